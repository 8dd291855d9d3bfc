//! The long-run motion of one run, in numbers: a point of a chart, and a row of a diagram.

use crate::estimate::Estimate;
use crate::orbit::long_run::{Budget, Kind, LongRun};
use crate::simulate::{ImpactTally, Machine, Motion, SimulateError};

use super::ensemble::{Judged, long_run};
use super::starts::Start;

/// The long-run motion of one run, in numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Kind of motion.
    pub kind: Kind,
    /// Turns of the cam in one period; 0 if the motion does not repeat, or if doubles cannot resolve its period.
    pub revolutions: u64,
    /// Impacts in one period; 0 if there is no period.
    pub impacts: u64,
    /// Impacts per revolution: over the period, or over the record.
    pub impact_rate: f64,
    /// Growth of a small deviation per revolution, a natural logarithm. For an orbit it follows from its multipliers, without error; if the
    /// follower rests, it is minus infinity; otherwise it is the mean over the record.
    pub growth: Estimate,
    /// Relative speed of follower and cam at the fastest impact, m/s.
    pub impact_speed: f64,
    /// Revolutions that the run was followed for.
    pub followed: u64,
}

impl Point {
    /// Judges a run from `start` within a budget, or returns the reason for its failure.
    pub fn from(machine: &Machine, start: Start, budget: Budget) -> Result<Self, String> {
        let run = start.motion(machine).and_then(|motion| Self::of(machine, motion, budget));
        run.map_err(|error| error.to_string())
    }

    /// Judges the long-run motion of `motion` within a budget.
    pub fn of(machine: &Machine, motion: Motion, budget: Budget) -> Result<Self, SimulateError> {
        let Judged { ending, followed, .. } = long_run(machine, motion, budget)?;
        let (revolutions, impacts) = ending.period().unwrap_or_default();
        // Number of revolutions that the impacts are counted over.
        let (met, of) = match &ending {
            LongRun::PermanentContact => (ImpactTally::default(), 1),
            LongRun::Orbit(orbit) => {
                let mut met = ImpactTally::default();
                orbit.impacts().for_each(|impact| met.take(impact));
                (met, orbit.revolutions)
            }
            LongRun::Sticking(orbit) => {
                (ImpactTally { impacts: orbit.impacts, impact_speed: orbit.impact_speed }, orbit.revolutions)
            }
            LongRun::Chaotic(recorded) | LongRun::Undecided(recorded) => (recorded.met, recorded.revolutions),
        };
        Ok(Self {
            kind: ending.kind(),
            revolutions,
            impacts,
            impact_rate: met.impacts as f64 / of as f64,
            growth: ending.growth(),
            impact_speed: met.impact_speed,
            followed,
        })
    }
}

/// Growth of a small deviation per revolution, with its error, of the motion on which `motion` settles within a budget.
pub fn growth(machine: &Machine, motion: Motion, budget: Budget) -> Result<Estimate, SimulateError> {
    Ok(long_run(machine, motion, budget)?.ending.growth())
}
