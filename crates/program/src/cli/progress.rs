//! Progress bar on standard error, for work that takes longer than a second at a terminal.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use corner_impact::progress::Watch;

/// Runs work that may report its progress; `what` names its first step.
pub(super) fn watched<T>(what: &str, work: impl FnOnce(&dyn Watch) -> T) -> T {
    work(&Progress::spinner(what))
}

/// Whether progress is hidden.
static HIDDEN: AtomicBool = AtomicBool::new(false);

/// Time when the command began.
static BEGUN: Mutex<Option<Instant>> = Mutex::new(None);

/// Shows progress of the command that begins now, or hides it.
pub(super) fn begin(is_hidden: bool) {
    HIDDEN.store(is_hidden, Ordering::Relaxed);
    *BEGUN.lock().unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
}

/// Progress of a command: a bar if the total is known, otherwise a spinner, and the current step.
pub(super) struct Progress {
    bar: ProgressBar,
    /// State for which the bar was styled: whether something is done, and the total.
    looks: Mutex<(bool, u64)>,
    /// Thread that shows the bar, which ends when this value is dropped.
    shows: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Progress {
    /// Time from the beginning of a command until its bar appears, and least duration of work with a bar.
    const PATIENCE: Duration = Duration::from_millis(900);
    const LEAST: Duration = Duration::from_millis(100);
    /// Time between two updates of an idle bar.
    const TICK: Duration = Duration::from_millis(120);

    const BAR: &'static str = "{bar:30} {percent:>3} %  {elapsed} of about {duration}  {wide_msg}";
    /// Bar before the first piece is done, without an estimate of the remaining time.
    const BEGUN: &'static str = "{bar:30} {percent:>3} %  {elapsed}  {wide_msg}";
    const SPINNER: &'static str = "{spinner} {elapsed}  {wide_msg}";

    /// Builds a spinner for work of unknown duration.
    pub(super) fn spinner(what: &str) -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        look(&bar, (false, 0));
        bar.set_message(what.to_owned());
        // The bar appears by itself: the work may report nothing for longer than the patience.
        let is_shown = std::io::stderr().is_terminal() && !HIDDEN.load(Ordering::Relaxed);
        let begun = *BEGUN.lock().unwrap_or_else(PoisonError::into_inner);
        let over = begun.map_or(Duration::ZERO, |begun| begun.elapsed());
        let patience = Self::PATIENCE.saturating_sub(over).max(Self::LEAST);
        let shows = is_shown.then(|| {
            let (ended, end) = channel::<()>();
            let shown = bar.clone();
            let thread = std::thread::spawn(move || {
                if end.recv_timeout(patience) == Err(RecvTimeoutError::Timeout) {
                    shown.set_draw_target(ProgressDrawTarget::stderr());
                    shown.enable_steady_tick(Self::TICK);
                }
            });
            (ended, thread)
        });
        Self { bar, looks: Mutex::new((false, 0)), shows }
    }
}

fn look(bar: &ProgressBar, (begun, total): (bool, u64)) {
    let template = match (begun, total) {
        (_, 0) => Progress::SPINNER,
        (false, _) => Progress::BEGUN,
        (true, _) => Progress::BAR,
    };
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    if total > 0 {
        bar.set_length(total);
    }
}

impl Watch for Progress {
    fn at(&self, what: &str, done: u64, total: u64) {
        let mut known = self.looks.lock().unwrap_or_else(PoisonError::into_inner);
        if known.1 != total {
            // Each kind of work has a different pace.
            self.bar.reset_eta();
        }
        if *known != (done > 0, total) {
            *known = (done > 0, total);
            look(&self.bar, *known);
        }
        if self.bar.message() != what {
            self.bar.set_message(what.to_owned());
        }
        self.bar.set_position(done);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((ended, thread)) = self.shows.take() {
            drop(ended);
            // The thread only waits, and ends at once.
            let _ = thread.join();
        }
        self.bar.finish_and_clear();
    }
}
