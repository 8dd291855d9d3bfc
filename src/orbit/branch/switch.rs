//! Continuation of a branch beyond a corner or a graze: the cycle there, and the direction that leads away from it.

use std::cmp::Ordering;
use std::f64::consts::TAU;

use nalgebra::DVector;

use super::constraint::{Held, Pinned};
use super::problem::Problem;
use super::{least_gap, special::SpecialKind};
use crate::orbit::curve::{NoPoint, first_tangent};
use crate::orbit::{Cycle, FamilyError, Impact};
use crate::simulate::Machine;

/// Exit of an orbit from its cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Exit {
    /// An impact goes past the end of its segment, or the start.
    Corner { impact: usize, past_end: bool },
    /// An impact loses its relative velocity.
    Tangent { impact: usize },
    /// The flight from an impact touches the cam at an angle turned, rad.
    Touch { impact: usize, turned: f64 },
}

/// Kind of special point that the exit is, with the order of the corner there.
pub(super) fn kind(exit: Exit, cycle: &Cycle, machine: &Machine, order: usize) -> SpecialKind {
    let count = cycle.impacts.len();
    let turned_at = |impact: usize| cycle.impacts[impact].turned();
    match exit {
        Exit::Corner { impact, past_end } => {
            let segment = cycle.impacts[impact].segment;
            let next = (segment + 1) % machine.cam().segments().len();
            SpecialKind::Corner { impact, segment: if past_end { next } else { segment }, jump_order: order }
        }
        Exit::Tangent { impact } => {
            SpecialKind::Graze { before: count, after: count - 1, turned: turned_at(impact), first: None }
        }
        Exit::Touch { impact, turned } => {
            let turned = least_gap::least(cycle, machine, impact, turned).map_or(turned, |(_, least)| least);
            SpecialKind::Graze { before: count, after: count + 1, turned: turned_at(impact) + turned, first: None }
        }
    }
}

/// The touch of an orbit when the cam has turned by `turned`, rad, since angle 0 of revolution 0.
pub(super) fn touch(cycle: &Cycle, turned: f64) -> Option<Exit> {
    let since = |impact: &Impact| (turned - impact.turned()).rem_euclid(cycle.revolutions as f64 * TAU);
    let flights = cycle.impacts.iter().map(since).enumerate();
    let (impact, turned) = flights.min_by(|one, two| one.1.total_cmp(&two.1))?;
    Some(Exit::Touch { impact, turned })
}

/// Condition at a special point, and the cycle to which it applies.
pub(super) fn held(kind: SpecialKind, cycle: &Cycle, machine: &Machine) -> Option<(Cycle, Held)> {
    match kind {
        SpecialKind::Corner { impact, segment, .. } => {
            let at_end = cycle.impacts[impact].segment != segment;
            Some((cycle.clone(), Held::Corner(Pinned { impact, at_end })))
        }
        SpecialKind::Fold => Some((cycle.clone(), Held::Multiplier(1.0))),
        SpecialKind::Flip => Some((cycle.clone(), Held::Multiplier(-1.0))),
        SpecialKind::Graze { turned, .. } => {
            let touch = touch(cycle, turned)?;
            Some((beyond(touch, cycle, machine)?, Held::Touch(moved_impact(touch)?)))
        }
        _ => None,
    }
}

/// Condition in the cycle beyond `exit`; `None` if it applies to the impact that the exit removes.
pub(super) fn held_beyond(held: Held, exit: Exit) -> Option<Held> {
    let moved = |index: usize| match exit {
        Exit::Tangent { impact } => match index.cmp(&impact) {
            Ordering::Less => Some(index),
            Ordering::Equal => None,
            Ordering::Greater => Some(index - 1),
        },
        Exit::Touch { impact, .. } if impact < index => Some(index + 1),
        _ => Some(index),
    };
    Some(match held {
        Held::Corner(pinned) => Held::Corner(Pinned { impact: moved(pinned.impact)?, ..pinned }),
        Held::Touch(impact) => Held::Touch(moved(impact)?),
        Held::Multiplier(_) => held,
    })
}

/// The cycle on the other side of `exit`, at the same angles; `None` if no impact would be left.
pub(super) fn beyond(exit: Exit, cycle: &Cycle, machine: &Machine) -> Option<Cycle> {
    let segments = machine.cam().segments();
    let mut beyond = cycle.clone();
    match exit {
        Exit::Corner { impact, past_end } => {
            beyond = Pinned { impact, at_end: past_end }.other_side(cycle, machine);
        }
        Exit::Tangent { impact } => {
            beyond.impacts.remove(impact);
        }
        Exit::Touch { impact, turned } => {
            let from = &cycle.impacts[impact];
            let angle = from.cam_angle + turned;
            let turns = (angle / TAU).floor();
            let cam_angle = angle - turns * TAU;
            let segment = machine.cam().segment_at(cam_angle.clamp(0.0, TAU));
            let slope = segments[segment].law.lift(cam_angle).slope;
            let revolution = from.revolution + turns as i64;
            let velocity_before = machine.angular_velocity() * slope;
            beyond.impacts.insert(impact + 1, Impact { revolution, segment, cam_angle, velocity_before });
        }
    }
    (!beyond.impacts.is_empty()).then_some(beyond)
}

/// Index, in the cycle beyond, of the impact that `exit` concerns, if that cycle has it.
fn moved_impact(exit: Exit) -> Option<usize> {
    match exit {
        Exit::Corner { impact, .. } => Some(impact),
        Exit::Touch { impact, .. } => Some(impact + 1),
        Exit::Tangent { .. } => None,
    }
}

/// Unit direction in which the solutions of `problem`, the cycle beyond `exit`, lead away from it. `from` is the cycle before.
pub(super) fn direction(
    exit: Exit,
    from: &Cycle,
    problem: &Problem<'_>,
    unknowns: &DVector<f64>,
) -> Result<DVector<f64>, NoPoint<FamilyError>> {
    growing(problem, unknowns, |cycle, machine| match exit {
        Exit::Corner { impact, past_end } => {
            // The distance from the corner, which a number of the cam may move.
            let impact = &cycle.impacts[impact];
            let segment = &machine.cam().segments()[impact.segment];
            if past_end { impact.cam_angle - segment.start } else { segment.end - impact.cam_angle }
        }
        // A new impact needs an approach, and a flight in place of an impact needs a gap.
        Exit::Touch { .. } => moved_impact(exit).map_or(f64::NAN, |impact| cycle.approach(machine, impact)),
        Exit::Tangent { impact } => {
            let count = from.impacts.len();
            let before = (impact + count - 1) % count;
            // In the cycle without the impact, the one before it has this index.
            let index = if impact == 0 { count - 2 } else { before };
            least_gap::least(cycle, machine, index, from.turn(before)).map_or(f64::NAN, |(gap, _)| gap)
        }
    })
}

/// Unit direction in which the solutions lead away from a touch of an orbit without impacts, with an impact at each place.
pub(super) fn from_touch(problem: &Problem<'_>, unknowns: &DVector<f64>) -> Result<DVector<f64>, NoPoint<FamilyError>> {
    growing(problem, unknowns, |cycle, machine| {
        (0..cycle.impacts.len()).map(|impact| cycle.approach(machine, impact)).fold(f64::INFINITY, f64::min)
    })
}

/// Unit direction of the solutions in which a quantity grows.
fn growing(
    problem: &Problem<'_>,
    unknowns: &DVector<f64>,
    quantity: impl Fn(&Cycle, &Machine) -> f64,
) -> Result<DVector<f64>, NoPoint<FamilyError>> {
    /// Small step that shows in which direction the orbit leaves.
    const TRIAL: f64 = 1e-6;
    let tangent = first_tangent(problem, unknowns)?;
    let measure = |step: f64| -> Result<f64, NoPoint<FamilyError>> {
        let (cycle, machine, _) = problem.unpack(&(unknowns + &tangent * step))?;
        Ok(quantity(&cycle, &machine))
    };
    // A quantity that cannot be measured gives no direction.
    match measure(TRIAL)?.partial_cmp(&measure(-TRIAL)?) {
        Some(Ordering::Greater) => Ok(tangent),
        Some(Ordering::Less) => Ok(-tangent),
        _ => Err(NoPoint::NotClosed),
    }
}
