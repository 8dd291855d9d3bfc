//! Every corner impact of a range of speeds with its local map: by routes that must agree, and what happens there.
//!
//! What a corner does depends on the lowest derivative of the lift that jumps. Where that is the velocity, the map has a gap
//! and each side ends on its own; where it is the acceleration, two matrices meet and Feigin's classification tells the rest;
//! where it is a higher one, both sides have one matrix, and nothing happens to first order.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};

use crate::agreement::{Agreement, compare, compare_routes, worse};
use crate::border_collision::{Classification, Degenerate, classify};
use crate::cam::{Cam, Side};
use crate::corner::border::border;
use crate::corner::map::Uncertainty;
use crate::corner::one_sided::SampleError;
use crate::corner::range::{FoundCornerImpacts, RangeError, find_corner_impacts};
use crate::corner::varied::Varied;
use crate::corner::{CornerImpact, CornerMap, Route, SideMap};
use crate::corner::{closed_form, finite_difference, least_squares, variational};
use crate::model::{Model, ModelError, Study};
use crate::study::ModelLabel;
use crate::study::verify::Skipped;
use crate::tolerance::Comparison;

/// The corner impacts of a range of speeds: the document `corner-impact/locate/1`.
#[derive(Clone, Debug)]
pub struct Located {
    /// The model that was looked at.
    pub model: ModelLabel,
    /// Each corner impact, by rising speed.
    pub found: Vec<LocatedImpact>,
    /// What was looked at for them, and refused.
    pub looked_at: FoundCornerImpacts,
    /// The range, rpm.
    pub range: Study,
    /// Turns of the cam in one period of the orbits looked for.
    pub revolutions: u64,
    /// Whether the routes agree at every one; true where there is none.
    pub agrees: bool,
}

document!(Located as it {
    schema: "corner-impact/locate/1",
    model: it.model.name,
    source: it.model.source,
    rpm: [it.range.rpm_min, it.range.rpm_max],
    revolutions: it.revolutions,
    corner_impacts: it.found,
    rejected: it.looked_at.rejected,
    searched: Searched(&it.looked_at),
    agrees: it.agrees,
});

/// What was looked at, without what was found there.
struct Searched<'a>(&'a FoundCornerImpacts);

document!(Searched<'_> as it {
    corners_rad: it.0.corners.iter().map(|corner| corner.angle).collect::<Vec<_>>(),
    speeds_rpm: it.0.searched.speeds,
    branches: it.0.searched.branches,
    one_impact_exhaustive: true,
    several_impacts_exhaustive: false,
    failed: it.0.searched.failed,
});

/// A corner impact and its map.
#[derive(Clone, Debug)]
pub struct LocatedImpact {
    /// The orbit.
    pub at: CornerImpact,
    /// Its map by the product of propagators and saltation matrices; at a corner of velocity only `at.side` of it holds.
    pub map: CornerMap,
    /// What happens there.
    pub local: Happens,
    /// The routes pairwise.
    pub comparisons: Vec<Agreement>,
    /// Routes that did not run.
    pub skipped: Vec<Skipped>,
    /// Whether every comparison agrees and every route ran.
    pub agrees: bool,
}

document!(LocatedImpact as it {
    speed_rpm: it.at.speed_rpm(),
    period_s: it.at.period,
    orbit_period_s: it.at.period * it.at.cycle.revolutions as f64,
    revolutions: it.at.cycle.revolutions,
    impacts: it.at.cycle.contacts.len(),
    cam_angle_rad: it.at.corner.angle,
    jump_order: it.at.corner.jump_order,
    side: it.side(),
    state: [it.at.state.position, it.at.state.velocity],
    section_angle_rad: it.at.section_angle(),
    velocity_before_m_s: it.at.velocity_before,
    velocity_after_m_s: it.at.velocity_after,
    impact_angles_rad: it.at.cycle.contacts.iter().map(|contact| contact.cam_angle).collect::<Vec<_>>(),
    map: it.sides().map(|side| (side, it.map.of(side))).collect::<BTreeMap<_, _>>(),
    classification: it.local,
    agreement: it.comparisons,
    skipped: it.skipped,
    agrees: it.agrees,
});

impl LocatedImpact {
    /// The side whose orbit this is, where the velocity jumps.
    pub(crate) fn side(&self) -> Option<Side> {
        (self.at.corner.jump_order == 1).then_some(self.at.side)
    }

    /// The sides that have a map.
    fn sides(&self) -> impl Iterator<Item = Side> {
        [Side::Minus, Side::Plus].into_iter().filter(|side| self.side().is_none_or(|only| only == *side))
    }
}

/// What happens at a corner impact.
#[derive(Clone, Debug, PartialEq)]
pub enum Happens {
    /// Velocity jumps: impacts across the corner are thrown elsewhere.
    Gap,
    /// Acceleration jumps: two matrices meet on a border; Feigin's verdict, where there is one.
    BorderCollision(Result<Classification, Degenerate>),
    /// A higher derivative jumps: one matrix.
    Smooth,
}

impl Happens {
    /// Its name in documents.
    pub(crate) fn scenario(&self) -> String {
        match self {
            Self::Gap => "gap".into(),
            Self::BorderCollision(Ok(kind)) => kind.scenario.to_string(),
            Self::BorderCollision(Err(_)) => "degenerate".into(),
            Self::Smooth => "smooth".into(),
        }
    }

    /// What that is, in words; of a border collision its fixed points tell more.
    pub(crate) fn meaning(&self) -> String {
        match self {
            Self::BorderCollision(Ok(_)) => "two matrices meet on a border".into(),
            Self::BorderCollision(Err(degenerate)) => format!("Feigin's classification says nothing: {degenerate}"),
            Self::Gap => {
                "the cam's velocity jumps, and what an impact leaves the follower with jumps with it: this side's \
                          orbit ends here, and across the corner the map has a gap, not a second matrix"
                    .into()
            }
            Self::Smooth => {
                "only a derivative above the acceleration jumps: both sides have the same matrices, the map's \
                             derivative is continuous, and there is no border collision to first order"
                    .into()
            }
        }
    }
}

impl Serialize for Happens {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        struct Other(String, String);
        document!(Other as it { scenario: it.0, meaning: it.1 });
        match self {
            Self::BorderCollision(Ok(kind)) => kind.serialize(to),
            other => Other(other.scenario(), other.meaning()).serialize(to),
        }
    }
}

/// Why a range cannot be looked through.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LocateError {
    /// The cam.
    #[error("{0}")]
    Model(#[from] ModelError),
    /// The range.
    #[error(transparent)]
    Range(#[from] RangeError),
}

/// Finds every corner impact of orbits of `revolutions` in `range`, and computes its map by every route of this program.
pub fn locate(model: &Model, range: Study, revolutions: u64) -> Result<Located, LocateError> {
    let cam = Cam::new(model)?;
    let looked_at = find_corner_impacts(model, &cam, range, revolutions)?;
    let found: Vec<LocatedImpact> = looked_at.found.iter().map(|at| located(model, &cam, at)).collect();
    let agrees = found.iter().all(|located| located.agrees);
    Ok(Located { model: ModelLabel::of(model), found, looked_at, range, revolutions, agrees })
}

/// A corner impact with its map by each route that its corner has.
fn located(model: &Model, cam: &Cam, at: &CornerImpact) -> LocatedImpact {
    let exact = variational::route(model, cam, at);
    let (map, border) = (exact.map, border(model, cam, at));
    let (mut comparisons, mut skipped) = (Vec::new(), Vec::new());
    let mut routes = vec![exact];
    let mut keep = |name: &str, route: Result<Route, SampleError>| {
        let fail =
            |error: SampleError| skipped.push(Skipped { route: name.into(), why: error.to_string(), failed: true });
        route.map_err(fail).ok()
    };
    let local = match at.corner.jump_order {
        1 => {
            comparisons.extend(keep("finite_difference", one_side(model, cam, at)).into_iter().flat_map(|route| {
                let (name, one, other) = match at.side {
                    Side::Minus => ("minus", map.minus, route.map.minus),
                    Side::Plus => ("plus", map.plus, route.map.plus),
                };
                compare_sides(name, &one, &other)
            }));
            Happens::Gap
        }
        order => {
            if at.is_simple() {
                routes.push(closed_form::route(model, at));
            }
            routes.extend(keep("finite_difference", finite_difference::route(model, cam, at)));
            if order == 2 {
                routes.extend(keep("least_squares", least_squares::route(model, cam, at)));
            }
            let (known, unknown) = split_by_knowledge(compare_routes(&routes), &routes);
            comparisons.extend(known);
            skipped.extend(unknown);
            if order == 2 {
                comparisons.extend(routes.iter().find(|route| route.name == "finite_difference").map(|route| {
                    let ((e, f), c, d) = (border, route.map.c(), route.map.d());
                    let names = [route.name, "flight"];
                    compare(names, "border", [(c * f).as_slice(), (e * d).as_slice()], Comparison::Routes)
                }));
                Happens::BorderCollision(classify(&map, border))
            } else {
                Happens::Smooth
            }
        }
    };
    let agrees = skipped.iter().all(|skipped| !skipped.failed) && comparisons.iter().all(|item| item.agrees);
    LocatedImpact { at: at.clone(), map, local, comparisons, skipped, agrees }
}

/// The estimate of the side that the impact is on, in the place of both.
fn one_side(model: &Model, cam: &Cam, at: &CornerImpact) -> Result<Route, SampleError> {
    let (side, _) = finite_difference::side_map(model, cam, at, at.side, &Varied::Period)?;
    Ok(Route { name: "finite_difference", map: CornerMap { minus: side, plus: side }, uncertainty: None })
}

/// The comparisons but for those with an estimate that says itself that it knows the quantity less closely than is asked,
/// and which those are. Over a whole period of several impacts, and next to a graze, rounding is amplified as deviations are.
///
/// A fit is left out wherever it says so: it would be no check. The differences add up the largest that every rounding can
/// do, and are mostly closer than that: they are left out only where they miss by no more than they say.
fn split_by_knowledge(mut comparisons: Vec<Agreement>, routes: &[Route]) -> (Vec<Agreement>, Vec<Skipped>) {
    let mut skipped = Vec::new();
    for route in routes {
        let Some(uncertainty) = &route.uncertainty else { continue };
        let is_unknown = |item: &Agreement| {
            let known_to = known_to(uncertainty, &item.quantity);
            let misses = match uncertainty {
                Uncertainty::Fit { .. } => true,
                Uncertainty::Extrapolation(_) => !item.agrees && item.max_abs_diff <= known_to,
            };
            item.routes.iter().any(|name| name == route.name) && misses && !(known_to <= item.bound.value)
        };
        let (unknown, known): (Vec<Agreement>, Vec<Agreement>) = comparisons.into_iter().partition(is_unknown);
        comparisons = known;
        skipped.extend(unknown.first().map(|item| {
            let (quantity, known_to, asked) = (&item.quantity, known_to(uncertainty, &item.quantity), item.bound.value);
            let why = format!("knows {quantity} to {known_to:.1e} by its own errors, and {asked:.1e} is asked for");
            Skipped { route: route.name.into(), why, failed: false }
        }));
    }
    (comparisons, skipped)
}

/// Three standard errors and the bias of a fit's worst entry of a quantity, or the error of an extrapolation's; of what
/// derives from A and B, of both sides.
fn known_to(uncertainty: &Uncertainty, quantity: &str) -> f64 {
    let worst = |entries: &[f64]| entries.iter().fold(0.0, |size, entry| worse(size, entry.abs()));
    let side = |error: &SideMap, in_b: bool| if in_b { worst(error.b.as_slice()) } else { worst(error.a.as_slice()) };
    let both = |minus: bool, plus: bool, in_b: bool| {
        let of = |map: &CornerMap| {
            let sides = [(minus, &map.minus), (plus, &map.plus)];
            sides.into_iter().filter(|(counts, _)| *counts).map(|(_, error)| side(error, in_b)).fold(0.0, worse)
        };
        match uncertainty {
            Uncertainty::Fit { standard, systematic, .. } => 3.0 * of(standard) + systematic.as_ref().map_or(0.0, of),
            Uncertainty::Extrapolation(error) => of(error),
        }
    };
    match quantity {
        "A_minus" | "eigenvalues_minus" => both(true, false, false),
        "A_plus" | "eigenvalues_plus" => both(false, true, false),
        "B_minus" => both(true, false, true),
        "B_plus" => both(false, true, true),
        "C" => both(true, true, false),
        _ => both(true, true, true),
    }
}

fn compare_sides(name: &str, one: &SideMap, other: &SideMap) -> [Agreement; 2] {
    let routes = ["variational", "finite_difference"];
    let (a, b) = (format!("A_{name}"), format!("B_{name}"));
    [
        compare(routes, &a, [one.a.as_slice(), other.a.as_slice()], Comparison::Routes),
        compare(routes, &b, [one.b.as_slice(), other.b.as_slice()], Comparison::Routes),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sides(a: f64) -> CornerMap {
        let side = SideMap { a: nalgebra::Matrix2::repeat(a), b: nalgebra::Vector2::repeat(1.0) };
        CornerMap { minus: side, plus: side }
    }

    #[test]
    fn an_estimate_that_misses_by_more_than_it_says_disagrees() {
        let exact = Route { name: "variational", map: sides(1.0), uncertainty: None };
        for (off, said, is_kept) in [(1e-4, 2e-4, false), (2e-4, 1e-4, true), (1e-12, 2e-4, true)] {
            let error = Some(Uncertainty::Extrapolation(sides(said)));
            let estimate = Route { name: "finite_difference", map: sides(1.0 + off), uncertainty: error };
            let routes = [exact.clone(), estimate];
            let (kept, skipped) = split_by_knowledge(compare_routes(&routes), &routes);
            assert_eq!(kept.iter().any(|item| item.quantity == "A_minus"), is_kept, "{off} {said}");
            assert_eq!(skipped.is_empty(), is_kept);
        }
    }
}
