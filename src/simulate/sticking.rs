//! Sticking: the end of infinitely many impacts, motion on the cam, and release.

use std::f64::consts::TAU;

use super::motion::Chatter;
use super::terrain::Entry;
use super::{EventKind, Goal, Machine, Motion, Observer, SimulateError, Step, on_cam};
use crate::cam::{Lift, Segment};
use crate::flight::State;
use crate::tolerance;

/// Returns the duration of infinitely many impacts, s, and its relative uncertainty.
///
/// After an impact with relative velocity u and restitution r, let the gap of a follower that moves with the cam accelerate at
/// `g'' = -A + J t` (damping: `zeta`). Then the hops are geometric up to the second order. With `y = u/A` and `k = J/A - zeta`, a hop takes
/// `2y (1 + 2ky/3)` and leaves `y' = r y (1 + 4ky/3)`, so their sum is
///
/// ```text
/// S = S1 (1 + k S1/3),  S1 = 2y/(1 - r)
/// ```
///
/// and the error is of the size `(k S1)^2`.
#[doc(hidden)]
pub fn accumulation(relative_velocity: f64, restitution: f64, pressing: f64, rate: f64, zeta: f64) -> (f64, f64) {
    let first = 2.0 * relative_velocity / (pressing * (1.0 - restitution));
    let bend = (rate / pressing - zeta) * first;
    (first * (1.0 + bend / 3.0), bend * bend)
}

impl Machine {
    /// Acceleration of the gap of a follower that moves with the cam, m/s^2; above 0 the cam releases it.
    pub(crate) fn lifting(&self, lift: &Lift) -> f64 {
        let omega = self.angular_velocity;
        self.flight.acceleration(on_cam(lift, omega)) - omega * omega * lift.curvature
    }

    /// Whether the cam releases a follower that moves with it: the acceleration of the gap exceeds 0 by more than rounding. A follower
    /// without any force stays.
    #[inline]
    pub(super) fn lets_go(&self, lift: &Lift) -> bool {
        let (_, rounding) = self.lifting_rate(lift);
        self.lifting(lift) > rounding
    }

    /// Time derivative of [`Machine::lifting`] along the cam, m/s^3, and the rounding error of `lifting`, m/s^2.
    pub(crate) fn lifting_rate(&self, lift: &Lift) -> (f64, f64) {
        let omega = self.angular_velocity;
        let (w, zeta) = (self.flight.omega0_squared(), self.flight.zeta());
        let rate = -2.0 * zeta * omega * omega * lift.curvature - w * omega * lift.slope - omega.powi(3) * lift.third;
        let terms = self.flight.force(lift.value).abs()
            + w * lift.value.abs()
            + 2.0 * zeta * omega * lift.slope.abs()
            + omega * omega * lift.curvature.abs()
            // A spring that carries the weight cancels gravity.
            + self.flight.gravity().abs();
        (rate, tolerance::GAP_ROUNDING.value * terms)
    }

    /// Jumps after an impact to the end of infinitely many further ones, if it is so near that two terms of their sum suffice.
    pub(super) fn end_chatter(&self, motion: &mut Motion, left: f64, observer: &mut impl Observer) -> Step {
        let segment = &self.cam().segments()[motion.segment];
        let lift = motion.lift.unwrap_or_else(|| segment.law.lift(motion.cam_angle));
        let pressing = -self.lifting(&lift);
        let relative_velocity = motion.state.velocity - self.angular_velocity * lift.slope;
        // The cheap test first: most impacts are far from a chatter's end; without pressing force or loss all are.
        let first = 2.0 * relative_velocity * self.angular_velocity;
        if first > tolerance::CHATTER_TURN.value * pressing * (1.0 - self.restitution) {
            return Step::Event;
        }
        let (rate, _) = self.lifting_rate(&lift);
        let (time, left_out) = accumulation(relative_velocity, self.restitution, pressing, rate, self.flight.zeta());
        let turn = self.angular_velocity * time;
        let angle = motion.cam_angle + turn;
        if !(angle <= segment.end && left_out <= tolerance::CHATTER_REMAINDER.value) {
            return Step::Event;
        }
        if turn < left {
            motion.cam_angle = angle;
            if motion.chatter == Chatter::Due {
                motion.chatter = Chatter::Anywhere;
            }
            return self.stick(motion, &segment.law.lift(angle), observer);
        }
        if motion.chatter == Chatter::WithinRun {
            return Step::Event;
        }
        motion.chatter = Chatter::Due;
        Step::Reached { until: turn, ahead: None }
    }

    /// Puts the follower on the cam and starts sticking.
    fn stick(&self, motion: &mut Motion, lift: &Lift, observer: &mut impl Observer) -> Step {
        motion.state = on_cam(lift, self.angular_velocity);
        (motion.contact, motion.gap, motion.lift, motion.followed) = (true, Some(0.0), Some(*lift), 0);
        self.report(motion, EventKind::Stick, observer)
    }

    /// Moves a follower that never leaves the cam to the start of the goal's segment, over any number of turns: a whole turn on the cam
    /// without an event repeats to the last bit. Returns whether it moved.
    pub(super) fn stays(&self, motion: &mut Motion, goal: &Goal) -> bool {
        // The first segment may have been followed only in part.
        if motion.followed <= self.cam().segments().len() {
            return false;
        }
        let index = self.cam().segment_at(goal.cam_angle);
        let segment = &self.cam().segments()[index];
        if (motion.revolution, motion.cam_angle) >= (goal.revolution, segment.start) {
            return false;
        }
        (motion.revolution, motion.cam_angle, motion.segment) = (goal.revolution, segment.start, index);
        motion.state = on_cam(&segment.law.lift(segment.start), self.angular_velocity);
        (motion.gap, motion.lift) = (Some(0.0), None);
        true
    }

    /// Follows the cam to a release, to the end of the segment, or to the end of the run.
    pub(super) fn follow(
        &self,
        motion: &mut Motion,
        left: f64,
        observer: &mut impl Observer,
    ) -> Result<Step, SimulateError> {
        let omega = self.angular_velocity;
        let segment = &self.cam().segments()[motion.segment];
        let within = segment.end - motion.cam_angle;
        let turn = match self.turn_to_sign(1.0, motion.cam_angle, segment, within) {
            Ok(turn) => turn,
            Err(turn) if turn < left => {
                return Err(self.no_progress(motion.revolution, motion.cam_angle, turn));
            }
            Err(turn) => return Ok(Step::Reached { until: turn, ahead: None }),
        };
        if let Some(turn) = turn.filter(|turn| *turn < left) {
            motion.cam_angle += turn;
            let lift = segment.law.lift(motion.cam_angle);
            return Ok(self.let_go(motion, &lift, on_cam(&lift, omega), observer));
        }
        if left < within {
            return Ok(Step::Reached { until: turn.unwrap_or(within), ahead: None });
        }
        let before = on_cam(&segment.law.lift(segment.end), omega);
        (motion.state, motion.gap, motion.lift) = (before, Some(0.0), None);
        self.enter_next(motion)?;
        let entry = self.terrain.entries[motion.segment];
        let next = &self.cam().segments()[motion.segment];
        let lift = next.law.lift(next.start);
        let after = on_cam(&lift, omega);
        if entry.slope_jump > 0.0 && entry.lift_step == 0.0 {
            // The cam's velocity jumps towards the follower.
            return Ok(self.strike(motion, before.velocity, &lift, left - within, observer));
        }
        if entry.slope_jump < 0.0 || entry.lift_step < 0.0 {
            let gap = motion.gap;
            // The difference between the two lifts at a seam must not become a gap.
            let position = if entry.lift_step == 0.0 { lift.value } else { before.position };
            let step = self.let_go(motion, &lift, State { position, ..before }, observer);
            motion.gap = gap;
            return Ok(step);
        }
        if self.lets_go(&lift) {
            return Ok(self.let_go(motion, &lift, after, observer));
        }
        motion.state = after;
        let all = self.cam().segments().len();
        motion.followed = (motion.followed + 1).min(all + 1);
        Ok(Step::Moved)
    }

    /// Ends the contact: the follower flies on from `state`.
    fn let_go(&self, motion: &mut Motion, lift: &Lift, state: State, observer: &mut impl Observer) -> Step {
        motion.state = state;
        (motion.contact, motion.gap, motion.lift, motion.followed) = (false, Some(0.0), Some(*lift), 0);
        self.report(motion, EventKind::Release, observer)
    }

    /// Ranges of cam angle, rad, on which a follower can rest: from the angle where the cam begins to press it to the angle where the cam
    /// releases or strikes it. A range through angle 0 begins below 0. If the follower can rest everywhere, the only range is a whole turn.
    pub fn rests(&self) -> Result<Vec<[f64; 2]>, SimulateError> {
        let mut rests: Vec<[f64; 2]> = Vec::new();
        let mut from = None;
        let lifts = |segment: &Segment| self.lets_go(&segment.law.lift(segment.start));
        let ends =
            |segment: &Segment, entry: &Entry| entry.slope_jump != 0.0 || entry.lift_step != 0.0 || lifts(segment);
        let segments = self.cam().segments();
        for (segment, entry) in segments.iter().zip(&self.terrain.entries) {
            let mut angle = segment.start;
            if let Some(begun) = from
                && ends(segment, entry)
            {
                rests.push([begun, angle]);
                from = None;
            }
            from = from.or((!lifts(segment)).then_some(angle));
            loop {
                let sign = if from.is_some() { 1.0 } else { -1.0 };
                let turn = self.turn_to_sign(sign, angle, segment, segment.end - angle);
                let Some(turn) = turn.map_err(|turn| self.no_progress(0, angle, turn))? else { break };
                angle += turn;
                match from.take() {
                    Some(begun) => rests.push([begun, angle]),
                    None => from = Some(angle),
                }
            }
        }
        if let Some(begun) = from {
            let seam = segments.first().zip(self.terrain.entries.first());
            match rests.first_mut().filter(|first| first[0] == 0.0) {
                Some(first) if seam.is_some_and(|(segment, entry)| !ends(segment, entry)) => first[0] = begun - TAU,
                _ => rests.push([begun, TAU]),
            }
        }
        Ok(rests)
    }

    /// Returns the turn, rad, within `span` from an angle of a segment, after which [`Machine::lifting`] has the sign of `sign`, 1 or -1;
    /// `None` if it never has. With 1, this is the release. The error is the turn at which the search failed.
    ///
    /// With `|d lifting/dt| <= L` over a range, `lifting` stays below 0 for `-lifting/L`, so a step of this time never passes a release. As
    /// the steps shrink, L tends to the slope itself. The slope's terms may cancel everywhere, if cam and spring swing alike. Then L is the
    /// present slope plus the largest change by its derivative over the range,
    ///
    /// ```text
    /// |d^2 lifting/dt^2| <= 2 zeta w^3 |c'''| + w0^2 w^2 |c''| + w^4 |c''''|
    /// ```
    fn turn_to_sign(&self, sign: f64, angle: f64, segment: &Segment, span: f64) -> Result<Option<f64>, f64> {
        let omega = self.angular_velocity;
        let (w, zeta) = (self.flight.omega0_squared(), self.flight.zeta());
        let bounds = &segment.bounds;
        // On a dwell the force is constant.
        if bounds.slope == [0.0; 2] {
            return Ok(None);
        }
        // Bound over the whole segment: each term at its largest.
        let end = usize::from(sign < 0.0);
        let forces = bounds.lift.map(|lift| sign * self.flight.force(lift));
        let largest = forces[0].max(forces[1])
            - sign * (2.0 * zeta * omega * bounds.slope[end] + omega * omega * bounds.curvature[end]);
        if largest < 0.0 {
            return Ok(None);
        }
        let end = span / omega;
        let (mut time, mut hover, mut widest) = (0.0, 0.0, end);
        for _ in 0..self.most_steps {
            if !(time < end) {
                return Ok(None);
            }
            let turned = omega * time;
            let from = angle + turned;
            let lift = segment.law.lift(from);
            let lifting = sign * self.lifting(&lift);
            let (rate, rounding) = self.lifting_rate(&lift);
            let steepest = |reach: f64| {
                let turn = omega * reach;
                let to = from + turn;
                let third = segment.law.third_bound(from, to).min(bounds.third);
                let curvature = lift.curvature.abs() + third * turn;
                let slope = lift.slope.abs() + curvature * turn;
                let sum = 2.0 * zeta * omega * omega * curvature + w * omega * slope + omega.powi(3) * third;
                (sum, third, curvature, to)
            };
            // |d lifting/dt| over a reach: its terms at their largest, or from the start by the second derivative if that is less.
            let fastest = |reach: f64| {
                let (sum, third, curvature, to) = steepest(reach);
                let fourth = segment.law.fourth_bound(from, to);
                let bend = omega * omega * (2.0 * zeta * omega * third + w * curvature + omega * omega * fourth);
                let of_rate = tolerance::GAP_ROUNDING.value * (sum + omega.powi(3) * bounds.third);
                sum.min(rate.abs() + of_rate + bend * reach)
            };
            if lifting > rounding {
                return Ok(Some(turned));
            }
            if lifting > -rounding {
                // Where rounding decides, each step doubles: the acceleration may only touch 0, or stay there.
                hover = if hover > 0.0 { 2.0 * hover } else { 2.0 * rounding / steepest(0.0).0 };
                time += hover.max(tolerance::ULP.value * end);
                continue;
            }
            hover = 0.0;
            let mut reach = widest.min(end - time);
            let mut safe: f64 = 0.0;
            for _ in 0..32 {
                let free = -lifting / fastest(reach);
                safe = safe.max(free.min(reach));
                if free >= 0.5 * reach {
                    break;
                }
                // Reduced step by step: if the bound itself grows with the reach, one step would find far less than is free.
                reach = (2.0 * free).max(0.25 * reach);
            }
            // Tried first at the next step: the free reach here suggests the next one.
            widest = 4.0 * reach;
            time += safe.max(tolerance::ULP.value * end);
        }
        Err(omega * time)
    }
}
