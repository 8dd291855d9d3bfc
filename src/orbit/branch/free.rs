//! Branches of orbits without impacts, and the graze where the cam reaches the follower.
//!
//! Away from the cam no force on the follower depends on time, since only the cam moves and positions are in fixed coordinates. So the
//! follower rests at its equilibrium at any speed, and the cam touches it where the cam's top is as high:
//!
//! ```text
//! gap = q_e - max c = 0        q_e = rest - g/omega0^2
//! ```

use std::convert::Infallible;

use super::first_touch::{Doubt, FirstTouch, UndecidedGraze, borders};
use super::{Branch, BranchPoint, End, Following, HalfBranch, OnCurve, Special, SpecialKind, follow};
use crate::bracket::{Width, halve};
use crate::cam::{Least, within_a_turn};
use crate::flight::State;
use crate::model::Model;
use crate::orbit::cycle::lift_size;
use crate::orbit::near::at_rest;
use crate::orbit::{Cycle, Family, FamilyError, Impact, OrbitError, Parameter, PeriodicOrbit};
use crate::simulate::{Machine, angular_velocity};
use crate::tolerance;

/// Halvings that narrow an interval of doubles down to neighbours.
const BINARY_DIGITS: u32 = 60;

/// The follower at rest above the cam, at one value of the followed parameter.
struct Rest {
    machine: Machine,
    rpm: f64,
    orbit: PeriodicOrbit,
    /// Height above the cam's top, m.
    gap: f64,
}

impl Rest {
    /// The follower at rest near `state`; `None` if it falls.
    fn at(family: &Family, value: f64, state: State) -> Result<Option<Self>, FamilyError> {
        let (machine, rpm) = family.machine(&[value])?;
        let orbit = at_rest(&machine, state);
        let highest = machine.cam().highest().value;
        Ok(orbit.map(|orbit| Self { gap: orbit.state.position - highest, machine, rpm, orbit }))
    }

    fn is_clear(rest: &Option<Self>) -> bool {
        rest.as_ref().is_some_and(|rest| rest.gap > 0.0)
    }

    /// The graze where the gap is 0 between two values, and the tops of the cam that touch.
    fn graze(&self, bracket: [f64; 2], larger: bool) -> (Special, Vec<Least>) {
        let tops = self.machine.cam().tops();
        let touch = FirstTouch::of(&self.machine, &tops, larger);
        let turned = tops.first().map_or(f64::NAN, |top| within_a_turn(top.angle));
        let kind = SpecialKind::Graze { before: 0, after: tops.len(), turned, first: Some(touch) };
        (Special { kind, bracket, residual: self.gap.abs() }, tops)
    }

    fn point(&self, value: f64, special: Option<Special>) -> BranchPoint {
        BranchPoint { held: None, rpm: self.rpm, value, orbit: self.orbit.clone(), special }
    }
}

/// Follows the branch in one direction from `value`, where the follower rests in `state`, and on with impacts behind a graze.
pub(super) fn half(
    family: &Family,
    value: f64,
    state: State,
    following: &Following,
    direction: f64,
) -> Result<HalfBranch, OrbitError> {
    let (edge, end) = following.bound(family, value, direction);
    let longest = following.longest_step * (following.range[1] - following.range[0]);
    let (mut points, mut here) = (Vec::new(), value);
    while here != edge {
        if points.len() >= following.most_points {
            return Ok((points, End::MostPoints));
        }
        let next = if (edge - here).abs() <= longest { edge } else { here + direction * longest };
        let rest = match Rest::at(family, next, state) {
            Ok(rest) => rest,
            Err(why) => return Ok((points, End::edge(direction > 0.0, &why))),
        };
        if !Rest::is_clear(&rest) {
            let clear = |value: f64| Ok::<_, FamilyError>(Rest::is_clear(&Rest::at(family, value, state)?));
            let [last, beyond] =
                halve([here, next], Width::Halvings(BINARY_DIGITS), |value| clear(value).map(|is| !is))?;
            let (Some(touch), Some(_)) = (Rest::at(family, last, state)?, Rest::at(family, beyond, state)?) else {
                return Ok((points, End::Falls));
            };
            let (special, tops) = touch.graze([last.min(beyond), last.max(beyond)], direction > 0.0);
            points.push(touch.point(last, Some(special)));
            let (onward, end) = with_impacts(family, &touch, last, &tops, special, following)?;
            points.extend(onward);
            return Ok((points, end));
        }
        points.extend(rest.map(|rest| rest.point(next, None)));
        here = next;
    }
    let is_nothing = end == End::Range && following.parameter == Parameter::Speed;
    Ok((points, if is_nothing { End::Clear } else { end }))
}

/// Follows the branch from the graze on, with an impact at each top of the cam.
fn with_impacts(
    family: &Family,
    touch: &Rest,
    value: f64,
    tops: &[Least],
    special: Special,
    following: &Following,
) -> Result<HalfBranch, OrbitError> {
    let doubt = if let SpecialKind::Graze { first: Some(first), .. } = special.kind { first.doubt } else { None };
    if matches!(doubt, Some(Doubt::Sharp | Doubt::Flat | Doubt::Unheld)) {
        return Ok((Vec::new(), End::Graze));
    }
    let omega = touch.machine.angular_velocity();
    let impact = |top: &Least| Impact {
        revolution: 0,
        segment: top.segment,
        cam_angle: top.angle,
        velocity_before: omega * top.lift.slope,
    };
    let cycle = Cycle { revolutions: 1, impacts: tops.iter().map(impact).collect() };
    let spans = [following.range[1] - following.range[0]];
    follow::from_touch(family, &follow::Start { cycle: &cycle, values: &[value], spans: &spans, held: None }, following)
}

/// Continues a half of a branch whose orbit has lost its only impact in a graze: the follower then rests.
pub(super) fn onward(
    family: &Family,
    (mut points, end): HalfBranch,
    following: &Following,
) -> Result<HalfBranch, OrbitError> {
    /// Small step, relative to the range, that shows on which side the follower is clear of the cam.
    const TRIAL: f64 = 1e-6;
    let Some(last) = points.last_mut() else { return Ok((points, end)) };
    let Some(special @ Special { kind: SpecialKind::Graze { before, after: 0, .. }, .. }) = last.special else {
        return Ok((points, end));
    };
    let (value, state) = (last.value, last.orbit.state);
    let Some(rest) = Rest::at(family, value, state)? else { return Ok((points, end)) };
    let trial = TRIAL * (following.range[1] - following.range[0]);
    let is_clear =
        |direction: &f64| Rest::at(family, value + direction * trial, state).is_ok_and(|rest| Rest::is_clear(&rest));
    // A follower without damping may also swing from touch to touch.
    let is_at_rest = rest.gap.abs() <= tolerance::CYCLE_CLOSED.value * lift_size(&rest.machine);
    let Some(direction) = [-1.0, 1.0].into_iter().find(is_clear).filter(|_| is_at_rest) else {
        return Ok((points, end));
    };
    let (Special { kind, .. }, _) = rest.graze(special.bracket, direction < 0.0);
    if let SpecialKind::Graze { turned, first, .. } = kind {
        last.special = Some(Special { kind: SpecialKind::Graze { before, after: 0, turned, first }, ..special });
    }
    last.orbit = rest.orbit;
    let (more, end) = half(family, value, state, following, direction)?;
    points.extend(more);
    Ok((points, end))
}

/// Returns the curves, in the plane of the speed and the followed parameter, of the grazes of orbits without impacts between two speeds,
/// rpm. The follower's equilibrium and the cam's top are the same at each speed; the class is not.
pub(crate) fn touches(
    model: &Model,
    speeds: [f64; 2],
    following: &Following,
) -> Result<Vec<(Branch, SpecialKind)>, OrbitError> {
    let family = Family::new(model, speeds[0], vec![following.parameter.clone()])?;
    let state = State { position: 0.0, velocity: 0.0 };
    let clear = |value: f64| {
        let rest = Rest::at(&family, value, state).ok()??;
        // Without a spring the follower rests anywhere.
        (rest.machine.flight().omega0_squared() > 0.0).then_some(rest.gap > 0.0)
    };
    let [low, high] = following.range;
    let count = following.longest_step.recip().ceil() as u64;
    let values: Vec<f64> = (0..=count).map(|index| low + (high - low) * index as f64 / count as f64).collect();
    let mut curves = Vec::new();
    for pair in values.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let (Some(one), Some(other)) = (clear(from), clear(to)) else { continue };
        if one == other {
            continue;
        }
        let is_beyond = |value: f64| Ok::<_, Infallible>(clear(value) == Some(other));
        let Ok(ends) = halve([from, to], Width::Halvings(BINARY_DIGITS), is_beyond);
        let value = if one { ends[0] } else { ends[1] };
        curves.push(touching(&family, value, ends, speeds, (state, one), following)?);
    }
    Ok(curves)
}

/// Returns the curve of a graze of an orbit without impacts.
fn touching(
    family: &Family,
    value: f64,
    bracket: [f64; 2],
    speeds: [f64; 2],
    (state, larger): (State, bool),
    following: &Following,
) -> Result<(Branch, SpecialKind), OrbitError> {
    let (machine, _) = family.machine(&[value])?;
    let tops = machine.cam().tops();
    let cam_angle = tops.first().map_or(f64::NAN, |top| within_a_turn(top.angle));
    let first = Some(FirstTouch::of(&machine, &tops, larger));
    let kind = SpecialKind::Graze { before: 0, after: tops.len(), turned: cam_angle, first };
    let count = following.longest_step.recip().ceil() as u64;
    let regular = (0..=count).map(|index| (speeds[0] + (speeds[1] - speeds[0]) * index as f64 / count as f64, None));
    let borders = borders(&machine, tops.len(), speeds, following.most_points);
    let mut places: Vec<(f64, Option<UndecidedGraze>)> =
        regular.chain(borders.into_iter().map(|(rpm, border)| (rpm, Some(border)))).collect();
    places.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut points = Vec::new();
    for (rpm, border) in places {
        let machine = machine.at_speed(angular_velocity(rpm));
        let Some(orbit) = at_rest(&machine, state) else { continue };
        let touch = FirstTouch::of(&machine, &tops, larger);
        let special = border.map(|border| Special { kind: SpecialKind::Class(border), bracket, residual: 0.0 });
        let held = Some(OnCurve { cam_angle, sides: vec![orbit.matrix], class: Some(touch.class) });
        points.push(BranchPoint { rpm, value, orbit, held, special });
    }
    Ok((Branch { points, ends: [End::Range, End::Range] }, kind))
}
