//! Display of an error in a model file: its line with the wrong part underlined, and a suggestion.

use std::error::Error;
use std::fmt;

use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, SourceCode};

use corner_impact::model::ModelError;
use corner_impact::untrusted;

/// Error in the form that miette displays.
#[derive(Debug)]
struct Pointed<'a> {
    at: &'a ModelError,
    /// Whether the error is in the file itself, and not in a computation's result.
    is_of_the_file: bool,
    source: NamedSource<String>,
}

impl fmt::Display for Pointed<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.at)
    }
}

impl Error for Pointed<'_> {}

/// Largest length of the words under a line.
const LONGEST_LABEL: usize = 72;

/// Largest length of a displayed line of a file, bytes.
const LONGEST_LINE: usize = 2000;

impl Diagnostic for Pointed<'_> {
    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(&self.source)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let span = self.at.pointer.span.clone()?;
        let label = if self.at.allowed.chars().count() > LONGEST_LABEL { "here" } else { &self.at.allowed };
        Some(Box::new(std::iter::once(LabeledSpan::new_with_span(Some(label.to_owned()), span))))
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        match &self.at.pointer.meant {
            Some(meant) => Some(Box::new(meant)),
            None if !self.is_of_the_file || self.at.file.ends_with(".csv") => None,
            None => Some(Box::new("`corner-impact new` writes a model file in which every field is explained")),
        }
    }
}

/// Word `error:` at the beginning of every error message.
pub(super) fn word(coloured: bool) -> &'static str {
    if coloured { "\x1b[1;31merror:\x1b[0m" } else { "error:" }
}

/// Displays the line of the file with the error; empty if there is none. Without a terminal it uses only characters that any log can store.
pub(super) fn shown(words: &str, at: &ModelError, coloured: bool, is_terminal: bool, width: usize) -> String {
    let (Some(text), Some(_)) = (&at.pointer.text, &at.pointer.span) else { return String::new() };
    let lines = || text.lines().filter(|line| line.len() > LONGEST_LINE);
    // Files that are not written by people are not displayed.
    if lines().next().is_some() {
        return String::new();
    }
    let theme = match (is_terminal, coloured) {
        (true, true) => GraphicalTheme::unicode(),
        (true, false) => GraphicalTheme::unicode_nocolor(),
        (false, true) => GraphicalTheme::ascii(),
        (false, false) => GraphicalTheme::none(),
    };
    let is_of_the_file = words == at.to_string();
    let pointed = Pointed {
        at,
        is_of_the_file,
        source: NamedSource::new(untrusted::visible(&at.file), untrusted::in_place(text)),
    };
    let handler = GraphicalReportHandler::new_themed(theme).with_links(false).with_width(width);
    let mut drawn = String::new();
    if handler.render_report(&mut drawn, &pointed).is_err() {
        return String::new();
    }
    // The words were already printed above, in one line that other programs can read.
    let body = drawn.lines().skip_while(|line| !line.contains("-[") && !line.contains("\u{2500}["));
    body.flat_map(|line| [line, "\n"]).collect()
}
