//! `corner-impact claims MODEL`.

use std::path::PathBuf;

use super::{CommandError, Exit};
use crate::cam::Cam;
use crate::claims::{Context, hold};
use crate::model::Model;
use crate::report::{ClaimsDocument, json};
use crate::verify::{External, verify};

/// Prints what the paper states, statement by statement, with a verdict and its evidence.
#[derive(clap::Args)]
#[command(after_help = "Example: corner-impact claims models/osorio-2008.toml\n\n\
    For another model than the paper's, statements about the paper's own numbers are open.\n\
    Exit code: 0 every check comes to the ledger's verdict, 1 one does not, 2 bad model file.")]
pub(super) struct Arguments {
    /// Model file (TOML).
    model: PathBuf,
    /// Print one JSON document instead of the page.
    #[arg(long, conflicts_with = "markdown")]
    json: bool,
    /// Print the page of docs/claims.md.
    #[arg(long)]
    markdown: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<(String, Exit), CommandError> {
    let input = |error: &dyn std::fmt::Display| CommandError::Input(error.to_string());
    let report = |error: &dyn std::fmt::Display| CommandError::Report(error.to_string());
    let model = Model::read(&arguments.model).map_err(|error| input(&error))?;
    let findings = verify(&model, External::LeftOut).map_err(|error| input(&error))?;
    let cam = Cam::new(&model).map_err(|error| input(&error))?;
    let context = Context::new(&model, &cam, &findings).map_err(|error| report(&error))?;
    let document = ClaimsDocument::new(&model.name, &hold(&context).map_err(|error| report(&error))?);
    let page = match (arguments.json, arguments.markdown) {
        (true, _) => json::render(&document).map_err(|error| report(&error))?,
        (_, true) => document.markdown().map_err(|error| report(&error))?,
        _ => document.text().map_err(|error| report(&error))?,
    };
    Ok((page, if document.agrees { Exit::Agrees } else { Exit::Disagrees }))
}
