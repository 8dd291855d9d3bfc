//! Starts of the runs of a survey.

use std::f64::consts::TAU;

use crate::estimate::Estimate;
use crate::flight::State;
use crate::simulate::{Machine, Motion, SimulateError};

/// The start of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Cam angle, rad, in `[0, 2 pi)`.
    pub cam_angle: f64,
    /// The follower at the start.
    pub follower: Placed,
}

/// State of the follower at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Placed {
    /// A given state.
    At(State),
    /// A place on the cam, which the follower leaves at this velocity, m/s, zero or more.
    OnCam(f64),
}

impl Start {
    /// Starts a motion of `machine` here.
    pub fn motion(&self, machine: &Machine) -> Result<Motion, SimulateError> {
        match self.follower {
            Placed::At(state) => machine.start(self.cam_angle, state),
            Placed::OnCam(relative_velocity) => machine.start_on_cam(self.cam_angle, relative_velocity),
        }
    }
}

/// Starts of the runs of a survey, at each value of the number that varies.
#[derive(Clone, Debug, PartialEq)]
pub enum Sample {
    /// Number of starts that represent all motions of a machine.
    Spread(usize),
    /// These starts only.
    Given(Vec<Start>),
}

impl Sample {
    /// Number of starts.
    pub fn count(&self) -> usize {
        match self {
            Self::Spread(count) => *count,
            Self::Given(starts) => starts.len(),
        }
    }

    /// Share of `number` of its starts out of the `of` that were run. Only the share of a spread sample has an error.
    pub fn share(&self, number: usize, of: usize) -> Estimate {
        match self {
            Self::Spread(_) => Estimate::share(number, of),
            Self::Given(_) => Estimate::counted(number, of),
        }
    }
}

/// Starts on the cam: every motion that meets the cam leaves it with some relative velocity at some angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Starts {
    /// Highest relative velocity, m/s; the lowest is 0, and the angles go all around.
    pub fastest: f64,
}

impl Starts {
    /// Starts of a machine, up to the highest relative velocity that impacts can sustain.
    ///
    /// A flight returns to the cam with no more than its energy at the start plus the energy of the way down the lift. With the cam's
    /// largest velocity V, and w the velocity of that way down,
    ///
    /// ```text
    /// u' <= r (u + 2 V + w),   in the long run u <= r (2 V + w)/(1 - r)
    /// ```
    ///
    /// For a very small restitution the limit is the velocity that the cam gives; without loss it is ten times that.
    pub fn of(machine: &Machine) -> Self {
        /// Largest sustained velocity, in units of the velocity that the cam gives.
        const MOST_KEPT: f64 = 10.0;
        let (flight, segments) = (machine.flight(), machine.cam().segments());
        let steepest =
            segments.iter().flat_map(|segment| segment.bounds.slope).fold(0.0_f64, |most, one| most.max(one.abs()));
        let lowest = segments.iter().fold(f64::INFINITY, |low, segment| low.min(segment.bounds.lift[0]));
        let top = machine.cam().top();
        let force = flight.force(lowest).abs().max(flight.force(top).abs());
        let given = 2.0 * machine.angular_velocity() * steepest + (2.0 * force * (top - lowest)).sqrt();
        let r = machine.restitution();
        let kept = if r < 1.0 { (r / (1.0 - r)).min(MOST_KEPT) } else { MOST_KEPT };
        Self { fastest: given * kept.max(1.0) }
    }

    /// Start of an index: cam angle, rad, and relative velocity, m/s. Any number of starts from index 0 on fills the rectangle evenly.
    ///
    /// Uses steps of the plastic number's powers, the counterpart in two dimensions of the golden section.
    pub fn at(&self, index: usize) -> [f64; 2] {
        /// The root of x^3 = x + 1.
        const PLASTIC: f64 = 1.324_717_957_244_746;
        let place = |step: f64| ((index as f64 + 0.5) * step).fract();
        [TAU * place(1.0 / PLASTIC), self.fastest * place(1.0 / (PLASTIC * PLASTIC))]
    }

    /// Starts the motion of `machine` from the start of an index.
    pub fn motion(&self, machine: &Machine, index: usize) -> Result<Motion, SimulateError> {
        let [cam_angle, relative_velocity] = self.at(index);
        machine.start_on_cam(cam_angle, relative_velocity)
    }
}
