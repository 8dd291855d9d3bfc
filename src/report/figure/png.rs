//! The figure as PNG, from its SVG; letters come with the program, for machines that have none.

use std::io::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree};

use super::density::SHADES;
use super::svg::{self, Dense};
use super::{Colour, Figure};

/// The widest image that is made.
const WIDEST: u32 = 10_000;
/// Rows of pixels that are drawn at a time; what is clipped takes five times as many beside them.
const BAND: u32 = 32;

/// Why there is no image.
#[derive(Debug, thiserror::Error)]
pub enum PngError {
    /// A width that makes no image.
    #[error("an image {0} pixels wide cannot be made: 1 to {WIDEST} can")]
    Width(u32),
    /// The SVG could not be written.
    #[error("the figure could not be written as SVG: {0}")]
    Svg(#[from] std::fmt::Error),
    /// The SVG could not be read back.
    #[error("the figure's SVG could not be read: {0}")]
    Read(#[from] resvg::usvg::Error),
    /// The pixels could not be packed.
    #[error("the image could not be packed: {0}")]
    Pack(String),
}

/// The figure on white paper, `width` pixels wide.
pub fn render(figure: &Figure, width: u32) -> Result<Vec<u8>, PngError> {
    if !(1..=WIDEST).contains(&width) {
        return Err(PngError::Width(width));
    }
    let mut options = Options::default();
    let fonts = options.fontdb_mut();
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    let family = fonts.faces().next().and_then(|face| face.families.first()).map(|(name, _)| name.clone());
    if let Some(family) = family {
        fonts.set_sans_serif_family(family);
    }
    // Only for what the first has no glyph of, such as a raised minus.
    fonts.load_font_data(epaint_default_fonts::HACK_REGULAR.to_vec());
    let tree = Tree::from_str(&svg::write(figure, Dense::Outlined)?, &options)?;
    let scale = width as f32 / tree.size().width();
    let height = (tree.size().height() * scale).ceil() as u32;
    let pack = |error: png::EncodingError| PngError::Pack(error.to_string());
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().map_err(pack)?;
    let mut stream = writer.stream_writer().map_err(pack)?;
    // Band by band: all pixels of a page at once would be most of the program's memory.
    let mut image = Pixmap::new(width, BAND.min(height)).ok_or(PngError::Width(width))?;
    for top in (0..height).step_by(BAND as usize) {
        image.fill(Color::WHITE);
        let place = Transform::from_row(scale, 0.0, 0.0, scale, 0.0, -(top as f32));
        resvg::render(&tree, place, &mut image.as_mut());
        let rows = width as usize * BAND.min(height - top) as usize;
        let band: Vec<u8> =
            image.pixels()[..rows].iter().flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]).collect();
        stream.write_all(&band).map_err(|error| PngError::Pack(error.to_string()))?;
    }
    stream.finish().map_err(pack)?;
    writer.finish().map_err(pack)?;
    Ok(bytes)
}

/// A grid of shades, rows from below, as a PNG in base 64: one colour, its opacity by shade.
pub(super) fn grid(
    shades: &[u8],
    columns: usize,
    colour: Colour,
    opacity: impl Fn(u8) -> f64,
) -> Result<String, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, columns as u32, (shades.len() / columns) as u32);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Four);
    let rgb: Vec<u8> = {
        let hex = colour.shades().1.trim_start_matches('#');
        (0..3).map(|part| u8::from_str_radix(&hex[2 * part..2 * part + 2], 16).unwrap_or(0)).collect()
    };
    let alpha: Vec<u8> =
        (0..=SHADES).map(|shade| if shade == 0 { 0 } else { (255.0 * opacity(shade)) as u8 }).collect();
    encoder.set_palette(rgb.repeat(alpha.len()));
    encoder.set_trns(alpha);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header()?;
    let rows = shades.chunks(columns).rev();
    let pair = |pair: &[u8]| (pair[0] << 4) | pair.get(1).copied().unwrap_or(0);
    let packed: Vec<u8> = rows.flat_map(|row| row.chunks(2).map(pair)).collect();
    writer.write_image_data(&packed)?;
    writer.finish()?;
    Ok(STANDARD.encode(bytes))
}
