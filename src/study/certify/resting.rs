//! Motions that rest on the cam, found and proved by the script alone.

use serde::{Deserialize, Serialize};
use serde_json::json;

use super::{Assumed, CertifyError, ask, hypotheses};
use crate::ball::Ball;
use crate::known::Evidence;
use crate::model::Model;

/// Long-run behaviour of a follower that rests on the cam at a speed.
#[derive(Clone, Debug, Deserialize)]
pub struct ProvedResting {
    /// Speed, rpm; the decimal as written.
    #[serde(skip)]
    pub speed_rpm: f64,
    /// Precision of the balls that the proofs needed, bits.
    pub bits: u32,
    /// Ranges of cam angle, rad, in which the cam presses against a resting follower.
    pub pressed_rad: Vec<[f64; 2]>,
    /// Places where the cam releases the follower.
    pub releases: Vec<ProvedRelease>,
    /// Largest number of impacts within which a rest was looked for.
    pub looked_at: u64,
    /// The periodic motions.
    pub periodic: Vec<Round>,
    /// Steps removed from the cam.
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

/// A place where the cam releases the follower.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct ProvedRelease {
    /// Cam angle, rad.
    pub cam_angle_rad: Ball,
    /// The next release; none if the follower does not rest again within the impacts examined.
    pub next: Option<NextRelease>,
}

/// The way from one release to the next.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct NextRelease {
    /// Number of impacts before the infinite sequence that ends at rest.
    pub impacts: u64,
    /// Cam angle by which the follower rests, rad.
    pub rests_by_rad: f64,
    /// Index of the next release.
    pub release: usize,
    /// Turns of the cam from one release to the next: the difference of the revolutions that they are in.
    pub revolutions: u64,
}

/// A motion that repeats, from release to release.
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

    /// Whether every resting motion is proved to become periodic.
    pub fn all_repeat(&self) -> bool {
        self.releases.iter().all(|release| release.next.is_some())
    }
}

/// Finds and proves the behaviour of a follower that rests on the cam at a speed, rpm.
pub fn proved_resting(model: &Model, speed_rpm: f64, bits: u32) -> Result<ProvedResting, CertifyError> {
    let found: ProvedResting = ask(model, bits, ("resting_at_rpm", json!(speed_rpm)))?;
    Ok(ProvedResting { speed_rpm, ..found })
}
