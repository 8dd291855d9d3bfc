//! Finds all orbits of a machine with one impact in so many revolutions, or with two in one, by enclosures that leave no case out.
//!
//! | module | contents |
//! |---|---|
//! | `one_impact` | one equation in the impact's angle and the time of the flight, its roots, and the status of each |
//! | `two_impacts` | two equations in the angles of both impacts, their roots, and the status of each |
//! | `clearance` | whether a flight is clear of the cam on its way |
//!
//! Angles where nothing can be decided, next to a fold, a graze or a corner, are reported. The proofs apply to the machine whose numbers
//! are the doubles of its model.

mod clearance;
mod one_impact;
mod two_impacts;

use super::cycle::Cycle;
use crate::interval::Interval;
pub(crate) use clearance::Struck;
pub use one_impact::OneImpact;
pub(super) use one_impact::{near_one_impact, of_one_impact};
pub(super) use two_impacts::of_two_impacts;

/// Status of a solution of the equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Standing {
    /// An orbit of the actual cam.
    Orbit,
    /// No orbit: the follower would come out of the cam, or meet it on the way.
    NoOrbit,
    /// Undecided because of rounding.
    Undecided,
}

/// Undecided angles: an orbit may have its impacts there.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub struct Undecided {
    /// Range of the angle of each impact, rad.
    pub cam_angles: Vec<[f64; 2]>,
}

document!(Undecided as it { impacts: it.cam_angles.len(), cam_angles_rad: it.cam_angles });

/// Place where the equations hold, or may hold.
#[derive(Clone, Debug)]
pub(super) struct Solved {
    /// Guess close to the solution.
    pub guess: Cycle,
    /// The angle of each impact, rad.
    pub angles: Vec<Interval>,
    /// The velocity of the follower before each impact, m/s.
    pub velocities: Vec<Interval>,
    pub standing: Standing,
}

/// Merges boxes that touch into their hull, until no two have a point in common. The result is sorted along the first side.
pub fn joined<B: AsRef<[Interval]> + AsMut<[Interval]>>(mut boxes: Vec<B>) -> Vec<B> {
    let low = |place: &B| place.as_ref().first().map_or(f64::NAN, |side| side.low());
    let in_order = |boxes: &mut Vec<B>| boxes.sort_by(|one, two| low(one).total_cmp(&low(two)));
    in_order(&mut boxes);
    let mut joined: Vec<B> = Vec::new();
    for mut next in boxes {
        let touches =
            |last: &B, next: &B| last.as_ref().iter().zip(next.as_ref()).all(|(one, two)| one.common(*two).is_some());
        // A hull may touch a box that none of its parts touches.
        while let Some(index) = joined.iter().rposition(|last| touches(last, &next)) {
            let last = joined.swap_remove(index);
            next.as_mut().iter_mut().zip(last.as_ref()).for_each(|(side, other)| *side = side.hull(*other));
        }
        joined.push(next);
    }
    in_order(&mut joined);
    joined
}
