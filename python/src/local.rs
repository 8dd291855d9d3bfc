//! Piecewise-linear map at a corner impact.

use corner_impact::border_collision::LocalMap;
use corner_impact::border_collision::local_map::MapOrbit;
use corner_impact::border_collision::outcome::LONGEST_WORD;
use corner_impact::border_collision::word::Word;
use corner_impact::cam::{Cam, Side};
use corner_impact::corner::CornerMap;
use corner_impact::corner::map::SideMap;
use corner_impact::corner::variational::border;
use corner_impact::model::Study;
use corner_impact::orbit::Search;
use corner_impact::progress::Unwatched;
use corner_impact::study::locate::locate;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;

use crate::error::OrRaise;
use crate::model::Model;
use crate::values::{answer, broadcast, counts, range_if_any, refused, speed_range, within};
use crate::work::spread;

/// The piecewise-linear map of the paper (eq:pwlf) at a corner impact of a model.
///
/// A deviation dx from the state of the corner impact at its section, and a change dT, s, of the period, map to A dx + B dT one
/// revolution later. The entries of dx are a position, m, and a velocity, m/s. A and B are `A_minus`, `B_minus` if the impact comes before the corner, and
/// `A_plus`, `B_plus` if it comes after it. The impact comes before the corner where e dx + f dT < 0; `border` is (e1, e2, f).
///
/// The corner impact is the slowest that `locate` finds over `rpm`, (lowest, highest), or in the model's `[study]`, of orbits with
/// `revolutions` in a period. Raises ValueError if there is none, or if the lift's acceleration does not jump there.
///
/// >>> from corner_impact import LocalMap, Model
/// >>> local = LocalMap(Model.paper())
/// >>> local.classification.scenario
/// 'nonsmooth-fold'
/// >>> local([[0.01, 0.0], [-0.01, 0.0]], dT=0.0).shape
/// (2, 2)
#[pyclass(frozen, name = "LocalMap", module = "corner_impact")]
pub(crate) struct Local {
    map: LocalMap,
    corner: CornerMap,
    model: Py<Model>,
    rpm: Option<(f64, f64)>,
    revolutions: u64,
    /// The corner impact, a `CornerImpact`.
    #[pyo3(get)]
    corner_impact: Py<PyAny>,
}

/// Orbits of the map as a document.
#[derive(Serialize)]
struct LocalOrbits {
    #[serde(rename = "period_change_s")]
    change: f64,
    orbits: Vec<MapOrbit>,
}

/// Deviations with changes of the period, and the shape of the input.
type Points = (Vec<([f64; 2], f64)>, Vec<usize>);

/// Arguments from which a map was built.
type Arguments = (Py<Model>, Option<(f64, f64)>, u64);

impl Local {
    fn matrix<'py>(py: Python<'py>, side: &SideMap) -> PyResult<Bound<'py, PyArray2<f64>>> {
        PyArray1::from_slice(py, &side.entries()[..4]).reshape([2, 2])
    }

    /// Combines every point of (..., 2) with every change of the period.
    fn at<'py>(dx: &Bound<'py, PyAny>, change: &Bound<'py, PyAny>) -> PyResult<Points> {
        let points = dx.py().import("numpy")?.call_method1("asarray", (dx,))?;
        let (all, shape) = broadcast(["dx"], [&points])?;
        let Some((2, shape)) = shape.split_last() else {
            return refused(format!("dx has shape {shape:?}; the last axis must be 2: position and velocity"));
        };
        let part = |index: usize| PyArray1::from_iter(dx.py(), all.iter().skip(index).step_by(2).map(|[value]| *value));
        let (one, two) = (part(0).reshape(shape)?, part(1).reshape(shape)?);
        let (rows, shape) = broadcast(["dx[..., 0]", "dx[..., 1]", "dT"], [one.as_any(), two.as_any(), change])?;
        Ok((rows.into_iter().map(|[one, two, change]| ([one, two], change)).collect(), shape))
    }
}

#[pymethods]
impl Local {
    #[new]
    #[pyo3(signature = (model, rpm=None, revolutions=1))]
    fn new(
        py: Python<'_>,
        model: Py<Model>,
        #[pyo3(from_py_with = range_if_any)] rpm: Option<(f64, f64)>,
        #[pyo3(from_py_with = counts::revolutions)] revolutions: u64,
    ) -> PyResult<Self> {
        let of = &model.get().model;
        let range = match rpm {
            None => of.study().or_raise()?,
            Some(rpm) => {
                let [rpm_min, rpm_max] = speed_range(rpm)?;
                Study { rpm_min, rpm_max }
            }
        };
        let revolutions = within("revolutions", revolutions, [1, Search::MOST_REVOLUTIONS])?;
        let found = spread(py, || locate(of, range, revolutions, &Unwatched))?.or_raise()?.found;
        let Some(first) = found.first() else {
            return refused(format!("no corner impact from {} to {} rpm", range.rpm_min, range.rpm_max));
        };
        if first.at.corner.jump_order != 2 {
            return refused(format!(
                "at {} rpm the lift's derivative of order {} jumps: only a jump of the acceleration has such a map",
                first.at.speed_rpm(),
                first.at.corner.jump_order
            ));
        }
        let map = LocalMap::new(&first.map, border(of, &Cam::new(of).or_raise()?, &first.at));
        let corner_impact = answer(py, "CornerImpact", first, &of.units)?.unbind();
        Ok(Self { map, corner: first.map, model, rpm, revolutions, corner_impact })
    }

    /// A before the corner, shape (2, 2).
    #[getter(A_minus)]
    fn a_minus<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        Self::matrix(py, &self.corner.minus)
    }

    /// A after the corner, shape (2, 2).
    #[getter(A_plus)]
    fn a_plus<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        Self::matrix(py, &self.corner.plus)
    }

    /// B before the corner, shape (2,): m/s and m/s^2.
    #[getter(B_minus)]
    fn b_minus<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.corner.minus.b.as_slice())
    }

    /// B after the corner, shape (2,): m/s and m/s^2.
    #[getter(B_plus)]
    fn b_plus<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.corner.plus.b.as_slice())
    }

    /// C, the first row of A+ - A-, shape (2,).
    #[getter(C)]
    fn c<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.corner.c().as_slice())
    }

    /// D, the first entry of B+ - B-, m/s.
    #[getter(D)]
    fn d(&self) -> f64 {
        self.corner.d()
    }

    /// Coefficients (e1, e2, f), shape (3,): the impact comes before the corner where e dx + f dT < 0.
    #[getter]
    fn border<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let (e, f) = self.map.border;
        PyArray1::from_slice(py, &[e[0], e[1], f])
    }

    /// Event at the corner impact by Feigin's classification, a `Classification`.
    #[getter]
    fn classification<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.corner_impact.bind(py).getattr("classification")
    }

    /// Maps deviations `dx`, shape (..., 2), with a change `dT` of the period, s, that broadcasts with (...), `steps` times.
    ///
    /// Returns an array of shape (..., 2). Raises ValueError if the last axis of `dx` is not 2, or if the shapes do not broadcast.
    #[pyo3(signature = (dx, dT, steps=1))]
    #[expect(non_snake_case, reason = "the paper's symbol")]
    fn __call__<'py>(
        &self,
        dx: &Bound<'py, PyAny>,
        dT: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = counts::steps)] steps: u64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (points, shape) = Self::at(dx, dT)?;
        let carried = points.into_iter().map(|(x, change)| (0..steps).fold(x.into(), |x, _| self.map.apply(x, change)));
        let values: Vec<f64> = carried.flat_map(|x| [x[0], x[1]]).collect();
        let shape = [shape.as_slice(), &[2]].concat();
        Ok(PyArray1::from_vec(dx.py(), values).reshape(shape)?.into_any())
    }

    /// Tells for deviations `dx`, shape (..., 2), and `dT`, s, on which side of the corner the impact is: -1 before it, 1 after it.
    ///
    /// Returns an int8 array of shape (...). Raises ValueError as a call does.
    #[pyo3(signature = (dx, dT))]
    #[expect(non_snake_case, reason = "the paper's symbol")]
    fn side<'py>(&self, dx: &Bound<'py, PyAny>, dT: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let (points, shape) = Self::at(dx, dT)?;
        let sign =
            |(x, change): ([f64; 2], f64)| if self.map.side(x.into(), change) == Side::Minus { -1_i8 } else { 1 };
        Ok(PyArray1::from_vec(dx.py(), points.into_iter().map(sign).collect()).reshape(shape)?.into_any())
    }

    /// Returns the orbit that repeats a sequence of sides, such as "LLR", for a change `dT` of the period, s: L before the corner, R after.
    ///
    /// The orbit is a `LocalOrbit`: `points`, shape (letters, 2), `multipliers`, `stable`, and `admissible`, whether every point lies on
    /// the side of its letter. Raises ValueError if the word has another letter, or if no single orbit repeats it.
    ///
    /// >>> LocalMap(Model.paper()).orbit("R", dT=-1e-4).stable
    /// True
    #[pyo3(signature = (word, dT))]
    #[expect(non_snake_case, reason = "the paper's symbol")]
    fn orbit<'py>(&self, py: Python<'py>, word: &str, dT: f64) -> PyResult<Bound<'py, PyAny>> {
        let Some(word) = Word::read(word) else {
            return refused(format!("word = {word:?} must be of one or more letters L and R"));
        };
        match self.map.orbit(&word, dT) {
            Some(orbit) => answer(py, "LocalOrbit", &orbit, &Default::default()),
            None => refused(format!("no single orbit repeats {word}: det(I - A) is zero to rounding")),
        }
    }

    /// Returns all admissible periodic orbits with words of `longest` letters or fewer for a change `dT` of the period, s.
    ///
    /// Returns a `LocalOrbits`, shortest words first. Raises ValueError if `longest` is not from 1 to 16.
    #[pyo3(signature = (dT, longest=LONGEST_WORD as u64), text_signature = "($self, dT, longest=8)")]
    #[expect(non_snake_case, reason = "the paper's symbol")]
    fn orbits<'py>(
        &self,
        py: Python<'py>,
        dT: f64,
        #[pyo3(from_py_with = counts::longest)] longest: u64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let longest = within("longest", longest, [1, 16])? as usize;
        let orbits = spread(py, || self.map.admissible_orbits(dT, longest))?;
        answer(py, "LocalOrbits", &LocalOrbits { change: dT, orbits }, &Default::default())
    }

    /// Returns the motions of the map for the sign of `dT`: fixed points, periodic orbits, and the ends of many starts.
    ///
    /// The result is a `LocalOutcome`, as in `local_map` of `Model.verify`; `dT` is set to -1, 0 or 1 s, since the map looks the same at
    /// every scale.
    #[pyo3(signature = (dT))]
    #[expect(non_snake_case, reason = "the paper's symbol")]
    fn outcome<'py>(&self, py: Python<'py>, dT: f64) -> PyResult<Bound<'py, PyAny>> {
        let sign = if dT == 0.0 { 0.0 } else { dT.signum() };
        answer(py, "LocalOutcome", &spread(py, || self.map.outcome(sign))?, &Default::default())
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let rpm: f64 = self.corner_impact.bind(py).getattr("speed_rpm")?.extract()?;
        Ok(format!("LocalMap('{}', {rpm} rpm)", self.model.get().model.name.escape_default()))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyAny>, Arguments) {
        let it = slf.get();
        (slf.get_type().into_any(), (it.model.clone_ref(slf.py()), it.rpm, it.revolutions))
    }

    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        let told = PyDict::new(py);
        told.set_item("A_minus", self.a_minus(py)?)?;
        told.set_item("B_minus", self.b_minus(py))?;
        told.set_item("A_plus", self.a_plus(py)?)?;
        told.set_item("B_plus", self.b_plus(py))?;
        told.set_item("C", self.c(py))?;
        told.set_item("D", self.d())?;
        py.import("corner_impact.results")?.call_method1("entries", (self.__repr__(py)?, told))?.extract()
    }
}
