//! Where a one-impact, one-revolution orbit hits a corner of the cam: (x*, T*), from the model alone.
//!
//! The orbit leaves the corner (position c, velocity v+) and is back after T (velocity v-), so with the follower's responses
//! s(T), p(T) and the force f at c
//!
//! ```text
//! 0  = v+ s + f p            v- = v+ s' + f s            v+ = (1 + r) c' - r v-,   c' = (2 pi/T) dc/dtheta
//! ```
//!
//! v+ and v- leave the equation `-f p (1 + r s') + r f s^2 - (1 + r) c' s = 0` for T alone. Each of its roots is simulated for
//! one revolution on the cam as it is: only an orbit with this one impact, on this corner, that returns to its start counts.

use std::f64::consts::{PI, TAU};
use std::fmt;
use std::ops::ControlFlow;

use nalgebra::Vector2;

use crate::cam::{Cam, Corner};
use crate::flight::{Flight, State};
use crate::model::{Follower, Model, ModelError, Study};
use crate::section::StroboscopicMap;
use crate::simulate::{Event, EventKind, Machine};
use crate::tolerance;

/// A periodic orbit with one impact a revolution, on a corner of the cam.
#[derive(Clone, Debug, PartialEq)]
pub struct CornerImpact {
    /// The corner that it hits.
    pub corner: Corner,
    /// T*, s.
    pub period: f64,
    /// The two neighbouring doubles, or nearly, that T* was bracketed by.
    pub bracket: [f64; 2],
    /// Left side of the equation for T*, over the sum of its terms' sizes.
    pub residual: f64,
    /// v-, m/s.
    pub velocity_before: f64,
    /// v+, m/s.
    pub velocity_after: f64,
    /// c', m/s.
    pub cam_velocity: f64,
    /// The state half a revolution from the corner, in the cam's coordinates.
    pub state: State,
    /// Where the paper's x is measured from, m: the spring's equilibrium, or where the spring is slack if it has no stiffness.
    pub origin: f64,
    /// How far one simulated revolution ends from its start, over the orbit's size.
    pub closure: f64,
}

impl CornerImpact {
    /// omega*, rpm.
    pub fn speed_rpm(&self) -> f64 {
        60.0 / self.period
    }

    /// c'' before and after the corner, m/s^2.
    pub fn cam_acceleration(&self) -> [f64; 2] {
        [self.corner.minus, self.corner.plus].map(|lift| lift.curvature * (TAU / self.period).powi(2))
    }

    /// The stroboscopic section, rad: half a revolution from the corner, so that the impact is at t = 0 in [-T/2, T/2].
    pub fn section_angle(&self) -> f64 {
        (self.corner.angle + PI) % TAU
    }

    /// The paper's x*: position from the equilibrium, and velocity, on the section.
    pub fn x_star(&self) -> Vector2<f64> {
        Vector2::new(self.state.position - self.origin, self.state.velocity)
    }

    /// The stroboscopic map over `cam` at `angular_velocity`, rad/s.
    pub fn map(&self, model: &Model, cam: Cam, angular_velocity: f64) -> StroboscopicMap {
        stroboscopic_map(&model.follower, cam, &self.corner, angular_velocity)
    }
}

fn stroboscopic_map(follower: &Follower, cam: Cam, corner: &Corner, angular_velocity: f64) -> StroboscopicMap {
    let machine = Machine::new(cam, follower, angular_velocity);
    StroboscopicMap { machine, cam_angle: (corner.angle + PI) % TAU }
}

/// A root of the equation for T at some corner that is no orbit, and why not.
#[derive(Clone, Debug, PartialEq)]
pub struct Rejected {
    /// Cam angle of the corner, rad.
    pub cam_angle: f64,
    /// Speed, rpm.
    pub speed_rpm: f64,
    /// What is wrong with it.
    pub why: String,
}

/// Why there is no corner impact to study.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LocateError {
    /// The model says nothing about where to look, or something impossible.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// Nothing in range.
    #[error("{}", .0)]
    NotFound(Box<NotFound>),
    /// The only candidate touches the corner without relative velocity.
    #[error(
        "{file}: grazing impact at {speed_rpm:.6} rpm: the follower touches the corner at {:.6} deg with v = c' = {velocity} m/s; \
         there the map has no linear part, so there is no A and B to check",
        cam_angle.to_degrees()
    )]
    Grazing {
        /// Model file.
        file: String,
        /// Cam angle of the corner, rad.
        cam_angle: f64,
        /// Speed, rpm.
        speed_rpm: f64,
        /// v = c', m/s.
        velocity: f64,
    },
}

/// The complaint that `[study]` holds no corner impact.
#[derive(Clone, Debug, PartialEq)]
pub struct NotFound {
    study: ModelError,
    corners: Vec<f64>,
    rejected: Vec<Rejected>,
}

impl fmt::Display for NotFound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; ", self.study)?;
        if self.corners.is_empty() {
            return write!(f, "the cam has no corner where its acceleration jumps");
        }
        let degrees: Vec<_> = self.corners.iter().map(|angle| format!("{:.4}", angle.to_degrees())).collect();
        write!(f, "looked at the corners at {} deg; ", degrees.join(", "))?;
        if self.rejected.is_empty() {
            return write!(f, "no flight of one period starts and ends on any of them");
        }
        write!(f, "found instead:")?;
        for Rejected { cam_angle, speed_rpm, why } in &self.rejected {
            write!(f, "\n  {speed_rpm:.6} rpm at {:.4} deg: {why}", cam_angle.to_degrees())?;
        }
        Ok(())
    }
}

/// The slowest corner impact in `[study]`, and the others by rising speed.
pub fn locate(model: &Model, cam: &Cam) -> Result<(CornerImpact, Vec<CornerImpact>), LocateError> {
    let study = model.study()?;
    let follower = &model.follower;
    let flight = Flight::new(follower);
    let fastest_rate = (follower.stiffness / follower.mass).sqrt() + follower.damping / (2.0 * follower.mass);
    let corners: Vec<Corner> = cam.corners().into_iter().filter(|corner| corner.jump_order == 2).collect();
    let (mut found, mut rejected, mut grazing) = (Vec::new(), Vec::new(), None);
    for corner in &corners {
        let equation = PeriodEquation { flight: &flight, corner, restitution: follower.restitution, fastest_rate };
        let verdicts: Vec<(f64, Verdict)> = match equation.roots(study) {
            Roots::Some(roots) => {
                roots.into_iter().map(|root| (root.period, equation.orbit(model, cam, root))).collect()
            }
            Roots::TooMany { radians } => {
                let words = format!(
                    "spans too much: between it and study.rpm_max the period grows by {radians:.3e} radians of the follower's \
                     motion, and at most {:.3e} are searched",
                    PeriodEquation::SAMPLES[1] / PeriodEquation::SAMPLES_PER_RADIAN
                );
                return Err(model.reject("study.rpm_min", words).into());
            }
            Roots::NotFinite => {
                let words =
                    "gives periods at which the follower's motion overflows a double: check the model's magnitudes";
                return Err(model.reject("study.rpm_min", words).into());
            }
            Roots::All { slowest } if equation.rests() => vec![(slowest, equation.graze(model, cam, slowest))],
            Roots::All { slowest } => {
                let why = "flights of every period start and end there, so nothing fixes a speed".into();
                vec![(slowest, Verdict::Rejected(why))]
            }
        };
        for (period, verdict) in verdicts {
            let (cam_angle, speed_rpm) = (corner.angle, 60.0 / period);
            match verdict {
                Verdict::Orbit(orbit) => found.push(*orbit),
                Verdict::Rejected(why) => rejected.push(Rejected { cam_angle, speed_rpm, why }),
                Verdict::Grazing(velocity) => {
                    let file = model.file().into();
                    grazing.get_or_insert(LocateError::Grazing { file, cam_angle, speed_rpm, velocity });
                }
            }
        }
    }
    found.sort_by(|a, b| b.period.total_cmp(&a.period));
    let mut found = found.into_iter();
    if let Some(first) = found.next() {
        return Ok((first, found.collect()));
    }
    Err(grazing.unwrap_or_else(|| {
        let words =
            format!("no corner impact of a one-impact, one-revolution orbit up to study.rpm_max = {}", study.rpm_max);
        let corners = corners.iter().map(|corner| corner.angle).collect();
        LocateError::NotFound(Box::new(NotFound { study: model.reject("study.rpm_min", words), corners, rejected }))
    }))
}

/// The equation for T at one corner.
struct PeriodEquation<'a> {
    flight: &'a Flight,
    corner: &'a Corner,
    restitution: f64,
    /// w0 + zeta, 1/s.
    fastest_rate: f64,
}

#[derive(Clone, Copy)]
struct Root {
    period: f64,
    bracket: [f64; 2],
    residual: f64,
}

/// The roots in range.
enum Roots {
    Some(Vec<Root>),
    /// The equation holds at every speed.
    All {
        slowest: f64,
    },
    /// More oscillations between the shortest period and the longest than can be searched.
    TooMany {
        radians: f64,
    },
    /// The numbers of the model overflow in the equation.
    NotFinite,
}

enum Verdict {
    Orbit(Box<CornerImpact>),
    Grazing(f64),
    Rejected(String),
}

impl PeriodEquation<'_> {
    /// Least samples in `[study]`, and most: beyond them `[study]` is refused, not thinned out.
    const SAMPLES: [f64; 2] = [4096.0, 1e6];
    /// Samples for each radian or time constant that the follower goes through between the shortest period and the longest.
    const SAMPLES_PER_RADIAN: f64 = 64.0;

    fn force(&self) -> f64 {
        self.flight.force(self.corner.plus.value)
    }

    /// Whether a follower that rests at the corner stays there: no force, and a cam that does not move.
    fn rests(&self) -> bool {
        self.force() == 0.0 && self.corner.plus.slope == 0.0
    }

    fn cam_velocity(&self, period: f64) -> f64 {
        TAU / period * self.corner.plus.slope
    }

    /// `-f p (1 + r s') + r f s^2 - (1 + r) c' s`, and the sum of the sizes of its terms.
    fn evaluate(&self, period: f64) -> (f64, f64) {
        let response = self.flight.response(period);
        let (p, s, s1) = (response.step, response.impulse, response.impulse_rate);
        let (r, f) = (self.restitution, self.force());
        let terms = [-f * p, -f * p * r * s1, r * f * s * s, -(1.0 + r) * self.cam_velocity(period) * s];
        (terms.iter().sum(), terms.iter().map(|term| term.abs()).sum())
    }

    /// Every sign change over `[study]`, closed by bisection.
    fn roots(&self, study: Study) -> Roots {
        let (first, last) = (60.0 / study.rpm_max, 60.0 / study.rpm_min);
        let samples = Self::SAMPLES_PER_RADIAN * self.fastest_rate * (last - first);
        if !(samples <= Self::SAMPLES[1]) {
            return Roots::TooMany { radians: self.fastest_rate * (last - first) };
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
    fn close(&self, mut bracket: [f64; 2], negative_at_low: bool) -> Root {
        while bracket[1] - bracket[0] > tolerance::ROOT_WIDTH.value * bracket[1] {
            let middle = 0.5 * (bracket[0] + bracket[1]);
            let negative = self.evaluate(middle).0 < 0.0;
            bracket[usize::from(negative != negative_at_low)] = middle;
        }
        let period = 0.5 * (bracket[0] + bracket[1]);
        let (value, size) = self.evaluate(period);
        Root { period, bracket, residual: value.abs() / size }
    }

    /// Whether a flight that leaves the corner with the cam's own velocity is free of the cam until it is back.
    fn graze(&self, model: &Model, cam: &Cam, period: f64) -> Verdict {
        let velocity = self.cam_velocity(period);
        let machine = stroboscopic_map(&model.follower, cam.clone(), self.corner, TAU / period).machine;
        let state = State { position: self.corner.plus.value, velocity };
        let from_corner = |turned: f64| if turned > PI { turned - TAU } else { turned };
        match one_revolution(&machine, self.corner.angle, state, from_corner) {
            // Adding 0 takes the sign off a zero.
            Ok(_) => Verdict::Grazing(velocity + 0.0),
            Err(why) => Verdict::Rejected(format!("a graze, v = c' = {velocity:.6} m/s, and no orbit: {why}")),
        }
    }

    /// Whether a root is an orbit of the cam as it is.
    fn orbit(&self, model: &Model, cam: &Cam, root: Root) -> Verdict {
        let Root { period, bracket, residual } = root;
        let response = self.flight.response(period);
        let cam_velocity = self.cam_velocity(period);
        let force = self.force();
        // Half-period and full-period resonance (s = 0): any v+ or none brings the flight back after T.
        if response.impulse.abs() <= tolerance::GRAZING.value * period * response.impulse_rate.abs() {
            if response.step.abs() <= tolerance::GRAZING.value * period * period {
                // v+ is free, so only v+ = v- = c' obeys the restitution law.
                return self.graze(model, cam, period);
            }
            return Verdict::Rejected("the flight would need an unbounded velocity: the period is in resonance".into());
        }
        let velocity_after = -force * response.step / response.impulse;
        let velocity_before = velocity_after * response.impulse_rate + force * response.impulse;
        let approach = cam_velocity - velocity_before;
        if approach.abs() <= tolerance::GRAZING.value * (cam_velocity.abs() + velocity_before.abs()) {
            return self.graze(model, cam, period);
        }
        if approach < 0.0 {
            return Verdict::Rejected("the flight would come out of the cam at the corner".into());
        }
        let position = self.corner.plus.value;
        let state = self.flight.fly(State { position, velocity: velocity_after }, 0.5 * period).1;
        let map = stroboscopic_map(&model.follower, cam.clone(), self.corner, TAU / period);
        let (impacts, end) = match one_revolution(&map.machine, map.cam_angle, state, |turned| turned - PI) {
            Ok(result) => result,
            Err(why) => return Verdict::Rejected(why),
        };
        let size = (state.position - position).abs() + period * approach;
        let closure = ((end.position - state.position).abs() + period * (end.velocity - state.velocity).abs()) / size;
        // A plastic impact a rounding before the corner is followed by another a rounding after it: they are one.
        if impacts == 0 || closure > tolerance::ORBIT_CLOSURE.value {
            return Verdict::Rejected(format!(
                "one revolution has {impacts} impacts and ends {closure:e} of the orbit's size from its start"
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
        }))
    }
}

/// Impacts and end of one revolution, or why it is no orbit with impacts only where `from_corner(turned)` is 0.
fn one_revolution(
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
    let goal = motion.after(1);
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

/// Where the paper's x is measured from: the equilibrium `rest - g/w0^2`, or the slack spring without stiffness, m.
fn origin(follower: &Follower) -> f64 {
    if follower.stiffness > 0.0 {
        follower.rest_position - follower.mass * follower.gravity / follower.stiffness
    } else {
        follower.rest_position
    }
}
