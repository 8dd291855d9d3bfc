//! One document value, several renderers, and one figure value, two renderers. No renderer computes anything but how many
//! digits to show; [`mod@file`] is how any of it reaches a disk.
//!
//! | what | modules |
//! |---|---|
//! | documents, each with its page of text | [`verification`], [`claims`], [`locate`], [`orbit`], [`regimes`], [`basins`], [`cam`], [`run`] |
//! | parts of documents | [`border_collision`], [`through`], [`quantities`], [`command`] |
//! | all of them in one, for [`html`] | [`dossier`] |
//! | tables of CSV | [`csv`], [`branch`], [`curve`] |
//! | renderers | [`json`], [`page`] (text for a terminal), [`html`] |
//! | pictures | [`mod@figure`] (the value and its renderers), [`figures`] (built from data), [`plates`] (those of a report) |

pub mod basins;
pub mod border_collision;
mod border_collision_text;
pub mod branch;
pub mod cam;
pub mod claims;
pub mod command;
pub mod csv;
pub mod curve;
pub mod dossier;
pub mod figure;
pub mod figures;
pub mod file;
pub mod html;
pub mod json;
pub mod locate;
pub mod orbit;
pub mod page;
pub mod plates;
pub mod quantities;
pub mod regimes;
pub mod run;
pub mod through;
pub mod verification;
mod verification_text;

pub use basins::BasinsSummary;
pub use cam::CamDocument;
pub use claims::ClaimsDocument;
pub use dossier::Dossier;
pub use locate::LocateDocument;
pub use orbit::OrbitDocument;
pub use page::Page;
pub use regimes::RegimesDocument;
pub use run::{RunSummary, SweepSummary};
pub use verification::Verification;
