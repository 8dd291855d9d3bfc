//! Does `compare` tell what moved, as `verify` and `design` have it of either model, and by how much more than it may be off?

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::common;
use corner_impact::agreement::Quantity;
use corner_impact::model::Model;
use corner_impact::progress::Unwatched;
use corner_impact::study::compare::{ModelComparison, NoVerdict, compare, spreads};
use corner_impact::study::verify::{External, verify};

const PAPER: &str = "models/osorio-2008.toml";

#[track_caller]
fn document(arguments: &[&str]) -> Value {
    // The routes in Python take seconds; one test below runs them.
    let quick = arguments.first().filter(|command| **command == "compare").map(|_| "--no-external");
    let output = common::corner_impact(arguments.iter().copied().chain(quick).chain(["--json"]));
    let complaints = common::text(output.stderr);
    assert_eq!((output.status.code(), complaints.as_str()), (Some(0), ""), "{arguments:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// What is told of a quantity, and whether as a change.
#[track_caller]
fn told<'a>(found: &'a Value, quantity: &str) -> (&'a Value, bool) {
    let of = |list: &str| found[list].as_array().unwrap().iter().find(|change| change["quantity"] == quantity);
    match (of("changes"), of("unchanged")) {
        (Some(change), None) => (change, true),
        (None, Some(change)) => (change, false),
        _ => panic!("{quantity} is not told once"),
    }
}

/// Every entry of the map, the orbit, the eigenvalues, the normal form and the separation, as the other commands have it.
#[test]
fn numbers_are_those_of_both_models() {
    let (a, b) = ([PAPER].as_slice(), [PAPER, "--set", "restitution=0.7"].as_slice());
    let found = document(&[&["compare"], b].concat());
    assert_eq!(found["schema"], "corner-impact/compare/1");
    assert_eq!(found["verdict"], json!({ "a": "nonsmooth-fold", "b": "nonsmooth-fold" }));
    assert_eq!(found["fields"], json!([{ "field": "follower.restitution", "a": 0.8, "b": 0.7 }]));
    let of = |command: &[&str]| [a, b].map(|model| document(&[command, model].concat()));
    let (verified, designed) = (of(&["verify", "--no-external"]), of(&["design", "--rpm", "90:100"]));
    let mut names = vec![
        ("T_star".to_owned(), "/corner_impact/period_s".to_owned()),
        ("speed_rpm".into(), "/corner_impact/speed_rpm".into()),
        ("x_star_1".into(), "/corner_impact/state/0".into()),
        ("D".into(), "/routes/closed_form/D".into()),
        ("B_tilde_2".into(), "/normal_form/B_tilde/1".into()),
        ("eigenvalues_plus_1_im".into(), "/eigenvalues/plus/0/im".into()),
        ("det(I - A-)".into(), "/conditions/2/value".into()),
        ("second_derivatives_minus_213".into(), "/second_order/minus/second_derivatives/1/0/2".into()),
        ("linear_range_fixed-point-plus_1_faster_0.1".into(), "/linear_range/2/speed_rpm".into()),
    ];
    for side in ["minus", "plus"] {
        for (row, column) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let place = format!("/routes/closed_form/{side}/A/{row}/{column}");
            names.push((format!("A_{side}_{}{}", row + 1, column + 1), place));
        }
        names
            .extend([0, 1].map(|row| (format!("B_{side}_{}", row + 1), format!("/routes/closed_form/{side}/B/{row}"))));
    }
    for (name, place) in names {
        let (change, is_one) = told(&found, &name);
        let [x, y] = verified.each_ref().map(|document| document.pointer(&place).unwrap().as_f64().unwrap());
        assert_eq!(
            [&change["a"], &change["b"], &change["difference"]],
            [&json!(x), &json!(y), &json!(y - x)],
            "{name}"
        );
        assert!(is_one, "{name}");
        // As far as its routes agree, a number of the map is known.
        let is_of_one_route = name.contains("second") || name.contains("range");
        assert_eq!(change["error"].is_null(), is_of_one_route, "{name}");
        if let Some(error) = change["error"].as_f64() {
            assert!(error > 0.0 && error < 1e-6 * x.abs().max(y.abs()), "{name}: {error}");
            assert!((change["times_error"].as_f64().unwrap() * error - (y - x).abs()).abs() < 1e-9 * error.max(1.0));
        }
    }
    // The error of A21 is what its routes differ by, of both models.
    let spread = |document: &Value| {
        let routes =
            document["routes"].as_object().unwrap().values().map(|it| it["minus"]["A"][1][0].as_f64().unwrap());
        let (least, most) = routes.fold((f64::MAX, f64::MIN), |(least, most), it| (least.min(it), most.max(it)));
        most - least
    };
    let error = told(&found, "A_minus_21").0["error"].as_f64().unwrap();
    approx::assert_relative_eq!(error, verified.iter().map(spread).sum::<f64>(), max_relative = 1e-3);
    // The spring and the cam press as before, whatever the follower does when it comes back.
    for (name, place) in [("separation_speed_rpm", "speed_rpm"), ("separation_cam_angle_rad", "cam_angle_rad")] {
        let (change, is_one) = told(&found, name);
        assert_eq!((&change["b"], is_one), (&designed[1]["separation"][place], false), "{name}");
    }
    // A product of roundings, and what is 1 by definition, have not moved.
    assert!(["B_bar_2", "C_bar_1", "x_star_2", "A_bar_plus_22"].iter().all(|name| !told(&found, name).1));
    // Of two derivatives that are the same by symmetry one is told: six of a matrix, two matrices a side.
    let all = ["changes", "unchanged"].iter().flat_map(|list| found[*list].as_array().unwrap());
    let names = all.map(|change| change["quantity"].as_str().unwrap());
    assert_eq!(names.filter(|name| name.starts_with("second_derivatives")).count(), 24);
    // The speeds come first, and then what moved most, of those whose error is known and of the others.
    let speeds = ["speed_rpm", "separation_speed_rpm"];
    assert!(speeds.contains(&found["changes"][0]["quantity"].as_str().unwrap()), "{}", found["changes"][0]);
    let parts: Vec<(bool, f64)> = found["changes"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|change| !speeds.contains(&change["quantity"].as_str().unwrap()))
        .filter_map(|change| Some((change["error"].is_null(), -change["relative"].as_f64()?.abs())))
        .collect();
    assert!(parts.len() > 80 && parts.is_sorted_by(|one, two| one <= two), "{parts:?}");
}

#[test]
fn a_model_is_no_other_than_itself() {
    let found = document(&["compare", PAPER, PAPER]);
    assert_eq!((&found["changes"], &found["fields"]), (&json!([]), &json!([])));
    assert!(found["unchanged"].as_array().unwrap().len() > 120);
}

/// Another verdict, and none, are answers.
#[test]
fn what_happens_comes_first() {
    let found = document(&["compare", PAPER, "models/persistence.toml"]);
    assert_eq!(found["verdict"], json!({ "a": "nonsmooth-fold", "b": "persistence" }));
    assert_eq!(found["verdict_changed"], true);
    // Neither file says where to look, each in its own words.
    let [harmonic, program] = ["harmonic", "program"].map(|law| format!("models/laws/{law}.toml"));
    assert_eq!(document(&["compare", &harmonic, &program])["verdict_changed"], false);
    assert_eq!(told(&found, "fixed_points_exist_for_minus").0["b"], "slower");
    assert!(found["changes"][0]["difference"].is_null(), "words come first: {}", found["changes"][0]);
    for (model, says) in [
        (
            ["compare", PAPER, "models/laws/harmonic.toml"].as_slice(),
            "no corner impact is looked for: the model has no [study]",
        ),
        (&["compare", PAPER, "--set", "rpm_max=610"], "no corner impact: "),
    ] {
        let found = document(model);
        assert!(found["verdict"]["b"].as_str().unwrap().starts_with(says), "{}", found["verdict"]);
        let (change, is_one) = told(&found, "A_minus_21");
        assert!(is_one && change["b"].is_null() && change["difference"].is_null(), "{change}");
        // The cam and the force on it are known all the same.
        assert!(told(&found, "separation_speed_rpm").0["b"].is_number());
    }
}

/// Routes that should have run and did not leave both verdicts unverified, and the exit code says so.
#[test]
fn what_is_not_verified_is_told() {
    let mut command = common::program(["compare", PAPER, "--set", "restitution=0.7", "--external", "--json"]);
    let output = command.env("CORNER_IMPACT_PYTHON", "/nonexistent/python").output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", common::text(output.stderr));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let verdict = "nonsmooth-fold; not verified: routes disagree or did not run";
    assert_eq!(found["verdict"], json!({ "a": verdict, "b": verdict }));
    assert!(told(&found, "A_minus_21").1);
}

#[test]
fn answers_are_in_the_units_of_the_first() {
    let folder = TempDir::new().unwrap();
    let write = |name: &str, units: &str, changes: &[(&str, &str)]| {
        let file = folder.path().join(name);
        fs::write(&file, format!("{}\n[units]\n{units}", common::osorio_text(changes))).unwrap();
        file.to_str().unwrap().to_owned()
    };
    let metres = write("m.toml", "length = \"m\"\nangle = \"deg\"\nforce = \"kN\"\n", &[]);
    let grams = write("g.toml", "mass = \"g\"\n", &[("mass", "1221.0")]);
    let inches = write("in.toml", "length = \"in\"\n", &[]);
    let found = document(&["compare", &metres, &grams]);
    let words: Vec<&str> = found["fields"].as_array().unwrap().iter().map(|it| it["field"].as_str().unwrap()).collect();
    assert!(!words.contains(&"follower.mass") && words.contains(&"units.mass"), "{words:?}");
    assert_eq!(found["changes"], json!([]), "one machine in other units");
    assert!((told(&found, "cam_angle_deg").0["b"].as_f64().unwrap() - 150.179371).abs() < 1e-6);
    let preload = told(&found, "preload_kn").0;
    assert!((preload["b"].as_f64().unwrap() - 0.14308).abs() < 1e-9, "{preload}");
    let refused = common::corner_impact(["compare", &metres, &inches]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(common::text(refused.stderr).contains("lengths are in \"m\" in the one and in \"in\" in the other"));
    let alone = common::corner_impact(["compare", PAPER]);
    assert_eq!(alone.status.code(), Some(2));
}

/// A cam and what is measured of it differ by no more than the measurement leaves open; another spring differs by more.
#[test]
#[ignore = "slow"]
fn what_a_measured_cam_leaves_open_is_no_change() {
    let cam = corner_impact::cam::Cam::new(&common::osorio()).unwrap();
    let rows = |places: i32| -> Vec<[f64; 2]> {
        let rounded = |lift: f64| (lift * 10f64.powi(places)).round() / 10f64.powi(places);
        (0..360).map(f64::from).map(|angle| [angle, rounded(cam.lift(angle.to_radians()).value)]).collect()
    };
    let of_rows = |rows: Vec<[f64; 2]>, stiffness: f64| {
        let follower = json!({ "mass": 1.221, "damping": 0, "stiffness": stiffness, "gravity": 0, "rest_position": 0.3, "restitution": 0.8 });
        let cam = json!({ "law": "table", "spline": "smoothing", "rows": rows });
        Model::of_document("measured", &json!({ "follower": follower, "cam": cam })).unwrap()
    };
    let machine = |places: i32, stiffness: f64| of_rows(rows(places), stiffness);
    let compared =
        |b: &Model| -> ModelComparison { compare(&machine(5, 1430.8), b, External::LeftOut, &Unwatched).unwrap() };
    let speed = |found: &ModelComparison| {
        let of =
            |name: &str| found.changes.iter().chain(&found.unchanged).find(|it| it.quantity == name).unwrap().clone();
        of("separation_speed_rpm")
    };
    let same = compared(&machine(4, 1430.8));
    let change = speed(&same);
    assert!(change.difference.unwrap() != 0.0 && !change.is_one, "{change:?}");
    assert!(change.error.unwrap() > 1e-3, "{change:?}");
    assert!(same.fields.iter().any(|field| field.field == "rows of the table"), "{:?}", same.fields);
    // A cam that is larger than either is known is another one.
    let larger = of_rows(rows(5).iter().map(|[angle, lift]| [*angle, 1.01 * lift]).collect(), 1430.8);
    let found = compared(&larger);
    let highest = found.changes.iter().find(|it| it.quantity == "highest_lift_m").unwrap();
    assert!((highest.relative.unwrap() - 0.01).abs() < 1e-4 && highest.times_error.unwrap() > 2.0, "{highest:?}");
    // The same rows leave another spring less open than other rows do: both followers are on one cam, whichever it is.
    let [once, twice, other] = [(5, 1500.0), (5, 1569.2), (4, 1500.0)].map(|(places, k)| compared(&machine(places, k)));
    // Two springs on one cam press by k (c - rest), and what is open about c is in the difference as often as k differs.
    let preload = |found: &ModelComparison| {
        found.changes.iter().find(|it| it.quantity == "preload_n").and_then(|it| it.error).unwrap()
    };
    assert!(preload(&once) > 0.0);
    approx::assert_relative_eq!(preload(&twice), 2.0 * preload(&once), max_relative = 1e-6);
    let [one_cam, two_cams] = [&once, &other].map(speed);
    assert!(one_cam.is_one && one_cam.times_error.unwrap() > 3.0, "{one_cam:?}");
    assert!(two_cams.error.unwrap() > 5.0 * one_cam.error.unwrap(), "{one_cam:?} {two_cams:?}");
}

/// The separation speed goes with one over the root of the mass. If both machines have one mass with one error, the error moves both alike.
/// Otherwise the errors are independent.
#[test]
fn an_error_of_both_machines_moves_both_alike() {
    const MASS: f64 = 1.221;
    let machine = |(mass, error, stiffness): (f64, Option<f64>, f64)| {
        let mass = error.map_or(mass.to_string(), |error| format!("{{ value = {mass}, error = {error} }}"));
        common::osorio_with(&[("mass", &mass), ("stiffness", &stiffness.to_string())])
    };
    let here = |error: Option<f64>| (MASS, error, 1430.8);
    for (a, b, is_common) in [
        (here(Some(0.01)), (1.3, Some(0.01), 1430.8), false),
        (here(Some(0.01)), (MASS, Some(0.02), 1500.0), false),
        (here(None), (1.3, Some(0.01), 1430.8), false),
        (here(Some(0.01)), (1.3, None, 1430.8), false),
        (here(Some(0.01)), (MASS, Some(0.01), 1600.0), true),
    ] {
        let found = compare(&machine(a), &machine(b), External::LeftOut, &Unwatched).unwrap();
        let change = found.changes.iter().chain(&found.unchanged).find(|it| it.quantity == "separation_speed_rpm");
        let change = change.unwrap();
        let moved = |speed: &Option<Value>, (mass, error, _): (f64, Option<f64>, f64)| {
            // Twice the standard deviation is told.
            -0.5 * 2.0 * speed.as_ref().and_then(Value::as_f64).unwrap() * error.unwrap_or(0.0) / mass
        };
        let (of_a, of_b) = (moved(&change.a, a), moved(&change.b, b));
        let expected = if is_common { (of_b - of_a).abs() } else { of_a.hypot(of_b) };
        approx::assert_relative_eq!(change.error.unwrap(), expected, max_relative = 1e-3);
    }
}

/// Where routes know the orbit, what they differ by of both models is the error: of the period and the state as it is, and of the speed
/// 60/T by 60/T^2 of that of the period.
#[test]
fn the_orbit_is_known_as_far_as_its_routes_agree() {
    let models = [common::osorio(), common::osorio_with(&[("restitution", "0.7")])];
    let found = compare(&models[0], &models[1], External::LeftOut, &Unwatched).unwrap();
    let (mut period, mut speed, mut state) = (0.0, 0.0, 0.0);
    for model in &models {
        let verified = verify(model, External::LeftOut).unwrap();
        let apart = |quantity: Quantity| {
            let pairs = verified.comparisons.iter().filter(|pair| pair.quantity == quantity);
            pairs.map(|pair| pair.max_abs_diff).fold(0.0, f64::max)
        };
        period += apart(Quantity::Period);
        speed += apart(Quantity::Period) * 60.0 / verified.at.period.powi(2);
        state += apart(Quantity::State);
    }
    for (quantity, apart) in [("T_star", period), ("speed_rpm", speed), ("x_star_1", state), ("x_star_2", state)] {
        let change = found.changes.iter().chain(&found.unchanged).find(|it| it.quantity == quantity).unwrap();
        let size = [&change.a, &change.b].map(|it| it.as_ref().and_then(Value::as_f64).unwrap().abs());
        // With a rounding of the difference itself.
        let rounding = f64::EPSILON * size[0].max(size[1]);
        assert!(apart > 0.2 * rounding, "{quantity}: {apart:e}");
        approx::assert_relative_eq!(change.error.unwrap(), apart + rounding, max_relative = 1e-6);
    }
}

/// A number of a cam moves when the cam does, however small that is, and rows of a table are counted that are others.
#[test]
fn what_moves_is_told_at_any_size() {
    let follower =
        json!({ "mass": 1, "damping": 0, "stiffness": 0, "gravity": 9.81, "rest_position": 0, "restitution": 0.5 });
    let compared = |cams: [Value; 2]| {
        let [a, b] = cams.map(|cam| Model::of_document("cam", &json!({ "follower": follower, "cam": cam })).unwrap());
        compare(&a, &b, External::LeftOut, &Unwatched).unwrap()
    };
    // Powers of two, by which a double is scaled without rounding.
    for size in [-30, 0, 30].map(|power| 2_f64.powi(power)) {
        let cam =
            |part: f64| json!({ "law": "harmonic", "offset": 0.0, "amplitudes": [part * size], "phases_deg": [0.0] });
        let found = compared([1.0, 1.0 + 1e-12].map(cam));
        assert!(found.changes.iter().any(|it| it.quantity == "highest_lift_m"), "{size}: {:?}", found.changes);
        let found = compared([1.0, 1.0 + f64::EPSILON].map(cam));
        assert!(found.unchanged.iter().any(|it| it.quantity == "highest_lift_m"), "{size}: {:?}", found.changes);
    }
    let rows = |other: f64| -> Vec<[f64; 2]> {
        (0..36).map(|row| [f64::from(10 * row), if row == 7 { other } else { (f64::from(row) * 0.17).cos() }]).collect()
    };
    let found = compared([0.4, 0.41].map(|other| json!({ "law": "table", "spline": "cubic", "rows": rows(other) })));
    let rows = found.fields.iter().find(|field| field.field == "rows of the table").unwrap();
    assert_eq!((&rows.a, &rows.b), (&Some(json!("36 rows")), &Some(json!("36 rows, 1 others"))));
}

/// A number that both files have, in one unit, is the same in the first one's to the last digit.
#[test]
fn what_is_written_alike_is_no_change() {
    let follower = "damping = 0\nstiffness = 0\ngravity = 9.81\nrest_position = 0\nrestitution = 0.5\n";
    let cam = "[cam]\nlaw = \"harmonic\"\noffset = 0\namplitudes = [1]\nphases_deg = [0]\n[units]\nmass = \"lb\"\n";
    for tenths in 1..30 {
        let text = format!("[follower]\nmass = {}\n{follower}{cam}", f64::from(tenths) / 10.0);
        let model = Model::parse("pounds.toml", &text).unwrap();
        let found = compare(&model, &model, External::LeftOut, &Unwatched).unwrap();
        assert_eq!(found.fields, [], "{tenths}");
    }
}

/// What one model has alone comes last, whichever of the two has it; and both have to be verified, and alike, for nothing to have changed.
#[test]
fn what_one_model_has_alone_comes_last() {
    let [paper, harmonic] = [PAPER, "models/laws/harmonic.toml"].map(|file| common::read(Path::new(file)));
    for [one, other] in [[&paper, &harmonic], [&harmonic, &paper]] {
        let found = compare(one, other, External::LeftOut, &Unwatched).unwrap();
        let alone: Vec<bool> = found.changes.iter().map(|it| it.a.is_none() || it.b.is_none()).collect();
        assert!(alone.is_sorted() && alone.contains(&true) && alone.contains(&false), "{:?}", found.changes);
    }
    let mut found = compare(&paper, &paper, External::LeftOut, &Unwatched).unwrap();
    // Parts of nothing are none, of what is 0 and known to be so.
    assert!(found.unchanged.iter().any(|it| it.error == Some(0.0)));
    for it in &found.unchanged {
        assert_eq!(it.times_error, it.error.filter(|error| *error > 0.0).map(|_| 0.0), "{it:?}");
    }
    for (a, b) in [(true, true), (true, false), (false, true), (false, false)] {
        (found.verdict.a.agrees, found.verdict.b.agrees) = (a, b);
        assert_eq!((found.agrees(), found.verdict_changed()), (a && b, a != b));
    }
}

/// A range that cannot be looked through is another reason than that none is given.
#[test]
fn a_range_that_is_too_wide_is_told_as_that() {
    let too_wide = common::osorio_with(&[("rpm_min", "0.001")]);
    let text = common::osorio_text(&[]);
    let none = Model::parse("none.toml", text.split("[study]").next().unwrap()).unwrap();
    let found = compare(&too_wide, &none, External::LeftOut, &Unwatched).unwrap();
    assert!(
        matches!(&found.verdict.a.found, Err(NoVerdict::NotThere(why)) if why.to_string().contains("spans too much"))
    );
    assert_eq!(found.verdict.b.found, Err(NoVerdict::NotLookedFor));
}

/// The spread of a number is that between routes: a number of one route alone has none.
#[test]
fn a_number_of_one_route_has_no_spread() {
    let model = common::osorio();
    let mut found = verify(&model, External::LeftOut).unwrap();
    let of_maps = |all: &BTreeMap<String, f64>| all.keys().filter(|name| name.starts_with("A_minus")).count();
    assert_eq!(of_maps(&spreads(&found, &model.units)), 4);
    found.routes.truncate(2);
    assert_eq!(of_maps(&spreads(&found, &model.units)), 4);
    found.routes.truncate(1);
    let alone = spreads(&found, &model.units);
    assert!(of_maps(&alone) == 0 && alone.contains_key("T_star"), "{alone:?}");
}
