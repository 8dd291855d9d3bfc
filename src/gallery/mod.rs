//! What the report's figures show, as numbers: motions, sweeps, branches, and the curves that the paper's maps are composed
//! of. Nothing is drawn here.

mod subject;
pub mod through_corner;

pub use subject::{Shown, Subject};
pub use through_corner::{ThroughCorner, through_corner};
