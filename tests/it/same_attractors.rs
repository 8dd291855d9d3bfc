//! Is an attractor of `speeds` what `basins`, `orbit`, `chart` and `diagram` find at the same speed?
//!
//! `python/tests/test_attractors.py` asks the same of the Python package.

use std::collections::BTreeSet;
use std::path::Path;

use serde_json::Value;

use crate::common::{self, text};

/// Budget of `speeds` and `basins`, for the commands that follow a run for less.
const BUDGET: [&str; 6] = ["--transient", "200", "--record", "1600", "--patience", "100000"];
/// Least share of the starts of a survey that the other one must have met, too.
const SEEN: f64 = 0.15;
/// Longest period whose orbits are looked for, revolutions.
const LONGEST: u64 = 4;

/// Kind, revolutions and impacts of a motion.
type Word = (String, Option<u64>, Option<u64>);

fn printed(words: &[&str]) -> String {
    let output = common::corner_impact(words);
    assert_eq!(output.status.code(), Some(0), "{words:?}: {}", text(output.stderr));
    text(output.stdout)
}

fn document(words: &[&str]) -> Value {
    serde_json::from_str(&printed(&[words, &["--json"]].concat())).unwrap()
}

/// Chaos that rests once in more revolutions than were run is called chaotic with these revolutions, and resting where a rest was met: as a
/// word both are one.
fn word(of: &Value, kind: &str) -> Word {
    let (kind, revolutions) = (of[kind].as_str().unwrap(), of["revolutions"].as_u64());
    let is_rare = kind == "resting" && revolutions.is_none();
    (if is_rare { "chaotic" } else { kind }.into(), revolutions, of["impacts"].as_u64())
}

/// The cells of the one row of a table.
fn row(words: &[&str]) -> Vec<String> {
    let table = printed(words);
    assert_eq!(table.lines().count(), 2, "{table}");
    table.lines().nth(1).unwrap().split(',').map(str::to_owned).collect()
}

#[track_caller]
fn near(one: f64, two: f64, what: &str) {
    assert!((one - two).abs() <= 1e-6 * one.abs().max(two.abs()), "{what}: {one} {two}");
}

/// Holds all commands against each other at a speed, rpm; returns how many periodic attractors were found again by each.
fn agree(model: &str, rpm: u32, restitution: &str) -> usize {
    let what = format!("{model} at {rpm} rpm with restitution {restitution}");
    let path = format!("models/{model}.toml");
    let set = format!("restitution={restitution}");
    let (speed, range) = (rpm.to_string(), format!("{rpm}:{}", rpm + 1));
    let asked = |command: &str, rest: &[&str]| {
        let mut words = vec![command.to_owned(), path.clone(), "--set".to_owned(), set.clone(), "--quiet".to_owned()];
        words.extend(rest.iter().map(|word| (*word).to_owned()));
        words
    };
    let find =
        |command: &str, rest: &[&str]| document(&asked(command, rest).iter().map(String::as_str).collect::<Vec<_>>());
    let found = find("speeds", &["--rpm", &range, "--speeds", "2", "--starts", "16"]);
    let shares = found["attractors"].as_array().unwrap().iter().flat_map(|it| it["shares"].as_array().unwrap());
    let here: Vec<&Value> = shares
        .filter(|share| share["speed_rpm"] == f64::from(rpm) && share["share"].as_f64().is_some_and(|it| it > 0.0))
        .collect();
    let words: BTreeSet<Word> = here.iter().map(|share| word(share, "kind")).collect();
    let basins = find("basins", &["--rpm", &speed, "--grid", "12x12"]);
    let endings = basins["endings"].as_array().unwrap();
    let ended: BTreeSet<Word> = endings.iter().map(|ending| word(ending, "ending")).collect();
    for ending in endings.iter().filter(|ending| ending["share"].as_f64().unwrap() >= SEEN) {
        assert!(words.contains(&word(ending, "ending")), "{what}: speeds lacks {ending}");
    }
    let mut again = 0;
    for share in here {
        let is_rare = share["share"].as_f64().unwrap() < SEEN;
        assert!(is_rare || ended.contains(&word(share, "kind")), "{what}: basins lacks {share}");
        let revolutions = share["revolutions"].as_u64().unwrap_or(u64::MAX);
        if share["kind"] != "periodic" || revolutions > LONGEST {
            continue;
        }
        let orbits = find("orbit", &["--rpm", &speed, "--revolutions", &revolutions.to_string()]);
        let is_it = |orbit: &&Value| {
            let count = orbit["impacts"].as_array().unwrap().len() as u64;
            orbit["stable"] == true && orbit["revolutions"] == revolutions && share["impacts"] == count
        };
        let orbit = orbits["orbits"].as_array().unwrap().iter().find(is_it);
        let orbit = orbit.unwrap_or_else(|| panic!("{what}: orbit lacks {share}"));
        let state = format!("{},{}", orbit["state"][0], orbit["state"][1]);
        let rest = [&["--state", &state, "--out", "-"][..], &BUDGET].concat();
        let axes = format!("rpm={rpm}:{rpm}:1");
        let mass = common::read(Path::new(&path)).follower.mass;
        let other = format!("mass={mass}:{mass}:1");
        let charted = asked("chart", &[&["--over", &axes, "--over", &other][..], &rest].concat());
        let charted = row(&charted.iter().map(String::as_str).collect::<Vec<_>>());
        let swept = asked("diagram", &[&["--rpm", &axes[4..], "--one-row"][..], &rest].concat());
        let swept = row(&swept.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(charted[2..], swept[1..], "{what}");
        assert_eq!(charted[2..5], ["periodic".into(), revolutions.to_string(), share["impacts"].to_string()], "{what}");
        near(charted[5].parse().unwrap(), share["growth"].as_f64().unwrap(), &what);
        near(charted[7].parse().unwrap(), share["impact_speed_m_s"].as_f64().unwrap(), &what);
        again += 1;
    }
    again
}

/// The window of `basins` holds what moves far faster than the cam does at the section, where no orbit of one impact says how fast that is:
/// of these machines it did not.
#[test]
#[ignore = "slow"]
fn starts_are_as_fast_as_the_machine() {
    for (model, rpm, restitution) in [("laws/table-quintic", 359, "0.818"), ("laws/polynomial", 1615, "0.8")] {
        assert!(agree(model, rpm, restitution) <= 1, "{model}");
    }
}

/// "No rest in N revolutions" counts what was run: of many chaotic runs as many are recorded as of few.
#[test]
fn revolutions_without_a_rest_are_those_that_were_run() {
    let recorded = |grid: &str| {
        let window = ["--position", "0.5:4", "--velocity=-30:30"];
        let asked = ["basins", "models/damped-heavy.toml", "--rpm", "700", "--grid", grid, "--quiet"];
        let found = document(&[&asked[..], &window].concat());
        let [ending] = found["endings"].as_array().unwrap().as_slice() else { panic!("{found}") };
        assert_eq!(ending["ending"], "chaotic");
        // A transient before a run is judged, and another before it counts as wandering.
        let transients = 2 * found["starts"].as_u64().unwrap() * found["budget"]["transient"].as_u64().unwrap();
        ending["followed"].as_u64().unwrap() - found["wandering"]["revolutions"].as_u64().unwrap() - transients
    };
    let [few, many] = ["6x6", "12x12"].map(recorded);
    assert_eq!([few, many], [6400; 2]);
}

#[test]
#[ignore = "slow"]
fn an_attractor_is_the_same_whoever_finds_it() {
    let cases = [
        ("osorio-2008", 700, "0.8"),
        ("osorio-2008", 670, "0.8"),
        ("damped-heavy", 500, "0.45"),
        ("sharp-nose", 330, "0.3"),
        ("laws/polynomial", 891, "0.125"),
        ("laws/harmonic", 550, "0.5"),
    ];
    let again: usize = cases.iter().map(|(model, rpm, restitution)| agree(model, *rpm, restitution)).sum();
    assert!(again >= 3, "{again}");
}

#[test]
#[ignore = "slow"]
fn attractors_of_120_machines_are_the_same_whoever_finds_them() {
    const MODELS: [&str; 10] = [
        "osorio-2008",
        "damped-heavy",
        "damped-light",
        "ballistic",
        "preloaded",
        "sharp-nose",
        "overdamped",
        "laws/polynomial",
        "laws/harmonic",
        "laws/program",
    ];
    // A third of them, at speeds that go on from model to model.
    let part = if crate::common::is_whole() { 1 } else { 3 };
    let mut again = 0;
    for (index, model) in MODELS.iter().enumerate() {
        for case in (index as u32 % part..12).step_by(part as usize) {
            let rpm = 100 + 120 * case + 7 * index as u32;
            let restitution = format!("0.{}", 12 + 7 * ((case + index as u32) % 12));
            again += agree(model, rpm, &restitution);
        }
    }
    assert!(again >= 10 / part as usize, "{again}");
}
