//! Number of threads that share the work: from `--threads`, else from RAYON_NUM_THREADS, else one per core.

use std::error::Error;

use super::CommandError;
use corner_impact::cancel;
use corner_impact::study::survey::limits::thread_count;
use corner_impact::untrusted;

/// Environment variable with the number of threads for all programs that use rayon.
const VARIABLE: &str = "RAYON_NUM_THREADS";

/// Parses a number of threads, for clap.
pub(super) fn threads(text: &str) -> Result<usize, String> {
    // Text that is not a number is rejected as 0 is.
    thread_count(text.trim().parse().unwrap_or(0))
}

/// Starts the global threads. The variable may be empty or 0, which has no effect.
pub(super) fn start(asked: Option<usize>) -> Result<(), CommandError> {
    let said = std::env::var_os(VARIABLE).unwrap_or_default();
    let said = said.to_string_lossy();
    let asked = match (asked, said.as_ref()) {
        (Some(asked), _) => asked,
        (None, "" | "0") => 0,
        (None, text) => threads(text)
            .map_err(|words| CommandError::Words(format!("{VARIABLE} = {}: {words}", untrusted::value(text))))?,
    };
    // In a program that runs several commands, the first command has already started them.
    let builder = rayon::ThreadPoolBuilder::new().num_threads(asked);
    let builder = builder
        .spawn_handler(|thread| std::thread::Builder::new().spawn(cancel::carry(move || thread.run())).map(drop));
    match builder.build_global() {
        Err(error) if error.source().is_some() => {
            let words = format!("threads cannot be started: {error}; {VARIABLE} sets their number");
            Err(CommandError::Words(words))
        }
        _ => Ok(()),
    }
}
