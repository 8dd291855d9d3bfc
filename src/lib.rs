//! corner-impact checks, on every run, what a paper derives by hand: the local map of a cam-follower system whose follower
//! hits the cam at a corner, where the cam's acceleration jumps. The proofs by computer algebra are redone on every commit.
//!
//! ```text
//!  model file (TOML)
//!    │  model            what the user wrote, checked
//!    ▼
//!  cam · flight · impact the physical laws; reading, a model whole
//!    ▼
//!  measured              how well a cam of measured lifts is known, and the cams that it may as well be
//!  uncertainty           the machines that the cam's rows and the errors of numbers allow, and the spread of results
//!    ▼
//!  simulate              the only event loop: fly, contact, impact or stick, release; the variational flow
//!    ▼
//!  section               the stroboscopic map and traces
//!    ▼
//!  orbit                 periodic orbits, their multipliers, branches of them and the points where these change
//!    ▼
//!  covering              chaos proved: boxes of impacts that the impact map stretches across each other
//!    ▼
//!  python                runs one script of `derivations/`
//!    ▼
//!  corner                where the corner impact is (x*, T*), and its map {A∓, B∓, C, D} by several routes
//!    ▼
//!  agreement             do two routes give one number? Pairwise, against the table of tolerances
//!    ▼
//!  border_collision      normal form, Feigin's classification, the local map's own motions and how far it holds
//!    ▼
//!  published             the digits that the paper prints, each right or wrong as it was found to be
//!    ▼
//!  study                 one module per question that a user can ask: verify, locate, speeds, ...; its result is the document
//!    ▼
//!  paper                 the paper's statements, one by one, each with a verdict and how that is known
//! ```
//!
//! Data moves down; no stage uses one below it, and a test holds the code to that. `tolerance` stands above all: every
//! threshold is a row of its one table; so do `elementary`, sine and exponential with the same bits on every processor, `known`, the
//! words for how a result is known, `progress`, by which long work
//! tells how far it has come, `cancel`, by which it is ended, `bracket`, which finds roots, `interval`, which proves that it has found all, `estimate`, a number with its error, `ball`, a number with the radius that is proved, `untrusted`, which shows text of somebody else, and `file`, which writes files whole or not at all and reads them up to
//! a limit.
//!
//! Three packages beside this one show its results. `crates/program` is the command with its pages, reports and figures; `crates/plot` turns a
//! figure into SVG, PNG or PDF; `crates/explore` is the live page. Modules and items that this documentation does not show serve them, the Python package
//! and the tests. They may change in any release.
//!
//! ```
//! use corner_impact::{model::{Model, OSORIO_2008}, study::verify::{External, verify}};
//!
//! let model = Model::parse("osorio-2008.toml", OSORIO_2008)?;
//! let findings = verify(&model, External::LeftOut)?;
//! assert!(findings.agrees);
//! assert!((findings.at.speed_rpm() - 673.234445).abs() < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![doc = include_str!("symbols.md")]

#[macro_use]
mod named;

#[doc(hidden)]
pub mod tolerance;

#[doc(hidden)]
pub mod elementary;

pub mod known;

pub mod progress;

#[doc(hidden)]
pub mod cancel;

#[doc(hidden)]
pub mod untrusted;

#[doc(hidden)]
pub mod bracket;
pub mod estimate;
#[doc(hidden)]
pub mod interval;

#[doc(hidden)]
pub mod ball;

#[doc(hidden)]
pub mod file;

pub mod model;

#[doc(hidden)]
pub mod command;
#[doc(hidden)]
pub mod json;

pub mod cam;

pub mod flight;
#[doc(hidden)]
pub mod impact;
#[doc(hidden)]
pub mod reading;

#[doc(hidden)]
pub mod measured;
#[doc(hidden)]
pub mod uncertainty;

pub mod simulate;

#[doc(hidden)]
pub mod section;

pub mod orbit;

#[doc(hidden)]
pub mod covering;

#[doc(hidden)]
pub mod python;

pub mod corner;

#[doc(hidden)]
pub mod agreement;

pub mod border_collision;

#[doc(hidden)]
pub mod published;

pub mod study;

#[doc(hidden)]
pub mod paper;

/// Internal functions that the tests call directly. Nothing else uses this module.
#[doc(hidden)]
pub mod inner {
    pub use crate::corner::extrapolation::{Powers, extrapolate};
    pub use crate::file::Unfinished;
    pub use crate::file::held;
    pub use crate::orbit::branch::onward;
    pub use crate::orbit::chain::{Link, determinant, solve};
    pub use crate::orbit::complete::{OneImpact, joined};
    pub use crate::simulate::contact::{GapAt, Outcome, first_contact};
}

/// The program on the page about the theory is a test.
#[cfg(doctest)]
#[doc = include_str!("../docs/theory.md")]
struct TheoryPage;
