//! Is a file written whole or not at all, whatever happens on the way?

use std::fs;
use std::io::Write;
use std::path::Path;

use corner_impact::file::Output;
use tempfile::TempDir;

fn names(folder: &TempDir) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn create(path: &Path) -> Output<'static> {
    Output::create(path, Box::leak(Box::new(std::io::sink()))).unwrap()
}

#[test]
fn a_file_appears_when_it_is_complete() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("out.csv");
    let mut output = create(&path);
    for row in 0..100_000 {
        writeln!(output, "{row},1.0").unwrap();
    }
    assert!(!path.exists());
    // What has no name yet is nowhere; where a system has no such files it is hidden.
    assert!(names(&folder).iter().all(|name| name.starts_with('.')), "{:?}", names(&folder));
    output.commit().unwrap();
    assert_eq!(names(&folder), ["out.csv"]);
    assert_eq!(fs::read_to_string(&path).unwrap().lines().count(), 100_000);
}

#[test]
fn what_is_not_committed_leaves_nothing() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("out.csv");
    fs::write(&path, "before").unwrap();
    let mut output = create(&path);
    output.write_all(&[b'x'; 100_000]).unwrap();
    drop(output);
    assert_eq!(names(&folder), ["out.csv"]);
    assert_eq!(fs::read_to_string(&path).unwrap(), "before");
}

#[test]
fn a_dash_is_standard_output() {
    let mut standard = Vec::new();
    let mut output = Output::create(Path::new("-"), &mut standard).unwrap();
    write!(output, "a,b").unwrap();
    output.commit().unwrap();
    assert_eq!(standard, b"a,b");
    assert!(!Path::new("-").exists());
}

/// What cannot be taken back says in its last line that it is not all.
#[test]
fn a_stream_that_is_not_complete_says_so() {
    let mut standard = Vec::new();
    let mut output = Output::create(Path::new("-"), &mut standard).unwrap();
    writeln!(output, "a,b").unwrap();
    drop(output);
    assert_eq!(String::from_utf8(standard).unwrap(), "a,b\n# unfinished: standard error says why\n");
    let mut standard = Vec::new();
    drop(Output::create(Path::new("-"), &mut standard).unwrap());
    assert!(standard.is_empty());
}

/// Refuses every byte, as a closed pipe or a full disk does.
struct Full;

impl Write for Full {
    fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
        Err(std::io::ErrorKind::StorageFull.into())
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn errors_name_the_path_and_say_why() {
    let folder = TempDir::new().unwrap();
    let refused = |path: &Path| Output::create(path, &mut std::io::sink()).unwrap_err().to_string();
    let missing = refused(&folder.path().join("none/out.csv"));
    assert!(missing.contains("none/out.csv") && missing.contains("there is no folder"), "{missing}");
    let is_folder = refused(folder.path());
    assert!(is_folder.contains(&folder.path().display().to_string()) && is_folder.contains("directory"), "{is_folder}");
    fs::write(folder.path().join("file"), "").unwrap();
    assert!(refused(&folder.path().join("file/out.csv")).contains("file/out.csv"));
    assert!(refused(Path::new("")).contains("cannot be written"));

    let mut full = Full;
    let mut output = Output::create(Path::new("-"), &mut full).unwrap();
    output.write_all(b"short enough to wait in the buffer").unwrap();
    let error = output.commit().unwrap_err();
    assert_eq!(error.kind(), std::io::ErrorKind::StorageFull);
    assert!(error.to_string().starts_with("standard output: cannot be written"), "{error}");
    let mut output = Output::create(Path::new("-"), &mut full).unwrap();
    let error = output.write_all(&[0; 100_000]).unwrap_err();
    assert!(error.to_string().starts_with("standard output: cannot be written"), "{error}");
}

#[cfg(unix)]
mod unix {
    use std::io::{BufRead, BufReader};
    use std::os::unix::fs::{PermissionsExt, symlink};
    use std::os::unix::process::ExitStatusExt;
    use std::process::{Command, Stdio};

    use super::*;

    #[test]
    fn devices_are_written_to_and_links_followed() {
        let mut output = create(Path::new("/dev/null"));
        output.write_all(b"x").unwrap();
        output.commit().unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
        if Path::new("/dev/full").exists() {
            let mut output = create(Path::new("/dev/full"));
            output.write_all(b"x").unwrap();
            let error = output.commit().unwrap_err().to_string();
            assert!(error.starts_with("/dev/full: cannot be written: No space left"), "{error}");
        }
        let folder = TempDir::new().unwrap();
        let (target, link) = (folder.path().join("target"), folder.path().join("link"));
        fs::write(&target, "before").unwrap();
        fs::set_permissions(&target, fs::Permissions::from_mode(0o640)).unwrap();
        symlink(&target, &link).unwrap();
        let mut output = create(&link);
        output.write_all(b"after").unwrap();
        output.commit().unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&target).unwrap(), "after");
        assert_eq!(fs::metadata(&target).unwrap().permissions().mode() & 0o777, 0o640);
        // A new file is as open as any other of this user.
        let (new, ordinary) = (folder.path().join("new"), folder.path().join("ordinary"));
        create(&new).commit().unwrap();
        fs::write(&ordinary, "").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&new), mode(&ordinary));
    }

    /// Not a test: the process that the next test stops.
    #[test]
    fn child_that_waits() {
        let Ok(path) = std::env::var("CORNER_IMPACT_TEST_FILE") else { return };
        corner_impact_cli::cli::clear_on_signals().unwrap();
        let mut output = create(Path::new(&path));
        output.write_all(&[b'x'; 100_000]).unwrap();
        println!("\nready");
        std::thread::sleep(crate::common::PATIENCE);
    }

    /// What ends a program from outside: SIGHUP, INT, QUIT, KILL, USR1, USR2, ALRM, TERM, VTALRM, PROF, XCPU. Nothing is left, whether a file of
    /// that name was there before or not.
    #[cfg(target_os = "linux")]
    #[test]
    fn no_signal_leaves_anything() {
        for signal in [1, 2, 3, 9, 10, 12, 14, 15, 24, 26, 27] {
            let folder = TempDir::new().unwrap();
            let was_there = signal % 2 == 0;
            if was_there {
                fs::write(folder.path().join("out.csv"), "before").unwrap();
            }
            let mut program = Command::new(std::env::current_exe().unwrap());
            program.args(["--exact", "whole_files::unix::child_that_waits", "--nocapture"]);
            let mut child = crate::common::that_signals_end(&program)
                .env("CORNER_IMPACT_TEST_FILE", folder.path().join("out.csv"))
                .stdout(Stdio::piped())
                .spawn()
                .unwrap();
            let lines = BufReader::new(child.stdout.take().unwrap()).lines();
            assert!(lines.map(Result::unwrap).any(|line| line == "ready"));
            let kill = Command::new("kill").args([format!("-{signal}"), child.id().to_string()]).status().unwrap();
            assert!(kill.success());
            // The shell is to see the signal, not an exit code.
            assert_eq!(child.wait().unwrap().signal(), Some(signal));
            let left = names(&folder);
            assert_eq!(left, if was_there { vec!["out.csv"] } else { Vec::new() }, "signal {signal}");
            assert!(!was_there || fs::read_to_string(folder.path().join("out.csv")).unwrap() == "before");
        }
    }

    /// Signals wait for the registry. As soon as the first of many names is there, nobody gets it until the last one is.
    #[test]
    #[ignore = "slow"]
    fn signals_wait_until_all_files_have_their_names() {
        /// Number of files: a process may have about as many open.
        const MANY: usize = 800;
        let folder = TempDir::new().unwrap();
        let file = |index: usize| {
            let mut output = create(&folder.path().join(index.to_string()));
            output.write_all(b"x").unwrap();
            output
        };
        let outputs: Vec<Output<'_>> = (0..MANY).map(file).collect();
        std::thread::scope(|scope| {
            let waiting = scope.spawn(|| {
                while names(&folder).is_empty() {}
                let _held = corner_impact::inner::held();
                names(&folder).len()
            });
            Output::commit_all(outputs).unwrap();
            assert_eq!(waiting.join().unwrap(), MANY);
        });
    }

    /// One of three files cannot have its name: the others are as they were.
    #[test]
    fn one_name_that_cannot_be_leaves_all_as_they_were() {
        let folder = TempDir::new().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("old"), "before").unwrap();
        let outputs: Vec<Output<'_>> = ["old", "new", "taken"]
            .iter()
            .map(|name| {
                let mut output = create(&at(name));
                output.write_all(b"after").unwrap();
                output
            })
            .collect();
        fs::create_dir(at("taken")).unwrap();
        let refused = Output::commit_all(outputs).unwrap_err().to_string();
        assert!(refused.contains("taken: cannot be replaced"), "{refused}");
        assert_eq!(fs::read_to_string(at("old")).unwrap(), "before");
        assert_eq!(names(&folder), ["old", "taken"]);
        // With all names free, or files, they are given.
        fs::remove_dir(at("taken")).unwrap();
        Output::commit_all(["old", "new"].map(|name| create(&at(name))).into()).unwrap();
        assert_eq!(
            (names(&folder), fs::read_to_string(at("old")).unwrap()),
            (vec!["new".into(), "old".into()], String::new())
        );
    }

    /// A name that is taken while the work goes on is replaced, as one that was taken before.
    #[test]
    fn a_name_that_is_taken_meanwhile_is_replaced() {
        let folder = TempDir::new().unwrap();
        let path = folder.path().join("out.csv");
        let mut output = create(&path);
        output.write_all(b"after").unwrap();
        fs::write(&path, "meanwhile").unwrap();
        output.commit().unwrap();
        assert_eq!((names(&folder), fs::read_to_string(&path).unwrap()), (vec!["out.csv".into()], "after".into()));
    }

    /// As long a name as a file may have, which leaves no room for a longer one beside it.
    #[test]
    fn the_longest_name_is_as_good_as_any() {
        let folder = TempDir::new().unwrap();
        let path = folder.path().join("n".repeat(255));
        for words in ["new", "in its place"] {
            let mut output = create(&path);
            output.write_all(words.as_bytes()).unwrap();
            output.commit().unwrap();
            assert_eq!((names(&folder).len(), fs::read_to_string(&path).unwrap().as_str()), (1, words));
        }
        let refused = Output::create(&folder.path().join("n".repeat(256)), &mut std::io::sink()).unwrap_err();
        assert!(refused.to_string().contains("too long"), "{refused}");
    }

    /// Renaming asks nobody: neither a file that may not be written to nor a link that leads nowhere is replaced.
    #[test]
    fn read_only_files_and_links_to_nowhere_are_refused() {
        let folder = TempDir::new().unwrap();
        let (locked, link) = (folder.path().join("locked"), folder.path().join("link"));
        fs::write(&locked, "mine").unwrap();
        fs::set_permissions(&locked, fs::Permissions::from_mode(0o444)).unwrap();
        symlink("nowhere", &link).unwrap();
        let refused = |path: &Path| Output::create(path, &mut std::io::sink()).unwrap_err().to_string();
        assert!(refused(&locked).contains("read-only"), "{}", refused(&locked));
        assert!(refused(&link).contains("a link to a file that does not exist"), "{}", refused(&link));
        assert_eq!((names(&folder).len(), fs::read_to_string(&locked).unwrap().as_str()), (2, "mine"));
    }
}
