//! Does every run obey the laws, whatever the model and the start?
//!
//! The cases are the same in every run. `PROPTEST_CASES=100000 PROPTEST_RNG_SEED=7` looks at others.

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU32, Ordering};

use corner_impact::flight::{Flight, State};
use corner_impact::simulate::{Event, EventKind, Goal, Machine, Motion, Observer, SimulateError, Variation};
use corner_impact::study::survey::{Placed, Start};
use corner_impact::tolerance::RELATIVE_VELOCITY_ROUNDING;
use nalgebra::{Matrix2, Vector2};

use crate::random;
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use random::{Case, check, check_many_segments};

/// Rounding of a number that a dozen operations made.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// All that a run shows, up to a number of events.
#[derive(Default)]
pub struct Log {
    pub events: Vec<Event>,
    flights: Vec<(State, f64)>,
}

/// Most events that one case is followed through.
pub const EVENTS: usize = 300;

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
pub fn goal(motion: &Motion, turn: f64) -> Goal {
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
#[ignore = "slow"]
fn the_follower_is_never_below_the_cam_and_the_cam_never_pulls() {
    check(2000, |case| {
        let (machine, mut motion) = (&case.machine, case.motion().unwrap());
        let (first, mut log) = (motion, Log::default());
        let omega = machine.angular_velocity();
        let mut last = 0.0;
        for index in 1..=500 {
            let turn = case.turns(5.0) * f64::from(index) / 500.0;
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
#[ignore = "slow"]
fn events_obey_their_laws() {
    check(4000, |case| {
        let (machine, mut motion) = (&case.machine, case.motion().unwrap());
        let (mut log, r, omega) = (Log::default(), machine.restitution(), machine.angular_velocity());
        let mut sticks = motion.contact;
        let goal = goal(&motion, case.turns(20.0));
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
                    prop_assert!(incoming <= rounding, "{event:?}");
                    // A follower that sticks is hit where the cam's velocity jumps.
                    prop_assert!(!sticks || angle == here.start, "sticks: {event:?}");
                    sticks = false;
                    prop_assert!(outgoing.abs() <= incoming.abs() + rounding, "grows: {event:?}");
                    // What is left below the rounding of the cam's largest velocity is none.
                    let slopes = machine.cam().segments().iter().flat_map(|segment| segment.bounds.slope);
                    let largest = omega * slopes.fold(0.0, |largest: f64, slope| largest.max(slope.abs()));
                    let none = RELATIVE_VELOCITY_ROUNDING.value * largest;
                    let ends = outgoing == 0.0 && r * incoming.abs() <= none;
                    let turns = (outgoing + r * incoming).abs() <= rounding;
                    prop_assert!(ends || turns, "{outgoing} after {incoming}: {event:?}");
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

/// The gap `time`, s, after a start at `angle`: no more than the flight and the lift.
fn gap(machine: &Machine, angle: f64, start: State, time: f64) -> f64 {
    let position = machine.flight().fly(start, time).1.position;
    position - machine.cam().lift((angle + machine.angular_velocity() * time) % TAU).value
}

/// The least gap over `[0, end]`, s, and where: a scan, refined wherever three samples hold a least one.
fn least_gap(machine: &Machine, angle: f64, start: State, end: f64) -> (f64, f64) {
    let steps = (600.0 * machine.angular_velocity() * end).clamp(400.0, 20_000.0) as u32;
    let time = |step: u32| end * f64::from(step) / f64::from(steps);
    let samples: Vec<f64> = (0..=steps).map(|step| gap(machine, angle, start, time(step))).collect();
    let mut least = (f64::INFINITY, 0.0);
    for step in 1..steps as usize {
        let low = samples[step - 1].min(samples[step + 1]);
        if samples[step] > low {
            continue;
        }
        let (mut from, mut to) = (time(step as u32 - 1), time(step as u32 + 1));
        for _ in 0..60 {
            let (left, right) = (from + 0.382 * (to - from), from + 0.618 * (to - from));
            if gap(machine, angle, start, left) <= gap(machine, angle, start, right) { to = right } else { from = left }
        }
        let found = gap(machine, angle, start, from).min(samples[step]);
        if found < least.0 {
            least = (found, from);
        }
    }
    least
}

/// A flight of a run: from where, and up to which event, if not the end of the run.
pub struct Leg {
    pub angle: f64,
    pub start: State,
    /// The angle turned where it begins, rad.
    pub turned: f64,
    /// s.
    pub time: f64,
    pub event: Option<Event>,
}

/// The flights of a run over `turns`, from the start and from every event on which one begins.
pub fn legs(case: &Case, mut motion: Motion, turns: f64) -> Result<Vec<Leg>, SimulateError> {
    let machine = &case.machine;
    let mut from = (!motion.contact).then_some((motion.cam_angle, motion.state));
    let (mut turned, mut log) = (motion.cam_angle, Log::default());
    let goal = goal(&motion, case.turns(turns));
    let _ = machine.advance(&mut motion, goal, &mut log)?;
    let end = (motion.revolution as f64) * TAU + motion.cam_angle;
    let ends = log.events.iter().map(|event| (event.turned_since(0.0), Some(*event)));
    let broken = log.events.len() >= EVENTS;
    let mut legs = Vec::new();
    for (until, event) in ends.chain((!broken).then_some((end, None))) {
        // A stick after a chatter is where infinitely many flights end.
        let ends_flights = event.is_some_and(|event| event.kind == EventKind::Stick);
        if let Some((angle, start)) = from.filter(|_| !ends_flights) {
            legs.push(Leg { angle, start, turned, time: (until - turned) / machine.angular_velocity(), event });
        }
        let Some(event) = event else { break };
        turned = until;
        let state = State { position: event.position, velocity: event.velocity_after };
        from = match event.kind {
            EventKind::Impact if event.velocity_after > event.cam_velocity => Some((event.cam_angle, state)),
            EventKind::Release => Some((event.cam_angle, state)),
            _ => None,
        };
    }
    Ok(legs)
}

fn first_contacts(case: &Case) -> TestCaseResult {
    first_contacts_from(case, case.motion().unwrap(), 3.0, 60)
}

/// A scan of each flight finds nothing below the cam before the next impact, and nothing above it there; of so many flights, over so many
/// turns.
pub fn first_contacts_from(case: &Case, motion: Motion, turns: f64, most: usize) -> TestCaseResult {
    let (machine, omega) = (&case.machine, case.machine.angular_velocity());
    let legs = match legs(case, motion, turns) {
        Ok(legs) => legs,
        Err(error) => return only_no_progress(case, error),
    };
    for Leg { angle, start, turned, time, event } in legs.into_iter().take(most) {
        let (least, at) = least_gap(machine, angle, start, time);
        let there = State { position: start.position, velocity: machine.flight().fly(start, at).1.velocity };
        let blur = |time: f64, state: State| blur(case, (angle + omega * time) % TAU, state, time);
        prop_assert!(
            least >= -blur(at, there),
            "{least} m after {at} s of {time} s from {start:?} at {angle}, {event:?}"
        );
        if event.is_some_and(|event| event.kind == EventKind::Impact) {
            let end = machine.flight().fly(start, time).1;
            // The angles of two events tell the time between them to the rounding of angles only.
            let last = gap(machine, angle, start, time);
            prop_assert!(
                last.abs() <= blur(time, end) + ROUNDING * end.velocity.abs() * turned / omega,
                "{last} m at the impact, after {time} s from {start:?} at {angle}: {event:?}"
            );
        }
    }
    Ok(())
}

#[test]
#[ignore = "slow"]
fn the_first_contact_is_the_first() {
    check(1500, first_contacts);
}

/// Where flights go over many segments at once.
#[test]
#[ignore = "slow"]
fn the_first_contact_is_the_first_over_many_segments() {
    check_many_segments(600, first_contacts);
}

/// How far rounding has moved the follower, as the flow carries it on: an upper bound, since nothing cancels.
pub struct Growth<'a> {
    one: Variation<'a>,
    /// m and m/s.
    pub error: Vector2<f64>,
    scale: Vector2<f64>,
    pub log: Log,
    /// The error before each event.
    at_events: Vec<Vector2<f64>>,
}

impl<'a> Growth<'a> {
    pub fn new(case: &'a Case, motion: &Motion) -> Self {
        let position = case.machine.cam().top().abs() + motion.state.position.abs() + 10.0 * case.stroke;
        let scale = 64.0 * f64::EPSILON * Vector2::new(position, case.velocity() + motion.state.velocity.abs());
        let one = Variation::new(&case.machine, motion);
        Self { one, error: scale, scale, log: Log::default(), at_events: Vec::new() }
    }

    fn carry(&mut self, matrix: Matrix2<f64>) {
        self.error = matrix.abs() * self.error + self.scale;
    }
}

impl Observer for Growth<'_> {
    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        self.at_events.push(self.error);
        self.one.reset(Matrix2::identity());
        let _ = self.one.event(event);
        self.carry(self.one.matrix());
        self.log.event(event)
    }

    fn flight(&mut self, flight: &Flight, from: State, time: f64) {
        for state in [from, flight.fly(from, time).1] {
            // The phase of an oscillation of that size is rounded, too.
            let rate = flight.omega0_squared().sqrt();
            let swing =
                if rate > 0.0 { (flight.force(state.position) / rate).abs() + state.velocity.abs() } else { 0.0 };
            let phase = swing * time * Vector2::new(1.0, rate);
            let size = Vector2::new(state.position.abs(), state.velocity.abs()) + phase;
            self.scale = self.scale.sup(&(64.0 * f64::EPSILON * size));
        }
        self.carry(flight.propagator(time));
        self.log.flight(flight, from, time);
    }
}

/// How deep the follower would go below the cam if it were not hit, by a parabola.
pub fn depth(machine: &Machine, event: &Event) -> f64 {
    let (omega, relative) = (machine.angular_velocity(), event.velocity_before - event.cam_velocity);
    let lift = machine.cam().segments()[event.segment].law.lift(event.cam_angle);
    let state = State { position: event.position, velocity: event.velocity_before };
    let curvature = machine.flight().acceleration(state) - omega * omega * lift.curvature;
    relative * relative / (2.0 * curvature.abs())
}

/// The motion goes on.
fn on(_: &Machine, motion: Motion) -> Result<Motion, TestCaseError> {
    Ok(motion)
}

/// A motion starts anew from the numbers that tell where one is, as they are printed.
fn anew(machine: &Machine, motion: Motion) -> Result<Motion, TestCaseError> {
    let mut again = machine.resume(&motion).map_err(|error| TestCaseError::fail(format!("{error}: {motion:?}")))?;
    again.revolution = motion.revolution;
    Ok(again)
}

/// Split at two places, a run has the same events, as far as rounding lets it be told.
#[test]
#[ignore = "slow"]
fn a_run_may_be_split_anywhere() {
    check(2000, |case| splits(case, on));
}

/// Over many segments, too, some of which it goes over at once.
#[test]
#[ignore = "slow"]
fn a_run_over_many_segments_may_be_split_anywhere() {
    check_many_segments(150, |case| splits(case, on));
}

/// So has one that is started again from the state that it has come to.
#[test]
#[ignore = "slow"]
fn a_run_may_be_started_again_anywhere() {
    check(2000, |case| splits(case, anew));
}

/// A motion starts anew from angle, position and velocity alone, as a command line and a table have them.
fn from_its_numbers(machine: &Machine, motion: Motion) -> Result<Motion, TestCaseError> {
    let told = |number: f64| number.to_string().parse().unwrap();
    let State { position, velocity } = motion.state;
    let follower = Placed::At(State { position: told(position), velocity: told(velocity) });
    let again = Start { cam_angle: told(motion.cam_angle), follower }.motion(machine);
    let mut again = again.map_err(|error| TestCaseError::fail(format!("{error}: {motion:?}")))?;
    prop_assert_eq!(again.contact, motion.contact, "{:?}", motion);
    again.revolution = motion.revolution;
    Ok(again)
}

#[test]
fn a_run_may_be_resumed_from_its_numbers() {
    check(400, |case| splits(case, from_its_numbers));
}

/// Also over many segments.
#[test]
#[ignore = "slow"]
fn any_run_may_be_resumed_from_its_numbers() {
    check(4000, |case| splits(case, from_its_numbers));
    check_many_segments(150, |case| splits(case, from_its_numbers));
}

fn splits(case: &Case, goes_on: fn(&Machine, Motion) -> Result<Motion, TestCaseError>) -> TestCaseResult {
    let (machine, first) = (&case.machine, case.motion().unwrap());
    let whole_turn = case.turns(6.0);
    let (mut whole, mut growth) = (first, Growth::new(case, &first));
    if let Err(error) = machine.advance(&mut whole, goal(&first, whole_turn), &mut growth) {
        return only_no_progress(case, error);
    }
    let (mut split, mut log) = (first, Log::default());
    // Places that the case decides on, without a second source of chance.
    let share = (case.rpm * 1e3).fract();
    for turn in [0.5 * share * whole_turn, (0.5 + 0.4 * share) * whole_turn] {
        let goal = goal(&first, turn);
        if machine.advance(&mut split, goal, &mut log).unwrap().is_break() {
            return Ok(());
        }
        prop_assert_eq!((split.revolution, split.cam_angle), (goal.revolution, goal.cam_angle));
        split = goes_on(machine, split)?;
    }
    let flow = machine.advance(&mut split, goal(&first, whole_turn), &mut log).unwrap();
    for ((one, two), error) in growth.log.events.iter().zip(&log.events).zip(&growth.at_events) {
        if one.kind != EventKind::Impact || two.kind != EventKind::Impact {
            return Ok(());
        }
        // The least of what the two would have dipped below the cam: less than the error, and it is a graze that one of
        // them may have passed over.
        let depth = [one, two].map(|event| depth(machine, event)).into_iter().fold(f64::INFINITY, f64::min);
        let relative = one.velocity_before - one.cam_velocity;
        if depth <= 100.0 * error[0] || error[1] > 1e-3 * relative.abs() {
            return Ok(());
        }
        let turn = 2.0 * machine.angular_velocity() * error[0] / relative.abs();
        let (one, two) = (one.turned_since(0.0), two.turned_since(0.0));
        prop_assert!((one - two).abs() <= turn + ROUNDING * one.max(1.0), "{one} rad, {two} rad, {turn}");
    }
    if flow.is_break() || whole.contact {
        return Ok(());
    }
    let (one, two) = (&growth.log.events, &log.events);
    if let Some(more) = one.get(two.len()).or(two.get(one.len())) {
        let is_graze = more.kind == EventKind::Impact && depth(machine, more) <= 100.0 * growth.error[0];
        prop_assert!(is_graze, "only one of the two has {more:?}");
        return Ok(());
    }
    let apart = [split.state.position - whole.state.position, split.state.velocity - whole.state.velocity];
    for (apart, error) in apart.into_iter().zip(growth.error.iter()) {
        prop_assert!(apart.abs() <= *error, "{apart}, {error}: {whole:?} {split:?}");
    }
    Ok(())
}

#[test]
fn the_same_run_is_the_same() {
    check(300, |case| {
        let run = || {
            let (mut motion, mut log) = (case.motion().unwrap(), Log::default());
            let goal = goal(&motion, case.turns(10.0));
            let end = case.machine.advance(&mut motion, goal, &mut log);
            (end, motion, log.events)
        };
        let (one, two) = (run(), run());
        // As text, in which one NaN is the other.
        prop_assert_eq!(format!("{one:?}"), format!("{two:?}"));
        Ok(())
    });
}

/// The matrix against differences of the state at the end, over two widths; 0 after the follower has stuck.
#[test]
#[ignore = "slow"]
fn the_variational_flow_is_the_derivative_of_the_end() {
    static COMPARED: AtomicU32 = AtomicU32::new(0);
    check(3000, |case| {
        let (machine, first) = (&case.machine, case.motion().unwrap());
        let turn = case.turns(0.3 + 2.0 * (case.rpm * 1e3).fract());
        let end = |state: State| -> Option<(State, Vec<Event>)> {
            let (mut motion, mut log) = (machine.start(case.angle, state).ok()?, Log::default());
            let goal = goal(&motion, turn);
            let flow = machine.advance(&mut motion, goal, &mut log).ok()?;
            flow.is_continue().then_some((motion.state, log.events))
        };
        // Off the cam, so that a deviation to either side is a start, too.
        let start = first.state;
        let scale = Vector2::new(case.stroke, case.velocity());
        if first.contact || machine.gap(&first) < 1e-3 * case.stroke {
            return Ok(());
        }
        let (mut motion, mut variation) = (first, Variation::new(machine, &first));
        if machine.advance(&mut motion, goal(&first, turn), &mut variation).is_err() {
            return Ok(());
        }
        let Some((_, events)) = end(start) else { return Ok(()) };
        let matrix = variation.matrix();
        if events.iter().any(|event| event.kind == EventKind::Stick) {
            prop_assert_eq!(matrix, Matrix2::zeros());
            return Ok(());
        }
        if events.is_empty() || events.len() > 12 {
            return Ok(());
        }
        let difference = |width: f64| -> Option<Matrix2<f64>> {
            let mut columns = Matrix2::zeros();
            for axis in 0..2 {
                let step = width * scale[axis];
                let moved = |by: f64| {
                    let mut vector = Vector2::new(start.position, start.velocity);
                    vector[axis] += by;
                    end(State { position: vector[0], velocity: vector[1] })
                };
                let ((behind, one), (ahead, two)) = (moved(-step)?, moved(step)?);
                // The same impacts on the same segments.
                let same = |other: &[Event]| {
                    other.len() == events.len()
                        && other
                            .iter()
                            .zip(&events)
                            .all(|(one, two)| one.segment == two.segment && one.kind == two.kind)
                };
                if !(same(&one) && same(&two)) {
                    return None;
                }
                columns[(0, axis)] = (ahead.position - behind.position) / (2.0 * step);
                columns[(1, axis)] = (ahead.velocity - behind.velocity) / (2.0 * step);
            }
            Some(columns)
        };
        let width = 1e-5;
        let (Some(wide), Some(narrow), Some(narrower)) =
            (difference(2.0 * width), difference(width), difference(0.5 * width))
        else {
            return Ok(());
        };
        // Errors of differences fall with the square of the width: away from a graze the two extrapolations agree.
        let (coarse, fine) = ((4.0 * narrow - wide) / 3.0, (4.0 * narrower - narrow) / 3.0);
        for row in 0..2 {
            for column in 0..2 {
                let at = (row, column);
                let unit = scale[row] / scale[column];
                let size =
                    matrix.component_mul(&Matrix2::new(1.0, scale[1] / scale[0], scale[0] / scale[1], 1.0)).amax();
                let left = (coarse[at] - fine[at]).abs() + (narrow[at] - wide[at]).abs() * 0.01;
                // Not resolved by these widths.
                if !(left <= 1e-3 * (size + 1.0) * unit) {
                    return Ok(());
                }
                // Of the position, and of the phase that the follower has gone through, divided by the width.
                let phase = turn / machine.angular_velocity() * machine.flight().omega0_squared().sqrt();
                let position = machine.cam().top().abs() / case.stroke;
                let rounding = ROUNDING * (1.0 + position + phase) / width * (size + 1.0) * unit;
                prop_assert!(
                    (fine[at] - matrix[at]).abs() <= left + rounding,
                    "{at:?}: {} {}, {left} {rounding}, {events:?}",
                    fine[at],
                    matrix[at]
                );
            }
        }
        COMPARED.fetch_add(1, Ordering::Relaxed);
        Ok(())
    });
    let compared = COMPARED.load(Ordering::Relaxed);
    assert!(compared >= 100, "{compared} cases could be compared");
}
