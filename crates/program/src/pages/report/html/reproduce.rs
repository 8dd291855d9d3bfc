//! Commands that reproduce the report.

use crate::report::{Report, VERSION};
use crate::show::block::{Block, PageSection, Span, Words, words};

pub(crate) fn section(report: &Report) -> PageSection {
    let code = |text: &str| Words::from(Span::Code(text.into()));
    let commands = report.commands.iter().map(|(command, what)| (code(command), (*what).into()));
    let written = "This page was written by corner-impact {} from {}. Its numbers are one document, which the first command \
                   prints with `--json`; the page only lays them out.";
    let sources =
        "With the sources, `make test` runs every check and `make derive-check` redoes the proofs by computer algebra.";
    let mut blocks = vec![
        Block::paragraph(Words::prose(written, [VERSION.into(), code(&report.model.file)])),
        Block::Entries(0, commands.collect()),
        Block::paragraph(Words::prose(sources, [])),
    ];
    if let Err(why) = &report.verification {
        blocks.push(Block::Note(words!["No corner impact is verified here: ", why.as_str()]));
    }
    PageSection { id: "reproduce", title: "How to do it again".into(), blocks }
}
