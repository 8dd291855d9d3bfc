//! Effect of a rounded corner: the shift of the end of a nonsmooth fold.
//!
//! No cam has a corner to the last digit. Let the lift around it, over an angle epsilon, be the polynomial of fifth degree that
//! meets both laws with their slopes and curvatures; its acceleration goes from one to the other as J phi(sigma), sigma from -1 to 1:
//!
//! ```text
//! phi(sigma) = 1/2 + (9 sigma - 5 sigma^3)/8,   Phi(sigma) = sigma/2 + (3 + 18 sigma^2 - 5 sigma^4)/32,   Phi' = phi
//! ```
//!
//! To first order in epsilon, A at an impact there is A- + phi (A+ - A-), and det(I - A) is linear in phi. With the gap
//! g = e dx + f dT of the fixed point from the border, G = (c' - v) epsilon/(2 omega) that at the polynomial's end and beta of the
//! classification,
//!
//! ```text
//! beta dT = det(I - A-) g + (det(I - A+) - det(I - A-)) G Phi(g/G),
//! ```
//!
//! so that where the determinants have opposite signs two fixed points meet smoothly where det(I - A) vanishes,
//! phi = det(I - A-)/(det(I - A-) - det(I - A+)), at a dT that grows as epsilon.

use std::convert::Infallible;

use super::feigin::{Classification, Scenario};
use crate::bracket::{Width, halve};
use crate::corner::CornerImpact;
use crate::tolerance;

/// Effect of rounding the corner on a nonsmooth fold.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct RoundedCorner {
    /// Shift of the speed at which the fixed points meet, rpm for each degree over which the corner is rounded.
    pub rpm_per_degree: f64,
    /// Angle of rounding at which that shift is [`tolerance::ROUNDED_AWAY`], degrees.
    pub degrees: f64,
}

document!(RoundedCorner as it {
    fold_moves_rpm_per_degree: it.rpm_per_degree,
    degrees_at_most: it.degrees,
    for_rpm: tolerance::ROUNDED_AWAY.value,
});

/// Effect to first order in the angle, for a corner impact that is a nonsmooth fold; none for another.
#[doc(hidden)]
pub fn rounded(kind: &Classification, at: &CornerImpact) -> Option<RoundedCorner> {
    if kind.scenario != Scenario::NonsmoothFold {
        return None;
    }
    let (minus, plus) = (kind.minus.determinant, kind.plus.determinant);
    let part = minus / (minus - plus);
    let blend = |sigma: f64| 0.5 + (9.0 * sigma - 5.0 * sigma.powi(3)) / 8.0;
    // phi rises between its extremes, from below 0 to above 1: there alone it takes a value between.
    let extreme = 0.6_f64.sqrt();
    let Ok([sigma, _]) = halve([-extreme, extreme], Width::Absolute(tolerance::ROOT_WIDTH.value), |sigma| {
        Ok::<_, Infallible>(blend(sigma) > part)
    });
    let risen = sigma / 2.0 + (3.0 + 18.0 * sigma.powi(2) - 5.0 * sigma.powi(4)) / 32.0;
    // beta = (e x + f) det(I - A-) at the fixed point x of dT = 1
    let (e, f) = kind.border;
    let beta = ((e * kind.minus.fixed_point)[0] + f) * minus;
    let gap_per_radian = (at.cam_velocity - at.velocity_before) / (2.0 * at.angular_velocity());
    let period_per_radian = (minus * sigma + (plus - minus) * risen) * gap_per_radian / beta;
    // d(60/T) = -60/T^2 dT
    let rpm_per_degree = (-60.0 / at.period.powi(2) * period_per_radian).to_radians();
    Some(RoundedCorner { rpm_per_degree, degrees: tolerance::ROUNDED_AWAY.value / rpm_per_degree.abs() })
}
