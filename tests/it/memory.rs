//! How much memory do long runs and pictures take?

#![cfg(target_os = "linux")]

use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Command, Stdio};

use crate::common;

const MODEL: &str = "models/osorio-2008.toml";
/// The goal for every command, kB. The program itself takes about 10 MB, most of it code and the threads' stacks.
const MOST: u64 = 20_000;

/// What has been resident at most so far, kB.
fn most_resident(child: &Child) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    line.trim().strip_suffix(" kB").unwrap().parse().unwrap()
}

/// The same while most of the output is still to be read: the pipe holds the program up.
fn most_while_printing(arguments: &[&str], rows: usize) -> u64 {
    let mut child = common::program(arguments).stdout(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    // Far enough from the end for some of it to be in the program's own hands.
    assert_eq!(lines.by_ref().take(rows).count(), rows, "{arguments:?}");
    let most = most_resident(&child);
    assert!(lines.count() > 10_000, "{arguments:?}");
    assert!(child.wait().unwrap().success());
    most
}

/// However long a run or a record, memory stays where it was.
#[test]
#[ignore = "slow"]
fn memory_does_not_grow_with_the_length_of_a_run() {
    let sweep = ["diagram", MODEL, "--rpm", "700:720:2", "--record", "500000", "--threads", "2", "--out", "-"];
    let diagram = most_while_printing(&sweep, 950_000);
    let long = ["simulate", MODEL, "--rpm", "700", "--revolutions", "2000000", "--events", "-"];
    let simulate = most_while_printing(&long, 1_950_000);
    assert!(diagram < MOST && simulate < MOST, "{diagram} kB, {simulate} kB");
}

/// A picture that goes to a pipe waits there, whole, for its reader, but for what a pipe holds.
#[test]
#[ignore = "slow"]
fn pictures_take_no_more_than_a_run() {
    let folder = tempfile::TempDir::new().unwrap();
    for (line, name) in [
        ("simulate MODEL --rpm 183 --trace", "trace.png"),
        ("diagram MODEL --rpm 660:690:400 --threads 2 --out", "impacts.svg"),
        ("cam MODEL --out", "cam.png"),
        ("diagram MODEL --rpm 660:690:200 --threads 2 --out", "dots.png"),
        ("diagram MODEL --rpm 660:690:400 --lyapunov --threads 2 --out", "cells.png"),
    ] {
        let pipe = folder.path().join(name);
        assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let words = line.split(' ').map(|word| word.replace("MODEL", MODEL));
        let mut child = common::program(words).arg(&pipe).stdout(Stdio::null()).spawn().unwrap();
        let mut reader = std::fs::File::open(&pipe).unwrap();
        reader.read_exact(&mut [0; 8]).unwrap();
        let most = most_resident(&child);
        let mut rest = Vec::new();
        reader.read_to_end(&mut rest).unwrap();
        assert!(rest.len() > 1 << 16, "{line}: {} bytes are all in the pipe", rest.len());
        assert!(child.wait().unwrap().success());
        assert!(most < MOST, "{line} {name}: {most} kB");
    }
}
