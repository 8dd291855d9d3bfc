//! Proofs of chaos: boxes of impacts that the impact map stretches across each other.
//!
//! An h-set N is a parallelogram of impacts, with a direction that the map stretches and one that it shrinks. Strips of N, over its whole
//! height, are each carried across N by a number of impacts. Then every sequence of strips, in both directions, is followed by a motion
//! (covering relations: Zgliczynski and Gidea 2004). If the strips also keep cones, there is only one such motion. These motions form a
//! chaotic set. The proof does not show that other motions approach it. If a region is found that the map sends into itself, all motions in
//! it stay there.
//!
//! | module | contents |
//! |---|---|
//! | `map` | the impact map over a box: enclosed, with derivatives, and proved to be the first impact |
//! | `frame` | the coordinates of an h-set, and the images of boxes in them |
//! | [`mod@prove`] | proofs that strips cover, and keep cones |
//! | `entropy` | the resulting topological entropy, per revolution |
//! | `base`, `sample` | saddles at which an h-set may begin; impacts along a line, by simulation |
//! | [`mod@find`] | search for an h-set of any machine, and its proof |
//! | [`region`] | sets of impacts that are followed by impacts in the set for ever |
//! | `known` | stored h-sets |

mod base;
mod entropy;
pub mod find;
mod frame;
mod known;
mod map;
pub mod prove;
pub mod region;
pub(crate) mod sample;

use serde::{Deserialize, Serialize};

pub use entropy::entropy;
pub use frame::{HSetFrame, Image};
pub use known::known;
pub use map::{ImpactMap, UnprovedFlight};

/// Parallelogram of impacts, `centre + x unstable + y stable`, with strips that are carried across it.
///
/// A plane point is the cam's angle at an impact, degrees, and the velocity after it relative to the cam, m/s.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HSet {
    /// Range of speeds, rpm.
    pub rpm: [f64; 2],
    /// Point with x = y = 0.
    pub centre: [f64; 2],
    /// Direction of x.
    pub unstable: [f64; 2],
    /// Direction of y.
    pub stable: [f64; 2],
    /// Range of x.
    pub x: [f64; 2],
    /// Range of y.
    pub y: [f64; 2],
    /// Slope L of the cones `|dy| <= L |dx|`; `None` if the strips need only cover.
    pub cone_slope: Option<f64>,
    /// Strips, each over all of y.
    pub strips: Vec<Strip>,
}

impl HSet {
    /// Lower bound on the topological entropy per revolution, if the strips cover.
    pub fn entropy(&self) -> f64 {
        entropy(&self.strips.iter().map(|strip| strip.revolutions).collect::<Vec<_>>())
    }

    /// Cam angle, degrees, and relative velocity, m/s, at x and y.
    pub fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|side| self.centre[side] + x * self.unstable[side] + y * self.stable[side])
    }
}

/// Part of an h-set between two values of x, with the impacts and revolutions until it returns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Strip {
    /// Number of impacts until it is carried across the h-set.
    pub impacts: u64,
    /// Number of turns of the cam until then.
    pub revolutions: u64,
    /// Range of x.
    pub x: [f64; 2],
}
