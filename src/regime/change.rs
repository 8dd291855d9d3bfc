//! Where one kind of motion gives way to another, and why.

use super::walk::{LONGER, between, long_run, machine};
use super::{Care, Regime, RegimeError, Settled};
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

/// Motions that are told apart between two speeds that are run.
const MOST: usize = 6;
/// The narrowest range between two changes, rpm: ten times what runs bracket a change to.
const NARROWEST: f64 = 10.0 * tolerance::SPEED_BRACKETED.value;

/// The changes between `last`, with the motion that it ended in, and the next speed's long run `now`: each with what is there
/// beyond it, the last with `now`.
///
/// Motions between the two count where they repeat and a special point tells where they end.
pub(super) fn narrowed(
    model: &Model,
    machine: &Machine,
    (last, motion): (&Settled, &Motion),
    now: &Settled,
    care: Care,
) -> Result<Vec<(Change, Settled)>, RegimeError> {
    // What leaves the cam is told by the first event alone.
    if let ((Regime::OnCam, other), on, off) | ((other, Regime::OnCam), off, on) =
        ((&last.regime, &now.regime), last.rpm, now.rpm)
        && *other != Regime::OnCam
    {
        let [on, off] = between(machine, on, off)?;
        let bracket = [on.min(off), on.max(off)];
        let special = Special { kind: Kind::Detachment, bracket, residual: bracket[1] - bracket[0] };
        return Ok(vec![(Change { rpm: off, bracket, cause: Cause::Special(special, None) }, now.clone())]);
    }
    let range = [last.rpm.min(now.rpm), last.rpm.max(now.rpm)];
    let care = (care, last.orbit.is_some() || now.orbit.is_some());
    let halved = |from: (f64, Motion), to: f64, stays: &dyn Fn(&Settled) -> bool| halve(machine, from, to, care, stays);
    let first = halved((last.rpm, *motion), now.rpm, &|settled| settled.is_like(last))?;
    let (mut beyond, mut later) = (now.clone(), Vec::new());
    if let Some((found, end)) = &first.beyond {
        // From what is beyond the first change on: where what is there at the next speed begins.
        while !found.is_like(&beyond) && later.len() < MOST {
            let second = halved((found.rpm, *end), beyond.rpm, &|settled| !settled.is_like(&beyond))?;
            let before = second.before.unwrap_or_else(|| found.clone());
            if before.orbit.is_none() || before.is_like(last) {
                break;
            }
            let Some(change) = explained_by_either(model, [&before, &beyond], second.bracket, range)? else { break };
            later.push((change, std::mem::replace(&mut beyond, before)));
        }
    }
    let change = match explained_by_either(model, [last, &beyond], first.bracket, range)? {
        Some(change) => change,
        None => {
            let rpm = 0.5 * (first.bracket[0] + first.bracket[1]);
            Change { rpm, bracket: first.bracket, cause: Cause::Unexplained }
        }
    };
    let mut chain = vec![(change, beyond)];
    for (change, settled) in later.into_iter().rev() {
        match chain.last_mut() {
            // Too narrow to be told apart.
            Some(last) if (change.rpm - last.0.rpm).abs() < NARROWEST => last.1 = settled,
            _ => chain.push((change, settled)),
        }
    }
    chain.dedup_by(|later, before| later.1.is_like(&before.1));
    // Special points are taken for changes that runs see a little later: they must still follow one another.
    let onward = (now.rpm - last.rpm).signum();
    if chain.windows(2).any(|two| (two[1].0.rpm - two[0].0.rpm) * onward <= 0.0) {
        let bracket = first.bracket;
        let whole = explained_by_either(model, [last, now], bracket, range)?;
        let runs = || Change { rpm: 0.5 * (bracket[0] + bracket[1]), bracket, cause: Cause::Unexplained };
        chain = vec![(whole.unwrap_or_else(runs), now.clone())];
    }
    Ok(chain)
}

/// Two speeds between which long runs cease to be of a kind.
struct Halved {
    /// Rising, rpm.
    bracket: [f64; 2],
    /// The last long run on this side; `None` where no speed between was like that.
    before: Option<Settled>,
    /// The first beyond, with where it ended; `None` where no speed between was.
    beyond: Option<(Settled, Motion)>,
}

/// Halves the way from a motion at one speed, rpm, to another speed, each long run going on from the last that `stays`.
fn halve(
    machine: &Machine,
    (mut here, mut motion): (f64, Motion),
    mut there: f64,
    (care, settles): (Care, bool),
    stays: &dyn Fn(&Settled) -> bool,
) -> Result<Halved, RegimeError> {
    let (mut before, mut beyond) = (None, None);
    // Nothing is told apart by waiting for what has not settled on either side.
    let longer = if settles { LONGER } else { 1 };
    while (there - here).abs() > tolerance::SPEED_BRACKETED.value {
        let middle = 0.5 * (here + there);
        let (settled, end) = long_run(machine, middle, &motion, care, longer)?;
        if stays(&settled) {
            (here, motion, before) = (middle, end, Some(settled));
        } else {
            (there, beyond) = (middle, Some((settled, end)));
        }
    }
    Ok(Halved { bracket: [here.min(there), here.max(there)], before, beyond })
}

/// The special point that explains a change, of the branch before it or else of the one beyond.
fn explained_by_either(
    model: &Model,
    sides: [&Settled; 2],
    bracket: [f64; 2],
    range: [f64; 2],
) -> Result<Option<Change>, RegimeError> {
    for side in sides {
        if let Some(found) = explained(model, side, bracket, range)? {
            return Ok(Some(found));
        }
    }
    Ok(None)
}

/// The special point nearest to `bracket` on the branch of `side`'s orbit, if one lies within what runs may be off by.
fn explained(
    model: &Model,
    side: &Settled,
    bracket: [f64; 2],
    [low, high]: [f64; 2],
) -> Result<Option<Change>, RegimeError> {
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
        Kind::Corner { segment, .. } => machine(model)?.cam().segments().get(segment).map(|segment| segment.start),
        _ => None,
    };
    Ok(Some(Change { rpm: point.rpm, bracket, cause: Cause::Special(special, angle) }))
}
