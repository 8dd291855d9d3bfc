//! A and B by central differences of simulated periods, extrapolated to step 0.
//!
//! A central difference errs by even powers of the step; its rounding is that of the period over the step.
//!
//! Over a period of several impacts rounding is amplified as deviations are. Such an orbit is differenced from the middle of
//! each flight to that of the next as well, and the parts multiplied.

use nalgebra::{Matrix2, Vector2, Vector3};

use super::corner_impact::CornerImpact;
use super::extrapolation::{Powers, extrapolate};
use super::map::{CornerMap, Route, SideMap, Uncertainty};
use super::one_sided::{OneSidedMap, SampleError};
use super::varied::Varied;
use crate::cam::{Cam, Side};
use crate::model::Model;

/// The map by extrapolated central differences, with the last correction of each entry.
pub fn route(model: &Model, cam: &Cam, at: &CornerImpact) -> Result<Route, SampleError> {
    route_by(model, cam, at, &Varied::Period)
}

/// The same with B by any number of the model.
pub fn route_by(model: &Model, cam: &Cam, at: &CornerImpact, varied: &Varied) -> Result<Route, SampleError> {
    let (minus, minus_error) = side_map(model, cam, at, Side::Minus, varied)?;
    let (plus, plus_error) = side_map(model, cam, at, Side::Plus, varied)?;
    Ok(Route {
        name: "finite_difference",
        map: CornerMap { minus, plus },
        uncertainty: Some(Uncertainty::Extrapolation(CornerMap { minus: minus_error, plus: plus_error })),
    })
}

/// One side's map, and the error of each entry: of several impacts over the whole period and impact by impact, each entry
/// as it is known better.
pub fn side_map(
    model: &Model,
    cam: &Cam,
    at: &CornerImpact,
    side: Side,
    varied: &Varied,
) -> Result<(SideMap, SideMap), SampleError> {
    let whole = OneSidedMap::by(model, cam, at, side, varied).and_then(|map| differences(&map));
    if at.cycle.contacts.len() == 1 {
        return whole;
    }
    Ok(match (whole, by_impacts(model, cam, at, side, varied)) {
        (Ok(whole), Ok(parts)) => {
            let (mut best, mut error) = whole;
            for entry in 0..4 {
                if parts.1.a[entry] < error.a[entry] {
                    (best.a[entry], error.a[entry]) = (parts.0.a[entry], parts.1.a[entry]);
                }
            }
            for row in 0..2 {
                if parts.1.b[row] < error.b[row] {
                    (best.b[row], error.b[row]) = (parts.0.b[row], parts.1.b[row]);
                }
            }
            (best, error)
        }
        (Ok(found), Err(_)) | (Err(_), Ok(found)) => found,
        (Err(failure), Err(_)) => return Err(failure),
    })
}

/// A period as the product of its parts, each with one impact.
fn by_impacts(
    model: &Model,
    cam: &Cam,
    at: &CornerImpact,
    side: Side,
    varied: &Varied,
) -> Result<(SideMap, SideMap), SampleError> {
    let none = SideMap { a: Matrix2::zeros(), b: Vector2::zeros() };
    let (mut all, mut off) = (SideMap { a: Matrix2::identity(), ..none }, none);
    for piece in OneSidedMap::pieces(model, cam, at, side, varied)? {
        let (next, error) = differences(&piece)?;
        // dx'' = A' (A dx + B dp) + B' dp, each factor off by its own error.
        off = SideMap {
            a: next.a.abs() * off.a + error.a * all.a.abs(),
            b: next.a.abs() * off.b + error.a * all.b.abs() + error.b,
        };
        all = SideMap { a: next.a * all.a, b: next.a * all.b + next.b };
    }
    Ok((all, off))
}

fn differences(map: &OneSidedMap<'_>) -> Result<(SideMap, SideMap), SampleError> {
    let scales = map.scales();
    let difference = |direction: usize, step: f64| {
        let mut perturbation = Vector3::zeros();
        perturbation[direction] = step;
        let (ahead, behind) = (map.sample(perturbation)?, map.sample(-perturbation)?);
        Ok((ahead.end - behind.end) / (ahead.perturbation - behind.perturbation)[direction])
    };
    let mut rounding = map.rounding();
    if map.impacts() > 1 {
        // Impacts one after another amplify rounding with every deviation.
        for direction in 0..2 {
            rounding += difference(direction, scales[direction])?.abs() * map.rounding()[direction];
        }
    }
    let mut columns = [(Vector2::zeros(), Vector2::zeros()); 3];
    for (direction, column) in columns.iter_mut().enumerate() {
        *column =
            extrapolate(scales[direction], Powers::Even, |step| rounding / step, |step| difference(direction, step))?;
    }
    let [first, second, period] = columns;
    let value = SideMap { a: Matrix2::from_columns(&[first.0, second.0]), b: period.0 };
    let error = SideMap { a: Matrix2::from_columns(&[first.1, second.1]), b: period.1 };
    Ok((value, error))
}
