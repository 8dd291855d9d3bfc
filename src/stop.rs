//! How work that takes long is ended before its end, by whoever waits for it.
//!
//! A program ends with its signals, and needs none of this. Where another program calls the library, [`unless`] does work
//! under a question, which the loops of the simulator and of the searches put again and again by [`heed`]. Where the answer is
//! yes, the work is unwound to where it began, and everything that it holds is dropped on the way: no search takes the end
//! for a run that failed, and no result carries it. Threads that work is shared with get the question by [`carried`].

use std::cell::{Cell, RefCell};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;

/// Whether work is to end; put on every thread that does some of it.
pub type Question = Arc<dyn Fn() -> bool + Send + Sync>;

thread_local! {
    static QUESTION: RefCell<Option<Question>> = const { RefCell::new(None) };
    static PASSED: Cell<u32> = const { Cell::new(0) };
}

/// What unwinds.
struct Stopped;

/// The result of some work; none where the answer to `question` was yes before its end.
pub fn unless<T>(question: Question, work: impl FnOnce() -> T) -> Option<T> {
    let before = QUESTION.replace(Some(question));
    // What the work leaves half done is its own, and goes with it.
    let outcome = catch_unwind(AssertUnwindSafe(work));
    QUESTION.set(before);
    match outcome {
        Ok(result) => Some(result),
        Err(thrown) if thrown.is::<Stopped>() => None,
        Err(thrown) => resume_unwind(thrown),
    }
}

/// Ends the work here where it is to end; for loops, each round.
#[inline]
pub fn heed() {
    /// Rounds between two questions: a question may cost as much as a round.
    const ROUNDS: u32 = 16;
    let passed = PASSED.get().wrapping_add(1);
    PASSED.set(passed);
    if passed.is_multiple_of(ROUNDS) {
        ask();
    }
}

/// The same, for rounds that take a millisecond or more.
#[cold]
pub fn ask() {
    // The answer may come from work of its own, under another question.
    let question = QUESTION.with_borrow(Clone::clone);
    if question.is_some_and(|question| question()) {
        resume_unwind(Box::new(Stopped));
    }
}

/// Work for another thread, under the question of this one.
pub fn carried<T>(work: impl FnOnce() -> T) -> impl FnOnce() -> T {
    let question = QUESTION.with_borrow(Clone::clone);
    move || {
        QUESTION.set(question);
        work()
    }
}
