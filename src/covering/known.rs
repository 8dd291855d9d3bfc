//! Stored h-sets, by model, which spare a program the search. They are not a proof.

use serde::Deserialize;

use super::HSet;

/// Contents of a file of `golden/chaos`.
#[derive(Debug, Deserialize)]
struct Golden {
    model: String,
    h_sets: Vec<HSet>,
}

const FILES: [&str; 1] = [include_str!("../../golden/chaos/osorio-2008.json")];

/// Returns the stored h-sets of the model of this name.
pub fn known(model: &str) -> Vec<HSet> {
    let files = FILES.iter().filter_map(|text| serde_json::from_str::<Golden>(text).ok());
    files.filter(|file| file.model == model).flat_map(|file| file.h_sets).collect()
}
