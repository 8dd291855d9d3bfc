//! Are claims, checks and evidence one set, and does each check come to the ledger's verdict?

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::OnceLock;

use crate::common;
use corner_impact::known::Evidence;
use corner_impact::model::Model;
use corner_impact::paper::checks::{CHECKS, Check, find};
use corner_impact::paper::ledger::claims;
use corner_impact::paper::{Claims, Context};
use corner_impact::progress::Unwatched;
use corner_impact::published::Verdict;
use corner_impact::study::verify::{External, verify};
use corner_impact_cli::pages;
use corner_impact_cli::show::markdown;

fn held(model: &Model) -> Claims {
    let findings = verify(model, External::LeftOut).unwrap();
    let cam = common::cam(model);
    Claims::hold(&Context::new(model, &cam, &findings).unwrap(), &Unwatched).unwrap()
}

/// Of the paper's model, made once.
fn papers() -> &'static Claims {
    static MADE: OnceLock<Claims> = OnceLock::new();
    MADE.get_or_init(|| held(&common::osorio()))
}

#[test]
fn claims_and_checks_are_the_same_set() {
    let listed: Vec<String> = claims().unwrap().into_iter().map(|claim| claim.id).collect();
    let ids: BTreeSet<&str> = listed.iter().map(String::as_str).collect();
    let checked: BTreeSet<&str> = CHECKS.iter().map(|(id, _)| *id).collect();
    assert_eq!(ids.len(), listed.len(), "no id twice");
    assert_eq!(checked.len(), CHECKS.len(), "no check twice");
    assert!(checked.is_subset(&ids), "{:?}", checked.difference(&ids));
    for id in ids {
        assert!(find(id).is_some(), "{id}");
    }
}

/// Nothing that the derivations judged, or that the paper prints in digits, is left out of the ledger.
#[test]
fn every_equation_and_every_number_has_its_claim() {
    let root = Path::new(common::ROOT);
    let read = |file: &str| -> serde_json::Value {
        serde_json::from_str(&std::fs::read_to_string(root.join(file)).unwrap()).unwrap()
    };
    let equations = read("golden/derived/printed_equations.json");
    let numbers = read("golden/published/osorio-2008.json");
    let ids: BTreeSet<String> = claims().unwrap().into_iter().map(|claim| claim.id).collect();
    for equation in equations["equations"].as_array().unwrap() {
        let id = format!("equation: {}", equation["label"].as_str().unwrap());
        assert!(ids.contains(&id), "{id}");
    }
    for number in numbers["numbers"].as_array().unwrap() {
        let id = format!("number: {}", number["quantity"].as_str().unwrap());
        assert!(ids.contains(&id), "{id}");
    }
}

#[test]
#[ignore = "slow"]
fn every_check_comes_to_the_ledgers_verdict() {
    for held in &papers().claims {
        assert!(held.as_found, "{held:#?}");
        assert_eq!(held.verdict, held.listed, "{held:#?}");
        assert!(!held.evidence.is_empty(), "{held:#?}");
    }
    for claim in claims().unwrap() {
        let wrong = [Verdict::Misprint, Verdict::Refuted].contains(&claim.verdict);
        let corrected = wrong || claim.verdict == Verdict::InPart;
        assert_eq!(claim.correct.is_some(), corrected, "a wrong statement says what is right: {claim:#?}");
    }
}

/// Every slip is made by a statement that is wrong, and each wrong statement has one: its own or one made elsewhere.
#[test]
#[ignore = "slow"]
fn consequences_lead_to_the_slips_that_they_are_of() {
    let found = papers();
    let makes = |id: &str| found.claims.iter().any(|held| held.id == id && held.makes_a_slip());
    for claim in claims().unwrap() {
        let held = found.claims.iter().find(|held| held.id == claim.id).unwrap();
        let wrong = [Verdict::Misprint, Verdict::Refuted].contains(&claim.verdict);
        assert_eq!(held.slips.is_empty(), !wrong, "{held:#?}");
        assert!(claim.slips.is_empty() || wrong, "{claim:#?}");
        assert!(held.slips.iter().all(|slip| makes(slip)), "{held:#?}");
    }
    let made = |verdict: Verdict| {
        let of = found.claims.iter().filter(|held| held.verdict == verdict);
        let (slips, consequences): (Vec<_>, Vec<_>) = of.partition(|held| held.makes_a_slip());
        (slips.into_iter().map(|held| held.id.as_str()).collect::<Vec<_>>(), consequences.len())
    };
    assert_eq!(made(Verdict::Refuted), (vec!["equation: eq:pwlf, region", "equation: B tilde", "five decimals"], 5));
}

/// What somebody read is known by reading, the others by what was proved, computed or sampled; and every word occurs.
#[test]
#[ignore = "slow"]
fn every_verdict_says_how_it_is_known() {
    let claims = &papers().claims;
    for held in claims {
        let check = find(&held.id).unwrap();
        assert_eq!(matches!(check, Check::Read(..)), held.known == Evidence::Read, "{held:#?}");
        let proof = matches!(check, Check::Equation(_) | Check::Proofs(..));
        assert_eq!(proof, held.known == Evidence::Proved, "{held:#?}");
    }
    let words: BTreeSet<Evidence> = claims.iter().map(|held| held.known).collect();
    assert_eq!(words.len(), 4, "{words:?}");
}

/// What the ledger tells of the drawn cams, from the coordinates as a reader of the source finds them.
#[test]
#[ignore = "slow"]
fn the_drawn_cams_are_as_the_ledger_says() {
    let claims = &papers().claims;
    let says = |id: &str, parts: &[&str]| {
        let evidence = &claims.iter().find(|held| held.id == id).unwrap().evidence;
        for part in parts {
            assert!(evidence.contains(part), "{part} in {evidence}");
        }
    };
    // |(1.8114, 3.4764) - (3.25, 4)| = 1.53091 for 3.5310 - 2, and so on; 147.1976 - 143.4024 and 36.5976 - 32.8367.
    says("figure: camprofileeq", &["at most 0.005, with", "3.8 deg past P"]);
    // |(5.2021, 2.8811) - (3.25, 4)| = 2.25004, |(3.5945, 5.9901) - (3.25, 4)| = 2.01970, radii 2, 4.25, 0.745, 2.77.
    let lengths = "0.40000, 0.45001, 0.85000, 0.40394, 0.14900, 0.55400";
    says("figure: camprofile (a)", &[lengths, "The angle from R to P is 60.1794 deg", "differ from the model: rho2"]);
    says("equation: theta_i", &["20.00, -62.03, -70.00 deg", "70.00, 152.03, 160.00 deg"]);
    says("figure: cam-shaft", &["g = 117.18 m/s^2"]);
}

/// Checks compute: with another restitution the paper's statements about its own map do not simply keep their verdicts.
#[test]
#[ignore = "slow"]
fn a_check_that_sees_another_map_finds_something_else() {
    let mut model = common::osorio();
    let findings =
        verify(&common::osorio_with(&[("restitution", "0.3"), ("rpm_max", "900.0")]), External::LeftOut).unwrap();
    let cam = common::cam(&model);
    // The paper's model by its numbers, with another map under it.
    let context = Context::new(&model, &cam, &findings).unwrap();
    let changed: Vec<String> = Claims::hold(&context, &Unwatched)
        .unwrap()
        .claims
        .into_iter()
        .filter(|held| !held.as_found)
        .map(|held| held.id)
        .collect();
    for id in ["number: A_minus", "fixed points above, none below", "transition at the corner"] {
        assert!(changed.iter().any(|found| found == id), "{id} among {changed:?}");
    }
    // And with another speed range it is the same model.
    model.name = "other".into();
    assert!(held(&model).claims.iter().all(|held| held.as_found));
}

#[test]
fn another_model_leaves_the_papers_numbers_open() {
    let files = common::model_files();
    let file = files.iter().find(|file| common::stem(file) == "damped-light").unwrap();
    let all = held(&common::read(file)).claims;
    assert!(all.iter().all(|held| held.as_found));
    for held in &all {
        if held.id.starts_with("number: ") {
            assert_eq!(held.verdict, Verdict::Open, "{held:#?}");
        }
        if matches!(find(&held.id).unwrap(), Check::Equation(_) | Check::Proofs(..)) {
            assert_eq!(held.verdict, held.listed, "{held:#?}");
        }
    }
}

#[test]
#[ignore = "slow"]
fn the_page_in_docs_is_fresh() {
    let (lead, sections) = pages::claims::document(papers()).unwrap();
    let page = markdown::page(&lead, &sections).unwrap();
    let stored = std::fs::read_to_string(Path::new(common::ROOT).join("docs/claims.md")).unwrap();
    assert!(page == stored, "docs/claims.md is stale: `make claims` writes it");
}

#[test]
#[ignore = "slow"]
fn the_json_document_has_the_fields_of_the_contract() {
    let file = common::model_files().into_iter().find(|file| common::stem(file) == "osorio-2008").unwrap();
    let output = common::program(["claims", "--json"]).arg(&file).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["schema"], "corner-impact/claims/1");
    for claim in document["claims"].as_array().unwrap() {
        for field in ["id", "where", "statement", "verdict", "known", "evidence"] {
            assert!(claim[field].is_string(), "{claim}");
        }
        let verdict = claim["verdict"].as_str().unwrap();
        assert!(["holds", "definition", "in-part", "misprint", "refuted", "open"].contains(&verdict));
        assert_eq!(claim["correct"].is_string(), ["in-part", "misprint", "refuted"].contains(&verdict), "{claim}");
        assert_eq!(claim["slips"].is_array(), ["misprint", "refuted"].contains(&verdict), "{claim}");
    }
}
