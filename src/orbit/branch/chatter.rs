//! Branches of orbits that stick to the cam. There is one orbit for each value of the parameter, found by one simulated period.

use std::f64::consts::TAU;

use super::{BranchPoint, End, Following, Special, SpecialKind};
use crate::orbit::{Family, OrbitError, PeriodicOrbit, sticking};
use crate::simulate::Machine;
use crate::tolerance;

/// Follows the branch in one direction from `value`, of an orbit that sticks at an `anchor`, rad, and repeats after some revolutions.
pub(super) fn half(
    family: &Family,
    value: f64,
    (anchor, revolutions): (f64, u64),
    following: &Following,
    direction: f64,
) -> Result<(Vec<BranchPoint>, End), OrbitError> {
    let span = following.range[1] - following.range[0];
    let (edge, end) = following.bound(family, value, direction);
    let longest = following.longest_step * span;
    let closest = tolerance::SPECIAL_POINT.value * span;
    // An orbit that never leaves the cam is anchored where the cam presses most, since the place that throws it off may be anywhere else.
    let orbit_at = |value: f64, anchor: Option<f64>| -> Result<(Option<PeriodicOrbit>, f64), OrbitError> {
        let (machine, rpm) = family.machine(&[value])?;
        let anchor = anchor.unwrap_or_else(|| pressed_most(&machine));
        Ok((sticking::through(&machine, anchor, revolutions)?, rpm))
    };
    let (mut points, mut at, mut step) = (Vec::<BranchPoint>::new(), value, longest);
    let mut leaves = orbit_at(value, Some(anchor))?.0.is_some_and(|orbit| !orbit.events.is_empty());
    let mut anchor = leaves.then_some(anchor);
    while at != edge {
        if points.len() >= following.most_points {
            return Ok((points, End::MostPoints));
        }
        let next = if (edge - at).abs() <= step { edge } else { at + direction * step };
        let (orbit, rpm) = match orbit_at(next, anchor) {
            Ok(found) => found,
            Err(OrbitError::Family(why)) => return Ok((points, End::edge(direction > 0.0, &why))),
            Err(error) => return Err(error),
        };
        // The stretch on the cam moves with the parameter; its middle vanishes last.
        let goes_on = orbit.filter(|orbit| step <= closest || leaves != orbit.events.is_empty());
        match goes_on {
            Some(orbit) => {
                let detaches = leaves == orbit.events.is_empty();
                leaves = !orbit.events.is_empty();
                anchor = sticking::anchor(&orbit.events, revolutions).or(anchor.filter(|_| leaves));
                let bracket = [at.min(next), at.max(next)];
                let special = detaches.then_some(Special {
                    kind: SpecialKind::Detachment,
                    bracket,
                    residual: bracket[1] - bracket[0],
                });
                points.push(BranchPoint { held: None, rpm, value: next, orbit, special });
                (at, step) = (next, longest.min(2.0 * step.max(closest)));
            }
            None if step > closest => step *= 0.5,
            None => {
                if let Some(last) = points.last_mut() {
                    let residual = sticking::time_on_cam(&last.orbit);
                    let bracket = [at.min(next), at.max(next)];
                    last.special = Some(Special { kind: SpecialKind::Chatter, bracket, residual });
                }
                return Ok((points, End::Chatter));
            }
        }
    }
    Ok((points, end))
}

/// Sampled cam angle, rad, at which the cam presses most against a follower that moves with it.
fn pressed_most(machine: &Machine) -> f64 {
    const PLACES: u32 = 256;
    let lifting = |angle: &f64| machine.lifting(&machine.cam().lift(*angle));
    let angles = (0..PLACES).map(|place| TAU * f64::from(place) / f64::from(PLACES));
    angles.min_by(|one, two| lifting(one).total_cmp(&lifting(two))).unwrap_or_default()
}
