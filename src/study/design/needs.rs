//! What must be changed so that a machine does as it is needed to: one number at a time, the others kept.

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

/// Units that loads are told in, each with what it is of the SI's.
const UNITS: [(Load, &str, f64); 9] = [
    (Load::ImpactSpeed, "m/s", 1.0),
    (Load::ImpactSpeed, "mm/s", 1e-3),
    (Load::ImpactSpeed, "in/s", 0.0254),
    (Load::Gap, "m", 1.0),
    (Load::Gap, "mm", 1e-3),
    (Load::Gap, "um", 1e-6),
    (Load::Gap, "in", 0.0254),
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
                let of_load = || UNITS.iter().filter(|(of, ..)| *of == load);
                let Some((_, _, one)) = of_load().find(|(_, name, _)| name == unit) else {
                    let names: Vec<&str> = of_load().map(|(_, name, _)| *name).collect();
                    let unit = foreign::value(unit);
                    return Err(format!("\"{unit}\": {} is in one of: {}", name.replace('-', " "), names.join(", ")));
                };
                Ok(Self { what: What::Below(load, number(value)? * one), rpm: number(rpm)? })
            }
            _ => Err(like.into()),
        }
    }
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
        let units = &self.model.units;
        let limit = match load {
            Load::ImpactSpeed | Load::Gap => units.length.told(limit),
            Load::Energy | Load::Force => limit,
        };
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
    /// The least that will do, of a mass the most; none where no value does it.
    pub value: Option<f64>,
    /// How far it may be off where the cam is measured.
    pub error: Option<f64>,
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
    is_upper_bound: it.lever.is_upper_bound(),
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
    let known = if need.what == What::NoSeparation { Known::Computed } else { Known::Sampled };
    let (found, note) = find(of, need, lever)?;
    let value = found.map(|value| of.told(lever, value).0);
    let error = match found {
        // Of what is as little as there can be nothing is open.
        Some(value) if uncertain > 0.0 && note.is_empty() => {
            let (certain, _) = find(of, &Need { rpm: need.rpm * (1.0 + uncertain), ..*need }, lever)?;
            certain.map(|certain| of.told(lever, (certain - value).abs()).0)
        }
        _ => None,
    };
    let (now, unit) = of.told(lever, of.value(lever));
    Ok(Answer { need: text.into(), lever, now, value, error, unit, note, known })
}

/// The value of a number, or none, with a sentence.
pub(super) fn find(of: &Changed<'_>, need: &Need, lever: Lever) -> Result<(Option<f64>, String), SimulateError> {
    /// Doublings and halvings of the number's own size that are tried.
    const DOUBLINGS: i32 = 20;
    const DOUBLINGS_OF_RUNS: i32 = 6;
    let springs = matches!(lever, Lever::Preload | Lever::Stiffness);
    if springs && of.contact.follower.stiffness == 0.0 {
        return Ok((None, "there is no spring".into()));
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
    let does = |value: f64| of.with(lever, value).does(need);
    let mut values: Vec<f64> = (-most..=most).map(|power| size * 2.0_f64.powi(power)).collect();
    if !matches!(lever, Lever::Mass | Lever::Stiffness) {
        values.insert(0, 0.0);
    }
    if lever.is_upper_bound() {
        values.reverse();
    }
    let mut before = None;
    for value in values {
        if does(value)? {
            let unit = of.told(lever, value).1;
            let Some(fails) = before else {
                let words = if lever.is_upper_bound() {
                    format!("as far as {:.3e} {unit} is looked at, any will do", of.told(lever, value).0)
                } else {
                    "as little as there can be will do".into()
                };
                return Ok((Some(value), words));
            };
            let [_, found] = halve([fails, value], Width::Relative(width), does)?;
            return Ok((Some(found), String::new()));
        }
        before = Some(value);
    }
    let (last, unit) = of.told(lever, before.unwrap_or_default());
    let side = if lever.is_upper_bound() { "above" } else { "below" };
    Ok((None, format!("no {lever} {side} {last:.1e} {unit} does it, the others kept")))
}
