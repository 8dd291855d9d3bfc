//! Finds the motions on which several starts of one machine settle, and how many starts settle on each.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;
use serde::Serialize;

use crate::orbit::long_run::{Budget, LongRun, Recorded, is_same_release};
use crate::orbit::runs::{AfterRelease, LongRuns, RunOutcome};
use crate::progress::{Unwatched, Watch};
use crate::simulate::{Machine, Motion, SimulateError};

/// Totals over the runs that neither rest nor settle on an orbit soon, from then on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Wandering {
    /// Revolutions run.
    pub revolutions: u64,
    /// Runs that ended in a motion they do not leave again: an orbit, permanent contact, or recurring rests.
    pub left: u64,
    /// Runs that rested on the cam.
    pub rested: u64,
}

impl Wandering {
    /// Sums the totals of both.
    pub fn with(self, other: Self) -> Self {
        Self {
            revolutions: self.revolutions + other.revolutions,
            left: self.left + other.left,
            rested: self.rested + other.rested,
        }
    }
}

/// A motion on which starts settle.
#[derive(Clone, Debug, PartialEq)]
pub struct Attractor {
    /// The motion.
    pub ending: LongRun,
    /// The starts that settle on it, in order; none if only the motion of another speed reached it.
    pub starts: Vec<usize>,
    /// Revolutions that the run from each start, or the run from another speed, was followed for until it was judged.
    pub followed: Vec<u64>,
    /// State of the first of these runs when it was judged.
    pub motion: Motion,
}

impl Attractor {
    /// Total revolutions of the runs that settle on it.
    pub fn followed(&self) -> u64 {
        self.followed.iter().sum()
    }
}

/// The motions on which the starts of a machine settle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ensemble {
    /// The motions, in the order of their first starts.
    pub attractors: Vec<Attractor>,
    /// Starts whose runs leave the cam for good.
    pub off_for_good: Vec<usize>,
    /// Totals of the runs that wandered longest.
    pub wandering: Wandering,
    /// Starts whose runs could not go on, and why.
    pub failed: Vec<Failed>,
}

/// Wandering runs whose growth is measured over the full number of records. All further runs together get as many records as these.
const MEASURED: u64 = 4;

/// A start that could not be run, and why.
pub type Failed = (usize, SimulateError);

/// The consequence of each release that a run has reached.
type Releases = Vec<Release>;

#[derive(Clone, Debug)]
struct Release {
    /// Cam angle of the release, rad.
    cam_angle: f64,
    after: AfterRelease,
    ending: LongRun,
    /// Revolutions that the run was followed for from the release.
    followed: u64,
}

/// The end of one run.
#[derive(Clone, Debug)]
struct End {
    /// The outcome, or why the run could not go on.
    run: Result<RunOutcome, SimulateError>,
    motion: Motion,
    /// Revolution at which the run began.
    begun: u64,
    /// Whether the run had already wandered long enough to forget its start.
    wandered: bool,
}

/// A judged start.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// The motion on which it settles.
    pub ending: LongRun,
    /// Revolutions that its run was followed for until it was judged.
    pub followed: u64,
    /// Index of the start.
    start: usize,
    /// State of the run when it was judged; for a run that wanders from a release, its state at that release.
    motion: Motion,
    /// Whether the run has yet to forget that release.
    released: bool,
}

/// Finds the long-run motion of one start within a budget, without regard to any other run.
pub fn long_run(machine: &Machine, motion: Motion, budget: Budget) -> Result<Judged, SimulateError> {
    let found = judged(&LongRuns::unaided(machine, budget), 1, |_| Ok(Some(motion)), &Unwatched);
    let (mut judged, ..) = found.map_err(|(_, error)| error)?;
    // One start settles on one motion.
    Ok(judged.swap_remove(0))
}

/// Finds the long-run motions of `count` starts. Runs go side by side, and `watch` is notified of each. `start` returns none for an
/// impossible start.
///
/// The motion after a rest is found once for each release. Runs that neither rest nor settle on an orbit share the patience of the budget.
/// If one of them settles on an orbit in the end, none of them is on an attractor yet. A run that cannot go on affects only its own start.
/// Fails if no other start is left.
pub fn attractors_of(
    runs: &LongRuns<'_>,
    count: usize,
    start: impl Fn(usize) -> Result<Option<Motion>, SimulateError> + Sync,
    watch: &dyn Watch,
) -> Result<Ensemble, Failed> {
    let (judged, mut ensemble, outlast) = judged(runs, count, start, watch)?;
    for one in judged {
        let index = one.start;
        ensemble.add(runs, one, outlast).map_err(|error| (index, error))?;
    }
    Ok(ensemble)
}

/// Judges each start. Returns also an ensemble without attractors, and whether the chaotic motion outlasts the rests.
fn judged(
    runs: &LongRuns<'_>,
    count: usize,
    start: impl Fn(usize) -> Result<Option<Motion>, SimulateError> + Sync,
    watch: &dyn Watch,
) -> Result<(Vec<Judged>, Ensemble, bool), Failed> {
    let told = each(watch, "runs", count);
    let first = |index: usize| {
        told();
        let run = start(index)?.map(|mut motion| -> Result<End, SimulateError> {
            let begun = motion.revolution;
            let run = runs.run(&mut motion, runs.budget.transient)?;
            Ok(End { run: Ok(run), motion, begun, wandered: false })
        });
        run.transpose()
    };
    let mut failed = Vec::new();
    let begun: Vec<_> = (0..count).into_par_iter().map(first).collect();
    let run = |(index, run): (usize, Result<Option<End>, SimulateError>)| {
        run.unwrap_or_else(|error| {
            failed.push((index, error));
            None
        })
    };
    let mut ends: Vec<Option<End>> = begun.into_iter().enumerate().map(run).collect();
    let mut releases = Releases::new();
    follow(runs, &ends, &mut releases)?;
    let (outlast, wandering) = wait(runs, &mut ends, &releases, watch);
    for (index, end) in ends.iter_mut().enumerate() {
        if let Some(End { run: Err(error), .. }) = end {
            failed.push((index, *error));
            *end = None;
        }
    }
    if let Some(failure) = failed.first().filter(|_| ends.iter().all(Option::is_none)) {
        return Err(*failure);
    }
    follow(runs, &ends, &mut releases)?;
    let exits = exits(&ends, &releases);
    let wandering = Wandering { left: exits.len() as u64, ..wandering };
    let wanders = if exits.is_empty() { told_wandering(runs, &ends, &releases, outlast, watch)? } else { exits };
    // A motion that runs leave sooner or later is also left after each of its rests.
    let wanders_on = |ending: &LongRun| wandering.left > 0 && ending.wanders();
    let mut ensemble = Ensemble { wandering, failed, ..Ensemble::default() };
    // Wandering runs get the endings in turn. An ending of several recorded runs gives their revolutions to as many of the wandering runs.
    let mut wanderers = (0_u64..).flat_map(|round| {
        wanders.iter().map(move |ending| {
            let growth = ending.of_growth().filter(|growth| round < growth.runs);
            (ending.clone(), growth.map_or(0, Recorded::each))
        })
    });
    let mut wanderer = || (!wanders.is_empty()).then(|| wanderers.next()).flatten();
    let mut judged = Vec::new();
    for (start, end) in ends.into_iter().enumerate() {
        let Some(End { run: Ok(run), mut motion, begun, .. }) = end else { continue };
        if runs.is_off_for_good(&motion) {
            ensemble.off_for_good.push(start);
        }
        let (mut released, mut followed) = (false, motion.revolution - begun);
        let ending = match run {
            RunOutcome::Arrives(orbit) => Some((LongRun::Orbit(orbit), 0)),
            RunOutcome::PermanentContact => Some((LongRun::PermanentContact, 0)),
            RunOutcome::Wanders => wanderer(),
            RunOutcome::Released(cam_angle) => match find(&releases, cam_angle) {
                Some(release) if wanders_on(&release.ending) => wanderer(),
                Some(release) => {
                    followed += release.followed;
                    match &release.after {
                        AfterRelease::Recurs(_) => {}
                        AfterRelease::Arrives(_, end) => motion = *end,
                        AfterRelease::Wanders { released: begun, .. } => (motion, released) = (*begun, true),
                    }
                    Some((release.ending.clone(), release.ending.of_growth().map_or(0, Recorded::each)))
                }
                None => None,
            },
        };
        if let Some((ending, recorded)) = ending {
            followed += recorded;
            judged.push(Judged { ending, followed, start, motion, released });
        }
    }
    Ok((judged, ensemble, outlast))
}

impl Ensemble {
    /// Counts a start under the motion on which it settles; the first start of a motion provides its state.
    fn add(&mut self, runs: &LongRuns<'_>, one: Judged, outlast: bool) -> Result<(), SimulateError> {
        let Judged { ending, followed, start, motion, released } = one;
        // A chaotic motion that outlasts the rests is not the motion that rests.
        let is_same =
            |part: &&mut Attractor| part.ending.is_same(&ending) && (part.ending.kind() == ending.kind() || !outlast);
        match self.attractors.iter_mut().find(is_same) {
            Some(part) => {
                // A rest is the later finding and replaces chaos.
                if matches!((&part.ending, &ending), (LongRun::Chaotic(_), LongRun::Sticking(_))) {
                    part.ending = ending;
                }
                part.starts.push(start);
                part.followed.push(followed);
            }
            None => {
                let motion = if released { runs.settled(motion)? } else { motion };
                self.attractors.push(Attractor { ending, starts: vec![start], followed: vec![followed], motion });
            }
        }
        Ok(())
    }
}

/// Runs the wandering runs on until their total reaches the patience of the budget. Runs that leave at first were only slow to settle and
/// do not count. Returns also whether the wandering runs are on another motion than those that had rested by then.
fn wait(runs: &LongRuns<'_>, ends: &mut [Option<End>], releases: &Releases, watch: &dyn Watch) -> (bool, Wandering) {
    /// Least revolutions after which an orbit is looked for.
    const LEAST: u64 = 32;
    let Budget { transient, patience, .. } = runs.budget;
    if patience == 0 {
        return (false, Wandering::default());
    }
    let (mut all, mut round, mut soon) = (None::<Wandering>, transient.max(1), Wandering::default());
    // The runs after a release that wander count as well.
    let followed = releases.iter().filter(|it| matches!(it.after, AfterRelease::Wanders { .. })).count() as u64;
    let released = Wandering {
        revolutions: followed.saturating_mul(runs.budget.rest()).min(patience / 2),
        ..Wandering::default()
    };
    loop {
        let goes_on = |end: &&End| end.run == Ok(RunOutcome::Wanders);
        let wanderers = ends.iter().flatten().filter(goes_on).count() as u64;
        if wanderers == 0 || all.is_some_and(|all| all.revolutions >= patience) {
            let all = all.unwrap_or_default();
            return (outlasts(all, soon), all);
        }
        let told = each(watch, "runs that have not settled so far", wanderers as usize);
        let stretch = ends.par_iter_mut().map(|end| {
            let Some(End { run: run @ Ok(RunOutcome::Wanders), motion, wandered, .. }) = end else {
                return Wandering::default();
            };
            told();
            let begun = motion.revolution;
            *wandered = all.is_some();
            *run = runs.run(motion, round);
            let revolutions = motion.revolution - begun;
            Wandering { revolutions, left: 0, rested: u64::from(matches!(run, Ok(RunOutcome::Released(_)))) }
        });
        let found = stretch.reduce(Wandering::default, Wandering::with);
        if all.is_none() {
            let first = |end: &End| soon_rested(&end.run, end.motion.revolution - end.begun);
            soon = ends.iter().flatten().map(first).fold(soon, Wandering::with);
        }
        all = Some(all.map_or(released, |all| all.with(found)));
        let left = patience.saturating_sub(all.map_or(0, |all| all.revolutions));
        round = (left.min(patience / 4) / wanderers).max(LEAST);
    }
}

/// Revolutions for which a run of `revolutions` has wandered, without those that it needs to forget its start, and whether it rested.
#[doc(hidden)]
pub fn soon_rested(run: &Result<RunOutcome, SimulateError>, revolutions: u64) -> Wandering {
    /// Revolutions after which the start is forgotten.
    const FORGOTTEN: u64 = 50;
    let rested = match run {
        Ok(RunOutcome::Released(_)) => 1,
        Ok(RunOutcome::Wanders) => 0,
        // A run that has settled can no longer rest.
        Ok(RunOutcome::Arrives(_) | RunOutcome::PermanentContact) | Err(_) => return Wandering::default(),
    };
    let wandered = revolutions.checked_sub(FORGOTTEN);
    wandered.map_or_else(Wandering::default, |revolutions| Wandering { revolutions, left: 0, rested })
}

/// Whether the long wandering runs rest so much less often than they did `soon` that they are on another motion than the runs that rested
/// then.
#[doc(hidden)]
pub fn outlasts(long: Wandering, soon: Wandering) -> bool {
    /// If 10 rests are expected, none occurs once in 20,000 times.
    const FEWER: f64 = 10.0;
    let rested = soon.rested as f64;
    // The true rate is above this with 95 % confidence.
    let rate = (rested - 2.0 * rested.sqrt()).max(0.0) / soon.revolutions.max(1) as f64;
    rate * long.revolutions as f64 > FEWER * (long.rested + 1) as f64
}

/// Finds what follows each release that a run has reached and that is not known yet, in the order of the runs.
fn follow(runs: &LongRuns<'_>, ends: &[Option<End>], releases: &mut Releases) -> Result<(), Failed> {
    for (index, end) in ends.iter().enumerate() {
        if let Some(End { run: Ok(RunOutcome::Released(cam_angle)), .. }) = end
            && find(releases, *cam_angle).is_none()
        {
            let known = |other: f64| known(releases, other);
            let (after, followed) =
                runs.after_release(*cam_angle, runs.budget.rest(), known).map_err(|error| (index, error))?;
            let ending = runs.ending_after(&after, &known).map_err(|error| (index, error))?;
            releases.push(Release { cam_angle: *cam_angle, after, ending, followed });
        }
    }
    Ok(())
}

/// Returns the motions that runs reached after they had wandered, one for each run. Chance alone decides when a run leaves and to which
/// motion, so the runs that still wander will end on these motions in the same proportions.
fn exits(ends: &[Option<End>], releases: &Releases) -> Vec<LongRun> {
    let wandered = ends.iter().flatten().filter(|end| end.wandered);
    let left = wandered.filter_map(|end| match &end.run {
        Ok(RunOutcome::Arrives(orbit)) => Some(LongRun::Orbit(orbit.clone())),
        Ok(RunOutcome::PermanentContact) => Some(LongRun::PermanentContact),
        Ok(RunOutcome::Released(cam_angle)) => find(releases, *cam_angle).map(|release| release.ending.clone()),
        Ok(RunOutcome::Wanders) | Err(_) => None,
    });
    left.filter(|ending| !ending.wanders()).collect()
}

/// Returns the motions assigned in turn to the runs that still wander, if no run has left.
///
/// If some motion rests now and then, the runs are on it, unless they outlast the runs that rest.
fn told_wandering(
    runs: &LongRuns<'_>,
    ends: &[Option<End>],
    releases: &Releases,
    outlast: bool,
    watch: &dyn Watch,
) -> Result<Vec<LongRun>, Failed> {
    let wanders = |end: &&End| end.run == Ok(RunOutcome::Wanders);
    let wanderers: Vec<(usize, Motion)> = ends
        .iter()
        .enumerate()
        .filter_map(|(index, end)| end.as_ref().filter(wanders).map(|end| (index, end.motion)))
        .collect();
    let measured = |(index, motion): &(usize, Motion), records: u64| {
        runs.by_growth(*motion, records, &|other| known(releases, other)).map_err(|error| (*index, error))
    };
    let first = wanderers.par_iter().take(MEASURED as usize);
    let told: Vec<LongRun> = first.map(|run| measured(run, Budget::RECORDS)).collect::<Result<_, _>>()?;
    if let Some(settled) = told.iter().find(|ending| ending.of_growth().is_none()) {
        return Ok(vec![settled.clone()]);
    }
    let together =
        LongRun::by_growth(Recorded::together(&told.iter().filter_map(LongRun::of_growth).collect::<Vec<_>>()));
    let long = releases.iter().map(|release| &release.ending).find(|ending| ending.is_long() && !outlast);
    Ok(match (&together, long) {
        (LongRun::Chaotic(_), Some(resting)) => vec![resting.clone()],
        (LongRun::Chaotic(_), None) => vec![together],
        // If they are not chaotic together, each is judged by itself.
        _ => {
            let rest = wanderers.get(told.len()..).unwrap_or_default();
            let further = each(watch, "growth of deviations from runs that have not settled", rest.len());
            let records = MEASURED * Budget::RECORDS / (rest.len() as u64).max(1);
            let one = |run| {
                further();
                measured(run, records.clamp(1, Budget::RECORDS))
            };
            let rest: Vec<LongRun> = rest.par_iter().map(one).collect::<Result<_, _>>()?;
            [told, rest].concat()
        }
    })
}

/// Returns a function that reports one more piece of `total` to `watch` with each call.
fn each<'a>(watch: &'a dyn Watch, what: &'a str, total: usize) -> impl Fn() + Sync + 'a {
    let done = AtomicU64::new(0);
    move || watch.at(what, done.fetch_add(1, Ordering::Relaxed), total as u64)
}

/// Looks up the release at a cam angle, rad.
fn find(releases: &Releases, cam_angle: f64) -> Option<&Release> {
    releases.iter().find(|known| is_same_release(known.cam_angle, cam_angle))
}

/// Looks up what is known to follow a release at a cam angle, rad.
fn known(releases: &Releases, cam_angle: f64) -> Option<AfterRelease> {
    find(releases, cam_angle).map(|release| release.after.clone())
}
