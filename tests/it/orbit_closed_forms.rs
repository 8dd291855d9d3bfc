//! Are the orbits that are found, and the points where they change, those of two machines whose orbits are known in closed
//! form: an oscillator at a wall, and a ball on a table?
//!
//! The numbers are thirty digits that computer algebra derives from the equations of motion (`derivations/impact_oscillator.py`).

use std::f64::consts::TAU;

use corner_impact::cam::Cam;
use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::orbit::branch::{Branch, BranchPoint, End, Following, SpecialKind};
use corner_impact::orbit::{Eigenvalue, Parameter, PeriodicOrbit, Search, Stability, near, search};
use corner_impact::simulate::{Machine, angular_velocity};
use serde_json::Value;

const DERIVED: &str = include_str!("../../golden/derived/impact_oscillator.json");
/// What the orbits are asked to, of their size.
const DIGITS: f64 = 1e-10;

fn number(value: &Value) -> f64 {
    value.as_str().unwrap().parse().unwrap()
}

fn cases(of: &str) -> Vec<Value> {
    let document: Value = serde_json::from_str(DERIVED).unwrap();
    let cases = document[of].as_array().unwrap().clone();
    let turns: Vec<u64> = cases.iter().map(revolutions).collect();
    assert_eq!(turns, [1, 2, 3]);
    cases
}

fn revolutions(case: &Value) -> u64 {
    case["revolutions"].as_u64().unwrap()
}

fn follower(stiffness: f64, gravity: f64, restitution: f64) -> String {
    format!(
        "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = {stiffness:?}\ngravity = {gravity:?}\nrest_position = 0.0\n\
         restitution = {restitution:?}\n"
    )
}

/// Above the wall at sigma, less gamma cos wt: the cam sigma - gamma cos(theta). With its speed, rpm.
fn oscillator(case: &Value) -> (Model, f64) {
    let cam = format!(
        "[cam]\nlaw = \"harmonic\"\noffset = {:?}\namplitudes = [{:?}]\nphases_deg = [0.0]\n",
        number(&case["wall"]),
        -number(&case["amplitude"])
    );
    let text = follower(1.0, 0.0, number(&case["restitution"])) + &cam;
    (Model::parse("oscillator.toml", &text).unwrap(), number(&case["frequency"]) * 60.0 / TAU)
}

/// The table at a cos(theta).
fn table(case: &Value) -> (Model, f64) {
    let cam = format!(
        "[cam]\nlaw = \"harmonic\"\noffset = 0.0\namplitudes = [{:?}]\nphases_deg = [0.0]\n",
        number(&case["amplitude"])
    );
    let text = follower(0.0, number(&case["gravity"]), number(&case["restitution"])) + &cam;
    (Model::parse("table.toml", &text).unwrap(), number(&case["rpm"]))
}

fn found(model: &Model, rpm: f64, revolutions: u64) -> Vec<PeriodicOrbit> {
    let machine = Machine::new(Cam::new(model).unwrap(), &model.follower, angular_velocity(rpm));
    search(&machine, &Search { revolutions, impacts: Some(1) }).unwrap()
}

#[track_caller]
fn near(computed: f64, derived: f64, size: f64, what: &str) {
    assert!((computed - derived).abs() <= DIGITS * size, "{what}: {computed:.15} against {derived:.15}");
}

/// A pair of complex numbers that are each other's conjugates, or two real ones: the larger real part first.
fn derived_multipliers(orbit: &Value) -> Vec<Eigenvalue> {
    let pair = orbit["multipliers"].as_array().unwrap();
    pair.iter().map(|one| Eigenvalue { re: number(&one["re"]), im: number(&one["im"]) }).collect()
}

fn meets(orbit: &PeriodicOrbit, derived: &Value, omega: f64) {
    let impact = orbit.impacts().next().unwrap();
    near(impact.cam_angle, number(&derived["cam_angle"]), 1.0, "cam angle");
    let before = number(&derived["velocity_before"]);
    near(impact.velocity_before, before, before.abs(), "velocity before");
    let (position, velocity) = (number(&derived["state"][0]), number(&derived["state"][1]));
    let size = position.hypot(velocity / omega);
    near(orbit.state.position, position, size, "position");
    near(orbit.state.velocity, velocity, size * omega, "velocity");
    for (found, derived) in orbit.multipliers().iter().zip(derived_multipliers(derived)) {
        near(found.re, derived.re, derived.modulus().max(1.0), "multiplier");
        near(found.im, derived.im, derived.modulus().max(1.0), "multiplier");
    }
    assert_eq!(orbit.is_stable(), derived_multipliers(derived).iter().all(|one| one.modulus() < 1.0));
}

/// No orbit is missed, none made up, stable or not.
fn both_are_found(model: &Model, rpm: f64, case: &Value) {
    let derived = case["orbits"].as_array().unwrap();
    let found = found(model, rpm, revolutions(case));
    assert_eq!(found.len(), derived.len(), "{found:#?}");
    for derived in derived {
        let angle = number(&derived["cam_angle"]);
        let apart = |orbit: &&PeriodicOrbit| (orbit.impacts().next().unwrap().cam_angle - angle).abs();
        let nearest = found.iter().min_by(|one, two| apart(one).total_cmp(&apart(two))).unwrap();
        assert!(nearest.residual <= DIGITS);
        meets(nearest, derived, angular_velocity(rpm));
    }
}

#[test]
fn the_oscillators_orbits_are_found() {
    for case in cases("oscillator") {
        let (model, rpm) = oscillator(&case);
        both_are_found(&model, rpm, &case);
    }
}

#[test]
fn the_balls_orbits_are_found() {
    for case in cases("table") {
        let (model, rpm) = table(&case);
        both_are_found(&model, rpm, &case);
    }
}

/// The branch through each orbit found: two of them, and the same one as long as a fold joins the two.
fn branches(model: &Model, rpm: f64, case: &Value, parameter: &str, range: [f64; 2]) -> Vec<Branch> {
    let parameter = Parameter::named(model, parameter).unwrap();
    let following = Following { parameter, range, longest_step: 0.05, most_points: 400 };
    let found = found(model, rpm, revolutions(case));
    found.iter().map(|orbit| Branch::through(model, rpm, orbit, &following).unwrap()).collect()
}

/// Among the orbits of one impact: the branch may go on with more.
fn all_of(branch: &Branch, is: impl Fn(&SpecialKind) -> bool) -> Vec<&BranchPoint> {
    let one_impact = branch.points.iter().filter(|point| point.orbit.impacts().count() == 1);
    one_impact.filter(|point| point.special.is_some_and(|special| is(&special.kind))).collect()
}

/// The one point of its kind, with its status: between the ends of its bracket, next to nothing left.
#[track_caller]
fn the_one(branch: &Branch, is: impl Fn(&SpecialKind) -> bool, derived: f64) -> &BranchPoint {
    let points = all_of(branch, is);
    let kinds: Vec<_> = branch.points.iter().filter_map(|point| Some((point.value, point.special?))).collect();
    assert_eq!(points.len(), 1, "{derived} among {kinds:#?}, ends {:?}", branch.ends);
    let (point, special) = (points[0], points[0].special.unwrap());
    near(point.value, derived, derived.abs(), special.kind.name());
    assert!(special.residual <= 1e-9, "{special:?}");
    let [low, high] = special.bracket;
    if [SpecialKind::Fold, SpecialKind::Flip].contains(&special.kind) {
        assert_eq!(point.orbit.judgement.stability, Stability::Neutral, "{point:?}");
    }
    let rounding = DIGITS * derived.abs();
    assert!(low - rounding <= point.value && point.value <= high + rounding, "{} in {special:?}", point.value);
    point
}

/// The wall as parameter: from the graze where the slow orbit begins, round the fold, to the fast one's flip and beyond.
#[test]
#[ignore = "slow"]
fn the_oscillators_branch_has_its_graze_its_fold_and_its_flip() {
    for case in cases("oscillator") {
        let (model, rpm) = oscillator(&case);
        let (fold, flip, graze) = (number(&case["fold"]), number(&case["flip"]), number(&case["graze"]));
        let range = [1.5 * fold, flip.max(graze) + 0.05 * fold.abs()];
        for branch in branches(&model, rpm, &case, "offset", range) {
            let at_fold = the_one(&branch, |kind| *kind == SpecialKind::Fold, fold);
            assert!(at_fold.orbit.multipliers().iter().any(|one| (one.re - 1.0).abs() < 1e-6));
            let at_flip = the_one(&branch, |kind| *kind == SpecialKind::Flip, flip);
            assert!(at_flip.orbit.multipliers().iter().any(|one| (one.re + 1.0).abs() < 1e-9));
            // Its one impact becomes a touch, and the follower at rest goes on to the end of the range.
            let is_its_own = |kind: &SpecialKind| matches!(kind, SpecialKind::Graze { before, after, .. } if before.min(after) == &0);
            let points = branch.points.iter().filter(|point| point.special.is_some_and(|at| is_its_own(&at.kind)));
            let [at] = points.collect::<Vec<_>>()[..] else { panic!("{:?}", branch.ends) };
            near(at.value, graze, graze.abs(), "graze");
            assert!(branch.ends.contains(&End::Range), "{:?}", branch.ends);
            assert!(branch.points.iter().any(|point| point.special.is_none() && point.orbit.impacts().count() == 0));
            the_one(
                &branch,
                |kind| matches!(kind, SpecialKind::Graze { before: 1, after: 2, .. }),
                number(&case["touch"]),
            );
        }
    }
}

/// The speed, and the restitution, as parameter: the table just fast enough at the fold.
#[test]
fn the_balls_branch_has_its_fold_and_its_flip() {
    for case in cases("table") {
        let (model, rpm) = table(&case);
        let (fold, flip) = (number(&case["fold_rpm"]), number(&case["flip_rpm"]));
        for branch in branches(&model, rpm, &case, "rpm", [0.9 * fold, 1.05 * flip]) {
            the_one(&branch, |kind| *kind == SpecialKind::Fold, fold);
            the_one(&branch, |kind| *kind == SpecialKind::Flip, flip);
        }
        let (fold, given) = (number(&case["fold_restitution"]), number(&case["restitution"]));
        for branch in branches(&model, rpm, &case, "restitution", [0.9 * fold, 0.5 + 0.5 * given]) {
            the_one(&branch, |kind| *kind == SpecialKind::Fold, fold);
        }
    }
}

/// On a table of 65 alike waves a revolution the ball hits every 17th, each time as high up on it, and is back on the first one after 17
/// revolutions: an orbit of 65 impacts, of which none follows the one before soon.
#[test]
fn an_orbit_of_many_revolutions_may_have_as_many_impacts() {
    let (waves, every, gravity, restitution, omega) = (65.0_f64, 17.0_f64, 9.81_f64, 0.5_f64, TAU);
    // v+ = g t/2 = -v-, so that (1 - r) g t/2 = (1 + r) c'; stable right behind the fold, where c' is the largest that there is.
    let time = every / waves * TAU / omega;
    let (after, sine) = (0.5 * gravity * time, -0.9995_f64);
    let cosine = (1.0 - sine * sine).sqrt();
    let amplitude = (1.0 - restitution) / (1.0 + restitution) * after / (waves * omega * -sine);
    let mut amplitudes = [0.0; 65];
    amplitudes[64] = amplitude;
    let cam =
        format!("[cam]\nlaw = \"harmonic\"\noffset = 0.0\namplitudes = {amplitudes:?}\nphases_deg = {:?}\n", [0.0; 65]);
    let model = Model::parse("waves.toml", &(follower(0.0, gravity, restitution) + &cam)).unwrap();
    let machine = Machine::new(Cam::new(&model).unwrap(), &model.follower, omega);
    // The impact on the first wave, and how long before angle 0 the one before it is.
    let first = sine.atan2(cosine).rem_euclid(TAU) / waves;
    let since = time - first / omega;
    let position = amplitude * cosine + after * since - 0.5 * gravity * since * since;
    let state = State { position, velocity: after - gravity * since };
    let orbit = near::near(&machine, 0.0, state, every as u64).unwrap().expect("an orbit");
    assert_eq!((orbit.revolutions, orbit.impacts().count()), (17, 65));
    assert!(orbit.is_stable() && orbit.events.len() == 65, "{orbit:?}");
    for (index, impact) in orbit.impacts().enumerate() {
        let turned = first + index as f64 * every / waves * TAU;
        near(impact.turned_since(0.0), turned, 1.0, "cam angle");
        near(impact.velocity_after, after, after, "velocity after");
    }
}
