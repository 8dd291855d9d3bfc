//! Pages as trees of blocks: written once, shown on a terminal, in a browser and as Markdown.
//!
//! The code that lays out a page states the meaning of a word, never its appearance. If a terminal has room only for a summary, the page
//! for a browser has more: [`Block::Brief`] is for the terminal, [`Block::Full`] for the browser.

use maud::Markup;

use crate::show::digits::Digits;
use corner_impact::model::Units;

/// Meaning of a piece of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextMark {
    Heading,
    /// Important words of a sentence; a terminal leaves them plain.
    Strong,
    /// Good result: agrees, correct.
    Good,
    /// Bad result: disagrees, refuted, did not run.
    Bad,
    /// Error on which no other statement depends.
    Doubtful,
    /// Undecided result.
    Open,
}

/// Part of a sentence.
#[derive(Clone, Debug, PartialEq)]
pub enum Span {
    Text(String),
    /// Text by the author of a model; an underscore in it does not mean an index.
    Quoted(String),
    /// Number with its displayed digits.
    Number(f64, Digits),
    /// Real and imaginary part; shown as a real number if the imaginary part is 0.
    Complex([f64; 2], Digits),
    /// Number with its expected value: a browser underlines the digits that differ.
    Against(f64, f64, Digits),
    /// Formula, in the spelling of a terminal: `A_hat_minus`.
    Formula(String),
    /// Matrix by rows, or a column.
    Matrix(Vec<Vec<f64>>, Digits),
    /// Typed text: a command, a field of a file.
    Code(String),
    /// Unit, written in metres: `m/s`. The page shows it in the model's unit of length.
    Unit(&'static str),
    /// Emphasized words.
    Marked(TextMark, String),
    /// Words for an entry of `explain` with this name.
    About(String, Words),
    /// Line break.
    Break,
}

/// Sentence, cell or heading.
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

    /// Builds a sentence. Each `{}` is replaced by the next of the parts, and typed text is between two backticks.
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

/// Words for an entry of `explain` with a name.
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

/// Element of a page.
#[derive(Clone, Debug)]
pub enum Block {
    /// Title of a page.
    Title(Words),
    /// Heading of a section or of a subsection.
    Heading(Words),
    /// Literal line with its spaces; if it is too long for a terminal, it continues under its second column.
    Line(Words),
    /// Command line; if it is too long for a terminal, it continues after a backslash.
    Command(String),
    /// Paragraph with an indent, in columns of a terminal.
    Paragraph(usize, Words),
    /// Remark on the block before it.
    Note(Words),
    /// Names with descriptions; the number is the width of the column of names.
    Entries(usize, Vec<(Words, Words)>),
    Table(Table),
    /// List of items.
    List(Vec<Words>),
    /// Block that a browser folds under its summary and a terminal omits.
    Details(Words, Vec<Block>),
    /// Blocks for a terminal only, shorter than those for a browser.
    Brief(Vec<Block>),
    /// Blocks for a browser only, longer than those for a terminal.
    Full(Vec<Block>),
    /// Blocks for an entry of `explain` with this name, except for parts that name another entry.
    About(String, Vec<Block>),
    /// Empty line on a terminal.
    Gap,
    /// Content for a browser only: a drawing, a form.
    Markup(Markup),
}

impl Block {
    /// Builds a paragraph with the usual indent.
    pub(crate) fn paragraph(words: impl Into<Words>) -> Self {
        Self::Paragraph(2, words.into())
    }

    /// Marks this block as belonging to an entry of `explain`.
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

/// Section of a page that can be linked to.
#[derive(Clone, Debug)]
pub struct PageSection {
    /// URL fragment of the section.
    pub id: &'static str,
    pub title: Words,
    /// Blocks of the section.
    pub blocks: Vec<Block>,
}

/// Column of a table.
#[derive(Clone, Debug)]
pub struct Column {
    pub head: Words,
    /// Spaces before the column on a terminal, if there is room.
    pub gap: usize,
    /// Least width on a terminal, if there is room.
    pub least: usize,
    /// Whether the cells are left-aligned; otherwise right-aligned.
    pub left: bool,
    /// Rank of the columns that a narrow page omits: the highest first, 0 for never.
    pub missable: u8,
}

impl Column {
    /// Builds a left-aligned column.
    pub(crate) fn left(head: impl Into<Words>, gap: usize, least: usize) -> Self {
        Self { head: head.into(), gap, least, left: true, missable: 0 }
    }

    /// Builds a column of words in the usual style.
    pub(crate) fn words(head: impl Into<Words>) -> Self {
        Self::left(head, 2, 0)
    }

    /// Builds a column of numbers in the usual style.
    pub(crate) fn number(head: impl Into<Words>) -> Self {
        Self::right(head, 0)
    }

    /// Builds a right-aligned column.
    pub(crate) fn right(head: impl Into<Words>, least: usize) -> Self {
        Self { head: head.into(), gap: 0, least, left: false, missable: 0 }
    }

    /// Marks the column as one that a narrow page omits. Columns of a higher rank are omitted first.
    pub(crate) fn missable(self, rank: u8) -> Self {
        Self { missable: rank, ..self }
    }
}

/// Row of a table.
#[derive(Clone, Debug)]
pub struct PageRow {
    /// Cells, one for each column; the first is the head of the row.
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
    /// Number of last columns that are repeated, besides the first one, if a table that is too wide is split into several. `None` if it is
    /// written row by row instead.
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
