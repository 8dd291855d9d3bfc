//! The local map's orbits next to the corner impact, beside the orbits of the machine itself.
//!
//! The local map looks the same at every scale, so each of its orbits is a ray from the corner impact. The machine's orbits deviate from
//! these rays where second-order terms matter.

use std::f64::consts::TAU;

use serde::Serialize;

use crate::border_collision::long_run::LocalLongRun;
use crate::border_collision::outcome::LocalOutcome;
use crate::border_collision::validity::ComparedMotion;
use crate::cam::{Cam, apart};
use crate::corner::CornerImpact;
use crate::model::Model;
use crate::orbit::branch::{Branch, BranchPoint, Following};
use crate::orbit::{Course, Cycle, Parameter, PeriodicOrbit, Search, Stability, search};
use crate::simulate::{Machine, angular_velocity};
use crate::study::verify::Verification;

/// Range of the changes of period, as a multiple of the least change at which a fixed point is wrong by a tenth.
const BEYOND: f64 = 3.0;
/// Step of a branch, as a share of that range.
const STEP: f64 = 0.01;
/// Longest period of an orbit of the map that is shown; longer orbits are too many.
const LONGEST: usize = 2;

/// A periodic orbit of the local map.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ray {
    /// Sides that the orbit visits: L before the corner, R after it.
    pub word: String,
    /// Sign of the changes of period for which the orbit exists: -1 at faster speeds.
    pub sign: f64,
    /// Whether small deviations from the orbit die out.
    pub stability: Stability,
    /// Positions of the points, m, for a change of the period by `sign`, s; they are proportional to that change.
    pub positions: Vec<f64>,
    /// Velocities, m/s, for the same change of the period.
    pub velocities: Vec<f64>,
}

/// The local map and the machine near the corner impact.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NextToCorner {
    /// Largest change of the period, s.
    #[serde(rename = "reach_s")]
    pub reach: f64,
    /// T*, s.
    #[serde(rename = "period_s")]
    pub period: f64,
    /// Position of x* on the section, m.
    #[serde(rename = "position_m")]
    pub position: f64,
    /// Orbits of the local map.
    pub rays: Vec<Ray>,
    /// Signs of the changes of period for which every motion of the local map escapes.
    pub left: Vec<f64>,
    /// Orbits of the machine: change of the period, s, and position relative to x*, m.
    pub machine: Vec<Crossings>,
}

/// A piece of a branch at the section: one crossing of its orbits.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Crossings {
    /// Stability of the orbits.
    pub stability: Stability,
    /// Speed, rpm, and position at the section, m.
    pub points: Vec<[f64; 2]>,
}

impl NextToCorner {
    /// Computes both from a verification of the model. The error says why there is nothing to show.
    pub fn new(model: &Model, cam: &Cam, found: &Verification) -> Result<Self, String> {
        let at = &found.at;
        if found.outcomes.is_empty() {
            let why = found.classification.as_ref().err().map(ToString::to_string);
            return Err(why.unwrap_or_else(|| "the local map is not classified".into()));
        }
        let rays = found.outcomes.iter().flat_map(|outcome| {
            let short = outcome.orbits.iter().filter(|orbit| orbit.points.len() <= LONGEST);
            short.map(|orbit| Ray {
                word: orbit.word.to_string(),
                sign: outcome.mu,
                stability: orbit.stability(),
                positions: orbit.points.iter().map(|point| point[0]).collect(),
                velocities: orbit.points.iter().map(|point| point[1]).collect(),
            })
        });
        let rays: Vec<Ray> = rays.filter(|ray| ray.sign != 0.0).collect();
        let leaves = |outcome: &&LocalOutcome| {
            outcome.mu != 0.0 && outcome.fates.iter().all(|fate| matches!(fate.end, LocalLongRun::Escapes(_)))
        };
        let left = found.outcomes.iter().filter(leaves).map(|outcome| outcome.mu).collect();
        let fixed =
            found.ranges.iter().filter(|range| range.order == 1 && range.compared != ComparedMotion::OneRevolution);
        let held = fixed.map(|range| range.period_change.abs()).filter(|change| *change > 0.0);
        let least = held.fold(f64::INFINITY, f64::min);
        let reach = if least.is_finite() { BEYOND * least } else { 1e-3 * at.period };
        let reach = reach.min(0.2 * at.period);
        let rpm = |change: f64| 60.0 / (at.period + change);
        let branches = close_by(model, cam, at, [rpm(reach), rpm(-reach)])?;
        let mut machine = Crossings::of(&branches, model, cam, at);
        for point in machine.iter_mut().flat_map(|line| &mut line.points) {
            *point = [60.0 / point[0] - at.period, point[1] - at.state.position];
        }
        Ok(Self { reach, period: at.period, position: at.state.position, rays, left, machine })
    }
}

impl Crossings {
    /// Crossings of the orbits of branches with the section of the corner impact's map.
    pub fn of(branches: &[Branch], model: &Model, cam: &Cam, at: &CornerImpact) -> Vec<Self> {
        let machine = Machine::new(cam.clone(), &model.follower, angular_velocity(at.speed_rpm()));
        let angle = at.section_angle();
        let mut all = Vec::new();
        for branch in branches {
            let most = branch.points.iter().map(|point| point.orbit.revolutions).max().unwrap_or(1);
            for turn in 0..most {
                let mut open: Option<Self> = None;
                for pair in branch.points.windows(2) {
                    let [one, other] = pair else { continue };
                    let ends = crossing(&machine, one, angle, turn).zip(crossing(&machine, other, angle, turn));
                    // A piece has the stability of the end that is not a special point.
                    let stability = if one.special.is_some() { other } else { one }.orbit.judgement.stability;
                    let Some((from, to)) = ends else {
                        all.extend(open.take());
                        continue;
                    };
                    match &mut open {
                        Some(line) if line.stability == stability => line.points.push(to),
                        _ => all.extend(open.replace(Self { stability, points: vec![from, to] })),
                    }
                }
                all.extend(open);
            }
        }
        all
    }
}

/// Branches through the orbits of one impact in one revolution, or of two in two, at either end of a range, rpm.
fn close_by(model: &Model, cam: &Cam, at: &CornerImpact, range: [f64; 2]) -> Result<Vec<Branch>, String> {
    let following =
        Following { parameter: Parameter::Speed, range, longest_step: STEP, most_points: (4.0 / STEP) as usize };
    let mut branches: Vec<Branch> = Vec::new();
    for (rpm, revolutions) in range.into_iter().flat_map(|rpm| [(rpm, 1), (rpm, 2)]) {
        let wanted = Search { revolutions, impacts: Some(revolutions as usize) };
        let orbits = search(&Machine::new(cam.clone(), &model.follower, angular_velocity(rpm)), &wanted)
            .map_err(|error| error.to_string())?;
        for orbit in orbits.iter().filter(|orbit| is_near(orbit, at)) {
            if !branches.iter().any(|branch| branch.holds(rpm, orbit)) {
                let branch = Branch::through(model, rpm, orbit, &following);
                branches.push(branch.map_err(|error| error.to_string())?);
            }
        }
    }
    Ok(branches)
}

/// Whether every impact of an orbit is nearer to the corner than to the opposite cam angle.
fn is_near(orbit: &PeriodicOrbit, at: &CornerImpact) -> bool {
    orbit.impacts().all(|impact| apart(impact.cam_angle, at.corner.angle) < 0.25 * TAU)
}

/// Speed, rpm, and position, m, at the section in one revolution of an orbit that never sticks.
fn crossing(machine: &Machine, point: &BranchPoint, cam_angle: f64, turn: u64) -> Option<[f64; 2]> {
    let Course::Impacts(cycle) = &point.orbit.course else { return None };
    let later: Cycle = if turn == 0 { cycle.clone() } else { cycle.begun_later(turn) };
    let machine = machine.at_speed(angular_velocity(point.rpm));
    (turn < cycle.revolutions).then(|| [point.rpm, later.at_section(&machine, cam_angle).0.position])
}
