//! A number with its uncertainty.

/// A number that was measured, by runs or by extrapolation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Estimated value.
    pub value: f64,
    /// Uncertainty of the value; NaN if it is unknown.
    pub error: f64,
    /// Kind of the error.
    pub error_is: ErrorIs,
}

/// Kind of the error of an [`Estimate`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorIs {
    /// Standard error of a mean or of a fit's coefficient.
    Standard,
    /// Last correction of an extrapolation, plus rounding.
    Correction,
}

impl Estimate {
    /// Mean of the means over equal parts of a run, with its standard error. The error is NaN for fewer than two parts; without parts the
    /// mean is NaN, too.
    pub fn of_parts(means: &[f64]) -> Self {
        let count = means.len() as f64;
        let value = means.iter().sum::<f64>() / count;
        let variance = means.iter().map(|mean| (mean - value).powi(2)).sum::<f64>() / (count - 1.0);
        Self { value, error: (variance / count).sqrt(), error_is: ErrorIs::Standard }
    }

    /// Mean of independent estimates of one number, with the standard error that follows from their errors.
    pub fn mean(of: &[Self]) -> Self {
        let count = of.len() as f64;
        let value = of.iter().map(|one| one.value).sum::<f64>() / count;
        let error = of.iter().map(|one| one.error * one.error).sum::<f64>().sqrt() / count;
        Self { value, error, error_is: ErrorIs::Standard }
    }

    /// Share of `number` out of `of`, with its standard error if the cases were drawn at random. The error counts one more case of each
    /// kind, because 0 of a few cases does not prove a share of 0.
    pub(crate) fn share(number: usize, of: usize) -> Self {
        let (number, of) = (number as f64, of as f64);
        let likely = (number + 1.0) / (of + 2.0);
        Self { value: number / of, error: (likely * (1.0 - likely) / of).sqrt(), error_is: ErrorIs::Standard }
    }

    /// Share of `number` out of `of` if no other cases exist, so that the error is 0.
    pub(crate) fn counted(number: usize, of: usize) -> Self {
        Self { value: number as f64 / of as f64, error: 0.0, error_is: ErrorIs::Standard }
    }

    /// Result of an extrapolation.
    pub(crate) fn extrapolated(value: f64, error: f64) -> Self {
        Self { value, error, error_is: ErrorIs::Correction }
    }
}
