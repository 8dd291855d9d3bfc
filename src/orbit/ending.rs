//! What a run can end on.

use serde::Serialize;

use super::PeriodicOrbit;
use crate::estimate::Estimate;
use crate::tolerance;

/// What a run ends on.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// The follower stays on the cam.
    Stays,
    /// A stable periodic orbit that does not rest on the cam.
    Orbit(PeriodicOrbit),
    /// It rests on the cam, and repeats what it did after it rested there before.
    Resting(Resting),
    /// None of these in the revolutions that were run, and small deviations grow: by how much a revolution, a natural logarithm.
    Chaotic(Estimate),
    /// None of these, and no growth that is above 0 by its error.
    Undecided(Estimate),
}

/// The kinds of motion that runs end on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
#[expect(missing_docs, reason = "as in Ending")]
pub enum Kind {
    Stays,
    Periodic,
    Resting,
    Chaotic,
    Undecided,
}

named!(Kind);

impl Ending {
    /// Its kind.
    pub fn kind(&self) -> Kind {
        match self {
            Self::Stays => Kind::Stays,
            Self::Orbit(_) => Kind::Periodic,
            Self::Resting(_) => Kind::Resting,
            Self::Chaotic(_) => Kind::Chaotic,
            Self::Undecided(_) => Kind::Undecided,
        }
    }

    /// Whether two runs of one machine end alike.
    ///
    /// Chaos, and a motion that bounces as chaos does until it rests, are taken for one motion: how soon a run of it rests is
    /// chance. Only many runs can tell chaos that does not rest beside one that does.
    pub fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Orbit(one), Self::Orbit(two)) => one.is_same(two),
            (Self::Resting(one), Self::Resting(two)) => one.is_same(two) || (one.is_long() && two.is_long()),
            (Self::Resting(resting), Self::Chaotic(_)) | (Self::Chaotic(_), Self::Resting(resting)) => {
                resting.is_long()
            }
            _ => self.kind() == other.kind(),
        }
    }

    /// Chaotic, if the growth of a small deviation is above 0 by its error; else undecided.
    pub fn by_growth(growth: Estimate) -> Self {
        let is_chaotic = growth.error < tolerance::CHAOTIC_EXPONENT.value * growth.value;
        if is_chaotic { Self::Chaotic(growth) } else { Self::Undecided(growth) }
    }

    /// The growth of a small deviation a revolution, a natural logarithm, where it does not repeat.
    pub fn growth(&self) -> Option<Estimate> {
        match self {
            Self::Chaotic(growth) | Self::Undecided(growth) => Some(*growth),
            _ => None,
        }
    }

    /// Revolutions from one rest to the next, in the mean, where it rests.
    pub fn between_rests(&self) -> Option<f64> {
        if let Self::Resting(resting) = self { Some(resting.between_rests()) } else { None }
    }

    /// Whether it rests so seldom that in between nothing tells it from chaos.
    pub fn is_long(&self) -> bool {
        matches!(self, Self::Resting(resting) if resting.is_long())
    }

    /// Turns of the cam and impacts of one period, where it repeats and doubles can tell after how long.
    pub fn period(&self) -> Option<(u64, u64)> {
        match self {
            Self::Stays => Some((1, 0)),
            Self::Orbit(orbit) => Some((orbit.revolutions, orbit.impacts().count() as u64)),
            Self::Resting(resting) if !resting.is_long() => Some((resting.revolutions, resting.impacts)),
            Self::Resting(_) | Self::Chaotic(_) | Self::Undecided(_) => None,
        }
    }
}

/// A motion of which the cam lets go again and again: an orbit, however long, since nothing but the angle of a release decides
/// what follows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Resting {
    /// Where the cam lets go, rad, in the order of one period.
    pub releases: Vec<f64>,
    /// Turns of the cam in one period.
    pub revolutions: u64,
    /// Impacts in one period.
    pub impacts: u64,
    /// The speed of the fastest of them, of follower and cam against each other, m/s.
    pub impact_speed: f64,
    /// What a deviation grows by from a release to the next rest, at most: a natural logarithm.
    pub growth: f64,
}

impl Resting {
    /// Revolutions from one rest to the next, in the mean.
    pub fn between_rests(&self) -> f64 {
        self.revolutions as f64 / self.releases.len() as f64
    }

    /// Whether it rests so seldom that rounding decides when: in between it is chaos, and its period is that of the rounded run.
    pub fn is_long(&self) -> bool {
        self.growth > (tolerance::SAME_ORBIT.value / tolerance::ULP.value).ln()
    }

    /// Whether two of them have a release in common: one motion at most goes on from there.
    fn is_same(&self, other: &Self) -> bool {
        self.releases.iter().any(|one| other.releases.iter().any(|two| is_same_release(*one, *two)))
    }
}

/// Whether two angles, rad, are one place where the cam lets go.
pub fn is_same_release(one: f64, two: f64) -> bool {
    (one - two).abs() <= tolerance::SAME_ORBIT.value
}
