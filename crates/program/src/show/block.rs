//! A page as a tree of blocks: written once, shown on a terminal, in a browser and as Markdown.
//!
//! The code that lays out a page gives the meaning of a word, never its appearance. Where a terminal has room for a summary only, the page
//! for a browser says more: [`Block::Brief`] is for the terminal, [`Block::Full`] for the browser.

use maud::Markup;

use crate::show::digits::Digits;
use corner_impact::model::Units;

/// Meaning of a stretch of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextMark {
    Heading,
    /// Important words of a sentence; a terminal leaves them plain.
    Strong,
    /// A good result: agrees, holds.
    Good,
    /// A bad result: disagrees, refuted, did not run.
    Bad,
    /// An error on which no other statement depends.
    Doubtful,
    /// An undecided result.
    Open,
}

/// A part of a sentence.
#[derive(Clone, Debug, PartialEq)]
pub enum Span {
    Text(String),
    /// Text by the author of a model; an underscore in it does not mean an index.
    Quoted(String),
    /// A number with its displayed digits.
    Number(f64, Digits),
    /// Real and imaginary part; shown as a real number if the imaginary part is 0.
    Complex([f64; 2], Digits),
    /// A number with its expected value: a browser underlines the digits that differ.
    Against(f64, f64, Digits),
    /// A formula, as a terminal shows it: `A_hat_minus`.
    Formula(String),
    /// A matrix by rows, or a column.
    Matrix(Vec<Vec<f64>>, Digits),
    /// Typed text: a command, a field of a file.
    Code(String),
    /// A unit, written in metres: `m/s`. The page shows it in the model's unit of length.
    Unit(&'static str),
    /// Emphasized words.
    Marked(TextMark, String),
    /// Words for an entry that `explain` has under this name.
    About(String, Words),
    /// A line break.
    Break,
}

/// A sentence, a cell or a heading.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Words(pub Vec<Span>);

/// Builds words from strings, counts, `(value, digits)`, spans and other words: `words!["of ", count, " pairs"]`.
macro_rules! words {
    ($($part:expr),* $(,)?) => {{
        let mut words = $crate::show::block::Words::default();
        $(words.push($part);)*
        words
    }};
}
pub(crate) use words;

impl Words {
    /// Appends more words.
    pub(crate) fn push(&mut self, more: impl Into<Self>) {
        self.0.extend(more.into().0);
    }

    /// Builds a sentence. Each `{}` takes the next of the parts, and typed text is between two backticks.
    pub(crate) fn prose(sentence: &'static str, parts: impl IntoIterator<Item = Self>) -> Self {
        let (mut prose, mut parts) = (Self::default(), parts.into_iter());
        for (place, text) in sentence.split('`').enumerate() {
            if place % 2 == 1 {
                prose.push(Span::Code(text.into()));
                continue;
            }
            for (place, text) in text.split("{}").enumerate() {
                prose.push(if place > 0 { parts.next().unwrap_or_default() } else { Self::default() });
                prose.push(text);
            }
        }
        prose
    }

    /// Joins words with a separator between them.
    pub(crate) fn joined(all: impl IntoIterator<Item = Self>, between: &str) -> Self {
        let mut joined = Self::default();
        for (index, words) in all.into_iter().enumerate() {
            joined.push(if index > 0 { between } else { "" });
            joined.push(words);
        }
        joined
    }

    /// Whether there is nothing to show.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl From<&str> for Words {
    fn from(text: &str) -> Self {
        Self(if text.is_empty() { Vec::new() } else { vec![Span::Text(text.into())] })
    }
}

impl From<String> for Words {
    fn from(text: String) -> Self {
        text.as_str().into()
    }
}

impl From<&String> for Words {
    fn from(text: &String) -> Self {
        text.as_str().into()
    }
}

impl From<usize> for Words {
    fn from(count: usize) -> Self {
        count.to_string().into()
    }
}

impl From<(f64, Digits)> for Words {
    fn from((value, digits): (f64, Digits)) -> Self {
        Span::Number(value, digits).into()
    }
}

impl From<(TextMark, &str)> for Words {
    fn from((mark, text): (TextMark, &str)) -> Self {
        Span::Marked(mark, text.into()).into()
    }
}

impl From<Span> for Words {
    fn from(span: Span) -> Self {
        Self(vec![span])
    }
}

/// Words for an entry that `explain` has under a name.
pub(crate) fn about(what: impl Into<String>, words: impl Into<Words>) -> Words {
    Span::About(what.into(), words.into()).into()
}

impl Words {
    /// Converts units to the length of a model.
    fn in_units(self, units: &Units) -> Self {
        let told = |span| match span {
            Span::Unit(unit) => Span::Text(units.spelled(unit)),
            Span::About(what, words) => Span::About(what, words.in_units(units)),
            span => span,
        };
        Self(self.0.into_iter().map(told).collect())
    }
}

/// One element of a page.
#[derive(Clone, Debug)]
pub enum Block {
    /// The title of a page.
    Title(Words),
    /// The heading of a section or of a subsection.
    Heading(Words),
    /// A literal line with its spaces; if it is too long for a terminal, it continues under its second column.
    Line(Words),
    /// A command line; where it is too long for a terminal, it goes on after a backslash.
    Command(String),
    /// A paragraph with an indent, in columns of a terminal.
    Paragraph(usize, Words),
    /// A remark on the block before it.
    Note(Words),
    /// Names with descriptions; the number is the width of the column of names.
    Entries(usize, Vec<(Words, Words)>),
    Table(Table),
    /// A list of items.
    List(Vec<Words>),
    /// A block that a browser folds under its summary and a terminal leaves out.
    Details(Words, Vec<Block>),
    /// Blocks for a terminal only, shorter than those for a browser.
    Brief(Vec<Block>),
    /// Blocks for a browser only, longer than those for a terminal.
    Full(Vec<Block>),
    /// Blocks for an entry that `explain` has under this name, except for parts that name another entry.
    About(String, Vec<Block>),
    /// An empty line on a terminal.
    Gap,
    /// Content for a browser only: a drawing, a form.
    Markup(Markup),
}

impl Block {
    /// A paragraph with the usual indent.
    pub(crate) fn paragraph(words: impl Into<Words>) -> Self {
        Self::Paragraph(2, words.into())
    }

    /// Marks this block as one for an entry that `explain` has under a name.
    pub(crate) fn about(self, what: &str) -> Self {
        Self::About(what.into(), vec![self])
    }
}

/// Converts the units of blocks to the length of a model.
pub(crate) fn in_units(blocks: Vec<Block>, units: &Units) -> Vec<Block> {
    let told = |words: Words| words.in_units(units);
    let all = |words: Vec<Words>| words.into_iter().map(told).collect::<Vec<_>>();
    let of_block = |block| match block {
        Block::Title(words) => Block::Title(told(words)),
        Block::Heading(words) => Block::Heading(told(words)),
        Block::Line(words) => Block::Line(told(words)),
        Block::Paragraph(indent, words) => Block::Paragraph(indent, told(words)),
        Block::Note(words) => Block::Note(told(words)),
        Block::Entries(width, entries) => {
            Block::Entries(width, entries.into_iter().map(|(name, words)| (told(name), told(words))).collect())
        }
        Block::Table(table) => {
            let columns = table.columns.into_iter().map(|column| Column { head: told(column.head), ..column });
            let rows = table.rows.into_iter().map(|row| PageRow { cells: all(row.cells), ..row });
            Block::Table(Table { columns: columns.collect(), rows: rows.collect(), ..table })
        }
        Block::List(items) => Block::List(all(items)),
        Block::Details(summary, blocks) => Block::Details(told(summary), in_units(blocks, units)),
        Block::Brief(blocks) => Block::Brief(in_units(blocks, units)),
        Block::Full(blocks) => Block::Full(in_units(blocks, units)),
        Block::About(what, blocks) => Block::About(what, in_units(blocks, units)),
        Block::Command(_) | Block::Gap | Block::Markup(_) => block,
    };
    blocks.into_iter().map(of_block).collect()
}

/// A section of a page that can be linked to.
#[derive(Clone, Debug)]
pub struct PageSection {
    /// URL fragment of the section.
    pub id: &'static str,
    pub title: Words,
    /// Blocks of the section.
    pub blocks: Vec<Block>,
}

/// A column of a table.
#[derive(Clone, Debug)]
pub struct Column {
    pub head: Words,
    /// Spaces before the column on a terminal, if there is room.
    pub gap: usize,
    /// Least width on a terminal, if there is room.
    pub least: usize,
    /// Whether the cells are left-aligned; otherwise right-aligned.
    pub left: bool,
    /// Rank among the columns that are left out of a narrow page: the highest first, 0 for never.
    pub missable: u8,
}

impl Column {
    /// A left-aligned column.
    pub(crate) fn left(head: impl Into<Words>, gap: usize, least: usize) -> Self {
        Self { head: head.into(), gap, least, left: true, missable: 0 }
    }

    /// A column of words in the usual style.
    pub(crate) fn words(head: impl Into<Words>) -> Self {
        Self::left(head, 2, 0)
    }

    /// A column of numbers in the usual style.
    pub(crate) fn number(head: impl Into<Words>) -> Self {
        Self::right(head, 0)
    }

    /// A right-aligned column.
    pub(crate) fn right(head: impl Into<Words>, least: usize) -> Self {
        Self { head: head.into(), gap: 0, least, left: false, missable: 0 }
    }

    /// Marks the column as one that a narrow page leaves out. Columns of a higher rank go first.
    pub(crate) fn missable(self, rank: u8) -> Self {
        Self { missable: rank, ..self }
    }
}

/// A row of a table.
#[derive(Clone, Debug)]
pub struct PageRow {
    /// One cell for each column; the first is the head of the row.
    pub cells: Vec<Words>,
    /// Whether the row states a bad result.
    pub is_bad: bool,
}

#[derive(Clone, Debug)]
pub struct Table {
    /// Subject of the table.
    pub label: String,
    pub columns: Vec<Column>,
    pub rows: Vec<PageRow>,
    /// Number of last columns that are repeated, besides the first one, if a table that is too wide is split into several.
    /// `None` if it is written row by row instead.
    pub repeated: Option<usize>,
}

impl Table {
    pub(crate) fn new(label: &str, columns: impl Into<Vec<Column>>) -> Self {
        Self { label: label.into(), columns: columns.into(), rows: Vec::new(), repeated: None }
    }

    pub(crate) fn row(&mut self, cells: impl Into<Vec<Words>>) {
        self.rows.push(PageRow { cells: cells.into(), is_bad: false });
    }

    /// Appends a row and marks it as a bad result if `is_bad`.
    pub(crate) fn row_bad_where(&mut self, is_bad: bool, cells: impl Into<Vec<Words>>) {
        self.rows.push(PageRow { cells: cells.into(), is_bad });
    }
}
