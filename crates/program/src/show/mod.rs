//! Output of results: blocks on a terminal, in a browser and as Markdown; JSON; CSV. Nothing is computed here.
//!
//! Enums become words only in `words`, and numbers become digits only in `digits`.

pub(crate) mod block;
pub(crate) mod csv;
pub mod digits;
pub(crate) mod html;
pub mod markdown;
pub(crate) mod matplotlib;
pub mod notes;
pub(crate) mod page;
pub(crate) mod sources;
pub(crate) mod words;

pub use page::{Page, Paged};
