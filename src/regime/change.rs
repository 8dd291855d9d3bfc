//! Where one kind of motion gives way to another, and why.

use super::walk::{between, long_run};
use super::{Care, Regime, Settled, SurveyError};
use crate::model::Model;
use crate::orbit::Parameter;
use crate::orbit::branch::{Branch, Following, Kind, Special};
use crate::simulate::{Machine, Motion};
use crate::tolerance;

/// A change of the motion between two speeds.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Where, rpm.
    pub rpm: f64,
    /// Between which speeds, rpm, as far as runs tell.
    pub bracket: [f64; 2],
    /// Why.
    pub cause: Cause,
}

/// Why a motion gives way.
#[derive(Clone, Debug, PartialEq)]
pub enum Cause {
    /// A special point of the branch of orbits that it is on, or that it comes to; and the angle of the impact that is at a
    /// corner, rad, if one is.
    Special(Special, Option<f64>),
    /// None that the branches on either side show: a motion that does not repeat begins or ends.
    Unexplained,
}

impl Cause {
    /// In words.
    pub fn words(&self) -> String {
        match self {
            Self::Special(special, angle) => match (special.kind, angle) {
                (Kind::Corner { jump_order, .. }, Some(angle)) => {
                    format!("corner impact at {:.4} deg, jump of order {jump_order}", angle.to_degrees())
                }
                (Kind::Graze { before, after }, _) => format!("graze: an impact more or less, {before} and {after}"),
                (kind, _) => kind.name().into(),
            },
            Self::Unexplained => "by runs alone".into(),
        }
    }
}

/// The change between `last`, with the motion that it ended in, and the next speed's long run `now`.
pub(super) fn narrowed(
    model: &Model,
    machine: &Machine,
    (last, motion): (&Settled, &Motion),
    now: &Settled,
    care: Care,
) -> Result<Change, SurveyError> {
    // What leaves the cam is told by the first event alone.
    if let ((Regime::OnCam, other), on, off) | ((other, Regime::OnCam), off, on) =
        ((&last.regime, &now.regime), last.rpm, now.rpm)
        && *other != Regime::OnCam
    {
        let [on, off] = between(machine, on, off)?;
        let bracket = [on.min(off), on.max(off)];
        let special = Special { kind: Kind::Detachment, bracket, residual: bracket[1] - bracket[0] };
        return Ok(Change { rpm: off, bracket, cause: Cause::Special(special, None) });
    }
    let (mut here, mut there, mut motion) = (last.rpm, now.rpm, *motion);
    while (there - here).abs() > tolerance::SPEED_BRACKETED.value {
        let middle = 0.5 * (here + there);
        let (settled, end) = long_run(machine, middle, &motion, care)?;
        if settled.is_like(last) {
            (here, motion) = (middle, end);
        } else {
            there = middle;
        }
    }
    let bracket = [here.min(there), here.max(there)];
    for side in [last, now] {
        if let Some(found) = explained(model, side, bracket, [last.rpm.min(now.rpm), last.rpm.max(now.rpm)])? {
            return Ok(found);
        }
    }
    Ok(Change { rpm: 0.5 * (here + there), bracket, cause: Cause::Unexplained })
}

/// The special point nearest to `bracket` on the branch of `side`'s orbit, if one lies within what runs may be off by.
fn explained(
    model: &Model,
    side: &Settled,
    bracket: [f64; 2],
    [low, high]: [f64; 2],
) -> Result<Option<Change>, SurveyError> {
    let Some(orbit) = &side.orbit else { return Ok(None) };
    let room = 0.5 * (high - low);
    let range = [(low - room).max(0.5 * low), high + room];
    let following = Following { parameter: Parameter::Speed, range, longest_step: 0.05, most_points: 400 };
    let branch = Branch::through(model, side.rpm, orbit, &following)?;
    let middle = 0.5 * (bracket[0] + bracket[1]);
    let off = |rpm: f64| (rpm - middle).abs();
    let specials = branch.points.iter().filter_map(|point| point.special.map(|special| (point, special)));
    let nearest = specials.min_by(|one, two| off(one.0.rpm).total_cmp(&off(two.0.rpm)));
    let Some((point, special)) = nearest.filter(|(point, _)| {
        off(point.rpm) <= tolerance::EXPLAINED.value * (high - low).max(middle * tolerance::EXPLAINED.value)
    }) else {
        return Ok(None);
    };
    let angle = match special.kind {
        Kind::Corner { contact, .. } => point.orbit.impacts().nth(contact).map(|impact| impact.cam_angle),
        _ => None,
    };
    Ok(Some(Change { rpm: point.rpm, bracket, cause: Cause::Special(special, angle) }))
}
