//! Blocks in a browser: tables with proper head cells, in boxes that scroll separately.

use corner_impact_plot::formula::{self, Part};
use maud::{Markup, html};

use crate::show::block::{Block, Column, Span, Table, TextMark, Words};
use crate::show::digits::{Digits, typeset};

/// Largest number of rows of a table that is not folded.
const LONG: usize = 24;

/// Markup of blocks in order. A long table is folded.
pub(crate) fn blocks(blocks: &[Block]) -> Markup {
    html! { @for block in blocks { (self::block(block, false)) } }
}

/// Markup of blocks that are folded together, so that no table in them is folded again.
fn folded(blocks: &[Block]) -> Markup {
    html! { @for block in blocks { (self::block(block, true)) } }
}

fn block(block: &Block, is_folded: bool) -> Markup {
    let inner = |inside: &[Block]| if is_folded { folded(inside) } else { blocks(inside) };
    html! {
        @match block {
            Block::Title(text) => h1 { (words(text)) }
            Block::Heading(text) => h3 { (words(text)) }
            Block::Line(text) | Block::Paragraph(_, text) => @if !text.is_empty() { p { (words(text)) } }
            Block::Command(line) => p { code { (line) } }
            Block::Note(text) => p.note { (words(text)) }
            Block::Entries(_, entries) => dl.entries {
                @for (name, text) in entries { dt { (words(name)) } dd { (words(text)) } }
            }
            Block::Table(table) if !is_folded && table.rows.len() > LONG => {
                details { summary { (table.label) " (" (table.rows.len()) " rows)" } (self::table(table)) }
            }
            Block::Table(table) => (self::table(table)),
            Block::List(items) => ul { @for item in items { li { (words(item)) } } }
            Block::Details(summary, inside) => details { summary { (words(summary)) } (folded(inside)) }
            Block::Full(inside) => (inner(inside)),
            Block::About(what, inside) => div data-about=(what) { (inner(inside)) },
            Block::Markup(markup) => (markup),
            Block::Brief(_) | Block::Gap => {}
        }
    }
}

/// Wraps a block that may be wider than the page in a box that scrolls separately.
pub(crate) fn wide(label: &str, body: &Markup) -> Markup {
    html! { div.wide role="region" aria-label=(label) tabindex="0" { (body) } }
}

fn table(table: &Table) -> Markup {
    let number = |index: usize| table.columns.get(index).filter(|column| !column.left).map(|_| "n");
    let headed = table.columns.iter().any(|column| !column.head.is_empty());
    // Heads for narrow pages, on which the cells of a row are below each other: the style sheet reads them from the table.
    let quoted = |text: &str| format!("'{}'", text.replace('\\', "\\\\").replace('\'', "\\'"));
    let heads: String = (table.columns.iter().zip(1..))
        .map(|(column, place)| (plain(&column.head), place))
        .filter(|(head, _)| !head.is_empty())
        .map(|(head, place): (String, i32)| format!("--h{place}:{};", quoted(&head)))
        .collect();
    let head =
        |column: &Column| html! { th class=[(!column.left).then_some("n")] scope="col" { (words(&column.head)) } };
    wide(
        &table.label,
        &html! {
            table style=[Some(heads).filter(|heads| !heads.is_empty())] {
                caption { (table.label) }
                @if headed { thead { tr { @for column in &table.columns { (head(column)) } } } }
                tbody {
                    @for row in &table.rows {
                        tr class=[row.is_bad.then_some("disagrees")] {
                            @for (index, cell) in row.cells.iter().enumerate() {
                                @let (about, cell) = whole_cell(cell);
                                @let (value, text) = number_cell(cell);
                                @if index == 0 { th class=[number(0)] scope="row" data-about=[about] data-value=[value] { (text) } }
                                @else { td class=[number(index)] data-about=[about] data-value=[value] { (text) } }
                            }
                        }
                    }
                }
            }
        },
    )
}

/// Name to which all words of a cell belong, and these words.
fn whole_cell(cell: &Words) -> (Option<&str>, &Words) {
    match cell.0.as_slice() {
        [Span::About(about, inside)] => (Some(about), inside),
        _ => (None, cell),
    }
}

/// Number of a cell, if it is one, and the cell's text. The cell itself has the number's digits, which halves the number of elements.
fn number_cell(cell: &Words) -> (Option<f64>, Markup) {
    match cell.0.as_slice() {
        [Span::Number(value, digits)] if value.is_finite() => (Some(*value), typeset(&digits.typed(*value))),
        [Span::Against(value, other, digits)] => (Some(*value), compared(*value, *other, *digits)),
        _ => (None, words(cell)),
    }
}

/// Words as plain text, without content for browsers only.
fn plain(words: &Words) -> String {
    let part = |span: &Span| match span {
        Span::Text(text) => formula::typed(text).into_owned(),
        Span::Quoted(text) | Span::Code(text) | Span::Formula(text) | Span::Marked(_, text) => text.clone(),
        Span::Unit(unit) => (*unit).to_owned(),
        Span::About(_, words) => plain(words),
        Span::Break => " ".into(),
        Span::Number(..) | Span::Complex(..) | Span::Against(..) | Span::Matrix(..) => String::new(),
    };
    words.0.iter().map(part).collect::<String>().replace('\n', " ").trim().to_owned()
}

/// Sentence with typeset formulas.
pub(crate) fn sentence(text: &str) -> Markup {
    parts(formula::sentence(text))
}

fn parts(parts: Vec<Part>) -> Markup {
    html! {
        @for part in parts {
            @match part {
                Part::Plain(text) => (text),
                Part::Letter(text) => i { (text) },
                Part::Below(text) => sub { (text) },
                Part::Above(text) => sup { (text) },
            }
        }
    }
}

/// Words as markup for a browser.
pub(crate) fn words(words: &Words) -> Markup {
    html! { @for span in &words.0 { (self::span(span)) } }
}

fn span(span: &Span) -> Markup {
    html! {
        @match span {
            Span::Text(text) => (sentence(text)),
            Span::Quoted(text) => (text),
            Span::Number(value, digits) => (digits.markup(*value)),
            Span::Complex([re, im], digits) => span.number {
                (digits.markup(*re))
                @if *im != 0.0 {
                    @let sign = if *im < 0.0 { " \u{2212} " } else { " + " };
                    (sign) data value=(im) { (typeset(&digits.typed(im.abs()))) } "\u{202f}i"
                }
            },
            Span::Against(value, other, digits) => data value=(value) { (compared(*value, *other, *digits)) },
            Span::Formula(text) => span.symbol { (parts(formula::formula(text))) },
            Span::Matrix(rows, digits) => table.matrix {
                tbody { @for row in rows { tr { @for entry in row { td { (digits.markup(*entry)) } } } } }
            },
            Span::Code(text) => code { (text) },
            Span::Unit(unit) => (unit),
            Span::Marked(TextMark::Strong | TextMark::Heading, text) => strong { (text) },
            Span::Marked(TextMark::Good, text) => span.good { (text) },
            Span::Marked(TextMark::Bad, text) => span.bad { (text) },
            Span::Marked(TextMark::Doubtful, text) => span.doubtful { (text) },
            Span::Marked(TextMark::Open, text) => span.open { (text) },
            Span::About(what, inside) => span data-about=(what) { (words(inside)) },
            Span::Break => br;
        }
    }
}

/// Writes a number and underlines the digits that differ from another number.
fn compared(value: f64, other: f64, digits: Digits) -> Markup {
    let (text, other) = (digits.typed(value), digits.typed(other));
    let same: usize =
        text.chars().zip(other.chars()).take_while(|(one, two)| one == two).map(|(one, _)| one.len_utf8()).sum();
    let (head, tail) = text.split_at(same);
    html! { (typeset(head)) @if !tail.is_empty() { u { (typeset(tail)) } } }
}
