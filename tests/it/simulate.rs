//! Does the event loop find every impact, and only impacts?

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;
use std::path::Path;

use crate::common;
use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::cam::Side;
use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::simulate::{Event, EventKind, Goal, Machine, Observer, SimulateError, Variation};
use corner_impact::study::verify::{External, verify};

fn machine(model: &Model, rpm: f64) -> Machine {
    Machine::new(common::cam(model), &model.follower, rpm * TAU / 60.0)
}

/// An impact, and the angle turned up to it.
#[derive(Debug)]
struct Impact {
    turned: f64,
    event: Event,
}

fn events(machine: &Machine, angle: f64, start: State, turn: f64) -> (Result<State, SimulateError>, Vec<Event>) {
    let mut events = Vec::new();
    let end = machine.turn(angle, start, turn, |event| {
        events.push(*event);
        ControlFlow::Continue(())
    });
    (end, events)
}

fn run(machine: &Machine, angle: f64, start: State, turn: f64) -> (Result<State, SimulateError>, Vec<Impact>) {
    let (end, events) = events(machine, angle, start, turn);
    let impacts = events.into_iter().filter(|event| event.kind == EventKind::Impact);
    (end, impacts.map(|event| Impact { turned: event.turned_since(angle), event }).collect())
}

/// A ball on the dwell of a cam that hardly turns: the k-th flight takes 2 r^k v/g.
#[test]
fn a_ball_on_a_dwell_bounces_as_in_the_textbook() {
    let model = common::osorio_with(&[("stiffness", "0.0"), ("gravity", "10.0"), ("restitution", "0.5")]);
    let machine = machine(&model, 0.6);
    let omega = machine.angular_velocity();
    let (_, impacts) = run(&machine, 0.1, State { position: 0.4, velocity: 1.0 }, 0.5 * omega);
    // 0.2 + 0.1 + 0.05 + 0.025 + 0.0125 + ... s: the impacts accumulate at 0.4 s.
    let mut time = 0.0;
    for (k, impact) in impacts.iter().enumerate() {
        let speed = 0.5_f64.powi(k as i32);
        time += 2.0 * speed / 10.0;
        assert_relative_eq!(impact.turned, time * omega, max_relative = 1e-13);
        assert_relative_eq!(impact.event.velocity_before, -speed, max_relative = 1e-13);
        assert_relative_eq!(impact.event.velocity_after, 0.5 * speed, max_relative = 1e-13);
        assert_eq!((impact.event.position, impact.event.cam_velocity), (0.4, 0.0));
    }
    assert!(impacts.len() >= 15, "{}", impacts.len());
}

/// The sum of infinitely many flights is 2 v/(g (1 - r)): sticking starts there, to the last digits.
#[test]
fn infinitely_many_impacts_end_where_their_sum_ends() {
    for restitution in ["0.0", "0.5", "0.9", "0.99"] {
        let model = common::osorio_with(&[("stiffness", "0.0"), ("gravity", "10.0"), ("restitution", restitution)]);
        let machine = machine(&model, 0.6);
        let start = State { position: 0.4, velocity: 1.0 };
        let r: f64 = restitution.parse().unwrap();
        let sum = 2.0 * start.velocity / (10.0 * (1.0 - r)) * machine.angular_velocity();
        let (end, events) = events(&machine, 0.1, start, sum + 0.1);
        let stick = events.last().unwrap();
        assert_eq!(stick.kind, EventKind::Stick);
        assert_relative_eq!(stick.turned_since(0.1), sum, max_relative = 1e-13);
        assert!(events[..events.len() - 1].iter().all(|event| event.kind == EventKind::Impact));
        assert_eq!(end.unwrap(), State { position: 0.4, velocity: 0.0 });
    }
}

/// Demands that a run's flights are above the cam wherever a fine scan looks, and meet it where they are said to; up to
/// where the follower sticks. The number of impacts that it looked at.
fn scan(machine: &Machine, angle: f64, start: State, turn: f64) -> usize {
    let omega = machine.angular_velocity();
    let (end, events) = events(machine, angle, start, turn);
    let end = end.unwrap();
    let mut from = (0.0, start);
    let mut impacts = 0;
    for event in &events {
        if event.kind != EventKind::Impact {
            return impacts;
        }
        let turned = event.turned_since(angle);
        let gap = |turned: f64| {
            let position = machine.flight().fly(from.1, (turned - from.0) / omega).1.position;
            position - machine.cam().lift((angle + turned).rem_euclid(TAU)).value
        };
        let steps = (2000.0 * (turned - from.0)).clamp(50.0, 4000.0) as u32;
        for step in 1..steps {
            let on_the_way = from.0 + (turned - from.0) * f64::from(step) / f64::from(steps);
            assert!(gap(on_the_way) > -1e-14, "{omega} rad/s from {angle}: {} before {event:?}", gap(on_the_way));
        }
        assert_abs_diff_eq!(gap(turned), 0.0, epsilon = 1e-13);
        assert!(event.velocity_before <= event.cam_velocity, "{event:?} is an approach");
        from = (turned, State { position: event.position, velocity: event.velocity_after });
        impacts += 1;
    }
    // The last flight ends where the run does.
    let (_, last) = machine.flight().fly(from.1, (turn - from.0) / omega);
    assert_abs_diff_eq!(last.position, end.position, epsilon = 1e-12);
    for step in 1..4000 {
        let turned = from.0 + (turn - from.0) * f64::from(step) / 4000.0;
        let position = machine.flight().fly(from.1, (turned - from.0) / omega).1.position;
        let gap = position - machine.cam().lift((angle + turned).rem_euclid(TAU)).value;
        assert!(gap > -1e-14, "{omega} rad/s from {angle}: {gap} at {turned}, and no impact");
    }
    impacts
}

/// Every impact that a fine scan of the flight finds is found, at the same place, and no other.
#[test]
fn impacts_are_those_of_a_fine_scan() {
    for file in common::model_files() {
        let model = common::read(&file);
        let study = model.study.unwrap();
        for k in 0..6 {
            let rpm = study.rpm_min + (study.rpm_max - study.rpm_min) * f64::from(k) / 5.0;
            let machine = machine(&model, rpm);
            let angle = 0.3 + f64::from(k);
            let start = State {
                position: machine.cam().lift(angle).value + 0.02 * f64::from(k),
                velocity: machine.angular_velocity() * 0.4 + f64::from(k),
            };
            scan(&machine, angle, start, TAU);
        }
    }
}

/// A toothed cam, one segment all round: over one window the gap bends up and down many times.
#[test]
#[ignore = "slow"]
fn impacts_on_a_toothed_cam_are_those_of_a_fine_scan() {
    let mut impacts = 0;
    for (stiffness, gravity, damping) in [(400.0, 0.0, 0.0), (0.0, 9.81, 0.0), (3000.0, 1.0, 4.0), (900.0, 0.0, 80.0)] {
        let text = format!(
            "[follower]\nmass = 1.0\ndamping = {damping}\nstiffness = {stiffness}\ngravity = {gravity}\n\
             rest_position = -0.2\nrestitution = 0.7\n[cam]\nlaw = \"harmonic\"\noffset = 0.0\n\
             amplitudes = [0.02, 0.0, 0.004, 0.0, 0.0, 0.0, 0.002, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0008]\n\
             phases_deg = [0, 0, 50, 0, 0, 0, 20, 0, 0, 0, 0, 0, 70]\n"
        );
        let model = Model::parse("toothed.toml", &text).unwrap();
        for rpm in [20.0, 60.0, 150.0, 400.0, 1500.0] {
            let machine = machine(&model, rpm);
            for k in 0..40 {
                let angle = TAU * f64::from(k) / 40.0;
                let lift = machine.cam().lift(angle);
                // Leaving the cam slowly and fast, and falling on it from near and far.
                for velocity in [0.02, 0.1, 0.5, 2.0] {
                    let relative =
                        State { position: lift.value, velocity: machine.angular_velocity() * lift.slope + velocity };
                    impacts += scan(&machine, angle, relative, 0.9 * TAU);
                    let above = State { position: lift.value + 0.05 * velocity, velocity: -velocity };
                    impacts += scan(&machine, angle, above, 0.9 * TAU);
                }
            }
        }
    }
    assert!(impacts > 5000, "{impacts}");
}

/// A flight that dips 1e-12 m below the cam hits it; one that passes 1e-12 m above it does not.
#[test]
fn a_graze_is_found_however_shallow() {
    let model = common::osorio();
    let machine = machine(&model, 700.0);
    let omega = machine.angular_velocity();
    for touch in [1.9, 2.2, 2.5, 2.62] {
        let lift = machine.cam().lift(touch);
        let turned = 0.25;
        // Flown back from a tangency at `touch`, raised or lowered by `offset`.
        for offset in [1e-6, 1e-9, 1e-12, -1e-12, -1e-9, -1e-6] {
            let tangent = State { position: lift.value + offset, velocity: omega * lift.slope };
            let start = back(&machine, tangent, turned / omega);
            let (end, impacts) = run(&machine, touch - turned, start, 2.0 * turned);
            let opens = machine.flight().acceleration(tangent) > omega * omega * lift.curvature;
            if opens {
                assert_eq!(impacts.is_empty(), offset > 0.0, "{touch} {offset}: {impacts:?}");
                end.unwrap();
            }
            if let (true, Some(first)) = (offset < 0.0 && opens, impacts.first()) {
                let curvature = machine.flight().acceleration(tangent) - omega * omega * lift.curvature;
                // g = offset + curvature t^2/2: down to the cam at t = -sqrt(-2 offset/curvature).
                let expected = turned - omega * (-2.0 * offset / curvature).sqrt();
                assert_abs_diff_eq!(first.turned, expected, epsilon = 1e-9_f64.max(2e-3 * (turned - expected)));
            }
        }
    }
}

/// A follower that stands still at -h over x^2 (5 x - 1) is met where x^2 (1 - 5 x) = h, to a few roundings of lifts of 1.
#[test]
fn a_shallow_contact_is_known_to_its_digits() {
    let text = format!(
        "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 0.0\ngravity = 0.0\nrest_position = 0.0\n\
         restitution = 0.5\n[cam]\nlaw = \"polynomial\"\n\
         [[cam.segment]]\nstart_deg = 0.0\ncoefficients = [-0.875, 4.75, -8.5, 5.0]\n\
         [[cam.segment]]\nstart_deg = {:?}\ncoefficients = [0.375, {:?}]\n",
        1.0_f64.to_degrees(),
        -1.25 / (TAU - 1.0)
    );
    let machine = machine(&Model::parse("shallow.toml", &text).unwrap(), 60.0 / TAU);
    let mut worst = 0.0_f64;
    for index in 0..200 {
        let height = 10.0_f64.powf(-4.0 - 0.04 * f64::from(index));
        let mut root = -height.sqrt();
        for _ in 0..50 {
            root = -(height / (1.0 - 5.0 * root)).sqrt();
        }
        let (_, impacts) = run(&machine, 0.0, State { position: -height, velocity: 0.0 }, 0.9);
        let apart = impacts[0].turned - 0.5 - root;
        // The slope there is 2 x.
        let of_the_lift = apart * 2.0 * root;
        worst = worst.max(of_the_lift.abs());
    }
    assert!(worst < 5e-16, "{worst}");
}

/// The undamped flight reversed in time.
fn back(machine: &Machine, end: State, time: f64) -> State {
    let mirrored = machine.flight().fly(State { position: end.position, velocity: -end.velocity }, time).1;
    State { position: mirrored.position, velocity: -mirrored.velocity }
}

#[test]
fn a_run_may_be_split_anywhere() {
    let model = common::osorio();
    let machine = machine(&model, 690.0);
    let start = State { position: 5.3, velocity: 1.0 };
    let whole = run(&machine, 5.76, start, 3.0 * TAU).0.unwrap();
    for cut in [0.1, 3.0, PI, 7.7, 15.0] {
        let middle = run(&machine, 5.76, start, cut).0.unwrap();
        let end = run(&machine, (5.76 + cut) % TAU, middle, 3.0 * TAU - cut).0.unwrap();
        assert_abs_diff_eq!(end.position, whole.position, epsilon = 1e-11);
        assert_abs_diff_eq!(end.velocity, whole.velocity, epsilon = 1e-9);
    }
}

/// A turn that ends at a whole one ends there, and not a whole one before or later; so does what is turned to an angle.
#[test]
fn a_turn_may_end_at_angle_0() {
    let machine = machine(&common::osorio(), 690.0);
    let start = State { position: 5.3, velocity: 1.0 };
    let end = |turn: f64| run(&machine, PI, start, turn).0.unwrap();
    assert_eq!(end(0.0), start);
    for (whole, more) in [(0.0, 1.0), (TAU, 1.0 + TAU)] {
        let (at_0, before, after) = (end(PI + whole), end(PI.next_down() + whole), end(PI + more));
        assert_abs_diff_eq!(at_0.position, before.position, epsilon = 1e-11);
        let mut motion = machine.start(PI, start).unwrap();
        if whole > 0.0 {
            machine.revolve(&mut motion, 1).unwrap();
        }
        machine.turn_to(&mut motion, 0.0).unwrap();
        assert_eq!((motion.cam_angle, motion.revolution), (0.0, 1 + u64::from(whole > 0.0)));
        assert_abs_diff_eq!(motion.state.position, at_0.position, epsilon = 1e-11);
        machine.turn_to(&mut motion, 1.0).unwrap();
        assert_abs_diff_eq!(motion.state.position, after.position, epsilon = 1e-9);
        assert!((at_0.position - after.position).abs() > 1e-3);
    }
}

#[test]
fn an_observer_ends_the_run() {
    let model = common::osorio();
    let found = verify(&model, External::LeftOut).unwrap();
    let machine = machine(&model, found.at.speed_rpm());
    let end = machine.turn(found.at.section_angle(), found.at.state, TAU, |_| ControlFlow::Break(())).unwrap();
    assert_abs_diff_eq!(end.velocity, found.at.velocity_after, epsilon = 1e-9);
    assert_abs_diff_eq!(end.position, found.at.corner.plus.value, epsilon = 1e-12);
}

#[test]
fn starts_that_cannot_be_are_refused() {
    let model = common::osorio();
    let machine = machine(&model, 700.0);
    match run(&machine, 0.5, State { position: 0.39, velocity: 0.0 }, 1.0).0 {
        Err(SimulateError::BelowCam { depth, cam_angle, .. }) => {
            assert_relative_eq!(depth, 0.01, max_relative = 1e-12);
            assert_eq!(cam_angle, 0.5);
        }
        other => panic!("{other:?}"),
    }
    for (position, velocity) in [(f64::NAN, 0.0), (f64::INFINITY, 0.0), (0.5, f64::NAN), (0.5, f64::NEG_INFINITY)] {
        let start = machine.start(0.5, State { position, velocity });
        assert!(matches!(start, Err(SimulateError::NotFinite { cam_angle: 0.5, .. })), "{start:?}");
    }
    let start = State { position: 0.5, velocity: 0.0 };
    for angle in [-0.1, TAU, f64::NAN] {
        assert!(matches!(machine.start(angle, start), Err(SimulateError::Start { .. })), "{angle}");
        assert!(matches!(machine.start_on_cam(angle, 0.0), Err(SimulateError::Start { .. })), "{angle}");
    }
    for turn in [-0.1, f64::NAN, f64::INFINITY] {
        assert!(matches!(run(&machine, 0.5, start, turn).0, Err(SimulateError::Turn { .. })), "{turn}");
    }
    for speed in [-1.0, 0.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(machine.at_speed(speed).start(0.5, start), Err(SimulateError::Turn { .. })), "{speed}");
    }
}

#[test]
fn a_perfectly_elastic_and_a_perfectly_plastic_follower() {
    let elastic = machine(&common::osorio_with(&[("restitution", "1.0")]), 700.0);
    let (end, impacts) = run(&elastic, 0.3, State { position: 0.45, velocity: 0.0 }, 2.2);
    end.unwrap();
    for impact in &impacts {
        assert_relative_eq!(
            impact.event.velocity_after - impact.event.cam_velocity,
            impact.event.cam_velocity - impact.event.velocity_before,
            max_relative = 1e-12
        );
    }
    assert!(!impacts.is_empty());
    let plastic = machine(&common::osorio_with(&[("restitution", "0.0")]), 700.0);
    let (end, impacts) = run(&plastic, 0.3, State { position: 0.45, velocity: 0.0 }, 2.2);
    assert_eq!(impacts.len(), 1);
    assert_eq!(impacts[0].event.velocity_after, impacts[0].event.cam_velocity);
    assert_eq!(end.unwrap().position, plastic.cam().lift(2.5).value);
}

/// Where segments meet at lift 0, or at one typed to ten digits, what the two laws differ by is no step, in any unit: neither a follower
/// that sticks nor one that flies close by is told that it is below the cam.
#[test]
fn a_cam_that_closes_to_its_digits_is_closed() {
    for size in [1.0, 1000.0] {
        // A parabola over the first half, the next digit of its lift at the end, and down again.
        for end in [0.0, 0.3000000001, 0.2999999999] {
            let scaled = |number: f64| number * size;
            let text = format!(
                "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 0.0\ngravity = {:?}\nrest_position = 0.0\n\
                 restitution = 0.5\n[cam]\nlaw = \"polynomial\"\n\
                 [[cam.segment]]\nstart_deg = 26.9\ncoefficients = {:?}\n\
                 [[cam.segment]]\nstart_deg = 206.9\ncoefficients = {:?}\n",
                scaled(9.81),
                [0.0, (if end > 0.0 { 0.3 } else { 0.0 }) / PI + PI * (0.3 + 0.1 * PI), -0.3, -0.1].map(scaled),
                [end, -end / PI + PI * (0.3 - 0.1 * PI), -0.3, 0.1].map(scaled)
            );
            let machine = machine(&Model::parse("closed.toml", &text).unwrap(), 0.001);
            let angle = 206.9_f64.to_radians() - 1e-12;
            let motion = machine.start_on_cam(3.0, 0.0).unwrap();
            assert!(motion.contact);
            for height in [0.0, 1e-12, 2e-11, 1e-9] {
                // At rest on the cam, or so close above it that it comes down at the joint, or on its way up from there.
                for rises in [0.0, 1e-9, 1e-6, 1e-3] {
                    let lift = machine.cam().lift(angle);
                    let velocity = machine.angular_velocity() * lift.slope + scaled(rises);
                    let start = State { position: lift.value + scaled(height), velocity };
                    let end = run(&machine, angle, start, TAU).0;
                    end.unwrap_or_else(|error| panic!("{size}, {height} m, {rises} m/s: {error}"));
                }
            }
        }
    }
}

/// An impact at a whole turn is one at angle 0: for the observer, for the motion that is stopped there, and for the one
/// whose goal is there; what the corner does then is not lost.
#[test]
fn an_impact_at_a_whole_turn_is_at_angle_0() {
    let text = "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 1000.0\ngravity = 0.0\nrest_position = 0.0\n\
                restitution = 0.0\n[cam]\nlaw = \"rectified-sine\"\noffset = 0.0\namplitude = 1.0\n";
    let machine = machine(&Model::parse("turn.toml", text).unwrap(), 1e-9);
    for stop in [true, false] {
        let mut motion = machine.start_on_cam(0.0, 0.0).unwrap();
        let mut at_0 = 0;
        for revolution in 1..=4 {
            let goal = Goal { revolution, cam_angle: 0.0 };
            while (motion.revolution, motion.cam_angle) < (revolution, 0.0) {
                let _ = machine
                    .advance(&mut motion, goal, &mut |event: &Event| {
                        assert!((0.0..TAU).contains(&event.cam_angle), "{event:?}");
                        at_0 += u32::from(event.kind == EventKind::Impact && event.cam_angle == 0.0);
                        if stop { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
                    })
                    .unwrap();
                assert!((0.0..TAU).contains(&motion.cam_angle), "{motion:?}");
            }
        }
        // Carried down and kicked up once a revolution, in the last instant or in the first of the next run.
        assert!(at_0 >= 3, "{at_0}");
    }
}

/// What an impact at a whole turn does to a deviation, the end of its segment decides, and not the segment's law a turn before.
#[test]
fn an_impact_at_a_whole_turn_is_carried_on_from_the_end_of_its_segment() {
    let machine = machine(&common::read(Path::new("models/laws/program.toml")), 670.0);
    let segment = machine.cam().segments().len() - 1;
    let matrix = |cam_angle: f64| {
        let lift = machine.cam().segments()[segment].law.lift(TAU);
        let cam_velocity = machine.angular_velocity() * lift.slope;
        let (velocity_before, velocity_after) = (cam_velocity - 1.0, cam_velocity + 0.8);
        let (kind, position) = (EventKind::Impact, lift.value);
        let event =
            Event { kind, revolution: 1, cam_angle, position, velocity_before, velocity_after, cam_velocity, segment };
        let mut variation = Variation::new(&machine, &machine.start_on_cam(0.0, 1.0).unwrap());
        let _ = variation.event(&event);
        variation.matrix()
    };
    assert_relative_eq!(matrix(0.0), matrix(TAU.next_down()), max_relative = 1e-12);
}

/// An overdamped follower has come to rest far above the lowest point of the cam when that passes under it: there the gap
/// hardly changes, which is no contact.
#[test]
fn a_gap_that_hardly_changes_is_no_contact() {
    let text = "[follower]\nrest_position = 0.21079897832828612\nmass = 0.2798945362602364\ndamping = 396.8274379876629\n\
                stiffness = 63.11216516375282\ngravity = 11.197473414932588\nrestitution = 0.0\n\
                [cam]\nlaw = \"program\"\nbase = 0.18730873583238372\n\
                [[cam.segment]]\nmotion = \"parabolic\"\nspan_deg = 72.0\nrise = -0.2\n\
                [[cam.segment]]\nmotion = \"parabolic\"\nspan_deg = 288.0\nrise = 0.2\n";
    let machine = machine(&Model::parse("rest.toml", text).unwrap(), 0.03678030500275241);
    let start = State { position: machine.cam().lift(0.0).value, velocity: 0.0 };
    let (end, impacts) = run(&machine, 0.0, start, TAU);
    end.unwrap();
    // It settles at 0.161 m, 0.17 m above the lowest point; the cam comes up to it again in the second half.
    for Impact { turned, event } in impacts {
        assert!(turned > PI && event.position > 0.1, "{event:?}");
    }
}

/// At a graze that rounding makes a contact of, the follower still comes down: one that moves away already would be thrown
/// into the cam.
#[test]
fn a_follower_that_moves_away_is_not_hit() {
    let text = "[follower]\nrest_position = 0.8086010220201013\nmass = 9.606224356706088\ndamping = 0.0\n\
                stiffness = 43.83745378635442\ngravity = -1.0\nrestitution = 0.0\n\
                [cam]\nlaw = \"arcs\"\nbase_radius = 0.806906262403807\nflank_radius = 1.6474476824952322\n\
                nose_radius = 0.2865811425529196\nflank_start_deg = 111.46156407317888\n\
                nose_end_deg = 121.46156407317888\n";
    let machine = machine(&Model::parse("graze.toml", text).unwrap(), 0.09181440618078734);
    let start = State { position: machine.cam().lift(0.0).value, velocity: 0.0 };
    let (end, impacts) = run(&machine, 0.0, start, 20.0 * TAU);
    end.unwrap();
    assert!(impacts.len() > 10, "{}", impacts.len());
    for Impact { event, .. } in impacts {
        assert!(event.velocity_before < event.cam_velocity, "{event:?}");
    }
}

/// Past the corner the continued cam is the law of one side, before it the cam as it was.
#[test]
fn a_continued_cam_keeps_one_law_past_the_corner() {
    let cam = common::cam(&common::osorio());
    let corner = cam.corners()[1];
    let reach = 0.05;
    let (flank, nose) = (&cam.segments()[1].law, &cam.segments()[2].law);
    let minus = cam.continued(&corner, Side::Minus, reach).unwrap();
    let plus = cam.continued(&corner, Side::Plus, reach).unwrap();
    for (offset, on_minus, on_plus) in
        [(-0.06, flank, flank), (-0.04, flank, nose), (0.04, flank, nose), (0.06, nose, nose)]
    {
        let angle = corner.angle + offset;
        assert_eq!(minus.lift(angle), on_minus.lift(angle));
        assert_eq!(plus.lift(angle), on_plus.lift(angle));
    }
    // The nose spans 9.8 degrees: it cannot give way by more than half.
    assert!(cam.continued(&corner, Side::Minus, 0.09).is_none());
    // The nose circle, continued backwards, ends where its tangent runs through the axis.
    assert!(cam.continued(&corner, Side::Plus, 0.4).is_none());
}

/// The impact of a settled motion is the same to an ulp or two after two million revolutions as after two thousand.
#[test]
#[ignore = "slow"]
fn no_digit_is_lost_to_the_number_of_revolutions() {
    let model = common::osorio();
    let machine = machine(&model, 700.0);
    let mut motion = machine.start(5.76, State { position: 2.7, velocity: 3.4 }).unwrap();
    let mut last = None;
    let mut after = |revolutions: u64| {
        let goal = motion.after(revolutions);
        let _ = machine.advance(&mut motion, goal, &mut |event: &Event| {
            last = Some(*event);
            ControlFlow::Continue(())
        });
        last.unwrap()
    };
    let (early, late) = (after(2000), after(2_000_000));
    assert_abs_diff_eq!(early.cam_angle, late.cam_angle, epsilon = 2e-15);
    assert_relative_eq!(early.velocity_after, late.velocity_after, max_relative = 1e-13, epsilon = 0.0);
    assert_eq!(late.revolution - early.revolution, 2_000_000);
}

/// A settled motion's shortcut finds what the general way finds: a run that is stopped at every revolution never takes it.
#[test]
fn one_turn_on_is_where_the_search_finds_it() {
    let model = common::osorio();
    for rpm in [680.0, 700.0, 720.0] {
        let machine = machine(&model, rpm);
        let (mut whole, mut stopped) = (Vec::new(), Vec::new());
        let start = State { position: 5.397, velocity: 0.0 };
        let mut motion = machine.start(5.76, start).unwrap();
        let goal = motion.after(1500);
        let _ = machine.advance(&mut motion, goal, &mut |event: &Event| {
            whole.push(*event);
            ControlFlow::Continue(())
        });
        let mut motion = machine.start(5.76, start).unwrap();
        for _ in 0..1500 {
            let goal = motion.after(1);
            let _ = machine.advance(&mut motion, goal, &mut |event: &Event| {
                stopped.push(*event);
                ControlFlow::Continue(())
            });
        }
        // The way to the orbit may be chaotic; on it, both are the same.
        for (one, other) in whole.iter().rev().zip(stopped.iter().rev()).take(500) {
            assert_eq!(one.revolution, other.revolution);
            assert_abs_diff_eq!(one.cam_angle, other.cam_angle, epsilon = 1e-13);
            assert_abs_diff_eq!(one.velocity_before, other.velocity_before, epsilon = 1e-11);
        }
    }
}
