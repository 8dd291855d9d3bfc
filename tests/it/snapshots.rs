//! Have the numbers moved? Snapshots under `golden/snapshots`; after a change to a model, `cargo insta review`.
//!
//! Values are kept to ten significant digits of their quantity's largest entry: the closed form holds them, while the last
//! digits are rounding. The page keeps its estimators' values, which are good to the
//! places shown, and masks differences and errors, which are rounding.

use crate::common;
use corner_impact::border_collision::LocalOutcome;
use corner_impact::border_collision::long_run::LocalLongRun;
use corner_impact::corner::map::{Eigenvalue, SideMap};
use corner_impact::study::verify::{External, verify};
use corner_impact_cli::show::Paged;
use serde_json::{Value, json};

const DIGITS: i32 = 10;

pub fn settings() -> insta::Settings {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../../golden/snapshots");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings
}

/// Entries as text with ten digits of the largest.
fn kept(entries: &[f64]) -> Value {
    let largest = entries.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    // Of the largest as it is written: what rounds up to 1 has a digit in front of its point.
    let written = format!("{largest:.*e}", DIGITS as usize - 1);
    let exponent: i32 = written.split_once('e').unwrap().1.parse().unwrap();
    let places = if largest > 0.0 { (DIGITS - 1 - exponent).max(0) as usize } else { 0 };
    let text = |entry: &f64| {
        let text = format!("{entry:.places$}");
        // Rounding decides the sign of a zero.
        if text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.') { "0".to_owned() } else { text }
    };
    json!(entries.iter().map(text).collect::<Vec<_>>())
}

fn side(side: &SideMap) -> Value {
    let values: Vec<f64> = side.eigenvalues().iter().flat_map(|Eigenvalue { re, im }| [*re, *im]).collect();
    json!({ "A": kept(side.a.transpose().as_slice()), "B": kept(side.b.as_slice()), "eigenvalues_re_im": kept(&values) })
}

/// Where the motion from x* ends: a word, or a kind.
fn end(outcome: &LocalOutcome) -> String {
    match &outcome.fates[0].end {
        LocalLongRun::Periodic(orbit) => orbit.word.to_string(),
        other => other.name().into(),
    }
}

#[test]
fn fixed_points_matrices_eigenvalues_and_normal_forms() {
    for file in common::model_files() {
        let found = verify(&common::read(&file), External::LeftOut).unwrap();
        let map = &found.map;
        let form = found.normal_form.unwrap();
        let verdict = found.classification.unwrap();
        let document = json!({
            "corner_impact": {
                "period_s": kept(&[found.at.period]),
                "speed_rpm": kept(&[found.at.speed_rpm()]),
                "cam_angle_rad": kept(&[found.at.corner.angle]),
                "x_star": kept(found.at.x_star().as_slice()),
                "velocity_before_after_cam_m_s": kept(&[found.at.velocity_before, found.at.velocity_after, found.at.cam_velocity]),
            },
            "closed_form": {
                "minus": side(&map.minus),
                "plus": side(&map.plus),
                "C": kept(map.c().as_slice()),
                "D": kept(&[map.d()]),
            },
            "normal_form": {
                "B_tilde": kept(form.b_tilde.as_slice()),
                "W": kept(form.w.transpose().as_slice()),
                "A_bar_minus": kept(form.a_bar_minus.transpose().as_slice()),
                "A_bar_plus": kept(form.a_bar_plus.transpose().as_slice()),
                "B_bar": kept(form.b_bar.as_slice()),
                "C_bar": kept(form.c_bar.as_slice()),
            },
            "classification": {
                "scenario": verdict.scenario,
                "fixed_points_exist_for": [verdict.minus.exists_for, verdict.plus.exists_for],
                "stable": [verdict.minus.stable, verdict.plus.stable],
            },
            "local_map_from_the_corner_impact": {
                "faster": end(&found.outcomes[0]),
                "slower": end(&found.outcomes[1]),
                "at": end(&found.outcomes[2]),
            },
        });
        settings().bind(|| insta::assert_json_snapshot!(format!("{}", common::stem(&file)), document));
    }
}

#[test]
fn the_verify_page() {
    let model = common::osorio();
    let page = verify(&model, External::LeftOut).unwrap().text().unwrap();
    let mut settings = settings();
    // Rounding: differences, error estimates, and how many decimals are shared beyond those asked for.
    settings.add_filter(r" +\d\.\de-?\d+(  |,|;| in | up to)", " [small]$1");
    settings.add_filter(r"bias up to \[small\], +\d\.\de-?\d+", "bias up to [small], [small]");
    settings.add_filter(r"(  |shares )(\d+ decimals|all digits)", "$1[shared]");
    // Which two routes differ most is rounding, too.
    settings.add_filter(r"\[shared\] +[a-z ]+ - [a-z ]+", "[shared]  [routes]");
    settings.add_filter(r"condition number \d+\.\d", "condition number [about 31]");
    settings.bind(|| insta::assert_snapshot!("verify-page", page));
}

/// `make review` runs every test that has a snapshot, slow ones as well.
#[test]
fn every_snapshot_is_reviewed() {
    let makefile = std::fs::read_to_string(concat!(env!("PROJECT"), "/Makefile")).unwrap();
    let words = makefile.split("insta test").nth(1).unwrap().split("\n\n").next().unwrap();
    let words: Vec<&str> = words.split(" -- --include-ignored ").nth(1).unwrap().split_whitespace().collect();
    for entry in std::fs::read_dir(concat!(env!("PROJECT"), "/tests/it")).unwrap() {
        let path = entry.unwrap().path();
        let module = path.file_stem().unwrap().to_string_lossy().into_owned();
        let Ok(text) = std::fs::read_to_string(&path) else { continue };
        // Split in two, so that this line is none of them.
        for (at, _) in text.match_indices(concat!("insta::assert", "_")) {
            let function = text[..at].rsplit("\nfn ").next().unwrap().rsplit("\npub(crate) fn ").next().unwrap();
            let name = format!("{module}::{}", function.split('(').next().unwrap());
            assert!(words.iter().any(|word| name.contains(word)), "`make review` leaves out {name}");
        }
    }
}
