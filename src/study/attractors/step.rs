//! The grid of values of a survey.

use std::ops::RangeInclusive;

use crate::elementary;
use crate::study::survey::Spacing;
use crate::tolerance;

/// A grid that does not depend on the range: multiples of a step, or powers of ten whose exponents are such multiples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// 1, 2, 3 or 5, so that the step is at least half as long as requested.
    digit: u64,
    /// Power of ten.
    power: i32,
    /// Whether the values or their decimal logarithms are multiples of the step.
    pub spacing: Spacing,
}

impl Step {
    /// Returns the longest step that puts `count` or more values into `range`.
    pub fn for_values(range: [f64; 2], count: u32, spacing: Spacing) -> Self {
        let [low, high] = range.map(|end| spacing.place(end));
        Self::at_most((high - low) / f64::from(count.max(1)), spacing)
    }

    /// Returns the longest step that is no longer than `longest`; in decades for a logarithmic grid.
    pub fn at_most(longest: f64, spacing: Spacing) -> Self {
        let power = elementary::log10(longest).floor();
        let digits = longest / elementary::powf(10.0_f64, power);
        // Rounding must not lose a step of exactly one of the digits.
        let digit = [5, 3, 2]
            .into_iter()
            .find(|digit| digits * (1.0 + 8.0 * tolerance::ULP.value) >= *digit as f64)
            .unwrap_or(1);
        Self { digit, power: power as i32, spacing }
    }

    /// Length of the step: rpm, the unit of the varied number, or decades.
    pub fn width(self) -> f64 {
        self.times(1)
    }

    /// Distance from one value of the grid to the next, near a value.
    #[doc(hidden)]
    pub fn near(self, value: f64) -> f64 {
        match self.spacing {
            Spacing::Linear => self.width(),
            Spacing::Logarithmic => value * (elementary::powf(10.0_f64, self.width()) - 1.0),
        }
    }

    /// Returns a multiple of the step: the double nearest to the decimal number.
    fn times(self, count: i64) -> f64 {
        let count = (count * self.digit as i64) as f64;
        if self.power < 0 { count / 10.0_f64.powi(-self.power) } else { count * 10.0_f64.powi(self.power) }
    }

    /// Returns the values from the last one not above `low` to the first one not below `high`, both as places of the spacing.
    #[doc(hidden)]
    pub fn over(self, [low, high]: [f64; 2]) -> impl Iterator<Item = f64> {
        let mut first = (low / self.width()).floor() as i64 - 1;
        while self.times(first + 1) <= low {
            first += 1;
        }
        let mut last = first;
        while self.times(last) < high {
            last += 1;
        }
        let all: RangeInclusive<i64> = first..=last;
        all.map(move |count| self.spacing.value(self.times(count)))
    }
}
