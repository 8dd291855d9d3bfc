//! Does the order of the derivative that jumps decide the map at a corner, as predicted?
//!
//! `UPDATE_DOCS=1 cargo test --release --test jump_order` writes the table of `docs/jump-order.md`.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use std::path::Path;

use crate::common;
use corner_impact::cam::Corner;
use corner_impact::corner::jump_order::compared::{Compared, PowerLawQuantity, compare};
use corner_impact::corner::jump_order::measured::{SideFlights, gap};
use corner_impact::corner::jump_order::predicted::{self, Hits};
use corner_impact::corner::jump_order::{Approach, JumpOrderError};
use corner_impact::corner::{closed_form, locate};
use corner_impact::model::{CamProfile, Model};
use corner_impact::paper::jump_order::{EXAMPLES, Example};
use nalgebra::{Matrix3, Vector3};

fn compared() -> Vec<(&'static Example, Compared)> {
    EXAMPLES.iter().map(|example| (example, example.compare().unwrap())).collect()
}

fn law(name: &str) -> Model {
    common::read(&Path::new(common::ROOT).join("models/laws").join(name))
}

/// A flight onto `corner` that closes at `closing`, m/s, at `omega`, rad/s.
fn approach(corner: Corner, omega: f64, closing: f64) -> Approach {
    Approach::new(corner, omega, omega * corner.minus.slope - closing).unwrap()
}

#[test]
fn exponents_and_coefficients_are_those_of_the_formulas() {
    for (example, compared) in compared() {
        let order = compared.approach.corner.jump_order as u32;
        assert!(compared.agrees(), "{}: {compared:#?}", example.name);
        for row in &compared.rows {
            let expected = match row.quantity {
                PowerLawQuantity::Position if order == 1 => 2,
                PowerLawQuantity::Position => order,
                _ => order - 1,
            };
            assert_eq!(row.predicted.exponent, expected, "{}: {row:?}", example.name);
            let off = (row.measured.coefficient.value - row.predicted.coefficient).abs();
            let size = row.predicted.coefficient.abs();
            // The formula itself is rounded, and J is a difference of derivatives.
            let known = 4.0 * row.measured.coefficient.error + 1e-8 * size;
            assert!(off <= known, "{}: off by {off:e}, known to {known:e}: {row:?}", example.name);
            assert!(row.measured.exponent.error < 1e-5, "{}: {row:?}", example.name);
            assert!(row.measured.coefficient.error < 1e-5 * size, "{}: {row:?}", example.name);
        }
    }
}

#[test]
fn every_order_from_one_to_four_and_every_way_to_hit_is_there() {
    let all = compared();
    for order in 1..=4 {
        let of_order = all.iter().filter(|(_, one)| one.approach.corner.jump_order == order);
        let moving = of_order.clone().filter(|(_, one)| one.approach.corner.minus.slope != 0.0).count();
        assert!(of_order.count() >= 2 && moving >= 1, "order {order}");
    }
    for hits in [Hits::Once, Hits::NeverAfter, Hits::TwiceBefore] {
        assert!(all.iter().any(|(_, one)| one.hits == hits), "{hits:?}");
    }
    for (_, one) in all.iter().filter(|(_, one)| one.hits == Hits::Once) {
        assert!(one.rows.len() >= 4 && one.span > 0.5, "{one:?}");
    }
}

/// On a located orbit the prediction is the closed form's own jump, A+ - A- and B+ - B-, on every model.
#[test]
fn order_two_is_the_rank_one_jump_of_the_closed_form() {
    for file in common::model_files() {
        let model = common::read(&file);
        let at = locate(&model, &common::cam(&model)).unwrap().0;
        let map = closed_form::route(&model, &at).map;
        let (jump_a, jump_b) = (map.plus.a - map.minus.a, map.plus.b - map.minus.b);
        let over = predicted::over(&model.follower, &Approach::of(&at).unwrap(), PI, PI);
        assert_eq!(over.exponent, 1);
        let scale = Vector3::new(jump_a.column(0).norm(), jump_a.column(1).norm(), jump_b.norm());
        for direction in 0..3 {
            let mut z = Vector3::zeros();
            z[direction] = 1.0;
            let expected = if direction < 2 { jump_a.column(direction).into_owned() } else { jump_b };
            assert!((over.at(z) - expected).norm() <= 1e-10 * scale[direction], "{file:?} {direction}");
        }
    }
}

/// The jump of the second derivatives is the same quadratic form in every direction, mixed ones too; below it nothing jumps.
#[test]
fn order_three_jumps_in_the_second_derivative_only() {
    for example in EXAMPLES.iter().filter(|example| example.name.starts_with("jerk")) {
        let (model, cam, approach) = example.build().unwrap();
        let sides = SideFlights::new(&model, &cam, &approach).unwrap();
        let over = predicted::over(&model.follower, &approach, sides.span(), sides.span());
        let scales = sides.scales();
        let parts = Matrix3::new(0.6, -0.4, 0.5, -0.3, 0.2, 0.7, 0.8, 0.3, -0.2);
        for part in parts.row_iter() {
            let z = scales.component_mul(&part.transpose());
            let found = sides.along(z).unwrap();
            for (law, expected) in found.iter().zip(over.at(z).iter()) {
                assert!((law.exponent.value - 2.0).abs() < 1e-4, "{} {z} {law:?}", example.name);
                let off = (law.coefficient.value - expected).abs();
                assert!(off <= 1e-6 * expected.abs(), "{} {z}: {law:?} {expected:e}", example.name);
            }
        }
        // And the closed form gives both sides one A and B.
        let [minus, plus] = [approach.corner.minus, approach.corner.plus].map(|lift| {
            closed_form::side_map(&model.follower, TAU / approach.angular_velocity, approach.velocity_before, &lift)
        });
        assert!((plus.a - minus.a).norm() <= 1e-12 * minus.a.norm());
        assert!((plus.b - minus.b).norm() <= 1e-12 * minus.b.norm());
    }
}

/// From the slowest approach to the fastest: the gap follows J held between -u- and r u-, and the impacts change where it says.
#[test]
fn the_gap_of_a_velocity_jump_is_held_between_two_bounds() {
    for amplitude in [1.0, -1.0] {
        let mut model = law("rectified-sine.toml");
        let CamProfile::RectifiedSine(profile) = &mut model.cam else { panic!("{:?}", model.cam) };
        profile.amplitude = amplitude;
        let cam = common::cam(&model);
        let corner = cam.corners()[1];
        let (r, jump) = (model.follower.restitution, 2.0 * amplitude);
        let mut ways = Vec::new();
        for closing in [0.3, 1.0, 1.9, 2.1, 2.4, 2.6, 4.0, 9.0] {
            let approach = approach(corner, 1.0, closing);
            let found = gap(&model, &cam, &approach).unwrap();
            // Before the corner: struck once, or twice. After it: struck, or missed. Velocities against the cam before it.
            let before = if r * closing < jump { jump - r * (r * closing - jump) } else { r * closing };
            let after = if closing + jump > 0.0 { jump + r * (closing + jump) } else { -closing };
            let expected = after - before;
            assert!((found.limit[1].value - expected).abs() < 1e-10, "{closing}: {found:?} {expected}");
            assert!(found.limit[0].value.abs() < 1e-10, "the position has no gap: {found:?}");
            let step = predicted::over(&model.follower, &approach, 0.0, 0.0).step;
            assert!((step[1] - expected).abs() < 1e-12 && step[0] == 0.0, "{closing}: {step} {expected}");
            let hits = predicted::hits(&model.follower, &approach);
            let impacts = [1 + usize::from(hits == Hits::TwiceBefore), usize::from(hits != Hits::NeverAfter)];
            assert_eq!(found.impacts, impacts, "{closing}");
            ways.push(hits);
        }
        ways.dedup();
        let other = if amplitude > 0.0 { Hits::TwiceBefore } else { Hits::NeverAfter };
        assert_eq!(ways, [other, Hits::Once]);
    }
}

/// A plastic follower keeps nothing of where it came from: on a corner that turns up the gap closes.
#[test]
fn a_plastic_follower_has_no_gap_at_a_corner_that_turns_up() {
    let mut model = law("rectified-sine.toml");
    model.follower.restitution = 0.0;
    let corner = common::cam(&model).corners()[1];
    assert_eq!(predicted::over(&model.follower, &approach(corner, 1.0, 4.0), 0.0, 0.0).step[1], 0.0);
}

#[test]
fn what_cannot_be_compared_says_why() {
    let model = law("rectified-sine.toml");
    let cam = common::cam(&model);
    let corner = cam.corners()[1];
    for (omega, velocity) in
        [(1.0, 5.0), (1.0, f64::NAN), (0.0, -5.0), (f64::INFINITY, -5.0), (-1.0, -5.0), (1.0, f64::NEG_INFINITY)]
    {
        let error = Approach::new(corner, omega, velocity).unwrap_err();
        assert!(matches!(error, JumpOrderError::NotFromAbove { .. }), "{omega} {velocity}: {error}");
    }
    // A hundred times slower than it falls: whatever it did before, it came through the cam.
    let error = compare(&model, &cam, &approach(corner, 1.0, 1e-9)).unwrap_err();
    assert!(error.to_string().starts_with("jump order: "), "{error}");
    // By hand the fields may hold anything.
    let wild = Approach { corner, angular_velocity: f64::NAN, velocity_before: f64::INFINITY };
    assert!(compare(&model, &cam, &wild).is_err());
}

const PAGE: &str = "docs/jump-order.md";
const MARKS: [&str; 2] = ["<!-- measured: begin -->\n", "<!-- measured: end -->\n"];

fn words(quantity: PowerLawQuantity) -> &'static str {
    match quantity {
        PowerLawQuantity::Gap => "velocity, cam as it is",
        PowerLawQuantity::Velocity => "velocity at the corner",
        PowerLawQuantity::Position => "position at the corner",
        PowerLawQuantity::MapOfPosition => "position after the map, by dx1",
        PowerLawQuantity::MapOfPeriod => "velocity after the map, by dT",
    }
}

/// The table, with the columns that rounding decides last.
fn table() -> String {
    let mut table = String::from(
        "| j | corner | of | exponent: formula | simulated | coefficient: formula | simulated | exponent off by | coefficient off by |\n\
         |--:|---|---|--:|--:|--:|--:|--:|--:|\n",
    );
    for (example, compared) in compared() {
        for row in &compared.rows {
            let exponent = row.measured.exponent.value;
            writeln!(
                table,
                "| {} | {} | {} | {} | {:.3} | {:.4e} | {:.4e} | {:.0e} ± {:.0e} | {:.0e} |",
                compared.approach.corner.jump_order,
                example.name,
                words(row.quantity),
                row.predicted.exponent,
                // Rounding decides the sign of a zero.
                if exponent.abs() < 5e-4 { 0.0 } else { exponent },
                row.predicted.coefficient,
                row.measured.coefficient.value,
                (exponent - f64::from(row.predicted.exponent)).abs(),
                row.measured.exponent.error,
                row.relative_difference(),
            )
            .unwrap();
        }
    }
    table
}

/// What does not depend on the machine: all but the last two columns.
fn kept(table: &str) -> Vec<Vec<&str>> {
    table.lines().map(|line| line.split('|').take(8).map(str::trim).collect()).collect()
}

#[test]
fn the_page_in_docs_has_the_measured_table() {
    let path = Path::new(common::ROOT).join(PAGE);
    let page = std::fs::read_to_string(&path).unwrap();
    let (head, rest) = page.split_once(MARKS[0]).unwrap();
    let (stored, tail) = rest.split_once(MARKS[1]).unwrap();
    let fresh = table();
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(&path, [head, MARKS[0], &fresh, MARKS[1], tail].concat()).unwrap();
    } else {
        assert_eq!(kept(stored), kept(&fresh), "{PAGE} is stale: UPDATE_DOCS=1 writes the table");
    }
}
