//! Records of runs, as columns.

use std::mem::take;

use corner_impact::simulate::{Event, EventKind};
use corner_impact::study::survey::{RecordBlock, RecordRow, Seen};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Kinds of events in the order of their codes.
const EVENTS: [EventKind; 3] = [EventKind::Impact, EventKind::Stick, EventKind::Release];

/// Code of the row of a diagram for a run that failed.
const FAILED: i8 = EVENTS.len() as i8;

/// Returns the names of the codes in a column `event`.
#[pyfunction]
pub(crate) fn events() -> Vec<&'static str> {
    EVENTS.iter().map(|kind| kind.name()).chain(["failed"]).collect()
}

fn code(kind: EventKind) -> i8 {
    EVENTS.iter().position(|known| *known == kind).map_or(FAILED, |code| code as i8)
}

/// Dict of columns that are handed over without copying; their names are made once.
macro_rules! columns {
    ($py:expr, $($name:literal: $column:expr),+ $(,)?) => {{
        let columns = PyDict::new($py);
        $(columns.set_item(pyo3::intern!($py, $name), PyArray1::from_vec($py, $column))?;)+
        columns
    }};
}

/// The events of one run, column by column.
#[derive(Default)]
pub(crate) struct Events {
    start_angle: f64,
    angular_velocity: f64,
    revolution: Vec<i64>,
    time_s: Vec<f64>,
    cam_angle_rad: Vec<f64>,
    event: Vec<i8>,
    position_m: Vec<f64>,
    velocity_before_m_s: Vec<f64>,
    velocity_after_m_s: Vec<f64>,
    cam_velocity_m_s: Vec<f64>,
}

impl Events {
    /// Builds an empty record of a run from a cam angle, rad.
    pub(crate) fn new(start_angle: f64, angular_velocity: f64) -> Self {
        Self { start_angle, angular_velocity, ..Self::default() }
    }

    /// Adds events column by column: each column then grows once for many events.
    pub(crate) fn extend(&mut self, events: &[Event]) {
        let (start_angle, angular_velocity) = (self.start_angle, self.angular_velocity);
        self.revolution.extend(events.iter().map(|event| event.revolution as i64));
        self.time_s.extend(events.iter().map(|event| event.turned_since(start_angle) / angular_velocity));
        self.cam_angle_rad.extend(events.iter().map(|event| event.cam_angle));
        self.event.extend(events.iter().map(|event| code(event.kind)));
        self.position_m.extend(events.iter().map(|event| event.position));
        self.velocity_before_m_s.extend(events.iter().map(|event| event.velocity_before));
        self.velocity_after_m_s.extend(events.iter().map(|event| event.velocity_after));
        self.cam_velocity_m_s.extend(events.iter().map(|event| event.cam_velocity));
    }

    pub(crate) fn columns(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        Ok(columns!(py,
            "revolution": self.revolution,
            "time_s": self.time_s,
            "cam_angle_rad": self.cam_angle_rad,
            "event": self.event,
            "position_m": self.position_m,
            "velocity_before_m_s": self.velocity_before_m_s,
            "velocity_after_m_s": self.velocity_after_m_s,
            "cam_velocity_m_s": self.cam_velocity_m_s,
        ))
    }
}

/// Rows of a diagram, column by column.
#[derive(Default)]
pub(crate) struct Rows {
    value: Vec<f64>,
    revolution: Vec<i64>,
    cam_angle_rad: Vec<f64>,
    event: Vec<i8>,
    position_m: Vec<f64>,
    /// Velocity before an impact; at a section, the velocity.
    velocity_before_m_s: Vec<f64>,
    velocity_after_m_s: Vec<f64>,
    growth: Vec<f64>,
    growth_error: Vec<f64>,
}

impl RecordBlock for Rows {
    fn push(&mut self, row: &RecordRow) {
        self.value.push(row.value);
        self.revolution.push(row.revolution as i64);
        match &row.seen {
            Seen::Event(event) => {
                self.cam_angle_rad.push(event.cam_angle);
                self.event.push(code(event.kind));
                self.position_m.push(event.position);
                self.velocity_before_m_s.push(event.velocity_before);
                self.velocity_after_m_s.push(event.velocity_after);
            }
            Seen::Section(state) => {
                self.position_m.push(state.position);
                self.velocity_before_m_s.push(state.velocity);
            }
        }
        if let Some(growth) = row.growth {
            self.growth.push(growth.value);
            self.growth_error.push(growth.error);
        }
    }

    fn is_full(&self) -> bool {
        self.value.len() >= 1024
    }

    /// Adds a row without numbers; columns that the diagram does not have are removed in the end.
    fn fail(&mut self, value: f64) -> bool {
        self.value.push(value);
        self.revolution.push(-1);
        self.event.push(FAILED);
        let numbers = [
            &mut self.cam_angle_rad,
            &mut self.position_m,
            &mut self.velocity_before_m_s,
            &mut self.velocity_after_m_s,
            &mut self.growth,
            &mut self.growth_error,
        ];
        numbers.into_iter().for_each(|column| column.push(f64::NAN));
        true
    }
}

impl Rows {
    /// Adds later rows.
    pub(crate) fn append(&mut self, mut rows: Self) {
        self.value.append(&mut rows.value);
        self.revolution.append(&mut rows.revolution);
        self.cam_angle_rad.append(&mut rows.cam_angle_rad);
        self.event.append(&mut rows.event);
        self.position_m.append(&mut rows.position_m);
        self.velocity_before_m_s.append(&mut rows.velocity_before_m_s);
        self.velocity_after_m_s.append(&mut rows.velocity_after_m_s);
        self.growth.append(&mut rows.growth);
        self.growth_error.append(&mut rows.growth_error);
    }

    pub(crate) fn columns<'py>(
        mut self,
        py: Python<'py>,
        over: &str,
        at_section: bool,
        lyapunov: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (growth, growth_error) = (take(&mut self.growth), take(&mut self.growth_error));
        let columns = PyDict::new(py);
        columns.set_item(over, PyArray1::from_vec(py, take(&mut self.value)))?;
        let seen = match at_section {
            true => columns!(py,
                "revolution": self.revolution,
                "position_m": self.position_m,
                "velocity_m_s": self.velocity_before_m_s,
            ),
            false => columns!(py,
                "revolution": self.revolution,
                "cam_angle_rad": self.cam_angle_rad,
                "event": self.event,
                "position_m": self.position_m,
                "velocity_before_m_s": self.velocity_before_m_s,
                "velocity_after_m_s": self.velocity_after_m_s,
            ),
        };
        columns.update(seen.as_mapping())?;
        if lyapunov {
            columns.set_item("lyapunov_per_revolution", PyArray1::from_vec(py, growth))?;
            columns.set_item("lyapunov_error", PyArray1::from_vec(py, growth_error))?;
        }
        Ok(columns)
    }
}
