//! `--set NAME=VALUE`: the same answers as those of a file with that number, and the complaints of a file.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::common;

fn prints(arguments: &[&str]) -> String {
    let output = common::corner_impact(arguments);
    let complaints = common::text(output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {complaints}");
    common::text(output.stdout)
}

fn refused(arguments: &[&str]) -> String {
    let output = common::corner_impact(arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    common::text(output.stderr)
}

/// Two numbers of the follower, by their short names and by a whole path, and one of the cam.
#[test]
fn a_number_that_is_set_is_as_good_as_one_in_the_file() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("other.toml");
    let changes = [("restitution", "0.75"), ("mass", "1.25"), ("nose_end_deg", "159.5")];
    fs::write(&file, common::osorio_text(&changes)).unwrap();
    let set = ["--set", "restitution=0.75", "--set", "follower.mass=1.25", "--set", "nose_end_deg = 159.5"];
    let model = "models/osorio-2008.toml";
    let command = ["locate", "--rpm", "640:700", "--json"];
    let [by_file, by_set] = [vec![file.to_str().unwrap()], [&[model][..], &set].concat()].map(|model| {
        let found: Value = serde_json::from_str(&prints(&[&command[..], &model].concat())).unwrap();
        found
    });
    assert!(!by_file["corner_impacts"].as_array().unwrap().is_empty());
    assert_eq!(by_file["corner_impacts"], by_set["corner_impacts"]);
    // What was changed is a part of the name that every answer carries.
    assert_eq!(
        by_set["model"],
        "osorio-2008 with follower.restitution = 0.75, follower.mass = 1.25, cam.nose_end_deg = 159.5"
    );
}

/// The range where a corner impact is looked for is numbers of the file, too, and both of its ends are checked together.
#[test]
fn the_range_of_the_study_can_be_set() {
    let set = ["verify", "--no-external", "--set", "rpm_min=800", "--set", "rpm_max=900", "models/osorio-2008.toml"];
    assert!(refused(&set).contains("800"), "a range above every corner impact of one impact");
    assert!(
        refused(&["verify", "--set", "rpm_min=800"]).contains("study.rpm_max = 760.0: must be above study.rpm_min")
    );
}

#[test]
fn what_cannot_be_set_is_refused_as_in_a_file() {
    let orbit = |set: &[&str]| {
        let words: Vec<&str> = set.iter().flat_map(|set| ["--set", set]).collect();
        refused(&[&["orbit", "models/damped-heavy.toml", "--rpm", "700"], &words[..]].concat())
    };
    assert!(orbit(&["restitution=1.7"]).contains("follower.restitution = 1.7: must be a finite number from 0 to 1"));
    assert!(orbit(&["restitution=1.7"]).contains("damped-heavy.toml: follower"), "no line of the file says 1.7");
    assert!(orbit(&["restitutoin=0.7"]).contains("did you mean restitution?"));
    assert!(orbit(&["rpm=700"]).contains("rpm is not a number of this model"));
    assert!(orbit(&["mass=2", "follower.mass=3"]).contains("follower.mass is set twice"));
    assert!(orbit(&["mass"]).contains("must be NAME=VALUE"));
    assert!(orbit(&["mass=heavy"]).contains("\"heavy\" is not a number"));
    // A cam that cannot be: what geometry forbids is a complaint about the field, too.
    assert!(orbit(&["nose_radius=7"]).contains("cam."));
    let ends = refused(&["orbit", "models/laws/polynomial.toml", "--rpm", "700", "--set", "start_deg=2"]);
    assert!(ends.contains("cam.segment[0].start_deg, cam.segment[1].start_deg: write the whole path"), "{ends}");
}

/// A command that takes a model takes its numbers.
#[test]
fn every_command_with_a_model_has_set() {
    let mut with_a_model = 0;
    for command in crate::command_line::COMMANDS {
        let help = prints(&[command, "--help"]);
        if help.contains("[MODEL]") {
            assert!(help.contains("--set <NAME=VALUE>"), "{command}");
            with_a_model += 1;
        }
    }
    assert!(with_a_model > 12, "{with_a_model}");
}
