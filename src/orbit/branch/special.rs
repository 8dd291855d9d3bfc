//! The points where something changes along a branch.

use std::f64::consts::TAU;

use crate::orbit::{Course, Impact, PeriodicOrbit};
use crate::tolerance;

/// What changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A multiplier passes 1: the branch turns round in the parameter.
    Fold,
    /// A multiplier passes 1 and the branch goes on: another branch crosses it, of orbits with less symmetry perhaps.
    Branching,
    /// A multiplier passes -1: an orbit of twice the period branches off; or, on a branch of those, its end there.
    Flip,
    /// An impact passes a corner of the cam.
    Corner {
        /// Index of the impact.
        impact: usize,
        /// Index of the segment that starts at the corner.
        segment: usize,
        /// The lowest derivative of the lift that jumps there.
        jump_order: usize,
    },
    /// A flight touches the cam, or an impact becomes a touch: the number of impacts changes from one to the other.
    Graze {
        /// Impacts before, in the direction in which the branch was followed.
        before: usize,
        /// Impacts after.
        after: usize,
    },
    /// Along a curve of corner impacts: a multiplier of the map on one side of the corner passes 1 or -1.
    Type {
        /// Whether that side is the one after the corner.
        after_corner: bool,
        /// 1 or -1.
        multiplier: f64,
    },
    /// The follower begins to chatter, or ceases to.
    Chatter,
    /// The follower leaves the cam for the first time, or never does beyond.
    Detachment,
}

impl Kind {
    /// Its name in tables.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Fold => "fold",
            Self::Branching => "branching",
            Self::Flip => "flip",
            Self::Corner { .. } => "corner",
            Self::Graze { .. } => "graze",
            Self::Type { .. } => "type",
            Self::Chatter => "chatter",
            Self::Detachment => "detachment",
        }
    }
}

/// Where it changes, and how well that is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Special {
    pub kind: Kind,
    /// Two values of the parameter between which it does.
    pub bracket: [f64; 2],
    /// What is left of the quantity that passes 0 there, in its own unit: rad, m/s, m, or a multiplier's.
    pub residual: f64,
}

/// Whether two orbits are close enough to be neighbours on one branch.
pub(super) fn is_near(one: &PeriodicOrbit, other: &PeriodicOrbit) -> bool {
    match (&one.course, &other.course) {
        (Course::Impacts(one), Course::Impacts(other)) => {
            one.revolutions == other.revolutions
                && one.impacts.len() == other.impacts.len()
                && (0..one.revolutions).any(|later| {
                    let other = other.begun_later(later);
                    let pairs = one.impacts.iter().zip(&other.impacts);
                    pairs.into_iter().all(|(a, b)| {
                        a.revolution == b.revolution
                            && (a.cam_angle - b.cam_angle).abs() < tolerance::NEIGHBOURING.value
                    })
                })
        }
        (Course::Sticking(_), Course::Sticking(_)) => one.revolutions == other.revolutions,
        _ => false,
    }
}

/// Which impact of one orbit is which of its neighbour's on a branch, by their numbers from angle 0 on; none where the orbits
/// stick or have different numbers of impacts.
///
/// The order in which impacts follow one another stays the same along a branch: the numbers are as many places further on as
/// moves the impacts least.
pub(super) fn same_impacts(one: &PeriodicOrbit, other: &PeriodicOrbit) -> Vec<(usize, usize)> {
    let (Course::Impacts(from), Course::Impacts(to)) = (&one.course, &other.course) else { return Vec::new() };
    let count = from.impacts.len();
    if count != to.impacts.len() || from.revolutions != to.revolutions {
        return Vec::new();
    }
    let period = from.revolutions as f64 * TAU;
    let turned = |impact: &Impact| impact.revolution as f64 * TAU + impact.cam_angle;
    let moved = |further: usize| {
        let pairs = (0..count).map(|index| (&from.impacts[index], &to.impacts[(index + further) % count]));
        pairs.fold(0.0_f64, |most, (here, there)| {
            let apart = (turned(there) - turned(here)).rem_euclid(period);
            most.max(apart.min(period - apart))
        })
    };
    let least = (0..count).min_by(|one, two| moved(*one).total_cmp(&moved(*two)));
    least.map_or_else(Vec::new, |further| (0..count).map(|index| (index, (index + further) % count)).collect())
}
