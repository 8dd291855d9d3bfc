//! The values of one number that meet a need, for each value of another number.

use rayon::prelude::*;
use serde::Serialize;

use super::contact::Contact;
use super::needs::{self, Answer, Changed, Lever, Need, UncertainMachine};
use crate::cam::Cam;
use crate::known::Evidence;
use crate::model::Model;
use crate::progress::Watch;
use crate::study::StudyError;
use crate::study::survey::Axis;
use crate::uncertainty::{PlausibleMachines, SourcedUncertainty, UncertaintyParts};

/// The value of one number that meets a need, at one value of another number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RequiredPair {
    /// Value of the given number.
    pub given: f64,
    /// Value of the number that is found.
    pub found: Option<f64>,
    /// Uncertainty of `found`.
    pub error: Option<SourcedUncertainty>,
    /// Limit on the other side, if there is one.
    pub other: Option<f64>,
    /// Uncertainty of `other`.
    pub other_error: Option<SourcedUncertainty>,
    /// A tried value beyond `other` that meets the need again.
    pub again: Option<f64>,
}

document!(RequiredPair as it {
    given: it.given,
    found: it.found,
    error if_any: it.error.map(|error| error.total()),
    other if_any: it.other,
    other_error if_any: it.other_error.map(|error| error.total()),
    again if_any: it.again,
    error_parts if_any: it.error.map(|error| UncertaintyParts(error, "")),
    other_error_parts if_any: it.other_error.map(|error| UncertaintyParts(error, "")),
});

impl RequiredPair {
    /// The range that the uncertainty of `found` leaves.
    pub fn found_bounds(&self) -> Option<[f64; 2]> {
        Some(self.error?.around(self.found?))
    }

    /// The range that the uncertainty of `other` leaves.
    pub fn other_bounds(&self) -> Option<[f64; 2]> {
        Some(self.other_error?.around(self.other?))
    }

    /// The answer at a given value. For a number with an upper bound, the least value that will do comes first; it is 0 if no lower limit
    /// was found.
    fn of(given: f64, answer: &Answer) -> Self {
        let Answer { value, error, other, other_error, again, .. } = *answer;
        match answer.is_upper_bound && !answer.lever.is_upper_bound() {
            true => {
                let found = Some(other.unwrap_or(0.0));
                Self { given, found, error: other_error, other: value, other_error: error, again }
            }
            false => Self { given, found: value, error, other, other_error, again },
        }
    }
}

/// The values of one number that meet a need, for each value of another number.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Trade {
    /// The need, in the user's words.
    pub need: String,
    /// The number that is found.
    pub parameter: Lever,
    /// Unit of the found number.
    pub unit: String,
    /// Name of the given number, without its table.
    pub against: String,
    /// Unit of the given number.
    pub against_unit: String,
    /// Pairs of a given and a found value; the found value is none if no value meets the need.
    pub pairs: Vec<RequiredPair>,
    /// Evidence for the values, as for the need alone.
    pub known: Evidence,
}

/// Finds the value of each lever that meets each need, at each value of another number. `uncertain` is the uncertainty of the model's own
/// machine. Its part of a measured cam is used at all values.
pub(super) fn trades(
    machines: &PlausibleMachines<'_>,
    uncertain: &UncertainMachine<'_>,
    needs: &[(String, Need)],
    against: &Axis,
    watch: &dyn Watch,
) -> Result<Vec<Trade>, StudyError> {
    let (path, units) = (against.parameter.name(), &machines.model.units);
    let own_name = path.rsplit('.').next().unwrap_or(path);
    let mut trades = Vec::new();
    for (text, need) in needs {
        for parameter in Lever::ALL.into_iter().filter(|lever| lever.path() != path) {
            watch.at(&format!("the {parameter} against the {own_name} for \"{text}\""), 0, 0);
            let pair = |given: &f64| -> Result<RequiredPair, StudyError> {
                let (model, cam) = given_machine(machines, path, *given)?;
                let contact = Contact::new(&cam, model.follower);
                // The part of the cam is in `uncertain`.
                let here = machines.uncertain().map(|_| PlausibleMachines::of_numbers(&model, &cam, model.errors));
                let uncertain = UncertainMachine { machines: here.as_ref(), ..*uncertain };
                let changed = Changed::new(&model, &contact).keeping_rest_of(machines.model);
                let answer = needs::answer(&changed, (need, text), parameter, &uncertain)?;
                Ok(RequiredPair::of(*given, &answer))
            };
            let pairs = against.values.par_iter().map(pair).collect::<Result<_, _>>()?;
            let (unit, known) = (units.of_number(&parameter.path()), need.known());
            let (against, against_unit) = (own_name.to_owned(), units.of_number(path));
            trades.push(Trade { need: text.clone(), parameter, unit, against, against_unit, pairs, known });
        }
    }
    Ok(trades)
}

/// The model with another number at `path`, in the unit of its file, and its cam. A preload may be given to a model without one.
fn given_machine(machines: &PlausibleMachines<'_>, path: &str, value: f64) -> Result<(Model, Cam), StudyError> {
    let (model, cam) = (machines.model, machines.cam);
    if path == Lever::Preload.path() && model.preload.is_none() {
        let preload = model.units.of_follower("preload").map_or(value, |unit| unit.inside(value));
        return Ok((model.preloaded(cam.lowest().value, preload), cam.clone()));
    }
    let given = model.with_number(path, value)?;
    let cam = if given.cam == model.cam { cam.clone() } else { Cam::new(&given)? };
    Ok((given, cam))
}
