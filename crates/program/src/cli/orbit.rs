//! `corner-impact orbit [MODEL] --rpm R`.

use super::numbers::rpm;
use super::start::state;
use super::{AnswerArguments, CommandError, Exit, ModelArgument, Session, progress::watched};
use corner_impact::flight::State;
use corner_impact::orbit::Search;
use corner_impact::study::orbit::{OrbitQuery, orbits};

/// Finds periodic orbits at one speed, with their multipliers.
///
/// The orbits may be stable or unstable.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact orbit --rpm 680\n\
    \x20 corner-impact orbit models/osorio-2008.toml --rpm 745 --revolutions 2 --json\n\
    \n\
    The list of orbits of one impact, and of two in one revolution, is proved to be complete, except for impacts at the angles that \
    the page names. Other orbits come from a search from many starts, which may miss some.\n\
    Exit code: 0 done, also if there is no orbit, 2 bad model file or usage.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Speed of the cam, rpm.
    #[arg(long, value_name = "R", value_parser = rpm, allow_hyphen_values = true)]
    rpm: f64,
    /// Revolutions of the cam in one period.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=Search::MOST_REVOLUTIONS))]
    revolutions: u64,
    /// Impacts in one period [default: any number].
    #[arg(long, value_name = "M")]
    impacts: Option<usize>,
    /// Find only the orbit to which Newton's method converges from this state at cam angle 0: position and velocity, in the model's units.
    #[arg(long, value_name = "Q,V", value_parser = state, allow_hyphen_values = true, conflicts_with = "impacts")]
    guess: Option<State>,
    #[command(flatten)]
    answer: AnswerArguments,
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read(session)?;
    let wanted = match arguments.guess {
        Some(state) => OrbitQuery::Near(state, arguments.revolutions),
        None => OrbitQuery::All(Search { revolutions: arguments.revolutions, impacts: arguments.impacts }),
    };
    let found = watched("looking for periodic orbits", |watch| orbits(&model, arguments.rpm, wanted, watch))?;
    session.answer(&found, &arguments.answer)
}
