//! Does the closed form meet what computer algebra derives, at 200 points, damped and undamped?
#![allow(clippy::unwrap_used, clippy::panic)]

use std::f64::consts::TAU;

use corner_impact::cam::Lift;
use corner_impact::corner::closed_form::side_map;
use corner_impact::flight::Flight;
use corner_impact::model::Follower;
use serde_json::Value;

const POINTS: &str = include_str!("../golden/derived/points.json");

fn number(value: &Value) -> f64 {
    value.as_str().unwrap().parse().unwrap()
}

#[test]
fn two_hundred_points_to_twelve_digits() {
    let document: Value = serde_json::from_str(POINTS).unwrap();
    let points = document["points"].as_array().unwrap();
    assert_eq!(points.len(), 200);
    let mut kinds = std::collections::BTreeMap::new();
    for point in points {
        let kind = point["kind"].as_str().unwrap();
        *kinds.entry(kind).or_insert(0) += 1;
        let input = |name: &str| number(&point["inputs"][name]["decimal"]);
        let (period, position) = (input("T"), 0.25);
        // With mass 1; the spring is slack at the corner, so that gravity alone is w0^2 (q - rest) + g.
        let follower = Follower {
            mass: 1.0,
            damping: 2.0 * input("zeta"),
            stiffness: input("omega0_squared"),
            gravity: input("spring"),
            rest_position: position,
            restitution: input("r"),
        };
        let omega = TAU / period;
        let (slope, curvature) = (input("c1") / omega, input("c2") / (omega * omega));
        let lift = Lift { value: position, slope, curvature, third: 0.0 };
        let map = side_map(&follower, period, input("v"), &lift);
        let rows = point["A"].as_array().unwrap();
        for (index, row) in rows.iter().enumerate() {
            meets(map.a[(index, 0)], number(&row[0]), point);
            meets(map.a[(index, 1)], number(&row[1]), point);
            meets(map.b[index], number(&point["B"][index]), point);
        }
        let response = Flight::new(&follower).response(0.5 * period);
        meets(response.step, number(&point["p"]), point);
        meets(response.impulse, number(&point["s"]), point);
    }
    assert!(kinds.len() == 6 && kinds.values().all(|count| *count >= 10), "{kinds:?}");
}

#[track_caller]
fn meets(computed: f64, derived: f64, point: &Value) {
    assert!(
        (computed - derived).abs() <= 1e-12 * derived.abs(),
        "{computed:e} against {derived:e} at {}",
        point["inputs"]
    );
}
