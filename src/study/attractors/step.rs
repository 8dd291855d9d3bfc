//! The grid of values of a survey.

use std::ops::RangeInclusive;

use crate::elementary;
use crate::study::survey::Spacing;
use crate::tolerance;

/// A grid that no range has a say in: whole multiples of a step, or powers of ten with such multiples as exponents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// 1, 2, 3 or 5, so that the step is no shorter than half of what was asked for.
    digit: u64,
    /// Of ten.
    power: i32,
    /// Whether values or their decimal logarithms are multiples of it.
    pub spacing: Spacing,
}

impl Step {
    /// The longest step that puts `count` values, or more, into `range`.
    pub fn for_values(range: [f64; 2], count: u32, spacing: Spacing) -> Self {
        let [low, high] = range.map(|end| spacing.place(end));
        Self::at_most((high - low) / f64::from(count.max(1)), spacing)
    }

    /// The longest step that is no longer than so much: of a logarithmic grid in decades.
    pub fn at_most(longest: f64, spacing: Spacing) -> Self {
        let power = elementary::log10(longest).floor();
        let digits = longest / elementary::powf(10.0_f64, power);
        // A step of exactly one of them is not to be lost to rounding.
        let digit = [5, 3, 2]
            .into_iter()
            .find(|digit| digits * (1.0 + 8.0 * tolerance::ULP.value) >= *digit as f64)
            .unwrap_or(1);
        Self { digit, power: power as i32, spacing }
    }

    /// The step: rpm, the unit of what varies, or decades.
    pub fn width(self) -> f64 {
        self.times(1)
    }

    /// From one value of the grid to the next, next to a value.
    pub(super) fn near(self, value: f64) -> f64 {
        match self.spacing {
            Spacing::Linear => self.width(),
            Spacing::Logarithmic => value * (elementary::powf(10.0_f64, self.width()) - 1.0),
        }
    }

    /// A multiple of it: the double nearest to the decimal number.
    fn times(self, count: i64) -> f64 {
        let count = (count * self.digit as i64) as f64;
        if self.power < 0 { count / 10.0_f64.powi(-self.power) } else { count * 10.0_f64.powi(self.power) }
    }

    /// The values from the last that is not above `low` to the first that is not below `high`, both as places of the spacing.
    pub(super) fn over(self, [low, high]: [f64; 2]) -> impl Iterator<Item = f64> {
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
