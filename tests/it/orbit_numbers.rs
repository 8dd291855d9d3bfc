//! Have orbits, their branches, and what runs come to moved? Each to the digits that it is known to, in a snapshot; that they are right is
//! for other files.

use std::path::Path;

use corner_impact::cam::Cam;
use corner_impact::model::Model;
use corner_impact::orbit::branch::{Branch, BranchPoint, End, Following, SpecialKind};
use corner_impact::orbit::long_run::{Budget, LongRun};
use corner_impact::orbit::runs::LongRuns;
use corner_impact::orbit::search::velocity_scale;
use corner_impact::orbit::{Course, Parameter, PeriodicOrbit, Search, search, search_all};
use corner_impact::progress::Unwatched;
use corner_impact::simulate::{EventKind, Machine, angular_velocity};
use corner_impact::study::continuation::branches;
use corner_impact::study::survey::long_run;

use crate::common;
use crate::random::{Case, cases_of_every_law, drawn};
use crate::snapshots;

pub fn model(name: &str) -> Model {
    common::read(Path::new(&format!("models/{name}.toml")))
}

pub fn machine(model: &Model, rpm: f64) -> Machine {
    Machine::new(Cam::new(model).unwrap(), &model.follower, angular_velocity(rpm))
}

pub fn orbits(model: &Model, rpm: f64, revolutions: u64) -> Vec<PeriodicOrbit> {
    search(&machine(model, rpm), &Search { revolutions, impacts: None }).unwrap()
}

pub fn is_as_it_was(name: &str, found: &str) {
    snapshots::settings().bind(|| insta::assert_snapshot!(name, found));
}

/// So many digits of a number; what is nothing but rounding is 0.
fn digits(number: f64, count: usize) -> String {
    if number.abs() < 1e-9 { "0".into() } else { format!("{number:.*e}", count - 1) }
}

/// Rad; what rounding moves over angle 0 has no sign.
fn angle(angle: f64) -> String {
    format!("{angle:.5}").replace("-0.00000", "0.00000")
}

pub fn orbit(orbit: &PeriodicOrbit) -> String {
    assert!(orbit.residual < 1e-9, "{orbit:?}");
    let event = |event: &corner_impact::simulate::Event| {
        let kind = match event.kind {
            EventKind::Impact => digits(event.velocity_before, 6),
            EventKind::Stick => "sticks".into(),
            EventKind::Release => "released".into(),
        };
        format!("{}:{:.6} {kind}", event.revolution, event.cam_angle)
    };
    let events: Vec<String> = orbit.events.iter().map(event).collect();
    let course = match &orbit.course {
        Course::Impacts(_) => "impacts".into(),
        Course::Sticking(anchor) => format!("sticking at {anchor:.6}"),
        Course::Free => "free".into(),
    };
    format!(
        "{} of {}, {:?}: {}; from {} {}, trace {}",
        course,
        orbit.revolutions,
        orbit.known,
        events.join(", "),
        digits(orbit.state.position, 8),
        digits(orbit.state.velocity, 8),
        digits(orbit.matrix.trace(), 5)
    )
}

fn special(kind: SpecialKind, residual: f64) -> String {
    match kind {
        // How long it rests goes to 0 there.
        SpecialKind::Chatter => {
            assert!(0.0 < residual && residual < 1e-5, "{residual}");
            "chatter".into()
        }
        SpecialKind::Corner { impact, segment, jump_order } => {
            format!("corner of impact {impact}, segment {segment}, order {jump_order}")
        }
        SpecialKind::Graze { before, after, turned, .. } => format!("graze from {before} to {after} at {turned:.5}"),
        SpecialKind::Type { after_corner, multiplier } => format!("type {after_corner:?} {multiplier}"),
        other => other.name().into(),
    }
}

/// What changes along it, and every fifteenth point besides.
fn branch(branch: &Branch, span: f64) -> String {
    let specials: Vec<f64> = branch.points.iter().filter(|it| it.special.is_some()).map(|it| it.value).collect();
    let point = |point: &BranchPoint| {
        assert!(point.orbit.residual < 1e-7, "{point:?}");
        // Next to where something changes for a follower that rests, rounding decides how many impacts come before.
        let rests = matches!(point.orbit.course, Course::Sticking(_));
        let is_at = |value: f64| (point.value - value).abs() <= 1e-5 * value.abs();
        let is_open = rests && (point.held.is_some() || specials.iter().any(|value| is_at(*value)));
        let events = if is_open { &[] } else { &point.orbit.events[..] };
        let angles: Vec<String> = events.iter().take(6).map(|event| angle(event.cam_angle)).collect();
        let known = if rests { 7 } else { 9 };
        let speed = if point.rpm == point.value { String::new() } else { format!(" {} rpm", digits(point.rpm, known)) };
        let sides = point.held.as_ref().map_or(vec![point.orbit.matrix], |held| held.sides.clone());
        let maps = sides.iter().map(|map| digits(map.trace(), 5));
        let place = point.held.as_ref().map_or(String::new(), |held| format!(" at {}", angle(held.cam_angle)));
        let maps: Vec<String> = maps.collect();
        let count = events.len();
        format!("{}{speed}: {count} at {}{place}; {}", digits(point.value, known), angles.join(" "), maps.join(", "))
    };
    let ends = branch.ends.each_ref().map(End::words);
    let mut told = format!("  {} points, from {}, to {}\n", branch.points.len(), ends[0], ends[1]);
    for (index, at) in branch.points.iter().enumerate() {
        if let Some(it) = at.special {
            let [low, high] = it.bracket;
            let is_seen = it.kind == SpecialKind::Branching || matches!(at.orbit.course, Course::Sticking(_));
            assert!(low <= high && high - low < if is_seen { 1e-3 } else { 1e-8 } * span, "{it:?}");
            told += &format!("    {} {}\n", special(it.kind, it.residual), point(at));
        } else if index % 15 == 0 {
            told += &format!("    {}\n", point(at));
        }
    }
    let lines: Vec<usize> = branch.lines().iter().map(|line| line.points.len()).collect();
    let is_curve = branch.points.iter().any(|point| point.held.is_some());
    if is_curve || lines.is_empty() { told } else { told + &format!("    lines of {lines:?}\n") }
}

/// The branches through all orbits of a speed.
fn through(name: &str, rpm: f64, revolutions: u64, parameter: &str, range: [f64; 2], longest_step: f64) -> String {
    let model = model(name);
    let followed = Parameter::named(&model, parameter).unwrap();
    let following = Following { parameter: followed, range, longest_step, most_points: 150 };
    let mut told = format!("{name} from {rpm} rpm, {parameter} {range:?}\n");
    for it in orbits(&model, rpm, revolutions) {
        let followed = Branch::through(&model, rpm, &it, &following).unwrap();
        let third = &followed.points[followed.points.len() / 3];
        assert!(followed.holds(third.value, &third.orbit), "{name} {parameter} {third:?}");
        told += &branch(&followed, range[1] - range[0]);
    }
    told
}

#[test]
fn branches_in_the_speed() {
    let told = [
        through("osorio-2008", 700.0, 1, "rpm", [660.0, 760.0], 0.03),
        through("osorio-2008", 442.0, 1, "rpm", [425.0, 460.0], 0.05),
        through("osorio-2008", 320.0, 1, "rpm", [310.0, 340.0], 0.05),
        through("osorio-2008", 760.0, 2, "rpm", [750.0, 800.0], 0.05),
        through("laws/harmonic", 500.0, 1, "rpm", [470.0, 560.0], 0.05),
        through("laws/program", 2900.0, 1, "rpm", [2800.0, 3100.0], 0.05),
        through("laws/rectified-sine", 25.0, 1, "rpm", [12.0, 50.0], 0.05),
        through("laws/table-cubic", 850.0, 1, "rpm", [840.0, 860.0], 0.2),
        through("persistence", 493.0, 1, "rpm", [490.0, 496.0], 0.05),
        through("damped-heavy", 752.0, 1, "rpm", [745.0, 760.0], 0.05),
    ];
    is_as_it_was("branches-speed", &told.concat());
}

#[test]
#[ignore = "slow"]
fn branches_in_numbers_of_the_model() {
    let told = [
        through("osorio-2008", 700.0, 1, "restitution", [0.75, 0.9], 0.05),
        through("osorio-2008", 700.0, 1, "stiffness", [1400.0, 1460.0], 0.05),
        through("osorio-2008", 700.0, 1, "nose_radius", [0.145, 0.155], 0.1),
        through("osorio-2008", 700.0, 1, "flank_start_deg", [85.0, 92.0], 0.1),
        through("osorio-2008", 700.0, 1, "nose_end_deg", [150.0, 190.0], 0.05),
        through("osorio-2008", 442.0, 1, "mass", [1.15, 1.3], 0.05),
        through("osorio-2008", 700.0, 1, "damping", [-1.0, 4.0], 0.05),
        through("laws/harmonic", 500.0, 1, "amplitudes[1]", [-0.001, 0.001], 0.05),
        through("laws/program", 2900.0, 1, "rest_position", [0.019, 0.021], 0.05),
        through("preloaded", 660.0, 1, "rest_position", [-1.0, 1.0], 0.05),
    ];
    is_as_it_was("branches-numbers", &told.concat());
}

#[test]
fn branches_of_a_follower_that_rests() {
    let told = [
        through("osorio-2008", 150.0, 1, "rpm", [100.0, 250.0], 0.05),
        through("osorio-2008", 90.0, 1, "rpm", [-5.0, 100.0], 0.2),
        through("osorio-2008", 150.0, 1, "stiffness", [1200.0, 1500.0], 0.05),
        through("osorio-2008", 190.0, 1, "restitution", [0.7, 0.83], 0.1),
        through("laws/harmonic", 340.0, 1, "rpm", [300.0, 420.0], 0.05),
        through("laws/polynomial", 700.0, 1, "rpm", [690.0, 710.0], 0.1),
    ];
    is_as_it_was("branches-resting", &told.concat());
}

/// What branches off with twice the period, and what crosses.
#[test]
fn branches_that_branch_off() {
    let mut told = String::new();
    for (name, rpm, range, doublings) in [
        ("osorio-2008", 735.0, [730.0, 745.0], 1),
        ("nonsmooth-flip", 890.0, [870.0, 900.0], 2),
        ("laws/rectified-sine", 12.0, [10.0, 20.0], 1),
    ] {
        let model = model(name);
        let following = Following { parameter: Parameter::Speed, range, longest_step: 0.05, most_points: 400 };
        let wanted = Search { revolutions: 1, impacts: None };
        let found = branches(&model, rpm, &wanted, following, doublings, &Unwatched).unwrap().branches;
        told += &format!("{name} from {rpm} rpm, {range:?}\n");
        told.extend(found.iter().map(|it| branch(it, range[1] - range[0])));
    }
    is_as_it_was("branches-doubled", &told);
}

/// The curves of what changes on the branches through all orbits of a speed, each that is not one before.
fn curves(name: &str, rpm: f64, speeds: [f64; 2], parameter: &str, range: [f64; 2]) -> String {
    let model = model(name);
    let in_speed = Following { parameter: Parameter::Speed, range: speeds, longest_step: 0.05, most_points: 400 };
    let parameter = Parameter::named(&model, parameter).unwrap();
    let following = Following { parameter, range, longest_step: 0.05, most_points: 400 };
    let mut told = format!("{name} near {rpm} rpm, {} {range:?}\n", following.parameter.name());
    let mut seen: Vec<f64> = Vec::new();
    for it in orbits(&model, rpm, 1) {
        let followed = Branch::through(&model, rpm, &it, &in_speed).unwrap();
        for point in followed.points.iter().filter(|point| point.special.is_some()) {
            if seen.iter().any(|rpm| (rpm - point.rpm).abs() < 1e-6) {
                continue;
            }
            seen.push(point.rpm);
            let curve = Branch::of_event(&model, point, speeds, &following).unwrap();
            told += &format!(
                " {} at {} rpm\n",
                point.special.map(|it| special(it.kind, it.residual)).unwrap_or_default(),
                digits(point.rpm, 9)
            );
            told += &curve.map_or("  none\n".into(), |curve| branch(&curve, range[1] - range[0]));
        }
    }
    told
}

#[test]
#[ignore = "slow"]
fn curves_in_two_numbers() {
    let told = [
        curves("osorio-2008", 700.0, [660.0, 760.0], "restitution", [0.7, 0.9]),
        curves("osorio-2008", 442.0, [425.0, 460.0], "nose_radius", [0.145, 0.155]),
        curves("laws/harmonic", 500.0, [470.0, 560.0], "damping", [0.0, 1.0]),
        curves("persistence", 494.0, [490.0, 496.0], "stiffness", [600.0, 700.0]),
        curves("damped-heavy", 752.0, [745.0, 760.0], "damping", [70.0, 80.0]),
        curves("laws/rectified-sine", 25.0, [15.0, 30.0], "restitution", [0.2, 0.9]),
    ];
    is_as_it_was("curves", &told.concat());
}

/// Up to bounds of the model, through corners and grazes of other impacts, to where velocities grow without bound, and to chattering.
#[test]
#[ignore = "slow"]
fn curves_over_wide_ranges() {
    let told = [
        curves("osorio-2008", 700.0, [660.0, 760.0], "restitution", [0.3, 1.2]),
        curves("osorio-2008", 442.0, [425.0, 460.0], "restitution", [0.3, 1.2]),
        curves("osorio-2008", 442.0, [425.0, 460.0], "flank_start_deg", [60.0, 120.0]),
        curves("osorio-2008", 320.0, [310.0, 340.0], "restitution", [0.6, 1.2]),
        curves("nonsmooth-flip", 890.0, [870.0, 900.0], "restitution", [0.1, 1.2]),
        curves("damped-heavy", 752.0, [745.0, 760.0], "restitution", [0.0, 1.2]),
        curves("laws/rectified-sine", 25.0, [12.0, 50.0], "damping", [0.0, 10.0]),
        curves("laws/polynomial", 700.0, [500.0, 800.0], "restitution", [0.1, 1.2]),
    ];
    is_as_it_was("curves-wide", &told.concat());
}

#[test]
#[ignore = "slow"]
fn curves_of_a_follower_that_rests() {
    let told = [
        curves("osorio-2008", 150.0, [100.0, 250.0], "stiffness", [1420.0, 1440.0]),
        curves("osorio-2008", 150.0, [100.0, 250.0], "restitution", [0.79, 0.81]),
        curves("laws/harmonic", 340.0, [300.0, 420.0], "damping", [0.0, 0.5]),
        curves("osorio-2008", 190.0, [185.0, 205.0], "restitution", [0.77, 0.85]),
    ];
    is_as_it_was("curves-resting", &told.concat());
}

/// Random machines, but for those that take more than a moment, by their numbers.
fn machines(count: usize, slow: &[usize]) -> impl Iterator<Item = (usize, Case)> {
    drawn(cases_of_every_law(), count).into_iter().enumerate().filter(|(index, _)| !slow.contains(index))
}

/// What a search finds, and what it could not decide.
fn found(machine: &Machine, wanted: &Search) -> String {
    match search_all(machine, wanted, &Unwatched) {
        Ok(found) => {
            let undecided = found.undecided.iter().flat_map(|it| &it.cam_angles);
            let undecided: Vec<String> =
                undecided.map(|[low, high]| format!("{} to {}", angle(*low), angle(*high))).collect();
            let known: Vec<String> = found
                .complete
                .iter()
                .map(|it| format!("{} of {} {:?}", it.impacts, it.revolutions, it.known))
                .collect();
            let mut told = format!("  all {}; undecided {}\n", known.join(", "), undecided.join(", "));
            told.extend(found.orbits.iter().map(|it| format!("    {}\n", orbit(it))));
            told
        }
        Err(error) => format!("  {error}\n"),
    }
}

#[test]
fn orbits_of_one_impact_of_any_machine() {
    let mut told = String::new();
    for (index, case) in machines(60, &[2, 13, 35]) {
        for revolutions in [1, 2] {
            told +=
                &format!("{index}, {revolutions}\n{}", found(&case.machine, &Search { revolutions, impacts: Some(1) }));
        }
    }
    is_as_it_was("orbits-one", &told);
}

/// Machines whose flights pass segments and turns of the cam, meet it on the way, or end where it is not proved that they do.
#[test]
fn orbits_of_one_impact_after_long_flights() {
    let (mut told, drawn) = (String::new(), drawn(cases_of_every_law(), 114));
    for index in [60, 61, 63, 85, 86, 113] {
        for revolutions in [1, 2, 3] {
            let wanted = Search { revolutions, impacts: Some(1) };
            told += &format!("{index}, {revolutions}\n{}", found(&drawn[index].machine, &wanted));
        }
    }
    is_as_it_was("orbits-one-long", &told);
}

/// Next to grazes, on either side: a flight that clears the cam by next to nothing, and one that does not.
#[test]
fn orbits_of_one_impact_next_to_grazes() {
    let mut told = String::new();
    for (name, rpm) in [
        ("laws/harmonic", 517.187805),
        ("laws/program", 3085.94146),
        ("laws/polynomial", 607.947896),
        ("damped-heavy", 752.164816),
    ] {
        for off in [-1e-3, -1e-5, -1e-7, 1e-7, 1e-5, 1e-3] {
            let machine = machine(&model(name), rpm * (1.0 + off));
            let wanted = Search { revolutions: 1, impacts: Some(1) };
            told += &format!("{name}, {off:e} beyond\n{}", found(&machine, &wanted));
        }
    }
    is_as_it_was("orbits-grazing", &told);
}

#[test]
fn orbits_of_two_impacts_of_any_machine() {
    let mut told = String::new();
    let slow = [2, 3, 5, 6, 7, 8, 11, 13, 16, 18, 19, 20, 21, 23, 26, 27, 32, 34, 35, 39, 41];
    for (index, case) in machines(42, &slow) {
        told += &format!("{index}\n{}", found(&case.machine, &Search { revolutions: 1, impacts: Some(2) }));
    }
    is_as_it_was("orbits-two", &told);
}

#[test]
#[ignore = "slow"]
fn orbits_of_any_machine() {
    let mut told = String::new();
    for (index, case) in machines(30, &[2, 6, 13, 23, 27, 29]) {
        for revolutions in [1, 2, 3] {
            told += &format!("{index}, {revolutions}\n");
            match search(&case.machine, &Search { revolutions, impacts: None }) {
                Ok(found) => told.extend(found.iter().map(|it| format!("    {}\n", orbit(it)))),
                Err(error) => told += &format!("    {error}\n"),
            }
        }
    }
    is_as_it_was("orbits-any", &told);
}

pub fn ending(ending: &LongRun) -> String {
    match ending {
        LongRun::PermanentContact => "stays".into(),
        LongRun::Orbit(it) => orbit(it),
        // The last digits of a sine decide what follows of these.
        LongRun::Chaotic(_) | LongRun::Undecided(_) => "does not repeat".into(),
        LongRun::Sticking(it) if it.growth > 8.0 => format!("rests after long, {}", it.is_long()),
        LongRun::Sticking(it) => {
            let releases: Vec<String> = it.releases.iter().map(|release| angle(*release)).collect();
            let [speed, growth] = [it.impact_speed, it.growth].map(|number| digits(number, 5));
            let [impacts, revolutions] = [it.impacts, it.revolutions];
            format!("rests: {impacts} of {revolutions}, at {speed}, grows by {growth}; {}", releases.join(" "))
        }
    }
}

#[test]
fn what_runs_of_any_machine_come_to() {
    let mut told = String::new();
    for (index, case) in machines(60, &[2, 13, 29, 35]) {
        let budget = Budget { transient: 400, record: 1600, longest: 4, patience: 0 };
        let ended = case.motion().and_then(|motion| long_run(&case.machine, motion, budget).map(|part| part.ending));
        told += &format!("{index}, {} known: ", LongRuns::new(&case.machine, budget).unwrap().known().count());
        told += &ended.map_or_else(|error| error.to_string(), |it| ending(&it));
        told += "\n";
    }
    is_as_it_was("endings", &told);
}

/// Few impacts are faster than a flight of one revolution under the force at the cam's top, plus four times the cam's velocity: g T and 4 V of a
/// weight without a spring.
#[test]
fn impacts_have_a_scale_of_velocity() {
    let text = "[follower]\nmass = 2.0\nrestitution = 0.5\nstiffness = 0.0\nrest_position = 0.0\ngravity = 9.81\ndamping = 0.0\n\
                [cam]\nlaw = \"harmonic\"\noffset = 0.0\namplitudes = [0.02]\nphases_deg = [0.0]\n";
    let ball = Model::parse("ball.toml", text).unwrap();
    for rpm in [60.0, 600.0] {
        let wanted = 9.81 * 60.0 / rpm + 4.0 * 0.02 * angular_velocity(rpm);
        let scale = velocity_scale(&machine(&ball, rpm));
        assert!((scale / wanted - 1.0).abs() < 1e-6, "{rpm}: {scale} {wanted}");
    }
}
