//! The orbit near a guess, or near a run.
//!
//! `near_run` looks for an orbit that a run is on already, or nearly; [`super::runs`] decides whether the run stays there. Every guess of a
//! cycle goes through [`close`]: Newton's method, and a simulated period that confirms the result.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use super::cycle::lift_size;
use super::multipliers::{Eigenvalue, eigenvalues};
use super::{Course, Cycle, Judgement, PeriodicOrbit, Stability, sticking};
use crate::flight::State;
use crate::known::Evidence;
use crate::simulate::{Event, EventKind, Machine, Motion, SimulateError};
use crate::tolerance;

/// Most impacts of an orbit whose equations are solved together. With more, a follower chatters.
pub(super) const MOST_IMPACTS: usize = 64;
/// Most events kept. A follower that chatters with restitution 0.99 makes thousands in a revolution before it rests.
const MOST_EVENTS: usize = 100_000;

/// Returns the orbit near the motion of `revolutions` that starts at `cam_angle`, rad, with `state`. Its impacts are the guess.
pub fn near(
    machine: &Machine,
    cam_angle: f64,
    state: State,
    revolutions: u64,
) -> Result<Option<PeriodicOrbit>, SimulateError> {
    let mut motion = machine.start(cam_angle, state)?;
    let events = period(machine, &mut motion, revolutions, MOST_EVENTS)?;
    if events.iter().any(|event| event.kind != EventKind::Impact) {
        return near_run(machine, motion, 0, revolutions);
    }
    if events.is_empty() {
        return Ok(None);
    }
    Ok(close(machine, &Cycle::of_events(revolutions, &events).in_order()))
}

/// Finds the orbit near a guess by Newton's method. `None` if the method does not converge, if the result is no motion of the actual cam,
/// or if it repeats sooner.
pub fn close(machine: &Machine, guess: &Cycle) -> Option<PeriodicOrbit> {
    // Up to four impacts per revolution are no chatter, however many revolutions there are.
    if guess.impacts.len() > MOST_IMPACTS.max(4 * guess.revolutions as usize) {
        return None;
    }
    let (cycle, residual) = guess.closed(machine).ok()?;
    let mut corners = machine.cam().corners().iter().copied().map(|corner| corner.segment).collect::<Vec<_>>();
    corners.sort_unstable();
    let cycle = cycle.renamed(machine, |segment| corners.binary_search(&segment).is_ok()).in_order();
    let is_orbit = cycle.departure(machine).is_ok_and(|departure| departure.is_none()) && !cycle.repeats_sooner();
    is_orbit.then(|| PeriodicOrbit::of_cycle(machine, cycle, residual))
}

/// Returns the orbit of at most `longest` revolutions that a run from `motion` is near after `revolutions`, unless it is unstable.
pub(super) fn near_run(
    machine: &Machine,
    mut motion: Motion,
    revolutions: u64,
    longest: u64,
) -> Result<Option<PeriodicOrbit>, SimulateError> {
    /// Growth of a deviation over a period beyond which a run is not near an attracting orbit.
    const NEARLY_DRAWS: f64 = 3.0;
    machine.revolve(&mut motion, revolutions)?;
    machine.turn_to(&mut motion, 0.0)?;
    let first = motion;
    let size = lift_size(machine);
    let mut events = Vec::new();
    for turns in 1..=longest {
        let more = period(machine, &mut motion, 1, MOST_EVENTS)?;
        events.extend(more.into_iter().map(|event| Event { revolution: turns - 1, ..event }));
        let apart = motion.state.apart(first.state, machine.angular_velocity());
        if apart > tolerance::NEARLY_REPEATS.value * size {
            continue;
        }
        let sticks = events.iter().any(|event| event.kind != EventKind::Impact);
        let impacts = events.iter().any(|event| event.kind == EventKind::Impact);
        if !sticks && events.len() > MOST_IMPACTS {
            continue;
        }
        let orbit = if sticks {
            match sticking::anchor(&events, turns) {
                Some(anchor) => sticking::through(machine, anchor, turns)?,
                None => None,
            }
        } else if motion.contact {
            sticking::through(machine, 0.0, turns)?
        } else if impacts {
            let guess = Cycle::of_events(turns, &events);
            // A run near an attracting orbit attracts its neighbours, or nearly so. Most runs that only pass near an earlier state do not.
            let modulus = eigenvalues(&guess.at_section(machine, 0.0).1).into_iter().map(Eigenvalue::modulus);
            if modulus.fold(0.0, f64::max) <= NEARLY_DRAWS { close(machine, &guess) } else { None }
        } else {
            free(machine, motion.state)
        };
        // A run settles only on orbits that are stable or neutral; Newton's method also finds orbits that a run only passes.
        let holds = |orbit: &PeriodicOrbit| orbit.judgement.stability != Stability::Unstable;
        if let Some(orbit) = orbit.filter(holds) {
            return Ok(Some(orbit));
        }
    }
    Ok(None)
}

/// Returns the follower at rest above the cam, near `state`. `None` if it falls or meets the cam.
pub(super) fn free(machine: &Machine, state: State) -> Option<PeriodicOrbit> {
    at_rest(machine, state).filter(|orbit| orbit.state.position > machine.cam().highest().value)
}

/// Returns the follower at rest near `state`, where no force acts on it, wherever the cam is. Without a spring or gravity it may rest
/// anywhere. `None` if it falls.
pub(super) fn at_rest(machine: &Machine, state: State) -> Option<PeriodicOrbit> {
    let (flight, force) = (machine.flight(), machine.flight().force(state.position));
    let above = if force == 0.0 { 0.0 } else { force / flight.omega0_squared() };
    let state = State { position: state.position + above, velocity: 0.0 };
    let matrix = flight.propagator(TAU / machine.angular_velocity());
    let residual = flight.acceleration(state).abs() / machine.angular_velocity().powi(2) / lift_size(machine);
    let (events, course, known) = (Vec::new(), Course::Free, Evidence::Computed);
    let judgement = Judgement::of_flight(machine, &matrix);
    let orbit = PeriodicOrbit { revolutions: 1, events, state, matrix, judgement, residual, course, known };
    state.position.is_finite().then_some(orbit)
}

/// Runs `revolutions` and returns the events on the way.
///
/// Stops right after more than `most` events.
pub(super) fn period(
    machine: &Machine,
    motion: &mut Motion,
    revolutions: u64,
    most: usize,
) -> Result<Vec<Event>, SimulateError> {
    let mut events = Vec::new();
    let goal = motion.after(revolutions);
    let _ = machine.advance(motion, goal, &mut |event: &Event| {
        events.push(*event);
        if events.len() > most { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    Ok(events)
}
