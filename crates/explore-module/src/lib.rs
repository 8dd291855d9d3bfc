//! The live page's answers for a browser: a question is put into memory, and its answer is read from there.
//!
//! The page calls `allocate` with the length of a question, writes it there, and calls `answer`, which returns where the answer stands.
//! `answer_length` is its length. Question and answer are UTF-8. The answer stays until the next call of `answer`.

use std::cell::RefCell;

thread_local! {
    static QUESTION: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static ANSWER: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Makes room for a question of `length` bytes, and returns where it is to be written.
#[unsafe(no_mangle)]
pub extern "C" fn allocate(length: usize) -> *mut u8 {
    QUESTION.with_borrow_mut(|question| {
        question.clear();
        question.resize(length, 0);
        question.as_mut_ptr()
    })
}

/// Answers the question that was written, and returns where the answer stands.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const u8 {
    let question = QUESTION.take();
    ANSWER.set(corner_impact_explore::respond(&String::from_utf8_lossy(&question)));
    ANSWER.with_borrow(|answer| answer.as_ptr())
}

/// Length of the answer, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn answer_length() -> usize {
    ANSWER.with_borrow(String::len)
}
