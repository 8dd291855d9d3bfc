//! Newton's law of restitution at the cam, and its derivative with respect to the state before the impact.

use nalgebra::Matrix2;

use crate::interval::Number;

/// Velocity after an impact, m/s: `v+ = (1 + r) c' - r v-`.
///
/// `incoming` is the follower's velocity before, `surface` the cam's velocity `c'`, both m/s; `restitution` is r.
#[inline]
pub fn rebound<N: Number>(restitution: f64, incoming: N, surface: N) -> N {
    // eq:i1   v+ = (1 + r) c' - r v-, as c' + r (c' - v-): the relative velocity is reversed and scaled, without cancellation as it
    // shrinks.
    surface + relative_rebound(restitution, incoming, surface)
}

/// Velocity relative to the cam after an impact, m/s: `v+ - c' = r (c' - v-)`; arguments as for [`rebound`].
#[inline]
pub fn relative_rebound<N: Number>(restitution: f64, incoming: N, surface: N) -> N {
    (surface - incoming) * restitution
}

/// Quantities of an impact that its derivative needs: velocities in m/s, accelerations in m/s^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactRates<N = f64> {
    /// Coefficient of restitution r, 0 to 1.
    pub restitution: f64,
    /// Velocity v- of the follower before the impact.
    pub velocity_before: N,
    /// Acceleration `q''` in flight just before the impact.
    pub acceleration_before: N,
    /// Acceleration `q''` in flight just after the impact.
    pub acceleration_after: N,
    /// Velocity c' of the cam.
    pub cam_velocity: N,
    /// Acceleration c'' of the cam.
    pub cam_acceleration: N,
}

impl<N: Number> ImpactRates<N> {
    /// Saltation matrix by rows: 2x2, from the deviation of (q, v) before to the deviation after, at the same instant.
    ///
    /// A deviation dq delays the impact by `dq/(c' - v-)`, during which both motions and the cam continue:
    ///
    /// ```text
    /// S = [[-r, 0], [(a+ + r a- - (1 + r) c'')/(v- - c'), -r]]
    /// ```
    ///
    /// Not finite at a graze, `v- = c'`.
    pub fn saltation_rows(&self) -> [[N; 2]; 2] {
        // eq:ftaylormapcornerX, the factor between the two flights, with the sign of its bracket repaired:
        // I + R - (R phi_0' x - phi_0' R x + phi_0' R y - R y') h/(h (phi_0' x - y')), x = (q, v-) and y = (c, c')
        let r = self.restitution;
        let turn = self.acceleration_after + self.acceleration_before * r - self.cam_acceleration * (1.0 + r);
        [[N::from(-r), N::from(0.0)], [turn / (self.velocity_before - self.cam_velocity), N::from(-r)]]
    }
}

impl ImpactRates {
    /// Saltation matrix.
    pub fn saltation(&self) -> Matrix2<f64> {
        let [[a, b], [c, d]] = self.saltation_rows();
        Matrix2::new(a, b, c, d)
    }
}
