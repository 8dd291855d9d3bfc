//! The least gap of a flight between two impacts: positive where the flight clears the cam, 0 where it touches.

use std::f64::consts::TAU;

use crate::orbit::Cycle;
use crate::simulate::Machine;
use crate::tolerance;

/// Least gap, m, of the flight that starts at impact `index`, near an angle `turned`, rad, after its start; and where, rad
/// after its start.
///
/// `None` if the gap has no minimum there but falls to one of the flight's ends.
pub(super) fn least(cycle: &Cycle, machine: &Machine, index: usize, turned: f64) -> Option<(f64, f64)> {
    /// First stride of the walk to the minimum, relative to the way to the nearer end of the flight. It is short enough to see a short hop
    /// in front of a long flight.
    const PART: f64 = 0.05;
    /// Ratio of each stride to the one before.
    const LONGER: f64 = 1.25;
    let (start, _) = cycle.flight(machine, index);
    let from = cycle.impacts[index].cam_angle;
    let whole = cycle.turn(index);
    let omega = machine.angular_velocity();
    let gap = |turned: f64| {
        let angle = (from + turned).rem_euclid(TAU);
        let lift = machine.cam().lift(if angle < TAU { angle } else { 0.0 });
        machine.flight().fly(start, turned / omega).1.position - lift.value
    };
    let inside = |turned: f64| (0.0..whole).contains(&turned);
    if !inside(turned) {
        return None;
    }
    let stride = PART * turned.min(whole - turned);
    let onward = if gap(turned + stride) < gap(turned - stride) { 1.0 } else { -1.0 };
    let (mut behind, mut middle, mut length) = (turned - onward * stride, turned, stride);
    let mut ahead = turned + onward * stride;
    while gap(ahead) < gap(middle) {
        length *= LONGER;
        (behind, middle, ahead) = (middle, ahead, ahead + onward * length);
        if !inside(ahead) {
            return None;
        }
    }
    // Golden section: the gap is smooth but at corners, and one minimum is inside.
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = (behind.min(ahead), behind.max(ahead));
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
    // Golden sections give half of the digits of the place. The relative velocity, which is 0 there, gives all of them.
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
    let at = if (sharp - at).abs() < tolerance::SAME_MINIMUM.value * length { sharp } else { at };
    Some((gap(at), at))
}
