//! The variational flow: propagation of a small deviation of the follower's state along a motion.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use nalgebra::Matrix2;

use super::{Event, EventKind, Machine, Motion, Observer};
use crate::flight::{Flight, State};
use crate::impact::ImpactRates;

/// [`Observer`] that multiplies propagators of flights and saltation matrices of impacts.
///
/// Sticking erases the deviation: a sticking follower's state depends on the cam alone, so the matrix is 0.
#[derive(Clone, Copy, Debug)]
#[doc(hidden)]
pub struct Variation<'a> {
    machine: &'a Machine,
    matrix: Matrix2<f64>,
    /// Time flown since `matrix` was set, s; a flight over several segments counts as one.
    flown: f64,
}

impl<'a> Variation<'a> {
    /// Starts with the identity at the start of `motion`, or with 0 if the follower sticks to the cam.
    pub fn new(machine: &'a Machine, motion: &Motion) -> Self {
        let matrix = if motion.contact { Matrix2::zeros() } else { Matrix2::identity() };
        Self { machine, matrix, flown: 0.0 }
    }

    /// `d(q, v)/d(q0, v0)` since the start, or since [`Variation::reset`]; 2x2.
    pub fn matrix(&self) -> Matrix2<f64> {
        if self.flown == 0.0 { self.matrix } else { self.machine.flight().propagator(self.flown) * self.matrix }
    }

    /// Restarts from `matrix`.
    pub fn reset(&mut self, matrix: Matrix2<f64>) {
        (self.matrix, self.flown) = (matrix, 0.0);
    }
}

impl Observer for Variation<'_> {
    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        match event.kind {
            EventKind::Impact => {
                self.reset(self.matrix());
                let segment = &self.machine.cam().segments()[event.segment];
                let angle = if event.cam_angle < segment.start { event.cam_angle + TAU } else { event.cam_angle };
                let omega = self.machine.angular_velocity();
                let acceleration =
                    |velocity: f64| self.machine.flight().acceleration(State { position: event.position, velocity });
                let rates = ImpactRates {
                    restitution: self.machine.restitution(),
                    velocity_before: event.velocity_before,
                    acceleration_before: acceleration(event.velocity_before),
                    acceleration_after: acceleration(event.velocity_after),
                    cam_velocity: event.cam_velocity,
                    cam_acceleration: omega * omega * segment.law.lift(angle).curvature,
                };
                self.matrix = rates.saltation() * self.matrix;
            }
            EventKind::Stick => self.reset(Matrix2::zeros()),
            EventKind::Release => {}
        }
        ControlFlow::Continue(())
    }

    fn flight(&mut self, _flight: &Flight, _from: State, time: f64) {
        self.flown += time;
    }
}
