//! How much memory do long runs and pictures take?

#![cfg(target_os = "linux")]

use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Command, Stdio};

use crate::common;

const MODEL: &str = "models/osorio-2008.toml";
/// The goal for every command, kB. The program itself takes about 10 MB, most of it code and the threads' stacks.
const MOST: u64 = 20_000;

/// What has been resident at most so far, kB; none of a program that has ended.
fn most_resident(child: &Child) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix(" kB")?.parse().ok()
}

/// The same while most of the output is still to be read: the pipe holds the program up.
fn most_while_printing(arguments: &[&str], rows: usize) -> u64 {
    let mut child = common::program(arguments).stdout(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    // Far enough from the end for some of it to be in the program's own hands.
    assert_eq!(lines.by_ref().take(rows).count(), rows, "{arguments:?}");
    let most = most_resident(&child).unwrap();
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
        let most = most_resident(&child).unwrap();
        let mut rest = Vec::new();
        reader.read_to_end(&mut rest).unwrap();
        assert!(rest.len() > 1 << 16, "{line}: {} bytes are all in the pipe", rest.len());
        assert!(child.wait().unwrap().success());
        assert!(most < MOST, "{line} {name}: {most} kB");
    }
}

/// How a run ends, and the most that was resident meanwhile, kB.
fn end_of_a_run(rpm: &str, revolutions: u64, start: &[String]) -> (serde_json::Value, u64) {
    let count = revolutions.to_string();
    let words = ["simulate", MODEL, "--rpm", rpm, "--revolutions", &count, "--summary"];
    let mut child = common::program(words).args(start).stdout(Stdio::piped()).spawn().unwrap();
    let mut most = 0;
    while child.try_wait().unwrap().is_none() {
        most = most.max(most_resident(&child).unwrap_or(0));
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    (serde_json::from_reader(child.stdout.unwrap()).unwrap(), most)
}

/// A long run and two of half its length have the same impacts and end alike to the last digits, in the memory of a short one:
/// `make soak` has a thousand times as many revolutions. Chaos makes another run of the last digits: of that, how often it hits.
#[test]
#[ignore = "slow"]
fn the_length_of_a_run_costs_neither_memory_nor_digits() {
    let times = if std::env::var_os("SOAK").is_some() { 1000 } else { 1 };
    for (rpm, revolutions) in [("700", 1_000_000 * times), ("670", 100_000 * times)] {
        let (short, _) = end_of_a_run(rpm, 1000, &[]);
        let (whole, most) = end_of_a_run(rpm, revolutions, &[]);
        let (half, _) = end_of_a_run(rpm, revolutions / 2, &[]);
        let at = |run: &serde_json::Value, name: &str| run["final"][name].as_f64().unwrap();
        let [angle, position, velocity] = ["cam_angle_rad", "position_m", "velocity_m_s"].map(|name| at(&half, name));
        let state = format!("--state={position:?},{velocity:?}");
        let (rest, _) = end_of_a_run(rpm, revolutions / 2, &["--start-angle".into(), format!("{angle:?}"), state]);
        println!("{rpm} rpm, {revolutions} revolutions: {most} kB, {whole}");
        assert!(most < MOST, "{rpm} rpm: {most} kB");
        let impacts = |run: &serde_json::Value| run["impacts"].as_f64().unwrap();
        let both = impacts(&half) + impacts(&rest);
        if rpm == "670" {
            // The number of impacts spreads by less than its root.
            let spread = 10.0 * both.sqrt();
            assert!((impacts(&whole) - both).abs() < spread, "{} impacts, {both} in halves", impacts(&whole));
            continue;
        }
        assert_eq!((impacts(&whole), impacts(&whole)), (both, revolutions as f64 + 1.0));
        for (name, size) in [("cam_angle_rad", 0.0), ("position_m", 3.0), ("velocity_m_s", 17.0)] {
            for other in [&short, &rest] {
                let apart = (at(&whole, name) - at(other, name)).abs();
                assert!(apart <= 16.0 * f64::EPSILON * size, "{name}: {apart:e}, {whole} {other}");
            }
        }
    }
}
