//! First separation of the follower from the cam, with the uncertainty of the machine.

use std::f64::consts::{PI, TAU};
use std::sync::atomic::{AtomicBool, Ordering};

use serde::Serialize;

use super::contact::{Contact, Separation};
use crate::cam::{Cam, nearest_turn};
use crate::model::Model;
use crate::tolerance;
use crate::uncertainty::{PlausibleMachines, SourcedUncertainty, UncertaintyParts};

/// A place where the follower may leave a measured cam first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SeparationPlace {
    /// Range of cam angles at which the follower separates here on likely cams, rad; its end may be in the next turn.
    #[serde(rename = "cam_angles_rad")]
    pub cam_angles: [f64; 2],
    /// Share of the likely cams on which the follower separates here first.
    pub share: f64,
    /// Number of likely cams that the share refers to.
    pub cams: usize,
}

impl SeparationPlace {
    /// Cam angles of both ends, within a turn, and the width between them, rad.
    pub fn within_a_turn(&self) -> ([f64; 2], f64) {
        let [from, to] = self.cam_angles;
        ([from, if to >= TAU { to - TAU } else { to }], to - from)
    }
}

/// A separation in a document.
#[derive(Serialize)]
pub(super) struct Separated<'a> {
    speed_rpm: f64,
    error_rpm: f64,
    cam_angle_rad: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    error_parts: Option<UncertaintyParts>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cam_angle_error_rad: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cam_angle_error_parts: Option<UncertaintyParts>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    places: &'a [SeparationPlace],
    within_errors: bool,
    located: bool,
}

impl<'a> Separated<'a> {
    /// Builds the separation at a speed, with its uncertainties and the competing places; none if there is no such speed.
    pub fn new(
        separation: Separation,
        errors: Option<[SourcedUncertainty; 2]>,
        places: &'a [SeparationPlace],
    ) -> Option<Self> {
        let Separation::At { rpm, error, cam_angle, angle_error, within_errors } = separation else {
            return None;
        };
        Some(Self {
            speed_rpm: rpm,
            error_rpm: error,
            cam_angle_rad: cam_angle,
            error_parts: errors.map(|[of_speed, _]| UncertaintyParts(of_speed, "_rpm")),
            cam_angle_error_rad: angle_error,
            cam_angle_error_parts: angle_error.and(errors).map(|[_, of_angle]| UncertaintyParts(of_angle, "_rad")),
            places,
            within_errors,
            located: true,
        })
    }
}

/// Adds the uncertainty of the machine to a separation's speed and angle, and returns it by its sources; NaN if it is unknown.
#[doc(hidden)]
pub fn known(
    separation: Separation,
    machines: &PlausibleMachines<'_>,
) -> (Separation, Option<[SourcedUncertainty; 2]>) {
    let (Some(machines), Separation::At { rpm, error, cam_angle, .. }) = (machines.uncertain(), separation) else {
        return (separation, None);
    };
    let row_error = machines.cams.as_ref().map_or(0.0, |cams| cams.measured.row_error());
    let is_within = |model: &Model, contact: &Contact<'_>, angle: f64| {
        contact.static_force(angle) < model.follower.stiffness * model.cam.lever_ratio() * row_error
    };
    let within_errors =
        AtomicBool::new(is_within(machines.model, &Contact::new(machines.cam, machines.model.follower), cam_angle));
    let of = |model: &Model, cam: &Cam| {
        let contact = Contact::new(cam, model.follower);
        let Separation::At { rpm, cam_angle: of_other, .. } = contact.separation() else { return None };
        within_errors.fetch_or(is_within(model, &contact, of_other), Ordering::Relaxed);
        Some([rpm, nearest_turn(of_other, cam_angle)])
    };
    let errors = machines.error([rpm, cam_angle], of).unwrap_or([SourcedUncertainty::UNKNOWN; 2]);
    let [open, angle_error] = errors.map(|error| error.total());
    // At a corner of an exact cam, the angle has no uncertainty.
    let angle_error = Some(angle_error).filter(|error| !(*error <= tolerance::UNCERTAINTY_SEEN.value));
    let within_errors = within_errors.into_inner();
    (Separation::At { rpm, error: error + open, cam_angle, angle_error, within_errors }, Some(errors))
}

/// Returns the places where the follower first separates on likely machines, the likeliest first; none if they agree to 10 degrees.
pub fn separation_places(separation: Separation, machines: &PlausibleMachines<'_>) -> Vec<SeparationPlace> {
    /// Largest uncertainty of the angle of a single place, and largest distance of neighbouring angles of one place, rad.
    const ONE: f64 = PI / 18.0;
    let Separation::At { angle_error: Some(error), .. } = separation else { return Vec::new() };
    if !(error > ONE) {
        return Vec::new();
    }
    let of = |model: &Model, cam: &Cam| match Contact::new(cam, model.follower).separation() {
        Separation::At { cam_angle: of_other, .. } => Some(of_other.rem_euclid(TAU)),
        _ => None,
    };
    let mut angles: Vec<f64> = machines.each(of);
    angles.sort_by(f64::total_cmp);
    // Some angles of a place at angle 0 are at the end of the turn. So the list begins with an angle that is far from the one before it.
    let count = angles.len();
    let is_far = |index: &usize| (angles[*index] - angles[(index + count - 1) % count]).rem_euclid(TAU) > ONE;
    let first = (0..count).find(is_far).unwrap_or(0);
    angles.rotate_left(first);
    let turned = count - first;
    angles.iter_mut().skip(turned).for_each(|angle| *angle += TAU);
    let place = |alike: &[f64]| {
        let from = alike[0].rem_euclid(TAU);
        SeparationPlace {
            cam_angles: [from, from + alike[alike.len() - 1] - alike[0]],
            share: alike.len() as f64 / angles.len() as f64,
            cams: angles.len(),
        }
    };
    let mut places: Vec<SeparationPlace> = angles.chunk_by(|one, two| two - one <= ONE).map(place).collect();
    places.sort_by(|one, two| two.share.total_cmp(&one.share));
    places
}
