//! Contents of a frame: each series as SVG, with no more bytes than print or a page can show.

use std::fmt::{self, Write};

use super::density::{Density, SHADES, Shades};
use super::element::{FAR, fill, markers, number, polyline, rim, stroke_width, stroked};
use super::grid::Grid;
use super::layout::{Frame, PanelLayout, share};
use super::sheet::{Host, Sheet};
use super::{BREAK, Colour, Data, Marker, Series, Stroke, thin, words};

/// Largest number of points of a line; a longer line is counted on a grid instead.
const MOST_POINTS: usize = 40_000;
/// Largest total number of cells along a line counted on a grid: a second of work.
const MOST_STEPS: usize = 100_000_000;
impl Host {
    /// Largest number of occupied cells that are drawn as dots; with more, an image is embedded. In a page an image replaces dots as soon
    /// as they are nearly as small as the cells: it has a fourth of the bytes.
    fn most_dots(self) -> usize {
        match self {
            Self::File => 25_000,
            Self::Page => 2500,
        }
    }

    /// Number of parts of a unit to which lines are rounded: a tenth is a fortieth of a millimetre on paper.
    fn parts(self) -> f64 {
        match self {
            Self::File => 100.0,
            Self::Page => 10.0,
        }
    }
}

/// Diameter of the dots for this number of occupied cells. A machine with few motions has some hundred; smaller dots would vanish in print.
pub fn dot_size(cells: usize) -> f64 {
    match cells {
        ..40 => 5.0,
        40..400 => 3.4,
        400..2500 => 2.4,
        2500..6000 => 1.7,
        _ => 1.25,
    }
}

/// Contents of a frame, with its upper left corner at the origin.
pub(super) struct Page {
    pub(super) width: f64,
    pub(super) height: f64,
    pub(super) x: [f64; 2],
    pub(super) y: [f64; 2],
    /// Whether lines, and markers, have a rim in the colour of the paper, because regions are behind them, or thick lines behind markers.
    pub(super) is_rimmed: [bool; 2],
}

impl Page {
    pub(super) fn new(place: &PanelLayout, is_rimmed: [bool; 2]) -> Self {
        let Frame { width, height, .. } = place.frame;
        Self { width, height, x: place.across.range, y: place.range, is_rimmed }
    }

    /// Points through which a line is drawn, with its breaks.
    pub(super) fn thinned(&self, points: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let value = |share: f64, [low, high]: [f64; 2]| low + share * (high - low);
        let mut kept = Vec::new();
        for stroke in thin::strokes(points.iter().map(|point| self.at(*point)), MOST_POINTS) {
            kept.extend((!kept.is_empty()).then_some(BREAK));
            kept.extend(
                stroke.iter().map(|[x, y]| [value(x / self.width, self.x), value(1.0 - y / self.height, self.y)]),
            );
        }
        kept
    }

    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let at = [self.width * share(x, self.x), self.height * (1.0 - share(y, self.y))];
        if at.iter().all(|part| part.is_finite()) { at.map(|part| part.clamp(-FAR, FAR)) } else { [f64::NAN; 2] }
    }

    pub(super) fn series(&self, out: &mut Sheet, series: &Series) -> fmt::Result {
        let colour = series.colour;
        match &series.data {
            Data::Line { points, stroke } => self.line(out, points, *stroke, colour, false),
            Data::Area { points, stroke } => self.line(out, points, *stroke, colour, true),
            Data::Arrow { points, stroke } => {
                self.line(out, points, *stroke, colour, false)?;
                self.heads(out, points, colour)
            }
            Data::Band { edges } => self.band(out, edges, colour),
            Data::Points { points, marker } => self.points(out, points, *marker, colour),
            Data::Words(words) => words
                .iter()
                .try_for_each(|word| words::write(out, word, self.at(word.at), [self.width, self.height], colour)),
            Data::Density(density) => self.density(out, density, colour),
            Data::Region { cells, .. } if cells.occupied() == 0 => Ok(()),
            Data::Region { cells, strength } => {
                out.grid(self.cells(cells, cells.shades(true).solid(), *strength), colour)
            }
        }
    }

    fn line(&self, out: &mut Sheet, points: &[[f64; 2]], how: Stroke, colour: Colour, filled: bool) -> fmt::Result {
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
            polyline(&mut path, stroke.iter().copied(), out.host().parts());
            if let (true, Some(first), Some(last)) = (filled, stroke.first(), stroke.last()) {
                let floor = number(self.height + 2.0);
                write!(area, "{path}L{} {floor}L{} {floor}z", number(last[0]), number(first[0]))?;
            }
            edge.push_str(&path);
        }
        if !area.is_empty() {
            writeln!(out, r#"<path d="{area}" fill-opacity="0.22" {}/>"#, fill(colour))?;
        }
        if edge.is_empty() {
            return Ok(());
        }
        if self.is_rimmed[0] {
            rim(out, &edge, stroke_width(how))?;
        }
        stroked(out, &edge, how, colour)
    }

    /// Draws the area between two lines, with a thin edge so that a narrow band is visible beside the line in its middle.
    fn band(&self, out: &mut Sheet, edges: &[[f64; 3]], colour: Colour) -> fmt::Result {
        let side = |index: usize| move |edge: &[f64; 3]| self.at([edge[0], edge[index]]);
        let mut path = String::new();
        for run in edges.split(|edge| edge.iter().any(|part| part.is_nan())).filter(|run| !run.is_empty()) {
            let around = run.iter().map(side(1)).chain(run.iter().rev().map(side(2))).filter(|at| !at[0].is_nan());
            polyline(&mut path, around, out.host().parts());
            path.push('z');
        }
        if path.len() < 2 {
            return Ok(());
        }
        let (class, light, _) = colour.shades();
        let look = format!(r#"class="f-{class} s-{class}" fill="{light}" stroke="{light}""#);
        writeln!(out, r#"<path d="{path}" fill-opacity="0.35" stroke-opacity="0.6" stroke-width="0.8" {look}/>"#)
    }

    /// Draws an arrowhead at the end of each run of a line.
    fn heads(&self, out: &mut Sheet, points: &[[f64; 2]], colour: Colour) -> fmt::Result {
        const LENGTH: f64 = 9.0;
        const HALF: f64 = 3.2;
        let mut path = String::new();
        let places: Vec<[f64; 2]> = points.iter().map(|point| self.at(*point)).collect();
        for run in places.split(|place| place[0].is_nan()) {
            let Some(tip) = run.last() else { continue };
            let away = |place: &[f64; 2]| [tip[0] - place[0], tip[1] - place[1]];
            // Direction of the last part that is about as long as the head.
            let along = run.iter().rev().map(away).find(|[x, y]| libm::hypot(*x, *y) >= 0.7 * LENGTH);
            let Some([x, y]) = along.or_else(|| run.first().map(away)) else { continue };
            let length = libm::hypot(x, y);
            if length > 0.0 {
                let ([x, y], [back, side]) = ([x / length, y / length], [LENGTH, HALF]);
                let foot = [tip[0] - back * x, tip[1] - back * y];
                let (one, other) = ([foot[0] - side * y, foot[1] + side * x], [foot[0] + side * y, foot[1] - side * x]);
                let [tip, one, other] = [*tip, one, other].map(|place| place.map(number).join(" "));
                write!(path, "M{tip}L{one}L{other}z")?;
            }
        }
        if path.is_empty() { Ok(()) } else { writeln!(out, r#"<path d="{path}" {}/>"#, fill(colour)) }
    }

    fn points(&self, out: &mut Sheet, points: &[[f64; 2]], marker: Marker, colour: Colour) -> fmt::Result {
        let mut places: Vec<[f64; 2]> = Vec::new();
        let on_page = |at: &[f64; 2]| at[0].abs() <= 2.0 * self.width && at[1].abs() <= 2.0 * self.height;
        for at in points.iter().map(|point| self.at(*point)).filter(on_page) {
            let at = at.map(|part| (2.0 * part).round() / 2.0);
            // Markers at the same point are drawn once.
            if places.last() != Some(&at) {
                places.push(at);
            }
            if places.len() > MOST_POINTS {
                let mut grid = Density::new(self.x, self.y);
                points.iter().for_each(|[x, y]| grid.push(*x, *y));
                return self.density(out, &grid, colour);
            }
        }
        if places.is_empty() { Ok(()) } else { markers(out, &places, (marker, colour), self.is_rimmed[1]) }
    }

    fn density(&self, out: &mut Sheet, density: &Density, colour: Colour) -> fmt::Result {
        match density.occupied() {
            0 => Ok(()),
            cells if cells <= out.host().most_dots() => out.grid(self.dots(density, cells), colour),
            _ => out.grid(self.cells(density, density.shades(true), 1.0), colour),
        }
    }

    /// Draws few cells as one dot each.
    fn dots(&self, density: &Density, cells: usize) -> Grid {
        let [x, y] = density.ranges();
        let [columns, rows] = density.cells();
        let mut at = [const { Vec::new() }; SHADES as usize];
        let shades = density.shades(false);
        let all = shades.rows().flat_map(|row| shades.cells(row)).enumerate();
        for (cell, shade) in all.filter(|(_, shade)| *shade > 0) {
            let middle = |index: usize, count: usize, [low, high]: [f64; 2]| {
                low + (high - low) * (index as f64 + 0.5) / count as f64
            };
            let dot = self.at([middle(cell % columns, columns, x), middle(cell / columns, rows, y)]);
            at[usize::from(shade - 1)].push(dot.map(|part| (10.0 * part).round() as i64));
        }
        // Clouds over speeds form columns: steps along these are shortest.
        at.iter_mut().for_each(|dots| dots.sort_unstable());
        Grid::Dots { at, size: dot_size(cells) }
    }

    /// Draws many cells as the grid itself, stretched over the frame.
    fn cells(&self, density: &Density, shades: Shades, strength: f64) -> Grid {
        let [x, y] = density.ranges();
        let ([left, top], [right, bottom]) = (self.at([x[0], y[1]]), self.at([x[1], y[0]]));
        let place = [left, top, right - left, bottom - top];
        Grid::Cells { shades, place, strength }
    }
}
