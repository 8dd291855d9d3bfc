//! The paper's statements, one by one, with a verdict that a check computes.
//!
//! `claims.toml` lists the statements with the verdicts found; [`checks`] has one check for each id.
//! A check that reaches another verdict than the ledger is an error. It never changes the ledger: somebody must look first.

pub mod checks;
mod context;
mod drawings;
mod dynamics;
pub mod jump_order;
pub mod ledger;
mod statements;

pub use context::{CheckResult, Context, LedgerError, proofs};
pub use ledger::{Claim, Claims, Held};
