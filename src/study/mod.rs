//! One module per question that a user can ask.

pub mod basins;
pub mod cam;
pub mod locate;
pub mod speeds;
pub mod verify;

use serde::Serialize;

use crate::model::Model;

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
