//! Runs a script of `derivations/` with JSON as input and output; errors contain the command and the script's message.
//!
//! The scripts get only a model's numbers, no results of this program. They are part of the program: for each run they are written to a
//! private temporary folder, run there, and removed, whatever signal ends the program. The current folder may contain files of others, so
//! nothing in it is run or imported. The private folder is the script's current folder, so that a relative entry of PATH or PYTHONPATH
//! leads there, too.
//!
//! The interpreter is, in this order:
//!
//! 1. `$CORNER_IMPACT_PYTHON`;
//! 2. the interpreter that has loaded this library, if any;
//! 3. the interpreter of the clone's `.venv`, if the program is in the clone in which it was built;
//! 4. `python3` of the PATH (`python` on Windows).
//!
//! An installed or unpacked program never runs an interpreter at a path of the machine that built it. An interpreter that nobody chose (3,
//! 4) starts with `-E -s`, without PYTHONPATH and without the user's packages.

use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use crate::cancel;
use crate::file::{Scratch, Started};

/// Scripts, the modules that they import and the file that they read, by their paths in the project.
const FILES: [(&str, &str); 24] = [
    ("derivations/arithmetic.py", include_str!("../derivations/arithmetic.py")),
    ("derivations/balls/__init__.py", include_str!("../derivations/balls/__init__.py")),
    ("derivations/balls/branches.py", include_str!("../derivations/balls/branches.py")),
    ("derivations/balls/cam.py", include_str!("../derivations/balls/cam.py")),
    ("derivations/balls/corner_impact.py", include_str!("../derivations/balls/corner_impact.py")),
    ("derivations/balls/duals.py", include_str!("../derivations/balls/duals.py")),
    ("derivations/balls/flight.py", include_str!("../derivations/balls/flight.py")),
    ("derivations/balls/krawczyk.py", include_str!("../derivations/balls/krawczyk.py")),
    ("derivations/balls/laws.py", include_str!("../derivations/balls/laws.py")),
    ("derivations/balls/motion.py", include_str!("../derivations/balls/motion.py")),
    ("derivations/balls/nearby.py", include_str!("../derivations/balls/nearby.py")),
    ("derivations/balls/numbers.py", include_str!("../derivations/balls/numbers.py")),
    ("derivations/balls/orbits.py", include_str!("../derivations/balls/orbits.py")),
    ("derivations/balls/profiles.py", include_str!("../derivations/balls/profiles.py")),
    ("derivations/balls/resting.py", include_str!("../derivations/balls/resting.py")),
    ("derivations/balls/roots.py", include_str!("../derivations/balls/roots.py")),
    ("derivations/balls/verdict.py", include_str!("../derivations/balls/verdict.py")),
    ("derivations/certify.py", include_str!("../derivations/certify.py")),
    ("derivations/evaluate.py", include_str!("../derivations/evaluate.py")),
    ("derivations/motions.py", include_str!("../derivations/motions.py")),
    ("derivations/scipy_cams.py", include_str!("../derivations/scipy_cams.py")),
    ("derivations/simulate_scipy.py", include_str!("../derivations/simulate_scipy.py")),
    ("derivations/splines.py", include_str!("../derivations/splines.py")),
    ("golden/derived/corner_map.json", include_str!("../golden/derived/corner_map.json")),
];

/// Interpreters that `make` sets up in a clone, with all packages that the scripts need.
const OF_A_CLONE: [&str; 2] = [".venv/bin/python", ".venv/Scripts/python.exe"];

/// Interpreter that is searched in the PATH.
const OF_THE_PATH: &str = if cfg!(windows) { "python" } else { "python3" };

/// Time after which a running script is stopped; the slowest takes seconds.
const TIME_LIMIT: Duration = Duration::from_secs(120);

/// Reason why a script has no result.
#[derive(Debug, thiserror::Error)]
pub(crate) enum PythonError {
    #[error("the scripts could not be written to a temporary folder: {0}")]
    NotWritten(std::io::Error),
    #[error("`{command}` did not start: {error}; {}", remedy())]
    NotStarted { command: String, error: std::io::Error },
    #[error("`{command}` failed ({status}); if a package is missing, {}; it said:\n{stderr}", remedy())]
    Failed { command: String, status: String, stderr: String },
    #[error("`{command}` did not end within {} s and was stopped: give a narrower range of speeds", TIME_LIMIT.as_secs())]
    TooLong { command: String },
    #[error("`{command}` printed something other than its result: {error}")]
    Output { command: String, error: String },
}

/// Remedy if Python or one of its packages is missing: for a clone, for an installed program, and for a script in Python.
fn remedy() -> &'static str {
    match (HOST.get(), is_in_its_clone()) {
        (Some(_), _) => {
            "`pip install 'corner-impact[routes]'` installs the packages, and `verify(external=False)` does without them"
        }
        (None, true) => "`make verify` sets up Python and its packages, and `verify --no-external` does without them",
        (None, false) => {
            "`python3 -m pip install mpmath python-flint scipy sympy` installs the packages, and `verify --no-external` does without them"
        }
    }
}

/// Runs `derivations/<script>` with `input` on standard input and reads its standard output as a `T`.
pub(crate) fn run<T: serde::de::DeserializeOwned>(script: &str, input: &serde_json::Value) -> Result<T, PythonError> {
    // The files are laid out as in the project.
    let folder = Scratch::of(&FILES).map_err(PythonError::NotWritten)?;
    let interpreter = interpreter();
    let script = format!("derivations/{script}");
    let command = format!("{} {script}", interpreter.display());
    let not_started = |error| PythonError::NotStarted { command: command.clone(), error };
    let child = Command::new(&interpreter)
        // -B: no compiled copies in a folder that is removed.
        .args(["-B"])
        .args(isolating())
        .arg(&script)
        .current_dir(folder.path())
        // This variable would keep the scripts from importing each other.
        .env_remove("PYTHONSAFEPATH")
        // The matrices of the scripts are too small for threads, which would only wait for each other.
        .env("OPENBLAS_NUM_THREADS", "1")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(not_started)?;
    let Talk { status, stdout, stderr } =
        talk(child, input.to_string().into_bytes(), TIME_LIMIT).map_err(not_started)?;
    let stdout = match status {
        None => return Err(PythonError::TooLong { command }),
        Some(status) if !status.success() => {
            let (status, stderr) = (status.to_string(), stderr.trim().into());
            return Err(PythonError::Failed { command, status, stderr });
        }
        Some(_) => stdout,
    };
    serde_json::from_str(&stdout).map_err(|error| PythonError::Output { command, error: error.to_string() })
}

/// Outcome of a child process.
#[derive(Debug)]
pub struct Talk {
    /// Exit status; `None` if the child had to be stopped.
    pub status: Option<ExitStatus>,
    pub stdout: String,
    pub stderr: String,
}

/// Feeds `input`, collects both streams, and stops a child that exceeds the time `limit`.
#[doc(hidden)]
pub fn talk(mut child: Child, input: Vec<u8>, limit: Duration) -> std::io::Result<Talk> {
    let pipes = (child.stdin.take(), child.stdout.take(), child.stderr.take());
    // The child ends with this value; its pipes are then closed, and their readers end, too.
    let mut child = Started::new(child);
    std::thread::scope(move |scope| {
        // A script that ends without reading closes the pipe: its own message says why.
        let feed = pipes.0.map(|mut stdin| scope.spawn(move || stdin.write_all(&input).is_ok()));
        let stdout = pipes.1.map(|pipe| scope.spawn(|| collect(pipe)));
        let stderr = pipes.2.map(|pipe| scope.spawn(|| collect(pipe)));
        let start = Instant::now();
        let status = loop {
            cancel::check_now();
            match child.child().try_wait()? {
                Some(status) => break Some(status),
                None if start.elapsed() > limit => {
                    child.child().kill()?;
                    child.child().wait()?;
                    break None;
                }
                None => std::thread::sleep(Duration::from_millis(5)),
            }
        };
        let text = |reader: Option<std::thread::ScopedJoinHandle<'_, String>>| {
            reader.and_then(|reader| reader.join().ok()).unwrap_or_default()
        };
        drop(feed);
        Ok(Talk { status, stdout: text(stdout), stderr: text(stderr) })
    })
}

fn collect(mut pipe: impl Read) -> String {
    let mut bytes = Vec::new();
    // Output read before an error is still shown.
    let _ = pipe.read_to_end(&mut bytes);
    String::from_utf8_lossy(&bytes).into_owned()
}

/// The interpreter that has loaded this library.
static HOST: OnceLock<PathBuf> = OnceLock::new();

/// Sets the interpreter that has loaded this library; only the first call counts.
pub fn loaded_by(interpreter: PathBuf) {
    let _ = HOST.set(interpreter);
}

/// Options that hide the user's packages, and variables such as PYTHONPATH, from a script; `-I` would also hide its own modules. If
/// somebody chose the interpreter, or loaded this library, the packages are their choice as well.
fn isolating() -> &'static [&'static str] {
    let is_chosen = std::env::var_os("CORNER_IMPACT_PYTHON").is_some() || HOST.get().is_some();
    if is_chosen { &[] } else { &["-E", "-s"] }
}

fn interpreter() -> PathBuf {
    let chosen = std::env::var_os("CORNER_IMPACT_PYTHON").map(PathBuf::from);
    // A bare name is searched in the PATH; a path is relative to the current folder, which is not the script's.
    let chosen = chosen.map(|path| match path.components().count() {
        0 | 1 => path,
        _ => std::path::absolute(&path).unwrap_or(path),
    });
    chosen.or_else(|| HOST.get().cloned()).or_else(of_the_clone).unwrap_or_else(|| OF_THE_PATH.into())
}

/// Whether the program is in the clone in which it was built.
fn is_in_its_clone() -> bool {
    let of = |path: std::io::Result<PathBuf>| path.and_then(|path| path.canonicalize()).ok();
    match (of(std::env::current_exe()), of(Ok(PathBuf::from(env!("CARGO_MANIFEST_DIR"))))) {
        (Some(program), Some(clone)) => program.starts_with(clone),
        _ => false,
    }
}

/// Interpreter of that clone, if the program is still there.
fn of_the_clone() -> Option<PathBuf> {
    let clone = Path::new(env!("CARGO_MANIFEST_DIR"));
    let interpreter = OF_A_CLONE.iter().map(|path| clone.join(path)).find(|path| path.is_file());
    interpreter.filter(|_| is_in_its_clone())
}
