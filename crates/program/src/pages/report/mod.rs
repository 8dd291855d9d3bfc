//! The report as one HTML page.

pub mod html;
