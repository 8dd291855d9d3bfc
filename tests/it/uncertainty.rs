//! Does ± have the part of every number of the follower? By closed forms, by machines drawn at random, and by differences of runs.

use corner_impact::cam::{Cam, Side};
use corner_impact::corner;
use corner_impact::model::{FollowerErrors, Model, Numeral};
use corner_impact::orbit::Search;
use corner_impact::progress::Unwatched;
use corner_impact::study::attractors::{Cause, Resolution};
use corner_impact::study::design::contact::Separation;
use corner_impact::study::design::needs::Lever;
use corner_impact::study::design::{Asked, Design, RequiredPair, design};
use corner_impact::study::locate::locate;
use corner_impact::study::orbit::{OrbitQuery, orbits};
use corner_impact::study::verify::{External, Verification, verify};
use corner_impact::uncertainty::{PlausibleMachines, SourcedUncertainty};
use corner_impact_cli::show::Paged;
use serde_json::{Value, json};

use crate::common;

/// c = 0.02 + 0.01 cos, which falls away fastest at angle 0.
const AMPLITUDE: f64 = 0.01;
const OFFSET: f64 = 0.02;

pub(crate) fn cosine(follower: &Value) -> Model {
    let cam = json!({ "law": "harmonic", "offset": OFFSET, "amplitudes": [AMPLITUDE], "phases_deg": [0.0] });
    Model::of_document("a cosine", &json!({ "follower": follower, "cam": cam })).unwrap()
}

pub(crate) fn with(value: f64, error: f64) -> Value {
    json!({ "value": value, "error": error })
}

/// The part of a number by its name.
pub(crate) fn part(error: &SourcedUncertainty, name: &str) -> f64 {
    error.of_each().into_iter().find(|(of, _)| *of == name).map_or(0.0, |(_, part)| part)
}

fn designed(model: &Model, needs: &[&str]) -> Design {
    let needs = needs.iter().map(|need| ((*need).to_owned(), need.parse().unwrap())).collect();
    design(model, &Asked { rpm: Some([100.0, 200.0]), speeds: 2, needs, ..Asked::default() }, &Unwatched).unwrap()
}

pub(crate) fn near(found: f64, wanted: f64, within: f64) {
    assert!((found - wanted).abs() <= within * wanted.abs(), "{found}, not {wanted}");
}

/// Likely machines differ in each number that has an error: none of the table's rows is left out.
#[test]
fn every_number_of_the_follower_may_have_an_error() {
    assert_eq!(FollowerErrors::names().count(), FollowerErrors::COUNT);
    for name in FollowerErrors::names() {
        let mut follower =
            json!({ "mass": 0.5, "stiffness": 2000.0, "gravity": 9.81, "damping": 1.0, "restitution": 0.5 });
        let place = if name == "preload" { "preload" } else { "rest_position" };
        follower[place] = json!(if name == "preload" { 60.0 } else { -0.03 });
        let value = follower[name].as_f64().unwrap();
        follower[name] = with(value, 0.01 * value.abs());
        let model = cosine(&follower);
        let cam = Cam::new(&model).unwrap();
        let machines = PlausibleMachines::of(&model, &cam).unwrap();
        let numbers = machines.each(|machine, _| Some(format!("{:?}", machine.follower)));
        assert!(numbers.iter().any(|other| *other != format!("{:?}", model.follower)), "{name}: {numbers:?}");
    }
}

/// The uncertainty of a number that a load needs is what the number moves by with the machine, and not what a separation would need.
#[test]
#[ignore = "slow"]
fn a_need_of_a_load_moves_with_the_uncertain_mass() {
    let needs = |mass: Value| {
        let model = cosine(&json!({
            "mass": mass, "stiffness": 2000.0, "gravity": 9.81, "rest_position": -0.03, "damping": 0.0, "restitution": 0.3,
        }));
        let needs = designed(&model, &["impact speed below 0.2 m/s to 1300 rpm"]).needs;
        needs.into_iter().find(|need| need.lever == Lever::Stiffness).unwrap()
    };
    let error = 0.015;
    let found = needs(with(0.5, error));
    let [high, low] = [0.5 + 2.0 * error, 0.5 - 2.0 * error].map(|mass| needs(json!(mass)).value.unwrap());
    near(part(&found.error.unwrap(), "mass"), 0.5 * (high - low), 0.1);
}

/// The document has the uncertainty of each load, with its parts.
#[test]
fn loads_of_a_document_have_the_uncertainty_of_the_machine() {
    let model = cosine(&json!({
        "mass": with(0.5, 0.005), "stiffness": with(2000.0, 30.0), "gravity": 9.81, "rest_position": -0.03, "damping": 0.0,
        "restitution": 0.3,
    }));
    let asked = Asked { rpm: Some([1600.0, 1700.0]), speeds: 2, ..Asked::default() };
    let found = design(&model, &asked, &Unwatched).unwrap();
    let document = serde_json::to_value(&found).unwrap();
    assert_eq!(found.loads.len(), 2);
    for (loads, told) in found.loads.iter().zip(document["loads"].as_array().unwrap()) {
        let errors = loads.errors.unwrap();
        let names =
            [["impact_speed", "m_s"], ["gap", "m"], ["off_cam", ""], ["energy_lost", "j"], ["largest_force", "n"]];
        for ([name, unit], error) in names.into_iter().zip(errors) {
            let unit = if unit.is_empty() { String::new() } else { format!("_{unit}") };
            assert_eq!(told[format!("{name}_error{unit}")], json!(error.total()), "{told}");
            assert_eq!(
                told[format!("{name}_error_parts")][format!("mass{unit}")],
                json!(part(&error, "mass")),
                "{told}"
            );
        }
        assert!(errors[4].total() > 0.0);
    }
}

/// A value that is required, and the one on the other side, are each known to within their own uncertainty.
#[test]
fn required_values_have_bounds_on_both_sides() {
    let of = |cam: f64, numbers: f64| Some(SourcedUncertainty { cam, numbers, each: None });
    let pair = RequiredPair {
        given: 1.0,
        found: Some(20.0),
        error: of(0.3, 0.4),
        other: Some(50.0),
        other_error: of(3.0, 4.0),
        again: None,
    };
    assert_eq!((pair.found_bounds(), pair.other_bounds()), (Some([19.5, 20.5]), Some([45.0, 55.0])));
    let open = RequiredPair { error: None, other: None, ..pair };
    assert_eq!((open.found_bounds(), open.other_bounds()), (None, None));
}

/// The follower leaves where `m w^2 A = k (C + A - rest) + m g`.
#[test]
fn separation_has_the_parts_that_follow_from_its_formula() {
    let (mass, stiffness, gravity, rest) = (0.5, 2000.0, 9.81, -0.03);
    let errors = [0.005, 30.0, 0.02, 0.0004];
    let model = cosine(&json!({
        "mass": with(mass, errors[0]), "stiffness": with(stiffness, errors[1]), "gravity": with(gravity, errors[2]),
        "rest_position": with(rest, errors[3]), "damping": 0.0, "restitution": with(0.5, 0.1),
    }));
    let high = OFFSET + AMPLITUDE - rest;
    let pressed = stiffness * high + mass * gravity;
    let omega = (pressed / (mass * AMPLITUDE)).sqrt();
    let rpm = 60.0 * omega / std::f64::consts::TAU;
    let found = designed(&model, &[]);
    let Separation::At { rpm: at, error: whole, .. } = found.separation else { panic!("{:?}", found.separation) };
    near(at, rpm, 1e-9);
    let [error, of_angle] = found.separation_errors.unwrap();
    let halves = [-stiffness * high / (mass * pressed), high / pressed, mass / pressed, -stiffness / pressed];
    let parts: Vec<f64> = halves.iter().zip(errors).map(|(half, error)| 2.0 * 0.5 * rpm * half.abs() * error).collect();
    for (name, wanted) in ["mass", "stiffness", "gravity", "rest_position"].into_iter().zip(&parts) {
        near(part(&error, name), *wanted, 1e-3);
    }
    assert_eq!((part(&error, "restitution"), part(&error, "damping"), error.cam), (0.0, 0.0, 0.0));
    let all = parts.iter().map(|part| part * part).sum::<f64>().sqrt();
    near(error.numbers, all, 1e-3);
    near(whole, all, 1e-3);
    // It always leaves at the top.
    assert!(of_angle.total() < 1e-6, "{of_angle:?}");
    assert!(found.text().unwrap().contains(" at 0.000 deg first"), "{}", found.text().unwrap());
    let document = serde_json::to_value(&found).unwrap();
    assert_eq!(document["uncertain"], json!(["mass", "stiffness", "gravity", "rest_position", "restitution"]));
    near(document["separation"]["error_parts"]["mass_rpm"].as_f64().unwrap(), parts[0], 1e-3);
    near(document["separation"]["error_parts"]["numbers_rpm"].as_f64().unwrap(), all, 1e-3);
    assert_eq!(document["separation"]["error_parts"]["cam_rpm"], json!(0.0));
    assert!(document["separation"].get("cam_angle_error_rad").is_none(), "{document}");
}

/// `F = m A w^2 - 2 k A - m g` holds the follower up to w. The error of the number that is to be changed does not matter.
#[test]
fn a_need_has_the_parts_of_the_numbers_that_are_kept() {
    let (mass, stiffness, gravity, preload) = (0.5, 2000.0, 9.81, 40.0);
    let model = cosine(&json!({
        "mass": with(mass, 0.005), "stiffness": with(stiffness, 30.0), "gravity": gravity, "damping": 0.0,
        "preload": with(preload, 3.0), "restitution": 0.5,
    }));
    let omega = 1500.0 / 60.0 * std::f64::consts::TAU;
    let found = designed(&model, &["no separation to 1500 rpm"]);
    let of = |lever: Lever| found.needs.iter().find(|answer| answer.lever == lever).unwrap();
    let answer = of(Lever::Preload);
    near(answer.value.unwrap(), mass * AMPLITUDE * omega * omega - 2.0 * stiffness * AMPLITUDE - mass * gravity, 1e-9);
    let error = answer.error.unwrap();
    near(part(&error, "mass"), 2.0 * 0.005 * (AMPLITUDE * omega * omega - gravity), 1e-3);
    near(part(&error, "stiffness"), 2.0 * 30.0 * 2.0 * AMPLITUDE, 1e-3);
    assert_eq!(part(&error, "preload"), 0.0);
    // k = (m A w^2 - m g - F) / (2 A)
    let error = of(Lever::Stiffness).error.unwrap();
    near(part(&error, "preload"), 2.0 * 3.0 / (2.0 * AMPLITUDE), 1e-3);
    assert_eq!(part(&error, "stiffness"), 0.0);
    let answer = of(Lever::Mass);
    let error = answer.error.unwrap();
    near(part(&error, "preload"), 2.0 * 3.0 / (AMPLITUDE * omega * omega - gravity), 1e-3);
    let document = serde_json::to_value(&found).unwrap();
    let of_mass = document["needs"].as_array().unwrap().iter().find(|need| need["parameter"] == "mass").unwrap();
    assert_eq!(of_mass["error_parts"]["preload"], json!(part(&error, "preload")));
    near(of_mass["error"].as_f64().unwrap(), error.total(), 1e-12);
    // The least force is that of spring, mass and weight at the top, and at rest at the bottom.
    let force = found.forces[0];
    let omega = 100.0 / 60.0 * std::f64::consts::TAU;
    near(force.least.value, preload + mass * gravity + mass * AMPLITUDE * omega * omega, 1e-9);
    near(part(&force.error.unwrap(), "preload"), 6.0, 1e-6);
    near(part(&force.error.unwrap(), "mass"), 0.01 * (gravity + AMPLITUDE * omega * omega), 1e-6);
}

/// The number that is sought has no error of its own: where no other number has one, the answer is exact.
#[test]
fn a_need_of_the_only_uncertain_number_is_exact() {
    let follower = json!({ "mass": with(0.5, 0.01), "stiffness": 2000.0, "gravity": 0.0, "rest_position": 0.0, "damping": 0.0, "restitution": 0.5 });
    let found = designed(&cosine(&follower), &["no separation to 800 rpm"]);
    let of = |lever: Lever| found.needs.iter().find(|answer| answer.lever == lever).unwrap();
    assert_eq!(of(Lever::Mass).error.as_ref().unwrap().total(), 0.0);
    assert!(of(Lever::Stiffness).error.as_ref().unwrap().total() > 0.0);
    let page = common::in_one_line(&found.text().unwrap());
    assert!(!page.contains("± ?") && !page.contains("± 0 "), "{page}");
}

/// The paper's machine with errors of three numbers.
fn paper(restitution: f64) -> Model {
    common::osorio_with(&[
        ("mass", "{ value = 1.221, error = 0.004 }"),
        ("stiffness", "{ value = 1430.8, error = 6.0 }"),
        ("restitution", &format!("{{ value = 0.8, error = {restitution} }}")),
    ])
}

/// A number in [0, 1) by another generator than the program's: Knuth's linear congruence.
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / 2.0_f64.powi(53)
}

/// Twice the standard deviation of numbers.
fn spread(numbers: &[f64]) -> f64 {
    let mean = numbers.iter().sum::<f64>() / numbers.len() as f64;
    2.0 * (numbers.iter().map(|one| (one - mean).powi(2)).sum::<f64>() / (numbers.len() - 1) as f64).sqrt()
}

/// Machines drawn with `--set`, independently of the program's own: of 400 the spread is known to 4 %.
#[test]
fn machines_drawn_at_random_spread_as_far_as_is_said() {
    let model = paper(0.004);
    let mut state = 1;
    // A sum of twelve even numbers is as good as normal.
    let mut normal = || (0..12).map(|_| random(&mut state)).sum::<f64>() - 6.0;
    let (mut speeds, mut entries) = (Vec::new(), Vec::new());
    for _ in 0..400 {
        let numbers = [("mass", 1.221, 0.004), ("stiffness", 1430.8, 6.0), ("restitution", 0.8, 0.004)];
        let numbers = numbers.map(|(name, value, error)| (name.to_owned(), value + error * normal()));
        let drawn = model.changed(&numbers).unwrap();
        let cam = Cam::new(&drawn).unwrap();
        let (at, _) = corner::locate(&drawn, &cam).unwrap();
        speeds.push(at.speed_rpm());
        entries.push(corner::closed_form::route(&drawn, &at).map.plus.entries());
    }
    let found = verify(&model, External::LeftOut).unwrap();
    let error = found.uncertainty.as_ref().unwrap().error.as_ref().unwrap();
    near(error.speed.total(), spread(&speeds), 0.1);
    for (index, error) in error.entries.plus.iter().enumerate() {
        let drawn: Vec<f64> = entries.iter().map(|entries| entries[index]).collect();
        near(error.total(), spread(&drawn), 0.1);
    }
}

fn map(found: &Verification, side: Side) -> [f64; 6] {
    found.map.of(side).entries()
}

/// A and B of machines with one number changed, by `verify` itself.
#[test]
fn the_map_has_the_parts_that_differences_of_verify_give() {
    let model = paper(0.01);
    let found = verify(&model, External::LeftOut).unwrap();
    let error = found.uncertainty.as_ref().unwrap().error.as_ref().unwrap();
    let changed = |name: &str, value: f64| {
        let exact = common::osorio().changed(&[(name.to_owned(), value)]).unwrap();
        verify(&exact, External::LeftOut).unwrap()
    };
    for (name, value, deviation) in [("mass", 1.221, 0.004), ("stiffness", 1430.8, 6.0), ("restitution", 0.8, 0.01)] {
        let [less, more] = [value - deviation, value + deviation].map(|value| changed(name, value));
        near(part(&error.speed, name), (more.at.speed_rpm() - less.at.speed_rpm()).abs(), 1e-6);
        for (side, errors) in [(Side::Minus, &error.entries.minus), (Side::Plus, &error.entries.plus)] {
            let ends = map(&less, side).into_iter().zip(map(&more, side)).zip(map(&found, side));
            for (error, ((less, more), own)) in errors.iter().zip(ends) {
                assert!((part(error, name) - (more - less).abs()).abs() <= 1e-7 * own.abs(), "{name}: {error:?}");
            }
        }
    }
    let document = serde_json::to_value(&found).unwrap();
    let uncertainty = &document["uncertainty"];
    assert_eq!(uncertainty["uncertain"], json!(["mass", "stiffness", "restitution"]));
    let of_mass = uncertainty["parts"]["mass"]["plus"]["A"][0][1].as_f64().unwrap();
    near(of_mass, part(&error.entries.plus[1], "mass"), 1e-12);
    assert!(uncertainty["minus"]["B"][0].as_f64().unwrap() > 0.0);
    // The verdict is that of the drawn machines as well, and how many of them say so is told.
    let all: usize =
        uncertainty["verdicts"].as_array().unwrap().iter().map(|it| it["cams"].as_u64().unwrap() as usize).sum();
    assert_eq!(all, 16);
    let exact = verify(&common::osorio(), External::LeftOut).unwrap();
    assert!(exact.uncertainty.is_none());
}

/// One corner impact has one ±, whichever command is asked; and so has the first separation.
#[test]
#[ignore = "slow"]
fn every_command_gives_the_same_uncertainty() {
    let model = paper(0.01);
    let verified = verify(&model, External::LeftOut).unwrap();
    let wanted = verified.uncertainty.as_ref().unwrap().error.as_ref().unwrap().speed;
    let located = locate(&model, model.study().unwrap(), 1, &Unwatched).unwrap();
    let here = located.found.iter().find(|it| it.at.is_near(&verified.at)).unwrap().speed_error.unwrap();
    let surveyed = common::speeds(&model, [665.0, 681.0], &Resolution::new(common::step(4.0), 8), &Unwatched).unwrap();
    let ends = surveyed.attractors.iter().flat_map(|row| row.birth.iter().chain(&row.death));
    let there = ends.clone().find(|end| matches!(end.cause, Cause::CornerImpact { .. })).unwrap().error.unwrap();
    for name in ["mass", "stiffness", "restitution"] {
        near(part(&here, name), part(&wanted, name), 1e-4);
        near(part(&there, name), part(&wanted, name), 1e-4);
    }
    let survey = |range| common::speeds(&model, range, &Resolution::new(common::step(10.0), 4), &Unwatched).unwrap();
    let survey = survey([100.0, 130.0]);
    let found = designed(&model, &[]).separation_errors.unwrap()[0];
    near(survey.detachment_error().unwrap().total(), found.total(), 1e-9);
    assert_eq!(surveyed.errors, model.errors);
}

/// Every orbit of the paper's machine at 700 rpm has errors, and those of another machine one error away are as far off as is said.
#[test]
fn orbits_have_the_parts_of_the_numbers() {
    let model = paper(0.01);
    let search = OrbitQuery::All(Search { revolutions: 1, impacts: Some(1) });
    let find = |model: &Model| orbits(model, 700.0, search, &Unwatched).unwrap();
    let (found, exact) = (find(&model), find(&common::osorio()));
    assert!(exact.errors.is_empty() && found.errors.len() == exact.orbits.len());
    let moved = find(&common::osorio().changed(&[("restitution".to_owned(), 0.81)]).unwrap());
    for (orbit, error) in found.orbits.iter().zip(&found.errors) {
        let error = error.unwrap();
        assert_eq!(error.cam.multiplier, 0.0);
        assert_eq!(error.total.velocity_m_s, error.numbers.velocity_m_s);
        let off = |other: &corner_impact::orbit::PeriodicOrbit| (other.state.position - orbit.state.position).abs();
        let nearest = moved.orbits.iter().map(off).fold(f64::INFINITY, f64::min);
        assert!(nearest > 0.0 && nearest < error.total.state[0], "{nearest} {error:?}");
    }
}

/// Linear results by differences and by runs of an orthogonal design, a curved one by an ensemble.
#[test]
fn a_result_that_is_not_linear_has_the_spread_of_an_ensemble() {
    let model = paper(0.01);
    let cam = common::cam(&model);
    let machines = PlausibleMachines::of(&model, &cam).unwrap();
    let straight = |model: &Model, _: &Cam| Some(3.0 * model.follower.mass - 0.01 * model.follower.stiffness);
    let number = straight(&model, &cam).unwrap();
    let [error] = machines.error([number], |model, cam| Some([straight(model, cam)?])).unwrap();
    let by_runs = machines.error_by_runs(number, straight).unwrap();
    for error in [error, by_runs] {
        near(part(&error, "mass"), 2.0 * 3.0 * 0.004, 1e-9);
        near(part(&error, "stiffness"), 2.0 * 0.01 * 6.0, 1e-9);
        near(error.total(), 0.024_f64.hypot(0.12), 1e-9);
        assert!(part(&error, "restitution") < 1e-9);
    }
    // Differences see nothing of a parabola about its vertex. The mean of z^4 is 3.
    let curved = |model: &Model, _: &Cam| Some([((model.follower.mass - 1.221) / 0.004).powi(2)]);
    let [error] = machines.error([0.0], curved).unwrap();
    assert!(error.each.is_none() && error.of_each().is_empty());
    near(error.total(), 2.0 * 3.0_f64.sqrt(), 0.4);
    // The ensemble itself gives a linear result the spread that differences give.
    let drawn = machines.drawn(straight);
    let off = drawn.iter().map(|one| (one - number).powi(2)).sum::<f64>() / drawn.len() as f64;
    near(2.0 * off.sqrt(), 0.024_f64.hypot(0.12), 1e-9);
    // If an eighth of the machines lack it, a result is known; if more do, it is not.
    let without = |share: f64| {
        let seen = std::sync::atomic::AtomicUsize::new(0);
        let of = |_: &Model, _: &Cam| {
            let index = seen.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            (index as f64 >= share * 16.0 + 6.0).then_some([1.0])
        };
        machines.error([0.0], of)
    };
    assert!(without(0.5).is_none());
}

/// A number at the end of its range moves to one side only, and none leaves it.
#[test]
fn numbers_stay_within_what_they_may_be() {
    let model = common::osorio_with(&[
        ("restitution", "{ value = 1.0, error = 0.1 }"),
        ("damping", "{ value = 0.0, error = 0.2 }"),
    ]);
    let cam = common::cam(&model);
    let machines = PlausibleMachines::of(&model, &cam).unwrap();
    let numbers = |model: &Model, _: &Cam| {
        let follower = model.follower;
        assert!((0.0..=1.0).contains(&follower.restitution) && follower.damping >= 0.0, "{follower:?}");
        Some([follower.restitution, follower.damping])
    };
    let [restitution, damping] = machines.error([1.0, 0.0], numbers).unwrap();
    near(part(&restitution, "restitution"), 0.2, 1e-9);
    near(part(&damping, "damping"), 0.4, 1e-9);
    assert!(machines.drawn(|model, cam| numbers(model, cam)).iter().any(|[restitution, _]| *restitution < 0.9));
}

/// `{ value, error }` is the number itself to all that knows of no errors, and is kept by all that writes models.
#[test]
fn errors_are_read_kept_and_changed() {
    let plain = common::osorio();
    let model = paper(0.01);
    assert_eq!(model.follower, plain.follower);
    assert_eq!(model.numbers().collect::<Vec<_>>(), plain.numbers().collect::<Vec<_>>());
    assert_eq!(model.exact(), plain.exact());
    let errors = |model: &Model| model.errors.uncertain().collect::<Vec<_>>();
    assert_eq!(errors(&model), [("mass", 0.004), ("stiffness", 6.0), ("restitution", 0.01)]);
    assert_eq!(plain.errors, FollowerErrors::default());
    // As text, and as text again.
    let again = Model::parse("again.toml", &model.text()).unwrap();
    assert!(model.text().contains("mass = { value = 1.221, error = 0.004 }"), "{}", model.text());
    assert_eq!((again.errors, again.text()), (model.errors, model.text()));
    // In three ways to write a table.
    for table in ["mass.value = 1.221\nmass.error = 0.004", "mass = { error = 0.004, value = 1.221 }"] {
        let text = common::osorio_text(&[]).replace("mass = 1.221", &format!("{table} #"));
        assert_eq!(errors(&Model::parse("a.toml", &text).unwrap()), [("mass", 0.004)]);
    }
    // A changed value keeps its error; a number that a study varies is exact.
    let set = |name: &str, value: f64| model.changed(&[(name.to_owned(), Numeral::from(value))]);
    assert_eq!(errors(&set("mass", 1.3).unwrap())[0], ("mass", 0.004));
    assert_eq!(errors(&set("follower.mass.error", 0.1).unwrap())[0], ("mass", 0.1));
    assert_eq!(errors(&set("damping.error", 0.1).unwrap())[1], ("damping", 0.1));
    assert_eq!(errors(&set("mass.error", 0.0).unwrap())[0], ("stiffness", 6.0));
    assert_eq!(errors(&model.with_number("follower.mass", 0.001).unwrap())[0], ("stiffness", 6.0));
    assert!(set("mass.error", -0.1).unwrap_err().to_string().contains("0 or more"));
    assert!(set("cam.base_radius.error", 0.1).is_err() && set("error", 0.1).is_err() && set(".error", 0.1).is_err());
    // In the units of the file.
    let text = common::osorio_text(&[("mass", "{ value = 1221.0, error = 4.0 }")]);
    let grams = Model::parse("grams.toml", &text.replace("[follower]", "[units]\nmass = \"g\"\n[follower]")).unwrap();
    assert_eq!(errors(&grams), [("mass", 0.004)]);
    assert!(grams.text().contains("mass = { value = 1221.0, error = 4.0 }"));
}

/// A sentence with file, line and field, and nothing is computed.
#[test]
fn errors_that_make_no_sense_are_refused() {
    let cases = [
        ("mass", "{ value = 1.2, error = -0.1 }", "follower.mass.error = -0.1", "0 or more"),
        ("mass", "{ value = 1.2, error = nan }", "follower.mass.error = nan", "0 or more"),
        ("mass", "{ value = 1.2, error = inf }", "follower.mass.error = inf", "finite"),
        ("mass", "{ value = 1.2, error = \"5 %\" }", "follower.mass.error = \"5 %\"", "0 or more"),
        ("mass", "{ value = 1.2 }", "follower.mass.error is missing", "found there: value"),
        ("mass", "{ error = 0.1 }", "follower.mass.value is missing", "found there: error"),
        ("mass", "{ value = -1.2, error = 0.1 }", "follower.mass = -1.2", "above 0"),
        ("mass", "{ value = \"heavy\", error = 0.1 }", "follower.mass = \"heavy\"", "above 0"),
        ("mass", "{ value = 1.2, error = 0.1, sigma = 3 }", "follower.mass.sigma", "error, value"),
        ("mass", "{ value = 1.2, erorr = 0.1 }", "follower.mass.error is missing", "did you mean error"),
        ("mass", "{ value = 0.1, error = 0.2 }", "follower.mass.error = 0.2", "must be 0.05 or less"),
        ("stiffness", "{ value = 0, error = 1 }", "follower.stiffness.error = 1", "must be 0 or less"),
        ("restitution", "{ value = 0.5, error = 0.6 }", "follower.restitution.error = 0.6", "0.5 or less"),
        ("restitution", "{ value = 1.5, error = 0.1 }", "follower.restitution = 1.5", "from 0 to 1"),
        ("base_radius", "{ value = 0.4, error = 0.1 }", "cam.base_radius", "must be a number without an error"),
        ("base_radius", "{ value = 0.4 }", "cam.base_radius", "finite number above 0"),
        (
            "rpm_min",
            "{ value = 600, error = 0.1 }",
            "study.rpm_min",
            "numbers of [follower] may have one: mass, damping",
        ),
    ];
    for (field, text, says, allowed) in cases {
        let text = common::osorio_text(&[(field, text)]);
        let line = 1 + text.lines().position(|line| line.starts_with(&format!("{field} ="))).unwrap();
        let refused = Model::parse("wrong.toml", &text).unwrap_err().to_string();
        for part in [says, allowed, &format!("wrong.toml:{line}:")] {
            assert!(refused.contains(part), "{field}: no \"{part}\" in: {refused}");
        }
    }
    let words = common::text(common::corner_impact(["design", "--set", "mass.error=1"]).stderr);
    assert!(words.contains("follower.mass.error") && words.contains("0.6105 or less"), "{words}");
}

/// The parts of a ± are rounded as the whole is: that of the only uncertain number is the whole.
#[test]
fn parts_are_rounded_as_the_whole_is() {
    let said = |error: &str| {
        let set = format!("mass.error={error}");
        let page =
            common::text(common::corner_impact(["design", "--rpm", "100:120", "--speeds", "2", "--set", &set]).stdout);
        let page = common::in_one_line(&page);
        let whole = page.split(" ± ").nth(1).unwrap().split(' ').next().unwrap().to_owned();
        (page, whole)
    };
    for error in ["0.001", "0.002", "0.003", "0.005", "0.007", "0.011", "0.013"] {
        let (page, whole) = said(error);
        assert!(page.contains(&format!(" ± {whole} rpm, from the numbers (mass {whole})")), "{error}: {page}");
    }
    // Less than half of the last place is not shown.
    let words =
        ["design", "--rpm", "100:120", "--speeds", "2", "--set", "mass.error=0.005", "--set", "stiffness.error=1e-9"];
    let page = common::in_one_line(&common::text(common::corner_impact(words).stdout));
    assert!(!page.contains("stiffness 0"), "{page}");
}

/// A ± that reaches 0 is none: a speed is above 0, and has a bound instead.
#[test]
fn a_speed_that_may_be_0_has_a_bound() {
    let set =
        ["design", "--rpm", "100:120", "--speeds", "2", "--set", "mass.error=0.6", "--set", "stiffness.error=715"];
    let page = common::in_one_line(&common::text(common::corner_impact(set).stdout));
    let sentence = page.split("The follower leaves the cam at ").nth(1).unwrap();
    let speed = sentence.split("force), at ").nth(1).unwrap().split(" rpm").next().unwrap();
    assert!(speed.contains(", < ") && !speed.contains('±'), "{speed}");
}

/// Every page with a ± says what it is of, within 80 columns.
#[test]
#[ignore = "slow"]
fn pages_say_where_the_uncertainty_comes_from() {
    let folder = tempfile::tempdir().unwrap();
    let run = |words: &[&str]| {
        let output = common::program(words).current_dir(folder.path()).env("COLUMNS", "80").output().unwrap();
        assert!(output.status.success(), "{words:?}: {}", common::text(output.stderr));
        let page = common::text(output.stdout);
        assert!(page.lines().all(|line| line.chars().count() <= 80), "{page}");
        common::in_one_line(&page)
    };
    run(&["new", "valve.toml", "--law", "table"]);
    let of_cam = "± is from the cam alone: the model gives no error of the follower's numbers";
    let both = "± is the root of the sum of two squares: the part from the cam, and two standard deviations from the errors of mass";
    let numbers = "± is two standard deviations, from the errors of mass";
    let design = ["design", "--rpm", "2400:3400", "--speeds", "3"];
    let speeds = ["speeds", "--rpm", "2800:3000", "--speeds", "3", "--starts", "4"];
    for command in [&design[..], &speeds[..]] {
        let page = run(&[command, &["valve.toml"]].concat());
        assert!(page.contains(of_cam) && page.contains("rpm (± from the cam: lift rounded to 0.001 mm)"), "{page}");
        let page = run(&[command, &["valve.toml", "--set", "mass.error=0.001"]].concat());
        assert!(page.contains(both) && page.contains(" from the cam (lift rounded to 0.001 mm), "), "{page}");
        assert!(page.contains(" from the numbers (mass 2"), "{page}");
        // A part has two digits of its own, however large the whole is.
        let page = run(&[command, &["valve.toml", "--set", "mass.error=0.005"]].concat());
        assert!(page.contains(": 13 from the cam (lift rounded to 0.001 mm), 140 from the numbers"), "{page}");
        let page = run(&[command, &["valve.toml", "--set", "mass.error=1 g"]].concat());
        assert!(page.contains(" from the numbers (mass 2"), "{page}");
    }
    let of_mass = ["--set", "mass.error=0.004"];
    for command in [&["locate", "--rpm", "600:760"][..], &["verify", "--no-external"], &["orbit", "--rpm", "700"]] {
        let page = run(&[command, &of_mass].concat());
        assert!(page.contains(numbers), "{page}");
        assert!(!run(command).contains('±'));
    }
    let page = run(&[&["speeds", "--rpm", "665:681", "--speeds", "5", "--starts", "8"][..], &of_mass].concat());
    assert!(page.contains(numbers) && page.contains("rpm: from the numbers (mass 2"), "{page}");
}
