//! Headline of the report: agreement, its number of digits, and disagreements.

use maud::html;

use crate::pages::verify::tally;
use crate::report::Report;
use crate::show::block::{Block, PageSection, TextMark, Words, about, words};
use crate::show::digits::Digits;
use crate::show::words::{self, quantity, route, slips, spoken};
use corner_impact::published::Verdict;
use corner_impact::study::verify::Verification;

/// Headline; `None` if there was nothing to verify.
pub(crate) fn section(report: &Report) -> Option<PageSection> {
    let found = report.verification.as_ref().ok()?;
    let (class, verdict) = match report.agrees {
        true => ("verdict agrees", "Everything that was checked agrees."),
        false => ("verdict disagrees", "Something that was checked does not agree."),
    };
    let mut blocks = vec![Block::Markup(html! { p class=(class) { (verdict) } }), Block::List(findings(report, found))];
    for (title, items) in [("What does not agree", disagreements(report, found)), ("Not run", not_run(found))] {
        if !items.is_empty() {
            blocks.extend([Block::Heading(title.into()), Block::List(items)]);
        }
    }
    Some(PageSection { id: "findings", title: "Findings".into(), blocks })
}

/// Emphasized words in a sentence.
fn strong(text: &str) -> Words {
    (TextMark::Strong, text).into()
}

fn findings(report: &Report, found: &Verification) -> Vec<Words> {
    let kind = match &found.classification {
        Ok(kind) => {
            let verdict = spoken(&words::border_collision(kind, found.danger.as_ref()));
            let danger =
                found.danger.as_ref().map(|danger| words![" It is ", about("danger", words::danger(danger)), "."]);
            words!["It is a ", strong(&verdict), ".", danger.unwrap_or_default()]
        }
        Err(_) => "It has no classification.".into(),
    };
    let speed = about("speed_rpm", (found.at.speed_rpm(), Digits::Fixed(6)));
    let angle = about("corner", (found.at.corner.angle.to_degrees(), Digits::Fixed(4)));
    let place = "The corner impact is at {} rpm, where the cam has turned by {}°. {}";
    let mut findings = tally(found);
    findings.insert(1, Words::prose(place, [speed, angle, kind]));
    if let Some(ledger) = &report.claims {
        let count = |verdict| ledger.counts.get(&verdict).copied().unwrap_or_default();
        let [part, misprint, refuted, open, definitions] =
            [Verdict::InPart, Verdict::Misprint, Verdict::Refuted, Verdict::Open, Verdict::Definition]
                .map(|verdict| Words::from(count(verdict)));
        let hold = strong(&format!("{} hold", count(Verdict::Holds)));
        let checks = match report.claims_otherwise() {
            0 => "every check confirms the ledger's verdict".into(),
            some => words![some, " of the checks contradict the ledger"],
        };
        findings.push(Words::prose(
            "Of the {} statements in {}, {}, {} in part, {} are misprints, {} are refuted ({}), {} are open and {} are definitions; {}.",
            [
                ledger.claims.len().into(),
                ledger.source.into(),
                hold,
                part,
                misprint,
                refuted,
                slips(ledger.slips_and_consequences(Verdict::Refuted)).into(),
                open,
                definitions,
                checks,
            ],
        ));
    }
    findings
}

fn disagreements(report: &Report, found: &Verification) -> Vec<Words> {
    let pairs = found.comparisons.iter().filter(|pair| !pair.agrees).map(|pair| {
        let [one, other] = pair.routes.map(route);
        words![
            quantity(pair.quantity),
            format!(" by {one} and {other} differs by "),
            about("agreement", (pair.max_abs_diff, Digits::Size)),
            ", but the bound is ",
            about("bound", (pair.bound.value, Digits::Size))
        ]
    });
    let numbers = found.published.iter().filter(|number| !number.as_found).map(|number| {
        let name = quantity(number.agreement.quantity);
        words![name, format!(" in print ({}) contradicts its recorded verdict", number.place)]
    });
    let claims = report.claims.iter().flat_map(|ledger| &ledger.claims).filter(|claim| !claim.as_found);
    let claims = claims.map(|claim| format!("the check of the claim {} contradicts the ledger", claim.id).into());
    pairs.chain(numbers).chain(claims).collect()
}

fn not_run(found: &Verification) -> Vec<Words> {
    let told = found.skipped.iter().map(|skipped| {
        let should = if skipped.failed { " It should have run." } else { "" };
        format!("{}: {}{should}", spoken(&skipped.route.to_string()), skipped.why).into()
    });
    told.collect()
}
