//! The event along a curve in two numbers: a condition in addition to the equations of the cycle.
//!
//! | event | condition |
//! |---|---|
//! | corner impact | an impact stays on its corner |
//! | fold, flip | a multiplier is 1, or -1 |
//! | graze | one of the impacts has no relative velocity: the flight to it touches, `g = g' = 0`, and goes on |
//!
//! The determinant of a matrix M of one period is `r^(2 n) e^(-b T/m)`, n impacts in a time T. It is not below 0, and it is below 1 except
//! for an elastic follower without damping. So no fold is a flip, and no pair of multipliers passes the unit circle.

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
    /// Renames the pinned impact by the segment on the other side of the corner.
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

/// Condition along a curve.
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
    /// Residual of the condition, of the size of an angle; `velocity` is the size of the follower's velocities over omega, m/rad.
    pub(super) fn off(self, cycle: &Cycle, machine: &Machine, velocity: f64) -> f64 {
        match self {
            Self::Corner(Pinned { impact, at_end }) => {
                let Impact { segment, cam_angle, .. } = cycle.impacts[impact];
                let segment = &machine.cam().segments()[segment];
                cam_angle - if at_end { segment.end } else { segment.start }
            }
            // Unlike the determinant of the multiplier less M, this has no pole at a graze.
            Self::Multiplier(multiplier) => cycle.characteristic(machine, multiplier, velocity),
            Self::Touch(impact) => cycle.approach(machine, impact) / machine.angular_velocity() / velocity,
        }
    }

    /// The orbit without the touch, which is no impact.
    pub(super) fn orbit(self, cycle: &Cycle) -> Cycle {
        let mut orbit = cycle.clone();
        if let Self::Touch(impact) = self {
            orbit.impacts.remove(impact);
        }
        orbit
    }

    /// For a corner, the orbit with the law before it and that with the law after it. For other events the one orbit.
    pub(super) fn sides(self, cycle: &Cycle, machine: &Machine) -> Vec<Cycle> {
        match self {
            Self::Corner(pinned) => {
                let (this, other) = (cycle.clone(), pinned.other_side(cycle, machine));
                if pinned.at_end { vec![this, other] } else { vec![other, this] }
            }
            _ => vec![self.orbit(cycle)],
        }
    }

    /// Cam angle of the event, rad, in `[0, 2 pi]`; for a multiplier, the angle of the first impact.
    pub(super) fn cam_angle(self, cycle: &Cycle) -> f64 {
        match self {
            Self::Corner(Pinned { impact, .. }) | Self::Touch(impact) => cycle.impacts[impact].cam_angle,
            Self::Multiplier(_) => cycle.clone().in_order().impacts.first().map_or(f64::NAN, |first| first.cam_angle),
        }
    }
}
