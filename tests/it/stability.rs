//! Is an orbit stable, unstable or neutral as its multipliers say, no better than these are known?

use std::f64::consts::TAU;

use corner_impact::cam::Cam;
use corner_impact::interval::Interval;
use corner_impact::known::Evidence;
use corner_impact::model::Model;
use corner_impact::orbit::branch::{Branch, Following};
use corner_impact::orbit::stability::{Rows, multipliers_error, trace};
use corner_impact::orbit::{Course, Parameter, PeriodicOrbit, Search, Stability, search};
use corner_impact::progress::Unwatched;
use corner_impact::simulate::{Machine, angular_velocity};
use corner_impact::study::orbit::{OrbitQuery, Orbits, orbits};
use corner_impact_cli::figures;
use corner_impact_cli::show::Paged;
use nalgebra::Matrix2;
use serde_json::Value;

const GRAVITY: f64 = 9.81;
const AMPLITUDE: f64 = 0.01;

/// A ball on a table that moves by `AMPLITUDE cos(theta + 90 deg)`: its top is at 270 degrees, its bottom at 90.
fn table(damping: f64, restitution: f64) -> Model {
    let text = format!(
        "name = \"table\"\n[follower]\nmass = 1.0\ndamping = {damping:e}\nstiffness = 0.0\ngravity = {GRAVITY}\nrest_position = 0.0\n\
         restitution = {restitution:?}\n[cam]\nlaw = \"harmonic\"\noffset = 0.0\namplitudes = [{AMPLITUDE}]\nphases_deg = [90.0]\n"
    );
    Model::parse("table.toml", &text).unwrap()
}

fn at(model: &Model, rpm: f64) -> Machine {
    Machine::new(Cam::new(model).unwrap(), &model.follower, angular_velocity(rpm))
}

fn found(model: &Model, rpm: f64, impacts: Option<usize>) -> Orbits {
    orbits(model, rpm, OrbitQuery::All(Search { revolutions: 1, impacts }), &Unwatched).unwrap()
}

/// The orbit of one impact at the top of an elastic table whose largest acceleration is `ratio` times gravity.
fn on_top(ratio: f64) -> PeriodicOrbit {
    let rpm = (ratio * GRAVITY / AMPLITUDE).sqrt() * 60.0 / TAU;
    let all = found(&table(0.0, 1.0), rpm, Some(1)).orbits;
    let is_on_top = |orbit: &PeriodicOrbit| orbit.impacts().all(|impact| (impact.cam_angle - 0.75 * TAU).abs() < 1e-3);
    all.into_iter().find(|orbit| matches!(orbit.course, Course::Impacts(_)) && is_on_top(orbit)).expect("an orbit")
}

/// In another unit of time multipliers are the same numbers, known as well: the speeds at impacts are known by lifts over that unit.
#[test]
fn multipliers_are_known_as_well_in_any_unit_of_time() {
    let own = crate::common::osorio().with_number("follower.damping", 5.0).unwrap();
    let told = |power: i32| {
        let unit = 2.0_f64.powi(power);
        let numbers = [("stiffness", unit * unit), ("damping", unit), ("gravity", unit * unit)];
        let scaled = numbers.into_iter().fold(own.clone(), |model, (name, by)| {
            let path = format!("follower.{name}");
            let now = model.numbers().find(|(known, _)| *known == path).unwrap().1;
            model.with_number(&path, now * by).unwrap()
        });
        let all = found(&scaled, 700.0 * unit, None).orbits;
        let errors = all.iter().filter(|orbit| matches!(orbit.course, Course::Impacts(_)));
        errors.map(|orbit| orbit.judgement.error).collect::<Vec<f64>>()
    };
    let once = told(0);
    assert!(!once.is_empty() && once.iter().all(|error| (1e-16..1e-10).contains(error)), "{once:?}");
    for power in [-12, 12] {
        for (one, other) in once.iter().zip(told(power)) {
            assert!((one / other - 1.0).abs() < 0.01, "{power}: {one:e} {other:e}");
        }
    }
}

/// It leaves at g T/2 and comes back at as much, so that `tr M = 2 + 4 c''/g` with `c'' = -a w^2`, and det M = 1: a pair on the unit
/// circle up to the ratio 1, and beyond it two real ones. Next to 1 a part in 1e12 is told, one of 1e-16 is not.
#[test]
#[ignore = "slow"]
fn an_elastic_balls_orbit_is_neutral_up_to_its_flip_and_unstable_beyond() {
    let told = |ratio: f64| on_top(ratio).judgement.stability;
    for ratio in [0.1, 0.5, 0.9, 1.0 - 1e-12, 1.0] {
        assert_eq!(told(ratio), Stability::Neutral, "{ratio}");
    }
    for ratio in [1.0 + 1e-12, 1.1, 3.0] {
        assert_eq!(told(ratio), Stability::Unstable, "{ratio}");
    }
    for ratio in [0.5, 1.0 - 1e-6, 1.0 + 1e-6, 3.0] {
        assert_eq!(on_top(ratio).judgement.known, Evidence::Proved, "{ratio}");
    }
    assert_eq!(on_top(1.0).judgement.known, Evidence::Computed);
    assert!(!on_top(0.5).is_stable() && !on_top(3.0).is_stable());
}

/// The multipliers are `-1 + x +- sqrt(x^2 - 2 x)` with `x = 2 (1 - ratio)`. Where they nearly meet at -1, an error of an ulp moves them
/// by its root: 1e-8 there, 1e-14 away from there.
#[test]
fn multipliers_are_as_near_as_their_error_says() {
    for (ratio, most) in [(0.5, 1e-13), (1.0 - 1e-6, 1e-11), (1.0 - 1e-12, 1e-7), (1.0 + 1e-12, 1e-7), (3.0, 1e-12)] {
        let orbit = on_top(ratio);
        let x = 2.0 * (1.0 - ratio);
        let (re, square) = (-1.0 + x, x * x - 2.0 * x);
        let root = square.abs().sqrt();
        let exact = [1.0, -1.0].map(|sign| if square > 0.0 { (re + sign * root, 0.0) } else { (re, sign * root) });
        let error = orbit.judgement.error;
        assert!((1e-16..most).contains(&error), "{ratio}: {error:e}");
        for (told, exact) in orbit.multipliers().iter().zip(exact) {
            let apart = (told.re - exact.0).hypot(told.im - exact.1);
            // The speed is a double itself, and so is the ratio.
            assert!(apart <= error + 1e-15 / root.max(1e-8), "{ratio}: {apart:e} of {error:e}");
        }
    }
}

/// Thirteen orbits with a pair of multipliers on the unit circle were called stable or unstable by the last bit of their moduli.
#[test]
fn with_restitution_1_no_orbit_is_stable_and_none_comes_to_rest() {
    let all = found(&table(0.0, 1.0), 200.0, None);
    let told = |orbit: &PeriodicOrbit| {
        let pair = orbit.multipliers();
        match orbit.course {
            Course::Sticking(_) => pair.iter().all(|one| one.re.is_nan()).then_some(Stability::Neutral),
            // A pair of real ones may be on the circle within their error.
            _ if pair[0].im != 0.0 || (pair[0].modulus() - 1.0).abs() <= orbit.judgement.error => {
                Some(Stability::Neutral)
            }
            _ => Some(Stability::Unstable),
        }
    };
    for orbit in &all.orbits {
        assert_eq!(Some(orbit.judgement.stability), told(orbit), "{orbit:?}");
    }
    let count = |stability| all.orbits.iter().filter(|orbit| orbit.judgement.stability == stability).count();
    assert!(count(Stability::Neutral) > 10 && count(Stability::Unstable) > 0, "{all:?}");
    let resting = all.orbits.iter().filter(|orbit| matches!(orbit.course, Course::Sticking(_))).count();
    assert_eq!(resting, 1);
    let document: Value = serde_json::to_value(&all).unwrap();
    for orbit in document["orbits"].as_array().unwrap() {
        assert_ne!(orbit["stability"], "stable");
        assert_eq!((&orbit["stable"], &orbit["multipliers_known"]), (&Value::from(false), &Value::from("computed")));
    }
    let page = all.text().unwrap();
    assert!(page.contains("none: with restitution 1 no bounce ends in a rest") && page.contains(", neutral"), "{page}");
    assert!(!page.contains(", stable") && !page.contains("NaN"), "{page}");
}

/// det M is `e^{-b T/m}`, 3e-10 below 1: the modulus of a pair is half as much below 1, and known to be.
#[test]
fn the_least_damping_makes_a_neutral_orbit_stable() {
    let all = found(&table(1e-9, 1.0), 200.0, Some(1)).orbits;
    let pair = all.iter().find(|orbit| orbit.multipliers()[0].im != 0.0).expect("a pair");
    assert_eq!((pair.judgement.stability, pair.judgement.known), (Stability::Stable, Evidence::Proved));
    assert!(pair.is_stable());
    let resting = search(&at(&table(1e-9, 1.0), 200.0), &Search { revolutions: 1, impacts: None }).unwrap();
    let resting = resting.iter().find(|orbit| matches!(orbit.course, Course::Sticking(_))).expect("a rest");
    assert_eq!(resting.judgement.stability, Stability::Stable);
}

/// A low bounce on a cam that presses all the time keeps its height, or loses `b/(3 m)` of its speed a second: no bounce ends in a rest,
/// and only a damper draws one to it.
#[test]
fn a_low_elastic_bounce_stays_as_low_or_is_damped_to_a_rest() {
    let (first, revolutions) = (0.02, 10);
    for damping in [0.0, 0.3] {
        let machine = at(&table(damping, 1.0), 60.0);
        let mut motion = machine.start_on_cam(1.0, first).unwrap();
        let goal = motion.after(revolutions);
        machine.revolve(&mut motion, revolutions - 1).unwrap();
        let mut fastest = 0.0_f64;
        let _ = machine.advance(&mut motion, goal, &mut |event: &corner_impact::simulate::Event| {
            fastest = fastest.max(event.velocity_after - event.cam_velocity);
            std::ops::ControlFlow::Continue(())
        });
        let slowest = first * (-damping * 60.0 / 60.0 * (revolutions - 1) as f64 / 3.0_f64).exp();
        // u^3 over the force of contact, which changes by 4 %, is kept.
        assert!((0.97..1.05).contains(&(fastest / slowest)), "{damping}: {fastest} of {slowest}");
        assert!(!motion.contact);
    }
}

/// Along a branch of an elastic ball orbits are neutral up to the flip, and unstable beyond: lines of two kinds, and points of the flip
/// where a multiplier is on the circle whatever rounding made of it.
#[test]
fn a_branch_is_drawn_by_its_stability() {
    let model = table(0.0, 1.0);
    let flip = (GRAVITY / AMPLITUDE).sqrt() * 60.0 / TAU;
    let range = [0.9 * flip, 1.1 * flip];
    let following = Following { parameter: Parameter::Speed, range, longest_step: 0.05, most_points: 100 };
    let orbit = on_top(0.9);
    let rpm = (0.9 * GRAVITY / AMPLITUDE).sqrt() * 60.0 / TAU;
    let branch = Branch::through(&model, rpm, &orbit, &following).unwrap();
    let kinds: Vec<_> = branch.lines().iter().map(|line| line.stability).collect();
    assert!(kinds.contains(&Stability::Neutral) && kinds.contains(&Stability::Unstable), "{kinds:?}");
    assert!(!kinds.contains(&Stability::Stable), "{kinds:?}");
    let figure = figures::branches_figure("table", ("rpm", "rpm", range), &[branch], &[], &[]);
    let labels: Vec<_> = figure.panels[0].series.iter().map(|series| series.label.clone()).collect();
    assert!(
        labels.iter().any(|label| label == "neutral") && !labels.iter().any(|label| label == "stable"),
        "{labels:?}"
    );
}

/// Of a long list a page has a part, and the number of the others.
#[test]
fn a_page_has_at_most_twenty_lines_of_what_is_undecided() {
    let mut all = found(&table(0.0, 1.0), 200.0, Some(1));
    let some = corner_impact::orbit::Undecided { cam_angles: vec![[1.0, 1.5]] };
    all.undecided = vec![some; 50];
    let page = all.text().unwrap();
    let lines = page.lines().filter(|line| line.contains("Not decided")).count();
    assert!((1..=20).contains(&lines) && page.contains(&format!("and {} more places", 50 - lines)), "{page}");
}

/// A cam with dwells and a spring without preload rests on its base without a force: flights of any length come back to it. 919 places
/// about two impacts were told one by one.
#[test]
#[ignore = "slow"]
fn neighbouring_places_that_are_undecided_are_one() {
    let text = "name = \"no preload\"\n[follower]\nmass = 0.5\ndamping = 0.0\nstiffness = 5000.0\ngravity = 0.0\npreload = 0.0\n\
        restitution = 0.5\n[cam]\nlaw = \"program\"\nbase = 0.0\n\
        [[cam.segment]]\nmotion = \"cycloidal\"\nspan_deg = 90.0\nrise = 0.02\n[[cam.segment]]\nmotion = \"dwell\"\nspan_deg = 60.0\n\
        [[cam.segment]]\nmotion = \"cycloidal\"\nspan_deg = 90.0\nrise = -0.02\n[[cam.segment]]\nmotion = \"dwell\"\nspan_deg = 120.0\n";
    let all = found(&Model::parse("dwells.toml", text).unwrap(), 300.0, None);
    assert!((2..=12).contains(&all.undecided.len()), "{:?}", all.undecided);
    // The whole base dwell is among them.
    let base = [240.0_f64.to_radians() + 0.1, TAU - 0.1];
    assert!(
        all.undecided
            .iter()
            .any(|it| it.cam_angles.len() == 1 && it.cam_angles[0][0] < base[0] && base[1] < it.cam_angles[0][1])
    );
}

/// Displacement of each entry of a matrix.
const PART: f64 = 1e-6;

fn exactly(entries: [[f64; 2]; 2]) -> Rows {
    entries.map(|row| row.map(Interval::from))
}

fn close(told: f64, expected: f64) {
    assert!((told - expected).abs() <= 1e-3 * expected.abs(), "{told:e} {expected:e}");
}

/// Each entry of each factor in turn is moved, and the trace of the product taken anew.
#[test]
fn the_error_of_a_trace_is_what_its_entries_move_it_by() {
    let plain = [[[2.0, 1.0], [0.5, -3.0]], [[1.0, -0.2], [4.0, 1.0]], [[0.3, 7.0], [-1.0, 2.0]]];
    let product = |of: &[[[f64; 2]; 2]; 3]| {
        let [first, second, third] = of.map(|rows| Matrix2::from_fn(|row, column| rows[row][column]));
        (third * second * first).trace()
    };
    let mut expected = 0.0;
    for (factor, row, column) in (0..12).map(|index| (index / 4, index / 2 % 2, index % 2)) {
        let mut moved = plain;
        moved[factor][row][column] += PART;
        expected += (product(&moved) - product(&plain)).abs();
    }
    let around = |middle: f64| Interval::new(middle - PART, middle + PART);
    let (middle, error) = trace(&plain.map(|rows| rows.map(|row| row.map(around))));
    close(middle, product(&plain));
    close(error, expected);
    // Of one factor alone what rounding makes of its diagonal.
    close(trace(&[exactly([[3.0, 9.0], [9.0, -5.0]])]).1, 16.0 * f64::EPSILON);
}

#[test]
fn a_multiplier_is_off_by_its_polynomial_over_the_gap_or_by_the_root_of_it() {
    let [apart, double] = [Matrix2::new(3.0, 0.0, 0.0, 1.0), Matrix2::identity()];
    close(multipliers_error(&apart, (4.0 + PART, PART), 3.0), 6.0 * PART);
    close(multipliers_error(&apart, (4.0, 0.0), 3.0 + PART), PART);
    close(multipliers_error(&double, (2.0, 1e-8), 1.0), 1e-4);
    for matrix in [Matrix2::new(1e3, 0.0, 0.0, -1e3), Matrix2::new(0.0, 1e3, 1e3, 0.0)] {
        close(multipliers_error(&matrix, (0.0, 0.0), -1e6), 2e3 * f64::EPSILON);
    }
    let turning = Matrix2::new(0.0, 1.0, -1.0, 0.0);
    close(multipliers_error(&turning, (0.0, PART), 1.0), PART);
    assert!(multipliers_error(&Matrix2::from_element(f64::NAN), (0.0, 0.0), 1.0).is_nan());
}

#[test]
fn a_modulus_decides_beyond_its_error_and_a_trace_between_its_bounds() {
    let of = |modulus| Stability::of_modulus(modulus, 0.1);
    assert_eq!(
        [0.8, 0.95, 1.05, 1.2].map(of),
        [Stability::Stable, Stability::Neutral, Stability::Neutral, Stability::Unstable]
    );
    let of = |size, loses| Stability::of_trace(size, [1.4, 1.6], loses);
    assert_eq!([of([0.0, 1.3], true), of([0.0, 1.3], false)], [Some(Stability::Stable), Some(Stability::Neutral)]);
    assert_eq!([of([1.7, 9.0], true), of([1.7, 9.0], false)], [Some(Stability::Unstable); 2]);
    assert_eq!([[0.0, 1.5], [1.5, 1.5], [1.5, 9.0]].map(|size| of(size, true)), [None; 3]);
}

/// A follower that stays above the cam has the multipliers of its free oscillation, `e^{(-zeta +- i nu) T}`: neutral without a damper.
#[test]
fn an_orbit_without_impacts_is_neutral_or_damped() {
    let (omega, period) = (10.0_f64, TAU / angular_velocity(300.0));
    for damping in [0.0, 1e-9, 0.4] {
        let text = format!(
            "[follower]\nmass = 1.0\nrestitution = 0.7\ndamping = {damping:e}\nstiffness = {:?}\ngravity = 0.0\nrest_position = 0.05\n\
             [cam]\nlaw = \"harmonic\"\noffset = 0.0\namplitudes = [0.01]\nphases_deg = [0.0]\n",
            omega * omega
        );
        let all = found(&Model::parse("wall.toml", &text).unwrap(), 300.0, None).orbits;
        let orbit = all.iter().find(|orbit| orbit.course == Course::Free).unwrap();
        let expected = if damping > 0.0 { Stability::Stable } else { Stability::Neutral };
        assert_eq!(orbit.judgement.stability, expected, "{damping}");
        assert!(orbit.judgement.error < 1e-13, "{damping}: {:e}", orbit.judgement.error);
        for multiplier in orbit.multipliers() {
            close(multiplier.modulus(), (-0.5 * damping * period).exp());
        }
    }
}
