//! What holds along a curve in two numbers, beside the equations of the cycle: the event that the curve is of.
//!
//! | event | what holds |
//! |---|---|
//! | corner impact | an impact stays on its corner |
//! | fold, flip | a multiplier is 1, or -1 |
//! | graze | one of the impacts has no relative velocity: the flight to it touches, `g = g' = 0`, and goes on |
//!
//! The determinant of a matrix M of one period is `r^(2 n) e^(-b T/m)`, n impacts in a time T: not below 0, and below 1 but for
//! an elastic follower without damping. So no fold is a flip, and no pair of multipliers passes the unit circle.

use std::f64::consts::TAU;

use crate::orbit::{Cycle, Impact};
use crate::simulate::Machine;

/// An impact that stays at an end of its segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pinned {
    pub impact: usize,
    /// Whether it stays at the end of its segment; at the start otherwise.
    pub at_end: bool,
}

impl Pinned {
    /// The same cycle, the pinned impact named after the segment on the other side of the corner.
    pub(super) fn other_side(&self, cycle: &Cycle, machine: &Machine) -> Cycle {
        let last = machine.cam().segments().len() - 1;
        let mut other = cycle.clone();
        let impact = &mut other.impacts[self.impact];
        match (self.at_end, impact.segment) {
            (true, segment) if segment == last => {
                (impact.segment, impact.cam_angle, impact.revolution) =
                    (0, impact.cam_angle - TAU, impact.revolution + 1);
            }
            (true, _) => impact.segment += 1,
            (false, 0) => {
                (impact.segment, impact.cam_angle, impact.revolution) =
                    (last, impact.cam_angle + TAU, impact.revolution - 1);
            }
            (false, _) => impact.segment -= 1,
        }
        other
    }
}

/// What holds along a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Held {
    /// An impact is on a corner.
    Corner(Pinned),
    /// A multiplier has this value, 1 or -1.
    Multiplier(f64),
    /// The impact of this index is a touch.
    Touch(usize),
}

impl Held {
    /// What is off, of the size of an angle; `velocity` is the size of the follower's velocities over omega, m/rad.
    pub(super) fn off(self, cycle: &Cycle, machine: &Machine, velocity: f64) -> f64 {
        match self {
            Self::Corner(Pinned { impact, at_end }) => {
                let Impact { segment, cam_angle, .. } = cycle.impacts[impact];
                let segment = &machine.cam().segments()[segment];
                cam_angle - if at_end { segment.end } else { segment.start }
            }
            // It has no pole at a graze, as the determinant of the multiplier less M has.
            Self::Multiplier(multiplier) => cycle.characteristic(machine, multiplier, velocity),
            Self::Touch(impact) => cycle.approach(machine, impact) / machine.angular_velocity() / velocity,
        }
    }

    /// The orbit without an impact that is none.
    pub(super) fn orbit(self, cycle: &Cycle) -> Cycle {
        let mut orbit = cycle.clone();
        if let Self::Touch(impact) = self {
            orbit.impacts.remove(impact);
        }
        orbit
    }

    /// The orbit with the law before a corner and with the law after it; of others the one orbit.
    pub(super) fn sides(self, cycle: &Cycle, machine: &Machine) -> Vec<Cycle> {
        match self {
            Self::Corner(pinned) => {
                let (this, other) = (cycle.clone(), pinned.other_side(cycle, machine));
                if pinned.at_end { vec![this, other] } else { vec![other, this] }
            }
            _ => vec![self.orbit(cycle)],
        }
    }

    /// Where it is, as a cam angle, rad, in `[0, 2 pi]`; of a multiplier where the first impact is.
    pub(super) fn cam_angle(self, cycle: &Cycle) -> f64 {
        match self {
            Self::Corner(Pinned { impact, .. }) | Self::Touch(impact) => cycle.impacts[impact].cam_angle,
            Self::Multiplier(_) => cycle.clone().in_order().impacts.first().map_or(f64::NAN, |first| first.cam_angle),
        }
    }

    /// The acceleration of the gap where a flight touches the cam, m/s^2: above 0, or it does not open again.
    pub(super) fn opening(self, cycle: &Cycle, machine: &Machine) -> Option<f64> {
        let Self::Touch(impact) = self else { return None };
        let rates = cycle.rates(machine, impact);
        Some(rates.acceleration_after - rates.cam_acceleration)
    }
}
