//! Does a branch know where angle 0 of its cam is?
//!
//! A cam that is turned on its shaft is the same machine: what happens does so at the same speeds, its contacts all turned alike.

use std::path::Path;

use corner_impact::cam::Cam;
use corner_impact::model::Model;
use corner_impact::orbit::branch::{Branch, Following};
use corner_impact::orbit::{Course, Parameter, Search, search};
use corner_impact::simulate::{Machine, angular_velocity};

use crate::common;

fn harmonic() -> Model {
    common::read(Path::new("models/laws/harmonic.toml"))
}

fn with(model: &Model, numbers: &[(&str, f64)]) -> Model {
    numbers.iter().fold(model.clone(), |model, (name, value)| model.with_number(name, *value).unwrap())
}

/// The cam turned by so many degrees: a cos(k (theta - turn) + p).
fn turned(degrees: f64) -> Model {
    let phases = [("cam.phases_deg[0]", 180.0 - degrees), ("cam.phases_deg[1]", -2.0 * degrees)];
    with(&harmonic(), &phases.map(|(name, phase)| (name, phase.rem_euclid(360.0))))
}

/// What is asked of a machine: the branches from a speed, rpm, of orbits of so many revolutions over speeds, and the curves in a number
/// over values.
struct Asked {
    rpm: f64,
    revolutions: u64,
    speeds: [f64; 2],
    parameter: &'static str,
    values: [f64; 2],
}

/// Words, values and speeds, rpm, that two machines are compared by.
type Told = Vec<(String, [f64; 2])>;

/// How a branch ends, and what changes along it.
fn along(branch: &Branch) -> Told {
    let ends = branch.ends.iter().zip([branch.points.first().unwrap(), branch.points.last().unwrap()]);
    let specials = branch.points.iter().filter_map(|point| Some((point, point.special?)));
    let ends = ends.map(|(end, point)| (end.words(), [point.value, point.rpm]));
    ends.chain(specials.map(|(point, it)| (it.kind.name().into(), [point.value, point.rpm]))).collect()
}

/// All branches and curves, by where they are.
fn told(model: &Model, asked: &Asked) -> Vec<Told> {
    let machine = Machine::new(Cam::new(model).unwrap(), &model.follower, angular_velocity(asked.rpm));
    let following = |parameter, range| Following { parameter, range, longest_step: 0.05, most_points: 400 };
    let in_speed = following(Parameter::Speed, asked.speeds);
    let in_number = following(Parameter::named(model, asked.parameter).unwrap(), asked.values);
    let mut all = Vec::new();
    for orbit in search(&machine, &Search { revolutions: asked.revolutions, impacts: None }).unwrap() {
        let branch = Branch::through(model, asked.rpm, &orbit, &in_speed).unwrap();
        let rests = matches!(orbit.course, Course::Sticking(_));
        // Along this one the value is the speed.
        let here = along(&branch).into_iter().map(|(words, [_, rpm])| (words, [0.0, rpm]));
        all.push([(format!("rests: {rests}"), [0.0; 2])].into_iter().chain(here).collect());
        for point in branch.points.iter().filter(|point| point.special.is_some()) {
            let curve = Branch::of_event(model, point, asked.speeds, &in_number).unwrap();
            all.extend(curve.map(|curve| along(&curve)));
        }
    }
    // Orbits are numbered from angle 0 on.
    let key = |told: &Told| told.iter().map(|(words, _)| words.clone()).collect::<Vec<_>>();
    all.sort_by(|one, two| {
        let numbers = |told: &Told| told.iter().map(|(_, at)| at[0] + at[1]).sum::<f64>();
        key(one).cmp(&key(two)).then(numbers(one).total_cmp(&numbers(two)))
    });
    all
}

/// The same words, values and speeds.
fn is_the_same(one: &[Told], two: &[Told], about: &str) {
    assert_eq!(one.len(), two.len(), "{about}: {one:#?} {two:#?}");
    for (one, two) in one.iter().zip(two) {
        assert_eq!(one.len(), two.len(), "{about}: {one:#?} {two:#?}");
        for ((one_words, one_at), (two_words, two_at)) in one.iter().zip(two) {
            assert_eq!(one_words, two_words, "{about}: {one:#?} {two:#?}");
            let near = |one: f64, two: f64| (one - two).abs() <= 1e-6 * (one.abs() + 1e-3);
            let near = near(one_at[0], two_at[0]) && near(one_at[1], two_at[1]);
            assert!(near, "{about} {one_words}: {one_at:?} {two_at:?}");
        }
    }
}

const LEAVES: Asked =
    Asked { rpm: 500.0, revolutions: 1, speeds: [470.0, 560.0], parameter: "damping", values: [0.0, 1.0] };
const RESTS: Asked =
    Asked { rpm: 340.0, revolutions: 1, speeds: [300.0, 420.0], parameter: "damping", values: [0.0, 0.5] };

#[test]
fn a_cam_that_is_turned_on_its_shaft_has_the_same_branches() {
    for asked in [&LEAVES, &RESTS] {
        let first = told(&harmonic(), asked);
        assert!(first.iter().flatten().count() > 8, "{first:#?}");
        for degrees in [110.0, 190.0, 260.0] {
            is_the_same(&first, &told(&turned(degrees), asked), &format!("turned by {degrees} degrees"));
        }
    }
}

/// A cosine has its ends where its phase says, also next to where a turn begins and ends.
#[test]
fn the_ends_of_a_turned_cosine_are_where_it_is_turned_to() {
    for degrees in [-0.2, -0.1, -1e-3, 1e-3, 0.05, 0.12, 0.2, 0.3, 180.0, 180.1] {
        let phases = [("cam.phases_deg[0]", f64::rem_euclid(-degrees, 360.0)), ("cam.amplitudes[1]", 0.0)];
        let cam = Cam::new(&with(&harmonic(), &phases)).unwrap();
        let (lowest, highest) = (cam.lowest(), cam.least([-1.0, 0.0, 0.0, 0.0]));
        for (found, value, at) in [(lowest.value, 0.08, degrees + 180.0), (-highest.value, 0.12, degrees)] {
            assert!((found - value).abs() < 1e-15, "{degrees}: {found}");
            let angle = if value < 0.1 { lowest.angle } else { highest.angle };
            let off = (angle - at.to_radians() + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU);
            assert!((off - std::f64::consts::PI).abs() < 1e-7, "{degrees}: {angle}");
        }
    }
}
