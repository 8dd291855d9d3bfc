//! Server of the live page: HTTP on the loopback interface, for one browser on the same machine.
//!
//! ```text
//!  server        accepts connections, and ends when the page has been closed
//!    ▲
//!  handler       handles one request: the page, its long poll, an answer
//!  state         state that all connections share
//!    ▲
//!  connections   limits the number of open connections
//!  access        decides which requests are answered: token, Host, Origin, method
//!  work          answers a question on separate threads, until it is stopped
//!  lanes         keeps the newest question of each lane, and stops older ones
//!  presence      records whether a page is open
//!    ▲
//!  request       reads a head within limits of size and time
//!  reply         writes a response with the headers that every response has
//! ```
//!
//! The requests are parsed by `httparse`, hyper's own parser, and the sockets are those of the standard library. `tiny_http` would be the
//! usual choice for a server without an asynchronous runtime. Its last release, 0.12, has no limit for the size of a head (its issue 56),
//! no time limit for a slow client (issue 143), and a thread for each connection, however many there are. It accepts the connections
//! itself, so that no limit can be put in front. `hyper` has these limits, and needs an asynchronous runtime for them.
//!
//! Each connection carries one request and is then closed, so that no second request can be confused with the body of the first.

mod access;
mod connections;
mod handler;
mod lanes;
mod presence;
mod reply;
mod request;
mod server;
mod state;
mod work;

use std::time::Duration;

pub(crate) use presence::End;
pub(crate) use server::Server;

/// Waiting times of the server.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Timeouts {
    /// Limit for the head of a request, from the beginning of its connection.
    head: Duration,
    /// Limit for the body of a request, and for the other side to receive a response.
    transfer: Duration,
    /// Limit for the other side to close the connection after a response.
    parting: Duration,
    /// Limit for the answer to a question.
    question: Duration,
    /// Time until a long poll of the page is answered.
    poll: Duration,
    /// Time without an open page, after the first was served, until the server ends.
    closed: Duration,
    /// Time until the server ends if no page is requested.
    unopened: Duration,
}

impl Timeouts {
    /// Returns the waiting times divided by a number; tests cannot wait for a minute.
    pub(crate) fn hurried(by: u32) -> Self {
        let seconds = |count| Duration::from_secs(count) / by.max(1);
        Self {
            head: seconds(10),
            transfer: seconds(20),
            parting: seconds(2),
            question: seconds(60),
            poll: seconds(20),
            closed: seconds(60),
            unopened: seconds(600),
        }
    }
}
