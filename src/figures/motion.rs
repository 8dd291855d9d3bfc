//! What the follower does at one speed once it has settled.

use crate::figures::Subject;
use crate::flight::State;
use crate::section;
use crate::simulate::{Event, Machine, Unobserved, angular_velocity};

/// Revolutions before anything is shown.
pub const TRANSIENT: u64 = 300;
/// Samples of a revolution.
const SAMPLES: u32 = 3600;

/// A stretch of motion at one speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Speed, rpm.
    pub rpm: f64,
    /// omega, rad/s.
    pub angular_velocity: f64,
    /// Evenly in angle, and twice at every event.
    pub samples: Vec<section::Sample>,
    /// The events.
    pub events: Vec<Event>,
}

impl Subject {
    /// The machine at a speed, rpm.
    pub(crate) fn machine(&self, rpm: f64) -> Machine {
        Machine::new(self.cam.clone(), &self.model.follower, angular_velocity(rpm))
    }

    /// `revolutions` of what a start at rest on the cam settles on, from cam angle 0 on; or why there are none.
    pub fn settled(&self, rpm: f64, revolutions: u64) -> Result<Run, String> {
        let machine = self.machine(rpm);
        let run = || {
            let mut motion = machine.start_on_cam(0.0, 0.0)?;
            let goal = motion.after(TRANSIENT);
            let _ = machine.advance(&mut motion, goal, &mut Unobserved)?;
            let mut motion = machine.resume(&motion)?;
            motion.revolution = 0;
            section::trace(&machine, motion, revolutions, SAMPLES)
        };
        let (samples, events) = run().map_err(|error| format!("at {rpm} rpm: {error}"))?;
        Ok(Run { rpm, angular_velocity: machine.angular_velocity(), samples, events })
    }

    /// One revolution of the orbit with its impact at the corner, from the section on.
    pub fn corner_orbit(&self) -> Result<Run, String> {
        let at = &self.found()?.at;
        let machine = self.machine(at.speed_rpm());
        let run = || section::trace(&machine, machine.start(at.section_angle(), at.state)?, 1, SAMPLES);
        let (samples, events) = run().map_err(|error| error.to_string())?;
        Ok(Run { rpm: at.speed_rpm(), angular_velocity: machine.angular_velocity(), samples, events })
    }

    /// The states at the section of the corner impact's map, once a revolution, that a start at rest on the cam settles on.
    pub fn section_states(&self, rpm: f64, revolutions: usize) -> Result<Vec<State>, String> {
        let machine = self.machine(rpm);
        let cam_angle = self.found()?.at.section_angle();
        let run = || {
            let mut motion = machine.start_on_cam(0.0, 0.0)?;
            let goal = motion.after(TRANSIENT);
            let _ = machine.advance(&mut motion, goal, &mut Unobserved)?;
            let mut states = Vec::with_capacity(revolutions);
            for _ in 0..revolutions {
                let goal = motion.next(cam_angle);
                let _ = machine.advance(&mut motion, goal, &mut Unobserved)?;
                states.push(motion.state);
            }
            Ok::<_, crate::simulate::SimulateError>(states)
        };
        run().map_err(|error| format!("at {rpm} rpm: {error}"))
    }
}
