//! Periodic orbits with an impact on a corner: the paper's, with one impact in one revolution, and orbits with any number of both.

use std::f64::consts::TAU;

use nalgebra::Vector2;
use serde::Serialize;

use super::map::Sides;
use crate::cam::{Corner, Lift, Side, apart};
use crate::flight::State;
use crate::model::Follower;
use crate::orbit::{Cycle, Impact};
use crate::simulate::Machine;
use crate::tolerance;

/// Method by which a corner impact was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[doc(hidden)]
pub enum Way {
    /// Root of the equation for one impact.
    Equation,
    /// Branch of orbits that passes the corner.
    Branch,
    /// Shot from the corner.
    Shot,
}

/// Periodic orbit with an impact on a corner of the cam.
#[derive(Clone, Debug, PartialEq)]
pub struct CornerImpact {
    /// Corner that the follower hits.
    pub corner: Corner,
    /// T*, s: one revolution of the cam.
    pub period: f64,
    /// Bracket of T*, s: two neighbouring doubles, or nearly.
    pub bracket: [f64; 2],
    /// Left side of the equation for T*, relative to the sum of its terms' sizes. With several impacts, the angle between the impact and
    /// the corner, rad.
    pub residual: f64,
    /// v- at the corner, m/s.
    pub velocity_before: f64,
    /// v+ at the corner, m/s.
    pub velocity_after: f64,
    /// c' at the corner, m/s.
    pub cam_velocity: f64,
    /// State on the section, in the cam's coordinates.
    pub state: State,
    /// Origin of the paper's x, m: the spring's equilibrium, or the position of the slack spring without stiffness.
    pub origin: f64,
    /// Distance from start to end of one simulated period, relative to the orbit's size. With several impacts, or at a corner of velocity,
    /// the residual of the closing equations.
    pub closure: f64,
    /// Impacts of the orbit.
    pub cycle: Cycle,
    /// Index of the impact on the corner.
    pub impact: usize,
    /// Side whose law the impact obeys: at a corner of velocity the orbits of the two sides differ.
    pub side: Side,
    /// Methods that found it: one, or two independent ones.
    pub ways: Vec<Way>,
}

impl CornerImpact {
    /// omega*, rpm.
    pub fn speed_rpm(&self) -> f64 {
        60.0 / self.period
    }

    /// omega*, rad/s.
    pub fn angular_velocity(&self) -> f64 {
        TAU / self.period
    }

    /// c'' before and after the corner, m/s^2.
    pub fn cam_acceleration(&self) -> Sides<f64> {
        Sides::of_each(|side| self.corner.lift(side).curvature * self.angular_velocity().powi(2))
    }

    /// Whether both are at the same corner, up to a small shift: a corner found in the rows of a table moves a little when the rows are
    /// replaced by others.
    #[doc(hidden)]
    pub fn is_near(&self, other: &Self) -> bool {
        apart(self.corner.angle, other.corner.angle) <= tolerance::NEIGHBOURING.value
    }

    /// Whether it is of the paper's kind: one impact in one revolution, at a corner of acceleration or a smoother one.
    pub fn is_simple(&self) -> bool {
        self.cycle.revolutions == 1 && self.cycle.impacts.len() == 1 && self.corner.jump_order > 1
    }

    /// Stroboscopic section, rad: the middle of the longest flight, with no impact nearby. With one impact it is half a period from the
    /// corner.
    pub fn section_angle(&self) -> f64 {
        let (index, turn) = longest_flight(&self.cycle);
        (self.cycle.impacts[index].cam_angle + 0.5 * turn) % TAU
    }

    /// Course of one period from the section: the angle of each flight, rad, with the index of the impact at its end, in order.
    /// The angle of the last flight, rad, which ends on the section, follows.
    pub fn course(&self) -> (Vec<(f64, usize)>, f64) {
        let (last, turn) = longest_flight(&self.cycle);
        let count = self.cycle.impacts.len();
        let flight = |later: usize| {
            let index = (last + 1 + later) % count;
            (if later == 0 { 0.5 * turn } else { self.cycle.turn((last + later) % count) }, index)
        };
        ((0..count).map(flight).collect(), 0.5 * turn)
    }

    /// State x* of the paper on the section: position from the equilibrium, and velocity.
    pub fn x_star(&self) -> Vector2<f64> {
        Vector2::new(self.state.position - self.origin, self.state.velocity)
    }

    /// Lift at an impact; at the corner, on `side`.
    pub fn lift(&self, machine: &Machine, impact: usize, side: Side) -> Lift {
        if impact == self.impact {
            return self.corner.lift(side);
        }
        let Impact { segment, cam_angle, .. } = self.cycle.impacts[impact];
        machine.cam().segments()[segment].law.lift(cam_angle)
    }
}

/// Longest flight of a cycle: the impact at its start, and its angle, rad.
fn longest_flight(cycle: &Cycle) -> (usize, f64) {
    let flights = (0..cycle.impacts.len()).map(|index| (index, cycle.turn(index)));
    flights.fold((0, f64::NEG_INFINITY), |longest, flight| if flight.1 > longest.1 { flight } else { longest })
}

/// State of a cycle in the middle of its longest flight.
pub fn at_section(machine: &Machine, cycle: &Cycle, period: f64) -> State {
    let (index, turn) = longest_flight(cycle);
    let (leaving, _) = cycle.flight(machine, index);
    machine.flight().fly(leaving, 0.5 * (turn / TAU) * period).1
}

/// Origin of the paper's x, m: the equilibrium `rest - g/w0^2`, or the position of the slack spring without stiffness.
pub fn origin(follower: &Follower) -> f64 {
    if follower.stiffness > 0.0 {
        follower.rest_position - follower.mass * follower.gravity / follower.stiffness
    } else {
        follower.rest_position
    }
}
