//! Test whether a closed cycle with an impact on a corner is an orbit of the actual cam.

use std::f64::consts::TAU;

use super::corner_impact::{CornerImpact, Way, at_section, origin};
use crate::cam::{Cam, Corner, Side, apart};
use crate::impact::rebound;
use crate::model::Model;
use crate::orbit::cycle::lift_size;
use crate::orbit::{Cycle, Departure};
use crate::simulate::Machine;
use crate::tolerance;

/// Closed cycle with an impact on a corner, of the cam with its laws continued.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    pub cycle: Cycle,
    /// Index of the impact on the corner.
    pub impact: usize,
    pub corner: Corner,
    /// Side whose law the impact obeys.
    pub side: Side,
    /// T*, s.
    pub period: f64,
    /// Bracket of T*, s.
    pub bracket: [f64; 2],
    /// Residual of the equation for T*: see [`CornerImpact::residual`].
    pub residual: f64,
    /// Method that found it.
    pub way: Way,
}

impl Candidate {
    /// Returns the corner impact if the cycle is an orbit of the actual cam, or the reason why it is none.
    pub fn confirmed(self, model: &Model, cam: &Cam) -> Result<CornerImpact, String> {
        let Self { cycle, impact, corner, side, period, bracket, residual, way } = self;
        let angular_velocity = TAU / period;
        let machine = Machine::new(cam.clone(), &model.follower, angular_velocity);
        let velocity_before = cycle.impacts[impact].velocity_before;
        let rates = cycle.rates(&machine, impact);
        let velocity_after = rebound(machine.restitution(), velocity_before, rates.cam_velocity);
        for index in 0..cycle.impacts.len() {
            let rates = cycle.rates(&machine, index);
            let approach = rates.cam_velocity - rates.velocity_before;
            if approach.abs() <= tolerance::GRAZE_FOUND.value * (rates.cam_velocity.abs() + rates.velocity_before.abs())
            {
                let angle = cycle.impacts[index].cam_angle.to_degrees();
                let velocity = rates.cam_velocity;
                return Err(format!(
                    "a graze at {angle:.4} deg, v = c' = {velocity:.6} in the model's units: the map has no linear part"
                ));
            }
        }
        // At a corner of velocity, an impact on one side may press the follower into the other side.
        let [before, after] = [corner.minus, corner.plus].map(|lift| angular_velocity * lift.slope);
        if corner.jump_order == 1 && !(velocity_before < before.min(after)) {
            return Err("the flight would reach the corner from inside the cam on its other side".into());
        }
        if corner.jump_order == 1 && !(velocity_after > before.max(after)) {
            return Err("the cam's other side hits the follower again at once".into());
        }
        let slack = tolerance::CORNER_ANGLE.value;
        let is_on_corner = |angle: f64| cam.corners().iter().any(|corner| apart(corner.angle, angle) <= slack);
        let mut others = cycle.impacts.iter().enumerate().filter(|(index, _)| *index != impact);
        if let Some((_, other)) = others.find(|(_, other)| is_on_corner(other.cam_angle)) {
            let [one, two] = [corner.angle, other.cam_angle].map(f64::to_degrees);
            return Err(format!(
                "impacts at {one:.4} and {two:.4} deg are on corners at once: its map has more than two pieces"
            ));
        }
        if cycle.repeats_sooner() {
            return Err("the orbit has a shorter period".into());
        }
        match cycle.departure(&machine) {
            Err(error) => return Err(error.to_string()),
            Ok(Some(departure)) => return Err(words(&cycle, departure)),
            Ok(None) => {}
        }
        let closure = cycle.residual(&machine).norm() / lift_size(&machine);
        Ok(CornerImpact {
            corner,
            period,
            bracket,
            residual,
            velocity_before,
            velocity_after,
            cam_velocity: rates.cam_velocity,
            state: at_section(&machine, &cycle, period),
            origin: origin(&model.follower),
            closure,
            cycle,
            impact,
            side,
            ways: vec![way],
        })
    }
}

/// Describes how the motion of the actual cam leaves a cycle.
fn words(cycle: &Cycle, departure: Departure) -> String {
    let angle = |impact: usize| cycle.impacts[impact].cam_angle.to_degrees();
    match departure {
        Departure::Beyond { impact } => {
            format!("its impact at {:.4} deg is on another segment of the cam", angle(impact))
        }
        Departure::Tangent { impact } => format!("the flight would come out of the cam at {:.4} deg", angle(impact)),
        Departure::Earlier { event, .. } => {
            format!("the flight meets the cam elsewhere, at {:.4} deg", event.cam_angle.to_degrees())
        }
        Departure::Elsewhere { impact } => {
            format!("the flight from {:.4} deg does not reach the next impact", angle(impact))
        }
    }
}
