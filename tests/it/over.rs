//! Does a survey over any number say at each value what the model with that value says?

use approx::assert_relative_eq;
use corner_impact::model::Model;
use corner_impact::orbit::Parameter;
use corner_impact::orbit::long_run::{Budget, Kind};
use corner_impact::progress::Unwatched;
use corner_impact::study::attractors::{AttractorsError, Cause, Resolution, Step, attractors};
use corner_impact::study::basins::{Basin, BasinsOver, Begun};
use corner_impact::study::design::contact::Contact;
use corner_impact::study::design::{Asked, design};
use corner_impact::study::diagram::one_row;
use corner_impact::study::speeds::{SpeedSurvey, speeds};
use corner_impact::study::survey::{Axis, Over, Placed, RunError, Sample, Spacing, Start, Survey, Values};
use corner_impact_cli::show::Paged;

use crate::common::{self, corner_impact, text};

const MODEL: &str = "models/osorio-2008.toml";
const REST: Start = Start { cam_angle: 0.0, follower: Placed::OnCam(0.0) };

/// Lines of a table, and what was said on standard error.
fn told(arguments: &[&str]) -> (String, String) {
    let output = corner_impact(arguments);
    (text(output.stdout), text(output.stderr))
}

/// What is refused, in words.
fn refused(words: &str) -> String {
    let arguments: Vec<&str> = words.split_whitespace().collect();
    let output = corner_impact(&arguments);
    assert_eq!(output.status.code(), Some(2), "{words}");
    text(output.stderr)
}

fn axis(model: &Model, name: &str, low: f64, high: f64, count: usize, spacing: Spacing) -> Axis {
    Axis::new(Parameter::named(model, name).unwrap(), &Values { low, high, count, spacing })
}

/// An oscillator whose rest position is a clearance above the middle of a table that goes up and down by 0.01 m: it touches the table's highest
/// point where the clearance is that.
fn wall() -> Model {
    let text = "[follower]\nmass = 1.0\nrestitution = 0.7\ndamping = 0.4\nstiffness = 100.0\ngravity = 0.0\nrest_position = 0.005\n\
                [cam]\nlaw = \"harmonic\"\noffset = 0.0\namplitudes = [0.01]\nphases_deg = [0.0]\n";
    Model::parse("wall.toml", text).unwrap()
}

fn over(model: &Model, name: &str, range: [f64; 2], step: Step, starts: usize) -> SpeedSurvey {
    let over = Over::new(model, Parameter::named(model, name).unwrap(), Some(700.0)).unwrap();
    speeds(&over, range, &Resolution::new(step, starts), &Unwatched).unwrap()
}

/// `--rpm LO:HI:N` is short for `--over rpm=LO:HI:N`.
#[test]
#[ignore = "slow"]
fn a_range_of_speeds_is_one_number_of_many() {
    for options in [&["--one-row"][..], &["--record", "3"], &["--show", "gap", "--record", "3"]] {
        let one = [&["diagram", MODEL, "--rpm", "660:740:3", "--out", "-"], options].concat();
        let other = [&["diagram", MODEL, "--over", "rpm=660:740:3", "--out", "-"], options].concat();
        assert_eq!(told(&one), told(&other));
    }
    let survey = ["--step", "5", "--starts", "4", "--json"];
    let one = [&["speeds", MODEL, "--rpm", "690:700"][..], &survey].concat();
    let other = [&["speeds", MODEL, "--over", "rpm=690:700"][..], &survey].concat();
    assert_eq!(told(&one), told(&other));
    let one = [&["design", MODEL, "--rpm", "150:160", "--speeds", "3", "--json"][..]].concat();
    let other = [&["design", MODEL, "--over", "rpm=150:160:3", "--json"][..]].concat();
    assert_eq!(told(&one), told(&other));
    let basins = ["--grid", "4x4", "--out", "-"];
    let one = [&["basins", MODEL, "--rpm", "680:700:2"][..], &basins].concat();
    let other = [&["basins", MODEL, "--over", "rpm=680:700:2"][..], &basins].concat();
    assert_eq!(told(&one), told(&other));
}

/// At each value every command says what it says of the model that is given the value.
#[test]
fn each_value_is_a_model_of_its_own() {
    for value in ["0.65", "0.8"] {
        let (set, range) = (format!("restitution={value}"), format!("restitution={value}:{value}:1"));
        for options in [
            &["--one-row"][..],
            &["--record", "3"],
            &["--show", "energy", "--record", "3"],
            &["--attractors", "--record", "2"],
        ] {
            let rows = |table: &str| -> Vec<String> {
                table.lines().skip(1).map(|line| line.split_once(',').unwrap().1.to_owned()).collect()
            };
            let one = [&["diagram", MODEL, "--rpm", "700", "--over", &range, "--out", "-"], options].concat();
            let other = [&["diagram", MODEL, "--rpm", "700:700:1", "--set", &set, "--out", "-"], options].concat();
            let [one, other] = [told(&one).0, told(&other).0].map(|table| rows(&table));
            assert!(!one.is_empty() && one == other, "{value} {options:?}: {one:?} {other:?}");
        }
        let starts = ["--grid", "5x5", "--summary"];
        let one = [&["basins", MODEL, "--rpm", "700", "--over", &range][..], &starts].concat();
        let other = [&["basins", MODEL, "--rpm", "700", "--set", &set][..], &starts].concat();
        let [one, other]: [serde_json::Value; 2] = [one, other].map(|it| serde_json::from_str(&told(&it).0).unwrap());
        assert_eq!(one["values"][0]["endings"], other["endings"]);
        assert_eq!((&one["values"][0]["speed_rpm"], &one["over"]), (&700.0.into(), &"follower.restitution".into()));
    }
}

/// The loads and the force of a design at each mass are those of the model with that mass; and a limit is passed between two of the values.
#[test]
fn a_design_goes_over_a_mass() {
    let paper = common::osorio();
    let over = Some(axis(&paper, "mass", 1.0, 2.0, 3, Spacing::Linear));
    let asked = Asked { rpm: Some([200.0; 2]), over, ..Asked::default() };
    let found = design(&paper, &asked, &Unwatched).unwrap();
    for (index, mass) in [1.0, 1.5, 2.0].into_iter().enumerate() {
        let of_mass = paper.with_number("follower.mass", mass).unwrap();
        let alone = design(&of_mass, &Asked { rpm: Some([200.0; 2]), ..Asked::default() }, &Unwatched).unwrap();
        assert_eq!(found.loads[index].numbers(), alone.loads[0].numbers());
        assert_eq!(found.forces[index].least, alone.forces[0].least);
        assert_eq!((found.loads[index].place.rpm, found.loads[index].place.value), (200.0, Some(mass)));
    }
    let [low, high] = [found.loads[0].impact_speed, found.loads[1].impact_speed];
    let limits = vec![(corner_impact::study::design::loads::Load::ImpactSpeed, 0.5 * (low + high))];
    let passed = design(&paper, &Asked { limits, ..asked.clone() }, &Unwatched).unwrap().limits[0].at.unwrap();
    assert!(low < high && passed.rpm == 200.0 && (1.0..1.5).contains(&passed.value.unwrap()), "{passed:?}");
    assert_eq!(found.over.rpm, Some(200.0));
    let several = Asked { rpm: Some([100.0, 200.0]), ..asked };
    assert!(design(&paper, &several, &Unwatched).is_err());
}

/// The orbit of one impact at 700 rpm loses its stability at the restitution that `continue` finds, and shares of all attractors sum to 1 at
/// every value; a part of the range has the answer of that part.
#[test]
#[ignore = "slow"]
fn attractors_are_matched_over_a_restitution() {
    let paper = common::osorio();
    let whole = over(&paper, "restitution", [0.3, 0.5], common::step(0.05), 6);
    let part = over(&paper, "restitution", [0.35, 0.45], common::step(0.05), 6);
    let mut sums = std::collections::BTreeMap::<u64, f64>::new();
    for at in whole.attractors.iter().flat_map(|row| &row.at) {
        assert_eq!(at.place.rpm, 700.0);
        *sums.entry(at.value().to_bits()).or_default() += at.share.value;
    }
    assert!(sums.len() == 5 && sums.values().all(|sum| (sum - 1.0).abs() < 1e-12), "{sums:?}");
    let kinds = |found: &SpeedSurvey, value: f64| -> Vec<(Kind, f64)> {
        let at = found.attractors.iter().flat_map(|row| &row.at).filter(|at| at.value() == value);
        at.map(|at| (at.ending.kind(), at.share.value)).collect()
    };
    for value in [0.35, 0.4, 0.45] {
        assert_eq!(kinds(&whole, value), kinds(&part, value), "{value}");
    }
    let ends = |found: &SpeedSurvey| -> Vec<(Cause, f64)> {
        let all = found.attractors.iter().flat_map(|row| row.birth.iter().chain(&row.death));
        all.filter(|end| end.is_located()).map(|end| (end.cause, end.value())).collect()
    };
    for (cause, value) in ends(&part) {
        assert!(
            ends(&whole).iter().any(|(known, at)| *known == cause && (at - value).abs() < 1e-9),
            "{cause:?} {value}"
        );
    }
}

/// Two halves of a range have what the whole has: the kinds of motion and their shares at each value, and the located events. A step that is
/// half as long has the same at the values of both, and the events of what was seen there; this is asked of the numbers whose surveys are
/// quick. All numbers of the model are asked but the phase and the rounding of corners, of which there are none.
#[test]
#[ignore = "slow"]
fn parts_of_a_range_of_any_number_have_their_part_of_the_answer() {
    let wall = wall();
    let here = |found: &SpeedSurvey, value: f64| -> Vec<(Kind, f64)> {
        let at = found.attractors.iter().flat_map(|row| &row.at).filter(|at| at.value() == value);
        at.filter(|at| at.share.value > 0.0).map(|at| (at.ending.kind(), at.share.value)).collect()
    };
    let values = |found: &SpeedSurvey| -> Vec<f64> {
        let mut values: Vec<f64> = found.attractors.iter().flat_map(|row| row.at.iter().map(|at| at.value())).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values
    };
    let events = |found: &SpeedSurvey| -> Vec<(Cause, f64)> {
        let rows = found.attractors.iter();
        let all = rows.flat_map(|row| row.birth.iter().chain(&row.death)).filter(|end| end.is_located());
        all.map(|end| (end.cause, end.value())).collect()
    };
    let axes = [
        ("damping", [0.6, 0.8, 1.0], 0.2),
        ("stiffness", [100.0, 120.0, 140.0], 20.0),
        ("mass", [0.6, 0.7, 0.8], 0.1),
        ("gravity", [-0.1, 0.0, 0.1], 0.1),
        ("rest_position", [0.004, 0.005, 0.006], 0.001),
        ("restitution", [0.4, 0.5, 0.6], 0.1),
        ("amplitudes[0]", [0.008, 0.009, 0.01], 0.001),
        ("cam.offset", [0.0, 0.001, 0.002], 0.001),
        ("lever_ratio", [0.9, 1.0, 1.1], 0.1),
    ];
    let asked: Vec<&str> = axes.iter().map(|(name, ..)| *name).collect();
    let changes_nothing = |path: &str| path.ends_with("phases_deg[0]") || path.ends_with("corner_rounding_deg");
    let is_asked = |path: &str| changes_nothing(path) || asked.iter().any(|name| path.ends_with(name));
    assert!(wall.numbers().all(|(path, _)| is_asked(path)), "{:?}", wall.numbers().collect::<Vec<_>>());
    let mut seen = 0;
    // Every second number, of the follower and of the cam.
    let every = if crate::common::is_whole() { 1 } else { 2 };
    for (index, (name, [low, middle, high], step)) in
        axes.into_iter().enumerate().filter(|(index, _)| (index + 1) % every == 0)
    {
        let over = Over::new(&wall, Parameter::named(&wall, name).unwrap(), Some(250.0)).unwrap();
        let found = |range, step| {
            let budget = Budget { patience: 2_000, ..Budget::SURVEY };
            let resolution = Resolution { budget, ..Resolution::new(common::step(step), 2) };
            speeds(&over, range, &resolution, &Unwatched).unwrap()
        };
        // One part of each: the lower and the upper by turns.
        let part = if index / every % 2 == 0 { [low, middle] } else { [middle, high] };
        let [whole, part] = [[low, high], part].map(|range| found(range, step));
        let fine = (name == "restitution").then(|| found([low, high], 0.5 * step));
        let all = values(&whole);
        assert!(all.len() >= 3, "{name}: {all:?}");
        for value in all {
            if part.range[0] <= value && value <= part.range[1] {
                assert_eq!(here(&part, value), here(&whole, value), "{name} {value}");
            }
            if let Some(fine) = &fine {
                assert_eq!(here(fine, value), here(&whole, value), "{name} {value}, of a step half as long");
            }
        }
        let is_inside = |(_, value): &(Cause, f64)| part.range[0] <= *value && *value <= part.range[1];
        let [mut of_whole, of_part] = [&whole, &part].map(&events);
        seen += of_whole.len();
        // An attractor that no value of the grid has is met by chance.
        let on_the_grid = SpeedSurvey {
            attractors: whole.attractors.iter().filter(|row| !row.at.is_empty()).cloned().collect(),
            ..whole.clone()
        };
        let of_fine = fine.as_ref().map(|fine| (events(&on_the_grid), events(fine)));
        of_whole.retain(is_inside);
        let asked = [(&of_whole, &of_part), (&of_part, &of_whole)];
        for (one, other) in asked.into_iter().chain(of_fine.as_ref().map(|(of_grid, of_fine)| (of_grid, of_fine))) {
            for (cause, value) in one {
                let is_same = |(known, at): &(Cause, f64)| known == cause && (at - value).abs() < 1e-9 * (high - low);
                assert!(other.iter().any(is_same), "{name}: {cause:?} at {value}");
            }
        }
    }
    assert!(seen >= 8 / every, "{seen}");
}

/// A table of amplitude a lets go of a ball that lies on it where gravity falls below `a w^2`.
#[test]
fn a_follower_leaves_the_cam_at_a_gravity() {
    // Of little restitution: what is thrown off rests in each revolution.
    let ball = crate::attractors::ball().with_number("follower.restitution", 0.1).unwrap();
    let over = Over::new(&ball, Parameter::named(&ball, "gravity").unwrap(), Some(900.0)).unwrap();
    let omega = corner_impact::simulate::angular_velocity(900.0);
    let amplitude = (corner_impact::simulate::angular_velocity(1.0), common::cam(&ball));
    let lift = amplitude.1.highest().value - amplitude.1.lowest().value;
    let leaves = 0.5 * lift * omega * omega;
    let range = [0.9 * leaves, 1.1 * leaves];
    let found = speeds(&over, range, &Resolution::new(common::step(0.02 * leaves), 2), &Unwatched).unwrap();
    assert_relative_eq!(found.detachment().unwrap()[0], leaves, max_relative = 1e-9);
    assert!(found.detachment().unwrap()[1] <= 1e-9 * leaves);
    assert!(found.separation.is_none());
    let stays = found.attractors.iter().find(|row| row.kind == Kind::Stays).unwrap();
    assert_eq!(stays.birth.as_ref().unwrap().cause, Cause::Detachment);
}

/// On an eccentric `c = a (1 + cos)` at `m w^2 = 0.9 k` the inertia presses on a follower that the spring would lift off a cam at rest:
/// `N = k a - k rest_position + 0.1 k a cos` is nowhere negative up to `rest_position = 0.9 a`.
#[test]
#[ignore = "slow"]
fn a_follower_that_inertia_presses_on_leaves_at_a_rest_position() {
    let [amplitude, stiffness, mass] = [0.02_f64, 100.0, 1.0];
    let text = format!(
        "[follower]\nmass = {mass:?}\nrestitution = 0.1\ndamping = 0.0\nstiffness = {stiffness:?}\ngravity = 0.0\nrest_position = 0.018\n\
         [cam]\nlaw = \"harmonic\"\noffset = {amplitude:?}\namplitudes = [{amplitude:?}]\nphases_deg = [0.0]\n"
    );
    let model = Model::parse("eccentric.toml", &text).unwrap();
    let rpm = (0.9 * stiffness / mass).sqrt() * 60.0 / std::f64::consts::TAU;
    let over = Over::new(&model, Parameter::named(&model, "rest_position").unwrap(), Some(rpm)).unwrap();
    let range = [0.8 * amplitude, 0.99 * amplitude];
    let found = speeds(&over, range, &Resolution::new(common::step(0.02 * amplitude), 2), &Unwatched).unwrap();
    assert_relative_eq!(found.detachment().unwrap()[0], 0.9 * amplitude, max_relative = 1e-9);
    let stays = found.attractors.iter().find(|row| row.kind == Kind::Stays).unwrap();
    assert_eq!(stays.death.as_ref().unwrap().cause, Cause::Detachment);
    // A force that is 0, as a spring leaves it that is just slack on the highest lift, is no detachment.
    let slack = Model::parse("slack.toml", &text.replace("0.018", "0.0")).unwrap();
    let cam = common::cam(&slack);
    let rpm = |part: f64| (part * stiffness / mass).sqrt() * 60.0 / std::f64::consts::TAU;
    let leaves = [0.0, 1.9, 2.1].map(|part| Contact::new(&cam, slack.follower).leaves(rpm(part)));
    assert_eq!(leaves, [false, false, true]);
}

/// Nordmark's diagram over the clearance of a wall, on a logarithmic axis: no impact where the clearance is more than the wall moves, and some
/// right below; values are each the same multiple of the one before.
#[test]
fn impacts_begin_where_the_clearance_is_taken_up() {
    let wall = wall();
    let axis = axis(&wall, "rest_position", 1e-3, 1e-1, 22, Spacing::Logarithmic);
    for pair in axis.values.windows(2) {
        assert_relative_eq!(pair[1] / pair[0], 10.0_f64.powf(2.0 / 21.0), max_relative = 1e-12);
    }
    assert_eq!(axis.ends(), [1e-3, 1e-1]);
    let survey = Survey::new(&wall, Some(300.0), axis.clone(), None).unwrap();
    let found = one_row(&survey, REST, Budget::CHART, Some(2), &Unwatched).unwrap();
    for (clearance, point) in axis.values.iter().zip(&found) {
        let rate = point.as_ref().unwrap().impact_rate;
        assert_eq!(rate == 0.0, *clearance > 0.01, "{clearance}: {rate}");
    }
    // From next to it.
    let near = self::axis(&wall, "rest_position", 0.0099, 0.0101, 2, Spacing::Logarithmic);
    let near = Survey::new(&wall, Some(300.0), near, None).unwrap();
    let near = one_row(&near, REST, Budget::CHART, None, &Unwatched).unwrap();
    assert_eq!(near.iter().map(|point| point.as_ref().unwrap().impact_rate > 0.0).collect::<Vec<_>>(), [true, false]);
}

/// A run from rest on the cam at each value, which stays there at a low speed.
fn at_rest(step: Step) -> Resolution {
    Resolution { sample: Sample::Given(vec![REST]), ..Resolution::new(step, 1) }
}

/// Without gravity, the least stiffness that keeps the follower on the cam is proportional to the mass. The highest speed at which it stays
/// there goes with one over the root of the mass. So each is known as well as the mass allows.
#[test]
fn where_a_follower_leaves_the_cam_is_known_as_well_as_its_mass() {
    const MASS: f64 = 1.221;
    const ERROR: f64 = 0.01;
    let model = common::osorio_with(&[("mass", &format!("{{ value = {MASS}, error = {ERROR} }}"))]);
    let stiffness = Over::new(&model, Parameter::named(&model, "stiffness").unwrap(), Some(150.0)).unwrap();
    let speed = Over::speed(&model).unwrap();
    for (over, range, power) in [(stiffness, [2000.0, 3000.0], 1.0), (speed, [105.0, 125.0], 0.5)] {
        let found = speeds(&over, range, &at_rest(common::step(0.25 * (range[1] - range[0]))), &Unwatched).unwrap();
        let ends = found.attractors.iter().flat_map(|row| row.birth.iter().chain(&row.death));
        let leaves: Vec<_> = ends.filter(|end| end.cause == Cause::Detachment).collect();
        assert!(!leaves.is_empty(), "{:?}", found.attractors);
        for end in leaves {
            // Twice the standard deviation is told.
            let expected = 2.0 * power * ERROR / MASS * end.value();
            assert_relative_eq!(end.error.unwrap().total(), expected, max_relative = 2e-3);
        }
    }
}

/// The values of a grid, and whether there is a machine at each.
fn grid(over: &Over<'_>, range: [f64; 2], step: Step) -> Result<Vec<(f64, bool)>, AttractorsError> {
    let found = attractors(over, range, &at_rest(step), &Unwatched)?;
    assert_eq!(found.range, range);
    let is_machine = |found: &Result<_, RunError>| !matches!(found, Err(RunError::Family(_)));
    Ok(found.grid.iter().map(|at| (at.value, is_machine(&at.found))).collect())
}

/// A grid goes on for eight steps beyond either end of a range, below 0 as above; but to no value beyond them at which there is no machine. Those of
/// the range itself are told all the same.
#[test]
fn a_grid_of_any_number_is_the_range_and_its_margin() {
    let pressed = wall().with_number("follower.rest_position", -0.02).unwrap();
    let over = |name: &str| Over::new(&pressed, Parameter::named(&pressed, name).unwrap(), Some(1.0)).unwrap();
    let tenths = |range: std::ops::RangeInclusive<i32>| range.map(|tenth| f64::from(tenth) / 10.0);
    let all = |range| tenths(range).map(|value| (value, true)).collect::<Vec<_>>();
    let rest = over("rest_position");
    for [low, high] in [[-1, 1], [-3, 0], [0, 2], [-5, -4], [4, 7]] {
        let range = [low, high].map(|end| f64::from(end) / 10.0);
        assert_eq!(grid(&rest, range, common::step(0.1)).unwrap(), all(low - 8..=high + 8), "{range:?}");
    }
    // Of a restitution there are machines from 0 to 1.
    let restitution = over("restitution");
    let found = grid(&restitution, [0.3, 0.5], common::step(0.1)).unwrap();
    assert_eq!(found, all(0..=10));
    let told = grid(&restitution, [-0.2, 1.2], common::step(0.1)).unwrap();
    let expected: Vec<_> = tenths(-2..=12).map(|value| (value, (0.0..=1.0).contains(&value))).collect();
    assert_eq!(told, expected);
}

/// A logarithmic grid has powers of ten whose exponents are multiples of the step, over any number above 0 and over speeds below 1 rpm.
#[test]
fn a_grid_of_powers_of_ten_is_the_range_and_its_margin() {
    let pressed = wall().with_number("follower.rest_position", -0.02).unwrap();
    let stiffness = Over::new(&pressed, Parameter::named(&pressed, "stiffness").unwrap(), Some(1.0)).unwrap();
    let speed = Over::speed(&pressed).unwrap();
    let step = Step::at_most(0.2, Spacing::Logarithmic);
    for over in [&stiffness, &speed] {
        let found = grid(over, [0.1, 0.4], step).unwrap();
        let expected: Vec<f64> = (-13..=7).map(|fifth| 10.0_f64.powf(f64::from(fifth) / 5.0)).collect();
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for ((value, is_machine), expected) in found.into_iter().zip(expected) {
            assert_relative_eq!(value, expected, max_relative = 1e-12);
            assert!(is_machine);
        }
        // Of a part of the range they are the same, to the last bit.
        let [whole, part] = [[0.1, 0.4], [0.2, 0.3]].map(|range| grid(over, range, step).unwrap());
        assert!(part.len() < whole.len() && part.iter().all(|value| whole.contains(value)), "{part:?}");
    }
    let widths = [Step::at_most(0.25, Spacing::Logarithmic), Step::for_values([1e-3, 1e-1], 10, Spacing::Logarithmic)];
    assert_eq!(widths.map(|step| step.width()), [0.2, 0.2]);
}

/// A range goes up, as far as a double does, and has logarithms where these are asked for.
#[test]
fn a_range_that_is_none_of_a_number_is_refused() {
    let wall = wall();
    let over = Over::new(&wall, Parameter::named(&wall, "rest_position").unwrap(), Some(1.0)).unwrap();
    let (linear, decades) = (common::step(0.5), Step::at_most(0.5, Spacing::Logarithmic));
    let ends = [
        (linear, [0.5, 0.5]),
        (linear, [0.5, -0.5]),
        (linear, [-1e308, 1e308]),
        (linear, [0.0, f64::INFINITY]),
        (decades, [0.0, 1.0]),
        (decades, [-1.0, 1.0]),
        (decades, [1.0, 1.0]),
    ];
    for (step, range) in ends {
        let found = grid(&over, range, step);
        let is_refused = match &found {
            Err(AttractorsError::NoRangeOf { name, low, high, of_logarithms }) => {
                name == "follower.rest_position"
                    && [*low, *high] == range
                    && *of_logarithms == (step.spacing == Spacing::Logarithmic)
            }
            _ => false,
        };
        assert!(is_refused, "{range:?}: {found:?}");
    }
    for (step, range) in [(linear, [-0.5, 0.5]), (linear, [0.0, 0.5]), (decades, [1e-3, 1e-2])] {
        assert!(grid(&over, range, step).is_ok(), "{range:?}");
    }
}

/// An oscillator over a table, both moved up by as much: nothing but their heights is another.
fn moved_up(by: f64) -> Model {
    wall().with_number("cam.offset", by).unwrap()
}

/// Attractors over a rest position, their periods, what they begin and end with and where: all that moves with the offset of the cam is that.
#[test]
#[ignore = "slow"]
fn attractors_over_a_rest_position_move_with_the_offset() {
    let rows = |by: f64| -> Vec<_> {
        let table = moved_up(by);
        let over = Over::new(&table, Parameter::named(&table, "rest_position").unwrap(), Some(300.0)).unwrap();
        let range = [-0.018, -0.0165].map(|end| end + by);
        let found = speeds(&over, range, &Resolution::new(common::step(5e-4), 1), &Unwatched).unwrap();
        let cause = |end: &Option<corner_impact::study::attractors::Transition>| end.as_ref().map(|end| end.cause);
        let row = |it: &corner_impact::study::speeds::AttractorRow| {
            ((it.revolutions, it.impacts), [cause(&it.birth), cause(&it.death)], it.range().map(|end| end - by))
        };
        found.attractors.iter().map(row).collect()
    };
    let own = rows(0.0);
    let [one, two] = &own[..] else { panic!("{own:?}") };
    assert_eq!((one.0, two.0), ((Some(1), Some(1)), (Some(2), Some(2))), "{own:?}");
    assert_eq!((one.1[1], two.1[0]), (Some(Cause::Flip), Some(Cause::Flip)), "{own:?}");
    assert_relative_eq!(one.2[1], two.2[0], max_relative = 1e-9);
    // Among them one that puts the first value at which the second is found at 0.
    for by in [0.0175, 0.018, 0.1, 1.0, -1.0] {
        let found = rows(by);
        assert_eq!(found.len(), own.len(), "{by}: {found:?}");
        for (found, own) in found.iter().zip(&own) {
            assert_eq!((found.0, found.1), (own.0, own.1), "{by}");
            for (end, own) in found.2.into_iter().zip(own.2) {
                assert!((end - own).abs() < 1e-10, "{by}: {end} {own}");
            }
        }
    }
}

/// A ball lies on a table whose acceleration is less than gravity, or bounces where it is more than a part of that: over a range of gravities between
/// them, however narrow, both are there all along.
#[test]
fn two_attractors_are_told_of_a_narrow_range() {
    let ball = crate::attractors::ball();
    let over = Over::new(&ball, Parameter::named(&ball, "gravity").unwrap(), Some(700.0)).unwrap();
    for width in [1e-2, 1e-6, 4e-10] {
        let range = [9.81, 9.81 + width];
        let found = attractors(&over, range, &Resolution::new(common::step(width), 2), &Unwatched).unwrap();
        let both = found.coexistence.iter().find(|it| it.range == range && it.families.len() >= 2);
        assert!(both.is_some(), "{width}: {:?}", found.coexistence);
    }
}

/// Shares sum to 1 at each value, at which starts may be given.
#[test]
fn shares_of_basins_sum_to_one_at_every_value() {
    let paper = common::osorio();
    let over = Over::new(&paper, Parameter::named(&paper, "restitution").unwrap(), Some(700.0)).unwrap();
    let axis = axis(&paper, "restitution", 0.6, 0.8, 3, Spacing::Linear);
    let given = Begun::Given(vec![corner_impact::flight::State { position: 1.0, velocity: 0.0 }]);
    for begun in [Begun::Grid([5, 4], [None; 2]), given] {
        let found = BasinsOver::new(&over, &axis, (1.0, &begun), Budget::SURVEY, Some(2), &Unwatched);
        assert_eq!(found.at.iter().map(|at| at.place.value.unwrap()).collect::<Vec<_>>(), axis.values.to_vec());
        for at in &found.at {
            let parts = &at.found.as_ref().unwrap().parts;
            assert_relative_eq!(parts.iter().map(|part| part.share.value).sum::<f64>(), 1.0, max_relative = 1e-12);
            assert_eq!(at.failure(), None);
        }
        // By motions, too: each has a share at each value, and that of most starts comes first.
        let shares = found.shares();
        for index in 0..axis.values.len() {
            let all: f64 = shares.iter().map(|it| it.shares[index][1]).sum();
            assert_relative_eq!(all, 1.0, max_relative = 1e-12);
        }
        for it in &shares {
            for (at, [_, share]) in found.at.iter().zip(&it.shares) {
                let ends = |part: &&Basin| (part.ending.kind(), part.ending.period()) == it.motion;
                let parts = at.found.as_ref().unwrap().parts.iter().filter(ends);
                assert_eq!(*share, parts.map(|part| part.share.value).sum::<f64>(), "{:?}", it.motion);
            }
        }
        let sums: Vec<f64> = shares.iter().map(|it| it.shares.iter().map(|[_, share]| share).sum()).collect();
        assert!(sums.is_sorted_by(|one, other| one >= other), "{sums:?}");
    }
    // A start below the cam is one that cannot be run, at its value.
    let below = Begun::Given(vec![corner_impact::flight::State { position: -1.0, velocity: 0.0 }]);
    let found = BasinsOver::new(&over, &axis, (1.0, &below), Budget::SURVEY, Some(1), &Unwatched);
    assert!(found.at.iter().all(|at| at.failure().is_some_and(|why| why.contains("below"))), "{found:?}");
}

/// An axis that cannot be is refused in a sentence that says why.
#[test]
fn axes_that_cannot_be_are_refused() {
    let out = std::env::temp_dir().join("corner-impact-over.csv");
    let out = out.display();
    for (words, says) in [
        (format!("diagram {MODEL} --rpm 700 --over friction=0:1:3 --out {out}"), "friction"),
        (format!("diagram {MODEL} --rpm 700 --over restitution=0:1:3:log --out {out}"), "begins above 0"),
        (
            format!("diagram {MODEL} --rpm 700 --over restitution=0.5:0.9:1 --out {out}"),
            "the lowest and the highest to be the same",
        ),
        (format!("diagram {MODEL} --rpm 700 --over restitution=0.9:0.5:3 --out {out}"), "below the lowest"),
        (format!("diagram {MODEL} --rpm 700 --over restitution=0.5:0.9:3:lin --out {out}"), "can only be log"),
        (format!("diagram {MODEL} --over restitution=0.5:0.9:3 --out {out}"), "the speed is missing: give --rpm R"),
        (format!("diagram {MODEL} --rpm 600:700:3 --over restitution=0.5:0.9:3 --out {out}"), "`chart` varies two"),
        (format!("diagram {MODEL} --rpm 700 --over rpm=600:700:3 --out {out}"), "leave it out where rpm is an axis"),
        (format!("diagram {MODEL} --rpm 700 --out {out}"), "is one speed"),
        (format!("diagram {MODEL} --out {out}"), "nothing varies: give --rpm LO:HI"),
        (
            format!("diagram {MODEL} --rpm 700 --over restitution=0.5:2:3 --out {out}"),
            "follower.restitution = 1.25: must be",
        ),
        (
            format!("diagram {MODEL} --rpm 700 --set restitution=0.5 --over restitution=0.5:0.9:3 --out {out}"),
            "no point would",
        ),
        (format!("speeds {MODEL} --rpm 600:700 --over restitution=0.5:0.9"), "with --over, --rpm is one speed"),
        (format!("speeds {MODEL} --over restitution=0.5:0.9"), "the speed is missing: give --rpm R"),
        (format!("speeds {MODEL} --rpm 700 --over rpm=600:700"), "leave it out where rpm is an axis"),
        (format!("design {MODEL} --rpm 700 --over rpm=600:700:2"), "leave it out where rpm is an axis"),
        (format!("speeds {MODEL} --rpm 700"), "is one speed"),
        (format!("speeds {MODEL} --rpm 700 --over restitution=0:0.9:log"), "begins above 0"),
        (format!("speeds {MODEL} --rpm 700 --over restitution=0.5:0.5:3"), "to a higher one"),
        (format!("basins {MODEL} --rpm 700 --over friction=0:1:3 --grid 2x2"), "friction"),
        (format!("basins {MODEL} --over mass=1:2:3 --grid 2x2"), "the speed is missing: give --rpm R"),
        (format!("design {MODEL} --rpm 100:200 --over mass=1:2:3"), "with --over, --rpm is one speed"),
        (format!("design {MODEL} --over mass=1:2:3"), "--rpm"),
        (format!("chart {MODEL} --x rpm=0:700:3:log --y mass=1:2:2 --out {out}"), "above 0"),
    ] {
        let complaint = refused(&words);
        assert!(common::in_one_line(&complaint).contains(says), "{words}: {complaint}");
        assert_eq!(complaint.matches("error:").count(), 1, "{complaint}");
    }
}

/// A start below the cam cannot be run: the shares are of the others.
#[test]
fn shares_are_of_the_starts_that_could_be_run() {
    let words = ["speeds", MODEL, "--rpm", "700:710", "--step", "10", "--state", "0.45,0", "--state", "-1,0", "--json"];
    let found: serde_json::Value = serde_json::from_str(&told(&words).0).unwrap();
    let rows = found["attractors"].as_array().unwrap().iter().flat_map(|row| row["shares"].as_array().unwrap());
    let shares: Vec<f64> = rows.map(|at| at["share"].as_f64().unwrap()).collect();
    assert_eq!(shares, [1.0, 1.0]);
    assert_eq!(found["failed"][0]["starts"], 1, "{found}");
    // Where none can be run, a speed of the range is named.
    let said = refused(&format!("speeds {MODEL} --rpm 700:710 --step 10 --state -1,0"));
    assert!(said.contains("at 700 rpm, and at every other value"), "{said}");
    let (table, said) = told(&["diagram", MODEL, "--rpm", "700:710:3", "--state", "-1,0", "--one-row", "--out", "-"]);
    assert_eq!(table.matches("failed").count(), 3, "{table}");
    assert!(said.contains("3 of 3 values could not be run; the first is 700 rpm: "), "{said}");
}

/// The row of an attractor that is of another kind at some values says so.
#[test]
fn a_row_of_two_kinds_names_both() {
    let mut found = crate::common::speeds(
        &crate::attractors::ball(),
        [600.0, 640.0],
        &Resolution::new(common::step(20.0), 2),
        &Unwatched,
    )
    .unwrap();
    let row = found.attractors.iter_mut().find(|row| row.at.len() == 3).unwrap();
    let motion = row.kind;
    row.at[1].ending = crate::attractors::by_growth(1.0, 0.1);
    assert_ne!(row.at[1].ending.kind(), motion);
    assert!(
        found.text().unwrap().contains("A1 was seen at 3 speeds: it is chaotic at 1 of them."),
        "{}",
        found.text().unwrap()
    );
}

/// A diagram runs on as many threads as the environment says, and is judged only as far as it was asked.
#[test]
fn a_diagram_says_its_threads_and_whether_it_judges() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("rows.csv").to_str().unwrap().to_owned();
    let said = |options: &[&str]| {
        let line = [&["diagram", MODEL, "--rpm", "690:710:3", "--record", "2", "--out", &out], options].concat();
        text(common::program(line).env("RAYON_NUM_THREADS", "1").output().unwrap().stdout)
    };
    let plain = said(&[]);
    assert!(
        plain.contains("302 revolutions; the motions are not classified") && plain.contains(" s on 1 thread,"),
        "{plain}"
    );
    for options in [&["--lyapunov"][..], &["--attractors"]] {
        let judged = said(options);
        assert!(
            !judged.contains("not classified") && judged.contains("and longer for growth rates or attractors"),
            "{judged}"
        );
    }
}

/// Given starts are counted: their shares have no error.
#[test]
fn shares_of_given_starts_have_no_error() {
    let words = ["basins", MODEL, "--rpm", "700", "--state", "0.45,0", "--state", "0.5,0"];
    let (page, _) = told(&words);
    assert!(page.contains("  1.0000  1 impact in a revolution (2)"), "{page}");
    let (json, _) = told(&[&words[..], &["--summary"]].concat());
    assert!(json.contains("\"share_standard_error\": 0.0"), "{json}");
    let words = ["speeds", MODEL, "--rpm", "700:710", "--step", "10", "--state", "0.45,0", "--json"];
    let found: serde_json::Value = serde_json::from_str(&told(&words).0).unwrap();
    let shares = found["attractors"][0]["shares"].as_array().unwrap();
    assert!(shares.iter().all(|at| at["error"] == 0.0), "{found}");
    // A sample stands for more starts than itself.
    let (page, _) = told(&["basins", MODEL, "--rpm", "700", "--grid", "4x4"]);
    assert!(page.contains(" ± "), "{page}");
}

/// What a table cannot say of its failures, and a grid below the cam, is told beside it.
#[test]
fn what_could_not_be_run_is_told() {
    let below = ["basins", MODEL, "--rpm", "700", "--grid", "4x4", "--position", "-5:-4", "--velocity", "-1:1"];
    let (page, _) = told(&below);
    assert!(page.contains("below the cam: 16 starts: none could be run"), "{page}");
    let states = ["basins", MODEL, "--rpm", "700", "--state", "0.45,0", "--state", "-5,0", "--out", "-"];
    assert!(told(&states).1.contains("1 of 2 starts could not be run; the first is "), "{}", told(&states).1);
    let over = ["basins", MODEL, "--over", "mass=-1:1:2", "--rpm", "700", "--grid", "2x2", "--out", "-"];
    assert!(told(&over).1.contains("1 of 2 values could not be run; the first is -1 kg: "), "{}", told(&over).1);
    let axes = ["--x", "mass=-1:1:2", "--y", "restitution=0.5:0.6:2", "--rpm", "700", "--out", "-"];
    let (_, said) = told(&[&["chart", MODEL][..], &axes].concat());
    assert!(said.contains("2 of 4 points could not be run; the first is "), "{said}");
}

/// A table of `design` has the unit of the number that varies, and says what is not of its values.
#[test]
fn a_design_over_a_number_has_its_unit() {
    let (page, _) = told(&["design", MODEL, "--over", "mass=0.5:1:2", "--rpm", "100"]);
    assert!(page.contains("Over mass at 100 rpm"), "{page}");
    assert!(page.contains("\n  mass kg  least force N"), "{page}");
    assert!(common::in_one_line(&page).contains("are for the model's own mass."), "{page}");
}

/// A table of lifts needs a mass by an option; that is the model's own number, which `--over` may vary as it may vary one of a file.
#[test]
fn a_number_that_a_table_of_lifts_needs_can_be_varied() {
    let folder = tempfile::tempdir().unwrap();
    let run = |words: &str| common::program(words.split(' ')).current_dir(folder.path()).output().unwrap();
    assert!(run("new valve.toml --law table").status.success());
    let needs = "--mass 0.11 --stiffness 30 --preload 220";
    let output = run(&format!("design valve.csv {needs} --rpm 2000 --over mass=0.1:0.2:2"));
    assert_eq!(output.status.code(), Some(0), "{}", text(output.stderr));
    let output = run("design valve.toml --mass 0.12 --rpm 2000 --over mass=0.1:0.2:2");
    assert!(output.status.code() == Some(2) && text(output.stderr).contains("drop one of them"));
}
