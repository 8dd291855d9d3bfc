//! Does a run obey the laws of mechanics in every regime: any damping, spring, gravity and impact, over every cam?
//!
//! Gaps and energies are those of the states that a run shows. `make fuzz` asks 20,000 machines, other ones in every round.

use std::ops::ControlFlow;

use corner_impact::flight::{Flight, State};
use corner_impact::model::{Follower, Model};
use corner_impact::simulate::{Event, EventKind, Machine, Motion, Observer, SimulateError, angular_velocity};
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;

use crate::common;
use crate::properties::goal;
use crate::random::{Case, cases_of_every_regime, cases_that_stand_still, check_all};

/// Most events that one case is followed through.
const EVENTS: usize = 200;

/// Rounding of the work that a run does between two looks, in roundings of its largest terms.
const ROUNDINGS: f64 = 4096.0 * f64::EPSILON;

/// All that a run shows.
struct Log<'a> {
    machine: &'a Machine,
    events: Vec<Event>,
    /// The state at which the last stretch of flight ended.
    flown: Option<State>,
    /// What was wrong first.
    wrong: Option<String>,
}

impl<'a> Log<'a> {
    fn of(machine: &'a Machine) -> Self {
        Self { machine, events: Vec::new(), flown: None, wrong: None }
    }

    fn told(&mut self, is_wrong: bool, words: impl Fn() -> String) {
        if is_wrong && self.wrong.is_none() {
            self.wrong = Some(words());
        }
    }

    /// Energy of the follower, J/kg: v^2/2 + w0^2 (q - rest)^2/2 + g q, as the work of the force from the cam's top on.
    fn energy(&self, State { position, velocity }: State) -> f64 {
        let top = self.machine.cam().top();
        let mean_force = self.machine.flight().force(0.5 * (position + top));
        0.5 * velocity * velocity - mean_force * (position - top)
    }

    /// What rounding may make of an energy at a state.
    fn rounding(&self, State { position, velocity }: State) -> f64 {
        let (flight, top) = (self.machine.flight(), self.machine.cam().top());
        let size = position.abs() + top.abs();
        let force = flight.force(position).abs() + flight.force(top).abs() + flight.omega0_squared() * size;
        // Beside what is too small for a double's square.
        ROUNDINGS * (velocity * velocity + force * size) + f64::MIN_POSITIVE
    }
}

impl Observer for Log<'_> {
    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        let state = State { position: event.position, velocity: event.velocity_before };
        if let Some(end) = self.flown.take() {
            let (apart, rounding) = (self.energy(end) - self.energy(state), self.rounding(end) + self.rounding(state));
            self.told(!(apart.abs() <= rounding), || {
                format!("{apart} J/kg more at the end of a flight than at {event:?}")
            });
        }
        self.events.push(*event);
        if self.events.len() >= EVENTS { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn flight(&mut self, flight: &Flight, from: State, time: f64) {
        if let Some(end) = self.flown {
            let (apart, rounding) = (self.energy(from) - self.energy(end), self.rounding(from) + self.rounding(end));
            self.told(!(apart.abs() <= rounding), || format!("{apart} J/kg more from {from:?} than at {end:?}"));
        }
        let end = flight.fly(from, time).1;
        let (lost, rounding) = (self.energy(from) - self.energy(end), self.rounding(from) + self.rounding(end));
        let damped = damped(flight, from, time);
        self.told(!(lost >= -rounding), || format!("a flight gains {} J/kg: {time} s from {from:?}", -lost));
        if let Some(damped) = damped {
            // What the quadrature leaves out beside.
            let apart = (lost - damped).abs();
            self.told(!(apart <= rounding + 1e-9 * damped), || {
                format!("a flight loses {lost} J/kg, and its damper takes {damped}: {time} s from {from:?}")
            });
        }
        self.flown = Some(end);
    }
}

/// Energy that the damper takes in a flight, J/kg: 2 zeta times the integral of v^2, by Gauss's five points over 64 parts; `None` for a flight
/// that is too long for as many.
fn damped(flight: &Flight, from: State, time: f64) -> Option<f64> {
    const NODES: [(f64, f64); 3] = [
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    const PARTS: u32 = 64;
    if flight.zeta() == 0.0 {
        return Some(0.0);
    }
    let rate = flight.omega0_squared().sqrt() + 2.0 * flight.zeta();
    let half = 0.5 * time / f64::from(PARTS);
    let square = |at: f64| flight.fly(from, at).1.velocity.powi(2);
    let part = |index: u32| {
        let middle = half * f64::from(2 * index + 1);
        let two = |(node, weight): (f64, f64)| weight * (square(middle - half * node) + square(middle + half * node));
        half * (NODES[0].1 * square(middle) + two(NODES[1]) + two(NODES[2]))
    };
    (rate * half < 0.3).then(|| 2.0 * flight.zeta() * (0..PARTS).map(part).sum::<f64>())
}

/// How far rounding moves the follower over the cam, m.
fn blur(case: &Case, motion: &Motion, since: f64) -> f64 {
    let (cam, omega) = (case.machine.cam(), case.machine.angular_velocity());
    let slopes = cam.lift(motion.cam_angle).slope.abs() + (motion.state.velocity / omega).abs();
    // A 4-5-6-7 motion is a sum of terms of up to 84 rises.
    let sizes = motion.state.position.abs() + cam.top().abs() + 250.0 * case.stroke;
    16.0 * f64::EPSILON * (sizes + (7.0 + since) * slopes)
}

/// A run that gives up has met more events, or taken more steps, than a run may.
fn gives_up(error: SimulateError) -> TestCaseResult {
    match error {
        SimulateError::NoProgress { .. } => Ok(()),
        _ => Err(TestCaseError::fail(error.to_string())),
    }
}

/// Looked at in forty places, the follower is over the cam; the events are the same, bit for bit, as those of a run that nobody looks at;
/// and only the damper and impacts change the energy.
fn obeys_the_laws(case: &Case) -> TestCaseResult {
    let (machine, first) = (&case.machine, case.motion().map_err(|error| TestCaseError::fail(error.to_string()))?);
    let turn = case.turns(20.0);
    let (mut whole, mut log) = (first, Log::of(machine));
    if let Err(error) = machine.advance(&mut whole, goal(&first, turn), &mut log) {
        return gives_up(error);
    }
    if let Some(wrong) = log.wrong {
        return Err(TestCaseError::fail(wrong));
    }
    let (mut split, mut seen) = (first, Log::of(machine));
    for index in 1..=40 {
        let part = turn * (f64::from(index) / 40.0);
        let flow = machine.advance(&mut split, goal(&first, part), &mut seen);
        let flow = flow.map_err(|error| TestCaseError::fail(error.to_string()))?;
        if flow.is_break() {
            break;
        }
        let (gap, blur) = (machine.gap(&split), blur(case, &split, part));
        prop_assert!(gap >= -blur, "{gap} m, {blur} m, at {part} rad: {split:?}");
    }
    if let Some(wrong) = seen.wrong {
        return Err(TestCaseError::fail(format!("split: {wrong}")));
    }
    prop_assert_eq!(&seen.events, &log.events);
    if log.events.len() < EVENTS {
        prop_assert_eq!((split.state, split.contact), (whole.state, whole.contact));
    }
    Ok(())
}

#[test]
#[ignore = "slow"]
fn the_laws_hold_in_every_regime() {
    check_all(cases_of_every_regime(), 1500, obeys_the_laws);
}

#[test]
fn the_laws_hold_in_some_machines_of_every_regime() {
    check_all(cases_of_every_regime(), 60, obeys_the_laws);
}

/// Over a cam that stands still nothing gives the follower energy.
#[test]
#[ignore = "slow"]
fn over_a_cam_that_stands_still_energy_never_rises() {
    check_all(cases_that_stand_still(), 400, |case| {
        let machine = &case.machine;
        let mut motion = case.motion().map_err(|error| TestCaseError::fail(error.to_string()))?;
        let mut log = Log::of(machine);
        let goal = goal(&motion, case.turns(50.0));
        let mut before = log.energy(motion.state);
        if let Err(error) = machine.advance(&mut motion, goal, &mut log) {
            return gives_up(error);
        }
        for event in &log.events {
            for velocity in [event.velocity_before, event.velocity_after] {
                let state = State { position: event.position, velocity };
                let now = log.energy(state);
                prop_assert!(now <= before + log.rounding(state), "{now} J/kg after {before}: {event:?}");
                before = before.min(now);
            }
        }
        Ok(())
    });
}

/// A ball over a cam that stands still: `count` machines of one family, whose numbers spread over many sizes.
fn balls(count: u32) -> impl Iterator<Item = (Machine, Motion)> {
    (1..=count).map(|index| {
        let unit = |root: f64| (f64::from(index) * root.sqrt()).fract();
        let spread = |root: f64, low: f64, high: f64| low * f64::powf(high / low, unit(root));
        let offset = 4.0 * unit(2.0) - 2.0;
        let stiffness = if index % 3 == 0 { 0.0 } else { spread(3.0, 1e-3, 1e4) };
        let gravity = if index % 3 == 1 { 0.0 } else { spread(5.0, 0.1, 100.0) };
        let follower =
            Follower { mass: 1.0, damping: 0.0, stiffness, gravity, rest_position: offset - 2.0 * unit(7.0), restitution: 1.0 };
        let text = format!(
            "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 1.0\ngravity = 0.0\nrest_position = 0.0\nrestitution = 1.0\n\
             [cam]\nlaw = \"harmonic\"\noffset = {offset:?}\namplitudes = [0.0]\nphases_deg = [0.0]\n"
        );
        let cam = common::cam(&Model::parse("still.toml", &text).unwrap());
        let pressing = -Flight::new(&follower).force(offset);
        // A flight of some turns, some thousandths of one, or of a part of the follower's own period.
        let omega = spread(11.0, 0.1, 1e3) * pressing.sqrt();
        let machine = Machine::new(cam, &follower, omega);
        let motion = machine.start_on_cam(6.0 * unit(13.0), spread(17.0, 1e-3, 10.0)).unwrap();
        (machine, motion)
    })
}

/// With restitution 1 and no damping a ball on a plate that stands still keeps its energy: to 1e-9 after a million impacts.
///
/// A hop that is a ten-millionth as high as the plate is known to fewer digits: its height is a difference of two positions. There four
/// times as much is allowed, which a hop of 67 nm over a plate at 0.7 m needs half of.
fn keeps_its_energy(machine: &Machine, mut motion: Motion, impacts: u32) {
    let begun = motion.state.velocity;
    let (mut met, mut last) = (0, f64::NAN);
    let goal = motion.after(u64::MAX / 2);
    let flow = machine.advance(&mut motion, goal, &mut |event: &Event| {
        assert_eq!(event.kind, EventKind::Impact);
        (met, last) = (met + 1, event.velocity_after);
        if met == impacts { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(flow.unwrap().is_break());
    let gained = (last / begun).powi(2) - 1.0;
    let (pressing, position) = (-machine.flight().force(motion.state.position), motion.state.position);
    let is_low = begun * begun < 2.0 * pressing * 1e-7 * position.abs();
    let most = if is_low { 4e-15 } else { 1e-15 };
    assert!(gained.abs() <= most * f64::from(impacts), "{gained} of the energy after {met} impacts: {machine:?}");
}

#[test]
#[ignore = "slow"]
fn a_million_impacts_without_loss_keep_the_energy() {
    let count = if std::env::var_os("SOAK").is_some() { 75 } else { 6 };
    balls(count).for_each(|(machine, motion)| keeps_its_energy(&machine, motion, 1_000_000));
}

#[test]
fn ten_thousand_impacts_without_loss_keep_the_energy() {
    balls(15).for_each(|(machine, motion)| keeps_its_energy(&machine, motion, 10_000));
}

/// One ulp above a level and on the way up, with the least damping: each comes down, and where it is then is below the level a little later.
#[test]
fn a_flight_from_an_ulp_above_a_level_comes_down_to_it() {
    for index in 1..=4000 {
        let unit = |root: f64| (f64::from(index) * root.sqrt()).fract();
        let spread = |root: f64, low: f64, high: f64| low * f64::powf(high / low, unit(root));
        let stiffness = if index % 2 == 0 { 0.0 } else { spread(3.0, 1e-6, 1e3) };
        let damping = spread(2.0, 1e-8, 10.0);
        let follower = Follower { mass: 1.0, damping, stiffness, gravity: 9.81, rest_position: 0.3, restitution: 0.9 };
        let (flight, level) = (Flight::new(&follower), 0.4 + 0.2 * unit(5.0));
        let start = State {
            position: level.next_up(),
            velocity: spread(7.0, 1e-9, 10.0) * if index % 5 == 0 { -1.0 } else { 1.0 },
        };
        let Some((time, state)) = flight.fall_to(level, start) else {
            panic!("{follower:?} from {start:?} never comes down")
        };
        assert!(state.position == level && state.velocity < 0.0, "{follower:?} from {start:?}: {time} {state:?}");
        let there = flight.fly(start, time).1;
        let rounding = 1e-14 * (1.0 + start.velocity.abs() * time);
        assert!((there.position - level).abs() <= rounding, "{follower:?} from {start:?}: {there:?} after {time}");
    }
}

/// 300 revolutions of the paper's cam under a ball with the least damping: it once fell through and ended 8 km below.
#[test]
fn a_lightly_damped_ball_stays_over_its_cam() {
    let mut model = common::osorio();
    model.follower = Follower {
        stiffness: 0.0,
        gravity: 9.81,
        damping: 0.001_034_894_470_332_752_5,
        restitution: 0.9,
        ..model.follower
    };
    let machine = Machine::new(common::cam(&model), &model.follower, angular_velocity(142.257_929_222_769_35));
    let mut motion = machine.start_on_cam(0.0, 1.395_100_248_466_848_2).unwrap();
    machine.revolve(&mut motion, 300).unwrap();
    assert!(machine.gap(&motion) >= 0.0 && motion.state.position < 10.0, "{motion:?}");
}

/// What else is written of a run changes none of its events.
#[test]
#[ignore = "slow"]
fn events_are_the_same_whatever_else_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    for (model, rpm) in
        [("osorio-2008", "650"), ("damped-heavy", "700"), ("damped-light", "620"), ("laws/table-cubic", "300")]
    {
        let model = format!("{}/models/{model}.toml", common::ROOT);
        let run = |name: &str, more: &[&str]| {
            let mut words = vec!["simulate", &model, "--rpm", rpm, "--revolutions", "500", "--relative-velocity", "1"];
            let events = file(name);
            words.extend(["--events", &events]);
            words.extend(more);
            let run = common::corner_impact(&words);
            assert!(run.status.success(), "{run:?}");
            std::fs::read(events).unwrap()
        };
        let plain = run("plain.csv", &[]);
        assert_eq!(plain, run("strobed.csv", &["--strobe", "1.25", "--strobe-out", &file("strobe.csv")]), "{model}");
        assert_eq!(plain, run("traced.csv", &["--trace", &file("trace.csv"), "--drawn", "7"]), "{model}");
    }
}
