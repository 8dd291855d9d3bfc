//! Departure of a motion from its former periodic orbit, when the speed has just passed the corner impact.
//!
//! Past a nonsmooth fold, neither side of the piecewise-linear map has its fixed point on its own side of the border. Near the border the
//! map still moves little, by an amount proportional to dT. Then the multiplier of A above 1 carries the deviation away. This multiplier
//! exists at dT = 0 already, so the number n of revolutions grows as a logarithm:
//!
//! ```text
//! |dx_n| ~ |dT| lambda^n     n(|dx| = reach) = ln(reach/|dT|)/ln(lambda) + constant
//! ```
//!
//! At a smooth fold the multiplier is 1, and n grows as the root of 1/|dT|.

use nalgebra::Vector2;

use super::LocalMap;
use crate::cam::Side;
use crate::elementary;
use crate::flight::State;
use crate::section::StroboscopicMap;
use crate::simulate::SimulateError;
use crate::tolerance;

/// Number of revolutions from x* until the position on the section is farther than `reach`, m, from x*. It is computed by the
/// piecewise-linear map at a period `dt`, s, longer than T*; `None` if above `most`.
pub fn linear(map: &LocalMap, dt: f64, reach: f64, most: u64) -> Option<u64> {
    let mut deviation = Vector2::zeros();
    (1..=most).find(|_| {
        deviation = map.apply(deviation, dt);
        deviation[0].abs() > reach
    })
}

/// Number of revolutions until the position is farther than `reach`, m, from `start`, the state x* on the section, by simulation.
pub fn simulated(map: &StroboscopicMap, start: State, reach: f64, most: u64) -> Result<Option<u64>, SimulateError> {
    let mut motion = map.machine.start(map.cam_angle, start)?;
    for revolution in 1..=most {
        map.machine.revolve(&mut motion, 1)?;
        if (motion.state.position - start.position).abs() > reach {
            return Ok(Some(revolution));
        }
    }
    Ok(None)
}

/// Number of revolutions added per factor of ten less in |dT|: `ln 10/ln lambda`, with the multiplier lambda above 1 of the side on which
/// the deviation grows. `None` if neither side has such a multiplier, or both have one.
pub fn revolutions_per_decade(map: &LocalMap) -> Option<f64> {
    let above = |side: Side| {
        let [first, _] = map.of(side).eigenvalues();
        (first.im == 0.0 && first.re > 1.0).then_some(first.re)
    };
    let multiplier = match (above(Side::Minus), above(Side::Plus)) {
        (Some(multiplier), None) | (None, Some(multiplier)) => multiplier,
        _ => return None,
    };
    Some(std::f64::consts::LN_10 / elementary::ln(multiplier))
}

/// Whether both motions left, after about the same number of revolutions.
pub fn agree(linear: Option<u64>, simulated: Option<u64>) -> bool {
    let near = |(linear, simulated): (u64, u64)| {
        linear.abs_diff(simulated) as f64 <= 1.0 + tolerance::PASSAGE.value * linear as f64
    };
    linear.zip(simulated).is_some_and(near)
}
