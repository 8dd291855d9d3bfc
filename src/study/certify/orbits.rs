//! Periodic orbits of one impact and of two in one revolution, found and proved by the script alone.

use serde::{Deserialize, Serialize};
use serde_json::json;

use super::{Assumed, CertifyError, ask, hypotheses};
use crate::ball::Ball;
use crate::known::Evidence;
use crate::model::Model;

/// The periodic orbits of one impact and of two in one revolution at a speed, found and proved by the script alone.
#[derive(Clone, Debug, Deserialize)]
pub struct ProvedOrbits {
    /// Speed, rpm; the decimal that it is written as.
    #[serde(skip)]
    pub speed_rpm: f64,
    /// Bits that the balls were computed with.
    #[serde(skip)]
    pub bits: u32,
    /// Each once.
    pub orbits: Vec<ProvedOrbit>,
    /// The numbers of impacts for which there are proved to be no others.
    pub complete: Vec<usize>,
    /// Where there may be others.
    pub undecided: Vec<UndecidedOrbit>,
    /// What is taken out of the cam.
    pub assumed: Option<Assumed>,
}

document!(ProvedOrbits as it {
    schema: "corner-impact/certify/1",
    speed_rpm: it.speed_rpm,
    bits: it.bits,
    known: Evidence::proved_if(!(it.orbits.is_empty() && it.complete.is_empty())),
    orbits: it.orbits,
    complete: it.complete,
    undecided: it.undecided,
    assumed: it.assumed,
    hypotheses: it.hypotheses(),
});

impl ProvedOrbits {
    /// Hypotheses of the proofs.
    pub fn hypotheses(&self) -> Vec<String> {
        hypotheses(self.assumed)
    }
}

/// Where it is not decided whether there is an orbit, or whether it is one of the machine.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct UndecidedOrbit {
    pub impacts: usize,
    /// From where to where each impact may be, rad.
    pub cam_angles_rad: Vec<[f64; 2]>,
}

/// A periodic orbit: its flights are clear of the cam, and it is alone near its impacts.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct ProvedOrbit {
    pub revolutions: u64,
    pub impacts: Vec<ProvedStart>,
    pub kind: OrbitKind,
}

/// Where a flight of an orbit starts: the velocity after the impact, relative to the cam.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct ProvedStart {
    pub cam_angle_rad: Ball,
    pub relative_velocity_m_s: Ball,
}

/// What the multipliers of an orbit are proved to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum OrbitKind {
    /// Both inside of the unit circle.
    Stable,
    /// One is above 1.
    Saddle,
    /// One is below -1.
    Flip,
    /// A pair outside of the unit circle.
    Unstable,
    /// A pair on the unit circle: the follower loses nothing.
    Neutral,
}

named!(OrbitKind, OrbitEvent);

/// All orbits of one impact and of two in one revolution at a speed, rpm.
pub fn proved_orbits(model: &Model, speed_rpm: f64, bits: u32) -> Result<ProvedOrbits, CertifyError> {
    let found: ProvedOrbits = ask(model, bits, ("orbits_at_rpm", json!(speed_rpm)))?;
    Ok(ProvedOrbits { speed_rpm, bits, ..found })
}

/// How many orbits of one impact in one revolution there are at every speed of a range, found and proved by the script alone.
#[derive(Clone, Debug, Deserialize)]
pub struct ProvedCounts {
    /// The range of speeds, rpm.
    #[serde(skip)]
    pub range_rpm: [f64; 2],
    /// Bits that the balls were computed with.
    #[serde(skip)]
    pub bits: u32,
    /// By rising speed, from one event to the next.
    pub counts: Vec<ProvedCount>,
    /// Speeds, rpm, at which the number is not decided.
    pub undecided: Vec<[f64; 2]>,
    /// By rising speed.
    pub events: Vec<ProvedEvent>,
    /// What is taken out of the cam.
    pub assumed: Option<Assumed>,
}

document!(ProvedCounts as it {
    schema: "corner-impact/certify/1",
    rpm: it.range_rpm,
    bits: it.bits,
    known: Evidence::proved_if(!it.counts.is_empty()),
    counts: it.counts,
    undecided: it.undecided,
    events: it.events,
    assumed: it.assumed,
    hypotheses: it.hypotheses(),
});

impl ProvedCounts {
    /// Hypotheses of the proofs.
    pub fn hypotheses(&self) -> Vec<String> {
        hypotheses(self.assumed)
    }
}

/// The number of orbits at every speed between two; at an event, whose ball says where it is, the nearest doubles.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct ProvedCount {
    pub from_rpm: f64,
    pub to_rpm: f64,
    pub one_impact_orbits: usize,
    /// Of each of them; none where that is not decided.
    pub kinds: Vec<Option<OrbitKind>>,
}

/// The one speed, near its ball, at which an orbit appears, vanishes or changes.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct ProvedEvent {
    /// What happens.
    pub kind: OrbitEvent,
    /// Speed, rpm.
    pub speed_rpm: Ball,
    /// Of the impact, rad.
    pub cam_angle_rad: Ball,
    /// The kinds of all orbits at the speeds before it; none where their number is not decided.
    pub before: Option<Vec<Option<OrbitKind>>>,
    /// And after it.
    pub after: Option<Vec<Option<OrbitKind>>>,
}

/// What happens to an orbit of one impact as the speed rises.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum OrbitEvent {
    /// Its impact is on a corner of the cam.
    CornerImpact,
    /// Two orbits are one.
    Fold,
    /// A multiplier is -1.
    Flip,
    /// Its flight touches the cam.
    Graze,
}

/// The number of orbits of one impact in one revolution at every speed of a range, rpm.
pub fn proved_counts(model: &Model, range_rpm: [f64; 2], bits: u32) -> Result<ProvedCounts, CertifyError> {
    let found: ProvedCounts = ask(model, bits, ("orbits_over_rpm", json!(range_rpm)))?;
    Ok(ProvedCounts { range_rpm, bits, ..found })
}
