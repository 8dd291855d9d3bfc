//! What a command talks to: the two streams, and what is known about the terminal that they may be.

use std::ffi::OsString;
use std::io::{ErrorKind, IsTerminal, Write};

use clap::{ColorChoice, ValueEnum};
use serde::Serialize;

use super::{CommandError, Exit, complaint};
use crate::model::{ModelError, Units};
use crate::show::block::in_units;
use crate::show::{Page, Paged, json};

/// The colours that a command line asks for before it is known to be one.
pub(super) fn said(words: &[OsString]) -> ColorChoice {
    let mut said = ColorChoice::Auto;
    let mut words = words.iter().skip(1).filter_map(|word| word.to_str()).take_while(|word| *word != "--");
    while let Some(word) = words.next() {
        let value = if word == "--color" { words.next() } else { word.strip_prefix("--color=") };
        said = value.and_then(|value| ColorChoice::from_str(value, false).ok()).unwrap_or(said);
    }
    said
}

/// The lowest and the highest of the speeds that a command line asks for by `--rpm`, as far as they can be read.
pub(super) fn speeds(matches: &clap::ArgMatches) -> Option<[f64; 2]> {
    let (_, of_command) = matches.subcommand()?;
    let text = of_command.try_get_raw("rpm").ok().flatten()?.next()?.to_str()?;
    let mut parts = text.split(':').map(|part| part.trim().parse::<f64>().ok());
    let low = parts.next()??;
    Some([low, parts.next().flatten().unwrap_or(low)])
}

/// What the streams of a process are connected to, and what its environment wants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Terminal {
    /// Whether standard output is a terminal.
    pub out: bool,
    /// Whether standard error is.
    pub err: bool,
    /// Columns of the page, where something says how many there are.
    pub columns: Option<usize>,
    /// The environment wants no colour: NO_COLOR.
    pub plain: bool,
    /// The environment wants colour everywhere: CLICOLOR_FORCE.
    pub forced: bool,
    /// The terminal has none, or is not to be asked for it: TERM=dumb, CLICOLOR=0.
    pub dumb: bool,
}

impl Terminal {
    /// The fewest that a page is laid out for, and the most that can be read with ease.
    const ALLOWED: [usize; 2] = [40, 120];

    /// That of this process. COLUMNS goes before what the terminal says.
    pub fn of_process() -> Self {
        let set = |name: &str| std::env::var(name).ok().filter(|value| !value.is_empty());
        let (out, err) = (std::io::stdout().is_terminal(), std::io::stderr().is_terminal());
        let asked = set("COLUMNS").and_then(|columns| columns.trim().parse().ok()).filter(|columns| *columns > 0);
        let measured = || terminal_size::terminal_size().filter(|_| out).map(|(width, _)| usize::from(width.0));
        let is = |name: &str, wanted: &str| set(name).is_some_and(|value| value == wanted);
        Self {
            out,
            err,
            columns: asked.or_else(measured),
            plain: set("NO_COLOR").is_some(),
            forced: set("CLICOLOR_FORCE").is_some_and(|value| value != "0"),
            dumb: is("TERM", "dumb") || is("CLICOLOR", "0"),
        }
    }

    /// Columns of a page.
    pub(super) fn width(&self) -> usize {
        let [fewest, most] = Self::ALLOWED;
        self.columns.unwrap_or(crate::show::page::WIDTH).clamp(fewest, most)
    }

    fn coloured(&self, choice: ColorChoice, is_terminal: bool) -> bool {
        match choice {
            ColorChoice::Always => true,
            ColorChoice::Never => false,
            // https://no-color.org and https://bixense.com/clicolors
            ColorChoice::Auto => !self.plain && (self.forced || (is_terminal && !self.dumb)),
        }
    }
}

/// The streams of one command line.
pub(super) struct Session<'a> {
    /// Results.
    pub(super) out: &'a mut dyn Write,
    /// Complaints, notes and accounts.
    pub(super) err: &'a mut dyn Write,
    /// What they are connected to.
    pub(super) terminal: Terminal,
    /// What `--color` says.
    pub(super) color: ColorChoice,
    /// The speeds that the command line asks for, rpm.
    pub(super) rpm: Option<[f64; 2]>,
    /// Those of the model that the command is about.
    pub(super) units: Units,
}

impl Session<'_> {
    /// Columns of a page.
    pub(super) fn width(&self) -> usize {
        self.terminal.width()
    }

    /// Whether results are coloured.
    pub(super) fn colours_out(&self) -> bool {
        self.terminal.coloured(self.color, self.terminal.out)
    }

    /// Whether complaints are.
    pub(super) fn colours_err(&self) -> bool {
        self.terminal.coloured(self.color, self.terminal.err)
    }

    /// Says something on standard error.
    pub(super) fn note(&mut self, words: &str) {
        // A closed pipe leaves nobody to tell.
        let _ = writeln!(self.err, "note: {words}");
    }

    /// Complains on standard error, in the words that every complaint begins with.
    pub(super) fn complain(&mut self, words: &str) {
        // A closed pipe leaves nobody to tell.
        let _ = writeln!(self.err, "{} {words}", complaint::word(self.colours_err()));
    }

    /// The same, with the line of the model file that it is about.
    pub(super) fn complain_at(&mut self, words: &str, at: &ModelError) {
        self.complain(words);
        let shown = complaint::shown(words, at, self.colours_err(), self.terminal.err, self.width());
        let _ = self.err.write_all(shown.as_bytes());
    }

    /// Says what is wrong with a command line, or what help was asked for.
    pub(super) fn refuse(&mut self, error: &clap::Error) -> Exit {
        let text = error.render();
        let shown = |colours: bool| if colours { text.ansi().to_string() } else { text.to_string() };
        // A closed pipe leaves nobody to tell.
        if error.use_stderr() {
            let text = shown(self.colours_err());
            let _ = self.err.write_all(text.as_bytes());
            Exit::BadInput
        } else {
            let text = shown(self.colours_out());
            let _ = self.out.write_all(text.as_bytes());
            Exit::Agrees
        }
    }

    /// A page as it is printed.
    pub(super) fn shown(&self, page: &Page) -> String {
        if self.colours_out() { page.coloured().to_owned() } else { page.plain() }
    }

    /// Prints a result whole.
    pub(super) fn print(&mut self, text: &str) -> Result<(), CommandError> {
        self.out.write_all(text.as_bytes()).and_then(|()| self.out.flush()).map_err(|error| match error.kind() {
            ErrorKind::BrokenPipe => CommandError::Unread,
            _ => CommandError::Words(format!("standard output: {error}")),
        })
    }

    /// Prints what was found: one document for a program, or the page for people, in as many columns as there are.
    pub(super) fn answer(&mut self, found: &(impl Serialize + Paged), as_json: bool) -> Result<Exit, CommandError> {
        let text = if as_json {
            json::render(found, &self.units)?
        } else {
            self.shown(&Page::of(self.width(), &in_units(found.blocks(), &self.units))?)
        };
        self.print(&text)?;
        Ok(Exit::Agrees)
    }
}
