//! Runs the values of a sweep side by side and returns their rows in order, in bounded memory.
//!
//! Each worker turns rows into blocks and sends the blocks to the calling thread, which takes them value by value. With few cores, a worker
//! stops whenever the calling thread wakes. So a worker runs a few neighbouring values in a row and sends short blocks together. Queues are
//! short: a worker that is ahead has to wait, but the worker of the lowest unfinished value never does.

use std::ops::{ControlFlow, Range};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use serde::Serialize;

use super::grid::RunError;
use super::sweep::{Beginning, RecordRow, Seen, Sweep, SweepStart};
use super::threads::SweepError;
use crate::simulate::EventKind;

/// A part of a record, made by a worker.
pub trait RecordBlock: Default + Send {
    /// An empty block for rows of a sweep.
    fn of(_sweep: &Sweep) -> Self {
        Self::default()
    }

    /// Adds a row.
    fn push(&mut self, row: &RecordRow);

    /// Whether the block should be sent.
    fn is_full(&self) -> bool;

    /// Notes that the run at a value could not go on. Returns true to continue the sweep; otherwise the sweep ends there.
    fn fail(&mut self, _value: f64) -> bool {
        false
    }
}

/// A block that keeps nothing: for a sweep that is only counted.
#[derive(Debug, Default)]
pub struct Counted;

impl RecordBlock for Counted {
    fn push(&mut self, _row: &RecordRow) {}

    fn is_full(&self) -> bool {
        false
    }
}

/// Totals of a sweep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SweepTally {
    /// Rows recorded.
    pub points: u64,
    /// Impacts among them.
    pub impacts: u64,
    /// Revolutions run, recorded or not.
    pub revolutions: u64,
}

impl SweepTally {
    fn add(&mut self, other: Self) {
        self.points += other.points;
        self.impacts += other.impacts;
        self.revolutions += other.revolutions;
    }
}

enum Message<B> {
    Block(B),
    Done(Result<SweepTally, SweepError>),
}

/// Batches of messages of one task that may wait to be taken.
const QUEUE: usize = 4;
/// Tasks in progress per thread.
const OPEN_PER_THREAD: usize = 4;
/// Largest number of values of a task, and the revolutions after which a task takes no further value.
const VALUES_PER_TASK: usize = 16;
const REVOLUTIONS_PER_TASK: u64 = 10_000;

impl Sweep {
    /// Runs the sweep on `threads` threads (all there are for `None`). `take` gets every block in order, and after each value its index
    /// with an empty block.
    pub fn run<B: RecordBlock, E: From<SweepError>>(
        &self,
        threads: Option<usize>,
        mut take: impl FnMut(usize, B) -> Result<(), E>,
    ) -> Result<SweepTally, E> {
        let mut tally = SweepTally::default();
        let follows = self.following != SweepStart::Nothing;
        if follows || cfg!(target_family = "wasm") {
            // Values that need the end of their neighbour run one after the other, here; so do all in a browser's page, which has one thread.
            let mut from = None;
            for step in 0..self.over.count() {
                let index = if self.following != SweepStart::Down { step } else { self.over.count() - 1 - step };
                let mut failed = None;
                let mut send = |block| match take(index, block) {
                    Ok(()) => ControlFlow::Continue(()),
                    Err(error) => {
                        failed = Some(error);
                        ControlFlow::Break(())
                    }
                };
                let found = self.one::<B>(index, from, &mut send);
                if let Some(error) = failed {
                    return Err(error);
                }
                let (motion, here) = found?;
                from = motion.filter(|_| follows);
                tally.add(here);
                take(index, B::default())?;
            }
            return Ok(tally);
        }
        let pool = super::threads::threads(threads)?;
        let open = OPEN_PER_THREAD * pool.current_num_threads();
        let each = self.values_per_task(open);
        let count = self.over.count();
        pool.in_place_scope_fifo(|scope| {
            let spawn = |first: usize| {
                let (sender, receiver) = sync_channel(QUEUE);
                let values = first..count.min(first + each);
                scope.spawn_fifo(move |_| self.work::<B>(values, &sender));
                receiver
            };
            let mut waiting = std::collections::VecDeque::new();
            let mut next = 0;
            for first in (0..count).step_by(each) {
                while next < count && next < first + open * each {
                    waiting.push_back(spawn(next));
                    next += each;
                }
                let Some(receiver) = waiting.pop_front() else { break };
                tally.add(drain(first..count.min(first + each), &receiver, &mut take)?);
            }
            Ok(tally)
        })
    }

    /// Number of neighbouring values per task if `open` tasks may be in progress: few enough for all threads to end together.
    fn values_per_task(&self, open: usize) -> usize {
        let revolutions = self.transient.saturating_add(self.record).max(1);
        let by_length = usize::try_from(REVOLUTIONS_PER_TASK / revolutions).unwrap_or(VALUES_PER_TASK);
        by_length.min(VALUES_PER_TASK).min(self.over.count() / (4 * open)).max(1)
    }

    /// Runs a few values on a worker; stops when the receiver is gone.
    fn work<B: RecordBlock>(&self, values: Range<usize>, sender: &SyncSender<Vec<Message<B>>>) {
        let mut lot = Vec::new();
        for index in values {
            let mut is_wanted = true;
            let mut send = |block: B| {
                let is_full = block.is_full();
                lot.push(Message::Block(block));
                if is_full {
                    is_wanted = sender.send(std::mem::take(&mut lot)).is_ok();
                }
                if is_wanted { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
            };
            let result = self.one::<B>(index, None, &mut send).map(|(_, tally)| tally);
            let failed = result.is_err();
            lot.push(Message::Done(result));
            if failed || !is_wanted {
                break;
            }
        }
        let _ = sender.send(lot);
    }

    fn one<B: RecordBlock>(
        &self,
        index: usize,
        from: Option<crate::simulate::Motion>,
        send: &mut dyn FnMut(B) -> ControlFlow<()>,
    ) -> Result<(Option<crate::simulate::Motion>, SweepTally), SweepError> {
        let value = self.over.value(index);
        let mut tally = SweepTally::default();
        let mut block = B::of(self);
        let mut keep = |row: RecordRow| {
            tally.points += 1;
            tally.impacts += u64::from(matches!(&row.seen, Seen::Event(event) if event.kind == EventKind::Impact));
            block.push(&row);
            if block.is_full() { send(std::mem::replace(&mut block, B::of(self))) } else { ControlFlow::Continue(()) }
        };
        let (mut end, mut runs) = (None, 0);
        let mut run = || -> Result<(), RunError> {
            let machine = self.over.machine(index)?;
            let motions = match &from {
                Some(motion) => vec![machine.resume(motion)?],
                None => self.starts.motions(&machine)?,
            };
            for motion in motions {
                let which = matches!(self.starts, Beginning::Found(_)).then_some(runs);
                let (last, flow) = self.record(&machine, value, motion, which, &mut keep)?;
                (end, runs) = (Some(last), runs + 1);
                if flow.is_break() {
                    break;
                }
            }
            Ok(())
        };
        if let Err(error) = run()
            && !block.fail(value)
        {
            return Err(SweepError::Run { place: self.over.words(index), error: error.to_string() });
        }
        tally.revolutions = runs as u64 * (self.transient + self.record);
        // A caller that wants no more blocks stops by itself.
        let _ = send(block);
        Ok((end, tally))
    }
}

/// Takes all blocks of a task's values.
fn drain<B: RecordBlock, E: From<SweepError>>(
    mut values: Range<usize>,
    receiver: &Receiver<Vec<Message<B>>>,
    take: &mut impl FnMut(usize, B) -> Result<(), E>,
) -> Result<SweepTally, E> {
    let mut tally = SweepTally::default();
    while !values.is_empty() {
        let Ok(lot) = receiver.recv() else {
            return Err(SweepError::Threads("a worker is gone".into()).into());
        };
        for message in lot {
            match message {
                Message::Block(block) => take(values.start, block)?,
                Message::Done(result) => {
                    take(values.start, B::default())?;
                    tally.add(result?);
                    values.start += 1;
                }
            }
        }
    }
    Ok(tally)
}
