//! The runs of one machine: where they settle, and what follows when the cam lets go of a follower.
//!
//! A run that rests on the cam has no past: the cam lets go of it at an angle that the speed decides, and what follows is the
//! same each time. So all that comes of a rest is found once for each release, however many runs rest ([`LongRuns::after_release`]).

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

/// What a run comes to within so many revolutions.
#[derive(Clone, Debug, PartialEq)]
pub enum RunOutcome {
    /// A stable periodic orbit.
    Arrives(PeriodicOrbit),
    /// It stays on the cam for good.
    PermanentContact,
    /// It has rested on the cam, which let go of it at this angle, rad.
    Released(f64),
    /// None of these.
    Wanders,
}

/// What follows a release.
#[derive(Clone, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "there is one for each release, and none is kept in bulk")]
pub enum AfterRelease {
    /// The same release again, in the end.
    Recurs(StickingOrbit),
    /// A stable periodic orbit, and the run at it.
    Arrives(PeriodicOrbit, Motion),
    /// Neither in the revolutions that are waited from one rest to the next.
    Wanders {
        /// As the cam let go of it.
        released: Motion,
        /// After those revolutions.
        end: Motion,
    },
}

/// Revolutions after which a run has forgotten its start, if it is to be told by how it goes on.
const SETTLED: u64 = 100;

/// The runs of one machine, with the stable orbits of it that are known beforehand: a run that comes to one of them is told
/// sooner, and ends on the same orbit to the last bit as any other run that does.
#[derive(Clone, Debug)]
pub struct LongRuns<'a> {
    /// What turns.
    pub machine: &'a Machine,
    /// For how long runs are followed.
    pub budget: Budget,
    /// The size of the cam's lift and its top, m.
    size: f64,
    top: f64,
    /// Whether a flight may stay above the top: nothing draws the follower down to it from there.
    floats: bool,
    /// With the states as the cam passes angle 0.
    known: Vec<(PeriodicOrbit, Vec<State>)>,
}

impl<'a> LongRuns<'a> {
    /// The runs of `machine`, with the stable orbits of one impact known beforehand.
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

    /// Takes note of the stable orbits of two impacts in one revolution: of all but next to a fold, a graze or a corner. It takes up to
    /// seconds.
    pub fn know_two_impacts(&mut self) -> Result<(), SimulateError> {
        let solved = of_two_impacts(self.machine, &Unwatched).into_iter();
        let may_be = solved.filter(|solved| solved.standing != Standing::NoOrbit);
        let orbits: Vec<PeriodicOrbit> = may_be.filter_map(|solved| close(self.machine, &solved.guess)).collect();
        orbits.iter().try_for_each(|orbit| self.know(orbit))
    }

    /// The runs of `machine` without any orbit that is known beforehand, for a run or a few: a search for orbits takes as long as thousands of
    /// revolutions.
    pub fn unaided(machine: &'a Machine, budget: Budget) -> Self {
        let top = machine.cam().top();
        let floats = !(machine.flight().force(top) < 0.0);
        Self { machine, budget, size: lift_size(machine), top, floats, known: Vec::new() }
    }

    /// The orbits known.
    pub fn known(&self) -> impl Iterator<Item = &PeriodicOrbit> {
        self.known.iter().map(|(orbit, _)| orbit)
    }

    /// Takes note of an orbit, if it is stable, meets the cam without resting on it, and is not known.
    pub fn know(&mut self, orbit: &PeriodicOrbit) -> Result<(), SimulateError> {
        if draws(orbit) && !self.known.iter().any(|(known, _)| known.is_same(orbit)) {
            self.known.push((orbit.clone(), passages(self.machine, orbit)?));
        }
        Ok(())
    }

    /// Runs `motion` for up to `revolutions`, or to where it is told what it comes to.
    ///
    /// An orbit counts where the run repeats nearly, Newton's method leads from there to a stable one, and the run's distance
    /// from that shrinks as its multipliers say: a chaotic run now and then passes by a stable orbit outside of its basin.
    pub fn run(&self, motion: &mut Motion, revolutions: u64) -> Result<RunOutcome, SimulateError> {
        self.counted(motion, revolutions, &mut ImpactTally::default())
    }

    /// The same, with the impacts on the way added to others.
    fn counted(
        &self,
        motion: &mut Motion,
        revolutions: u64,
        met: &mut ImpactTally,
    ) -> Result<RunOutcome, SimulateError> {
        /// Revolutions before the first look for an orbit that is not known: what most starts near one need.
        const FIRST: u64 = 50;
        /// Revolutions from one look for a known orbit to the next.
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
            // A look takes revolutions: only where the run has come back to near where it was, and as many.
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

    /// Whether the follower is off the cam for good: its flight never comes down to the top of the cam.
    pub fn is_off_for_good(&self, motion: &Motion) -> bool {
        self.floats
            && motion.state.position > self.top
            && self.machine.flight().fall_to(self.top, motion.state).is_none()
    }

    /// The long-run motion of a run that has come to a release; with what is `known` to follow other releases.
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

    /// Runs `motion` to where the cam lets go of it, rad, if it does so before the goal, and counts the impacts on the way.
    fn to_release(&self, motion: &mut Motion, goal: Goal, met: &mut ImpactTally) -> Result<Option<f64>, SimulateError> {
        let flow = self.machine.advance(motion, goal, &mut |event: &Event| {
            met.take(event);
            if event.kind == EventKind::Release { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })?;
        Ok(flow.is_break().then_some(motion.cam_angle))
    }

    /// Whether nothing happens in the next revolution of a follower on the cam: it stays there.
    fn stays(&self, mut motion: Motion) -> Result<bool, SimulateError> {
        let goal = motion.after(1);
        Ok(self.machine.advance(&mut motion, goal, &mut |_: &Event| ControlFlow::Break(()))?.is_continue())
    }

    /// Whether `motion`, at cam angle 0, is so near to a stable orbit, with its `states` there, that it stays: its distance
    /// shrinks by what the multipliers say.
    fn has_arrived(&self, mut motion: Motion, orbit: &PeriodicOrbit, states: &[State]) -> Result<bool, SimulateError> {
        /// Periods in which the distance is to shrink, at most.
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
        // As many periods as leave a tenth, or as can be waited for.
        let periods = (elementary::ln(0.1_f64) / elementary::ln(modulus)).ceil().clamp(1.0, MOST);
        let goal = motion.after(periods as u64 * orbit.revolutions);
        if self.to_release(&mut motion, goal, &mut ImpactTally::default())?.is_some() {
            return Ok(false);
        }
        let shrunk = 0.5 * (1.0 + elementary::powf(modulus, periods)) * first;
        Ok(distance(&motion) <= shrunk.max(tolerance::ORBIT_CLOSURE.value * size))
    }

    /// What follows a release at `cam_angle`, rad, where the next rest is waited for as long as `rest` revolutions, as far as that is not `known`
    /// of it or of a release that comes later; and the revolutions that it was followed for.
    pub fn after_release(
        &self,
        cam_angle: f64,
        rest: u64,
        known: impl Fn(f64) -> Option<AfterRelease>,
    ) -> Result<(AfterRelease, u64), SimulateError> {
        // Each release with the revolutions and what was met from it to the next.
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
                let growth =
                    releases.iter().try_fold(0.0_f64, |most, release| self.grown(*release).map(|g| most.max(g)))?;
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

    /// The orbit that chance takes some runs to from a release, rad, of which rounding decides what follows: what bounces there is
    /// on its way to that.
    fn by_chance(&self, cam_angle: f64) -> Result<Option<AfterRelease>, SimulateError> {
        /// How many runs, each a little faster at the release than the one before.
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

    /// What a deviation grows by at most on the way from a release, rad, to the next rest, a natural logarithm: of a long way, on
    /// its beginning.
    fn grown(&self, cam_angle: f64) -> Result<f64, SimulateError> {
        /// Revolutions after which a deviation is as large as the motion, if it is to be at all.
        const LOOKED_AT: u64 = 200;
        let mut record = Record::over(1);
        record.take(self.machine, &mut self.released(cam_angle)?, LOOKED_AT)?;
        Ok(record.most())
    }

    /// A follower of which the cam lets go at an angle, rad.
    pub fn released(&self, cam_angle: f64) -> Result<Motion, SimulateError> {
        let mut motion = self.machine.start_on_cam(cam_angle, 0.0)?;
        if motion.contact {
            let goal = motion.after(1);
            self.to_release(&mut motion, goal, &mut ImpactTally::default())?;
        }
        Ok(motion)
    }

    /// A run that wanders from a release, when it has forgotten that: long before the end of what is waited for, where the follower may be
    /// about to rest.
    pub fn settled(&self, mut released: Motion) -> Result<Motion, SimulateError> {
        self.machine.revolve(&mut released, SETTLED)?;
        Ok(released)
    }

    /// What a motion comes to that has settled on nothing: chaotic or undecided by the growth of a small deviation, over up to so many
    /// records; or what it settles on before that is known. What is `known` to follow a release is not followed again.
    pub fn by_growth(
        &self,
        mut motion: Motion,
        records: u64,
        known: &dyn Fn(f64) -> Option<AfterRelease>,
    ) -> Result<LongRun, SimulateError> {
        /// Revolutions from one record to the next, with a look for an orbit.
        const LOOK: u64 = 8;
        let (rest, later_rest) = (self.budget.rest(), self.budget.later_rest());
        // That no rest came in fewer revolutions does not answer for more.
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
            // The cam may have let go of it already; else the record goes on from where it is.
            let mut onward = motion;
            match self.run(&mut onward, if rests { later_rest } else { LOOK })? {
                RunOutcome::Arrives(orbit) => return Ok(LongRun::Orbit(orbit)),
                RunOutcome::PermanentContact => return Ok(LongRun::PermanentContact),
                RunOutcome::Released(cam_angle) => {
                    match self.after_release(cam_angle, later_rest, |angle| known(angle).filter(answers))?.0 {
                        // What rests that seldom may do so any number of times.
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

/// Whether runs come to `orbit`, and do not rest on the way.
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
