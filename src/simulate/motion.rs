//! Where cam and follower are, and where a run is to end.

use std::f64::consts::TAU;

use super::ahead::Ahead;
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
    pub(super) chatter: Chatter,
    /// Where the run goes on from, if it was stopped between two events.
    pub(super) stopped: Option<Stopped>,
    /// How much of the present stretch of flight an observer has seen already: from which state, s.
    pub(super) seen: Option<(State, f64)>,
    /// The revolution of the last event, and the events in it so far, however often the run was split.
    pub(super) events: (u64, u32),
}

/// When the sum of infinitely many impacts is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Chatter {
    /// As soon as it is known, whether it ends before the run does or not.
    Anywhere,
    /// Next.
    Due,
    /// Only where it ends before the run does: otherwise each impact up to there is looked for, and none beyond.
    WithinRun,
}

/// The stretch of flight or contact in which a run was stopped.
///
/// A motion that was stopped shows cam and follower where it was stopped, and goes on from where the stretch began, so that a run
/// has the same events, bit for bit, wherever it is stopped to be looked at.
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
    /// The next event, or the next segment, is so much after the stretch began, rad.
    until: f64,
    /// The next event, where the stretch is a flight.
    ahead: Option<Ahead>,
    /// Angle and state that the motion shows, and its stick.
    shown: (f64, State, bool),
}

impl Stopped {
    /// The stretch that begins where `motion` is, and is not over before `until`, rad.
    #[inline(always)]
    pub fn of(motion: &Motion, (until, ahead): (f64, Option<Ahead>)) -> Self {
        let Motion { revolution, cam_angle, state, segment, gap, lift, contact, chatter, .. } = *motion;
        let shown = (cam_angle, state, contact);
        Self { turns: revolution, cam_angle, state, segment, gap, lift, contact, chatter, until, ahead, shown }
    }

    /// The stretch, stopped where `motion` shows it.
    #[inline(always)]
    pub fn shown_by(mut self, motion: &Motion) -> Self {
        self.turns = motion.revolution - self.turns;
        self.shown = (motion.cam_angle, motion.state, motion.contact);
        self
    }

    /// Takes `motion` back to where the stretch began, and returns how long it lasts and what comes then; does nothing to a motion that was
    /// changed since.
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
    /// Sees each impact up to the goal of a run, also where infinitely many of them end soon after it. Such a run depends on its goal to
    /// rounding, and hops that are lower than the rounding of a gap are resolved better near it.
    pub(crate) fn with_each_impact(self) -> Self {
        Self { chatter: Chatter::WithinRun, ..self }
    }

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
