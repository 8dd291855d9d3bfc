//! The attractors of one machine.

use crate::cam::within_a_turn;
use crate::orbit::long_run::{Budget, LongRun};
use crate::orbit::runs::LongRuns;
use crate::progress::Unwatched;
use crate::simulate::{Machine, Motion, SimulateError};
use crate::study::survey::{Attractor, Ensemble, Failed, Sample, Starts, Wandering, attractors_of};

/// What a machine does in the long run, at one value of what varies.
#[derive(Clone, Debug, PartialEq)]
pub struct AttractorsAtValue {
    /// For how long runs are followed.
    pub budget: Budget,
    /// The motions that were found; starts below `sampled` are the sample's.
    pub attractors: Vec<Attractor>,
    /// How many starts of the sample were run.
    pub sampled: usize,
    /// How many of these leave the cam for good.
    pub off_for_good: usize,
    /// How many were from rest on the cam, one for each place where that lets go of the follower; they follow the sample's.
    pub rests: usize,
    /// The runs that were waited for longest.
    pub wandering: Wandering,
    /// The starts whose runs could not go on, and why.
    pub failed: Vec<Failed>,
}

impl AttractorsAtValue {
    /// From the starts of a sample, within a budget.
    pub fn new(machine: &Machine, sample: &Sample, budget: Budget) -> Result<Self, SimulateError> {
        Self::seeded(machine, (sample, budget), false)
    }

    /// From the starts that are given, or from a sample of [`Starts`], from rest on the cam at each of its releases, and with the
    /// stable orbits that a search finds.
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

    /// What so many starts of a sample, and others, come to.
    fn of(budget: Budget, found: Ensemble, sampled: usize, rests: usize) -> Self {
        let Ensemble { attractors, off_for_good, wandering, failed } = found;
        let off_for_good = off_for_good.into_iter().filter(|start| *start < sampled).count();
        Self { budget, attractors, sampled, off_for_good, rests, wandering, failed }
    }

    /// Whether a run has come to an attractor, from the sample, from rest on the cam or from a neighbouring value, and not only one
    /// that began on it.
    pub fn is_reached(&self, attractor: &Attractor) -> bool {
        attractor.starts.is_empty() || attractor.starts.iter().any(|start| *start < self.sampled + self.rests)
    }

    /// How many of the sample's starts end on an attractor.
    pub fn count(&self, attractor: &Attractor) -> usize {
        attractor.starts.iter().filter(|start| **start < self.sampled).count()
    }

    /// Takes note of what the motion of another value has come to at this one; false where that is known.
    pub(super) fn take(&mut self, attractor: Attractor) -> bool {
        match self.attractors.iter().position(|known| known.ending.is_same(&attractor.ending)) {
            Some(known) => {
                // A run has come to what was only begun on.
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

    /// What the motion of another value comes to on this machine, if that is an attractor.
    pub fn come_to(&self, machine: &Machine, motion: &Motion) -> Result<Option<Attractor>, SimulateError> {
        /// Revolutions after which a motion that still wanders is one that does.
        const WAITED: u64 = 20_000;
        // At another value the cam may have come to where the follower is.
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
        // What wanders where others have left is on its way, too.
        let is_on_its_way =
            matches!(ending, LongRun::Undecided(_)) || (self.wandering.left > 0 && ending.period().is_none());
        Ok((!is_on_its_way).then_some(Attractor { starts: Vec::new(), ..attractor }))
    }
}
