//! The cam: lift against angle in smooth segments, and the corners where they meet.
//!
//! A [`Cam`] is an ordered list of [`Segment`]s that cover `[0, 2 pi]`. Each segment's [`Law`] gives lift and
//! derivatives with respect to the angle, and goes on smoothly past its ends, so that a corner has values on both
//! sides and a map can be continued past it. Nothing here knows time or the follower.

mod arcs;

use std::f64::consts::TAU;

use crate::model::{CamProfile, Model, ModelError};
use crate::tolerance;
pub use arcs::Arc;

/// Lift and its derivatives with respect to the cam angle: m, m/rad, m/rad^2, m/rad^3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lift {
    /// c(theta), m.
    pub value: f64,
    /// dc/dtheta, m/rad.
    pub slope: f64,
    /// d^2c/dtheta^2, m/rad^2.
    pub curvature: f64,
    /// d^3c/dtheta^3, m/rad^3.
    pub third: f64,
}

impl Lift {
    fn derivatives(self) -> [f64; 4] {
        [self.value, self.slope, self.curvature, self.third]
    }
}

/// A smooth lift law, valid on its segment and some way past its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Constant lift, m.
    Dwell(f64),
    /// A circle seen from the cam's axis.
    Arc(Arc),
}

impl Law {
    /// Lift and derivatives at `angle`, rad.
    pub fn lift(&self, angle: f64) -> Lift {
        match self {
            Self::Dwell(value) => Lift { value: *value, slope: 0.0, curvature: 0.0, third: 0.0 },
            Self::Arc(arc) => arc.lift(angle),
        }
    }

    /// `c(from + turn) - c(from)` without cancellation, m.
    pub fn rise(&self, from: f64, turn: f64) -> f64 {
        match self {
            Self::Dwell(_) => 0.0,
            Self::Arc(arc) => arc.rise(from, turn),
        }
    }

    /// A bound on `|d^3c/dtheta^3|` over `[start, end]`, m/rad^3; infinite where the law does not reach.
    pub fn third_bound(&self, start: f64, end: f64) -> f64 {
        match self {
            Self::Dwell(_) => 0.0,
            Self::Arc(arc) => arc.third_bound(start, end),
        }
    }
}

/// A stretch of cam with one law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Where it starts, rad.
    pub start: f64,
    /// Where it ends, rad; above `start`.
    pub end: f64,
    /// Its lift.
    pub law: Law,
    /// Ranges over it.
    pub bounds: Bounds,
}

/// Ranges (low, high) that hold over a whole segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// m.
    pub lift: [f64; 2],
    /// m/rad.
    pub slope: [f64; 2],
    /// m/rad^2.
    pub curvature: [f64; 2],
    /// m/rad^3, of the size.
    pub third: f64,
}

impl Bounds {
    fn new(law: &Law, start: f64, end: f64) -> Self {
        let n = 256;
        let h = (end - start) / n as f64;
        let mut b = Self {
            lift: [f64::INFINITY, f64::NEG_INFINITY],
            slope: [f64::INFINITY, f64::NEG_INFINITY],
            curvature: [f64::INFINITY, f64::NEG_INFINITY],
            third: 0.0,
        };
        for i in 0..n {
            let a = start + h * i as f64;
            let t = law.third_bound(a, a + h);
            b.third = b.third.max(t);
            let l = law.lift(a + 0.5 * h);
            let c = l.curvature.abs() + t * h;
            let s = l.slope.abs() + c * h;
            let w = |r: &mut [f64; 2], v: f64, e: f64| *r = [r[0].min(v - e), r[1].max(v + e)];
            w(&mut b.curvature, l.curvature, t * h * 0.5);
            w(&mut b.slope, l.slope, c * h * 0.5);
            w(&mut b.lift, l.value, s * h * 0.5);
        }
        b
    }
}

/// The side of a corner: the segment before it or the one after.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Before the corner: `c''-`, the limit from `t < 0`.
    Minus,
    /// After the corner: `c''+`, the limit from `t > 0`.
    Plus,
}

/// A point of the cam where a derivative of the lift jumps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Cam angle, rad, in `[0, 2 pi)`.
    pub angle: f64,
    /// Index of the segment that starts there.
    pub segment: usize,
    /// The lowest derivative that jumps: 1 velocity, 2 acceleration, 3 jerk.
    pub jump_order: usize,
    /// Lift and derivatives in the limit from before.
    pub minus: Lift,
    /// Lift and derivatives in the limit from after.
    pub plus: Lift,
}

/// A periodic lift profile.
#[derive(Clone, Debug, PartialEq)]
pub struct Cam {
    segments: Vec<Segment>,
}

impl Cam {
    /// The cam of a model, or the complaint about the field that makes it impossible.
    pub fn new(model: &Model) -> Result<Self, ModelError> {
        match &model.cam {
            CamProfile::Arcs(profile) => arcs::build(model, profile),
        }
    }

    /// From laws with the angles where they start; each ends where the next starts, the last at 2 pi.
    fn from_laws(laws: Vec<(f64, Law)>) -> Self {
        let ends: Vec<f64> = laws.iter().skip(1).map(|(start, _)| *start).chain([TAU]).collect();
        let segments = laws.into_iter().zip(ends).filter(|((start, _), end)| start < end);
        Self {
            segments: segments
                .map(|((start, law), end)| Segment { start, end, law, bounds: Bounds::new(&law, start, end) })
                .collect(),
        }
    }

    /// The segments, in order of angle.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// The index of the segment that holds `angle`, rad, in `[0, 2 pi)`.
    pub fn segment_at(&self, angle: f64) -> usize {
        self.segments.partition_point(|segment| segment.end <= angle).min(self.segments.len() - 1)
    }

    /// Lift and derivatives at `angle`, rad, in `[0, 2 pi)`; at a corner, those after it.
    pub fn lift(&self, angle: f64) -> Lift {
        self.segments[self.segment_at(angle)].law.lift(angle)
    }

    /// No lift is above it, m.
    pub fn top(&self) -> f64 {
        self.segments.iter().fold(f64::NEG_INFINITY, |top, segment| top.max(segment.bounds.lift[1]))
    }

    /// The corners, in order of angle.
    pub fn corners(&self) -> Vec<Corner> {
        let count = self.segments.len();
        let meetings = (0..count).map(|after| (self.segments[(after + count - 1) % count], after));
        meetings
            .filter_map(|(before, after)| {
                let (minus, plus) =
                    (before.law.lift(before.end), self.segments[after].law.lift(self.segments[after].start));
                let scale =
                    minus.derivatives().iter().chain(&plus.derivatives()).fold(0.0_f64, |scale, x| scale.max(x.abs()));
                let jumps = minus.derivatives().into_iter().zip(plus.derivatives());
                let jump_order = jumps.enumerate().position(|(order, (minus, plus))| {
                    order > 0 && (minus - plus).abs() > tolerance::CAM_JUMP.value * scale
                })?;
                Some(Corner { angle: self.segments[after].start, segment: after, jump_order, minus, plus })
            })
            .collect()
    }

    /// The cam with the law of one side of `corner` continued past it by `reach`, rad.
    ///
    /// Refused (`None`) where the neighbour is shorter than twice `reach` or the law ends before.
    pub fn continued(&self, corner: &Corner, side: Side, reach: f64) -> Option<Self> {
        let count = self.segments.len();
        let (before, after) = ((corner.segment + count - 1) % count, corner.segment);
        let mut segments = self.segments.clone();
        let shortened = match side {
            Side::Minus => segments[after],
            Side::Plus => segments[before],
        };
        // The segment before angle 0 ends at 2 pi: continuing it would need a segment that wraps.
        if after == 0 || shortened.end - shortened.start < 2.0 * reach {
            return None;
        }
        let meeting = match side {
            Side::Minus => corner.angle + reach,
            Side::Plus => corner.angle - reach,
        };
        segments[before].end = meeting;
        segments[after].start = meeting;
        for segment in &mut segments {
            segment.bounds = Bounds::new(&segment.law, segment.start, segment.end);
        }
        let reaches = |segment: &Segment| segment.law.third_bound(segment.start, segment.end).is_finite();
        segments.iter().all(reaches).then_some(Self { segments })
    }
}
