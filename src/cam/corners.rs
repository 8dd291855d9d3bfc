//! Corners, where segments meet, with the derivative that jumps; and cams with the law of one side continued past a corner.

use std::f64::consts::TAU;

use serde::Serialize;

use super::jet::Jet;
use super::lift::Lift;
use super::{Cam, Joint, Segment};
use crate::elementary;
use crate::tolerance;

/// The side of a corner: the segment before it or the one after.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// Side of a corner: the segment before it or the one after.
    Minus,
    /// After the corner: `c''+`, the limit from `t > 0`.
    Plus,
}

named!(Side);

/// Point of the cam where a derivative of the lift jumps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Cam angle, rad, in `[0, 2 pi)`.
    pub angle: f64,
    /// Index of the segment that starts at the corner.
    pub segment: usize,
    /// Order of the lowest derivative that jumps: 1 velocity, 2 acceleration, 3 jerk, and so on.
    pub jump_order: usize,
    /// Jump of that derivative, value after less value before, m/rad^order.
    pub jump: f64,
    /// Lift and derivatives in the limit from before.
    pub minus: Lift,
    /// Lift and derivatives in the limit from after.
    pub plus: Lift,
}

document!(Corner as it {
    cam_angle_rad: it.angle,
    angle_deg: it.angle.to_degrees(),
    jump_order: it.jump_order,
    jump: it.jump,
    lift_m: it.plus.value,
    slope_before: it.minus.slope,
    slope_after: it.plus.slope,
    curvature_before: it.minus.curvature,
    curvature_after: it.plus.curvature,
});

impl Corner {
    /// Lift and derivatives at the corner on one side.
    pub fn lift(&self, side: Side) -> Lift {
        if side == Side::Minus { self.minus } else { self.plus }
    }
}

impl Cam {
    /// Corners in order of angle, for jumps of any order.
    pub fn corners(&self) -> &[Corner] {
        &self.corners
    }

    pub(super) fn meetings(&self) -> Vec<Corner> {
        let meetings = (0..self.segments().len()).map(|after| (self.before(after), after));
        meetings.filter_map(|(before, after)| self.corner(before, after)).collect()
    }

    fn corner(&self, before: usize, after: usize) -> Option<Corner> {
        let (before, next) = (&self.segments()[before], &self.segments()[after]);
        // A law that continues past 2 pi is smooth there.
        if after == 0 && before.law.turned(-TAU) == next.law {
            return None;
        }
        let (minus, plus) = (before.law.jet(before.end), next.law.jet(next.start));
        let jump = |order: usize| plus.0[order] - minus.0[order];
        let jump_order = match self.joint() {
            // Two different pieces of a spline differ at least in the highest power, however little.
            Joint::Spline { degree, breaks } => {
                let broken = breaks.iter().find(|(angle, _)| *angle == next.start);
                let order = broken.map_or(*degree, |(_, order)| *order);
                (jump(order) != 0.0).then_some(order)?
            }
            Joint::Listed { corners, .. } => {
                let listed = corners.binary_search_by(|(angle, _)| angle.total_cmp(&next.start)).ok()?;
                let order = corners[listed].1;
                (jump(order) != 0.0).then_some(order)?
            }
            Joint::Free | Joint::Continued { .. } => {
                let (minus_size, plus_size) = (sizes(before), sizes(next));
                let size = |order: usize| minus_size[order].max(plus_size[order]);
                let (minus_terms, plus_terms) = (before.law.terms(before.end), next.law.terms(next.start));
                let terms = |order: usize| minus_terms.0[order].abs().max(plus_terms.0[order].abs());
                (1..=Jet::HIGHEST_JUMP).find(|order| {
                    let rounding = tolerance::JET_ROUNDING.value * (size(order + 1) + terms(*order));
                    jump(*order).abs() > tolerance::CAM_JUMP.value * size(*order) + rounding
                })?
            }
        };
        Some(Corner {
            angle: next.start,
            segment: after,
            jump_order,
            jump: jump(jump_order),
            minus: before.law.lift(before.end),
            plus: next.law.lift(next.start),
        })
    }

    /// Returns the cam with the law of one side of `corner` continued past it by `reach`, rad.
    ///
    /// At angle 0 the continued part is a separate segment: the last law turned back by a revolution, or the first law turned forward.
    /// `None` if the neighbouring segment is shorter than twice `reach`, or the law is not defined that far.
    pub fn continued(&self, corner: &Corner, side: Side, reach: f64) -> Option<Self> {
        let mut segments = self.segments().to_vec();
        let (before, after) = (self.before(corner.segment), corner.segment);
        let shortened = match side {
            Side::Minus => &segments[after],
            Side::Plus => &segments[before],
        };
        if !(shortened.end - shortened.start >= 2.0 * reach) {
            return None;
        }
        let remade = |segment: &Segment, start: f64, end: f64| Segment::new(start, end, segment.law.clone(), 1);
        let up_to = match (side, after) {
            (Side::Minus, _) => corner.angle + reach,
            (Side::Plus, 0) => TAU - reach,
            (Side::Plus, _) => corner.angle - reach,
        };
        match (side, after) {
            (Side::Minus, 0) => {
                let law = segments[before].law.turned(-TAU);
                segments[after] = remade(&segments[after], up_to, segments[after].end);
                segments.insert(0, Segment::new(0.0, up_to, law, 1));
            }
            (Side::Plus, 0) => {
                let law = segments[after].law.turned(TAU);
                segments[before] = remade(&segments[before], segments[before].start, up_to);
                segments.push(Segment::new(up_to, TAU, law, 1));
            }
            _ => {
                segments[before] = remade(&segments[before], segments[before].start, up_to);
                segments[after] = remade(&segments[after], up_to, segments[after].end);
            }
        }
        let reaches = |segment: &Segment| segment.law.third_bound(segment.start, segment.end).is_finite();
        segments.iter().all(reaches).then(|| Self::joined(segments, Joint::Continued { up_to }))
    }
}

impl Segment {
    /// Order of the lowest derivative that is not 0 at an extremum of the lift, rad; `None` if the lift is constant up to rounding.
    ///
    /// If derivatives up to n - 1 vanish, the extremum is found to about the nth root of the lift's rounding, and at that distance lower
    /// derivatives are not 0. Therefore an order counts only if two conditions are met. Within a radian its Taylor term must exceed
    /// rounding, and there the higher terms must be below rounding:
    ///
    /// ```text
    /// d = (rounding / |c_n|)^(1/n) <= 1,    |c_m| d^m <= rounding for m > n,    c_n = c^(n) / n!
    /// ```
    #[doc(hidden)]
    pub fn order_at(&self, angle: f64) -> Option<usize> {
        let rounding = tolerance::RANGE_ROUNDING.value * sizes(self)[0];
        let mut factorial = 1.0;
        let taylor = self.law.jet(angle).0.into_iter().enumerate().map(|(order, derivative)| {
            factorial *= order.max(1) as f64;
            derivative.abs() / factorial
        });
        let taylor: Vec<f64> = taylor.collect();
        (2..=Jet::HIGHEST_JUMP).find(|order| {
            let seen = elementary::powf(rounding / taylor[*order], 1.0 / *order as f64);
            let mut higher = taylor.iter().enumerate().skip(order + 1);
            seen <= 1.0 && higher.all(|(m, term)| term * seen.powi(m as i32) <= rounding)
        })
    }
}

/// Largest derivative of each order over a segment, from eight samples: zeros at regular distances do not hide all of it.
fn sizes(segment: &Segment) -> [f64; Jet::ORDERS] {
    const SAMPLES: usize = 8;
    let mut sizes = [0.0_f64; Jet::ORDERS];
    for sample in 0..SAMPLES {
        let part = sample as f64 / (SAMPLES as f64 - 1.0);
        let jet = segment.law.jet(segment.start + part * (segment.end - segment.start));
        for (size, derivative) in sizes.iter_mut().zip(jet.0) {
            *size = size.max(derivative.abs());
        }
    }
    sizes
}
