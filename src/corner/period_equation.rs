//! Equation for the speeds at which an orbit with one impact in n revolutions has it on a given corner, with all its roots in a range.
//!
//! The orbit leaves the corner (position c, velocity v+) and returns after `t = n T` (velocity v-), so with the follower's responses s(t),
//! p(t) and the force f at c
//!
//! ```text
//! 0  = v+ s + f p            v- = v+ s' + f s            v+ = (1 + r) c' - r v-,   c' = (2 pi/T) dc/dtheta
//! ```
//!
//! Eliminating v+ and v- gives the equation of [`OneImpact`] for T alone. All its roots are isolated; none is missed. Each root is
//! simulated for one period on the actual cam. It counts only if the orbit has this one impact, on this corner, and returns to its start.
//! Where enclosures suffice, they also prove whether the root is an orbit.

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

/// Equation for T at one corner.
pub struct PeriodEquation<'a> {
    cam: &'a Cam,
    flight: Flight,
    corner: &'a Corner,
    side: Side,
    revolutions: u64,
    restitution: f64,
    /// Lift and slope at the corner on its side; the hull of both sides if they agree up to rounding.
    lift: Lift<Interval>,
    /// w0 + zeta, 1/s.
    fastest_rate: f64,
}

/// Period that solves the equation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// Period T, s.
    pub period: f64,
    /// Bracket of T, s, with no other root in it.
    pub bracket: [f64; 2],
    /// Left side of the equation, relative to the sum of its terms' sizes.
    pub residual: f64,
    /// Proved classification of the root, as orbit or not, if enclosures decide it.
    pub standing: Standing,
}

/// Roots of the equation in a range of speeds.
pub enum Roots {
    /// All roots, except between these periods, s, where the search is undecided.
    Some(Vec<Root>, Vec<[f64; 2]>),
    /// Equation that holds at every speed.
    All {
        /// Longest period, s.
        slowest: f64,
    },
    /// Range with more oscillations between the shortest and the longest period than can be searched.
    TooMany {
        /// Growth of the follower's phase over the range, rad.
        radians: f64,
    },
    /// Overflow of the model's numbers in the equation.
    NotFinite,
}

/// Reason for refusing a period at which the follower returns with any initial velocity, or with none.
pub const RESONANCE: &str = "the flight would need an unbounded velocity: the period is in resonance";

/// Verdict on a root.
pub enum RootVerdict {
    /// Orbit of the actual cam.
    Orbit(Box<CornerImpact>),
    /// Orbit that touches the corner at this velocity, m/s, and does not hit it.
    Grazing(f64),
    /// Root that is not an orbit, with the reason.
    Rejected(String),
}

impl<'a> PeriodEquation<'a> {
    /// Number of boxes after which the rest of a range is left undecided: a fixed part, and a part per radian of the follower's motion.
    const MOST_BOXES: [usize; 2] = [1024, 64];
    /// Largest growth of the follower's phase over a range that is searched, rad.
    pub const MOST_RADIANS: f64 = 15_625.0;

    /// Builds the equation for one impact in `revolutions`, on `corner` with the velocity of `side`.
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

    /// Whether a follower at rest on the corner stays there: no force, and a cam that does not move.
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

    /// Finds every root over a range of speeds.
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

    /// Tests whether a flight that leaves the corner with the cam's velocity is free of the cam until it returns.
    pub fn graze(&self, model: &Model, cam: &Cam, period: f64) -> RootVerdict {
        let velocity = self.cam_velocity(period);
        let machine = Machine::new(cam.clone(), &model.follower, TAU / period);
        let state = State { position: self.corner.plus.value, velocity };
        let whole = self.revolutions as f64;
        let from_corner = |turned: f64| if turned > whole * PI { turned - whole * TAU } else { turned };
        match self.one_period(&machine, self.corner.angle, state, from_corner) {
            // Adding 0 turns -0 into 0.
            Ok(_) => RootVerdict::Grazing(velocity + 0.0),
            Err(why) => RootVerdict::Rejected(format!("a graze, v = c', and no orbit: {why}")),
        }
    }

    /// Tests whether a root is an orbit of the actual cam.
    pub fn orbit(&self, model: &Model, cam: &Cam, root: Root) -> RootVerdict {
        let Root { period, bracket, residual, .. } = root;
        let time = self.flight_time(period);
        let response = self.flight.response(time);
        let cam_velocity = self.cam_velocity(period);
        // Resonance (s = 0): the flight returns for any v+ or for none.
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
        // The simulated follower has met the cam too slowly to hit it.
        if !is_hit {
            return self.graze(model, cam, period);
        }
        // Half a period later the follower may be at the corner's height, moving past it.
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

    /// Velocities v- and v+, m/s; `None` in resonance.
    fn velocities(&self, period: f64) -> Option<[f64; 2]> {
        let velocities = self.one_impact().velocities(self.lift.value, self.flight_time(period).into());
        velocities.map(|velocities| velocities.map(Interval::middle))
    }

    /// Cycle of the orbit's one impact, on its side of the corner.
    fn cycle(&self, cam: &Cam, velocity_before: f64) -> Cycle {
        let impact = at_corner(cam, self.corner, self.side, 0, velocity_before);
        Cycle { revolutions: self.revolutions, impacts: vec![impact] }
    }

    /// Returns the impact and period of a root, whether or not it is an orbit of the cam; `None` in resonance.
    pub fn candidate(&self, cam: &Cam, root: Root) -> Option<Candidate> {
        let [velocity_before, _] = self.velocities(root.period)?;
        let cycle = self.cycle(cam, velocity_before);
        let (corner, side, Root { period, bracket, residual, .. }) = (*self.corner, self.side, root);
        Some(Candidate { cycle, impact: 0, corner, side, period, bracket, residual, way: Way::Equation })
    }

    /// Simulates one period: returns whether the cam is hit, and the final state. The error is the reason why it is no orbit with impacts
    /// only where `from_corner(turned)` is 0.
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
            // The angle of a graze is accurate only to the root of rounding; the graze changes nothing.
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

/// Impact on a corner, by the law of one side. At angle 0 the side before belongs to the end of the previous revolution.
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
