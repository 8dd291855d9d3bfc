//! Command line: parse, one library call, exit code. Results go to standard output, errors to standard error.

mod about;
mod basins;
mod cam;
mod certify;
mod chaos;
mod chart;
mod claims;
mod compare;
mod complaint;
mod completions;
mod continuation;
mod curve;
mod design;
mod diagram;
mod explain;
mod explore;
mod external;
mod figure;
mod help;
mod locate;
mod man;
mod model;
mod new;
mod next;
mod numbers;
mod orbit;
mod over;
mod picture;
mod progress;
mod report;
mod session;
mod signals;
mod simulate;
mod speeds;
mod standard;
mod start;
mod threads;
mod verify;

use std::error::Error;
use std::ffi::OsString;
use std::io::Write;

use clap::{ColorChoice, FromArgMatches, Parser, Subcommand};

use model::ModelArgument;
use session::AnswerArguments;
use session::Session;
pub use session::Terminal;
use session::Wishes;
pub use signals::watch as clear_on_signals;

use corner_impact::cancel;
use corner_impact::file::FileError;
use corner_impact::model::{ModelError, Units};
use corner_impact::simulate::SimulateError;

/// Outcome of a command, which is the process's exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Success: everything checked agrees.
    Agrees = 0,
    /// Success, but a check disagrees.
    Disagrees = 1,
    /// Wrong usage, model file or data.
    BadInput = 2,
}

/// Computes separation, impacts and chaos of cam followers, and verifies the corner-impact bifurcation by independent routes.
#[derive(Parser)]
#[command(name = "corner-impact", bin_name = "corner-impact", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// Condition for colours in pages, errors and help.
    #[arg(long, global = true, value_enum, value_name = "WHEN", default_value = "auto")]
    color: ColorChoice,
    /// Print only results and errors: no notes, progress or `next:`.
    #[arg(long, short, global = true)]
    quiet: bool,
    /// Number of threads that share the work [default: RAYON_NUM_THREADS, or one per core].
    #[arg(long, global = true, value_name = "N", value_parser = threads::threads, allow_hyphen_values = true)]
    threads: Option<usize>,
}

/// The subcommands: one line each, under the heading that `--help` lists it by, with the command that usually follows. A module has `Arguments` and
/// `run`.
macro_rules! subcommands {
    ($($heading:literal: $($name:ident = $module:ident => $next:literal,)+)+) => {
        #[derive(Subcommand)]
        enum Command {
            $($($name($module::Arguments),)+)+
        }

        impl Command {
            fn run(&self, session: &mut Session<'_>) -> Result<Exit, CommandError> {
                match self {
                    $($(Self::$name(arguments) => $module::run(arguments, session),)+)+
                }
            }

            /// Template of the command that usually follows; empty for none.
            fn next(&self) -> &'static str {
                match self {
                    $($(Self::$name(_) => $next,)+)+
                }
            }
        }

        /// Headings of `--help`, each with its commands.
        const GROUPS: &[(&str, &[&str])] = &[$(($heading, &[$(stringify!($name)),+])),+];
    };
}

subcommands! {
    "A machine of your own":
        New = new => "cam{model}",
        Cam = cam => "design{model}",
        Design = design => "simulate{model} --rpm {rpm}",
        Simulate = simulate => "speeds{model}",
        Speeds = speeds => "report{model}",
        Explore = explore => "",
        Report = report => "compare{model} --set NAME=VALUE",
        Compare = compare => "explain speed_rpm{model}",
    "Attractors, periodic orbits and bifurcations":
        Diagram = diagram => "chart{model} --over rpm={range} --over restitution=0.5:0.95",
        Chart = chart => "curve{model} --rpm {range} --over {axis}",
        Basins = basins => "orbit{model} --rpm {rpm}",
        Orbit = orbit => "continue{model} --rpm {rpm} --over rpm={range}",
        Continue = continuation => "curve{model} --rpm {range} --over {axis}",
        Curve = curve => "chart{model} --over rpm={range} --over {axis} --with-curves --out chart.svg",
        Chaos = chaos => "orbit{model} --rpm {rpm}",
    "The paper's result, on its model or yours":
        Verify = verify => "report{model}",
        Locate = locate => "orbit{model} --rpm {rpm}",
        Certify = certify => "chaos{model} --rpm {rpm}",
        Claims = claims => "explain feigin{model}",
        Explain = explain => "",
        Figure = figure => "report{model}",
    "The shell":
        Completions = completions => "",
        Man = man => "",
    // This command is not listed: `corner-impact MODEL` calls it.
    "":
        About = about => "",
}

/// Reason why a command has no result.
#[derive(Debug)]
enum CommandError {
    Words(String),
    /// Error with a place in a model file.
    Model {
        words: String,
        at: Box<ModelError>,
    },
    /// Fault of the program itself, which depends on the model.
    Fault(String),
    /// Closed pipe: the reader of standard output has stopped reading.
    Unread,
}

/// Converts every error of the library, with its place in a model file, if any.
impl<E: Error + 'static> From<E> for CommandError {
    fn from(error: E) -> Self {
        let words = error.to_string();
        let mut cause: Option<&(dyn Error + 'static)> = Some(&error);
        while let Some(error) = cause {
            if let Some(at) = error.downcast_ref::<ModelError>() {
                return Self::Model { words, at: Box::new(at.clone()) };
            }
            if let Some(SimulateError::PassedThrough { .. }) = error.downcast_ref() {
                return Self::Fault(words);
            }
            // The error inside a stream's error is not its source.
            let held = error.downcast_ref::<std::io::Error>().and_then(|error| error.get_ref());
            let file = error.downcast_ref().or_else(|| held.and_then(|held| held.downcast_ref::<FileError>()));
            if file.is_some_and(FileError::is_unread) {
                return Self::Unread;
            }
            cause = error.source();
        }
        Self::Words(words)
    }
}

/// Runs one command line, program name first; neither stream is a terminal.
pub fn run(arguments: impl IntoIterator<Item = OsString>, out: &mut dyn Write, err: &mut dyn Write) -> Exit {
    run_at(Terminal::default(), arguments, out, err)
}

/// Runs a command; ends it when nobody reads its results any more, if they are only printed.
fn begun(arguments: &Arguments, only_prints: bool, session: &mut Session<'_>) -> Result<Exit, CommandError> {
    (session.color, session.quiet, session.threads) = (arguments.color, arguments.quiet, arguments.threads);
    progress::begin(arguments.quiet);
    let is_watched = session.terminal.is_process && only_prints;
    let next = arguments.command.next();
    signals::watch().map_err(|error| CommandError::Words(format!("signals: {error}")))?;
    let mut work = || {
        threads::start(arguments.threads)?;
        arguments.command.run(session)
    };
    let exit = if is_watched {
        standard::takes_more()?;
        cancel::run(standard::is_unread(), work).unwrap_or(Err(CommandError::Unread))?
    } else {
        work()?
    };
    session.open();
    session.tell_next(next)?;
    Ok(exit)
}

/// Runs one command line, program name first, with streams that `terminal` describes.
pub fn run_at(
    terminal: Terminal,
    arguments: impl IntoIterator<Item = OsString>,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Exit {
    let words = about::named(numbers::with_units(arguments));
    // Errors of a command line are coloured by its own option.
    let mut session = Session {
        out,
        err,
        terminal,
        color: session::said(&words),
        quiet: false,
        threads: None,
        rpm: None,
        units: Units::default(),
        model: String::new(),
        named: String::new(),
        wishes: Wishes::default(),
    };
    let mut command = help::command(session.width(), &words);
    let matches = command.try_get_matches_from_mut(&words);
    session.rpm = matches.as_ref().ok().and_then(session::speeds);
    session.wishes = matches.as_ref().map(Wishes::of).unwrap_or_default();
    let only_prints = matches.as_ref().is_ok_and(|matches| session::only_prints(&command, matches));
    let run = match matches.and_then(|matches| Arguments::from_arg_matches(&matches)) {
        Ok(arguments) => {
            // Frees all options with their help, a part of a megabyte, for the work.
            drop(command);
            begun(&arguments, only_prints, &mut session)
        }
        Err(error) => session.refuse(&command, &words, error),
    };
    run.unwrap_or_else(|error| {
        // A reader that closes a pipe early, as `head` does, needs no more output and no error.
        match &error {
            CommandError::Unread => {}
            CommandError::Model { words, at } => session.complain_at(words, at),
            CommandError::Words(words) => session.complain(words),
            CommandError::Fault(words) => session.complain(&format!("{words}; the model is {}", session.model)),
        }
        Exit::BadInput
    })
}
