//! Attractors of a machine over a range of speeds, or of values of another number. They are found at each value of a grid and matched
//! from value to value, with where each begins and ends.
//!
//! At each value, runs start from a sample of starts, from rest on the cam, and from the stable orbits known without a run. Then they
//! start from the attractors that the two neighbouring values have and this one lacks. The grid does not depend on the range: a part of a
//! range has the attractors of that part.
//!
//! | module | contents |
//! |---|---|
//! | `at_value` | the attractors of one machine |
//! | `stable_range` | the range over which a periodic orbit is stable, by the branch that it is on |
//! | `transition` | where an attractor begins or ends, and why |
//! | `family` | the attractors at each value matched with those at the next |
//! | `step` | the grid of values |
//! | `uncertain_ends` | the uncertainty of where attractors begin and end |

mod at_value;
mod detachment;
mod family;
mod stable_range;
mod step;
mod transition;
mod uncertain_ends;

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use crate::bracket::{Width, halve};
use crate::cancel;
use crate::model::ModelError;
use crate::orbit::FamilyError;
use crate::orbit::long_run::Budget;
use crate::progress::Watch;
use crate::study::design::contact::{Contact, Separation};
use crate::study::survey::{Attractor, Over, OverError, RunError, Sample, Spacing};
use crate::tolerance;
pub use at_value::AttractorsAtValue;
pub use detachment::detachment;
pub use family::{AttractorFamily, GridValue, StartsAndBudget, ValueGrid, families, has_reached};
#[doc(hidden)]
pub use stable_range::StableRange;
pub use step::Step;
pub use transition::{Cause, Transition};
pub(crate) use uncertain_ends::UncertainEnds;

/// Builds a transition known by runs alone, between two values in either order.
fn by_runs(over: &Over<'_>, [one, two]: [f64; 2]) -> Transition {
    Transition::by_runs(&over.parameter, over.rpm, [one.min(two), one.max(two)])
}

/// Whether the follower leaves the cam at a value, by the contact force.
fn leaves_at(over: &Over<'_>, value: f64) -> Result<bool, FamilyError> {
    let (model, cam) = over.model(value)?;
    Ok(Contact::new(&cam, model.follower).leaves(over.place(value).rpm))
}

/// Returns the value between two at which the follower begins or ceases to leave the cam, by the contact force, and its uncertainty.
fn leaves(over: &Over<'_>, bracket: [f64; 2]) -> Option<[f64; 2]> {
    let [low, high] = bracket;
    let at_low = leaves_at(over, low).ok()?;
    if leaves_at(over, high).ok()? == at_low {
        return None;
    }
    let width = Width::Relative(tolerance::ROOT_WIDTH.value);
    let [low, high] = halve(bracket, width, |value| Ok::<_, FamilyError>(leaves_at(over, value)? != at_low)).ok()?;
    Some([0.5 * (low + high), 0.5 * (high - low).abs()])
}

/// Fineness of a survey over a range.
#[derive(Clone, Debug, PartialEq)]
pub struct Resolution {
    /// Step from one value to the next.
    pub step: Step,
    /// Starts to be run at each value.
    pub sample: Sample,
    /// Budget of each run.
    pub budget: Budget,
    /// Whether runs also begin on the stable orbits of two impacts in one revolution. The search at each value takes up to seconds. It
    /// finds all of them except near a fold, a graze or a corner.
    pub two_impacts: bool,
}

impl Resolution {
    /// Builds a resolution of `starts` starts of a sample at each value, with the budget of a survey.
    pub fn new(step: Step, starts: usize) -> Self {
        Self { step, sample: Sample::Spread(starts), budget: Budget::SURVEY, two_impacts: false }
    }
}

/// A range of values with two or more attractors.
#[derive(Clone, Debug, PartialEq)]
pub struct FamilyCoexistence {
    /// Lowest and highest value.
    pub range: [f64; 2],
    /// Indices of the families.
    pub families: Vec<usize>,
}

/// The attractors of a range of values.
#[derive(Clone, Debug)]
pub struct Attractors {
    /// The range.
    pub range: [f64; 2],
    /// For each value of the grid, from the lowest up, the attractors there, or why there are none.
    pub grid: Vec<GridValue>,
    /// The attractors, by rising value.
    pub families: Vec<AttractorFamily>,
    /// Ranges with several attractors.
    pub coexistence: Vec<FamilyCoexistence>,
    /// First speed, above the lowest of the range, at which the follower leaves the cam, by the contact force; none if the speed does not
    /// vary.
    pub separation: Option<Separation>,
}

/// Reason why a range of values cannot be surveyed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the message says what each number is")]
pub enum AttractorsError {
    /// The model is impossible.
    #[error("{0}")]
    Model(#[from] ModelError),
    /// The varied number is not a number of the model, or cannot have the value.
    #[error(transparent)]
    Family(#[from] FamilyError),
    /// The number cannot be varied.
    #[error(transparent)]
    Over(#[from] OverError),
    /// The ends of a speed range are not a range.
    #[error("{low}:{high} rpm: a range goes from a speed above 0 to a higher one")]
    NoRange { low: f64, high: f64 },
    /// The ends of another number's range are not a range.
    #[error("{name} = {low}:{high}: a range goes from a value to a higher one{}", if *of_logarithms { ", and a logarithmic one begins above 0" } else { "" })]
    NoRangeOf { name: String, low: f64, high: f64, of_logarithms: bool },
    /// The grid is too fine for doubles, or has too many values to be run.
    #[error("{low}:{high}: values that are {step:e} apart are too many, or too close to distinguish")]
    TooFine { low: f64, high: f64, step: f64 },
    /// No value could be run.
    #[error("at {place}, and at every other value: {error}")]
    Run { place: String, error: Box<RunError> },
}

/// Margin beyond a range in which attractors are looked for, in steps.
const MARGIN: f64 = 8.0;
/// Largest number of values in one grid.
const MOST_VALUES: f64 = 200_000.0;

/// Finds the attractors of a model over a range of one of its numbers. `watch` is notified at each value.
pub fn attractors(
    over: &Over<'_>,
    range: [f64; 2],
    resolution: &Resolution,
    watch: &dyn Watch,
) -> Result<Attractors, AttractorsError> {
    let values = values(over, range, resolution)?;
    let (done, total) = (AtomicU64::new(0), values.len() as u64);
    let at = |value: &f64| {
        // Cancelled work does not begin any of the remaining values.
        cancel::check_now();
        watch.at("motions that runs settle on", done.fetch_add(1, Ordering::Relaxed), total);
        let found = over.machine(*value).map_err(RunError::from).and_then(|machine| {
            let runs = (&resolution.sample, resolution.budget);
            Ok(AttractorsAtValue::seeded(&machine, runs, resolution.two_impacts)?)
        });
        GridValue { value: *value, found }
    };
    let mut grid: Vec<GridValue> = values.par_iter().map(at).collect();
    // Beyond the range there may be no machine.
    grid.retain(|at| (range[0] <= at.value && at.value <= range[1]) || !matches!(at.found, Err(RunError::Family(_))));
    let inside = grid.iter().find(|at| range[0] <= at.value).or(grid.first());
    if let Some(GridValue { value, found: Err(error) }) = inside
        && grid.iter().all(|at| at.found.is_err())
    {
        return Err(AttractorsError::Run { place: over.parameter.words(*value), error: Box::new(error.clone()) });
    }
    watch.at("motions at neighbouring values", 0, 0);
    // For given starts, the runs from those starts are the whole answer.
    if let Sample::Spread(_) = resolution.sample {
        exchange(over, &mut grid);
    }
    watch.at("beginning and end of each motion", 0, 0);
    let mut families =
        families(over, (&grid, range), &|value| resolution.step.near(value), (&resolution.sample, resolution.budget));
    let separation = over.is_speed().then(|| {
        let machine = over.machine(range[0])?;
        Ok::<_, FamilyError>(Contact::new(machine.cam(), over.model.follower).separation_above(range[0]))
    });
    let separation = separation.transpose()?;
    let detachments: Vec<[f64; 2]> = match separation {
        Some(Separation::At { rpm, error, .. }) => vec![[rpm, error]],
        Some(_) => Vec::new(),
        None => {
            families.iter().flat_map(AttractorFamily::brackets).filter_map(|bracket| leaves(over, bracket)).collect()
        }
    };
    for [value, error] in detachments {
        families.iter_mut().for_each(|family| family.detaches(over, value, error));
    }
    families.retain_mut(|family| family.cut(range));
    let coexistence = coexistence(&families, range);
    Ok(Attractors { range, grid, families, coexistence, separation })
}

/// Returns the values at which attractors are looked for.
fn values(over: &Over<'_>, [low, high]: [f64; 2], resolution: &Resolution) -> Result<Vec<f64>, AttractorsError> {
    let (step, is_range) = (resolution.step, high > low && (high - low).is_finite());
    let of_logarithms = step.spacing == Spacing::Logarithmic;
    match over.is_speed() {
        true if !(is_range && low > 0.0) => return Err(AttractorsError::NoRange { low, high }),
        false if !is_range || (of_logarithms && low <= 0.0) => {
            let name = over.parameter.name().into();
            return Err(AttractorsError::NoRangeOf { name, low, high, of_logarithms });
        }
        _ => {}
    }
    let [from, to] = [low, high].map(|end| step.spacing.place(end));
    let size = from.abs().max(to.abs());
    if !(step.width() > size * tolerance::ULP.value && (to - from) / step.width() <= MOST_VALUES) {
        return Err(AttractorsError::TooFine { low, high, step: step.width() });
    }
    // Attractors that exist only between two values of the grid are found from those next to it, which may lie outside the range.
    let around = MARGIN * step.width();
    let mut values: Vec<f64> = step.over([from - around, to + around]).collect();
    if over.is_speed() {
        // The cam does not turn at speed 0; below 0 it turns the other way.
        values.retain(|rpm| *rpm > 0.0);
        if values.first().is_some_and(|first| low < *first) {
            values.insert(0, low);
        }
    }
    Ok(values)
}

/// Runs, at each value, the motions that its neighbours have and it lacks, until no new attractor is found.
fn exchange(over: &Over<'_>, grid: &mut [GridValue]) {
    let mut fresh: Vec<usize> = (0..grid.len()).collect();
    while !fresh.is_empty() {
        let pairs = fresh.iter().flat_map(|from| [(*from, from.checked_sub(1)), (*from, Some(from + 1))]);
        let pairs: Vec<(usize, usize)> = pairs.filter_map(|(from, to)| Some((from, to?))).collect();
        let found: Vec<(usize, Attractor)> = pairs
            .par_iter()
            .flat_map_iter(|(from, to)| {
                let (Some(from), Some(at)) = (grid.get(*from), grid.get(*to)) else { return Vec::new() };
                let (Ok(from), Ok(here)) = (&from.found, &at.found) else { return Vec::new() };
                let mut missing = from.attractors.iter().filter(|it| !has_reached(here, &it.ending)).peekable();
                if missing.peek().is_none() {
                    return Vec::new();
                }
                let Ok(machine) = over.machine(at.value) else { return Vec::new() };
                let found = missing.filter_map(|it| here.come_to(&machine, &it.motion).ok().flatten());
                found.map(|attractor| (*to, attractor)).collect()
            })
            .collect();
        fresh.clear();
        for (index, attractor) in found {
            if let Ok(here) = &mut grid[index].found
                && here.take(attractor)
            {
                fresh.push(index);
            }
        }
        fresh.dedup();
    }
}

/// Returns the ranges in which families overlap by more than the uncertainty of their ends.
fn coexistence(families: &[AttractorFamily], range: [f64; 2]) -> Vec<FamilyCoexistence> {
    let ends = families.iter().flat_map(|family| family.range.into_iter().zip(&family.ends));
    let open = |end: &Option<Transition>| end.as_ref().map_or(0.0, |end| end.bracket[1] - end.bracket[0]);
    let mut ends: Vec<(f64, f64)> = ends.map(|(value, end)| (value, open(end))).collect();
    ends.sort_by(|one, other| one.0.total_cmp(&other.0));
    // Resolution of a speed, rpm; for a number with a range below 1, that fraction of the range.
    let rounding = tolerance::SPEED_FOUND.value * (range[1] - range[0]).min(1.0);
    let mut found: Vec<FamilyCoexistence> = Vec::new();
    for pair in ends.windows(2) {
        let [(low, one), (high, other)] = [pair[0], pair[1]];
        let covers = |index: &usize| families[*index].range[0] <= low && high <= families[*index].range[1];
        let families: Vec<usize> = (0..families.len()).filter(covers).collect();
        if families.len() > 1 && high - low > one.max(other).max(rounding) {
            found.push(FamilyCoexistence { range: [low, high], families });
        }
    }
    found
}
