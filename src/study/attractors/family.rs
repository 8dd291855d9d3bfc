//! Attractors over a range of values: the attractors at each value are matched with those at the next.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::at_value::AttractorsAtValue;
use super::by_runs;
use super::stable_range::StableRange;
use super::transition::{Cause, Transition};
use crate::bracket::{Width, halve, outward};
use crate::orbit::branch::BranchPoint;
use crate::orbit::long_run::{Budget, Kind, LongRun};
use crate::orbit::near::close;
use crate::orbit::{Course, PeriodicOrbit};
use crate::simulate::{Machine, Motion, SimulateError};
use crate::study::survey::{Attractor, Over, RunError, Sample};

/// Property by which a motion at one value is matched with a motion at the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Class {
    /// The follower stays on the cam.
    Stays,
    /// An orbit of so many revolutions and impacts.
    Orbit(u64, u64),
    /// The follower rests and repeats in every revolution, after any number of impacts.
    Rests,
    /// The follower rests without repeating in every revolution, or is chaotic. Whether a period is seen, and which, changes with every
    /// value.
    Irregular,
    /// Undecided within the budget.
    Undecided,
}

impl Class {
    fn of(ending: &LongRun) -> Self {
        match ending {
            LongRun::PermanentContact => Self::Stays,
            LongRun::Orbit(orbit) => Self::Orbit(orbit.revolutions, orbit.impacts().count() as u64),
            LongRun::Sticking(resting) if resting.revolutions == 1 => Self::Rests,
            LongRun::Sticking(_) | LongRun::Chaotic(_) => Self::Irregular,
            LongRun::Undecided(_) => Self::Undecided,
        }
    }
}

/// An attractor over a range of values.
#[derive(Clone, Debug)]
pub struct AttractorFamily {
    class: Class,
    /// For each value of the grid at which the attractor exists, its index among the attractors there.
    pub at: BTreeMap<usize, usize>,
    /// Lower and upper transition; none at the ends of the grid.
    pub ends: [Option<Transition>; 2],
    /// Lowest and highest value.
    pub range: [f64; 2],
    stable: Option<StableRange>,
}

/// A value of the grid.
#[derive(Clone, Debug)]
pub struct GridValue {
    /// The value; for the speed, rpm.
    pub value: f64,
    /// The attractors there, or why there are none.
    pub found: Result<AttractorsAtValue, RunError>,
}

/// The values of the grid, from the lowest up.
pub type ValueGrid = [GridValue];

/// Matches the attractors over a grid of values into families. `step` gives the step of the grid near a value. Ends found by runs outside
/// `range` are bracketed only by neighbouring values of the grid.
pub fn families(
    over: &Over<'_>,
    (grid, range): (&ValueGrid, [f64; 2]),
    step: &(dyn Fn(f64) -> f64 + Sync),
    runs: StartsAndBudget<'_>,
) -> Vec<AttractorFamily> {
    let mut families = linked(over, grid);
    let step = |family: &AttractorFamily| step(family.range[1]);
    families.par_iter_mut().for_each(|family| family.follow(over, grid, step(family)));
    let mut families = joined(over, families);
    beyond(over, &mut families, &step);
    let mut families = joined(over, families);
    families.par_iter_mut().for_each(|family| family.narrow(over, (grid, range), runs));
    families.iter_mut().for_each(|family| family.reach(over, grid));
    families.sort_by(|one, two| one.range[0].total_cmp(&two.range[0]).then(one.range[1].total_cmp(&two.range[1])));
    families
}

/// Links attractors at neighbouring values into families.
fn linked(over: &Over<'_>, grid: &ValueGrid) -> Vec<AttractorFamily> {
    let mut families: Vec<AttractorFamily> = Vec::new();
    for (index, GridValue { value, found }) in grid.iter().enumerate() {
        let (Ok(here), Ok(machine)) = (found, over.machine(*value)) else { continue };
        for (place, attractor) in here.attractors.iter().enumerate() {
            let class = Class::of(&attractor.ending);
            let before = |family: &AttractorFamily| {
                let before = index.checked_sub(1)?;
                let attractor = *family.at.get(&before)?;
                Some(&grid[before].found.as_ref().ok()?.attractors.get(attractor)?.ending)
            };
            let goes_on = |family: &AttractorFamily| {
                let is_free = family.class == class && !family.at.contains_key(&index);
                is_free && before(family).is_some_and(|before| is_next(&machine, before, &attractor.ending))
            };
            // Among several irregular motions, those of one kind belong together.
            let is_alike =
                |family: &AttractorFamily| before(family).is_some_and(|it| it.kind() == attractor.ending.kind());
            let open: Vec<usize> = (0..families.len()).filter(|family| goes_on(&families[*family])).collect();
            let family = open.iter().find(|family| is_alike(&families[**family])).or(open.first()).copied();
            match family.and_then(|family| families.get_mut(family)) {
                Some(family) => {
                    family.at.insert(index, place);
                    family.range[1] = *value;
                }
                None => families.push(AttractorFamily {
                    class,
                    at: BTreeMap::from([(index, place)]),
                    ends: [None, None],
                    range: [*value; 2],
                    stable: None,
                }),
            }
        }
    }
    families
}

/// Whether Newton's method leads from an orbit of one value to the orbit of the next. True for motions that are not orbits.
fn is_next(machine: &Machine, before: &LongRun, now: &LongRun) -> bool {
    match (before, now) {
        (LongRun::Orbit(before), LongRun::Orbit(now)) => {
            continued(machine, before).is_some_and(|orbit| orbit.is_same(now))
        }
        _ => true,
    }
}

/// Returns the orbit of this machine near an orbit of a machine at a neighbouring value.
fn continued(machine: &Machine, orbit: &PeriodicOrbit) -> Option<PeriodicOrbit> {
    match &orbit.course {
        Course::Impacts(cycle) => close(machine, cycle),
        Course::Sticking(_) => None,
        Course::Free => Some(orbit.clone()),
    }
}

/// Adds the stable orbits just beyond the end of another family, and repeats this from their own ends. Several orbits may follow each
/// other between two values of the grid.
fn beyond(over: &Over<'_>, families: &mut Vec<AttractorFamily>, step: &(dyn Fn(&AttractorFamily) -> f64 + Sync)) {
    /// Number of repetitions.
    const DEPTH: usize = 3;
    let holds = |families: &[AttractorFamily], (value, orbit): &(f64, PeriodicOrbit)| {
        families.iter().any(|family| family.holds(over, *value, orbit))
    };
    let mut fresh = 0;
    for _ in 0..DEPTH {
        let next = |ended: &AttractorFamily| {
            let (mut found, step) = (Vec::<((f64, PeriodicOrbit), AttractorFamily)>::new(), step(ended));
            for seen in ended.stable.iter().flat_map(|stable| stable.beyond(over, step)) {
                if holds(families, &seen) || found.iter().any(|(_, it)| holds(std::slice::from_ref(it), &seen)) {
                    continue;
                }
                let (class, range) = (Class::of(&LongRun::Orbit(seen.1.clone())), [seen.0; 2]);
                let mut family =
                    AttractorFamily { class, at: BTreeMap::new(), ends: [None, None], range, stable: None };
                if let Ok(stable) = StableRange::all(over, seen.0, &seen.1, range, step) {
                    family.take(stable);
                    found.push((seen, family));
                }
            }
            found
        };
        let found: Vec<_> = families[fresh..].par_iter().map(next).collect();
        fresh = families.len();
        // One orbit may lie beyond the ends of several families.
        for (seen, family) in found.into_iter().flatten() {
            if !holds(&families[fresh..], &seen) {
                families.push(family);
            }
        }
        if fresh == families.len() {
            return;
        }
    }
}

/// Joins families on the same stable range of a branch: they have orbits in common. Newton's method leads from one to the same orbit on
/// the other if its impacts are on the same segments of the cam. Over rows of a table it may succeed only for some orbits.
fn joined(over: &Over<'_>, families: Vec<AttractorFamily>) -> Vec<AttractorFamily> {
    let mut joined: Vec<AttractorFamily> = Vec::new();
    for family in families {
        let middle = || family.stable.iter().flat_map(StableRange::middle);
        // Two motions at one value are different families.
        let apart = |known: &AttractorFamily| known.at.keys().all(|index| !family.at.contains_key(index));
        let same = |known: &&mut AttractorFamily| {
            apart(known) && middle().any(|(value, orbit)| known.holds(over, value, orbit))
        };
        match joined.iter_mut().find(same) {
            Some(known) => known.at.extend(family.at),
            None => joined.push(family),
        }
    }
    joined
}

impl AttractorFamily {
    fn ending<'a>(&self, grid: &'a ValueGrid, index: usize) -> Option<&'a LongRun> {
        let here = grid.get(index)?.found.as_ref().ok()?;
        Some(&here.attractors.get(*self.at.get(&index)?)?.ending)
    }

    /// Whether an orbit at a value is on the family's stable range.
    fn holds(&self, over: &Over<'_>, value: f64, orbit: &PeriodicOrbit) -> bool {
        let near = self.stable.as_ref().and_then(|stable| stable.near(value));
        let known = near.and_then(|near| continued(&over.machine(value).ok()?, near));
        known.is_some_and(|known| known.is_same(orbit))
    }

    /// Orbits of the family, within a range of values, with an impact at a corner where the acceleration jumps.
    pub fn corner_impacts(&self, [low, high]: [f64; 2]) -> impl Iterator<Item = &BranchPoint> {
        let all = self.stable.iter().flat_map(StableRange::corner_impacts);
        all.filter(move |point| low <= point.value && point.value <= high)
    }

    /// Follows the branch of an orbit to both ends of its stable range.
    fn follow(&mut self, over: &Over<'_>, grid: &ValueGrid, step: f64) {
        let middle = self.at.keys().nth(self.at.len() / 2).copied();
        if let Some(index) = middle
            && let Some(LongRun::Orbit(orbit)) = self.ending(grid, index)
            && let Ok(stable) = StableRange::all(over, grid[index].value, orbit, self.range, step)
        {
            self.take(stable);
        }
    }

    fn take(&mut self, stable: StableRange) {
        (self.range, self.ends) = (stable.ends(), stable.ends.clone());
        self.stable = Some(stable);
    }

    /// Extends the family's range to the values at which runs settle on it, if its branch ends before. Beyond the branch's end, a run may
    /// still linger on the lost motion.
    fn reach(&mut self, over: &Over<'_>, grid: &ValueGrid) {
        let [Some(first), Some(last)] =
            [self.at.keys().next(), self.at.keys().last()].map(|index| index.map(|index| grid[*index].value))
        else {
            return;
        };
        let [low, high] = self.range;
        for (end, own, reached, is_beyond) in [(0, low, first, first < low), (1, high, last, last > high)] {
            if is_beyond {
                (self.range[end], self.ends[end]) = (reached, Some(by_runs(over, [own, reached])));
            }
        }
    }

    /// Narrows down the ends, within a range, of a motion that is not an orbit. Each end lies between two values of the grid.
    fn narrow(&mut self, over: &Over<'_>, (grid, range): (&ValueGrid, [f64; 2]), runs: StartsAndBudget<'_>) {
        if self.stable.is_some() {
            return;
        }
        let [Some(first), Some(last)] = [self.at.keys().next().copied(), self.at.keys().last().copied()] else {
            return;
        };
        let changed = |(side, index): (usize, usize)| {
            let next = if side == 0 { index.checked_sub(1) } else { Some(index + 1) };
            let ends = [grid[index].value, grid.get(next?)?.value];
            let is_asked_for = ends[0].min(ends[1]) < range[1] && range[0] < ends[0].max(ends[1]);
            Some(if is_asked_for { self.ended((over, runs), grid, index, ends) } else { by_runs(over, ends) })
        };
        let (lower, upper) = rayon::join(|| changed((0, first)), || changed((1, last)));
        for ((end, own), change) in self.ends.iter_mut().zip(&mut self.range).zip([lower, upper]) {
            if let Some(change) = change {
                *own = change.value();
                *end = Some(change);
            }
        }
    }

    /// Narrows down an end between the value of an index, at which the motion exists, and the next.
    fn ended(
        &self,
        (over, runs): (&Over<'_>, StartsAndBudget<'_>),
        grid: &ValueGrid,
        index: usize,
        ends: [f64; 2],
    ) -> Transition {
        /// Halvings of a step of the grid.
        const HALVINGS: u32 = 8;
        /// Halvings for an undecided motion. A longer budget would move its ends, and each try takes as long as the budget.
        const OF_UNDECIDED: u32 = 4;
        let halvings = if self.class == Class::Undecided { OF_UNDECIDED } else { HALVINGS };
        let found = self.wanted(grid, index, runs).map(|(wanted, attractor)| {
            let mut motion = Some(attractor.motion);
            halve(ends, Width::Halvings(halvings), |value| Ok(!wanted.is_there(&over.machine(value)?, &mut motion)?))
        });
        by_runs(over, found.and_then(Result::<_, RunError>::ok).unwrap_or(ends))
    }

    /// Locates, on slightly different machines over the same number, an end that is known by runs. None if it is not found nearby.
    pub fn moved(&self, other: &Over<'_>, grid: &ValueGrid, runs: StartsAndBudget<'_>, side: usize) -> Option<f64> {
        /// First step, in widths of the end's bracket. A bracket as narrow as that takes long, and steps are doubled.
        const FIRST: f64 = 16.0;
        /// Number of doublings.
        const DOUBLED: usize = 7;
        /// Halvings of the step that contains the end.
        const HALVINGS: u32 = 3;
        let change = self.ends[side].as_ref().filter(|_| self.class != Class::Undecided)?;
        let (index, outwards) = if side == 0 { (self.at.keys().next(), -1.0) } else { (self.at.keys().last(), 1.0) };
        let (wanted, _) = self.wanted(grid, *index?, runs)?;
        let mut motion = None;
        let mut is_there =
            |value: f64| -> Result<bool, RunError> { Ok(wanted.is_there(&other.machine(value)?, &mut motion)?) };
        let was_there = is_there(change.value()).ok()?;
        let direction = if was_there { outwards } else { -outwards };
        let step = direction * FIRST * (change.bracket[1] - change.bracket[0]);
        let mut is_beyond = |value: f64| is_there(value).map(|there| there != was_there);
        let bracket = outward(change.value(), step, DOUBLED, &mut is_beyond).ok()??;
        let [one, two] = halve(bracket, Width::Halvings(HALVINGS), is_beyond).ok()?;
        Some(0.5 * (one + two))
    }

    /// Describes the family's motion at a value of the grid, for a search at other values.
    fn wanted<'a>(
        &self,
        grid: &'a ValueGrid,
        index: usize,
        (sample, budget): StartsAndBudget<'_>,
    ) -> Option<(Wanted, &'a Attractor)> {
        let here = grid.get(index)?.found.as_ref().ok()?;
        let attractor = here.attractors.get(*self.at.get(&index)?)?;
        let of_class = here.attractors.iter().filter(|it| Class::of(&it.ending) == self.class);
        let sample = match sample {
            Sample::Spread(_) => Sample::Spread(STARTS),
            Sample::Given(_) => sample.clone(),
        };
        let wanted =
            Wanted { class: self.class, kind: attractor.ending.kind(), both: of_class.count() > 1, sample, budget };
        Some((wanted, attractor))
    }

    /// Turns of the cam and impacts of one period, if they are the same at all values.
    pub fn period(&self) -> Option<(u64, u64)> {
        match self.class {
            Class::Orbit(revolutions, impacts) => Some((revolutions, impacts)),
            Class::Stays => Some((1, 0)),
            Class::Rests | Class::Irregular | Class::Undecided => None,
        }
    }

    /// Kind of the motion at most of its values.
    pub fn kind(&self, grid: &ValueGrid) -> Kind {
        let mut counts: BTreeMap<Kind, usize> = BTreeMap::new();
        for index in self.at.keys() {
            if let Some(ending) = self.ending(grid, *index) {
                *counts.entry(ending.kind()).or_default() += 1;
            }
        }
        // A family between two values of the grid is known only if it is an orbit.
        counts.into_iter().max_by_key(|(_, count)| *count).map_or(Kind::Periodic, |(kind, _)| kind)
    }

    /// Replaces an end known by runs by the value at which the follower leaves the cam, with its error, if that value is in the bracket.
    pub(super) fn detaches(&mut self, over: &Over<'_>, value: f64, error: f64) {
        for (end, own) in self.ends.iter_mut().zip(&mut self.range) {
            if let Some(change) = end
                && change.cause == Cause::Runs
                && change.bracket[0] <= value + error
                && value - error <= change.bracket[1]
            {
                let bracket = [value - error, value + error];
                *change = Transition { bracket, ..Transition::at(over.place(value), Cause::Detachment) };
                *own = value;
            }
        }
    }

    /// Brackets of the ends.
    pub(super) fn brackets(&self) -> impl Iterator<Item = [f64; 2]> {
        self.ends.iter().flatten().map(|end| end.bracket)
    }

    /// Cuts the family to a range of values. Returns false if nothing is left.
    pub(super) fn cut(&mut self, [low, high]: [f64; 2]) -> bool {
        let is_inside = |value: f64| low < value && value < high;
        for (end, own) in self.ends.iter_mut().zip(&mut self.range) {
            if !is_inside(*own) {
                (*end, *own) = (None, own.clamp(low, high));
            }
        }
        self.range[0] < self.range[1]
    }
}

/// A motion to be found by runs at other values.
struct Wanted {
    class: Class,
    kind: Kind,
    /// Whether the class has several attractors, so that a motion of another kind is another motion. Otherwise the kind may change: a
    /// long motion may be chaotic at one value and be seen to rest at the next.
    both: bool,
    /// Starts of the runs at each value.
    sample: Sample,
    budget: Budget,
}

/// Starts of a survey's runs, and the budget of each.
pub type StartsAndBudget<'a> = (&'a Sample, Budget);

/// Number of starts of a sample.
const STARTS: usize = 12;

impl Wanted {
    /// Whether the motion exists on a machine: one of a few starts settles on it, or the `motion` of another value continues as one. If so,
    /// replaces `motion`.
    fn is_there(&self, machine: &Machine, motion: &mut Option<Motion>) -> Result<bool, SimulateError> {
        let here = AttractorsAtValue::new(machine, &self.sample, self.budget)?;
        let of_class = |it: &Attractor| Class::of(&it.ending) == self.class;
        let alike = |it: &&Attractor| of_class(it) && it.ending.kind() == self.kind;
        let goes_on = |it: &Attractor| if self.both { alike(&it) } else { of_class(it) };
        let there = match (here.attractors.iter().find(alike), *motion) {
            (Some(attractor), _) => Some(attractor.motion),
            (None, Some(before)) if matches!(self.sample, Sample::Spread(_)) => {
                here.come_to(machine, &before)?.filter(goes_on).map(|it| it.motion)
            }
            (None, _) => here.attractors.iter().find(|it| goes_on(it)).map(|it| it.motion),
        };
        *motion = there.or(*motion);
        Ok(there.is_some())
    }
}

/// Whether runs have reached a motion of the same class as `ending`.
pub fn has_reached(here: &AttractorsAtValue, ending: &LongRun) -> bool {
    here.attractors.iter().any(|it| Class::of(&it.ending) == Class::of(ending) && here.is_reached(it))
}
