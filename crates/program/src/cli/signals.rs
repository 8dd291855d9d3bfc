//! Signals that end the program. They are delayed while a file gets its name. Before the end, hidden files and private folders are removed,
//! and started programs are ended.
//!
//! A separate thread waits for signals, removes unfinished files and then lets the signal take effect: no loop has to poll a flag, and the
//! shell sees the signal.

use std::io;

/// Installs a handler for signals that end the program. Such signals are delayed while a file gets its name; the handler removes unfinished
/// files and ends started programs.
#[cfg(unix)]
pub fn watch() -> io::Result<()> {
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
        // A file at its size limit gives an error message, like a full disk.
        let too_large = signal_hook::flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)));
        let ignored = ignored();
        let heeded = ENDING.into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0);
        result = too_large.and_then(|_| Signals::new(heeded)).and_then(|mut signals| {
            std::thread::Builder::new().name("signals".into()).spawn(move || {
                for signal in signals.forever() {
                    // Kept until the end: no other thread may begin or finish a file now.
                    let _cleared = corner_impact::file::clear();
                    let _ = emulate_default_handler(signal);
                }
            })?;
            Ok(())
        });
    });
    result
}

/// Signals that this program was started to ignore, as under `nohup`, one bit for each. If the system does not report them, the signal of a
/// lost terminal is assumed to be ignored.
#[cfg(unix)]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(1 << (signal_hook::consts::SIGHUP - 1))
}

/// Does nothing: this system has no such signals.
#[cfg(not(unix))]
pub fn watch() -> io::Result<()> {
    Ok(())
}
