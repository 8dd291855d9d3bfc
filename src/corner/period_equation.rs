//! All speeds of a range at which an orbit with one impact in n revolutions has it on a given corner.
//!
//! The orbit leaves the corner (position c, velocity v+) and is back after `t = n T` (velocity v-), so with the follower's
//! responses s(t), p(t) and the force f at c
//!
//! ```text
//! 0  = v+ s + f p            v- = v+ s' + f s            v+ = (1 + r) c' - r v-,   c' = (2 pi/T) dc/dtheta
//! ```
//!
//! Eliminating v+ and v- gives the equation of [`OneImpact`] for T alone. All its roots are isolated; none is missed. Each root is
//! simulated for one period on the cam as it is. It counts only if the orbit has this one impact, on this corner, and returns to
//! its start. Where enclosures suffice, they also prove that the root is an orbit, or that it is none.

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

use super::confirm::Candidate;
use super::corner_impact::{CornerImpact, Way, origin};
use crate::cam::{Cam, Corner, Lift, Side};
use crate::flight::{Flight, State};
use crate::interval::Interval;
use crate::interval::roots::{BoxValues, Isolated, isolate};
use crate::model::{Follower, Model, Study};
use crate::orbit::complete::{OneImpact, Standing, Struck, joined};
use crate::orbit::{Cycle, Impact};
use crate::simulate::{Event, EventKind, Machine};
use crate::tolerance;

/// The equation for T at one corner.
pub struct PeriodEquation<'a> {
    cam: &'a Cam,
    flight: Flight,
    corner: &'a Corner,
    side: Side,
    revolutions: u64,
    restitution: f64,
    /// Lift and slope on the corner, of its side; of both where they agree but for rounding.
    lift: Lift<Interval>,
    /// w0 + zeta, 1/s.
    fastest_rate: f64,
}

/// A period that solves the equation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// T, s.
    pub period: f64,
    /// Bracket of T, s, with no other root in it.
    pub bracket: [f64; 2],
    /// Left side over the sum of its terms' sizes.
    pub residual: f64,
    /// Orbit or not, as far as enclosures prove it.
    pub standing: Standing,
}

/// The roots in range.
pub enum Roots {
    /// All of them, but for some between these periods, s.
    Some(Vec<Root>, Vec<[f64; 2]>),
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

/// Why a period in which the follower comes back however it leaves is refused.
pub const RESONANCE: &str = "the flight would need an unbounded velocity: the period is in resonance";

/// Verdict on a root.
pub enum RootVerdict {
    /// An orbit of the cam as it is.
    Orbit(Box<CornerImpact>),
    /// An orbit that touches the corner at this velocity, m/s, and does not hit it.
    Grazing(f64),
    /// No orbit, and why.
    Rejected(String),
}

impl<'a> PeriodEquation<'a> {
    /// Boxes after which the rest of a range is left undecided: so many, and as many for each radian of the follower's motion.
    const MOST_BOXES: [usize; 2] = [1024, 64];
    /// The most radians of the follower's motion, between the shortest period and the longest, that are searched.
    pub const MOST_RADIANS: f64 = 15_625.0;

    /// One impact in `revolutions`, on `corner` with the velocity of `side`.
    pub fn new(follower: &Follower, cam: &'a Cam, corner: &'a Corner, side: Side, revolutions: u64) -> Self {
        let fastest_rate = (follower.stiffness / follower.mass).sqrt() + follower.damping / (2.0 * follower.mass);
        let (flight, restitution) = (Flight::new(follower), follower.restitution);
        let (before, after) = (&cam.segments()[cam.before(corner.segment)], &cam.segments()[corner.segment]);
        let (minus, plus) = (before.law.lift_over(before.end.into()), after.law.lift_over(after.start.into()));
        let lift = match (corner.jump_order, side) {
            (1, Side::Minus) => minus,
            (1, Side::Plus) => plus,
            _ => Lift { value: minus.value.hull(plus.value), slope: minus.slope.hull(plus.slope), ..plus },
        };
        Self { cam, flight, corner, side, revolutions, restitution, lift, fastest_rate }
    }

    fn one_impact(&self) -> OneImpact<'_> {
        let Self { cam, flight, restitution, revolutions, .. } = self;
        OneImpact { cam, flight, restitution: *restitution, revolutions: *revolutions }
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
        self.force() == 0.0 && self.slope() == 0.0
    }

    /// dc/dtheta, m/rad.
    fn slope(&self) -> f64 {
        if self.side == Side::Minus { self.corner.minus.slope } else { self.corner.plus.slope }
    }

    fn cam_velocity(&self, period: f64) -> f64 {
        TAU / period * self.slope()
    }

    /// Every root over a range of speeds.
    pub fn roots(&self, range: Study) -> Roots {
        let (first, last) = (60.0 / range.rpm_max, 60.0 / range.rpm_min);
        let radians = self.fastest_rate * self.flight_time(last - first);
        if !(radians <= Self::MOST_RADIANS) {
            return Roots::TooMany { radians };
        }
        let equation = self.one_impact();
        let at = |time: Interval| equation.equation(&self.lift, time, &self.flight.response_over(time));
        let times = [first, last].map(|period| self.flight_time(period));
        if times.iter().any(|time| !at((*time).into()).size.is_finite()) {
            return Roots::NotFinite;
        }
        let [least, for_each] = Self::MOST_BOXES;
        let most = least + for_each * radians as usize;
        let Isolated { roots, undecided, .. } = isolate([Interval::new(times[0], times[1])], most, |[time]| {
            let equation = at(*time);
            BoxValues { values: [equation.value], derivatives: [[equation.by_time]], is_wanted: true }
        });
        let ends = |time: Interval| [time.low(), time.high()].map(|time| time / self.revolutions as f64);
        let undecided: Vec<[f64; 2]> = joined(undecided).into_iter().map(|[time]| ends(time)).collect();
        if let [[from, to]] = undecided[..]
            && [from, to] == [times[0], times[1]].map(|time| time / self.revolutions as f64)
        {
            return Roots::All { slowest: last };
        }
        let root = |[time]: [Interval; 1]| {
            let middle = at(time.middle().into());
            let residual = middle.value.middle().abs() / middle.size;
            let period = time.middle() / self.revolutions as f64;
            Root { period, bracket: ends(time), residual, standing: self.standing(time) }
        };
        Roots::Some(roots.into_iter().map(root).collect(), undecided)
    }

    /// Classifies a root by enclosures: its flight leaves the corner over the segment after it, and returns over the one before.
    fn standing(&self, time: Interval) -> Standing {
        let after = self.corner.segment;
        let before = self.cam.before(after);
        let turns = if after == 0 { self.revolutions - 1 } else { self.revolutions };
        let segments = self.cam.segments();
        let from = Struck { segment: after, angle: segments[after].start.into(), turns: 0 };
        let to = Struck { segment: before, angle: segments[before].end.into(), turns };
        self.one_impact().standing([from, to], &self.lift, time)
    }

    /// Whether a flight that leaves the corner with the cam's own velocity is free of the cam until it is back.
    pub fn graze(&self, model: &Model, cam: &Cam, period: f64) -> RootVerdict {
        let velocity = self.cam_velocity(period);
        let machine = Machine::new(cam.clone(), &model.follower, TAU / period);
        let state = State { position: self.corner.plus.value, velocity };
        let whole = self.revolutions as f64;
        let from_corner = |turned: f64| if turned > whole * PI { turned - whole * TAU } else { turned };
        match self.one_period(&machine, self.corner.angle, state, from_corner) {
            // Adding 0 takes the sign off a zero.
            Ok(_) => RootVerdict::Grazing(velocity + 0.0),
            Err(why) => RootVerdict::Rejected(format!("a graze, v = c', and no orbit: {why}")),
        }
    }

    /// Whether a root is an orbit of the cam as it is.
    pub fn orbit(&self, model: &Model, cam: &Cam, root: Root) -> RootVerdict {
        let Root { period, bracket, residual, .. } = root;
        let time = self.flight_time(period);
        let response = self.flight.response(time);
        let cam_velocity = self.cam_velocity(period);
        // Half-period and full-period resonance (s = 0): any v+ or none brings the flight back.
        if response.impulse.abs() <= tolerance::GRAZING.value * time * response.impulse_rate.abs() {
            if response.step.abs() <= tolerance::GRAZING.value * time * time {
                // v+ is free, so only v+ = v- = c' obeys the restitution law.
                return self.graze(model, cam, period);
            }
            return RootVerdict::Rejected(RESONANCE.into());
        }
        let Some([velocity_before, velocity_after]) = self.velocities(period) else {
            return RootVerdict::Rejected(RESONANCE.into());
        };
        let approach = cam_velocity - velocity_before;
        if approach.abs() <= tolerance::GRAZING.value * (cam_velocity.abs() + velocity_before.abs()) {
            return self.graze(model, cam, period);
        }
        if approach < 0.0 {
            return RootVerdict::Rejected("the flight would come out of the cam at the corner".into());
        }
        let position = self.corner.plus.value;
        let state = self.flight.fly(State { position, velocity: velocity_after }, 0.5 * time).1;
        let half = self.revolutions as f64 * PI;
        let section = (self.corner.angle + half) % TAU;
        let machine = Machine::new(cam.clone(), &model.follower, TAU / period);
        let (is_hit, end) = match self.one_period(&machine, section, state, |turned| turned - half) {
            Ok(result) => result,
            Err(why) => return RootVerdict::Rejected(why),
        };
        // What is simulated has met the cam too slowly to hit it.
        if !is_hit {
            return self.graze(model, cam, period);
        }
        // Half a period later it may be as high as the corner, on its way past it.
        let size = (state.position - position).abs() + time * (approach + state.velocity.abs());
        let closure = ((end.position - state.position).abs() + time * (end.velocity - state.velocity).abs()) / size;
        if closure > tolerance::ORBIT_CLOSURE.value {
            return RootVerdict::Rejected(format!("one period ends {closure:e} of the orbit's size from its start"));
        }
        RootVerdict::Orbit(Box::new(CornerImpact {
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
            ways: vec![Way::Equation],
        }))
    }

    /// v- and v+, m/s; none in resonance.
    fn velocities(&self, period: f64) -> Option<[f64; 2]> {
        let velocities = self.one_impact().velocities(self.lift.value, self.flight_time(period).into());
        velocities.map(|velocities| velocities.map(Interval::middle))
    }

    /// The orbit's one impact, on its side of the corner.
    fn cycle(&self, cam: &Cam, velocity_before: f64) -> Cycle {
        let impact = at_corner(cam, self.corner, self.side, 0, velocity_before);
        Cycle { revolutions: self.revolutions, impacts: vec![impact] }
    }

    /// A root as its impact and period, whether or not it is an orbit of the cam; `None` in resonance.
    pub fn candidate(&self, cam: &Cam, root: Root) -> Option<Candidate> {
        let [velocity_before, _] = self.velocities(root.period)?;
        let cycle = self.cycle(cam, velocity_before);
        let (corner, side, Root { period, bracket, residual, .. }) = (*self.corner, self.side, root);
        Some(Candidate { cycle, impact: 0, corner, side, period, bracket, residual, way: Way::Equation })
    }

    /// Whether the cam is hit in one period, and its end, or why it is no orbit with impacts only where `from_corner(turned)` is 0.
    fn one_period(
        &self,
        machine: &Machine,
        cam_angle: f64,
        start: State,
        from_corner: impl Fn(f64) -> f64,
    ) -> Result<(bool, State), String> {
        let mut motion = machine.start(cam_angle, start).map_err(|error| error.to_string())?;
        let (mut is_hit, mut why) = (false, None);
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
            is_hit |= event.kind == EventKind::Impact;
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
            (None, Ok(_)) => Ok((is_hit, motion.state)),
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
