//! Events of a run, observers of a run, and the errors that end it.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use serde::Serialize;

use crate::cam::Lift;
use crate::flight::{Flight, State};

/// Kind of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum EventKind {
    /// Impact: the follower hits the cam.
    Impact,
    /// Start of sticking, after one impact without relative velocity, or after infinitely many impacts.
    Stick,
    /// Release: the follower leaves the cam after sticking.
    Release,
}

impl EventKind {
    /// Name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Impact => "impact",
            Self::Stick => "stick",
            Self::Release => "release",
        }
    }
}

/// Impact, start of sticking, or release.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Kind of event.
    pub kind: EventKind,
    /// Number of times that the cam has passed angle 0 since the start of the run.
    pub revolution: u64,
    /// Cam angle, rad, in `[0, 2 pi)`.
    pub cam_angle: f64,
    /// q = c, m.
    pub position: f64,
    /// v-, m/s.
    pub velocity_before: f64,
    /// v+, m/s.
    pub velocity_after: f64,
    /// c', m/s; at a corner, on the segment that was hit.
    pub cam_velocity: f64,
    /// Index of the segment of the cam.
    pub segment: usize,
}

impl Event {
    /// Angle turned since a start at `cam_angle`, rad, in revolution 0.
    pub fn turned_since(&self, cam_angle: f64) -> f64 {
        let within = self.cam_angle - cam_angle;
        if self.revolution == 0 { within } else { self.revolution as f64 * TAU + within }
    }
}

/// Work spent on finding contacts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[doc(hidden)]
pub struct Work {
    /// Evaluations of the gap between follower and cam.
    pub gaps: u64,
    /// Steps of Newton's or Halley's method.
    pub steps: u64,
    /// Windows that were searched step by step, because the shape of their gap certifies no contact.
    pub marches: u64,
    /// Impacts of a settled motion, found one turn later without a search.
    pub repeats: u64,
}

/// Observer of a run. A closure that takes each event is an observer.
pub trait Observer {
    /// Whether `work` is called. It is a constant, so that other runs spend no time on counting.
    const COUNTS: bool = false;

    /// Receives an event; may end the run right after it.
    fn event(&mut self, event: &Event) -> ControlFlow<()>;

    /// Receives the lift at the impact whose event follows, on the segment that is hit.
    fn strikes(&mut self, _lift: &Lift) {}

    /// Receives a completed part of free flight: its start state and its duration, s.
    fn flight(&mut self, _flight: &Flight, _from: State, _time: f64) {}

    /// Receives the work of one more search for a contact.
    fn work(&mut self, _work: Work) {}
}

impl<F: FnMut(&Event) -> ControlFlow<()>> Observer for F {
    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        self(event)
    }
}

/// Number and greatest speed of impacts in a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[doc(hidden)]
pub struct ImpactTally {
    /// Number of impacts.
    pub impacts: u64,
    /// Relative speed of follower and cam at the fastest impact, m/s.
    pub impact_speed: f64,
}

impl ImpactTally {
    /// Combines the impacts of both.
    pub fn with(self, other: Self) -> Self {
        Self { impacts: self.impacts + other.impacts, impact_speed: self.impact_speed.max(other.impact_speed) }
    }

    /// Counts an event if it is an impact.
    pub fn take(&mut self, event: &Event) {
        if event.kind == EventKind::Impact {
            self.impacts += 1;
            self.impact_speed = self.impact_speed.max(event.cam_velocity - event.velocity_before);
        }
    }
}

/// Observer that ignores everything.
#[derive(Clone, Copy, Debug)]
pub struct Unobserved;

impl Observer for Unobserved {
    fn event(&mut self, _event: &Event) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Reason why a run cannot continue.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the message says what each number is")]
pub enum SimulateError {
    /// Follower inside the cam: it started there, or a continued cam has a step.
    #[error(
        "simulate: the follower is below the cam by {depth:.3e} in the model's unit of length at cam angle {:.4} deg of revolution {revolution}",
        cam_angle.to_degrees()
    )]
    BelowCam { depth: f64, revolution: u64, cam_angle: f64 },
    /// Flight through the cam, which is impossible: a fault of this program.
    #[error(
        "simulate: a fault of this program: at {rpm} rpm the follower has passed through the cam by {depth:.3e} at cam angle \
         {:.4} deg of revolution {revolution}, at position {position} with velocity {velocity}, in the model's units",
        cam_angle.to_degrees()
    )]
    PassedThrough { depth: f64, revolution: u64, cam_angle: f64, position: f64, velocity: f64, rpm: f64 },
    /// More events in one revolution, or steps from one event to the next, than allowed.
    #[error(
        "simulate: no progress: {events} events or steps in revolution {revolution}, and still at cam angle {:.6} deg",
        cam_angle.to_degrees()
    )]
    NoProgress { events: u32, revolution: u64, cam_angle: f64 },
    /// Start outside `[0, 2 pi)`.
    #[error("simulate: a start at cam angle {cam_angle} rad: it must be 0 or more, and below 2 pi")]
    Start { cam_angle: f64 },
    /// Cam that does not turn, or turns backwards.
    #[error(
        "simulate: the cam turns by {angular_velocity} rad a second or for {turn} rad: both must be finite, and forwards"
    )]
    Turn { angular_velocity: f64, turn: f64 },
    /// State that is not finite.
    #[error(
        "simulate: a state that is not finite near cam angle {:.4} deg of revolution {revolution}",
        cam_angle.to_degrees()
    )]
    NotFinite { revolution: u64, cam_angle: f64 },
}
