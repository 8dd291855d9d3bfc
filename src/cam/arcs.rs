//! Cam of three circles that touch, followed by a point, a roller or a flat face: Appendix A of the paper.
//!
//! The base circle (radius rho0) meets the flank circle (rho1) at R, the flank meets the nose circle (rho2) at P, and the nose meets the
//! top dwell (rho3) at Q. The second half mirrors the first. The paper gives kappa1, kappa2, P and rho3 as separate constants. Here they
//! follow from tangency: `kappa1 = rho1 - rho0`, `|O1 O2| = rho1 - rho2`, `rho3 = kappa2 + rho2`.

use std::f64::consts::{PI, TAU};

use super::arc::Arc;
use super::law::Law;
use super::offset_arc::OffsetArc;
use super::sinusoid::Sinusoid;
use super::{Cam, Joint, within_turn};
use crate::elementary;
use crate::model::{ArcsProfile, FollowerContact, Model, ModelError};

/// Builds the cam of an `arcs` profile; the error names the field that keeps its circles from touching.
pub(super) fn build(model: &Model, profile: &ArcsProfile) -> Result<Cam, ModelError> {
    let ArcsProfile { base_radius, flank_radius, nose_radius, flank_start_deg, nose_end_deg, .. } = *profile;
    if nose_end_deg <= flank_start_deg {
        return Err(model.reject("cam.nose_end_deg", format!("must be above cam.flank_start_deg = {flank_start_deg}")));
    }
    if flank_radius <= base_radius {
        let words = format!(
            "must be above cam.base_radius = {base_radius}: the flank circle touches the base circle from outside it"
        );
        return Err(model.reject("cam.flank_radius", words));
    }
    if nose_radius >= flank_radius {
        let words = format!(
            "must be below cam.flank_radius = {flank_radius}: the nose circle touches the flank circle from inside"
        );
        return Err(model.reject("cam.nose_radius", words));
    }
    let (flank_start, nose_end) = (flank_start_deg.to_radians(), nose_end_deg.to_radians());
    let (span_sin, span_cos) = elementary::sin_cos(nose_end - flank_start);
    // kappa1 = rho1 - rho0 puts O1 opposite R; |O1 O2| = rho1 - rho2 gives kappa2 by the law of cosines.
    let flank_distance = flank_radius - base_radius;
    let centres = flank_radius - nose_radius;
    let root = (centres - flank_distance * span_sin) * (centres + flank_distance * span_sin);
    let nose_distance = root.sqrt() - flank_distance * span_cos;
    if !(root >= 0.0 && nose_distance > 0.0) {
        // rho2 = rho0 puts O2 on the axis; past a right angle the circles separate where O1 O2 is perpendicular to the ray at Q.
        let largest = if span_cos > 0.0 { base_radius } else { flank_radius - flank_distance * span_sin };
        let words = format!(
            "must be below {largest} for the nose circle to touch the flank circle and end at cam.nose_end_deg"
        );
        return Err(model.reject("cam.nose_radius", words));
    }
    let circles = Circles { flank_distance, flank_radius, nose_distance, nose_radius };
    let ends = [flank_start, nose_end];
    profile.contact.fits(model, nose_distance + nose_radius)?;
    match profile.contact {
        FollowerContact::Point => Ok(circles.met_by_point(ends, base_radius, 0.0)),
        FollowerContact::Flat => Ok(circles.met_by_face(ends, base_radius)),
        FollowerContact::Roller { roller_radius, offset } => {
            // The roller's centre moves on the pitch curve: circles about the same centres, a roller's radius larger.
            let pitch = Circles {
                flank_radius: flank_radius + roller_radius,
                nose_radius: nose_radius + roller_radius,
                ..circles
            };
            let base = base_radius + roller_radius;
            if offset.abs() >= base {
                let words = format!("must be between -{base} and {base}, the radius of the pitch curve's base circle");
                return Err(model.reject("cam.contact.offset", words));
            }
            // The pitch curve is convex and contains its base circle: a line that crosses the base circle crosses the curve and is never
            // tangent to it.
            Ok(pitch.met_by_point(ends, base, offset))
        }
    }
}

/// Flank and nose circle, with the distances of their centres from the axis.
struct Circles {
    flank_distance: f64,
    flank_radius: f64,
    nose_distance: f64,
    nose_radius: f64,
}

impl Circles {
    /// Directions, rad, of the centres of the flank and the nose on the way up; they are mirrored on the way down.
    fn directions([flank_start, nose_end]: [f64; 2]) -> [f64; 2] {
        [flank_start + PI, nose_end]
    }

    /// O2 - O1, in axes turned so that R is at angle 0.
    fn between(&self, [flank_start, nose_end]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = elementary::sin_cos(nose_end - flank_start);
        [self.nose_distance * cos + self.flank_distance, self.nose_distance * sin]
    }

    /// Cam of a point that moves on a line at a distance `offset` to the left of the axis and follows these circles.
    fn met_by_point(&self, ends: [f64; 2], base: f64, offset: f64) -> Cam {
        let Self { flank_distance, flank_radius, nose_distance, nose_radius } = *self;
        let [flank_start, nose_end] = ends;
        // P = O1 + rho1 (O2 - O1)/|O2 - O1|
        let [x, y] = self.between(ends);
        let stretch = flank_radius / (flank_radius - nose_radius);
        let (x, y) = (stretch * x - flank_distance, stretch * y);
        let meeting = flank_start + elementary::atan2(y, x);
        let top = nose_distance + nose_radius;
        // Offset turns the cam angle by asin(offset / radius): the point meets that radius earlier.
        let earlier = |radius: f64| elementary::asin(offset / radius);
        let early = [earlier(base), earlier(elementary::hypot(x, y)), earlier(top)];
        let law = |distance: f64, direction: f64, radius: f64| match offset == 0.0 {
            true => Law::Arc(Arc { distance, direction, radius }),
            false => Law::OffsetArc(OffsetArc { distance, direction, radius, offset }),
        };
        let dwell = |radius: f64| match offset == 0.0 {
            true => Law::Dwell(radius),
            false => Law::Dwell(((radius - offset) * (radius + offset)).sqrt()),
        };
        let circles = [(flank_distance, flank_radius), (nose_distance, nose_radius)];
        mirrored(
            [flank_start, meeting, nose_end],
            early,
            [dwell(base), dwell(top)],
            |circle, direction| law(circles[circle].0, direction, circles[circle].1),
            Self::directions(ends),
        )
    }

    /// Cam of a flat face perpendicular to the line of motion: it touches a circle at `kappa cos(phi) + rho` from the axis.
    fn met_by_face(&self, ends: [f64; 2], base: f64) -> Cam {
        let Self { flank_distance, flank_radius, nose_distance, nose_radius } = *self;
        let [flank_start, nose_end] = ends;
        // Flank and nose have a common normal, along the line of centres.
        let [x, y] = self.between(ends);
        let meeting = flank_start + elementary::atan2(y, x);
        let circles = [(flank_distance, flank_radius), (nose_distance, nose_radius)];
        let law = |circle: usize, direction: f64| {
            let (distance, radius) = circles[circle];
            // kappa cos(phi) + rho = kappa + rho - kappa (1 - cos(phi))
            let value = distance + radius;
            Law::Sinusoid(Sinusoid { start: direction, value, tilt: 0.0, sine: 0.0, cosine: -distance, frequency: 1.0 })
        };
        let dwells = [Law::Dwell(base), Law::Dwell(nose_distance + nose_radius)];
        mirrored([flank_start, meeting, nose_end], [0.0; 3], dwells, law, Self::directions(ends))
    }
}

/// Cam of flank, nose, top, nose, flank and base. The contour is its own mirror image: its circles meet at `meetings`, rad, on the way up.
/// The follower reaches each meeting `early` by these angles, rad, on the way up and down.
fn mirrored(
    meetings: [f64; 3],
    early: [f64; 3],
    [base, top]: [Law; 2],
    law: impl Fn(usize, f64) -> Law,
    directions: [f64; 2],
) -> Cam {
    let up = [0, 1, 2].map(|at| meetings[at] - early[at]);
    let down = [2, 1, 0].map(|at| TAU - meetings[at] - early[at]);
    let [flank, nose] = directions;
    let laws = [
        (up[0], law(0, flank)),
        (up[1], law(1, nose)),
        (up[2], top),
        (down[0], law(1, TAU - nose)),
        (down[1], law(0, TAU - flank)),
        (down[2], base),
    ];
    // With an offset, the first law may start before angle 0, or the last after a full turn.
    let mut laws: Vec<(f64, Law)> = laws.into_iter().map(within_turn).collect();
    laws.sort_by(|one, two| one.0.total_cmp(&two.0));
    Cam::from_laws(laws, Joint::Free)
}
