//! Formulas from the corner's derivatives and the paper's propagator; nothing is simulated.

use std::f64::consts::TAU;

use nalgebra::{RowVector3, Vector2, Vector3};

use super::Approach;
use crate::cam::Lift;
use crate::corner::closed_form::propagator;
use crate::model::Follower;

/// Power law `coefficient * s^exponent`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// Power of s.
    pub exponent: u32,
    /// Coefficient in m or m/s, per power of a second.
    pub coefficient: f64,
}

/// Number of times that flights near the one on the corner hit the cam near it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hits {
    /// One hit, on either side.
    Once,
    /// One hit before the corner, none after it: there the cam falls away faster than the flight descends.
    NeverAfter,
    /// Two hits if the first is before the corner: the cam after it rises faster than the follower rebounds. One hit after it.
    TwiceBefore,
}

/// Difference of the two sides' states after the impact, at the corner's moment, after less before. It is given to leading order in the
/// time s from the corner to the impact under the law before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Difference of the positions, m.
    pub position: PowerLaw,
    /// Difference of the velocities, m/s.
    pub velocity: PowerLaw,
}

/// Jump J of the j-th derivative of the lift in time, m/s^j.
pub fn jump(approach: &Approach) -> f64 {
    approach.corner.jump * approach.angular_velocity.powi(approach.corner.jump_order as i32)
}

/// Number of times that flights near `approach` hit the cam, from the velocities alone.
pub fn hits(follower: &Follower, approach: &Approach) -> Hits {
    let closing = approach.closing_velocity();
    match approach.corner.jump_order {
        1 if jump(approach) <= -closing => Hits::NeverAfter,
        1 if jump(approach) > follower.restitution * closing => Hits::TwiceBefore,
        _ => Hits::Once,
    }
}

/// Difference at the corner's moment, for flights that hit the cam once under the law of either side.
pub fn difference(follower: &Follower, approach: &Approach) -> Difference {
    let order = approach.corner.jump_order as u32;
    let r = follower.restitution;
    let jump = jump(approach);
    let velocity = PowerLaw { exponent: order - 1, coefficient: (1.0 + r) * jump / factorial(order - 1) };
    let position = if order == 1 {
        // -(1+r)/2 (S+ (u-/u+)^2 - S-),  S = c'' + 2 zeta c' + w0^2 q on each side
        let closing = approach.closing_velocity();
        let ratio = closing / (closing + jump);
        let surplus = |lift: &Lift| surplus(follower, approach.angular_velocity, lift);
        let [minus, plus] = [&approach.corner.minus, &approach.corner.plus].map(surplus);
        PowerLaw { exponent: 2, coefficient: -0.5 * (1.0 + r) * (plus * ratio * ratio - minus) }
    } else {
        // -(1+r) J (j-1) s^j/j!
        let coefficient = -(1.0 + r) * jump * f64::from(order - 1) / factorial(order);
        PowerLaw { exponent: order, coefficient }
    };
    Difference { position, velocity }
}

/// Excess S of the cam's acceleration over the follower's at the cam's velocity, m/s^2.
fn surplus(follower: &Follower, omega: f64, lift: &Lift) -> f64 {
    let zeta = follower.damping / (2.0 * follower.mass);
    let spring = follower.stiffness / follower.mass * (lift.value - follower.rest_position) + follower.gravity;
    omega * omega * lift.curvature + 2.0 * zeta * omega * lift.slope + spring
}

fn factorial(n: u32) -> f64 {
    (1..=n).map(f64::from).product()
}

/// Difference of the two sides of a map from a section before the corner to one after it, to leading order:
/// `P+ - P- = step (n z)^(j-1)` for a deviation `z = (dx, dT)` of the state and the period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionJump {
    /// Order j - 1 of the derivative of the map that jumps; 0 is a gap.
    pub exponent: u32,
    /// Vector `(1+r) J/(j-1)! F e2`, m and m/s per power of a second, with the flight F from the corner to the end. For j = 1, J is limited
    /// to the range from `-u-` to `r u-`: beyond it flights miss the cam, or hit it twice.
    pub step: Vector2<f64>,
    /// Gradient n: the time of the impact from the corner per unit of position, velocity and period: s/m, s^2/m, 1. The border is
    /// `n z = 0`.
    pub gradient: RowVector3<f64>,
}

impl SectionJump {
    /// Difference `P+ - P-` at the deviation `z`: m, m/s and s.
    pub fn at(&self, z: Vector3<f64>) -> Vector2<f64> {
        self.step * (self.gradient * z)[0].powi(self.exponent as i32)
    }
}

/// Section jump for flights that start `before` rad before the corner and end `after` rad after it. Half a turn each gives the stroboscopic
/// map: `step n` is `(A+ - A-, B+ - B-)` for j = 2, and `2 step n n` the jump of the second derivatives for j = 3.
pub fn over(follower: &Follower, approach: &Approach, before: f64, after: f64) -> SectionJump {
    let zeta = follower.damping / (2.0 * follower.mass);
    let flight = |turn: f64| {
        let omega0_squared = follower.stiffness / follower.mass;
        propagator(zeta, omega0_squared, turn / approach.angular_velocity)
    };
    let Approach { corner, velocity_before: v, .. } = approach;
    let (exponent, closing) = (corner.jump_order as u32 - 1, approach.closing_velocity());
    let effective = match exponent {
        0 => jump(approach).min(follower.restitution * closing).max(-closing),
        _ => jump(approach),
    };
    let step = flight(after).column(1) * ((1.0 + follower.restitution) * effective / factorial(exponent));
    // n z = (h F dx + v dt)/u,  dt = before/(2 pi) dT
    let incoming = flight(before);
    let gradient = RowVector3::new(incoming[(0, 0)], incoming[(0, 1)], v * before / TAU) / closing;
    SectionJump { exponent, step, gradient }
}
