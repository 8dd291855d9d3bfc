//! Proofs of corner impacts by a script: which corner impacts are proved to exist, and which are refused. The same script also proves
//! orbits and resting motions.
//!
//! Candidates are found here, in doubles. `derivations/certify.py` makes the proof, in balls, from the numbers of the model file. The
//! proof does not rely on the candidate: a wrong place is refused.

mod orbits;
mod resting;

use nalgebra::{Matrix2, RowVector2, Vector2};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::ModelLabel;
use crate::ball::Ball;
use crate::border_collision::directions::Homogeneous;
use crate::border_collision::feigin::{Scenario, Speeds};
use crate::border_collision::{Danger, LocalMap, RobustChaos};
use crate::cam::{Cam, Side};
use crate::corner::map::{Eigenvalue, Own, Sides};
use crate::corner::range::{RangeError, Rejected, find_corner_impacts};
use crate::corner::{CornerImpact, CornerMap, SideMap};
use crate::known::Evidence;
use crate::model::{CamProfile, MOST_PROVED_ROWS, Model, ModelError, Study};
use crate::progress::Watch;
use crate::python::{self, PythonError};
use crate::simulate::Machine;
pub use orbits::{
    OrbitEvent, OrbitKind, ProvedCount, ProvedCounts, ProvedEvent, ProvedOrbit, ProvedOrbits, ProvedStart,
    UndecidedOrbit, proved_counts, proved_orbits,
};
pub use resting::{NextRelease, ProvedRelease, ProvedResting, Round, proved_resting};

/// Precision in bits, enough for more digits than are ever printed.
pub const BITS: u32 = 128;

/// The certificates of a range of speeds: the document `corner-impact/certify/1`.
#[derive(Clone, Debug)]
pub struct Certified {
    /// The model.
    pub model: ModelLabel,
    /// The range of speeds.
    pub range: Study,
    /// Precision of the balls, bits.
    pub bits: u32,
    /// Proved corner impacts, by rising speed.
    pub corner_impacts: Vec<Certificate>,
    /// Corner impacts without a proof, by rising speed.
    pub refused: Vec<Unproved>,
}

document!(Certified as it {
    schema: "corner-impact/certify/1",
    model: it.model.name,
    source: it.model.source,
    rpm: [it.range.rpm_min, it.range.rpm_max],
    bits: it.bits,
    known: Evidence::proved_if(!it.corner_impacts.is_empty()),
    corner_impacts: it.corner_impacts,
    refused: it.refused,
    hypotheses: it.hypotheses(),
    agrees: it.agrees(),
});

/// Lists the hypotheses of the script's proofs, with the steps that they remove from the cam.
fn hypotheses(assumed: Option<Assumed>) -> Vec<String> {
    let numbers = "the machine's numbers are the decimals of its model file, except angles of a table in radians, which are the nearest \
                   doubles in degrees";
    let mechanics = "free flight follows the equation of motion, and impacts are instantaneous, by Newton's law";
    let cam = assumed.map(|Assumed { lift_m, slope_m_rad }| {
        format!(
            "the cam's pieces join: the steps between them as typed, up to {lift_m:.1e} m and {slope_m_rad:.1e} m/rad, are removed"
        )
    });
    [numbers, mechanics].map(str::to_owned).into_iter().chain(cam).collect()
}

impl Certified {
    /// Hypotheses of the proofs; empty if nothing is proved.
    pub fn hypotheses(&self) -> Vec<String> {
        self.corner_impacts.first().map(Certificate::hypotheses).unwrap_or_default()
    }

    /// Whether every corner impact found where the cam's acceleration jumps is proved.
    pub fn agrees(&self) -> bool {
        !self.refused.iter().any(|refused| refused.was_found)
    }
}

/// A corner impact without a certificate.
#[derive(Clone, Debug, PartialEq)]
pub struct Unproved {
    /// Speed at which it was looked for, rpm.
    pub speed_rpm: f64,
    /// Cam angle of the corner, rad.
    pub cam_angle: f64,
    /// Reason why the proof fails.
    pub why: String,
    /// Whether a search in doubles finds a border collision there.
    pub was_found: bool,
}

document!(Unproved as it {
    speed_rpm: it.speed_rpm,
    cam_angle_rad: it.cam_angle,
    why: it.why,
    known: Evidence::Sampled,
    was_found: it.was_found,
});

/// Proof of one corner impact: there is one periodic orbit of these numbers, with these maps and this verdict. No other orbit has a
/// period and impacts that differ from its own by up to `alone_within` of them.
///
/// Speeds in rpm, angles in rad, times in s, lengths in m; the state is the paper's, from the spring's equilibrium.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[expect(missing_docs, reason = "the fields are those of the document, which says what each is")]
pub struct Certificate {
    pub speed_rpm: Ball,
    pub period_s: Ball,
    pub cam_angle_rad: Ball,
    pub alone_within: f64,
    pub revolutions: u64,
    pub section_angle_rad: Ball,
    pub state: [Ball; 2],
    pub state_origin_m: Ball,
    pub impacts: Vec<ProvedImpact>,
    #[serde(flatten)]
    pub sides: Sides<ProvedSide>,
    #[serde(rename = "C")]
    pub c: [Ball; 2],
    #[serde(rename = "D")]
    pub d: Ball,
    pub border: [Ball; 3],
    pub conditions: Vec<ProvedCondition>,
    pub verdict: Scenario,
    /// Whether an orbit of period two, with an impact on each side of the corner, exists on one side of omega*, next to it.
    pub period_two_orbit: bool,
    pub assumed: Option<Assumed>,
    pub proved: bool,
}

/// An impact; the first is on the corner. It lies on its piece of the cam, and no contact comes before it.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct ProvedImpact {
    pub cam_angle_rad: Ball,
    pub velocity_before_m_s: Ball,
    pub velocity_after_m_s: Ball,
    pub cam_velocity_m_s: Ball,
}

/// One side of the map.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct ProvedSide {
    /// Matrix A, by rows.
    #[serde(rename = "A")]
    pub a: [[Ball; 2]; 2],
    /// Derivatives by the period.
    #[serde(rename = "B")]
    pub b: [Ball; 2],
    /// The eigenvalue with the larger real part first; of a complex pair, the one above the real axis.
    pub eigenvalues: [ProvedEigenvalue; 2],
    /// Speeds at which the machine has this side's fixed point, near the corner impact.
    pub fixed_point_exists_for: Speeds,
    /// Whether both eigenvalues are inside the unit circle.
    pub stable: bool,
    /// Neighbourhood of the corner impact in which the side's fixed point is followed; none if there is no such neighbourhood.
    pub followed: Option<Followed>,
}

/// Neighbourhood in which a side's fixed point is followed. For every period within `period_within_s` of T\*, the side has exactly one
/// fixed point with its impact within `cam_angle_within_rad` of the corner. Its state is within `state_within` of x\*. The machine has it
/// for the periods on the side of T\* that the verdict names.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct Followed {
    pub period_within_s: f64,
    pub cam_angle_within_rad: f64,
    pub state_within: [f64; 2],
}

/// An eigenvalue; proved to be real if the imaginary part is 0.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[expect(missing_docs, reason = "real and imaginary part")]
pub struct ProvedEigenvalue {
    pub re: Ball,
    pub im: Ball,
}

/// A number that must not be 0, and its proved sign.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct ProvedCondition {
    pub name: String,
    pub value: Ball,
    pub sign: i8,
}

/// Largest steps between polynomials of a cam, as typed, where they meet. The proofs remove these steps.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[expect(missing_docs, reason = "the names say what each is")]
pub struct Assumed {
    pub lift_m: f64,
    pub slope_m_rad: f64,
}

impl Certificate {
    /// Hypotheses of the proofs.
    pub fn hypotheses(&self) -> Vec<String> {
        hypotheses(self.assumed)
    }

    /// Map with the middles of the balls.
    pub fn map(&self) -> CornerMap {
        self.sides.map(|side| SideMap {
            a: Matrix2::from_fn(|row, column| side.a[row][column].value()),
            b: Vector2::from_fn(|row, _| side.b[row].value()),
        })
    }

    /// Proved quantities besides A and B, by the middles of their balls.
    pub(crate) fn own(&self) -> Own {
        let line = |[first, second, last]: [&Ball; 3]| (RowVector2::new(first.value(), second.value()), last.value());
        let eigenvalue = |it: &ProvedEigenvalue| Eigenvalue { re: it.re.value(), im: it.im.value() };
        let ([c1, c2], border) = (&self.c, self.border.each_ref());
        Own {
            jump: Some(line([c1, c2, &self.d])),
            eigenvalues: Some(self.sides.map(|side| side.eigenvalues.each_ref().map(eigenvalue))),
            ..Own::border(line(border))
        }
    }

    /// Checks the theorem of robust chaos at these speeds against the proved matrices, and marks it as proved if its hypotheses follow.
    pub(crate) fn prove(&self, chaos: &mut RobustChaos, speeds: Speeds) {
        let other = if chaos.saddle == Side::Minus { Side::Plus } else { Side::Minus };
        let sides = [chaos.saddle, other].map(|side| self.sides.of(side));
        if sides.iter().all(|side| side.fixed_point_exists_for == speeds) {
            chaos.prove(sides.map(|side| side.a.each_ref().map(|row| row.each_ref().map(Ball::interval))));
        }
    }

    /// Checks the danger at the corner impact against the proved matrices, border and fixed points, and records what follows.
    pub(crate) fn prove_danger(&self, danger: &mut Danger, local: &LocalMap) {
        let sides = [&self.sides.minus, &self.sides.plus];
        let matrices = sides.map(|side| side.a.each_ref().map(|row| row.each_ref().map(Ball::interval)));
        let [e1, e2, _] = self.border.each_ref().map(Ball::interval);
        // Two stable sides both have det(I - A) > 0, and so their fixed points exist at speeds of the two sides.
        let is_attracting = sides.iter().all(|side| side.stable);
        danger.prove(Homogeneous::new(matrices, [e1, e2], local.units()).diverging(true), is_attracting);
    }

    /// Fewest digits to which speed, state or map is proved. Numbers without a proved digit, such as a 0 with a radius, do not count.
    pub fn digits(&self) -> usize {
        let sides = [&self.sides.minus, &self.sides.plus];
        let map = sides.into_iter().flat_map(|side| side.a.iter().flatten().chain(&side.b));
        let all = map.chain(&self.state).chain([&self.speed_rpm, &self.period_s]);
        all.map(Ball::digits).filter(|digits| *digits > 0).min().unwrap_or(0)
    }
}

/// Reason why there is no answer.
#[derive(Debug, thiserror::Error)]
pub enum CertifyError {
    /// The model or its cam is invalid.
    #[error("{0}")]
    Model(#[from] ModelError),
    /// The range is invalid.
    #[error(transparent)]
    Range(#[from] RangeError),
    /// Python or the script failed.
    #[error("{0}")]
    Python(String),
}

impl From<PythonError> for CertifyError {
    fn from(error: PythonError) -> Self {
        Self::Python(error.to_string())
    }
}

/// Tries to prove every corner impact that a search of `range` finds for orbits of `revolutions`, and those that the search refuses.
///
/// A refused corner impact where the acceleration jumps is passed on with its speed alone, so that the proof decides it anew.
pub fn certify(
    model: &Model,
    range: Study,
    revolutions: u64,
    bits: u32,
    watch: &dyn Watch,
) -> Result<Certified, CertifyError> {
    let cam = Cam::new(model)?;
    let looked_at = find_corner_impacts(model, &cam, range, revolutions, watch)?;
    watch.at("their proofs, in Python", 0, 0);
    let jumps = |angle: f64| looked_at.corners.iter().any(|corner| corner.angle == angle && corner.jump_order == 2);
    let refused = looked_at.rejected.iter().filter(|one| jumps(one.cam_angle)).map(|one| {
        let Rejected { cam_angle, speed_rpm, .. } = *one;
        let place = json!({ "cam_angle_rad": cam_angle, "period_s": 60.0 / speed_rpm, "revolutions": revolutions });
        (speed_rpm, cam_angle, false, place)
    });
    let found = looked_at.found.iter().map(|at| {
        let is_border_collision = at.corner.jump_order == 2;
        (at.speed_rpm(), at.corner.angle, is_border_collision, candidate(model, &cam, at))
    });
    let mut places: Vec<_> = found.chain(refused).collect();
    places.sort_by(|one, other| one.0.total_cmp(&other.0));
    let candidates = places.iter().map(|(.., place)| place.clone()).collect();
    let (mut corner_impacts, mut refused) = (Vec::new(), Vec::new());
    for ((speed_rpm, cam_angle, was_found, _), outcome) in places.into_iter().zip(prove(model, candidates, bits)?) {
        match outcome {
            Outcome::Certificate(certificate) => corner_impacts.push(*certificate),
            Outcome::Refused(why) => refused.push(Unproved { speed_rpm, cam_angle, why, was_found }),
        }
    }
    Ok(Certified { model: ModelLabel::of(model), range, bits, corner_impacts, refused })
}

/// The script's answer for one place.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Outcome {
    Certificate(Box<Certificate>),
    Refused(String),
}

/// Lets the script prove the `candidates`. Returns the answers in the same order.
pub(super) fn prove(model: &Model, candidates: Vec<Value>, bits: u32) -> Result<Vec<Outcome>, CertifyError> {
    #[derive(Deserialize)]
    struct Answer {
        results: Vec<Outcome>,
    }
    Ok(ask::<Answer>(model, bits, ("candidates", json!(candidates)))?.results)
}

/// Runs the script on a model with one request field. Returns its answer.
fn ask<T: DeserializeOwned>(model: &Model, bits: u32, (field, value): (&str, Value)) -> Result<T, CertifyError> {
    if is_beyond(model) {
        if is_contour(model) {
            let allowed =
                "gives a contour; proofs are for lifts, and for the three circles of arcs with their follower";
            return Err(model.reject("cam.law", allowed).into());
        }
        let allowed =
            format!("proofs are for cubic or quintic splines through the rows, with {MOST_PROVED_ROWS} rows at most");
        return Err(model.reject("cam.spline", allowed).into());
    }
    let mut document = model.exact();
    document["bits"] = json!(bits);
    document[field] = value;
    Ok(python::run("certify.py", &document)?)
}

fn is_contour(model: &Model) -> bool {
    matches!(model.cam.plain(), CamProfile::Contour(_))
}

/// Whether proofs do not cover the model's cam.
pub(super) fn is_beyond(model: &Model) -> bool {
    is_contour(model) || model.is_smoothed() || model.table().is_some_and(|table| table.rows.len() > MOST_PROVED_ROWS)
}

/// Builds the candidate for a corner impact: its place, and its flights in order from the corner on.
pub(super) fn candidate(model: &Model, cam: &Cam, at: &CornerImpact) -> serde_json::Value {
    let machine = Machine::new(cam.clone(), &model.follower, at.angular_velocity());
    let count = at.cycle.impacts.len();
    let flight = |later: usize| {
        let index = (at.impact + later) % count;
        let (leaving, _) = at.cycle.flight(&machine, index);
        json!({ "turn_rad": at.cycle.turn(index), "velocity_after_m_s": leaving.velocity })
    };
    json!({
        "cam_angle_rad": at.corner.angle,
        "period_s": at.period,
        "revolutions": at.cycle.revolutions,
        "impacts": (0..count).map(flight).collect::<Vec<_>>(),
    })
}
