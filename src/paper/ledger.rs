//! The ledger: what the paper says, what was found, and whether the check still finds it.

use serde::Deserialize;

use super::checks;
use super::context::{Context, Found, LedgerError};
use crate::progress::{Unwatched, Watch};
use crate::published::Verdict;

/// The statements and the verdicts found.
const CLAIMS: &str = include_str!("claims.toml");

/// A statement of the paper.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// Names it for good; checks go by it.
    pub id: String,
    /// Where the paper has it.
    #[serde(rename = "where")]
    pub place: String,
    /// What it says, in words of this project.
    pub statement: String,
    /// What was found.
    pub verdict: Verdict,
    /// What is right instead; with every misprint and refutation.
    pub correct: Option<String>,
}

/// A statement beside what its check found.
#[derive(Clone, Debug, PartialEq)]
pub struct Held {
    /// The statement.
    pub claim: Claim,
    /// What the check found; `open` for another model where the statement is about the paper's.
    pub found: Found,
    /// Whether that is the ledger's verdict, or the statement is not about this model.
    pub as_found: bool,
}

#[derive(Deserialize)]
struct Ledger {
    claim: Vec<Claim>,
}

/// Every statement, in the paper's order by kind: equations, numbers, statements and figures.
pub fn claims() -> Result<Vec<Claim>, LedgerError> {
    let ledger: Ledger = toml::from_str(CLAIMS).map_err(|error| LedgerError::Unreadable(error.to_string()))?;
    Ok(ledger.claim)
}

/// Holds every statement against its check.
pub fn hold(context: &Context<'_>) -> Result<Vec<Held>, LedgerError> {
    hold_watched(context, &Unwatched)
}

/// The same, told to `watch` statement by statement.
pub fn hold_watched(context: &Context<'_>, watch: &dyn Watch) -> Result<Vec<Held>, LedgerError> {
    let claims = claims()?;
    let total = claims.len() as u64;
    let one = |(done, claim): (usize, Claim)| {
        watch.at(&claim.id, done as u64, total);
        let check = checks::find(&claim.id).ok_or_else(|| LedgerError::Unchecked(claim.id.clone()))?;
        let found = check.run(context);
        let elsewhere = !context.is_paper && check.is_about_the_papers_model() && found.verdict == Verdict::Open;
        let as_found = found.verdict == claim.verdict || elsewhere;
        Ok(Held { claim, found, as_found })
    };
    claims.into_iter().enumerate().map(one).collect()
}
