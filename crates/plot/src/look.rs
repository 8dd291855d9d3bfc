//! Appearance of a figure on paper or on a screen, whatever its data: its width, font, title and ranges of axes.

use super::font::Fonts;
use super::layout::{TEXT, WIDTH};
use super::{Data, Figure, Panel, extent};

/// Default width of a figure, points, 72 to the inch: that of a page between its margins.
pub const PAGE: f64 = 480.0;
/// Least and greatest width of the page, in units; a letter is [`TEXT`] high. A narrower page has no room beside its labels.
const ACROSS: [f64; 2] = [240.0, 4000.0];
/// Allowed widths of a figure, points: from a thumb to a poster.
const WIDTHS: [f64; 2] = [30.0, 2400.0];
/// Largest ratio of the drawn range to the displayed range: farther out, coordinates are clamped, and lines would change direction.
const FARTHEST: f64 = 100.0;

/// Medium on which a figure is viewed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// A screen: an SVG is light or dark, as the reader's screen is.
    #[default]
    Screen,
    /// White paper, whatever the screen.
    Print,
}

/// Appearance of a figure.
#[derive(Clone, Debug, Default)]
pub struct Look {
    /// Width on paper, points. By default that of the surrounding page; in print, a page's width.
    pub width: Option<f64>,
    /// Height of letters on paper, points. By default as in a figure as wide as a page.
    pub size: Option<f64>,
    /// Fonts, which an SVG then embeds. By default an SVG uses the fonts of the surrounding page; a PNG and a PDF use the built-in
    /// font.
    pub fonts: Option<Fonts>,
    /// Medium on which the figure is viewed.
    pub theme: Theme,
    /// Whether the title is left out.
    pub untitled: bool,
    /// Ends of the horizontal axis, in place of the figure's.
    pub x: Option<[f64; 2]>,
    /// Ends of the first panel's vertical axis, in place of the panel's.
    pub y: Option<[f64; 2]>,
}

/// Reason why a look is impossible.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LookError {
    /// A width outside the allowed range.
    #[error("a figure {0:.1} pt wide cannot be made: {low} to {high} pt can", low = WIDTHS[0], high = WIDTHS[1])]
    Width(f64),
    /// Letters that leave no room, or that are too small to read.
    #[error("letters of {size:.2} pt do not fit into a figure {width:.1} pt wide: {low:.2} to {high:.1} pt do")]
    #[expect(missing_docs, reason = "what the words say")]
    Size { size: f64, width: f64, low: f64, high: f64 },
    /// A range that shows no data.
    #[error("{axis} from {} to {} shows nothing: what is drawn lies from {} to {}", shown[0], shown[1], drawn[0] as f32, drawn[1] as f32)]
    #[expect(missing_docs, reason = "what the words say")]
    Aside { axis: &'static str, shown: [f64; 2], drawn: [f64; 2] },
    /// A range that shows too little of the data.
    #[error(
        "{axis} from {} to {} is less than a hundredth of what is drawn, from {} to {}: compute the figure anew over a narrower range",
        shown[0], shown[1], drawn[0] as f32, drawn[1] as f32
    )]
    #[expect(missing_docs, reason = "what the words say")]
    Narrow { axis: &'static str, shown: [f64; 2], drawn: [f64; 2] },
}

impl Look {
    /// Whether the look asks for a length on paper.
    pub(super) fn is_sized(&self) -> bool {
        self.width.is_some() || self.size.is_some() || self.theme == Theme::Print
    }

    /// Title above the figure.
    pub(super) fn title<'a>(&self, figure: &'a Figure) -> &'a str {
        if self.untitled { "" } else { &figure.title }
    }

    /// Width on paper, points.
    pub fn points(&self) -> f64 {
        self.width.unwrap_or(PAGE)
    }

    /// Width of the page in units of which a letter is [`TEXT`] high.
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
        let [high, low] = ACROSS.map(|across| TEXT * width / across);
        let size = TEXT * width / self.across();
        if !(ACROSS[0]..=ACROSS[1]).contains(&self.across()) {
            return Err(LookError::Size { size, width, low, high });
        }
        Ok(self)
    }

    /// Restricts the figure to the requested ranges; the vertical one applies to the first panel only.
    pub fn framed(&self, mut figure: Figure) -> Result<Figure, LookError> {
        if let Some(shown) = self.x {
            let drawn = extent(figure.panels.iter().flat_map(|panel| reach(panel, 0)));
            figure.x.range = Some(within("--x-range", shown, drawn)?);
        }
        if let Some((shown, panel)) = self.y.zip(figure.panels.first_mut()) {
            panel.y.range = Some(within("--y-range", shown, extent(reach(panel, 1)))?);
        }
        Ok(figure)
    }
}

/// Drawable data of a panel in one direction, from which its extent follows.
fn reach(panel: &Panel, direction: usize) -> Vec<f64> {
    let of = |data: &Data| match data {
        Data::Density(cells) | Data::Region { cells, .. } => cells.ranges()[direction].to_vec(),
        data => data.points().unwrap_or_default().iter().map(|point| point[direction]).collect(),
    };
    let all = panel.series.iter().flat_map(|series| of(&series.data));
    all.filter(|value| value.abs() < super::layout::LARGEST).collect()
}

fn within(axis: &'static str, shown: [f64; 2], drawn: [f64; 2]) -> Result<[f64; 2], LookError> {
    let [low, high] = drawn;
    // Without data, any range will do.
    if low <= high && (shown[1] < low || high < shown[0]) {
        return Err(LookError::Aside { axis, shown, drawn });
    }
    if high - low > FARTHEST * (shown[1] - shown[0]) {
        return Err(LookError::Narrow { axis, shown, drawn });
    }
    Ok(shown)
}
