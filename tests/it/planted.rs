//! Are planted coefficients recovered, and known maps classified as they must be?

use approx::assert_relative_eq;
use corner_impact::border_collision::{Degenerate, classify, normal_form};
use corner_impact::cam::Side;
use corner_impact::corner::map::{CornerMap, SideMap};
use nalgebra::{Matrix2, RowVector2, Vector2};

const SHIFT: Vector2<f64> = Vector2::new(1.3, -2.1);

/// A continuous map with given traces and determinants, in coordinates `x = M^{-1} x_bar + shift dT` of no special kind.
fn planted(traces: [f64; 2], determinants: [f64; 2], b_bar: [f64; 2]) -> (CornerMap, Matrix2<f64>) {
    let companion = |side: usize| Matrix2::new(traces[side], 1.0, -determinants[side], 0.0);
    let m = Matrix2::new(0.7, -0.4, 0.9, 1.6);
    let inverse = m.try_inverse().unwrap();
    // Moved by s dT the border is C x + D dT = 0 with D = -C s, and B = (I - A) s + M^{-1} b_bar.
    let side = |side: usize| {
        let a = inverse * companion(side) * m;
        SideMap { a, b: inverse * Vector2::from(b_bar) + (Matrix2::identity() - a) * SHIFT }
    };
    (CornerMap { minus: side(0), plus: side(1) }, m)
}

#[test]
fn a_planted_normal_form_is_recovered() {
    // C is only fixed up to its scale, h (A+ - A-); so the plant's jump of trace sets the scale of W and B bar.
    let (map, m) = planted([1.2, -0.7], [0.3, 0.9], [1.0, 0.5]);
    let form = normal_form(&map).unwrap();
    assert_relative_eq!(form.a_bar_minus, Matrix2::new(1.2, 1.0, -0.3, 0.0), epsilon = 1e-12);
    assert_relative_eq!(form.a_bar_plus, Matrix2::new(-0.7, 1.0, -0.9, 0.0), epsilon = 1e-12);
    assert_relative_eq!(form.c_bar, RowVector2::new(1.0, 0.0), epsilon = 1e-12);
    let scale = form.w[(0, 0)] / m[(0, 0)];
    assert_relative_eq!(form.w, m * scale, epsilon = 1e-12);
    // The plant moved its origin by SHIFT, the normal form along e1; the difference k lies in the border, C k = 0.
    let k = SHIFT - Vector2::new((map.c() * SHIFT)[0] / map.c()[0], 0.0);
    assert_relative_eq!((map.c() * k)[0], 0.0, epsilon = 1e-12);
    let moved = form.w * (Matrix2::identity() - map.minus.a) * k;
    assert_relative_eq!(form.b_bar, Vector2::new(1.0, 0.5) * scale + moved, epsilon = 1e-11);
    // B~ is the same from either side.
    let from_plus = map.plus.b - (map.plus.a - Matrix2::identity()) * Vector2::new(map.d() / map.c()[0], 0.0);
    assert_relative_eq!(form.b_tilde, from_plus, epsilon = 1e-12);
}

#[test]
fn the_normal_form_has_the_same_orbit() {
    // The minus side is stable, the plus side flips: its orbits go to and fro.
    let (map, _) = planted([0.2, -1.95], [0.3, 0.9], [1.0, 0.5]);
    let form = normal_form(&map).unwrap();
    let dt = -0.01;
    let mut x = Vector2::new(0.03, -0.02);
    let to_bar = |x: Vector2<f64>| form.w * (x + Vector2::new(map.d() * dt / map.c()[0], 0.0));
    let mut bar = to_bar(x);
    let mut sides = [0, 0];
    for _ in 0..40 {
        let minus = (map.c() * x)[0] + map.d() * dt < 0.0;
        sides[usize::from(minus)] += 1;
        let (side, a_bar) = if minus { (&map.minus, form.a_bar_minus) } else { (&map.plus, form.a_bar_plus) };
        assert_eq!(bar[0] < 0.0, minus);
        x = side.a * x + side.b * dt;
        bar = a_bar * bar + form.b_bar * dt;
        assert_relative_eq!(bar, to_bar(x), epsilon = 1e-9);
    }
    assert!(sides[0] > 0 && sides[1] > 0, "the orbit visits both sides: {sides:?}");
}

/// Where a fixed point is on its own side, found by trying both signs of dT.
fn exists_for(map: &CornerMap, border: (RowVector2<f64>, f64), minus: bool) -> &'static str {
    let side = if minus { &map.minus } else { &map.plus };
    let found: Vec<_> = [(-1.0, "faster"), (1.0, "slower")]
        .into_iter()
        .filter(|(dt, _)| {
            let x = (Matrix2::identity() - side.a).lu().solve(&(side.b * *dt)).unwrap();
            assert_relative_eq!(side.a * x + side.b * *dt, x, epsilon = 1e-9);
            ((border.0 * x)[0] + border.1 * dt < 0.0) == minus
        })
        .collect();
    assert_eq!(found.len(), 1);
    found[0].1
}

#[test]
fn known_maps_are_classified_by_trace_and_determinant() {
    // An eigenvalue above 1 for 1 - tr + det < 0, below -1 for 1 + tr + det < 0.
    for (traces, determinants, scenario, counts, period_two) in [
        ([0.5, -0.5], [0.2, 0.3], "persistence", [0, 0, 0, 0], false),
        ([1.5, 0.5], [0.2, 0.3], "nonsmooth-fold", [1, 0, 0, 0], false),
        ([0.5, 1.5], [0.2, 0.3], "nonsmooth-fold", [0, 1, 0, 0], false),
        ([1.5, 1.6], [0.2, 0.3], "persistence", [1, 1, 0, 0], false),
        ([2.5, 0.1], [1.51, 0.3], "persistence", [2, 0, 0, 0], false),
        ([0.5, -1.5], [0.2, 0.3], "nonsmooth-flip", [0, 0, 0, 1], true),
        ([-1.5, 0.5], [0.2, 0.3], "nonsmooth-flip", [0, 0, 1, 0], true),
        ([-1.5, -1.6], [0.2, 0.3], "persistence", [0, 0, 1, 1], false),
        ([1.5, -1.5], [0.2, 0.3], "nonsmooth-fold", [1, 0, 0, 1], true),
        ([0.5, 1.9], [0.2, 1.2], "persistence", [0, 0, 0, 0], false),
    ] {
        let (map, _) = planted(traces, determinants, [1.0, 0.4]);
        for sign in [1.0, -1.0] {
            let border = (map.c() * sign, map.d() * sign);
            let verdict = classify(&map, border).unwrap();
            let case = format!("{traces:?} {determinants:?} {sign}");
            assert_eq!(verdict.scenario.to_string(), scenario, "{case}");
            let found = [
                verdict.minus.above_one,
                verdict.plus.above_one,
                verdict.minus.below_minus_one,
                verdict.plus.below_minus_one,
            ];
            assert_eq!(found, counts, "{case}");
            assert_eq!(verdict.period_two_orbit, period_two, "{case}");
            assert_eq!(verdict.minus.exists_for.to_string(), exists_for(&map, border, true), "{case}");
            assert_eq!(verdict.plus.exists_for.to_string(), exists_for(&map, border, false), "{case}");
            // Feigin's counts and the fixed points' own places must tell the same story.
            let same_side = verdict.minus.exists_for == verdict.plus.exists_for;
            assert_eq!(same_side, scenario == "nonsmooth-fold", "{case}");
            for (side, map) in [(&verdict.minus, &map.minus), (&verdict.plus, &map.plus)] {
                let (trace, determinant) = (map.a.trace(), map.a.determinant());
                assert_relative_eq!(side.determinant, 1.0 - trace + determinant, epsilon = 1e-12);
                // Jury's conditions.
                let stable =
                    determinant.abs() < 1.0 && 1.0 - trace + determinant > 0.0 && 1.0 + trace + determinant > 0.0;
                assert_eq!(side.stable, stable, "{case}");
            }
        }
    }
}

#[test]
fn degenerate_maps_are_refused_with_the_reason() {
    // tr = 1.2, det = 0.2: an eigenvalue at 1; tr = -1.2, det = 0.2: at -1.
    for (trace, boundary) in [(1.2, 1.0), (-1.2, -1.0)] {
        for at_minus in [true, false] {
            let traces = if at_minus { [trace, 0.3] } else { [0.3, trace] };
            let (map, _) = planted(traces, [0.2, 0.2], [1.0, 0.4]);
            match classify(&map, (map.c(), map.d())) {
                Err(Degenerate::EigenvalueOnBoundary { side, boundary: found, .. }) => {
                    assert_eq!(found, boundary);
                    assert_eq!(side, if at_minus { Side::Minus } else { Side::Plus });
                }
                other => panic!("{other:?}"),
            }
        }
    }
    // The same matrices on both sides: no border at all.
    let (map, _) = planted([0.5, 0.5], [0.2, 0.2], [1.0, 0.4]);
    assert!(matches!(normal_form(&map), Err(Degenerate::Vanishes { .. })));
    // C is a left eigenvector of A-: the companion form does not exist.
    let minus = SideMap { a: Matrix2::new(0.5, 0.0, 1.0, 0.3), b: Vector2::new(1.0, 1.0) };
    let plus = SideMap { a: Matrix2::new(0.9, 0.0, 2.0, 0.3), b: Vector2::new(2.0, 1.0) };
    assert!(matches!(normal_form(&CornerMap { minus, plus }), Err(Degenerate::Vanishes { .. })));
    // A fixed point on the border itself.
    let (map, _) = planted([0.5, -0.5], [0.2, 0.3], [1.0, 0.4]);
    let x = (Matrix2::identity() - map.minus.a).try_inverse().unwrap() * map.minus.b;
    let border = (map.c(), -(map.c() * x)[0]);
    assert!(matches!(classify(&map, border), Err(Degenerate::Vanishes { .. })));
}

/// Zero to rounding means zero beside what it is made of: the same small number is refused or not by its terms.
#[test]
fn degenerate_is_measured_against_its_terms() {
    // The first entry of C beside A's own entries of 1000: 1e-7 is rounding, 4e-7 is not.
    for (jump, refused) in [(1e-7, true), (4e-7, false)] {
        let minus = SideMap { a: Matrix2::new(1000.0, 2.0, 3.0, 0.5), b: Vector2::new(1.0, 1.0) };
        let plus = SideMap { a: Matrix2::new(1000.0 + jump, 2.5, 3.0, 0.5), b: Vector2::new(2.0, 1.0) };
        let form = normal_form(&CornerMap { minus, plus });
        assert_eq!(form.is_err(), refused, "{jump}: {form:?}");
    }
    // det [C; C A-] beside the lengths of its rows, 400 and 200.
    for (coupling, refused) in [(2e-11, true), (2e-10, false)] {
        let minus = SideMap { a: Matrix2::new(0.5, coupling, 1.0, 0.3), b: Vector2::new(1.0, 1.0) };
        let plus = SideMap { a: Matrix2::new(400.5, coupling, 2.0, 0.3), b: Vector2::new(2.0, 1.0) };
        let form = normal_form(&CornerMap { minus, plus });
        assert_eq!(form.is_err(), refused, "{coupling}: {form:?}");
    }
}
