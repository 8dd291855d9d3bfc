//! `corner-impact speeds [MODEL]`.

use super::start::rpm_range;
use super::{CommandError, Exit, ModelArgument, Session, progress::watched};
use crate::study::speeds::{Care, regimes, usual_speeds};

/// Tells at which speeds the follower leaves the cam, chatters, bounces regularly, is chaotic, and where hysteresis is.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n\
    \x20 corner-impact speeds\n\
    \x20 corner-impact speeds models/osorio-2008.toml --rpm 600:800 --speeds 100\n\
    \n\
    Speeds are run through upwards and downwards; changes between them are narrowed down and, where a branch of orbits explains them, located. Narrow ranges between two of the speeds that are run may be missing: --speeds looks closer.\n\
    Exit code: 0 done, 2 bad model file, usage, or a run that cannot go on.")]
pub(super) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    /// Lowest and highest speed [default: up to the end of the model's [study], or 1000 rpm, from a twentieth of that].
    #[arg(long, value_name = "LO:HI", value_parser = rpm_range, allow_hyphen_values = true)]
    rpm: Option<[f64; 2]>,
    /// Speeds that are run.
    #[arg(long, value_name = "N", default_value_t = 300, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    speeds: u32,
    /// Revolutions at each speed before anything is decided.
    #[arg(long, value_name = "N", default_value_t = 400)]
    settling: u64,
    /// Print one JSON document instead of the page.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    let model = arguments.model.read(session)?;
    let rpm = arguments.rpm.unwrap_or_else(|| usual_speeds(&model));
    let care = Care { speeds: arguments.speeds as usize, settling: arguments.settling, ..Care::default() };
    let found = watched("", |watch| regimes(&model, rpm, care, watch))?;
    session.answer(&found, arguments.json)
}
