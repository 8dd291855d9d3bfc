//! The inside of a frame: each series as SVG, with no more bytes than print can show.

use std::fmt::{self, Write};

use super::density::{Density, SHADES};
use super::layout::share;
use super::svg::{Dense, FAR, fill, markers, number, stroke, stroked};
use super::{Colour, Data, Marker, Series, Stroke, thin};

/// More points of a line than this are counted on a grid instead.
const MOST_POINTS: usize = 40_000;
/// Cells that a line counted on a grid may pass in all: a second of work.
const MOST_STEPS: usize = 100_000_000;
/// More occupied cells than this are embedded as an image instead of as dots.
const MOST_DOTS: usize = 25_000;

/// The inside of a frame, its upper left corner at the origin.
pub(super) struct Page {
    pub(super) width: f64,
    pub(super) height: f64,
    pub(super) x: [f64; 2],
    pub(super) y: [f64; 2],
    pub(super) dense: Dense,
}

impl Page {
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let at = [self.width * share(x, self.x), self.height * (1.0 - share(y, self.y))];
        if at.iter().all(|part| part.is_finite()) { at.map(|part| part.clamp(-FAR, FAR)) } else { [f64::NAN; 2] }
    }

    pub(super) fn series(&self, out: &mut String, series: &Series) -> fmt::Result {
        let colour = series.colour;
        match &series.data {
            Data::Line { points, stroke } => self.line(out, points, *stroke, colour, false),
            Data::Area { points, stroke } => self.line(out, points, *stroke, colour, true),
            Data::Points { points, marker } => self.points(out, points, *marker, colour),
            Data::Density(density) => self.density(out, density, colour),
        }
    }

    fn line(&self, out: &mut String, points: &[[f64; 2]], how: Stroke, colour: Colour, filled: bool) -> fmt::Result {
        let strokes = thin::strokes(points.iter().map(|point| self.at(*point)), MOST_POINTS);
        if strokes.iter().map(Vec::len).sum::<usize>() > MOST_POINTS {
            let mut grid = Density::new(self.x, self.y);
            let most = MOST_STEPS / points.len();
            for pair in points.windows(2).filter(|pair| pair.iter().all(|point| !self.at(*point)[0].is_nan())) {
                grid.join(pair[0], pair[1], most);
            }
            return self.density(out, &grid, colour);
        }
        let (mut edge, mut area) = (String::new(), String::new());
        for stroke in strokes {
            let mut path = String::new();
            for (index, [x, y]) in stroke.iter().enumerate() {
                write!(path, "{}{} {}", if index == 0 { 'M' } else { 'L' }, number(*x), number(*y))?;
            }
            if let (true, Some(first), Some(last)) = (filled, stroke.first(), stroke.last()) {
                let floor = number(self.height + 2.0);
                write!(area, "{path}L{} {floor}L{} {floor}z", number(last[0]), number(first[0]))?;
            }
            // A single point has no length to be stroked along.
            edge.push_str(&path);
            if stroke.len() == 1 {
                edge.push_str("h0.01");
            }
        }
        if !area.is_empty() {
            writeln!(out, r#"<path d="{area}" fill-opacity="0.22" {}/>"#, fill(colour))?;
        }
        if edge.is_empty() { Ok(()) } else { stroked(out, &edge, how, colour) }
    }

    fn points(&self, out: &mut String, points: &[[f64; 2]], marker: Marker, colour: Colour) -> fmt::Result {
        let mut places: Vec<[f64; 2]> = Vec::new();
        let on_page = |at: &[f64; 2]| at[0].abs() <= 2.0 * self.width && at[1].abs() <= 2.0 * self.height;
        for at in points.iter().map(|point| self.at(*point)).filter(on_page) {
            let at = at.map(|part| (2.0 * part).round() / 2.0);
            // Markers on one spot are one marker.
            if places.last() != Some(&at) {
                places.push(at);
            }
            if places.len() > MOST_POINTS {
                let mut grid = Density::new(self.x, self.y);
                points.iter().for_each(|[x, y]| grid.push(*x, *y));
                return self.density(out, &grid, colour);
            }
        }
        if places.is_empty() { Ok(()) } else { markers(out, &places, marker, colour) }
    }

    fn density(&self, out: &mut String, density: &Density, colour: Colour) -> fmt::Result {
        match density.occupied() {
            0 => Ok(()),
            cells if cells <= MOST_DOTS => self.dots(out, density, cells, colour),
            _ => self.cells(out, density, colour),
        }
    }

    /// Few cells: a dot each, larger where there are fewer.
    fn dots(&self, out: &mut String, density: &Density, cells: usize, colour: Colour) -> fmt::Result {
        let [x, y] = density.ranges();
        let [columns, rows] = density.cells();
        let shades = density.shades(false);
        let size = if cells < 4000 { 1.7 } else { 1.25 };
        for shade in 1..=SHADES {
            let (mut path, mut last) = (String::new(), [0_i64; 2]);
            for (cell, _) in shades.iter().enumerate().filter(|(_, found)| **found == shade) {
                let middle = |index: usize, count: usize, [low, high]: [f64; 2]| {
                    low + (high - low) * (index as f64 + 0.5) / count as f64
                };
                let at = self.at([middle(cell % columns, columns, x), middle(cell / columns, rows, y)]);
                // Tenths of a unit, from the dot before: half the bytes, and no error adds up.
                let tenths = at.map(|part| (10.0 * part).round() as i64);
                write!(path, "m{} {}h0", tenths[0] - last[0], tenths[1] - last[1])?;
                last = tenths;
            }
            if !path.is_empty() {
                let (width, opacity) = (10.0 * size, number(opacity(shade)));
                let stroke = stroke(colour);
                writeln!(
                    out,
                    r#"<path transform="scale(0.1)" d="M0 0{path}" fill="none" stroke-width="{width}" stroke-linecap="round" stroke-opacity="{opacity}" {stroke}/>"#
                )?;
            }
        }
        Ok(())
    }

    /// Many cells: the grid itself, stretched over the frame.
    fn cells(&self, out: &mut String, density: &Density, colour: Colour) -> fmt::Result {
        let [x, y] = density.ranges();
        let [columns, rows] = density.cells();
        let shades = density.shades(true);
        let ([left, top], [right, bottom]) = (self.at([x[0], y[1]]), self.at([x[1], y[0]]));
        if self.dense == Dense::Embedded {
            let image = super::png::grid(&shades, columns, colour, opacity).map_err(|_| fmt::Error)?;
            let [left, top, width, height] = [left, top, right - left, bottom - top].map(number);
            return writeln!(
                out,
                r#"<image class="dense" x="{left}" y="{top}" width="{width}" height="{height}" preserveAspectRatio="none" href="data:image/png;base64,{image}"/>"#
            );
        }
        let (across, up) = ((right - left) / columns as f64, (bottom - top) / rows as f64);
        writeln!(out, r#"<g transform="translate({left} {top}) scale({across} {up})">"#)?;
        for shade in 1..=SHADES {
            let mut path = String::new();
            for (row, cells) in shades.chunks(columns).enumerate() {
                let mut column = 0;
                for run in cells.chunk_by(|one, other| (*one == shade) == (*other == shade)) {
                    if run[0] == shade {
                        let length = run.len();
                        write!(path, "M{column} {}h{length}v1h-{length}z", rows - 1 - row)?;
                    }
                    column += run.len();
                }
            }
            if !path.is_empty() {
                let opacity = number(opacity(shade));
                writeln!(out, r#"<path d="{path}" fill-opacity="{opacity}" {}/>"#, fill(colour))?;
            }
        }
        writeln!(out, "</g>")
    }
}

/// Of a shade: the faintest is still seen in print.
fn opacity(shade: u8) -> f64 {
    0.5 + 0.5 * f64::from(shade - 1) / f64::from(SHADES - 1)
}
