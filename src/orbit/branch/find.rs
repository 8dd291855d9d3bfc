//! The branches of a range of speeds: those through every orbit that is found at a few of them, each once.

use rayon::prelude::*;

use super::{Branch, BranchPoint, Following, Kind};
use crate::cam::Cam;
use crate::model::Model;
use crate::orbit::{FamilyError, Parameter, Search, search};
use crate::simulate::{Machine, angular_velocity};
use crate::tolerance;

/// Speeds at which orbits are looked for, evenly over the range, its ends left out.
const SPEEDS: usize = 16;
/// The longest step along a branch.
const STEP: f64 = 0.02;
/// Points of a branch in either direction: beyond, it winds through ever more impacts.
const MOST_POINTS: usize = 1000;

/// The branches of a range of speeds, and how they were looked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FoundBranches {
    /// Those that were found, each once.
    pub branches: Vec<Branch>,
    /// Speeds at which orbits were searched for, rpm.
    pub speeds: Vec<f64>,
    /// The first search or branch that ended with an error, if any did.
    pub failed: Option<String>,
}

/// The branches of `model` over `range`, rpm, of orbits of `wanted.revolutions` that have `wanted.impacts` where they were
/// found.
///
/// Found by searches at a few speeds: a branch that none of these meets is missing.
pub fn find_branches(model: &Model, range: [f64; 2], wanted: &Search) -> Result<FoundBranches, FamilyError> {
    let machine = Machine::new(Cam::new(model)?, &model.follower, angular_velocity(range[0]));
    let following = Following { parameter: Parameter::Speed, range, longest_step: STEP, most_points: MOST_POINTS };
    let speed = |index: usize| range[0] + (range[1] - range[0]) * (index as f64 + 0.5) / SPEEDS as f64;
    let mut all = FoundBranches { speeds: (0..SPEEDS).map(speed).collect(), ..FoundBranches::default() };
    let searches = all.speeds.par_iter().map(|rpm| search(&machine.at_speed(angular_velocity(*rpm)), wanted));
    let found: Vec<_> = searches.collect();
    for (rpm, orbits) in all.speeds.clone().into_iter().zip(found) {
        let orbits = orbits.unwrap_or_else(|error| {
            all.failed.get_or_insert(error.to_string());
            Vec::new()
        });
        for orbit in orbits {
            if all.branches.iter().any(|branch| branch.holds(rpm, &orbit)) {
                continue;
            }
            match Branch::through(model, rpm, &orbit, &following) {
                Ok(branch) => all.branches.push(branch),
                Err(error) => {
                    all.failed.get_or_insert(error.to_string());
                }
            }
        }
    }
    Ok(all)
}

/// The corner impacts on `branches`, each once, by rising speed.
pub fn corner_impacts(branches: &[Branch]) -> Vec<BranchPoint> {
    let is_corner =
        |point: &&BranchPoint| matches!(point.special, Some(special) if matches!(special.kind, Kind::Corner { .. }));
    let mut found: Vec<BranchPoint> = Vec::new();
    for point in branches.iter().flat_map(|branch| &branch.points).filter(is_corner) {
        let same = |known: &BranchPoint| {
            (known.rpm - point.rpm).abs() <= tolerance::SAME_ORBIT.value * point.rpm
                && known.orbit.is_same(&point.orbit)
        };
        if !found.iter().any(same) {
            found.push(point.clone());
        }
    }
    found.sort_by(|one, two| one.rpm.total_cmp(&two.rpm));
    found
}
