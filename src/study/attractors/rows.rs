//! Attractors over a range of speeds: what was found at one speed matched with what was found at the next.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::change::{Cause, Change};
use super::here::Here;
use super::stretch::Stretch;
use crate::bracket::{Width, halve};
use crate::model::Model;
use crate::orbit::branch::BranchPoint;
use crate::orbit::long_run::{Budget, Kind, LongRun};
use crate::orbit::near::close;
use crate::orbit::{Course, PeriodicOrbit};
use crate::simulate::{Machine, Motion, SimulateError, angular_velocity};
use crate::study::survey::{Part, Sample};

/// What holds a motion together from one speed to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Class {
    /// The follower stays on the cam.
    Stays,
    /// Its revolutions and impacts.
    Orbit(u64, u64),
    /// It rests in every revolution, after as many impacts as it takes.
    Rests,
    /// It rests sooner or later, or bounces on: whether it is seen to repeat, and after how long, changes with every speed.
    Irregular,
    /// What could not be told.
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

/// An attractor over a range of speeds.
#[derive(Clone, Debug)]
pub struct Row {
    class: Class,
    /// The part that it is at speeds of the grid, by their indices.
    pub at: BTreeMap<usize, usize>,
    /// What it begins and ends with, by rising speed; nothing at the ends of the grid.
    pub ends: [Option<Change>; 2],
    /// Its lowest and highest speed, rpm.
    pub rpm: [f64; 2],
    stretch: Option<Stretch>,
}

/// The speeds that were looked at, by rising speed, with what was found at each or why nothing was.
pub type Grid = [Result<Here, (f64, SimulateError)>];

/// Matches what was found over a grid of speeds.
pub fn rows(model: &Model, machine: &Machine, grid: &mut Grid, runs: Asked<'_>) -> Vec<Row> {
    let mut rows = linked(machine, grid);
    let step = step(grid);
    rows.par_iter_mut().for_each(|row| row.follow(model, grid, step));
    let mut rows = joined(machine, rows);
    beyond(model, machine, &mut rows, step);
    let mut rows = joined(machine, rows);
    rows.par_iter_mut().for_each(|row| row.narrow(machine, grid, runs));
    rows.iter_mut().for_each(|row| row.reach(grid));
    rows.sort_by(|one, two| one.rpm[0].total_cmp(&two.rpm[0]).then(one.rpm[1].total_cmp(&two.rpm[1])));
    rows
}

fn speed(found: &Result<Here, (f64, SimulateError)>) -> f64 {
    match found {
        Ok(here) => here.rpm,
        Err((rpm, _)) => *rpm,
    }
}

fn step(grid: &Grid) -> f64 {
    grid.windows(2).map(|pair| speed(&pair[1]) - speed(&pair[0])).fold(0.0, f64::max)
}

/// Rows by what one speed and the next have in common.
fn linked(machine: &Machine, grid: &Grid) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    for (index, found) in grid.iter().enumerate() {
        let Ok(here) = found else { continue };
        let machine = machine.at_speed(angular_velocity(here.rpm));
        for (place, part) in here.parts.iter().enumerate() {
            let class = Class::of(&part.ending);
            let before = |row: &Row| {
                let before = index.checked_sub(1)?;
                let part = *row.at.get(&before)?;
                Some(&grid[before].as_ref().ok()?.parts.get(part)?.ending)
            };
            let goes_on = |row: &Row| {
                let is_free = row.class == class && !row.at.contains_key(&index);
                is_free && before(row).is_some_and(|before| is_next(&machine, before, &part.ending))
            };
            // Of several irregular motions those of one kind belong together.
            let is_alike = |row: &Row| before(row).is_some_and(|before| before.kind() == part.ending.kind());
            let open: Vec<usize> = (0..rows.len()).filter(|row| goes_on(&rows[*row])).collect();
            let row = open.iter().find(|row| is_alike(&rows[**row])).or(open.first()).copied();
            match row.and_then(|row| rows.get_mut(row)) {
                Some(row) => {
                    row.at.insert(index, place);
                    row.rpm[1] = here.rpm;
                }
                None => rows.push(Row {
                    class,
                    at: BTreeMap::from([(index, place)]),
                    ends: [None, None],
                    rpm: [here.rpm; 2],
                    stretch: None,
                }),
            }
        }
    }
    rows
}

/// Whether Newton's method leads from an orbit of one speed to that of the next; of other motions there is one of a class.
fn is_next(machine: &Machine, before: &LongRun, now: &LongRun) -> bool {
    match (before, now) {
        (LongRun::Orbit(before), LongRun::Orbit(now)) => {
            at_speed(machine, before).is_some_and(|orbit| orbit.is_same(now))
        }
        _ => true,
    }
}

/// The orbit of this machine near that of a machine at a neighbouring speed.
fn at_speed(machine: &Machine, orbit: &PeriodicOrbit) -> Option<PeriodicOrbit> {
    match &orbit.course {
        Course::Impacts(cycle) => close(machine, cycle),
        Course::Sticking(_) => None,
        Course::Free => Some(orbit.clone()),
    }
}

/// Adds the orbits that runs come to right beyond where another has ended, and those beyond their ends in turn: between two
/// speeds of the grid there is room for several.
fn beyond(model: &Model, machine: &Machine, rows: &mut Vec<Row>, step: f64) {
    /// How often that is done.
    const DEPTH: usize = 3;
    let holds =
        |rows: &[Row], (rpm, orbit): &(f64, PeriodicOrbit)| rows.iter().any(|row| row.holds(machine, *rpm, orbit));
    let mut fresh = 0;
    for _ in 0..DEPTH {
        let next = |stretch: &Stretch| {
            let mut found: Vec<((f64, PeriodicOrbit), Row)> = Vec::new();
            for (rpm, orbit) in stretch.beyond(model, machine, step) {
                let seen = (rpm, orbit);
                if holds(rows, &seen) || found.iter().any(|(_, row)| holds(std::slice::from_ref(row), &seen)) {
                    continue;
                }
                let class = Class::of(&LongRun::Orbit(seen.1.clone()));
                let mut row = Row { class, at: BTreeMap::new(), ends: [None, None], rpm: [rpm; 2], stretch: None };
                if let Ok(stretch) = Stretch::all(model, rpm, &seen.1, row.rpm, step) {
                    row.take(stretch);
                    found.push((seen, row));
                }
            }
            found
        };
        let ended = rows[fresh..].par_iter().filter_map(|row| row.stretch.as_ref());
        let found: Vec<_> = ended.map(next).collect();
        fresh = rows.len();
        // What is beyond the end of one may be beyond that of another.
        for (seen, row) in found.into_iter().flatten() {
            if !holds(&rows[fresh..], &seen) {
                rows.push(row);
            }
        }
        if fresh == rows.len() {
            return;
        }
    }
}

/// Rows that are on one stretch of one branch, as one: they have its orbits in common. Newton's method leads from one to the same orbit on the
/// other where that is on the same segments of the cam; over rows of a table it may be next to others alone.
fn joined(machine: &Machine, rows: Vec<Row>) -> Vec<Row> {
    let mut joined: Vec<Row> = Vec::new();
    for row in rows {
        let middle = || row.stretch.iter().flat_map(Stretch::middle);
        // Two motions at one speed are two.
        let apart = |known: &Row| known.at.keys().all(|index| !row.at.contains_key(index));
        let same = |known: &&mut Row| apart(known) && middle().any(|(rpm, orbit)| known.holds(machine, rpm, orbit));
        match joined.iter_mut().find(same) {
            Some(known) => known.at.extend(row.at),
            None => joined.push(row),
        }
    }
    joined
}

impl Row {
    fn ending<'a>(&self, grid: &'a Grid, index: usize) -> Option<&'a LongRun> {
        let here = grid.get(index)?.as_ref().ok()?;
        Some(&here.parts.get(*self.at.get(&index)?)?.ending)
    }

    /// Whether an orbit at a speed, rpm, is on its stretch.
    fn holds(&self, machine: &Machine, rpm: f64, orbit: &PeriodicOrbit) -> bool {
        let near = self.stretch.as_ref().and_then(|stretch| stretch.near(rpm));
        let known = near.and_then(|near| at_speed(&machine.at_speed(angular_velocity(rpm)), near));
        known.is_some_and(|known| known.is_same(orbit))
    }

    /// Its orbits with an impact at a corner where the acceleration jumps, within a range of speeds, rpm.
    pub fn corner_impacts(&self, [low, high]: [f64; 2]) -> impl Iterator<Item = &BranchPoint> {
        let all = self.stretch.iter().flat_map(Stretch::corner_impacts);
        all.filter(move |point| low <= point.rpm && point.rpm <= high)
    }

    /// Follows the branch of an orbit to where it ceases to be stable.
    fn follow(&mut self, model: &Model, grid: &Grid, step: f64) {
        let middle = self.at.keys().nth(self.at.len() / 2).copied();
        if let Some(index) = middle
            && let Some(LongRun::Orbit(orbit)) = self.ending(grid, index)
            && let Ok(stretch) = Stretch::all(model, speed(&grid[index]), orbit, self.rpm, step)
        {
            self.take(stretch);
        }
    }

    fn take(&mut self, stretch: Stretch) {
        (self.rpm, self.ends) = (stretch.range(), stretch.ends.clone());
        self.stretch = Some(stretch);
    }

    /// Makes its range that of the speeds at which runs have come to it, where the branch that it is on ends before: a run that has not left
    /// what is lost beyond is on it still.
    fn reach(&mut self, grid: &Grid) {
        let [Some(first), Some(last)] =
            [self.at.keys().next(), self.at.keys().last()].map(|index| index.map(|index| speed(&grid[*index])))
        else {
            return;
        };
        let [low, high] = self.rpm;
        for (end, own, reached, is_beyond) in [(0, low, first, first < low), (1, high, last, last > high)] {
            if is_beyond {
                (self.rpm[end], self.ends[end]) = (reached, Some(Change::by_runs(sorted([own, reached]))));
            }
        }
    }

    /// Narrows down where a motion that is no orbit begins and ends, between two speeds of the grid.
    fn narrow(&mut self, machine: &Machine, grid: &Grid, runs: Asked<'_>) {
        if self.stretch.is_some() {
            return;
        }
        let [Some(first), Some(last)] = [self.at.keys().next().copied(), self.at.keys().last().copied()] else {
            return;
        };
        let changed = |(side, index): (usize, usize)| {
            let next = if side == 0 { index.checked_sub(1) } else { Some(index + 1) };
            Some(self.ended((machine, runs), grid, index, speed(grid.get(next?)?)))
        };
        let (lower, upper) = rayon::join(|| changed((0, first)), || changed((1, last)));
        for ((end, own), change) in self.ends.iter_mut().zip(&mut self.rpm).zip([lower, upper]) {
            if let Some(change) = change {
                *own = change.rpm;
                *end = Some(change);
            }
        }
    }

    /// Between the speed of an index, at which it is there, and `gone`, rpm.
    fn ended(&self, (machine, runs): (&Machine, Asked<'_>), grid: &Grid, index: usize, gone: f64) -> Change {
        /// Halvings of a step of the grid.
        const HALVINGS: u32 = 8;
        let ends = [speed(&grid[index]), gone];
        let found = self.wanted(grid, index, runs).map(|(wanted, part)| {
            let mut motion = Some(part.motion);
            halve(ends, Width::Halvings(HALVINGS), |rpm| Ok(!wanted.is_there(machine, rpm, &mut motion)?))
        });
        Change::by_runs(sorted(found.and_then(Result::<_, SimulateError>::ok).unwrap_or(ends)))
    }

    /// The speed, rpm, at which an end that is known by runs is on another machine, whose cam differs by little; none where it is not
    /// found near by.
    pub fn moved(&self, other: &Machine, grid: &Grid, runs: Asked<'_>, side: usize) -> Option<f64> {
        /// The first step, in brackets of the end: as narrow a bracket takes long, and steps are doubled.
        const FIRST: f64 = 16.0;
        /// How often.
        const DOUBLED: usize = 7;
        /// Halvings of the step that it is in.
        const HALVINGS: u32 = 3;
        let change = self.ends[side].as_ref().filter(|_| self.class != Class::Undecided)?;
        let index = if side == 0 { self.at.keys().next() } else { self.at.keys().last() };
        let (wanted, _) = self.wanted(grid, *index?, runs)?;
        let mut motion = None;
        let mut is_there = |rpm: f64| wanted.is_there(other, rpm, &mut motion);
        let was_there = is_there(change.rpm).ok()?;
        let outward = if side == 0 { -1.0 } else { 1.0 };
        let mut step = (if was_there { outward } else { -outward }) * FIRST * (change.bracket[1] - change.bracket[0]);
        let mut from = change.rpm;
        for _ in 0..DOUBLED {
            let next = from + step;
            if is_there(next).ok()? != was_there {
                let found =
                    halve([from, next], Width::Halvings(HALVINGS), |rpm| is_there(rpm).map(|there| there != was_there));
                return found.ok().map(|[one, two]| 0.5 * (one + two));
            }
            (from, step) = (next, 2.0 * step);
        }
        None
    }

    /// What it is at a speed of the grid, to be looked for elsewhere.
    fn wanted<'a>(&self, grid: &'a Grid, index: usize, (sample, budget): Asked<'_>) -> Option<(Wanted, &'a Part)> {
        let here = grid.get(index)?.as_ref().ok()?;
        let part = here.parts.get(*self.at.get(&index)?)?;
        let of_class = here.parts.iter().filter(|part| Class::of(&part.ending) == self.class);
        let sample = match sample {
            Sample::Spread(_) => Sample::Spread(STARTS),
            Sample::Given(_) => sample.clone(),
        };
        Some((Wanted { class: self.class, kind: part.ending.kind(), both: of_class.count() > 1, sample, budget }, part))
    }

    /// Turns of the cam and impacts of one period, where that is the same all along.
    pub fn period(&self) -> Option<(u64, u64)> {
        match self.class {
            Class::Orbit(revolutions, impacts) => Some((revolutions, impacts)),
            Class::Stays => Some((1, 0)),
            Class::Rests | Class::Irregular | Class::Undecided => None,
        }
    }

    /// Its kind: that of most of its speeds.
    pub fn kind(&self, grid: &Grid) -> Kind {
        let mut counts: BTreeMap<Kind, usize> = BTreeMap::new();
        for index in self.at.keys() {
            if let Some(ending) = self.ending(grid, *index) {
                *counts.entry(ending.kind()).or_default() += 1;
            }
        }
        // Between two speeds of the grid only orbits are known.
        counts.into_iter().max_by_key(|(_, count)| *count).map_or(Kind::Periodic, |(kind, _)| kind)
    }

    /// Gives an end that is known by runs the speed at which the follower leaves the cam, rpm, and its rounding, if that is in the bracket.
    pub(super) fn detaches(&mut self, rpm: f64, error: f64) {
        for (end, own) in self.ends.iter_mut().zip(&mut self.rpm) {
            if let Some(change) = end
                && change.cause == Cause::Runs
                && change.bracket[0] <= rpm + error
                && rpm - error <= change.bracket[1]
            {
                let bracket = [rpm - error, rpm + error];
                *change = Change { rpm, bracket, cause: Cause::Detachment, point: None, error: None };
                *own = rpm;
            }
        }
    }

    /// Leaves what is inside of a range of speeds, rpm; false where nothing is.
    pub(super) fn cut(&mut self, [low, high]: [f64; 2]) -> bool {
        let is_inside = |rpm: f64| low < rpm && rpm < high;
        for (end, own) in self.ends.iter_mut().zip(&mut self.rpm) {
            if !is_inside(*own) {
                (*end, *own) = (None, own.clamp(low, high));
            }
        }
        self.rpm[0] < self.rpm[1]
    }
}

/// A motion that runs are asked for at other speeds.
struct Wanted {
    class: Class,
    kind: Kind,
    /// Whether there are several of the class, of which another kind is another motion: one that is long may be chaotic at one speed and
    /// be seen to rest at the next.
    both: bool,
    /// Where runs begin at each speed that is tried.
    sample: Sample,
    budget: Budget,
}

/// Where the runs of a survey begin, and for how long they are followed.
pub type Asked<'a> = (&'a Sample, Budget);

/// How many of a sample.
const STARTS: usize = 12;

impl Wanted {
    /// Whether one of a few starts ends on it, or the `motion` of another speed goes on as one; that is put in its place then.
    fn is_there(&self, machine: &Machine, rpm: f64, motion: &mut Option<Motion>) -> Result<bool, SimulateError> {
        let here = Here::new(machine, rpm, &self.sample, self.budget)?;
        let of_class = |part: &Part| Class::of(&part.ending) == self.class;
        let alike = |part: &&Part| of_class(part) && part.ending.kind() == self.kind;
        let goes_on = |part: &Part| if self.both { alike(&part) } else { of_class(part) };
        let there = match (here.parts.iter().find(alike), *motion) {
            (Some(part), _) => Some(part.motion),
            (None, Some(before)) if matches!(self.sample, Sample::Spread(_)) => {
                here.come_to(machine, &before)?.filter(goes_on).map(|part| part.motion)
            }
            (None, _) => here.parts.iter().find(|part| goes_on(part)).map(|part| part.motion),
        };
        *motion = there.or(*motion);
        Ok(there.is_some())
    }
}

fn sorted([one, two]: [f64; 2]) -> [f64; 2] {
    [one.min(two), one.max(two)]
}

/// Whether runs have come to a motion of the same class as `ending`.
pub(super) fn has_reached(here: &Here, ending: &LongRun) -> bool {
    here.parts.iter().any(|part| Class::of(&part.ending) == Class::of(ending) && here.is_reached(part))
}
