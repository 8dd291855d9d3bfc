//! Does every run obey the laws, whatever the model and the start?
//!
//! The cases are the same in every run. `PROPTEST_CASES=100000 PROPTEST_RNG_SEED=7` looks at others.
#![allow(clippy::unwrap_used, clippy::panic)]

#[path = "properties/random.rs"]
mod random;

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::mpsc;
use std::time::Duration;

use corner_impact::flight::{Flight, State};
use corner_impact::simulate::{Event, EventKind, Goal, Motion, Observer, SimulateError};

use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestCaseResult, TestRunner};
use random::{Case, cases};

/// Rounding of a number that a dozen operations made.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Asks `holds` of `count` cases, or as many as the environment says.
#[track_caller]
fn check(count: u32, holds: fn(&Case) -> TestCaseResult) {
    let is_set = |name: &str| std::env::var_os(name).is_some();
    let config = Config::default();
    let config = Config {
        cases: if is_set("PROPTEST_CASES") { config.cases } else { count },
        rng_seed: if is_set("PROPTEST_RNG_SEED") { config.rng_seed } else { RngSeed::Fixed(1) },
        failure_persistence: None,
        max_shrink_time: 60_000,
        ..config
    };
    let result = TestRunner::new(config).run(&cases(), move |case| in_time(case, holds));
    if let Err(error) = result {
        panic!("{error}");
    }
}

/// A run of a few thousand events that takes this long makes no progress.
const PATIENCE: Duration = Duration::from_secs(20);

fn in_time(case: Case, holds: fn(&Case) -> TestCaseResult) -> TestCaseResult {
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || sender.send(holds(&case)));
    let late = |error| TestCaseError::fail(format!("no end after {PATIENCE:?}, or a panic: {error}"));
    receiver.recv_timeout(PATIENCE).unwrap_or_else(|error| Err(late(error)))
}

/// All that a run shows, up to a number of events.
#[derive(Default)]
struct Log {
    events: Vec<Event>,
    flights: Vec<(State, f64)>,
}

/// Most events that one case is followed through.
const EVENTS: usize = 300;

impl Observer for Log {
    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        self.events.push(*event);
        if self.events.len() >= EVENTS { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn flight(&mut self, _: &Flight, from: State, time: f64) {
        self.flights.push((from, time));
    }
}

/// The goal `turn`, rad, after the start.
fn goal(motion: &Motion, turn: f64) -> Goal {
    let angle = motion.cam_angle + turn % TAU;
    let revolution = motion.revolution + (turn / TAU).floor() as u64 + u64::from(angle >= TAU);
    Goal { revolution, cam_angle: if angle >= TAU { angle - TAU } else { angle } }
}

/// How far rounding moves lift, slope and curvature of a segment, m/rad^k.
///
/// The 4-5-6-7 motion sums terms of 35, 84, 70 and 20 rises; its derivatives those of 4, 5, 6, 7 and 12, 20, 30, 42 times
/// the rise over a power of the span.
fn noise(case: &Case, segment: usize) -> [f64; 3] {
    let segment = &case.machine.cam().segments()[segment];
    let span = segment.end - segment.start;
    [209.0, 1120.0 / span, 5040.0 / (span * span)].map(|terms| 4.0 * f64::EPSILON * terms * case.stroke)
}

/// How far rounding moves the follower over the cam, m, `time`, s, after the last event: of the two positions, and of the
/// angle that both are taken at.
fn blur(case: &Case, angle: f64, state: State, time: f64) -> f64 {
    let (cam, omega) = (case.machine.cam(), case.machine.angular_velocity());
    let lift = cam.lift(angle);
    let slopes = lift.slope.abs() + (state.velocity / omega).abs();
    let [of_the_lift, ..] = noise(case, cam.segment_at(angle));
    of_the_lift + ROUNDING * (state.position.abs() + lift.value.abs() + (TAU + omega * time) * slopes)
}

/// The only ways in which a run may end early. None of these starts is below its cam, and no law has a step.
fn only_no_progress(case: &Case, error: SimulateError) -> TestCaseResult {
    match error {
        SimulateError::NoProgress { events, cam_angle, .. } => {
            prop_assert!(events > 100_000 && (0.0..=TAU).contains(&cam_angle), "{error:?}");
            Ok(())
        }
        _ => Err(TestCaseError::fail(format!("{error}: {case:?}"))),
    }
}

/// m(w^2 c'' - a) over m, m/s^2: what presses a follower that goes with the cam against it; and its
/// rounding.
fn pressing(case: &Case, segment: usize, angle: f64) -> (f64, f64) {
    let machine = &case.machine;
    let lift = machine.cam().segments()[segment].law.lift(angle);
    let (omega, flight) = (machine.angular_velocity(), machine.flight());
    let state = State { position: lift.value, velocity: omega * lift.slope };
    let cam = omega * omega * lift.curvature;
    let terms = flight.force(lift.value).abs() + flight.omega0_squared() * lift.value.abs()
        + 2.0 * flight.zeta() * state.velocity.abs()
        + cam.abs()
        // Both are taken at an angle that is rounded itself.
        + TAU * (omega * omega * lift.third.abs() + flight.omega0_squared() * lift.slope.abs()
            + 2.0 * flight.zeta() * omega * lift.curvature.abs());
    let [value, slope, curvature] = noise(case, segment);
    let of_the_law = flight.omega0_squared() * value + 2.0 * flight.zeta() * omega * slope + omega * omega * curvature;
    (cam - flight.acceleration(state), ROUNDING * terms + of_the_law)
}

/// Looked at 500 times in 5 revolutions, the follower is over the cam or sticks to it, and the cam does not pull.
#[test]
fn the_follower_is_never_below_the_cam_and_the_cam_never_pulls() {
    check(2000, |case| {
        let (machine, mut motion) = (&case.machine, case.motion().unwrap());
        let (first, mut log) = (motion, Log::default());
        let omega = machine.angular_velocity();
        let mut last = 0.0;
        for index in 1..=500 {
            let turn = 5.0 * TAU * f64::from(index) / 500.0;
            let before = log.events.len();
            let flow = match machine.advance(&mut motion, goal(&first, turn), &mut log) {
                Ok(flow) => flow,
                Err(error) => return only_no_progress(case, error),
            };
            if flow.is_break() {
                return Ok(());
            }
            if log.events.len() > before {
                last = turn;
            }
            let lift = machine.cam().lift(motion.cam_angle);
            let blur = blur(case, motion.cam_angle, motion.state, (turn - last) / omega + TAU / omega / 500.0);
            let gap = motion.state.position - lift.value;
            prop_assert!(gap >= -blur, "{gap} m at {turn} rad, {blur}: {motion:?}");
            prop_assert!((machine.gap(&motion) - gap).abs() <= blur, "{} is not {gap}", machine.gap(&motion));
            if motion.contact {
                let velocity = motion.state.velocity - omega * lift.slope;
                let [_, of_the_slope, _] = noise(case, machine.cam().segment_at(motion.cam_angle));
                let rounding = omega * (of_the_slope + ROUNDING * lift.slope.abs());
                prop_assert!(gap.abs() <= blur && velocity.abs() <= rounding, "sticks at {turn} rad: {motion:?}");
                let (force, rounding) = pressing(case, machine.cam().segment_at(motion.cam_angle), motion.cam_angle);
                prop_assert!(force >= -rounding, "pulls with {force}, {rounding}, at {turn} rad: {motion:?}");
            }
        }
        Ok(())
    });
}

/// Impacts are on the cam, turn the relative velocity round and scale it by r, and come one after the other; a follower
/// that sticks has the cam's velocity; the cam lets go where it no longer presses or where it has a corner.
#[test]
fn events_obey_their_laws() {
    check(4000, |case| {
        let (machine, mut motion) = (&case.machine, case.motion().unwrap());
        let (mut log, r, omega) = (Log::default(), machine.restitution(), machine.angular_velocity());
        let mut sticks = motion.contact;
        let goal = motion.after(20);
        if let Err(error) = machine.advance(&mut motion, goal, &mut log) {
            only_no_progress(case, error)?;
        }
        prop_assert!((0.0..TAU).contains(&motion.cam_angle), "{motion:?}");
        let mut before = case.angle;
        for event in &log.events {
            let turned = event.turned_since(0.0);
            prop_assert!(turned >= before, "{turned} after {before}: {event:?}");
            before = turned;
            prop_assert!((0.0..TAU).contains(&event.cam_angle), "{event:?}");
            let Event { position, velocity_before, velocity_after, cam_velocity, segment, .. } = *event;
            let law = &machine.cam().segments()[segment].law;
            let here = &machine.cam().segments()[segment];
            let angle = if event.cam_angle < here.start { event.cam_angle + TAU } else { event.cam_angle };
            prop_assert!(here.start <= angle && angle <= here.end, "{event:?} is not on its segment");
            let lift = law.lift(angle);
            let [of_the_lift, of_the_slope, _] = noise(case, segment);
            let of_the_velocity = omega * (of_the_slope + ROUNDING * (lift.slope.abs() + TAU * lift.curvature.abs()));
            let blur = of_the_lift + ROUNDING * (position.abs() + TAU * lift.slope.abs());
            prop_assert!((position - lift.value).abs() <= blur, "{} m off the cam: {event:?}", position - lift.value);
            match event.kind {
                EventKind::Impact => {
                    let (incoming, outgoing) = (velocity_before - cam_velocity, velocity_after - cam_velocity);
                    let rounding = ROUNDING * (velocity_before.abs() + cam_velocity.abs());
                    prop_assert!(incoming <= 0.0, "{event:?}");
                    // A follower that sticks is hit where the cam's velocity jumps.
                    prop_assert!(!sticks || angle == here.start, "sticks: {event:?}");
                    sticks = false;
                    prop_assert!(outgoing.abs() <= incoming.abs() + rounding, "grows: {event:?}");
                    prop_assert!((outgoing + r * incoming).abs() <= rounding, "{outgoing} after {incoming}: {event:?}");
                    prop_assert!((cam_velocity - omega * lift.slope).abs() <= of_the_velocity, "{event:?}");
                }
                EventKind::Stick => {
                    prop_assert!(!sticks, "sticks already: {event:?}");
                    sticks = true;
                    prop_assert_eq!(velocity_before, velocity_after);
                    prop_assert!((velocity_after - omega * lift.slope).abs() <= of_the_velocity, "{event:?}");
                    let (force, rounding) = pressing(case, segment, angle);
                    prop_assert!(force >= -rounding, "sticks where the cam pulls with {force}: {event:?}");
                }
                EventKind::Release => {
                    prop_assert!(sticks, "does not stick: {event:?}");
                    sticks = false;
                    prop_assert_eq!(velocity_before, velocity_after);
                    let (force, rounding) = pressing(case, segment, angle);
                    let at_a_corner = angle == here.start;
                    // Where rounding decides, the search looks ahead: up to as far again as it has hovered.
                    prop_assert!(at_a_corner || force.abs() <= 64.0 * rounding, "lets go with {force}: {event:?}");
                    prop_assert!(force <= rounding || at_a_corner, "lets go with {force}: {event:?}");
                }
            }
        }
        Ok(())
    });
}
