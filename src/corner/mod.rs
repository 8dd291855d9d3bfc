//! The corner impact: where it happens, and its local map {A-, A+, B-, B+, C, D} by several routes.
//!
//! Near a periodic orbit with an impact on a corner of the cam, one period maps a deviation of the state `dx` and of the
//! cam's period `dT`, or of any number of the model, to `A dx + B dT`, with matrices that depend on the side of the corner the
//! impact falls on. The orbit is the paper's, one impact in one revolution, or has any number of both. It is found by
//!
//! | module | finds |
//! |---|---|
//! | `period_equation` | the speeds at which the one impact of an orbit is on a corner: all roots of one equation |
//! | `candidates` | corner impacts of several impacts, where branches of orbits pass a corner |
//! | `shots` | corner impacts of several impacts again, by shots from the corner; independent of orbits and branches |
//! | `confirm` | whether a corner impact of the equations is an orbit of the cam as it is |
//! | [`mod@locate`] | the paper's kind, for `verify`; [`range`] all kinds |
//!
//! Each route then computes the matrices by means of its own:
//!
//! | module | shares with the simulator |
//! |---|---|
//! | [`closed_form`] | the place: T*, v and the cam's lift there; the formulas and their propagator are its own. The paper's orbits only |
//! | [`variational`] | the laws of flight and impact; it multiplies their derivatives once around and simulates nothing |
//! | [`finite_difference`] | is built on it: differences of simulated periods |
//! | [`least_squares`] | is built on it: a polynomial fitted to simulated periods |
//! | `external` | nothing: Python programs that get the model file's numbers and find the place themselves. The paper's orbits only |
//!
//! [`mod@second_order`] has the terms of second order, which these matrices leave out.
//!
//! [`jump_order`] predicts and measures the effect of a corner of any order on the map.
//!
//! States here are the paper's x: position from the spring's equilibrium, and velocity.

#[doc(hidden)]
pub mod candidates;
#[doc(hidden)]
pub mod closed_form;
pub(crate) mod confirm;
pub(crate) mod corner_impact;
pub(crate) mod external;
pub(crate) mod extrapolation;
#[doc(hidden)]
pub mod finite_difference;
#[doc(hidden)]
pub mod jump_order;
#[doc(hidden)]
pub mod least_squares;
#[doc(hidden)]
pub mod locate;
pub mod map;
#[doc(hidden)]
pub mod one_sided;
pub(crate) mod period_equation;
#[doc(hidden)]
pub mod range;
#[doc(hidden)]
pub mod second_order;
#[doc(hidden)]
pub mod shots;
pub(crate) mod simulated_orbit;
#[doc(hidden)]
pub mod variational;
#[doc(hidden)]
pub mod varied;

pub use corner_impact::{CornerImpact, Way};
pub use external::told;
pub use locate::{LocateError, locate};
pub use map::{CornerMap, Route, SideMap};
