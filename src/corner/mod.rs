//! The corner impact: where it happens, and its local map {A-, A+, B-, B+, C, D} by several routes.
//!
//! Near a periodic orbit whose impact falls on a corner of the cam, one revolution maps a deviation of the state `dx` and of
//! the period `dT` to `A dx + B dT`, with matrices that depend on the side of the corner the impact falls on. [`mod@locate`]
//! finds the orbit; each route then computes the matrices by means of its own:
//!
//! | module | shares with the simulator |
//! |---|---|
//! | [`closed_form`] | the place: T*, v and the cam's lift there; the formulas and their propagator are its own |
//! | [`finite_difference`] | is built on it: differences of simulated revolutions |
//! | [`least_squares`] | is built on it: a polynomial fitted to simulated revolutions |
//! | [`external`] | nothing: Python programs that get the model file's numbers and find the place themselves |
//!
//! [`jump_order`] has what a corner of any order makes of the map, predicted and measured.
//!
//! States here are the paper's x: position from the spring's equilibrium, and velocity.

pub mod border;
pub mod closed_form;
pub mod external;
mod extrapolation;
pub mod finite_difference;
pub mod jump_order;
pub mod least_squares;
pub mod locate;
pub mod map;
pub mod one_sided;
pub mod simulated_orbit;

pub use locate::{CornerImpact, LocateError, locate};
pub use map::{CornerMap, Route, SideMap};
