//! JSON output.

use serde::Serialize;

use corner_impact::model::Units;

/// Writes one JSON document, indented, with a line end, in the units of a model.
pub fn render(document: &impl Serialize, units: &Units) -> Result<String, serde_json::Error> {
    let text = serde_json::to_string_pretty(document)? + "\n";
    Ok(if units.are_given { in_units(&text, units) } else { text })
}

/// Converts names and values to the units of a model. Each name begins a line of its own, as does each number of a list.
fn in_units(text: &str, units: &Units) -> String {
    let mut told = String::with_capacity(text.len());
    // Conversion of the numbers of the current list, and the indent of that list.
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
                // A ball stays in the unit in which it is proved.
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
