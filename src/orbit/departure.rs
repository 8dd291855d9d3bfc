//! Checks whether a cycle that closes is an orbit of the actual cam, by simulating its flights one by one.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use super::cycle::Cycle;
use crate::simulate::{Event, Goal, Machine, SimulateError};
use crate::tolerance;

/// Event at which the motion on the actual cam leaves a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Departure {
    /// An impact outside of its segment.
    Beyond { impact: usize },
    /// An impact at which the follower would come out of the cam, or only touches it.
    Tangent { impact: usize },
    /// A flight that meets the cam too early.
    Earlier {
        /// Index of the impact that the flight starts at.
        impact: usize,
        event: Event,
        /// Angle turned since that impact, rad.
        turned: f64,
    },
    /// A flight that does not arrive at the next impact, or no flight at all, since the follower sticks.
    Elsewhere {
        /// Index of the impact that the flight starts at.
        impact: usize,
    },
}

impl Cycle {
    /// Simulates each flight, and returns where the motion on the actual cam leaves this cycle. `None` if it follows the cycle.
    pub fn departure(&self, machine: &Machine) -> Result<Option<Departure>, SimulateError> {
        self.departure_but_for(machine, None)
    }

    /// Checks an orbit that grazes: its impact `touch` is only a touch. The flight across the touch is simulated up to it, and again from
    /// where the gap has opened.
    pub fn departure_but_for(
        &self,
        machine: &Machine,
        touch: Option<usize>,
    ) -> Result<Option<Departure>, SimulateError> {
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
            if touch != Some(index)
                && !(struck.cam_velocity - impact.velocity_before > tolerance::GRAZING.value * scale)
            {
                return Ok(Some(Departure::Tangent { impact: index }));
            }
        }
        for index in 0..count {
            let turn = self.turn(index);
            if !(turn > 0.0) {
                return Ok(Some(Departure::Elsewhere { impact: index }));
            }
            let since = if touch == Some(index) { tolerance::TOUCH.value.min(0.5 * turn) } else { 0.0 };
            let to_touch = touch == Some((index + 1) % count);
            let Some((event, turned)) = self.next_event(machine, index, turn, since)? else {
                if to_touch {
                    continue;
                }
                return Ok(Some(Departure::Elsewhere { impact: index }));
            };
            let room = if to_touch { tolerance::TOUCH.value } else { tolerance::SAME_ORBIT.value };
            if turned < turn - room {
                return Ok(Some(Departure::Earlier { impact: index, event, turned }));
            }
        }
        Ok(None)
    }

    /// Returns the first event after an impact, and the angle turned from the impact to the event, rad. The search begins `since`, rad,
    /// after the impact and ends shortly after `turn`. `None` if there is no event, or if the follower does not leave the cam.
    fn next_event(
        &self,
        machine: &Machine,
        index: usize,
        turn: f64,
        since: f64,
    ) -> Result<Option<(Event, f64)>, SimulateError> {
        let impact = &self.impacts[index];
        let struck = self.struck(machine, index);
        // Rounding may put an impact outside of its revolution; then it is at angle 0.
        let on_cam = |angle: f64| if (0.0..TAU).contains(&angle) { angle } else { 0.0 };
        let from = on_cam(impact.cam_angle);
        let mut motion = if since > 0.0 {
            let (_, state) = machine.flight().fly(struck.leaving, since / machine.angular_velocity());
            machine.start(on_cam((from + since) % TAU), state)?
        } else {
            let relative = struck.leaving.velocity - machine.angular_velocity() * machine.cam().lift(from).slope;
            if relative < 0.0 {
                return Ok(None);
            }
            // A follower without rebound stays on the cam, or flies off at once where the cam falls away.
            let motion = machine.start_on_cam(from, relative)?;
            if motion.contact {
                return Ok(None);
            }
            motion
        };
        let begun = motion.cam_angle;
        let end = begun + turn - since + tolerance::SAME_ORBIT.value;
        let goal = Goal::turned(end);
        let mut met = None;
        let _ = machine.advance(&mut motion, goal, &mut |event: &Event| {
            met = Some((*event, since + event.turned_since(begun)));
            ControlFlow::Break(())
        })?;
        Ok(met)
    }
}
