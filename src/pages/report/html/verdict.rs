//! The headline: what agrees, to how many digits, and what does not.

use maud::{Markup, html};

use crate::show::{html, words};

use crate::pages::report::dossier::Dossier;
use crate::pages::report::html::Section;
use crate::pages::report::html::numbers::{fixed, size};
use crate::published::Verdict;

pub(crate) fn section(dossier: &Dossier) -> Section {
    let head = &dossier.headline;
    let verdict = match (&dossier.verification, dossier.agrees) {
        (None, _) => "There is no corner impact to verify: nothing was checked, and nothing disagrees.",
        (Some(_), true) => "Everything that was checked agrees.",
        (Some(_), false) => "Something that was checked does not agree.",
    };
    let body = html! {
        p class={ "verdict " (if dossier.agrees { "agrees" } else { "disagrees" }) } { (verdict) }
        @if let Some(found) = &dossier.verification {
            ul.findings {
                li {
                    strong { (head.agreeing) " of " (head.comparisons) } " comparisons between "
                    (head.routes.len()) " routes to the local map agree"
                    @if head.agreeing > 0 { "; every entry of A and B shares " (words::shared(head.shared_decimals)) " or more" } "."
                }
                li {
                    "The corner impact is at " strong { (fixed(found.at.speed_rpm(), 6)) " rpm" }
                    @if let Some(angle) = dossier.corner_deg { ", where the cam has turned by " (fixed(angle, 4)) "°" }
                    @match &found.classification {
                        Ok(kind) => { ". It is a " strong { (words::spoken(&kind.scenario.to_string())) } "." }
                        Err(_) => { ". It has no classification." }
                    }
                }
                @if head.printed > 0 {
                    li {
                        "Of the paper's " (head.printed) " printed numbers " strong { (head.printed_right) " hold" } ", "
                        (head.printed_wrong) " are wrong as the ledger says, and "
                        (head.printed_otherwise) " came out otherwise."
                    }
                }
                @if let Some(ledger) = &dossier.claims {
                    @let count = |verdict| ledger.counts.get(&verdict).copied().unwrap_or_default();
                    li {
                        "Of the paper's " (ledger.claims.len()) " statements " strong { (count(Verdict::Holds)) " hold" } ", "
                        (count(Verdict::Misprint)) " are misprints, " (count(Verdict::Refuted)) " are refuted and "
                        (count(Verdict::Open)) " open; "
                        @if head.claims_otherwise == 0 { "every check comes to the ledger's verdict." }
                        @else { (head.claims_otherwise) " came out otherwise than the ledger says." }
                    }
                }
            }
            (disagreements(dossier))
            @if !found.skipped.is_empty() {
                h3 { "Not run" }
                ul { @for skipped in &found.skipped { li { (words::spoken(&skipped.route)) ": " (skipped.why) @if skipped.failed { " It should have run." } } } }
            }
        }
        @if let Some(why) = &dossier.nothing_to_verify { p { "In the words of the search: " } pre.why { (why) } }
    };
    Section { id: "findings", title: "Findings", body }
}

fn disagreements(dossier: &Dossier) -> Markup {
    let Some(found) = &dossier.verification else { return html! {} };
    let pairs: Vec<_> = found.comparisons.iter().filter(|entry| !entry.agrees).collect();
    let numbers: Vec<_> = found.published.iter().filter(|number| !number.as_found).collect();
    let claims = dossier.claims.iter().flat_map(|ledger| &ledger.claims).filter(|claim| !claim.as_found);
    let claims: Vec<_> = claims.collect();
    if pairs.is_empty() && numbers.is_empty() && claims.is_empty() {
        return html! {};
    }
    html! {
        h3 { "What does not agree" }
        ul {
            @for entry in pairs {
                li {
                    (html::words(&words::quantity(entry.quantity))) " by " (words::route(entry.routes[0])) " and " (words::route(entry.routes[1]))
                    " differs by " (size(entry.max_abs_diff)) ", allowed is " (size(entry.bound.value))
                }
            }
            @for number in numbers { li { (html::words(&words::quantity(number.agreement.quantity))) " in print (" (number.place) ") came out otherwise" } }
            @for claim in claims { li { "the claim " (claim.id) " came out otherwise" } }
        }
    }
}
