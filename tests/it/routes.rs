//! Do the routes agree on every model, and do they know how well?

use crate::common;
use corner_impact::cam::Side;
use corner_impact::corner::map::{CornerMap, SideMap, Uncertainty};
use corner_impact::corner::one_sided::OneSidedMap;
use corner_impact::study::verify::{External, verify};
use nalgebra::Vector3;

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
