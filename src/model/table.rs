//! Measured lifts: a CSV file of angle and lift, read whole and checked row by row.

use std::path::Path;
use std::sync::Arc;

use serde::Serialize;

use super::ModelError;
use super::fields::{Fields, Pair};
use crate::tolerance;

/// A spline through the rows of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct TableProfile {
    /// The file as the model names it, from where the model file is; none where the model has the rows itself.
    pub file: Option<String>,
    /// How the lift goes from row to row.
    pub spline: Spline,
    /// In order of angle, one for each angle of `[0, 360]`; shared, because a table may be long.
    pub rows: Arc<[Row]>,
}

document!(TableProfile as it { file if_any: it.file, spline: it.spline, rows: &it.rows[..] });

/// The periodic interpolating splines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Spline {
    /// Pieces of degree 3; the third derivative jumps at every row.
    Cubic,
    /// Pieces of degree 5; the fifth derivative jumps at every row.
    Quintic,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Cam angle, degrees.
    pub angle_deg: f64,
    /// Lift, m.
    pub lift: f64,
    /// Line in the file, from 1; of rows that came without a file, which one it is.
    pub line: usize,
}

/// First line of the file.
const HEADER: &str = "angle_deg,lift";
/// A periodic spline needs three rows to have a neighbour on either side.
const FEWEST_ROWS: usize = 3;
/// More are finer than any cam is made or measured.
const MOST_ROWS: usize = 1_000_000;

/// The fields of `law = "table"`, and the file that they name, if they do not have its rows.
pub(super) fn read(fields: &mut Fields) -> Result<TableProfile, ModelError> {
    let splines = [("cubic", Spline::Cubic), ("quintic", Spline::Quintic)];
    fields.may_hold("cam.rows");
    if fields.has("cam.rows") {
        let rows = fields.rows("cam.rows", [FEWEST_ROWS, MOST_ROWS])?;
        fields.may_hold("cam.file");
        if fields.has("cam.file") {
            return Err(fields.reject("cam.file", "is there beside cam.rows: the rows are here or in a file"));
        }
        let spline = fields.choice("cam.spline", &splines)?;
        let has_lines = rows.iter().all(|(_, line)| line.is_some());
        let table = Table { file: fields.file().into(), text: fields.source(), has_lines };
        let row = |(index, ([angle_deg, lift], line)): (usize, Pair)| {
            let line = line.unwrap_or(index + 1);
            if (0.0..=360.0).contains(&angle_deg) && lift.is_finite() {
                return Ok(Row { angle_deg, lift, line });
            }
            let words = "must be an angle from 0 to 360 and a finite lift".into();
            Err(table.reject(line, "cam.rows", &format!("[{angle_deg}, {lift}]"), words))
        };
        let rows = rows.into_iter().enumerate().map(row).collect::<Result<_, _>>()?;
        return Ok(TableProfile { file: None, spline, rows: table.checked(rows)?.into() });
    }
    let file = fields.text("cam.file")?;
    let spline = fields.choice("cam.spline", &splines)?;
    let path = Path::new(fields.file()).parent().unwrap_or(Path::new("")).join(&file);
    let shown = path.display().to_string();
    let text = std::fs::read_to_string(&path)
        .map_err(|error| fields.reject("cam.file", format!("cannot be read at {shown}: {error}")))?;
    // Spreadsheets begin UTF-8 with a mark.
    let table = Table { file: shown, text: text.strip_prefix('\u{feff}').unwrap_or(&text), has_lines: true };
    let rows = table.rows()?;
    Ok(TableProfile { file: Some(file), spline, rows: rows.into() })
}

/// A file being read, for complaints.
struct Table<'a> {
    file: String,
    text: &'a str,
    /// Whether rows are told by their lines in the text, and not by their numbers.
    has_lines: bool,
}

impl Table<'_> {
    fn reject(&self, line: usize, column: &str, value: &str, allowed: String) -> ModelError {
        let shown: String = value.chars().take(60).collect();
        let (field, shown) = (Some(column.into()), Some(shown));
        let complaint = ModelError { field, value: shown, ..self.complain(Some(line), allowed) };
        complaint.in_line(self.text, Some(value))
    }

    fn complain(&self, line: Option<usize>, allowed: String) -> ModelError {
        let line = line.filter(|_| self.has_lines);
        ModelError { line, ..ModelError::file(&self.file, allowed) }.in_line(self.text, None)
    }

    fn rows(&self) -> Result<Vec<Row>, ModelError> {
        let mut lines = self.text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
        match lines.next() {
            Some((_, found)) if found.split(',').map(str::trim).eq(HEADER.split(',')) => {}
            Some((line, found)) => return Err(self.reject(line, "header", found, format!("must be {HEADER}"))),
            None => return Err(self.complain(None, format!("is empty; its first line must be {HEADER}"))),
        }
        let mut rows: Vec<Row> = Vec::new();
        for (line, text) in lines.filter(|(_, text)| !text.is_empty()) {
            let row = self.row(line, text)?;
            if rows.len() == MOST_ROWS {
                return Err(self.complain(Some(line), format!("more than {MOST_ROWS} rows")));
            }
            rows.push(row);
        }
        self.checked(rows)
    }

    /// Rows, each of which may stand alone, as those of one table.
    fn checked(&self, mut rows: Vec<Row>) -> Result<Vec<Row>, ModelError> {
        rows.windows(2).try_for_each(|pair| self.in_order(&pair[0], &pair[1]))?;
        self.close(&mut rows)?;
        if rows.len() < FEWEST_ROWS {
            let words = format!("{} different angles; {FEWEST_ROWS} to {MOST_ROWS} are needed", rows.len());
            return Err(self.complain(None, words));
        }
        self.even(&rows)?;
        Ok(rows)
    }

    fn row(&self, line: usize, text: &str) -> Result<Row, ModelError> {
        let Some((angle, lift)) = text.split_once(',') else {
            return Err(self.reject(line, "row", text, format!("must be two numbers: {HEADER}")));
        };
        let number = |column: &str, text: &str, allowed: &str, is_allowed: fn(f64) -> bool| {
            let number = text.trim().parse().ok().filter(|number| is_allowed(*number));
            number.ok_or_else(|| self.reject(line, column, text.trim(), format!("must be a finite number{allowed}")))
        };
        let angle_deg = number("angle_deg", angle, " from 0 to 360", |angle| (0.0..=360.0).contains(&angle))?;
        let lift = number("lift", lift, "", f64::is_finite)?;
        Ok(Row { angle_deg, lift, line })
    }

    fn place(&self, row: &Row) -> String {
        format!("{} {}", if self.has_lines { "line" } else { "row" }, row.line)
    }

    fn in_order(&self, before: &Row, row: &Row) -> Result<(), ModelError> {
        // What cannot be told apart in radians is one angle.
        if row.angle_deg.to_radians() > before.angle_deg.to_radians() {
            return Ok(());
        }
        let repeats = row.angle_deg >= before.angle_deg;
        let what = if repeats { "repeats the angle of the row before" } else { "angles must rise" };
        let words = format!("{what}: must be above {}, {}", before.angle_deg, self.place(before));
        Err(self.reject(row.line, "angle_deg", &row.angle_deg.to_string(), words))
    }

    /// A last row at 360 is the first one again: dropped where it says the same.
    fn close(&self, rows: &mut Vec<Row>) -> Result<(), ModelError> {
        let (Some(first), Some(last)) = (rows.first().copied(), rows.last().copied()) else {
            return Ok(());
        };
        if first.angle_deg > 0.0 || last.angle_deg < 360.0 {
            return Ok(());
        }
        let largest = rows.iter().fold(0.0_f64, |largest, row| largest.max(row.lift.abs()));
        if (last.lift - first.lift).abs() > tolerance::CAM_CLOSURE.value * largest {
            let words =
                format!("must be {}, the lift at 0 on {}: 360 degrees are 0 again", first.lift, self.place(&first));
            return Err(self.reject(last.line, "lift", &last.lift.to_string(), words));
        }
        rows.pop();
        Ok(())
    }

    /// Refuses a gap where rows are missing.
    fn even(&self, rows: &[Row]) -> Result<(), ModelError> {
        let next = |index: usize| match rows.get(index + 1) {
            Some(row) => row.angle_deg,
            None => rows[0].angle_deg + 360.0,
        };
        let gaps: Vec<f64> = rows.iter().enumerate().map(|(index, row)| next(index) - row.angle_deg).collect();
        let mut sorted = gaps.clone();
        let (_, median, _) = sorted.select_nth_unstable_by(gaps.len() / 2, f64::total_cmp);
        let widest = *median / tolerance::TABLE_GAP.value;
        let Some(index) = gaps.iter().position(|gap| *gap > widest) else {
            return Ok(());
        };
        let words = format!(
            "no row from {} to {}: rows are missing; a gap may be at most {widest}, {} times the median one",
            rows[index].angle_deg,
            next(index),
            1.0 / tolerance::TABLE_GAP.value
        );
        Err(self.reject(rows[index].line, "angle_deg", &rows[index].angle_deg.to_string(), words))
    }
}
