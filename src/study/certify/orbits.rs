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
    /// Speed, rpm; the decimal as written.
    #[serde(skip)]
    pub speed_rpm: f64,
    /// Precision of the balls, bits.
    #[serde(skip)]
    pub bits: u32,
    /// The orbits, each once.
    pub orbits: Vec<ProvedOrbit>,
    /// Numbers of impacts for which the list of orbits is proved complete.
    pub complete: Vec<usize>,
    /// Places where there may be further orbits.
    pub undecided: Vec<UndecidedOrbit>,
    /// Steps removed from the cam.
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

/// A place where the script does not decide whether there is an orbit, or whether the machine has it.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct UndecidedOrbit {
    pub impacts: usize,
    /// Range of each impact's cam angle, rad.
    pub cam_angles_rad: Vec<[f64; 2]>,
}

/// A periodic orbit. Its flights are clear of the cam, and no other orbit is near its impacts.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct ProvedOrbit {
    pub revolutions: u64,
    pub impacts: Vec<ProvedStart>,
    pub kind: OrbitKind,
}

/// Start of a flight of an orbit: the velocity after the impact, relative to the cam.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct ProvedStart {
    pub cam_angle_rad: Ball,
    pub relative_velocity_m_s: Ball,
}

/// Kind of an orbit by its multipliers, as proved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum OrbitKind {
    /// Both are inside the unit circle.
    Stable,
    /// One is above 1.
    Saddle,
    /// One is below -1.
    Flip,
    /// A complex pair is outside the unit circle.
    Unstable,
    /// A complex pair is on the unit circle: the follower loses nothing.
    Neutral,
}

named!(OrbitKind, OrbitEvent);

/// Finds and proves all orbits of one impact and of two in one revolution at a speed, rpm.
pub fn proved_orbits(model: &Model, speed_rpm: f64, bits: u32) -> Result<ProvedOrbits, CertifyError> {
    let found: ProvedOrbits = ask(model, bits, ("orbits_at_rpm", json!(speed_rpm)))?;
    Ok(ProvedOrbits { speed_rpm, bits, ..found })
}

/// Number of orbits of one impact in one revolution at every speed of a range, found and proved by the script alone.
#[derive(Clone, Debug, Deserialize)]
pub struct ProvedCounts {
    /// The range of speeds, rpm.
    #[serde(skip)]
    pub range_rpm: [f64; 2],
    /// Precision of the balls, bits.
    #[serde(skip)]
    pub bits: u32,
    /// The numbers of orbits, by rising speed, from one event to the next.
    pub counts: Vec<ProvedCount>,
    /// Speeds, rpm, at which the number is not decided.
    pub undecided: Vec<[f64; 2]>,
    /// Events, by rising speed.
    pub events: Vec<ProvedEvent>,
    /// Steps removed from the cam.
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

/// The number of orbits at every speed between two. At an event the ends are the doubles nearest to its ball.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct ProvedCount {
    pub from_rpm: f64,
    pub to_rpm: f64,
    pub one_impact_orbits: usize,
    /// Kind of each orbit; none if not decided.
    pub kinds: Vec<Option<OrbitKind>>,
}

/// The one speed, near its ball, at which an orbit appears, vanishes or changes.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct ProvedEvent {
    /// Kind of event.
    pub kind: OrbitEvent,
    /// Speed, rpm.
    pub speed_rpm: Ball,
    /// Cam angle of the impact, rad.
    pub cam_angle_rad: Ball,
    /// Kinds of all orbits at the speeds before the event; none if their number is not decided.
    pub before: Option<Vec<Option<OrbitKind>>>,
    /// Kinds of all orbits at the speeds after the event; none if their number is not decided.
    pub after: Option<Vec<Option<OrbitKind>>>,
}

/// Event of an orbit of one impact as the speed rises.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum OrbitEvent {
    /// The impact is on a corner of the cam.
    CornerImpact,
    /// Two orbits merge.
    Fold,
    /// A multiplier is -1.
    Flip,
    /// The flight grazes the cam.
    Graze,
}

/// Finds and proves the number of orbits of one impact in one revolution at every speed of a range, rpm.
pub fn proved_counts(model: &Model, range_rpm: [f64; 2], bits: u32) -> Result<ProvedCounts, CertifyError> {
    let found: ProvedCounts = ask(model, bits, ("orbits_over_rpm", json!(range_rpm)))?;
    Ok(ProvedCounts { range_rpm, bits, ..found })
}
