//! Axis of a survey, and its fixed speed if the axis is another number.

use super::numbers::{NamedSpan, Span, Speeds};
use super::{CommandError, ModelArgument};
use corner_impact::model::Model;
use corner_impact::orbit::Parameter;
use corner_impact::study::StudyError;
use corner_impact::study::survey::Axis;

/// Checks a number of values that are run one by one.
pub(super) fn values(count: usize) -> Result<u32, CommandError> {
    let count = u32::try_from(count).ok().filter(|few| (2..=100_000).contains(few)).ok_or(count);
    count.map_err(|count| CommandError::Words(format!("{count} values: there must be 2 to 100000")))
}

/// Fixed speed of a survey, if any, and name and range of its axis: the speed, or a number of the model. The axis is `None` if no option
/// names it.
pub(super) fn varied(
    rpm: Option<Speeds>,
    over: Option<&NamedSpan>,
) -> Result<(Option<f64>, Option<NamedSpan>), CommandError> {
    match (rpm, over) {
        (Some(Speeds::Span(Span { ends: [low, high], .. })), Some(_)) => {
            Err(StudyError::RangeAndNumber { low, high }.into())
        }
        (Some(Speeds::Span(span)), None) => Ok((None, Some((Parameter::Speed.name().into(), span)))),
        (Some(Speeds::One(rpm)), None) => Err(CommandError::Words(format!(
            "--rpm {rpm} is one speed: give a range, --rpm LO:HI, or add --over NAME=LO:HI to vary a number at this speed; `basins` shows the attractors at one speed, and `simulate` one run"
        ))),
        (Some(Speeds::One(rpm)), Some(over)) => Ok((Some(rpm), Some(over.clone()))),
        (None, over) => Ok((None, over.cloned())),
    }
}

/// Speed and axis of a survey, with the values along the axis; their number is `usual` if none is given.
pub(super) fn over(
    (argument, model): (&ModelArgument, &Model),
    rpm: Option<Speeds>,
    over: Option<&NamedSpan>,
    usual: usize,
) -> Result<(Option<f64>, Axis), CommandError> {
    let (rpm, Some((name, span))) = varied(rpm, over)? else {
        return Err(CommandError::Words("nothing varies: give --rpm LO:HI or --over NAME=LO:HI".into()));
    };
    Ok((rpm, Axis::new(argument.varied(model, &name, "--over")?, &span.values(usual))))
}
