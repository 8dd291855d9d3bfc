//! Machines that differ in a few numbers, along which a branch of orbits is followed.

use crate::cam::Cam;
use crate::model::{Model, ModelError, Units};
use crate::simulate::{Machine, angular_velocity};

/// A number that may be varied.
#[derive(Clone, Debug, PartialEq)]
pub enum Parameter {
    /// The speed of the cam, rpm.
    Speed,
    /// A field of the model file, by dotted path.
    Field(String),
}

/// Reason why there is no machine with these numbers.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the message says what each number is")]
pub enum FamilyError {
    /// The model does not allow the numbers.
    #[error("{0}")]
    Model(#[from] ModelError),
    /// The cam would not turn.
    #[error("{rpm} rpm: {ABOVE_0}")]
    Speed { rpm: f64 },
    /// The cam would have another number of segments, since a segment would lose its width, or gain one.
    #[error("the cam would have {found} segments instead of {own}")]
    Segments { own: usize, found: usize },
}

const ABOVE_0: &str = "the speed must be a finite number above 0";

impl FamilyError {
    /// The rule that is broken, without the number that breaks it.
    pub fn rule(&self) -> String {
        match self {
            Self::Model(error) => error.rule(),
            Self::Speed { .. } => ABOVE_0.into(),
            Self::Segments { own, .. } => format!("must leave the cam its {own} segments"),
        }
    }
}

impl Parameter {
    /// Finds the parameter with a name: `rpm`, a dotted path, or an end of a path that no other field shares.
    pub fn named(model: &Model, name: &str) -> Result<Self, FamilyError> {
        if name == "rpm" {
            return Ok(Self::Speed);
        }
        Ok(Self::Field(model.path_of(name, &["rpm"])?.into()))
    }

    /// Name in tables and messages.
    pub fn name(&self) -> &str {
        match self {
            Self::Speed => "rpm",
            Self::Field(path) => path,
        }
    }

    /// Value in `model` turning at `rpm`.
    pub fn value(&self, model: &Model, rpm: f64) -> Option<f64> {
        match self {
            Self::Speed => Some(rpm),
            Self::Field(path) => model.numbers().find(|(name, _)| name == path).map(|(_, value)| value),
        }
    }
}

/// The machines of one model, at one speed, with some numbers free.
#[derive(Clone, Debug)]
pub struct Family {
    model: Model,
    machine: Machine,
    rpm: f64,
    free: Vec<Parameter>,
}

impl Family {
    /// Builds the family of `model` at `rpm`, with the numbers `free` to be chosen.
    pub fn new(model: &Model, rpm: f64, free: Vec<Parameter>) -> Result<Self, FamilyError> {
        let machine = Machine::new(Cam::new(model)?, &model.follower, speed(rpm)?);
        Ok(Self { model: model.clone(), machine, rpm, free })
    }

    /// Builds the family of `model` at `rpm`, with the numbers `free` to be chosen; `machine` is the model's own.
    pub(crate) fn of(model: &Model, machine: &Machine, rpm: f64, free: Vec<Parameter>) -> Self {
        Self { model: model.clone(), machine: machine.clone(), rpm, free }
    }

    /// Units of the model.
    pub(crate) fn units(&self) -> &Units {
        &self.model.units
    }

    /// The machine with these values of the free numbers, and its speed, rpm.
    pub fn machine(&self, values: &[f64]) -> Result<(Machine, f64), FamilyError> {
        let (rpm, model) = self.changed(values)?;
        let omega = speed(rpm)?;
        let machine = match model {
            None => self.machine.at_speed(omega),
            Some(model) if model.cam == self.model.cam => {
                Machine::new(self.machine.cam().clone(), &model.follower, omega)
            }
            Some(model) => Machine::new(Cam::new(&model)?, &model.follower, omega),
        };
        Ok((machine, rpm))
    }

    /// The model with these values of the free numbers.
    pub fn model(&self, values: &[f64]) -> Result<Model, FamilyError> {
        Ok(self.changed(values)?.1.unwrap_or_else(|| self.model.clone()))
    }

    /// Speed, rpm, and model with these values of the free numbers. The model is `None` if only the speed is free.
    fn changed(&self, values: &[f64]) -> Result<(f64, Option<Model>), FamilyError> {
        let (mut rpm, mut model) = (self.rpm, None);
        for (parameter, value) in self.free.iter().zip(values) {
            match parameter {
                Parameter::Speed => rpm = *value,
                Parameter::Field(path) => {
                    model = Some(model.as_ref().unwrap_or(&self.model).with_number(path, *value)?);
                }
            }
        }
        Ok((rpm, model))
    }

    /// Machine with these values of the free numbers, and its speed, rpm. Fails if the cam has another number of segments, since cycles
    /// name segments by index.
    pub fn machine_of_cycles(&self, values: &[f64]) -> Result<(Machine, f64), FamilyError> {
        let (machine, rpm) = self.machine(values)?;
        match [&self.machine, &machine].map(|machine| machine.cam().segments().len()) {
            [own, found] if own != found => Err(FamilyError::Segments { own, found }),
            _ => Ok((machine, rpm)),
        }
    }
}

fn speed(rpm: f64) -> Result<f64, FamilyError> {
    if rpm > 0.0 && rpm.is_finite() { Ok(angular_velocity(rpm)) } else { Err(FamilyError::Speed { rpm }) }
}
