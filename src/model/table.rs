//! Measured lifts: rows of angle and lift, in a file of their own or in the model file, read whole and checked row by row.

use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

use serde::Serialize;

use super::ModelError;
use super::fields::{Fields, Pair, Value};
use super::rows::{AngleUnit, Chosen, MOST_ROWS, Table, TableLayout, TableRow};
use super::toml;
use super::units::{LENGTHS, Unit, Units};
use crate::file;
use crate::tolerance;

/// Most rows of a table in proofs.
#[doc(hidden)]
pub const MOST_PROVED_ROWS: usize = 1000;

/// A spline through the rows of a table, or near them.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub struct TableProfile {
    /// Path of the file as in the model, relative to the model file; `None` where the model has the rows itself.
    pub file: Option<String>,
    /// Kind of the spline.
    pub spline: Spline,
    /// Rows in order of angle, one for each angle in `[0, 360)`; shared, because a table may be long.
    pub rows: Arc<[TableRow]>,
    /// How the rows were interpreted.
    pub reading: Arc<Reading>,
}

document!(TableProfile as it {
    file if_any: it.file,
    spline: it.spline.name(),
    tolerance if_any: it.spline.smoothing().map(|smoothing| smoothing.tolerance),
    corners_deg if_any: it.spline.smoothing().and_then(|smoothing| smoothing.corners_deg.as_ref()),
    dwells_deg if_any: it.spline.smoothing().and_then(|smoothing| smoothing.dwells_deg.as_ref()),
    rows: &it.rows[..],
});

impl TableProfile {
    /// Whether there are enough rows to separate the motion from errors of measurement.
    pub(crate) fn may_be_smoothed(&self) -> bool {
        self.rows.len() >= FEWEST_SMOOTHED
    }

    /// Difference between the highest and the lowest lift.
    pub(crate) fn rise(&self) -> f64 {
        let lifts = self.rows.iter().map(|row| row.lift);
        lifts.clone().fold(f64::NEG_INFINITY, f64::max) - lifts.fold(f64::INFINITY, f64::min)
    }

    /// Field that gives the rows.
    pub fn place(&self) -> &'static str {
        if self.file.is_some() { "cam.file" } else { "cam.rows" }
    }
}

/// The periodic splines.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub enum Spline {
    /// Pieces of degree 3 through the rows; the third derivative jumps at every row.
    Cubic,
    /// Pieces of degree 5 through the rows; the fifth derivative jumps at every row.
    Quintic,
    /// Pieces of degree 5 near the rows.
    Smoothing(Smoothing),
}

impl Spline {
    /// Name in a model file.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Cubic => "cubic",
            Self::Quintic => "quintic",
            Self::Smoothing(_) => "smoothing",
        }
    }

    /// Constraints of a smoothing spline; `None` for the other splines.
    pub fn smoothing(&self) -> Option<&Smoothing> {
        if let Self::Smoothing(smoothing) = self { Some(smoothing) } else { None }
    }
}

/// Constraints of a smoothing spline.
#[derive(Clone, Debug, Default, PartialEq)]
#[doc(hidden)]
pub struct Smoothing {
    /// Largest distance from a row.
    pub tolerance: SmoothingTolerance,
    /// Angles at which the second derivative may jump, degrees, ascending; `None` where they are to be found.
    pub corners_deg: Option<Vec<f64>>,
    /// Dwells, from and to, degrees, ascending by their start; `None` where they are to be found.
    pub dwells_deg: Option<Vec<[f64; 2]>>,
    /// Whether corners are only near the given angles, not exactly there.
    pub are_near: bool,
}

/// Largest distance of a smoothing spline from a row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[doc(hidden)]
pub enum SmoothingTolerance {
    /// Estimated from the rows themselves.
    #[default]
    Auto,
    /// This distance, in the model's unit of length.
    #[serde(untagged)]
    Within(f64),
    /// The distance that results from this weight of the rows, given by its logarithm; the weight is that of another table.
    #[serde(untagged)]
    Weighted(f64),
}

/// How the rows of a table were interpreted.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[doc(hidden)]
pub struct Reading {
    /// The unit of lifts in the table.
    pub unit: String,
    /// Unit of lifts as a multiple of the model's unit of length.
    #[serde(skip)]
    pub in_model: Unit,
    /// Angle and lift of every row as written, in degrees and the unit of lifts. Empty where angles are in radians, where the lifts are
    /// those of another table, and where there are more rows than proofs take.
    #[serde(skip)]
    pub(crate) written: Vec<[String; 2]>,
    /// The unit of angles in the table.
    pub angle_unit: &'static str,
    /// Degrees of the table in one turn of the cam, where these are not 360.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turn_deg: Option<f64>,
    /// The layout of its text; none where the model has the rows itself.
    #[serde(flatten)]
    pub layout: Option<TableLayout>,
    /// Number of rows kept.
    pub rows: usize,
    /// Angle of the first row as written, degrees.
    pub first_deg: f64,
    /// Whether the rows came with falling angles.
    pub falls: bool,
    /// Number of rows that repeated the one before and were dropped.
    pub merged: usize,
    /// Whether the rows are half a lobe and its mirror image.
    #[serde(rename = "mirrored")]
    pub is_mirrored: bool,
    /// Number of rows that were added on the base circle.
    pub filled: usize,
    /// Whether the last row repeated the first and was dropped.
    pub repeats_first: bool,
    /// Step of the decimal grid that all lifts lie on, in the table's unit; `None` if no such step is above the rounding of a
    /// double.
    pub step: Option<f64>,
}

impl Reading {
    /// Half of the step that the lifts are rounded to, in the model's unit of length; 0 without such a step.
    pub fn half_step(&self) -> f64 {
        self.step.map_or(0.0, |step| self.in_model.inside(0.5 * step))
    }
}

/// Kind of a spline, without its constraints.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Cubic,
    Quintic,
    Smoothing,
}

/// The splines, with their names in the field `spline`.
const SPLINES: [(&str, Kind); 3] = [("cubic", Kind::Cubic), ("quintic", Kind::Quintic), ("smoothing", Kind::Smoothing)];
/// Fewest rows: a periodic spline needs three for every row to have a neighbour on either side.
const FEWEST_ROWS: usize = 3;
/// Fewest rows of a smoothing spline, which has to separate the motion from errors of measurement.
const FEWEST_SMOOTHED: usize = 12;
/// Most corners or dwells: more than any cam has.
const MOST_FEATURES: usize = 1000;
/// Most rows of a table in proofs, plus a last one that repeats the first.
const MOST_WRITTEN: usize = MOST_PROVED_ROWS + 1;
/// Reads the fields of `law = "table"`, and the file that they name unless they have its rows.
pub(super) fn read(fields: &mut Fields) -> Result<TableProfile, ModelError> {
    fields.may_hold("cam.rows");
    if fields.has("cam.rows") {
        let spline = fields.choice("cam.spline", &SPLINES)?;
        let pairs = fields.rows("cam.rows", [FEWEST_ROWS, MOST_ROWS])?;
        fields.may_hold("cam.file");
        if fields.has("cam.file") {
            return Err(fields.reject("cam.file", "is there beside cam.rows: the rows are here or in a file"));
        }
        let has_lines = pairs.iter().all(|(_, line)| line.is_some());
        let text = fields.source().to_owned();
        let table = Table { file: fields.file().into(), text: &text, has_lines, angles: AngleUnit::DEGREES };
        let row = |(index, ([angle_deg, lift], line)): (usize, Pair)| {
            let line = line.unwrap_or(index + 1);
            if angle_deg.is_finite() && lift.is_finite() {
                return Ok(TableRow { angle_deg, lift, line });
            }
            let words = "must be a finite angle and a finite lift".into();
            Err(table.reject(line, "cam.rows", &format!("[{angle_deg}, {lift}]"), words))
        };
        let rows = pairs.into_iter().enumerate().map(row).collect::<Result<_, _>>()?;
        return table.profile(fields, (None, spline), rows, None);
    }
    let file = fields.text("cam.file")?;
    let spline = fields.choice("cam.spline", &SPLINES)?;
    let path = Path::new(fields.file()).parent().unwrap_or(Path::new("")).join(&file);
    let shown = path.display().to_string();
    let text = file::text_of_any_age(&path)
        .map_err(|error| fields.reject("cam.file", format!("cannot be read at {shown}: {error}")))?;
    // Spreadsheets begin UTF-8 with a byte order mark; old ones end lines with a carriage return alone.
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let text = if text.contains('\r') {
        Cow::Owned(text.replace("\r\n", "\n").replace('\r', "\n"))
    } else {
        Cow::Borrowed(text)
    };
    let table = Table { file: shown, text: &text, has_lines: true, angles: AngleUnit::DEGREES };
    let chosen = [Chosen::read(fields, "cam.angle_column")?, Chosen::read(fields, "cam.lift_column")?];
    let (rows, layout) = table.rows(&chosen).map_err(|complaint| table.discreet(complaint, &chosen))?;
    table.profile(fields, (Some(file), spline), rows, Some(layout))
}

/// Index of the unit that a field or a header names; 0 if neither names one.
fn unit(fields: &mut Fields, path: &str, names: &[&str], header: Option<usize>) -> Result<usize, ModelError> {
    fields.may_hold(path);
    if !fields.has(path) {
        return Ok(header.unwrap_or(0));
    }
    let choices: Vec<(&str, usize)> = names.iter().enumerate().map(|(index, name)| (*name, index)).collect();
    let chosen = fields.choice(path, &choices)?;
    match header.filter(|header| *header != chosen) {
        Some(other) => Err(fields.reject(path, format!("is not what the header of the table says: {}", names[other]))),
        None => Ok(chosen),
    }
}

/// Degrees of the table in one turn of the cam.
fn turn_deg(fields: &mut Fields) -> Result<f64, ModelError> {
    let path = "cam.turn_deg";
    fields.may_hold(path);
    match fields.fields.get(path).map(|field| &field.value) {
        None => Ok(360.0),
        Some(Value::Number(turn)) if *turn > 0.0 && turn.is_finite() => Ok(*turn),
        Some(_) => Err(fields.reject(path, "must be a finite number above 0")),
    }
}

/// Whether the rows are half a lobe.
fn mirrored(fields: &mut Fields) -> Result<bool, ModelError> {
    let path = "cam.mirrored";
    fields.may_hold(path);
    if fields.has(path) { fields.flag(path) } else { Ok(false) }
}

/// Reads the fields of `spline = "smoothing"`. `step` is the step of the lifts in the table's unit; `in_model` is that unit as a multiple
/// of the model's unit of length.
fn smoothing(fields: &mut Fields, step: Option<f64>, in_model: &Unit) -> Result<Smoothing, ModelError> {
    let path = "cam.tolerance";
    fields.may_hold(path);
    let tolerance = match fields.fields.get(path).map(|field| &field.value) {
        None => SmoothingTolerance::Auto,
        Some(Value::Text(_)) => fields.choice(path, &[("auto", SmoothingTolerance::Auto)])?,
        Some(_) => {
            let within = fields.number(path)?;
            // Half of a decimal step has one digit more; allow for its rounding.
            if let Some(step) = step.filter(|step| within < 0.5 * step * (1.0 - 8.0 * tolerance::ULP.value)) {
                let words =
                    format!("must be at least {}, half of the step {step} that the lifts are rounded to", 0.5 * step);
                return Err(fields.reject(path, words));
            }
            SmoothingTolerance::Within(in_model.inside(within))
        }
    };
    let path = "cam.dwells_deg";
    fields.may_hold(path);
    let mut dwells_deg = None;
    if fields.has(path) && !fields.is_empty_list(path) {
        let mut dwells: Vec<[f64; 2]> = Vec::new();
        for ([from, to], _) in fields.rows(path, [1, MOST_FEATURES])? {
            let (start, span) = (from.rem_euclid(360.0) % 360.0, (to - from).rem_euclid(360.0));
            if !(from.is_finite() && to.is_finite() && span > 0.0) {
                return Err(fields.reject(
                    path,
                    format!("has a dwell from {from} to {to}: it must have an end and be less than a turn"),
                ));
            }
            dwells.push([start, start + span]);
        }
        dwells.sort_by(|one, two| one[0].total_cmp(&two[0]));
        let after = |index: usize| dwells.get(index + 1).map_or(dwells[0][0] + 360.0, |next| next[0]);
        if let Some(index) = (0..dwells.len()).find(|index| dwells[*index][1] >= after(*index)) {
            let [from, to] = dwells[index];
            return Err(fields.reject(
                path,
                format!("has dwells that meet: one from {from} to {to}, and one from {}", after(index) % 360.0),
            ));
        }
        dwells_deg = Some(dwells);
    } else if fields.has(path) {
        dwells_deg = Some(Vec::new());
    }
    let path = "cam.corners_deg";
    fields.may_hold(path);
    let mut corners_deg = None;
    if fields.has(path) {
        let corners = if fields.is_empty_list(path) { Vec::new() } else { fields.numbers(path, MOST_FEATURES)? };
        let mut corners: Vec<f64> = corners.into_iter().map(|corner| corner.rem_euclid(360.0)).collect();
        corners.sort_by(f64::total_cmp);
        if let Some([corner, _]) = corners.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(fields.reject(path, format!("has {corner} twice: a corner is at an angle once")));
        }
        let inside = |corner: &&f64| {
            // A corner may be an end of a dwell, up to rounding.
            let room = tolerance::SAME_KNOT.value;
            let is_inside =
                |[from, to]: &[f64; 2]| (room..to - from - room).contains(&(**corner - from).rem_euclid(360.0));
            dwells_deg.iter().flatten().any(is_inside)
        };
        if let Some(corner) = corners.iter().find(inside) {
            return Err(fields.reject(path, format!("has {corner}, which is inside of a dwell")));
        }
        corners_deg = Some(corners);
    }
    Ok(Smoothing { tolerance, corners_deg, dwells_deg, are_near: false })
}

/// Step of the coarsest decimal grid, 1, 2 or 5 times a power of ten, that all numbers lie on. `None` if they have as many
/// digits as a double, or are all 0.
fn grid(numbers: &[TableRow]) -> Option<f64> {
    /// Upper limit of whole numbers of which a double has every digit.
    const DIGITS: f64 = 1e15;
    // The shortest digits that read back as the same double are the written ones, except for zeros at the end.
    let decimals = |row: &TableRow| row.lift.to_string().split_once('.').map_or(0, |(_, behind)| behind.len());
    let decimals = numbers.iter().map(decimals).max().unwrap_or_default();
    let power = 10.0_f64.powi(i32::try_from(decimals).ok()?);
    let whole = |row: &TableRow| (row.lift * power).round().abs();
    if !numbers.iter().all(|row| whole(row) < DIGITS) {
        return None;
    }
    let common = numbers.iter().fold(0_u64, |common, row| {
        let (mut one, mut two) = (common, whole(row) as u64);
        while two != 0 {
            (one, two) = (two, one % two);
        }
        one
    });
    let mut step = 1;
    let mut largest = (common > 0).then_some(1_u64)?;
    while step <= common {
        largest = [1, 2, 5].iter().map(|digit| digit * step).filter(|size| common % size == 0).fold(largest, u64::max);
        step *= 10;
    }
    Some(largest as f64 / power)
}

impl Table<'_> {
    /// Builds the profile from rows that are each valid alone, and from the fields beside them.
    fn profile(
        mut self,
        fields: &mut Fields,
        (file, spline): (Option<String>, Kind),
        mut rows: Vec<TableRow>,
        layout: Option<TableLayout>,
    ) -> Result<TableProfile, ModelError> {
        let named = layout.as_ref();
        let index = unit(fields, "cam.angle_unit", &AngleUnit::NAMES, named.and_then(|named| named.angle))?;
        self.angles = AngleUnit { index, turn_deg: turn_deg(fields)? };
        let of_model = Units::read(fields)?.length;
        let named_length = named.and_then(|named| named.length);
        if let Some((line, word)) = named.and_then(|named| named.unread.as_ref()).filter(|_| !fields.has("cam.unit")) {
            let words =
                "is a unit of length that no column is said to be in: say which the lifts are in, by unit in [cam]";
            return Err(self.reject(*line, "title", word, words.into()));
        }
        let named_length = named_length
            .or_else(|| LENGTHS.iter().position(|unit| *unit == of_model).filter(|_| !fields.has("cam.unit")));
        let unit = &LENGTHS[unit(fields, "cam.unit", &LENGTHS.each_ref().map(Unit::name), named_length)?];
        let in_model = unit.in_parts_of(&of_model);
        let step = grid(&rows);
        for row in &mut rows {
            row.lift = in_model.inside(row.lift);
            row.angle_deg = self.angles.degrees(row.angle_deg);
        }
        let first_deg = rows.first().map_or(0.0, |row| row.angle_deg);
        let falls = rows.windows(2).filter(|pair| pair[1].angle_deg < pair[0].angle_deg).count();
        let falls = 2 * falls > rows.len();
        if falls {
            rows.reverse();
        }
        let read = rows.len();
        // Segments that are given one after the other repeat the row between them.
        rows.dedup_by(|row, before| row.angle_deg == before.angle_deg && row.lift == before.lift);
        let merged = read - rows.len();
        let is_mirrored = mirrored(fields)?;
        fields.may_hold("cam.outside");
        let fills = fields.has("cam.outside") && fields.choice("cam.outside", &[("base", true)])?;
        let mut written = Vec::new();
        let is_whole = self.angles.is_of_cam() && !(is_mirrored || fills || falls || merged > 0);
        if is_whole && rows.len() <= MOST_WRITTEN {
            written = match (named, fields.fields.get("cam.rows")) {
                (Some(layout), _) => rows.iter().filter_map(|row| self.cells(layout, row.line)).collect(),
                (None, field) => field.map_or_else(Vec::new, |field| toml::pairs(&field.written)),
            };
        }
        if is_mirrored {
            self.mirror(fields, &mut rows)?;
        }
        let (repeats_first, filled) = self.turned(fields, &mut rows, fills)?;
        let fewest = if spline == Kind::Smoothing { FEWEST_SMOOTHED } else { FEWEST_ROWS };
        if rows.len() < fewest {
            let words = format!("{} different angles; {fewest} to {MOST_ROWS} are needed", rows.len());
            return Err(self.complain(None, words));
        }
        let spline = match spline {
            Kind::Cubic => Spline::Cubic,
            Kind::Quintic => Spline::Quintic,
            Kind::Smoothing => Spline::Smoothing(smoothing(fields, step, &in_model)?),
        };
        written.truncate(if written.len() < rows.len() { 0 } else { rows.len() });
        let reading = Reading {
            unit: unit.name().to_owned(),
            in_model,
            written,
            angle_unit: self.angles.name(),
            turn_deg: Some(self.angles.turn_deg).filter(|turn| *turn != 360.0),
            layout,
            rows: rows.len(),
            first_deg,
            falls,
            merged,
            is_mirrored,
            filled,
            repeats_first,
            step,
        };
        Ok(TableProfile { file, spline, rows: rows.into(), reading: Arc::new(reading) })
    }

    /// Adds the mirror image of half a lobe about its nose, the row of the greatest lift at one of the ends.
    fn mirror(&self, fields: &Fields, rows: &mut Vec<TableRow>) -> Result<(), ModelError> {
        let highest = rows.iter().copied().reduce(|highest, row| if row.lift > highest.lift { row } else { highest });
        let (Some(first), Some(last), Some(highest)) = (rows.first().copied(), rows.last().copied(), highest) else {
            return Ok(());
        };
        let image = |nose: f64| move |row: &TableRow| TableRow { angle_deg: 2.0 * nose - row.angle_deg, ..*row };
        let slack = tolerance::TURN_CLOSED.value * 360.0 / rows.len() as f64;
        if last.angle_deg - first.angle_deg > 180.0 + slack {
            let words = format!(
                "is asked of rows over {} degrees: half a lobe has 180 at most",
                last.angle_deg - first.angle_deg
            );
            return Err(fields.reject("cam.mirrored", words));
        }
        // What is half a turn from the nose is its own image.
        let is_other = |row: &TableRow| {
            let from = (row.angle_deg - highest.angle_deg).abs();
            from > 0.0 && from < 180.0 - slack
        };
        if highest.lift == first.lift {
            let images: Vec<TableRow> = rows.iter().filter(|row| is_other(row)).map(image(first.angle_deg)).collect();
            rows.splice(0..0, images.into_iter().rev());
        } else if highest.lift == last.lift {
            let images: Vec<TableRow> =
                rows.iter().rev().filter(|row| is_other(row)).map(image(last.angle_deg)).collect();
            rows.extend(images);
        } else {
            let words =
                format!("needs the nose, the greatest lift, at one end of the rows: it is on {}", self.place(&highest));
            return Err(fields.reject("cam.mirrored", words));
        }
        Ok(())
    }

    /// Adds rows on the base circle over the widest gap, as far apart as the others are. Returns their number.
    fn fill(&self, fields: &Fields, rows: &mut Vec<TableRow>) -> Result<usize, ModelError> {
        let Some(first) = rows.first().copied() else { return Ok(0) };
        let next = |index: usize| {
            rows.get(index + 1).map_or(TableRow { angle_deg: first.angle_deg + 360.0, ..first }, |row| *row)
        };
        let mut gaps: Vec<f64> = (0..rows.len()).map(|index| next(index).angle_deg - rows[index].angle_deg).collect();
        let widest = (0..rows.len()).max_by(|one, two| gaps[*one].total_cmp(&gaps[*two])).unwrap_or_default();
        let (before, after, gap) = (rows[widest], next(widest), gaps[widest]);
        let middle = gaps.len() / 2;
        let (_, median, _) = gaps.select_nth_unstable_by(middle, f64::total_cmp);
        let count = ((gap / *median).round() as usize).saturating_sub(1).min(MOST_ROWS - rows.len().min(MOST_ROWS));
        let lifts = rows.iter().map(|row| row.lift);
        let (base, top) =
            lifts.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), lift| (low.min(lift), high.max(lift)));
        let little = tolerance::ON_BASE.value * (top - base);
        // From the gap inwards on either side; a rise from the circle begins with little and goes on with more.
        let inwards = |from: usize, back: bool| {
            [0, 1, 2].map(|step| rows[(from + if back { rows.len() - step } else { step }) % rows.len()].lift)
        };
        let is_off = |[one, two, three]: [f64; 3]| {
            one - base > little || (two - one).abs() > little && (two - one).abs() > 0.5 * (three - two).abs()
        };
        let sides = [(widest, before, true), ((widest + 1) % rows.len(), after, false)];
        if count > 0
            && rows.len() >= FEWEST_ROWS
            && let Some((_, row, _)) = sides.into_iter().find(|(from, _, back)| is_off(inwards(*from, *back)))
        {
            let words = format!(
                "is asked of rows that do not begin and end on the base circle: the lift on {} is {} above the lowest, or does not rise from it \
                 smoothly",
                self.place(&row),
                row.lift - base
            );
            return Err(fields.reject("cam.outside", words));
        }
        let added = (1..=count).map(|index| TableRow {
            angle_deg: before.angle_deg + gap * index as f64 / (count + 1) as f64,
            lift: base,
            line: before.line,
        });
        let added: Vec<TableRow> = added.collect();
        rows.splice(widest + 1..widest + 1, added);
        rows.iter_mut().for_each(|row| row.angle_deg = row.angle_deg.rem_euclid(360.0) % 360.0);
        rows.sort_by(|one, two| one.angle_deg.total_cmp(&two.angle_deg));
        Ok(count)
    }

    /// Orders the rows of one turn from 0 to below 360, from any first angle, and fills the base circle if that is asked for. Returns whether the
    /// last row repeated the first, and how many were added.
    fn turned(&self, fields: &Fields, rows: &mut Vec<TableRow>, fills: bool) -> Result<(bool, usize), ModelError> {
        /// Smallest fall of the angle that begins a new turn, degrees.
        const BACK: f64 = 180.0;
        let mut turns = 0.0;
        let first = rows.first().map_or(0.0, |row| row.angle_deg);
        // In radians, a turn is 2 pi to as many digits as were written.
        let slack = tolerance::TURN_CLOSED.value * 360.0 / rows.len() as f64;
        let mut before_written = first;
        for index in 1..rows.len() {
            let (before, row) = (rows[index - 1], &mut rows[index]);
            let written = row.angle_deg;
            let begins_turn = turns == 0.0 && before.angle_deg - written > BACK;
            if begins_turn {
                turns = 360.0;
            }
            row.angle_deg += turns;
            let row = *row;
            self.in_order([(&before, before_written), (&row, written)], begins_turn)?;
            before_written = written;
            if row.angle_deg - first > 360.0 + slack {
                let [from, to] = [first - turns, first + 360.0 - turns].map(|angle| self.shown(angle));
                let words = format!("must be within a turn of the first row, from {from} to {to}");
                let twice = rows.last().is_some_and(|last| last.angle_deg - first <= 2.0 * (360.0 + slack));
                let meant = twice.then(|| "are these degrees of a crank? then say turn_deg = 720 in [cam]".to_owned());
                return Err(self.reject_angle(row.line, written, words).meaning(meant));
            }
        }
        let last = rows.last().copied().filter(|last| last.angle_deg - first >= 360.0 - slack);
        if let Some(last) = last {
            self.closes(rows, &rows[0], &last)?;
            rows.pop();
        }
        rows.iter_mut().for_each(|row| row.angle_deg = row.angle_deg.rem_euclid(360.0) % 360.0);
        let start = rows.iter().enumerate().min_by(|one, two| one.1.angle_deg.total_cmp(&two.1.angle_deg));
        let start = start.map_or(0, |(index, _)| index);
        rows.rotate_left(start);
        rows.windows(2).try_for_each(|pair| {
            let [before, row] = [&pair[0], &pair[1]].map(|row| (row, row.angle_deg));
            self.in_order([before, row], false)
        })?;
        let filled = if fills { self.fill(fields, rows)? } else { 0 };
        if rows.len() >= FEWEST_ROWS {
            self.even(rows)?;
        }
        Ok((last.is_some(), filled))
    }

    fn place(&self, row: &TableRow) -> String {
        format!("{} {}", if self.has_lines { "line" } else { "row" }, row.line)
    }

    /// An angle, degrees of the cam, as the table has it.
    fn shown(&self, angle_deg: f64) -> f64 {
        self.angles.told(angle_deg)
    }

    fn reject_angle(&self, line: usize, angle_deg: f64, words: String) -> ModelError {
        let field = format!("angle_{}", self.angles.name());
        self.reject(line, &field, &self.shown(angle_deg).to_string(), words)
    }

    /// Refuses a row that is not above the one before it; each comes with its angle as written, degrees.
    fn in_order(&self, rows: [(&TableRow, f64); 2], begins_turn: bool) -> Result<(), ModelError> {
        let [(before, above), (row, written)] = rows;
        // Angles that are equal in radians count as one.
        if row.angle_deg.to_radians() > before.angle_deg.to_radians() {
            return Ok(());
        }
        let repeats = row.angle_deg >= before.angle_deg;
        let what = if repeats { "repeats the angle of the row before with another lift" } else { "angles must rise" };
        let of_turn = if begins_turn { " less a turn" } else { "" };
        let words = format!("{what}: must be above {}{of_turn}, {}", self.shown(above), self.place(before));
        Err(self.reject_angle(row.line, written, words))
    }

    /// Checks that a last row one turn after the first has the same lift.
    fn closes(&self, rows: &[TableRow], first: &TableRow, last: &TableRow) -> Result<(), ModelError> {
        let largest = rows.iter().fold(0.0_f64, |largest, row| largest.max(row.lift.abs()));
        if (last.lift - first.lift).abs() > tolerance::CAM_CLOSURE.value * largest {
            let words = format!(
                "must be {}, the lift at {} on {}: a turn later it is the same again, and the row may be left out",
                first.lift,
                self.shown(first.angle_deg),
                self.place(first)
            );
            return Err(self.reject(last.line, "lift", &last.lift.to_string(), words));
        }
        Ok(())
    }

    /// Refuses a gap where rows are missing.
    fn even(&self, rows: &[TableRow]) -> Result<(), ModelError> {
        /// Smallest gap that is refused for any number of rows, degrees.
        const HALF: f64 = 180.0;
        /// Gap, degrees, above which the rows cover only a part of the turn.
        const PART: f64 = 90.0;
        let next = |index: usize| match rows.get(index + 1) {
            Some(row) => row.angle_deg,
            None => rows[0].angle_deg + 360.0,
        };
        let gaps: Vec<f64> = rows.iter().enumerate().map(|(index, row)| next(index) - row.angle_deg).collect();
        let mut sorted = gaps.clone();
        let (_, median, _) = sorted.select_nth_unstable_by(gaps.len() / 2, f64::total_cmp);
        let widest = *median / tolerance::TABLE_GAP.value;
        // Allow for the digits to which a turn is written.
        let half = HALF - tolerance::TURN_CLOSED.value * 360.0 / rows.len() as f64;
        let Some(index) = gaps.iter().position(|gap| *gap > widest || *gap > half) else {
            return Ok(());
        };
        // The difference of two angles has fewer digits than the angles.
        let covered = ((360.0 - gaps[index]) * 1e9).round() / 1e9;
        let words = if gaps[index] > PART {
            format!(
                "no row from {} to {}: the rows cover {covered} degrees, and a whole turn is needed, also of a cam that is its own \
                 mirror image",
                self.shown(rows[index].angle_deg),
                self.shown(next(index))
            )
        } else {
            format!(
                "no row from {} to {}: rows are missing; a gap may be at most {}, {} times the median one",
                self.shown(rows[index].angle_deg),
                self.shown(next(index)),
                self.shown(widest),
                1.0 / tolerance::TABLE_GAP.value
            )
        };
        let meant = match covered {
            _ if !self.angles.is_of_cam() || gaps[index] <= PART => None,
            turn if (0.5..=1.0).contains(&turn) => Some("did you mean angle_unit = \"turn\" in [cam]?"),
            turn if turn <= std::f64::consts::TAU => Some("did you mean angle_unit = \"rad\" in [cam]?"),
            _ => Some(
                "of the open part alone say outside = \"base\" in [cam], which fills the base circle; of a half about the nose, mirrored = true",
            ),
        };
        let meant = meant.map(str::to_owned);
        Err(self.reject_angle(rows[index].line, rows[index].angle_deg, words).meaning(meant))
    }
}
