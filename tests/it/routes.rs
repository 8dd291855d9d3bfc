//! Do the routes agree on every model, and do they know how well?

use crate::common;
use corner_impact::agreement::{Quantity, compare_routes};
use corner_impact::cam::Side;
use corner_impact::corner::map::{CornerMap, Own, Route, RouteName, SideMap, Uncertainty};
use corner_impact::corner::one_sided::OneSidedMap;
use corner_impact::study::routes::{Log, split_by_knowledge};
use corner_impact::study::verify::{External, verify};
use nalgebra::{Matrix2, Vector2, Vector3};

const MAPS: [&str; 4] = ["A_minus", "A_plus", "B_minus", "B_plus"];

#[test]
fn five_decimals_on_the_papers_model() {
    let found = verify(&common::osorio(), External::LeftOut).unwrap();
    let of_maps: Vec<_> =
        found.comparisons.iter().filter(|entry| MAPS.contains(&entry.quantity.to_string().as_str())).collect();
    assert_eq!(of_maps.len(), 6 * MAPS.len(), "closed form, product, differences and fit, pairwise");
    for entry in of_maps {
        assert!(entry.max_abs_diff < 5e-6, "{entry:?}");
    }
    assert!(found.agrees);
}

#[test]
fn eight_digits_of_every_entry_on_every_model() {
    for file in common::model_files() {
        let found = verify(&common::read(&file), External::LeftOut).unwrap();
        assert!(found.agrees, "{file:?}: {:?}", found.skipped);
        for entry in found.comparisons.iter().filter(|entry| MAPS.contains(&entry.quantity.to_string().as_str())) {
            assert!(entry.max_rel_diff < 1e-8, "{file:?}: {entry:?}");
        }
        for entry in
            found.comparisons.iter().filter(|entry| ["T_star", "x_star"].contains(&entry.quantity.to_string().as_str()))
        {
            assert!(entry.agrees && entry.bound.value < 1e-9, "{file:?}: {entry:?}");
        }
    }
}

fn entries(map: &CornerMap) -> Vec<f64> {
    let side = |side: &SideMap| side.a.iter().chain(side.b.iter()).copied().collect::<Vec<_>>();
    [side(&map.minus), side(&map.plus)].concat()
}

/// An estimate's own error must cover its distance from the closed form, and must not be an empty promise.
#[test]
fn estimators_know_their_errors() {
    for file in common::model_files() {
        let found = verify(&common::read(&file), External::LeftOut).unwrap();
        let exact = entries(&found.map);
        let estimates: Vec<_> = found.routes.iter().filter(|route| route.uncertainty.is_some()).collect();
        assert_eq!(estimates.len(), 2, "differences and fit");
        for route in estimates {
            let error: Vec<f64> = match route.uncertainty.as_ref().unwrap() {
                Uncertainty::Fit { standard, systematic, condition_number } => {
                    assert!((1.0..100.0).contains(condition_number), "{condition_number}");
                    entries(standard).iter().zip(entries(systematic.as_ref().unwrap())).map(|(a, b)| a + b).collect()
                }
                Uncertainty::Extrapolation(correction) => entries(correction),
            };
            let misses: Vec<f64> = entries(&route.map).iter().zip(&exact).map(|(a, b)| (a - b).abs()).collect();
            for ((miss, error), exact) in misses.iter().zip(&error).zip(&exact) {
                let allowed = 4.0 * error;
                assert!(*miss <= allowed, "{file:?} {}: off by {miss:e}, allowed {allowed:e}", route.name);
                assert!(*error > 0.0 && *error < 1e-6 * exact.abs().max(1.0), "{file:?} {}: {error:e}", route.name);
            }
        }
    }
}

/// The paper's region condition, tried out: perturb the orbit, look on which side of the corner the impact falls.
#[test]
fn the_border_of_the_free_flight_says_on_which_side_the_impact_falls() {
    for file in common::model_files() {
        let model = common::read(&file);
        let cam = common::cam(&model);
        let found = verify(&model, External::LeftOut).unwrap();
        let (e, f) = found.border;
        for side in [Side::Minus, Side::Plus] {
            let map = OneSidedMap::new(&model, &cam, &found.at, side).unwrap();
            let scales = map.scales();
            for direction in [[1.0, 0.3, 0.2], [-1.0, 0.2, -0.4], [0.1, -1.0, 0.3], [0.2, 0.1, -1.0], [0.0, 0.0, 1.0]] {
                let sample = map.sample(scales.component_mul(&Vector3::from(direction))).unwrap();
                let by_border = (e * sample.perturbation.xy())[0] + f * sample.perturbation[2];
                assert!(
                    by_border * sample.past_corner > 0.0,
                    "{file:?} {direction:?}: {by_border} {}",
                    sample.past_corner
                );
            }
        }
    }
}

/// As printed, (C, D) takes the place of (e, f), and is wrong for the paper's own numbers.
#[test]
fn the_printed_region_condition_has_the_wrong_sign() {
    let found = verify(&common::osorio(), External::LeftOut).unwrap();
    let (e, f) = found.border;
    let map = &found.map;
    let (c, d) = (map.c(), map.d());
    assert!((c * e.transpose())[0] + d * f < 0.0, "(C, D) and (e, f) point opposite ways");
}

/// A route to a map with A = a everywhere.
fn route(name: RouteName, a: f64, uncertainty: Option<Uncertainty>) -> Route {
    Route { name, map: sides(a), own: Own::default(), uncertainty }
}

fn sides(a: f64) -> CornerMap {
    let side = SideMap { a: Matrix2::repeat(a), b: Vector2::repeat(1.0) };
    CornerMap { minus: side, plus: side }
}

/// Whether A is still compared with what is exact once the quantities are left out that a route does not know, and whether that is told.
fn is_compared(estimate: Route) -> (bool, bool) {
    let routes = [route(RouteName::Variational, 1.0, None), estimate];
    let mut log = Log::default();
    let kept = split_by_knowledge(compare_routes(&routes), &routes, &mut log);
    (kept.iter().any(|item| item.quantity == Quantity::A(Side::Minus)), !log.0.is_empty())
}

#[test]
fn an_estimate_that_misses_by_more_than_it_says_disagrees() {
    for (off, said, is_kept) in [(1e-4, 2e-4, false), (2e-4, 1e-4, true), (1e-12, 2e-4, true)] {
        let estimate = route(RouteName::FiniteDifference, 1.0 + off, Some(Uncertainty::Extrapolation(sides(said))));
        assert_eq!(is_compared(estimate), (is_kept, !is_kept), "{off} {said}");
    }
}

/// A is to agree to 1e-8. A fit knows it to three standard errors and the bias together.
#[test]
fn a_fit_is_compared_where_it_knows_enough() {
    let none = CornerMap { minus: SideMap { a: Matrix2::zeros(), b: Vector2::zeros() }, ..sides(0.0) };
    let error = |a: f64| CornerMap { minus: SideMap { a: Matrix2::repeat(a), ..none.minus }, plus: none.minus };
    for (standard, bias, is_kept) in
        [(2e-9, 3e-9, true), (2e-9, 5e-9, false), (4e-9, 0.0, false), (0.0, 9e-9, true), (0.0, 2e-8, false)]
    {
        let (standard_error, systematic) = (error(standard), Some(error(bias)));
        let fit = Uncertainty::Fit { standard: standard_error, systematic, condition_number: 10.0 };
        let (kept, told) = is_compared(route(RouteName::LeastSquares, 1.0, Some(fit)));
        assert_eq!((kept, told), (is_kept, !is_kept), "{standard} {bias}");
    }
}
