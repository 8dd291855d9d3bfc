//! Standard deviations of the follower's numbers: `mass = { value = 0.11, error = 0.005 }`.

use serde::{Serialize, Serializer};

use super::fields::{Field, Fields, Value};
use super::quantity::{Allowed, ModelNumber};
use super::units::Units;
use super::{Model, ModelError};

/// Standard deviations of the follower's numbers, in internal units; 0 for an exact number. The errors are independent of each other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FollowerErrors([f64; Self::COUNT]);

/// Shifts of the follower's numbers as multiples of their standard deviations, in the order of [`FollowerErrors::names`].
pub(crate) type Moves = [f64; FollowerErrors::COUNT];

impl FollowerErrors {
    /// Number of the follower's quantities that may have an error.
    pub const COUNT: usize = 7;
    /// Name of the entry that gives an error.
    const ERROR: &str = "error";
    /// Largest error of a number that must not reach 0, relative to its value.
    const MOST: f64 = 0.5;

    /// Reads the errors of the numbers in a model file.
    pub(super) fn read(fields: &mut Fields, units: &Units) -> Result<Self, ModelError> {
        let mut errors = Self::default();
        for (error, name) in errors.0.iter_mut().zip(Self::names()) {
            let path = format!("follower.{name}.{}", Self::ERROR);
            if fields.has(&path) {
                let written = fields.number_within(&path, Allowed::NOT_NEGATIVE)?;
                *error = units.of_follower(name).map_or(written, |unit| unit.inside(written));
                if !error.is_finite() {
                    return Err(fields.reject(&path, "is too large"));
                }
            }
        }
        Ok(errors)
    }

    /// Rejects an error that includes impossible values: ± is two standard deviations, and a mass or a stiffness must not reach 0.
    pub(super) fn check(self, fields: &mut Fields) -> Result<(), ModelError> {
        for (name, _) in self.uncertain() {
            let (number, path) = (format!("follower.{name}"), format!("follower.{name}.{}", Self::ERROR));
            let [value, error] = [fields.number(&number)?, fields.number(&path)?];
            let most = match name {
                "mass" | "stiffness" => Self::MOST * value,
                "restitution" => Self::MOST,
                _ => f64::INFINITY,
            };
            if error > most {
                let words = match name {
                    "restitution" => format!("must be {most} or less: a coefficient of restitution is from 0 to 1"),
                    _ => format!("must be {most} or less, half of the value: ± is twice the error, and would reach 0"),
                };
                return Err(fields.reject(&path, words));
            }
        }
        Ok(())
    }

    /// Names of the numbers in their table, in the order of [`Self::all`].
    pub fn names() -> impl Iterator<Item = &'static str> {
        ModelNumber::of_follower()
    }

    /// Standard deviations of all numbers, 0 for an exact number.
    pub fn all(self) -> [f64; Self::COUNT] {
        self.0
    }

    /// Returns the errors with the number at a dotted path made exact.
    pub fn without(self, path: &str) -> Self {
        let name = path.strip_prefix("follower.");
        self.kept(|index| name != Self::names().nth(index))
    }

    /// Returns the larger error of two machines for each number.
    pub(crate) fn or(self, other: Self) -> Self {
        Self(std::array::from_fn(|index| self.0[index].max(other.0[index])))
    }

    /// Keeps the errors of the numbers at some indices and makes the others exact.
    pub(crate) fn kept(self, is_kept: impl Fn(usize) -> bool) -> Self {
        Self(std::array::from_fn(|index| if is_kept(index) { self.0[index] } else { 0.0 }))
    }

    /// Numbers that are not exact, each with its standard deviation.
    pub fn uncertain(self) -> impl Iterator<Item = (&'static str, f64)> {
        Self::names().zip(self.0).filter(|(_, error)| *error > 0.0)
    }

    /// Returns the errors, or `None` if every number is exact.
    pub fn if_any(self) -> Option<Self> {
        (!self.are_none()).then_some(self)
    }

    /// Whether every number is exact.
    pub fn are_none(&self) -> bool {
        self.0.iter().all(|error| *error == 0.0)
    }

    /// Moves a number of the follower from `value` by `by`, within its allowed range. A number that must not be 0 keeps a tenth of its
    /// value.
    pub(crate) fn moved(name: &str, value: f64, by: f64) -> f64 {
        const KEPT: f64 = 0.1;
        let allowed = ModelNumber::of(&format!("follower.{name}")).map_or(Allowed::FINITE, |number| number.allowed);
        let least = if matches!(name, "mass" | "stiffness") { KEPT * value } else { f64::NEG_INFINITY };
        allowed.nearest(value + by).max(least)
    }
}

/// Serializes as the names of the numbers that are not exact.
impl Serialize for FollowerErrors {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(self.uncertain().map(|(name, _)| name))
    }
}

impl Model {
    /// Number of the follower by its name, in internal units; `None` if the model has none.
    pub(crate) fn of_follower(&self, name: &str) -> Option<f64> {
        self.clone().of_follower_mut(name).copied()
    }

    /// Number of the follower by its name, for a change.
    pub(crate) fn of_follower_mut(&mut self, name: &str) -> Option<&mut f64> {
        let follower = &mut self.follower;
        match name {
            "mass" => Some(&mut follower.mass),
            "damping" => Some(&mut follower.damping),
            "stiffness" => Some(&mut follower.stiffness),
            "gravity" => Some(&mut follower.gravity),
            "restitution" => Some(&mut follower.restitution),
            "preload" => self.preload.as_mut(),
            "rest_position" => Some(&mut follower.rest_position).filter(|_| self.preload.is_none()),
            _ => None,
        }
    }
}

impl Fields {
    /// Path of a number's error.
    pub(super) fn error_of(path: &str) -> String {
        format!("{path}.{}", FollowerErrors::ERROR)
    }

    /// Whether a path belongs to an error and not to a number of the machine.
    pub(super) fn is_error(path: &str) -> bool {
        path.strip_suffix(FollowerErrors::ERROR).is_some_and(|head| head.ends_with('.'))
    }

    /// Path of the number to which an error belongs; `error` is the path of the error.
    pub(super) fn number_of(error: &str) -> Option<&str> {
        error.strip_suffix(FollowerErrors::ERROR)?.strip_suffix('.')
    }

    /// Splits `{ value = ..., error = ... }`: the value becomes the number at `path`, and its error stays beside it.
    pub(super) fn part_error(&mut self, path: &str) -> Result<(), ModelError> {
        let [value, error] = [format!("{path}.value"), Self::error_of(path)];
        // Any other table is not a number.
        if !self.is_table(path) || !(self.has(&value) || self.has(&error)) {
            return Ok(());
        }
        self.present(&value)?;
        self.present(&error)?;
        if let Some(field) = self.fields.remove(&*value) {
            self.fields.insert(path.into(), field);
        }
        Ok(())
    }

    /// Makes a number exact.
    pub(super) fn drop_error(&mut self, path: &str) {
        self.fields.remove(&*Self::error_of(path));
    }

    /// Error of the number at `path`, in the unit of the file; `None` for an exact number.
    pub(super) fn error_at(&self, path: &str) -> Option<f64> {
        match self.fields.get(&*Self::error_of(path)) {
            Some(Field { value: Value::Number(error), .. }) if *error > 0.0 => Some(*error),
            _ => None,
        }
    }
}
