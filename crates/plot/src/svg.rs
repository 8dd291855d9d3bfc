//! Figures as SVG: colours as attributes for white paper, and a style that changes them on a dark screen.
//!
//! The document has no ids, so that several figures fit into one page; nested `svg` elements clip the data.

use std::fmt::{self, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use resvg::usvg::fontdb::{Database, ID};

use super::element::{escaped, fill, markers, number, stroke, stroke_width, stroked};
use super::font::{Glyphs, cut, used};
use super::layout::{Frame, Layout, MarkLine, PanelLayout, SAMPLE, TEXT, TITLE, Text, share};
use super::look::{Look, Theme};
use super::series::Page;
use super::sheet::{Host, Layer, Sheet};
use super::{Colour, Data, Figure, Marker, Panel, Series};

/// Width of strokes above which a marker on the stroke would be invisible.
const THICK: f64 = 3.0;
/// Colour of the paper on a dark screen.
const DARK_PAPER: &str = "#15171a";
/// Filter for images, whose colours are fixed: on a dark screen, light and dark are exchanged, and hues are unchanged.
const DARK_IMAGE: &str = "invert(1) hue-rotate(180deg)";

/// Reason why there is no SVG.
#[derive(Debug, thiserror::Error)]
pub enum SvgError {
    /// SVG that could not be written.
    #[error("the figure could not be written as SVG: {0}")]
    Svg(#[from] fmt::Error),
    /// SVG that could not be read to find its letters.
    #[error("the figure's SVG could not be read: {0}")]
    Read(#[from] resvg::usvg::Error),
}

/// Renders the figure as an SVG document.
pub fn render(figure: &Figure, look: &Look) -> Result<String, SvgError> {
    const HEAD: &str = "</title>\n";
    let own = document(figure, look)?;
    match &look.fonts {
        Some(fonts) => {
            let tree = fonts.tree(&own)?;
            let letters = format!("{HEAD}<style>{}</style>\n", letters(tree.fontdb(), used(&tree))?.trim_end());
            Ok(own.replacen(HEAD, &letters, 1))
        }
        None => Ok(own),
    }
}

/// Renders the figure for a page that has the [`page_style`] of all its figures: without separate fonts and dark colours, with denser
/// clouds as images, and with the ranges of its frames.
pub fn inset(figure: &Figure, look: &Look) -> Result<String, SvgError> {
    Ok(whole(write(figure, look, false, Host::Page)?))
}

/// Style of a page's figures: their fonts, each once, and their colours on a dark screen.
pub fn page_style<'a>(look: &Look, insets: impl IntoIterator<Item = &'a str>) -> Result<String, SvgError> {
    let mut style = if look.theme == Theme::Screen { dark_screen() } else { String::new() };
    let Some(fonts) = &look.fonts else { return Ok(style) };
    let mut all: Vec<(ID, Glyphs)> = Vec::new();
    let mut database = None;
    for inset in insets {
        let tree = fonts.tree(inset)?;
        for (id, glyphs) in used(&tree) {
            match all.iter_mut().find(|(other, _)| *other == id) {
                Some((_, known)) => known.extend(glyphs),
                None => all.push((id, glyphs)),
            }
        }
        database = Some(std::sync::Arc::clone(tree.fontdb()));
    }
    if let Some(database) = database {
        style.push_str(letters(&database, all)?.trim_end());
    }
    Ok(style)
}

/// Fonts reduced to the glyphs of the figures, for a style.
fn letters(database: &Database, used: Vec<(ID, Glyphs)>) -> Result<String, fmt::Error> {
    let mut faces = String::new();
    for (id, glyphs) in used {
        let name = database.face(id).and_then(|face| Some(face.families.first()?.0.clone())).unwrap_or_default();
        let face = database.with_face_data(id, |data, index| cut(data, index, &glyphs)).flatten();
        if let Some(face) = face {
            let (name, data) = (escaped(&name), STANDARD.encode(face.data));
            write!(faces, "@font-face {{ font-family: '{name}'; src: url(data:font/ttf;base64,{data}) }} ")?;
        }
    }
    Ok(faces)
}

/// Renders the document without embedded fonts.
pub(super) fn document(figure: &Figure, look: &Look) -> Result<String, fmt::Error> {
    Ok(whole(write(figure, look, false, Host::File)?))
}

/// Text of the drawings among layers.
fn whole(layers: Vec<Layer>) -> String {
    let drawings = layers.into_iter().filter_map(|layer| match layer {
        Layer::Drawing(text) => Some(text),
        Layer::Grid(..) => None,
    });
    drawings.collect()
}

/// Writes the figure in layers, separate from dense grids if `apart` is set, else as one document.
pub(super) fn write(figure: &Figure, look: &Look, apart: bool, host: Host) -> Result<Vec<Layer>, fmt::Error> {
    let wide = look.across();
    let layout = Layout::new(figure, look);
    let height = layout.height;
    // The renderer scales separate layers.
    let size = match look.is_sized() && !apart {
        true => format!(r#"width="{}pt" height="{}pt""#, number(look.points()), number(look.points() * height / wide)),
        false => r#"width="100%""#.into(),
    };
    let family = look.fonts.as_ref().map(|fonts| format!("'{}', ", escaped(fonts.family()))).unwrap_or_default();
    // A title in a page would hide the values under the pointer.
    let named = match host {
        Host::File => String::new(),
        Host::Page => format!(r#" aria-label="{}""#, escaped(&figure.title)),
    };
    let page = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {height}" {size} role="img"{named} font-family="{family}sans-serif" font-size="{TEXT}">"#
    );
    let ink = format!("<g {}>", fill(Colour::Ink));
    let mut out = Sheet::new(format!("{page}\n{ink}\n"), apart, host);
    writeln!(out, "{page}")?;
    if host == Host::File {
        writeln!(out, "<title>{}</title>", escaped(&figure.title))?;
    }
    if look.theme == Theme::Screen && host == Host::File {
        writeln!(out, "<style>{}</style>", dark_screen())?;
    }
    writeln!(out, r##"<rect class="paper" width="{wide}" height="{height}" fill="#ffffff"/>"##)?;
    writeln!(out, "{ink}")?;
    for line in &layout.title {
        text(&mut out, line.at, &format!(r#" font-size="{TITLE}""#), &line.text)?;
    }
    for (panel, place) in figure.panels.iter().zip(&layout.panels) {
        self::panel(&mut out, panel, &layout, place)?;
    }
    for mark in layout.marks.iter().filter(|mark| mark.inside) {
        leader(&mut out, mark, &layout)?;
    }
    for (frame, across) in layout.panels.iter().map(|place| (&place.frame, &place.across)) {
        let Some(name) = &across.name else { continue };
        for tick in &across.ticks {
            let x = frame.left + frame.width * share(tick.at, across.range);
            let y = frame.bottom() + 4.0 + TEXT + 2.0;
            text(&mut out, [x, y], r#" text-anchor="middle""#, &tick.label)?;
        }
        label(&mut out, name)?;
    }
    layout.note.iter().try_for_each(|line| label(&mut out, line))?;
    writeln!(out, "</g>\n</svg>")?;
    Ok(out.layers())
}

/// Style of colours on a dark screen.
fn dark_screen() -> String {
    let colours = Colour::ALL.map(Colour::shades);
    let colours = colours
        .map(|(class, _, dark)| format!(" .s-{class} {{ stroke: {dark} }} .f-{class} {{ fill: {dark} }}"))
        .concat();
    format!(
        "@media screen and (prefers-color-scheme: dark) {{ .paper {{ fill: {DARK_PAPER} }}{colours} .halo {{ stroke: {DARK_PAPER} }} \
         .dense {{ filter: {DARK_IMAGE} }} }}"
    )
}

fn panel(out: &mut Sheet, panel: &Panel, layout: &Layout, place: &PanelLayout) -> fmt::Result {
    let frame = &place.frame;
    let over_regions = panel.series.iter().any(|series| matches!(series.data, Data::Region { .. }));
    let is_thick = |series: &Series| series.data.style().1.is_some_and(|stroke| stroke_width(stroke) > THICK);
    let is_rimmed = [over_regions, over_regions || panel.series.iter().any(is_thick)];
    let page = Page::new(place, is_rimmed);
    let Frame { left, top, width, height } = *frame;
    out.open_frame([left, top, width, height], [page.x, page.y]);
    let [left, top, width, height] = [left, top, width, height].map(number);
    for mark in layout.marks.iter().filter(|mark| mark.inside && !place.across.is_own) {
        let x = number(mark.at - frame.left);
        line(out, &format!("M{x} 0V{height}"), mark.label.is_some(), Colour::Grey)?;
    }
    for (mark, place) in panel.marks.iter().zip(&place.marks).filter(|(_, place)| place.inside) {
        let y = number(place.at - frame.top);
        line(out, &format!("M0 {y}H{width}"), !mark.label.is_empty(), Colour::Grey)?;
    }
    for series in &panel.series {
        page.series(out, series)?;
    }
    writeln!(out, "</svg>")?;
    let mut path = format!("M{left} {top}h{width}v{height}h-{width}z");
    for tick in &place.across.ticks {
        write!(
            path,
            "M{} {}v4",
            number(frame.left + frame.width * share(tick.at, place.across.range)),
            number(frame.bottom())
        )?;
    }
    for tick in &place.ticks {
        let y = frame.bottom() - frame.height * share(tick.at, place.range);
        write!(path, "M{left} {}h-4", number(y))?;
        text(out, [frame.left - 7.0, y + 0.35 * TEXT], r#" text-anchor="end""#, &tick.label)?;
    }
    for mark in place.marks.iter().filter(|mark| mark.inside) {
        if let Some(words) = &mark.label {
            let (from, to) = (number(mark.at), number(words.at[1] - 0.35 * TEXT));
            let leader = format!("M{} {from}L{} {to}", number(frame.right()), number(words.at[0] - 4.0));
            line(out, &leader, false, Colour::Grey)?;
            label(out, words)?;
        }
    }
    line(out, &path, false, Colour::Ink)?;
    for Text { at: [x, y], text: words } in &place.name {
        let turned = format!(r#" text-anchor="middle" transform="rotate(-90 {} {})""#, number(*x), number(*y));
        text(out, [*x, *y], &turned, words)?;
    }
    for (index, words) in &place.legend {
        sample(out, &panel.series[*index], [words.at[0] - SAMPLE - 6.0, words.at[1] - 0.35 * TEXT])?;
        label(out, words)?;
    }
    if place.empty {
        let middle = [frame.left + frame.width / 2.0, frame.top + frame.height / 2.0];
        text(out, middle, r#" text-anchor="middle""#, "no data")?;
    }
    Ok(())
}

fn text(out: &mut Sheet, [x, y]: [f64; 2], attributes: &str, words: &str) -> fmt::Result {
    writeln!(out, r#"<text x="{}" y="{}"{attributes}>{}</text>"#, number(x), number(y), escaped(words))
}

fn label(out: &mut Sheet, Text { at, text: words }: &Text) -> fmt::Result {
    text(out, *at, "", words)
}

/// Draws a thin line, dashed if it leads to a label across the frame.
fn line(out: &mut Sheet, path: &str, broken: bool, colour: Colour) -> fmt::Result {
    let dash = if broken { r#" stroke-dasharray="2 3""# } else { "" };
    writeln!(out, r#"<path d="{path}" fill="none" stroke-width="0.8"{dash} {}/>"#, stroke(colour))
}

/// Draws the line from the first frame up to a label beside it.
fn leader(out: &mut Sheet, mark: &MarkLine, layout: &Layout) -> fmt::Result {
    let Some((words, first)) = mark.label.as_ref().zip(layout.panels.first()) else { return Ok(()) };
    // A line ends below a label that is above it.
    let to = if words.at[0] > mark.at { words.at[1] - 0.75 * TEXT } else { words.at[1] + 2.0 };
    let (x, from, to) = (number(mark.at), number(first.frame.top), number(to));
    line(out, &format!("M{x} {from}V{to}"), false, Colour::Grey)?;
    label(out, words)
}

/// Draws the sample of a series in the legend.
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
        Data::Band { .. } => {
            let block = format!("M{} {}h{SAMPLE}v8h-{SAMPLE}z", number(x), number(y - 4.0));
            writeln!(out, r#"<path d="{block}" fill-opacity="0.35" {}/>"#, fill(colour))
        }
        Data::Points { marker, .. } => {
            let tip = if *marker == Marker::Below { y - 3.0 } else { y };
            markers(out, &[[x + SAMPLE / 2.0, tip]], (*marker, colour), false)
        }
        Data::Density(_) => {
            let dots = [0.2, 0.5, 0.8].map(|share| [x + share * SAMPLE, y]);
            markers(out, &dots, (Marker::Dot, colour), false)
        }
    }
}
