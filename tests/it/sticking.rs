//! Does the follower stay on the cam exactly as long as the cam presses, and leave where it lets go?

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU32, Ordering};

use crate::common;
use crate::progress::program;
use crate::random::{cases_of_every_law, check, drawn};
use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::cam::{Lift, apart, within_a_turn};
use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::orbit::{Course, Search, search};
use corner_impact::simulate::{Event, EventKind, Goal, Machine, Motion, SimulateError, angular_velocity};
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

/// A whole turn on the cam without an event repeats, so that a million million of them take no time. Wherever the run is stopped, the state
/// is that of the first turn to the last bit.
#[test]
fn a_follower_that_never_leaves_repeats_its_first_turn() {
    // Far from the lobe the spline through the rows of the dwell ends in numbers below 1e-290, which are no corners.
    let lift = |degrees: f64| {
        let x = (1.0 - (degrees - 180.0).abs() / 120.0).max(0.0);
        x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x)
    };
    let row = |index: i32| {
        let degrees = 0.036 * f64::from(index);
        format!("[{degrees:?}, {:?}],", lift(degrees))
    };
    let rows: String = (0..10_000).map(row).collect();
    let model = over(&format!("law = \"table\"\nspline = \"quintic\"\nrows = [{rows}]"), 0.5, -5.0);
    let machine = machine(&model, 30.0);
    let segment = machine.cam().segments()[2500].start;
    let start = machine.start_on_cam(1.0, 0.0).unwrap();
    let shown = |motion: &Motion| (motion.state, motion.cam_angle, motion.contact, machine.gap(motion));
    let mut stopped = start;
    for (turn, cam_angle) in [0.0, segment, 3.0, 1.0, 0.5, segment, 6.0].into_iter().enumerate() {
        let to = |mut motion: Motion, revolution: u64| {
            let _ =
                machine.advance(&mut motion, Goal { revolution, cam_angle }, &mut |event: &Event| panic!("{event:?}"));
            assert_eq!(motion.revolution, revolution);
            motion
        };
        let far = 1_000_000_000_000 + turn as u64;
        stopped = to(stopped, far);
        assert_eq!(shown(&to(start, 1)), shown(&to(start, far)), "{cam_angle}");
        assert_eq!(shown(&stopped), shown(&to(start, far)), "{cam_angle}");
    }
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

/// A run that ends at the corner, or between the last of many impacts and where they end, ends there, and goes on as one that does not.
#[test]
fn a_run_may_end_where_something_happens() {
    let hits = machine(&over("law = \"rectified-sine\"\noffset = 0.0\namplitude = 0.01", 0.6, -0.5), 47.0);
    let chatters = machine(&common::osorio(), 183.0);
    // So small a kick ends at once.
    let pieces = "[[cam.segment]]\nstart_deg = 0.0\ncoefficients = [0.01]\n\
                  [[cam.segment]]\nstart_deg = 180.0\ncoefficients = [0.01, 1e-8, -3.183098861837907e-9]";
    let kicks = machine(&over(&format!("law = \"polynomial\"\n{pieces}"), 0.6, -0.5), 47.0);
    let kicked = run(&kicks, kicks.start_on_cam(0.5 * PI, 0.0).unwrap(), 1).1;
    let kinds: Vec<EventKind> = kicked.iter().map(|event| event.kind).collect();
    assert_eq!(kinds, [EventKind::Impact, EventKind::Stick, EventKind::Impact, EventKind::Stick], "{kicked:?}");
    let stuck = run(&hits, hits.start_on_cam(0.5 * PI, 0.0).unwrap(), 1).1;
    let whole = run(&chatters, chatters.start_on_cam(0.0, 0.0).unwrap(), 1).1;
    let [.., last, stick] = &whole[..] else { panic!("{whole:?}") };
    assert_eq!((last.kind, stick.kind), (EventKind::Impact, EventKind::Stick));
    for (machine, start, events, end) in [
        (&hits, 0.5 * PI, &stuck, PI),
        (&chatters, 0.0, &whole, 0.5 * (last.cam_angle + stick.cam_angle)),
        (&chatters, 0.0, &whole, last.cam_angle + 0.99 * (stick.cam_angle - last.cam_angle)),
        (&chatters, 0.0, &whole, whole[0].cam_angle),
        (&kicks, 0.5 * PI, &kicked, 0.5 * (kicked[0].cam_angle + kicked[1].cam_angle)),
    ] {
        let mut motion = machine.start_on_cam(start, 0.0).unwrap();
        let mut found = Vec::new();
        for goal in [Goal { cam_angle: end, ..motion.after(0) }, motion.after(1)] {
            let _ = machine
                .advance(&mut motion, goal, &mut |event: &Event| {
                    found.push(*event);
                    ControlFlow::Continue(())
                })
                .unwrap();
            assert_eq!((motion.revolution, motion.cam_angle), (goal.revolution, goal.cam_angle));
        }
        // The end of the impacts is summed up from later ones: each leaves out the more the nearer it is.
        let (one, two) = (found.last().unwrap(), events.last().unwrap());
        assert_eq!(one.kind, two.kind);
        assert_abs_diff_eq!(one.turned_since(0.0), two.turned_since(0.0), epsilon = 1e-12);
        assert!((events.len()..events.len() + 30).contains(&found.len()), "{end}: {}", found.len());
    }
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
    // A velocity that is the cam's but for its last digit is the cam's.
    let Lift { value: position, slope, .. } = machine.cam().lift(2.0);
    let velocity = machine.angular_velocity() * slope;
    for velocity in [velocity.next_up(), velocity.next_down()] {
        assert!(machine.start(2.0, State { position, velocity }).unwrap().contact);
    }
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
#[ignore = "slow"]
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

/// Pieces of motions that meet smoothly are no corners, in whatever unit: pressed everywhere, a follower rests all round.
#[test]
fn a_follower_that_is_pressed_rests_all_round_in_any_unit() {
    for size in [1e-6, 1.0, 1e6] {
        for motion in
            ["modified-trapezoid", "modified-sine", "cycloidal", "poly345", "poly4567", "parabolic", "harmonic"]
        {
            let segments = [(motion, 90.0, 0.7), ("dwell", 90.0, 0.0), (motion, 90.0, 0.3), (motion, 90.0, -1.0)];
            let cam = program(0.1 * size, &segments.map(|(motion, span, rise)| (motion, span, rise * size)));
            let text = format!(
                "[follower]\nmass = 1.0\ndamping = 0.1\nstiffness = 0.0\ngravity = {:?}\nrest_position = 0.0\n\
                 restitution = 0.5\n[cam]\n{cam}",
                10.0 * size
            );
            let machine = machine(&Model::parse("smooth.toml", &text).unwrap(), 1.0);
            assert_eq!(machine.rests().unwrap(), [[0.0, TAU]], "{motion} {size}");
        }
    }
}

/// Over a corner at angle 0 no stretch of rest goes on.
#[test]
fn a_stretch_of_rest_ends_at_a_corner_at_angle_0() {
    let machine = machine(&over("law = \"rectified-sine\"\noffset = 0.0\namplitude = 0.01", 0.6, -0.5), 47.0);
    assert_eq!(machine.rests().unwrap(), [[0.0, PI], [PI, TAU]]);
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

/// Where the force of contact is least on the way, a rest position that takes it up to a little above 0 keeps the follower there, and one that
/// takes it to as little below lets go of it, just before.
#[test]
fn a_force_that_only_just_vanishes_lets_go() {
    let mut looked_at = 0;
    for case in drawn(cases_of_every_law(), 400) {
        let (machine, omega) = (&case.machine, case.machine.angular_velocity());
        let stiffness = machine.flight().omega0_squared();
        let segments = machine.cam().segments();
        let segment = &segments[((case.rpm * 1e3).fract() * segments.len() as f64) as usize];
        let lifting = |angle: f64| {
            let lift = segment.law.lift(angle);
            let state = State { position: lift.value, velocity: omega * lift.slope };
            machine.flight().acceleration(state) - omega * omega * lift.curvature
        };
        let angle = |index: u32| segment.start + (segment.end - segment.start) * f64::from(index) / 2000.0;
        let most = (1..2000).max_by(|one, two| lifting(angle(*one)).total_cmp(&lifting(angle(*two)))).unwrap();
        if stiffness == 0.0 || most == 1 || most == 1999 {
            continue;
        }
        let (mut from, mut to) = (angle(most - 1), angle(most + 1));
        for _ in 0..100 {
            let (left, right) = (from + 0.382 * (to - from), from + 0.618 * (to - from));
            if lifting(left) >= lifting(right) { to = right } else { from = left }
        }
        let (at, largest) = (from, lifting(from));
        let spread = (0..=2000).map(|index| largest - lifting(angle(index))).fold(0.0, f64::max);
        // What rounding leaves of the force.
        let rounding = 1e-13
            * (spread
                + largest.abs()
                + stiffness * (segment.law.lift(at).value.abs() + case.model.follower.rest_position.abs()));
        for part in [1e-2, 1e-4, 1e-6, 1e-8] {
            let left = part * spread;
            if left < 100.0 * rounding {
                continue;
            }
            for lets_go in [true, false] {
                let mut follower = case.model.follower;
                follower.rest_position += (if lets_go { left } else { -left } - largest) / stiffness;
                let other = Machine::new(machine.cam().clone(), &follower, omega);
                let (mut motion, mut first) = (other.start_on_cam(segment.start, 0.0).unwrap(), None);
                let goal = Goal { cam_angle: at.max(segment.end.next_down()), ..motion.after(0) };
                if !motion.contact {
                    continue;
                }
                let run = other.advance(&mut motion, goal, &mut |event: &Event| {
                    first = Some(*event);
                    ControlFlow::Break(())
                });
                let said = (part, lets_go, at, run, first);
                match first {
                    Some(event) => assert!(
                        lets_go && event.kind == EventKind::Release && event.cam_angle <= at,
                        "{said:?} {case:?}"
                    ),
                    None => assert!(!lets_go && motion.contact, "{said:?} {case:?}"),
                }
                looked_at += 1;
            }
        }
    }
    assert!(looked_at > 200, "{looked_at}");
}

/// A corner that turns up throws a resting follower off by an impact and no release: what it does is an orbit like any other that rests.
#[test]
fn a_corner_that_turns_up_ends_a_rest() {
    for restitution in [0.0, 0.3, 0.8] {
        let mut model = common::read("models/laws/rectified-sine.toml".as_ref());
        let follower = &mut model.follower;
        (follower.mass, follower.damping, follower.stiffness, follower.gravity) = (1.0, 0.1, 1.0, 0.0);
        (follower.rest_position, follower.restitution) = (-50.0, restitution);
        let machine = Machine::new(common::cam(&model), &model.follower, angular_velocity(3.0));
        let found = search(&machine, &Search { revolutions: 1, impacts: None }).unwrap();
        let [orbit] = found.as_slice() else { panic!("{restitution}: {found:?}") };
        let Course::Sticking(anchor) = orbit.course else { panic!("{orbit:?}") };
        // It is told from the middle of a rest, far from both corners, also of a follower that rests as soon as it is struck.
        assert!(anchor.sin().abs() > 0.5 && orbit.residual < 1e-12, "{orbit:?}");
        let count = |kind: EventKind| orbit.events.iter().filter(|event| event.kind == kind).count();
        // At 0 and at 180 degrees.
        assert_eq!([count(EventKind::Stick), count(EventKind::Release)], [2, 0], "{orbit:?}");
        assert!(count(EventKind::Impact) >= 2, "{orbit:?}");
    }
}
