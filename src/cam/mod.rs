//! The cam: lift against angle in smooth segments, and the corners where they meet.
//!
//! A [`Cam`] is an ordered list of [`Segment`]s that cover `[0, 2 pi]`. Each segment's [`Law`] gives lift and derivatives with respect to
//! the angle. A law continues smoothly past its ends, so that a corner has values on both sides and a map can be continued past it. This
//! module does not depend on time or the follower.

mod arc;
mod arcs;
mod bounds;
mod contour;
mod corner_rounding;
mod corner_test;
mod corners;
mod cyclic;
mod envelope;
mod features;
mod fit;
mod harmonics;
mod jet;
mod law;
mod lift;
mod lift_range;
mod minimum;
mod offset_arc;
mod orthonormal;
mod outline;
mod polynomial;
mod profile;
mod program;
mod series;
mod sinusoid;
mod smoothing;
mod table;

use std::f64::consts::TAU;

use crate::interval::Interval;
use crate::model::{Model, ModelError};
use crate::tolerance;
pub use arc::Arc;
pub(crate) use bounds::Bounds;
pub use contour::ContourPoint;
pub use corners::{Corner, Side};
pub use features::Stray;
pub(crate) use features::{spread, strays};
pub(crate) use fit::{Fit, fit, fitted};
pub use harmonics::Harmonics;
pub use jet::Jet;
pub use law::Law;
pub use lift::Lift;
pub use minimum::Least;
pub(crate) use minimum::halved;
pub use offset_arc::OffsetArc;
pub use outline::{Outline, OutlinePiece};
pub use polynomial::Polynomial;
pub use sinusoid::Sinusoid;
pub(crate) use table::build as spline_of_rows;

/// Part of a cam with one lift law.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// Angle of its start, rad.
    pub start: f64,
    /// Angle of its end, rad; above `start`.
    pub end: f64,
    /// Lift law.
    pub law: Law,
    /// Ranges of its lift and derivatives, from samples and bounds.
    pub bounds: Bounds,
    /// Enclosures of its lift and derivatives, in interval arithmetic.
    pub(crate) over: Lift<Interval>,
}

impl Segment {
    /// Largest number of pieces from which the ranges of one segment are computed, and of all segments of a cam together.
    const MOST_PIECES: usize = 256;
    const MOST_PIECES_OF_ALL: usize = 1 << 20;

    /// Segment of a law on `[start, end]`, one of `count` segments.
    fn new(start: f64, end: f64, law: Law, count: usize) -> Self {
        let most = Self::MOST_PIECES.min(Self::MOST_PIECES_OF_ALL / count.max(1)).max(1);
        let bounds = Bounds::new(&law, start, end, most);
        let over = law.lift_over(Interval::new(start, end));
        Self { start, end, law, bounds, over }
    }

    /// Range of its angles, rad.
    pub(crate) fn angles(&self) -> Interval {
        Interval::new(self.start, self.end)
    }
}

document!(Segment as it {
    start_deg: it.start.to_degrees(),
    end_deg: it.end.to_degrees(),
    law: it.law.name(),
    lift_m: it.extremes(),
});

/// Prior knowledge of how segments meet.
#[derive(Clone, Debug, PartialEq)]
enum Joint {
    /// No prior knowledge: the laws decide.
    Free,
    /// Pieces of a spline: derivatives below `degree` agree by construction, except at `breaks` (angle, rad, and order of the derivative
    /// that jumps).
    Spline { degree: usize, breaks: std::sync::Arc<[(f64, usize)]> },
    /// Pieces with known corners: angle, rad, rising, and order of the derivative that jumps. Jumps of order `degree` and above are knots.
    Listed { degree: usize, corners: std::sync::Arc<[(f64, usize)]> },
    /// Cam on which a law continues past its corner up to this angle, rad, where the next law has another lift.
    Continued { up_to: f64 },
}

/// Returns the angle, rad, turned into `[0, 2 pi)`.
#[doc(hidden)]
pub fn within_a_turn(angle: f64) -> f64 {
    let angle = angle.rem_euclid(TAU);
    // A tiny negative angle rounds up to a whole turn.
    if angle >= TAU { 0.0 } else { angle }
}

/// Turns a law and its start, rad, into `[0, 2 pi)`.
fn within_turn((start, law): (f64, Law)) -> (f64, Law) {
    let inside = within_a_turn(start);
    match ((start - inside) / TAU).round() * TAU {
        // A law that starts at the end of the turn has no length; one that starts a rounding error below 0 starts at 0.
        _ if start == TAU => (start, law),
        turns if turns == 0.0 || inside == 0.0 && start < 0.0 => (inside, law),
        turns => (inside, law.turned(-turns)),
    }
}

/// Returns the angle between two angles, rad, the shorter way round.
#[doc(hidden)]
pub fn apart(one: f64, two: f64) -> f64 {
    let turned = (one - two).rem_euclid(TAU);
    turned.min(TAU - turned)
}

/// Returns the angle plus the whole turns that bring it nearest to another angle, rad.
#[doc(hidden)]
pub fn nearest_turn(angle: f64, other: f64) -> f64 {
    angle - ((angle - other) / TAU).round() * TAU
}

/// A periodic lift profile; clones share its data.
#[derive(Clone, Debug, PartialEq)]
pub struct Cam {
    segments: std::sync::Arc<Vec<Segment>>,
    joint: Joint,
    corners: std::sync::Arc<Vec<Corner>>,
}

impl Cam {
    /// Builds a cam from laws with the angles where they start, in order. Each ends where the next starts; the last continues to the start
    /// of the first.
    fn from_laws(mut laws: Vec<(f64, Law)>, joint: Joint) -> Self {
        let first = laws.first().map_or(0.0, |(start, _)| *start);
        if let Some((_, last)) = laws.last().filter(|_| first > 0.0) {
            laws.insert(0, (0.0, last.turned(-TAU)));
        }
        let ends: Vec<f64> = laws.iter().skip(1).map(|(start, _)| *start).chain([TAU]).collect();
        let count = laws.len();
        let segments = laws.into_iter().zip(ends).filter(|((start, _), end)| start < end);
        let segments = segments.map(|((start, law), end)| Segment::new(start, end, law, count)).collect();
        Self::joined(segments, joint)
    }

    /// Builds a cam from segments that cover `[0, 2 pi]`.
    fn joined(segments: Vec<Segment>, joint: Joint) -> Self {
        let mut cam = Self { segments: std::sync::Arc::new(segments), joint, corners: std::sync::Arc::default() };
        // Computed once: searches need the corners at each guess, and a table has many.
        cam.corners = std::sync::Arc::new(cam.meetings());
        cam
    }

    /// Returns the cam behind a lever: every lift is multiplied by the ratio.
    #[doc(hidden)]
    pub fn levered(&self, ratio: f64) -> Self {
        if ratio == 1.0 {
            return self.clone();
        }
        let count = self.segments.len();
        let segment = |it: &Segment| Segment::new(it.start, it.end, it.law.times(ratio), count);
        Self::joined(self.segments.iter().map(segment).collect(), self.joint.clone())
    }

    /// Whether a corner is a knot: a point where two pieces of a spline meet, which is not a feature of the measured cam.
    pub fn is_knot(&self, corner: &Corner) -> bool {
        matches!(self.joint, Joint::Spline { degree, .. } | Joint::Listed { degree, .. } if corner.jump_order >= degree)
    }

    /// Whether a segment begins where a continued law ends. The two lifts there count as different, however close they are.
    pub(crate) fn ends_a_continued_law(&self, segment: &Segment) -> bool {
        matches!(self.joint, Joint::Continued { up_to } if up_to == segment.start)
    }

    fn joint(&self) -> &Joint {
        &self.joint
    }

    /// Index of the segment before another, cyclically.
    pub fn before(&self, segment: usize) -> usize {
        (segment + self.segments.len() - 1) % self.segments.len()
    }

    /// Returns the cam, or an error if its lift jumps; `place` names the model and the field that begins a segment.
    fn without_steps<'a>(self, place: impl Fn(usize) -> (&'a Model, String)) -> Result<Self, ModelError> {
        let largest =
            self.segments.iter().map(|segment| segment.bounds.lift[0].abs().max(segment.bounds.lift[1].abs()));
        let largest = largest.fold(0.0, f64::max);
        for after in 0..self.segments.len() {
            let (before, after_it) = (&self.segments[self.before(after)], &self.segments[after]);
            let (minus, plus) = (before.law.lift(before.end).value, after_it.law.lift(after_it.start).value);
            if !((plus - minus).abs() <= tolerance::CAM_CLOSURE.value * largest) {
                let (model, field) = place(after);
                let angle = after_it.start.to_degrees();
                let words = format!("makes the lift jump from {minus} to {plus} at {angle} degrees");
                return Err(model.reject(&field, words));
            }
        }
        Ok(self)
    }

    /// The segments, in order of angle.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// Upper bound on the lift, m.
    pub fn top(&self) -> f64 {
        self.segments.iter().fold(f64::NEG_INFINITY, |top, segment| top.max(segment.bounds.lift[1]))
    }

    /// The index of the segment that contains `angle`, rad, in `[0, 2 pi)`.
    pub fn segment_at(&self, angle: f64) -> usize {
        // The guess is right if all segments are equally long, as in a table.
        let guess = (angle / TAU * self.segments.len() as f64) as usize;
        if self.segments.get(guess).is_some_and(|segment| segment.start <= angle && angle < segment.end) {
            return guess;
        }
        self.segments.partition_point(|segment| segment.end <= angle).min(self.segments.len() - 1)
    }

    /// Lift and derivatives at `angle`, rad, in `[0, 2 pi)`; at a corner, of the segment after it.
    pub fn lift(&self, angle: f64) -> Lift {
        self.segments[self.segment_at(angle)].law.lift(angle)
    }
}
