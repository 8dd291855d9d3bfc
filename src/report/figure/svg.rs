//! The figure as SVG: colours as attributes for white paper, and a style that changes them on a dark screen.
//!
//! No ids, so that several figures may stand in one page; data are clipped by nested `svg` elements.

use std::fmt::{self, Write};

use super::density::{Density, SHADES};
use super::layout::{Frame, Layout, MarkLine, SAMPLE, TEXT, TITLE, Text, WIDTH, share};
use super::{Colour, Data, Figure, Marker, Panel, Series, Stroke, thin};

/// Paper on a dark screen.
const DARK_PAPER: &str = "#15171a";
/// More points of a line than this are counted on a grid instead.
const MOST_POINTS: usize = 40_000;
/// More occupied cells than this are embedded as an image instead of as dots.
const MOST_DOTS: usize = 25_000;
/// Coordinates far outside the page are cut here.
const FAR: f64 = 1e5;

/// How a dense grid is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Dense {
    /// As an image, which bounds the size of the file.
    Embedded,
    /// As rectangles, for a renderer that reads no images.
    Outlined,
}

/// The figure as an SVG document.
pub fn render(figure: &Figure) -> Result<String, fmt::Error> {
    write(figure, Dense::Embedded)
}

pub(super) fn write(figure: &Figure, dense: Dense) -> Result<String, fmt::Error> {
    let layout = Layout::new(figure);
    let mut out = String::new();
    let height = layout.height;
    writeln!(
        out,
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="100%" role="img" font-family="sans-serif" font-size="{TEXT}">"#
    )?;
    writeln!(out, "<title>{}</title>", escaped(&figure.title))?;
    style(&mut out)?;
    writeln!(out, r##"<rect class="paper" width="{WIDTH}" height="{height}" fill="#ffffff"/>"##)?;
    writeln!(out, "<g {}>", fill(Colour::Ink))?;
    for line in &layout.title {
        let Text { at: [x, y], text } = line;
        writeln!(out, r#"<text x="{}" y="{}" font-size="{TITLE}">{}</text>"#, number(*x), number(*y), escaped(text))?;
    }
    for (panel, place) in figure.panels.iter().zip(&layout.panels) {
        self::panel(&mut out, panel, &layout, place, dense)?;
    }
    for mark in layout.marks.iter().filter(|mark| mark.inside) {
        leader(&mut out, mark, &layout)?;
    }
    if let Some(last) = layout.panels.last() {
        for tick in &layout.ticks {
            let x = last.frame.left + last.frame.width * share(tick.at, layout.range);
            let y = last.frame.bottom() + 4.0 + TEXT + 2.0;
            writeln!(
                out,
                r#"<text x="{}" y="{}" text-anchor="middle">{}</text>"#,
                number(x),
                number(y),
                escaped(&tick.label)
            )?;
        }
        text(&mut out, &layout.name)?;
    }
    for line in &layout.note {
        text(&mut out, line)?;
    }
    writeln!(out, "</g>\n</svg>")?;
    Ok(out)
}

fn style(out: &mut String) -> fmt::Result {
    write!(out, "<style>@media (prefers-color-scheme: dark) {{ .paper {{ fill: {DARK_PAPER} }}")?;
    for (class, _, dark) in Colour::ALL.map(Colour::shades) {
        write!(out, " .s-{class} {{ stroke: {dark} }} .f-{class} {{ fill: {dark} }}")?;
    }
    // An image has its colours inside.
    writeln!(out, " .dense {{ filter: invert(1) hue-rotate(180deg) }} }}</style>")
}

fn panel(
    out: &mut String,
    panel: &Panel,
    layout: &Layout,
    place: &super::layout::PanelLayout,
    dense: Dense,
) -> fmt::Result {
    let frame = &place.frame;
    let page = Page { width: frame.width, height: frame.height, x: layout.range, y: place.range, dense };
    let Frame { left, top, width, height } = frame;
    let [left, top, width, height] = [left, top, width, height].map(|part| number(*part));
    writeln!(out, r#"<svg x="{left}" y="{top}" width="{width}" height="{height}">"#)?;
    for mark in layout.marks.iter().filter(|mark| mark.inside) {
        let x = number(mark.at - frame.left);
        line(out, &format!("M{x} 0V{height}"), mark.label.is_some())?;
    }
    for (mark, place) in panel.marks.iter().zip(&place.marks).filter(|(_, place)| place.inside) {
        let y = number(place.at - frame.top);
        line(out, &format!("M0 {y}H{width}"), !mark.label.is_empty())?;
    }
    for series in &panel.series {
        page.series(out, series)?;
    }
    writeln!(out, "</svg>")?;
    let mut path = format!("M{left} {top}h{width}v{height}h-{width}z");
    for tick in &layout.ticks {
        write!(
            path,
            "M{} {}v4",
            number(frame.left + frame.width * share(tick.at, layout.range)),
            number(frame.bottom())
        )?;
    }
    for tick in &place.ticks {
        let y = frame.bottom() - frame.height * share(tick.at, place.range);
        write!(path, "M{left} {}h-4", number(y))?;
        let (x, base) = (number(frame.left - 7.0), number(y + 0.35 * TEXT));
        writeln!(out, r#"<text x="{x}" y="{base}" text-anchor="end">{}</text>"#, escaped(&tick.label))?;
    }
    for mark in place.marks.iter().filter(|mark| mark.inside) {
        if let Some(label) = &mark.label {
            let (from, to) = (number(mark.at), number(label.at[1] - 0.35 * TEXT));
            let leader = format!("M{} {from}L{} {to}", number(frame.right()), number(label.at[0] - 4.0));
            writeln!(out, r#"<path d="{leader}" fill="none" stroke-width="0.8" {}/>"#, stroke(Colour::Grey))?;
            text(out, label)?;
        }
    }
    writeln!(out, r#"<path d="{path}" fill="none" stroke-width="0.8" {}/>"#, stroke(Colour::Ink))?;
    text(out, &place.name)?;
    for (index, label) in &place.legend {
        let series = &panel.series[*index];
        sample(out, series, [label.at[0] - SAMPLE - 6.0, label.at[1] - 0.35 * TEXT])?;
        text(out, label)?;
    }
    if place.empty {
        let (x, y) = (number(frame.left + frame.width / 2.0), number(frame.top + frame.height / 2.0));
        writeln!(out, r#"<text x="{x}" y="{y}" text-anchor="middle">no data</text>"#)?;
    }
    Ok(())
}

fn text(out: &mut String, text: &Text) -> fmt::Result {
    let Text { at: [x, y], text } = text;
    writeln!(out, r#"<text x="{}" y="{}">{}</text>"#, number(*x), number(*y), escaped(text))
}

fn line(out: &mut String, path: &str, labelled: bool) -> fmt::Result {
    let dash = if labelled { r#" stroke-dasharray="2 3""# } else { "" };
    writeln!(out, r#"<path d="{path}" fill="none" stroke-width="0.8"{dash} {}/>"#, stroke(Colour::Grey))
}

/// The line from the first frame up to a label beside it.
fn leader(out: &mut String, mark: &MarkLine, layout: &Layout) -> fmt::Result {
    let Some((label, first)) = mark.label.as_ref().zip(layout.panels.first()) else { return Ok(()) };
    let (x, from, to) = (number(mark.at), number(first.frame.top), number(label.at[1] - 0.75 * TEXT));
    writeln!(out, r#"<path d="M{x} {from}V{to}" fill="none" stroke-width="0.8" {}/>"#, stroke(Colour::Grey))?;
    text(out, label)
}

/// A series in the legend.
fn sample(out: &mut String, series: &Series, [x, y]: [f64; 2]) -> fmt::Result {
    let across = format!("M{} {}h{SAMPLE}", number(x), number(y));
    let colour = series.colour;
    match &series.data {
        Data::Line { stroke, .. } => stroked(out, &across, *stroke, colour),
        Data::Area { stroke, .. } => {
            let block = format!("M{} {}h{SAMPLE}v8h-{SAMPLE}z", number(x), number(y - 1.5));
            writeln!(out, r#"<path d="{block}" fill-opacity="0.22" {}/>"#, fill(colour))?;
            stroked(out, &format!("M{} {}h{SAMPLE}", number(x), number(y - 1.5)), *stroke, colour)
        }
        Data::Points { marker, .. } => {
            let tip = if *marker == Marker::Below { y - 3.0 } else { y };
            markers(out, &[[x + SAMPLE / 2.0, tip]], *marker, colour)
        }
        Data::Density(_) => {
            let dots = [0.2, 0.5, 0.8].map(|share| [x + share * SAMPLE, y]);
            markers(out, &dots, Marker::Dot, colour)
        }
    }
}

fn stroked(out: &mut String, path: &str, how: Stroke, colour: Colour) -> fmt::Result {
    let (width, dash) = match how {
        Stroke::Thin => (0.9, ""),
        Stroke::Solid => (1.5, ""),
        Stroke::Dashed => (1.5, r#" stroke-dasharray="6 3""#),
        Stroke::Thick => (4.5, ""),
    };
    let colour = stroke(colour);
    writeln!(out, r#"<path d="{path}" fill="none" stroke-width="{width}" stroke-linejoin="round"{dash} {colour}/>"#)
}

fn markers(out: &mut String, points: &[[f64; 2]], marker: Marker, colour: Colour) -> fmt::Result {
    let shape = match marker {
        Marker::Dot => "h0",
        Marker::Ring => "m-2.4 0a2.4 2.4 0 1 0 4.8 0a2.4 2.4 0 1 0 -4.8 0z",
        Marker::Below => "m0 1.5l3.2 5.5h-6.4z",
    };
    let mut path = String::new();
    for [x, y] in points {
        write!(path, "M{} {}{shape}", number(*x), number(*y))?;
    }
    let (stroke, fill) = (stroke(colour), fill(colour));
    match marker {
        Marker::Dot => writeln!(out, r#"<path d="{path}" stroke-width="3.4" stroke-linecap="round" {stroke}/>"#),
        Marker::Ring => writeln!(out, r#"<path d="{path}" fill="none" stroke-width="1" {stroke}/>"#),
        Marker::Below => writeln!(out, r#"<path d="{path}" {fill}/>"#),
    }
}

fn stroke(colour: Colour) -> String {
    let (class, light, _) = colour.shades();
    format!(r#"class="s-{class}" stroke="{light}""#)
}

fn fill(colour: Colour) -> String {
    let (class, light, _) = colour.shades();
    format!(r#"class="f-{class}" fill="{light}""#)
}

/// Text that XML takes for text; characters that it has no place for are left out.
pub fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\t' | '\n' | '\r' => escaped.push(' '),
            '\u{fffe}' | '\u{ffff}' => {}
            letter if letter.is_control() => {}
            letter => escaped.push(letter),
        }
    }
    escaped
}

/// A coordinate with two decimals, without trailing zeros.
fn number(value: f64) -> String {
    let text = format!("{:.2}", value.clamp(-FAR, FAR));
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

/// The inside of a frame, its upper left corner at the origin.
struct Page {
    width: f64,
    height: f64,
    x: [f64; 2],
    y: [f64; 2],
    dense: Dense,
}

impl Page {
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let at = [self.width * share(x, self.x), self.height * (1.0 - share(y, self.y))];
        if at.iter().all(|part| part.is_finite()) { at.map(|part| part.clamp(-FAR, FAR)) } else { [f64::NAN; 2] }
    }

    fn series(&self, out: &mut String, series: &Series) -> fmt::Result {
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
            for pair in points.windows(2).filter(|pair| pair.iter().all(|point| !self.at(*point)[0].is_nan())) {
                grid.join(pair[0], pair[1]);
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
    0.4 + 0.6 * f64::from(shade - 1) / f64::from(SHADES - 1)
}
