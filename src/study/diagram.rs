//! Diagrams of the motions on which runs settle, over the speed or another number.

use serde::Serialize;

use crate::orbit::long_run::Budget;
use crate::progress::{Clock, Watch};
use crate::simulate::{Machine, Motion, SimulateError};
use crate::study::attractors::AttractorsAtValue;
use crate::study::design::loads::Loads;
use crate::study::survey::{
    Beginning, GridResults, Point, RecordBlock, Sample, Start, Survey, Sweep, SweepError, SweepStart, SweepTally,
};

/// Returns a motion on each attractor of `machine`, as found without other machines.
pub fn on_attractors(machine: &Machine, sample: &Sample, budget: Budget) -> Result<Vec<Motion>, SimulateError> {
    let found = AttractorsAtValue::new(machine, sample, budget)?;
    let mut motions: Vec<Motion> = found.attractors.into_iter().map(|attractor| attractor.motion).collect();
    motions.iter_mut().for_each(|motion| motion.revolution = 0);
    Ok(motions)
}

/// Finds the long-run motion of a run from `start` at each value, in parallel on `threads` threads; `None` takes one for each core.
pub fn one_row(
    over: &Survey,
    start: Start,
    budget: Budget,
    threads: Option<usize>,
    watch: &dyn Watch,
) -> Result<GridResults<Point>, SweepError> {
    over.run(threads, watch, |_, machine| Point::from(machine, start, budget))
}

/// Computes the loads of each recorded revolution of a run from `start` at each value. Fails if a run fails.
pub fn loads(
    over: &Survey,
    start: Start,
    budget: Budget,
    threads: Option<usize>,
    watch: &dyn Watch,
) -> Result<Vec<Vec<Loads>>, SweepError> {
    let found = over.run(threads, watch, |index, machine| {
        let model = over.model(index).map_err(|error| error.to_string())?;
        let recorded = || {
            let mut motion = start.motion(machine)?;
            machine.revolve(&mut motion, budget.transient)?;
            Loads::recorded(&model, machine, motion, budget.record)
        };
        let loads = recorded().map_err(|error: SimulateError| error.to_string())?;
        // The place as requested, not as computed from the angular velocity.
        Ok(loads.into_iter().map(|loads| Loads { place: over.place(index), ..loads }).collect())
    });
    let one = |(index, found): (usize, Result<Vec<Loads>, String>)| {
        found.map_err(|error| SweepError::Run { place: over.words(index), error })
    };
    found?.into_iter().enumerate().map(one).collect()
}

/// Summary of a sweep: the document of `diagram --json`.
#[derive(Clone, Debug, Serialize)]
pub struct Swept {
    schema: &'static str,
    /// The model's name.
    pub model: String,
    /// Numbers of rows recorded, impacts among them, and revolutions run.
    #[serde(flatten)]
    pub tally: SweepTally,
    /// Revolutions that each run was followed for, recorded or not.
    pub followed: u64,
    /// Whether the growth or the attractors were asked for, which are judged within a budget. Otherwise no motion is judged.
    #[serde(skip)]
    pub is_judged: bool,
    /// Threads used.
    pub threads: usize,
    /// Seconds that the sweep took, including writing its results.
    pub wall_s: f64,
}

impl Swept {
    /// Runs a sweep on `threads` threads; `None` takes one for each core. `take` gets the results in order.
    pub fn new<B: RecordBlock, E: From<SweepError>>(
        model: &str,
        sweep: &Sweep,
        threads: Option<usize>,
        watch: &dyn Watch,
        mut take: impl FnMut(B) -> Result<(), E>,
    ) -> Result<Self, E> {
        let threads = match sweep.following {
            // RAYON_NUM_THREADS gives the number, or there is one for each core.
            SweepStart::Nothing => threads.unwrap_or_else(rayon::current_num_threads).min(sweep.over.count()),
            SweepStart::Up | SweepStart::Down => 1,
        };
        let clock = Clock::start();
        let tally = sweep.run(Some(threads), |index, block| {
            watch.at("", index as u64, sweep.over.count() as u64);
            take(block)
        })?;
        let followed = sweep.transient + sweep.record;
        let is_judged = sweep.growth.is_some() || matches!(sweep.starts, Beginning::Found(_));
        let (schema, wall_s) = ("corner-impact/diagram/1", clock.elapsed().as_secs_f64());
        Ok(Self { schema, model: model.into(), tally, followed, is_judged, threads, wall_s })
    }
}
