//! Is what is proved of motions that rest what a simulation of them does, as far as that is true?

use crate::common::{corner_impact, text};
use serde_json::Value;

#[track_caller]
fn proved(arguments: &[&str]) -> Value {
    let output = corner_impact([&["certify", "--resting", "--json"], arguments].concat());
    assert_eq!(output.status.code(), Some(0), "{}", text(output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn angle(release: &Value) -> f64 {
    release["cam_angle_rad"]["mid"].as_str().unwrap().parse().unwrap()
}

/// From each release the simulation rests by the angle that is told, and is let go at the angle and in the revolution that are.
#[track_caller]
fn held_against_simulation(model: &str, rpm: &str, revolutions: &[u64]) {
    let found = proved(&[model, "--rpm", rpm]);
    let releases = found["releases"].as_array().unwrap();
    let turns = |release: &Value| release["next"]["revolutions"].as_u64().unwrap();
    assert_eq!(releases.iter().map(turns).collect::<Vec<_>>(), revolutions, "{found}");
    for release in releases {
        let next = &release["next"];
        // Beyond the angle of a corner's double, so that the simulation starts on the side where the cam lets go.
        let start = (angle(release) + 1e-14).to_string();
        let upto = (turns(release) + 2).to_string();
        let run =
            ["simulate", model, "--rpm", rpm, "--start-angle", &start, "--relative-velocity", "0", "--events", "-"];
        let events = text(corner_impact([&run[..], &["--revolutions", &upto]].concat()).stdout);
        let rows: Vec<Vec<&str>> = events.lines().map(|row| row.split(',').collect()).collect();
        let stick = rows.iter().position(|row| row[3] == "stick").unwrap();
        let let_go = rows[stick..].iter().find(|row| row[3] == "release").unwrap();
        let number = |row: &[&str], column: usize| row[column].parse::<f64>().unwrap();
        let expected = angle(&releases[next["release"].as_u64().unwrap() as usize]);
        assert!((number(let_go, 2) - expected).abs() < 1e-9, "{model} {rpm}: {let_go:?}");
        assert_eq!(number(let_go, 0) as u64, turns(release), "{model} {rpm}: {let_go:?}");
        let before =
            (next["rests_by_rad"].as_f64().unwrap() - number(&rows[stick], 2)).rem_euclid(std::f64::consts::TAU);
        assert!(before < 1.5, "{model} {rpm}: rests at {:?}, not by {next}", rows[stick]);
        assert!(next["impacts"].as_u64().unwrap() < stick as u64, "{model} {rpm}: {next}");
    }
}

#[test]
#[ignore = "slow"]
fn motions_that_rest_are_proved_to_repeat_as_simulation_has_them() {
    // Let go where the acceleration jumps, and where that of the cam passes through what the spring can follow.
    held_against_simulation("models/osorio-2008.toml", "250", &[1, 3]);
    held_against_simulation("models/laws/harmonic.toml", "350", &[1]);
    held_against_simulation("models/damped-heavy.toml", "300", &[1, 1]);
}

/// The period is beyond what doubles can follow: a simulation of it has 354 revolutions.
#[test]
#[ignore = "slow"]
fn at_663_rpm_a_motion_that_rests_repeats_after_1120_revolutions() {
    let found = proved(&["models/osorio-2008.toml", "--rpm", "663"]);
    let round = &found["periodic"][0];
    assert_eq!(
        (&round["releases"], &round["impacts"], &round["revolutions"]),
        (&[1].into(), &1449.into(), &1120.into())
    );
    assert!(found["bits"].as_u64() > Some(600), "{found}");
}

#[test]
fn where_the_cam_presses_everywhere_a_follower_stays() {
    for (file, rpm) in [("models/osorio-2008.toml", "100"), ("models/laws/polynomial.toml", "300")] {
        let found = proved(&[file, "--rpm", rpm]);
        let [releases, pressed] = ["releases", "pressed_rad"].map(|of| found[of].as_array().unwrap().len());
        assert_eq!((releases, pressed), (0, 1), "{file}");
    }
    let page = text(corner_impact(["certify", "--resting", "--rpm", "100"]).stdout);
    assert!(crate::common::in_one_line(&page).contains("stays on it"), "{page}");
}

#[test]
fn machines_of_which_nothing_is_said_are_refused_with_the_reason() {
    for (arguments, why) in [
        (&["models/laws/rectified-sine.toml", "--rpm", "300"][..], "the velocity of the cam jumps"),
        (&["models/osorio-2008.toml", "--rpm", "300", "--set", "restitution=1"], "without a loss"),
        (&["models/osorio-2008.toml", "--rpm", "300:400"], "takes one speed"),
    ] {
        let output = corner_impact([&["certify", "--resting"], arguments].concat());
        let words = text(output.stderr);
        assert_eq!((output.status.code(), output.stdout.as_slice()), (Some(2), &[][..]), "{words}");
        assert!(words.contains(why), "{words}");
    }
}
