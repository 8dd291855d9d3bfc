//! What the motion settles on, speed by speed.

use std::f64::consts::TAU;
use std::time::Instant;

use rayon::prelude::*;
use serde::Serialize;

use crate::diagram::{Block, Following, Places, Section, Speeds, Start, Sweep, SweepError, Tally};
use crate::draw::{Cloud, Density};
use crate::model::Model;
use crate::orbit::long_run::Budget;
use crate::progress::{Pieces, Watch};
use crate::simulate::{Machine, Motion, SimulateError, angular_velocity};
use crate::study::attractors::Here;
use crate::study::design::loads::Loads;
use crate::study::survey::{Point, Sample};

/// A motion on each of the attractors of `machine` that are found at its speed alone.
pub fn on_attractors(machine: &Machine, sample: &Sample, budget: Budget) -> Result<Vec<Motion>, SimulateError> {
    let rpm = machine.angular_velocity() * 60.0 / TAU;
    let mut motions: Vec<Motion> =
        Here::new(machine, rpm, sample, budget)?.parts.into_iter().map(|part| part.motion).collect();
    motions.iter_mut().for_each(|motion| motion.revolution = 0);
    Ok(motions)
}

/// What a run from `start` comes to at each of `speeds`, side by side on `threads` threads, for `None` on one for each core.
pub fn one_row(
    machine: &Machine,
    speeds: &Speeds,
    start: Start,
    budget: Budget,
    threads: Option<usize>,
    watch: &dyn Watch,
) -> Result<Vec<Result<Point, String>>, SweepError> {
    let pieces = Pieces::new(watch, "", speeds.count);
    let one = |index: usize| {
        let machine = machine.at_speed(angular_velocity(speeds.value(index)));
        let run = start.motion(&machine).and_then(|motion| Point::of(&machine, motion, budget));
        run.map_err(|error| error.to_string())
    };
    let each = |index: usize| pieces.each(|| one(index));
    Ok(crate::diagram::threads(threads)?.install(|| (0..speeds.count).into_par_iter().map(each).collect()))
}

/// The loads of each recorded revolution of a run from `start` at each of `speeds`; an error where it cannot be run.
pub fn loads(
    model: &Model,
    sweep: &Sweep,
    start: Start,
    budget: Budget,
    threads: Option<usize>,
    watch: &dyn Watch,
) -> Result<Vec<Vec<Loads>>, SweepError> {
    let (machine, speeds) = (&sweep.machine, &sweep.speeds);
    let pieces = Pieces::new(watch, "", speeds.count);
    let of_speed = |rpm: f64| -> Result<Vec<Loads>, SimulateError> {
        let machine = machine.at_speed(angular_velocity(rpm));
        let mut motion = start.motion(&machine)?;
        machine.revolve(&mut motion, budget.transient)?;
        let found = Loads::recorded(model, &machine, motion, budget.record)?;
        // As it was asked for, and not as the angular velocity has it.
        Ok(found.into_iter().map(|loads| Loads { rpm, ..loads }).collect())
    };
    let one = |index: usize| {
        let rpm = speeds.value(index);
        pieces.each(|| of_speed(rpm)).map_err(|error| SweepError::Simulate { rpm, error })
    };
    crate::diagram::threads(threads)?.install(|| (0..speeds.count).into_par_iter().map(one).collect())
}

/// What a sweep came to: the document of `diagram --summary`.
#[derive(Clone, Debug, Serialize)]
pub struct Swept {
    schema: &'static str,
    /// The model's name.
    pub model: String,
    /// Rows recorded, impacts among them, revolutions run.
    #[serde(flatten)]
    pub tally: Tally,
    /// Threads used.
    pub threads: usize,
    /// Seconds that the sweep took, with writing what it found.
    pub wall_s: f64,
}

impl Swept {
    /// Sweeps on `threads` threads, for `None` on one for each core; `take` gets what is found, in order.
    pub fn new<B: Block, E: From<SweepError>>(
        model: &str,
        sweep: &Sweep,
        threads: Option<usize>,
        watch: &dyn Watch,
        mut take: impl FnMut(B) -> Result<(), E>,
    ) -> Result<Self, E> {
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        let threads = match sweep.following {
            Following::Nothing => threads.unwrap_or_else(cores).min(sweep.speeds.count),
            Following::Up | Following::Down => 1,
        };
        let clock = Instant::now();
        let tally = sweep.run(Some(threads), |index, block| {
            watch.at("", index as u64, sweep.speeds.count as u64);
            take(block)
        })?;
        let (schema, wall_s) = ("corner-impact/diagram/1", clock.elapsed().as_secs_f64());
        Ok(Self { schema, model: model.into(), tally, threads, wall_s })
    }
}

/// What a picture shows of a sweep: where impacts are, in degrees, or positions at the section, m, and exponents.
#[derive(Clone, Debug)]
pub struct Shown {
    in_degrees: bool,
    cloud: Cloud,
    /// Speed, rpm, and Lyapunov exponent per revolution, of each speed that has one.
    pub exponents: Vec<[f64; 2]>,
}

impl Shown {
    /// Nothing of a sweep yet.
    pub fn new(sweep: &Sweep) -> Self {
        let (low, high) = (sweep.speeds.low, sweep.speeds.high);
        let cloud = Cloud::new(if high > low { [low, high] } else { [0.99 * low, 1.01 * low] });
        Self { in_degrees: sweep.section == Section::Impacts, cloud, exponents: Vec::new() }
    }

    /// Adds what was found.
    pub fn take(&mut self, found: &Places) {
        for [rpm, place] in &found.places {
            self.cloud.push(*rpm, if self.in_degrees { place.to_degrees() } else { *place });
        }
        let is_new = |new: &[f64; 2]| self.exponents.last().is_none_or(|last| last[0] != new[0]);
        self.exponents.extend(found.exponent.filter(is_new));
    }

    /// The places.
    pub fn places(self) -> (Density, Vec<[f64; 2]>) {
        (self.cloud.finish(), self.exponents)
    }
}
