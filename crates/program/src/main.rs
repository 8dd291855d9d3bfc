//! The `corner-impact` command.

use std::process::ExitCode;

use corner_impact_cli::cli::{Terminal, run_at};

fn main() -> ExitCode {
    // Standard error stays unlocked: a progress bar writes to it from a separate thread.
    let (mut out, mut err) = (std::io::stdout().lock(), std::io::stderr());
    ExitCode::from(run_at(Terminal::of_process(), std::env::args_os(), &mut out, &mut err) as u8)
}
