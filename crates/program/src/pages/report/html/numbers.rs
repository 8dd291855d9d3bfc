//! Meaning of each number of the page: the text of `explain`, folded here and shown when a number is clicked.

use maud::html;

use crate::explain::{Findings, Links};
use crate::pages::explain::explained;
use crate::pages::report::html::HtmlError;
use crate::report::Report;
use crate::show::block::{Block, PageSection, Span, Words, in_units, words};
use crate::show::html::blocks;

/// Section with an explanation for every name in these sections.
pub(crate) fn section(report: &Report, sections: &[PageSection]) -> Result<PageSection, HtmlError> {
    let mut names: Vec<&str> = Vec::new();
    sections.iter().for_each(|section| of_blocks(&section.blocks, &mut names));
    let (links, found) = (Links::read()?, report.verification.as_ref().ok());
    let findings = Findings::new(&report.parsed, found)?;
    let mut parts = vec![Block::paragraph(Words::prose(
        "Click on a number of this page to see its meaning: formula, inputs, value by every route, evidence, code, proof and tests. \
         The same text is folded here under each name, and `corner-impact explain` prints it.",
        [],
    ))];
    for name in names {
        let explanation = links.explain(name, &findings)?;
        let inside = in_units(explained(&explanation), &report.units);
        parts.push(Block::Markup(html! {
            details.explanation id={ "explain-" (name) } { summary { (name) } (blocks(&inside)) }
        }));
    }
    Ok(PageSection { id: "numbers", title: words!["Where each number comes from"], blocks: parts })
}

/// Adds a name that is not in the list yet, which keeps the order of the page.
fn named<'a>(name: &'a str, names: &mut Vec<&'a str>) {
    if !names.contains(&name) {
        names.push(name);
    }
}

fn of_blocks<'a>(blocks: &'a [Block], names: &mut Vec<&'a str>) {
    for block in blocks {
        match block {
            Block::Title(words) | Block::Heading(words) | Block::Line(words) | Block::Paragraph(_, words) => {
                of_words(words, names);
            }
            Block::Note(words) => of_words(words, names),
            Block::Command(_) => {}
            Block::Entries(_, entries) => entries.iter().for_each(|(_, words)| of_words(words, names)),
            Block::Table(table) => {
                table.rows.iter().flat_map(|row| &row.cells).for_each(|words| of_words(words, names));
            }
            Block::List(items) => items.iter().for_each(|words| of_words(words, names)),
            Block::About(name, inside) => {
                named(name, names);
                of_blocks(inside, names);
            }
            Block::Details(_, inside) | Block::Full(inside) => of_blocks(inside, names),
            Block::Brief(_) | Block::Gap | Block::Markup(_) => {}
        }
    }
}

fn of_words<'a>(words: &'a Words, names: &mut Vec<&'a str>) {
    for span in &words.0 {
        if let Span::About(name, inside) = span {
            named(name, names);
            of_words(inside, names);
        }
    }
}
