//! Table `[units]`: the units of a model file's numbers and of the results.
//!
//! Internally, masses are in kg, times in s and lengths in the file's unit. So every position, velocity and matrix is computed in the units
//! of the file. Stiffness and damping, kg/s^2 and kg/s, are N/m and N s/m for any unit of length. Only forces, kg times that length over
//! s^2, are converted for output.

use std::borrow::Cow;

use super::ModelError;
use super::fields::Fields;
use super::quantity::{Dimension, ModelNumber};

/// Unit: its name, and its size in the internal unit as an exact quotient of whole numbers.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub struct Unit {
    name: Cow<'static, str>,
    ratio: [u128; 2],
}

impl Unit {
    const fn new(name: &'static str, above: u128, below: u128) -> Self {
        Self { name: Cow::Borrowed(name), ratio: [above, below] }
    }

    /// Name in files and results.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Converts a value from this unit to the internal unit.
    pub fn inside(&self, value: f64) -> f64 {
        value * self.ratio[0] as f64 / self.ratio[1] as f64
    }

    /// Converts a value from the internal unit to this unit.
    pub fn told(&self, value: f64) -> f64 {
        value * self.ratio[1] as f64 / self.ratio[0] as f64
    }

    /// Exact factor from this unit to the internal unit; `None` for 1.
    pub(super) fn factor(&self) -> Option<[u128; 2]> {
        (self.ratio[0] != self.ratio[1]).then_some(self.ratio)
    }

    /// Returns this unit as a multiple of `other`, which then becomes the internal unit.
    pub(super) fn in_parts_of(&self, other: &Self) -> Self {
        let ratio = if self.ratio == other.ratio { [1; 2] } else { self.over(other) };
        Self { name: self.name.clone(), ratio }
    }

    /// Whether it is another unit divided by this power of ten: a thousandth for 3.
    pub(super) fn is_part_of(&self, other: &Self, places: u32) -> bool {
        self.ratio == [other.ratio[0], other.ratio[1] * 10_u128.pow(places)]
    }

    fn over(&self, other: &Self) -> [u128; 2] {
        [self.ratio[0] * other.ratio[1], self.ratio[1] * other.ratio[0]]
    }
}

/// Units by name, as multiples of the SI unit; the first is the SI unit itself.
pub(super) static LENGTHS: [Unit; 7] = [
    Unit::new("m", 1, 1),
    Unit::new("cm", 1, 100),
    Unit::new("mm", 1, 1000),
    Unit::new("um", 1, 1_000_000),
    Unit::new("in", 127, 5000),
    Unit::new("ft", 381, 1250),
    Unit::new("thou", 127, 5_000_000),
];
const MASSES: [Unit; 5] = [
    Unit::new("kg", 1, 1),
    Unit::new("g", 1, 1000),
    Unit::new("t", 1000, 1),
    Unit::new("lb", 45_359_237, 100_000_000),
    Unit::new("oz", 45_359_237, 1_600_000_000),
];
const FORCES: [Unit; 5] = [
    Unit::new("N", 1, 1),
    Unit::new("mN", 1, 1000),
    Unit::new("kN", 1000, 1),
    Unit::new("kgf", 980_665, 100_000),
    // Pound times the standard acceleration of gravity.
    Unit::new("lbf", 44_482_216_152_605, 10_000_000_000_000),
];

/// Units of a model file.
#[derive(Clone, Debug, PartialEq)]
pub struct Units {
    /// Whether the file gives any unit.
    pub are_given: bool,
    /// Whether the file gives the units of length, mass and stiffness, in this order.
    pub(crate) says: [bool; 3],
    /// Unit of length, as a multiple of a metre; internal lengths are in it too.
    pub length: Unit,
    /// Unit of mass, as a multiple of a kilogram.
    pub mass: Unit,
    /// Unit of force; internally kg times the unit of length over s^2.
    pub force: Unit,
    /// Unit of stiffness, as a multiple of N/m.
    pub stiffness: Unit,
    /// Unit of damping, as a multiple of N s/m.
    pub damping: Unit,
    /// Unit of gravity; internally the unit of length over s^2.
    pub gravity: Unit,
    /// Whether results give angles in degrees.
    pub degrees: bool,
}

/// Function that converts an internal value for output.
#[doc(hidden)]
pub type Converted = fn(&Units, f64) -> f64;

/// Reads the unit from `table` that a field names; the first one if the field is missing.
fn simple(fields: &mut Fields, path: &str, table: &[Unit]) -> Result<Unit, ModelError> {
    let choices: Vec<(&str, usize)> = table.iter().enumerate().map(|(index, unit)| (unit.name(), index)).collect();
    if !fields.has(path) {
        fields.may_hold(path);
        return Ok(table[0].clone());
    }
    Ok(table[fields.choice(path, &choices)?].clone())
}

fn named(table: &[Unit], name: &str) -> Option<Unit> {
    table.iter().find(|unit| unit.name() == name.trim()).cloned()
}

/// Reads the quotient of units that a field names; `part` looks up the units before and after the slash.
fn quotient(
    fields: &mut Fields,
    path: &str,
    usual: &'static str,
    is_like: &str,
    part: impl Fn(&str, &str) -> Option<[Unit; 2]>,
) -> Result<Unit, ModelError> {
    let text = fields.text_or(path, usual)?;
    let units = text.split_once('/').and_then(|(above, below)| part(above, below));
    let [above, below] = units.ok_or_else(|| fields.reject(path, format!("must be {is_like}")))?;
    let name = if text == usual { Cow::Borrowed(usual) } else { Cow::Owned(text) };
    Ok(Unit { name, ratio: above.over(&below) })
}

impl Units {
    /// Reads the table `[units]`; missing entries are SI units.
    pub(super) fn read(fields: &mut Fields) -> Result<Self, ModelError> {
        let length = simple(fields, "units.length", &LENGTHS)?;
        let mass = simple(fields, "units.mass", &MASSES)?;
        let force = simple(fields, "units.force", &FORCES)?;
        let of_length = |unit: Unit| Unit { ratio: unit.over(&length), ..unit };
        let stiffness =
            quotient(fields, "units.stiffness", "N/m", "a force over a length, such as N/mm", |one, two| {
                Some([named(&FORCES, one)?, named(&LENGTHS, two)?])
            })?;
        let like = "a force times s over a length, such as N s/mm";
        let damping = quotient(fields, "units.damping", "N s/m", like, |one, two| {
            let force = one.trim().strip_suffix('s')?.trim_end_matches([' ', '*', '·']);
            Some([named(&FORCES, force)?, named(&LENGTHS, two)?])
        })?;
        let like = "a length over s^2, such as mm/s^2";
        let gravity = quotient(fields, "units.gravity", "m/s^2", like, |one, two| {
            let is_square = ["s^2", "s2", "s²"].contains(&two.trim());
            is_square.then_some([named(&LENGTHS, one)?, LENGTHS[0].clone()])
        })?;
        fields.may_hold("units.angle");
        let degrees = fields.has("units.angle") && fields.choice("units.angle", &[("rad", false), ("deg", true)])?;
        let (force, gravity) = (of_length(force), of_length(gravity));
        let says = ["units.length", "units.mass", "units.stiffness"].map(|path| fields.has(path));
        Ok(Self { are_given: fields.has("units"), says, length, mass, force, stiffness, damping, gravity, degrees })
    }

    /// Unit of a number of the follower; `None` for a pure number or a length.
    pub fn of_follower(&self, name: &str) -> Option<&Unit> {
        self.of(ModelNumber::of(&format!("follower.{name}"))?.dimension)
    }

    /// Unit of the numbers of a dimension; `None` for dimensions with a fixed unit, and for lengths, which are in the file's unit.
    fn of(&self, dimension: Dimension) -> Option<&Unit> {
        match dimension {
            Dimension::Mass => Some(&self.mass),
            Dimension::Damping => Some(&self.damping),
            Dimension::Stiffness => Some(&self.stiffness),
            Dimension::Acceleration => Some(&self.gravity),
            Dimension::Force => Some(&self.force),
            Dimension::Pure | Dimension::Length | Dimension::Degrees | Dimension::Speed | Dimension::LengthPerPower => {
                None
            }
        }
    }

    /// Output unit of a number, by its dotted path or `rpm`; empty for a pure number.
    pub fn of_number(&self, path: &str) -> String {
        let number = ModelNumber::of(path).or_else(|| ModelNumber::of(&format!("follower.{path}")));
        let Some(number) = number else { return String::new() };
        let unit = self.of(number.dimension).filter(|_| self.are_given);
        unit.map_or_else(|| self.spelled(number.dimension.si()), |unit| unit.name().into())
    }

    /// Converts a value of the number at a dotted path from a typed unit to the file's unit; `None` if such a number cannot have the typed
    /// unit.
    #[doc(hidden)]
    pub fn in_own(&self, path: &str, value: f64, unit: &str) -> Option<f64> {
        let parts = |text: &str| {
            let (above, below) = text.split_once('/')?;
            let (force, length) = (named(&FORCES, above)?, named(&LENGTHS, below)?);
            Some(Unit { name: Cow::Borrowed(""), ratio: force.over(&length) })
        };
        let number = ModelNumber::of(path)?;
        let (own, typed) = match number.dimension {
            Dimension::Mass => (&self.mass, named(&MASSES, unit)?),
            Dimension::Stiffness => (&self.stiffness, parts(unit)?),
            Dimension::Length => (&self.length, named(&LENGTHS, unit)?),
            Dimension::Force => {
                let typed = named(&FORCES, unit)?;
                (&self.force, Unit { ratio: typed.over(&self.length), ..typed })
            }
            _ => return (unit.replace(' ', "") == self.of_number(path).replace(' ', "")).then_some(value),
        };
        Some(if own.ratio == typed.ratio { value } else { own.told(typed.inside(value)) })
    }

    /// Reads a number of the follower and converts it to internal units.
    pub(super) fn number(&self, fields: &mut Fields, name: &str) -> Result<f64, ModelError> {
        let path = format!("follower.{name}");
        let written = fields.number(&path)?;
        let number = self.of_follower(name).map_or(written, |unit| unit.inside(written));
        // After conversion, a number may have overflowed, or underflowed to 0 where that is not allowed.
        if ModelNumber::of(&path).is_none_or(|it| it.allowed.contains(number)) {
            Ok(number)
        } else {
            Err(fields.reject(&path, "is too large or too small"))
        }
    }

    /// Rewrites a unit of length, velocity or acceleration from metres to this file's length: `m/s` to `mm/s`.
    pub fn spelled(&self, unit: &str) -> String {
        let rest = unit.strip_prefix('m').filter(|rest| rest.is_empty() || rest.starts_with(['/', ' ']));
        rest.map_or_else(|| unit.to_owned(), |rest| format!("{}{rest}", self.length.name()))
    }

    /// Name of a field or a column in these units: `gap_mm` for `gap_m`.
    pub fn field(&self, name: &str) -> String {
        let (head, unit) = ["_m_s", "_m", "_rad", "_n"]
            .into_iter()
            .find_map(|unit| Some((name.strip_suffix(unit)?, unit)))
            .unwrap_or((name, ""));
        let length = self.length.name();
        match unit {
            "_m_s" => format!("{head}_{length}_s"),
            "_m" => format!("{head}_{length}"),
            "_rad" if self.degrees => format!("{head}_deg"),
            "_n" => format!("{head}_{}", self.force.name().to_lowercase()),
            unit => format!("{head}{unit}"),
        }
    }

    /// Header line of a table, with its line end, in these units.
    pub fn columns(&self, line: &str) -> String {
        let names = line.trim_end().split(',').map(|name| self.field(name));
        names.collect::<Vec<_>>().join(",") + "\n"
    }

    /// Converts an angle, rad, to the unit of the results.
    pub fn angle(&self, angle: f64) -> f64 {
        if self.degrees { angle.to_degrees() } else { angle }
    }

    /// Conversion of the values of a field or column, by its name in SI units; `None` for lengths, which need none.
    pub fn converted(&self, name: &str) -> Option<Converted> {
        if name.ends_with("_rad") {
            Some(Self::angle)
        } else if name.ends_with("_n") {
            Some(|units, force| units.force.told(force))
        } else {
            None
        }
    }
}

impl Default for Units {
    /// SI units.
    fn default() -> Self {
        let [length, mass, force] = [&LENGTHS[0], &MASSES[0], &FORCES[0]].map(Unit::clone);
        let [stiffness, damping, gravity] = ["N/m", "N s/m", "m/s^2"].map(|name| Unit::new(name, 1, 1));
        Self { are_given: false, says: [false; 3], length, mass, force, stiffness, damping, gravity, degrees: false }
    }
}
