//! Routes pairwise, quantity by quantity, against the one table of tolerances.
//!
//! Nothing is compared with itself, nothing that did not run is compared at all, and what is not a number disagrees.

use nalgebra::Vector2;
use serde::Serialize;

use crate::corner::map::{CornerMap, Eigenvalue, Route};
use crate::tolerance::{Bound, Comparison, agreement_bound};

/// One quantity by two routes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Agreement {
    /// The two routes.
    pub routes: [String; 2],
    /// What was compared.
    pub quantity: String,
    /// Largest absolute difference of any entry.
    pub max_abs_diff: f64,
    /// Largest difference of any entry, over that entry.
    pub max_rel_diff: f64,
    /// Most that `max_abs_diff` may be, and why.
    #[serde(flatten)]
    pub bound: Bound,
    /// Whether it is less.
    pub agrees: bool,
}

/// Compares the entries of one quantity, on the scale of its largest entry.
pub fn compare(routes: [&str; 2], quantity: &str, entries: [&[f64]; 2], comparison: Comparison) -> Agreement {
    let scale = entries.iter().map(|entries| size(entries)).fold(0.0, f64::max);
    compare_on_scale(routes, quantity, entries, comparison, scale)
}

/// The larger of two; not a number if either is not, which [`f64::max`] would pass over.
pub fn worse(one: f64, other: f64) -> f64 {
    if one.is_nan() || other.is_nan() { f64::NAN } else { one.max(other) }
}

fn size(entries: &[f64]) -> f64 {
    entries.iter().fold(0.0_f64, |size, entry| size.max(entry.abs()))
}

fn compare_on_scale(
    routes: [&str; 2],
    quantity: &str,
    [left, right]: [&[f64]; 2],
    comparison: Comparison,
    scale: f64,
) -> Agreement {
    let bound = agreement_bound(comparison, scale);
    let mut max_abs_diff = if left.len() == right.len() { 0.0 } else { f64::NAN };
    let mut max_rel_diff = max_abs_diff;
    for (a, b) in left.iter().zip(right) {
        let diff = (a - b).abs();
        let size = a.abs().max(b.abs());
        max_abs_diff = worse(max_abs_diff, diff);
        let relative = if diff == 0.0 { 0.0 } else { diff / size };
        max_rel_diff = worse(max_rel_diff, relative);
    }
    Agreement {
        routes: routes.map(String::from),
        quantity: quantity.into(),
        max_abs_diff,
        max_rel_diff,
        agrees: max_abs_diff < bound.value || max_abs_diff == 0.0,
        bound,
    }
}

/// The quantities of a map that routes are compared in: name and entries, rows first.
pub fn quantities(map: &CornerMap) -> Vec<(&'static str, Vec<f64>)> {
    let rows = |matrix: nalgebra::Matrix2<f64>| matrix.transpose().as_slice().to_vec();
    let flat = |pair: [Eigenvalue; 2]| pair.iter().flat_map(|value| [value.re, value.im]).collect();
    vec![
        ("A_minus", rows(map.minus.a)),
        ("A_plus", rows(map.plus.a)),
        ("B_minus", map.minus.b.as_slice().to_vec()),
        ("B_plus", map.plus.b.as_slice().to_vec()),
        ("C", map.c().as_slice().to_vec()),
        ("D", vec![map.d()]),
        ("eigenvalues_minus", flat(map.minus.eigenvalues())),
        ("eigenvalues_plus", flat(map.plus.eigenvalues())),
    ]
}

/// Every pair of routes to the map, in every quantity.
pub fn compare_routes(routes: &[Route]) -> Vec<Agreement> {
    pairs(routes)
        .flat_map(|(left, right)| {
            let (these, those) = (quantities(&left.map), quantities(&right.map));
            // C and D are differences of A's and B's entries, and known no better than those.
            let integrated = is_integrated(left.name) || is_integrated(right.name);
            let of = |route: &Route| {
                let sides = [&route.map.minus, &route.map.plus];
                let a = sides.map(|side| size(side.a.as_slice())).into_iter().fold(0.0, f64::max);
                (a, sides.map(|side| size(side.b.as_slice())).into_iter().fold(0.0, f64::max))
            };
            let ((a, b), (other_a, other_b)) = (of(left), of(right));
            let (a, b) = (a.max(other_a), b.max(other_b));
            let compare = move |((quantity, x), (_, y)): ((&'static str, Vec<f64>), (_, Vec<f64>))| {
                let comparison = match quantity {
                    "eigenvalues_minus" | "eigenvalues_plus" => Comparison::Eigenvalues,
                    _ if integrated => Comparison::Integrated,
                    _ => Comparison::Routes,
                };
                let scale = match quantity {
                    "C" => a,
                    "D" => b,
                    _ => size(&x).max(size(&y)),
                };
                compare_on_scale([left.name, right.name], quantity, [&x, &y], comparison, scale)
            };
            these.into_iter().zip(those).map(compare).collect::<Vec<_>>()
        })
        .collect()
}

/// Whether a route steps a differential equation through time, and so has an integrator's error.
fn is_integrated(route: &str) -> bool {
    route == "scipy"
}

/// An orbit by one route: name, x* and T*.
pub type NamedOrbit = (&'static str, Vector2<f64>, f64);

/// Every pair of routes to the orbit.
pub fn compare_orbits(orbits: &[NamedOrbit]) -> Vec<Agreement> {
    pairs(orbits)
        .flat_map(|((left, x, t), (right, y, u))| {
            let integrated = is_integrated(left) || is_integrated(right);
            let comparison = if integrated { Comparison::IntegratedOrbit } else { Comparison::Orbit };
            [
                compare([*left, *right], "T_star", [&[*t], &[*u]], comparison),
                compare([*left, *right], "x_star", [x.as_slice(), y.as_slice()], comparison),
            ]
        })
        .collect()
}

fn pairs<T>(items: &[T]) -> impl Iterator<Item = (&T, &T)> {
    items.iter().enumerate().flat_map(|(index, left)| items[index + 1..].iter().map(move |right| (left, right)))
}

/// How many decimals two numbers share whose difference is `diff`: they differ by less than half a unit in that place.
///
/// `None` when they are equal to the last digit; at least 0.
pub fn shared_decimals(diff: f64) -> Option<u32> {
    (diff != 0.0).then(|| if diff.is_finite() { (-(2.0 * diff).log10()).floor().max(0.0) as u32 } else { 0 })
}
