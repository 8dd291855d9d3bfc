//! The page of each command, laid out from what was found.

mod basins;
pub(crate) mod branches;
pub mod cam;
mod certify;
mod chaos;
mod chart;
pub mod claims;
mod compare;
pub(crate) mod design;
pub(crate) mod explain;
mod local_map;
mod locate;
mod orbit;
pub mod report;
mod simulate;
mod speeds;
mod verify;
