//! What one run comes to, in numbers: a point of a chart, and a row of a diagram.

use crate::estimate::Estimate;
use crate::orbit::long_run::{Budget, Kind, LongRun};
use crate::simulate::{Machine, Met, Motion, SimulateError};

use super::ensemble::{Judged, long_run};
use super::starts::Start;

/// What a run comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// The kind of motion.
    pub kind: Kind,
    /// Turns of the cam of one period; 0 where it does not repeat, or where doubles cannot tell after how long.
    pub revolutions: u64,
    /// Impacts of one period; 0 where there is none.
    pub impacts: u64,
    /// Impacts a revolution: of the period, or of what was recorded.
    pub impact_rate: f64,
    /// The growth of a small deviation a revolution, a natural logarithm: of an orbit by its multipliers, without error; minus
    /// infinity where the follower rests; else the mean over the record.
    pub growth: Estimate,
    /// The speed of the fastest impact, of follower and cam against each other, m/s.
    pub impact_speed: f64,
    /// Revolutions that the run was followed for.
    pub followed: u64,
}

impl Point {
    /// What a run from `start` comes to within a budget, or why there is none.
    pub fn from(machine: &Machine, start: Start, budget: Budget) -> Result<Self, String> {
        let run = start.motion(machine).and_then(|motion| Self::of(machine, motion, budget));
        run.map_err(|error| error.to_string())
    }

    /// What `motion` comes to within a budget.
    pub fn of(machine: &Machine, motion: Motion, budget: Budget) -> Result<Self, SimulateError> {
        let Judged { ending, followed, .. } = long_run(machine, motion, budget)?;
        let (revolutions, impacts) = ending.period().unwrap_or_default();
        // Of so many revolutions.
        let (met, of) = match &ending {
            LongRun::PermanentContact => (Met::default(), 1),
            LongRun::Orbit(orbit) => {
                let mut met = Met::default();
                orbit.impacts().for_each(|impact| met.take(impact));
                (met, orbit.revolutions)
            }
            LongRun::Sticking(orbit) => {
                (Met { impacts: orbit.impacts, impact_speed: orbit.impact_speed }, orbit.revolutions)
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

/// The growth of a small deviation of `motion` a revolution, and its error: that of what it comes to within a budget.
pub fn growth(machine: &Machine, motion: Motion, budget: Budget) -> Result<Estimate, SimulateError> {
    Ok(long_run(machine, motion, budget)?.ending.growth())
}
