//! A number with the text that it is written in: proofs take the decimal, everything else the double nearest to it.

/// A number as somebody wrote it.
#[derive(Clone, Debug, PartialEq)]
pub struct Numeral {
    /// The double nearest to it.
    pub number: f64,
    /// The text that it is written in.
    pub text: String,
}

impl Numeral {
    /// The decimal that the text is, without the signs and marks that TOML allows besides; that of the double where the text is another one.
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
    /// In digits, but for what nobody would count.
    fn from(number: f64) -> Self {
        let digits = number.to_string();
        Self { number, text: if digits.len() > 24 { format!("{number:e}") } else { digits } }
    }
}
