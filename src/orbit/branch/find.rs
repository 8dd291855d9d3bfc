//! Finds the branches through given orbits and what branches off from them. Also finds the branches of a range of speeds, and their special
//! points, which are the same for any wider range.
//!
//! Searches for orbits run at the speeds of a grid. The grid and its cells do not depend on the range. The special points of a cell are
//! found by searches and branches in a window around the cell, and a range is cut out of whole cells.

use std::borrow::Borrow;
use std::ops::Range;

use rayon::prelude::*;

use super::{Branch, BranchPoint, Following, SpecialKind, crossing, doubled};
use crate::cam::Cam;
use crate::elementary;
use crate::model::Model;
use crate::orbit::{Family, FamilyError, OrbitError, Parameter, PeriodicOrbit, Search, search};
use crate::progress::{Pieces, Unwatched, Watch};
use crate::simulate::{Machine, SimulateError, angular_velocity};
use crate::tolerance;

/// Ratio of each speed of the grid to the one before it.
#[doc(hidden)]
pub const GRID_RATIO: f64 = 1.02;
/// Number of grid speeds in a cell.
const CELL: i32 = 8;
/// Number of grid speeds by which a cell's window extends beyond either end of the cell. A branch that no search meets in the cell may
/// still be met there.
const MARGIN: i32 = 2;
/// The longest step along a branch.
const STEP: f64 = 0.02;
/// Most points of a branch in either direction; beyond, it winds through ever more impacts.
const MOST_POINTS: usize = 1000;

/// Branches, and whether all could be followed.
#[derive(Clone, Debug, Default, PartialEq)]
#[doc(hidden)]
pub struct FoundBranches {
    /// The branches found, each once.
    pub branches: Vec<Branch>,
    /// Error of the first search or branch that failed, if any did.
    pub failed: Option<OrbitError>,
}

impl FoundBranches {
    /// Follows the branch through each orbit that is on no known branch. Each orbit comes with its value of the parameter, and is one piece
    /// of the work.
    pub fn follow(
        &mut self,
        family: &Family,
        following: &Following,
        orbits: impl IntoIterator<Item = (f64, impl Borrow<PeriodicOrbit>)>,
        pieces: &Pieces<'_>,
    ) {
        for (value, orbit) in orbits {
            let orbit = orbit.borrow();
            let is_new = !self.branches.iter().any(|branch| branch.holds(value, orbit));
            match pieces.each(|| is_new.then(|| Branch::at(family, value, orbit, following))) {
                Some(Ok(branch)) => self.branches.push(branch),
                Some(Err(error)) => self.fail(error),
                None => {}
            }
        }
    }

    fn fail(&mut self, error: impl Into<OrbitError>) {
        self.failed.get_or_insert(error.into());
    }
}

/// The special points on the branches of a range of speeds, and the extent of the search.
#[derive(Clone, Debug, Default, PartialEq)]
#[doc(hidden)]
pub struct MetPoints {
    /// Points by rising speed, each once.
    pub points: Vec<BranchPoint>,
    /// Speeds at which orbits were searched for, rpm.
    pub speeds: Vec<f64>,
    /// Number of branches followed, each counted once for each window that it passes.
    pub branches: usize,
    /// Error of the first search or branch that failed, if any did.
    pub failed: Option<OrbitError>,
}

/// Start of step `index` of the grid, rpm; the step's speed is half-way to the next one.
fn grid(index: f64) -> f64 {
    elementary::powf(GRID_RATIO, index)
}

/// Index of the grid step that contains a speed, rpm.
fn step_at(rpm: f64) -> i32 {
    (elementary::ln(rpm) / elementary::ln(GRID_RATIO)).floor() as i32
}

/// Result of a search at one speed.
type Orbits = Result<Vec<PeriodicOrbit>, SimulateError>;

/// Results of searches at speeds, rpm, of the grid.
struct Searched<'a> {
    model: &'a Model,
    speeds: Vec<f64>,
    /// Searches, each over twice as many revolutions as the one before it, with the result at each speed.
    orbits: Vec<(Search, Vec<Orbits>)>,
}

impl<'a> Searched<'a> {
    /// Searches at the speeds in `steps` for the wanted orbits, and for those of a half, a quarter and so on of their revolutions, from
    /// which they may have branched off.
    fn at(model: &'a Model, steps: Range<i32>, wanted: &Search, watch: &dyn Watch) -> Result<Self, FamilyError> {
        let machine = Machine::new(Cam::new(model)?, &model.follower, angular_velocity(1.0));
        let speeds: Vec<f64> = steps.map(|step| grid(f64::from(step) + 0.5)).collect();
        let halvings = wanted.revolutions.trailing_zeros();
        let pieces = Pieces::new(watch, "periodic orbits at speeds of a grid", speeds.len() * (halvings as usize + 1));
        let at = |wanted: Search| {
            let one = |rpm: &f64| search(&machine.at_speed(angular_velocity(*rpm)), &wanted);
            (wanted, speeds.par_iter().map(|rpm| pieces.each(|| one(rpm))).collect())
        };
        let halved =
            (1..=halvings).rev().map(|times| Search { revolutions: wanted.revolutions >> times, impacts: None });
        let orbits = halved.chain([*wanted]).map(at).collect();
        Ok(Self { model, speeds, orbits })
    }

    /// Number of orbits found between two speeds, rpm.
    fn count(&self, range: [f64; 2]) -> usize {
        let all = self.orbits.iter().flat_map(|(_, orbits)| self.speeds.iter().zip(orbits));
        let inside = all.filter(|(rpm, _)| (range[0]..=range[1]).contains(*rpm));
        inside.map(|(_, orbits)| orbits.as_ref().map_or(0, Vec::len)).sum()
    }

    /// The branches of the wanted orbits between two speeds, rpm.
    fn branches(&self, range: [f64; 2], pieces: &Pieces<'_>) -> FoundBranches {
        let parameter = Parameter::Speed;
        let mut all = FoundBranches::default();
        let family = match Family::new(self.model, range[0], vec![parameter.clone()]) {
            Ok(family) => family,
            Err(error) => return FoundBranches { failed: Some(error.into()), ..all },
        };
        let following = Following { parameter, range, longest_step: STEP, most_points: MOST_POINTS };
        for (wanted, orbits) in &self.orbits {
            let shorter = std::mem::take(&mut all.branches);
            for (rpm, orbits) in self.speeds.iter().zip(orbits) {
                match orbits {
                    _ if !(range[0]..=range[1]).contains(rpm) => {}
                    Ok(orbits) => {
                        let orbits = orbits.iter().map(|orbit| (*rpm, orbit));
                        all.follow(&family, &following, orbits, pieces);
                    }
                    Err(error) => all.fail(*error),
                }
            }
            let is_wanted = |orbit: &PeriodicOrbit| wanted.impacts.is_none_or(|count| orbit.impacts().count() == count);
            let doubled = doubled(&family, &following, &shorter).into_iter().filter(|(_, orbit)| is_wanted(orbit));
            let found: Vec<_> = doubled.chain(crossing(&family, &following, &all.branches)).collect();
            pieces.more(found.len());
            all.follow(&family, &following, found, pieces);
        }
        all
    }
}

/// Finds the branches of `model` over `range`, rpm, of orbits of `wanted.revolutions` that have `wanted.impacts` where they were found.
///
/// Searches run at the speeds of the grid that are in the range: a branch that none of these meets is missing.
pub fn find_branches(model: &Model, range: [f64; 2], wanted: &Search) -> Result<FoundBranches, FamilyError> {
    Ok(Searched::at(model, step_at(range[0])..step_at(range[1]) + 1, wanted, &Unwatched)?
        .branches(range, &Pieces::new(&Unwatched, "", 0)))
}

/// Finds the special points of some kinds between two speeds, rpm, of orbits of `wanted.revolutions` that have `wanted.impacts` where they
/// were found. Any wider range gives the same points in this one.
#[doc(hidden)]
pub fn special_points(
    model: &Model,
    range: [f64; 2],
    wanted: &Search,
    is_wanted: impl Fn(SpecialKind) -> bool + Sync,
    watch: &dyn Watch,
) -> Result<MetPoints, FamilyError> {
    let [first, last] = range.map(|rpm| step_at(rpm).div_euclid(CELL));
    let searched = Searched::at(model, CELL * first - MARGIN..CELL * (last + 1) + MARGIN, wanted, watch)?;
    let window = |cell: i32| [CELL * cell - MARGIN, CELL * (cell + 1) + MARGIN].map(|step| grid(f64::from(step)));
    let count = (first..=last).map(|cell| searched.count(window(cell))).sum();
    let pieces = Pieces::new(watch, "branches of these orbits", count);
    let of_cell = |cell: i32| {
        let found = searched.branches(window(cell), &pieces);
        let mut points = points_on(&found.branches, &is_wanted);
        points.retain(|point| step_at(point.rpm).div_euclid(CELL) == cell);
        (points, found)
    };
    let cells: Vec<_> = (first..=last).into_par_iter().map(of_cell).collect();
    let mut all = MetPoints { speeds: searched.speeds, ..MetPoints::default() };
    for (points, found) in cells {
        all.points.extend(points.into_iter().filter(|point| range[0] <= point.rpm && point.rpm <= range[1]));
        all.branches += found.branches.len();
        all.failed = all.failed.or(found.failed);
    }
    Ok(all)
}

/// The special points of some kinds on `branches`, each once, by rising speed.
fn points_on(branches: &[Branch], is_wanted: impl Fn(SpecialKind) -> bool) -> Vec<BranchPoint> {
    let kind = |point: &BranchPoint| point.special.map(|special| special.kind);
    let is_met = |point: &&BranchPoint| kind(point).is_some_and(&is_wanted);
    let mut found: Vec<BranchPoint> = Vec::new();
    for point in branches.iter().flat_map(|branch| &branch.points).filter(is_met) {
        let same = |known: &BranchPoint| {
            (known.rpm / point.rpm - 1.0).abs() <= tolerance::SAME_ORBIT.value
                && kind(known).map(|kind| kind.name()) == kind(point).map(|kind| kind.name())
                && known.orbit.is_same(&point.orbit)
        };
        if !found.iter().any(same) {
            found.push(point.clone());
        }
    }
    found.sort_by(|one, two| one.rpm.total_cmp(&two.rpm));
    found
}
