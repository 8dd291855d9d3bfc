//! Work on one question, on separate threads, which ends within a fraction of a second once it is stopped.

use std::io;
use std::net::TcpStream;
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use corner_impact::cancel;
use corner_impact::study::survey::{SweepError, threads};

use super::lanes::{Stop, Why};

/// Time between two checks whether somebody still waits for the answer.
const LOOK: Duration = Duration::from_millis(50);

/// Answers a question on the given number of threads; `None` if the work was stopped.
///
/// The threads serve only this question: a thread shared by two questions could not tell which of them is to stop. Meanwhile this thread
/// checks the clock and the connection.
pub(super) fn answer(
    question: &str,
    stop: &Arc<Stop>,
    connection: &TcpStream,
    timeouts: Duration,
    count: Option<usize>,
) -> Result<Option<String>, String> {
    std::thread::scope(|scope| {
        let (asked, (sender, receiver)) = (Arc::clone(stop), channel());
        let work = move || {
            let is_stopped = Arc::new(move || asked.is_set());
            let respond = || Ok::<_, SweepError>(threads(count)?.install(|| corner_impact_explore::respond(question)));
            let done = cancel::run(is_stopped, respond);
            // The receiver exists until this thread has ended.
            let _ = sender.send(());
            done
        };
        let worker = std::thread::Builder::new().name("question".into()).spawn_scoped(scope, work);
        let worker = worker.map_err(|error| format!("threads cannot be started: {error}"))?;
        let until = Instant::now() + timeouts;
        while receiver.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
            if Instant::now() >= until {
                stop.set(Why::Late);
            } else if has_gone(connection) {
                stop.set(Why::Gone);
            }
        }
        match worker.join() {
            Ok(done) => done.transpose().map_err(|error| error.to_string()),
            Err(thrown) => std::panic::resume_unwind(thrown),
        }
    })
}

/// Whether the other side has closed the connection.
fn has_gone(connection: &TcpStream) -> bool {
    let looked = connection.set_nonblocking(true).and_then(|()| connection.peek(&mut [0]));
    let is_open = connection.set_nonblocking(false).is_ok();
    match looked {
        Ok(count) => count == 0 || !is_open,
        Err(error) => error.kind() != io::ErrorKind::WouldBlock || !is_open,
    }
}
