//! Polynomial lift: the `polynomial` law, the polynomial motions, and the pieces of a spline.

use super::jet::Jet;
use super::lift::Lift;
use crate::interval::Number;
use crate::model::MOST_COEFFICIENTS;
use crate::tolerance;

/// `c = sum a_k u^k`, `u = theta - start`.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub struct Polynomial {
    start: f64,
    coefficients: Box<[f64]>,
}

impl Polynomial {
    /// Polynomial from the angle where `u` is 0, rad, and `a_k`, k from 0; powers above the 31st are dropped.
    pub fn new(start: f64, coefficients: &[f64]) -> Self {
        let kept = coefficients.len().min(MOST_COEFFICIENTS);
        Self { start, coefficients: coefficients[..kept].into() }
    }

    /// Returns a copy with these derivatives, from order 0 on, added where `u` is 0.
    pub(super) fn plus(&self, derivatives: &[f64]) -> Self {
        let mut coefficients = self.coefficients.to_vec();
        let mut factorial = 1.0;
        for (n, derivative) in derivatives.iter().enumerate() {
            factorial *= n.max(1) as f64;
            if n < coefficients.len() {
                coefficients[n] += derivative / factorial;
            } else {
                coefficients.push(derivative / factorial);
            }
        }
        let kept = coefficients.iter().rposition(|a| *a != 0.0).map_or(0, |last| last + 1);
        Self::new(self.start, &coefficients[..kept])
    }

    pub(super) fn times(&self, ratio: f64) -> Self {
        Self { start: self.start, coefficients: self.coefficients.iter().map(|a| ratio * a).collect() }
    }

    pub(super) fn turned(&self, turn: f64) -> Self {
        Self { start: self.start + turn, coefficients: self.coefficients.clone() }
    }

    /// Lift and derivatives at `angle`, rad.
    #[inline]
    pub fn lift<N: Number>(&self, angle: N) -> Lift<N> {
        let u = angle - self.start;
        // Horner's scheme, differentiated: the Taylor coefficients c, c', c''/2, c'''/6.
        let [mut value, mut slope, mut half, mut sixth] = [N::from(0.0); 4];
        for a in self.coefficients.iter().rev() {
            sixth = sixth * u + half;
            half = half * u + slope;
            slope = slope * u + value;
            value = value * u + *a;
        }
        Lift { value, slope, curvature: half * 2.0, third: sixth * 6.0 }
    }

    /// `c(from + turn) - c(from)`, m, exact as `turn` goes to 0.
    #[inline]
    pub fn rise(&self, from: f64, turn: f64) -> f64 {
        let x = from - self.start;
        let y = x + turn;
        // Horner's scheme at x, and for the divided difference: p = a + x p1 gives p[x, y] = p1(x) + y p1[x, y].
        let (mut value, mut difference) = (0.0, 0.0);
        for a in self.coefficients.iter().rev() {
            difference = difference * y + value;
            value = value * x + a;
        }
        turn * difference
    }

    /// Bound on `|c'''|` over `[start, end]`: its Taylor sum about the middle, with every term at its largest.
    #[inline]
    pub fn third_bound(&self, start: f64, end: f64) -> f64 {
        self.high_bound::<3>(start, end)
    }

    /// Bound on `|c''''|` over `[start, end]`, by the same sum.
    pub fn fourth_bound(&self, start: f64, end: f64) -> f64 {
        self.high_bound::<4>(start, end)
    }

    #[inline]
    fn high_bound<const ORDER: usize>(&self, start: f64, end: f64) -> f64 {
        let Some(above) = self.coefficients.get(ORDER..) else { return 0.0 };
        // Measured from the start of the polynomial first: the piece of a spline is short and far from 0.
        let (low, high) = (start - self.start, end - self.start);
        let (middle, reach) = (0.5 * (low + high), 0.5 * (high - low));
        // The n-th derivative is sum (k+1)(k+2)...(k+n) a_{k+n} u^k
        let mut derivative = [0.0; MOST_COEFFICIENTS];
        let count = above.len();
        for (k, (slot, a)) in derivative.iter_mut().zip(above).enumerate() {
            *slot = (1..=ORDER).map(|next| (k + next) as f64).product::<f64>() * a;
        }
        let largest = |terms: &[f64], u: f64| terms.iter().rev().fold(0.0, |sum, term| sum * u + term.abs());
        // Size of the terms, which sets the rounding of the sum: terms far from the start may cancel.
        let terms = largest(&derivative[..count], middle.abs() + reach);
        shift(&mut derivative[..count], middle);
        largest(&derivative[..count], reach) + tolerance::JET_ROUNDING.value * terms
    }

    /// Lift and high derivatives at `angle`, rad.
    pub fn jet(&self, angle: f64) -> Jet {
        self.shifted(angle - self.start, |a| a)
    }

    /// Sizes of the terms whose sum is each derivative; its rounding is relative to them.
    pub(super) fn terms(&self, angle: f64) -> Jet {
        self.shifted((angle - self.start).abs(), f64::abs)
    }

    fn shifted(&self, u: f64, of: fn(f64) -> f64) -> Jet {
        let mut shifted = [0.0; MOST_COEFFICIENTS];
        let count = self.coefficients.len();
        for (slot, a) in shifted.iter_mut().zip(self.coefficients.iter()) {
            *slot = of(*a);
        }
        shift(&mut shifted[..count], u);
        let mut series = [0.0; Jet::ORDERS];
        for (slot, coefficient) in series.iter_mut().zip(shifted) {
            *slot = coefficient;
        }
        Jet::from_series(series)
    }
}

/// Converts coefficients about 0 to coefficients about `u`, by repeated division by `x - u`.
fn shift(coefficients: &mut [f64], u: f64) {
    let count = coefficients.len();
    for low in 0..count.saturating_sub(1) {
        for k in (low..count - 1).rev() {
            coefficients[k] += u * coefficients[k + 1];
        }
    }
}
