//! Whether a cycle that closes is an orbit of the cam as it is: its flights, simulated one by one.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use super::cycle::Cycle;
use crate::simulate::{Event, Goal, Machine, SimulateError};
use crate::tolerance;

/// How the motion of the cam as it is leaves a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Departure {
    /// An impact lies outside of its segment.
    Beyond { impact: usize },
    /// The follower would come out of the cam at an impact, or touches it only.
    Tangent { impact: usize },
    /// The flight that starts at this impact meets the cam before it should.
    Earlier {
        /// Index of the impact that the flight starts at.
        impact: usize,
        event: Event,
    },
    /// The flight that starts at this impact does not come to the next; or there is none, since the follower sticks.
    Elsewhere {
        /// Index of the impact that the flight starts at.
        impact: usize,
    },
}

impl Cycle {
    /// Where the cam as it is leaves this cycle, flight by flight, by simulation; `None` where it does not.
    pub fn departure(&self, machine: &Machine) -> Result<Option<Departure>, SimulateError> {
        let segments = machine.cam().segments();
        let count = self.impacts.len();
        for (index, impact) in self.impacts.iter().enumerate() {
            let segment = &segments[impact.segment];
            let slack = tolerance::CORNER_ANGLE.value;
            if !(impact.cam_angle >= segment.start - slack && impact.cam_angle <= segment.end + slack) {
                return Ok(Some(Departure::Beyond { impact: index }));
            }
            let struck = self.struck(machine, index);
            let scale = struck.cam_velocity.abs() + impact.velocity_before.abs();
            if !(struck.cam_velocity - impact.velocity_before > tolerance::GRAZING.value * scale) {
                return Ok(Some(Departure::Tangent { impact: index }));
            }
        }
        for index in 0..count {
            let turn = self.turn(index);
            if !(turn > 0.0) {
                return Ok(Some(Departure::Elsewhere { impact: index }));
            }
            let Some((met, turned)) = self.next_event(machine, index, turn)? else {
                return Ok(Some(Departure::Elsewhere { impact: index }));
            };
            if turned < turn - tolerance::SAME_ORBIT.value {
                return Ok(Some(Departure::Earlier { impact: index, event: met }));
            }
        }
        Ok(None)
    }

    /// The first event after a impact, and the angle turned to it, rad; `None` where there is none for somewhat longer than
    /// `turn`.
    fn next_event(&self, machine: &Machine, index: usize, turn: f64) -> Result<Option<(Event, f64)>, SimulateError> {
        let impact = &self.impacts[index];
        let struck = self.struck(machine, index);
        // A impact that rounding puts outside of its revolution is at the end of it.
        let cam_angle = if impact.cam_angle >= TAU || impact.cam_angle < 0.0 { 0.0 } else { impact.cam_angle };
        let relative = struck.leaving.velocity - machine.angular_velocity() * machine.cam().lift(cam_angle).slope;
        if relative <= 0.0 {
            return Ok(None);
        }
        let mut motion = machine.start_on_cam(cam_angle, relative)?;
        let end = cam_angle + turn + tolerance::SAME_ORBIT.value;
        let goal = Goal { revolution: (end / TAU) as u64, cam_angle: end % TAU };
        let mut met = None;
        let _ = machine.advance(&mut motion, goal, &mut |event: &Event| {
            met = Some((*event, event.turned_since(cam_angle)));
            ControlFlow::Break(())
        })?;
        Ok(met)
    }
}
