//! Where cam and follower are, and where a run is to end.

use std::f64::consts::TAU;

use crate::cam::Lift;
use crate::flight::State;

/// Where cam and follower are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// How often the cam has passed angle 0 since the start.
    pub revolution: u64,
    /// Cam angle, rad, in `[0, 2 pi)`.
    pub cam_angle: f64,
    /// The follower.
    pub state: State,
    /// Whether the follower sticks to the cam.
    pub contact: bool,
    pub(super) segment: usize,
    /// The gap, m, where it is known better than as a difference of two positions.
    pub(super) gap: Option<f64>,
    /// The lift under the follower, where it is known.
    pub(super) lift: Option<Lift>,
    /// Where the last impact was, rad, if the one before it was close by, or where a leap found that there is one: the next is
    /// looked for there first.
    pub(super) expected: Option<f64>,
    /// Whether the last two impacts were at the same place to within the step that again takes.
    pub(super) settled: bool,
    pub(super) last_impact: f64,
    pub(super) known: Known,
    /// The revolution of the last event, and the events in it so far, however often the run was split.
    pub(super) events: (u64, u32),
}

/// An angle, rad, and a segment's lift there, evaluated and not summed: a settled motion's impacts are close to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Known {
    pub segment: usize,
    pub angle: f64,
    pub lift: Lift,
}

/// Where a run ends.
///
/// Later goals are greater.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Goal {
    /// As [`Motion::revolution`].
    pub revolution: u64,
    /// Cam angle, rad, in `[0, 2 pi)`.
    pub cam_angle: f64,
}

impl Goal {
    /// Where the cam is when it has turned by so much from angle 0, rad, 0 or more.
    pub(crate) fn turned(angle: f64) -> Self {
        Self { revolution: (angle / TAU) as u64, cam_angle: angle % TAU }
    }
}

impl Motion {
    /// The goal `revolutions` further on, at the angle where the cam is now.
    pub fn after(&self, revolutions: u64) -> Goal {
        Goal { revolution: self.revolution.saturating_add(revolutions), cam_angle: self.cam_angle }
    }

    /// The next passage of `cam_angle`, rad, in `[0, 2 pi)`; a whole turn if the cam is there now.
    pub fn next(&self, cam_angle: f64) -> Goal {
        Goal { revolution: self.revolution + u64::from(cam_angle <= self.cam_angle), cam_angle }
    }

    /// The angle still to turn, rad; not above 0 when the goal is passed.
    pub(super) fn left(&self, goal: &Goal) -> f64 {
        let turns = goal.revolution as f64 - self.revolution as f64;
        let within = goal.cam_angle - self.cam_angle;
        if turns == 0.0 { within } else { turns * TAU + within }
    }
}
