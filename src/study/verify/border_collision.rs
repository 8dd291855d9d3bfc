//! The part of the document on the border collision: normal form, verdict, conditions, the local map's own motions, its range.

use nalgebra::RowVector2;
use serde::Serialize;

use crate::border_collision::conditions::{Condition, Decides};
use crate::border_collision::feigin::{Scenario, Speeds};
use crate::border_collision::local_map::PeriodicOrbit;
use crate::border_collision::long_run::End;
use crate::border_collision::outcome::{Fate, LocalOutcome};
use crate::border_collision::validity::{Compared, Ends, Range};
use crate::border_collision::{Classification, NormalForm};
use crate::corner::map::Eigenvalue;
use crate::study::verify::document::{EigenvalueEntry, Sides, rows};

/// The normal form.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct NormalFormEntry {
    /// After the shift.
    #[serde(rename = "B_tilde")]
    pub b_tilde: [f64; 2],
    /// The change of coordinates.
    #[serde(rename = "W")]
    pub w: [[f64; 2]; 2],
    /// Companion form.
    #[serde(rename = "A_bar_minus")]
    pub a_bar_minus: [[f64; 2]; 2],
    /// Companion form.
    #[serde(rename = "A_bar_plus")]
    pub a_bar_plus: [[f64; 2]; 2],
    /// `W B_tilde`.
    #[serde(rename = "B_bar")]
    pub b_bar: [f64; 2],
    /// `C W^{-1}`.
    #[serde(rename = "C_bar")]
    pub c_bar: [f64; 2],
}

/// Feigin's verdict.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ClassificationEntry {
    /// The scenario's name.
    pub scenario: Scenario,
    /// Counts.
    pub real_eigenvalues_above_one: Sides<usize>,
    /// Counts.
    pub real_eigenvalues_below_minus_one: Sides<usize>,
    /// Speeds at which each side's fixed point exists.
    pub fixed_points_exist_for: Sides<Speeds>,
    /// Whether an orbit of period two is born: the total below -1 is odd.
    pub period_two_orbit: bool,
    /// Whether each side's fixed point is stable.
    pub stable: Sides<bool>,
    /// Each side's fixed point for dT = 1 s.
    pub fixed_point_per_unit_period: Sides<[f64; 2]>,
    /// `det(I - A)`.
    pub determinant_of_identity_minus_a: Sides<f64>,
    /// `(e, f)`: the impact comes before the corner where `e dx + f dT < 0`.
    pub border: [f64; 3],
}

/// A condition of the classification.
#[derive(Clone, Debug, Serialize)]
pub struct ConditionEntry {
    /// What must not vanish.
    pub name: &'static str,
    /// What its failing would mean.
    pub meaning: &'static str,
    /// The quantity.
    pub value: f64,
    /// How far from failing, without units.
    pub distance: f64,
    /// What the distance must exceed.
    pub least: f64,
    /// Why.
    pub reason: &'static str,
    /// `classification`, `stability` or `normal-form`: what rests on it.
    pub decides: Decides,
    /// Whether it holds.
    pub holds: bool,
}

/// The local map's motions on one side of the corner-impact speed.
#[derive(Clone, Debug, Serialize)]
pub struct OutcomeEntry {
    /// `faster`, `slower` or `at`.
    pub speeds: &'static str,
    /// Of both sides, admissible or not.
    pub fixed_points: Vec<OrbitEntry>,
    /// The orbit of period two with a point on each side, admissible or not.
    pub period_two: Option<OrbitEntry>,
    /// Admissible ones, of a few steps.
    pub periodic_orbits: Vec<OrbitEntry>,
    /// How many motions were run.
    pub starts: usize,
    /// Where they end; the first is that of the corner impact's own state.
    pub ends: Vec<EndEntry>,
}

/// A periodic orbit of the local map.
#[derive(Clone, Debug, Serialize)]
pub struct OrbitEntry {
    /// The sides that it visits, L for minus and R for plus.
    pub word: String,
    /// Its points for |dT| = 1 s: m, m/s.
    pub points: Vec<[f64; 2]>,
    /// Of the whole word.
    pub multipliers: [EigenvalueEntry; 2],
    /// Whether both are inside the unit circle.
    pub stable: bool,
    /// Whether each point is on the side of its letter.
    pub admissible: bool,
    /// The least distance from the border over its terms.
    pub margin: f64,
}

/// Where motions end.
#[derive(Clone, Debug, Serialize)]
pub struct EndEntry {
    /// `fixed-point`, `periodic`, `chaotic`, `undecided`, `corner` or `escapes`.
    pub end: &'static str,
    /// Of a periodic orbit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub word: Option<String>,
    /// The largest Lyapunov exponent per step, of a motion that is not periodic.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exponent: Option<f64>,
    /// Of the exponent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub standard_error: Option<f64>,
    /// How many starts end there.
    pub starts: usize,
    /// What that was decided by.
    pub basis: String,
}

/// How far a prediction of the local map holds.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct RangeEntry {
    /// `one-revolution`, `fixed-point-minus` or `fixed-point-plus`.
    pub compared: Compared,
    /// `faster` or `slower`.
    pub speeds: &'static str,
    /// The last change of the period for which it holds, s; 0 where it never does.
    pub period_change_s: f64,
    /// The speed there.
    pub speed_rpm: f64,
    /// The relative difference there.
    pub difference: Option<f64>,
    /// `tenth`, `other-motion` or `nothing`: what ends the range.
    pub ends: Ends,
}

/// On which side of the corner-impact speed a change of the period lies.
fn speeds(mu: f64) -> &'static str {
    if mu < 0.0 {
        "faster"
    } else if mu > 0.0 {
        "slower"
    } else {
        "at"
    }
}

impl NormalFormEntry {
    pub(crate) fn new(form: &NormalForm) -> Self {
        Self {
            b_tilde: form.b_tilde.into(),
            w: rows(&form.w),
            a_bar_minus: rows(&form.a_bar_minus),
            a_bar_plus: rows(&form.a_bar_plus),
            b_bar: form.b_bar.into(),
            c_bar: form.c_bar.into(),
        }
    }
}

impl ClassificationEntry {
    pub(crate) fn new(verdict: &Classification, (e, f): (RowVector2<f64>, f64)) -> Self {
        let Classification { scenario, period_two_orbit, minus, plus } = verdict;
        Self {
            scenario: *scenario,
            real_eigenvalues_above_one: Sides { minus: minus.above_one, plus: plus.above_one },
            real_eigenvalues_below_minus_one: Sides { minus: minus.below_minus_one, plus: plus.below_minus_one },
            fixed_points_exist_for: Sides { minus: minus.exists_for, plus: plus.exists_for },
            period_two_orbit: *period_two_orbit,
            stable: Sides { minus: minus.stable, plus: plus.stable },
            fixed_point_per_unit_period: Sides { minus: minus.fixed_point.into(), plus: plus.fixed_point.into() },
            determinant_of_identity_minus_a: Sides { minus: minus.determinant, plus: plus.determinant },
            border: [e[0], e[1], f],
        }
    }
}

impl ConditionEntry {
    pub(crate) fn new(condition: &Condition) -> Self {
        let Condition { name, meaning, value, distance, least, decides } = *condition;
        let (bound, reason) = (least.value, least.reason);
        let (decides, holds) = (decides, condition.holds());
        Self { name, meaning, value, distance, least: bound, reason, decides, holds }
    }
}

impl OutcomeEntry {
    pub(crate) fn new(outcome: &LocalOutcome) -> Self {
        Self {
            speeds: speeds(outcome.mu),
            fixed_points: outcome.fixed_points.iter().map(OrbitEntry::new).collect(),
            period_two: outcome.period_two.as_ref().map(OrbitEntry::new),
            periodic_orbits: outcome.orbits.iter().map(OrbitEntry::new).collect(),
            starts: outcome.starts(),
            ends: outcome.fates.iter().map(EndEntry::new).collect(),
        }
    }
}

impl OrbitEntry {
    fn new(orbit: &PeriodicOrbit) -> Self {
        Self {
            word: orbit.word.to_string(),
            points: orbit.points.iter().map(|point| (*point).into()).collect(),
            multipliers: orbit.multipliers.map(|Eigenvalue { re, im }| EigenvalueEntry { re, im }),
            stable: orbit.stable(),
            admissible: orbit.admissible(),
            margin: orbit.margin,
        }
    }
}

impl EndEntry {
    fn new(fate: &Fate) -> Self {
        let exponent = match &fate.end {
            End::Chaotic(exponent) | End::Undecided(exponent) => Some(exponent),
            _ => None,
        };
        let word = match &fate.end {
            End::Periodic(orbit) => Some(orbit.word.to_string()),
            _ => None,
        };
        Self {
            end: fate.end.name(),
            word,
            exponent: exponent.map(|exponent| exponent.value),
            standard_error: exponent.map(|exponent| exponent.error),
            starts: fate.starts,
            basis: fate.end.basis(),
        }
    }
}

impl RangeEntry {
    pub(crate) fn new(range: &Range) -> Self {
        let Range { compared, sign, period_change, speed_rpm, difference, ends } = *range;
        Self { compared, speeds: speeds(sign), period_change_s: period_change, speed_rpm, difference, ends }
    }
}
