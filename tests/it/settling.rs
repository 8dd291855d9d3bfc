//! Do runs and searches come to the same in whatever unit, and however the cam sits on its shaft?

use std::f64::consts::TAU;

use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::cam::apart;
use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::orbit::branch::{Branch, BranchPoint, Following, SpecialKind};
use corner_impact::orbit::long_run::{Budget, LongRun};
use corner_impact::orbit::runs::{AfterRelease, LongRuns, RunOutcome};
use corner_impact::orbit::{Course, Parameter, PeriodicOrbit, Search, search, search_all};
use corner_impact::progress::Unwatched;
use corner_impact::simulate::{Machine, Motion};
use corner_impact::study::survey::long_run;

use crate::common;
use crate::orbit_numbers::{ending, is_as_it_was, machine, orbit};
use crate::random::{cases_of_every_law, drawn};
use crate::scales::in_units;

fn model(follower: &str, cam: &str) -> Model {
    Model::parse("machine.toml", &format!("[follower]\nmass = 1.0\n{follower}\n[cam]\n{cam}\n")).unwrap()
}

fn of_one_revolution(machine: &Machine) -> Vec<PeriodicOrbit> {
    search(machine, &Search { revolutions: 1, impacts: None }).unwrap()
}

/// An eccentric with a second lobe, turned on its shaft by so many degrees.
fn two_lobes(turned: f64) -> Model {
    let follower = "damping = 0.0\nstiffness = 400.0\ngravity = 9.81\nrest_position = 0.08\nrestitution = 0.3";
    let phases = [180.0 - turned, -2.0 * turned].map(|phase| phase.rem_euclid(360.0));
    let cam = format!("law = \"harmonic\"\noffset = 0.1\namplitudes = [0.002, 0.02]\nphases_deg = {phases:?}");
    model(follower, &cam)
}

/// It rests twice in a revolution, and longer behind one of the lobes: where angle 0 is in one of the rests, too.
#[test]
fn an_orbit_that_rests_is_told_by_the_middle_of_its_longest_rest() {
    let mut middles = Vec::new();
    for turned in [0.0, 20.0, 45.0, 70.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0_f64] {
        let orbits = of_one_revolution(&machine(&two_lobes(turned), 190.0));
        let [orbit] = &orbits[..] else { panic!("{turned}: {orbits:?}") };
        let Course::Sticking(middle) = orbit.course else { panic!("{turned}: {orbit:?}") };
        assert!(orbit.residual < 1e-12, "{turned}: {orbit:?}");
        middles.push(middle - turned.to_radians());
    }
    for middle in &middles {
        assert_abs_diff_eq!(apart(middle.rem_euclid(TAU), middles[0]), 0.0, epsilon = 1e-9);
    }
    // The rests of the cam that is not turned: 1.30889 to 2.78230 and 4.44852 to 5.92340.
    assert_abs_diff_eq!(middles[0], 0.5 * (4.448520428182 + 5.923399952748), epsilon = 1e-9);
}

/// An eccentric turned on its shaft by so many degrees, whose follower comes to rest on it for ever less as the speed grows.
fn eccentric(turned: f64) -> Model {
    let follower = "damping = 0.0\nstiffness = 400.0\ngravity = 9.81\nrest_position = 0.08\nrestitution = 0.6";
    let phases = [180.0 - turned, -2.0 * turned].map(|phase| phase.rem_euclid(360.0));
    let cam = format!("law = \"harmonic\"\noffset = 0.1\namplitudes = [0.02, 0.001]\nphases_deg = {phases:?}");
    model(follower, &cam)
}

/// Where the follower of an eccentric rests no more: the speed, how long it rests there, rad, and the middle of that.
fn onset_of_chattering(turned: f64) -> [f64; 3] {
    let model = eccentric(turned);
    let orbits = of_one_revolution(&machine(&model, 376.0));
    let orbit = orbits.iter().find(|orbit| matches!(orbit.course, Course::Sticking(_))).unwrap();
    let (range, parameter) = ([375.0, 385.0], Parameter::Speed);
    let following = Following { parameter, range, longest_step: 0.5, most_points: 400 };
    let branch = Branch::through(&model, 376.0, orbit, &following).unwrap();
    let ends = |point: &&BranchPoint| point.special.is_some_and(|special| special.kind == SpecialKind::Chatter);
    let end = branch.points.iter().find(ends).unwrap();
    let Course::Sticking(middle) = end.orbit.course else { panic!("{end:?}") };
    [end.rpm, end.special.unwrap().residual, middle]
}

#[test]
fn a_rest_that_ends_at_the_onset_of_chattering_may_be_anywhere_on_the_cam() {
    let [rpm, rest, middle] = onset_of_chattering(0.0);
    assert!((1e-9..1e-6).contains(&rest), "{rest}");
    for off in [-3.0, 0.0, 1e-6, 2e-6, 3.0] {
        let [same, rest, at] = onset_of_chattering(off - middle.to_degrees());
        assert_relative_eq!(same, rpm, max_relative = 1e-11);
        assert!((1e-9..1e-6).contains(&rest), "{off}: {rest}");
        assert_abs_diff_eq!(apart(at, off.to_radians().rem_euclid(TAU)), 0.0, epsilon = 1e-6);
    }
}

/// The cam is at its top at angle 0, where a follower that is put on it is thrown no higher, and oscillates above it for good.
#[test]
fn a_follower_without_damping_above_the_cam_has_an_orbit() {
    let cam = "law = \"harmonic\"\noffset = 0.1\namplitudes = [0.02]\nphases_deg = [0.0]";
    let follower = "damping = 0.0\nstiffness = 400.0\ngravity = 0.0\nrest_position = 0.12001\nrestitution = 0.6";
    let orbits = of_one_revolution(&machine(&model(follower, cam), 100.0));
    let free: Vec<_> = orbits.iter().filter(|orbit| orbit.course == Course::Free).collect();
    let [free] = free[..] else { panic!("{orbits:?}") };
    assert_eq!([free.state.position, free.state.velocity], [0.12001, 0.0]);
}

/// It repeats as nearly as anything that floats, revolution by revolution, and comes down all the same.
#[test]
fn a_follower_that_creeps_down_to_the_cam_over_thousands_of_revolutions_has_no_orbit_above_it() {
    let cam = "law = \"harmonic\"\noffset = 0.1\namplitudes = [0.02]\nphases_deg = [0.0]";
    for rest in [0.119, 0.11] {
        let follower =
            format!("damping = 1000.0\nstiffness = 0.01\ngravity = 0.0\nrest_position = {rest}\nrestitution = 0.6");
        let orbits = of_one_revolution(&machine(&model(&follower, cam), 6000.0));
        assert!(orbits.iter().all(|orbit| orbit.course != Course::Free), "{orbits:?}");
    }
}

/// The paper's machine, whose spring has no unit of length, with all its lengths times a power of two, which doubles hold exactly.
pub fn enlarged(power: i32) -> Model {
    let lengths = [("rest_position", 0.3), ("base_radius", 0.4), ("flank_radius", 0.85), ("nose_radius", 0.15)];
    let lengths = lengths.map(|(name, length)| (name, format!("{:?}", length * 2.0_f64.powi(power))));
    common::osorio_with(&lengths.each_ref().map(|(name, length)| (*name, length.as_str())))
}

#[test]
fn runs_of_a_machine_of_any_size_come_to_the_same_after_as_many_revolutions() {
    for (rpm, revolutions) in [(700.0, 60), (442.0, 60), (736.0, 120), (760.0, 120)] {
        let told = [0, -12, 12].map(|power| {
            let machine = machine(&enlarged(power), rpm);
            let unaided = LongRuns::unaided(&machine, Budget { transient: 1000, record: 0, longest: 4, patience: 0 });
            [unaided, LongRuns::new(&machine, Budget { longest: 4, ..Budget::SURVEY }).unwrap()].map(|settling| {
                let mut motion = machine.start_on_cam(1.0, 2.0_f64.powi(power)).unwrap();
                let run = settling.run(&mut motion, revolutions).unwrap();
                let come_to = match run {
                    RunOutcome::Arrives(orbit) => orbit.impacts().map(|impact| impact.cam_angle).collect(),
                    RunOutcome::Released(angle) => vec![-angle],
                    RunOutcome::PermanentContact | RunOutcome::Wanders => Vec::new(),
                };
                (come_to, motion.revolution)
            })
        });
        assert!(told[0] == told[1] && told[0] == told[2], "{rpm} rpm: {told:?}");
    }
}

#[test]
fn an_orbit_is_known_once_and_only_if_runs_come_to_it_without_rest() {
    let paper = common::osorio();
    for (rpm, expected) in [(700.0, 1), (150.0, 0)] {
        let machine = machine(&paper, rpm);
        let orbits = of_one_revolution(&machine);
        let stable = orbits.iter().filter(|orbit| orbit.is_stable()).count();
        assert_eq!(stable, 1, "{orbits:?}");
        let mut settling = LongRuns::unaided(&machine, Budget { transient: 1000, record: 0, longest: 4, patience: 0 });
        for orbit in orbits.iter().chain(&orbits) {
            settling.know(orbit).unwrap();
        }
        assert_eq!(settling.known().count(), expected, "{rpm} rpm");
    }
}

#[test]
fn orbits_of_two_impacts_are_all_found_only_in_one_revolution() {
    let machine = machine(&common::osorio(), 700.0);
    let once = search_all(&machine, &Search { revolutions: 1, impacts: Some(2) }, &Unwatched).unwrap();
    assert!(!once.complete.is_empty(), "{once:?}");
    let searched = search_all(&machine, &Search { revolutions: 2, impacts: Some(2) }, &Unwatched).unwrap();
    assert!(searched.complete.is_empty() && searched.orbits.iter().all(|orbit| orbit.revolutions == 2), "{searched:?}");
}

/// Without enclosures: by short runs alone, which an unstable orbit is next to.
#[test]
fn short_runs_lead_to_unstable_orbits_of_as_many_impacts_as_are_asked_for() {
    let paper = common::osorio();
    for (rpm, expected) in [(700.0, &[[24.927658265, 158.084998107]][..]), (736.2, &[[90.009638838, 154.942675475]])] {
        let found = search(&machine(&paper, rpm), &Search { revolutions: 1, impacts: Some(2) }).unwrap();
        let angles = |orbit: &PeriodicOrbit| orbit.impacts().map(|it| it.cam_angle.to_degrees()).collect::<Vec<_>>();
        let found: Vec<_> = found.iter().map(angles).collect();
        for [one, two] in expected {
            let is_it = |it: &Vec<f64>| (it[0] - one).abs() < 1e-7 && (it[1] - two).abs() < 1e-7;
            assert!(found.iter().any(is_it), "{rpm} rpm: {found:?}");
        }
    }
}

#[test]
fn no_branch_begins_at_a_speed_that_no_cam_turns_at() {
    let paper = common::osorio();
    let orbits = of_one_revolution(&machine(&paper, 700.0));
    for rpm in [0.0, -700.0, f64::INFINITY, f64::NAN] {
        let (range, parameter) = ([660.0, 760.0], Parameter::Speed);
        let following = Following { parameter, range, longest_step: 0.1, most_points: 10 };
        let error = Branch::through(&paper, rpm, &orbits[0], &following).unwrap_err();
        assert!(error.to_string().contains("must be a finite number above 0"), "{rpm}: {error}");
    }
}

/// What a run comes to, and after how many revolutions that is told.
fn told(settling: &LongRuns, mut motion: Motion, revolutions: u64) -> String {
    let come_to = match settling.run(&mut motion, revolutions).unwrap() {
        RunOutcome::Arrives(it) => orbit(&it),
        RunOutcome::PermanentContact => "stays".into(),
        RunOutcome::Released(angle) => format!("released at {angle:.5}"),
        RunOutcome::Wanders => "none of these".into(),
    };
    // When it is told may be a threshold that rounding decides.
    let sooner = motion.revolution < revolutions;
    format!("    {revolutions} revolutions, {}: {come_to}\n", if sooner { "told sooner" } else { "all of them" })
}

/// Machines of those that are drawn whose runs come to something soon, late, or within little more than they are looked at for: none is
/// chaotic.
#[test]
fn what_runs_come_to_is_told_as_soon_as_it_is_certain() {
    let mut all = String::new();
    let drawn = drawn(cases_of_every_law(), 120);
    for index in [63, 95, 100, 108, 115, 116, 119] {
        let case = &drawn[index];
        let motion = case.motion().unwrap();
        let unaided = LongRuns::unaided(&case.machine, Budget { transient: 2000, record: 0, longest: 4, patience: 0 });
        all += &format!("{index}\n");
        for settling in [&LongRuns::new(&case.machine, Budget { longest: 4, ..Budget::SURVEY }).unwrap(), &unaided] {
            all += &format!("  {} known\n", settling.known().count());
            all.extend([60, 400].map(|revolutions| told(settling, motion, revolutions)));
        }
        for revolutions in [3, 400] {
            let ended = long_run(
                &case.machine,
                motion,
                Budget { transient: revolutions, record: 1600, longest: 4, patience: 0 },
            )
            .unwrap()
            .ending;
            all += &format!("  {revolutions} revolutions, and what follows: {}\n", ending(&ended));
        }
        all += &match unaided.after_release(case.angle, unaided.budget.rest(), |_| None).unwrap().0 {
            AfterRelease::Recurs(it) => format!("  let go, it rests again: {}\n", ending(&LongRun::Sticking(it))),
            AfterRelease::Arrives(it, motion) => {
                format!("  let go, in revolution {}: {}\n", motion.revolution, orbit(&it))
            }
            AfterRelease::Wanders { .. } => "  let go, it comes to nothing\n".into(),
        };
    }
    is_as_it_was("runs-told", &all);
}

/// Next to a fold, with the stable orbit as near as a hundredth of the cam's lift: beside the unstable one a run goes the other way.
#[test]
fn a_run_that_leaves_an_unstable_orbit_is_not_said_to_come_to_a_stable_one_nearby() {
    for scales in [[0, 0, 0], [-20, 0, 0], [20, 0, 0]] {
        let (machine, size) =
            (machine(&in_units("persistence", scales), 493.811509867092714 + 2e-9), 2.0_f64.powi(scales[0]));
        let orbits = search(&machine, &Search { revolutions: 1, impacts: Some(1) }).unwrap();
        let near = |orbit: &&PeriodicOrbit| (orbit.events[0].cam_angle.to_degrees() - 131.75).abs() < 1.0;
        let (stable, unstable): (Vec<_>, Vec<_>) = orbits.iter().filter(near).partition(|orbit| orbit.is_stable());
        let ([stable], [unstable]) = (&stable[..], &unstable[..]) else { panic!("{orbits:?}") };
        let settling = LongRuns::new(&machine, Budget { longest: 1, ..Budget::SURVEY }).unwrap();
        assert!(settling.known().any(|known| known.is_same(stable)));
        let apart = (unstable.state.position - stable.state.position).abs();
        assert!((1e-6..1e-3).contains(&(apart / size)), "{apart} m");
        let start = |part: f64| {
            let along = |from: f64, to: f64| from + part * (to - from);
            let [from, to] = [unstable.state, stable.state];
            let state =
                State { position: along(from.position, to.position), velocity: along(from.velocity, to.velocity) };
            machine.start(0.0, state).unwrap()
        };
        for part in [-0.5, -0.1, -0.01, 0.01, 1.0 - 1e-3] {
            let run = settling.run(&mut start(part), 8).unwrap();
            let comes = matches!(&run, RunOutcome::Arrives(orbit) if orbit.is_same(stable));
            assert_eq!(comes, part > 0.9, "{part}: {run:?}");
        }
    }
}

/// At angle 0 the cam is low, and what is below its top there may be struck yet.
#[test]
fn a_follower_floats_once_it_is_above_the_top_for_good() {
    let cam = "law = \"harmonic\"\noffset = 0.1\namplitudes = [0.02]\nphases_deg = [180.0]";
    let follower = "damping = 1.0\nstiffness = 400.0\ngravity = 0.0\nrest_position = 0.125\nrestitution = 0.6";
    let model = model(follower, cam);
    for (rpm, position, revolution) in [(100.0, 0.155, 3), (150.0, 0.14, 13), (150.0, 0.167, 6), (400.0, 0.143, 33)] {
        let machine = machine(&model, rpm);
        let settling = LongRuns::unaided(&machine, Budget { transient: 1000, record: 0, longest: 100, patience: 0 });
        let start = machine.start(0.0, State { position, velocity: 0.0 }).unwrap();
        let (mut motion, mut earlier) = (start, start);
        let run = settling.run(&mut motion, 100).unwrap();
        assert!(matches!(&run, RunOutcome::Arrives(orbit) if orbit.course == Course::Free), "{rpm} rpm: {run:?}");
        assert_eq!(motion.revolution, revolution, "{rpm} rpm from {position}");
        machine.revolve(&mut earlier, revolution - 1).unwrap();
        let [before, now] = [earlier, motion].map(|motion| motion.state.position);
        assert!(before < 0.12 && 0.12 < now, "{rpm} rpm: {before} {now}");
    }
}

/// Right behind a flip the two halves of eight revolutions are alike, so that the run is back near where it was after four: who looks for
/// seven at most is not told of the eight.
#[test]
fn a_run_comes_to_no_orbit_that_is_longer_than_what_is_looked_for() {
    let machine = machine(&crate::orbit_numbers::model("nonsmooth-flip"), 881.773);
    let mut settled = machine.start_on_cam(1.0, 0.1).unwrap();
    machine.revolve(&mut settled, 20_000).unwrap();
    let run = |longest: u64| {
        LongRuns::unaided(&machine, Budget { transient: 1000, record: 0, longest, patience: 0 })
            .run(&mut settled.clone(), 400)
            .unwrap()
    };
    let RunOutcome::Arrives(orbit) = run(8) else { panic!("{:?}", run(8)) };
    assert_eq!(orbit.revolutions, 8);
    for longest in [5, 6, 7] {
        assert_eq!(run(longest), RunOutcome::Wanders, "{longest}");
    }
}
