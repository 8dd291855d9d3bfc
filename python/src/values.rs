//! Python's values, checked as those of the command line are.

use corner_impact::cam::within_a_turn;
use corner_impact::flight::State;
use corner_impact::json;
use corner_impact::model::{Model, Units};
use corner_impact::orbit::Parameter;
use corner_impact::orbit::long_run::Budget;
use corner_impact::study::survey::{Axis, Placed, Spacing, Start, Values, limits};
use numpy::{AllowTypeChange, PyArrayLike1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyString};
use serde::Serialize;
use serde_json::Value;

use crate::error::{OrRaise, raised};

pub(crate) fn refused<T>(words: String) -> PyResult<T> {
    Err(PyValueError::new_err(words))
}

/// How many of something.
pub(crate) fn count(value: &Bound<'_, PyAny>) -> PyResult<u64> {
    let found = if value.is_instance_of::<PyBool>() { None } else { value.extract().ok() };
    found.map_or_else(|| refused(format!("{value} must be a whole number from 0 to {}", u64::MAX)), Ok)
}

/// How many threads; none for as many as there are cores.
pub(crate) fn thread_count(value: &Bound<'_, PyAny>) -> PyResult<Option<usize>> {
    if value.is_none() {
        return Ok(None);
    }
    let found = limits::thread_count(value.extract().unwrap_or(0));
    found.map_or_else(|words| refused(format!("threads = {value} {words}, or None")), |count| Ok(Some(count)))
}

/// A number of something within limits.
pub(crate) fn within(name: &str, value: u64, [low, high]: [u64; 2]) -> PyResult<u64> {
    if (low..=high).contains(&value) {
        Ok(value)
    } else {
        refused(format!("{name} = {value} must be from {low} to {high}"))
    }
}

/// A speed that a simulation can turn at.
pub(crate) fn speed(rpm: f64) -> PyResult<f64> {
    limits::speed(rpm).or_else(|words| refused(format!("rpm = {rpm} {words}")))
}

/// A range of speeds.
pub(crate) fn speed_range((low, high): (f64, f64)) -> PyResult<[f64; 2]> {
    let range = [speed(low)?, speed(high)?];
    limits::range(range).or_else(|words| refused(format!("rpm: {words}")))
}

/// The values of an axis; `what` is the word for one of them.
fn checked(name: &str, (low, high, count): (f64, f64, usize), log: bool, what: &str) -> PyResult<Values> {
    let spacing = if log { Spacing::Logarithmic } else { Spacing::Linear };
    let values = Values { low, high, count, spacing }.checked(what);
    values.or_else(|words| refused(format!("{name}: ({low}, {high}, {count}): {words}")))
}

/// One speed, or what a survey goes over.
#[derive(FromPyObject)]
pub(crate) enum Rpm<Range> {
    One(f64),
    Range(Range),
}

/// How the values of an axis lie.
pub(crate) fn spacing(log: bool, low: f64) -> PyResult<Spacing> {
    limits::spaced(low, if log { Spacing::Logarithmic } else { Spacing::Linear }).or_else(refused)
}

/// The one speed, where there is one, and what a diagram goes over.
pub(crate) fn axis(
    model: &Model,
    rpm: Rpm<(f64, f64, usize)>,
    over: Option<(String, f64, f64, usize)>,
    log: bool,
) -> PyResult<(Option<f64>, Axis)> {
    match (rpm, over) {
        (Rpm::Range(range), None) => {
            let values = checked("rpm", (speed(range.0)?, speed(range.1)?, range.2), log, "speed")?;
            Ok((None, Axis::new(Parameter::Speed, &values)))
        }
        (Rpm::One(rpm), Some((name, low, high, count))) => {
            let values = checked(&name, (low, high, count), log, "value")?;
            Ok((Some(speed(rpm)?), Axis::new(Parameter::named(model, &name).or_raise()?, &values)))
        }
        (Rpm::One(rpm), None) => refused(format!("rpm = {rpm} is one speed: over says what varies then")),
        (Rpm::Range(_), Some((name, ..))) => {
            refused(format!("rpm and {name} are both ranges: with over, rpm is one speed"))
        }
    }
}

/// For how long runs are followed.
pub(crate) fn budget(transient: u64, record: u64, longest: u64, patience: u64) -> PyResult<Budget> {
    Budget { transient, record, longest, patience }.judging().or_else(refused)
}

/// Where a run starts: on the cam, leaving it at a relative velocity, or somewhere with a position and a velocity.
pub(crate) fn start(
    cam_angle: f64,
    relative_velocity: Option<f64>,
    position: Option<f64>,
    velocity: Option<f64>,
) -> PyResult<Start> {
    let given = [Some(cam_angle), relative_velocity, position, velocity];
    if given.into_iter().flatten().any(|number| !number.is_finite()) {
        return refused("a start is of finite numbers".into());
    }
    let follower = match (position, velocity, relative_velocity) {
        (Some(position), Some(velocity), None) => Placed::At(State { position, velocity }),
        (None, None, None) => Placed::OnCam(0.0),
        (None, None, Some(velocity)) if velocity >= 0.0 => Placed::OnCam(velocity),
        (None, None, Some(velocity)) => return refused(format!("relative_velocity = {velocity} must be 0 or more")),
        _ => return refused("a start is position and velocity, or relative_velocity, or none of them".into()),
    };
    Ok(Start { cam_angle: within_a_turn(cam_angle), follower })
}

/// Numbers in a list, a tuple or an array of any type, contiguous or not.
pub(crate) fn numbers(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    match value.extract::<PyArrayLike1<'_, f64, AllowTypeChange>>() {
        Ok(array) => Ok(array.as_array().iter().copied().collect()),
        Err(error) => refused(format!("{name} must be numbers in one dimension: {}", error.value(value.py()))),
    }
}

/// Arrays of one length.
pub(crate) fn pairs(
    [one, two]: [&str; 2],
    first: &Bound<'_, PyAny>,
    second: &Bound<'_, PyAny>,
) -> PyResult<Vec<[f64; 2]>> {
    let (first, second) = (numbers(one, first)?, numbers(two, second)?);
    if first.len() != second.len() {
        return refused(format!("{one} has {} numbers, and {two} {}", first.len(), second.len()));
    }
    Ok(first.into_iter().zip(second).map(|(first, second)| [first, second]).collect())
}

/// Columns under their names in the units of a model, with the values that those make others.
pub(crate) fn in_units<'py>(columns: Bound<'py, PyDict>, units: &Units) -> PyResult<Bound<'py, PyDict>> {
    if !units.are_given {
        return Ok(columns);
    }
    let told = PyDict::new(columns.py());
    for (name, values) in columns {
        let name: String = name.extract()?;
        let values = match units.converted(&name) {
            Some(convert) => values.mul(convert(units, 1.0))?,
            None => values,
        };
        told.set_item(units.field(&name), values)?;
    }
    Ok(told)
}

/// A document as the command prints it about a model in these units, as a dict.
pub(crate) fn document<'py>(py: Python<'py>, found: &impl Serialize, units: &Units) -> PyResult<Bound<'py, PyDict>> {
    let text = json::render(found, units).map_err(|error| raised(&error))?;
    Ok(py.import("json")?.call_method1("loads", (text,))?.cast_into()?)
}

/// What a dict of dicts, lists, arrays, text and numbers holds; nothing where it holds something else.
pub(crate) fn item(value: &Bound<'_, PyAny>) -> PyResult<Value> {
    if let Ok(table) = value.cast::<PyDict>() {
        let entry = |(key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| Ok((key.extract()?, item(&value)?));
        return table.iter().map(entry).collect::<PyResult<_>>().map(Value::Object);
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(Value::String(text.extract()?));
    }
    if value.is_instance_of::<PyBool>() {
        return Ok(Value::Bool(value.extract()?));
    }
    if let Ok(number) = value.extract::<f64>() {
        return Ok(number.into());
    }
    // Arrays have their numbers as lists.
    let listed = if value.hasattr("tolist")? { value.call_method0("tolist")? } else { value.clone() };
    match listed.try_iter() {
        Ok(items) => items.map(|value| item(&value?)).collect::<PyResult<_>>().map(Value::Array),
        Err(_) => Ok(Value::Null),
    }
}
