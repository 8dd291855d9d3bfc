//! Does every run come to an end: with a result, or with an error that says where it was?
//!
//! A hang is the failure.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use crate::common;
use corner_impact::cam::Cam;
use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::simulate::{Event, EventKind, Machine, Motion, SimulateError, angular_velocity};

#[track_caller]
fn in_time<T: Send + 'static>(what: &str, run: impl FnOnce() -> T + Send + 'static) -> T {
    common::ends(run).unwrap_or_else(|why| panic!("{what}: {why}"))
}

/// `[follower]` by damping, stiffness, gravity, rest position and restitution, for a mass of 1; and `[cam]`.
fn machine([damping, stiffness, gravity, rest, restitution]: [f64; 5], cam: &str, rpm: f64) -> Machine {
    let text = format!(
        "[follower]\nmass = 1.0\ndamping = {damping:?}\nstiffness = {stiffness:?}\ngravity = {gravity:?}\n\
         rest_position = {rest:?}\nrestitution = {restitution:?}\n[cam]\n{cam}"
    );
    let model = Model::parse("progress.toml", &text).unwrap();
    Machine::new(Cam::new(&model).unwrap(), &model.follower, angular_velocity(rpm))
}

/// `[cam]` of standard motions, each with its span in degrees and its rise.
pub fn program(base: f64, segments: &[(&str, f64, f64)]) -> String {
    let segment = |(motion, span, rise): &(&str, f64, f64)| {
        format!("[[cam.segment]]\nmotion = \"{motion}\"\nspan_deg = {span:?}\nrise = {rise:?}\n")
    };
    format!("law = \"program\"\nbase = {base:?}\n") + &segments.iter().map(segment).collect::<String>()
}

/// What a run came to.
#[derive(Debug)]
struct End {
    result: Result<Motion, SimulateError>,
    impacts: usize,
    events: Vec<Event>,
}

fn run(machine: Machine, start: Motion, revolutions: u64) -> End {
    in_time(&format!("{machine:?} from {start:?}"), move || {
        let (mut motion, mut impacts, mut events) = (start, 0, Vec::new());
        let goal = motion.after(revolutions);
        let result = machine.advance(&mut motion, goal, &mut |event: &Event| {
            impacts += usize::from(event.kind == EventKind::Impact);
            if events.len() < 100 {
                events.push(*event);
            }
            ControlFlow::Continue(())
        });
        End { result: result.map(|_| motion), impacts, events }
    })
}

/// The force of contact starts from 0 as a high power of the angle, or ends so: a bound on how fast it changes that is taken
/// too widely would let the search creep.
#[test]
fn a_force_that_grows_slowly_out_of_nothing() {
    let cam = program(-0.1, &[("poly4567", 239.2, 0.2), ("poly345", 120.8, -0.2)]);
    let slow = machine([0.004, 0.0, 0.0, 0.0, 0.99], &cam, 0.001);
    let start = slow.start_on_cam(0.0, 0.0).unwrap();
    assert!(start.contact);
    let end = run(slow, start, 3);
    // Nothing ever pushes it down again: it is thrown off where the damping no longer holds it.
    assert!(end.result.is_ok() && end.events[0].kind == EventKind::Release, "{end:?}");
    for motion in ["parabolic", "harmonic", "cycloidal", "modified-trapezoid", "modified-sine", "poly345", "poly4567"] {
        for damping in [0.0, 1e-6, 1.0] {
            let cam = program(0.1, &[("dwell", 60.0, 0.0), (motion, 140.0, 0.2), (motion, 160.0, -0.2)]);
            for rpm in [1e-3, 1.0, 1e5] {
                let machine = machine([damping, 0.0, 0.0, 0.0, 0.0], &cam, rpm);
                let start = machine.start_on_cam(0.5, 0.0).unwrap();
                let end = run(machine, start, 3);
                assert!(end.result.is_ok(), "{motion}: {end:?}");
            }
        }
    }
}

/// Cam and spring in resonance: the force of contact is the same all round, and as small as one likes.
#[test]
#[ignore = "slow"]
fn a_force_that_is_hardly_there_all_round() {
    let cam = "law = \"harmonic\"\noffset = 0.5\namplitudes = [0.1]\nphases_deg = [0.0]\n";
    let rpm = 60.0 / TAU;
    for below in [1e-3, 1e-5, 1e-9, 1e-14, 1e-16, 0.0] {
        let machine = machine([0.0, 1.0, 0.0, 0.5 - below, 0.5], cam, rpm);
        let start = machine.start_on_cam(0.3, 0.0).unwrap();
        let end = run(machine, start, 2);
        match end.result {
            // Told apart from 0, it holds the follower; else nothing lifts it far.
            Ok(motion) => assert!(below < 1e-15 || motion.contact, "{below}: {end:?}"),
            // In between the search would creep.
            Err(SimulateError::NoProgress { revolution: 0, cam_angle, .. }) => {
                assert!((1e-15..1e-9).contains(&below) && (0.3..TAU).contains(&cam_angle), "{below}: {end:?}");
            }
            Err(error) => panic!("{below}: {error}"),
        }
    }
}

/// Each impact takes a ten-millionth of the velocity: more impacts than a revolution may have, and the error says so.
#[test]
#[ignore = "slow"]
fn impacts_that_hardly_die_out() {
    let cam = program(0.0, &[("dwell", 360.0, 0.0)]);
    for restitution in [0.9999999, 1.0] {
        let machine = machine([0.0, 0.0, 10.0, 0.0, restitution], &cam, 1e-3);
        let start = machine.start(1.0, State { position: 1e-7, velocity: 0.0 }).unwrap();
        let end = run(machine, start, 1);
        match end.result {
            Err(SimulateError::NoProgress { events, revolution: 0, cam_angle }) => {
                assert!(events > 1_000_000 && (1.0..TAU).contains(&cam_angle), "{events} {cam_angle}");
                let words = end.result.unwrap_err().to_string();
                assert!(words.contains("revolution 0") && words.contains(" deg"), "{words}");
            }
            other => panic!("{other:?}"),
        }
    }
    // With 0.99 they die out in time.
    let machine = machine([0.0, 0.0, 10.0, 0.0, 0.99], &cam, 1e-3);
    let start = machine.start(1.0, State { position: 1e-3, velocity: 0.0 }).unwrap();
    let end = run(machine, start, 1);
    assert!(end.result.unwrap().contact && end.impacts > 100);
}

/// The impacts would end where the cam begins to rise, at 90 degrees, give or take.
#[test]
fn impacts_that_end_at_a_corner() {
    let cam = program(0.0, &[("dwell", 90.0, 0.0), ("parabolic", 135.0, 0.1), ("parabolic", 135.0, -0.1)]);
    for restitution in [0.0, 0.3, 0.9] {
        for offset in [-1e-9, -1e-15, 0.0, 1e-15, 1e-12, 1e-9, 1e-6] {
            let machine = machine([0.0, 0.0, 10.0, 0.0, restitution], &cam, 10.0);
            // 2 u/(g (1 - r)) is the time left to the corner.
            let left = (90.0_f64.to_radians() - 1.0 + offset) / machine.angular_velocity();
            let velocity = 0.5 * left * 10.0 * (1.0 - restitution);
            let start = machine.start(1.0, State { position: 0.0, velocity }).unwrap();
            let end = run(machine, start, 2);
            assert!(end.result.is_ok() && end.impacts < 10_000, "{restitution} {offset}: {end:?}");
        }
    }
}

/// Nothing moves the follower but the cam; or something moves it away for good.
#[test]
fn followers_that_nothing_brings_back() {
    let cam = program(0.2, &[("dwell", 90.0, 0.0), ("cycloidal", 135.0, 0.1), ("cycloidal", 135.0, -0.1)]);
    for follower in [
        [0.0, 0.0, 0.0, 0.0, 0.5],
        [0.0, 0.0, -1.0, 0.0, 0.5],
        [0.0, 0.0, 0.0, 0.0, 1.0],
        [1e3, 0.0, 0.0, 0.0, 0.0],
        [1.0, 100.0, 0.0, 0.3, 0.5],
        [0.0, 1e-12, -1e-9, 0.3, 0.5],
    ] {
        for (position, velocity) in [(0.2, 0.0), (0.3, 0.0), (0.2, 1.0), (0.3, -1.0), (5.0, 1e300), (1e300, -1.0)] {
            let machine = machine(follower, &cam, 60.0);
            let start = machine.start(0.5, State { position, velocity }).unwrap();
            let end = run(machine, start, 1000);
            assert!(end.result.is_ok(), "{follower:?} {position} {velocity}: {end:?}");
        }
    }
}

/// Cams that bend a million million times as sharply as they are large, and speeds at both ends of what is allowed.
#[test]
#[ignore = "slow"]
fn extreme_cams_and_speeds() {
    let cams = [
        program(0.2, &[("dwell", 180.0, 0.0), ("parabolic", 1e-4, 1.0), ("parabolic", 180.0 - 1e-4, -1.0)]),
        program(0.2, &[("dwell", 180.0, 0.0), ("poly4567", 1e-4, 1e-6), ("poly4567", 180.0 - 1e-4, -1e-6)]),
        "law = \"harmonic\"\noffset = 0.0\namplitudes = [1e12]\nphases_deg = [0.0]\n".into(),
        "law = \"harmonic\"\noffset = 0.0\namplitudes = [0.0]\nphases_deg = [0.0]\n".into(),
        "law = \"rectified-sine\"\noffset = 0.0\namplitude = 1.0\n".into(),
        "law = \"rectified-sine\"\noffset = 0.0\namplitude = -1.0\n".into(),
    ];
    for cam in &cams {
        for rpm in [1e-9, 1.0, 1e9] {
            for follower in [[0.0, 0.0, 9.81, 0.0, 0.5], [0.0, 1000.0, 0.0, 0.0, 0.0], [200.0, 1000.0, 9.81, -1.0, 0.8]]
            {
                // A tenth of the steps after which a run fails: what makes no progress in them makes none.
                let machine = machine(follower, cam, rpm).giving_up_after(1_000_000);
                // At the one speed that is none of the extremes also without any.
                for velocity in [1.0, 0.0].into_iter().take(if rpm == 1.0 { 2 } else { 1 }) {
                    let start = machine.start_on_cam(0.0, velocity).unwrap();
                    let end = run(machine.clone(), start, 2);
                    let allowed = match &end.result {
                        Ok(motion) => motion.revolution == 2,
                        Err(error) => matches!(error, SimulateError::NoProgress { .. }),
                    };
                    assert!(allowed, "{cam} at {rpm} rpm, {follower:?}, {velocity}: {end:?}");
                }
            }
        }
    }
}

/// A cam whose velocity jumps kicks a follower that sticks to it, once at each corner.
#[test]
fn a_follower_that_sticks_is_kicked_at_corners() {
    let cam = "law = \"rectified-sine\"\noffset = 0.0\namplitude = 1.0\n";
    let heavy = machine([0.0, 0.0, 1e4, 0.0, 0.0], cam, 10.0);
    let start = heavy.start_on_cam(1.0, 0.0).unwrap();
    let end = run(heavy, start, 5);
    assert!(end.result.unwrap().contact && end.impacts == 10, "{:?}", end.events);
    for event in end.events.iter().filter(|event| event.kind == EventKind::Impact) {
        assert!(event.cam_angle.sin().abs() < 1e-15, "{event:?}");
        assert!(event.velocity_before < 0.0 && event.velocity_after == event.cam_velocity, "{event:?}");
    }
}

/// As many rows as a file holds: read, splined and run over in seconds.
#[test]
#[ignore = "slow"]
fn a_table_of_as_many_rows_as_a_file_holds() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("many");
    std::fs::create_dir_all(&folder).unwrap();
    let rows = 400_000;
    let mut table = "angle_deg,lift\n".to_owned();
    for row in 0..rows {
        let angle = 360.0 * f64::from(row) / f64::from(rows);
        table += &format!("{angle},{}\n", 0.1 - 0.02 * angle.to_radians().cos());
    }
    std::fs::write(folder.join("lifts.csv"), table).unwrap();
    let file = folder.join("many.toml");
    let text = "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 0.0\ngravity = 9.81\nrest_position = 0.0\n\
                restitution = 0.5\n[cam]\nlaw = \"table\"\nfile = \"lifts.csv\"\nspline = \"cubic\"\n";
    let end = in_time("many rows", move || {
        let model = Model::parse(file.to_str().unwrap(), text).unwrap();
        let machine = Machine::new(Cam::new(&model).unwrap(), &model.follower, angular_velocity(300.0));
        let start = machine.start_on_cam(0.0, 0.0).unwrap();
        run(machine, start, 20)
    });
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(end.result.is_ok() && end.impacts > 20, "{end:?}");
}
