//! The paper's statements, one by one, with a verdict that a check computes.
//!
//! `claims.toml` lists what the paper says and what was found; [`checks`] has one check for each id.
//! A check that reaches another verdict than the ledger is an error, never an update: a misprint stays a
//! misprint until somebody looks.

pub mod checks;
mod context;
mod drawings;
mod dynamics;
pub mod jump_order;
pub mod ledger;
mod statements;

pub use context::{CheckResult, Context, LedgerError, proofs};
pub use ledger::{Claim, Claims, Held};
