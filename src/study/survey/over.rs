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

impl<'a> Over<'a> {
    /// The machines of `model` over a number, at `rpm` where that is not the speed.
    pub fn new(model: &'a Model, parameter: Parameter, rpm: f64) -> Result<Self, FamilyError> {
        let family = Family::new(model, rpm, vec![parameter.clone()])?;
        Ok(Self { model, parameter, family, rpm })
    }

    /// The machines of `model` over its speed; `rpm` is one of them.
    pub fn speed(model: &'a Model, rpm: f64) -> Result<Self, FamilyError> {
        Self::new(model, Parameter::Speed, rpm)
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
