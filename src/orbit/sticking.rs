//! Orbits on which the follower sticks to the cam for a while. The cam alone determines the motion after that.

use std::f64::consts::TAU;

use nalgebra::Matrix2;

use super::{Course, Judgement, PeriodicOrbit};
use crate::flight::State;
use crate::known::Evidence;
use crate::simulate::{Event, EventKind, Machine, SimulateError};

/// Returns the orbit of `revolutions` that sticks to the cam at `anchor`, rad, in `[0, 2 pi)`. `None` if a follower put on the cam there
/// does not stick, or is not on the cam one period later.
pub fn through(machine: &Machine, anchor: f64, revolutions: u64) -> Result<Option<PeriodicOrbit>, SimulateError> {
    let mut motion = machine.start_on_cam(anchor, 0.0)?.with_each_impact();
    if !motion.contact {
        return Ok(None);
    }
    let state = motion.state;
    let mut events = Vec::new();
    machine.watch(&mut motion, revolutions, |event| events.push(*event))?;
    if !motion.contact {
        return Ok(None);
    }
    let closing = (motion.state.position - state.position).abs();
    // Revolutions count from angle 0, as in every orbit.
    for event in &mut events {
        event.revolution %= revolutions;
    }
    events.sort_by(|one, two| one.revolution.cmp(&two.revolution).then(one.cam_angle.total_cmp(&two.cam_angle)));
    let at_zero = at_zero(machine, anchor)?;
    Ok(Some(PeriodicOrbit {
        revolutions,
        events,
        state: at_zero,
        matrix: matrix(machine),
        judgement: Judgement::of_rest(machine),
        residual: closing / super::cycle::lift_size(machine),
        course: Course::Sticking(anchor),
        known: Evidence::Computed,
    }))
}

/// Matrix that carries a small deviation once around an orbit that sticks, 2x2. It is 0, since infinitely many impacts before a rest erase
/// the deviation. With restitution 1 no bounce ends in a rest, and the matrix is NaN.
pub fn matrix(machine: &Machine) -> Matrix2<f64> {
    Matrix2::from_element(if machine.restitution() < 1.0 { 0.0 } else { f64::NAN })
}

/// State of the follower at the next passage of angle 0.
pub fn at_zero(machine: &Machine, anchor: f64) -> Result<State, SimulateError> {
    let mut motion = machine.start_on_cam(anchor, 0.0)?;
    if anchor == 0.0 {
        return Ok(motion.state);
    }
    machine.turn_to(&mut motion, 0.0)?;
    Ok(motion.state)
}

/// Middle of the longest stretch on the cam among the events of one period, rad, in `[0, 2 pi)`. `None` if the follower never comes to rest
/// or never leaves the cam.
pub fn anchor(events: &[Event], revolutions: u64) -> Option<f64> {
    let longest = stretches(events, revolutions).max_by(|one, two| (one.1 - one.0).total_cmp(&(two.1 - two.0)))?;
    Some(longest.0.midpoint(longest.1).rem_euclid(TAU)).filter(|angle| *angle < TAU)
}

/// Stretches on the cam among the events of one period, in their order: start and end, rad. The next event ends a stretch: a release, or an
/// impact, where a corner that turns up throws the follower off the cam.
fn stretches(events: &[Event], revolutions: u64) -> impl Iterator<Item = (f64, f64)> {
    let period = revolutions as f64 * TAU;
    let again = events.iter().map(move |first| (first.kind, first.turned_since(0.0) + period));
    let next = events.iter().skip(1).map(|event| (event.kind, event.turned_since(0.0))).chain(again);
    events.iter().zip(next).filter_map(|(event, (next, end))| match (event.kind, next) {
        (EventKind::Stick, EventKind::Release | EventKind::Impact) => Some((event.turned_since(0.0), end)),
        _ => None,
    })
}

/// Angle over which the follower sticks in one period, rad.
pub fn time_on_cam(orbit: &PeriodicOrbit) -> f64 {
    if matches!(orbit.course, Course::Sticking(_)) && orbit.events.is_empty() {
        return orbit.revolutions as f64 * TAU;
    }
    stretches(&orbit.events, orbit.revolutions).map(|(stick, end)| end - stick).sum()
}
