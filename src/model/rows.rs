//! Parser for the text of a table of lifts: its lines, its columns and their units, and its numbers row by row.
//!
//! The first line with numbers determines the separator. Of the lines above it, the last that names an angle and a lift is the header; a
//! comment counts only if no other line is a header. The header chooses the columns, unless the model does. Other lines that name these
//! columns may contain their units. The remaining lines are titles and comments.

use std::iter;

use serde::Serialize;

use super::ModelError;
use super::above::{Chosen, Columns, LineAbove};
use super::heading::{ProseUnit, prose_units};
use super::lines::{Holds, Separator, Table, decimal, has_numbers, is_rule, number, without_comment};
use super::table_units::LiftUnit;

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TableRow {
    /// Cam angle, degrees.
    pub angle_deg: f64,
    /// Lift, m.
    pub lift: f64,
    /// Line in the file, from 1; for rows without a file, the row's number.
    pub line: usize,
}

/// Layout of a table's text.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[doc(hidden)]
pub struct TableLayout {
    /// Separator of the columns.
    pub separator: Separator,
    /// Whether numbers have a decimal comma.
    pub decimal_comma: bool,
    /// Number whose comma may separate thousands, if three digits follow every comma.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thousands: Option<String>,
    /// Whether the comma separates thousands, as neighbouring lifts show.
    #[serde(rename = "parts_thousands", skip_serializing_if = "std::ops::Not::not")]
    pub has_parted: bool,
    /// Number of lines with a comment.
    pub comments: usize,
    /// Number of lines above the header, or above the rows if there is no header.
    pub titles: usize,
    /// Line that names the columns.
    pub header: Option<String>,
    /// Line of units alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub units: Option<String>,
    /// Columns of the angle and of the lift, from 1.
    pub columns: [usize; 2],
    /// Other columns: their names, or their numbers if there is no header.
    pub left_out: Vec<String>,
    /// Whether the header calls the angles a crank's.
    #[serde(skip)]
    pub is_of_crank: bool,
    /// Whether the columns are x and y.
    #[serde(skip)]
    pub(super) are_points: bool,
    /// Unit of angles named above the rows, by its index in the names of a model file; an error if it is not understood.
    #[serde(skip)]
    pub(super) angle: Result<Option<usize>, ModelError>,
    /// Unit of lifts named above the rows.
    #[serde(skip)]
    pub(super) lift: Result<Option<LiftUnit>, ModelError>,
    /// Units in titles and comments, each with its line and its word.
    #[serde(skip)]
    pub(super) seen: Vec<(usize, String, ProseUnit)>,
}

/// Largest number of rows: more would be finer than any cam is made or measured.
pub(super) const MOST_ROWS: usize = 1_000_000;
/// Number of first lines that are examined to recognise a table: titles may precede its rows.
const FIRST_LINES: usize = 20;

impl<'a> Table<'a> {
    /// Removes the contents of a line from an error about a text that does not begin like a table: the model may name any file that its
    /// reader can open.
    pub(super) fn discreet(&self, complaint: ModelError, chosen: &[Option<Chosen>; 2]) -> ModelError {
        let lines = self.text.lines().map(|line| without_comment(line).0).filter(|line| !line.trim().is_empty());
        let begins_like_table = lines.take(FIRST_LINES).any(|line| has_numbers(line) || self.is_header(line, chosen));
        if begins_like_table || complaint.pointer.text.is_none() {
            return complaint;
        }
        let (values, value, header) = (self.holds.values(), self.holds.value(), self.holds.header());
        let words = format!(
            "is not a table of {values}: none of its first {FIRST_LINES} lines has two numbers, or names an angle and a {value} as {header} does"
        );
        ModelError { line: complaint.line, ..ModelError::file(&self.file, words) }
    }

    /// Rejects a row with `####` in place of a number that is read, or before one, where it would begin a comment.
    fn has_no_hidden(&self, separator: Separator, width: usize, columns: Columns) -> Result<(), ModelError> {
        let is_hidden = |cell: &&str| cell.len() > 1 && cell.bytes().all(|letter| letter == b'#');
        let last = columns[0].max(columns[1]);
        for (index, text) in self.text.lines().enumerate().filter(|(_, text)| text.contains("##")) {
            let cells = separator.filled_cells(text);
            let hidden = cells.iter().take(last + 1).find(|cell| is_hidden(cell));
            let mut others = cells.iter().filter(|cell| !is_hidden(cell) && !cell.is_empty());
            // A line of `## ##` between blanks is a comment.
            let is_row = cells.len() == width
                && (separator != Separator::Blanks || others.clone().next().is_some())
                && others.all(|cell| number(cell.trim_end_matches('°'), true).is_some());
            if let Some(cell) = hidden.filter(|_| is_row) {
                let words = "is what a spreadsheet prints for a number that is wider than its column: widen the column, and save the table again";
                return Err(self.reject(index + 1, "cell", cell, words.to_owned()));
            }
        }
        Ok(())
    }

    /// Rejects a column number or name of the model that no line has.
    fn has_columns(
        &self,
        above: &[LineAbove<'_>],
        width: usize,
        chosen: &[Option<Chosen>; 2],
    ) -> Result<(), ModelError> {
        let names = above.iter().rev().find(|above| above.cells.len() == width && !above.is_comment);
        let named = names.map_or_else(String::new, |names| format!(": {}", names.cells.join(", ")));
        let most = above.iter().map(|above| above.cells.len()).fold(width, usize::max);
        for (chosen, field) in chosen.iter().zip(["angle_column", "lift_column"]) {
            if let Some(Chosen::Number(number)) = chosen
                && *number > most
            {
                let words = format!("has {width} columns{named}; {field} = {number} in [cam] names none of them");
                return Err(self.complain(None, words));
            }
        }
        Ok(())
    }

    /// Whether a line below rows is the header of a second table, with angles that begin again below it.
    fn begins_again(&self, line: usize, text: &str, chosen: &[Option<Chosen>; 2], rows: &[TableRow]) -> bool {
        let (Some(first), Some(last)) = (rows.first(), rows.last()) else { return false };
        // Only a line without numbers is examined in detail.
        if text.trim_start().starts_with(|letter: char| letter.is_ascii_digit()) || has_numbers(text) {
            return false;
        }
        let mut below = self.text.lines().skip(line).filter(|text| has_numbers(text));
        let next = below.next().and_then(|row| {
            let cell = row.split([',', ';', '\t', '|', ' ']).find(|cell| !cell.is_empty())?;
            number(cell, false)
        });
        let is_back =
            next.is_some_and(|next| (next - first.angle_deg).abs() < 0.5 * (last.angle_deg - first.angle_deg).abs());
        is_back && self.is_header(text, chosen)
    }

    /// Whether a line names an angle and a lift.
    fn is_header(&self, line: &str, chosen: &[Option<Chosen>; 2]) -> bool {
        let above = LineAbove::new((0, line), Separator::of(line), 0, false);
        self.named(&above, chosen).is_ok_and(|columns| columns.is_some())
    }

    /// Angle and lift of the row in a line, as written except for the decimal point.
    pub(super) fn cells(&self, layout: &TableLayout, line: usize) -> Option<[String; 2]> {
        let (text, _) = without_comment(self.text.lines().nth(line.checked_sub(1)?)?);
        let cell = |column: usize| layout.separator.cells(text).nth(column - 1);
        let [angle, lift] = layout.columns.map(cell);
        let number = |cell: &str| decimal(cell.trim_end_matches(['°', ' ']), layout.decimal_comma).into_owned();
        let lift = number(lift?);
        Some([number(angle?), if layout.has_parted { lift.replace('.', "") } else { lift }])
    }

    /// Reads the rows of the text and its layout; `chosen` are the columns that the model chooses, the angle's first.
    pub(super) fn rows(&self, chosen: &[Option<Chosen>; 2]) -> Result<(Vec<TableRow>, TableLayout), ModelError> {
        let header = self.holds.header();
        let lines = || self.text.lines().enumerate().map(|(index, line)| (index + 1, line));
        let filled = || {
            lines()
                .map(|(line, text)| (line, without_comment(text).0))
                .filter(|(_, text)| !text.trim().is_empty() && !is_rule(text.trim()))
        };
        if filled().next().is_none() {
            return Err(self.complain(None, format!("is empty; its first line must be {header}")));
        }
        // A line `sep=` states the separator for spreadsheets.
        let said = filled().next().and_then(|(_, text)| match text.trim().to_lowercase().strip_prefix("sep=") {
            Some(";") => Some(Separator::Semicolon),
            Some(",") => Some(Separator::Comma),
            Some("|") => Some(Separator::Bar),
            Some("") | Some("\t") => Some(Separator::Tab),
            _ => None,
        });
        let filled = || filled().skip(usize::from(said.is_some()));
        let is_number = |text: &str| {
            let before = |letter: char| letter.is_whitespace() || "\"|,;+-.\u{2212}".contains(letter);
            text.trim_start_matches(before).starts_with(|letter: char| letter.is_ascii_digit())
        };
        // Below a header even a line without a number is a row, with a mistake.
        let found =
            filled().position(|(_, text)| has_numbers(text)).or_else(|| filled().position(|(_, text)| is_number(text)));
        let found = found.or_else(|| Some(1 + filled().position(|(_, text)| self.is_header(text, chosen))?));
        let Some(found) = found else {
            return Err(self.complain(
                None,
                format!(
                    "is not a table of {}: no line has two numbers, as rows below {header} do",
                    self.holds.values()
                ),
            ));
        };
        let above: Vec<(usize, &str)> = filled().take(found).collect();
        let Some((_, first)) = filled().nth(found) else {
            return Err(self.complain(None, format!("has a header such as {header}, but no rows below it")));
        };
        // If the row is one number without a separator, the line above it decides.
        let is_one = !first.trim().contains(|letter: char| letter.is_whitespace() || ",;|".contains(letter));
        let shown = if is_one { above.last().map_or(first, |(_, text)| *text) } else { first };
        let separator = said.unwrap_or_else(|| Separator::of(shown));
        let width = separator.filled_cells(first).len();
        // A mistake or an empty cell in a first row does not make it a title; below a header a single number is a row.
        let is_slip = |&(index, &(line, text)): &(usize, &(usize, &str))| {
            // A tab or a bar at the end of a line is removed.
            let is_cut = || {
                self.text.lines().nth(line - 1).is_some_and(|line| line.trim_end_matches(' ').ends_with(['\t', '|']))
            };
            let is_as_wide =
                separator.filled_cells(text).len() <= width && (separator.cells(text).count() >= width || is_cut());
            is_number(text) && (is_as_wide || above[..index].iter().any(|(_, text)| self.is_header(text, chosen)))
        };
        let begins = found - above.iter().enumerate().rev().take_while(is_slip).count();
        let first_line = filled().nth(begins).map_or(0, |(line, _)| line);
        let comments = lines().take_while(|(line, _)| *line < first_line).filter_map(|(line, text)| {
            let (text, comment) = without_comment(text);
            Some((line, comment.filter(|_| text.is_empty())?))
        });
        let mut above: Vec<LineAbove<'_>> =
            above[..begins].iter().map(|line| LineAbove::new(*line, separator, width, false)).collect();
        above.extend(comments.map(|line| LineAbove::new(line, separator, width, true)));
        above.sort_by_key(|above| above.line);
        self.has_columns(&above, width, chosen)?;
        let above = self.above(&above, width, chosen)?;
        let columns = match (above.columns, chosen) {
            (Some(columns), _) => columns,
            (None, [Some(Chosen::Number(angle)), Some(Chosen::Number(lift))]) => [angle - 1, lift - 1],
            (None, [None, None]) if width == 2 => [0, 1],
            (None, [Some(Chosen::Name(name)), _] | [_, Some(Chosen::Name(name))]) => {
                return Err(self.complain(None, format!("has no column named {name}")));
            }
            (None, _) if width < 2 => {
                return Err(self.reject(first_line, "row", first.trim(), format!("must be two numbers: {header}")));
            }
            (None, _) => {
                let ([one, two], [first, second]) = (self.holds.named(), self.holds.choices());
                let words = format!(
                    "has {width} columns without names: set the columns of {one} and {two} in [cam], such as {first} = 1 and {second} = 2"
                );
                let rows = || filled().skip(begins).map(|(_, text)| text);
                return Err(self.complain(None, words + twofold(separator, rows())));
            }
        };
        self.has_no_hidden(separator, width, columns)?;
        let mut layout = TableLayout {
            separator,
            decimal_comma: false,
            thousands: None,
            has_parted: false,
            comments: 0,
            titles: above.titles,
            header: above.header.map(str::to_owned),
            units: above.units.map(str::to_owned),
            columns: columns.map(|column| column + 1),
            left_out: (0..width.max(above.names.len()))
                .filter(|column| !columns.contains(column))
                .map(|column| above.names.get(column).cloned().unwrap_or_else(|| (column + 1).to_string()))
                .collect(),
            is_of_crank: above.is_of_crank,
            are_points: above.are_points,
            angle: above.angle,
            lift: above.lift,
            seen: above.seen,
        };
        for (line, text) in lines() {
            let (text, comment) = without_comment(text);
            let Some(comment) = comment else { continue };
            layout.comments += 1;
            // A comment in a row is only about that row.
            if text.trim().is_empty() == (line > first_line) {
                layout.seen.extend(prose_units(comment).into_iter().map(|(word, unit)| (line, word, unit)));
            }
        }
        layout.comments -= above.comments;
        let (most, what) = match above.names.len() {
            0 => (width, "the first row"),
            named => (named, "the header"),
        };
        let advice = |layout: &TableLayout, text: &str| match &layout.header {
            Some(header) if header == text.trim() => ": this is the header again; leave the line out",
            _ if self.is_header(text, chosen) => ": this is a header between rows; leave the line out",
            _ if is_number(text) => "",
            _ => "; if this line is no row, leave it out or begin it with #",
        };
        let names = if above.are_points { Holds::Points } else { self.holds }.columns();
        let mut rows: Vec<TableRow> = Vec::new();
        let (mut point, mut thousands) = (None, Thousands::default());
        for (line, text) in filled().skip(begins) {
            if line > first_line && self.begins_again(line, text, chosen, &rows) {
                let words = "is the header of a second table in this file: keep one of them".to_owned();
                return Err(self.reject(line, "header", text.trim(), words));
            }
            let (mut found, mut filled_cells) = ([None; 2], 0);
            for (column, cell) in separator.cells(text).enumerate() {
                filled_cells = if cell.is_empty() { filled_cells } else { column + 1 };
                found
                    .iter_mut()
                    .zip(columns)
                    .filter(|(_, wanted)| *wanted == column)
                    .for_each(|(found, _)| *found = Some(cell));
            }
            // A decimal comma would add a column.
            if filled_cells > most {
                let words = format!(
                    "has {filled_cells} columns, and {what} has {most}{}",
                    twofold(separator, iter::once(text))
                );
                return Err(self.reject(line, "row", text.trim(), words));
            }
            let [Some(angle), Some(lift)] = found else {
                let words = format!("must be two numbers: {header}{}", advice(&layout, text));
                return Err(self.reject(line, "row", text.trim(), words));
            };
            let angle = match angle.strip_suffix('°') {
                Some(angle) => {
                    layout.angle = layout.angle.and_then(|unit| match unit {
                        None | Some(0) => Ok(Some(0)),
                        Some(_) => Err(self.unit_complaint(line, angle, 0, &["rad".to_owned(), "deg".to_owned()])),
                    });
                    angle.trim_end()
                }
                None => angle,
            };
            point = point.or([angle, lift].iter().any(|cell| cell.contains('.')).then_some(line));
            layout.decimal_comma |= [angle, lift].iter().any(|cell| cell.contains(','));
            if let Some(other) = point.filter(|_| layout.decimal_comma) {
                let words =
                    format!("must use one decimal sign: there is a comma here or before, and a point on line {other}");
                return Err(self.reject(line, "row", text.trim(), words));
            }
            thousands.see(angle, lift);
            let number = |column: &str, cell: &str| {
                number(cell, layout.decimal_comma).ok_or_else(|| match slip(cell, layout.decimal_comma) {
                    Some(slip) if cell.is_empty() => {
                        self.reject(line, "row", text.trim(), format!("{slip}: {column} is missing"))
                    }
                    slip => {
                        let slip = slip.map_or_else(|| advice(&layout, text).to_owned(), |slip| format!(": {slip}"));
                        self.reject(line, column, cell, format!("must be a finite number{slip}"))
                    }
                })
            };
            let (angle_deg, lift) = (number(names[0], angle)?, number(names[1], lift)?);
            if rows.len() == MOST_ROWS {
                return Err(self.complain(Some(line), format!("has more than {MOST_ROWS} rows, the most allowed")));
            }
            rows.push(TableRow { angle_deg, lift, line });
        }
        layout.has_parted = thousands.are_parted(&mut rows);
        layout.thousands = thousands.example();
        Ok((rows, layout))
    }
}

/// Names the mistake in a cell that is not a finite number; `None` if it is unknown.
fn slip(cell: &str, decimal_comma: bool) -> Option<&'static str> {
    let begins = |cell: &str| {
        let end = cell.find(|letter: char| {
            letter.is_whitespace() || letter == '°' || letter.is_alphabetic() && !"eEdD".contains(letter)
        })?;
        number(cell[..end].trim_end(), decimal_comma)
    };
    let is_word =
        |words: &[&str]| words.iter().any(|word| cell.trim_start_matches(['+', '-']).eq_ignore_ascii_case(word));
    if cell.is_empty() {
        Some("has an empty cell")
    } else if is_word(&["nan", "inf", "infinity", "n/a", "na", "#n/a", "null"]) {
        Some("this marks a missing number; leave the row out")
    } else if begins(cell).is_some() {
        Some("the cell has more than a number; write a unit in the header")
    } else {
        None
    }
}

/// Advice for rows whose numbers may contain the separator of the columns: decimal commas, or blanks between thousands.
fn twofold<'a>(separator: Separator, mut rows: impl Iterator<Item = &'a str>) -> &'static str {
    let has_thousands = |row: &str| separator.cells(row).skip(1).any(|cell| is_three(cell.split(['.', ',']).next()));
    match separator {
        Separator::Comma if rows.all(|row| !row.contains('.')) => {
            "; if commas are also decimal signs, separate the columns by semicolons, or write decimal points"
        }
        Separator::Blanks if rows.any(has_thousands) => {
            "; if blanks also separate thousands, separate the columns by semicolons, or write nothing between thousands"
        }
        _ => "",
    }
}

/// Whether a part of a number is three digits, as after a separator of thousands.
fn is_three(part: Option<&str>) -> bool {
    part.is_some_and(|part| part.len() == 3 && part.bytes().all(|digit| digit.is_ascii_digit()))
}

/// Evidence from groups of three digits after commas or points that these may separate thousands.
#[derive(Default)]
struct Thousands {
    /// Number that has two readings.
    example: Option<String>,
    /// Whether some number has only one reading.
    is_decided: bool,
    /// Whether some lift has neither a comma nor a point, and is not 0.
    has_whole: bool,
    /// Whether the lift has a comma or a point, for each row.
    parted: Vec<bool>,
}

impl Thousands {
    fn see(&mut self, angle: &str, lift: &str) {
        for cell in [angle, lift] {
            if let Some((_, behind)) = cell.split_once(',') {
                self.is_decided |= !is_three(Some(behind));
                self.example.get_or_insert_with(|| cell.to_owned());
            }
        }
        self.parted.push(lift.contains(['.', ',']));
        // Points are decimal, unless numbers below a thousand have none.
        match lift.split_once('.') {
            Some((before, behind)) => {
                self.is_decided |= before.starts_with('0') || !is_three(Some(behind));
                self.example.get_or_insert_with(|| lift.to_owned());
            }
            None => self.has_whole |= lift.contains(|digit: char| ('1'..='9').contains(&digit)),
        }
    }

    fn is_open(&self) -> bool {
        self.example.as_ref().is_some_and(|example| !self.is_decided && (self.has_whole || example.contains(',')))
    }

    /// Reads lifts with a comma or a point as thousands if only this makes one curve with the whole numbers beside them.
    fn are_parted(&self, rows: &mut [TableRow]) -> bool {
        /// Ratio of the bends of the curve in thousands to the bends with decimals, below which thousands are meant.
        const SMOOTH: f64 = 0.5;
        if !self.is_open() {
            return false;
        }
        let parted: Vec<f64> = rows
            .iter()
            .zip(&self.parted)
            .map(|(row, is_parted)| if *is_parted { (1000.0 * row.lift).round() } else { row.lift })
            .collect();
        let bends =
            |lifts: &[f64]| lifts.windows(3).map(|three| (three[0] - 2.0 * three[1] + three[2]).abs()).sum::<f64>();
        let written: Vec<f64> = rows.iter().map(|row| row.lift).collect();
        let is_one = bends(&parted) < SMOOTH * bends(&written);
        if is_one {
            rows.iter_mut().zip(parted).for_each(|(row, lift)| row.lift = lift);
        }
        is_one
    }

    fn example(self) -> Option<String> {
        if self.is_open() { self.example } else { None }
    }
}
