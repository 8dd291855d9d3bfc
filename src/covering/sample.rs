//! Simulated impacts along a line and their returns: candidates for a proof.

use std::ops::ControlFlow;

use super::HSet;
use crate::simulate::{Event, EventKind, Machine, SimulateError};

/// Number of impacts that are followed after a start.
pub(super) const MOST_IMPACTS: usize = 8;

/// Impact in the coordinates of an h-set.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrival {
    /// Turns of the cam, chosen so that the angle is nearest to the h-set's.
    pub revolutions: i64,
    pub x: f64,
    pub y: f64,
}

/// Line along x, with the impacts that follow each of its points.
pub(crate) struct Line {
    /// Points of the line.
    pub x: Vec<f64>,
    /// Impacts that follow each point, in order, up to the first rest.
    pub arrivals: Vec<Vec<Arrival>>,
}

impl Line {
    /// Simulates points of an h-set at one y on a machine, each for up to this number of impacts.
    pub fn new(machine: &Machine, set: &HSet, y: f64, x: Vec<f64>, impacts: usize) -> Self {
        let arrivals = x.iter().map(|x| arrivals(machine, set, [*x, y], impacts).unwrap_or_default()).collect();
        Self { x, arrivals }
    }
}

/// Returns the impacts after a start; `None` if the follower cannot start there.
fn arrivals(machine: &Machine, set: &HSet, point: [f64; 2], impacts: usize) -> Option<Vec<Arrival>> {
    /// Longest simulation, turns of the cam.
    const MOST_REVOLUTIONS: u64 = 30;
    let [angle, velocity] = set.at(point);
    let start = angle.rem_euclid(360.0);
    if !(velocity > 0.0) {
        return None;
    }
    let mut motion = machine.start_on_cam(start.to_radians(), velocity).ok()?;
    let ([u0, u1], [s0, s1]) = (set.unstable, set.stable);
    let determinant = u0 * s1 - u1 * s0;
    let before = (angle - start) / 360.0;
    let mut found = Vec::new();
    let mut see = |event: &Event| {
        if event.kind != EventKind::Impact {
            return ControlFlow::Break(());
        }
        let angle = event.cam_angle.to_degrees() - set.centre[0];
        let turns = -(angle / 360.0).round();
        let (angle, velocity) = (angle + 360.0 * turns, event.velocity_after - event.cam_velocity - set.centre[1]);
        found.push(Arrival {
            revolutions: event.revolution as i64 + before as i64 - turns as i64,
            x: (angle * s1 - velocity * s0) / determinant,
            y: (velocity * u0 - angle * u1) / determinant,
        });
        if found.len() < impacts { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let goal = motion.after(MOST_REVOLUTIONS);
    let _ = machine.advance(&mut motion, goal, &mut see).ok()?;
    Some(found)
}

/// Part of a line that is carried across an h-set.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    pub impacts: usize,
    pub revolutions: u64,
    /// Range of x on the line; its ends are carried beyond the h-set.
    pub x: [f64; 2],
    /// Range of y of the images inside the h-set's range of x.
    pub y: [f64; 2],
}

impl Crossing {
    /// Smallest crossing that contains both.
    pub fn hull(&self, other: &Self) -> Self {
        let hull = |one: [f64; 2], two: [f64; 2]| [one[0].min(two[0]), one[1].max(two[1])];
        Self { x: hull(self.x, other.x), y: hull(self.y, other.y), ..*self }
    }
}

impl Line {
    /// Returns the parts within a range of x that are carried across that range after some impacts, without a jump.
    pub(super) fn crossings(&self, [low, high]: [f64; 2]) -> Vec<Crossing> {
        /// Smallest number of points of a crossing. With fewer, some may lie on the two sides of a jump.
        const FEWEST: usize = 6;
        let mut found = Vec::new();
        let from = self.x.partition_point(|x| *x <= low);
        let to = self.x.partition_point(|x| *x < high);
        for impacts in 1..=MOST_IMPACTS {
            // Side from which the image came, the last point on that side, and the number of points and the y since then.
            let mut last: Option<(bool, usize, i64)> = None;
            let (mut count, mut y) = (0, [f64::INFINITY, f64::NEG_INFINITY]);
            for index in from..to {
                let Some(arrival) = self.arrivals[index].get(impacts - 1) else {
                    last = None;
                    continue;
                };
                let side = (arrival.x <= low).then_some(true).or((arrival.x >= high).then_some(false));
                let Some(is_left) = side else {
                    count += 1;
                    y = [y[0].min(arrival.y), y[1].max(arrival.y)];
                    if last.is_some_and(|(_, _, revolutions)| revolutions != arrival.revolutions) {
                        last = None;
                    }
                    continue;
                };
                if let Some((was_left, begun, revolutions)) = last
                    && was_left != is_left
                    && revolutions == arrival.revolutions
                    && revolutions > 0
                    && count >= FEWEST
                {
                    let x = [self.x[begun], self.x[index]];
                    found.push(Crossing { impacts, revolutions: revolutions as u64, x, y });
                }
                last = Some((is_left, index, arrival.revolutions));
                (count, y) = (0, [f64::INFINITY, f64::NEG_INFINITY]);
            }
        }
        found
    }
}

/// Impacts, degrees of the cam and m/s relative to it, of a run that starts with an impact at an angle, rad, and a velocity.
pub(crate) fn impacts(
    machine: &Machine,
    [angle, velocity]: [f64; 2],
    settling: usize,
    shown: usize,
) -> Result<Vec<[f64; 2]>, SimulateError> {
    let mut impacts = Vec::new();
    let mut motion = machine.start_on_cam(angle, velocity)?;
    let mut see = |event: &Event| {
        if event.kind == EventKind::Impact {
            impacts.push([event.cam_angle.to_degrees(), event.velocity_after - event.cam_velocity]);
        }
        if impacts.len() < shown { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let goal = motion.after(shown as u64);
    let _ = machine.advance(&mut motion, goal, &mut see)?;
    impacts.drain(..settling.min(impacts.len()));
    Ok(impacts)
}
