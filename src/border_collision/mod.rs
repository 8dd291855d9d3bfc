//! Predictions of the piecewise-linear map: its normal form, Feigin's classification, its own motions on either side of the
//! corner impact; and the distance from it up to which they are valid.
//!
//! | module | contents |
//! |---|---|
//! | [`mod@conditions`], [`feigin`] | conditions of a classification, and the classification |
//! | [`mod@normal_form`] | the map with its parameter out of the border |
//! | [`local_map`], [`word`] | the map itself; the sides that its orbits visit |
//! | [`trapping`] | regions that it sends into themselves |
//! | [`mod@robust_chaos`] | when chaos is a theorem |
//! | [`long_run`], `outcome` | where its motions end, on either side of the corner impact |
//! | [`directions`], [`danger`] | directions of divergence at the corner impact; basins that vanish there; attractors that meet there |
//! | [`validity`], [`passage`] | range in which the map holds; departure of the machine from the place of its former orbit |
//! | [`mod@rounded`] | how far a fold moves where the corner is rounded |
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

/// A map that cannot be classified, and the reason.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the message says what each number is")]
pub enum Degenerate {
    /// A change of coordinates divides by this.
    #[error("{what} is {value:e}, zero to rounding")]
    Vanishes { what: &'static str, value: f64 },
    /// An eigenvalue on a boundary that the counts divide at.
    #[error("the {side} side has an eigenvalue at {value}, too close to {boundary} to count")]
    EigenvalueOnBoundary { side: Side, value: f64, boundary: f64 },
    /// A condition of the classification fails.
    #[error("{name} is {value:e}, {distance:.1e} from failing: {meaning}")]
    Fails { name: &'static str, value: f64, distance: f64, meaning: &'static str },
}

/// Why a corner impact is not classified.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[doc(hidden)]
pub enum Refusal {
    /// The map is none of the generic kinds.
    #[error("degenerate: {0}")]
    Degenerate(#[from] Degenerate),
    /// The follower stays on the cam, so that a revolution forgets where it began and the map has no such sides.
    #[error(
        "sticking: next to the corner, on its {side} side, the follower stays on the cam after the impact and \
         forgets its start. A of that side is the zero matrix, which no formula for a flight after the impact gives"
    )]
    Sticking { side: Side },
}
