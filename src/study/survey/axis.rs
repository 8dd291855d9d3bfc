//! Axes of a survey: the values of one number of the model.

use std::fmt::Display;
use std::sync::Arc;

use crate::elementary;
use crate::orbit::Parameter;

/// Spacing of values between the lowest and the highest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spacing {
    /// Evenly.
    Linear,
    /// Evenly in the logarithm: each value is the same multiple of the one before.
    Logarithmic,
}

impl Spacing {
    /// Position of a value on an axis with even spacing: the value itself, or its decimal logarithm.
    pub fn place(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Logarithmic => elementary::log10(value),
        }
    }

    /// Value at a position on the axis.
    pub fn value(self, place: f64) -> f64 {
        match self {
            Self::Linear => place,
            Self::Logarithmic => elementary::powf(10.0_f64, place),
        }
    }
}

/// Values between two ends, including both ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Values {
    /// Lowest value.
    pub low: f64,
    /// Highest value.
    pub high: f64,
    /// Number of values, 1 or more.
    pub count: usize,
    /// Spacing of the values; if it is logarithmic, `low` is above 0.
    pub spacing: Spacing,
}

impl Values {
    /// Highest speed of a run, rpm: an angle keeps its digits only over times that a double resolves.
    pub const FASTEST: f64 = 1e9;
    /// Largest number of values of one axis.
    pub const MOST: usize = 10_000_000;

    /// Evenly spaced values.
    pub fn linear(low: f64, high: f64, count: usize) -> Self {
        Self { low, high, count, spacing: Spacing::Linear }
    }

    /// Iterates over all values, from the lowest up.
    pub fn all(self) -> impl Iterator<Item = f64> {
        (0..self.count).map(move |index| self.value(index))
    }

    /// Returns the value of an index below `count`; the last is `high` exactly.
    pub fn value(&self, index: usize) -> f64 {
        if index + 1 >= self.count && self.count > 1 {
            return self.high;
        }
        let part = index as f64 / (self.count.max(2) - 1) as f64;
        match self.spacing {
            Spacing::Linear => self.low + (self.high - self.low) * part,
            // The first is `low` exactly.
            Spacing::Logarithmic => self.low * elementary::powf(self.high / self.low, part),
        }
    }
}

/// Values of one number of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The number that varies.
    pub parameter: Parameter,
    /// The values, one or more.
    pub values: Arc<[f64]>,
    /// Spacing of the values, for pictures.
    pub spacing: Spacing,
}

impl Axis {
    /// Builds an axis from a parameter and its values.
    pub fn new(parameter: Parameter, values: &Values) -> Self {
        Self { parameter, values: values.all().collect(), spacing: values.spacing }
    }

    /// Builds an axis from a parameter and a list of values.
    pub fn of(parameter: Parameter, values: Arc<[f64]>) -> Self {
        Self { parameter, values, spacing: Spacing::Linear }
    }

    /// Returns the first and the last value.
    pub fn ends(&self) -> [f64; 2] {
        [self.values.first(), self.values.last()].map(|end| end.copied().unwrap_or(f64::NAN))
    }
}

/// A place on an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The speed, rpm.
    pub rpm: f64,
    /// Value of the number that varies; none if that is the speed.
    pub value: Option<f64>,
}

impl Place {
    /// Place at a speed, rpm, if the speed varies.
    pub fn of_speed(rpm: f64) -> Self {
        Self { rpm, value: None }
    }

    /// Unit in the name of a field with the value: the unit of a speed, or none.
    pub fn unit(&self) -> &'static str {
        if self.value.is_none() { "_rpm" } else { "" }
    }

    /// Value of the number that varies.
    pub fn across(&self) -> f64 {
        self.value.unwrap_or(self.rpm)
    }
}

impl Parameter {
    /// Place of a value. If the parameter is not the speed, the machines turn at `rpm`.
    pub fn place(&self, value: f64, rpm: f64) -> Place {
        match self {
            Self::Speed => Place::of_speed(value),
            Self::Field(_) => Place { rpm, value: Some(value) },
        }
    }

    /// Value of the parameter in words: `700 rpm`, `follower.restitution = 0.8`.
    pub fn words(&self, value: f64) -> String {
        match self {
            Self::Speed => format!("{value} rpm"),
            Self::Field(path) => format!("{path} = {value}"),
        }
    }
}

/// The number that varies, and the fixed speed if it is another number.
#[derive(Clone, Debug, PartialEq)]
pub struct VariedNumber {
    /// Name of the number: `rpm`, or its dotted path.
    pub name: String,
    /// Unit of its values; empty for a pure number.
    pub unit: String,
    /// The speed, rpm, if another number varies.
    pub rpm: Option<f64>,
    /// Spacing of the values.
    pub spacing: Spacing,
}

impl VariedNumber {
    /// Whether the speed varies.
    pub fn is_speed(&self) -> bool {
        self.rpm.is_none()
    }

    /// Word for one of its values.
    pub fn value(&self) -> &'static str {
        if self.is_speed() { "speed" } else { "value" }
    }

    /// A value in words, with its unit.
    pub fn words(&self, value: impl Display) -> String {
        match &self.unit {
            unit if unit.is_empty() => value.to_string(),
            unit => format!("{value} {unit}"),
        }
    }

    /// Head of a column of its values: `rpm`, `stiffness N/m`.
    pub fn head(&self) -> String {
        let unit = if self.is_speed() { "" } else { &self.unit };
        format!("{} {unit}", self.own_name()).trim_end().to_owned()
    }

    /// The last part of its path.
    pub fn own_name(&self) -> &str {
        self.name.rsplit('.').next().unwrap_or_default()
    }

    /// Its name at the fixed speed, `restitution at 700 rpm`, or this word if it is the speed.
    pub fn at_speed(&self, speed: &str) -> String {
        self.rpm.map_or(speed.to_owned(), |rpm| format!("{} at {rpm} rpm", self.own_name()))
    }

    /// A range in words: `600 to 760 rpm`, `restitution 0.5 to 0.9 at 700 rpm`.
    pub fn range(&self, [low, high]: [f64; 2]) -> String {
        let range = self.words(format!("{low} to {high}"));
        let name = self.own_name();
        self.rpm.map_or(range.clone(), |rpm| format!("{name} {range} at {rpm} rpm"))
    }
}
