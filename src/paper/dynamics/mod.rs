//! Checks, by the simulator, of statements about the follower's motion at a speed.
//!
//! - `chattering`: slow cams, on which the follower comes to rest once a revolution.
//! - `transition`: fast cams, near the corner impact.
//! - `global`: motions that coexist there, and the change from one to the other.
//!
//! Evidence must not depend on the computer: for a chaotic run it contains only results that every run shows.

mod chattering;
mod global;
mod transition;

use std::ops::ControlFlow;

use super::context::Context;
use crate::orbit::PeriodicOrbit;
use crate::orbit::long_run::{Budget, LongRun};
use crate::simulate::{Event, EventKind, Machine, Motion, SimulateError, angular_velocity};
use crate::study::survey::long_run;
use crate::tolerance;
pub(super) use {chattering::*, global::*, transition::*};

fn listed(numbers: impl IntoIterator<Item = impl ToString>) -> String {
    numbers.into_iter().map(|number| number.to_string()).collect::<Vec<_>>().join(", ")
}

/// Returns the paper's machine at a speed, rpm.
fn machine(context: &Context<'_>, rpm: f64) -> Machine {
    Machine::new(context.cam.clone(), &context.model.follower, angular_velocity(rpm))
}

/// Returns the angles of the corners R, P, Q, Q', P', R', rad; NaN where the cam has fewer.
fn corners(context: &Context<'_>) -> [f64; 6] {
    let corners = context.cam.corners();
    std::array::from_fn(|index| corners.get(index).map_or(f64::NAN, |corner| corner.angle))
}

/// Returns the orbit of one impact a revolution to which `motion` converges within `transient` revolutions, or within as many after a rest.
fn one_impact(machine: &Machine, motion: Motion, transient: u64) -> Result<Option<PeriodicOrbit>, SimulateError> {
    let budget = Budget { transient, record: 1, longest: 1, patience: 0 };
    Ok(match long_run(machine, motion, budget)?.ending {
        LongRun::Orbit(orbit) if orbit.impacts().count() == 1 => Some(orbit),
        _ => None,
    })
}

/// Motion after the release at P of a follower that came up the flank on the cam. The speed alone decides it.
struct Round {
    /// The impacts up to the first stick: the angle turned since P, rad, and the relative velocity after it, m/s.
    impacts: Vec<[f64; 2]>,
    /// Where the impacts accumulate: the angle turned since P, rad; NaN where they never do.
    accumulation: f64,
    /// Releases on the way to the next at P.
    releases: usize,
    /// Revolutions from the release at P to the next one there: the period, if it is not 0.
    period: u64,
}

impl Round {
    /// Revolutions after which a release at P is no longer expected.
    const LONGEST: u64 = 50;

    /// Simulates from `corner`, P, on.
    fn new(machine: &Machine, corner: f64) -> Result<Self, SimulateError> {
        /// Start, rad before P: on the flank the cam presses against the follower at any speed.
        const BEFORE: f64 = 0.05;
        let mut motion = machine.start_on_cam(corner - BEFORE, 0.0)?;
        let goal = motion.after(Self::LONGEST);
        let mut round = Self { impacts: Vec::new(), accumulation: f64::NAN, releases: 0, period: 0 };
        let mut released = false;
        let _ = machine.advance(&mut motion, goal, &mut |event: &Event| {
            let turned = event.turned_since(corner);
            match event.kind {
                EventKind::Release if event.cam_angle == corner && !released => released = true,
                EventKind::Release if event.cam_angle == corner => {
                    round.period = event.revolution;
                    return ControlFlow::Break(());
                }
                EventKind::Release => round.releases += 1,
                EventKind::Impact if round.accumulation.is_nan() => {
                    round.impacts.push([turned, event.velocity_after - event.cam_velocity]);
                }
                EventKind::Stick if round.accumulation.is_nan() => round.accumulation = turned,
                EventKind::Impact | EventKind::Stick => {}
            }
            ControlFlow::Continue(())
        })?;
        Ok(round)
    }

    /// Number of impacts that can be felt.
    fn felt(&self) -> usize {
        self.impacts.iter().filter(|[_, velocity]| *velocity > tolerance::FELT_IMPACT.value).count()
    }
}
