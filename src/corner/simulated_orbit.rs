//! Computes (x*, T*) from the simulator alone, by Newton's method on the condition that a run returns to its start with the impact on the
//! corner.

use nalgebra::{Matrix3, Vector2, Vector3};

use super::corner_impact::CornerImpact;
use super::one_sided::{OneSidedMap, SampleError};
use crate::cam::{Cam, Side};
use crate::model::Model;

/// Returns x* (m from the equilibrium, m/s) and T* (s), by Newton's method from a start that is off by half a unit of each scale.
pub fn orbit(model: &Model, cam: &Cam, at: &CornerImpact) -> Result<(Vector2<f64>, f64), SampleError> {
    let map = OneSidedMap::new(model, cam, at, Side::Minus)?;
    let scales = map.scales();
    // Unknowns and equations in units of the scales: the deviation of state and period, and the miss of the start and of the corner.
    let miss = |z: Vector3<f64>| {
        let perturbation = z.component_mul(&scales);
        let sample = map.sample(perturbation)?;
        let state = (sample.end - perturbation.xy()).component_div(&scales.xy());
        Ok(Vector3::new(state[0], state[1], sample.past_corner))
    };
    let mut z = Vector3::repeat(0.5);
    // Differences over a small part of a scale give the slope to five digits, so that each step gains five digits.
    const STEP: f64 = 1e-3;
    for _ in 0..8 {
        let mut jacobian = Matrix3::zeros();
        for direction in 0..3 {
            let mut step = Vector3::zeros();
            step[direction] = STEP;
            jacobian.set_column(direction, &((miss(z + step)? - miss(z - step)?) / (2.0 * STEP)));
        }
        let correction = jacobian.lu().solve(&miss(z)?).ok_or(SampleError::Singular { what: "orbit" })?;
        z -= correction;
    }
    let deviation = z.component_mul(&scales);
    Ok((at.x_star() + deviation.xy(), at.period + deviation[2]))
}
