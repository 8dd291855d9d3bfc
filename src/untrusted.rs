//! Prepares text by others for display: a name in a file, a path, a word of the command line.
//!
//! Characters that would steer a terminal or a browser, and invisible ones, are written as escapes. Long text is cut in the middle. JSON
//! writes these characters by its own escapes, so that programs read the text unchanged; CSV keeps them.

use std::borrow::Cow;

/// Largest displayed length of a message, of a value, and of a sentence with values in it, characters. A message is a sentence after one
/// word.
pub const MESSAGE: usize = 2000;
/// Room for that word, in a message.
pub const PREFIX: usize = 20;
const VALUE: usize = 60;
const SENTENCE: usize = MESSAGE - PREFIX;
/// Mark in place of the omitted part.
const CUT: &str = "...";

/// Characters that are not displayed: the property Default_Ignorable_Code_Point of Unicode 17, and the separators of lines and paragraphs.
/// The property includes all characters that change the direction of writing, Bidi_Control.
const UNSEEN: [(char, char); 18] = [
    ('\u{ad}', '\u{ad}'),
    ('\u{34f}', '\u{34f}'),
    ('\u{61c}', '\u{61c}'),
    ('\u{115f}', '\u{1160}'),
    ('\u{17b4}', '\u{17b5}'),
    ('\u{180b}', '\u{180f}'),
    ('\u{200b}', '\u{200f}'),
    ('\u{2028}', '\u{2029}'),
    ('\u{202a}', '\u{202e}'),
    ('\u{2060}', '\u{206f}'),
    ('\u{3164}', '\u{3164}'),
    ('\u{fe00}', '\u{fe0f}'),
    ('\u{feff}', '\u{feff}'),
    ('\u{ffa0}', '\u{ffa0}'),
    ('\u{fff0}', '\u{fff8}'),
    ('\u{1bca0}', '\u{1bca3}'),
    ('\u{1d173}', '\u{1d17a}'),
    ('\u{e0000}', '\u{e0fff}'),
];

/// Whether a character steers a display or is invisible.
fn steers(letter: char) -> bool {
    letter.is_control() || UNSEEN.iter().any(|(first, last)| (*first..=*last).contains(&letter))
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

/// Escapes the steering characters of a JSON document, which leaves its values as they are.
pub fn json(document: String) -> String {
    if !document.chars().any(|letter| letter != '\n' && steers(letter)) {
        return document;
    }
    let part = |letter: char| match letter {
        '\n' => letter.to_string(),
        _ if steers(letter) => letter.encode_utf16(&mut [0; 2]).iter().map(|unit| format!("\\u{unit:04x}")).collect(),
        _ => letter.to_string(),
    };
    document.chars().map(part).collect()
}

/// Makes the text of a file safe to display with every letter at its position, in bytes, for a drawing that points into it.
pub fn in_place(text: &str) -> String {
    let mut letters = text.chars().peekable();
    let mut seen = String::with_capacity(text.len());
    while let Some(letter) = letters.next() {
        let is_end = letter == '\r' && letters.peek() == Some(&'\n');
        match (letter, letter.len_utf8()) {
            ('\n' | '\t', _) => seen.push(letter),
            _ if is_end || !steers(letter) => seen.push(letter),
            (_, 1) => seen.push('?'),
            (_, 2) => seen.push('\u{b7}'),
            (_, 3) => seen.push('\u{fffd}'),
            _ => seen.push_str("\u{b7}\u{b7}"),
        }
    }
    seen
}
