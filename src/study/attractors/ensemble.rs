//! What many starts of one machine end on, and how many on each.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;
use serde::Serialize;

use crate::estimate::Estimate;
use crate::orbit::ending::{Ending, is_same_release};
use crate::orbit::fate::{Fate, Run, Settling};
use crate::progress::Watch;
use crate::simulate::{Motion, SimulateError};

/// How long runs are waited for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Patience {
    /// Revolutions of each run.
    pub revolutions: u64,
    /// The longest period looked for, revolutions.
    pub longest: u64,
}

impl Default for Patience {
    fn default() -> Self {
        Self { revolutions: 200, longest: 32 }
    }
}

/// What the runs that neither rest nor come to an orbit soon did after that, all together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Wandering {
    /// Revolutions.
    pub revolutions: u64,
    /// How many have come to an orbit, or to the cam for good.
    pub left: u64,
    /// How many have rested on the cam.
    pub rested: u64,
}

impl Wandering {
    /// Of both.
    pub fn with(self, other: Self) -> Self {
        Self {
            revolutions: self.revolutions + other.revolutions,
            left: self.left + other.left,
            rested: self.rested + other.rested,
        }
    }
}

/// A motion that starts end on.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The motion.
    pub ending: Ending,
    /// The starts that end on it, in order.
    pub starts: Vec<usize>,
    /// Where the first of these was when that was told.
    pub motion: Motion,
}

/// What starts end on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ensemble {
    /// The motions, in the order of the first start of each.
    pub parts: Vec<Part>,
    /// The runs that were waited for longest.
    pub wandering: Wandering,
}

/// Revolutions that wandering runs are given all together: a chaos that is left once in a tenth of them is seen to be left.
const POOL: u64 = 100_000;
/// Wandering runs of which the growth of a deviation is measured.
const MEASURED: usize = 4;

/// The start that could not be run, and why.
type Failed = (usize, SimulateError);
/// What follows each release, rad.
type Fates = Vec<(f64, Fate, Ending)>;

/// The end of one run.
#[derive(Clone, Debug)]
struct End {
    run: Run,
    motion: Motion,
    /// Whether it had wandered before, for long enough to have forgotten its start.
    wandered: bool,
}

impl Ensemble {
    /// Runs `count` starts side by side, told to `watch` one by one; `start` gives none where one is impossible.
    ///
    /// What a rest leads to is found once for each release. A run that does neither is waited for as long as all such runs
    /// together say: if one of them comes to an orbit in the end, none of them is on an attractor yet.
    pub fn of(
        settling: &Settling<'_>,
        patience: Patience,
        count: usize,
        start: impl Fn(usize) -> Result<Option<Motion>, SimulateError> + Sync,
        watch: &dyn Watch,
    ) -> Result<Self, Failed> {
        let (done, total) = (AtomicU64::new(0), count as u64);
        let first = |index: usize| {
            watch.at("runs", done.fetch_add(1, Ordering::Relaxed), total);
            let run = start(index)?.map(|mut motion| -> Result<End, SimulateError> {
                Ok(End { run: settling.run(&mut motion, patience.revolutions)?, motion, wandered: false })
            });
            run.transpose()
        };
        let runs = (0..count).into_par_iter().map(|index| first(index).map_err(|error| (index, error)));
        let mut ends: Vec<Option<End>> = runs.collect::<Result<_, _>>()?;
        let wandering = wait(settling, &mut ends)?;
        let fates = fates(settling, &ends)?;
        let wanders = told_wandering(settling, &ends, &fates)?;
        let mut ensemble = Self { parts: Vec::new(), wandering };
        let mut wanderers = 0;
        for (index, end) in ends.into_iter().enumerate() {
            let Some(End { run, mut motion, .. }) = end else { continue };
            let ending = match run {
                Run::Arrives(orbit) => Ending::Orbit(orbit),
                Run::Stays => Ending::Stays,
                Run::Wanders => {
                    wanderers += 1;
                    match wanders.get((wanderers - 1) % wanders.len().max(1)) {
                        Some(ending) => ending.clone(),
                        None => continue,
                    }
                }
                Run::Released(release) => {
                    let Some((_, fate, ending)) = fates.iter().find(|(known, ..)| is_same_release(*known, release))
                    else {
                        continue;
                    };
                    if let Fate::Arrives(_, end) | Fate::Wanders(end) = fate {
                        motion = *end;
                    }
                    ending.clone()
                }
            };
            ensemble.add(ending, index, motion);
        }
        Ok(ensemble)
    }

    /// Counts a start that ends on `ending`.
    fn add(&mut self, ending: Ending, index: usize, motion: Motion) {
        match self.parts.iter_mut().find(|part| part.ending.is_same(&ending)) {
            Some(part) => {
                // That it rests is the later news.
                if matches!((&part.ending, &ending), (Ending::Chaotic(_), Ending::Resting(_))) {
                    part.ending = ending;
                }
                part.starts.push(index);
            }
            None => self.parts.push(Part { ending, starts: vec![index], motion }),
        }
    }
}

/// Runs those that wander on, until all of them together have run for as long as is told; what leaves at first was only slow
/// to settle, and does not count.
fn wait(settling: &Settling<'_>, ends: &mut [Option<End>]) -> Result<Wandering, Failed> {
    /// Revolutions that do not count, and the least that is worth a look for an orbit after them.
    const SLOW: u64 = 200;
    const LEAST: u64 = 25;
    let (mut all, mut round) = (None::<Wandering>, SLOW);
    loop {
        let wanderers = ends.iter().flatten().filter(|end| end.run == Run::Wanders).count() as u64;
        if wanderers == 0 || all.is_some_and(|all| all.revolutions >= POOL) {
            return Ok(all.unwrap_or_default());
        }
        let runs = ends.par_iter_mut().enumerate().map(|(index, end)| -> Result<Wandering, Failed> {
            let Some(End { run: run @ Run::Wanders, motion, wandered }) = end else { return Ok(Wandering::default()) };
            let begun = motion.revolution;
            *wandered = all.is_some();
            *run = settling.run(motion, round).map_err(|error| (index, error))?;
            let revolutions = motion.revolution - begun;
            let left = u64::from(matches!(run, Run::Arrives(_) | Run::Stays));
            Ok(Wandering { revolutions, left, rested: u64::from(matches!(run, Run::Released(_))) })
        });
        let found = runs.try_reduce(Wandering::default, |one, other| Ok(one.with(other)))?;
        all = Some(all.map_or_else(Wandering::default, |all| all.with(found)));
        round = (POOL / 4 / wanderers).max(LEAST);
    }
}

/// What follows each release that a run has come to, in the order of the runs.
fn fates(settling: &Settling<'_>, ends: &[Option<End>]) -> Result<Fates, Failed> {
    let mut fates = Fates::new();
    for (index, end) in ends.iter().enumerate() {
        if let Some(End { run: Run::Released(release), .. }) = end
            && !fates.iter().any(|(known, ..)| is_same_release(*known, *release))
        {
            let fate = settling.fate(*release).map_err(|error| (index, error))?;
            let ending = settling.after(&fate).map_err(|error| (index, error))?;
            fates.push((*release, fate, ending));
        }
    }
    Ok(fates)
}

/// What the runs that wander still are told to be, in turn.
///
/// Where others have left after they wandered as these do, chance alone decides when a run leaves: these are on their way to
/// where the others went, if all of those went to one motion.
fn told_wandering(settling: &Settling<'_>, ends: &[Option<End>], fates: &Fates) -> Result<Vec<Ending>, Failed> {
    let mut left: Vec<Ending> = Vec::new();
    for end in ends.iter().flatten().filter(|end| end.wandered) {
        let ending = match &end.run {
            Run::Arrives(orbit) => Some(Ending::Orbit(orbit.clone())),
            Run::Stays => Some(Ending::Stays),
            Run::Released(release) => ending_of(fates, *release).cloned(),
            Run::Wanders => None,
        };
        left.extend(ending.filter(|ending| !left.iter().any(|known| known.is_same(ending))));
    }
    if let [only] = left.as_slice() {
        return Ok(vec![only.clone()]);
    }
    let wanderers: Vec<(usize, Motion)> = ends
        .iter()
        .enumerate()
        .filter_map(|(index, end)| end.as_ref().filter(|end| end.run == Run::Wanders).map(|end| (index, end.motion)))
        .collect();
    let measured = |(index, motion): &(usize, Motion)| settling.by_growth(*motion).map_err(|error| (*index, error));
    let told: Vec<Ending> = wanderers.par_iter().take(MEASURED).map(measured).collect::<Result<_, _>>()?;
    if let Some(rested) = told.iter().find(|ending| ending.growth().is_none()) {
        return Ok(vec![rested.clone()]);
    }
    if !left.is_empty() {
        return Ok(told.iter().filter_map(Ending::growth).map(Ending::Undecided).collect());
    }
    let growths: Vec<Estimate> = told.iter().filter_map(Ending::growth).collect();
    let together = Ending::by_growth(Estimate::mean(&growths));
    // They are on the motion that rests now and then, if there is one.
    let long = fates.iter().map(|(.., ending)| ending).find(|ending| ending.is_long());
    Ok(match (&together, long) {
        (Ending::Chaotic(_), Some(resting)) => vec![resting.clone()],
        (Ending::Chaotic(_), None) => vec![together],
        // Where they are not chaotic all together, each is told by itself.
        _ => wanderers.par_iter().map(measured).collect::<Result<_, _>>()?,
    })
}

/// What follows a release, rad.
fn ending_of(fates: &Fates, release: f64) -> Option<&Ending> {
    fates.iter().find(|(known, ..)| is_same_release(*known, release)).map(|(.., ending)| ending)
}
