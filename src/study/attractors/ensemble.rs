//! What many starts of one machine end on, and how many on each.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;
use serde::Serialize;

use crate::estimate::Estimate;
use crate::orbit::ending::{Ending, is_same_release};
use crate::orbit::fate::{Fate, LONGEST_REST, Run, Settling};
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
    /// How many have come to what is not left again: an orbit, the cam for good, or rests that recur.
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
    /// The starts that end on it, in order; none where only the motion of another speed came to it.
    pub starts: Vec<usize>,
    /// Where the first of these was when that was told.
    pub motion: Motion,
}

/// What starts end on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ensemble {
    /// The motions, in the order of the first start of each.
    pub parts: Vec<Part>,
    /// The starts whose runs leave the cam for good.
    pub off_for_good: Vec<usize>,
    /// The runs that were waited for longest.
    pub wandering: Wandering,
    /// The starts whose runs could not go on, and why.
    pub failed: Vec<Failed>,
}

/// Revolutions that wandering runs are given all together: a chaos that is left once in a tenth of them is seen to be left.
const POOL: u64 = 100_000;
/// Wandering runs of which the growth of a deviation is measured.
const MEASURED: usize = 4;

/// The start that could not be run, and why.
pub type Failed = (usize, SimulateError);
/// What follows each release, rad.
type Fates = Vec<(f64, Fate, Ending)>;

/// The end of one run.
#[derive(Clone, Debug)]
struct End {
    run: Run,
    motion: Motion,
    /// Whether it had wandered before, for long enough to have forgotten its start.
    wandered: bool,
    /// Why it could not go on.
    failed: Option<SimulateError>,
}

impl Ensemble {
    /// Runs `count` starts side by side, told to `watch` one by one; `start` gives none where one is impossible.
    ///
    /// What a rest leads to is found once for each release. A run that does neither is waited for as long as all such runs
    /// together say: if one of them comes to an orbit in the end, none of them is on an attractor yet. A run that cannot go on costs
    /// its own start; it is an error where no other start is left.
    pub fn of(
        settling: &Settling<'_>,
        patience: Patience,
        count: usize,
        start: impl Fn(usize) -> Result<Option<Motion>, SimulateError> + Sync,
        watch: &dyn Watch,
    ) -> Result<Self, Failed> {
        let told = each(watch, "runs", count);
        let first = |index: usize| {
            told();
            let run = start(index)?.map(|mut motion| -> Result<End, SimulateError> {
                Ok(End { run: settling.run(&mut motion, patience.revolutions)?, motion, wandered: false, failed: None })
            });
            run.transpose()
        };
        let mut failed = Vec::new();
        let runs: Vec<_> = (0..count).into_par_iter().map(first).collect();
        let run = |(index, run): (usize, Result<Option<End>, SimulateError>)| {
            run.unwrap_or_else(|error| {
                failed.push((index, error));
                None
            })
        };
        let mut ends: Vec<Option<End>> = runs.into_iter().enumerate().map(run).collect();
        let mut fates = Fates::new();
        follow(settling, &ends, &mut fates)?;
        let (outlast, wandering) = wait(settling, &mut ends, &fates, watch);
        for (index, end) in ends.iter_mut().enumerate() {
            if let Some(error) = end.as_ref().and_then(|end| end.failed) {
                failed.push((index, error));
                *end = None;
            }
        }
        if let Some(failure) = failed.first().filter(|_| ends.iter().all(Option::is_none)) {
            return Err(*failure);
        }
        follow(settling, &ends, &mut fates)?;
        let exits = exits(&ends, &fates);
        let wandering = Wandering { left: exits.len() as u64, ..wandering };
        let wanders = if exits.is_empty() { told_wandering(settling, &ends, &fates, outlast, watch)? } else { exits };
        // What is left sooner or later is left from each of its rests as well.
        let wanders_on = |ending: &Ending| wandering.left > 0 && is_wandering(ending);
        let mut ensemble = Self { wandering, failed, ..Self::default() };
        let mut wanderers = wanders.iter().cycle();
        for (index, end) in ends.into_iter().enumerate() {
            let Some(End { run, mut motion, .. }) = end else { continue };
            if settling.is_off_for_good(&motion) {
                ensemble.off_for_good.push(index);
            }
            let mut wandering_from = None;
            let ending = match run {
                Run::Arrives(orbit) => Some(Ending::Orbit(orbit)),
                Run::Stays => Some(Ending::Stays),
                Run::Wanders => wanderers.next().cloned(),
                Run::Released(release) => match fates.iter().find(|(known, ..)| is_same_release(*known, release)) {
                    Some((.., ending)) if wanders_on(ending) => wanderers.next().cloned(),
                    Some((_, fate, ending)) => {
                        match fate {
                            Fate::Recurs(_) => {}
                            Fate::Arrives(_, end) => motion = *end,
                            Fate::Wanders { released, .. } => wandering_from = Some(*released),
                        }
                        Some(ending.clone())
                    }
                    None => None,
                },
            };
            if let Some(ending) = ending {
                let settled = || wandering_from.map_or(Ok(motion), |released| settling.settled(released));
                ensemble.add(ending, index, outlast, settled).map_err(|error| (index, error))?;
            }
        }
        Ok(ensemble)
    }

    /// Counts a start that ends on `ending`; the first that does gives the motion.
    fn add(
        &mut self,
        ending: Ending,
        index: usize,
        outlast: bool,
        motion: impl FnOnce() -> Result<Motion, SimulateError>,
    ) -> Result<(), SimulateError> {
        // Chaos is not what rests where it outlasts that.
        let is_same =
            |part: &&mut Part| part.ending.is_same(&ending) && (part.ending.kind() == ending.kind() || !outlast);
        match self.parts.iter_mut().find(is_same) {
            Some(part) => {
                // That it rests is the later news.
                if matches!((&part.ending, &ending), (Ending::Chaotic(_), Ending::Resting(_))) {
                    part.ending = ending;
                }
                part.starts.push(index);
            }
            None => self.parts.push(Part { ending, starts: vec![index], motion: motion()? }),
        }
        Ok(())
    }
}

/// Runs those that wander on, until all of them together have run for as long as is told; what leaves at first was only slow
/// to settle, and does not count. With whether these are runs of another motion than those that had rested by then.
fn wait(settling: &Settling<'_>, ends: &mut [Option<End>], fates: &Fates, watch: &dyn Watch) -> (bool, Wandering) {
    /// Revolutions that do not count, and the least that is worth a look for an orbit after them.
    const SLOW: u64 = 200;
    const LEAST: u64 = 32;
    let (mut all, mut round, mut soon) = (None::<Wandering>, SLOW, Wandering::default());
    // Those that a release was followed by count as well.
    let followed = fates.iter().filter(|(_, fate, _)| matches!(fate, Fate::Wanders { .. })).count() as u64;
    let released = Wandering { revolutions: (followed * LONGEST_REST).min(POOL / 2), ..Wandering::default() };
    loop {
        let goes_on = |end: &&End| end.run == Run::Wanders && end.failed.is_none();
        let wanderers = ends.iter().flatten().filter(goes_on).count() as u64;
        if wanderers == 0 || all.is_some_and(|all| all.revolutions >= POOL) {
            let all = all.unwrap_or_default();
            return (outlasts(all, soon), all);
        }
        let told = each(watch, "runs that end on nothing so far", wanderers as usize);
        let runs = ends.par_iter_mut().map(|end| {
            let Some(End { run: run @ Run::Wanders, motion, wandered, failed: failed @ None }) = end else {
                return Wandering::default();
            };
            told();
            let begun = motion.revolution;
            *wandered = all.is_some();
            match settling.run(motion, round) {
                Ok(ended) => *run = ended,
                Err(error) => *failed = Some(error),
            }
            let revolutions = motion.revolution - begun;
            Wandering { revolutions, left: 0, rested: u64::from(matches!(run, Run::Released(_))) }
        });
        let found = runs.reduce(Wandering::default, Wandering::with);
        if all.is_none() {
            soon = ends.iter().flatten().map(soon_rested).fold(soon, Wandering::with);
        }
        all = Some(all.map_or(released, |all| all.with(found)));
        let left = POOL.saturating_sub(all.map_or(0, |all| all.revolutions));
        round = (left.min(POOL / 4) / wanderers).max(LEAST);
    }
}

/// For how long a run has wandered that may have come to rest, but for the time that it takes to forget its start.
fn soon_rested(end: &End) -> Wandering {
    /// Revolutions.
    const FORGOTTEN: u64 = 50;
    let rested = u64::from(matches!(end.run, Run::Released(_)));
    match end.motion.revolution.checked_sub(FORGOTTEN) {
        Some(revolutions) if rested > 0 || end.run == Run::Wanders => Wandering { revolutions, left: 0, rested },
        _ => Wandering::default(),
    }
}

/// Whether runs that wandered for long have rested so much less often than they did `soon` that they are another motion than those
/// that rested then.
fn outlasts(long: Wandering, soon: Wandering) -> bool {
    /// Of 10 rests that are to be expected there is none once in 20,000 times.
    const FEWER: f64 = 10.0;
    let rested = soon.rested as f64;
    // With 95 % it is more often than that.
    let rate = (rested - 2.0 * rested.sqrt()).max(0.0) / soon.revolutions.max(1) as f64;
    rate * long.revolutions as f64 > FEWER * (long.rested + 1) as f64
}

/// Finds what follows each release that a run has come to and that is not known yet, in the order of the runs.
fn follow(settling: &Settling<'_>, ends: &[Option<End>], fates: &mut Fates) -> Result<(), Failed> {
    for (index, end) in ends.iter().enumerate() {
        if let Some(End { run: Run::Released(release), .. }) = end
            && ending_of(fates, *release).is_none()
        {
            let known = |other: f64| {
                let known = fates.iter().find(|(known, ..)| is_same_release(*known, other));
                known.map(|(_, fate, _)| fate.clone())
            };
            let fate = settling.fate_beside(*release, known).map_err(|error| (index, error))?;
            let ending = settling.after(&fate).map_err(|error| (index, error))?;
            fates.push((*release, fate, ending));
        }
    }
    Ok(())
}

/// Whether a motion is left by chance alone, if it is left at all: chaos, and what bounces as chaos does until it rests.
fn is_wandering(ending: &Ending) -> bool {
    ending.growth().is_some() || ending.is_long()
}

/// What the runs have come to that left after they had wandered, each once. Chance alone decides when a run leaves, and to where:
/// those that wander still are on their way there, in these parts.
fn exits(ends: &[Option<End>], fates: &Fates) -> Vec<Ending> {
    let wandered = ends.iter().flatten().filter(|end| end.wandered);
    let left = wandered.filter_map(|end| match &end.run {
        Run::Arrives(orbit) => Some(Ending::Orbit(orbit.clone())),
        Run::Stays => Some(Ending::Stays),
        Run::Released(release) => ending_of(fates, *release).cloned(),
        Run::Wanders => None,
    });
    left.filter(|ending| !is_wandering(ending)).collect()
}

/// What the runs that wander, and that none has left, are told to be, in turn.
///
/// They are on the motion that rests now and then, if there is one, unless they outlast those that rest.
fn told_wandering(
    settling: &Settling<'_>,
    ends: &[Option<End>],
    fates: &Fates,
    outlast: bool,
    watch: &dyn Watch,
) -> Result<Vec<Ending>, Failed> {
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
    let growths: Vec<Estimate> = told.iter().filter_map(Ending::growth).collect();
    let together = Ending::by_growth(Estimate::mean(&growths));
    let long = fates.iter().map(|(.., ending)| ending).find(|ending| ending.is_long() && !outlast);
    Ok(match (&together, long) {
        (Ending::Chaotic(_), Some(resting)) => vec![resting.clone()],
        (Ending::Chaotic(_), None) => vec![together],
        // Where they are not chaotic all together, each is told by itself.
        _ => {
            let told = each(watch, "growth of deviations from runs that end on nothing", wanderers.len());
            let one = |run| {
                told();
                measured(run)
            };
            wanderers.par_iter().map(one).collect::<Result<_, _>>()?
        }
    })
}

/// Tells `watch` of one more piece of so many with each call.
fn each<'a>(watch: &'a dyn Watch, what: &'a str, total: usize) -> impl Fn() + Sync + 'a {
    let done = AtomicU64::new(0);
    move || watch.at(what, done.fetch_add(1, Ordering::Relaxed), total as u64)
}

/// What follows a release, rad.
fn ending_of(fates: &Fates, release: f64) -> Option<&Ending> {
    fates.iter().find(|(known, ..)| is_same_release(*known, release)).map(|(.., ending)| ending)
}
