//! The document as JSON.

use serde::Serialize;

use crate::model::Units;

/// One JSON document, indented, with a line end, in the units of a model.
pub fn render(document: &impl Serialize, units: &Units) -> Result<String, serde_json::Error> {
    let text = serde_json::to_string_pretty(document)? + "\n";
    Ok(if units.are_given { in_units(&text, units) } else { text })
}

/// Names and values in the units of a model. Each name stands at the beginning of a line of its own, as does each number of a list.
fn in_units(text: &str, units: &Units) -> String {
    let mut told = String::with_capacity(text.len());
    // What becomes of the numbers of a list that is open, and how far that is indented.
    let mut list = None;
    for line in text.lines() {
        let body = line.trim_start();
        let indent = line.len() - body.len();
        told.push_str(&line[..indent]);
        let is_name = |name: &str| name.bytes().all(|letter| letter.is_ascii_alphanumeric() || letter == b'_');
        let entry = body.strip_prefix('"').and_then(|rest| rest.split_once("\": ")).filter(|(name, _)| is_name(name));
        let (convert, value) = match entry {
            Some((name, value)) => {
                let convert = units.converted(name);
                // A ball is left in the unit that it is proved in.
                let name = if convert.is_some() && value == "{" { name.to_owned() } else { units.field(name) };
                list = convert.filter(|_| value == "[").map(|convert| (convert, indent)).or(list);
                told.push_str(&format!("\"{name}\": "));
                (convert, value)
            }
            None => (list.map(|(convert, _)| convert), body),
        };
        list = list.filter(|(_, opened)| indent > *opened || value == "[");
        let number = value.trim_end_matches(',');
        match (convert, number.parse()) {
            (Some(convert), Ok(parsed)) => {
                told.push_str(&format!("{}{}", convert(units, parsed), &value[number.len()..]));
            }
            _ => told.push_str(value),
        }
        told.push('\n');
    }
    told
}
