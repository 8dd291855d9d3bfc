//! Guesses at corner impacts of orbits with several impacts: where the branches of a range of speeds pass a corner.
//!
//! Branches are found by searches at some speeds, which may miss orbits: what is yielded here need not be all.

use super::pinned::Candidate;
use crate::cam::{Cam, Side};
use crate::model::{Model, Study};
use crate::orbit::branch::{BranchPoint, Kind, corner_impacts, survey};
use crate::orbit::{Course, Search};

/// Impacts in a revolution of the orbits that are looked at: with more a follower is about to chatter, and its last hops
/// are too short for the cam to be continued past a corner among them, as the estimators need.
pub const MOST_IMPACTS: usize = 12;

/// The guesses, and what was looked at.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Candidates {
    /// Each once or more.
    pub list: Vec<Candidate>,
    /// Speeds at which orbits were searched for, rpm.
    pub speeds: Vec<f64>,
    /// Branches of orbits that were found there.
    pub branches: usize,
    /// The first search or branch that ended with an error, if any did.
    pub failed: Option<String>,
}

/// Guesses over a range of speeds, for orbits of several impacts in `revolutions`.
pub fn candidates(model: &Model, cam: &Cam, range: Study, revolutions: u64) -> Candidates {
    let wanted = Search { revolutions, impacts: None };
    match survey(model, [range.rpm_min, range.rpm_max], &wanted) {
        Ok(found) => Candidates {
            list: corner_impacts(&found.branches).iter().filter_map(|point| candidate(cam, point)).collect(),
            speeds: found.speeds,
            branches: found.branches.len(),
            failed: found.failed,
        },
        Err(error) => Candidates { failed: Some(error.to_string()), ..Candidates::default() },
    }
}

/// The corner impact of a branch as a guess, if it is one of several impacts.
fn candidate(cam: &Cam, point: &BranchPoint) -> Option<Candidate> {
    let special = point.special?;
    let (Kind::Corner { contact, segment, jump_order }, Course::Impacts(cycle)) = (special.kind, &point.orbit.course)
    else {
        return None;
    };
    if cycle.contacts.len() < 2 || cycle.contacts.len() > MOST_IMPACTS * cycle.revolutions as usize {
        return None;
    }
    let corner = *cam.corners().iter().find(|corner| corner.segment == segment)?;
    // Where the velocity jumps, both sides have an orbit on the corner, at speeds of their own.
    let is_before = cycle.contacts[contact].segment != segment;
    let side = if jump_order == 1 && is_before { Side::Minus } else { Side::Plus };
    Some(Candidate { cycle: cycle.clone(), contact, corner, side, rpm: point.rpm })
}
