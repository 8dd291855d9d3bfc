//! The machines of a model over one of its numbers, at any value.

use super::axis::{Place, Spacing, Varied};
use crate::cam::Cam;
use crate::model::Model;
use crate::orbit::{Family, FamilyError, Parameter};
use crate::simulate::Machine;

/// The machines of a model over one of its numbers.
#[derive(Clone, Debug)]
pub struct Over<'a> {
    /// The model.
    pub model: &'a Model,
    /// What varies.
    pub parameter: Parameter,
    /// For branches that are followed along it.
    pub family: Family,
    /// The speed, rpm, where it is not what varies.
    pub rpm: f64,
}

/// Why nothing can be gone over.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OverError {
    /// No speed is named, and what varies is none.
    #[error("{} rpm: --rpm says at which speed", .0.as_ref().map_or("neither axis is".into(), |name| format!("{name} is not")))]
    NoSpeed(Option<String>),
    /// A speed is named, and what varies is the speed.
    #[error("--rpm R is for a survey of which no axis is rpm")]
    TwoSpeeds,
    /// The machine cannot be.
    #[error(transparent)]
    Family(#[from] FamilyError),
}

/// The speed, rpm, of a survey over these numbers, of which `rpm` is named: any, where the speed varies.
pub(super) fn speed(free: &[Parameter], rpm: Option<f64>) -> Result<f64, OverError> {
    /// Where it varies, each machine has another.
    const ANY: f64 = 1.0;
    match (free.contains(&Parameter::Speed), rpm) {
        (true, None) => Ok(ANY),
        (true, Some(_)) => Err(OverError::TwoSpeeds),
        (false, Some(rpm)) => Ok(rpm),
        (false, None) => {
            let alone = if let [one] = free { Some(one.name().to_owned()) } else { None };
            Err(OverError::NoSpeed(alone))
        }
    }
}

impl<'a> Over<'a> {
    /// The machines of `model` over a number, at `rpm`, which is named where that is not the speed.
    pub fn new(model: &'a Model, parameter: Parameter, rpm: Option<f64>) -> Result<Self, OverError> {
        let free = vec![parameter.clone()];
        let rpm = speed(&free, rpm)?;
        let family = Family::new(model, rpm, free)?;
        Ok(Self { model, parameter, family, rpm })
    }

    /// The machines of `model` over its speed.
    pub fn speed(model: &'a Model) -> Result<Self, OverError> {
        Self::new(model, Parameter::Speed, None)
    }

    /// Whether the speed varies.
    pub fn is_speed(&self) -> bool {
        self.parameter == Parameter::Speed
    }

    /// The machine with a value.
    pub fn machine(&self, value: f64) -> Result<Machine, FamilyError> {
        Ok(self.family.machine(&[value])?.0)
    }

    /// The model with a value, and its cam.
    pub fn model(&self, value: f64) -> Result<(Model, Cam), FamilyError> {
        let (model, machine) = (self.family.model(&[value])?, self.machine(value)?);
        Ok((model, machine.cam().clone()))
    }

    /// What varies, in words, with values that lie so.
    pub fn varied(&self, spacing: Spacing) -> Varied {
        let name = self.parameter.name();
        let rpm = (!self.is_speed()).then_some(self.rpm);
        Varied { name: name.into(), unit: self.model.units.of_number(name), rpm, spacing }
    }

    /// Where a value is.
    pub fn place(&self, value: f64) -> Place {
        self.parameter.place(value, self.rpm)
    }
}
