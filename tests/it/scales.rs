//! Are a machine's answers the same in whatever units its numbers are?
//!
//! Length, mass and time are scaled by powers of two, which doubles hold exactly, so that every number of an answer must be the same
//! one times a power of two, and every word the same. Angles have no unit.
//!
//! `make properties` asks 200 machines everything; `PROPTEST_CASES` and `PROPTEST_RNG_SEED` say how many and which.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Output;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use corner_impact::cam::Cam;
use corner_impact::model::Model;
use corner_impact::orbit::{PeriodicOrbit, Search, Searched, search_all};
use corner_impact::progress::Unwatched;
use corner_impact::simulate::{Machine, angular_velocity};
use proptest::prelude::*;
use serde_json::Value;

use crate::common::{ROOT, program, read, text};
use crate::random::{Case, Start, cases_of_every_law, check, drawn};

/// The powers of two that lengths, masses and times are scaled by.
pub type Scales = [i32; 3];
const NONE: Scales = [0; 3];
/// Up and down, each by another number of digits.
const SCALED: [Scales; 2] = [[-20, 10, -7], [10, -20, 17]];

fn factor(dimension: Scales, scales: Scales) -> f64 {
    2.0_f64.powi(dimension.iter().zip(scales).map(|(power, scale)| power * scale).sum())
}

/// What the numbers of a model are of: length, mass, time.
fn dimension(name: &str) -> Option<Scales> {
    match name {
        "mass" => Some([0, 1, 0]),
        "damping" => Some([0, 1, -1]),
        "stiffness" => Some([0, 1, -2]),
        "gravity" => Some([1, 0, -2]),
        "restitution" | "lever_ratio" | "start_deg" | "span_deg" | "phases_deg" | "flank_start_deg"
        | "nose_end_deg" => Some(NONE),
        "rest_position"
        | "base"
        | "rise"
        | "offset"
        | "amplitude"
        | "amplitudes"
        | "coefficients"
        | "base_radius"
        | "flank_radius"
        | "nose_radius"
        | "contact.roller_radius"
        | "contact.offset" => Some([1, 0, 0]),
        _ => None,
    }
}

/// The numbers of a line of TOML, each times a factor.
fn times(numbers: &str, factor: f64) -> String {
    let one = |number: &str| format!("{:?}", number.trim().parse::<f64>().unwrap() * factor);
    match numbers.strip_prefix('[') {
        Some(list) => {
            let all: Vec<_> = list.trim_end_matches(']').split(',').map(one).collect();
            format!("[{}]", all.join(", "))
        }
        None => one(numbers),
    }
}

/// The model of a case in other units, in a folder of its own.
fn written(case: &Case, scales: Scales, folder: &Path) -> PathBuf {
    let line = |line: &str| {
        let Some((name, value)) = line.split_once(" = ") else { return line.to_owned() };
        if value.starts_with('"') {
            return line.to_owned();
        }
        let dimension = dimension(name).unwrap_or_else(|| panic!("{name} is of no unit that is known here"));
        format!("{name} = {}", times(value, factor(dimension, scales)))
    };
    let lines: Vec<_> = case.text.lines().map(line).collect();
    let rpm = case.rpm * factor([0, 0, -1], scales);
    let study = format!("[study]\nrpm_min = {:?}\nrpm_max = {:?}\n", 0.5 * rpm, 2.0 * rpm);
    std::fs::write(folder.join("machine.toml"), format!("{}\n{study}", lines.join("\n"))).unwrap();
    if let Some(table) = &case.table {
        let row = |row: &str| {
            let (angle, lift) = row.split_once(',').unwrap();
            lift.parse::<f64>().map_or(row.to_owned(), |lift| format!("{angle},{:?}", lift * factor([1, 0, 0], scales)))
        };
        let rows: Vec<_> = table.lines().map(row).collect();
        std::fs::write(folder.join("table.csv"), rows.join("\n")).unwrap();
    }
    folder.join("machine.toml")
}

/// A model of the folder in other units.
pub fn in_units(name: &str, scales: Scales) -> Model {
    let text = std::fs::read_to_string(format!("{ROOT}/models/{name}.toml")).unwrap();
    let line = |line: &str| {
        let line = line.split('#').next().unwrap().trim();
        match line.split_once('=').map(|(name, value)| (name.trim(), value.trim())) {
            Some((name, value)) if !value.starts_with('"') => {
                dimension(name).map(|dimension| format!("{name} = {}", times(value, factor(dimension, scales))))
            }
            _ => Some(line.to_owned()),
        }
    };
    let lines = text[text.find("[follower]").unwrap()..].split("[study]").next().unwrap().lines();
    Model::parse("scaled.toml", &lines.filter_map(line).collect::<Vec<_>>().join("\n")).unwrap()
}

/// What is listed where no run goes on.
const NO_RUN: &str = "no run goes on";

/// All orbits of one revolution with so many impacts, and where that is not known: angles alone, to the last bit.
fn listed(model: &Model, rpm: f64, impacts: usize) -> String {
    let machine = Machine::new(Cam::new(model).unwrap(), &model.follower, angular_velocity(rpm));
    match search_all(&machine, &Search { revolutions: 1, impacts: Some(impacts) }, &Unwatched) {
        Ok(Searched { orbits, complete, undecided }) => {
            let angles = |orbit: &PeriodicOrbit| orbit.events.iter().map(|event| event.cam_angle).collect::<Vec<_>>();
            let orbits: Vec<_> = orbits.iter().map(|orbit| (orbit.known, angles(orbit))).collect();
            format!("{complete:?} {undecided:?} {orbits:?}")
        }
        Err(_) => NO_RUN.into(),
    }
}

/// Asks machines by their numbers among those that are drawn.
#[track_caller]
fn lists_are_the_same(impacts: usize, numbers: &[usize]) {
    let drawn = drawn(cases_of_every_law(), numbers.iter().max().unwrap() + 1);
    for number in numbers {
        let case = &drawn[*number];
        let expected = listed(&case.model, case.rpm, impacts);
        assert_ne!(expected, NO_RUN, "{case:?}");
        for scales in SCALED {
            let folder = tempfile::tempdir().unwrap();
            let scaled = read(&written(case, scales, folder.path()));
            let found = listed(&scaled, case.rpm * factor([0, 0, -1], scales), impacts);
            assert!(found == expected, "{number} with {impacts} impacts, {scales:?}:\n{expected}\n{found}\n{case:?}");
        }
    }
}

/// Enclosures of flights are made of what has a unit, and what they prove is not.
#[test]
fn lists_of_orbits_are_the_same_in_any_units() {
    lists_are_the_same(1, &[0, 1, 5, 9, 10]);
    lists_are_the_same(2, &[14, 15, 17]);
}

/// What is asked at once, and what takes up to seconds.
const QUICK: [&str; 7] = [
    "simulate --rpm {1} --revolutions 10 --start-angle {angle} {start} --events -",
    "simulate --rpm {1} --revolutions 10 --start-angle {angle} {start} --summary --lyapunov",
    "diagram --rpm {0.8}:{1.25}:3 --transient 20 --record 5 --lyapunov --out -",
    "chart --x rpm={0.8}:{1.25}:2 --y restitution=0.4:0.6:2 --transient 20 --record 10 --out -",
    "basins --rpm {1} --grid 4x4 --revolutions 20 --longest 4 --out -",
    "cam --json",
    "design --rpm {0.8}:{1.25} --speeds 3 --json",
];
const SLOW: [&str; 7] = [
    "orbit --rpm {1} --json",
    "orbit --rpm {1} --revolutions 2 --json",
    // The speeds that these three search or run at are a grid in rpm.
    "locate --rpm {0.99}:{1.01} --json",
    "speeds --rpm {0.95}:{1.05} --speeds 2 --starts 6 --json",
    "continue --from-rpm {1} --parameter rpm={0.95}:{1.05} --step 0.1 --out -",
    "curve --rpm {0.99}:{1.01} --parameter restitution=0.4:0.6 --step 0.1 --out -",
    "verify --no-external --json",
];

/// What a question comes to in other units; none where it takes longer than anyone waits.
fn asked(case: &Case, question: &str, scales: Scales, patience: Duration) -> Option<Output> {
    let folder = tempfile::tempdir().unwrap();
    let model = written(case, scales, folder.path());
    let velocity = factor([1, 0, -1], scales);
    let start = match case.start {
        Start::OnCam(relative) => format!("--relative-velocity {:?}", relative * velocity),
        Start::Above(height, speed) => {
            let position = (case.machine.cam().lift(case.angle).value + height) * factor([1, 0, 0], scales);
            format!("--state {position:?},{:?}", speed * velocity)
        }
    };
    let word = |part: &str| match part {
        "angle" => format!("{:?}", case.angle),
        "start" => start.clone(),
        of => format!("{:?}", of.parse::<f64>().unwrap() * case.rpm * factor([0, 0, -1], scales)),
    };
    let mut pieces = question.split(['{', '}']);
    let mut filled = pieces.next().unwrap().to_owned();
    while let (Some(part), Some(rest)) = (pieces.next(), pieces.next()) {
        filled += &(word(part) + rest);
    }
    let mut words = filled.split_whitespace();
    let mut command = program(words.next());
    command.arg(model).args(words);
    let mut child = command
        .stdout(std::fs::File::create(folder.path().join("out")).unwrap())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let clock = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if clock.elapsed() > patience {
            child.kill().unwrap();
            child.wait().unwrap();
            return None;
        }
        std::thread::sleep(Duration::from_millis(1));
    };
    Some(Output { status, stdout: std::fs::read(folder.path().join("out")).unwrap(), stderr: Vec::new() })
}

/// What an answer is made of: each number and word with the names of where it stands.
fn leaves(answer: &str) -> Vec<(String, Value)> {
    fn walk(place: &str, value: Value, all: &mut Vec<(String, Value)>) {
        match value {
            Value::Object(entries) => {
                entries.into_iter().for_each(|(name, value)| walk(&format!("{place}.{name}"), value, all))
            }
            Value::Array(list) => {
                all.push((format!("{place}#"), list.len().into()));
                list.into_iter().for_each(|value| walk(place, value, all));
            }
            leaf => all.push((place.to_owned(), leaf)),
        }
    }
    let mut all = Vec::new();
    if answer.starts_with('{') {
        walk("", serde_json::from_str(answer).unwrap(), &mut all);
        return all;
    }
    let mut rows = answer.lines().map(|row| row.split(',').collect::<Vec<_>>());
    let names = rows.next().unwrap_or_default();
    for row in rows {
        let cell = |cell: &str| cell.parse::<f64>().map_or_else(|_| cell.into(), Value::from);
        all.extend(names.iter().zip(row).map(|(name, value)| ((*name).to_owned(), cell(value))));
    }
    all
}

/// The unit that a name ends in; none where it tells none.
fn unit(place: &str) -> Option<Scales> {
    let units: [(&str, Scales); 6] =
        [("_m_s", [1, 0, -1]), ("_m", [1, 0, 0]), ("_rad", NONE), ("_deg", NONE), ("rpm", [0, 0, -1]), ("#", NONE)];
    units.into_iter().find(|(end, _)| place.ends_with(end)).map(|(_, unit)| unit)
}

/// Names of what is not the machine's: how long it took, sentences, and what routes are compared by, which are the decimals of the
/// paper's own units.
fn is_left_out(place: &str) -> bool {
    ["wall_s", "reason", "meaning", ".rounded_corner", "source", ".agreement", ".skipped", ".failed"]
        .iter()
        .any(|name| place.contains(name))
}

/// Whether a number is another one times a power of two; where the name tells the unit, times the right one.
fn is_scaled(place: &str, one: f64, other: f64, scales: Scales) -> bool {
    // Below it doubles have fewer digits.
    if one.abs().max(other.abs()) < 1e-290 {
        return true;
    }
    match unit(place) {
        Some(unit) => other == one * factor(unit, scales),
        None => {
            let ratio = other / one;
            one == other || ratio > 0.0 && ratio.log2() == ratio.log2().round()
        }
    }
}

fn differs(one: &str, other: &str, scales: Scales) -> Option<String> {
    let kept = |answer: &str| leaves(answer).into_iter().filter(|(place, _)| !is_left_out(place)).collect::<Vec<_>>();
    let (one, other) = (kept(one), kept(other));
    let pairs = one.iter().zip(&other).find_map(|((place, one), (there, other))| {
        let same = place == there
            && match (one.as_f64(), other.as_f64()) {
                (Some(one), Some(other)) => is_scaled(place, one, other, scales),
                _ => one == other,
            };
        (!same).then(|| format!("{place}: {one} | {there}: {other}"))
    });
    pairs.or_else(|| (one.len() != other.len()).then(|| format!("{} | {} numbers", one.len(), other.len())))
}

/// How many answers were held against the same in other units, and how many took too long, by question.
static TOLD: Mutex<BTreeMap<&str, [u32; 2]>> = Mutex::new(BTreeMap::new());

/// Whether a question comes to the same in other units.
fn alike(case: &Case, question: &'static str, others: &[Scales], patience: Duration) -> Result<(), TestCaseError> {
    let one = asked(case, question, NONE, patience);
    for scales in others.iter().copied() {
        // A speed that is refused is one in no unit.
        if !(1e-9..=1e9).contains(&(case.rpm * factor([0, 0, -1], scales))) {
            continue;
        }
        let other = one.as_ref().and_then(|_| asked(case, question, scales, 4 * patience));
        let (Some(one), Some(other)) = (&one, other) else {
            TOLD.lock().unwrap().entry(question).or_default()[1] += 1;
            continue;
        };
        prop_assert_eq!(one.status.code(), other.status.code(), "{} {:?}", question, scales);
        let [here, there] = [&one.stdout, &other.stdout].map(|bytes| text(bytes.clone()));
        let differs = differs(&here, &there, scales);
        prop_assert!(differs.is_none(), "{question} {scales:?}: {}", differs.unwrap_or_default());
        TOLD.lock().unwrap().entry(question).or_default()[0] += 1;
    }
    Ok(())
}

fn in_any_units(case: &Case, questions: &[&'static str], patience: Duration) -> Result<(), TestCaseError> {
    for question in questions {
        let of_its_own_speeds = ["speeds", "locate", "curve"].iter().any(|command| question.starts_with(command));
        let others = SCALED.map(|[length, mass, time]| [length, mass, if of_its_own_speeds { 0 } else { time }]);
        alike(case, question, &others, patience)?;
    }
    Ok(())
}

#[test]
#[ignore = "slow"]
fn answers_are_the_same_in_any_units() {
    check(4, |case| in_any_units(case, &QUICK, Duration::from_secs(60)));
}

/// Of 200 machines, everything that a question comes to within seconds.
#[test]
#[ignore = "slow"]
fn all_answers_are_the_same_in_any_units() {
    let count = if crate::common::is_whole() { 200 } else { 1 };
    check(count, |case| {
        in_any_units(case, &QUICK, Duration::from_secs(10))?;
        in_any_units(case, &SLOW, Duration::from_secs(10))
    });
    for (question, [told, late]) in TOLD.lock().unwrap().iter() {
        println!("{told} alike, {late} too slow: {question}");
    }
}

/// The same machine, of which nothing but a damper, if it has one, gives a scale of time.
fn without_forces(case: &Case) -> Case {
    let line = |line: &str| match line.split_once(" = ") {
        Some((name @ ("stiffness" | "gravity"), _)) => format!("{name} = 0.0\n"),
        _ => format!("{line}\n"),
    };
    Case { text: case.text.lines().map(line).collect(), ..case.clone() }
}

#[test]
#[ignore = "slow"]
fn what_nothing_moves_but_the_cam_ends_the_same_in_any_units() {
    check(6, |case| {
        let case = without_forces(case);
        for command in ["chart", "basins"] {
            let question = QUICK.into_iter().find(|question| question.starts_with(command)).unwrap();
            alike(&case, question, &[[0, 0, -20], [0, 0, 10], [0, 0, 19]], Duration::from_secs(60))?;
        }
        Ok(())
    });
}
