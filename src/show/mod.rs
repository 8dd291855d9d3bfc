//! How what was found is shown: blocks on a terminal, in a browser and as Markdown; JSON; CSV. Nothing is computed here.
//!
//! An enum becomes words in [`words`] and a number digits in [`digits`], and nowhere else.

pub mod block;
pub mod command;
pub mod csv;
pub mod digits;
pub mod html;
pub mod json;
pub mod markdown;
pub mod page;
pub mod words;

pub use page::{Page, Paged};
