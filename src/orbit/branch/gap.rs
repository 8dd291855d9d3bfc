//! The least gap of a flight between two impacts: positive where the flight clears the cam, 0 where it touches.

use std::f64::consts::TAU;

use crate::orbit::Cycle;
use crate::simulate::Machine;
use crate::tolerance;

/// Least gap, m, of the flight that starts at contact `index`, near an angle `turned`, rad, after its start; and where, rad
/// after its start.
///
/// `None` where the gap has no minimum there but falls to one of the flight's ends.
pub(super) fn least(cycle: &Cycle, machine: &Machine, index: usize, turned: f64) -> Option<(f64, f64)> {
    /// From where to where the minimum is walked to, in parts of the flight.
    const PARTS: f64 = 400.0;
    let (start, _) = cycle.flight(machine, index);
    let from = cycle.contacts[index].cam_angle;
    let whole = cycle.turn(index);
    let omega = machine.angular_velocity();
    let gap = |turned: f64| {
        let angle = (from + turned).rem_euclid(TAU);
        let lift = machine.cam().lift(if angle < TAU { angle } else { 0.0 });
        machine.flight().fly(start, turned / omega).1.position - lift.value
    };
    let stride = whole / PARTS;
    let inside = |turned: f64| turned > stride && turned < whole - stride;
    let mut at = turned.clamp(2.0 * stride, whole - 2.0 * stride);
    let direction = if gap(at + stride) < gap(at - stride) { stride } else { -stride };
    while gap(at + direction) < gap(at) {
        at += direction;
        if !inside(at) {
            return None;
        }
    }
    // Golden section: the gap is smooth but at corners, and one minimum is inside.
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = (at - stride, at + stride);
    let (mut left, mut right) = (high - golden * (high - low), low + golden * (high - low));
    let (mut at_left, mut at_right) = (gap(left), gap(right));
    // Sixty sections leave less than rounding of the angle.
    for _ in 0..60 {
        if at_left < at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - golden * (high - low);
            at_left = gap(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + golden * (high - low);
            at_right = gap(right);
        }
    }
    let at = 0.5 * (low + high);
    // Sections see half the digits of where it is; the relative velocity, which is 0 there, sees all of them.
    let mut sharp = at;
    for _ in 0..4 {
        let angle = (from + sharp).rem_euclid(TAU);
        let lift = machine.cam().lift(if angle < TAU { angle } else { 0.0 });
        let state = machine.flight().fly(start, sharp / omega).1;
        let (velocity, acceleration) = (
            state.velocity - omega * lift.slope,
            machine.flight().acceleration(state) - omega * omega * lift.curvature,
        );
        sharp -= omega * velocity / acceleration;
    }
    // Not at a corner, where the gap has a kink.
    let at = if (sharp - at).abs() < tolerance::SHARPENED_GAP.value * stride { sharp } else { at };
    Some((gap(at), at))
}
