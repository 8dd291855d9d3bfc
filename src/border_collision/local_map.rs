//! Local map `x' = A x + B mu`, with the matrices of the side of x, and its periodic orbits.
//!
//! The map looks the same at every scale: for k > 0, x moves at mu as k x moves at k mu. So the cases mu = 1, -1 and 0 suffice. A map of
//! the line is the special case in which the second coordinate stays 0.

use nalgebra::{Matrix2, RowVector2, Vector2};

use super::word::Word;
use crate::cam::Side;
use crate::corner::map::{CornerMap, Eigenvalue, SideMap};
use crate::elementary;
use crate::orbit::Stability;
use crate::tolerance;

/// Piecewise-linear map of the plane with one border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalMap {
    /// Map where `e x + f mu < 0`; L in words.
    pub minus: SideMap,
    /// Map where `e x + f mu >= 0`; R in words.
    pub plus: SideMap,
    /// Border `(e, f)`.
    pub border: (RowVector2<f64>, f64),
}

/// Orbit that repeats a word, wherever its points lie.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub struct MapOrbit {
    /// Sides of the word.
    pub word: Word,
    /// Points, one for each letter.
    pub points: Vec<Vector2<f64>>,
    /// Eigenvalues of the product of the word's matrices.
    pub multipliers: [Eigenvalue; 2],
    /// Least distance of its points from the border relative to the largest term of any: positive if all points lie on the side of their
    /// letter, negative if one does not.
    pub margin: f64,
}

document!(MapOrbit as orbit {
    word: orbit.word.to_string(),
    points: orbit.points.iter().map(|point| [point[0], point[1]]).collect::<Vec<_>>(),
    multipliers: orbit.multipliers,
    stability: orbit.stability(),
    stable: orbit.stable(),
    admissible: orbit.admissible(),
    margin: orbit.margin,
});

impl MapOrbit {
    /// Whether every point lies on the side of its letter, and off the border by more than rounding.
    pub fn admissible(&self) -> bool {
        self.margin > tolerance::DEGENERATE.value
    }

    /// Whether both multipliers lie inside the unit circle.
    pub fn stable(&self) -> bool {
        self.stability() == Stability::Stable
    }

    /// Stability: the behaviour of small deviations from the orbit.
    pub fn stability(&self) -> Stability {
        stability(&self.multipliers)
    }
}

impl LocalMap {
    /// Builds the local map of a corner impact, with dT for mu; `border` is `(e, f)` of [`crate::corner::variational::border`].
    pub fn new(map: &CornerMap, border: (RowVector2<f64>, f64)) -> Self {
        Self { minus: map.minus, plus: map.plus, border }
    }

    /// Map of one side.
    pub fn of(&self, side: Side) -> &SideMap {
        match side {
            Side::Minus => &self.minus,
            Side::Plus => &self.plus,
        }
    }

    /// Height `e x + f mu` over the border, and the sum of its terms' sizes.
    pub fn height(&self, x: Vector2<f64>, mu: f64) -> (f64, f64) {
        let (e, f) = self.border;
        let terms = [e[0] * x[0], e[1] * x[1], f * mu];
        (terms.iter().sum(), terms.iter().map(|term| term.abs()).sum())
    }

    /// Side of x.
    pub fn side(&self, x: Vector2<f64>, mu: f64) -> Side {
        if self.height(x, mu).0 < 0.0 { Side::Minus } else { Side::Plus }
    }

    /// Applies the map once.
    pub fn apply(&self, x: Vector2<f64>, mu: f64) -> Vector2<f64> {
        let side = self.of(self.side(x, mu));
        side.a * x + side.b * mu
    }

    /// Composition `x -> A_W x + B_W mu` of the maps of a word's letters, wherever x is.
    pub fn along(&self, word: &Word) -> SideMap {
        word.sides().iter().fold(SideMap::IDENTITY, |first, side| self.of(*side).after(&first))
    }

    /// Orbit that repeats `word`; `None` if `det(I - A_W)` is zero up to rounding, so that there is no orbit or a family of them.
    pub fn orbit(&self, word: &Word, mu: f64) -> Option<MapOrbit> {
        // Each point is computed from its own rotation: carried from one to the next, it would lose digits that the word expands.
        let point = |by: usize| {
            let round = self.along(&word.turned(by));
            let (value, terms) = characteristic(&round.a, 1.0);
            if !(value.abs() > tolerance::DEGENERATE.value * terms) {
                return None;
            }
            // x = (I - A_W)^{-1} B_W mu
            (Matrix2::identity() - round.a).try_inverse().map(|inverse| inverse * round.b * mu)
        };
        let points: Vec<_> = (0..word.sides().len()).map(point).collect::<Option<_>>()?;
        let inward = |(x, side): (&Vector2<f64>, &Side)| {
            let height = self.height(*x, mu).0;
            if *side == Side::Minus { -height } else { height }
        };
        let least = points.iter().zip(word.sides()).map(inward).fold(f64::INFINITY, f64::min);
        let terms = points.iter().map(|x| self.height(*x, mu).1).fold(0.0, f64::max);
        let margin = if terms > 0.0 { least / terms } else { 0.0 };
        Some(MapOrbit { word: word.clone(), points, multipliers: self.along(word).eigenvalues(), margin })
    }

    /// All admissible periodic orbits with a word of at most `longest` letters, the short ones first.
    pub fn admissible_orbits(&self, mu: f64, longest: usize) -> Vec<MapOrbit> {
        let words = Word::primitive(longest);
        words.iter().filter_map(|word| self.orbit(word, mu)).filter(MapOrbit::admissible).collect()
    }
}

/// Behaviour of small deviations under a matrix with these eigenvalues.
pub(super) fn stability(eigenvalues: &[Eigenvalue; 2]) -> Stability {
    let [one, two] = eigenvalues.map(|value| elementary::hypot(value.re, value.im));
    let modulus = if one > two { one } else { two };
    Stability::of_modulus(modulus, tolerance::UNIT_EIGENVALUE.value)
}

/// Returns `det(z I - A) = z^2 - z tr A + det A` for z = 1 or -1, and the sum of its terms' sizes.
#[doc(hidden)]
pub fn characteristic(a: &Matrix2<f64>, z: f64) -> (f64, f64) {
    let (trace, determinant) = (a.trace(), a.determinant());
    (1.0 - z * trace + determinant, 1.0 + trace.abs() + determinant.abs())
}
