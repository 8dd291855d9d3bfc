//! Exponents and coefficients from simulation alone.
//!
//! [`SideFlights`] runs each flight twice, over the cam with the law before the corner continued past it and over the cam with the law
//! after it continued. [`gap`] runs flights on either side of the corner over the actual cam. A ladder of distances gives the exponent as
//! the slope of a log-log fit. The quotient by that power, extrapolated to distance 0, gives the coefficient.

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

use faer::Mat;
use nalgebra::{Matrix2, Vector2, Vector3};

use super::{Approach, JumpOrderError};
use crate::cam::{Cam, Side};
use crate::corner::extrapolation::{Powers, extrapolate};
use crate::corner::least_squares::Solver;
use crate::corner::one_sided::SampleError;
use crate::elementary;
use crate::estimate::{ErrorIs, Estimate};
use crate::flight::{Flight, State};
use crate::model::{Follower, Model};
use crate::simulate::{Event, EventKind, Machine};
use crate::tolerance;

/// Measured power law `coefficient * distance^exponent`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredLaw {
    /// Slope of the log-log fit.
    pub exponent: Estimate,
    /// Coefficient of the nearest whole power.
    pub coefficient: Estimate,
}

/// Number of halvings of a perturbation, or of the span around the corner, before the search fails.
const HALVINGS: u32 = 12;
/// Number of rungs of the ladder on either side: four to an octave, over four octaves.
const RUNGS: u32 = 17;
/// Number of powers of the distance that the fit has besides the logarithm, for terms after the leading one.
const CORRECTIONS: usize = 4;

/// Start before the corner and end after it, between which events occur only near the corner.
#[derive(Clone, Copy, Debug)]
struct Passage {
    /// Angle flown before the corner, and after it, rad.
    span: f64,
    /// Angle at the start, rad, in `[0, 2 pi)`.
    cam_angle: f64,
    /// State at the start of the flight that hits the corner.
    start: State,
    /// Matrix that carries a deviation from the end back to the corner's moment.
    back: Matrix2<f64>,
    omega: f64,
}

/// Result of a run.
#[derive(Clone, Copy, Debug)]
struct Run {
    end: Vector2<f64>,
    impacts: usize,
    /// Angle of the first impact past the corner, rad; NaN without an impact.
    past_corner: f64,
}

impl Passage {
    /// Longest passage that `free` accepts, at most half a turn.
    fn longest(follower: &Follower, approach: &Approach, free: impl Fn(&Self) -> bool) -> Result<Self, JumpOrderError> {
        let mut span = PI;
        for _ in 0..HALVINGS {
            match Self::new(follower, approach, span).filter(&free) {
                Some(passage) => return Ok(passage),
                None => span *= 0.5,
            }
        }
        Err(JumpOrderError::NotFree { cam_angle: approach.corner.angle, least: 2.0 * span })
    }

    fn new(follower: &Follower, approach: &Approach, span: f64) -> Option<Self> {
        let omega = approach.angular_velocity;
        let flight = Flight::new(follower);
        let propagator = flight.propagator(span / omega);
        let back = propagator.try_inverse()?;
        // A flight is affine: its miss at the corner, carried back, is the error of its start.
        let corner = State { position: approach.corner.minus.value, velocity: approach.velocity_before };
        let miss = flight.fly(corner, span / omega).1;
        let off = back * Vector2::new(corner.position - miss.position, corner.velocity - miss.velocity);
        let start = State { position: corner.position + off[0], velocity: corner.velocity + off[1] };
        let turned = (approach.corner.angle - span).rem_euclid(TAU);
        let cam_angle = if turned < TAU { turned } else { 0.0 };
        Some(Self { span, cam_angle, start, back, omega })
    }

    /// Flies from a deviation `z` of position (m), velocity (m/s) and period (s); `None` if the run fails, sticks, or has an impact further
    /// from the corner than `reach`, rad.
    fn run(&self, machine: &Machine, z: Vector3<f64>, reach: f64) -> Option<Run> {
        let state = State { position: self.start.position + z[0], velocity: self.start.velocity + z[1] };
        let machine = machine.at_speed(TAU / (TAU / self.omega + z[2]));
        let (mut impacts, mut past_corner, mut good) = (0, f64::NAN, true);
        let end = machine.turn(self.cam_angle, state, 2.0 * self.span, |event: &Event| {
            let past = event.turned_since(self.cam_angle) - self.span;
            good &= event.kind == EventKind::Impact && past.abs() < reach;
            past_corner = if impacts == 0 { past } else { past_corner };
            impacts += 1;
            if good { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        let end = end.ok().filter(|_| good)?;
        Some(Run { end: Vector2::new(end.position, end.velocity), impacts, past_corner })
    }

    /// Deviation at the start of a flight that is `distance`, m, above the corner at its moment.
    fn shifted(&self, distance: f64) -> Vector3<f64> {
        let z = self.back.column(0) * distance;
        Vector3::new(z[0], z[1], 0.0)
    }

    /// Rounding error of a difference of two ends at the corner's moment: a few ulps of the state.
    fn rounding(&self, approach: &Approach) -> Vector2<f64> {
        let position = self.start.position.abs().max(approach.corner.minus.value.abs());
        let velocity = self.start.velocity.abs().max(approach.velocity_before.abs());
        self.back.abs() * Vector2::new(position, velocity) * (2.0 * tolerance::RUN_ROUNDING.value)
    }
}

/// Deviations of position (m), velocity (m/s) and period (s) that move the impact by comparable times.
fn scales(approach: &Approach, span: f64, reach: f64) -> Vector3<f64> {
    let (closing, omega) = (approach.closing_velocity(), approach.angular_velocity);
    let time = reach / omega;
    Vector3::new(closing * time, closing * reach / span, time * closing / (closing + approach.velocity_before.abs()))
}

/// Flights over the cam with one side's law continued past the corner, for both sides.
pub struct SideFlights<'a> {
    approach: &'a Approach,
    machines: [Machine; 2],
    reach: f64,
    passage: Passage,
}

/// One flight, run under both laws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightPair {
    /// Time from the corner to the impact under the law before it, s.
    pub offset: f64,
    /// End under the law after the corner less the end under the law before it, m and m/s.
    pub difference: Vector2<f64>,
}

impl<'a> SideFlights<'a> {
    /// Largest continuation, rad; less if the neighbouring segments are too short.
    const REACH: f64 = 0.1;

    /// Prepares both sides of the map of flights near `approach`, over the largest span without other events.
    pub fn new(model: &Model, cam: &Cam, approach: &'a Approach) -> Result<Self, JumpOrderError> {
        let (mut reach, least) = (Self::REACH, tolerance::LEAST_REACH.value);
        let continued = |reach: f64, side: Side| {
            let cam = cam.continued(&approach.corner, side, reach)?;
            Some(Machine::new(cam, &model.follower, approach.angular_velocity))
        };
        let machines = loop {
            if let (Some(minus), Some(plus)) = (continued(reach, Side::Minus), continued(reach, Side::Plus)) {
                break [minus, plus];
            }
            reach *= 0.5;
            if reach < least {
                let cam_angle = approach.corner.angle;
                return Err(SampleError::NotContinued { side: Side::Minus, cam_angle, least }.into());
            }
        };
        let once = |run: Option<Run>| run.is_some_and(|run| run.impacts == 1);
        let free =
            |passage: &Passage| machines.iter().all(|machine| once(passage.run(machine, Vector3::zeros(), reach)));
        let passage = Passage::longest(&model.follower, approach, free)?;
        Ok(Self { approach, machines, reach, passage })
    }

    /// Angle flown before the corner, and after it, rad.
    pub fn span(&self) -> f64 {
        self.passage.span
    }

    /// Deviations of position (m), velocity (m/s) and period (s) that move the impact by comparable times.
    pub fn scales(&self) -> Vector3<f64> {
        scales(self.approach, self.passage.span, self.reach)
    }

    /// Runs the flight that deviates by `z`: m, m/s and s.
    pub fn pair(&self, z: Vector3<f64>) -> Option<FlightPair> {
        let [minus, plus] = self.machines.each_ref().map(|machine| self.passage.run(machine, z, self.reach));
        let (minus, plus) = minus.zip(plus).filter(|(minus, plus)| minus.impacts == 1 && plus.impacts == 1)?;
        let omega = TAU / (TAU / self.passage.omega + z[2]);
        Some(FlightPair { offset: minus.past_corner / omega, difference: plus.end - minus.end })
    }

    fn pair_or_error(&self, z: Vector3<f64>) -> Result<FlightPair, JumpOrderError> {
        let least = self.passage.span;
        self.pair(z).ok_or(JumpOrderError::NotFree { cam_angle: self.approach.corner.angle, least })
    }

    /// Half of the longest of `z`, `z/2`, ... whose flights in both directions hit the cam once under either law. Near the limit, the
    /// powers that the fit leaves out are largest.
    fn widest(&self, z: Vector3<f64>) -> Result<Vector3<f64>, JumpOrderError> {
        let halved = (0..HALVINGS).map(|halving| z / f64::from(1_u32 << halving));
        let mut good = halved.filter(|z| self.pair(*z).is_some() && self.pair(-*z).is_some());
        let least = self.passage.span;
        good.nth(1).ok_or(JumpOrderError::NotFree { cam_angle: self.approach.corner.angle, least })
    }

    /// Laws of position and velocity at the corner's moment against the time of the impact. The flights would then be above or below the
    /// corner, with the velocity of the one that hits it.
    pub fn at_corner(&self) -> Result<[MeasuredLaw; 2], JumpOrderError> {
        let z = self.widest(self.passage.shifted(scales(self.approach, self.passage.span, self.reach)[0]))?;
        let sample = |part: f64| {
            let FlightPair { offset, difference } = self.pair_or_error(z * part)?;
            Ok((offset, self.passage.back * difference))
        };
        laws(sample, self.passage.rounding(self.approach))
    }

    /// Laws of position and velocity at the end against the part of the deviation `z` (m, m/s, s) at the start.
    pub fn along(&self, z: Vector3<f64>) -> Result<[MeasuredLaw; 2], JumpOrderError> {
        let widest = self.widest(z)?;
        let unit = widest.norm() / z.norm();
        let sample = |part: f64| Ok((part * unit, self.pair_or_error(widest * part)?.difference));
        let forth = self.passage.back.try_inverse().unwrap_or_else(Matrix2::identity);
        laws(sample, forth.abs() * self.passage.rounding(self.approach))
    }
}

/// Gap, measured over the actual cam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Gap in position and velocity at the corner's moment, m and m/s, in the limit of flights on either side of the corner.
    pub limit: [Estimate; 2],
    /// Exponent of the gap in velocity.
    pub exponent: Estimate,
    /// Numbers of impacts near the corner of flights that reach the cam before it, and after it.
    pub impacts: [usize; 2],
}

/// Measures the gap between flights that reach the cam after the corner and before it, over the actual cam.
pub fn gap(model: &Model, cam: &Cam, approach: &Approach) -> Result<Gap, JumpOrderError> {
    /// Largest distance of an impact from the corner, rad. A second impact follows the first by times that shrink with the distance.
    const NEAR: f64 = 0.1;
    let machine = Machine::new(cam.clone(), &model.follower, approach.angular_velocity);
    let scale = |passage: &Passage| scales(approach, passage.span, NEAR)[0];
    let both = |passage: &Passage, distance: f64| {
        let run = |distance: f64| passage.run(&machine, passage.shifted(distance), NEAR);
        Some([run(-distance)?, run(distance)?])
    };
    let counts = |runs: [Run; 2]| runs.map(|run| run.impacts);
    let smallest = |passage: &Passage| both(passage, scale(passage) / f64::from(1_u32 << (2 * HALVINGS)));
    let passage = Passage::longest(&model.follower, approach, |passage| smallest(passage).is_some())?;
    let least = passage.span;
    let not_free = || JumpOrderError::NotFree { cam_angle: approach.corner.angle, least };
    let impacts = smallest(&passage).map(counts).ok_or_else(not_free)?;
    let halved = (0..HALVINGS).map(|halving| scale(&passage) / f64::from(1_u32 << halving));
    let alike = |distance: &f64| both(&passage, *distance).map(counts) == Some(impacts);
    let widest = halved.filter(alike).nth(1).ok_or_else(not_free)?;
    let sample = |part: f64| {
        let [before, after] = both(&passage, widest * part).ok_or_else(not_free)?;
        Ok((part, passage.back * (after.end - before.end)))
    };
    let rounding = passage.rounding(approach);
    let ladder = ladder(&sample, Powers::Every)?;
    let exponent = exponent(&ladder, 1, rounding[1])?;
    let difference = |part: f64| sample(part).map(|(_, difference)| difference);
    let (value, error) = extrapolate(1.0, Powers::Every, |_| rounding, difference)?;
    let limit = [0, 1].map(|component| Estimate::extrapolated(value[component], error[component]));
    Ok(Gap { limit, exponent, impacts })
}

type Sample = (f64, Vector2<f64>);

/// Laws of both components of `sample(part)`, which gives a distance and a difference, for parts of either sign from 1 down to 0.
fn laws(
    sample: impl Fn(f64) -> Result<Sample, JumpOrderError>,
    rounding: Vector2<f64>,
) -> Result<[MeasuredLaw; 2], JumpOrderError> {
    let ladder = ladder(&sample, Powers::Even)?;
    let exponents = [exponent(&ladder, 0, rounding[0])?, exponent(&ladder, 1, rounding[1])?];
    let whole = exponents.map(|exponent| exponent.value.round() as i32);
    let unit = ladder.iter().fold(0.0_f64, |unit, (distance, _)| unit.max(distance.abs()));
    let quotient = |part: f64| -> Result<Vector2<f64>, JumpOrderError> {
        let (distance, difference) = sample(part)?;
        Ok(Vector2::from_fn(|component, _| difference[component] / distance.powi(whole[component])))
    };
    let mean = |part: f64| -> Result<_, JumpOrderError> { Ok((quotient(part)? + quotient(-part)?) * 0.5) };
    let noise = |part: f64| Vector2::from_fn(|component, _| rounding[component] / (part * unit).powi(whole[component]));
    let (value, error) = extrapolate(1.0, Powers::Even, noise, mean)?;
    Ok([0, 1].map(|component| MeasuredLaw {
        exponent: exponents[component],
        coefficient: Estimate::extrapolated(value[component], error[component]),
    }))
}

/// Samples at parts 1, 2^(-1/4), ... and, for even powers, at their opposites.
fn ladder(
    sample: &impl Fn(f64) -> Result<Sample, JumpOrderError>,
    powers: Powers,
) -> Result<Vec<Sample>, JumpOrderError> {
    let parts = (0..RUNGS).map(|rung| elementary::exp2(-0.25 * f64::from(rung)));
    let signs: &[f64] = if powers == Powers::Even { &[1.0, -1.0] } else { &[1.0] };
    parts.flat_map(|part| signs.iter().map(move |sign| sample(sign * part))).collect()
}

/// Slope of `log |difference|` against `log |distance|`, with powers of the distance for terms after the leading one.
///
/// A difference `K x^p (1 + k1 x + ...)` has the logarithm `log K + p log |x| + k1 x + ...`: the fit is linear.
fn exponent(ladder: &[Sample], component: usize, rounding: f64) -> Result<Estimate, JumpOrderError> {
    let columns = 2 + CORRECTIONS;
    let unit = ladder.iter().fold(0.0_f64, |unit, (distance, _)| unit.max(distance.abs()));
    let resolved: Vec<(f64, f64)> = ladder
        .iter()
        .map(|(distance, difference)| (distance / unit, difference[component].abs()))
        .filter(|(_, size)| rounding <= tolerance::JUMP_RESOLVED.value * size)
        .collect();
    let needed = 2 * columns;
    if resolved.len() < needed {
        return Err(JumpOrderError::Unresolved { resolved: resolved.len(), tried: ladder.len(), needed });
    }
    let design = Mat::from_fn(resolved.len(), columns, |row, column| match (resolved[row].0, column) {
        (_, 0) => 1.0,
        (distance, 1) => elementary::ln(distance.abs()),
        (distance, column) => distance.powi(column as i32 - 1),
    });
    let response = Mat::from_fn(resolved.len(), 1, |row, _| elementary::ln(resolved[row].1));
    let fit = Solver::new(&design)?.fit(&response);
    let (value, error) = (fit.coefficients[(1, 0)], fit.standard_errors[(1, 0)]);
    Ok(Estimate { value, error, error_is: ErrorIs::Standard })
}
