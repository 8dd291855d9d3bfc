//! Newton's restitution at the cam, and its derivative with respect to the state before.

use nalgebra::Matrix2;

/// Velocity after an impact, m/s: `v+ = (1 + r) c' - r v-`.
///
/// `incoming` is the follower's velocity before, `surface` the cam's velocity `c'`, both m/s; `restitution` is r.
#[inline]
pub fn rebound(restitution: f64, incoming: f64, surface: f64) -> f64 {
    // eq:i1   v+ = (1 + r) c' - r v-, as c' + r (c' - v-): the relative velocity is reversed and scaled, with no cancellation as it dies out.
    surface + relative_rebound(restitution, incoming, surface)
}

/// Velocity relative to the cam after an impact, m/s: `v+ - c' = r (c' - v-)`; arguments as for [`rebound`].
#[inline]
pub fn relative_rebound(restitution: f64, incoming: f64, surface: f64) -> f64 {
    restitution * (surface - incoming)
}

/// An impact as its derivative needs it: velocities in m/s, accelerations in m/s^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactRates {
    /// r, 0 to 1.
    pub restitution: f64,
    /// v-.
    pub velocity_before: f64,
    /// `q''` in flight just before.
    pub acceleration_before: f64,
    /// `q''` in flight just after.
    pub acceleration_after: f64,
    /// c'.
    pub cam_velocity: f64,
    /// c''.
    pub cam_acceleration: f64,
}

impl ImpactRates {
    /// The saltation matrix: 2x2, deviation of (q, v) before to deviation after, at the same instant.
    ///
    /// A deviation dq delays the impact by `dq/(c' - v-)`, in which both motions and the law itself move on:
    ///
    /// ```text
    /// S = [[-r, 0], [(a+ + r a- - (1 + r) c'')/(v- - c'), -r]]
    /// ```
    ///
    /// Not finite at a graze, `v- = c'`.
    pub fn saltation(&self) -> Matrix2<f64> {
        // eq:ftaylormapcornerX, what stands between the two flights, with the sign of its bracket repaired:
        // I + R - (R phi_0' x - phi_0' R x + phi_0' R y - R y') h/(h (phi_0' x - y')), x = (q, v-) and y = (c, c')
        let r = self.restitution;
        let turn = self.acceleration_after + r * self.acceleration_before - (1.0 + r) * self.cam_acceleration;
        Matrix2::new(-r, 0.0, turn / (self.velocity_before - self.cam_velocity), -r)
    }
}
