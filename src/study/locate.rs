//! Every corner impact in a range of speeds, with its local map by routes that must agree, and the event there.
//!
//! The event depends on the lowest derivative of the lift that jumps at the corner. If the velocity jumps, the map has a gap and each
//! side's orbit ends by itself. If the acceleration jumps, two matrices meet, and Feigin's classification gives the event. If only a
//! higher derivative jumps, both sides have one matrix, and nothing happens to first order.

use std::collections::BTreeMap;

use rayon::prelude::*;
use serde::{Serialize, Serializer};

use crate::agreement::Agreement;
use crate::border_collision::{Classification, Danger, LocalMap, Refusal, WithDanger};
use crate::cam::{Cam, Side};
use crate::corner::map::RouteName;
use crate::corner::range::{FoundCornerImpacts, RangeError, find_corner_impacts};
use crate::corner::shots::{SHOT_RATIO, VELOCITIES};
use crate::corner::{CornerImpact, CornerMap, variational};
use crate::known::Evidence;
use crate::measured::Measured;
use crate::model::{FollowerErrors, Model, ModelError, Study};
use crate::orbit::branch::{Event, GRID_RATIO};
use crate::progress::{Pieces, Watch};
use crate::simulate::Machine;
use crate::study::routes::{self, Log, Skipped};
use crate::study::{ModelLabel, hypotheses};
use crate::uncertainty::{PlausibleMachines, SourcedUncertainty, UncertaintyParts};

/// The corner impacts of a range of speeds: the document `corner-impact/locate/1`.
#[derive(Clone, Debug)]
pub struct Located {
    /// The model.
    pub model: ModelLabel,
    /// Each corner impact, by rising speed.
    pub found: Vec<LocatedImpact>,
    /// Record of the search, with the refused candidates.
    pub looked_at: FoundCornerImpacts,
    /// Hypotheses on the machine for the proof that there are no others; empty if nothing is proved.
    pub hypotheses: Vec<&'static str>,
    /// The range, rpm.
    pub range: Study,
    /// Turns of the cam in one period of the orbits looked for.
    pub revolutions: u64,
    /// Accuracy of the cam, if it is measured.
    pub measured: Option<Measured>,
    /// Standard deviations of the follower's numbers.
    pub errors: FollowerErrors,
    /// Whether the routes agree at every corner impact; true if there is none.
    pub agrees: bool,
}

document!(Located as it {
    schema: "corner-impact/locate/1",
    model: it.model.name,
    source: it.model.source,
    rpm: [it.range.rpm_min, it.range.rpm_max],
    revolutions: it.revolutions,
    corner_impacts: it.found,
    rejected: it.looked_at.rejected,
    complete: it.looked_at.complete,
    hypotheses: it.hypotheses,
    undecided: it.looked_at.undecided,
    searched: Searched(&it.looked_at),
    measured if_any: it.measured,
    uncertain if_any: it.errors.if_any(),
    agrees: it.agrees,
});

/// The extent of the search, without its results.
struct Searched<'a>(&'a FoundCornerImpacts);

document!(Searched<'_> as it {
    corners_rad: it.0.corners.iter().map(|corner| corner.angle).collect::<Vec<_>>(),
    speeds_rpm: it.0.searched.speeds,
    speed_ratio: GRID_RATIO,
    branches: it.0.searched.branches,
    failed: it.0.searched.failed,
    shots: Shots { speed_ratio: SHOT_RATIO, velocities: VELOCITIES },
    found_by: it.0.recaptured(),
});

/// Settings of the shots from corners.
#[derive(Serialize)]
struct Shots {
    speed_ratio: f64,
    velocities: usize,
}

/// A corner impact and its map.
#[derive(Clone, Debug)]
pub struct LocatedImpact {
    /// The orbit.
    pub at: CornerImpact,
    /// Uncertainty of the machine in the speed, rpm; none if the machine is exact or the uncertainty is unknown.
    pub speed_error: Option<SourcedUncertainty>,
    /// Map by the product of propagators and saltation matrices. At a corner of velocity it is valid on `at.side` only.
    pub map: CornerMap,
    /// The event at the corner impact.
    pub local: Happens,
    /// Danger of a border collision, if there is any.
    pub danger: Option<Danger>,
    /// Comparisons of the routes, pairwise.
    pub comparisons: Vec<Agreement>,
    /// Routes that did not run.
    pub skipped: Vec<Skipped>,
    /// Whether every comparison agrees and every route ran.
    pub agrees: bool,
}

document!(LocatedImpact as it {
    known: Evidence::Computed,
    found_by: it.at.ways,
    speed_rpm: it.at.speed_rpm(),
    error_rpm if_any: it.speed_error.map(|error| error.total()),
    error_parts if_any: it.speed_error.map(|error| UncertaintyParts(error, "_rpm")),
    period_s: it.at.period,
    orbit_period_s: it.at.period * it.at.cycle.revolutions as f64,
    revolutions: it.at.cycle.revolutions,
    impacts: it.at.cycle.impacts.len(),
    cam_angle_rad: it.at.corner.angle,
    jump_order: it.at.corner.jump_order,
    side: it.side(),
    state: [it.at.state.position, it.at.state.velocity],
    section_angle_rad: it.at.section_angle(),
    velocity_before_m_s: it.at.velocity_before,
    velocity_after_m_s: it.at.velocity_after,
    impact_angles_rad: it.at.cycle.impacts.iter().map(|impact| impact.cam_angle).collect::<Vec<_>>(),
    map: it.sides().map(|side| (side, it.map.of(side))).collect::<BTreeMap<_, _>>(),
    classification: Told(&it.local, it.danger.as_ref()),
    agreement: it.comparisons,
    skipped: it.skipped,
    agrees: it.agrees,
});

impl LocatedImpact {
    /// The side whose orbit this is, if the velocity jumps.
    pub fn side(&self) -> Option<Side> {
        (self.at.corner.jump_order == 1).then_some(self.at.side)
    }

    /// Sides that have a map.
    fn sides(&self) -> impl Iterator<Item = Side> {
        [Side::Minus, Side::Plus].into_iter().filter(|side| self.side().is_none_or(|only| only == *side))
    }
}

/// The event at a corner impact.
#[derive(Clone, Debug, PartialEq)]
pub enum Happens {
    /// The velocity jumps: impacts across the corner are thrown elsewhere.
    Gap,
    /// The acceleration jumps: two matrices meet on a border. Contains Feigin's verdict, if there is one.
    BorderCollision(Result<Classification, Refusal>),
    /// A higher derivative jumps: both sides have one matrix.
    Smooth,
}

impl Happens {
    /// Name in documents.
    pub fn scenario(&self) -> String {
        match self {
            Self::Gap => "gap".into(),
            Self::BorderCollision(Ok(kind)) => kind.scenario.to_string(),
            Self::BorderCollision(Err(Refusal::Degenerate(_))) => "degenerate".into(),
            Self::BorderCollision(Err(Refusal::Sticking { .. })) => "sticking".into(),
            Self::Smooth => "smooth".into(),
        }
    }

    /// Meaning of the event, in words. For a border collision the fixed points give more.
    pub fn meaning(&self) -> String {
        match self {
            Self::BorderCollision(Ok(_)) => "two matrices meet on a border".into(),
            Self::BorderCollision(Err(refusal)) => format!("Feigin's classification does not apply: {refusal}"),
            Self::Gap => {
                "the cam's velocity jumps, and the velocity after an impact jumps with it. The orbit of this side \
                          ends here. Across the corner the map has a gap instead of a second matrix"
                    .into()
            }
            Self::Smooth => {
                "only a derivative above the acceleration jumps: both sides have the same matrices, the map's \
                             derivative is continuous, and there is no border collision to first order"
                    .into()
            }
        }
    }
}

/// The event, with the danger of a border collision: the document of both.
struct Told<'a>(&'a Happens, Option<&'a Danger>);

impl Serialize for Told<'_> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Other {
            scenario: String,
            meaning: String,
        }
        match self {
            Self(Happens::BorderCollision(Ok(kind)), danger) => WithDanger { kind, danger: *danger }.serialize(to),
            Self(other, _) => Other { scenario: other.scenario(), meaning: other.meaning() }.serialize(to),
        }
    }
}

/// Reason why a range cannot be searched.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LocateRangeError {
    /// The cam is invalid.
    #[error("{0}")]
    Model(#[from] ModelError),
    /// The range is invalid.
    #[error(transparent)]
    Range(#[from] RangeError),
}

/// Finds every corner impact of orbits of `revolutions` in `range`, and computes its map by every route of this program.
pub fn locate(model: &Model, range: Study, revolutions: u64, watch: &dyn Watch) -> Result<Located, LocateRangeError> {
    let cam = Cam::new(model)?;
    let looked_at = find_corner_impacts(model, &cam, range, revolutions, watch)?;
    let pieces = Pieces::new(watch, "the map of each corner impact, by every route", looked_at.found.len());
    let found: Vec<LocatedImpact> =
        looked_at.found.par_iter().map(|at| pieces.each(|| located(model, &cam, at))).collect();
    let machines = if found.is_empty() { None } else { Some(PlausibleMachines::of(model, &cam)?) };
    let mut found = found;
    if let Some(machines) = machines.as_ref().and_then(PlausibleMachines::uncertain) {
        found.par_iter_mut().for_each(|found| found.speed_error = speed_error(model, &cam, machines, &found.at));
    }
    let agrees = found.iter().all(|located| located.agrees);
    let is_proved = looked_at.complete.iter().any(|complete| complete.known == Evidence::Proved);
    Ok(Located {
        hypotheses: if is_proved { hypotheses(&cam) } else { Vec::new() },
        model: ModelLabel::of(model),
        found,
        looked_at,
        range,
        revolutions,
        measured: machines.and_then(PlausibleMachines::measured),
        errors: model.errors,
        agrees,
    })
}

/// Uncertainty of the machine in the speed of a corner impact, rpm.
fn speed_error(
    model: &Model,
    cam: &Cam,
    machines: &PlausibleMachines<'_>,
    at: &CornerImpact,
) -> Option<SourcedUncertainty> {
    let machine = Machine::new(cam.clone(), &model.follower, at.angular_velocity());
    let at_end = at.cycle.impacts.get(at.impact)?.segment != at.corner.segment;
    let event = Event::of_corner(&machine, at.speed_rpm(), &at.cycle, at.impact, at_end);
    machines.error([at.speed_rpm()], |model, cam| event.moved(model, cam).map(|rpm| [rpm])).map(|[error]| error)
}

/// Computes the map of a corner impact by each route that its corner has.
pub(super) fn located(model: &Model, cam: &Cam, at: &CornerImpact) -> LocatedImpact {
    let mut log = Log::default();
    let (mut routes, sticking) = routes::routes(model, cam, at, &mut log);
    // The route that handles every kind of orbit comes first: its map is reported.
    routes.sort_by_key(|route| route.name != RouteName::Variational);
    let comparisons = routes::comparisons(at, &routes, &mut log);
    let (map, border) = (variational::route(model, cam, at).map, variational::border(model, cam, at));
    let local = match at.corner.jump_order {
        1 => Happens::Gap,
        2 => Happens::BorderCollision(routes::classified(&map, border, sticking)),
        _ => Happens::Smooth,
    };
    let danger = match &local {
        Happens::BorderCollision(Ok(_)) => {
            let local = LocalMap::new(&map, border);
            local.danger(&local.outcomes(), at.period)
        }
        _ => None,
    };
    let agrees = log.agrees(&comparisons);
    LocatedImpact { at: at.clone(), speed_error: None, map, local, danger, comparisons, skipped: log.0, agrees }
}
