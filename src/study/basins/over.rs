//! The share of the starts that end on each motion, over the values of a number.

use super::{Basin, BasinSection, Basins, SectionStarts, States};
use crate::flight::State;
use crate::orbit::long_run::{Budget, Kind};
use crate::progress::{Clock, Unwatched, Watch};
use crate::study::StudyError;
use crate::study::survey::{Axis, Over, Place, VariedNumber};

/// Starts at each value.
#[derive(Clone, Debug)]
pub enum Begun {
    /// A grid of so many cells along the positions and the velocities, over these ranges, or over ranges from the orbits of each value.
    Grid([usize; 2], [Option<[f64; 2]>; 2]),
    /// Given states.
    Given(Vec<State>),
}

/// The motions that starts end on at each of several values: the document of `basins --over --json`.
#[derive(Clone, Debug)]
pub struct BasinsOver {
    /// The model's name.
    pub model: String,
    /// The number that varies.
    pub over: VariedNumber,
    /// Lowest and highest value.
    pub range: [f64; 2],
    /// Cam angle of the section, rad, in `[0, 2 pi)`.
    pub cam_angle: f64,
    /// Budget of each run.
    pub budget: Budget,
    /// The basins at each value.
    pub at: Vec<BasinsAt>,
    /// Seconds that the runs took.
    pub wall_s: f64,
}

document!(BasinsOver as it {
    schema: "corner-impact/basins/1",
    model: it.model,
    rpm if_any: it.over.rpm,
    over: it.over.name,
    range: it.range,
    cam_angle_rad: it.cam_angle,
    budget: it.budget,
    values: it.at,
    wall_s: it.wall_s,
});

/// The motions that the starts of one value end on.
#[derive(Clone, Debug)]
pub struct BasinsAt {
    /// Place of the value.
    pub place: Place,
    /// The basins, or why there are none.
    pub found: Result<Basins, String>,
}

document!(BasinsAt as it {
    speed_rpm: it.place.rpm,
    value if_any: it.place.value,
    starts: it.found.as_ref().map_or(0, |found| found.starts),
    endings: it.found.as_ref().map_or(&[][..], |found| &found.parts),
    failed: it.found.as_ref().map_or(0, |found| found.failed),
    failure if_any: it.failure(),
});

impl BasinsAt {
    /// Reason why nothing, or one of the starts, could be run.
    pub fn failure(&self) -> Option<&str> {
        match &self.found {
            Ok(found) => found.failure.as_deref(),
            Err(why) => Some(why),
        }
    }
}

/// A kind of motion, with its revolutions and impacts if it repeats.
pub type MotionKind = (Kind, Option<(u64, u64)>);

/// The share of the starts that end on motions of one kind and period, at each value at which basins were found.
#[derive(Clone, Debug, PartialEq)]
pub struct SharesOf {
    /// The motion.
    pub motion: MotionKind,
    /// Each value, with the share.
    pub shares: Vec<[f64; 2]>,
}

impl BasinsOver {
    /// Returns the shares by kind and period, the motion of most starts first. The share is 0 where no start ends on such a motion.
    pub fn shares(&self) -> Vec<SharesOf> {
        let found = || self.at.iter().filter_map(|at| Some((at.place.across(), &at.found.as_ref().ok()?.parts)));
        let of = |part: &Basin| (part.ending.kind(), part.ending.period());
        let mut motions: Vec<MotionKind> = found().flat_map(|(_, parts)| parts.iter().map(of)).collect();
        motions.sort_unstable();
        motions.dedup();
        let shares = |motion: MotionKind| {
            let share = |parts: &[Basin]| -> f64 {
                parts.iter().filter(|part| of(part) == motion).map(|part| part.share.value).sum()
            };
            SharesOf { motion, shares: found().map(|(value, parts)| [value, share(parts)]).collect() }
        };
        let mut all: Vec<SharesOf> = motions.into_iter().map(shares).collect();
        let sum = |it: &SharesOf| it.shares.iter().map(|[_, share]| share).sum::<f64>();
        all.sort_by(|one, other| sum(other).total_cmp(&sum(one)));
        all
    }

    /// Finds the motions that starts on the section at `cam_angle`, rad, end on at each value. `watch` is notified at each value.
    pub fn new(
        over: &Over<'_>,
        axis: &Axis,
        (cam_angle, begun): (f64, &Begun),
        budget: Budget,
        threads: Option<usize>,
        watch: &dyn Watch,
    ) -> Self {
        let (clock, total) = (Clock::start(), axis.values.len() as u64);
        let one = |value: f64| -> Result<Basins, StudyError> {
            let (model, _) = over.model(value)?;
            let section = BasinSection::new(&model, over.place(value).rpm, cam_angle)?;
            let starts = match begun {
                Begun::Grid(cells, [positions, velocities]) => {
                    SectionStarts::Grid(section.grid(*cells, *positions, *velocities)?)
                }
                Begun::Given(states) => SectionStarts::Given(States { cam_angle, states: states.clone() }),
            };
            Ok(starts.basins(&section.map.machine, budget, threads, &Unwatched)?)
        };
        let at = |(index, value): (usize, &f64)| {
            watch.at("", index as u64, total);
            BasinsAt { place: over.place(*value), found: one(*value).map_err(|error| error.to_string()) }
        };
        let at = axis.values.iter().enumerate().map(at).collect();
        let (model, varied) = (over.model.name.clone(), over.varied(axis.spacing));
        Self { model, over: varied, range: axis.ends(), cam_angle, budget, at, wall_s: clock.elapsed().as_secs_f64() }
    }
}
