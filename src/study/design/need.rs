//! Requirements on a machine, as users write them.

use std::str::FromStr;

use super::loads::Load;
use crate::known::Evidence;
use crate::model::{finite, parted};
use crate::untrusted;

/// A requirement that a machine must meet up to a speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Need {
    /// The requirement.
    pub what: What,
    /// Highest speed at which it must be met, rpm.
    pub rpm: f64,
}

/// A requirement on a machine.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub enum What {
    /// The follower stays on the cam.
    NoSeparation,
    /// A load stays below a value, in SI units.
    Below(Load, f64),
}

impl Need {
    /// Evidence for the answer to this need: separation is computed, loads are sampled by runs.
    pub(super) fn known(&self) -> Evidence {
        if self.what == What::NoSeparation { Evidence::Computed } else { Evidence::Sampled }
    }
}

/// Units in which a load may be written, each with its size in SI units.
const UNITS: [(Load, &str, f64); 14] = [
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
    (Load::Force, "N", 1.0),
    (Load::Force, "kN", 1e3),
    (Load::Force, "lbf", 4.4482216152605),
];

/// Parses `no separation to 4500 rpm`, `impact speed below 0.5 m/s to 6000 rpm`.
impl FromStr for Need {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let like = "must be like \"no separation to 4500 rpm\" or \"impact speed below 0.5 m/s to 6000 rpm\" (also gap, energy)";
        let number = |word: &str| match finite(word, "") {
            Ok(number) if number > 0.0 => Ok(number),
            Err(why) if word.contains(',') => Err(why),
            _ => Err(format!("\"{}\" is not a number above 0; {like}", untrusted::value(word))),
        };
        // "4500rpm" is two words.
        let apart = |word| {
            let (number, unit) = parted(word);
            if unit.starts_with(',') { [word, ""] } else { [number, unit] }
        };
        let words = text.split_whitespace().flat_map(apart).filter(|word| !word.is_empty());
        let words: Vec<&str> = words.collect();
        match words.as_slice() {
            ["no", "separation", "to", rpm, "rpm"] => Ok(Self { what: What::NoSeparation, rpm: number(rpm)? }),
            [name @ .., "below", value, unit, "to", rpm, "rpm"] => {
                let name = name.join("-");
                let load = Load::ALL.into_iter().find(|load| load.to_string() == name).ok_or(like)?;
                if load == Load::Force {
                    return Err(
                        "a force cannot be a need: keeping the follower on the cam raises it; --limit finds where it is exceeded".into(),
                    );
                }
                Ok(Self { what: What::Below(load, number(value)? * in_si(load, unit)?), rpm: number(rpm)? })
            }
            _ => Err(like.into()),
        }
    }
}

/// Size of a load's unit in SI units.
#[doc(hidden)]
pub fn in_si(load: Load, unit: &str) -> Result<f64, String> {
    let of_load = || UNITS.iter().filter(|(of, ..)| *of == load);
    let found = of_load().find(|(_, name, _)| *name == unit).map(|(_, _, one)| *one);
    found.ok_or_else(|| {
        let names: Vec<&str> = of_load().map(|(_, name, _)| *name).collect();
        let (unit, name) = (untrusted::value(unit), load.to_string().replace('-', " "));
        format!("\"{unit}\": {name} is in one of: {}", names.join(", "))
    })
}
