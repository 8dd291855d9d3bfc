//! Stroboscopic map, from the follower's state at a cam angle to its state one revolution later; and traces of a motion.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use nalgebra::{Matrix2, Vector2};

use crate::cam::Lift;
use crate::flight::State;
use crate::simulate::{Event, EventKind, Goal, Machine, Motion, SimulateError, Variation};
use crate::tolerance;

/// Map of one revolution, from the section at a cam angle back to it.
#[derive(Clone, Debug)]
pub struct StroboscopicMap {
    /// Machine.
    pub machine: Machine,
    /// Angle of the section, rad, in `[0, 2 pi)`.
    pub cam_angle: f64,
}

/// Result of one revolution.
#[derive(Clone, Debug, PartialEq)]
pub struct Return {
    /// State on the section, one revolution later.
    pub state: State,
    /// Events on the way, in order.
    pub events: Vec<Event>,
}

impl Return {
    /// The impacts among the events.
    pub fn impacts(&self) -> impl Iterator<Item = &Event> {
        self.events.iter().filter(|event| event.kind == EventKind::Impact)
    }
}

impl StroboscopicMap {
    /// Maps `state` over one revolution: eq:lmap_g.
    pub fn apply(&self, state: State) -> Result<Return, SimulateError> {
        let mut events = Vec::new();
        let state = self.machine.turn(self.cam_angle, state, TAU, |event| {
            events.push(*event);
            ControlFlow::Continue(())
        })?;
        Ok(Return { state, events })
    }

    /// Returns the state after `revolutions` from `state`, and the propagator of a small deviation, `d(q, v)/d(q0, v0)`, 2x2.
    pub fn carry(&self, state: State, revolutions: u64) -> Result<(State, Matrix2<f64>), SimulateError> {
        let mut motion = self.machine.start(self.cam_angle, state)?;
        let mut variation = Variation::new(&self.machine, &motion);
        let goal = motion.after(revolutions);
        let _ = self.machine.advance(&mut motion, goal, &mut variation)?;
        Ok((motion.state, variation.matrix()))
    }

    /// Finds the motion near `guess` that repeats after `revolutions`, stable or not, by Newton's method; `None` if the method finds none.
    pub fn periodic(&self, guess: State, revolutions: u64) -> Result<Option<Periodic>, SimulateError> {
        /// Step limit: Newton's method doubles the digits, and a useful guess needs about six steps.
        const STEPS: usize = 20;
        let omega = self.machine.angular_velocity();
        let size = |dx: Vector2<f64>| Vector2::new(dx[0], dx[1] / omega).norm();
        let mut state = guess;
        for _ in 0..STEPS {
            let (end, matrix) = match self.carry(state, revolutions) {
                Ok(carried) => carried,
                // A step below the cam ends the search.
                Err(SimulateError::BelowCam { revolution: 0, .. }) => return Ok(None),
                Err(error) => return Err(error),
            };
            let miss = Vector2::new(end.position - state.position, end.velocity - state.velocity);
            // Velocities are divided by omega, so that the largest entry of a column is independent of units.
            let unit = Matrix2::from_diagonal(&Vector2::new(1.0, omega));
            let per_unit = Matrix2::from_diagonal(&Vector2::new(1.0, 1.0 / omega));
            let equations = per_unit * (Matrix2::identity() - matrix) * unit;
            let Some(step) = equations.lu().solve(&(per_unit * miss)).map(|step| unit * step) else { return Ok(None) };
            if size(step) <= tolerance::ORBIT_CLOSURE.value * size(Vector2::new(state.position, state.velocity)) {
                return Ok(Some(Periodic { state, matrix }));
            }
            state = State { position: state.position + step[0], velocity: state.velocity + step[1] };
        }
        Ok(None)
    }
}

/// Impact map: the first impact after the follower leaves the cam at `cam_angle`, rad, in `[0, 2 pi)`, with a relative velocity, m/s, zero
/// or more. `None` if there is no further impact, or none for very long.
pub fn next_impact(machine: &Machine, cam_angle: f64, relative_velocity: f64) -> Result<Option<Event>, SimulateError> {
    /// Revolutions without an impact after which the search ends.
    const PATIENCE: u64 = 100_000;
    if !(relative_velocity >= 0.0) {
        return Ok(None);
    }
    let mut motion = machine.start_on_cam(cam_angle, relative_velocity)?;
    loop {
        // A cam that does not release the follower within a turn never does.
        let goal = motion.after(if motion.contact { 1 } else { PATIENCE });
        let mut last = None;
        let _ = machine.advance(&mut motion, goal, &mut |event: &Event| {
            last = Some(*event);
            ControlFlow::Break(())
        })?;
        match last {
            Some(event) if event.kind == EventKind::Impact => return Ok(Some(event)),
            Some(_) => {}
            None => return Ok(None),
        }
    }
}

/// A periodic motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Periodic {
    /// State on the section.
    pub state: State,
    /// Propagator of a small deviation over one period; its eigenvalues are the multipliers.
    pub matrix: Matrix2<f64>,
}

impl Periodic {
    /// Determinant det(I + A): 0 if a multiplier is -1, where the motion flips to one of twice the period.
    pub fn flip(&self) -> f64 {
        1.0 + self.matrix.trace() + self.matrix.determinant()
    }
}

/// Follower and cam at one moment of a trace.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TraceSample {
    /// Angle turned since the cam passed 0 in revolution 0, rad.
    pub turned: f64,
    /// Cam angle, rad, in `[0, 2 pi)`.
    pub cam_angle: f64,
    /// State of the follower.
    pub state: State,
    /// Lift of the cam, m.
    pub lift: f64,
    /// Velocity of the cam, m/s.
    pub cam_velocity: f64,
    /// Gap, m.
    pub gap: f64,
    /// Whether the follower sticks to the cam.
    pub contact: bool,
    /// Contact force per kilogram of the follower, m/s^2; 0 without contact.
    pub pressing: f64,
}

/// Samples a motion at `samples` moments per revolution, evenly spaced in angle, over `revolutions` from `motion` on. Also returns the
/// events in between, each with one sample right before and one right after it.
pub fn trace(
    machine: &Machine,
    mut motion: Motion,
    revolutions: u64,
    samples: u32,
) -> Result<(Vec<TraceSample>, Vec<Event>), SimulateError> {
    let omega = machine.angular_velocity();
    // N/m = c'' - (b q' + k (q - rest) + m g)/m, whose last term is the acceleration in flight
    let pressing = |lift: Lift, state: State| omega * omega * lift.curvature - machine.flight().acceleration(state);
    let sample = |motion: &Motion| {
        let lift = machine.cam().lift(motion.cam_angle);
        TraceSample {
            turned: motion.revolution as f64 * TAU + motion.cam_angle,
            cam_angle: motion.cam_angle,
            state: motion.state,
            lift: lift.value,
            cam_velocity: omega * lift.slope,
            gap: machine.gap(motion),
            contact: motion.contact,
            pressing: if motion.contact { pressing(lift, motion.state) } else { 0.0 },
        }
    };
    let mut found = vec![sample(&motion)];
    let mut events = Vec::new();
    let (begun, first, step) = (motion.revolution, motion.cam_angle, TAU / f64::from(samples));
    for index in 1..=revolutions * u64::from(samples) {
        let turns = begun + index / u64::from(samples);
        let angle = first + (index % u64::from(samples)) as f64 * step;
        let (revolution, cam_angle) = if angle < TAU { (turns, angle) } else { (turns + 1, angle - TAU) };
        let before = events.len();
        let _ = machine.advance(&mut motion, Goal { revolution, cam_angle }, &mut |event: &Event| {
            events.push(*event);
            ControlFlow::Continue(())
        })?;
        for event in &events[before..] {
            let at = |velocity: f64, contact: bool| {
                let state = State { position: event.position, velocity };
                // Contact ends where the cam no longer presses.
                let sticks = contact && event.kind == EventKind::Stick;
                TraceSample {
                    turned: event.turned_since(0.0),
                    cam_angle: event.cam_angle,
                    state,
                    lift: event.position,
                    cam_velocity: event.cam_velocity,
                    gap: 0.0,
                    contact,
                    pressing: if sticks { pressing(machine.cam().lift(event.cam_angle), state) } else { 0.0 },
                }
            };
            found.push(at(event.velocity_before, event.kind == EventKind::Release));
            found.push(at(event.velocity_after, event.kind == EventKind::Stick));
        }
        found.push(sample(&motion));
    }
    Ok((found, events))
}
