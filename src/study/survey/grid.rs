//! Runs the machines of a model over one or two of its numbers, each point independently.
//!
//! The result at a point is the same to the last bit for any order, partition or number of threads.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use rayon::prelude::*;

use super::axis::{Axis, Place};
use super::over::{self, OverError};
use super::threads::{SweepError, on_threads};
use crate::model::{Model, Units};
use crate::orbit::{Family, FamilyError, Parameter};
use crate::progress::{Clock, Watch};
use crate::simulate::{Machine, SimulateError, angular_velocity};

/// The machines of a model over the values of one or two of its numbers.
#[derive(Clone, Debug)]
pub struct Survey {
    family: Family,
    /// Speed of the family, rpm.
    rpm: f64,
    across: Axis,
    up: Option<Axis>,
}

/// Why a survey cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurveyError {
    /// The speed is given twice or never, or the machine is impossible.
    #[error(transparent)]
    Over(#[from] OverError),
    /// Both axes are the same number.
    #[error("both axes are {0}: a chart needs two different numbers")]
    OneNumber(String),
    /// No points, or more than [`Survey::MOST`].
    #[error("{points} points: there must be 1 to {}", Survey::MOST)]
    Points {
        /// Number of points asked for.
        points: usize,
    },
    /// The threads could not be started.
    #[error(transparent)]
    Threads(#[from] SweepError),
}

/// Why a point has no motion.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RunError {
    /// The machine is impossible.
    #[error(transparent)]
    Family(#[from] FamilyError),
    /// A run could not go on.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
}

/// Results at the points, row by row, the first axis fastest; the reason where there is no machine.
pub type GridResults<T> = Vec<Result<T, String>>;

impl Survey {
    /// Largest number of points.
    pub const MOST: usize = 100_000_000;

    /// Builds the survey of `model` over one or two axes; `rpm` is the speed if neither axis is the speed.
    pub fn new(model: &Model, rpm: Option<f64>, across: Axis, up: Option<Axis>) -> Result<Self, SurveyError> {
        if let Some(up) = up.as_ref().filter(|up| up.parameter == across.parameter) {
            return Err(SurveyError::OneNumber(up.parameter.name().into()));
        }
        let points = across.values.len().saturating_mul(up.as_ref().map_or(1, |up| up.values.len()));
        if !(1..=Self::MOST).contains(&points) {
            return Err(SurveyError::Points { points });
        }
        let free: Vec<Parameter> = std::iter::once(&across).chain(&up).map(|axis| axis.parameter.clone()).collect();
        let rpm = over::speed(&free, rpm)?;
        // Errors of the model itself are reported at once, not at every point; an impossible speed is reported at its point.
        let family = Family::new(model, rpm, free).map_err(OverError::from)?;
        Ok(Self { family, rpm, across, up })
    }

    /// The axis that varies; with two axes, the one that runs fastest.
    pub fn axis(&self) -> &Axis {
        &self.across
    }

    /// The fixed speed, rpm; none if the speed varies.
    pub fn speed(&self) -> Option<f64> {
        let varies = std::iter::once(&self.across).chain(&self.up).any(|axis| axis.parameter == Parameter::Speed);
        (!varies).then_some(self.rpm)
    }

    /// Number of values of the first axis.
    pub fn count(&self) -> usize {
        self.across.values.len()
    }

    /// Value at an index.
    pub fn value(&self, index: usize) -> f64 {
        self.across.values[index]
    }

    /// Place of the value at an index.
    pub fn place(&self, index: usize) -> Place {
        self.across.parameter.place(self.value(index), self.rpm)
    }

    /// Value at an index in words.
    pub fn words(&self, index: usize) -> String {
        self.across.parameter.words(self.value(index))
    }

    /// Units of the model.
    pub fn units(&self) -> &Units {
        self.family.units()
    }

    /// Machine with the value at an index, for a survey over one number.
    pub fn machine(&self, index: usize) -> Result<Machine, FamilyError> {
        Ok(self.family.machine(&[self.value(index)])?.0)
    }

    /// Model with the value at an index, for a survey over one number.
    pub fn model(&self, index: usize) -> Result<Model, FamilyError> {
        self.family.model(&[self.value(index)])
    }

    /// Applies `one` to the machine of each value, for a survey over one number, on `threads` threads (all there are for `None`).
    pub fn run<T: Send>(
        &self,
        threads: Option<usize>,
        watch: &dyn Watch,
        one: impl Fn(usize, &Machine) -> Result<T, String> + Sync,
    ) -> Result<GridResults<T>, SweepError> {
        Ok(self.part([0..self.count(), 0..1], threads, watch, |[index, _], machine| one(index, machine))?.0)
    }

    /// Applies `one` to the machines of some columns and rows, reporting to `watch` row by row, or value by value. Returns the results with
    /// the processor seconds of the threads, and the seconds from the beginning to the end.
    pub fn part<T: Send>(
        &self,
        [columns, rows]: [Range<usize>; 2],
        threads: Option<usize>,
        watch: &dyn Watch,
        one: impl Fn([usize; 2], &Machine) -> Result<T, String> + Sync,
    ) -> Result<(GridResults<T>, [f64; 2]), SweepError> {
        let clock = Clock::start();
        let count = threads.unwrap_or_else(rayon::current_num_threads);
        // Rows, or the columns of the only row.
        let (lines, what) = if self.up.is_some() { (rows.clone(), "rows") } else { (columns.clone(), "") };
        let height = (lines.len() / (8 * count)).clamp(1, STRIP);
        let (done, last, total) = (AtomicU64::new(0), lines.end, lines.len() as u64);
        let strips = lines.step_by(height).collect::<Vec<_>>().into_par_iter().map(|first| {
            let clock = Processor::now();
            let strip = first..last.min(first + height);
            let count = strip.len() as u64;
            let [columns, rows] = if self.up.is_some() { [columns.clone(), strip] } else { [strip, rows.clone()] };
            let found = self.block(columns, rows, &one);
            watch.at(what, done.fetch_add(count, Ordering::Relaxed) + count, total);
            (found, clock.elapsed())
        });
        let strips: Vec<_> = on_threads(threads, || strips.collect())?;
        let processor: Duration = strips.iter().map(|(_, elapsed)| *elapsed).sum();
        let found = strips.into_iter().flat_map(|(found, _)| found).collect();
        Ok((found, [processor.as_secs_f64(), clock.elapsed().as_secs_f64()]))
    }

    /// Applies `one` to some columns and rows, row by row.
    fn block<T>(
        &self,
        columns: Range<usize>,
        rows: Range<usize>,
        one: &impl Fn([usize; 2], &Machine) -> Result<T, String>,
    ) -> GridResults<T> {
        // The speed is set below.
        let value = |axis: &Axis, index: usize| match axis.parameter {
            Parameter::Speed => self.rpm,
            Parameter::Field(_) => axis.values[index],
        };
        let machine = |x: usize, y: usize| {
            let up = self.up.as_ref().map(|up| value(up, y));
            let values: Vec<f64> = std::iter::once(value(&self.across, x)).chain(up).collect();
            self.family.machine(&values).map(|(machine, _)| machine).map_err(|error| error.to_string())
        };
        // A cam and its derived data cost as much as hundreds of revolutions; another speed is free.
        let at = |machine: &Result<Machine, String>, rpm: f64, place: [usize; 2]| match machine {
            Ok(machine) if rpm > 0.0 && rpm.is_finite() => one(place, &machine.at_speed(angular_velocity(rpm))),
            Ok(_) => Err(FamilyError::Speed { rpm }.to_string()),
            Err(error) => Err(error.clone()),
        };
        if let Some(up) = self.up.as_ref().filter(|up| up.parameter == Parameter::Speed) {
            let machines: Vec<_> = columns.map(|x| (x, machine(x, rows.start))).collect();
            return rows.flat_map(|y| machines.iter().map(move |(x, it)| at(it, up.values[y], [*x, y]))).collect();
        }
        let row = |y: usize| -> Vec<_> {
            if self.across.parameter == Parameter::Speed {
                let machine = machine(columns.start, y);
                return columns.clone().map(|x| at(&machine, self.across.values[x], [x, y])).collect();
            }
            columns.clone().map(|x| one([x, y], &machine(x, y)?)).collect()
        };
        rows.flat_map(row).collect()
    }
}

/// Largest number of rows that a thread takes at a time.
const STRIP: usize = 32;

/// Processor time of a thread, if the system reports it; else wall-clock time.
enum Processor {
    Thread(Duration),
    Day(Clock),
}

impl Processor {
    fn now() -> Self {
        Self::of_thread().map_or_else(|| Self::Day(Clock::start()), Self::Thread)
    }

    /// Linux reports it in nanoseconds, as the first number of a file.
    fn of_thread() -> Option<Duration> {
        let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
        told.split_whitespace().next()?.parse().ok().map(Duration::from_nanos)
    }

    fn elapsed(&self) -> Duration {
        match self {
            Self::Thread(begun) => Self::of_thread().unwrap_or(*begun).saturating_sub(*begun),
            Self::Day(begun) => begun.elapsed(),
        }
    }
}
