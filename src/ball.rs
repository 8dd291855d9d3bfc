//! A number that is proved to lie within a radius of a middle, as decimals.

use serde::{Deserialize, Serialize};

use crate::interval::Interval;

/// A ball, as proofs in many digits write it: the number lies within `rad` of `mid`.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Ball {
    /// The digits that are proved, each right but for one unit of the last.
    pub mid: String,
    /// How far the number may be from them.
    pub rad: String,
}

impl Ball {
    /// An interval that holds it.
    pub(crate) fn interval(&self) -> Interval {
        let [mid, rad] = [&self.mid, &self.rad].map(|digits| digits.parse::<f64>().unwrap_or(f64::NAN));
        // Reading rounds to the nearest double.
        Interval::new(mid.next_down(), mid.next_up()) + Interval::new(-rad.next_up(), rad.next_up())
    }

    /// The double nearest to the middle; not a number where the text is none, which no comparison lets pass.
    pub fn value(&self) -> f64 {
        self.mid.parse().unwrap_or(f64::NAN)
    }

    /// How many significant digits are proved.
    pub fn digits(&self) -> usize {
        let mantissa = self.mid.split(['e', 'E']).next().unwrap_or_default();
        mantissa.chars().filter(char::is_ascii_digit).skip_while(|digit| *digit == '0').count()
    }
}
