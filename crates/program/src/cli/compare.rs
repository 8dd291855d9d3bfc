//! `corner-impact compare [A] [B]`.

use std::path::PathBuf;

use super::external::ExternalArguments;
use super::model::{Changes, TABLES};
use super::picture::ends_in;
use super::{AnswerArguments, CommandError, Exit, ModelArgument, Session, progress::watched};
use corner_impact::study::compare::compare;

/// Lists what differs between the results of two models.
///
/// The verdicts come first. Then come the numbers that changed, each with its change in multiples of its error.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact compare --set restitution=0.7\n\
    \x20 corner-impact compare models/damped-light.toml models/damped-heavy.toml --no-external\n\
    \x20 corner-impact compare models/osorio-2008.toml --set mass=1.3 --no-external --json\n\
    \n\
    Results are in the units of A. B must have the same unit of length. A model without a corner impact is no error.\n\
    Exit code: 0 done, whatever changed, 1 routes disagree about one of the models, 2 bad usage or model file.")]
pub(super) struct Arguments {
    /// Model file (TOML) [default: the paper's model, osorio-2008, which is built in].
    #[arg(value_name = "A")]
    first: Option<PathBuf>,
    /// Model file that is compared with A [default: A, with the numbers of --set].
    #[arg(value_name = "B", required_unless_present = "numbers")]
    second: Option<PathBuf>,
    /// Changes of the second model.
    #[command(flatten)]
    changes: Changes,
    #[command(flatten)]
    external: ExternalArguments,
    #[command(flatten)]
    answer: AnswerArguments,
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    // A table of lifts has no follower.
    let is_table = arguments.first.as_deref().is_some_and(|file| ends_in(file, &TABLES));
    let changes = if is_table && arguments.second.is_some() { &arguments.changes } else { &Changes::default() };
    let a = ModelArgument::of(arguments.first.as_deref(), changes).read_as_drawn(session)?;
    let b = match &arguments.second {
        Some(file) => ModelArgument::of(Some(file), &arguments.changes).read_as_drawn(session)?,
        None => arguments.changes.of(&a)?,
    };
    session.units = a.units.clone();
    let found = watched("the first model", |watch| compare(&a, &b, arguments.external.routes(), watch))?;
    session.answer(&found, &arguments.answer)?;
    Ok(if found.agrees() { Exit::Agrees } else { Exit::Disagrees })
}
