//! Circle met by a line of motion beside the cam's axis: the law of an offset roller follower.

use super::jet::Jet;
use super::lift::Lift;
use super::series::{product, square_root};
use crate::elementary;
use crate::interval::{Interval, Number};

/// Circle of radius `rho` whose centre lies at polar `(distance, direction)` from the cam's axis, met by a line parallel to the ray at
/// angle theta, at a distance `e` to the left of it:
///
/// ```text
/// c = kappa cos(phi) + w,   w^2 = rho^2 - s^2,   s = kappa sin(phi) + e,   phi = theta - direction
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct OffsetArc {
    /// kappa, m.
    pub distance: f64,
    /// Direction of the centre, rad.
    pub direction: f64,
    /// rho, m.
    pub radius: f64,
    /// e, m.
    pub offset: f64,
}

impl OffsetArc {
    /// `w^2` from s, factored so that a line near tangency keeps its digits.
    fn root_squared<N: Number>(&self, s: N) -> N {
        (-s + self.radius) * (s + self.radius)
    }

    /// Lift `c` and its first four derivatives at `angle`, rad; NaN if the line misses the circle.
    fn derivatives<N: Number>(&self, angle: N) -> [N; 5] {
        let (sin, cos) = (angle - self.direction).sin_cos();
        let (p, q) = (cos * self.distance, sin * self.distance);
        let s = q + self.offset;
        let w = self.root_squared(s).sqrt();
        // u = w^2, s' = p, p' = -q, q' = p
        let u1 = s * p * -2.0;
        let u2 = (s * q - p * p) * 2.0;
        let u3 = p * (q * 3.0 + s) * 2.0;
        let u4 = p * p * 8.0 - q * (q * 3.0 + s) * 2.0;
        let half = N::from(0.5) / w;
        // u' = 2 w w' gives w' = u'/(2 w), w'' = (u'' - 2 w'^2)/(2 w), w''' = (u''' - 6 w' w'')/(2 w),
        // w'''' = (u'''' - 8 w' w''' - 6 w''^2)/(2 w)
        let w1 = u1 * half;
        let w2 = (u2 - w1 * w1 * 2.0) * half;
        let w3 = (u3 - w1 * w2 * 6.0) * half;
        let w4 = (u4 - w1 * w3 * 8.0 - w2 * w2 * 6.0) * half;
        [p + w, w1 - q, w2 - p, q + w3, p + w4]
    }

    /// Lift and derivatives at `angle`, rad; NaN if the line misses the circle.
    pub fn lift<N: Number>(&self, angle: N) -> Lift<N> {
        let [value, slope, curvature, third, _] = self.derivatives(angle);
        Lift { value, slope, curvature, third }
    }

    /// `c(from + turn) - c(from)`, m, exact as `turn` goes to 0.
    pub fn rise(&self, from: f64, turn: f64) -> f64 {
        let (half_sin, half_cos) = elementary::sin_cos(0.5 * turn);
        let (sin, cos) = elementary::sin_cos(from - self.direction + 0.5 * turn);
        let s = |sign: f64| self.distance * (sin * half_cos + sign * cos * half_sin) + self.offset;
        let [before, after] = [s(-1.0), s(1.0)];
        let [w0, w1] = [before, after].map(|s| self.root_squared(s).sqrt());
        // s1 - s0 = 2 kappa cos(phi + d/2) sin(d/2),  w1 - w0 = -(s1 - s0)(s1 + s0)/(w1 + w0)
        let step = 2.0 * self.distance * cos * half_sin;
        -2.0 * self.distance * sin * half_sin - step * (before + after) / (w0 + w1)
    }

    /// A bound on `|c'''|` over `[start, end]`.
    pub fn third_bound(&self, start: f64, end: f64) -> f64 {
        self.bound(3, start, end)
    }

    /// A bound on `|c''''|` over `[start, end]`.
    pub fn fourth_bound(&self, start: f64, end: f64) -> f64 {
        self.bound(4, start, end)
    }

    /// A bound on a derivative over `[start, end]`, from interval arithmetic; infinite where the line may miss the circle.
    fn bound(&self, order: usize, start: f64, end: f64) -> f64 {
        self.derivatives(Interval::new(start, end))[order].magnitude()
    }

    /// Lift and high derivatives at `angle`, rad.
    pub fn jet(&self, angle: f64) -> Jet {
        let (sin, cos) = elementary::sin_cos(angle - self.direction);
        let (p, q) = (self.distance * cos, self.distance * sin);
        let mut s = Jet::of_sinusoid(p, q, 1.0).series();
        s[0] += self.offset;
        // u = rho^2 - s^2
        let mut u = product(&s, &s).map(|it| -it);
        u[0] = self.root_squared(s[0]);
        Jet::of_sinusoid(-q, p, 1.0).plus(&Jet::from_series(square_root(u)))
    }
}
