//! Ends long work early, at the request of the caller.
//!
//! A program ends by its signals and needs none of this. If another program calls the library, [`run`] runs work under a question, which
//! the loops of the simulator and of the searches repeat by [`check`]. If the answer is yes, the work is unwound to its beginning, and
//! everything that it holds is dropped on the way. So no search takes the stop for a failed run, and no result carries it. Threads that
//! share the work get the question by [`carry`].

use std::cell::{Cell, RefCell};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;

/// Question whether work is to end; put on every thread that does some of it.
pub type Question = Arc<dyn Fn() -> bool + Send + Sync>;

thread_local! {
    static QUESTION: RefCell<Option<Question>> = const { RefCell::new(None) };
    static PASSED: Cell<u32> = const { Cell::new(0) };
}

/// Payload of the unwinding.
struct Stopped;

/// Runs some work and returns its result; none if the answer to `question` was yes before its end.
pub fn run<T>(question: Question, work: impl FnOnce() -> T) -> Option<T> {
    let before = QUESTION.replace(Some(question));
    // State that the work leaves half done is its own, and is dropped with it.
    let outcome = catch_unwind(AssertUnwindSafe(work));
    QUESTION.set(before);
    match outcome {
        Ok(result) => Some(result),
        Err(thrown) if thrown.is::<Stopped>() => None,
        Err(thrown) => resume_unwind(thrown),
    }
}

/// Ends the work here if it is to end; to be called in each round of a loop.
#[inline]
pub fn check() {
    /// Rounds between two questions: a question may cost as much as a round.
    const ROUNDS: u32 = 16;
    let passed = PASSED.get().wrapping_add(1);
    PASSED.set(passed);
    if passed.is_multiple_of(ROUNDS) {
        check_now();
    }
}

/// Ends the work here if it is to end, asking at every call; for rounds that take a millisecond or more.
#[cold]
pub fn check_now() {
    // The answer may come from work of its own, under another question.
    let question = QUESTION.with_borrow(Clone::clone);
    if question.is_some_and(|question| question()) {
        resume_unwind(Box::new(Stopped));
    }
}

/// Wraps work for another thread, under the question of this one.
pub fn carry<T>(work: impl FnOnce() -> T) -> impl FnOnce() -> T {
    let question = QUESTION.with_borrow(Clone::clone);
    move || {
        QUESTION.set(question);
        work()
    }
}
