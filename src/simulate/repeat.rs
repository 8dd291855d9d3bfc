//! Next impact of a settled motion: one turn later, at the same place up to the last digits.
//!
//! A flight of one turn is the same linear map each time, and the cam is at the same angle. So position and velocity one turn later cost a
//! few products. The next impact is found by checking that guess, without the general search.

use std::f64::consts::{PI, TAU};

use super::ahead::Again;
use super::motion::LastLift;
use super::{Machine, Motion};
use crate::flight::{Flight, Response, State};
use crate::tolerance;

/// Flight over one turn of the cam.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    time: f64,
    response: Response,
    /// Whether a flight that starts upwards has only one turning point in a turn, its highest point.
    rises_once: bool,
}

impl Turn {
    pub fn new(flight: &Flight, angular_velocity: f64) -> Self {
        let time = TAU / angular_velocity;
        // Turning points of an oscillation are half a period apart.
        let rises_once = flight.damped_frequency().is_none_or(|frequency| frequency * time <= PI);
        Self { time, response: flight.response(time), rises_once }
    }
}

impl Machine {
    /// Returns the next impact of a motion that has just left the cam and certainly rises above its top. `None` unless the impact is one
    /// turn later, to within the last Taylor step, and certainly the first.
    #[inline(always)]
    pub(super) fn again(&self, motion: &mut Motion, jerk: f64) -> Option<Again> {
        let Turn { time, response, rises_once } = self.turn;
        let (lift, start, omega) = (motion.lift?, motion.state, self.angular_velocity);
        if !rises_once {
            return None;
        }
        let force = self.flight.force(start.position);
        let gap = start.velocity * response.impulse + force * response.step;
        let end = State {
            position: start.position + gap,
            velocity: start.velocity * response.impulse_rate + force * response.impulse,
        };
        let rate = end.velocity - omega * lift.slope;
        let acceleration = self.flight.acceleration(end);
        // Halley's step from one turn later, -(g/g')/(1 - g g''/(2 g'^2)), with both fractions times g'^2. If the gap hardly changes, the
        // step would be short however far the contact is.
        let square = rate * rate;
        let bend = 0.5 * gap * (acceleration - omega * omega * lift.curvature);
        let step = -gap * rate / (square - bend);
        let shift = omega * step;
        if !(rate < 0.0
            && square.is_normal()
            && bend.abs() <= 0.5 * square
            && shift.abs() <= tolerance::LAST_TURN.value)
        {
            return None;
        }
        // The flight descends from above the top: it was there at this time before,
        let segment = &self.cam().segments()[motion.segment];
        let before = 1.25 * (self.terrain.top - end.position) / -end.velocity;
        let steepest = acceleration.abs() + jerk * before;
        let from_top = end.position + before * (-end.velocity - 0.5 * steepest * before) > self.terrain.top;
        // and since then the gap only shrank over one segment. Earlier, the only highest point lies between two points above the top.
        let shrinks = end.velocity + steepest * before < omega * segment.bounds.slope[0];
        let cam_angle = motion.cam_angle + shift;
        let inside = cam_angle - omega * before >= segment.start && cam_angle < segment.end;
        if !(from_top && shrinks && inside) {
            return None;
        }
        // Near an angle with a stored lift, its Taylor sum is as accurate as an evaluation.
        let is_near = (cam_angle - motion.known.angle).abs() <= tolerance::LAST_TURN.value;
        if !(is_near && motion.known.segment == motion.segment) {
            motion.known = LastLift { segment: motion.segment, angle: cam_angle, lift: segment.law.lift(cam_angle) };
        }
        Some(Again {
            time: time + step,
            cam_angle,
            velocity: end.velocity + step * (acceleration + 0.5 * step * self.flight.jerk(end)),
            lift: motion.known.lift.after(cam_angle - motion.known.angle),
        })
    }
}
