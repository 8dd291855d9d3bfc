//! Have answers moved? What the program prints for short questions of every kind, in snapshots; that it is right is for other files.

use serde_json::Value;

use crate::{common, snapshots};

/// To six digits, as many as all machines agree on; what is nothing but rounding is 0.
fn digits(number: f64) -> String {
    let exponent = if number.abs() < 1e-8 { return "0".into() } else { number.abs().log10().floor() };
    if (-3.0..6.0).contains(&exponent) {
        let text = format!("{number:.*}", (5.0 - exponent) as usize);
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
    } else {
        format!("{number:.5e}")
    }
}

/// A document on a few lines.
fn document(value: &Value) -> String {
    match value {
        Value::Number(number) if number.is_f64() => number.as_f64().map_or(String::new(), digits),
        Value::Array(values) => format!("[{}]", values.iter().map(document).collect::<Vec<_>>().join(", ")),
        Value::Object(fields) => {
            // Times, and what rounding decides, errors and how often a box is halved, are a machine's own.
            const OWN: [&str; 8] =
                ["wall_s", "error", "times_error", "residual", "rate_error", "agreement", "skipped", "boxes"];
            // The last digits of a sine decide what chaos comes to.
            if fields.get("kind").is_some_and(|kind| kind == "chaotic") {
                return "chaotic".into();
            }
            // As they do how long it takes to a rest that comes again in no time that is waited for.
            if fields.get("kind").is_some_and(|kind| kind == "resting") && fields.get("impacts") == Some(&Value::Null) {
                return "rests after long".into();
            }
            // A quotient of two that are 0 is one of what rounding left.
            let is_0 = |name: &str| fields.get(name).and_then(Value::as_f64).is_some_and(|it| it.abs() < 1e-8);
            let is_known = |name: &str| !OWN.contains(&name) && (name != "relative" || !(is_0("a") && is_0("b")));
            let fields = fields.iter().filter(|(name, _)| is_known(name));
            let fields = fields.map(|(name, value)| format!("{name}: {}", document(value)));
            format!("{{{}}}\n ", fields.collect::<Vec<_>>().join(", "))
        }
        other => other.to_string(),
    }
}

/// A table's row.
fn row(line: &str) -> String {
    let cell = |cell: &str| match cell.parse::<f64>() {
        Ok(number) if cell.contains(['.', 'e']) => digits(number),
        _ => cell.to_owned(),
    };
    line.split(',').map(cell).collect::<Vec<_>>().join(",")
}

/// What the program says to each line, in a snapshot; `~` is a blank within a word.
pub fn are_as_they_were(name: &str, lines: &[&str]) {
    let mut said = String::new();
    for line in lines {
        let output = common::corner_impact(line.split(' ').map(|word| word.replace('~', " ")));
        let text = common::text(output.stdout);
        said += &format!("$ {line}\n");
        match serde_json::from_str::<Value>(&text) {
            Ok(value) => said += &document(&value),
            Err(_) => said.extend(text.lines().map(|line| format!("{}\n", row(line)))),
        }
        assert!(output.status.success(), "{line}: {}", common::text(output.stderr));
    }
    snapshots::settings().bind(|| insta::assert_snapshot!(name, said));
}

#[test]
#[ignore = "slow"]
fn where_corner_impacts_are() {
    are_as_they_were(
        "answers-locate",
        &[
            "locate --rpm 670:680 --json",
            "locate --rpm 735:740 --json",
            "locate models/nonsmooth-flip.toml --rpm 875:880 --json",
            "locate models/damped-light.toml --rpm 700:705 --json",
        ],
    );
}

#[test]
#[ignore = "slow"]
fn where_corner_impacts_of_other_kinds_are() {
    are_as_they_were(
        "answers-locate-kinds",
        &[
            "locate models/persistence.toml --rpm 485:500 --json",
            "locate models/preloaded.toml --rpm 655:665 --json",
            "locate --rpm 750:760 --revolutions 2 --json",
        ],
    );
}

#[test]
#[ignore = "slow"]
fn which_corner_impacts_are_none() {
    are_as_they_were(
        "answers-locate-refused",
        &[
            "locate --set stiffness=0 --rpm 500:800",
            "locate --rpm 600:640 --json",
            "locate models/laws/polynomial.toml --rpm 301.9:302 --json",
            "locate models/laws/rectified-sine.toml --rpm 19:20 --json",
        ],
    );
}

#[test]
#[ignore = "slow"]
fn which_corner_impacts_come_after_chattering() {
    are_as_they_were("answers-locate-chattering", &["locate --rpm 163.4:163.5 --json"]);
}

#[test]
#[ignore = "slow"]
fn corner_impacts_of_many_impacts() {
    are_as_they_were(
        "answers-locate-many",
        &[
            "locate models/ballistic.toml --rpm 331.9:332.1 --json",
            "locate models/overdamped.toml --rpm 557:558 --json",
        ],
    );
}

#[test]
#[ignore = "slow"]
fn corner_impacts_at_other_corners() {
    are_as_they_were(
        "answers-locate-corners",
        &[
            "locate models/laws/rectified-sine.toml --rpm 18.4:18.6 --json",
            "locate models/laws/rectified-sine.toml --rpm 6.588:6.589 --json",
            "locate models/laws/program.toml --rpm 2257:2258 --json",
        ],
    );
}

/// Where a turn begins an impact is named by the end of it or by the beginning of the next.
#[test]
#[ignore = "slow"]
fn corner_impacts_over_several_turns() {
    are_as_they_were(
        "answers-locate-turns",
        &[
            "locate models/persistence.toml --rpm 465.7:465.8 --revolutions 2 --json",
            "locate --rpm 672.6:672.7 --revolutions 6 --json",
        ],
    );
}

#[test]
#[ignore = "slow"]
fn corner_impacts_where_turns_begin() {
    are_as_they_were(
        "answers-locate-begin",
        &["locate models/laws/program.toml --rpm 1721.1:1721.2 --revolutions 2 --json"],
    );
}

#[test]
#[ignore = "slow"]
fn corner_impacts_of_many_impacts_on_either_side() {
    are_as_they_were("answers-locate-sides", &["locate models/laws/polynomial.toml --rpm 408:411 --json"]);
}

#[test]
#[ignore = "slow"]
fn corner_impacts_of_more_impacts_yet() {
    are_as_they_were(
        "answers-locate-most",
        &[
            "locate --rpm 194.2:194.3 --json",
            "locate --rpm 195.5:195.7 --json",
            "locate --rpm 134.5:134.6 --json",
            "locate models/sharp-nose.toml --rpm 218.9:219.1 --json",
        ],
    );
}

#[test]
#[ignore = "slow"]
fn which_motions_there_are() {
    are_as_they_were("answers-speeds", &["speeds --rpm 735:739 --step 2 --starts 8 --json"]);
}

#[test]
#[ignore = "slow"]
fn which_motions_there_are_side_by_side() {
    are_as_they_were(
        "answers-speeds-several",
        &["speeds models/laws/program.toml --rpm 2900:2920 --step 10 --starts 4 --json"],
    );
}

#[test]
#[ignore = "slow"]
fn which_motions_there_are_beside_chaos() {
    are_as_they_were("answers-speeds-chaos", &["speeds --rpm 676:680 --step 2 --starts 4 --json"]);
}

#[test]
#[ignore = "slow"]
fn which_motions_end_in_flips() {
    are_as_they_were(
        "answers-speeds-flips",
        &["speeds models/sharp-nose.toml --rpm 300:310 --step 5 --starts 2 --json"],
    );
}

#[test]
fn what_speeds_show() {
    are_as_they_were(
        "answers-diagram",
        &[
            "diagram --rpm 660:700:5 --transient 50 --record 5 --out -",
            "diagram --rpm 690:710:3 --attractors --record 3 --out -",
            "diagram --rpm 700:704:3 --start up --section strobe --strobe 90deg --transient 100 --record 2 --out -",
            "diagram --rpm 700:704:3 --start down --transient 30 --record 2 --out - --relative-velocity 2",
            "diagram --rpm 150:190:3 --transient 3 --record 1 --out -",
        ],
    );
}

#[test]
fn where_starts_end() {
    are_as_they_were(
        "answers-basins",
        &[
            "basins --rpm 700 --grid 8x6 --out -",
            "basins --rpm 700 --grid 12x12 --summary",
            "basins --rpm 738 --grid 10x8 --summary",
            "basins models/laws/harmonic.toml --rpm 500 --grid 8x8 --summary",
            "basins --rpm 150 --grid 5x5 --summary",
            "basins --rpm 700 --grid 4x4 --position 0.5:3 --velocity -20:20 --strobe 90deg --out -",
        ],
    );
}

#[test]
fn what_two_numbers_show() {
    are_as_they_were(
        "answers-chart",
        &[
            "chart --x rpm=690:720:4 --y restitution=0.75:0.8:3 --out -",
            "chart --x mass=1.2:1.3:3 --y stiffness=1400:1500:3 --rpm 700 --out - --transient 100 --record 20",
            "chart models/laws/harmonic.toml --x rpm=300:500:2 --y damping=0:1:3 --out -",
        ],
    );
}

#[test]
#[ignore = "slow"]
fn what_moved() {
    are_as_they_were("answers-compare", &["compare models/damped-light.toml models/damped-heavy.toml --json"]);
}

#[test]
fn what_a_designer_asks() {
    are_as_they_were(
        "answers-design",
        &[
            "design --rpm 100:180 --speeds 5 --json",
            "design models/laws/polynomial.toml --rpm 300:400 --speeds 5 --json",
            "design --need no~separation~to~200~rpm --speeds 2 --json",
            "design --limit impact-speed=5m/s --limit gap=10mm --limit energy=2J --limit force=3000 --rpm 100:180 --speeds 9 --json",
            "design models/laws/rectified-sine.toml --rpm 20:24 --speeds 2 --json",
            "design models/preloaded.toml --rpm 90:100 --speeds 2 --limit force=100 --limit gap=1mm --json",
        ],
    );
}

#[test]
#[ignore = "slow"]
fn what_a_designer_asks_against_another_number() {
    are_as_they_were(
        "answers-design-against",
        &[
            "design models/laws/program.toml --need no~separation~to~2000~rpm --against mass=0.05:0.2:3 --speeds 2 --json",
            "design models/laws/program.toml --need no~separation~to~2000~rpm --against stiffness=100:10000:3 --speeds 2 --json",
        ],
    );
}

#[test]
fn what_a_designer_asks_against_the_preload() {
    are_as_they_were(
        "answers-design-preload",
        &[
            "design models/laws/program.toml --need no~separation~to~2000~rpm --against preload=20:100:3 --speeds 2 --json",
        ],
    );
}

#[test]
fn how_a_run_goes() {
    are_as_they_were(
        "answers-simulate",
        &[
            "simulate --rpm 183 --revolutions 2 --events -",
            "simulate --rpm 700 --revolutions 4 --events -",
            "simulate --rpm 670 --revolutions 3 --events -",
            "simulate --rpm 150 --revolutions 2 --strobe 90deg --strobe-out -",
            "simulate models/laws/harmonic.toml --rpm 500 --revolutions 4 --state 0.2,1 --start-angle 90deg --events -",
        ],
    );
}

#[test]
#[ignore = "slow"]
fn how_events_move() {
    are_as_they_were(
        "answers-curve",
        &[
            "curve --rpm 670:676 --parameter restitution=0.79:0.81 --step 0.2",
            "curve --rpm 738:744 --parameter nose_radius=0.149:0.151 --step 0.2",
            "curve models/persistence.toml --rpm 490:496 --parameter damping=0:1 --step 0.2",
        ],
    );
}

#[test]
#[ignore = "slow"]
fn how_folds_move_from_a_sharp_corner() {
    are_as_they_were(
        "answers-curve-rounded",
        &["curve --rpm 672:675 --parameter corner_rounding_deg=0.001:2 --step 0.2"],
    );
}

#[test]
fn how_orbits_move() {
    are_as_they_were(
        "answers-continue",
        &[
            "continue --from-rpm 700 --parameter rpm=690:710 --all=1 --step 0.2",
            "continue --from-rpm 739.35 --revolutions 2 --parameter rpm=738:740 --step 0.2",
            "orbit --rpm 700 --json",
            "orbit --rpm 183 --json",
            "orbit models/laws/program.toml --rpm 2900 --json",
        ],
    );
}
