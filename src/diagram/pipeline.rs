//! Speeds side by side, their rows in order, in bounded memory.
//!
//! Each worker turns rows into blocks, whatever those are, and sends them to the thread that called, which takes the blocks
//! of one speed after those of the speed before. Queues are short: a worker that is ahead waits, and the worker of the
//! lowest open speed never does.

use std::ops::ControlFlow;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use super::{Following, Row, Seen, Sweep, SweepError};
use crate::simulate::EventKind;

/// A part of a record, made by a worker.
pub trait Block: Default + Send {
    /// Adds a row.
    fn push(&mut self, row: &Row);

    /// Whether it is time to send it on.
    fn is_full(&self) -> bool;
}

/// A block that keeps nothing: for a sweep that is only counted.
#[derive(Debug, Default)]
pub struct Counted;

impl Block for Counted {
    fn push(&mut self, _row: &Row) {}

    fn is_full(&self) -> bool {
        false
    }
}

/// What a sweep came to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// Rows recorded.
    pub points: u64,
    /// Impacts among them.
    pub impacts: u64,
    /// Revolutions run, recorded or not.
    pub revolutions: u64,
}

impl Tally {
    fn add(&mut self, other: Self) {
        self.points += other.points;
        self.impacts += other.impacts;
        self.revolutions += other.revolutions;
    }
}

enum Message<B> {
    Block(B),
    Done(Result<Tally, SweepError>),
}

/// Blocks of one speed that may wait to be taken.
const QUEUE: usize = 4;
/// Speeds that may be open, for each thread.
const OPEN_PER_THREAD: usize = 4;

impl Sweep {
    /// Runs on `threads` threads (all there are for `None`); `take` gets every block in order, and after each speed its
    /// index with an empty block.
    pub fn run<B: Block, E: From<SweepError>>(
        &self,
        threads: Option<usize>,
        mut take: impl FnMut(usize, B) -> Result<(), E>,
    ) -> Result<Tally, E> {
        let mut tally = Tally::default();
        if self.following != Following::Nothing {
            // Each speed waits for its neighbour: one after the other, here.
            let mut from = None;
            for step in 0..self.speeds.count {
                let index = if self.following == Following::Up { step } else { self.speeds.count - 1 - step };
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
                from = Some(motion);
                tally.add(here);
                take(index, B::default())?;
            }
            return Ok(tally);
        }
        let mut builder = rayon::ThreadPoolBuilder::new();
        if let Some(threads) = threads {
            builder = builder.num_threads(threads);
        }
        let pool = builder.build().map_err(|error| SweepError::Threads(error.to_string()))?;
        let open = OPEN_PER_THREAD * pool.current_num_threads();
        pool.in_place_scope_fifo(|scope| {
            let spawn = |index: usize| {
                let (sender, receiver) = sync_channel(QUEUE);
                scope.spawn_fifo(move |_| self.work::<B>(index, &sender));
                receiver
            };
            let mut waiting = std::collections::VecDeque::new();
            let mut next = 0;
            for index in 0..self.speeds.count {
                while next < self.speeds.count && next < index + open {
                    waiting.push_back(spawn(next));
                    next += 1;
                }
                let Some(receiver) = waiting.pop_front() else { break };
                tally.add(drain(index, &receiver, &mut take)?);
            }
            Ok(tally)
        })
    }

    /// One speed's run on a worker; a receiver that is gone ends it.
    fn work<B: Block>(&self, index: usize, sender: &SyncSender<Message<B>>) {
        let mut send = |block| match sender.send(Message::Block(block)) {
            Ok(()) => ControlFlow::Continue(()),
            Err(_) => ControlFlow::Break(()),
        };
        let result = self.one::<B>(index, None, &mut send).map(|(_, tally)| tally);
        let _ = sender.send(Message::Done(result));
    }

    fn one<B: Block>(
        &self,
        index: usize,
        from: Option<crate::simulate::Motion>,
        send: &mut dyn FnMut(B) -> ControlFlow<()>,
    ) -> Result<(crate::simulate::Motion, Tally), SweepError> {
        let rpm = self.speeds.rpm(index);
        let failed = |error| SweepError::Simulate { rpm, error };
        let machine = self.machine_at(rpm);
        let motion = match &from {
            Some(motion) => machine.resume(motion),
            None => self.start.motion(&machine),
        };
        let mut tally = Tally { revolutions: self.transient + self.record, ..Tally::default() };
        let mut block = B::default();
        let keep = |row: Row| {
            tally.points += 1;
            tally.impacts += u64::from(matches!(&row.seen, Seen::Event(event) if event.kind == EventKind::Impact));
            block.push(&row);
            if block.is_full() { send(std::mem::take(&mut block)) } else { ControlFlow::Continue(()) }
        };
        let (end, _) = self.speed(&machine, rpm, motion.map_err(failed)?, keep).map_err(failed)?;
        // The caller that wants no more sees to it itself.
        let _ = send(block);
        Ok((end, tally))
    }
}

/// Takes all blocks of a speed.
fn drain<B: Block, E: From<SweepError>>(
    index: usize,
    receiver: &Receiver<Message<B>>,
    take: &mut impl FnMut(usize, B) -> Result<(), E>,
) -> Result<Tally, E> {
    loop {
        match receiver.recv() {
            Ok(Message::Block(block)) => take(index, block)?,
            Ok(Message::Done(result)) => {
                take(index, B::default())?;
                return Ok(result?);
            }
            Err(_) => return Err(SweepError::Threads("a worker is gone".into()).into()),
        }
    }
}
