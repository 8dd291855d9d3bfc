//! A periodic orbit as the sequence of its impacts, and the equations that close it.
//!
//! Impact i is on a known segment of the cam, at angle `t_i` with velocity `v_i` before it. The follower leaves it with
//! `w_i = (1 + r) c'_i - r v_i`, and the flight to the next impact, over `t_{i+1} - t_i`, must end there:
//!
//! ```text
//! q(t_{i+1}) = c_{i+1}        v(t_{i+1}) = v_{i+1}        the last is followed by the first, n revolutions on
//! ```
//!
//! Each segment's law continues smoothly past its ends, so the equations are smooth wherever an impact is. An orbit can be followed through
//! a corner as if its law went on; the corner is where an angle passes it. The simulator decides whether the orbit is one of the actual cam
//! ([`Cycle::departure`]).

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector, Matrix2, Vector2};

use super::chain::{self, Link};
use crate::cam::{Lift, apart};
use crate::elementary;
use crate::flight::State;
use crate::impact::{ImpactRates, rebound};
use crate::simulate::{Event, EventKind, Machine};
use crate::tolerance;

/// One impact of a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct Impact {
    /// Number of times that the cam has passed angle 0 since the cycle's start; counted modulo the cycle's revolutions.
    pub revolution: i64,
    /// Index of the segment of the cam whose law holds.
    pub segment: usize,
    /// Cam angle, rad. It may lie outside of the segment, where the segment's law is continued.
    pub cam_angle: f64,
    /// v-, m/s.
    pub velocity_before: f64,
}

impl Impact {
    /// The angle that the cam has turned since angle 0 of revolution 0, rad.
    pub fn turned(&self) -> f64 {
        self.revolution as f64 * TAU + self.cam_angle
    }
}

/// A periodic motion, as its impacts in order: at least one.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub struct Cycle {
    /// Turns of the cam in one period.
    pub revolutions: u64,
    /// The impacts, in order.
    pub impacts: Vec<Impact>,
}

/// Newton's method found no cycle near the guess that meets the equations.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "no periodic orbit near the guess: after {steps} Newton steps the equations are off by {residual:e} of their size"
)]
#[doc(hidden)]
pub struct NotClosed {
    /// Steps of Newton's method.
    pub steps: usize,
    /// Residual of the orbit's equations, relative to their size.
    pub residual: f64,
}

/// Quantities of one impact that the equations need.
pub(super) struct Struck {
    pub(super) lift: Lift,
    /// c', m/s.
    pub(super) cam_velocity: f64,
    pub(super) leaving: State,
}

impl Cycle {
    /// Guesses a cycle from the impacts of a run over `revolutions`.
    pub fn of_events(revolutions: u64, events: &[Event]) -> Self {
        let impact = |event: &Event| Impact {
            revolution: event.revolution as i64,
            segment: event.segment,
            cam_angle: event.cam_angle,
            velocity_before: event.velocity_before,
        };
        let impacts = events.iter().filter(|event| event.kind == EventKind::Impact);
        Self { revolutions, impacts: impacts.map(impact).collect() }
    }

    pub(super) fn struck(&self, machine: &Machine, index: usize) -> Struck {
        let impact = &self.impacts[index];
        let lift = machine.cam().segments()[impact.segment].law.lift(impact.cam_angle);
        let cam_velocity = machine.angular_velocity() * lift.slope;
        let velocity = rebound(machine.restitution(), impact.velocity_before, cam_velocity);
        Struck { lift, cam_velocity, leaving: State { position: lift.value, velocity } }
    }

    /// Speed at which follower and cam approach one another at an impact, m/s: `c' - v-`.
    pub fn approach(&self, machine: &Machine, index: usize) -> f64 {
        self.struck(machine, index).cam_velocity - self.impacts[index].velocity_before
    }

    /// Number of times that the cam passes angle 0 from one impact to the next.
    pub(super) fn turns(&self, index: usize) -> f64 {
        let next = (index + 1) % self.impacts.len();
        let later = if next == 0 { self.revolutions as f64 } else { 0.0 };
        later + self.impacts[next].revolution as f64 - self.impacts[index].revolution as f64
    }

    /// The angle turned from one impact to the next, rad.
    pub fn turn(&self, index: usize) -> f64 {
        let next = (index + 1) % self.impacts.len();
        self.turns(index) * TAU + (self.impacts[next].cam_angle - self.impacts[index].cam_angle)
    }

    /// Distance on the cam from one impact to the nearest other, rad.
    pub fn nearest_other(&self, impact: usize) -> f64 {
        let others = self.impacts.iter().enumerate().filter(|(index, _)| *index != impact);
        let near = |other: &Impact| apart(other.cam_angle, self.impacts[impact].cam_angle);
        others.fold(f64::INFINITY, |least, (_, other)| least.min(near(other)))
    }

    /// The state right after an impact, and the time of the flight that begins there, s.
    pub fn flight(&self, machine: &Machine, index: usize) -> (State, f64) {
        (self.struck(machine, index).leaving, self.turn(index) / machine.angular_velocity())
    }

    /// Residual of the equations: for each flight the position, m, and the velocity over omega, m/rad.
    pub fn residual(&self, machine: &Machine) -> DVector<f64> {
        self.equations(machine).0
    }

    /// [`Cycle::residual`] and its derivative by angle, rad, and velocity over omega, m/rad, of each impact in turn.
    pub fn linear(&self, machine: &Machine) -> (DVector<f64>, DMatrix<f64>) {
        let count = self.impacts.len();
        let (residual, links) = self.equations(machine);
        let mut rows = DMatrix::zeros(2 * count, 2 * count);
        for (index, link) in links.into_iter().enumerate() {
            let next = (index + 1) % count;
            for (column, by) in [(index, link.leaving), (next, link.coming)] {
                let mut block = rows.fixed_view_mut::<2, 2>(2 * index, 2 * column);
                block += by;
            }
        }
        (residual, rows)
    }

    /// Determinant of the derivative in [`Cycle::linear`] for deviations that grow by `multiplier` in one period, with velocities over
    /// omega in the unit `velocity`, m/rad. It is 0 for a multiplier of the orbit. Its rows have length 1, so its size is at most 1
    /// (Hadamard).
    pub fn characteristic(&self, machine: &Machine, multiplier: f64, velocity: f64) -> f64 {
        let (_, mut links) = self.equations(machine);
        let is_alone = links.len() == 1;
        if let Some(last) = links.last_mut() {
            last.coming *= multiplier;
        }
        for Link { leaving, coming } in &mut links {
            for block in [&mut *leaving, &mut *coming] {
                block.column_mut(1).scale_mut(velocity);
            }
            for row in 0..2 {
                let (from, to) = (leaving.row(row), coming.row(row));
                let length = if is_alone { (from + to).norm() } else { elementary::hypot(from.norm(), to.norm()) };
                leaving.row_mut(row).unscale_mut(length);
                coming.row_mut(row).unscale_mut(length);
            }
        }
        chain::determinant(&links)
    }

    /// Residual and its derivatives, flight by flight.
    fn equations(&self, machine: &Machine) -> (DVector<f64>, Vec<Link>) {
        let (count, omega, r) = (self.impacts.len(), machine.angular_velocity(), machine.restitution());
        let flight = machine.flight();
        let struck: Vec<Struck> = (0..count).map(|index| self.struck(machine, index)).collect();
        let mut off = DVector::zeros(2 * count);
        let mut link = |index: usize| {
            let next = (index + 1) % count;
            let (from, to) = (&struck[index], &struck[next]);
            let response = flight.response(self.turn(index) / omega);
            let (displacement, end) = flight.fly_by(from.leaving, &response);
            off[2 * index] = displacement - (to.lift.value - from.lift.value);
            off[2 * index + 1] = (end.velocity - self.impacts[next].velocity_before) / omega;
            let propagator = flight.propagator_by(&response);
            let moving = Vector2::new(end.velocity, flight.acceleration(end)) / omega;
            // As the start moves along the cam, the flight becomes shorter by as much.
            let by_angle = propagator * Vector2::new(from.lift.slope, (1.0 + r) * omega * from.lift.curvature) - moving;
            let by_velocity = propagator * Vector2::new(0.0, -r * omega);
            let block = |by_angle: Vector2<f64>, by_velocity: Vector2<f64>| {
                Matrix2::new(by_angle[0], by_velocity[0], by_angle[1] / omega, by_velocity[1] / omega)
            };
            Link {
                leaving: block(by_angle, by_velocity),
                coming: block(moving - Vector2::new(to.lift.slope, 0.0), Vector2::new(0.0, -omega)),
            }
        };
        let links = (0..count).map(&mut link).collect();
        (off, links)
    }

    /// The cycle moved by `step`: angle, rad, and velocity over omega, m/rad, of each impact in turn.
    pub fn moved(&self, machine: &Machine, step: &[f64]) -> Self {
        let mut moved = self.clone();
        for (impact, step) in moved.impacts.iter_mut().zip(step.chunks_exact(2)) {
            impact.cam_angle += step[0];
            impact.velocity_before += step[1] * machine.angular_velocity();
        }
        moved
    }

    /// Closes a cycle near this one by Newton's method. Returns it with the last correction over the orbit's size.
    pub fn closed(&self, machine: &Machine) -> Result<(Self, f64), NotClosed> {
        /// Newton's method doubles the digits once it is near; a guess far away takes longer.
        const STEPS: usize = 40;
        /// The farthest that an impact is moved in one step, rad.
        const REACH: f64 = 0.3;
        let size = lift_size(machine);
        let mut cycle = self.clone();
        let mut last = f64::INFINITY;
        for step in 0..STEPS {
            let (off, links) = cycle.equations(machine);
            let Some(mut correction) = chain::solve(&links, &-off) else {
                return Err(NotClosed { steps: step, residual: last });
            };
            let length = relative_length(&correction, size);
            if !length.is_finite() {
                return Err(NotClosed { steps: step, residual: length });
            }
            // Rounding is reached where a correction is no smaller than the one before it.
            if length <= tolerance::CYCLE_CLOSED.value && length >= 0.5 * last {
                return Ok((cycle, length));
            }
            if length > REACH {
                correction *= REACH / length;
            }
            cycle = cycle.moved(machine, correction.as_slice());
            last = length;
        }
        if last <= tolerance::CYCLE_CLOSED.value {
            return Ok((cycle, last));
        }
        Err(NotClosed { steps: STEPS, residual: last })
    }

    /// The impacts in the order in which the cam meets them from `cam_angle`, rad, in `[0, 2 pi)`, each with the angle turned.
    fn turned_from(&self, cam_angle: f64) -> Vec<(f64, usize)> {
        let period = self.revolutions as f64 * TAU;
        let turned = |impact: &Impact| {
            let turned = impact.revolution as f64 * TAU + (impact.cam_angle - cam_angle);
            if (0.0..period).contains(&turned) { turned } else { turned.rem_euclid(period) }
        };
        let mut order: Vec<(f64, usize)> =
            self.impacts.iter().enumerate().map(|(index, impact)| (turned(impact), index)).collect();
        order.sort_by(|one, other| one.0.total_cmp(&other.0));
        order
    }

    /// Returns the state when the cam is at `cam_angle`, rad, in `[0, 2 pi)`, in revolution 0, and the 2x2 matrix that carries a small
    /// deviation of it once around the orbit. The matrix is a product of flights' propagators and impacts' saltation matrices.
    pub fn at_section(&self, machine: &Machine, cam_angle: f64) -> (State, Matrix2<f64>) {
        let order = self.turned_from(cam_angle);
        let (omega, count) = (machine.angular_velocity(), order.len());
        // From the last impact before the section.
        let (turned, last) = order[count - 1];
        let since = (self.revolutions as f64 * TAU - turned) / omega;
        let (_, state) = machine.flight().fly(self.struck(machine, last).leaving, since);
        let (mut matrix, mut from) = (Matrix2::identity(), 0.0);
        for (turned, index) in order {
            matrix =
                self.rates(machine, index).saltation() * machine.flight().propagator((turned - from) / omega) * matrix;
            from = turned;
        }
        (state, machine.flight().propagator(since) * matrix)
    }

    /// Determinant of the matrix of one period, `r^(2 n) e^(-b T/m)` with n impacts in a period T. The determinant of the computed matrix
    /// would be lost to rounding where a small deviation grows a millionfold on the way.
    pub fn determinant(&self, machine: &Machine) -> f64 {
        let period = self.revolutions as f64 * TAU / machine.angular_velocity();
        let struck = machine.restitution().powi(2 * self.impacts.len() as i32);
        struck * elementary::exp(-2.0 * machine.flight().zeta() * period)
    }

    /// `det(mu I - M) = mu^2 - mu tr M + det M` of the matrix M of one period, for `mu` 1 or -1. It is 0 where the orbit has this
    /// multiplier.
    pub(super) fn missing(&self, machine: &Machine, multiplier: f64) -> f64 {
        let (_, matrix) = self.at_section(machine, 0.0);
        1.0 - multiplier * matrix.trace() + self.determinant(machine)
    }

    /// Quantities that determine an impact's saltation matrix.
    pub fn rates(&self, machine: &Machine, index: usize) -> ImpactRates {
        let struck = self.struck(machine, index);
        let omega = machine.angular_velocity();
        let velocity_before = self.impacts[index].velocity_before;
        let before = State { velocity: velocity_before, ..struck.leaving };
        ImpactRates {
            restitution: machine.restitution(),
            velocity_before,
            acceleration_before: machine.flight().acceleration(before),
            acceleration_after: machine.flight().acceleration(struck.leaving),
            cam_velocity: struck.cam_velocity,
            cam_acceleration: omega * omega * struck.lift.curvature,
        }
    }

    /// The impacts as events of a run.
    pub fn events(&self, machine: &Machine) -> Vec<Event> {
        let event = |(index, impact): (usize, &Impact)| {
            let struck = self.struck(machine, index);
            Event {
                kind: EventKind::Impact,
                revolution: impact.revolution.rem_euclid(self.revolutions.max(1) as i64) as u64,
                cam_angle: impact.cam_angle,
                position: struck.lift.value,
                velocity_before: impact.velocity_before,
                velocity_after: struck.leaving.velocity,
                cam_velocity: struck.cam_velocity,
                segment: impact.segment,
            }
        };
        self.impacts.iter().enumerate().map(event).collect()
    }
}

/// Span of the cam's lift, m, by which lengths of an orbit are measured. For a constant lift, its absolute value.
pub fn lift_size(machine: &Machine) -> f64 {
    let segments = machine.cam().segments();
    let low = segments.iter().fold(f64::INFINITY, |low, segment| low.min(segment.bounds.lift[0]));
    let span = machine.cam().top() - low;
    let lift = machine.cam().top().abs();
    // The ends of each range have room for rounding.
    if span > 4.0 * tolerance::RANGE_ROUNDING.value * lift { span } else { lift.max(f64::MIN_POSITIVE) }
}

/// Natural speed of the machine, rpm: the speed at which the cam would move with the follower's own acceleration. With a
/// damper alone it is `b/m`. `None` if neither a force nor a damper acts.
///
/// ```text
/// omega^2 = k/m + |g + k (c_min - rest)/m| / (c_max - c_min)
/// ```
pub fn own_speed(machine: &Machine) -> Option<f64> {
    let (flight, size) = (machine.flight(), lift_size(machine));
    let pressed = flight.omega0_squared() + flight.force(machine.cam().top() - size).abs() / size;
    let squared = if pressed > 0.0 { pressed } else { (2.0 * flight.zeta()).powi(2) };
    (squared > 0.0 && squared.is_finite()).then(|| squared.sqrt() * 60.0 / TAU)
}

/// Length of a step: angles count as they are, velocities over omega in units of `size`.
fn relative_length(step: &DVector<f64>, size: f64) -> f64 {
    let square = |(index, entry): (usize, &f64)| (if index % 2 == 0 { *entry } else { *entry / size }).powi(2);
    step.iter().enumerate().map(square).sum::<f64>().sqrt()
}
