//! The command line: parse, one library call, exit code. Results to standard output, complaints to standard error.

mod basins;
mod cam;
mod claims;
mod diagram;
mod picture;
mod progress;
mod simulate;
mod start;
mod verify;

use std::ffi::OsString;
use std::io::Write;

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
    Basins(basins::Arguments),
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
}

impl CommandError {
    fn input(error: impl std::fmt::Display) -> Self {
        Self::Input(error.to_string())
    }

    fn report(error: impl std::fmt::Display) -> Self {
        Self::Report(error.to_string())
    }

    fn file(error: FileError) -> Self {
        Self::Write(error.to_string())
    }

    fn write(error: std::io::Error) -> Self {
        Self::Write(error.to_string())
    }

    fn standard(error: std::io::Error) -> Self {
        Self::Write(format!("standard output: {error}"))
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
        Command::Basins(arguments) => basins::run(arguments, out),
    };
    result.unwrap_or_else(|error| {
        let _ = writeln!(err, "error: {error}");
        Exit::BadInput
    })
}
