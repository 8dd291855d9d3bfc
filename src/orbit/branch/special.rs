//! The points where something changes along a branch.

use crate::orbit::{Course, PeriodicOrbit};
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
        contact: usize,
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
    /// What changes.
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
                && one.contacts.len() == other.contacts.len()
                && (0..one.revolutions).any(|later| {
                    let other = other.begun_later(later);
                    let pairs = one.contacts.iter().zip(&other.contacts);
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
