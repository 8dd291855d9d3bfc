//! The map of a corner impact by every route of this program that its corner has, and the comparison of the routes.

use std::fmt::Display;

use serde::Serialize;

use crate::agreement::{Agreement, Quantity, compare_routes, worse};
use crate::border_collision::{Classification, Danger, LocalMap, Refusal, classify};
use crate::cam::{Cam, Side};
use crate::corner::map::{LinearForm, RouteName, Uncertainty};
use crate::corner::one_sided::SampleError;
use crate::corner::varied::Varied;
use crate::corner::{CornerImpact, CornerMap, Route, SideMap};
use crate::corner::{closed_form, finite_difference, least_squares, variational};
use crate::model::Model;

/// A route or result that was not computed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Skipped {
    /// The route, or the result that it would have given.
    pub route: String,
    /// Reason.
    pub why: String,
    /// Whether it should have run. If so, the verification as a whole disagrees.
    pub failed: bool,
}

/// Routes and results that were left out or failed.
#[derive(Default)]
pub struct Log(pub Vec<Skipped>);

impl Log {
    pub(super) fn leave_out(&mut self, route: impl Display, why: impl Display) {
        self.0.push(Skipped { route: route.to_string(), why: why.to_string(), failed: false });
    }

    pub(super) fn refused<T>(&mut self, route: &str, result: &Result<T, impl Display>) {
        if let Err(why) = result {
            self.leave_out(route, why);
        }
    }

    pub(super) fn fail(&mut self, route: impl Display, why: impl Display) {
        self.0.push(Skipped { route: route.to_string(), why: why.to_string(), failed: true });
    }

    pub(super) fn keep<T>(&mut self, route: impl Display, result: Result<T, impl Display>) -> Option<T> {
        result.map_err(|error| self.fail(route, error)).ok()
    }

    /// Whether everything that should have run did run, and all comparisons agree.
    pub(super) fn agrees(&self, comparisons: &[Agreement]) -> bool {
        self.0.iter().all(|skipped| !skipped.failed) && comparisons.iter().all(|item| item.agrees)
    }
}

/// Computes the map of `at` by every route of this program that its corner has. Also returns the side on which the follower sticks, where
/// simulation finds no map.
///
/// The closed form covers the paper's orbits only. A polynomial is fitted if two matrices meet. If the velocity jumps, the differences
/// have only the side of the impact.
pub(super) fn routes(model: &Model, cam: &Cam, at: &CornerImpact, log: &mut Log) -> (Vec<Route>, Option<Side>) {
    let order = at.corner.jump_order;
    let mut routes = Vec::new();
    if at.is_simple() {
        routes.push(closed_form::route(model, at));
    }
    routes.push(variational::route(model, cam, at));
    let differenced = match order {
        1 => one_side(model, cam, at),
        _ => finite_difference::route(model, cam, at),
    };
    let sticking = match &differenced {
        Err(SampleError::OtherImpacts { side, sticks: true, .. }) => Some(*side),
        _ => None,
    };
    routes.extend(log.keep(RouteName::FiniteDifference, differenced));
    if order == 2 {
        routes.extend(log.keep(RouteName::LeastSquares, least_squares::route(model, cam, at)));
    }
    (routes, sticking)
}

/// Classifies a corner impact whose map is `map`. Refuses if the follower sticks to the cam on one side next to it.
pub(super) fn classified(
    map: &CornerMap,
    border: LinearForm,
    sticking: Option<Side>,
) -> Result<Classification, Refusal> {
    match sticking {
        Some(side) => Err(Refusal::Sticking { side }),
        None => Ok(classify(map, border)?),
    }
}

/// Returns the danger at a corner impact where the acceleration jumps, if the follower flies off the cam next to it.
pub(super) fn danger(model: &Model, cam: &Cam, at: &CornerImpact) -> Option<Danger> {
    let (map, border) = (variational::route(model, cam, at).map, variational::border(model, cam, at));
    classify(&map, border).ok()?;
    let local = LocalMap::new(&map, border);
    let danger = local.danger(&local.outcomes(), at.period)?;
    // The simulation runs only if there is a danger to report.
    let (_, sticking) = routes(model, cam, at, &mut Log::default());
    sticking.is_none().then_some(danger)
}

/// Returns the estimate of the impact's side in the place of both sides.
fn one_side(model: &Model, cam: &Cam, at: &CornerImpact) -> Result<Route, SampleError> {
    let found = finite_difference::side_map(model, cam, at, at.side, &Varied::Period)?;
    let both = |side| CornerMap { minus: side, plus: side };
    let uncertainty = Some(Uncertainty::Extrapolation(both(found.1.map)));
    let (map, own) = (both(found.0.map), finite_difference::own(&found));
    Ok(Route { name: RouteName::FiniteDifference, map, own, uncertainty })
}

/// Compares every pair of routes in every quantity that both have. If the velocity jumps, only the impact's side is compared.
pub(super) fn comparisons(at: &CornerImpact, routes: &[Route], log: &mut Log) -> Vec<Agreement> {
    let mut all = compare_routes(routes);
    if at.corner.jump_order == 1 {
        all.retain(|item| [Quantity::A(at.side), Quantity::B(at.side), Quantity::Border].contains(&item.quantity));
    }
    split_by_knowledge(all, routes, log)
}

/// Returns the comparisons without those that an estimate cannot decide, because its own uncertainty in the quantity exceeds the bound.
/// Logs one left-out quantity for each route. Over a whole period of several impacts, and next to a graze, rounding is amplified as
/// deviations are.
///
/// A fit with too large an uncertainty is always left out: it would not test anything. The differences state the largest error that all
/// roundings together can cause, and are mostly closer. They are left out only if they disagree by no more than that error.
pub fn split_by_knowledge(mut comparisons: Vec<Agreement>, routes: &[Route], log: &mut Log) -> Vec<Agreement> {
    for route in routes {
        let Some(uncertainty) = &route.uncertainty else { continue };
        let is_unknown = |item: &Agreement| {
            let known_to = known_to(route, uncertainty, item.quantity);
            let misses = match uncertainty {
                Uncertainty::Fit { .. } => true,
                Uncertainty::Extrapolation(_) => !item.agrees && item.max_abs_diff <= known_to,
            };
            item.routes.contains(&route.name) && misses && !(known_to <= item.bound.value)
        };
        let (unknown, known): (Vec<Agreement>, Vec<Agreement>) = comparisons.into_iter().partition(is_unknown);
        comparisons = known;
        if let Some(item) = unknown.first() {
            let (quantity, known_to, asked) =
                (item.quantity, known_to(route, uncertainty, item.quantity), item.bound.value);
            let why = format!("knows {quantity} to {known_to:.1e} by its own errors, but {asked:.1e} is required");
            log.leave_out(route.name, why);
        }
    }
    comparisons
}

/// Returns the uncertainty of a quantity. For a fit it is three standard errors and the bias of the worst entry, for an extrapolation its
/// error. For quantities derived from A and B it covers both sides.
fn known_to(route: &Route, uncertainty: &Uncertainty, quantity: Quantity) -> f64 {
    if quantity == Quantity::Border {
        return route.own.border_error.unwrap_or(0.0);
    }
    let worst = |entries: &[f64]| entries.iter().fold(0.0, |size, entry| worse(size, entry.abs()));
    let a = |side: &SideMap| worst(side.a.as_slice());
    let b = |side: &SideMap| worst(side.b.as_slice());
    let of = |error: &CornerMap| match quantity {
        Quantity::A(side) | Quantity::Eigenvalues(side) => a(error.of(side)),
        Quantity::B(side) => b(error.of(side)),
        Quantity::C => worse(a(&error.minus), a(&error.plus)),
        _ => worse(b(&error.minus), b(&error.plus)),
    };
    match uncertainty {
        Uncertainty::Fit { standard, systematic, .. } => 3.0 * of(standard) + systematic.as_ref().map_or(0.0, of),
        Uncertainty::Extrapolation(error) => of(error),
    }
}
