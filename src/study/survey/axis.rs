//! Axes of a survey: the values of one number of the model.

use std::fmt::Display;
use std::sync::Arc;

use crate::elementary;
use crate::orbit::Parameter;

/// How values lie between the lowest and the highest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spacing {
    /// Evenly.
    Linear,
    /// Evenly in their logarithm: each is the same multiple of the one before.
    Logarithmic,
}

impl Spacing {
    /// Where a value lies, so that what is as far apart there is as far apart on the axis: itself, or its decimal logarithm.
    pub fn place(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Logarithmic => elementary::log10(value),
        }
    }

    /// The value that lies there.
    pub fn value(self, place: f64) -> f64 {
        match self {
            Self::Linear => place,
            Self::Logarithmic => elementary::powf(10.0_f64, place),
        }
    }
}

/// Values between two ends, both of which are among them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Values {
    /// The lowest.
    pub low: f64,
    /// The highest.
    pub high: f64,
    /// How many, 1 or more.
    pub count: usize,
    /// How they lie between the two; of logarithmic ones `low` is above 0.
    pub spacing: Spacing,
}

impl Values {
    /// The fastest speed that is turned, rpm: an angle keeps its digits only over times that a double resolves.
    pub const FASTEST: f64 = 1e9;
    /// The most values of one axis.
    pub const MOST: usize = 10_000_000;

    /// Evenly spaced.
    pub fn linear(low: f64, high: f64, count: usize) -> Self {
        Self { low, high, count, spacing: Spacing::Linear }
    }

    /// All of them, from the lowest up.
    pub fn all(self) -> impl Iterator<Item = f64> {
        (0..self.count).map(move |index| self.value(index))
    }

    /// The one of an index below `count`; the last is `high` exactly.
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

/// Values of a number.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What varies.
    pub parameter: Parameter,
    /// Its values, one or more.
    pub values: Arc<[f64]>,
    /// How they lie, for pictures.
    pub spacing: Spacing,
}

impl Axis {
    /// Values of a parameter.
    pub fn new(parameter: Parameter, values: &Values) -> Self {
        Self { parameter, values: values.all().collect(), spacing: values.spacing }
    }

    /// These values.
    pub fn of(parameter: Parameter, values: Arc<[f64]>) -> Self {
        Self { parameter, values, spacing: Spacing::Linear }
    }

    /// The first and the last value.
    pub fn ends(&self) -> [f64; 2] {
        [self.values.first(), self.values.last()].map(|end| end.copied().unwrap_or(f64::NAN))
    }
}

/// Where on an axis something is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The speed, rpm.
    pub rpm: f64,
    /// The value of the number that varies; none where that is the speed.
    pub value: Option<f64>,
}

impl Place {
    /// At a speed, rpm, which is what varies.
    pub fn of_speed(rpm: f64) -> Self {
        Self { rpm, value: None }
    }

    /// The value of what varies.
    pub fn across(&self) -> f64 {
        self.value.unwrap_or(self.rpm)
    }
}

impl Parameter {
    /// Where it has a value, of machines that turn at `rpm` where it is not the speed.
    pub fn place(&self, value: f64, rpm: f64) -> Place {
        match self {
            Self::Speed => Place::of_speed(value),
            Self::Field(_) => Place { rpm, value: Some(value) },
        }
    }

    /// A value of it in words: `700 rpm`, `follower.restitution = 0.8`.
    pub fn words(&self, value: f64) -> String {
        match self {
            Self::Speed => format!("{value} rpm"),
            Self::Field(path) => format!("{path} = {value}"),
        }
    }
}

/// What varies, and where the rest stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Varied {
    /// The number's name: `rpm`, or its dotted path.
    pub name: String,
    /// What it is told in; empty of a pure number.
    pub unit: String,
    /// The speed, rpm, where another number varies.
    pub rpm: Option<f64>,
    /// How the values lie.
    pub spacing: Spacing,
}

impl Varied {
    /// Whether the speed varies.
    pub fn is_speed(&self) -> bool {
        self.rpm.is_none()
    }

    /// What one of its values is called.
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

    /// A range in words: `600 to 760 rpm`, `restitution 0.5 to 0.9 at 700 rpm`.
    pub fn range(&self, [low, high]: [f64; 2]) -> String {
        let range = self.words(format!("{low} to {high}"));
        let name = self.name.rsplit('.').next().unwrap_or_default();
        self.rpm.map_or(range.clone(), |rpm| format!("{name} {range} at {rpm} rpm"))
    }
}
