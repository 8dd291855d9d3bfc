//! Detection of corners and dwells in the rows of a table.
//!
//! A dwell is a range over which rows stay within their noise, without a trend. It must be so long that a curvature hidden by noise is a
//! small part of the cam's largest, and the lift must change beyond its ends. A range that the lift leaves slowly is no dwell if it fits
//! one smooth motion together with as many rows on one side. Parts of an eccentric base circle are such ranges. A dwell is taken to end a
//! little further inside, because at first a motion leaves it too slowly to be seen.
//!
//! A corner is an angle where the rows on both sides fit a jump of the second derivative better than any smooth motion (`corner_test`). The
//! jump must also be a considerable part of the largest curvature. A corner with less evidence is doubtful.

use std::f64::consts::TAU;

use nalgebra::DVector;
use serde::Serialize;

use super::corner_test::{self, Jump, Scales};
use super::orthonormal::Orthonormal;
pub(super) use super::smoothing::Features;
use crate::elementary;
use crate::model::{Smoothing, TableProfile, TableRow};
use crate::tolerance;

/// Rows at rising angles over one turn.
struct Rows<'a> {
    angles: &'a [f64],
    lifts: &'a [f64],
    /// Mean gap, rad.
    gap: f64,
    /// Standard deviation of the noise, m.
    noise: f64,
    /// Largest second derivative, estimated from rows some degrees apart, m/rad^2.
    curvature: f64,
}

/// Number of rows above which only every nth row is examined: features are some degrees long.
const MOST_ROWS: usize = 1000;

/// Corners found in rows, rad, ascending.
#[derive(Clone, Debug, Default)]
struct FoundCorners {
    /// Corners that no smooth motion explains.
    certain: Vec<f64>,
    /// Corners with less evidence, which are left out of the cam.
    doubtful: Vec<f64>,
}

/// Returns the features that a model gives, completed by features found in the rows, and the doubtful corners. `half_step` is half of the
/// rounding step of the lifts.
pub(super) fn of(smoothing: &Smoothing, angles: &[f64], lifts: &[f64], half_step: f64) -> (Features, Vec<f64>) {
    let given = |degrees: &Vec<f64>| degrees.iter().map(|angle| angle.to_radians()).collect();
    let corners: Option<Vec<f64>> = smoothing.corners_deg.as_ref().map(given);
    let given = |degrees: &Vec<[f64; 2]>| degrees.iter().map(|dwell| dwell.map(f64::to_radians)).collect();
    let dwells: Option<Vec<[f64; 2]>> = smoothing.dwells_deg.as_ref().map(given);
    let (corners, dwells) = match (corners, dwells) {
        (Some(corners), Some(dwells)) => return (Features { corners, dwells }, Vec::new()),
        open => open,
    };
    let every = angles.len().div_ceil(MOST_ROWS);
    let thin = |all: &[f64]| all.iter().copied().step_by(every).collect::<Vec<_>>();
    let (angles, lifts) = (thin(angles), thin(lifts));
    let rows = Rows::new(&angles, &lifts, half_step);
    let is_given = corners.is_some();
    let mut found = match corners {
        Some(certain) => FoundCorners { certain, doubtful: Vec::new() },
        None => rows.corners(),
    };
    let dwells = dwells.unwrap_or_else(|| rows.dwells(&found.certain));
    if !is_given {
        for corners in [&mut found.certain, &mut found.doubtful] {
            corners.retain(|corner| !dwells.iter().any(|dwell| is_inside(*corner, dwell)));
        }
    }
    (Features { corners: found.certain, dwells }, found.doubtful)
}

/// Whether a corner is inside a dwell; both in radians.
pub(super) fn is_inside(corner: f64, [from, to]: &[f64; 2]) -> bool {
    // A dwell that ends at a corner ends there to the last bit, up to a whole turn.
    let room = tolerance::SAME_KNOT.value;
    (room..to - from - room).contains(&(corner - from).rem_euclid(TAU))
}

/// Row of a table that is far from the value interpolated from the rows beside it.
#[derive(Clone, Copy, Debug, Serialize)]
#[doc(hidden)]
pub struct Stray {
    /// Line in the file of the table or of the model; for rows without a file, its index.
    pub line: usize,
    /// Angle, degrees.
    pub cam_angle_deg: f64,
    /// Lift, m.
    pub lift_m: f64,
    /// Distance above the value interpolated from the rows beside it, m.
    pub off_m: f64,
}

/// Standard deviation of the rows of a table from values interpolated from the rows beside them, m: their noise or their rounding.
pub(crate) fn spread(profile: &TableProfile) -> f64 {
    let (angles, lifts): (Vec<f64>, Vec<f64>) =
        profile.rows.iter().map(|row| (row.angle_deg.to_radians(), row.lift)).unzip();
    Rows::new(&angles, &lifts, profile.reading.half_step()).noise
}

/// Finds stray rows of a table, for example from a slip of a gauge, in order. An interpolating spline follows them fully, a smoothing
/// spline partly. A cam that turns sharply between two rows has such rows, too.
pub(crate) fn strays(profile: &TableProfile) -> Vec<Stray> {
    /// Distance in standard deviations that noise does not reach.
    const FAR: f64 = 8.0;
    /// Smallest distance of a stray row, as a part of the bend that the largest second derivative makes from one row to the next. At a jump
    /// of that derivative, at most twice as large, a polynomial through both sides is off by a tenth of this bend.
    const BENT: f64 = 0.25;
    /// Largest number of rounds over the rows.
    const ROUNDS: usize = 20;
    if !profile.may_be_smoothed() {
        return Vec::new();
    }
    let (angles, mut lifts): (Vec<f64>, Vec<f64>) =
        profile.rows.iter().map(|row| (row.angle_deg.to_radians(), row.lift)).unzip();
    let mut is_far = vec![false; lifts.len()];
    // A stray row far off hides others until it is replaced by its interpolated value.
    for _ in 0..ROUNDS {
        let rows = Rows::new(&angles, &lifts, profile.reading.half_step());
        let misses: Vec<(f64, f64)> = (0..angles.len() as isize).map(|row| rows.miss(row)).collect();
        let is_stray = |row: &usize| {
            let (off, by_noise) = misses[*row];
            // The rows beside a stray one also deviate, by less.
            let beside = [1, 2, 3].into_iter().flat_map(|away| [row + away, row + misses.len() - away]);
            off.abs() > BENT * rows.curvature * rows.gap * rows.gap
                && by_noise.abs() > FAR * rows.noise
                && beside.map(|other| misses[other % misses.len()].0).all(|other| other.abs() < off.abs())
        };
        let found: Vec<usize> = (0..misses.len()).filter(is_stray).filter(|row| !is_far[*row]).collect();
        if found.is_empty() {
            break;
        }
        for row in found {
            lifts[row] -= misses[row].0;
            is_far[row] = true;
        }
    }
    let stray = |row: usize| {
        let TableRow { line, angle_deg, lift } = profile.rows[row];
        Stray { line, cam_angle_deg: angle_deg, lift_m: lift, off_m: lift - lifts[row] }
    };
    (0..lifts.len()).filter(|row| is_far[*row]).map(stray).collect()
}

/// Polynomial of fourth degree fitted to rows.
struct Trend {
    /// Whether it reduces their squares by more than noise explains.
    is_seen: bool,
    /// Whether the rows are as near to it as their noise allows.
    is_smooth: bool,
}

impl<'a> Rows<'a> {
    fn new(angles: &'a [f64], lifts: &'a [f64], half_step: f64) -> Self {
        /// Angle over which curvatures are taken, rad.
        const REACH: f64 = 0.14;
        let gap = TAU / angles.len() as f64;
        let mut rows = Self { angles, lifts, gap, noise: 0.0, curvature: 0.0 };
        let reach = ((REACH / gap) as isize).clamp(1, angles.len() as isize / 4);
        let all = || 0..angles.len() as isize;
        rows.curvature = all().map(|row| rows.bend(row, reach).abs()).fold(0.0, f64::max);
        // On a dwell, lifts that are the same number differ by rounding alone, which depends on their unit.
        let size = lifts.iter().fold(0.0_f64, |size, lift| size.max(lift.abs()));
        let rounding = 64.0 * tolerance::ULP.value * size;
        let mut misses: Vec<f64> = all().map(|row| rows.miss(row).1.abs()).filter(|miss| *miss > rounding).collect();
        let middle = misses.len() / 2;
        let median = if misses.is_empty() { 0.0 } else { *misses.select_nth_unstable_by(middle, f64::total_cmp).1 };
        /// Ratio of the standard deviation of a normal distribution to the median of its absolute value.
        const NORMAL: f64 = 1.4826;
        rows.noise = (NORMAL * median).max(half_step / 3.0_f64.sqrt());
        rows
    }

    /// Angle and lift of a row; an index beyond a turn continues into the next turn.
    fn row(&self, index: isize) -> (f64, f64) {
        let count = self.angles.len() as isize;
        let inside = index.rem_euclid(count);
        let turns = (index - inside) / count;
        (self.angles[inside as usize] + TAU * turns as f64, self.lifts[inside as usize])
    }

    /// The second derivative over the rows `reach` before and after one.
    fn bend(&self, row: isize, reach: isize) -> f64 {
        let [before, here, after] = [row - reach, row, row + reach].map(|index| self.row(index));
        let slope = |one: (f64, f64), two: (f64, f64)| (two.1 - one.1) / (two.0 - one.0);
        2.0 * (slope(here, after) - slope(before, here)) / (after.0 - before.0)
    }

    /// Distance of a row from the polynomial of fifth degree through three rows on either side, m; and that distance divided by its
    /// standard deviation for noise of 1.
    fn miss(&self, row: isize) -> (f64, f64) {
        let (at, lift) = self.row(row);
        let others = [-3, -2, -1, 1, 2, 3].map(|away| self.row(row + away));
        let weight = |index: usize| {
            let parts = others.iter().enumerate().filter(|(other, _)| *other != index);
            parts.fold(1.0, |product, (_, other)| product * (at - other.0) / (others[index].0 - other.0))
        };
        let weights: [f64; 6] = std::array::from_fn(weight);
        let told: f64 = weights.iter().zip(others).map(|(weight, other)| weight * other.1).sum();
        let off = lift - told;
        (off, off / (1.0 + weights.iter().map(|weight| weight * weight).sum::<f64>()).sqrt())
    }

    /// Finds ranges of constant lift, by their ends; at one of `corners` a range may end abruptly.
    fn dwells(&self, corners: &[f64]) -> Vec<[f64; 2]> {
        /// Largest deviation of a row by noise, in standard deviations.
        const FAR: f64 = 3.0;
        /// Smallest number of rows of a dwell.
        const FEWEST: isize = 6;
        /// Angle over which the acceleration of a motion rises to its largest, rad.
        const RISE: f64 = 0.2;
        /// Longest second stay of a motion within the noise after it has left a dwell, relative to the angle that it needed to leave.
        const LEAVING: f64 = 0.6;
        /// Length, relative to that angle, from which a range may be a dwell even if it is left slowly.
        const LONG: f64 = 10.0;
        let count = self.angles.len() as isize;
        let room = FAR * self.noise;
        // Starts where the lift changes most, so that no dwell is cut in two.
        let change = |row: &isize| (self.row(row + 1).1 - self.row(*row).1).abs();
        let first = (0..count).max_by(|one, two| change(one).total_cmp(&change(two))).map_or(0, |row| row + 1);
        // Angle after which a motion has left the noise: c'' x^2/2 = 2 room at a corner, c''' x^3/6 if it leaves smoothly.
        let sudden = (4.0 * room / self.curvature).sqrt();
        let smooth = elementary::cbrt(12.0 * room * RISE / self.curvature).max(sudden);
        let mut stretches: Vec<[isize; 2]> = Vec::new();
        let mut row = first;
        while row < first + count {
            let end = self.stays(row, 1, first + count - 1 - row, room);
            let [from, to] = [row, end].map(|row| self.row(row).0);
            // A parabola that stays within the room over the stretch: c'' (length/2)^2 / 2 = 2 room.
            let hidden = 16.0 * room / (to - from).powi(2);
            if end - row + 1 >= FEWEST && hidden <= tolerance::HIDDEN_CURVATURE.value * self.curvature {
                // Noise may divide a dwell: two ranges that meet at one lift are merged. If they have a common trend, neither is a dwell.
                let meets = |before: &&mut [isize; 2]| {
                    let apart = (self.mean(**before) - self.mean([row, end])).abs();
                    from - self.row(before[1]).0 <= smooth + 2.0 * self.gap && apart <= 2.0 * room
                };
                match stretches.last_mut().filter(meets) {
                    Some(before) => before[1] = end,
                    None => stretches.push([row, end]),
                }
            }
            row = end + 1;
        }
        let mut found = Vec::new();
        for ends in stretches {
            let [start, end] = ends.map(|row| self.row(row).0);
            let snap = |end: f64, inward: f64| {
                let near = |corner: &f64| {
                    let away = (corner - end + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
                    (away.abs() <= smooth + 2.0 * self.gap).then_some(end + away)
                };
                corners.iter().find_map(near).unwrap_or(end + inward * smooth)
            };
            let [from, to] = [snap(start, 1.0), snap(end, -1.0)];
            // The top or the bottom of a wave also stays long within the noise, but leaves slowly.
            let moves_on = |row: isize, way: isize| {
                let last = self.stays(row + way, way, count, room);
                (self.row(last).0 - self.row(row + way).0).abs() <= LEAVING * smooth + 1.5 * self.gap
            };
            // A slope or a crest of an eccentric base circle also leaves slowly. There the range and as many rows on one side follow one
            // smooth motion.
            let beyond = ends[1] - ends[0] + 1;
            let goes_on =
                |more: [isize; 2]| self.trend(more, None).is_some_and(|trend| trend.is_seen && trend.is_smooth);
            let is_part = || goes_on([ends[0] - beyond, ends[1]]) || goes_on([ends[0], ends[1] + beyond]);
            let is_left = moves_on(ends[0], -1) && moves_on(ends[1], 1) || end - start > LONG * smooth && !is_part();
            let is_level = || self.trend(ends, Some([from, to])).is_none_or(|trend| !trend.is_seen);
            if to - from > 0.0 && is_left && is_level() {
                let start = from.rem_euclid(TAU);
                found.push([start, start + to - from]);
            }
        }
        found.sort_by(|one, two| one[0].total_cmp(&two[0]));
        found
    }

    /// Last row from `row` on, in direction `way` and at most `most` rows away, up to which the lifts stay within twice the room.
    fn stays(&self, row: isize, way: isize, most: isize, room: f64) -> isize {
        let mut range = [self.row(row).1; 2];
        let within = |away: &isize| {
            let lift = self.row(row + way * away).1;
            range = [range[0].min(lift), range[1].max(lift)];
            range[1] - range[0] <= 2.0 * room
        };
        row + way * (1..=most).take_while(within).last().unwrap_or(0)
    }

    /// Mean lift from one row to another.
    fn mean(&self, [start, end]: [isize; 2]) -> f64 {
        (start..=end).map(|row| self.row(row).1).sum::<f64>() / (end - start + 1) as f64
    }

    /// Trend of the rows from one to another, or of those between two angles, rad; `None` if a polynomial passes through all of these rows.
    fn trend(&self, [start, end]: [isize; 2], within: Option<[f64; 2]>) -> Option<Trend> {
        const DEGREE: i32 = 4;
        let [from, to] = within.unwrap_or([start, end].map(|row| self.row(row).0));
        let inside = (start..=end).map(|row| self.row(row)).filter(|(angle, _)| (from..=to).contains(angle));
        let (angles, lifts): (Vec<f64>, Vec<f64>) =
            inside.map(|(angle, lift)| (2.0 * (angle - from) / (to - from) - 1.0, lift)).unzip();
        let free = angles.len().checked_sub(DEGREE as usize + 1).filter(|free| *free > 0)?;
        let polynomials = Orthonormal::new(&angles, DEGREE)?;
        let mut lifts = DVector::from_iterator(lifts.len(), lifts.iter().map(|lift| lift - lifts[0]));
        let trend: f64 = polynomials.take(&mut lifts)[1..].iter().sum();
        let square = self.noise * self.noise;
        Some(Trend {
            is_seen: tolerance::DWELL_TREND.value * trend > square,
            is_smooth: lifts.norm_squared()
                <= square * (free as f64 + (2.0 * free as f64).sqrt() / tolerance::DWELL_SMOOTH.value),
        })
    }

    /// Finds the angles where the second derivative jumps.
    fn corners(&self) -> FoundCorners {
        /// Number of rows examined on either side, one scale after the other.
        const SCALES: [isize; 4] = [6, 12, 24, 48];
        /// Number of rows on either side that are examined even if they are far apart.
        const FEW: isize = 24;
        /// Angle on either side over which more rows are examined, rad: 24 rows that are a degree apart.
        const WIDE: f64 = 0.45;
        let is_near = |reach: isize| reach <= FEW || reach as f64 * self.gap <= WIDE;
        let count = self.angles.len() as isize;
        let is_certain = |jump: &Jump| tolerance::CORNER_CERTAIN.value * jump.evidence >= 1.0;
        let mut found: Vec<Jump> = Vec::new();
        let apart = |one: f64, two: f64| ((one - two + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU).abs();
        for reach in SCALES.into_iter().filter(|reach| 4 * reach < count && is_near(*reach)) {
            let half = reach / 2;
            // One-sided second differences cheaply show likely corners: the angles where they differ most.
            let differ = |row: isize| (self.bend(row + half, half) - self.bend(row - half, half)).abs();
            let least = 0.5 * tolerance::CORNER_SHARE.value * self.curvature;
            let is_most = |row: &isize| {
                let here = differ(*row);
                here >= least && (1..=half).all(|away| here >= differ(row - away) && here > differ(row + away))
            };
            let mut seen: Vec<Jump> = (0..count).filter(is_most).filter_map(|row| self.corner(row, reach)).collect();
            seen.sort_by(|one, two| two.evidence.total_cmp(&one.evidence));
            for jump in seen {
                match found.iter_mut().find(|other| apart(other.at, jump.at) <= half as f64 * self.gap) {
                    // Rows over a longer range may settle a doubt.
                    Some(other) if !is_certain(other) && is_certain(&jump) => *other = jump,
                    Some(_) => {}
                    None => found.push(jump),
                }
            }
        }
        let of = |certain: bool| {
            let corners = found.iter().filter(|jump| is_certain(jump) == certain);
            let mut corners: Vec<f64> = corners.map(|jump| jump.at.rem_euclid(TAU) % TAU).collect();
            corners.sort_by(f64::total_cmp);
            corners
        };
        FoundCorners { certain: of(true), doubtful: of(false) }
    }

    /// Tests the rows around one for a jump.
    fn corner(&self, row: isize, reach: isize) -> Option<Jump> {
        let rows: Vec<(f64, f64)> = (row - reach..=row + reach).map(|row| self.row(row)).collect();
        corner_test::jump(&rows, &Scales { gap: self.gap, noise: self.noise, curvature: self.curvature })
    }
}
