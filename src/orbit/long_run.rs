//! The long-run motion that a run ends on, and the budget of revolutions within which it is judged.
//!
//! All commands judge runs by this rule. [`super::runs`] follows a run until it settles on an orbit, stays on the cam or rests there.
//! `study::survey` judges several runs at once. Those that wander share the revolutions that decide whether such motions ever rest.

use std::f64::consts::LN_2;

use serde::Serialize;

use super::PeriodicOrbit;
use crate::elementary;
use crate::estimate::{ErrorIs, Estimate};
use crate::simulate::ImpactTally;
use crate::simulate::Record;
use crate::tolerance;

/// Revolutions for which runs are followed before their long-run motion is decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Budget {
    /// Revolutions within which a run should settle.
    pub transient: u64,
    /// Revolutions after that over which the growth of a deviation is recorded, if the run settles on nothing. Up to [`Self::RECORDS`]
    /// times as many are recorded while the growth is undecided.
    pub record: u64,
    /// The longest period looked for, revolutions.
    pub longest: u64,
    /// Total revolutions for which all runs that settle on nothing are followed before their growth is recorded. A motion that runs leave
    /// once in a tenth of these revolutions is seen to be left.
    pub patience: u64,
}

impl Budget {
    /// The default of `speeds`, `basins`, `simulate` and `diagram --attractors`: all runs of a speed share the patience, and one run can
    /// afford it.
    pub const SURVEY: Self = Self { transient: 200, record: 1600, longest: 32, patience: 100_000 };
    /// The default of `chart` and `diagram`: they run thousands of points, and a chaotic run costs all the revolutions for which it is
    /// followed.
    pub const CHART: Self = Self { transient: 300, record: 100, longest: 32, patience: 0 };
    /// The default of `design`: a rare rest causes no load that does not occur without it.
    pub const DESIGN: Self = Self { transient: 200, record: 200, longest: 32, patience: 0 };

    /// Most records of a run, after which it is undecided.
    pub const RECORDS: u64 = 8;
    /// Most revolutions that an option of a budget accepts.
    pub const MOST: u64 = 1_000_000_000;

    /// Revolutions within which a follower that has rested should rest again.
    pub fn rest(&self) -> u64 {
        /// Divisor of the patience.
        const SHARE: u64 = 5;
        self.transient.max(self.patience / SHARE)
    }

    /// Revolutions allowed for the next rest of a follower that rested while its growth was recorded, since rests are rarer there.
    pub fn later_rest(&self) -> u64 {
        self.rest().max(self.transient.saturating_add(self.record))
    }

    /// Revolutions of a block. The growth is the mean over blocks.
    pub fn block(&self) -> u64 {
        /// Fewest blocks of a record, and most revolutions of one.
        const PARTS: u64 = 8;
        const LONGEST: u64 = 25;
        (self.record / PARTS).clamp(1, LONGEST)
    }
}

/// The long-run motion of a run.
#[derive(Clone, Debug, PartialEq)]
pub enum LongRun {
    /// The follower stays on the cam.
    PermanentContact,
    /// A stable periodic orbit that does not rest on the cam.
    Orbit(PeriodicOrbit),
    /// The follower rests on the cam, and repeats its motion from an earlier rest.
    Sticking(StickingOrbit),
    /// Chaotic: no period found within the run, and small deviations grow exponentially.
    Chaotic(Recorded),
    /// Undecided: no period found within the run, and exponential growth is not certain either.
    Undecided(Recorded),
}

/// Growth and impacts of a motion that settles on nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct Recorded {
    /// Growth of a small deviation per revolution, a natural logarithm.
    pub growth: Estimate,
    /// Total growth over the first half of the record and over the second, not per revolution.
    pub halves: [f64; 2],
    /// Tally of the impacts.
    pub met: ImpactTally,
    /// Revolutions of all runs together.
    pub revolutions: u64,
    /// Number of runs recorded.
    pub runs: u64,
    /// Whether any run rested on the way.
    pub rested: bool,
}

impl Recorded {
    /// Growth and impacts of one record.
    pub fn of(record: &Record) -> Self {
        let (growth, halves) = (record.growth(), record.halves());
        Self { growth, halves, met: record.met, revolutions: record.revolutions, runs: 1, rested: record.rests() }
    }

    /// The mean growth of several runs, with all their impacts.
    pub fn together(all: &[Self]) -> Self {
        let growth = Estimate::mean(&all.iter().map(|one| one.growth).collect::<Vec<_>>());
        let half = |half: usize| all.iter().map(|one| one.halves[half]).sum::<f64>() / all.len() as f64;
        let met = all.iter().fold(ImpactTally::default(), |all, one| all.with(one.met));
        let sum = |number: fn(&Self) -> u64| all.iter().map(number).sum();
        let (revolutions, runs) = (sum(|one| one.revolutions), sum(|one| one.runs));
        let rested = all.iter().any(|one| one.rested);
        Self { growth, halves: [half(0), half(1)], met, revolutions, runs, rested }
    }

    /// Mean revolutions per run.
    pub fn each(self) -> u64 {
        self.revolutions / self.runs.max(1)
    }

    /// Whether the motion has impacts, and deviations grow by more than their error, and exponentially.
    ///
    /// A deviation that grows as a power n^d of the revolutions, as in a motion without loss, gains d ln 2 over the second half of a
    /// record, and far more over the first. An exponential gains as much over either half, except for chance.
    fn is_chaotic(&self) -> bool {
        /// Power that is distinguished from an exponential.
        const POWER: f64 = 3.0;
        let (growth, [first, second]) = (self.growth, self.halves);
        let is_seen = growth.error < tolerance::CHAOTIC_EXPONENT.value * growth.value;
        let is_exponential = second > POWER * LN_2 && second > tolerance::LATER_GROWTH.value * first;
        self.met.impacts > 0 && is_seen && is_exponential
    }
}

/// The kinds of motion that runs end on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
#[expect(missing_docs, reason = "as in LongRun")]
pub enum Kind {
    Stays,
    Periodic,
    Resting,
    Chaotic,
    Undecided,
}

named!(Kind);

impl LongRun {
    /// Kind of the motion.
    pub fn kind(&self) -> Kind {
        match self {
            Self::PermanentContact => Kind::Stays,
            Self::Orbit(_) => Kind::Periodic,
            Self::Sticking(_) => Kind::Resting,
            Self::Chaotic(_) => Kind::Chaotic,
            Self::Undecided(_) => Kind::Undecided,
        }
    }

    /// Whether two runs of one machine end on the same motion.
    ///
    /// Chaos counts as the same motion as one that bounces chaotically until it rests, since chance decides how soon a run rests. Only many
    /// runs can distinguish chaos that does not rest from chaos that does.
    pub fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Orbit(one), Self::Orbit(two)) => one.is_same(two),
            (Self::Sticking(one), Self::Sticking(two)) => one.is_same(two) || (one.is_long() && two.is_long()),
            (Self::Sticking(resting), Self::Chaotic(_)) | (Self::Chaotic(_), Self::Sticking(resting)) => {
                resting.is_long()
            }
            _ => self.kind() == other.kind(),
        }
    }

    /// Classifies a motion that settles on nothing by its record, as chaotic or undecided.
    pub fn by_growth(recorded: Recorded) -> Self {
        if recorded.is_chaotic() { Self::Chaotic(recorded) } else { Self::Undecided(recorded) }
    }

    /// Growth of a small deviation per revolution, a natural logarithm. For an orbit it follows from the multipliers. It is minus infinity
    /// where the follower rests, and otherwise the mean over the record.
    pub fn growth(&self) -> Estimate {
        let exactly = |value| Estimate { value, error: 0.0, error_is: ErrorIs::Correction };
        match self {
            Self::PermanentContact | Self::Sticking(_) => exactly(f64::NEG_INFINITY),
            Self::Orbit(orbit) => exactly(orbit.growth()),
            Self::Chaotic(recorded) | Self::Undecided(recorded) => recorded.growth,
        }
    }

    /// Growth and impacts of a motion that settles on nothing; `None` for others.
    pub fn of_growth(&self) -> Option<Recorded> {
        if let Self::Chaotic(recorded) | Self::Undecided(recorded) = self { Some(*recorded) } else { None }
    }

    /// Marks a recorded motion as one of a run that rested on the way.
    pub(super) fn having_rested(self) -> Self {
        match self {
            Self::Chaotic(recorded) => Self::Chaotic(Recorded { rested: true, ..recorded }),
            Self::Undecided(recorded) => Self::Undecided(Recorded { rested: true, ..recorded }),
            settled => settled,
        }
    }

    /// Whether the motion ends by chance alone, if at all: chaos, and motion that bounces as chaos does until it rests.
    pub fn wanders(&self) -> bool {
        self.of_growth().is_some() || self.is_long()
    }

    /// Mean revolutions from one rest to the next; `None` for a motion without rests.
    pub fn between_rests(&self) -> Option<f64> {
        if let Self::Sticking(orbit) = self { Some(orbit.between_rests()) } else { None }
    }

    /// Whether rests are so rare that the motion between them cannot be distinguished from chaos.
    pub fn is_long(&self) -> bool {
        matches!(self, Self::Sticking(resting) if resting.is_long())
    }

    /// Turns of the cam and impacts of one period, where the motion is periodic and doubles can resolve the period.
    pub fn period(&self) -> Option<(u64, u64)> {
        match self {
            Self::PermanentContact => Some((1, 0)),
            Self::Orbit(orbit) => Some((orbit.revolutions, orbit.impacts().count() as u64)),
            Self::Sticking(resting) if !resting.is_long() => Some((resting.revolutions, resting.impacts)),
            Self::Sticking(_) | Self::Chaotic(_) | Self::Undecided(_) => None,
        }
    }
}

/// A motion that the cam releases again and again. It is periodic, however long, since the angle of a release alone decides what follows.
#[derive(Clone, Debug, PartialEq)]
pub struct StickingOrbit {
    /// Angles of release, rad, in the order of one period.
    pub releases: Vec<f64>,
    /// Turns of the cam in one period.
    pub revolutions: u64,
    /// Impacts in one period.
    pub impacts: u64,
    /// Speed of the fastest impact, of follower and cam against each other, m/s.
    pub impact_speed: f64,
    /// Largest growth of a deviation from a release to the next rest, a natural logarithm; a lower bound if rounding decides what follows.
    pub growth: f64,
}

impl StickingOrbit {
    /// Mean revolutions from one rest to the next.
    pub fn between_rests(&self) -> f64 {
        self.revolutions as f64 / self.releases.len() as f64
    }

    /// Whether rests are so rare that rounding decides when they occur. Between them the motion is chaotic, and its period is that of the
    /// rounded run.
    pub fn is_long(&self) -> bool {
        self.growth > Self::long()
    }

    /// Growth beyond which rounding decides what follows: one ulp becomes the distance from which on two releases differ.
    pub(super) fn long() -> f64 {
        elementary::ln(tolerance::SAME_ORBIT.value / tolerance::ULP.value)
    }

    /// Whether two orbits have a release in common. Then they are the same motion, since at most one continues from there.
    fn is_same(&self, other: &Self) -> bool {
        self.releases.iter().any(|one| other.releases.iter().any(|two| is_same_release(*one, *two)))
    }
}

/// Whether two angles, rad, are the same place of release.
#[doc(hidden)]
pub fn is_same_release(one: f64, two: f64) -> bool {
    (one - two).abs() <= tolerance::SAME_ORBIT.value
}
