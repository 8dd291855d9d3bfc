//! Finds the long-run motion of a machine, from one start or from many, at one value of its numbers or over a range of them.
//!
//! ```text
//! start  ->  long_run, attractors_of  ->  at a value (Point, Attractor)  ->  over values (Survey; Sweep)
//! ```
//!
//! | module | contents |
//! |---|---|
//! | `starts` | where runs begin: starts that are given, or a sample that stands for all |
//! | `ensemble` | the motions on which one start, or several, settle |
//! | `point` | the motion of one start, in numbers: a point of a chart, a row of a diagram |
//! | `axis` | the values of a number that a survey goes through |
//! | `limits` | limits of the numbers that a user asks with |
//! | `over` | the machines over one number, at any value |
//! | `grid` | the machines over one number or two, side by side |
//! | `sweep` | runs over one number, recorded and not judged |
//! | `pipeline` | the rows of a sweep, in order and in bounded memory |
//! | `places` | the positions of those rows, without the rest of their data |
//! | `threads` | the threads that all this runs on |

mod axis;
mod ensemble;
mod grid;
#[doc(hidden)]
pub mod limits;
mod over;
mod pipeline;
mod places;
mod point;
mod starts;
mod sweep;
mod threads;

pub use axis::{Spacing, Values, VariedNumber};
pub use over::{Over, OverError};
pub use starts::{Placed, Sample, Start};

#[doc(hidden)]
pub use axis::{Axis, Place};
#[doc(hidden)]
pub use ensemble::{Attractor, Ensemble, Failed, Judged, Wandering, attractors_of, long_run, outlasts, soon_rested};
#[doc(hidden)]
pub use grid::{GridResults, RunError, Survey, SurveyError};
#[doc(hidden)]
pub use pipeline::{Counted, RecordBlock, SweepTally};
#[doc(hidden)]
pub use places::Places;
#[doc(hidden)]
pub use point::{Point, growth};
#[doc(hidden)]
pub use starts::Starts;
#[doc(hidden)]
pub use sweep::{Beginning, Find, Growth, RecordRow, Section, Seen, Sweep, SweepStart, recurrence, settled_impacts};
pub(crate) use threads::on_threads;
#[doc(hidden)]
pub use threads::{SweepError, threads};
