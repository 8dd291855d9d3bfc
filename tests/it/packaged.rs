//! Is what the code embeds in the package that is published, and nothing else beside the code?

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::ROOT;

/// Files of a package that no `include_str!` names: Cargo's own, licences and the front page.
const BESIDE: [&str; 7] = [
    ".cargo_vcs_info.json",
    "Cargo.lock",
    "Cargo.toml",
    "Cargo.toml.orig",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "README.md",
];

#[test]
#[ignore = "slow"]
fn each_package_has_what_its_code_embeds() {
    for (package, folder) in [
        ("corner-impact", "."),
        ("corner-impact-plot", "crates/plot"),
        ("corner-impact-explore", "crates/explore"),
        ("corner-impact-cli", "crates/program"),
    ] {
        let folder = Path::new(ROOT).join(folder);
        let packed = packed(package);
        for file in BESIDE {
            assert!(packed.contains(file), "{package} has no {file}");
        }
        let mut embedded = BTreeSet::new();
        for source in files(&folder.join("src")) {
            embedded.extend(embedded_by(&source, &folder));
        }
        let missing: Vec<&String> = embedded.difference(&packed).collect();
        assert!(missing.is_empty(), "{package} lacks {missing:?}");
        let outside = |name: &&String| !name.starts_with("src/") && !BESIDE.contains(&name.as_str());
        let outside: Vec<&String> = packed.iter().filter(outside).collect();
        // A build script and what it reads.
        let built =
            |name: &str| package == "corner-impact-cli" && ["build.rs", "module/explore.wasm.gz"].contains(&name);
        let unused: Vec<&&String> = outside.iter().filter(|name| !embedded.contains(**name) && !built(name)).collect();
        assert!(unused.is_empty(), "{package} has {unused:?}, which its code does not embed");
    }
}

/// The files of a package, as cargo lists them.
fn packed(package: &str) -> BTreeSet<String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let list = ["package", "--list", "--allow-dirty", "--offline", "--package", package];
    let output = Command::new(cargo).args(list).current_dir(ROOT).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let listed = String::from_utf8(output.stdout).unwrap();
    listed.lines().map(|line| line.replace('\\', "/")).collect()
}

/// Paths from the package's folder of the files that a source embeds.
fn embedded_by(source: &Path, folder: &Path) -> BTreeSet<String> {
    let text = std::fs::read_to_string(source).unwrap();
    // A page of docs/ is embedded where its examples are tested, and nowhere else.
    let text = text.replace("#[doc = include_str!(\"../docs/theory.md\")]", "");
    let named = text.split("include_str!(\"").skip(1).filter_map(|rest| rest.split_once('"'));
    let root = folder.canonicalize().unwrap();
    let of = |(name, _): (&str, &str)| {
        let path = source.parent().unwrap().join(name).canonicalize().unwrap();
        path.strip_prefix(&root).unwrap().to_string_lossy().replace('\\', "/")
    };
    named.map(of).collect()
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries
        .flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|end| end == "rs"))
        .collect()
}
