//! Which conditions does a verdict rest on, and do Feigin's counts say what the orbits do?

use crate::common;
use approx::assert_relative_eq;
use corner_impact::border_collision::conditions::{Condition, Decides};
use corner_impact::border_collision::long_run::LocalLongRun;
use corner_impact::border_collision::word::Word;
use corner_impact::border_collision::{Degenerate, LocalMap, classify, conditions};
use corner_impact::corner::map::{CornerMap, SideMap};
use corner_impact::orbit::Stability;
use nalgebra::{Matrix2, RowVector2, Vector2};

/// `count` values from `low` to `high`.
fn grid([low, high]: [f64; 2], count: u32) -> impl Iterator<Item = f64> + Clone {
    (0..count).map(move |index| low + (high - low) * f64::from(index) / f64::from(count - 1))
}

/// A continuous map with these traces and determinants, in coordinates of no special kind and units of no special size.
fn planted(traces: [f64; 2], determinants: [f64; 2], units: [f64; 2]) -> (CornerMap, (RowVector2<f64>, f64)) {
    let m = Matrix2::new(0.7, -0.4, 0.9, 1.6) * Matrix2::from_diagonal(&Vector2::from(units)).try_inverse().unwrap();
    let inverse = m.try_inverse().unwrap();
    let shift = Vector2::new(1.3 * units[0], -2.1 * units[1]);
    let side = |side: usize| {
        let a = inverse * Matrix2::new(traces[side], 1.0, -determinants[side], 0.0) * m;
        SideMap { a, b: inverse * Vector2::new(1.0, 0.4) + (Matrix2::identity() - a) * shift }
    };
    let e = m.row(0).into_owned();
    (CornerMap { minus: side(0), plus: side(1) }, (e, -(e * shift)[0]))
}

/// Feigin's counts against the orbits themselves, found by solving for them on both sides.
#[test]
fn feigins_counts_say_what_the_orbits_do() {
    let mut seen = std::collections::BTreeMap::new();
    for (t_l, t_r) in grid([-2.53, 2.61], 18).flat_map(|l| grid([-2.57, 2.47], 18).map(move |r| (l, r))) {
        for (d_l, d_r) in [(0.3, 0.6), (-0.4, 0.5), (1.3, 0.2)] {
            let (map, border) = planted([t_l, t_r], [d_l, d_r], [1.0, 1.0]);
            let verdict = classify(&map, border).unwrap();
            let local = LocalMap::new(&map, border);
            let there = |text: &str, mu: f64| local.orbit(&Word::read(text).unwrap(), mu).unwrap().admissible();
            let [l, r, two] = ["L", "R", "LR"].map(|text| [there(text, 1.0), there(text, -1.0)]);
            let case = format!("traces {t_l} {t_r}, determinants {d_l} {d_r}: {verdict:?}");
            assert!(l[0] != l[1] && r[0] != r[1], "{case}");
            assert_eq!(verdict.scenario.to_string() == "nonsmooth-fold", l == r, "{case}");
            assert_eq!(verdict.period_two_orbit, two[0] != two[1], "{case}");
            assert!(!(two[0] && two[1]), "{case}");
            *seen.entry(verdict.scenario.to_string()).or_insert(0) += 1;
        }
    }
    assert!(seen.len() == 3 && seen.values().all(|count| *count > 100), "{seen:?}");
}

/// A pair on the unit circle, whatever the last bit of its modulus is; and a pair a millionth inside or outside of it.
#[test]
fn a_side_with_a_pair_on_the_unit_circle_is_neutral() {
    let told = |determinants: [f64; 2]| {
        let (map, border) = planted([1.2, 0.3], determinants, [1.0, 1e-3]);
        let verdict = classify(&map, border).unwrap();
        let orbit = LocalMap::new(&map, border).orbit(&Word::read("L").unwrap(), 1.0).unwrap();
        assert_eq!((orbit.stability(), orbit.stable()), (verdict.minus.stability, verdict.minus.stable));
        [verdict.minus.stability, verdict.plus.stability]
    };
    assert_eq!(told([1.0, 1.0 - 1e-6]), [Stability::Neutral, Stability::Stable]);
    assert_eq!(told([1.0 + 1e-6, 1.0]), [Stability::Unstable, Stability::Neutral]);
}

fn named<'a>(all: &'a [Condition], name: &str) -> &'a Condition {
    all.iter().find(|condition| condition.name == name).unwrap_or_else(|| panic!("{name}"))
}

/// Of sides that do not meet the largest minor is told over its own terms: by hand, 1*2 - 3*1 over 3*2 + 7*1. A row of which nothing depends on
/// anything is continuous.
#[test]
fn how_far_a_condition_is_from_failing_is_told_over_its_terms() {
    let side =
        |first: [f64; 3]| SideMap { a: Matrix2::new(first[0], first[1], 0.0, 0.0), b: Vector2::new(first[2], 0.0) };
    let map = CornerMap { minus: side([1.0, 2.0, 5.0]), plus: side([2.0, 5.0, 8.0]) };
    for size in [1.0, 1e9] {
        let all = conditions(&LocalMap::new(&map, (RowVector2::new(size, 2.0 * size), 3.0 * size)));
        let meeting = named(&all, "(A+ - A-, B+ - B-) - E (e, f) = 0");
        assert!(!meeting.holds(), "{meeting:?}");
        assert_relative_eq!(meeting.value, 1.0 / 13.0, max_relative = 1e-14);
        assert_relative_eq!(named(&all, "first entry of C").distance, 1.0 / 3.0, max_relative = 1e-14);
        let jump = named(&all, "A+ - A-");
        assert_eq!(jump.value, 3.0);
        assert_relative_eq!(jump.distance, 3.0 / 7.0, max_relative = 1e-14);
        // e A- is e.
        let form = named(&all, "det [e; e A-]");
        assert!(form.value == 0.0 && form.distance == 0.0 && !form.holds(), "{form:?}");
    }
}

/// Of length, time, period and the height over the border alike: how far each condition is from failing, and the verdict.
#[test]
fn conditions_hang_on_no_unit() {
    let told = |units: [f64; 2], of_period: f64, of_height: f64| {
        let (mut map, (e, f)) = planted([0.4, -1.7], [0.3, 0.2], units);
        map.minus.b *= of_period;
        map.plus.b *= of_period;
        let border = (e * of_height, f * of_period * of_height);
        let distances: Vec<f64> =
            conditions(&LocalMap::new(&map, border)).iter().skip(2).map(|condition| condition.distance).collect();
        (distances, classify(&map, border).unwrap().scenario)
    };
    let (distances, scenario) = told([1.0, 1.0], 1.0, 1.0);
    for (units, of_period, of_height) in
        [([1e6, 1e6], 1.0, 1.0), ([1.0, 1.0], 1e-30, 1.0), ([1.0, 1.0], 1e30, 1.0), ([1.0, 1.0], 1.0, 1e9)]
    {
        let other = told(units, of_period, of_height);
        assert_eq!(other.1, scenario);
        for (one, other) in distances.iter().zip(&other.0) {
            assert_relative_eq!(*one, *other, epsilon = 0.0, max_relative = 1e-9);
        }
    }
}

/// A fixed point that stays on the border is on neither side; and a complex pair is neither above 1 nor below -1, wherever its real part is.
#[test]
fn what_is_counted_is_real_and_on_a_side() {
    let (map, border) = planted([3.0, 0.4], [4.0, 0.2], [1.0, 1.0]);
    let counts = classify(&map, border).unwrap().minus;
    assert_eq!((counts.above_one, counts.below_minus_one), (0, 0));
    let (mut map, (e, f)) = planted([0.4, -1.7], [0.3, 0.2], [1.0, 1.0]);
    // f is -e shift, and the fixed point of both sides is at the shift, but for what rounding might make of it.
    let shift = Vector2::new(1.3, -2.1) * (1.0 + 1e-13);
    for side in [&mut map.minus, &mut map.plus] {
        side.b = (Matrix2::identity() - side.a) * shift;
    }
    let refused = classify(&map, (e, f)).unwrap_err();
    assert!(
        matches!(refused, Degenerate::Vanishes { what: "the fixed point's distance from the border", .. }),
        "{refused:?}"
    );
}

/// A map in which one condition fails says so, and no other does.
#[test]
fn each_condition_fails_where_it_must_and_alone() {
    let two = (1.0 + 0.3) * (1.0 + 0.2);
    for (traces, determinants, failing) in [
        ([1.3, 0.4], [0.3, 0.2], "det(I - A-)"),
        ([0.4, 1.2], [0.3, 0.2], "det(I - A+)"),
        ([-1.3, 0.4], [0.3, 0.2], "det(I + A-)"),
        ([0.4, -1.2], [0.3, 0.2], "det(I + A+)"),
        ([0.4, 0.7], [1.0, 0.2], "|eigenvalue| - 1 of A-"),
        ([0.4, 0.7], [0.3, 1.0], "|eigenvalue| - 1 of A+"),
        ([-2.0, -two / 2.0], [0.3, 0.2], "det(I - A+ A-)"),
        ([0.4, 0.4], [0.3, 0.3], "A+ - A-"),
    ] {
        let (map, border) = planted(traces, determinants, [1.0, 1.0]);
        let all = conditions(&LocalMap::new(&map, border));
        assert_eq!(all.len(), 12);
        for condition in &all {
            // An eigenvalue 1 or -1 is on the unit circle too; without a jump there is no C.
            let implied = match failing {
                "det(I - A-)" | "det(I + A-)" => condition.name == "|eigenvalue| - 1 of A-",
                "det(I - A+)" | "det(I + A+)" => condition.name == "|eigenvalue| - 1 of A+",
                "A+ - A-" => condition.name == "first entry of C",
                _ => false,
            };
            assert_eq!(!condition.holds(), condition.name == failing || implied, "{failing}: {condition:?}");
        }
        let verdict = classify(&map, border);
        let decides = named(&all, failing).decides == Decides::Classification;
        assert_eq!(verdict.is_err(), decides, "{failing}: {verdict:?}");
    }
    // The fixed points stay on the border.
    let (mut map, border) = planted([0.4, -0.6], [0.3, 0.2], [1.0, 1.0]);
    map.minus.b = Vector2::zeros();
    map.plus.b = Vector2::zeros();
    let all = conditions(&LocalMap::new(&map, (border.0, 0.0)));
    assert!(!named(&all, "e adj(I - A-) B- + f det(I - A-)").holds());
    // The sides do not meet: B+ moved off.
    let (mut map, border) = planted([0.4, -0.6], [0.3, 0.2], [1.0, 1.0]);
    map.plus.b[1] += 1e-4;
    let all = conditions(&LocalMap::new(&map, border));
    assert!(!named(&all, "(A+ - A-, B+ - B-) - E (e, f) = 0").holds());
    match classify(&map, border) {
        Err(Degenerate::Fails { value, distance, .. }) => assert!(value > 1e-6 && distance < 0.0),
        other => panic!("{other:?}"),
    }
    // e is a left eigenvector of A-.
    let minus = SideMap { a: Matrix2::new(0.5, 0.0, 1.0, 0.3), b: Vector2::new(1.0, 1.0) };
    let plus = SideMap { a: Matrix2::new(0.9, 0.0, 2.0, 0.3), b: Vector2::new(1.0, 1.0) };
    let all = conditions(&LocalMap { minus, plus, border: (RowVector2::new(1.0, 0.0), 0.0) });
    assert!(!named(&all, "det [e; e A-]").holds());
}

/// The values are those of their formulas: over `det(I - A)` of a side, beta is where that side's fixed point lies.
#[test]
fn values_are_what_the_names_say() {
    let (map, border) = planted([0.4, -1.6], [0.3, 0.2], [1.0, 1.0]);
    let all = conditions(&LocalMap::new(&map, border));
    let value = |name: &str| named(&all, name).value;
    for (side, name) in [(&map.minus, "det(I - A-)"), (&map.plus, "det(I - A+)")] {
        let whole = Matrix2::identity() - side.a;
        let point = whole.lu().solve(&side.b).unwrap();
        assert_relative_eq!(value(name), whole.determinant(), max_relative = 1e-12);
        let height = (border.0 * point)[0] + border.1;
        assert_relative_eq!(value("e adj(I - A-) B- + f det(I - A-)") / value(name), height, max_relative = 1e-12);
    }
    let (e, a) = (border.0, map.minus.a);
    assert_relative_eq!(value("det [e; e A-]"), Matrix2::from_rows(&[e, e * a]).determinant(), max_relative = 1e-12);
    let both = (Matrix2::identity() - map.plus.a * map.minus.a).determinant();
    assert_relative_eq!(value("det(I - A+ A-)"), both, max_relative = 1e-12);
    assert_relative_eq!(value("det(I + A+)"), (Matrix2::identity() + map.plus.a).determinant(), max_relative = 1e-12);
    // Traces 0.4 and -1.6 with determinants 0.3 and 0.2: a pair of modulus sqrt 0.3; -1.463 and -0.137.
    assert_relative_eq!(value("|eigenvalue| - 1 of A-"), 0.3_f64.sqrt() - 1.0, max_relative = 1e-12);
    assert_relative_eq!(value("|eigenvalue| - 1 of A+"), 0.8 + 0.44_f64.sqrt() - 1.0, max_relative = 1e-12);
}

/// A distance is no matter of metres or millimetres.
#[test]
fn distances_from_failing_have_no_units() {
    let of = |units| {
        let (map, border) = planted([0.4, -1.6], [0.3, 0.2], units);
        conditions(&LocalMap::new(&map, border))
    };
    for (one, other) in of([1.0, 1.0]).iter().zip(&of([1e3, 1e-4])) {
        let epsilon = if one.name.starts_with("(A+") { 1e-4 } else { 1e-9 };
        assert_relative_eq!(one.distance, other.distance, epsilon = epsilon);
    }
}

#[test]
fn numbers_that_are_none_end_without_a_panic() {
    let mut map = common::normal_form([0.5, f64::NAN], [0.3, 0.2]);
    assert!(!matches!(map.outcome(1.0).fates[0].end, LocalLongRun::Periodic(_) | LocalLongRun::Chaotic(..)));
    map.plus.a = Matrix2::repeat(f64::INFINITY);
    assert!(!matches!(map.outcome(-1.0).fates[0].end, LocalLongRun::Chaotic(..)));
    assert!(conditions(&map).iter().any(|condition| !condition.holds()));
}

/// `det(I - A)` is 0 to rounding over its terms, `1 + |tr A| + |det A|`, and not as a number: with traces and determinants of 1e8 it has to be
/// above 0.02, with those of 1 above 3e-10.
#[test]
fn an_orbit_is_none_where_rounding_decides_where_it_is() {
    for (determinant, off, is_there) in [(1e8, 1e-3, false), (1e8, 1.0, true), (0.5, 1e-11, false), (0.5, 1e-8, true)] {
        let map = common::normal_form([1.0 + determinant - off, 0.4], [determinant, 0.2]);
        assert_eq!(map.orbit(&Word::read("L").unwrap(), 1.0).is_some(), is_there, "{determinant} {off}");
    }
}
