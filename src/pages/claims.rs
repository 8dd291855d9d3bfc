//! The ledger as a document: JSON, a page of text, and the Markdown page under `docs/`.

use std::fmt::{self, Write};

use serde::Serialize;

use crate::paper::Held;
use crate::published::Verdict;
use crate::show::block::Mark;
use crate::show::page::{Page, WIDTH};
use crate::show::words::mark;

/// What `claims` found; serializes to the document `corner-impact/claims/1`.
#[derive(Clone, Debug, Serialize)]
pub struct ClaimsDocument {
    /// `corner-impact/claims/1`.
    pub schema: &'static str,
    /// Name of the model.
    pub model: String,
    /// Every statement.
    pub claims: Vec<ClaimEntry>,
    /// How many statements have each verdict.
    pub counts: Counts,
    /// Whether every check comes to the ledger's verdict.
    pub agrees: bool,
}

/// How many statements have each verdict.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Right.
    pub holds: usize,
    /// Slips.
    pub misprint: usize,
    /// Wrong.
    pub refuted: usize,
    /// Not decided.
    pub open: usize,
}

/// A statement with its verdict and evidence.
#[derive(Clone, Debug, Serialize)]
pub struct ClaimEntry {
    /// Names it.
    pub id: String,
    /// Where the paper has it.
    #[serde(rename = "where")]
    pub place: String,
    /// What it says.
    pub statement: String,
    /// What the check found.
    pub verdict: Verdict,
    /// The numbers that it rests on.
    pub evidence: String,
    /// What is right instead.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub correct: Option<String>,
    /// Whether the ledger says the same.
    pub as_found: bool,
}

impl ClaimsDocument {
    /// Lays out what was found.
    pub fn new(model: &str, held: &[Held]) -> Self {
        let mut counts = Counts::default();
        let entry = |held: &Held| {
            let verdict = held.found.verdict;
            let count = match verdict {
                Verdict::Holds => &mut counts.holds,
                Verdict::Misprint => &mut counts.misprint,
                Verdict::Refuted => &mut counts.refuted,
                Verdict::Open => &mut counts.open,
            };
            *count += 1;
            let claim = held.claim.clone();
            let wrong = [Verdict::Misprint, Verdict::Refuted].contains(&verdict);
            ClaimEntry {
                id: claim.id,
                place: claim.place,
                statement: claim.statement,
                verdict,
                evidence: held.found.evidence.clone(),
                correct: claim.correct.filter(|_| wrong),
                as_found: held.as_found,
            }
        };
        let claims = held.iter().map(entry).collect();
        let agrees = held.iter().all(|held| held.as_found);
        Self { schema: "corner-impact/claims/1", model: model.into(), claims, counts, agrees }
    }

    /// The verdicts with how many have each, the ones to read first in front.
    pub(crate) fn groups(&self) -> [(Verdict, usize); 4] {
        let Counts { holds, misprint, refuted, open } = self.counts;
        [(Verdict::Refuted, refuted), (Verdict::Misprint, misprint), (Verdict::Open, open), (Verdict::Holds, holds)]
    }

    /// The page, as wide as where nothing says how wide, without marks.
    pub fn text(&self) -> Result<String, fmt::Error> {
        Ok(self.page(WIDTH)?.plain().to_owned())
    }

    /// The page for a terminal of `width` columns.
    pub fn page(&self, width: usize) -> Result<Page, fmt::Error> {
        let mut page = Page::new(width);
        page.marked(Mark::Heading, &format!("What the paper states, held against {}", self.model));
        writeln!(page)?;
        for (verdict, count) in self.groups() {
            writeln!(page)?;
            page.marked(mark(verdict), &verdict.to_string().to_uppercase());
            writeln!(page, " ({count})")?;
            for claim in self.claims.iter().filter(|claim| claim.verdict == verdict) {
                write!(page, "\n  {} [{}]", claim.id, claim.place)?;
                if !claim.as_found {
                    write!(page, "   ")?;
                    page.marked(Mark::Bad, "OTHERWISE THAN THE LEDGER SAYS");
                }
                writeln!(page)?;
                page.paragraph_at(4, &claim.statement)?;
                if let Some(correct) = &claim.correct {
                    page.paragraph_at(4, &format!("Right: {correct}"))?;
                }
                page.paragraph_at(4, &format!("Evidence: {}", claim.evidence))?;
            }
        }
        let (mark, agreement) = if self.agrees {
            (Mark::Good, "Every check comes to the ledger's verdict.")
        } else {
            (Mark::Bad, "A CHECK DISAGREES WITH THE LEDGER.")
        };
        writeln!(page)?;
        page.marked(mark, agreement);
        writeln!(page)?;
        Ok(page)
    }

    /// The page under `docs/`.
    pub fn markdown(&self) -> Result<String, fmt::Error> {
        let mut page = String::new();
        writeln!(page, "# What the paper states, and what was found\n")?;
        writeln!(
            page,
            "Written by `make claims`; a test keeps it fresh. Statements are in words of this project. *Misprint*: a slip \
             that nothing was built on; *refuted*: what is said is wrong; *open*: not decided here yet.\n"
        )?;
        let counts: Vec<_> = self.groups().iter().map(|(verdict, count)| format!("{count} {verdict}")).collect();
        writeln!(page, "{} statements: {}.", self.claims.len(), counts.join(", "))?;
        for (verdict, count) in self.groups() {
            writeln!(page, "\n## {} ({count})\n", capitalized(&verdict.to_string()))?;
            writeln!(page, "| id | where | statement | right instead | evidence |\n|---|---|---|---|---|")?;
            for claim in self.claims.iter().filter(|claim| claim.verdict == verdict) {
                let cells = [
                    &claim.id,
                    &claim.place,
                    &claim.statement,
                    claim.correct.as_ref().unwrap_or(&String::new()),
                    &claim.evidence,
                ]
                .map(|cell| escaped(cell));
                writeln!(page, "| {} |", cells.join(" | "))?;
            }
        }
        Ok(page)
    }
}

fn capitalized(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

/// A cell of a Markdown table: bars, stars and angle brackets stand for themselves.
fn escaped(cell: &str) -> String {
    let mut text = String::new();
    for letter in cell.chars() {
        if ['|', '*', '<', '>', '_', '[', ']', '~', '^'].contains(&letter) {
            text.push('\\');
        }
        text.push(letter);
    }
    text
}
