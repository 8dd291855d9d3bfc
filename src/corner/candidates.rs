//! Corner impacts of orbits with several impacts: where the branches of a range of speeds pass a corner.
//!
//! Branches are found by searches at some speeds, which may miss orbits: what is yielded here need not be all.

use std::f64::consts::TAU;

use super::confirm::Candidate;
use super::period_equation::at_corner;
use crate::cam::{Cam, Side};
use crate::model::{Model, Study};
use crate::orbit::branch::{BranchPoint, Kind, corner_impacts, find_branches};
use crate::orbit::{Course, Impact, Search};

/// Impacts in a revolution of the orbits that are looked at: with more a follower is about to chatter, and its last hops
/// are too short for the cam to be continued past a corner among them, as the estimators need.
pub const MOST_IMPACTS: usize = 12;

/// The corner impacts, and what was looked at.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Candidates {
    pub list: Vec<Candidate>,
    /// Speeds at which orbits were searched for, rpm.
    pub speeds: Vec<f64>,
    /// Branches of orbits that were found there.
    pub branches: usize,
    /// The first search or branch that ended with an error, if any did.
    pub failed: Option<String>,
}

/// The corner impacts over a range of speeds of orbits of several impacts in `revolutions`.
pub fn candidates(model: &Model, cam: &Cam, range: Study, revolutions: u64) -> Candidates {
    let wanted = Search { revolutions, impacts: None };
    match find_branches(model, [range.rpm_min, range.rpm_max], &wanted) {
        Ok(found) => Candidates {
            list: corner_impacts(&found.branches).iter().filter_map(|point| candidate(cam, point)).collect(),
            speeds: found.speeds,
            branches: found.branches.len(),
            failed: found.failed,
        },
        Err(error) => Candidates { failed: Some(error.to_string()), ..Candidates::default() },
    }
}

/// The corner impact that a branch passes, if it is one of several impacts.
fn candidate(cam: &Cam, point: &BranchPoint) -> Option<Candidate> {
    let special = point.special?;
    let (Kind::Corner { impact, segment, jump_order }, Course::Impacts(cycle)) = (special.kind, &point.orbit.course)
    else {
        return None;
    };
    if cycle.impacts.len() < 2 || cycle.impacts.len() > MOST_IMPACTS * cycle.revolutions as usize {
        return None;
    }
    let corner = *cam.corners().iter().find(|corner| corner.segment == segment)?;
    // Where the velocity jumps, both sides have an orbit on the corner, at speeds of their own.
    let is_before = cycle.impacts[impact].segment != segment;
    let side = if jump_order == 1 && is_before { Side::Minus } else { Side::Plus };
    let old = &cycle.impacts[impact];
    let on_corner = at_corner(cam, &corner, side, 0, old.velocity_before);
    // The angle may be named by the revolution before or after.
    let turns = ((old.cam_angle - on_corner.cam_angle) / TAU).round() as i64;
    let revolution = old.revolution + turns;
    let mut cycle = cycle.clone();
    cycle.impacts[impact] = Impact { revolution, ..on_corner };
    let [slow, fast] = special.bracket.map(|rpm| 60.0 / rpm);
    let (period, bracket) = (60.0 / point.rpm, [fast, slow]);
    Some(Candidate { cycle, impact, corner, side, period, bracket, residual: special.residual })
}
