//! Work that releases the interpreter, and ends within a fraction of a second after a signal that Python turns into an exception.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use corner_impact::cancel;
use corner_impact::study::survey::{SweepError, threads};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Time between two checks for a signal.
const LOOK: Duration = Duration::from_millis(50);

/// Runs work on this thread, which checks for signals itself; short work has no overhead.
pub(crate) fn alone<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    struct Looks {
        last: Instant,
        raised: Option<PyErr>,
    }
    let looks = Arc::new(Mutex::new(Looks { last: Instant::now(), raised: None }));
    let asked = looks.clone();
    let question = move || {
        let mut looks = asked.lock().unwrap_or_else(PoisonError::into_inner);
        if looks.last.elapsed() < LOOK {
            return false;
        }
        looks.last = Instant::now();
        drop(looks);
        // A handler may call this module.
        let raised = Python::attach(|py| py.check_signals()).err();
        let is_raised = raised.is_some();
        asked.lock().unwrap_or_else(PoisonError::into_inner).raised = raised;
        is_raised
    };
    let done = py.detach(|| cancel::run(Arc::new(question), work));
    done.ok_or_else(|| {
        let raised = looks.lock().unwrap_or_else(PoisonError::into_inner).raised.take();
        raised.unwrap_or_else(ended)
    })
}

/// Runs work that several threads share, on a separate thread, while this thread checks for signals.
pub(crate) fn shared<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    py.detach(|| {
        std::thread::scope(|scope| {
            let ends = Arc::new(AtomicBool::new(false));
            let (asked, (sender, receiver)) = (ends.clone(), channel());
            let question = Arc::new(move || asked.load(Ordering::Relaxed));
            let worker = scope.spawn(move || {
                let done = cancel::run(question, work);
                // The receiver exists until this thread has ended.
                let _ = sender.send(());
                done
            });
            let mut raised = None;
            while receiver.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
                if let Err(error) = Python::attach(|py| py.check_signals()) {
                    raised = Some(error);
                    ends.store(true, Ordering::Relaxed);
                    break;
                }
            }
            match worker.join() {
                Ok(Some(done)) if raised.is_none() => Ok(done),
                Ok(_) => Err(raised.unwrap_or_else(ended)),
                Err(thrown) => std::panic::resume_unwind(thrown),
            }
        })
    })
}

/// Runs work as [`shared`] does, on as many threads as there are cores, if the work uses the current thread pool.
pub(crate) fn spread<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    shared(py, || Ok(threads(None)?.install(work)))?
        .map_err(|error: SweepError| PyValueError::new_err(error.to_string()))
}

fn ended() -> PyErr {
    PyValueError::new_err("the work was ended")
}
