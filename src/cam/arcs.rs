//! Appendix A of the paper: a cam of three circles that touch, seen from its axis.
//!
//! The base circle (radius rho0) carries into the flank circle (rho1) at R, the flank into the nose circle (rho2) at P,
//! the nose into the top dwell (rho3) at Q; the second half mirrors the first. The paper gives kappa1, kappa2, P and rho3
//! as separate constants; here they follow from tangency: `kappa1 = rho1 - rho0`, `|O1 O2| = rho1 - rho2`,
//! `rho3 = kappa2 + rho2`.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::{Cam, Law, Lift};
use crate::model::{ArcsProfile, Model, ModelError};

/// A circle whose centre lies at polar `(distance, direction)` from the cam's axis, met by the ray at angle theta:
/// `c = kappa cos(phi) + sqrt(rho^2 - kappa^2 sin^2(phi))`, `phi = theta - direction`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// kappa, m.
    pub distance: f64,
    /// Direction of the centre, rad.
    pub direction: f64,
    /// rho, m.
    pub radius: f64,
}

impl Arc {
    /// `w^2 = rho^2 - kappa^2 sin^2(phi)`, factored so that a ray near tangency keeps its digits.
    fn root_squared(&self, sin: f64) -> f64 {
        (self.radius - self.distance * sin) * (self.radius + self.distance * sin)
    }

    /// Lift and derivatives at `angle`, rad; not a number where the ray misses the circle.
    pub fn lift(&self, angle: f64) -> Lift {
        let (sin, cos) = (angle - self.direction).sin_cos();
        let kappa = self.distance;
        // w = sqrt(rho^2 - kappa^2 sin^2 phi); u = w^2, u' = -kappa^2 sin 2 phi, u'' = -2 kappa^2 cos 2 phi, u''' = -4 u'
        let w = self.root_squared(sin).sqrt();
        let u1 = -kappa * kappa * 2.0 * sin * cos;
        let u2 = -2.0 * kappa * kappa * (cos - sin) * (cos + sin);
        let u3 = -4.0 * u1;
        Lift {
            value: kappa * cos + w,
            // c' = -kappa sin phi + u'/(2 w)
            slope: -kappa * sin + u1 / (2.0 * w),
            // c'' = -kappa cos phi + u''/(2 w) - u'^2/(4 w^3)
            curvature: -kappa * cos + u2 / (2.0 * w) - u1 * u1 / (4.0 * w.powi(3)),
            // c''' = kappa sin phi + u'''/(2 w) - 3 u' u''/(4 w^3) + 3 u'^3/(8 w^5)
            third: kappa * sin + u3 / (2.0 * w) - 3.0 * u1 * u2 / (4.0 * w.powi(3))
                + 3.0 * u1.powi(3) / (8.0 * w.powi(5)),
        }
    }

    /// `c(from + turn) - c(from)`, m, exact as `turn` goes to 0.
    pub fn rise(&self, from: f64, turn: f64) -> f64 {
        let phi = from - self.direction;
        let kappa = self.distance;
        // cos(phi + d) - cos phi = -2 sin(phi + d/2) sin(d/2)
        let shift = -2.0 * kappa * (phi + 0.5 * turn).sin() * (0.5 * turn).sin();
        // w1 - w0 = (u1 - u0)/(w1 + w0),  u1 - u0 = -kappa^2 sin(2 phi + d) sin d
        let difference = -kappa * kappa * (2.0 * phi + turn).sin() * turn.sin();
        let (w0, w1) = (self.root_squared(phi.sin()).sqrt(), self.root_squared((phi + turn).sin()).sqrt());
        shift + difference / (w0 + w1)
    }

    /// A bound on `|c'''|` over `[start, end]`: the formula of [`Arc::lift`] with each factor at its largest.
    pub fn third_bound(&self, start: f64, end: f64) -> f64 {
        let (start, end) = (start - self.direction, end - self.direction);
        let kappa = self.distance.abs();
        let sin = largest_sine(start, end);
        let double_sine = largest_sine(2.0 * start, 2.0 * end);
        let double_cosine = largest_sine(2.0 * start + FRAC_PI_2, 2.0 * end + FRAC_PI_2);
        let w = self.root_squared(sin).sqrt();
        if w.is_nan() || w <= 0.0 {
            return f64::INFINITY;
        }
        let u1 = kappa * kappa * double_sine;
        let u2 = 2.0 * kappa * kappa * double_cosine;
        let u3 = 4.0 * u1;
        kappa * sin + u3 / (2.0 * w) + 3.0 * u1 * u2 / (4.0 * w.powi(3)) + 3.0 * u1.powi(3) / (8.0 * w.powi(5))
    }

    /// The same arc in the mirror theta -> 2 pi - theta.
    fn mirrored(self) -> Self {
        Self { direction: TAU - self.direction, ..self }
    }
}

/// The largest `|sin|` over `[start, end]`.
fn largest_sine(start: f64, end: f64) -> f64 {
    // |sin| peaks at pi/2 + n pi.
    let next_peak = ((start - FRAC_PI_2) / PI).ceil() * PI + FRAC_PI_2;
    if next_peak <= end { 1.0 } else { start.sin().abs().max(end.sin().abs()) }
}

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
    let (span_sin, span_cos) = (nose_end - flank_start).sin_cos();
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
    let meeting = flank_start + y.atan2(x);
    let flank = Arc { distance: flank_distance, direction: flank_start + PI, radius: flank_radius };
    let nose = Arc { distance: nose_distance, direction: nose_end, radius: nose_radius };
    let base = Law::Dwell(base_radius);
    // P's outward normal leans towards R from Q's, so P lies between them and every ray leaves both circles outwards.
    Ok(Cam::from_laws(vec![
        (0.0, base),
        (flank_start, Law::Arc(flank)),
        (meeting, Law::Arc(nose)),
        (nose_end, Law::Dwell(nose_distance + nose_radius)),
        (TAU - nose_end, Law::Arc(nose.mirrored())),
        (TAU - meeting, Law::Arc(flank.mirrored())),
        (TAU - flank_start, base),
    ]))
}
