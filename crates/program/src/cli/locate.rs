//! `corner-impact locate [MODEL]`.

use super::numbers::rpm_range;
use super::{AnswerArguments, CommandError, Exit, ModelArgument, Session, progress::watched};
use corner_impact::model::Study;
use corner_impact::orbit::Search;
use corner_impact::study::locate::{LocateRangeError, locate};

/// Lists the speeds at which an orbit hits a corner of the cam.
///
/// Each speed has the map on both sides of the corner and the type of the bifurcation.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact locate --rpm 600:760\n\
    \x20 corner-impact locate models/osorio-2008.toml --rpm 600:760 --revolutions 2 --json\n\
    \n\
    Exit code: 0 the routes agree, 1 routes disagree at a corner impact, 2 bad model file or usage.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Range of speeds, rpm.
    #[arg(long, value_name = "LO:HI", value_parser = study)]
    rpm: Study,
    /// Revolutions of the cam after which the orbits first repeat.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=Search::MOST_REVOLUTIONS))]
    revolutions: u64,
    #[command(flatten)]
    answer: AnswerArguments,
}

/// Parses `LO:HI`.
fn study(text: &str) -> Result<Study, String> {
    rpm_range(text).map(|[rpm_min, rpm_max]| Study { rpm_min, rpm_max })
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read(session)?;
    let found = watched("looking for orbits with an impact on a corner", |watch| {
        locate(&model, arguments.rpm, arguments.revolutions, watch).map_err(|error| match error {
            LocateRangeError::Range(error) => CommandError::Words(format!("{}: {error}", model.file())),
            error => error.into(),
        })
    })?;
    session.answer(&found, &arguments.answer)?;
    Ok(if found.agrees { Exit::Agrees } else { Exit::Disagrees })
}
