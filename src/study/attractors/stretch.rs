//! The range of speeds over which a periodic orbit is stable, with what ends it on either side: by the branch that it is on.

use super::change::{Cause, Change};
use crate::model::Model;
use crate::orbit::branch::{self, Branch, BranchPoint, End, Following, Kind};
use crate::orbit::long_run::Budget;
use crate::orbit::runs::{LongRuns, RunOutcome};
use crate::orbit::symmetry;
use crate::orbit::{Family, OrbitError, Parameter, PeriodicOrbit, Stability};
use crate::simulate::{Machine, SimulateError, angular_velocity};
use crate::study::machine;

/// A part of a branch on which the orbits are stable and have the same numbers of revolutions and impacts.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    /// The orbits, by rising speed.
    points: Vec<BranchPoint>,
    /// What lies at the lower and at the upper end; nothing where the branch was followed no further.
    pub ends: [Option<Change>; 2],
}

/// How far branches are followed beyond where their orbits are known, of the speed, and in steps of the grid.
const BEYOND: (f64, f64) = (0.02, 3.0);

/// How branches are followed over a range, rpm.
fn following(range: [f64; 2]) -> Following {
    /// The longest step, of the range or of a radian of an impact's angle.
    const STEP: f64 = 0.05;
    /// Points in either direction.
    const MOST: usize = 400;
    Following { parameter: Parameter::Speed, range, longest_step: STEP, most_points: MOST }
}

impl Stretch {
    /// Through a stable orbit at `rpm`, followed between `range`, rpm.
    fn through(model: &Model, rpm: f64, orbit: &PeriodicOrbit, range: [f64; 2]) -> Result<Self, OrbitError> {
        let following = following(range);
        let branch = Branch::through(model, rpm, orbit, &following)?;
        let here = branch.points.iter().position(|point| point.rpm == rpm && point.orbit == *orbit).unwrap_or_default();
        let (before, after) = branch.points.split_at(here);
        let [mut backward, mut forward] = [Vec::new(), Vec::new()];
        let middle = &after[..after.len().min(1)];
        let first = walk(middle, before.iter().rev(), &branch.ends[0], &mut backward);
        // What comes back to its start was followed backward alone, all the way round.
        let onward = if branch.ends[0] == End::Closed { before } else { after.get(1..).unwrap_or_default() };
        let last = walk(middle, onward.iter(), &branch.ends[1], &mut forward);
        let mut ends = [first, last];
        for (end, points) in ends.iter_mut().zip([&mut backward, &mut forward]) {
            located(model, end, points);
        }
        backward.reverse();
        let mut points = [backward, middle.to_vec(), forward].concat();
        if points.first().zip(points.last()).is_some_and(|(first, last)| first.rpm > last.rpm) {
            points.reverse();
            ends.reverse();
        }
        Ok(Self { points, ends })
    }

    /// Through a stable orbit at `rpm`, that is known between `known`, rpm, at speeds `step` apart; followed to where it ends on
    /// both sides, if that is not far.
    pub fn all(
        model: &Model,
        rpm: f64,
        orbit: &PeriodicOrbit,
        [low, high]: [f64; 2],
        step: f64,
    ) -> Result<Self, OrbitError> {
        /// How many times that is made longer by a factor of four, where nothing ends the orbit.
        const LONGER: i32 = 3;
        let mut longer = 0;
        loop {
            let beyond = (BEYOND.0 * high + BEYOND.1 * step) * 4.0_f64.powi(longer);
            let stretch = Self::through(model, rpm, orbit, [(low - beyond).max(0.5 * low), high + beyond])?;
            if longer == LONGER || stretch.ends.iter().all(Option::is_some) {
                return Ok(stretch);
            }
            longer += 1;
        }
    }

    /// The stable orbits next to this one's ends, each at a speed, rpm: those of twice the period that branch off, and those that runs come to
    /// right beyond.
    pub fn beyond(&self, model: &Model, machine: &Machine, step: f64) -> Vec<(f64, PeriodicOrbit)> {
        let mut found = self.doubled(model);
        found.extend(self.run_to(machine, step));
        found
    }

    /// The stable orbits of twice the period that branch off at the ends: runs pass over one that lives between few speeds.
    fn doubled(&self, model: &Model) -> Vec<(f64, PeriodicOrbit)> {
        let points = self.ends.iter().flatten().filter_map(|change| change.point.as_deref());
        let at = |point: &BranchPoint| {
            let family = Family::new(model, point.rpm, vec![Parameter::Speed]).ok()?;
            let alone = Branch { points: vec![point.clone()], ends: [End::Range, End::Range] };
            let range = [(1.0 - BEYOND.0) * point.rpm, (1.0 + BEYOND.0) * point.rpm];
            Some(branch::doubled(&family, &following(range), &[alone]))
        };
        points.filter_map(at).flatten().filter(|(_, orbit)| !is_unstable(orbit)).collect()
    }

    /// Those that runs from the ends come to right beyond.
    fn run_to(&self, machine: &Machine, step: f64) -> Vec<(f64, PeriodicOrbit)> {
        /// How far beyond, in steps.
        const FAR: [f64; 3] = [1e-1, 1e-2, 1e-3];
        /// Revolutions in which a run has come to an orbit.
        const WAITED: u64 = 10_000;
        /// The longest period looked for: beyond, one follows the other in ever shorter ranges.
        const LONGEST: u64 = 8;
        let ends = [(-1.0, self.points.first()), (1.0, self.points.last())].into_iter().zip(&self.ends);
        let ended = ends.filter(|(_, change)| change.as_ref().is_some_and(Change::is_located));
        let starts = ended.filter_map(|((onward, point), _)| Some((onward, point?)));
        let settled = |(onward, point, far): (f64, &BranchPoint, f64)| -> Result<_, SimulateError> {
            let rpm = point.rpm + onward * far * step;
            let machine = machine.at_speed(angular_velocity(rpm));
            let settling = LongRuns::new(&machine, Budget { longest: LONGEST, ..Budget::SURVEY })?;
            let impact = point.orbit.impacts().next();
            // From the cam, which at another speed is where it was at this one.
            let Some(impact) = impact else { return Ok(None) };
            let mut motion = machine.start_on_cam(impact.cam_angle, impact.velocity_after - impact.cam_velocity)?;
            Ok(match settling.run(&mut motion, WAITED)? {
                RunOutcome::Arrives(orbit) => Some((rpm, orbit)),
                _ => None,
            })
        };
        let starts = starts.flat_map(|(onward, point)| FAR.map(|far| (onward, point, far)));
        // What cannot be run has no orbit to add.
        starts.filter_map(|start| settled(start).ok().flatten()).collect()
    }

    /// The orbit of the stretch that is nearest in speed to `rpm`; none where that is beyond its ends.
    pub fn near(&self, rpm: f64) -> Option<&PeriodicOrbit> {
        let apart = |point: &&BranchPoint| (point.rpm - rpm).abs();
        let inside = self.points.first().is_some_and(|first| first.rpm <= rpm)
            && self.points.last().is_some_and(|last| rpm <= last.rpm);
        let nearest = self.points.iter().min_by(|one, two| apart(one).total_cmp(&apart(two)));
        nearest.filter(|_| inside).map(|point| &point.orbit)
    }

    /// Orbits of its middle half, which no other stretch begins or ends with, each at its speed, rpm.
    pub fn middle(&self) -> impl Iterator<Item = (f64, &PeriodicOrbit)> {
        let middle = self.points.iter().skip(self.points.len() / 4).take(self.points.len().div_ceil(2));
        middle.map(|point| (point.rpm, &point.orbit))
    }

    /// Its orbits with an impact at a corner where the acceleration jumps.
    pub fn corner_impacts(&self) -> impl Iterator<Item = &BranchPoint> {
        let is_corner = |point: &&BranchPoint| {
            point.special.is_some_and(|special| matches!(special.kind, Kind::Corner { jump_order: 2, .. }))
        };
        self.points.iter().filter(is_corner)
    }

    /// The lowest and the highest speed, rpm.
    pub fn range(&self) -> [f64; 2] {
        [self.points.first(), self.points.last()].map(|point| point.map_or(f64::NAN, |point| point.rpm))
    }
}

/// Whether an orbit is certainly unstable: next to a flip or a fold, stable ones are neutral within their error.
fn is_unstable(orbit: &PeriodicOrbit) -> bool {
    orbit.judgement.stability == Stability::Unstable
}

/// An end at which the branch turns back, or touches one that crosses it, by its own equations where a symmetry is lost there; the last of
/// the points is where it ends.
fn located(model: &Model, end: &mut Option<Change>, points: &mut Vec<BranchPoint>) {
    let Some(change) = end.as_mut().filter(|change| matches!(change.cause, Cause::Fold | Cause::Runs)) else { return };
    let Some(cycle) = points.last().and_then(|point| point.orbit.cycle()) else { return };
    let Ok(near) = machine(model, change.rpm) else { return };
    if let Some((rpm, orbit)) = symmetry::breaking(&near, cycle) {
        let point = BranchPoint { rpm, value: rpm, orbit, held: None, special: None };
        *change = Change { rpm, bracket: [rpm; 2], cause: Cause::SymmetryBreaking, point: None, error: None };
        // What was taken for the end.
        points.retain(|it| it.special.is_none());
        points.push(point);
    }
}

/// Takes the points for as long as orbits are of one kind and the speed goes one way, and returns why that is over.
fn walk<'a>(
    middle: &[BranchPoint],
    points: impl Iterator<Item = &'a BranchPoint>,
    end: &End,
    taken: &mut Vec<BranchPoint>,
) -> Option<Change> {
    let numbers = |orbit: &PeriodicOrbit| (orbit.revolutions, orbit.impacts().count());
    let kind = middle.first().map(|point| numbers(&point.orbit))?;
    let mut last = middle.first()?.rpm;
    // Where the speed turns back without a change of stability, the orbits of the other side are others: those of a symmetry that is lost.
    let (begun, mut onward) = (last, 0.0);
    let mut pending: Option<&BranchPoint> = None;
    // A smooth corner changes nothing that a stable orbit depends on.
    let passed = |point: &&BranchPoint| point.special.is_some_and(|special| special.kind.is_smooth_corner());
    for point in points.filter(|point| !passed(point)) {
        if point.special.is_some() {
            let is_corner = matches!(point.special, Some(special) if matches!(special.kind, Kind::Corner { .. }));
            // Two special points in a row, or one that ends the motion whatever is beyond.
            if let Some(before) = pending.or((!is_corner).then_some(point)) {
                taken.push(before.clone());
                return Some(Change::of_point(before));
            }
            pending = Some(point);
            continue;
        }
        if is_unstable(&point.orbit) || numbers(&point.orbit) != kind {
            let [low, high] = [last.min(point.rpm), last.max(point.rpm)];
            let change = pending.map(Change::of_point);
            taken.extend(pending.cloned());
            return Some(change.unwrap_or(Change::by_runs([low, high])));
        }
        if onward == 0.0 {
            onward = point.rpm - begun;
        }
        if (point.rpm - last) * onward < 0.0 {
            let change = pending.map(Change::of_point);
            taken.extend(pending.cloned());
            return Some(change.unwrap_or(Change::by_runs([last.min(point.rpm), last.max(point.rpm)])));
        }
        taken.extend(pending.take().cloned());
        taken.push(point.clone());
        last = point.rpm;
    }
    taken.extend(pending.cloned());
    match (pending, end) {
        (Some(point), _) => Some(Change::of_point(point)),
        (None, End::Range | End::Clear | End::Closed | End::MostPoints) => None,
        (None, _) => Some(Change { rpm: last, bracket: [last; 2], cause: Cause::Runs, point: None, error: None }),
    }
}
