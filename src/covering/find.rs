//! Search for h-sets of a machine at a speed, or over a range of speeds: first by simulation, then by proof.
//!
//! Around each impact of a saddle of few impacts, N is tried with sides of many lengths along the stretched direction. Its height is the
//! height of the images of the parts that cross it. The h-set with the most motions is prepared for a proof: its strips are widened until
//! they cover at every height and at both ends of the range of speeds, with a margin.

use std::cmp::Ordering;

use rayon::prelude::*;

use super::base::{bases, rounded};
use super::frame::{HSetFrame, Image};
use super::map::ImpactMap;
use super::prove::{Covered, Refused, Relation, covered, loses, stands};
use super::sample::{Crossing, Line, MOST_IMPACTS};
use super::{HSet, Strip, entropy};
use crate::elementary;
use crate::progress::Watch;
use crate::simulate::{Machine, SimulateError, angular_velocity};

/// Proved h-set, with the proofs of its strips.
#[derive(Clone, Debug, PartialEq)]
pub struct Proved {
    /// Set with its proved strips only.
    pub set: HSet,
    /// Proved properties of each strip.
    pub strips: Vec<Covered>,
    /// Set without cones, with all strips that cover; `None` unless these are more than the strips that keep cones.
    pub without_cones: Option<(HSet, Vec<Covered>)>,
    /// Strips whose proof failed.
    pub refused: Vec<Refused>,
}

/// Result of a search that proved no chaos.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Short {
    /// Number of impacts of saddles that were tried.
    pub saddles: usize,
    /// Number of strips of the most promising h-set sampled.
    pub strips: usize,
    /// Relations that failed, for the strips tried.
    pub refused: Vec<Refused>,
}

/// Largest length of N along x that is tried, in the unit of x: degrees or m/s.
const FARTHEST: f64 = 32.0;
/// Number of sample points on a line.
const POINTS: usize = 12_000;
/// Ratio of successive lengths of a side of N, and the shortest length.
const SHORTER: f64 = 0.8;
const SHORTEST: f64 = 0.06;

/// Number of boxes after which the proof of a strip fails, which takes some seconds. Strips that cover with a margin need some hundreds.
const MOST_BOXES: usize = 1536;

/// Extent of the proof.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProofScope {
    /// Largest number of strips; those with the fewest revolutions come first.
    pub strips: usize,
    /// Whether cones are searched.
    pub cones: bool,
}

/// Finds an h-set with two strips or more at every speed of a range, rpm, and proves it.
pub fn find(
    machine: &Machine,
    rpm: [f64; 2],
    wanted: ProofScope,
    watch: &dyn Watch,
) -> Result<Result<Proved, Short>, SimulateError> {
    /// Number of h-sets per impact of a saddle that are sampled at all heights, and number of h-sets over all saddles whose proof is tried.
    /// The most promising come first.
    const SAMPLED: usize = 12;
    const TRIES: usize = 3;
    let middle = 0.5 * (rpm[0] + rpm[1]);
    let machine = machine.at_speed(angular_velocity(middle));
    watch.at("saddles of few impacts", 0, 0);
    let bases = bases(&machine, middle)?;
    let made_ready = |base: &HSet, lengths: &[Vec<f64>; 2]| {
        let mut sized = sizes(&machine, base, lengths, wanted.strips);
        sized.sort_by(promising);
        sized.dedup_by(|one, two| (one.x, &one.strips) == (two.x, &two.strips));
        sized.truncate(SAMPLED);
        let ready = sized.into_par_iter().filter_map(|set| ready(&machine, HSet { rpm, ..set }));
        ready.min_by(promising)
    };
    watch.at("strips that return across h-sets about saddles", 0, 0);
    let everywhere = [lengths(SHORTER), lengths(SHORTER)];
    let mut sets: Vec<HSet> = bases.par_iter().filter_map(|base| made_ready(base, &everywhere)).collect();
    // One more strip may lie between an end of the best set and the next.
    if let Some(best) = sets.iter_mut().min_by(|one, two| promising(one, two))
        && let Some(near) = made_ready(best, &[near(-best.x[0]), near(best.x[1])])
        && promising(&near, best).is_lt()
    {
        *best = near;
    }
    sets.sort_by(promising);
    let strips = sets.first().map_or(0, |set| set.strips.len());
    let mut short = Short { saddles: bases.len(), strips, refused: Vec::new() };
    let coned = |set| if wanted.cones { with_cones(&machine, set) } else { (0.0, set) };
    let mut candidates: Vec<(f64, HSet)> = sets.into_par_iter().map(coned).collect();
    // Sets whose strips keep cones at sample points come first.
    candidates.sort_by(|one, two| two.0.total_cmp(&one.0).then_with(|| promising(&one.1, &two.1)));
    let mut best: Option<Proved> = None;
    for (tried, (_, set)) in candidates.into_iter().take(TRIES).enumerate() {
        watch.at("strips, which are proved", tried as u64, TRIES as u64);
        let is_coned = set.cone_slope.is_some();
        let found = proved(&machine, set.clone());
        // Without strips whose flights may touch the cam, N need not be as high, and the other strips are farther from a touch.
        let refused = match &found {
            Ok(proved) => &proved.refused,
            Err(refused) => refused,
        };
        let is_left = |strip: &Strip| !refused.iter().any(|why| strip.x[0] <= why.at[0] && why.at[0] <= strip.x[1]);
        let left = HSet { strips: set.strips.iter().filter(|strip| is_left(strip)).cloned().collect(), ..set.clone() };
        let again = (!refused.is_empty() && left.strips.len() > 1).then(|| ready(&machine, left)).flatten();
        let again = again.and_then(|left| proved(&machine, coned(left).1).ok());
        if again.is_none()
            && let Err(refused) = &found
        {
            short.refused.extend(refused.iter().cloned());
        }
        for proved in found.ok().into_iter().chain(again) {
            if best.as_ref().is_none_or(|best| better(&proved.set, &best.set).is_lt()) {
                best = Some(proved);
            }
        }
        if best.as_ref().is_some_and(|best| best.set.cone_slope.is_some() == is_coned) {
            break;
        }
    }
    Ok(best.ok_or(short))
}

/// Orders h-sets: those with cones first, then those with more motions.
fn better(one: &HSet, two: &HSet) -> Ordering {
    two.cone_slope.is_some().cmp(&one.cone_slope.is_some()).then_with(|| promising(one, two))
}

/// Orders h-sets: higher entropy first. At equal entropy the smaller one comes first, since strips cross it sooner.
fn promising(one: &HSet, two: &HSet) -> Ordering {
    let size = |set: &HSet| (set.x[1] - set.x[0]) * (set.y[1] - set.y[0]);
    two.entropy().total_cmp(&one.entropy()).then(size(one).total_cmp(&size(two)))
}

/// Lengths from the farthest down to the shortest, each `part` of the one before.
fn lengths(part: f64) -> Vec<f64> {
    let shorter = |length: &f64| Some(part * length);
    std::iter::successors(Some(FARTHEST), shorter).take_while(|length| *length > SHORTEST).collect()
}

/// Lengths around a given one, from the next shorter to the next longer.
fn near(length: f64) -> Vec<f64> {
    const STEPS: i32 = 4;
    (-STEPS..=STEPS).map(|step| length * elementary::powf(SHORTER, f64::from(step) / f64::from(STEPS))).collect()
}

/// Returns sizes of N for a saddle. For each length to the left and each limit of the height, it takes the size with the most motions, with
/// the strips found along the middle line.
fn sizes(machine: &Machine, base: &HSet, [lefts, rights]: &[Vec<f64>; 2], strips: usize) -> Vec<HSet> {
    let points = (0..=POINTS).map(|index| FARTHEST * (2.0 * index as f64 / POINTS as f64 - 1.0));
    let line = Line::new(machine, base, 0.0, points.collect(), MOST_IMPACTS);
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
                *best = base.sized(x, &apart, ROOM).filter(is_more).or_else(|| best.take());
            }
        }
        all.extend(best.into_iter().flatten());
    }
    all
}

impl HSet {
    /// Sets the range of x, and its crossings as strips. `None` for fewer than two strips, or if a follower would not leave the cam.
    fn sized(&self, x: [f64; 2], crossings: &[Crossing], room: f64) -> Option<Self> {
        let strip = |crossing: &Crossing| Strip {
            impacts: crossing.impacts as u64,
            revolutions: crossing.revolutions,
            x: crossing.x,
        };
        let y = height(crossings, room)?.map(rounded);
        let set = Self { x, y, strips: crossings.iter().map(strip).collect(), ..self.clone() };
        (set.strips.len() > 1 && lowest_velocity(&set) > 0.0).then_some(set)
    }
}

/// Lowest velocity u in N.
fn lowest_velocity(set: &HSet) -> f64 {
    let least = |range: [f64; 2], by: f64| (range[0] * by).min(range[1] * by);
    set.centre[1] + least(set.x, set.unstable[1]) + least(set.y, set.stable[1])
}

/// Selects crossings that do not overlap, those with the fewest revolutions first.
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

/// Range of y of the crossings, extended at both ends by the part `room` of its height.
fn height(crossings: &[Crossing], room: f64) -> Option<[f64; 2]> {
    let low = crossings.iter().map(|crossing| crossing.y[0]).reduce(f64::min)?;
    let high = crossings.iter().map(|crossing| crossing.y[1]).reduce(f64::max)?;
    Some([low - room * (high - low), high + room * (high - low)])
}

/// Room above and below N, as a part of its height: if only images of the middle line count, and if the images of the lowest and highest
/// points count, too.
const ROOM: f64 = 0.12;
const LESS_ROOM: f64 = 0.1;
/// Room at each edge of a strip, as a part of its width.
const EDGE: f64 = 0.03;

/// Adjusts the height and the strips of N so that they cover at all sampled heights and speeds.
fn ready(machine: &Machine, mut set: HSet) -> Option<HSet> {
    /// The height converges at once, since images hardly depend on it.
    const ROUNDS: usize = 2;
    /// Sample points around a strip, and their reach beyond it, in widths of the strip.
    const STRIP_POINTS: usize = 80;
    const BEYOND: f64 = 1.5;
    set.x = set.x.map(rounded);
    let parts = if set.rpm[0] < set.rpm[1] { vec![0.0, 0.5, 1.0] } else { vec![0.0] };
    let speed = |part: f64| machine.at_speed(angular_velocity(set.rpm[0] + part * (set.rpm[1] - set.rpm[0])));
    let machines: Vec<Machine> = parts.into_iter().map(speed).collect();
    for _ in 0..ROUNDS {
        let heights = [0.0, 0.5, 1.0].map(|part| set.y[0] + part * (set.y[1] - set.y[0]));
        // A strip exists at each speed and height, near its position at the others.
        let everywhere = |strip: &Strip| {
            let width = strip.x[1] - strip.x[0];
            let [low, high] = [strip.x[0] - BEYOND * width, strip.x[1] + BEYOND * width];
            let point = |index: usize| low + (high - low) * index as f64 / STRIP_POINTS as f64;
            let points: Vec<f64> = (0..=STRIP_POINTS).map(point).collect();
            let lines = machines.iter().flat_map(|machine| heights.map(|height| (machine, height)));
            let same = |crossing: &Crossing| {
                (crossing.impacts as u64, crossing.revolutions) == (strip.impacts, strip.revolutions)
            };
            // Of two equal returns, the one nearer to the strip is used.
            let off = |crossing: &Crossing| (crossing.x[0] + crossing.x[1] - strip.x[0] - strip.x[1]).abs();
            let mut crossings = lines.map(|(machine, height)| {
                let line = Line::new(machine, &set, height, points.clone(), strip.impacts as usize);
                let alike = line.crossings(set.x).into_iter().filter(same);
                alike.min_by(|one, two| off(one).total_cmp(&off(two)))
            });
            let first = crossings.next()??;
            let whole = crossings.try_fold(first, |whole, crossing| Some(whole.hull(&crossing?)))?;
            let room = EDGE * (whole.x[1] - whole.x[0]);
            Some(Crossing { x: [rounded(whole.x[0] - room), rounded(whole.x[1] + room)], ..whole })
        };
        let is_inside = |crossing: &Crossing| set.x[0] < crossing.x[0] && crossing.x[1] < set.x[1];
        let crossings = apart(set.strips.iter().filter_map(everywhere).filter(is_inside).collect());
        set = set.sized(set.x, &crossings, LESS_ROOM)?;
    }
    Some(set)
}

/// Proves an h-set with the strips that cover it. If two or more keep cones, the set has only these, and `without_cones` has all.
fn proved(machine: &Machine, set: HSet) -> Result<Proved, Vec<Refused>> {
    let without = HSet { cone_slope: None, ..set.clone() };
    stands(&set).map_err(|why| vec![why])?;
    let has_cones = set.cone_slope.is_some() && loses(machine, &set).is_ok();
    let one = |strip: &Strip| {
        let kept = if has_cones {
            covered(machine, &set, strip, MOST_BOXES)
        } else {
            covered(machine, &without, strip, MOST_BOXES)
        };
        match kept {
            Err(Refused { relation: Relation::Cones, .. }) => covered(machine, &without, strip, MOST_BOXES),
            kept => kept,
        }
    };
    let outcomes: Vec<_> = set.strips.par_iter().map(one).collect();
    let all = set.strips.iter().zip(outcomes);
    let (covering, refused): (Vec<_>, Vec<_>) = all.partition(|(_, outcome)| outcome.is_ok());
    let refused: Vec<Refused> = refused.into_iter().filter_map(|(_, outcome)| outcome.err()).collect();
    let covering: Vec<_> =
        covering.into_iter().filter_map(|(strip, outcome)| Some((strip.clone(), outcome.ok()?))).collect();
    let coned: Vec<_> = covering.iter().filter(|(_, covered)| covered.growth.is_some()).cloned().collect();
    let with = |set: &HSet, some: &[(Strip, Covered)]| {
        let (strips, covered) = some.iter().cloned().unzip();
        (HSet { strips, ..set.clone() }, covered)
    };
    let (all, covered) = with(&without, &covering);
    if coned.len() < 2 {
        let has_chaos = covering.len() > 1;
        return if has_chaos {
            Ok(Proved { set: all, strips: covered, without_cones: None, refused })
        } else {
            Err(refused)
        };
    }
    let without_cones = (coned.len() < covering.len()).then_some((all, covered));
    let (set, strips) = with(&set, &coned);
    Ok(Proved { set, strips, without_cones, refused })
}

/// Chooses the slope of the cones for which the strips that keep them, at sample points, have the highest entropy, then the largest least
/// growth. Returns that entropy and the h-set.
fn with_cones(machine: &Machine, set: HSet) -> (f64, HSet) {
    let map = ImpactMap::new(machine);
    let frame = HSetFrame::new(&set);
    let images = set.strips.iter().map(|strip| {
        let at = |part: f64, [low, high]: [f64; 2]| low + part * (high - low);
        let parts = [0.0, 0.1, 0.5, 0.9, 1.0];
        let points = parts.into_iter().flat_map(|x| parts.map(|y| [at(x, strip.x), at(y, set.y)]));
        points.map(|point| frame.at_point(&map, strip, point, set.rpm).ok()).collect::<Option<Vec<_>>>()
    });
    let images: Vec<_> = images.collect();
    let kept = |slope: f64| {
        let least = |images: &Option<Vec<Image>>| {
            let growths = images.as_ref()?.iter().map(|image| image.stretched(slope));
            growths.reduce(|least, growth| Some(least?.min(growth?)))?
        };
        let growths: Vec<Option<f64>> = images.iter().map(least).collect();
        let keeps = set.strips.iter().zip(&growths).filter(|(_, growth)| growth.is_some());
        let least = growths.iter().flatten().fold(f64::INFINITY, |least, growth| least.min(*growth));
        (entropy(&keeps.map(|(strip, _)| strip.revolutions).collect::<Vec<_>>()), least)
    };
    let slopes = (-6..=8).map(|power| 2.0_f64.powi(power)).map(|slope| (kept(slope), slope));
    let most = |((one, more), _): &((f64, f64), f64), ((two, less), _): &((f64, f64), f64)| {
        one.total_cmp(two).then(more.total_cmp(less))
    };
    match slopes.max_by(most) {
        Some(((entropy, _), slope)) if entropy > 0.0 => (entropy, HSet { cone_slope: Some(slope), ..set }),
        _ => (0.0, set),
    }
}
