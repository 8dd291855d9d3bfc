//! Fields of `[cam]` that control how a table is read: its units, its turn, and the constraints of a smoothing spline.

use super::ModelError;
use super::fields::{Fields, Value};
use super::heading::part_of_unit;
use super::lines::Holds;
use super::table::{Smoothing, SmoothingTolerance};
use super::table_units::LiftUnit;
use super::units::{LENGTHS, Unit};
use crate::tolerance;

/// Kind of a spline, without its constraints.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Cubic,
    Quintic,
    Smoothing,
}

/// Splines, with their names in the field `spline`.
pub(super) const SPLINES: [(&str, Kind); 3] =
    [("cubic", Kind::Cubic), ("quintic", Kind::Quintic), ("smoothing", Kind::Smoothing)];
/// Largest number of corners or dwells: more than any cam has.
const MOST_FEATURES: usize = 1000;

/// Unit that a field or the table names; `usual` if neither does. A given field decides if the table is not understood.
pub(super) fn unit<T: Copy + PartialEq>(
    fields: &Fields,
    path: &str,
    [given, usual]: [Option<T>; 2],
    named: Result<Option<T>, ModelError>,
    name: impl Fn(T) -> String,
) -> Result<Option<T>, ModelError> {
    match (given, named) {
        (None, named) => Ok(named?.or(usual)),
        (Some(given), Ok(Some(other))) if other != given => {
            Err(fields.reject(path, format!("must be the unit in the header of the table: {}", name(other))))
        }
        (given, _) => Ok(given),
    }
}

/// Reads the unit `cam.unit`: a unit of length, or a decimal part of one such as `0.01 mm`.
pub(super) fn lift_unit(fields: &mut Fields) -> Result<Option<LiftUnit>, ModelError> {
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

/// Reads the degrees of the table in one turn of the cam.
pub(super) fn turn_deg(fields: &mut Fields) -> Result<f64, ModelError> {
    let path = "cam.turn_deg";
    fields.may_hold(path);
    match fields.fields.get(path).map(|field| &field.value) {
        None => Ok(360.0),
        Some(Value::Number(turn)) if *turn > 0.0 && turn.is_finite() => Ok(*turn),
        Some(_) => Err(fields.reject(path, "must be a finite number above 0")),
    }
}

/// Reads whether the rows are half a lobe.
pub(super) fn mirrored(fields: &mut Fields) -> Result<bool, ModelError> {
    let path = "cam.mirrored";
    fields.may_hold(path);
    if fields.has(path) { fields.flag(path) } else { Ok(false) }
}

/// Reads the fields of `spline = "smoothing"`. `step` is the step of the lifts in the table's unit; `in_model` is that unit as a multiple
/// of the model's unit of length.
pub(super) fn smoothing(
    fields: &mut Fields,
    step: Option<f64>,
    in_model: &Unit,
    holds: Holds,
) -> Result<Smoothing, ModelError> {
    let path = "cam.tolerance";
    fields.may_hold(path);
    let tolerance = match fields.fields.get(path).map(|field| &field.value) {
        None => SmoothingTolerance::Auto,
        Some(Value::Text(_)) => fields.choice(path, &[("auto", SmoothingTolerance::Auto)])?,
        Some(_) => {
            let within = fields.number(path)?;
            // Half of a decimal step has one digit more, which may be rounded.
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
                    format!("has a dwell from {from} to {to}: a dwell must be longer than 0 and shorter than a turn"),
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
                format!(
                    "has dwells that meet or overlap: one from {from} to {to}, and one from {}",
                    after(index) % 360.0
                ),
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
            return Err(fields.reject(path, format!("has {corner} twice: give each corner once")));
        }
        let inside = |corner: &&f64| {
            // A corner may be an end of a dwell, up to rounding.
            let room = tolerance::SAME_KNOT.value;
            let is_inside =
                |[from, to]: &[f64; 2]| (room..to - from - room).contains(&(**corner - from).rem_euclid(360.0));
            dwells_deg.iter().flatten().any(is_inside)
        };
        if let Some(corner) = corners.iter().find(inside) {
            return Err(fields.reject(path, format!("has {corner}, which is inside a dwell")));
        }
        corners_deg = Some(corners);
    }
    Ok(Smoothing { tolerance, corners_deg, dwells_deg, are_near: false })
}
