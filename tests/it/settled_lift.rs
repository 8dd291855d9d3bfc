//! Does a settled motion, whose impacts are summed from a lift known nearby, stay on the cam?

use std::f64::consts::PI;
use std::ops::ControlFlow;

use crate::common;
use corner_impact::flight::State;
use corner_impact::model::{Model, OSORIO_2008};
use corner_impact::simulate::{Event, EventKind, Machine, angular_velocity};

/// Runs `revolutions` from `turn`, rad, after the corner P, with `state`, and holds every impact against the lift of the
/// segment that it is on; the impacts, by how far after P they are, rad.
fn impacts(machine: &Machine, corner: f64, turn: f64, state: State, revolutions: u64) -> Vec<f64> {
    let mut motion = machine.start(corner + turn, state).unwrap();
    let goal = motion.after(revolutions);
    let mut found = Vec::new();
    let mut hold = |event: &Event| {
        if event.kind == EventKind::Impact {
            let segment = &machine.cam().segments()[event.segment];
            assert!(segment.start <= event.cam_angle && event.cam_angle <= segment.end, "{event:?}");
            let lift = segment.law.lift(event.cam_angle);
            let cam_velocity = machine.angular_velocity() * lift.slope;
            // An ulp of the value, and what an ulp of the angle makes of it.
            let rounding = |value: f64, rate: f64| 4.0 * f64::EPSILON * (value.abs() + rate.abs() * event.cam_angle);
            assert!((event.position - lift.value).abs() <= rounding(lift.value, lift.slope), "{event:?}, {lift:?}");
            let apart = (event.cam_velocity - cam_velocity).abs() / machine.angular_velocity();
            assert!(apart <= rounding(lift.slope, lift.curvature), "{event:?}, {cam_velocity}");
            found.push(event.cam_angle - corner);
        }
        ControlFlow::Continue(())
    };
    let _ = machine.advance(&mut motion, goal, &mut hold).unwrap();
    found
}

/// Next to the corner impact an orbit on the flank is left slowly for one on the nose: over the corner, by steps so small
/// that the lift known on the one side would be taken for that of the other; as it would from a start on the corner.
#[test]
fn a_settled_motion_goes_over_a_corner() {
    let model = Model::parse("osorio-2008.toml", OSORIO_2008).unwrap();
    let machine = Machine::new(common::cam(&model), &model.follower, 1.0);
    let corner = machine.cam().segments()[1].end;
    let (mut crossings, mut on_the_flank) = (0, 0);
    for parts in [1e-10, 1e-9, 1e-8] {
        let machine = machine.at_speed(angular_velocity(673.234445003848821 * (1.0 + parts)));
        for shift in [-1e-6, -1e-7, -1e-8, 0.0, 1e-8, 1e-7, 1e-6] {
            let state = State { position: 0.3 + 5.09700788184262174 + shift, velocity: 0.0 };
            let found = impacts(&machine, corner, PI, state, 3000);
            let near = |pair: &&[f64]| pair[0] * pair[1] < 0.0 && pair.iter().all(|apart| apart.abs() < 4e-7);
            crossings += found.windows(2).filter(near).count();
            // v+ = v- reversed, on an orbit that time reverses.
            let state = State { position: 0.3 + 0.231255562019001421, velocity: 174.300839020840963 + shift };
            let found = impacts(&machine, corner, 0.0, state, 100);
            on_the_flank += found.iter().filter(|apart| (-4e-7..0.0).contains(*apart)).count();
        }
    }
    assert!(
        crossings > 0 && on_the_flank > 0,
        "{crossings} go over the corner by small steps, {on_the_flank} close by"
    );
}

/// At other speeds it settles away from corners, to the last digits.
#[test]
fn a_settled_motion_stays_on_the_cam() {
    let model = Model::parse("osorio-2008.toml", OSORIO_2008).unwrap();
    let machine = Machine::new(common::cam(&model), &model.follower, 1.0);
    let corner = machine.cam().segments()[1].end;
    for rpm in [680.0, 700.0, 720.0, 738.0] {
        let machine = machine.at_speed(angular_velocity(rpm));
        let state = State { position: 0.3 + 5.09700788184262174, velocity: 0.0 };
        let found = impacts(&machine, corner, PI, state, 2000);
        let last = found.last().unwrap();
        assert!(found.iter().rev().take(100).all(|apart| (apart - last).abs() < 1e-12), "{rpm} rpm does not settle");
    }
}
