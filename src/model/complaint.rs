//! What is wrong with a model file, as a value that points into it.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use crate::foreign;

/// A complaint about a model file: where, what was found, what would be allowed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct ModelError {
    /// The file as the user named it.
    pub file: Box<str>,
    /// Line in the file, from 1; of the table where a field is missing.
    pub line: Option<usize>,
    /// Dotted path of the field.
    pub field: Option<String>,
    /// The value as written.
    pub value: Option<String>,
    /// What is wrong and what is allowed.
    pub allowed: String,
    /// Where exactly, and what may have been meant.
    pub pointer: Box<Pointer>,
}

/// What a complaint points at.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pointer {
    /// The file's text, where there is some.
    pub text: Option<Arc<str>>,
    /// What the complaint is about, in bytes of the text.
    pub span: Option<Range<usize>>,
    /// What may have been meant, as a question.
    pub meant: Option<String>,
}

impl ModelError {
    pub(crate) fn file(file: &str, allowed: String) -> Self {
        Self { file: file.into(), line: None, field: None, value: None, allowed, pointer: Box::default() }
    }

    /// What is allowed, of which field.
    pub fn rule(&self) -> String {
        self.field.as_ref().map_or_else(|| self.allowed.clone(), |field| format!("{field} {}", self.allowed))
    }

    /// The same complaint, pointing at `span` of `text`.
    pub(super) fn at(mut self, text: Option<Arc<str>>, span: Option<Range<usize>>) -> Self {
        (self.pointer.text, self.pointer.span) = (text, span);
        self
    }

    /// The same complaint with what may have been meant, a question.
    pub(super) fn meaning(mut self, meant: Option<String>) -> Self {
        self.pointer.meant = meant;
        self
    }

    /// The same complaint with what was found instead.
    pub(super) fn found(mut self, words: &str) -> Self {
        self.allowed.push_str(words);
        self
    }

    /// The same complaint, pointing at its line of `text`: at `value` in it where it is there, else at all of it.
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
        write!(f, "{}", foreign::visible(&self.file))?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        let [field, value] = [&self.field, &self.value].map(|part| part.as_deref().map(foreign::value));
        let allowed = foreign::sentence(&self.allowed);
        match (field, value) {
            (Some(field), Some(value)) => write!(f, ": {field} = {value}: {allowed}")?,
            (Some(field), None) => write!(f, ": {field} {allowed}")?,
            _ => write!(f, ": {allowed}")?,
        }
        self.pointer.meant.as_ref().map_or(Ok(()), |meant| write!(f, "; {meant}"))
    }
}
