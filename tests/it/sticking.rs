//! Does the follower stay on the cam exactly as long as the cam presses, and leave where it lets go?

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU32, Ordering};

use crate::common;
use crate::random::check;
use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::cam::{apart, within_a_turn};
use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::simulate::{Event, EventKind, Machine, Motion, SimulateError, angular_velocity};
use proptest::prelude::*;

fn machine(model: &Model, rpm: f64) -> Machine {
    Machine::new(common::cam(model), &model.follower, angular_velocity(rpm))
}

/// A follower with w0^2 = 100 1/s^2 over the cam of some `[cam]` table.
fn over(cam: &str, restitution: f64, rest_position: f64) -> Model {
    let text = format!(
        "[follower]\nmass = 2.0\ndamping = 0.0\nstiffness = 200.0\ngravity = 9.0\nrest_position = {rest_position}\n\
         restitution = {restitution}\n[cam]\n{cam}\n"
    );
    Model::parse("over.toml", &text).unwrap()
}

fn run(machine: &Machine, mut motion: Motion, revolutions: u64) -> (Motion, Vec<Event>) {
    let mut events = Vec::new();
    let goal = motion.after(revolutions);
    let _ = machine
        .advance(&mut motion, goal, &mut |event: &Event| {
            events.push(*event);
            ControlFlow::Continue(())
        })
        .unwrap();
    (motion, events)
}

/// c = a cos theta: the contact force is 0 where w0^2 (c - rest) + g + w^2 c'' = 0, and grows less before that.
#[test]
fn release_inside_a_segment_is_where_the_contact_force_ends() {
    let (amplitude, rest, w, g) = (0.1, -0.05, 100.0, 9.0);
    let model = over("law = \"harmonic\"\noffset = 0.0\namplitudes = [0.1]\nphases_deg = [0.0]", 0.5, rest);
    for omega in [16.0, 20.0, 31.0] {
        let machine = machine(&model, omega * 60.0 / TAU);
        // (w^2 - w0^2) a cos theta = g - w0^2 rest, on the way up.
        let at = TAU - ((g - w * rest) / (amplitude * (omega * omega - w))).acos();
        let start = machine.start_on_cam(PI, 0.0).unwrap();
        assert!(start.contact);
        let (_, events) = run(&machine, start, 9);
        assert_eq!(events[0].kind, EventKind::Release, "{events:?}");
        assert_abs_diff_eq!(events[0].cam_angle, at, epsilon = 1e-11);
        assert_eq!(events[0].velocity_before, events[0].velocity_after);
        // It leaves upwards from its tangent, and comes back further on.
        assert_eq!(events[1].kind, EventKind::Impact);
        assert!(events[1].turned_since(at) > 1e-3, "{:?}", events[1]);
    }
    // At 15 rad/s the cam presses all the way.
    let machine = machine(&model, 15.0 * 60.0 / TAU);
    let (end, events) = run(&machine, machine.start_on_cam(PI, 0.0).unwrap(), 3);
    assert!(end.contact && events.is_empty(), "{events:?}");
}

/// c'' jumps down at P: there the paper's follower lets go, from 114.98 rpm on, where
/// w^2 = w0^2 (c - rest)/(-c''+).
#[test]
fn release_at_a_corner_is_at_the_corner_to_the_last_bit() {
    let model = common::osorio();
    let cam = common::cam(&model);
    let corner = cam.corners()[1];
    let w = model.follower.stiffness / model.follower.mass;
    let detachment = (w * (corner.plus.value - 0.3) / -corner.plus.curvature).sqrt() * 60.0 / TAU;
    assert_abs_diff_eq!(detachment, 114.98, epsilon = 5e-3);
    let above = machine(&model, detachment * (1.0 + 1e-9));
    let (_, events) = run(&above, above.start_on_cam(0.0, 0.0).unwrap(), 1);
    assert_eq!((events[0].kind, events[0].cam_angle), (EventKind::Release, corner.angle));
    let below = machine(&model, detachment * (1.0 - 1e-9));
    let (end, events) = run(&below, below.start_on_cam(0.0, 0.0).unwrap(), 2);
    assert!(events.is_empty() && end.contact, "{events:?}");
}

/// c = a |sin theta|: its velocity jumps from -a w to a w at 0 and pi. A follower that goes with it is hit there.
#[test]
fn a_velocity_jump_hits_a_follower_that_sticks() {
    let (amplitude, restitution, omega) = (0.01, 0.6, 5.0);
    let model = over("law = \"rectified-sine\"\noffset = 0.0\namplitude = 0.01", restitution, -0.5);
    let machine = machine(&model, omega * 60.0 / TAU);
    let (_, events) = run(&machine, machine.start_on_cam(0.5 * PI, 0.0).unwrap(), 1);
    let hit = events[0];
    assert_eq!((hit.kind, hit.cam_angle), (EventKind::Impact, PI));
    assert_relative_eq!(hit.velocity_before, -amplitude * omega, max_relative = 1e-14);
    assert_relative_eq!(hit.cam_velocity, amplitude * omega, max_relative = 1e-14);
    // v+ = c'+ + r (c'+ - v-)
    assert_relative_eq!(hit.velocity_after, amplitude * omega * (1.0 + 2.0 * restitution), max_relative = 1e-14);
    // It comes to rest again before the next corner, a revolution's half later: strongly pressed.
    assert!(events.iter().any(|event| event.kind == EventKind::Stick), "{events:?}");
    assert_eq!(events.iter().filter(|event| event.cam_angle == 0.0).count(), 1);
}

/// c = -a |sin theta|: there the velocity jumps down, and the follower goes on with the one it had.
#[test]
fn a_velocity_jump_downwards_lets_go() {
    let model = over("law = \"rectified-sine\"\noffset = 0.0\namplitude = -0.01", 0.6, -0.5);
    let machine = machine(&model, 5.0 * 60.0 / TAU);
    let (_, events) = run(&machine, machine.start_on_cam(0.5 * PI, 0.0).unwrap(), 1);
    assert_eq!((events[0].kind, events[0].cam_angle), (EventKind::Release, PI));
    assert_relative_eq!(events[0].velocity_after, 0.05, max_relative = 1e-14);
    assert_eq!(events[1].kind, EventKind::Impact);
}

/// At 183 rpm each revolution releases at P, bounces, and sticks again where infinitely many impacts end: period one, from
/// the first revolution on to the last bit, since sticking forgets the past.
#[test]
fn chattering_at_183_rpm_ends_in_sticking() {
    let model = common::osorio();
    let machine = machine(&model, 183.0);
    let (_, events) = run(&machine, machine.start_on_cam(0.0, 0.0).unwrap(), 5);
    let of = |revolution: u64| -> Vec<Event> {
        let events = events.iter().filter(|event| event.revolution == revolution);
        events.map(|event| Event { revolution: 0, ..*event }).collect()
    };
    let first = of(0);
    assert_eq!(first[0].kind, EventKind::Release);
    assert_eq!(first[0].cam_angle, common::cam(&model).corners()[1].angle);
    assert_eq!(first.last().unwrap().kind, EventKind::Stick);
    let hard = |event: &&Event| (event.velocity_after - event.cam_velocity).abs() > 1e-6;
    assert_eq!(first.iter().filter(|event| event.kind == EventKind::Impact).filter(hard).count(), 64);
    for revolution in 1..5 {
        assert_eq!(of(revolution), first);
    }
    // Each impact keeps 0.8 of the relative velocity, so the angles left to the end shrink by 0.8 too.
    let impacts: Vec<f64> = first.iter().filter(|event| event.kind == EventKind::Impact).map(|e| e.cam_angle).collect();
    let end = first.last().unwrap().cam_angle;
    let ratio = |k: usize| (end - impacts[k + 1]) / (end - impacts[k]);
    for k in [40, 50, 60] {
        assert_relative_eq!(ratio(k), 0.8, max_relative = 1e-4);
    }
}

/// Where chattering ends does not depend on where the sum is taken: cut off by hand at a millionth, the hops come to the
/// same angle.
#[test]
fn the_end_of_chattering_is_that_of_its_hops() {
    let model = common::osorio();
    let machine = machine(&model, 183.0);
    let (_, events) = run(&machine, machine.start_on_cam(0.0, 0.0).unwrap(), 1);
    let impacts: Vec<&Event> = events.iter().filter(|event| event.kind == EventKind::Impact).collect();
    let last = events.last().unwrap();
    // The last hops one after the other, each a geometric sum of what is left: Aitken's limit of the last three.
    let [a, b, c] =
        [impacts[impacts.len() - 3], impacts[impacts.len() - 2], impacts[impacts.len() - 1]].map(|e| e.cam_angle);
    let limit = c - (c - b) * (c - b) / ((c - b) - (b - a));
    assert_abs_diff_eq!(last.cam_angle, limit, epsilon = 2e-13);
}

#[test]
fn a_start_on_the_cam_sticks_flies_or_is_hit() {
    let model = common::osorio();
    let machine = machine(&model, 183.0);
    assert!(machine.start_on_cam(0.3, 0.0).unwrap().contact);
    assert!(!machine.start_on_cam(0.3, 1e-9).unwrap().contact);
    // On the nose the cam turns away faster than the spring follows.
    assert!(!machine.start_on_cam(2.7, 0.0).unwrap().contact);
    // With the cam's velocity and a bit less it is hit where it starts.
    let lift = machine.cam().lift(2.0);
    let velocity = machine.angular_velocity() * lift.slope - 0.5;
    let start = machine.start(2.0, State { position: lift.value, velocity }).unwrap();
    let (_, events) = run(&machine, start, 1);
    assert_eq!((events[0].kind, events[0].cam_angle), (EventKind::Impact, 2.0));
    assert_relative_eq!(events[0].velocity_after - events[0].cam_velocity, 0.4, max_relative = 1e-12);
}

/// Spring and cam swing alike: the slope's terms cancel all round, and the contact force is what is left.
#[test]
fn a_force_near_zero_all_round_is_followed_and_its_end_found() {
    let near_zero = |second: f64, preload: f64| {
        let text = format!(
            "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 1.0\ngravity = 0.0\nrest_position = {}\n\
             restitution = 0.5\n[cam]\nlaw = \"harmonic\"\noffset = 1.0\namplitudes = [0.1, {second:e}]\n\
             phases_deg = [0.0, 0.0]\n",
            1.0 - preload
        );
        machine(&Model::parse("near-zero.toml", &text).unwrap(), 60.0 / TAU)
    };
    let pressed = near_zero(0.0, 1e-9);
    let (end, events) = run(&pressed, pressed.start_on_cam(0.0, 0.0).unwrap(), 2);
    assert!(end.contact && events.is_empty(), "{events:?}");
    // w = w0 = 1: lifting = 3 b cos(2 theta) - preload, which rises through 0 on the way to theta = pi.
    let preload = 1e-6;
    for share in [1.01, 1.1, 2.0, 10.0] {
        let machine = near_zero(preload * share / 3.0, preload);
        let at = PI - 0.5 * (1.0_f64 / share).acos();
        let (_, events) = run(&machine, machine.start_on_cam(0.5 * PI, 0.0).unwrap(), 1);
        assert_eq!(events[0].kind, EventKind::Release, "{share}: {events:?}");
        assert_abs_diff_eq!(events[0].cam_angle, at, epsilon = 1e-7);
    }
    let machine = near_zero(preload * 0.999 / 3.0, preload);
    let (end, events) = run(&machine, machine.start_on_cam(0.5 * PI, 0.0).unwrap(), 1);
    assert!(end.contact && events.is_empty(), "{events:?}");
}

/// On a turn of angles a follower that is put on the cam stays there inside of a stretch of rest, and flies outside; where each stretch
/// ends, the cam lets go of it or strikes it.
#[test]
fn a_follower_rests_on_the_cam_in_the_stretches_of_rest_and_nowhere_else() {
    static LEFT: AtomicU32 = AtomicU32::new(0);
    check(300, |case| {
        let machine = &case.machine;
        let rests = machine.rests().unwrap();
        for index in 0..360 {
            let angle = TAU * f64::from(index) / 360.0;
            if rests.iter().flatten().any(|end| apart(*end, angle) < 1e-7) {
                continue;
            }
            let inside =
                rests.iter().any(|[from, to]| [angle - TAU, angle].iter().any(|angle| from < angle && angle < to));
            let start = machine.start_on_cam(angle, 0.0).unwrap();
            prop_assert_eq!(start.contact, inside, "at {} deg: {:?}", index, rests);
        }
        for [from, to] in &rests {
            if to - from < 1e-6 {
                continue;
            }
            let mut motion = machine.start_on_cam(within_a_turn(0.5 * (from + to)), 0.0).unwrap();
            let mut first: Option<Event> = None;
            let goal = motion.after(1);
            let run = machine.advance(&mut motion, goal, &mut |event: &Event| {
                first.get_or_insert(*event);
                ControlFlow::Break(())
            });
            LEFT.fetch_add(u32::from(first.is_some()), Ordering::Relaxed);
            match (run, first) {
                (Ok(_), Some(event)) => prop_assert!(
                    event.kind != EventKind::Stick && apart(event.cam_angle, *to) < 1e-9,
                    "{:?} {:?}",
                    [from, to],
                    event
                ),
                (Ok(_), None) => prop_assert!(to - from == TAU, "{:?} is not left", [from, to]),
                // The lift steps up through the follower.
                (Err(SimulateError::BelowCam { cam_angle, .. }), _) => prop_assert!(apart(cam_angle, *to) < 1e-9),
                (Err(error), _) => prop_assert!(false, "{error}"),
            }
        }
        Ok(())
    });
    let left = LEFT.load(Ordering::Relaxed);
    assert!(left >= 200, "{left} stretches with an end");
}

/// A cam that is put on its shaft by some angle has its stretches of rest by that angle further on, through angle 0 too.
#[test]
fn stretches_of_rest_turn_with_the_cam() {
    let rests = |turned: f64| {
        let phases = [40.0 - turned, 100.0 - 2.0 * turned];
        let law = format!("law = \"harmonic\"\noffset = 1.0\namplitudes = [0.3, 0.1]\nphases_deg = {phases:?}");
        machine(&over(&law, 0.5, 0.8), 105.0).rests().unwrap()
    };
    let first = rests(0.0);
    assert!(first.len() == 2 && first.iter().all(|[from, to]| to - from < TAU), "{first:?}");
    let mut through_0 = 0;
    for index in 1..24 {
        let turned = 15.0 * f64::from(index);
        let found = rests(turned);
        assert_eq!(found.len(), 2, "{turned} deg: {found:?}");
        for [from, to] in &first {
            let same = |[other_from, other_to]: &&[f64; 2]| {
                apart(*from + turned.to_radians(), *other_from) < 1e-9
                    && (other_to - other_from - (to - from)).abs() < 1e-9
            };
            let other = found.iter().find(same).unwrap_or_else(|| panic!("{turned} deg: {first:?} {found:?}"));
            assert!(-TAU < other[0] && other[0] < TAU && 0.0 < other[1] && other[1] <= TAU, "{other:?}");
            through_0 += u32::from(other[0] < 0.0);
        }
    }
    assert!((3..24).contains(&through_0), "{through_0}");
}
