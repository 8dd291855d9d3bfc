//! Streams of a command, and the terminal behind them.

use std::ffi::OsString;
use std::io::{ErrorKind, IsTerminal, Write};
use std::path::PathBuf;

use clap::builder::Str;
use clap::error::{ContextKind, ContextValue, ErrorKind as Kind};
use clap::{ColorChoice, ValueEnum};
use serde::Serialize;

use super::picture::ends_in;
use super::{CommandError, Exit, complaint, next};
use crate::show::block::in_units;
use crate::show::page::options;
use crate::show::{Page, Paged};
use corner_impact::json;
use corner_impact::model::{ModelError, Units, nearest};
use corner_impact::untrusted;

/// Value of `--color`, read before the command line is parsed.
pub(super) fn said(words: &[OsString]) -> ColorChoice {
    let mut said = ColorChoice::Auto;
    let mut words = words.iter().skip(1).filter_map(|word| word.to_str()).take_while(|word| *word != "--");
    while let Some(word) = words.next() {
        let value = if word == "--color" { words.next() } else { word.strip_prefix("--color=") };
        said = value.and_then(|value| ColorChoice::from_str(value, false).ok()).unwrap_or(said);
    }
    said
}

/// Ranges of `--over`, as `NAME=LO:HI`.
fn axes(of_command: &clap::ArgMatches) -> impl Iterator<Item = String> {
    let all = of_command.try_get_raw("over").ok().flatten().into_iter().flatten();
    all.filter_map(|axis| Some(axis.to_str()?.split(':').take(2).collect::<Vec<_>>().join(":")))
}

/// Lowest and highest speed requested by `--rpm` or `--over rpm=`, if they can be parsed. The axis takes precedence.
pub(super) fn speeds(matches: &clap::ArgMatches) -> Option<[f64; 2]> {
    let (_, of_command) = matches.subcommand()?;
    let axis = axes(of_command).find_map(|axis| axis.strip_prefix("rpm=").map(str::to_owned));
    let rpm = || Some(of_command.try_get_raw("rpm").ok().flatten()?.next()?.to_str()?.to_owned());
    let text = axis.or_else(rpm)?;
    let mut parts = text.split(':').map(|part| part.trim().parse::<f64>().ok());
    let low = parts.next()??;
    Some([low, parts.next().flatten().unwrap_or(low)])
}

/// Words of a command line for an error message.
fn shown(value: &ContextValue) -> ContextValue {
    match value {
        ContextValue::String(text) => ContextValue::String(untrusted::value(text).into_owned()),
        ContextValue::Strings(texts) => {
            ContextValue::Strings(texts.iter().map(|text| untrusted::value(text).into_owned()).collect())
        }
        other => other.clone(),
    }
}

/// Unknown option of a command, without its hyphens.
fn unknown_option(error: &clap::Error) -> Option<&str> {
    let unknown = error.get(ContextKind::InvalidArg).filter(|_| error.kind() == Kind::UnknownArgument);
    let Some(ContextValue::String(option)) = unknown else { return None };
    option.strip_prefix("--")?.split(['=', ' ']).next()
}

/// Words for an option in other programs, or in earlier versions of other commands.
const SYNONYMS: [(&str, &str); 15] = [
    ("parameter", "over"),
    ("against", "over"),
    ("from-rpm", "rpm"),
    ("summary", "json"),
    ("trace", "out"),
    ("speed", "rpm"),
    ("output", "out"),
    ("file", "out"),
    ("svg", "out"),
    ("png", "out"),
    ("pdf", "out"),
    ("csv", "out"),
    ("spring", "stiffness"),
    ("rate", "stiffness"),
    ("verbose", "all"),
];

/// Option of a command for which an unknown one was meant: a typing error, or a word of other programs.
fn near_option(command: &clap::Command, error: &clap::Error) -> Option<String> {
    let longs = || command.get_arguments().filter(|argument| !argument.is_hide_set()).filter_map(clap::Arg::get_long);
    let unknown = unknown_option(error)?;
    let same = SYNONYMS.iter().find(|(other, own)| *other == unknown && longs().any(|long| long == *own));
    same.map(|(_, own)| *own).or_else(|| nearest(unknown, longs())).map(|near| format!("--{near}"))
}

/// First example in the help of a command.
fn example(command: &clap::Command) -> Option<String> {
    let help = command.get_after_help()?.to_string();
    help.lines().map(str::trim).find(|line| line.starts_with("corner-impact ")).map(str::to_owned)
}

/// Whether an error is about this option.
fn is_of(error: &clap::Error, context: ContextKind, option: &str) -> bool {
    matches!(error.get(context), Some(ContextValue::String(name)) if name.starts_with(option))
}

/// Commands that accept an option which another one rejects; `None` if there are none.
fn taken_by(command: &clap::Command, error: &clap::Error) -> Option<String> {
    if error.kind() == Kind::ArgumentConflict && is_of(error, ContextKind::InvalidArg, "--over") {
        return is_of(error, ContextKind::PriorArg, "--over").then(|| "note: `chart` varies two numbers".into());
    }
    let name = unknown_option(error)?;
    let takes = |sub: &&clap::Command| {
        sub.get_arguments().any(|argument| argument.get_long() == Some(name) && !argument.is_hide_set())
    };
    let names: Vec<&str> = command.get_subcommands().filter(takes).map(clap::Command::get_name).collect();
    (!names.is_empty()).then(|| format!("note: --{name} is an option of {}", names.join(", ")))
}

/// Wraps lines to the columns of a terminal, if there is one.
pub(super) fn in_columns(text: &str, columns: Option<usize>) -> String {
    let Some(columns) = columns else { return text.to_owned() };
    let wrapped = |line: &str| {
        let indent = " ".repeat(line.len() - line.trim_start().len() + 4);
        textwrap::fill(line, options(columns).subsequent_indent(&indent)) + "\n"
    };
    text.lines().map(wrapped).collect()
}

/// Whether a command line requests no file.
pub(super) fn only_prints(command: &clap::Command, matches: &clap::ArgMatches) -> bool {
    let Some((name, given)) = matches.subcommand() else { return false };
    let arguments = command.find_subcommand(name).map(clap::Command::get_arguments).into_iter().flatten();
    // A report writes a file even if none is named, and a live page is shown in a browser.
    let of_files = |names: &[Str]| names.iter().any(|name| ["FILE", "DIR"].contains(&name.as_str()));
    let mut files = arguments.filter(|argument| argument.get_value_names().is_some_and(of_files));
    !["report", "explore"].contains(&name)
        && files.all(|file| given.get_raw(file.get_id().as_str()).is_none_or(|mut names| names.all(|name| name == "-")))
}

/// Terminals behind the streams of a process, and the settings of its environment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Terminal {
    /// Whether standard output is a terminal.
    pub out: bool,
    /// Whether standard error is a terminal.
    pub err: bool,
    /// Columns of the page, if known.
    pub columns: Option<usize>,
    /// Whether the environment forbids colour: NO_COLOR.
    pub plain: bool,
    /// Whether the environment requests colour everywhere: CLICOLOR_FORCE.
    pub forced: bool,
    /// Whether the terminal has no colour, or colour is switched off: TERM=dumb, CLICOLOR=0.
    pub dumb: bool,
    /// Whether results go to standard output of this process, and not to a program that calls the library.
    pub is_process: bool,
}

impl Terminal {
    /// Smallest number of columns of a page, and the largest that is easy to read.
    const ALLOWED: [usize; 2] = [40, 120];

    /// Terminal of this process. COLUMNS takes precedence over the measured width.
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
            is_process: true,
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

/// Streams of one command line.
pub(super) struct Session<'a> {
    /// Results.
    pub(super) out: &'a mut dyn Write,
    /// Errors, notes and accounts.
    pub(super) err: &'a mut dyn Write,
    /// Terminals behind both streams.
    pub(super) terminal: Terminal,
    /// Value of `--color`.
    pub(super) color: ColorChoice,
    /// Whether only results and errors are printed.
    pub(super) quiet: bool,
    /// Number of threads that share the work; `None` for the default.
    pub(super) threads: Option<usize>,
    /// Speeds requested on the command line, rpm.
    pub(super) rpm: Option<[f64; 2]>,
    /// Units of the model that the command is about.
    pub(super) units: Units,
    /// Name of the model.
    pub(super) model: String,
    /// Words that name the model on a command line, each after a blank.
    pub(super) named: String,
    /// Destination and form of the result.
    pub(super) wishes: Wishes,
}

/// The form of a result.
#[derive(clap::Args)]
pub(super) struct AnswerArguments {
    /// Print one JSON document instead of the page.
    #[arg(long, alias = "summary")]
    pub(super) json: bool,
    /// Show every column of a table that is too wide for the page, row by row.
    #[arg(long, conflicts_with = "json")]
    pub(super) all: bool,
}

/// Destination and form of a result, as requested on the command line.
#[derive(Debug, Default)]
pub(super) struct Wishes {
    /// File of the result, if any.
    pub(super) file: Option<PathBuf>,
    /// Whether to open the file.
    open: bool,
    /// Whether the result is for a program.
    json: bool,
    /// Range of a number other than the speed, without the number of its values.
    axis: Option<String>,
}

impl Wishes {
    /// Reads the requests from the parsed command line. A command that chooses the name of its file adds it later.
    pub(super) fn of(matches: &clap::ArgMatches) -> Self {
        let Some((_, given)) = matches.subcommand() else { return Self::default() };
        let flag = |name: &str| given.try_get_one::<bool>(name).ok().flatten() == Some(&true);
        let file = |name: &&str| Some(PathBuf::from(given.try_get_raw(name).ok().flatten()?.next()?));
        let axis = axes(given).find(|axis| !axis.starts_with("rpm="));
        Self { file: ["out", "phase_plane"].iter().find_map(file), open: flag("open"), json: flag("json"), axis }
    }
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

    /// Whether errors are coloured.
    pub(super) fn colours_err(&self) -> bool {
        self.terminal.coloured(self.color, self.terminal.err)
    }

    /// Prints a note on standard error.
    pub(super) fn note(&mut self, words: &str) {
        if self.quiet {
            return;
        }
        // If the pipe is closed, the failure cannot be reported.
        let _ = writeln!(self.err, "{}", self.in_width(&format!("note: {}", untrusted::sentence(words))));
    }

    /// Columns of the terminal behind standard error, if any.
    pub(super) fn columns_err(&self) -> Option<usize> {
        self.terminal.err.then(|| self.width())
    }

    /// Wraps a sentence to the lines of a terminal; without a terminal it stays in one line.
    fn in_width(&self, words: &str) -> String {
        if self.terminal.err {
            textwrap::fill(words, options(self.width()).subsequent_indent("  "))
        } else {
            words.to_owned()
        }
    }

    /// Notes how many parts of a survey failed, and the first reason: tables do not give reasons.
    pub(super) fn failures(&mut self, what: &str, [count, all]: [usize; 2], first: &str) {
        self.note(&format!("{count} of {all} {what} could not be run; the first is {first}"));
    }

    /// Tells a user at a terminal which file was written, and opens it on request with the program for its kind.
    pub(super) fn open(&mut self) {
        let Some(path) = self.wishes.file.clone().filter(|path| path.is_file()) else { return };
        // `report` prints the name of its page.
        if self.terminal.err && !ends_in(&path, &["html", "htm"]) {
            self.note(&format!("wrote {}", path.display()));
        }
        if self.wishes.open && open::that_detached(&path).is_err() {
            self.note(&format!("{} is written, but no program here opens it", path.display()));
        }
    }

    /// Tells a user at a terminal which command usually follows.
    pub(super) fn tell_next(&mut self, template: &str) -> Result<(), CommandError> {
        let is_table = self.wishes.file.as_ref().is_some_and(|path| path.as_os_str() == "-");
        if template.is_empty() || !self.terminal.out || self.quiet || self.wishes.json || is_table {
            return Ok(());
        }
        let next = next::filled(template, &self.named, self.rpm, self.wishes.axis.as_deref());
        self.print(&format!("next: corner-impact {next}\n"))
    }

    /// Prints an error on standard error, with the usual beginning.
    pub(super) fn complain(&mut self, words: &str) {
        // If the pipe is closed, the failure cannot be reported.
        let words = format!("{} {}", complaint::word(self.colours_err()), untrusted::sentence(words));
        let _ = writeln!(self.err, "{}", self.in_width(&words));
    }

    /// Prints an error with its line of the model file.
    pub(super) fn complain_at(&mut self, words: &str, at: &ModelError) {
        self.complain(words);
        let shown = complaint::shown(words, at, self.colours_err(), self.terminal.err, self.width());
        // A message must fit a page.
        if shown.chars().count() + untrusted::sentence(words).chars().count() > untrusted::MESSAGE - untrusted::PREFIX {
            return;
        }
        let _ = self.err.write_all(shown.as_bytes());
    }

    /// Prints the error of a command line, or the requested help.
    pub(super) fn refuse(
        &mut self,
        command: &clap::Command,
        words: &[OsString],
        mut error: clap::Error,
    ) -> Result<Exit, CommandError> {
        let others = taken_by(command, &error);
        let called = words.iter().skip(1).find_map(|word| command.find_subcommand(word));
        let place = |name: &str| words.iter().position(|word| word.to_string_lossy().starts_with(name));
        let unknown = unknown_option(&error).and_then(|option| place(&format!("--{option}")));
        let is_early = unknown.zip(called).is_some_and(|(option, called)| Some(option) < place(called.get_name()));
        if error.kind() == Kind::UnknownArgument {
            // The suggestion "-- --json" would make it the name of a file.
            error.remove(ContextKind::Suggested);
            error.remove(ContextKind::SuggestedArg);
            if let Some(near) = called.filter(|_| !is_early).and_then(|called| near_option(called, &error)) {
                error.insert(ContextKind::SuggestedArg, ContextValue::String(near));
            }
            // Clap writes the option that it would suggest into the usage.
            let usage = called.filter(|_| !is_early).unwrap_or(command).clone().render_usage();
            error.insert(ContextKind::Usage, ContextValue::StyledStr(usage));
        }
        // Advice that repeats an unreadable word is omitted.
        let is_odd =
            |value: &ContextValue| matches!(value, ContextValue::String(text) if untrusted::value(text) != *text);
        if error.context().any(|(_, value)| is_odd(value)) {
            error.remove(ContextKind::Suggested);
        }
        let foreign: Vec<_> = error.context().map(|(kind, value)| (kind, shown(value))).collect();
        for (kind, value) in foreign {
            error.insert(kind, value);
        }
        let others = match error.kind() {
            _ if is_early => Some("note: options of a command come after it".into()),
            Kind::InvalidSubcommand => {
                Some("note: `corner-impact MODEL` lists what you can do with a model file or a table of lifts".into())
            }
            _ => others,
        };
        let text = error.render();
        let shown = |colours: bool| if colours { text.ansi().to_string() } else { text.to_string() };
        if error.use_stderr() {
            let text = in_columns(&shown(self.colours_err()), self.columns_err());
            let text = text.replace("invalid digit found in string", "must be a whole number");
            let text = text.replace("<--out <FILE>>", "--out <FILE>");
            let others = others.map_or(String::new(), |others| format!("{}\n", self.in_width(&others)));
            let example = called.and_then(example).map_or(String::new(), |line| format!("example: {line}\n"));
            let text = format!("{text}{others}{example}");
            // If the pipe is closed, the failure cannot be reported.
            let _ = self.err.write_all(text.as_bytes());
            Ok(Exit::BadInput)
        } else {
            let text = shown(self.colours_out());
            self.print(&text)?;
            Ok(Exit::Agrees)
        }
    }

    /// Returns a page as it is printed.
    pub(super) fn shown(&self, page: &Page) -> String {
        if self.colours_out() { page.coloured().to_owned() } else { page.plain() }
    }

    /// Prints a complete result.
    pub(super) fn print(&mut self, text: &str) -> Result<(), CommandError> {
        self.out.write_all(text.as_bytes()).and_then(|()| self.out.flush()).map_err(|error| match error.kind() {
            ErrorKind::BrokenPipe => CommandError::Unread,
            _ => CommandError::Words(format!("standard output: {error}")),
        })
    }

    /// Prints a result: one document for programs, or the page for people, in the available columns.
    pub(super) fn answer(
        &mut self,
        found: &(impl Serialize + Paged),
        asked: &AnswerArguments,
    ) -> Result<Exit, CommandError> {
        let text = if asked.json {
            json::render(found, &self.units)?
        } else {
            self.shown(&Page::of(self.width(), asked.all, &in_units(found.blocks(), &self.units))?)
        };
        self.print(&text)?;
        Ok(Exit::Agrees)
    }
}
