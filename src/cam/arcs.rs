//! Appendix A of the paper: a cam of three circles that touch, seen from its axis.
//!
//! The base circle (radius rho0) carries into the flank circle (rho1) at R, the flank into the nose circle (rho2) at P,
//! the nose into the top dwell (rho3) at Q; the second half mirrors the first. The paper gives kappa1, kappa2, P and rho3
//! as separate constants; here they follow from tangency: `kappa1 = rho1 - rho0`, `|O1 O2| = rho1 - rho2`,
//! `rho3 = kappa2 + rho2`.

use std::f64::consts::{PI, TAU};

use super::arc::Arc;
use super::law::Law;
use super::{Cam, Joint};
use crate::elementary;
use crate::model::{ArcsProfile, Model, ModelError};

/// The cam of an `arcs` profile, or which field keeps its circles from touching.
pub(super) fn build(model: &Model, profile: &ArcsProfile) -> Result<Cam, ModelError> {
    let ArcsProfile { base_radius, flank_radius, nose_radius, flank_start_deg, nose_end_deg } = *profile;
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
        // rho2 = rho0 puts O2 on the axis; past a right angle the circles part where O1 O2 is square to the ray at Q.
        let largest = if span_cos > 0.0 { base_radius } else { flank_radius - flank_distance * span_sin };
        let words = format!(
            "must be below {largest} for the nose circle to touch the flank circle and end at cam.nose_end_deg"
        );
        return Err(model.reject("cam.nose_radius", words));
    }
    // P = O1 + rho1 (O2 - O1)/|O2 - O1|, in axes turned so that R is at angle 0.
    let (nose_x, nose_y) = (nose_distance * span_cos, nose_distance * span_sin);
    let stretch = flank_radius / centres;
    let (x, y) = (stretch * (nose_x + flank_distance) - flank_distance, stretch * nose_y);
    let meeting = flank_start + elementary::atan2(y, x);
    let flank = Arc { distance: flank_distance, direction: flank_start + PI, radius: flank_radius };
    let nose = Arc { distance: nose_distance, direction: nose_end, radius: nose_radius };
    let base = Law::Dwell(base_radius);
    // P's outward normal leans towards R from Q's, so P lies between them and every ray leaves both circles outwards.
    let laws = vec![
        (0.0, base.clone()),
        (flank_start, Law::Arc(flank)),
        (meeting, Law::Arc(nose)),
        (nose_end, Law::Dwell(nose_distance + nose_radius)),
        (TAU - nose_end, Law::Arc(nose.mirrored())),
        (TAU - meeting, Law::Arc(flank.mirrored())),
        (TAU - flank_start, base),
    ];
    Ok(Cam::from_laws(laws, Joint::Free))
}
