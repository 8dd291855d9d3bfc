//! Figures to files: the name says whether SVG, PNG or PDF, and options how they stand on paper.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::ValueEnum;

use super::CommandError;
use super::numbers::{positive, range};
use corner_impact::file::{self, Output};
use corner_impact::model::Units;
use corner_impact::untrusted;
use corner_impact_plot::font::Fonts;
use corner_impact_plot::{Figure, Look, Theme, pdf, png, svg};

/// The heading of these options in `--help`.
const LOOKS: &str = "How a picture looks";

/// How a picture stands on paper.
#[derive(clap::Args)]
pub(super) struct LookArguments {
    /// Width on paper, such as 85mm, 8.5cm, 3.35in or 240pt [default: that of what an SVG stands in, 169mm on paper].
    #[arg(long, value_name = "WIDTH", value_parser = length, requires = "picture", help_heading = LOOKS)]
    width: Option<f64>,
    /// Height of the letters on paper, such as 8pt [default: 8.3pt in a figure 169mm wide, and in proportion].
    #[arg(long, value_name = "SIZE", value_parser = length, requires = "picture", help_heading = LOOKS)]
    size: Option<f64>,
    /// The letters: a font that is installed, or the file of one (.ttf, .otf); they come with the picture [default: the program's own].
    #[arg(long, value_name = "FONT", requires = "picture", help_heading = LOOKS)]
    font: Option<String>,
    /// Leave out the title.
    #[arg(long, requires = "picture", help_heading = LOOKS)]
    no_title: bool,
    /// Open the file once it is written.
    #[arg(long, requires = "picture", help_heading = LOOKS)]
    open: bool,
    /// A screen that may be dark, or white paper; PNG and PDF are white on both.
    #[arg(long, value_enum, value_name = "THEME", requires = "picture", help_heading = LOOKS)]
    theme: Option<ThemeName>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum ThemeName {
    Screen,
    Print,
}

/// How a picture stands on paper, and which part of it is shown.
#[derive(clap::Args)]
pub(super) struct PictureArguments {
    #[command(flatten)]
    look: LookArguments,
    /// Ends of the horizontal axis, in its unit.
    #[arg(long, value_name = "LO:HI", value_parser = range, allow_hyphen_values = true, requires = "picture", help_heading = LOOKS)]
    x_range: Option<[f64; 2]>,
    /// Ends of the vertical axis, in its unit: of the first panel, where there are more; the others keep theirs.
    #[arg(long, value_name = "LO:HI", value_parser = range, allow_hyphen_values = true, requires = "picture", help_heading = LOOKS)]
    y_range: Option<[f64; 2]>,
}

impl LookArguments {
    /// The look, found before the work that the picture shows; none where nothing is asked for.
    pub(super) fn look(&self) -> Result<Option<Look>, CommandError> {
        let Self { width, size, font, no_title, theme, .. } = self;
        if width.is_none() && size.is_none() && font.is_none() && !no_title && theme.is_none() {
            return Ok(None);
        }
        let fonts = font.as_deref().map(fonts).transpose()?;
        let theme = match theme {
            Some(ThemeName::Print) => Theme::Print,
            Some(ThemeName::Screen) | None => Theme::Screen,
        };
        let look = Look { width: *width, size: *size, fonts, theme, untitled: *no_title, ..Look::default() };
        Ok(Some(look.checked()?))
    }
}

impl PictureArguments {
    /// The look, with the part that is shown; none where nothing is asked for.
    pub(super) fn look(&self) -> Result<Option<Look>, CommandError> {
        let look = self.look.look()?;
        if self.x_range.is_none() && self.y_range.is_none() {
            return Ok(look);
        }
        Ok(Some(Look { x: self.x_range, y: self.y_range, ..look.unwrap_or_default() }))
    }
}

/// Largest file of a font, bytes.
const LARGEST_FONT: usize = 64 << 20;

/// The letters of a font that is installed, or of a file.
fn fonts(name: &str) -> Result<Fonts, CommandError> {
    if !Fonts::is_file(name) {
        return Ok(Fonts::named(name)?);
    }
    let read = file::bytes(Path::new(name), LARGEST_FONT);
    let data = read.map_err(|error| CommandError::Words(format!("{name}: cannot be read as a font: {error}")))?;
    Ok(Fonts::of_file(name, data)?)
}

/// A length on paper as points, 72 to the inch.
fn length(text: &str) -> Result<f64, String> {
    const UNITS: [(&str, f64); 4] = [("mm", 72.0 / 25.4), ("cm", 720.0 / 25.4), ("in", 72.0), ("pt", 1.0)];
    let found = UNITS.iter().find_map(|(unit, points)| Some((text.trim().strip_suffix(unit)?, points)));
    let (number, points) = found.ok_or("must be a number with its unit: 85mm, 8.5cm, 3.35in or 240pt")?;
    Ok(positive(number)? * points)
}

/// The kinds of picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Svg,
    Png,
    Pdf,
}

const KINDS: [(&str, Kind); 3] = [("svg", Kind::Svg), ("png", Kind::Png), ("pdf", Kind::Pdf)];

/// Whether a file name ends in one of some extensions, in either case.
pub(super) fn ends_in(path: &Path, extensions: &[&str]) -> bool {
    path.extension().is_some_and(|extension| extensions.iter().any(|known| extension.eq_ignore_ascii_case(known)))
}

/// The kind that a file name asks for.
pub(super) fn kind(path: &Path) -> Option<Kind> {
    KINDS.into_iter().find(|(name, _)| ends_in(path, &[name])).map(|(_, kind)| kind)
}

/// A file name of a picture, for clap.
pub(super) fn picture(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    if kind(&path).is_some() { Ok(path) } else { Err("must end in .svg, .png or .pdf".into()) }
}

/// A file name of a picture or a table, for clap. Devices and pipes have names of any kind; what ends like another kind of
/// picture is not to hold a table.
pub(super) fn picture_or_table(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    if path.extension().is_none() || ends_in(&path, &["csv"]) || kind(&path).is_some() {
        Ok(path)
    } else {
        Err("must end in .csv, .svg, .png or .pdf, or be -".into())
    }
}

/// A file that a figure goes to, whole or not at all; opened before the work that the figure shows.
pub(super) struct Canvas {
    file: Output<'static>,
    kind: Kind,
    look: Look,
}

impl Canvas {
    /// Begins to write `path`, which names a kind of picture.
    pub(super) fn create(path: &Path, look: Option<Look>) -> Result<Self, CommandError> {
        let mut look = look.unwrap_or_default();
        // A file is to have the same letters wherever it is looked at.
        look.fonts.get_or_insert_default();
        Ok(Self { file: Output::file(path)?, kind: kind(path).unwrap_or(Kind::Svg), look })
    }

    /// The figure with the units of a model, written but not yet a file of that name.
    pub(super) fn draw(mut self, figure: Figure, units: &Units) -> Result<Output<'static>, CommandError> {
        let mut figure = figure.in_units(|unit| units.spelled(unit));
        figure.title = untrusted::visible(&figure.title).into_owned();
        let (look, figure) = (&self.look, self.look.framed(figure)?);
        let bytes = match self.kind {
            Kind::Png => png::render(figure, look, look.pixels())?,
            Kind::Svg => untrusted::visible(&svg::render(&figure, look)?).as_bytes().to_vec(),
            Kind::Pdf => pdf::render(&figure, look)?,
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
    pub(super) fn create(path: &Path, standard: &'a mut dyn Write, look: Option<Look>) -> Result<Self, CommandError> {
        Ok(match kind(path) {
            Some(_) => Self::Picture(Canvas::create(path, look)?),
            None if look.is_some() => {
                let words = "--width, --size, --font, --no-title, --theme, --x-range and --y-range are of pictures: the name must end in .svg, .png or .pdf";
                return Err(CommandError::Words(words.into()));
            }
            None => Self::Table(Output::create(path, standard)?),
        })
    }

    /// Writes the one or the other in the units of a model, and gives the file its name.
    pub(super) fn fill(
        self,
        units: &Units,
        table: impl FnOnce() -> String,
        figure: impl FnOnce() -> Result<Figure, CommandError>,
    ) -> Result<(), CommandError> {
        let file = match self {
            Self::Table(mut file) => {
                file.write_all(table().as_bytes())?;
                file
            }
            Self::Picture(canvas) => canvas.draw(figure()?, units)?,
        };
        Ok(file.commit()?)
    }
}

/// Where a command writes that prints its table unless a document is asked for; none if the document is all.
pub(super) fn table(out: Option<&PathBuf>, json: bool) -> Result<Option<&Path>, CommandError> {
    out_is_standard(out, json)?;
    let standard = (!json).then_some(Path::new("-"));
    Ok(out.map(PathBuf::as_path).or(standard))
}

/// Whether a name stands for standard output.
pub(super) fn is_standard(path: Option<&PathBuf>) -> bool {
    path.is_some_and(|path| path.as_os_str() == "-")
}

/// Whether `--out` is standard output, which then has no room for a document.
pub(super) fn out_is_standard(out: Option<&PathBuf>, json: bool) -> Result<bool, CommandError> {
    let standard = is_standard(out);
    if standard && json {
        return Err(CommandError::Words("--out - and --json both print to standard output".into()));
    }
    Ok(standard)
}
