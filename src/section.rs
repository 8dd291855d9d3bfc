//! The stroboscopic map: the follower's state each time the cam passes one angle.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use crate::flight::State;
use crate::simulate::{Impact, Machine, SimulateError};

/// The map of one revolution, from the section at a cam angle back to it.
#[derive(Clone, Debug)]
pub struct StroboscopicMap {
    /// What turns.
    pub machine: Machine,
    /// The section, rad, in `[0, 2 pi)`.
    pub cam_angle: f64,
}

/// What one revolution did.
#[derive(Clone, Debug, PartialEq)]
pub struct Return {
    /// The state on the section, one revolution later.
    pub state: State,
    /// The impacts on the way, in order.
    pub impacts: Vec<Impact>,
}

impl StroboscopicMap {
    /// One revolution from `state`.
    pub fn apply(&self, state: State) -> Result<Return, SimulateError> {
        let mut impacts = Vec::new();
        let state = self.machine.turn(self.cam_angle, state, TAU, |impact| {
            impacts.push(*impact);
            ControlFlow::Continue(())
        })?;
        Ok(Return { state, impacts })
    }
}
