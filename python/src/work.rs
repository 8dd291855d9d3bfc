//! Work without the interpreter, which ends within a fraction of a second of a signal that Python makes an exception of.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use corner_impact::cancel;
use corner_impact::study::survey::{SweepError, threads};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Between two looks for a signal.
const LOOK: Duration = Duration::from_millis(50);

/// Work of this thread alone, which looks for signals itself: nothing is spent on what takes microseconds.
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
        // A handler may call this very module.
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

/// Work that threads share, on one of its own: this one looks for signals.
pub(crate) fn shared<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    py.detach(|| {
        std::thread::scope(|scope| {
            let ends = Arc::new(AtomicBool::new(false));
            let (asked, (sender, receiver)) = (ends.clone(), channel());
            let question = Arc::new(move || asked.load(Ordering::Relaxed));
            let worker = scope.spawn(move || {
                let done = cancel::run(question, work);
                // The other end is there until this thread has ended.
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

/// The same on as many threads as there are cores, for what finds its threads itself.
pub(crate) fn spread<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    shared(py, || Ok(threads(None)?.install(work)))?
        .map_err(|error: SweepError| PyValueError::new_err(error.to_string()))
}

fn ended() -> PyErr {
    PyValueError::new_err("the work was ended")
}
