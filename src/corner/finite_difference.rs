//! A and B by central differences of simulated periods, extrapolated to step 0.
//!
//! The error of a central difference is a series of even powers of the step; its rounding grows as the step shrinks.
//!
//! Over a period of several impacts rounding grows as deviations do. Such an orbit is also differenced from the middle of
//! each flight to the middle of the next, and the parts multiplied; each entry is taken from the better way.
//!
//! Near a graze an impact amplifies rounding by the inverse of its relative velocity. The error estimate counts this at
//! every impact, and the first steps are as wide as they can be without changing which impacts there are.

use nalgebra::{Matrix2, Vector2, Vector3};

use super::corner_impact::CornerImpact;
use super::extrapolation::{Powers, extrapolate};
use super::map::{Route, RouteName, SideMap, Sides, Uncertainty};
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
    let found = Sides::try_of_each(|side| side_map(model, cam, at, side, varied))?;
    let uncertainty = Some(Uncertainty::Extrapolation(found.map(|(_, error)| *error)));
    Ok(Route { name: RouteName::FiniteDifference, map: found.map(|(map, _)| *map), uncertainty })
}

/// One side's map, and the error of each entry: of several impacts over the whole period and impact by impact, each entry
/// as it is known better.
pub fn side_map(
    model: &Model,
    cam: &Cam,
    at: &CornerImpact,
    side: Side,
    varied: &Varied,
) -> Result<Known, SampleError> {
    let whole = OneSidedMap::by(model, cam, at, side, varied);
    if at.cycle.impacts.len() == 1 {
        return whole.and_then(|map| differences(&map, amplified_once(&map)?));
    }
    let parts = by_impacts(model, cam, at, side, varied);
    let whole = whole.and_then(|map| {
        let amplified = match &parts {
            Ok(parts) => parts.amplify(map.rounding()),
            Err(_) => amplified_once(&map)?,
        };
        differences(&map, amplified)
    });
    Ok(match (whole, parts.map(|parts| parts.product())) {
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

/// Both of a map: the value and the error of each entry.
type Known = (SideMap, SideMap);

/// A period as the product of its parts, each with one impact.
struct Parts {
    parts: Vec<Known>,
    /// The product of the A after each part, of the last the identity.
    after: Vec<Matrix2<f64>>,
}

fn by_impacts(model: &Model, cam: &Cam, at: &CornerImpact, side: Side, varied: &Varied) -> Result<Parts, SampleError> {
    let pieces = OneSidedMap::pieces(model, cam, at, side, varied)?;
    let known = |piece: &OneSidedMap<'_>| differences(piece, amplified_once(piece)?);
    let parts = pieces.iter().map(known).collect::<Result<Vec<_>, _>>()?;
    let mut after = vec![Matrix2::identity(); parts.len()];
    for index in (1..parts.len()).rev() {
        after[index - 1] = after[index] * parts[index].0.a;
    }
    Ok(Parts { parts, after })
}

impl Parts {
    /// The map of the period, and what the errors of the parts make of it to first order.
    fn product(&self) -> Known {
        let (mut all, mut off) = (SideMap::IDENTITY, SideMap::ZERO);
        for ((next, error), after) in self.parts.iter().zip(&self.after) {
            off.a += after.abs() * error.a * all.a.abs();
            off.b += after.abs() * (error.a * all.b.abs() + error.b);
            all = next.after(&all);
        }
        (all, off)
    }

    /// How far a rounding in every flight moves the end of the period.
    fn amplify(&self, rounding: Vector2<f64>) -> Vector2<f64> {
        let first = self.after.first().zip(self.parts.first()).map(|(after, (part, _))| after * part.a);
        first.iter().chain(&self.after).map(|matrix| matrix.abs() * rounding).sum()
    }
}

/// How far a rounding at the start and one at the end move the end.
fn amplified_once(map: &OneSidedMap<'_>) -> Result<Vector2<f64>, SampleError> {
    let (scales, rounding) = (map.scales(), map.rounding());
    (0..2).try_fold(rounding, |sum, direction| {
        Ok(sum + difference(map, direction, scales[direction])?.abs() * rounding[direction])
    })
}

/// The map, with ends of stretches known to `rounding`.
fn differences(map: &OneSidedMap<'_>, rounding: Vector2<f64>) -> Result<Known, SampleError> {
    let mut columns = [(Vector2::zeros(), Vector2::zeros()); 3];
    for (direction, column) in columns.iter_mut().enumerate() {
        let step = widest(map, direction);
        *column = extrapolate(step, Powers::Even, |step| rounding / step, |step| difference(map, direction, step))?;
    }
    let [first, second, period] = columns;
    let value = SideMap { a: Matrix2::from_columns(&[first.0, second.0]), b: period.0 };
    let error = SideMap { a: Matrix2::from_columns(&[first.1, second.1]), b: period.1 };
    Ok((value, error))
}

/// The impacts' own scale in one direction, doubled while they remain the orbit's.
fn widest(map: &OneSidedMap<'_>, direction: usize) -> f64 {
    /// Doublings that are tried: a unit is about a thousandth of the velocity that an impact cannot lose.
    const DOUBLINGS: usize = 8;
    let steps = std::iter::successors(Some(map.scales()[direction]), |step| Some(2.0 * step)).take(1 + DOUBLINGS);
    let inside = steps.take_while(|step| difference(map, direction, *step).is_ok());
    inside.last().unwrap_or(map.scales()[direction])
}

fn difference(map: &OneSidedMap<'_>, direction: usize, step: f64) -> Result<Vector2<f64>, SampleError> {
    let mut perturbation = Vector3::zeros();
    perturbation[direction] = step;
    let (ahead, behind) = (map.sample(perturbation)?, map.sample(-perturbation)?);
    Ok((ahead.end - behind.end) / (ahead.perturbation - behind.perturbation)[direction])
}
