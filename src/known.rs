//! How a result is known: the word that every result carries, in documents and on pages.

use serde::{Deserialize, Serialize};

/// How a result is known; the strongest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Evidence {
    /// By algebra, or by enclosures that leave no case out.
    Proved,
    /// By a computation in rounded numbers, held against a tolerance.
    Computed,
    /// By computations for some cases out of many; what lies between the cases is not looked at.
    Sampled,
    /// By somebody who read it; nothing was computed.
    Read,
}

named!(Evidence);

impl Evidence {
    /// Proved where something is; else no more than what a search says.
    pub fn proved_if(is_proved: bool) -> Self {
        if is_proved { Self::Proved } else { Self::Sampled }
    }
}

/// A list of orbits has all of so many revolutions and impacts, and how that is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[doc(hidden)]
pub struct Complete {
    /// Turns of the cam in one period.
    pub revolutions: u64,
    /// Impacts in one period.
    pub impacts: usize,
    /// Proved where no place is left undecided.
    pub known: Evidence,
}
