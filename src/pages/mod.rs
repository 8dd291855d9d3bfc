//! The page of each command, laid out from what was found.

use crate::show::block::Block;

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

/// Where a model's numbers come from, where it says so.
fn source(said: &str) -> Option<Block> {
    (!said.is_empty()).then(|| Block::paragraph(said))
}
