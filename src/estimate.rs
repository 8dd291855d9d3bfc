//! A number and how well it is known.

/// A number that was measured, by runs or by extrapolation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// How far it may be off; not a number where that is not known.
    pub error: f64,
    /// What the error is.
    pub error_is: ErrorIs,
}

/// What the error of an [`Estimate`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorIs {
    /// The standard error of a mean or of a fit's coefficient.
    Standard,
    /// The last correction of an extrapolation, and rounding.
    Correction,
}

impl Estimate {
    /// The mean of the means over equal parts of a run, with its standard error; neither is a number for fewer than two parts.
    pub fn of_parts(means: &[f64]) -> Self {
        let count = means.len() as f64;
        let value = means.iter().sum::<f64>() / count;
        let variance = means.iter().map(|mean| (mean - value).powi(2)).sum::<f64>() / (count - 1.0);
        Self { value, error: (variance / count).sqrt(), error_is: ErrorIs::Standard }
    }

    /// The mean of independent estimates of one number, with the error that theirs leave it.
    pub fn mean(of: &[Self]) -> Self {
        let count = of.len() as f64;
        let value = of.iter().map(|one| one.value).sum::<f64>() / count;
        let error = of.iter().map(|one| one.error * one.error).sum::<f64>().sqrt() / count;
        Self { value, error, error_is: ErrorIs::Standard }
    }

    /// The share of those that do something, with its standard error if they were drawn by chance: that of one more which does
    /// and one more which does not, since none of few is not certainly none of all.
    pub(crate) fn share(number: usize, of: usize) -> Self {
        let (number, of) = (number as f64, of as f64);
        let likely = (number + 1.0) / (of + 2.0);
        Self { value: number / of, error: (likely * (1.0 - likely) / of).sqrt(), error_is: ErrorIs::Standard }
    }

    /// What an extrapolation leads to.
    pub(crate) fn extrapolated(value: f64, error: f64) -> Self {
        Self { value, error, error_is: ErrorIs::Correction }
    }
}
