//! Contour of a cam, computed from the lift of the follower that touches it.

use super::{Cam, Lift};
use crate::elementary;
use crate::model::{FollowerContact, Model, ModelError};

/// Contact point of the follower on the contour at a cam angle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct ContourPoint {
    /// Cam angle, rad.
    pub cam_angle: f64,
    /// Position on the contour, m: along the follower's motion from the cam's axis, and to the left of it.
    pub place: [f64; 2],
    /// Radius of curvature of the contour, m; negative where it is hollow, infinite where it is straight.
    pub radius: f64,
    /// Angle between the normal of the contour and the follower's motion, rad.
    pub pressure_angle: f64,
}

impl FollowerContact {
    /// Distance of the line of motion from the cam's axis, m, and radius of the roller, m.
    fn line_and_radius(self) -> [f64; 2] {
        match self {
            Self::Point | Self::Flat => [0.0; 2],
            Self::Roller { roller_radius, offset } => [offset, roller_radius],
        }
    }

    /// Refuses a roller that is larger than the cam, whose largest radius is `largest`.
    pub(super) fn fits(self, model: &Model, largest: f64) -> Result<(), ModelError> {
        let [_, radius] = self.line_and_radius();
        if radius <= largest {
            return Ok(());
        }
        let unit = model.units.length.name();
        let words =
            format!("must be at most {largest:.6} {unit}, the largest radius of the cam: a roller is no larger");
        Err(model.reject("cam.contact.roller_radius", words))
    }

    /// Contact point at a cam angle, rad, with this lift.
    ///
    /// The roller's centre, or the point, is at `X = (c, e)` along the motion and to the left of it, and moves on the cam by `X'`:
    ///
    /// ```text
    /// X' = (c' - e, c),   X'' = (c'' - c, 2 c' - e),   rho = |X'|^3/(X' x X'') - a,   tan(alpha) = (c' - e)/c
    /// flat face:   (c, c'),   rho = c + c'',   alpha = 0
    /// ```
    pub fn touches(self, cam_angle: f64, lift: &Lift) -> ContourPoint {
        let Lift { value: c, slope, curvature, .. } = *lift;
        if self == Self::Flat {
            return ContourPoint { cam_angle, place: [c, slope], radius: c + curvature, pressure_angle: 0.0 };
        }
        let [e, a] = self.line_and_radius();
        let along = slope - e;
        let moved = elementary::hypot(along, c);
        let turned = along * (slope + along) - c * (curvature - c);
        ContourPoint {
            cam_angle,
            // The outward normal is (c, e - c')/|X'|.
            place: [c - a * c / moved, e + a * along / moved],
            radius: moved * moved * moved / turned - a,
            pressure_angle: elementary::atan2(along, c),
        }
    }
}

impl Cam {
    /// Contour of a cam that this follower touches, by rising angle; a corner has a point on either side.
    pub fn contour(&self, contact: FollowerContact) -> impl Iterator<Item = ContourPoint> {
        /// Points of a segment, and of all segments of a cam with many segments.
        const POINTS: usize = 360;
        const POINTS_OF_ALL: usize = 24 * POINTS;
        let points = (POINTS_OF_ALL / self.segments().len()).clamp(2, POINTS);
        self.segments().iter().flat_map(move |segment| {
            (0..=points).map(move |point| {
                let angle = segment.start + (segment.end - segment.start) * point as f64 / points as f64;
                contact.touches(angle, &segment.law.lift(angle))
            })
        })
    }
}
