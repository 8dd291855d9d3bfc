//! The value at which an attractor begins or ends, and the cause.

use serde::Serialize;

use crate::orbit::branch::{BranchPoint, SpecialKind};
use crate::orbit::{Course, Parameter};
use crate::study::survey::Place;
use crate::uncertainty::{SourcedUncertainty, UncertaintyParts};

/// The value at which an attractor begins or ends, with its cause.
#[derive(Clone, Debug, PartialEq)]
pub struct Transition {
    /// Place of the transition.
    pub at: Place,
    /// Bracket of values; for the speed, rpm.
    pub bracket: [f64; 2],
    /// Cause of the transition.
    pub cause: Cause,
    /// Special point of a branch at which it lies, if any.
    pub point: Option<Box<BranchPoint>>,
    /// Uncertainty of the machine in the value; for the speed, rpm. None if the machine is exact, or if the uncertainty is unknown.
    pub error: Option<SourcedUncertainty>,
}

// `located` is true if the equations of the event were solved, and false for a bracket of runs.
document!(Transition as it {
    cause: it.cause.name(),
    speed_rpm: it.at.rpm,
    value if_any: it.at.value,
    located: it.is_located(),
    bracket_rpm if_any: it.at.value.is_none().then_some(it.bracket),
    bracket if_any: it.at.value.map(|_| it.bracket),
    error_rpm if_any: it.error.filter(|_| it.at.value.is_none()).map(|error| error.total()),
    error if_any: it.error.filter(|_| it.at.value.is_some()).map(|error| error.total()),
    error_parts if_any: it.error.map(|error| UncertaintyParts(error, it.at.unit())),
    cam_angle_rad if_any: it.cause.corner().map(|(angle, _)| angle),
    jump_order if_any: it.cause.corner().map(|(_, order)| order),
});

/// Cause for which an attractor begins or ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cause {
    /// A multiplier of the orbit passes 1.
    Fold,
    /// Two orbits branch off from one that repeats over each of equal lobes.
    SymmetryBreaking,
    /// A multiplier of the orbit passes -1.
    Flip,
    /// A flight grazes the cam: an impact is added or lost.
    Graze {
        /// Impacts before and after, in the direction in which the orbit was followed.
        impacts: [usize; 2],
    },
    /// An impact at a corner of the cam.
    CornerImpact {
        /// Corner angle, rad.
        cam_angle: f64,
        /// The lowest derivative of the lift that jumps there.
        jump_order: usize,
    },
    /// The follower leaves the cam for the first time.
    Detachment,
    /// Runs settle on the attractor on one side only.
    Runs,
}

impl Cause {
    /// Name in documents.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fold => "fold",
            Self::SymmetryBreaking => "symmetry-breaking",
            Self::Flip => "flip",
            Self::Graze { .. } => "graze",
            Self::CornerImpact { .. } => "corner-impact",
            Self::Detachment => "detachment",
            Self::Runs => "runs",
        }
    }

    fn corner(self) -> Option<(f64, usize)> {
        match self {
            Self::CornerImpact { cam_angle, jump_order } => Some((cam_angle, jump_order)),
            _ => None,
        }
    }
}

impl Transition {
    /// Builds the transition at a special point of a branch in `parameter`.
    pub fn of_point(parameter: &Parameter, point: &BranchPoint) -> Self {
        let at = parameter.place(point.value, point.rpm);
        let Some(special) = point.special else { return Self::at(at, Cause::Runs) };
        let cause = match (special.kind, &point.orbit.course) {
            // A multiplier also passes 1 where another branch crosses.
            (SpecialKind::Fold | SpecialKind::Branching, _) => Cause::Fold,
            (SpecialKind::Flip, _) => Cause::Flip,
            (SpecialKind::Graze { before, after, .. }, _) => Cause::Graze { impacts: [before, after] },
            (SpecialKind::Corner { impact, jump_order, .. }, Course::Impacts(cycle)) => {
                let cam_angle = cycle.impacts.get(impact).map_or(f64::NAN, |impact| impact.cam_angle);
                Cause::CornerImpact { cam_angle: cam_angle.rem_euclid(std::f64::consts::TAU), jump_order }
            }
            (SpecialKind::Detachment, _) => Cause::Detachment,
            (SpecialKind::Corner { .. } | SpecialKind::Chatter, _) => Cause::Runs,
            // Special points of curves in two numbers.
            (
                SpecialKind::Type { .. }
                | SpecialKind::Cusp
                | SpecialKind::Class(_)
                | SpecialKind::Place
                | SpecialKind::Turn,
                _,
            ) => Cause::Runs,
        };
        Self { at, bracket: special.bracket, cause, point: Some(Box::new(point.clone())), error: None }
    }

    /// Builds a transition at one place, known by an event's own equations or to the resolution of runs.
    pub fn at(at: Place, cause: Cause) -> Self {
        Self { at, bracket: [at.across(); 2], cause, point: None, error: None }
    }

    /// Builds a transition between two values of `parameter`, known by runs. The machines turn at `rpm` if the speed does not vary.
    pub fn by_runs(parameter: &Parameter, rpm: f64, bracket: [f64; 2]) -> Self {
        let at = parameter.place(0.5 * (bracket[0] + bracket[1]), rpm);
        Self { at, bracket, cause: Cause::Runs, point: None, error: None }
    }

    /// The value; of the speed, rpm.
    pub fn value(&self) -> f64 {
        self.at.across()
    }

    /// Whether the event's own equations were solved.
    pub fn is_located(&self) -> bool {
        self.cause != Cause::Runs
    }
}
