//! Corner impacts by shots: a follower leaves a corner and returns to it a whole number of turns later, with the velocity with which it
//! left.
//!
//! There are two unknowns, the speed of the cam and the leaving velocity, however many impacts come between. At each speed of a grid the
//! follower leaves the corner with the velocities of a grid. A shot whose last impact is closer to the corner than at neighbouring
//! velocities is a guess for Newton's method on the equations of the whole orbit, with the speed free. The method searches no orbits and
//! follows no branches, so it can find what the branches miss, and vice versa.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use rayon::prelude::*;

use super::candidates::{MOST_IMPACTS, NEAREST_OTHER};
use super::confirm::Candidate;
use super::corner_impact::Way;
use super::period_equation::at_corner;
use crate::cam::{Cam, Corner, Side, apart};
use crate::elementary;
use crate::flight::State;
use crate::model::{Model, Study};
use crate::orbit::branch::Event as OnCorner;
use crate::orbit::cycle::lift_size;
use crate::orbit::search::velocity_scale;
use crate::orbit::{Cycle, Impact};
use crate::progress::{Pieces, Watch};
use crate::simulate::{Event, EventKind, Machine, angular_velocity};
use crate::tolerance;

/// Ratio of successive speeds of the grid.
pub const SHOT_RATIO: f64 = 1.004;
/// Number of leaving velocities at each speed of the grid.
pub const VELOCITIES: usize = 400;
/// Largest factor by which Newton's method may change the speed. Shots extend beyond a range by this factor, so that the results for a part
/// of a range are the same as for the whole.
const REACH: f64 = 1.02;
/// Largest distance of the last impact of a guess from the corner, rad.
const NEAR: f64 = 0.3;

/// Finds corner impacts of orbits with several impacts in `revolutions` by shots, over a range of speeds and a little beyond.
pub fn shots(
    model: &Model,
    cam: &Cam,
    corners: &[Corner],
    range: Study,
    revolutions: u64,
    watch: &dyn Watch,
) -> Vec<Candidate> {
    let machine = Machine::new(cam.clone(), &model.follower, angular_velocity(1.0));
    let step = |rpm: f64| elementary::ln(rpm) / elementary::ln(SHOT_RATIO);
    let first = step(range.rpm_min / REACH).floor() as i32;
    let speeds = first..=step(range.rpm_max * REACH).ceil() as i32;
    let pieces = Pieces::new(watch, "shots from the corners", speeds.clone().count() * corners.len());
    let at = |index: i32| {
        let rpm = elementary::powf(SHOT_RATIO, f64::from(index) + 0.5);
        let machine = machine.at_speed(angular_velocity(rpm));
        let (fastest, size) = (velocity_scale(&machine) / machine.angular_velocity(), lift_size(&machine));
        let of_corner = |corner: &Corner| {
            let sides = if corner.jump_order == 1 { &[Side::Minus, Side::Plus][..] } else { &[Side::Plus] };
            let shooter = |side: &Side| {
                let (machine, corner, side) = (&machine, *corner, *side);
                Shooter { model, machine, rpm, corner, side, revolutions, fastest, size }
            };
            sides.iter().flat_map(|side| shooter(side).corner_impacts()).collect::<Vec<_>>()
        };
        corners.iter().flat_map(|corner| pieces.each(|| of_corner(corner))).collect::<Vec<_>>()
    };
    speeds.into_par_iter().flat_map_iter(at).collect()
}

/// Shots from one side of a corner at one speed.
struct Shooter<'a> {
    model: &'a Model,
    machine: &'a Machine,
    rpm: f64,
    corner: Corner,
    side: Side,
    revolutions: u64,
    /// Largest leaving velocity, over omega, m/rad.
    fastest: f64,
    /// Size of the cam's lift, m.
    size: f64,
}

/// Impact that may close a shot into an orbit.
#[derive(Clone, Copy)]
struct Closing {
    /// Number of impacts of the orbit that it would close.
    impacts: usize,
    /// Miss: the angle to the corner, rad, plus the difference of its velocity from the leaving velocity, over omega and the cam's size.
    off: f64,
}

impl Shooter<'_> {
    fn slope(&self) -> f64 {
        match self.side {
            Side::Minus => self.corner.minus.slope,
            Side::Plus => self.corner.plus.slope,
        }
    }

    /// Leaving velocity over omega, m/rad. The grid is finer at low velocities, since a slow follower soon hits again.
    fn leaving(&self, index: usize) -> f64 {
        let part = (index as f64 + 0.5) / VELOCITIES as f64;
        part * part * self.fastest
    }

    /// Impacts after the start, up to the first one after a period; fewer if the follower sticks or chatters.
    fn impacts(&self, leaving: f64) -> Vec<Event> {
        let mut impacts = Vec::new();
        let velocity = self.machine.angular_velocity() * (self.slope() + leaving);
        let state = State { position: self.corner.plus.value, velocity };
        let Ok(mut motion) = self.machine.start(self.corner.angle, state) else { return impacts };
        let (most, end) = (MOST_IMPACTS * self.revolutions as usize, self.revolutions as f64 * TAU);
        let goal = motion.after(self.revolutions + 1);
        // A run that fails has not returned.
        let _ = self.machine.advance(&mut motion, goal, &mut |event: &Event| {
            if event.kind != EventKind::Impact || impacts.len() > most {
                return ControlFlow::Break(());
            }
            impacts.push(*event);
            if event.turned_since(self.corner.angle) > end { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        impacts
    }

    /// Closings by the last impact before the corner returns, and by the first one after.
    fn closings(&self, leaving: f64) -> [Option<Closing>; 2] {
        let impacts = self.impacts(leaving);
        let omega = self.machine.angular_velocity();
        let closing = |count: usize| {
            let event = impacts.get(count.checked_sub(1)?)?;
            let angle = (event.turned_since(self.corner.angle) - self.revolutions as f64 * TAU).abs();
            let velocity = ((event.velocity_after - event.cam_velocity) / omega - leaving).abs() / self.size;
            (count > 1 && angle < NEAR).then_some(Closing { impacts: count, off: angle + velocity })
        };
        [impacts.len().saturating_sub(1), impacts.len()].map(closing)
    }

    fn corner_impacts(&self) -> Vec<Candidate> {
        let all: Vec<_> = (0..VELOCITIES).map(|index| self.closings(self.leaving(index))).collect();
        let off = |index: usize, impacts: usize| {
            let closings = all.get(index).into_iter().flatten().flatten();
            closings.filter(|closing| closing.impacts == impacts).fold(f64::INFINITY, |least, one| least.min(one.off))
        };
        let is_least = |index: usize, closing: &Closing| {
            closing.off <= off(index.wrapping_sub(1), closing.impacts) && closing.off <= off(index + 1, closing.impacts)
        };
        let guesses =
            all.iter().enumerate().flat_map(|(index, closings)| closings.iter().flatten().map(move |one| (index, one)));
        let least = guesses.filter(|(index, closing)| is_least(*index, closing));
        least.filter_map(|(index, closing)| self.solved(self.leaving(index), closing.impacts)).collect()
    }

    /// Runs Newton's method from a shot that closes with its impact number `impacts`.
    fn solved(&self, leaving: f64, impacts: usize) -> Option<Candidate> {
        let (cam, omega, r) = (self.machine.cam(), self.machine.angular_velocity(), self.machine.restitution());
        // v+ = (1 + r) c' - r v-
        let velocity_before = omega * (self.slope() - leaving / r);
        let first = at_corner(cam, &self.corner, self.side, 0, velocity_before);
        let mut guess = Cycle::of_events(self.revolutions, self.impacts(leaving).get(..impacts - 1)?);
        guess.impacts.insert(0, first);
        let at_end = self.side == Side::Minus;
        let on_corner = OnCorner::of_corner(self.machine, self.rpm, &guess, 0, at_end);
        let (mut cycle, rpm) = on_corner.solved(self.model, cam)?;
        let is_near = (rpm / self.rpm).max(self.rpm / rpm) <= REACH;
        if !is_near || cycle.nearest_other(0) < NEAREST_OTHER {
            return None;
        }
        let Impact { cam_angle, velocity_before, .. } = cycle.impacts[0];
        cycle.impacts[0] = at_corner(cam, &self.corner, self.side, 0, velocity_before);
        let machine = self.machine.at_speed(angular_velocity(rpm));
        cycle.departure(&machine).is_ok_and(|departure| departure.is_none()).then(|| {
            let (period, width) = (60.0 / rpm, tolerance::CYCLE_CLOSED.value);
            let impact = cycle.place_in_order(0);
            let cycle = cycle.in_order();
            Candidate {
                impact,
                corner: self.corner,
                side: self.side,
                period,
                bracket: [period * (1.0 - width), period * (1.0 + width)],
                residual: apart(cam_angle, self.corner.angle),
                cycle,
                way: Way::Shot,
            }
        })
    }
}
