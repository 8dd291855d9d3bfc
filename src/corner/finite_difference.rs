//! A and B by central differences of simulated revolutions, extrapolated to step 0.
//!
//! A central difference errs by even powers of the step; its rounding is that of the revolution over the step.

use nalgebra::{Matrix2, Vector2, Vector3};

use super::extrapolation::{Powers, extrapolate};
use super::locate::CornerImpact;
use super::map::{CornerMap, Route, SideMap, Uncertainty};
use super::one_sided::{OneSidedMap, SampleError};
use crate::cam::{Cam, Side};
use crate::model::Model;

/// The map by extrapolated central differences, with the last correction of each entry.
pub fn route(model: &Model, cam: &Cam, at: &CornerImpact) -> Result<Route, SampleError> {
    let (minus, minus_error) = side_map(&OneSidedMap::new(model, cam, at, Side::Minus)?)?;
    let (plus, plus_error) = side_map(&OneSidedMap::new(model, cam, at, Side::Plus)?)?;
    Ok(Route {
        name: "finite_difference",
        map: CornerMap { minus, plus },
        uncertainty: Some(Uncertainty::Extrapolation(CornerMap { minus: minus_error, plus: plus_error })),
    })
}

fn side_map(map: &OneSidedMap<'_>) -> Result<(SideMap, SideMap), SampleError> {
    let scales = map.scales();
    let mut columns = [(Vector2::zeros(), Vector2::zeros()); 3];
    for (direction, column) in columns.iter_mut().enumerate() {
        let difference = |step: f64| {
            let mut perturbation = Vector3::zeros();
            perturbation[direction] = step;
            let (ahead, behind) = (map.sample(perturbation)?, map.sample(-perturbation)?);
            Ok((ahead.end - behind.end) / (ahead.perturbation - behind.perturbation)[direction])
        };
        *column = extrapolate(scales[direction], Powers::Even, |step| map.rounding() / step, difference)?;
    }
    let [first, second, period] = columns;
    let value = SideMap { a: Matrix2::from_columns(&[first.0, second.0]), b: period.0 };
    let error = SideMap { a: Matrix2::from_columns(&[first.1, second.1]), b: period.1 };
    Ok((value, error))
}
