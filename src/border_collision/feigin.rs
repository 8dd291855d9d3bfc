//! Feigin's classification of a border collision in a continuous piecewise-linear map.
//!
//! The counts are the numbers of real eigenvalues above 1 and below -1 on both sides. If the total above 1 is even, the fixed point
//! persists; if it is odd, two fixed points meet and vanish (nonsmooth fold). If the total below -1 is odd, an orbit of period two is born
//! (nonsmooth flip). The speeds at which each side's fixed point exists are computed separately, from the border.

use nalgebra::{Matrix2, RowVector2, Vector2};
use serde::{Deserialize, Serialize};

use super::Degenerate;
use super::conditions::{Condition, Decides, conditions};
use super::local_map::{LocalMap, stability};
use crate::cam::Side;
use crate::corner::map::{CornerMap, Eigenvalue, SideMap, Sides};
use crate::elementary;
use crate::orbit::{Stability, eigenvalues};
use crate::tolerance;

/// Scenario of the fixed point at the border.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scenario {
    /// Crossing of the fixed point to the other side.
    Persistence,
    /// Meeting of the fixed points of both sides, which vanish.
    NonsmoothFold,
    /// Crossing of the fixed point, with the birth of an orbit of period two.
    NonsmoothFlip,
}

impl Scenario {
    /// Returns the scenario for the numbers of real eigenvalues above 1 and below -1, of both sides together.
    pub fn of_counts(above_one: usize, below_minus_one: usize) -> Self {
        match (above_one % 2, below_minus_one % 2) {
            (1, _) => Self::NonsmoothFold,
            (_, 1) => Self::NonsmoothFlip,
            _ => Self::Persistence,
        }
    }
}

named!(Scenario, Speeds);

/// Side of the corner-impact speed on which a fixed point exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Speeds {
    /// Speeds above omega*: dT < 0.
    Faster,
    /// Speeds below omega*: dT > 0.
    Slower,
}

impl Speeds {
    /// Returns the speeds at which the period changes by `mu`; `None` for 0.
    pub fn of(mu: f64) -> Option<Self> {
        if mu == 0.0 { None } else { Some(if mu < 0.0 { Self::Faster } else { Self::Slower }) }
    }
}

/// Name of the speeds at which the period changes by `mu`.
#[doc(hidden)]
pub fn speeds_at(mu: f64) -> String {
    Speeds::of(mu).map_or("at".into(), |speeds| speeds.to_string())
}

/// Counts, fixed point and stability of one side.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct SideCounts {
    /// Number of real eigenvalues above 1.
    pub above_one: usize,
    /// Number of real eigenvalues below -1.
    pub below_minus_one: usize,
    /// Whether both eigenvalues lie inside the unit circle.
    pub stable: bool,
    /// Stability of the side's fixed point.
    pub stability: Stability,
    /// Fixed point `(I - A)^{-1} B` for dT = 1 s: m, m/s.
    pub fixed_point: Vector2<f64>,
    /// Determinant `det(I - A)`.
    pub determinant: f64,
    /// Speeds at which the fixed point lies on its own side of the border.
    pub exists_for: Speeds,
}

/// Feigin's verdict, with the counts and the border from which it follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Classification {
    /// Scenario.
    pub scenario: Scenario,
    /// Whether an orbit of period two exists on one side of the corner-impact speed; with a fold it is a second verdict.
    pub period_two_orbit: bool,
    /// Impacts before the corner.
    pub minus: SideCounts,
    /// Impacts after the corner.
    pub plus: SideCounts,
    /// Border `(e, f)`: the impact comes before the corner if `e dx + f dT < 0`.
    pub border: (RowVector2<f64>, f64),
}

impl Classification {
    /// Applies a function to the counts of each side.
    fn sides<T>(&self, of: impl Fn(&SideCounts) -> T) -> Sides<T> {
        Sides { minus: of(&self.minus), plus: of(&self.plus) }
    }
}

document!(Classification as kind {
    scenario: kind.scenario,
    real_eigenvalues_above_one: kind.sides(|side| side.above_one),
    real_eigenvalues_below_minus_one: kind.sides(|side| side.below_minus_one),
    fixed_points_exist_for: kind.sides(|side| side.exists_for),
    period_two_orbit: kind.period_two_orbit,
    stable: kind.sides(|side| side.stable),
    stability: kind.sides(|side| side.stability),
    fixed_point_per_unit_period: kind.sides(|side| [side.fixed_point[0], side.fixed_point[1]]),
    determinant_of_identity_minus_a: kind.sides(|side| side.determinant),
    border: [kind.border.0[0], kind.border.0[1], kind.border.1],
});

/// Classifies the border collision of `map`.
///
/// `border` is `(e, f)`, with the minus side where `e dx + f dT < 0`. The paper uses `(C, D)` instead, which is correct only if both have
/// the same sign.
pub fn classify(map: &CornerMap, border: (RowVector2<f64>, f64)) -> Result<Classification, Degenerate> {
    let minus = side_counts(Side::Minus, &map.minus, border, -1.0)?;
    let plus = side_counts(Side::Plus, &map.plus, border, 1.0)?;
    let all = conditions(&LocalMap::new(map, border));
    let failing = all.iter().find(|condition| condition.decides == Decides::Classification && !condition.holds());
    if let Some(&Condition { name, meaning, value, distance, .. }) = failing {
        return Err(Degenerate::Fails { name, value, distance, meaning });
    }
    let (above, below) = (minus.above_one + plus.above_one, minus.below_minus_one + plus.below_minus_one);
    let scenario = Scenario::of_counts(above, below);
    Ok(Classification { scenario, period_two_orbit: below % 2 == 1, minus, plus, border })
}

/// Returns the scenario of A- and A+, 2x2, by their eigenvalues alone.
pub fn scenario([minus, plus]: &[Matrix2<f64>; 2]) -> Result<Scenario, Degenerate> {
    let (minus, plus) = (counts(Side::Minus, &eigenvalues(minus))?, counts(Side::Plus, &eigenvalues(plus))?);
    Ok(Scenario::of_counts(minus[0] + plus[0], minus[1] + plus[1]))
}

/// Numbers of real eigenvalues above 1 and below -1 on one side.
fn counts(side: Side, eigenvalues: &[Eigenvalue; 2]) -> Result<[usize; 2], Degenerate> {
    for Eigenvalue { re, im } in *eigenvalues {
        for boundary in [1.0, -1.0] {
            if !(elementary::hypot(re - boundary, im) > tolerance::UNIT_EIGENVALUE.value) {
                return Err(Degenerate::EigenvalueOnBoundary { side, value: re, boundary });
            }
        }
    }
    let real = |test: fn(f64) -> bool| eigenvalues.iter().filter(|value| value.im == 0.0 && test(value.re)).count();
    Ok([real(|value| value > 1.0), real(|value| value < -1.0)])
}

/// Counts of one side; `sign` is the sign of `e x + f dT` on it.
fn side_counts(
    name: Side,
    side: &SideMap,
    (e, f): (RowVector2<f64>, f64),
    sign: f64,
) -> Result<SideCounts, Degenerate> {
    let eigenvalues = side.eigenvalues();
    let [above_one, below_minus_one] = counts(name, &eigenvalues)?;
    let stability = stability(&eigenvalues);
    // x = A x + B dT
    let whole = Matrix2::identity() - side.a;
    let fixed_point = whole.try_inverse().map(|inverse| inverse * side.b);
    let Some(fixed_point) = fixed_point else {
        return Err(Degenerate::Vanishes { what: "the determinant of I - A", value: whole.determinant() });
    };
    let along = (e * fixed_point)[0];
    let distance = along + f;
    if !(distance.abs() > tolerance::DEGENERATE.value * (along.abs() + f.abs())) {
        return Err(Degenerate::Vanishes { what: "the fixed point's distance from the border", value: distance });
    }
    Ok(SideCounts {
        above_one,
        below_minus_one,
        stable: stability == Stability::Stable,
        stability,
        fixed_point,
        determinant: whole.determinant(),
        exists_for: if distance * sign > 0.0 { Speeds::Slower } else { Speeds::Faster },
    })
}
