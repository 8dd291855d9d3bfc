//! A figure as one value, and three renderers of it: SVG, and PNG and PDF from the SVG.
//!
//! A [`Figure`] says what is drawn in the data's own units; [`layout`] decides where on the page, [`svg`], [`png`] and [`pdf`] only
//! write that down, as a [`Look`] has it. Nothing here computes anything from the data but its extent; the figures themselves are built in
//! [`crate::figures`].

mod density;
mod element;
pub mod font;
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
pub use look::{Look, Theme};
pub use ticks::Spacing;

/// What is drawn: panels below each other that share the horizontal axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figure {
    /// Stands above; empty for none.
    pub title: String,
    /// The horizontal axis of every panel.
    pub x: Axis,
    /// Vertical lines through every panel, labelled above the first.
    pub marks: Vec<Mark>,
    /// From top to bottom.
    pub panels: Vec<Panel>,
    /// Stands below; empty for none.
    pub note: String,
}

impl Figure {
    /// Panels without marks of their axis and without a note.
    pub(crate) fn new(title: &str, x: Axis, panels: Vec<Panel>) -> Self {
        Self { title: title.into(), x, marks: Vec::new(), panels, note: String::new() }
    }

    /// The same with each axis' unit written otherwise.
    pub fn in_units(mut self, spelled: impl Fn(&str) -> String) -> Self {
        for axis in self.panels.iter_mut().map(|panel| &mut panel.y).chain([&mut self.x]) {
            axis.unit = spelled(&axis.unit);
        }
        self
    }
}

/// An axis: its name, unit and range.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Axis {
    /// What is drawn against it.
    pub label: String,
    /// Its unit; empty for a pure number.
    pub unit: String,
    /// Its ends, the lower first; the extent of the data where there is none.
    pub range: Option<[f64; 2]>,
    /// Where its ticks may stand.
    pub spacing: Spacing,
    /// Of a vertical axis: whether a unit is as long as one of the horizontal axis, so that a circle is one.
    pub to_scale: bool,
}

impl Axis {
    /// An axis that takes the extent of the data.
    pub fn new(label: &str, unit: &str) -> Self {
        Self { label: label.into(), unit: unit.into(), range: None, spacing: Spacing::Decimal, to_scale: false }
    }

    /// An axis of degrees.
    pub fn degrees(label: &str) -> Self {
        Self { spacing: Spacing::Degrees, ..Self::new(label, "deg") }
    }

    /// The axis with its ends set.
    pub fn over(self, range: [f64; 2]) -> Self {
        Self { range: Some(range), ..self }
    }

    /// The vertical axis with units as long as those of the horizontal one; its frame is as high as that makes it.
    pub(crate) fn scaled(self) -> Self {
        Self { to_scale: true, ..self }
    }
}

/// One frame with its vertical axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Panel {
    /// The vertical axis.
    pub y: Axis,
    /// Height of the frame, in units of the figure's width.
    pub height: f64,
    /// What it shows; the first is drawn first.
    pub series: Vec<Series>,
    /// Horizontal lines, labelled at the right.
    pub marks: Vec<Mark>,
}

impl Panel {
    /// A panel without marks.
    pub(crate) fn new(y: Axis, height: f64, series: Vec<Series>) -> Self {
        Self { y, height, series, marks: Vec::new() }
    }

    /// The panel with the plain line of zero.
    pub(crate) fn with_zero(self) -> Self {
        Self { marks: vec![Mark::zero()], ..self }
    }
}

/// A reference line.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mark {
    /// Where it crosses its axis.
    pub at: f64,
    /// What it stands for; empty for a plain thin line, such as that of zero.
    pub label: String,
}

impl Mark {
    /// The plain line of zero.
    pub(crate) fn zero() -> Self {
        Self { at: 0.0, label: String::new() }
    }
}

/// In the points of a line: where it is broken.
pub(crate) const BREAK: [f64; 2] = [f64::NAN; 2];

/// The least and the greatest of some values; upside down where there are none.
pub(crate) fn extent(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    values.into_iter().fold(none, |[low, high], value| [low.min(value), high.max(value)])
}

/// Points `[x, y]` in the data's units, one after another.
pub(crate) trait Points: IntoIterator<Item = [f64; 2]> {}

impl<P: IntoIterator<Item = [f64; 2]>> Points for P {}

/// Data drawn in one way.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Series {
    /// Its name in the legend; empty for none.
    pub label: String,
    /// What a table calls it where the legend does not name it; empty where it does.
    pub name: String,
    /// Its colour.
    pub colour: Colour,
    /// Its values.
    pub data: Data,
}

impl Series {
    pub(crate) fn new(label: &str, colour: Colour, data: Data) -> Self {
        Self { label: label.into(), name: String::new(), colour, data }
    }

    /// The same with a name for tables.
    pub(crate) fn called(self, name: &str) -> Self {
        Self { name: name.into(), ..self }
    }

    pub(crate) fn line(label: &str, colour: Colour, stroke: Stroke, points: impl Points) -> Self {
        Self::new(label, colour, Data::Line { points: points.into_iter().collect(), stroke })
    }

    pub(crate) fn area(label: &str, colour: Colour, stroke: Stroke, points: impl Points) -> Self {
        Self::new(label, colour, Data::Area { points: points.into_iter().collect(), stroke })
    }

    pub(crate) fn arrow(label: &str, colour: Colour, stroke: Stroke, points: impl Points) -> Self {
        Self::new(label, colour, Data::Arrow { points: points.into_iter().collect(), stroke })
    }

    pub(crate) fn points(label: &str, colour: Colour, marker: Marker, points: impl Points) -> Self {
        Self::new(label, colour, Data::Points { points: points.into_iter().collect(), marker })
    }

    /// Words stand in the colour of the text and in no legend.
    pub(crate) fn words(words: impl IntoIterator<Item = Word>) -> Self {
        Self::new("", Colour::Ink, Data::Words(words.into_iter().collect()))
    }

    /// The series, if it has anything: a legend names nothing that is not there.
    pub(crate) fn if_any(self) -> Option<Self> {
        let none = match &self.data {
            Data::Words(words) => words.is_empty(),
            data => data.points().is_some_and(<[_]>::is_empty),
        };
        (!none).then_some(self)
    }
}

/// The values of a series, `[x, y]` each, and how they are joined.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "points, stroke and marker are what their types say")]
pub enum Data {
    /// Points joined in order; what is not a number breaks the line.
    Line {
        points: Vec<[f64; 2]>,
        stroke: Stroke,
    },
    /// Points joined in order, and what lies below them filled down to the frame.
    Area {
        points: Vec<[f64; 2]>,
        stroke: Stroke,
    },
    /// A line with the head of an arrow at the end of each of its runs.
    Arrow {
        points: Vec<[f64; 2]>,
        stroke: Stroke,
    },
    Points {
        points: Vec<[f64; 2]>,
        marker: Marker,
    },
    /// Words at points, over whatever else is there.
    Words(Vec<Word>),
    /// More points than there is paper, counted on a grid.
    Density(Density),
    /// Parts of the plane, as the cells of a grid.
    Region {
        cells: Density,
        /// How much of the colour they have, up to 1: in grey print regions are told apart by it.
        strength: f64,
    },
}

impl Data {
    /// The points that are drawn one by one or joined.
    pub(crate) fn points(&self) -> Option<&[[f64; 2]]> {
        match self {
            Self::Line { points, .. }
            | Self::Area { points, .. }
            | Self::Arrow { points, .. }
            | Self::Points { points, .. } => Some(points),
            Self::Words(_) | Self::Density(_) | Self::Region { .. } => None,
        }
    }
}

/// A word at a point.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Word {
    /// `[x, y]`.
    pub at: [f64; 2],
    /// What it says; `_` lowers and `^` raises the letter after it, or the letters in braces.
    pub text: String,
    /// On which side of the point it stands.
    pub beside: Beside,
}

impl Word {
    pub(crate) fn new(at: [f64; 2], text: &str, beside: Beside) -> Self {
        Self { at, text: text.into(), beside }
    }
}

/// A side of a point.
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

/// How a line is stroked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stroke {
    /// Thin and unbroken.
    Thin,
    /// Unbroken.
    Solid,
    /// Broken.
    Dashed,
    /// Of points.
    Dotted,
    /// Unbroken, three times as wide.
    Thick,
}

/// What stands at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Marker {
    /// A small disc.
    Dot,
    /// A disc.
    Disc,
    /// An open circle; this and the next are small where there are many.
    Ring,
    /// An open square.
    Square,
    /// An open square on its tip.
    Diamond,
    /// An open triangle.
    Triangle,
    /// Two strokes, across.
    Cross,
    /// Two strokes, one upright.
    Plus,
    /// A triangle, its tip at the point, standing below it.
    Below,
}

/// Colours that stay apart for the colour-blind (Okabe and Ito), and in grey by what they are drawn with.
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
    pub(crate) const ALL: [Self; 6] = [Self::Ink, Self::Grey, Self::Blue, Self::Vermilion, Self::Green, Self::Purple];

    /// Its class in the SVG, its hex value on white paper, and on a dark screen.
    pub(crate) const fn shades(self) -> (&'static str, &'static str, &'static str) {
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
    pub(crate) fn rgb(self) -> [u8; 3] {
        let hex = self.shades().1.trim_start_matches('#');
        [0, 2, 4].map(|at| u8::from_str_radix(&hex[at..at + 2], 16).unwrap_or(0))
    }
}
