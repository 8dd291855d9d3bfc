//! Does a machine with a mirrored cam do what it must?
//!
//! A mirrored cam that turned backwards would be the same lift at each time; speeds are above 0 here, so the mirror is written
//! into the model file, law by law, and what it has to keep is asked: the lift at each angle is that of the opposite angle, a cam that is
//! mirrored twice moves its follower as the first does, and what loses no energy, without damping and with a restitution of 1, goes back
//! the way that it came when its cam turns the other way. What loses energy does not: there is no more to ask of it.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use corner_impact::cam::Cam;
use corner_impact::simulate::{Event, EventKind, Machine, Motion};
use proptest::prelude::*;

use crate::random::{Case, check, model};

fn numbers(list: &str) -> Vec<f64> {
    list.trim_matches(['[', ']']).split(',').map(|number| number.trim().parse().unwrap()).collect()
}

/// The value of a field in lines of TOML.
fn field<'a>(lines: &'a str, name: &str) -> &'a str {
    lines.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(" = ")).unwrap()
}

/// A polynomial in x, as one in h - x.
fn from_the_other_end(coefficients: &[f64], h: f64) -> Vec<f64> {
    let mut turned = vec![0.0; coefficients.len()];
    for coefficient in coefficients.iter().rev() {
        // Horner's rule: times h - x, and one more.
        let times: Vec<f64> =
            (0..turned.len()).map(|k| h * turned[k] - if k > 0 { turned[k - 1] } else { 0.0 }).collect();
        turned = times;
        turned[0] += coefficient;
    }
    turned
}

/// `[cam]` and its table with the lift at each angle that they have at the opposite one.
fn mirrored(cam: &str, table: Option<&str>) -> (String, Option<String>) {
    let opposite = |degrees: f64| if degrees == 0.0 { 0.0 } else { 360.0 - degrees };
    let (head, segments) = cam.split_once("[[cam.segment]]\n").unwrap_or((cam, ""));
    let segments: Vec<&str> = segments.split("[[cam.segment]]\n").collect();
    let with = |segments: Vec<String>| {
        segments.into_iter().fold(head.to_owned(), |text, segment| text + "[[cam.segment]]\n" + &segment)
    };
    let text = match field(cam, "law").trim_matches('"') {
        // These are their own mirrors.
        "rectified-sine" | "table" => cam.to_owned(),
        // The line of motion is on the other side of the axis.
        "arcs" => match cam.lines().find_map(|line| line.strip_prefix("contact.offset = ")) {
            Some(offset) => {
                let other = format!("contact.offset = {:?}", -offset.parse::<f64>().unwrap());
                cam.replace(&format!("contact.offset = {offset}"), &other)
            }
            None => cam.to_owned(),
        },
        "harmonic" => {
            let phases = field(cam, "phases_deg");
            let mirror: Vec<f64> = numbers(phases).into_iter().map(opposite).collect();
            cam.replace(phases, &format!("{mirror:?}"))
        }
        "program" => {
            let turned = |segment: &&str| {
                let rise = field(segment, "rise");
                segment.replace(&format!("rise = {rise}"), &format!("rise = {:?}", -rise.parse::<f64>().unwrap()))
            };
            with(segments.iter().rev().map(turned).collect())
        }
        "polynomial" => {
            let starts: Vec<f64> =
                segments.iter().map(|segment| field(segment, "start_deg").parse().unwrap()).collect();
            let turned = |index: usize| {
                let end = starts.get(index + 1).copied().unwrap_or(starts[0] + 360.0);
                let coefficients = numbers(field(segments[index], "coefficients"));
                let coefficients = from_the_other_end(&coefficients, (end - starts[index]).to_radians());
                let start = if end > 360.0 { 720.0 - end } else { opposite(end) };
                (start, format!("start_deg = {start:?}\ncoefficients = {coefficients:?}\n"))
            };
            let mut all: Vec<(f64, String)> = (0..segments.len()).map(turned).collect();
            all.sort_by(|one, other| one.0.total_cmp(&other.0));
            with(all.into_iter().map(|(_, text)| text).collect())
        }
        law => panic!("how is {law} mirrored?"),
    };
    let table = table.map(|table| {
        let row =
            |row: &str| row.split_once(',').map(|(angle, lift)| (opposite(angle.parse().unwrap()), lift.to_owned()));
        let mut rows: Vec<(f64, String)> = table.lines().skip(1).filter_map(row).collect();
        rows.sort_by(|one, other| one.0.total_cmp(&other.0));
        rows.into_iter()
            .fold("angle_deg,lift\n".to_owned(), |text, (angle, lift)| text + &format!("{angle:?},{lift}\n"))
    });
    (text, table)
}

/// The machine of a case with its cam mirrored so often, and with other fields of the follower.
fn machine(case: &Case, times: usize, changes: &[(&str, f64)]) -> Machine {
    let (follower, cam) = case.text.split_once("[cam]\n").unwrap();
    let once = |(cam, table): (String, Option<String>), _| mirrored(&cam, table.as_deref());
    let (cam, table) = (0..times).fold((cam.to_owned(), case.table.clone()), once);
    let line = |line: &str| {
        let change = changes.iter().find(|(name, _)| line.starts_with(&format!("{name} = ")));
        change.map_or(line.to_owned(), |(name, value)| format!("{name} = {value:?}"))
    };
    let follower: Vec<String> = follower.lines().map(line).collect();
    let model = model(&format!("{}\n[cam]\n{cam}", follower.join("\n")), table.as_deref());
    Machine::new(Cam::new(&model).unwrap(), &model.follower, case.machine.angular_velocity())
}

fn opposite(angle: f64) -> f64 {
    if angle == 0.0 { 0.0 } else { TAU - angle }
}

fn around(one: f64, other: f64) -> f64 {
    let apart = (one - other).abs() % TAU;
    apart.min(TAU - apart)
}

/// Up to so many impacts, but none after something else, within so many turns of the cam.
fn impacts(machine: &Machine, mut motion: Motion, most: usize, turns: u64) -> Vec<Event> {
    let (mut events, goal) = (Vec::new(), motion.after(turns));
    let _ = machine.advance(&mut motion, goal, &mut |event: &Event| {
        if event.kind == EventKind::Impact {
            events.push(*event);
        }
        if event.kind == EventKind::Impact && events.len() < most {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    });
    events
}

#[test]
fn a_mirrored_cam_has_the_lift_of_the_opposite_angle() {
    check(300, |case| {
        let (cam, mirror) = (case.machine.cam(), machine(case, 1, &[]));
        for step in 0..97 {
            let angle = TAU * (f64::from(step) + 0.37) / 97.0;
            let (lift, there) = (cam.lift(angle), mirror.cam().lift(opposite(angle)));
            let segment = &cam.segments()[cam.segment_at(angle)];
            let size = |bounds: [f64; 2]| 1e-9 * (bounds[0].abs().max(bounds[1].abs()) + case.stroke);
            let near = |one: f64, other: f64, size: f64| (one - other).abs() <= size;
            prop_assert!(near(lift.value, there.value, size(segment.bounds.lift)), "{angle}: {lift:?} {there:?}");
            prop_assert!(near(lift.slope, -there.slope, size(segment.bounds.slope)), "{angle}: {lift:?} {there:?}");
            prop_assert!(
                near(lift.curvature, there.curvature, size(segment.bounds.curvature)),
                "{angle}: {lift:?} {there:?}"
            );
        }
        let places = |machine: &Machine| machine.cam().corners().len();
        prop_assert_eq!(places(&case.machine), places(&mirror));
        Ok(())
    });
}

/// What a run of a few impacts may differ by: rounding, over the slowness of the impact that makes most of it.
fn is_rough(case: &Case, event: &Event) -> bool {
    (event.velocity_before - event.cam_velocity).abs() < 1e-3 * case.velocity()
}

#[test]
#[ignore = "slow"]
fn a_cam_that_is_mirrored_twice_moves_its_follower_as_the_first() {
    check(500, |case| {
        let Ok(start) = case.motion() else { return Ok(()) };
        let twice = machine(case, 2, &[]);
        let Ok(again) = twice.start(start.cam_angle, start.state) else { return Ok(()) };
        // One that rests on the cam, or bounces too slowly to be told from that, begins as rounding has it.
        if start.contact || start.state.position - case.machine.cam().lift(case.angle).value < 1e-3 * case.stroke {
            return Ok(());
        }
        let (one, other) = (impacts(&case.machine, start, 3, 20), impacts(&twice, again, 3, 20));
        let smooth = one.iter().position(|event| is_rough(case, event)).unwrap_or(one.len());
        prop_assert!(other.len() >= smooth, "{one:?} {other:?}");
        for (one, other) in one.iter().zip(&other).take(smooth) {
            prop_assert!(around(one.cam_angle, other.cam_angle) < 1e-6, "{one:?} {other:?}");
            let apart = (one.velocity_after - other.velocity_after).abs();
            prop_assert!(apart < 1e-6 * case.velocity(), "{one:?} {other:?}");
        }
        Ok(())
    });
}

#[test]
#[ignore = "slow"]
fn what_loses_no_energy_goes_back_over_the_mirrored_cam() {
    check(500, |case| {
        let changes = [("damping", 0.0), ("restitution", 1.0)];
        let (there, back) = (machine(case, 0, &changes), machine(case, 1, &changes));
        let Ok(Ok(start)) = case.motion().map(|start| there.start(start.cam_angle, start.state)) else { return Ok(()) };
        let forth = impacts(&there, start, 2, 20);
        let [first, second] = forth.as_slice() else { return Ok(()) };
        // Where the cam's velocity jumps, it is that of the segment which is hit: another one from the other side.
        let segments = there.cam().segments();
        let is_told = |event: &&Event| {
            !is_rough(case, event) && segments.iter().all(|segment| around(segment.start, event.cam_angle) > 1e-6)
        };
        if ![first, second].iter().all(is_told) {
            return Ok(());
        }
        // The last impact begins the way back, which comes to the one before with the velocity that it left with.
        let leaves = second.cam_velocity - second.velocity_before;
        let start = back.start_on_cam(opposite(second.cam_angle), leaves).unwrap();
        let returned = impacts(&back, start, 1, 20);
        let [event] = returned.as_slice() else { return Err(TestCaseError::fail(format!("{forth:?} {returned:?}"))) };
        prop_assert!(around(event.cam_angle, opposite(first.cam_angle)) < 1e-6, "{forth:?} {event:?}");
        let apart = [event.velocity_before + first.velocity_after, event.velocity_after + first.velocity_before];
        prop_assert!(apart.iter().all(|apart| apart.abs() < 1e-5 * case.velocity()), "{forth:?} {event:?}");
        COMPARED.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        Ok(())
    });
    assert!(COMPARED.load(std::sync::atomic::Ordering::Relaxed) > 100, "{COMPARED:?}");
}

static COMPARED: std::sync::atomic::AtomicU32 = std::sync::atomic::AtomicU32::new(0);
