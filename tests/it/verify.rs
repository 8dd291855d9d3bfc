//! Does `verify` keep its contract: fields, exit codes, streams?

use std::path::PathBuf;

use crate::common::{self, corner_impact};
use corner_impact_cli::show::Paged;
use serde_json::Value;

fn model(name: &str) -> String {
    common::model_files().iter().find(|file| common::stem(file) == name).unwrap().to_string_lossy().into_owned()
}

fn document(name: &str) -> Value {
    let output = corner_impact(["verify", "--json", "--no-external", &model(name)]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

fn is_matrix(value: &Value) -> bool {
    let row = |row: &Value| row.as_array().is_some_and(|row| row.len() == 2 && row.iter().all(Value::is_f64));
    value.as_array().is_some_and(|rows| rows.len() == 2 && rows.iter().all(row))
}

fn is_vector(value: &Value) -> bool {
    value.as_array().is_some_and(|entries| entries.len() == 2 && entries.iter().all(Value::is_f64))
}

#[test]
fn the_json_document_has_the_fields_of_the_contract() {
    let document = document("osorio-2008");
    assert_eq!(document["schema"], "corner-impact/verify/1");
    let at = &document["corner_impact"];
    assert!(["period_s", "speed_rpm", "cam_angle_rad"].iter().all(|field| at[field].is_f64()));
    assert!(is_vector(&at["state"]));
    let routes = &document["routes"];
    for route in ["closed_form", "variational", "finite_difference", "least_squares"] {
        assert!(is_vector(&routes[route]["C"]) && routes[route]["D"].is_f64(), "{route}");
        for side in ["minus", "plus"] {
            assert!(is_matrix(&routes[route][side]["A"]) && is_vector(&routes[route][side]["B"]), "{route} {side}");
        }
    }
    for side in ["minus", "plus"] {
        let error = &routes["least_squares"]["standard_error"][side];
        assert!(is_matrix(&error["A"]) && is_vector(&error["B"]));
        let eigenvalues = document["eigenvalues"][side].as_array().unwrap();
        assert!(eigenvalues.len() == 2 && eigenvalues.iter().all(|value| value["re"].is_f64() && value["im"].is_f64()));
    }
    assert!(routes["least_squares"]["condition_number"].is_f64());
    let comparisons = document["agreement"].as_array().unwrap();
    for entry in comparisons {
        assert!(entry["routes"].as_array().unwrap().len() == 2 && entry["quantity"].is_string());
        assert!(["max_abs_diff", "max_rel_diff", "tolerance"].iter().all(|field| entry[field].is_f64()));
        assert_eq!(entry["agrees"], true);
        let (diff, tolerance) = (entry["max_abs_diff"].as_f64().unwrap(), entry["tolerance"].as_f64().unwrap());
        assert!(diff < tolerance);
    }
    let form = &document["normal_form"];
    assert_eq!(keys(form), ["A_bar_minus", "A_bar_plus", "B_bar", "B_tilde", "C_bar", "W"]);
    assert!(["W", "A_bar_minus", "A_bar_plus"].iter().all(|field| is_matrix(&form[field])));
    assert!(["B_tilde", "B_bar", "C_bar"].iter().all(|field| is_vector(&form[field])));
    let verdict = &document["classification"];
    assert_eq!(verdict["scenario"], "nonsmooth-fold");
    assert_eq!(verdict["real_eigenvalues_above_one"], serde_json::json!({"minus": 1, "plus": 0}));
    assert_eq!(verdict["real_eigenvalues_below_minus_one"], serde_json::json!({"minus": 0, "plus": 0}));
    assert_eq!(verdict["fixed_points_exist_for"], serde_json::json!({"minus": "faster", "plus": "faster"}));
    assert!(document["skipped"].is_array());
    assert_eq!(document["agrees"], true);
}

/// What the document says of each route is what the route found.
#[test]
fn the_json_document_carries_the_findings_unchanged() {
    let document = document("preloaded");
    let model = common::read(&PathBuf::from(model("preloaded")));
    let found = corner_impact::study::verify::verify(&model, corner_impact::study::verify::External::LeftOut).unwrap();
    assert_eq!(document["corner_impact"]["period_s"].as_f64().unwrap(), found.at.period);
    assert_eq!(document["corner_impact"]["state"][0].as_f64().unwrap(), found.at.x_star()[0]);
    for route in &found.routes {
        let entry = &document["routes"][route.name.to_string()];
        for (side, map) in [("minus", &route.map.minus), ("plus", &route.map.plus)] {
            for row in 0..2 {
                assert_eq!(entry[side]["B"][row].as_f64().unwrap(), map.b[row]);
                for column in 0..2 {
                    assert_eq!(entry[side]["A"][row][column].as_f64().unwrap(), map.a[(row, column)]);
                }
            }
        }
        assert_eq!(entry["C"][1].as_f64().unwrap(), route.map.c()[1]);
        assert_eq!(entry["D"].as_f64().unwrap(), route.map.d());
    }
}

#[test]
fn scenarios_of_the_other_models() {
    for (name, scenario, minus, plus) in [
        ("persistence", "persistence", "slower", "faster"),
        ("nonsmooth-flip", "nonsmooth-flip", "slower", "faster"),
        ("damped-light", "nonsmooth-fold", "faster", "faster"),
    ] {
        let verdict = &document(name)["classification"];
        assert_eq!(verdict["scenario"], scenario, "{name}");
        assert_eq!(verdict["fixed_points_exist_for"], serde_json::json!({"minus": minus, "plus": plus}), "{name}");
    }
}

/// A document whose routes disagree says so on the page and in the exit code's twin.
#[test]
fn disagreement_is_said_plainly() {
    let model = common::osorio();
    let mut found =
        corner_impact::study::verify::verify(&model, corner_impact::study::verify::External::LeftOut).unwrap();
    found.comparisons[3].agrees = false;
    found.published[0].as_found = false;
    found.agrees = false;
    let page = found.text().unwrap();
    assert!(page.contains("DISAGREE") && page.contains("UNEXPECTED"));
    let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        page.contains("35 of 36 comparisons agree, and so do 24 of 24 that follow")
            && page.contains("1 differ from the recorded verdict")
    );
    assert!(page.trim_end().ends_with("DISAGREES: a comparison above"));
}

/// A plastic follower sticks to the flank before the corner: the closed form's map is not its map, and verify says so.
#[test]
fn a_route_that_cannot_run_is_no_agreement() {
    let file = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("plastic.toml");
    std::fs::write(&file, common::osorio_text(&[("restitution", "0.0"), ("rpm_max", "1500.0")])).unwrap();
    let output = corner_impact(["verify", "--no-external", file.to_str().unwrap()]);
    let page = common::text(output.stdout);
    assert_eq!(output.status.code(), Some(1), "{page}");
    assert!(
        page.contains("NOT RUN") && page.contains("least_squares: ") && page.contains("sticks to the cam"),
        "{page}"
    );
    assert!(page.contains("INCOMPLETE: finite_difference, least_squares and"), "{page}");
}

#[test]
fn pages_fit_a_terminal() {
    for file in common::model_files() {
        let output = corner_impact(["verify", "--no-external", file.to_str().unwrap()]);
        let page = common::text(output.stdout);
        for line in page.lines() {
            assert!(line.chars().count() <= 100, "{file:?}: {line}");
        }
        assert!(page.contains("AGREES") && output.stderr.is_empty());
    }
}
