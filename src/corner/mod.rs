//! Corner impacts: their position, and the local map {A-, A+, B-, B+, C, D} by several routes.
//!
//! Consider a periodic orbit with an impact on a corner of the cam. One period maps a deviation of the state `dx` and of the cam's period
//! `dT`, or of any number of the model, to `A dx + B dT`. The matrices depend on the side of the corner on which the impact falls. The
//! paper's orbit has one impact in one revolution; others may have any number of both. Orbits are found by
//!
//! | module | finds |
//! |---|---|
//! | `period_equation` | the speeds at which the only impact of an orbit is on a corner: all roots of one equation |
//! | `candidates` | corner impacts of orbits with several impacts, where branches of orbits pass a corner |
//! | `shots` | the same kind by shots from the corner, independent of orbits and branches |
//! | `confirm` | whether a corner impact of the equations is an orbit of the actual cam |
//! | [`mod@locate`] | the paper's kind, for `verify`; [`range`] all kinds |
//!
//! Each route then computes the matrices by its own means:
//!
//! | module | shares with the simulator |
//! |---|---|
//! | [`closed_form`] | the position: T*, v and the cam's lift there; formulas and propagator are its own. The paper's orbits only |
//! | [`variational`] | the laws of flight and impact; it multiplies their derivatives over one period and simulates nothing |
//! | [`finite_difference`] | the simulation itself: differences of simulated periods |
//! | [`least_squares`] | the simulation itself: a polynomial fitted to simulated periods |
//! | `external` | nothing: Python programs read the model file's numbers and locate the impact themselves. The paper's orbits only |
//!
//! [`mod@second_order`] computes the terms of second order, which these matrices leave out.
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
