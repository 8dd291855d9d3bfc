//! Which motion a start ends on, and what parts the starts that end on one from those that end on another.
//!
//! | module | what it holds |
//! |---|---|
//! | [`grid`] | a grid of starts on a section, side by side |
//! | `over` | the shares of the basins over a number of the model |
//! | [`manifold`] | the curves along which a saddle is approached and left |
//! | `section` | the starts on a section of a model, the orbits that cross it, the curves that part the basins |
//! | [`boundary`] | points of the border between two basins, by halving; how near a manifold comes back to the saddle's other |

pub mod boundary;
pub mod grid;
pub mod manifold;
mod over;
mod section;

pub use grid::{Basin, Basins, Grid, GridError, SectionStarts, States};
pub use manifold::{Curve, Extent, Reversed, Saddle};
pub use over::{BasinsAt, BasinsOver, Begun, SharesOf};
pub use section::{BasinBoundary, BasinSection, Summary};
