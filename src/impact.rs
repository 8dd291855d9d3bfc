//! Newton's restitution at the cam.

/// Velocity after an impact, m/s: `v+ = (1 + r) c' - r v-`.
///
/// `incoming` is the follower's velocity before, `surface` the cam's velocity `c'`, both m/s; `restitution` is r.
pub fn rebound(restitution: f64, incoming: f64, surface: f64) -> f64 {
    // As c' + r (c' - v-): the relative velocity is reversed and scaled, with no cancellation as it dies out.
    surface + restitution * (surface - incoming)
}
