//! Where motions of the local map end: on a periodic orbit, in chaos, or nowhere.
//!
//! Whether a motion ends on an orbit or escapes is not guessed from its size. Once the sides that it visits repeat a word,
//! the rest follows: it converges to the orbit of that word where this orbit is stable and visits those sides, and it escapes
//! where a sufficient condition holds. For a motion that repeats no word the largest Lyapunov exponent is measured, or proved to
//! be above 0; it is called chaotic where a region that the map sends into itself shows that it stays.

use nalgebra::{Matrix2, Vector2};

use super::local_map::{LocalMap, MapOrbit};
use super::trapping::TrappingRegion;
use super::word::Word;
use crate::cam::Side;
use crate::corner::map::Eigenvalue;
use crate::elementary;
use crate::estimate::Estimate;
use crate::tolerance;

/// Where a motion ends.
#[derive(Clone, Debug, PartialEq)]
pub enum LocalLongRun {
    /// On a stable periodic orbit; a fixed point for a word of one letter.
    Periodic(MapOrbit),
    /// In chaos.
    Chaotic(LocalChaos),
    /// Undecided, with its exponent: the motion is on a closed curve, is not settled, or may be a long transient because no region
    /// was found that traps it.
    Undecided(Estimate),
    /// At the corner impact itself: at mu = 0 the motion shrinks to nothing.
    Corner,
    /// Nowhere: it grows without bound.
    Escapes(EscapeReason),
}

/// A motion that stays bounded and separates neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalChaos {
    /// Its largest Lyapunov exponent a step, a natural logarithm.
    pub exponent: Estimate,
    /// Lower bound of the exponent of every motion, by [`super::robust_chaos`]; none where its saddles do not exist. Then
    /// only the measured exponent shows that it is above 0.
    pub least_exponent: Option<f64>,
    /// Region in which it stays.
    pub region: TrappingRegion,
}

/// Why a motion is taken to escape.
#[derive(Clone, Debug, PartialEq)]
pub enum EscapeReason {
    /// The motion follows a word for ever and grows by a factor with each repetition.
    Follows {
        /// The word.
        word: Word,
        /// The multiplier above 1.
        multiplier: f64,
    },
    /// The motion has grown past `1/tolerance::ESCAPED` times its scale.
    Grown,
}

/// Steps between two checks of a motion. An exponent is a mean of means over this many steps.
const PART: usize = 1024;
/// Parts before the first mean: the transient.
const TRANSIENT: usize = 8;
/// Parts of a run that repeats no word.
const PARTS: usize = 40;
/// Steps of a run that repeats no word.
pub(super) const STEPS: usize = PARTS * PART;
/// Steps over which an exponent is averaged.
pub(super) const MEASURED: usize = (PARTS - TRANSIENT) * PART;
/// Parts around which a trapping region is built.
const AROUND: usize = 8;
/// Repetitions that a word needs to count.
const REPEATED: usize = 8;

impl LocalMap {
    /// Largest size of each coordinate in the first steps from 0: its natural unit at mu = 1, positive or 0 where x is never moved
    /// along it.
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

    /// The natural unit of each coordinate, 1 where x is never moved along it.
    pub(crate) fn units(&self) -> Vector2<f64> {
        self.scales().map(|scale| if scale > 0.0 { scale } else { 1.0 })
    }

    /// Where the motion from `start` ends.
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
            // The region around what was visited is made of the last parts alone.
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
            // At mu = 0 the only orbit is the corner impact itself, which is on no side.
            let word = if mu == 0.0 { None } else { Word::repeated(&sides, REPEATED) };
            if let Some(orbit) = word.and_then(|word| self.orbit(&word, mu)) {
                if orbit.admissible() && orbit.stable() {
                    let (word, _) = orbit.word.least_rotation();
                    return self.orbit(&word, mu).map_or(LocalLongRun::Periodic(orbit), LocalLongRun::Periodic);
                }
                // Rounding can put a motion on an unstable orbit and keep it there.
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

    /// The factor by which a motion at `x` grows with each repetition of `word`, if it provably repeats it for ever.
    ///
    /// After m repetitions a point is `c + l1^m d1 + l2^m d2` with the word's fixed point c and the parts of x - c along the
    /// eigenvectors. With l1 > 1 and l1 > |l2| it stays on the side s = -1, 1 for every m where
    /// `s e d1 > |e d2| + max(0, -s (e c + f mu))`, which is checked for each rotation of the word.
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

    /// The escape of a motion that has visited `sides` and is at `x` now, if it provably continues in the same way.
    fn escape(&self, sides: &[Side], x: Vector2<f64>, mu: f64) -> Option<EscapeReason> {
        // What follows is proved, so that a word seen twice is worth trying.
        let word = Word::repeated(&sides[sides.len() / 2..], 2)?;
        let multiplier = self.follows_for_ever(&word, x, mu)?;
        Some(EscapeReason::Follows { word: word.least_rotation().0, multiplier })
    }
}

/// A small deviation carried along, in natural units.
struct Tangent {
    scales: Vector2<f64>,
    direction: Vector2<f64>,
    growth: f64,
}

impl Tangent {
    fn new(scales: Vector2<f64>) -> Self {
        // Any direction has a part along the one that grows most.
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
