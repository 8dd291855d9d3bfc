//! Effect of a rounded corner: the shift of a nonsmooth fold.
//!
//! No real cam has a perfectly sharp corner. Over an angle epsilon around it, let the lift be the polynomial of fifth degree that meets
//! both laws with their slopes and curvatures. Its acceleration changes from one law to the other as J phi(sigma), sigma from -1 to 1:
//!
//! ```text
//! phi(sigma) = 1/2 + (9 sigma - 5 sigma^3)/8,   Phi(sigma) = sigma/2 + (3 + 18 sigma^2 - 5 sigma^4)/32,   Phi' = phi
//! ```
//!
//! To first order in epsilon, A at an impact there is A- + phi (A+ - A-), and det(I - A) is linear in phi. Let g = e dx + f dT be the gap
//! of the fixed point from the border, and G = (c' - v) epsilon/(2 omega) its value at the polynomial's end. With beta of the
//! classification,
//!
//! ```text
//! beta dT = det(I - A-) g + (det(I - A+) - det(I - A-)) G Phi(g/G),
//! ```
//!
//! Therefore, if the determinants have opposite signs, two fixed points meet smoothly where det(I - A) vanishes, at phi = det(I -
//! A-)/(det(I - A-) - det(I - A+)). The dT of this point grows in proportion to epsilon.

use std::convert::Infallible;

use super::feigin::{Classification, Scenario};
use crate::bracket::{Width, halve};
use crate::corner::CornerImpact;
use crate::tolerance;

/// Effect of rounding the corner on a nonsmooth fold.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct RoundedCorner {
    /// Shift of the speed at which the fixed points meet, rpm per degree of rounding.
    pub rpm_per_degree: f64,
    /// Angle of rounding, degrees, at which the shift is [`tolerance::ROUNDED_AWAY`].
    pub degrees: f64,
}

document!(RoundedCorner as it {
    fold_moves_rpm_per_degree: it.rpm_per_degree,
    degrees_at_most: it.degrees,
    for_rpm: tolerance::ROUNDED_AWAY.value,
});

/// Computes the effect to first order in the angle for a nonsmooth fold; `None` for other scenarios.
#[doc(hidden)]
pub fn rounded(kind: &Classification, at: &CornerImpact) -> Option<RoundedCorner> {
    if kind.scenario != Scenario::NonsmoothFold {
        return None;
    }
    let (minus, plus) = (kind.minus.determinant, kind.plus.determinant);
    let part = minus / (minus - plus);
    let blend = |sigma: f64| 0.5 + (9.0 * sigma - 5.0 * sigma.powi(3)) / 8.0;
    // phi rises between its extremes, from below 0 to above 1: only there does it take a value between 0 and 1.
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
