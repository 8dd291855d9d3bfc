//! The stroboscopic map: the follower's state each time the cam passes one angle.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use crate::flight::State;
use crate::simulate::{Event, EventKind, Machine, SimulateError};

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
    /// The events on the way, in order.
    pub events: Vec<Event>,
}

impl Return {
    /// The impacts among the events.
    pub fn impacts(&self) -> impl Iterator<Item = &Event> {
        self.events.iter().filter(|event| event.kind == EventKind::Impact)
    }
}

impl StroboscopicMap {
    /// One revolution from `state`.
    pub fn apply(&self, state: State) -> Result<Return, SimulateError> {
        let mut events = Vec::new();
        let state = self.machine.turn(self.cam_angle, state, TAU, |event| {
            events.push(*event);
            ControlFlow::Continue(())
        })?;
        Ok(Return { state, events })
    }
}
