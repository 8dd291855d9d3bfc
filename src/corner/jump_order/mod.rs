//! Order of the derivative that jumps at a corner, and its effect on the map of a flight that hits the cam there.
//!
//! J is the jump of the lift's j-th derivative in time, u = c' - v the velocity of approach, and s the time of the impact from the corner.
//! The states after an impact under the laws after and before the corner, both carried to the corner's moment, differ by
//!
//! ```text
//! velocity    (1+r) J s^(j-1)/(j-1)!            position    -(1+r) J (j-1) s^j/j!
//! ```
//!
//! to leading order. The map has a gap for j = 1, is continuous and piecewise linear for j = 2, and has a continuous derivative and a jump
//! in its second one for j = 3. [`mod@predicted`] has the formulas, which `derivations/jump_order.py` proves. [`mod@measured`] finds
//! exponents and coefficients by simulation, without these formulas. [`mod@compared`] compares the two.

pub mod compared;
pub mod measured;
pub mod predicted;

use std::f64::consts::TAU;

use super::locate::CornerImpact;
use super::one_sided::SampleError;
use crate::cam::Corner;
use crate::simulate::SimulateError;

/// Flight that comes from above and hits the cam on a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// Corner that is hit.
    pub corner: Corner,
    /// Speed omega, rad/s.
    pub angular_velocity: f64,
    /// Velocity v- before the impact, m/s.
    pub velocity_before: f64,
}

impl Approach {
    /// A flight that arrives on `corner` at `velocity_before`, m/s, over a cam that turns at `angular_velocity`, rad/s.
    ///
    /// Returns an error unless the flight comes from above: `u- = c'- - v-` must be above 0.
    pub fn new(corner: Corner, angular_velocity: f64, velocity_before: f64) -> Result<Self, JumpOrderError> {
        let approach = Self { corner, angular_velocity, velocity_before };
        let closing = approach.closing_velocity();
        if closing > 0.0 && closing.is_finite() && angular_velocity > 0.0 && angular_velocity.is_finite() {
            Ok(approach)
        } else {
            Err(JumpOrderError::NotFromAbove { closing, angular_velocity, cam_angle: corner.angle })
        }
    }

    /// Approach of a located orbit.
    pub fn of(at: &CornerImpact) -> Result<Self, JumpOrderError> {
        Self::new(at.corner, TAU / at.period, at.velocity_before)
    }

    /// Closing velocity u- = c'- - v-, m/s, with the cam's velocity before the corner.
    pub fn closing_velocity(&self) -> f64 {
        self.angular_velocity * self.corner.minus.slope - self.velocity_before
    }
}

/// Reason why nothing can be predicted or measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the message says what each number is")]
pub enum JumpOrderError {
    /// Follower that does not fall onto the corner.
    #[error(
        "jump order: at {angular_velocity} rad/s the follower closes on the corner at {cam_angle} rad at {closing} in the model's units; it must come in from above"
    )]
    NotFromAbove { closing: f64, angular_velocity: f64, cam_angle: f64 },
    /// Corner without surroundings free of other events.
    #[error(
        "jump order: within {least} rad of the corner at {cam_angle} rad a flight that hits it has impacts elsewhere, or sticks"
    )]
    NotFree { cam_angle: f64, least: f64 },
    /// Too few differences that exceed rounding.
    #[error("jump order: {resolved} of {tried} differences exceed rounding, but a fit needs {needed}")]
    Unresolved { resolved: usize, tried: usize, needed: usize },
    /// Side that could not be sampled.
    #[error("jump order: {0}")]
    Sample(#[from] SampleError),
    /// Failure of the simulator.
    #[error("jump order: {0}")]
    Simulate(#[from] SimulateError),
}
