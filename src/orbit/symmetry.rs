//! Locates where an orbit over equal lobes loses its symmetry, by its own equations.
//!
//! Over a cam of equal lobes an orbit may repeat p times in a period. The matrix M that carries a deviation once around is then the p-th
//! power of the matrix S of a p-th of the period. The symmetry is lost at an even p where
//!
//! ```text
//! M = S^p        1 + tr S + det S = 0: S has the multiplier -1, and M has 1 of a pair of orbits that branch off
//! ```
//!
//! Along either branch 1 - tr M + det M touches 0 there and does not pass it. So S of the symmetric orbit is evaluated instead.

use std::f64::consts::{PI, TAU};

use nalgebra::Matrix2;

use super::near::close;
use super::{Course, Cycle, Impact, PeriodicOrbit};
use crate::cam::Cam;
use crate::simulate::Machine;
use crate::tolerance;

/// Locates the value near `begun` at which the symmetric orbit near `near` loses its symmetry: a p-th of its period has the multiplier -1.
/// Also returns that orbit right beside the value, since at the value the equations of the whole period do not determine it. `None` if the
/// cam has no such lobes, no symmetric orbit is nearby, or the value is 0.
pub fn breaking(machine: impl Fn(f64) -> Option<Machine>, begun: f64, near: &Cycle) -> Option<(f64, PeriodicOrbit)> {
    /// Relative distances from the value at which the orbit is computed. They are large enough to determine the orbit, and so small that a
    /// cubic through the results errs by less than rounding.
    const BESIDE: [f64; 4] = [-2e-4, -1e-4, 1e-4, 2e-4];
    /// Most rounds of interpolation, each about the result of the one before.
    const ROUNDS: usize = 8;
    /// Largest distance of the result from the start, relative to the value.
    const FAR: f64 = 0.02;
    let first = machine(begun)?;
    let parts = parts(first.cam(), near)?;
    let (mut value, mut guess) = (begun, symmetric(first.cam(), near, parts));
    for _ in 0..ROUNDS {
        let mut seen: Vec<(f64, f64)> = Vec::new();
        for beside in BESIDE {
            let machine = machine(value * (1.0 + beside))?;
            let closed = guess.closed(&machine).ok()?.0;
            guess = symmetric(machine.cam(), &closed, parts);
            let step = step(&machine, &guess, parts);
            seen.push((1.0 + step.trace() + step.determinant(), beside));
        }
        let moved = at_zero(&seen)?;
        value *= 1.0 + moved;
        if !((value - begun).abs() <= FAR * begun.abs()) {
            return None;
        }
        if moved.abs() <= tolerance::ROOT_WIDTH.value {
            return Some((value, close(&machine(value * (1.0 + BESIDE[3]))?, &guess)?));
        }
    }
    None
}

/// Place at which the value is 0, by inverse interpolation through points of a value and its place (Neville's scheme). `None` if two values
/// are equal.
fn at_zero(seen: &[(f64, f64)]) -> Option<f64> {
    let mut row: Vec<f64> = seen.iter().map(|(_, place)| *place).collect();
    for width in 1..seen.len() {
        for index in 0..seen.len() - width {
            let [low, high] = [seen[index].0, seen[index + width].0];
            row[index] = (high * row[index] - low * row[index + 1]) / (high - low);
        }
    }
    row.first().copied().filter(|place| place.is_finite())
}

/// Even number of parts in which the cycle nearly repeats. `None` if the cycle or the cam does not repeat.
fn parts(cam: &Cam, cycle: &Cycle) -> Option<usize> {
    /// Tolerance in rad, and relative for velocities. Near the branching point, orbits differ from symmetric ones by the root of their
    /// distance from it.
    const NEAR: f64 = 0.2;
    let count = cycle.impacts.len();
    let fastest = cycle.impacts.iter().fold(0.0_f64, |most, impact| most.max(impact.velocity_before.abs()));
    let is_near = |parts: &usize| {
        let (each, turn) = (count / parts, cycle.revolutions as f64 * TAU / *parts as f64);
        has_lobes(cam, turn)
            && (0..count).all(|index| {
                let [one, other] = [index, (index + each) % count].map(|index| cycle.impacts[index]);
                let turned = (other.turned() - one.turned()).rem_euclid(cycle.revolutions as f64 * TAU);
                (turned - turn).abs() <= NEAR && (other.velocity_before - one.velocity_before).abs() <= NEAR * fastest
            })
    };
    (2..=count).rev().filter(|parts| parts.is_multiple_of(2) && count.is_multiple_of(*parts)).find(is_near)
}

/// Whether the cam is unchanged when it is turned by an angle, rad, within its digits.
fn has_lobes(cam: &Cam, turn: f64) -> bool {
    /// Places in each segment that are compared.
    const PLACES: usize = 16;
    let size = cam.top() - cam.lowest().value;
    let places = cam.segments().iter().flat_map(|segment| {
        (0..PLACES).map(|place| segment.start + (segment.end - segment.start) * (place as f64 + 0.5) / PLACES as f64)
    });
    let is_same = |angle: f64| {
        let [one, other] = [angle, angle + turn].map(|angle| cam.lift(angle.rem_euclid(TAU)));
        let near = |one: f64, other: f64| (one - other).abs() <= tolerance::ORBIT_CLOSURE.value * size;
        near(one.value, other.value) && near(one.slope, other.slope)
    };
    size > 0.0 && places.into_iter().all(is_same)
}

/// Replaces each part of the cycle by the mean of all parts.
fn symmetric(cam: &Cam, cycle: &Cycle, parts: usize) -> Cycle {
    let count = cycle.impacts.len();
    let (each, period) = (count / parts, cycle.revolutions as f64 * TAU);
    let turn = period / parts as f64;
    let mean = |index: usize| {
        let first = cycle.impacts[index].turned();
        let of_part = |part: usize| {
            let impact = &cycle.impacts[(index + part * each) % count];
            // The angle nearest to the first part's, whatever revolution it is numbered in.
            let off = (impact.turned() - part as f64 * turn - first + PI).rem_euclid(period) - PI;
            (off, impact.velocity_before)
        };
        let sum = (0..parts).map(of_part).fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
        (first + sum.0 / parts as f64, sum.1 / parts as f64)
    };
    let means: Vec<(f64, f64)> = (0..each).map(mean).collect();
    let impact = |index: usize| {
        let (turned, velocity_before) = means[index % each];
        let turned = turned + (index / each) as f64 * turn;
        let revolution = (turned / TAU).floor();
        let cam_angle = turned - revolution * TAU;
        Impact { revolution: revolution as i64, segment: cam.segment_at(cam_angle), cam_angle, velocity_before }
    };
    Cycle { revolutions: cycle.revolutions, impacts: (0..count).map(impact).collect() }
}

/// S: the matrix that carries a deviation from right before the first impact to the start of the next part.
fn step(machine: &Machine, cycle: &Cycle, parts: usize) -> Matrix2<f64> {
    let flown = |index: usize| {
        let (_, time) = cycle.flight(machine, index);
        machine.flight().propagator(time) * cycle.rates(machine, index).saltation()
    };
    (0..cycle.impacts.len() / parts).fold(Matrix2::identity(), |matrix, index| flown(index) * matrix)
}

impl PeriodicOrbit {
    /// The orbit's impacts as a cycle; `None` if it rests on the cam or never meets it.
    pub fn cycle(&self) -> Option<&Cycle> {
        if let Course::Impacts(cycle) = &self.course { Some(cycle) } else { None }
    }
}
