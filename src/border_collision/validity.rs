//! Range around the corner impact in which the local map is valid, measured on the simulated machine with its actual cam.
//!
//! The real map has terms of second order that the local map leaves out. The machine is run with a period T* + dT, and its displacement
//! from x* is compared with the one predicted by A and B. |dT| grows from almost nothing until they differ by a tenth of the prediction.
//! The comparison is repeated with the terms of second order of [`crate::corner::second_order`], until the difference is a tenth, and a
//! ten-thousandth. Velocities are divided by omega, `|(q, v/omega)|`.

use std::convert::Infallible;
use std::f64::consts::TAU;

use nalgebra::Vector2;
use serde::Serialize;

use super::feigin::speeds_at;
use super::local_map::{LocalMap, MapOrbit};
use super::word::Word;
use crate::bracket::{Width, halve};
use crate::cam::{Cam, Side};
use crate::corner::CornerImpact;
use crate::corner::map::Sides;
use crate::corner::second_order::CurvedMap;
use crate::elementary;
use crate::flight::State;
use crate::model::Model;
use crate::section::StroboscopicMap;
use crate::simulate::{Event, EventKind, Machine};
use crate::tolerance;

/// Quantity that is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ComparedMotion {
    /// Image of x* after one revolution, to first order `B dT`.
    OneRevolution,
    /// Fixed point before the corner, to first order `(I - A-)^{-1} B- dT`.
    FixedPointMinus,
    /// Fixed point after the corner, to first order `(I - A+)^{-1} B+ dT`.
    FixedPointPlus,
}

named!(ComparedMotion);

/// Reason for the end of the range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ends {
    /// Difference larger than allowed.
    Differs,
    /// Real motion that no longer exists, or does not have exactly one impact.
    OtherMotion,
    /// No end, up to half and twice the speed.
    Nothing,
}

/// Range in which one prediction is valid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Quantity compared.
    pub compared: ComparedMotion,
    /// Order in dT, 1 or 2.
    pub order: u32,
    /// Largest allowed difference, relative to the prediction.
    pub within: f64,
    /// Sign of dT: -1 for speeds above the corner-impact speed, 1 for speeds below.
    pub sign: f64,
    /// Last change of the period at which the prediction is valid, s, with its sign; 0 if it is valid nowhere.
    pub period_change: f64,
    /// Speed at that change, rpm.
    pub speed_rpm: f64,
    /// Relative difference at that change; `None` if the prediction is valid nowhere.
    pub difference: Option<f64>,
    /// Reason for the end of the range.
    pub ends: Ends,
}

document!(Range as range {
    compared: range.compared,
    order: range.order,
    within: range.within,
    speeds: speeds_at(range.sign),
    period_change_s: range.period_change,
    speed_rpm: range.speed_rpm,
    difference: range.difference,
    ends: range.ends,
});

/// Real displacement, and its relative difference from the predicted one.
type Difference = Option<(Vector2<f64>, f64)>;

/// Range of each available prediction, to first order and then to second, on either side of the corner-impact speed, faster speeds first.
pub fn ranges(model: &Model, cam: &Cam, at: &CornerImpact, map: &LocalMap, curved: &Sides<CurvedMap>) -> Vec<Range> {
    let machine = Real {
        at,
        map: StroboscopicMap {
            machine: Machine::new(cam.clone(), &model.follower, at.angular_velocity()),
            cam_angle: at.section_angle(),
        },
    };
    let mut found = Vec::new();
    let asked = [(1, tolerance::LINEAR_WITHIN), (2, tolerance::LINEAR_WITHIN), (2, tolerance::CURVED_WITHIN)];
    for ((order, within), sign) in asked.into_iter().flat_map(|asked| [(asked, -1.0), (asked, 1.0)]) {
        let within = within.value;
        let asked = |compared| Range::asked(compared, order, within, sign);
        let predicted = |[first, second]: [Vector2<f64>; 2], dt: f64| match order {
            1 => first * dt,
            _ => first * dt + second * (dt * dt),
        };
        let image = curved.of(map.side(Vector2::zeros(), sign)).image();
        let image = |dt: f64, _| machine.revolution(dt, predicted(image, dt));
        found.push(machine.range(asked(ComparedMotion::OneRevolution), image));
        for (name, side, compared) in
            [("L", Side::Minus, ComparedMotion::FixedPointMinus), ("R", Side::Plus, ComparedMotion::FixedPointPlus)]
        {
            let orbit = Word::read(name).and_then(|word| map.orbit(&word, sign)).filter(MapOrbit::admissible);
            let Some(point) = orbit.and_then(|_| curved.of(side).fixed_point()) else { continue };
            found.push(machine.range(asked(compared), |dt, before| {
                let predicted = predicted(point, dt);
                // The guess is the last real displacement, scaled as the prediction.
                let guess = before.map_or(predicted, |(real, at): (Vector2<f64>, f64)| real * (dt / at));
                machine.fixed_point(dt, predicted, guess)
            }));
        }
    }
    found
}

impl Range {
    /// Empty range, before the search.
    fn asked(compared: ComparedMotion, order: u32, within: f64, sign: f64) -> Self {
        let (period_change, speed_rpm, difference, ends) = (0.0, f64::NAN, None, Ends::Nothing);
        Self { compared, order, within, sign, period_change, speed_rpm, difference, ends }
    }
}

struct Real<'a> {
    at: &'a CornerImpact,
    map: StroboscopicMap,
}

impl Real<'_> {
    /// Factor by which |dT| grows from one comparison to the next.
    const GROWTH: f64 = 1.15;

    fn map(&self, dt: f64) -> StroboscopicMap {
        let machine = self.map.machine.at_speed(TAU / (self.at.period + dt));
        StroboscopicMap { machine, cam_angle: self.map.cam_angle }
    }

    fn difference(&self, real: Vector2<f64>, predicted: Vector2<f64>) -> Difference {
        let omega = TAU / self.at.period;
        let size = |x: Vector2<f64>| elementary::hypot(x[0], x[1] / omega);
        let relative = size(real - predicted) / size(predicted);
        relative.is_finite().then_some((real, relative))
    }

    fn displaced(&self, dx: Vector2<f64>) -> State {
        State { position: self.at.state.position + dx[0], velocity: self.at.state.velocity + dx[1] }
    }

    /// Displacement after a revolution from `x* + dx`, if it has one impact.
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

    /// Finds the first |dT| at which a comparison fails, growing from [`tolerance::LINEAR_FROM`], then by halving.
    fn range(&self, asked: Range, compare: impl Fn(f64, Option<(Vector2<f64>, f64)>) -> Difference) -> Range {
        let (period, Range { sign, within, .. }) = (self.at.period, asked);
        // Last dT for which the prediction was valid, with the real displacement and the difference.
        let mut last: Option<(f64, Vector2<f64>, f64)> = None;
        let mut ends = Ends::Nothing;
        let mut fails = |dt: f64| {
            let found = compare(dt, last.map(|(dt, real, _)| (real, dt)));
            match found {
                Some((real, apart)) if apart <= within => last = Some((dt, real, apart)),
                other => {
                    ends = if other.is_some() { Ends::Differs } else { Ends::OtherMotion };
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
                // If the prediction was valid nowhere, there is no range to narrow down.
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
        Range { period_change, speed_rpm: 60.0 / (period + period_change), difference, ends, ..asked }
    }
}
