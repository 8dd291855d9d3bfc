//! Blocks as Markdown, for pages under `docs/`.

use std::fmt::{self, Write};

use crate::show::block::{Block, PageSection, Span, Table, Words};
use crate::show::page;
use corner_impact::untrusted;

/// Writes a page: its introduction and its sections.
pub fn page(lead: &[Block], sections: &[PageSection]) -> Result<String, fmt::Error> {
    let mut out = String::new();
    blocks(&mut out, lead)?;
    for section in sections {
        after_a_gap(&mut out)?;
        writeln!(out, "## {}", text(&section.title))?;
        blocks(&mut out, &section.blocks)?;
    }
    Ok(out)
}

/// Writes an empty line between two blocks.
fn after_a_gap(out: &mut String) -> fmt::Result {
    if out.is_empty() { Ok(()) } else { writeln!(out) }
}

/// Writes blocks in order.
fn blocks(out: &mut String, blocks: &[Block]) -> fmt::Result {
    for block in blocks {
        match block {
            Block::Full(inside) | Block::About(_, inside) => self::blocks(out, inside)?,
            Block::Brief(_) | Block::Gap | Block::Markup(_) => {}
            block => {
                after_a_gap(out)?;
                self::block(out, block)?;
            }
        }
    }
    Ok(())
}

fn block(out: &mut String, block: &Block) -> fmt::Result {
    match block {
        Block::Title(words) => writeln!(out, "# {}", text(words)),
        Block::Heading(words) => writeln!(out, "### {}", text(words)),
        Block::Line(words) | Block::Paragraph(_, words) | Block::Note(words) => writeln!(out, "{}", text(words)),
        Block::Command(line) => writeln!(out, "    {line}"),
        Block::Entries(_, entries) => {
            entries.iter().try_for_each(|(name, words)| writeln!(out, "- {}: {}", text(name), text(words)))
        }
        Block::Table(table) => self::table(out, table),
        Block::List(items) => items.iter().try_for_each(|words| writeln!(out, "- {}", text(words))),
        Block::Details(summary, inside) => {
            writeln!(out, "{}", text(summary))?;
            blocks(out, inside)
        }
        Block::Full(_) | Block::About(..) | Block::Brief(_) | Block::Gap | Block::Markup(_) => Ok(()),
    }
}

fn table(out: &mut String, table: &Table) -> fmt::Result {
    let line = |cells: Vec<String>| format!("| {} |", cells.join(" | "));
    writeln!(out, "{}", line(table.columns.iter().map(|column| text(&column.head)).collect()))?;
    writeln!(out, "|{}", "---|".repeat(table.columns.len()))?;
    table.rows.iter().try_for_each(|row| writeln!(out, "{}", line(row.cells.iter().map(text).collect())))
}

/// Words as Markdown; bars, asterisks and angle brackets of a text are escaped.
fn text(words: &Words) -> String {
    let of = |span: &Span| match span {
        Span::Code(text) => format!("`{}`", untrusted::visible(text)),
        Span::Unit(unit) => (*unit).to_owned(),
        Span::Marked(_, text) => format!("*{}*", escaped(&untrusted::visible(text))),
        Span::Break => "<br>".into(),
        Span::About(_, words) => self::text(words),
        span => escaped(&page::text(&span.clone().into())),
    };
    words.0.iter().map(of).collect()
}

fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for letter in text.chars() {
        if "|*<>_[]~^".contains(letter) {
            escaped.push('\\');
        }
        escaped.push(letter);
    }
    escaped
}
