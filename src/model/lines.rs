//! Lines, cells and numbers in the text of a table of lifts.

use std::borrow::Cow;
use std::iter;

use serde::Serialize;

use super::ModelError;
use super::heading::{Heading, Kind};
use super::table_units::AngleUnit;

/// Quantities in the two columns of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[doc(hidden)]
pub enum Holds {
    /// Lifts over the cam angle.
    Lifts,
    /// Radii of a contour over their polar angle.
    Radii,
    /// Points of a contour, x and y.
    Points,
}

impl Holds {
    /// Names of the columns in a header.
    pub(super) fn columns(self) -> [&'static str; 2] {
        match self {
            Self::Lifts => ["angle_deg", "lift"],
            Self::Radii => ["angle_deg", "radius"],
            Self::Points => ["x", "y"],
        }
    }

    /// An example of a header.
    pub(super) fn header(self) -> String {
        self.columns().join(",")
    }

    /// Names of the columns in a sentence.
    pub(super) fn named(self) -> [&'static str; 2] {
        match self {
            Self::Lifts => ["the angle", "the lift"],
            Self::Radii => ["the angle", "the radius"],
            Self::Points => ["x", "y"],
        }
    }

    /// Fields of a model that choose the columns.
    pub(super) fn choices(self) -> [&'static str; 2] {
        match self {
            Self::Lifts => ["angle_column", "lift_column"],
            Self::Radii => ["angle_column", "radius_column"],
            Self::Points => ["x_column", "y_column"],
        }
    }

    /// Name of the quantity of the rows as a function of the angle.
    pub fn value(self) -> &'static str {
        if self == Self::Lifts { "lift" } else { "radius" }
    }

    /// Plural of the quantity's name.
    pub fn values(self) -> &'static str {
        if self == Self::Lifts { "lifts" } else { "radii" }
    }
}

/// Table that is being read, with the information for error messages.
pub(super) struct Table<'a> {
    pub(super) holds: Holds,
    /// Whether a header may name x and y instead.
    pub(super) may_be_points: bool,
    pub(super) file: String,
    pub(super) text: &'a str,
    /// Whether error messages name rows by their lines in the text; otherwise by their numbers.
    pub(super) has_lines: bool,
    /// Unit in which error messages name angles, as the table does; rows have them in degrees of the cam.
    pub(super) angles: AngleUnit,
    /// Whether the text names that unit.
    pub(super) says_angles: bool,
}

/// Separator of the columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[doc(hidden)]
pub enum Separator {
    /// Comma
    Comma,
    /// Semicolon
    Semicolon,
    /// Tabulator.
    Tab,
    /// Vertical bar
    Bar,
    /// Spaces.
    Blanks,
}

/// Text without the quotes around it.
fn unquoted(text: &str) -> &str {
    let text = text.trim();
    let inside = |quote| text.strip_prefix(quote)?.strip_suffix(quote);
    inside('"').or_else(|| inside('\'')).map_or(text, str::trim)
}

/// Rewrites a number for Rust's parser: with a decimal point, Fortran's exponent as `e`, a minus sign as a hyphen, and without apostrophes
/// or blanks between thousands.
pub(super) fn decimal(text: &str, decimal_comma: bool) -> Cow<'_, str> {
    if text.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte)) {
        return Cow::Borrowed(text);
    }
    let letter = |letter| match letter {
        ',' if decimal_comma => '.',
        'd' | 'D' => 'e',
        '\u{2212}' | '–' => '-',
        // A cell contains a blank only if blanks do not separate the columns.
        '’' | ' ' | '\u{a0}' | '\u{2009}' | '\u{202f}' => '\'',
        letter => letter,
    };
    let text: String = text.chars().map(letter).collect();
    let is_number = |group: &str| group.bytes().all(|digit| digit.is_ascii_digit());
    let mut groups = text.split(['\'', '.']).take(1 + text.matches('\'').count());
    let first = groups.next().unwrap_or_default().trim_start_matches(['+', '-']);
    let are_thousands =
        (1..=3).contains(&first.len()) && is_number(first) && groups.all(|group| group.len() == 3 && is_number(group));
    Cow::Owned(if are_thousands { text.replace('\'', "") } else { text })
}

pub(super) fn number(text: &str, decimal_comma: bool) -> Option<f64> {
    decimal(text, decimal_comma).parse().ok().filter(|number: &f64| number.is_finite())
}

impl Separator {
    /// Finds the separator of a line of numbers.
    pub(super) fn of(line: &str) -> Self {
        // Text in quotes is one cell.
        let outside = line.split('"').enumerate().map(|(part, text)| if part % 2 == 0 { text } else { "0" });
        let line: String = outside.collect();
        let mut numbers = line.split_whitespace();
        // A decimal comma is between two digits; in `0 ,15` the comma separates the columns.
        let is_number = |text: &str| {
            text.matches(',').count() < 2
                && number(text, true).is_some()
                && !text.starts_with(',')
                && !text.ends_with(',')
        };
        if line.contains(';') {
            Self::Semicolon
        } else if line.contains('\t') {
            Self::Tab
        } else if line.contains('|') {
            Self::Bar
        } else if !line.contains(',') || line.trim().contains(char::is_whitespace) && numbers.all(is_number) {
            Self::Blanks
        } else {
            Self::Comma
        }
    }

    /// Cells of a line, without quotes.
    pub(super) fn cells(self, line: &str) -> impl Iterator<Item = &str> {
        // If usual blanks separate the columns, a thin or non-breaking one separates thousands.
        let is_typed = line.trim().contains([' ', '\t']);
        let parts = move |letter: char| match self {
            Self::Comma => letter == ',',
            Self::Semicolon => letter == ';',
            Self::Tab => letter == '\t',
            Self::Bar => letter == '|',
            Self::Blanks => letter.is_whitespace() && !(is_typed && "\u{a0}\u{2009}\u{202f}".contains(letter)),
        };
        let trimmed = match self {
            // Tabs separate the cells, and the first cell may be empty.
            Self::Tab => line.trim_matches(' '),
            Self::Bar => line.trim().trim_start_matches('|').trim_end_matches('|'),
            _ => line.trim(),
        };
        let mut rest = Some(trimmed);
        iter::from_fn(move || {
            let text = rest?;
            let (mut is_quoted, may_be_quoted) = (false, text.trim_start().starts_with('"'));
            let end = text.char_indices().find(|&(at, letter)| {
                is_quoted ^= may_be_quoted && letter == '"';
                // A unit in brackets belongs to the name before it, if there is one.
                let is_unit = || {
                    let [before, behind] = [text, &text[at..]].map(|text| text.trim_start().starts_with(['[', '(']));
                    let count = |brackets: [char; 2]| text[..at].matches(brackets).count();
                    self == Self::Blanks && (behind && !before || count(['[', '(']) > count([']', ')']))
                };
                !is_quoted && parts(letter) && !is_unit()
            });
            let (cell, after) = match end {
                Some((at, letter)) => (&text[..at], Some(&text[at + letter.len_utf8()..])),
                None => (text, None),
            };
            rest = if self == Self::Blanks { after.map(str::trim_start) } else { after };
            Some(unquoted(cell))
        })
    }
}

impl Separator {
    /// Cells of a line up to the last that is not empty.
    pub(super) fn filled_cells(self, line: &str) -> Vec<&str> {
        let mut cells: Vec<&str> = self.cells(line).collect();
        cells.truncate(cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1));
        cells
    }

    /// Cells of a line above `width` columns. Its separator may differ from the rows': two blanks, a sign, or a unit after each name.
    pub(super) fn names(self, line: &str, width: usize) -> Vec<String> {
        let wide: Vec<&str> = line.split("  ").flat_map(|part| part.split('\t')).map(unquoted).collect();
        let wide = wide.into_iter().filter(|cell| !cell.is_empty()).collect();
        let mut ways = vec![self.filled_cells(line)];
        ways.insert(if self == Self::Blanks { 0 } else { 1 }, wide);
        ways.extend([Self::Semicolon, Self::Comma, Self::Bar].map(|other| other.filled_cells(line)));
        let own = ways[usize::from(self == Self::Blanks)].clone();
        let is_pairs = |cells: &&Vec<&str>| {
            cells.len() == 2 * width && cells.iter().skip(1).step_by(2).all(|cell| Heading::of(cell).is_unit)
        };
        if let Some(cells) = ways.iter().find(|cells| cells.len() == width && width > 1) {
            return cells.iter().map(|cell| (*cell).to_owned()).collect();
        }
        if let Some(cells) = ways.iter().find(is_pairs) {
            return cells.chunks(2).map(|pair| pair.join(" ")).collect();
        }
        own.into_iter().map(str::to_owned).collect()
    }
}

/// Marks of comments; a line may begin with `*`, too.
const MARKS: [&str; 3] = ["#", "%", "//"];

/// Splits a line into its content and its comment.
pub(super) fn without_comment(line: &str) -> (&str, Option<&str>) {
    if line.trim_start().starts_with('*') {
        return ("", Some(line));
    }
    // A percent sign is a unit unless it begins a line or follows a number.
    let is_mark = |at: usize, mark: &str| {
        let before = line[..at].trim_end();
        mark != "%" || before.is_empty() || before.ends_with(|letter: char| letter.is_ascii_digit() || letter == '.')
    };
    let first = |mark: &&str| line.match_indices(*mark).map(|(at, _)| at).find(|at| is_mark(*at, mark));
    let at = MARKS.iter().filter_map(first).min();
    // In `Pt #,Angle` and `Pt #  Angle` the sign belongs to the name, and in `Angle,#` it is a name.
    let is_name = |at: usize| {
        const PARTS: [char; 4] = [',', ';', '\t', '|'];
        let (before, behind) = (line[..at].trim_end_matches(' '), line[at + 1..].trim_start_matches(' '));
        let word = before.rsplit(char::is_whitespace).next().unwrap_or_default();
        word.contains(char::is_alphabetic)
            && (behind.starts_with(PARTS)
                || behind.is_empty() && before.ends_with(PARTS)
                || line[at + 1..].starts_with("  ") && Heading::of(word).kind == Kind::Other)
    };
    match at {
        Some(at) if !is_name(at) => (line[..at].trim_end(), Some(&line[at..])),
        _ => (line.trim_end(), None),
    }
}

/// Whether a line has at least two numbers, and more numbers than words.
pub(super) fn has_numbers(line: &str) -> bool {
    let parts = line.split(|letter: char| letter.is_whitespace() || ",;|\"°".contains(letter));
    let (numbers, all) = parts
        .filter(|part| !part.is_empty())
        .fold((0, 0), |(numbers, all), part| (numbers + usize::from(number(part, false).is_some()), all + 1));
    numbers >= 2 && 2 * numbers > all
}

/// Whether a line is only a rule between others, as in a table of Markdown.
pub(super) fn is_rule(line: &str) -> bool {
    line.contains(['-', '=']) && line.chars().all(|letter| "|-:+= ".contains(letter))
}

impl Table<'_> {
    pub(super) fn reject(&self, line: usize, column: &str, value: &str, allowed: String) -> ModelError {
        let (field, written) = (Some(column.into()), Some(value.into()));
        let complaint = ModelError { field, value: written, ..self.complain(Some(line), allowed) };
        complaint.in_line(self.text, Some(value))
    }

    pub(super) fn complain(&self, line: Option<usize>, allowed: String) -> ModelError {
        let line = line.filter(|_| self.has_lines);
        ModelError { line, ..ModelError::file(&self.file, allowed) }.in_line(self.text, None)
    }
}
