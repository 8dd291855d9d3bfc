//! A chart over two numbers of a model: at each point of a grid, the long-run motion of one run.

pub mod store;

use std::ops::Range;

use serde::Serialize;

use crate::known::Evidence;
use crate::model::Model;
use crate::orbit::long_run::{Budget, Kind};
use crate::progress::Watch;
use crate::study::survey::{Axis, GridResults, Point, Start, Survey, SurveyError, SweepError};

/// A grid over two numbers of a model, with the settings of its runs.
#[derive(Clone, Debug)]
pub struct Chart {
    /// The model.
    pub model: Model,
    survey: Survey,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Start of every run.
    pub start: Start,
    /// Budget of each run.
    pub budget: Budget,
}

/// Results over a grid.
#[derive(Clone, Debug)]
pub struct Charted {
    /// The grid.
    pub chart: Chart,
    /// Results row by row, the first axis fastest; the reason if a point has no motion.
    pub points: GridResults<Point>,
    /// Seconds of the threads that ran it, and of wall-clock time.
    pub times: [f64; 2],
}

/// Results of filling a store of a chart.
#[derive(Clone, Debug)]
pub struct Filled {
    /// The chart.
    pub chart: Chart,
    /// Number of points that were run.
    pub points: usize,
    /// Blocks of the store.
    pub blocks: Blocks,
    /// Seconds of the threads that ran them, and of wall-clock time.
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

/// Numbers of blocks of a store.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Blocks {
    /// Blocks computed now.
    pub computed: usize,
    /// Blocks done, by any process.
    pub done: usize,
    /// All blocks.
    pub total: usize,
}

/// Number of points of each kind; the kind is none for those that failed.
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
    known: Evidence::Sampled,
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

/// Returns the name of a class of points in files.
pub fn class(kind: Option<Kind>) -> String {
    kind.map_or_else(|| "failed".into(), |kind| kind.to_string())
}

impl Chart {
    /// Builds a chart of `model` over two numbers; at `rpm` if neither of them is the speed.
    pub fn new(
        model: &Model,
        rpm: Option<f64>,
        [x, y]: [Axis; 2],
        start: Start,
        budget: Budget,
    ) -> Result<Self, SurveyError> {
        let survey = Survey::new(model, rpm, x.clone(), Some(y.clone()))?;
        Ok(Self { model: model.clone(), survey, x, y, start, budget })
    }

    /// The speed of all points, rpm; none if it varies.
    pub fn speed(&self) -> Option<f64> {
        self.survey.speed()
    }

    /// Runs every point on `threads` threads (all there are for `None`). `watch` is notified row by row.
    pub fn run(self, threads: Option<usize>, watch: &dyn Watch) -> Result<Charted, SweepError> {
        let (points, times) = self.part([0..self.x.values.len(), 0..self.y.values.len()], threads, watch)?;
        Ok(Charted { chart: self, points, times })
    }

    /// Runs the points of some columns and rows. Returns them row by row, with the seconds of the threads that ran them and of wall-clock
    /// time.
    pub fn part(
        &self,
        part: [Range<usize>; 2],
        threads: Option<usize>,
        watch: &dyn Watch,
    ) -> Result<(GridResults<Point>, [f64; 2]), SweepError> {
        self.survey.part(part, threads, watch, |_, machine| Point::from(machine, self.start, self.budget))
    }
}

impl Charted {
    /// Returns the number of points of each kind that occurs, in the order of the kinds. The failed points come last.
    pub fn counts(&self) -> Counts {
        let kinds = [Kind::Stays, Kind::Periodic, Kind::Resting, Kind::Chaotic, Kind::Undecided].map(Some);
        let number = |kind: Option<Kind>| {
            self.points.iter().filter(|point| point.as_ref().ok().map(|it| it.kind) == kind).count()
        };
        kinds.into_iter().chain([None]).map(|kind| (kind, number(kind))).filter(|(_, number)| *number > 0).collect()
    }

    /// Revolutions that the runs were followed for, in total.
    pub fn followed(&self) -> u64 {
        self.points.iter().flatten().map(|point| point.followed).sum()
    }

    /// Reason why the first failed point failed.
    pub fn failure(&self) -> Option<&str> {
        self.points.iter().find_map(|point| point.as_ref().err()).map(String::as_str)
    }
}
