//! Starts on a section, from a grid or given, and the motion that each ends on.

use serde::Serialize;

use crate::estimate::Estimate;
use crate::flight::State;
use crate::orbit::long_run::{Budget, LongRun};
use crate::orbit::runs::LongRuns;
use crate::progress::Watch;
use crate::simulate::{Machine, SimulateError};
use crate::study::survey::{Ensemble, SweepError, Wandering, attractors_of, on_threads};

/// Starts on the section at one cam angle: the middles of cells, evenly spaced in position and velocity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Grid {
    /// The section, rad, in `[0, 2 pi)`.
    #[serde(rename = "cam_angle_rad")]
    pub cam_angle: f64,
    /// Positions, m: the outer edges of the first and the last cell.
    #[serde(rename = "position_m")]
    pub positions: [f64; 2],
    /// Velocities, m/s.
    #[serde(rename = "velocity_m_s")]
    pub velocities: [f64; 2],
    /// Number of cells along the positions and along the velocities, 1 or more.
    pub cells: [usize; 2],
}

impl Grid {
    /// Largest number of cells in a grid.
    pub const MOST: usize = 4_000_000;

    /// Start of a cell. Cells are counted row by row, from the lowest velocity and the lowest position on.
    pub fn start(&self, cell: usize) -> State {
        let [columns, rows] = self.cells;
        let middle = |[low, high]: [f64; 2], index: usize, count: usize| {
            low + (high - low) * ((index as f64 + 0.5) / count as f64)
        };
        State {
            position: middle(self.positions, cell % columns, columns),
            velocity: middle(self.velocities, cell / columns, rows),
        }
    }
}

/// Starts on a section.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum SectionStarts {
    /// The starts of a grid.
    Grid(Grid),
    /// Given starts.
    Given(States),
}

/// States on the section at one cam angle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct States {
    /// The section, rad, in `[0, 2 pi)`.
    #[serde(rename = "cam_angle_rad")]
    pub cam_angle: f64,
    /// The states.
    #[serde(skip)]
    pub states: Vec<State>,
}

impl SectionStarts {
    /// Number of starts.
    pub fn count(&self) -> usize {
        match self {
            Self::Grid(grid) => grid.cells.iter().product(),
            Self::Given(given) => given.states.len(),
        }
    }

    /// The section, rad, in `[0, 2 pi)`.
    pub fn cam_angle(&self) -> f64 {
        match self {
            Self::Grid(Grid { cam_angle, .. }) | Self::Given(States { cam_angle, .. }) => *cam_angle,
        }
    }

    /// State of one start.
    pub fn state(&self, index: usize) -> State {
        match self {
            Self::Grid(grid) => grid.start(index),
            Self::Given(given) => given.states[index],
        }
    }

    /// Finds the motion that every start ends on, on `threads` threads (all there are for `None`); the result does not depend on their
    /// number. `watch` is notified start by start. Starts of a grid may be below the cam.
    pub fn basins(
        self,
        machine: &Machine,
        budget: Budget,
        threads: Option<usize>,
        watch: &dyn Watch,
    ) -> Result<Basins, GridError> {
        let failed = |(index, error): (usize, SimulateError)| GridError::Simulate { state: self.state(index), error };
        let start = |index: usize| match machine.start(self.cam_angle(), self.state(index)) {
            Ok(motion) => Ok(Some(motion)),
            Err(SimulateError::BelowCam { .. }) if matches!(self, Self::Grid(_)) => Ok(None),
            Err(error) => Err(error),
        };
        // A search for orbits takes as long as thousands of revolutions.
        let runs = match self {
            Self::Grid(_) => LongRuns::new(machine, budget).map_err(|error| failed((0, error)))?,
            Self::Given(_) => LongRuns::unaided(machine, budget),
        };
        let found = on_threads(threads, || attractors_of(&runs, self.count(), start, watch))?.map_err(failed)?;
        Ok(Basins::new(self, budget, found))
    }
}

/// Reason why the endings of starts could not be found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GridError {
    /// A run could not go on.
    #[error("basins: from q = {}, v = {} in the model's units: {error}", state.position, state.velocity)]
    Simulate {
        /// Start of the run.
        state: State,
        /// Cause of the failure.
        error: SimulateError,
    },
    /// The threads could not be started.
    #[error(transparent)]
    Threads(#[from] SweepError),
}

// The period is beside the kind.
document!(Basin as part {
    ending: part.ending.kind(),
    revolutions if_any: part.ending.period().map(|(revolutions, _)| revolutions),
    impacts if_any: part.ending.period().map(|(_, impacts)| impacts),
    growth: part.ending.growth().value,
    growth_error: part.ending.growth().error,
    followed: part.followed,
    starts: part.starts,
    share: part.share.value,
    share_standard_error: part.share.error,
});

/// The starts that end on one motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Basin {
    /// The motion on which they end.
    pub ending: LongRun,
    /// Revolutions that their runs were followed for, in total.
    pub followed: u64,
    /// Number of starts.
    pub starts: usize,
    /// Share of the starts above the cam whose runs did not fail. For starts of a grid, which are spread better than by chance, the error
    /// is overestimated; given starts are counted, and the error is 0.
    pub share: Estimate,
}

/// The motions on which starts end.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Basins {
    /// The starts.
    #[serde(flatten)]
    pub begun: SectionStarts,
    /// Budget of each run.
    pub budget: Budget,
    /// Number of the starts above the cam whose runs did not fail.
    pub starts: usize,
    /// The endings found; the one with most starts comes first.
    #[serde(rename = "endings")]
    pub parts: Vec<Basin>,
    /// Totals of the runs that neither rest nor settle on an orbit soon.
    pub wandering: Wandering,
    /// Number of starts below the cam, which are not run.
    pub below_cam: usize,
    /// Number of starts that could not be run.
    pub failed: usize,
    /// Reason why the first of these could not be run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
    /// For each cell, the index of its part; none if the start is below the cam.
    #[serde(skip)]
    pub cells: Vec<Option<usize>>,
    /// For each cell, the revolutions that its run was followed for.
    #[serde(skip)]
    pub followed: Vec<Option<u64>>,
}

impl Basins {
    fn new(begun: SectionStarts, budget: Budget, mut found: Ensemble) -> Self {
        // The sort is stable: among parts of one size, the first found comes first.
        found.attractors.sort_by_key(|part| std::cmp::Reverse(part.starts.len()));
        let (mut cells, mut followed) = (vec![None; begun.count()], vec![None; begun.count()]);
        let starts = found.attractors.iter().map(|part| part.starts.len()).sum::<usize>();
        let mut parts = Vec::with_capacity(found.attractors.len());
        for (index, part) in found.attractors.into_iter().enumerate() {
            part.starts.iter().for_each(|cell| cells[*cell] = Some(index));
            part.starts.iter().zip(&part.followed).for_each(|(cell, turns)| followed[*cell] = Some(*turns));
            let share = match begun {
                SectionStarts::Grid(_) => Estimate::share,
                SectionStarts::Given(_) => Estimate::counted,
            }(part.starts.len(), starts);
            parts.push(Basin { followed: part.followed(), ending: part.ending, starts: part.starts.len(), share });
        }
        let failure = found.failed.first().map(|(_, error)| error.to_string());
        Self {
            below_cam: begun.count() - starts - found.failed.len(),
            begun,
            budget,
            starts,
            parts,
            wandering: found.wandering,
            failed: found.failed.len(),
            failure,
            cells,
            followed,
        }
    }
}
