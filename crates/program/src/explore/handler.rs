//! Handling of one request, from its head to its response.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::sync::atomic::Ordering;

use super::access::{Purpose, secret};
use super::lanes::Why;
use super::reply::{self, Refused, Reply, Timed};
use super::request::{Head, late};
use super::state::ServerState;
use super::work;

/// Largest body of a question, bytes. A table of a hundred thousand lifts fits.
const LARGEST_QUESTION: u64 = 4 << 20;
/// Longest name of a lane, bytes.
const LONGEST_LANE: usize = 100;

/// Handles an accepted request; returns the response, or `None` if nobody waits for one.
pub(super) fn run(purpose: Purpose, head: &Head, connection: &TcpStream, state: &ServerState) -> Option<Reply> {
    let done = match purpose {
        Purpose::Ticket => Ok(Reply::empty(reply::SEE_OTHER).with("Location", &state.access.page())),
        Purpose::Page => page(state),
        Purpose::Alive => alive(connection, state),
        Purpose::Answer { page } => answer(&page, head, connection, state),
    };
    done.map_or_else(|refused| refused, Some)
}

/// Serves the page: only inline scripts and styles with this response's nonce run.
fn page(state: &ServerState) -> Result<Reply, Refused> {
    let nonce = secret().map_err(|_| Some(Reply::empty(reply::UNAVAILABLE)))?;
    let load = state.loads.fetch_add(1, Ordering::Relaxed);
    let page = (state.page)(&format!("{}{load}", state.access.page()), &nonce);
    let policy = format!(
        "default-src 'none'; script-src 'nonce-{nonce}'; style-src 'nonce-{nonce}'; img-src data: blob:; connect-src 'self'; \
         worker-src blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    );
    state.presence.served();
    Ok(Reply::new(reply::OK, "text/html", Some(&policy), page))
}

/// Handles the long poll of an open page. It ends early if the page is closed.
fn alive(connection: &TcpStream, state: &ServerState) -> Result<Reply, Refused> {
    let _poll = state.presence.poll();
    let waits = connection.set_read_timeout(Some(state.timeouts.poll)).is_ok();
    match connection.peek(&mut [0]) {
        Ok(0) => Err(None),
        Err(error) if waits => late(&error).map_or(Err(None), |_| Ok(Reply::empty(reply::OK))),
        // A request must not have further bytes.
        _ => Err(Some(Reply::empty(reply::BAD_REQUEST))),
    }
}

/// Answers a question.
fn answer(page: &str, head: &Head, connection: &TcpStream, state: &ServerState) -> Result<Reply, Refused> {
    let refused = |words: &str| Some(Reply::sentence(reply::BAD_REQUEST, words));
    let lane = head.parameter("lane").filter(|lane| (1..=LONGEST_LANE).contains(&lane.len()));
    let sequence = head.parameter("sequence").and_then(|number| number.parse::<u64>().ok());
    let (Some(lane), Some(sequence)) = (lane, sequence) else {
        return Err(refused("A question has a lane and a sequence number."));
    };
    let body = body(head, connection, state)?;
    let question = std::str::from_utf8(&body).map_err(|_| refused("A question is written in UTF-8."))?;
    let turn = state.lanes.take(format!("{page}/{lane}"), sequence);
    let turn = turn.ok_or_else(|| Some(Reply::empty(reply::CONFLICT)))?;
    let timeouts = state.timeouts.question;
    let found = match work::answer(question, &turn.stop, connection, timeouts, state.threads) {
        Ok(Some(found)) => found,
        Ok(None) => match turn.stop.why() {
            Some(Why::Newer) => return Err(Some(Reply::empty(reply::CONFLICT))),
            Some(Why::Late) => unanswered(
                question,
                &format!(
                    "this computation takes longer than {} s: reduce it, or run its command in a terminal",
                    timeouts.as_secs_f64()
                ),
            ),
            _ => return Err(None),
        },
        Err(words) => unanswered(question, &words),
    };
    Ok(Reply::new(reply::OK, "application/json", None, found))
}

/// Document of a question without an answer, with the reason.
fn unanswered(question: &str, words: &str) -> String {
    let question: serde_json::Value = serde_json::from_str(question).unwrap_or_default();
    serde_json::json!({ "view": question.get("view"), "error": { "sentence": words } }).to_string()
}

/// Reads the body of a request. A body that is too large is rejected before it is read.
fn body(head: &Head, connection: &TcpStream, state: &ServerState) -> Result<Vec<u8>, Refused> {
    let length = head.field("content-length")?.and_then(|length| length.parse::<u64>().ok());
    let (Some(length), None) = (length, head.field("transfer-encoding")?) else {
        return Err(Some(Reply::empty(reply::LENGTH_REQUIRED)));
    };
    if length > LARGEST_QUESTION {
        return Err(Some(Reply::sentence(reply::TOO_LARGE, "A question has at most 4 MiB.")));
    }
    let mut timed = Timed::new(connection, state.timeouts.transfer);
    if head.field("expect")?.is_some_and(|value| value.eq_ignore_ascii_case("100-continue")) {
        timed.write_all(b"HTTP/1.1 100 Continue\r\n\r\n").map_err(|error| late(&error))?;
    }
    let mut body = head.begun.clone();
    let missing = length.saturating_sub(body.len() as u64);
    timed.take(missing).read_to_end(&mut body).map_err(|error| late(&error))?;
    // The body must have exactly the announced length.
    if body.len() as u64 == length { Ok(body) } else { Err(Some(Reply::empty(reply::BAD_REQUEST))) }
}
