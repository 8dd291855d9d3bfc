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
//! | `over` | the machines over one number, at any value |
//! | `grid` | the machines over one number or two, side by side |
//! | `sweep` | runs over one number, recorded and not judged |
//! | `pipeline` | the rows of a sweep, in order and in bounded memory |
//! | `places` | the positions of those rows, without the rest of their data |
//! | `threads` | the threads that all this runs on |

mod axis;
mod ensemble;
mod grid;
mod over;
mod pipeline;
mod places;
mod point;
mod starts;
mod sweep;
mod threads;

pub use axis::{Axis, Place, Spacing, Values, VariedNumber};
#[doc(hidden)]
pub use ensemble::outlasts;
pub use ensemble::{Attractor, Ensemble, Failed, Judged, Wandering, attractors_of, long_run};
pub use grid::{GridResults, RunError, Survey, SurveyError};
pub use over::{Over, OverError};
pub use pipeline::{Counted, RecordBlock, SweepTally};
pub use places::Places;
pub use point::{Point, growth};
pub use starts::{Placed, Sample, Start, Starts};
pub use sweep::recurrence;
pub use sweep::{Beginning, Find, Growth, RecordRow, Section, Seen, Sweep, SweepStart, settled_impacts};
pub use threads::{SweepError, threads};
