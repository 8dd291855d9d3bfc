//! Growth of small deviations, from the variational flow: Lyapunov exponents in the limit.

use std::ops::ControlFlow;

use nalgebra::{Matrix2, Vector2};

use super::{Event, EventKind, Machine, Met, Motion, Observer, SimulateError, Variation};
use crate::elementary;
use crate::estimate::Estimate;
use crate::flight::{Flight, State};

/// The mean growth of a small deviation per revolution, as a natural logarithm: the largest Lyapunov exponent in the limit
/// of many `revolutions`.
///
/// Minus infinity where the follower comes to stick to the cam, be it once in thousands of revolutions: nothing is left of a
/// deviation then, and what follows repeats what followed the stick before. Until such a stick a chaotic motion has the
/// number that it would have without. A start on the cam counts from its release on; in no revolution nothing grows.
pub fn growth(machine: &Machine, mut motion: Motion, revolutions: u64) -> Result<f64, SimulateError> {
    let (mut sum, mut direction) = (0.0, ANY);
    let met = &mut Met::default();
    stretches(machine, &mut motion, revolutions, (met, &mut direction), |stretch| sum += stretch)?;
    Ok(sum / revolutions.max(1) as f64)
}

/// A deviation to begin with, its angle in rad and its velocity over the angle in m/rad: any has a part along what grows most.
const ANY: Vector2<f64> = Vector2::new(0.6, 0.8);

/// What is seen of a run that does not repeat, for as long as it is looked at.
#[derive(Clone, Debug)]
pub struct Record {
    means: Means,
    /// The direction of the deviation, carried from one part of the record to the next.
    direction: Vector2<f64>,
    /// The impacts, of whole revolutions.
    pub met: Met,
    /// How many revolutions.
    pub revolutions: u64,
}

impl Record {
    /// Nothing yet, of which the growth will be taken in blocks of so many revolutions.
    pub fn over(per_block: u64) -> Self {
        Self { means: Means::over(per_block), direction: ANY, met: Met::default(), revolutions: 0 }
    }

    /// Goes on for so many revolutions, or to where the follower comes to stick: from `motion`, which is where it was left.
    pub fn take(&mut self, machine: &Machine, motion: &mut Motion, revolutions: u64) -> Result<(), SimulateError> {
        let begun = motion.revolution;
        let seen = (&mut self.met, &mut self.direction);
        stretches(machine, motion, revolutions, seen, |stretch| self.means.take(stretch))?;
        self.revolutions += motion.revolution - begun;
        Ok(())
    }

    /// The mean growth a revolution over the blocks that are over; neither it nor its error is a number for fewer than two.
    pub fn growth(&self) -> Estimate {
        Estimate::of_parts(&self.means.of_blocks)
    }

    /// What a deviation grows by at most from the beginning of any block to the end of any later one: what shrinks in the end may
    /// have been as large as the motion on the way.
    pub fn most(&self) -> f64 {
        let grown = |(most, here): (f64, f64), block: &f64| {
            let here = (here + block * self.means.per_block as f64).max(0.0);
            (here.max(most), here)
        };
        self.means.of_blocks.iter().fold((0.0, 0.0), grown).0
    }

    /// Growth of a deviation over the first half of the blocks that are over, and over the second; a natural logarithm.
    pub fn halves(&self) -> [f64; 2] {
        let blocks = &self.means.of_blocks;
        let grown = |blocks: &[f64]| self.means.per_block as f64 * blocks.iter().sum::<f64>();
        let (first, second) = blocks.split_at(blocks.len() / 2);
        [grown(first), grown(second)]
    }

    /// Whether it ended where the follower came to stick.
    pub fn rests(&self) -> bool {
        self.means.sum == f64::NEG_INFINITY
    }
}

/// Counts impacts beside the variation.
struct Counting<'a, 'machine>(&'a mut Variation<'machine>, &'a mut Met);

impl Observer for Counting<'_, '_> {
    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        self.1.take(event);
        self.0.event(event)
    }

    fn flight(&mut self, flight: &Flight, from: State, time: f64) {
        self.0.flight(flight, from, time);
    }
}

/// The mean growth of each block of revolutions that is over.
#[derive(Clone, Debug)]
struct Means {
    per_block: u64,
    of_blocks: Vec<f64>,
    /// Of the block that is not over.
    sum: f64,
    seen: u64,
}

impl Means {
    fn over(per_block: u64) -> Self {
        Self { per_block, of_blocks: Vec::new(), sum: 0.0, seen: 0 }
    }

    fn take(&mut self, stretch: f64) {
        (self.sum, self.seen) = (self.sum + stretch, self.seen + 1);
        if self.seen == self.per_block && self.sum > f64::NEG_INFINITY {
            self.of_blocks.push(self.sum / self.per_block as f64);
            (self.sum, self.seen) = (0.0, 0);
        }
    }
}

/// The growth of each revolution in turn; minus infinity, once, where the follower sticks.
fn stretches(
    machine: &Machine,
    motion: &mut Motion,
    revolutions: u64,
    (met, direction): (&mut Met, &mut Vector2<f64>),
    mut keep: impl FnMut(f64),
) -> Result<(), SimulateError> {
    let omega = machine.angular_velocity();
    if motion.contact {
        let goal = motion.after(revolutions);
        let released = machine.advance(motion, goal, &mut |event: &Event| match event.kind {
            EventKind::Release => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        })?;
        if released.is_continue() {
            keep(f64::NEG_INFINITY);
            return Ok(());
        }
    }
    let mut variation = Variation::new(machine, motion);
    for _ in 0..revolutions {
        let goal = motion.after(1);
        let _ = machine.advance(motion, goal, &mut Counting(&mut variation, met))?;
        let matrix = variation.matrix();
        let carried = Vector2::new(
            matrix[(0, 0)] * direction[0] + matrix[(0, 1)] * omega * direction[1],
            matrix[(1, 0)] / omega * direction[0] + matrix[(1, 1)] * direction[1],
        );
        let stretch = carried.norm();
        keep(elementary::ln(stretch));
        if stretch == 0.0 {
            return Ok(());
        }
        *direction = carried / stretch;
        variation.reset(Matrix2::identity());
    }
    Ok(())
}
