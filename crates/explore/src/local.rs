//! Orbits of the local map beside those of the machine.

use corner_impact::border_collision::long_run::LocalLongRun;
use corner_impact::model::Model;
use corner_impact::study::verify::Verification;
use serde::Serialize;

use crate::Refusal;

/// The local map's orbits of period one and two.
#[derive(Serialize)]
pub struct NextToCorner {
    period_s: f64,
    position_m: f64,
    velocity_m_s: f64,
    rays: Vec<Ray>,
    left: Vec<f64>,
}

/// An orbit of the local map: it grows in proportion to the change of the period.
#[derive(Serialize)]
struct Ray {
    word: String,
    sign: f64,
    is_stable: bool,
    /// Positions of its points relative to x*, for a change of the period by `sign`, s.
    positions: Vec<f64>,
    velocities: Vec<f64>,
}

impl NextToCorner {
    pub(crate) fn of(_: &Model, found: &Verification) -> Result<Self, Refusal> {
        let outcomes = || found.outcomes.iter().filter(|outcome| outcome.mu != 0.0);
        let rays = outcomes().flat_map(|outcome| {
            outcome.orbits.iter().map(|orbit| Ray {
                word: orbit.word.to_string(),
                sign: outcome.mu,
                is_stable: orbit.stability() == corner_impact::orbit::Stability::Stable,
                positions: orbit.points.iter().map(|point| point[0]).collect(),
                velocities: orbit.points.iter().map(|point| point[1]).collect(),
            })
        });
        let leaves = outcomes().filter(|outcome| {
            outcome.fates.iter().all(|fate| matches!(fate.end, LocalLongRun::Escapes(_)))
        });
        Ok(Self {
            period_s: found.at.period,
            position_m: found.at.state.position,
            velocity_m_s: found.at.state.velocity,
            rays: rays.collect(),
            left: leaves.map(|outcome| outcome.mu).collect(),
        })
    }
}
