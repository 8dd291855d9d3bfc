//! h-sets of a machine at a speed, or over a range of speeds: sought by simulation, then proved.
//!
//! About each impact of a saddle of few impacts N is tried with sides of many lengths along what the saddle stretches; its height is
//! that of the images of the stretches that go across. Where most motions follow from them it is made ready for a proof: strips
//! reach as far as they must at every height and at both ends of the range of speeds, with room to spare.

use std::cmp::Ordering;

use rayon::prelude::*;

use super::base::{bases, rounded};
use super::frame::Frame;
use super::map::ImpactMap;
use super::prove::{Covered, Refused, Relation, prove};
use super::sample::{Crossing, Line};
use super::{HSet, Strip};
use crate::simulate::{Machine, SimulateError, angular_velocity};

/// An h-set with what is proved of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Proved {
    /// The h-set, with those of its strips that are proved.
    pub set: HSet,
    /// What is proved of each strip.
    pub strips: Vec<Covered>,
    /// Strips that were given up.
    pub refused: Vec<Refused>,
}

/// Why no chaos is proved: how far it came.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Short {
    /// Impacts of saddles that were tried.
    pub saddles: usize,
    /// The most strips that a sampled h-set has.
    pub strips: usize,
    /// The relations that failed where strips were tried.
    pub refused: Vec<Refused>,
}

/// The largest distance along x, degrees or m/s whichever it is of, that N is tried to.
const FARTHEST: f64 = 32.0;
/// Points of a line.
const POINTS: usize = 12_000;
/// Each length of a side of N is this part of the one before, down to the shortest.
const SHORTER: f64 = 0.8;
const SHORTEST: f64 = 0.06;

/// How much is to be proved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wanted {
    /// The most strips, the shortest in turns first.
    pub strips: usize,
    /// Whether cones are looked for.
    pub cones: bool,
}

/// Finds an h-set with two strips or more at every speed of a range, rpm, and proves it.
pub fn find(machine: &Machine, rpm: [f64; 2], wanted: Wanted) -> Result<Result<Proved, Short>, SimulateError> {
    /// h-sets that are sampled at all heights, and of those the ones that are tried to be proved; the most promising first.
    const SAMPLED: usize = 150;
    const TRIES: usize = 3;
    let middle = 0.5 * (rpm[0] + rpm[1]);
    let machine = machine.at_speed(angular_velocity(middle));
    let bases = bases(&machine, middle)?;
    let made_ready = |mut sized: Vec<HSet>| {
        sized.sort_by(promising);
        sized.truncate(SAMPLED);
        sized.into_par_iter().filter_map(|set| ready(&machine, HSet { rpm, ..set })).collect::<Vec<_>>()
    };
    let everywhere = [lengths(SHORTER), lengths(SHORTER)];
    let sized = bases.par_iter().flat_map_iter(|base| sizes(&machine, base, &everywhere, wanted.strips)).collect();
    let mut sets = made_ready(sized);
    // One strip more may lie between an end of the best and the next.
    if let Some(best) = sets.iter().min_by(|one, two| promising(one, two)) {
        let lengths = [near(-best.x[0]), near(best.x[1])];
        sets.extend(made_ready(sizes(&machine, best, &lengths, wanted.strips)));
    }
    sets.sort_by(promising);
    let strips = sets.first().map_or(0, |set| set.strips.len());
    let mut short = Short { saddles: bases.len(), strips, refused: Vec::new() };
    let mut best: Option<Proved> = None;
    for set in sets.into_iter().take(TRIES) {
        match proved(&machine, set, wanted) {
            Ok(proved) => {
                let is_all = proved.refused.is_empty();
                if best.as_ref().is_none_or(|best| promising(&proved.set, &best.set).is_lt()) {
                    best = Some(proved);
                }
                if is_all {
                    break;
                }
            }
            Err(refused) => short.refused.extend(refused),
        }
    }
    Ok(best.ok_or(short))
}

/// The one with more motions first; of two with as many the smaller one, which strips get across sooner.
fn promising(one: &HSet, two: &HSet) -> Ordering {
    let size = |set: &HSet| (set.x[1] - set.x[0]) * (set.y[1] - set.y[0]);
    two.entropy().total_cmp(&one.entropy()).then(size(one).total_cmp(&size(two)))
}

/// Each length is `part` of the one before, down to the shortest.
fn lengths(part: f64) -> Vec<f64> {
    let shorter = |length: &f64| Some(part * length);
    std::iter::successors(Some(FARTHEST), shorter).take_while(|length| *length > SHORTEST).collect()
}

/// Lengths about one, from the next shorter to the next longer.
fn near(length: f64) -> Vec<f64> {
    const STEPS: i32 = 4;
    (-STEPS..=STEPS).map(|step| length * SHORTER.powf(f64::from(step) / f64::from(STEPS))).collect()
}

/// For a saddle the sizes of N, of some lengths to either side, that have most motions for heights of many sizes, with strips as they
/// are along the middle.
fn sizes(machine: &Machine, base: &HSet, [lefts, rights]: &[Vec<f64>; 2], strips: usize) -> Vec<HSet> {
    let points = (0..=POINTS).map(|index| FARTHEST * (2.0 * index as f64 / POINTS as f64 - 1.0));
    let line = Line::new(machine, base, 0.0, points.collect());
    let heights = lengths(0.5);
    let mut all = Vec::new();
    for left in lefts {
        let mut best: Vec<Option<HSet>> = vec![None; heights.len()];
        for right in rights {
            let x = [-left, *right];
            let crossings = line.crossings(x);
            for (highest, best) in heights.iter().zip(&mut best) {
                let is_low = |crossing: &&Crossing| crossing.y.iter().all(|y| y.abs() < *highest);
                let mut apart = apart(crossings.iter().filter(is_low).copied().collect());
                apart.truncate(strips);
                let is_more = |set: &HSet| best.as_ref().is_none_or(|best| promising(set, best).is_lt());
                *best = base.sized(x, &apart).filter(is_more).or_else(|| best.take());
            }
        }
        all.extend(best.into_iter().flatten());
    }
    all
}

impl HSet {
    /// With a range of x, and crossings of it as its strips; none of less than two, or where a follower would not leave the cam.
    fn sized(&self, x: [f64; 2], crossings: &[Crossing]) -> Option<Self> {
        let strip = |crossing: &Crossing| Strip {
            impacts: crossing.impacts as u64,
            revolutions: crossing.revolutions,
            x: crossing.x,
        };
        let y = height(crossings)?.map(rounded);
        let set = Self { x, y, strips: crossings.iter().map(strip).collect(), ..self.clone() };
        (set.strips.len() > 1 && lowest_velocity(&set) > 0.0).then_some(set)
    }
}

/// The lowest u in N.
fn lowest_velocity(set: &HSet) -> f64 {
    let least = |range: [f64; 2], by: f64| (range[0] * by).min(range[1] * by);
    set.centre[1] + least(set.x, set.unstable[1]) + least(set.y, set.stable[1])
}

/// Those of some crossings that are apart, the shortest in turns first.
fn apart(mut crossings: Vec<Crossing>) -> Vec<Crossing> {
    crossings.sort_by_key(|crossing| (crossing.revolutions, crossing.impacts));
    let mut apart: Vec<Crossing> = Vec::new();
    for crossing in crossings {
        if apart.iter().all(|other| other.x[1] < crossing.x[0] || crossing.x[1] < other.x[0]) {
            apart.push(crossing);
        }
    }
    apart
}

/// The range of y of crossings, and some more.
fn height(crossings: &[Crossing]) -> Option<[f64; 2]> {
    let low = crossings.iter().map(|crossing| crossing.y[0]).reduce(f64::min)?;
    let high = crossings.iter().map(|crossing| crossing.y[1]).reduce(f64::max)?;
    Some([low - ROOM * (high - low), high + ROOM * (high - low)])
}

/// Room above and below, of the height; the images of the lowest and the highest points leave most of it.
const ROOM: f64 = 0.12;
/// Room at each edge of a strip, of its width.
const EDGE: f64 = 0.03;

/// N with its height and strips such that they cover at all heights and speeds that are sampled.
fn ready(machine: &Machine, mut set: HSet) -> Option<HSet> {
    /// The height settles at once: images hardly depend on it.
    const ROUNDS: usize = 3;
    /// Points about a strip, and how far they go beyond it, of its width.
    const STRIP_POINTS: usize = 200;
    const BEYOND: f64 = 1.5;
    set.x = set.x.map(rounded);
    let parts = if set.rpm[0] < set.rpm[1] { vec![0.0, 0.5, 1.0] } else { vec![0.0] };
    let speed = |part: f64| machine.at_speed(angular_velocity(set.rpm[0] + part * (set.rpm[1] - set.rpm[0])));
    let machines: Vec<Machine> = parts.into_iter().map(speed).collect();
    for _ in 0..ROUNDS {
        let heights = [0.0, 0.5, 1.0].map(|part| set.y[0] + part * (set.y[1] - set.y[0]));
        // A strip is there at each speed and height, next to where it is at the others.
        let everywhere = |strip: &Strip| {
            let width = strip.x[1] - strip.x[0];
            let [low, high] = [strip.x[0] - BEYOND * width, strip.x[1] + BEYOND * width];
            let point = |index: usize| low + (high - low) * index as f64 / STRIP_POINTS as f64;
            let points: Vec<f64> = (0..=STRIP_POINTS).map(point).collect();
            let lines = machines.iter().flat_map(|machine| heights.map(|height| (machine, height)));
            let same = |crossing: &Crossing| {
                (crossing.impacts as u64, crossing.revolutions) == (strip.impacts, strip.revolutions)
            };
            let mut crossings = lines.map(|(machine, height)| {
                Line::new(machine, &set, height, points.clone()).crossings(set.x).into_iter().find(same)
            });
            let first = crossings.next()??;
            let whole = crossings.try_fold(first, |whole, crossing| Some(whole.hull(&crossing?)))?;
            let room = EDGE * (whole.x[1] - whole.x[0]);
            Some(Crossing { x: [rounded(whole.x[0] - room), rounded(whole.x[1] + room)], ..whole })
        };
        let is_inside = |crossing: &Crossing| set.x[0] < crossing.x[0] && crossing.x[1] < set.x[1];
        let crossings = apart(set.strips.iter().filter_map(everywhere).filter(is_inside).collect());
        set = set.sized(set.x, &crossings)?;
    }
    Some(set)
}

/// Proves an h-set, with cones where they are wanted and kept, and without the strips that are refused.
fn proved(machine: &Machine, mut set: HSet, wanted: Wanted) -> Result<Proved, Vec<Refused>> {
    let mut refused: Vec<Refused> = Vec::new();
    if wanted.cones {
        set.cone_slope = slope(machine, &set);
    }
    while set.strips.len() > 1 {
        match prove(machine, &set) {
            Ok(strips) => return Ok(Proved { set, strips, refused }),
            Err(why) if matches!(why.relation, Relation::Cones | Relation::Losses) => set.cone_slope = None,
            Err(why) => {
                set.strips.retain(|strip| strip.impacts != why.impacts);
                refused.push(why);
            }
        }
    }
    Err(refused)
}

/// The slope of cones that are kept, and stretched most, at some points of the strips.
fn slope(machine: &Machine, set: &HSet) -> Option<f64> {
    let map = ImpactMap::new(machine);
    let frame = Frame::new(set);
    let points = set.strips.iter().flat_map(|strip| {
        let at = |part: f64, [low, high]: [f64; 2]| low + part * (high - low);
        let parts = [0.0, 0.1, 0.5, 0.9, 1.0];
        parts.into_iter().flat_map(move |x| parts.map(move |y| (strip, [at(x, strip.x), at(y, set.y)])))
    });
    let points: Vec<_> = points.collect();
    let images: Option<Vec<_>> =
        points.into_par_iter().map(|(strip, point)| frame.at_point(&map, strip, point, set.rpm).ok()).collect();
    let images = images?;
    let least = |slope: f64| {
        images
            .iter()
            .map(|image| image.stretched(slope))
            .try_fold(f64::INFINITY, |least, growth| Some(least.min(growth?)))
    };
    let slopes = (-6..=8).map(|power| 2.0_f64.powi(power));
    let best = slopes.filter_map(|slope| Some((slope, least(slope)?))).max_by(|one, two| one.1.total_cmp(&two.1));
    best.map(|(slope, _)| slope)
}
