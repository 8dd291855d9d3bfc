//! Where the follower first leaves the cam, by runs alone: a second route to what the force between them says.

use std::ops::ControlFlow;

use crate::bracket::{Width, halve};
use crate::model::Model;
use crate::simulate::{Event, Machine, SimulateError, angular_velocity};
use crate::study::{StudyError, machine};
use crate::tolerance;

/// Where the follower first leaves the cam between two speeds, rpm; `None` where it leaves at the lower already, or at
/// neither.
pub fn detachment(model: &Model, [low, high]: [f64; 2]) -> Result<Option<f64>, StudyError> {
    /// Speeds that are looked at before the first change is narrowed down.
    const SPEEDS: u32 = 200;
    let machine = machine(model, low)?;
    if !stays(&machine, low)? {
        return Ok(None);
    }
    let at = |index: u32| low + (high - low) * f64::from(index) / f64::from(SPEEDS);
    for index in 1..=SPEEDS {
        if !stays(&machine, at(index))? {
            let (bracket, width) = ([at(index - 1), at(index)], Width::Relative(tolerance::ROOT_WIDTH.value));
            let [_, off] = halve(bracket, width, |rpm| Ok::<_, SimulateError>(!stays(&machine, rpm)?))?;
            return Ok(Some(off));
        }
    }
    Ok(None)
}

/// Whether a follower that is put on the cam stays there for a revolution.
fn stays(machine: &Machine, rpm: f64) -> Result<bool, SimulateError> {
    let machine = machine.at_speed(angular_velocity(rpm));
    let mut motion = machine.start_on_cam(0.0, 0.0)?;
    if !motion.contact {
        return Ok(false);
    }
    let goal = motion.after(1);
    let flow = machine.advance(&mut motion, goal, &mut |_: &Event| ControlFlow::Break(()))?;
    Ok(flow.is_continue())
}
