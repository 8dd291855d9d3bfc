//! Orbits of one machine, stable or not.
//!
//! Orbits of one impact, and of two in one revolution where they are asked for, are all found, by enclosures. Of the others two
//! ways each find what the other may miss: long runs settle on stable orbits, and short runs from many starts on the cam give
//! Newton's method the guesses from which it finds unstable ones. The follower at rest above the cam is known in closed form.

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

/// Which orbits are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Search {
    /// Turns of the cam in one period, the smallest number.
    pub revolutions: u64,
    /// Impacts in one period; any number where there is none given.
    pub impacts: Option<usize>,
}

impl Search {
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

/// The orbits that a search found, and which of them are all there are.
#[derive(Clone, Debug)]
pub struct Searched {
    /// In order of impacts, then of where the first one is.
    pub orbits: Vec<PeriodicOrbit>,
    /// For which numbers of impacts they are all there is.
    pub complete: Vec<Complete>,
    /// Where that could not be decided.
    pub undecided: Vec<Undecided>,
}

/// Every orbit that was found, in order of impacts, then of where its first impact is.
///
/// An error only where no run could go on.
pub fn search(machine: &Machine, wanted: &Search) -> Result<Vec<PeriodicOrbit>, SimulateError> {
    let found = Found::new(machine, wanted);
    found.search().map(|searched| searched.orbits)
}

/// The same with all of two impacts in one revolution, where they are among the wanted, which takes seconds.
pub fn search_all(machine: &Machine, wanted: &Search, watch: &dyn Watch) -> Result<Searched, SimulateError> {
    let mut found = Found::new(machine, wanted);
    if wanted.revolutions == 1 && wanted.impacts.is_none_or(|impacts| impacts == 2) {
        found.all(2, of_two_impacts(machine, watch));
    }
    watch.at("orbits that runs settle on, or lead near to", 0, 0);
    found.search()
}

/// A velocity that few impacts of the machine are faster than, m/s: a fall from rest over the size of its motion.
pub(crate) fn velocity_scale(machine: &Machine) -> f64 {
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

    /// Everything that solves the equations of so many impacts, or may.
    fn all(&mut self, impacts: usize, solved: Vec<Solved>) {
        let mut undecided = Vec::new();
        for Solved { guess, angles, velocities, standing } in solved {
            if standing == Standing::NoOrbit {
                continue;
            }
            // Newton's method gives the digits; where it leads elsewhere, they are not those of what is proved.
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
                // Two that are proved are two, however near to each other.
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

    /// The other ways, and everything in order.
    fn search(mut self) -> Result<Searched, SimulateError> {
        let mut error = None;
        // The equilibrium, if the cam does not reach it: no run from the cam need come to it.
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
                    // The middle of each cell, in angle and in the square of the velocity's part.
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

    fn keep(&mut self, orbit: PeriodicOrbit) {
        // A long run may settle on what repeats sooner.
        let wanted = orbit.revolutions == self.wanted.revolutions
            && self.wanted.impacts.is_none_or(|impacts| orbit.impacts().count() == impacts);
        if wanted && !self.searched.orbits.iter().any(|known| known.is_same(&orbit)) {
            self.searched.orbits.push(orbit);
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
        let early = near_run(self.machine, motion, SETTLING_STICKING, self.wanted.revolutions)?;
        let sticks = early.as_ref().is_some_and(|orbit| matches!(orbit.course, Course::Sticking(_)));
        let settled = if sticks { early } else { near_run(self.machine, motion, SETTLING, self.wanted.revolutions)? };
        if let Some(orbit) = settled {
            self.keep(orbit);
        }
        Ok(())
    }

    /// One period from the cam: its impacts are a guess.
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
