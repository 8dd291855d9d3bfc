//! Corners and dwells, found in the rows of a table.
//!
//! A dwell is a stretch over which rows stay within their noise. It must be so long that a curvature hidden by noise is a small part
//! of the cam's largest. It is taken to end a little inside: a motion leaves it too slowly to be seen at first.
//!
//! At a corner the rows on both sides fit a cubic plus a jump of its second and third derivatives. Elsewhere a quartic with a
//! jump of the third alone, which has as many coefficients, fits equally well. A corner is where the first fit leaves much less than the
//! second, each with its jump where it leaves the least. The jump must also be no small part of the largest curvature.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use serde::Serialize;

pub(super) use super::smoothing::Features;
use crate::elementary;
use crate::model::{Smoothing, TableProfile, TableRow};
use crate::tolerance;

/// Rows at rising angles, once round.
struct Rows<'a> {
    angles: &'a [f64],
    lifts: &'a [f64],
    /// The mean gap, rad.
    gap: f64,
    /// The standard deviation of the noise, m.
    noise: f64,
    /// The largest second derivative, estimated from rows some degrees apart, m/rad^2.
    curvature: f64,
}

/// With more rows than this, one in so many is examined: the features are some degrees long.
const MOST_ROWS: usize = 1000;

/// The features that a model gives, and those that it leaves to be found; `half_step` is half of the rounding step of the lifts.
pub(super) fn of(smoothing: &Smoothing, angles: &[f64], lifts: &[f64], half_step: f64) -> Features {
    let given = |degrees: &Vec<f64>| degrees.iter().map(|angle| angle.to_radians()).collect();
    let mut corners: Option<Vec<f64>> = smoothing.corners_deg.as_ref().map(given);
    let given = |degrees: &Vec<[f64; 2]>| degrees.iter().map(|dwell| dwell.map(f64::to_radians)).collect();
    let mut dwells: Option<Vec<[f64; 2]>> = smoothing.dwells_deg.as_ref().map(given);
    if corners.is_none() || dwells.is_none() {
        let every = angles.len().div_ceil(MOST_ROWS);
        let thin = |all: &[f64]| all.iter().copied().step_by(every).collect::<Vec<_>>();
        let (angles, lifts) = (thin(angles), thin(lifts));
        let rows = Rows::new(&angles, &lifts, half_step);
        let found = corners.get_or_insert_with(|| rows.corners());
        if dwells.is_none() {
            dwells = Some(rows.dwells(found));
        }
        if smoothing.corners_deg.is_none() {
            found.retain(|corner| !dwells.iter().flatten().any(|dwell| is_inside(*corner, dwell)));
        }
    }
    Features { corners: corners.unwrap_or_default(), dwells: dwells.unwrap_or_default() }
}

/// Whether a corner is inside of a dwell; both in radians.
pub(super) fn is_inside(corner: f64, [from, to]: &[f64; 2]) -> bool {
    // A dwell that ends at a corner ends there to the last bit but for a turn.
    let room = tolerance::SAME_KNOT.value;
    (room..to - from - room).contains(&(corner - from).rem_euclid(TAU))
}

/// A row of a table that is far from the value that the rows beside it give.
#[derive(Clone, Copy, Debug, Serialize)]
#[doc(hidden)]
pub struct Stray {
    /// Its line in the file of the table or of the model; for rows without a file, its index.
    pub line: usize,
    /// Its angle, degrees.
    pub cam_angle_deg: f64,
    /// Its lift, m.
    pub lift_m: f64,
    /// Its distance above the value that the rows beside it give, m.
    pub off_m: f64,
}

/// Standard deviation of the rows of a table from the values that the rows beside them give, m: their noise, or their rounding.
pub(crate) fn spread(profile: &TableProfile) -> f64 {
    let (angles, lifts): (Vec<f64>, Vec<f64>) =
        profile.rows.iter().map(|row| (row.angle_deg.to_radians(), row.lift)).unzip();
    Rows::new(&angles, &lifts, profile.reading.half_step()).noise
}

/// Stray rows of a table, such as a slip of a hand or a gauge leaves, in order. An interpolating spline follows them, a smoothing spline
/// half follows them. A cam that turns sharply between two rows has such rows, too.
pub(crate) fn strays(profile: &TableProfile) -> Vec<Stray> {
    /// Distance beyond any that noise gives a row, in its standard deviations.
    const FAR: f64 = 8.0;
    /// Part of the bend that the largest second derivative makes from one row to the next. At a jump of that derivative, at most
    /// twice as large, a polynomial through both sides is off by a tenth of that.
    const BENT: f64 = 0.25;
    /// Largest number of rounds over the rows.
    const ROUNDS: usize = 20;
    if !profile.may_be_smoothed() {
        return Vec::new();
    }
    let (angles, mut lifts): (Vec<f64>, Vec<f64>) =
        profile.rows.iter().map(|row| (row.angle_deg.to_radians(), row.lift)).unzip();
    let mut is_far = vec![false; lifts.len()];
    // One that is far off hides others until it stands where the rows beside it say.
    for _ in 0..ROUNDS {
        let rows = Rows::new(&angles, &lifts, profile.reading.half_step());
        let misses: Vec<(f64, f64)> = (0..angles.len() as isize).map(|row| rows.miss(row)).collect();
        let is_stray = |row: &usize| {
            let (off, by_noise) = misses[*row];
            // The rows beside a stray one are missed as well, by less.
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

impl<'a> Rows<'a> {
    fn new(angles: &'a [f64], lifts: &'a [f64], half_step: f64) -> Self {
        /// Angle over which curvatures are taken, rad.
        const REACH: f64 = 0.14;
        let gap = TAU / angles.len() as f64;
        let mut rows = Self { angles, lifts, gap, noise: 0.0, curvature: 0.0 };
        let reach = ((REACH / gap) as isize).clamp(1, angles.len() as isize / 4);
        let all = || 0..angles.len() as isize;
        rows.curvature = all().map(|row| rows.bend(row, reach).abs()).fold(0.0, f64::max);
        // On a dwell rounding alone is left of lifts that are one number; how much depends on the unit that they are in.
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

    /// Angle, from any turn on, and lift of a row.
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

    /// Distance of a row from the polynomial of fifth degree through three rows on either side, m; and that divided by the one from noise
    /// of 1.
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

    /// Stretches of one lift, by their ends; at one of `corners` a stretch may end abruptly.
    fn dwells(&self, corners: &[f64]) -> Vec<[f64; 2]> {
        /// Largest deviation of a row by noise, in standard deviations.
        const FAR: f64 = 3.0;
        /// The fewest rows of a dwell.
        const FEWEST: isize = 6;
        /// Angle in which the acceleration of a motion rises to its largest, rad.
        const RISE: f64 = 0.2;
        let count = self.angles.len() as isize;
        let room = FAR * self.noise;
        // From where the lift changes most, so that no dwell is cut in two.
        let change = |row: &isize| (self.row(row + 1).1 - self.row(*row).1).abs();
        let first = (0..count).max_by(|one, two| change(one).total_cmp(&change(two))).map_or(0, |row| row + 1);
        let mut found = Vec::new();
        let mut row = first;
        while row < first + count {
            let mut range = [self.row(row).1; 2];
            let mut end = row;
            while end + 1 < first + count {
                let lift = self.row(end + 1).1;
                let wider = [range[0].min(lift), range[1].max(lift)];
                if wider[1] - wider[0] > 2.0 * room {
                    break;
                }
                (range, end) = (wider, end + 1);
            }
            let [from, to] = [row, end].map(|row| self.row(row).0);
            // A parabola that stays within the room over the stretch: c'' (length/2)^2 / 2 = 2 room.
            let hidden = 16.0 * room / (to - from).powi(2);
            if end - row + 1 >= FEWEST && hidden <= tolerance::HIDDEN_CURVATURE.value * self.curvature {
                // What leaves at a corner is off by the room after c'' x^2/2 = 2 room, what leaves smoothly after c''' x^3/6.
                let sudden = (4.0 * room / self.curvature).sqrt();
                let smooth = elementary::cbrt(12.0 * room * RISE / self.curvature).max(sudden);
                let snap = |end: f64, inward: f64| {
                    let near = |corner: &f64| {
                        let away = (corner - end + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
                        (away.abs() <= smooth + 2.0 * self.gap).then_some(end + away)
                    };
                    corners.iter().find_map(near).unwrap_or(end + inward * smooth)
                };
                let [from, to] = [snap(from, 1.0), snap(to, -1.0)];
                if to - from > 0.0 {
                    let start = from.rem_euclid(TAU);
                    found.push([start, start + to - from]);
                }
            }
            row = end + 1;
        }
        found.sort_by(|one, two| one[0].total_cmp(&two[0]));
        found
    }

    /// Where the second derivative jumps, by rising angle.
    fn corners(&self) -> Vec<f64> {
        /// Rows examined on either side, a scale at a time.
        const SCALES: [isize; 3] = [6, 12, 24];
        let count = self.angles.len() as isize;
        let mut found: Vec<f64> = Vec::new();
        let apart = |one: f64, two: f64| ((one - two + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU).abs();
        for reach in SCALES.into_iter().filter(|reach| 4 * reach < count) {
            let half = reach / 2;
            // One-sided second differences cheaply show where a corner is likely: where they differ most.
            let differ = |row: isize| (self.bend(row + half, half) - self.bend(row - half, half)).abs();
            let least = 0.5 * tolerance::CORNER_SHARE.value * self.curvature;
            let is_most = |row: &isize| {
                let here = differ(*row);
                here >= least && (1..=half).all(|away| here >= differ(row - away) && here > differ(row + away))
            };
            let mut seen: Vec<(f64, f64)> =
                (0..count).filter(is_most).filter_map(|row| self.corner(row, reach)).collect();
            seen.sort_by(|one, two| two.0.total_cmp(&one.0));
            for (_, at) in seen {
                if found.iter().all(|other| apart(*other, at) > half as f64 * self.gap) {
                    found.push(at);
                }
            }
        }
        found.iter_mut().for_each(|corner| *corner = corner.rem_euclid(TAU) % TAU);
        found.sort_by(f64::total_cmp);
        found
    }

    /// Advantage of a corner over a jump of the third derivative, or over a steep rise of the second, in the squares that it leaves of the
    /// rows around one, over the squares of the noise; and its place. None where the advantage or the corner is too small.
    fn corner(&self, row: isize, reach: isize) -> Option<(f64, f64)> {
        /// Parts of the rows on one side, over half of which the acceleration may as well rise.
        const RISES: [f64; 2] = [0.25, 0.5];
        let [(with, at, jump), (without, ..)] = [0.0, f64::NAN].map(|rise| self.best(row, reach, rise));
        let rising = RISES.iter().filter_map(|rise| Some(self.fitted(at, row, reach, *rise)?.0));
        let without = rising.fold(without, f64::min);
        // The rows less two polynomials and where they meet.
        let freedom = (2 * reach - 6) as f64;
        let gained = (without - with) / (with / freedom).max(self.noise * self.noise);
        // What two cubics cannot follow is no noise, and hides more than one jump.
        let coarse = tolerance::CORNER_MISFIT.value * self.curvature * self.gap * self.gap;
        let noise = self.noise.max(coarse);
        let is_clear =
            with / freedom <= 4.0 * noise * noise && noise * noise <= tolerance::CORNER_NOISE.value * (without - with);
        let is_one = is_clear && jump.abs() >= tolerance::CORNER_SHARE.value * self.curvature;
        is_one.then_some((gained, at))
    }

    /// The least sum of squares left of the rows around one, the place of the jump then, and the jump.
    fn best(&self, row: isize, reach: isize, rise: f64) -> (f64, f64, f64) {
        /// Parts of the stretch that are tried, at first and after each round.
        const PARTS: i32 = 6;
        const ROUNDS: i32 = 9;
        let mut step = 0.5 * reach as f64 * self.gap / f64::from(PARTS);
        let mut best = (f64::INFINITY, self.row(row).0, 0.0);
        for _ in 0..ROUNDS {
            let middle = best.1;
            for at in (-PARTS..=PARTS).map(|part| middle + f64::from(part) * step) {
                if let Some((left, jump)) = self.fitted(at, row, reach, rise).filter(|(left, _)| *left < best.0) {
                    best = (left, at, jump);
                }
            }
            step *= 2.0 / f64::from(PARTS);
        }
        best
    }

    /// The sum of squares that a cubic with a jump of its second and third derivatives at `at` leaves of the rows around one, and the jump
    /// of the second. With a `rise`, the second derivative rises over that part of the rows on either side instead. Where `rise` is not a
    /// number, the fit is a quartic with a jump of the third.
    fn fitted(&self, at: f64, row: isize, reach: isize, rise: f64) -> Option<(f64, f64)> {
        let unit = reach as f64 * self.gap;
        let rows: Vec<(f64, f64)> = (row - reach..=row + reach).map(|row| self.row(row)).collect();
        let middle = self.row(row).1;
        let column = |u: f64, column: i32| match column {
            4 if rise == 0.0 => u.max(0.0).powi(2),
            // The integral of the integral of what rises from 0 to 2 in between.
            4 if rise > 0.0 => ((u + rise).max(0.0).powi(3) - (u - rise).max(0.0).powi(3)) / (6.0 * rise),
            5 => u.max(0.0).powi(3),
            power => u.powi(power),
        };
        let matrix = DMatrix::from_fn(rows.len(), 6, |index, power| column((rows[index].0 - at) / unit, power as i32));
        let right = DVector::from_fn(rows.len(), |index, _| rows[index].1 - middle);
        let qr = matrix.clone().qr();
        let solution = qr.r().solve_upper_triangular(&(qr.q().transpose() * &right))?;
        let left = right - matrix * &solution;
        Some((left.norm_squared(), 2.0 * solution[4] / (unit * unit)))
    }
}
