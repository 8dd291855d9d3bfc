//! Quantity with respect to which B is the derivative: the period, or any number of the model; and the derivatives of the laws.

use nalgebra::{Matrix2, Vector2};

use super::corner_impact::CornerImpact;
use super::period_equation::at_corner;
use crate::cam::{Cam, Side};
use crate::model::{Follower, Model, ModelNumber};
use crate::orbit::{Family, FamilyError, Parameter};
use crate::tolerance;

/// Quantity with respect to which B is the derivative.
#[derive(Clone, Debug, PartialEq)]
pub enum Varied {
    /// Period T, s.
    Period,
    /// Number of the model file, by dotted path, in its own units.
    Number(String),
}

/// Reason why a law has no derivative with respect to a number.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the message says what each number is")]
pub enum NoChange {
    /// Model that does not allow neighbouring numbers.
    #[error(transparent)]
    Family(#[from] FamilyError),
    /// Name that is not a number of the model.
    #[error("the model has no number \"{name}\" to vary")]
    Unknown { name: String },
    /// Number with respect to which the laws of flight and impact have no derivative here.
    #[error("the laws of flight and impact have no derivative by {name}")]
    OfNoLaw { name: String },
    /// Number that changes the segments of the cam as soon as it varies.
    #[error("the segments of the cam change as soon as {name} moves from {value}")]
    OtherSegments { name: String, value: f64 },
}

/// Change of the lift under an impact, at the same angle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct LiftChange {
    /// Derivative `c_p`, m per unit.
    pub value: f64,
    /// Derivative of `dc/dtheta` with respect to p, m/rad per unit.
    pub slope: f64,
}

/// Derivatives of the physical laws with respect to the number.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Change {
    /// Derivative of T: 1 or 0.
    pub period: f64,
    /// Derivative of M in `y' = M y + f`.
    pub matrix: Matrix2<f64>,
    pub force: Vector2<f64>,
    pub restitution: f64,
    /// Change of the lift at each impact.
    pub lifts: Vec<LiftChange>,
    /// Error estimates of `lifts`.
    pub lift_errors: Vec<LiftChange>,
}

impl Change {
    fn none(impacts: usize) -> Self {
        let still = vec![LiftChange::default(); impacts];
        let (matrix, force) = (Matrix2::zeros(), Vector2::zeros());
        Self { period: 0.0, matrix, force, restitution: 0.0, lifts: still.clone(), lift_errors: still }
    }

    /// Derivatives with respect to T, for an orbit with this many impacts.
    pub fn of_period(impacts: usize) -> Self {
        Self { period: 1.0, ..Self::none(impacts) }
    }

    /// Derivatives with respect to any number, with the lift of one side at the corner.
    pub fn new(model: &Model, at: &CornerImpact, varied: &Varied, side: Side) -> Result<Self, NoChange> {
        let impacts = at.cycle.impacts.len();
        let Varied::Number(name) = varied else { return Ok(Self::of_period(impacts)) };
        let Follower { mass, damping, stiffness, rest_position, .. } = model.follower;
        // The number is in the unit of its field.
        let unit = name.strip_prefix("follower.").and_then(|name| model.units.of_follower(name));
        let scale = unit.map_or(1.0, |unit| unit.inside(1.0));
        // M = [[0, 1], [-k/m, -b/m]],  f = (0, k rest/m - g)
        let bottom = |position: f64, velocity: f64, force: f64| Self {
            matrix: Matrix2::new(0.0, 0.0, position * scale, velocity * scale),
            force: Vector2::new(0.0, force * scale),
            ..Self::none(impacts)
        };
        // A preload keeps k (c_min - rest): d(k rest)/dk = c_min.
        let slack = rest_position + model.preload.map_or(0.0, |preload| preload / stiffness);
        Ok(match name.as_str() {
            "follower.mass" => {
                bottom(stiffness / (mass * mass), damping / (mass * mass), -stiffness * rest_position / (mass * mass))
            }
            "follower.damping" => bottom(0.0, -1.0 / mass, 0.0),
            "follower.stiffness" => bottom(-1.0 / mass, 0.0, slack / mass),
            "follower.gravity" => bottom(0.0, 0.0, -1.0),
            "follower.rest_position" => bottom(0.0, 0.0, stiffness / mass),
            "follower.preload" => bottom(0.0, 0.0, -1.0 / mass),
            "follower.restitution" => Self { restitution: 1.0, ..Self::none(impacts) },
            _ if ModelNumber::of(name).is_some_and(|number| number.path.starts_with("follower.")) => {
                return Err(NoChange::OfNoLaw { name: name.clone() });
            }
            _ => {
                let (mut lifts, mut lift_errors) = lift_changes(model, at, name, side)?;
                // The last entry is for the lowest lift, from which a preload is measured.
                let (lowest, _) = (lifts.pop().unwrap_or_default(), lift_errors.pop());
                let moved = if model.preload.is_some() { lowest.value } else { 0.0 };
                let force = Vector2::new(0.0, stiffness / mass * moved);
                Self { lifts, lift_errors, force, ..Self::none(impacts) }
            }
        })
    }

    /// Whether the number changes the law of flight.
    pub fn flies_differently(&self) -> bool {
        self.matrix != Matrix2::zeros() || self.force != Vector2::zeros()
    }
}

/// Value of a number of the model.
pub(super) fn value_of(model: &Model, name: &str) -> Result<f64, NoChange> {
    let value = Parameter::Field(name.into()).value(model, f64::NAN);
    value.ok_or_else(|| NoChange::Unknown { name: name.into() })
}

/// Derivatives of the lift under every impact, and of the lowest lift, with respect to a number of the cam; then their errors. They are
/// differences over six cams,
///
/// ```text
/// h df/dp = (45 (f_1 - f_-1) - 9 (f_2 - f_-2) + (f_3 - f_-3))/60 + O(h^7)
/// ```
///
/// at the step where halving changes them least.
fn lift_changes(
    model: &Model,
    at: &CornerImpact,
    name: &str,
    side: Side,
) -> Result<(Vec<LiftChange>, Vec<LiftChange>), NoChange> {
    /// Number of steps tried, each half of the one before; and the largest step, as a part of the number.
    const STEPS: i32 = 16;
    const LARGEST: f64 = 1.0 / 64.0;
    const WEIGHTS: [f64; 3] = [45.0, -9.0, 1.0];
    let value = value_of(model, name)?;
    let family = Family::new(model, at.speed_rpm(), vec![Parameter::Field(name.into())])?;
    let here = family.machine(&[value])?.0;
    let scale = LARGEST * if value == 0.0 { 1.0 } else { value.abs() };
    let mut impacts = impacts(here.cam(), at, side);
    let lowest = here.cam().lowest();
    impacts.push((lowest.segment, lowest.angle));
    let mut failure = NoChange::OtherSegments { name: name.into(), value };
    let (mut wider, mut best): (Option<Vec<LiftChange>>, Option<_>) = (None, None);
    for halving in 0..STEPS {
        let step = scale * 0.5_f64.powi(halving);
        let mut sums = vec![LiftChange::default(); impacts.len()];
        let mut sample = |multiple: f64, weight: f64| -> Result<bool, FamilyError> {
            let (machine, _) = family.machine(&[value + multiple * step])?;
            let segments = machine.cam().segments();
            for (sum, (segment, angle)) in sums.iter_mut().zip(&impacts) {
                let lift = segments.get(*segment).map(|segment| segment.law.lift(*angle));
                sum.value += weight * lift.map_or(f64::NAN, |lift| lift.value);
                sum.slope += weight * lift.map_or(f64::NAN, |lift| lift.slope);
            }
            Ok(segments.len() == here.cam().segments().len())
        };
        let mut same = true;
        let mut at_steps = || {
            for (weight, multiple) in WEIGHTS.into_iter().zip([1.0, 2.0, 3.0]) {
                same &= sample(multiple, weight / (60.0 * step))?;
                same &= sample(-multiple, -weight / (60.0 * step))?;
            }
            Ok::<_, FamilyError>(())
        };
        if let Err(error) = at_steps() {
            (failure, wider) = (error.into(), None);
            continue;
        }
        if !same {
            wider = None;
            continue;
        }
        if let Some(wider) = &wider {
            let rounding = tolerance::ULP.value * here.cam().top().abs() / step;
            let off = |one: f64, other: f64| (one - other).abs() + rounding;
            let errors: Vec<LiftChange> = sums
                .iter()
                .zip(wider)
                .map(|(sum, wide)| LiftChange { value: off(sum.value, wide.value), slope: off(sum.slope, wide.slope) })
                .collect();
            let size: f64 = errors.iter().map(|error| error.value + error.slope).sum();
            if best.as_ref().is_none_or(|(least, _, _)| size < *least) {
                best = Some((size, sums.clone(), errors));
            }
        }
        wider = Some(sums);
    }
    best.map(|(_, lifts, errors)| (lifts, errors)).ok_or(failure)
}

/// Segment and angle, rad, of every impact.
fn impacts(cam: &Cam, at: &CornerImpact, side: Side) -> Vec<(usize, f64)> {
    let place = |(index, impact): (usize, &crate::orbit::Impact)| {
        let on_side = at_corner(cam, &at.corner, side, impact.revolution, impact.velocity_before);
        let impact = if index == at.impact { &on_side } else { impact };
        (impact.segment, impact.cam_angle)
    };
    at.cycle.impacts.iter().enumerate().map(place).collect()
}
