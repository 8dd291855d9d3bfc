//! Conditions under which a border collision is of a generic kind, each with its distance from failing.
//!
//! A distance has no unit: it is a quantity relative to the sum of the sizes of its terms, or the difference of an eigenvalue's modulus
//! from 1. The distance is 0 where the condition fails. Continuity is the only condition that is an equation: its distance is the unused
//! share of the allowance for rounding, at most 1.

use nalgebra::{Matrix2, RowVector2};
use serde::Serialize;

use super::local_map::{LocalMap, characteristic};
use super::word::Word;
use crate::corner::SideMap;
use crate::elementary;
use crate::tolerance::{self, Tolerance};

/// Result that depends on a condition.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Decides {
    /// Classification, which does not exist without the condition.
    Classification,
    /// Stability of the fixed points; their positions do not depend on it.
    Stability,
    /// Normal form alone.
    NormalForm,
    /// Theorem of robust chaos.
    RobustChaos,
}

/// Condition of a classification.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct Condition {
    /// Formula of the quantity that must not vanish; for continuity, of the quantity that must vanish.
    pub name: &'static str,
    /// Consequence of a failure.
    pub meaning: &'static str,
    /// Value of the quantity, in the map's units.
    pub value: f64,
    /// Distance from failing, without units.
    pub distance: f64,
    /// Value that the distance must exceed.
    pub least: Tolerance,
    /// Result that depends on it.
    pub decides: Decides,
}

document!(Condition as condition {
    name: condition.name,
    meaning: condition.meaning,
    value: condition.value,
    distance: condition.distance,
    least: condition.least.value,
    reason: condition.least.reason,
    decides: condition.decides,
    holds: condition.holds(),
});

impl Condition {
    /// Whether the condition is met; false if the distance is NaN.
    pub fn holds(&self) -> bool {
        self.distance > self.least.value
    }
}

/// All conditions on the map of the plane `map`, those of the classification first.
#[doc(hidden)]
pub fn conditions(map: &LocalMap) -> Vec<Condition> {
    let (minus, plus) = (&map.minus, &map.plus);
    let one =
        |name, meaning, (value, distance), least, decides| Condition { name, meaning, value, distance, least, decides };
    let over_terms = |(value, terms): (f64, f64)| (value, value.abs() / terms);
    let determinant = |a: &Matrix2<f64>, z| over_terms(characteristic(a, z));
    let zero = tolerance::DEGENERATE;
    let circle = tolerance::UNIT_EIGENVALUE;
    let (verdict, stability, form) = (Decides::Classification, Decides::Stability, Decides::NormalForm);
    let neutral = "a multiplier is on the unit circle: the linear part does not decide stability";
    let vanishing = "a multiplier is 1: the fixed point is not isolated, or does not exist";
    let flipping = "a multiplier is -1: the smooth map flips at the same speed";
    let mut all = vec![
        one("A+ - A-", "both sides are one map: there is no border", jump(map), zero, verdict),
        one(
            "(A+ - A-, B+ - B-) - E (e, f) = 0",
            "the sides do not meet on the border: the map is not continuous",
            continuity(map),
            zero,
            verdict,
        ),
        one("det(I - A-)", vanishing, determinant(&minus.a, 1.0), zero, verdict),
        one("det(I - A+)", vanishing, determinant(&plus.a, 1.0), zero, verdict),
        one("det(I + A-)", flipping, determinant(&minus.a, -1.0), zero, verdict),
        one("det(I + A+)", flipping, determinant(&plus.a, -1.0), zero, verdict),
        one(
            "e adj(I - A-) B- + f det(I - A-)",
            "the fixed points do not cross the border as the speed changes",
            crossing(map),
            zero,
            verdict,
        ),
    ];
    if let Some(both) = Word::read("LR").map(|word| map.along(&word).a) {
        let pair = determinant(&both, 1.0);
        all.push(one(
            "det(I - A+ A-)",
            "the orbit of period two is not isolated, or does not exist",
            pair,
            zero,
            verdict,
        ));
    }
    all.push(one("|eigenvalue| - 1 of A-", neutral, modulus(minus), circle, stability));
    all.push(one("|eigenvalue| - 1 of A+", neutral, modulus(plus), circle, stability));
    let e = map.border.0;
    all.push(one("det [e; e A-]", "the companion form does not exist", seen(e, e * minus.a), zero, form));
    let c1 = (plus.a[(0, 0)] - minus.a[(0, 0)], plus.a[(0, 0)].abs() + minus.a[(0, 0)].abs());
    all.push(one("first entry of C", "the position does not shift the border away", over_terms(c1), zero, form));
    all
}

/// Largest entry of `A+ - A-`, and its size relative to the terms of its difference.
fn jump(map: &LocalMap) -> (f64, f64) {
    let (minus, plus) = (map.minus.a, map.plus.a);
    let relative = |index: usize| {
        let terms = minus[index].abs() + plus[index].abs();
        let jump = plus[index] - minus[index];
        (jump, if terms > 0.0 { jump.abs() / terms } else { 0.0 })
    };
    (0..4).map(relative).fold((0.0, 0.0), |most, next| if next.1 <= most.1 { most } else { next })
}

/// Largest minor of `[A+ - A-, B+ - B-]` and `[e, f]` relative to its terms, 0 if each row is a multiple of `[e, f]`; and the unused share
/// of the allowance.
fn continuity(map: &LocalMap) -> (f64, f64) {
    let (e, f) = map.border;
    let border = [e[0], e[1], f];
    let mut off = 0.0_f64;
    for row in 0..2 {
        let both = |side: &SideMap| [side.a[(row, 0)], side.a[(row, 1)], side.b[row]];
        let (minus, plus) = (both(&map.minus), both(&map.plus));
        for (j, k) in [(0, 1), (0, 2), (1, 2)] {
            let jump = |index: usize| plus[index] - minus[index];
            let size = |index: usize| plus[index].abs() + minus[index].abs();
            let terms = size(j) * border[k].abs() + size(k) * border[j].abs();
            let minor = (jump(j) * border[k] - jump(k) * border[j]).abs();
            let relative = if terms > 0.0 { minor / terms } else { minor };
            off = if relative.is_nan() { f64::NAN } else { off.max(relative) };
        }
    }
    (off, 1.0 - off / tolerance::CONTINUOUS.value)
}

/// Difference from 1 of the modulus nearest to it.
fn modulus(side: &SideMap) -> (f64, f64) {
    let off = side.eigenvalues().map(|value| elementary::hypot(value.re, value.im) - 1.0);
    let nearest = if off[0].abs() <= off[1].abs() { off[0] } else { off[1] };
    (nearest, nearest.abs())
}

/// Returns `e adj(I - A) B + f det(I - A)`, which is equal for both sides. Divided by `det(I - A)` it is the distance of a side's fixed
/// point from the border at mu = 1.
fn crossing(map: &LocalMap) -> (f64, f64) {
    let side = &map.minus;
    let whole = Matrix2::identity() - side.a;
    let (e, f) = map.border;
    // adj [[a, b], [c, d]] = [[d, -b], [-c, a]]
    let terms = [
        e[0] * whole[(1, 1)] * side.b[0],
        -e[0] * whole[(0, 1)] * side.b[1],
        -e[1] * whole[(1, 0)] * side.b[0],
        e[1] * whole[(0, 0)] * side.b[1],
        f * whole.determinant(),
    ];
    let value = terms.iter().sum::<f64>();
    (value, value.abs() / terms.iter().map(|term| term.abs()).sum::<f64>())
}

/// Determinant of two rows, and its size relative to its terms.
fn seen(first: RowVector2<f64>, second: RowVector2<f64>) -> (f64, f64) {
    let terms = [first[0] * second[1], -first[1] * second[0]];
    (terms[0] + terms[1], (terms[0] + terms[1]).abs() / (terms[0].abs() + terms[1].abs()))
}
