//! How far long work has come, told to whoever waits for it.
//!
//! A computation that may take longer than a second takes a [`Watch`] and tells it what it is at; what becomes of that is
//! not its business. Nothing that is computed depends on who watches.

/// Whoever wants to know how far a computation has come; told from any thread.
pub trait Watch: Sync {
    /// `done` of `total` pieces are done, and `what`, in a few words, is what it is at; a total of 0 is not known.
    fn at(&self, what: &str, done: u64, total: u64);
}

/// Nobody.
#[derive(Clone, Copy, Debug)]
pub struct Unwatched;

impl Watch for Unwatched {
    fn at(&self, _: &str, _: u64, _: u64) {}
}
