//! Does a brute-force search find an orbit that a complete list lacks, or no orbit where a list has one that is proved?
//!
//! The search is `adversary/ask.py`, which shares no code with the proofs and asks the program as anybody would.

use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;

use serde_json::Value;

use crate::common;

/// What the search says of each machine it looked at.
fn looked_at(options: &[String]) -> Vec<Value> {
    let folder = tempfile::tempdir().unwrap();
    let mut command = Command::new(Path::new(common::ROOT).join(".venv/bin/python"));
    command.arg(Path::new(common::ROOT).join("tests/it/adversary/ask.py")).args([common::PROGRAM, "--folder"]);
    command.current_dir(common::ROOT);
    let output = command.arg(folder.path()).args(options).stderr(Stdio::inherit()).output().unwrap();
    assert!(output.status.success(), "{options:?}: {}", output.status);
    let mut all: Vec<Value> =
        common::text(output.stdout).lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    for machine in &mut all {
        let file = Path::new(common::ROOT).join(machine["file"].as_str().unwrap());
        machine["model"] = std::fs::read_to_string(file).unwrap().into();
    }
    all
}

fn words(text: &str) -> Vec<String> {
    text.split_whitespace().map(String::from).collect()
}

/// Machines of seeds from `first` to below `end`, as many processes at once as there are processors.
fn drawn(first: u32, end: u32, options: &str) -> Vec<Value> {
    let count = thread::available_parallelism().map_or(1, usize::from) as u32;
    let part = (end - first).div_ceil(count);
    thread::scope(|scope| {
        let parts = (first..end).step_by(part as usize).map(|start| {
            let options = words(&format!("--seeds {start} {} {options}", (start + part).min(end)));
            scope.spawn(move || looked_at(&options))
        });
        let parts: Vec<_> = parts.collect();
        parts.into_iter().flat_map(|part| part.join().unwrap()).collect()
    })
}

fn total(machines: &[Value], count: &str) -> u64 {
    machines.iter().map(|machine| machine[count].as_u64().unwrap()).sum()
}

#[track_caller]
fn nothing_is_wrong(machines: &[Value]) {
    for machine in machines {
        let wrong: Vec<_> = machine["wrong"].as_array().unwrap().iter().map(|what| what.as_str().unwrap()).collect();
        assert!(
            wrong.is_empty(),
            "seed {}, {}, {} rpm:\n{}\n\n{}",
            machine["index"],
            machine["plant"],
            machine["rpm"],
            wrong.join("\n"),
            machine["model"].as_str().unwrap()
        );
    }
}

/// `PROPERTIES=all` looks at 200 machines, and asks `certify` itself of every tenth, which takes a minute or more of each.
#[test]
#[ignore = "slow"]
fn no_orbit_is_found_that_a_complete_list_lacks() {
    let is_whole = crate::common::is_whole();
    let machines = match is_whole {
        true => {
            drawn(0, 207, "--ask orbit:1 --ask pairs:1 --ask proofs:1 --ask counts:1 --ask locate:1 --ask certify:10")
        }
        false => drawn(0, 21, "--ask orbit:1 --ask proofs:1 --ask pairs:8 --ask locate:7 --ask counts:10"),
    };
    nothing_is_wrong(&machines);
    let [asked, complete, confirmed, proved] =
        ["asked", "complete", "confirmed", "proved"].map(|count| total(&machines, count));
    println!(
        "{} machines: {asked} questions, {complete} complete lists, {confirmed} orbits found, {proved} proved",
        machines.len()
    );
    // Of a search that finds nothing, and of lists that are never said to be complete, nothing would be wrong.
    let least = if is_whole { 200 } else { 20 };
    assert!(
        machines.len() >= least && 10 * complete >= 7 * asked,
        "{} machines, {complete} of {asked}",
        machines.len()
    );
    assert!(confirmed as usize >= 2 * machines.len(), "{confirmed} orbits of {} machines", machines.len());
}

/// The cam's velocity jumps 2.1 degrees beyond the impact.
#[test]
#[ignore = "slow"]
fn an_orbit_next_to_a_jump_of_velocity_is_not_denied() {
    let mut given =
        words("--model tests/it/corpus/velocity-jump.toml 542.617 --ask orbit:1 --ask pairs:1 --ask proofs:1");
    if crate::common::is_whole() {
        given.extend(words("--ask certify:1"));
    }
    let machines = looked_at(&given);
    nothing_is_wrong(&machines);
    assert!(total(&machines, "confirmed") >= 2, "{machines:?}");
}

/// The search sees what it is there to see.
#[test]
#[ignore = "slow"]
fn an_orbit_that_is_left_out_of_a_list_is_missed() {
    let mut left_out = 0;
    for machine in drawn(0, 9, "--drop --ask orbit:1 --ask proofs:1") {
        let is_left_out = machine["left_out"].as_u64().unwrap() > 0;
        assert_eq!(machine["wrong"].as_array().unwrap().is_empty(), !is_left_out, "{machine}");
        left_out += u32::from(is_left_out);
    }
    assert!(left_out >= 5, "{left_out}");
}
