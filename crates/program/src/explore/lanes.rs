//! Lanes of questions: a newer question of a lane stops the older one.

use std::collections::HashMap;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Reason to stop the work on a question.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Why {
    /// Newer question of the same lane.
    Newer = 1,
    /// Time limit.
    Late = 2,
    /// Closed connection: nobody waits for the answer.
    Gone = 3,
}

/// Flag to stop the work on a question, with the reason.
#[derive(Debug, Default)]
pub(super) struct Stop(AtomicU8);

impl Stop {
    /// Stops the work; the first reason is kept.
    pub(super) fn set(&self, why: Why) {
        let _ = self.0.compare_exchange(0, why as u8, Ordering::Relaxed, Ordering::Relaxed);
    }

    /// Whether the work is to stop.
    pub(super) fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed) != 0
    }

    /// Reason to stop, if there is one.
    pub(super) fn why(&self) -> Option<Why> {
        let reason = self.0.load(Ordering::Relaxed);
        [Why::Newer, Why::Late, Why::Gone].into_iter().find(|why| *why as u8 == reason)
    }
}

/// Question of a lane that is being answered.
struct Asked {
    sequence: u64,
    stop: Arc<Stop>,
}

/// Questions that are being answered, at most one for each lane.
#[derive(Default)]
pub(super) struct Lanes(Mutex<HashMap<String, Asked>>);

impl Lanes {
    /// Places a question in its lane and stops the older one there; `None` if the one there is newer.
    pub(super) fn take(&self, lane: String, sequence: u64) -> Option<Turn<'_>> {
        let mut lanes = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(other) = lanes.get(&lane) {
            if other.sequence > sequence {
                return None;
            }
            other.stop.set(Why::Newer);
        }
        let stop = Arc::new(Stop::default());
        lanes.insert(lane.clone(), Asked { sequence, stop: Arc::clone(&stop) });
        Some(Turn { lanes: self, lane, stop })
    }

    /// Stops the work on all questions.
    pub(super) fn stop_all(&self) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).values().for_each(|asked| asked.stop.set(Why::Gone));
    }
}

/// Place of a question in its lane, until it is dropped.
pub(super) struct Turn<'a> {
    lanes: &'a Lanes,
    lane: String,
    pub(super) stop: Arc<Stop>,
}

impl Drop for Turn<'_> {
    fn drop(&mut self) {
        let mut lanes = self.lanes.0.lock().unwrap_or_else(PoisonError::into_inner);
        // A newer question may occupy the lane.
        if lanes.get(&self.lane).is_some_and(|asked| Arc::ptr_eq(&asked.stop, &self.stop)) {
            lanes.remove(&self.lane);
        }
    }
}
