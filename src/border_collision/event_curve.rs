//! Curves of one kind of event in the plane of the speed and a number of the model, with the scenario at each corner impact.

use serde::Serialize;

use super::feigin::{Scenario, scenario};
use crate::orbit::branch::{Branch, BranchPoint, End, GrazeClass, Special, SpecialKind};
use crate::orbit::{Eigenvalue, eigenvalues};
use crate::tolerance;

/// Scenario of a corner impact, by the eigenvalues of its map alone, or class of the graze of an orbit without impacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Happening {
    /// Jump of a derivative that gives no piecewise-linear map.
    NotPiecewiseLinear,
    /// Eigenvalue on a boundary of the counts.
    Degenerate,
    /// Border collision: Feigin's scenario.
    #[serde(untagged)]
    BorderCollision(Scenario),
    /// Graze of an orbit without impacts.
    #[serde(untagged)]
    Graze(GrazeClass),
}

named!(Happening);

/// One point of a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct EventPoint {
    /// Speed, rpm.
    pub rpm: f64,
    /// Value of the other number.
    pub value: f64,
    /// Cam angle of the impact at the corner, of the graze, or of the first impact, rad.
    pub cam_angle: f64,
    /// Turns of the cam in one period.
    pub revolutions: u64,
    pub impacts: usize,
    /// Scenario of a corner impact, or class of the graze of an orbit without impacts.
    pub happening: Option<Happening>,
    /// Multipliers: two of the orbit; at a corner impact two with the law before the corner, then two with the law after it.
    pub multipliers: Vec<Eigenvalue>,
    /// Special point at this point of the curve, if any.
    pub special: Option<Special>,
}

document!(EventPoint as it {
    speed_rpm: it.rpm,
    value: it.value,
    cam_angle_rad: it.cam_angle,
    revolutions: it.revolutions,
    impacts: it.impacts,
    happens: it.happening.map(|happening| happening.to_string()),
    multipliers: it.multipliers,
    special: it.special,
});

impl EventPoint {
    fn new(point: &BranchPoint, kind: SpecialKind) -> Self {
        let BranchPoint { rpm, value, orbit, held, special } = point;
        let sides = held.as_ref().map(|held| held.sides.as_slice()).unwrap_or_default();
        let of_sides = |sides: [_; 2]| scenario(&sides).map_or(Happening::Degenerate, Happening::BorderCollision);
        let happening = match (kind, sides) {
            (SpecialKind::Corner { jump_order: 2, .. }, [minus, plus]) => Some(of_sides([*minus, *plus])),
            (SpecialKind::Corner { .. }, _) => Some(Happening::NotPiecewiseLinear),
            _ => held.as_ref().and_then(|held| held.class).map(Happening::Graze),
        };
        Self {
            rpm: *rpm,
            value: *value,
            cam_angle: held.as_ref().map_or(f64::NAN, |held| held.cam_angle),
            revolutions: orbit.revolutions,
            impacts: orbit.impacts().count(),
            happening,
            multipliers: sides.iter().flat_map(eigenvalues).collect(),
            special: *special,
        }
    }
}

/// Curve of one kind of event.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub struct EventCurve {
    /// Event at the model's own number.
    pub kind: SpecialKind,
    pub points: Vec<EventPoint>,
    /// Reasons for its start and its end.
    pub ends: [End; 2],
}

document!(EventCurve as it {
    event: it.kind.bifurcation().map(|event| event.to_string()),
    begins: it.ends[0].words(),
    ends: it.ends[1].words(),
    points: it.points,
});

impl EventCurve {
    /// Builds the events along a curve whose event is `kind` at the model's own number.
    pub fn new(curve: &Branch, kind: SpecialKind) -> Self {
        let points = curve.points.iter().map(|point| EventPoint::new(point, kind)).collect();
        Self { kind, points, ends: curve.ends.clone() }
    }

    /// Whether both curves have the same events, in either direction: their ends and the reasons for them agree.
    pub fn is_same(&self, other: &Self) -> bool {
        let ends = |curve: &Self| -> Option<[(f64, f64, End); 2]> {
            let [first, last] = [curve.points.first()?, curve.points.last()?].map(|point| (point.value, point.rpm));
            let [begins, ends] = curve.ends.clone();
            (curve.points.len() > 1).then_some([(first.0, first.1, begins), (last.0, last.1, ends)])
        };
        let near = |one: f64, two: f64| (one - two).abs() <= tolerance::SAME_ORBIT.value * one.abs().max(two.abs());
        let same =
            |one: &(f64, f64, End), two: &(f64, f64, End)| near(one.0, two.0) && near(one.1, two.1) && one.2 == two.2;
        let both = ends(self).zip(ends(other)).filter(|_| self.kind.bifurcation() == other.kind.bifurcation());
        both.is_some_and(|([begin, end], [first, last])| {
            (same(&begin, &first) && same(&end, &last)) || (same(&begin, &last) && same(&end, &first))
        })
    }

    /// Pairs of neighbouring points, with the happening between them, taken from an end that is not a special point.
    pub fn pieces(&self) -> impl Iterator<Item = ([&EventPoint; 2], Option<Happening>)> {
        self.points.windows(2).filter_map(|pair| {
            let [from, to] = pair else { return None };
            let of = if from.special.is_some() { to } else { from };
            Some(([from, to], of.happening))
        })
    }
}
