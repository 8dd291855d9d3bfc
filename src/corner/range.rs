//! Search for all corner impacts in a range of speeds. Those of one impact are the roots of one equation; those of several impacts are
//! found by two searches.

use std::collections::BTreeMap;

use serde::Serialize;

use super::candidates::{SearchedBranches, candidates};
use super::confirm::Candidate;
use super::corner_impact::{CornerImpact, Way};
use super::period_equation::{PeriodEquation, RESONANCE, Root, RootVerdict, Roots};
use super::shots::shots;
use crate::cam::{Cam, Corner, Side};
use crate::known::{Complete, Evidence};
use crate::model::{Model, Study};
use crate::orbit::complete::Standing;
use crate::progress::Watch;
use crate::simulate::angular_velocity;
use crate::tolerance;

/// Root of the equation for T at a corner that is not an orbit, with the reason.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rejected {
    /// Speed, rpm.
    pub speed_rpm: f64,
    /// Cam angle of the corner, rad.
    #[serde(rename = "cam_angle_rad")]
    pub cam_angle: f64,
    /// Reason why it is no orbit.
    pub why: String,
}

/// Speeds at which enclosures do not decide whether an orbit of one impact has it on a corner.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct UndecidedSpeeds {
    /// Cam angle of the corner, rad.
    #[serde(rename = "cam_angle_rad")]
    pub cam_angle: f64,
    /// Lowest and highest speed, rpm.
    pub speeds_rpm: [f64; 2],
}

/// Corner impacts in a range of speeds, with the record of the search.
#[derive(Clone, Debug)]
pub struct FoundCornerImpacts {
    /// Corner impacts, by rising speed.
    pub found: Vec<CornerImpact>,
    /// Speeds at which the equations hold without an orbit of the cam, by rising speed.
    pub rejected: Vec<Rejected>,
    /// Corners of the cam, in order of angle.
    pub corners: Vec<Corner>,
    /// Number of corners of a smoothing spline that were not examined: knots, and ends of dwells found in the rows.
    pub left_out: usize,
    /// Numbers of impacts for which the list is complete.
    pub complete: Vec<Complete>,
    /// Speeds at which a corner impact of one impact may be missing, or is rejected without a proof.
    pub undecided: Vec<UndecidedSpeeds>,
    /// Record of the search for orbits of several impacts.
    pub searched: SearchedBranches,
}

/// Counts of corner impacts found by two independent searches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Recaptured {
    /// Number found on branches.
    pub branches: usize,
    /// Number found by shots.
    pub shots: usize,
    /// Number found by both.
    pub both: usize,
}

document!(Recaptured as it { branches: it.branches, shots: it.shots, both: it.both, missing: it.missing() });

impl Recaptured {
    /// Estimated number of corner impacts that both searches missed, from their overlap (Chapman 1951). It assumes that all are equally
    /// easy to find. If some are harder to find, more are missing.
    ///
    /// ```text
    /// N = (n_1 + 1) (n_2 + 1) / (m + 1) - 1        m found by both searches, of n_1 and n_2
    /// N - (n_1 + n_2 - m) = (n_1 - m) (n_2 - m) / (m + 1)
    /// ```
    pub fn missing(&self) -> f64 {
        let [branches, shots] = [self.branches, self.shots].map(|count| (count - self.both) as f64);
        branches * shots / (self.both as f64 + 1.0)
    }
}

/// Reason why a range of speeds cannot be searched.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the message says what each number is")]
pub enum RangeError {
    /// Ends that do not form a range.
    #[error("{low}:{high} rpm: a range goes from a speed above 0 to a higher one")]
    NoRange { low: f64, high: f64 },
    /// Range with too many oscillations of the follower.
    #[error(
        "{low}:{high} rpm spans too much: from end to end the flight grows by {radians:.3e} radians of the follower's motion, \
         and at most {:.3e} are searched",
        PeriodEquation::MOST_RADIANS
    )]
    TooWide { low: f64, high: f64, radians: f64 },
    #[error("{low}:{high} rpm: the follower's motion overflows a double: check the model's magnitudes")]
    NotFinite { low: f64, high: f64 },
}

/// Searches a range of speeds for orbits that repeat after `revolutions`, with an impact on any corner.
pub fn find_corner_impacts(
    model: &Model,
    cam: &Cam,
    range: Study,
    revolutions: u64,
    watch: &dyn Watch,
) -> Result<FoundCornerImpacts, RangeError> {
    let Study { rpm_min: low, rpm_max: high } = range;
    if !(low > 0.0 && high > low && angular_velocity(high).is_finite()) {
        return Err(RangeError::NoRange { low, high });
    }
    let corners = &worth_looking_at(model, cam);
    let (one_impact, undecided) = one_impact(model, cam, corners, range, revolutions)?;
    let known = if undecided.is_empty() { Evidence::Proved } else { Evidence::Sampled };
    let complete = vec![Complete { revolutions, impacts: 1, known }];
    let (mut on_branches, searched) = candidates(model, cam, range, revolutions, watch);
    on_branches.retain(|candidate| corners.contains(&candidate.corner));
    let mut all = FoundCornerImpacts {
        found: Vec::new(),
        rejected: Vec::new(),
        corners: corners.to_vec(),
        left_out: cam.corners().len() - corners.len(),
        complete,
        undecided,
        searched,
    };
    for (corner, period, verdict) in one_impact {
        let orbit = all.orbit(&corner, 60.0 / period, verdict);
        all.found.extend(orbit);
    }
    for candidates in [on_branches, shots(model, cam, corners, range, revolutions, watch)] {
        all.confirm(model, cam, range, candidates);
    }
    all.found.sort_by(|one, two| one.speed_rpm().total_cmp(&two.speed_rpm()));
    all.rejected.sort_by(|one, two| one.speed_rpm.total_cmp(&two.speed_rpm));
    Ok(all)
}

/// Corners at which impacts are searched. On a smoothing spline, knots are left out because they are not part of the measurement. Ends of
/// dwells found in the rows are left out because they lie somewhat inside the true ends.
fn worth_looking_at(model: &Model, cam: &Cam) -> Vec<Corner> {
    let smoothing = model.table().and_then(|table| table.spline.smoothing());
    let is_laid = |corner: &Corner| {
        smoothing.is_some_and(|own| cam.is_knot(corner) || (own.dwells_deg.is_none() && corner.jump_order > 2))
    };
    cam.corners().iter().filter(|corner| !is_laid(corner)).copied().collect()
}

/// Verdict on each root of the equation for one impact, with its corner and its period, s; and the undecided speeds.
#[expect(clippy::type_complexity, reason = "two lists, each of which is told")]
pub(super) fn one_impact(
    model: &Model,
    cam: &Cam,
    corners: &[Corner],
    range: Study,
    revolutions: u64,
) -> Result<(Vec<(Corner, f64, RootVerdict)>, Vec<UndecidedSpeeds>), RangeError> {
    let Study { rpm_min: low, rpm_max: high } = range;
    let (mut all, mut undecided) = (Vec::new(), Vec::new());
    for corner in corners {
        let mut leave = |[shortest, longest]: [f64; 2]| {
            undecided.push(UndecidedSpeeds { cam_angle: corner.angle, speeds_rpm: [60.0 / longest, 60.0 / shortest] });
        };
        // At a corner of velocity, each side throws the follower differently.
        let throws = corner.jump_order == 1;
        for side in if throws { &[Side::Minus, Side::Plus][..] } else { &[Side::Plus] } {
            let equation = PeriodEquation::new(&model.follower, cam, corner, *side, revolutions);
            match equation.roots(range) {
                Roots::Some(roots, between) => {
                    between.into_iter().for_each(&mut leave);
                    for root in roots {
                        let verdict = match throws {
                            true => one_side(model, cam, &equation, root),
                            false => equation.orbit(model, cam, root),
                        };
                        let proved =
                            if matches!(verdict, RootVerdict::Orbit(_)) { Standing::Orbit } else { Standing::NoOrbit };
                        if root.standing != proved {
                            leave(root.bracket);
                        }
                        all.push((*corner, root.period, verdict));
                    }
                }
                Roots::TooMany { radians } => return Err(RangeError::TooWide { low, high, radians }),
                Roots::NotFinite => return Err(RangeError::NotFinite { low, high }),
                Roots::All { slowest } => {
                    leave([60.0 / high, slowest]);
                    let why = "flights of every period start and end there, so nothing fixes a speed";
                    let verdict = match equation.rests() {
                        true => equation.graze(model, cam, slowest),
                        false => RootVerdict::Rejected(why.into()),
                    };
                    all.push((*corner, slowest, verdict));
                }
            }
        }
    }
    Ok((all, undecided))
}

/// Verdict on a root at a corner of velocity. A simulation in doubles cannot decide which side is hit, so only the flight is simulated.
fn one_side(model: &Model, cam: &Cam, equation: &PeriodEquation<'_>, root: Root) -> RootVerdict {
    match equation.candidate(cam, root) {
        Some(candidate) => verdict(candidate, model, cam),
        None => RootVerdict::Rejected(RESONANCE.into()),
    }
}

fn verdict(candidate: Candidate, model: &Model, cam: &Cam) -> RootVerdict {
    candidate.confirmed(model, cam).map_or_else(RootVerdict::Rejected, |orbit| RootVerdict::Orbit(Box::new(orbit)))
}

impl FoundCornerImpacts {
    /// Returns the orbit of a verdict; records any other verdict as rejected.
    fn orbit(&mut self, corner: &Corner, speed_rpm: f64, verdict: RootVerdict) -> Option<CornerImpact> {
        let cam_angle = corner.angle;
        let why = match verdict {
            RootVerdict::Orbit(orbit) => return Some(*orbit),
            RootVerdict::Rejected(why) => why,
            RootVerdict::Grazing(_) => {
                "a graze, v = c': the corner is touched, not hit, and the map has no linear part".into()
            }
        };
        let again = |other: &Rejected| other.cam_angle == cam_angle && is_same_speed(other.speed_rpm, speed_rpm);
        if !self.rejected.iter().any(again) {
            self.rejected.push(Rejected { cam_angle, speed_rpm, why });
        }
        None
    }

    /// Adds the orbits among candidates in a range, each once, with every method that found it.
    fn confirm(&mut self, model: &Model, cam: &Cam, range: Study, candidates: Vec<Candidate>) {
        for candidate in candidates {
            let (corner, rpm, way) = (candidate.corner, 60.0 / candidate.period, candidate.way);
            if !(range.rpm_min <= rpm && rpm <= range.rpm_max) {
                continue;
            }
            match self.found.iter_mut().find(|known| is_same(known, &candidate)) {
                Some(known) if known.ways.contains(&way) => {}
                Some(known) => known.ways.push(way),
                None => {
                    let orbit = self.orbit(&corner, rpm, verdict(candidate, model, cam));
                    self.found.extend(orbit);
                }
            }
        }
    }

    /// Counts the corner impacts with several impacts that each of the two searches found, by their number of impacts.
    pub fn recaptured(&self) -> BTreeMap<usize, Recaptured> {
        let mut all = BTreeMap::<usize, Recaptured>::new();
        for at in self.found.iter().filter(|at| at.cycle.impacts.len() > 1) {
            let count = all.entry(at.cycle.impacts.len()).or_default();
            let [branch, shot] = [Way::Branch, Way::Shot].map(|way| at.ways.contains(&way));
            count.branches += usize::from(branch);
            count.shots += usize::from(shot);
            count.both += usize::from(branch && shot);
        }
        all
    }
}

/// Whether a candidate is a corner impact already found, by another method or on another branch.
fn is_same(known: &CornerImpact, at: &Candidate) -> bool {
    // Cycles at different speeds have different velocities.
    known.corner.segment == at.corner.segment && known.side == at.side && known.cycle.is_same(&at.cycle)
}

fn is_same_speed(one: f64, two: f64) -> bool {
    (one - two).abs() <= tolerance::SAME_ORBIT.value * one.abs()
}
