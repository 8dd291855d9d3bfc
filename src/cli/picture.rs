//! Figures to files: the name says whether SVG or PNG.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::CommandError;
use crate::cli::file::Output;
use crate::draw::{Figure, png, svg};

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

/// A file name of a picture or a table, for clap. Devices and pipes have names of any kind; what ends like another kind of
/// picture is not to hold a table.
pub(super) fn picture_or_table(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let is_table = path.extension().is_none_or(|extension| extension.eq_ignore_ascii_case("csv"));
    if is_table || kind(&path).is_some() { Ok(path) } else { Err("must end in .csv, .svg or .png, or be -".into()) }
}

/// A file that a figure goes to, whole or not at all; opened before the work that the figure shows.
pub(super) struct Canvas<'a> {
    file: Output<'a>,
    kind: Kind,
}

impl<'a> Canvas<'a> {
    /// Begins to write `path`, which names a kind of picture; `nobody` stands for a standard output that is not meant.
    pub(super) fn create(path: &Path, nobody: &'a mut dyn Write) -> Result<Self, CommandError> {
        let file = Output::create(path, nobody).map_err(CommandError::file)?;
        Ok(Self { file, kind: kind(path).unwrap_or(Kind::Svg) })
    }

    /// The figure, written but not yet a file of that name.
    pub(super) fn draw(mut self, figure: &Figure) -> Result<Output<'a>, CommandError> {
        let bytes = match self.kind {
            Kind::Png => png::render(figure, PNG_WIDTH).map_err(CommandError::report)?,
            Kind::Svg => svg::render(figure).map_err(CommandError::report)?.into_bytes(),
        };
        self.file.write_all(&bytes).map_err(CommandError::write)?;
        Ok(self.file)
    }
}
