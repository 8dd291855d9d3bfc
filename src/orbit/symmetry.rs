//! Where an orbit over equal lobes loses its symmetry: located by its own equations.
//!
//! Over a cam of equal lobes an orbit may do the same from lobe to lobe: p times in a period. What carries a deviation of it once around is
//! then the p-th power of what carries it on by a p-th of a period, and p is even where
//!
//! ```text
//! M = S^p        1 + tr S + det S = 0: S has the multiplier -1, and M has 1 of a pair of orbits that branch off
//! ```
//!
//! Nothing passes 0 there along either branch: 1 - tr M + det M only touches it. So S is asked, of the orbit that is symmetric.

use std::f64::consts::{PI, TAU};

use nalgebra::Matrix2;

use super::near::close;
use super::{Course, Cycle, Impact, PeriodicOrbit};
use crate::cam::Cam;
use crate::simulate::Machine;
use crate::tolerance;

/// The value near `begun` with whose `machine` the symmetric orbit near `near` has the multiplier -1 of a p-th of its period; and that orbit
/// right beside it, as the equations of the whole period do not determine it there. `None` where the cam has no such lobes, or the orbit is
/// not symmetric near by, and where the value is 0.
pub fn breaking(machine: impl Fn(f64) -> Option<Machine>, begun: f64, near: &Cycle) -> Option<(f64, PeriodicOrbit)> {
    /// Where the orbit is asked, over the value: far enough from where it is not determined, and so near that a cubic through these errs by
    /// less than rounding.
    const BESIDE: [f64; 4] = [-2e-4, -1e-4, 1e-4, 2e-4];
    /// How often that is done about what came out before.
    const ROUNDS: usize = 8;
    /// How far from where it is looked for it may be, of the value.
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

/// Where the polynomial through these points, a value and where it is, has the value 0: Neville's scheme; `None` where two values are the same.
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

/// How many times in its period the cycle nearly does the same, an even number; `None` where it does not, or the cam does not.
fn parts(cam: &Cam, cycle: &Cycle) -> Option<usize> {
    /// Rad, and of a velocity: next to where they branch off, orbits are as near to symmetric as their distance from there is to its root.
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

/// Whether the cam is the same when it is turned by an angle, rad, as far as its digits go.
fn has_lobes(cam: &Cam, turn: f64) -> bool {
    /// Places in each segment at which it is looked at.
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

/// The cycle with the mean of what it does in each of its parts in all of them.
fn symmetric(cam: &Cam, cycle: &Cycle, parts: usize) -> Cycle {
    let count = cycle.impacts.len();
    let (each, period) = (count / parts, cycle.revolutions as f64 * TAU);
    let turn = period / parts as f64;
    let mean = |index: usize| {
        let first = cycle.impacts[index].turned();
        let of_part = |part: usize| {
            let impact = &cycle.impacts[(index + part * each) % count];
            // Near to where the first is, whichever part it is numbered in.
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

/// S: what carries a deviation right before the first impact on to where the next part begins.
fn step(machine: &Machine, cycle: &Cycle, parts: usize) -> Matrix2<f64> {
    let flown = |index: usize| {
        let (_, time) = cycle.flight(machine, index);
        machine.flight().propagator(time) * cycle.rates(machine, index).saltation()
    };
    (0..cycle.impacts.len() / parts).fold(Matrix2::identity(), |matrix, index| flown(index) * matrix)
}

impl PeriodicOrbit {
    /// Its impacts as a cycle; none where it rests on the cam or never meets it.
    pub fn cycle(&self) -> Option<&Cycle> {
        if let Course::Impacts(cycle) = &self.course { Some(cycle) } else { None }
    }
}
