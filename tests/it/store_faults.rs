//! Does a store belong to one chart, whatever happens to its files and to the programs that fill it? docs/reliability.md has the figures.

#![cfg(unix)]

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use corner_impact::progress::Unwatched;
use corner_impact::study::chart::store::{Shard, Store, StoreError, VARIABLES, blocks_of, status, status_within};
use corner_impact::study::chart::{Blocks, Chart};
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::chart_store::chart;
use crate::common::{self, PROGRAM, osorio, program, text};

/// A chart of 3 x 2 points, up to a restitution, in a store of one block.
fn command(folder: &Path, to: &str) -> Command {
    let across = ["chart", "--x", "rpm=600:760:3", "--transient", "5", "--record", "5", "--threads", "1", "--quiet"];
    let mut command = program(across);
    command.args(["--y", &format!("restitution=0.5:{to}:2"), "--out"]).arg(folder);
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

fn filled(store: &Store<'_>) -> Blocks {
    store.fill(Shard::ALL, Some(1), &Unwatched).unwrap().blocks
}

/// All files below a folder, with their contents.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() { all.extend(files(&path)) } else { all.push((path.clone(), fs::read(&path).unwrap())) }
    }
    all.sort();
    all
}

/// Files of a store, named from its folder.
fn contents(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    files(folder).into_iter().map(|(path, bytes)| (path.strip_prefix(folder).unwrap().to_owned(), bytes)).collect()
}

#[track_caller]
fn one_wins(outputs: [Output; 2], store: &Path, alone: &[Vec<(PathBuf, Vec<u8>)>; 2]) {
    let codes = [&outputs[0], &outputs[1]].map(|output| output.status.code());
    let winner =
        codes.iter().position(|code| *code == Some(0)).unwrap_or_else(|| panic!("both are refused: {outputs:?}"));
    let [one, two] = outputs;
    let said = text([two, one][winner].stderr.clone());
    assert_eq!(codes[1 - winner], Some(2), "both win");
    assert!(said.contains("holds another chart"), "{said}");
    assert_eq!(contents(store), alone[winner]);
}

fn races(count: usize) {
    let folder = TempDir::new().unwrap();
    let ends = ["0.9", "0.8"];
    let alone = ends.map(|end| {
        let store = folder.path().join(format!("{end}.zarr"));
        assert!(command(&store, end).output().unwrap().status.success());
        contents(&store)
    });
    for race in 0..count {
        let store = folder.path().join(format!("{race}.zarr"));
        let both = ends.map(|end| command(&store, end).spawn().unwrap());
        one_wins(both.map(|child| child.wait_with_output().unwrap()), &store, &alone);
    }
}

#[test]
fn of_two_charts_begun_at_once_one_wins() {
    races(10);
}

#[test]
#[ignore = "slow"]
fn of_two_charts_begun_at_once_one_wins_200_times() {
    races(200);
}

/// Killed at any moment, a chart is completed by the same command, and another chart is refused.
#[test]
#[ignore = "slow"]
fn what_is_killed_is_completed_by_the_same_chart_alone() {
    let folder = TempDir::new().unwrap();
    let alone = folder.path().join("alone.zarr");
    let started = Instant::now();
    assert!(command(&alone, "0.9").output().unwrap().status.success());
    let whole = started.elapsed();
    const MOMENTS: u32 = 20;
    for moment in 0..MOMENTS {
        let store = folder.path().join(format!("{moment}.zarr"));
        let mut killed = command(&store, "0.9").spawn().unwrap();
        std::thread::sleep(whole * moment / MOMENTS);
        killed.kill().unwrap();
        killed.wait().unwrap();
        let is_begun = store.join("zarr.json").exists();
        let other = command(&store, "0.8").output().unwrap();
        assert_eq!(other.status.success(), !is_begun, "{}", text(other.stderr));
        let (end, same) = if is_begun { ("0.9", contents(&alone)) } else { ("0.8", contents(&store)) };
        assert!(command(&store, end).output().unwrap().status.success());
        assert_eq!(contents(&store), same);
    }
}

/// Nothing says which chart the blocks of a store without `zarr.json` are of, not even to the chart that wrote them.
#[test]
fn without_its_description_a_store_takes_no_chart() {
    let folder = TempDir::new().unwrap();
    let own = chart(&osorio(), 8);
    let at = folder.path();
    filled(&Store::open(at, &own, [2, 3]).unwrap());
    fs::remove_file(at.join("zarr.json")).unwrap();
    let before = files(at);
    for chart in [own, chart(&osorio(), 9)] {
        let refused = Store::open(at, &chart, [2, 3]).map(|_| ()).unwrap_err().to_string();
        assert!(refused.contains("arrays but no zarr.json"), "{refused}");
    }
    assert!(status(at).is_err());
    assert_eq!(files(at), before);
    // A link to nowhere is no description either, and is not written through.
    let other = TempDir::new().unwrap();
    symlink(other.path().join("there"), other.path().join("zarr.json")).unwrap();
    assert!(matches!(Store::open(other.path(), &chart(&osorio(), 8), [2, 3]), Err(StoreError::None { .. })));
    assert!(!other.path().join("there").exists());
}

/// Where the folder is removed, and another chart begun in it, while a chart runs.
#[test]
fn a_chart_whose_folder_was_taken_writes_nothing_there() {
    let folder = TempDir::new().unwrap();
    let at = folder.path().join("a.zarr");
    let (first, second) = (chart(&osorio(), 8), chart(&osorio(), 9));
    let store = Store::open(&at, &first, [2, 3]).unwrap();
    fs::remove_dir_all(&at).unwrap();
    filled(&Store::open(&at, &second, [2, 3]).unwrap());
    for variable in &VARIABLES {
        fs::remove_file(at.join(variable.name).join("c/0/0")).unwrap();
    }
    let before = files(&at);
    let refused = store.fill_block(0, Some(1)).unwrap_err();
    assert!(matches!(&refused, StoreError::Another { how, .. } if how.contains("removed or replaced")), "{refused}");
    assert_eq!(files(&at), before);
}

/// A byte of each file in turn is flipped, and each is cut: what is damaged is written again, and nothing else.
#[test]
#[ignore = "slow"]
fn what_is_damaged_is_written_again() {
    let folder = TempDir::new().unwrap();
    let (at, own) = (folder.path(), chart(&osorio(), 8));
    let store = Store::open(at, &own, [3, 4]).unwrap();
    assert_eq!(filled(&store), Blocks { computed: 2, done: 2, total: 2 });
    let whole = files(at);
    let group = at.join("zarr.json");
    for (path, bytes) in &whole {
        let middle = bytes.len() / 2;
        let mut flipped = bytes.clone();
        flipped[middle] ^= 4;
        for damaged in [&flipped[..], &bytes[..middle], &[]] {
            fs::write(path, damaged).unwrap();
            if *path == group {
                assert!(Store::open(at, &own, [3, 4]).is_err());
                fs::write(path, bytes).unwrap();
            }
            let name = path.display();
            let is_block = path.ends_with("c/0/0") || path.ends_with("c/0/1");
            let done = status(at).unwrap().done;
            assert_eq!(done, if is_block { 1 } else { 2 }, "{name}");
            let computed = filled(&Store::open(at, &own, [3, 4]).unwrap()).computed;
            assert_eq!(computed, usize::from(is_block), "{name}");
            assert_eq!(files(at), whole, "{name}");
        }
    }
}

/// A store as it was written before blocks had checksums.
fn old(folder: &Path, chart: &Chart) {
    filled(&Store::open(folder, chart, [3, 4]).unwrap());
    let group = folder.join("zarr.json");
    let mut document: Value = serde_json::from_slice(&fs::read(&group).unwrap()).unwrap();
    document["attributes"].as_object_mut().unwrap().remove("axes");
    let arrays = document["consolidated_metadata"]["metadata"].as_object_mut().unwrap();
    for (name, array) in arrays {
        array["codecs"] = json!([{ "name": "bytes", "configuration": { "endian": "little" } }]);
        fs::write(folder.join(name).join("zarr.json"), format!("{array:#}")).unwrap();
    }
    fs::write(&group, format!("{document:#}")).unwrap();
    for (path, bytes) in files(folder).iter().filter(|(path, _)| !path.ends_with("zarr.json")) {
        fs::write(path, &bytes[..bytes.len() - 4]).unwrap();
    }
}

#[test]
fn a_store_without_checksums_is_continued() {
    let folder = TempDir::new().unwrap();
    let (at, own) = (folder.path(), chart(&osorio(), 8));
    old(at, &own);
    let before = files(at);
    assert_eq!(blocks_of(at).unwrap(), [true, true]);
    for variable in &VARIABLES {
        fs::remove_file(at.join(variable.name).join("c/0/1")).unwrap();
    }
    assert_eq!(filled(&Store::open(at, &own, [3, 4]).unwrap()), Blocks { computed: 1, done: 2, total: 2 });
    assert_eq!(files(at), before);
    // It describes its axes by their values alone.
    let mut other = own.clone();
    other.y.values = [0.1, 0.3, 0.5, 0.8].into();
    let refused = Store::open(at, &other, [3, 4]).map(|_| ()).unwrap_err().to_string();
    assert!(refused.contains("other values of follower.restitution"), "{refused}");
    assert_eq!(files(at), before);
}

/// Links to files of others, in the places of blocks, axes, descriptions and folders.
#[test]
fn nothing_is_written_through_a_link() {
    let (folder, elsewhere) = (TempDir::new().unwrap(), TempDir::new().unwrap());
    let (at, own) = (folder.path(), chart(&osorio(), 8));
    filled(&Store::open(at, &own, [3, 4]).unwrap());
    let whole = files(at);
    let mine = elsewhere.path().join("mine");
    for name in ["class/c/0/1", "revolutions/c/0/0", "rpm/c/0", "rpm/zarr.json", "class/zarr.json"] {
        // Even a link to what the file should be is none of the store's.
        for held in [&b"mine"[..], &fs::read(at.join(name)).unwrap()] {
            fs::write(&mine, held).unwrap();
            fs::remove_file(at.join(name)).unwrap();
            symlink(&mine, at.join(name)).unwrap();
            filled(&Store::open(at, &own, [3, 4]).unwrap());
            assert_eq!(fs::read(&mine).unwrap(), held, "{name}");
            assert!(fs::symlink_metadata(at.join(name)).unwrap().is_file(), "{name}");
            assert_eq!(files(at), whole, "{name}");
        }
    }
    fs::remove_dir_all(at.join("class/c")).unwrap();
    symlink(elsewhere.path(), at.join("class/c")).unwrap();
    let refused = Store::open(at, &own, [3, 4]).unwrap().fill_block(0, Some(1)).unwrap_err().to_string();
    assert!(refused.contains("class/c: cannot be made: a link has its name"), "{refused}");
    assert_eq!(fs::read_dir(elsewhere.path()).unwrap().count(), 1);
}

/// Pipes, devices and folders in the places of files: none is waited for, and the store says what it cannot write.
#[test]
fn what_is_no_file_is_no_block() {
    let folder = TempDir::new().unwrap();
    let (at, own) = (folder.path(), chart(&osorio(), 8));
    filled(&Store::open(at, &own, [3, 4]).unwrap());
    let block = at.join("impacts/c/0/0");
    fs::remove_file(&block).unwrap();
    assert!(Command::new("mkfifo").arg(&block).status().unwrap().success());
    assert_eq!(status(at).unwrap().done, 1);
    assert_eq!(filled(&Store::open(at, &own, [3, 4]).unwrap()).done, 2);
    fs::remove_file(&block).unwrap();
    fs::create_dir(&block).unwrap();
    let before = files(at);
    assert!(Store::open(at, &own, [3, 4]).unwrap().fill_block(0, Some(1)).is_err());
    assert_eq!(files(at), before);
    let group = at.join("zarr.json");
    fs::remove_file(&group).unwrap();
    assert!(Command::new("mkfifo").arg(&group).status().unwrap().success());
    for said in
        [status(at).unwrap_err().to_string(), Store::open(at, &own, [3, 4]).map(|_| ()).unwrap_err().to_string()]
    {
        assert!(said.contains("a device, a pipe or a socket"), "{said}");
    }
}

/// A crafted description, or a store of more blocks than can be looked at, is answered within a second.
#[test]
#[ignore = "slow"]
fn a_status_is_an_answer_or_a_sentence_within_a_second() {
    let folder = TempDir::new().unwrap();
    let says = |shape: [u64; 2], chunk: [u64; 2], attributes: Value| {
        let class = json!({ "shape": shape, "chunk_grid": { "configuration": { "chunk_shape": chunk } } });
        let group = json!({ "attributes": attributes, "consolidated_metadata": { "metadata": { "class": class } } });
        fs::write(folder.path().join("zarr.json"), group.to_string()).unwrap();
        let started = Instant::now();
        let output = program(["chart", "--json", "--status"]).arg(folder.path()).output().unwrap();
        assert!(started.elapsed() < Duration::from_secs(if cfg!(debug_assertions) { 10 } else { 2 }), "{shape:?}");
        (output.status.code(), text(output.stdout) + &text(output.stderr))
    };
    let refused = |shape: [u64; 2], chunk: [u64; 2], words: &str| {
        let (code, said) = says(shape, chunk, json!({}));
        assert!(code == Some(2) && said.contains(words), "{said}");
    };
    refused([u64::MAX; 2], [1, 1], "18446744073709551615 blocks: a store can have 1048576 or fewer");
    refused([100_000, 10_000], [1, 1], "1000000000 blocks: a store can have 1048576 or fewer");
    refused([1025, 1024], [1, 1], "1049600 blocks: a store can have");
    refused([u64::MAX; 2], [u64::MAX; 2], "blocks of 18446744073709551615 x 18446744073709551615 points");
    refused([9, 9], [4096, 4097], "blocks of 4097 x 4096 points");
    for chunk in [[1, 1], [4096, 4096]] {
        let (code, said) = says([1000, 1000], chunk, json!({ "axes": [] }));
        assert!(code == Some(0) && said.contains("\"done\": 0") || said.contains("within a second"), "{said}");
    }
    assert_eq!(says([1, 1], [1, 1], json!({})).0, Some(0));
    let slow = status_within(folder.path(), Duration::ZERO).unwrap_err();
    assert!(matches!(slow, StoreError::Slow { done: 0, looked: 0, total: 1, .. }), "{slow}");
}

#[test]
fn a_chart_of_too_many_blocks_is_refused() {
    let (folder, own) = (TempDir::new().unwrap(), chart(&osorio(), 8));
    let mut many = own.clone();
    many.x.values = (0..1025).map(f64::from).collect();
    many.y.values = (0..1024).map(|row| f64::from(row) / 2000.0).collect();
    let at = folder.path().join("a.zarr");
    let refused = Store::open(&at, &many, [1, 1]).map(|_| ()).unwrap_err();
    assert!(matches!(refused, StoreError::TooMany { blocks: 1_049_600, most: 1_048_576 }), "{refused}");
    assert!(!at.exists());
    many.x.values = (0..1024).map(f64::from).collect();
    assert!(Store::open(&at, &many, [1, 1]).is_ok());
}

/// A folder that may not be written to: a store that is complete is read, and one that is not says why.
#[test]
fn a_read_only_store_is_read() {
    /// User and group of nobody.
    const NOBODY: u32 = 65534;
    let folder = TempDir::new().unwrap();
    let store = folder.path().join("a.zarr");
    assert!(command(&store, "0.9").output().unwrap().status.success());
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
    let copy = folder.path().join("program");
    common::copy_program(&copy);
    // An administrator may write anywhere.
    let is_administrator =
        fs::metadata("/proc/self").is_ok_and(|found| std::os::unix::fs::MetadataExt::uid(&found) == 0);
    let run = |to: &str| {
        let asked = command(&store, to);
        let mut command = Command::new(&copy);
        command.args(asked.get_args()).current_dir("/");
        if is_administrator {
            command.uid(NOBODY).gid(NOBODY);
        } else {
            for name in ["a.zarr", "a.zarr/class/c/0", "a.zarr/class"] {
                fs::set_permissions(folder.path().join(name), fs::Permissions::from_mode(0o555)).unwrap();
            }
        }
        command.output().unwrap()
    };
    let before = files(&store);
    let same = run("0.9");
    assert!(same.status.success(), "{}", text(same.stderr));
    assert_eq!(files(&store), before);
    fs::write(store.join("class/c/0/0"), "x").unwrap();
    let refused = run("0.9");
    let said = text(refused.stderr);
    assert!(refused.status.code() == Some(2) && said.contains("c/0/0: cannot be written: Permission denied"), "{said}");
    for name in ["a.zarr", "a.zarr/class/c/0", "a.zarr/class"] {
        fs::set_permissions(folder.path().join(name), fs::Permissions::from_mode(0o755)).unwrap();
    }
}

/// Files may grow to a limit, as on a full disk: no file of the store is there in part, and with room it is completed.
#[test]
fn without_room_a_store_keeps_whole_files_alone() {
    let folder = TempDir::new().unwrap();
    let alone = folder.path().join("alone.zarr");
    assert!(command(&alone, "0.9").output().unwrap().status.success());
    let whole = contents(&alone);
    // In blocks of 512 bytes: nothing, arrays without the group, and more than any file.
    for (limit, is_begun) in [(0, false), (3, false), (8, false)] {
        let store = folder.path().join(format!("{limit}.zarr"));
        let limited = format!("trap '' XFSZ; ulimit -f {limit}; exec \"$@\"");
        let asked = command(&store, "0.9");
        let mut shell = Command::new("sh");
        shell.args(["-c", &limited, "sh", PROGRAM]).args(asked.get_args());
        let output = shell.output().unwrap();
        let said = text(output.stderr);
        assert!(output.status.code() == Some(2) && said.contains("File too large"), "{limit}: {said}");
        assert_eq!(store.exists(), is_begun, "{limit}");
        assert!(command(&store, "0.9").output().unwrap().status.success());
        assert_eq!(contents(&store), whole, "{limit}");
    }
}

/// zarr's own library reads the store, checks its checksums, and writes blocks that this program takes for whole.
#[test]
#[ignore = "slow"]
fn zarr_and_this_program_agree_on_checksums() {
    let folder = TempDir::new().unwrap();
    let (at, own) = (folder.path(), chart(&osorio(), 8));
    filled(&Store::open(at, &own, [3, 4]).unwrap());
    let script = "import sys, json, numpy, zarr\n\
        store = zarr.open_group(sys.argv[1], mode='r+')\n\
        values = {name: array[:] for name, array in store.arrays()}\n\
        for name, array in store.arrays(): array[:] = values[name]\n\
        path = sys.argv[1] + '/class/c/0/0'\n\
        held = open(path, 'rb').read()\n\
        open(path, 'wb').write(bytes([held[0] ^ 1]) + held[1:])\n\
        try: zarr.open_group(sys.argv[1], mode='r')['class'][:]; raise SystemExit('no checksum')\n\
        except ValueError: pass\n\
        open(path, 'wb').write(held)\n\
        print(json.dumps([len(values), values['class'].shape]))\n";
    let interpreter = Path::new(common::ROOT).join(".venv/bin/python");
    let output = Command::new(interpreter).args(["-c", script]).arg(at).output().unwrap();
    assert_eq!(text(output.stdout).trim(), "[10, [4, 5]]", "{}", text(output.stderr));
    assert_eq!(status(at).unwrap(), Blocks { computed: 0, done: 2, total: 2 });
}
