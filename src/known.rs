//! Evidence for results: the word that every result carries, in documents and on pages.

use serde::{Deserialize, Serialize};

/// Kind of evidence for a result; the strongest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Evidence {
    /// Result of algebra, or of enclosures that leave no case out.
    Proved,
    /// Result of a computation in rounded numbers, compared with a tolerance.
    Computed,
    /// Result of computations for some cases out of many; the cases between them are not examined.
    Sampled,
    /// Finding of a person who read a text or a figure; no computation supports it.
    Read,
}

named!(Evidence);

impl Evidence {
    /// Returns `Proved` if a proof exists, else `Sampled`.
    pub fn proved_if(is_proved: bool) -> Self {
        if is_proved { Self::Proved } else { Self::Sampled }
    }
}

/// Claim that a list contains all orbits of a number of revolutions and impacts, with its evidence.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[doc(hidden)]
pub struct Complete {
    /// Turns of the cam in one period.
    pub revolutions: u64,
    /// Impacts in one period.
    pub impacts: usize,
    /// `Proved` if no region is left undecided.
    pub known: Evidence,
}
