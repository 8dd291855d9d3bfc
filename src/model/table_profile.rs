//! Conversion of rows as written to the rows of one turn of the cam, in the units of the model.

use std::sync::Arc;

use super::ModelError;
use super::fields::Fields;
use super::heading::ProseUnit;
use super::lines::{Holds, Table};
use super::rows::{MOST_ROWS, TableLayout, TableRow};
use super::table::{FEWEST_SMOOTHED, MOST_PROVED_ROWS, Reading, Spline, TableProfile};
use super::table_fields::{Kind, lift_unit, mirrored, smoothing, turn_deg, unit};
use super::table_units::{AngleUnit, LiftUnit};
use super::toml;
use super::turn::FEWEST_ROWS;
use super::units::{LENGTHS, Units};
use crate::tolerance;

/// Largest number of rows of a table in proofs, plus a last row that repeats the first.
const MOST_WRITTEN: usize = MOST_PROVED_ROWS + 1;

/// Decimal number as written, divided by a power of ten.
fn shifted(number: &str, places: u32) -> String {
    let (digits, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    format!("{digits}e{}", exponent.parse::<i64>().unwrap_or(0) - i64::from(places))
}

/// Step of the coarsest decimal grid, 1, 2 or 5 times a power of ten, that contains all numbers. `None` if they have as many digits as a
/// double, or are all 0.
fn grid(numbers: &[f64]) -> Option<f64> {
    /// Upper limit of whole numbers that a double represents digit by digit.
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
    /// Whether the values of rows, as written, look like angles, and the angles do not. Angles change in one direction, except at a new
    /// turn, or in equal steps.
    pub(super) fn seems_swapped(&self, rows: &[TableRow]) -> bool {
        /// Smallest range of angles of a cam's rows, degrees, and the largest: two turns of a crank with a row too many.
        const OVER: [f64; 2] = [45.0, 730.0];
        let [angles, values] = [|row: &TableRow| row.angle_deg, |row: &TableRow| row.lift].map(|of| {
            let steps = rows.windows(2).map(|pair| of(&pair[1]) - of(&pair[0]));
            let against = |sign: f64| steps.clone().filter(|step| !(sign * step > 0.0)).count();
            let (first, mut gaps) = (steps.clone().next().unwrap_or_default(), steps.clone());
            let little = tolerance::TURN_CLOSED.value * first.abs();
            [against(1.0).min(against(-1.0)) <= 1, gaps.all(|step| (step - first).abs() <= little)]
        });
        let range = rows
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], row| [low.min(row.lift), high.max(row.lift)]);
        let over = range[1] - range[0];
        let is_better = |way: usize| values[way] && !angles[way];
        self.holds != Holds::Points && (OVER[0]..=OVER[1]).contains(&over) && (is_better(0) || is_better(1))
    }

    /// Builds the profile from rows that are each valid, and from the fields beside them.
    pub(super) fn profile(
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
        // The word "grad" is a degree in German, and a gon elsewhere.
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
        // A unit in a title or a comment may belong to the lifts or to something else.
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
                "is a unit of {what} that no column has: set the unit of the {of} in [cam], such as {field} = \"{meant}\""
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
            (Holds::Points, Some(path)) => return Err(fields.reject(path, "is for angles, but the table has x and y")),
        }
        let first_deg = rows.first().map_or(0.0, |row| row.angle_deg);
        let falls = rows.windows(2).filter(|pair| pair[1].angle_deg < pair[0].angle_deg).count();
        let falls = 2 * falls > rows.len();
        if falls {
            rows.reverse();
        }
        let read = rows.len();
        // Segments listed one after the other repeat the row between them.
        rows.dedup_by(|row, before| row.angle_deg == before.angle_deg && row.lift == before.lift);
        let merged = read - rows.len();
        let is_mirrored = mirrored(fields)?;
        fields.may_hold("cam.outside");
        let fills = fields.has("cam.outside") && fields.choice("cam.outside", &[("base", true)])?;
        let mut written = Vec::new();
        if self.angles.is_of_cam() && !falls && merged == 0 && rows.len() <= MOST_WRITTEN {
            written = match (named, fields.fields.get("cam.rows")) {
                (Some(layout), _) => rows.iter().filter_map(|row| self.cells(layout, row.line)).collect(),
                (None, field) => field.map_or_else(Vec::new, |field| toml::pairs(&field.written)),
            };
        }
        if lift_unit.places > 0 {
            written.iter_mut().for_each(|[_, lift]| *lift = shifted(lift, lift_unit.places));
        }
        let nose_deg = if is_mirrored { self.mirror(fields, &mut rows)? } else { None };
        // Row numbers increase by 1, as degrees often do.
        let counts =
            fields.has("cam.angle_column") && rows.windows(2).all(|pair| pair[1].angle_deg - pair[0].angle_deg == 1.0);
        let column = named.map_or(0, |named| named.columns[0]);
        let (repeats_first, filled) = self.turned(fields, &mut rows, fills).map_err(|error| {
            let meant =
                format!("does column {column} count the rows? then choose another one by angle_column in [cam]");
            if counts { error.meaning(Some(meant)) } else { error }
        })?;
        let fewest = if spline == Kind::Smoothing { FEWEST_SMOOTHED } else { FEWEST_ROWS };
        if rows.len() < fewest {
            let words = format!("has {} different angles; {fewest} to {MOST_ROWS} are needed", rows.len());
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
