//! What the report's figures show, as numbers: motions, sweeps, branches, and the curves that the paper's maps are composed
//! of. Nothing is drawn here.
//!
//! | module | what it holds |
//! |---|---|
//! | [`subject`] | the model, its corner impact, and the speeds that are shown |
//! | [`outline`] | the cam as a shape |
//! | [`motion`] | what the follower does at one speed |
//! | [`sweep`] | what runs settle on over a range of speeds, and the branches of orbits there |
//! | [`composition`] | the paper's composition of its map, and the discontinuity mapping, with the model's own flow |
//! | [`local_map`] | the orbits of the local map, and the machine's beside them |
//! | [`mod@through_corner`] | orbits and runs at speeds on either side of the corner impact |

pub mod composition;
pub mod local_map;
pub mod motion;
pub mod outline;
pub mod plates;
pub mod plots;
pub mod run;
pub mod subject;
pub mod sweep;
pub mod through_corner;

pub use composition::{Composition, Neighbour};
pub use local_map::NextToCorner;
pub use motion::{Run, TRANSIENT};
pub use outline::Outline;
pub use run::{RunSummary, SweepSummary};
pub use subject::{Fast, Shown, Slow, Subject};
pub use sweep::{Crossings, Effort};
pub use through_corner::{ThroughCorner, through_corner};
