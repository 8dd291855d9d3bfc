//! The threads that a survey runs on, and why it stops.

use crate::cancel;

/// Why a sweep stopped.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the message says what each number is")]
pub enum SweepError {
    /// A run could not begin or go on.
    #[error("at {place}: {error}")]
    Run { place: String, error: String },
    /// The threads could not be started.
    #[error("threads cannot be started: {0}")]
    Threads(String),
}

/// Does work on `count` threads, or for `None` on one for each core. A browser's page has one thread, which does the work itself.
pub(crate) fn on_threads<T: Send>(count: Option<usize>, work: impl FnOnce() -> T + Send) -> Result<T, SweepError> {
    if cfg!(target_family = "wasm") { Ok(work()) } else { Ok(threads(count)?.install(work)) }
}

/// Builds a pool of `count` threads. For `None` it has as many as the pool that this thread belongs to, or else one for each core.
pub fn threads(count: Option<usize>) -> Result<rayon::ThreadPool, SweepError> {
    // For 0, the builder makes as many threads as there are cores.
    let here = || rayon::current_thread_index().map(|_| rayon::current_num_threads());
    let builder = rayon::ThreadPoolBuilder::new().num_threads(count.or_else(here).unwrap_or(0));
    let builder = builder
        .spawn_handler(|thread| std::thread::Builder::new().spawn(cancel::carry(move || thread.run())).map(drop));
    builder.build().map_err(|error| SweepError::Threads(error.to_string()))
}
