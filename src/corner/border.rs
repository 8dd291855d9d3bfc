//! On which side of the corner the impact falls, from the flight that leads to it.

use nalgebra::RowVector2;

use super::corner_impact::CornerImpact;
use super::variational;
use crate::cam::Cam;
use crate::flight::Flight;
use crate::model::Model;

/// `(e, f)`: the impact comes before the corner where `e dx + f dT < 0`.
///
/// `h (phi_{T/2} x - y_0)` is the gap that a flight without impact would have when the corner passes: negative means that
/// the impact has been. Its derivatives are `e = [dq/dq0, dq/dv0]` over half a period, and `f = v/2`, the cam at the corner
/// not depending on T. Where impacts come between the section and the corner, the deviation goes through them first.
pub fn border(model: &Model, cam: &Cam, at: &CornerImpact) -> (RowVector2<f64>, f64) {
    if !at.is_simple() {
        return variational::gap_at_corner(model, cam, at);
    }
    let response = Flight::new(&model.follower).response(0.5 * at.period);
    let omega0_squared = model.follower.stiffness / model.follower.mass;
    // Eq:dti_dxn   e = dH/dx = h phi_{T/2}: dq/dq0 = 1 - w0^2 p,  dq/dv0 = s
    // Eq:dti_dT    f = dH/dT = h phi_{T/2}' x/2 = v/2, both at t_i = 0
    (RowVector2::new(1.0 - omega0_squared * response.step, response.impulse), 0.5 * at.velocity_before)
}
