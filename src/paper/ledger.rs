//! The ledger: each statement of the paper, its verdict, and whether the check still gives that verdict.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::checks;
use super::context::{CheckResult, Context, LedgerError};
use crate::known::Evidence;
use crate::progress::Watch;
use crate::published::Verdict;

/// The statements and the verdicts found.
const CLAIMS: &str = include_str!("claims.toml");

/// A statement of the paper.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// Permanent name, by which checks refer to it.
    pub id: String,
    /// Place in the paper.
    #[serde(rename = "where")]
    pub place: String,
    /// The statement, in words of this project.
    pub statement: String,
    /// Verdict found.
    pub verdict: Verdict,
    /// Correction; given with every misprint, every refutation and every statement that holds in part.
    pub correct: Option<String>,
    /// For a wrong statement, the ids of the statements whose slips it contains. An empty list means its own.
    #[serde(default)]
    pub slips: Vec<String>,
    /// The function that decides the statement, `FILE: FUNCTION`, if that is neither a proof nor the comparison of a printed number.
    pub check: Option<String>,
}

/// A statement with the result of its check.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Held {
    /// Permanent name of the statement.
    pub id: String,
    /// Place in the paper.
    #[serde(rename = "where")]
    pub place: String,
    /// The statement.
    pub statement: String,
    /// Verdict of the check; `open` for another model where the statement is about the paper's.
    pub verdict: Verdict,
    /// Verdict in the ledger.
    #[serde(skip)]
    pub listed: Verdict,
    /// Evidence for the verdict.
    pub known: Evidence,
    /// The numbers that the verdict rests on.
    pub evidence: String,
    /// Correction, where the check finds the statement wrong.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub correct: Option<String>,
    /// The ids of the statements whose slips make it wrong. If its own id is among them, it makes a slip itself.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub slips: Vec<String>,
    /// Whether the check confirms the ledger's verdict, or the statement is not about this model.
    pub as_found: bool,
}

impl Held {
    /// Whether the statement makes a slip itself, instead of being wrong only by slips of other statements.
    pub fn makes_a_slip(&self) -> bool {
        self.slips.contains(&self.id)
    }
}

/// Source of the statements.
pub(crate) const SOURCE: &str = "the paper's source on arXiv (0711.1008)";

/// Every statement with the result of its check: the output of `claims`; serializes to `corner-impact/claims/1`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Claims {
    schema: &'static str,
    /// Source of all statements.
    pub source: &'static str,
    /// Name of the model.
    pub model: String,
    /// Every statement.
    pub claims: Vec<Held>,
    /// Number of statements with each verdict.
    pub counts: BTreeMap<Verdict, usize>,
    /// Whether every check confirms the ledger's verdict.
    pub agrees: bool,
}

#[derive(Deserialize)]
struct Ledger {
    claim: Vec<Claim>,
}

/// Returns every statement: equations, numbers, then statements and figures, each kind in the paper's order.
pub fn claims() -> Result<Vec<Claim>, LedgerError> {
    let ledger: Ledger = toml::from_str(CLAIMS).map_err(|error| LedgerError::Unreadable(error.to_string()))?;
    Ok(ledger.claim)
}

impl Claims {
    /// Runs the check of every statement, and reports its progress to `watch`.
    pub fn hold(context: &Context<'_>, watch: &dyn Watch) -> Result<Self, LedgerError> {
        let claims = claims()?;
        let total = claims.len() as u64;
        let mut counts = Verdict::WORST_FIRST.map(|verdict| (verdict, 0)).into_iter().collect::<BTreeMap<_, _>>();
        let one = |(done, claim): (usize, Claim)| {
            watch.at(&claim.id, done as u64, total);
            let check = checks::find(&claim.id).ok_or_else(|| LedgerError::Unchecked(claim.id.clone()))?;
            let CheckResult { verdict, known, evidence } = check.run(context);
            let elsewhere = !context.is_paper && check.is_about_the_papers_model() && verdict == Verdict::Open;
            let as_found = verdict == claim.verdict || elsewhere;
            let correct = claim.correct.filter(|_| verdict.has_correction());
            let slips = match claim.slips {
                _ if !verdict.is_wrong() => Vec::new(),
                own if own.is_empty() => vec![claim.id.clone()],
                listed => listed,
            };
            *counts.entry(verdict).or_default() += 1;
            let Claim { id, place, statement, verdict: listed, .. } = claim;
            Ok(Held { id, place, statement, verdict, listed, known, evidence, correct, slips, as_found })
        };
        let claims = claims.into_iter().enumerate().map(one).collect::<Result<Vec<_>, LedgerError>>()?;
        let agrees = claims.iter().all(|held| held.as_found);
        let (schema, model) = ("corner-impact/claims/1", context.model.name.clone());
        Ok(Self { schema, source: SOURCE, model, claims, counts, agrees })
    }

    /// Returns the statements that make a slip, each with the other statements that are wrong because of it.
    pub fn slips(&self) -> impl Iterator<Item = (&Held, Vec<&Held>)> {
        let makers = self.claims.iter().filter(|held| held.makes_a_slip());
        makers.map(|maker| {
            let others = self.claims.iter().filter(|held| held.id != maker.id && held.slips.contains(&maker.id));
            (maker, others.collect())
        })
    }

    /// Counts the statements of a verdict: those that make a slip, and those that are only consequences of one.
    pub fn slips_and_consequences(&self, verdict: Verdict) -> (usize, usize) {
        let with = self.claims.iter().filter(|held| held.verdict == verdict);
        let (makers, followers): (Vec<_>, Vec<_>) = with.partition(|held| held.makes_a_slip());
        (makers.len(), followers.len())
    }

    /// Returns the verdicts, the worst first, each with its statements.
    pub fn groups(&self) -> impl Iterator<Item = (Verdict, Vec<&Held>)> {
        Verdict::WORST_FIRST
            .into_iter()
            .map(|verdict| (verdict, self.claims.iter().filter(|held| held.verdict == verdict).collect()))
    }
}
