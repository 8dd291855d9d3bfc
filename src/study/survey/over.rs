//! The machines of a model over one of its numbers, at any value.

use super::axis::{Place, Spacing, VariedNumber};
use crate::cam::Cam;
use crate::model::Model;
use crate::orbit::{Family, FamilyError, Parameter};
use crate::simulate::{Machine, angular_velocity};
use crate::uncertainty::PlausibleMachines;

/// The machines of a model over one of its numbers.
#[derive(Clone, Debug)]
pub struct Over<'a> {
    /// The model.
    pub model: &'a Model,
    /// The number that varies.
    pub parameter: Parameter,
    /// The family, for following branches along the parameter.
    pub family: Family,
    /// The speed, rpm, if it is not the number that varies.
    pub rpm: f64,
}

/// Why there are no machines over a number.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OverError {
    /// No speed is given, and the number that varies is not the speed.
    #[error("{}, but the speed is missing: give --rpm R", .0.as_ref().map_or("neither axis is rpm".into(), |name| format!("{name} varies")))]
    NoSpeed(Option<String>),
    /// A speed is given, but the speed is the number that varies.
    #[error("--rpm R is the speed at which other numbers vary: leave it out where rpm is an axis")]
    TwoSpeeds,
    /// The machine is impossible.
    #[error(transparent)]
    Family(#[from] FamilyError),
}

/// Speed, rpm, of a survey over the numbers `free`. If the speed varies, `rpm` must not be given, and the result is a placeholder.
pub(super) fn speed(free: &[Parameter], rpm: Option<f64>) -> Result<f64, OverError> {
    /// Placeholder: if the speed varies, each machine has its own.
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
    /// Builds the machines of `model` over a number, at `rpm`, which must be given if that number is not the speed.
    pub fn new(model: &'a Model, parameter: Parameter, rpm: Option<f64>) -> Result<Self, OverError> {
        let free = vec![parameter.clone()];
        let rpm = speed(&free, rpm)?;
        let family = Family::new(model, rpm, free)?;
        Ok(Self { model, parameter, family, rpm })
    }

    /// Builds the machines of `model` over its speed.
    pub fn speed(model: &'a Model) -> Result<Self, OverError> {
        Self::new(model, Parameter::Speed, None)
    }

    /// Returns an uncertainty among the plausible machines at a value, where the number that varies is exact; none if the machines are
    /// exact. `machines` are plausible in place of the model's own.
    pub(crate) fn uncertain_at<T>(
        &self,
        machines: &PlausibleMachines<'_>,
        value: f64,
        of: impl FnOnce(&PlausibleMachines<'_>) -> Option<T>,
    ) -> Result<Option<T>, FamilyError> {
        let Some(machines) = machines.uncertain() else { return Ok(None) };
        if self.is_speed() {
            return Ok(of(machines));
        }
        let (model, cam) = self.model(value)?;
        let here = machines.elsewhere(self.parameter.name(), &model, &cam)?;
        Ok(here.uncertain().and_then(of))
    }

    /// Builds the machines of another model, on its cam, over this number.
    pub(crate) fn elsewhere<'b>(&self, model: &'b Model, cam: &Cam) -> Over<'b> {
        let (parameter, rpm) = (self.parameter.clone(), self.rpm);
        let machine = Machine::new(cam.clone(), &model.follower, angular_velocity(rpm));
        Over { model, family: Family::of(model, &machine, rpm, vec![parameter.clone()]), parameter, rpm }
    }

    /// Whether the speed varies.
    pub fn is_speed(&self) -> bool {
        self.parameter == Parameter::Speed
    }

    /// Machine with a value of the number.
    pub fn machine(&self, value: f64) -> Result<Machine, FamilyError> {
        Ok(self.family.machine(&[value])?.0)
    }

    /// Model with a value of the number, and its cam.
    pub fn model(&self, value: f64) -> Result<(Model, Cam), FamilyError> {
        let (model, machine) = (self.family.model(&[value])?, self.machine(value)?);
        Ok((model, machine.cam().clone()))
    }

    /// Describes the number that varies, with values of this spacing.
    pub fn varied(&self, spacing: Spacing) -> VariedNumber {
        let name = self.parameter.name();
        let rpm = (!self.is_speed()).then_some(self.rpm);
        VariedNumber { name: name.into(), unit: self.model.units.of_number(name), rpm, spacing }
    }

    /// Place of a value.
    pub fn place(&self, value: f64) -> Place {
        self.parameter.place(value, self.rpm)
    }
}
