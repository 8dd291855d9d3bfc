//! State that all connections share.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64};

use super::Timeouts;
use super::access::Access;
use super::connections::Connections;
use super::lanes::Lanes;
use super::presence::Presence;

/// Function that writes the page for a server whose addresses begin with the first word, with the second as the `nonce` of its scripts and
/// styles.
pub(super) type PageSource = Box<dyn Fn(&str, &str) -> String + Send + Sync>;

/// State that all connections share.
pub(super) struct ServerState {
    pub(super) access: Access,
    pub(super) connections: Arc<Connections>,
    pub(super) lanes: Lanes,
    pub(super) presence: Presence,
    pub(super) timeouts: Timeouts,
    pub(super) page: PageSource,
    /// Number of pages served so far.
    pub(super) loads: AtomicU64,
    /// Number of threads that share the work on one question.
    pub(super) threads: Option<usize>,
    pub(super) is_over: AtomicBool,
}

impl ServerState {
    pub(super) fn new(access: Access, threads: Option<usize>, timeouts: Timeouts, page: PageSource) -> Self {
        let (connections, lanes, presence) = (Arc::default(), Lanes::default(), Presence::new());
        let (loads, is_over) = (AtomicU64::new(0), AtomicBool::new(false));
        Self { access, connections, lanes, presence, timeouts, page, loads, threads, is_over }
    }
}
