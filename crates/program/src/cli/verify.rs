//! `corner-impact verify [MODEL]`.

use super::external::ExternalArguments;
use super::{AnswerArguments, CommandError, Exit, ModelArgument, Session, progress::watched};
use corner_impact::cam::Cam;
use corner_impact::study::verify::verify_watched;

/// Computes the map at a corner impact by every route.
///
/// Begins with the corner impact of the model. Ends with whether the routes agree.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact verify\n\
    \x20 corner-impact verify models/damped-light.toml --no-external\n\
    \x20 corner-impact verify models/osorio-2008.toml --json\n\
    \n\
    Exit code: 0 everything agrees, 1 something disagrees, 2 bad model file or no corner impact to verify.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    #[command(flatten)]
    answer: AnswerArguments,
    #[command(flatten)]
    external: ExternalArguments,
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read(session)?;
    if !Cam::new(&model)?.corners().iter().any(|corner| corner.jump_order <= 2) {
        let words = "the acceleration of this cam jumps nowhere, so there is no corner impact to verify; `cam`, `design`, `simulate` and `speeds` \
                     take every cam";
        return Err(CommandError::Words(format!("{}: {words}", model.file())));
    }
    let findings =
        watched("looking for the corner impact", |watch| verify_watched(&model, arguments.external.routes(), watch))?;
    for failure in findings.skipped.iter().filter(|skipped| skipped.failed) {
        // The page contains the same message.
        session.complain(&format!("{} did not run: {}", failure.route, failure.why));
    }
    session.answer(&findings, &arguments.answer)?;
    Ok(if findings.agrees { Exit::Agrees } else { Exit::Disagrees })
}
