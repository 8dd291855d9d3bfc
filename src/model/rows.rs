//! The text of a table of lifts: its lines, its columns and their units, and its numbers row by row.
//!
//! The order of detection: the first line with numbers tells the separator. Of the lines above it, the last that names an angle and a lift is the
//! header; a line of units may follow it, and what is above it are titles. The header chooses the columns, unless the model does.

use std::borrow::Cow;
use std::iter;

use serde::Serialize;

use super::ModelError;
use super::fields::{Fields, Value};
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
    /// Unit in which complaints name angles, as the table does; rows have them in degrees of the cam.
    pub(super) angles: AngleUnit,
}

/// Unit of the angles of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct AngleUnit {
    /// Index in the names of the units.
    pub(super) index: usize,
    /// Degrees of the table in one turn of the cam: 720 for those of a crank.
    pub(super) turn_deg: f64,
}

impl AngleUnit {
    pub(super) const DEGREES: Self = Self { index: 0, turn_deg: 360.0 };
    /// Names in a model file.
    pub(super) const NAMES: [&'static str; 3] = ["deg", "rad", "turn"];

    pub(super) fn name(self) -> &'static str {
        Self::NAMES[self.index]
    }

    /// Whether numbers of the table are degrees of the cam.
    pub(super) fn is_of_cam(self) -> bool {
        self == Self::DEGREES
    }

    /// Degrees of the cam of an angle as written.
    pub(super) fn degrees(self, angle: f64) -> f64 {
        let degrees = match self.index {
            0 => angle,
            1 => angle.to_degrees(),
            _ => 360.0 * angle,
        };
        if self.turn_deg == 360.0 { degrees } else { degrees * 360.0 / self.turn_deg }
    }

    /// An angle, degrees of the cam, as the table has it, to the digits that survive a conversion there and back.
    pub(super) fn told(self, angle_deg: f64) -> f64 {
        if self.is_of_cam() {
            return angle_deg;
        }
        let degrees = angle_deg * self.turn_deg / 360.0;
        let angle = match self.index {
            0 => degrees,
            1 => degrees.to_radians(),
            _ => degrees / 360.0,
        };
        format!("{angle:.14e}").parse().unwrap_or(angle)
    }
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
    /// "|"
    Bar,
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
    /// A number whose comma may part thousands, where three digits follow every comma.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thousands: Option<String>,
    /// Number of lines with a comment.
    pub comments: usize,
    /// Lines above the header, or above the rows where there is none.
    pub titles: usize,
    /// The line that names the columns.
    pub header: Option<String>,
    /// Columns of the angle and of the lift, from 1.
    pub columns: [usize; 2],
    /// The other columns: their names, or their numbers where there is no header.
    pub left_out: Vec<String>,
    /// Unit of angles that the header names, by its index in [`AngleUnit::NAMES`].
    #[serde(skip)]
    pub angle: Option<usize>,
    /// Unit of lifts that the header names, by its index in the table of lengths.
    #[serde(skip)]
    pub length: Option<usize>,
    /// Line of a title, and a unit of length in it that no column is said to be in.
    #[serde(skip)]
    pub unread: Option<(usize, String)>,
}

/// Column that a model chooses.
pub(super) enum Chosen {
    /// By its number, from 1.
    Number(usize),
    /// By its name in the header.
    Name(String),
}

impl Chosen {
    /// Reads `cam.angle_column` or `cam.lift_column`.
    pub(super) fn read(fields: &mut Fields, path: &str) -> Result<Option<Self>, ModelError> {
        fields.may_hold(path);
        match fields.fields.get(path).map(|field| &field.value) {
            None => Ok(None),
            Some(Value::Text(_)) => Ok(Some(Self::Name(fields.text(path)?))),
            Some(Value::Number(number)) if *number >= 1.0 && *number <= MOST_COLUMNS && number.fract() == 0.0 => {
                Ok(Some(Self::Number(*number as usize)))
            }
            Some(_) => Err(fields.reject(path, "must be the name of a column in quotes, or its number from 1")),
        }
    }
}

/// Most rows: more would be finer than any cam is made or measured.
pub(super) const MOST_ROWS: usize = 1_000_000;
/// Largest number of a column.
const MOST_COLUMNS: f64 = 1e6;
/// Example of a header line, for complaints.
const HEADER: &str = "angle_deg,lift";
/// Words of a column of angles.
const ANGLES: [&str; 13] = [
    "angle",
    "angles",
    "theta",
    "θ",
    "phi",
    "φ",
    "alpha",
    "rotation",
    "winkel",
    "drehwinkel",
    "cam",
    "crank",
    "camshaft",
];
/// Words of a column of lifts.
const LIFTS: [&str; 9] = ["lift", "lifts", "hub", "ventilhub", "rise", "displacement", "displ", "height", "stroke"];
/// Words of columns of something else.
const OTHERS: [&str; 27] = [
    "velocity",
    "vel",
    "v",
    "speed",
    "acceleration",
    "accel",
    "acc",
    "a",
    "jerk",
    "force",
    "load",
    "curvature",
    "time",
    "t",
    "no",
    "nr",
    "row",
    "index",
    "idx",
    "n",
    "point",
    "pt",
    "station",
    "geschwindigkeit",
    "beschleunigung",
    "rpm",
    "pressure",
];
/// Words of a column of radii, which are the cam's own.
const RADII: [&str; 5] = ["radius", "radii", "radial", "polar", "r"];
/// Words of the units of angles, in the order of [`AngleUnit::NAMES`]. "Grad" is German; a turn of 400 of them is refused by its rows.
const ANGLE_UNITS: [&[&str]; 3] = [
    &["deg", "degs", "degree", "degrees", "°", "grad"],
    &["rad", "rads", "radian", "radians"],
    &["turn", "turns", "rev", "revs", "revolution", "revolutions"],
];
/// Words of the units of lifts, in the order of the table of lengths.
const LENGTH_UNITS: [&[&str]; 7] = [
    &["m", "metre", "metres", "meter", "meters"],
    &["cm", "centimetre", "centimetres", "centimeter", "centimeters"],
    &["mm", "millimetre", "millimetres", "millimeter", "millimeters"],
    &["um", "µm", "μm", "micron", "microns", "micrometre", "micrometres", "micrometer", "micrometers"],
    &["in", "inch", "inches", "zoll"],
    &["ft", "foot", "feet"],
    &["thou", "thous", "mil", "mils"],
];
/// Words of units that no column of a table is read in.
const UNKNOWN_UNITS: [&str; 12] =
    ["km", "dm", "nm", "pm", "yd", "yard", "yards", "gon", "gons", "mrad", "arcmin", "arcsec"];

/// Text without the quotes around it.
fn unquoted(text: &str) -> &str {
    let text = text.trim();
    text.strip_prefix('"').and_then(|text| text.strip_suffix('"')).map_or(text, str::trim)
}

/// Reads a number, with a decimal comma or with an exponent of Fortran; its text as Rust reads it.
fn decimal(text: &str, decimal_comma: bool) -> Cow<'_, str> {
    let is_fortran = text.contains(['d', 'D']);
    match decimal_comma || is_fortran {
        true => {
            let text = if decimal_comma { text.replace(',', ".") } else { text.to_owned() };
            Cow::Owned(if is_fortran { text.replace(['d', 'D'], "e") } else { text })
        }
        false => Cow::Borrowed(text),
    }
}

fn number(text: &str, decimal_comma: bool) -> Option<f64> {
    decimal(text, decimal_comma).parse().ok().filter(|number: &f64| number.is_finite())
}

impl Separator {
    /// Separator of a line of numbers.
    fn of(line: &str) -> Self {
        // What stands in quotes is one cell.
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
    fn cells(self, line: &str) -> impl Iterator<Item = &str> {
        let parts = move |letter: char| match self {
            Self::Comma => letter == ',',
            Self::Semicolon => letter == ';',
            Self::Tab => letter == '\t',
            Self::Bar => letter == '|',
            Self::Blanks => letter.is_whitespace(),
        };
        let trimmed = match self {
            // Tabs part the cells, of which the first may be empty.
            Self::Tab => line.trim_matches(' '),
            Self::Bar => line.trim().trim_start_matches('|').trim_end_matches('|'),
            _ => line.trim(),
        };
        let mut rest = Some(trimmed);
        iter::from_fn(move || {
            let text = rest?;
            let mut is_quoted = false;
            let end = text.char_indices().find(|&(at, letter)| {
                is_quoted ^= letter == '"';
                // A unit in brackets belongs to the name before it.
                let is_unit = || self == Self::Blanks && text[at..].trim_start().starts_with(['[', '(']);
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

/// Words of a header's cell, in lower case.
fn words(cell: &str) -> Vec<String> {
    let parts = cell.split(|letter: char| !letter.is_alphanumeric() && letter != '°');
    parts.filter(|word| !word.is_empty()).map(str::to_lowercase).collect()
}

/// Text between brackets in a header's cell, in lower case.
fn bracketed(cell: &str) -> Option<String> {
    let (_, inside) = cell.split_once(['[', '('])?;
    Some(inside.split([']', ')']).next().unwrap_or_default().trim().to_lowercase())
}

/// Index of a unit's word in a table of them.
fn unit_of(word: &str, table: &[&[&str]]) -> Option<usize> {
    table.iter().position(|names| names.contains(&word))
}

/// The unit that a header's cell names, by its index in a table of words; an error with the unit where it is none of them.
fn named_unit(cell: &str, table: &[&[&str]]) -> Result<Option<usize>, String> {
    if let Some(unit) = bracketed(cell) {
        return unit_of(&unit, table).map(Some).ok_or(unit);
    }
    let all = words(cell);
    let Some((last, before)) = all.split_last() else { return Ok(None) };
    // "in" before another word is no inch, and one letter may be the column's name.
    let is_name = |(place, word): (usize, &String)| match &**word {
        "in" => place + 1 < all.len(),
        word => word.chars().count() == 1 && place == 0 && !before.is_empty() && word != "°",
    };
    let named = all.iter().enumerate().rev().filter(|word| !is_name(*word)).find_map(|(_, word)| unit_of(word, table));
    // "lift in furlongs", "Hub / Elle"
    let is_unit =
        before.last().is_some_and(|word| word == "in") || cell.contains('/') || UNKNOWN_UNITS.contains(&last.as_str());
    match named {
        None if is_unit && !before.is_empty() => Err(last.clone()),
        named => Ok(named),
    }
}

/// Quantity in a column, by the words of its header.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Angle,
    Lift,
    /// A radius of the cam itself.
    Radius,
    /// Something else, which is left out.
    Other,
    Unknown,
}

impl Kind {
    fn of(cell: &str) -> Self {
        let all = words(cell);
        let has = |names: &[&str]| all.iter().any(|word| names.contains(&word.as_str()));
        // One letter is a name only where it is the first word.
        let begins = |names: &[&str]| all.first().is_some_and(|word| names.contains(&word.as_str()));
        let is_other = all.iter().any(|word| word.len() > 2 && OTHERS.contains(&word.as_str())) || begins(&OTHERS);
        if all.is_empty() || is_other {
            Self::Other
        } else if has(&LIFTS) {
            Self::Lift
        } else if all.iter().any(|word| word.len() > 1 && RADII.contains(&word.as_str())) || begins(&RADII) {
            Self::Radius
        } else if has(&ANGLES) || all.last().is_some_and(|word| unit_of(word, &ANGLE_UNITS).is_some()) {
            Self::Angle
        } else {
            Self::Unknown
        }
    }
}

/// Number of lines by which a text is taken for a table: titles may stand above its rows.
const FIRST_LINES: usize = 20;

/// The columns of a table, from 0, the angle's first.
type Columns = [usize; 2];

/// Titles, header and units above the rows.
#[derive(Default)]
struct Above<'a> {
    titles: usize,
    header: Option<String>,
    columns: Option<Columns>,
    /// Names of all columns.
    names: Vec<&'a str>,
    angle: Option<usize>,
    length: Option<usize>,
    unread: Option<(usize, String)>,
}

/// The line without its comment, and whether it had one.
fn without_comment(line: &str) -> (&str, bool) {
    let at = ["#", "%", "//"].iter().filter_map(|mark| line.find(mark)).min();
    match at {
        _ if line.trim_start().starts_with('*') => ("", true),
        Some(at) => (line[..at].trim_end(), true),
        None => (line.trim_end(), false),
    }
}

/// Whether a line has numbers, more of them than words.
fn has_numbers(line: &str) -> bool {
    let parts = line.split(|letter: char| letter.is_whitespace() || ",;|\"".contains(letter));
    let (numbers, all) = parts
        .filter(|part| !part.is_empty())
        .fold((0, 0), |(numbers, all), part| (numbers + usize::from(number(part, false).is_some()), all + 1));
    numbers >= 2 && 2 * numbers > all
}

/// Whether a line only rules off others, as in a table of Markdown.
fn is_rule(line: &str) -> bool {
    line.contains(['-', '=']) && line.chars().all(|letter| "|-:+= ".contains(letter))
}

/// Whether each cell of a line is a unit, an angle's and a lift's among them.
fn is_units(cells: &[&str]) -> bool {
    let units = || {
        cells
            .iter()
            .filter(|cell| !cell.is_empty())
            .map(|cell| cell.trim_matches(['[', ']', '(', ')']).trim().to_lowercase())
    };
    let has = |table: &[&[&str]]| units().any(|unit| unit_of(&unit, table).is_some());
    let all = |unit: String| {
        let first = unit.split(['/', '^']).next().unwrap_or_default().trim();
        unit_of(first, &ANGLE_UNITS).or(unit_of(first, &LENGTH_UNITS)).is_some()
            || ["-", "1", "n", "s"].contains(&first)
    };
    has(&ANGLE_UNITS) && has(&LENGTH_UNITS) && units().all(all)
}

impl<'a> Table<'a> {
    pub(super) fn reject(&self, line: usize, column: &str, value: &str, allowed: String) -> ModelError {
        let (field, written) = (Some(column.into()), Some(value.into()));
        let complaint = ModelError { field, value: written, ..self.complain(Some(line), allowed) };
        complaint.in_line(self.text, Some(value))
    }

    pub(super) fn complain(&self, line: Option<usize>, allowed: String) -> ModelError {
        let line = line.filter(|_| self.has_lines);
        ModelError { line, ..ModelError::file(&self.file, allowed) }.in_line(self.text, None)
    }

    /// Takes what a line has out of a complaint about a text that does not begin like a table: the model may name any file of its reader.
    pub(super) fn discreet(&self, complaint: ModelError, chosen: &[Option<Chosen>; 2]) -> ModelError {
        let mut first = self
            .text
            .lines()
            .map(|line| without_comment(line).0)
            .filter(|line| !line.trim().is_empty())
            .take(FIRST_LINES);
        let begins_like_table = first.any(|line| has_numbers(line) || self.is_header(line, chosen));
        if begins_like_table || complaint.pointer.text.is_none() {
            return complaint;
        }
        let words = format!(
            "is no table of lifts: none of its first {FIRST_LINES} lines has two numbers, or an angle and a lift as {HEADER}"
        );
        ModelError { line: complaint.line, ..ModelError::file(&self.file, words) }
    }

    /// Whether a line names an angle and a lift.
    fn is_header(&self, line: &str, chosen: &[Option<Chosen>; 2]) -> bool {
        let cells: Vec<&str> = Separator::of(line).cells(line).collect();
        self.named(&cells, chosen).is_ok_and(|columns| columns.is_some())
    }

    /// Angle and lift of the row in a line, as written except for the decimal point.
    pub(super) fn cells(&self, layout: &TableLayout, line: usize) -> Option<[String; 2]> {
        let (text, _) = without_comment(self.text.lines().nth(line.checked_sub(1)?)?);
        let cell = |column: usize| layout.separator.cells(text).nth(column - 1);
        let [angle, lift] = layout.columns.map(cell);
        Some([angle?, lift?].map(|cell| decimal(cell, layout.decimal_comma).into_owned()))
    }

    /// The columns that a header names; `None` if it is no header, an error if it leaves open which they are.
    fn named(&self, cells: &[&str], chosen: &[Option<Chosen>; 2]) -> Result<Option<Columns>, String> {
        let kinds: Vec<Kind> = cells.iter().map(|cell| Kind::of(cell)).collect();
        let by_choice = |chosen: &Option<Chosen>| match chosen {
            Some(Chosen::Number(number)) => Some((*number <= cells.len()).then(|| number - 1)),
            Some(Chosen::Name(name)) => {
                let is_it = |cell: &&str| {
                    let alone = cell.split(['[', '(']).next().unwrap_or_default().trim();
                    cell.to_lowercase() == name.to_lowercase() || alone.to_lowercase() == name.to_lowercase()
                };
                Some(cells.iter().position(is_it))
            }
            None => None,
        };
        let angle = match by_choice(&chosen[0]) {
            Some(found) => found,
            None => {
                let all: Vec<usize> = (0..cells.len()).filter(|column| kinds[*column] == Kind::Angle).collect();
                let of_cam = |column: &usize| words(cells[*column]).iter().any(|word| word.starts_with("cam"));
                let of_cam: Vec<usize> = all.iter().copied().filter(of_cam).collect();
                match (&all[..], &of_cam[..]) {
                    ([], _) => None,
                    ([one], _) | (_, [one]) => Some(*one),
                    _ => return Err("names several angles: say which in [cam], by angle_column".into()),
                }
            }
        };
        let Some(angle) = angle else { return Ok(None) };
        let lift = match by_choice(&chosen[1]) {
            Some(found) => found,
            None => {
                let of = |wanted: &[Kind]| -> Vec<usize> {
                    (0..cells.len()).filter(|column| *column != angle && wanted.contains(&kinds[*column])).collect()
                };
                match (&of(&[Kind::Lift])[..], &of(&[Kind::Unknown, Kind::Radius])[..]) {
                    ([one], _) | ([], [one]) => Some(*one),
                    ([], []) => None,
                    _ => return Err("leaves open which column is the lift: say which in [cam], by lift_column".into()),
                }
            }
        };
        let Some(lift) = lift else { return Ok(None) };
        if kinds[lift] == Kind::Radius && chosen[1].is_none() {
            let words = "names a radius, the cam's own, which is no follower's lift: give the lift; or lift_column in [cam], if it is a lift";
            return Err(words.into());
        }
        if lift == angle {
            return Err("is asked for the angle and for the lift in one column".into());
        }
        Ok(Some([angle, lift]))
    }

    /// Reads the rows of the text and its layout; `chosen` are the columns that the model chooses, the angle's first.
    pub(super) fn rows(&self, chosen: &[Option<Chosen>; 2]) -> Result<(Vec<TableRow>, TableLayout), ModelError> {
        let lines = || self.text.lines().enumerate().map(|(index, line)| (index + 1, line));
        let filled = || {
            lines()
                .map(|(line, text)| (line, without_comment(text).0))
                .filter(|(_, text)| !text.trim().is_empty() && !is_rule(text.trim()))
        };
        let comments = lines().filter(|(_, text)| without_comment(text).1).count();
        if filled().next().is_none() {
            return Err(self.complain(None, format!("is empty; its first line must be {HEADER}")));
        }
        // Spreadsheets are told the separator so.
        let said = filled().next().and_then(|(_, text)| match text.trim().to_lowercase().strip_prefix("sep=") {
            Some(";") => Some(Separator::Semicolon),
            Some(",") => Some(Separator::Comma),
            Some("|") => Some(Separator::Bar),
            Some("") | Some("\t") => Some(Separator::Tab),
            _ => None,
        });
        let filled = || filled().skip(usize::from(said.is_some()));
        let is_number = |text: &str| {
            text.trim_start()
                .trim_start_matches(['"', '|'])
                .trim_start()
                .starts_with(|letter: char| letter.is_ascii_digit() || "+-.".contains(letter))
        };
        // Below a header even a line without a number is a row, with a slip.
        let found =
            filled().position(|(_, text)| has_numbers(text)).or_else(|| filled().position(|(_, text)| is_number(text)));
        let found = found.or_else(|| Some(1 + filled().position(|(_, text)| self.is_header(text, chosen))?));
        let Some(found) = found else {
            return Err(
                self.complain(None, format!("is no table of lifts: no line has two numbers, as below {HEADER}"))
            );
        };
        let above: Vec<(usize, &str)> = filled().take(found).collect();
        let Some((_, first)) = filled().nth(found) else {
            return Err(self.complain(None, format!("has no rows below its header, as {HEADER}")));
        };
        // If the row is one number without a separator, the line above it decides.
        let is_one = !first.trim().contains(|letter: char| letter.is_whitespace() || ",;|".contains(letter));
        let shown = if is_one { above.last().map_or(first, |(_, text)| *text) } else { first };
        let separator = said.unwrap_or_else(|| Separator::of(shown));
        let cells = |text: &'a str| -> Vec<&'a str> {
            let mut cells: Vec<&str> = separator.cells(text).collect();
            cells.truncate(cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1));
            cells
        };
        let width = cells(first).len();
        // A slip in a first row makes it no title.
        let slips = above.iter().rev().take_while(|(_, text)| is_number(text) && cells(text).len() == width).count();
        let begins = found - slips;
        let above = self.above(&above[..begins], &cells, (width, chosen))?;
        let columns = match (above.columns, chosen) {
            (Some(columns), _) => columns,
            (None, [Some(Chosen::Number(angle)), Some(Chosen::Number(lift))]) => [angle - 1, lift - 1],
            (None, [None, None]) if width == 2 => [0, 1],
            (None, [Some(Chosen::Name(name)), _] | [_, Some(Chosen::Name(name))]) => {
                return Err(self.complain(None, format!("has no column that is named {name}")));
            }
            (None, _) if width < 2 => {
                let line = filled().nth(begins).map_or(0, |(line, _)| line);
                return Err(self.reject(line, "row", first.trim(), format!("must be two numbers: {HEADER}")));
            }
            (None, _) => {
                let words = format!(
                    "has {width} columns without names: say which are the angle and the lift in [cam], as angle_column = 1 and lift_column = 2 do"
                );
                return Err(self.complain(None, words));
            }
        };
        let mut layout = TableLayout {
            separator,
            decimal_comma: false,
            thousands: None,
            comments,
            titles: above.titles,
            header: above.header,
            columns: columns.map(|column| column + 1),
            left_out: (0..width.max(above.names.len()))
                .filter(|column| !columns.contains(column))
                .map(|column| {
                    above.names.get(column).map_or_else(|| (column + 1).to_string(), |name| (*name).to_owned())
                })
                .collect(),
            angle: above.angle,
            length: above.length,
            unread: above.unread,
        };
        let (most, what) = match above.names.len() {
            0 => (width, "the first row"),
            named => (named, "the header"),
        };
        let mut rows: Vec<TableRow> = Vec::new();
        let (mut point, mut by_three) = (None, None::<(bool, String)>);
        for (line, text) in filled().skip(begins) {
            let (mut found, mut filled) = ([None; 2], 0);
            for (column, cell) in separator.cells(text).enumerate() {
                filled = if cell.is_empty() { filled } else { column + 1 };
                found
                    .iter_mut()
                    .zip(columns)
                    .filter(|(_, wanted)| *wanted == column)
                    .for_each(|(found, _)| *found = Some(cell));
            }
            // A decimal comma would be one more.
            if filled > most {
                let words = format!("has {filled} columns, and {what} has {most}");
                return Err(self.reject(line, "row", text.trim(), words));
            }
            let [Some(angle), Some(lift)] = found else {
                return Err(self.reject(line, "row", text.trim(), format!("must be two numbers: {HEADER}")));
            };
            point = point.or([angle, lift].iter().any(|cell| cell.contains('.')).then_some(line));
            for (_, behind) in [angle, lift].iter().filter_map(|cell| cell.split_once(',')) {
                layout.decimal_comma = true;
                let is_three = behind.len() == 3 && behind.bytes().all(|digit| digit.is_ascii_digit());
                by_three = Some(match by_three {
                    Some((others, example)) => (others && is_three, example),
                    None => (is_three, if angle.contains(',') { angle } else { lift }.to_owned()),
                });
            }
            if let Some(other) = point.filter(|_| layout.decimal_comma) {
                let words = format!(
                    "must have one kind of decimals: there is a comma here or before, and a point on line {other}"
                );
                return Err(self.reject(line, "row", text.trim(), words));
            }
            let number = |column: &str, text: &str| {
                number(text, layout.decimal_comma)
                    .ok_or_else(|| self.reject(line, column, text, "must be a finite number".into()))
            };
            let (angle_deg, lift) = (number("angle_deg", angle)?, number("lift", lift)?);
            if rows.len() == MOST_ROWS {
                return Err(self.complain(Some(line), format!("more than {MOST_ROWS} rows")));
            }
            rows.push(TableRow { angle_deg, lift, line });
        }
        layout.thousands = by_three.filter(|(all, _)| *all).map(|(_, example)| example);
        Ok((rows, layout))
    }

    /// Reads the lines above the rows: titles, a header, and the units below it.
    fn above(
        &self,
        lines: &[(usize, &'a str)],
        cells: &dyn Fn(&'a str) -> Vec<&'a str>,
        (width, chosen): (usize, &[Option<Chosen>; 2]),
    ) -> Result<Above<'a>, ModelError> {
        let named = |&(line, text): &(usize, &'a str)| {
            let columns = self.named(&cells(text), chosen);
            columns.map_err(|words| self.reject(line, "header", text.trim(), words))
        };
        let Some(last) = lines.last() else { return Ok(Above::default()) };
        // A line of units alone, below a header.
        let units = lines.len() > 1 && is_units(&cells(last.1)) && named(&lines[lines.len() - 2])?.is_some();
        let (lines, units) = lines.split_at(lines.len() - usize::from(units));
        let Some(last) = lines.last() else { return Ok(Above::default()) };
        let mut header = None;
        for (index, line) in lines.iter().enumerate().rev() {
            if let Some(columns) = named(line)? {
                header = Some((index, line, columns));
                break;
            }
        }
        if header.is_none_or(|(index, ..)| index + 1 < lines.len()) && cells(last.1).len() == width {
            let names = if chosen.iter().any(Option::is_some) {
                format!("; its columns are {}", cells(last.1).join(", "))
            } else {
                String::new()
            };
            let allowed =
                format!("must name the angle, then the lift, as {HEADER} does, with their units or without{names}");
            return Err(self.reject(last.0, "header", last.1.trim(), allowed));
        }
        let mut above = Above { titles: lines.len() - usize::from(header.is_some()), ..Above::default() };
        let columns = header.map(|(.., columns)| columns);
        let mut named_units = [None; 2];
        for &(line, text) in header.iter().map(|(_, line, _)| *line).chain(units) {
            let all = cells(text);
            for (index, (column, name)) in columns.unwrap_or_default().into_iter().zip(["angle", "lift"]).enumerate() {
                let Some(cell) = all.get(column) else { continue };
                named_units[index] = named_units[index].or(self.unit(line, cell, name)?);
            }
        }
        [above.angle, above.length] = named_units;
        above.columns = columns;
        if let Some((_, (_, text), _)) = header {
            (above.header, above.names) = (Some(text.trim().to_owned()), cells(text));
        }
        // A unit that only a title has.
        let unit = |&(line, text): &(usize, &'a str)| {
            let is_unit =
                |word: &&str| word.len() > 1 && *word != "in" && unit_of(&word.to_lowercase(), &LENGTH_UNITS).is_some();
            let mut words = text.split(|letter: char| !letter.is_alphanumeric());
            words.find(is_unit).map(|word| (line, word.to_owned()))
        };
        let titles = lines.iter().filter(|line| header.is_none_or(|(_, header, _)| *line != header));
        above.unread = if above.length.is_none() { titles.clone().find_map(unit) } else { None };
        Ok(above)
    }

    /// The unit that a header's cell names. One that is none of those that are read would otherwise be taken for another.
    fn unit(&self, line: usize, cell: &str, column: &str) -> Result<Option<usize>, ModelError> {
        let lengths: Vec<&str> = LENGTHS.iter().map(Unit::name).collect();
        let (table, units, field) = match column {
            "angle" => (&ANGLE_UNITS[..], AngleUnit::NAMES.to_vec(), "angle_unit"),
            _ => (&LENGTH_UNITS[..], lengths, "unit"),
        };
        named_unit(cell, table).map_err(|_| {
            let words = format!(
                "the unit of the {column} must be one of: {}; or leave this line out, and say it in [cam], by {field}",
                units.join(", ")
            );
            self.reject(line, "header", cell, words)
        })
    }
}
