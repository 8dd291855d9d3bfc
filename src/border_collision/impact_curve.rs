//! A curve of corner impacts in the plane of the speed and a number of the model, and what happens at each of them.

use serde::Serialize;

use super::feigin::{Scenario, scenario};
use crate::orbit::branch::{Branch, BranchPoint, End, Kind, Special};
use crate::orbit::{Eigenvalue, eigenvalues};

/// What is the same all along a curve: the impact at the corner, by its number, and the order of the jump.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AtCorner {
    /// Index of the impact, of those from angle 0 on.
    pub impact: usize,
    /// The lowest derivative that jumps.
    pub jump_order: usize,
}

impl AtCorner {
    /// Of a point of a branch, if it is a corner impact.
    pub fn of(point: &BranchPoint) -> Option<Self> {
        match point.special {
            Some(Special { kind: Kind::Corner { impact, jump_order, .. }, .. }) => Some(Self { impact, jump_order }),
            _ => None,
        }
    }
}

/// What happens at a corner impact, by the eigenvalues of its map alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Happening {
    /// A derivative jumps that gives no such map.
    NotPiecewiseLinear,
    /// An eigenvalue on a boundary of the counts.
    Degenerate,
    /// Two matrices meet: Feigin's scenario.
    #[serde(untagged)]
    BorderCollision(Scenario),
}

named!(Happening);

/// One corner impact of a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveImpact {
    /// Its speed, rpm.
    pub rpm: f64,
    /// What the other number is.
    pub value: f64,
    /// Where the impact is that is at the corner, rad; no number where the orbit has none of that index.
    pub cam_angle: f64,
    /// Turns of the cam in one period.
    pub revolutions: u64,
    pub impacts: usize,
    pub happening: Happening,
    /// Two with the law before the corner, then two with the law after it.
    pub multipliers: Vec<Eigenvalue>,
    /// What changes along the curve here, if anything.
    pub special: Option<Special>,
}

impl CurveImpact {
    fn new(point: &BranchPoint, at: AtCorner) -> Self {
        let BranchPoint { rpm, value, orbit, sides, special } = point;
        let happening = match sides {
            _ if at.jump_order != 2 => Happening::NotPiecewiseLinear,
            Some(sides) => scenario(sides).map_or(Happening::Degenerate, Happening::BorderCollision),
            None => Happening::Degenerate,
        };
        Self {
            rpm: *rpm,
            value: *value,
            cam_angle: orbit.impacts().nth(at.impact).map_or(f64::NAN, |impact| impact.cam_angle),
            revolutions: orbit.revolutions,
            impacts: orbit.impacts().count(),
            happening,
            multipliers: sides.iter().flatten().flat_map(eigenvalues).collect(),
            special: *special,
        }
    }
}

/// A curve of corner impacts.
#[derive(Clone, Debug, PartialEq)]
pub struct ImpactCurve {
    /// Which impact, and of what order.
    pub at: AtCorner,
    pub impacts: Vec<CurveImpact>,
    /// Why it starts and ends where it does.
    pub ends: [End; 2],
}

impl ImpactCurve {
    /// What happens along a curve of corner impacts.
    pub fn new(curve: &Branch, at: AtCorner) -> Self {
        let impacts = curve.points.iter().map(|point| CurveImpact::new(point, at)).collect();
        Self { at, impacts, ends: curve.ends.clone() }
    }

    /// From each corner impact to the next, with what happens in between: as at the end that is no point of change.
    pub fn pieces(&self) -> impl Iterator<Item = ([&CurveImpact; 2], Happening)> {
        self.impacts.windows(2).filter_map(|pair| {
            let [from, to] = pair else { return None };
            let of = if from.special.is_some() { to } else { from };
            Some(([from, to], of.happening))
        })
    }
}
