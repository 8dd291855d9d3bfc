//! Sum of cosines: the `harmonic` law, one smooth segment over the whole turn.

use super::jet::Jet;
use super::lift::Lift;
use crate::elementary;
use crate::interval::Number;
use crate::model::HarmonicProfile;
use crate::tolerance;

/// `c = offset + sum A_k cos(k theta) + B_k sin(k theta)`, k from 1.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub struct Harmonics {
    offset: f64,
    terms: Box<[Term]>,
    /// `sum k^3 |(A_k, B_k)|` and `sum k^4 |(A_k, B_k)|`: bounds on `|c'''|` and `|c''''|` anywhere.
    bounds: [f64; 2],
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Term {
    cosine: f64,
    sine: f64,
}

/// Yields `cos(k x)`, `sin(k x)` for k = 1, 2, ... by rotations by x.
fn multiples<N: Number>(x: N) -> impl Iterator<Item = (N, N)> {
    let (sin, cos) = x.sin_cos();
    let turn = move |&(c, s): &(N, N)| Some((c * cos - s * sin, s * cos + c * sin));
    std::iter::successors(Some((cos, sin)), turn)
}

impl Harmonics {
    /// Sum `offset + sum a_k cos(k theta + p_k)` from its amplitudes and phases.
    pub fn new(profile: &HarmonicProfile) -> Self {
        let of_phase = |(amplitude, phase_deg): (&f64, &f64)| {
            let (sin, cos) = elementary::sin_cos(phase_deg.to_radians());
            // a cos(x + p) = a cos p cos x - a sin p sin x
            Term { cosine: amplitude * cos, sine: -amplitude * sin }
        };
        let terms: Box<[Term]> = profile.amplitudes.iter().zip(&profile.phases_deg).map(of_phase).collect();
        let sum = |power: i32| {
            let term =
                |(k, term): (usize, &Term)| (k as f64 + 1.0).powi(power) * elementary::hypot(term.cosine, term.sine);
            terms.iter().enumerate().map(term).sum()
        };
        let bounds = [sum(3), sum(4)];
        Self { offset: profile.offset, terms, bounds }
    }

    pub(super) fn times(&self, ratio: f64) -> Self {
        let term = |term: &Term| Term { cosine: ratio * term.cosine, sine: ratio * term.sine };
        Self {
            offset: ratio * self.offset,
            terms: self.terms.iter().map(term).collect(),
            bounds: self.bounds.map(|bound| ratio * bound),
        }
    }

    /// Number of the highest harmonic.
    pub(super) fn highest(&self) -> usize {
        self.terms.len()
    }

    /// Lift and derivatives at `angle`, rad.
    #[inline]
    pub fn lift<N: Number>(&self, angle: N) -> Lift<N> {
        let mut lift = Lift::constant(self.offset);
        let mut k = 0.0;
        for (term, (cos, sin)) in self.terms.iter().zip(multiples(angle)) {
            k += 1.0;
            let value = cos * term.cosine + sin * term.sine;
            let slope = (cos * term.sine - sin * term.cosine) * k;
            lift.value = lift.value + value;
            lift.slope = lift.slope + slope;
            lift.curvature = lift.curvature - value * (k * k);
            lift.third = lift.third - slope * (k * k);
        }
        lift
    }

    /// `c(from + turn) - c(from)`, m, exact as `turn` goes to 0.
    #[inline]
    pub fn rise(&self, from: f64, turn: f64) -> f64 {
        let half = 0.5 * turn;
        let pairs = multiples(from + half).zip(multiples(half));
        // cos(k(x + 2h)) - cos(k x) = -2 sin(k(x + h)) sin(k h),  sin(k(x + 2h)) - sin(k x) = 2 cos(k(x + h)) sin(k h)
        let mut rise = 0.0;
        for (term, ((cos, sin), (_, half))) in self.terms.iter().zip(pairs) {
            rise += 2.0 * half * (term.sine * cos - term.cosine * sin);
        }
        rise
    }

    /// Bound on `|c'''|` over `[start, end]`: everywhere, or from the middle if that is less.
    #[inline]
    pub fn third_bound(&self, start: f64, end: f64) -> f64 {
        let [third, fourth] = self.bounds;
        let from_middle = self.lift(0.5 * (start + end)).third.abs() + 0.5 * (end - start) * fourth;
        // Each rotation by x adds a rounding of an ulp.
        let rounding = tolerance::TERM_ROUNDING.value * self.terms.len() as f64;
        third.min(from_middle + rounding * fourth) * (1.0 + rounding)
    }

    /// A bound on `|c''''|` anywhere.
    pub fn fourth_bound(&self, _start: f64, _end: f64) -> f64 {
        self.bounds[1] * (1.0 + tolerance::TERM_ROUNDING.value * self.terms.len() as f64)
    }

    /// Lift and high derivatives at `angle`, rad.
    pub fn jet(&self, angle: f64) -> Jet {
        let mut jet = Jet::constant(self.offset);
        for (index, (term, (cos, sin))) in self.terms.iter().zip(multiples(angle)).enumerate() {
            // A cos(x + w t) + B sin(x + w t) = (A cos x + B sin x) cos(w t) + (B cos x - A sin x) sin(w t)
            let (b, a) = (term.cosine * cos + term.sine * sin, term.sine * cos - term.cosine * sin);
            jet = jet.plus(&Jet::of_sinusoid(a, b, index as f64 + 1.0));
        }
        jet
    }
}
