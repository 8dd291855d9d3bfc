//! How what was found is shown: text for a terminal, JSON, CSV. Nothing is computed here.

pub mod command;
pub mod csv;
pub mod json;
pub mod page;

pub use page::Page;
