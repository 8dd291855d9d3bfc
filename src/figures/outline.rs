//! The cam as a shape, seen along its axis when it is at angle 0: the follower stands on it straight above the axis.
//!
//! The paper's follower touches the cam on the ray from the axis along which it moves, so the outline is the lift as a
//! radius: at angle `theta` of the cam the point `c(theta) (sin theta, cos theta)` comes up, and the cam turns to the left.

use std::f64::consts::TAU;

use crate::cam::{Arc, Cam, Law};

/// Samples of a whole turn.
const SAMPLES: f64 = 1440.0;

/// A cam as a shape; lengths in m, from the axis, the follower's direction up.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// What is added to the lift, m: a lift that is no distance from the axis is drawn around a circle of this radius.
    pub added: f64,
    /// The outline, segment by segment.
    pub pieces: Vec<Piece>,
    /// Cam angle, rad, and place of each corner.
    pub corners: Vec<(f64, [f64; 2])>,
}

/// A segment of the outline.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The name of its law.
    pub law: &'static str,
    /// Its mean lift, m.
    pub lift: f64,
    /// `[x, y]`, one after another.
    pub points: Vec<[f64; 2]>,
    /// The centre of its circle, where it is part of one that is not about the axis.
    pub centre: Option<[f64; 2]>,
}

/// The place of a radius at a cam angle, rad.
fn place(angle: f64, radius: f64) -> [f64; 2] {
    [radius * angle.sin(), radius * angle.cos()]
}

impl Outline {
    /// The outline of a cam.
    pub fn new(cam: &Cam) -> Self {
        let lifts = cam.segments().iter().map(|segment| segment.bounds.lift);
        let [low, high] = lifts
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [least, most]| [low.min(least), high.max(most)]);
        let stroke = high - low;
        // A radius that the lift would turn inside out, or to a needle, is none.
        let added = if low >= stroke { 0.0 } else { 2.0 * stroke - low };
        let piece = |segment: &crate::cam::Segment| {
            let steps = ((segment.end - segment.start) / TAU * SAMPLES).ceil().max(2.0);
            let angle = |step: f64| segment.start + (segment.end - segment.start) * step / steps;
            let points = (0..=steps as usize).map(|step| angle(step as f64));
            let radius = |angle: f64| added + segment.law.lift(angle).value;
            let centre = match &segment.law {
                Law::Arc(Arc { distance, direction, .. }) if added == 0.0 => Some(place(*direction, *distance)),
                _ => None,
            };
            Piece {
                law: segment.law.name(),
                lift: 0.5 * (segment.bounds.lift[0] + segment.bounds.lift[1]),
                points: points.map(|angle| place(angle, radius(angle))).collect(),
                centre,
            }
        };
        let corner = |corner: &crate::cam::Corner| (corner.angle, place(corner.angle, added + corner.plus.value));
        Self {
            added,
            pieces: cam.segments().iter().map(piece).collect(),
            corners: cam.corners().iter().map(corner).collect(),
        }
    }
}
