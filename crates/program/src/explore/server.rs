//! Server that accepts connections until the page has been closed for a while.

use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use super::access::Access;
use super::connections::Admission;
use super::presence::End;
use super::reply::{self, Reply, Timed, part};
use super::request::Head;
use super::state::{PageSource, ServerState};
use super::{Timeouts, handler};

/// Pause after the system could not accept a connection, for example because too many files are open.
const PAUSE: Duration = Duration::from_millis(50);

/// Server that listens, and serves when `serve` is called.
pub(crate) struct Server {
    listener: TcpListener,
    address: SocketAddr,
    state: Arc<ServerState>,
}

impl Server {
    /// Listens on the loopback interface, at this port or at any free port.
    pub(crate) fn listen(
        port: Option<u16>,
        threads: Option<usize>,
        timeouts: Timeouts,
        page: PageSource,
    ) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port.unwrap_or(0)))?;
        let address = listener.local_addr()?;
        let access = Access::new(address.port()).map_err(io::Error::other)?;
        Ok(Self { listener, address, state: Arc::new(ServerState::new(access, threads, timeouts, page)) })
    }

    /// Address of the page.
    pub(crate) fn address(&self) -> String {
        format!("http://{}{}", self.address, self.state.access.page())
    }

    /// Address that leads to the page once, for the command line of a browser.
    pub(crate) fn first_visit(&self) -> String {
        format!("http://{}{}", self.address, self.state.access.first_visit())
    }

    /// Serves until no page is open any more.
    pub(crate) fn serve(self) -> io::Result<End> {
        let Self { listener, address, state } = self;
        let accepting = Arc::clone(&state);
        let accepts = move || accept(&listener, &accepting);
        let acceptor = std::thread::Builder::new().name("acceptor".into()).spawn(accepts)?;
        let end = state.presence.wait(&state.timeouts);
        state.is_over.store(true, Ordering::Relaxed);
        state.lanes.stop_all();
        // The acceptor waits for a connection, and gets one here. Otherwise it ends with the program.
        if TcpStream::connect(address).is_ok() {
            let _ = acceptor.join();
        }
        Ok(end)
    }
}

/// Accepts connections, each on a separate thread.
fn accept(listener: &TcpListener, state: &Arc<ServerState>) {
    for connection in listener.incoming() {
        if state.is_over.load(Ordering::Relaxed) {
            return;
        }
        let Ok(connection) = connection else {
            std::thread::sleep(PAUSE);
            continue;
        };
        match Admission::enter(&state.connections, connection) {
            Ok(admission) => {
                let state = Arc::clone(state);
                // If no thread can be started, the connection is closed.
                let _ = std::thread::Builder::new().name("connection".into()).spawn(move || attend(admission, &state));
            }
            Err(connection) => {
                // A few bytes fit into any socket, so that writing never waits.
                let _ = connection.set_nonblocking(true);
                let _ = Reply::empty(reply::UNAVAILABLE).write(&connection);
            }
        }
    }
}

/// Reads the request of a connection, responds, and closes it.
fn attend(mut admission: Admission, state: &ServerState) {
    let connection = Arc::clone(&admission.connection);
    let _ = connection.set_nodelay(true);
    let admitted = Head::read(&mut Timed::new(&connection, state.timeouts.head))
        .and_then(|head| state.access.judge(&head).map(|purpose| (purpose, head)));
    let reply = match admitted {
        Ok((purpose, head)) => {
            admission.admit();
            handler::run(purpose, &head, &connection, state)
        }
        Err(refused) => refused,
    };
    let Some(reply) = reply else { return };
    if reply.write(Timed::new(&connection, state.timeouts.transfer)).is_ok() {
        admission.dismiss();
        part(&connection, state.timeouts.parting);
    }
}
