//! A grid of starts on a section, and the motion that each ends on.

use serde::Serialize;

use crate::diagram::SweepError;
use crate::estimate::Estimate;
use crate::flight::State;
use crate::orbit::ending::Ending;
use crate::orbit::fate::Settling;
use crate::progress::{Unwatched, Watch};
use crate::simulate::{Machine, SimulateError};
use crate::study::attractors::{Ensemble, Patience, Wandering};

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
    /// How many along the positions and along the velocities, 1 or more.
    pub cells: [usize; 2],
}

impl Grid {
    /// The most cells of a grid.
    pub const MOST: usize = 4_000_000;

    /// The start of a cell, counted row by row, from the lowest velocity up and from the lowest position on.
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

    /// What every start ends on, on `threads` threads (all there are for `None`): the same for every number of them.
    pub fn basins(&self, machine: &Machine, patience: Patience, threads: Option<usize>) -> Result<Basins, GridError> {
        self.basins_watched(machine, patience, threads, &Unwatched)
    }

    /// The same, told to `watch` start by start.
    pub fn basins_watched(
        &self,
        machine: &Machine,
        patience: Patience,
        threads: Option<usize>,
        watch: &dyn Watch,
    ) -> Result<Basins, GridError> {
        let pool = crate::diagram::threads(threads)?;
        let start = |cell: usize| match machine.start(self.cam_angle, self.start(cell)) {
            Ok(motion) => Ok(Some(motion)),
            Err(SimulateError::BelowCam { .. }) => Ok(None),
            Err(error) => Err(error),
        };
        let settling = Settling::new(machine, patience.longest).map_err(|error| self.failed(0, error))?;
        let run = || Ensemble::of(&settling, patience, self.cells.iter().product(), start, watch);
        let found = pool.install(run).map_err(|(cell, error)| self.failed(cell, error))?;
        Ok(Basins::new(*self, found))
    }

    fn failed(&self, cell: usize, error: SimulateError) -> GridError {
        GridError::Simulate { state: self.start(cell), error }
    }
}

/// Why a grid of starts has no endings.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GridError {
    /// A run could not go on.
    #[error("basins: from q = {} m, v = {} m/s: {error}", state.position, state.velocity)]
    Simulate {
        /// Its start.
        state: State,
        /// Why.
        error: SimulateError,
    },
    /// The threads could not be started.
    #[error(transparent)]
    Threads(#[from] SweepError),
}

// A period stands beside the kind.
document!(Basin as part {
    ending: part.ending.kind(),
    revolutions if_any: part.ending.period().map(|(revolutions, _)| revolutions),
    impacts if_any: part.ending.period().map(|(_, impacts)| impacts),
    growth if_any: part.ending.growth().map(|growth| growth.value),
    growth_error if_any: part.ending.growth().map(|growth| growth.error),
    starts: part.starts,
    share: part.share.value,
    share_standard_error: part.share.error,
});

/// The starts of a grid that end alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Basin {
    /// How they end.
    pub ending: Ending,
    /// How many.
    pub starts: usize,
    /// Their share of the starts above the cam. Those of a grid are spread better than by chance, so that its error errs on the
    /// large side.
    pub share: Estimate,
}

/// What the starts of a grid end on.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Basins {
    /// The starts.
    #[serde(flatten)]
    pub grid: Grid,
    /// How many of them are above the cam.
    pub starts: usize,
    /// The endings found, that of most starts first.
    #[serde(rename = "endings")]
    pub parts: Vec<Basin>,
    /// Runs that neither rested nor came to an orbit soon, all together.
    pub wandering: Wandering,
    /// How many starts could not be run.
    pub failed: usize,
    /// Why the first of these could not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
    /// For each cell the index of its part; nothing where the start is below the cam.
    #[serde(skip)]
    pub cells: Vec<Option<usize>>,
}

impl Basins {
    fn new(grid: Grid, mut found: Ensemble) -> Self {
        // Stable: among parts of one size the first found comes first.
        found.parts.sort_by_key(|part| std::cmp::Reverse(part.starts.len()));
        let mut cells = vec![None; grid.cells.iter().product()];
        let starts = found.parts.iter().map(|part| part.starts.len()).sum::<usize>();
        let mut parts = Vec::with_capacity(found.parts.len());
        for (index, part) in found.parts.into_iter().enumerate() {
            part.starts.iter().for_each(|cell| cells[*cell] = Some(index));
            let share = Estimate::share(part.starts.len(), starts);
            parts.push(Basin { ending: part.ending, starts: part.starts.len(), share });
        }
        let failure = found.failed.first().map(|(_, error)| error.to_string());
        Self { grid, starts, parts, wandering: found.wandering, failed: found.failed.len(), failure, cells }
    }
}
