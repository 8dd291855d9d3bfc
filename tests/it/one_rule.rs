//! One question has one answer: what a machine does from a start at a speed is the same word, and the same growth, whoever is asked.

use std::f64::consts::TAU;

use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::orbit::Parameter;
use corner_impact::orbit::long_run::{Budget, Kind, LongRun};
use corner_impact::progress::Unwatched;
use corner_impact::simulate::angular_velocity;
use corner_impact::study::StudyError;
use corner_impact::study::attractors::{Cause, Resolution, Step};
use corner_impact::study::basins::{SectionStarts, States};
use corner_impact::study::chart::Chart;
use corner_impact::study::design::loads::Loads;
use corner_impact::study::diagram::one_row;
use corner_impact::study::simulate::{RunRequest, Simulation, Until};
use corner_impact::study::survey::{Axis, Placed, Sample, Spacing, Start, Survey, Values, growth, long_run};
use serde_json::Value;

use crate::common::{self, corner_impact, text};
use crate::orbit_numbers::{machine, model};

/// A model, a speed, rpm, and a start at angle 0.
type Case = (&'static str, f64, State);

/// Short enough for a test, and long enough for each word to come up.
const BUDGET: Budget = Budget { transient: 60, record: 64, longest: 8, patience: 400 };

fn cases() -> Vec<Case> {
    let paper = [
        100.0, 116.0, 183.0, 300.0, 380.0, 420.0, 640.0, 655.0, 660.0, 662.0, 663.0, 664.0, 666.0, 668.0, 670.0, 672.0,
        676.0, 678.0, 700.0, 737.0, 745.0, 760.0,
    ];
    let four = [
        ("damped-heavy", [500.0, 600.0, 700.0, 800.0]),
        ("damped-light", [450.0, 600.0, 640.0, 760.0]),
        ("ballistic", [332.0, 450.0, 600.0, 700.0]),
        ("preloaded", [503.6, 560.0, 650.0, 750.0]),
        ("sharp-nose", [290.0, 305.0, 330.0, 400.0]),
        ("laws/harmonic", [300.0, 500.0, 700.0, 900.0]),
        ("laws/polynomial", [330.0, 421.0, 443.5, 600.0]),
        ("laws/program", [666.0, 1500.0, 2400.0, 2915.0]),
    ];
    let mut cases: Vec<Case> =
        paper.map(|rpm| ("osorio-2008", rpm, State { position: 0.8, velocity: 0.0 })).into_iter().collect();
    for (name, rpm) in four.into_iter().flat_map(|(name, speeds)| speeds.map(|rpm| (name, rpm))) {
        let machine = machine(&model(name), rpm);
        let (top, size) = (machine.cam().top(), machine.cam().top() - machine.cam().lowest().value);
        let fast = size * angular_velocity(rpm);
        let starts = [(0.2, 0.0), (0.05, 0.5), (1.0, -0.3)];
        let at = |(above, speed): (f64, f64)| State { position: top + above * size, velocity: speed * fast };
        cases.extend(starts.map(|start| (name, rpm, at(start))));
    }
    cases
}

/// A word, and the growth a revolution with its error, to the last bit.
type Told = (Kind, u64, u64);

fn told(ending: &LongRun) -> Told {
    (ending.kind(), ending.growth().value.to_bits(), ending.growth().error.to_bits())
}

/// What each command of the library says, by its name.
fn answers((name, rpm, state): Case, surveyed: bool) -> Vec<(&'static str, Told)> {
    let model: Model = model(name);
    let start = Start { cam_angle: 0.0, follower: Placed::At(state) };
    let machine = machine(&model, rpm);
    let motion = start.motion(&machine).unwrap();
    let alone = long_run(&machine, motion, BUDGET).unwrap().ending;
    let values = Values::linear(rpm, rpm, 1);
    let mass = Parameter::named(&model, "mass").unwrap();
    let fixed = Values::linear(model.follower.mass, model.follower.mass, 1);
    let speed = Axis::new(Parameter::Speed, &values);
    let axes = [speed.clone(), Axis::new(mass, &fixed)];
    let chart = Chart::new(&model, None, axes, start, BUDGET).unwrap().run(Some(1), &Unwatched).unwrap();
    let over = Survey::new(&model, None, speed, None).unwrap();
    let row = one_row(&over, start, BUDGET, Some(1), &Unwatched).unwrap();
    let [point, row] = [&chart.points[0], &row[0]]
        .map(|it| it.as_ref().map(|it| (it.kind, it.growth.value.to_bits(), it.growth.error.to_bits())));
    let states = SectionStarts::Given(States { cam_angle: 0.0, states: vec![state] });
    let basins = states.basins(&machine, BUDGET, Some(1), &Unwatched).unwrap();
    let loads = Loads::among(&model, &machine, Some(&[start]), BUDGET).unwrap().1;
    let wanted =
        RunRequest { until: Until::Revolutions(1), events: false, strobe: None, drawn: 0, long_run: Some(BUDGET) };
    let run = Simulation::new(&model, rpm, start).unwrap().run::<StudyError>(wanted, &Unwatched, |_| Ok(())).unwrap();
    let grown = growth(&machine, motion, BUDGET).unwrap();
    let mut all = vec![
        ("long_run", told(&alone)),
        ("chart", point.unwrap()),
        ("diagram --one-row", row.unwrap()),
        ("basins", told(&basins.parts[0].ending)),
        ("design", told(&loads[0].ending)),
        ("simulate", told(&run.long_run.unwrap().ending)),
        ("diagram --lyapunov", (alone.kind(), grown.value.to_bits(), grown.error.to_bits())),
    ];
    if surveyed {
        let step = common::step(1e-3);
        let sample = Sample::Given(vec![start]);
        let resolution = Resolution { step, sample, budget: BUDGET, two_impacts: false };
        let found = common::speeds(&model, [rpm, rpm + 1e-3], &resolution, &Unwatched).unwrap();
        let mut here = found.attractors.iter().flat_map(|it| &it.at).filter(|at| at.value() == rpm);
        let at = here.next().unwrap_or_else(|| panic!("{name} {rpm}: nothing, {:?}", found.failed));
        assert!(here.next().is_none() && at.share.value == 1.0, "{name} {rpm}");
        all.push(("speeds", told(&at.ending)));
    }
    all
}

#[test]
fn every_command_says_the_same_word_and_the_same_growth() {
    let cases = cases();
    assert!(cases.len() >= 100, "{}", cases.len());
    let mut words = Vec::new();
    for (index, case) in cases.into_iter().enumerate() {
        let all = answers(case, index % 6 == 0);
        let first = all[0].1;
        for (command, told) in &all {
            assert_eq!(*told, first, "{command} of {case:?}");
        }
        words.push(first.0);
    }
    for kind in [Kind::Stays, Kind::Periodic, Kind::Resting, Kind::Chaotic] {
        assert!(words.contains(&kind), "{kind} comes up nowhere: {words:?}");
    }
}

/// The same through the command line, where each has the options of the budget and of the start.
#[test]
fn the_commands_say_it_too() {
    let budget = ["--transient", "60", "--record", "64", "--longest", "8", "--patience", "400", "--state", "0.8,0"];
    let answered = |arguments: &[&str]| {
        let output = corner_impact([arguments, &budget].concat());
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(output.stderr));
        text(output.stdout)
    };
    let document = |arguments: &[&str]| serde_json::from_str::<Value>(&answered(arguments)).unwrap();
    let word = |it: &Value, name: &str| {
        (it[name].as_str().unwrap().to_owned(), it["growth"].as_f64(), it["followed"].as_u64())
    };
    for rpm in [183.0, 664.0, 670.0, 700.0] {
        let state = State { position: 0.8, velocity: 0.0 };
        let machine = machine(&common::osorio(), rpm);
        let part = long_run(&machine, machine.start(0.0, state).unwrap(), BUDGET).unwrap();
        let growth = Some(part.ending.growth().value).filter(|growth| growth.is_finite());
        let expected = (part.ending.kind().to_string(), growth, Some(part.followed));
        let at = rpm.to_string();
        let model = "models/osorio-2008.toml";
        let basins = document(&["basins", model, "--rpm", &at, "--summary"]);
        assert_eq!(word(&basins["endings"][0], "ending"), expected, "basins at {rpm}");
        let design = document(&["design", model, "--rpm", &at, "--json"]);
        assert_eq!(word(&design["attractors"][0]["endings"][0], "ending"), expected, "design at {rpm}");
        let run = document(&["simulate", model, "--rpm", &at, "--lyapunov", "--summary"]);
        let run = (
            run["kind"].as_str().unwrap().to_owned(),
            run["lyapunov_per_revolution"].as_f64(),
            run["followed"].as_u64(),
        );
        assert_eq!(run, expected, "simulate at {rpm}");
        let range = format!("{at}:{at}:1");
        let surveyed = document(&["speeds", model, "--rpm", &format!("{at}:{}", rpm + 1.0), "--step", "1", "--json"]);
        let all = surveyed["attractors"].as_array().unwrap();
        let mut here = all.iter().flat_map(|it| it["shares"].as_array().unwrap()).filter(|it| it["speed_rpm"] == rpm);
        assert_eq!(word(here.next().unwrap(), "kind"), expected, "speeds at {rpm}");
        for (arguments, column) in [
            (vec!["chart", model, "--x", &format!("rpm={range}"), "--y", "restitution=0.8:0.8:1", "--out", "-"], 2),
            (vec!["diagram", model, "--rpm", &range, "--one-row", "--out", "-"], 1),
        ] {
            let table = answered(&arguments);
            let cells: Vec<&str> = table.lines().nth(1).unwrap().split(',').collect();
            let growth = cells[column + 3].parse::<f64>().ok().filter(|growth| growth.is_finite());
            let followed = cells.last().unwrap().parse().ok();
            assert_eq!((cells[column].to_owned(), growth, followed), expected, "{} at {rpm}", arguments[0]);
        }
    }
}

/// What the paper's machine is said to do at these speeds with the budget of `speeds` rests now and then; with that of `chart`, chaos is said
/// with the revolutions in which it did not.
#[test]
fn a_longer_budget_turns_chaos_into_rests() {
    for rpm in [640.0, 655.0, 662.0, 664.0, 666.0, 669.0] {
        let machine = machine(&common::osorio(), rpm);
        let motion = machine.start_on_cam(0.0, 0.0).unwrap();
        let [short, long] = [Budget::CHART, Budget::SURVEY].map(|budget| long_run(&machine, motion, budget).unwrap());
        assert!(matches!(short.ending, LongRun::Chaotic(_)) && short.followed < 2000, "{rpm}: {short:?}");
        assert!(long.ending.is_long() && long.followed > short.followed, "{rpm}: {long:?}");
    }
    let page = text(corner_impact(["basins", "--rpm", "670", "--state", "0.8,0"]).stdout);
    assert!(page.contains("chaotic (no rest in 10") && page.contains(" revolutions)"), "{page}");
    let page = text(corner_impact(["basins", "--rpm", "666", "--state", "0.8,0"]).stdout);
    assert!(page.contains("rests now and then (transient chaos: once in"), "{page}");
}

/// A deviation of a motion without loss grows as the number of revolutions does: that is no chaos, however well the growth is measured.
#[test]
fn growth_that_is_not_exponential_is_not_chaos() {
    // A plate that stands still under a ball without loss: each impact is one period later, by the speed.
    let plate = "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 0.0\ngravity = 9.81\nrest_position = 0.0\nrestitution = 1.0\n\
                 [cam]\nlaw = \"harmonic\"\noffset = 0.0\namplitudes = [0.0]\nphases_deg = [0.0]\n";
    let plate = Model::parse("plate.toml", plate).unwrap();
    let machine = machine(&plate, 60.0);
    for velocity in [4.9, 1.3, 0.77] {
        let motion = machine.start_on_cam(0.0, velocity).unwrap();
        for budget in [Budget::CHART, Budget { record: 1000, ..Budget::CHART }] {
            let found = long_run(&machine, motion, budget).unwrap();
            assert!(matches!(found.ending, LongRun::Undecided(_)), "{velocity} m/s, {budget:?}: {found:?}");
        }
    }
    // Chaos of a ball on a plate that shakes.
    let shaken = "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 0.0\ngravity = 9.81\nrest_position = 0.0\nrestitution = 0.8\n\
                  [cam]\nlaw = \"harmonic\"\noffset = 0.0\namplitudes = [0.001]\nphases_deg = [0.0]\n";
    let shaken = Model::parse("shaken.toml", shaken).unwrap();
    let machine = self::machine(&shaken, 3000.0);
    let found = long_run(&machine, machine.start_on_cam(0.5 * TAU, 0.3).unwrap(), Budget::CHART).unwrap();
    assert!(matches!(found.ending, LongRun::Chaotic(_)), "{found:?}");
}

/// A sentence each.
#[test]
fn starts_and_budgets_that_cannot_be_are_told() {
    let refused = |arguments: &[&str]| {
        let output = corner_impact(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        text(output.stderr)
    };
    let below = "below the cam";
    for arguments in [
        vec!["speeds", "--rpm", "700:701", "--step", "1", "--state", "0.1,0"],
        vec!["basins", "--rpm", "700", "--state", "0.1,0"],
        vec!["design", "--rpm", "700", "--state", "0.1,0"],
        vec!["simulate", "--rpm", "700", "--state", "0.1,0"],
    ] {
        let words = common::in_one_line(&refused(&arguments));
        assert!(words.contains(below), "{arguments:?}: {words}");
    }
    for command in [
        vec!["speeds", "--rpm", "700:701"],
        vec!["basins", "--rpm", "700", "--state", "0.8,0"],
        vec!["design", "--rpm", "700"],
        vec!["simulate", "--rpm", "700", "--lyapunov"],
        vec!["chart", "--x", "rpm=700:701:2", "--y", "mass=1:2:2"],
        vec!["diagram", "--rpm", "700:701:2", "--one-row", "--out", "-"],
    ] {
        let words = refused(&[&command[..], &["--record", "0"]].concat());
        assert!(words.contains("--record 0: in no revolution nothing grows"), "{command:?}: {words}");
        let words = refused(&[&command[..], &["--longest", "0"]].concat());
        assert!(words.contains("--longest"), "{command:?}: {words}");
    }
    let words =
        refused(&["chart", "--x", "rpm=700:701:2", "--y", "mass=1:2:2", "--state", "0.8,0", "--state", "0.9,0"]);
    assert!(words.contains("--state is given 2 times, but one run has one start"), "{words}");
    let words = refused(&["basins", "--rpm", "700", "--state", "0.8,0", "--out", "x.svg"]);
    assert!(words.contains("--grid NxM"), "{words}");
}

/// Every start ends on something that is listed: at each speed the shares are all of it, off the cam for good included.
#[test]
#[ignore = "slow"]
fn shares_of_a_speed_are_all_of_it() {
    let folder =
        |path: &str| std::fs::read_dir(format!("{}/{path}", common::ROOT)).unwrap().map(|entry| entry.unwrap().path());
    let models =
        folder("models").chain(folder("models/laws")).filter(|path| path.extension().is_some_and(|it| it == "toml"));
    let mut speeds_seen = 0;
    for path in models {
        let model = Model::read(&path).unwrap();
        let [low, high] = corner_impact::study::speeds::usual_range(&model).unwrap();
        let from = low + 0.7 * (high - low);
        let range = [from, 1.01 * from];
        let budget = Budget { patience: 5_000, ..Budget::SURVEY };
        let resolution = Resolution { budget, ..Resolution::new(Step::for_values(range, 2, Spacing::Linear), 12) };
        let found = common::speeds(&model, range, &resolution, &Unwatched).unwrap();
        let shares = all_of_each_speed(&found);
        assert!(!shares.is_empty(), "{}", model.name);
        speeds_seen += shares.len();
    }
    assert!(speeds_seen > 30, "{speeds_seen}");
}

/// The sum of shares at each speed, which must be 1.
fn all_of_each_speed(found: &corner_impact::study::speeds::SpeedSurvey) -> Vec<f64> {
    let mut all: std::collections::BTreeMap<u64, f64> = std::collections::BTreeMap::new();
    for at in found.attractors.iter().flat_map(|it| &it.at) {
        *all.entry(at.value().to_bits()).or_default() += at.share.value;
    }
    for (rpm, sum) in &all {
        assert!((sum - 1.0).abs() < 1e-12, "{} at {} rpm: {sum}", found.model, f64::from_bits(*rpm));
    }
    all.into_values().collect()
}

/// A ball on a plate with `lobes` equal lobes.
fn lobes(lobes: usize) -> Model {
    let amplitudes = vec!["0.0"; lobes - 1].join(", ") + if lobes > 1 { ", " } else { "" } + "0.01";
    let phases = vec!["0.0"; lobes].join(", ");
    let text = format!(
        "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 0.0\ngravity = 9.81\nrest_position = 0.0\nrestitution = 0.5\n\
         [cam]\nlaw = \"harmonic\"\noffset = 0.0\namplitudes = [{amplitudes}]\nphases_deg = [{phases}]\n"
    );
    Model::parse("lobes.toml", &text).unwrap()
}

/// Two orbits branch off from one that does the same over each of two lobes where the orbit over one lobe doubles its period, at twice the
/// speed: located by its own equations from any step, and no row has no width.
#[test]
#[ignore = "slow"]
fn a_symmetry_breaks_at_half_of_the_speed_of_the_flip_over_one_lobe() {
    let flip = 369.573_082_351_769_7;
    for (step, starts) in [(0.5, 16), (1.0, 8)] {
        let found = common::speeds(&lobes(2), [184.0, 186.0], &Resolution::new(common::step(step), starts), &Unwatched)
            .unwrap();
        let broken = found.attractors.iter().flat_map(|it| [&it.birth, &it.death].into_iter().flatten());
        let broken: Vec<_> =
            broken.filter(|change| change.cause == Cause::SymmetryBreaking && change.value() > 184.5).collect();
        // The symmetric orbit ends, and both others begin.
        assert_eq!(broken.len(), 3, "{step}: {broken:?}");
        for change in broken {
            assert!((change.value() / (0.5 * flip) - 1.0).abs() < 1e-12 && change.is_located(), "{change:?}");
        }
        assert!(found.attractors.iter().all(|it| it.range()[1] - it.range()[0] > 1e-9), "{step}");
        all_of_each_speed(&found);
    }
    // The same of the cam with one lobe is a flip.
    let found = common::speeds(&lobes(1), [368.0, 372.0], &Resolution::new(common::step(2.0), 4), &Unwatched).unwrap();
    let ends = found.attractors.iter().filter_map(|it| it.death.as_ref());
    let flips: Vec<_> =
        ends.filter(|change| change.cause == Cause::Flip && (change.value() / flip - 1.0).abs() < 1e-9).collect();
    assert_eq!(flips.len(), 1, "{:?}", found.attractors);
}

/// Over k equal lobes a follower does at n/k rpm what it does over one at n: each motion of so many impacts a lobe has the same share of the starts,
/// all its copies together, and begins and ends at the same speeds, n/k. A flip over one lobe is a symmetry that breaks over two.
#[test]
#[ignore = "slow"]
fn equal_lobes_have_the_answers_of_one() {
    let survey = |count: usize, step: f64| {
        let range = [354.0, 372.0].map(|rpm| rpm / count as f64);
        common::speeds(&lobes(count), range, &Resolution::new(common::step(step), 48), &Unwatched).unwrap()
    };
    let one = survey(1, 3.0);
    type Shares = std::collections::BTreeMap<(Kind, u64), [f64; 2]>;
    // Impacts of a lobe in thousandths; of what does not repeat none.
    let shares = |found: &corner_impact::study::speeds::SpeedSurvey, count: usize, rpm: f64| {
        let mut shares = Shares::new();
        for at in found.attractors.iter().flat_map(|row| &row.at).filter(|at| at.value() == rpm / count as f64) {
            let orbit = at.ending.period().filter(|_| at.ending.kind() == Kind::Periodic);
            let each = orbit.map_or(0, |(turns, impacts)| 1000 * impacts / (turns * count as u64));
            let [share, square] = shares.entry((at.ending.kind(), each)).or_default();
            (*share, *square) = (*share + at.share.value, *square + at.share.error.powi(2));
        }
        shares
    };
    for (count, step) in [(2, 3.0), (3, 2.0)] {
        let several = survey(count, step);
        for rpm in [354.0, 360.0, 366.0, 372.0] {
            let [one, several] = [shares(&one, 1, rpm), shares(&several, count, rpm)];
            assert!(!one.is_empty() && one.keys().eq(several.keys()), "{count} at {rpm}: {one:?} {several:?}");
            for ([first, square], [second, other]) in one.values().zip(several.values()) {
                assert!((first - second).abs() <= 4.0 * (square + other).sqrt(), "{count} at {rpm}: {first} {second}");
            }
        }
        let ends: Vec<_> = several.attractors.iter().flat_map(|row| row.birth.iter().chain(&row.death)).collect();
        let short = one.attractors.iter().filter(|row| row.revolutions.is_some_and(|turns| turns <= 4));
        let mut compared = 0;
        for end in short.flat_map(|row| row.birth.iter().chain(&row.death)).filter(|end| end.is_located()) {
            let near = |other: &&&corner_impact::study::attractors::Transition| {
                (other.value() * count as f64 / end.value() - 1.0).abs() < 1e-9
            };
            let there = ends.iter().find(near).unwrap_or_else(|| panic!("{count}: no {end:?}"));
            let breaks = count == 2 && end.cause == Cause::Flip;
            assert!(there.cause == end.cause || breaks && there.cause == Cause::SymmetryBreaking, "{there:?} {end:?}");
            compared += 1;
        }
        assert!(compared >= 6, "{compared}");
        all_of_each_speed(&several);
    }
}

/// A row that no start reached hides no range: rows that overlap coexist, and one list has the headline.
#[test]
#[ignore = "slow"]
fn what_overlaps_coexists() {
    let found = common::speeds(&lobes(2), [188.0, 192.0], &Resolution::new(common::step(1.0), 8), &Unwatched).unwrap();
    assert!(!found.coexistence.is_empty());
    for pair in found.coexistence.windows(2) {
        assert!(pair[0].range()[1] <= pair[1].range()[0]);
    }
    for rpm in [188.3, 188.9, 190.05, 191.5] {
        let there = |it: &&corner_impact::study::speeds::AttractorRow| it.range()[0] <= rpm && rpm <= it.range()[1];
        let there: Vec<&str> = found.attractors.iter().filter(there).map(|it| it.id.as_str()).collect();
        let over = found.coexistence.iter().find(|over| over.range()[0] <= rpm && rpm <= over.range()[1]).unwrap();
        assert_eq!(over.attractors, there, "{rpm}");
    }
}

/// "Rests now and then" is said only of what was seen to rest in the range.
#[test]
#[ignore = "slow"]
fn what_did_not_rest_is_not_said_to() {
    let model = model("preloaded");
    let found =
        common::speeds(&model, [735.0, 786.868_675_463_751_4], &Resolution::new(common::step(30.0), 16), &Unwatched)
            .unwrap();
    let wandering = found.attractors.iter().filter(|it| it.kind == Kind::Chaotic || it.kind == Kind::Resting);
    for it in wandering {
        let rested = it.at.iter().any(|at| at.ending.is_long());
        assert_eq!(
            it.kind == Kind::Resting,
            rested,
            "{}: {:?}",
            it.id,
            it.at.iter().map(|at| at.ending.kind()).collect::<Vec<_>>()
        );
    }
    assert!(found.attractors.iter().any(|it| it.kind == Kind::Chaotic));
}
