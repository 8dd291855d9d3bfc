//! Does every name lead to something that exists, and does every number of the report have one?

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::common::{self, corner_impact, text};
use crate::labels::LABELS;
use crate::page::papers;
use corner_impact::model::Model;
use corner_impact::progress::Unwatched;
use corner_impact::study::compare::compare;
use corner_impact::study::verify::{External, verify};
use corner_impact_cli::explain::{Explanation, Findings, Links};
use corner_impact_cli::show::Paged;
use serde_json::Value;

fn file(name: &str) -> String {
    let path: PathBuf = Path::new(common::ROOT).join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Every statement that the derivations prove, those about the printed equations among them.
fn statements() -> BTreeSet<String> {
    let [proofs, printed] = ["proofs", "printed_equations"]
        .map(|name| serde_json::from_str::<Value>(&file(&format!("golden/derived/{name}.json"))).unwrap());
    let stages = proofs["stages"].as_array().unwrap().iter();
    let proved = stages.flat_map(|stage| stage["proved"].as_array().into_iter().flatten());
    let equations = printed["equations"].as_array().unwrap().iter().map(|equation| &equation["statement"]);
    proved.chain(equations).map(|statement| statement.as_str().unwrap().to_owned()).collect()
}

/// Function, constant or test of that name is in the file; the statement among those that are proved.
fn leads_somewhere(it: &Explanation, statements: &BTreeSet<String>) {
    let what = &it.what;
    if let Some(code) = &it.code {
        let text = file(&code.file);
        let declared = [format!("fn {}", code.function), format!("    {} =", code.function)];
        let ends = |rest: &str| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_');
        let is_there = |name: &String| text.match_indices(name).any(|(at, _)| ends(&text[at + name.len()..]));
        assert!(declared.iter().any(is_there), "{what}: no {} in {}", code.function, code.file);
    }
    for test in &it.tests {
        assert!(
            file(&test.file).contains(&format!("fn {}()", test.test)),
            "{what}: no test {} in {}",
            test.test,
            test.file
        );
    }
    if let Some(proof) = &it.derivation {
        assert!(Path::new(common::ROOT).join(&proof.script).is_file(), "{what}: {}", proof.script);
        assert!(statements.contains(&proof.statement), "{what}: nobody proves \"{}\"", proof.statement);
    }
}

#[test]
#[ignore = "slow"]
fn every_link_leads_to_something_that_exists() {
    let (links, model, statements) = (Links::read().unwrap(), Model::built_in().unwrap(), statements());
    let found = verify(&model, External::LeftOut).unwrap();
    let findings = Findings::new(&model, Some(&found)).unwrap();
    let names = links.names();
    assert!(names.len() > 300, "{}", names.len());
    let mut seen = BTreeSet::new();
    for (name, _) in &names {
        let it = links.explain(name, &findings).unwrap();
        leads_somewhere(&it, &statements);
        assert!(!it.sentence.is_empty() && !it.sentence.contains("{m"), "{name}: {}", it.sentence);
        for input in &it.inputs {
            assert!(input.value.is_some(), "{name}: no value of {}", input.name);
            links.explain(&input.name, &findings).unwrap();
        }
        let is_claim = it.tests.iter().any(|test| test.file.ends_with("ledger.rs"));
        // What is computed or sampled is evaluated somewhere, and something would notice if it were not.
        assert!(it.code.is_some() || it.known == corner_impact::known::Evidence::Read, "{name}");
        assert!(!it.tests.is_empty(), "{name}");
        // A name that stands for two things stands for the first.
        assert!(
            seen.insert(name.clone()) || is_claim || name.starts_with("eq:") || name.starts_with("Eq:"),
            "{name} twice"
        );
    }
}

/// Where a value by a route is missing, the page says so.
#[test]
fn routes_that_did_not_run_are_told() {
    let (links, model) = (Links::read().unwrap(), Model::built_in().unwrap());
    let found = verify(&model, External::LeftOut).unwrap();
    let it = links.explain("B_minus", &Findings::new(&model, Some(&found)).unwrap()).unwrap();
    for route in ["symbolic", "scipy", "certificate"] {
        assert!(!it.routes.contains_key(route) && it.skipped.iter().any(|one| one.route == route), "{route}: {it:?}");
    }
    let page = it.text().unwrap();
    assert!(page.contains("not run   symbolic, scipy, certificate (`verify` says why)"), "{page}");
    // What is no route to it, as the digits in print, misses from no other model.
    let other = common::read("models/damped-light.toml".as_ref());
    let found_there = verify(&other, External::LeftOut).unwrap();
    assert!(found_there.skipped.iter().any(|one| one.route == "published"));
    let there = links.explain("B_minus", &Findings::new(&other, Some(&found_there)).unwrap()).unwrap();
    assert_eq!(
        there.skipped.iter().map(|one| &one.route[..]).collect::<Vec<_>>(),
        ["symbolic", "scipy", "certificate"]
    );
    // One that no route computes misses none.
    let alone = links.explain("CAM_JUMP", &Findings::new(&model, Some(&found)).unwrap()).unwrap();
    assert!(alone.skipped.is_empty(), "{alone:?}");
}

#[test]
fn every_label_is_reached() {
    let (links, model) = (Links::read().unwrap(), Model::built_in().unwrap());
    let findings = Findings::new(&model, None).unwrap();
    for label in LABELS {
        let it = links.explain(label, &findings).unwrap();
        assert!(it.formula.is_some() && it.code.is_some(), "{label}");
    }
}

/// The words of a table's first line, in every place where the program writes one.
#[test]
fn every_column_of_every_table_is_reached() {
    let (links, model) = (Links::read().unwrap(), Model::built_in().unwrap());
    let findings = Findings::new(&model, None).unwrap();
    let code = file("crates/program/src/show/csv.rs");
    let is_word =
        |word: &str| !word.is_empty() && word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
    let mut reached = BTreeSet::new();
    let unbroken = code.replace("\\\n         ", "");
    for written in unbroken.split('"').filter(|written| written.contains(',')) {
        let words: Vec<&str> = written.trim_end_matches("\\n").split(',').filter(|word| !word.contains('{')).collect();
        if words.iter().all(|word| is_word(word) || word.is_empty()) {
            for word in words.into_iter().filter(|word| is_word(word)) {
                links.explain(word, &findings).unwrap_or_else(|error| panic!("{error}"));
                reached.insert(word);
            }
        }
    }
    assert!(reached.len() > 50, "{reached:?}");
}

/// Numbers that are not inside of an element that says what they stand for.
fn unexplained(page: &str) -> Vec<String> {
    let (mut open, mut found): (Vec<(String, bool)>, Vec<String>) = (Vec::new(), Vec::new());
    for part in page.split('<').skip(1) {
        let (tag, rest) = part.split_once('>').unwrap_or((part, ""));
        let name: String = tag.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '/').collect();
        if let Some(closed) = name.strip_prefix('/') {
            while open.pop().is_some_and(|(name, _)| name != closed) {}
        } else if !["br", "meta", "input", "hr", "!DOCTYPE"].contains(&name.as_str()) && !tag.ends_with('/') {
            let is_about = tag.contains("data-about=\"") || tag.starts_with("section id=\"numbers\"");
            let is_number = name == "data" || tag.contains(" data-value=\"");
            if is_number && !is_about && !open.iter().any(|(_, is_about)| *is_about) {
                found.push(rest.chars().take(30).collect());
            }
            open.push((name, is_about));
        }
    }
    found
}

/// Each number of a report stands for something, and what that is stands at its end.
pub fn all_are_explained(page: &str) {
    // Scripts and styles hold signs that are no tags.
    let body = page.split("<main").nth(1).unwrap().split("</main>").next().unwrap();
    assert_eq!(unexplained(body), Vec::<String>::new());
    let names: BTreeSet<&str> = body.split("data-about=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert!(names.len() > 3 && names.iter().all(|name| body.contains(&format!("id=\"explain-{name}\""))), "{names:?}");
}

#[test]
#[ignore = "slow"]
fn every_number_of_the_report_is_explained() {
    all_are_explained(&papers().1);
    assert_eq!(unexplained("<p><data value=\"1\">1</data></p>"), ["1"]);
    assert_eq!(unexplained("<tr><td data-value=\"2\">2</td><td data-about=\"a\" data-value=\"3\">3</td></tr>"), ["2"]);
}

#[test]
fn the_document_has_the_fields_of_the_contract() {
    let output = corner_impact(["explain", "B_minus", "--json", "--no-external"]);
    let it: Value = serde_json::from_str(&text(output.stdout)).unwrap();
    assert_eq!(it["schema"], "corner-impact/explain/1");
    assert_eq!(it["label"], "eq:PT");
    assert_eq!(it["code"]["function"], "side_map");
    assert!(it["derivation"]["script"].is_string() && it["derivation"]["statement"].is_string());
    assert!(it["tests"][0]["file"].is_string() && it["tests"][0]["test"].is_string());
    let found = verify(&common::osorio(), External::LeftOut).unwrap();
    for (route, b) in it["routes"].as_object().unwrap() {
        let own = found.routes.iter().find(|own| own.name.to_string() == *route).unwrap();
        assert_eq!(b[1].as_f64().unwrap(), own.map.minus.b[1], "{route}");
    }
    assert_eq!(it["routes"].as_object().unwrap().len(), found.routes.len());
    assert_eq!(it["value"][0].as_f64().unwrap(), found.map.minus.b[0]);
}

/// As a reader writes them, and as `compare` does.
#[test]
fn entries_and_symbols_lead_to_what_they_are_of() {
    let (links, model) = (Links::read().unwrap(), Model::built_in().unwrap());
    let findings = Findings::new(&model, None).unwrap();
    let formula = |name: &str| links.explain(name, &findings).unwrap().formula;
    for (name, of) in [
        ("A-", "A_minus"),
        ("A_minus_21", "A_minus"),
        ("B_plus_2", "B_plus"),
        ("x_star_1", "x_star"),
        ("x*", "x_star"),
        ("eigenvalues_plus_1_re", "eigenvalues_plus"),
        ("lambda", "eigenvalues_minus"),
        ("A-bar", "A_bar_minus"),
        ("v before", "velocity_before"),
        ("Linear range", "linear_range"),
    ] {
        assert_eq!(formula(name), formula(of), "{name}");
    }
    assert_eq!(links.explain("zeta", &findings).unwrap().value, Some(0.0.into()));
    assert!(links.explain("q_1", &findings).is_err() && links.explain("7", &findings).is_err());
}

/// Each of them with the value that it has there.
#[test]
fn every_name_that_compare_has_is_reached() {
    let (links, model) = (Links::read().unwrap(), Model::built_in().unwrap());
    let found = verify(&model, External::LeftOut).unwrap();
    let findings = Findings::new(&model, Some(&found)).unwrap();
    let text = file("models/osorio-2008.toml").replace("restitution = 0.8", "restitution = 0.7");
    let other = Model::parse("other.toml", &text).unwrap();
    let moved = compare(&model, &other, External::LeftOut, &Unwatched).unwrap();
    assert!(moved.changes.len() > 90, "{}", moved.changes.len());
    for change in moved.changes.iter().chain(&moved.unchanged).filter(|change| change.a.is_some()) {
        let it = links.explain(&change.quantity, &findings).unwrap_or_else(|error| panic!("{error}"));
        assert!(it.code.is_some(), "{}", change.quantity);
        assert_eq!(it.value, change.a, "{}", change.quantity);
    }
}

#[test]
#[ignore = "slow"]
fn a_label_and_a_claim_tell_all() {
    let (links, model) = (Links::read().unwrap(), Model::built_in().unwrap());
    let found = verify(&model, External::LeftOut).unwrap();
    let findings = Findings::new(&model, Some(&found)).unwrap();
    let also = |what: &str| links.explain(what, &findings).unwrap().also;
    let statements = ["region", "acceleration", "continuity"].map(|which| format!("equation: eq:pwlf, {which}"));
    assert_eq!(also("eq:pwlf"), [&["D".to_owned()], &statements[..]].concat());
    assert_eq!(also("eq:PT"), ["B_plus"]);
    assert!(also("C").is_empty() && also("B_minus").is_empty());
    assert_eq!(links.explain("restitution", &findings).unwrap().value, Some(0.8.into()));
    let evidence = links.explain("odd count", &findings).unwrap().evidence.unwrap();
    let claims = corner_impact(["claims", "--json"]);
    let claims: Value = serde_json::from_str(&text(claims.stdout)).unwrap();
    let claim = claims["claims"].as_array().unwrap().iter().find(|claim| claim["id"] == "odd count").unwrap();
    assert_eq!(claim["evidence"].as_str().unwrap(), evidence);
}

#[test]
fn what_is_not_known_is_refused_with_what_is_near() {
    let output = corner_impact(["explain", "B_mins"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(output.stderr).contains("did you mean B_minus?"));
}
