//! Prepares text by others for display: a name in a file, a path, a word of the command line.
//!
//! Characters that would steer a terminal or a browser are written out, and long text is cut in the middle. Documents for programs, JSON
//! and CSV, keep the text unchanged.

use std::borrow::Cow;

/// Largest displayed length of a value, and of a sentence with values in it, characters.
const VALUE: usize = 60;
const SENTENCE: usize = 2000;
/// Mark in place of the omitted part.
const CUT: &str = "...";

/// Whether a letter is not merely displayed: control characters, and those that change the direction of writing.
fn steers(letter: char) -> bool {
    letter.is_control() || matches!(letter, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

fn written_out(text: &str, is_kept: impl Fn(char) -> bool) -> Cow<'_, str> {
    let is_seen = |letter: char| !steers(letter) || is_kept(letter);
    if text.chars().all(is_seen) {
        return text.into();
    }
    let part = |letter: char| if is_seen(letter) { letter.to_string() } else { letter.escape_default().to_string() };
    text.chars().map(part).collect()
}

fn cut(text: Cow<'_, str>, most: usize) -> Cow<'_, str> {
    let length = text.chars().count();
    if length <= most {
        return text;
    }
    let (head, tail) = ((most - CUT.len()).div_ceil(2), (most - CUT.len()) / 2);
    let ends = [text.chars().take(head).collect(), CUT.to_owned(), text.chars().skip(length - tail).collect()];
    ends.concat().into()
}

/// Makes a page, or a part of one, safe to display: lines and tabulators stay.
pub fn visible(text: &str) -> Cow<'_, str> {
    written_out(text, |letter| matches!(letter, '\n' | '\t'))
}

/// Makes an error message that contains values safe to display.
pub fn sentence(text: &str) -> Cow<'_, str> {
    cut(visible(text), SENTENCE)
}

/// Makes a value safe to display, in one line.
pub fn value(text: &str) -> Cow<'_, str> {
    cut(written_out(text, |_| false), VALUE)
}

/// Makes the text of a file safe to display with every letter at its place, in bytes, for a drawing that points into it.
pub fn in_place(text: &str) -> String {
    let mut letters = text.chars().peekable();
    let mut seen = String::with_capacity(text.len());
    while let Some(letter) = letters.next() {
        let is_end = letter == '\r' && letters.peek() == Some(&'\n');
        seen.push(match (letter, letter.len_utf8()) {
            ('\n' | '\t', _) => letter,
            _ if is_end || !steers(letter) => letter,
            (_, 1) => '?',
            (_, 2) => '\u{b7}',
            _ => '\u{fffd}',
        });
    }
    seen
}
