//! SVG document under construction: in one piece, or divided where a grid is drawn between lower and upper layers.

use std::fmt::{self, Write};

use super::Colour;
use super::grid::Grid;

/// Surroundings of an SVG.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Host {
    /// Separate file.
    File,
    /// Page with one style for all its figures. Frames state their ranges, so that a script finds values.
    Page,
}

/// Layer of the drawing; the first is the lowest.
pub(super) enum Layer {
    /// A whole SVG document.
    Drawing(String),
    /// A grid, its colour, and its clipping frame: left, top, width and height on the page.
    Grid(Grid, Colour, [f64; 4]),
}

/// Current text, and the layers below it.
pub(super) struct Sheet {
    text: String,
    layers: Vec<Layer>,
    apart: bool,
    host: Host,
    /// Start tags of a document and of a group in it.
    page: String,
    /// Start tag of the open frame, and the frame's position.
    frame: (String, [f64; 4]),
}

impl Write for Sheet {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.text.write_str(text)
    }
}

impl Sheet {
    /// Creates an empty sheet; `page` opens a document and a group in it. Grids are part of the text unless `apart` is set.
    pub(super) fn new(page: String, apart: bool, host: Host) -> Self {
        Self { text: String::new(), layers: Vec::new(), apart, host, page, frame: (String::new(), [0.0; 4]) }
    }

    /// Returns the surroundings.
    pub(super) fn host(&self) -> Host {
        self.host
    }

    /// Opens a frame: left, top, width and height, with its ranges across and up.
    pub(super) fn open_frame(&mut self, frame: [f64; 4], [x, y]: [[f64; 2]; 2]) {
        let [left, top, width, height] = frame.map(super::element::number);
        let ranges = match self.host {
            Host::File => String::new(),
            Host::Page => format!(" data-x=\"{} {}\" data-y=\"{} {}\"", x[0], x[1], y[0], y[1]),
        };
        let tag = format!("<svg x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\"{ranges}>\n");
        self.text.push_str(&tag);
        self.frame = (tag, frame);
    }

    /// Adds a grid to the open frame.
    pub(super) fn grid(&mut self, grid: Grid, colour: Colour) -> fmt::Result {
        if !self.apart {
            return grid.write(self, colour);
        }
        let (tag, frame) = &self.frame;
        let above = format!("{}{tag}", self.page);
        let below = std::mem::replace(&mut self.text, above) + "</svg>\n</g>\n</svg>\n";
        self.layers.extend([Layer::Drawing(below), Layer::Grid(grid, colour, *frame)]);
        Ok(())
    }

    /// Returns the layers, the lowest first.
    pub(super) fn layers(mut self) -> Vec<Layer> {
        self.layers.push(Layer::Drawing(self.text));
        self.layers
    }
}
