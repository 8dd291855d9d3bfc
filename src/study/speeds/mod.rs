//! What a machine does over a range of speeds: on the cam, chattering, bouncing regularly, chaotic; and where that changes.
//!
//! The speeds are run through once upwards and once downwards, each run from where the one before ended, so that
//! hysteresis shows. A change between two speeds is bracketed by halving, and explained by the special point of a branch
//! of orbits if one begins or ends there. Two changes between neighbouring speeds are told apart only if each is
//! explained.

mod change;
mod run;
mod walk;

use std::sync::atomic::{AtomicU64, Ordering};

use serde::Serialize;

use crate::model::{Model, ModelError};
use crate::orbit::{Course, OrbitError, PeriodicOrbit};
use crate::progress::Watch;
use crate::simulate::SimulateError;
use crate::study::machine;
pub use change::{Cause, Change};
pub use run::detachment;

/// What a follower does in the long run at one speed.
#[derive(Clone, Debug, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Regime {
    /// It stays on the cam.
    OnCam,
    /// It bounces, chatters and sticks to the cam, and repeats.
    Chattering,
    /// It repeats, with an impact here and there.
    Regular,
    /// It never meets the cam.
    Free,
    /// It does not repeat; small deviations grow.
    Chaotic,
    /// It does not repeat within the revolutions that were run, and small deviations do not grow.
    Unsettled,
}

impl Regime {
    /// As they are listed.
    const IN_ORDER: [Self; 6] =
        [Self::OnCam, Self::Chattering, Self::Regular, Self::Chaotic, Self::Free, Self::Unsettled];
}

/// The long run at one speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Settled {
    /// Speed, rpm.
    pub rpm: f64,
    /// What it is.
    pub regime: Regime,
    /// The orbit that it is, if it repeats.
    pub orbit: Option<PeriodicOrbit>,
    /// Growth of a small deviation per revolution, where it does not.
    pub growth: Option<f64>,
}

document!(Settled as it {
    regime: it.regime,
    revolutions: it.period().map(|(revolutions, _)| revolutions),
    impacts: it.period().map(|(_, impacts)| impacts),
    lyapunov_per_revolution: it.growth,
});

impl Settled {
    fn of_orbit(rpm: f64, orbit: PeriodicOrbit) -> Self {
        let regime = match orbit.course {
            Course::Sticking(_) if orbit.events.is_empty() => Regime::OnCam,
            Course::Sticking(_) => Regime::Chattering,
            Course::Impacts(_) => Regime::Regular,
            Course::Free => Regime::Free,
        };
        Self { rpm, regime, orbit: Some(orbit), growth: None }
    }

    /// Turns of the cam and impacts of one period.
    pub fn period(&self) -> Option<(u64, usize)> {
        self.orbit.as_ref().map(|orbit| (orbit.revolutions, orbit.impacts().count()))
    }

    /// Whether two long runs are of one kind: the same regime, and if regular the same numbers of revolutions and impacts.
    pub fn is_like(&self, other: &Self) -> bool {
        self.regime == other.regime && (self.regime != Regime::Regular || self.period() == other.period())
    }
}

/// A range of speeds over which runs are of one kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stretch {
    /// Lowest and highest speed, rpm.
    pub rpm: [f64; 2],
    /// The long run at its first speed, in the direction of the walk.
    #[serde(flatten)]
    pub settled: Settled,
    /// What lies at its lower end; nothing at the lowest speed.
    pub begins: Option<Change>,
}

/// A range of speeds at which what is seen depends on where the speed comes from.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Hysteresis {
    /// Lowest and highest speed, rpm.
    pub rpm: [f64; 2],
    /// What rising speed shows.
    pub rising: Settled,
    /// What falling speed shows.
    pub falling: Settled,
}

/// Where one regime is seen.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Seen {
    /// Which.
    pub regime: Regime,
    /// Lowest and highest speed of each range, rpm, with rising or falling speed, overlaps joined.
    pub ranges: Vec<[f64; 2]>,
}

/// What a machine does over a range of speeds: the document of `speeds --json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Regimes {
    schema: &'static str,
    /// The model's name.
    pub model: String,
    /// The range, rpm.
    pub rpm: [f64; 2],
    /// Where the follower first leaves the cam, rpm; `None` where it never does, or even at rest would not stay on it.
    pub detachment_rpm: Option<f64>,
    /// The regimes that are seen.
    pub regimes: Vec<Seen>,
    /// Where rising and falling speed differ.
    pub hysteresis: Vec<Hysteresis>,
    /// By rising speed.
    pub rising: Vec<Stretch>,
    /// Those of falling speed; by rising speed, too.
    pub falling: Vec<Stretch>,
}

impl Regimes {
    /// Where rising and falling speed show something else, joined where they meet.
    pub fn hysteresis_ranges(&self) -> Vec<[f64; 2]> {
        joined(self.hysteresis.iter().map(|found| found.rpm).collect())
    }
}

/// Ranges, those that overlap or meet as one.
fn joined(mut all: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    all.sort_by(|one, two| one[0].total_cmp(&two[0]));
    let mut joined: Vec<[f64; 2]> = Vec::new();
    for [low, high] in all {
        match joined.last_mut() {
            Some(last) if low <= last[1] => last[1] = last[1].max(high),
            _ => joined.push([low, high]),
        }
    }
    joined
}

/// How finely a range is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Care {
    /// Speeds that are run.
    pub speeds: usize,
    /// Revolutions at each before anything is decided.
    pub settling: u64,
    /// The longest period that counts as regular, revolutions.
    pub longest_period: u64,
}

impl Default for Care {
    fn default() -> Self {
        Self { speeds: 300, settling: 400, longest_period: 400 }
    }
}

/// Why it could not be told.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RegimeError {
    /// The model is impossible.
    #[error("{0}")]
    Model(#[from] ModelError),
    /// A run could not go on.
    #[error("at {rpm} rpm: {error}")]
    Simulate {
        /// Speed, rpm.
        rpm: f64,
        /// Why.
        error: SimulateError,
    },
    /// A branch could not be followed.
    #[error(transparent)]
    Orbit(#[from] OrbitError),
}

/// The speeds to walk through where none are named, rpm: up to the fastest of `[study]`, or 1000, from a twentieth of that.
pub fn usual_speeds(model: &Model) -> [f64; 2] {
    let fastest = model.study.map_or(1000.0, |study| study.rpm_max);
    [0.05 * fastest, fastest]
}

/// Walks through `rpm` upwards and downwards, told to `watch` speed by speed.
pub fn regimes(model: &Model, rpm: [f64; 2], care: Care, watch: &dyn Watch) -> Result<Regimes, RegimeError> {
    let machine = machine(model, rpm[0])?;
    let detachment_rpm = detachment(model, rpm)?;
    let (done, total) = (AtomicU64::new(0), 2 * care.speeds as u64);
    let passed = || watch.at("other speeds", done.fetch_add(1, Ordering::Relaxed) + 1, total);
    let walk = |rising| walk::walk(model, &machine, rpm, care, rising, &passed);
    let (rising, falling) = rayon::join(|| walk(true), || walk(false));
    let ((rising, up), (falling, down)) = (rising?, falling?);
    let seen = |regime: Regime| {
        let stretches = rising.iter().chain(&falling).filter(|stretch| stretch.settled.regime == regime);
        Seen { regime, ranges: joined(stretches.map(|stretch| stretch.rpm).collect()) }
    };
    let regimes = Regime::IN_ORDER.map(seen).into_iter().filter(|seen| !seen.ranges.is_empty()).collect();
    let hysteresis = hysteresis(&rising, &falling, &up, &down);
    let (schema, model) = ("corner-impact/speeds/1", model.name.clone());
    Ok(Regimes { schema, model, rpm, detachment_rpm, regimes, hysteresis, rising, falling })
}

/// Where the two walks differ: between the ends of their stretches, and where runs of one kind are not one motion, between
/// the speeds that were run. `up` and `down` are those runs, both by rising speed.
fn hysteresis(rising: &[Stretch], falling: &[Stretch], up: &[Settled], down: &[Settled]) -> Vec<Hysteresis> {
    let mut ends: Vec<f64> = rising.iter().chain(falling).flat_map(|stretch| stretch.rpm).collect();
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let mut found = Vec::new();
    for rpm in ends.windows(2).map(|pair| [pair[0], pair[1]]) {
        let at = |walk: &[Stretch]| -> Option<Settled> {
            let holds = |stretch: &&Stretch| stretch.rpm[0] <= rpm[0] && rpm[1] <= stretch.rpm[1];
            walk.iter().find(holds).map(|stretch| stretch.settled.clone())
        };
        let Some((rising, falling)) = at(rising).zip(at(falling)) else { continue };
        if of_other_kind(&rising, &falling) {
            found.push(Hysteresis { rpm, rising, falling });
            continue;
        }
        let inside = |(one, _): &(&Settled, &Settled)| rpm[0] <= one.rpm && one.rpm <= rpm[1];
        let mut open = false;
        for (one, other) in up.iter().zip(down).filter(inside) {
            let differ = of_other_motion(one, other);
            match found.last_mut() {
                Some(last) if differ && open => last.rpm[1] = one.rpm,
                _ if differ => {
                    let rpm = [one.rpm; 2];
                    found.push(Hysteresis { rpm, rising: one.clone(), falling: other.clone() });
                }
                _ => {}
            }
            open = differ;
        }
    }
    found
}

/// What does not repeat may be called chaotic at one time and not settled at another.
fn of_other_kind(one: &Settled, other: &Settled) -> bool {
    !one.is_like(other) && (one.orbit.is_some() || other.orbit.is_some())
}

/// Chattering, one period and another are told apart by where rounding had a say.
fn of_other_motion(one: &Settled, other: &Settled) -> bool {
    match (&one.orbit, &other.orbit) {
        _ if one.regime == Regime::Chattering && other.regime == Regime::Chattering => false,
        (Some(orbit), Some(of_other)) => one.is_like(other) && !orbit.is_same(of_other),
        _ => false,
    }
}
