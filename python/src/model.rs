//! A model, and all that is asked of one.

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
use corner_impact::study::compare::compare;
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
use pyo3::exceptions::{PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use rayon::prelude::*;

use crate::arrays::{Events, Rows, columns};
use crate::error::OrRaise;
use crate::page::Page;
use crate::values::{
    self, Rpm, budget, count, document, in_units, item, numbers, pairs, refused, start, thread_count, within,
};
use crate::work::{alone, shared, spread};

/// A follower and its cam. What a model is does not change: another number makes another model.
///
/// Models come from `Model.load`, `Model.parse`, `Model.from_dict` and `Model.paper`; they are compared, hashed and pickled by
/// their text. Whatever is wrong with one is a `ModelError`, a `ValueError` with `file`, `line` and `field`.
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

    /// Read from somewhere, with a warning for each thing that is odd about it.
    fn read(py: Python<'_>, model: model::Model) -> PyResult<Self> {
        for note in alone(py, || notes::notes(&model, None))?.or_raise()? {
            let note = std::ffi::CString::new(note).map_err(|error| PyValueError::new_err(error.to_string()))?;
            PyErr::warn(py, &py.get_type::<PyUserWarning>(), &note, 1)?;
        }
        Self::new(model)
    }

    fn at(&self, rpm: f64) -> PyResult<Machine> {
        Ok(self.machine.at_speed(angular_velocity(values::speed(rpm)?)))
    }
}

#[pymethods]
impl Model {
    /// The model in a file, with the table of lifts that it names, if any.
    ///
    /// Warns of what is odd about it, such as a row of the table that is a slip. Raises ModelError where the file cannot be read or a
    /// field of it is wrong.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        Self::read(py, alone(py, || model::Model::read(&path))?.or_raise()?)
    }

    /// The model that the text of a model file describes; `file` is what complaints call it, and tables of lifts are looked for
    /// beside it.
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

    /// The model that a dict describes: the tables and fields of a model file, as dicts, lists (or arrays), text and numbers.
    /// Lifts of a table may stand in it as `rows`, N x 2: angle in degrees and lift. Warns as `load` does.
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

    /// The model of the paper: Osorio, di Bernardo, Santini 2008.
    #[staticmethod]
    fn paper() -> PyResult<Self> {
        Self::new(model::Model::built_in().or_raise()?)
    }

    /// Its name.
    #[getter]
    fn name(&self) -> &str {
        &self.model.name
    }

    /// Where its numbers come from, in the author's words.
    #[getter]
    fn source(&self) -> &str {
        &self.model.source
    }

    /// What there is to say before anything is computed with it, a sentence each: what `load` warns of, at speeds `rpm`, a pair, or
    /// those of its `[study]`; and how well a measured cam is known.
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

    /// The model as the text of a model file that needs no other: every number in digits that read back as the same double,
    /// and the rows of a table inside.
    #[getter]
    fn text(&self) -> String {
        self.model.text()
    }

    /// The numbers of follower and cam, by dotted path: those that `with_number` changes and a chart varies.
    fn numbers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let numbers = PyDict::new(py);
        self.model.numbers().try_for_each(|(path, value)| numbers.set_item(path, value))?;
        Ok(numbers)
    }

    /// The standard deviations of the numbers that have an error, by dotted path, in the units of `numbers`. They come from
    /// `{"value": ..., "error": ...}` in the place of a number.
    ///
    /// >>> Model.paper().with_number("mass.error", 0.01).errors()
    /// {'follower.mass': 0.01}
    fn errors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let errors = PyDict::new(py);
        let numbers = self.model.numbers().filter_map(|(path, _)| Some((path, self.model.error_of(path)?)));
        numbers.into_iter().try_for_each(|(path, error)| errors.set_item(path, error))?;
        Ok(errors)
    }

    /// The unit of a number of `numbers`, or of `rpm`, as the model's answers have it; empty for a pure number.
    ///
    /// >>> Model.paper().unit("follower.stiffness")
    /// 'N/m'
    fn unit(&self, path: &str) -> String {
        self.model.units.of_number(path)
    }

    /// The same model with another number, by dotted path or by the end of one that no other has; it becomes a part of the name.
    ///
    /// >>> Model.paper().with_number("restitution", 0.7)
    /// Model('osorio-2008 with follower.restitution = 0.7')
    fn with_number(&self, name: &str, value: f64) -> PyResult<Self> {
        Self::new(self.model.changed(&[(name.to_owned(), value)]).or_raise()?)
    }

    /// Lift and derivatives of the cam, at angles in rad, N of any size: `lift_m`, `slope_m_rad` and `curvature_m_rad2`, N each;
    /// at a corner those after it, and not a number where the angle is none.
    ///
    /// >>> Model.paper().cam([0.0])["lift_m"]
    /// array([0.4])
    fn cam<'py>(&self, py: Python<'py>, angle: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let mut found = [const { Vec::new() }; 3];
        for angle in numbers("angle", angle)? {
            let lift = self.machine.cam().lift(within_a_turn(angle));
            let values = [lift.value, lift.slope, lift.curvature];
            found.iter_mut().zip(values).for_each(|(column, value)| {
                column.push(if angle.is_finite() { value } else { f64::NAN });
            });
        }
        let [lift, slope, curvature] = found;
        let columns = columns!(py, "lift_m": lift, "slope_m_rad": slope, "curvature_m_rad2": curvature);
        in_units(columns, &self.model.units)
    }

    /// The events of `revolutions` of one run at `rpm`, after `transient` revolutions that are not recorded.
    ///
    /// It starts at `cam_angle`, rad: on the cam, which the follower leaves at `relative_velocity`, m/s, 0 or more (0 without
    /// it), or with `position`, m, and `velocity`, m/s. Columns, one row an event: `revolution` (int64), `time_s`,
    /// `cam_angle_rad`, `event` (int8, a place in `corner_impact.EVENTS`), `position_m`, `velocity_before_m_s`,
    /// `velocity_after_m_s`, `cam_velocity_m_s`: those of `corner-impact simulate --events`.
    ///
    /// Raises ValueError where the start is below the cam, or the run cannot go on.
    ///
    /// >>> events = Model.paper().simulate(700, 3, transient=300)
    /// >>> events["revolution"]
    /// array([300, 301, 302])
    /// >>> import numpy as np
    /// >>> np.degrees(events["cam_angle_rad"]).round(6)
    /// array([155.303686, 155.303686, 155.303686])
    #[pyo3(signature = (rpm, revolutions=100, *, transient=0, cam_angle=0.0, relative_velocity=None, position=None,
        velocity=None))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn simulate<'py>(
        &self,
        py: Python<'py>,
        rpm: f64,
        #[pyo3(from_py_with = count)] revolutions: u64,
        #[pyo3(from_py_with = count)] transient: u64,
        cam_angle: f64,
        relative_velocity: Option<f64>,
        position: Option<f64>,
        velocity: Option<f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
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
        in_units(alone(py, run)?.or_raise()?.columns(py)?, &self.model.units)
    }

    /// Events, or states at a section, over a range of speeds: `record` revolutions after `transient` at each of `rpm`, (lowest, highest, how
    /// many). With `over`, (name, lowest, highest, how many), another number varies at the one speed `rpm`, and the first column has its
    /// name. With `log` values are spaced by their logarithm.
    ///
    /// Each starts at `cam_angle` on the cam or as for `simulate`, or, with `follow` "up" or "down", where its neighbour ended. With
    /// `strobe`, an angle in rad, the states there are recorded instead of events. `lyapunov` adds the growth of a small deviation a
    /// revolution, a natural logarithm, and its error. Columns: those of `corner-impact diagram --out` in its order: `rpm`,
    /// `revolution`, `cam_angle_rad`, `event` (a place in `corner_impact.EVENTS`), `position_m`, `velocity_before_m_s`,
    /// `velocity_after_m_s`, or with `strobe` `rpm`, `revolution`, `position_m`, `velocity_m_s`; and `lyapunov_per_revolution`,
    /// `lyapunov_error`. A speed whose run cannot go on has a row of its own, the event `failed` of revolution -1 without numbers.
    ///
    /// >>> found = Model.paper().diagram((690, 710, 3), record=2)
    /// >>> found["rpm"]
    /// array([690., 690., 700., 700., 710., 710.])
    #[pyo3(signature = (rpm, *, over=None, log=false, transient=300, record=100, strobe=None, follow=None, lyapunov=false, cam_angle=0.0,
        relative_velocity=None, position=None, velocity=None, threads=None))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn diagram<'py>(
        &self,
        py: Python<'py>,
        rpm: Rpm<(f64, f64, usize)>,
        over: Option<(String, f64, f64, usize)>,
        log: bool,
        #[pyo3(from_py_with = count)] transient: u64,
        #[pyo3(from_py_with = count)] record: u64,
        strobe: Option<f64>,
        follow: Option<&str>,
        lyapunov: bool,
        cam_angle: f64,
        relative_velocity: Option<f64>,
        position: Option<f64>,
        velocity: Option<f64>,
        #[pyo3(from_py_with = thread_count)] threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (rpm, axis) = values::axis(&self.model, rpm, over, log)?;
        let name = axis.parameter.name().to_owned();
        let section = match strobe {
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
        in_units(found.columns(py, &name, strobe.is_some(), lyapunov)?, &self.model.units)
    }

    /// Where `revolutions` take the states `position`, m, and `velocity`, m/s, N each, at `cam_angle`, rad: `position_m` and
    /// `velocity_m_s`, N each, and with `jacobian` their derivatives by the start, N x 2 x 2, rows first. A start below the cam, one
    /// that is not a number and a run that cannot go on come to NaN.
    ///
    /// >>> model = Model.paper()
    /// >>> found = model.strobe_map(700, [4.4, -9.0], [-30.0, 0.0])
    /// >>> found["position_m"]
    /// array([3.67961464,        nan])
    #[pyo3(signature = (rpm, position, velocity, revolutions=1, *, cam_angle=0.0, jacobian=false, threads=Some(1)),
        text_signature = "($self, rpm, position, velocity, revolutions=1, *, cam_angle=0.0, jacobian=False, threads=1)")]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn strobe_map<'py>(
        &self,
        py: Python<'py>,
        rpm: f64,
        position: &Bound<'py, PyAny>,
        velocity: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = count)] revolutions: u64,
        cam_angle: f64,
        jacobian: bool,
        #[pyo3(from_py_with = thread_count)] threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let starts = pairs(["position", "velocity"], position, velocity)?;
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
        let columns = columns!(py,
            "position_m": images.iter().map(|image| image[0]).collect::<Vec<_>>(),
            "velocity_m_s": images.iter().map(|image| image[1]).collect::<Vec<_>>(),
        );
        if jacobian {
            let entries = images.iter().flat_map(|image| image[2..].iter().copied()).collect::<Vec<_>>();
            columns.set_item("jacobian", PyArray1::from_vec(py, entries).reshape([images.len(), 2, 2])?)?;
        }
        in_units(columns, &self.model.units)
    }

    /// The first impact after the follower leaves the cam at `cam_angle`, rad, with `relative_velocity`, m/s, 0 or more, N each:
    /// `cam_angle_rad`, `relative_velocity_m_s` after it, and `flight_s`, the time from the one to the other, N each. NaN where no
    /// impact follows, and for a start that is none.
    ///
    /// >>> found = Model.paper().impact_map(700, [2.71], [79.0])
    /// >>> found["cam_angle_rad"], found["relative_velocity_m_s"]
    /// (array([2.73919377]), array([75.2131057]))
    #[pyo3(signature = (rpm, cam_angle, relative_velocity, *, threads=Some(1)),
        text_signature = "($self, rpm, cam_angle, relative_velocity, *, threads=1)")]
    fn impact_map<'py>(
        &self,
        py: Python<'py>,
        rpm: f64,
        cam_angle: &Bound<'py, PyAny>,
        relative_velocity: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = thread_count)] threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let starts = pairs(["cam_angle", "relative_velocity"], cam_angle, relative_velocity)?;
        let machine = self.at(rpm)?;
        let image = |[angle, velocity]: &[f64; 2]| -> [f64; 3] {
            let angle = within_a_turn(*angle);
            let next = next_impact(&machine, angle, *velocity).ok().flatten();
            next.map_or([f64::NAN; 3], |next| {
                let time = next.turned_since(angle) / machine.angular_velocity();
                [next.cam_angle, next.velocity_after - next.cam_velocity, time]
            })
        };
        let images = map_over(py, &starts, image, threads)?;
        let columns = columns!(py,
            "cam_angle_rad": images.iter().map(|image| image[0]).collect::<Vec<_>>(),
            "relative_velocity_m_s": images.iter().map(|image| image[1]).collect::<Vec<_>>(),
            "flight_s": images.iter().map(|image| image[2]).collect::<Vec<_>>(),
        );
        in_units(columns, &self.model.units)
    }

    /// The periodic orbits at `rpm` with so many `revolutions` in a period, and with so many `impacts`, if given; or the one that
    /// Newton's method finds from `guess`, position and velocity at cam angle 0: the document of `corner-impact orbit --json`.
    ///
    /// >>> found = Model.paper().orbits(680)
    /// >>> [orbit["stable"] for orbit in found["orbits"]]
    /// [False, True, False]
    #[pyo3(signature = (rpm, revolutions=1, impacts=None, *, guess=None))]
    fn orbits<'py>(
        &self,
        py: Python<'py>,
        rpm: f64,
        #[pyo3(from_py_with = count)] revolutions: u64,
        impacts: Option<usize>,
        guess: Option<(f64, f64)>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let revolutions = within("revolutions", revolutions, [1, Search::MOST_REVOLUTIONS])?;
        let wanted = match (guess, impacts) {
            (None, impacts) => OrbitQuery::All(Search { revolutions, impacts }),
            (Some((position, velocity)), None) => OrbitQuery::Near(State { position, velocity }, revolutions),
            (Some(_), Some(_)) => {
                return refused("guess and impacts: it is one orbit, or those of so many impacts".into());
            }
        };
        let rpm = values::speed(rpm)?;
        document(py, &spread(py, || orbits(&self.model, rpm, wanted, &Unwatched))?.or_raise()?, &self.model.units)
    }

    /// The corner impacts over a range of speeds, (lowest, highest) rpm, of orbits with so many `revolutions` in a period: the
    /// document of `corner-impact locate --json`.
    ///
    /// >>> found = Model.paper().locate((670, 680))
    /// >>> [round(impact["speed_rpm"], 6) for impact in found["corner_impacts"]]
    /// [673.234445]
    #[pyo3(signature = (rpm, revolutions=1))]
    fn locate<'py>(
        &self,
        py: Python<'py>,
        rpm: (f64, f64),
        #[pyo3(from_py_with = count)] revolutions: u64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let [rpm_min, rpm_max] = values::speed_range(rpm)?;
        let revolutions = within("revolutions", revolutions, [1, Search::MOST_REVOLUTIONS])?;
        let range = model::Study { rpm_min, rpm_max };
        document(
            py,
            &spread(py, || locate(&self.model, range, revolutions, &Unwatched))?.or_raise()?,
            &self.model.units,
        )
    }

    /// The attractors over a range of speeds, (lowest, highest) rpm, or over the one that `corner-impact speeds` takes, or at one speed over
    /// another number, `over` (name, lowest, highest), with `log` on a logarithmic axis: at `speeds`
    /// values or more, or from one to the next at most `step`, with `starts` starts at each, and on the stable orbits of two
    /// impacts in one revolution with `two_impacts`: the document of `corner-impact speeds --json`. With `states`, (position, velocity) each at
    /// `cam_angle`, those are the starts. `transient`, `record`, `longest` and `patience` are the options of that command.
    #[pyo3(signature = (rpm=None, *, over=None, log=false, speeds=300, step=None, starts=64, two_impacts=false, states=None, cam_angle=0.0, transient=200,
        record=1600, longest=32, patience=100_000))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn speeds<'py>(
        &self,
        py: Python<'py>,
        rpm: Option<Rpm<(f64, f64)>>,
        over: Option<(String, f64, f64)>,
        log: bool,
        #[pyo3(from_py_with = count)] speeds: u64,
        step: Option<f64>,
        #[pyo3(from_py_with = count)] starts: u64,
        two_impacts: bool,
        states: Option<Vec<[f64; 2]>>,
        cam_angle: f64,
        #[pyo3(from_py_with = count)] transient: u64,
        #[pyo3(from_py_with = count)] record: u64,
        #[pyo3(from_py_with = count)] longest: u64,
        #[pyo3(from_py_with = count)] patience: u64,
    ) -> PyResult<Bound<'py, PyDict>> {
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
        document(
            py,
            &spread(py, || self::speeds(&over, range, &resolution, &Unwatched))?.or_raise()?,
            &self.model.units,
        )
    }

    /// What an engineer asks: the contact force and the speed of the first separation, loads beyond it, and for each of `needs`, such
    /// as "no separation to 700 rpm", what the preload, the stiffness, the damping and the mass would have to be. At `speeds`
    /// speeds over `rpm`, (lowest, highest), or around the separation, or at one speed and values of another number, `over` (name, lowest,
    /// highest, how many), with `log` on a logarithmic axis: the document of `corner-impact design --json`.
    ///
    /// >>> found = Model.paper().design(needs=["no separation to 130 rpm"])
    /// >>> round(found["separation"]["speed_rpm"], 4)
    /// 114.9793
    /// >>> {need["parameter"]: need["value"] is not None for need in found["needs"]}
    /// {'preload': True, 'stiffness': True, 'damping': False, 'mass': True}
    #[pyo3(signature = (rpm=None, *, over=None, log=false, speeds=21, needs=Vec::new()),
        text_signature = "($self, rpm=None, *, over=None, log=False, speeds=21, needs=())")]
    fn design<'py>(
        &self,
        py: Python<'py>,
        rpm: Option<Rpm<(f64, f64)>>,
        over: Option<(String, f64, f64, usize)>,
        log: bool,
        #[pyo3(from_py_with = count)] speeds: u64,
        needs: Vec<String>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let need = |text: String| match text.parse() {
            Ok(need) => Ok((text, need)),
            Err(words) => refused(words),
        };
        if log && over.is_none() {
            return refused("log is of the number that over names".into());
        }
        let (rpm, over) = match (rpm, over) {
            (Some(Rpm::One(rpm)), Some(over)) => {
                let (_, axis) = values::axis(&self.model, Rpm::One(rpm), Some(over), log)?;
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
        document(py, &spread(py, || design(&self.model, &asked, &Unwatched))?.or_raise()?, &self.model.units)
    }

    /// The corner impact of the model's `[study]`, its map by every route, all compared, and what happens there: the document of
    /// `corner-impact verify --json`. Without `external` the routes in Python are left out, as with `--no-external`; they need what
    /// `pip install 'corner-impact[routes]'` installs, and a route that does not run is listed in `skipped`.
    ///
    /// >>> found = Model.paper().verify(external=False)
    /// >>> found["agrees"], found["classification"]["scenario"]
    /// (True, 'nonsmooth-fold')
    #[pyo3(signature = (external=true))]
    fn verify<'py>(&self, py: Python<'py>, external: bool) -> PyResult<Bound<'py, PyDict>> {
        let external = if external { External::Run } else { External::LeftOut };
        document(py, &spread(py, || verify(&self.model, external))?.or_raise()?, &self.model.units)
    }

    /// What moved from this model to `other`: the verdicts, the fields that differ, and each number that changed with how far the difference
    /// may be off: the document of `corner-impact compare --json`, in this model's units. Without `external` the routes in Python are left
    /// out, as with `--no-external`.
    ///
    /// >>> found = Model.paper().compare(Model.paper().with_number("restitution", 0.7), external=False)
    /// >>> found["verdict"]
    /// {'a': 'nonsmooth-fold', 'b': 'nonsmooth-fold'}
    /// >>> {change["quantity"]: round(change["difference"], 6) for change in found["changes"]}["speed_rpm"]
    /// 11.412107
    #[pyo3(signature = (other, *, external=true))]
    fn compare<'py>(&self, py: Python<'py>, other: &Self, external: bool) -> PyResult<Bound<'py, PyDict>> {
        let external = if external { External::Run } else { External::LeftOut };
        let (a, b) = (&self.model, &other.model);
        document(py, &spread(py, || compare(a, b, external, &Unwatched))?.or_raise()?, &a.units)
    }

    /// What is proved in ball arithmetic of the corner impacts over a range of speeds, (lowest, highest) rpm, without it the model's
    /// `[study]`; with `orbits`, of the orbits of one impact and of two at one speed, or how many there are of one impact at every
    /// speed of a range. The document of `corner-impact certify --json`; needs what `pip install 'corner-impact[routes]'` installs.
    ///
    /// Raises ValueError where Python or a package of it is missing.
    #[pyo3(signature = (rpm=None, revolutions=1, *, bits=128, orbits=false))]
    fn certify<'py>(
        &self,
        py: Python<'py>,
        rpm: Option<Bound<'py, PyAny>>,
        #[pyo3(from_py_with = count)] revolutions: u64,
        #[pyo3(from_py_with = count)] bits: u64,
        orbits: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let range = rpm.as_ref().map(|rpm| rpm.extract::<(f64, f64)>().ok().map(values::speed_range).transpose());
        let range = range.transpose()?.flatten();
        let bits = within("bits", bits, [16, 16384])? as u32;
        let revolutions = within("revolutions", revolutions, [1, Search::MOST_REVOLUTIONS])?;
        match (range, rpm) {
            (Some(range), _) if orbits => {
                document(py, &spread(py, || proved_counts(&self.model, range, bits))?.or_raise()?, &self.model.units)
            }
            (None, Some(rpm)) if orbits => {
                let rpm = values::speed(rpm.extract()?)?;
                document(py, &spread(py, || proved_orbits(&self.model, rpm, bits))?.or_raise()?, &self.model.units)
            }
            (None, None) if orbits => refused("orbits: at which rpm?".into()),
            (None, Some(rpm)) => refused(format!("rpm = {rpm} must be (lowest, highest)")),
            (range, _) => {
                let range = match range {
                    Some([rpm_min, rpm_max]) => model::Study { rpm_min, rpm_max },
                    None => self.model.study().or_raise()?,
                };
                document(
                    py,
                    &spread(py, || certify(&self.model, range, revolutions, bits, &Unwatched))?.or_raise()?,
                    &self.model.units,
                )
            }
        }
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

    /// Lift, velocity and acceleration of the cam, as a picture.
    fn _repr_svg_(&self) -> PyResult<String> {
        svg::render(&cam_figure(&self.model, self.machine.cam(), &self.model.name), &Look::default()).or_raise()
    }

    /// Lift, velocity and acceleration of the cam, as an SVG in a look of the command's options.
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

    /// The live page of the model, as of `corner-impact explore --out`: change a number and see the dynamics change. A notebook shows it;
    /// `save` writes it to a file.
    ///
    /// Raises RuntimeError where the package was built without the page's module.
    fn explore(&self, py: Python<'_>) -> PyResult<Page> {
        py.detach(|| Page::of(self))
    }
}

/// A title: whether the figure's own is shown, or other words.
#[derive(FromPyObject)]
enum Title {
    Shown(bool),
    Words(String),
}

/// An option of a picture, read as the command reads it.
fn told<V, T>(name: &str, value: V, read: impl FnOnce(V) -> Result<T, String>) -> PyResult<T> {
    read(value).or_else(|why| refused(format!("{name} {why}")))
}

/// The images of some starts, side by side on `threads` threads.
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
