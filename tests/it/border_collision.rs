//! Does the local map do what is known of piecewise-linear maps in terms of trace and determinant?
//!
//! The conditions are derived in `derivations/border_collision.py` and stand here once more; the map is simulated on grids
//! of parameters and must end where they say.

use std::fmt::Write;

use crate::common;
use crate::orbit_numbers::is_as_it_was;
use approx::assert_relative_eq;
use corner_impact::border_collision::local_map::MapOrbit;
use corner_impact::border_collision::long_run::{EscapeReason, LocalLongRun};
use corner_impact::border_collision::word::Word;
use corner_impact::border_collision::{LocalMap, passage};
use corner_impact::cam::Side;
use corner_impact::corner::SideMap;
use corner_impact::estimate::Estimate;
use corner_impact::interval::Interval;
use corner_impact::known::Evidence;
use nalgebra::{Matrix2, Vector2};

/// What a motion from 0 does, in a word.
fn kind(end: &LocalLongRun) -> String {
    match end {
        LocalLongRun::Periodic(orbit) => orbit.word.to_string(),
        other => other.name().into(),
    }
}

fn word(text: &str) -> Word {
    Word::read(text).unwrap()
}

/// `count` values from `low` to `high`.
fn grid([low, high]: [f64; 2], count: u32) -> impl Iterator<Item = f64> + Clone {
    (0..count).map(move |index| low + (high - low) * f64::from(index) / f64::from(count - 1))
}

fn exponent(end: &LocalLongRun) -> Estimate {
    match end {
        LocalLongRun::Chaotic(chaos) => chaos.exponent,
        other => panic!("{other:?}"),
    }
}

#[test]
fn primitive_words_are_all_there_once() {
    let words = Word::primitive(8);
    // Lyndon words over two letters, by length: OEIS A001037.
    for (length, count) in [(1, 2), (2, 1), (3, 2), (4, 3), (5, 6), (6, 9), (7, 18), (8, 30)] {
        assert_eq!(words.iter().filter(|word| word.sides().len() == length).count(), count, "{length}");
    }
    for (index, one) in words.iter().enumerate() {
        assert_eq!(one.least_rotation(), (one.clone(), 0));
        assert!(words[..index].iter().all(|other| other.least_rotation().0 != one.least_rotation().0), "{one}");
    }
    assert!(Word::primitive(0).is_empty());
    assert_eq!(Word::read("LRX"), None);
    assert_eq!(Word::read(""), None);
}

#[test]
fn a_repeated_word_is_found_and_only_where_it_repeats() {
    let of = |text: &str, times| Word::repeated(word(text).sides(), times).map(|word| word.to_string());
    assert_eq!(of("RLLRLLRLL", 3).as_deref(), Some("RLL"));
    assert_eq!(of("LLRLLRLLRL", 3).as_deref(), Some("LRL"), "goes on as it would");
    assert_eq!(of("LRLRLRLR", 4).as_deref(), Some("LR"));
    assert_eq!(of("LRLRLRLR", 5), None);
    assert_eq!(of("LLRLLRLR", 3), None);
    assert_eq!(of("RRRR", 4).as_deref(), Some("R"));
    assert_eq!(Word::repeated(&[], 1), None);
}

/// Where the motion of `x -> a x + 1 (x < 0), b x + 1 (x > 0)` from 0 ends, and how far the nearest change is.
///
/// Nusse and Yorke 1995, di Bernardo, Feigin, Hogan and Homer 1999, Banerjee, Karthik, Yuan and Yorke 2000: the fixed point
/// of R is stable for |b| < 1; for b < -1 and 0 < a < 1 the only stable orbits are L^{n-1} R, which exist for
/// `b a^{n-1} < 1 - (1 - a^n)/(1 - a)` and are stable for `b a^{n-1} > -1`, and what is left is chaotic; with a > 1 it is
/// chaotic while the fixed point of L is not passed, `1/a + 1/|b| > 1`; with a < 0 the map falls everywhere and has the
/// orbit of period two for a b < 1, or nothing.
fn expected_on_the_line(a: f64, b: f64) -> (String, f64) {
    let nearest = |values: &[f64]| values.iter().fold(f64::INFINITY, |least: f64, value| least.min(value.abs()));
    if b > -1.0 {
        return (if b < 1.0 { "R" } else { "escapes" }.into(), nearest(&[b - 1.0, b + 1.0]));
    }
    if a < 0.0 {
        return (if a * b < 1.0 { "LR" } else { "escapes" }.into(), nearest(&[a, b + 1.0, a * b - 1.0]));
    }
    let bounded = 1.0 / a - 1.0 / b - 1.0;
    if a > 1.0 {
        return (if bounded > 0.0 { "chaotic" } else { "escapes" }.into(), nearest(&[a - 1.0, b + 1.0, bounded]));
    }
    let mut near = nearest(&[a, a - 1.0, b + 1.0]);
    let mut found = "chaotic".to_owned();
    for n in 2..40 {
        let product = b * a.powi(n - 1);
        let exists = product - (1.0 - (1.0 - a.powi(n)) / (1.0 - a));
        near = near.min(nearest(&[exists, product + 1.0]));
        if exists < 0.0 && product > -1.0 {
            found = "L".repeat(n as usize - 1) + "R";
        }
    }
    (found, near)
}

#[test]
#[ignore = "slow"]
fn maps_of_the_line_end_where_the_known_partition_says() {
    let mut seen = std::collections::BTreeMap::new();
    for a in grid([-1.93, 2.07], 61) {
        for b in grid([-9.11, 1.61], 83) {
            let (expected, near) = expected_on_the_line(a, b);
            if near < 0.02 {
                continue;
            }
            *seen.entry(expected.clone()).or_insert(0) += 1;
            let map = common::of_the_line([a, b]);
            let end = map.end(Vector2::zeros(), 1.0);
            assert_eq!(kind(&end), expected, "a = {a}, b = {b}: {end:?}");
            // Mirrored, x -> -x: the sides change places and mu its sign.
            let mirrored = common::of_the_line([b, a]).end(Vector2::new(-0.0, 0.0), -1.0);
            let swapped: String = expected
                .chars()
                .map(|c| {
                    if c == 'L' {
                        'R'
                    } else if c == 'R' {
                        'L'
                    } else {
                        c
                    }
                })
                .collect();
            let swapped = Word::read(&swapped).map_or(swapped, |word| word.least_rotation().0.to_string());
            assert_eq!(kind(&mirrored), swapped, "mirrored, a = {a}, b = {b}: {mirrored:?}");
        }
    }
    for (what, least) in [("R", 500), ("LR", 100), ("LLR", 20), ("LLLR", 5), ("chaotic", 500), ("escapes", 500)] {
        assert!(seen.get(what).is_some_and(|count| *count >= least), "{what}: {seen:?}");
    }
}

/// The boundaries of the stable orbits L^{n-1} R, a millionth to either side.
#[test]
fn stable_orbits_of_the_line_begin_and_end_where_they_must() {
    let mut both = 0;
    for n in 2..=5 {
        let text = "L".repeat(n - 1) + "R";
        for a in [0.15_f64, 0.3, 0.45, 0.6] {
            let power = a.powi(n as i32 - 1);
            let (exists, stable) = ((1.0 - (1.0 - a.powi(n as i32)) / (1.0 - a)) / power, -1.0 / power);
            let orbit = |b: f64| common::of_the_line([a, b]).orbit(&word(&text), 1.0).unwrap();
            assert!(
                orbit(exists * (1.0 + 1e-6)).admissible() && !orbit(exists * (1.0 - 1e-6)).admissible(),
                "{text} {a}"
            );
            assert!(orbit(stable * (1.0 - 1e-6)).stable() && !orbit(stable * (1.0 + 1e-6)).stable(), "{text} {a}");
            both += usize::from(stable < exists);
        }
    }
    assert!(both > 10 && both < 16, "some have a range and some have none: {both}");
}

/// `x -> a x + 1, b x + 1` with `a = -b/(b^2 - 1)`: 0 goes to 1, b + 1 and then to the fixed point of R, so that the intervals
/// between these points map onto one another (Markov) and the invariant density is constant on each.
#[test]
fn the_exponent_of_a_markov_map_is_the_known_one() {
    for b in [-1.2_f64, -1.35, -1.5] {
        let a = -b / (b * b - 1.0);
        let fixed = 1.0 / (1.0 - b);
        assert_relative_eq!(a * (b + 1.0) + 1.0, fixed, epsilon = 1e-12);
        // The density is 1 above the fixed point and 1/|b| below; mass on L and on R.
        let (left, right) = ((b + 1.0) / b, fixed / b.abs() + 1.0 - fixed);
        let known = (left * a.ln() + right * b.abs().ln()) / (left + right);
        let map = common::of_the_line([a, b]);
        let found = exponent(&map.end(Vector2::zeros(), 1.0));
        assert!((found.value - known).abs() < 5.0 * found.error, "b = {b}: {found:?}, known {known}");
        assert!(found.error > 0.0 && found.error < 0.003, "b = {b}: {found:?}");
    }
}

/// Lozi's map, 1 - 1.7 |x| + y, 0.5 x: Sprott, Chaos and Time-Series Analysis (2003), gives 0.47023.
#[test]
fn the_exponent_of_lozis_map_is_the_known_one() {
    let found = exponent(&common::normal_form([1.7, -1.7], [-0.5, -0.5]).end(Vector2::zeros(), 1.0));
    assert!((found.value - 0.47023).abs() < 5.0 * found.error && found.error < 0.003, "{found:?}");
}

/// Fixed points and the orbit of period two of the plane's normal form, by trace and determinant.
///
/// Fixed points: `x = mu/(1 - tau + delta)`, stable where `|tau| < 1 + delta` and `|delta| < 1`. Period two: with
/// `D = (1 + dL)(1 + dR) - tL tR`, on L at `mu (1 + dR + tR)/D`, on R at `mu (1 + dL + tL)/D`, stable where `D > 0`,
/// `tL tR + (1 - dL)(1 - dR) > 0` and `|dL dR| < 1`.
#[test]
fn fixed_points_and_period_two_are_where_trace_and_determinant_say() {
    let determinants = [-0.6, 0.15, 0.7, 1.25];
    let mut ended = [0; 3];
    for (t_l, t_r) in grid([-2.53, 2.61], 14).flat_map(|l| grid([-2.57, 2.47], 14).map(move |r| (l, r))) {
        for (d_l, d_r) in determinants.iter().flat_map(|l| determinants.map(|r| (*l, r))) {
            let map = common::normal_form([t_l, t_r], [d_l, d_r]);
            let d = (1.0 + d_l) * (1.0 + d_r) - t_l * t_r;
            let fixed = |t: f64, d: f64| (1.0 / (1.0 - t + d), t.abs() < 1.0 + d && d.abs() < 1.0);
            let (x_l, x_r) = ((1.0 + d_r + t_r) / d, (1.0 + d_l + t_l) / d);
            let two_stable = d > 0.0 && t_l * t_r + (1.0 - d_l) * (1.0 - d_r) > 0.0 && (d_l * d_r).abs() < 1.0;
            for mu in [1.0, -1.0] {
                let ((l, l_stable), (r, r_stable)) = (fixed(t_l, d_l), fixed(t_r, d_r));
                let two = (mu * x_l < 0.0 && mu * x_r > 0.0, two_stable);
                let known = [(mu * l < 0.0, l_stable, l), (mu * r > 0.0, r_stable, r), (two.0, two.1, x_l)];
                for (index, (text, (admissible, stable, x))) in ["L", "R", "LR"].into_iter().zip(known).enumerate() {
                    let case = format!("{text} at mu = {mu}, traces {t_l} {t_r}, determinants {d_l} {d_r}");
                    let orbit = map.orbit(&word(text), mu).unwrap_or_else(|| panic!("{case}"));
                    assert_eq!(orbit.admissible(), admissible, "{case}: {orbit:?}");
                    assert_eq!(orbit.stable(), stable, "{case}: {orbit:?}");
                    assert_relative_eq!(orbit.points[0][0], mu * x, max_relative = 1e-9);
                    if admissible && stable {
                        // A thousandth of the way off it, simulated.
                        let end = map.end(orbit.points[0] * 1.001, mu);
                        assert_eq!(kind(&end), text, "{case}: {end:?}");
                        ended[index] += 1;
                    }
                }
            }
        }
    }
    assert!(ended.iter().all(|count| *count > 300), "{ended:?}");
}

/// Banerjee, Yorke and Grebogi, Robust Chaos (1998), proved by Glendinning and Simpson (2021): with a saddle on L and one that
/// flips on R, `tL > 1 + dL`, `tR < -(1 + dR)` and mu > 0, the map is chaotic, without a stable orbit of any period, where
/// `phi = l (l - dL) + (l - 1)(l tR - dR) > 0`, l the unstable eigenvalue on L.
///
/// Where phi < 0 the saddle's own unstable manifold leaves: its fold, at `(l/(l - dL), 0)`, is carried past the stable one.
/// Chaos that does not reach as far as the fold stays, on nine of the maps.
#[test]
#[ignore = "slow"]
fn chaos_is_robust_where_it_is_known_to_be() {
    let (mut chaotic, mut left, mut stayed) = (0, 0, 0);
    for (d_l, d_r) in [(0.2, 0.2), (0.4, 0.4), (0.3, 0.7), (0.7, 0.3), (0.05, 0.9)] {
        for (t_l, t_r) in grid([1.1, 2.9], 19).flat_map(|l| grid([-3.7, -1.2], 19).map(move |r| (l, r))) {
            if t_l < 1.05 + d_l || t_r > -1.05 - d_r {
                continue;
            }
            let l = 0.5 * (t_l + (t_l * t_l - 4.0 * d_l).sqrt());
            let phi = l * (l - d_l) + (l - 1.0) * (l * t_r - d_r);
            let map = common::normal_form([t_l, t_r], [d_l, d_r]);
            let (from_0, from_fold) = (map.end(Vector2::zeros(), 1.0), map.end(Vector2::new(l / (l - d_l), 0.0), 1.0));
            let case = format!("traces {t_l} {t_r}, determinants {d_l} {d_r}, phi = {phi}: {from_0:?} {from_fold:?}");
            if phi > 1e-3 {
                let stable = map.admissible_orbits(1.0, 6).iter().any(MapOrbit::stable);
                assert!(kind(&from_0) == "chaotic" && kind(&from_fold) == "chaotic" && !stable, "{case}");
                let theorem = map.robust_chaos(1.0).unwrap();
                assert!(theorem.holds() && theorem.saddle == Side::Minus, "{case}");
                assert_relative_eq!(theorem.hypotheses[4].value, phi, max_relative = 1e-9);
                assert!(exponent(&from_0).value > theorem.least_exponent, "{case}: {theorem:?}");
                assert_eq!(map.robust_chaos(-1.0), None);
                chaotic += 1;
            } else if phi < -1e-3 {
                let follows = matches!(&from_fold, LocalLongRun::Escapes(EscapeReason::Follows { word, .. }) if word.to_string() == "L");
                assert!(follows && !map.robust_chaos(1.0).unwrap().holds(), "{case}");
                left += 1;
                stayed += usize::from(kind(&from_0) == "chaotic");
            }
        }
    }
    assert!(chaotic > 200 && left > 200 && stayed == 9, "{chaotic} {left} {stayed}");
}

/// The theorem does not mind which side is called L, nor coordinates; and it is silent where a hypothesis fails.
#[test]
fn the_theorem_of_robust_chaos_has_its_hypotheses() {
    let map = common::normal_form([1.7, -1.5], [0.3, 0.2]);
    let theorem = map.robust_chaos(1.0).unwrap();
    let (e, f) = map.border;
    let mirrored = LocalMap { minus: map.plus, plus: map.minus, border: (-e, -f) };
    let other = mirrored.robust_chaos(1.0).unwrap();
    assert_eq!((theorem.saddle, other.saddle), (Side::Minus, Side::Plus));
    assert_eq!(theorem.hypotheses, other.hypotheses);
    assert!(theorem.holds());
    // l = 1.5, -k = -1.35: l (l - 0.3) + (l - 1)(-1.5 l - 0.2) = 0.575 to the last digit.
    let l = 0.85 + 0.4225_f64.sqrt();
    assert_relative_eq!(l, 1.5, max_relative = 1e-15);
    assert_relative_eq!(theorem.hypotheses[4].value, 0.575, max_relative = 1e-14);
    assert_relative_eq!(theorem.least_exponent, (0.75 + 0.3625_f64.sqrt()).ln(), max_relative = 1e-14);
    // Proved for matrices in intervals, as long as none of these has a hypothesis that fails: at phi = 0.575, 0.1 is too wide.
    for (width, known) in [(1e-3, Evidence::Proved), (0.1, Evidence::Computed)] {
        let around = |entry: f64| Interval::new(entry - width, entry + width);
        let matrices =
            [map.minus, map.plus].map(|side| [0, 1].map(|row| [0, 1].map(|column| around(side.a[(row, column)]))));
        let mut theorem = map.robust_chaos(1.0).unwrap();
        assert_eq!(theorem.known, Evidence::Computed);
        theorem.prove(matrices);
        assert_eq!(theorem.known, known, "{width}");
        theorem.known = Evidence::Computed;
        theorem.prove([matrices[1], matrices[0]]);
        assert_eq!(theorem.known, Evidence::Computed, "the sides exchanged");
    }
    // Nor for matrices of which one hypothesis alone fails, whichever.
    for (failing, traces, determinants) in [
        (0, [1.7, -1.5], [-0.1, 0.2]),
        (1, [1.7, -1.5], [0.3, -0.1]),
        (2, [1.25, -1.5], [0.3, 0.2]),
        (3, [1.7, -1.1], [0.3, 0.2]),
        (4, [1.7, -2.5], [0.3, 0.2]),
    ] {
        let side = |side: usize| [[traces[side], 1.0], [-determinants[side], 0.0]].map(|row| row.map(Interval::from));
        let mut theorem = map.robust_chaos(1.0).unwrap();
        theorem.prove([side(0), side(1)]);
        assert_eq!(theorem.known, Evidence::Computed, "{failing}");
    }
    for (traces, determinants) in
        [([1.29, -1.5], [0.3, 0.2]), ([1.7, -1.19], [0.3, 0.2]), ([1.7, -1.5], [-0.1, 0.2]), ([1.7, -1.5], [0.3, 0.0])]
    {
        assert_eq!(common::normal_form(traces, determinants).robust_chaos(1.0), None, "{traces:?} {determinants:?}");
    }
}

#[test]
fn the_map_is_the_same_at_every_scale() {
    for (traces, determinants) in [([0.4, -1.7], [0.3, 0.2]), ([2.4, 0.3], [0.4, 0.5]), ([1.7, -1.7], [0.3, 0.3])] {
        let map = common::normal_form(traces, determinants);
        for mu in [1.0, -1.0] {
            let (whole, part) = (map.end(Vector2::zeros(), mu), map.end(Vector2::zeros(), mu / 1024.0));
            assert_eq!(kind(&whole), kind(&part));
            if let (LocalLongRun::Periodic(whole), LocalLongRun::Periodic(part)) = (&whole, &part) {
                assert_relative_eq!(whole.points[0] / 1024.0, part.points[0], max_relative = 1e-12);
            }
        }
    }
}

#[test]
fn escapes_name_the_word_that_they_follow() {
    for (slopes, mu, text, multiplier) in
        [([1.5, 0.5], -1.0, "L", 1.5), ([0.5, 3.0], 1.0, "R", 3.0), ([-1.5, -2.0], 1.0, "LR", 3.0)]
    {
        match common::of_the_line(slopes).end(Vector2::zeros(), mu) {
            LocalLongRun::Escapes(EscapeReason::Follows { word, multiplier: found }) => {
                assert_eq!(word.to_string(), text);
                assert_relative_eq!(found, multiplier, max_relative = 1e-12);
            }
            other => panic!("{slopes:?}: {other:?}"),
        }
    }
    // A spiral away follows no word for ever.
    let spiral = common::normal_form([0.9, 0.8], [1.2, 1.3]).end(Vector2::zeros(), 1.0);
    assert_eq!(spiral, LocalLongRun::Escapes(EscapeReason::Grown));
}

#[test]
fn at_the_corner_impact_itself_the_map_shrinks_or_grows() {
    let fate = |traces, determinants| {
        let outcome = common::normal_form(traces, determinants).outcome(0.0);
        assert!(outcome.fixed_points.is_empty() && outcome.orbits.is_empty() && outcome.starts() == 24);
        outcome.fates.iter().map(|fate| kind(&fate.end)).collect::<Vec<_>>()
    };
    assert_eq!(fate([0.5, -0.4], [0.3, 0.5]), ["corner"]);
    assert_eq!(fate([1.899, 1.898], [0.9, 0.899]), ["corner"], "slowly, without turning");
    assert_eq!(fate([-2.0, -2.0], [0.5, 0.5]), ["escapes"]);
    // A saddle on L only: what lies on the other side of its stable direction comes to R and may come back.
    assert!(fate([1.5, 0.2], [0.2, 0.1]).contains(&"escapes".to_owned()));
}

/// A motion that is said to follow a word for ever does so as far as it is run, from any point.
#[test]
fn what_follows_a_word_for_ever_follows_it() {
    let (mut said, mut silent) = (0, 0);
    for (traces, determinants, text) in [
        ([2.02, 0.5], [1.0195, 0.3], "L"),
        ([2.3, 0.5], [1.2, 0.3], "L"),
        ([0.4, 2.05], [0.3, 1.048], "R"),
        ([-1.5, -1.9], [0.3, 0.4], "LR"),
        ([0.5, -3.4], [1.3, -1.2], "LR"),
    ] {
        let map = common::normal_form(traces, determinants);
        let word = word(text);
        for (x, y) in grid([-41.3, 39.7], 82).flat_map(|x| grid([-60.1, 58.9], 60).map(move |y| (x, y))) {
            for mu in [1.0, -1.0] {
                let mut point = Vector2::new(x, y);
                let follows = (0..600).all(|step| {
                    let side = map.side(point, mu);
                    point = map.apply(point, mu);
                    side == word.sides()[step % word.sides().len()]
                });
                match map.follows_for_ever(&word, Vector2::new(x, y), mu) {
                    Some(_) => {
                        assert!(follows, "{text} from {x} {y} at mu = {mu}, traces {traces:?}");
                        said += 1;
                    }
                    None => silent += usize::from(follows),
                }
            }
        }
    }
    // Sufficient, not necessary; and not so narrow that it says nothing.
    assert!(said > 2000 && silent < said, "{said} {silent}");
}

/// 1/4 is a double and the unstable fixed point of R: rounding alone would keep the motion there.
#[test]
fn a_motion_does_not_rest_on_an_unstable_orbit() {
    let map = common::of_the_line([0.25, -3.0]);
    assert_eq!(map.apply(Vector2::new(0.25, 0.0), 1.0)[0], 0.25);
    assert_eq!(kind(&map.end(Vector2::new(0.25, 0.0), 1.0)), "LR");
}

/// A thousand steps on L towards a stable fixed point that lies on the other side are no settled motion.
#[test]
fn a_motion_does_not_settle_on_an_orbit_of_the_other_side() {
    let map = common::of_the_line([0.999, 0.5]);
    let end = map.end(Vector2::new(-1e6, 0.0), 1.0);
    assert_eq!(kind(&end), "R", "{end:?}");
}

/// To five digits; what is nothing but rounding is 0.
fn digits(number: f64) -> String {
    if number.abs() < 1e-12 { "0".into() } else { format!("{number:.4e}") }
}

/// What a map does at one sign of mu: its orbits, the theorem, and where motions end.
fn told(map: &LocalMap, mu: f64) -> String {
    let outcome = map.outcome(mu);
    let mut text = String::new();
    for orbit in outcome.fixed_points.iter().chain(&outcome.period_two) {
        let points = orbit.points.iter().map(|point| format!("({}, {})", digits(point[0]), digits(point[1])));
        let points: Vec<_> = points.collect();
        writeln!(text, "  orbit {} {} margin {}", orbit.word, points.join(" "), digits(orbit.margin)).unwrap();
    }
    // Of longer ones the word says where the points are.
    let words = outcome.orbits.iter().map(|orbit| orbit.word.to_string());
    writeln!(text, "  there: {}", words.collect::<Vec<_>>().join(" ")).unwrap();
    if let Some(theorem) = outcome.robust_chaos {
        let distances = theorem.hypotheses.map(|condition| digits(condition.distance));
        let holds = theorem.holds();
        writeln!(text, "  saddle {:?} {} holds {holds}", theorem.saddle, distances.join(" ")).unwrap();
    }
    for fate in outcome.fates {
        let more = match &fate.end {
            LocalLongRun::Chaotic(chaos) => {
                let (exponent, region) = (chaos.exponent, chaos.region);
                format!(" {} in {} polygons of {} corners", digits(exponent.value), region.polygons, region.corners)
            }
            // How fast what never settles parts is known to its error.
            LocalLongRun::Undecided(exponent) => format!(" above {:.3}", exponent.value - 5.0 * exponent.error),
            LocalLongRun::Escapes(EscapeReason::Follows { word, multiplier }) => {
                format!(" by {word}, {}", digits(*multiplier))
            }
            _ => String::new(),
        };
        writeln!(text, "  {} {}{more}", fate.starts, kind(&fate.end)).unwrap();
    }
    text
}

/// Sums, products and comparisons alone decide where the motion from 0 goes, which is the first that is told; of starts on circles it is told
/// how many go where.
#[test]
fn what_local_maps_do_is_as_it_was() {
    let mut text = String::new();
    for (traces, determinants) in [
        ([0.4, -1.7], [0.3, 0.2]),
        ([2.4, 0.3], [0.4, 0.5]),
        ([1.7, -1.5], [0.3, 0.2]),
        ([1.8, -1.954043], [0.3, 0.3]),
        ([2.1, -1.4777777777777779], [0.4, 0.4]),
        ([-1.2, -0.9], [0.3, 0.4]),
        ([0.4, 2.05], [0.3, 1.048]),
        ([-0.3, -1.4], [0.9, 0.85]),
        ([0.9, -1.9], [-0.3, 1.4]),
    ] {
        // Where coordinates are not those of the normal form, and the border does not go through 0.
        let map = common::normal_form(traces, determinants);
        let moved = LocalMap { border: (map.border.0 * 2.0, 0.3), ..map };
        for (name, map) in [("", map), ("moved ", moved)] {
            let scales = map.scales();
            let scales = format!("{} {}", digits(scales[0]), digits(scales[1]));
            writeln!(text, "{name}traces {traces:?}, determinants {determinants:?}: scales {scales}").unwrap();
            for mu in [1.0, -1.0, 0.0] {
                let decade = passage::revolutions_per_decade(&map).map_or("none".into(), digits);
                let leaves = passage::linear(&map, 1e-4 * mu, 10.0, 1000);
                writeln!(text, " mu {mu}: a decade in {decade}, away after {leaves:?}").unwrap();
                text += &told(&map, mu);
            }
        }
    }
    for slopes in [[0.5, -1.3], [-1.5, -2.0], [0.3, -4.0]] {
        writeln!(text, "the line with slopes {slopes:?}").unwrap();
        text += &told(&common::of_the_line(slopes), 1.0);
    }
    is_as_it_was("local-maps", &text);
}

/// One revolution more or less, and a hundredth of them; who never leaves agrees with nobody.
#[test]
fn passages_agree_within_a_hundredth() {
    for (linear, simulated, agree) in [
        (Some(100), Some(102), true),
        (Some(100), Some(98), true),
        (Some(100), Some(103), false),
        (Some(1), Some(2), true),
        (Some(1), Some(3), false),
        (Some(300), Some(305), false),
        (None, None, false),
        (Some(5), None, false),
    ] {
        assert_eq!(passage::agree(linear, simulated), agree, "{linear:?} {simulated:?}");
    }
}

/// A complex pair turns a deviation and carries it off along no direction, however large its real part is: 1.5 of the left side. The right
/// side's pair is 2 and 1/2.
#[test]
fn a_complex_pair_has_no_rate_at_which_it_is_left() {
    assert_eq!(passage::revolutions_per_decade(&common::normal_form([3.0, 0.4], [4.0, 0.2])), None);
    let beside = passage::revolutions_per_decade(&common::normal_form([3.0, 2.5], [4.0, 1.0])).unwrap();
    assert_relative_eq!(beside, std::f64::consts::LN_10 / std::f64::consts::LN_2, max_relative = 1e-14);
}

/// By hand, of l = 2: each over `|tau| + |delta| + 1`, and phi = 2 (2 - 1) + 1 (-4.4 - 0.6) over 2 + 5.
#[test]
fn how_far_a_hypothesis_is_from_failing_is_told_over_its_terms() {
    let theorem = common::normal_form([2.5, -2.2], [1.0, 0.6]).robust_chaos(1.0).unwrap();
    let expected = [1.0, 1.0, 0.5 / 4.5, 0.6 / 3.8, -3.0 / 7.0];
    for (hypothesis, distance) in theorem.hypotheses.iter().zip(expected) {
        assert_relative_eq!(hypothesis.distance, distance, max_relative = 1e-13);
    }
}

/// Traces 1.7 and -1.5 with determinants 0.3 and 0.2, for which the theorem holds, in coordinates in which both entries of a trace count.
#[test]
fn robust_chaos_is_proved_in_any_coordinates() {
    let side = |half: f64, product: f64| [[half, 1.0], [-product, half]].map(|row| row.map(Interval::from));
    let map = common::normal_form([1.7, -1.5], [0.3, 0.2]);
    let mut theorem = map.robust_chaos(1.0).unwrap();
    // 0.85^2 + c = 0.3 and 0.75^2 + c = 0.2
    theorem.prove([side(0.85, 0.3 - 0.7225), side(-0.75, 0.2 - 0.5625)]);
    assert_eq!(theorem.known, Evidence::Proved);
    // At the other sign of mu the saddles are not there.
    assert_eq!(map.robust_chaos(-1.0), None);
}

/// What shrinks is never away, however slowly it shrinks; what grows by less than is told from 1 is not said to.
#[test]
fn what_does_not_grow_follows_no_word_for_ever() {
    for (growth, follows) in [(1.0 - 5e-10, false), (1.0 + 5e-10, false), (1.0 + 2e-9, true)] {
        let mut map = common::of_the_line([growth, 0.5]);
        map.minus.b = Vector2::zeros();
        let found = map.follows_for_ever(&word("L"), Vector2::new(-9.0, 0.0), 1.0);
        assert_eq!(found.is_some(), follows, "{growth:e} {found:?}");
    }
}

/// x' = mu - 2 x leaves its fixed point mu/3, twofold and on either side of it by turns: below 0 and mu from the first, it goes on for ever.
#[test]
fn a_motion_that_alternates_is_followed_from_side_to_side() {
    let map = common::of_the_line([-2.0; 2]);
    for (start, mu) in [(-0.5, 1.0), (-1.0, -0.25), (-8.0, 4.0)] {
        assert_eq!(map.follows_for_ever(&word("LR"), Vector2::new(start, 0.0), mu), Some(4.0), "{start} {mu}");
    }
}

/// Slopes 2 and 1/2 at the corner impact itself: what is on the left grows, what is on the right shrinks. Half of all directions point to
/// either side.
#[test]
fn starts_lie_all_around_the_corner() {
    let outcome = common::of_the_line([2.0, 0.5]).outcome(0.0);
    let mut fates: Vec<_> = outcome.fates.iter().map(|fate| (fate.end.name(), fate.starts)).collect();
    fates.sort_unstable();
    assert_eq!(fates, [("corner", 12), ("escapes", 12)]);
}

/// `(x, y) -> (y, g(x))` is g of x and of y by turns. Of an orbit of three of g, a pair of its points that are i and j steps on goes to one of
/// j and i + 1: j - i becomes 1 - (j - i), so that 0 and 1 are one orbit, of six, and 2 is another, of three.
#[test]
fn two_orbits_at_once_are_told_apart() {
    // g is x/2 + 1 to the left of 0 and 1 - 7x/2 to the right, and its orbit of three is stable: 7/2 over 4 is below 1.
    let map = two_maps_of_the_line([0.5, -3.5], 0.0);
    let outcome = map.outcome(1.0);
    let mut words: Vec<_> = outcome.fates.iter().map(|fate| kind(&fate.end)).collect();
    words.sort_unstable();
    assert_eq!(words, ["LLLLRR", "LLR"]);
}

/// The maps of x and of y by turns, with `more` of y in the next.
fn two_maps_of_the_line(slopes: [f64; 2], more: f64) -> LocalMap {
    let [minus, plus] =
        slopes.map(|slope| SideMap { a: Matrix2::new(0.0, 1.0, slope, more), b: Vector2::new(0.0, 1.0) });
    LocalMap { minus, plus, ..common::of_the_line(slopes) }
}

/// Where that orbit is unstable by little, 1.025 a round, there is chaos in three pieces around it, and of pairs of pieces there are the same two
/// kinds: what joins x and y a little parts neighbours in one more than in the other.
#[test]
fn two_kinds_of_chaos_at_once_are_told_apart() {
    let outcome = two_maps_of_the_line([0.5, -4.1], 0.02).outcome(1.0);
    let exponents: Vec<_> = outcome.fates.iter().map(|fate| exponent(&fate.end)).collect();
    let [one, other] = exponents.as_slice() else { panic!("{exponents:?}") };
    assert!((one.value - other.value).abs() > 5.0 * one.error.hypot(other.error), "{exponents:?}");
}

/// Two motions that begin close to each other are as close after forty thousand steps, within a factor of a thousand: if there is an exponent
/// it is below ln 1000 over 40,000, which a mean over parts of a thousand does not tell from 0.
#[test]
fn a_motion_whose_neighbours_stay_is_not_called_chaotic() {
    for (traces, determinants) in
        [([-1.5, -1.3], [0.0, 1.3]), ([-1.5, -1.3], [-0.2, 1.3]), ([0.9, 0.7], [0.3, 1.1]), ([-0.3, -0.7], [0.7, 1.2])]
    {
        let map = common::normal_form(traces, determinants);
        let (mut x, mut beside) = (Vector2::zeros(), Vector2::new(1e-10, 0.0));
        for _ in 0..40_000 {
            (x, beside) = (map.apply(x, 1.0), map.apply(beside, 1.0));
        }
        assert!((x - beside).norm() < 1e-7 && x.norm() < 100.0, "{traces:?} {determinants:?}: {x} {beside}");
        let end = map.end(Vector2::zeros(), 1.0);
        assert!(matches!(end, LocalLongRun::Undecided(_)), "{traces:?} {determinants:?}: {end:?}");
    }
}

/// Both saddles grow by a millionth a step: for thousands of steps a motion stays next to one and then the other, so that its parts tell hardly
/// anything of its exponent. By the theorem no exponent is below ln l, and what is sent into itself is chaotic.
#[test]
fn chaos_by_the_theorem_needs_no_measured_exponent() {
    let (determinant, trace) = (0.3, 1.3 + 1.5e-6);
    let map = common::normal_form([trace, -trace], [determinant; 2]);
    assert!(map.robust_chaos(1.0).unwrap().holds());
    let l: f64 = 0.5 * (trace + (trace * trace - 4.0 * determinant).sqrt());
    match map.end(Vector2::zeros(), 1.0) {
        LocalLongRun::Chaotic(chaos) => {
            assert!(chaos.exponent.error > 0.2 * chaos.exponent.value, "{chaos:?}");
            assert_relative_eq!(chaos.least_exponent.unwrap(), l.ln(), max_relative = 1e-9);
        }
        end => panic!("{end:?}"),
    }
}
