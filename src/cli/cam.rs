//! `corner-impact cam MODEL`.

use std::path::PathBuf;

use super::{CommandError, Exit};
use crate::cam::{Cam, Jet};
use crate::model::Model;
use crate::report::{CamDocument, json};

/// Lists the segments of a model's cam and the corners where they meet.
#[derive(clap::Args)]
#[command(after_help = "Example: corner-impact cam models/osorio-2008.toml\n\n\
    Exit code: 0 done, 2 bad model file.")]
pub(super) struct Arguments {
    /// Model file (TOML).
    model: PathBuf,
    /// Print one JSON document instead of the page.
    #[arg(long)]
    json: bool,
    /// Leave out corners where only a derivative above this order jumps.
    #[arg(long, value_name = "N", default_value_t = Jet::HIGHEST_JUMP)]
    order: usize,
}

pub(super) fn run(arguments: &Arguments) -> Result<(String, Exit), CommandError> {
    let input = |error: &dyn std::fmt::Display| CommandError::Input(error.to_string());
    let report = |error: &dyn std::fmt::Display| CommandError::Report(error.to_string());
    let model = Model::read(&arguments.model).map_err(|error| input(&error))?;
    let cam = Cam::new(&model).map_err(|error| input(&error))?;
    let document = CamDocument::new(&model, &cam, arguments.order);
    let page = if arguments.json {
        json::render(&document).map_err(|error| report(&error))?
    } else {
        document.text().map_err(|error| report(&error))?
    };
    Ok((page, Exit::Agrees))
}
