//! Do the searches for a contact and for a release find what is there, in any unit, and say where they were given up?

use std::ops::ControlFlow;

use crate::common;
use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::flight::State;
use corner_impact::inner::{GapAt, Outcome, first_contact};
use corner_impact::model::Model;
use corner_impact::simulate::{Event, EventKind, Goal, Machine, Motion, SimulateError};

/// A follower of mass 1 by damping, stiffness, gravity and rest position, without rebound, over a `[cam]`, at a speed in rad/s.
fn machine([damping, stiffness, gravity, rest]: [f64; 4], cam: &str, omega: f64) -> Machine {
    let text = format!(
        "[follower]\nmass = 1.0\ndamping = {damping:?}\nstiffness = {stiffness:?}\ngravity = {gravity:?}\n\
         rest_position = {rest:?}\nrestitution = 0.0\n[cam]\n{cam}"
    );
    let model = Model::parse("searched.toml", &text).unwrap();
    Machine::new(common::cam(&model), &model.follower, omega)
}

/// `[cam]` of polynomials from each of these angles, rad, on.
fn pieces(pieces: &[(f64, &[f64])]) -> String {
    let piece = |(start, coefficients): &(f64, &[f64])| {
        format!("[[cam.segment]]\nstart_deg = {:?}\ncoefficients = {coefficients:?}\n", start.to_degrees())
    };
    format!("law = \"polynomial\"\n{}", pieces.iter().map(piece).collect::<String>())
}

fn first_event(machine: &Machine, mut motion: Motion) -> Event {
    let mut first = None;
    let goal = motion.after(1);
    let _ = machine
        .advance(&mut motion, goal, &mut |event: &Event| {
            first.get_or_insert(*event);
            ControlFlow::Break(())
        })
        .unwrap();
    first.unwrap()
}

fn advance(machine: &Machine, motion: &mut Motion, cam_angle: f64) -> Result<(), SimulateError> {
    let goal = Goal { cam_angle, ..motion.after(0) };
    machine.advance(motion, goal, &mut |_: &Event| ControlFlow::Continue(())).map(|_| ())
}

/// The last Newton step towards a contact leads no deeper into the cam, and not to where the follower moves away already.
#[test]
fn a_contact_is_within_rounding_of_the_cam_and_the_follower_approaches_there() {
    let power = |exponent: i32| 2.0_f64.powi(exponent);
    let rounding = power(-50);
    for (rate, curvature) in [
        // The step would lead 512 roundings deep,
        (-power(-30), -1.0),
        // beyond the lowest gap, and to it.
        (-power(-25), 1.5),
        (-power(-25), 1.0),
        (-power(-25), 0.125),
        (-power(-25), -0.125),
    ] {
        let gap_at = |time: f64| GapAt {
            value: rounding + time * (rate + 0.5 * curvature * time),
            rounding,
            rate: rate + curvature * time,
            rate_rounding: power(-52),
            curvature,
            third: 0.0,
        };
        let Outcome::Contact(time) = first_contact(gap_at, |_, _| 0.0, 1.0, 100) else { panic!("{rate} {curvature}") };
        let there = gap_at(time);
        assert!(there.value.abs() <= rounding && there.rate < 0.0, "{rate} {curvature}: {there:?}");
        assert!(curvature.abs() >= 1.0 || there.value.abs() < 0.1 * rounding, "{rate} {curvature}: {there:?}");
    }
}

/// A follower that is inside the cam by a few roundings, and neither moves nor is lifted, is in contact; one that moves out leaves it.
#[test]
fn a_follower_that_is_inside_the_cam_by_rounding_rests_or_leaves() {
    let gap = |time: f64, rate: f64, curvature: f64| GapAt {
        value: -1e-14 + time * (rate + 0.5 * curvature * time),
        rounding: 1e-15,
        rate: rate + curvature * time,
        rate_rounding: 1e-16,
        curvature,
        third: 0.0,
    };
    let first = |rate: f64, curvature: f64| first_contact(|time| gap(time, rate, curvature), |_, _| 0.0, 1.0, 100);
    assert_eq!(first(0.0, -1.0), Outcome::Contact(0.0));
    assert_eq!([first(0.0, 1.0), first(1.0, 1.0), first(1.0, -0.5)], [Outcome::None; 3]);
    let Outcome::Contact(time) = first(1.0, -10.0) else { panic!("no contact") };
    assert_abs_diff_eq!(time, 0.2, epsilon = 1e-13);
}

/// Spring and cam swing alike, so that all but `preload` of the force cancels all round: c = size (1 + cos(theta)/10).
fn near_zero(size: f64, omega: f64, preload: f64) -> Machine {
    let cam = format!("law = \"harmonic\"\noffset = {size:?}\namplitudes = [{:?}]\nphases_deg = [0.0]\n", 0.1 * size);
    machine([0.0, omega * omega, 0.0, size * (1.0 - preload)], &cam, omega)
}

/// In any unit of length and time a search along the cam takes steps of the same turn.
#[test]
fn a_force_near_zero_is_followed_as_far_in_any_unit() {
    let units = [-66, 0, 66].map(|power| 2.0_f64.powi(power));
    for (size, omega) in units.into_iter().flat_map(|size| units.map(|omega| (size, omega))) {
        let machine = near_zero(size, omega, 2e-8).giving_up_after(100_000);
        let mut motion = machine.start_on_cam(0.0, 0.0).unwrap();
        machine.revolve(&mut motion, 1).unwrap();
        assert!(motion.contact, "{size:e} m, {omega:e} rad/s");
    }
}

/// A search that is given up has passed nothing up to where it was, so that a run up to there is none the worse.
#[test]
fn a_search_that_is_given_up_says_where() {
    const FROM: f64 = 0.3;
    let rests = near_zero(1.0, 16.0, 1e-9);
    // The follower swings many times before the cam comes up to it.
    let cam = "law = \"harmonic\"\noffset = 0.0\namplitudes = [0.1]\nphases_deg = [180.0]\n";
    let flies = machine([0.0, 1e6, 0.0, 0.02], cam, 16.0);
    let swinging = State { position: 0.04, velocity: 0.0 };
    let contact = first_event(&flies, flies.start(FROM, swinging).unwrap()).cam_angle;
    for (whole, end) in [(&rests, 6.0), (&flies, contact)] {
        let start = if end == contact { whole.start(FROM, swinging) } else { whole.start_on_cam(FROM, 0.0) }.unwrap();
        let mut farthest = FROM;
        for steps in [1, 2, 4, 8, 16] {
            let machine = whole.giving_up_after(steps);
            let given_up = advance(&machine, &mut start.clone(), 6.0);
            let Err(SimulateError::NoProgress { events, revolution: 0, cam_angle }) = given_up else {
                panic!("{steps}: {given_up:?}");
            };
            assert!(events == steps && farthest < cam_angle && cam_angle < end, "{steps}: {cam_angle} {end}");
            farthest = cam_angle;
            let mut motion = start;
            let before = 0.5 * (FROM + cam_angle);
            advance(&machine, &mut motion, before).unwrap();
            assert_eq!(motion.cam_angle, before);
            assert_eq!(advance(&machine, &mut motion, 6.0), given_up);
        }
    }
    // From angle 0 on, where no difference is rounded, also exactly up to there.
    let machine = rests.giving_up_after(5);
    let start = machine.start_on_cam(0.0, 0.0).unwrap();
    let given_up = advance(&machine, &mut start.clone(), 6.0);
    let Err(SimulateError::NoProgress { cam_angle, .. }) = given_up else { panic!("{given_up:?}") };
    let mut motion = start;
    advance(&machine, &mut motion, cam_angle).unwrap();
    assert!(motion.contact && motion.cam_angle == cam_angle && cam_angle > 0.0);
    assert_eq!(machine.rests().map(|_| ()), given_up);
}

/// A force of seven roundings, where it is the difference of two terms that are each known to four, lifts no follower; a larger one does.
#[test]
fn a_force_within_the_rounding_of_its_terms_is_none() {
    let end = std::f64::consts::TAU - 1.0;
    // The damper and the spring, each against the cam's acceleration; all is exact.
    for (follower, slope, presses) in [([64.0, 0.0, 0.0, 0.0], 1.0, -1.0), ([0.0, 4096.0, 0.0, 1.0], 0.0, 1.0)] {
        for (roundings, lifts) in [(-1e3, false), (-7.0, false), (0.0, false), (7.0, false), (1e3, true)] {
            let half = 0.5 * (presses - roundings * f64::EPSILON);
            let closing = -(slope + half * end) / (end * end);
            let cam = pieces(&[(0.0, &[0.0]), (1.0, &[0.0, slope, half, closing])]);
            let machine = machine(follower, &cam, 64.0);
            let start = machine.start_on_cam(machine.cam().segments()[1].start, 0.0).unwrap();
            assert_eq!(start.contact, !lifts, "{follower:?}: {roundings}");
        }
    }
}

/// c = 3x - x^3/4 lets go of a follower that gravity alone holds where c'' = -g/w^2 = -1, at x = 2/3, however steeply it rises there.
#[test]
fn a_cam_lets_go_where_it_rises() {
    let fall = -2.75 / (std::f64::consts::TAU - 2.0);
    let cam = pieces(&[(0.0, &[0.0]), (1.0, &[0.0, 3.0, 0.0, -0.25]), (2.0, &[2.75, fall])]);
    let machine = machine([0.0, 0.0, 1.0, 0.0], &cam, 1.0);
    let event = first_event(&machine, machine.start_on_cam(1.1, 0.0).unwrap());
    assert_eq!(event.kind, EventKind::Release);
    assert_abs_diff_eq!(event.cam_angle, 1.0 + 2.0 / 3.0, epsilon = 1e-9);
}

/// A follower that has just left the cam, and comes back only behind the end of a segment, does not hit it as it leaves.
#[test]
fn a_follower_that_moves_away_does_not_hit_the_cam() {
    let hill: [(f64, &[f64]); 3] = [(0.0, &[0.0]), (1.0, &[0.0, 0.0, 1.0, -1.0 / 3.0]), (4.0, &[0.0])];
    let machine = machine([0.0, 0.01, 10.0, 0.0], &pieces(&hill), 1.0);
    for gap in [2e-15, 1e-14, 1e-13] {
        // u t - g t^2/2 = 0 at t = 1.01, and the dwell ends at 1.
        let start = machine.start(0.0, State { position: gap, velocity: 5.05 }).unwrap();
        let event = first_event(&machine, start);
        assert!(event.kind == EventKind::Impact && event.cam_angle > 1.0, "{event:?}");
    }
}

/// The velocity of the cam at an impact is that at its angle, also where it changes so fast that the last step of the search changes it.
#[test]
fn the_velocity_of_the_cam_is_that_at_the_angle_of_the_impact() {
    const SIZE: f64 = 1e-4;
    const WAVES: usize = 200;
    let mut amplitudes = vec![0.0; WAVES];
    (amplitudes[0], amplitudes[WAVES - 1]) = (SIZE, 0.2 * SIZE / WAVES as f64);
    let cam =
        format!("law = \"harmonic\"\noffset = 0.0\namplitudes = {amplitudes:?}\nphases_deg = {:?}\n", vec![0.0; WAVES]);
    let machine = machine([0.0; 4], &cam, 10.0);
    let lift = machine.cam().lift(1.0).value;
    for index in 0..500 {
        let position = lift + SIZE * (0.25 + 0.2 * f64::from(index) / 500.0);
        let start = machine.start(1.0, State { position, velocity: -40.0 * SIZE }).unwrap();
        let event = first_event(&machine, start);
        let slope = machine.cam().lift(event.cam_angle).slope;
        // Of the angle's rounding the 200th cosine makes 1e-14.
        assert_relative_eq!(event.cam_velocity, 10.0 * slope, epsilon = 0.0, max_relative = 5e-14);
    }
}
