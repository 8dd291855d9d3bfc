//! Responses: status, headers and body, and the headers that every response has.

use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::time::{Duration, Instant};

/// Status of a response.
pub(super) type Status = (u16, &'static str);

pub(super) const OK: Status = (200, "OK");
pub(super) const SEE_OTHER: Status = (303, "See Other");
pub(super) const BAD_REQUEST: Status = (400, "Bad Request");
pub(super) const FORBIDDEN: Status = (403, "Forbidden");
pub(super) const NOT_FOUND: Status = (404, "Not Found");
pub(super) const METHOD_NOT_ALLOWED: Status = (405, "Method Not Allowed");
pub(super) const TIMEOUT: Status = (408, "Request Timeout");
pub(super) const CONFLICT: Status = (409, "Conflict");
pub(super) const LENGTH_REQUIRED: Status = (411, "Length Required");
pub(super) const TOO_LARGE: Status = (413, "Content Too Large");
pub(super) const HEAD_TOO_LARGE: Status = (431, "Request Header Fields Too Large");
pub(super) const UNAVAILABLE: Status = (503, "Service Unavailable");

/// Headers of every response: nothing may be stored, framed, guessed, or read by another page.
const ALWAYS: &str = "Connection: close\r\n\
    Cache-Control: no-store\r\n\
    Cross-Origin-Opener-Policy: same-origin\r\n\
    Cross-Origin-Resource-Policy: same-origin\r\n\
    Referrer-Policy: no-referrer\r\n\
    X-Content-Type-Options: nosniff\r\n\
    X-Frame-Options: DENY\r\n";

/// Policy of responses other than the page: they may load nothing.
const NOTHING: &str = "default-src 'none'; frame-ancestors 'none'";

/// Response to one request.
#[derive(Debug)]
pub(super) struct Reply {
    status: Status,
    /// Further header lines.
    headers: String,
    body: String,
}

/// Reason to end a request: a response, or `None` if nobody waits for one.
pub(super) type Refused = Option<Reply>;

impl Reply {
    /// Builds a response with a body of this media type.
    pub(super) fn new(status: Status, kind: &str, policy: Option<&str>, body: String) -> Self {
        let policy = policy.unwrap_or(NOTHING);
        let headers = format!("Content-Type: {kind}; charset=utf-8\r\nContent-Security-Policy: {policy}\r\n");
        Self { status, headers, body }
    }

    /// Builds a response with a sentence that gives the reason.
    pub(super) fn sentence(status: Status, words: &str) -> Self {
        Self::new(status, "text/plain", None, format!("{words}\n"))
    }

    /// Builds a response without a body.
    pub(super) fn empty(status: Status) -> Self {
        Self::new(status, "text/plain", None, String::new())
    }

    /// Adds a header.
    pub(super) fn with(mut self, name: &str, value: &str) -> Self {
        self.headers += &format!("{name}: {value}\r\n");
        self
    }

    /// Writes the response.
    pub(super) fn write(&self, mut to: impl Write) -> io::Result<()> {
        let ((code, reason), length) = (self.status, self.body.len());
        let head = format!("HTTP/1.1 {code} {reason}\r\n{ALWAYS}{}Content-Length: {length}\r\n\r\n", self.headers);
        to.write_all(head.as_bytes())?;
        to.write_all(self.body.as_bytes())
    }
}

/// Connection whose reads and writes end at a given moment, however slow the other side is.
pub(super) struct Timed<'a> {
    stream: &'a TcpStream,
    until: Instant,
}

impl<'a> Timed<'a> {
    pub(super) fn new(stream: &'a TcpStream, timeouts: Duration) -> Self {
        Self { stream, until: Instant::now() + timeouts }
    }

    fn left(&self) -> io::Result<Option<Duration>> {
        let left = self.until.saturating_duration_since(Instant::now());
        if left.is_zero() { Err(io::ErrorKind::TimedOut.into()) } else { Ok(Some(left)) }
    }
}

impl Read for Timed<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.stream.set_read_timeout(self.left()?)?;
        self.stream.read(buffer)
    }
}

impl Write for Timed<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.set_write_timeout(self.left()?)?;
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Ends a connection so that the other side gets the response: for a while, further input is read and discarded. A socket that is closed
/// with unread bytes resets the connection, and the response may be lost.
pub(super) fn part(stream: &TcpStream, timeouts: Duration) {
    let mut dropped = [0; 65536];
    let mut timed = Timed::new(stream, timeouts);
    // A connection that is already closed needs no further action.
    if stream.shutdown(Shutdown::Write).is_ok() {
        while timed.read(&mut dropped).is_ok_and(|count| count > 0) {}
    }
}
