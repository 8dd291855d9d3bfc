//! Orbits with one impact in n revolutions: one equation with two unknowns.
//!
//! A flight of `t = n T` begins and ends on the cam at angle theta. With the responses s(t), p(t) and the force f at c(theta), it leaves
//! with `v+ = -f p/s` and returns with `v- = v+ s' + f s`. The restitution law then gives
//!
//! ```text
//! E(theta, t) = -f a(t) - (1 + r) c' s = 0        a = p (1 + r s') - r s^2        c' = (2 pi n/t) dc/dtheta
//! ```
//!
//! At a given speed the angle is unknown; at a corner the time is.

use super::clearance::Hop;
use super::{Solved, Standing, Struck, joined};
use crate::cam::{Cam, Lift};
use crate::flight::{Flight, Response};
use crate::interval::roots::{BoxValues, Isolated, isolate};
use crate::interval::{Interval, Number};
use crate::orbit::cycle::{Cycle, Impact};
use crate::simulate::Machine;

/// The equation of a cam and a follower.
#[derive(Clone, Copy, Debug)]
pub struct OneImpact<'a> {
    /// The cam.
    pub cam: &'a Cam,
    /// The law of flight.
    pub flight: &'a Flight,
    /// r, 0 to 1.
    pub restitution: f64,
    /// n, turns of the cam in one flight.
    pub revolutions: u64,
}

/// E, and its derivatives by the angle, rad, and by the time, s.
pub struct Equation {
    pub value: Interval,
    pub by_angle: Interval,
    pub by_time: Interval,
    /// Sum of the sizes of its terms.
    pub size: f64,
}

impl OneImpact<'_> {
    /// 2 pi n, rad.
    fn turn(&self) -> Interval {
        Interval::TURN * self.revolutions as f64
    }

    /// Evaluates the equation for the lifts of a range of angles and a range of times, with the responses over these.
    pub fn equation(&self, lift: &Lift<Interval>, time: Interval, response: &Response<Interval>) -> Equation {
        let (r, flight) = (self.restitution, self.flight);
        let (p, s, s1) = (response.step, response.impulse, response.impulse_rate);
        let s2 = flight.impulse_bend(response);
        let force = flight.force(lift.value);
        let back = Interval::from(r) + 1.0;
        let (a, omega) = (p * (s1 * r + 1.0) - s.squared() * r, self.turn() / time);
        // a' = s (1 + r s') + r p s'' - 2 r s s'
        let a1 = s * (s1 * r + 1.0) + p * s2 * r - s * s1 * (2.0 * r);
        let terms = [force * a, back * omega * lift.slope * s];
        Equation {
            value: -terms[0] - terms[1],
            size: terms[0].magnitude() + terms[1].magnitude(),
            // df/dtheta = -w0^2 dc/dtheta
            by_angle: lift.slope * a * flight.omega0_squared() - back * omega * lift.curvature * s,
            // d(s/t)/dt = (s' - s/t)/t
            by_time: -(force * a1) - back * omega * lift.slope * (s1 - s / time),
        }
    }

    /// Velocities v- and v+, m/s; `None` if s may be 0.
    pub(crate) fn velocities(&self, position: Interval, time: Interval) -> Option<[Interval; 2]> {
        let (response, force) = (self.flight.response_over(time), self.flight.force(position));
        let after = -(force * response.step / response.impulse);
        let before = after * response.impulse_rate + force * response.impulse;
        (!response.impulse.holds_zero()).then_some([before, after])
    }

    /// Decides whether a flight that solves the equation is an orbit. Its ends are the two sides of the cam at an angle, which differ only
    /// at a corner. `lift` is the lift by which the impact throws the follower.
    pub(crate) fn standing(&self, [from, to]: [Struck; 2], lift: &Lift<Interval>, time: Interval) -> Standing {
        let Some([before, after]) = self.velocities(lift.value, time) else { return Standing::Undecided };
        let omega = self.turn() / time;
        let approach = omega * lift.slope - before;
        if approach.is_negative() {
            return Standing::NoOrbit;
        }
        // Without an approach, a follower that sticks would solve the equation as well.
        if !approach.is_positive() || self.restitution == 0.0 {
            return Standing::Undecided;
        }
        match (Hop { from, to, velocity: after, omega }).is_clear(self.cam, self.flight) {
            Some(true) => Standing::Orbit,
            Some(false) => Standing::NoOrbit,
            None => Standing::Undecided,
        }
    }
}

/// Boxes after which a segment is left undecided. If flights from every angle return, no number is enough.
const MOST_BOXES: usize = 1 << 14;

/// Solution, or possible solution, at the speed of a machine: its place, and whether it is certainly the only root there.
struct Solution {
    guess: Cycle,
    segment: usize,
    angle: Interval,
    is_root: bool,
}

impl<'a> OneImpact<'a> {
    /// The equation of a machine, with the time of the flight.
    fn of(machine: &'a Machine, revolutions: u64) -> (Self, Interval) {
        let (cam, flight, restitution) = (machine.cam(), machine.flight(), machine.restitution());
        let equation = Self { cam, flight, restitution, revolutions };
        (equation, equation.turn() / machine.angular_velocity())
    }

    fn solutions(&self, time: Interval) -> Vec<Solution> {
        let (segments, response) = (self.cam.segments(), self.flight.response_over(time));
        let mut all = Vec::new();
        // If the equation has no root over the hull of several segments' lifts, none of them is examined.
        let mut left = vec![(0, segments.len())];
        while let Some((first, end)) = left.pop() {
            let over = segments[first..end].iter().map(|segment| segment.over).reduce(Lift::hull);
            if !over.is_some_and(|over| self.equation(&over, time, &response).value.holds_zero()) {
                continue;
            }
            if end - first > 1 {
                let middle = first.midpoint(end);
                left.extend([(middle, end), (first, middle)]);
                continue;
            }
            let segment = &segments[first];
            let over = |[angle]: &[Interval; 1]| {
                let Equation { value, by_angle, .. } = self.equation(&segment.law.lift_over(*angle), time, &response);
                BoxValues { values: [value], derivatives: [[by_angle]], is_wanted: true }
            };
            let Isolated { roots, undecided, .. } = isolate([segment.angles()], MOST_BOXES, over);
            let roots = roots.into_iter().map(|root| (root, true));
            for ([angle], is_root) in roots.chain(joined(undecided).into_iter().map(|place| (place, false))) {
                let lift = segment.law.lift_over(angle.middle().into());
                let velocity_before = self.velocities(lift.value, time).map_or(0.0, |[before, _]| before.middle());
                let impact = Impact { revolution: 0, segment: first, cam_angle: angle.middle(), velocity_before };
                let guess = Cycle { revolutions: self.revolutions, impacts: vec![impact] };
                all.push(Solution { guess, segment: first, angle, is_root });
            }
        }
        all
    }
}

/// Returns guesses, one or more near every orbit of one impact.
pub(crate) fn near_one_impact(machine: &Machine, revolutions: u64) -> impl Iterator<Item = Cycle> {
    let (equation, time) = OneImpact::of(machine, revolutions);
    equation.solutions(time).into_iter().map(|solution| solution.guess)
}

/// Returns every solution at the speed of a machine, and places that may be solutions.
pub(crate) fn of_one_impact(machine: &Machine, revolutions: u64) -> Vec<Solved> {
    let (equation, time) = OneImpact::of(machine, revolutions);
    let standing = |&Solution { segment: index, angle, is_root, .. }: &Solution| {
        let segment = &equation.cam.segments()[index];
        let struck = |turns: u64| Struck { segment: index, angle, turns };
        // A root on the border may belong to the law of either side.
        match is_root && angle.is_inside(segment.angles()) {
            true => equation.standing([struck(0), struck(revolutions)], &segment.law.lift_over(angle), time),
            false => Standing::Undecided,
        }
    };
    let solved = equation.solutions(time).into_iter().map(|solution| {
        let standing = standing(&solution);
        let lift = equation.cam.segments()[solution.segment].law.lift_over(solution.angle);
        let before = equation.velocities(lift.value, time).map_or(Interval::EVERYTHING, |[before, _]| before);
        Solved { guess: solution.guess, angles: vec![solution.angle], velocities: vec![before], standing }
    });
    solved.collect()
}
