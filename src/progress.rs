//! How far long work has come, told to whoever waits for it.
//!
//! A computation that may take longer than a second takes a [`Watch`] and tells it what it is at; what becomes of that is
//! not its business. Nothing that is computed depends on who watches.

use std::sync::atomic::{AtomicU64, Ordering};

/// Whoever wants to know how far a computation has come; told from any thread.
pub trait Watch: Sync {
    /// `done` of `total` pieces are done, and `what`, in a few words, is what it is at; a total of 0 is not known.
    fn at(&self, what: &str, done: u64, total: u64);
}

/// Pieces of work that are done in any order, on any thread.
pub struct Pieces<'a> {
    watch: &'a dyn Watch,
    what: &'a str,
    done: AtomicU64,
    total: AtomicU64,
}

impl<'a> Pieces<'a> {
    /// None of them done yet.
    pub fn new(watch: &'a dyn Watch, what: &'a str, total: usize) -> Self {
        watch.at(what, 0, total as u64);
        Self { watch, what, done: AtomicU64::new(0), total: AtomicU64::new(total as u64) }
    }

    /// So many more have turned up.
    pub fn more(&self, count: usize) {
        self.total.fetch_add(count as u64, Ordering::Relaxed);
    }

    /// Does one of them, and says that it is done.
    pub fn each<T>(&self, piece: impl FnOnce() -> T) -> T {
        let result = piece();
        let total = self.total.load(Ordering::Relaxed);
        self.watch.at(self.what, 1 + self.done.fetch_add(1, Ordering::Relaxed), total);
        result
    }
}

/// Nobody.
#[derive(Clone, Copy, Debug)]
pub struct Unwatched;

impl Watch for Unwatched {
    fn at(&self, _: &str, _: u64, _: u64) {}
}
