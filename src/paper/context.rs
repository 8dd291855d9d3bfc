//! What a check may look at, and what it gives back.

use std::collections::BTreeMap;
use std::error::Error;

use serde::Deserialize;

use crate::cam::Cam;
use crate::known::Known;
use crate::model::Model;
use crate::published::Verdict;
use crate::study::verify::Verification;

/// What computer algebra found about the printed equations; `make derive` writes it, `make derive-check` redoes it.
const EQUATIONS: &str = include_str!("../../golden/derived/printed_equations.json");

/// What checks may look at.
pub struct Context<'a> {
    pub(super) model: &'a Model,
    pub(super) cam: &'a Cam,
    pub(super) findings: &'a Verification,
    /// Whether follower and cam are the paper's.
    pub(super) is_paper: bool,
    pub(super) equations: BTreeMap<String, Equation>,
}

/// A printed equation, as the derivations judged it.
#[derive(Debug, Deserialize)]
pub(super) struct Equation {
    label: String,
    pub verdict: Verdict,
    pub evidence: Residuals,
}

#[derive(Debug, Deserialize)]
pub(super) struct Residuals {
    pub residual_as_printed: serde_json::Value,
    pub residual_repaired: serde_json::Value,
    pub subsets: Vec<serde_json::Value>,
}

#[derive(Deserialize)]
struct Equations {
    equations: Vec<Equation>,
}

impl<'a> Context<'a> {
    /// The context of a verified model.
    pub fn new(model: &'a Model, cam: &'a Cam, findings: &'a Verification) -> Result<Self, LedgerError> {
        let derived = |error: String| LedgerError::Derived(format!("golden/derived/printed_equations.json: {error}"));
        let read: Equations = serde_json::from_str(EQUATIONS).map_err(|error| derived(error.to_string()))?;
        let is_paper = model.is_the_papers().map_err(|error| LedgerError::Derived(error.to_string()))?;
        let equations = read.equations.into_iter().map(|equation| (equation.label.clone(), equation)).collect();
        Ok(Self { model, cam, findings, is_paper, equations })
    }
}

/// What a check found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Its verdict.
    pub verdict: Verdict,
    /// How that is known.
    pub known: Known,
    /// The numbers that it rests on.
    pub evidence: String,
}

/// The verdict that a check comes to, with its evidence; an error says why the statement stays open.
pub(super) type Decision = Result<(Verdict, String), Box<dyn Error>>;

/// `holds` or `otherwise`, with the numbers.
pub(super) fn decide(holds: bool, otherwise: Verdict, evidence: String) -> Decision {
    Ok((if holds { Verdict::Holds } else { otherwise }, evidence))
}

/// Why the ledger cannot be held against anything.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LedgerError {
    /// The file does not read.
    #[error("claims.toml: {0}")]
    Unreadable(String),
    /// A statement without a check.
    #[error("claims.toml: no check for \"{0}\"")]
    Unchecked(String),
    /// What the checks need is not there.
    #[error("claims: {0}")]
    Derived(String),
}
