//! Statements of the paper with their verdicts, with a filter and a search.

use std::collections::BTreeMap;

use maud::html;

use crate::explain::Links;
use crate::pages::explain::behind;
use crate::pages::report::html::HtmlError;
use crate::report::Report;
use crate::show::block::{Block, PageSection, Words};
use crate::show::html::sentence;
use crate::show::html::words;
use crate::show::words::{slips, verdict, verdict_word};
use corner_impact::published::Verdict;

/// URL fragments of claims: letters and digits of their ids.
fn anchors<'a>(ids: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let anchor = |id: &str| {
        let words: Vec<&str> =
            id.split(|letter: char| !letter.is_ascii_alphanumeric()).filter(|word| !word.is_empty()).collect();
        let name = format!("claim-{}", words.join("-"));
        let count = seen.entry(name.clone()).or_default();
        *count += 1;
        if *count == 1 { name } else { format!("{name}-{count}") }
    };
    ids.map(anchor).collect()
}

pub(crate) fn section(report: &Report) -> Result<Option<PageSection>, HtmlError> {
    let Some(ledger) = report.claims.as_ref() else { return Ok(None) };
    let links = Links::read()?;
    let behind_claims = links.of_claims();
    let anchors = anchors(ledger.claims.iter().map(|claim| claim.id.as_str()));
    let anchor_of = |id: &str| {
        let found = ledger.claims.iter().position(|claim| claim.id == id);
        found.map_or("claims", |index| anchors[index].as_str())
    };
    // Parts that all claims share are shown once.
    let parts_of = |id: &str| behind_claims.get(id).map(behind).unwrap_or_default();
    let mut tests = ledger.claims.iter().map(|claim| parts_of(&claim.id)[2].clone());
    let shared = tests.next().filter(|first| !first.is_empty() && tests.all(|other| other == *first));
    let behind_of = |id: &str| {
        let parts = parts_of(id)
            .into_iter()
            .enumerate()
            .filter(|(index, part)| !part.is_empty() && (*index < 2 || shared.is_none()));
        Words::joined(parts.map(|(_, part)| part), "; ")
    };
    let body = html! {
        p {
            "Every displayed equation, number, statement and figure of the paper, in words of this project, with a verdict and the "
            "evidence for it. All of it is about " (ledger.source) ". A " em { "misprint" } " is an error in what is printed, on which no result rests. "
            "A " em { "refuted" } " statement is wrong. A statement that holds " em { "in part" } " has a row that says what is wrong. In a "
            em { "definition" } " there is nothing to check. An " em { "open" } " statement is not decided here. The refuted statements are "
            (slips(ledger.slips_and_consequences(Verdict::Refuted))) " of them, and the misprints are "
            (slips(ledger.slips_and_consequences(Verdict::Misprint))) "."
            @if let Some(test) = &shared { " Every check is run by the test " (words(test)) "." }
        }
        div.ledger-page {
        form.filter id="ledger-filter" {
            fieldset {
                legend { "Verdict" }
                label { input type="radio" name="verdict" value="all" id="verdict-all" checked; " all (" (ledger.claims.len()) ")" }
                @for (verdict, held) in ledger.groups() {
                    label {
                        input type="radio" name="verdict" value=(verdict) id={ "verdict-" (verdict) };
                        " " (verdict_word(verdict)) " (" (held.len()) ")"
                    }
                }
            }
            label.search hidden { "Words " input type="search" id="ledger-search" autocomplete="off"; }
            p.count role="status" id="ledger-count" {}
        }
        ol.ledger id="ledger-entries" {
            @for (claim, anchor) in ledger.claims.iter().zip(&anchors) {
                li class={ "claim v-" (claim.verdict) } id=(anchor) data-verdict=(claim.verdict) {
                    p.head { (words(&verdict(claim.verdict))) " " a href={ "#" (anchor) } { (claim.id) } " " span.place { (claim.place) } }
                    p { (sentence(&claim.statement)) }
                    @if let Some(correct) = &claim.correct { p.correct { "Right: " (sentence(correct)) } }
                    @for slip in claim.slips.iter().filter(|slip| **slip != claim.id) {
                        p { "Wrong because of the error in " a href={ "#" (anchor_of(slip)) } { (slip) } "." }
                    }
                    details {
                        summary { "Evidence, " (claim.known) }
                        p.evidence { (sentence(&claim.evidence)) }
                        @let behind = behind_of(&claim.id);
                        @if !behind.is_empty() { p.behind { (words(&behind)) } }
                    }
                    @if !claim.as_found { p.disagrees { "The check contradicts the ledger." } }
                }
            }
        }
        }
    };
    Ok(Some(PageSection { id: "claims", title: "The paper's claims".into(), blocks: vec![Block::Markup(body)] }))
}
