//! Periodic quintic smoothing splines, which pass near the rows of a table and are as smooth as that allows.
//!
//! Among all periodic curves the spline minimises `integral of c'''^2 + weight sum of (c(row) - lift)^2`. Its unknowns are lift f, slope s
//! and curvature k at every knot. The integral over a piece is a quadratic form in the values at its ends. Setting the derivatives to zero
//! gives a positive definite system that couples neighbours. No other condition is set at a knot: derivatives up to the fourth are
//! continuous there, unless a row lies between it and the next knot.
//!
//! A corner is a knot with a separate curvature on either side, for which the integral is least: there the third derivative is 0 on both
//! sides. A dwell is a knot with a width, where only the lift is unknown. Its slope is 0, and so is its curvature, except at an end that is
//! a corner.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Matrix6, Vector6};
use serde::Serialize;

use super::cyclic::Cyclic;
use super::law::Law;
use super::polynomial::Polynomial;
use super::within_a_turn;
use crate::tolerance;

/// Corners and dwells of a cam, rad.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Features {
    /// Angles where the second derivative may jump, in `[0, 2 pi)`.
    pub corners: Vec<f64>,
    /// Ranges of constant lift, start and end; they begin in `[0, 2 pi)`, by rising angle.
    pub dwells: Vec<[f64; 2]>,
}

impl Features {
    /// Returns a copy with one corner turned by an angle, rad, together with dwell ends at that corner.
    pub fn moved(&self, corner: usize, by: f64) -> Self {
        let mut moved = self.clone();
        let from = self.corners[corner];
        moved.corners[corner] = (from + by).rem_euclid(TAU) % TAU;
        let is_there = |end: f64| {
            let apart = (end - from).rem_euclid(TAU);
            apart.min(TAU - apart) <= tolerance::SAME_KNOT.value
        };
        for dwell in &mut moved.dwells {
            for end in dwell.iter_mut().filter(|end| is_there(**end)) {
                *end += by;
            }
            let turn = within_a_turn(dwell[0]) - dwell[0];
            *dwell = dwell.map(|end| end + turn);
        }
        moved.dwells.sort_by(|one, two| one[0].total_cmp(&two[0]));
        moved
    }
}

/// Knot or dwell.
#[derive(Clone, Copy, Debug)]
struct Knot {
    start: f64,
    /// End, rad; above `start` for a dwell.
    end: f64,
    /// Whether the curvature is free on the side before, and on the side after.
    corner: [bool; 2],
}

impl Knot {
    fn is_dwell(&self) -> bool {
        self.end > self.start
    }

    fn is_corner(&self) -> bool {
        self.corner[0] || self.corner[1]
    }
}

/// Place of a row: the knot before it, and its position in the piece after that knot, from 0 to 1; `None` for a row at the knot.
type Place = (usize, Option<f64>);

/// Knots and places of rows, independent of the lifts.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    knots: Vec<Knot>,
    places: Vec<Place>,
    /// Mean gap between two knots, rad. Widths are in this unit, so that their powers stay in range.
    unit: f64,
}

/// Functional that a smoothing spline minimises, in radians, for programs that compute it by other means.
#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct Fitted {
    /// Weight of the sum of squares relative to the integral, 1/rad^5.
    weight: f64,
    /// Angles where pieces meet, without dwells.
    knots_rad: Vec<f64>,
    corners_rad: Vec<f64>,
    /// Ends of each dwell.
    dwells_rad: Vec<[f64; 2]>,
}

/// Smoothing spline.
#[derive(Clone, Debug)]
pub(super) struct Smoothed {
    /// Lift, slope and curvature at both ends of each piece, by powers of the unit.
    ends: Vec<Vector6<f64>>,
    /// Lift that was subtracted from all lifts.
    base: f64,
    /// Lift of each row less the lift of the spline there.
    pub residuals: Vec<f64>,
    /// Minimum of the integral plus the weighted sum.
    pub least: f64,
    /// Sum of squared residuals of rows outside dwells.
    pub squares: f64,
    /// Number of rows outside dwells.
    pub moving: f64,
    /// Degrees of freedom taken from these rows: the trace of the matrix that maps lifts to spline lifts. It equals the number of rows if
    /// the spline passes through them.
    pub freedom: f64,
}

/// Eliminated curvatures of a piece at its start and its end: for each, its column divided by its pivot, and the pivot.
type Freed = [Option<(Vector6<f64>, f64)>; 2];

/// Laws with the angles where they start.
pub(super) type Laws = Vec<(f64, Law)>;

/// Quadratic form of `integral of c'''^2` over a piece of width 1, in f, s, k at its start and at its end.
#[rustfmt::skip]
const ENERGY: [[f64; 6]; 6] = [
    [720.0, 360.0, 60.0, -720.0, 360.0, -60.0],
    [360.0, 192.0, 36.0, -360.0, 168.0, -24.0],
    [60.0, 36.0, 9.0, -60.0, 24.0, -3.0],
    [-720.0, -360.0, -60.0, 720.0, -360.0, 60.0],
    [360.0, 168.0, 24.0, -360.0, 192.0, -36.0],
    [-60.0, -24.0, -3.0, 60.0, -36.0, 9.0],
];

/// Quintic with f, s, k at the ends of a piece of width 1, as powers of the position in the piece: one column for each value.
#[rustfmt::skip]
const HERMITE: [[f64; 6]; 6] = [
    [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 0.5, 0.0, 0.0, 0.0],
    [-10.0, -6.0, -1.5, 10.0, -4.0, 0.5],
    [15.0, 8.0, 1.5, -15.0, 7.0, -1.0],
    [-6.0, -3.0, -0.5, 6.0, -3.0, 0.5],
];

/// Indices of the curvature at a piece's start and at its end.
const CURVATURES: [usize; 2] = [2, 5];

impl Layout {
    /// Largest number of knots: more would be closer than any feature of a motion, and lose digits in its slow parts.
    const MOST_KNOTS: usize = 1000;

    /// Builds the layout for rows at rising angles in `[0, 2 pi)`, rad; `None` if fewer than three knots remain.
    pub fn new(angles: &[f64], features: &Features) -> Option<Self> {
        let every = angles.len().div_ceil(Self::MOST_KNOTS);
        let gap = TAU * every as f64 / angles.len() as f64;
        let near = tolerance::SAME_KNOT.value * gap;
        let around = |from: f64, to: f64| (to - from).rem_euclid(TAU);
        let apart = |one: f64, two: f64| around(one, two).min(around(two, one));
        let is_corner = |angle: f64| features.corners.iter().any(|corner| apart(*corner, angle) <= near);
        let dwell = |[from, to]: &[f64; 2]| Knot { start: *from, end: *to, corner: [is_corner(*from), is_corner(*to)] };
        let mut knots: Vec<Knot> = features.dwells.iter().map(dwell).collect();
        let holds =
            |knot: &Knot, angle: f64, room: f64| around(knot.start - room, angle) <= knot.end - knot.start + 2.0 * room;
        for corner in &features.corners {
            if !knots.iter().any(|knot| holds(knot, *corner, near)) {
                knots.push(Knot { start: *corner, end: *corner, corner: [true; 2] });
            }
        }
        // A knot close to another one would make a piece too short for its powers.
        let features = knots.clone();
        let is_free = |angle: &&f64| !features.iter().any(|knot| holds(knot, **angle, 0.5 * gap));
        knots.extend(angles.iter().step_by(every).filter(is_free).map(|angle| Knot {
            start: *angle,
            end: *angle,
            corner: [false; 2],
        }));
        knots.sort_by(|one, two| one.start.total_cmp(&two.start));
        if knots.len() < 3 {
            return None;
        }
        let mut layout = Self { unit: TAU / knots.len() as f64, knots, places: Vec::new() };
        let place = |angle: &f64| {
            let before = layout.knots.partition_point(|knot| knot.start <= angle + near);
            let before = before.checked_sub(1).unwrap_or(layout.knots.len() - 1);
            let knot = layout.knots[before];
            if holds(&knot, *angle, near) {
                return (before, None);
            }
            (before, Some(around(knot.end, *angle) / layout.width(before)))
        };
        layout.places = angles.iter().map(place).collect();
        Some(layout)
    }

    /// Returns the functional in radians, for a weight in units of the mean gap.
    pub fn fitted(&self, weight: f64) -> Fitted {
        let mut fitted = Fitted { weight: weight / self.unit.powi(5), ..Fitted::default() };
        for knot in &self.knots {
            let ends = [knot.start, knot.end % TAU];
            let corners = ends.into_iter().zip(knot.corner).filter(|(_, is_corner)| *is_corner);
            fitted.corners_rad.extend(corners.map(|(end, _)| end));
            match knot.is_dwell() {
                true => fitted.dwells_rad.push(ends),
                false => fitted.knots_rad.push(knot.start),
            }
        }
        fitted
    }

    fn after(&self, knot: usize) -> usize {
        (knot + 1) % self.knots.len()
    }

    /// Width of the piece after a knot, rad.
    fn width(&self, knot: usize) -> f64 {
        let turn = if knot + 1 == self.knots.len() { TAU } else { 0.0 };
        self.knots[self.after(knot)].start + turn - self.knots[knot].end
    }

    /// Computes the spline near the lifts for a weight in units of the mean gap; `None` if rounding destroys the solution.
    pub fn smoothed(&self, lifts: &[f64], weight: f64) -> Option<Smoothed> {
        let count = self.knots.len();
        let base = lifts.iter().sum::<f64>() / lifts.len() as f64;
        let mut forms: Vec<(Matrix6<f64>, Vector6<f64>)> =
            (0..count).map(|knot| (self.energy(knot), Vector6::zeros())).collect();
        // Rows at a knot are counted with the piece after it.
        let seen = |(knot, part): &Place| {
            let width = self.width(*knot) / self.unit;
            (*knot, basis(width, part.unwrap_or(0.0)))
        };
        for (place, lift) in self.places.iter().zip(lifts) {
            let (knot, basis) = seen(place);
            forms[knot].0 += weight * basis * basis.transpose();
            forms[knot].1 += weight * (lift - base) * basis;
        }
        // Factors by which free curvatures are eliminated, kept for the back substitution.
        let mut freed: Vec<Freed> = vec![[None; 2]; count];
        let mut system = Cyclic::<3>::new(count);
        for (knot, (form, right)) in forms.iter_mut().enumerate() {
            for (side, index) in CURVATURES.into_iter().enumerate() {
                if self.is_free(knot, side) {
                    let (row, pivot, known) = (form.column(index).into_owned(), form[(index, index)], right[index]);
                    *form -= row * row.transpose() / pivot;
                    *right -= row * known / pivot;
                    freed[knot][side] = Some((row / pivot, pivot));
                    // The part of the curvature that depends on the lifts is kept in its place.
                    right[index] = known / pivot;
                }
            }
            let [mut before, mut beyond] = [0, 3].map(|start| right.fixed_rows::<3>(start).into_owned());
            if freed[knot][0].is_some() {
                before[2] = 0.0;
            }
            if freed[knot][1].is_some() {
                beyond[2] = 0.0;
            }
            let block = |row: usize, column: usize| form.fixed_view::<3, 3>(row, column).into_owned();
            let after = self.after(knot);
            system.diagonal[knot] += block(0, 0);
            system.diagonal[after] += block(3, 3);
            system.next[knot] += block(0, 3);
            system.right[knot] += before;
            system.right[after] += beyond;
        }
        self.hold(&mut system);
        let (solution, inverse) = system.solve_and_invert()?;
        let mut ends = Vec::with_capacity(count);
        for knot in 0..count {
            let (one, two) = (solution[knot], solution[self.after(knot)]);
            let mut end = Vector6::new(one[0], one[1], one[2], two[0], two[1], two[2]);
            // Back substitution, in the reverse order of elimination.
            for side in [1, 0] {
                if let Some((row, _)) = freed[knot][side] {
                    let index = CURVATURES[side];
                    end[index] = 0.0;
                    end[index] = forms[knot].1[index] - row.dot(&end);
                }
            }
            ends.push(end);
        }
        let (mut least, mut squares, mut moving, mut freedom) = (0.0, 0.0, 0.0, 0.0);
        let mut residuals = Vec::with_capacity(lifts.len());
        for (place, lift) in self.places.iter().zip(lifts) {
            let (knot, basis) = seen(place);
            let residual = lift - base - basis.dot(&ends[knot]);
            residuals.push(residual);
            // At the minimum the functional equals weight times the sum of residual times lift, relative to the base.
            least += weight * residual * (lift - base);
            // A dwell has one lift for all of its rows, whatever the weight.
            if place.1.is_none() && self.knots[knot].is_dwell() {
                continue;
            }
            (squares, moving) = (squares + residual * residual, moving + 1.0);
            freedom += weight * self.influence(knot, &basis, &freed[knot], &inverse);
        }
        residuals.iter().all(|residual| residual.is_finite()).then_some(Smoothed {
            ends,
            base,
            residuals,
            least,
            squares,
            moving,
            freedom,
        })
    }

    /// Shift of the spline at a row per unit shift of its lift, divided by the weight: `b^T M^-1 b`, plus the contribution of the
    /// eliminated curvatures.
    fn influence(&self, knot: usize, basis: &Vector6<f64>, freed: &Freed, inverse: &[[Matrix3<f64>; 2]]) -> f64 {
        let [here, beyond] = inverse[knot];
        let there = inverse[self.after(knot)][0];
        let (mut seen, mut of_freed) = (*basis, 0.0);
        for (row, index) in freed.iter().zip(CURVATURES) {
            if let Some((row, pivot)) = row {
                let part = seen[index];
                of_freed += part * part / pivot;
                seen -= row * part;
                seen[index] = 0.0;
            }
        }
        let [one, two] = [0, 3].map(|start| seen.fixed_rows::<3>(start).into_owned());
        of_freed + one.dot(&(here * one)) + 2.0 * one.dot(&(beyond * two)) + two.dot(&(there * two))
    }

    /// Whether a piece has a separate curvature at its start (side 0) or its end (side 1).
    fn is_free(&self, piece: usize, side: usize) -> bool {
        if side == 0 { self.knots[piece].corner[1] } else { self.knots[self.after(piece)].corner[0] }
    }

    /// Quadratic form of a piece, in units of the mean gap.
    fn energy(&self, piece: usize) -> Matrix6<f64> {
        let width = self.width(piece) / self.unit;
        let powers: [f64; 6] = std::array::from_fn(|index| width.powi(index as i32 % 3));
        Matrix6::from_fn(|row, column| ENERGY[row][column] * powers[row] * powers[column] / width.powi(5))
    }

    /// Sets the equations of values that are fixed at 0.
    fn hold(&self, system: &mut Cyclic<3>) {
        for (index, knot) in self.knots.iter().enumerate() {
            for unknown in 1..3 {
                if knot.is_dwell() || unknown == 2 && knot.is_corner() {
                    for other in 0..3 {
                        system.diagonal[index][(unknown, other)] = 0.0;
                        system.diagonal[index][(other, unknown)] = 0.0;
                        system.next[index][(unknown, other)] = 0.0;
                        let before = (index + self.knots.len() - 1) % self.knots.len();
                        system.next[before][(other, unknown)] = 0.0;
                    }
                    system.diagonal[index][(unknown, unknown)] = 1.0;
                    system.right[index][unknown] = 0.0;
                }
            }
        }
    }

    /// Laws of a spline with the angles where they start, by rising angle in `[0, 2 pi)`; and the angles where a derivative below the fifth
    /// jumps, with its order.
    pub fn laws(&self, spline: &Smoothed) -> (Laws, Vec<(f64, usize)>) {
        let (mut laws, mut breaks) = (Vec::new(), Vec::new());
        let within = |angle: f64| if angle >= TAU { angle - TAU } else { angle };
        for (index, (knot, ends)) in self.knots.iter().zip(&spline.ends).enumerate() {
            if knot.is_dwell() {
                laws.push((knot.start, Law::Dwell(spline.base + ends[0])));
                let order = |corner: bool| if corner { 2 } else { 3 };
                breaks.extend([(knot.start, order(knot.corner[0])), (within(knot.end), order(knot.corner[1]))]);
            } else if knot.is_corner() {
                breaks.push((knot.start, 2));
            }
            let start = within(knot.end);
            let (width, next) = (self.width(index), self.knots[self.after(index)]);
            // Expanded about the start of a dwell that follows, so that the lift is constant there to the last bit.
            let (from, sign, ends) = match next.is_dwell() {
                true => (if next.start > start { next.start } else { next.start + TAU }, -1.0, mirrored(ends)),
                false => (start, 1.0, *ends),
            };
            let powers = self.powers(&ends, sign * width, spline.base);
            laws.push((start, Law::Polynomial(Polynomial::new(from, &powers))));
        }
        laws.sort_by(|one, two| one.0.total_cmp(&two.0));
        (laws, breaks)
    }

    /// Coefficients of a piece in powers of the angle from its start; with a negative width, those of its mirror image from its end.
    fn powers(&self, ends: &Vector6<f64>, width: f64, base: f64) -> [f64; 6] {
        let scale = width.abs() / self.unit;
        // Uses the difference of the lifts, so that no large terms cancel: the columns of f in HERMITE are each other's negative.
        let parts = [
            0.0,
            ends[1] * scale,
            ends[2] * scale * scale,
            ends[3] - ends[0],
            ends[4] * scale,
            ends[5] * scale * scale,
        ];
        std::array::from_fn(|power| {
            let sum: f64 = HERMITE[power].iter().zip(parts).map(|(entry, part)| entry * part).sum();
            if power == 0 { base + ends[0] } else { sum / width.powi(power as i32) }
        })
    }
}

/// Lift, slope and curvature at both ends of a piece's mirror image.
fn mirrored(ends: &Vector6<f64>) -> Vector6<f64> {
    Vector6::new(ends[3], -ends[4], ends[5], ends[0], -ends[1], ends[2])
}

/// Coefficients of f, s, k at the ends of a piece in the lift at a position in the piece.
fn basis(width: f64, part: f64) -> Vector6<f64> {
    Vector6::from_fn(|column, _| {
        let polynomial = (0..6).rev().fold(0.0, |sum, power| sum * part + HERMITE[power][column]);
        polynomial * width.powi(column as i32 % 3)
    })
}
