//! Numbers as digits: the number of digits is chosen once for all pages.

use maud::{Markup, html};

use corner_impact::elementary;
use corner_impact::tolerance;

/// Number of displayed digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Digits {
    /// Number of significant digits, without trailing zeros.
    Significant(usize),
    /// Number of significant digits, including trailing zeros, so that numbers can be compared.
    Aligned(usize),
    /// Number of decimal places.
    Fixed(usize),
    /// Number of decimal places, without trailing zeros.
    UpTo(usize),
    /// Number of significant digits, with a power of ten.
    Power(usize),
    /// Two digits, for a difference or a bound, where only the size matters.
    Size,
    /// Nine digits, or six and a power of ten if zeros would replace digits.
    Short,
    /// All digits that are needed to read back the same number.
    All,
}

impl Digits {
    /// Significant digits of a value, with a power of ten if zeros would replace them.
    pub(crate) fn of(value: f64, digits: usize) -> Self {
        let least = elementary::powf(10.0_f64, 1.0 - digits as f64);
        let is_small = value.abs() < least && value.abs() >= tolerance::DISPLAYED_ZERO.value;
        if is_small { Self::Power(digits) } else { Self::Significant(digits) }
    }

    /// Text for a terminal and for a text file: `-1.5e-9`.
    pub(crate) fn text(self, value: f64) -> String {
        match self {
            _ if !value.is_finite() => format!("{value}"),
            // The sign of a zero, or its rounding error, has no meaning.
            Self::Short if value.abs() < tolerance::DISPLAYED_ZERO.value => "0".into(),
            Self::Short if is_plain(value) => Self::Significant(9).text(value),
            Self::Short => Self::Power(6).text(value),
            // A column of a terminal is narrow: limit the places to the digits.
            Self::Significant(digits) => trimmed(&format!("{value:.*}", places(value, digits).min(digits))),
            Self::Aligned(digits) if value == 0.0 || is_plain(value) => {
                without_sign_of_zero(format!("{value:.*}", places(value, digits)))
            }
            Self::Aligned(digits) | Self::Power(digits) => format!("{value:.*e}", digits.saturating_sub(1)),
            Self::Fixed(places) => without_sign_of_zero(format!("{value:.places$}")),
            Self::UpTo(places) => trimmed(&format!("{value:.places$}")),
            Self::Size => Self::Power(2).text(value),
            Self::All => format!("{value}"),
        }
    }

    /// Markup for a browser, with all digits in the value of a `data` element.
    pub(crate) fn markup(self, value: f64) -> Markup {
        html! { @if value.is_finite() { data value=(value) { (typeset(&self.typed(value))) } } @else { (value) } }
    }

    /// Digits of [`Digits::markup`] before typesetting; a small number has room for all its places.
    pub(crate) fn typed(self, value: f64) -> String {
        match self {
            Self::Significant(_) if value.abs() < tolerance::DISPLAYED_ZERO.value => "0".into(),
            Self::Size if value == 0.0 => "0".into(),
            Self::Size if (0.01..100.0).contains(&value.abs()) => trimmed(&format!("{value:.*}", places(value, 2))),
            Self::Significant(digits) if is_plain(value) => trimmed(&format!("{value:.*}", places(value, digits))),
            Self::Significant(digits) => Self::Power(digits).text(value),
            Self::All if value != 0.0 && !is_plain(value) => format!("{value:e}"),
            _ => self.text(value),
        }
    }
}

/// Digits for a number with this error, down to the second digit of the error, and the error rounded up to that place.
pub(crate) fn with_error(error: f64) -> (Digits, f64) {
    if !(error > 0.0 && error.is_finite()) {
        return (Digits::Significant(9), error);
    }
    let place = 1.0 - elementary::log10(error).floor();
    (Digits::Fixed(place.clamp(0.0, 12.0) as usize), rounded_up(error, place))
}

/// Text of a part of an error: two digits of its own, rounded up.
pub(crate) fn part_of_error(part: f64) -> String {
    let (digits, part) = with_error(part);
    digits.text(part)
}

/// Rounds a number up to this many decimals; a negative number of decimals rounds to tens and so on.
fn rounded_up(number: f64, place: f64) -> f64 {
    let unit = elementary::powf(10.0_f64, place);
    (number * unit).ceil() / unit
}

/// Upper bound of a number that is not negative and has an error as large as itself: `< 0.13`.
pub(crate) fn at_most(bound: f64) -> String {
    let (digits, bound) = with_error(bound);
    format!("< {}", digits.text(bound))
}

/// Decimals of a number, zero or more, rounded down for a lower bound.
pub fn at_least(number: f64, places: usize) -> String {
    // This many places print a double exactly, so cutting them rounds down.
    let exact = format!("{number:.1074}");
    let end = exact.find('.').map_or(exact.len(), |point| point + 1 + places);
    exact.get(..end).unwrap_or(&exact).to_owned()
}

/// Typesets digits as in print: a minus as wide as a plus, and a raised power of ten.
pub(crate) fn typeset(text: &str) -> Markup {
    let signed = |text: &str| text.replace('-', "\u{2212}");
    html! {
        @match text.split_once('e') {
            Some((mantissa, exponent)) => { (signed(mantissa)) "\u{202f}×\u{202f}10" sup { (signed(exponent)) } }
            None => (signed(text))
        }
    }
}

/// Whether a number is written without a power of ten: only few zeros precede or follow its digits.
fn is_plain(value: f64) -> bool {
    (-4.0..9.0).contains(&elementary::log10(value.abs()))
}

/// Decimal places that give a number this many significant digits.
fn places(value: f64, digits: usize) -> usize {
    if value == 0.0 { 0 } else { (digits as f64 - 1.0 - elementary::log10(value.abs()).floor()).max(0.0) as usize }
}

fn trimmed(text: &str) -> String {
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text };
    without_sign_of_zero(text.into())
}

fn without_sign_of_zero(text: String) -> String {
    if text.bytes().any(|letter| (b'1'..=b'9').contains(&letter)) { text } else { text.trim_start_matches('-').into() }
}
