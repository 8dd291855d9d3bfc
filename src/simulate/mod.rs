//! The only event loop: fly to the first contact, resolve it, or follow the cam until the follower is released.
//!
//! A [`Machine`] is a cam, a follower over it and a speed; a [`Motion`] is the present state of both. [`Machine::advance`] takes a motion
//! to a later angle and reports the events on the way to an [`Observer`]: impacts, the start of sticking, release. Time runs from the last
//! event and the cam angle stays in `[0, 2 pi)`, so neither a short hop nor the hundred-millionth revolution loses digits.
//!
//! | module | contents |
//! |---|---|
//! | `motion`, `event` | the state of cam and follower; the events of a run, and their observers |
//! | `ahead` | the next event of a flight |
//! | `terrain` | the cam with its seams, corners and bounds, as the loop uses it |
//! | `window` | part of a flight over one segment: free, or with its first contact |
//! | `contact` | the first root of the gap over a segment, certified |
//! | `leap` | a flight over many short segments at once |
//! | `repeat` | the next impact of a settled motion, one turn later: checked, not searched |
//! | `sticking` | the end of chatter, contact, release |
//! | `variation` | the propagation of a small deviation |
//! | `growth` | the growth rate of a small deviation |

mod ahead;
pub(crate) mod contact;
mod event;
mod growth;
mod leap;
mod motion;
mod repeat;
mod sticking;
mod terrain;
mod variation;
mod window;

use std::cell::Cell;
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::Arc;

use crate::cam::{Cam, Lift};
use crate::cancel;
use crate::flight::{Flight, State};
use crate::impact::relative_rebound;
use crate::model::Follower;
use crate::tolerance;
use ahead::{Again, Ahead, Leap, Passage};
pub use event::{Event, EventKind, ImpactTally, Observer, SimulateError, Unobserved, Work};
pub use growth::{Record, growth};
use motion::{Chatter, LastLift, Stopped};
pub use motion::{Goal, Motion};
use repeat::Turn;
pub use sticking::accumulation;
use terrain::CamBounds;
pub use variation::Variation;
use window::Window;

/// Number of steps of one search for a contact or a release after which a run fails. Examples are a follower that swings a million times
/// over one segment, or one pressed against it by a ten-millionth of the forces at work.
const MOST_STEPS: u32 = 10_000_000;

/// Cam, a follower over it, and the speed at which the cam turns.
#[derive(Clone, Debug)]
pub struct Machine {
    terrain: Arc<CamBounds>,
    flight: Flight,
    restitution: f64,
    angular_velocity: f64,
    turn: Turn,
    most_steps: u32,
}

/// Converts revolutions per minute to radians per second.
pub fn angular_velocity(rpm: f64) -> f64 {
    rpm * TAU / 60.0
}

impl Machine {
    /// Number of events in one revolution after which a run fails. A follower that chatters with restitution 0.99 makes thousands of
    /// events; one without progress makes infinitely many.
    const MOST_EVENTS: u32 = 1_000_000;

    /// Builds a machine that turns at `angular_velocity`, rad/s, positive.
    pub fn new(cam: Cam, follower: &Follower, angular_velocity: f64) -> Self {
        let flight = Flight::new(follower);
        Self {
            terrain: Arc::new(CamBounds::new(cam)),
            flight,
            restitution: follower.restitution,
            angular_velocity,
            turn: Turn::new(&flight, angular_velocity),
            most_steps: MOST_STEPS,
        }
    }

    /// Returns this machine at another speed, rad/s, positive; the cam is shared.
    pub fn at_speed(&self, angular_velocity: f64) -> Self {
        Self { angular_velocity, turn: Turn::new(&self.flight, angular_velocity), ..self.clone() }
    }

    /// Returns this machine with another cam.
    pub fn with_cam(&self, cam: Cam) -> Self {
        Self { terrain: Arc::new(CamBounds::new(cam)), ..self.clone() }
    }

    /// Returns this machine with another limit on the steps of a search.
    #[doc(hidden)]
    pub fn giving_up_after(&self, most_steps: u32) -> Self {
        Self { most_steps, ..self.clone() }
    }

    /// Cam with its lift profile.
    pub fn cam(&self) -> &Cam {
        &self.terrain.cam
    }

    /// Free flight of the follower.
    pub fn flight(&self) -> &Flight {
        &self.flight
    }

    /// Coefficient of restitution r, 0 to 1.
    pub fn restitution(&self) -> f64 {
        self.restitution
    }

    /// Speed omega, rad/s.
    pub fn angular_velocity(&self) -> f64 {
        self.angular_velocity
    }

    /// Starts a motion at `cam_angle`, rad, in `[0, 2 pi)`, with `state`; in contact if the follower rests against the cam.
    pub fn start(&self, cam_angle: f64, state: State) -> Result<Motion, SimulateError> {
        if !(0.0..TAU).contains(&cam_angle) {
            return Err(SimulateError::Start { cam_angle });
        }
        let angular_velocity = self.angular_velocity;
        if !(angular_velocity > 0.0 && angular_velocity.is_finite()) {
            return Err(SimulateError::Turn { angular_velocity, turn: 0.0 });
        }
        if !(state.position.is_finite() && state.velocity.is_finite()) {
            return Err(SimulateError::NotFinite { revolution: 0, cam_angle });
        }
        let segment = self.cam().segment_at(cam_angle);
        let lift = self.cam().segments()[segment].law.lift(cam_angle);
        let gap = state.position - lift.value;
        let rounding = self.gap_rounding(state.position);
        if gap < -rounding {
            return Err(SimulateError::BelowCam { depth: -gap, revolution: 0, cam_angle });
        }
        let mut motion = Motion {
            revolution: 0,
            cam_angle,
            state,
            contact: false,
            segment,
            gap: None,
            lift: None,
            expected: None,
            settled: false,
            last_impact: f64::NAN,
            known: LastLift { segment, angle: cam_angle, lift },
            chatter: Chatter::Anywhere,
            stopped: None,
            seen: None,
            events: (0, 0),
            followed: 0,
        };
        if gap <= rounding {
            let relative_velocity = state.velocity - self.angular_velocity * lift.slope;
            self.leave(&mut motion, &lift, relative_velocity);
        }
        Ok(motion)
    }

    /// Starts a motion on the cam at `cam_angle`, rad, leaving it at `relative_velocity`, m/s, zero or more.
    pub fn start_on_cam(&self, cam_angle: f64, relative_velocity: f64) -> Result<Motion, SimulateError> {
        let lift = self.cam().lift(cam_angle);
        let velocity = self.angular_velocity * lift.slope + relative_velocity;
        self.start(cam_angle, State { position: lift.value, velocity })
    }

    /// Continues `motion` at its angle on this machine, which may have another speed. A sticking follower remains sticking, unless the cam
    /// releases it at this speed.
    pub fn resume(&self, motion: &Motion) -> Result<Motion, SimulateError> {
        match motion.contact {
            true => self.start_on_cam(motion.cam_angle, 0.0),
            false => self.start(motion.cam_angle, motion.state),
        }
    }

    /// Puts the follower on the cam, whose lift there is `lift`, with a relative velocity, m/s. The follower sticks if the velocity is
    /// within rounding of zero and the follower is pressed against the cam.
    #[inline(always)]
    fn leave(&self, motion: &mut Motion, lift: &Lift, relative_velocity: f64) {
        let cam_velocity = self.angular_velocity * lift.slope;
        let is_none = relative_velocity.abs() <= self.velocity_rounding();
        let velocity = if is_none { cam_velocity } else { cam_velocity + relative_velocity };
        motion.state = State { position: lift.value, velocity };
        (motion.gap, motion.lift) = (Some(0.0), Some(*lift));
        (motion.contact, motion.followed) = (is_none && !self.lets_go(lift), 0);
    }

    /// Rounding error of the gap of a follower at `position`, m.
    fn gap_rounding(&self, position: f64) -> f64 {
        tolerance::GAP_ROUNDING.value * (position.abs() + self.terrain.size)
    }

    /// Rounding error of the relative velocity at the cam, m/s.
    fn velocity_rounding(&self) -> f64 {
        tolerance::RELATIVE_VELOCITY_ROUNDING.value * self.angular_velocity * self.terrain.steepest
    }

    /// Gap between follower and cam, m.
    pub fn gap(&self, motion: &Motion) -> f64 {
        let lift = || self.cam().segments()[motion.segment].law.lift(motion.cam_angle).value;
        motion.gap.unwrap_or_else(|| motion.state.position - lift())
    }

    /// Advances `motion` until the cam reaches `goal`, or until the observer breaks right after an event.
    ///
    /// An event in the last instant belongs to the run that continues from there; a stick is reported with the impact that led to it.
    /// Stopping a run anywhere changes no bit of its later course.
    pub fn advance(
        &self,
        motion: &mut Motion,
        goal: Goal,
        observer: &mut impl Observer,
    ) -> Result<ControlFlow<()>, SimulateError> {
        let mut stopped = None;
        if motion.left(&goal) > 0.0 {
            stopped = motion.stopped.take().and_then(|stopped| stopped.undo(motion, self.angular_velocity));
        }
        let mut steps = 0_u32;
        loop {
            // Checked at the start, and then every 64 steps.
            if steps.is_multiple_of(64) {
                cancel::check();
            }
            steps = steps.wrapping_add(1);
            if motion.contact && self.stays(motion, &goal) {
                stopped = None;
            }
            let left = motion.left(&goal);
            // At the end of the last segment a corner still follows.
            if !(left > 0.0) && motion.cam_angle < TAU {
                return Ok(ControlFlow::Continue(()));
            }
            let step = match stopped.take() {
                Some((until, ahead)) if left < until => Step::Reached { until, ahead },
                _ if motion.contact => self.follow(motion, left, observer)?,
                _ if motion.chatter == Chatter::Due => self.end_chatter(motion, left, observer),
                known => self.fly(motion, left, known.and_then(|(_, ahead)| ahead), observer)?,
            };
            match step {
                Step::Moved => {}
                Step::Event => self.counted(motion)?,
                Step::Reached { until, ahead } => {
                    let stopped = Stopped::of(motion, (until, ahead));
                    self.show_at(motion, goal, left, observer)?;
                    motion.stopped = Some(stopped.shown_by(motion));
                    return Ok(ControlFlow::Continue(()));
                }
                Step::Broken => {
                    self.counted(motion)?;
                    self.wrap(motion, observer)?;
                    return Ok(ControlFlow::Break(()));
                }
            }
        }
    }

    /// Sets cam and follower to their state at `goal`, `left` rad further in the present part of flight or contact.
    #[doc(hidden)]
    pub fn show_at(
        &self,
        motion: &mut Motion,
        goal: Goal,
        left: f64,
        observer: &mut impl Observer,
    ) -> Result<(), SimulateError> {
        if motion.chatter == Chatter::Due {
            // Within chatter: simulates each of the infinitely many impacts up to the goal.
            let mut shown = motion.with_each_impact();
            let _ = self.advance(&mut shown, goal, &mut Unobserved)?;
            let Motion { revolution, cam_angle, state, contact, segment, gap, lift, .. } = shown;
            let chatter = Chatter::Anywhere;
            *motion = Motion { revolution, cam_angle, state, contact, segment, gap, lift, chatter, ..*motion };
            return Ok(());
        }
        let segment = &self.cam().segments()[motion.segment];
        let angle = motion.cam_angle + left;
        if motion.contact {
            motion.state = on_cam(&segment.law.lift(angle), self.angular_velocity);
        } else {
            let time = left / self.angular_velocity;
            self.flown(motion, time, observer);
            let (displacement, state) = self.flight.fly(motion.state, time);
            let gap = motion.gap.filter(|_| angle <= segment.end);
            motion.gap = gap.map(|gap| gap + displacement - segment.law.rise(motion.cam_angle, left));
            motion.state = state;
        }
        motion.lift = None;
        (motion.revolution, motion.cam_angle) = (goal.revolution, goal.cam_angle);
        motion.segment = self.cam().segment_at(goal.cam_angle);
        self.above_cam(motion, || self.gap(motion))
    }

    /// Reports the part of a flight that an observer has not seen yet; the flight starts at `motion` and takes `time`, s.
    #[inline(always)]
    fn flown(&self, motion: &mut Motion, time: f64, observer: &mut impl Observer) {
        let (state, seen) = motion.seen.take().unwrap_or((motion.state, 0.0));
        observer.flight(&self.flight, state, time - seen);
    }

    /// Returns an error if a flight has passed through the cam. This is a fault of this program, and no run continues after it.
    #[inline(always)]
    #[doc(hidden)]
    pub fn above_cam(&self, motion: &Motion, gap: impl Fn() -> f64) -> Result<(), SimulateError> {
        let State { position, velocity } = motion.state;
        if position > self.terrain.top {
            return Ok(());
        }
        let gap = gap();
        if gap >= -tolerance::PASSED_THROUGH.value * (position.abs() + self.terrain.size) {
            return Ok(());
        }
        let (revolution, cam_angle, rpm) = (motion.revolution, motion.cam_angle, 60.0 * self.angular_velocity / TAU);
        Err(SimulateError::PassedThrough { depth: -gap, revolution, cam_angle, position, velocity, rpm })
    }

    /// Counts an event; returns an error if one revolution has more events than allowed.
    #[inline(always)]
    fn counted(&self, motion: &mut Motion) -> Result<(), SimulateError> {
        let Motion { revolution, cam_angle, events: (last, events), .. } = motion;
        *events = if last == revolution { *events + 1 } else { 1 };
        *last = *revolution;
        match *events > Self::MOST_EVENTS {
            true => Err(SimulateError::NoProgress { events: *events, revolution: *last, cam_angle: *cam_angle }),
            false => Ok(()),
        }
    }

    /// Advances `motion` by `revolutions` without an observer.
    pub fn revolve(&self, motion: &mut Motion, revolutions: u64) -> Result<(), SimulateError> {
        let goal = motion.after(revolutions);
        self.advance(motion, goal, &mut Unobserved).map(|_| ())
    }

    /// Advances `motion` to the next passage of `cam_angle`, rad, in `[0, 2 pi)`, without an observer.
    pub fn turn_to(&self, motion: &mut Motion, cam_angle: f64) -> Result<(), SimulateError> {
        let goal = motion.next(cam_angle);
        self.advance(motion, goal, &mut Unobserved).map(|_| ())
    }

    /// Advances `motion` by `revolutions`; `see` receives every event and cannot end the run.
    pub fn watch(
        &self,
        motion: &mut Motion,
        revolutions: u64,
        mut see: impl FnMut(&Event),
    ) -> Result<(), SimulateError> {
        let goal = motion.after(revolutions);
        let mut observer = |event: &Event| {
            see(event);
            ControlFlow::Continue(())
        };
        self.advance(motion, goal, &mut observer).map(|_| ())
    }

    /// Turns the cam by `turn`, rad, 0 or more, from `cam_angle`, rad, in `[0, 2 pi)`, and returns the state there.
    ///
    /// `observe` receives every event, and may end the run right after one.
    pub fn turn(
        &self,
        cam_angle: f64,
        start: State,
        turn: f64,
        mut observe: impl FnMut(&Event) -> ControlFlow<()>,
    ) -> Result<State, SimulateError> {
        if !(turn >= 0.0 && turn.is_finite()) {
            return Err(SimulateError::Turn { angular_velocity: self.angular_velocity, turn });
        }
        let mut motion = self.start(cam_angle, start)?;
        let (whole, angle) = ((turn / TAU).floor(), cam_angle + turn % TAU);
        let goal = Goal { revolution: whole as u64 + u64::from(angle >= TAU), cam_angle: angle % TAU };
        let _ = self.advance(&mut motion, goal, &mut observe)?;
        Ok(motion.state)
    }

    /// Flies over the top of the cam, or up to a contact or the end of a segment. The end of this flight does not depend on `left`, the
    /// rest of the run in rad. `known` is its next event if a run was stopped in it.
    #[inline(always)]
    fn fly<O: Observer>(
        &self,
        motion: &mut Motion,
        left: f64,
        known: Option<Ahead>,
        observer: &mut O,
    ) -> Result<Step, SimulateError> {
        let omega = self.angular_velocity;
        let ahead = match known {
            Some(ahead) => ahead,
            None => self.ahead(motion, left, observer),
        };
        let until = match &ahead {
            Ahead::Again(Again { time, .. })
            | Ahead::Top { time, .. }
            | Ahead::Leap(Leap { time, .. })
            | Ahead::Over { passage: Passage::Contact { time, .. } | Passage::NoProgress { time }, .. } => omega * time,
            Ahead::Never => f64::INFINITY,
            Ahead::Over { passage: Passage::Free { .. }, .. } => {
                let within = self.cam().segments()[motion.segment].end - motion.cam_angle;
                if left < within { within } else { f64::NEG_INFINITY }
            }
            Ahead::Over { passage: Passage::NotFinite, .. } => f64::NEG_INFINITY,
        };
        if !(until < left) {
            return Ok(Step::Reached { until, ahead: Some(ahead).filter(|_| motion.chatter != Chatter::WithinRun) });
        }
        let after = left - until;
        match ahead {
            Ahead::Again(again) => {
                if O::COUNTS {
                    observer.work(Work { repeats: 1, ..Work::default() });
                }
                self.flown(motion, again.time, observer);
                motion.revolution += 1;
                motion.cam_angle = again.cam_angle;
                Ok(self.strike(motion, again.velocity, &again.lift, after, observer))
            }
            Ahead::Top { time, state } => {
                self.flown(motion, time, observer);
                self.turn_over(motion, until);
                (motion.state, motion.gap, motion.lift) = (state, None, None);
                // A follower exactly at the top would count as above it again.
                if state.position <= self.terrain.top { Ok(Step::Moved) } else { Err(self.not_finite(motion)) }
            }
            Ahead::Never => Ok(Step::Reached { until, ahead: None }),
            Ahead::Leap(leap) => {
                self.flown(motion, leap.time, observer);
                (motion.state, motion.gap) = (self.flight.fly(motion.state, leap.time).1, None);
                motion.segment = leap.segment;
                self.enter_next(motion)?;
                if leap.lands {
                    motion.expected = Some(motion.cam_angle);
                }
                Ok(Step::Moved)
            }
            Ahead::Over { end, passage } => match passage {
                Passage::Free { state, gap } => {
                    self.flown(motion, end, observer);
                    (motion.state, motion.gap, motion.lift) = (state, gap, None);
                    self.enter_next(motion)?;
                    Ok(Step::Moved)
                }
                Passage::Contact { time, velocity, lift } => {
                    self.flown(motion, time, observer);
                    // A contact found at the segment's end belongs to this segment, regardless of rounding.
                    let last = self.cam().segments()[motion.segment].end;
                    motion.cam_angle = (motion.cam_angle + until).min(last);
                    Ok(self.strike(motion, velocity, &lift, after, observer))
                }
                Passage::NoProgress { .. } => Err(self.no_progress(motion.revolution, motion.cam_angle, until)),
                Passage::NotFinite => Err(self.not_finite(motion)),
            },
        }
    }

    /// Finds the next event of a flight. It depends on `left`, the rest of the run in rad, only if each impact of a chatter is simulated.
    #[inline(always)]
    fn ahead<O: Observer>(&self, motion: &mut Motion, left: f64, observer: &mut O) -> Ahead {
        let omega = self.angular_velocity;
        let top = self.terrain.top;
        let clears = self.clears(motion, top);
        if motion.settled
            && let Some(jerk) = clears
            && let Some(again) = self.again(motion, jerk)
        {
            return Ahead::Again(again);
        }
        if motion.state.position > top || clears.is_some() {
            return match self.flight.fall_to(top, motion.state) {
                Some((time, state)) => Ahead::Top { time, state },
                None => Ahead::Never,
            };
        }
        if let Some(leap) = self.leap(motion) {
            return Ahead::Leap(leap);
        }
        let segment = &self.cam().segments()[motion.segment];
        let within = segment.end - motion.cam_angle;
        let span = if motion.chatter == Chatter::WithinRun { within.min(left) } else { within };
        let end = span / omega;
        let expected = motion.expected.map(|angle| (angle - motion.cam_angle) / omega);
        let passage = if O::COUNTS {
            let work = Cell::default();
            let passage = Window::new(self, motion, &work).pass(end, expected);
            observer.work(work.get());
            passage
        } else {
            Window::new(self, motion, ()).pass(end, expected)
        };
        Ahead::Over { end, passage }
    }

    /// Error of a search that used all its steps from `angle`, rad, and ended `turn`, rad, further on.
    fn no_progress(&self, revolution: u64, angle: f64, turn: f64) -> SimulateError {
        SimulateError::NoProgress { events: self.most_steps, revolution, cam_angle: angle + turn }
    }

    fn not_finite(&self, motion: &Motion) -> SimulateError {
        SimulateError::NotFinite { revolution: motion.revolution, cam_angle: motion.cam_angle }
    }

    /// Returns a bound on the jerk, m/s^3, if the follower has just left the cam and certainly rises above the whole cam without another
    /// contact.
    #[inline(always)]
    fn clears(&self, motion: &Motion, top: f64) -> Option<f64> {
        let (State { position, velocity }, omega) = (motion.state, self.angular_velocity);
        if motion.gap != Some(0.0) || !(velocity > 0.0) {
            return None;
        }
        let relative_velocity = velocity - motion.lift.map_or(f64::INFINITY, |lift| omega * lift.slope);
        // While it rises q >= q0 + v0 t + (a0 - J t) t^2/2, with |q'''| <= J. Within this time it must be above the top,
        let time = 1.25 * (top - position) / velocity;
        let jerk = self.flight.jerk_bound(motion.state);
        let slowest = self.flight.acceleration(motion.state) - jerk * time;
        let rises = position + time * (velocity + 0.5 * slowest * time) > top;
        // and the gap, with g' >= u at the start and g'' >= a - w^2 max c'', must stay positive that long.
        let closing = slowest - omega * omega * self.terrain.largest_curvature;
        (rises && relative_velocity + 0.5 * closing * time > 0.0).then_some(jerk)
    }

    /// Moves the cam on by `turn`, rad, over any number of segments.
    fn turn_over(&self, motion: &mut Motion, turn: f64) {
        let mut angle = motion.cam_angle + turn;
        if angle >= TAU {
            angle -= TAU;
            motion.revolution += 1;
            if angle >= TAU {
                let turns = (angle / TAU).floor();
                motion.revolution += turns as u64;
                angle = (angle - turns * TAU).clamp(0.0, TAU);
            }
        }
        motion.cam_angle = angle;
        // Most flights land on the segment where the flight before landed.
        let here = &self.cam().segments()[motion.segment];
        if !(here.start <= angle && angle < here.end) {
            motion.segment = self.cam().segment_at(angle);
        }
    }

    /// Moves to the start of the next segment; returns an error if the lift steps up through the follower.
    #[doc(hidden)]
    pub fn enter_next(&self, motion: &mut Motion) -> Result<(), SimulateError> {
        let segments = self.cam().segments();
        motion.segment += 1;
        if motion.segment == segments.len() {
            motion.segment = 0;
            motion.revolution += 1;
        }
        motion.cam_angle = segments[motion.segment].start;
        motion.lift = None;
        let entry = self.terrain.entries[motion.segment];
        if entry.lift_step != 0.0 {
            motion.gap = motion.gap.map(|gap| gap - entry.lift_step);
            let gap = self.gap(motion);
            if gap < -self.gap_rounding(motion.state.position) {
                let Motion { revolution, cam_angle, .. } = *motion;
                return Err(SimulateError::BelowCam { depth: -gap, revolution, cam_angle });
            }
            return Ok(());
        }
        if let Some(lift) = entry.seam {
            // The gap is continuous.
            motion.gap.get_or_insert(motion.state.position - lift);
        }
        self.above_cam(motion, || motion.gap.unwrap_or(motion.state.position - entry.lift))
    }

    /// Moves a motion that an observer has stopped at a whole turn to the start of the next turn, where the lift has no step.
    fn wrap(&self, motion: &mut Motion, observer: &mut impl Observer) -> Result<(), SimulateError> {
        if motion.cam_angle < TAU {
            return Ok(());
        }
        self.enter_next(motion)?;
        let slope_jump = self.terrain.entries[motion.segment].slope_jump;
        if motion.contact && slope_jump != 0.0 {
            // A release is reported with the event that led to it; a strike by the cam is found when the motion continues.
            (motion.contact, motion.followed) = (false, 0);
            if slope_jump < 0.0 {
                self.report(motion, EventKind::Release, observer);
            }
        }
        Ok(())
    }

    /// Resolves an impact at the motion's angle, where the cam has `lift`, `left` rad before the end of the run.
    #[inline(always)]
    fn strike(
        &self,
        motion: &mut Motion,
        velocity_before: f64,
        lift: &Lift,
        left: f64,
        observer: &mut impl Observer,
    ) -> Step {
        let cam_velocity = self.angular_velocity * lift.slope;
        let angle = motion.cam_angle;
        let moved = (angle - motion.last_impact).abs();
        motion.expected = (moved <= tolerance::REPEATED_IMPACT.value).then_some(angle);
        motion.settled = moved <= 2.0 * tolerance::LAST_TURN.value;
        motion.last_impact = angle;
        self.leave(motion, lift, relative_rebound(self.restitution, velocity_before, cam_velocity));
        let impact = self.event(motion, EventKind::Impact, velocity_before, cam_velocity);
        observer.strikes(lift);
        // A stick that follows from the impact belongs to it, also if the observer ends the run here: the run continues as if it had not
        // been split.
        let enough = observer.event(&impact).is_break();
        let step = if motion.contact {
            self.report(motion, EventKind::Stick, observer)
        } else {
            self.end_chatter(motion, left, observer)
        };
        if enough { Step::Broken } else { step }
    }

    fn event(&self, motion: &Motion, kind: EventKind, velocity_before: f64, cam_velocity: f64) -> Event {
        let over = motion.cam_angle >= TAU;
        Event {
            kind,
            revolution: motion.revolution + u64::from(over),
            cam_angle: if over { 0.0 } else { motion.cam_angle },
            position: motion.state.position,
            velocity_before,
            velocity_after: motion.state.velocity,
            cam_velocity,
            segment: motion.segment,
        }
    }

    /// Reports a stick or a release: an event without a change of velocity.
    fn report(&self, motion: &Motion, kind: EventKind, observer: &mut impl Observer) -> Step {
        let velocity = motion.state.velocity;
        let event = self.event(motion, kind, velocity, velocity);
        if observer.event(&event).is_break() { Step::Broken } else { Step::Event }
    }
}

/// State of a follower that moves with the cam.
fn on_cam(lift: &Lift, omega: f64) -> State {
    State { position: lift.value, velocity: omega * lift.slope }
}

/// Result of one step of the loop.
enum Step {
    Moved,
    Event,
    /// End of the run in a flight or contact that lasts until `until`, rad after its beginning.
    Reached {
        until: f64,
        ahead: Option<Ahead>,
    },
    /// End of the run by the observer.
    Broken,
}
