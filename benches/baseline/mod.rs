//! The scan-and-bisect loop: what a careful user writes in an afternoon, and what every speed is compared with.
//!
//! Of the crate it takes the model and the cam's lift. The undamped follower's flight is its closed form,
//!
//! ```text
//! q(t) = q* + (q0 - q*) cos w0 t + v0/w0 sin w0 t        q* = rest - g/w0^2, the spring's equilibrium
//! v(t) = -w0 (q0 - q*) sin w0 t + v0 cos w0 t
//! ```
//!
//! and an event is found by evaluating the gap `q(t) - c(theta0 + omega t)` at a fixed spacing of [`STEPS`] a revolution from
//! the start of the flight on, and bisecting the first change of sign. What it cannot do: see the follower dip into the cam
//! and out again between two points of the grid, and follow impacts that accumulate, which it ends with a cut-off.

#![allow(clippy::disallowed_methods, reason = "what is timed beside the project uses the standard library")]

use std::f64::consts::TAU;

use corner_impact::cam::{Cam, Law};
use corner_impact::flight::State;
use corner_impact::model::Model;

/// Points of the grid in a revolution, 1.4 degrees apart: at 700 rpm a point every 0.33 ms. Fine enough for every impact of the
/// paper's diagrams but grazes of less than 0.1 mm, and as coarse as that allows: a finer grid would flatter what is compared.
pub const STEPS: u32 = 256;

/// Width of the bracket that ends the bisection, rad.
pub const BISECT_TO: f64 = 1e-14;

/// Relative velocity after an impact below which the follower stays on the cam, m/s.
pub const STICKS_BELOW: f64 = 1e-6;

/// Follower, cam and speed, in the terms of the loop.
pub struct Baseline {
    cam: Cam,
    omega0: f64,
    equilibrium: f64,
    restitution: f64,
    omega: f64,
}

/// Where the follower is: on the cam or above it.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Cam angle, rad, in `[0, 2 pi)`.
    pub cam_angle: f64,
    /// Position and velocity.
    pub state: State,
}

/// What happened at an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The follower hit the cam and left it.
    Impact,
    /// The follower hit the cam and stayed.
    Stick,
    /// The cam fell away from under the follower.
    Release,
}

/// An event of the run.
#[allow(dead_code)] // the program prints what the benchmarks only count
#[derive(Clone, Copy, Debug)]
pub struct Event {
    /// What it was.
    pub kind: Kind,
    /// Angle turned since the start of the run, rad.
    pub turned: f64,
    /// Cam angle, rad, in `[0, 2 pi)`.
    pub cam_angle: f64,
    /// v-, m/s.
    pub velocity_before: f64,
    /// v+, m/s.
    pub velocity_after: f64,
}

impl Baseline {
    /// The loop for a model at a speed, or why its closed form does not apply.
    pub fn new(model: &Model, rpm: f64) -> Result<Self, String> {
        let follower = &model.follower;
        if follower.damping != 0.0 || follower.stiffness <= 0.0 {
            return Err("the baseline knows the undamped follower on a spring only".into());
        }
        let omega0_squared = follower.stiffness / follower.mass;
        Ok(Self {
            cam: Cam::new(model).map_err(|error| error.to_string())?,
            omega0: omega0_squared.sqrt(),
            equilibrium: follower.rest_position - follower.gravity / omega0_squared,
            restitution: follower.restitution,
            omega: rpm * TAU / 60.0,
        })
    }

    /// Turns the cam by `turn`, rad, and returns where the follower ends; `observe` sees every event.
    pub fn run(&self, start: Place, turn: f64, mut observe: impl FnMut(&Event)) -> Place {
        let (mut now, mut turned) = (start, 0.0);
        loop {
            let Some((flown, landing)) = self.fly(now, turn - turned) else {
                return self.after_flight(now, turn - turned);
            };
            turned += flown;
            let cam_velocity = self.cam.lift(landing.cam_angle).slope * self.omega;
            let velocity_before = landing.state.velocity;
            let bounce = self.restitution * (cam_velocity - velocity_before);
            let sticks = bounce < STICKS_BELOW;
            let velocity_after = cam_velocity + if sticks { 0.0 } else { bounce };
            let state = State { velocity: velocity_after, ..self.on_cam(landing.cam_angle).state };
            now = Place { state, ..landing };
            let cam_angle = now.cam_angle;
            let kind = if sticks { Kind::Stick } else { Kind::Impact };
            observe(&Event { kind, turned, cam_angle, velocity_before, velocity_after });
            if sticks {
                let (carried, released) = self.carry(cam_angle, turn - turned);
                turned += carried;
                now = self.on_cam(advance(cam_angle, carried));
                if !released {
                    return now;
                }
                let velocity = now.state.velocity;
                let (velocity_before, velocity_after) = (velocity, velocity);
                let cam_angle = now.cam_angle;
                observe(&Event { kind: Kind::Release, turned, cam_angle, velocity_before, velocity_after });
            }
        }
    }

    /// The angle flown to the first contact, and the follower there; none within `turn`.
    fn fly(&self, from: Place, turn: f64) -> Option<(f64, Place)> {
        let gap = |turned: f64| {
            let (sin, cos) = (self.omega0 * turned / self.omega).sin_cos();
            let offset = from.state.position - self.equilibrium;
            let position = self.equilibrium + offset * cos + from.state.velocity / self.omega0 * sin;
            position - self.height(advance(from.cam_angle, turned))
        };
        let flown = first_negative(turn, gap)?;
        Some((flown, self.after_flight(from, flown)))
    }

    /// The angle that the cam carries the follower, at most `turn`, and whether it then lets go.
    fn carry(&self, from: f64, turn: f64) -> (f64, bool) {
        // Contact force over mass: c'' omega^2 + w0^2 (c - q*).
        let force = |turned: f64| {
            let lift = self.cam.lift(advance(from, turned));
            lift.curvature * self.omega * self.omega + self.omega0 * self.omega0 * (lift.value - self.equilibrium)
        };
        if force(0.0) < 0.0 {
            return (0.0, true);
        }
        first_negative(turn, force).map_or((turn, false), |carried| (carried, true))
    }

    /// c, m: the scan needs no derivative, and computes none.
    fn height(&self, cam_angle: f64) -> f64 {
        match &self.cam.segments()[self.cam.segment_at(cam_angle)].law {
            Law::Dwell(height) => *height,
            Law::Arc(arc) => {
                let (sin, cos) = (cam_angle - arc.direction).sin_cos();
                let across = arc.distance * sin;
                arc.distance * cos + (arc.radius * arc.radius - across * across).sqrt()
            }
            other => other.lift(cam_angle).value,
        }
    }

    fn on_cam(&self, cam_angle: f64) -> Place {
        let lift = self.cam.lift(cam_angle);
        Place { cam_angle, state: State { position: lift.value, velocity: lift.slope * self.omega } }
    }

    fn after_flight(&self, from: Place, turned: f64) -> Place {
        let (sin, cos) = (self.omega0 * turned / self.omega).sin_cos();
        let offset = from.state.position - self.equilibrium;
        let state = State {
            position: self.equilibrium + offset * cos + from.state.velocity / self.omega0 * sin,
            velocity: from.state.velocity * cos - self.omega0 * offset * sin,
        };
        Place { cam_angle: advance(from.cam_angle, turned), state }
    }
}

/// Scan and bisect: where `value` first turns negative on the grid of `(0, turn]`.
fn first_negative(turn: f64, value: impl Fn(f64) -> f64) -> Option<f64> {
    let step = TAU / f64::from(STEPS);
    let mut low = 0.0;
    for k in 1_u32.. {
        let mut high = (f64::from(k) * step).min(turn);
        if value(high) < 0.0 {
            while high - low > BISECT_TO {
                let middle = 0.5 * (low + high);
                if middle <= low || middle >= high {
                    break;
                }
                if value(middle) < 0.0 { high = middle } else { low = middle }
            }
            return Some(low);
        }
        if high >= turn {
            return None;
        }
        low = high;
    }
    None
}

/// A cam angle turned on, in `[0, 2 pi)`.
fn advance(angle: f64, turned: f64) -> f64 {
    let mut angle = angle + turned;
    while angle >= TAU {
        angle -= TAU;
    }
    angle
}
