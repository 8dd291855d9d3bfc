//! `corner-impact cam MODEL`.

use std::io::Write;
use std::path::PathBuf;

use super::{CommandError, Exit, picture};
use crate::cam::{Cam, Jet};
use crate::model::Model;
use crate::report::figures::cam_figure;
use crate::report::{CamDocument, json};

/// Lists the segments of a model's cam and the corners where they meet.
#[derive(clap::Args)]
#[command(after_help = "Examples: corner-impact cam models/osorio-2008.toml\n\
    \x20         corner-impact cam models/osorio-2008.toml --out cam.svg\n\n\
    Exit code: 0 done, 2 bad model file, usage or file.")]
pub(super) struct Arguments {
    /// Model file (TOML).
    model: PathBuf,
    /// Print one JSON document instead of the page.
    #[arg(long)]
    json: bool,
    /// Leave out corners where only a derivative above this order jumps.
    #[arg(long, value_name = "N", default_value_t = Jet::HIGHEST_JUMP)]
    order: usize,
    /// Draw lift, velocity and acceleration against the cam angle (.svg or .png).
    #[arg(long, value_name = "FILE", value_parser = picture::picture)]
    out: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<(String, Exit), CommandError> {
    let model = Model::read(&arguments.model).map_err(CommandError::input)?;
    let cam = Cam::new(&model).map_err(CommandError::input)?;
    if let Some(path) = &arguments.out {
        let drawn = picture::Canvas::create(path, out)?.draw(&cam_figure(&cam, &model.name))?;
        drawn.commit().map_err(CommandError::file)?;
    }
    let document = CamDocument::new(&model, &cam, arguments.order);
    let page = if arguments.json {
        json::render(&document).map_err(CommandError::report)?
    } else {
        document.text().map_err(CommandError::report)?
    };
    Ok((page, Exit::Agrees))
}
