//! Effect of rounding the corners at which the cam's acceleration jumps.

use serde::Serialize;

use super::contact::{Contact, Separation};
use crate::cam::Cam;
use crate::model::{CORNER_ROUNDING, Model};

/// Separation and jerk of the machine with the corners of its cam rounded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rounded {
    /// Angle of the rounding, degrees.
    pub corner_rounding_deg: f64,
    /// Speed at which the follower first leaves the rounded cam, rpm; none if it leaves at every speed or at none.
    pub separation_rpm: Option<f64>,
    /// Largest absolute value of the jerk, m/rad^3.
    pub jerk: f64,
    /// Change of the separation speed over that of the unrounded cam; none if one of them is missing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub separation_change: Option<f64>,
}

/// Rounds the corners over several angles, as far as the cam allows. Returns nothing if the acceleration has no
/// jump, or if the corners are already rounded.
pub(super) fn rounded(model: &Model, cam: &Cam, separation: Separation) -> Vec<Rounded> {
    /// Angles of the rounding, degrees.
    const ANGLES: [f64; 4] = [1.0, 2.0, 5.0, 10.0];
    let jumps = cam.corners().iter().any(|corner| corner.jump_order == 2);
    let at = |angle: f64| {
        let model = model.with_number(CORNER_ROUNDING, angle).ok()?;
        let cam = Cam::new(&model).ok()?;
        let jerk = |sign: f64| -cam.least([0.0, 0.0, 0.0, sign]).value;
        let separation_rpm = Contact::new(&cam, model.follower).separation().at_speed();
        let separation_change = separation_rpm.zip(separation.at_speed()).map(|(rpm, own)| rpm / own - 1.0);
        Some(Rounded { corner_rounding_deg: angle, separation_rpm, jerk: jerk(1.0).max(jerk(-1.0)), separation_change })
    };
    if jumps { ANGLES.into_iter().filter_map(at).collect() } else { Vec::new() }
}
