//! The equations of a cycle with numbers of the model free, in units in which a curve of solutions is followed.

use nalgebra::{DMatrix, DVector};

use super::constraint::Held;
use crate::orbit::curve::{CurvePoint, Equations};
use crate::orbit::cycle::lift_size;
use crate::orbit::{Cycle, Family, FamilyError};
use crate::simulate::Machine;

/// Units of lengths and of velocities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BranchScales {
    /// The size of the cam's lift, m.
    pub lift: f64,
    /// The size of the follower's velocities over omega, m/rad.
    pub velocity: f64,
}

impl BranchScales {
    pub fn of(cycle: &Cycle, machine: &Machine) -> Self {
        let lift = lift_size(machine);
        let fastest = cycle.impacts.iter().fold(0.0_f64, |fastest, impact| fastest.max(impact.velocity_before.abs()));
        Self { lift, velocity: lift.max(fastest / machine.angular_velocity()) }
    }

    /// Converts a point of a curve of cycles with `impacts` impacts from these units to the units `other`.
    pub fn convert(&self, point: &mut CurvePoint, impacts: usize, other: Self) {
        let factor = self.velocity / other.velocity;
        for index in (1..2 * impacts).step_by(2) {
            point.unknowns[index] *= factor;
            point.tangent[index] *= factor;
        }
        point.tangent /= point.tangent.norm();
    }
}

/// Unknowns: angle (rad) and velocity over omega (by its unit) of each impact, then the free numbers (by `spans`).
pub struct Problem<'a> {
    family: &'a Family,
    /// Revolutions and segments of the cycle; its angles and velocities are replaced.
    pattern: Cycle,
    /// Units of the cam's lift, m, and of velocities over omega, m/rad.
    units: BranchScales,
    spans: Vec<f64>,
    held: Option<Held>,
}

impl<'a> Problem<'a> {
    /// Equations of a cycle with the pattern's revolutions and segments.
    pub fn new(family: &'a Family, pattern: &Cycle, units: BranchScales, spans: &[f64], held: Option<Held>) -> Self {
        Self { family, pattern: pattern.clone(), units, spans: spans.to_vec(), held }
    }

    /// The unknowns of `cycle` with these numbers.
    pub fn unknowns(&self, cycle: &Cycle, machine: &Machine, values: &[f64]) -> DVector<f64> {
        let impacts = cycle.impacts.iter();
        let of_impacts = impacts.flat_map(|impact| {
            [impact.cam_angle, impact.velocity_before / machine.angular_velocity() / self.units.velocity]
        });
        let of_values = values.iter().zip(&self.spans).map(|(value, span)| value / span);
        let all: Vec<f64> = of_impacts.chain(of_values).collect();
        DVector::from_vec(all)
    }

    /// The free numbers among the unknowns.
    pub fn values(&self, unknowns: &DVector<f64>) -> Vec<f64> {
        let count = 2 * self.pattern.impacts.len();
        unknowns.iter().skip(count).zip(&self.spans).map(|(value, span)| value * span).collect()
    }

    /// The cycle and the machine that unknowns represent, and its speed, rpm.
    pub fn unpack(&self, unknowns: &DVector<f64>) -> Result<(Cycle, Machine, f64), FamilyError> {
        let (machine, rpm) = self.family.machine_of_cycles(&self.values(unknowns))?;
        let cycle = self.cycle(unknowns, &machine);
        Ok((cycle, machine, rpm))
    }

    fn cycle(&self, unknowns: &DVector<f64>, machine: &Machine) -> Cycle {
        let mut cycle = self.pattern.clone();
        for (index, impact) in cycle.impacts.iter_mut().enumerate() {
            impact.cam_angle = unknowns[2 * index];
            impact.velocity_before = unknowns[2 * index + 1] * self.units.velocity * machine.angular_velocity();
        }
        cycle
    }

    /// Scales the residual of the cycle by the lift, and appends the residual of the held condition, if any.
    fn with_held(&self, of_cycle: DVector<f64>, cycle: &Cycle, machine: &Machine) -> DVector<f64> {
        let of_cycle = of_cycle / self.units.lift;
        match self.held {
            Some(held) => of_cycle.push(held.off(cycle, machine, self.units.velocity)),
            None => of_cycle,
        }
    }

    /// Residual of the equations.
    pub(super) fn residual(&self, unknowns: &DVector<f64>) -> Result<DVector<f64>, FamilyError> {
        let (cycle, machine, _) = self.unpack(unknowns)?;
        Ok(self.with_held(cycle.residual(&machine), &cycle, &machine))
    }
}

impl Equations for Problem<'_> {
    type Error = FamilyError;

    fn linear(&self, unknowns: &DVector<f64>) -> Result<(DVector<f64>, DMatrix<f64>), FamilyError> {
        /// Difference for derivatives, in radians or spans of a free number. It steers Newton's method and the tangent, and needs six
        /// digits.
        const DIFFERENCE: f64 = 1e-7;
        let count = 2 * self.pattern.impacts.len();
        let (cycle, machine, _) = self.unpack(unknowns)?;
        let (residual, by_impacts) = cycle.linear(&machine);
        let residual = self.with_held(residual, &cycle, &machine);
        let mut jacobian = DMatrix::zeros(residual.len(), unknowns.len());
        for column in 0..count {
            let unit = if column % 2 == 0 { 1.0 } else { self.units.velocity } / self.units.lift;
            for row in 0..count {
                jacobian[(row, column)] = by_impacts[(row, column)] * unit;
            }
            if let Some(held) = self.held {
                let off = |step: f64| {
                    let mut moved = unknowns.clone();
                    moved[column] += step;
                    held.off(&self.cycle(&moved, &machine), &machine, self.units.velocity)
                };
                jacobian[(count, column)] = (off(DIFFERENCE) - off(-DIFFERENCE)) / (2.0 * DIFFERENCE);
            }
        }
        for column in count..unknowns.len() {
            let moved = |step: f64| {
                let mut moved = unknowns.clone();
                moved[column] += step;
                self.residual(&moved)
            };
            // At the edge of the allowed values, the difference is taken on the other side.
            let derivative = match moved(DIFFERENCE) {
                Ok(ahead) => (ahead - &residual) / DIFFERENCE,
                Err(_) => (&residual - moved(-DIFFERENCE)?) / DIFFERENCE,
            };
            jacobian.set_column(column, &derivative);
        }
        Ok((residual, jacobian))
    }
}
