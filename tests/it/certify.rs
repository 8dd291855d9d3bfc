//! Is a certificate what it says: right in every digit, narrow, and refused where there is nothing to certify?

use std::f64::consts::{PI, TAU};
use std::path::Path;

use crate::common::{self, corner_impact, in_one_line, text};
use corner_impact::corner::range::find_corner_impacts;
use corner_impact::model::{Model, Study};
use corner_impact::progress::Unwatched;
use corner_impact::study::ModelLabel;
use corner_impact::study::certify::{BITS, Certificate, Certified, ProvedCounts, ProvedOrbits, ProvedResting, certify};
use serde_json::{Value, json};

/// The paper's corner impact, as doubles have it.
const PERIOD: f64 = 0.089_121_999_691_593_72;
/// P, rad.
const CORNER: f64 = 2.621_124_501_166_232_3;

#[track_caller]
fn certified(arguments: &[&str]) -> Value {
    let output = corner_impact([&["certify"], arguments, &["--json"]].concat());
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// What the script says of one place, without the search that leads there.
fn script(model: &Model, place: Value, bits: u32) -> Value {
    let document = json!({ "follower": model.follower, "cam": model.cam, "bits": bits, "candidates": [place] });
    let answer = common::python(&["-B", "derivations/certify.py"], &document);
    let answer: Value = serde_json::from_slice(&answer.stdout).unwrap();
    answer["results"][0].clone()
}

#[track_caller]
fn refused(model: &Model, place: Value, bits: u32, why: &str) {
    let result = script(model, place, bits);
    assert!(result["refused"].as_str().is_some_and(|words| words.contains(why)), "{why}: {result}");
}

/// The radii of all balls in a document.
fn radii(document: &Value) -> Vec<f64> {
    match document {
        Value::Object(fields) if fields.contains_key("rad") => vec![fields["rad"].as_str().unwrap().parse().unwrap()],
        Value::Object(fields) => fields.values().flat_map(radii).collect(),
        Value::Array(entries) => entries.iter().flat_map(radii).collect(),
        _ => Vec::new(),
    }
}

#[track_caller]
fn has(ball: &Value, digits: &str) {
    let mid = ball["mid"].as_str().unwrap();
    assert!(mid.starts_with(digits), "{mid}, not {digits}");
}

fn sign(impact: &Value, name: &str) -> i64 {
    let conditions = impact["conditions"].as_array().unwrap();
    conditions.iter().find(|condition| condition["name"] == name).unwrap()["sign"].as_i64().unwrap()
}

#[test]
#[ignore = "slow"]
fn every_corner_impact_is_proved_to_its_digits() {
    for (model, speed, verdict) in [
        ("damped-light", "680.406599562249702281862", "nonsmooth-fold"),
        ("damped-heavy", "706.478083785854967392434", "nonsmooth-fold"),
        ("overdamped", "667.614255380603524266329", "nonsmooth-fold"),
        ("sharp-nose", "671.370481923295900503392", "nonsmooth-fold"),
        ("preloaded", "701.188784033066269305003", "nonsmooth-fold"),
        ("persistence", "493.827512921678820090498", "persistence"),
        ("nonsmooth-flip", "877.655930381898969268375", "nonsmooth-flip"),
    ] {
        let found = certified(&[&format!("models/{model}.toml")]);
        let impacts = found["corner_impacts"].as_array().unwrap();
        let proved = impacts.iter().find(|impact| impact["speed_rpm"]["mid"].as_str().unwrap().starts_with(speed));
        let proved = proved.unwrap_or_else(|| panic!("{model}: {found}"));
        assert_eq!((proved["verdict"].as_str(), proved["proved"].as_bool()), (Some(verdict), Some(true)), "{model}");
        // By Feigin's counts, there is one where the number of real eigenvalues below -1 is odd.
        let below = ["minus", "plus"].iter().flat_map(|side| proved[side]["eigenvalues"].as_array().unwrap());
        let number = |ball: &Value| ball["mid"].as_str().unwrap().parse::<f64>().unwrap();
        let below = below.filter(|one| number(&one["im"]) == 0.0 && number(&one["re"]) < -1.0).count();
        assert_eq!(proved["period_two_orbit"], below % 2 == 1, "{model}");
        // The flip's numbers are in the thousands.
        assert!(radii(proved).iter().all(|radius| *radius <= 1e-28), "{model}: {:?}", radii(proved));
    }
}

/// `verify` and `locate` name the orbit of period two beside this fold as well.
#[test]
#[ignore = "slow"]
fn an_orbit_of_period_two_beside_a_fold_is_proved() {
    let words = ["certify", "models/osorio-2008.toml", "--set", "damping=100", "--rpm", "680:690"];
    let page = in_one_line(&text(common::program(words).output().unwrap().stdout));
    assert!(page.contains("nonsmooth-fold, with an orbit of period two: the two fixed points meet"), "{page}");
}

#[test]
#[ignore = "slow"]
fn the_paper_s_corner_impacts_are_proved_and_its_solution_inside_of_the_cam_is_not() {
    let found = certified(&["models/osorio-2008.toml"]);
    let [one, two] = &found["corner_impacts"].as_array().unwrap()[..] else { panic!("{found}") };
    has(&one["period_s"], "0.08912199969159371625692048105");
    has(&one["speed_rpm"], "673.2344450038120023278237472");
    has(&one["state"][0], "5.0970078818426217442089424163");
    assert_eq!(one["state"][1]["mid"], "0");
    has(&one["minus"]["A"][0][1], "0.0134653091565451123684");
    has(&one["minus"]["eigenvalues"][0]["re"], "1.0051474054653550140781742965");
    has(&one["plus"]["A"][1][0], "2.3098843370794479080");
    has(&one["minus"]["B"][0], "-51.627579902968250900");
    has(&one["plus"]["B"][1], "-5051.9603090325984825");
    has(&one["C"][0], "-0.13522424749437171215");
    has(&one["D"], "259.74498640162738544");
    assert_eq!(one["verdict"], "nonsmooth-fold");
    assert!(radii(one).iter().all(|radius| *radius <= 1e-28), "{:?}", radii(one));
    assert_eq!((sign(one, "det(I - A-)"), sign(one, "det(I - A+)")), (-1, 1));
    for side in ["minus", "plus"] {
        assert_eq!(one[side]["fixed_point_exists_for"], "faster");
        assert_eq!(one[side]["stable"], side == "plus");
    }
    // Of the velocity, which is 0 but for its radius, no digit is proved, and none is counted.
    let certificate: Certificate = serde_json::from_value(one.clone()).unwrap();
    let map = ["minus", "plus"].map(|side| [&one[side]["A"], &one[side]["B"]]);
    let map = map.iter().flatten().flat_map(|numbers| numbers.as_array().unwrap());
    let map = map.flat_map(|entry| entry.as_array().cloned().unwrap_or_else(|| vec![entry.clone()]));
    let proved = map.chain([one["speed_rpm"].clone(), one["period_s"].clone(), one["state"][0].clone()]);
    let fewest = proved.map(|ball| significant(ball["mid"].as_str().unwrap())).min().unwrap();
    assert!(fewest > 20 && certificate.digits() == fewest, "{fewest} {}", certificate.digits());
    beside_it_both_fixed_points_are_followed(one);
    beside_it_both_fixed_points_are_followed(two);
    has(&two["speed_rpm"], "736.110814038711385786420");
    assert_eq!((two["impacts"].as_array().unwrap().len(), two["verdict"].as_str()), (2, Some("nonsmooth-fold")));
    assert!(radii(two).iter().all(|radius| *radius <= 1e-24), "{:?}", radii(two));
    let [inside] = &found["refused"].as_array().unwrap()[..] else { panic!("{found}") };
    assert!((inside["speed_rpm"].as_f64().unwrap() - 634.331_399).abs() < 1e-6, "{inside}");
    assert!(inside["why"].as_str().unwrap().contains("into the cam"), "{inside}");
}

/// From the first digit that is not 0 on.
fn significant(decimal: &str) -> usize {
    let (mantissa, _) = decimal.split_once('e').unwrap_or((decimal, ""));
    mantissa.replace(['-', '.'], "").trim_start_matches('0').len()
}

/// As far as it is said; `orbit` has the orbits that are told of there, on the side of the corner that is.
#[track_caller]
fn beside_it_both_fixed_points_are_followed(impact: &Value) {
    let (period, corner) = (number(&impact["period_s"]), number(&impact["cam_angle_rad"]));
    let count = impact["impacts"].as_array().unwrap().len();
    for (side, towards) in [("minus", -1.0), ("plus", 1.0)] {
        let followed = &impact[side]["followed"];
        let [within, reach] = ["period_within_s", "cam_angle_within_rad"].map(|name| followed[name].as_f64().unwrap());
        assert!(within > 1e-8 && reach >= 5e-4, "{side}: {followed}");
        for (part, is_there) in [(-0.99, true), (0.99, false)] {
            let rpm = (60.0 / (period + part * within)).to_string();
            let found = corner_impact(["orbit", "models/osorio-2008.toml", "--rpm", &rpm, "--json"]);
            let found: Value = serde_json::from_slice(&found.stdout).unwrap();
            let is_beside = |orbit: &Value| {
                let impacts = orbit["impacts"].as_array().unwrap();
                let beyond = |one: &Value| towards * (one["cam_angle_rad"].as_f64().unwrap() - corner);
                impacts.len() == count && impacts.iter().any(|one| beyond(one) > 0.0 && beyond(one) <= reach)
            };
            assert_eq!(
                found["orbits"].as_array().unwrap().iter().any(is_beside),
                is_there,
                "{side} at {rpm} rpm: {found}"
            );
        }
    }
}

/// A decimal in units of 1e-24.
fn fixed(decimal: &str) -> i128 {
    let (whole, part) = decimal.trim_start_matches('-').split_once('.').unwrap_or((decimal, ""));
    let digits: i128 = format!("{whole}{:0<24.24}", part).parse().unwrap();
    if decimal.starts_with('-') { -digits } else { digits }
}

/// By how many units of its last digit each printed number is off, to a thousandth of a unit: more than doubles can tell.
#[test]
#[ignore = "slow"]
fn the_printed_digits_are_off_by_so_many_units_of_the_last() {
    let found = certified(&["models/osorio-2008.toml"]);
    let proved = &found["corner_impacts"][0];
    let paper = std::fs::read_to_string(Path::new(common::ROOT).join("golden/published/osorio-2008.json")).unwrap();
    let paper: Value = serde_json::from_str(&paper).unwrap();
    let flat = |value: &Value| -> Vec<String> {
        fn mids(value: &Value) -> Vec<String> {
            match value {
                Value::Array(entries) => entries.iter().flat_map(mids).collect(),
                ball => vec![ball["mid"].as_str().unwrap().to_owned()],
            }
        }
        mids(value)
    };
    for (quantity, balls, units) in [
        ("T_star", &proved["period_s"], &[-0.372][..]),
        ("speed_rpm", &proved["speed_rpm"], &[-0.004]),
        ("x_star", &proved["state"], &[-12.174, 0.0]),
        ("A_minus", &proved["minus"]["A"], &[0.239, 0.489, 3.846, 0.239]),
        ("B_minus", &proved["minus"]["B"], &[-0.175, 10.575]),
        ("A_plus", &proved["plus"]["A"], &[-0.589, 0.207, 3.209, -0.589]),
        ("B_plus", &proved["plus"]["B"], &[-0.913, 11.848]),
        ("C", &proved["C"], &[-0.829, -0.282]),
        ("D", &proved["D"], &[-73.854]),
    ] {
        let numbers = paper["numbers"].as_array().unwrap();
        let printed = &numbers.iter().find(|number| number["quantity"] == quantity).unwrap()["printed"];
        let off = printed.as_array().unwrap().iter().zip(flat(balls)).map(|(printed, ball)| {
            let printed = printed.as_str().unwrap();
            let places = printed.split_once('.').map_or(0, |(_, places)| places.len());
            (fixed(printed) - fixed(&ball)) as f64 / 10_f64.powi(24 - places as i32)
        });
        for (off, units) in off.zip(units) {
            assert!((off - units).abs() < 1e-3, "{quantity}: {off}, not {units}");
        }
    }
}

#[test]
#[ignore = "slow"]
fn more_bits_prove_more_digits_and_too_few_prove_nothing() {
    let model = common::osorio();
    let place = json!({ "cam_angle_rad": CORNER, "period_s": PERIOD, "revolutions": 1 });
    for (bits, least, most) in [(53, 1e-11, 1e-7), (400, 0.0, 1e-110)] {
        let all = radii(&script(&model, place.clone(), bits)["certificate"]);
        let largest = all.iter().copied().fold(0.0, f64::max);
        assert!(all.len() > 40 && least <= largest && largest <= most, "{bits}: {largest}");
    }
    let result = script(&model, place, 18);
    let why = result["refused"].as_str().unwrap();
    assert!(
        ["is not decided", "bits are too few", "not proved", "cannot be told"].iter().any(|part| why.contains(part)),
        "{why}"
    );
}

#[test]
#[ignore = "slow"]
fn places_where_there_is_none_are_refused() {
    let model = common::osorio();
    let place = |angle: f64, period: f64| json!({ "cam_angle_rad": angle, "period_s": period, "revolutions": 1 });
    refused(&model, place(CORNER, PERIOD * (1.0 + 1e-4)), 128, "no root of the equations lies in the box searched");
    refused(&model, place(2.6, PERIOD), 128, "no corner of the cam is at 2.6 rad");
    refused(&model, place(3.662_060_806_013_354, 60.0 / 634.331_398_999), 128, "sends the follower into the cam");
    refused(&model, place(CORNER, 60.0 / 224.376_214_135), 128, "meets the cam elsewhere");
    // Without restitution every impact leaves the follower on the cam.
    let plastic = Model::parse("plastic.toml", &common::osorio_text(&[("restitution", "0.0")])).unwrap();
    refused(&plastic, place(CORNER, PLASTIC_PERIOD), 128, "cannot be distinguished from a graze");
}

/// Where a plastic follower that leaves P with the cam's velocity is back at P after a revolution, s.
const PLASTIC_PERIOD: f64 = 0.072_917_459_437_368_74;

fn number(ball: &Value) -> f64 {
    ball["mid"].as_str().unwrap().parse().unwrap()
}

/// The angles of the impacts of a certificate, and of the first a turn on.
fn angles_of(proved: &Value) -> Vec<f64> {
    let mut angles: Vec<f64> =
        proved["impacts"].as_array().unwrap().iter().map(|impact| number(&impact["cam_angle_rad"])).collect();
    angles.push(angles[0] + std::f64::consts::TAU);
    angles
}

/// Where to look for an orbit whose impacts are at these angles.
fn place_of(proved: &Value, angles: &[f64]) -> Value {
    let flight = |(ends, impact): (&[f64], &Value)| json!({ "turn_rad": ends[1] - ends[0], "velocity_after_m_s": number(&impact["velocity_after_m_s"]) });
    let flights: Vec<Value> = angles.windows(2).zip(proved["impacts"].as_array().unwrap()).map(flight).collect();
    json!({ "cam_angle_rad": angles[0], "period_s": number(&proved["period_s"]), "revolutions": 1, "impacts": flights })
}

/// The second parabola has a bump from 200 to 220 degrees, as high as a flight over it.
#[test]
#[ignore = "slow"]
fn a_flight_that_touches_is_refused_and_one_that_is_clear_by_a_hair_is_not() {
    let file = "models/laws/polynomial.toml";
    let found = certified(&[file, "--rpm", "443:444"]);
    let place = place_of(&found["corner_impacts"][0], &angles_of(&found["corner_impacts"][0]));
    let text = std::fs::read_to_string(Path::new(common::ROOT).join(file)).unwrap();
    let with_bump = |height: f64| {
        let width = 20.0_f64.to_radians();
        let bend = -0.02 + height * width * width;
        let bump = [0.146_911_082_647_153_14, -0.013_962_634_015_954_628, bend, -2.0 * height * width, height];
        let after = [0.139_600_264_572_272_15, -0.027_925_268_031_909_27, -0.02];
        let piece = |start: f64, coefficients: &[f64]| {
            format!("[[cam.segment]]\nstart_deg = {start}\ncoefficients = {coefficients:?}\n")
        };
        let (first, second) = text.split_at(text.rfind("[[cam.segment]]").unwrap());
        Model::parse("bump.toml", &[first, &piece(200.0, &bump), &piece(220.0, &after), second].concat()).unwrap()
    };
    const TOUCHING: f64 = 8.455_831_071_557_895;
    refused(&with_bump(TOUCHING), place.clone(), 128, "it may touch");
    refused(&with_bump(TOUCHING * (1.0 + 1e-9)), place.clone(), 128, "meets the cam elsewhere");
    assert!(script(&with_bump(TOUCHING * (1.0 - 1e-9)), place, 128)["certificate"].is_object());
}

/// At this restitution a multiplier of the law before the corner is -1, but for 1e-8.
#[test]
#[ignore = "slow"]
fn a_sign_that_is_not_decided_is_refused() {
    let arguments = ["certify", "--set", "restitution=0.61501779", "--rpm", "687:689", "--bits"];
    let output = corner_impact([&arguments[..], &["26"]].concat());
    let page = text(output.stdout);
    assert!(page.contains("687.927243 rpm at 90.0000 deg: the sign of det(I + A-) is not decided"), "{page}");
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(corner_impact([&arguments[..], &["60"]].concat()).status.code(), Some(0));
}

#[test]
#[ignore = "slow"]
fn a_root_off_the_piece_that_its_equations_are_of_is_refused() {
    let file = "models/laws/polynomial.toml";
    let found = certified(&[file, "--rpm", "443:444"]);
    let proved = &found["corner_impacts"][0];
    let other = angles_of(proved)[1];
    let place = |second: f64| {
        let mut angles = angles_of(proved);
        angles[1] = second;
        place_of(proved, &angles)
    };
    assert!(script(&common::read(Path::new(file)), place(other), 128)["certificate"].is_object());
    // The same cam with its second parabola cut in two, right before the other impact.
    let (cut, [a0, a1, a2]) = (other - 1e-8, [0.1, -0.062_831_853_071_795_87, 0.02_f64]);
    let u = cut - 270.0_f64.to_radians();
    assert!((0.0..1.5).contains(&u), "{other}");
    let (value, slope) = (a0 + u * (a1 + u * a2), a1 + 2.0 * a2 * u);
    let text = std::fs::read_to_string(Path::new(common::ROOT).join(file)).unwrap()
        + &format!("\n[[cam.segment]]\nstart_deg = {}\ncoefficients = [{value}, {slope}, {a2}]\n", cut.to_degrees());
    let cut = Model::parse("cut.toml", &text).unwrap();
    refused(&cut, place(other - 2e-8), 128, "is not on the piece of the cam");
    assert!(script(&cut, place(other), 128)["certificate"].is_object());
}

#[test]
#[ignore = "slow"]
fn a_cam_that_is_typed_is_certified_as_it_is_joined_and_says_so() {
    let found = certified(&["models/laws/polynomial.toml", "--rpm", "443:444"]);
    let assumed = &found["corner_impacts"][0]["assumed"];
    let off = |name: &str| assumed[name].as_f64().unwrap();
    assert!(off("lift_m") > 1e-18 && off("lift_m") < 1e-15 && off("slope_m_rad") < 1e-15, "{assumed}");
    for side in ["minus", "plus"] {
        let followed = &found["corner_impacts"][0][side]["followed"];
        assert!(followed["period_within_s"].as_f64() > Some(1e-7), "{side}: {followed}");
    }
    assert!(certified(&["models/osorio-2008.toml"])["corner_impacts"][0]["assumed"].is_null());
    // Whatever else is proved is about the same cam.
    let others =
        [vec!["--orbits", "--rpm", "670"], vec!["--orbits", "--rpm", "669:670"], vec!["--resting", "--rpm", "100"]];
    for arguments in others {
        let of = |model: &'static str| [vec![model], arguments.clone()].concat();
        assert_eq!(&certified(&of("models/laws/polynomial.toml"))["assumed"], assumed, "{arguments:?}");
        let page = text(corner_impact([vec!["certify"], of("models/laws/polynomial.toml")].concat()).stdout);
        assert!(in_one_line(&page).contains("as typed"), "{page}");
        assert!(certified(&of("models/osorio-2008.toml"))["assumed"].is_null(), "{arguments:?}");
    }
    let page = corner_impact(["certify", "models/laws/polynomial.toml", "--rpm", "443:444"]);
    assert!(in_one_line(&text(page.stdout)).contains("the steps between them as typed"));
}

/// Every document with a proof has what that takes for granted; so have `verify`, which repeats one, and `explain`, of a number of it.
#[test]
#[ignore = "slow"]
fn hypotheses_stand_beside_what_is_proved() {
    let decimals = "the machine's numbers are the decimals of its model file";
    let begins = |found: &Value| found["hypotheses"][0].as_str().is_some_and(|first| first.starts_with(decimals));
    for arguments in [vec!["--rpm", "660:690"], vec!["--orbits", "--rpm", "670"], vec!["--resting", "--rpm", "250"]] {
        let found = certified(&[vec!["models/osorio-2008.toml"], arguments.clone()].concat());
        assert!(begins(&found), "{arguments:?}: {}", found["hypotheses"]);
    }
    let nothing = certified(&["models/osorio-2008.toml", "--rpm", "690:700"]);
    assert_eq!(nothing["hypotheses"], json!([]));
    let of = |arguments: &[&str]| serde_json::from_slice::<Value>(&corner_impact(arguments).stdout).unwrap();
    assert!(begins(&of(&["verify", "--json"])) && begins(&of(&["explain", "T*", "--json"])));
    assert!(of(&["verify", "--json", "--no-external"])["hypotheses"].is_null());
    let page = text(corner_impact(["verify"]).stdout);
    assert!(in_one_line(&page).contains(&format!("Hypotheses: {decimals}")), "{page}");
}

/// The list is found by another program than `orbit`'s, and neither may have an orbit that the other lacks.
#[test]
#[ignore = "slow"]
fn all_orbits_of_one_and_of_two_impacts_are_proved_and_orbit_has_the_same() {
    let file = "models/osorio-2008.toml";
    let found = certified(&[file, "--orbits", "--rpm", "700"]);
    assert_eq!(found["complete"], json!([1, 2]), "{found}");
    let orbits = found["orbits"].as_array().unwrap();
    let first = |orbit: &Value| orbit["impacts"][0]["cam_angle_rad"]["mid"].as_str().unwrap().parse::<f64>().unwrap();
    let mut seen: Vec<(usize, f64, &str)> = orbits
        .iter()
        .map(|orbit| {
            let count = orbit["impacts"].as_array().unwrap().len();
            (count, first(orbit).to_degrees(), orbit["kind"].as_str().unwrap())
        })
        .collect();
    seen.sort_by(|one, other| one.0.cmp(&other.0).then(one.1.total_cmp(&other.1)));
    let kinds: Vec<_> = seen.iter().map(|(count, _, kind)| (*count, *kind)).collect();
    assert_eq!(kinds, [(1, "saddle"), (1, "stable"), (2, "flip")], "{seen:?}");
    for (angle, expected) in [(seen[0].1, 104.160_829_387_844_75), (seen[1].1, 155.303_685_602_748_75)] {
        assert!((angle - expected).abs() < 1e-12, "{angle}");
    }
    let other = corner_impact(["orbit", file, "--rpm", "700", "--json"]);
    let other: Value = serde_json::from_slice(&other.stdout).unwrap();
    let impacts = |orbit: &Value| -> Vec<f64> {
        orbit["impacts"].as_array().unwrap().iter().map(|impact| impact["cam_angle_rad"].as_f64().unwrap()).collect()
    };
    let theirs: Vec<Vec<f64>> = other["orbits"].as_array().unwrap().iter().map(impacts).collect();
    assert_eq!(theirs.iter().filter(|angles| angles.len() <= 2).count(), orbits.len(), "{theirs:?}");
    for orbit in orbits {
        let (count, angle) = (orbit["impacts"].as_array().unwrap().len(), first(orbit));
        let has = |angles: &Vec<f64>| angles.len() == count && angles.iter().any(|other| (other - angle).abs() < 1e-9);
        assert!(theirs.iter().any(has), "{orbit} is none of {theirs:?}");
    }
}

/// Of two saddles next to the corner impact: in doubles it only follows that their map has robust chaos.
#[test]
#[ignore = "slow"]
fn the_hypotheses_of_robust_chaos_are_proved_with_the_matrices() {
    for model in ["models/damped-heavy.toml", "models/overdamped.toml"] {
        let found: Value = serde_json::from_slice(&corner_impact(["verify", model, "--json"]).stdout).unwrap();
        assert_eq!(found["local_map"][0]["robust_chaos"]["known"], "proved", "{model}");
    }
}

#[test]
fn without_python_it_says_so() {
    let output = common::program(["certify"]).env("CORNER_IMPACT_PYTHON", "/nonexistent/python").output().unwrap();
    assert_eq!((output.status.code(), output.stdout.as_slice()), (Some(2), &[][..]));
    let words = text(output.stderr);
    assert!(words.contains("/nonexistent/python") && words.contains("did not start"), "{words}");
}

#[test]
#[ignore = "slow"]
fn without_python_flint_it_says_so() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("flint.py"), "raise ImportError\n").unwrap();
    let certify = |python: Option<&str>| {
        let mut command = common::program(["certify"]);
        command.env("PYTHONPATH", folder.path()).env_remove("CORNER_IMPACT_PYTHON");
        command.envs(python.map(|python| ("CORNER_IMPACT_PYTHON", python))).output().unwrap()
    };
    // Only an interpreter that somebody chose looks into PYTHONPATH.
    assert_eq!(certify(None).status.code(), Some(0));
    let output = certify(Some(".venv/bin/python"));
    assert_eq!((output.status.code(), output.stdout.as_slice()), (Some(2), &[][..]));
    let words = text(output.stderr);
    assert!(
        words.contains("the Python package python-flint is missing")
            && words.contains("`make verify` sets up Python and its packages"),
        "{words}"
    );
}

/// A smoothing spline is near the rows, where no proof knows how: refused by name before a script runs.
#[test]
fn splines_near_the_rows_are_not_proved() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("valve.toml");
    let file = file.to_str().unwrap();
    assert!(common::corner_impact(["new", file, "--law", "table"]).status.success());
    for asked in [["--resting", "--rpm", "3500"], ["--orbits", "--rpm", "3500"]] {
        let output = common::corner_impact(["certify", file].iter().chain(&asked));
        let says = common::text(output.stderr);
        assert_eq!(output.status.code(), Some(2), "{says}");
        assert!(
            says.contains("cam.spline = \"smoothing\": proofs are for cubic or quintic splines through the rows"),
            "{says}"
        );
    }
}

/// Of a thousand rows a proof is tried, which takes Python; of more it is not.
#[test]
fn splines_through_a_thousand_rows_are_proved_and_of_more_are_not() {
    let folder = tempfile::tempdir().unwrap();
    for (rows, says) in
        [(1000, "/nonexistent/python"), (1001, "proofs are for cubic or quintic splines through the rows")]
    {
        let lift = |row: u32| 0.1 + 0.02 * (std::f64::consts::TAU * f64::from(row) / f64::from(rows)).cos();
        let row = |row: u32| format!("[{:?}, {:?}]", 360.0 * f64::from(row) / f64::from(rows), lift(row));
        let rows = (0..rows).map(row).collect::<Vec<_>>().join(", ");
        let follower =
            "[follower]\nmass = 1\ndamping = 0\nstiffness = 1000\ngravity = 0\nrest_position = 0\nrestitution = 0.5\n";
        let file = folder.path().join("rows.toml");
        std::fs::write(&file, format!("{follower}[cam]\nlaw = \"table\"\nspline = \"cubic\"\nrows = [{rows}]\n"))
            .unwrap();
        let mut program = common::program(["certify", file.to_str().unwrap(), "--resting", "--rpm", "3500"]);
        let output = program.env("CORNER_IMPACT_PYTHON", "/nonexistent/python").output().unwrap();
        let words = text(output.stderr);
        assert!(output.status.code() == Some(2) && words.contains(says), "{words}");
    }
}

/// Only where after each release another is known.
#[test]
fn motions_that_rest_all_repeat_where_each_release_has_a_next() {
    let next = json!({ "impacts": 3, "rests_by_rad": 1.0, "release": 0, "revolutions": 1 });
    let release = |next: &Value| json!({ "cam_angle_rad": { "mid": "2.0", "rad": "1e-30" }, "next": next });
    for (second, all) in [(next.clone(), true), (Value::Null, false)] {
        let releases = [release(&next), release(&second)];
        let document = json!({ "speed_rpm": 100.0, "bits": 128, "pressed_rad": [], "releases": releases, "looked_at": 9, "periodic": [] });
        let proved: ProvedResting = serde_json::from_value(document).unwrap();
        assert_eq!(proved.all_repeat(), all);
    }
}

/// A proof is of an acceleration that jumps. What is refused at a kink of a cam that has such a corner elsewhere is not asked for.
#[test]
fn what_is_refused_where_the_velocity_jumps_is_not_asked_for() {
    // From a kink up with a slope of 0.01, over 180 degrees with the same slope on both sides, and down to the kink with -0.04.
    let (slope, square, end) = (0.01, -0.001, -0.04);
    let (top, over) = (slope * PI + square * PI * PI, slope + 2.0 * square * PI);
    let second = -3.0 * top / (PI * PI) - (2.0 * over + end) / PI;
    let third = (end - over - 2.0 * second * PI) / (3.0 * PI * PI);
    let document = json!({
        "follower": { "mass": 1, "damping": 0, "stiffness": 0, "gravity": 9.81, "rest_position": 0, "restitution": 0.5 },
        "cam": { "law": "polynomial", "segment": [
            { "start_deg": 0.0, "coefficients": [0.1, slope, square, 0.0] },
            { "start_deg": 180.0, "coefficients": [0.1 + top, over, second, third] },
        ] },
    });
    let model = Model::of_document("kink", &document).unwrap();
    let orders: Vec<usize> = common::cam(&model).corners().iter().map(|corner| corner.jump_order).collect();
    assert_eq!(orders, [1, 2]);
    // 3 c' = g T/2
    let rpm = 60.0 / (6.0 * TAU * slope / 9.81_f64).sqrt();
    let range = Study { rpm_min: rpm - 0.01, rpm_max: rpm + 0.01 };
    assert_eq!(find_corner_impacts(&model, &common::cam(&model), range, 1, &Unwatched).unwrap().rejected.len(), 1);
    let found = certify(&model, range, 1, BITS, &Unwatched).unwrap();
    assert!(found.corner_impacts.is_empty() && found.agrees());
    assert_eq!(found.refused, []);
}

/// The preload, the units and digits beyond those of a double reach the proof as they are written.
#[test]
#[ignore = "slow"]
fn a_proof_is_of_the_numbers_that_are_written() {
    let folder = tempfile::TempDir::new().unwrap();
    let period = |changes: &[(&str, &str)], rpm: &str, set: &[&str]| {
        let mut text = common::osorio_text(&[]);
        for (old, new) in changes {
            assert!(text.contains(old), "{old}");
            text = text.replacen(old, new, 1);
        }
        let file = folder.path().join("model.toml");
        std::fs::write(&file, text).unwrap();
        let found = certified(&[&[file.to_str().unwrap(), "--rpm", rpm], set].concat());
        found["corner_impacts"][0]["period_s"]["mid"].as_str().unwrap()[..32].to_owned()
    };
    let right = "0.089121999691593716256920481050";
    let preload = ("rest_position = 0.3", "preload = 143.08");
    assert_eq!(period(&[preload], "672:675", &[]), right);
    // A pound is 0.45359237 kg.
    let units = "[units]\nmass = \"lb\"\nforce = \"kN\"\nstiffness = \"N/mm\"\n\n[follower]";
    let stiffness = ("stiffness = 1430.8", "stiffness = 1.4308");
    let pounds = [("[follower]", units), stiffness, ("rest_position = 0.3", "preload = 0.14308")];
    let kilograms = [("mass = 1.221", "mass = 0.55383628377")];
    assert_eq!(period(&pounds, "998:1001", &[]), period(&kilograms, "998:1001", &[]));
    let long = "1.22100000000000000000000123";
    let in_file = period(&[("mass = 1.221", &format!("mass = {long}"))], "672:675", &[]);
    assert_eq!(in_file, period(&[], "672:675", &["--set", &format!("mass={long}")]));
    assert_ne!(in_file, right);
}

/// A document has the hypotheses of its proofs: the decimals, the mechanics, the cam where its pieces are typed, and of motions that rest that
/// impacts without end put them there. Where nothing is proved there are none.
#[test]
fn a_document_has_the_hypotheses_of_its_proofs() {
    let ball = || json!({ "mid": "1.0", "rad": "1e-30" });
    let side = json!({
        "A": [[ball(), ball()], [ball(), ball()]],
        "B": [ball(), ball()],
        "eigenvalues": [{ "re": ball(), "im": ball() }, { "re": ball(), "im": ball() }],
        "fixed_point_exists_for": "faster",
        "stable": true,
        "followed": null,
    });
    let certified = |impacts: Vec<Certificate>| Certified {
        model: ModelLabel { name: "model".into(), source: "nowhere".into() },
        range: Study { rpm_min: 600.0, rpm_max: 700.0 },
        bits: BITS,
        corner_impacts: impacts,
        refused: Vec::new(),
    };
    for assumed in [Value::Null, json!({ "lift_m": 2.5e-9, "slope_m_rad": 7.5e-8 })] {
        let certificate: Certificate = serde_json::from_value(json!({
            "speed_rpm": ball(), "period_s": ball(), "cam_angle_rad": ball(), "alone_within": 1e-3, "revolutions": 1,
            "section_angle_rad": ball(), "state": [ball(), ball()], "state_origin_m": ball(), "impacts": [],
            "minus": side, "plus": side, "C": [ball(), ball()], "D": ball(), "border": [ball(), ball(), ball()],
            "conditions": [], "verdict": "persistence", "period_two_orbit": false, "assumed": assumed, "proved": true,
        }))
        .unwrap();
        let orbits = json!({ "orbits": [], "complete": [1], "undecided": [], "assumed": assumed });
        let counts = json!({ "counts": [], "undecided": [], "events": [], "assumed": assumed });
        let resting = json!({ "bits": 128, "pressed_rad": [], "releases": [], "looked_at": 9, "periodic": [], "assumed": assumed });
        let documents = [
            serde_json::to_value(certified(vec![certificate])),
            serde_json::to_value(serde_json::from_value::<ProvedOrbits>(orbits).unwrap()),
            serde_json::to_value(serde_json::from_value::<ProvedCounts>(counts).unwrap()),
            serde_json::to_value(serde_json::from_value::<ProvedResting>(resting).unwrap()),
        ];
        for (index, document) in documents.into_iter().enumerate() {
            let document = document.unwrap();
            let mut told = document["hypotheses"].as_array().unwrap().iter().map(|it| it.as_str().unwrap());
            let mut says =
                |words: &str| assert!(told.next().is_some_and(|it| it.contains(words)), "{words}: {document}");
            says("the machine's numbers are the decimals of its model file");
            says("free flight follows the equation of motion");
            if !assumed.is_null() {
                says("up to 2.5e-9 m and 7.5e-8 m/rad");
            }
            if index == 3 {
                says("impacts that follow each other without end put the follower to rest");
            }
            assert_eq!(told.next(), None);
        }
    }
    assert_eq!(serde_json::to_value(certified(Vec::new())).unwrap()["hypotheses"], json!([]));
}
