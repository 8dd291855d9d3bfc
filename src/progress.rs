//! Reports the progress of long work to an observer.
//!
//! A computation that may take longer than a second takes a [`Watch`] and reports its progress to it. No result depends on the observer.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Observer of a computation's progress; called from any thread.
pub trait Watch: Sync {
    /// Reports that `done` of `total` pieces are done; `what` describes the present work in a few words. A total of 0 means unknown.
    fn at(&self, what: &str, done: u64, total: u64);
}

/// Counter of pieces of work that are done in any order, on any thread.
#[doc(hidden)]
pub struct Pieces<'a> {
    watch: &'a dyn Watch,
    what: &'a str,
    done: AtomicU64,
    total: AtomicU64,
}

impl<'a> Pieces<'a> {
    /// Starts with no piece done.
    pub fn new(watch: &'a dyn Watch, what: &'a str, total: usize) -> Self {
        watch.at(what, 0, total as u64);
        Self { watch, what, done: AtomicU64::new(0), total: AtomicU64::new(total as u64) }
    }

    /// Adds `count` pieces to the total.
    pub fn more(&self, count: usize) {
        self.total.fetch_add(count as u64, Ordering::Relaxed);
    }

    /// Does one piece, and reports it as done.
    pub fn each<T>(&self, piece: impl FnOnce() -> T) -> T {
        let result = piece();
        let total = self.total.load(Ordering::Relaxed);
        self.watch.at(self.what, 1 + self.done.fetch_add(1, Ordering::Relaxed), total);
        result
    }
}

/// Observer that ignores all reports.
#[derive(Clone, Copy, Debug)]
pub struct Unwatched;

impl Watch for Unwatched {
    fn at(&self, _: &str, _: u64, _: u64) {}
}

/// Clock for the run time that a computation reports. In a browser it always shows 0 seconds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock(Option<Instant>);

impl Clock {
    pub(crate) fn start() -> Self {
        Self(cfg!(not(target_family = "wasm")).then(Instant::now))
    }

    pub(crate) fn elapsed(&self) -> Duration {
        self.0.map_or(Duration::ZERO, |begun| begun.elapsed())
    }
}
