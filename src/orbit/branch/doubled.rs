//! Orbits on other branches next to special points. They have twice the period at a flip, and at a corner impact or a graze, where the
//! second period may differ from the first. Where a symmetry is lost, they are on the branch that crosses.

use nalgebra::DVector;

use super::problem::{BranchScales, Problem};
use super::switch::{self, Exit};
use super::{Branch, Following, SpecialKind};
use crate::cam;
use crate::orbit::curve::{self, Equations, NoPoint};
use crate::orbit::cycle::lift_size;
use crate::orbit::{Course, Cycle, Family, FamilyError, Impact, PeriodicOrbit};
use crate::simulate::Machine;
use crate::tolerance;

/// Distance of a returned orbit from the special point, in units of the longest step.
const FIRST: f64 = 0.1;

/// Orbits of twice the period next to the special points of branches, with the values of the followed parameter.
pub fn doubled(family: &Family, following: &Following, branches: &[Branch]) -> Vec<(f64, PeriodicOrbit)> {
    let points = branches.iter().flat_map(|branch| (0..branch.points.len()).map(move |index| (branch, index)));
    points.flat_map(|(branch, index)| at(family, following, branch, index)).collect()
}

/// Orbits on the branches that cross others, next to the crossings, with the values of the followed parameter.
pub fn crossing(family: &Family, following: &Following, branches: &[Branch]) -> Vec<(f64, PeriodicOrbit)> {
    let pairs = branches.iter().flat_map(|branch| branch.points.windows(2));
    let met = pairs.filter_map(|pair| {
        let [before, point] = pair else { return None };
        let (SpecialKind::Branching, Course::Impacts(cycle)) = (point.special?.kind, &point.orbit.course) else {
            return None;
        };
        let Course::Impacts(last) = &before.orbit.course else { return None };
        // A touch or a halved period changes the number of impacts between the two. Then there is no direction to come from.
        if last.impacts.len() != cycle.impacts.len() {
            return None;
        }
        let (machine, _) = family.machine(&[before.value]).ok()?;
        let start = |problem: &Problem<'_>, at: &DVector<f64>| {
            across(problem, at, &(at - problem.unknowns(last, &machine, &[before.value])))
        };
        stepped(family, following, point.value, cycle, start)
    });
    met.collect()
}

/// Orbits of twice the period next to one special point.
fn at(family: &Family, following: &Following, branch: &Branch, index: usize) -> Vec<(f64, PeriodicOrbit)> {
    let point = &branch.points[index];
    let (Some(special), Course::Impacts(cycle)) = (point.special, &point.orbit.course) else { return Vec::new() };
    let Ok((machine, _)) = family.machine(&[point.value]) else { return Vec::new() };
    let exits = match special.kind {
        SpecialKind::Flip => vec![None],
        SpecialKind::Corner { segment, .. } => on_corner(cycle, &machine, segment).map(Some).collect(),
        SpecialKind::Graze { turned, .. } => switch::touch(cycle, turned).into_iter().map(Some).collect(),
        _ => Vec::new(),
    };
    exits.into_iter().filter_map(|exit| beyond(family, following, point.value, &cycle.twice(), exit)).collect()
}

/// Returns the orbit next to `twice`, an orbit run twice, one period of which leaves its cycle by `exit`. A flip has no exit. `None` if
/// there is no such orbit.
fn beyond(
    family: &Family,
    following: &Following,
    value: f64,
    twice: &Cycle,
    exit: Option<Exit>,
) -> Option<(f64, PeriodicOrbit)> {
    let pattern = match exit {
        None => twice.clone(),
        Some(exit) => switch::beyond(exit, twice, &family.machine(&[value]).ok()?.0)?,
    };
    stepped(family, following, value, &pattern, |problem, from| match exit {
        None => apart(problem, from),
        Some(exit) => switch::direction(exit, twice, problem, from),
    })
}

/// Returns the orbit one step along a direction from a cycle at a value.
fn stepped(
    family: &Family,
    following: &Following,
    value: f64,
    cycle: &Cycle,
    direction: impl Fn(&Problem<'_>, &DVector<f64>) -> Result<DVector<f64>, NoPoint<FamilyError>>,
) -> Option<(f64, PeriodicOrbit)> {
    let (machine, _) = family.machine(&[value]).ok()?;
    let spans = [following.range[1] - following.range[0]];
    let problem = Problem::new(family, cycle, BranchScales::of(cycle, &machine), &spans, None);
    let from = problem.unknowns(cycle, &machine, &[value]);
    let along = direction(&problem, &from).ok()?;
    let point = curve::step(&problem, &from, &along, FIRST * following.longest_step).ok()?;
    // The point is not refined with the value fixed: Newton's method could return to the known orbit.
    let (cycle, machine, _) = problem.unpack(&point.unknowns).ok()?;
    let residual = cycle.residual(&machine).amax() / lift_size(&machine);
    let is_orbit = matches!(cycle.departure(&machine), Ok(None));
    let value = *problem.values(&point.unknowns).first()?;
    is_orbit.then(|| (value, PeriodicOrbit::of_cycle(&machine, cycle, residual)))
}

/// Exits over the corner that starts `segment`, one for each impact on it: where branches meet there may be several.
fn on_corner(cycle: &Cycle, machine: &Machine, segment: usize) -> impl Iterator<Item = Exit> {
    let segments = machine.cam().segments();
    let corner = segments[segment].start;
    cycle.impacts.iter().enumerate().filter_map(move |(impact, Impact { segment: on, cam_angle, .. })| {
        let past_end = *cam_angle > segments[*on].start.midpoint(segments[*on].end);
        let is_there = cam::apart(*cam_angle, corner) <= tolerance::SAME_ORBIT.value;
        is_there.then_some(Exit::Corner { impact, past_end })
    })
}

/// Unit direction from a flip in which the two halves of a period separate.
///
/// The equations are nearly met there in two directions. In the direction of the short orbits the two halves move alike. In the direction
/// of the orbits of twice the period they move against each other.
fn apart(problem: &Problem<'_>, at: &DVector<f64>) -> Result<DVector<f64>, NoPoint<FamilyError>> {
    let (_, jacobian) = problem.linear(at)?;
    // Two unknowns for each impact, and one more.
    let half = at.len() / 2;
    // J on halves that move against each other: (J_1 - J_2) d = 0 for d of the first half.
    let against = jacobian.columns(0, half) - jacobian.columns(half, half);
    let [first] = curve::least_seen(against).ok_or(NoPoint::NotClosed)?;
    let entry = |index: usize| match index {
        _ if index < half => first[index],
        _ if index < 2 * half => -first[index - half],
        _ => 0.0,
    };
    curve::unit(DVector::from_fn(at.len(), |index, _| entry(index)))
}

/// Unit direction across the known branch at a crossing, in the plane of the two directions in which the equations change least. The known
/// branch continues `along`.
fn across(
    problem: &Problem<'_>,
    at: &DVector<f64>,
    along: &DVector<f64>,
) -> Result<DVector<f64>, NoPoint<FamilyError>> {
    let (_, jacobian) = problem.linear(at)?;
    let [one, two] = curve::least_seen(jacobian).ok_or(NoPoint::NotClosed)?;
    curve::unit(&one * two.dot(along) - &two * one.dot(along))
}
