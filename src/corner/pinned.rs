//! The speed at which a cycle has one of its impacts on a corner: its closing equations with that angle fixed and the speed
//! free, by Newton's method; and whether it is then an orbit of the cam as it is.

use std::f64::consts::TAU;

use nalgebra::{DVector, Vector2};

use super::corner_impact::{CornerImpact, at_section, origin};
use super::period_equation::at_corner;
use crate::cam::{Cam, Corner, Side};
use crate::impact::rebound;
use crate::model::Model;
use crate::orbit::cycle::lift_size;
use crate::orbit::{Cycle, Departure, NotClosed};
use crate::simulate::{Machine, angular_velocity};
use crate::tolerance;

/// A guess at a corner impact.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The impacts, nearly.
    pub cycle: Cycle,
    /// Index of the one that is near the corner.
    pub contact: usize,
    /// The corner.
    pub corner: Corner,
    /// Whose law the impact obeys.
    pub side: Side,
    /// The speed, nearly, rpm.
    pub rpm: f64,
}

/// A cycle that closes with an impact on a corner, of the cam with its laws continued.
#[derive(Clone, Debug, PartialEq)]
pub struct Pinned {
    /// The guess with everything found.
    pub at: Candidate,
    /// omega*, rad/s.
    pub angular_velocity: f64,
    /// Newton's last correction, relative.
    pub correction: f64,
}

impl Candidate {
    /// The speed and the other impacts.
    pub fn pin(mut self, machine: &Machine) -> Result<Pinned, NotClosed> {
        /// Newton's method doubles the digits; a guess is a small step of speed away.
        const STEPS: usize = 30;
        /// The farthest that an impact or the logarithm of the speed is moved in one step.
        const REACH: f64 = 0.1;
        let old = &self.cycle.contacts[self.contact];
        let on_corner = at_corner(machine.cam(), &self.corner, self.side, 0, old.velocity_before);
        // The angle may be named by the revolution before or after.
        let turns = ((old.cam_angle - on_corner.cam_angle) / TAU).round() as i64;
        let revolution = old.revolution + turns;
        self.cycle.contacts[self.contact] = crate::orbit::Contact { revolution, ..on_corner };
        let (mut omega, size, mut last) = (angular_velocity(self.rpm), lift_size(machine), f64::INFINITY);
        for step in 0..STEPS {
            let machine = machine.at_speed(omega);
            let mut matrix = self.cycle.jacobian(&machine);
            // In place of the corner's angle.
            matrix.set_column(2 * self.contact, &by_speed(&self.cycle, &machine));
            let Some(mut correction) = matrix.lu().solve(&-self.cycle.residual(&machine)) else {
                return Err(NotClosed { steps: step, residual: last });
            };
            let square = |(index, entry): (usize, &f64)| (if index % 2 == 0 { *entry } else { entry / size }).powi(2);
            let length = correction.iter().enumerate().map(square).sum::<f64>().sqrt();
            if !length.is_finite() {
                return Err(NotClosed { steps: step, residual: length });
            }
            // Rounding is reached where a correction is no smaller than the one before it.
            if length <= tolerance::CYCLE_CLOSED.value && (length >= 0.5 * last || length == 0.0) {
                self.rpm = omega * 60.0 / TAU;
                return Ok(Pinned { at: self, angular_velocity: omega, correction: length });
            }
            if length > REACH {
                correction *= REACH / length;
            }
            let faster = std::mem::replace(&mut correction[2 * self.contact], 0.0);
            self.cycle = self.cycle.moved(&machine, correction.as_slice());
            omega *= 1.0 + faster;
            last = length;
        }
        Err(NotClosed { steps: STEPS, residual: last })
    }
}

/// The derivative of [`Cycle::residual`] by the logarithm of the speed: flights are shorter, the cam throws faster.
fn by_speed(cycle: &Cycle, machine: &Machine) -> DVector<f64> {
    let (omega, r, residual) = (machine.angular_velocity(), machine.restitution(), cycle.residual(machine));
    let mut rows = DVector::zeros(residual.len());
    for index in 0..cycle.contacts.len() {
        let (leaving, time) = cycle.flight(machine, index);
        let end = machine.flight().fly(leaving, time).1;
        let thrown = Vector2::new(0.0, (1.0 + r) * cycle.rates(machine, index).cam_velocity);
        let moving = Vector2::new(end.velocity, machine.flight().acceleration(end));
        let by = machine.flight().propagator(time) * thrown - moving * time;
        rows[2 * index] = by[0];
        rows[2 * index + 1] = by[1] / omega - residual[2 * index + 1];
    }
    rows
}

impl Pinned {
    /// The corner impact, if the cycle is an orbit of the cam as it is; or why it is none.
    pub fn confirmed(self, model: &Model, cam: &Cam, bracket: Option<[f64; 2]>) -> Result<CornerImpact, String> {
        let Self { at: Candidate { cycle, contact, corner, side, .. }, angular_velocity, correction } = self;
        let machine = Machine::new(cam.clone(), &model.follower, angular_velocity);
        let period = TAU / angular_velocity;
        let velocity_before = cycle.contacts[contact].velocity_before;
        let rates = cycle.rates(&machine, contact);
        let velocity_after = rebound(machine.restitution(), velocity_before, rates.cam_velocity);
        for index in 0..cycle.contacts.len() {
            let rates = cycle.rates(&machine, index);
            let approach = rates.cam_velocity - rates.velocity_before;
            if approach.abs() <= tolerance::GRAZE_FOUND.value * (rates.cam_velocity.abs() + rates.velocity_before.abs())
            {
                let angle = cycle.contacts[index].cam_angle.to_degrees();
                let velocity = rates.cam_velocity;
                return Err(format!(
                    "a graze at {angle:.4} deg, v = c' = {velocity:.6} m/s: the map has no linear part"
                ));
            }
        }
        // Where the velocity jumps, an impact on one side may press the follower into the other.
        let [before, after] = [corner.minus, corner.plus].map(|lift| angular_velocity * lift.slope);
        if corner.jump_order == 1 && !(velocity_before < before.min(after)) {
            return Err("the flight would come to the corner out of the cam's other side".into());
        }
        if corner.jump_order == 1 && !(velocity_after > before.max(after)) {
            return Err("the cam's other side hits the follower again at once".into());
        }
        let slack = tolerance::CORNER_ANGLE.value;
        let is_on_corner = |angle: f64| cam.corners().iter().any(|corner| apart(corner.angle, angle) <= slack);
        let mut others = cycle.contacts.iter().enumerate().filter(|(index, _)| *index != contact);
        if let Some((_, other)) = others.find(|(_, other)| is_on_corner(other.cam_angle)) {
            let [one, two] = [corner.angle, other.cam_angle].map(f64::to_degrees);
            return Err(format!(
                "impacts at {one:.4} and {two:.4} deg are on corners at once: its map has more than two pieces"
            ));
        }
        if cycle.repeats_sooner() {
            return Err("it repeats sooner".into());
        }
        match cycle.departure(&machine) {
            Err(error) => return Err(error.to_string()),
            Ok(Some(departure)) => return Err(words(&cycle, departure)),
            Ok(None) => {}
        }
        let residual = cycle.residual(&machine);
        Ok(CornerImpact {
            corner,
            period,
            bracket: bracket.unwrap_or([-1.0, 1.0].map(|sign| period * (1.0 + sign * correction))),
            residual: correction,
            velocity_before,
            velocity_after,
            cam_velocity: rates.cam_velocity,
            state: at_section(&machine, &cycle, period),
            origin: origin(&model.follower),
            closure: residual.norm() / lift_size(&machine),
            cycle,
            contact,
            side,
        })
    }
}

/// The angle between two angles, rad, the shorter way round.
pub fn apart(one: f64, two: f64) -> f64 {
    let turned = (one - two).rem_euclid(TAU);
    turned.min(TAU - turned)
}

/// How the motion of the cam as it is leaves a cycle, in words.
fn words(cycle: &Cycle, departure: Departure) -> String {
    let angle = |contact: usize| cycle.contacts[contact].cam_angle.to_degrees();
    match departure {
        Departure::Beyond { contact } => {
            format!("its impact at {:.4} deg is on another segment of the cam", angle(contact))
        }
        Departure::Tangent { contact } => format!("the flight would come out of the cam at {:.4} deg", angle(contact)),
        Departure::Earlier { event, .. } => {
            format!("the flight meets the cam elsewhere, at {:.4} deg", event.cam_angle.to_degrees())
        }
        Departure::Elsewhere { contact } => {
            format!("the flight from {:.4} deg does not come to the next impact", angle(contact))
        }
    }
}
