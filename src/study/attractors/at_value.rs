//! The attractors of one machine.

use crate::cam::within_a_turn;
use crate::orbit::long_run::{Budget, LongRun};
use crate::orbit::runs::LongRuns;
use crate::progress::Unwatched;
use crate::simulate::{Machine, Motion, SimulateError};
use crate::study::survey::{Attractor, Ensemble, Failed, Sample, Starts, Wandering, attractors_of};

/// The long-run behaviour of a machine at one value of the varied number.
#[derive(Clone, Debug, PartialEq)]
pub struct AttractorsAtValue {
    /// Budget of each run.
    pub budget: Budget,
    /// The motions that were found. Start indices below `sampled` belong to the sample.
    pub attractors: Vec<Attractor>,
    /// Number of starts of the sample.
    pub sampled: usize,
    /// Number of these starts whose runs leave the cam for good.
    pub off_for_good: usize,
    /// Number of starts from rest on the cam, one for each stretch on which the follower can rest. Their indices follow the sample's.
    pub rests: usize,
    /// Totals of the runs that wandered longest.
    pub wandering: Wandering,
    /// Starts whose runs could not go on, with the reason.
    pub failed: Vec<Failed>,
}

impl AttractorsAtValue {
    /// Finds the attractors from the starts of a sample, within a budget.
    pub fn new(machine: &Machine, sample: &Sample, budget: Budget) -> Result<Self, SimulateError> {
        Self::seeded(machine, (sample, budget), false)
    }

    /// Finds the attractors from given starts alone. For a sample of [`Starts`] it also runs from rest on each stretch of the cam where the
    /// follower can rest, and from the stable orbits that a search finds.
    pub(super) fn seeded(
        machine: &Machine,
        (sample, budget): (&Sample, Budget),
        two_impacts: bool,
    ) -> Result<Self, SimulateError> {
        let count = match sample {
            Sample::Given(starts) => {
                let runs = LongRuns::unaided(machine, budget);
                let start = |index: usize| starts[index].motion(machine).map(Some);
                let found = attractors_of(&runs, starts.len(), start, &Unwatched).map_err(|(_, error)| error)?;
                return Ok(Self::of(budget, found, starts.len(), 0));
            }
            Sample::Spread(count) => *count,
        };
        let mut runs = LongRuns::new(machine, budget)?;
        if two_impacts {
            runs.know_two_impacts()?;
        }
        let known: Vec<Motion> = runs.known().map(|orbit| orbit.motion(machine)).collect::<Result<_, _>>()?;
        let rests = machine.rests()?;
        let starts = Starts::of(machine);
        let start = |index: usize| {
            if index < count {
                return starts.motion(machine, index).map(Some);
            }
            let rest = index - count;
            let Some([from, to]) = rests.get(rest) else { return Ok(known.get(rest - rests.len()).copied()) };
            let angle = within_a_turn(from.midpoint(*to));
            machine.start_on_cam(angle, 0.0).map(|motion| motion.contact.then_some(motion))
        };
        let all = count + rests.len() + known.len();
        let found = attractors_of(&runs, all, start, &Unwatched).map_err(|(_, error)| error)?;
        Ok(Self::of(budget, found, count, rests.len()))
    }

    /// Builds the result from an ensemble whose first starts are `sampled` starts of a sample, followed by `rests` starts from rest.
    fn of(budget: Budget, found: Ensemble, sampled: usize, rests: usize) -> Self {
        let Ensemble { attractors, off_for_good, wandering, failed } = found;
        let off_for_good = off_for_good.into_iter().filter(|start| *start < sampled).count();
        Self { budget, attractors, sampled, off_for_good, rests, wandering, failed }
    }

    /// Whether a run from the sample, from rest on the cam or from a neighbouring value settles on an attractor. Runs that begin on the
    /// attractor do not count.
    pub fn is_reached(&self, attractor: &Attractor) -> bool {
        attractor.starts.is_empty() || attractor.starts.iter().any(|start| *start < self.sampled + self.rests)
    }

    /// Number of the sample's starts that could be run, at least 1.
    pub fn run(&self) -> usize {
        let failed = self.failed.iter().filter(|(start, _)| *start < self.sampled).count();
        (self.sampled - failed).max(1)
    }

    /// Number of the sample's starts that end on an attractor.
    pub fn count(&self, attractor: &Attractor) -> usize {
        attractor.starts.iter().filter(|start| **start < self.sampled).count()
    }

    /// Records an attractor that the motion of another value reaches at this one. Returns false if it is already known.
    pub(super) fn take(&mut self, attractor: Attractor) -> bool {
        match self.attractors.iter().position(|known| known.ending.is_same(&attractor.ending)) {
            Some(known) => {
                // A run from elsewhere has now reached an attractor that only runs begun on it had shown.
                if !self.is_reached(&self.attractors[known]) {
                    self.attractors[known].starts.clear();
                }
                false
            }
            None => {
                self.attractors.push(attractor);
                true
            }
        }
    }

    /// Returns the attractor that the motion of another value settles on at this machine, if it settles on one.
    pub fn come_to(&self, machine: &Machine, motion: &Motion) -> Result<Option<Attractor>, SimulateError> {
        /// Revolutions after which a motion that still wanders counts as wandering for good.
        const WAITED: u64 = 20_000;
        // At another value the cam may be where the follower was.
        let Ok(motion) = machine.resume(motion) else { return Ok(None) };
        let budget = Budget { transient: WAITED, patience: 0, ..self.budget };
        let mut runs = LongRuns::new(machine, budget)?;
        for attractor in &self.attractors {
            if let LongRun::Orbit(orbit) = &attractor.ending {
                runs.know(orbit)?;
            }
        }
        let found = attractors_of(&runs, 1, |_| Ok(Some(motion)), &Unwatched).map_err(|(_, error)| error)?;
        let Some(attractor) = found.attractors.into_iter().next() else { return Ok(None) };
        let ending = &attractor.ending;
        // Other runs have left such a motion, so it does not last.
        let is_on_its_way =
            matches!(ending, LongRun::Undecided(_)) || (self.wandering.left > 0 && ending.period().is_none());
        Ok((!is_on_its_way).then_some(Attractor { starts: Vec::new(), ..attractor }))
    }
}
