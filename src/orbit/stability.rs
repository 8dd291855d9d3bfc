//! Decides whether small deviations from a periodic motion die out; no other module does.
//!
//! The matrix M that carries a deviation once around has the multipliers as its eigenvalues. Its determinant is known in closed form and is
//! 1 at most. So both multipliers are inside the unit circle, or one is outside (Jury 1962), as
//!
//! ```text
//! det M < 1 and |tr M| < 1 + det M        |tr M| > 1 + det M
//! ```
//!
//! A lossless follower has det M = 1: its multipliers are a pair on the unit circle where |tr M| < 2. Between the two cases, within the
//! error of the trace, a multiplier is 1 or -1. The trace decides without a square root. So nearly equal multipliers do no harm, although
//! an error moves them by its square root.

use nalgebra::Matrix2;
use serde::Serialize;

use super::cycle::{Cycle, lift_size};
use super::multipliers::eigenvalues;
use crate::elementary;
use crate::flight::Flight;
use crate::impact::{ImpactRates, rebound};
use crate::interval::Interval;
use crate::known::Evidence;
use crate::simulate::Machine;
use crate::tolerance;

/// Behaviour of small deviations from a periodic motion, by its multipliers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Stability {
    /// All multipliers are inside the unit circle: deviations die out.
    Stable,
    /// A multiplier is outside the unit circle: deviations grow.
    Unstable,
    /// The largest modulus of a multiplier is 1 within its error: to first order deviations neither die out nor grow.
    Neutral,
}

named!(Stability);

impl Stability {
    /// Decides by the largest modulus of a multiplier and its error.
    pub fn of_modulus(modulus: f64, error: f64) -> Self {
        if modulus + error < 1.0 {
            Self::Stable
        } else if modulus - error > 1.0 {
            Self::Unstable
        } else {
            Self::Neutral
        }
    }

    /// Decides by the ranges of |tr M| and 1 + det M, and by whether det M is below 1. `None` if a multiplier may be inside or outside the
    /// unit circle.
    #[doc(hidden)]
    pub fn of_trace([least, most]: [f64; 2], [low, high]: [f64; 2], loses: bool) -> Option<Self> {
        if least > high {
            Some(Self::Unstable)
        } else if most < low {
            Some(if loses { Self::Stable } else { Self::Neutral })
        } else {
            None
        }
    }
}

/// Stability of a motion, and the accuracy of its multipliers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judgement {
    /// The verdict.
    pub stability: Stability,
    /// Proved if the verdict holds for every number of the enclosures of a proved orbit, otherwise computed.
    pub known: Evidence,
    /// Bound on the distance of each computed multiplier from the true one, to first order in the errors of the matrix. NaN where there are
    /// no multipliers.
    pub error: f64,
}

/// A 2x2 matrix by rows, whose entries are known to lie in intervals.
#[doc(hidden)]
pub type Rows = [[Interval; 2]; 2];

/// The angle, rad, and the velocity before, m/s, of an impact.
pub(super) type Place = [Interval; 2];

/// Propagator of a flight over a time, s.
fn propagator(flight: &Flight, time: Interval) -> Rows {
    let response = flight.response_over(time);
    let spring = flight.omega0_squared();
    let (p, s) = (response.step, response.impulse);
    [[-(p * spring) + 1.0, s], [-(s * spring), response.impulse_rate]]
}

fn product(left: &Rows, right: &Rows) -> Rows {
    [0, 1].map(|row| [0, 1].map(|column| left[row][0] * right[0][column] + left[row][1] * right[1][column]))
}

/// For each impact, encloses its saltation matrix and the flight to the next, for all impacts within `places`.
fn factors(machine: &Machine, cycle: &Cycle, places: &[Place]) -> Vec<Rows> {
    let (flight, r, omega) = (machine.flight(), machine.restitution(), machine.angular_velocity());
    let count = cycle.impacts.len();
    let factor = |(index, &[angle, velocity_before]): (usize, &Place)| {
        let lift = machine.cam().segments()[cycle.impacts[index].segment].law.lift_over(angle);
        let cam_velocity = lift.slope * omega;
        let rates = ImpactRates {
            restitution: r,
            velocity_before,
            acceleration_before: flight.acceleration_at(lift.value, velocity_before),
            acceleration_after: flight.acceleration_at(lift.value, rebound(r, velocity_before, cam_velocity)),
            cam_velocity,
            cam_acceleration: lift.curvature * omega * omega,
        };
        let next = (index + 1) % count;
        let turn = Interval::TURN * cycle.turns(index);
        let turn = if next == index { turn } else { turn + places[next][0] - angle };
        product(&propagator(flight, turn / Interval::from(omega)), &rates.saltation_rows())
    };
    places.iter().enumerate().map(factor).collect()
}

/// Midpoints of the entries.
fn middle(rows: &Rows) -> Matrix2<f64> {
    Matrix2::from_fn(|row, column| rows[row][column].middle())
}

/// Trace tr M of a product of factors, and its error to first order.
///
/// Let F be one factor, P the product of the factors before it, and R the product of those after it. An error dF changes the trace by tr(R
/// dF P) = tr(P R dF). Rounding of the product F P makes an error E of at most 2 u |F| |P|, which changes the trace by tr(R E):
///
/// ```text
/// tr(|P R| |dF|)        2 u tr(|R| |F| |P|)        at most
/// ```
#[doc(hidden)]
pub fn trace(factors: &[Rows]) -> (f64, f64) {
    let mut after = vec![Matrix2::<f64>::identity()];
    for factor in factors.iter().skip(1).rev() {
        let last = after[after.len() - 1];
        after.push(last * middle(factor));
    }
    let (mut before, mut error) = (Matrix2::<f64>::identity(), 0.0);
    for (factor, after) in factors.iter().zip(after.iter().rev()) {
        let centre = middle(factor);
        let radius = Matrix2::from_fn(|row, column| 0.5 * factor[row][column].width());
        let rounding = after.abs() * centre.abs() * before.abs() * (2.0 * tolerance::ULP.value);
        error += ((before * after).abs() * radius).trace() + rounding.trace();
        before = centre * before;
    }
    (before.trace(), error)
}

/// Bound on the distance of the computed eigenvalues of `matrix` from those that belong to a more accurate trace and determinant.
///
/// At a computed multiplier mu the true characteristic polynomial has the value p. So the distances d1 and d2 of mu from the true
/// multipliers have the product p. The nearer one is at most the root of p away, and at most 2 p/g if the two are a distance g apart.
#[doc(hidden)]
pub fn multipliers_error(matrix: &Matrix2<f64>, (trace, error): (f64, f64), determinant: f64) -> f64 {
    let pair = eigenvalues(matrix);
    let terms = (matrix[(0, 0)] * matrix[(1, 1)]).abs() + (matrix[(0, 1)] * matrix[(1, 0)]).abs();
    let off = (matrix.determinant() - determinant).abs() + 2.0 * tolerance::ULP.value * terms;
    let gap = elementary::hypot(pair[0].re - pair[1].re, pair[0].im - pair[1].im);
    let of_one = |modulus: f64| {
        let missed = modulus * ((matrix.trace() - trace).abs() + error) + off;
        missed.sqrt().min(2.0 * missed / gap)
    };
    pair.into_iter().map(|one| of_one(one.modulus())).fold(0.0, |most, one| if one <= most { most } else { one })
}

impl Judgement {
    /// Verdict on a product of factors with a known determinant, and the error of the eigenvalues of `matrix`.
    fn of(factors: &[Rows], determinant: f64, loses: bool, matrix: &Matrix2<f64>) -> Self {
        let (middle, error) = trace(factors);
        let size = Interval::from(middle.abs()) + Interval::new(-error, error);
        let flip = Interval::from(1.0) + Interval::from(determinant);
        let decided = Stability::of_trace([size.low(), size.high()], [flip.low(), flip.high()], loses);
        let error = multipliers_error(matrix, (middle, error), determinant);
        Self { stability: decided.unwrap_or(Stability::Neutral), known: Evidence::Computed, error }
    }

    /// Verdict on a cycle that closes within `residual` of its size, and whose matrix at angle 0 was computed as `matrix`.
    ///
    /// The impacts are known to the last correction of Newton's method. Next to a fold, where the equations hardly determine them, rounding
    /// limits this to an ulp over det(I - M), which takes half of the digits at most.
    pub(super) fn of_cycle(machine: &Machine, cycle: &Cycle, residual: f64, matrix: &Matrix2<f64>) -> Self {
        /// Safety factor on this uncertainty.
        const ROOM: f64 = 4.0;
        let determinant = cycle.determinant(machine);
        let singular = (1.0 - matrix.trace() + determinant).abs().clamp(tolerance::ULP.value.sqrt(), 1.0);
        let part = ROOM * (residual + tolerance::ULP.value / singular);
        let speed = lift_size(machine) * machine.angular_velocity();
        let around = |middle: f64, radius: f64| Interval::new(middle - radius, middle + radius);
        let places = cycle.impacts.iter().map(|impact| {
            let angle = around(impact.cam_angle, part);
            [angle, around(impact.velocity_before, part * speed.max(impact.velocity_before.abs()))]
        });
        let factors = factors(machine, cycle, &places.collect::<Vec<_>>());
        Self::of(&factors, determinant, loses(machine), matrix)
    }

    /// Verdict on a follower that stays above the cam.
    pub(super) fn of_flight(machine: &Machine, matrix: &Matrix2<f64>) -> Self {
        let (flight, omega) = (machine.flight(), machine.angular_velocity());
        let time = Interval::TURN / Interval::from(omega);
        // det M = e^{-b T/m}
        let determinant = elementary::exp(-2.0 * flight.zeta() * std::f64::consts::TAU / omega);
        Self::of(&[propagator(flight, time)], determinant, flight.zeta() > 0.0, matrix)
    }

    /// Verdict on a follower that rests on the cam.
    ///
    /// With restitution below 1 infinitely many impacts erase a deviation. With restitution 1 no bounce ends in a rest, and there is no
    /// matrix. A low bounce of speed u then keeps u^3 over the force of contact, an adiabatic invariant of many bounces in a revolution,
    /// except for what the damper takes: `u ~ e^{-b t/(3 m)}`.
    pub(super) fn of_rest(machine: &Machine) -> Self {
        let stability = if loses(machine) { Stability::Stable } else { Stability::Neutral };
        let error = if machine.restitution() < 1.0 { 0.0 } else { f64::NAN };
        Self { stability, known: Evidence::Computed, error }
    }

    /// Verdict that is proved for all impacts of a cycle within `places`; `None` if there is no single verdict.
    pub(super) fn proved(machine: &Machine, cycle: &Cycle, places: &[Place]) -> Option<Stability> {
        let factors = factors(machine, cycle, places);
        let determinant = |of: &Rows| of[0][0] * of[1][1] - of[0][1] * of[1][0];
        let whole = factors.iter().copied().reduce(|before, next| product(&next, &before))?;
        let trace = whole[0][0] + whole[1][1];
        let least = if trace.holds_zero() { 0.0 } else { trace.low().abs().min(trace.high().abs()) };
        let size = [least, trace.low().abs().max(trace.high().abs())];
        let determinant = factors.iter().map(determinant).fold(Interval::from(1.0), |all, one| all * one);
        let sum = determinant + 1.0;
        Stability::of_trace(size, [sum.low(), sum.high()], loses(machine))
    }
}

/// Whether impacts or flights lose energy, so that det M is below 1.
fn loses(machine: &Machine) -> bool {
    machine.restitution() < 1.0 || machine.flight().zeta() > 0.0
}
