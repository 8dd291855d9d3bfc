//! Ranges that certainly contain a segment's lift and derivatives, from samples and a bound on the third derivative.
//!
//! Between two samples a derivative changes no faster than the next derivative allows. The range of c'' follows from the bound on c''', the
//! range of c' from the range of c'', and the range of c from the range of c'.

use std::f64::consts::TAU;

use super::law::Law;
use crate::tolerance;

/// Ranges over a segment, lowest and highest; infinite where the law is not defined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Range of c, m.
    pub lift: [f64; 2],
    /// Range of c', m/rad.
    pub slope: [f64; 2],
    /// Range of c'', m/rad^2.
    pub curvature: [f64; 2],
    /// Bound on `|c'''|`, m/rad^3.
    pub third: f64,
}

/// Range under construction: the sampled part, and the certain range, which includes values between samples.
#[derive(Clone, Copy)]
struct Range {
    sampled: [f64; 2],
    certain: [f64; 2],
}

impl Range {
    const EMPTY: Self = Self { sampled: NOTHING, certain: NOTHING };

    fn take(&mut self, ends: [f64; 2], certain: [f64; 2]) {
        self.sampled = hull(self.sampled, [ends[0].min(ends[1]), ends[0].max(ends[1])]);
        self.certain = hull(self.certain, certain);
    }

    /// Whether the certain range is only slightly wider than the sampled range.
    fn is_close(&self) -> bool {
        let width = |range: [f64; 2]| range[1] - range[0];
        width(self.certain) <= (1.0 + tolerance::RANGE_WIDTH.value) * width(self.sampled)
    }
}

const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];
const ANYTHING: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

fn hull(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

impl Bounds {
    /// Bounds of `law` over `[start, end]`, from at most `most` pieces.
    pub(super) fn new(law: &Law, start: f64, end: f64, most: usize) -> Self {
        if let Law::Dwell(value) = law {
            return Self { lift: [*value; 2], slope: [0.0; 2], curvature: [0.0; 2], third: 0.0 };
        }
        let mut pieces = 1;
        loop {
            let (bounds, is_close) = Self::from_pieces(law, start, end, pieces);
            if is_close || pieces >= most {
                return bounds;
            }
            pieces *= 2;
        }
    }

    fn from_pieces(law: &Law, start: f64, end: f64, pieces: usize) -> (Self, bool) {
        let width = (end - start) / pieces as f64;
        let [mut lift, mut slope, mut curvature] = [Range::EMPTY; 3];
        let mut third: f64 = 0.0;
        let mut left = law.lift(start);
        for piece in 1..=pieces {
            let low = start + width * (piece - 1) as f64;
            let high = if piece == pieces { end } else { start + width * piece as f64 };
            let right = law.lift(high);
            let bound = law.third_bound(low, high);
            // A bound that is NaN bounds nothing.
            if !bound.is_finite() {
                return (Self { lift: ANYTHING, slope: ANYTHING, curvature: ANYTHING, third: f64::INFINITY }, true);
            }
            let of_curvature = between([left.curvature, right.curvature], [-bound, bound], high - low);
            let of_slope = between([left.slope, right.slope], of_curvature, high - low);
            let of_lift = between([left.value, right.value], of_slope, high - low);
            curvature.take([left.curvature, right.curvature], of_curvature);
            slope.take([left.slope, right.slope], of_slope);
            lift.take([left.value, right.value], of_lift);
            third = third.max(bound);
            left = right;
        }
        let bounds = Self { lift: lift.certain, slope: slope.certain, curvature: curvature.certain, third };
        (bounds.widened(), lift.is_close() && slope.is_close() && curvature.is_close())
    }

    /// Widens the ranges for rounding: a dozen ulps of each quantity, and its change over an ulp of the angle.
    fn widened(self) -> Self {
        let largest = |range: [f64; 2]| range[0].abs().max(range[1].abs());
        let sizes = [largest(self.lift), largest(self.slope), largest(self.curvature), self.third];
        let widen = |range: [f64; 2], order: usize| {
            let room = tolerance::RANGE_ROUNDING.value * (sizes[order] + TAU * sizes[order + 1]);
            [range[0] - room, range[1] + room]
        };
        Self {
            lift: widen(self.lift, 0),
            slope: widen(self.slope, 1),
            curvature: widen(self.curvature, 2),
            third: self.third,
        }
    }
}

/// The range of a quantity between two samples `width` apart whose rate stays within `rates`.
fn between(ends: [f64; 2], rates: [f64; 2], width: f64) -> [f64; 2] {
    let highest = peak(ends, rates, width);
    // The lowest value is the highest of the mirror image.
    let lowest = -peak([-ends[0], -ends[1]], [-rates[1], -rates[0]], width);
    [lowest.min(ends[0]).min(ends[1]), highest.max(ends[0]).max(ends[1])]
}

/// Value at which the fastest rise from the left end meets the fastest fall to the right end.
fn peak(ends: [f64; 2], [slowest, fastest]: [f64; 2], width: f64) -> f64 {
    if slowest >= 0.0 || fastest <= 0.0 {
        return ends[0].max(ends[1]);
    }
    // left + r1 x = right - r0 (h - x)
    let at = (ends[1] - ends[0] - slowest * width) / (fastest - slowest);
    ends[0] + fastest * at.clamp(0.0, width)
}
