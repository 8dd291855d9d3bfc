//! `corner-impact speeds MODEL`.

use std::path::PathBuf;
use std::sync::Mutex;

use super::start::range;
use super::{CommandError, Exit, progress::Progress};
use crate::model::Model;
use crate::regime::{Care, regimes};
use crate::report::{RegimesDocument, json};

/// Tells at which speeds the follower leaves the cam, chatters, bounces regularly, is chaotic, and where hysteresis is.
#[derive(clap::Args)]
#[command(after_help = "Example: corner-impact speeds models/osorio-2008.toml --rpm 50:800\n\n\
    Speeds are run through upwards and downwards; changes between them are narrowed down and, where a branch of orbits\n\
    explains them, located. Narrow ranges between two of the speeds that are run may be missing: --speeds looks closer.\n\
    Exit code: 0 done, 2 bad model file, usage, or a run that cannot go on.")]
pub(super) struct Arguments {
    /// Model file (TOML).
    model: PathBuf,
    /// Lowest and highest speed [default: 50 rpm to the end of the model's [study], or 1000].
    #[arg(long, value_name = "LO:HI", value_parser = range, allow_hyphen_values = true)]
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

pub(super) fn run(arguments: &Arguments) -> Result<(String, Exit), CommandError> {
    let model = Model::read(&arguments.model).map_err(CommandError::input)?;
    let rpm = arguments.rpm.unwrap_or_else(|| [50.0, model.study.map_or(1000.0, |study| study.rpm_max.max(100.0))]);
    let care = Care { speeds: arguments.speeds as usize, settling: arguments.settling, ..Care::default() };
    let progress = Mutex::new((Progress::new(2 * u64::from(arguments.speeds)), 0));
    let passed = || {
        // A bar that a thread died over shows nothing more.
        if let Ok(mut guard) = progress.lock() {
            let (bar, done) = &mut *guard;
            *done += 1;
            bar.set(*done);
        }
    };
    let found = regimes(&model, rpm, care, &passed).map_err(CommandError::input)?;
    drop(progress);
    let document = RegimesDocument::new(&model.name, &found);
    let page = if arguments.json {
        json::render(&document).map_err(CommandError::report)?
    } else {
        document.text().map_err(CommandError::report)?
    };
    Ok((page, Exit::Agrees))
}
