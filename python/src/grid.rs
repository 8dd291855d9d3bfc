//! A grid over two numbers of a model: its blocks as arrays, and the store that processes fill together.

use std::path::PathBuf;
use std::sync::Arc;

use corner_impact::model::Units;
use corner_impact::orbit::Parameter;
use corner_impact::progress::Unwatched;
use corner_impact::study::chart::Chart;
use corner_impact::study::chart::store::{SIDES, Store, VARIABLES, attributes, blocks_of};
use corner_impact::study::survey::{Axis, Start};
use numpy::{IntoPyArray, PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::error::OrRaise;
use crate::model::Model;
use crate::values::{budget, count, document, numbers, refused, start, thread_count};
use crate::work::shared;

/// A grid over two numbers of a model: what one run comes to at each of its points.
///
/// `axes` is a dict of two: a name as for `Model.with_number`, or `rpm`, and its values, in any order; the first runs along the rows of
/// arrays (down), the second along their columns. `rpm` says the speed where neither is it. Each run starts as for `Model.simulate`, is to
/// settle within `transient` revolutions on a motion of up to `longest`, and else is followed for `patience` and told by `record` more, as
/// `corner-impact chart` does.
///
/// >>> from corner_impact import Chart, Model
/// >>> chart = Chart(Model.paper(), {"restitution": [0.7, 0.8], "rpm": [660.0, 700.0, 720.0]})
/// >>> chart.shape
/// (2, 3)
/// >>> chart.compute()["class"]
/// array([[3, 1, 1],
///        [3, 1, 1]], dtype=int8)
#[pyclass(frozen, name = "Chart", module = "corner_impact")]
pub(crate) struct Grid {
    chart: Chart,
    model: Py<Model>,
    rpm: Option<f64>,
    /// Cam angle, relative velocity, position and velocity at the start.
    place: (f64, Option<f64>, Option<f64>, Option<f64>),
}

/// What a grid is made of: its model and its axes.
type Named<'py> = (Py<Model>, Bound<'py, PyDict>);

#[pymethods]
impl Grid {
    #[new]
    #[pyo3(signature = (model, axes, *, rpm=None, transient=300, record=100, longest=32, patience=0, cam_angle=0.0,
        relative_velocity=None, position=None, velocity=None))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn new(
        model: Bound<'_, Model>,
        axes: &Bound<'_, PyDict>,
        rpm: Option<f64>,
        #[pyo3(from_py_with = count)] transient: u64,
        #[pyo3(from_py_with = count)] record: u64,
        #[pyo3(from_py_with = count)] longest: u64,
        #[pyo3(from_py_with = count)] patience: u64,
        cam_angle: f64,
        relative_velocity: Option<f64>,
        position: Option<f64>,
        velocity: Option<f64>,
    ) -> PyResult<Self> {
        let of = &model.get().model;
        let axis = |(name, values): (Bound<'_, PyAny>, Bound<'_, PyAny>)| -> PyResult<Axis> {
            let name: String = name.extract()?;
            let parameter = Parameter::named(of, &name).or_raise()?;
            Ok(Axis::of(parameter, Arc::from(numbers(&name, &values)?)))
        };
        let axes: Vec<Axis> = axes.iter().map(axis).collect::<PyResult<_>>()?;
        let Ok([y, x]) = <[Axis; 2]>::try_from(axes) else {
            return refused("axes are two: a name and its values each".into());
        };
        let at: Start = start(cam_angle, relative_velocity, position, velocity)?;
        let budget = budget(transient, record, longest, patience)?;
        let chart = Chart::new(of, rpm, [x, y], at, budget).or_raise()?;
        Ok(Self { chart, model: model.unbind(), rpm, place: (cam_angle, relative_velocity, position, velocity) })
    }

    /// The model.
    #[getter]
    fn model(&self, py: Python<'_>) -> Py<Model> {
        self.model.clone_ref(py)
    }

    /// The values of both axes, by the whole names of the numbers.
    #[getter]
    fn axes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let axes = PyDict::new(py);
        for axis in [&self.chart.y, &self.chart.x] {
            axes.set_item(axis.parameter.name(), PyArray1::from_slice(py, &axis.values))?;
        }
        Ok(axes)
    }

    /// How many rows and columns.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        (self.chart.y.values.len(), self.chart.x.values.len())
    }

    /// Revolutions within which a run is to settle.
    #[getter]
    fn transient(&self) -> u64 {
        self.chart.budget.transient
    }

    /// Revolutions that are looked at where it does not.
    #[getter]
    fn record(&self) -> u64 {
        self.chart.budget.record
    }

    /// The longest period looked for, revolutions.
    #[getter]
    fn longest(&self) -> u64 {
        self.chart.budget.longest
    }

    /// Revolutions for which a run that settles on nothing is followed before its growth is looked at.
    #[getter]
    fn patience(&self) -> u64 {
        self.chart.budget.patience
    }

    /// The speed of all points, rpm; None where it varies.
    #[getter]
    fn rpm(&self) -> Option<f64> {
        self.chart.speed()
    }

    /// What a dataset says of where it comes from, with CF's conventions: the model's whole text, the start, the lengths, the version.
    #[getter]
    fn attributes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        document(py, &attributes(&self.chart), &Units::default())
    }

    /// What the runs of some rows and columns, (first, end) each, come to, without them of all: two-dimensional arrays by name,
    /// as `chart_variables` describes them. The points are the same in whatever parts and on however many `threads`.
    #[pyo3(signature = (rows=None, columns=None, *, threads=None))]
    fn compute<'py>(
        &self,
        py: Python<'py>,
        rows: Option<(usize, usize)>,
        columns: Option<(usize, usize)>,
        #[pyo3(from_py_with = thread_count)] threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let part = |name: &str, part: Option<(usize, usize)>, all: usize| match part.unwrap_or((0, all)) {
            (first, end) if first <= end && end <= all => Ok(first..end),
            (first, end) => refused(format!("{name} = ({first}, {end}) is no part of {all}")),
        };
        let (high, wide) = self.shape();
        let (rows, columns) = (part("rows", rows, high)?, part("columns", columns, wide)?);
        let shape = [rows.len(), columns.len()];
        let (points, _) = shared(py, || self.chart.part([columns, rows], threads, &Unwatched))?.or_raise()?;
        let found = PyDict::new(py);
        for variable in &VARIABLES {
            let values = points.iter().map(|point| variable.of(point));
            match variable.whole {
                None => found.set_item(variable.name, values.collect::<Vec<_>>().into_pyarray(py).reshape(shape)?)?,
                Some(1) => {
                    let values: Vec<i8> = values.map(|value| value as i8).collect();
                    found.set_item(variable.name, values.into_pyarray(py).reshape(shape)?)?;
                }
                Some(_) => {
                    let values: Vec<i32> = values.map(|value| value as i32).collect();
                    found.set_item(variable.name, values.into_pyarray(py).reshape(shape)?)?;
                }
            }
        }
        Ok(found)
    }

    /// Begins the zarr store at `path`, of blocks with so many rows and columns, or finds it begun: how many blocks there are down and
    /// across. Another chart's store is refused.
    #[pyo3(signature = (path, chunks=(SIDES[1], SIDES[0])), text_signature = "($self, path, chunks=(100, 100))")]
    fn begin(&self, py: Python<'_>, path: PathBuf, chunks: (usize, usize)) -> PyResult<(usize, usize)> {
        let store = py.detach(|| Store::open(&path, &self.chart, [chunks.1, chunks.0]).map(|store| store.blocks()));
        store.or_raise().map(|[across, up]| (up, across))
    }

    /// Computes block number `block` of the store at `path`, counted row by row from 0, if it is not done: whether it was not.
    #[pyo3(signature = (path, block, chunks=(SIDES[1], SIDES[0]), *, threads=Some(1)),
        text_signature = "($self, path, block, chunks=(100, 100), *, threads=1)")]
    fn fill(
        &self,
        py: Python<'_>,
        path: PathBuf,
        block: usize,
        chunks: (usize, usize),
        #[pyo3(from_py_with = thread_count)] threads: Option<usize>,
    ) -> PyResult<bool> {
        let fill = || Store::open(&path, &self.chart, [chunks.1, chunks.0])?.fill_block(block, threads);
        Ok(shared(py, fill)?.or_raise()?.is_some())
    }

    fn __repr__(&self) -> String {
        let [y, x] =
            [&self.chart.y, &self.chart.x].map(|axis| format!("{}: {}", axis.parameter.name(), axis.values.len()));
        format!("Chart('{}', {y}, {x})", self.chart.model.name.escape_default())
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Named<'py>, Bound<'py, PyDict>)> {
        let rest = PyDict::new(py);
        let (cam_angle, relative_velocity, position, velocity) = self.place;
        rest.set_item("rpm", self.rpm)?;
        rest.set_item("transient", self.transient())?;
        rest.set_item("record", self.record())?;
        rest.set_item("longest", self.longest())?;
        rest.set_item("patience", self.patience())?;
        rest.set_item("cam_angle", cam_angle)?;
        rest.set_item("relative_velocity", relative_velocity)?;
        rest.set_item("position", position)?;
        rest.set_item("velocity", velocity)?;
        Ok(((self.model(py), self.axes(py)?), rest))
    }
}

/// Which blocks of the store at `path` are done, row by row.
#[pyfunction]
pub(crate) fn blocks_done(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyArray1<bool>>> {
    Ok(PyArray1::from_vec(py, py.detach(|| blocks_of(&path)).or_raise()?))
}

/// The arrays of a chart: a dict for each with `name`, `dtype` and `attributes`, those of the store; `class` has the meanings of its
/// codes as `flag_meanings`. Units are those of a `chart`'s model, without one the SI's.
#[pyfunction]
#[pyo3(signature = (chart=None))]
pub(crate) fn chart_variables<'py>(py: Python<'py>, chart: Option<&Grid>) -> PyResult<Bound<'py, PyList>> {
    let all = PyList::empty(py);
    let units = chart.map_or_else(Units::default, |grid| grid.chart.model.units.clone());
    let documents = VARIABLES.iter().map(|variable| variable.document(&units));
    documents
        .map(|variable| document(py, &variable, &Units::default()))
        .try_for_each(|variable| all.append(variable?))?;
    Ok(all)
}
