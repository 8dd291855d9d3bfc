//! Pairwise comparison of routes, quantity by quantity, against the one table of tolerances.
//!
//! No route is compared with itself or with a route that did not run. A value that is not a number disagrees.

use nalgebra::Vector2;
use std::fmt;

use serde::{Serialize, Serializer};

use crate::cam::Side;
use crate::corner::map::{Eigenvalue, Route, RouteName};
use crate::elementary;
use crate::tolerance::{Bound, Comparison, agreement_bound};

/// Quantity that is compared. The letters are the paper's, and a hat marks its own estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Quantity {
    Period,
    State,
    Speed,
    A(Side),
    B(Side),
    C,
    D,
    Eigenvalues(Side),
    Border,
    AHat(Side),
    BHat(Side),
    BTilde,
    ABar(Side),
    BBar,
    CBar,
}

impl Quantity {
    /// Returns the letter in documents, and the side where there is one.
    pub fn parts(self) -> (&'static str, Option<Side>) {
        match self {
            Self::Period => ("T_star", None),
            Self::State => ("x_star", None),
            Self::Speed => ("speed_rpm", None),
            Self::A(side) => ("A", Some(side)),
            Self::B(side) => ("B", Some(side)),
            Self::C => ("C", None),
            Self::D => ("D", None),
            Self::Eigenvalues(side) => ("eigenvalues", Some(side)),
            Self::Border => ("border", None),
            Self::AHat(side) => ("A_hat", Some(side)),
            Self::BHat(side) => ("B_hat", Some(side)),
            Self::BTilde => ("B_tilde", None),
            Self::ABar(side) => ("A_bar", Some(side)),
            Self::BBar => ("B_bar", None),
            Self::CBar => ("C_bar", None),
        }
    }

    /// Whether the quantity is A or B of either side.
    pub(crate) fn is_of_the_map(self) -> bool {
        matches!(self, Self::A(_) | Self::B(_))
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.parts() {
            (letter, Some(side)) => write!(f, "{letter}_{side}"),
            (letter, None) => f.write_str(letter),
        }
    }
}

impl Serialize for Quantity {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(self)
    }
}

/// One quantity by two routes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Agreement {
    /// The two routes.
    pub routes: [RouteName; 2],
    /// Quantity compared.
    pub quantity: Quantity,
    /// Whether both routes compute the quantity from their A and B by one function. Then it agrees where A and B do, and tests nothing more.
    pub follows: bool,
    /// Largest absolute difference of any entry.
    pub max_abs_diff: f64,
    /// Largest relative difference of any entry.
    pub max_rel_diff: f64,
    /// Largest allowed `max_abs_diff`, with the reason.
    #[serde(flatten)]
    pub bound: Bound,
    /// Whether `max_abs_diff` is within the bound.
    pub agrees: bool,
}

/// Compares the entries of one quantity, on the scale of its largest entry.
pub fn compare(routes: [RouteName; 2], quantity: Quantity, entries: [&[f64]; 2], comparison: Comparison) -> Agreement {
    let scale = entries.iter().map(|entries| size(entries)).fold(0.0, f64::max);
    compare_on_scale(routes, quantity, entries, comparison, scale)
}

/// Returns the larger of two numbers, or NaN if either is NaN, which [`f64::max`] would ignore.
pub fn worse(one: f64, other: f64) -> f64 {
    if one.is_nan() || other.is_nan() { f64::NAN } else { one.max(other) }
}

fn size(entries: &[f64]) -> f64 {
    entries.iter().fold(0.0_f64, |size, entry| size.max(entry.abs()))
}

fn compare_on_scale(
    routes: [RouteName; 2],
    quantity: Quantity,
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
        routes,
        quantity,
        follows: false,
        max_abs_diff,
        max_rel_diff,
        agrees: max_abs_diff < bound.value || max_abs_diff == 0.0,
        bound,
    }
}

/// Result of a route for one quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct RouteValue {
    /// The quantity.
    pub quantity: Quantity,
    /// The entries, row by row.
    pub entries: Vec<f64>,
    /// Whether the route finds the quantity by a method of its own, instead of from its A and B as others do.
    pub is_own: bool,
}

/// Returns the quantities in which routes are compared, with the values of one route.
pub fn quantities(route: &Route) -> Vec<RouteValue> {
    let (map, own) = (&route.map, &route.own);
    let rows = |matrix: nalgebra::Matrix2<f64>| matrix.transpose().as_slice().to_vec();
    let flat = |pair: [Eigenvalue; 2]| pair.iter().flat_map(|value| [value.re, value.im]).collect();
    let (derived, both) = (own.eigenvalues.is_some(), route.eigenvalues());
    let found = |quantity, entries, is_own| RouteValue { quantity, entries, is_own };
    let border = own.border.map(|(e, f)| found(Quantity::Border, vec![e[0], e[1], f], true));
    let all = [
        found(Quantity::A(Side::Minus), rows(map.minus.a), true),
        found(Quantity::A(Side::Plus), rows(map.plus.a), true),
        found(Quantity::B(Side::Minus), map.minus.b.as_slice().to_vec(), true),
        found(Quantity::B(Side::Plus), map.plus.b.as_slice().to_vec(), true),
        found(Quantity::C, route.c().as_slice().to_vec(), own.jump.is_some()),
        found(Quantity::D, vec![route.d()], own.jump.is_some()),
        found(Quantity::Eigenvalues(Side::Minus), flat(both.minus), derived),
        found(Quantity::Eigenvalues(Side::Plus), flat(both.plus), derived),
    ];
    all.into_iter().chain(border).collect()
}

/// Compares every pair of routes to the map, in every quantity.
pub fn compare_routes(routes: &[Route]) -> Vec<Agreement> {
    pairs(routes)
        .flat_map(|(left, right)| {
            let (these, those) = (quantities(left), quantities(right));
            // C and D are differences of entries of A and B, and no more accurate than those.
            let integrated = is_integrated(left.name) || is_integrated(right.name);
            let of = |route: &Route| {
                let sides = [&route.map.minus, &route.map.plus];
                let a = sides.map(|side| size(side.a.as_slice())).into_iter().fold(0.0, f64::max);
                (a, sides.map(|side| size(side.b.as_slice())).into_iter().fold(0.0, f64::max))
            };
            let ((a, b), (other_a, other_b)) = (of(left), of(right));
            let (a, b) = (a.max(other_a), b.max(other_b));
            let compare = move |(x, y): (RouteValue, RouteValue)| {
                let comparison = match x.quantity {
                    Quantity::Eigenvalues(_) => Comparison::Eigenvalues,
                    _ if integrated => Comparison::Integrated,
                    _ => Comparison::Routes,
                };
                let scale = match x.quantity {
                    Quantity::C => a,
                    Quantity::D => b,
                    _ => size(&x.entries).max(size(&y.entries)),
                };
                let entries = [&*x.entries, &*y.entries];
                let compared = compare_on_scale([left.name, right.name], x.quantity, entries, comparison, scale);
                Agreement { follows: !(x.is_own || y.is_own), ..compared }
            };
            // The border comes last, and is compared only if both routes have it.
            these.into_iter().zip(those).map(compare).collect::<Vec<_>>()
        })
        .collect()
}

/// Whether a route integrates a differential equation in time, and so has an integrator's error.
fn is_integrated(route: RouteName) -> bool {
    route == RouteName::Scipy
}

/// An orbit by one route: name, x* and T*.
pub type NamedOrbit = (RouteName, Vector2<f64>, f64);

/// Compares every pair of routes to the orbit.
pub(crate) fn compare_orbits(orbits: &[NamedOrbit]) -> Vec<Agreement> {
    pairs(orbits)
        .flat_map(|((left, x, t), (right, y, u))| {
            let integrated = is_integrated(*left) || is_integrated(*right);
            let comparison = if integrated { Comparison::IntegratedOrbit } else { Comparison::Orbit };
            [
                compare([*left, *right], Quantity::Period, [&[*t], &[*u]], comparison),
                compare([*left, *right], Quantity::State, [x.as_slice(), y.as_slice()], comparison),
            ]
        })
        .collect()
}

fn pairs<T>(items: &[T]) -> impl Iterator<Item = (&T, &T)> {
    items.iter().enumerate().flat_map(|(index, left)| items[index + 1..].iter().map(move |right| (left, right)))
}

/// The comparisons of one quantity, one for each pair of routes.
#[derive(Clone, Debug)]
pub struct Pairs<'a> {
    pub quantity: Quantity,
    pub all: Vec<&'a Agreement>,
    /// The pair that is nearest to its bound, or furthest beyond it. A difference that is NaN disagrees, and comes first.
    pub closest: &'a Agreement,
}

document!(Pairs<'_> as pairs {
    quantity: pairs.quantity,
    pairs: pairs.all.len(),
    following: pairs.following(),
    agreeing: pairs.all.iter().filter(|pair| pair.agrees).count(),
    closest: pairs.closest,
    shared_decimals: shared_decimals(pairs.closest.max_abs_diff),
});

impl Pairs<'_> {
    /// Returns how many of the pairs follow from A and B.
    pub fn following(&self) -> usize {
        self.all.iter().filter(|pair| pair.follows).count()
    }
}

/// Groups comparisons by quantity, in the order in which the quantities first appear.
pub fn by_quantity(comparisons: &[Agreement]) -> Vec<Pairs<'_>> {
    let used = |entry: &Agreement| {
        let used = entry.max_abs_diff / entry.bound.value;
        if used.is_nan() { f64::INFINITY } else { used }
    };
    let mut found: Vec<Pairs<'_>> = Vec::new();
    for entry in comparisons {
        match found.iter_mut().find(|pairs| pairs.quantity == entry.quantity) {
            None => found.push(Pairs { quantity: entry.quantity, all: vec![entry], closest: entry }),
            Some(pairs) => {
                pairs.all.push(entry);
                if used(entry) >= used(pairs.closest) {
                    pairs.closest = entry;
                }
            }
        }
    }
    found
}

/// Returns the fewest decimals that any two routes share in an entry of A or B; `None` for all digits.
pub(crate) fn fewest_shared_decimals(comparisons: &[Agreement]) -> Option<u32> {
    let maps = comparisons.iter().filter(|entry| entry.quantity.is_of_the_map());
    maps.filter_map(|entry| shared_decimals(entry.max_abs_diff)).min()
}

/// Returns how many decimals two numbers with the difference `diff` share: they differ by less than half a unit in that place.
///
/// `None` if they are equal to the last digit; otherwise at least 0.
pub fn shared_decimals(diff: f64) -> Option<u32> {
    (diff != 0.0).then(|| if diff.is_finite() { (-elementary::log10(2.0 * diff)).floor().max(0.0) as u32 } else { 0 })
}
