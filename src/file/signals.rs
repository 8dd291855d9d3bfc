//! Signals that end the program. They wait while a file gets its name. Before the end, hidden files and private folders are removed,
//! and started programs are ended.
//!
//! Destructors do not run when a signal ends the program. So a separate thread waits for signals, removes unfinished
//! files and then lets the signal take effect: no loop has to poll a flag, and the shell sees the signal.

use std::collections::BTreeSet;
use std::io;
use std::path::PathBuf;
use std::process::Child;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Hidden files and private folders that a signal has to remove; locked while one of them is created, removed or renamed.
static HIDDEN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

pub(super) fn held() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // The set remains valid even if a thread panicked with the lock.
    HIDDEN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ids of the processes that a signal has to end.
static STARTED: Mutex<BTreeSet<u32>> = Mutex::new(BTreeSet::new());

fn started() -> MutexGuard<'static, BTreeSet<u32>> {
    STARTED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A started program; it ends with this value or with a signal that ends this program.
pub(crate) struct Started {
    child: Child,
}

impl Started {
    pub(crate) fn new(child: Child) -> Self {
        started().insert(child.id());
        Self { child }
    }

    pub(crate) fn child(&mut self) -> &mut Child {
        &mut self.child
    }
}

impl Drop for Started {
    fn drop(&mut self) {
        // The system may soon reuse its process id.
        started().remove(&self.child.id());
        // A process that has ended is neither killed nor waited for.
        let _ = self.child.kill().and_then(|()| self.child.wait().map(drop));
    }
}

/// An entry of `HIDDEN`, removed from it with this value.
pub(super) struct Listed(pub(super) PathBuf);

impl Drop for Listed {
    fn drop(&mut self) {
        held().remove(&self.0);
    }
}

#[cfg(unix)]
pub(super) fn watch() -> io::Result<()> {
    use std::sync::atomic::AtomicBool;
    use std::sync::{Arc, Once};

    use signal_hook::consts::{
        SIGALRM, SIGHUP, SIGINT, SIGPROF, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2, SIGVTALRM, SIGXCPU, SIGXFSZ,
    };
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    /// Signals that end a program and can be caught, except those for a program's own faults.
    const ENDING: [i32; 10] =
        [SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGALRM, SIGUSR1, SIGUSR2, SIGVTALRM, SIGPROF, SIGXCPU];
    static WATCHED: Once = Once::new();
    let mut result = Ok(());
    WATCHED.call_once(|| {
        // A file at its size limit gives an error message, as a full disk does.
        let too_large = signal_hook::flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)));
        let ignored = ignored();
        let heeded = ENDING.into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0);
        result = too_large.and_then(|_| Signals::new(heeded)).and_then(|mut signals| {
            std::thread::Builder::new().name("signals".into()).spawn(move || {
                for signal in signals.forever() {
                    // Locked until the end: no other thread may begin or finish a file now.
                    let held = held();
                    for path in held.iter() {
                        let _ = std::fs::remove_file(path).or_else(|_| std::fs::remove_dir_all(path));
                    }
                    for number in started().iter() {
                        use rustix::process::{Pid, Signal, kill_process};
                        let number = i32::try_from(*number).ok().and_then(Pid::from_raw);
                        let _ = number.map(|number| kill_process(number, Signal::KILL));
                    }
                    let _ = emulate_default_handler(signal);
                }
            })?;
            Ok(())
        });
    });
    result
}

/// Signals that this program was started to ignore, as under `nohup`, a bit for each. If the system does not
/// report them, the signal of a lost terminal is assumed.
#[cfg(unix)]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(1 << (signal_hook::consts::SIGHUP - 1))
}

#[cfg(not(unix))]
pub(super) fn watch() -> io::Result<()> {
    Ok(())
}
