//! Measured lifts: rows of angle and lift, in a file of their own or in the model file, read whole and checked row by row.

use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

use serde::Serialize;

use super::ModelError;
use super::above::Chosen;
use super::fields::{Fields, Pair, Value};
use super::heading::{ProseUnit, part_of_unit};
use super::lines::{Holds, Table};
use super::rows::{MOST_ROWS, TableLayout, TableRow};
use super::table_units::{AngleUnit, LiftUnit};
use super::toml;
use super::turn::FEWEST_ROWS;
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
    /// Quantities in its columns.
    #[serde(skip)]
    pub holds: Holds,
    /// The unit of lifts in the table.
    pub unit: String,
    /// The decimal part of that unit that the numbers of the table are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
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
    /// Angle that they are mirrored about, degrees of the cam.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nose_deg: Option<f64>,
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
/// Fewest rows of a smoothing spline, which has to separate the motion from errors of measurement.
const FEWEST_SMOOTHED: usize = 12;
/// Most corners or dwells: more than any cam has.
const MOST_FEATURES: usize = 1000;
/// Most rows of a table in proofs, plus a last one that repeats the first.
const MOST_WRITTEN: usize = MOST_PROVED_ROWS + 1;
/// Reads the fields of `law = "table"`, and the file that they name unless they have its rows.
pub(super) fn read(fields: &mut Fields) -> Result<TableProfile, ModelError> {
    read_rows(fields, Holds::Lifts, false)
}

/// Reads the table of `law = "contour"`: radii over polar angles, or points.
pub(super) fn read_contour(fields: &mut Fields) -> Result<TableProfile, ModelError> {
    let path = "cam.coordinates";
    fields.may_hold(path);
    let mut chosen = |holds: Holds| {
        let paths = holds.choices().map(|column| format!("cam.{column}"));
        paths.iter().for_each(|path| fields.may_hold(path));
        paths.into_iter().find(|path| fields.has(path))
    };
    let [polar, xy] = [Holds::Radii, Holds::Points].map(&mut chosen);
    let holds = match (&polar, &xy) {
        _ if fields.has(path) => fields.choice(path, &[("polar", Holds::Radii), ("xy", Holds::Points)])?,
        (None, Some(_)) => Holds::Points,
        _ => Holds::Radii,
    };
    let is_open = !fields.has(path) && polar.is_none() && xy.is_none();
    let other = if holds == Holds::Points { polar } else { xy };
    if let Some(other) = other {
        let words =
            "belongs to the other coordinates: a contour has angle_column and radius_column, or x_column and y_column";
        return Err(fields.reject(&other, words));
    }
    read_rows(fields, holds, is_open)
}

fn read_rows(fields: &mut Fields, holds: Holds, may_be_points: bool) -> Result<TableProfile, ModelError> {
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
        let table = Table {
            holds,
            may_be_points: false,
            file: fields.file().into(),
            text: &text,
            has_lines,
            angles: AngleUnit::DEGREES,
            says_angles: false,
        };
        let row = |(index, ([angle_deg, lift], line)): (usize, Pair)| {
            let line = line.unwrap_or(index + 1);
            if angle_deg.is_finite() && lift.is_finite() {
                return Ok(TableRow { angle_deg, lift, line });
            }
            let [one, two] = holds.named();
            let words = match holds {
                Holds::Points => format!("must have a finite {one} and a finite {two}"),
                _ => format!("must be a finite angle and a finite {}", holds.value()),
            };
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
    // Spreadsheets begin UTF-8 with a byte order mark; old ones end lines with a carriage return alone, and old systems a text with Ctrl-Z.
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text).trim_end_matches(['\u{1a}', '\r', '\n']);
    let text = if text.contains('\r') {
        Cow::Owned(text.replace("\r\n", "\n").replace('\r', "\n"))
    } else {
        Cow::Borrowed(text)
    };
    let angles = AngleUnit::DEGREES;
    let mut table =
        Table { holds, may_be_points, file: shown, text: &text, has_lines: true, angles, says_angles: false };
    let [one, two] = holds.choices().map(|column| format!("cam.{column}"));
    let chosen = [Chosen::read(fields, &one)?, Chosen::read(fields, &two)?];
    let (rows, layout) = table.rows(&chosen).map_err(|complaint| table.discreet(complaint, &chosen))?;
    if layout.are_points {
        table.holds = Holds::Points;
    }
    let is_unsaid = may_be_points && layout.header.is_none();
    table.profile(fields, (Some(file), spline), rows, Some(layout)).map_err(|error| {
        let meant = "are the columns x and y? then say coordinates = \"xy\" in [cam]";
        if is_unsaid && error.pointer.meant.is_none() { error.meaning(Some(meant.into())) } else { error }
    })
}

/// The unit that a field or the table names; `usual` if neither does. A field that is given decides where the table is not understood.
fn unit<T: Copy + PartialEq>(
    fields: &Fields,
    path: &str,
    [given, usual]: [Option<T>; 2],
    named: Result<Option<T>, ModelError>,
    name: impl Fn(T) -> String,
) -> Result<Option<T>, ModelError> {
    match (given, named) {
        (None, named) => Ok(named?.or(usual)),
        (Some(given), Ok(Some(other))) if other != given => {
            Err(fields.reject(path, format!("is not what the header of the table says: {}", name(other))))
        }
        (given, _) => Ok(given),
    }
}

/// Unit that `cam.unit` names: a unit of length, or a decimal part of one as in `0.01 mm`.
fn lift_unit(fields: &mut Fields) -> Result<Option<LiftUnit>, ModelError> {
    let path = "cam.unit";
    fields.may_hold(path);
    let part = match fields.fields.get(path).map(|field| &field.value) {
        None => return Ok(None),
        Some(Value::Text(text)) => part_of_unit(text),
        Some(_) => None,
    };
    let choices: Vec<(&str, LiftUnit)> =
        LENGTHS.iter().enumerate().map(|(index, unit)| (unit.name(), LiftUnit { index, places: 0 })).collect();
    part.map_or_else(|| fields.choice(path, &choices), Ok).map(Some)
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
fn smoothing(fields: &mut Fields, step: Option<f64>, in_model: &Unit, holds: Holds) -> Result<Smoothing, ModelError> {
    let path = "cam.tolerance";
    fields.may_hold(path);
    let tolerance = match fields.fields.get(path).map(|field| &field.value) {
        None => SmoothingTolerance::Auto,
        Some(Value::Text(_)) => fields.choice(path, &[("auto", SmoothingTolerance::Auto)])?,
        Some(_) => {
            let within = fields.number(path)?;
            // Half of a decimal step has one digit more; allow for its rounding.
            if let Some(step) = step.filter(|step| within < 0.5 * step * (1.0 - 8.0 * tolerance::ULP.value)) {
                let (half, values) = (0.5 * step, holds.values());
                let words =
                    format!("must be at least {half}, half of the step {step} that the {values} are rounded to");
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

/// A decimal number as it is written, divided by a power of ten.
fn shifted(number: &str, places: u32) -> String {
    let (digits, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    format!("{digits}e{}", exponent.parse::<i64>().unwrap_or(0) - i64::from(places))
}

/// Step of the coarsest decimal grid, 1, 2 or 5 times a power of ten, that all numbers lie on. `None` if they have as many
/// digits as a double, or are all 0.
fn grid(numbers: &[f64]) -> Option<f64> {
    /// Upper limit of whole numbers of which a double has every digit.
    const DIGITS: f64 = 1e15;
    // The shortest digits that read back as the same double are the written ones, except for zeros at the end.
    let decimals = |number: &f64| number.to_string().split_once('.').map_or(0, |(_, behind)| behind.len());
    let decimals = numbers.iter().map(decimals).max().unwrap_or_default();
    let power = 10.0_f64.powi(i32::try_from(decimals).ok()?);
    let whole = |number: &f64| (number * power).round().abs();
    if !numbers.iter().all(|number| whole(number) < DIGITS) {
        return None;
    }
    let common = numbers.iter().fold(0_u64, |common, number| {
        let (mut one, mut two) = (common, whole(number) as u64);
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
        let (named, are_points) = (layout.as_ref(), self.holds == Holds::Points);
        fields.may_hold("cam.angle_unit");
        let names: Vec<(&str, usize)> =
            AngleUnit::NAMES.iter().enumerate().map(|(index, name)| (*name, index)).collect();
        let given_angle = fields.has("cam.angle_unit").then(|| fields.choice("cam.angle_unit", &names)).transpose()?;
        let angle = named.map_or(Ok(None), |named| named.angle.clone());
        // A "grad" is a degree in German, and a gon elsewhere.
        let is_grad = || {
            named.and_then(|named| named.header.as_ref()).is_some_and(|header| header.to_lowercase().contains("grad"))
        };
        let is_gon = given_angle.is_some_and(|given| AngleUnit::NAMES[given] == "gon");
        let angle = if is_gon && is_grad() { Ok(None) } else { angle };
        self.says_angles = angle.as_ref().is_ok_and(Option::is_some);
        let index =
            unit(fields, "cam.angle_unit", [given_angle, None], angle, |index| AngleUnit::NAMES[index].to_owned())?;
        self.angles = AngleUnit { index: index.unwrap_or(0), turn_deg: turn_deg(fields)? };
        let of_model = Units::read(fields)?.length;
        let own = LENGTHS.iter().position(|unit| *unit == of_model).map(|index| LiftUnit { index, places: 0 });
        let given = lift_unit(fields)?;
        let lift = named.map_or(Ok(None), |named| named.lift.clone());
        let said = unit(fields, "cam.unit", [given, None], lift, LiftUnit::name)?;
        let lift_unit = said.or(own).unwrap_or(LiftUnit { index: 0, places: 0 });
        // A unit in a title or a comment may be that of the lifts, or of something else.
        let unread = |(_, _, seen): &&(usize, String, ProseUnit)| match seen {
            ProseUnit::Angle(_) if are_points => false,
            ProseUnit::Angle(seen) => index.is_none() && *seen != self.angles.index,
            ProseUnit::Length(seen) => said.is_none() && *seen != lift_unit,
        };
        if let Some((line, word, seen)) = named.and_then(|named| named.seen.iter().find(unread)) {
            let (what, of, field, meant) = match seen {
                ProseUnit::Angle(index) => ("angle", "angles", "angle_unit", AngleUnit::NAMES[*index].to_owned()),
                ProseUnit::Length(unit) => ("length", self.holds.values(), "unit", unit.name()),
            };
            let words = format!(
                "is a unit of {what} that no column is said to be in: say which the {of} are in, by {field} in [cam], such as {field} = \"{meant}\""
            );
            return Err(self.reject(*line, "unit", word, words));
        }
        let unit = &LENGTHS[lift_unit.index];
        let in_model = unit.in_parts_of(&of_model);
        let mut lengths: Vec<f64> = rows.iter().map(|row| row.lift).collect();
        if are_points {
            lengths.extend(rows.iter().map(|row| row.angle_deg));
        }
        if lift_unit.places > 0 {
            lengths
                .iter_mut()
                .for_each(|length| *length = shifted(&length.to_string(), lift_unit.places).parse().unwrap_or(*length));
        }
        let step = grid(&lengths);
        let (values, abscissas) = lengths.split_at(rows.len());
        for (index, row) in rows.iter_mut().enumerate() {
            row.lift = in_model.inside(values[index]);
            row.angle_deg = match abscissas.get(index) {
                Some(x) => in_model.inside(*x),
                None => self.angles.degrees(row.angle_deg),
            };
        }
        let of_angles = ["cam.angle_unit", "cam.turn_deg"].into_iter().find(|path| fields.has(path));
        match (self.holds, of_angles) {
            (Holds::Lifts, _) => {}
            (Holds::Radii, _) => self.radii(&rows)?,
            (Holds::Points, None) => self.polar(&mut rows)?,
            (Holds::Points, Some(path)) => return Err(fields.reject(path, "is of angles, and the table has x and y")),
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
        let is_whole = self.angles.is_of_cam() && !(are_points || is_mirrored || fills || falls || merged > 0);
        if is_whole && rows.len() <= MOST_WRITTEN {
            written = match (named, fields.fields.get("cam.rows")) {
                (Some(layout), _) => rows.iter().filter_map(|row| self.cells(layout, row.line)).collect(),
                (None, field) => field.map_or_else(Vec::new, |field| toml::pairs(&field.written)),
            };
        }
        if lift_unit.places > 0 {
            written.iter_mut().for_each(|[_, lift]| *lift = shifted(lift, lift_unit.places));
        }
        let nose_deg = if is_mirrored { self.mirror(fields, &mut rows)? } else { None };
        // Row numbers are as far apart as degrees are.
        let counts = !are_points
            && fields.has("cam.angle_column")
            && rows.windows(2).all(|pair| pair[1].angle_deg - pair[0].angle_deg == 1.0);
        let column = named.map_or(0, |named| named.columns[0]);
        let (repeats_first, filled) = self.turned(fields, &mut rows, fills).map_err(|error| {
            let meant =
                format!("does column {column} count the rows? then choose another one by angle_column in [cam]");
            if counts { error.meaning(Some(meant)) } else { error }
        })?;
        let fewest = if spline == Kind::Smoothing { FEWEST_SMOOTHED } else { FEWEST_ROWS };
        if rows.len() < fewest {
            let words = format!("{} different angles; {fewest} to {MOST_ROWS} are needed", rows.len());
            return Err(self.complain(None, words));
        }
        let spline = match spline {
            Kind::Cubic => Spline::Cubic,
            Kind::Quintic => Spline::Quintic,
            Kind::Smoothing => Spline::Smoothing(smoothing(fields, step, &in_model, self.holds)?),
        };
        written.truncate(if written.len() < rows.len() { 0 } else { rows.len() });
        let reading = Reading {
            holds: self.holds,
            unit: unit.name().to_owned(),
            part: (lift_unit.places > 0).then(|| lift_unit.name()),
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
            nose_deg,
            filled,
            repeats_first,
            step,
        };
        Ok(TableProfile { file, spline, rows: rows.into(), reading: Arc::new(reading) })
    }
}
