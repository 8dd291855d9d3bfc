//! Elements of an SVG: coordinates, colours, text, lines and markers.

use std::fmt::{self, Write};

use super::{Colour, Marker, Stroke};

/// Coordinates far outside the page are cut here.
pub(super) const FAR: f64 = 1e5;

pub(super) fn stroked(out: &mut impl Write, path: &str, how: Stroke, colour: Colour) -> fmt::Result {
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

pub(super) fn markers(out: &mut impl Write, points: &[[f64; 2]], marker: Marker, colour: Colour) -> fmt::Result {
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
pub(crate) fn escaped(text: &str) -> String {
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
