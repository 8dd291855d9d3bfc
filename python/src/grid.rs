//! Grids over two numbers of a model: blocks as arrays, and the store that several processes fill.

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
use crate::model::{Model, start_angle};
use crate::values::{budget, counts, document, numbers, refused, result, start, thread_count};
use crate::work::shared;

/// A grid over two numbers of a model, with one run at each point: its class, period, growth rate and fastest impact.
///
/// `axes` is a dict of two: a name as for `Model.with_number`, or `rpm`, and its values, in any order. The first runs along the rows of
/// arrays, the second along their columns. `rpm` is the speed if no axis is. Each run starts as for `Model.simulate`. It settles within
/// `transient` revolutions on a motion of a period up to `longest`; otherwise it is followed for `patience` and judged by `record` more,
/// as `corner-impact chart` does. Raises ValueError if an argument is wrong.
///
/// >>> from corner_impact import Chart, Model
/// >>> chart = Chart(Model.paper(), {"restitution": [0.7, 0.8], "rpm": [660.0, 700.0, 720.0]})
/// >>> chart.shape
/// (2, 3)
/// >>> chart.compute().class_
/// array([[3, 1, 1],
///        [3, 1, 1]], dtype=int8)
/// >>> chart.sel(restitution=0.7, rpm=700).revolutions.item()
/// 1
#[pyclass(frozen, name = "Chart", module = "corner_impact")]
pub(crate) struct Grid {
    chart: Chart,
    model: Py<Model>,
    rpm: Option<f64>,
    /// Cam angle, relative velocity, position and velocity at the start.
    place: (f64, Option<f64>, Option<f64>, Option<f64>),
}

/// Definition of a grid: its model and its axes.
type Named<'py> = (Py<Model>, Bound<'py, PyDict>);

#[pymethods]
impl Grid {
    #[new]
    #[pyo3(signature = (model, axes, *, rpm=None, transient=300, record=100, longest=32, patience=0, start_angle_rad=None,
        start_angle_deg=None, cam_angle=None, relative_velocity=None, position=None, velocity=None))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn new(
        model: Bound<'_, Model>,
        axes: &Bound<'_, PyDict>,
        rpm: Option<f64>,
        #[pyo3(from_py_with = counts::transient)] transient: u64,
        #[pyo3(from_py_with = counts::record)] record: u64,
        #[pyo3(from_py_with = counts::longest)] longest: u64,
        #[pyo3(from_py_with = counts::patience)] patience: u64,
        start_angle_rad: Option<f64>,
        start_angle_deg: Option<f64>,
        cam_angle: Option<f64>,
        relative_velocity: Option<f64>,
        position: Option<f64>,
        velocity: Option<f64>,
    ) -> PyResult<Self> {
        let cam_angle = start_angle([cam_angle, start_angle_rad, start_angle_deg])?;
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

    /// Values of both axes, by the dotted paths of the numbers.
    #[getter]
    fn axes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let axes = PyDict::new(py);
        for axis in [&self.chart.y, &self.chart.x] {
            axes.set_item(axis.parameter.name(), PyArray1::from_slice(py, &axis.values))?;
        }
        Ok(axes)
    }

    /// Numbers of rows and columns.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        (self.chart.y.values.len(), self.chart.x.values.len())
    }

    /// Revolutions within which a run settles.
    #[getter]
    fn transient(&self) -> u64 {
        self.chart.budget.transient
    }

    /// Revolutions over which the growth of a run is measured that does not settle.
    #[getter]
    fn record(&self) -> u64 {
        self.chart.budget.record
    }

    /// Longest period of a motion on which a run settles, revolutions.
    #[getter]
    fn longest(&self) -> u64 {
        self.chart.budget.longest
    }

    /// Revolutions for which a run is followed that does not settle, before its growth is measured.
    #[getter]
    fn patience(&self) -> u64 {
        self.chart.budget.patience
    }

    /// Speed of all points, rpm; None if the speed is an axis.
    #[getter]
    fn rpm(&self) -> Option<f64> {
        self.chart.speed()
    }

    /// Attributes of a dataset by the CF conventions: the text of the model, the start, the numbers of revolutions, the version.
    #[getter]
    fn attributes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        document(py, &attributes(&self.chart), &Units::default())
    }

    /// Computes the points of some rows and columns, (first, end) each; without them, all points.
    ///
    /// Returns a `ChartPoints`: arrays of shape (rows, columns) by name, as `chart_variables` describes them. The points do not depend on
    /// the part or on the number of `threads`. Raises ValueError if a part is outside the grid.
    #[pyo3(signature = (rows=None, columns=None, *, threads=None))]
    fn compute<'py>(
        slf: &Bound<'py, Self>,
        rows: Option<(usize, usize)>,
        columns: Option<(usize, usize)>,
        #[pyo3(from_py_with = thread_count)] threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (py, it) = (slf.py(), slf.get());
        let part = |name: &str, part: Option<(usize, usize)>, all: usize| match part.unwrap_or((0, all)) {
            (first, end) if first <= end && end <= all => Ok(first..end),
            (first, end) => refused(format!("{name} = ({first}, {end}) is no part of {all}")),
        };
        let (high, wide) = it.shape();
        let (rows, columns) = (part("rows", rows, high)?, part("columns", columns, wide)?);
        let shape = [rows.len(), columns.len()];
        let part = [columns.clone(), rows.clone()];
        let (points, _) = shared(py, || it.chart.part(part, threads, &Unwatched))?.or_raise()?;
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
        let found = result("ChartPoints", found)?;
        let axes = PyDict::new(py);
        for (axis, part) in [(&it.chart.y, rows), (&it.chart.x, columns)] {
            axes.set_item(axis.parameter.name(), PyArray1::from_slice(py, &axis.values[part]))?;
        }
        found.setattr("axes", axes)?;
        found.setattr("chart", slf)?;
        Ok(found)
    }

    /// Computes the chart and selects from it by the values of its axes, which may be named by their ends: `chart.sel(restitution=0.7)`.
    ///
    /// Returns an xarray Dataset; other options, such as `method="nearest"`, are those of `xarray.Dataset.sel`. Raises KeyError if an
    /// axis has no such value, and ValueError if there is no such axis.
    #[pyo3(signature = (**values))]
    fn sel<'py>(slf: &Bound<'py, Self>, values: Option<&Bound<'py, PyDict>>) -> PyResult<Bound<'py, PyAny>> {
        Self::compute(slf, None, None, None)?.call_method("sel", (), values)
    }

    /// Computes the chart and returns it as an xarray Dataset, with units and the meanings of codes as CF attributes.
    fn to_xarray<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        Self::compute(slf, None, None, None)?.call_method0("to_xarray")
    }

    /// Computes the chart and writes it to a netCDF file, which `xarray.open_dataset` reads.
    fn to_netcdf(slf: &Bound<'_, Self>, path: PathBuf) -> PyResult<()> {
        Self::compute(slf, None, None, None)?.call_method1("to_netcdf", (path,)).map(|_| ())
    }

    /// Computes the chart and draws one of its variables with matplotlib; arguments are those of `ChartPoints.plot`. Returns the Axes.
    #[pyo3(signature = (**how))]
    fn plot<'py>(slf: &Bound<'py, Self>, how: Option<&Bound<'py, PyDict>>) -> PyResult<Bound<'py, PyAny>> {
        Self::compute(slf, None, None, None)?.call_method("plot", (), how)
    }

    /// Begins the zarr store at `path`, in blocks of `chunks` (rows, columns), or continues it.
    ///
    /// Returns the numbers of blocks down and across. Raises ValueError if the store holds another chart or cannot be written.
    #[pyo3(signature = (path, chunks=(SIDES[1], SIDES[0])), text_signature = "($self, path, chunks=(100, 100))")]
    fn begin(&self, py: Python<'_>, path: PathBuf, chunks: (usize, usize)) -> PyResult<(usize, usize)> {
        let store = py.detach(|| Store::open(&path, &self.chart, [chunks.1, chunks.0]).map(|store| store.blocks()));
        store.or_raise().map(|[across, up]| (up, across))
    }

    /// Computes block number `block` of the store at `path`, counted row by row from 0, unless it is done. Returns whether it computed.
    ///
    /// Raises ValueError if there is no such block, or if the store holds another chart or cannot be written.
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

/// Returns which blocks of the store at `path` are done, row by row: a bool array of shape (blocks,).
///
/// Raises ValueError if there is no store.
#[pyfunction]
pub(crate) fn blocks_done(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyArray1<bool>>> {
    Ok(PyArray1::from_vec(py, py.detach(|| blocks_of(&path)).or_raise()?))
}

/// Describes the arrays of a chart: a dict for each with `name`, `dtype` and `attributes`.
///
/// The attributes of `class` have the meanings of its codes as `flag_meanings`. Units are those of the model of `chart`, or SI units.
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
