//! Commands that reproduce the report.

use crate::report::{Report, VERSION};
use crate::show::block::{Block, PageSection, Span, Words, words};

pub(crate) fn section(report: &Report) -> PageSection {
    let code = |text: &str| Words::from(Span::Code(text.into()));
    let commands = report.commands.iter().map(|(command, what)| (code(command), (*what).into()));
    let written = "corner-impact {} wrote this page from {}. All numbers come from one document, which the first command \
                   prints with `--json`.";
    let sources = "In the folder of the sources, `make test` runs every check, and `make derive-check` repeats the proofs by computer algebra.";
    let mut blocks = vec![
        Block::paragraph(Words::prose(written, [VERSION.into(), code(&report.model.file)])),
        Block::Entries(0, commands.collect()),
        Block::paragraph(Words::prose(sources, [])),
    ];
    if let Err(why) = &report.verification {
        blocks.push(Block::Note(words!["No corner impact is verified here: ", why.as_str()]));
    }
    PageSection { id: "reproduce", title: "How to reproduce this page".into(), blocks }
}
