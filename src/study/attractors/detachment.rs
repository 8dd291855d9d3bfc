//! The speed at which the follower first leaves the cam, by runs alone: a second route besides the contact force.

use std::ops::ControlFlow;

use crate::bracket::{Width, halve};
use crate::model::Model;
use crate::simulate::{Event, Machine, SimulateError, angular_velocity};
use crate::study::{StudyError, machine};
use crate::tolerance;

/// Returns the speed, rpm, at which the follower first leaves the cam between two speeds. `None` if it leaves at the lower one already,
/// or at neither.
pub fn detachment(model: &Model, [low, high]: [f64; 2]) -> Result<Option<f64>, StudyError> {
    /// Number of speeds tried before the first change is bracketed.
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
