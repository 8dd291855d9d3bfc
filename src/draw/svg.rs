//! The figure as SVG: colours as attributes for white paper, and a style that changes them on a dark screen.
//!
//! No ids, so that several figures may stand in one page; data are clipped by nested `svg` elements.

use std::fmt::{self, Write};

use super::layout::{Frame, Layout, MarkLine, SAMPLE, TEXT, TITLE, Text, WIDTH, share};
use super::series::Page;
use super::sheet::{Layer, Sheet};
use super::{Colour, Data, Figure, Marker, Panel, Series, Stroke};

/// Paper on a dark screen.
const DARK_PAPER: &str = "#15171a";
/// An image has its colours inside: on a dark screen light and dark change places, hues stay.
const DARK_IMAGE: &str = "invert(1) hue-rotate(180deg)";
/// Coordinates far outside the page are cut here.
pub(super) const FAR: f64 = 1e5;

/// The figure as an SVG document.
pub fn render(figure: &Figure) -> Result<String, fmt::Error> {
    let drawings = write(figure, false)?.into_iter().filter_map(|layer| match layer {
        Layer::Drawing(text) => Some(text),
        Layer::Grid(..) => None,
    });
    Ok(drawings.collect())
}

/// The figure in layers, dense grids among them if they are to stand `apart`, else one document.
pub(super) fn write(figure: &Figure, apart: bool) -> Result<Vec<Layer>, fmt::Error> {
    let layout = Layout::new(figure);
    let height = layout.height;
    let page = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="100%" role="img" font-family="sans-serif" font-size="{TEXT}">"#
    );
    let ink = format!("<g {}>", fill(Colour::Ink));
    let mut out = Sheet::new(format!("{page}\n{ink}\n"), apart);
    writeln!(out, "{page}\n<title>{}</title>", escaped(&figure.title))?;
    style(&mut out)?;
    writeln!(out, r##"<rect class="paper" width="{WIDTH}" height="{height}" fill="#ffffff"/>"##)?;
    writeln!(out, "{ink}")?;
    for line in &layout.title {
        let Text { at: [x, y], text } = line;
        writeln!(out, r#"<text x="{}" y="{}" font-size="{TITLE}">{}</text>"#, number(*x), number(*y), escaped(text))?;
    }
    for (panel, place) in figure.panels.iter().zip(&layout.panels) {
        self::panel(&mut out, panel, &layout, place)?;
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
    Ok(out.layers())
}

fn style(out: &mut Sheet) -> fmt::Result {
    write!(out, "<style>@media screen and (prefers-color-scheme: dark) {{ .paper {{ fill: {DARK_PAPER} }}")?;
    for (class, _, dark) in Colour::ALL.map(Colour::shades) {
        write!(out, " .s-{class} {{ stroke: {dark} }} .f-{class} {{ fill: {dark} }}")?;
    }
    writeln!(out, " .halo {{ stroke: {DARK_PAPER} }} .dense {{ filter: {DARK_IMAGE} }} }}</style>")
}

fn panel(out: &mut Sheet, panel: &Panel, layout: &Layout, place: &super::layout::PanelLayout) -> fmt::Result {
    let frame = &place.frame;
    let page = Page { width: frame.width, height: frame.height, x: layout.range, y: place.range };
    let Frame { left, top, width, height } = *frame;
    out.open_frame([left, top, width, height]);
    let [left, top, width, height] = [left, top, width, height].map(number);
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

fn text(out: &mut Sheet, text: &Text) -> fmt::Result {
    let Text { at: [x, y], text } = text;
    writeln!(out, r#"<text x="{}" y="{}">{}</text>"#, number(*x), number(*y), escaped(text))
}

fn line(out: &mut Sheet, path: &str, labelled: bool) -> fmt::Result {
    let dash = if labelled { r#" stroke-dasharray="2 3""# } else { "" };
    writeln!(out, r#"<path d="{path}" fill="none" stroke-width="0.8"{dash} {}/>"#, stroke(Colour::Grey))
}

/// The line from the first frame up to a label beside it.
fn leader(out: &mut Sheet, mark: &MarkLine, layout: &Layout) -> fmt::Result {
    let Some((label, first)) = mark.label.as_ref().zip(layout.panels.first()) else { return Ok(()) };
    let (x, from, to) = (number(mark.at), number(first.frame.top), number(label.at[1] - 0.75 * TEXT));
    writeln!(out, r#"<path d="M{x} {from}V{to}" fill="none" stroke-width="0.8" {}/>"#, stroke(Colour::Grey))?;
    text(out, label)
}

/// A series in the legend.
fn sample(out: &mut Sheet, series: &Series, [x, y]: [f64; 2]) -> fmt::Result {
    let across = format!("M{} {}h{SAMPLE}", number(x), number(y));
    let colour = series.colour;
    match &series.data {
        Data::Line { stroke, .. } | Data::Arrow { stroke, .. } => stroked(out, &across, *stroke, colour),
        Data::Words(_) => Ok(()),
        Data::Region { strength, .. } => {
            let block = format!("M{} {}h{SAMPLE}v10h-{SAMPLE}z", number(x), number(y - 5.0));
            writeln!(out, r#"<path d="{block}" fill-opacity="{}" {}/>"#, number(*strength), fill(colour))
        }
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

pub(super) fn stroked(out: &mut Sheet, path: &str, how: Stroke, colour: Colour) -> fmt::Result {
    let (width, dash) = match how {
        Stroke::Thin => (0.9, ""),
        Stroke::Solid => (1.5, ""),
        Stroke::Dashed => (1.5, r#" stroke-dasharray="6 3""#),
        Stroke::Dotted => (1.5, r#" stroke-dasharray="1.5 2.5""#),
        Stroke::Thick => (4.5, ""),
    };
    let colour = stroke(colour);
    writeln!(out, r#"<path d="{path}" fill="none" stroke-width="{width}" stroke-linejoin="round"{dash} {colour}/>"#)
}

pub(super) fn markers(out: &mut Sheet, points: &[[f64; 2]], marker: Marker, colour: Colour) -> fmt::Result {
    let shape = match marker {
        Marker::Dot | Marker::Disc => "h0",
        Marker::SmallRing => "m-1.4 0a1.4 1.4 0 1 0 2.8 0a1.4 1.4 0 1 0 -2.8 0z",
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
        Marker::Disc => writeln!(out, r#"<path d="{path}" stroke-width="6.4" stroke-linecap="round" {stroke}/>"#),
        Marker::SmallRing => writeln!(out, r#"<path d="{path}" fill="none" stroke-width="0.6" {stroke}/>"#),
        Marker::Ring => writeln!(out, r#"<path d="{path}" fill="none" stroke-width="1" {stroke}/>"#),
        Marker::Below => writeln!(out, r#"<path d="{path}" {fill}/>"#),
    }
}

pub(super) fn stroke(colour: Colour) -> String {
    let (class, light, _) = colour.shades();
    format!(r#"class="s-{class}" stroke="{light}""#)
}

pub(super) fn fill(colour: Colour) -> String {
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
pub(super) fn number(value: f64) -> String {
    let text = format!("{:.2}", value.clamp(-FAR, FAR));
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}
