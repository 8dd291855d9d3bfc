//! What the piecewise-linear map predicts: its normal form and Feigin's classification.

pub mod feigin;
pub mod normal_form;
pub mod passage;

pub use feigin::{Classification, classify};
pub use normal_form::{NormalForm, normal_form};

/// A map that the classification says nothing about, and why.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Degenerate {
    /// A change of coordinates divides by this.
    #[error("{what} is {value:e}, zero to rounding")]
    Vanishes {
        /// The quantity.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// An eigenvalue on a boundary that the counts divide at.
    #[error("the {side} side has an eigenvalue at {value}, too close to {boundary} to count")]
    EigenvalueOnBoundary {
        /// `minus` or `plus`.
        side: &'static str,
        /// The eigenvalue.
        value: f64,
        /// 1 or -1.
        boundary: f64,
    },
}
