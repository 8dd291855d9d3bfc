//! The runs of one machine: where they settle, and what follows when the cam releases the follower.
//!
//! A rest on the cam erases the past of a run: the speed alone decides the angle of the release, and the motion after it is the same each
//! time. So the motion after a rest is computed once for each release, however many runs rest ([`LongRuns::after_release`]).

use std::ops::ControlFlow;

use super::complete::{Standing, near_one_impact, of_two_impacts};
use super::cycle::lift_size;
use super::long_run::{Budget, LongRun, Recorded, StickingOrbit, is_same_release};
use super::near::{close, free, near_run};
use super::{Course, PeriodicOrbit};
use crate::elementary;
use crate::flight::State;
use crate::progress::Unwatched;
use crate::simulate::Record;
use crate::simulate::{Event, EventKind, Goal, ImpactTally, Machine, Motion, SimulateError};
use crate::tolerance;

/// Outcome of a run within a number of revolutions.
#[derive(Clone, Debug, PartialEq)]
pub enum RunOutcome {
    /// A stable periodic orbit.
    Arrives(PeriodicOrbit),
    /// The follower stays on the cam for good.
    PermanentContact,
    /// A release of the follower at this cam angle, rad, after a rest.
    Released(f64),
    /// No decision within the revolutions: the run wanders.
    Wanders,
}

/// Motion that follows a release.
#[derive(Clone, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "there is one for each release, and none is kept in bulk")]
pub enum AfterRelease {
    /// A release that recurs in the end.
    Recurs(StickingOrbit),
    /// A stable periodic orbit, and the run when it is on that orbit.
    Arrives(PeriodicOrbit, Motion),
    /// Neither a rest nor an orbit within the revolutions allowed from one rest to the next.
    Wanders {
        /// The run at the release.
        released: Motion,
        /// The run after those revolutions.
        end: Motion,
    },
}

/// Revolutions after which a wandering run has forgotten its start.
const SETTLED: u64 = 100;

/// The runs of one machine, with its stable orbits that are known beforehand. A run that converges to a known orbit is decided sooner, and
/// ends on the same orbit to the last bit as any other such run.
#[derive(Clone, Debug)]
pub struct LongRuns<'a> {
    /// The machine that runs.
    pub machine: &'a Machine,
    /// Revolutions for which runs are followed.
    pub budget: Budget,
    /// The size of the cam's lift and its top, m.
    size: f64,
    top: f64,
    /// Whether a flight may stay above the top, since nothing pulls the follower down to it from there.
    floats: bool,
    /// Known orbits, with their states as the cam passes angle 0.
    known: Vec<(PeriodicOrbit, Vec<State>)>,
}

impl<'a> LongRuns<'a> {
    /// Builds the runs of `machine`, with the stable orbits of one impact known beforehand.
    pub fn new(machine: &'a Machine, budget: Budget) -> Result<Self, SimulateError> {
        /// The most revolutions of an orbit with one impact.
        const ONE_IMPACT: u64 = 3;
        let mut new = Self::unaided(machine, budget);
        let guesses = (1..=ONE_IMPACT).flat_map(|revolutions| near_one_impact(machine, revolutions));
        for orbit in guesses.filter_map(|guess| close(machine, &guess)) {
            new.know(&orbit)?;
        }
        Ok(new)
    }

    /// Adds the stable orbits of two impacts in one revolution, except those next to a fold, a graze or a corner. This takes up to seconds.
    pub fn know_two_impacts(&mut self) -> Result<(), SimulateError> {
        let solved = of_two_impacts(self.machine, &Unwatched).into_iter();
        let may_be = solved.filter(|solved| solved.standing != Standing::NoOrbit);
        let orbits: Vec<PeriodicOrbit> = may_be.filter_map(|solved| close(self.machine, &solved.guess)).collect();
        orbits.iter().try_for_each(|orbit| self.know(orbit))
    }

    /// Builds the runs of `machine` without known orbits, for one run or a few. A search for orbits takes as long as thousands of
    /// revolutions.
    pub fn unaided(machine: &'a Machine, budget: Budget) -> Self {
        let top = machine.cam().top();
        let floats = !(machine.flight().force(top) < 0.0);
        Self { machine, budget, size: lift_size(machine), top, floats, known: Vec::new() }
    }

    /// The known orbits.
    pub fn known(&self) -> impl Iterator<Item = &PeriodicOrbit> {
        self.known.iter().map(|(orbit, _)| orbit)
    }

    /// Adds an orbit, if it is stable, meets the cam without resting on it, and is not known yet.
    pub fn know(&mut self, orbit: &PeriodicOrbit) -> Result<(), SimulateError> {
        if draws(orbit) && !self.known.iter().any(|(known, _)| known.is_same(orbit)) {
            self.known.push((orbit.clone(), passages(self.machine, orbit)?));
        }
        Ok(())
    }

    /// Runs `motion` for up to `revolutions`, or until its outcome is decided.
    ///
    /// An orbit counts if the run nearly repeats, Newton's method leads from there to a stable orbit, and the run's distance from the orbit
    /// shrinks as the multipliers predict. The last condition is needed since a chaotic run sometimes passes a stable orbit outside of its
    /// basin.
    pub fn run(&self, motion: &mut Motion, revolutions: u64) -> Result<RunOutcome, SimulateError> {
        self.counted(motion, revolutions, &mut ImpactTally::default())
    }

    /// Runs `motion` like `run`, and adds the impacts on the way to `met`.
    fn counted(
        &self,
        motion: &mut Motion,
        revolutions: u64,
        met: &mut ImpactTally,
    ) -> Result<RunOutcome, SimulateError> {
        /// Revolutions before the first search for an unknown orbit; most starts near one need so many.
        const FIRST: u64 = 50;
        /// Revolutions from one check for a known orbit to the next.
        const OFTEN: u64 = 8;
        // Orbits are compared as the cam passes angle 0.
        if motion.cam_angle > 0.0
            && let Some(release) = self.to_release(motion, motion.next(0.0), met)?
        {
            return Ok(RunOutcome::Released(release));
        }
        let (mut ran, mut look) = (0, FIRST.min(revolutions));
        let omega = self.machine.angular_velocity();
        let mut past: Vec<State> = Vec::new();
        while ran < revolutions {
            let back = look.saturating_sub(self.budget.longest);
            let stretch = if ran < back { OFTEN.min(back - ran) } else { 1 };
            if ran >= back {
                past.push(motion.state);
            }
            if let Some(release) = self.to_release(motion, motion.after(stretch), met)? {
                return Ok(RunOutcome::Released(release));
            }
            ran += stretch;
            if motion.contact && self.stays(*motion)? {
                return Ok(RunOutcome::PermanentContact);
            }
            if self.is_off_for_good(motion)
                && let Some(orbit) = free(self.machine, motion.state)
            {
                return Ok(RunOutcome::Arrives(orbit));
            }
            for (orbit, states) in &self.known {
                if self.has_arrived(*motion, orbit, states)? {
                    return Ok(RunOutcome::Arrives(orbit.clone()));
                }
            }
            if ran < look {
                continue;
            }
            look = revolutions.min(2 * look);
            // A search costs revolutions. So it is made only if the run has returned near an earlier state, and only up to that period.
            let near = tolerance::NEARLY_REPEATS.value * self.size;
            let before = past.iter().position(|state| motion.state.apart(*state, omega) <= near);
            let repeats_after = before.map(|before| (past.len() - before) as u64);
            past.clear();
            if let Some(longest) = repeats_after
                && let Some(orbit) = near_run(self.machine, *motion, 0, longest)?.filter(draws)
                && self.has_arrived(*motion, &orbit, &passages(self.machine, &orbit)?)?
            {
                return Ok(RunOutcome::Arrives(orbit));
            }
        }
        Ok(RunOutcome::Wanders)
    }

    /// Whether the follower is off the cam for good: its flight never returns to the top of the cam.
    pub fn is_off_for_good(&self, motion: &Motion) -> bool {
        self.floats
            && motion.state.position > self.top
            && self.machine.flight().fall_to(self.top, motion.state).is_none()
    }

    /// Long-run motion of a run after a release. `known` returns what follows other releases.
    pub fn ending_after(
        &self,
        after: &AfterRelease,
        known: &dyn Fn(f64) -> Option<AfterRelease>,
    ) -> Result<LongRun, SimulateError> {
        Ok(match after {
            AfterRelease::Recurs(orbit) => LongRun::Sticking(orbit.clone()),
            AfterRelease::Arrives(orbit, _) => LongRun::Orbit(orbit.clone()),
            AfterRelease::Wanders { end, .. } => self.by_growth(*end, Budget::RECORDS, known)?.having_rested(),
        })
    }

    /// Runs `motion` until the cam releases it, if it does so before the goal, and counts the impacts on the way. Returns the angle, rad.
    fn to_release(&self, motion: &mut Motion, goal: Goal, met: &mut ImpactTally) -> Result<Option<f64>, SimulateError> {
        let flow = self.machine.advance(motion, goal, &mut |event: &Event| {
            met.take(event);
            if event.kind == EventKind::Release { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })?;
        Ok(flow.is_break().then_some(motion.cam_angle))
    }

    /// Whether a follower on the cam stays there, since nothing happens in its next revolution.
    fn stays(&self, mut motion: Motion) -> Result<bool, SimulateError> {
        let goal = motion.after(1);
        Ok(self.machine.advance(&mut motion, goal, &mut |_: &Event| ControlFlow::Break(()))?.is_continue())
    }

    /// Whether `motion`, at cam angle 0, has converged to a stable orbit with these `states` there: its distance from the orbit shrinks as
    /// the multipliers predict.
    fn has_arrived(&self, mut motion: Motion, orbit: &PeriodicOrbit, states: &[State]) -> Result<bool, SimulateError> {
        /// Most periods in which the distance must shrink.
        const MOST: f64 = 100.0;
        let (size, omega) = (self.size, self.machine.angular_velocity());
        let distance = |motion: &Motion| {
            states.iter().map(|state| motion.state.apart(*state, omega)).fold(f64::INFINITY, f64::min)
        };
        let first = distance(&motion);
        if first > tolerance::NEARLY_REPEATS.value * size {
            return Ok(false);
        }
        let modulus = orbit.multipliers().iter().fold(0.0_f64, |largest, one| largest.max(one.modulus()));
        // Periods after which a tenth of the distance is left, up to the most allowed.
        let periods = (elementary::ln(0.1_f64) / elementary::ln(modulus)).ceil().clamp(1.0, MOST);
        let goal = motion.after(periods as u64 * orbit.revolutions);
        if self.to_release(&mut motion, goal, &mut ImpactTally::default())?.is_some() {
            return Ok(false);
        }
        let shrunk = 0.5 * (1.0 + elementary::powf(modulus, periods)) * first;
        Ok(distance(&motion) <= shrunk.max(tolerance::ORBIT_CLOSURE.value * size))
    }

    /// Follows a run from its release at `cam_angle`, rad, with up to `rest` revolutions to each next rest. Stops at a release whose
    /// continuation is `known`. Also returns the number of revolutions followed.
    pub fn after_release(
        &self,
        cam_angle: f64,
        rest: u64,
        known: impl Fn(f64) -> Option<AfterRelease>,
    ) -> Result<(AfterRelease, u64), SimulateError> {
        // Each release, with the revolutions and the impacts from it to the next.
        let mut releases: Vec<(f64, u64, ImpactTally)> = Vec::new();
        let (mut release, mut followed) = (cam_angle, 0);
        loop {
            if let Some(after) = known(release) {
                return Ok((after, followed));
            }
            let begun = self.released(release)?;
            let (mut motion, mut met) = (begun, ImpactTally::default());
            let run = self.counted(&mut motion, rest, &mut met)?;
            let turned = motion.revolution - begun.revolution;
            followed += turned;
            let next = match run {
                RunOutcome::Arrives(orbit) => return Ok((AfterRelease::Arrives(orbit, motion), followed)),
                RunOutcome::PermanentContact | RunOutcome::Wanders => {
                    return Ok((AfterRelease::Wanders { released: begun, end: motion }, followed));
                }
                RunOutcome::Released(next) => next,
            };
            releases.push((release, turned, met));
            if let Some(first) = releases.iter().position(|(known, ..)| is_same_release(*known, next)) {
                let period = &releases[first..];
                let releases: Vec<f64> = period.iter().map(|(angle, ..)| *angle).collect();
                let growth = self.grown(&releases)?;
                let revolutions = period.iter().map(|(_, turned, _)| turned).sum();
                let impacts = period.iter().map(|(.., met)| met.impacts).sum();
                let impact_speed = period.iter().fold(0.0_f64, |most, (.., met)| most.max(met.impact_speed));
                let resting = StickingOrbit { releases, revolutions, impacts, impact_speed, growth };
                let other = if resting.is_long() { self.by_chance(release)? } else { None };
                return Ok((other.unwrap_or(AfterRelease::Recurs(resting)), followed));
            }
            release = next;
        }
    }

    /// Looks for an orbit on which runs settle that leave a release, rad, slightly faster; for use where rounding decides what follows. If
    /// there is one, the motion that bounces there is on its way to this orbit.
    fn by_chance(&self, cam_angle: f64) -> Result<Option<AfterRelease>, SimulateError> {
        /// Number of runs, each a little faster at the release than the one before.
        const RUNS: u32 = 4;
        let faster = tolerance::SAME_ORBIT.value * self.size * self.machine.angular_velocity();
        for run in 1..=RUNS {
            let mut motion = self.machine.start_on_cam(cam_angle, f64::from(run) * faster)?;
            if let RunOutcome::Arrives(orbit) = self.run(&mut motion, self.budget.rest())? {
                return Ok(Some(AfterRelease::Arrives(orbit, motion)));
            }
        }
        Ok(None)
    }

    /// Largest growth of a deviation from one of these releases, rad, to the next rest, a natural logarithm. Only the beginning of a long
    /// way is followed. The search stops at a growth at which rounding decides what follows.
    fn grown(&self, releases: &[f64]) -> Result<f64, SimulateError> {
        /// Revolutions after which a deviation is as large as the motion, if it ever is, and revolutions from one look at it to the next.
        const LOOKED_AT: u64 = 200;
        const OFTEN: u64 = 20;
        let mut most = 0.0_f64;
        for release in releases {
            let (mut record, mut motion) = (Record::over(1), self.released(*release)?);
            while record.revolutions < LOOKED_AT && !record.rests() && most <= StickingOrbit::long() {
                record.take(self.machine, &mut motion, OFTEN)?;
                most = most.max(record.most());
            }
        }
        Ok(most)
    }

    /// Motion of a follower that the cam releases at an angle, rad.
    pub fn released(&self, cam_angle: f64) -> Result<Motion, SimulateError> {
        let mut motion = self.machine.start_on_cam(cam_angle, 0.0)?;
        if motion.contact {
            let goal = motion.after(1);
            self.to_release(&mut motion, goal, &mut ImpactTally::default())?;
        }
        Ok(motion)
    }

    /// Continues a run that wanders after a release until it has forgotten the release. At the end of the allowed revolutions, much later,
    /// the follower may be about to rest.
    pub fn settled(&self, mut released: Motion) -> Result<Motion, SimulateError> {
        self.machine.revolve(&mut released, SETTLED)?;
        Ok(released)
    }

    /// Judges a run that has settled on nothing, over up to `records` records of the growth of a small deviation. The result is chaotic,
    /// undecided, or the motion on which the run settles in the meantime. A release whose continuation is `known` is not followed again.
    pub fn by_growth(
        &self,
        mut motion: Motion,
        records: u64,
        known: &dyn Fn(f64) -> Option<AfterRelease>,
    ) -> Result<LongRun, SimulateError> {
        /// Revolutions from one record to the next, in which a search for an orbit is made.
        const LOOK: u64 = 8;
        let (rest, later_rest) = (self.budget.rest(), self.budget.later_rest());
        // No rest within fewer revolutions says nothing about more.
        let answers = |after: &AfterRelease| later_rest == rest || !matches!(after, AfterRelease::Wanders { .. });
        let fresh = || Record::over(self.budget.block());
        let mut record = fresh();
        let mut told = LongRun::by_growth(Recorded::of(&record));
        let records = if self.budget.record == 0 { 0 } else { records.max(1) };
        let (mut released, mut rested) = (false, false);
        for _ in 0..records {
            record.take(self.machine, &mut motion, self.budget.record)?;
            told = LongRun::by_growth(Recorded::of(&record));
            let rests = record.rests();
            rested |= rests;
            if matches!(told, LongRun::Chaotic(_)) && !rests {
                break;
            }
            // A copy runs ahead, since the cam may have released the follower already. If it finds nothing, the record continues from here.
            let mut onward = motion;
            match self.run(&mut onward, if rests { later_rest } else { LOOK })? {
                RunOutcome::Arrives(orbit) => return Ok(LongRun::Orbit(orbit)),
                RunOutcome::PermanentContact => return Ok(LongRun::PermanentContact),
                RunOutcome::Released(cam_angle) => {
                    match self.after_release(cam_angle, later_rest, |angle| known(angle).filter(answers))?.0 {
                        // Rests this rare may recur any number of times.
                        AfterRelease::Wanders { .. } if released => break,
                        AfterRelease::Wanders { end, .. } => (record, motion, released) = (fresh(), end, true),
                        settled => return self.ending_after(&settled, known),
                    }
                }
                RunOutcome::Wanders if rests => (record, motion) = (fresh(), onward),
                RunOutcome::Wanders => {}
            }
        }
        Ok(if rested { told.having_rested() } else { told })
    }
}

/// Whether runs can converge to `orbit` without resting on the way.
fn draws(orbit: &PeriodicOrbit) -> bool {
    orbit.is_stable() && matches!(orbit.course, Course::Impacts(_))
}

/// The states of an orbit as the cam passes angle 0, revolution by revolution.
fn passages(machine: &Machine, orbit: &PeriodicOrbit) -> Result<Vec<State>, SimulateError> {
    let mut motion = orbit.motion(machine)?;
    let mut states = vec![motion.state];
    for _ in 1..orbit.revolutions {
        machine.revolve(&mut motion, 1)?;
        states.push(motion.state);
    }
    Ok(states)
}
