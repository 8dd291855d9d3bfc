//! The graze of an orbit without impacts, and the motions beyond it.
//!
//! The follower rests at its equilibrium, and the cam's top just touches it. Beyond the graze, a follower that is y too low is struck
//! shortly before the top. With `a = -omega^2 c''` it takes up a velocity. After n passages of the top, each a time T after the one before,
//! it is above the touch by
//!
//! ```text
//! (1 + r) sqrt(2 a y) s(n T)        s the response of the follower to a unit impulse, as far as small motions go
//! ```
//!
//! For small y the square root is much larger than y (Nordmark 1991). So the first passage with `s(n T) < 0` strikes the follower deeper
//! than the one before. The impacts grow, and no motion nearby attracts: a jump. They grow to a depth of at least the size of
//!
//! ```text
//! y = (1 + r)^2 2 a s(n T)^2        where the root gives back y
//! ```
//!
//! A follower that oscillates has such an n, unless its oscillation is in resonance with the cam, `s(n T) = 0`. A follower that does not
//! oscillate has `s > 0` always, and impacts stay small. Close to the graze the slower of its two rates then decides the motion, by the
//! part `lambda = e^(-slow T)` of a deviation that is left after one passage (Chin, Ott, Nusse, Grebogi 1994; Fredriksson, Nordmark 1997):
//!
//! ```text
//! lambda < 1/4          stable orbits of one impact in n passages; neighbours coexist in part; n grows without end
//! 1/4 < lambda < 2/3    the same orbits, with chaos between them
//! 2/3 < lambda < 1      chaos
//! ```

use std::f64::consts::{PI, TAU};

use serde::Serialize;

use crate::cam::Least;
use crate::elementary;
use crate::orbit::cycle::lift_size;
use crate::simulate::{Machine, angular_velocity};
use crate::tolerance;

/// The kinds of graze of an orbit without impacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum GrazeClass {
    /// No motion nearby attracts beyond the graze.
    Jump,
    /// Stable orbits of one impact in ever more passages; neighbours coexist in part.
    PeriodAdding,
    /// Stable orbits of one impact in ever more passages, with chaos between them.
    PeriodAddingChaos,
    /// Chaos of small impacts.
    Chaos,
    /// No certain class.
    Undecided,
}

named!(GrazeClass);

/// Reason why a class is undecided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Doubt {
    /// The cam's velocity jumps at its top.
    Sharp,
    /// The cam does not fall away from its top as a parabola does.
    Flat,
    /// The cam is equally high at several places, which are not alike or not evenly spaced.
    Places,
    /// A follower that nothing returns to where it was.
    Unheld,
    /// The follower's oscillation is in resonance with the cam.
    Resonance,
    /// The eigenvalue is at the boundary of two classes.
    Boundary,
}

/// Class of the graze of an orbit without impacts, with the motions beyond it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstTouch {
    /// Class of the motions beyond the graze.
    pub class: GrazeClass,
    /// For a jump: the number of passages of the cam's top after which the follower is struck deeper, and the depth from which on it need
    /// not be, m.
    pub back: Option<(u64, f64)>,
    /// Why the class is undecided.
    pub doubt: Option<Doubt>,
    /// Whether the cam reaches the follower at larger values of the followed parameter; otherwise at smaller ones.
    pub larger: bool,
}

/// Eigenvalues between which stable orbits of one impact have chaos between them.
const CHAOS_BETWEEN: [f64; 2] = [1.0 / 4.0, 2.0 / 3.0];
/// Resonances after more passages than this are not listed one by one.
const LATEST: u64 = 4;

impl FirstTouch {
    /// Classifies the touch of a follower at rest by the `tops` of the cam.
    pub(super) fn of(machine: &Machine, tops: &[Least], larger: bool) -> Self {
        let told = |class| Self { class, back: None, doubt: None, larger };
        match classified(machine, tops) {
            Ok((GrazeClass::Jump, passages, depth)) => Self { back: Some((passages, depth)), ..told(GrazeClass::Jump) },
            Ok((class, ..)) => told(class),
            Err(doubt) => Self { doubt: Some(doubt), ..told(GrazeClass::Undecided) },
        }
    }
}

/// Class of the graze; for a jump also the passages and the depth.
fn classified(machine: &Machine, tops: &[Least]) -> Result<(GrazeClass, u64, f64), Doubt> {
    let (flight, omega) = (machine.flight(), machine.angular_velocity());
    let acceleration = omega * omega * bend(machine, tops)?;
    let time = TAU / omega / tops.len() as f64;
    if let Some(oscillation) = flight.damped_frequency() {
        let passages = struck_deeper(oscillation * time).ok_or(Doubt::Resonance)?;
        // y = (1 + r)^2 2 a s(n T)^2
        let response = flight.response(passages as f64 * time).impulse;
        let depth = (1.0 + machine.restitution()).powi(2) * 2.0 * acceleration * response * response;
        return Ok((GrazeClass::Jump, passages, depth));
    }
    let slow = flight.slowest_rate().filter(|rate| *rate > 0.0).ok_or(Doubt::Unheld)?;
    // lambda = e^(-slow T)
    let eigenvalue = elementary::exp(-slow * time);
    if CHAOS_BETWEEN.iter().any(|bound| (eigenvalue - bound).abs() <= tolerance::UNIT_EIGENVALUE.value) {
        return Err(Doubt::Boundary);
    }
    let class = match CHAOS_BETWEEN.map(|bound| bound < eigenvalue) {
        [false, _] => GrazeClass::PeriodAdding,
        [true, false] => GrazeClass::PeriodAddingChaos,
        [true, true] => GrazeClass::Chaos,
    };
    Ok((class, 0, 0.0))
}

/// Curvature at the cam's tops, `-c''` on the side that comes first, m/rad^2. Fails if the tops are not alike.
fn bend(machine: &Machine, tops: &[Least]) -> Result<f64, Doubt> {
    let flat = tolerance::FLAT_TOP.value * lift_size(machine);
    let mut bends = Vec::new();
    for top in tops {
        let segment = &machine.cam().segments()[top.segment];
        let is_start = (top.angle - segment.start).abs() <= tolerance::CORNER_ANGLE.value;
        let before = &machine.cam().segments()[machine.cam().before(top.segment)];
        let lift = if is_start { before.law.lift(before.end) } else { top.lift };
        if lift.slope > flat {
            return Err(Doubt::Sharp);
        }
        if !(-lift.curvature > flat) {
            return Err(Doubt::Flat);
        }
        bends.push(-lift.curvature);
    }
    let first = *bends.first().ok_or(Doubt::Flat)?;
    let apart = TAU / tops.len() as f64;
    let are_even =
        tops.windows(2).all(|two| (two[1].angle - two[0].angle - apart).abs() <= tolerance::CORNER_ANGLE.value);
    let are_alike = bends.iter().all(|bend| (bend - first).abs() <= flat);
    if are_even && are_alike { Ok(first) } else { Err(Doubt::Places) }
}

/// First n with `sin(n angle) < 0`, rad; `None` if the sine is, or may be, 0 for an earlier n.
fn struck_deeper(angle: f64) -> Option<u64> {
    let within = angle.rem_euclid(TAU);
    let halves = PI / within;
    let is_resonant = |off: f64| off.abs() <= tolerance::UNIT_EIGENVALUE.value * angle.max(1.0);
    if is_resonant(within) || is_resonant(TAU - within) || is_resonant(PI - halves.round() * within) {
        return None;
    }
    Some(halves.floor() as u64 + 1)
}

/// Reason why the class of a graze is undecided at a speed. On the two sides of that speed the class differs, or the number of passages
/// after which the follower is struck deeper.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub enum UndecidedGraze {
    /// An eigenvalue at the boundary of two classes.
    Eigenvalue(f64),
    /// A resonance: the follower is back at its equilibrium this number of passages after an impact.
    Resonance(u64),
}

/// Returns speeds in a range, rpm, at which the class is undecided, for a cam with so many tops: at most `most` of them.
pub(super) fn borders(
    machine: &Machine,
    tops: usize,
    [low, high]: [f64; 2],
    most: usize,
) -> Vec<(f64, UndecidedGraze)> {
    let per_rpm = angular_velocity(1.0);
    // A passage takes T = 2 pi/(omega tops).
    let speed = |time: f64| TAU / time / tops as f64 / per_rpm;
    let is_inside = |(rpm, _): &(f64, UndecidedGraze)| low < *rpm && *rpm < high;
    if let Some(slow) = machine.flight().slowest_rate() {
        let at = |bound: f64| (speed(-elementary::ln(bound) / slow), UndecidedGraze::Eigenvalue(bound));
        return CHAOS_BETWEEN.into_iter().map(at).filter(is_inside).collect();
    }
    let Some(oscillation) = machine.flight().damped_frequency() else { return Vec::new() };
    // sin(n angle) = 0 at angle = 2 pi j + pi/n, and at 2 pi j.
    let turns = ((oscillation * speed(1.0) / high / TAU).floor() as u64)..;
    let parts = (1..=LATEST).rev().map(|passages| (PI / passages as f64, passages));
    let parts: Vec<(f64, u64)> = std::iter::once((0.0, 1)).chain(parts).collect();
    let angles = turns.flat_map(|turn| parts.clone().into_iter().map(move |(part, n)| (turn as f64 * TAU + part, n)));
    let speeds = angles.map(|(angle, passages)| (speed(angle / oscillation), UndecidedGraze::Resonance(passages)));
    let mut inside: Vec<_> = speeds.take_while(|(rpm, _)| low < *rpm).filter(is_inside).take(most).collect();
    inside.reverse();
    inside
}
