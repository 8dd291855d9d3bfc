//! Command lines that do again what a report shows.

use crate::model::Model;

/// `corner-impact NAME MODEL REST`, without a model file where the model is built in, with the numbers that are changed.
pub(crate) fn command(name: &str, model: &Model, rest: &str) -> String {
    let mut words = format!("corner-impact {name}");
    if let Some(path) = model.path() {
        words = format!("{words} {}", shell_word(&path.to_string_lossy()));
    }
    for (path, number) in model.changes() {
        words = format!("{words} --set {}", shell_word(&format!("{path}={number}")));
    }
    if rest.is_empty() { words } else { format!("{words} {rest}") }
}

/// A word as a shell takes it: in quotes where it has anything but plain letters.
fn shell_word(word: &str) -> String {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "/._-+:@%,=".contains(letter);
    if !word.is_empty() && word.chars().all(plain) { word.into() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}
