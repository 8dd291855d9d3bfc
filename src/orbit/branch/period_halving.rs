//! Locates the end of a branch of orbits of twice the period: the flip from which they come.
//!
//! There the two halves of a period become one, and the equations of the long orbit are singular. Those of the short orbit are not, so the
//! flip is located on the short orbit.

use crate::bracket::secants;
use crate::orbit::{Cycle, Impact};
use crate::simulate::Machine;
use crate::tolerance;

/// The flip of an orbit of half the period.
pub(super) struct Flipped {
    pub(super) value: f64,
    /// The short orbit, run twice.
    pub(super) cycle: Cycle,
    /// Bracket of the parameter.
    pub(super) bracket: [f64; 2],
    /// Residual of 1 + trace + determinant.
    pub(super) residual: f64,
}

/// Angle from the first half of a cycle to its second, rad, at the first impact; `None` if the halves do not correspond.
pub(super) fn apart(cycle: &Cycle) -> Option<f64> {
    let other = cycle.second_half(0)?;
    Some(cycle.impacts[other].cam_angle - cycle.impacts[0].cam_angle)
}

/// The mean of both halves.
fn mean(cycle: &Cycle) -> Cycle {
    let half = cycle.impacts.len() / 2;
    let mut impacts = cycle.impacts[..half].to_vec();
    for (impact, other) in impacts.iter_mut().zip(&cycle.impacts[half..]) {
        impact.cam_angle = 0.5 * (impact.cam_angle + other.cam_angle);
        impact.velocity_before = 0.5 * (impact.velocity_before + other.velocity_before);
    }
    Cycle { revolutions: cycle.revolutions / 2, impacts }
}

/// Locates the flip between two cycles, at two values of the parameter, whose halves have changed places. `None` if there is no flip
/// between them.
pub(super) fn flip(machine_at: impl Fn(f64) -> Option<Machine>, ends: [(f64, &Cycle); 2]) -> Option<Flipped> {
    /// Most steps. The guess is a step away, and secants need six or so.
    const STEPS: usize = 20;
    let [(first, one), (second, two)] = ends;
    let [before, after] = [apart(one)?, apart(two)?];
    if (before > 0.0) == (after > 0.0) {
        return None;
    }
    let at = |value: f64, guess: &Cycle| -> Option<(Cycle, f64)> {
        let machine = machine_at(value)?;
        let (cycle, _) = guess.closed(&machine).ok()?;
        let left = cycle.missing(&machine, -1.0);
        Some((cycle, left))
    };
    // The parameter turns round at the flip: its distance from there grows as the square of the halves' distance from each other.
    let span = (second - first).abs().max(tolerance::SPECIAL_POINT.value * first.abs());
    let mut cycle = mean(one);
    let mut value = |parameter: f64| {
        let (found, value) = at(parameter, &cycle).ok_or(())?;
        cycle = found;
        Ok::<_, ()>(value)
    };
    let guesses = [first, first + span].map(|guess| value(guess).map(|value| (guess, value)));
    let [Ok(low), Ok(high)] = guesses else { return None };
    let ([(low, _), (high, at_high)], _) = secants([low, high], STEPS, 0.0, value).ok()?;
    let halves = mean(one);
    let reach = before.abs() + after.abs();
    let near = |(found, halves): (&Impact, &Impact)| (found.cam_angle - halves.cam_angle).abs() <= reach;
    let is_flip = at_high.abs() <= tolerance::SAME_ORBIT.value && cycle.impacts.iter().zip(&halves.impacts).all(near);
    let mut doubled = one.clone();
    let half = cycle.impacts.len();
    for (index, impact) in doubled.impacts.iter_mut().enumerate() {
        let found = &cycle.impacts[index % half];
        (impact.cam_angle, impact.velocity_before) = (found.cam_angle, found.velocity_before);
    }
    let bracket = [low.min(high), low.max(high)];
    is_flip.then_some(Flipped { value: high, cycle: doubled, bracket, residual: at_high.abs() })
}
