//! Newton's restitution at the cam, and its derivative with respect to the state before.

use nalgebra::Matrix2;

use crate::interval::Number;

/// Velocity after an impact, m/s: `v+ = (1 + r) c' - r v-`.
///
/// `incoming` is the follower's velocity before, `surface` the cam's velocity `c'`, both m/s; `restitution` is r.
#[inline]
pub fn rebound<N: Number>(restitution: f64, incoming: N, surface: N) -> N {
    // eq:i1   v+ = (1 + r) c' - r v-, as c' + r (c' - v-): the relative velocity is reversed and scaled, with no cancellation as it dies out.
    surface + relative_rebound(restitution, incoming, surface)
}

/// Velocity relative to the cam after an impact, m/s: `v+ - c' = r (c' - v-)`; arguments as for [`rebound`].
#[inline]
pub fn relative_rebound<N: Number>(restitution: f64, incoming: N, surface: N) -> N {
    (surface - incoming) * restitution
}

/// An impact as its derivative needs it: velocities in m/s, accelerations in m/s^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactRates<N = f64> {
    /// r, 0 to 1.
    pub restitution: f64,
    /// v-.
    pub velocity_before: N,
    /// `q''` in flight just before.
    pub acceleration_before: N,
    /// `q''` in flight just after.
    pub acceleration_after: N,
    /// c'.
    pub cam_velocity: N,
    /// c''.
    pub cam_acceleration: N,
}

impl<N: Number> ImpactRates<N> {
    /// The saltation matrix by rows: 2x2, deviation of (q, v) before to deviation after, at the same instant.
    ///
    /// A deviation dq delays the impact by `dq/(c' - v-)`, in which both motions and the law itself move on:
    ///
    /// ```text
    /// S = [[-r, 0], [(a+ + r a- - (1 + r) c'')/(v- - c'), -r]]
    /// ```
    ///
    /// Not finite at a graze, `v- = c'`.
    pub fn saltation_rows(&self) -> [[N; 2]; 2] {
        // eq:ftaylormapcornerX, what stands between the two flights, with the sign of its bracket repaired:
        // I + R - (R phi_0' x - phi_0' R x + phi_0' R y - R y') h/(h (phi_0' x - y')), x = (q, v-) and y = (c, c')
        let r = self.restitution;
        let turn = self.acceleration_after + self.acceleration_before * r - self.cam_acceleration * (1.0 + r);
        [[N::from(-r), N::from(0.0)], [turn / (self.velocity_before - self.cam_velocity), N::from(-r)]]
    }
}

impl ImpactRates {
    /// The saltation matrix.
    pub fn saltation(&self) -> Matrix2<f64> {
        let [[a, b], [c, d]] = self.saltation_rows();
        Matrix2::new(a, b, c, d)
    }
}
