//! The command line, pages, reports and figures of [`corner_impact`]. This package computes nothing of its own.
//!
//! ```text
//!  show                  blocks on a terminal, in a browser and as Markdown; JSON, CSV; words and digits, each written once
//!    ▼
//!  figures               a file for each figure, or for a family: numbers, plot, title and caption
//!    ▼
//!  report                everything about one model in one value
//!    ▼
//!  live                  the page that computes as one looks at it, inside one file
//!    ▼
//!  explain               what a number on a page stands for
//!    ▼
//!  pages                 the page of each command, and that of the report
//!    ▼
//!  explore               the server of the live page
//!    ▼
//!  cli                   parse, one library call, exit code
//! ```
//!
//! Data moves down; no stage uses one below it, and a test holds the code to that. The package serves the command, the Python package and
//! the tests. Its modules may change in any release.

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
