//! Numbers with the text in which they were written: proofs use the decimal, everything else the nearest double. Numbers that people type
//! may have a unit or a decimal comma.

use crate::untrusted;

/// Number as the user wrote it.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub struct Numeral {
    /// Nearest double.
    pub number: f64,
    /// Text as written.
    pub text: String,
}

impl Numeral {
    /// Decimal form of the text, without the plus sign and underscores that TOML also allows; the digits of the double if the text is not
    /// that number.
    pub(super) fn decimal(&self) -> String {
        let text = self.text.trim().replace('_', "");
        let text = text.trim_start_matches('+');
        match text.parse::<f64>() {
            Ok(number) if number == self.number => text.to_owned(),
            _ => format!("{:?}", self.number),
        }
    }
}

impl From<f64> for Numeral {
    /// Writes the number in plain digits, or with an exponent if it has more than 24 of them.
    fn from(number: f64) -> Self {
        let digits = number.to_string();
        Self { number, text: if digits.len() > 24 { format!("{number:e}") } else { digits } }
    }
}

/// Splits `900N` or `900 N` into the number, which is the longest initial part that parses, and the rest.
#[doc(hidden)]
pub fn parted(text: &str) -> (&str, &str) {
    let text = text.trim();
    let ends = text.char_indices().map(|(at, letter)| at + letter.len_utf8());
    let reads = |end: &usize| text[..*end].parse::<f64>().is_ok_and(f64::is_finite);
    let end = ends.rev().find(reads).unwrap_or(0);
    (&text[..end], text[end..].trim())
}

/// Reads a finite number, which `unit` may follow; an empty unit means a pure number. A decimal comma is rejected with both possible
/// readings.
#[doc(hidden)]
pub fn finite(text: &str, unit: &str) -> Result<f64, String> {
    let (written, follows) = parted(text);
    let shown = untrusted::value(text.trim());
    let Ok(number) = written.parse::<f64>() else {
        let is_number = text.trim().parse::<f64>().is_ok();
        return Err(if is_number { "must be a finite number".into() } else { format!("\"{shown}\" is not a number") });
    };
    let comma = |separator| parted(&text.replacen(',', separator, 1)).0.parse::<f64>().unwrap_or(number);
    match follows {
        "" => Ok(number),
        follows if follows == unit => Ok(number),
        follows if follows.starts_with(',') => Err(format!(
            "\"{shown}\" may be {} or {}: write a decimal point, and nothing between thousands",
            comma("."),
            comma("")
        )),
        _ if unit.is_empty() => {
            Err(format!("\"{shown}\" is more than a number: write the number alone, in the unit of the model"))
        }
        _ => Err(format!("\"{shown}\" is not in {unit}: write {number}, or {number} {unit}, if that is meant")),
    }
}
