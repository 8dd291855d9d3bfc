//! Finds orbits of one machine, stable or not.
//!
//! Enclosures find all orbits of one impact, and where requested all of two in one revolution. For the others there are two methods, and
//! each finds orbits that the other may miss. Long runs settle on stable orbits. Short runs from many starts on the cam give Newton's
//! method the guesses from which it finds unstable ones. The follower at rest above the cam is known in closed form.

use std::f64::consts::TAU;

use super::complete::{Solved, Standing, Undecided, joined, of_one_impact, of_two_impacts};
use super::near::{MOST_IMPACTS, close, free, near_run, period};
use super::{Course, Cycle, Judgement, PeriodicOrbit};
use crate::flight::State;
use crate::interval::Interval;
use crate::known::{Complete, Evidence};
use crate::progress::Watch;
use crate::simulate::{EventKind, Machine, SimulateError};
use crate::tolerance;

/// Orbits to be looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Search {
    /// Turns of the cam in one period, the smallest number.
    pub revolutions: u64,
    /// Impacts in one period; `None` for any number.
    pub impacts: Option<usize>,
}

impl Search {
    /// Longest period of an orbit that is looked for, revolutions.
    pub const MOST_REVOLUTIONS: u64 = 1000;
}

/// Cam angles that short runs start at, and velocities at each.
const START_ANGLES: usize = 60;
const START_VELOCITIES: usize = 20;
/// Number of long runs, and revolutions in which they settle.
const LONG_RUNS: usize = 6;
const SETTLING: u64 = 600;
/// Revolutions within which a run that comes to rest on the cam settles.
const SETTLING_STICKING: u64 = 6;

/// Orbits found by a search, with the completeness of the list.
#[derive(Clone, Debug)]
pub struct Searched {
    /// Sorted by the number of impacts, then by the angle of the first impact.
    pub orbits: Vec<PeriodicOrbit>,
    /// Numbers of impacts for which all orbits were looked for, and whether the list is proved complete.
    pub complete: Vec<Complete>,
    /// Angles at which orbits may be missing.
    pub undecided: Vec<Undecided>,
}

/// Returns every orbit found, sorted by the number of impacts, then by the angle of the first impact.
///
/// Fails only if no orbit was found and a run could not go on.
pub fn search(machine: &Machine, wanted: &Search) -> Result<Vec<PeriodicOrbit>, SimulateError> {
    let found = Found::new(machine, wanted);
    found.search().map(|searched| searched.orbits)
}

/// Searches as `search` does, and also finds all orbits of two impacts in one revolution, if these are wanted. This takes seconds.
pub fn search_all(machine: &Machine, wanted: &Search, watch: &dyn Watch) -> Result<Searched, SimulateError> {
    let mut found = Found::new(machine, wanted);
    if wanted.revolutions == 1 && wanted.impacts.is_none_or(|impacts| impacts == 2) {
        found.all(2, of_two_impacts(machine, watch));
    }
    watch.at("orbits that runs settle on or pass near", 0, 0);
    found.search()
}

/// Velocity that few impacts of the machine exceed, m/s: four times the cam's largest, plus the velocity gained in one revolution under the
/// force at the top.
#[doc(hidden)]
pub fn velocity_scale(machine: &Machine) -> f64 {
    let cam = machine.cam();
    let omega = machine.angular_velocity();
    let steepest = cam.segments().iter().flat_map(|segment| segment.bounds.slope).fold(0.0_f64, |s, b| s.max(b.abs()));
    let force = machine.flight().force(cam.top()).abs();
    // The cam's own velocity, and a flight of one revolution under that force.
    4.0 * omega * steepest + force * TAU / omega
}

struct Found<'a> {
    machine: &'a Machine,
    wanted: &'a Search,
    searched: Searched,
}

impl<'a> Found<'a> {
    fn new(machine: &'a Machine, wanted: &'a Search) -> Self {
        let searched = Searched { orbits: Vec::new(), complete: Vec::new(), undecided: Vec::new() };
        let mut found = Self { machine, wanted, searched };
        if wanted.impacts.is_none_or(|impacts| impacts == 1) {
            found.all(1, of_one_impact(machine, wanted.revolutions));
        }
        found
    }

    /// Adds the certain and the possible solutions of the equations of `impacts` impacts.
    fn all(&mut self, impacts: usize, solved: Vec<Solved>) {
        let mut undecided = Vec::new();
        for Solved { guess, angles, velocities, standing } in solved {
            if standing == Standing::NoOrbit {
                continue;
            }
            // Newton's method gives the digits. If it converges elsewhere, they do not belong to the proved orbit.
            let orbit = close(self.machine, &guess);
            let places: Vec<_> =
                angles.iter().copied().zip(velocities).map(|(angle, before)| [angle, before]).collect();
            let proved = Judgement::proved(self.machine, &guess, &places);
            let guess = guess.in_order();
            let is_at = |cycle: &Cycle| {
                let pairs = cycle.impacts.iter().zip(&guess.impacts);
                pairs.fold(0.0, |apart: f64, (one, other)| apart.max((one.cam_angle - other.cam_angle).abs()))
                    <= tolerance::CYCLE_CLOSED.value
            };
            match orbit {
                // Two proved orbits are distinct, however near to each other.
                Some(orbit)
                    if standing == Standing::Orbit && matches!(&orbit.course, Course::Impacts(it) if is_at(it)) =>
                {
                    let judgement = proved.map_or(orbit.judgement, |stability| Judgement {
                        stability,
                        known: Evidence::Proved,
                        ..orbit.judgement
                    });
                    self.searched.orbits.push(PeriodicOrbit { known: Evidence::Proved, judgement, ..orbit });
                    continue;
                }
                orbit => orbit.into_iter().for_each(|orbit| self.keep(orbit)),
            }
            undecided.push(angles);
        }
        let known = if undecided.is_empty() { Evidence::Proved } else { Evidence::Sampled };
        let ends = |angles: Vec<Interval>| angles.iter().map(|angle| [angle.low(), angle.high()]).collect();
        let ranges = joined(undecided).into_iter().map(|angles| Undecided { cam_angles: ends(angles) });
        self.searched.undecided.extend(ranges);
        let revolutions = self.wanted.revolutions;
        self.searched.complete.push(Complete { revolutions, impacts, known });
    }

    /// Adds the follower at rest above the cam and the orbits that runs find, and sorts all.
    fn search(mut self) -> Result<Searched, SimulateError> {
        let mut error = None;
        // The equilibrium above the cam: runs from the cam need not converge to it.
        let state = State { position: self.machine.cam().top(), velocity: 0.0 };
        if self.machine.flight().omega0_squared() > 0.0 {
            free(self.machine, state).into_iter().for_each(|orbit| self.keep(orbit));
        }
        for start in 0..LONG_RUNS {
            let angle = TAU * start as f64 / LONG_RUNS as f64;
            let speed = start as f64 / LONG_RUNS as f64 * velocity_scale(self.machine);
            error = self.settle(angle, speed).err().or(error);
        }
        if self.wanted.impacts != Some(1) {
            for angle in 0..START_ANGLES {
                for velocity in 0..START_VELOCITIES {
                    // The middle of each cell, in the angle and in the square root of the velocity.
                    let angle = TAU * (angle as f64 + 0.5) / START_ANGLES as f64;
                    let part = (velocity as f64 + 0.5) / START_VELOCITIES as f64;
                    error = self.shoot(angle, part * part * velocity_scale(self.machine)).err().or(error);
                }
            }
        }
        let Searched { orbits, .. } = &mut self.searched;
        if let (true, Some(error)) = (orbits.is_empty(), error) {
            return Err(error);
        }
        let key =
            |orbit: &PeriodicOrbit| (orbit.impacts().count(), orbit.impacts().next().map_or(0.0, |e| e.cam_angle));
        orbits.sort_by(|one, two| key(one).0.cmp(&key(two).0).then(key(one).1.total_cmp(&key(two).1)));
        Ok(self.searched)
    }

    /// Adds an orbit that was found without a proof, unless it is known or the list of its kind is proved to be complete. Next to a
    /// corner, Newton's method also finds an orbit that exists within rounding alone.
    fn keep(&mut self, orbit: PeriodicOrbit) {
        let impacts = orbit.impacts().count();
        let is_listed = |complete: &Complete| complete.known == Evidence::Proved && complete.impacts == impacts;
        if matches!(orbit.course, Course::Impacts(_)) && self.searched.complete.iter().any(is_listed) {
            return;
        }
        // A long run may settle on an orbit that repeats sooner.
        let wanted =
            orbit.revolutions == self.wanted.revolutions && self.wanted.impacts.is_none_or(|wanted| impacts == wanted);
        if wanted && !self.searched.orbits.iter().any(|known| known.is_same(&orbit)) {
            self.searched.orbits.push(orbit);
        }
    }

    /// Applies Newton's method to a guess. Keeps the result if it is an orbit of the actual cam.
    fn close(&mut self, guess: &Cycle) {
        if let Some(orbit) = close(self.machine, guess) {
            self.keep(orbit);
        }
    }

    /// Keeps the orbit on which a long run settles.
    fn settle(&mut self, cam_angle: f64, relative_velocity: f64) -> Result<(), SimulateError> {
        let motion = self.machine.start_on_cam(cam_angle, relative_velocity)?;
        // A follower that comes to rest on the cam has settled: the motion after that repeats at once.
        let early = near_run(self.machine, motion, SETTLING_STICKING, self.wanted.revolutions)?;
        let sticks = early.as_ref().is_some_and(|orbit| matches!(orbit.course, Course::Sticking(_)));
        let settled = if sticks { early } else { near_run(self.machine, motion, SETTLING, self.wanted.revolutions)? };
        if let Some(orbit) = settled {
            self.keep(orbit);
        }
        Ok(())
    }

    /// Runs one period from the cam, and takes its impacts as a guess.
    fn shoot(&mut self, cam_angle: f64, relative_velocity: f64) -> Result<(), SimulateError> {
        let mut motion = self.machine.start_on_cam(cam_angle, relative_velocity)?;
        let most = self.wanted.impacts.unwrap_or(MOST_IMPACTS);
        let events = period(self.machine, &mut motion, self.wanted.revolutions, most)?;
        let sticks = events.iter().any(|event| event.kind == EventKind::Stick);
        if !sticks && events.len() <= most {
            self.close(&Cycle::of_events(self.wanted.revolutions, &events).in_order());
        }
        Ok(())
    }
}
