//! The range of values over which a periodic orbit is stable, with the event that ends it on either side, found along the orbit's branch.

use super::by_runs;
use super::transition::{Cause, Transition};
use crate::orbit::branch::{self, Branch, BranchPoint, End, Following, SpecialKind};
use crate::orbit::long_run::Budget;
use crate::orbit::runs::{LongRuns, RunOutcome};
use crate::orbit::symmetry;
use crate::orbit::{OrbitError, PeriodicOrbit, Stability};
use crate::study::survey::{Over, RunError};

/// A part of a branch with stable orbits of equal numbers of revolutions and impacts.
#[derive(Clone, Debug, PartialEq)]
pub struct StableRange {
    /// The orbits, by rising value.
    points: Vec<BranchPoint>,
    /// Transitions at the lower and the upper end; none where the branch was followed no further.
    pub ends: [Option<Transition>; 2],
}

/// Distance that branches are followed beyond the known orbits: a fraction of the value, and a number of grid steps.
const BEYOND: (f64, f64) = (0.02, 3.0);

/// Returns the settings for following branches over a range.
fn following(over: &Over<'_>, range: [f64; 2]) -> Following {
    /// Longest step, as a part of the range or of a radian of an impact's angle.
    const STEP: f64 = 0.05;
    /// Most points in either direction.
    const MOST: usize = 400;
    Following { parameter: over.parameter.clone(), range, longest_step: STEP, most_points: MOST }
}

impl StableRange {
    /// Finds the stable range through a stable orbit at a value; the branch is followed over `range`.
    fn through(over: &Over<'_>, value: f64, orbit: &PeriodicOrbit, range: [f64; 2]) -> Result<Self, OrbitError> {
        let branch = Branch::at(&over.family, value, orbit, &following(over, range))?;
        let is_here = |point: &BranchPoint| point.value == value && point.orbit == *orbit;
        let here = branch.points.iter().position(is_here).unwrap_or_default();
        let (before, after) = branch.points.split_at(here);
        let [mut backward, mut forward] = [Vec::new(), Vec::new()];
        let middle = &after[..after.len().min(1)];
        let first = walk(over, middle, before.iter().rev(), &branch.ends[0], &mut backward);
        // A closed branch was followed backward alone, all the way round.
        let onward = if branch.ends[0] == End::Closed { before } else { after.get(1..).unwrap_or_default() };
        let last = walk(over, middle, onward.iter(), &branch.ends[1], &mut forward);
        let mut ends = [first, last];
        for (end, points) in ends.iter_mut().zip([&mut backward, &mut forward]) {
            located(over, end, points);
        }
        backward.reverse();
        let mut points = [backward, middle.to_vec(), forward].concat();
        if points.first().zip(points.last()).is_some_and(|(first, last)| first.value > last.value) {
            points.reverse();
            ends.reverse();
        }
        Ok(Self { points, ends })
    }

    /// Finds the stable range through a stable orbit at a value. The orbit is known from `low` to `high` at values `step` apart. Its
    /// branch is followed to both ends, if they are not far.
    pub fn all(
        over: &Over<'_>,
        value: f64,
        orbit: &PeriodicOrbit,
        [low, high]: [f64; 2],
        step: f64,
    ) -> Result<Self, OrbitError> {
        /// Number of times that the distance is extended by a factor of four, if the orbit does not end.
        const LONGER: i32 = 3;
        let mut longer = 0;
        loop {
            let beyond = (BEYOND.0 * high.abs() + BEYOND.1 * step) * 4.0_f64.powi(longer);
            // A range above 0 stays above 0.
            let lowest = if low > 0.0 { (low - beyond).max(0.5 * low) } else { low - beyond };
            let range = Self::through(over, value, orbit, [lowest, high + beyond])?;
            if longer == LONGER || range.ends.iter().all(Option::is_some) {
                return Ok(range);
            }
            longer += 1;
        }
    }

    /// Returns stable orbits next to the ends of this range, each with its value: orbits of twice the period that branch off, and orbits on
    /// which runs settle just beyond.
    pub fn beyond(&self, over: &Over<'_>, step: f64) -> Vec<(f64, PeriodicOrbit)> {
        let mut found = self.doubled(over, step);
        found.extend(self.run_to(over, step));
        found
    }

    /// Returns the stable orbits of twice the period that branch off at the ends. Runs miss one that exists only between few values.
    fn doubled(&self, over: &Over<'_>, step: f64) -> Vec<(f64, PeriodicOrbit)> {
        let points = self.ends.iter().flatten().filter_map(|change| change.point.as_deref());
        let at = |point: &BranchPoint| {
            let alone = Branch { points: vec![point.clone()], ends: [End::Range, End::Range] };
            // One step, in units of the value; at a value of 0, of the grid's step.
            let far = point.value.abs().max(step);
            branch::doubled(&over.family, &following(over, [-far, far]), &[alone])
        };
        points.flat_map(at).filter(|(_, orbit)| !is_unstable(orbit)).collect()
    }

    /// Returns the orbits on which runs from the ends settle just beyond.
    fn run_to(&self, over: &Over<'_>, step: f64) -> Vec<(f64, PeriodicOrbit)> {
        /// Distances beyond the end, in steps.
        const FAR: [f64; 3] = [1e-1, 1e-2, 1e-3];
        /// Revolutions within which a run must settle on an orbit.
        const WAITED: u64 = 10_000;
        /// Longest period looked for. Longer periods follow each other in ever shorter ranges.
        const LONGEST: u64 = 8;
        let ends = [(-1.0, self.points.first()), (1.0, self.points.last())].into_iter().zip(&self.ends);
        let ended = ends.filter(|(_, change)| change.as_ref().is_some_and(Transition::is_located));
        let starts = ended.filter_map(|((onward, point), _)| Some((onward, point?)));
        let settled = |(onward, point, far): (f64, &BranchPoint, f64)| -> Result<_, RunError> {
            let value = point.value + onward * far * step;
            let machine = over.machine(value)?;
            let settling = LongRuns::new(&machine, Budget { longest: LONGEST, ..Budget::SURVEY })?;
            let impact = point.orbit.impacts().next();
            // The start is on the cam, wherever that is at this value.
            let Some(impact) = impact else { return Ok(None) };
            let mut motion = machine.start_on_cam(impact.cam_angle, impact.velocity_after - impact.cam_velocity)?;
            Ok(match settling.run(&mut motion, WAITED)? {
                RunOutcome::Arrives(orbit) => Some((value, orbit)),
                _ => None,
            })
        };
        let starts = starts.flat_map(|(onward, point)| FAR.map(|far| (onward, point, far)));
        // A run that fails has no orbit to add.
        starts.filter_map(|start| settled(start).ok().flatten()).collect()
    }

    /// Returns the orbit of the range that is nearest to a value; none if the value is beyond its ends.
    pub fn near(&self, value: f64) -> Option<&PeriodicOrbit> {
        let apart = |point: &&BranchPoint| (point.value - value).abs();
        let inside = self.points.first().is_some_and(|first| first.value <= value)
            && self.points.last().is_some_and(|last| value <= last.value);
        let nearest = self.points.iter().min_by(|one, two| apart(one).total_cmp(&apart(two)));
        nearest.filter(|_| inside).map(|point| &point.orbit)
    }

    /// Orbits of the middle half of the range, each with its value. No other range begins or ends with one of these.
    pub fn middle(&self) -> impl Iterator<Item = (f64, &PeriodicOrbit)> {
        let middle = self.points.iter().skip(self.points.len() / 4).take(self.points.len().div_ceil(2));
        middle.map(|point| (point.value, &point.orbit))
    }

    /// Orbits with an impact at a corner where the acceleration jumps.
    pub fn corner_impacts(&self) -> impl Iterator<Item = &BranchPoint> {
        let is_corner = |point: &&BranchPoint| {
            point.special.is_some_and(|special| matches!(special.kind, SpecialKind::Corner { jump_order: 2, .. }))
        };
        self.points.iter().filter(is_corner)
    }

    /// Lowest and highest value.
    pub fn ends(&self) -> [f64; 2] {
        [self.points.first(), self.points.last()].map(|point| point.map_or(f64::NAN, |point| point.value))
    }
}

/// Whether an orbit is certainly unstable. Next to a flip or a fold, stable orbits are neutral within their error.
fn is_unstable(orbit: &PeriodicOrbit) -> bool {
    orbit.judgement.stability == Stability::Unstable
}

/// Locates a symmetry breaking at an end where the branch turns back or touches a crossing branch, by its own equations. The last point
/// is then that end.
fn located(over: &Over<'_>, end: &mut Option<Transition>, points: &mut Vec<BranchPoint>) {
    let Some(change) = end.as_mut().filter(|change| matches!(change.cause, Cause::Fold | Cause::Runs)) else { return };
    let Some(cycle) = points.last().and_then(|point| point.orbit.cycle()) else { return };
    if let Some((value, orbit)) = symmetry::breaking(|value| over.machine(value).ok(), change.value(), cycle) {
        let place = over.place(value);
        let point = BranchPoint { rpm: place.rpm, value, orbit, held: None, special: None };
        *change = Transition::at(place, Cause::SymmetryBreaking);
        // This point was taken for the end.
        points.retain(|it| it.special.is_none());
        points.push(point);
    }
}

/// Collects the points while orbits are stable and the value moves one way. Returns the transition that ends this. The numbers of revolutions
/// and impacts change only at a graze or a flip, which ends it.
fn walk<'a>(
    over: &Over<'_>,
    middle: &[BranchPoint],
    points: impl Iterator<Item = &'a BranchPoint>,
    end: &End,
    taken: &mut Vec<BranchPoint>,
) -> Option<Transition> {
    let of_point = |point: &BranchPoint| Transition::of_point(&over.parameter, point);
    let ended = |pending: Option<&BranchPoint>, between, taken: &mut Vec<BranchPoint>| {
        taken.extend(pending.cloned());
        pending.map_or_else(|| by_runs(over, between), of_point)
    };
    let mut last = middle.first()?.value;
    // If the value turns back without a change of stability, the orbits beyond have lost a symmetry.
    let (begun, mut onward) = (last, 0.0);
    let mut pending: Option<&BranchPoint> = None;
    // A smooth corner changes nothing that a stable orbit depends on.
    let passed = |point: &&BranchPoint| point.special.is_some_and(|special| special.kind.is_smooth_corner());
    for point in points.filter(|point| !passed(point)) {
        if point.special.is_some() {
            let is_corner =
                matches!(point.special, Some(special) if matches!(special.kind, SpecialKind::Corner { .. }));
            // Two special points in a row, or one that ends the motion in any case.
            if let Some(before) = pending.or((!is_corner).then_some(point)) {
                taken.push(before.clone());
                return Some(of_point(before));
            }
            pending = Some(point);
            continue;
        }
        if is_unstable(&point.orbit) {
            return Some(ended(pending, [last, point.value], taken));
        }
        if onward == 0.0 {
            onward = point.value - begun;
        }
        if (point.value - last) * onward < 0.0 {
            return Some(ended(pending, [last, point.value], taken));
        }
        taken.extend(pending.take().cloned());
        taken.push(point.clone());
        last = point.value;
    }
    taken.extend(pending.cloned());
    match (pending, end) {
        (Some(point), _) => Some(of_point(point)),
        (None, End::Range | End::Clear | End::Closed | End::Continuum | End::MostPoints) => None,
        (None, _) => Some(Transition::at(over.place(last), Cause::Runs)),
    }
}
