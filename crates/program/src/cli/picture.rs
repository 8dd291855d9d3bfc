//! Figures as files: the name determines SVG, PNG or PDF, and options the appearance on paper.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::ValueEnum;

use super::CommandError;
use super::numbers::range;
use crate::show::csv;
use crate::show::matplotlib::matplotlib;
use corner_impact::file::{self, Output};
use corner_impact::model::Units;
use corner_impact::untrusted;
use corner_impact_plot::font::Fonts;
use corner_impact_plot::layout::WIDTH;
use corner_impact_plot::look::length;
use corner_impact_plot::{Figure, LegendPlace, Look, Theme, TitleChoice, pdf, png, svg};

/// Heading of these options in `--help`.
const LOOKS: &str = "How a picture looks";

/// Options for the size and the letters of a picture.
#[derive(clap::Args)]
pub(super) struct LookArguments {
    /// Width on paper, such as 85mm, 8.5cm, 3.35in or 240pt [default: 169mm on paper; an SVG fills its place on a page].
    #[arg(long, value_name = "WIDTH", value_parser = length, requires = "picture", help_heading = LOOKS)]
    width: Option<f64>,
    /// Height of the letters on paper, such as 8pt [default: 8.3pt at a width of 169mm, in proportion at others].
    #[arg(long, value_name = "SIZE", value_parser = length, requires = "picture", help_heading = LOOKS)]
    size: Option<f64>,
    /// Font of the letters: an installed font, or a font file (.ttf, .otf). The picture contains the letters [default: the program's own font].
    #[arg(long, value_name = "FONT", requires = "picture", help_heading = LOOKS)]
    font: Option<String>,
    /// Write a title above the figure: TEXT, or the figure's own [default: the figure's own; none with --width].
    #[arg(long, value_name = "TEXT", num_args = 0..=1, require_equals = true, default_missing_value = "", requires = "picture", help_heading = LOOKS)]
    title: Option<String>,
    /// Leave out the title.
    #[arg(long, conflicts_with = "title", requires = "picture", help_heading = LOOKS)]
    no_title: bool,
    /// Place of the legend: none, above (each frame), below (the figure) or right (of it) [default: above].
    #[arg(long, value_name = "PLACE", value_parser = LegendPlace::named, requires = "picture", help_heading = LOOKS)]
    legend: Option<LegendPlace>,
    /// Colours for a screen that may be dark, or for white paper. PNG and PDF are always white.
    #[arg(long, value_enum, value_name = "THEME", requires = "picture", help_heading = LOOKS)]
    theme: Option<ThemeName>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum ThemeName {
    Screen,
    Print,
}

/// Options for the size of a picture, the part of it that is shown, and the files beside it.
#[derive(clap::Args)]
pub(super) struct PictureArguments {
    #[command(flatten)]
    look: LookArguments,
    /// Height on paper, such as 60mm [default: the height that the panels need].
    #[arg(long, value_name = "HEIGHT", value_parser = length, requires = "picture", help_heading = LOOKS)]
    height: Option<f64>,
    /// Ends of the horizontal axis, in its unit.
    #[arg(long, value_name = "LO:HI", value_parser = range, allow_hyphen_values = true, requires = "picture", help_heading = LOOKS)]
    x_range: Option<[f64; 2]>,
    /// Ends of the vertical axis, in its unit. Of several panels, only the first changes.
    #[arg(long, value_name = "LO:HI", value_parser = range, allow_hyphen_values = true, requires = "picture", help_heading = LOOKS)]
    y_range: Option<[f64; 2]>,
    /// Write a Python script that draws the same figure with matplotlib. Its data go to a file of the same name that ends in .csv.
    #[arg(long, value_name = "FILE", value_parser = script, requires = "picture", help_heading = LOOKS)]
    script: Option<PathBuf>,
    /// Open the file after writing it.
    #[arg(long, requires = "picture", help_heading = LOOKS)]
    open: bool,
}

/// Requested look, and the files beside the picture.
#[derive(Clone, Default)]
pub(super) struct PictureRequest {
    look: Option<Look>,
    script: Option<PathBuf>,
}

impl PictureRequest {
    /// Width of the page in units of the letters.
    pub(super) fn across(&self) -> f64 {
        self.look.as_ref().map_or(WIDTH, Look::across)
    }

    /// Names of the files beside the picture, each with its option.
    pub(super) fn files(&self) -> Option<[(&'static str, PathBuf); 2]> {
        let script = self.script.as_ref()?;
        Some([("--script", script.clone()), ("the data of --script", data(script))])
    }
}

impl LookArguments {
    /// Returns the look, before the work for the picture; `None` if no option sets it.
    pub(super) fn look(&self) -> Result<Option<Look>, CommandError> {
        let Self { width, size, font, title, no_title, legend, theme } = self;
        let is_plain = width.is_none() && size.is_none() && font.is_none() && legend.is_none() && theme.is_none();
        if is_plain && title.is_none() && !no_title {
            return Ok(None);
        }
        let fonts = font.as_deref().map(fonts).transpose()?;
        let theme = match theme {
            Some(ThemeName::Print) => Theme::Print,
            Some(ThemeName::Screen) | None => Theme::Screen,
        };
        let title = match title.as_deref() {
            None if *no_title => TitleChoice::Hidden,
            None => TitleChoice::OffPaper,
            Some("") => TitleChoice::Shown,
            Some(words) => TitleChoice::Words(words.into()),
        };
        let legend = legend.unwrap_or_default();
        let look = Look { width: *width, size: *size, fonts, theme, title, legend, ..Look::default() };
        Ok(Some(look.checked()?))
    }
}

impl PictureArguments {
    /// Returns the look with the ranges of the axes, and the files beside the picture.
    pub(super) fn request(&self) -> Result<PictureRequest, CommandError> {
        let (look, script) = (self.look.look()?, self.script.clone());
        if self.x_range.is_none() && self.y_range.is_none() && self.height.is_none() {
            return Ok(PictureRequest { look, script });
        }
        let look = Look { x: self.x_range, y: self.y_range, height: self.height, ..look.unwrap_or_default() };
        Ok(PictureRequest { look: Some(look.checked()?), script })
    }
}

/// Largest file of a font, bytes.
const LARGEST_FONT: usize = 64 << 20;

/// Loads an installed font, or a font file.
fn fonts(name: &str) -> Result<Fonts, CommandError> {
    if !Fonts::is_file(name) {
        return Ok(Fonts::named(name)?);
    }
    let read = file::bytes(Path::new(name), LARGEST_FONT);
    let data = read.map_err(|error| CommandError::Words(format!("{name}: cannot be read as a font: {error}")))?;
    Ok(Fonts::of_file(name, data)?)
}

/// Parses the file name of a script, for clap.
fn script(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    if ends_in(&path, &["py"]) { Ok(path) } else { Err("must end in .py".into()) }
}

/// Name of the data file of a script.
fn data(script: &Path) -> PathBuf {
    script.with_extension("csv")
}

/// Kind of picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Svg,
    Png,
    Pdf,
}

const KINDS: [(&str, Kind); 3] = [("svg", Kind::Svg), ("png", Kind::Png), ("pdf", Kind::Pdf)];

/// Whether a file name ends in one of some extensions, in upper or lower case.
pub(super) fn ends_in(path: &Path, extensions: &[&str]) -> bool {
    path.extension().is_some_and(|extension| extensions.iter().any(|known| extension.eq_ignore_ascii_case(known)))
}

/// Kind of picture of a file name.
pub(super) fn kind(path: &Path) -> Option<Kind> {
    KINDS.into_iter().find(|(name, _)| ends_in(path, &[name])).map(|(_, kind)| kind)
}

/// Parses the file name of a picture, for clap.
pub(super) fn picture(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    if kind(&path).is_some() { Ok(path) } else { Err("must end in .svg, .png or .pdf".into()) }
}

/// Parses the file name of a picture or a table, for clap. Devices and pipes may have any name; a name with the ending of an unsupported
/// kind of picture is rejected for a table.
pub(super) fn picture_or_table(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    if path.extension().is_none() || ends_in(&path, &["csv"]) || kind(&path).is_some() {
        Ok(path)
    } else {
        Err("must end in .csv, .svg, .png or .pdf, or be -".into())
    }
}

/// Files of a figure, all or none of which are written; opened before the work for the figure.
pub(super) struct Canvas {
    file: Output<'static>,
    kind: Kind,
    look: Look,
    /// Script and its data, and the name of the data file.
    script: Option<([Output<'static>; 2], String)>,
}

impl Canvas {
    /// Begins to write `path`, whose name is that of a picture, and the requested files beside it.
    pub(super) fn create(path: &Path, request: PictureRequest) -> Result<Self, CommandError> {
        let beside = request.files();
        let all = [("--out", path)].into_iter();
        file::distinct(all.chain(beside.iter().flatten().map(|(option, path)| (*option, path.as_path()))))?;
        let mut look = request.look.unwrap_or_default();
        // A file must have the same letters on every machine.
        look.fonts.get_or_insert_default();
        let script = beside.map(|[(_, script), (_, data)]| -> Result<_, CommandError> {
            let name = data.file_name().unwrap_or_default().to_string_lossy().into_owned();
            Ok(([Output::file(&script)?, Output::file(&data)?], name))
        });
        Ok(Self { file: Output::file(path)?, kind: kind(path).unwrap_or(Kind::Svg), look, script: script.transpose()? })
    }

    /// Writes the figure with the units of a model into files that do not have their names yet.
    pub(super) fn draw(mut self, figure: Figure, units: &Units) -> Result<Vec<Output<'static>>, CommandError> {
        let mut figure = figure.in_units(|unit| units.spelled(unit));
        figure.title = untrusted::visible(&figure.title).into_owned();
        let (look, figure) = (&self.look, self.look.framed(figure)?);
        let mut files = Vec::new();
        if let Some(([mut script, mut data], name)) = self.script {
            script.write_all(matplotlib(&figure, look, &name).as_bytes())?;
            data.write_all(csv::figure(&figure).as_bytes())?;
            files.extend([script, data]);
        }
        let bytes = match self.kind {
            Kind::Png => png::render(figure, look, look.pixels())?,
            Kind::Svg => untrusted::visible(&svg::render(&figure, look)?).as_bytes().to_vec(),
            Kind::Pdf => pdf::render(&figure, look)?,
        };
        self.file.write_all(&bytes)?;
        files.push(self.file);
        Ok(files)
    }

    /// Writes the figure with the units of a model, and gives the files their names.
    pub(super) fn write(self, figure: Figure, units: &Units) -> Result<(), CommandError> {
        Ok(Output::commit_all(self.draw(figure, units)?)?)
    }
}

/// Destination of a table or a picture, by its name; opened before the work.
pub(super) enum Target<'a> {
    Table(Output<'a>),
    Picture(Box<Canvas>),
}

impl<'a> Target<'a> {
    /// Begins to write `path`; `-` is a table on `standard`.
    pub(super) fn create(
        path: &Path,
        standard: &'a mut dyn Write,
        request: PictureRequest,
    ) -> Result<Self, CommandError> {
        Ok(match kind(path) {
            Some(_) => Self::Picture(Box::new(Canvas::create(path, request)?)),
            None if request.look.is_some() || request.script.is_some() => {
                let words = "--width, --height, --size, --font, --title, --no-title, --legend, --theme, --x-range, --y-range and --script are for \
                             pictures: --out must end in .svg, .png or .pdf";
                return Err(CommandError::Words(words.into()));
            }
            None => Self::Table(Output::create(path, standard)?),
        })
    }

    /// Writes the table or the picture in the units of a model, and gives the files their names.
    pub(super) fn fill(
        self,
        units: &Units,
        table: impl FnOnce() -> String,
        figure: impl FnOnce() -> Result<Figure, CommandError>,
    ) -> Result<(), CommandError> {
        let files = match self {
            Self::Table(mut file) => {
                file.write_all(table().as_bytes())?;
                vec![file]
            }
            Self::Picture(canvas) => canvas.draw(figure()?, units)?,
        };
        Ok(Output::commit_all(files)?)
    }
}

/// Destination of a command that prints its table unless a document is requested; `None` if only the document is printed.
pub(super) fn table(out: Option<&PathBuf>, json: bool) -> Result<Option<&Path>, CommandError> {
    out_is_standard(out, json)?;
    let standard = (!json).then_some(Path::new("-"));
    Ok(out.map(PathBuf::as_path).or(standard))
}

/// Whether a name denotes standard output.
pub(super) fn is_standard(path: Option<&PathBuf>) -> bool {
    path.is_some_and(|path| path.as_os_str() == "-")
}

/// Whether `--out` is standard output, which then leaves no room for a document.
pub(super) fn out_is_standard(out: Option<&PathBuf>, json: bool) -> Result<bool, CommandError> {
    let standard = is_standard(out);
    if standard && json {
        return Err(CommandError::Words("--out - and --json both print to standard output".into()));
    }
    Ok(standard)
}
