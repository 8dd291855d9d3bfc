//! One document value, several renderers, and one figure value, two renderers. No renderer computes anything but how many
//! digits to show; [`mod@file`] is how any of it reaches a disk.

pub mod basins;
pub mod border_collision;
mod border_collision_text;
pub mod branch;
pub mod cam;
pub mod claims;
pub mod csv;
pub mod curve;
pub mod document;
pub mod figure;
pub mod figures;
pub mod file;
pub mod json;
pub mod locate;
pub mod orbit;
pub mod page;
pub mod plates;
pub mod regimes;
pub mod run;
pub mod text;

pub use basins::BasinsSummary;
pub use cam::CamDocument;
pub use claims::ClaimsDocument;
pub use document::Verification;
pub use locate::LocateDocument;
pub use orbit::OrbitDocument;
pub use page::Page;
pub use regimes::RegimesDocument;
pub use run::{RunSummary, SweepSummary};
