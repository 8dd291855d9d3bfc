//! Guesses at corner impacts of orbits with several impacts: orbits found at some speeds of a range, followed in small steps
//! of speed until an impact passes a corner.
//!
//! A search may miss orbits, and steps of speed end at a fold: what is yielded here need not be all.

use rayon::prelude::*;

use super::pinned::Candidate;
use crate::cam::{Cam, Corner, Side};
use crate::model::{Model, Study};
use crate::orbit::{Course, Cycle, Departure, Search, search};
use crate::simulate::{Machine, angular_velocity};

/// Speeds that orbits are searched for at, both ends among them.
const SPEEDS: usize = 17;
/// Steps between two of them, and halvings of a step that leads nowhere.
const STEPS: usize = 16;
const HALVINGS: usize = 8;

/// The guesses, and what was looked at.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Candidates {
    /// Each once or more.
    pub list: Vec<Candidate>,
    /// Speeds at which orbits were searched for, rpm.
    pub speeds: Vec<f64>,
    /// Orbits of several impacts that were found there.
    pub orbits: usize,
    /// The first search that ended with an error, if any did.
    pub failed: Option<String>,
}

/// Guesses over a range of speeds, for orbits of several impacts in `revolutions`.
pub fn candidates(model: &Model, cam: &Cam, range: Study, revolutions: u64) -> Candidates {
    let machine = Machine::new(cam.clone(), &model.follower, angular_velocity(range.rpm_min));
    let spacing = (range.rpm_max - range.rpm_min) / (SPEEDS - 1) as f64;
    let speeds: Vec<f64> = (0..SPEEDS).map(|index| range.rpm_min + spacing * index as f64).collect();
    let wanted = Search { revolutions, impacts: None };
    let searches = speeds.par_iter().map(|rpm| {
        let found = search(&machine.at_speed(angular_velocity(*rpm)), &wanted).map_err(|error| error.to_string())?;
        let cycles = found.into_iter().filter_map(|orbit| match orbit.course {
            Course::Impacts(cycle) if cycle.revolutions == revolutions && cycle.contacts.len() > 1 => Some(cycle),
            _ => None,
        });
        let corners = cam.corners();
        let cycles: Vec<Cycle> = cycles.filter(|cycle| cycle.contacts.len() <= Search::MOST_IMPACTS).collect();
        let mut list = Vec::new();
        for cycle in &cycles {
            for to in [rpm - spacing, rpm + spacing] {
                let follow = Follow { machine: &machine, corners: &corners, list: &mut list };
                follow.from(cycle.clone(), *rpm, to.clamp(range.rpm_min, range.rpm_max));
            }
        }
        Ok((list, cycles.len()))
    });
    let mut all = Candidates { speeds: speeds.clone(), ..Candidates::default() };
    for result in searches.collect::<Vec<Result<_, String>>>() {
        match result {
            Ok((list, orbits)) => {
                all.list.extend(list);
                all.orbits += orbits;
            }
            Err(error) => all.failed = all.failed.or(Some(error)),
        }
    }
    all
}

struct Follow<'a> {
    machine: &'a Machine,
    corners: &'a [Corner],
    list: &'a mut Vec<Candidate>,
}

impl Follow<'_> {
    /// Follows an orbit from one speed to another, rpm, as far as small steps lead.
    fn from(mut self, mut cycle: Cycle, mut rpm: f64, to: f64) {
        let mut step = (to - rpm) / STEPS as f64;
        let (least, mut left) = (step.abs() * 0.5_f64.powi(HALVINGS as i32), 2 * STEPS + 64);
        while (to - rpm) * step > 0.0 && left > 0 {
            left -= 1;
            let next = if (to - rpm).abs() <= step.abs() { to } else { rpm + step };
            match self.step(&cycle, next) {
                Some(moved) => (cycle, rpm) = (moved, next),
                None if step.abs() * 0.5 >= least => step *= 0.5,
                None => return,
            }
        }
    }

    /// The orbit at another speed, with each impact on its own segment; the corners passed on the way are noted.
    fn step(&mut self, cycle: &Cycle, rpm: f64) -> Option<Cycle> {
        let machine = self.machine.at_speed(angular_velocity(rpm));
        let is_corner = |segment: usize| self.corners.iter().any(|corner| corner.segment == segment);
        let mut cycle = cycle.closed(&machine).ok()?.0.renamed(&machine, is_corner);
        // Each turn moves an impact over one corner; more than there are corners lead nowhere.
        for _ in 0..=self.corners.len() {
            match cycle.departure(&machine).ok()? {
                None => return Some(cycle),
                Some(Departure::Beyond { contact }) => {
                    cycle = self.pass(&cycle, contact, rpm)?;
                    // At a corner of velocity, and where two orbits meet and vanish, there is none on the other side.
                    cycle = cycle.closed(&machine).ok()?.0.renamed(&machine, is_corner);
                }
                Some(_) => return None,
            }
        }
        None
    }

    /// Notes the corner that an impact has passed, and gives it the segment after.
    fn pass(&mut self, cycle: &Cycle, contact: usize, rpm: f64) -> Option<Cycle> {
        let segments = self.machine.cam().segments();
        let passed = cycle.contacts[contact];
        let upwards = passed.cam_angle >= segments[passed.segment].end;
        let meeting = if upwards { (passed.segment + 1) % segments.len() } else { passed.segment };
        let corner = *self.corners.iter().find(|corner| corner.segment == meeting)?;
        // Where the velocity jumps, both sides have an orbit on the corner, at speeds of their own.
        let own = if upwards { Side::Minus } else { Side::Plus };
        let side = if corner.jump_order == 1 { own } else { Side::Plus };
        self.list.push(Candidate { cycle: cycle.clone(), contact, corner, side, rpm });
        let mut moved = cycle.clone();
        let next = &mut moved.contacts[contact];
        let turn = std::f64::consts::TAU;
        if upwards {
            next.segment = meeting;
            if meeting == 0 {
                (next.cam_angle, next.revolution) = (next.cam_angle - turn, next.revolution + 1);
            }
        } else {
            next.segment = (meeting + segments.len() - 1) % segments.len();
            if meeting == 0 {
                (next.cam_angle, next.revolution) = (next.cam_angle + turn, next.revolution - 1);
            }
        }
        Some(moved)
    }
}
