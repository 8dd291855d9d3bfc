//! Ends of the local map's motions: a periodic orbit, chaos, or escape.
//!
//! Convergence to an orbit and escape are not judged by the size of a motion. Once the visited sides repeat a word, the rest follows. The
//! motion converges to the orbit of that word if this orbit is stable and visits those sides; it escapes if a sufficient condition is met.
//! For a motion that repeats no word, the largest Lyapunov exponent is measured, or proved to be above 0. The motion is called chaotic if a
//! region that the map sends into itself shows that it stays.

use nalgebra::{Matrix2, Vector2};

use super::local_map::{LocalMap, MapOrbit};
use super::trapping::TrappingRegion;
use super::word::Word;
use crate::cam::Side;
use crate::corner::map::Eigenvalue;
use crate::elementary;
use crate::estimate::Estimate;
use crate::tolerance;

/// End of a motion.
#[derive(Clone, Debug, PartialEq)]
pub enum LocalLongRun {
    /// Stable periodic orbit; a fixed point for a word of one letter.
    Periodic(MapOrbit),
    /// Chaos.
    Chaotic(LocalChaos),
    /// Undecided end, with the exponent: the motion is on a closed curve, is not settled, or may be a long transient, since no trapping
    /// region was found.
    Undecided(Estimate),
    /// Corner impact itself: at mu = 0 the motion shrinks to nothing.
    Corner,
    /// Escape: the motion grows without bound.
    Escapes(EscapeReason),
}

/// Motion that stays bounded and on which small deviations grow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalChaos {
    /// Largest Lyapunov exponent per step, a natural logarithm.
    pub exponent: Estimate,
    /// Lower bound of the exponent of every motion, by [`super::robust_chaos`]; `None` if its saddles do not exist. Then only the measured
    /// exponent shows that it is above 0.
    pub least_exponent: Option<f64>,
    /// Region in which the motion stays.
    pub region: TrappingRegion,
}

/// Reason why a motion is taken to escape.
#[derive(Clone, Debug, PartialEq)]
pub enum EscapeReason {
    /// Motion that repeats a word for ever and grows by a factor with each repetition.
    Follows {
        /// Repeated word.
        word: Word,
        /// Growth factor per repetition, above 1.
        multiplier: f64,
    },
    /// Growth past `1/tolerance::ESCAPED` times the motion's scale.
    Grown,
}

/// Number of steps between two checks of a motion. An exponent is a mean of means over this many steps.
const PART: usize = 1024;
/// Number of parts before the first mean: the transient.
const TRANSIENT: usize = 8;
/// Number of parts of a run that repeats no word.
const PARTS: usize = 40;
/// Number of steps of a run that repeats no word.
pub(super) const STEPS: usize = PARTS * PART;
/// Number of steps over which an exponent is averaged.
pub(super) const MEASURED: usize = (PARTS - TRANSIENT) * PART;
/// Number of last parts around which a trapping region is built.
const AROUND: usize = 8;
/// Number of repetitions that a word needs to count.
const REPEATED: usize = 8;

impl LocalMap {
    /// Largest size of each coordinate in the first steps from 0, its natural unit at mu = 1; 0 if x never moves along it.
    pub fn scales(&self) -> Vector2<f64> {
        let mut scales = Vector2::<f64>::zeros();
        for mu in [1.0, -1.0] {
            let mut x = Vector2::zeros();
            for _ in 0..8 {
                x = self.apply(x, mu);
                scales = scales.sup(&x.abs());
            }
        }
        scales
    }

    /// Natural unit of each coordinate; 1 if x never moves along it.
    pub(crate) fn units(&self) -> Vector2<f64> {
        self.scales().map(|scale| if scale > 0.0 { scale } else { 1.0 })
    }

    /// End of the motion from `start`.
    pub fn end(&self, start: Vector2<f64>, mu: f64) -> LocalLongRun {
        let scales = self.scales();
        let size = |x: Vector2<f64>| {
            let over = |index: usize| if scales[index] > 0.0 { (x[index] / scales[index]).abs() } else { 0.0 };
            over(0).max(over(1))
        };
        let escaped = |x: Vector2<f64>| !(size(x) * tolerance::ESCAPED.value < 1.0);
        let mut x = start;
        let mut tangent = Tangent::new(self.units());
        let mut means = Vec::with_capacity(PARTS);
        let mut sides = Vec::with_capacity(PART);
        let mut visited = Vec::with_capacity(PART);
        for part in 0..PARTS {
            sides.clear();
            // The region is built around the points of the last parts alone.
            if part + AROUND < PARTS {
                visited.clear();
            }
            for _ in 0..PART {
                visited.push(x);
                let side = self.side(x, mu);
                sides.push(side);
                let map = self.of(side);
                x = map.a * x + map.b * mu;
                tangent.carry(&map.a);
                if escaped(x) {
                    return LocalLongRun::Escapes(self.escape(&sides, x, mu).unwrap_or(EscapeReason::Grown));
                }
            }
            if mu == 0.0 && size(x) < tolerance::ESCAPED.value {
                return LocalLongRun::Corner;
            }
            if let Some(escape) = self.escape(&sides, x, mu) {
                return LocalLongRun::Escapes(escape);
            }
            // At mu = 0 the only orbit is the corner impact itself, which is on neither side.
            let word = if mu == 0.0 { None } else { Word::repeated(&sides, REPEATED) };
            if let Some(orbit) = word.and_then(|word| self.orbit(&word, mu)) {
                if orbit.admissible() && orbit.stable() {
                    let (word, _) = orbit.word.least_rotation();
                    return self.orbit(&word, mu).map_or(LocalLongRun::Periodic(orbit), LocalLongRun::Periodic);
                }
                // Rounding can put a motion on an unstable orbit and keep it there; a small kick removes it.
                x += scales * tolerance::KICK.value;
            }
            let mean = tangent.take_growth() / PART as f64;
            if part >= TRANSIENT {
                means.push(mean);
            }
        }
        let exponent = Estimate::of_parts(&means);
        let least_exponent = self.robust_chaos(mu).map(|chaos| chaos.least_exponent);
        let known = exponent.error <= tolerance::CHAOTIC_EXPONENT.value * exponent.value && exponent.value > 0.0;
        let region = if known || least_exponent.is_some() { self.region(&visited, mu) } else { None };
        match region {
            Some(region) => LocalLongRun::Chaotic(LocalChaos { exponent, least_exponent, region }),
            None => LocalLongRun::Undecided(exponent),
        }
    }

    /// Growth factor per repetition of `word` of a motion at `x`, if it provably repeats the word for ever.
    ///
    /// After m repetitions a point is `c + l1^m d1 + l2^m d2`, with the word's fixed point c and the parts d1, d2 of x - c along the
    /// eigenvectors. With l1 > 1 and l1 > |l2| it stays on the side s = -1, 1 for every m if `s e d1 > |e d2| + max(0, -s (e c + f mu))`.
    /// This is checked for each rotation of the word.
    pub fn follows_for_ever(&self, word: &Word, x: Vector2<f64>, mu: f64) -> Option<f64> {
        let (mut point, mut growth) = (x, None);
        for (by, side) in word.sides().iter().enumerate() {
            let round = self.along(&word.turned(by));
            let [Eigenvalue { re: l1, im }, Eigenvalue { re: l2, .. }] = round.eigenvalues();
            if !(im == 0.0 && l1 > 1.0 + tolerance::UNIT_EIGENVALUE.value && l1 > l2.abs()) {
                return None;
            }
            let center = (Matrix2::identity() - round.a).try_inverse()? * round.b * mu;
            // d1 = (A_W - l2 I)/(l1 - l2) d
            let deviation = point - center;
            let first = (round.a * deviation - deviation * l2) / (l1 - l2);
            let (e, sign) = (self.border.0, if *side == Side::Minus { -1.0 } else { 1.0 });
            let against = (-sign * self.height(center, mu).0).max(0.0);
            if !(sign * (e * first)[0] > (e * (deviation - first))[0].abs() + against) {
                return None;
            }
            growth = Some(l1);
            let map = self.of(*side);
            point = map.a * point + map.b * mu;
        }
        growth
    }

    /// Escape of a motion that has visited `sides` and is at `x`, if it provably continues in the same way.
    fn escape(&self, sides: &[Side], x: Vector2<f64>, mu: f64) -> Option<EscapeReason> {
        // The continuation is proved, so that a word seen twice is worth a try.
        let word = Word::repeated(&sides[sides.len() / 2..], 2)?;
        let multiplier = self.follows_for_ever(&word, x, mu)?;
        Some(EscapeReason::Follows { word: word.least_rotation().0, multiplier })
    }
}

/// Small deviation carried along a motion, in natural units.
struct Tangent {
    scales: Vector2<f64>,
    direction: Vector2<f64>,
    growth: f64,
}

impl Tangent {
    fn new(scales: Vector2<f64>) -> Self {
        // Almost any direction has a part along the fastest growth.
        Self { scales, direction: Vector2::new(0.8, 0.6), growth: 0.0 }
    }

    fn carry(&mut self, a: &Matrix2<f64>) {
        let carried = (a * self.direction.component_mul(&self.scales)).component_div(&self.scales);
        let stretch = carried.norm();
        self.growth += elementary::ln(stretch);
        if stretch > 0.0 {
            self.direction = carried / stretch;
        }
    }

    fn take_growth(&mut self) -> f64 {
        std::mem::take(&mut self.growth)
    }
}
