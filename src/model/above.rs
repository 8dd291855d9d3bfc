//! Lines above the rows of a table of lifts: the header, with its columns and units.

use super::ModelError;
use super::fields::{Fields, Value};
use super::heading::{Heading, Kind, Named, ProseUnit, prose_units};
use super::lines::{Holds, Separator, Table};
use super::table_units::{AngleUnit, LiftUnit};
use super::units::{LENGTHS, Unit};

/// Choice of a column in a model file.
pub(super) enum Chosen {
    /// Number of the column, from 1.
    Number(usize),
    /// Name of the column in the header.
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

/// Largest number of a column.
const MOST_COLUMNS: f64 = 1e6;
/// Columns of the angle and of the value in a table, from 0.
pub(super) type Columns = [usize; 2];

/// Line above the rows.
pub(super) struct LineAbove<'a> {
    pub(super) line: usize,
    pub(super) text: &'a str,
    pub(super) is_comment: bool,
    pub(super) cells: Vec<String>,
    pub(super) headings: Vec<Heading>,
}

/// Titles, header and units above the rows.
pub(super) struct Above<'a> {
    pub(super) titles: usize,
    /// Number of comments that serve as header or units.
    pub(super) comments: usize,
    pub(super) header: Option<&'a str>,
    pub(super) units: Option<&'a str>,
    pub(super) columns: Option<Columns>,
    /// Whether the columns are x and y.
    pub(super) are_points: bool,
    /// Names of all columns.
    pub(super) names: Vec<String>,
    pub(super) is_of_crank: bool,
    pub(super) angle: Result<Option<usize>, ModelError>,
    pub(super) lift: Result<Option<LiftUnit>, ModelError>,
    pub(super) seen: Vec<(usize, String, ProseUnit)>,
}

impl<'a> Table<'a> {
    /// Returns the columns that a line names; `None` if it is no header, an error if it names them ambiguously.
    pub(super) fn named(&self, above: &LineAbove<'_>, chosen: &[Option<Chosen>; 2]) -> Result<Option<Columns>, String> {
        let (cells, headings) = (&above.cells, &above.headings);
        let by_choice = |chosen: &Option<Chosen>| match chosen {
            Some(Chosen::Number(number)) => Some((*number <= cells.len()).then(|| number - 1)),
            Some(Chosen::Name(name)) => {
                let is_it = |cell: &String| {
                    let alone = cell.split(['[', '(']).next().unwrap_or_default().trim();
                    cell.to_lowercase() == name.to_lowercase() || alone.to_lowercase() == name.to_lowercase()
                };
                Some(cells.iter().position(is_it))
            }
            None => None,
        };
        let of = |wanted: &[Kind]| -> Vec<usize> {
            (0..cells.len()).filter(|column| wanted.contains(&headings[*column].kind)).collect()
        };
        if self.may_be_points || self.holds == Holds::Points {
            let one = |place: usize, kind: Kind| match by_choice(&chosen[place]) {
                Some(found) => found,
                None => {
                    if let [one] = of(&[kind])[..] {
                        Some(one)
                    } else {
                        None
                    }
                }
            };
            match (one(0, Kind::Abscissa), one(1, Kind::Ordinate)) {
                (Some(x), Some(y)) if x == y => return Err("names one column for both x and y".into()),
                (Some(x), Some(y)) => return Ok(Some([x, y])),
                _ if self.holds == Holds::Points => return Ok(None),
                _ => {}
            }
        }
        let angle = match by_choice(&chosen[0]) {
            Some(found) => found,
            None => {
                let all = of(&[Kind::Angle]);
                let of_cam: Vec<usize> = all.iter().copied().filter(|column| headings[*column].is_of[1]).collect();
                match (&all[..], &of_cam[..]) {
                    ([], _) => None,
                    ([one], _) | (_, [one]) => Some(*one),
                    _ => return Err("names several angles: choose one by angle_column in [cam]".into()),
                }
            }
        };
        let Some(angle) = angle else { return Ok(None) };
        let (value, field) = (self.holds.value(), self.holds.choices()[1]);
        let [own, foreign] = match self.holds {
            Holds::Lifts => [Kind::Lift, Kind::Radius],
            _ => [Kind::Radius, Kind::Lift],
        };
        let lift = match by_choice(&chosen[1]) {
            Some(found) => found,
            None => {
                let others = |wanted: &[Kind]| -> Vec<usize> {
                    of(wanted).into_iter().filter(|column| *column != angle).collect()
                };
                match (&others(&[own])[..], &others(&[Kind::Unknown, foreign, Kind::Abscissa, Kind::Ordinate])[..]) {
                    ([one], _) | ([], [one]) => Some(*one),
                    ([], []) => None,
                    _ => {
                        return Err(format!("does not say which column is the {value}: set {field} in [cam]"));
                    }
                }
            }
        };
        let Some(lift) = lift else { return Ok(None) };
        if headings[lift].kind == foreign && chosen[1].is_none() {
            let words = match self.holds {
                Holds::Lifts => {
                    "names a radius of the cam, which is not the follower's lift: use law = \"contour\", or set lift_column in [cam] if it \
                     is a lift"
                }
                _ => {
                    "names a lift, which is not a radius of the cam's contour: use law = \"table\", or set radius_column in [cam] if it \
                     is a radius"
                }
            };
            return Err(words.into());
        }
        if lift == angle {
            return Err(format!("names one column for both the angle and the {value}"));
        }
        Ok(Some([angle, lift]))
    }

    /// Reads the lines above the rows: titles, a header, units and comments.
    pub(super) fn above(
        &self,
        lines: &[LineAbove<'a>],
        width: usize,
        chosen: &[Option<Chosen>; 2],
    ) -> Result<Above<'a>, ModelError> {
        let header = self.header(lines, width, chosen)?;
        let is_used = |&(index, above): &(usize, &LineAbove<'a>)| {
            header.is_some_and(|(at, columns)| {
                let is_known = || above.names_all();
                let names_them = || above.is_units() || is_known() && self.named(above, chosen) == Ok(Some(columns));
                index == at || above.cells.len() == width && names_them()
            })
        };
        let below = lines.iter().enumerate().skip(header.map_or(0, |(at, _)| at + 1));
        if let Some((_, last)) = below.rev().find(|(_, above)| !above.is_comment).filter(|last| !is_used(last))
            && last.cells.len() == width
            && !last.text.split_whitespace().any(|word| word.starts_with(|letter: char| letter.is_ascii_digit()))
        {
            return Err(self.unnamed(last, chosen));
        }
        let (used, others): (Vec<_>, Vec<_>) = lines.iter().enumerate().partition(is_used);
        let named = header.map(|(at, _)| &lines[at]);
        let [angle, lift] = header.map_or([0, 1], |(_, columns)| columns);
        let is_below = |above: &LineAbove<'a>| named.is_some_and(|named| named.line != above.line);
        let cells = |column: usize| {
            used.iter().filter_map(move |(_, above)| {
                let (cell, mut heading) = (above.cells.get(column)?.clone(), above.headings.get(column)?.clone());
                // Below a header, an unknown word among units is an unknown unit.
                if is_below(above) && above.is_units() && !heading.is_unit && has_letters(&cell) {
                    (heading.angle, heading.lift) = (Err(Vec::new()), Err(Vec::new()));
                }
                Some((above.line, cell, heading))
            })
        };
        let kind = |column: usize| named.and_then(|named| named.headings.get(column)).map(|heading| heading.kind);
        let are_points = self.holds == Holds::Points
            || self.may_be_points && [angle, lift].map(kind) == [Some(Kind::Abscissa), Some(Kind::Ordinate)];
        let angles = cells(angle).filter(|_| !are_points).map(|(line, cell, heading)| (line, cell, heading.angle));
        let lengths = cells(angle).filter(|_| are_points).chain(cells(lift));
        let lifts = lengths.map(|(line, cell, heading)| (line, cell, heading.lift));
        let units = used.iter().rev().find(|(_, above)| above.is_units());
        let seen = others
            .iter()
            .flat_map(|(_, above)| prose_units(above.text).into_iter().map(|(word, unit)| (above.line, word, unit)));
        Ok(Above {
            titles: others.iter().filter(|(_, above)| !above.is_comment).count(),
            comments: used.iter().filter(|(_, above)| above.is_comment).count(),
            header: named.filter(|named| !named.is_units()).map(|named| named.text.trim()),
            units: units.map(|(_, units)| units.text.trim()),
            columns: header.map(|(_, columns)| columns),
            are_points,
            names: named.map_or_else(Vec::new, |named| named.cells.clone()),
            is_of_crank: named.and_then(|named| named.headings.get(angle)).is_some_and(|heading| heading.is_of[0]),
            angle: self.together(angles, 0, |unit| AngleUnit::NAMES[*unit].to_owned()),
            lift: self.together(lifts, 1, |unit: &LiftUnit| unit.name()),
            seen: seen.collect(),
        })
    }

    /// Index of the last line that names the columns. A line of units or a comment serves as a header if there is no other.
    fn header(
        &self,
        lines: &[LineAbove<'a>],
        width: usize,
        chosen: &[Option<Chosen>; 2],
    ) -> Result<Option<(usize, Columns)>, ModelError> {
        for (of_comments, of_units) in [(false, false), (false, true), (true, false), (true, true)] {
            for (index, above) in lines.iter().enumerate().rev() {
                let is_whole = above.cells.len() == width;
                let is_known = || is_whole && above.names_all();
                if above.is_comment != of_comments || above.is_units() != of_units || above.is_comment && !is_known() {
                    continue;
                }
                match self.named(above, chosen) {
                    Ok(Some(columns)) => return Ok(Some((index, columns))),
                    Err(words) if is_whole => return Err(self.reject(above.line, "header", above.text.trim(), words)),
                    _ => {}
                }
            }
        }
        Ok(None)
    }

    /// Error about a line in place of a header.
    fn unnamed(&self, last: &LineAbove<'a>, chosen: &[Option<Chosen>; 2]) -> ModelError {
        let more = match chosen.iter().any(Option::is_some) {
            true => format!("; its columns are {}", last.cells.join(", ")),
            false => {
                let [one, two] = self.holds.choices();
                format!("; or set the columns in [cam], such as {one} = 1 and {two} = 2")
            }
        };
        let ([one, two], header) = (self.holds.named(), self.holds.header());
        let allowed = format!("must name {one}, then {two}, with or without units, such as {header}{more}");
        self.reject(last.line, "header", last.text.trim(), allowed)
    }

    /// Unit that the cells of a column name together.
    fn together<T: PartialEq>(
        &self,
        cells: impl Iterator<Item = (usize, String, Named<T>)>,
        column: usize,
        name: impl Fn(&T) -> String,
    ) -> Result<Option<T>, ModelError> {
        let mut unit: Option<T> = None;
        for (line, cell, found) in cells {
            let found = found.map_err(|meant| self.unit_complaint(line, &cell, column, &meant))?;
            unit = match (unit, found) {
                (Some(one), Some(other)) if one != other => {
                    return Err(self.unit_complaint(line, &cell, column, &[name(&one), name(&other)]));
                }
                (one, other) => one.or(other),
            };
        }
        Ok(unit)
    }

    /// Error about a cell whose unit is not understood. If such a unit were ignored, the numbers would be read in a wrong unit.
    pub(super) fn unit_complaint(&self, line: usize, cell: &str, column: usize, meant: &[String]) -> ModelError {
        let (name, units, field, example) = match column {
            0 => ("angle", AngleUnit::NAMES.to_vec(), "angle_unit", "deg"),
            _ => (self.holds.value(), LENGTHS.iter().map(Unit::name).collect(), "unit", "mm"),
        };
        let words = match meant {
            [] => format!(
                "the unit of the {name} must be one of: {}; or set it in [cam], such as {field} = \"{example}\"{}",
                units.join(", "),
                if column == 0 { "" } else { ", or a decimal part such as unit = \"0.01 mm\"" }
            ),
            [fields] if fields.contains('=') => format!("names a part of a unit: set {fields} in [cam]"),
            [one] => {
                format!("names a multiple of a unit: set the unit of the numbers in [cam], such as {field} = \"{one}\"")
            }
            [one, other, ..] => {
                format!(
                    "the lines above the rows name both {one} and {other}: set {field} = \"{one}\" or {field} = \"{other}\" in [cam]"
                )
            }
        };
        self.reject(line, "header", cell, words)
    }
}

fn has_letters(text: &str) -> bool {
    text.contains(char::is_alphabetic)
}

impl<'a> LineAbove<'a> {
    /// Splits a line above the rows, or a comment without its marks, into cells.
    pub(super) fn new((line, text): (usize, &'a str), separator: Separator, width: usize, is_comment: bool) -> Self {
        let bare = text.trim_matches(|letter: char| letter.is_whitespace() || "#%/*".contains(letter));
        // In `#,Angle` the sign is the name of a column.
        let is_name = is_comment
            && text.strip_prefix('#').is_some_and(|after| after.starts_with([',', ';', '\t', '|']))
            && separator.filled_cells(text).len() == width;
        let text = if is_comment && !is_name { bare } else { text };
        let cells = separator.names(text, width);
        let headings = cells.iter().map(|cell| Heading::of(cell)).collect();
        Self { line, text, is_comment, cells, headings }
    }

    /// Whether each of its cells is understood without the others. In a comment, a number and a unit beside an unknown word are a
    /// length, not the unit of a column: `dial gauge 0.01 mm`.
    fn names_all(&self) -> bool {
        let is_length = |heading: &Heading, cell: &str| {
            heading.kind == Kind::Unknown && !heading.is_unit && cell.contains(|letter: char| letter.is_ascii_digit())
        };
        let mut cells = self.headings.iter().zip(&self.cells);
        cells.all(|(heading, cell)| heading.is_known() && !(self.is_comment && is_length(heading, cell)))
    }

    /// Whether it has units but no names of an angle or a lift: an angle's unit, or units alone.
    fn is_units(&self) -> bool {
        let is_of_angle = |heading: &Heading| heading.kind == Kind::Angle;
        let is_other = |heading: &Heading| matches!(heading.kind, Kind::Other | Kind::Unknown);
        self.headings.iter().any(|heading| heading.is_unit)
            && match self.headings.iter().any(is_of_angle) {
                true => self.headings.iter().all(|heading| heading.is_unit || is_other(heading)),
                false => (0..self.cells.len())
                    .all(|column| self.headings[column].is_unit || !has_letters(&self.cells[column])),
            }
    }
}
