//! Brute-force bifurcation diagrams: what a machine settles on, speed by speed.
//!
//! Each speed runs through a transient and is then recorded. From a fixed start the speeds are independent and run side by
//! side; followed up or down, each starts where the one before ended. What is recorded leaves in the order of the speeds
//! whatever the number of threads, in blocks, so that memory does not grow with the length of a record.

mod growth;
mod pipeline;
mod places;

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::cam::apart;
use crate::estimate::Estimate;
use crate::flight::State;
use crate::simulate::{Event, EventKind, Machine, Motion, SimulateError, Unobserved};
use crate::tolerance;
pub use growth::{Record, growth};
pub use pipeline::{Block, Counted, Tally, threads};
pub use places::Places;

/// What is recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Section {
    /// Every event at the cam.
    Impacts,
    /// The state at one cam angle, rad, in `[0, 2 pi)`, once a revolution.
    Strobe(f64),
}

/// Where each speed starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Following {
    /// From the same start.
    Nothing,
    /// From the end of the next lower speed.
    Up,
    /// From the end of the next higher speed.
    Down,
}

/// The start of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Cam angle, rad, in `[0, 2 pi)`.
    pub cam_angle: f64,
    /// The follower there.
    pub follower: Placed,
}

/// A follower at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Placed {
    /// With this state.
    At(State),
    /// On the cam, leaving it at this velocity, m/s, zero or more.
    OnCam(f64),
}

impl Start {
    /// A motion of `machine` from here.
    pub fn motion(&self, machine: &Machine) -> Result<Motion, SimulateError> {
        match self.follower {
            Placed::At(state) => machine.start(self.cam_angle, state),
            Placed::OnCam(relative_velocity) => machine.start_on_cam(self.cam_angle, relative_velocity),
        }
    }
}

/// The motions of a machine that are looked at, each found before.
pub type Find = Arc<dyn Fn(&Machine) -> Result<Vec<Motion>, SimulateError> + Send + Sync>;

/// Where the runs of a speed begin.
#[derive(Clone)]
pub enum Starts {
    /// One run, from one start at every speed.
    One(Start),
    /// A run from each motion that is found for the speed.
    Found(Find),
}

impl Starts {
    /// The motions of `machine` to begin with.
    fn motions(&self, machine: &Machine) -> Result<Vec<Motion>, SimulateError> {
        match self {
            Self::One(start) => Ok(vec![start.motion(machine)?]),
            Self::Found(find) => find(machine),
        }
    }
}

/// Speeds, or values of another number, evenly spaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speeds {
    /// Lowest, rpm.
    pub low: f64,
    /// Highest, rpm.
    pub high: f64,
    /// How many, 1 or more.
    pub count: usize,
}

impl Speeds {
    /// The fastest that is turned, rpm: an angle keeps its digits only over times that a double resolves.
    pub const FASTEST: f64 = 1e9;
    /// The most speeds of one sweep.
    pub const MOST: usize = 10_000_000;

    /// The one of an index below `count`; the last is `high` exactly.
    pub fn value(&self, index: usize) -> f64 {
        if index + 1 >= self.count && self.count > 1 {
            return self.high;
        }
        self.low + (self.high - self.low) * (index as f64 / (self.count.max(2) - 1) as f64)
    }
}

/// How fast a small deviation of what a motion comes to grows in a revolution, a natural logarithm.
pub type Growth = Arc<dyn Fn(&Machine, Motion) -> Result<Estimate, SimulateError> + Send + Sync>;

/// A sweep over speeds.
#[derive(Clone)]
pub struct Sweep {
    /// The machine at the lowest speed: each has one of its own, over the same cam.
    pub machine: Machine,
    /// The speeds.
    pub speeds: Speeds,
    /// Where each starts.
    pub starts: Starts,
    /// Whether each goes on from its neighbour.
    pub following: Following,
    /// Revolutions that are not recorded.
    pub transient: u64,
    /// Revolutions that are.
    pub record: u64,
    /// What of them.
    pub section: Section,
    /// How the growth of a small deviation a revolution is found, if it is.
    pub growth: Option<Growth>,
}

/// What a record consists of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Speed, rpm.
    pub rpm: f64,
    /// How often the cam has passed angle 0 since the start at this speed.
    pub revolution: u64,
    /// Which of the motions found for this speed it belongs to.
    pub motion: Option<usize>,
    /// What was seen.
    pub seen: Seen,
    /// The growth of a small deviation at this speed per revolution, if asked for.
    pub growth: Option<Estimate>,
}

/// Cam angles, rad, of the impacts that a machine settles on: those of `record` revolutions after `transient` from rest on
/// the cam at angle 0.
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

/// After how many impacts their places on the cam, rad, recur, as far as a picture can show; `None` where they do not, as often
/// as there are impacts for.
pub(crate) fn recurrence(angles: &[f64]) -> Option<usize> {
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

/// Why a sweep stopped.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the message says what each number is")]
pub enum SweepError {
    /// A run could not go on.
    #[error("at {rpm} rpm: {error}")]
    Simulate { rpm: f64, error: SimulateError },
    /// The threads could not be started.
    #[error("threads cannot be started: {0}")]
    Threads(String),
}

impl Sweep {
    fn machine_at(&self, rpm: f64) -> Machine {
        self.machine.at_speed(crate::simulate::angular_velocity(rpm))
    }

    /// Records one speed from `motion`, row by row, and returns where it ended; stops early where `keep` breaks.
    fn speed(
        &self,
        machine: &Machine,
        rpm: f64,
        mut motion: Motion,
        which: Option<usize>,
        mut keep: impl FnMut(Row) -> ControlFlow<()>,
    ) -> Result<(Motion, ControlFlow<()>), SimulateError> {
        let growth = self.growth.as_ref().map(|growth| growth(machine, motion)).transpose()?;
        machine.revolve(&mut motion, self.transient)?;
        let row = |revolution, seen| Row { rpm, revolution, motion: which, seen, growth };
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
