//! Restriction of a figure to the ranges of a look, and a check that the figure fits.

use super::layout::{LARGEST, Layout};
use super::look::{LegendPlace, Look, LookError};
use super::series::Page;
use super::{Data, Figure, Panel, extent};

/// Largest ratio of the drawn range to the displayed range: farther out, coordinates are clamped, which would change the direction of
/// lines.
const FARTHEST: f64 = 100.0;

/// Ranges and lines of a panel as drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnPanel {
    /// Ends of the axes, across and up.
    pub ranges: [[f64; 2]; 2],
    /// Points of each series' line, with its breaks; empty for other data.
    pub lines: Vec<Vec<[f64; 2]>>,
}

impl Look {
    /// Checks that the figure fits into the height of the look, with its legend.
    pub fn has_room(&self, figure: &Figure) -> Result<(), LookError> {
        /// Largest difference in height, points, since the page's height is a whole number of units.
        const CLOSE: f64 = 1.0;
        if self.height.is_none() && self.legend != LegendPlace::Right {
            return Ok(());
        }
        let (layout, width) = (Layout::new(figure, self), self.points());
        let needed = layout.height * width / self.across();
        if let Some(height) = self.height.filter(|height| (height - needed).abs() > CLOSE) {
            return Err(LookError::Height { height, width, needed });
        }
        let reaches = layout.panels.iter().map(|panel| panel.frame.right()).fold(0.0, f64::max);
        let legend = layout.panels.iter().flat_map(|panel| &panel.legend).map(|(_, text)| text.at[0]);
        let is_apart = self.legend != LegendPlace::Right || reaches < legend.fold(f64::INFINITY, f64::min);
        if is_apart { Ok(()) } else { Err(LookError::Legend(width)) }
    }

    /// Returns each panel of a figure as drawn.
    pub fn drawn(&self, figure: &Figure) -> Vec<DrawnPanel> {
        let layout = Layout::new(figure, self);
        let of = |page: &Page, data: &Data| match data {
            Data::Line { points, .. } | Data::Area { points, .. } | Data::Arrow { points, .. } => page.thinned(points),
            _ => Vec::new(),
        };
        let panels = figure.panels.iter().zip(&layout.panels).map(|(panel, place)| {
            let page = Page::new(place, [false; 2]);
            let lines = panel.series.iter().map(|series| of(&page, &series.data)).collect();
            DrawnPanel { ranges: [page.x, page.y], lines }
        });
        panels.collect()
    }

    /// Restricts the figure to the requested ranges; the vertical one applies to the first panel only.
    pub fn framed(&self, mut figure: Figure) -> Result<Figure, LookError> {
        if let Some(shown) = self.x {
            let sharing = figure.panels.iter().filter(|panel| panel.own_x.is_none());
            let drawn = extent(sharing.flat_map(|panel| reach(panel, 0)));
            figure.x.range = Some(within("--x-range", shown, drawn)?);
        }
        if let Some((shown, panel)) = self.y.zip(figure.panels.first_mut()) {
            panel.y.range = Some(within("--y-range", shown, extent(reach(panel, 1)))?);
        }
        self.has_room(&figure)?;
        Ok(figure)
    }
}

/// Drawable data of a panel in one direction, from which its extent follows.
fn reach(panel: &Panel, direction: usize) -> Vec<f64> {
    let of = |data: &Data| match data {
        Data::Density(cells) | Data::Region { cells, .. } => cells.ranges()[direction].to_vec(),
        Data::Band { edges } if direction == 0 => edges.iter().map(|[x, ..]| *x).collect(),
        Data::Band { edges } => edges.iter().flat_map(|[_, low, high]| [*low, *high]).collect(),
        data => data.points().unwrap_or_default().iter().map(|point| point[direction]).collect(),
    };
    let all = panel.series.iter().flat_map(|series| of(&series.data));
    all.filter(|value| value.abs() < LARGEST).collect()
}

fn within(axis: &'static str, shown: [f64; 2], drawn: [f64; 2]) -> Result<[f64; 2], LookError> {
    let [low, high] = drawn;
    // Without data, any range is accepted.
    if low <= high && (shown[1] < low || high < shown[0]) {
        return Err(LookError::Aside { axis, shown, drawn });
    }
    if high - low > FARTHEST * (shown[1] - shown[0]) {
        return Err(LookError::Narrow { axis, shown, drawn });
    }
    Ok(shown)
}
