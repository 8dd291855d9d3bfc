//! Impacts as a function of a number, and basins of a grid, in columns.

use std::sync::Arc;

use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::orbit::long_run::Budget;
use corner_impact::simulate::EventKind;
use corner_impact::study::basins::{BasinBoundary, Basins, Curve, Grid};
use corner_impact::study::diagram::on_attractors;
use corner_impact::study::survey::{
    Beginning, RecordBlock, RecordRow, Sample, Section, Seen, Survey, Sweep, SweepError, SweepStart,
};
use serde::Serialize;

use crate::PageRefusal;
use crate::question::DiagramRequest;

/// Impacts at each value, as columns: the columns of `diagram --out` for impacts.
#[derive(Default, Serialize)]
pub struct Diagram {
    /// Path of the varied number, or `rpm`.
    over: String,
    /// Values that were run.
    values: Vec<f64>,
    /// Value of each impact.
    value: Vec<f64>,
    cam_angle_rad: Vec<f64>,
    position_m: Vec<f64>,
    velocity_before_m_s: Vec<f64>,
    velocity_after_m_s: Vec<f64>,
    /// Attractor of each impact, from 0 at each value; empty for runs from one start.
    attractor: Vec<usize>,
    /// Values at which the run failed.
    failed: Vec<f64>,
}

/// Number of starts for a value's attractors.
const SAMPLED: usize = 64;
/// Largest total number of revolutions of a diagram on the page, recorded or not.
const MOST_REVOLUTIONS: u64 = 100_000_000;

impl Diagram {
    /// Simulates each value.
    pub(crate) fn of(model: &Model, asked: &DiagramRequest) -> Result<Self, PageRefusal> {
        let axis = asked.over.axis(model)?;
        let (over, values) = (axis.parameter.name().to_owned(), axis.values.to_vec());
        let each = asked.transient.saturating_add(asked.record);
        if each.saturating_mul(values.len() as u64) > MOST_REVOLUTIONS {
            let words = format!(
                "diagram: {each} revolutions at each of {} values: must be at most {MOST_REVOLUTIONS} together; give fewer of either",
                values.len()
            );
            return Err(PageRefusal::of_words(words));
        }
        let sweep = Sweep {
            over: Survey::new(model, asked.rpm, axis, None)?,
            starts: match asked.attractors {
                true => {
                    let DiagramRequest { transient, record, patience, .. } = *asked;
                    let budget = Budget { transient, record, patience, ..Budget::SURVEY };
                    Beginning::Found(Arc::new(move |machine| on_attractors(machine, &Sample::Spread(SAMPLED), budget)))
                }
                false => Beginning::One(asked.start.start()?),
            },
            following: SweepStart::Nothing,
            transient: asked.transient,
            record: asked.record,
            section: Section::Impacts,
            growth: None,
        };
        let mut found = Self { over, values, ..Self::default() };
        sweep.run(None, |_, block: Impacts| -> Result<(), SweepError> {
            found.take(block);
            Ok(())
        })?;
        Ok(found)
    }

    fn take(&mut self, block: Impacts) {
        for RecordRow { value, motion, seen, .. } in block.rows {
            let Seen::Event(event) = seen else { continue };
            self.value.push(value);
            self.cam_angle_rad.push(event.cam_angle);
            self.position_m.push(event.position);
            self.velocity_before_m_s.push(event.velocity_before);
            self.velocity_after_m_s.push(event.velocity_after);
            self.attractor.extend(motion);
        }
        self.failed.extend(block.failed);
    }
}

/// Impacts of a value.
#[derive(Default)]
struct Impacts {
    rows: Vec<RecordRow>,
    failed: Option<f64>,
}

impl RecordBlock for Impacts {
    fn push(&mut self, row: &RecordRow) {
        if matches!(row.seen, Seen::Event(event) if event.kind == EventKind::Impact) {
            self.rows.push(*row);
        }
    }

    fn is_full(&self) -> bool {
        self.rows.len() >= 4096
    }

    fn fail(&mut self, value: f64) -> bool {
        self.failed = Some(value);
        true
    }
}

/// Basins with the motion of each cell, and the curves that separate them.
#[derive(Serialize)]
pub struct GridBasins {
    #[serde(flatten)]
    basins: Basins,
    /// Index in `endings` of the motion on which each cell ends, row by row from the lowest velocity; -1 below the cam.
    cell_endings: Vec<i64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    boundary: Option<Boundary>,
}

/// Curve of positions and velocities on the section, alternately.
#[derive(Serialize)]
struct Boundary {
    stable: Vec<[f64; 2]>,
    saddles: Vec<[f64; 2]>,
    curves: Vec<Vec<[f64; 2]>>,
}

impl GridBasins {
    /// Builds the document from the results on a grid.
    pub(crate) fn of(basins: Basins, grid: &Grid, border: Option<&BasinBoundary>) -> Self {
        let place = |part: &Option<usize>| part.and_then(|part| i64::try_from(part).ok()).unwrap_or(-1);
        let cell_endings = basins.cells.iter().map(place).collect();
        Self { basins, cell_endings, boundary: border.map(|border| Boundary::of(border, grid)) }
    }
}

impl Boundary {
    fn of(border: &BasinBoundary, grid: &Grid) -> Self {
        let pair = |state: &State| [state.position, state.velocity];
        Self {
            stable: border.stable.iter().map(pair).collect(),
            saddles: border.saddles.iter().map(pair).collect(),
            curves: border.curves.iter().flat_map(|curve| drawn(curve, grid)).collect(),
        }
    }
}

/// Parts of a curve inside the ranges of a grid, with only the points that a screen can resolve.
fn drawn(curve: &Curve, grid: &Grid) -> Vec<Vec<[f64; 2]>> {
    /// Smallest distance of neighbouring points, as a share of the ranges.
    const STEP: f64 = 1.0 / 500.0;
    /// Distance above which two points are not joined by a line.
    const LEAP: f64 = 0.1;
    let place = |value: f64, [low, high]: [f64; 2]| (value - low) / (high - low);
    let mut pieces: Vec<Vec<[f64; 2]>> = vec![Vec::new()];
    let mut last = [f64::INFINITY; 2];
    for State { position, velocity } in curve.points() {
        let at = [place(position, grid.positions), place(velocity, grid.velocities)];
        let leap = at.iter().zip(last).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
        if at.iter().any(|part| !(-STEP..=1.0 + STEP).contains(part)) {
            last = [f64::INFINITY; 2];
            pieces.push(Vec::new());
            continue;
        }
        if leap > LEAP {
            pieces.push(Vec::new());
        }
        if leap >= STEP {
            last = at;
            if let Some(piece) = pieces.last_mut() {
                piece.push([position, velocity]);
            }
        }
    }
    pieces.retain(|piece| piece.len() > 1);
    pieces
}
