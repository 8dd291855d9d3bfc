//! State that all connections share.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64};

use super::Patience;
use super::crowd::Crowd;
use super::door::Door;
use super::lanes::Lanes;
use super::presence::Presence;

/// Writes the page for a server whose addresses begin with the first word, with the second as the `nonce` of its scripts and styles.
pub(super) type PageSource = Box<dyn Fn(&str, &str) -> String + Send + Sync>;

/// State that all connections share.
pub(super) struct House {
    pub(super) door: Door,
    pub(super) crowd: Arc<Crowd>,
    pub(super) lanes: Lanes,
    pub(super) presence: Presence,
    pub(super) patience: Patience,
    pub(super) page: PageSource,
    /// Pages that were served so far.
    pub(super) loads: AtomicU64,
    /// Threads that share the work on one question.
    pub(super) threads: Option<usize>,
    pub(super) is_over: AtomicBool,
}

impl House {
    pub(super) fn new(door: Door, threads: Option<usize>, patience: Patience, page: PageSource) -> Self {
        let (crowd, lanes, presence) = (Arc::default(), Lanes::default(), Presence::new());
        let (loads, is_over) = (AtomicU64::new(0), AtomicBool::new(false));
        Self { door, crowd, lanes, presence, patience, page, loads, threads, is_over }
    }
}
