//! Samples of one simulated period over a cam with one law continued past the corner, for the estimators.
//!
//! The cam's law on one side is continued past the corner, as in the paper. This makes the map of that side smooth through the corner. A
//! period counts only if its impacts match the orbit's one by one and the corner's impact is on the continued part. Any other period is an
//! error, never a sample.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use nalgebra::{Vector2, Vector3};

use super::corner_impact::CornerImpact;
use super::varied::{NoChange, Varied, value_of};
use crate::cam::{Cam, Corner, Side};
use crate::flight::State;
use crate::model::Model;
use crate::orbit::{Family, Parameter};
use crate::simulate::{Event, EventKind, Goal, Machine, SimulateError};
use crate::tolerance;

/// Reason why a side of the map could not be sampled.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the message says what each number is")]
pub enum SampleError {
    /// Corner whose neighbouring segment is too short, or whose law ends too soon.
    #[error("the {side:?} law cannot be continued past the corner at {cam_angle} rad by {least} rad")]
    NotContinued { side: Side, cam_angle: f64, least: f64 },
    /// Period perturbed in position (m), velocity (m/s), and period (s) or number, whose impacts do not match the orbit's.
    #[error(
        "{side:?} side: a period perturbed by {perturbation:?} has {impacts} impacts near the corner or elsewhere{} instead of {}",
        if *sticks { ", and sticks to the cam," } else { "" },
        if *expected == 1 { "one near it".to_owned() } else { format!("the orbit's {expected}, one near it") }
    )]
    OtherImpacts { side: Side, perturbation: [f64; 3], impacts: usize, expected: usize, sticks: bool },
    /// Failure of the simulator.
    #[error("{side:?} side: {error}")]
    Simulate { side: Side, error: SimulateError },
    /// Number that cannot be varied.
    #[error("{side:?} side: {error}")]
    Varied { side: Side, error: NoChange },
    /// Linear system that does not determine its unknowns.
    #[error("the samples do not determine the {what}")]
    Singular { what: &'static str },
}

/// Smooth map of one side: from a deviation of the state and of the period, or of another number, to the deviation of the state one period
/// of the orbit later.
pub struct OneSidedMap<'a> {
    model: &'a Model,
    at: &'a CornerImpact,
    side: Side,
    cam: Cam,
    /// Cam without continuation.
    whole: Cam,
    reach: f64,
    varied: Turned,
    /// Factor that reduces unit perturbations.
    shrunk: f64,
    stretch: SampledArc,
}

/// Part of the orbit from one section to another.
#[derive(Clone, Debug)]
struct SampledArc {
    /// First section, rad, and the follower's state there.
    section: f64,
    start: State,
    /// Angle of each flight, rad, and the impact at its end.
    flights: Vec<(f64, usize)>,
    goal: Goal,
    end: State,
    /// Relative velocity `c' - v-` and velocity `v-` of the impact that sets the scales of the perturbations, m/s.
    approach: f64,
    velocity_before: f64,
}

impl SampledArc {
    fn whole(at: &CornerImpact) -> Self {
        let section = at.section_angle();
        Self {
            section,
            start: at.state,
            flights: at.course().0,
            goal: Goal { revolution: at.cycle.revolutions, cam_angle: section },
            end: at.state,
            approach: at.cam_velocity - at.velocity_before,
            velocity_before: at.velocity_before,
        }
    }

    /// One part for each impact, from the middle of the flight before it to the middle of the flight after.
    fn pieces(at: &CornerImpact, machine: &Machine) -> Vec<Self> {
        let flights = at.course().0;
        let count = flights.len();
        // Middle of the flight to each impact: its angle, the follower's state, and the angle from there to either impact.
        let middle = |index: usize| {
            if index.is_multiple_of(count) {
                return (at.section_angle(), at.state, flights[0].0);
            }
            let ((turn, _), (_, before)) = (flights[index], flights[index - 1]);
            let angle = (at.cycle.impacts[before].cam_angle + 0.5 * turn).rem_euclid(TAU) % TAU;
            let leaving = at.cycle.flight(machine, before).0;
            (angle, machine.flight().fly(leaving, 0.5 * turn / TAU * at.period).1, 0.5 * turn)
        };
        let piece = |index: usize| {
            let ((section, start, to), (cam_angle, end, from)) = (middle(index), middle(index + 1));
            let impact = flights[index].1;
            let revolution = ((section + to + from - cam_angle) / TAU).round() as u64;
            let goal = Goal { revolution, cam_angle };
            let velocity_before = at.cycle.impacts[impact].velocity_before;
            let approach = at.cycle.approach(machine, impact);
            Self { section, start, flights: vec![(to, impact)], goal, end, approach, velocity_before }
        };
        (0..count).map(piece).collect()
    }
}

/// Effect of the third perturbation on the machine.
enum Turned {
    /// Another period of the same cam.
    Slower,
    /// Machine built with another number.
    Remade { family: Box<Family>, value: f64 },
}

/// Sampled period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeriodSample {
    /// Deviation of position (m), velocity (m/s), and period (s) or number at the start.
    pub perturbation: Vector3<f64>,
    /// Deviation from the orbit at the end: m, m/s.
    pub end: Vector2<f64>,
    /// Cam angle of the impact past the corner, rad; 0 on a part without this impact.
    pub past_corner: f64,
}

impl<'a> OneSidedMap<'a> {
    /// Largest continuation, rad: a few degrees, well inside any segment of a cam.
    const REACH: f64 = 0.05;
    /// Unit perturbation relative to the reach: the impact moves by at most about 2 pi per unit, so it stays well inside.
    const PERTURBATION: f64 = 0.02;
    /// Number of halvings of the perturbations that are tried if successive impacts amplify them too much.
    const HALVINGS: u32 = 16;

    /// Builds the map of `side` by state and period, with its law continued as far as the neighbouring segment allows.
    pub fn new(model: &'a Model, cam: &Cam, at: &'a CornerImpact, side: Side) -> Result<Self, SampleError> {
        Self::by(model, cam, at, side, &Varied::Period)
    }

    /// Builds the map of `side` by state and any number.
    pub fn by(
        model: &'a Model,
        whole: &Cam,
        at: &'a CornerImpact,
        side: Side,
        varied: &Varied,
    ) -> Result<Self, SampleError> {
        Self::over(model, whole, at, side, varied, SampledArc::whole(at))
    }

    /// Builds the maps from the middle of each flight to the middle of the next, whose product is the map of a period. Successive impacts
    /// amplify rounding together with every deviation; a single impact does not.
    pub fn pieces(
        model: &'a Model,
        whole: &Cam,
        at: &'a CornerImpact,
        side: Side,
        varied: &Varied,
    ) -> Result<Vec<Self>, SampleError> {
        let machine = Machine::new(whole.clone(), &model.follower, at.angular_velocity());
        let stretches = SampledArc::pieces(at, &machine).into_iter();
        stretches.map(|stretch| Self::over(model, whole, at, side, varied, stretch)).collect()
    }

    fn over(
        model: &'a Model,
        whole: &Cam,
        at: &'a CornerImpact,
        side: Side,
        varied: &Varied,
        stretch: SampledArc,
    ) -> Result<Self, SampleError> {
        let varied = match varied {
            Varied::Period => Turned::Slower,
            Varied::Number(name) => {
                let number = || {
                    let value = value_of(model, name)?;
                    let free = vec![Parameter::Field(name.clone())];
                    Ok(Turned::Remade { family: Box::new(Family::new(model, at.speed_rpm(), free)?), value })
                };
                number().map_err(|error| SampleError::Varied { side, error })?
            }
        };
        let mut reach = Self::REACH;
        let cam = loop {
            let clear = at.cycle.nearest_other(at.impact) >= 2.0 * reach;
            if let Some(continued) = whole.continued(&at.corner, side, reach).filter(|_| clear) {
                break continued;
            }
            reach *= 0.5;
            let least = tolerance::LEAST_REACH.value;
            if reach < least {
                return Err(SampleError::NotContinued { side, cam_angle: at.corner.angle, least });
            }
        };
        let mut map = Self { model, at, side, cam, whole: whole.clone(), reach, varied, shrunk: 1.0, stretch };
        map.shrink()?;
        Ok(map)
    }

    /// Halves the perturbations until a unit in each direction keeps the orbit's impacts.
    fn shrink(&mut self) -> Result<(), SampleError> {
        let mut first = None;
        for _ in 0..=Self::HALVINGS {
            let units = (0..6).map(|index| {
                let mut unit = Vector3::zeros();
                unit[index / 2] = if index % 2 == 0 { 1.0 } else { -1.0 };
                unit.component_mul(&self.scales())
            });
            match units.map(|unit| self.sample(unit)).find_map(Result::err) {
                None => return Ok(()),
                Some(error) => first = first.or(Some(error)),
            }
            self.shrunk *= 0.5;
        }
        first.map_or(Ok(()), Err)
    }

    /// Perturbations of position, velocity and period or number that move the impact by comparable parts of the reach.
    ///
    /// They are the impact's own scales: its relative velocity u, the length u/omega, and the period, reduced if the follower is faster
    /// than u. For another number, a part of its value.
    pub fn scales(&self) -> Vector3<f64> {
        let (approach, period) = (self.stretch.approach, self.at.period);
        let third = match &self.varied {
            Turned::Slower => period * approach / (approach + self.stretch.velocity_before.abs()),
            Turned::Remade { value, .. } => {
                // A number at 0 starts with one of its units; `shrink` halves it if that is too much.
                if *value == 0.0 { 1.0 / (Self::PERTURBATION * self.reach) } else { value.abs() }
            }
        };
        Vector3::new(approach * period / TAU, approach, third) * (Self::PERTURBATION * self.reach * self.shrunk)
    }

    /// Distance of the follower from the cam when the corner passed, to first order. It shrinks by `c' - v-` per unit of the time from the
    /// corner to the impact.
    pub fn gap(&self, sample: &PeriodSample) -> f64 {
        sample.past_corner * self.per_angle()
    }

    /// Decrease of the gap per radian of cam angle, m.
    fn per_angle(&self) -> f64 {
        (self.at.cam_velocity - self.at.velocity_before) / self.at.angular_velocity()
    }

    /// Rounding error of the gap, m: from a position, and from the angle of a full turn.
    pub fn gap_rounding(&self) -> f64 {
        self.rounding()[0] + tolerance::RUN_ROUNDING.value * TAU * self.per_angle()
    }

    /// Rounding error of the end of a part: a few ulps of the largest position and velocity in it.
    pub fn rounding(&self) -> Vector2<f64> {
        let CornerImpact { state, velocity_before, velocity_after, .. } = *self.at;
        let position = state.position.abs().max(self.at.corner.plus.value.abs());
        let velocity = state.velocity.abs().max(velocity_before.abs()).max(velocity_after.abs());
        Vector2::new(position, velocity) * tolerance::RUN_ROUNDING.value
    }

    /// Returns the machine of a third perturbation, with the law continued; its cam without continuation; the corner on that cam, rad; and
    /// the perturbation as rounded to doubles.
    fn machine(&self, perturbation: f64) -> Result<(Machine, Cam, f64, f64), SampleError> {
        let CornerImpact { period, corner, .. } = *self.at;
        match &self.varied {
            Turned::Slower => {
                let (omega, perturbed) = (TAU / period, TAU / (period + perturbation));
                let machine = Machine::new(self.cam.clone(), &self.model.follower, perturbed);
                // dT = 2 pi/w - 2 pi/w* = T* (w* - w)/w
                Ok((machine, self.whole.clone(), corner.angle, period * ((omega - perturbed) / perturbed)))
            }
            Turned::Remade { family, value } => {
                let side = self.side;
                let moved = value + perturbation;
                let remade = family
                    .machine_of_cycles(&[moved])
                    .map_err(|error| SampleError::Varied { side, error: error.into() })?;
                let cam = remade.0.cam().clone();
                let angle = cam.segments().get(corner.segment).map_or(f64::NAN, |segment| segment.start);
                let there = Corner { angle, ..corner };
                let Some(continued) = cam.continued(&there, side, self.reach) else {
                    return Err(SampleError::NotContinued { side, cam_angle: angle, least: self.reach });
                };
                let machine = remade.0.with_cam(continued);
                Ok((machine, cam, angle, moved - value))
            }
        }
    }

    /// Simulates one period from about `x* + (dx1, dx2)` at a period of about `T* + dT`, or with another number. The sample records the
    /// exact start.
    pub fn sample(&self, perturbation: Vector3<f64>) -> Result<PeriodSample, SampleError> {
        let SampledArc { section, start, goal, end, .. } = self.stretch;
        let state = State { position: start.position + perturbation[0], velocity: start.velocity + perturbation[1] };
        let (machine, whole, corner, third) = self.machine(perturbation[2])?;
        // A perturbation of a ten-thousandth keeps twelve digits when it is added to x* and T*. The rounded perturbation is known exactly,
        // because differences of close numbers are exact.
        let exact = Vector3::new(state.position - start.position, state.velocity - start.velocity, third);
        let failed = |error| SampleError::Simulate { side: self.side, error };
        let mut motion = machine.start(section, state).map_err(failed)?;
        let (mut events, expected) = (Vec::new(), self.stretch.flights.len());
        let _ = machine
            .advance(&mut motion, goal, &mut |event: &Event| {
                events.push(*event);
                if events.len() > expected { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            })
            .map_err(failed)?;
        let moved_corner = corner - self.at.corner.angle;
        match self.past_corner(&whole, section, &events).map(|past| past - moved_corner) {
            Some(past_corner) if past_corner.abs() < self.reach => Ok(PeriodSample {
                perturbation: exact,
                end: Vector2::new(motion.state.position - end.position, motion.state.velocity - end.velocity),
                past_corner,
            }),
            _ => {
                let impacts = events.iter().filter(|event| event.kind == EventKind::Impact).count();
                let sticks = events.iter().any(|event| event.kind == EventKind::Stick);
                let (side, perturbation) = (self.side, exact.into());
                Err(SampleError::OtherImpacts { side, perturbation, impacts, expected, sticks })
            }
        }
    }

    /// Angle from the corner's original position to the corner's impact, rad; 0 if that impact is not among the events. `None` unless the
    /// events are the orbit's impacts, each on its own segment.
    #[doc(hidden)]
    pub fn past_corner(&self, whole: &Cam, section: f64, events: &[Event]) -> Option<f64> {
        let flights = &self.stretch.flights;
        if events.len() != flights.len() || events.iter().any(|event| event.kind != EventKind::Impact) {
            return None;
        }
        let (mut turned, mut past_corner) = (0.0, 0.0);
        for (event, (turn, index)) in events.iter().zip(flights) {
            turned += turn;
            let later = event.turned_since(section) - turned;
            if *index == self.at.impact {
                past_corner = later;
                continue;
            }
            let impact = &self.at.cycle.impacts[*index];
            let segment = &whole.segments()[impact.segment];
            let angle = impact.cam_angle + later;
            if !(segment.start <= angle && angle <= segment.end) {
                return None;
            }
        }
        Some(past_corner)
    }
}
