//! The attractors at one speed.

use super::ensemble::{Ensemble, Failed, Part, Patience, Wandering};
use super::starts::Starts;
use crate::cam::within_a_turn;
use crate::orbit::ending::Ending;
use crate::orbit::fate::{Run, Settling};
use crate::progress::Unwatched;
use crate::simulate::{Machine, Motion, SimulateError, angular_velocity};

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
    /// At `rpm`, from `sampled` starts of [`Starts`], from rest on the cam at each of its releases, and with the stable orbits
    /// that a search finds.
    pub fn new(machine: &Machine, rpm: f64, sampled: usize) -> Result<Self, SimulateError> {
        Self::seeded(machine, rpm, sampled, false)
    }

    /// The same, on all of two impacts in one revolution, too, if `two_impacts`.
    pub(super) fn seeded(
        machine: &Machine,
        rpm: f64,
        sampled: usize,
        two_impacts: bool,
    ) -> Result<Self, SimulateError> {
        let machine = machine.at_speed(angular_velocity(rpm));
        let patience = Patience::default();
        let mut settling = Settling::new(&machine, patience.longest)?;
        if two_impacts {
            settling.know_two_impacts()?;
        }
        let known: Vec<Motion> =
            settling.known().map(|orbit| machine.start(0.0, orbit.state)).collect::<Result<_, _>>()?;
        let rests = machine.rests()?;
        let starts = Starts::of(&machine);
        let start = |index: usize| {
            if index < sampled {
                return starts.motion(&machine, index).map(Some);
            }
            let rest = index - sampled;
            let Some([from, to]) = rests.get(rest) else { return Ok(known.get(rest - rests.len()).copied()) };
            let angle = within_a_turn(from.midpoint(*to));
            machine.start_on_cam(angle, 0.0).map(|motion| motion.contact.then_some(motion))
        };
        let count = sampled + rests.len() + known.len();
        let Ensemble { parts, off_for_good, wandering, failed } =
            Ensemble::of(&settling, patience, count, start, &Unwatched).map_err(|(_, error)| error)?;
        let off_for_good = off_for_good.into_iter().filter(|start| *start < sampled).count();
        Ok(Self { rpm, parts, sampled, off_for_good, rests: rests.len(), wandering, failed })
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
        let mut settling = Settling::new(&machine, Patience::default().longest)?;
        for part in &self.parts {
            if let Ending::Orbit(orbit) = &part.ending {
                settling.know(orbit)?;
            }
        }
        let ending = match settling.run(&mut motion, WAITED)? {
            Run::Arrives(orbit) => Ending::Orbit(orbit),
            Run::Stays => Ending::Stays,
            Run::Released(release) => settling.after(&settling.fate(release)?)?,
            Run::Wanders => settling.by_growth(motion)?,
        };
        // What wanders where others have left is on its way, too.
        let is_on_its_way =
            matches!(ending, Ending::Undecided(_)) || (self.wandering.left > 0 && ending.period().is_none());
        Ok((!is_on_its_way).then_some(Part { ending, starts: Vec::new(), motion }))
    }
}
