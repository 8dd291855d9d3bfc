//! Input and result of a check.

use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;

use serde::Deserialize;

use crate::cam::Cam;
use crate::known::Evidence;
use crate::model::Model;
use crate::published::{PrintedNumber, Verdict};
use crate::study::verify::Verification;

/// Results of computer algebra for the printed equations. `make derive` writes the file, `make derive-check` checks it.
const EQUATIONS: &str = include_str!("../../golden/derived/printed_equations.json");

/// Every statement that computer algebra proves, written and checked by the same commands.
const PROOFS: &str = include_str!("../../golden/derived/proofs.json");

/// Input of the checks.
pub struct Context<'a> {
    pub(super) model: &'a Model,
    pub(super) cam: &'a Cam,
    pub(super) findings: &'a Verification,
    /// Whether follower and cam are the paper's.
    pub(super) is_paper: bool,
    pub(super) equations: BTreeMap<String, Equation>,
    /// The statements that are proved; measured results are not among them.
    pub(super) proved: BTreeSet<String>,
}

/// A printed equation, as the derivations judged it.
#[derive(Debug, Deserialize)]
pub(super) struct Equation {
    label: String,
    statement: String,
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

#[derive(Deserialize)]
struct Proofs {
    stages: Vec<Stage>,
}

#[derive(Deserialize)]
struct Stage {
    stage: String,
    #[serde(default)]
    proved: Vec<String>,
}

fn derived(file: &str, error: &serde_json::Error) -> LedgerError {
    LedgerError::Derived(format!("golden/derived/{file}: {error}"))
}

fn equations() -> Result<Vec<Equation>, LedgerError> {
    let read: Result<Equations, _> = serde_json::from_str(EQUATIONS);
    Ok(read.map_err(|error| derived("printed_equations.json", &error))?.equations)
}

fn stages() -> Result<Vec<Stage>, LedgerError> {
    let read: Result<Proofs, _> = serde_json::from_str(PROOFS);
    Ok(read.map_err(|error| derived("proofs.json", &error))?.stages)
}

/// Returns the script and the statement of each printed equation, by its label, and of each separately proved statement.
pub fn proofs() -> Result<BTreeMap<String, [String; 2]>, LedgerError> {
    let printed = |equation: Equation| (equation.label, [script("printed equations"), equation.statement]);
    let of_stage = |stage: Stage| stage.proved.into_iter().map(move |it| (it.clone(), [script(&stage.stage), it]));
    Ok(stages()?.into_iter().flat_map(of_stage).chain(equations()?.into_iter().map(printed)).collect())
}

/// Returns the script of a stage of the derivations.
fn script(stage: &str) -> String {
    format!("derivations/{}.py", stage.replace(' ', "_"))
}

impl<'a> Context<'a> {
    /// Creates the context of a verified model.
    pub fn new(model: &'a Model, cam: &'a Cam, findings: &'a Verification) -> Result<Self, LedgerError> {
        let is_paper = model.is_the_papers().map_err(|error| LedgerError::Derived(error.to_string()))?;
        let equations = equations()?.into_iter().map(|equation| (equation.label.clone(), equation)).collect();
        let proved = stages()?.into_iter().flat_map(|stage| stage.proved).collect();
        Ok(Self { model, cam, findings, is_paper, equations, proved })
    }

    /// Returns the printed values of a quantity, with their comparison.
    pub(super) fn printed(&self, quantity: &str) -> Result<&'a PrintedNumber, String> {
        let mut numbers = self.findings.published.iter();
        let found = numbers.find(|number| number.agreement.quantity.to_string() == quantity);
        found.ok_or_else(|| format!("{quantity} was not compared with the print"))
    }

    /// Returns one entry of the printed values of a quantity.
    pub(super) fn printed_entry(&self, quantity: &str, index: usize) -> Result<f64, Box<dyn Error>> {
        let entry =
            self.printed(quantity)?.printed.get(index).ok_or_else(|| format!("{quantity}: no entry {index}"))?;
        Ok(entry.parse()?)
    }

    /// Checks that computer algebra proves each of these statements; the error names one that it does not.
    pub(super) fn proves(&self, statements: &[&str]) -> Result<(), String> {
        match statements.iter().find(|statement| !self.proved.contains(**statement)) {
            Some(missing) => Err(format!("the derivations do not prove: {missing}")),
            None => Ok(()),
        }
    }
}

/// Result of a check.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckResult {
    /// Verdict of the check.
    pub verdict: Verdict,
    /// Evidence for the verdict.
    pub known: Evidence,
    /// The numbers on which the verdict rests.
    pub evidence: String,
}

/// Verdict of a check, with its evidence, or the reason why the statement stays open.
pub(super) type Decision = Result<(Verdict, String), Box<dyn Error>>;

/// Returns the verdict `holds`, or `otherwise`, with the evidence.
pub(super) fn decide(holds: bool, otherwise: Verdict, evidence: String) -> Decision {
    Ok((if holds { Verdict::Holds } else { otherwise }, evidence))
}

/// Reason why the ledger cannot be checked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LedgerError {
    /// The file cannot be read.
    #[error("claims.toml: {0}")]
    Unreadable(String),
    /// A statement without a check.
    #[error("claims.toml: no check for \"{0}\"")]
    Unchecked(String),
    /// Data that the checks need is missing.
    #[error("claims: {0}")]
    Derived(String),
}
