//! Figures as plain values, with three renderers: SVG, and PNG and PDF made from the SVG.
//!
//! A [`Figure`] describes the drawing in the data's units. The module [`layout`] places it on the page; [`svg`], [`png`] and [`pdf`] write
//! it in a given [`Look`]. The only quantity computed here from the data is their extent.

mod density;
mod element;
pub mod font;
pub mod formula;
mod framed;
mod grid;
pub mod layout;
pub mod look;
pub mod pdf;
pub mod png;
mod series;
mod sheet;
pub mod svg;
pub mod thin;
pub mod ticks;
mod words;

use serde::Serialize;

pub use density::{Cloud, Density};
pub use element::{dashes, stroke_width};
pub use framed::DrawnPanel;
pub use look::{LegendPlace, Look, Theme, TitleChoice};
pub use series::dot_size;
pub use ticks::TickSpacing;

/// Drawing of panels below each other that share the horizontal axis, unless a panel has its own.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figure {
    /// Title above the panels; empty for none.
    pub title: String,
    /// Horizontal axis of the panels.
    pub x: FigureAxis,
    /// Vertical lines through the panels that share the axis, labelled above the first.
    pub marks: Vec<Mark>,
    /// Panels from top to bottom.
    pub panels: Vec<Panel>,
    /// Note below the panels; empty for none.
    pub note: String,
}

impl Figure {
    /// Builds a figure without marks on its horizontal axis and without a note.
    pub fn new(title: &str, x: FigureAxis, panels: Vec<Panel>) -> Self {
        Self { title: title.into(), x, marks: Vec::new(), panels, note: String::new() }
    }

    /// Rewrites the unit of each axis.
    pub fn in_units(mut self, spelled: impl Fn(&str) -> String) -> Self {
        let of_panels = self.panels.iter_mut().flat_map(|panel| [&mut panel.y].into_iter().chain(&mut panel.own_x));
        for axis in of_panels.chain([&mut self.x]) {
            axis.unit = spelled(&axis.unit);
        }
        self
    }
}

/// Axis: its name, unit and range.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FigureAxis {
    /// Name of the quantity on the axis.
    pub label: String,
    /// Unit; empty for a pure number.
    pub unit: String,
    /// Ends of the axis, the lower first; `None` for the extent of the data.
    pub range: Option<[f64; 2]>,
    /// Spacing of the ticks.
    pub spacing: TickSpacing,
    /// Whether a unit of this vertical axis is as long as one of the horizontal axis, so that circles are round.
    pub to_scale: bool,
}

impl FigureAxis {
    /// Builds an axis over the extent of the data.
    pub fn new(label: &str, unit: &str) -> Self {
        Self { label: label.into(), unit: unit.into(), range: None, spacing: TickSpacing::Decimal, to_scale: false }
    }

    /// Builds an axis of degrees.
    pub fn degrees(label: &str) -> Self {
        Self { spacing: TickSpacing::Degrees, ..Self::new(label, "deg") }
    }

    /// Returns the axis with its ends set.
    pub fn over(self, range: [f64; 2]) -> Self {
        Self { range: Some(range), ..self }
    }

    /// Returns a vertical axis to the scale of the horizontal one, which determines the height of its frame.
    pub fn scaled(self) -> Self {
        Self { to_scale: true, ..self }
    }
}

/// Frame with its vertical axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Panel {
    /// Vertical axis.
    pub y: FigureAxis,
    /// Height of the frame, in units of the figure's width.
    pub height: f64,
    /// Series of data; the first is drawn first.
    pub series: Vec<Series>,
    /// Horizontal lines, labelled at the right.
    pub marks: Vec<Mark>,
    /// Separate horizontal axis; `None` for the figure's. Panels with a separate axis are below the others.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub own_x: Option<FigureAxis>,
}

impl Panel {
    /// Builds a panel without marks.
    pub fn new(y: FigureAxis, height: f64, series: Vec<Series>) -> Self {
        Self { y, height, series, marks: Vec::new(), own_x: None }
    }

    /// Gives the panel a separate horizontal axis.
    pub fn across(self, x: FigureAxis) -> Self {
        Self { own_x: Some(x), ..self }
    }

    /// Adds a plain line at zero.
    pub fn with_zero(self) -> Self {
        Self { marks: vec![Mark::zero()], ..self }
    }
}

/// Reference line.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mark {
    /// Position on its axis.
    pub at: f64,
    /// Label; empty for a plain thin line, such as a line at zero.
    pub label: String,
}

impl Mark {
    /// Builds a plain line at zero.
    pub fn zero() -> Self {
        Self { at: 0.0, label: String::new() }
    }
}

/// Point that breaks a line.
pub const BREAK: [f64; 2] = [f64::NAN; 2];

/// Minimum and maximum of some values; in reverse order if there are no values.
pub fn extent(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    values.into_iter().fold(none, |[low, high], value| [low.min(value), high.max(value)])
}

/// Sequence of points `[x, y]` in the data's units.
pub trait Points: IntoIterator<Item = [f64; 2]> {}

impl<P: IntoIterator<Item = [f64; 2]>> Points for P {}

/// Data drawn in one style.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Series {
    /// Name in the legend; empty for none.
    pub label: String,
    /// Name in tables for a series without a legend entry; otherwise empty.
    pub name: String,
    /// Colour of the series.
    pub colour: Colour,
    /// Values of the series.
    pub data: Data,
}

impl Series {
    /// Builds a series with this label in the legend; an empty label has no entry.
    pub fn new(label: &str, colour: Colour, data: Data) -> Self {
        Self { label: label.into(), name: String::new(), colour, data }
    }

    /// Sets the name for tables.
    pub fn called(self, name: &str) -> Self {
        Self { name: name.into(), ..self }
    }

    /// Builds a line through points.
    pub fn line(label: &str, colour: Colour, stroke: Stroke, points: impl Points) -> Self {
        Self::new(label, colour, Data::Line { points: points.into_iter().collect(), stroke })
    }

    /// Builds the area inside a closed line.
    pub fn area(label: &str, colour: Colour, stroke: Stroke, points: impl Points) -> Self {
        Self::new(label, colour, Data::Area { points: points.into_iter().collect(), stroke })
    }

    /// Builds a line with an arrow at its end.
    pub fn arrow(label: &str, colour: Colour, stroke: Stroke, points: impl Points) -> Self {
        Self::new(label, colour, Data::Arrow { points: points.into_iter().collect(), stroke })
    }

    /// Builds a band between two values at each x: `[x, low, high]`; NaN breaks it.
    pub fn band(label: &str, colour: Colour, edges: impl IntoIterator<Item = [f64; 3]>) -> Self {
        Self::new(label, colour, Data::Band { edges: edges.into_iter().collect() })
    }

    /// Builds a marker at each point.
    pub fn points(label: &str, colour: Colour, marker: Marker, points: impl Points) -> Self {
        Self::new(label, colour, Data::Points { points: points.into_iter().collect(), marker })
    }

    /// Builds a series of words, in the colour of the text and without a legend entry.
    pub fn words(words: impl IntoIterator<Item = Label>) -> Self {
        Self::new("", Colour::Ink, Data::Words(words.into_iter().collect()))
    }

    /// Returns the series unless it is empty, so that the legend has no empty entries.
    pub fn if_any(self) -> Option<Self> {
        let none = match &self.data {
            Data::Words(words) => words.is_empty(),
            Data::Band { edges } => edges.is_empty(),
            data => data.points().is_some_and(<[_]>::is_empty),
        };
        (!none).then_some(self)
    }
}

/// Values of a series, `[x, y]` each, and the way they are joined.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "points, stroke and marker are what their types say")]
pub enum Data {
    /// Points joined in order; NaN breaks the line.
    Line {
        points: Vec<[f64; 2]>,
        stroke: Stroke,
    },
    /// Points joined in order, with the area below them filled down to the frame.
    Area {
        points: Vec<[f64; 2]>,
        stroke: Stroke,
    },
    /// Line with an arrowhead at the end of each of its runs.
    Arrow {
        points: Vec<[f64; 2]>,
        stroke: Stroke,
    },
    /// Area between two lines: `[x, low, high]` at each x; NaN breaks it.
    Band {
        edges: Vec<[f64; 3]>,
    },
    Points {
        points: Vec<[f64; 2]>,
        marker: Marker,
    },
    /// Words at points, above all other data.
    Words(Vec<Label>),
    /// Points counted on a grid, if there are too many to draw one by one.
    Density(Density),
    /// Regions of the plane, as the cells of a grid.
    Region {
        cells: Density,
        /// Strength of the colour, up to 1, which distinguishes regions in grey print.
        strength: f64,
    },
}

impl Data {
    /// Returns points that are drawn one by one or joined; `None` for other data.
    pub fn points(&self) -> Option<&[[f64; 2]]> {
        match self {
            Self::Line { points, .. }
            | Self::Area { points, .. }
            | Self::Arrow { points, .. }
            | Self::Points { points, .. } => Some(points),
            Self::Band { .. } | Self::Words(_) | Self::Density(_) | Self::Region { .. } => None,
        }
    }

    /// Stroke, marker and strength, without the values: series of one style share a sample in a legend.
    pub fn style(&self) -> (std::mem::Discriminant<Self>, Option<Stroke>, Option<Marker>, f64) {
        let (stroke, marker, strength) = match self {
            Self::Line { stroke, .. } | Self::Area { stroke, .. } | Self::Arrow { stroke, .. } => {
                (Some(*stroke), None, 1.0)
            }
            Self::Points { marker, .. } => (None, Some(*marker), 1.0),
            Self::Region { strength, .. } => (None, None, *strength),
            Self::Band { .. } | Self::Words(_) | Self::Density(_) => (None, None, 1.0),
        };
        (std::mem::discriminant(self), stroke, marker, strength)
    }
}

/// Word at a point.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Label {
    /// Position `[x, y]`.
    pub at: [f64; 2],
    /// Text; `_` lowers and `^` raises the next letter, or the letters in braces.
    pub text: String,
    /// Side of the point where the word is written.
    pub beside: Beside,
}

impl Label {
    /// Builds a label beside a point in data values.
    pub fn new(at: [f64; 2], text: &str, beside: Beside) -> Self {
        Self { at, text: text.into(), beside }
    }
}

/// Side of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "a side is what its name says")]
pub enum Beside {
    Right,
    Left,
    Above,
    Below,
    AboveRight,
    AboveLeft,
    BelowRight,
    BelowLeft,
}

/// Stroke of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stroke {
    /// Thin solid stroke.
    Thin,
    /// Solid stroke.
    Solid,
    /// Dashed stroke.
    Dashed,
    /// Dotted stroke.
    Dotted,
    /// Alternating dashes and dots.
    DashDotted,
    /// Dashes, each followed by two dots.
    DashDotDotted,
    /// Solid stroke, three times as wide.
    Thick,
    /// Dashed stroke, three times as wide.
    ThickDashed,
    /// Dotted stroke, three times as wide.
    ThickDotted,
    /// Alternating dashes and dots, three times as wide.
    ThickDashDotted,
}

/// Marker at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Marker {
    /// Small disc.
    Dot,
    /// Disc.
    Disc,
    /// Open circle; this marker and the next ones are small if there are many.
    Ring,
    /// Open square.
    Square,
    /// Open square on its tip.
    Diamond,
    /// Open triangle.
    Triangle,
    /// Two diagonal strokes.
    Cross,
    /// Horizontal and vertical stroke.
    Plus,
    /// Triangle below the point, with its tip at the point.
    Below,
}

/// Colours that remain distinct for the colour-blind (Okabe and Ito), and in grey by their strokes and markers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "a colour is what its name says; ink is that of the text")]
pub enum Colour {
    Ink,
    Grey,
    Blue,
    Vermilion,
    Green,
    Purple,
}

impl Colour {
    /// All colours, in the order in which series use them.
    pub const ALL: [Self; 6] = [Self::Ink, Self::Grey, Self::Blue, Self::Vermilion, Self::Green, Self::Purple];

    /// Class of the colour in the SVG, its hex value on white paper, and its hex value on a dark screen.
    pub const fn shades(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::Ink => ("ink", "#1a1a1a", "#e8e8e8"),
            Self::Grey => ("grey", "#8a8a8a", "#8f8f8f"),
            Self::Blue => ("blue", "#0072b2", "#56b4e9"),
            Self::Vermilion => ("vermilion", "#d55e00", "#f0903c"),
            Self::Green => ("green", "#009e73", "#35cfa2"),
            Self::Purple => ("purple", "#b0588a", "#dd9cc2"),
        }
    }

    /// Red, green and blue on white paper.
    pub fn rgb(self) -> [u8; 3] {
        let hex = self.shades().1.trim_start_matches('#');
        [0, 2, 4].map(|at| u8::from_str_radix(&hex[at..at + 2], 16).unwrap_or(0))
    }
}
