//! The attractors of a machine over a range of speeds: sought at each speed of a grid, matched from speed to speed, each with
//! where it begins and ends.
//!
//! At each speed runs are made from a sample of starts, from rest on the cam, and from the stable orbits that are known without
//! a run; then from what the two neighbouring speeds have and this one has not. The grid is the same for every range: a part
//! of a range has the attractors of that part.
//!
//! | module | what it holds |
//! |---|---|
//! | [`here`] | the attractors at one speed |
//! | `stretch` | how far a periodic orbit is stable, by the branch that it is on |
//! | [`change`] | where an attractor begins or ends, and why |
//! | [`rows`] | what was found at one speed matched with what was found at the next |

pub mod change;
mod detachment;
pub mod here;
pub mod rows;
mod stretch;

use std::sync::atomic::{AtomicU64, Ordering};

use crate::model::{Model, ModelError};
use crate::orbit::long_run::Budget;
use crate::progress::Watch;
use crate::simulate::{Machine, SimulateError};
use crate::stop;
use crate::study::design::contact::{Contact, Separation};
use crate::study::machine;
use crate::study::survey::{Part, Sample};
pub use change::{Cause, Change};
pub use detachment::detachment;

pub use here::Here;
use rayon::prelude::*;
pub use rows::{Grid, Row};

/// A grid of speeds that no range has a say in: whole multiples of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// 1, 2, 3 or 5, so that the step is no shorter than half of what was asked for.
    digit: u64,
    /// Of ten.
    power: i32,
}

impl Step {
    /// The longest step that puts `speeds` of them, or more, into `range`, rpm.
    pub fn for_speeds([low, high]: [f64; 2], speeds: u32) -> Self {
        Self::at_most((high - low) / f64::from(speeds.max(1)))
    }

    /// The longest step that is no longer than so many rpm.
    pub fn at_most(longest: f64) -> Self {
        let power = longest.log10().floor();
        let digits = longest / 10.0_f64.powf(power);
        // A step of exactly one of them is not to be lost to rounding.
        let digit = [5, 3, 2]
            .into_iter()
            .find(|digit| digits * (1.0 + 8.0 * crate::tolerance::ULP.value) >= *digit as f64)
            .unwrap_or(1);
        Self { digit, power: power as i32 }
    }

    /// The step, rpm.
    pub fn rpm(self) -> f64 {
        self.times(1)
    }

    /// A multiple of it, rpm: the double nearest to the decimal number.
    fn times(self, count: u64) -> f64 {
        let count = (count * self.digit) as f64;
        if self.power < 0 { count / 10.0_f64.powi(-self.power) } else { count * 10.0_f64.powi(self.power) }
    }

    /// The multiples from the last that is not above `low` to the first that is not below `high`, rpm.
    fn over(self, [low, high]: [f64; 2]) -> impl Iterator<Item = f64> {
        let first = (low / self.rpm()).floor() as u64;
        let mut first = first.saturating_sub(1);
        while self.times(first + 1) <= low {
            first += 1;
        }
        let mut last = first;
        while self.times(last) < high {
            last += 1;
        }
        (first..=last).map(move |count| self.times(count))
    }
}

/// How closely a range is looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct Resolution {
    /// From one speed to the next.
    pub step: Step,
    /// The starts that are run at each.
    pub sample: Sample,
    /// For how long.
    pub budget: Budget,
    /// Whether runs begin on the stable orbits of two impacts in one revolution, too: a search at each speed that takes up to
    /// seconds, and finds all of them but next to a fold, a graze or a corner.
    pub two_impacts: bool,
}

impl Resolution {
    /// So many starts of a sample at each speed, with the budget of a survey.
    pub fn new(step: Step, starts: usize) -> Self {
        Self { step, sample: Sample::Spread(starts), budget: Budget::SURVEY, two_impacts: false }
    }
}

/// Two or more attractors at the same speeds.
#[derive(Clone, Debug, PartialEq)]
pub struct Coexistence {
    /// Lowest and highest speed, rpm.
    pub rpm: [f64; 2],
    /// The rows, by their indices.
    pub rows: Vec<usize>,
}

/// The attractors of a range of speeds.
#[derive(Clone, Debug)]
pub struct Attractors {
    /// The range, rpm.
    pub range: [f64; 2],
    /// What was found at each speed of the grid, by rising speed, or why nothing was.
    pub grid: Vec<Result<Here, (f64, SimulateError)>>,
    /// The attractors, by rising speed.
    pub rows: Vec<Row>,
    /// Where there are several.
    pub coexistence: Vec<Coexistence>,
    /// Where the follower first leaves the cam above the lowest speed, by the force between them.
    pub separation: Separation,
}

/// Why a range of speeds cannot be looked through.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the message says what each number is")]
pub enum AttractorsError {
    /// The model is impossible.
    #[error("{0}")]
    Model(#[from] ModelError),
    /// Ends that are no range.
    #[error("{low}:{high} rpm: a range goes from a speed above 0 to a higher one")]
    NoRange { low: f64, high: f64 },
    /// A grid that no double resolves, or of more speeds than can be run.
    #[error("{low}:{high} rpm: speeds that are {step:e} rpm apart are too many, or too near to be told apart")]
    TooFine { low: f64, high: f64, step: f64 },
    /// No speed could be run.
    #[error("at {rpm} rpm, and at every other speed: {error}")]
    Simulate { rpm: f64, error: SimulateError },
}

/// How far beyond a range attractors are looked for, in steps.
const MARGIN: f64 = 8.0;
/// The most speeds of one grid.
const MOST_SPEEDS: f64 = 200_000.0;

/// The attractors of `model` over `range`, rpm; `watch` is told speed by speed.
pub fn attractors(
    model: &Model,
    range: [f64; 2],
    resolution: &Resolution,
    watch: &dyn Watch,
) -> Result<Attractors, AttractorsError> {
    let [low, high] = range;
    if !(low > 0.0 && high > low && high.is_finite()) {
        return Err(AttractorsError::NoRange { low, high });
    }
    let step = resolution.step.rpm();
    if !(step > high * crate::tolerance::ULP.value && (high - low) / step <= MOST_SPEEDS) {
        return Err(AttractorsError::TooFine { low, high, step });
    }
    let machine = machine(model, low)?;
    // What lives between two speeds of the grid is found from attractors next to it, which may lie outside of the range.
    let around = MARGIN * step;
    let mut speeds: Vec<f64> = resolution.step.over([(low - around).max(0.0), high + around]).collect();
    // Nothing turns at speed 0.
    speeds.retain(|rpm| *rpm > 0.0);
    if speeds.first().is_some_and(|first| low < *first) {
        speeds.insert(0, low);
    }
    let (done, total) = (AtomicU64::new(0), speeds.len() as u64);
    let at = |rpm: &f64| {
        // Work that is to end does not begin at each of the speeds that are left.
        stop::ask();
        watch.at("what runs end on", done.fetch_add(1, Ordering::Relaxed), total);
        Here::seeded(&machine, *rpm, (&resolution.sample, resolution.budget), resolution.two_impacts)
            .map_err(|error| (*rpm, error))
    };
    let mut grid: Vec<_> = speeds.par_iter().map(at).collect();
    if let Some(Err((rpm, error))) = grid.first()
        && grid.iter().all(Result::is_err)
    {
        return Err(AttractorsError::Simulate { rpm: *rpm, error: *error });
    }
    watch.at("what neighbouring speeds end on", 0, 0);
    // Starts that are given are all that is asked about.
    if let Sample::Spread(_) = resolution.sample {
        exchange(&machine, &mut grid);
    }
    watch.at("where each begins and ends", 0, 0);
    let mut rows = rows::rows(model, &machine, &mut grid, (&resolution.sample, resolution.budget));
    let separation = Contact::new(machine.cam(), model.follower).separation_above(low);
    if let Separation::At { rpm, error, .. } = separation {
        rows.iter_mut().for_each(|row| row.detaches(rpm, error));
    }
    rows.retain_mut(|row| row.cut(range));
    let coexistence = coexistence(&rows);
    Ok(Attractors { range, grid, rows, coexistence, separation })
}

/// Runs on, at each speed, what its neighbours have and it has not, until that finds nothing new.
fn exchange(machine: &Machine, grid: &mut [Result<Here, (f64, SimulateError)>]) {
    let mut fresh: Vec<usize> = (0..grid.len()).collect();
    while !fresh.is_empty() {
        let pairs = fresh.iter().flat_map(|from| [(*from, from.checked_sub(1)), (*from, Some(from + 1))]);
        let pairs: Vec<(usize, usize)> = pairs.filter_map(|(from, to)| Some((from, to?))).collect();
        let found: Vec<(usize, Part)> = pairs
            .par_iter()
            .flat_map_iter(|(from, to)| {
                let (Some(Ok(from)), Some(Ok(here))) = (grid.get(*from), grid.get(*to)) else { return Vec::new() };
                let missing = from.parts.iter().filter(|part| !rows::has_reached(here, &part.ending));
                let found = missing.filter_map(|part| here.come_to(machine, &part.motion).ok().flatten());
                found.map(|part| (*to, part)).collect()
            })
            .collect();
        fresh.clear();
        for (index, part) in found {
            if let Ok(here) = &mut grid[index]
                && here.take(part)
            {
                fresh.push(index);
            }
        }
        fresh.dedup();
    }
}

/// Where rows overlap, by more than where they begin and end is open by.
fn coexistence(rows: &[Row]) -> Vec<Coexistence> {
    let ends = rows.iter().flat_map(|row| row.rpm.into_iter().zip(&row.ends));
    let open = |end: &Option<Change>| end.as_ref().map_or(0.0, |change| change.bracket[1] - change.bracket[0]);
    let mut ends: Vec<(f64, f64)> = ends.map(|(rpm, end)| (rpm, open(end))).collect();
    ends.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut found: Vec<Coexistence> = Vec::new();
    for pair in ends.windows(2) {
        let [(low, one), (high, other)] = [pair[0], pair[1]];
        let covers = |row: &usize| rows[*row].rpm[0] <= low && high <= rows[*row].rpm[1];
        let over: Vec<usize> = (0..rows.len()).filter(covers).collect();
        let rounding = crate::tolerance::SPEED_FOUND.value;
        if over.len() > 1 && high - low > one.max(other).max(rounding) {
            found.push(Coexistence { rpm: [low, high], rows: over });
        }
    }
    found
}
