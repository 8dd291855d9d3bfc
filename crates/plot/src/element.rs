//! Elements of an SVG: coordinates, colours, text, lines and markers.

use std::fmt::{self, Write};

use super::{Colour, Marker, Stroke};

/// Limit to which coordinates far outside the page are clamped.
pub(super) const FAR: f64 = 1e5;

pub(super) fn stroked(out: &mut impl Write, path: &str, how: Stroke, colour: Colour) -> fmt::Result {
    let (width, dash) = (stroke_width(how), dashes(how));
    let dash = if dash.is_empty() { String::new() } else { format!(r#" stroke-dasharray="{dash}""#) };
    let colour = stroke(colour);
    writeln!(out, r#"<path d="{path}" fill="none" stroke-width="{width}" stroke-linejoin="round"{dash} {colour}/>"#)
}

/// Width of a stroke.
pub fn stroke_width(how: Stroke) -> f64 {
    match how {
        Stroke::Thin => 0.9,
        Stroke::Solid | Stroke::Dashed | Stroke::Dotted | Stroke::DashDotted | Stroke::DashDotDotted => 1.5,
        Stroke::Thick | Stroke::ThickDashed | Stroke::ThickDotted | Stroke::ThickDashDotted => 4.5,
    }
}

/// Lengths of the dashes of a stroke and of the gaps between them; empty for an unbroken one.
pub fn dashes(how: Stroke) -> &'static str {
    match how {
        Stroke::Thin | Stroke::Solid | Stroke::Thick => "",
        Stroke::Dashed => "6 3",
        Stroke::Dotted => "1.5 2.5",
        Stroke::DashDotted => "7 2.5 1.5 2.5",
        Stroke::DashDotDotted => "7 2.5 1.5 2.5 1.5 2.5",
        Stroke::ThickDashed => "8 4",
        Stroke::ThickDotted => "2.5 2.5",
        Stroke::ThickDashDotted => "8 3 3 3",
    }
}

/// Draws a rim in the colour of the paper below a stroke, so that it contrasts with any area behind it.
pub(super) fn rim(out: &mut impl Write, path: &str, width: f64) -> fmt::Result {
    let width = number(width + 2.6);
    writeln!(
        out,
        r##"<path d="{path}" class="halo" fill="none" stroke="#ffffff" stroke-width="{width}" stroke-linejoin="round" stroke-linecap="round"/>"##
    )
}

pub(super) fn markers(
    out: &mut impl Write,
    points: &[[f64; 2]],
    (marker, colour): (Marker, Colour),
    is_rimmed: bool,
) -> fmt::Result {
    /// Number of markers above which they are small, so that they do not hide the data.
    const MANY: usize = 40;
    let small = points.len() > MANY;
    let shape = match (marker, small) {
        (Marker::Dot | Marker::Disc, _) => "h0",
        (Marker::Ring, false) => "m-2.7 0a2.7 2.7 0 1 0 5.4 0a2.7 2.7 0 1 0 -5.4 0z",
        (Marker::Ring, true) => "m-1.4 0a1.4 1.4 0 1 0 2.8 0a1.4 1.4 0 1 0 -2.8 0z",
        (Marker::Square, false) => "m-2.5 -2.5h5v5h-5z",
        (Marker::Square, true) => "m-1.3 -1.3h2.6v2.6h-2.6z",
        (Marker::Diamond, false) => "m0 -3.7l3.7 3.7l-3.7 3.7l-3.7 -3.7z",
        (Marker::Diamond, true) => "m0 -2l2 2l-2 2l-2 -2z",
        (Marker::Triangle, false) => "m0 -3.7l3.6 6.2h-7.2z",
        (Marker::Triangle, true) => "m0 -2l2 3.4h-4z",
        (Marker::Cross, false) => "m-2.7 -2.7l5.4 5.4m0 -5.4l-5.4 5.4",
        (Marker::Cross, true) => "m-1.4 -1.4l2.8 2.8m0 -2.8l-2.8 2.8",
        (Marker::Plus, false) => "m-3.4 0h6.8m-3.4 -3.4v6.8",
        (Marker::Plus, true) => "m-1.8 0h3.6m-1.8 -1.8v3.6",
        (Marker::Below, _) => "m0 1.5l3.2 5.5h-6.4z",
    };
    let mut path = String::new();
    for [x, y] in points {
        write!(path, "M{} {}{shape}", number(*x), number(*y))?;
    }
    if is_rimmed {
        rim(out, &path, if small { 0.7 } else { 1.2 })?;
    }
    let (stroke, fill) = (stroke(colour), fill(colour));
    match marker {
        Marker::Dot => writeln!(out, r#"<path d="{path}" stroke-width="3.4" stroke-linecap="round" {stroke}/>"#),
        Marker::Disc => writeln!(out, r#"<path d="{path}" stroke-width="6.4" stroke-linecap="round" {stroke}/>"#),
        Marker::Ring | Marker::Square | Marker::Diamond | Marker::Triangle | Marker::Cross | Marker::Plus => {
            let width = if small { 0.7 } else { 1.2 };
            writeln!(out, r#"<path d="{path}" fill="none" stroke-width="{width}" {stroke}/>"#)
        }
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

/// Escapes text for XML; characters that XML does not allow are left out.
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

/// Appends a path through points, rounded to parts of a unit (10 or 100): absolute at its start, then relative to the rounded point before,
/// so that errors do not accumulate.
pub(super) fn polyline(path: &mut String, points: impl IntoIterator<Item = [f64; 2]>, parts: f64) {
    let (mut last, mut letter): (Option<[f64; 2]>, &str) = (None, "l");
    for point in points {
        let at = point.map(|part| (parts * part.clamp(-FAR, FAR)).round());
        match last {
            None => {
                let [x, y] = at.map(|part| number(part / parts));
                path.push_str(&format!("M{x} {y}"));
            }
            Some(before) if before == at => {}
            Some([x, y]) => {
                path.push_str(letter);
                let across = short((at[0] - x) / parts);
                let gap = if letter.is_empty() && !across.starts_with('-') { " " } else { "" };
                path.push_str(gap);
                path.push_str(&across);
                let up = short((at[1] - y) / parts);
                path.push_str(if up.starts_with('-') { "" } else { " " });
                path.push_str(&up);
                letter = "";
            }
        }
        last = Some(at);
    }
    // A single point has no length to stroke.
    if letter == "l" && last.is_some() {
        path.push_str("h.01");
    }
}

/// Formats a coordinate without the zero before its point.
fn short(value: f64) -> String {
    let text = number(value);
    match text.strip_prefix("0.").zip(Some("")).or_else(|| text.strip_prefix("-0.").zip(Some("-"))) {
        Some((parts, sign)) => format!("{sign}.{parts}"),
        None => text,
    }
}

/// Formats a coordinate with two decimals, without trailing zeros.
pub(super) fn number(value: f64) -> String {
    let text = format!("{:.2}", value.clamp(-FAR, FAR));
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}
