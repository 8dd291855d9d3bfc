//! Registry of the hidden files, private folders and started programs that must be removed or ended before a signal ends the program.
//!
//! Destructors do not run when a signal ends the program. A program that does not handle its signals calls [`clear`] first.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::process::Child;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Hidden files and private folders that a signal must remove; locked while one of them is created, removed or renamed.
static HIDDEN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

pub fn held() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // The set remains valid even if a thread panicked with the lock.
    HIDDEN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ids of the processes that a signal must end.
static STARTED: Mutex<BTreeSet<u32>> = Mutex::new(BTreeSet::new());

fn started() -> MutexGuard<'static, BTreeSet<u32>> {
    STARTED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Started program; it ends when this value is dropped or when a signal ends this program.
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

/// Entry of `HIDDEN`, removed from it when this value is dropped.
pub struct HeldPath(pub(super) PathBuf);

impl Drop for HeldPath {
    fn drop(&mut self) {
        held().remove(&self.0);
    }
}

/// Removes hidden files and private folders, and ends started programs, before this program ends. While the result lives, no thread can
/// begin or finish a file.
pub fn clear() -> impl Drop {
    let held = held();
    for path in held.iter() {
        let _ = std::fs::remove_file(path).or_else(|_| std::fs::remove_dir_all(path));
    }
    #[cfg(unix)]
    for number in started().iter() {
        use rustix::process::{Pid, Signal, kill_process};
        let number = i32::try_from(*number).ok().and_then(Pid::from_raw);
        let _ = number.map(|number| kill_process(number, Signal::KILL));
    }
    held
}
