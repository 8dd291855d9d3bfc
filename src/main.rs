//! The `corner-impact` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    let exit =
        corner_impact::cli::run(std::env::args_os(), &mut std::io::stdout().lock(), &mut std::io::stderr().lock());
    ExitCode::from(exit as u8)
}
