//! All orbits of a machine with one impact in so many revolutions, or with two in one: by enclosures that leave no case out.
//!
//! | module | what it holds |
//! |---|---|
//! | `one_impact` | one equation in the impact's angle and the time of the flight, its roots, and what each of them is |
//! | `two_impacts` | the same of two equations in the angles of both |
//! | `clearance` | whether a flight is clear of the cam on its way |
//!
//! Angles where nothing can be decided, next to a fold, a graze or a corner, are told. What is proved is said of the machine whose
//! numbers are the doubles that its model became.

mod clearance;
mod one_impact;
mod two_impacts;

use super::cycle::Cycle;
use crate::interval::Interval;
pub(crate) use clearance::Struck;
pub(crate) use one_impact::OneImpact;
pub(super) use one_impact::{near_one_impact, of_one_impact};
pub(super) use two_impacts::of_two_impacts;

/// What a solution of the equations is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Standing {
    /// An orbit of the cam as it is.
    Orbit,
    /// None: the follower would come out of the cam, or meet it on the way.
    NoOrbit,
    /// Rounding does not tell.
    Undecided,
}

/// Angles of which not all is known: an orbit may have its impacts there.
#[derive(Clone, Debug, PartialEq)]
pub struct Undecided {
    /// For each impact from where to where, rad.
    pub cam_angles: Vec<[f64; 2]>,
}

document!(Undecided as it { impacts: it.cam_angles.len(), cam_angles_rad: it.cam_angles });

/// Where the equations hold, or may hold.
#[derive(Clone, Debug)]
pub(super) struct Solved {
    /// Close to it.
    pub guess: Cycle,
    /// The angle of each impact, rad.
    pub angles: Vec<Interval>,
    pub standing: Standing,
}

/// Boxes one next to the other as one; their order along the first side is kept.
pub(crate) fn joined<const N: usize>(mut boxes: Vec<[Interval; N]>) -> Vec<[Interval; N]> {
    boxes.sort_by(|one, two| one[0].low().total_cmp(&two[0].low()));
    let mut joined: Vec<[Interval; N]> = Vec::new();
    'boxes: for next in boxes {
        for last in joined.iter_mut().rev() {
            if last.iter().zip(&next).all(|(one, other)| one.common(*other).is_some()) {
                *last = std::array::from_fn(|side| last[side].hull(next[side]));
                continue 'boxes;
            }
        }
        joined.push(next);
    }
    joined
}
