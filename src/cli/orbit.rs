//! `corner-impact orbit [MODEL] --rpm R`.

use super::start::{rpm, state, turn};
use super::{CommandError, Exit, ModelArgument, Session, progress::Progress};
use crate::cam::Cam;
use crate::flight::State;
use crate::orbit::search::near;
use crate::orbit::{Search, search};
use crate::pages::OrbitDocument;
use crate::simulate::{Machine, angular_velocity};

/// Finds periodic orbits at one speed, stable and unstable, with their multipliers.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact orbit --rpm 680\n\
    \x20 corner-impact orbit models/osorio-2008.toml --rpm 745 --revolutions 2 --json\n\
    \n\
    One-impact orbits are found one and all; those of more impacts by a search from many starts, which may miss some.\n\
    Exit code: 0 done, also where there is none, 2 bad model file or usage.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Speed of the cam.
    #[arg(long, value_name = "R", value_parser = rpm, allow_hyphen_values = true)]
    rpm: f64,
    /// Turns of the cam in one period.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=Search::MOST_REVOLUTIONS))]
    revolutions: u64,
    /// Impacts in one period [default: any number].
    #[arg(long, value_name = "M")]
    impacts: Option<usize>,
    /// Only the orbit that Newton's method finds from this state at cam angle 0, m and m/s.
    #[arg(long, value_name = "Q,V", value_parser = state, allow_hyphen_values = true, conflicts_with = "impacts")]
    guess: Option<State>,
    /// Print one JSON document instead of the page.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read(session)?;
    let cam = Cam::new(&model)?;
    let machine = Machine::new(cam, &model.follower, angular_velocity(arguments.rpm));
    let progress = Progress::spinner("looking for periodic orbits");
    let orbits = match arguments.guess {
        Some(state) => {
            let found = near(&machine, turn(0.0), state, arguments.revolutions)?;
            found.into_iter().collect()
        }
        None => {
            let wanted = Search { revolutions: arguments.revolutions, impacts: arguments.impacts };
            search(&machine, &wanted)?
        }
    };
    drop(progress);
    let document = OrbitDocument::new(&model.name, arguments.rpm, &orbits);
    session.answer(&document, arguments.json, |width| document.page(width))?;
    Ok(Exit::Agrees)
}
