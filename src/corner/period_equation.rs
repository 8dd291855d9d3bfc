//! The speeds at which an orbit with one impact in n revolutions has it on a given corner: all of a range.
//!
//! The orbit leaves the corner (position c, velocity v+) and is back after `t = n T` (velocity v-), so with the follower's
//! responses s(t), p(t) and the force f at c
//!
//! ```text
//! 0  = v+ s + f p            v- = v+ s' + f s            v+ = (1 + r) c' - r v-,   c' = (2 pi/T) dc/dtheta
//! ```
//!
//! v+ and v- leave the equation `-f p (1 + r s') + r f s^2 - (1 + r) c' s = 0` for T alone. Each of its roots is simulated for
//! one period on the cam as it is: only an orbit with this one impact, on this corner, that returns to its start counts.

use std::convert::Infallible;
use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

use super::confirm::Candidate;
use super::corner_impact::{CornerImpact, origin};
use crate::bracket::{Width, halve};
use crate::cam::{Cam, Corner, Lift, Side};
use crate::flight::{Flight, State};
use crate::model::{Follower, Model, Study};
use crate::orbit::{Cycle, Impact};
use crate::simulate::{Event, EventKind, Machine};
use crate::tolerance;

/// The equation for T at one corner.
pub struct PeriodEquation<'a> {
    flight: Flight,
    corner: &'a Corner,
    side: Side,
    revolutions: u64,
    restitution: f64,
    /// w0 + zeta, 1/s.
    fastest_rate: f64,
}

/// A period that solves the equation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// T, s.
    pub period: f64,
    /// What it was closed in by.
    pub bracket: [f64; 2],
    /// Left side over the sum of its terms' sizes.
    pub residual: f64,
}

/// The roots in range.
pub enum Roots {
    Some(Vec<Root>),
    /// The equation holds at every speed.
    All {
        /// The longest period, s.
        slowest: f64,
    },
    /// More oscillations between the shortest period and the longest than can be searched.
    TooMany {
        /// How many, rad.
        radians: f64,
    },
    /// The numbers of the model overflow in the equation.
    NotFinite,
}

/// What a root is.
pub enum Verdict {
    /// An orbit of the cam as it is.
    Orbit(Box<CornerImpact>),
    /// An orbit that touches the corner at this velocity, m/s, and does not hit it.
    Grazing(f64),
    /// No orbit, and why.
    Rejected(String),
}

impl<'a> PeriodEquation<'a> {
    /// Least samples in a range, and most: beyond them the range is refused, not thinned out.
    pub const SAMPLES: [f64; 2] = [4096.0, 1e6];
    /// Samples for each radian or time constant that the follower goes through between the shortest period and the longest.
    const SAMPLES_PER_RADIAN: f64 = 64.0;
    /// The most radians of the follower's motion, between the shortest period and the longest, that are searched.
    pub const MOST_RADIANS: f64 = Self::SAMPLES[1] / Self::SAMPLES_PER_RADIAN;

    /// One impact in `revolutions`, on `corner` with the velocity of `side`.
    pub fn new(follower: &Follower, corner: &'a Corner, side: Side, revolutions: u64) -> Self {
        let fastest_rate = (follower.stiffness / follower.mass).sqrt() + follower.damping / (2.0 * follower.mass);
        let (flight, restitution) = (Flight::new(follower), follower.restitution);
        Self { flight, corner, side, revolutions, restitution, fastest_rate }
    }

    fn lift(&self) -> &Lift {
        match self.side {
            Side::Minus => &self.corner.minus,
            Side::Plus => &self.corner.plus,
        }
    }

    fn force(&self) -> f64 {
        self.flight.force(self.corner.plus.value)
    }

    /// n T, s.
    fn flight_time(&self, period: f64) -> f64 {
        self.revolutions as f64 * period
    }

    /// Whether a follower that rests at the corner stays there: no force, and a cam that does not move.
    pub fn rests(&self) -> bool {
        self.force() == 0.0 && self.lift().slope == 0.0
    }

    fn cam_velocity(&self, period: f64) -> f64 {
        TAU / period * self.lift().slope
    }

    /// `-f p (1 + r s') + r f s^2 - (1 + r) c' s`, and the sum of the sizes of its terms.
    fn evaluate(&self, period: f64) -> (f64, f64) {
        let response = self.flight.response(self.flight_time(period));
        let (p, s, s1) = (response.step, response.impulse, response.impulse_rate);
        let (r, f) = (self.restitution, self.force());
        let terms = [-f * p, -f * p * r * s1, r * f * s * s, -(1.0 + r) * self.cam_velocity(period) * s];
        (terms.iter().sum(), terms.iter().map(|term| term.abs()).sum())
    }

    /// Every sign change over a range of speeds, closed by bisection.
    pub fn roots(&self, range: Study) -> Roots {
        let (first, last) = (60.0 / range.rpm_max, 60.0 / range.rpm_min);
        let radians = self.fastest_rate * self.flight_time(last - first);
        let samples = Self::SAMPLES_PER_RADIAN * radians;
        if !(samples <= Self::SAMPLES[1]) {
            return Roots::TooMany { radians };
        }
        let samples = samples.max(Self::SAMPLES[0]) as usize;
        let at = |index: usize| first + (last - first) * index as f64 / samples as f64;
        let mut roots = Vec::new();
        let (mut largest, mut largest_term) = (0.0_f64, 0.0_f64);
        let (mut low, mut at_low) = (first, self.evaluate(first).0);
        let mut finite = at_low.is_finite();
        for index in 1..=samples {
            let high = at(index);
            let (at_high, size) = self.evaluate(high);
            finite &= at_high.is_finite();
            (largest, largest_term) = (largest.max(at_high.abs()), largest_term.max(size));
            if (at_low < 0.0) != (at_high < 0.0) {
                roots.push(self.close([low, high], at_low < 0.0));
            }
            (low, at_low) = (high, at_high);
        }
        if !finite {
            Roots::NotFinite
        } else if largest <= tolerance::DEGENERATE.value * largest_term {
            Roots::All { slowest: last }
        } else {
            Roots::Some(roots)
        }
    }

    /// Bisection down to neighbouring doubles.
    fn close(&self, bracket: [f64; 2], negative_at_low: bool) -> Root {
        let changed = |period: f64| Ok::<_, Infallible>((self.evaluate(period).0 < 0.0) != negative_at_low);
        let Ok(bracket) = halve(bracket, Width::Relative(tolerance::ROOT_WIDTH.value), changed);
        let period = 0.5 * (bracket[0] + bracket[1]);
        let (value, size) = self.evaluate(period);
        Root { period, bracket, residual: value.abs() / size }
    }

    /// Whether a flight that leaves the corner with the cam's own velocity is free of the cam until it is back.
    pub fn graze(&self, model: &Model, cam: &Cam, period: f64) -> Verdict {
        let velocity = self.cam_velocity(period);
        let machine = Machine::new(cam.clone(), &model.follower, TAU / period);
        let state = State { position: self.corner.plus.value, velocity };
        let whole = self.revolutions as f64;
        let from_corner = |turned: f64| if turned > whole * PI { turned - whole * TAU } else { turned };
        match self.one_period(&machine, self.corner.angle, state, from_corner) {
            // Adding 0 takes the sign off a zero.
            Ok(_) => Verdict::Grazing(velocity + 0.0),
            Err(why) => Verdict::Rejected(format!("a graze, v = c' = {velocity:.6} m/s, and no orbit: {why}")),
        }
    }

    /// v- and v+, m/s, where `s` is not 0.
    fn velocities(&self, period: f64) -> [f64; 2] {
        let response = self.flight.response(self.flight_time(period));
        let force = self.force();
        let after = -force * response.step / response.impulse;
        [after * response.impulse_rate + force * response.impulse, after]
    }

    /// Whether a root is an orbit of the cam as it is.
    pub fn orbit(&self, model: &Model, cam: &Cam, root: Root) -> Verdict {
        let Root { period, bracket, residual } = root;
        let time = self.flight_time(period);
        let response = self.flight.response(time);
        let cam_velocity = self.cam_velocity(period);
        // Half-period and full-period resonance (s = 0): any v+ or none brings the flight back.
        if response.impulse.abs() <= tolerance::GRAZING.value * time * response.impulse_rate.abs() {
            if response.step.abs() <= tolerance::GRAZING.value * time * time {
                // v+ is free, so only v+ = v- = c' obeys the restitution law.
                return self.graze(model, cam, period);
            }
            return Verdict::Rejected("the flight would need an unbounded velocity: the period is in resonance".into());
        }
        let [velocity_before, velocity_after] = self.velocities(period);
        let approach = cam_velocity - velocity_before;
        if approach.abs() <= tolerance::GRAZING.value * (cam_velocity.abs() + velocity_before.abs()) {
            return self.graze(model, cam, period);
        }
        if approach < 0.0 {
            return Verdict::Rejected("the flight would come out of the cam at the corner".into());
        }
        let position = self.corner.plus.value;
        let state = self.flight.fly(State { position, velocity: velocity_after }, 0.5 * time).1;
        let half = self.revolutions as f64 * PI;
        let section = (self.corner.angle + half) % TAU;
        let machine = Machine::new(cam.clone(), &model.follower, TAU / period);
        let (impacts, end) = match self.one_period(&machine, section, state, |turned| turned - half) {
            Ok(result) => result,
            Err(why) => return Verdict::Rejected(why),
        };
        let size = (state.position - position).abs() + time * approach;
        let closure = ((end.position - state.position).abs() + time * (end.velocity - state.velocity).abs()) / size;
        // A plastic impact a rounding before the corner is followed by another a rounding after it: they are one.
        if impacts == 0 || closure > tolerance::ORBIT_CLOSURE.value {
            return Verdict::Rejected(format!(
                "one period has {impacts} impacts and ends {closure:e} of the orbit's size from its start"
            ));
        }
        Verdict::Orbit(Box::new(CornerImpact {
            corner: *self.corner,
            period,
            bracket,
            residual,
            velocity_before,
            velocity_after,
            cam_velocity,
            state,
            origin: origin(&model.follower),
            closure,
            cycle: self.cycle(cam, velocity_before),
            impact: 0,
            side: self.side,
        }))
    }

    /// The orbit's one impact, on its side of the corner.
    fn cycle(&self, cam: &Cam, velocity_before: f64) -> Cycle {
        let impact = at_corner(cam, self.corner, self.side, 0, velocity_before);
        Cycle { revolutions: self.revolutions, impacts: vec![impact] }
    }

    /// A root as its impact and period, whether or not it is an orbit of the cam; `None` in resonance.
    pub fn candidate(&self, cam: &Cam, root: Root) -> Option<Candidate> {
        let [velocity_before, _] = self.velocities(root.period);
        let cycle = self.cycle(cam, velocity_before);
        let (corner, side, Root { period, bracket, residual }) = (*self.corner, self.side, root);
        let candidate = Candidate { cycle, impact: 0, corner, side, period, bracket, residual };
        velocity_before.is_finite().then_some(candidate)
    }

    /// Impacts and end of one period, or why it is no orbit with impacts only where `from_corner(turned)` is 0.
    fn one_period(
        &self,
        machine: &Machine,
        cam_angle: f64,
        start: State,
        from_corner: impl Fn(f64) -> f64,
    ) -> Result<(usize, State), String> {
        let mut motion = machine.start(cam_angle, start).map_err(|error| error.to_string())?;
        let (mut impacts, mut why) = (0, None);
        let angle = |event: &Event| event.cam_angle.to_degrees();
        if motion.contact {
            return Err(format!("the follower stays on the cam at {:.4} deg", cam_angle.to_degrees()));
        }
        let goal = motion.after(self.revolutions);
        let end = machine.advance(&mut motion, goal, &mut |event: &Event| {
            let approach = event.cam_velocity - event.velocity_before;
            let scale = event.cam_velocity.abs() + event.velocity_before.abs();
            // Where a graze is found is known to the root of rounding only; it changes nothing.
            if event.kind == EventKind::Impact && approach <= tolerance::GRAZE_FOUND.value * scale {
                return ControlFlow::Continue(());
            }
            impacts += usize::from(event.kind == EventKind::Impact);
            if from_corner(event.turned_since(cam_angle)).abs() > tolerance::CORNER_ANGLE.value {
                why = Some(match event.kind {
                    EventKind::Impact => format!("the flight meets the cam elsewhere, at {:.4} deg", angle(event)),
                    _ => format!("the follower sticks to the cam up to or from {:.4} deg", angle(event)),
                });
            }
            if why.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        match (why, end) {
            (Some(why), _) => Err(why),
            (None, Ok(_)) => Ok((impacts, motion.state)),
            (None, Err(error)) => Err(error.to_string()),
        }
    }
}

/// An impact on a corner, by the law of one side; at angle 0 the side before ends the revolution before.
pub fn at_corner(cam: &Cam, corner: &Corner, side: Side, revolution: i64, velocity_before: f64) -> Impact {
    match (side, corner.segment) {
        (Side::Plus, segment) => Impact { revolution, segment, cam_angle: corner.angle, velocity_before },
        (Side::Minus, 0) => {
            let (segment, cam_angle) = (cam.segments().len() - 1, TAU);
            Impact { revolution: revolution - 1, segment, cam_angle, velocity_before }
        }
        (Side::Minus, after) => Impact { revolution, segment: after - 1, cam_angle: corner.angle, velocity_before },
    }
}
