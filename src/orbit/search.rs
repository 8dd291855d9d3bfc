//! Orbits of one machine, stable or not.
//!
//! Three ways, each of which finds what the others may miss. Orbits of one impact are roots of one function of the
//! impact's angle, looked for between samples. Long runs settle on stable orbits. Short runs from many starts on the cam
//! give Newton's method the guesses from which it finds unstable orbits.

use std::convert::Infallible;
use std::f64::consts::TAU;

use super::settle::{MOST_IMPACTS, close, period, settled};
use super::{Course, Cycle, Impact, PeriodicOrbit};
use crate::bracket::{Width, halve};
use crate::known::{Complete, Known};
use crate::simulate::{EventKind, Machine, SimulateError};

/// Which orbits are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Search {
    /// Turns of the cam in one period, the smallest number.
    pub revolutions: u64,
    /// Impacts in one period; any number where there is none given.
    pub impacts: Option<usize>,
}

impl Search {
    /// What the list of [`search`] has all of: one function's changes of sign between samples.
    pub fn complete(&self) -> Option<Complete> {
        let one = self.impacts.is_none_or(|impacts| impacts == 1);
        one.then_some(Complete { revolutions: self.revolutions, impacts: 1, known: Known::Sampled })
    }

    /// The most revolutions that an orbit is looked for over.
    pub const MOST_REVOLUTIONS: u64 = 1000;
}

/// Cam angles that short runs start at, and velocities at each.
const START_ANGLES: usize = 60;
const START_VELOCITIES: usize = 20;
/// Starts of long runs, and revolutions that they settle in.
const LONG_RUNS: usize = 6;
const SETTLING: u64 = 600;
/// The same for those that come to rest on the cam.
const SETTLING_STICKING: u64 = 6;
/// Samples of a segment in which roots are told apart.
const SAMPLES: usize = 512;

/// Every orbit that was found, in order of impacts, then of where its first impact is.
///
/// An error only where no run could go on.
pub fn search(machine: &Machine, wanted: &Search) -> Result<Vec<PeriodicOrbit>, SimulateError> {
    let mut found = Found { machine, wanted, orbits: Vec::new() };
    let mut error = None;
    if wanted.impacts.is_none_or(|impacts| impacts == 1) {
        for guess in one_impact(machine, wanted.revolutions) {
            found.close(&guess);
        }
    }
    for start in 0..LONG_RUNS {
        let angle = TAU * start as f64 / LONG_RUNS as f64;
        let speed = start as f64 / LONG_RUNS as f64 * velocity_scale(machine);
        error = found.settle(angle, speed).err().or(error);
    }
    if wanted.impacts != Some(1) {
        for angle in 0..START_ANGLES {
            for velocity in 0..START_VELOCITIES {
                // The middle of each cell, in angle and in the square of the velocity's part.
                let angle = TAU * (angle as f64 + 0.5) / START_ANGLES as f64;
                let part = (velocity as f64 + 0.5) / START_VELOCITIES as f64;
                error = found.shoot(angle, part * part * velocity_scale(machine)).err().or(error);
            }
        }
    }
    let Found { mut orbits, .. } = found;
    if let (true, Some(error)) = (orbits.is_empty(), error) {
        return Err(error);
    }
    let key = |orbit: &PeriodicOrbit| (orbit.impacts().count(), orbit.impacts().next().map_or(0.0, |e| e.cam_angle));
    orbits.sort_by(|one, two| key(one).0.cmp(&key(two).0).then(key(one).1.total_cmp(&key(two).1)));
    Ok(orbits)
}

/// A velocity that few impacts of the machine are faster than, m/s: a fall from rest over the size of its motion.
fn velocity_scale(machine: &Machine) -> f64 {
    let cam = machine.cam();
    let omega = machine.angular_velocity();
    let steepest = cam.segments().iter().flat_map(|segment| segment.bounds.slope).fold(0.0_f64, |s, b| s.max(b.abs()));
    let force = machine.flight().force(cam.top()).abs();
    // A flight of one revolution under that force, or the cam's own velocity.
    4.0 * omega * steepest + force * TAU / omega
}

struct Found<'a> {
    machine: &'a Machine,
    wanted: &'a Search,
    orbits: Vec<PeriodicOrbit>,
}

impl Found<'_> {
    fn keep(&mut self, orbit: PeriodicOrbit) {
        // A long run may settle on what repeats sooner.
        let wanted = orbit.revolutions == self.wanted.revolutions
            && self.wanted.impacts.is_none_or(|impacts| orbit.impacts().count() == impacts);
        if wanted && !self.orbits.iter().any(|known| known.is_same(&orbit)) {
            self.orbits.push(orbit);
        }
    }

    /// Newton's method from a guess; keeps what it leads to if that is an orbit of the cam as it is.
    fn close(&mut self, guess: &Cycle) {
        if let Some(orbit) = close(self.machine, guess) {
            self.keep(orbit);
        }
    }

    /// A long run, which settles on something stable.
    fn settle(&mut self, cam_angle: f64, relative_velocity: f64) -> Result<(), SimulateError> {
        let motion = self.machine.start_on_cam(cam_angle, relative_velocity)?;
        // A follower that comes to rest on the cam has settled: what comes after repeats at once.
        let early = settled(self.machine, motion, SETTLING_STICKING, self.wanted.revolutions)?;
        let sticks = early.as_ref().is_some_and(|orbit| matches!(orbit.course, Course::Sticking(_)));
        let settled = if sticks { early } else { settled(self.machine, motion, SETTLING, self.wanted.revolutions)? };
        if let Some(orbit) = settled {
            self.keep(orbit);
        }
        Ok(())
    }

    /// One period from the cam: its impacts are a guess.
    fn shoot(&mut self, cam_angle: f64, relative_velocity: f64) -> Result<(), SimulateError> {
        let mut motion = self.machine.start_on_cam(cam_angle, relative_velocity)?;
        let most = self.wanted.impacts.unwrap_or(MOST_IMPACTS);
        let events = period(self.machine, &mut motion, self.wanted.revolutions, most + 1)?;
        let count = events.iter().filter(|event| event.kind == EventKind::Impact).count();
        let sticks = events.iter().any(|event| event.kind == EventKind::Stick);
        if sticks || count == 0 || count > most + 1 {
            return Ok(());
        }
        self.close(&Cycle::of_events(self.wanted.revolutions, &events).in_order());
        Ok(())
    }
}

/// Guesses for every orbit of one impact in `revolutions`.
///
/// A flight of `T = 2 pi n/omega` from the cam at angle t back to it, with the responses s(T), p(T) and the force f at c(t),
/// leaves with `v+ = -f p/s` and comes back with `v- = v+ s' + f s`; the restitution law leaves one equation for t:
///
/// ```text
/// -f p (1 + r s') + r f s^2 - (1 + r) c' s = 0
/// ```
fn one_impact(machine: &Machine, revolutions: u64) -> Vec<Cycle> {
    let (omega, r) = (machine.angular_velocity(), machine.restitution());
    let response = machine.flight().response(revolutions as f64 * TAU / omega);
    let (p, s, s1) = (response.step, response.impulse, response.impulse_rate);
    let mut guesses = Vec::new();
    for (index, segment) in machine.cam().segments().iter().enumerate() {
        let equation = |angle: f64| {
            let lift = segment.law.lift(angle);
            let f = machine.flight().force(lift.value);
            -f * p * (1.0 + r * s1) + r * f * s * s - (1.0 + r) * omega * lift.slope * s
        };
        let at = |sample: usize| segment.start + (segment.end - segment.start) * sample as f64 / SAMPLES as f64;
        let mut before = equation(at(0));
        for sample in 1..=SAMPLES {
            let after = equation(at(sample));
            if (before < 0.0) != (after < 0.0) {
                // Newton's method goes on from here: a guess is enough.
                let changed = |angle: f64| Ok::<_, Infallible>((equation(angle) < 0.0) != (before < 0.0));
                let Ok([low, high]) = halve([at(sample - 1), at(sample)], Width::Halvings(20), changed);
                let cam_angle = 0.5 * (low + high);
                let f = machine.flight().force(segment.law.lift(cam_angle).value);
                let velocity_before = -f * p / s * s1 + f * s;
                if velocity_before.is_finite() {
                    let impact = Impact { revolution: 0, segment: index, cam_angle, velocity_before };
                    guesses.push(Cycle { revolutions, impacts: vec![impact] });
                }
            }
            before = after;
        }
    }
    guesses
}
