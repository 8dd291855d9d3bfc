//! Is an orbit without impacts followed to where the cam comes to touch it, and is what is said of the motions beyond so in the simulator?

use std::f64::consts::{PI, TAU};

use corner_impact::cam::Cam;
use corner_impact::model::Model;
use corner_impact::orbit::branch::{
    Bifurcation, Branch, BranchPoint, Doubt, End, FirstTouch, Following, GrazeClass, SpecialKind, UndecidedGraze,
};
use corner_impact::orbit::long_run::{Budget, LongRun};
use corner_impact::orbit::{Course, Parameter, PeriodicOrbit, Search, search};
use corner_impact::progress::Unwatched;
use corner_impact::simulate::{Machine, angular_velocity};
use corner_impact::study::curve::{Curves, curves};
use corner_impact::study::survey::long_run;

/// An oscillator of mass 1 at 0, and a wall that is moved harmonically by 1 about an offset.
fn wall(damping: f64, stiffness: f64, offset: f64) -> Model {
    on_cam(
        damping,
        stiffness,
        &format!("law = \"harmonic\"\noffset = {offset:?}\namplitudes = [1.0]\nphases_deg = [0.0]"),
    )
}

fn on_cam(damping: f64, stiffness: f64, cam: &str) -> Model {
    let follower = format!(
        "[follower]\nmass = 1.0\ndamping = {damping:?}\nstiffness = {stiffness:?}\ngravity = 0.0\nrest_position = 0.0\nrestitution = 0.8"
    );
    Model::parse("wall.toml", &format!("name = \"wall\"\n{follower}\n[cam]\n{cam}")).unwrap()
}

fn machine(model: &Model, rpm: f64) -> Machine {
    Machine::new(Cam::new(model).unwrap(), &model.follower, angular_velocity(rpm))
}

fn free(model: &Model, rpm: f64) -> PeriodicOrbit {
    let found = search(&machine(model, rpm), &Search { revolutions: 1, impacts: Some(0) }).unwrap();
    let [orbit] = &found[..] else { panic!("{found:?}") };
    assert!(orbit.course == Course::Free && orbit.events.is_empty(), "{orbit:?}");
    orbit.clone()
}

fn follow(model: &Model, rpm: f64, orbit: &PeriodicOrbit, parameter: &str, range: [f64; 2]) -> Branch {
    let parameter = Parameter::named(model, parameter).unwrap();
    let following = Following { parameter, range, longest_step: 0.05, most_points: 100 };
    Branch::through(model, rpm, orbit, &following).unwrap()
}

fn graze(branch: &Branch) -> (&BranchPoint, FirstTouch) {
    let first = |point: &BranchPoint| match point.special?.kind {
        SpecialKind::Graze { first, .. } => first,
        _ => None,
    };
    let mut grazes = branch.points.iter().filter_map(|point| Some((point, first(point)?)));
    let found = grazes.next().unwrap_or_else(|| panic!("no graze: {:?}", branch.ends));
    assert!(grazes.next().is_none());
    found
}

/// The touch of the wall at 0, with the follower at rest above it.
fn touch(model: &Model, rpm: f64) -> FirstTouch {
    graze(&follow(model, rpm, &free(model, rpm), "offset", [-1.02, -0.99])).1
}

/// The equilibrium is rest - g m/k, and the wall's top at offset + amplitude.
#[test]
fn a_follower_at_rest_is_touched_where_the_cams_top_is_as_high() {
    let model = wall(0.1, 1.0, -1.02);
    let orbit = free(&model, 20.0);
    let cases = [
        ("offset", [-1.05, -0.95], -1.0, true),
        ("cam.amplitudes[0]", [0.9, 1.1], 1.02, true),
        ("rest_position", [-0.1, 0.1], -0.02, false),
        ("gravity", [0.0, 0.1], 0.02, true),
    ];
    for (name, range, at, larger) in cases {
        let branch = follow(&model, 20.0, &orbit, name, range);
        let (point, first) = graze(&branch);
        assert!(branch.holds(0.5 * (point.value + range[usize::from(!larger)]), &orbit), "{name}");
        assert!((point.value - at).abs() < 1e-12 && first.larger == larger, "{name}: {} {first:?}", point.value);
        let special = point.special.unwrap();
        assert!(matches!(special.kind, SpecialKind::Graze { before: 0, after: 1, turned: 0.0, .. }), "{special:?}");
        assert!(special.residual < 1e-15 && special.bracket[1] - special.bracket[0] < 1e-15, "{special:?}");
        let (mut clear, mut struck) = (0, 0);
        let is_off = |point: &&BranchPoint| point.special.is_none() && (point.value - at).abs() > 1e-12;
        for other in branch.points.iter().filter(is_off) {
            let is_beyond = (other.value > at) == larger;
            match &other.orbit.course {
                // e^{-b T/2m} in a revolution.
                Course::Free => {
                    assert!(!is_beyond, "{name} = {}", other.value);
                    let modulus = other.orbit.multipliers()[0].modulus();
                    assert!((modulus - (-0.05 * 60.0 / 20.0_f64).exp()).abs() < 1e-12 && other.orbit.is_stable());
                    clear += 1;
                }
                _ => struck += usize::from(other.orbit.impacts().count() == 1 && !other.orbit.is_stable()),
            }
        }
        assert!(clear > 3 && struck > 3, "{name}: {clear} {struck} {:?}", branch.ends);
    }
}

/// What is beyond the graze is on one branch with what is before it, from whichever side it is followed.
#[test]
fn a_branch_that_loses_its_only_impact_goes_on_at_rest() {
    let model = wall(0.1, 1.0, -1.02);
    let there = follow(&model, 20.0, &free(&model, 20.0), "offset", [-1.05, -0.95]);
    let struck =
        there.points.iter().find(|point| point.special.is_none() && point.orbit.impacts().count() == 1).unwrap();
    let other = wall(0.1, 1.0, struck.value);
    let back = follow(&other, 20.0, &struck.orbit, "offset", [-1.05, -0.95]);
    let (point, first) = graze(&back);
    assert!((point.value + 1.0).abs() < 1e-9 && point.orbit.course == Course::Free, "{point:?}");
    assert_eq!((first.class, first.larger), (GrazeClass::Jump, true));
    let last = [&back.points[0], &back.points[back.points.len() - 1]].map(|point| &point.orbit.course);
    assert!(last.contains(&&Course::Free) && back.ends.contains(&End::Range), "{:?}", back.ends);
}

/// The equilibrium and the cam's top are the same at every speed.
#[test]
fn no_speed_makes_the_cam_touch_a_follower_at_rest() {
    let model = wall(0.1, 1.0, -1.02);
    let branch = follow(&model, 20.0, &free(&model, 20.0), "rpm", [10.0, 30.0]);
    assert_eq!(branch.ends, [End::Clear, End::Clear]);
    assert!(branch.points.len() > 20 && branch.points.iter().all(|point| point.special.is_none()));
}

/// lambda of a follower with real rates: e^{-slow T} with slow = (b - sqrt(b^2 - 4 k))/2.
fn rpm_of(damping: f64, lambda: f64) -> f64 {
    let slow = 0.5 * (damping - (damping * damping - 4.0).sqrt());
    60.0 * slow / -lambda.ln()
}

#[test]
#[ignore = "slow"]
fn the_class_of_a_graze_goes_by_the_eigenvalue() {
    for damping in [2.0, 3.0] {
        for (lambda, class) in [
            (0.01, GrazeClass::PeriodAdding),
            (0.2499, GrazeClass::PeriodAdding),
            (0.2501, GrazeClass::PeriodAddingChaos),
            (0.6666, GrazeClass::PeriodAddingChaos),
            (0.6667, GrazeClass::Chaos),
            (0.99, GrazeClass::Chaos),
        ] {
            let first = touch(&wall(damping, 1.0, -1.01), rpm_of(damping, lambda));
            assert_eq!((first.class, first.back, first.doubt), (class, None, None), "{damping} {lambda}");
        }
        for lambda in [0.25, 2.0 / 3.0] {
            let first = touch(&wall(damping, 1.0, -1.01), rpm_of(damping, lambda));
            assert_eq!(first.doubt, Some(Doubt::Boundary), "{damping} {lambda}");
        }
    }
    // One that oscillates: the first n with s(n T) < 0 by trial, and the depth at which the root gives back what it is given.
    for (damping, rpm) in [(0.1, 20.0), (0.1, 16.0), (0.0, 8.0), (0.5, 50.0), (1.0, 7.0), (0.1, 200.0)] {
        let oscillation = f64::sqrt(1.0 - 0.25 * damping * damping);
        let time = 60.0 / rpm;
        let response =
            |n: u64| (-0.5 * damping * n as f64 * time).exp() * (oscillation * n as f64 * time).sin() / oscillation;
        let passages = (1..).find(|n| response(*n) < 0.0).unwrap();
        let omega = angular_velocity(rpm);
        let depth = (1.8 * response(passages)).powi(2) * 2.0 * omega * omega;
        let first = touch(&wall(damping, 1.0, -1.01), rpm);
        let (found, deep) = first.back.unwrap();
        assert_eq!((first.class, found), (GrazeClass::Jump, passages), "{damping} {rpm}");
        assert!((deep - depth).abs() < 1e-9 * depth, "{deep} {depth}");
    }
}

#[test]
fn a_class_that_is_not_known_has_its_reason() {
    let two = "law = \"harmonic\"\noffset = -1.01\namplitudes = [0.0, 1.0]\nphases_deg = [0.0, 0.0]";
    let sharp = "law = \"rectified-sine\"\noffset = -0.01\namplitude = -1.0";
    let dwell = |segments: &str| format!("law = \"program\"\nbase = -1.01\n{segments}");
    let segment = |motion: &str, span: f64, rise: f64| {
        format!("[[cam.segment]]\nmotion = \"{motion}\"\nspan_deg = {span:?}\nrise = {rise:?}\n")
    };
    let flat = [segment("harmonic", 90.0, 1.0), segment("dwell", 90.0, 0.0), segment("harmonic", 180.0, -1.0)].concat();
    let uneven = [
        segment("harmonic", 60.0, 1.0),
        segment("harmonic", 60.0, -1.0),
        segment("harmonic", 120.0, 1.0),
        segment("harmonic", 120.0, -1.0),
    ]
    .concat();
    let resonant = 60.0 * (1.0 - 0.0025_f64).sqrt() / PI;
    let cases = [
        (on_cam(0.1, 1.0, sharp), "offset", 20.0, Doubt::Sharp),
        (on_cam(0.1, 1.0, &dwell(&flat)), "base", 20.0, Doubt::Flat),
        (on_cam(0.1, 1.0, &dwell(&uneven)), "base", 20.0, Doubt::Places),
        (wall(0.1, 1.0, -1.01), "offset", resonant, Doubt::Resonance),
    ];
    for (model, name, rpm, doubt) in cases {
        let own = model.numbers().find(|(path, _)| path.ends_with(name)).unwrap().1;
        let branch = follow(&model, rpm, &free(&model, rpm), name, [own, own + 0.02]);
        let (point, first) = graze(&branch);
        assert!((point.value - own - 0.01).abs() < 1e-12, "{name}: {}", point.value);
        assert_eq!((first.class, first.doubt), (GrazeClass::Undecided, Some(doubt)));
    }
    // Two tops that are alike are a cam of one top that turns twice as fast.
    let model = on_cam(3.0, 1.0, two);
    for (lambda, class) in [(0.24, GrazeClass::PeriodAdding), (0.26, GrazeClass::PeriodAddingChaos)] {
        let rpm = 0.5 * rpm_of(3.0, lambda);
        let branch = follow(&model, rpm, &free(&model, rpm), "offset", [-1.02, -0.98]);
        let (point, first) = graze(&branch);
        assert_eq!(first.class, class);
        assert!(matches!(point.special.unwrap().kind, SpecialKind::Graze { after: 2, .. }));
        assert!(branch.points.iter().any(|point| point.orbit.impacts().count() == 2), "{:?}", branch.ends);
    }
}

/// What a follower comes to that rests at 0 while the wall comes up `far` beyond the graze.
fn beyond(damping: f64, rpm: f64, far: f64) -> LongRun {
    let machine = machine(&wall(damping, 1.0, -1.0 + far), rpm);
    let budget = Budget { transient: 2000, record: 1600, longest: 30, patience: 0 };
    // From the wall, as a follower at rest meets it.
    let angle = TAU - (2.0 * far).sqrt();
    let motion = machine.start_on_cam(angle, 0.8 * angular_velocity(rpm) * (2.0 * far).sqrt()).unwrap();
    long_run(&machine, motion, budget).unwrap().ending
}

/// How far it is from the wall's top at most, once it has been near it for so many revolutions.
fn strays(damping: f64, rpm: f64, far: f64, revolutions: u64) -> f64 {
    let machine = machine(&wall(damping, 1.0, -1.0 + far), rpm);
    let mut motion = machine.start_on_cam(0.0, 0.0).unwrap();
    machine.revolve(&mut motion, revolutions).unwrap();
    let mut most = 0.0_f64;
    for _ in 0..50 {
        machine.revolve(&mut motion, 1).unwrap();
        most = most.max(motion.state.position.abs()).max(motion.state.velocity.abs());
    }
    most
}

/// However near the graze is: a jump goes as far from any distance, and what stays nearby shrinks with its root.
#[test]
fn motions_stay_near_a_graze_or_jump_as_its_class_says() {
    let far = [1e-4, 1e-6, 1e-8];
    for rpm in [20.0, 16.0, 11.0] {
        assert_eq!(touch(&wall(0.1, 1.0, -1.01), rpm).class, GrazeClass::Jump);
        let strays = far.map(|far| strays(0.1, rpm, far, 300));
        assert!(strays.iter().all(|most| *most > 0.05), "{rpm}: {strays:?}");
    }
    for lambda in [0.15, 0.5, 0.9] {
        let rpm = rpm_of(3.0, lambda);
        assert_ne!(touch(&wall(3.0, 1.0, -1.01), rpm).class, GrazeClass::Jump);
        // An impact leaves no more than (1 + r) sqrt(2 a far) above the follower's own velocity.
        let most = 1.8 * 2.0_f64.sqrt() * angular_velocity(rpm);
        let part = far.map(|far| strays(3.0, rpm, far, 300) / far.sqrt() / most);
        assert!(part.iter().all(|part| *part < 2.0), "{lambda}: {part:?}");
    }
}

/// One impact in n revolutions is stable at the distances from 3/4 (z_n)^2 to (1 - lambda) (z_{n-1})^2 beyond the graze, z_n = (1 + r) sqrt(2 a)
/// s(n T): below lambda = 1/4 always with the next, up to 2/3 with chaos between.
#[test]
fn the_orbits_beyond_a_graze_are_where_its_class_has_them() {
    let size = |lambda: f64, n: i32| {
        let (rpm, root) = (rpm_of(3.0, lambda), 5.0_f64.sqrt());
        let time = f64::from(n) * 60.0 / rpm;
        let response = ((-0.5 * (3.0 - root) * time).exp() - (-0.5 * (3.0 + root) * time).exp()) / root;
        (1.8 * response * angular_velocity(rpm)).powi(2) * 2.0
    };
    let period = |ending: &LongRun| match ending {
        LongRun::Orbit(orbit) if orbit.impacts().count() == 1 => Some(orbit.revolutions),
        _ => None,
    };
    for n in [5, 6] {
        let lambda = 0.15;
        let [low, high] = [0.75 * size(lambda, n), (1.0 - lambda) * size(lambda, n - 1)];
        for part in [0.05, 0.5, 0.9] {
            let far = low * (high / low).powf(part);
            let found = beyond(3.0, rpm_of(3.0, lambda), far);
            assert!(
                period(&found).is_some_and(|period| (n as u64..=n as u64 + 1).contains(&period)),
                "{n} {part}: {found:?}"
            );
        }
    }
    for n in [7, 8] {
        let lambda = 0.45;
        let [low, high] = [0.75 * size(lambda, n), (1.0 - lambda) * size(lambda, n - 1)];
        let found = beyond(3.0, rpm_of(3.0, lambda), (low * high).sqrt());
        assert_eq!(period(&found), Some(n as u64), "{found:?}");
        let above = (high * 0.75 * size(lambda, n - 1)).sqrt();
        let found = beyond(3.0, rpm_of(3.0, lambda), above);
        assert!(found.of_growth().is_some_and(|it| it.growth.value > 3.0 * it.growth.error), "{found:?}");
    }
    for far in [1e-3, 3e-4, 1e-4] {
        let found = beyond(3.0, rpm_of(3.0, 0.75), far);
        assert!(found.of_growth().is_some_and(|it| it.growth.value > 3.0 * it.growth.error), "{far}: {found:?}");
    }
}

/// The graze is at one value at every speed, and its class changes where the eigenvalue or the resonance has it.
#[test]
#[ignore = "slow"]
fn the_curve_of_a_graze_of_a_follower_at_rest_is_straight() {
    let found = |model: &Model, rpm: [f64; 2]| {
        let parameter = Parameter::named(model, "offset").unwrap();
        let following = Following { parameter, range: [-1.05, -0.95], longest_step: 0.1, most_points: 100 };
        let wanted = Search { revolutions: 1, impacts: Some(0) };
        let mut found = curves(model, rpm, &wanted, &[Bifurcation::Graze], &following, &Unwatched).unwrap().curves;
        assert_eq!(found.len(), 1);
        let curve = found.remove(0);
        for point in &curve.points {
            assert!((point.value + 1.0).abs() < 1e-15 && point.impacts == 0 && point.cam_angle == 0.0, "{point:?}");
        }
        assert_eq!([curve.points[0].rpm, curve.points[curve.points.len() - 1].rpm], rpm);
        curve
    };
    let curve = found(&wall(3.0, 1.0, -1.02), [10.0, 80.0]);
    let specials: Vec<(f64, SpecialKind)> =
        curve.points.iter().filter_map(|it| Some((it.rpm, it.special?.kind))).collect();
    let [
        (one, SpecialKind::Class(UndecidedGraze::Eigenvalue(quarter))),
        (two, SpecialKind::Class(UndecidedGraze::Eigenvalue(thirds))),
    ] = specials[..]
    else {
        panic!("{specials:?}")
    };
    assert_eq!([quarter, thirds], [0.25, 2.0 / 3.0]);
    assert!((one - rpm_of(3.0, 0.25)).abs() < 1e-9 && (two - rpm_of(3.0, 2.0 / 3.0)).abs() < 1e-9, "{specials:?}");
    let curve = found(&wall(0.1, 1.0, -1.02), [7.0, 130.0]);
    let oscillation = (1.0 - 0.0025_f64).sqrt();
    let angle = |rpm: f64| oscillation * 60.0 / rpm / PI;
    let specials: Vec<(f64, u64)> = curve
        .points
        .iter()
        .filter_map(|point| match point.special?.kind {
            SpecialKind::Class(UndecidedGraze::Resonance(passages)) => Some((angle(point.rpm), passages)),
            _ => None,
        })
        .collect();
    let halves = [(2.5, 2), (7.0 / 3.0, 3), (2.25, 4), (2.0, 1), (1.0, 1), (0.5, 2), (1.0 / 3.0, 3), (0.25, 4)];
    assert_eq!(specials.len(), halves.len(), "{specials:?}");
    for (found, wanted) in specials.iter().zip(halves) {
        assert!((found.0 - wanted.0).abs() < 1e-12 && found.1 == wanted.1, "{specials:?}");
    }
}

/// A program of motions, each with its span, degrees, and rise, m, from a base below the follower.
fn program(base: f64, motions: &[(&str, f64, f64)]) -> String {
    let motion = |(motion, span, rise): &(&str, f64, f64)| {
        format!("[[cam.segment]]\nmotion = \"{motion}\"\nspan_deg = {span:?}\nrise = {rise:?}\n")
    };
    format!("law = \"program\"\nbase = {base:?}\n{}", motions.iter().map(motion).collect::<String>())
}

/// `c = offset + sum a_k cos(k theta)`.
fn cosines(offset: f64, amplitudes: &[f64]) -> String {
    let phases = vec![0.0; amplitudes.len()];
    format!("law = \"harmonic\"\noffset = {offset:?}\namplitudes = {amplitudes:?}\nphases_deg = {phases:?}")
}

/// The touch where this number of the cam is 0.01 m, times the size, larger.
fn touched(model: &Model, rpm: f64, name: &str, size: f64) -> FirstTouch {
    let own = model.numbers().find(|(path, _)| path.ends_with(name)).unwrap().1;
    let parameter = Parameter::named(model, name).unwrap();
    // In one step over the graze, and a few beyond.
    let following = Following { parameter, range: [own, own + 0.011 * size], longest_step: 1.0, most_points: 3 };
    let branch = Branch::through(model, rpm, &free(model, rpm), &following).unwrap();
    let (point, first) = graze(&branch);
    assert!((point.value - own - 0.01 * size).abs() < 1e-12, "{name}: {}", point.value);
    first
}

/// `(1 + r)^2 2 a s(n T)^2` with a follower of mass 1 and stiffness 1, damping 0.1, where the top has this second derivative, m/rad^2, so many
/// times in a revolution.
fn depth_of(rpm: f64, bend: f64, tops: u64) -> (u64, f64) {
    let oscillation = f64::sqrt(1.0 - 0.0025);
    let response = |n: u64| {
        let time = n as f64 * 60.0 / rpm / tops as f64;
        (-0.05 * time).exp() * (oscillation * time).sin() / oscillation
    };
    let passages = (1..).find(|n| response(*n) < 0.0).unwrap();
    (passages, (1.8 * response(passages)).powi(2) * 2.0 * bend * angular_velocity(rpm).powi(2))
}

/// The follower meets the cam before its top: of two second derivatives there that of the rise counts, wherever angle 0 is.
#[test]
fn the_depth_of_a_jump_goes_by_the_rise_to_the_top() {
    let (rise, fall) = (("harmonic", 90.0, 1.0), ("harmonic", 270.0, -1.0));
    let dwell = ("dwell", 60.0, 0.0);
    let cams: [(String, f64); 4] = [
        (program(-1.01, &[rise, fall]), 90.0),
        (program(-0.01, &[fall, rise]), 90.0),
        (program(-1.01, &[dwell, rise, ("harmonic", 210.0, -1.0)]), 90.0),
        (program(-1.01, &[("harmonic", 120.0, 1.0), ("harmonic", 240.0, -1.0)]), 120.0),
    ];
    for (index, (cam, span)) in cams.iter().enumerate() {
        for rpm in [20.0, 50.0] {
            let first = touched(&on_cam(0.1, 1.0, cam), rpm, "base", 1.0);
            let (passages, deep) = first.back.unwrap();
            let wanted = depth_of(rpm, 0.5 * (180.0 / span).powi(2), 1);
            assert!(passages == wanted.0 && (deep / wanted.1 - 1.0).abs() < 1e-6, "{index}: {deep} {wanted:?}");
        }
    }
}

/// `cos - b cos 2` falls away from 0 as a fourth power at b = 1/4, and as a parabola below.
#[test]
fn a_top_is_flat_where_its_second_derivative_is_0() {
    for size in [1.0, 1e-3, 50.0] {
        let model = |part: f64| {
            let top = size * (1.0 - part);
            on_cam(0.1, 1.0, &cosines(-top - 0.01 * size, &[size, -size * part]))
        };
        let first = touched(&model(0.25), 20.0, "offset", size);
        assert_eq!((first.class, first.doubt), (GrazeClass::Undecided, Some(Doubt::Flat)), "{size}");
        let first = touched(&model(0.2499), 20.0, "offset", size);
        let (passages, deep) = first.back.unwrap();
        let wanted = depth_of(20.0, size * (1.0 - 4.0 * 0.2499), 1);
        assert!(passages == wanted.0 && (deep / wanted.1 - 1.0).abs() < 1e-6, "{size}: {deep} {wanted:?}");
    }
}

/// Three tops that are alike and as far from each other are a cam of one that turns three times as fast; not so where the one or the other fails.
#[test]
fn tops_count_as_one_where_they_are_alike_and_evenly_apart() {
    let (up, down) = (("harmonic", 60.0, 1.0), ("harmonic", 60.0, -1.0));
    let waves = program(-1.01, &[up, down, up, down, up, down]);
    let three = on_cam(0.1, 1.0, &waves);
    for rpm in [7.0, 20.0] {
        let first = touched(&three, rpm, "base", 1.0);
        let (passages, deep) = first.back.unwrap_or_else(|| panic!("{rpm}: {first:?}"));
        let wanted = depth_of(rpm, 4.5, 3);
        assert!(passages == wanted.0 && (deep / wanted.1 - 1.0).abs() < 1e-9, "{rpm}: {passages} {deep} {wanted:?}");
    }
    let three = on_cam(3.0, 1.0, &waves);
    for (lambda, class) in [(0.24, GrazeClass::PeriodAdding), (0.26, GrazeClass::PeriodAddingChaos)] {
        assert_eq!(touched(&three, rpm_of(3.0, lambda) / 3.0, "base", 1.0).class, class, "{lambda}");
    }
    let dwell = |span: f64| ("dwell", span, 0.0);
    let uneven = [up, down, dwell(30.0), up, down, dwell(90.0)];
    let unlike = [up, down, dwell(80.0), ("harmonic", 40.0, 1.0), down, dwell(60.0)];
    let alike = [up, down, dwell(60.0), up, down, dwell(60.0)];
    for (motions, doubt) in [(uneven, Some(Doubt::Places)), (unlike, Some(Doubt::Places)), (alike, None)] {
        let first = touched(&on_cam(0.1, 1.0, &program(-1.01, &motions)), 20.0, "base", 1.0);
        assert_eq!(first.doubt, doubt, "{motions:?}");
    }
}

/// At 2 pi j + pi/n of its oscillation the follower is back at its equilibrium after n passages, as far as the angle is known.
#[test]
#[ignore = "slow"]
fn a_follower_that_comes_back_to_its_equilibrium_is_in_resonance() {
    let oscillation = (1.0 - 0.0025_f64).sqrt();
    let doubt = |angle: f64| touched(&wall(0.1, 1.0, -1.01), oscillation * 60.0 / angle, "offset", 1.0).doubt;
    for turn in [0.0, 1.0, 3.0] {
        let part = [0.0, PI, PI / 2.0, PI / 3.0, PI / 5.0, TAU].map(|part| turn * TAU + part);
        for angle in part.into_iter().filter(|angle| *angle > 0.0) {
            for off in [0.0, 1e-11, -1e-11] {
                assert_eq!(doubt(angle * (1.0 + off)), Some(Doubt::Resonance), "{angle} {off}");
            }
            for off in [1.3e-6, -1.3e-6] {
                assert_eq!(doubt(angle * (1.0 + off)), None, "{angle} {off}");
            }
        }
    }
    // The error of an angle is a part of it.
    let angle = 200.0 * TAU + 1.0;
    assert_eq!(
        (doubt(angle), doubt(200.0 * TAU + PI + 1e-8), doubt(200.0 * TAU + 1e-8)),
        (None, Some(Doubt::Resonance), Some(Doubt::Resonance))
    );
    // One without damping turns with the cam to the last bit.
    for (stiffness, omega) in [(1.0, 1.0), (4.0, 2.0), (16.0, 4.0), (4.0, 1.0)] {
        let rpm = omega * 60.0 / TAU;
        assert_eq!(touched(&wall(0.0, stiffness, -1.01), rpm, "offset", 1.0).doubt, Some(Doubt::Resonance));
    }
}

/// Without a spring or gravity a follower stays where it is, and nothing returns it.
#[test]
fn nothing_holds_a_follower_without_a_spring() {
    for damping in [0.1, 3.0] {
        let model = wall(damping, 0.0, -1.02);
        let orbit = free(&wall(damping, 1.0, -1.02), 20.0);
        let branch = follow(&model, 20.0, &orbit, "offset", [-1.05, -0.95]);
        let (point, first) = graze(&branch);
        assert!((point.value + 1.0).abs() < 1e-12);
        assert_eq!((first.class, first.back, first.doubt), (GrazeClass::Undecided, None, Some(Doubt::Unheld)));
        assert_eq!(branch.ends, [End::Range, End::Graze]);
    }
}

/// A part of the range after the other to its ends, or as many as were asked for.
#[test]
fn orbits_at_rest_are_told_as_far_apart_as_was_asked_for() {
    let model = wall(0.1, 1.0, -1.02);
    let orbit = free(&model, 20.0);
    for (name, [low, high], step, ends) in [
        ("offset", [-1.1, -1.005], 0.05, [End::Range, End::Range]),
        ("rpm", [12.0, 25.0], 0.03, [End::Clear, End::Clear]),
        ("rest_position", [-0.01, 0.3], 0.01, [End::Range, End::Range]),
    ] {
        let parameter = Parameter::named(&model, name).unwrap();
        let own = parameter.value(&model, 20.0).unwrap();
        let mut following = Following { parameter, range: [low, high], longest_step: step, most_points: 100 };
        let found = Branch::through(&model, 20.0, &orbit, &following).unwrap();
        assert_eq!(found.ends, ends, "{name}");
        let values: Vec<f64> = found.points.iter().map(|point| point.value).collect();
        assert!(found.points.iter().all(|it| it.special.is_none() && it.orbit.course == Course::Free));
        assert_eq!([values[0], values[values.len() - 1]], [low, high], "{name}");
        let longest = step * (high - low);
        let steps = |span: f64| (span / longest - 1e-9).ceil() as usize;
        assert_eq!(values.len(), 1 + steps(own - low) + steps(high - own), "{name}");
        let apart: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let inner = &apart[1..apart.len() - 1];
        assert!(inner.iter().all(|apart| (apart / longest - 1.0).abs() < 1e-9), "{name}: {apart:?}");
        following.most_points = 3;
        let found = Branch::through(&model, 20.0, &orbit, &following).unwrap();
        assert_eq!((found.points.len(), found.ends), (7, [End::MostPoints, End::MostPoints]), "{name}");
    }
}

/// No speed is 0, and without a spring gravity takes the follower away.
#[test]
fn orbits_at_rest_end_where_there_are_none() {
    let model = wall(0.1, 1.0, -1.02);
    let branch = follow(&model, 20.0, &free(&model, 20.0), "rpm", [0.0, 30.0]);
    let [End::Edge { largest: false, .. }, End::Clear] = branch.ends else { panic!("{:?}", branch.ends) };
    assert!(branch.points[0].value > 0.0 && branch.points[0].value < 1e-6, "{:?}", branch.points[0]);
    // Gravity that lifts it.
    let lifted = model.with_number("follower.gravity", -1.0).unwrap();
    let orbit = free(&lifted, 20.0);
    assert!((orbit.state.position - 1.0).abs() < 1e-12);
    let branch = follow(&lifted, 20.0, &orbit, "stiffness", [0.0, 1.5]);
    assert_eq!(branch.ends, [End::Falls, End::Range]);
    for point in &branch.points {
        assert!((point.orbit.state.position * point.value - 1.0).abs() < 1e-9, "{point:?}");
    }
}

/// Of the borders between classes those of the range are told, and no other.
#[test]
#[ignore = "slow"]
fn the_curve_of_a_graze_has_the_borders_between_its_speeds() {
    let found = |model: &Model, rpm: [f64; 2]| -> Vec<(f64, UndecidedGraze)> {
        let parameter = Parameter::named(model, "offset").unwrap();
        let following = Following { parameter, range: [-1.03, -0.95], longest_step: 0.5, most_points: 100 };
        let wanted = Search { revolutions: 1, impacts: Some(0) };
        let mut found = curves(model, rpm, &wanted, &[Bifurcation::Graze], &following, &Unwatched).unwrap().curves;
        assert_eq!(found.len(), 1);
        let points = found.remove(0).points;
        let regular: Vec<f64> = points.iter().filter(|point| point.special.is_none()).map(|point| point.rpm).collect();
        let wanted = [rpm[0], 0.5 * (rpm[0] + rpm[1]), rpm[1]];
        assert!(regular.len() == 3 && regular.iter().zip(wanted).all(|(one, other)| (one / other - 1.0).abs() < 1e-12));
        let border =
            |kind: SpecialKind| if let SpecialKind::Class(border) = kind { border } else { panic!("{kind:?}") };
        points.iter().filter_map(|point| Some((point.rpm, border(point.special?.kind)))).collect()
    };
    let [quarter, thirds] = [0.25, 2.0 / 3.0].map(|lambda| (rpm_of(3.0, lambda), UndecidedGraze::Eigenvalue(lambda)));
    let model = wall(3.0, 1.0, -1.02);
    for (rpm, wanted) in [
        ([0.9 * quarter.0, 1.1 * quarter.0], vec![quarter]),
        ([0.9 * thirds.0, 1.1 * thirds.0], vec![thirds]),
        ([1.01 * quarter.0, 0.99 * thirds.0], vec![]),
        ([0.5 * quarter.0, 2.0 * thirds.0], vec![quarter, thirds]),
    ] {
        let found = found(&model, rpm);
        assert_eq!(found.len(), wanted.len(), "{rpm:?}: {found:?}");
        for (one, other) in found.iter().zip(wanted) {
            assert!((one.0 / other.0 - 1.0).abs() < 1e-12 && one.1 == other.1, "{rpm:?}: {found:?}");
        }
    }
    let oscillation = (1.0 - 0.0025_f64).sqrt();
    let at = |halves: f64| oscillation * 60.0 / (halves * PI);
    let model = wall(0.1, 1.0, -1.02);
    for (halves, wanted) in [
        ([2.6, 2.1], vec![(2.5, 2), (7.0 / 3.0, 3), (2.25, 4)]),
        ([2.4, 2.3], vec![(7.0 / 3.0, 3)]),
        ([4.6, 4.4], vec![(4.5, 2)]),
        ([4.1, 1.9], vec![(4.0, 1), (3.0, 1), (2.5, 2), (7.0 / 3.0, 3), (2.25, 4), (2.0, 1)]),
        ([0.9, 0.6], vec![]),
    ] {
        let found = found(&model, halves.map(at));
        assert_eq!(found.len(), wanted.len(), "{halves:?}: {found:?}");
        for (one, (halves, passages)) in found.iter().zip(wanted) {
            assert!(
                (one.0 / at(halves) - 1.0).abs() < 1e-12 && one.1 == UndecidedGraze::Resonance(passages),
                "{found:?}"
            );
        }
    }
}

/// The curves of the touches of a follower at rest, over a range of a number and of speeds, rpm.
fn touches(model: &Model, name: &str, range: [f64; 2], rpm: [f64; 2]) -> Curves {
    let following =
        Following { parameter: Parameter::named(model, name).unwrap(), range, longest_step: 0.1, most_points: 100 };
    let wanted = Search { revolutions: 1, impacts: Some(0) };
    curves(model, rpm, &wanted, &[Bifurcation::Graze], &following, &Unwatched).unwrap()
}

/// A cam with k equal tops passes k times as often, so its borders are at a k-th of the speed. A slower follower has them at speeds that are lower
/// by the same factor.
#[test]
#[ignore = "slow"]
fn the_borders_of_a_graze_go_by_passages_and_by_the_followers_time() {
    let at = |halves: f64| (1.0 - 0.0025_f64).sqrt() * 60.0 / (halves * PI);
    for (tops, slower) in [(1, 100.0), (3, 1.0), (2, 0.01)] {
        let mut amplitudes = vec![0.0; tops];
        amplitudes[tops - 1] = 1.0;
        let own = |rpm: f64| rpm / slower / tops as f64;
        let found = |damping: f64, rpm: [f64; 2]| -> Vec<(f64, UndecidedGraze)> {
            let model = on_cam(damping / slower, slower.powi(-2), &cosines(-1.02, &amplitudes));
            let [curve] = &touches(&model, "offset", [-1.03, -0.95], rpm.map(own)).curves[..] else { panic!("{tops}") };
            let border =
                |kind: SpecialKind| if let SpecialKind::Class(border) = kind { border } else { panic!("{kind:?}") };
            curve.points.iter().filter_map(|point| Some((point.rpm, border(point.special?.kind)))).collect()
        };
        let oscillating =
            [(2.5, 2), (7.0 / 3.0, 3), (2.25, 4)].map(|(halves, n)| (at(halves), UndecidedGraze::Resonance(n)));
        let real = [0.25, 2.0 / 3.0].map(|lambda| (rpm_of(3.0, lambda), UndecidedGraze::Eigenvalue(lambda)));
        for (found, wanted) in
            [(found(0.1, [2.6, 2.1].map(at)), &oscillating[..]), (found(3.0, [10.0, 80.0]), &real[..])]
        {
            assert_eq!(found.len(), wanted.len(), "{tops} {slower}: {found:?}");
            for (one, other) in found.iter().zip(wanted) {
                assert!((one.0 / own(other.0) - 1.0).abs() < 1e-12 && one.1 == other.1, "{tops} {slower}: {found:?}");
            }
        }
    }
}

/// Where the wall reaches the follower on both sides of a range there are two touches, and none where it does on no side or where nothing holds
/// the follower.
#[test]
#[ignore = "slow"]
fn each_touch_in_a_range_has_a_curve_and_no_other() {
    let model = wall(0.1, 1.0, -1.02);
    for (name, range, wanted) in [
        ("offset", [-1.05, -0.95], vec![(-1.0, true)]),
        ("rest_position", [-0.05, 0.05], vec![(-0.02, false)]),
        ("cam.amplitudes[0]", [-1.1, 1.1], vec![(-1.02, false), (1.02, true)]),
        ("offset", [-1.2, -1.1], vec![]),
    ] {
        let found: Vec<(f64, bool)> = touches(&model, name, range, [20.0, 22.0])
            .curves
            .iter()
            .map(|curve| match curve.kind {
                SpecialKind::Graze { first: Some(first), .. } => (curve.points[0].value, first.larger),
                kind => panic!("{kind:?}"),
            })
            .collect();
        assert_eq!(found.len(), wanted.len(), "{name}: {found:?}");
        for (one, other) in found.iter().zip(wanted) {
            assert!((one.0 - other.0).abs() < 1e-15 && one.1 == other.1, "{name}: {found:?}");
        }
    }
    assert_eq!(touches(&wall(0.1, 0.0, -1.02), "offset", [-0.05, 0.95], [20.0, 22.0]).curves.len(), 0);
}

/// A follower that loses its only impact is at rest until the wall reaches it from the other side, in any unit of length.
#[test]
fn a_branch_goes_on_at_rest_from_one_touch_to_the_other() {
    for size in [1.0, 2.0_f64.powi(-13), 2.0_f64.powi(20)] {
        let model = |amplitude: f64| on_cam(0.1, 1.0, &cosines(-size, &[amplitude]));
        let name = "cam.amplitudes[0]";
        let range = [-1.1 * size, 1.1 * size];
        let there = follow(&model(0.99 * size), 20.0, &free(&model(0.99 * size), 20.0), name, range);
        let is_struck = |point: &&BranchPoint| point.value > 1.01 * size && point.orbit.impacts().count() == 1;
        let struck = there.points.iter().find(is_struck).unwrap();
        let back = follow(&model(struck.value), 20.0, &struck.orbit, name, range);
        let grazes: Vec<(f64, bool)> = back
            .points
            .iter()
            .filter_map(|point| match point.special?.kind {
                SpecialKind::Graze { first: Some(first), .. } => Some((point.value / size, first.larger)),
                _ => None,
            })
            .collect();
        let [(one, false), (other, true)] = grazes[..] else { panic!("{size}: {grazes:?} {:?}", back.ends) };
        assert!((one + 1.0).abs() < 1e-9 && (other - 1.0).abs() < 1e-9, "{size}: {grazes:?}");
        let at_rest = back.points.iter().filter(|point| point.orbit.course == Course::Free);
        assert!(at_rest.clone().count() > 15 && at_rest.clone().all(|point| point.value.abs() < size * (1.0 + 1e-9)));
    }
}

/// Without damping and in resonance with the cam a follower swings from touch to touch, and is not at rest: a branch of one impact ends there.
#[test]
fn a_follower_that_swings_from_touch_to_touch_is_not_at_rest() {
    let model = wall(0.0, 1.0, -1.5);
    let found = search(&machine(&model, 12.0), &Search { revolutions: 1, impacts: Some(1) }).unwrap();
    assert!(!found.is_empty());
    for orbit in found {
        let branch = follow(&model, 12.0, &orbit, "rpm", [9.0, 13.0]);
        let ends = |at: &BranchPoint| (at.value / (60.0 / TAU) - 1.0).abs() < 1e-4;
        assert!(branch.points.first().is_some_and(ends) && branch.ends[0] == End::Graze, "{:?}", branch.ends);
        assert!(branch.points.iter().all(|point| point.orbit.course != Course::Free), "{:?}", branch.ends);
    }
}

/// Two tops that are 150 degrees apart, the way round by 210, strike a follower without damping with impulses that are alike. It comes to the second
/// one rising, and to the first one falling, and meets that on the far side of its top: with a half swing of `p` rad in a revolution the cam's
/// velocity is `1/(1 + r) - 1/2 - sin(p/6)/(2 sin p)` of the impulse, and of the second with a plus.
#[test]
fn a_follower_may_meet_the_cam_behind_its_top() {
    let (up, down) = (("harmonic", 60.0, 1.0), ("harmonic", 90.0, -1.0));
    for dwell in [0.0_f64, 40.0] {
        // Angle 0 in the dwell, or at its end.
        let mut motions = vec![up, down, up, down, ("dwell", 60.0 - dwell, 0.0)];
        if dwell > 0.0 {
            motions.insert(0, ("dwell", dwell, 0.0));
        }
        let model = on_cam(1e-3, 1.0, &program(-1.01, &motions));
        let branch = follow(&model, 20.0, &free(&model, 20.0), "base", [-1.02, -0.98]);
        let struck: Vec<Vec<f64>> = branch
            .points
            .iter()
            .filter(|point| (1e-9..1e-3).contains(&(point.value + 1.0)))
            .map(|point| point.orbit.impacts().map(|impact| impact.cam_angle.to_degrees() - dwell).collect())
            .collect();
        assert!(struck.len() > 1, "{:?}", branch.ends);
        for angles in struck {
            assert!(angles.len() == 2 && angles[0] > 60.0 && angles[1] < 210.0, "{angles:?}");
        }
    }
}

/// `cos t cos 75 deg * 4 - cos 2t` has two tops as high, 150 degrees apart around 0. It is one segment, in which either impact moves.
#[test]
fn a_follower_may_meet_a_smooth_cam_behind_its_top() {
    let (top, bend) = (75.0_f64.to_radians(), 4.0 * 75.0_f64.to_radians().cos());
    let highest = bend * top.cos() - (2.0 * top).cos();
    let model = on_cam(1e-3, 1.0, &cosines(-0.01 - highest, &[bend, -1.0]));
    let branch = follow(&model, 20.0, &free(&model, 20.0), "offset", [-0.02 - highest, 0.02 - highest]);
    let near = |point: &&BranchPoint| (1e-9..1e-3).contains(&(point.value + highest));
    let struck: Vec<Vec<f64>> = branch
        .points
        .iter()
        .filter(near)
        .map(|point| point.orbit.impacts().map(|impact| impact.cam_angle.to_degrees()).collect())
        .collect();
    assert!(struck.len() > 1, "{:?}", branch.ends);
    for angles in struck {
        assert!(angles.len() == 2 && angles[0] < 75.0 && angles[1] > 285.0, "{angles:?}");
    }
}

/// A follower at rest is followed to where the cam ends, on either side of the range.
#[test]
fn orbits_at_rest_end_where_there_is_no_such_cam() {
    let own = crate::common::osorio().with_number("follower.rest_position", 10.0).unwrap();
    let model = own.with_number("follower.damping", 1.0).unwrap();
    let allowed = |name: &str| format!("cam.{name}_deg must be a finite number from 0 to 180");
    let ends =
        |name: &str, range: [f64; 2]| follow(&model, 300.0, &free(&model, 300.0), &format!("{name}_deg"), range).ends;
    let [_, high] = ends("nose_end", [112.0, 208.0]);
    assert_eq!(high, End::Edge { largest: true, why: allowed("nose_end") });
    let [low, _] = ends("flank_start", [-30.0, 70.0]);
    assert_eq!(low, End::Edge { largest: false, why: allowed("flank_start") });
}

/// Without a spring a follower without weight rests wherever it is: no value of the cam's offset is one at which it comes to be touched.
#[test]
fn a_follower_without_a_spring_has_no_curve_of_touches() {
    let found = touches(&wall(0.1, 0.0, -1.02), "offset", [-1.05, -0.95], [10.0, 80.0]);
    assert!(found.curves.is_empty(), "{found:?}");
}
