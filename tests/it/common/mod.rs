//! What several questions need: the program, the models under `models/`, and a model with some fields changed.
// `documents` needs a part of it.
#![allow(dead_code)]

use std::ffi::OsStr;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::mpsc;
use std::time::Duration;

use corner_impact::border_collision::LocalMap;
use corner_impact::cam::Cam;
use corner_impact::corner::SideMap;
use corner_impact::model::{Model, OSORIO_2008};
use corner_impact::orbit::Parameter;
use corner_impact::progress::Watch;
use corner_impact::study::attractors::{AttractorsError, Resolution, Step};
use corner_impact::study::design::needs::Lever;
use corner_impact::study::speeds::{self, SpeedSurvey};
use corner_impact::study::survey::{Axis, Over, Spacing, Values};
use nalgebra::{Matrix2, RowVector2, Vector2};

/// The project's folder.
pub const ROOT: &str = env!("PROJECT");
/// The program under test.
pub const PROGRAM: &str = env!("CARGO_BIN_EXE_corner-impact-tested");

/// The program in the project's folder, in an environment that says nothing about terminals.
pub fn program<Word: AsRef<OsStr>>(words: impl IntoIterator<Item = Word>) -> Command {
    let mut command = Command::new(PROGRAM);
    command.current_dir(ROOT).args(words);
    for name in ["COLUMNS", "NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE"] {
        command.env_remove(name);
    }
    command
}

/// Copies the program, by a process of its own on Unix: what this process writes is open in every child that another test starts
/// meanwhile, and a program that is open for writing cannot be run.
pub fn copy_program(to: &Path) {
    let done = if cfg!(unix) {
        Command::new("cp").args([PROGRAM.as_ref(), to]).status().is_ok_and(|status| status.success())
    } else {
        std::fs::copy(PROGRAM, to).is_ok()
    };
    assert!(done, "{}", to.display());
}

/// A program that signals end as they do by themselves: whoever runs the tests in the background may have it that some are ignored, and what
/// is ignored at the start stays so.
#[cfg(unix)]
pub fn that_signals_end(program: &Command) -> Command {
    let mut command = Command::new("env");
    if cfg!(target_os = "linux") {
        command.arg("--default-signal");
    }
    command.arg(program.get_program()).args(program.get_args());
    if let Some(folder) = program.get_current_dir() {
        command.current_dir(folder);
    }
    command
}

/// Runs the program in the project's folder.
pub fn corner_impact<Word: AsRef<OsStr>>(words: impl IntoIterator<Item = Word>) -> Output {
    program(words).output().unwrap()
}

/// Runs the interpreter of `make test` in the project's folder, with a document on standard input.
pub fn python(arguments: &[&str], document: &serde_json::Value) -> Output {
    let interpreter = Path::new(ROOT).join(".venv/bin/python");
    assert!(interpreter.is_file(), "run `make test`, which sets up .venv");
    let mut command = Command::new(interpreter);
    command.args(arguments).current_dir(ROOT);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(document.to_string().as_bytes()).unwrap();
    child.wait_with_output().unwrap()
}

pub fn text(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).unwrap()
}

/// A page as it was before it was cut into lines.
pub fn in_one_line(page: &str) -> String {
    page.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// How long the slowest machine may take over what has an end. Whether work is fast is no question of a test; what never
/// ends must still fail.
pub const PATIENCE: Duration = Duration::from_secs(600);

/// What `run` comes to; `Err` where it panics or never ends.
pub fn ends<T: Send + 'static>(run: impl FnOnce() -> T + Send + 'static) -> Result<T, String> {
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || sender.send(run()));
    receiver.recv_timeout(PATIENCE).map_err(|error| format!("no end after {PATIENCE:?}, or a panic: {error}"))
}

/// Whether tests over many cases look at all of them: in `make properties`.
pub fn is_whole() -> bool {
    std::env::var_os("PROPERTIES").is_some()
}

/// Waits until something is so, for as long as a busy machine may take.
#[track_caller]
pub fn until(what: &str, is_so: impl Fn() -> bool) {
    let begun = std::time::Instant::now();
    while !is_so() {
        assert!(begun.elapsed() < PATIENCE, "never: {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Every model file that has a corner impact to verify, by name; `models/laws` has those that need none.
pub fn model_files() -> Vec<PathBuf> {
    let folder = Path::new(env!("PROJECT")).join("models");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    assert!(files.len() >= 4, "models/ holds the paper's model and at least three others: {files:?}");
    files
}

pub fn stem(file: &Path) -> String {
    file.file_stem().unwrap().to_string_lossy().into_owned()
}

/// A model of the project, by its path from there; tests run in `tests/`.
pub fn read(file: &Path) -> Model {
    Model::read(&Path::new(ROOT).join(file)).unwrap()
}

pub fn osorio() -> Model {
    Model::parse("osorio-2008.toml", OSORIO_2008).unwrap()
}

pub fn cam(model: &Model) -> Cam {
    Cam::new(model).unwrap()
}

/// The paper's model file with some lines replaced: `[("restitution", "0.5"), ...]`.
pub fn osorio_text(changes: &[(&str, &str)]) -> String {
    let mut lines: Vec<String> = OSORIO_2008.lines().map(String::from).collect();
    for (field, value) in changes {
        let line = lines.iter_mut().find(|line| line.starts_with(&format!("{field} ="))).unwrap();
        *line = format!("{field} = {value}");
    }
    lines.join("\n")
}

pub fn osorio_with(changes: &[(&str, &str)]) -> Model {
    Model::parse("changed.toml", &osorio_text(changes)).unwrap()
}

/// The two cams of the tutorial, from a drawing and measured, as it gives them.
pub fn tutorial(name: &str) -> Model {
    let page = include_str!("../../../docs/tutorial.md");
    let file = |name: &str| {
        let kind = if name.ends_with("csv") { "csv" } else { "toml" };
        let (_, after) = page.split_once(&format!("```{kind} {name}\n")).unwrap();
        after.split_once("```").unwrap().0
    };
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("lift.csv"), file("lift.csv")).unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, file(name)).unwrap();
    read(&path)
}

fn map_from(sides: [SideMap; 2]) -> LocalMap {
    let [minus, plus] = sides;
    LocalMap { minus, plus, border: (RowVector2::new(1.0, 0.0), 0.0) }
}

/// The map in normal form `(x, y) -> (trace x + y + mu, -determinant x)`, minus where x < 0.
pub fn normal_form(traces: [f64; 2], determinants: [f64; 2]) -> LocalMap {
    let matrix = |side: usize| Matrix2::new(traces[side], 1.0, -determinants[side], 0.0);
    map_from([0, 1].map(|side| SideMap { a: matrix(side), b: Vector2::new(1.0, 0.0) }))
}

/// The map of the line `x -> slope x + mu`, minus where x < 0.
pub fn of_the_line(slopes: [f64; 2]) -> LocalMap {
    map_from(slopes.map(|slope| SideMap { a: Matrix2::new(slope, 0.0, 0.0, 0.0), b: Vector2::new(1.0, 0.0) }))
}

/// What `speeds` finds over a range of speeds, rpm.
pub fn speeds(
    model: &Model,
    range: [f64; 2],
    resolution: &Resolution,
    watch: &dyn Watch,
) -> Result<SpeedSurvey, AttractorsError> {
    speeds::speeds(&Over::speed(model).unwrap(), range, resolution, watch)
}

/// Values of a lever at which needs are answered.
pub fn axis_of(lever: Lever, values: &Values) -> Axis {
    Axis::new(Parameter::Field(lever.path()), values)
}

/// Speeds that are so far apart at most, rpm.
pub fn step(longest: f64) -> Step {
    Step::at_most(longest, Spacing::Linear)
}
