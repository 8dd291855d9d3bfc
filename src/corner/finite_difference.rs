//! A and B by central differences of simulated periods, extrapolated to step 0.
//!
//! A central difference errs by even powers of the step, so halving it k times and eliminating a power each time
//! (Richardson) leaves an error of order 2k + 2 in the step, until rounding, which grows as the step shrinks, takes over.
//! Each entry of the table is known to its last correction and to the rounding of the period over the step; the one
//! for which their sum is smallest is taken, and that sum is its error estimate.

use nalgebra::{Matrix2, Vector2, Vector3};

use super::corner_impact::CornerImpact;
use super::map::{CornerMap, Route, SideMap, Uncertainty};
use super::one_sided::{OneSidedMap, SampleError};
use super::varied::Varied;
use crate::cam::{Cam, Side};
use crate::model::Model;

/// Halvings of the step: enough to bring a cam with sharp arcs to rounding.
const HALVINGS: usize = 7;

/// The map by extrapolated central differences, with the last correction of each entry.
pub fn route(model: &Model, cam: &Cam, at: &CornerImpact) -> Result<Route, SampleError> {
    route_by(model, cam, at, &Varied::Period)
}

/// The same with B by any number of the model.
pub fn route_by(model: &Model, cam: &Cam, at: &CornerImpact, varied: &Varied) -> Result<Route, SampleError> {
    let (minus, minus_error) = side_map(&OneSidedMap::by(model, cam, at, Side::Minus, varied)?)?;
    let (plus, plus_error) = side_map(&OneSidedMap::by(model, cam, at, Side::Plus, varied)?)?;
    Ok(Route {
        name: "finite_difference",
        map: CornerMap { minus, plus },
        uncertainty: Some(Uncertainty::Extrapolation(CornerMap { minus: minus_error, plus: plus_error })),
    })
}

/// One side's map, and the error of each entry.
pub fn side_map(map: &OneSidedMap<'_>) -> Result<(SideMap, SideMap), SampleError> {
    let scales = map.scales();
    let mut columns = [(Vector2::zeros(), Vector2::zeros()); 3];
    for (direction, column) in columns.iter_mut().enumerate() {
        let difference = |step: f64| {
            let mut perturbation = Vector3::zeros();
            perturbation[direction] = step;
            let (ahead, behind) = (map.sample(perturbation)?, map.sample(-perturbation)?);
            Ok((ahead.end - behind.end) / (ahead.perturbation - behind.perturbation)[direction])
        };
        *column = extrapolate(scales[direction], map.rounding(), difference)?;
    }
    let [first, second, period] = columns;
    let value = SideMap { a: Matrix2::from_columns(&[first.0, second.0]), b: period.0 };
    let error = SideMap { a: Matrix2::from_columns(&[first.1, second.1]), b: period.1 };
    Ok((value, error))
}

/// Richardson's limit of `difference(step)` for step to 0, and the size of its error, where `rounding` is that of the
/// function differenced.
fn extrapolate<E>(
    step: f64,
    rounding: Vector2<f64>,
    difference: impl Fn(f64) -> Result<Vector2<f64>, E>,
) -> Result<(Vector2<f64>, Vector2<f64>), E> {
    let mut row = vec![difference(step)?];
    let mut best = (row[0], Vector2::repeat(f64::INFINITY));
    for halving in 1..=HALVINGS {
        let step = step / f64::from(1_u32 << halving);
        let mut next = vec![difference(step)?];
        for (order, coarse) in row.iter().enumerate() {
            // The error of order 2(k+1) shrinks by 4^{k+1} when the step is halved.
            let gain = f64::from(4_u32.pow(order as u32 + 1));
            let fine = next[order];
            let better = fine + (fine - coarse) / (gain - 1.0);
            let error = (better - coarse).abs() + rounding / step;
            for component in 0..2 {
                if error[component] < best.1[component] {
                    best.0[component] = better[component];
                    best.1[component] = error[component];
                }
            }
            next.push(better);
        }
        row = next;
    }
    Ok(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extrapolation_recovers_a_derivative_to_rounding() {
        let difference =
            |h: f64| Ok::<_, ()>(Vector2::new(((1.0 + h).exp() - (1.0 - h).exp()) / (2.0 * h), (h.sin()) / h));
        let (limit, error) =
            extrapolate(0.5, Vector2::repeat(f64::EPSILON), difference).unwrap_or((Vector2::zeros(), Vector2::zeros()));
        approx::assert_relative_eq!(limit[0], std::f64::consts::E, epsilon = 1e-12);
        approx::assert_relative_eq!(limit[1], 1.0, epsilon = 1e-12);
        assert!(error.max() < 1e-11 && error.min() > 0.0, "{error}");
    }
}
