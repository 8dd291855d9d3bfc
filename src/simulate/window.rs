//! Search for the first contact in a flight over one segment of the cam.
//!
//! Four shapes of the gap g need no search. A gap that only shrinks (`g' < 0`) or is bent downwards (`g'' < 0`) meets the cam at most once,
//! so that any root is the first. A gap that is bent upwards (`g'' > 0`) meets the cam at most once while it shrinks, and that root is the
//! first. A gap that grows at first and has a positive cubic lower bound has no contact. The shape follows from the gap at the start and
//! from bounds of the flight's jerk and of the segment. Windows of any other shape are searched step by step by [`super::contact`].

use std::cell::Cell;

use super::ahead::Passage;
use super::contact::{self, GapAt, Outcome};
use super::{Machine, Motion, Work};
use crate::cam::{Lift, Segment};
use crate::flight::{Flight, Flown, State};
use crate::tolerance;

/// Counter of a window's work; `()` counts nothing.
pub(super) trait Tally: Copy {
    fn add(self, gaps: u64, steps: u64, marches: u64);
}

impl Tally for () {
    #[inline(always)]
    fn add(self, _gaps: u64, _steps: u64, _marches: u64) {}
}

impl Tally for &Cell<Work> {
    fn add(self, gaps: u64, steps: u64, marches: u64) {
        let work = self.get();
        let (gaps, steps, marches) = (work.gaps + gaps, work.steps + steps, work.marches + marches);
        self.set(Work { gaps, steps, marches, ..work });
    }
}

/// Flight over a segment, from its present angle on.
pub(super) struct Window<'a, T> {
    tally: T,
    machine: &'a Machine,
    flight: &'a Flight,
    segment: &'a Segment,
    omega: f64,
    start: State,
    angle: f64,
    /// Gap at the start, m, if it is stored more accurately than the difference of two positions.
    gap: Option<f64>,
    /// Lift at the start, if it was computed.
    lift: Option<Lift>,
}

/// Gap, follower and cam at an instant.
struct Seen {
    value: f64,
    rate: f64,
    curvature: f64,
    flown: Flown,
    lift: Lift,
}

impl<'a, T: Tally> Window<'a, T> {
    pub fn new(machine: &'a Machine, motion: &Motion, tally: T) -> Self {
        Self {
            tally,
            machine,
            flight: &machine.flight,
            segment: &machine.cam().segments()[motion.segment],
            omega: machine.angular_velocity,
            start: motion.state,
            angle: motion.cam_angle,
            gap: motion.gap,
            lift: motion.lift,
        }
    }

    /// Flies up to `end`, s, or to the first contact; `expected` is the likely time of a contact, s.
    pub fn pass(mut self, end: f64, expected: Option<f64>) -> Passage {
        if !(end > 0.0) {
            return Passage::Free { state: self.start, gap: self.gap };
        }
        let jerk = self.flight.jerk_bound(self.start);
        let acceleration = self.flight.acceleration(self.start);
        // v <= v0 + max(a) t, and c' >= the segment's least slope.
        let fastest = self.start.velocity + (acceleration + jerk * end).max(0.0) * end;
        let bounds = &self.segment.bounds;
        let closing = self.omega * bounds.slope[0] - fastest;
        if self.gap != Some(0.0) && closing > 0.0 {
            let first = expected.filter(|time| (0.0..=end).contains(time)).unwrap_or(0.0);
            self.forget_gap(closing);
            return self.only_contact(0.0, end, first, end);
        }
        let now = self.at_start();
        if !(now.value.is_finite() && now.rate.is_finite() && now.curvature.is_finite()) {
            return Passage::NotFinite;
        }
        let third = jerk + self.omega.powi(3) * bounds.third;
        // g >= g0 + g' t + g'' t^2/2 - |g'''| t^3/6, which from g' >= 0 rises and then falls: positive at both ends means positive between
        // them.
        let least = now.value + end * (now.rate + end * (0.5 * now.curvature - end * third / 6.0));
        if now.value >= 0.0 && now.rate >= 0.0 && least > 0.0 {
            return self.free(end);
        }
        if now.curvature < 0.0 && now.value >= 0.0 && (now.value > 0.0 || now.rate > 0.0) {
            // g + g' t + g'' t^2/2 = 0, as a first guess.
            let root = (now.rate * now.rate - 2.0 * now.curvature * now.value).sqrt();
            let back =
                if now.rate > 0.0 { (now.rate + root) / -now.curvature } else { 2.0 * now.value / (root - now.rate) };
            let reach = end.min(2.0 * back);
            self.forget_gap(now.rate.abs());
            if now.curvature + third * reach < 0.0 {
                // From the cam, g >= u t - (|g''| + third reach) t^2/2: the contact just left is not found again.
                let low = if now.value == 0.0 { 2.0 * now.rate / (third * reach - now.curvature) } else { 0.0 };
                return self.only_contact(low.min(reach), reach, self.bent(&now, back), end);
            }
        }
        // Lower bound of g''.
        let least = acceleration - jerk * end - self.omega * self.omega * bounds.curvature[1];
        if least > 0.0 && now.value > 0.0 { self.hollow(now, end, least) } else { self.march(end) }
    }

    /// Passes a window whose gap is positive at the start and bent upwards by at least `least`, m/s^2. While such a gap shrinks, it has
    /// shrunk since the start, so that no contact precedes a point with a positive gap. Its first contact is where it still shrinks. A gap
    /// that only touches 0 is searched step by step.
    fn hollow(&self, mut now: Seen, end: f64, least: f64) -> Passage {
        let mut time = 0.0;
        // Each step triples the number of digits.
        for _ in 0..8 {
            let left = end - time;
            // g + g' t + g'' t^2/2 with the least g'' is a lower bound: over the rest it is lowest at the end or where it turns.
            let lowest = left.min(-now.rate / least);
            let depth = now.value + lowest * (now.rate + 0.5 * least * lowest);
            if !(now.rate < 0.0) {
                break;
            }
            if depth > self.machine.gap_rounding(now.flown.state.position) {
                return self.free(end);
            }
            self.tally.add(0, 1, 0);
            let newton = -now.value / now.rate;
            let bend = 0.5 * newton * now.curvature / now.rate;
            // Far from a tangency, where -g g''/(2 g'^2) is -1/4.
            if !(bend.abs() <= 0.125) {
                if now.value < 0.0 {
                    break;
                }
                // The tangent never passes the contact.
                time += newton;
            } else {
                let step = newton / (1.0 + bend);
                if self.is_small(step, time, &now.lift) && time + step <= end {
                    return self.met(time, step, &now);
                }
                time += step;
            }
            if !(0.0..end).contains(&time) {
                break;
            }
            now = self.near(&now.flown, time);
        }
        self.march(end)
    }

    /// Drops the separate gap if the gap changes so fast that the last bit of a position matters less than the last bit of an angle. Then
    /// the difference of two positions is as accurate, and cheaper.
    fn forget_gap(&mut self, rate: f64) {
        if rate > self.omega * self.start.position.abs() {
            self.gap = None;
        }
    }

    /// Guess from a parabola with a cubic correction: from the cam, `t = 2u/A (1 + 2 J u/(3 A^2))`.
    fn bent(&self, now: &Seen, back: f64) -> f64 {
        if now.value > 0.0 {
            return back;
        }
        let third = self.flight.jerk(now.flown.state) - self.omega.powi(3) * now.lift.third;
        back * (1.0 + third * back / (-3.0 * now.curvature))
    }

    /// Finds the contact of a gap that has at most one in `(low, reach]`, by Halley's method inside a bracket. `end` is the end of the
    /// window.
    fn only_contact(&self, low: f64, reach: f64, first: f64, end: f64) -> Passage {
        let (mut low, mut high, mut high_is_closed) = (low, reach, false);
        let mut time = if low < first && first < reach { first } else { low };
        const LAST_TURN: f64 = tolerance::LAST_TURN.value;
        let mut known = Flown::not_yet(self.start);
        // Each halving of the bracket gains one bit.
        for _ in 0..128 {
            let now = if time == 0.0 { self.at_start() } else { self.near(&known, time) };
            known = now.flown;
            if now.value.is_nan() {
                return Passage::NotFinite;
            }
            // Halley: t = -g/g' / (1 - g g''/(2 g'^2))
            self.tally.add(0, 1, 0);
            let newton = -now.value / now.rate;
            let bend = 0.5 * newton * now.curvature / now.rate;
            // If the gap hardly changes, Halley's step is short however far the contact is.
            let step = if bend.abs() <= 0.5 { newton / (1.0 + bend) } else { newton };
            // At the start no time has passed as a scale; the relative error of even Newton's step is only this bend.
            let is_at_once =
                time == 0.0 && (self.omega * step).abs() <= LAST_TURN * LAST_TURN && bend.abs() <= LAST_TURN;
            let is_last = is_at_once || self.is_small(step, time, &now.lift);
            if now.rate < 0.0 && is_last && time + step <= reach {
                return self.met(time, step, &now);
            }
            if now.value > 0.0 {
                if time >= reach {
                    // Before the window's end, at twice the root b of a parabola bent down by A: g <= -A b^2 + third (2b)^3/6 < -A b^2/3.
                    // Only rounding can make the gap positive there.
                    let (state, gap) = (now.flown.state, self.gap.map(|_| now.value));
                    return if reach < end { self.march(end) } else { Passage::Free { state, gap } };
                }
                low = time;
            } else {
                (high, high_is_closed) = (time, true);
            }
            let next = time + step;
            // Where the gap grows, the step leads out of the bracket.
            time = if low < next && next < high {
                next
            } else if !high_is_closed {
                reach
            } else {
                0.5 * (low + high)
            };
            if high_is_closed && high - low <= tolerance::ULP.value * high {
                return self.met(high, 0.0, &self.at(high));
            }
        }
        if high_is_closed { self.met(high, 0.0, &self.at(high)) } else { self.march(end) }
    }

    /// Whether the last step is so small that Taylor sums give follower and cam after it.
    fn is_small(&self, step: f64, time: f64, lift: &Lift) -> bool {
        let turn = self.omega * step;
        step.abs() <= tolerance::LAST_STEP.value * time
            && turn.abs() <= tolerance::LAST_TURN.value
            && lift.third.abs() * turn * turn <= tolerance::LAST_BEND.value * lift.slope.abs()
            || step.abs() <= 2.0 * tolerance::ULP.value * time
    }

    /// Contact at `step` after an instant.
    fn met(&self, time: f64, step: f64, now: &Seen) -> Passage {
        let lift = now.lift.after(self.omega * step);
        let jerk = self.flight.jerk(now.flown.state);
        let velocity =
            now.flown.state.velocity + step * (self.flight.acceleration(now.flown.state) + 0.5 * step * jerk);
        Passage::Contact { time: time + step, velocity, lift }
    }

    fn free(&self, end: f64) -> Passage {
        let (displacement, state) = self.flight.fly(self.start, end);
        let gap = self.gap.map(|gap| gap + displacement - self.segment.law.rise(self.angle, self.omega * end));
        Passage::Free { state, gap }
    }

    fn at_start(&self) -> Seen {
        let lift = self.lift.unwrap_or_else(|| self.segment.law.lift(self.angle));
        self.seen(self.gap.unwrap_or(self.start.position - lift.value), Flown::not_yet(self.start), lift)
    }

    fn at(&self, time: f64) -> Seen {
        self.near(&Flown::not_yet(self.start), time)
    }

    /// Gap at `time`, s, from the state of the flight at another time.
    #[inline]
    fn near(&self, known: &Flown, time: f64) -> Seen {
        let flown = self.flight.fly_near(self.start, known, time);
        let turn = self.omega * time;
        if let Some(gap) = self.gap {
            let (rise, lift) = self.segment.law.climb(self.angle, turn);
            return self.seen(gap + flown.displacement - rise, flown, lift);
        }
        let lift = self.segment.law.lift(self.angle + turn);
        self.seen(flown.state.position - lift.value, flown, lift)
    }

    #[inline]
    fn seen(&self, value: f64, flown: Flown, lift: Lift) -> Seen {
        self.tally.add(1, 0, 0);
        let (omega, state) = (self.omega, flown.state);
        Seen {
            value,
            rate: state.velocity - omega * lift.slope,
            curvature: self.flight.acceleration(state) - omega * omega * lift.curvature,
            flown,
            lift,
        }
    }

    /// Searches a window with any shape of gap, step by step.
    #[cold]
    fn march(&self, end: f64) -> Passage {
        self.tally.add(0, 0, 1);
        let omega = self.omega;
        let gap_at = |time: f64| {
            let now = if time == 0.0 { self.at_start() } else { self.at(time) };
            let third = 2.0 * (self.flight.jerk(now.flown.state) - omega.powi(3) * now.lift.third).abs();
            // Rounding of the two positions, however accurate their difference is: no dip below it is an impact.
            let rounding = self.machine.gap_rounding(now.flown.state.position);
            let rate_rounding = self.machine.velocity_rounding();
            GapAt { value: now.value, rounding, rate: now.rate, rate_rounding, curvature: now.curvature, third }
        };
        let third_bound = |time: f64, reach: f64| {
            let state = if time == 0.0 { self.start } else { self.flight.fly(self.start, time).1 };
            let angle = self.angle + omega * time;
            self.flight.jerk_bound(state) + omega.powi(3) * self.segment.law.third_bound(angle, angle + omega * reach)
        };
        match contact::first_contact(gap_at, third_bound, end, self.machine.most_steps) {
            Outcome::None => self.free(end),
            Outcome::Contact(time) => {
                let now = if time == 0.0 { self.at_start() } else { self.at(time) };
                Passage::Contact { time, velocity: now.flown.state.velocity, lift: now.lift }
            }
            Outcome::NoProgress(time) => Passage::NoProgress { time },
            Outcome::NotFinite(_) => Passage::NotFinite,
        }
    }
}
