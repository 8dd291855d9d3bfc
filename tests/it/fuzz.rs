//! Does anything get through? Flights with planted near-grazes, corners and rounding, against sixty digits; texts of models; command lines.
//!
//! The cases are the same in every run; `make fuzz` looks at others for ten minutes. What once failed, or is worth a look each
//! time, is in tests/it/corpus.

use std::f64::consts::TAU;
use std::io::{BufRead, BufReader, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::process::{Child, ChildStdout, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{LazyLock, Mutex};

use corner_impact::cam::Cam;
use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::simulate::{Event, EventKind, Motion};
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;

use crate::common;
use crate::properties::{Leg, first_contacts_from, goal, legs};
use crate::random::{Case, cases_of_every_law, cases_of_few_laws, cases_of_many_segments, check_all, drawn};

/// What a flight is aimed at.
#[derive(Clone, Copy, Debug)]
enum Aim {
    /// Touches the cam but for this share of the stroke, from above or below it.
    Graze(f64),
    /// Hits the cam so many ulps of the angle from where a segment starts.
    Corner(i32),
    /// Starts so many ulps of the position above the cam.
    Above(u32),
}

/// A machine, a flight to plant, and five numbers from 0 to 1 that decide where and how.
type Planted = (Case, Aim, [f64; 5]);

fn planted(cases: impl Strategy<Value = Case>) -> impl Strategy<Value = Planted> {
    let aim = prop_oneof![
        4 => (10.0..14.0_f64, any::<bool>())
            .prop_map(|(digits, below)| Aim::Graze(if below { -1.0 } else { 1.0 } * 10.0_f64.powf(-digits))),
        2 => (-4..=4).prop_map(Aim::Corner),
        2 => (0..8_u32).prop_map(Aim::Above),
    ];
    (cases, aim, prop::array::uniform5(0.0..1.0_f64))
}

fn ulps(mut number: f64, count: i32) -> f64 {
    for _ in 0..count.abs() {
        number = if count > 0 { number.next_up() } else { number.next_down() };
    }
    number
}

/// The start of the planted flight; none where this machine has no such flight.
fn start(case: &Case, aim: Aim, [place, speed, back, ..]: [f64; 5]) -> Option<Motion> {
    let machine = &case.machine;
    let (cam, omega) = (machine.cam(), machine.angular_velocity());
    let corner = cam.segments()[(place * cam.segments().len() as f64) as usize].start;
    let slow = (2.0 * speed - 1.0) * case.velocity() * 10.0_f64.powf(-14.0 * back);
    let (angle, end) = match aim {
        Aim::Above(count) => {
            let angle = if back < 0.5 { corner } else { place * TAU };
            let lift = cam.lift(angle);
            let velocity = omega * lift.slope + slow;
            return machine.start(angle, State { position: ulps(lift.value, count as i32), velocity }).ok();
        }
        Aim::Corner(count) => {
            let angle = ulps(corner, count).rem_euclid(TAU);
            let lift = cam.lift(angle);
            let velocity = omega * lift.slope - speed * case.velocity();
            (angle, State { position: lift.value, velocity })
        }
        // Where the flight bends away from the cam.
        Aim::Graze(share) => (0..40).find_map(|index| {
            let angle = (place + f64::from(index) * 0.618_033_988_749_894_9).fract() * TAU;
            let lift = cam.lift(angle);
            let end = State { position: lift.value + share * case.stroke, velocity: omega * lift.slope };
            (machine.flight().acceleration(end) > omega * omega * lift.curvature).then_some((angle, end))
        })?,
    };
    // As far back as the follower is above the cam all the way, seen from here.
    let period = TAU / omega.max(machine.flight().omega0_squared().sqrt());
    (1..40).find_map(|halves| {
        let time = (0.1 + back) * period * 0.7_f64.powi(halves);
        let begin = (angle - omega * time).rem_euclid(TAU);
        let state = machine.flight().fly(end, -time).1;
        let above = state.position - cam.lift(begin).value;
        (above > 1e-6 * case.stroke && begin < TAU).then(|| machine.start(begin, state).ok())?
    })
}

/// The judge of flights, one for all.
struct Judge {
    child: Child,
    said: BufReader<ChildStdout>,
}

static JUDGE: LazyLock<Mutex<Judge>> = LazyLock::new(|| {
    let python = Path::new(common::ROOT).join(".venv/bin/python");
    let mut command = Command::new(python);
    command.args(["-c", include_str!("first_contact.py")]).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let said = BufReader::new(child.stdout.take().unwrap());
    Mutex::new(Judge { child, said })
});

fn judged(line: &serde_json::Value) -> String {
    let mut judge = JUDGE.lock().unwrap();
    writeln!(judge.child.stdin.as_mut().unwrap(), "{line}").unwrap();
    let mut said = String::new();
    judge.said.read_line(&mut said).unwrap();
    said
}

/// Above the cam up to where they meet it, as a scan finds, by the rounding of doubles: on cams of many segments too.
#[test]
#[ignore = "slow"]
fn planted_flights_come_down_first_where_a_scan_says() {
    let holds = |(case, aim, units): &Planted| match start(case, *aim, *units) {
        // Where damping has stopped a follower from very far off, what it has lost on the way is rounded too.
        Some(motion) if motion.state.velocity.abs() < 10.0 * case.velocity() => {
            first_contacts_from(case, motion, 0.5, 2)
        }
        _ => Ok(()),
    };
    check_all(planted(cases_of_few_laws()), 400, holds);
    check_all(planted(cases_of_many_segments()), 200, holds);
}

/// A flight that ends below the cam has met it on the way, however shallow, and over however many segments it leaps.
#[test]
fn what_ends_below_the_cam_has_met_it() {
    let mut flights = 0_u32;
    for case in drawn(cases_of_many_segments(), 80) {
        let (machine, omega) = (&case.machine, case.machine.angular_velocity());
        for index in 0..60 {
            let part = |root: f64| (f64::from(index + 1) * root.sqrt()).fract();
            let angle = TAU * part(2.0);
            let lift = machine.cam().lift(angle);
            let depth = case.stroke * 10.0_f64.powf(-3.0 - 8.0 * part(3.0));
            let end = State { position: lift.value - depth, velocity: omega * lift.slope };
            // Where it bends away from the cam it comes from above.
            let turn = 3.0 * part(5.0).powi(2);
            let state = machine.flight().fly(end, -turn / omega).1;
            let begin = (angle - turn).rem_euclid(TAU);
            let is_far = state.velocity.abs() > 10.0 * case.velocity();
            if machine.flight().acceleration(end) <= omega * omega * lift.curvature || begin >= TAU || is_far {
                continue;
            }
            let Ok(mut motion) = machine.start(begin, state) else { continue };
            let goal = goal(&motion, turn + 1.0);
            let mut first = None;
            let done = machine.advance(&mut motion, goal, &mut |event: &Event| {
                first = Some(event.turned_since(begin));
                ControlFlow::Break(())
            });
            flights += 1;
            let is_met = done.is_ok() && first.is_some_and(|first| first <= turn + 1e-12);
            assert!(is_met, "{depth} m below the cam at {angle}, {turn} rad on, and {first:?}: {case:?}");
        }
    }
    assert!(flights > 500, "{flights}");
}

static FLIGHTS: AtomicU32 = AtomicU32::new(0);
static UNDECIDED: AtomicU32 = AtomicU32::new(0);

/// Each of a run's first flights is what sixty digits make of it, to the rounding of a few sums of doubles.
fn is_what_sixty_digits_say((case, aim, units): &Planted) -> TestCaseResult {
    let Some(motion) = start(case, *aim, *units) else { return Ok(()) };
    let (machine, omega) = (&case.machine, case.machine.angular_velocity());
    // How a run may end early is asked elsewhere.
    let Ok(legs) = legs(case, motion, 1.0) else { return Ok(()) };
    let model = case.model.text();
    // Of hundreds of swings the last would be asked of what rounding has made of the others.
    let rate = machine.flight().omega0_squared().sqrt() + 2.0 * machine.flight().zeta();
    let short = legs.into_iter().filter(|leg| leg.time * rate < 60.0);
    for Leg { angle, start, turned, time, event } in short.take(4) {
        let event = event.filter(|event| event.kind == EventKind::Impact);
        let (flight, cam) = (machine.flight(), machine.cam());
        let steepest = cam
            .segments()
            .iter()
            .flat_map(|segment| segment.bounds.slope)
            .fold(0.0, |most: f64, slope| most.max(slope.abs()));
        let end = flight.fly(start, time).1;
        let force = flight.force(start.position).abs();
        let fastest = start.velocity.abs().max(end.velocity.abs()) + force * time.min(1.0 / rate);
        let highest = cam.top().abs() + case.stroke + start.position.abs().max(end.position.abs());
        // Rounded: positions, the angle that the lift is taken at, the time of flight, and the angles that tell it here.
        let room = 4.0 * f64::EPSILON * (highest + TAU * steepest + fastest * time);
        let early = 4.0 * f64::EPSILON * (turned + omega * time + TAU) / omega;
        let hardest = force + rate * fastest;
        let blur = 8.0 * f64::EPSILON * (fastest + hardest * time) + early * hardest;
        let line = serde_json::json!({
            "model": model, "omega": omega, "angle": angle, "position": start.position, "velocity": start.velocity, "time": time,
            "hit": event.map(|event| (event.velocity_before, blur)), "room": room, "early": early,
        });
        let said = judged(&line);
        let said = said.trim();
        FLIGHTS.fetch_add(u32::from(said == "right"), Ordering::Relaxed);
        UNDECIDED.fetch_add(u32::from(said == "undecided"), Ordering::Relaxed);
        prop_assert!(["right", "no reference", "undecided"].contains(&said), "{said} {line}");
    }
    Ok(())
}

#[test]
#[ignore = "slow"]
fn flights_are_what_sixty_digits_say() {
    check_all(planted(cases_of_few_laws()), 150, is_what_sixty_digits_say);
    let flights = FLIGHTS.load(Ordering::Relaxed);
    let undecided = UNDECIDED.load(Ordering::Relaxed);
    println!("{flights} flights are right, {undecided} undecided");
    assert!(flights > 100 && undecided < flights / 50, "{flights}, {undecided}");
}

/// Numbers, and what is none, to put in the place of a number.
const ODD: [&str; 20] = [
    "0",
    "-0.0",
    "-1",
    "1e-300",
    "5e-324",
    "1e300",
    "1.7976931348623157e308",
    "1e999",
    "nan",
    "inf",
    "0x10",
    "1_000",
    "1e",
    "",
    "true",
    "\"x\"",
    "[1, 2]",
    "{ a = 1 }",
    "\u{202e}",
    "1e-9",
];

/// What somebody does to a text: where, and what.
type Edit = (f64, usize, usize);

fn edited(text: &str, edits: &[Edit]) -> String {
    let mut text = text.to_owned();
    for (place, what, odd) in edits {
        let mut lines: Vec<String> = text.lines().map(String::from).collect();
        let at = (place * lines.len() as f64) as usize;
        let Some(line) = lines.get_mut(at) else { continue };
        match what {
            0 => drop(lines.remove(at)),
            1 => lines.insert(at, lines[at].clone()),
            2 => *line = line.replace("_deg", ""),
            3 => line.push_str(ODD[*odd]),
            4 => *line = line.chars().rev().collect(),
            // Names stay.
            _ => {
                *line = line.split_once('=').map_or(ODD[*odd].to_owned(), |(name, _)| format!("{name}= {}", ODD[*odd]))
            }
        }
        text = lines.join("\n");
    }
    text
}

/// Whatever a text says, it is refused with a sentence, or it is a model whose text is the same model's.
fn is_refused_or_itself(text: &str) -> TestCaseResult {
    let model = match Model::parse("a text", text) {
        Ok(model) => model,
        Err(error) => {
            let said = error.to_string();
            prop_assert!((10..2500).contains(&said.len()), "{said}");
            return Ok(());
        }
    };
    let again = model.text();
    let same = Model::parse("a text", &again).map_err(|error| TestCaseError::fail(format!("{error}\n{again}")))?;
    prop_assert_eq!(same.text(), again);
    prop_assert_eq!(same.follower, model.follower);
    prop_assert_eq!(format!("{:?}", Cam::new(&same).ok()), format!("{:?}", Cam::new(&model).ok()));
    Ok(())
}

#[test]
fn a_text_is_refused_or_a_model_whose_text_is_its_own() {
    let edits = prop::collection::vec((0.0..1.0_f64, 0..9_usize, 0..ODD.len()), 0..4);
    check_all((cases_of_every_law(), edits), 400, |(case, edits)| {
        is_refused_or_itself(&edited(&case.model.text(), edits))
    });
    let corpus = Path::new(common::ROOT).join("tests/it/corpus");
    let texts = std::fs::read_dir(corpus).unwrap().map(|entry| entry.unwrap().path());
    for path in texts.filter(|path| path.extension().is_some_and(|end| end == "toml")) {
        is_refused_or_itself(&std::fs::read_to_string(path).unwrap()).unwrap();
    }
}

/// A folder that commands run in, with a model.
static FOLDER: LazyLock<tempfile::TempDir> = LazyLock::new(|| {
    let folder = tempfile::TempDir::new().unwrap();
    std::fs::write(folder.path().join("m.toml"), common::osorio_text(&[])).unwrap();
    folder
});

/// The commands, each with its options.
static COMMANDS: LazyLock<Vec<(String, Vec<String>)>> = LazyLock::new(|| {
    let help = |words: &[&str]| common::text(common::corner_impact(words).stdout);
    let first = |line: &str| line.split([' ', '<']).find(|word| !word.is_empty()).unwrap_or("").to_owned();
    let main = help(&["--help"]);
    let commands = main.lines().filter(|line| line.starts_with("  ") && line[2..].starts_with(char::is_lowercase));
    let commands = commands.map(first).filter(|word| word != "corner-impact");
    let options =
        |command: &str| help(&[command, "--help"]).lines().map(first).filter(|word| word.starts_with("--")).collect();
    commands.map(|command| (command.clone(), options(&command))).collect()
});

const WORDS: [&str; 24] = [
    "m.toml",
    "none.toml",
    "-",
    "673",
    "670:680",
    "680:670",
    "670:680:3",
    "rpm=670:680",
    "mass=1:2:2",
    "mass=2",
    "x=1",
    "0",
    "-1",
    "1e308",
    "nan",
    "x.svg",
    "x.csv",
    "x.png",
    "/dev/full",
    "",
    "--",
    "\u{1b}[31m",
    "99999999999999999999",
    "0.5,1e200",
];

/// A command line ends with one of three codes; what is refused is refused with a sentence, and nothing panics.
fn ends_with_a_word(words: &[String]) -> TestCaseResult {
    let mut command = common::program(words);
    command.current_dir(FOLDER.path()).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let errors = child.stderr.take().unwrap();
    let reader = std::thread::spawn(move || std::io::read_to_string(errors).unwrap_or_default());
    // Many a command line is a long piece of work: how that goes on is not looked at.
    let begun = std::time::Instant::now();
    let status = loop {
        match child.try_wait().unwrap() {
            Some(status) => break status,
            None if begun.elapsed().as_secs_f64() > 0.5 => {
                child.kill().unwrap();
                child.wait().unwrap();
                return Ok(());
            }
            None => std::thread::sleep(std::time::Duration::from_millis(2)),
        }
    };
    let said = reader.join().unwrap();
    prop_assert!(matches!(status.code(), Some(0..=2)), "{words:?}: {status} {said}");
    prop_assert!(!said.contains("panicked"), "{words:?}: {said}");
    prop_assert!(status.code() != Some(2) || said.contains("error: "), "{words:?}: {said}");
    Ok(())
}

fn command_lines() -> impl Strategy<Value = Vec<String>> {
    let words = prop::collection::vec((0.0..1.0_f64, 0..WORDS.len(), any::<bool>()), 0..4);
    (0.0..1.0_f64, any::<bool>(), words).prop_map(|(command, with_model, words)| {
        let (command, options) = &COMMANDS[(command * COMMANDS.len() as f64) as usize];
        let mut line = vec![command.clone()];
        line.extend(with_model.then(|| "m.toml".to_owned()));
        for (option, word, is_one_word) in words {
            let option = options.get((option * options.len() as f64) as usize).cloned().unwrap_or_default();
            match is_one_word {
                true => line.push(format!("{option}={}", WORDS[word])),
                false => line.extend([option, WORDS[word].to_owned()]),
            }
        }
        line
    })
}

#[test]
#[ignore = "slow"]
fn a_command_line_ends_with_a_word() {
    assert!(COMMANDS.len() > 18 && COMMANDS.iter().all(|(_, options)| !options.is_empty()), "{:?}", *COMMANDS);
    for line in include_str!("corpus/commands.txt").lines() {
        ends_with_a_word(&line.split(' ').map(String::from).collect::<Vec<_>>()).unwrap();
    }
    check_all(command_lines(), 200, |line| ends_with_a_word(line));
}
