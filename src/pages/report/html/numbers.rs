//! Numbers as they stand on the page: how many digits is decided here, and nothing else.

use maud::{Markup, Render, html};

use crate::orbit::Eigenvalue;
use crate::tolerance;

/// A minus that is as wide as a plus.
pub(crate) fn signed(text: &str) -> String {
    text.replace('-', "\u{2212}")
}

/// A computed number, in which what rounding leaves of a zero is shown as one.
pub(crate) fn number(value: f64, digits: usize) -> Markup {
    if value.abs() < tolerance::DISPLAYED_ZERO.value {
        return html! { data value=(value) { "0" } };
    }
    given(value, digits)
}

/// Up to `digits` significant digits, without trailing zeros; a power of ten where zeros would take their place.
pub(crate) fn given(value: f64, digits: usize) -> Markup {
    if !value.is_finite() {
        return html! { (value) };
    }
    let exponent = if value == 0.0 { 0.0 } else { value.abs().log10() };
    if !(-4.0..9.0).contains(&exponent) {
        return power(value, digits);
    }
    html! { data value=(value) { (signed(&plain(value, digits))) } }
}

/// `digits` significant digits without a power of ten, without trailing zeros.
fn plain(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let places = (digits as f64 - 1.0 - value.abs().log10().floor()).max(0.0) as usize;
    let text = format!("{value:.places$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

/// So many places after the point.
pub(crate) fn fixed(value: f64, places: usize) -> Markup {
    let text = format!("{value:.places$}");
    // A zero has no sign.
    let text = if text.trim_matches(['-', '0', '.']).is_empty() { text.replace('-', "") } else { text };
    html! { data value=(value) { (signed(&text)) } }
}

/// Two digits: of a difference or a bound the size is all that matters.
pub(crate) fn size(value: f64) -> Markup {
    if value == 0.0 {
        return html! { data value="0" { "0" } };
    }
    if !value.is_finite() {
        return html! { (value) };
    }
    if (0.01..100.0).contains(&value.abs()) {
        html! { data value=(value) { (signed(&plain(value, 2))) } }
    } else {
        power(value, 2)
    }
}

fn power(value: f64, digits: usize) -> Markup {
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    html! { data value=(value) { (signed(mantissa)) "\u{202f}×\u{202f}10" sup { (signed(exponent)) } } }
}

/// Real and imaginary part.
pub(crate) fn complex(Eigenvalue { re, im }: Eigenvalue, digits: usize) -> Markup {
    html! {
        span.number {
            (number(re, digits))
            @if im != 0.0 {
                @let sign = if im < 0.0 { " \u{2212} " } else { " + " };
                (sign) (Unsigned(im, digits)) "\u{202f}i"
            }
        }
    }
}

/// A number without its sign, which stands before it already.
struct Unsigned(f64, usize);

impl Render for Unsigned {
    fn render(&self) -> Markup {
        let text =
            if self.0.abs() < tolerance::DISPLAYED_ZERO.value { "0".into() } else { plain(self.0.abs(), self.1) };
        html! { data value=(self.0) { (text) } }
    }
}

/// A 2x2 matrix, or a column of two.
pub(crate) fn matrix<const N: usize>(rows: &[[f64; N]; 2], digits: usize) -> Markup {
    html! {
        table.matrix {
            tbody { @for row in rows { tr { @for entry in row { td { (number(*entry, digits)) } } } } }
        }
    }
}

/// A symbol of mathematics: its letter in italics, what is below and above it smaller.
pub(crate) fn symbol(letter: &str, below: &str, above: &str) -> Markup {
    html! {
        span.symbol { i { (letter) } @if !below.is_empty() { sub { (below) } } @if !above.is_empty() { sup { (above) } } }
    }
}

/// An entry of a map, `A12`, as a letter with its indices and its side.
pub(crate) fn entry(name: &str, side: &str) -> Markup {
    let (letter, index) = name.split_at(1.min(name.len()));
    let above = match side {
        "minus" => "\u{2212}",
        "plus" => "+",
        _ => "",
    };
    symbol(letter, index, above)
}
