//! Do the programs outside agree where they run, and is it said plainly where they cannot?

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::common;
use serde_json::Value;

/// The interpreter that `make` sets up; without it these questions cannot be asked, and that is a failure, not a pass.
fn interpreter() -> PathBuf {
    let python = Path::new(env!("CARGO_MANIFEST_DIR")).join(".venv/bin/python");
    assert!(python.is_file(), "run `make test`, which sets up .venv");
    python
}

fn verify(arguments: &[&str], environment: &[(&str, &str)]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_corner-impact"));
    command.current_dir(env!("CARGO_MANIFEST_DIR")).arg("verify").args(arguments);
    command.envs(environment.iter().copied()).output().unwrap()
}

/// A page as one line: where it breaks depends on the length of paths.
fn unwrapped(page: Vec<u8>) -> String {
    String::from_utf8(page).unwrap().split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Every entry of A to five decimals and of B to 1e-6 relative, or better; the derived expressions to twelve digits.
#[test]
fn both_programs_agree_on_every_model() {
    interpreter();
    for file in common::model_files() {
        let output = verify(&["--json", file.to_str().unwrap()], &[]);
        assert_eq!(output.status.code(), Some(0), "{file:?}: {}", String::from_utf8_lossy(&output.stdout));
        let document: Value = serde_json::from_slice(&output.stdout).unwrap();
        for (program, a_bound, b_bound) in [("scipy", 5e-6, 1e-6), ("symbolic", 1e-10, 1e-12)] {
            for side in ["minus", "plus"] {
                let (closed, other) = (&document["routes"]["closed_form"][side], &document["routes"][program][side]);
                for row in 0..2 {
                    let (b, c) = (closed["B"][row].as_f64().unwrap(), other["B"][row].as_f64().unwrap());
                    assert!((b - c).abs() < b_bound * b.abs(), "{file:?} {program} B {side}: {b} {c}");
                    for column in 0..2 {
                        let a = |route: &Value| route["A"][row][column].as_f64().unwrap();
                        assert!((a(closed) - a(other)).abs() < a_bound, "{file:?} {program} A {side}");
                    }
                }
            }
            let orbit = document["agreement"].as_array().unwrap().iter().filter(|entry| {
                entry["quantity"] == "x_star"
                    && entry["routes"].as_array().unwrap().iter().any(|route| route == program)
            });
            assert!(orbit.count() >= 2, "{file:?}: {program} finds the orbit by itself");
        }
        assert!(document["routes"]["scipy"]["standard_error"]["minus"]["A"].is_array());
    }
}

#[test]
fn without_python_it_says_so_and_does_not_agree() {
    let model = "models/osorio-2008.toml";
    let output = verify(&[model], &[("CORNER_IMPACT_PYTHON", "/nonexistent/python")]);
    let page = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1), "{page}");
    assert!(
        page.contains("NOT RUN") && page.contains("/nonexistent/python") && page.contains("did not start"),
        "{page}"
    );
    assert!(
        page.contains("INCOMPLETE: scipy and symbolic did not run")
            || page.contains("INCOMPLETE: symbolic and scipy did not run"),
        "{page}"
    );
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("scipy") && message.contains("did not start"), "{message}");
}

#[test]
fn a_script_that_fails_is_quoted() {
    let home = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("failing");
    std::fs::create_dir_all(home.join("derivations")).unwrap();
    let scripts = [
        ("evaluate.py", "import sys\nsys.exit('no module named sympathy')\n"),
        ("simulate_scipy.py", "print('not json')\n"),
    ];
    for (name, text) in scripts {
        std::fs::write(home.join("derivations").join(name), text).unwrap();
    }
    let python = interpreter();
    let environment =
        [("CORNER_IMPACT_HOME", home.to_str().unwrap()), ("CORNER_IMPACT_PYTHON", python.to_str().unwrap())];
    let output = verify(&["models/osorio-2008.toml"], &environment);
    let page = unwrapped(output.stdout);
    assert_eq!(output.status.code(), Some(1), "{page}");
    for part in ["evaluate.py", "no module named sympathy", "simulate_scipy.py", "printed something else"] {
        assert!(page.contains(part), "{part} in {page}");
    }
}

#[test]
fn left_out_on_purpose_is_listed_and_agrees() {
    let output =
        verify(&["--no-external", "models/osorio-2008.toml"], &[("CORNER_IMPACT_PYTHON", "/nonexistent/python")]);
    let page = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{page}");
    assert!(
        page.contains("NOT RUN") && page.contains("symbolic: left out") && page.contains("scipy: left out"),
        "{page}"
    );
}
