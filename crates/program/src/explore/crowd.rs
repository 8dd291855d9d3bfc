//! Connections that are open, at most so many at once.

use std::collections::VecDeque;
use std::net::{Shutdown, TcpStream};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Most connections at once. A browser has six to one server.
const MOST_CONNECTIONS: usize = 64;
/// Most threads for connections: those that were just closed to make room may take a moment to end.
const MOST_THREADS: usize = 2 * MOST_CONNECTIONS;
/// Longest wait for one of these threads to end. Meanwhile, the system holds new connections.
const MOMENT: Duration = Duration::from_secs(2);

/// Connections that are open.
#[derive(Default)]
pub(super) struct Crowd {
    places: Mutex<Places>,
    /// A thread of a connection has ended.
    ended: Condvar,
}

#[derive(Default)]
struct Places {
    /// Threads of connections.
    threads: usize,
    /// Connections with a request that may come in.
    admitted: usize,
    /// Connections without such a request, oldest first.
    strangers: VecDeque<Arc<TcpStream>>,
}

impl Places {
    /// Takes a connection from the strangers; whether it was one.
    fn forget(&mut self, connection: &Arc<TcpStream>) -> bool {
        let place = self.strangers.iter().position(|other| Arc::ptr_eq(other, connection));
        place.and_then(|place| self.strangers.remove(place)).is_some()
    }
}

impl Crowd {
    fn places(&self) -> MutexGuard<'_, Places> {
        self.places.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Place of a connection in the crowd, until it is dropped.
pub(super) struct Guest {
    crowd: Arc<Crowd>,
    pub(super) connection: Arc<TcpStream>,
    is_admitted: bool,
}

impl Guest {
    /// Gives a place to a connection; the connection is handed back if there is none. If all places are taken, the oldest stranger loses its
    /// own, so that connections that say nothing keep no page from its answers.
    pub(super) fn enter(crowd: &Arc<Crowd>, connection: TcpStream) -> Result<Self, TcpStream> {
        let waited = crowd.ended.wait_timeout_while(crowd.places(), MOMENT, |places| places.threads >= MOST_THREADS);
        let (mut places, timeout) = waited.unwrap_or_else(PoisonError::into_inner);
        if timeout.timed_out() {
            return Err(connection);
        }
        if places.admitted + places.strangers.len() >= MOST_CONNECTIONS {
            match places.strangers.pop_front() {
                // Its thread notices, and ends.
                Some(oldest) => drop(oldest.shutdown(Shutdown::Both)),
                None => return Err(connection),
            }
        }
        let connection = Arc::new(connection);
        places.threads += 1;
        places.strangers.push_back(Arc::clone(&connection));
        Ok(Self { crowd: Arc::clone(crowd), connection, is_admitted: false })
    }

    /// Notes that the connection has a request that may come in. It keeps its place then.
    pub(super) fn admit(&mut self) {
        let mut places = self.crowd.places();
        if places.forget(&self.connection) {
            places.admitted += 1;
            self.is_admitted = true;
        }
    }

    /// Notes that the request has its response. The connection is a stranger again, until the other side closes it.
    pub(super) fn dismiss(&mut self) {
        let mut places = self.crowd.places();
        if std::mem::take(&mut self.is_admitted) {
            places.admitted -= 1;
            places.strangers.push_back(Arc::clone(&self.connection));
        }
    }
}

impl Drop for Guest {
    fn drop(&mut self) {
        let mut places = self.crowd.places();
        places.threads -= 1;
        if self.is_admitted {
            places.admitted -= 1;
        } else {
            places.forget(&self.connection);
        }
        self.crowd.ended.notify_one();
    }
}
