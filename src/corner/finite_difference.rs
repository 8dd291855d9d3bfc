//! A and B by central differences of simulated revolutions, extrapolated to step 0.
//!
//! A central difference errs by even powers of the step, so halving it k times and eliminating a power each time
//! (Richardson) leaves an error of order 2k + 2 in the step; the last correction is the estimate of what remains.

use nalgebra::{Matrix2, Vector2, Vector3};

use super::locate::CornerImpact;
use super::map::{CornerMap, Route, SideMap, Uncertainty};
use super::one_sided::{OneSidedMap, SampleError};
use crate::cam::{Cam, Side};
use crate::model::Model;

/// Halvings of the step. The fourth correction is below rounding for the perturbations that are used; more would only
/// add the rounding of smaller steps.
const HALVINGS: usize = 3;

/// The map by extrapolated central differences, with the last correction of each entry.
pub fn route(model: &Model, cam: &Cam, at: &CornerImpact) -> Result<Route, SampleError> {
    let (minus, minus_error) = side_map(&OneSidedMap::new(model, cam, at, Side::Minus)?)?;
    let (plus, plus_error) = side_map(&OneSidedMap::new(model, cam, at, Side::Plus)?)?;
    Ok(Route {
        name: "finite_difference",
        map: CornerMap { minus, plus },
        uncertainty: Some(Uncertainty::LastCorrection(CornerMap { minus: minus_error, plus: plus_error })),
    })
}

fn side_map(map: &OneSidedMap<'_>) -> Result<(SideMap, SideMap), SampleError> {
    let scales = map.scales();
    let mut columns = [(Vector2::zeros(), Vector2::zeros()); 3];
    for (direction, column) in columns.iter_mut().enumerate() {
        let difference = |step: f64| {
            let mut perturbation = Vector3::zeros();
            perturbation[direction] = step;
            Ok((map.sample(perturbation)?.end - map.sample(-perturbation)?.end) / (2.0 * step))
        };
        *column = extrapolate(scales[direction], difference)?;
    }
    let [first, second, period] = columns;
    let value = SideMap { a: Matrix2::from_columns(&[first.0, second.0]), b: period.0 };
    let error = SideMap { a: Matrix2::from_columns(&[first.1, second.1]), b: period.1 };
    Ok((value, error))
}

/// Richardson's limit of `difference(step)` for step to 0, and the size of its last correction.
fn extrapolate<E>(
    step: f64,
    difference: impl Fn(f64) -> Result<Vector2<f64>, E>,
) -> Result<(Vector2<f64>, Vector2<f64>), E> {
    let mut row = vec![difference(step)?];
    let mut correction = Vector2::repeat(f64::INFINITY);
    for halving in 1..=HALVINGS {
        let mut next = vec![difference(step / f64::from(1_u32 << halving))?];
        for (order, coarse) in row.iter().enumerate() {
            // The error of order 2(k+1) shrinks by 4^{k+1} when the step is halved.
            let gain = f64::from(4_u32.pow(order as u32 + 1));
            let fine = next[order];
            next.push(fine + (fine - coarse) / (gain - 1.0));
        }
        correction = (next[halving] - row[halving - 1]).abs();
        row = next;
    }
    Ok((row[HALVINGS], correction))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extrapolation_recovers_a_derivative_to_rounding() {
        let difference = |h: f64| Ok::<_, ()>(Vector2::new(((1.0 + h).exp() - (1.0 - h).exp()) / (2.0 * h), (h.sin()) / h));
        let (limit, error) = extrapolate(0.5, difference).unwrap_or((Vector2::zeros(), Vector2::zeros()));
        approx::assert_relative_eq!(limit[0], std::f64::consts::E, epsilon = 1e-12);
        approx::assert_relative_eq!(limit[1], 1.0, epsilon = 1e-12);
        // The estimate is that of the step before, larger than the true error but of its kind.
        assert!(error.max() < 1e-7 && error.min() > 1e-14, "{error}");
    }
}
