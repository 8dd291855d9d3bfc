//! How far from the corner impact the local map holds: measured against the simulated machine on its own cam.
//!
//! The real map has terms of second order that the local one leaves out. For a period T* + dT the machine is run, and its
//! displacement from x* is compared with the one that A and B predict; |dT| grows from almost nothing until they differ by a
//! tenth of the prediction. Velocities count over the cam's angle, `|(q, v/omega)|`.

use std::convert::Infallible;
use std::f64::consts::TAU;

use nalgebra::Vector2;
use serde::Serialize;

use super::feigin::speeds_at;
use super::local_map::LocalMap;
use super::word::Word;
use crate::bracket::{Width, halve};
use crate::cam::Cam;
use crate::corner::CornerImpact;
use crate::flight::State;
use crate::model::Model;
use crate::section::StroboscopicMap;
use crate::simulate::{Event, EventKind, Machine};
use crate::tolerance;

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Compared {
    /// The image of x* after one revolution, `B dT`.
    OneRevolution,
    /// The fixed point before the corner, `(I - A-)^{-1} B- dT`.
    FixedPointMinus,
    /// The fixed point after the corner, `(I - A+)^{-1} B+ dT`.
    FixedPointPlus,
}

/// What ends the range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ends {
    /// The two differ by a tenth.
    Tenth,
    /// The real motion is not there any more, or has not one impact.
    OtherMotion,
    /// Nothing, up to half and twice the speed.
    Nothing,
}

/// How far one prediction holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Of what.
    pub compared: Compared,
    /// Of dT: -1 for speeds above that of the corner impact, 1 for those below.
    pub sign: f64,
    /// The last change of the period for which it holds, s, with its sign; 0 where it never does.
    pub period_change: f64,
    /// The speed there, rpm.
    pub speed_rpm: f64,
    /// The relative difference there; none where it holds nowhere.
    pub difference: Option<f64>,
    /// What ends it.
    pub ends: Ends,
}

document!(Range as range {
    compared: range.compared,
    speeds: speeds_at(range.sign),
    period_change_s: range.period_change,
    speed_rpm: range.speed_rpm,
    difference: range.difference,
    ends: range.ends,
});

/// A real displacement and the relative difference from the predicted one.
type Difference = Option<(Vector2<f64>, f64)>;

/// The range of each prediction that there is, on either side of the corner-impact speed, faster speeds first.
pub fn ranges(model: &Model, cam: &Cam, at: &CornerImpact, map: &LocalMap) -> Vec<Range> {
    let machine = Real {
        at,
        map: StroboscopicMap {
            machine: Machine::new(cam.clone(), &model.follower, at.angular_velocity()),
            cam_angle: at.section_angle(),
        },
    };
    let mut found = Vec::new();
    for sign in [-1.0, 1.0] {
        let side = map.side(Vector2::zeros(), sign);
        let image = map.of(side).b * sign;
        found.push(machine.range(Compared::OneRevolution, sign, |dt, _| machine.revolution(dt, image * dt.abs())));
        for (name, compared) in [("L", Compared::FixedPointMinus), ("R", Compared::FixedPointPlus)] {
            let orbit = Word::read(name).and_then(|word| map.orbit(&word, sign)).filter(|orbit| orbit.admissible());
            let Some(point) = orbit.and_then(|orbit| orbit.points.first().copied()) else { continue };
            found.push(machine.range(compared, sign, |dt, before| {
                // The real one where it was, moved on as the prediction is.
                let guess = before.map_or(point * dt.abs(), |(real, at): (Vector2<f64>, f64)| real * (dt / at));
                machine.fixed_point(dt, point * dt.abs(), guess)
            }));
        }
    }
    found
}

struct Real<'a> {
    at: &'a CornerImpact,
    map: StroboscopicMap,
}

impl Real<'_> {
    /// By how much |dT| grows from one comparison to the next.
    const GROWTH: f64 = 1.15;

    fn map(&self, dt: f64) -> StroboscopicMap {
        let machine = self.map.machine.at_speed(TAU / (self.at.period + dt));
        StroboscopicMap { machine, cam_angle: self.map.cam_angle }
    }

    fn difference(&self, real: Vector2<f64>, predicted: Vector2<f64>) -> Difference {
        let omega = TAU / self.at.period;
        let size = |x: Vector2<f64>| x[0].hypot(x[1] / omega);
        let relative = size(real - predicted) / size(predicted);
        relative.is_finite().then_some((real, relative))
    }

    fn displaced(&self, dx: Vector2<f64>) -> State {
        State { position: self.at.state.position + dx[0], velocity: self.at.state.velocity + dx[1] }
    }

    /// The displacement after a revolution from `x* + dx`, if it has one impact.
    fn image(&self, map: &StroboscopicMap, dx: Vector2<f64>) -> Option<Vector2<f64>> {
        let back = map.apply(self.displaced(dx)).ok()?;
        let [Event { kind: EventKind::Impact, .. }] = back.events.as_slice() else { return None };
        let State { position, velocity } = back.state;
        Some(Vector2::new(position - self.at.state.position, velocity - self.at.state.velocity))
    }

    fn revolution(&self, dt: f64, predicted: Vector2<f64>) -> Difference {
        self.difference(self.image(&self.map(dt), Vector2::zeros())?, predicted)
    }

    fn fixed_point(&self, dt: f64, predicted: Vector2<f64>, guess: Vector2<f64>) -> Difference {
        let map = self.map(dt);
        let State { position, velocity } = map.periodic(self.displaced(guess), 1).ok()??.state;
        let real = Vector2::new(position - self.at.state.position, velocity - self.at.state.velocity);
        self.image(&map, real)?;
        self.difference(real, predicted)
    }

    /// The first |dT| at which a comparison fails, growing from [`tolerance::LINEAR_FROM`], then by halving.
    fn range(
        &self,
        compared: Compared,
        sign: f64,
        compare: impl Fn(f64, Option<(Vector2<f64>, f64)>) -> Difference,
    ) -> Range {
        let period = self.at.period;
        // The last dT that held with what was found there.
        let mut last: Option<(f64, Vector2<f64>, f64)> = None;
        let mut ends = Ends::Nothing;
        let mut fails = |dt: f64| {
            let found = compare(dt, last.map(|(dt, real, _)| (real, dt)));
            match found {
                Some((real, apart)) if apart <= tolerance::LINEAR_WITHIN.value => last = Some((dt, real, apart)),
                other => {
                    ends = if other.is_some() { Ends::Tenth } else { Ends::OtherMotion };
                    return Ok::<_, Infallible>(true);
                }
            }
            Ok(false)
        };
        let (mut held, mut dt) = (None, sign * tolerance::LINEAR_FROM.value * period);
        // Half the speed and twice the speed: T* more, or T*/2 less.
        let most = if sign > 0.0 { period } else { 0.5 * period };
        while dt.abs() < most {
            let Ok(false) = fails(dt) else {
                // Where nothing held there is no range to close in.
                if let Some(held) = held {
                    let Ok(_) = halve([held, dt], Width::Relative(tolerance::LINEAR_BRACKET.value), &mut fails);
                }
                break;
            };
            held = Some(dt);
            dt *= Self::GROWTH;
        }
        let period_change = last.map_or(0.0, |(dt, ..)| dt);
        let difference = last.map(|(.., apart)| apart);
        Range { compared, sign, period_change, speed_rpm: 60.0 / (period + period_change), difference, ends }
    }
}
