//! Lyapunov exponents, from the variational flow.

use std::ops::ControlFlow;

use nalgebra::{Matrix2, Vector2};

use crate::simulate::{Event, EventKind, Machine, Motion, SimulateError, Variation};

/// The mean growth of a small deviation per revolution, as a natural logarithm: the largest Lyapunov exponent in the limit
/// of many `revolutions`.
///
/// Minus infinity where the follower comes to stick to the cam, be it once in thousands of revolutions: nothing is left of a
/// deviation then, and what follows repeats what followed the stick before. Until such a stick a chaotic motion has the
/// number that it would have without. A start on the cam counts from its release on; in no revolution nothing grows.
pub fn growth(machine: &Machine, mut motion: Motion, revolutions: u64) -> Result<f64, SimulateError> {
    let omega = machine.angular_velocity();
    if motion.contact {
        let goal = motion.after(revolutions);
        let released = machine.advance(&mut motion, goal, &mut |event: &Event| match event.kind {
            EventKind::Release => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        })?;
        if released.is_continue() {
            return Ok(f64::NEG_INFINITY);
        }
    }
    let mut variation = Variation::new(machine, &motion);
    // Any direction has a part along the one that grows most; velocity counts over the angle, in m/rad.
    let mut direction = Vector2::new(0.6, 0.8);
    let mut sum = 0.0;
    for _ in 0..revolutions {
        let goal = motion.after(1);
        let _ = machine.advance(&mut motion, goal, &mut variation)?;
        let matrix = variation.matrix();
        let carried = Vector2::new(
            matrix[(0, 0)] * direction[0] + matrix[(0, 1)] * omega * direction[1],
            matrix[(1, 0)] / omega * direction[0] + matrix[(1, 1)] * direction[1],
        );
        let stretch = carried.norm();
        if stretch == 0.0 {
            return Ok(f64::NEG_INFINITY);
        }
        sum += stretch.ln();
        direction = carried / stretch;
        variation.reset(Matrix2::identity());
    }
    Ok(sum / revolutions.max(1) as f64)
}
