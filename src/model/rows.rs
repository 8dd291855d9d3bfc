//! The text of a table of lifts: its column separator, its header, and its numbers row by row.

use std::borrow::Cow;

use serde::Serialize;

use super::ModelError;
use super::units::{LENGTHS, Unit};

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TableRow {
    /// Cam angle, degrees.
    pub angle_deg: f64,
    /// Lift, m.
    pub lift: f64,
    /// Line in the file, from 1; for rows that came without a file, the row's number.
    pub line: usize,
}

/// A table while it is read; complaints use it.
pub(super) struct Table<'a> {
    pub(super) file: String,
    pub(super) text: &'a str,
    /// Whether complaints name rows by their lines in the text; otherwise by their numbers.
    pub(super) has_lines: bool,
    /// Whether complaints name angles in radians, as the table does; rows have them in degrees.
    pub(super) in_radians: bool,
}

/// Separator of the columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[doc(hidden)]
pub enum Separator {
    /// ","
    Comma,
    /// ";"
    Semicolon,
    /// A tabulator.
    Tab,
    /// Spaces.
    Blanks,
}

/// Layout of a text.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[doc(hidden)]
pub struct TableLayout {
    /// Separator of the columns.
    pub separator: Separator,
    /// Whether numbers have a decimal comma.
    pub decimal_comma: bool,
    /// Number of lines with a comment.
    pub comments: usize,
    /// The line that names the columns.
    pub header: Option<String>,
    /// Whether the header gives angles in radians; `None` where it names no unit.
    #[serde(skip)]
    pub radians: Option<bool>,
    /// Unit of lifts that the header names, by its index in the table of lengths.
    #[serde(skip)]
    pub length: Option<usize>,
}

/// Most rows: more would be finer than any cam is made or measured.
pub(super) const MOST_ROWS: usize = 1_000_000;
/// Example of a header line, for complaints.
const HEADER: &str = "angle_deg,lift";
/// Names of the first column.
const ANGLES: [&str; 12] =
    ["angle", "angles", "theta", "θ", "phi", "φ", "alpha", "rotation", "winkel", "drehwinkel", "cam", "crank"];
/// "Grad" is German; a turn of 400 of them is refused by its rows.
const DEGREES: [&str; 5] = ["deg", "degree", "degrees", "°", "grad"];
const RADIANS: [&str; 3] = ["rad", "radian", "radians"];

impl Separator {
    /// Separator of a line of two numbers.
    fn of(line: &str) -> Self {
        let numbers: Vec<&str> = line.split_whitespace().collect();
        // A decimal comma is between two digits; in `0 ,15` the comma separates the columns.
        let is_number = |text: &&str| {
            text.replacen(',', ".", 1).parse::<f64>().is_ok() && !text.starts_with(',') && !text.ends_with(',')
        };
        if line.contains(';') {
            Self::Semicolon
        } else if line.contains('\t') {
            Self::Tab
        } else if numbers.len() == 2 && numbers.iter().all(is_number) || !line.contains(',') {
            Self::Blanks
        } else {
            Self::Comma
        }
    }

    /// Splits a line into two columns, the second with all that follows.
    fn columns(self, line: &str) -> Option<[&str; 2]> {
        let at = match self {
            Self::Comma => line.split_once(','),
            Self::Semicolon => line.split_once(';'),
            Self::Tab => line.split_once('\t'),
            // A unit in brackets belongs to the name before it.
            Self::Blanks => {
                let is_parted = |at: &usize| !line[*at..].trim_start().starts_with(['[', '(']);
                let at = line.match_indices(char::is_whitespace).map(|(at, _)| at).find(is_parted);
                at.map(|at| line.split_at(at))
            }
        };
        let last = if self == Self::Semicolon { ";" } else { "\t" };
        at.map(|(one, two)| [one.trim(), two.trim().trim_end_matches(last).trim()])
    }
}

/// Words of a header's cell, in lower case.
fn words(cell: &str) -> Vec<String> {
    let parts = cell.split(|letter: char| !letter.is_alphanumeric() && letter != '°');
    parts.filter(|word| !word.is_empty()).map(str::to_lowercase).collect()
}

/// Units in a header line: whether angles are in radians, and the unit of lifts by its index in the table of lengths.
fn header([angle, lift]: [&str; 2]) -> Option<(Option<bool>, Option<usize>)> {
    let (angle, lift) = (words(angle), words(lift));
    let has = |cell: &[String], names: &[&str]| cell.iter().any(|word| names.contains(&word.as_str()));
    let (degrees, radians) = (has(&angle, &DEGREES), has(&angle, &RADIANS));
    if !(degrees || radians || has(&angle, &ANGLES)) || lift.is_empty() || has(&lift, &ANGLES) {
        return None;
    }
    let is_unit = |name: &str| lift.iter().skip(usize::from(lift.len() > 1)).any(|word| word == name);
    let length = LENGTHS.iter().position(|unit| is_unit(unit.name()) || unit.name() == "um" && is_unit("µm"));
    Some(((degrees || radians).then_some(radians), length))
}

/// Text between brackets in a header's cell, in lower case.
fn bracketed(cell: &str) -> Option<String> {
    let (_, inside) = cell.split_once(['[', '('])?;
    Some(inside.split([']', ')']).next().unwrap_or_default().trim().to_lowercase())
}

/// The line without its comment, and whether it had one.
fn without_comment(line: &str) -> (&str, bool) {
    let at = ["#", "%", "//"].iter().filter_map(|mark| line.find(mark)).min();
    at.map_or((line.trim(), false), |at| (line[..at].trim(), true))
}

impl Table<'_> {
    /// Refuses an unknown unit in brackets, which would otherwise be taken for another one.
    fn known_unit(&self, line: usize, cell: &str, column: &str) -> Result<(), ModelError> {
        let lengths: Vec<&str> = LENGTHS.iter().map(Unit::name).collect();
        let (units, field) = if column == "angle" { (vec!["deg", "rad"], "angle_unit") } else { (lengths, "unit") };
        let is_known = |unit: &str| match column {
            "angle" => DEGREES.contains(&unit) || RADIANS.contains(&unit),
            _ => units.contains(&unit) || unit == "µm",
        };
        match bracketed(cell) {
            Some(unit) if !is_known(&unit) => Err(self.reject(
                line,
                "header",
                cell,
                format!(
                    "the unit of the {column} must be one of: {}; or leave this line out, and say it in [cam], by {field}",
                    units.join(", ")
                ),
            )),
            _ => Ok(()),
        }
    }

    pub(super) fn reject(&self, line: usize, column: &str, value: &str, allowed: String) -> ModelError {
        let (field, written) = (Some(column.into()), Some(value.into()));
        let complaint = ModelError { field, value: written, ..self.complain(Some(line), allowed) };
        complaint.in_line(self.text, Some(value))
    }

    pub(super) fn complain(&self, line: Option<usize>, allowed: String) -> ModelError {
        let line = line.filter(|_| self.has_lines);
        ModelError { line, ..ModelError::file(&self.file, allowed) }.in_line(self.text, None)
    }

    /// Angle and lift of the row in a line, as written except for the decimal point.
    pub(super) fn cells(&self, layout: &TableLayout, line: usize) -> Option<[String; 2]> {
        let (text, _) = without_comment(self.text.lines().nth(line.checked_sub(1)?)?);
        let cells = layout.separator.columns(text)?;
        Some(cells.map(|cell| if layout.decimal_comma { cell.replace(',', ".") } else { cell.to_owned() }))
    }

    /// Reads the rows of the text and its layout.
    pub(super) fn rows(&self) -> Result<(Vec<TableRow>, TableLayout), ModelError> {
        let lines = || self.text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
        let filled =
            || lines().map(|(line, text)| (line, without_comment(text).0)).filter(|(_, text)| !text.is_empty());
        let comments = lines().filter(|(_, text)| without_comment(text).1).count();
        let Some((first_line, first)) = filled().next() else {
            return Err(self.complain(None, format!("is empty; its first line must be {HEADER}")));
        };
        let is_numeric =
            |text: &str| text.starts_with(|letter: char| letter.is_ascii_digit() || "+-.".contains(letter));
        let numbers = filled().map(|(_, text)| text).find(|text| is_numeric(text));
        // If the row is one number without a separator, the header decides.
        let is_one = |text: &&str| !text.contains([',', ';']) && !text.contains(char::is_whitespace);
        let separator = Separator::of(numbers.filter(|text| !is_one(text)).unwrap_or(first));
        let has_header = !is_numeric(first);
        let named = separator.columns(first).and_then(header).filter(|_| has_header);
        if has_header && named.is_none() {
            let allowed = format!("must name the angle, then the lift, as {HEADER} does, with their units or without");
            return Err(self.reject(first_line, "header", first, allowed));
        }
        for (cell, column) in
            separator.columns(first).filter(|_| has_header).into_iter().flatten().zip(["angle", "lift"])
        {
            self.known_unit(first_line, cell, column)?;
        }
        let mut layout = TableLayout {
            separator,
            decimal_comma: false,
            comments,
            header: has_header.then(|| first.to_owned()),
            radians: named.and_then(|named| named.0),
            length: named.and_then(|named| named.1),
        };
        let mut rows: Vec<TableRow> = Vec::new();
        let mut point = None;
        for (line, text) in filled().skip(usize::from(has_header)) {
            let Some(cells) = separator.columns(text) else {
                return Err(self.reject(line, "row", text, format!("must be two numbers: {HEADER}")));
            };
            if separator != Separator::Comma {
                point = point.or(cells.iter().any(|cell| cell.contains('.')).then_some(line));
                layout.decimal_comma |= cells.iter().any(|cell| cell.contains(','));
            }
            if let Some(other) = point.filter(|_| layout.decimal_comma) {
                let words = format!(
                    "must have one kind of decimals: there is a comma here or before, and a point on line {other}"
                );
                return Err(self.reject(line, "row", text, words));
            }
            let number = |column: &str, text: &str| {
                let written =
                    if layout.decimal_comma { Cow::Owned(text.replace(',', ".")) } else { Cow::Borrowed(text) };
                let number = written.parse().ok().filter(|number: &f64| number.is_finite());
                number.ok_or_else(|| self.reject(line, column, text, "must be a finite number".into()))
            };
            let angle_deg = number("angle_deg", cells[0])?;
            let lift = number("lift", cells[1])?;
            if rows.len() == MOST_ROWS {
                return Err(self.complain(Some(line), format!("more than {MOST_ROWS} rows")));
            }
            rows.push(TableRow { angle_deg, lift, line });
        }
        Ok((rows, layout))
    }
}
