//! The document as JSON.

use serde::Serialize;

/// One JSON document, indented, with a line end.
pub(crate) fn render(document: &impl Serialize) -> Result<String, serde_json::Error> {
    Ok(serde_json::to_string_pretty(document)? + "\n")
}
