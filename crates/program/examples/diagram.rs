//! Sweeps the paper's model over speeds and draws where its impacts fall on the cam.
//!
//! `cargo run --release --example diagram -- diagram.svg`

use std::ops::ControlFlow;

use corner_impact::cam::Cam;
use corner_impact::model::{Model, OSORIO_2008};
use corner_impact::simulate::{Event, EventKind, Machine, Unobserved, angular_velocity};
use corner_impact_cli::figures::{corner_marks, impact_diagram};
use corner_impact_plot::{Density, Look, svg};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("the name of a file to write, such as diagram.svg")?;
    let model = Model::parse("osorio-2008.toml", OSORIO_2008)?;
    let cam = Cam::new(&model)?;
    let corners = corner_marks(&cam);
    let machine = Machine::new(cam, &model.follower, angular_velocity(700.0));

    let mut points = Density::new([660.0, 750.0], [0.0, 360.0]);
    let mut impacts = 0;
    for step in 0..=90 {
        let rpm = 660.0 + f64::from(step);
        let machine = machine.at_speed(angular_velocity(rpm));
        let mut motion = machine.start_on_cam(0.0, 0.0)?;
        let goal = motion.after(300);
        let _ = machine.advance(&mut motion, goal, &mut Unobserved)?;
        let goal = motion.after(100);
        let _ = machine.advance(&mut motion, goal, &mut |event: &Event| {
            if event.kind == EventKind::Impact {
                points.push(rpm, event.cam_angle.to_degrees());
                impacts += 1;
            }
            ControlFlow::Continue(())
        })?;
    }
    let figure = impact_diagram("Where the follower hits the cam", points, &corners, None);
    std::fs::write(&file, svg::render(&figure, &Look::default())?)?;
    println!("{impacts} impacts at 91 speeds drawn to {file}");
    Ok(())
}
