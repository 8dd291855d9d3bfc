//! Where the follower first leaves the cam.

use std::ops::ControlFlow;

use super::rows::Grid;
use crate::bracket::{Width, halve};
use crate::cam::Cam;
use crate::model::Model;
use crate::orbit::ending::Ending;
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
            return Ok(Some(between(&machine, at(index - 1), at(index))?[1]));
        }
    }
    Ok(None)
}

/// Where the follower first leaves the cam near a speed, rpm; `None` where it does not.
pub fn detachment_near(model: &Model, cam: &Cam, rpm: f64) -> Option<f64> {
    /// How far it is looked for, of the speed: at first, and at most.
    const FAR: [f64; 2] = [0.01, 0.9];
    let machine = Machine::new(cam.clone(), &model.follower, angular_velocity(rpm));
    let mut far = FAR[0];
    while far < FAR[1] {
        let [low, high] = [rpm * (1.0 - far), rpm * (1.0 + far)];
        if stays(&machine, low).ok()? && !stays(&machine, high).ok()? {
            let width = Width::Absolute(tolerance::SPEED_FOUND.value);
            return halve([low, high], width, |rpm| stays(&machine, rpm).map(|stays| !stays))
                .ok()
                .map(|found| found[1]);
        }
        far *= 2.0;
    }
    None
}

/// The neighbouring speeds, rpm, of which the follower stays on the cam at the first only, between two of a grid.
pub(super) fn between_speeds(machine: &Machine, grid: &Grid) -> Option<[f64; 2]> {
    let pair = grid.windows(2).find_map(|pair| {
        let [Ok(one), Ok(two)] = pair else { return None };
        let stays = |here: &super::Here| here.parts.iter().any(|part| part.ending == Ending::Stays);
        (stays(one) && !stays(two)).then_some([one.rpm, two.rpm])
    })?;
    between(machine, pair[0], pair[1]).ok()
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

/// The neighbouring speeds, rpm, of which the follower stays on the cam at the first only; between one where it does and
/// one where it does not.
fn between(machine: &Machine, on: f64, off: f64) -> Result<[f64; 2], SimulateError> {
    halve([on, off], Width::Relative(tolerance::ROOT_WIDTH.value), |rpm| Ok(!stays(machine, rpm)?))
}
