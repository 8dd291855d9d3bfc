//! Is every periodic orbit there that is proved to be, and none that is proved not to be?

use crate::common::{corner_impact, text};
use serde_json::{Value, json};

#[track_caller]
fn document(arguments: &[&str]) -> Value {
    let output = corner_impact([arguments, &["--json"]].concat());
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn number(ball: &Value) -> f64 {
    ball["mid"].as_str().unwrap().parse().unwrap()
}

/// The kinds of the orbits of one impact that `orbit` finds at a speed, by their multipliers.
fn found_at(file: &str, rpm: f64) -> Vec<&'static str> {
    let found = document(&["orbit", file, "--rpm", &rpm.to_string()]);
    let one =
        found["orbits"].as_array().unwrap().iter().filter(|orbit| orbit["impacts"].as_array().unwrap().len() == 1);
    let mut kinds: Vec<_> = one
        .map(|orbit| {
            let beyond = |sign: f64| {
                let all = orbit["multipliers"].as_array().unwrap().iter();
                all.map(|one| (one["re"].as_f64().unwrap(), one["im"].as_f64().unwrap()))
                    .any(|(re, im)| im == 0.0 && sign * re > 1.0)
            };
            if beyond(1.0) {
                "saddle"
            } else if beyond(-1.0) {
                "flip"
            } else {
                "stable"
            }
        })
        .collect();
    kinds.sort_unstable();
    kinds
}

/// (speed, what happens) of each special orbit of one impact on the branches through those that `orbit` finds at a speed.
fn followed(file: &str, from: &str, rpm: &str) -> Vec<(f64, String)> {
    let output = corner_impact(["continue", file, "--from-rpm", from, "--parameter", &format!("rpm={rpm}")]);
    assert_eq!(output.status.code(), Some(0), "{}", text(output.stderr));
    let table = text(output.stdout);
    let mut lines = table.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let head = lines.next().unwrap();
    let column = |name: &str| head.iter().position(|one| *one == name).unwrap();
    let (speed, impacts, special) = (column("rpm"), column("impacts"), column("special"));
    let mut all: Vec<_> = lines
        .filter(|row| row[impacts] == "1" && !row[special].is_empty())
        .map(|row| (row[speed].parse().unwrap(), row[special].replace("corner", "corner-impact")))
        .collect();
    all.sort_by(|one: &(f64, String), other| one.0.total_cmp(&other.0));
    all
}

/// What is proved over a range is held against what `orbit` finds between the events, and against the special orbits of `continue`,
/// of which neither may have one that the other lacks.
#[track_caller]
fn held(file: &str, rpm: &str, from: &str) -> Value {
    let proved = document(&["certify", file, "--orbits", "--rpm", rpm]);
    assert_eq!(proved["undecided"], json!([]), "{proved}");
    for count in proved["counts"].as_array().unwrap() {
        let middle = (count["from_rpm"].as_f64().unwrap() + count["to_rpm"].as_f64().unwrap()) / 2.0;
        assert_eq!(json!(found_at(file, middle)), count["kinds"], "{middle} rpm");
        assert_eq!(count["kinds"].as_array().unwrap().len() as u64, count["one_impact_orbits"].as_u64().unwrap());
    }
    let events = proved["events"].as_array().unwrap();
    let followed = followed(file, from, rpm);
    let agree = |(event, (speed, kind)): (&Value, &(f64, String))| {
        event["kind"] == kind.as_str() && (number(&event["speed_rpm"]) - speed).abs() < 1e-9
    };
    assert!(events.len() == followed.len() && events.iter().zip(&followed).all(agree), "{events:#?}\n{followed:?}");
    proved
}

#[track_caller]
fn event(proved: &Value, kind: &str, speed: &str, degrees: f64) {
    let is_it =
        |event: &&Value| event["kind"] == kind && event["speed_rpm"]["mid"].as_str().unwrap().starts_with(speed);
    let found = proved["events"].as_array().unwrap().iter().find(is_it).unwrap_or_else(|| panic!("{kind}: {proved}"));
    assert!((number(&found["cam_angle_rad"]).to_degrees() - degrees).abs() < 0.005, "{found}");
    assert!(found["speed_rpm"]["rad"].as_str().unwrap().parse::<f64>().unwrap() < 1e-30, "{found}");
}

#[test]
#[ignore = "slow"]
fn the_paper_s_machine_has_no_orbit_of_one_impact_below_its_corner_impact_and_two_beyond_at_every_speed() {
    let proved = held("models/osorio-2008.toml", "600:800", "700");
    event(&proved, "corner-impact", "673.2344450038120023278237472", 150.1794);
    event(&proved, "flip", "739.3197802160016157043598311", 157.4192);
    let kinds: Vec<_> = proved["counts"].as_array().unwrap().iter().map(|count| count["kinds"].clone()).collect();
    assert_eq!(kinds, [json!([]), json!(["saddle", "stable"]), json!(["flip", "saddle"]), json!(["flip"])]);
    // The corner impact is the one that has a certificate, and the only one of one impact that `locate` finds.
    let certified = document(&["certify", "models/osorio-2008.toml", "--rpm", "600:800"]);
    let of_one = |found: &Value| -> Vec<Value> {
        let all = found["corner_impacts"].as_array().unwrap().iter();
        all.filter(|one| one["impacts"] == 1 || one["impacts"].as_array().is_some_and(|all| all.len() == 1))
            .cloned()
            .collect()
    };
    let [certificate] = &of_one(&certified)[..] else { panic!("{certified}") };
    assert_eq!(
        certificate["speed_rpm"]["mid"].as_str().unwrap()[..30],
        proved["events"][0]["speed_rpm"]["mid"].as_str().unwrap()[..30]
    );
    let located = document(&["locate", "models/osorio-2008.toml", "--rpm", "600:800"]);
    assert_eq!(of_one(&located).len(), 1, "{located}");
}

/// 4e-9 rpm below the corner impact, where Newton's method still finds the orbit that exists above it: both lists are the proved one.
#[test]
fn an_orbit_that_exists_within_rounding_alone_is_not_listed() {
    let paper = "models/osorio-2008.toml";
    for (rpm, count) in [("673.234445", 0), ("673.23444500382", 2)] {
        for arguments in [&["orbit", paper, "--rpm", rpm][..], &["orbit", paper, "--rpm", rpm, "--impacts", "1"]] {
            let found = document(arguments);
            let orbits = found["orbits"].as_array().unwrap().iter();
            let one = orbits.filter(|orbit| orbit["impacts"].as_array().is_some_and(|impacts| impacts.len() == 1));
            assert_eq!(one.count(), count, "{arguments:?}");
            assert_eq!(
                found["complete"][0],
                json!({"revolutions": 1, "impacts": 1, "known": "proved"}),
                "{arguments:?}"
            );
        }
    }
}

#[test]
#[ignore = "slow"]
fn folds_and_grazes_are_proved_where_branches_have_them() {
    let proved = held("models/persistence.toml", "485:570", "500");
    event(&proved, "fold", "493.811509867092714", 131.75);
    event(&proved, "corner-impact", "493.82751292167882009", 134.1765);
    let proved = held("models/nonsmooth-flip.toml", "810:890", "850");
    event(&proved, "fold", "813.366199080021228", 82.78);
    // A cam without corners, one of decimals, and a follower without a spring.
    for (file, rpm, from) in [
        ("models/laws/harmonic.toml", "440:610", "450"),
        ("models/laws/polynomial.toml", "607:622", "607.9"),
        ("models/ballistic.toml", "690:710", "695"),
    ] {
        held(file, rpm, from);
    }
}

/// At 500 rpm one of the flights between two impacts may last a half swing, after which a follower is at its end however it left.
#[test]
#[ignore = "slow"]
fn orbits_of_two_impacts_are_all_there_where_a_flight_may_last_a_half_swing() {
    let proved = document(&["certify", "--orbits", "--rpm", "500"]);
    assert_eq!((&proved["complete"], &proved["undecided"]), (&json!([1, 2]), &json!([])), "{proved}");
    let [orbit] = &proved["orbits"].as_array().unwrap()[..] else { panic!("{proved}") };
    let angles: Vec<f64> =
        orbit["impacts"].as_array().unwrap().iter().map(|one| number(&one["cam_angle_rad"])).collect();
    let found = document(&["orbit", "models/osorio-2008.toml", "--rpm", "500", "--impacts", "2"]);
    let has = |one: &Value| {
        let impacts = one["impacts"].as_array().unwrap();
        let near =
            |angle: &f64| impacts.iter().any(|one| (one["cam_angle_rad"].as_f64().unwrap() - angle).abs() < 1e-9);
        impacts.len() == 2 && angles.iter().all(near)
    };
    assert_eq!(found["orbits"].as_array().unwrap().iter().filter(|one| has(one)).count(), 1, "{found}\n{proved}");
}

/// The speed of a graze, but for 1e-14 rpm: an impact of two is a touch there.
#[test]
#[ignore = "slow"]
fn where_a_flight_touches_the_list_is_not_said_to_be_complete() {
    let arguments = ["certify", "--orbits", "--rpm", "786.7196856957516", "--bits", "53"];
    let proved = document(&arguments);
    assert!(!proved["complete"].as_array().unwrap().contains(&json!(2)), "{proved}");
    let degrees = |one: &Value| one["cam_angles_rad"][0][0].as_f64().unwrap().to_degrees();
    assert!(
        proved["undecided"]
            .as_array()
            .unwrap()
            .iter()
            .any(|one| one["impacts"] == 2 && (degrees(one) - 94.61957).abs() < 1e-4),
        "{proved}"
    );
    assert!(text(corner_impact(arguments).stdout).contains("not decided about impacts at 94.6195"));
}

#[test]
#[ignore = "slow"]
fn machines_whose_orbits_are_not_counted_over_a_range_are_refused_with_the_reason() {
    for (arguments, why) in [
        (&["models/laws/rectified-sine.toml"][..], "the cam's velocity jumps"),
        (&["models/osorio-2008.toml", "--set", "restitution=0"], "does not leave the cam"),
        (&["models/osorio-2008.toml", "--set", "restitution=1"], "neither stable nor unstable"),
        (&["models/osorio-2008.toml", "--bits", "52"], "at least 53"),
    ] {
        let output = corner_impact([&["certify"], arguments, &["--orbits", "--rpm", "600:760"]].concat());
        let words = text(output.stderr);
        assert_eq!((output.status.code(), output.stdout.as_slice()), (Some(2), &[][..]), "{words}");
        assert!(words.contains(why), "{words}");
    }
}

/// A cam with two corners at which its velocity jumps; `certify` once said that it has no orbit of one impact.
const JUMPING: &str = r#"name = "a cam whose velocity jumps"
[follower]
mass = 1.0
damping = 0.0
stiffness = 341.3789996313038
gravity = 0.0
rest_position = -0.2953266235676433
restitution = 0.309463983701128
[cam]
law = "polynomial"
[[cam.segment]]
start_deg = 68.27439771110639
coefficients = [0.009160140751629275, -0.059060678004851284, 0.03512740121516389]
[[cam.segment]]
start_deg = 197.76469278753777
coefficients = [0.05510291367552992, -0.18479739484281107, 0.043095002513597935]
"#;

/// The orbit of one impact solves the equations of flight and impact to 2e-40, found by Newton's method in 60 digits.
#[test]
#[ignore = "slow"]
fn no_orbit_is_missing_where_the_velocity_of_the_cam_jumps() {
    let folder = tempfile::TempDir::new().unwrap();
    let file = folder.path().join("jumping.toml");
    std::fs::write(&file, JUMPING).unwrap();
    let file = file.to_str().unwrap();
    let proved = document(&["certify", file, "--orbits", "--rpm", "542.617"]);
    let orbits = proved["orbits"].as_array().unwrap();
    let one: Vec<&Value> = orbits.iter().filter(|orbit| orbit["impacts"].as_array().unwrap().len() == 1).collect();
    let [orbit] = &one[..] else { panic!("{proved}") };
    let impact = &orbit["impacts"][0];
    assert!(impact["cam_angle_rad"]["mid"].as_str().unwrap().starts_with("3.415282925377087"), "{orbit}");
    assert!((number(&impact["relative_velocity_m_s"]) - 4.9485).abs() < 1e-4, "{orbit}");
    assert_eq!((&orbit["kind"], &proved["complete"]), (&json!("saddle"), &json!([1])), "{proved}");
    // Two impacts beside a jump are left open, and not said to be none.
    let undecided = proved["undecided"].as_array().unwrap();
    assert!(!undecided.is_empty() && undecided.iter().all(|place| place["impacts"] == 2), "{proved}");
    let output = corner_impact(["certify", file, "--orbits", "--rpm", "540:545"]);
    assert!(text(output.stderr).contains("where the cam's velocity jumps"), "over a range it is refused");
}
