//! A circle seen from the cam's axis: the law of the base, flank and nose of Appendix A.

use std::f64::consts::FRAC_PI_2;

use super::jet::Jet;
use super::lift::Lift;
use super::series::square_root;
use crate::elementary;
use crate::interval::Number;
use crate::tolerance;

/// A circle whose centre lies at polar `(distance, direction)` from the cam's axis, met by the ray at angle theta:
/// `c = kappa cos(phi) + sqrt(rho^2 - kappa^2 sin^2(phi))`, `phi = theta - direction`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct Arc {
    /// kappa, m.
    pub distance: f64,
    /// Direction of the centre, rad.
    pub direction: f64,
    /// rho, m.
    pub radius: f64,
}

impl Arc {
    /// `w^2 = rho^2 - kappa^2 sin^2(phi)`, factored so that a ray near tangency keeps its digits.
    fn root_squared<N: Number>(&self, sin: N) -> N {
        (-(sin * self.distance) + self.radius) * (sin * self.distance + self.radius)
    }

    /// Lift and derivatives at `angle`, rad; NaN if the ray misses the circle.
    #[inline]
    pub fn lift<N: Number>(&self, angle: N) -> Lift<N> {
        let (sin, cos) = (angle - self.direction).sin_cos();
        self.lift_by(sin, cos, self.root_squared(sin).sqrt())
    }

    /// Lift and derivatives from the sine and cosine of phi, and w.
    #[inline]
    fn lift_by<N: Number>(&self, sin: N, cos: N, w: N) -> Lift<N> {
        let kappa = N::from(self.distance);
        // u = w^2 = rho^2 - kappa^2 sin^2 phi, u' = -kappa^2 sin 2 phi, u'' = -2 kappa^2 cos 2 phi, u''' = -4 u'
        let u1 = -kappa * kappa * 2.0 * sin * cos;
        let u2 = kappa * -2.0 * kappa * (cos - sin) * (cos + sin);
        let u3 = u1 * -4.0;
        let half = N::from(0.5) / w;
        // u' = 2 w w' gives w' = u'/(2 w), w'' = (u'' - 2 w'^2)/(2 w), w''' = (u''' - 6 w' w'')/(2 w)
        let w1 = u1 * half;
        let w2 = (u2 - w1 * 2.0 * w1) * half;
        let w3 = (u3 - w1 * 6.0 * w2) * half;
        // c = kappa cos phi + w
        Lift { value: kappa * cos + w, slope: -kappa * sin + w1, curvature: -kappa * cos + w2, third: kappa * sin + w3 }
    }

    /// `c(from + turn) - c(from)`, m, exact as `turn` goes to 0.
    #[inline]
    pub fn rise(&self, from: f64, turn: f64) -> f64 {
        self.climb(from, turn).0
    }

    /// Returns [`Arc::rise`] and the lift at the end of the turn.
    #[inline]
    pub fn climb(&self, from: f64, turn: f64) -> (f64, Lift) {
        let half = 0.5 * turn;
        let kappa = self.distance;
        let (half_sin, half_cos) = elementary::sin_cos(half);
        let (sin, cos) = elementary::sin_cos(from - self.direction + half);
        // cos(phi + d) - cos phi = -2 sin(phi + d/2) sin(d/2)
        let shift = -2.0 * kappa * sin * half_sin;
        // w1 - w0 = (u1 - u0)/(w1 + w0),  u1 - u0 = -kappa^2 sin(2 phi + d) sin d
        let difference = -4.0 * kappa * kappa * sin * cos * half_sin * half_cos;
        // sin and cos of phi + d/2 -+ d/2
        let (along, across) = (sin * half_cos, cos * half_sin);
        let (before, after) = (along - across, along + across);
        let (w0, w1) = (self.root_squared(before).sqrt(), self.root_squared(after).sqrt());
        let after_cos = cos * half_cos - sin * half_sin;
        (shift + difference / (w0 + w1), self.lift_by(after, after_cos, w1))
    }

    /// Bound on `|c'''|` over `[start, end]`: the smaller of its terms at their largest and its value in the middle extended by `|c''''|`.
    #[inline]
    pub fn third_bound(&self, start: f64, end: f64) -> f64 {
        self.high_bounds(start, end)[0]
    }

    /// Bound on `|c''''|` over `[start, end]`: its terms at their largest.
    pub fn fourth_bound(&self, start: f64, end: f64) -> f64 {
        self.high_bounds(start, end)[1]
    }

    /// Bounds on the third and the fourth derivative.
    #[inline]
    fn high_bounds(&self, start: f64, end: f64) -> [f64; 2] {
        let (middle, reach) = (0.5 * (start + end), 0.5 * (end - start));
        let (sin, cos) = elementary::sin_cos(middle - self.direction);
        let turn = elementary::sin_cos(reach);
        let kappa = self.distance.abs();
        let largest = largest_sine((sin, cos), turn, reach);
        // The smallest w decides whether the ray meets the circle over the whole range.
        let w = self.root_squared(largest).sqrt();
        if !(w > 0.0) {
            return [f64::INFINITY; 2];
        }
        let twice = |(sin, cos): (f64, f64)| (2.0 * sin * cos, (cos - sin) * (cos + sin));
        let (double_sin, double_cos) = twice((sin, cos));
        let square = kappa * kappa;
        let u1 = square * largest_sine((double_sin, double_cos), twice(turn), 2.0 * reach);
        // |cos 2 phi| = |sin(2 phi + pi/2)|
        let u2 = 2.0 * square * largest_sine((double_cos, -double_sin), twice(turn), 2.0 * reach);
        let half = 0.5 / w;
        let w1 = u1 * half;
        let w2 = (u2 + 2.0 * w1 * w1) * half;
        let w3 = (4.0 * u1 + 6.0 * w1 * w2) * half;
        // w'''' = (u'''' - 8 w' w''' - 6 w''^2)/(2 w),  u'''' = -4 u''
        let w4 = (4.0 * u2 + 8.0 * w1 * w3 + 6.0 * w2 * w2) * half;
        let everywhere = kappa * largest + w3;
        let from_middle = self.lift(middle).third.abs() + reach * (kappa + w4);
        // Rounding of a dozen operations and of the angle. `f64::min` is not used above: it would accept a bound where one value is NaN.
        let rounding = tolerance::JET_ROUNDING.value * (everywhere + kappa + w4);
        let third = if from_middle < everywhere { from_middle } else { everywhere };
        [third + rounding, kappa + w4 + rounding]
    }

    /// Lift and high derivatives at `angle`, rad.
    pub fn jet(&self, angle: f64) -> Jet {
        let (sin, cos) = elementary::sin_cos(angle - self.direction);
        let kappa = self.distance;
        // c = kappa cos(phi + t) + w,  w^2 = rho^2 - kappa^2/2 + kappa^2/2 cos(2 phi + 2 t)
        let half_square = 0.5 * kappa * kappa;
        let (double_sin, double_cos) = (2.0 * sin * cos, (cos - sin) * (cos + sin));
        let mut squared = Jet::of_sinusoid(-half_square * double_sin, half_square * double_cos, 2.0).series();
        squared[0] = self.root_squared(sin);
        Jet::of_sinusoid(-kappa * sin, kappa * cos, 1.0).plus(&Jet::from_series(square_root(squared)))
    }
}

/// Largest `|sin|` within `reach` of an angle; both are given by sine and cosine.
#[inline]
fn largest_sine((sin, cos): (f64, f64), (sin_reach, cos_reach): (f64, f64), reach: f64) -> f64 {
    let (sin, cos) = (sin.abs(), cos.abs());
    // |sin| is 1 within reach where cos(|x| + reach) <= 0; else it is largest at the far end, sin(|x| + reach).
    if reach >= FRAC_PI_2 || cos * cos_reach <= sin * sin_reach { 1.0 } else { sin * cos_reach + cos * sin_reach }
}
