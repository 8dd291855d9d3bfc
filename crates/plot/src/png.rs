//! Figures as PNG, made from their SVG; the program embeds a font, for machines without fonts.

use std::io::Write;

use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::Tree;

use super::grid::Grid;
use super::layout::Layout;
use super::look::Look;
use super::sheet::{Host, Layer};
use super::svg;
use super::{Colour, Figure};

/// Largest width of an image, pixels.
const WIDEST: u32 = 10_000;
/// Number of rows of pixels drawn at a time; clipping needs five times as much additional memory.
const BAND: u32 = 8;

/// Reason why there is no image.
#[derive(Debug, thiserror::Error)]
pub enum PngError {
    /// Width that is not allowed.
    #[error("an image {0} pixels wide cannot be made: the width must be 1 to {WIDEST}")]
    Width(u32),
    /// SVG that could not be written.
    #[error("the figure could not be written as SVG: {0}")]
    Svg(#[from] std::fmt::Error),
    /// SVG that could not be read back.
    #[error("the figure's SVG could not be read: {0}")]
    Read(#[from] resvg::usvg::Error),
    /// Pixels that could not be compressed.
    #[error("the image could not be packed: {0}")]
    Pack(String),
}

/// Layer that is drawn over the layers before it.
enum Paint {
    Drawing(Box<Tree>),
    Grid(Grid, Colour, [f64; 4]),
}

/// Resolution of an image on paper, dots per inch.
const DOTS: f64 = 300.0;

impl Look {
    /// Width in pixels, at 300 to the inch of the width on paper.
    pub fn pixels(&self) -> u32 {
        (DOTS * self.points() / 72.0).round() as u32
    }
}

/// Renders the figure on white paper, `width` pixels wide. Takes the figure by value, to free its data after the layout.
pub fn render(figure: Figure, look: &Look, width: u32) -> Result<Vec<u8>, PngError> {
    if !(1..=WIDEST).contains(&width) {
        return Err(PngError::Width(width));
    }
    let fonts = look.fonts.clone().unwrap_or_default();
    let scale = f64::from(width) / look.across();
    let height = (Layout::new(&figure, look).height * scale).ceil() as u32;
    let layers = svg::write(&figure, look, true, Host::File)?.into_iter().map(|layer| match layer {
        Layer::Drawing(text) => fonts.tree(&text).map(|tree| Paint::Drawing(Box::new(tree))),
        Layer::Grid(grid, colour, frame) => Ok(Paint::Grid(grid, colour, frame)),
    });
    drop(figure);
    let layers: Vec<Paint> = layers.collect::<Result<_, _>>()?;
    let pack = |error: png::EncodingError| PngError::Pack(error.to_string());
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    if look.is_sized() {
        // Pixels per metre.
        let [xppu, yppu] = [(f64::from(width) / look.points() * 72.0 / 0.0254).round() as u32; 2];
        encoder.set_pixel_dims(Some(png::PixelDimensions { xppu, yppu, unit: png::Unit::Meter }));
    }
    let mut writer = encoder.write_header().map_err(pack)?;
    let mut stream = writer.stream_writer().map_err(pack)?;
    // Band by band: all pixels at once would take most of the program's memory.
    let mut image = Pixmap::new(width, BAND.min(height)).ok_or(PngError::Width(width))?;
    for top in (0..height).step_by(BAND as usize) {
        image.fill(Color::WHITE);
        let place = Transform::from_row(scale as f32, 0.0, 0.0, scale as f32, 0.0, -(top as f32));
        for layer in &layers {
            match layer {
                Paint::Drawing(tree) => resvg::render(tree, place, &mut image.as_mut()),
                Paint::Grid(grid, colour, frame) => {
                    grid.draw(&mut image, *colour, *frame, f64::from(top), scale);
                }
            }
        }
        let rows = width as usize * BAND.min(height - top) as usize;
        let band: Vec<u8> =
            image.pixels()[..rows].iter().flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]).collect();
        stream.write_all(&band).map_err(|error| PngError::Pack(error.to_string()))?;
    }
    stream.finish().map_err(pack)?;
    writer.finish().map_err(pack)?;
    Ok(bytes)
}
