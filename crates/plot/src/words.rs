//! Words in a frame, with subscripts and superscripts, outlined in the colour of the paper so that lines do not cross them.

use std::fmt::{self, Write};

use super::element::{escaped, fill, number};
use super::formula::{Part, sentence};
use super::layout::{TEXT, width};
use super::{Beside, Colour, Label};

/// Distance from a point to the word beside it.
const AWAY: f64 = 7.0;
/// Vertical shift of lowered and raised letters.
const SHIFT: f64 = 4.0;

/// Writes a word beside a point within a frame of this width and height; does nothing if the point is NaN.
pub(super) fn write(
    out: &mut impl Write,
    word: &Label,
    [x, y]: [f64; 2],
    [across, height]: [f64; 2],
    colour: Colour,
) -> fmt::Result {
    if x.is_nan() || y.is_nan() {
        return Ok(());
    }
    let is_across = (0.0..=across).contains(&x);
    let (x, y, anchor) = match within(word.beside, y, height) {
        Beside::Right => (x + AWAY, y + 0.35 * TEXT, "start"),
        Beside::Left => (x - AWAY, y + 0.35 * TEXT, "end"),
        Beside::Above => (x, y - AWAY, "middle"),
        Beside::Below => (x, y + AWAY + 0.75 * TEXT, "middle"),
        Beside::AboveRight => (x + 0.7 * AWAY, y - 0.7 * AWAY, "start"),
        Beside::AboveLeft => (x - 0.7 * AWAY, y - 0.7 * AWAY, "end"),
        Beside::BelowRight => (x + 0.7 * AWAY, y + 0.7 * AWAY + 0.75 * TEXT, "start"),
        Beside::BelowLeft => (x - 0.7 * AWAY, y + 0.7 * AWAY + 0.75 * TEXT, "end"),
    };
    // A word that the frame would cut is moved inside, where the point is.
    let wide = width(&word.text, TEXT).min(across);
    let inside = match anchor {
        "start" => x.min(across - wide),
        "end" => x.max(wide),
        _ => x.clamp(0.5 * wide, across - 0.5 * wide),
    };
    let x = if is_across { inside } else { x };
    let (x, y, text) = (number(x), number(y), marked_up(&word.text));
    let place = format!(r#"x="{x}" y="{y}" text-anchor="{anchor}""#);
    // The rim is a separate text, because not every reader supports paint-order.
    writeln!(
        out,
        r##"<text {place} class="halo" stroke="#ffffff" stroke-width="3.5" stroke-linejoin="round">{text}</text>"##
    )?;
    writeln!(out, r#"<text {place} {}>{text}</text>"#, fill(colour))
}

/// Returns the side of a point at this height, or the opposite side if the frame would cut the word.
fn within(beside: Beside, y: f64, height: f64) -> Beside {
    let (is_high, is_low) = (y < AWAY + 0.75 * TEXT, y > height - AWAY - 0.75 * TEXT);
    match beside {
        Beside::Above if is_high => Beside::Below,
        Beside::AboveRight if is_high => Beside::BelowRight,
        Beside::AboveLeft if is_high => Beside::BelowLeft,
        Beside::Below if is_low => Beside::Above,
        Beside::BelowRight if is_low => Beside::AboveRight,
        Beside::BelowLeft if is_low => Beside::AboveLeft,
        _ => beside,
    }
}

/// Returns a label with typeset formulas.
fn marked_up(text: &str) -> String {
    let (mut out, mut shifted) = (String::new(), 0.0);
    for part in sentence(text) {
        let (text, to) = match &part {
            Part::Plain(text) | Part::Letter(text) => (text, 0.0),
            Part::Below(text) => (text, SHIFT),
            Part::Above(text) => (text, -SHIFT),
        };
        let (by, size) = (number(to - shifted), if to == 0.0 { "" } else { r#" font-size="9.5""# });
        // The program's font has no prime: another font would replace it.
        let text = text.replace('′', "'");
        out.push_str(&format!(r#"<tspan dy="{by}"{size}>{}</tspan>"#, escaped(&text)));
        shifted = to;
    }
    out
}
