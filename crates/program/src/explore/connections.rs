//! Open connections, with a limit on their number.

use std::collections::VecDeque;
use std::net::{Shutdown, TcpStream};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Largest number of connections at once. A browser opens six to one server.
const MOST_CONNECTIONS: usize = 64;
/// Largest number of threads for connections: threads of connections closed to make room may take a moment to end.
const MOST_THREADS: usize = 2 * MOST_CONNECTIONS;
/// Longest wait for one of these threads to end. Meanwhile, the system queues new connections.
const MOMENT: Duration = Duration::from_secs(2);

/// Open connections.
#[derive(Default)]
pub(super) struct Connections {
    places: Mutex<Places>,
    /// Signal that a thread of a connection has ended.
    ended: Condvar,
}

#[derive(Default)]
struct Places {
    /// Number of threads of connections.
    threads: usize,
    /// Number of connections with an accepted request.
    admitted: usize,
    /// Connections without an accepted request, oldest first.
    unadmitted: VecDeque<Arc<TcpStream>>,
}

impl Places {
    /// Removes a connection from the unadmitted ones. Returns whether it was one of them.
    fn forget(&mut self, connection: &Arc<TcpStream>) -> bool {
        let place = self.unadmitted.iter().position(|other| Arc::ptr_eq(other, connection));
        place.and_then(|place| self.unadmitted.remove(place)).is_some()
    }
}

impl Connections {
    fn places(&self) -> MutexGuard<'_, Places> {
        self.places.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Place of an open connection, until it is dropped.
pub(super) struct Admission {
    connections: Arc<Connections>,
    pub(super) connection: Arc<TcpStream>,
    is_admitted: bool,
}

impl Admission {
    /// Gives a place to a connection, or returns it if there is none. If all places are taken, the oldest unadmitted connection loses its
    /// place, so that silent connections cannot block the answers of a page.
    pub(super) fn enter(connections: &Arc<Connections>, connection: TcpStream) -> Result<Self, TcpStream> {
        let waited =
            connections.ended.wait_timeout_while(connections.places(), MOMENT, |places| places.threads >= MOST_THREADS);
        let (mut places, timeout) = waited.unwrap_or_else(PoisonError::into_inner);
        if timeout.timed_out() {
            return Err(connection);
        }
        if places.admitted + places.unadmitted.len() >= MOST_CONNECTIONS {
            match places.unadmitted.pop_front() {
                // The thread of that connection notices, and ends.
                Some(oldest) => drop(oldest.shutdown(Shutdown::Both)),
                None => return Err(connection),
            }
        }
        let connection = Arc::new(connection);
        places.threads += 1;
        places.unadmitted.push_back(Arc::clone(&connection));
        Ok(Self { connections: Arc::clone(connections), connection, is_admitted: false })
    }

    /// Records that the connection has an accepted request, so that it keeps its place.
    pub(super) fn admit(&mut self) {
        let mut places = self.connections.places();
        if places.forget(&self.connection) {
            places.admitted += 1;
            self.is_admitted = true;
        }
    }

    /// Records that the request has its response. The connection counts as unadmitted again, until the other side closes it.
    pub(super) fn dismiss(&mut self) {
        let mut places = self.connections.places();
        if std::mem::take(&mut self.is_admitted) {
            places.admitted -= 1;
            places.unadmitted.push_back(Arc::clone(&self.connection));
        }
    }
}

impl Drop for Admission {
    fn drop(&mut self) {
        let mut places = self.connections.places();
        places.threads -= 1;
        if self.is_admitted {
            places.admitted -= 1;
        } else {
            places.forget(&self.connection);
        }
        self.connections.ended.notify_one();
    }
}
