//! How a figure stands on paper or on a screen, whatever it shows: its width, its letters, its title and the ranges of its axes.

use super::font::Fonts;
use super::layout::{TEXT, WIDTH};
use super::{Data, Figure, Panel, extent};

/// Points, 72 to the inch, of the width of a figure that is given none: a page's, between its margins.
pub const PAGE: f64 = 480.0;
/// The narrowest and the widest page, in units of which a letter is [`TEXT`] high: a narrower one has no room beside its labels.
const ACROSS: [f64; 2] = [240.0, 4000.0];
/// Widths that are a figure's, points: of a thumb, and of a poster.
const WIDTHS: [f64; 2] = [30.0, 2400.0];
/// What is drawn reaches at most this many times as far as what is shown: farther out coordinates are cut, and lines would turn.
const FARTHEST: f64 = 100.0;

/// On what a figure is looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// On a screen: an SVG is light or dark as the reader's screen is.
    #[default]
    Screen,
    /// On white paper, whatever the screen.
    Print,
}

/// What a figure looks like.
#[derive(Clone, Debug, Default)]
pub struct Look {
    /// Its width on paper, points; that of what it stands in where there is none, and a page's in print.
    pub width: Option<f64>,
    /// Height of its letters on paper, points; what they have in a figure as wide as a page where there is none.
    pub size: Option<f64>,
    /// Whose letters, which an SVG brings with it then; where there are none those of the page that an SVG stands in, and the program's own
    /// in a PNG and a PDF.
    pub fonts: Option<Fonts>,
    /// On what it is looked at.
    pub theme: Theme,
    /// Whether its title is left out.
    pub untitled: bool,
    /// Ends of the horizontal axis instead of its own.
    pub x: Option<[f64; 2]>,
    /// Ends of the first panel's vertical axis, instead of its own.
    pub y: Option<[f64; 2]>,
}

/// A look that no figure can have.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LookError {
    /// A width that is no figure's.
    #[error("a figure {0:.1} pt wide cannot be made: {low} to {high} pt can", low = WIDTHS[0], high = WIDTHS[1])]
    Width(f64),
    /// Letters that leave no room, or that nobody can read.
    #[error("letters of {size:.2} pt do not fit into a figure {width:.1} pt wide: {low:.2} to {high:.1} pt do")]
    #[expect(missing_docs, reason = "what the words say")]
    Size { size: f64, width: f64, low: f64, high: f64 },
    /// Nothing would be seen.
    #[error("{axis} from {} to {} shows nothing: what is drawn lies from {} to {}", shown[0], shown[1], drawn[0], drawn[1])]
    #[expect(missing_docs, reason = "what the words say")]
    Aside { axis: &'static str, shown: [f64; 2], drawn: [f64; 2] },
    /// Too little would be seen.
    #[error(
        "{axis} from {} to {} is less than a hundredth of what is drawn, from {} to {}: compute the figure anew over a narrower range",
        shown[0], shown[1], drawn[0], drawn[1]
    )]
    #[expect(missing_docs, reason = "what the words say")]
    Narrow { axis: &'static str, shown: [f64; 2], drawn: [f64; 2] },
}

impl Look {
    /// Whether a length on paper is asked for.
    pub(super) fn is_sized(&self) -> bool {
        self.width.is_some() || self.size.is_some() || self.theme == Theme::Print
    }

    /// The title that stands above a figure.
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

    /// Refuses what no figure can have.
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

    /// The figure between the ends that are asked for; its first panel alone has those of the vertical axis.
    pub fn framed(&self, mut figure: Figure) -> Result<Figure, LookError> {
        if let Some(shown) = self.x {
            let drawn = extent(figure.panels.iter().flat_map(|panel| reach(panel, 0)));
            figure.x.range = Some(within("--x", shown, drawn)?);
        }
        if let Some((shown, panel)) = self.y.zip(figure.panels.first_mut()) {
            panel.y.range = Some(within("--y", shown, extent(reach(panel, 1)))?);
        }
        Ok(figure)
    }
}

/// The ends of a panel's data in one direction, as far as they can be drawn.
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
    // Nothing is drawn where there are no data: any range is as good.
    if low <= high && (shown[1] < low || high < shown[0]) {
        return Err(LookError::Aside { axis, shown, drawn });
    }
    if high - low > FARTHEST * (shown[1] - shown[0]) {
        return Err(LookError::Narrow { axis, shown, drawn });
    }
    Ok(shown)
}
