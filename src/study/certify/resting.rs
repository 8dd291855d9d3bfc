//! Motions that rest on the cam, found and proved by the script alone.

use serde::{Deserialize, Serialize};
use serde_json::json;

use super::{Assumed, CertifyError, ask, hypotheses};
use crate::ball::Ball;
use crate::known::Evidence;
use crate::model::Model;

/// What becomes of a follower that rests on the cam at a speed.
#[derive(Clone, Debug, Deserialize)]
pub struct ProvedResting {
    /// Speed, rpm; the decimal that it is written as.
    #[serde(skip)]
    pub speed_rpm: f64,
    /// Bits that the balls were computed with: as many as it took.
    pub bits: u32,
    /// From where to where the cam presses against a follower that rests, rad.
    pub pressed_rad: Vec<[f64; 2]>,
    /// Where it lets go.
    pub releases: Vec<ProvedRelease>,
    /// Impacts up to which a rest was looked for.
    pub looked_at: u64,
    /// The motions that repeat.
    pub periodic: Vec<Round>,
    /// What is taken out of the cam.
    pub assumed: Option<Assumed>,
}

document!(ProvedResting as it {
    schema: "corner-impact/certify/1",
    speed_rpm: it.speed_rpm,
    bits: it.bits,
    known: Evidence::Proved,
    pressed_rad: it.pressed_rad,
    releases: it.releases,
    looked_at: it.looked_at,
    periodic: it.periodic,
    assumed: it.assumed,
    hypotheses: it.hypotheses(),
});

/// A place where the cam lets go of the follower.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct ProvedRelease {
    /// Where, rad.
    pub cam_angle_rad: Ball,
    /// What comes after it; none where that is not at rest again within the impacts that were looked at.
    pub next: Option<NextRelease>,
}

/// From a release to the next.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct NextRelease {
    /// Impacts before those without end, by which it comes to rest.
    pub impacts: u64,
    /// Where it is at rest at the latest, rad.
    pub rests_by_rad: f64,
    /// Which release is the next.
    pub release: usize,
    /// Turns of the cam from the one to the other, counted by whole ones: those between the revolutions that they are in.
    pub revolutions: u64,
}

/// A motion that repeats: from release to release, and round.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct Round {
    pub releases: Vec<usize>,
    pub impacts: u64,
    pub revolutions: u64,
}

impl ProvedResting {
    /// Hypotheses of the proofs.
    pub fn hypotheses(&self) -> Vec<String> {
        let mut all = hypotheses(self.assumed);
        all.push("impacts that follow each other without end put the follower to rest".into());
        all
    }

    /// Whether every motion that rests is proved to be periodic some time later.
    pub fn all_repeat(&self) -> bool {
        self.releases.iter().all(|release| release.next.is_some())
    }
}

/// What becomes of a follower that rests on the cam at a speed, rpm.
pub fn proved_resting(model: &Model, speed_rpm: f64, bits: u32) -> Result<ProvedResting, CertifyError> {
    let found: ProvedResting = ask(model, bits, ("resting_at_rpm", json!(speed_rpm)))?;
    Ok(ProvedResting { speed_rpm, ..found })
}
