//! Blocks as Markdown, for pages under `docs/`.

use std::fmt::{self, Write};

use crate::show::block::{Block, Section, Span, Table, Words};
use crate::show::page;

/// Blocks one after the other.
pub fn blocks(out: &mut String, blocks: &[Block]) -> fmt::Result {
    blocks.iter().try_for_each(|block| match block {
        Block::Title(words) => writeln!(out, "# {}\n", text(words)),
        Block::Heading(words) => writeln!(out, "\n### {}\n", text(words)),
        Block::Paragraph(_, words) | Block::Note(words) => writeln!(out, "{}\n", text(words)),
        Block::Entries(_, entries) => {
            entries.iter().try_for_each(|(name, words)| writeln!(out, "- {}: {}", text(name), text(words)))
        }
        Block::Table(table) => self::table(out, table),
        Block::List(items) => items.iter().try_for_each(|words| writeln!(out, "- {}", text(words))),
        Block::Details(summary, inside) => {
            writeln!(out, "{}\n", text(summary))?;
            self::blocks(out, inside)
        }
        Block::Full(inside) => self::blocks(out, inside),
        Block::Brief(_) | Block::Gap | Block::Markup(_) => Ok(()),
    })
}

/// Sections one after the other.
pub fn sections<'a>(out: &mut String, sections: impl IntoIterator<Item = &'a Section>) -> fmt::Result {
    sections.into_iter().try_for_each(|section| {
        writeln!(out, "\n## {}\n", text(&section.title))?;
        blocks(out, &section.blocks)
    })
}

fn table(out: &mut String, table: &Table) -> fmt::Result {
    let line = |cells: Vec<String>| format!("| {} |", cells.join(" | "));
    writeln!(out, "{}", line(table.columns.iter().map(|column| text(&column.head)).collect()))?;
    writeln!(out, "|{}", "---|".repeat(table.columns.len()))?;
    table.rows.iter().try_for_each(|row| writeln!(out, "{}", line(row.cells.iter().map(text).collect())))
}

/// Words as Markdown has them: bars, stars and angle brackets of a text stand for themselves.
fn text(words: &Words) -> String {
    let of = |span: &Span| match span {
        Span::Code(text) => format!("`{text}`"),
        Span::Marked(_, text) => format!("*{}*", escaped(text)),
        Span::Break => "<br>".into(),
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
