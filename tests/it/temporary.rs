//! Does the sweep of temporary folders leave everything alone that this program did not make?

#![cfg(target_os = "linux")]

use std::fs;
use std::os::unix::fs::{MetadataExt, PermissionsExt, chown, symlink};
use std::os::unix::net::UnixListener;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::program;
use tempfile::TempDir;

/// Starts a command that writes scripts to a folder and runs them by an interpreter.
fn verify(python: &Path, folder: &Path) -> Child {
    let mut command = program(["verify"]);
    command.env("CORNER_IMPACT_PYTHON", python).env("TMPDIR", folder).process_group(0);
    command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

/// Ends within a time in which nothing waits for a pipe.
#[track_caller]
fn swept(folder: &Path) {
    let mut child = verify(Path::new("false"), folder);
    let started = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if started.elapsed() > Duration::from_secs(120) {
            child.kill().unwrap();
            panic!("it waits for ever");
        }
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// A folder of scripts, left by a program that was killed.
fn left(folder: &Path) -> PathBuf {
    let helper = TempDir::new().unwrap();
    let (python, begun) = (helper.path().join("python"), helper.path().join("begun"));
    fs::write(&python, format!("#!/bin/sh\necho > {}\nexec sleep 6000\n", begun.display())).unwrap();
    fs::set_permissions(&python, fs::Permissions::from_mode(0o755)).unwrap();
    let before = names(folder);
    let mut killed = verify(&python, folder);
    while !begun.exists() {
        assert!(killed.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(1));
    }
    let group = format!("-{}", killed.id());
    assert!(Command::new("kill").args(["-KILL", "--", &group]).status().unwrap().success());
    killed.wait().unwrap();
    let mut new = names(folder);
    new.retain(|name| !before.contains(name));
    // Its other scripts ran beside them.
    new[1..].iter().for_each(|name| fs::remove_dir_all(folder.join(name)).unwrap());
    folder.join(&new[0])
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// All below a folder: its path, and what kind of thing it is.
fn all(folder: &Path) -> Vec<(PathBuf, fs::FileType, u64)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let metadata = fs::symlink_metadata(&path).unwrap();
        if metadata.is_dir() {
            found.extend(all(&path));
        }
        found.push((path, metadata.file_type(), metadata.ino()));
    }
    found.sort_by(|one, two| one.0.cmp(&two.0));
    found
}

/// Copies a folder of scripts under another name, with the name that its mark has.
fn copied(from: &Path, name: &str, marked: &str) -> PathBuf {
    let to = from.with_file_name(name);
    assert!(Command::new("cp").arg("-r").args([from, &to]).status().unwrap().success());
    let mark = fs::read_to_string(from.join(".alive")).unwrap();
    let own = from.file_name().unwrap().to_str().unwrap();
    assert!(mark.contains(own), "{mark}");
    fs::write(to.join(".alive"), mark.replace(own, marked)).unwrap();
    to
}

#[test]
fn only_what_this_program_made_is_removed() {
    let folder = TempDir::new().unwrap();
    let at = folder.path();
    let elsewhere = TempDir::new().unwrap();
    let left = left(at);
    let make = |name: &str| {
        let made = at.join(name);
        fs::create_dir(&made).unwrap();
        made.join(".alive")
    };
    assert!(Command::new("mkfifo").arg(make("corner-impact.fifo")).status().unwrap().success());
    let _socket = UnixListener::bind(make("corner-impact.socket")).unwrap();
    symlink("/dev/zero", make("corner-impact.device")).unwrap();
    symlink(left.join(".alive"), make("corner-impact.link")).unwrap();
    fs::create_dir(make("corner-impact.folder")).unwrap();
    // As older versions and other programs leave them.
    fs::write(make("corner-impact.empty"), "").unwrap();
    fs::write(make("corner-impact.foreign"), "my notes").unwrap();
    fs::write(at.join("corner-impact.foreign/thesis.tex"), "mine").unwrap();
    fs::write(at.join("corner-impact.file"), "mine").unwrap();
    fs::create_dir(at.join("another.prefix")).unwrap();
    copied(&left, "corner-impact.copied", "corner-impact.other");
    // A folder with the mark, reached by a link.
    let linked = copied(&left, "elsewhere.linked", "corner-impact.linked");
    symlink(&linked, at.join("corner-impact.linked")).unwrap();
    // Somebody else's folder, which only an administrator can make here.
    if fs::metadata(at).unwrap().uid() == 0 {
        const NOBODY: Option<u32> = Some(65534);
        let theirs = copied(&left, "corner-impact.theirs", "corner-impact.theirs");
        chown(&theirs, NOBODY, NOBODY).unwrap();
        let mark = copied(&left, "corner-impact.mark", "corner-impact.mark").join(".alive");
        chown(&mark, NOBODY, NOBODY).unwrap();
    }
    // The program's own folders, into which somebody put something: of these the scripts go.
    let added = copied(&left, "corner-impact.added", "corner-impact.added");
    fs::write(added.join("thesis.tex"), "mine").unwrap();
    let outside = elsewhere.path().join("derivations");
    let redirected = copied(&left, "corner-impact.redirected", "corner-impact.redirected");
    fs::rename(redirected.join("derivations"), &outside).unwrap();
    symlink(&outside, redirected.join("derivations")).unwrap();
    // Not even an empty one of somebody else's folders goes.
    let empty = outside.join("balls");
    let _ = fs::remove_dir_all(&empty);
    fs::create_dir(&empty).unwrap();
    let is_kept = |path: &Path| !path.starts_with(&left) && !path.starts_with(&added) && !path.starts_with(&redirected);
    let kept = || all(at).into_iter().filter(|(path, ..)| is_kept(path)).collect::<Vec<_>>();
    let (before, scripts) = (kept(), all(&outside));
    swept(at);
    assert_eq!(kept(), before);
    assert!(!left.exists());
    assert_eq!(names(&added), [".alive", "thesis.tex"]);
    assert_eq!(names(&redirected), [".alive", "derivations"]);
    assert_eq!(all(&outside), scripts);
    // What was in the way is gone: then so is the rest.
    fs::remove_file(added.join("thesis.tex")).unwrap();
    fs::remove_file(redirected.join("derivations")).unwrap();
    swept(at);
    assert!(!added.exists() && !redirected.exists());
    assert_eq!(kept(), before);
}

/// Folders of programs that run are locked, and stay.
#[test]
fn what_is_in_use_stays() {
    let folder = TempDir::new().unwrap();
    let left = left(folder.path());
    let alive = fs::File::open(left.join(".alive")).unwrap();
    alive.lock().unwrap();
    let before = all(folder.path());
    swept(folder.path());
    assert_eq!(all(folder.path()), before);
    // Closing the file would not do: a process that another test is about to start may have it open as well.
    alive.unlock().unwrap();
    swept(folder.path());
    assert_eq!(names(folder.path()), Vec::<String>::new());
}
