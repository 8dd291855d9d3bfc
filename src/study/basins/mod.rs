//! The motion that each start ends on, and the borders between basins.
//!
//! | module | contents |
//! |---|---|
//! | [`grid`] | a grid of starts on a section, side by side |
//! | `over` | the shares of the basins over a number of the model |
//! | [`manifold`] | the stable and unstable manifolds of a saddle |
//! | `section` | the starts on a section of a model, the orbits that cross it, the curves that separate the basins |
//! | [`boundary`] | points of the border between two basins, by halving; the distance between a saddle's two manifolds |

pub mod boundary;
pub mod grid;
pub mod manifold;
mod over;
mod section;

pub use grid::{Basin, Basins, Grid, GridError, SectionStarts, States};
pub use manifold::{Curve, Extent, Reversed, Saddle};
pub use over::{BasinsAt, BasinsOver, Begun, SharesOf};
pub use section::{BasinBoundary, BasinSection, Summary};
