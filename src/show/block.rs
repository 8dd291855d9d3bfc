//! A page as a tree of blocks: written once, shown on a terminal, in a browser and as Markdown.
//!
//! Whoever lays out a page says what a word is, never how it looks. Where a terminal has room for a summary only, the page for
//! a browser carries more: [`Block::Brief`] is for the one, [`Block::Full`] for the other.

use maud::Markup;

use crate::model::Units;
use crate::show::digits::Digits;

/// What a stretch of text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    Heading,
    /// What matters in a sentence; a terminal leaves it plain.
    Strong,
    /// As it should be: agrees, holds.
    Good,
    /// Not as it should be: disagrees, refuted, did not run.
    Bad,
    /// A slip that nothing rests on.
    Doubtful,
    /// Not decided.
    Open,
}

/// A part of a sentence.
#[derive(Clone, Debug, PartialEq)]
pub enum Span {
    Text(String),
    /// What the author of a model wrote: in it an underscore is no index.
    Quoted(String),
    /// A number, and how many of its digits are shown.
    Number(f64, Digits),
    /// Real and imaginary part; a real number where the latter is 0.
    Complex([f64; 2], Digits),
    /// A number beside another one that it should be: a browser underlines the digits that differ.
    Against(f64, f64, Digits),
    /// A symbol of mathematics.
    Symbol(Symbol),
    /// A matrix by rows, or a column.
    Matrix(Vec<Vec<f64>>, Digits),
    /// What is typed: a command, a field of a file.
    Code(String),
    /// A unit, written in metres: `m/s`. It is told in the length of the model.
    Unit(&'static str),
    /// Words that stand out.
    Marked(Mark, String),
    /// What stands for something that `explain` knows by this name.
    About(String, Words),
    /// The end of a line.
    Break,
}

/// A symbol: a letter, smaller what is below and above it; and how a terminal writes it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// As a terminal writes it: `A-`, `T*`.
    pub plain: String,
    pub letter: &'static str,
    /// An index; empty where there is none.
    pub below: String,
    /// A side, or an asterisk; empty where there is none.
    pub above: &'static str,
}

/// A sentence, a cell or a heading.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Words(pub Vec<Span>);

/// Words of strings, numbers of things, `(value, digits)`, spans and other words: `words!["of ", count, " pairs"]`.
macro_rules! words {
    ($($part:expr),* $(,)?) => {{
        let mut words = $crate::show::block::Words::default();
        $(words.push($part);)*
        words
    }};
}
pub(crate) use words;

impl Words {
    /// Puts more words behind these.
    pub(crate) fn push(&mut self, more: impl Into<Self>) {
        self.0.extend(more.into().0);
    }

    /// A sentence: each `{}` is the next of the parts, a letter of mathematics stands between two underscores with its side
    /// behind a `^`, and what is typed between two backticks.
    pub(crate) fn prose(sentence: &'static str, parts: impl IntoIterator<Item = Self>) -> Self {
        let (mut prose, mut parts) = (Self::default(), parts.into_iter());
        for (place, text) in sentence.split('`').enumerate() {
            if place % 2 == 1 {
                prose.push(Span::Code(text.into()));
                continue;
            }
            for (place, text) in text.split('_').enumerate() {
                if place % 2 == 1 {
                    let (letter, above) = text.split_once('^').unwrap_or((text, ""));
                    prose.push(Symbol { plain: format!("{letter}{above}"), letter, below: String::new(), above });
                    continue;
                }
                for (place, text) in text.split("{}").enumerate() {
                    prose.push(if place > 0 { parts.next().unwrap_or_default() } else { Self::default() });
                    prose.push(text);
                }
            }
        }
        prose
    }

    /// Words with others between each two of them.
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

impl From<(Mark, &str)> for Words {
    fn from((mark, text): (Mark, &str)) -> Self {
        Span::Marked(mark, text.into()).into()
    }
}

impl From<Span> for Words {
    fn from(span: Span) -> Self {
        Self(vec![span])
    }
}

impl From<Symbol> for Words {
    fn from(symbol: Symbol) -> Self {
        Span::Symbol(symbol).into()
    }
}

/// Words that stand for something that `explain` knows by a name.
pub(crate) fn about(what: impl Into<String>, words: impl Into<Words>) -> Words {
    Span::About(what.into(), words.into()).into()
}

impl Words {
    /// The same with units in the length of a model.
    fn in_units(self, units: &Units) -> Self {
        let told = |span| match span {
            Span::Unit(unit) => Span::Text(units.spelled(unit)),
            Span::About(what, words) => Span::About(what, words.in_units(units)),
            span => span,
        };
        Self(self.0.into_iter().map(told).collect())
    }
}

/// A piece of a page.
#[derive(Clone, Debug)]
pub enum Block {
    /// The title of a page.
    Title(Words),
    /// The heading of a section or of a part of one.
    Heading(Words),
    /// A line as it stands, with its spaces; where it does not fit a terminal, it goes on under its second column.
    Line(Words),
    /// A paragraph, so many columns from the edge of a terminal.
    Paragraph(usize, Words),
    /// A remark to what stands before it.
    Note(Words),
    /// A name and what there is to say about it, each; the words begin so many columns behind the name.
    Entries(usize, Vec<(Words, Words)>),
    Table(Table),
    /// One thing after the other.
    List(Vec<Words>),
    /// What a browser folds away under its summary, and a terminal leaves out.
    Details(Words, Vec<Block>),
    /// For a terminal alone: less than a browser shows.
    Brief(Vec<Block>),
    /// For a browser alone: more than a terminal shows.
    Full(Vec<Block>),
    /// All of these stand for something that `explain` knows by this name, but for what says that it stands for something else.
    About(String, Vec<Block>),
    /// An empty line of a terminal.
    Gap,
    /// What only a browser can show: a drawing, a form.
    Markup(Markup),
}

impl Block {
    /// A paragraph that is indented as most are.
    pub(crate) fn paragraph(words: impl Into<Words>) -> Self {
        Self::Paragraph(2, words.into())
    }

    /// This, standing for something that `explain` knows by a name.
    pub(crate) fn about(self, what: &str) -> Self {
        Self::About(what.into(), vec![self])
    }
}

/// Blocks with units in the length of a model.
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
            let rows = table.rows.into_iter().map(|row| Row { cells: all(row.cells), ..row });
            Block::Table(Table { columns: columns.collect(), rows: rows.collect(), ..table })
        }
        Block::List(items) => Block::List(all(items)),
        Block::Details(summary, blocks) => Block::Details(told(summary), in_units(blocks, units)),
        Block::Brief(blocks) => Block::Brief(in_units(blocks, units)),
        Block::Full(blocks) => Block::Full(in_units(blocks, units)),
        Block::About(what, blocks) => Block::About(what, in_units(blocks, units)),
        Block::Gap | Block::Markup(_) => block,
    };
    blocks.into_iter().map(of_block).collect()
}

/// A part of a page that can be linked to.
#[derive(Clone, Debug)]
pub struct Section {
    /// The fragment that leads there.
    pub id: &'static str,
    pub title: Words,
    /// What stands under it.
    pub blocks: Vec<Block>,
}

/// A column of a table.
#[derive(Clone, Debug)]
pub struct Column {
    pub head: Words,
    /// Spaces before it on a terminal, where there is room.
    pub gap: usize,
    /// The fewest columns that it takes on a terminal, where there is room.
    pub least: usize,
    /// Whether its cells begin, and not end, under each other.
    pub left: bool,
}

impl Column {
    /// Cells that begin under each other.
    pub(crate) fn left(head: impl Into<Words>, gap: usize, least: usize) -> Self {
        Self { head: head.into(), gap, least, left: true }
    }

    /// A column of words in the look that most have.
    pub(crate) fn words(head: impl Into<Words>) -> Self {
        Self::left(head, 2, 0)
    }

    /// A column of numbers in the look that most have.
    pub(crate) fn number(head: impl Into<Words>) -> Self {
        Self::right(head, 0)
    }

    /// Cells that end under each other.
    pub(crate) fn right(head: impl Into<Words>, least: usize) -> Self {
        Self { head: head.into(), gap: 0, least, left: false }
    }
}

/// A row of a table.
#[derive(Clone, Debug)]
pub struct Row {
    /// One for each column; the first one heads the row.
    pub cells: Vec<Words>,
    /// Whether it says what should not be.
    pub is_bad: bool,
}

#[derive(Clone, Debug)]
pub struct Table {
    /// What it is of.
    pub label: String,
    pub columns: Vec<Column>,
    pub rows: Vec<Row>,
    /// Where it is too wide, it is told in several tables that all have the first column and so many of the last ones;
    /// `None` where it goes on row by row instead.
    pub repeated: Option<usize>,
}

impl Table {
    pub(crate) fn new(label: &str, columns: impl Into<Vec<Column>>) -> Self {
        Self { label: label.into(), columns: columns.into(), rows: Vec::new(), repeated: None }
    }

    pub(crate) fn row(&mut self, cells: impl Into<Vec<Words>>) {
        self.rows.push(Row { cells: cells.into(), is_bad: false });
    }

    /// Appends a row that says what should not be, where it is so.
    pub(crate) fn row_bad_where(&mut self, is_bad: bool, cells: impl Into<Vec<Words>>) {
        self.rows.push(Row { cells: cells.into(), is_bad });
    }
}
