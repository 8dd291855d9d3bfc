//! One revolution of the simulator over a cam with one segment continued past the corner: what the estimators sample.
//!
//! As in the paper, the map of a side is smooth through the corner once the cam's law on that side is continued past it.
//! A revolution counts only if its one impact falls on the continued stretch; any other is an error, never a sample.

use std::f64::consts::{PI, TAU};

use nalgebra::{Vector2, Vector3};

use super::locate::CornerImpact;
use crate::cam::{Cam, Side};
use crate::flight::State;
use crate::model::Model;
use crate::simulate::{Event, EventKind, SimulateError};

/// Why a side of the map could not be sampled.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SampleError {
    /// The neighbour of the corner is too short, or the law ends too soon.
    #[error("the {side:?} law cannot be continued past the corner at {cam_angle} rad by {least} rad")]
    NotContinued {
        /// Which side's law.
        side: Side,
        /// The corner, rad.
        cam_angle: f64,
        /// The shortest continuation tried, rad.
        least: f64,
    },
    /// A perturbed revolution did something else than hit the cam once near the corner.
    #[error(
        "{side:?} side: a revolution perturbed by {perturbation:?} has {impacts} impacts near the corner or elsewhere{} instead of one near it",
        if *sticks { ", and sticks to the cam," } else { "" }
    )]
    NotOneImpact {
        /// Which side's law.
        side: Side,
        /// Change of position (m), velocity (m/s) and period (s).
        perturbation: [f64; 3],
        /// Impacts counted.
        impacts: usize,
        /// Whether the follower stays on the cam for a while.
        sticks: bool,
    },
    /// The simulator gave up.
    #[error("{side:?} side: {error}")]
    Simulate {
        /// Which side's law.
        side: Side,
        /// Why.
        error: SimulateError,
    },
    /// A linear system that does not determine its unknowns.
    #[error("the samples do not determine the {what}")]
    Singular {
        /// Which unknowns.
        what: &'static str,
    },
}

/// The smooth map of one side: deviation of state and period in, deviation of the state one revolution later out.
pub struct OneSidedMap<'a> {
    model: &'a Model,
    at: &'a CornerImpact,
    side: Side,
    cam: Cam,
    reach: f64,
}

/// A sampled revolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Deviation of position (m), velocity (m/s) and period (s) that the revolution started with.
    pub perturbation: Vector3<f64>,
    /// Deviation from x* after the revolution: m, m/s.
    pub end: Vector2<f64>,
    /// Cam angle of the impact past the corner, rad.
    pub past_corner: f64,
}

impl<'a> OneSidedMap<'a> {
    /// Furthest continuation, rad: a few degrees, well inside any segment that a cam is made of.
    const REACH: f64 = 0.05;
    /// Shortest continuation, rad: perturbations below it would be lost in rounding.
    const LEAST_REACH: f64 = 5e-4;
    /// A unit perturbation over the reach: the impact moves by at most about 2 pi per unit, and stays inside with room.
    const PERTURBATION: f64 = 0.02;

    /// The map of `side`, with its law continued as far as the neighbouring segment allows.
    pub fn new(model: &'a Model, cam: &Cam, at: &'a CornerImpact, side: Side) -> Result<Self, SampleError> {
        let mut reach = Self::REACH;
        loop {
            if let Some(cam) = cam.continued(&at.corner, side, reach) {
                return Ok(Self { model, at, side, cam, reach });
            }
            reach *= 0.5;
            if reach < Self::LEAST_REACH {
                return Err(SampleError::NotContinued { side, cam_angle: at.corner.angle, least: Self::LEAST_REACH });
            }
        }
    }

    /// Perturbations of position, velocity and period that move the impact by comparable parts of the reach.
    ///
    /// The impact's own scales: its relative velocity u, the length u/omega, and the period, less where the follower is faster
    /// than u.
    pub fn scales(&self) -> Vector3<f64> {
        let approach = self.at.cam_velocity - self.at.velocity_before;
        let period = self.at.period;
        let time = period * approach / (approach + self.at.velocity_before.abs());
        Vector3::new(approach * period / TAU, approach, time) * (Self::PERTURBATION * self.reach)
    }

    /// How far rounding may move the end of a revolution: a few ulps of the largest position and velocity on the way.
    pub fn rounding(&self) -> Vector2<f64> {
        let CornerImpact { state, velocity_before, velocity_after, .. } = *self.at;
        let position = state.position.abs().max(self.at.corner.plus.value);
        let velocity = state.velocity.abs().max(velocity_before.abs()).max(velocity_after.abs());
        Vector2::new(position, velocity) * (4.0 * f64::EPSILON)
    }

    /// One revolution from about `x* + (dx1, dx2)` at a period of about `T* + dT`; the sample says from where exactly.
    pub fn sample(&self, perturbation: Vector3<f64>) -> Result<Sample, SampleError> {
        let CornerImpact { state: start, period, .. } = *self.at;
        let state = State { position: start.position + perturbation[0], velocity: start.velocity + perturbation[1] };
        let (omega, perturbed) = (TAU / period, TAU / (period + perturbation[2]));
        // A perturbation of a ten-thousandth keeps twelve digits when it is added to x* and T*. What is left of it is known
        // exactly, the differences of close numbers being exact: dT = 2 pi/w - 2 pi/w* = T* (w* - w)/w.
        let exact = Vector3::new(
            state.position - start.position,
            state.velocity - start.velocity,
            period * ((omega - perturbed) / perturbed),
        );
        let map = self.at.map(self.model, self.cam.clone(), perturbed);
        let back = map.apply(state).map_err(|error| SampleError::Simulate { side: self.side, error })?;
        let past_corner = |event: &Event| event.turned_since(map.cam_angle) - PI;
        match back.events.as_slice() {
            [impact] if impact.kind == EventKind::Impact && past_corner(impact).abs() < self.reach => Ok(Sample {
                perturbation: exact,
                end: Vector2::new(back.state.position - start.position, back.state.velocity - start.velocity),
                past_corner: past_corner(impact),
            }),
            events => {
                let impacts = back.impacts().count();
                let sticks = events.iter().any(|event| event.kind == EventKind::Stick);
                Err(SampleError::NotOneImpact { side: self.side, perturbation: exact.into(), impacts, sticks })
            }
        }
    }
}
