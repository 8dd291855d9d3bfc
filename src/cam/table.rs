//! Periodic interpolating splines through a table of lifts.
//!
//! Among all periodic curves through the rows the cubic spline minimises `integral of c''^2`, the quintic spline `integral of c'''^2`. The
//! unknowns are the slopes s at the rows and, for the quintic, the curvatures k. Setting the integral's derivatives to zero gives a
//! positive definite system that couples neighbours.

use std::f64::consts::TAU;

use nalgebra::{Matrix1, Matrix2, Vector1, Vector2};

use super::cyclic::Cyclic;
use super::law::Law;
use super::polynomial::Polynomial;
use super::{Cam, Joint, fit};
use crate::model::{Model, ModelError, Spline, TableProfile};

/// Range from one row to the next.
#[derive(Clone, Copy)]
struct Gap {
    start: f64,
    value: f64,
    /// Width in units of the mean gap, so that its powers stay in range.
    width: f64,
    slope: f64,
}

/// Builds the spline through the rows of a table, or near them.
pub(crate) fn build(model: &Model, profile: &TableProfile) -> Result<Cam, ModelError> {
    let rows = &profile.rows;
    let unit = TAU / rows.len() as f64;
    let gap = |index: usize| {
        let row = rows[index];
        let start = row.angle_deg.to_radians();
        let (end, lift) = match rows.get(index + 1) {
            Some(next) => (next.angle_deg.to_radians(), next.lift),
            None => (rows[0].angle_deg.to_radians() + TAU, rows[0].lift),
        };
        let width = (end - start) / unit;
        Gap { start, value: row.lift, width, slope: (lift - row.lift) / width }
    };
    let gaps: Vec<Gap> = (0..rows.len()).map(gap).collect();
    let (pieces, degree) = match &profile.spline {
        Spline::Cubic => (cubic(&gaps), 3),
        Spline::Quintic => (quintic(&gaps), 5),
        Spline::Smoothing(smoothing) => return Ok(fit::fit(model, profile, smoothing)?.cam()),
    };
    let place = profile.place();
    let overflow = || model.reject(place, "has lifts too large, or angles too close, for a spline through them");
    let law = |(gap, mut piece): (&Gap, [f64; 6])| {
        let mut scale = 1.0;
        for coefficient in &mut piece {
            *coefficient *= scale;
            scale /= unit;
        }
        let is_finite = piece.iter().all(|coefficient| coefficient.is_finite());
        is_finite.then(|| (gap.start, Law::Polynomial(Polynomial::new(gap.start, &piece[..=degree]))))
    };
    let pieces = pieces.ok_or_else(overflow)?;
    let laws: Option<Vec<_>> = gaps.iter().zip(pieces).map(law).collect();
    Ok(Cam::from_laws(laws.ok_or_else(overflow)?, Joint::Spline { degree, breaks: [].into() }))
}

/// Coefficients of each piece in powers of the angle from its start, in units of the mean gap.
fn cubic(gaps: &[Gap]) -> Option<Vec<[f64; 6]>> {
    let count = gaps.len();
    let mut system = Cyclic::<1>::new(count);
    for (index, Gap { width, slope, .. }) in gaps.iter().enumerate() {
        let after = (index + 1) % count;
        // c'' at the ends of a piece: (6 d - 4 s0 - 2 s1)/h and (2 s0 + 4 s1 - 6 d)/h; c'' must agree at every row.
        system.diagonal[index] += Matrix1::new(4.0 / width);
        system.diagonal[after] += Matrix1::new(4.0 / width);
        system.next[index] = Matrix1::new(2.0 / width);
        system.right[index] += Vector1::new(6.0 * slope / width);
        system.right[after] += Vector1::new(6.0 * slope / width);
    }
    let slopes = system.solve()?;
    let piece = |(index, gap): (usize, &Gap)| {
        let (s0, s1) = (slopes[index].x, slopes[(index + 1) % count].x);
        // Differences from the mean slope: no cancellation where the lift is steep.
        let (e0, e1) = (s0 - gap.slope, s1 - gap.slope);
        [gap.value, s0, -(2.0 * e0 + e1) / gap.width, (e0 + e1) / gap.width.powi(2), 0.0, 0.0]
    };
    Some(gaps.iter().enumerate().map(piece).collect())
}

/// Coefficients of each piece of degree 5 in powers of the angle from its start, in units of the mean gap.
fn quintic(gaps: &[Gap]) -> Option<Vec<[f64; 6]>> {
    let count = gaps.len();
    let mut system = Cyclic::<2>::new(count);
    for (index, Gap { width, slope, .. }) in gaps.iter().enumerate() {
        let after = (index + 1) % count;
        let (h, h2, h3) = (*width, width.powi(2), width.powi(3));
        // At a piece's start c''' = (60 d - 36 s0 - 24 s1)/h^2 + (3 k1 - 9 k0)/h,
        // c'''' = (-360 d + 192 s0 + 168 s1)/h^3 + (36 k0 - 24 k1)/h^2. At its end the mirror image applies, with the signs of d and s that
        // the order gives. The equations for s make c'''' continuous, those for k make c''' continuous.
        system.diagonal[index] += Matrix2::new(192.0 / h3, 36.0 / h2, 36.0 / h2, 9.0 / h);
        system.diagonal[after] += Matrix2::new(192.0 / h3, -36.0 / h2, -36.0 / h2, 9.0 / h);
        system.next[index] = Matrix2::new(168.0 / h3, -24.0 / h2, 24.0 / h2, -3.0 / h);
        system.right[index] += Vector2::new(360.0 * slope / h3, 60.0 * slope / h2);
        system.right[after] += Vector2::new(360.0 * slope / h3, -60.0 * slope / h2);
    }
    let ends = system.solve()?;
    let piece = |(index, gap): (usize, &Gap)| {
        let (left, right) = (ends[index], ends[(index + 1) % count]);
        let h = gap.width;
        // Differences from the mean slope, divided by h; curvatures.
        let (e0, e1) = ((left.x - gap.slope) / h, (right.x - gap.slope) / h);
        let (k0, k1) = (left.y, right.y);
        [
            gap.value,
            left.x,
            0.5 * k0,
            (-6.0 * e0 - 4.0 * e1 + 0.5 * (k1 - 3.0 * k0)) / h,
            (8.0 * e0 + 7.0 * e1 + 0.5 * (3.0 * k0 - 2.0 * k1)) / h.powi(2),
            (-3.0 * (e0 + e1) + 0.5 * (k1 - k0)) / h.powi(3),
        ]
    };
    Some(gaps.iter().enumerate().map(piece).collect())
}
