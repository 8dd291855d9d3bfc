//! Page of each command, laid out from its results.

use crate::show::block::{Block, Words};
use crate::show::words;

mod basins;
pub(crate) mod branches;
pub mod cam;
mod certify;
mod chaos;
mod chart;
pub mod claims;
mod compare;
pub(crate) mod design;
pub(crate) mod explain;
mod local_map;
mod locate;
mod orbit;
pub mod report;
mod simulate;
mod speeds;
mod verify;

/// Source of a model's numbers, if the model states one.
fn source(said: &str) -> Option<Block> {
    (!said.is_empty()).then(|| Block::paragraph(said))
}

/// Lines for the items, up to a limit.
fn some_of<T>(all: &[T], what: &str, line: impl Fn(&T) -> Words) -> Vec<Block> {
    /// Largest number of items that are printed line by line.
    const LONGEST: usize = 12;
    let mut lines: Vec<_> = all.iter().take(LONGEST).map(|one| Block::Paragraph(4, line(one))).collect();
    if all.len() > LONGEST {
        let rest = words::many((all.len() - LONGEST) as u64, &format!("more {what}"));
        lines.push(Block::Paragraph(4, format!("and {rest}; --json lists them").into()));
    }
    lines
}
