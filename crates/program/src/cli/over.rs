//! The axis that --rpm or --over names, and the one speed of a survey over another number.

use super::start::Rpm;
use super::{CommandError, ModelArgument};
use corner_impact::model::Model;
use corner_impact::orbit::Parameter;
use corner_impact::study::survey::{Axis, Values};

/// The one speed of a survey, where it has one, and what it goes over: the speed, or a number of the model.
pub(super) fn over(
    (argument, model): (&ModelArgument, &Model),
    rpm: Option<Rpm>,
    over: Option<&(String, Values)>,
) -> Result<(Option<f64>, Axis), CommandError> {
    match (rpm, over) {
        (Some(Rpm::Range(_)), Some((name, _))) => {
            Err(CommandError::Words(format!("--rpm LO:HI:N and --over {name}: one number varies, and chart has two")))
        }
        (Some(Rpm::Range(speeds)), None) => Ok((None, Axis::new(Parameter::Speed, &speeds))),
        (Some(Rpm::One(rpm)), None) => Err(CommandError::Words(format!(
            "--rpm {rpm} is one speed: LO:HI:N is from where to where and how many, or --over NAME=LO:HI:N is what varies"
        ))),
        (rpm, Some((name, values))) => {
            let rpm = if let Some(Rpm::One(rpm)) = rpm { Some(rpm) } else { None };
            Ok((rpm, Axis::new(argument.varied(model, name, "--over")?, values)))
        }
        (None, None) => Err(CommandError::Words("--rpm LO:HI:N, or --over NAME=LO:HI:N, says what varies".into())),
    }
}
