//! A cam of one's own, as the text of a model file: its corners, and the speed at which the follower first leaves it.
//!
//! `cargo run --release --example own_cam`

use corner_impact::cam::Cam;
use corner_impact::model::Model;
use corner_impact::simulate::{Machine, angular_velocity};

/// Rises in harmonic motion, dwells, and returns by a parabola.
const OWN: &str = r#"
name = "own cam"

[follower]
mass = 0.4
damping = 1.0
stiffness = 2000.0
gravity = 9.81
rest_position = 0.01
restitution = 0.6

[cam]
law = "program"
base = 0.03

[[cam.segment]]
motion = "harmonic"
span_deg = 90.0
rise = 0.012

[[cam.segment]]
motion = "dwell"
span_deg = 60.0

[[cam.segment]]
motion = "parabolic"
span_deg = 120.0
rise = -0.012

[[cam.segment]]
motion = "dwell"
span_deg = 90.0
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = Model::parse("own.toml", OWN)?;
    let cam = Cam::new(&model)?;
    for corner in cam.corners() {
        let angle = corner.angle.to_degrees();
        println!("{angle:8.3} deg: derivative {} jumps by {:+.6}", corner.jump_order, corner.jump);
    }
    let machine = Machine::new(cam, &model.follower, angular_velocity(1.0));
    // From rest on the cam, at rising whole speeds: the first at which a revolution has an event.
    let leaves = |rpm: f64| -> Result<bool, Box<dyn std::error::Error>> {
        let machine = machine.at_speed(angular_velocity(rpm));
        let mut motion = machine.start_on_cam(0.0, 0.0)?;
        let goal = motion.after(1);
        let mut left = false;
        let _ = machine.advance(&mut motion, goal, &mut |_: &corner_impact::simulate::Event| {
            left = true;
            std::ops::ControlFlow::Break(())
        })?;
        Ok(left)
    };
    for rpm in 1..=2000 {
        if leaves(f64::from(rpm))? {
            println!("the follower leaves this cam at {rpm} rpm, and not at {} rpm", rpm - 1);
            return Ok(());
        }
    }
    println!("the follower stays on this cam up to 2000 rpm");
    Ok(())
}
