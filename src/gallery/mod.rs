//! What the report's figures show, as numbers: motions, sweeps, branches, and the curves that the paper's maps are composed
//! of. Nothing is drawn here.

mod subject;

pub use subject::{Shown, Subject};
