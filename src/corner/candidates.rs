//! Corner impacts of orbits with several impacts, found where branches of orbits pass a corner.
//!
//! Branches are found by searches at the speeds of a grid. These may miss orbits, so the list may be incomplete.
//! The list does not depend on the range: a part of a range gives that part of the list.

use std::f64::consts::TAU;

use super::confirm::Candidate;
use super::corner_impact::Way;
use super::period_equation::at_corner;
use crate::cam::{Cam, Side};
use crate::model::{Model, Study};
use crate::orbit::branch::{BranchPoint, MetPoints, SpecialKind, special_points};
use crate::orbit::{Course, Impact, Search};
use crate::progress::Watch;
use crate::tolerance;

/// Largest number of impacts per revolution of the orbits examined; with more, a follower is about to chatter.
pub const MOST_IMPACTS: usize = 12;
/// Smallest distance of another impact from the impact on the corner, rad. The estimators continue the cam past the corner by less than
/// half of it, and halve that reach down to twice the least.
pub const NEAREST_OTHER: f64 = 4.0 * tolerance::LEAST_REACH.value;

/// Record of the search: its speeds, branches and first failure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SearchedBranches {
    /// Speeds at which orbits were searched for, rpm.
    pub speeds: Vec<f64>,
    /// Branches of orbits that were found there.
    pub branches: usize,
    /// First search or branch that ended with an error, if any did.
    pub failed: Option<String>,
}

/// Finds corner impacts of orbits with several impacts in `revolutions`, over a range of speeds.
pub fn candidates(
    model: &Model,
    cam: &Cam,
    range: Study,
    revolutions: u64,
    watch: &dyn Watch,
) -> (Vec<Candidate>, SearchedBranches) {
    let wanted = Search { revolutions, impacts: None };
    let is_corner = |kind| matches!(kind, SpecialKind::Corner { .. });
    match special_points(model, [range.rpm_min, range.rpm_max], &wanted, is_corner, watch) {
        Ok(found) => {
            let candidates = found.points.iter().filter_map(|point| candidate(cam, point)).collect();
            let MetPoints { speeds, branches, failed, .. } = found;
            (candidates, SearchedBranches { speeds, branches, failed: failed.map(|error| error.to_string()) })
        }
        Err(error) => (Vec::new(), SearchedBranches { failed: Some(error.to_string()), ..SearchedBranches::default() }),
    }
}

/// Corner impact that a branch passes; `None` for an orbit with one impact.
fn candidate(cam: &Cam, point: &BranchPoint) -> Option<Candidate> {
    on_branch(cam, point).filter(|candidate| candidate.cycle.impacts.len() > 1)
}

/// Corner impact that a branch passes; `None` if its follower is about to chatter.
pub(crate) fn on_branch(cam: &Cam, point: &BranchPoint) -> Option<Candidate> {
    let special = point.special?;
    let (SpecialKind::Corner { impact, segment, jump_order }, Course::Impacts(cycle)) =
        (special.kind, &point.orbit.course)
    else {
        return None;
    };
    let chatters =
        cycle.impacts.len() > MOST_IMPACTS * cycle.revolutions as usize || cycle.nearest_other(impact) < NEAREST_OTHER;
    if chatters {
        return None;
    }
    let corner = *cam.corners().iter().find(|corner| corner.segment == segment)?;
    let old = &cycle.impacts[impact];
    // At a corner of velocity each side has an orbit with an impact on the corner, at its own speed: one on the segment before it, one on
    // the segment after it.
    let on = &cam.segments()[old.segment];
    let is_before = old.cam_angle > on.start.midpoint(on.end);
    let side = if jump_order == 1 && is_before { Side::Minus } else { Side::Plus };
    let on_corner = at_corner(cam, &corner, side, 0, old.velocity_before);
    // The angle may belong to the revolution before or after.
    let turns = ((old.cam_angle - on_corner.cam_angle) / TAU).round() as i64;
    let revolution = old.revolution + turns;
    let mut cycle = cycle.clone();
    cycle.impacts[impact] = Impact { revolution, ..on_corner };
    let [slow, fast] = special.bracket.map(|rpm| 60.0 / rpm);
    let (period, bracket) = (60.0 / point.rpm, [fast, slow]);
    Some(Candidate { cycle, impact, corner, side, period, bracket, residual: special.residual, way: Way::Branch })
}
