//! Orbits of twice the period that branch off: at a flip, and at a corner impact or a graze, where the second period may go
//! on otherwise than the first.

use std::f64::consts::TAU;

use nalgebra::DVector;

use super::problem::{Problem, Units};
use super::switch::{self, Exit};
use super::{Branch, Following, Kind};
use crate::orbit::curve::{self, Equations, NoPoint};
use crate::orbit::{Course, Cycle, Family, FamilyError, Impact, PeriodicOrbit};

/// How far from the special point the orbit is that is given, of the longest step.
const FIRST: f64 = 0.02;

/// The orbit of twice the period next to a special point of a branch, and the value of what is followed; `None` where there
/// is none.
pub(super) fn at(
    family: &Family,
    branch: &Branch,
    index: usize,
    following: &Following,
) -> Option<(f64, PeriodicOrbit)> {
    let at = branch.points.get(index)?;
    let Course::Impacts(cycle) = &at.orbit.course else { return None };
    let (machine, _) = family.machine(&[at.value]).ok()?;
    let exit = match at.special?.kind {
        Kind::Flip => None,
        Kind::Corner { impact, segment, .. } => {
            Some(Exit::Corner { impact, past_end: cycle.impacts[impact].segment != segment })
        }
        Kind::Graze { .. } => Some(touch(branch, index, cycle)?),
        _ => return None,
    };
    let twice = cycle.twice();
    let pattern = match exit {
        None => twice.clone(),
        Some(exit) => switch::beyond(exit, &twice, &machine)?,
    };
    let spans = [following.range[1] - following.range[0]];
    let problem = Problem::new(family, &pattern, Units::of(&pattern, &machine), &spans, None);
    let from = problem.unknowns(&pattern, &machine, &[at.value]);
    let along = match exit {
        None => apart(&problem, &from),
        Some(exit) => switch::direction(exit, &twice, &problem, &from),
    };
    let point = curve::step(&problem, &from, &along.ok()?, FIRST * following.longest_step).ok()?;
    let (cycle, machine, _) = problem.unpack(&point.unknowns).ok()?;
    let (cycle, residual) = cycle.closed(&machine).ok()?;
    let is_orbit = matches!(cycle.departure(&machine), Ok(None)) && !cycle.repeats_sooner();
    let value = *problem.values(&point.unknowns).first()?;
    is_orbit.then(|| (value, PeriodicOrbit::of_cycle(&machine, cycle, residual)))
}

/// The touch that the orbit at a graze has, from the slowest impact of its neighbour on the branch that has one impact more.
fn touch(branch: &Branch, index: usize, cycle: &Cycle) -> Option<Exit> {
    let count = cycle.impacts.len();
    let beside = [index.checked_sub(1), index.checked_add(1)].into_iter().flatten();
    let mut beside = beside.filter_map(|index| branch.points.get(index)).map(|point| &point.orbit);
    let more = beside.find(|orbit| orbit.revolutions == cycle.revolutions && orbit.impacts().count() == count + 1)?;
    let approach = |event: &&crate::simulate::Event| event.cam_velocity - event.velocity_before;
    let slowest = more.impacts().min_by(|one, two| approach(one).total_cmp(&approach(two)))?;
    let since = |impact: &Impact| {
        let turns = slowest.revolution as f64 - impact.revolution as f64;
        (turns * TAU + slowest.cam_angle - impact.cam_angle).rem_euclid(cycle.revolutions as f64 * TAU)
    };
    let flights = cycle.impacts.iter().map(since).enumerate();
    let (impact, turned) = flights.min_by(|one, two| one.1.total_cmp(&two.1))?;
    Some(Exit::Touch { impact, turned })
}

/// The unit direction from a flip in which the two halves of a period part.
///
/// The solutions that the equations see least there are the short orbits, whose halves move alike, and those of twice the
/// period, whose halves move against each other.
fn apart(problem: &Problem<'_>, at: &DVector<f64>) -> Result<DVector<f64>, NoPoint<FamilyError>> {
    let jacobian = problem.jacobian(at)?;
    let half = (at.len() - 1) / 2;
    // J on halves that move against each other: (J_1 - J_2) d = 0 for d of the first half.
    let against = jacobian.columns(0, half) - jacobian.columns(half, half);
    let svd = against.svd(false, true);
    let rows = svd.v_t.ok_or(NoPoint::NotClosed)?;
    let values = svd.singular_values.iter().enumerate();
    let least = values.min_by(|one, two| one.1.total_cmp(two.1)).map_or(0, |(index, _)| index);
    let first = rows.row(least);
    let entry = |index: usize| match index {
        _ if index < half => first[index],
        _ if index < 2 * half => -first[index - half],
        _ => 0.0,
    };
    let direction = DVector::from_fn(at.len(), |index, _| entry(index));
    let length = direction.norm();
    if length.is_finite() && length > 0.0 { Ok(direction / length) } else { Err(NoPoint::NotClosed) }
}
