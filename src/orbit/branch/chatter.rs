//! Branches of orbits that stick to the cam: there is one for each value of the parameter, found by one simulated period.

use super::{BranchPoint, End, Following, Kind, Special};
use crate::orbit::{Family, OrbitError, PeriodicOrbit, curve, sticking};
use crate::tolerance;

/// The branch in one direction from `value`, of an orbit that sticks at an `anchor`, rad, and repeats after some
/// revolutions.
pub(super) fn half(
    family: &Family,
    value: f64,
    (mut anchor, revolutions): (f64, u64),
    following: &Following,
    direction: f64,
) -> Result<(Vec<BranchPoint>, End), OrbitError> {
    let span = following.range[1] - following.range[0];
    let (mut edge, mut end) = (following.range[usize::from(direction > 0.0)], End::Range);
    // Up to the last value that the model allows.
    if let Err(why) = family.machine(&[edge])
        && let Some(last) = curve::limit(value, edge, |value| family.machine(&[value]).is_err())
    {
        (edge, end) = (last, End::edge(direction > 0.0, &why));
    }
    let longest = following.longest_step * span;
    let closest = tolerance::SPECIAL_POINT.value * span;
    let orbit_at = |value: f64, anchor: f64| -> Result<(Option<PeriodicOrbit>, f64), OrbitError> {
        let (machine, rpm) = family.machine(&[value])?;
        Ok((sticking::through(&machine, anchor, revolutions)?, rpm))
    };
    let (mut points, mut at, mut step) = (Vec::<BranchPoint>::new(), value, longest);
    let mut leaves = orbit_at(value, anchor)?.0.is_some_and(|orbit| !orbit.events.is_empty());
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
        // The stretch on the cam moves with the parameter; its middle is the last to go.
        let goes_on = orbit.filter(|orbit| step <= closest || leaves != orbit.events.is_empty());
        match goes_on {
            Some(orbit) => {
                let detaches = leaves == orbit.events.is_empty();
                leaves = !orbit.events.is_empty();
                anchor = sticking::anchor(&orbit.events, revolutions).unwrap_or(anchor);
                let bracket = [at.min(next), at.max(next)];
                let special =
                    detaches.then_some(Special { kind: Kind::Detachment, bracket, residual: bracket[1] - bracket[0] });
                points.push(BranchPoint { held: None, rpm, value: next, orbit, special });
                (at, step) = (next, longest.min(2.0 * step.max(closest)));
            }
            None if step > closest => step *= 0.5,
            None => {
                if let Some(last) = points.last_mut() {
                    let residual = sticking::time_on_cam(&last.orbit);
                    let bracket = [at.min(next), at.max(next)];
                    last.special = Some(Special { kind: Kind::Chatter, bracket, residual });
                }
                return Ok((points, End::Chatter));
            }
        }
    }
    Ok((points, end))
}
