//! Growth of small deviations from the variational flow, which gives Lyapunov exponents in the limit.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use nalgebra::Vector2;

use super::{Event, EventKind, Goal, ImpactTally, Machine, Motion, Observer, SimulateError};
use crate::cam::Lift;
use crate::elementary;
use crate::estimate::Estimate;
use crate::flight::{Response, State};
use crate::impact::ImpactRates;

/// Mean growth of a small deviation per revolution, as a natural logarithm: the largest Lyapunov exponent in the limit of many
/// `revolutions`.
///
/// Minus infinity if the follower sticks to the cam, even if only once in thousands of revolutions: the deviation then vanishes, and the
/// motion repeats its course after the stick. Before such a stick a chaotic motion has the same growth as without it. A start on the cam
/// counts from its release. Zero revolutions have zero growth.
#[doc(hidden)]
pub fn growth(machine: &Machine, mut motion: Motion, revolutions: u64) -> Result<f64, SimulateError> {
    let mut record = Record::over(revolutions.max(1));
    record.take(machine, &mut motion, revolutions)?;
    // One block of all revolutions, unless the follower sticks in it or there are no revolutions.
    Ok(match record.means.of_blocks.as_slice() {
        [mean] => *mean,
        _ => record.means.sum,
    })
}

/// Initial deviation, its angle in rad and its velocity over the angle in m/rad: almost any direction has a part along the fastest growth.
const ANY: Vector2<f64> = Vector2::new(0.6, 0.8);

/// Record of a run that does not repeat.
#[derive(Clone, Debug)]
#[doc(hidden)]
pub struct Record {
    means: Means,
    /// Direction of the deviation, carried from one part of the record to the next.
    direction: Vector2<f64>,
    /// Impacts of whole revolutions.
    pub met: ImpactTally,
    /// Number of revolutions.
    pub revolutions: u64,
}

impl Record {
    /// Returns an empty record, whose growth is computed in blocks of `per_block` revolutions.
    pub fn over(per_block: u64) -> Self {
        Self { means: Means::over(per_block), direction: ANY, met: ImpactTally::default(), revolutions: 0 }
    }

    /// Continues the record for `revolutions`, or until the follower sticks; `motion` must be where the record ended.
    pub fn take(&mut self, machine: &Machine, motion: &mut Motion, revolutions: u64) -> Result<(), SimulateError> {
        let begun = motion.revolution;
        if revolutions > 0 && !is_released(machine, motion, revolutions)? {
            self.means.take(1, f64::NEG_INFINITY);
        } else {
            let mut left = revolutions;
            while left > 0 {
                let turns = left.min(self.means.per_block - self.means.seen);
                let grown = self.carry(machine, motion, turns)?;
                self.means.take(turns, grown);
                // The deviation has vanished.
                left = if grown == f64::NEG_INFINITY { 0 } else { left - turns };
            }
        }
        self.revolutions += motion.revolution - begun;
        Ok(())
    }

    /// Growth of the deviation over this number of revolutions; minus infinity if the follower sticks, which ends the run after that
    /// revolution.
    fn carry(&mut self, machine: &Machine, motion: &mut Motion, revolutions: u64) -> Result<f64, SimulateError> {
        let mut carried = Carried::new(machine, motion, self.direction, &mut self.met);
        let flow = machine.advance(motion, motion.after(revolutions), &mut carried)?;
        if flow.is_break() {
            let _ = machine.advance(motion, motion.next(carried.begun.cam_angle), &mut |event: &Event| {
                carried.met.take(event);
                ControlFlow::Continue(())
            })?;
            return Ok(f64::NEG_INFINITY);
        }
        let (direction, grown) = carried.ended(motion);
        if grown > f64::NEG_INFINITY {
            self.direction = direction;
        }
        Ok(grown)
    }

    /// Mean growth per revolution over the complete blocks. Its error is NaN for fewer than two blocks.
    pub fn growth(&self) -> Estimate {
        Estimate::of_parts(&self.means.of_blocks)
    }

    /// Largest growth of a deviation from the beginning of any block to the end of any later one. A deviation that shrinks in the end may
    /// have been as large as the motion in between.
    pub fn most(&self) -> f64 {
        let grown = |(most, here): (f64, f64), block: &f64| {
            let here = (here + block * self.means.per_block as f64).max(0.0);
            (here.max(most), here)
        };
        self.means.of_blocks.iter().fold((0.0, 0.0), grown).0
    }

    /// Growth of a deviation over the first and the second half of the complete blocks, as natural logarithms.
    pub fn halves(&self) -> [f64; 2] {
        let blocks = &self.means.of_blocks;
        let grown = |blocks: &[f64]| self.means.per_block as f64 * blocks.iter().sum::<f64>();
        let (first, second) = blocks.split_at(blocks.len() / 2);
        [grown(first), grown(second)]
    }

    /// Whether the record ended with the follower sticking.
    pub fn rests(&self) -> bool {
        self.means.sum == f64::NEG_INFINITY
    }
}

/// Whether the follower is off the cam, or the cam releases it within this number of revolutions; then `motion` is at the release.
fn is_released(machine: &Machine, motion: &mut Motion, revolutions: u64) -> Result<bool, SimulateError> {
    if !motion.contact {
        return Ok(true);
    }
    let flow = machine.advance(motion, motion.after(revolutions), &mut |event: &Event| match event.kind {
        EventKind::Release => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    })?;
    Ok(flow.is_break())
}

/// Small deviation that is carried along a run from impact to impact. It ends the run where the follower sticks.
struct Carried<'a> {
    machine: &'a Machine,
    met: &'a mut ImpactTally,
    begun: Goal,
    /// Deviation of the position, and of the velocity over the angular velocity, after the last impact.
    deviation: Vector2<f64>,
    /// Growth up to the last rescaling, a natural logarithm.
    grown: f64,
    /// Cam and follower right after the last impact.
    at: Goal,
    state: State,
    /// Curvature of the lift at the next impact, m/rad^2.
    curvature: f64,
}

impl<'a> Carried<'a> {
    fn new(machine: &'a Machine, motion: &Motion, direction: Vector2<f64>, met: &'a mut ImpactTally) -> Self {
        let begun = motion.after(0);
        Self {
            machine,
            met,
            begun,
            deviation: direction,
            grown: 0.0,
            at: begun,
            state: motion.state,
            curvature: f64::NAN,
        }
    }

    /// Time of the flight from the last impact to `to`, s.
    fn time_to(&self, to: Goal) -> f64 {
        let turns = to.revolution as f64 - self.at.revolution as f64;
        let turned = turns * TAU + (to.cam_angle - self.at.cam_angle);
        turned / self.machine.angular_velocity()
    }

    /// Deviation after a flight with these responses.
    fn flown(&self, response: &Response) -> Vector2<f64> {
        let (omega, [position, velocity]) = (self.machine.angular_velocity(), self.deviation.into());
        let matrix = self.machine.flight().propagator_by(response);
        Vector2::new(
            matrix[(0, 0)] * position + matrix[(0, 1)] * omega * velocity,
            matrix[(1, 0)] / omega * position + matrix[(1, 1)] * velocity,
        )
    }

    /// Direction of the deviation at the end of the run, and its growth.
    fn ended(mut self, motion: &Motion) -> (Vector2<f64>, f64) {
        let response = self.machine.flight().response(self.time_to(motion.after(0)));
        self.deviation = self.flown(&response);
        self.rescale();
        (self.deviation, self.grown)
    }

    fn rescale(&mut self) {
        let size = self.deviation.norm();
        self.grown += elementary::ln(size);
        // A deviation of 0 stays 0.
        if size > 0.0 {
            self.deviation /= size;
        }
    }
}

impl Observer for Carried<'_> {
    fn strikes(&mut self, lift: &Lift) {
        self.curvature = lift.curvature;
    }

    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        /// Squared size above which, or below whose inverse, the deviation is rescaled; far from the limits of a double.
        const LARGE: f64 = 1e100;
        self.met.take(event);
        match event.kind {
            EventKind::Impact => {}
            EventKind::Stick => return ControlFlow::Break(()),
            EventKind::Release => return ControlFlow::Continue(()),
        }
        let (flight, omega) = (self.machine.flight(), self.machine.angular_velocity());
        let at = Goal { revolution: event.revolution, cam_angle: event.cam_angle };
        let [before, after] =
            [event.velocity_before, event.velocity_after].map(|velocity| State { position: event.position, velocity });
        let response = flight.response_between(self.state, before, || self.time_to(at));
        let rates = ImpactRates {
            restitution: self.machine.restitution(),
            velocity_before: before.velocity,
            acceleration_before: flight.acceleration(before),
            acceleration_after: flight.acceleration(after),
            cam_velocity: event.cam_velocity,
            cam_acceleration: omega * omega * self.curvature,
        };
        let [position, velocity] = self.flown(&response).into();
        let [[a, _], [c, d]] = rates.saltation_rows();
        self.deviation = Vector2::new(a * position, c / omega * position + d * velocity);
        (self.at, self.state) = (at, after);
        if !(1.0 / LARGE..LARGE).contains(&self.deviation.norm_squared()) {
            self.rescale();
        }
        ControlFlow::Continue(())
    }
}

/// Mean growth of each complete block of revolutions.
#[derive(Clone, Debug)]
struct Means {
    per_block: u64,
    of_blocks: Vec<f64>,
    /// Growth over the incomplete block.
    sum: f64,
    seen: u64,
}

impl Means {
    fn over(per_block: u64) -> Self {
        Self { per_block, of_blocks: Vec::new(), sum: 0.0, seen: 0 }
    }

    /// Adds the growth over some revolutions, at most those left in the block.
    fn take(&mut self, revolutions: u64, grown: f64) {
        (self.sum, self.seen) = (self.sum + grown, self.seen + revolutions);
        if self.seen == self.per_block && self.sum > f64::NEG_INFINITY {
            self.of_blocks.push(self.sum / self.per_block as f64);
            (self.sum, self.seen) = (0.0, 0);
        }
    }
}
