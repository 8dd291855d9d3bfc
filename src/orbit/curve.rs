//! Curves of solutions: n - 1 equations in n unknowns, followed by pseudo-arclength (Keller 1977).
//!
//! The next point u' after a point u with unit tangent t solves the equations together with `t (u' - u) = h`. There is one
//! solution nearby even where the curve turns round in the parameter.

use std::convert::Infallible;

use nalgebra::{DMatrix, DVector};

use crate::bracket::{Width, halve};
use crate::tolerance;

/// Equations whose solutions form a curve. Unknowns are scaled so that their changes are of one size.
pub trait Equations {
    /// Reason why the equations cannot be evaluated at some place.
    type Error;

    /// Residual of n - 1 equations at n unknowns, and its derivative, (n - 1) x n.
    fn linear(&self, unknowns: &DVector<f64>) -> Result<(DVector<f64>, DMatrix<f64>), Self::Error>;
}

/// Reason why there is no next point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoPoint<E> {
    /// The equations cannot be evaluated.
    Outside(E),
    /// Newton's method does not converge.
    NotClosed,
}

impl<E> From<E> for NoPoint<E> {
    fn from(error: E) -> Self {
        Self::Outside(error)
    }
}

/// A point of the curve, its unit tangent, and the number of Newton steps that it took.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvePoint {
    pub unknowns: DVector<f64>,
    /// The direction in which the curve goes on.
    pub tangent: DVector<f64>,
    /// Steps of Newton's method.
    pub steps: usize,
}

/// Unit tangent at `unknowns`, of either sign, where no earlier tangent is known.
pub fn first_tangent<E: Equations>(equations: &E, unknowns: &DVector<f64>) -> Result<DVector<f64>, NoPoint<E::Error>> {
    let (_, jacobian) = equations.linear(unknowns)?;
    let [direction] = least_seen(jacobian).ok_or(NoPoint::NotClosed)?;
    Ok(direction)
}

/// Returns the `N` unit directions with the smallest images under a matrix, the smallest first. `None` if the matrix is not finite or has
/// fewer than `N` columns.
pub fn least_seen<const N: usize>(matrix: DMatrix<f64>) -> Option<[DVector<f64>; N]> {
    let [rows, columns] = [matrix.nrows(), matrix.ncols()];
    // Rows of zeros fill a flat matrix up to a square, so that each column has a direction, from most to least stretched.
    let directions = matrix.resize_vertically(rows.max(columns), 0.0).svd(false, true).v_t?;
    let row = |back: usize| Some(directions.row(columns.checked_sub(back)?).transpose());
    let least: Vec<DVector<f64>> = (1..=N).map(row).collect::<Option<_>>()?;
    least.iter().flatten().all(|entry| entry.is_finite()).then(|| least.try_into().ok())?
}

/// Solves for the point of the curve in the plane across `along` at a distance `step` from `from`.
pub fn step<E: Equations>(
    equations: &E,
    from: &DVector<f64>,
    along: &DVector<f64>,
    step: f64,
) -> Result<CurvePoint, NoPoint<E::Error>> {
    closed(equations, from, along, step, from + along * step)
}

/// Solves for the same point as `step`, starting from a guess.
pub fn closed<E: Equations>(
    equations: &E,
    from: &DVector<f64>,
    along: &DVector<f64>,
    step: f64,
    guess: DVector<f64>,
) -> Result<CurvePoint, NoPoint<E::Error>> {
    /// Most Newton steps. A step along the curve that needs more is too long.
    const STEPS: usize = 12;
    let mut unknowns = guess;
    let mut last = f64::INFINITY;
    for steps in 1..=STEPS {
        let (residual, jacobian) = equations.linear(&unknowns)?;
        let off_plane = along.dot(&(&unknowns - from)) - step;
        let right = -residual.push(off_plane);
        let matrix = bordered(jacobian, along).lu();
        let correction = matrix.solve(&right).ok_or(NoPoint::NotClosed)?;
        let length = correction.norm();
        // No convergence: the correction has at least doubled, or is at least eight times as long as the step.
        if !(length < 2.0 * last.min(step.abs().max(tolerance::CYCLE_CLOSED.value) * 4.0)) {
            return Err(NoPoint::NotClosed);
        }
        unknowns += correction;
        // Newton's method converges quadratically: the next correction would be about the square of this one.
        if length <= tolerance::CYCLE_CLOSED.value {
            // The tangent t solves [J; along] t = (0, 1), unless it is across `along`. J is taken before the last correction, which turns
            // the tangent by no more than its own length.
            let across = DVector::from_fn(unknowns.len(), |row, _| f64::from(row + 1 == unknowns.len()));
            let tangent = matrix.solve(&across).ok_or(NoPoint::NotClosed)?;
            return Ok(CurvePoint { unknowns, tangent: unit(tangent)?, steps });
        }
        last = length;
    }
    Err(NoPoint::NotClosed)
}

/// Scales a direction to length 1. Fails if its length is 0 or not finite.
pub fn unit<E>(direction: DVector<f64>) -> Result<DVector<f64>, NoPoint<E>> {
    let length = direction.norm();
    if length.is_normal() { Ok(direction / length) } else { Err(NoPoint::NotClosed) }
}

/// Last value between `value` and `beyond` that is not refused. `None` if `beyond` is not refused.
pub fn limit(value: f64, beyond: f64, is_refused: impl Fn(f64) -> bool) -> Option<f64> {
    /// Halvings that narrow an interval of doubles down to neighbours.
    const BINARY_DIGITS: u32 = 60;
    if !is_refused(beyond) {
        return None;
    }
    let Ok([last, _]) =
        halve([value, beyond], Width::Halvings(BINARY_DIGITS), |at| Ok::<_, Infallible>(is_refused(at)));
    // Halving approaches a limit of exactly 0 only up to rounding.
    let is_zero = last.abs() <= tolerance::ULP.value * (value - beyond).abs() && !is_refused(0.0);
    Some(if is_zero { 0.0 } else { last })
}

fn bordered(jacobian: DMatrix<f64>, row: &DVector<f64>) -> DMatrix<f64> {
    let last = jacobian.nrows();
    let mut square = jacobian.insert_row(last, 0.0);
    square.set_row(last, &row.transpose());
    square
}
