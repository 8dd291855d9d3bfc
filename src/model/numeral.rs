//! A number with the text that it was written in: proofs use the decimal, everything else the nearest double.

/// A number as the user wrote it.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub struct Numeral {
    /// The nearest double.
    pub number: f64,
    /// The text as written.
    pub text: String,
}

impl Numeral {
    /// Decimal form of the text, without the plus sign and underscores that TOML also allows. If the text is not that number, the double's.
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
