//! The page of each command, laid out from what was found.

pub mod basins;
pub mod branch;
pub mod cam;
pub mod claims;
pub mod curve;
mod local_map;
mod locate;
pub mod orbit;
pub mod report;
pub mod speeds;
mod verify;

pub use basins::BasinsSummary;
pub use orbit::OrbitDocument;
pub use report::Dossier;
pub use speeds::RegimesDocument;
