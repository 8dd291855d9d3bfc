//! Everything that is found about one model, as one document and one HTML page.

pub mod dossier;
pub mod html;
pub mod quantities;
pub mod through;

pub use dossier::Dossier;
