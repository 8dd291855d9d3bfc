//! Does `grep` lead from an equation of the paper to the line that computes it, and from derivations/README.md to the code?

use std::path::{Path, PathBuf};

use crate::layering::{packages, rust_files};

/// The labels of the paper's equations.
pub const LABELS: [&str; 26] = [
    "eq:fb1",
    "eq:i1",
    "eq:lmap_g",
    "eq:fbsol1",
    "eq:gff",
    "eq:lmaptheta_1",
    "eq:H",
    "eq:impactdynamics_1",
    "eq:impactdynamics_2",
    "eq:impactdynamics_3",
    "eq:lmapd",
    "eq:lmap",
    "eq:fixedp",
    "eq:linearmap",
    "eq:dPdx",
    "Eq:dP_dxn",
    "Eq:dP_dti",
    "Eq:dti_dxn",
    "eq:ftaylormapcornerX",
    "eq:dPdT",
    "Eq:dP_dT",
    "Eq:dti_dT",
    "eq:ftaylormapcornerT",
    "eq:Px",
    "eq:PT",
    "eq:pwlf",
];

/// Steps of the paper that the program does not take, and why. All of them are proved or repaired in `derivations/`.
const NOT_TAKEN: [(&str, &str); 5] = [
    ("eq:dPdx", "a chain rule; the saltation matrix has both of its terms in one"),
    ("eq:dPdT", "a chain rule; the variational route adds what T changes flight by flight"),
    ("Eq:dP_dxn", "a term of the chain rule by x"),
    ("Eq:dP_dti", "a term of both chain rules"),
    ("Eq:dP_dT", "a term of the chain rule by T"),
];

/// The code of the crate but for the ledger, which names every equation.
fn code() -> Vec<(String, String)> {
    let of_package = |root: PathBuf| {
        let files = rust_files(&root);
        let named = move |file: PathBuf| {
            let name = file.strip_prefix(&root).unwrap().to_str().unwrap().to_owned();
            (name, std::fs::read_to_string(&file).unwrap())
        };
        files.into_iter().map(named).collect::<Vec<_>>()
    };
    let files = packages().flat_map(of_package);
    files.filter(|(name, _)| !name.starts_with("paper/")).collect()
}

/// Whether a label stands in a text, and not only as the beginning of a longer one.
fn has(text: &str, label: &str) -> bool {
    let ends = |rest: &str| !rest.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '_');
    text.match_indices(label).any(|(at, _)| ends(&text[at + label.len()..]))
}

#[test]
fn every_equation_of_the_paper_is_found_in_the_code() {
    let code = code();
    for label in LABELS {
        let found = code.iter().any(|(_, text)| has(text, label));
        let excused = NOT_TAKEN.iter().any(|(name, _)| *name == label);
        assert!(found != excused, "{label}: in the code {found}, in the list of what is not taken {excused}");
    }
    let known = |label: &str| LABELS.contains(&label);
    for (file, text) in &code {
        for word in text.split(|c: char| !c.is_ascii_alphanumeric() && !"_:".contains(c)) {
            let is_label = word.strip_prefix(['e', 'E']).is_some_and(|rest| rest.starts_with("q:"));
            assert!(!is_label || known(word.trim_end_matches(':')), "{file}: {word} is no label of the paper");
        }
    }
}

/// The table of derivations names files and paths of the code: each of them exists.
#[test]
fn what_the_derivations_name_exists() {
    let root = Path::new(crate::common::ROOT);
    let page = std::fs::read_to_string(root.join("derivations/README.md")).unwrap();
    let code = code();
    let mut checked = 0;
    for name in page.split('`').skip(1).step_by(2) {
        if name.ends_with(".py") || name.ends_with(".json") || name.ends_with(".rs") || name.ends_with(".toml") {
            let places = ["", "derivations/", "golden/derived/"].map(|folder| root.join(folder).join(name));
            assert!(places.iter().any(|place| place.is_file()), "{name}");
            checked += 1;
        } else if let Some((modules, last)) = name.rsplit_once("::") {
            let file = modules.replace("::", "/");
            let own = [format!("{file}/{last}.rs"), format!("{file}/{last}/mod.rs")];
            let holds = |name: &str, text: &str| {
                own.contains(&name.to_owned())
                    || ([format!("{file}.rs"), format!("{file}/mod.rs")].contains(&name.to_owned())
                        && text.contains(&format!("fn {last}(")))
            };
            assert!(code.iter().any(|(name, text)| holds(name, text)), "{name}");
            checked += 1;
        }
    }
    assert!(checked > 20, "{checked}");
}
