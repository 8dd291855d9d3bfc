//! Checks of standard output: whether somebody reads it, and whether there is room.

use std::io;

use super::CommandError;
use corner_impact::cancel::Question;

/// Returns an error if the output could not be read or stored.
pub(super) fn takes_more() -> Result<(), CommandError> {
    match room() {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Err(CommandError::Unread),
        Err(error) => Err(CommandError::Words(format!("standard output: {error}"))),
        Ok(()) => Ok(()),
    }
}

/// Writes nothing: a full device returns an error, and a pipe without a reader has an event.
#[cfg(unix)]
fn room() -> io::Result<()> {
    let out = io::stdout();
    if has_ended(Some(&rustix::event::Timespec::default())) {
        return Err(io::ErrorKind::BrokenPipe.into());
    }
    rustix::io::write(&out, &[]).map(drop).map_err(io::Error::from)
}

/// Waits, for a limited time or without limit, until nobody reads any more; returns whether this is the case.
#[cfg(unix)]
fn has_ended(patience: Option<&rustix::event::Timespec>) -> bool {
    use rustix::event::{PollFd, PollFlags, poll};
    let out = io::stdout();
    let mut wanted = [PollFd::new(&out, PollFlags::empty())];
    let polled = poll(&mut wanted, patience);
    polled.is_ok() && wanted[0].revents().intersects(PollFlags::ERR)
}

/// Question whether the reader has stopped reading, which work may ask often.
#[cfg(unix)]
pub(super) fn is_unread() -> Question {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};
    let unread = Arc::new(AtomicBool::new(false));
    let seen = Arc::clone(&unread);
    // This thread waits while the program runs, and ends with it. If it cannot start, work continues to its end.
    let _ = std::thread::Builder::new().name("reader".into()).spawn(move || {
        if has_ended(None) {
            seen.store(true, Ordering::Relaxed);
        }
    });
    Arc::new(move || unread.load(Ordering::Relaxed))
}

#[cfg(not(unix))]
fn room() -> io::Result<()> {
    Ok(())
}

#[cfg(not(unix))]
pub(super) fn is_unread() -> Question {
    std::sync::Arc::new(|| false)
}
