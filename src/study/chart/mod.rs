//! What a machine does over two of its numbers: at each point of a grid, what one run comes to.
//!
//! Each point is a run of its own from one start, so that it is the same to the last bit in whatever order, parts or threads
//! the points are run.

pub mod store;

use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use rayon::prelude::*;
use serde::Serialize;

use crate::diagram::{Speeds, Start, SweepError};
use crate::known::Known;
use crate::model::Model;
use crate::orbit::long_run::{Budget, Kind};
use crate::orbit::{Family, FamilyError, Parameter};
use crate::progress::Watch;
use crate::simulate::{Machine, angular_velocity};
use crate::study::survey::Point;

/// Values of a number.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What varies.
    pub parameter: Parameter,
    /// Its values, one or more.
    pub values: Arc<[f64]>,
}

impl Axis {
    /// Evenly spaced.
    pub fn even(parameter: Parameter, spacing: &Speeds) -> Self {
        Self { parameter, values: (0..spacing.count).map(|index| spacing.value(index)).collect() }
    }

    /// The first and the last value.
    pub fn ends(&self) -> [f64; 2] {
        [self.values.first(), self.values.last()].map(|end| end.copied().unwrap_or(f64::NAN))
    }
}

/// A grid over two numbers of a model, and how it is run.
#[derive(Clone, Debug)]
pub struct Chart {
    /// The model.
    pub model: Model,
    /// The speed, rpm, where neither number is it.
    pub rpm: f64,
    /// Across.
    pub x: Axis,
    /// Up.
    pub y: Axis,
    /// Where every run starts.
    pub start: Start,
    /// For how long each goes on.
    pub budget: Budget,
}

/// Points in order; the reason where one has no motion.
pub type Points = Vec<Result<Point, String>>;

/// What was found over a grid.
#[derive(Clone, Debug)]
pub struct Charted {
    /// The grid.
    pub chart: Chart,
    /// Row by row, the first axis fastest; the reason where a point has no motion.
    pub points: Points,
    /// Seconds of the threads that ran it, and from its beginning to its end.
    pub times: [f64; 2],
}

/// What was found for a store of a chart.
#[derive(Clone, Debug)]
pub struct Filled {
    /// The chart.
    pub chart: Chart,
    /// Points that were run.
    pub points: usize,
    /// Its blocks.
    pub blocks: Blocks,
    /// Seconds of the threads that ran them, and of the day.
    pub times: [f64; 2],
}

document!(Filled as it {
    schema: "corner-impact/chart/1",
    model: it.chart.model.name,
    points: it.points,
    revolutions: it.points as u64 * (it.chart.budget.transient + it.chart.budget.record),
    blocks: it.blocks,
    cpu_s: it.times[0],
    wall_s: it.times[1],
});

/// The blocks of a store.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Blocks {
    /// Computed now.
    pub computed: usize,
    /// Done, by whomever.
    pub done: usize,
    /// All.
    pub total: usize,
}

/// How many points of one kind there are; none is for those that failed.
type Counts = Vec<(Option<Kind>, usize)>;

// A class of points is a kind of motion, or that there is none.
document!(Charted as it {
    schema: "corner-impact/chart/1",
    model: it.chart.model.name,
    x: AxisDocument::of(&it.chart.x),
    y: AxisDocument::of(&it.chart.y),
    rpm if_any: it.chart.speed(),
    transient: it.chart.budget.transient,
    record: it.chart.budget.record,
    longest: it.chart.budget.longest,
    patience: it.chart.budget.patience,
    known: Known::Sampled,
    points: it.points.len(),
    revolutions: it.points.len() as u64 * (it.chart.budget.transient + it.chart.budget.record),
    followed: it.followed(),
    classes: it.counts().into_iter().map(|(kind, points)| Class { class: class(kind), points }).collect::<Vec<_>>(),
    cpu_s: it.times[0],
    wall_s: it.times[1],
});

#[derive(Serialize)]
struct Class {
    class: String,
    points: usize,
}

#[derive(Serialize)]
struct AxisDocument<'a> {
    name: &'a str,
    low: f64,
    high: f64,
    points: usize,
}

impl<'a> AxisDocument<'a> {
    fn of(axis: &'a Axis) -> Self {
        let [low, high] = axis.ends();
        Self { name: axis.parameter.name(), low, high, points: axis.values.len() }
    }
}

/// The name of a class of points in files.
pub fn class(kind: Option<Kind>) -> String {
    kind.map_or_else(|| "failed".into(), |kind| kind.to_string())
}

/// Why there is no chart.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ChartError {
    /// Both axes are one number.
    #[error("--x and --y are both {0}: a chart is over two numbers")]
    OneNumber(String),
    /// No speed is named.
    #[error("neither axis is rpm: --rpm says at which speed")]
    NoSpeed,
    /// Two speeds are named.
    #[error("--rpm is for a chart of which no axis is rpm")]
    TwoSpeeds,
    /// No points, or more than a chart may have.
    #[error("{points} points: a chart has 1 to {}", Chart::MOST)]
    Points {
        /// How many were asked for.
        points: usize,
    },
    /// The machine cannot be.
    #[error(transparent)]
    Family(#[from] FamilyError),
    /// The threads could not be started.
    #[error(transparent)]
    Threads(#[from] SweepError),
}

impl Chart {
    /// The most points of a chart.
    pub const MOST: usize = 100_000_000;

    /// A chart of `model` over two numbers, or why there is none; at `rpm` where neither of them is the speed.
    pub fn new(
        model: &Model,
        rpm: Option<f64>,
        [x, y]: [Axis; 2],
        start: Start,
        budget: Budget,
    ) -> Result<Self, ChartError> {
        if x.parameter == y.parameter {
            return Err(ChartError::OneNumber(x.parameter.name().into()));
        }
        let points = x.values.len().saturating_mul(y.values.len());
        if !(1..=Self::MOST).contains(&points) {
            return Err(ChartError::Points { points });
        }
        let speed = [&x, &y].into_iter().find(|axis| axis.parameter == Parameter::Speed);
        let rpm = match (speed, rpm) {
            // Where one of them cannot be turned at, that is told of its point.
            (Some(axis), None) => axis.values.iter().copied().find(|rpm| *rpm > 0.0 && rpm.is_finite()).unwrap_or(1.0),
            (None, Some(rpm)) => rpm,
            (Some(_), Some(_)) => return Err(ChartError::TwoSpeeds),
            (None, None) => return Err(ChartError::NoSpeed),
        };
        let chart = Self { model: model.clone(), rpm, x, y, start, budget };
        // What is wrong with the model itself is told at once, and not at every point.
        chart.family()?;
        Ok(chart)
    }

    /// The speed of all points, rpm; none where it varies.
    pub fn speed(&self) -> Option<f64> {
        let varies = [&self.x, &self.y].iter().any(|axis| axis.parameter == Parameter::Speed);
        (!varies).then_some(self.rpm)
    }

    fn family(&self) -> Result<Family, FamilyError> {
        Family::new(&self.model, self.rpm, [&self.x, &self.y].map(|axis| axis.parameter.clone()).into())
    }

    /// Runs every point on `threads` threads (all there are for `None`), told to `watch` row by row.
    pub fn run(self, threads: Option<usize>, watch: &dyn Watch) -> Result<Charted, ChartError> {
        let (points, times) = self.part(0..self.x.values.len(), 0..self.y.values.len(), threads, watch)?;
        Ok(Charted { chart: self, points, times })
    }

    /// The points of some columns and rows, row by row, and the seconds of the threads that ran them, and from the beginning to
    /// the end.
    pub fn part(
        &self,
        columns: Range<usize>,
        rows: Range<usize>,
        threads: Option<usize>,
        watch: &dyn Watch,
    ) -> Result<(Points, [f64; 2]), ChartError> {
        let clock = Instant::now();
        let pool = crate::diagram::threads(threads)?;
        let height = (rows.len() / (8 * pool.current_num_threads())).clamp(1, STRIP);
        let (family, done, last, total) = (self.family()?, AtomicU64::new(0), rows.end, rows.len() as u64);
        let strips = rows.step_by(height).collect::<Vec<_>>().into_par_iter().map(|first| {
            let clock = Processor::now();
            let strip = first..last.min(first + height);
            let points = self.block(&family, columns.clone(), strip.clone());
            let done = done.fetch_add(strip.len() as u64, Ordering::Relaxed) + strip.len() as u64;
            watch.at("rows", done, total);
            (points, clock.elapsed())
        });
        let strips: Vec<_> = pool.install(|| strips.collect());
        let processor: Duration = strips.iter().map(|(_, elapsed)| *elapsed).sum();
        let points = strips.into_iter().flat_map(|(points, _)| points).collect();
        Ok((points, [processor.as_secs_f64(), clock.elapsed().as_secs_f64()]))
    }

    /// The points of some columns and rows, row by row.
    fn block(&self, family: &Family, columns: Range<usize>, rows: Range<usize>) -> Points {
        // The speed is set below.
        let value = |axis: &Axis, index: usize| match axis.parameter {
            Parameter::Speed => self.rpm,
            Parameter::Field(_) => axis.values[index],
        };
        let machine = |x: usize, y: usize| {
            let values = [value(&self.x, x), value(&self.y, y)];
            family.machine(&values).map(|(machine, _)| machine).map_err(|error| error.to_string())
        };
        // A cam and what is known of it take as long to make as hundreds of revolutions; another speed is free.
        let at = |machine: &Result<Machine, String>, axis: &Axis, index: usize| {
            machine
                .as_ref()
                .map_err(String::clone)
                .and_then(|it| self.point(&it.at_speed(angular_velocity(axis.values[index]))))
        };
        if self.y.parameter == Parameter::Speed {
            let machines: Vec<_> = columns.clone().map(|x| machine(x, rows.start)).collect();
            return rows.flat_map(|y| machines.iter().map(move |it| at(it, &self.y, y))).collect();
        }
        let row = |y: usize| -> Vec<_> {
            if self.x.parameter == Parameter::Speed {
                let machine = machine(columns.start, y);
                return columns.clone().map(|x| at(&machine, &self.x, x)).collect();
            }
            columns.clone().map(|x| self.point(&machine(x, y)?)).collect()
        };
        rows.flat_map(row).collect()
    }

    fn point(&self, machine: &Machine) -> Result<Point, String> {
        let run = self.start.motion(machine).and_then(|motion| Point::of(machine, motion, self.budget));
        run.map_err(|error| error.to_string())
    }
}

impl Charted {
    /// How many points there are of each kind that there is, in the order of the kinds; those that failed come last.
    pub fn counts(&self) -> Counts {
        let kinds = [Kind::Stays, Kind::Periodic, Kind::Resting, Kind::Chaotic, Kind::Undecided].map(Some);
        let number = |kind: Option<Kind>| {
            self.points.iter().filter(|point| point.as_ref().ok().map(|it| it.kind) == kind).count()
        };
        kinds.into_iter().chain([None]).map(|kind| (kind, number(kind))).filter(|(_, number)| *number > 0).collect()
    }

    /// Revolutions that the runs were followed for, all together.
    pub fn followed(&self) -> u64 {
        self.points.iter().flatten().map(|point| point.followed).sum()
    }

    /// Why the first point that failed did.
    pub fn failure(&self) -> Option<&str> {
        self.points.iter().find_map(|point| point.as_ref().err()).map(String::as_str)
    }
}

/// Rows that a thread takes at a time, at most.
const STRIP: usize = 32;

/// The time that a thread has had of a processor, where the system tells, else that of the day.
enum Processor {
    Thread(Duration),
    Day(Instant),
}

impl Processor {
    fn now() -> Self {
        Self::of_thread().map_or_else(|| Self::Day(Instant::now()), Self::Thread)
    }

    /// Linux keeps it in nanoseconds, as the first number of a file.
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
