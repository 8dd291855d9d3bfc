//! The command line: parse, one library call, exit code. Results to standard output, complaints to standard error.

mod cam;
mod claims;
mod verify;

use std::ffi::OsString;
use std::io::Write;

use clap::{Parser, Subcommand};

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
}

/// Why a command has no result.
#[derive(Debug, thiserror::Error)]
enum CommandError {
    #[error("{0}")]
    Input(String),
    #[error("report: {0}")]
    Report(String),
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
        Command::Verify(arguments) => verify::run(arguments, err),
        Command::Claims(arguments) => claims::run(arguments),
        Command::Cam(arguments) => cam::run(arguments),
    };
    match result {
        Ok((text, exit)) => match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
            Ok(()) => exit,
            Err(error) => {
                let _ = writeln!(err, "error: standard output: {error}");
                Exit::BadInput
            }
        },
        Err(error) => {
            let _ = writeln!(err, "error: {error}");
            Exit::BadInput
        }
    }
}
