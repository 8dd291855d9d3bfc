//! Does the event loop go over the steps of a lift? No model has one: a law that is continued past a corner leaves one where it ends.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::ControlFlow;

use crate::common;
use crate::progress::program;
use crate::properties::{EVENTS, first_contacts_from, goal};
use crate::random::{Case, cases_of_every_law, cases_of_many_segments, drawn};
use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::cam::{Cam, Side};
use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::simulate::{Event, EventKind, Machine, Motion, SimulateError, angular_velocity};

/// A follower that gravity alone pulls over polynomials from each of these angles, rad, on.
fn machine(restitution: f64, gravity: f64, pieces: &[(f64, &[f64])]) -> Machine {
    let piece = |(start, coefficients): &(f64, &[f64])| {
        format!("[[cam.segment]]\nstart_deg = {:?}\ncoefficients = {coefficients:?}\n", start.to_degrees())
    };
    let text = format!(
        "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 0.0\ngravity = {gravity:?}\nrest_position = 0.0\n\
         restitution = {restitution:?}\n[cam]\nlaw = \"polynomial\"\n{}",
        pieces.iter().map(piece).collect::<String>()
    );
    let model = Model::parse("steps.toml", &text).unwrap();
    Machine::new(common::cam(&model), &model.follower, 1.0)
}

fn continued(machine: &Machine, corner: usize, side: Side, reach: f64) -> Machine {
    let cam = machine.cam().continued(&machine.cam().corners()[corner], side, reach).unwrap();
    machine.with_cam(cam)
}

/// A run up to its end or to so many events, and these.
fn run(machine: &Machine, mut motion: Motion, turn: f64) -> (Result<Motion, SimulateError>, Vec<Event>) {
    let mut events = Vec::new();
    let goal = goal(&motion, turn);
    let end = machine.advance(&mut motion, goal, &mut |event: &Event| {
        events.push(*event);
        if events.len() < EVENTS { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    (end.map(|_| motion), events)
}

/// From a dwell at 0 the lift goes over to x^2 - x^3/3, which is level again, 4/3 higher, at x = 2.
const HILL: [(f64, &[f64]); 3] = [(0.0, &[0.0]), (1.0, &[0.0, 0.0, 1.0, -1.0 / 3.0]), (4.0, &[0.0])];

/// A follower that rests on the cam is below it where the lift steps up, is let go where it steps down, whatever the slope does there, and
/// the stretches of rest end there.
#[test]
fn a_follower_that_rests_meets_a_step() {
    let whole = machine(0.0, 30.0, &HILL);
    // Up by the hill's 2/3 at 1, where it is steep, and by 4/3 at 2, where it is as level as the dwell.
    for (reach, depth) in [(1.0, 2.0 / 3.0), (1.5, 1.125)] {
        let machine = continued(&whole, 0, Side::Minus, reach);
        let (end, events) = run(&machine, machine.start_on_cam(0.5, 0.0).unwrap(), TAU);
        match end {
            Err(SimulateError::BelowCam { depth: found, revolution: 0, cam_angle }) => {
                assert_relative_eq!(found, depth, max_relative = 1e-14);
                assert_abs_diff_eq!(cam_angle, 1.0 + reach, epsilon = 1e-14);
            }
            other => panic!("{other:?} {events:?}"),
        }
        let rests = machine.rests().unwrap();
        assert!(rests.iter().any(|[_, to]| (to - 1.0 - reach).abs() < 1e-14), "{rests:?}");
    }
    // Down from the hill, or from its valley's far side, to the dwell: where the slope is level, falls and rises.
    for (pieces, reach) in [
        (&HILL[..], 1.0),
        (&HILL[..], 1.2),
        (&[(0.0, &[0.0][..]), (1.0, &[0.0, 0.0, 1.0, -1.0 / 3.0]), (4.0, &[0.0])][..], 0.8),
    ] {
        let whole = machine(0.0, 30.0, pieces);
        let machine = continued(&whole, 1, Side::Plus, reach);
        let at = 4.0 - reach;
        let before = whole.cam().lift(at);
        let (end, events) = run(&machine, machine.start_on_cam(2.0, 0.0).unwrap(), 0.99 * (TAU - 2.0));
        let end = end.unwrap();
        let [release, impact, ..] = events[..] else { panic!("{events:?}") };
        assert_eq!(release.kind, EventKind::Release);
        assert_abs_diff_eq!(release.cam_angle, at, epsilon = 1e-14);
        assert_relative_eq!(release.position, before.value, max_relative = 1e-14);
        assert_relative_eq!(release.velocity_after, before.slope, epsilon = 1e-14, max_relative = 1e-13);
        // q = c + c' t - 15 t^2 is 0 again.
        let time = (before.slope + (before.slope.powi(2) + 60.0 * before.value).sqrt()) / 30.0;
        assert_eq!(impact.kind, EventKind::Impact);
        assert_abs_diff_eq!(impact.cam_angle, at + time, epsilon = 1e-13);
        assert!(end.contact);
        let rests = machine.rests().unwrap();
        assert!(rests.iter().any(|[_, to]| (to - at).abs() < 1e-14), "{rests:?}");
    }
}

/// However fast a follower leaves the cam just before a step, it is below it, also on a cam whose slope jumps downwards alone.
#[test]
fn no_start_is_fast_enough_for_a_step() {
    let cam = program(
        0.0,
        &[("dwell", 90.0, 0.0), ("cycloidal", 90.0, 1.0), ("dwell", 90.0, 0.0), ("cycloidal", 90.0, -1.0)],
    );
    let text = format!(
        "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 0.0\ngravity = 30.0\nrest_position = 0.0\n\
         restitution = 0.5\n[cam]\n{cam}"
    );
    let model = Model::parse("steps.toml", &text).unwrap();
    let whole = Machine::new(common::cam(&model), &model.follower, 1.0);
    let corner = whole.cam().corners().iter().position(|corner| (corner.angle - PI).abs() < 1e-9).unwrap();
    let machine = continued(&whole, corner, Side::Plus, 0.6);
    let (before, at) = (1e-4, PI - 0.6);
    let lift = whole.cam().lift(at);
    let motion = machine.start_on_cam(at - before, 50.0).unwrap();
    match run(&machine, motion, 1.0).0 {
        Err(SimulateError::BelowCam { depth, .. }) => {
            assert_abs_diff_eq!(depth, 1.0 - lift.value - 50.0 * before, epsilon = 1e-6);
        }
        other => panic!("{other:?}"),
    }
}

/// A flight that is as high as the lift behind a step, to rounding, goes over it; a lower one is below the cam.
#[test]
fn a_flight_as_high_as_a_step_goes_over_it() {
    let machine = continued(&machine(0.0, 30.0, &HILL), 0, Side::Minus, 1.0);
    let at = machine.cam().segments()[1].start;
    let lift = machine.cam().lift(at);
    // Rounding: four ulps of the follower's 2/3 and the cam's 4/3.
    for share in [-0.25, 0.0, 0.25] {
        let state = State { position: lift.value + share * 8.0 * f64::EPSILON, velocity: 1.5 * lift.slope };
        run(&machine, machine.start(at.next_down(), state).unwrap(), 0.01).0.unwrap();
        let lower = State { position: state.position - 1e-9, ..state };
        match run(&machine, machine.start(at.next_down(), lower).unwrap(), 0.01).0 {
            Err(SimulateError::BelowCam { depth, .. }) => assert_abs_diff_eq!(depth, 1e-9, epsilon = 1e-14),
            other => panic!("{other:?}"),
        }
    }
}

/// Flights over a step find their contacts where a scan does, and know their gap; who is below it is as deep as the lift is higher.
#[test]
#[ignore = "slow"]
fn flights_go_over_steps() {
    const TURNS: f64 = 1.5;
    let (mut below, mut over) = (0, 0);
    let cases = drawn(cases_of_every_law(), 200).into_iter().chain(drawn(cases_of_many_segments(), 40));
    for mut case in cases {
        let cam = case.machine.cam();
        let unit = |factor: f64| (case.rpm * factor).fract();
        let Some(corner) = cam.corners().get((unit(1e3) * cam.corners().len() as f64) as usize) else { continue };
        let side = if unit(1e4) < 0.5 { Side::Minus } else { Side::Plus };
        let least = cam.segments().iter().map(|segment| segment.end - segment.start).fold(TAU, f64::min);
        let Some(cam) = cam.continued(corner, side, least * (0.1 + 0.4 * unit(1e5))) else { continue };
        let steps = steps(&cam);
        // Smaller ones are none: the gap goes on as it was.
        let largest = steps.iter().fold(0.0_f64, |largest, (_, step)| largest.max(step.abs()));
        if largest < 1e-6 * case.stroke {
            continue;
        }
        case.machine = case.machine.with_cam(cam);
        let Ok(motion) = case.motion() else { continue };
        let turn = case.turns(TURNS);
        match run(&case.machine, motion, turn) {
            (Ok(_), _) => {
                first_contacts_from(&case, motion, TURNS, 20).unwrap();
                over += u32::from(knows_its_gap(&case, motion, turn));
            }
            (Err(SimulateError::BelowCam { depth, cam_angle, .. }), events) => {
                let (at, step) =
                    *steps.iter().find(|(at, step)| (at - cam_angle).abs() < 1e-12 && *step > 0.0).unwrap();
                let last = events.last();
                let (angle, state, sticks) = last.map_or((motion.cam_angle, motion.state, motion.contact), |event| {
                    let state = State { position: event.position, velocity: event.velocity_after };
                    (event.turned_since(0.0), state, event.kind == EventKind::Stick)
                });
                let lift = case.machine.cam().lift(at).value;
                let time = (at - angle).rem_euclid(TAU) / case.machine.angular_velocity();
                let position = case.machine.flight().fly(state, time).1.position;
                let expected = if sticks { step } else { lift - position };
                assert!(0.0 < depth && depth <= step * 1.000_001, "{depth} m below a step of {step} m");
                assert_abs_diff_eq!(depth, expected, epsilon = 1e-9 * case.stroke.max(lift.abs()));
                below += 1;
            }
            (Err(SimulateError::NoProgress { .. }), _) => {}
            (Err(error), _) => panic!("{error}: {case:?}"),
        }
    }
    assert!(below > 10 && over > 10, "{below} {over}");
}

/// Where the lift steps, rad, and by how much, m.
fn steps(cam: &Cam) -> Vec<(f64, f64)> {
    let pairs = cam.segments().windows(2);
    pairs
        .map(|pair| (pair[1].start, pair[1].law.lift(pair[1].start).value - pair[0].law.lift(pair[0].end).value))
        .collect()
}

/// The gap of a flight that is stopped at every place is its height above the lift; whether it came to the end of the run.
fn knows_its_gap(case: &Case, mut motion: Motion, turn: f64) -> bool {
    let (machine, first) = (&case.machine, motion);
    for index in 1..=100 {
        let goal = goal(&first, turn * f64::from(index) / 100.0);
        if machine.advance(&mut motion, goal, &mut |_: &Event| ControlFlow::Continue(())).is_err() {
            return false;
        }
        let lift = machine.cam().lift(motion.cam_angle).value;
        let gap = motion.state.position - lift;
        let size = motion.state.position.abs() + lift.abs() + case.stroke;
        assert!((machine.gap(&motion) - gap).abs() <= 1e-9 * size, "{} is not {gap}: {case:?}", machine.gap(&motion));
    }
    true
}

/// A follower without gravity or spring that comes down in the last instant of a turn, on a dwell, and sticks or bounces: stopped there, it meets
/// what begins at angle 0 as one that goes on does, whichever way the slope jumps, if it does.
#[test]
fn a_run_may_be_stopped_in_the_last_instant_of_a_turn() {
    // Where the first half begins with a slope, and where it begins level.
    let halves = [1.0, -1.0].map(|slope| [0.0, slope, -slope / PI, 0.0, 0.0]);
    let level = [0.0, 0.0, 0.1 * PI * PI, -0.2 * PI, 0.1];
    for (half, restitution) in [(halves[0], 0.0), (halves[1], 0.0), (level, 0.0), (halves[0], 0.5), (halves[1], 0.5)] {
        let machine = machine(restitution, 0.0, &[(0.0, &half), (PI, &[0.0])]).at_speed(angular_velocity(60.0));
        let mut met = 0;
        for ulps in -200..200 {
            let start = TAU - FRAC_PI_2;
            let height = 0.25 * (1.0 + f64::from(ulps) * f64::EPSILON);
            let motion = machine.start(start, State { position: height, velocity: -1.0 }).unwrap();
            let (end, whole) = run(&machine, motion, PI);
            end.unwrap();
            let Some(first) = whole.first().filter(|first| first.cam_angle == 0.0 && first.segment == 1) else {
                continue;
            };
            assert_eq!(first.kind, EventKind::Impact);
            met += 1;
            let mut split = motion;
            let goal = goal(&motion, PI);
            let mut events = Vec::new();
            while machine
                .advance(&mut split, goal, &mut |event: &Event| {
                    events.push(*event);
                    ControlFlow::Break(())
                })
                .unwrap()
                .is_break()
            {}
            assert_eq!(events, whole, "{half:?} {restitution}");
        }
        assert!(met > 0, "{half:?} {restitution}");
    }
}

/// A cam whose halves were typed to ten digits, with a lift of 0 beside one of 5e-12: the two count as one. A follower that floats over the lower
/// one, by less than they differ, is over the other by as much.
#[test]
fn a_follower_floats_over_a_seam_as_high_as_before_it() {
    let hump = [0.0, 0.0, 0.16 / (PI * PI), -0.32 / (PI * PI * PI), 0.16 / (PI * PI * PI * PI)];
    let machine = machine(0.5, 0.0, &[(0.0, &[0.0]), (FRAC_PI_2, &[5e-12]), (PI, &hump)]);
    let motion = machine.start(1.5, State { position: 2.5e-12, velocity: 1e-13 }).unwrap();
    let (end, events) = run(&machine, motion, 1.0);
    assert_abs_diff_eq!(machine.gap(&end.unwrap()), 2.6e-12, epsilon = 1e-16);
    assert!(events.is_empty(), "{events:?}");
}

/// The cam `c = 6 - s x + k x^2/2` has a ridge at angle 0. A ball comes down just behind it, a turn after an impact, nearly as fast as the cam falls.
/// The gap is small and hardly shrinks: Halley's step is a thousandth of the way to the contact.
#[test]
fn a_ball_that_hardly_nears_the_cam_a_turn_on_is_not_taken_to_it() {
    /// Angle behind the ridge, rad; the cam falls more slowly by as much than a ball that returns after exactly a turn.
    const BEHIND: f64 = 1e-7;
    let slope = PI - BEHIND;
    let bend = slope / PI;
    let machine = machine(0.5, 1.0, &[(0.0, &[6.0, -slope, 0.5 * bend])]);
    let lift = |angle: f64| -slope * angle + 0.5 * bend * angle * angle;
    let falls = |angle: f64| -slope + bend * angle;
    // It leaves for a little more than a turn, with half of the relative velocity that it came with.
    let higher = 0.3 * BEHIND;
    let leaves = PI + higher;
    let comes = falls(BEHIND) - 2.0 * (leaves - falls(BEHIND));
    // The impact before was five turns earlier, at an angle this much larger; the ball came to it from above.
    let mut later = 0.0;
    for _ in 0..60 {
        let time = 5.0 * TAU - later;
        later += (comes * time + 0.5 * time * time - lift(BEHIND) + lift(BEHIND + later)) / (6.0 * PI);
    }
    let first = BEHIND + later;
    let leaves_first = comes + 5.0 * TAU - later;
    let comes_first = falls(first) - 2.0 * (leaves_first - falls(first));
    let time = 1.0 + first;
    let position = 6.0 + lift(first) - comes_first * time - 0.5 * time * time;
    let motion = machine.start(TAU - 1.0, State { position, velocity: comes_first + time }).unwrap();
    let (_, events) = run(&machine, motion, 8.0 * TAU);
    let [one, two, three] = [events[0], events[1], events[2]];
    assert_eq!([one, two, three].map(|event| event.revolution), [1, 6, 7], "{events:?}");
    assert_abs_diff_eq!(one.cam_angle, first, epsilon = 1e-12);
    assert_abs_diff_eq!(two.cam_angle, BEHIND, epsilon = 1e-12);
    assert_abs_diff_eq!(two.velocity_after, leaves, epsilon = 1e-12);
    // 2 pi h - (1 + k) y^2/2 - (d + k d - h) y = 0 for the angle y from there on.
    let (half, slows) = (0.5 * (1.0 + bend), BEHIND + bend * BEHIND - higher);
    let after = ((slows * slows + 4.0 * half * TAU * higher).sqrt() - slows) / (2.0 * half);
    assert_abs_diff_eq!(three.cam_angle, BEHIND + after, epsilon = 1e-9);
}
