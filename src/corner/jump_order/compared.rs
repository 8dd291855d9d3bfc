//! Comparison of predictions at a corner with measurements.

use nalgebra::Vector3;

use super::measured::{self, Gap, MeasuredLaw, SideFlights};
use super::predicted::{self, Hits, PowerLaw};
use super::{Approach, JumpOrderError};
use crate::cam::Cam;
use crate::estimate::Estimate;
use crate::model::Model;
use crate::tolerance;

/// Quantity that follows a power law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PowerLawQuantity {
    /// Velocities over the actual cam, on either side of the corner, against the gap at the corner's moment.
    Gap,
    /// Velocities at the corner's moment, against the time of the impact.
    Velocity,
    /// Positions at the corner's moment, against the time of the impact.
    Position,
    /// Positions at the end of the map, against a deviation of the starting position.
    MapOfPosition,
    /// Velocities at the end of the map, against a deviation of the period.
    MapOfPeriod,
}

/// Power law, predicted and measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLawRow {
    /// Quantity.
    pub quantity: PowerLawQuantity,
    /// Law from the formulas.
    pub predicted: PowerLaw,
    /// Law from simulation.
    pub measured: MeasuredLaw,
}

impl PowerLawRow {
    /// Difference of the two coefficients, relative to the predicted one.
    pub fn relative_difference(&self) -> f64 {
        let predicted = self.predicted.coefficient;
        ((self.measured.coefficient.value - predicted) / predicted).abs()
    }

    /// Whether the measured exponent and coefficient agree with the predicted ones.
    pub fn agrees(&self) -> bool {
        let off = (self.measured.exponent.value - f64::from(self.predicted.exponent)).abs();
        off <= tolerance::JUMP_EXPONENT.value && self.relative_difference() <= tolerance::JUMP_COEFFICIENT.value
    }
}

/// All predictions and measurements at a corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// Flight.
    pub approach: Approach,
    /// Predicted number of times that flights hit the cam near the corner.
    pub hits: Hits,
    /// Gap over the actual cam, for a jump of order 1.
    pub gap: Option<Gap>,
    /// Angle of the map before the corner, and after it, rad; 0 if only the gap was measured.
    pub span: f64,
    /// All power laws.
    pub rows: Vec<PowerLawRow>,
}

impl Compared {
    /// Whether everything agrees: the laws, and the numbers of hits.
    pub fn agrees(&self) -> bool {
        let counted = self.gap.is_none_or(|gap| gap.impacts == impacts(self.hits));
        counted && !self.rows.is_empty() && self.rows.iter().all(PowerLawRow::agrees)
    }
}

/// Impacts of a flight that would reach the cam before the corner, and of one that would reach it after.
fn impacts(hits: Hits) -> [usize; 2] {
    match hits {
        Hits::Once => [1, 1],
        Hits::NeverAfter => [1, 0],
        Hits::TwiceBefore => [2, 1],
    }
}

/// Predicts and measures the effects at the corner of `approach`.
pub fn compare(model: &Model, cam: &Cam, approach: &Approach) -> Result<Compared, JumpOrderError> {
    let follower = &model.follower;
    let hits = predicted::hits(follower, approach);
    let mut compared = Compared { approach: *approach, hits, gap: None, span: 0.0, rows: Vec::new() };
    if approach.corner.jump_order == 1 {
        let gap = measured::gap(model, cam, approach)?;
        // At the corner's moment itself F is the identity.
        let step = predicted::over(follower, approach, 0.0, 0.0).step;
        compared.gap = Some(gap);
        compared.rows.push(PowerLawRow {
            quantity: PowerLawQuantity::Gap,
            predicted: PowerLaw { exponent: 0, coefficient: step[1] },
            measured: MeasuredLaw { exponent: gap.exponent, coefficient: gap.limit[1] },
        });
    }
    if hits != Hits::Once {
        return Ok(compared);
    }
    let sides = SideFlights::new(model, cam, approach)?;
    compared.span = sides.span();
    let [position, velocity] = sides.at_corner()?;
    let difference = predicted::difference(follower, approach);
    let row = |quantity, predicted, measured| PowerLawRow { quantity, predicted, measured };
    compared.rows.push(row(PowerLawQuantity::Velocity, difference.velocity, velocity));
    compared.rows.push(row(PowerLawQuantity::Position, difference.position, position));

    let map = predicted::over(follower, approach, compared.span, compared.span);
    let scales = sides.scales();
    let directions = [(PowerLawQuantity::MapOfPosition, 0, 0), (PowerLawQuantity::MapOfPeriod, 2, 1)];
    for (quantity, direction, component) in directions {
        let mut z = Vector3::zeros();
        z[direction] = scales[direction];
        let law = sides.along(z)?[component];
        // Converts to units of the deviation; the runs used parts of a scale.
        let per_unit = scales[direction].powi(law.exponent.value.round() as i32);
        let Estimate { value, error, .. } = law.coefficient;
        let coefficient = Estimate::extrapolated(value / per_unit, error / per_unit);
        let unit = map.at(z / scales[direction])[component];
        let predicted = PowerLaw { exponent: map.exponent, coefficient: unit };
        compared.rows.push(row(quantity, predicted, MeasuredLaw { exponent: law.exponent, coefficient }));
    }
    Ok(compared)
}
