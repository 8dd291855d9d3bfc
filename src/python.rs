//! Runs one script of `derivations/`: JSON in, JSON out, errors that carry the command and what it said.
//!
//! The scripts get a model's numbers and nothing that this program computed. The folder is looked for at
//! `$CORNER_IMPACT_HOME`, above the executable and above the current folder; the interpreter is `$CORNER_IMPACT_PYTHON`, or
//! that of `.venv` beside `derivations/`, or `python3`.

use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A script still running after this long is stopped: the slowest takes seconds.
const TIME_LIMIT: Duration = Duration::from_secs(120);

/// Why a script has no result.
#[derive(Debug, thiserror::Error)]
pub enum PythonError {
    /// No `derivations/` with the script in it.
    #[error(
        "derivations/{script} was not found above the executable or the current folder; set CORNER_IMPACT_HOME to the \
         project's folder"
    )]
    NoScript {
        /// The script.
        script: String,
    },
    /// The interpreter did not start.
    #[error("`{command}` did not start: {error}; `make verify` sets up Python, --no-external does without it")]
    NotStarted {
        /// What was run.
        command: String,
        /// Why it did not.
        error: std::io::Error,
    },
    /// It ended with an error.
    #[error(
        "`{command}` failed ({status}); if a package is missing, `make verify` sets it up, and --no-external does without; it \
         said:\n{stderr}"
    )]
    Failed {
        /// What was run.
        command: String,
        /// Exit status.
        status: String,
        /// Its standard error, trimmed.
        stderr: String,
    },
    /// What it printed is not what it should.
    #[error("`{command}` printed something else than its result: {error}")]
    Output {
        /// What was run.
        command: String,
        /// Where the output went wrong.
        error: String,
    },
}

/// Runs `derivations/<script>` with `input` on standard input and reads its standard output as a `T`.
pub fn run<T: serde::de::DeserializeOwned>(script: &str, input: &serde_json::Value) -> Result<T, PythonError> {
    let path = find(script).ok_or_else(|| PythonError::NoScript { script: script.into() })?;
    let interpreter = interpreter(&path);
    let command = format!("{} {}", interpreter.display(), path.display());
    let not_started = |error| PythonError::NotStarted { command: command.clone(), error };
    let child = Command::new(&interpreter)
        .arg(&path)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(not_started)?;
    let (status, stdout, stderr) = talk(child, input.to_string().into_bytes()).map_err(not_started)?;
    let Some(stdout) = stdout else {
        return Err(PythonError::Failed { command, status, stderr: stderr.trim().into() });
    };
    serde_json::from_str(&stdout).map_err(|error| PythonError::Output { command, error: error.to_string() })
}

/// Feeds `input`, collects both streams, and stops a child that does not end: its end in words, its output if it succeeded,
/// and its standard error.
fn talk(mut child: Child, input: Vec<u8>) -> std::io::Result<(String, Option<String>, String)> {
    let pipes = (child.stdin.take(), child.stdout.take(), child.stderr.take());
    std::thread::scope(|scope| {
        // A script that ends without reading closes the pipe: its own message says why.
        let feed = pipes.0.map(|mut stdin| scope.spawn(move || stdin.write_all(&input).is_ok()));
        let stdout = pipes.1.map(|pipe| scope.spawn(|| collect(pipe)));
        let stderr = pipes.2.map(|pipe| scope.spawn(|| collect(pipe)));
        let start = Instant::now();
        let (status, succeeded) = loop {
            match child.try_wait()? {
                Some(status) => break (status.to_string(), status.success()),
                None if start.elapsed() > TIME_LIMIT => {
                    child.kill()?;
                    child.wait()?;
                    break (format!("stopped after {} s", TIME_LIMIT.as_secs()), false);
                }
                None => std::thread::sleep(Duration::from_millis(5)),
            }
        };
        let text = |reader: Option<std::thread::ScopedJoinHandle<'_, String>>| {
            reader.and_then(|reader| reader.join().ok()).unwrap_or_default()
        };
        drop(feed);
        let stdout = text(stdout);
        Ok((status, succeeded.then_some(stdout), text(stderr)))
    })
}

fn collect(mut pipe: impl Read) -> String {
    let mut bytes = Vec::new();
    // What was read before an error is still worth showing.
    let _ = pipe.read_to_end(&mut bytes);
    String::from_utf8_lossy(&bytes).into_owned()
}

fn find(script: &str) -> Option<PathBuf> {
    let home = std::env::var_os("CORNER_IMPACT_HOME").map(PathBuf::from);
    let current = std::env::current_dir().ok();
    let executable = std::env::current_exe().ok();
    let above = [executable, current];
    let folders = above.iter().flatten().flat_map(|path| path.ancestors()).map(Path::to_path_buf);
    home.into_iter().chain(folders).map(|folder| folder.join("derivations").join(script)).find(|path| path.is_file())
}

fn interpreter(script: &Path) -> PathBuf {
    if let Some(chosen) = std::env::var_os("CORNER_IMPACT_PYTHON") {
        return chosen.into();
    }
    let home = script.ancestors().nth(2);
    let of_project = home.map(|home| home.join(".venv/bin/python")).filter(|path| path.is_file());
    of_project.unwrap_or_else(|| "python3".into())
}
