//! `corner-impact verify MODEL`.

use std::io::Write;
use std::path::PathBuf;

use super::{CommandError, Exit};
use crate::model::Model;
use crate::report::{Verification, json, text};
use crate::verify::{External, verify};

/// Finds the corner impact of a model, computes its map by every route, and says whether they agree.
#[derive(clap::Args)]
#[command(after_help = "Example: corner-impact verify models/osorio-2008.toml\n\n\
    Exit code: 0 everything agrees, 1 something disagrees, 2 bad model file or no corner impact to verify.")]
pub(super) struct Arguments {
    /// Model file (TOML).
    model: PathBuf,
    /// Print one JSON document instead of the page.
    #[arg(long)]
    json: bool,
    /// Leave out the routes that need Python (symbolic, scipy), and say so.
    #[arg(long)]
    no_external: bool,
}

pub(super) fn run(arguments: &Arguments, err: &mut dyn Write) -> Result<(String, Exit), CommandError> {
    let input = |error: &dyn std::fmt::Display| CommandError::Input(error.to_string());
    let model = Model::read(&arguments.model).map_err(|error| input(&error))?;
    let external = if arguments.no_external { External::LeftOut } else { External::Run };
    let findings = verify(&model, external).map_err(|error| input(&error))?;
    for failure in findings.skipped.iter().filter(|skipped| skipped.failed) {
        // A closed pipe leaves nobody to tell; the page says the same.
        let _ = writeln!(err, "error: {} did not run: {}", failure.route, failure.why);
    }
    let document = Verification::new(&model, &findings);
    let page = if arguments.json {
        json::render(&document).map_err(|error| CommandError::Report(error.to_string()))?
    } else {
        text::render(&document).map_err(|error| CommandError::Report(error.to_string()))?
    };
    Ok((page, if document.agrees { Exit::Agrees } else { Exit::Disagrees }))
}
