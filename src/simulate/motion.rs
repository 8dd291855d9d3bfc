//! State of cam and follower, and the goal of a run.

use std::f64::consts::TAU;

use super::ahead::Ahead;
use crate::cam::Lift;
use crate::flight::State;

/// State of cam and follower.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Number of times that the cam has passed angle 0 since the start.
    pub revolution: u64,
    /// Cam angle, rad, in `[0, 2 pi)`.
    pub cam_angle: f64,
    /// State of the follower.
    pub state: State,
    /// Whether the follower sticks to the cam.
    pub contact: bool,
    pub(super) segment: usize,
    /// Gap, m, if it is stored more accurately than the difference of two positions.
    #[doc(hidden)]
    pub gap: Option<f64>,
    /// Lift under the follower, if it was computed.
    pub(super) lift: Option<Lift>,
    /// Angle, rad, where the next impact is searched first: the last impact if the one before it was close, or a contact found by a leap.
    pub(super) expected: Option<f64>,
    /// Whether the last two impacts were at the same angle, to within the step that `again` takes.
    pub(super) settled: bool,
    pub(super) last_impact: f64,
    pub(super) known: LastLift,
    pub(super) chatter: Chatter,
    /// Part of the motion from which the run continues, if it was stopped between two events.
    pub(super) stopped: Option<Stopped>,
    /// State up to which an observer has seen the present flight, and the duration of that part, s.
    pub(super) seen: Option<(State, f64)>,
    /// Revolution of the last event, and the number of events in it so far, however often the run was split.
    pub(super) events: (u64, u32),
    /// Number of segments that the follower has followed from end to end in this contact, up to one more than the cam has.
    pub(super) followed: usize,
}

/// Time at which the sum of infinitely many impacts is used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Chatter {
    /// Sum that is used once it is accurate, whether the chatter ends before the run or after it.
    Anywhere,
    /// Sum that is used in the next step.
    Due,
    /// Sum that is used only if the chatter ends before the run; otherwise each impact up to the goal is simulated, and none beyond.
    WithinRun,
}

/// Flight or contact in which a run was stopped.
///
/// A stopped motion shows cam and follower at the stop, and continues from the beginning of that flight or contact. So a run has the same
/// events, bit for bit, wherever it is stopped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stopped {
    turns: u64,
    cam_angle: f64,
    state: State,
    segment: usize,
    gap: Option<f64>,
    lift: Option<Lift>,
    contact: bool,
    chatter: Chatter,
    /// Angle from the beginning of the part to the next event or segment, rad.
    until: f64,
    /// Next event, if the part is a flight.
    ahead: Option<Ahead>,
    /// Angle, state and contact shown at the stop.
    shown: (f64, State, bool),
}

impl Stopped {
    /// Part that begins at `motion` and lasts until `until`, rad.
    #[inline(always)]
    pub fn of(motion: &Motion, (until, ahead): (f64, Option<Ahead>)) -> Self {
        let Motion { revolution, cam_angle, state, segment, gap, lift, contact, chatter, .. } = *motion;
        let shown = (cam_angle, state, contact);
        Self { turns: revolution, cam_angle, state, segment, gap, lift, contact, chatter, until, ahead, shown }
    }

    /// Records that the run was stopped in this part where `motion` shows it.
    #[inline(always)]
    pub fn shown_by(mut self, motion: &Motion) -> Self {
        self.turns = motion.revolution - self.turns;
        self.shown = (motion.cam_angle, motion.state, motion.contact);
        self
    }

    /// Returns `motion` to the beginning of the part; gives the length of the part and the event at its end. A motion that was changed
    /// since the stop is left as it is.
    pub fn undo(self, motion: &mut Motion, omega: f64) -> Option<(f64, Option<Ahead>)> {
        let Self { cam_angle, state, segment, gap, lift, contact, chatter, until, ahead, shown, .. } = self;
        let revolution = motion.revolution.checked_sub(self.turns)?;
        if shown != (motion.cam_angle, motion.state, motion.contact) {
            return None;
        }
        let is_flight = !contact && chatter != Chatter::Due;
        let turned = self.turns as f64 * TAU + (motion.cam_angle - cam_angle);
        motion.seen = is_flight.then_some((motion.state, turned / omega));
        (motion.revolution, motion.cam_angle, motion.state, motion.segment) = (revolution, cam_angle, state, segment);
        (motion.gap, motion.lift, motion.contact, motion.chatter) = (gap, lift, contact, chatter);
        Some((until, ahead))
    }
}

/// Lift of a segment at an angle, rad, evaluated directly: the impacts of a settled motion are close to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LastLift {
    pub segment: usize,
    pub angle: f64,
    pub lift: Lift,
}

/// Goal of a run.
///
/// Later goals are greater.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Goal {
    /// See [`Motion::revolution`].
    pub revolution: u64,
    /// Cam angle, rad, in `[0, 2 pi)`.
    pub cam_angle: f64,
}

impl Goal {
    /// Goal after the cam has turned by `angle` from angle 0, rad, 0 or more.
    pub(crate) fn turned(angle: f64) -> Self {
        Self { revolution: (angle / TAU) as u64, cam_angle: angle % TAU }
    }
}

impl Motion {
    /// Returns a motion that simulates each impact up to the goal of a run, even if a chatter ends soon after the goal. Such a run depends
    /// on its goal up to rounding. Near the goal it resolves hops lower than the rounding of a gap better.
    pub(crate) fn with_each_impact(self) -> Self {
        Self { chatter: Chatter::WithinRun, ..self }
    }

    /// Goal `revolutions` later, at the present angle of the cam.
    pub fn after(&self, revolutions: u64) -> Goal {
        Goal { revolution: self.revolution.saturating_add(revolutions), cam_angle: self.cam_angle }
    }

    /// Next passage of `cam_angle`, rad, in `[0, 2 pi)`; a whole turn later if the cam is there now.
    pub fn next(&self, cam_angle: f64) -> Goal {
        Goal { revolution: self.revolution + u64::from(cam_angle <= self.cam_angle), cam_angle }
    }

    /// Remaining angle, rad; not above 0 after the goal.
    pub(super) fn left(&self, goal: &Goal) -> f64 {
        let turns = goal.revolution as f64 - self.revolution as f64;
        let within = goal.cam_angle - self.cam_angle;
        if turns == 0.0 { within } else { turns * TAU + within }
    }
}
