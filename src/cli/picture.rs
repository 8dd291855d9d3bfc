//! Figures to files: the name says whether SVG or PNG.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::CommandError;
use crate::report::figure::{Figure, png, svg};
use crate::report::file::Output;

/// The kinds of picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Svg,
    Png,
}

/// Pixels across of a PNG: a page's width at 300 dots an inch.
const PNG_WIDTH: u32 = 2000;

/// The kind that a file name asks for.
pub(super) fn kind(path: &Path) -> Option<Kind> {
    let extension = path.extension()?.to_str()?;
    match extension {
        _ if extension.eq_ignore_ascii_case("svg") => Some(Kind::Svg),
        _ if extension.eq_ignore_ascii_case("png") => Some(Kind::Png),
        _ => None,
    }
}

/// A file name of a picture, for clap.
pub(super) fn picture(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    if kind(&path).is_some() { Ok(path) } else { Err("must end in .svg or .png".into()) }
}

/// Writes `figure` to `path`, whole or not at all.
pub(super) fn draw(figure: &Figure, path: &Path, out: &mut dyn Write) -> Result<(), CommandError> {
    let report = |error: &dyn std::fmt::Display| CommandError::Report(error.to_string());
    let bytes = match kind(path) {
        Some(Kind::Png) => png::render(figure, PNG_WIDTH).map_err(|error| report(&error))?,
        _ => svg::render(figure).map_err(|error| report(&error))?.into_bytes(),
    };
    let mut file = Output::create(path, out).map_err(CommandError::file)?;
    file.write_all(&bytes).map_err(CommandError::write)?;
    file.commit().map_err(CommandError::file)
}
