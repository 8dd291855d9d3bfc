//! A page for a terminal: text in lines that fit, and marks on words that stand out.
//!
//! Whoever lays out a page says what a word is ([`Mark`]), never how that looks; [`Page::coloured`] alone knows, and
//! [`Page::plain`] leaves it out. A mark adds nothing that the words do not say.

use std::fmt::{self, Write};
use std::ops::Range;

/// Columns of a page where nothing says how many there are.
pub const WIDTH: usize = 100;

/// What a stretch of text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A heading.
    Heading,
    /// As it should be: agrees, holds.
    Good,
    /// Not as it should be: disagrees, refuted, did not run.
    Bad,
    /// A slip that nothing rests on.
    Doubtful,
    /// Not decided.
    Open,
}

impl Mark {
    /// The escape codes that begin it: bold, and colours of the terminal's own sixteen, so that any background will do.
    fn codes(self) -> &'static str {
        match self {
            Self::Heading => "\x1b[1m",
            Self::Good => "\x1b[32m",
            Self::Bad => "\x1b[1;31m",
            Self::Doubtful => "\x1b[33m",
            Self::Open => "\x1b[36m",
        }
    }
}

/// Text in lines of at most so many columns, with marks.
#[derive(Clone, Debug)]
pub struct Page {
    width: usize,
    text: String,
    marks: Vec<(Range<usize>, Mark)>,
    /// Where the line that is being written begins.
    line: usize,
}

impl Write for Page {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for piece in text.split_inclusive('\n') {
            self.text.push_str(piece.trim_end_matches('\n'));
            if piece.ends_with('\n') {
                self.fold();
                self.text.push('\n');
                self.line = self.text.len();
            }
        }
        Ok(())
    }
}

impl Page {
    /// An empty page of `width` columns.
    pub fn new(width: usize) -> Self {
        Self { width, text: String::new(), marks: Vec::new(), line: 0 }
    }

    /// Its columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Writes words that stand out; within a line.
    pub fn marked(&mut self, mark: Mark, words: &str) {
        let start = self.text.len();
        self.text.push_str(words);
        self.marks.push((start..self.text.len(), mark));
    }

    /// A title and a line under it.
    pub fn title(&mut self, text: &str) -> fmt::Result {
        self.underlined(text, '=')
    }

    /// A heading and a line under it, after an empty one.
    pub fn heading(&mut self, text: &str) -> fmt::Result {
        writeln!(self)?;
        self.underlined(text, '-')
    }

    fn underlined(&mut self, text: &str, rule: char) -> fmt::Result {
        self.marked(Mark::Heading, text);
        writeln!(self)?;
        let length = text.chars().count().min(self.width);
        writeln!(self, "{}", String::from(rule).repeat(length))
    }

    /// Text in lines that fit, indented.
    pub fn paragraph_at(&mut self, indent: usize, text: &str) -> fmt::Result {
        for line in lines(text, self.width.saturating_sub(indent)) {
            writeln!(self, "{:indent$}{line}", "")?;
        }
        Ok(())
    }

    /// The text alone.
    pub fn plain(&self) -> &str {
        &self.text
    }

    /// The text with escape codes around what is marked.
    pub fn coloured(&self) -> String {
        let (mut coloured, mut at) = (String::with_capacity(self.text.len()), 0);
        for (range, mark) in &self.marks {
            coloured.push_str(&self.text[at..range.start]);
            let _ = write!(coloured, "{}{}\x1b[0m", mark.codes(), &self.text[range.clone()]);
            at = range.end;
        }
        coloured.push_str(&self.text[at..]);
        coloured
    }

    /// Breaks the line that has just been written where it is too long, at spaces: what follows goes on under the second
    /// column of the line where it has one.
    fn fold(&mut self) {
        loop {
            let line = &self.text[self.line..];
            if line.chars().count() <= self.width {
                return;
            }
            let indent = line.len() - line.trim_start().len();
            let hang = second_column(line).filter(|column| *column <= self.width * 2 / 5).unwrap_or(indent + 2);
            let hang = hang.min(self.width / 2);
            let Some(gap) = gap(line, indent, self.width) else {
                return;
            };
            let gap = self.line + gap.start..self.line + gap.end;
            let break_ = format!("\n{:hang$}", "");
            let moved = |at: usize| if at >= gap.end { at + break_.len() - gap.len() } else { at };
            for (range, _) in &mut self.marks {
                *range = moved(range.start)..moved(range.end);
            }
            self.line = gap.start + 1;
            self.text.replace_range(gap, &break_);
            // A word longer than the room that there is stays whole.
            if self.text[self.line..].trim_start().find(' ').is_none() {
                return;
            }
        }
    }
}

/// The column where the second word after two or more spaces begins.
fn second_column(line: &str) -> Option<usize> {
    let start = line.len() - line.trim_start().len();
    let gap = start + line[start..].find("  ")?;
    Some(line[..gap].chars().count() + line[gap..].len() - line[gap..].trim_start().len())
}

/// The spaces of a line at which it is broken to fit: the last that do, or the first that there are.
fn gap(line: &str, indent: usize, width: usize) -> Option<Range<usize>> {
    let (mut last, mut column, mut at) = (None, indent, indent);
    while let Some(space) = line[at..].find(' ') {
        let start = at + space;
        column += line[at..start].chars().count();
        let length = line[start..].len() - line[start..].trim_start().len();
        if column > width && last.is_some() {
            break;
        }
        last = Some(start..start + length);
        (at, column) = (start + length, column + length);
    }
    last
}

/// The words of a text in lines of at most `width` columns, as far as words are no longer.
fn lines(text: &str, width: usize) -> Vec<String> {
    let (mut lines, mut column): (Vec<String>, usize) = (Vec::new(), 0);
    for word in text.split_whitespace() {
        let length = word.chars().count();
        match lines.last_mut().filter(|_| column + 1 + length <= width) {
            Some(line) => {
                line.push(' ');
                line.push_str(word);
                column += 1 + length;
            }
            None => {
                lines.push(word.to_owned());
                column = length;
            }
        }
    }
    if lines.is_empty() {
        lines.push(String::new());
    }
    lines
}

/// A column of a table.
#[derive(Clone, Copy, Debug)]
pub struct Column {
    /// Its head.
    pub head: &'static str,
    /// Spaces before it, where there is room.
    pub gap: usize,
    /// The fewest columns that it takes, where there is room.
    pub least: usize,
    /// Whether its cells begin, and not end, under each other.
    pub left: bool,
}

impl Column {
    /// Cells that begin under each other.
    pub const fn left(head: &'static str, gap: usize, least: usize) -> Self {
        Self { head, gap, least, left: true }
    }

    /// Cells that end under each other.
    pub const fn right(head: &'static str, least: usize) -> Self {
        Self { head, gap: 0, least, left: false }
    }
}

/// A cell, with what it is.
#[derive(Clone, Debug)]
pub struct Cell(pub String, pub Option<Mark>);

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self(text, None)
    }
}

/// A table that is laid out for the room that there is.
#[derive(Clone, Debug)]
pub struct Table<const N: usize> {
    /// Its columns.
    pub columns: [Column; N],
    /// Its rows.
    pub rows: Vec<[Cell; N]>,
}

impl<const N: usize> Table<N> {
    /// The least room in which the last column's words are folded.
    const NARROWEST: usize = 18;

    /// Writes it: with its gaps, or close together, or, where even that does not fit, row by row with a line for each cell.
    pub fn write(&self, page: &mut Page) -> fmt::Result {
        let natural: [usize; N] = std::array::from_fn(|index| {
            let cells = self.rows.iter().map(|row| row[index].0.chars().count());
            cells.chain([self.columns[index].head.chars().count()]).max().unwrap_or(0)
        });
        let wide: [(usize, usize); N] =
            std::array::from_fn(|index| (self.columns[index].gap, natural[index].max(self.columns[index].least)));
        let close: [(usize, usize); N] = std::array::from_fn(|index| (2, natural[index]));
        let fits = |layout: &[(usize, usize); N], last: usize| {
            let before: usize = layout[..N - 1].iter().map(|(gap, width)| gap + width).sum();
            before + layout[N - 1].0 + last <= page.width
        };
        let last = natural[N - 1];
        // Words may be folded, numbers not.
        let folded = if self.columns[N - 1].left { last.min(Self::NARROWEST) } else { last };
        let layouts = [(wide, last), (close, last), (wide, folded), (close, folded)];
        match layouts.iter().find(|(layout, last)| fits(layout, *last)) {
            Some((layout, _)) => self.side_by_side(page, layout),
            None => self.stacked(page),
        }
    }

    fn side_by_side(&self, page: &mut Page, layout: &[(usize, usize); N]) -> fmt::Result {
        let heads = self.columns.map(|column| Cell(column.head.to_owned(), None));
        for (number, row) in std::iter::once(&heads).chain(&self.rows).enumerate() {
            if number == 0 && row.iter().all(|cell| cell.0.is_empty()) {
                continue;
            }
            let mut column = 0;
            for (index, Cell(text, mark)) in row.iter().enumerate() {
                let (gap, width) = layout[index];
                let space = width.saturating_sub(text.chars().count());
                let is_last = index == N - 1;
                let before = gap + if self.columns[index].left { 0 } else { space };
                write!(page, "{:before$}", "")?;
                column += before;
                let hang = column;
                let room = page.width.saturating_sub(hang).max(1);
                let pieces = if is_last && self.columns[index].left { lines(text, room) } else { vec![text.clone()] };
                for (part, words) in pieces.iter().enumerate() {
                    if part > 0 {
                        write!(page, "\n{:hang$}", "")?;
                    }
                    match mark {
                        Some(mark) if !words.is_empty() => page.marked(*mark, words),
                        _ => page.write_str(words)?,
                    }
                }
                column += text.chars().count();
                if self.columns[index].left && !is_last {
                    write!(page, "{:space$}", "")?;
                    column += space;
                }
            }
            // Spaces at the end of a line are none.
            let kept = page.text.trim_end_matches(' ').len();
            page.text.truncate(kept);
            writeln!(page)?;
        }
        Ok(())
    }

    fn stacked(&self, page: &mut Page) -> fmt::Result {
        let longest = self.columns.iter().map(|column| column.head.chars().count()).max().unwrap_or(0);
        for (number, row) in self.rows.iter().enumerate() {
            if number > 0 {
                writeln!(page)?;
            }
            for (column, Cell(text, mark)) in self.columns.iter().zip(row).filter(|(_, cell)| !cell.0.is_empty()) {
                match column.head {
                    // The number of a row heads it.
                    "" => write!(page, "  ")?,
                    head => write!(page, "  {head:<longest$}  ")?,
                }
                match mark {
                    Some(mark) => page.marked(*mark, text),
                    None => page.write_str(text)?,
                }
                writeln!(page)?;
            }
        }
        Ok(())
    }
}

/// What a verdict's name is.
pub(crate) fn mark(verdict: &str) -> Mark {
    match verdict {
        "holds" => Mark::Good,
        "misprint" => Mark::Doubtful,
        "refuted" => Mark::Bad,
        _ => Mark::Open,
    }
}

/// A number with so many significant digits, without trailing zeros.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() || value == 0.0 {
        return format!("{value:.0}");
    }
    let places = (digits as f64 - 1.0 - value.abs().log10().floor()).clamp(0.0, digits as f64) as usize;
    let text = format!("{value:.places$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text.trim_matches(['-', '0', '.']).is_empty() { "0".into() } else { text.into() }
}
