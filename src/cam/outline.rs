//! Shape of the cam, viewed along its axis at angle 0, with the follower straight above the axis.
//!
//! The outline is the contour that the follower touches; if only a lift is given, the lift as a radius. At cam angle `theta` the ray
//! `(sin theta, cos theta)` is on top; the cam turns to the left.

use std::f64::consts::TAU;

use serde::Serialize;

use super::{Cam, Lift, Segment};
use crate::elementary;
use crate::model::{FollowerContact, Model};

/// Number of samples of a whole turn.
const SAMPLES: f64 = 1440.0;
/// Outline of the cam; lengths in m from the axis, with the follower's direction up.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outline {
    /// Radius added to the lift, m; not 0 if the lift is not a distance from the axis.
    pub added: f64,
    /// Outline, segment by segment.
    pub pieces: Vec<OutlinePiece>,
    /// Cam angle, rad, and position of each corner.
    pub corners: Vec<(f64, [f64; 2])>,
    /// Shape of the follower's end at cam angle 0, as a line.
    pub follower: Vec<[f64; 2]>,
    /// Path of the centre of a roller; empty for other followers.
    pub pitch: Vec<[f64; 2]>,
}

/// Outline of one segment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OutlinePiece {
    /// Points `[x, y]`, in order.
    pub points: Vec<[f64; 2]>,
    /// Centre of the segment's circle; `None` for other curves and for circles about the axis.
    pub centre: Option<[f64; 2]>,
}

/// Point at a radius and a cam angle, rad.
fn place(angle: f64, radius: f64) -> [f64; 2] {
    [radius * elementary::sin(angle), radius * elementary::cos(angle)]
}

/// Point at a distance along the ray of a cam angle, rad, and at a distance across it.
fn beside(angle: f64, [along, across]: [f64; 2]) -> [f64; 2] {
    let [[x, y], [right, down]] = [place(angle, along), place(angle, across)];
    [x + down, y - right]
}

impl Outline {
    /// Computes the outline of a model's cam, at the cam's end of a lever.
    pub fn of(model: &Model, cam: &Cam) -> Self {
        Self::new(&cam.levered(model.cam.lever_ratio().recip()), model.cam.contact())
    }

    /// Computes the outline of a cam for its follower; without a contact, for a point.
    pub fn new(cam: &Cam, contact: Option<FollowerContact>) -> Self {
        let [low, high] = extent(cam.segments().iter().flat_map(|segment| segment.bounds.lift));
        let stroke = high - low;
        let (has_contour, contact) = (contact.is_some(), contact.unwrap_or_default());
        // If the lift alone would turn the outline inside out, or make it a needle, a radius is added.
        let added = if low >= stroke || has_contour { 0.0 } else { 2.0 * stroke - low };
        let at = |angle: f64, lift: &Lift| match contact {
            FollowerContact::Point => place(angle, added + lift.value),
            _ => beside(angle, contact.touches(angle, lift).place),
        };
        let angles = |segment: &Segment| {
            let (start, span) = (segment.start, segment.end - segment.start);
            let steps = (span / TAU * SAMPLES).ceil().max(2.0);
            (0..=steps as usize).map(move |step| start + span * step as f64 / steps)
        };
        let piece = |segment: &Segment| {
            let centre = segment.law.circle_centre().filter(|_| added == 0.0);
            let centre = centre.map(|[distance, direction]| place(direction, distance));
            OutlinePiece { points: angles(segment).map(|angle| at(angle, &segment.law.lift(angle))).collect(), centre }
        };
        let first = cam.lift(0.0).value;
        let (follower, pitch) = match contact {
            FollowerContact::Point => (Vec::new(), Vec::new()),
            FollowerContact::Flat => {
                let [left, right] = extent(cam.segments().iter().flat_map(|segment| segment.bounds.slope));
                (vec![[left, first], [right, first]], Vec::new())
            }
            FollowerContact::Roller { roller_radius, offset } => {
                let circle = (0..=72).map(|part| place(TAU * f64::from(part) / 72.0, roller_radius));
                let centre = |(angle, lift): (f64, Lift)| beside(angle, [lift.value, offset]);
                let lifts = cam.segments().iter().flat_map(|it| angles(it).map(|angle| (angle, it.law.lift(angle))));
                (circle.map(|[x, y]| [x + offset, y + first]).collect(), lifts.map(centre).collect())
            }
        };
        Self {
            added,
            pieces: cam.segments().iter().map(piece).collect(),
            corners: cam.corners().iter().map(|corner| (corner.angle, at(corner.angle, &corner.plus))).collect(),
            follower,
            pitch,
        }
    }

    /// Largest distance of the outline from the axis.
    pub fn farthest(&self) -> f64 {
        let outline = self.pieces.iter().flat_map(|piece| &piece.points);
        outline.chain(&self.follower).chain(&self.pitch).fold(0.0_f64, |far, [x, y]| far.max(elementary::hypot(*x, *y)))
    }
}

/// Lowest and highest of the values.
fn extent(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    values.into_iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
}
