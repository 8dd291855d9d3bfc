//! A and B by central differences of simulated periods, extrapolated to step 0.
//!
//! The error of a central difference is a series of even powers of the step; its rounding grows as the step shrinks.
//!
//! Over a period of several impacts rounding grows as deviations do. Therefore such an orbit is also differenced from the middle of each
//! flight to the middle of the next, and the parts are multiplied. Each entry is taken from the more accurate of the two results.
//!
//! Near a graze an impact amplifies rounding by the inverse of its relative velocity. The error estimate includes this at every impact. The
//! first steps are as wide as possible without changing the sequence of impacts.

use nalgebra::{Matrix2, RowVector2, RowVector3, Vector2, Vector3};

use super::corner_impact::CornerImpact;
use super::extrapolation::{Powers, extrapolate};
use super::map::{Own, Route, RouteName, SideMap, Sides, Uncertainty};
use super::one_sided::{OneSidedMap, SampleError};
use super::varied::Varied;
use crate::cam::{Cam, Side};
use crate::model::Model;

/// Computes the map by extrapolated central differences, with the last correction of each entry.
pub fn route(model: &Model, cam: &Cam, at: &CornerImpact) -> Result<Route, SampleError> {
    route_by(model, cam, at, &Varied::Period)
}

/// Computes the map by extrapolated central differences, with B for any number of the model.
pub fn route_by(model: &Model, cam: &Cam, at: &CornerImpact, varied: &Varied) -> Result<Route, SampleError> {
    let found = Sides::try_of_each(|side| side_map(model, cam, at, side, varied))?;
    let uncertainty = Some(Uncertainty::Extrapolation(found.map(|(_, error)| error.map)));
    let (map, own) = (found.map(|(known, _)| known.map), own(found.of(at.side)));
    Ok(Route { name: RouteName::FiniteDifference, map, own, uncertainty })
}

/// Computes one side's map and the error of each entry. With several impacts it is differenced both over the whole period and impact by
/// impact; each entry is taken from the more accurate result.
pub fn side_map(
    model: &Model,
    cam: &Cam,
    at: &CornerImpact,
    side: Side,
    varied: &Varied,
) -> Result<Evidence, SampleError> {
    let whole = OneSidedMap::by(model, cam, at, side, varied);
    if at.cycle.impacts.len() == 1 {
        return whole.and_then(|map| differences(&map, amplified_once(&map)?));
    }
    let parts = by_impacts(model, cam, at, side, varied);
    let whole = whole.and_then(|map| {
        let amplified = match &parts {
            Ok(parts) => parts.amplify(rounding(&map)),
            Err(_) => amplified_once(&map)?,
        };
        differences(&map, amplified)
    });
    Ok(match (whole, parts.map(|parts| parts.product())) {
        (Ok(whole), Ok(parts)) => {
            let (mut best, mut error) = whole;
            better(best.map.a.as_mut_slice(), error.map.a.as_mut_slice(), &parts.0.map.a, &parts.1.map.a);
            better(best.map.b.as_mut_slice(), error.map.b.as_mut_slice(), &parts.0.map.b, &parts.1.map.b);
            better(best.gap.as_mut_slice(), error.gap.as_mut_slice(), &parts.0.gap, &parts.1.gap);
            (best, error)
        }
        (Ok(found), Err(_)) | (Err(_), Ok(found)) => found,
        (Err(failure), Err(_)) => return Err(failure),
    })
}

/// Result of the differences, or its error: the map, and the derivatives of the gap at the corner with respect to the start and the period.
#[derive(Clone, Copy)]
pub struct Differenced {
    /// The map.
    pub map: SideMap,
    /// `(e1, e2, f)`.
    pub gap: RowVector3<f64>,
}

/// The value and the error of each entry.
type Evidence = (Differenced, Differenced);

/// Returns the border, on which the gap is 0.
pub(crate) fn own((found, error): &Evidence) -> Own {
    let border = (RowVector2::new(found.gap[0], found.gap[1]), found.gap[2]);
    Own { border_error: Some(error.gap.max()), ..Own::border(border) }
}

/// Period as the product of its parts, each with one impact.
struct Parts {
    parts: Vec<Evidence>,
    /// Product of the matrices A after each part; the identity for the last part.
    after: Vec<Matrix2<f64>>,
}

fn by_impacts(model: &Model, cam: &Cam, at: &CornerImpact, side: Side, varied: &Varied) -> Result<Parts, SampleError> {
    let pieces = OneSidedMap::pieces(model, cam, at, side, varied)?;
    let known = |piece: &OneSidedMap<'_>| differences(piece, amplified_once(piece)?);
    let parts = pieces.iter().map(known).collect::<Result<Vec<_>, _>>()?;
    let mut after = vec![Matrix2::identity(); parts.len()];
    for index in (1..parts.len()).rev() {
        after[index - 1] = after[index] * parts[index].0.map.a;
    }
    Ok(Parts { parts, after })
}

impl Parts {
    /// Map of the period, and its error from the errors of the parts, to first order.
    fn product(&self) -> Evidence {
        let (mut all, mut off) = (SideMap::IDENTITY, SideMap::ZERO);
        let (mut gap, mut gap_off) = (RowVector3::zeros(), RowVector3::zeros());
        for ((next, error), after) in self.parts.iter().zip(&self.after) {
            // Only one part contains the corner: the others have no gap and no error of it.
            gap += by_start(&next.gap, &all);
            gap_off += by_start(&error.gap, &SideMap { a: all.a.abs(), b: all.b.abs() });
            // Error of the parts before it, which shift its start.
            gap_off += by_start(&next.gap.abs().component_mul(&RowVector3::new(1.0, 1.0, 0.0)), &off);
            off.a += after.abs() * error.map.a * all.a.abs();
            off.b += after.abs() * (error.map.a * all.b.abs() + error.map.b);
            all = next.map.after(&all);
        }
        (Differenced { map: all, gap }, Differenced { map: off, gap: gap_off })
    }

    /// Shift of the period's end and of the gap caused by a rounding in every flight.
    fn amplify(&self, rounding: Vector3<f64>) -> Vector3<f64> {
        let flights = rounding.xy();
        let first = self.after.first().zip(self.parts.first()).map(|(after, (part, _))| after * part.map.a);
        let end: Vector2<f64> = first.iter().chain(&self.after).map(|matrix| matrix.abs() * flights).sum();
        let (mut by_state, mut gap) = (RowVector2::zeros(), rounding[2]);
        // Backwards from the part that contains the corner to the start.
        for (part, _) in self.parts.iter().rev() {
            by_state = by_state * part.map.a + RowVector2::new(part.gap[0], part.gap[1]);
            gap += (by_state.abs() * flights)[0];
        }
        end.push(gap)
    }
}

/// Converts derivatives of a gap with respect to the start of its part into derivatives with respect to the start of all parts; `before`
/// maps the latter start to the former.
fn by_start(gap: &RowVector3<f64>, before: &SideMap) -> RowVector3<f64> {
    let (e, f) = (RowVector2::new(gap[0], gap[1]), gap[2]);
    let state = e * before.a;
    RowVector3::new(state[0], state[1], (e * before.b)[0] + f)
}

/// Takes each entry from the result with the smaller error.
fn better<'a>(
    best: &mut [f64],
    error: &mut [f64],
    other: impl IntoIterator<Item = &'a f64>,
    other_error: impl IntoIterator<Item = &'a f64>,
) {
    let others = other.into_iter().zip(other_error);
    for ((best, error), (other, other_error)) in best.iter_mut().zip(error).zip(others) {
        if other_error < error {
            (*best, *error) = (*other, *other_error);
        }
    }
}

/// Rounding error of the end of a part, and of the gap.
fn rounding(map: &OneSidedMap<'_>) -> Vector3<f64> {
    map.rounding().push(map.gap_rounding())
}

/// Error of the end and of the gap from one rounding at the start and one at the end.
fn amplified_once(map: &OneSidedMap<'_>) -> Result<Vector3<f64>, SampleError> {
    let (scales, rounding) = (map.scales(), rounding(map));
    (0..2).try_fold(rounding, |sum, direction| {
        Ok(sum + difference(map, direction, scales[direction])?.abs() * rounding[direction])
    })
}

/// Computes the map by extrapolated differences; `rounding` is the rounding error of ends and gaps.
fn differences(map: &OneSidedMap<'_>, rounding: Vector3<f64>) -> Result<Evidence, SampleError> {
    let mut columns = [(Vector3::zeros(), Vector3::zeros()); 3];
    for (direction, column) in columns.iter_mut().enumerate() {
        let step = widest(map, direction);
        *column = extrapolate(step, Powers::Even, |step| rounding / step, |step| difference(map, direction, step))?;
    }
    let differenced = |[first, second, period]: [Vector3<f64>; 3]| Differenced {
        map: SideMap { a: Matrix2::from_columns(&[first.xy(), second.xy()]), b: period.xy() },
        gap: RowVector3::new(first[2], second[2], period[2]),
    };
    Ok((differenced(columns.map(|(value, _)| value)), differenced(columns.map(|(_, error)| error))))
}

/// Widest step in one direction: the impacts' scale, doubled while the impacts remain those of the orbit.
fn widest(map: &OneSidedMap<'_>, direction: usize) -> f64 {
    /// Largest number of doublings: a unit is about a thousandth of the velocity that an impact cannot lose.
    const DOUBLINGS: usize = 8;
    let steps = std::iter::successors(Some(map.scales()[direction]), |step| Some(2.0 * step)).take(1 + DOUBLINGS);
    let inside = steps.take_while(|step| difference(map, direction, *step).is_ok());
    inside.last().unwrap_or(map.scales()[direction])
}

/// Central difference of the end, and of the gap when the corner passes.
fn difference(map: &OneSidedMap<'_>, direction: usize, step: f64) -> Result<Vector3<f64>, SampleError> {
    let mut perturbation = Vector3::zeros();
    perturbation[direction] = step;
    let (ahead, behind) = (map.sample(perturbation)?, map.sample(-perturbation)?);
    let change = (ahead.end - behind.end).push(map.gap(&ahead) - map.gap(&behind));
    Ok(change / (ahead.perturbation - behind.perturbation)[direction])
}
