//! The command line: parse, one library call, exit code. Results to standard output, complaints to standard error.

mod basins;
mod cam;
mod claims;
mod continuation;
mod curve;
mod diagram;
mod figure;
mod locate;
mod orbit;
mod picture;
mod progress;
mod simulate;
mod speeds;
mod start;
mod verify;

use std::ffi::OsString;
use std::io::{ErrorKind, Write};

use clap::{Parser, Subcommand};

use crate::report::file::{FileError, Output};

/// How a command ended; the process's exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Done, and everything checked agrees.
    Agrees = 0,
    /// Done, and a check disagrees.
    Disagrees = 1,
    /// Bad usage, model file or data.
    BadInput = 2,
}

/// Re-proves the corner-impact bifurcation of a cam-follower system: closed forms against simulation.
#[derive(Parser)]
#[command(name = "corner-impact", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Verify(verify::Arguments),
    Claims(claims::Arguments),
    Cam(cam::Arguments),
    Simulate(simulate::Arguments),
    Diagram(diagram::Arguments),
    Orbit(orbit::Arguments),
    Continue(continuation::Arguments),
    Curve(curve::Arguments),
    Speeds(speeds::Arguments),
    Locate(locate::Arguments),
    Basins(basins::Arguments),
    Figure(figure::Arguments),
}

/// Why a command has no result.
#[derive(Debug, thiserror::Error)]
enum CommandError {
    #[error("{0}")]
    Input(String),
    #[error("report: {0}")]
    Report(String),
    #[error("{0}")]
    Write(String),
    #[error("standard output: nobody reads it any more")]
    Unread,
}

impl CommandError {
    fn input(error: impl std::fmt::Display) -> Self {
        Self::Input(error.to_string())
    }

    fn report(error: impl std::fmt::Display) -> Self {
        Self::Report(error.to_string())
    }

    fn file(error: FileError) -> Self {
        if error.is_unread() { Self::Unread } else { Self::Write(error.to_string()) }
    }

    fn write(error: std::io::Error) -> Self {
        match error.downcast::<FileError>() {
            Ok(error) => Self::file(error),
            Err(error) => Self::Write(error.to_string()),
        }
    }

    fn standard(error: std::io::Error) -> Self {
        match error.kind() {
            ErrorKind::BrokenPipe => Self::Unread,
            _ => Self::Write(format!("standard output: {error}")),
        }
    }
}

/// Gives files their names, when every one of them is on the disk as far as can be told.
fn commit(mut files: Vec<Output<'_>>) -> Result<(), CommandError> {
    files.iter_mut().try_for_each(Write::flush).map_err(CommandError::write)?;
    files.into_iter().try_for_each(Output::commit).map_err(CommandError::file)
}

/// Prints a page whole.
fn print(page: Result<(String, Exit), CommandError>, out: &mut dyn Write) -> Result<Exit, CommandError> {
    let (text, exit) = page?;
    let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    written.map_err(CommandError::standard)?;
    Ok(exit)
}

/// Runs one command line, program name first.
pub fn run(arguments: impl IntoIterator<Item = OsString>, out: &mut dyn Write, err: &mut dyn Write) -> Exit {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            let help = !error.use_stderr();
            let text = error.render().to_string();
            // A closed pipe leaves nobody to tell.
            let _ = if help { out.write_all(text.as_bytes()) } else { err.write_all(text.as_bytes()) };
            return if help { Exit::Agrees } else { Exit::BadInput };
        }
    };
    let result = match &arguments.command {
        Command::Verify(arguments) => print(verify::run(arguments, err), out),
        Command::Claims(arguments) => print(claims::run(arguments), out),
        Command::Cam(arguments) => {
            let page = cam::run(arguments, out);
            print(page, out)
        }
        Command::Simulate(arguments) => simulate::run(arguments, out),
        Command::Diagram(arguments) => diagram::run(arguments, out),
        Command::Orbit(arguments) => print(orbit::run(arguments), out),
        Command::Speeds(arguments) => print(speeds::run(arguments), out),
        Command::Curve(arguments) => curve::run(arguments, out, err),
        Command::Continue(arguments) => continuation::run(arguments, out, err),
        Command::Locate(arguments) => print(locate::run(arguments), out),
        Command::Basins(arguments) => basins::run(arguments, out),
        Command::Figure(arguments) => figure::run(arguments, out),
    };
    result.unwrap_or_else(|error| {
        // Whoever closes a pipe early, as `head` does, wants no more, nor a complaint.
        if !matches!(error, CommandError::Unread) {
            let _ = writeln!(err, "error: {error}");
        }
        Exit::BadInput
    })
}
