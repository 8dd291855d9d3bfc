//! Errors in a model file, as values that point to a place in it.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use crate::untrusted;

/// Error in a model file: its place, the value found, and the values allowed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct ModelError {
    /// File as the user named it.
    pub file: Box<str>,
    /// Line in the file, from 1; for a missing field, the line of its table.
    pub line: Option<usize>,
    /// Dotted path of the field.
    pub field: Option<String>,
    /// Value as written.
    pub value: Option<String>,
    /// Allowed values, or the error.
    pub allowed: String,
    /// Exact place in the text, and a suggestion.
    pub pointer: Box<Pointer>,
}

/// Place of an error, and a suggested correction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pointer {
    /// Text of the file, if there is one.
    pub text: Option<Arc<str>>,
    /// Range of the text with the error, in bytes.
    pub span: Option<Range<usize>>,
    /// Suggested correction, as a question.
    pub meant: Option<String>,
}

impl ModelError {
    pub(crate) fn file(file: &str, allowed: String) -> Self {
        Self { file: file.into(), line: None, field: None, value: None, allowed, pointer: Box::default() }
    }

    /// Field, if any, followed by its allowed values.
    pub fn rule(&self) -> String {
        self.field.as_ref().map_or_else(|| self.allowed.clone(), |field| format!("{field} {}", self.allowed))
    }

    /// Sets the place to `span` of `text`.
    pub(super) fn at(mut self, text: Option<Arc<str>>, span: Option<Range<usize>>) -> Self {
        (self.pointer.text, self.pointer.span) = (text, span);
        self
    }

    /// Adds a suggested correction, a question.
    pub fn meaning(mut self, meant: Option<String>) -> Self {
        self.pointer.meant = meant;
        self
    }

    /// Appends a description of the value found instead.
    pub fn found(mut self, words: &str) -> Self {
        self.allowed.push_str(words);
        self
    }

    /// Sets the place in the error's line of `text`: `value` if the line contains it, else the whole line.
    pub(super) fn in_line(self, text: &str, value: Option<&str>) -> Self {
        let Some(line) = self.line else { return self };
        let start = text.split_inclusive('\n').take(line - 1).map(str::len).sum::<usize>();
        let Some(written) = text[start..].lines().next() else { return self };
        let place =
            value.filter(|value| !value.is_empty()).and_then(|value| Some((written.rfind(value)?, value.len())));
        let (at, length) = place.unwrap_or((0, written.len()));
        self.at(Some(text.into()), Some(start + at..start + at + length))
    }
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", untrusted::visible(&self.file))?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        let [field, value] = [&self.field, &self.value].map(|part| part.as_deref().map(untrusted::value));
        let allowed = untrusted::sentence(&self.allowed);
        match (field, value) {
            (Some(field), Some(value)) => write!(f, ": {field} = {value}: {allowed}")?,
            (Some(field), None) => write!(f, ": {field} {allowed}")?,
            _ => write!(f, ": {allowed}")?,
        }
        self.pointer.meant.as_ref().map_or(Ok(()), |meant| write!(f, "; {meant}"))
    }
}
