//! Does `locate` find the corner impacts of a range of speeds, say what happens at each, and refuse what is none?

use std::process::Output;

use crate::common;
use corner_impact::border_collision::feigin::Scenario;
use corner_impact::corner::Way;
use corner_impact::corner::range::{self, RangeError, Recaptured};
use corner_impact::model::{Model, Study};
use corner_impact::progress::Unwatched;
use corner_impact::study::locate::{Happens, LocateRangeError, Located, LocatedImpact};
use serde_json::Value;

const MODEL: &str = concat!(env!("PROJECT"), "/models/osorio-2008.toml");

fn law(name: &str) -> String {
    format!("{}/models/laws/{name}.toml", common::ROOT)
}

fn locate(arguments: &[&str]) -> Output {
    common::program(["locate"]).args(arguments).output().unwrap()
}

fn document(model: &str, rpm: &str, revolutions: &str) -> (Option<i32>, Value) {
    let output = locate(&[model, "--rpm", rpm, "--revolutions", revolutions, "--json"]);
    let text = String::from_utf8(output.stdout).unwrap();
    (output.status.code(), serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}")))
}

fn surveyed(model: &Model, low: f64, high: f64, revolutions: u64) -> Located {
    corner_impact::study::locate::locate(model, Study { rpm_min: low, rpm_max: high }, revolutions, &Unwatched).unwrap()
}

fn speeds(document: &Value) -> Vec<f64> {
    document["corner_impacts"].as_array().unwrap().iter().map(|at| at["speed_rpm"].as_f64().unwrap()).collect()
}

#[test]
fn the_papers_corner_impact_is_among_them() {
    let (code, document) = document(MODEL, "600:760", "1");
    assert_eq!(
        (code, &document["schema"], &document["agrees"]),
        (Some(0), &"corner-impact/locate/1".into(), &true.into())
    );
    let speeds = speeds(&document);
    assert!(speeds.is_sorted() && speeds.len() >= 2, "{speeds:?}");
    let at = &document["corner_impacts"][0];
    let one_impact = serde_json::json!([{ "revolutions": 1, "impacts": 1, "known": "proved" }]);
    assert_eq!((&document["complete"], &at["known"]), (&one_impact, &"computed".into()));
    let near =
        |value: &Value, expected: f64| (value.as_f64().unwrap() - expected).abs() <= 1e-12 * expected.abs().max(1.0);
    assert!(near(&at["speed_rpm"], 673.234445003848821) && near(&at["period_s"], 0.08912199969158884), "{at}");
    assert!(near(&at["cam_angle_rad"], 2.62112450116623235), "{at}");
    // x* from the equilibrium at 0.3.
    assert!(near(&at["state"][0], 5.39700788184262174) && near(&at["state"][1], 0.0), "{at}");
    assert_eq!([&at["revolutions"], &at["impacts"], &at["jump_order"]], [1, 1, 2]);
    assert_eq!((&at["classification"]["scenario"], &at["agrees"]), (&"nonsmooth-fold".into(), &true.into()));
    assert_eq!(
        at["classification"]["fixed_points_exist_for"],
        serde_json::json!({ "minus": "faster", "plus": "faster" })
    );
    let found =
        corner_impact::study::verify::verify(&common::osorio(), corner_impact::study::verify::External::LeftOut)
            .unwrap();
    let closed = found.map;
    let a11 = at["map"]["minus"]["A"][0][0].as_f64().unwrap();
    assert!((a11 - closed.minus.a[(0, 0)]).abs() < 1e-12 && near(&at["map"]["plus"]["B"][0], 208.117406498670516));
}

/// After 739.32 rpm the stable motion repeats after two revolutions; one of its two impacts reaches the nose's end.
#[test]
#[ignore = "slow"]
fn an_orbit_of_two_revolutions_reaches_the_noses_end() {
    let (code, document) = document(MODEL, "738:741", "2");
    assert_eq!(code, Some(0));
    let at = &document["corner_impacts"][0];
    let one_impact = serde_json::json!([{ "revolutions": 2, "impacts": 1, "known": "proved" }]);
    assert_eq!((&document["complete"], &at["known"]), (&one_impact, &"computed".into()));
    assert!((at["speed_rpm"].as_f64().unwrap() - 739.377929649).abs() < 1e-8, "{at}");
    assert_eq!([&at["revolutions"], &at["impacts"], &at["jump_order"]], [2, 2, 2]);
    assert!((at["cam_angle_rad"].as_f64().unwrap().to_degrees() - 160.0).abs() < 1e-12);
    assert_eq!(at["orbit_period_s"].as_f64().unwrap(), 2.0 * at["period_s"].as_f64().unwrap());
    // No motion of one revolution is there.
    assert!(self::document(MODEL, "738:741", "1").1["corner_impacts"].as_array().unwrap().is_empty());
}

/// A follower without spring that flies for two revolutions from the corner back to it.
#[test]
#[ignore = "slow"]
fn one_impact_in_two_revolutions_is_found() {
    let model = common::read(concat!(env!("PROJECT"), "/models/ballistic.toml").as_ref());
    let found = surveyed(&model, 332.0, 332.6, 2);
    let [located] = found.found.as_slice() else { panic!("{:?}", found.found) };
    assert!((located.at.speed_rpm() - 332.297519227).abs() < 1e-8 && located.agrees, "{located:?}");
    assert_eq!((located.at.cycle.revolutions, located.at.cycle.impacts.len()), (2, 1));
}

#[test]
#[ignore = "slow"]
fn routes_agree_at_every_corner_impact() {
    let mut scenarios = Vec::new();
    for (model, low, high, revolutions, least) in [
        (common::osorio(), 600.0, 760.0, 1, 2),
        (common::osorio(), 600.0, 760.0, 2, 2),
        (common::read(law("polynomial").as_ref()), 300.0, 800.0, 1, 7),
        (common::read(law("rectified-sine").as_ref()), 13.0, 20.0, 1, 2),
        (common::read(law("table-cubic").as_ref()), 672.0, 674.0, 1, 10),
        // Rounding in early flights moves the gap of the corner, which comes late.
        (common::read(law("program").as_ref()), 1141.0, 1142.0, 1, 2),
    ] {
        let found = surveyed(&model, low, high, revolutions);
        assert!(found.found.len() >= least, "{}: {}", model.name, found.found.len());
        assert!(found.agrees);
        assert!(found.found.iter().map(|located| located.at.speed_rpm()).is_sorted(), "{}", model.name);
        for located in &found.found {
            let speed = located.at.speed_rpm();
            assert!(located.agrees && (low..=high).contains(&speed), "{} at {speed}: {located:?}", model.name);
            assert_eq!(located.at.cycle.revolutions, revolutions);
            // Each matrix of each side that there is has been compared.
            let quantities: Vec<String> = located.comparisons.iter().map(|item| item.quantity.to_string()).collect();
            let sides: &[&str] = if located.at.corner.jump_order == 1 { &["plus"] } else { &["minus", "plus"] };
            for name in sides.iter().flat_map(|side| [format!("A_{side}"), format!("B_{side}")]) {
                assert!(quantities.contains(&name), "{name} of {quantities:?}");
            }
            scenarios.push((located.at.corner.jump_order, located.local.clone()));
        }
    }
    // Orders 1, 2 and 3 are met, and each is what it must be.
    for order in [1, 2, 3] {
        assert!(scenarios.iter().any(|(met, _)| *met == order), "order {order}");
    }
    for (order, local) in scenarios {
        match order {
            1 => assert_eq!(local, Happens::Gap),
            2 => assert!(matches!(local, Happens::BorderCollision(Ok(_)))),
            _ => assert_eq!(local, Happens::Smooth),
        }
    }
}

/// At a corner of jerk and above the matrices are one; at a corner of acceleration the jump is the border's.
#[test]
#[ignore = "slow"]
fn only_a_corner_of_acceleration_has_two_matrices() {
    for located in surveyed(&common::read(law("table-cubic").as_ref()), 672.0, 674.0, 1).found {
        assert!(located.at.corner.jump_order == 3 && (located.map.plus.a - located.map.minus.a).norm() < 1e-10);
    }
    for located in surveyed(&common::osorio(), 600.0, 760.0, 1).found {
        let Happens::BorderCollision(Ok(kind)) = located.local else { panic!("{:?}", located.local) };
        let (c, (e, _)) = (located.map.c(), kind.border);
        assert!((c[0] * e[1] - c[1] * e[0]).abs() < 1e-10 * c.norm() * e.norm(), "one direction");
        assert!(located.comparisons.iter().any(|item| item.quantity.to_string() == "border"));
    }
}

/// Feigin's fold, against orbits: at a nonsmooth fold of a two-impact orbit both fixed points are on one side of the speed.
#[test]
fn orbits_exist_where_the_classification_says() {
    use corner_impact::orbit::near::close;
    use corner_impact::simulate::{Machine, angular_velocity};
    let model = common::osorio();
    let found = surveyed(&model, 730.0, 740.0, 1);
    let located = found.found.iter().find(|located| located.at.cycle.impacts.len() == 2).unwrap();
    let Happens::BorderCollision(Ok(verdict)) = &located.local else { panic!("{:?}", located.local) };
    assert_eq!(verdict.scenario, Scenario::NonsmoothFold);
    let machine = Machine::new(common::cam(&model), &model.follower, 1.0);
    let count = |rpm: f64| {
        let machine = machine.at_speed(angular_velocity(rpm));
        let sides = [0, 1].map(|back| {
            let mut guess = located.at.cycle.clone();
            guess.impacts[located.at.impact].segment -= back;
            close(&machine, &guess)
        });
        sides.iter().flatten().count()
    };
    let (slower, faster) = (count(located.at.speed_rpm() - 0.01), count(located.at.speed_rpm() + 0.01));
    let expected = |name: &str| {
        [verdict.minus.exists_for.to_string(), verdict.plus.exists_for.to_string()]
            .iter()
            .filter(|side| **side == name)
            .count()
    };
    assert_eq!((slower, faster), (expected("slower"), expected("faster")));
    assert_eq!(slower + faster, 2);
}

/// What `verify` calls the slowest, and its others, are the first of the same list.
#[test]
#[ignore = "slow"]
fn it_finds_what_verify_finds() {
    for file in common::model_files() {
        let model = common::read(&file);
        let study = model.study.unwrap();
        let (first, others) = corner_impact::corner::locate(&model, &common::cam(&model)).unwrap();
        let found = surveyed(&model, study.rpm_min, study.rpm_max, 1);
        for at in [&[first][..], &others].concat() {
            let located =
                found.found.iter().find(|located| located.at.period == at.period && located.at.corner == at.corner);
            let located = located.unwrap_or_else(|| panic!("{file:?}: {} rpm", at.speed_rpm()));
            assert!(located.at == at && located.agrees, "{file:?}: {:?}", located.comparisons);
        }
    }
}

#[test]
#[ignore = "slow"]
fn a_cam_without_corners_has_none_and_says_so() {
    let (code, document) = document(&law("harmonic"), "100:900", "1");
    assert_eq!((code, &document["agrees"]), (Some(0), &true.into()));
    assert_eq!(document["corner_impacts"], serde_json::json!([]));
    let page = String::from_utf8(locate(&[&law("harmonic"), "--rpm", "100:900"]).stdout).unwrap();
    assert!(page.contains("Found (0)") && page.contains("The cam has no corner"), "{page}");
}

#[test]
fn a_corner_that_is_only_grazed_is_refused_with_the_reason() {
    // Slack where the dwell is: the follower rests on the corner at 90 degrees at any speed.
    let model = common::osorio_with(&[("rest_position", "0.4")]);
    let found = surveyed(&model, 600.0, 760.0, 1);
    let grazes: Vec<_> = found.looked_at.rejected.iter().filter(|rejected| rejected.why.contains("graze")).collect();
    assert!(!grazes.is_empty(), "{:?}", found.looked_at.rejected);
    for graze in grazes {
        assert!(found.found.iter().all(|located| (located.at.speed_rpm() - graze.speed_rpm).abs() > 1e-9), "{graze:?}");
    }
}

/// Where the velocity jumps, an orbit may close through the cam's other side, and the reason names it.
#[test]
#[ignore = "slow"]
fn an_orbit_out_of_the_other_side_is_refused_with_the_reason() {
    let found = surveyed(&common::read(law("rectified-sine").as_ref()), 4.1, 4.3, 1);
    let through = |angle: f64| {
        let near = |speed: f64| (speed - 4.207501).abs() < 1e-6;
        found.looked_at.rejected.iter().any(|at| {
            near(at.speed_rpm)
                && (at.cam_angle - angle).abs() < 1e-9
                && at.why.contains("from inside the cam on its other side")
        })
    };
    assert!(through(0.0) && through(std::f64::consts::PI), "{:?}", found.looked_at.rejected);
}

#[test]
#[ignore = "slow"]
fn the_page_says_what_was_looked_at() {
    let output = locate(&[MODEL, "--rpm", "600:760"]);
    assert_eq!(output.status.code(), Some(0));
    let page = String::from_utf8(output.stdout).unwrap();
    assert!(page.contains("673.234445004") && page.contains("nonsmooth-fold") && page.contains("agree"), "{page}");
    assert!(page.contains("634.331399 rpm") && page.contains("would come out of the cam"), "{page}");
    let words = crate::common::in_one_line(&page);
    assert!(words.contains("Orbits of one impact: the list is proved to be complete."), "{page}");
    assert!(
        words.contains("each 2 % above the one before")
            && words.contains("too few for an estimate of how many both missed"),
        "{page}"
    );
    assert!(page.lines().all(|line| line.chars().count() <= 100), "{page}");
}

/// No search at the grid's speeds comes upon the branch of this orbit of five impacts; shots from the corner do.
#[test]
#[ignore = "slow"]
fn what_one_way_of_looking_misses_the_other_finds() {
    let found = surveyed(&common::osorio(), 294.0, 295.5, 1);
    let is_it =
        |it: &&LocatedImpact| (it.at.speed_rpm() - 294.280557836).abs() < 1e-8 && it.at.cycle.impacts.len() == 5;
    let by_shots = found.found.iter().find(is_it);
    assert!(by_shots.is_some_and(|it| it.agrees), "{:?}", found.found);
    assert_eq!(by_shots.unwrap().at.ways, [Way::Shot]);
    // What both found is there once, and counted under both.
    let recaptured = found.looked_at.recaptured();
    assert_eq!((recaptured[&4].branches, recaptured[&4].shots, recaptured[&4].both), (1, 1, 1), "{recaptured:?}");
    assert_eq!((recaptured[&5].branches, recaptured[&5].shots, recaptured[&5].both), (0, 1, 0), "{recaptured:?}");
    let page = corner_impact_cli::show::Paged::text(&found).unwrap();
    let words = crate::common::in_one_line(&page);
    assert!(words.contains("By shots alone: 2."), "{page}");
}

/// One impact is on the seam at angle 0, where rounding decides which revolution it is in.
#[test]
#[ignore = "slow"]
fn what_both_ways_find_is_one() {
    let model = common::read("models/laws/program.toml".as_ref());
    let found = surveyed(&model, 1329.0, 1330.5, 1).found;
    let there: Vec<_> = found.iter().filter(|it| (it.at.speed_rpm() - 1329.750507842).abs() < 1e-6).collect();
    let [it] = there[..] else { panic!("{} of them", there.len()) };
    assert_eq!((it.at.ways.as_slice(), it.at.corner.angle), ([Way::Branch, Way::Shot].as_slice(), 0.0));
}

/// Chapman's 60 * 70 / 58 - 1 less the 59 + 69 - 57 that are known: 12 * 2 / 58.
#[test]
fn what_two_catches_share_tells_what_is_missing() {
    let missing = Recaptured { branches: 59, shots: 69, both: 57 }.missing();
    approx::assert_relative_eq!(missing, 24.0 / 58.0, max_relative = 1e-15);
}

#[test]
fn a_disagreement_is_said_and_ends_with_1() {
    use corner_impact_cli::show::Paged;
    let model = common::osorio();
    let mut found = surveyed(&model, 672.0, 674.0, 1);
    let item = found.found[0].comparisons.iter_mut().find(|item| item.quantity.to_string() == "A_plus").unwrap();
    item.agrees = false;
    (found.found[0].agrees, found.agrees) = (false, false);
    let page = found.text().unwrap();
    assert!(!found.agrees && page.contains("DISAGREE. A_plus: "), "{page}");
}

/// Speed, corner and number of impacts of each corner impact of a range.
fn met(model: &Model, [low, high]: [f64; 2], revolutions: u64) -> Vec<(f64, f64, usize)> {
    let range = Study { rpm_min: low, rpm_max: high };
    let found = range::find_corner_impacts(model, &common::cam(model), range, revolutions, &Unwatched).unwrap().found;
    found.iter().map(|at| (at.speed_rpm(), at.corner.angle, at.cycle.impacts.len())).collect()
}

/// The parts of a range, together, have what the whole has: two, and in `make properties` 2, 4 and 8.
#[track_caller]
fn parts_are_the_whole(model: &Model, range: [f64; 2], revolutions: u64, least: usize) {
    let whole = met(model, range, revolutions);
    assert!(whole.len() >= least, "{}: {whole:?}", model.name);
    let counts = if crate::common::is_whole() { &[2, 4, 8][..] } else { &[2] };
    for &count in counts {
        let end = |index: i32| range[0] + (range[1] - range[0]) * f64::from(index) / f64::from(count);
        let parts: Vec<_> = (0..count).flat_map(|i| met(model, [end(i), end(i + 1)], revolutions)).collect();
        assert_eq!(whole.len(), parts.len(), "{} in {count}: {whole:?} {parts:?}", model.name);
        for (one, other) in whole.iter().zip(&parts) {
            assert!((one.0 - other.0).abs() <= 1e-9 * one.0, "{} in {count}: {one:?} {other:?}", model.name);
            assert_eq!((one.1, one.2), (other.1, other.2), "{} in {count}", model.name);
        }
    }
}

#[test]
#[ignore = "slow"]
fn a_part_of_a_range_has_its_part_of_the_corner_impacts() {
    parts_are_the_whole(&common::osorio(), [600.0, 760.0], 1, 2);
    parts_are_the_whole(&common::tutorial("own.toml"), [1290.0, 1380.0], 1, 5);
}

/// Shots are made beyond either end of a range, as far as Newton's method may go from one.
#[test]
#[ignore = "slow"]
fn a_range_around_one_corner_impact_has_it_by_the_same_ways() {
    let model = common::read("models/sharp-nose.toml".as_ref());
    let find = |rpm_min: f64, rpm_max: f64| {
        range::find_corner_impacts(&model, &common::cam(&model), Study { rpm_min, rpm_max }, 1, &Unwatched)
            .unwrap()
            .found
    };
    let whole = find(222.0, 228.0);
    assert!(whole.iter().any(|at| at.ways == [Way::Shot]), "{whole:?}");
    for at in &whole {
        let alone = find(at.speed_rpm() * (1.0 - 1e-7), at.speed_rpm() * (1.0 + 1e-7));
        let ways = alone.iter().find(|it| it.cycle.is_same(&at.cycle)).map(|it| &it.ways[..]);
        assert_eq!(ways, Some(&at.ways[..]), "{} rpm: {alone:?}", at.speed_rpm());
    }
}

/// One model of each kind of cam that has corners, and orbits that repeat after two revolutions; `make properties` has wider ranges, and
/// more models.
#[test]
#[ignore = "slow"]
fn parts_of_ranges_have_their_parts_of_the_corner_impacts() {
    let mut ranges = vec![
        ("osorio-2008", [690.0, 760.0], 4, 8),
        ("persistence", [450.0, 600.0], 2, 2),
        ("laws/program", [2100.0, 2500.0], 1, 3),
        ("laws/polynomial", [340.0, 420.0], 1, 10),
        ("laws/rectified-sine", [13.0, 20.0], 1, 2),
        ("laws/table-quintic", [690.0, 694.0], 1, 3),
    ];
    if crate::common::is_whole() {
        ranges.extend([
            ("damped-light", [560.0, 760.0], 1, 2),
            ("nonsmooth-flip", [800.0, 950.0], 4, 4),
            ("laws/program", [1700.0, 2100.0], 1, 6),
            ("laws/rectified-sine", [4.0, 13.0], 1, 4),
            ("laws/table-quintic", [650.0, 700.0], 1, 48),
            ("ballistic", [300.0, 400.0], 2, 50),
        ]);
    }
    for (name, range, revolutions, least) in ranges {
        let file = format!("{}/models/{name}.toml", common::ROOT);
        parts_are_the_whole(&common::read(file.as_ref()), range, revolutions, least);
    }
}

#[test]
fn bad_ranges_are_refused() {
    for range in ["600", "760:600", "0:100", "-5:10", "600:600", "a:b", "1:inf", "nan:700"] {
        let output = locate(&[MODEL, &format!("--rpm={range}")]);
        assert_eq!(output.status.code(), Some(2), "{range}");
        assert!(output.stdout.is_empty() && String::from_utf8(output.stderr).unwrap().contains("--rpm"), "{range}");
    }
    for revolutions in ["0", "1001", "x"] {
        let output = locate(&[MODEL, "--rpm", "600:700", "--revolutions", revolutions]);
        assert_eq!(output.status.code(), Some(2), "{revolutions}");
    }
    let output = locate(&[MODEL, "--rpm", "1e-9:700"]);
    let words = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(2) && words.contains("spans too much"), "{words}");
    // As a range, whatever the command line makes of it.
    for (rpm_min, rpm_max) in [(700.0, 600.0), (0.0, 700.0), (600.0, f64::INFINITY), (600.0, 600.0), (f64::NAN, 600.0)]
    {
        let range = Study { rpm_min, rpm_max };
        let found = corner_impact::study::locate::locate(&common::osorio(), range, 1, &Unwatched);
        assert!(matches!(found, Err(LocateRangeError::Range(RangeError::NoRange { .. }))), "{rpm_min} {rpm_max}");
    }
}

#[test]
#[ignore = "slow"]
fn routes_agree_where_a_follower_chatters_before_the_corner() {
    for (name, low, high, impacts) in [("own.toml", 1290.0, 1380.0, 12), ("measured.toml", 1320.0, 1480.0, 10)] {
        let survey = surveyed(&common::tutorial(name), low, high, 1);
        let off = survey
            .found
            .iter()
            .filter(|located| !located.agrees)
            .map(|located| (located.at.speed_rpm(), &located.comparisons));
        assert_eq!(off.collect::<Vec<_>>(), [], "{name}");
        assert!(survey.found.iter().any(|located| located.at.cycle.impacts.len() >= impacts));
    }
}

/// The speeds of the grid are half-way between whole powers of 1.02, eight of them make a cell, and two more on either side are looked at.
#[test]
fn orbits_are_searched_for_at_the_speeds_of_a_whole_cell_and_its_margins() {
    let model = common::read(law("polynomial").as_ref());
    let searched = surveyed(&model, 620.0, 622.0, 1).looked_at.searched;
    let cell = (621.0_f64.ln() / 1.02_f64.ln() / 8.0).floor();
    let expected: Vec<f64> = (-2..10).map(|step| 1.02_f64.powf(8.0 * cell + f64::from(step) + 0.5)).collect();
    assert_eq!(searched.speeds.len(), expected.len(), "{:?}", searched.speeds);
    assert!(searched.speeds.iter().zip(&expected).all(|(one, two)| (one / two - 1.0).abs() < 1e-12), "{searched:?}");
    assert!((1..=searched.speeds.len()).contains(&searched.branches) && searched.failed.is_none(), "{searched:?}");
}

/// A cam whose numbers were typed to ten digits is one cam on either side of a joint: the routes agree as on that of all digits, and find
/// as much.
#[test]
#[ignore = "slow"]
fn numbers_typed_to_ten_digits_change_no_agreement() {
    let text = std::fs::read_to_string(law("polynomial")).unwrap();
    let typed = text.replace("0.06283185307179587", "0.0628318531");
    assert_ne!(text, typed);
    let [exact, typed] = [text, typed].map(|text| {
        let found = surveyed(&Model::parse("polynomial.toml", &text).unwrap(), 390.0, 450.0, 1).found;
        assert!(found.len() >= 4 && found.iter().all(|it| it.agrees), "{found:?}");
        found
    });
    assert_eq!(typed.len(), exact.len());
    for (one, other) in typed.iter().zip(&exact) {
        assert!((one.at.speed_rpm() - other.at.speed_rpm()).abs() < 1e-5, "{one:?} {other:?}");
    }
}

/// With much damping a fold has an orbit of period two beside it, which `verify` names as well; the condition of its theorem is small, not 0.
#[test]
fn an_orbit_of_period_two_beside_a_fold_is_named() {
    let verdict = "nonsmooth-fold, with an orbit of period two";
    let page = common::text(locate(&[MODEL, "--set", "damping=100", "--rpm", "680:690"]).stdout);
    assert!(page.contains(verdict), "{page}");
    let output = common::program(["verify", MODEL, "--set", "damping=100", "--no-external"]).output().unwrap();
    let page = common::in_one_line(&common::text(output.stdout));
    assert!(page.contains(verdict) && page.contains("delta_L = 4.86e-4"), "{page}");
}
