//! Command lines that reproduce the contents of a report.

use corner_impact::model::Model;

/// `corner-impact NAME MODEL REST`, without a model file for the built-in model, with options for the changed numbers.
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

/// A word quoted for a shell if it has anything but plain letters.
fn shell_word(word: &str) -> String {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "/._-+:@%,=".contains(letter);
    if !word.is_empty() && word.chars().all(plain) { word.into() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}
