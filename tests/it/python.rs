//! Do the programs outside agree where they run, and is it said plainly where they cannot?

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::common;
use serde_json::{Value, json};

/// The interpreter that `make` sets up; without it these questions cannot be asked, and that is a failure, not a pass.
fn interpreter() -> PathBuf {
    let python = Path::new(common::ROOT).join(".venv/bin/python");
    assert!(python.is_file(), "run `make test`, which sets up .venv");
    python
}

fn verify(arguments: &[&str], environment: &[(&str, &str)]) -> Output {
    common::program(["verify"]).args(arguments).envs(environment.iter().copied()).output().unwrap()
}

/// A page as one line: where it breaks depends on the length of paths.
fn unwrapped(page: Vec<u8>) -> String {
    String::from_utf8(page).unwrap().split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Every entry of A to five decimals and of B to 1e-6 relative, or better; the derived expressions to twelve digits.
#[test]
#[ignore = "slow"]
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
#[ignore = "slow"]
fn without_python_it_says_so_and_does_not_agree() {
    let model = "models/osorio-2008.toml";
    let output = verify(&[model], &[("CORNER_IMPACT_PYTHON", "/nonexistent/python")]);
    let page = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1), "{page}");
    assert!(
        page.contains("NOT RUN") && page.contains("/nonexistent/python") && page.contains("did not start"),
        "{page}"
    );
    assert!(page.contains("INCOMPLETE: symbolic, scipy and certificate did not run"), "{page}");
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("scipy") && message.contains("did not start"), "{message}");
}

/// An interpreter that runs no Python: it says what a failing script says, or prints what is no result.
#[cfg(unix)]
#[test]
#[ignore = "slow"]
fn a_script_that_fails_is_quoted() {
    let folder = tempfile::tempdir().unwrap();
    let says = r#"case "$*" in *evaluate.py) echo 'no module named sympathy' >&2; exit 1;; *) echo 'not json';; esac"#;
    let python = executable(folder.path(), "python", says);
    let output = verify(&["models/osorio-2008.toml"], &[("CORNER_IMPACT_PYTHON", python.to_str().unwrap())]);
    let page = unwrapped(output.stdout);
    assert_eq!(output.status.code(), Some(1), "{page}");
    for part in
        ["evaluate.py", "no module named sympathy", "simulate_scipy.py", "printed something other than its result"]
    {
        assert!(page.contains(part), "{part} in {page}");
    }
}

/// Everything runs, and one number is another, or one orbit is not proved: the whole disagrees.
#[cfg(unix)]
#[test]
#[ignore = "slow"]
fn one_number_that_is_otherwise_and_one_refused_proof_are_enough_to_disagree() {
    let (folder, real) = (tempfile::tempdir().unwrap(), interpreter());
    let real = real.to_str().unwrap();
    let changed = "import json, sys; found = json.load(sys.stdin); found['minus']['A'][0][0] = '0.5'; json.dump(found, sys.stdout)";
    let number = format!("*evaluate.py) '{real}' \"$@\" | '{real}' -c \"{changed}\";;");
    let proof = r#"*certify.py) cat > /dev/null; echo '{"results": [{"refused": "not today"}]}';;"#;
    for (name, case, failed) in [("number", number.as_str(), json!([])), ("proof", proof, json!(["certificate"]))] {
        let says = format!("case \"$*\" in {case} *) exec '{real}' \"$@\";; esac");
        let python = executable(folder.path(), name, &says);
        let python = ("CORNER_IMPACT_PYTHON", python.to_str().unwrap());
        let output = verify(&["--json", "models/osorio-2008.toml"], &[python]);
        let found: Value = serde_json::from_slice(&output.stdout).unwrap();
        let of = |list: &str, wanted: fn(&Value) -> bool, field: &str| -> Value {
            found[list].as_array().unwrap().iter().filter(|it| wanted(it)).map(|it| it[field].clone()).collect()
        };
        assert_eq!((output.status.code(), &found["agrees"]), (Some(1), &json!(false)), "{name}");
        assert_eq!(of("skipped", |it| it["failed"] == true, "route"), failed, "{name}");
        let disagreeing = of("agreement", |it| it["agrees"] == false, "quantity");
        assert_eq!(disagreeing == json!([]), name == "proof", "{disagreeing}");
    }
}

/// A shell script that can be run.
#[cfg(unix)]
fn executable(folder: &Path, name: &str, text: &str) -> PathBuf {
    use std::os::unix::fs::PermissionsExt;
    std::fs::create_dir_all(folder).unwrap();
    let path = folder.join(name);
    std::fs::write(&path, format!("#!/bin/sh\n{text}\n")).unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
    path
}

/// A program that left its clone runs the Python of the PATH, and says what to install; it knows nothing of the clone's `.venv`.
#[cfg(unix)]
#[test]
fn a_program_outside_its_clone_runs_the_python_of_the_path() {
    let installed = tempfile::tempdir().unwrap();
    let program = installed.path().join("corner-impact");
    common::copy_program(&program);
    executable(&installed.path().join("bin"), "python3", "echo 'this Python has nothing' >&2; exit 3");
    let model = Path::new(common::ROOT).join("models/osorio-2008.toml");
    let path = format!("{}:/usr/bin:/bin", installed.path().join("bin").display());
    let output = Command::new(&program).arg("certify").arg(model).env("PATH", path).output().unwrap();
    let words = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{words}");
    assert!(words.contains("this Python has nothing") && words.contains("python3 -m pip install"), "{words}");
    assert!(!words.contains("make verify"), "{words}");
}

/// A program of the clone in a folder that somebody else filled: with scripts and an interpreter where the project has its
/// own, with modules of the names that the scripts import, and a module that Python imports by itself where it finds one.
#[cfg(unix)]
#[test]
#[ignore = "slow"]
fn nothing_of_the_current_folder_is_run() {
    // In the clone, whose interpreter it finds.
    let home = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
    let (stranger, private) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let program = home.path().join("corner-impact");
    common::copy_program(&program);
    let marks = stranger.path().join("marks");
    std::fs::create_dir_all(&marks).unwrap();
    let python = |name: &str| {
        let path = stranger.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        let mark = marks.join(name.replace('/', "-"));
        std::fs::write(path, format!("open({:?}, 'w').close()\n", mark.to_str().unwrap())).unwrap();
    };
    let modules =
        ["arithmetic.py", "json.py", "mpmath.py", "numpy.py", "scipy.py", "flint.py", "sitecustomize.py", "sympy.py"];
    for name in modules.into_iter().chain([
        "derivations/evaluate.py",
        "derivations/simulate_scipy.py",
        "derivations/certify.py",
    ]) {
        python(name);
    }
    let touch = format!("touch '{}/interpreter'", marks.display());
    executable(&stranger.path().join(".venv/bin"), "python", &touch);
    executable(stranger.path(), "python3", &touch);
    let real = interpreter();
    // The interpreter of the clone, one that is named, and one of a PATH that has the current folder in it.
    let path = format!(".:{}", std::env::var("PATH").unwrap());
    for chosen in [None, Some(real.to_str().unwrap()), Some("python3")] {
        let mut command = Command::new(&program);
        command.current_dir(stranger.path()).args(["verify", "--json"]).env_remove("CORNER_IMPACT_PYTHON");
        // An empty entry of PYTHONPATH is the current folder.
        command.env("PYTHONPATH", ":").env("PATH", &path).env("TMPDIR", private.path());
        command.envs(chosen.map(|chosen| ("CORNER_IMPACT_PYTHON", chosen)));
        let output = command.output().unwrap();
        let left: Vec<_> = std::fs::read_dir(&marks).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert!(left.is_empty(), "{chosen:?}: {left:?}");
        assert_eq!(std::fs::read_dir(private.path()).unwrap().count(), 0, "{chosen:?}: the scripts are removed");
        if chosen != Some("python3") {
            assert_eq!(output.status.code(), Some(0), "{chosen:?}: {}", String::from_utf8_lossy(&output.stderr));
        }
    }
}

/// A relative path to an interpreter is one from the current folder, wherever the scripts are run.
#[test]
#[ignore = "slow"]
fn an_interpreter_is_named_from_the_current_folder() {
    interpreter();
    let output = verify(&["models/osorio-2008.toml"], &[("CORNER_IMPACT_PYTHON", ".venv/bin/python")]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
#[ignore = "slow"]
fn left_out_on_purpose_is_listed_and_agrees() {
    let output =
        verify(&["--no-external", "models/osorio-2008.toml"], &[("CORNER_IMPACT_PYTHON", "/nonexistent/python")]);
    let page = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{page}");
    assert!(
        page.contains("Left out\n")
            && !page.contains("NOT RUN")
            && page.contains("symbolic: left out")
            && page.contains("scipy: left out"),
        "{page}"
    );
}

/// The second program that proves chaos: an h-set that is off is refused, with the reason, and the same one is proved as it stands.
#[test]
#[ignore = "slow"]
fn an_h_set_that_is_off_is_refused_in_balls_too() {
    let folder = tempfile::tempdir().unwrap();
    let golden = std::fs::read_to_string(Path::new(common::ROOT).join("golden/chaos/osorio-2008.json")).unwrap();
    let mut golden: Value = serde_json::from_str(&golden).unwrap();
    let kept = golden["h_sets"][0].take();
    // Each with one strip, the one of so many impacts.
    type Change = fn(&mut Value);
    let cases: [(u64, &str, Change); 13] = [
        (5, "", |_| {}),
        (5, "lie beyond", |set| set["strips"][0]["x"] = json!([-3.6901, -3.6141])),
        (5, "lie beyond", |set| set["strips"][0]["x"] = json!([-3.8901, -3.8141])),
        (5, "does not go beyond N", |set| set["strips"][0]["x"] = json!([-3.7751, -3.7141])),
        (5, "does not go beyond N", |set| set["strips"][0]["x"] = json!([-3.7901, -3.7291])),
        (6, "leaves N at", |set| set["y"] = json!([-0.159, 1.2])),
        (2, "leaves N at", |set| set["y"] = json!([0.05, 1.386])),
        // The flights of a part of it touch the cam; its edges are carried across all the same.
        (2, "is not proved to", |set| set["strips"][0]["x"] = json!([-0.3, 0.201])),
        (5, "lie beyond", |set| set["strips"][0]["revolutions"] = json!(5)),
        (5, "cones are not proved", |set| set["cone_slope"] = json!(0.01)),
        (5, "is not inside N", |set| set["x"] = json!([-3.75, 0.211])),
        (5, "are parallel", |set| set["stable"] = set["unstable"].clone()),
        (5, "does not leave the cam", |set| set["centre"] = json!([158.29, 0.1])),
    ];
    let files: Vec<PathBuf> =
        (0..).map(|index| folder.path().join(format!("{index}.json"))).take(cases.len()).collect();
    for (file, (impacts, _, change)) in files.iter().zip(&cases) {
        let mut set = kept.clone();
        set["strips"].as_array_mut().unwrap().retain(|strip| strip["impacts"] == *impacts);
        change(&mut set);
        std::fs::write(file, json!({ "model": "osorio-2008", "h_sets": [set] }).to_string()).unwrap();
    }
    let script = Path::new(common::ROOT).join("derivations/chaos.py");
    let output = Command::new(interpreter()).arg(script).arg("--json").args(&files).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stderr));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let theorems = document["theorems"].as_array().unwrap();
    assert_eq!(theorems.len(), cases.len());
    for (theorem, (_, why, _)) in theorems.iter().zip(&cases) {
        assert_eq!(theorem["proved"], why.is_empty(), "{theorem}");
        let refused = [&theorem["refused"], &theorem["strips"][0]["refused"]].into_iter().find_map(Value::as_str);
        assert!(refused.unwrap_or_default().contains(why), "{why}: {theorem}");
    }
}

/// The balls know no rounded corner and say so; to the other routes in Python such a cam has no corner.
#[test]
#[ignore = "slow"]
fn a_rounded_corner_is_none() {
    use std::io::Write;
    let model = common::osorio().with_number("cam.corner_rounding_deg", 0.1).unwrap();
    let (follower, cam, study) = (model.follower, &model.cam, model.study);
    let document =
        json!({ "follower": follower, "cam": cam, "study": study, "bits": 64, "candidates": [{}] }).to_string();
    for (script, says) in [
        ("evaluate.py", "no corner impact"),
        ("simulate_scipy.py", "no corner impact"),
        ("certify.py", "cam.corner_rounding_deg"),
    ] {
        let path = Path::new(common::ROOT).join("derivations").join(script);
        let mut command = Command::new(interpreter());
        let piped = std::process::Stdio::piped;
        let mut child = command.arg(path).stdin(piped()).stdout(piped()).stderr(piped()).spawn().unwrap();
        child.stdin.take().unwrap().write_all(document.as_bytes()).unwrap();
        let output = child.wait_with_output().unwrap();
        let said = unwrapped([output.stdout, output.stderr].concat());
        assert!(said.contains(says), "{script}: {said}");
        assert!(!said.contains("Traceback") && !said.contains("speed_rpm"), "{script}: {said}");
    }
}
