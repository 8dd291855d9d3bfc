//! The points where something changes along a branch.

use std::f64::consts::TAU;

use serde::Serialize;

use super::first_touch::{FirstTouch, UndecidedGraze};
use crate::orbit::{Course, Impact, Judgement, PeriodicOrbit, Stability};

/// Kind of change along a branch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpecialKind {
    /// A multiplier passes 1: the branch turns round in the parameter.
    Fold,
    /// A multiplier passes 1 and the branch goes on: another branch crosses it, perhaps of orbits with less symmetry.
    Branching,
    /// A multiplier passes -1: an orbit of twice the period branches off. On a branch of such orbits it is their end.
    Flip,
    /// An impact passes a corner of the cam.
    Corner {
        /// Index of the impact.
        impact: usize,
        /// Index of the segment that starts at the corner.
        segment: usize,
        /// Lowest order of a derivative of the lift that jumps there.
        jump_order: usize,
    },
    /// A flight touches the cam, or an impact becomes a touch: the number of impacts changes.
    Graze {
        /// Impacts before, in the direction in which the branch was followed.
        before: usize,
        /// Impacts after.
        after: usize,
        /// Angle that the cam has turned at the touch since angle 0 of revolution 0, rad.
        turned: f64,
        /// For an orbit without impacts: class of the graze.
        first: Option<FirstTouch>,
    },
    /// Along a curve of corner impacts or grazes: a fold or a flip meets the curve. A multiplier of the map on one side of the corner, or
    /// of the orbit without the touch, passes 1 or -1.
    Type {
        /// Whether it is the map after the corner; `None` for a graze.
        after_corner: Option<bool>,
        /// 1 or -1.
        multiplier: f64,
    },
    /// Along a curve of folds: a cusp, where two of them meet.
    Cusp,
    /// Along a curve of grazes of orbits without impacts: the class of the graze is undecided there, and may change.
    Class(UndecidedGraze),
    /// Along a curve of detachment: the place where the follower first leaves the cam changes to another.
    Place,
    /// A curve turns round in the followed parameter.
    Turn,
    /// The follower begins to chatter, or ceases to.
    Chatter,
    /// The follower leaves the cam for the first time, or never does beyond.
    Detachment,
}

/// The kinds of event that are followed in two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Bifurcation {
    /// An impact is at a corner of the cam.
    Corner,
    /// A multiplier is 1.
    Fold,
    /// A multiplier is -1.
    Flip,
    /// A flight touches the cam.
    Graze,
    /// The follower leaves the cam for the first time.
    Detachment,
    /// The follower begins to come to rest on the cam, or ceases to.
    Resting,
}

named!(Bifurcation);

impl Bifurcation {
    /// All of them.
    pub const ALL: [Self; 6] = [Self::Corner, Self::Fold, Self::Flip, Self::Graze, Self::Detachment, Self::Resting];
}

impl SpecialKind {
    /// Whether the matrix of the orbit is the same on both sides of a corner, since only derivatives beyond the acceleration jump there.
    pub(crate) fn is_smooth_corner(&self) -> bool {
        matches!(self, Self::Corner { jump_order: 3.., .. })
    }

    /// Kind of event that its curve follows, if it has a curve.
    pub fn bifurcation(&self) -> Option<Bifurcation> {
        match self {
            Self::Corner { .. } => Some(Bifurcation::Corner),
            Self::Fold => Some(Bifurcation::Fold),
            Self::Flip => Some(Bifurcation::Flip),
            Self::Graze { .. } => Some(Bifurcation::Graze),
            Self::Detachment => Some(Bifurcation::Detachment),
            Self::Chatter => Some(Bifurcation::Resting),
            _ => None,
        }
    }

    /// Name in tables.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Fold => "fold",
            Self::Branching => "branching",
            Self::Flip => "flip",
            Self::Corner { .. } => "corner",
            Self::Graze { .. } => "graze",
            Self::Type { .. } => "type",
            Self::Cusp => "cusp",
            Self::Class(_) => "class",
            Self::Place => "place",
            Self::Turn => "turn",
            Self::Chatter => "chatter",
            Self::Detachment => "detachment",
        }
    }
}

/// Returns the orbit at a special point with its verdict. The verdict is neutral if the equations of the point make a multiplier 1 or -1,
/// on whichever side of the circle rounding puts it. The other multiplier has the size of det M, which is 1 at most.
pub(super) fn judged(orbit: PeriodicOrbit, special: Option<Special>) -> PeriodicOrbit {
    let on_circle = special
        .is_some_and(|special| matches!(special.kind, SpecialKind::Fold | SpecialKind::Flip | SpecialKind::Branching));
    let stability = if on_circle { Stability::Neutral } else { orbit.judgement.stability };
    PeriodicOrbit { judgement: Judgement { stability, ..orbit.judgement }, ..orbit }
}

/// A special point: the kind of change, and how well it is located.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct Special {
    /// The kind of change.
    pub kind: SpecialKind,
    /// Bracket of the parameter.
    pub bracket: [f64; 2],
    /// Residual of the quantity that passes 0 there, in its own unit: rad, m/s, m, or a multiplier's.
    pub residual: f64,
}

/// Distance of two neighbours on a branch, rad, and the shift between the indices of their impacts, counted from angle 0. `None` if they
/// have different numbers of revolutions or impacts, or stick.
///
/// The order in which impacts follow one another stays the same along a branch: the shift is the one that moves the impacts least.
pub(super) fn apart(one: &PeriodicOrbit, other: &PeriodicOrbit) -> Option<(f64, usize)> {
    let (Course::Impacts(from), Course::Impacts(to)) = (&one.course, &other.course) else { return None };
    let count = from.impacts.len();
    if count != to.impacts.len() || from.revolutions != to.revolutions {
        return None;
    }
    let period = from.revolutions as f64 * TAU;
    let moved = |further: usize| {
        let pairs = (0..count).map(|index| (&from.impacts[index], &to.impacts[(index + further) % count]));
        // An orbit may begin with any of its revolutions.
        let turns = |(here, there): (&Impact, &Impact)| ((there.turned() - here.turned()) / TAU).round();
        let later = pairs.clone().next().map_or(0.0, turns);
        pairs.fold(0.0_f64, |most, (here, there)| {
            let apart = (there.turned() - here.turned() - later * TAU).rem_euclid(period);
            most.max(apart.min(period - apart))
        })
    };
    let all = (0..count).map(|further| (moved(further), further));
    all.min_by(|one, two| one.0.total_cmp(&two.0))
}

/// Pairs each impact of one orbit with that of its neighbour on a branch, by their indices from angle 0. Empty if they cannot be matched.
pub(super) fn same_impacts(one: &PeriodicOrbit, other: &PeriodicOrbit) -> Vec<(usize, usize)> {
    let count = one.impacts().count();
    let further = apart(one, other).map(|(_, further)| further);
    further.map_or_else(Vec::new, |further| (0..count).map(|index| (index, (index + further) % count)).collect())
}
