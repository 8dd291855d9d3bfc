//! One module per question that a user can ask.

pub mod basins;
pub mod cam;
pub mod compared;
pub mod locate;
pub mod orbit;
pub mod speeds;
pub mod verify;

use serde::Serialize;

use crate::model::{Model, ModelError};
use crate::orbit::OrbitError;
use crate::simulate::SimulateError;

/// Which model a finding is about.
#[derive(Clone, Debug, Serialize)]
pub struct ModelLabel {
    /// Its name.
    pub name: String,
    /// Where its numbers come from.
    pub source: String,
}

impl ModelLabel {
    pub(crate) fn of(model: &Model) -> Self {
        Self { name: model.name.clone(), source: model.source.clone() }
    }
}

/// Why a question has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StudyError {
    /// The model is impossible.
    #[error("{0}")]
    Model(#[from] ModelError),
    /// A run could not go on.
    #[error("{0}")]
    Simulate(#[from] SimulateError),
    /// An orbit could not be found or followed.
    #[error("{0}")]
    Orbit(#[from] OrbitError),
    /// No starts were named, and the machine has none of its own.
    #[error("no range to put starts in: give --position and --velocity")]
    NoStarts,
}
