//! Predictions of the piecewise-linear map at a corner impact: its normal form, Feigin's classification, its own motions on either side of
//! the corner impact, and the range in which they are valid.
//!
//! | module | contents |
//! |---|---|
//! | [`mod@conditions`], [`feigin`] | conditions of a classification, and the classification |
//! | [`mod@normal_form`] | normal form, with the border independent of the parameter |
//! | [`local_map`], [`word`] | the map; the sides that its orbits visit |
//! | [`trapping`] | regions that the map sends into themselves |
//! | [`mod@robust_chaos`] | the theorem of robust chaos, and its hypotheses |
//! | [`long_run`], `outcome` | ends of the map's motions, on either side of the corner impact |
//! | [`directions`], [`danger`] | directions of divergence at the corner impact; basins that vanish there; attractors that meet there |
//! | [`validity`], [`passage`] | range in which the map is valid; departure of the machine from its former orbit |
//! | [`mod@rounded`] | shift of a fold by rounding of the corner |
//! | `event_curve` | curves of corner impacts, folds, flips, grazes in two numbers of the model; scenarios of corner impacts |

#[doc(hidden)]
pub mod conditions;
pub mod danger;
#[doc(hidden)]
pub mod directions;
#[doc(hidden)]
pub mod event_curve;
pub mod feigin;
pub mod local_map;
#[doc(hidden)]
pub mod long_run;
#[doc(hidden)]
pub mod normal_form;
#[doc(hidden)]
pub mod outcome;
#[doc(hidden)]
pub mod passage;
pub mod robust_chaos;
#[doc(hidden)]
pub mod rounded;
#[doc(hidden)]
pub mod trapping;
#[doc(hidden)]
pub mod validity;
#[doc(hidden)]
pub mod word;

pub use conditions::{Condition, conditions};
pub(crate) use danger::WithDanger;
pub use danger::{Danger, DangerKind};
pub use event_curve::EventCurve;
pub use feigin::{Classification, classify, scenario};
pub use local_map::LocalMap;
pub use normal_form::{NormalForm, normal_form};
pub use outcome::LocalOutcome;
pub use robust_chaos::RobustChaos;
pub use rounded::{RoundedCorner, rounded};

use crate::cam::Side;

/// Reason why a map cannot be classified.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the message says what each number is")]
pub enum Degenerate {
    /// Divisor of a change of coordinates that vanishes.
    #[error("{what} is {value:e}, zero to rounding")]
    Vanishes { what: &'static str, value: f64 },
    /// Eigenvalue on a boundary of the counts.
    #[error("the {side} side has an eigenvalue at {value}, too close to {boundary} to count")]
    EigenvalueOnBoundary { side: Side, value: f64, boundary: f64 },
    /// Condition of the classification that fails.
    #[error("{name} is {value:e}, {distance:.1e} from failing: {meaning}")]
    Fails { name: &'static str, value: f64, distance: f64, meaning: &'static str },
}

/// Reason why a corner impact is not classified.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[doc(hidden)]
pub enum Refusal {
    /// Map of no generic kind.
    #[error("degenerate: {0}")]
    Degenerate(#[from] Degenerate),
    /// Sticking of the follower near the corner, so that a revolution forgets its start and the map has no such sides.
    #[error(
        "sticking: next to the corner, on its {side} side, the follower stays on the cam after the impact and \
         forgets its start. A of that side is the zero matrix, which no formula for a flight after the impact gives"
    )]
    Sticking { side: Side },
}
