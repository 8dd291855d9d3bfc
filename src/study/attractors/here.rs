//! The attractors at one speed.

use super::{Resolution, Step};
use crate::cam::within_a_turn;
use crate::orbit::long_run::{Budget, LongRun, Recorded};
use crate::orbit::runs::{LongRuns, RunOutcome};
use crate::progress::Unwatched;
use crate::simulate::{Machine, Motion, SimulateError, angular_velocity};
use crate::study::survey::{Ensemble, Failed, Part, Sample, Starts, Wandering, attractors_of};

/// What a machine does in the long run at one speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Here {
    /// Speed, rpm.
    pub rpm: f64,
    /// The motions that were found; starts below `sampled` are the sample's.
    pub parts: Vec<Part>,
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

impl Here {
    /// At `rpm`, from the starts of a sample, with the budget of a survey.
    pub fn new(machine: &Machine, rpm: f64, sample: &Sample) -> Result<Self, SimulateError> {
        let step = Step::at_most(rpm);
        Self::seeded(
            machine,
            rpm,
            &Resolution { step, sample: sample.clone(), budget: Budget::SURVEY, two_impacts: false },
        )
    }

    /// At `rpm`: from the starts that are given, or from a sample of [`Starts`], from rest on the cam at each of its releases, and with the
    /// stable orbits that a search finds.
    pub(super) fn seeded(machine: &Machine, rpm: f64, resolution: &Resolution) -> Result<Self, SimulateError> {
        let machine = machine.at_speed(angular_velocity(rpm));
        let Resolution { sample, budget, two_impacts, .. } = resolution;
        let count = match sample {
            Sample::Given(starts) => {
                let runs = LongRuns::unaided(&machine, *budget);
                let start = |index: usize| starts[index].motion(&machine).map(Some);
                let found = attractors_of(&runs, starts.len(), start, &Unwatched).map_err(|(_, error)| error)?;
                return Ok(Self::of(rpm, found, starts.len(), 0));
            }
            Sample::Spread(count) => *count,
        };
        let mut runs = LongRuns::new(&machine, *budget)?;
        if *two_impacts {
            runs.know_two_impacts()?;
        }
        let known: Vec<Motion> = runs.known().map(|orbit| orbit.motion(&machine)).collect::<Result<_, _>>()?;
        let rests = machine.rests()?;
        let starts = Starts::of(&machine);
        let start = |index: usize| {
            if index < count {
                return starts.motion(&machine, index).map(Some);
            }
            let rest = index - count;
            let Some([from, to]) = rests.get(rest) else { return Ok(known.get(rest - rests.len()).copied()) };
            let angle = within_a_turn(from.midpoint(*to));
            machine.start_on_cam(angle, 0.0).map(|motion| motion.contact.then_some(motion))
        };
        let all = count + rests.len() + known.len();
        let found = attractors_of(&runs, all, start, &Unwatched).map_err(|(_, error)| error)?;
        Ok(Self::of(rpm, found, count, rests.len()))
    }

    /// What so many starts of a sample, and others, come to.
    fn of(rpm: f64, found: Ensemble, sampled: usize, rests: usize) -> Self {
        let Ensemble { parts, off_for_good, wandering, failed } = found;
        let off_for_good = off_for_good.into_iter().filter(|start| *start < sampled).count();
        Self { rpm, parts, sampled, off_for_good, rests, wandering, failed }
    }

    /// Whether a run has come to a part, from the sample, from rest on the cam or from a neighbouring speed, and not only one
    /// that began on it.
    pub fn is_reached(&self, part: &Part) -> bool {
        part.starts.is_empty() || part.starts.iter().any(|start| *start < self.sampled + self.rests)
    }

    /// How many of the sample's starts end on a part.
    pub fn count(&self, part: &Part) -> usize {
        part.starts.iter().filter(|start| **start < self.sampled).count()
    }

    /// Takes note of what the motion of another speed has come to at this one; false where that is known.
    pub(super) fn take(&mut self, part: Part) -> bool {
        match self.parts.iter().position(|known| known.ending.is_same(&part.ending)) {
            Some(known) => {
                // A run has come to what was only begun on.
                if !self.is_reached(&self.parts[known]) {
                    self.parts[known].starts.clear();
                }
                false
            }
            None => {
                self.parts.push(part);
                true
            }
        }
    }

    /// What the motion of another speed comes to at this one, if that is an attractor.
    pub fn come_to(&self, machine: &Machine, motion: &Motion) -> Result<Option<Part>, SimulateError> {
        /// Revolutions after which a motion that still wanders is one that does.
        const WAITED: u64 = 20_000;
        let machine = machine.at_speed(angular_velocity(self.rpm));
        // At another speed the cam may have come to where the follower is.
        let Ok(mut motion) = machine.resume(motion) else { return Ok(None) };
        let mut runs = LongRuns::new(&machine, Budget::SURVEY)?;
        for part in &self.parts {
            if let LongRun::Orbit(orbit) = &part.ending {
                runs.know(orbit)?;
            }
        }
        let begun = motion.revolution;
        let (ending, more) = match runs.run(&mut motion, WAITED)? {
            RunOutcome::Arrives(orbit) => (LongRun::Orbit(orbit), 0),
            RunOutcome::PermanentContact => (LongRun::PermanentContact, 0),
            RunOutcome::Released(release) => {
                let (after, followed) = runs.after_release(release, runs.budget.rest(), |_| None)?;
                (runs.ending_after(&after)?, followed)
            }
            RunOutcome::Wanders => (runs.by_growth(motion, 1)?, 0),
        };
        let followed = motion.revolution - begun + more + ending.of_growth().map_or(0, Recorded::each);
        // What wanders where others have left is on its way, too.
        let is_on_its_way =
            matches!(ending, LongRun::Undecided(_)) || (self.wandering.left > 0 && ending.period().is_none());
        Ok((!is_on_its_way).then_some(Part { ending, starts: Vec::new(), followed: vec![followed], motion }))
    }
}
