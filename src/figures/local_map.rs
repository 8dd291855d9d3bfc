//! The local map's own orbits against the change of period, and the machine's beside them.
//!
//! The local map looks the same at every scale, so that each of its orbits is a ray from the corner impact; the machine's
//! orbits leave these where terms of second order count.

use std::f64::consts::TAU;

use crate::border_collision::long_run::End;
use crate::border_collision::outcome::LocalOutcome;
use crate::border_collision::validity::Compared;
use crate::cam::apart;
use crate::figures::Subject;
use crate::figures::sweep::Crossings;
use crate::orbit::branch::{Branch, Following};
use crate::orbit::{Parameter, Search, search};

/// Beyond the least range over which a fixed point is a tenth off: how far the changes of period go.
const BEYOND: f64 = 3.0;
/// Steps of a branch over that range.
const STEP: f64 = 0.01;
/// The longest period of an orbit of the map that is shown: longer ones come in crowds.
const LONGEST: usize = 2;

/// A periodic orbit of the local map.
#[derive(Clone, Debug, PartialEq)]
pub struct Ray {
    /// The sides that it visits: L before the corner, R after it.
    pub word: String,
    /// Sign of the changes of period for which it exists: -1 at faster speeds.
    pub sign: f64,
    /// Whether it is stable.
    pub stable: bool,
    /// Positions of its points, m, for a change of the period by `sign`, s: they grow in proportion to it.
    pub positions: Vec<f64>,
    /// Velocities, m/s, for the same.
    pub velocities: Vec<f64>,
}

/// The local map and the machine next to the corner impact.
#[derive(Clone, Debug, PartialEq)]
pub struct NextToCorner {
    /// The largest change of the period, s.
    pub reach: f64,
    /// T*, s.
    pub period: f64,
    /// x* on the section: position, m.
    pub position: f64,
    /// The local map's orbits.
    pub rays: Vec<Ray>,
    /// Signs of the changes of period for which every motion of the local map leaves.
    pub left: Vec<f64>,
    /// The machine's, as change of the period, s, and position less that of x*, m.
    pub machine: Vec<Crossings>,
}

impl Subject {
    /// The local map's diagram, or why there is none.
    pub fn next_to_corner(&self) -> Result<NextToCorner, String> {
        let found = self.found()?;
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
                stable: orbit.stable(),
                positions: orbit.points.iter().map(|point| point[0]).collect(),
                velocities: orbit.points.iter().map(|point| point[1]).collect(),
            })
        });
        let rays: Vec<Ray> = rays.filter(|ray| ray.sign != 0.0).collect();
        let leaves = |outcome: &&LocalOutcome| {
            outcome.mu != 0.0 && outcome.fates.iter().all(|fate| matches!(fate.end, End::Escapes(_)))
        };
        let left = found.outcomes.iter().filter(leaves).map(|outcome| outcome.mu).collect();
        let fixed = found.ranges.iter().filter(|range| range.compared != Compared::OneRevolution);
        let held = fixed.map(|range| range.period_change.abs()).filter(|change| *change > 0.0);
        let least = held.fold(f64::INFINITY, f64::min);
        let reach = if least.is_finite() { BEYOND * least } else { 1e-3 * at.period };
        let reach = reach.min(0.2 * at.period);
        let rpm = |change: f64| 60.0 / (at.period + change);
        let branches = self.close_by([rpm(reach), rpm(-reach)])?;
        let mut machine = self.crossings(&branches)?;
        for point in machine.iter_mut().flat_map(|line| &mut line.points) {
            *point = [60.0 / point[0] - at.period, point[1] - at.state.position];
        }
        Ok(NextToCorner { reach, period: at.period, position: at.state.position, rays, left, machine })
    }

    /// The branches through the orbits of one impact a revolution, or two in two, at either end of a range, rpm.
    fn close_by(&self, range: [f64; 2]) -> Result<Vec<Branch>, String> {
        let following =
            Following { parameter: Parameter::Speed, range, longest_step: STEP, most_points: (4.0 / STEP) as usize };
        let mut branches: Vec<Branch> = Vec::new();
        for (rpm, revolutions) in range.into_iter().flat_map(|rpm| [(rpm, 1), (rpm, 2)]) {
            let wanted = Search { revolutions, impacts: Some(revolutions as usize) };
            let orbits = search(&self.machine(rpm), &wanted).map_err(|error| error.to_string())?;
            for orbit in orbits.iter().filter(|orbit| self.is_near(orbit)) {
                if !branches.iter().any(|branch| branch.holds(rpm, orbit)) {
                    let branch = Branch::through(&self.model, rpm, orbit, &following);
                    branches.push(branch.map_err(|error| error.to_string())?);
                }
            }
        }
        Ok(branches)
    }

    /// Whether every impact of an orbit is nearer to the corner than to its opposite.
    fn is_near(&self, orbit: &crate::orbit::PeriodicOrbit) -> bool {
        let Ok(found) = self.found() else { return false };
        orbit.impacts().all(|impact| apart(impact.cam_angle, found.at.corner.angle) < 0.25 * TAU)
    }
}
