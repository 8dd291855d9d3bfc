//! Figures to files: the name says whether SVG or PNG.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::CommandError;
use crate::draw::{Figure, png, svg};
use crate::file::Output;

/// The kinds of picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Svg,
    Png,
}

/// Pixels across of a PNG: a page's width at 300 dots an inch.
const PNG_WIDTH: u32 = 2000;

/// Whether a file name ends in one of some extensions, in either case.
pub(super) fn ends_in(path: &Path, extensions: &[&str]) -> bool {
    path.extension().is_some_and(|extension| extensions.iter().any(|known| extension.eq_ignore_ascii_case(known)))
}

/// The kind that a file name asks for.
pub(super) fn kind(path: &Path) -> Option<Kind> {
    [("svg", Kind::Svg), ("png", Kind::Png)].into_iter().find(|(name, _)| ends_in(path, &[name])).map(|(_, kind)| kind)
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
    if path.extension().is_none() || ends_in(&path, &["csv", "svg", "png"]) {
        Ok(path)
    } else {
        Err("must end in .csv, .svg or .png, or be -".into())
    }
}

/// A file that a figure goes to, whole or not at all; opened before the work that the figure shows.
pub(super) struct Canvas {
    file: Output<'static>,
    kind: Kind,
}

impl Canvas {
    /// Begins to write `path`, which names a kind of picture.
    pub(super) fn create(path: &Path) -> Result<Self, CommandError> {
        Ok(Self { file: Output::file(path)?, kind: kind(path).unwrap_or(Kind::Svg) })
    }

    /// The figure, written but not yet a file of that name.
    pub(super) fn draw(mut self, figure: &Figure) -> Result<Output<'static>, CommandError> {
        let bytes = match self.kind {
            Kind::Png => png::render(figure, PNG_WIDTH)?,
            Kind::Svg => svg::render(figure)?.into_bytes(),
        };
        self.file.write_all(&bytes)?;
        Ok(self.file)
    }
}

/// Where a table or a picture goes, as its name says; opened before the work.
pub(super) enum Target<'a> {
    Table(Output<'a>),
    Picture(Canvas),
}

impl<'a> Target<'a> {
    /// Begins to write `path`; `-` is a table on `standard`.
    pub(super) fn create(path: &Path, standard: &'a mut dyn Write) -> Result<Self, CommandError> {
        Ok(match kind(path) {
            Some(_) => Self::Picture(Canvas::create(path)?),
            None => Self::Table(Output::create(path, standard)?),
        })
    }

    /// Writes the one or the other, and gives the file its name.
    pub(super) fn fill(
        self,
        table: impl FnOnce(&mut dyn Write) -> Result<(), CommandError>,
        figure: impl FnOnce() -> Result<Figure, CommandError>,
    ) -> Result<(), CommandError> {
        let file = match self {
            Self::Table(mut file) => table(&mut file).map(|()| file)?,
            Self::Picture(canvas) => canvas.draw(&figure()?)?,
        };
        super::commit(vec![file])
    }
}

/// Whether a name stands for standard output.
pub(super) fn is_standard(path: Option<&PathBuf>) -> bool {
    path.is_some_and(|path| path.as_os_str() == "-")
}

/// Whether `--out` is standard output, which then has no room for a summary.
pub(super) fn out_is_standard(out: Option<&PathBuf>, summary: bool) -> Result<bool, CommandError> {
    let standard = is_standard(out);
    if standard && summary {
        return Err(CommandError::Words("--out - and --summary both print to standard output".into()));
    }
    Ok(standard)
}
