//! What the long run at one speed is, and where the follower first leaves the cam.

use std::ops::ControlFlow;

use super::{Care, Regime, RegimeError, Settled};
use crate::bracket::{Width, halve};
use crate::diagram::growth;
use crate::model::Model;
use crate::orbit::settle::settled;
use crate::simulate::{Event, Machine, Motion, SimulateError, angular_velocity};
use crate::study::machine;
use crate::tolerance;

/// Revolutions over which the growth of a deviation is averaged.
const AVERAGED: u64 = 400;
/// How much longer a run is at most next to a change, if it neither repeats nor is chaotic.
pub(super) const LONGER: u64 = 4;

/// Where the follower first leaves the cam between two speeds, rpm; `None` where it leaves at the lower already, or at
/// neither.
pub fn detachment(model: &Model, [low, high]: [f64; 2]) -> Result<Option<f64>, RegimeError> {
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

/// Whether a follower that is put on the cam stays there for a revolution.
fn stays(machine: &Machine, rpm: f64) -> Result<bool, RegimeError> {
    let of_speed = |error| RegimeError::Simulate { rpm, error };
    let machine = machine.at_speed(angular_velocity(rpm));
    let mut motion = machine.start_on_cam(0.0, 0.0).map_err(of_speed)?;
    if !motion.contact {
        return Ok(false);
    }
    let goal = motion.after(1);
    let flow = machine.advance(&mut motion, goal, &mut |_: &Event| ControlFlow::Break(())).map_err(of_speed)?;
    Ok(flow.is_continue())
}

/// The neighbouring speeds, rpm, of which the follower stays on the cam at the first only; between one where it does and
/// one where it does not.
pub(super) fn between(machine: &Machine, on: f64, off: f64) -> Result<[f64; 2], RegimeError> {
    halve([on, off], Width::Relative(tolerance::ROOT_WIDTH.value), |rpm| Ok(!stays(machine, rpm)?))
}

/// The long run from `motion`, with where it ended; up to `longer` times as long where it settles slowly.
pub(super) fn long_run(
    machine: &Machine,
    rpm: f64,
    motion: &Motion,
    care: Care,
    longer: u64,
) -> Result<(Settled, Motion), RegimeError> {
    let run = || -> Result<(Settled, Motion), SimulateError> {
        let machine = machine.at_speed(angular_velocity(rpm));
        let (mut motion, mut stretch) = (machine.resume(motion)?, care.settling);
        loop {
            machine.revolve(&mut motion, stretch)?;
            if let Some(orbit) = settled(&machine, motion, 0, care.longest_period)? {
                return Ok((Settled::of_orbit(rpm, orbit), motion));
            }
            let rate = growth(&machine, motion, AVERAGED)?;
            let is_chaotic = rate > tolerance::CHAOTIC_GROWTH.value;
            // Next to where it begins a motion settles slowly; one that comes to rest on the cam only repeats.
            if is_chaotic || rate == f64::NEG_INFINITY || stretch >= care.settling * longer {
                let regime = if is_chaotic { Regime::Chaotic } else { Regime::Unsettled };
                return Ok((Settled { rpm, regime, orbit: None, growth: Some(rate) }, motion));
            }
            stretch *= 2;
        }
    };
    run().map_err(|error| RegimeError::Simulate { rpm, error })
}
