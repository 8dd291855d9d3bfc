//! Proves or refutes that a flight is clear of the cam from one impact to the next.
//!
//! The gap G(phi) = q - c is 0 at both ends. Next to the first end it is positive if it rises all over a stretch that begins there. Next to
//! the other end it is positive if it falls all over a stretch that ends there. Between them it is positive on a stretch if its Taylor sum
//! about the middle m is, with G'' enclosed over the stretch:
//!
//! ```text
//! G(m + x) = G(m) + x G'(m) + x^2/2 G''(...)
//! ```

use std::collections::VecDeque;
use std::f64::consts::TAU;

use crate::cam::Cam;
use crate::flight::Flight;
use crate::interval::Interval;
use crate::tolerance;

/// Impact on the cam at which a flight begins or ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Struck {
    /// Index of the segment whose law applies to the flight that begins or ends here.
    pub segment: usize,
    /// Cam angle, rad.
    pub angle: Interval,
    /// Turns of the cam since angle 0 before the flight began.
    pub turns: u64,
}

/// A flight from the cam back to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hop {
    pub from: Struck,
    pub to: Struck,
    /// Velocity after the impact that begins the flight, m/s.
    pub velocity: Interval,
    /// Angular velocity of the cam, rad/s.
    pub omega: Interval,
}

/// G, G' and G'', by the angle.
struct Gap {
    value: Interval,
    slope: Interval,
    curvature: Interval,
}

impl Hop {
    /// Encloses the gap over angles of a segment, `turns` of the cam later.
    fn gap(&self, cam: &Cam, flight: &Flight, segment: usize, turns: u64, angles: Interval) -> Gap {
        let law = |segment: usize| &cam.segments()[segment].law;
        let (start, lift) = (law(self.from.segment).lift_over(self.from.angle), law(segment).lift_over(angles));
        let turned = angles + Interval::TURN * turns as f64 - self.from.angle;
        let response = flight.response_over(turned / self.omega);
        let (force, v) = (flight.force(start.value), self.velocity);
        // q = q0 + v0 s + f0 p,  q' = v0 s' + f0 s,  q'' = v0 s'' + f0 s'
        let displacement = v * response.impulse + force * response.step;
        let velocity = v * response.impulse_rate + force * response.impulse;
        let acceleration = v * flight.impulse_bend(&response) + force * response.impulse_rate;
        Gap {
            value: displacement - (lift.value - start.value),
            slope: velocity / self.omega - lift.slope,
            curvature: acceleration / self.omega.squared() - lift.curvature,
        }
    }

    /// Whether the flight is clear of the cam. `None` if this cannot be decided.
    pub(super) fn is_clear(&self, cam: &Cam, flight: &Flight) -> Option<bool> {
        /// Most boxes that are halved. A flight next to a graze takes some hundreds.
        const MOST: usize = 100_000;
        let narrowest = tolerance::NARROWEST_BOX.value * TAU;
        let mut left: VecDeque<_> = self.stretches(cam).into();
        let (mut is_decided, mut halvings) = (true, 0..MOST);
        while let Some(stretch @ Stretch { segment, turns, angles, .. }) = left.pop_front() {
            let middle = angles.middle();
            let whole = self.gap(cam, flight, segment, turns, angles);
            let centre = self.gap(cam, flight, segment, turns, middle.into());
            let away = angles - middle;
            let value = centre.value + away * centre.slope + away.squared().half() * whole.curvature;
            let is_past = !stretch.is_first || middle > self.from.angle.high();
            let is_before = !stretch.is_last || middle < self.to.angle.low();
            if is_past && is_before && centre.value.is_negative() {
                return Some(false);
            }
            let rises = stretch.is_first && whole.slope.is_positive();
            let falls = stretch.is_last && whole.slope.is_negative();
            if rises || falls || value.is_positive() {
                continue;
            }
            if halvings.next().filter(|_| angles.width() > narrowest).is_none() {
                is_decided = false;
                continue;
            }
            let [low, high] = angles.halves();
            left.push_back(Stretch { angles: low, is_last: false, ..stretch });
            left.push_back(Stretch { angles: high, is_first: false, ..stretch });
        }
        is_decided.then_some(true)
    }

    /// Splits the flight by the segments that it passes over.
    fn stretches(&self, cam: &Cam) -> Vec<Stretch> {
        let segments = cam.segments();
        let (mut segment, mut turns, mut all) = (self.from.segment, 0, Vec::new());
        let mut low = self.from.angle.low();
        loop {
            let is_last = (segment, turns) == (self.to.segment, self.to.turns);
            let high = if is_last { self.to.angle.high() } else { segments[segment].end };
            all.push(Stretch { segment, turns, angles: Interval::new(low, high), is_first: all.is_empty(), is_last });
            if is_last || turns > self.to.turns {
                return all;
            }
            (segment, turns) = if segment + 1 == segments.len() { (0, turns + 1) } else { (segment + 1, turns) };
            low = segments[segment].start;
        }
    }
}

/// A part of a segment, with the turns of the cam up to it.
#[derive(Clone, Copy)]
struct Stretch {
    segment: usize,
    turns: u64,
    angles: Interval,
    is_first: bool,
    is_last: bool,
}
