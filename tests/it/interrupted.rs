//! Is a run that is stopped to be looked at the run that it would have been, and is a follower inside the cam an error?

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::flight::{Flight, State};
use corner_impact::model::Model;
use corner_impact::simulate::{
    Event, EventKind, Goal, ImpactTally, Machine, Motion, Observer, SimulateError, Work, angular_velocity,
};
use corner_impact::tolerance;

use crate::common;
use crate::settling::enlarged;

fn machine(model: &Model, rpm: f64) -> Machine {
    Machine::new(common::cam(model), &model.follower, angular_velocity(rpm))
}

/// All that a run shows.
#[derive(Default)]
struct Seen {
    events: Vec<Event>,
    /// Of flights up to each event, s.
    times: Vec<f64>,
    time: f64,
    /// Where the stretch of flight before ended, if nothing has happened since.
    end: Option<State>,
    /// How far a stretch began from there, m and m/s.
    torn: f64,
    stretches: usize,
    work: Work,
}

impl Observer for Seen {
    const COUNTS: bool = true;

    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        self.events.push(*event);
        self.times.push(self.time);
        self.end = None;
        ControlFlow::Continue(())
    }

    fn flight(&mut self, flight: &Flight, from: State, time: f64) {
        if let Some(end) = self.end {
            let apart = (end.position - from.position).abs().max((end.velocity - from.velocity).abs());
            self.torn = self.torn.max(apart);
        }
        self.end = Some(flight.fly(from, time).1);
        self.time += time;
        self.stretches += 1;
    }

    fn work(&mut self, work: Work) {
        self.work.gaps += work.gaps;
        self.work.steps += work.steps;
        self.work.marches += work.marches;
        self.work.repeats += work.repeats;
    }
}

/// Runs `motion` from goal to goal, and to the last once more.
fn run(machine: &Machine, mut motion: Motion, goals: &[Goal]) -> (Motion, Seen) {
    let mut seen = Seen::default();
    for goal in goals {
        let _ = machine.advance(&mut motion, *goal, &mut seen).unwrap();
        assert_eq!((motion.revolution, motion.cam_angle), (goal.revolution, goal.cam_angle));
    }
    (motion, seen)
}

fn goal(turned: f64) -> Goal {
    Goal { revolution: (turned / TAU) as u64, cam_angle: turned % TAU }
}

/// Runs that fly high, settle, or chatter and stick, stopped often, also within a ten-millionth of a turn before infinitely many impacts
/// end: the same events to the last bit, after flights as long, that go on where they were left, with as much work as without a stop.
#[test]
fn a_run_that_is_stopped_is_the_same_run() {
    let paper = common::osorio();
    let mut in_chatter = 0;
    for (rpm, angle, start, revolutions) in [
        (690.0, 5.76, State { position: 5.3, velocity: 1.0 }, 12.0),
        (671.0, 1.0, State { position: 2.0, velocity: 0.0 }, 12.0),
        (183.0, 1.0, State { position: 0.9, velocity: 3.0 }, 6.0),
        (175.0, 1.0, State { position: 0.9, velocity: 3.0 }, 6.0),
        (90.0, 1.0, State { position: 0.9, velocity: 0.0 }, 3.0),
    ] {
        let machine = machine(&paper, rpm);
        let start = machine.start(angle, start).unwrap();
        let end = angle + TAU * revolutions;
        let (last, whole) = run(&machine, start, &[goal(end)]);
        assert!(whole.events.len() >= 3 && whole.torn < 1e-9, "{rpm}: {} {}", whole.events.len(), whole.torn);
        let sticks: Vec<f64> = whole
            .events
            .iter()
            .filter(|event| event.kind == EventKind::Stick)
            .map(|event| event.turned_since(0.0))
            .collect();
        for stops in [7, 40, 333] {
            let mut turned: Vec<f64> =
                (1..=stops).map(|stop| angle + (end - angle) * f64::from(stop) / f64::from(stops)).collect();
            turned.extend(sticks.iter().flat_map(|stick| [5e-8, 3e-8, 1e-8].map(|before| stick - before)));
            in_chatter += sticks.len();
            turned.retain(|turned| *turned < end);
            turned.sort_by(f64::total_cmp);
            let goals: Vec<Goal> = turned.into_iter().map(goal).chain([goal(end)]).collect();
            let (stopped, seen) = run(&machine, start, &goals);
            assert_eq!(seen.events, whole.events, "{rpm} rpm, {stops} stops");
            assert_eq!(stopped.state, last.state, "{rpm} rpm, {stops} stops");
            assert_eq!(seen.work, whole.work, "{rpm} rpm, {stops} stops");
            for (one, other) in seen.times.iter().zip(&whole.times) {
                assert_abs_diff_eq!(one, other, epsilon = 1e-12);
            }
            assert_abs_diff_eq!(seen.time, whole.time, epsilon = 1e-12);
            assert!(seen.torn < 1e-9, "{rpm} rpm, {stops} stops: {}", seen.torn);
            assert!(seen.stretches > whole.stretches, "{rpm} rpm, {stops} stops: each is seen in parts");
        }
    }
    assert!(in_chatter > 10, "{in_chatter}");
}

/// A run to where it is already shows nothing more, in the middle of a flight as well.
#[test]
fn a_run_to_where_it_is_shows_nothing() {
    let machine = machine(&common::osorio(), 690.0);
    let start = machine.start(5.76, State { position: 5.3, velocity: 1.0 }).unwrap();
    for turned in [6.0, 7.0, 9.0, 20.0] {
        let (once, first) = run(&machine, start, &[goal(turned)]);
        let (again, seen) = run(&machine, start, &[goal(turned); 3]);
        assert!(first.stretches > 0);
        assert_eq!((seen.stretches, seen.events.len(), seen.work), (first.stretches, first.events.len(), first.work));
        assert_eq!(again.state, once.state);
    }
}

/// Stopped right after it has left the cam, the gap has digits of its own, `u t + (a - w^2 c'') t^2/2`, far more than two positions have;
/// stopped over another segment, it is the difference of both positions.
#[test]
fn a_stopped_motion_shows_its_gap() {
    let machine = machine(&common::osorio(), 690.0);
    let (omega, angle, rebound) = (machine.angular_velocity(), 1.8, 1.0);
    let start = machine.start_on_cam(angle, rebound).unwrap();
    let acceleration = machine.flight().acceleration(start.state) - omega * omega * machine.cam().lift(angle).curvature;
    for index in 1..=20 {
        let turned = angle + 1e-9 * f64::from(index);
        let (motion, _) = run(&machine, start, &[goal(turned)]);
        let time = (turned - angle) / omega;
        let gap = time * (rebound + 0.5 * acceleration * time);
        assert_relative_eq!(machine.gap(&motion), gap, max_relative = 1e-12);
    }
    let start = machine.start_on_cam(angle, 5.0).unwrap();
    for index in 1..60 {
        let (motion, _) = run(&machine, start, &[goal(angle + 0.1 * f64::from(index))]);
        let expected = motion.state.position - machine.cam().lift(motion.cam_angle).value;
        assert_abs_diff_eq!(machine.gap(&motion), expected, epsilon = 1e-13);
    }
}

/// A start that is below the cam by two roundings of its position is on it, whatever the size of the cam, and by a hundred it is inside.
#[test]
fn a_start_below_the_cam_by_rounding_alone_is_on_it() {
    for power in [-20, -12, 0, 12, 20] {
        let machine = machine(&enlarged(power), 100.0);
        for angle in [0.3, 1.9, 3.0, 4.0] {
            let lift = machine.cam().lift(angle);
            let velocity = machine.angular_velocity() * lift.slope;
            let below = |roundings: f64| {
                machine.start(angle, State { position: lift.value * (1.0 - roundings * f64::EPSILON), velocity })
            };
            assert!(below(2.0).is_ok_and(|motion| motion.contact), "2^{power}, {angle}");
            assert!(matches!(below(100.0), Err(SimulateError::BelowCam { .. })), "2^{power}, {angle}");
        }
    }
}

/// A follower that is put below the cam in its flight has passed through it when the next segment is shown, if it is deeper than 256
/// roundings of its position and the cam's largest lift, in any unit; the error says how deep, where, and at which speed.
#[test]
fn a_flight_inside_the_cam_is_an_error_with_its_state_and_speed() {
    let ulps = tolerance::PASSED_THROUGH.value / f64::EPSILON;
    assert_eq!(ulps, 256.0);
    for power in [-12, 0, 12] {
        let size = 2.0_f64.powi(power);
        let machine = machine(&enlarged(power), 700.0);
        let largest = machine.cam().highest().value;
        let (mut passed, mut borne) = (0, 0);
        for segment in machine.cam().segments().iter().filter(|segment| segment.end < 6.0) {
            let end = segment.end;
            let near = f64::EPSILON * end;
            let start = machine.start_on_cam(end - near, 100.0 * size).unwrap();
            let most = ulps * f64::EPSILON * (start.state.position + largest);
            for (share, passes) in [(0.5, false), (0.9, false), (1.1, true), (2.0, true), (1e9, true)] {
                let mut motion = start;
                motion.state.position -= share * most;
                let goal = Goal { cam_angle: end + near, ..motion.after(0) };
                match machine.advance(&mut motion, goal, &mut |_: &Event| ControlFlow::Continue(())) {
                    Err(SimulateError::PassedThrough { depth, revolution, cam_angle, position, velocity, rpm }) => {
                        assert!(passes, "2^{power}, {end}: {share}");
                        assert!((depth - share * most).abs() < 0.05 * most, "{depth:e} {share}");
                        assert_eq!((revolution, cam_angle, position), (0, goal.cam_angle, motion.state.position));
                        assert_relative_eq!(velocity, start.state.velocity, max_relative = 1e-9);
                        assert_relative_eq!(rpm, 700.0, max_relative = 1e-12);
                        passed += 1;
                    }
                    told => {
                        assert!(!passes && told.is_ok(), "2^{power}, {end}: {share}: {told:?}");
                        borne += 1;
                    }
                }
            }
        }
        assert!(passed >= 9 && borne >= 6, "2^{power}: {passed} {borne}");
    }
}

fn over(follower: &str, cam: &str) -> Model {
    Model::parse("over.toml", &format!("[follower]\nmass = 1.0\n{follower}\n[cam]\n{cam}\n")).unwrap()
}

/// `c = h (1 - cos(4 (theta - pi/3)))/2` catches a follower that is above it and rises as fast as the rise is in the mean, although it would
/// rise above all of the cam: the first impact is where both closed forms first have one height.
#[test]
fn a_cam_catches_a_follower_that_would_rise_above_it() {
    let segment = |motion: &str, span: f64, rise: f64| {
        format!("[[cam.segment]]\nmotion = \"{motion}\"\nspan_deg = {span:?}\nrise = {rise:?}\n")
    };
    let pieces = [
        segment("dwell", 60.0, 0.0),
        segment("harmonic", 45.0, 0.1),
        segment("dwell", 60.0, 0.0),
        segment("harmonic", 195.0, -0.1),
    ];
    let follower = "damping = 0.0\nstiffness = 0.0\ngravity = 9.81\nrest_position = 0.0\nrestitution = 0.5";
    let model = over(follower, &format!("law = \"program\"\nbase = 0.05\n{}", pieces.concat()));
    let machine = machine(&model, 3000.0);
    let omega = machine.angular_velocity();
    let (from, span) = (TAU / 6.0, TAU / 8.0);
    let mean = 0.1 * omega / span;
    for share in [1.0, 1.05, 1.1] {
        let (gap, velocity) = (1e-4, share * mean);
        let fall = |turn: f64| {
            let time = turn / omega;
            gap + velocity * time - 0.5 * 9.81 * time * time - 0.05 * (1.0 - (4.0 * turn).cos())
        };
        let step = span / 10_000.0;
        let first = (1..10_000).map(|index| step * f64::from(index)).find(|turn| fall(*turn) < 0.0).unwrap();
        let start = machine.start(from, State { position: 0.05 + gap, velocity }).unwrap();
        let (_, seen) = run(&machine, start, &[goal(from + span)]);
        let impact = seen.events[0];
        assert_eq!(impact.kind, EventKind::Impact);
        assert!(
            first - step - 1e-12 <= impact.cam_angle - from && impact.cam_angle - from <= first,
            "{share}: {impact:?} {first}"
        );
    }
}

/// A run that ends where the cam lets go of the follower to the last bit leaves that to the run that goes on from there.
#[test]
fn a_release_in_the_last_instant_is_left_to_the_next_run() {
    let cam = "law = \"harmonic\"\noffset = 0.0\namplitudes = [0.1]\nphases_deg = [180.0]";
    let follower = "damping = 0.0\nstiffness = 100.0\ngravity = 9.0\nrest_position = -0.05\nrestitution = 0.5";
    for rpm in [160.0, 190.0, 300.0] {
        let machine = machine(&over(follower, cam), rpm);
        let start = machine.start_on_cam(0.0, 0.0).unwrap();
        assert!(start.contact);
        let (_, whole) = run(&machine, start, &[start.after(1)]);
        let release = whole.events[0];
        assert!(release.kind == EventKind::Release && release.revolution == 0 && release.cam_angle > 1.0);
        let (motion, seen) = run(&machine, start, &[goal(release.cam_angle)]);
        assert!(motion.contact && seen.events.is_empty(), "{rpm}: {:?}", seen.events);
        let (_, seen) = run(&machine, start, &[goal(release.cam_angle), start.after(1)]);
        assert_eq!(seen.events, whole.events);
    }
}

/// Where the spring carries the weight but for rounding, nothing lifts the follower off a dwell at height 0.
#[test]
fn rounding_of_a_weight_that_is_carried_lifts_nothing() {
    let mut lifted = 0;
    for index in 1..300_u32 {
        let (gravity, stiffness) = (9.0 + 0.37 * f64::from(index), 30.0 + 1.7 * f64::from(index * 7 % 97));
        let rest = gravity / stiffness;
        if rest * stiffness - gravity <= 0.0 {
            continue;
        }
        lifted += 1;
        let follower = format!(
            "damping = 0.0\nstiffness = {stiffness:?}\ngravity = {gravity:?}\nrest_position = {rest:?}\nrestitution = 0.5"
        );
        let cam = "law = \"program\"\nbase = 0.0\n\
                   [[cam.segment]]\nmotion = \"dwell\"\nspan_deg = 180.0\nrise = 0.0\n\
                   [[cam.segment]]\nmotion = \"cycloidal\"\nspan_deg = 90.0\nrise = 0.01\n\
                   [[cam.segment]]\nmotion = \"cycloidal\"\nspan_deg = 90.0\nrise = -0.01\n";
        let machine = machine(&over(&follower, cam), 1.0);
        assert!(machine.start_on_cam(1.0, 0.0).unwrap().contact, "{gravity} {stiffness}");
    }
    assert!(lifted > 10, "{lifted}");
}

/// Of two stretches of a run there are as many impacts as in both, and the fastest is that of either.
#[test]
fn impacts_of_two_stretches_are_those_of_both() {
    let [one, two] = [(3, 2.0), (4, 1.0)].map(|(impacts, impact_speed)| ImpactTally { impacts, impact_speed });
    assert_eq!(one.with(two), ImpactTally { impacts: 7, impact_speed: 2.0 });
    assert_eq!(two.with(one), ImpactTally { impacts: 7, impact_speed: 2.0 });
}
