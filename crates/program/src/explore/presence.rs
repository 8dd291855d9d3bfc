//! Record of open pages: each open page waits for the answer to a long poll.

use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Instant;

use super::Timeouts;

/// Reason why the server ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// Page that was closed, and not opened again for a minute.
    Closed,
    /// Page that nobody opened within ten minutes.
    Unopened,
}

/// Open pages.
pub(super) struct Presence {
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    /// Number of long polls that wait for their answer.
    polls: usize,
    /// Whether a page was ever served.
    is_opened: bool,
    /// Moment of the last sign of a page, or of the server's start.
    last: Instant,
}

impl Presence {
    pub(super) fn new() -> Self {
        let state = State { polls: 0, is_opened: false, last: Instant::now() };
        Self { state: Mutex::new(state), changed: Condvar::new() }
    }

    fn change(&self, change: impl FnOnce(&mut State)) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        change(&mut state);
        state.last = Instant::now();
        self.changed.notify_all();
    }

    /// Records that a page was served.
    pub(super) fn served(&self) {
        self.change(|state| state.is_opened = true);
    }

    /// Counts a long poll until the returned value is dropped.
    pub(super) fn poll(&self) -> Poll<'_> {
        self.change(|state| state.polls += 1);
        Poll(self)
    }

    /// Waits until no page has been open for long enough.
    pub(super) fn wait(&self, timeouts: &Timeouts) -> End {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            let (end, timeouts) = match state.is_opened {
                true => (End::Closed, timeouts.closed),
                false => (End::Unopened, timeouts.unopened),
            };
            let left = match state.polls {
                0 => (state.last + timeouts).saturating_duration_since(Instant::now()),
                // Waits until something changes.
                _ => timeouts,
            };
            if left.is_zero() {
                return end;
            }
            state = self.changed.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}

/// Long poll that waits for its answer.
pub(super) struct Poll<'a>(&'a Presence);

impl Drop for Poll<'_> {
    fn drop(&mut self) {
        self.0.change(|state| state.polls = state.polls.saturating_sub(1));
    }
}
