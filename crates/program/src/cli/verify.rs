//! `corner-impact verify [MODEL]`.

use super::{CommandError, Exit, ModelArgument, Session, progress::watched};
use corner_impact::study::verify::{External, verify_watched};

/// Finds the corner impact of a model, computes its map by every route, and says whether they agree.
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
    /// Print one JSON document instead of the page.
    #[arg(long)]
    json: bool,
    /// Leave out the routes that need Python (symbolic, scipy, certificate), and say so.
    #[arg(long)]
    no_external: bool,
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read(session)?;
    let external = if arguments.no_external { External::LeftOut } else { External::Run };
    let findings = watched("", |watch| verify_watched(&model, external, watch))?;
    for failure in findings.skipped.iter().filter(|skipped| skipped.failed) {
        // The page says the same.
        session.complain(&format!("{} did not run: {}", failure.route, failure.why));
    }
    session.answer(&findings, arguments.json)?;
    Ok(if findings.agrees { Exit::Agrees } else { Exit::Disagrees })
}
