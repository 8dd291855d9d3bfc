//! Does a command that is stopped half-way, or runs out of room, leave the files as they were?

#![cfg(target_os = "linux")]

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::common;
use tempfile::TempDir;

const MODEL: &str = concat!(env!("PROJECT"), "/models/osorio-2008.toml");
const SIGINT: i32 = 2;
/// What a file held before.
const OLD: &str = "old\n";
/// What each file of a full disk may hold in the tests below, in blocks of 512 bytes: less than any picture.
const BLOCKS: u32 = 4;

/// A folder where `out.csv`, `out.svg` and `out.png` hold something already.
fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    for name in ["out.csv", "out.svg", "out.png"] {
        fs::write(folder.path().join(name), OLD).unwrap();
    }
    folder
}

/// The files in a folder that a program is at and that have no name yet.
fn unfinished(child: &Child, folder: &TempDir) -> Vec<PathBuf> {
    let named: Vec<PathBuf> = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
    let open = fs::read_dir(format!("/proc/{}/fd", child.id())).unwrap().map(|entry| entry.unwrap().path());
    let is_new =
        |path: &PathBuf| fs::read_link(path).is_ok_and(|to| to.starts_with(folder.path()) && !named.contains(&to));
    open.filter(is_new).collect()
}

#[track_caller]
fn is_as_it_was(folder: &TempDir, line: &str) {
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3, "{line}");
    for name in ["out.csv", "out.svg", "out.png"] {
        assert_eq!(fs::read_to_string(folder.path().join(name)).unwrap(), OLD, "{line}: {name}");
    }
}

fn words(line: &str) -> impl Iterator<Item = String> {
    line.split_whitespace().map(|word| word.replace("MODEL", MODEL))
}

/// Waits until `ready`, for as long as a busy machine may take.
fn wait_until(child: &mut Child, ready: impl Fn(&Child) -> bool, line: &str) {
    let started = Instant::now();
    while !ready(child) {
        assert!(child.try_wait().unwrap().is_none(), "{line}: ended by itself");
        assert!(started.elapsed() < common::PATIENCE, "{line}: never got there");
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Runs that would last for hours, stopped when something has been written for each of their files.
#[test]
fn ctrl_c_leaves_the_old_files_and_no_others() {
    const LONG: &str = "--revolutions 1000000000000";
    for (line, files, written) in [
        (format!("simulate MODEL --rpm 183 {LONG} --events out.csv"), 1, true),
        (format!("simulate MODEL --rpm 183 {LONG} --strobe 1 --strobe-out out.csv --trace out.svg"), 2, false),
        (format!("simulate MODEL --rpm 183 {LONG} --trace out.svg --phase-plane out.png"), 2, false),
        ("diagram MODEL --rpm 180:190:1000000 --out out.csv".into(), 1, true),
        ("diagram MODEL --rpm 180:190:1000000 --start down --out out.csv".into(), 1, true),
        ("diagram MODEL --rpm 180:190:1000000 --out out.svg".into(), 1, false),
        ("diagram MODEL --rpm 180:190:1000000 --out out.png".into(), 1, false),
    ] {
        let folder = folder();
        let mut command = common::that_signals_end(common::program(words(&line)).current_dir(&folder));
        let mut child = command.stdout(Stdio::null()).spawn().unwrap();
        // Pictures are drawn in the end: until then there is an empty file.
        let begun = |child: &Child| {
            let files_there = unfinished(child, &folder);
            let sizes = files_there.iter().map(|path| fs::metadata(path).map_or(0, |file| file.len()));
            files_there.len() == files && (!written || sizes.sum::<u64>() > 0)
        };
        wait_until(&mut child, begun, &line);
        let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
        assert!(kill.success());
        // The shell is to see the signal, not an exit code.
        assert_eq!(child.wait().unwrap().signal(), Some(SIGINT), "{line}");
        is_as_it_was(&folder, &line);
    }
}

/// A line of each command that may take long, and takes minutes here; but for those whose work Python does.
const PYTHON: [&str; 6] = [
    "verify MODEL",
    "report MODEL --out out.html",
    "claims MODEL",
    "explain eq:pwlf MODEL",
    "compare MODEL --external --set restitution=0.7",
    "certify MODEL --orbits --rpm 100:900",
];
const LONG: [&str; 11] = [
    "certify MODEL --rpm 100:5000",
    "locate MODEL --rpm 670:680 --revolutions 20",
    "speeds MODEL --rpm 50:760 --step 0.01 --out out.svg",
    "diagram MODEL --rpm 180:190:1000000 --summary",
    "chart MODEL --x rpm=600:760:2000 --y restitution=0.5:0.9:2000 --out out.png",
    "orbit MODEL --rpm 0.1 --impacts 2",
    "curve MODEL --rpm 600:760 --parameter restitution=0.1:0.99 --step 0.00001 --out out.svg",
    "basins MODEL --rpm 678 --grid 2000x2000 --out out.png",
    "basins MODEL --rpm 678 --grid 1x400000 --revolutions 1 --position 50:60 --out out.csv",
    "chaos MODEL --rpm 500:760",
    "simulate MODEL --rpm 183 --revolutions 1000000000000",
];

/// Whatever a command is at, it ends at once, with the scripts that it has written and the Python that runs them.
#[test]
#[ignore = "slow"]
fn ctrl_c_ends_every_command_at_once_and_leaves_nothing() {
    const AT_ONCE: Duration = Duration::from_secs(5);
    let lines = PYTHON.map(|line| (line, true)).into_iter().chain(LONG.map(|line| (line, false)));
    for (line, is_python) in lines {
        let (folder, scripts) = (folder(), TempDir::new().unwrap());
        let written = || fs::read_dir(&scripts).unwrap().count();
        let mut command = common::that_signals_end(common::program(words(line)).current_dir(&folder));
        // As a terminal does: of its own group, of which all get the signal.
        command.env("TMPDIR", scripts.path()).process_group(0).stdout(Stdio::null()).stderr(Stdio::null());
        let started = Instant::now();
        let mut child = command.spawn().unwrap();
        let at_it = |_: &Child| if is_python { written() > 0 } else { started.elapsed() > Duration::from_millis(300) };
        wait_until(&mut child, at_it, line);
        let asked = Instant::now();
        let kill = Command::new("kill").args(["-INT", "--", &format!("-{}", child.id())]).status().unwrap();
        assert!(kill.success(), "{line}");
        assert_eq!(child.wait().unwrap().signal(), Some(SIGINT), "{line}");
        assert!(asked.elapsed() < AT_ONCE, "{line}: went on for {:?}", asked.elapsed());
        assert_eq!(written(), 0, "{line}: left its scripts");
        is_as_it_was(&folder, line);
    }
}

/// A signal to the program alone, and none to what it has started, as `kill` and a scheduler send it.
#[test]
fn a_script_ends_with_the_program() {
    let folder = TempDir::new().unwrap();
    let (python, number) = (folder.path().join("python"), folder.path().join("number"));
    // Whole as soon as it has its name.
    let script = format!("#!/bin/sh\necho $$ > {0}.new\nmv {0}.new {0}\nexec sleep 6000\n", number.display());
    fs::write(&python, script).unwrap();
    fs::set_permissions(&python, fs::Permissions::from_mode(0o755)).unwrap();
    let mut command = common::program(["verify"]);
    let mut child =
        command.env("CORNER_IMPACT_PYTHON", &python).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    wait_until(&mut child, |_| number.exists(), "verify");
    let script = format!("/proc/{}", fs::read_to_string(&number).unwrap().trim());
    assert!(Path::new(&script).exists());
    let signal = Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap();
    assert!(signal.success());
    assert_eq!(child.wait().unwrap().signal(), Some(15));
    let begun = Instant::now();
    // Gone, or dead and not yet counted by whoever has inherited it.
    let runs = || fs::read_to_string(format!("{script}/stat")).is_ok_and(|stat| !stat.contains(") Z "));
    while runs() {
        assert!(begun.elapsed() < common::PATIENCE, "it runs on");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// The folder of a program that runs is left alone, that of one that was killed goes with the next that makes one.
#[test]
fn what_was_killed_leaves_nothing_for_long() {
    let (folder, scripts) = (TempDir::new().unwrap(), TempDir::new().unwrap());
    let written = || fs::read_dir(&scripts).unwrap().map(|entry| entry.unwrap().path()).collect::<Vec<_>>();
    let (python, begun) = (folder.path().join("python"), folder.path().join("begun"));
    fs::write(&python, format!("#!/bin/sh\necho > {}\nexec sleep 6000\n", begun.display())).unwrap();
    fs::set_permissions(&python, fs::Permissions::from_mode(0o755)).unwrap();
    let verify = |python: &Path| {
        let mut command = common::program(["verify"]);
        command.env("CORNER_IMPACT_PYTHON", python).env("TMPDIR", scripts.path()).process_group(0);
        command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
    };
    let mut killed = verify(&python);
    wait_until(&mut killed, |_| begun.exists(), "verify");
    let first = written();
    verify(Path::new("false")).wait().unwrap();
    assert!(!first.is_empty() && first.iter().all(|folder| folder.exists()), "{first:?}");
    // With the scripts, which would sleep on.
    let group = format!("-{}", killed.id());
    assert!(Command::new("kill").args(["-KILL", "--", &group]).status().unwrap().success());
    assert_eq!(killed.wait().unwrap().signal(), Some(9));
    assert!(!written().is_empty());
    verify(Path::new("false")).wait().unwrap();
    assert_eq!(written(), Vec::<PathBuf>::new());
}

#[track_caller]
fn complains(output: &Output, says: &[&str], line: &str) {
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{line}: {message}");
    assert!(output.stdout.is_empty(), "{line}");
    assert!(message.starts_with("error: ") && message.lines().count() == 1, "{line}: {message}");
    for part in says {
        assert!(message.contains(part), "{line}: no \"{part}\" in: {message}");
    }
}

/// Every way to draw, with `FILE` for the picture.
const PICTURES: [&str; 4] = [
    "simulate MODEL --rpm 183 --trace FILE",
    "simulate MODEL --rpm 183 --phase-plane FILE",
    "diagram MODEL --rpm 180:190:20 --out FILE",
    "cam MODEL --out FILE",
];

/// A device has no name to keep: what is written to it is lost at once, and said to be.
#[test]
#[ignore = "slow"]
fn a_picture_on_a_full_device_is_an_error() {
    if !Path::new("/dev/full").exists() {
        return;
    }
    for line in PICTURES {
        for name in ["full.svg", "full.png"] {
            let folder = TempDir::new().unwrap();
            symlink("/dev/full", folder.path().join(name)).unwrap();
            let line = line.replace("FILE", name);
            let output = common::program(words(&line)).current_dir(&folder).output().unwrap();
            complains(&output, &[name, "cannot be written", "No space left"], &line);
            assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "{line}");
            assert!(fs::symlink_metadata(folder.path().join(name)).unwrap().is_symlink(), "{line}");
        }
    }
}

/// A file that may not grow as far as it has to, as on a full disk: the one that was there stays.
#[test]
#[ignore = "slow"]
fn a_picture_without_room_leaves_the_old_one() {
    let program = env!("CARGO_BIN_EXE_corner-impact-tested");
    for line in
        PICTURES.map(|line| line.to_owned()).into_iter().chain(["simulate MODEL --rpm 183 --events FILE".into()])
    {
        for name in ["out.svg", "out.png", "out.csv"] {
            let is_table = line.contains("--events");
            if is_table != (name == "out.csv") {
                continue;
            }
            let folder = folder();
            let line = line.replace("FILE", name);
            // Past the limit the shell's children would get a signal; without that, an error.
            let limited = format!("trap '' XFSZ; ulimit -f {BLOCKS}; exec \"$@\"");
            let mut shell = Command::new("sh");
            let output =
                shell.args(["-c", &limited, "sh", program]).args(words(&line)).current_dir(&folder).output().unwrap();
            complains(&output, &[name, "cannot be written", "File too large"], &line);
            is_as_it_was(&folder, &line);
        }
    }
}
