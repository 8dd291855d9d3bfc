//! Closed forms of the paper, each under its label, for every damping.
//!
//! They use no part of the simulator: the propagator is transcribed from the paper, not taken from [`crate::flight`]. The inputs are the
//! cam's lift at the corner, T*, and the velocity before the impact. Where the paper misprints a formula, the repaired form is given and
//! the repair is named.

use std::f64::consts::TAU;

use nalgebra::{Matrix2, RowVector2, Vector2};

use super::corner_impact::CornerImpact;
use super::map::{CornerMap, LinearForm, Own, Route, RouteName, SideMap};
use crate::bracket::secants;
use crate::cam::Lift;
use crate::elementary;
use crate::model::{Follower, Model};
use crate::tolerance;

/// Error of eq:fixedp: no solution, or secants that do not converge.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("closed form: eq:fixedp and the contact condition converge to no period near {period} s")]
pub struct NoFixedPoint {
    /// Last period tried, s.
    pub period: f64,
}

/// Computes the map by eq:Px and eq:PT.
pub fn route(model: &Model, at: &CornerImpact) -> Route {
    let side = |side| side_map(&model.follower, at.period, at.velocity_before, &at.corner.lift(side));
    let map = CornerMap::of_each(side);
    let own = Own::border(border(&model.follower, at.period, at.velocity_before));
    Route { name: RouteName::ClosedForm, map, own, uncertainty: None }
}

/// Returns `(e, f)`, the derivatives of eq:H: to first order, the distance of the flight from the cam when the corner passes. `v` is the
/// velocity before the impact, m/s, and `period` T*, s.
fn border(follower: &Follower, period: f64, v: f64) -> LinearForm {
    let f = propagator(follower.damping / (2.0 * follower.mass), follower.stiffness / follower.mass, 0.5 * period);
    // Eq:dti_dxn   e = dH/dx = h phi_{T/2}
    // Eq:dti_dT    f = dH/dT = h phi_{T/2}' x/2 = v/2, both at t_i = 0; the cam at the corner does not depend on T
    (RowVector2::new(f[(0, 0)], f[(0, 1)]), 0.5 * v)
}

/// Computes `A` and `B` for one side's lift at the corner; `v` is the velocity before the impact, m/s, and `period` T*, s.
pub fn side_map(follower: &Follower, period: f64, v: f64, lift: &Lift) -> SideMap {
    let zeta = follower.damping / (2.0 * follower.mass);
    let omega0_squared = follower.stiffness / follower.mass;
    let r = follower.restitution;
    let omega = TAU / period;
    let (c1, c2) = (omega * lift.slope, omega * omega * lift.curvature);
    // a(q, v) = -2 zeta v - w0^2 (q - rest) - g, at the corner's position
    let spring = omega0_squared * (lift.value - follower.rest_position) + follower.gravity;
    let acceleration = |v: f64| -2.0 * zeta * v - spring;
    // eq:lmaptheta_1   F = phi_{T/2}: the flight to the corner, and from there
    let f = propagator(zeta, omega0_squared, 0.5 * period);
    // S = 2 zeta c' + c'' + w0^2 q, the cam's acceleration less the follower's at the cam's velocity
    let s = c2 - acceleration(c1);

    // eq:Px   A = F [[-r, 0], [alpha, -r]] F,  alpha = -(1 + r) S/(v - c')
    let alpha = -(1.0 + r) * s / (v - c1);
    let a = f * Matrix2::new(-r, 0.0, alpha, -r) * f;

    // eq:PT   B = 1/2 F' (q, v+) + 1/2 F (v, -r a - 2 (1+r) c'/T) - 1/2 F (1+r) v/(v - c') (v - c', S)
    // In print F and F' are exchanged in the first two terms and the last sign is +. F' (q, v+) = F (v+, a(q, v+)).
    let v_plus = (1.0 + r) * c1 - r * v;
    let leaving = Vector2::new(v_plus, acceleration(v_plus));
    let arriving = Vector2::new(v, -r * acceleration(v) - 2.0 * (1.0 + r) * c1 / period);
    let shift = Vector2::new(v - c1, s) * ((1.0 + r) * v / (v - c1));
    let b = f * (leaving + arriving - shift) * 0.5;
    SideMap { a, b }
}

/// Solves eq:fixedp, repaired: `x* = -[I - phi_T - F R F]^{-1} F R y_0`, `R = [[0, 0], [0, -(1+r)]]`. The print has the sign + before
/// `F R F`. `T*` follows from `h (F x* - y_0) = 0` by secants from a period close by.
///
/// Needs an equilibrium, so a stiffness above 0.
pub fn orbit(model: &Model, at: &CornerImpact) -> Result<(Vector2<f64>, f64), NoFixedPoint> {
    let follower = &model.follower;
    let zeta = follower.damping / (2.0 * follower.mass);
    let omega0_squared = follower.stiffness / follower.mass;
    let equilibrium = follower.rest_position - follower.gravity / omega0_squared;
    // eq:impactdynamics_2   x+ = x + R (x - y)
    let restitution = Matrix2::new(0.0, 0.0, 0.0, -(1.0 + follower.restitution));
    let fixed_point = |period: f64| {
        let f = propagator(zeta, omega0_squared, 0.5 * period);
        let y0 = Vector2::new(at.corner.minus.value - equilibrium, TAU / period * at.corner.minus.slope);
        let whole = Matrix2::identity() - propagator(zeta, omega0_squared, period) - f * restitution * f;
        let x = -(whole.try_inverse()? * (f * (restitution * y0)));
        // eq:H at t_i = 0   h (F x - y_0) = 0
        Some((x, (f * x - y0)[0]))
    };
    let fixed_point = |period: f64| fixed_point(period).ok_or(NoFixedPoint { period });
    // Starts from periods that are off by at least a millionth, so that the root is found here and not copied.
    let miss = |period: f64| Ok(fixed_point(period)?.1);
    let [first, second] = [1.0 - 2e-6, 1.0 + 1e-6].map(|part| at.period * part);
    let guesses = [(first, miss(first)?), (second, miss(second)?)];
    // Each secant step gains half as many digits again; a handful reach rounding.
    let ([_, (period, _)], settled) = secants(guesses, 20, tolerance::ROOT_WIDTH.value, miss)?;
    if settled { Ok((fixed_point(period)?.0, period)) } else { Err(NoFixedPoint { period }) }
}

/// Computes eq:fbsol1, eq:gff: `phi_t = e^{-zeta t} (I cos(ws t) + A sin(ws t))`, `ws = sqrt(w0^2 - zeta^2)`. In the limits of critical
/// damping and overdamping, cosine and sine become hyperbolic.
pub(super) fn propagator(zeta: f64, omega0_squared: f64, t: f64) -> Matrix2<f64> {
    let square = omega0_squared - zeta * zeta;
    let omega = square.abs().sqrt();
    // cos = e^{-zeta t} cos(ws t), sin = e^{-zeta t} sin(ws t)/ws
    let decay = elementary::exp(-zeta * t);
    let x = omega * t;
    let (cos, sin) = if square > 0.0 {
        (decay * elementary::cos(x), decay * elementary::sin(x) / omega)
    } else if x < 1.0 {
        let ratio = if x == 0.0 { 1.0 } else { elementary::sinh(x) / x };
        (decay * elementary::cosh(x), decay * t * ratio)
    } else {
        // e^{-zeta t} and cosh alone would underflow and overflow.
        let (slow, fast) =
            (elementary::exp(-omega0_squared / (zeta + omega) * t), elementary::exp(-(zeta + omega) * t));
        (0.5 * (slow + fast), (slow - fast) / (2.0 * omega))
    };
    Matrix2::new(cos + zeta * sin, sin, -omega0_squared * sin, cos - zeta * sin)
}
