//! Growth of small deviations, from the variational flow: Lyapunov exponents in the limit.

use std::ops::ControlFlow;

use nalgebra::{Matrix2, Vector2};

use super::{Event, EventKind, ImpactTally, Machine, Motion, Observer, SimulateError, Variation};
use crate::elementary;
use crate::estimate::Estimate;
use crate::flight::{Flight, State};

/// Mean growth of a small deviation per revolution, as a natural logarithm: the largest Lyapunov exponent in the limit of many
/// `revolutions`.
///
/// Minus infinity if the follower sticks to the cam, be it once in thousands of revolutions: nothing remains of a deviation then, and the
/// motion repeats what followed the stick before. Until such a stick a chaotic motion has the growth that it would have without. A start on
/// the cam counts from its release on. Zero revolutions have zero growth.
#[doc(hidden)]
pub fn growth(machine: &Machine, mut motion: Motion, revolutions: u64) -> Result<f64, SimulateError> {
    let (mut sum, mut direction) = (0.0, ANY);
    let met = &mut ImpactTally::default();
    stretches(machine, &mut motion, revolutions, (met, &mut direction), |stretch| sum += stretch)?;
    Ok(sum / revolutions.max(1) as f64)
}

/// Initial deviation, its angle in rad and its velocity over the angle in m/rad: any one has a part along the fastest growth.
const ANY: Vector2<f64> = Vector2::new(0.6, 0.8);

/// Data recorded from a run that does not repeat.
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
    /// An empty record, whose growth will be taken in blocks of `per_block` revolutions.
    pub fn over(per_block: u64) -> Self {
        Self { means: Means::over(per_block), direction: ANY, met: ImpactTally::default(), revolutions: 0 }
    }

    /// Continues the record for `revolutions`, or until the follower sticks, from `motion`, which must be where the record ended.
    pub fn take(&mut self, machine: &Machine, motion: &mut Motion, revolutions: u64) -> Result<(), SimulateError> {
        let begun = motion.revolution;
        let seen = (&mut self.met, &mut self.direction);
        stretches(machine, motion, revolutions, seen, |stretch| self.means.take(stretch))?;
        self.revolutions += motion.revolution - begun;
        Ok(())
    }

    /// Mean growth per revolution over the complete blocks. Its error is NaN for fewer than two blocks.
    pub fn growth(&self) -> Estimate {
        Estimate::of_parts(&self.means.of_blocks)
    }

    /// Largest growth of a deviation from the beginning of any block to the end of any later one. A deviation that shrinks in the end may
    /// have been as large as the motion on the way.
    pub fn most(&self) -> f64 {
        let grown = |(most, here): (f64, f64), block: &f64| {
            let here = (here + block * self.means.per_block as f64).max(0.0);
            (here.max(most), here)
        };
        self.means.of_blocks.iter().fold((0.0, 0.0), grown).0
    }

    /// Growth of a deviation over the first half of the complete blocks, and over the second; a natural logarithm.
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

/// Counts impacts besides the variation.
struct Counting<'a, 'machine>(&'a mut Variation<'machine>, &'a mut ImpactTally);

impl Observer for Counting<'_, '_> {
    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        self.1.take(event);
        self.0.event(event)
    }

    fn flight(&mut self, flight: &Flight, from: State, time: f64) {
        self.0.flight(flight, from, time);
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

    fn take(&mut self, stretch: f64) {
        (self.sum, self.seen) = (self.sum + stretch, self.seen + 1);
        if self.seen == self.per_block && self.sum > f64::NEG_INFINITY {
            self.of_blocks.push(self.sum / self.per_block as f64);
            (self.sum, self.seen) = (0.0, 0);
        }
    }
}

/// Passes the growth of each revolution to `keep`; minus infinity, once, if the follower sticks.
fn stretches(
    machine: &Machine,
    motion: &mut Motion,
    revolutions: u64,
    (met, direction): (&mut ImpactTally, &mut Vector2<f64>),
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
