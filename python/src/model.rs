//! Model, with all its computations.

use std::path::PathBuf;
use std::sync::Arc;

use corner_impact::cam::{Cam, within_a_turn};
use corner_impact::flight::State;
use corner_impact::model;
use corner_impact::orbit::long_run::Budget;
use corner_impact::orbit::{Parameter, Search};
use corner_impact::progress::Unwatched;
use corner_impact::section::{StroboscopicMap, next_impact};
use corner_impact::simulate::{Machine, angular_velocity};
use corner_impact::study::StudyError;
use corner_impact::study::attractors::{Resolution, Step};
use corner_impact::study::certify::{certify, proved_counts, proved_orbits};
use corner_impact::study::chaos::chaos;
use corner_impact::study::compare::compare;
use corner_impact::study::continuation::branches;
use corner_impact::study::curve::curves;
use corner_impact::study::design::{Asked, design};
use corner_impact::study::locate::locate;
use corner_impact::study::orbit::{OrbitQuery, orbits};
use corner_impact::study::simulate::{self, Sight, Simulation, Until};
use corner_impact::study::speeds::{speeds, usual_range};
use corner_impact::study::survey::{
    Beginning, Growth, Over, Sample, Section, Survey, Sweep, SweepError, SweepStart, growth,
};
use corner_impact::study::verify::{External, verify};
use corner_impact_cli::figures::cam_figure;
use corner_impact_cli::show::notes;
use corner_impact_plot::font::Fonts;
use corner_impact_plot::{LegendPlace, Look, Theme, TitleChoice, look, svg};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use rayon::prelude::*;

use crate::arrays::{Events, Rows};
use crate::error::{OrRaise, about_model};
use crate::page::Page;
use crate::studies;
use crate::values::{
    self, NamedValues, Rpm, Speeds, angle, angles, answer, broadcast, budget, counts, followed, in_units, item,
    refused, result, shaped, start, thread_count, within,
};
use crate::work::{alone, shared, spread};

/// A follower and its cam. A model never changes; another number makes another model.
///
/// Models come from `Model.load`, `Model.parse`, `Model.from_dict` and `Model.paper`. They are compared, hashed and pickled by
/// their text. Every fault of a model is a `ModelError`, a `ValueError` with `file`, `line` and `field`.
///
/// >>> from corner_impact import Model
/// >>> model = Model.paper()
/// >>> model
/// Model('osorio-2008')
/// >>> model.numbers()["follower.restitution"]
/// 0.8
#[pyclass(frozen, module = "corner_impact")]
#[derive(Clone)]
pub(crate) struct Model {
    pub(crate) model: model::Model,
    /// Over its cam, at any speed: it takes as long to make as a thousand revolutions.
    machine: Machine,
}

impl Model {
    fn new(model: model::Model) -> PyResult<Self> {
        let machine = Machine::new(Cam::new(&model).or_raise()?, &model.follower, 1.0);
        Ok(Self { model, machine })
    }

    /// Builds a model, and warns of each oddity.
    fn read(py: Python<'_>, model: model::Model) -> PyResult<Self> {
        for note in alone(py, || notes::notes(&model, None))?.or_raise()? {
            warn(py, note)?;
        }
        Self::new(model)
    }

    fn at(&self, rpm: f64) -> PyResult<Machine> {
        Ok(self.machine.at_speed(angular_velocity(values::speed(rpm)?)))
    }
}

/// Issues a warning.
pub(crate) fn warn(py: Python<'_>, words: String) -> PyResult<()> {
    let words = std::ffi::CString::new(words).unwrap_or_default();
    PyErr::warn(py, &py.get_type::<PyUserWarning>(), &words, 1)
}

#[pymethods]
impl Model {
    /// Reads a model file, and the table of lifts that it names, if any.
    ///
    /// Warns of oddities, such as a row of the table that looks like a slip. Raises ModelError if the file cannot be read or a field
    /// is wrong.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let read = alone(py, || model::Model::read(&path))?;
        if let Err(error) = &read
            && path.extension().is_some_and(|end| ["csv", "tsv", "txt", "dat"].iter().any(|table| end == *table))
            && error.to_string().contains("not valid TOML")
        {
            let hint = "a table of lifts has no follower: give both to Model.from_dict, with the table as cam rows";
            return Err(about_model(py, &format!("{error}; {hint}"), error)?);
        }
        Self::read(py, read.or_raise()?)
    }

    /// Reads the text of a model file. Complaints call it `file`; tables of lifts are looked for beside that file.
    ///
    /// Raises ModelError if a field is wrong.
    ///
    /// >>> model = Model.parse(Model.paper().text)
    /// >>> model == Model.paper()
    /// True
    /// >>> Model.parse("[follower]\nmass = -1")
    /// Traceback (most recent call last):
    ///     ...
    /// corner_impact.ModelError: model:2: follower.mass = -1: must be a finite number above 0
    #[staticmethod]
    #[pyo3(signature = (text, file="model"))]
    fn parse(py: Python<'_>, text: &str, file: &str) -> PyResult<Self> {
        Self::new(alone(py, || model::Model::parse(file, text))?.or_raise()?)
    }

    /// Builds a model from a dict of the tables and fields of a model file: dicts, lists or arrays, text and numbers.
    ///
    /// A table of lifts may be given as `rows`, shape (N, 2): angle in degrees, and lift. Warns and raises as `load` does.
    ///
    /// >>> import numpy as np
    /// >>> angle = np.arange(0.0, 360.0, 10.0)
    /// >>> lift = 0.05 - 0.01 * np.cos(np.radians(angle))
    /// >>> model = Model.from_dict({
    /// ...     "name": "measured",
    /// ...     "follower": {"mass": 1.0, "damping": 0.0, "stiffness": 400.0, "gravity": 9.81,
    /// ...                  "rest_position": 0.03, "restitution": 0.6},
    /// ...     "cam": {"law": "table", "spline": "quintic", "rows": np.column_stack([angle, lift])},
    /// ... })
    /// >>> model.name
    /// 'measured'
    #[staticmethod]
    #[pyo3(signature = (fields, name="dict"))]
    fn from_dict(fields: &Bound<'_, PyDict>, name: &str) -> PyResult<Self> {
        Self::read(fields.py(), model::Model::of_document(name, &item(fields.as_any())?).or_raise()?)
    }

    /// Returns the model of the paper: Osorio, di Bernardo, Santini 2008.
    #[staticmethod]
    fn paper() -> PyResult<Self> {
        Self::new(model::Model::built_in().or_raise()?)
    }

    /// Name of the model.
    #[getter]
    fn name(&self) -> &str {
        &self.model.name
    }

    /// Source of its numbers, in the author's words.
    #[getter]
    fn source(&self) -> &str {
        &self.model.source
    }

    /// Returns remarks about the model, a sentence each: the warnings of `load`, and the accuracy of a measured cam.
    ///
    /// Warnings about speeds refer to `rpm`, (lowest, highest), or to the model's `[study]`.
    ///
    /// >>> Model.paper().notes()
    /// []
    #[pyo3(signature = (rpm=None))]
    fn notes(&self, py: Python<'_>, rpm: Option<[f64; 2]>) -> PyResult<Vec<String>> {
        alone(py, || {
            let mut said = notes::notes(&self.model, rpm)?;
            said.extend(notes::as_drawn(&self.model)?);
            Ok::<_, model::ModelError>(said)
        })?
        .or_raise()
    }

    /// Text of a model file that needs no other file. Every number reads back as the same double; a table has its rows inside.
    #[getter]
    fn text(&self) -> String {
        self.model.text()
    }

    /// Returns the numbers of follower and cam by dotted path, in the model's units. `with_number` changes them.
    fn numbers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let numbers = PyDict::new(py);
        self.model.numbers().try_for_each(|(path, value)| numbers.set_item(path, value))?;
        Ok(numbers)
    }

    /// Returns the standard deviations of the numbers that have one, by dotted path, in the units of `numbers`.
    ///
    /// A model file gives them as `{"value": ..., "error": ...}` in the place of a number.
    ///
    /// >>> Model.paper().with_number("mass.error", 0.01).errors()
    /// {'follower.mass': 0.01}
    fn errors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let errors = PyDict::new(py);
        let numbers = self.model.numbers().filter_map(|(path, _)| Some((path, self.model.error_of(path)?)));
        numbers.into_iter().try_for_each(|(path, error)| errors.set_item(path, error))?;
        Ok(errors)
    }

    /// Returns the unit of a number of `numbers`, or of `rpm`; empty for a pure number.
    ///
    /// >>> Model.paper().unit("follower.stiffness")
    /// 'N/m'
    fn unit(&self, path: &str) -> String {
        self.model.units.of_number(path)
    }

    /// Returns the model with another number, named by its dotted path or by an unambiguous end of that path.
    ///
    /// The number becomes a part of the model's name. Raises ModelError if the model has no such number or does not allow the value.
    ///
    /// >>> Model.paper().with_number("restitution", 0.7)
    /// Model('osorio-2008 with follower.restitution = 0.7')
    fn with_number(&self, name: &str, value: f64) -> PyResult<Self> {
        Self::new(self.model.changed(&[(name.to_owned(), value)]).or_raise()?)
    }

    /// Evaluates the lift of the cam and its derivatives at angles of any shape: `angle`, `angle_rad` or `angle_deg`.
    ///
    /// Returns a `CamLift`: `lift_m`, `slope_m_rad`, `curvature_m_rad2` and `cam_angle_rad`, each of the shape of the angles. At a
    /// corner, derivatives are those after it. An angle that is not finite gives NaN.
    ///
    /// >>> Model.paper().cam([0.0]).lift_m
    /// array([0.4])
    #[pyo3(signature = (angle=None, *, angle_rad=None, angle_deg=None))]
    fn cam<'py>(
        &self,
        py: Python<'py>,
        angle: Option<&Bound<'py, PyAny>>,
        angle_rad: Option<&Bound<'py, PyAny>>,
        angle_deg: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (given, in_degrees) = angles("angle", [angle, angle_rad, angle_deg])?;
        let (given, shape) = broadcast(["angle"], [given])?;
        let at = |[angle]: [f64; 1]| {
            let angle = within_a_turn(if in_degrees { angle.to_radians() } else { angle });
            let lift = self.machine.cam().lift(angle);
            if angle.is_finite() { [lift.value, lift.slope, lift.curvature, angle] } else { [f64::NAN; 4] }
        };
        let rows: Vec<[f64; 4]> = given.into_iter().map(at).collect();
        let units = &self.model.units;
        // Derivatives are by the angle in rad, whatever the unit of angles.
        let names = ["lift_m", "slope_m", "curvature_m", "cam_angle_rad"];
        let found = in_units(shaped(py, names, &rows, &shape)?, units)?;
        let named = PyDict::new(py);
        for (name, values) in found {
            let unit = match name.extract::<&str>()? {
                name if name.starts_with("slope") => "_rad",
                name if name.starts_with("curvature") => "_rad2",
                _ => "",
            };
            named.set_item(format!("{name}{unit}"), values)?;
        }
        result("CamLift", named)
    }

    /// Simulates one run at `rpm` and returns its events over `revolutions`, after `transient` revolutions without a record.
    ///
    /// The run starts at `start_angle_rad` or `start_angle_deg` (0; `cam_angle` is an older name, in rad). The follower is on the cam
    /// and leaves it at `relative_velocity`, m/s, 0 or more (0), or it has `position`, m, and `velocity`, m/s.
    ///
    /// Returns an `Events` with one row an event, shape (N,): `revolution` (int64), `time_s`, `cam_angle_rad`, `event` (int8, an index
    /// of `corner_impact.EVENTS`), `position_m`, `velocity_before_m_s`, `velocity_after_m_s`, `cam_velocity_m_s`. These are the columns
    /// of `corner-impact simulate --events`.
    ///
    /// Raises ValueError if the start is below the cam, or if the run cannot go on.
    ///
    /// >>> events = Model.paper().simulate(700, 3, transient=300)
    /// >>> events.revolution
    /// array([300, 301, 302])
    /// >>> events.cam_angle_deg.round(6)
    /// array([155.303686, 155.303686, 155.303686])
    #[pyo3(signature = (rpm, revolutions=100, *, transient=0, start_angle_rad=None, start_angle_deg=None, cam_angle=None,
        relative_velocity=None, position=None, velocity=None))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn simulate<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = values::one_speed)] rpm: f64,
        #[pyo3(from_py_with = counts::revolutions)] revolutions: u64,
        #[pyo3(from_py_with = counts::transient)] transient: u64,
        start_angle_rad: Option<f64>,
        start_angle_deg: Option<f64>,
        cam_angle: Option<f64>,
        relative_velocity: Option<f64>,
        position: Option<f64>,
        velocity: Option<f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let cam_angle = start_angle([cam_angle, start_angle_rad, start_angle_deg])?;
        let machine = self.at(rpm)?;
        let start = start(cam_angle, relative_velocity, position, velocity)?;
        let run = || -> Result<Events, StudyError> {
            let mut first = start.motion(&machine)?;
            machine.revolve(&mut first, transient)?;
            let mut events = Events::new(start.cam_angle, machine.angular_velocity());
            let until = Until::Revolutions(revolutions);
            let wanted = simulate::RunRequest { until, events: true, strobe: None, drawn: 0, long_run: None };
            let simulation = Simulation::of(&self.model.name, rpm, machine, first);
            let run = simulation.run(wanted, &Unwatched, |sight| {
                if let Sight::Events(seen) = sight {
                    events.extend(seen);
                }
                Ok(())
            });
            run.map(|_| events)
        };
        result("Events", in_units(alone(py, run)?.or_raise()?.columns(py)?, &self.model.units)?)
    }

    /// Records events, or states at a section, at each of many speeds, or of many values of another number.
    ///
    /// `rpm` is a tuple (lowest, highest, how many) or any other one-dimensional sequence of speeds. With `over`, `rpm` is one speed
    /// and another number varies: (name, lowest, highest, how many) or (name, values). `log` spaces values by their logarithm.
    ///
    /// `record` revolutions are recorded after `transient` others. Each run starts as for `simulate`; with `follow`, "up" or "down", it
    /// starts where its neighbour ended. With `strobe_rad` or `strobe_deg` (`strobe` is an older name, in rad), states at that cam angle
    /// are recorded instead of events. `lyapunov` adds the growth rate of small deviations, as a natural logarithm per revolution.
    ///
    /// Returns a `Diagram` with the columns of `corner-impact diagram --out`, one row an event or state, shape (N,):
    ///
    /// - events: `rpm` or the name of the other number, `revolution`, `cam_angle_rad`, `event` (an index of `corner_impact.EVENTS`),
    ///   `position_m`, `velocity_before_m_s`, `velocity_after_m_s`;
    /// - states at a section: `rpm` or the name of the other number, `revolution`, `position_m`, `velocity_m_s`;
    /// - with `lyapunov`: `lyapunov_per_revolution`, `lyapunov_error`.
    ///
    /// A run that fails has one row, of event `failed` and revolution -1, with NaN.
    ///
    /// Raises ValueError if an argument is wrong.
    ///
    /// >>> Model.paper().diagram([690, 710], record=2).rpm
    /// array([690., 690., 710., 710.])
    #[pyo3(signature = (rpm, *, over=None, log=false, transient=300, record=100, strobe_rad=None, strobe_deg=None, strobe=None, follow=None,
        lyapunov=false, start_angle_rad=None, start_angle_deg=None, cam_angle=None, relative_velocity=None, position=None, velocity=None,
        threads=None))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn diagram<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = values::speeds)] rpm: Speeds,
        #[pyo3(from_py_with = values::over)] over: Option<NamedValues>,
        log: bool,
        #[pyo3(from_py_with = counts::transient)] transient: u64,
        #[pyo3(from_py_with = counts::record)] record: u64,
        strobe_rad: Option<f64>,
        strobe_deg: Option<f64>,
        strobe: Option<f64>,
        follow: Option<&str>,
        lyapunov: bool,
        start_angle_rad: Option<f64>,
        start_angle_deg: Option<f64>,
        cam_angle: Option<f64>,
        relative_velocity: Option<f64>,
        position: Option<f64>,
        velocity: Option<f64>,
        #[pyo3(from_py_with = thread_count)] threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let cam_angle = start_angle([cam_angle, start_angle_rad, start_angle_deg])?;
        let (rpm, axis) = values::axis(&self.model, rpm, over, log)?;
        let name = axis.parameter.name().to_owned();
        let section = match angle("strobe", "strobe", [strobe, strobe_rad, strobe_deg])? {
            None => Section::Impacts,
            Some(angle) if angle.is_finite() => Section::Strobe(within_a_turn(angle)),
            Some(angle) => return refused(format!("strobe = {angle} must be a finite number")),
        };
        let following = match follow {
            None => SweepStart::Nothing,
            Some("up") => SweepStart::Up,
            Some("down") => SweepStart::Down,
            Some(other) => return refused(format!("follow = {other:?} must be None, \"up\" or \"down\"")),
        };
        let budget = Budget {
            transient,
            record: if lyapunov { within("record", record, [1, u64::MAX])? } else { record },
            ..Budget::CHART
        };
        let sweep = Sweep {
            over: Survey::new(&self.model, rpm, axis, None).or_raise()?,
            starts: Beginning::One(start(cam_angle, relative_velocity, position, velocity)?),
            following,
            transient,
            record,
            section,
            growth: lyapunov.then(|| -> Growth { Arc::new(move |machine, motion| growth(machine, motion, budget)) }),
        };
        let run = || {
            let mut rows = Rows::default();
            let found = sweep.run(threads, |_, block| {
                rows.append(block);
                Ok::<(), SweepError>(())
            });
            found.map(|_| rows)
        };
        let found = shared(py, run)?.or_raise()?;
        let found = found.columns(py, &name, matches!(section, Section::Strobe(_)), lyapunov)?;
        result("Diagram", in_units(found, &self.model.units)?)
    }

    /// Maps states at a cam angle to the states `revolutions` later.
    ///
    /// `position`, m, and `velocity`, m/s, are numbers or arrays that broadcast by the rules of numpy to some shape S. The cam angle is
    /// `cam_angle_rad` or `cam_angle_deg` (0; `cam_angle` is another name, in rad).
    ///
    /// Returns a `StrobeMap`: `position_m` and `velocity_m_s`, shape S, and with `jacobian` their derivatives by the start, shape
    /// S + (2, 2), rows first. An invalid start, such as one below the cam, gives NaN; the other starts are unaffected.
    ///
    /// Raises ValueError if the shapes do not broadcast.
    ///
    /// >>> Model.paper().strobe_map(700, [4.4, -9.0], -30.0).position_m
    /// array([3.67961464,        nan])
    #[pyo3(signature = (rpm, position, velocity, revolutions=1, *, cam_angle=None, cam_angle_rad=None, cam_angle_deg=None, jacobian=false,
        threads=Some(1)), text_signature = "($self, rpm, position, velocity, revolutions=1, *, cam_angle=None, cam_angle_rad=None, \
        cam_angle_deg=None, jacobian=False, threads=1)")]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn strobe_map<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = values::one_speed)] rpm: f64,
        position: &Bound<'py, PyAny>,
        velocity: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = counts::revolutions)] revolutions: u64,
        cam_angle: Option<f64>,
        cam_angle_rad: Option<f64>,
        cam_angle_deg: Option<f64>,
        jacobian: bool,
        #[pyo3(from_py_with = thread_count)] threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (starts, shape) = broadcast(["position", "velocity"], [position, velocity])?;
        let cam_angle = angle("cam_angle", "cam_angle", [cam_angle, cam_angle_rad, cam_angle_deg])?.unwrap_or(0.0);
        let cam_angle = start(cam_angle, None, None, None)?.cam_angle;
        let map = StroboscopicMap { machine: self.at(rpm)?, cam_angle };
        let image = |start: &[f64; 2]| -> [f64; 6] {
            let state = State { position: start[0], velocity: start[1] };
            let end = if jacobian {
                let carried = map.carry(state, revolutions);
                carried.map(|(to, by)| [to.position, to.velocity, by[(0, 0)], by[(0, 1)], by[(1, 0)], by[(1, 1)]])
            } else {
                let run = map.machine.start(cam_angle, state).and_then(|mut motion| {
                    map.machine.revolve(&mut motion, revolutions)?;
                    Ok(motion.state)
                });
                run.map(|to| [to.position, to.velocity, 0.0, 0.0, 0.0, 0.0])
            };
            end.unwrap_or([f64::NAN; 6])
        };
        let images = map_over(py, &starts, image, threads)?;
        let states: Vec<[f64; 2]> = images.iter().map(|image| [image[0], image[1]]).collect();
        let columns = shaped(py, ["position_m", "velocity_m_s"], &states, &shape)?;
        if jacobian {
            let entries = images.iter().flat_map(|image| image[2..].iter().copied()).collect();
            let shape = [shape.as_slice(), &[2, 2]].concat();
            columns.set_item("jacobian", PyArray1::from_vec(py, entries).reshape(shape)?)?;
        }
        result("StrobeMap", in_units(columns, &self.model.units)?)
    }

    /// Maps departures from the cam to the first impact after each.
    ///
    /// The follower leaves the cam at `cam_angle` or `cam_angle_rad`, rad, or `cam_angle_deg`, with `relative_velocity`, m/s, 0 or more.
    /// Both are numbers or arrays that broadcast by the rules of numpy to some shape S.
    ///
    /// Returns an `ImpactMap`: `cam_angle_rad` of the impact, `relative_velocity_m_s` after it, and `flight_s`, the time until it, each
    /// of shape S. An invalid start gives NaN, and so does one after which no impact follows.
    ///
    /// Raises ValueError if the shapes do not broadcast.
    ///
    /// >>> found = Model.paper().impact_map(700, [2.71], [79.0])
    /// >>> found.cam_angle_rad, found.relative_velocity_m_s
    /// (array([2.73919377]), array([75.2131057]))
    #[pyo3(signature = (rpm, cam_angle=None, relative_velocity=None, *, cam_angle_rad=None, cam_angle_deg=None, threads=Some(1)),
        text_signature = "($self, rpm, cam_angle=None, relative_velocity=None, *, cam_angle_rad=None, cam_angle_deg=None, threads=1)")]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn impact_map<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = values::one_speed)] rpm: f64,
        cam_angle: Option<&Bound<'py, PyAny>>,
        relative_velocity: Option<&Bound<'py, PyAny>>,
        cam_angle_rad: Option<&Bound<'py, PyAny>>,
        cam_angle_deg: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = thread_count)] threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (angles, in_degrees) = angles("cam_angle", [cam_angle, cam_angle_rad, cam_angle_deg])?;
        let Some(velocities) = relative_velocity else { return refused("relative_velocity is missing".into()) };
        let (starts, shape) = broadcast(["cam_angle", "relative_velocity"], [angles, velocities])?;
        let machine = self.at(rpm)?;
        let image = |[angle, velocity]: &[f64; 2]| -> [f64; 3] {
            let angle = within_a_turn(if in_degrees { angle.to_radians() } else { *angle });
            let next = next_impact(&machine, angle, *velocity).ok().flatten();
            next.map_or([f64::NAN; 3], |next| {
                let time = next.turned_since(angle) / machine.angular_velocity();
                [next.cam_angle, next.velocity_after - next.cam_velocity, time]
            })
        };
        let images = map_over(py, &starts, image, threads)?;
        let names = ["cam_angle_rad", "relative_velocity_m_s", "flight_s"];
        result("ImpactMap", in_units(shaped(py, names, &images, &shape)?, &self.model.units)?)
    }

    /// Finds the periodic orbits at `rpm` with `revolutions` in a period, and with `impacts` impacts, if given.
    ///
    /// With `guess`, position (m) and velocity (m/s) at cam angle 0, Newton's method finds the one orbit from there.
    ///
    /// Returns an `Orbits`, the document of `corner-impact orbit --json`. Raises ValueError if an argument is wrong or nothing is found
    /// from the guess.
    ///
    /// >>> [orbit.stable for orbit in Model.paper().orbits(680).orbits]
    /// [False, True, False]
    #[pyo3(signature = (rpm, revolutions=1, impacts=None, *, guess=None))]
    fn orbits<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = values::one_speed)] rpm: f64,
        #[pyo3(from_py_with = counts::revolutions)] revolutions: u64,
        impacts: Option<usize>,
        guess: Option<[f64; 2]>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let revolutions = within("revolutions", revolutions, [1, Search::MOST_REVOLUTIONS])?;
        let wanted = match (guess, impacts) {
            (None, impacts) => OrbitQuery::All(Search { revolutions, impacts }),
            (Some([position, velocity]), None) => OrbitQuery::Near(State { position, velocity }, revolutions),
            (Some(_), Some(_)) => {
                return refused("guess and impacts: it is one orbit, or those of so many impacts".into());
            }
        };
        let rpm = values::speed(rpm)?;
        answer(
            py,
            "Orbits",
            &spread(py, || orbits(&self.model, rpm, wanted, &Unwatched))?.or_raise()?,
            &self.model.units,
        )
    }

    /// Finds the corner impacts between two speeds, (lowest, highest) rpm, of orbits with `revolutions` in a period.
    ///
    /// Returns a `Located`, the document of `corner-impact locate --json`. Raises ValueError if the range is invalid.
    ///
    /// >>> [round(impact.speed_rpm, 6) for impact in Model.paper().locate((670, 680)).corner_impacts]
    /// [673.234445]
    #[pyo3(signature = (rpm, revolutions=1))]
    fn locate<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = values::range)] rpm: (f64, f64),
        #[pyo3(from_py_with = counts::revolutions)] revolutions: u64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let [rpm_min, rpm_max] = values::speed_range(rpm)?;
        let revolutions = within("revolutions", revolutions, [1, Search::MOST_REVOLUTIONS])?;
        let range = model::Study { rpm_min, rpm_max };
        answer(
            py,
            "Located",
            &spread(py, || locate(&self.model, range, revolutions, &Unwatched))?.or_raise()?,
            &self.model.units,
        )
    }

    /// Finds the attractors over a range of speeds, (lowest, highest) rpm, and their births and deaths.
    ///
    /// Without `rpm` the range is the one that `corner-impact speeds` takes. With `over`, (name, lowest, highest), `rpm` is one speed and
    /// another number varies, with `log` on a logarithmic axis. There are at least `speeds` values, or steps of at most `step`, with
    /// `starts` starts at each. `two_impacts` adds starts on the stable orbits of two impacts in one revolution.
    ///
    /// With `states`, pairs of position (m) and velocity (m/s) at `start_angle_rad` or `start_angle_deg` (0; `cam_angle` is an older name,
    /// in rad), only those are started. A run settles within `transient` revolutions on a motion of a period up to `longest`; otherwise
    /// it is followed for `patience` and judged by `record` more.
    ///
    /// Returns a `SpeedSurvey`, the document of `corner-impact speeds --json`. Raises ValueError if an argument is wrong.
    #[pyo3(signature = (rpm=None, *, over=None, log=false, speeds=300, step=None, starts=64, two_impacts=false, states=None,
        start_angle_rad=None, start_angle_deg=None, cam_angle=None, transient=200, record=1600, longest=32, patience=100_000))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn speeds<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = values::rpm_if_any)] rpm: Option<Rpm>,
        #[pyo3(from_py_with = values::named_range_if_any)] over: Option<(String, f64, f64)>,
        log: bool,
        #[pyo3(from_py_with = counts::speeds)] speeds: u64,
        step: Option<f64>,
        #[pyo3(from_py_with = counts::starts)] starts: u64,
        two_impacts: bool,
        states: Option<Vec<[f64; 2]>>,
        start_angle_rad: Option<f64>,
        start_angle_deg: Option<f64>,
        cam_angle: Option<f64>,
        #[pyo3(from_py_with = counts::transient)] transient: u64,
        #[pyo3(from_py_with = counts::record)] record: u64,
        #[pyo3(from_py_with = counts::longest)] longest: u64,
        #[pyo3(from_py_with = counts::patience)] patience: u64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let cam_angle = start_angle([cam_angle, start_angle_rad, start_angle_deg])?;
        let (parameter, rpm, range) = match (rpm, over) {
            (Some(Rpm::One(rpm)), Some((name, low, high))) => {
                (Parameter::named(&self.model, &name).or_raise()?, Some(values::speed(rpm)?), [low, high])
            }
            (None, None) => (Parameter::Speed, None, usual_range(&self.model).or_raise()?),
            (Some(Rpm::Range(range)), None) => (Parameter::Speed, None, values::speed_range(range)?),
            _ => return refused("rpm is a range of speeds, and with over one speed".into()),
        };
        let spacing = values::spacing(log, range[0])?;
        let step = match step {
            None => Step::for_values(range, within("speeds", speeds, [2, 100_000])? as u32, spacing),
            Some(step) if step > 0.0 && step.is_finite() => Step::at_most(step, spacing),
            Some(step) => return refused(format!("step = {step} must be a finite number above 0")),
        };
        let starts = within("starts", starts, [1, 1_000_000])? as usize;
        let sample = match states {
            None => Sample::Spread(starts),
            Some(states) => {
                let start = |[position, velocity]: [f64; 2]| start(cam_angle, None, Some(position), Some(velocity));
                Sample::Given(states.into_iter().map(start).collect::<PyResult<_>>()?)
            }
        };
        let budget = budget(transient, record, longest, patience)?;
        let resolution = Resolution { step, sample, budget, two_impacts };
        let over = Over::new(&self.model, parameter, rpm).or_raise()?;
        answer(
            py,
            "SpeedSurvey",
            &spread(py, || self::speeds(&over, range, &resolution, &Unwatched))?.or_raise()?,
            &self.model.units,
        )
    }

    /// Computes the contact force, the speed at which the follower first leaves the cam, and the loads beyond it.
    ///
    /// The force is computed at `speeds` speeds over `rpm`, (lowest, highest), or around the separation. With `over`, (name, lowest,
    /// highest, how many) or (name, values), `rpm` is one speed and another number varies, with `log` on a logarithmic axis. For each of
    /// `needs`, such as "no separation to 700 rpm", it computes the preload, stiffness, damping and mass that would meet it.
    ///
    /// Returns a `Design`, the document of `corner-impact design --json`. Raises ValueError if an argument is wrong.
    ///
    /// >>> found = Model.paper().design(needs=["no separation to 130 rpm"])
    /// >>> round(found.separation.speed_rpm, 4)
    /// 114.9793
    /// >>> {need.parameter: need.value is not None for need in found.needs}
    /// {'preload': True, 'stiffness': True, 'damping': False, 'mass': True}
    #[pyo3(signature = (rpm=None, *, over=None, log=false, speeds=21, needs=Vec::new()),
        text_signature = "($self, rpm=None, *, over=None, log=False, speeds=21, needs=())")]
    fn design<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = values::rpm_if_any)] rpm: Option<Rpm>,
        #[pyo3(from_py_with = values::over)] over: Option<NamedValues>,
        log: bool,
        #[pyo3(from_py_with = counts::speeds)] speeds: u64,
        #[pyo3(from_py_with = values::words)] needs: Vec<String>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let need = |text: String| match text.parse() {
            Ok(need) => Ok((text, need)),
            Err(words) => refused(words),
        };
        if log && over.is_none() {
            return refused("log is of the number that over names".into());
        }
        let (rpm, over) = match (rpm, over) {
            (Some(Rpm::One(rpm)), Some(over)) => {
                let (_, axis) = values::axis(&self.model, Speeds::One(rpm), Some(over), log)?;
                (Some([rpm; 2]), Some(axis))
            }
            (_, Some((name, ..))) => return refused(format!("over {name}, rpm is one speed")),
            (Some(Rpm::One(rpm)), None) => (Some([values::speed(rpm)?; 2]), None),
            (Some(Rpm::Range(range)), None) => (Some(values::speed_range(range)?), None),
            (None, None) => (None, None),
        };
        let asked = Asked {
            rpm,
            over,
            speeds: within("speeds", speeds, [2, 10_000])? as u32,
            needs: needs.into_iter().map(need).collect::<PyResult<_>>()?,
            ..Asked::default()
        };
        answer(py, "Design", &spread(py, || design(&self.model, &asked, &Unwatched))?.or_raise()?, &self.model.units)
    }

    /// Finds the corner impact of the model's `[study]`, computes its map by every route, compares the routes, and classifies it.
    ///
    /// Without `external` the routes in Python are left out, as with `--no-external`. They need `pip install 'corner-impact[routes]'`; a
    /// route that does not run is listed in `skipped`. A route that should run and fails is warned about, too, and `agrees` is False.
    ///
    /// Returns a `Verification`, the document of `corner-impact verify --json`. Raises ValueError if there is no corner impact.
    ///
    /// >>> found = Model.paper().verify(external=False)
    /// >>> found.agrees, found.classification.scenario
    /// (True, 'nonsmooth-fold')
    #[pyo3(signature = (external=true))]
    fn verify<'py>(&self, py: Python<'py>, external: bool) -> PyResult<Bound<'py, PyAny>> {
        let external = if external { External::Run } else { External::LeftOut };
        let found = spread(py, || verify(&self.model, external))?.or_raise()?;
        for skipped in found.skipped.iter().filter(|skipped| skipped.failed) {
            warn(py, format!("the route {} failed, and so the routes do not agree: {}", skipped.route, skipped.why))?;
        }
        answer(py, "Verification", &found, &self.model.units)
    }

    /// Compares the results for this model with those for `other`: verdicts, fields, and every number that differs, with its error.
    ///
    /// Without `external` the routes in Python are left out, as with `--no-external`.
    ///
    /// Returns a `Comparison`, the document of `corner-impact compare --json`, in this model's units. Raises ValueError if the two have
    /// different units of length.
    ///
    /// >>> found = Model.paper().compare(Model.paper().with_number("restitution", 0.7), external=False)
    /// >>> found["verdict"]
    /// {'a': 'nonsmooth-fold', 'b': 'nonsmooth-fold'}
    /// >>> {change.quantity: round(change.difference, 6) for change in found.changes}["speed_rpm"]
    /// 11.412107
    #[pyo3(signature = (other, *, external=true))]
    fn compare<'py>(&self, py: Python<'py>, other: &Self, external: bool) -> PyResult<Bound<'py, PyAny>> {
        let external = if external { External::Run } else { External::LeftOut };
        let (a, b) = (&self.model, &other.model);
        answer(py, "Comparison", &spread(py, || compare(a, b, external, &Unwatched))?.or_raise()?, &a.units)
    }

    /// Proves, in ball arithmetic of `bits` bits, the corner impacts between two speeds, (lowest, highest) rpm, or in `[study]`.
    ///
    /// With `orbits` it proves the orbits of one and of two impacts at one speed `rpm`, or counts those of one impact at every speed of
    /// a range. It needs `pip install 'corner-impact[routes]'`.
    ///
    /// Returns a `Certificate`, the document of `corner-impact certify --json`. Raises ImportError if a package is missing, and
    /// ValueError if Python does not start.
    #[pyo3(signature = (rpm=None, revolutions=1, *, bits=128, orbits=false))]
    fn certify<'py>(
        &self,
        py: Python<'py>,
        rpm: Option<Bound<'py, PyAny>>,
        #[pyo3(from_py_with = counts::revolutions)] revolutions: u64,
        #[pyo3(from_py_with = counts::bits)] bits: u64,
        orbits: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let range = rpm.as_ref().map(|rpm| values::range(rpm).ok().map(values::speed_range).transpose());
        let range = range.transpose()?.flatten();
        let bits = within("bits", bits, [16, 16384])? as u32;
        let revolutions = within("revolutions", revolutions, [1, Search::MOST_REVOLUTIONS])?;
        match (range, rpm) {
            (Some(range), _) if orbits => answer(
                py,
                "Certificate",
                &spread(py, || proved_counts(&self.model, range, bits))?.or_raise()?,
                &self.model.units,
            ),
            (None, Some(rpm)) if orbits => {
                let rpm = values::speed(rpm.extract()?)?;
                answer(
                    py,
                    "Certificate",
                    &spread(py, || proved_orbits(&self.model, rpm, bits))?.or_raise()?,
                    &self.model.units,
                )
            }
            (None, None) if orbits => refused("orbits: at which rpm?".into()),
            (None, Some(rpm)) => refused(format!("rpm = {rpm} must be (lowest, highest)")),
            (range, _) => {
                let range = match range {
                    Some([rpm_min, rpm_max]) => model::Study { rpm_min, rpm_max },
                    None => self.model.study().or_raise()?,
                };
                answer(
                    py,
                    "Certificate",
                    &spread(py, || certify(&self.model, range, revolutions, bits, &Unwatched))?.or_raise()?,
                    &self.model.units,
                )
            }
        }
    }

    /// Finds the motion on which each start of a grid settles: the basins of attraction.
    ///
    /// The starts are at the cam angle `strobe_rad` or `strobe_deg` (0): the middles of `grid`, (cells along the positions, cells along
    /// the velocities), over `position`, (lowest, highest) m, and `velocity`, m/s. Without these ranges they follow from the orbits.
    /// `states`, pairs of position and velocity, replace the grid. At several speeds `rpm`, or over another number as for `diagram`, only
    /// the shares of the basins are found. `transient`, `record`, `longest` and `patience` are those of `speeds`.
    ///
    /// Returns a `Basins`, the document of `corner-impact basins --json`. With a grid at one speed, `ending` is an array, int32 of shape
    /// (velocities, positions): for each start the index in `endings`, or -1 if the start is below the cam or its run failed. `positions` and
    /// `velocities` are the starts along each axis. At several values it returns a `BasinShares`.
    ///
    /// Raises ValueError if an argument is wrong, or if a run fails that starts on no grid.
    ///
    /// >>> found = Model.paper().basins(678, (20, 20), strobe_deg=330)
    /// >>> found.ending.shape, [part.ending for part in found.endings]
    /// ((20, 20), ['periodic', 'chaotic'])
    #[pyo3(signature = (rpm, grid=None, *, over=None, log=false, strobe_rad=None, strobe_deg=None, position=None, velocity=None,
        states=None, transient=200, record=1600, longest=32, patience=100_000, threads=None))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn basins<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = values::speeds)] rpm: Speeds,
        grid: Option<[usize; 2]>,
        #[pyo3(from_py_with = values::over)] over: Option<NamedValues>,
        log: bool,
        strobe_rad: Option<f64>,
        strobe_deg: Option<f64>,
        position: Option<[f64; 2]>,
        velocity: Option<[f64; 2]>,
        states: Option<Vec<[f64; 2]>>,
        #[pyo3(from_py_with = counts::transient)] transient: u64,
        #[pyo3(from_py_with = counts::record)] record: u64,
        #[pyo3(from_py_with = counts::longest)] longest: u64,
        #[pyo3(from_py_with = counts::patience)] patience: u64,
        #[pyo3(from_py_with = thread_count)] threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let strobe = angle("strobe", "strobe_rad", [None, strobe_rad, strobe_deg])?.unwrap_or(0.0);
        let begun = studies::begun(grid, [position, velocity], states)?;
        let starts = (start(strobe, None, None, None)?.cam_angle, begun);
        let (budget, model) = (budget(transient, record, longest, patience)?, &self.model);
        match (rpm, over) {
            (Speeds::One(rpm), None) => studies::basins(py, model, values::speed(rpm)?, starts, budget, threads),
            (rpm, over) => {
                let survey = values::axis(model, rpm, over, log)?;
                studies::basin_shares(py, model, survey, &starts, budget, threads)
            }
        }
    }

    /// Follows the periodic orbits at `rpm` through a number, past folds and corners. Python keeps the word `continue` for itself.
    ///
    /// `over` is (name, lowest, highest); the name may be "rpm". The orbits have `revolutions` in a period, and `impacts` impacts, if
    /// given. `step` is the longest step, relative to the range and to a radian. A branch is given up after `points` orbits in either
    /// direction. Orbits that branch off with twice the period, or cross a branch, are followed `doublings` times in turn (0 to 10).
    ///
    /// Returns a `Branches`, the document of `corner-impact continue --json`. Raises ValueError if there is no such orbit.
    ///
    /// >>> [len(branch.points) > 10 for branch in Model.paper().continue_(700, ("rpm", 690, 710)).branches]
    /// [True, True, True]
    #[pyo3(signature = (rpm, over, *, revolutions=1, impacts=None, step=0.02, points=2000, doublings=0))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn continue_<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = values::one_speed)] rpm: f64,
        #[pyo3(from_py_with = values::named_range)] over: (String, f64, f64),
        #[pyo3(from_py_with = counts::revolutions)] revolutions: u64,
        impacts: Option<usize>,
        step: f64,
        #[pyo3(from_py_with = counts::points)] points: u64,
        #[pyo3(from_py_with = counts::doublings)] doublings: u64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let rpm = values::speed(rpm)?;
        let search =
            Search { revolutions: within("revolutions", revolutions, [1, Search::MOST_REVOLUTIONS])?, impacts };
        let doublings = within("doublings", doublings, [0, 10])? as u32;
        let following = followed(&self.model, over, step, points)?;
        let found = spread(py, || branches(&self.model, rpm, &search, following, doublings, &Unwatched))?;
        answer(py, "Branches", &found.or_raise()?, &self.model.units)
    }

    /// Follows the bifurcations between two speeds, (lowest, highest) rpm, through a number of the model.
    ///
    /// `over` is (name, lowest, highest). `events` are some of "corner", "fold", "flip", "graze", "detachment" and "resting"; without
    /// them, all. The orbits have `revolutions` in a period, and `impacts` impacts, if given. `step` and `points` are those of
    /// `continue_`.
    ///
    /// Returns a `Curves`, the document of `corner-impact curve --json`. Raises ValueError if an argument is wrong.
    ///
    /// >>> found = Model.paper().curve((665, 680), ("restitution", 0.79, 0.81), events=["corner"])
    /// >>> [curve.event for curve in found.curves]
    /// ['corner']
    #[pyo3(signature = (rpm, over, *, events=Vec::new(), revolutions=1, impacts=None, step=0.02, points=2000),
        text_signature = "($self, rpm, over, *, events=(), revolutions=1, impacts=None, step=0.02, points=2000)")]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn curve<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = values::range)] rpm: (f64, f64),
        #[pyo3(from_py_with = values::named_range)] over: (String, f64, f64),
        #[pyo3(from_py_with = values::words)] events: Vec<String>,
        #[pyo3(from_py_with = counts::revolutions)] revolutions: u64,
        impacts: Option<usize>,
        step: f64,
        #[pyo3(from_py_with = counts::points)] points: u64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (range, events) = (values::speed_range(rpm)?, studies::bifurcations(&events)?);
        let search =
            Search { revolutions: within("revolutions", revolutions, [1, Search::MOST_REVOLUTIONS])?, impacts };
        let following = followed(&self.model, over, step, points)?;
        let found = spread(py, || curves(&self.model, range, &search, &events, &following, &Unwatched))?;
        answer(py, "Curves", &found.or_raise()?, &self.model.units)
    }

    /// Proves that chaotic motions exist at one speed, or at every speed of a range, (lowest, highest) rpm.
    ///
    /// `trapping` also looks for regions at the lowest speed that no motion leaves.
    ///
    /// Returns a `Chaos`, the document of `corner-impact chaos --json`; `theorems` is empty if nothing is proved. Raises ValueError if a
    /// run cannot go on.
    ///
    /// >>> [theorem.symbols.tolist() for theorem in Model.paper().chaos(670).theorems]
    /// [[2, 3, 4, 5, 6]]
    #[pyo3(signature = (rpm, *, trapping=false))]
    fn chaos<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = values::rpm)] rpm: Rpm,
        trapping: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let range = match rpm {
            Rpm::One(rpm) => [values::speed(rpm)?; 2],
            Rpm::Range(range) => values::speed_range(range)?,
        };
        let found = spread(py, || chaos(&self.model, range, trapping, &Unwatched))?.or_raise()?;
        answer(py, "Chaos", &found, &self.model.units)
    }

    /// Draws a figure of the report by its name, or lists all figures if `id` is None.
    ///
    /// `rpm`, (lowest, highest), are the speeds of the figures that show no corner impact.
    ///
    /// Returns a `Figure`, the document of `corner-impact figure --json` with every number that is drawn; `svg` is the picture, which a
    /// notebook shows. The list is a `Figures`. Raises ValueError if there is no such figure, or if the model has none.
    ///
    /// >>> Model.paper().figure("cam").title
    /// 'osorio-2008: lift, velocity and acceleration of the cam'
    #[pyo3(signature = (id=None, *, rpm=None))]
    fn figure<'py>(
        &self,
        py: Python<'py>,
        id: Option<&str>,
        #[pyo3(from_py_with = values::range_if_any)] rpm: Option<(f64, f64)>,
    ) -> PyResult<Bound<'py, PyAny>> {
        studies::figure(py, &self.model, id, rpm.map(values::speed_range).transpose()?)
    }

    /// Explains a name: a number as `verify` names it, a label or claim of the paper, a tolerance, a field, or a column.
    ///
    /// Without `external` the routes in Python are left out, as with `--no-external`.
    ///
    /// Returns an `Explanation`, the document of `corner-impact explain --json`: meaning, formula, inputs, the value by every route, code,
    /// derivation, tests and place in the paper. Warns if the model has no value. Raises ValueError if nothing has that name.
    ///
    /// >>> Model.paper().explain("B_minus", external=False).label
    /// 'eq:PT'
    #[pyo3(signature = (what, *, external=true))]
    fn explain<'py>(&self, py: Python<'py>, what: &str, external: bool) -> PyResult<Bound<'py, PyAny>> {
        let external = if external { External::Run } else { External::LeftOut };
        studies::explain(py, &self.model, what, external)
    }

    fn __repr__(&self) -> String {
        format!("Model('{}')", self.model.name.escape_default())
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| other.get().model.text() == self.model.text())
    }

    fn __hash__(&self) -> u64 {
        use std::hash::{DefaultHasher, Hash, Hasher};
        let mut hasher = DefaultHasher::new();
        self.model.text().hash(&mut hasher);
        hasher.finish()
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String, String))> {
        let model = &slf.get().model;
        let class: Bound<'py, PyType> = slf.get_type();
        Ok((class.getattr("parse")?, (model.text(), model.file().to_owned())))
    }

    /// Picture of the cam's lift, velocity and acceleration.
    fn _repr_svg_(&self) -> PyResult<String> {
        svg::render(&cam_figure(&self.model, self.machine.cam(), &self.model.name), &Look::default()).or_raise()
    }

    /// Returns a picture of the cam's lift, velocity and acceleration as SVG, with the options of the command.
    ///
    /// Raises ValueError if an option is wrong.
    #[pyo3(signature = (*, width = None, height = None, size = None, font = None, title = None, legend = None, theme = None, x_range = None,
        y_range = None))]
    #[expect(clippy::too_many_arguments, reason = "the options of the command")]
    fn cam_picture(
        &self,
        width: Option<&str>,
        height: Option<&str>,
        size: Option<&str>,
        font: Option<&str>,
        title: Option<Title>,
        legend: Option<&str>,
        theme: Option<&str>,
        x_range: Option<[f64; 2]>,
        y_range: Option<[f64; 2]>,
    ) -> PyResult<String> {
        let length = |name: &str, text: Option<&str>| text.map(|text| told(name, text, look::length)).transpose();
        let look = Look {
            width: length("width", width)?,
            height: length("height", height)?,
            size: length("size", size)?,
            fonts: Some(font.map_or_else(|| Ok(Fonts::default()), Fonts::named).or_raise()?),
            title: match title {
                None => TitleChoice::OffPaper,
                Some(Title::Shown(true)) => TitleChoice::Shown,
                Some(Title::Shown(false)) => TitleChoice::Hidden,
                Some(Title::Words(words)) => TitleChoice::Words(words),
            },
            legend: legend.map_or(Ok(LegendPlace::default()), |text| told("legend", text, LegendPlace::named))?,
            theme: theme.map_or(Ok(Theme::default()), |text| told("theme", text, Theme::named))?,
            x: x_range.map(|range| told("x_range", range, look::ends)).transpose()?,
            y: y_range.map(|range| told("y_range", range, look::ends)).transpose()?,
        };
        let (look, units) = (look.checked().or_raise()?, &self.model.units);
        let figure = cam_figure(&self.model, self.machine.cam(), &self.model.name).in_units(|unit| units.spelled(unit));
        svg::render(&look.framed(figure).or_raise()?, &look).or_raise()
    }

    /// Returns the live page of the model, as `corner-impact explore --out` writes it. A notebook shows the page.
    ///
    /// Raises RuntimeError if the package was built without the page's module.
    fn explore(&self, py: Python<'_>) -> PyResult<Page> {
        py.detach(|| Page::of(self))
    }
}

/// Returns the cam angle at the start, rad, given by one of its three names.
pub(crate) fn start_angle(given: [Option<f64>; 3]) -> PyResult<f64> {
    Ok(angle("start_angle", "cam_angle", given)?.unwrap_or(0.0))
}

/// Title of a picture: whether the figure's own is shown, or other words.
#[derive(FromPyObject)]
enum Title {
    Shown(bool),
    Words(String),
}

/// Reads an option of a picture as the command does.
fn told<V, T>(name: &str, value: V, read: impl FnOnce(V) -> Result<T, String>) -> PyResult<T> {
    read(value).or_else(|why| refused(format!("{name} {why}")))
}

/// Computes the images of some starts in parallel on `threads` threads.
fn map_over<T: Send>(
    py: Python<'_>,
    starts: &[[f64; 2]],
    image: impl Fn(&[f64; 2]) -> T + Send + Sync,
    threads: Option<usize>,
) -> PyResult<Vec<T>> {
    if threads == Some(1) {
        return alone(py, || starts.iter().map(image).collect());
    }
    let pool = || corner_impact::study::survey::threads(threads);
    shared(py, || Ok(pool()?.install(|| starts.par_iter().map(image).collect())))?
        .map_err(|error: SweepError| crate::error::raised(&error))
}
