//! One module per question that a user can ask.

#[doc(hidden)]
pub mod attractors;
#[doc(hidden)]
pub mod basins;
#[doc(hidden)]
pub mod cam;
#[doc(hidden)]
pub mod certify;
#[doc(hidden)]
pub mod chaos;
#[doc(hidden)]
pub mod chart;
#[doc(hidden)]
pub mod compare;
#[doc(hidden)]
pub mod continuation;
#[doc(hidden)]
pub mod curve;
pub mod design;
#[doc(hidden)]
pub mod diagram;
#[doc(hidden)]
pub mod local;
pub mod locate;
pub mod orbit;
#[doc(hidden)]
pub mod routes;
pub mod simulate;
pub mod speeds;
pub mod survey;
#[doc(hidden)]
pub mod trapping;
pub mod verify;

use serde::Serialize;

use crate::cam::Cam;
use crate::model::{Model, ModelError};
use crate::orbit::branch::Following;
use crate::orbit::{FamilyError, OrbitError};
use crate::simulate::{Machine, SimulateError, angular_velocity};

/// Label of the model that a finding is about.
#[derive(Clone, Debug, Serialize)]
pub struct ModelLabel {
    /// Name of the model.
    pub name: String,
    /// Source of its numbers.
    pub source: String,
}

impl ModelLabel {
    pub(crate) fn of(model: &Model) -> Self {
        Self { name: model.name.clone(), source: model.source.clone() }
    }
}

/// Reason why a question has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the message says what each number is")]
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
    /// A number of the model cannot be changed.
    #[error("{0}")]
    Family(#[from] FamilyError),
    /// Corner impacts cannot be looked for.
    #[error(transparent)]
    Locate(#[from] locate::LocateRangeError),
    /// The matrices of two models are in different units of length.
    #[error(
        "lengths are in \"{a}\" in the one and in \"{b}\" in the other model: state both in one unit ([units], length)"
    )]
    Lengths { a: String, b: String },
    /// The value at which a search begins is outside the range to be followed.
    #[error("{file}: {name} = {value}, where the search for orbits starts, is outside of {}:{}: start elsewhere by --set {name}=VALUE, or by --rpm R if the speed varies", range[0], range[1])]
    Outside { file: String, name: String, value: f64, range: [f64; 2] },
    /// A search found no orbit.
    #[error("{file}: no periodic orbit of {revolutions} revolution(s) found at {rpm} rpm to follow")]
    NothingToFollow { file: String, revolutions: u64, rpm: f64 },
    /// The speed was to be followed, but a curve of events gives their speed.
    #[error("--over must be a number of the model: the speed of each event is the result")]
    SpeedFollowed,
    /// A run up to a number of impacts met no further impact.
    #[error(
        "simulate: no impact in {waited} revolutions after impact {impacts}; the cam is at {:.4} deg of revolution {revolution}",
        cam_angle.to_degrees()
    )]
    NoImpact { waited: u64, impacts: u64, cam_angle: f64, revolution: u64 },
    /// The number cannot be varied.
    #[error(transparent)]
    Over(#[from] survey::OverError),
    /// A range of speeds was given together with another number that varies.
    #[error(
        "--rpm {low}:{high} and --over are two ranges: with --over, --rpm is one speed; `chart` varies two numbers"
    )]
    RangeAndNumber {
        /// Lowest speed, rpm.
        low: f64,
        /// Highest speed, rpm.
        high: f64,
    },
    /// No speeds were given, and the machine has no range of its own.
    #[error(
        "no range of speeds: the follower leaves the cam at every speed or at none, and the model has no [study]; give --rpm"
    )]
    NoSpeeds,
    /// Starts cannot be run.
    #[error(transparent)]
    Basins(#[from] basins::GridError),
    /// No starts were given, and the machine has no range of its own.
    #[error("no range to put starts in: give --position and --velocity")]
    NoStarts,
}

/// Builds the machine of a model at a speed, rpm.
fn machine(model: &Model, rpm: f64) -> Result<Machine, ModelError> {
    Ok(Machine::new(Cam::new(model)?, &model.follower, angular_velocity(rpm)))
}

/// Returns the value at which the followed number begins. Fails if it is outside its range.
fn inside(model: &Model, rpm: f64, following: &Following) -> Result<f64, StudyError> {
    let Following { parameter, range, .. } = following;
    let value = parameter.value(model, rpm).unwrap_or(f64::NAN);
    if range[0] <= value && value <= range[1] {
        return Ok(value);
    }
    let (file, name) = (model.file().to_string(), parameter.name().to_owned());
    Err(StudyError::Outside { file, name, value, range: *range })
}

/// Hypotheses on the machine for proofs by intervals of doubles.
#[doc(hidden)]
pub fn hypotheses(cam: &Cam) -> Vec<&'static str> {
    let doubles = "the machine's numbers are the doubles taken from those of the model file";
    let meets = "adjacent segments of the lift join with the same lift and the same slope, as the model means it, except at corners where the \
                 velocity jumps";
    if cam.segments().len() > 1 { vec![doubles, meets] } else { vec![doubles] }
}
