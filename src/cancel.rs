//! Ends long work early, at the request of the caller.
//!
//! A program that its signals end needs none of this. If another program calls the library, [`run`] runs work with a question, which the
//! loops of the simulator and of the searches repeat by [`check`]. If the answer is yes, the work is unwound to its beginning and
//! everything that it owns is dropped. So no search mistakes the stop for a failed run, and no result carries it. Threads that share the
//! work get the question by [`carry`].

use std::cell::{Cell, RefCell};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;

/// Question whether work is to end; set on every thread that does part of the work.
pub type Question = Arc<dyn Fn() -> bool + Send + Sync>;

thread_local! {
    static QUESTION: RefCell<Option<Question>> = const { RefCell::new(None) };
    static PASSED: Cell<u32> = const { Cell::new(0) };
}

/// Payload of the unwinding.
struct Stopped;

/// Runs some work and returns its result; `None` if the answer to `question` was yes before the end.
pub fn run<T>(question: Question, work: impl FnOnce() -> T) -> Option<T> {
    let before = QUESTION.replace(Some(question));
    // State that the work leaves incomplete belongs to it, and is dropped with it.
    let outcome = catch_unwind(AssertUnwindSafe(work));
    QUESTION.set(before);
    match outcome {
        Ok(result) => Some(result),
        Err(thrown) if thrown.is::<Stopped>() => None,
        Err(thrown) => resume_unwind(thrown),
    }
}

/// Ends the work here if it is to end; called in each round of a loop.
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

/// Ends the work here if it is to end; asks at every call, for rounds that take a millisecond or more.
#[cold]
pub fn check_now() {
    // The answer may come from other work, under another question.
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
