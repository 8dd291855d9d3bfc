//! Computes the local map of a cam-follower system at a corner impact, where the follower hits the cam at a jump of the cam's acceleration.
//! Each run checks what a paper derives by hand; the proofs by computer algebra are redone on every commit.
//!
//! ```text
//!  model file (TOML)
//!    │  model            the user's input, checked
//!    ▼
//!  cam · flight · impact the physical laws; reading, a whole model
//!    ▼
//!  measured              uncertainty of a measured cam, and other cams that agree with its rows
//!  uncertainty           machines that the cam's rows and the errors of numbers allow, and the spread of results
//!    ▼
//!  simulate              the only event loop: fly, contact, impact or stick, release; the variational flow
//!    ▼
//!  section               the stroboscopic map and traces
//!    ▼
//!  orbit                 periodic orbits, their multipliers, branches of them and the special points of branches
//!    ▼
//!  covering              proofs of chaos: boxes of impacts that the impact map stretches across each other
//!    ▼
//!  python                runs one script of `derivations/`
//!    ▼
//!  corner                position of the corner impact (x*, T*), and its map {A∓, B∓, C, D} by several routes
//!    ▼
//!  agreement             comparison of routes in pairs, against the table of tolerances
//!    ▼
//!  border_collision      normal form, Feigin's classification, motions of the local map and its range of validity
//!    ▼
//!  published             the digits that the paper prints, each with a verdict
//!    ▼
//!  study                 one module per question of a user: verify, locate, speeds, ...; its result is the document
//!    ▼
//!  paper                 the paper's statements, one by one, each with a verdict and its evidence
//! ```
//!
//! Data moves down: no stage uses a later one, which a test checks. All stages may use these modules:
//!
//! - `tolerance`: the table of all thresholds;
//! - `elementary`: sine and exponential with the same bits on every processor;
//! - `known`: the words for how a result is known;
//! - `progress` and `cancel`: reports of long work, and its end at the user's wish;
//! - `bracket`: root finding; `interval`: proofs that all roots are found;
//! - `estimate`: a number with its error; `ball`: a number with its proved radius;
//! - `untrusted`: display of text from other people;
//! - `file`: files that are written completely or not at all, and read up to a limit.
//!
//! Three other packages show the results. `crates/program` is the command with its pages, reports and figures; `crates/plot` draws figures
//! as SVG, PNG or PDF; `crates/explore` is the live page. Hidden modules and items serve these packages, the Python package and the tests;
//! they may change in any release.
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
