//! Does data move one way? No stage may use a stage that `lib.rs` lists below it.

use std::path::{Path, PathBuf};

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files
}

fn stages(root: &Path) -> Vec<String> {
    let lib = std::fs::read_to_string(root.join("lib.rs")).unwrap();
    lib.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';')).map(String::from).collect()
}

/// The stages named after `crate::` in a file, with the line.
fn uses(text: &str) -> Vec<(usize, String)> {
    let word = |rest: &str| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let of_line = |(line, text): (usize, &str)| {
        text.match_indices("crate::").map(|(at, found)| (line + 1, word(&text[at + found.len()..]))).collect::<Vec<_>>()
    };
    let code = text.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//"));
    code.flat_map(of_line).collect()
}

#[test]
fn no_stage_uses_one_below_it() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let stages = stages(&root);
    assert!(stages.len() > 10, "{stages:?}");
    let mut checked = 0;
    for file in rust_files(&root) {
        let inside = file.strip_prefix(&root).unwrap().with_extension("");
        let stage = inside.components().next().unwrap().as_os_str().to_string_lossy().into_owned();
        let Some(here) = stages.iter().position(|name| *name == stage) else { continue };
        for (line, used) in uses(&std::fs::read_to_string(&file).unwrap()) {
            let there = stages.iter().position(|name| *name == used);
            let there =
                there.unwrap_or_else(|| panic!("{}:{line}: crate::{used} is no stage of lib.rs", file.display()));
            assert!(there <= here, "{}:{line}: {stage} uses {used}, which comes after it", file.display());
            checked += 1;
        }
    }
    assert!(checked > 40, "{checked} uses seen");
}

/// Routes to the map share the model, the cam and the place, and nothing else with one another.
#[test]
fn routes_do_not_use_each_other() {
    let corner = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/corner");
    let text = |file: &str| std::fs::read_to_string(corner.join(file)).unwrap();
    for forbidden in ["flight", "simulate", "section", "impact", "one_sided", "finite_difference", "least_squares"] {
        for (line, used) in uses(&text("closed_form.rs").replace("super::", "crate::")) {
            assert_ne!(used, forbidden, "closed_form.rs:{line}");
        }
    }
    for file in ["finite_difference.rs", "least_squares.rs", "one_sided.rs", "simulated_orbit.rs"] {
        assert!(!text(file).contains("closed_form") && !text(file).contains("variational"), "{file}");
    }
    // The product around the orbit knows the laws and the orbit, and neither runs it nor looks at another route.
    for file in ["variational.rs", "varied.rs"] {
        for forbidden in ["closed_form", "finite_difference", "least_squares", "one_sided", "advance(", ".turn("] {
            assert!(!text(file).contains(forbidden), "{file}: {forbidden}");
        }
    }
}

/// What a jump of any order makes of the map is predicted without a run, and measured without a formula of it.
#[test]
fn prediction_and_measurement_share_nothing() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/corner/jump_order");
    let code = |file: &str| {
        let text = std::fs::read_to_string(folder.join(file)).unwrap();
        text.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
    };
    for forbidden in ["simulate", "section", "flight::", "measured", "extrapolation", "least_squares", "one_sided"] {
        assert!(!code("predicted.rs").contains(forbidden), "predicted.rs: {forbidden}");
    }
    for forbidden in ["predicted", "closed_form", "jump_order.", ".jump,", "corner.jump", "curvature", "third", "slope"]
    {
        assert!(!code("measured.rs").contains(forbidden), "measured.rs: {forbidden}");
    }
}

/// One event loop, one tolerance table: small numbers that decide something stand in the table.
#[test]
fn thresholds_stand_in_the_table() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for file in rust_files(&root) {
        if file.ends_with("tolerance.rs") {
            continue;
        }
        let text = std::fs::read_to_string(&file).unwrap();
        let code = text.split("#[cfg(test)]").next().unwrap();
        for (number, line) in code.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//")) {
            let compares = line.contains('<') || line.contains('>');
            // 1e-9, but not stroke-width.
            let small = line.match_indices("e-").any(|(at, _)| line[..at].ends_with(|c: char| c.is_ascii_digit()));
            assert!(!(compares && small), "{}:{}: {line}", file.display(), number + 1);
        }
    }
}
