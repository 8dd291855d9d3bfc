//! Command lines of the program that reproduce results shown in a report or on the live page.

use crate::model::Model;

/// Command line `corner-impact NAME MODEL REST`, without a model file for the built-in model, with options for the changed numbers.
pub fn command(name: &str, model: &Model, rest: &str) -> String {
    let words = format!("corner-impact {name}{}", named(model));
    if rest.is_empty() { words } else { format!("{words} {rest}") }
}

/// Words that name a model on a command line, each after a blank: its file, and options for the changed numbers.
pub fn named(model: &Model) -> String {
    let file = model.path().map(|path| format!(" {}", shell_word(&path.to_string_lossy())));
    file.unwrap_or_default() + &changed(model)
}

/// Options for the changed numbers of a model, each after a blank.
pub fn changed(model: &Model) -> String {
    let set = |(path, number): &(String, f64)| format!(" --set {}", shell_word(&format!("{path}={number}")));
    model.changes().iter().map(set).collect()
}

/// Returns a word, quoted for a shell if it has anything but plain letters.
pub fn shell_word(word: &str) -> String {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "/._-+:@%,=".contains(letter);
    if !word.is_empty() && word.chars().all(plain) { word.into() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}
