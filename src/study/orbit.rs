//! Which periodic orbits there are at one speed.

use serde::Serialize;

use super::{StudyError, machine};
use crate::flight::State;
use crate::known::Complete;
use crate::model::Model;
use crate::orbit::settle::near;
use crate::orbit::{PeriodicOrbit, Search, search};

/// The periodic orbits of a model at a speed: the document of `orbit --json`.
#[derive(Clone, Debug, Serialize)]
pub struct Orbits {
    schema: &'static str,
    /// The model's name.
    pub model: String,
    /// rpm.
    pub speed_rpm: f64,
    /// The cam angle at which their states are, rad.
    pub section_angle_rad: f64,
    /// For which numbers of impacts the list is all there is.
    pub complete: Vec<Complete>,
    /// Those that were found.
    pub orbits: Vec<PeriodicOrbit>,
}

/// What is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wanted {
    /// Whatever a search finds.
    All(Search),
    /// The orbit of so many revolutions that Newton's method finds from a state at cam angle 0.
    Near(State, u64),
}

/// Looks for the periodic orbits of a model at `speed_rpm`.
pub fn orbits(model: &Model, speed_rpm: f64, wanted: Wanted) -> Result<Orbits, StudyError> {
    let machine = machine(model, speed_rpm)?;
    let complete = match &wanted {
        Wanted::All(wanted) => wanted.complete().into_iter().collect(),
        Wanted::Near(..) => Vec::new(),
    };
    let orbits = match wanted {
        Wanted::All(wanted) => search(&machine, &wanted)?,
        Wanted::Near(state, revolutions) => near(&machine, 0.0, state, revolutions)?.into_iter().collect(),
    };
    let schema = "corner-impact/orbit/1";
    Ok(Orbits { schema, model: model.name.clone(), speed_rpm, section_angle_rad: 0.0, complete, orbits })
}
