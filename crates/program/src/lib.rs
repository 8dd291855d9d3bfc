//! Command line, pages, reports and figures of [`corner_impact`]. This package computes no results.
//!
//! ```text
//!  show                  blocks on a terminal, in a browser and as Markdown; JSON, CSV; words and digits, each written once
//!    ▼
//!  figures               a file for each figure, or for a family of figures: numbers, plot, title and caption
//!    ▼
//!  report                everything about one model in one value
//!    ▼
//!  live                  the live page inside one file
//!    ▼
//!  explain               meaning and evidence of a number on a page
//!    ▼
//!  pages                 the page of each command, and of the report
//!    ▼
//!  explore               the server of the live page
//!    ▼
//!  cli                   parse, one library call, exit code
//! ```
//!
//! Data moves down: no stage uses a later one, which a test checks. The package serves the command, the Python package and the tests. Its
//! modules may change in any release.

#[doc(hidden)]
pub mod show;

#[doc(hidden)]
pub mod figures;

#[doc(hidden)]
pub mod report;

#[doc(hidden)]
pub mod live;

#[doc(hidden)]
pub mod explain;

#[doc(hidden)]
pub mod pages;

#[doc(hidden)]
pub mod explore;

#[doc(hidden)]
pub mod cli;
