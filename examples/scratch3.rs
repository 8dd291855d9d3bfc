#![allow(missing_docs, clippy::unwrap_used, clippy::panic)]
use corner_impact::{cam::Cam, flight::State, model::*, simulate::*};
use std::{f64::consts::TAU, ops::ControlFlow};
fn main() {
    for (stiffness, gravity, damping) in [(400.0, 0.0, 0.0), (0.0, 9.81, 0.0), (3000.0, 1.0, 4.0), (900.0, 0.0, 80.0)] {
        let text = format!(
            "[follower]\nmass = 1.0\ndamping = {damping}\nstiffness = {stiffness}\ngravity = {gravity}\nrest_position = -0.2\nrestitution = 0.7\n[cam]\nlaw = \"harmonic\"\noffset = 0.0\namplitudes = [0.02, 0.0, 0.004, 0.0, 0.0, 0.0, 0.002, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0008]\nphases_deg = [0, 0, 50, 0, 0, 0, 20, 0, 0, 0, 0, 0, 70]\n"
        );
        let model = Model::parse("toothed.toml", &text).unwrap();
        let cam = Cam::new(&model).unwrap();
        for rpm in [20.0, 60.0, 150.0, 400.0, 1500.0] {
            let m = Machine::new(cam.clone(), &model.follower, angular_velocity(rpm));
            for k in 0..40 {
                for velocity in [0.02, 0.1, 0.5, 2.0] {
                    for below in [false, true] {
                        let angle = TAU * f64::from(k) / 40.0;
                        let lift = m.cam().lift(angle);
                        let s = if below {
                            State { position: lift.value + 0.05 * velocity, velocity: -velocity }
                        } else {
                            State { position: lift.value, velocity: m.angular_velocity() * lift.slope + velocity }
                        };
                        let mut ev: Vec<Event> = vec![];
                        let mut n = 0;
                        let r = m.turn(angle, s, 0.9 * TAU, |e| {
                            n += 1;
                            if ev.len() < 400 {
                                ev.push(*e);
                            }
                            if n > 5000 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
                        });
                        if r.is_err() || n > 5000 {
                            println!(
                                "k {stiffness} g {gravity} b {damping} rpm {rpm} k {k} v {velocity} {below} {r:?}"
                            );
                            for e in ev.iter().skip(380).take(8) {
                                println!(
                                    "  {:?} {:.17} u- {:e} u+ {:e}",
                                    e.kind,
                                    e.cam_angle,
                                    e.velocity_before - e.cam_velocity,
                                    e.velocity_after - e.cam_velocity
                                );
                            }
                            return;
                        }
                    }
                }
            }
        }
    }
}
