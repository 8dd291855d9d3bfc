//! What a machine does in the long run, from one start or from many.
//!
//! | module | what it holds |
//! |---|---|
//! | `starts` | where runs begin: starts that are given, or a sample that stands for all |
//! | `ensemble` | what one start comes to, and what several do |
//! | `point` | what one start comes to, in numbers: a point of a chart, a row of a diagram |

mod ensemble;
mod point;
mod starts;

pub use ensemble::{Ensemble, Failed, Part, Wandering, attractors_of, long_run};
pub use point::{Point, growth};
pub use starts::{Sample, Starts};
