//! Where one kind of motion gives way to another, and why.

use std::cell::RefCell;

use serde::Serialize;

use super::run::{LONGER, between, long_run};
use super::{Care, Regime, RegimeError, Settled};
use crate::bracket::{self, Width};
use crate::model::Model;
use crate::orbit::Parameter;
use crate::orbit::branch::{Branch, Following, Kind, Special};
use crate::simulate::{Machine, Motion};
use crate::study::machine;
use crate::tolerance;

/// A change of the motion between two speeds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change {
    /// Where, rpm.
    pub rpm: f64,
    /// Between which speeds, rpm, as far as runs tell.
    #[serde(rename = "bracket_rpm")]
    pub bracket: [f64; 2],
    /// Why.
    #[serde(flatten)]
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

// Located is a special point of a branch, and not a bracket of runs.
document!(Cause as cause { cause: cause.words(), located: matches!(cause, Cause::Special(..)) });

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
    let branches = Branches { model, range, known: RefCell::default() };
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
            let Some(change) = branches.explain([&before, &beyond], second.bracket)? else { break };
            later.push((change, std::mem::replace(&mut beyond, before)));
        }
    }
    let change = match branches.explain([last, &beyond], first.bracket)? {
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
        let whole = branches.explain([last, now], bracket)?;
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
    (here, mut motion): (f64, Motion),
    there: f64,
    (care, settles): (Care, bool),
    stays: &dyn Fn(&Settled) -> bool,
) -> Result<Halved, RegimeError> {
    let (mut before, mut beyond) = (None, None);
    // Nothing is told apart by waiting for what has not settled on either side.
    let longer = if settles { LONGER } else { 1 };
    let mut bracket = bracket::halve([here, there], Width::Absolute(tolerance::SPEED_BRACKETED.value), |rpm| {
        let (settled, end) = long_run(machine, rpm, &motion, care, longer)?;
        let changed = !stays(&settled);
        if changed {
            beyond = Some((settled, end));
        } else {
            (motion, before) = (end, Some(settled));
        }
        Ok::<_, RegimeError>(changed)
    })?;
    bracket.sort_by(f64::total_cmp);
    Ok(Halved { bracket, before, beyond })
}

/// A special point of a branch, where it is, rpm, and the angle of the corner that it is at, rad.
type Place = (f64, Special, Option<f64>);

/// The special points of the branches between two speeds, each branch followed once.
struct Branches<'a> {
    model: &'a Model,
    /// Rising, rpm.
    range: [f64; 2],
    /// By the orbit that each was followed from.
    known: RefCell<Vec<(Settled, Vec<Place>)>>,
}

impl Branches<'_> {
    /// The special point that explains a change, of the branch before it or else of the one beyond: the nearest to `bracket`,
    /// if it lies within what runs may be off by.
    fn explain(&self, sides: [&Settled; 2], bracket: [f64; 2]) -> Result<Option<Change>, RegimeError> {
        let [low, high] = self.range;
        let middle = 0.5 * (bracket[0] + bracket[1]);
        let off = |rpm: f64| (rpm - middle).abs();
        let allowed = tolerance::EXPLAINED.value * (high - low).max(middle * tolerance::EXPLAINED.value);
        for side in sides {
            let places = self.through(side)?;
            let nearest = places.into_iter().min_by(|one, two| off(one.0).total_cmp(&off(two.0)));
            if let Some((rpm, special, angle)) = nearest.filter(|(rpm, ..)| off(*rpm) <= allowed) {
                return Ok(Some(Change { rpm, bracket, cause: Cause::Special(special, angle) }));
            }
        }
        Ok(None)
    }

    /// The special points of the branch of `side`'s orbit; none where it is no orbit.
    fn through(&self, side: &Settled) -> Result<Vec<Place>, RegimeError> {
        let Some(orbit) = &side.orbit else { return Ok(Vec::new()) };
        if let Some((_, places)) = self.known.borrow().iter().find(|(known, _)| known == side) {
            return Ok(places.clone());
        }
        let [low, high] = self.range;
        let room = 0.5 * (high - low);
        let range = [(low - room).max(0.5 * low), high + room];
        let following = Following { parameter: Parameter::Speed, range, longest_step: 0.05, most_points: 400 };
        let branch = Branch::through(self.model, side.rpm, orbit, &following)?;
        let mut places = Vec::new();
        for (rpm, special) in branch.points.iter().filter_map(|point| point.special.map(|special| (point.rpm, special)))
        {
            let angle = match special.kind {
                Kind::Corner { segment, .. } => {
                    machine(self.model, self.range[0])?.cam().segments().get(segment).map(|segment| segment.start)
                }
                _ => None,
            };
            places.push((rpm, special, angle));
        }
        self.known.borrow_mut().push((side.clone(), places.clone()));
        Ok(places)
    }
}
