//! What must be changed so that a machine does as it is needed to: one number at a time, the others kept.

use std::cell::Cell;
use std::str::FromStr;

use rayon::prelude::*;
use serde::Serialize;

use super::contact::Contact;
use super::loads::{Load, Loads};
use crate::bracket::{Width, halve};
use crate::foreign;
use crate::known::Known;
use crate::model::{Follower, Model};
use crate::simulate::{Machine, SimulateError, angular_velocity};
use crate::tolerance;

/// What is needed up to a speed, rpm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Need {
    /// What.
    pub what: What,
    /// Up to which speed, rpm.
    pub rpm: f64,
}

/// What is needed of a machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum What {
    /// The follower stays on the cam.
    NoSeparation,
    /// A load stays below a value, in the SI's unit.
    Below(Load, f64),
}

impl Need {
    /// How it is known what it needs: loads by runs.
    pub(super) fn known(&self) -> Known {
        if self.what == What::NoSeparation { Known::Computed } else { Known::Sampled }
    }
}

/// Units that loads are told in, each with what it is of the SI's.
const UNITS: [(Load, &str, f64); 11] = [
    (Load::ImpactSpeed, "m/s", 1.0),
    (Load::ImpactSpeed, "mm/s", 1e-3),
    (Load::ImpactSpeed, "in/s", 0.0254),
    (Load::ImpactSpeed, "ft/s", 0.3048),
    (Load::Gap, "m", 1.0),
    (Load::Gap, "mm", 1e-3),
    (Load::Gap, "um", 1e-6),
    (Load::Gap, "in", 0.0254),
    (Load::Gap, "ft", 0.3048),
    (Load::Energy, "J", 1.0),
    (Load::Energy, "mJ", 1e-3),
];

/// `no separation to 4500 rpm`, `impact speed below 0.5 m/s to 6000 rpm`.
impl FromStr for Need {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let like = "must be like \"no separation to 4500 rpm\" or \"impact speed below 0.5 m/s to 6000 rpm\" (also gap, energy)";
        let number = |word: &str| {
            let number = word.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
            number.ok_or_else(|| format!("\"{}\" is not a number above 0; {like}", foreign::value(word)))
        };
        let words: Vec<&str> = text.split_whitespace().collect();
        match words.as_slice() {
            ["no", "separation", "to", rpm, "rpm"] => Ok(Self { what: What::NoSeparation, rpm: number(rpm)? }),
            [name @ .., "below", value, unit, "to", rpm, "rpm"] => {
                let name = name.join("-");
                let load = Load::ALL.into_iter().find(|load| load.to_string() == name).ok_or(like)?;
                if load == Load::Force {
                    return Err("a force is no need: what keeps the follower on the cam presses harder; --limit tells where it is".into());
                }
                Ok(Self { what: What::Below(load, number(value)? * in_si(load, unit)?), rpm: number(rpm)? })
            }
            _ => Err(like.into()),
        }
    }
}

/// What a unit of a load is of the SI's.
pub fn in_si(load: Load, unit: &str) -> Result<f64, String> {
    let of_load = || UNITS.iter().filter(|(of, ..)| *of == load);
    let found = of_load().find(|(_, name, _)| *name == unit).map(|(_, _, one)| *one);
    found.ok_or_else(|| {
        let names: Vec<&str> = of_load().map(|(_, name, _)| *name).collect();
        let (unit, name) = (foreign::value(unit), load.to_string().replace('-', " "));
        match names.as_slice() {
            [] => format!("\"{unit}\": {name} is in the model's unit, which is not written"),
            names => format!("\"{unit}\": {name} is in one of: {}", names.join(", ")),
        }
    })
}

/// A number that an engineer can change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Lever {
    /// The force of the spring at the lowest lift.
    Preload,
    /// The stiffness of the spring.
    Stiffness,
    /// The damping.
    Damping,
    /// The mass of the follower.
    Mass,
}

named!(Lever);

impl Lever {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Preload, Self::Stiffness, Self::Damping, Self::Mass];

    /// Whether less of it does the most good.
    pub fn is_upper_bound(self) -> bool {
        self == Self::Mass
    }
}

/// A machine whose numbers are changed one by one.
#[derive(Clone, Debug)]
pub(super) struct Changed<'a> {
    model: &'a Model,
    contact: Contact<'a>,
    /// The lowest lift, and the force there where the model keeps that.
    lowest: f64,
    preload: Option<f64>,
}

impl<'a> Changed<'a> {
    pub fn new(model: &'a Model, contact: &Contact<'a>) -> Self {
        let lowest = contact.cam.lowest().value;
        Self { model, contact: contact.clone(), lowest, preload: model.preload }
    }

    /// The number as it is.
    pub fn value(&self, lever: Lever) -> f64 {
        let Follower { mass, damping, stiffness, rest_position, .. } = self.contact.follower;
        match lever {
            Lever::Preload => stiffness * (self.lowest - rest_position),
            Lever::Stiffness => stiffness,
            Lever::Damping => damping,
            Lever::Mass => mass,
        }
    }

    /// With another value of one number: `k (c_min - rest) = preload` stays where the model says the preload.
    pub fn with(&self, lever: Lever, value: f64) -> Self {
        let mut changed = self.clone();
        let follower = &mut changed.contact.follower;
        match lever {
            Lever::Preload => changed.preload = self.preload.map(|_| value),
            Lever::Stiffness => follower.stiffness = value,
            Lever::Damping => follower.damping = value,
            Lever::Mass => follower.mass = value,
        }
        let preload = if lever == Lever::Preload { Some(value) } else { changed.preload };
        if let Some(preload) = preload {
            changed.contact.follower.rest_position = self.lowest - preload / changed.contact.follower.stiffness;
        }
        changed
    }

    fn machine(&self, rpm: f64) -> Machine {
        Machine::new(self.contact.cam.clone(), &self.contact.follower, angular_velocity(rpm))
    }

    /// A value of a lever as it is told, and its unit.
    pub fn told(&self, lever: Lever, value: f64) -> (f64, String) {
        let unit = self.model.units.of_follower(&lever.to_string());
        unit.map_or((value, String::new()), |unit| (unit.told(value), unit.name().into()))
    }

    /// Whether the machine does as it is needed to.
    fn does(&self, need: &Need) -> Result<bool, SimulateError> {
        let stays = self.contact.separation().speed();
        if stays > need.rpm {
            return Ok(true);
        }
        let What::Below(load, limit) = need.what else { return Ok(false) };
        let limit = load.of_si(&self.model.units, limit);
        let mut model = self.model.clone();
        model.follower = self.contact.follower;
        let speed = |index: u32| stays + (need.rpm - stays) * f64::from(index) / f64::from(SPEEDS);
        // The highest speed first: one that does not do is enough.
        let passes = |index: u32| match Loads::at(&model, &self.machine(speed(SPEEDS - index))) {
            Ok(loads) if loads.of(load) < limit => None,
            other => Some(other.map(|_| false)),
        };
        (0..SPEEDS).into_par_iter().find_map_any(passes).unwrap_or(Ok(true))
    }
}

/// Speeds between separation and the highest that a load is looked at.
const SPEEDS: u32 = 24;

/// What one number has to be.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// What is needed, as it was said.
    pub need: String,
    /// Which number.
    pub lever: Lever,
    /// What it is, in the unit that is told.
    pub now: f64,
    /// The least that will do, or the most; none where no value does it.
    pub value: Option<f64>,
    /// How far it may be off: where the cam is measured, and of what is told by runs.
    pub error: Option<f64>,
    /// Whether that is the most that will do.
    pub is_upper_bound: bool,
    /// Where it does no more on the other side: a damper that keeps the follower on the cam's rise throws it off on the return.
    pub other: Option<f64>,
    /// How far that may be off.
    pub other_error: Option<f64>,
    /// A value beyond, of those tried, with which a load is as it is needed to be again.
    pub again: Option<f64>,
    /// The unit.
    pub unit: String,
    /// Why there is no value, or what else there is to say.
    pub note: String,
    /// Exact where it is a detachment, sampled where loads are looked at.
    pub known: Known,
}

document!(Answer as it {
    need: it.need,
    parameter: it.lever,
    now: it.now,
    value: it.value,
    error if_any: it.error,
    unit: it.unit,
    is_upper_bound: it.is_upper_bound,
    other if_any: it.other,
    other_error if_any: it.other_error,
    again if_any: it.again,
    note: it.note,
    known: it.known,
});

/// What a number has to be, the others kept, of a machine whose separation is uncertain by this part of its speed.
pub(super) fn answer(
    of: &Changed<'_>,
    (need, text): (&Need, &str),
    lever: Lever,
    uncertain: f64,
) -> Result<Answer, SimulateError> {
    let known = need.known();
    let found = find(of, need, lever)?;
    let told = |value: f64| of.told(lever, value).0;
    // Of what is as little as there can be nothing is open.
    let certain = match found.value {
        Some(_) if uncertain > 0.0 && found.note.is_empty() => {
            Some(find(of, &Need { rpm: need.rpm * (1.0 + uncertain), ..*need }, lever)?)
        }
        _ => None,
    };
    let error = |of: fn(&Found) -> Option<f64>| {
        let apart = (of(certain.as_ref()?)? - of(&found)?).abs();
        // As narrow as runs tell it.
        let width = if known == Known::Sampled { tolerance::NEEDED_BY_RUNS.value * of(&found)?.abs() } else { 0.0 };
        Some(told(apart.max(width)))
    };
    let (now, unit) = of.told(lever, of.value(lever));
    let stuck = found
        .stuck
        .map(|value| format!("at {} {unit} a run makes no progress, which is taken not to do", told(value) as f32));
    let again = found.again.map(|value| format!("with {} {unit} it is so again", told(value) as f32));
    let notes = [found.note.clone()].into_iter().filter(|note| !note.is_empty()).chain(again).chain(stuck);
    Ok(Answer {
        need: text.into(),
        lever,
        now,
        value: found.value.map(told),
        error: error(|found| found.value),
        is_upper_bound: found.is_upper_bound,
        other: found.other.map(told),
        other_error: error(|found| found.other),
        again: found.again.map(told),
        unit,
        note: notes.collect::<Vec<_>>().join("; "),
        known,
    })
}

/// Where a number begins to do, and where it ceases to on the other side; in the unit inside, with a sentence where there is none.
#[derive(Default)]
pub(super) struct Found {
    pub value: Option<f64>,
    pub other: Option<f64>,
    pub is_upper_bound: bool,
    pub note: String,
    /// A value that does beyond where it ceases to.
    pub again: Option<f64>,
    /// A value with which a run makes no progress.
    pub stuck: Option<f64>,
}

/// The range of values that do, if there are any.
///
/// The contact force is linear in each of the numbers: what keeps the follower on the cam everywhere and at each speed is one range. Of
/// loads that is not certain.
pub(super) fn find(of: &Changed<'_>, need: &Need, lever: Lever) -> Result<Found, SimulateError> {
    /// Doublings and halvings of the number's own size that are tried.
    const DOUBLINGS: i32 = 20;
    const DOUBLINGS_OF_RUNS: i32 = 6;
    let is_upper_bound = lever.is_upper_bound();
    let none = |note: String| Found { note, is_upper_bound, ..Found::default() };
    let springs = matches!(lever, Lever::Preload | Lever::Stiffness);
    if springs && of.contact.follower.stiffness == 0.0 {
        return Ok(none("there is no spring".into()));
    }
    let Follower { mass, stiffness, gravity, .. } = of.contact.follower;
    let weight = mass * gravity.abs();
    let rise = of.contact.cam.top() - of.lowest;
    let size = match lever {
        Lever::Preload => of.value(lever).max(stiffness * rise).max(weight),
        // The critical one, or what stops the mass in a radian.
        Lever::Damping => of.value(lever).max(2.0 * (stiffness * mass).sqrt()).max(mass * angular_velocity(need.rpm)),
        _ => of.value(lever),
    };
    let (most, width) = match need.what {
        What::NoSeparation => (DOUBLINGS, tolerance::ROOT_WIDTH.value),
        What::Below(..) => (DOUBLINGS_OF_RUNS, tolerance::NEEDED_BY_RUNS.value),
    };
    // A value with which a run does not get on is none that is known to do.
    let stuck = Cell::new(None);
    let does = |value: f64| match of.with(lever, value).does(need) {
        Err(SimulateError::NoProgress { .. }) => {
            stuck.set(Some(value));
            Ok(false)
        }
        other => other,
    };
    let mut values: Vec<f64> = (-most..=most).map(|power| size * 2.0_f64.powi(power)).collect();
    if !matches!(lever, Lever::Mass | Lever::Stiffness) {
        values.insert(0, 0.0);
    }
    if is_upper_bound {
        values.reverse();
    }
    let told = |value: f64| of.told(lever, value);
    let mut first = None;
    for (index, value) in values.iter().enumerate() {
        if does(*value)? {
            first = Some(index);
            break;
        }
    }
    let edge = |fails: f64, does_it: f64| halve([fails, does_it], Width::Relative(width), does).map(|[_, found]| found);
    let told_stuck = |found: Found| Found { stuck: stuck.get(), ..found };
    let Some(first) = first else {
        // A narrow range may lie between two of the values.
        if need.what == What::NoSeparation
            && let Some([low, best, high]) =
                best_of(&values, |value| of.with(lever, value).contact.separation().speed())
            && does(best)?
        {
            let (value, other) = (edge(low, best)?, edge(high, best)?);
            let found = Found { value: Some(value), other: Some(other), is_upper_bound, ..Found::default() };
            return Ok(told_stuck(found));
        }
        let (last, unit) = told(values.last().copied().unwrap_or_default());
        let side = if is_upper_bound { "above" } else { "below" };
        let tried = if need.what == What::NoSeparation { "" } else { ", of those tried," };
        return Ok(told_stuck(none(format!("no {lever} {side} {last:.1e} {unit}{tried} does it, the others kept"))));
    };
    // A preload moves the spring's rest from the lowest lift, which hides what rounds away beside that.
    let hidden = if lever == Lever::Preload { stiffness * of.lowest.abs() } else { 0.0 };
    let before = match first.checked_sub(1) {
        // Where nothing of it fails for want of any, no least value is to be found.
        Some(before) if values[before] == 0.0 && does(width * values[first].max(hidden))? => None,
        Some(before) => Some(edge(values[before], values[first])?),
        None => None,
    };
    let (mut beyond, mut again) = (None, None);
    for pair in values[first..].windows(2) {
        match (beyond, does(pair[1])?) {
            (None, false) => beyond = Some(edge(pair[1], pair[0])?),
            (Some(_), true) => {
                again = Some(pair[1]);
                break;
            }
            // What keeps the follower on the cam is one range.
            (Some(_), false) if need.what == What::NoSeparation => break,
            _ => {}
        }
    }
    let told_stuck = |found: Found| Found { again, ..told_stuck(found) };
    Ok(told_stuck(match (before, beyond) {
        (None, Some(_)) => Found { value: beyond, is_upper_bound: !is_upper_bound, ..Found::default() },
        (Some(_), _) => Found { value: before, other: beyond, is_upper_bound, ..Found::default() },
        (None, None) => {
            let (value, unit) = told(values[first]);
            let (value, note) = if is_upper_bound {
                (values[first], format!("as far as {value:.3e} {unit} is looked at, any will do"))
            } else if first > 0 && values[first - 1] == 0.0 {
                (0.0, "any above 0 will do".into())
            } else {
                (values[first], "as little as there can be will do".into())
            };
            Found { value: Some(value), ..none(note) }
        }
    }))
}

/// Between its neighbours the value for which `speed` is largest, where all values for which it is above any bound are one range.
fn best_of(values: &[f64], speed: impl Fn(f64) -> f64) -> Option<[f64; 3]> {
    /// Thirds of the range that are left out, one after the other: to the square root of a rounding, which a flat top hides.
    const THIRDS: usize = 45;
    let speeds: Vec<f64> = values.iter().map(|value| speed(*value)).collect();
    let best = (0..values.len()).max_by(|one, two| speeds[*one].total_cmp(&speeds[*two]))?;
    let [from, to] = [best.saturating_sub(1), (best + 1).min(values.len() - 1)].map(|index| values[index]);
    let (mut low, mut high) = (from, to);
    for _ in 0..THIRDS {
        let third = (high - low) / 3.0;
        if speed(low + third) < speed(high - third) {
            low += third;
        } else {
            high -= third;
        }
    }
    Some([from, 0.5 * (low + high), to])
}
