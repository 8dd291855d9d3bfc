//! Dense grids on the page: as SVG, or drawn directly into the pixels of a PNG.

use std::borrow::Cow;
use std::fmt::{self, Write};
use std::io::Write as _;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use resvg::tiny_skia::{FillRule, Mask, Paint, Path, PathBuilder, Pixmap, Rect, Transform};

use super::Colour;
use super::density::{SHADES, Shades};
use super::element::{number, stroke};

/// Drawing of a grid; lengths in the page's units, from the upper left corner of its frame.
pub(super) enum Grid {
    /// Cells stretched over a rectangle.
    Cells {
        shades: Shades,
        /// Left, top, width and height of the whole grid.
        place: [f64; 4],
        /// Opacity of a cell of full shade: 1 is opaque.
        strength: f64,
    },
    /// Dot for each occupied cell.
    Dots {
        /// Centres of the dots in tenths of a unit, by shade, the faintest first.
        at: [Vec<[i64; 2]>; SHADES as usize],
        size: f64,
    },
}

/// Opacity of a shade; the faintest remains visible in print.
fn opacity(shade: u8) -> f64 {
    0.5 + 0.5 * f64::from(shade - 1) / f64::from(SHADES - 1)
}

/// Opacity of a shade on the scale to 255; 0 for no shade.
fn alpha(shade: u8) -> u8 {
    if shade == 0 { 0 } else { (255.0 * opacity(shade)) as u8 }
}

impl Grid {
    /// Writes the grid as elements of an SVG.
    pub(super) fn write(&self, out: &mut impl Write, colour: Colour) -> fmt::Result {
        match self {
            Self::Cells { shades, place, strength } => {
                let (image, is_turned) = image(shades, colour).map_err(|_| fmt::Error)?;
                let [left, top, width, height] = place.map(number);
                // The page's vertical axis runs across in an image that is reflected at its diagonal.
                let place = match is_turned {
                    false => format!(r#"x="{left}" y="{top}" width="{width}" height="{height}""#),
                    true => {
                        format!(
                            r#"transform="matrix(0 1 1 0 0 0)" x="{top}" y="{left}" width="{height}" height="{width}""#
                        )
                    }
                };
                let strength =
                    if *strength < 1.0 { format!(r#" opacity="{}""#, number(*strength)) } else { String::new() };
                writeln!(
                    out,
                    r#"<image class="dense" {place}{strength} preserveAspectRatio="none" href="data:image/png;base64,{image}"/>"#
                )
            }
            Self::Dots { at, size } => {
                for (shade, dots) in (1..).zip(at).filter(|(_, dots)| !dots.is_empty()) {
                    let (mut path, mut last) = (String::new(), [0; 2]);
                    for dot in dots {
                        // Relative to the previous dot: half the bytes, and errors do not accumulate.
                        write!(path, "m{} {}h0", dot[0] - last[0], dot[1] - last[1])?;
                        last = *dot;
                    }
                    let (width, opacity) = (10.0 * size, number(opacity(shade)));
                    let stroke = stroke(colour);
                    writeln!(
                        out,
                        r#"<path transform="scale(0.1)" d="M0 0{path}" fill="none" stroke-width="{width}" stroke-linecap="round" stroke-opacity="{opacity}" {stroke}/>"#
                    )?;
                }
                Ok(())
            }
        }
    }

    /// Draws the part of the grid within a band of the page, `top` pixels below the page's upper edge, and within `frame` (left, top, width
    /// and height on the page); a unit is `scale` pixels.
    pub(super) fn draw(&self, band: &mut Pixmap, colour: Colour, frame: [f64; 4], top: f64, scale: f64) {
        let [left, above, width, height] = frame.map(|part| part as f32);
        let scaled = Transform::from_row(scale as f32, 0.0, 0.0, scale as f32, 0.0, -top as f32);
        let shown = Rect::from_xywh(left, above, width, height).map(PathBuilder::from_rect);
        let Some((mut mask, shown)) = Mask::new(band.width(), band.height()).zip(shown) else { return };
        mask.fill_path(&shown, FillRule::Winding, true, scaled);
        let place = Transform::from_translate(left, above).post_concat(scaled);
        let strength = if let Self::Cells { strength, .. } = self { *strength } else { 1.0 };
        let seen = [top, top + f64::from(band.height())].map(|pixels| pixels / scale - frame[1]);
        for shade in 1..=SHADES {
            if let Some(path) = self.path(shade, seen) {
                let mut paint = Paint::default();
                let [red, green, blue] = colour.rgb();
                paint.set_color_rgba8(red, green, blue, (f64::from(alpha(shade)) * strength) as u8);
                band.fill_path(&path, &paint, FillRule::Winding, place, Some(&mask));
            }
        }
    }

    /// Outlines of the cells or dots of a shade within a range of heights; `None` if there are none.
    fn path(&self, shade: u8, [upper, lower]: [f64; 2]) -> Option<Path> {
        let mut path = PathBuilder::new();
        match self {
            Self::Cells { shades, place: [left, top, width, height], .. } => {
                let rows = shades.rows().len();
                let [across, down] = [width / shades.columns() as f64, height / rows as f64];
                let [first, last] = [upper, lower].map(|y| ((y - top) / down).max(0.0));
                let lines = first as usize..rows.min(last.ceil() as usize);
                for (line, row) in shades.rows().rev().enumerate().skip(lines.start).take(lines.len()) {
                    let [y, below] = [line, line + 1].map(|line| (top + down * line as f64) as f32);
                    let mut column = 0;
                    let cells: Vec<u8> = shades.cells(row).collect();
                    for run in cells.chunk_by(|one, other| (*one == shade) == (*other == shade)) {
                        let [x, right] =
                            [column, column + run.len()].map(|column| (left + across * column as f64) as f32);
                        column += run.len();
                        if run[0] == shade {
                            path.push_rect(Rect::from_ltrb(x, y, right, below)?);
                        }
                    }
                }
            }
            Self::Dots { at, size } => {
                let dots = at[usize::from(shade - 1)].iter().map(|dot| dot.map(|tenths| tenths as f64 / 10.0));
                for [x, y] in dots.filter(|[_, y]| upper - size < *y && *y < lower + size) {
                    path.push_circle(x as f32, y as f32, (size / 2.0) as f32);
                }
            }
        }
        path.finish()
    }
}

/// Encodes shades as a PNG in base 64; also returns whether it is reflected at its diagonal. Clouds over speeds form columns, which
/// compress better as rows.
fn image(shades: &Shades, colour: Colour) -> Result<(String, bool), png::EncodingError> {
    let size = [shades.columns(), shades.rows().len()];
    // Rows from above.
    let upright = encoded(size, shades.rows().rev().map(Cow::Borrowed), colour)?;
    let columns = (0..size[0]).map(|column| Cow::Owned(turned(shades, column)));
    let turned = encoded([size[1], size[0]], columns, colour)?;
    Ok(if turned.len() < upright.len() { (STANDARD.encode(turned), true) } else { (STANDARD.encode(upright), false) })
}

/// Column of the shades from above, two cells in a byte.
fn turned(shades: &Shades, column: usize) -> Vec<u8> {
    let mut packed = vec![0; shades.rows().len().div_ceil(2)];
    for (row, cells) in shades.rows().rev().enumerate() {
        let pair = cells[column / 2];
        let shade = if column.is_multiple_of(2) { pair >> 4 } else { pair & 15 };
        packed[row / 2] |= if row.is_multiple_of(2) { shade << 4 } else { shade };
    }
    packed
}

/// Encodes a PNG of one colour, with an opacity for each shade; two shades in a byte. Its rows are encoded one by one: an image takes a
/// megabyte.
fn encoded<'a>(
    [width, height]: [usize; 2],
    rows: impl Iterator<Item = Cow<'a, [u8]>>,
    colour: Colour,
) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Four);
    let alpha: Vec<u8> = (0..=SHADES).map(alpha).collect();
    encoder.set_palette(colour.rgb().repeat(alpha.len()));
    encoder.set_trns(alpha);
    encoder.set_compression(png::Compression::High);
    // Differences of shades compress worse than the shades.
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header()?;
    let mut stream = writer.stream_writer()?;
    for row in rows {
        stream.write_all(&row)?;
    }
    stream.finish()?;
    writer.finish()?;
    Ok(bytes)
}
