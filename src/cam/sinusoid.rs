//! Sine on a straight line: harmonic, cycloidal and modified motions, and the rectified sine.

use super::jet::Jet;
use super::lift::Lift;
use crate::elementary;
use crate::interval::Number;
use crate::tolerance;

/// `c = value + tilt u + sine (phi - sin phi) + cosine (1 - cos phi)`, `phi = frequency u`, `u = theta - start`.
///
/// Remainders of sine and cosine near phi = 0 keep the digits of motions that start there at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct Sinusoid {
    /// Angle where `u` is 0, rad; may lie outside the segment.
    pub start: f64,
    /// Lift at `start`, m.
    pub value: f64,
    /// Slope at `start`, m/rad.
    pub tilt: f64,
    /// Coefficient of `phi - sin phi`, m.
    pub sine: f64,
    /// Coefficient of `1 - cos phi`, m.
    pub cosine: f64,
    /// dphi/dtheta.
    pub frequency: f64,
}

impl Sinusoid {
    /// `sin phi`, `cos phi` and `1 - cos phi`.
    #[inline]
    fn circular<N: Number>(phi: N) -> (N, N, N) {
        let (sin, cos) = (phi * 0.5).sin_cos();
        // sin phi = 2 s c, 1 - cos phi = 2 s^2
        let versine = sin * 2.0 * sin;
        (sin * 2.0 * cos, -versine + 1.0, versine)
    }

    /// Lift and derivatives at `angle`, rad.
    #[inline]
    pub fn lift<N: Number>(&self, angle: N) -> Lift<N> {
        let Self { start, value, tilt, sine, cosine, frequency } = *self;
        let (u, w) = (angle - start, N::from(frequency));
        let phi = u * frequency;
        let (sin, cos, versine) = Self::circular(phi);
        let squared = w * w;
        Lift {
            value: u * tilt + value + (phi - sin) * sine + versine * cosine,
            // c' = tilt + w (A (1 - cos phi) + B sin phi)
            slope: w * (versine * sine + sin * cosine) + tilt,
            // c'' = w^2 (A sin phi + B cos phi)
            curvature: squared * (sin * sine + cos * cosine),
            // c''' = w^3 (A cos phi - B sin phi)
            third: squared * w * (cos * sine - sin * cosine),
        }
    }

    /// `c(from + turn) - c(from)`, m, exact as `turn` goes to 0.
    #[inline]
    pub fn rise(&self, from: f64, turn: f64) -> f64 {
        let Self { start, tilt, sine, cosine, frequency, .. } = *self;
        let (sin, cos, versine) = Self::circular(frequency * (from - start));
        let delta = frequency * turn;
        let (sin_delta, _, versine_delta) = Self::circular(delta);
        // phi - sin phi grows by d (1 - cos phi) + (d - sin d) cos phi + (1 - cos d) sin phi
        let of_sine = delta * versine + sine_deficit(delta, sin_delta) * cos + versine_delta * sin;
        // 1 - cos phi grows by sin d sin phi + (1 - cos d) cos phi
        let of_cosine = sin_delta * sin + versine_delta * cos;
        tilt * turn + sine * of_sine + cosine * of_cosine
    }

    /// Bound on `|c'''|` over `[start, end]`: `w^3 |(A, B)|`, or from the middle by `w^4 |(A, B)|` if that is less.
    #[inline]
    pub fn third_bound(&self, start: f64, end: f64) -> f64 {
        let frequency = self.frequency.abs();
        let everywhere = frequency.powi(3) * elementary::hypot(self.sine, self.cosine);
        let from_middle = self.lift(0.5 * (start + end)).third.abs() + 0.5 * (end - start) * frequency * everywhere;
        // Rounding of the phase and of the sum.
        let rounding = tolerance::JET_ROUNDING.value * (1.0 + frequency) * everywhere;
        everywhere.min(from_middle) + rounding
    }

    /// A bound on `|c''''|` anywhere: `w^4 |(A, B)|`.
    pub fn fourth_bound(&self, _start: f64, _end: f64) -> f64 {
        self.frequency.powi(4) * elementary::hypot(self.sine, self.cosine) * (1.0 + tolerance::JET_ROUNDING.value)
    }

    /// Lift and high derivatives at `angle`, rad.
    pub fn jet(&self, angle: f64) -> Jet {
        let Self { sine, cosine, frequency, .. } = *self;
        let (sin, cos, _) = Self::circular(frequency * (angle - self.start));
        // -A sin phi - B cos phi. Orders 0 and 1 also include the straight line, which `lift` adds without cancellation.
        let mut jet = Jet::of_sinusoid(cosine * sin - sine * cos, -(sine * sin + cosine * cos), frequency);
        let lift = self.lift(angle);
        (jet.0[0], jet.0[1]) = (lift.value, lift.slope);
        jet
    }
}

/// Returns `d - sin d`, by its series where the difference would cancel.
#[inline]
fn sine_deficit(delta: f64, sin: f64) -> f64 {
    if delta.abs() > 1.0 {
        return delta - sin;
    }
    let square = delta * delta;
    // d^3/6 (1 - d^2/20 (1 - d^2/42 (1 - ...))): the ninth factor is below an ulp.
    const SERIES: [f64; 7] = [1.0 / 272.0, 1.0 / 210.0, 1.0 / 156.0, 1.0 / 110.0, 1.0 / 72.0, 1.0 / 42.0, 1.0 / 20.0];
    let sum = SERIES.iter().fold(1.0, |sum, factor| 1.0 - square * factor * sum);
    square * delta * (1.0 / 6.0) * sum
}
