//! Conversion of Python values, with the checks of the command line.

use corner_impact::cam::within_a_turn;
use corner_impact::flight::State;
use corner_impact::json;
use corner_impact::model::{Model, Units};
use corner_impact::orbit::Parameter;
use corner_impact::orbit::branch::Following;
use corner_impact::orbit::long_run::Budget;
use corner_impact::study::survey::{Axis, Placed, Spacing, Start, Values, limits};
use numpy::{AllowTypeChange, PyArray1, PyArrayLike1, PyArrayLikeDyn, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyString, PyTuple};
use serde::Serialize;
use serde_json::Value;

use crate::error::{OrRaise, raised};

pub(crate) fn refused<T>(words: String) -> PyResult<T> {
    Err(PyValueError::new_err(words))
}

/// Reads a count.
fn count(name: &str, value: &Bound<'_, PyAny>) -> PyResult<u64> {
    let found = if value.is_instance_of::<PyBool>() { None } else { value.extract().ok() };
    found.map_or_else(|| refused(format!("{name} = {value} must be a whole number from 0 to {}", u64::MAX)), Ok)
}

/// Readers of counts: one function for each argument, so that errors name it.
pub(crate) mod counts {
    use pyo3::prelude::*;

    macro_rules! counts {
        ($($name:ident),+) => {
            $(pub(crate) fn $name(value: &Bound<'_, PyAny>) -> PyResult<u64> {
                super::count(stringify!($name), value)
            })+
        };
    }

    counts!(bits, doublings, longest, patience, points, record, revolutions, speeds, starts, steps, transient);
}

/// Reads a number of threads; `None` for one per core.
pub(crate) fn thread_count(value: &Bound<'_, PyAny>) -> PyResult<Option<usize>> {
    if value.is_none() {
        return Ok(None);
    }
    let found = limits::thread_count(value.extract().unwrap_or(0));
    found.map_or_else(|words| refused(format!("threads = {value} {words}, or None")), |count| Ok(Some(count)))
}

/// Checks that a number is within limits.
pub(crate) fn within(name: &str, value: u64, [low, high]: [u64; 2]) -> PyResult<u64> {
    if (low..=high).contains(&value) {
        Ok(value)
    } else {
        refused(format!("{name} = {value} must be from {low} to {high}"))
    }
}

/// Checks that a simulation can run at a speed.
pub(crate) fn speed(rpm: f64) -> PyResult<f64> {
    limits::speed(rpm).or_else(|words| refused(format!("rpm = {rpm} {words}")))
}

/// Checks a range of speeds.
pub(crate) fn speed_range((low, high): (f64, f64)) -> PyResult<[f64; 2]> {
    let range = [speed(low)?, speed(high)?];
    limits::range(range).or_else(|words| refused(format!("rpm: {words}")))
}

/// One speed, or a range of them.
pub(crate) enum Rpm {
    One(f64),
    Range((f64, f64)),
}

/// Reads two numbers in a tuple, a list or an array.
fn two(value: &Bound<'_, PyAny>) -> Option<(f64, f64)> {
    let [low, high] = numbers("", value).ok()?.try_into().ok()?;
    Some((low, high))
}

/// Reads (lowest, highest) rpm.
pub(crate) fn range(value: &Bound<'_, PyAny>) -> PyResult<(f64, f64)> {
    two(value).map_or_else(|| refused(format!("rpm = {value} must be (lowest, highest)")), Ok)
}

/// Reads (lowest, highest) rpm, if any.
pub(crate) fn range_if_any(value: &Bound<'_, PyAny>) -> PyResult<Option<(f64, f64)>> {
    if value.is_none() { Ok(None) } else { range(value).map(Some) }
}

/// Reads a speed, rpm.
pub(crate) fn one_speed(value: &Bound<'_, PyAny>) -> PyResult<f64> {
    value.extract().or_else(|_| refused(format!("rpm = {value} must be one number")))
}

/// Reads a speed, or (lowest, highest).
pub(crate) fn rpm(value: &Bound<'_, PyAny>) -> PyResult<Rpm> {
    if let Some(range) = two(value) {
        return Ok(Rpm::Range(range));
    }
    let one = value.extract().map(Rpm::One);
    one.or_else(|_| refused(format!("rpm = {value} must be a number or (lowest, highest)")))
}

/// Reads a speed, or (lowest, highest), if any.
pub(crate) fn rpm_if_any(value: &Bound<'_, PyAny>) -> PyResult<Option<Rpm>> {
    if value.is_none() { Ok(None) } else { rpm(value).map(Some) }
}

/// Reads a list of words; one word is a list of it.
pub(crate) fn words(value: &Bound<'_, PyAny>) -> PyResult<Vec<String>> {
    if value.is_instance_of::<PyString>() { Ok(vec![value.extract()?]) } else { value.extract() }
}

/// Items of a sequence as a tuple.
fn tuple<'py>(value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    value.py().get_type::<PyTuple>().call1((value,))
}

/// Reads (name, lowest, highest).
pub(crate) fn named_range(value: &Bound<'_, PyAny>) -> PyResult<(String, f64, f64)> {
    let found = tuple(value).and_then(|items| items.extract());
    found.or_else(|_| refused(format!("over = {value} must be (name, lowest, highest)")))
}

/// Reads (name, lowest, highest), if any.
pub(crate) fn named_range_if_any(value: &Bound<'_, PyAny>) -> PyResult<Option<(String, f64, f64)>> {
    if value.is_none() { Ok(None) } else { named_range(value).map(Some) }
}

/// Values of an axis as given by a caller.
pub(crate) enum AxisValues {
    /// Lowest and highest value, and their number.
    Spaced(f64, f64, usize),
    /// Given values.
    Each(Vec<f64>),
}

impl AxisValues {
    /// Builds the axis of a number, with checked values.
    fn axis(self, parameter: Parameter, log: bool) -> PyResult<Axis> {
        let (name, is_speed) = (parameter.name().to_owned(), parameter == Parameter::Speed);
        let checked = |value: f64| match value {
            value if is_speed => speed(value),
            value if value.is_finite() => Ok(value),
            value => refused(format!("{name} = {value} must be a finite number")),
        };
        let spacing = if log { Spacing::Logarithmic } else { Spacing::Linear };
        match self {
            Self::Spaced(low, high, count) => {
                let values = Values { low: checked(low)?, high: checked(high)?, count, spacing };
                let values = values.checked(if is_speed { "speed" } else { "value" });
                let values = values.or_else(|words| refused(format!("{name}: ({low}, {high}, {count}): {words}")))?;
                Ok(Axis::new(parameter, &values))
            }
            Self::Each(values) => {
                let values: Vec<f64> = values.into_iter().map(checked).collect::<PyResult<_>>()?;
                let Some(least) = values.iter().copied().reduce(f64::min) else {
                    return refused(format!("{name}: there must be 1 value or more"));
                };
                let spacing = self::spacing(log, least)?;
                Ok(Axis { spacing, ..Axis::of(parameter, values.into()) })
            }
        }
    }
}

/// One speed, or the speeds of a survey.
pub(crate) enum Speeds {
    One(f64),
    Axis(AxisValues),
}

/// Reads a number, a tuple (lowest, highest, how many), or any other sequence of speeds.
pub(crate) fn speeds(value: &Bound<'_, PyAny>) -> PyResult<Speeds> {
    // An array of one value converts to a number, too.
    if value.len().is_err() {
        return Ok(Speeds::One(value.extract()?));
    }
    let spaced = value.extract().map(|(low, high, count)| AxisValues::Spaced(low, high, count));
    Ok(Speeds::Axis(spaced.or_else(|_| numbers("rpm", value).map(AxisValues::Each))?))
}

/// Name of a number, and its values.
pub(crate) type NamedValues = (String, AxisValues);

/// Reads (name, lowest, highest, how many) or (name, values), if any.
pub(crate) fn over(value: &Bound<'_, PyAny>) -> PyResult<Option<NamedValues>> {
    if value.is_none() {
        return Ok(None);
    }
    let items = tuple(value).unwrap_or_else(|_| value.clone());
    if let Ok((name, low, high, count)) = items.extract() {
        return Ok(Some((name, AxisValues::Spaced(low, high, count))));
    }
    let Ok((name, values)) = items.extract::<(String, Bound<'_, PyAny>)>() else {
        return refused(format!("over = {value} must be (name, lowest, highest, how many) or (name, values)"));
    };
    let values = numbers(&name, &values)?;
    Ok(Some((name, AxisValues::Each(values))))
}

/// Range over which orbits or events are followed.
pub(crate) fn followed(
    model: &Model,
    (name, low, high): (String, f64, f64),
    longest_step: f64,
    most_points: u64,
) -> PyResult<Following> {
    let parameter = Parameter::named(model, &name).or_raise()?;
    let range = match parameter {
        Parameter::Speed => speed_range((low, high))?,
        Parameter::Field(_) => limits::range([low, high]).or_else(|words| refused(format!("{name}: {words}")))?,
    };
    if !(longest_step > 0.0 && longest_step.is_finite()) {
        return refused(format!("step = {longest_step} must be a finite number above 0"));
    }
    let most_points = within("points", most_points, [1, 1_000_000])? as usize;
    Ok(Following { parameter, range, longest_step, most_points })
}

/// Angle in rad, given by one of its three names: plain, in rad, or in degrees.
pub(crate) fn angle(name: &str, plain: &str, given: [Option<f64>; 3]) -> PyResult<Option<f64>> {
    if given.iter().flatten().count() > 1 {
        let names = [plain, &format!("{name}_rad"), &format!("{name}_deg")];
        let names = &names[usize::from(names[0] == names[1])..];
        return refused(format!("the angle is given more than once: {} are one", names.join(" and ")));
    }
    let [plain, rad, deg] = given;
    Ok(plain.or(rad).or(deg.map(f64::to_radians)))
}

/// Angles in any shape, given by one of their three names, and whether they are in degrees.
pub(crate) fn angles<'a, 'py>(
    name: &str,
    given: [Option<&'a Bound<'py, PyAny>>; 3],
) -> PyResult<(&'a Bound<'py, PyAny>, bool)> {
    match given {
        [Some(angles), None, None] | [None, Some(angles), None] => Ok((angles, false)),
        [None, None, Some(angles)] => Ok((angles, true)),
        _ => refused(format!("one of {name}, {name}_rad and {name}_deg has the angles")),
    }
}

/// Spacing of an axis's values.
pub(crate) fn spacing(log: bool, low: f64) -> PyResult<Spacing> {
    limits::spaced(low, if log { Spacing::Logarithmic } else { Spacing::Linear }).or_else(refused)
}

/// Fixed speed, if any, and the axis of a survey.
pub(crate) fn axis(model: &Model, rpm: Speeds, over: Option<NamedValues>, log: bool) -> PyResult<(Option<f64>, Axis)> {
    match (rpm, over) {
        (Speeds::Axis(values), None) => Ok((None, values.axis(Parameter::Speed, log)?)),
        (Speeds::One(rpm), Some((name, values))) => {
            let parameter = Parameter::named(model, &name).or_raise()?;
            Ok((Some(speed(rpm)?), values.axis(parameter, log)?))
        }
        (Speeds::One(rpm), None) => refused(format!("rpm = {rpm} is one speed: over says what varies then")),
        (Speeds::Axis(_), Some((name, ..))) => {
            refused(format!("rpm and {name} both have several values: with over, rpm is one speed"))
        }
    }
}

/// Builds the budget of runs.
pub(crate) fn budget(transient: u64, record: u64, longest: u64, patience: u64) -> PyResult<Budget> {
    Budget { transient, record, longest, patience }.judging().or_else(refused)
}

/// Builds the start of a run: on the cam, leaving it at a relative velocity, or with a position and a velocity.
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

/// Broadcasts arrays of numbers by the rules of numpy: returns their values side by side, and the common shape.
pub(crate) fn broadcast<const N: usize>(
    names: [&str; N],
    values: [&Bound<'_, PyAny>; N],
) -> PyResult<(Vec<[f64; N]>, Vec<usize>)> {
    let mut arrays = Vec::with_capacity(N);
    for (name, value) in names.iter().zip(values) {
        // None counts as NaN, as in numpy.
        if value.is_none() {
            return refused(format!("{name} = None must be numbers"));
        }
        match value.extract::<PyArrayLikeDyn<'_, f64, AllowTypeChange>>() {
            Ok(array) => arrays.push(array),
            Err(error) => return refused(format!("{name} must be numbers: {}", error.value(value.py()))),
        }
    }
    let views: Vec<_> = arrays.iter().map(|array| array.as_array()).collect();
    let depth = views.iter().map(|view| view.ndim()).max().unwrap_or(0);
    let mut shape = vec![1; depth];
    for view in &views {
        for (size, other) in shape.iter_mut().rev().zip(view.shape().iter().rev()) {
            match (*size, *other) {
                (1, other) => *size = other,
                (size, other) if size == other || other == 1 => {}
                _ => {
                    let told: Vec<_> =
                        names.iter().zip(&views).map(|(name, view)| format!("{name} {:?}", view.shape())).collect();
                    return refused(format!("the shapes do not broadcast: {}", told.join(", ")));
                }
            }
        }
    }
    let mut rows = vec![[0.0; N]; shape.iter().product()];
    for (index, view) in views.iter().enumerate() {
        let whole = view.broadcast(shape.as_slice());
        for (row, value) in rows.iter_mut().zip(whole.iter().flatten()) {
            row[index] = *value;
        }
    }
    Ok((rows, shape))
}

/// Converts columns of equal length to arrays of a shape, by name.
pub(crate) fn shaped<'py, const N: usize>(
    py: Python<'py>,
    names: [&str; N],
    rows: &[[f64; N]],
    shape: &[usize],
) -> PyResult<Bound<'py, PyDict>> {
    let columns = PyDict::new(py);
    for (index, name) in names.into_iter().enumerate() {
        let column = PyArray1::from_vec(py, rows.iter().map(|row| row[index]).collect());
        columns.set_item(name, column.reshape(shape)?)?;
    }
    Ok(columns)
}

/// Returns columns under their names in the units of a model, with converted values.
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

/// Builds an object of a class of `corner_impact.results` with these entries.
pub(crate) fn result<'py>(class: &str, entries: Bound<'py, PyDict>) -> PyResult<Bound<'py, PyAny>> {
    entries.py().import("corner_impact.results")?.getattr(class)?.call1((entries,))
}

/// Converts a document, as the command prints it about a model in these units, to an object of a class of `corner_impact.results`.
pub(crate) fn answer<'py>(
    py: Python<'py>,
    class: &str,
    found: &impl Serialize,
    units: &Units,
) -> PyResult<Bound<'py, PyAny>> {
    result(class, document(py, found, units)?)
}

/// Converts a document, as the command prints it about a model in these units, to a dict.
pub(crate) fn document<'py>(py: Python<'py>, found: &impl Serialize, units: &Units) -> PyResult<Bound<'py, PyDict>> {
    let text = json::render(found, units).map_err(|error| raised(&error))?;
    Ok(py.import("json")?.call_method1("loads", (text,))?.cast_into()?)
}

/// Converts a dict of dicts, lists, arrays, text and numbers to JSON; other contents become null.
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
    // Arrays are converted to lists of numbers.
    let listed = if value.hasattr("tolist")? { value.call_method0("tolist")? } else { value.clone() };
    match listed.try_iter() {
        Ok(items) => items.map(|value| item(&value?)).collect::<PyResult<_>>().map(Value::Array),
        Err(_) => Ok(Value::Null),
    }
}
