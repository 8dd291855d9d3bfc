//! The server: accepts connections until the page has been closed for a while.

use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use super::crowd::Guest;
use super::door::Door;
use super::house::{House, PageSource};
use super::presence::End;
use super::reply::{self, Reply, Timed, part};
use super::request::Head;
use super::{Patience, errand};

/// Pause after the system could not accept a connection, for example because too many files are open.
const PAUSE: Duration = Duration::from_millis(50);

/// Server that listens, and serves once it is told to.
pub(crate) struct Server {
    listener: TcpListener,
    address: SocketAddr,
    house: Arc<House>,
}

impl Server {
    /// Listens on the loopback interface, at this port or at any that is free.
    pub(crate) fn listen(
        port: Option<u16>,
        threads: Option<usize>,
        patience: Patience,
        page: PageSource,
    ) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port.unwrap_or(0)))?;
        let address = listener.local_addr()?;
        let door = Door::new(address.port()).map_err(io::Error::other)?;
        Ok(Self { listener, address, house: Arc::new(House::new(door, threads, patience, page)) })
    }

    /// Address of the page.
    pub(crate) fn address(&self) -> String {
        format!("http://{}{}", self.address, self.house.door.page())
    }

    /// Address that leads to the page once, for the command line of a browser.
    pub(crate) fn first_visit(&self) -> String {
        format!("http://{}{}", self.address, self.house.door.first_visit())
    }

    /// Serves until no page is open any more.
    pub(crate) fn serve(self) -> io::Result<End> {
        let Self { listener, address, house } = self;
        let accepting = Arc::clone(&house);
        let accepts = move || accept(&listener, &accepting);
        let acceptor = std::thread::Builder::new().name("acceptor".into()).spawn(accepts)?;
        let end = house.presence.wait(&house.patience);
        house.is_over.store(true, Ordering::Relaxed);
        house.lanes.stop_all();
        // The acceptor waits for a connection, and gets one. Otherwise it ends with the program.
        if TcpStream::connect(address).is_ok() {
            let _ = acceptor.join();
        }
        Ok(end)
    }
}

/// Accepts connections, each on a thread of its own.
fn accept(listener: &TcpListener, house: &Arc<House>) {
    for connection in listener.incoming() {
        if house.is_over.load(Ordering::Relaxed) {
            return;
        }
        let Ok(connection) = connection else {
            std::thread::sleep(PAUSE);
            continue;
        };
        match Guest::enter(&house.crowd, connection) {
            Ok(guest) => {
                let house = Arc::clone(house);
                // Where no thread can be started, the connection is closed.
                let _ = std::thread::Builder::new().name("connection".into()).spawn(move || attend(guest, &house));
            }
            Err(connection) => {
                // A few bytes fit into any socket. Nothing is waited for.
                let _ = connection.set_nonblocking(true);
                let _ = Reply::empty(reply::UNAVAILABLE).write(&connection);
            }
        }
    }
}

/// Reads the request of a connection, responds, and closes it.
fn attend(mut guest: Guest, house: &House) {
    let connection = Arc::clone(&guest.connection);
    let _ = connection.set_nodelay(true);
    let admitted = Head::read(&mut Timed::new(&connection, house.patience.head))
        .and_then(|head| house.door.judge(&head).map(|errand| (errand, head)));
    let reply = match admitted {
        Ok((errand, head)) => {
            guest.admit();
            errand::run(errand, &head, &connection, house)
        }
        Err(refused) => refused,
    };
    let Some(reply) = reply else { return };
    if reply.write(Timed::new(&connection, house.patience.transfer)).is_ok() {
        guest.dismiss();
        part(&connection, house.patience.parting);
    }
}
