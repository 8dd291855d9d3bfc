//! Branches: periodic orbits followed in one number of the model, round folds and through corners, with the points located
//! where something changes.
//!
//! Where an impact passes a corner, the orbits beyond obey the law of the next segment. Where a flight touches the cam, the orbits beyond
//! have one more impact, and where an impact becomes a touch, one less. Either way the branch continues with the equations of another
//! cycle: it is continuous, but its direction may jump.
//!
//! | module | contents |
//! |---|---|
//! | `find` | the branches through given orbits and what branches off; the branches of a range of speeds, and their special points |
//! | `doubled` | orbits of twice the period next to a special point, and orbits of a branch that crosses |
//! | `follow` | one direction of a branch, step by step; `chatter` where the follower sticks |
//! | `problem`, `constraint` | the equations, with numbers of the model free; the condition added along a curve in two of them |
//! | `step_event`, `least_gap`, `period_halving` | events within a step: corners, folds, flips; grazes; the end of a doubled period |
//! | `free`, `first_touch` | orbits without impacts, and their graze with the motions beyond it |
//! | `sticking_curve`, `sticking_event` | curves of a follower on the cam: where it leaves the cam, where it no longer rests |
//! | `perturbed` | the events of a machine that differs a little |
//! | `switch` | the cycle beyond a corner or a graze, and which way leads there |
//! | `special` | the points where something changes; which impacts of neighbouring orbits correspond |

mod chatter;
mod constraint;
mod doubled;
mod find;
mod first_touch;
mod follow;
mod free;
mod least_gap;
mod period_halving;
mod perturbed;
mod problem;
mod special;
mod step_event;
mod sticking_curve;
mod sticking_event;
mod switch;

use nalgebra::Matrix2;

use super::{Family, FamilyError, OrbitError, Parameter, PeriodicOrbit, Stability};
use crate::model::Model;
use crate::tolerance;
pub(crate) use doubled::{crossing, doubled};
pub use find::{FoundBranches, GRID_RATIO, MetPoints, find_branches, special_points};
pub use first_touch::{Doubt, FirstTouch, GrazeClass, UndecidedGraze};
pub(crate) use free::touches;
pub(crate) use perturbed::Event;
pub use special::Special;
pub use special::{Bifurcation, SpecialKind};
#[doc(hidden)]
pub use sticking_curve::onward;

/// The followed parameter, its range, and the limits of a walk.
#[derive(Clone, Debug, PartialEq)]
pub struct Following {
    /// Parameter that changes.
    pub parameter: Parameter,
    /// Lowest and highest value of the parameter.
    pub range: [f64; 2],
    /// Longest step, relative to the range or to a radian of an impact's angle.
    pub longest_step: f64,
    /// Points in one direction after which the branch is given up.
    pub most_points: usize,
}

impl Following {
    /// Returns the last value in one direction from `value`: the end of the range, or the last that the model allows.
    fn bound(&self, family: &Family, value: f64, direction: f64) -> (f64, End) {
        let edge = self.range[usize::from(direction > 0.0)];
        if let Err(why) = family.machine(&[edge])
            && let Some(last) = super::curve::limit(value, edge, |value| family.machine(&[value]).is_err())
        {
            return (last, End::edge(direction > 0.0, &why));
        }
        (edge, End::Range)
    }
}

/// An orbit on a branch.
#[derive(Clone, Debug, PartialEq)]
pub struct BranchPoint {
    /// The speed, rpm.
    pub rpm: f64,
    /// Value of the parameter.
    pub value: f64,
    /// The orbit.
    pub orbit: PeriodicOrbit,
    /// Event of a curve in two numbers.
    pub held: Option<OnCurve>,
    /// Change at this point, if any.
    pub special: Option<Special>,
}

document!(BranchPoint as it {
    speed_rpm: it.rpm,
    value: it.value,
    special: it.special,
    orbit: it.orbit,
});

document!(Special as it {
    kind: it.kind.name(),
    bracket: it.bracket,
    residual: it.residual,
});

/// The event that a curve follows, at one of its points.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub struct OnCurve {
    /// Cam angle, rad, of the impact on the corner, or of the touch; for other events, of the first impact.
    pub cam_angle: f64,
    /// Matrix of one period. For a corner impact, the matrix with the law before the corner, then the matrix with the law after it.
    pub sides: Vec<Matrix2<f64>>,
    /// Class of the graze of an orbit without impacts.
    pub class: Option<GrazeClass>,
}

/// Reason why a branch goes no further in one direction.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// The end of the range.
    Range,
    /// The start of the branch again: the branch is closed.
    Closed,
    /// An edge of the values that the model allows.
    Edge {
        /// Whether the last value is the largest allowed; otherwise it is the smallest.
        largest: bool,
        /// Rule of the model.
        why: String,
    },
    /// Velocities that grow without bound.
    Unbounded,
    /// Impacts without number before the follower rests.
    Endless,
    /// An impact on the way to a rest at a corner, where the curve has a kink.
    Kink,
    /// Another way of the follower to its rest, or no rest at all.
    OtherWay,
    /// A continuum: orbits of many amplitudes at one value, which changes by no more than rounding over a few steps.
    Continuum,
    /// The requested number of points.
    MostPoints,
    /// Impacts without number: the follower begins to chatter there, or ceases to.
    Chatter,
    /// The end of a range of speeds, for an orbit without impacts: its distance from the cam is the same at each speed.
    Clear,
    /// A fall of the follower, which no spring supports above the cam any more.
    Falls,
    /// An impact of the orbit at a corner, beyond which the curve does not exist.
    Corner,
    /// A graze beyond which no orbit nearby continues the branch.
    Graze,
    /// An orbit that repeats sooner, from which the branch comes by a flip or a graze.
    Shorter,
    /// An impact at a corner where the cam's velocity jumps: the map has a gap there.
    Gap,
    /// A loss of the branch: no orbit was found nearby.
    Lost,
}

impl End {
    /// The end where the model allows no larger value, or no smaller one, with the reason.
    fn edge(largest: bool, why: &FamilyError) -> Self {
        Self::Edge { largest, why: why.rule() }
    }

    /// Describes the end in words, for a message.
    pub fn words(&self) -> String {
        match self {
            Self::Range => "the end of the range".into(),
            Self::Closed => "its own start: the branch is closed".into(),
            Self::Edge { largest, why } => {
                format!("the {} possible value: {why}", if *largest { "largest" } else { "smallest" })
            }
            Self::Unbounded => "impacts that become faster without bound".into(),
            Self::Endless => "infinitely many impacts before the follower rests".into(),
            Self::Kink => "an impact at a corner on the way to the rest, beyond which it is not followed".into(),
            Self::OtherWay => "a place from which the follower goes another way".into(),
            Self::Continuum => "an apparent continuum of orbits: over the last steps amplitudes change at the same value".into(),
            Self::MostPoints => "the number of points that was asked for".into(),
            Self::Chatter => "the onset of chattering".into(),
            Self::Clear => {
                "the end of the range; a follower at rest is equally far from the cam at every speed, so there is no graze".into()
            }
            Self::Falls => "a place beyond which nothing holds the follower above the cam".into(),
            Self::Corner => "an impact at a corner, beyond which nothing continues it".into(),
            Self::Graze => "a graze, beyond which no orbit continues it".into(),
            Self::Shorter => "an orbit of fewer revolutions, from which it branches off".into(),
            Self::Gap => "a corner where the cam's velocity jumps, beyond which no orbit continues it".into(),
            Self::Lost => "a place beyond which Newton's method finds no orbit nearby".into(),
        }
    }
}

/// One impact of the orbits of a branch, as long as it is the same impact and the orbits have the same stability.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub struct ImpactLine {
    /// Stability of the orbits.
    pub stability: Stability,
    /// The parameter, and the cam angle of the impact, rad.
    pub points: Vec<[f64; 2]>,
}

/// A branch in one direction from where it starts, and why it ends.
type HalfBranch = (Vec<BranchPoint>, End);

/// A branch, from one end to the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// The orbits in order along it.
    pub points: Vec<BranchPoint>,
    /// Reasons why it starts and ends where it does.
    pub ends: [End; 2],
}

document!(Branch as it {
    begins: it.ends[0].words(),
    ends: it.ends[1].words(),
    points: it.points,
});

impl Branch {
    /// Follows the branch through `orbit`, an orbit of `model` at `rpm`.
    pub fn through(model: &Model, rpm: f64, orbit: &PeriodicOrbit, following: &Following) -> Result<Self, OrbitError> {
        let family = Family::new(model, rpm, vec![following.parameter.clone()])?;
        Self::at(&family, following.parameter.value(model, rpm).unwrap_or(f64::NAN), orbit, following)
    }

    /// Follows the branch through `orbit`, of the machine at `value` of the followed parameter, the one free number of `family`.
    pub(crate) fn at(
        family: &Family,
        value: f64,
        orbit: &PeriodicOrbit,
        following: &Following,
    ) -> Result<Self, OrbitError> {
        let (_, rpm) = family.machine(&[value])?;
        let spans = [following.range[1] - following.range[0]];
        let half = |direction| match &orbit.course {
            super::Course::Impacts(cycle) => {
                let start = follow::Start { cycle, values: &[value], spans: &spans, held: None };
                free::onward(family, follow::half(family, &start, following, direction)?, following)
            }
            super::Course::Sticking(anchor) => {
                chatter::half(family, value, (*anchor, orbit.revolutions), following, direction)
            }
            super::Course::Free => free::half(family, value, orbit.state, following, direction),
        };
        let middle = BranchPoint { held: None, rpm, value, orbit: orbit.clone(), special: None };
        Ok(Self::joined([half(-1.0)?, half(1.0)?], middle))
    }

    /// Follows the curve of the event at `point`, a special point of a branch in the speed, in the plane of the speed and the followed
    /// parameter. `None` if the point has no such curve. Speeds are measured against the range `speeds`, rpm.
    pub fn of_event(
        model: &Model,
        point: &BranchPoint,
        speeds: [f64; 2],
        following: &Following,
    ) -> Result<Option<Self>, OrbitError> {
        let Some(special) = point.special else { return Ok(None) };
        let family = Family::new(model, point.rpm, vec![Parameter::Speed, following.parameter.clone()])?;
        let values = [point.rpm, following.parameter.value(model, point.rpm).unwrap_or(f64::NAN)];
        let spans = [speeds[1] - speeds[0], following.range[1] - following.range[0]];
        let whole = match &point.orbit.course {
            super::Course::Impacts(cycle) => {
                let (machine, _) = family.machine(&values)?;
                let Some((cycle, held)) = switch::held(special.kind, cycle, &machine) else { return Ok(None) };
                let start = follow::Start { cycle: &cycle, values: &values, spans: &spans, held: Some(held) };
                follow::curve(&family, &start, following, Some(special))?
            }
            super::Course::Sticking(_) => {
                sticking_curve::curve(&family, (values, spans), &point.orbit, special, following)?
            }
            super::Course::Free => None,
        };
        Ok(Some(match whole {
            Some((middle, halves)) => Self::joined(halves, BranchPoint { value: values[1], ..middle }),
            None => {
                Self { points: vec![BranchPoint { value: values[1], ..point.clone() }], ends: [End::Lost, End::Lost] }
            }
        }))
    }

    /// Joins both directions from a point in the middle.
    fn joined([(mut points, first), (onward, last)]: [HalfBranch; 2], middle: BranchPoint) -> Self {
        points.reverse();
        points.push(middle);
        if first != End::Closed {
            points.extend(onward);
        }
        Self { points, ends: [first, last] }
    }

    /// Lines of the impacts along the branch, for orbits that do not stick. Each impact is followed from orbit to orbit, even if its index
    /// from angle 0 changes.
    ///
    /// A line ends where the number of impacts or the stability changes, or where the impact passes angle 0.
    pub fn lines(&self) -> Vec<ImpactLine> {
        let (mut done, mut open) = (Vec::new(), Vec::<(usize, ImpactLine)>::new());
        for pair in self.points.windows(2) {
            let [one, other] = pair else { continue };
            // A piece has the stability of the end that is not a special point.
            let stability = if one.special.is_some() { other } else { one }.orbit.judgement.stability;
            let mut onward = Vec::new();
            for (from, to) in special::same_impacts(&one.orbit, &other.orbit) {
                let [here, there] = [(one, from), (other, to)].map(|(point, index)| {
                    [point.value, point.orbit.impacts().nth(index).map_or(f64::NAN, |impact| impact.cam_angle)]
                });
                let same = open.iter().position(|(index, line)| *index == from && line.stability == stability);
                let over = (there[1] - here[1]).abs() > std::f64::consts::PI;
                let (_, mut line) = same.map_or_else(
                    || (from, ImpactLine { stability, points: vec![here] }),
                    |place| open.swap_remove(place),
                );
                if over {
                    done.push(std::mem::replace(&mut line, ImpactLine { stability, points: vec![there] }));
                } else {
                    line.points.push(there);
                }
                onward.push((to, line));
            }
            done.extend(std::mem::replace(&mut open, onward).into_iter().map(|(_, line)| line));
        }
        done.extend(open.into_iter().map(|(_, line)| line));
        done.retain(|line| line.points.len() > 1);
        done
    }

    /// Whether an orbit at `value` of the parameter is on the branch.
    pub fn holds(&self, value: f64, orbit: &PeriodicOrbit) -> bool {
        let spans = |pair: &&[BranchPoint]| (pair[0].value - value) * (pair[1].value - value) <= 0.0;
        self.points.windows(2).filter(spans).any(|pair| {
            let nearest =
                if (pair[0].value - value).abs() < (pair[1].value - value).abs() { &pair[0] } else { &pair[1] };
            // The distance between neighbouring points is the bound: where branches meet, orbits of other branches are near.
            let stride = special::apart(&pair[0].orbit, &pair[1].orbit).map_or(f64::INFINITY, |(stride, _)| stride);
            let reach = (stride + tolerance::SAME_ORBIT.value).min(tolerance::NEIGHBOURING.value);
            match (&nearest.orbit.course, &orbit.course) {
                (super::Course::Sticking(_), super::Course::Sticking(_)) => {
                    nearest.orbit.revolutions == orbit.revolutions
                }
                (super::Course::Free, super::Course::Free) => true,
                _ => special::apart(&nearest.orbit, orbit).is_some_and(|(apart, _)| apart <= reach),
            }
        })
    }
}
