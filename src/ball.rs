//! Number that is proved to lie within a radius of a middle, as decimals.

use serde::{Deserialize, Serialize};

use crate::interval::Interval;

/// Ball, as proofs in many digits write it: the number lies within `rad` of `mid`.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Ball {
    /// Middle of the ball: the proved digits, each right except for one unit of the last.
    pub mid: String,
    /// Largest distance of the number from the middle.
    pub rad: String,
}

impl Ball {
    /// Interval that contains the ball.
    pub(crate) fn interval(&self) -> Interval {
        let [mid, rad] = [&self.mid, &self.rad].map(|digits| digits.parse::<f64>().unwrap_or(f64::NAN));
        // Reading rounds to the nearest double.
        Interval::new(mid.next_down(), mid.next_up()) + Interval::new(-rad.next_up(), rad.next_up())
    }

    /// Double nearest to the middle; NaN if the text is not a number, which fails every comparison.
    pub fn value(&self) -> f64 {
        self.mid.parse().unwrap_or(f64::NAN)
    }

    /// Number of significant digits that are proved.
    pub fn digits(&self) -> usize {
        let mantissa = self.mid.split(['e', 'E']).next().unwrap_or_default();
        mantissa.chars().filter(char::is_ascii_digit).skip_while(|digit| *digit == '0').count()
    }
}
