//! Appearance of a figure on paper or on a screen: its width, font, title and ranges of axes.

use super::Figure;
use super::font::Fonts;

/// Default width of the page, in units.
pub const WIDTH: f64 = 720.0;
/// Height of most letters, in units.
pub const TEXT: f64 = 12.5;
/// Default width of a figure, points, 72 to the inch: the width of a page between its margins.
pub const PAGE: f64 = 480.0;
/// Least and greatest width of the page, in units; a letter is [`TEXT`] high. A narrower page has no room beside its labels.
const ACROSS: [f64; 2] = [240.0, 4000.0];
/// Allowed widths of a figure, points: from a thumb to a poster.
const WIDTHS: [f64; 2] = [30.0, 2400.0];

/// Medium on which a figure is viewed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// Screen: an SVG is light or dark, like the reader's screen.
    #[default]
    Screen,
    /// White paper, on any screen.
    Print,
}

impl Theme {
    /// Returns the theme of this name.
    pub fn named(name: &str) -> Result<Self, String> {
        match name {
            "screen" => Ok(Self::Screen),
            "print" => Ok(Self::Print),
            _ => Err("must be screen or print".into()),
        }
    }
}

/// Place of the legend.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LegendPlace {
    /// No legend.
    None,
    /// Above each frame, the series of that frame.
    #[default]
    Above,
    /// Below the figure, all series.
    Below,
    /// Right of the frames, all series.
    Right,
}

impl LegendPlace {
    /// Returns the place of this name.
    pub fn named(name: &str) -> Result<Self, String> {
        match name {
            "none" => Ok(Self::None),
            "above" => Ok(Self::Above),
            "below" => Ok(Self::Below),
            "right" => Ok(Self::Right),
            _ => Err("must be none, above, below or right".into()),
        }
    }
}

/// Title above a figure.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum TitleChoice {
    /// Title of the figure, unless the figure has a width on paper: there the caption serves as title.
    #[default]
    OffPaper,
    /// Title of the figure.
    Shown,
    /// No title.
    Hidden,
    /// Given words.
    Words(String),
}

/// Reads a length on paper, such as `85mm`, in points, 72 to the inch.
pub fn length(text: &str) -> Result<f64, String> {
    const UNITS: [(&str, f64); 4] = [("mm", 72.0 / 25.4), ("cm", 720.0 / 25.4), ("in", 72.0), ("pt", 1.0)];
    let found = UNITS.iter().find_map(|(unit, points)| Some((text.trim().strip_suffix(unit)?, points)));
    let (number, points) = found.ok_or("must be a number with its unit: 85mm, 8.5cm, 3.35in or 240pt")?;
    let number = number.trim().parse::<f64>().ok().filter(|number| *number > 0.0 && number.is_finite());
    Ok(number.ok_or("must be a finite number above 0 with its unit")? * points)
}

/// Converts points to millimetres.
fn millimetres(points: f64) -> f64 {
    points * 25.4 / 72.0
}

/// Checks the ends of an axis: finite numbers, the lower first.
pub fn ends([low, high]: [f64; 2]) -> Result<[f64; 2], String> {
    let is_range = low.is_finite() && high.is_finite() && low < high;
    if is_range { Ok([low, high]) } else { Err("must be LO and HI, LO below HI".into()) }
}

/// Appearance of a figure.
#[derive(Clone, Debug, Default)]
pub struct Look {
    /// Width on paper, points; by default the width of the surrounding page, or of a page in print.
    pub width: Option<f64>,
    /// Height on paper, points; by default the height of the panels.
    pub height: Option<f64>,
    /// Height of letters on paper, points; by default as in a figure as wide as a page.
    pub size: Option<f64>,
    /// Fonts, which an SVG then embeds. By default an SVG uses the fonts of the surrounding page; a PNG and a PDF use the built-in
    /// font.
    pub fonts: Option<Fonts>,
    /// Medium on which the figure is viewed.
    pub theme: Theme,
    /// Title above the figure.
    pub title: TitleChoice,
    /// Place of the legend.
    pub legend: LegendPlace,
    /// Ends of the horizontal axis, instead of the figure's.
    pub x: Option<[f64; 2]>,
    /// Ends of the first panel's vertical axis, instead of the panel's.
    pub y: Option<[f64; 2]>,
}

/// Reason why a look is impossible.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LookError {
    /// Width outside the allowed range.
    #[error("a figure {:.1} mm wide cannot be made: the width must be {:.1} to {:.0} mm", millimetres(*.0), millimetres(WIDTHS[0]), millimetres(WIDTHS[1]))]
    Width(f64),
    /// Height without room for the panels and words, or different from the height of panels to scale.
    #[error(
        "this figure cannot be {:.1} mm high at a width of {:.1} mm: it needs {:.1} mm",
        millimetres(*height), millimetres(*width), millimetres(*needed)
    )]
    #[expect(missing_docs, reason = "what the words say")]
    Height { height: f64, width: f64, needed: f64 },
    /// Legend that leaves too little room for the frames.
    #[error("the legend leaves no room for the figure in a width of {:.1} mm: use --legend below or above", millimetres(*.0))]
    Legend(f64),
    /// Letters that leave no room, or that are too small to read.
    #[error("letters of {size:.2} pt do not fit into a figure {:.1} mm wide: the size must be {low:.2} to {high:.1} pt", millimetres(*width))]
    #[expect(missing_docs, reason = "what the words say")]
    Size { size: f64, width: f64, low: f64, high: f64 },
    /// Range without data.
    #[error("{axis} from {} to {} shows nothing: what is drawn lies from {} to {}", shown[0], shown[1], drawn[0] as f32, drawn[1] as f32)]
    #[expect(missing_docs, reason = "what the words say")]
    Aside { axis: &'static str, shown: [f64; 2], drawn: [f64; 2] },
    /// Range that shows too little of the data.
    #[error(
        "{axis} from {} to {} is less than a hundredth of what is drawn, from {} to {}: compute the figure over a narrower range",
        shown[0], shown[1], drawn[0] as f32, drawn[1] as f32
    )]
    #[expect(missing_docs, reason = "what the words say")]
    Narrow { axis: &'static str, shown: [f64; 2], drawn: [f64; 2] },
}

impl Look {
    /// Whether the look has a length on paper.
    pub(super) fn is_sized(&self) -> bool {
        self.width.is_some() || self.height.is_some() || self.size.is_some() || self.theme == Theme::Print
    }

    /// Title above the figure.
    pub(super) fn title<'a>(&'a self, figure: &'a Figure) -> &'a str {
        match &self.title {
            TitleChoice::OffPaper if self.width.is_some() => "",
            TitleChoice::OffPaper | TitleChoice::Shown => &figure.title,
            TitleChoice::Hidden => "",
            TitleChoice::Words(words) => words,
        }
    }

    /// Width on paper, points.
    pub fn points(&self) -> f64 {
        self.width.unwrap_or(PAGE)
    }

    /// Width of the page in units in which a letter is [`TEXT`] high.
    pub fn across(&self) -> f64 {
        // width : size = across : TEXT
        let across = self.size.map_or(WIDTH * self.points() / PAGE, |size| TEXT * self.points() / size);
        (100.0 * across).round() / 100.0
    }

    /// Checks that a figure can have this look.
    pub fn checked(self) -> Result<Self, LookError> {
        let width = self.points();
        if !(WIDTHS[0]..=WIDTHS[1]).contains(&width) {
            return Err(LookError::Width(width));
        }
        if let Some(height) = self.height.filter(|height| !(WIDTHS[0]..=WIDTHS[1]).contains(height)) {
            return Err(LookError::Height { height, width, needed: height.clamp(WIDTHS[0], WIDTHS[1]) });
        }
        let [high, low] = ACROSS.map(|across| TEXT * width / across);
        let size = TEXT * width / self.across();
        if !(ACROSS[0]..=ACROSS[1]).contains(&self.across()) {
            return Err(LookError::Size { size, width, low, high });
        }
        Ok(self)
    }
}
