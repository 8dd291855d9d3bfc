//! Does a cycle of impacts stay the same motion under each of its names, and is it told from what is none?

use std::f64::consts::TAU;

use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::cam::apart;
use corner_impact::model::Follower;
use corner_impact::orbit::{Course, PeriodicOrbit, Search, eigenvalues, search};
use corner_impact::simulate::{EventKind, Machine, angular_velocity};
use nalgebra::Matrix2;

use crate::common;
use crate::random::{cases_of_every_law, drawn};

fn machine(rpm: f64) -> Machine {
    let paper = common::osorio();
    Machine::new(common::cam(&paper), &paper.follower, angular_velocity(rpm))
}

fn orbits(machine: &Machine, impacts: usize) -> Vec<PeriodicOrbit> {
    search(machine, &Search { revolutions: 1, impacts: Some(impacts) }).unwrap()
}

/// The cycle of an orbit of impacts: its type has no name here.
macro_rules! cycle_of {
    ($orbit:expr) => {{
        let Course::Impacts(cycle) = &$orbit.course else { panic!("{:?}", $orbit) };
        cycle.clone()
    }};
}

/// A cycle with an impact in each of these revolutions, at a segment and an angle, rad.
macro_rules! cycle {
    ($revolutions:expr, $impacts:expr) => {{
        let mut cycle = cycle_of!(orbits(&machine(700.0), 1)[0]);
        let one = cycle.impacts[0];
        cycle.revolutions = $revolutions;
        cycle.impacts.clear();
        for (revolution, segment, cam_angle) in $impacts {
            let mut impact = one;
            (impact.revolution, impact.segment, impact.cam_angle) = (revolution, segment, cam_angle);
            cycle.impacts.push(impact);
        }
        cycle
    }};
}

/// The revolution, the segment and the angle of each impact.
macro_rules! told {
    ($cycle:expr) => {
        $cycle.impacts.iter().map(|it| (it.revolution, it.segment, it.cam_angle)).collect::<Vec<_>>()
    };
}

#[test]
fn a_cycle_may_begin_with_any_of_its_revolutions() {
    let cycle = cycle!(3, [(0, 0, 1.0), (1, 1, 2.0), (2, 2, 3.0)]);
    let begun = [
        [(0, 0, 1.0), (1, 1, 2.0), (2, 2, 3.0)],
        [(0, 1, 2.0), (1, 2, 3.0), (2, 0, 1.0)],
        [(0, 2, 3.0), (1, 0, 1.0), (2, 1, 2.0)],
    ];
    for later in 0..7 {
        let other = cycle.begun_later(later as u64);
        assert_eq!(told!(other), begun[later % 3], "{later}");
        assert!(other.is_same(&cycle) && cycle.is_same(&other), "{later}");
    }
}

#[test]
fn cycles_are_one_motion_only_with_all_their_impacts_and_revolutions() {
    let one = cycle!(1, [(0, 0, 1.0), (0, 0, 2.0)]);
    assert!(one.is_same(&one));
    let longer = cycle!(1, [(0, 0, 1.0), (0, 0, 2.0), (0, 0, 4.0)]);
    assert!(!one.is_same(&longer) && !longer.is_same(&one));
    let slower = cycle!(2, [(0, 0, 1.0), (0, 0, 2.0)]);
    assert!(!one.is_same(&slower) && !slower.is_same(&one));
}

#[test]
fn an_angle_is_named_by_the_segment_that_it_is_in_but_past_a_corner() {
    let machine = machine(700.0);
    let segments = machine.cam().segments();
    let (last, inner) = (segments.len() - 1, &segments[1]);
    let [before, after] = [inner.start - 0.01, inner.end + 0.01];
    let names = [
        ((1, 0, -0.1), (0, last, TAU - 0.1)),
        ((0, last, TAU + 0.1), (1, 0, TAU + 0.1 - TAU)),
        ((2, 1, before), (2, 0, before)),
        ((2, 1, after), (2, 2, after)),
        ((3, 1, 0.5 * (inner.start + inner.end)), (3, 1, 0.5 * (inner.start + inner.end))),
    ];
    for (name, renamed) in names {
        let cycle = cycle!(5, [name]);
        assert_eq!(told!(cycle.renamed(&machine, |_| false)), [renamed]);
        assert_eq!(told!(cycle.renamed(&machine, |corner| corner <= last)), [name]);
    }
}

#[test]
fn a_cycle_that_repeats_sooner_is_cut_to_what_repeats() {
    let once = [(0, 0, 1.0), (1, 0, 2.0), (1, 0, 3.0), (2, 0, 2.5)];
    for (period, rounds) in [(1, 4), (2, 2), (2, 3), (3, 2), (3, 3)] {
        let once: Vec<_> = once.into_iter().filter(|(turn, ..)| *turn < period).collect();
        let later =
            |round: i64| once.iter().map(move |(turn, segment, angle)| (turn + round * period, *segment, *angle));
        let cycle = cycle!((rounds * period) as u64, (0..rounds).flat_map(later));
        assert!(cycle.repeats_sooner(), "{cycle:?}");
        let short = cycle.shortest();
        assert_eq!((short.revolutions, told!(short)), (period as u64, once));
        assert!(!short.repeats_sooner());
    }
    let once = cycle!(4, [(0, 0, 1.0), (1, 0, 2.0), (2, 0, 1.0), (3, 0, 2.1)]);
    assert!(!once.repeats_sooner() && once.clone().shortest() == once);
}

#[test]
fn the_second_half_is_half_the_impacts_and_half_the_revolutions_on() {
    let half =
        |revolutions, impacts: &[(i64, usize, f64)], of| cycle!(revolutions, impacts.iter().copied()).second_half(of);
    let doubled = [(0, 1, 1.6), (1, 1, 1.7)];
    assert_eq!(half(2, &doubled, 0), Some(1));
    assert_eq!(half(2, &doubled, 1), None);
    assert_eq!(half(2, &[(1, 1, 1.6), (2, 1, 1.7)], 0), Some(1));
    assert_eq!(half(4, &[(0, 0, 1.0), (1, 1, 2.0), (2, 0, 1.1), (3, 1, 2.1)], 1), Some(3));
    // On two segments, in one revolution, of three impacts, of three revolutions.
    assert_eq!(half(2, &[(0, 1, 1.6), (1, 2, 2.7)], 0), None);
    assert_eq!(half(2, &[(0, 1, 1.6), (0, 1, 1.7)], 0), None);
    assert_eq!(half(2, &[(0, 1, 1.6), (1, 1, 1.7), (1, 1, 2.0)], 0), None);
    assert_eq!(half(3, &[(0, 1, 1.6), (1, 1, 1.7)], 0), None);
}

#[test]
fn the_nearest_other_impact_is_looked_for_all_round_the_cam() {
    let cycle = cycle!(2, [(0, 0, 1.0), (1, 0, 1.5), (0, 4, 6.2), (1, 2, 3.0)]);
    for (impact, nearest) in [(0, 0.5), (1, 0.5), (2, TAU - 5.2), (3, 1.5)] {
        assert_relative_eq!(cycle.nearest_other(impact), nearest, max_relative = 1e-14);
    }
    assert_eq!(cycle!(1, [(0, 0, 1.0)]).nearest_other(0), f64::INFINITY);
}

/// Two routes to the multipliers: the matrix of one period, and all flights at once.
#[test]
fn the_equations_of_all_flights_are_singular_at_the_multipliers_and_nowhere_else() {
    let (machine, mut seen) = (machine(700.0), 0);
    for impacts in [1, 2] {
        for orbit in orbits(&machine, impacts) {
            let cycle = cycle_of!(orbit);
            for multiplier in orbit.multipliers().iter().filter(|it| it.im == 0.0) {
                seen += 1;
                assert_abs_diff_eq!(cycle.characteristic(&machine, multiplier.re, 0.1), 0.0, epsilon = 1e-9);
                let other = cycle.characteristic(&machine, 1.0 / multiplier.re, 0.1);
                assert!(other.abs() > 1e-6, "{other} at 1 over {multiplier:?}");
            }
        }
    }
    assert!(seen >= 4, "{seen}");
}

/// The product of both is the determinant, however far apart they are.
#[test]
fn of_two_eigenvalues_far_apart_the_small_one_keeps_its_digits() {
    for (matrix, product) in [
        (Matrix2::new(1e8, 1.0, 1.0, 0.0), -1.0),
        (Matrix2::new(3e7, 1.0, -4.0, 1e-7), 7.0),
        (Matrix2::new(0.0, 2.0, 1.0, -1e9), -2.0),
        (Matrix2::new(1e-7, 1.0, -4.0, 3e7), 7.0),
    ] {
        let [one, two] = eigenvalues(&matrix);
        assert_relative_eq!(one.re * two.re, product, max_relative = 1e-14);
        assert!(one.re > two.re && one.im == 0.0 && two.im == 0.0, "{one:?} {two:?}");
    }
}

/// At 660 rpm there is no orbit of one impact, so that nothing is to be found from any guess.
#[test]
fn newtons_method_that_wanders_finds_nothing() {
    let (at_700, machine) = (machine(700.0), machine(660.0));
    for orbit in orbits(&at_700, 1) {
        for off in [-0.2, 0.0, 0.2] {
            let mut guess = cycle_of!(orbit);
            guess.impacts[0].cam_angle += off;
            match guess.closed(&machine) {
                Err(error) => assert!(error.residual > 1e-9, "{error}"),
                Ok((cycle, _)) => assert!(cycle.residual(&machine).amax() < 1e-9, "{cycle:?}"),
            }
        }
    }
}

/// An impact is a touch by how fast follower and cam approach each other, of both velocities.
#[test]
fn what_approaches_the_cam_by_a_thousand_millionth_of_its_velocity_only_touches_it() {
    let machine = machine(700.0);
    let cycle = cycle_of!(orbits(&machine, 1)[0]);
    let mut velocities = Vec::new();
    for turned in [1e-3, 1e-2, 0.1, 0.4] {
        let mut touching = cycle.clone();
        let segment = touching.impacts[0].segment;
        touching.impacts[0].cam_angle = machine.cam().segments()[segment].start + turned;
        touching.impacts[0].velocity_before = 0.0;
        let velocity = touching.approach(&machine, 0);
        velocities.push(velocity);
        for (part, touches) in [(0.9, true), (1.1, false)] {
            touching.impacts[0].velocity_before = velocity * (1.0 - part * 2e-9);
            let departure = format!("{:?}", touching.departure(&machine).unwrap());
            assert_eq!(departure.contains("Tangent"), touches, "{velocity} m/s: {departure}");
        }
    }
    assert!(velocities[0].abs() < 0.1 && velocities[3] > 3.0, "{velocities:?}");
}

/// A bounce that is over sooner than a touch is left behind is looked at from its half on.
#[test]
fn the_flight_after_a_touch_may_be_as_short_as_one_of_chattering() {
    let machine = machine(700.0);
    let mut cycle = cycle_of!(orbits(&machine, 1)[0]);
    let (angle, r) = (cycle.impacts[0].cam_angle, machine.restitution());
    let slow = 2e-3;
    let mut motion = machine.start_on_cam(angle, slow).unwrap();
    let mut events = Vec::new();
    machine.watch(&mut motion, 1, |event| events.push(*event)).unwrap();
    let turned = events[0].turned_since(angle);
    assert!((1e-4..1e-3).contains(&turned), "{turned}");
    cycle.impacts[0].velocity_before = machine.angular_velocity() * machine.cam().lift(angle).slope - slow / r;
    let mut next = cycle.impacts[0];
    (next.cam_angle, next.velocity_before) = (events[0].cam_angle, events[0].velocity_before);
    cycle.impacts.push(next);
    let departure = format!("{:?}", cycle.departure_but_for(&machine, Some(0)).unwrap());
    assert!(departure.contains("impact: 1"), "{departure}");
}

/// What the flight after a touch comes to is looked for no longer than to where the next impact is said to be.
#[test]
fn the_flight_after_a_touch_that_comes_down_later_is_none_of_the_cycle() {
    let machine = machine(700.0);
    let mut cycle = cycle_of!(orbits(&machine, 2)[0]);
    assert!(cycle.departure_but_for(&machine, Some(0)).unwrap().is_none());
    cycle.impacts[1].cam_angle -= 5e-4;
    let departure = format!("{:?}", cycle.departure_but_for(&machine, Some(0)).unwrap());
    assert_eq!(departure, "Some(Elsewhere { impact: 0 })");
}

/// Without a rebound a follower that is pressed against the cam begins no flight, wherever the cam lets go of it later.
#[test]
fn an_impact_that_a_follower_sticks_after_begins_no_flight() {
    let paper = common::osorio();
    let follower = Follower { restitution: 0.0, ..paper.follower };
    let plastic = Machine::new(common::cam(&paper), &follower, angular_velocity(700.0));
    let mut cycle = cycle_of!(orbits(&machine(700.0), 1)[0]);
    let mut released = 0;
    for degrees in 0..360 {
        let angle = f64::from(degrees).to_radians();
        let mut motion = plastic.start_on_cam(angle, 0.0).unwrap();
        let is_rising = plastic.cam().lift(angle).slope > 1e-3;
        if !(motion.contact && is_rising) {
            continue;
        }
        plastic.watch(&mut motion, 1, |event| released += u64::from(event.kind == EventKind::Release)).unwrap();
        let impact = &mut cycle.impacts[0];
        (impact.cam_angle, impact.segment) = (angle, plastic.cam().segment_at(angle));
        impact.velocity_before = 0.0;
        let departure = format!("{:?}", cycle.departure(&plastic).unwrap());
        assert_eq!(departure, "Some(Elsewhere { impact: 0 })", "{degrees}");
    }
    assert!(released > 10, "{released}");
}

/// A run from the state at angle 0 has the orbit's impacts and comes back, but for rounding as often as deviations grow: also where nothing is
/// left of an impact, and the cam falls away at once.
#[test]
#[ignore = "slow"]
fn an_orbit_without_a_rebound_is_a_motion() {
    let mut flown = 0;
    for case in drawn(cases_of_every_law(), 60) {
        let follower = Follower { restitution: 0.0, ..case.model.follower };
        let machine = Machine::new(case.machine.cam().clone(), &follower, angular_velocity(case.rpm));
        for orbit in search(&machine, &Search { revolutions: 1, impacts: None }).unwrap() {
            if !matches!(orbit.course, Course::Impacts(_)) {
                continue;
            }
            let mut motion = machine.start(0.0, orbit.state).unwrap();
            let mut met = Vec::new();
            machine.watch(&mut motion, 1, |event| met.push((event.kind, event.cam_angle))).unwrap();
            let grown = 1e-9 * (1.0 + orbit.matrix.norm());
            let same = met.len() == orbit.events.len()
                && met
                    .iter()
                    .zip(&orbit.events)
                    .all(|((kind, angle), event)| *kind == EventKind::Impact && apart(*angle, event.cam_angle) < grown);
            let off = (motion.state.position - orbit.state.position).abs() / case.stroke;
            assert!(same && off < grown, "{}: {off:e} {met:?} {orbit:?}", case.text);
            flown += 1;
        }
    }
    assert!(flown > 5, "{flown}");
}
