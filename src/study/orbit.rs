//! Which periodic orbits there are at one speed.

use serde::Serialize;

use super::{StudyError, machine};
use crate::flight::State;
use crate::known::Complete;
use crate::model::Model;
use crate::orbit::settle::near;
use crate::orbit::{PeriodicOrbit, Search, Searched, Undecided, search_all};
use crate::progress::Watch;

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
    /// Where orbits of these numbers of impacts may be missing.
    pub undecided: Vec<Undecided>,
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
pub fn orbits(model: &Model, speed_rpm: f64, wanted: Wanted, watch: &dyn Watch) -> Result<Orbits, StudyError> {
    let machine = machine(model, speed_rpm)?;
    let Searched { orbits, complete, undecided } = match wanted {
        Wanted::All(wanted) => search_all(&machine, &wanted, watch)?,
        Wanted::Near(state, revolutions) => {
            let orbits = near(&machine, 0.0, state, revolutions)?.into_iter().collect();
            Searched { orbits, complete: Vec::new(), undecided: Vec::new() }
        }
    };
    let (schema, model) = ("corner-impact/orbit/1", model.name.clone());
    Ok(Orbits { schema, model, speed_rpm, section_angle_rad: 0.0, complete, undecided, orbits })
}
