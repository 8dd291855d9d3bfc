//! Brute-force bifurcation diagrams: the motion on which a machine settles, value by value of one of its numbers.
//!
//! Each value runs through a transient and is then recorded. From a fixed start, the values are independent and run side by side; followed
//! up or down, each starts where the one before ended. Records are returned in the order of the values for any number of threads. They are
//! returned in blocks, so that memory does not grow with the length of a record.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::grid::Survey;
use super::starts::Start;
use crate::cam::apart;
use crate::estimate::Estimate;
use crate::flight::State;
use crate::simulate::{Event, EventKind, Machine, Motion, SimulateError, Unobserved};
use crate::tolerance;

/// The data that is recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Section {
    /// Every event at the cam.
    Impacts,
    /// The state at one cam angle, rad, in `[0, 2 pi)`, once a revolution.
    Strobe(f64),
}

/// Start of the run at each value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SweepStart {
    /// One start for all values.
    Nothing,
    /// End of the run at the next lower value.
    Up,
    /// End of the run at the next higher value.
    Down,
}

/// Function that finds the motions of a machine that are to be recorded.
pub type Find = Arc<dyn Fn(&Machine) -> Result<Vec<Motion>, SimulateError> + Send + Sync>;

/// Starts of the runs at a value.
#[derive(Clone)]
pub enum Beginning {
    /// One run, from one start at every value.
    One(Start),
    /// One run from each motion that is found for the value.
    Found(Find),
}

impl Beginning {
    /// Motions of `machine` to begin with.
    pub(super) fn motions(&self, machine: &Machine) -> Result<Vec<Motion>, SimulateError> {
        match self {
            Self::One(start) => Ok(vec![start.motion(machine)?]),
            Self::Found(find) => find(machine),
        }
    }
}

/// Function for the growth of a small deviation per revolution, a natural logarithm, of the motion on which a run settles.
pub type Growth = Arc<dyn Fn(&Machine, Motion) -> Result<Estimate, SimulateError> + Send + Sync>;

/// A sweep over the values of one number.
#[derive(Clone)]
pub struct Sweep {
    /// The machines.
    pub over: Survey,
    /// Start of each machine's runs.
    pub starts: Beginning,
    /// Whether each value continues from its neighbour.
    pub following: SweepStart,
    /// Revolutions before recording.
    pub transient: u64,
    /// Revolutions recorded.
    pub record: u64,
    /// The data that is recorded.
    pub section: Section,
    /// Function for the growth of a small deviation per revolution, if asked for.
    pub growth: Option<Growth>,
}

/// One row of a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordRow {
    /// Value of the number that varies; for the speed, rpm.
    pub value: f64,
    /// Number of times that the cam has passed angle 0 since the start at this value.
    pub revolution: u64,
    /// Index of the motion found for this value that the row belongs to.
    pub motion: Option<usize>,
    /// The event or state that was recorded.
    pub seen: Seen,
    /// Growth of a small deviation per revolution at this value, if asked for.
    pub growth: Option<Estimate>,
}

/// Cam angles, rad, of the impacts on which a machine settles, over `record` revolutions after `transient` revolutions from rest on the cam
/// at angle 0.
pub fn settled_impacts(machine: &Machine, transient: u64, record: u64) -> Result<Vec<f64>, SimulateError> {
    let mut motion = machine.start_on_cam(0.0, 0.0)?;
    machine.revolve(&mut motion, transient)?;
    let mut angles = Vec::new();
    machine.watch(&mut motion, record, |event| {
        if event.kind == EventKind::Impact {
            angles.push(event.cam_angle);
        }
    })?;
    Ok(angles)
}

/// Number of impacts after which their cam angles, rad, recur to the precision of a picture. `None` if they do not, within half of the
/// impacts given.
pub fn recurrence(angles: &[f64]) -> Option<usize> {
    let near = |(one, other): (&f64, &f64)| apart(*one, *other).to_degrees() <= tolerance::DRAWN_DEGREES.value;
    (1..=angles.len() / 2).find(|period| angles.iter().zip(&angles[*period..]).all(near))
}

/// An event, or the state on the section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Seen {
    /// An impact, stick or release.
    Event(Event),
    /// The follower on the section.
    Section(State),
}

impl Sweep {
    /// Records one value from `motion`, row by row, and returns where it ended; stops early if `keep` breaks.
    pub(super) fn record(
        &self,
        machine: &Machine,
        value: f64,
        mut motion: Motion,
        which: Option<usize>,
        mut keep: impl FnMut(RecordRow) -> ControlFlow<()>,
    ) -> Result<(Motion, ControlFlow<()>), SimulateError> {
        let growth = self.growth.as_ref().map(|growth| growth(machine, motion)).transpose()?;
        machine.revolve(&mut motion, self.transient)?;
        let row = |revolution, seen| RecordRow { value, revolution, motion: which, seen, growth };
        let goal = motion.after(self.record);
        let flow = match self.section {
            Section::Impacts => machine
                .advance(&mut motion, goal, &mut |event: &Event| keep(row(event.revolution, Seen::Event(*event))))?,
            Section::Strobe(cam_angle) => loop {
                let next = motion.next(cam_angle);
                let last = next > goal;
                let _ = machine.advance(&mut motion, if last { goal } else { next }, &mut Unobserved)?;
                if last {
                    break ControlFlow::Continue(());
                }
                if keep(row(motion.revolution, Seen::Section(motion.state))).is_break() {
                    break ControlFlow::Break(());
                }
            },
        };
        Ok((motion, flow))
    }
}
