//! Page of `explain`, also used for the numbers of the report.

use serde_json::Value;

use crate::explain::Explanation;
use crate::show::Paged;
use crate::show::block::{Block, Column, Span, Table, TextMark, Words, words};
use crate::show::digits::Digits;
use crate::show::words;

/// Digits of an entry when routes are compared.
const TWELVE: Digits = Digits::Aligned(12);

impl Paged for Explanation {
    fn blocks(&self) -> Vec<Block> {
        [vec![Block::Title(self.what.as_str().into())], explained(self)].concat()
    }
}

/// Body of an explanation, without its title.
pub(crate) fn explained(it: &Explanation) -> Vec<Block> {
    let code = |text: &str| Words::from(Span::Code(text.into()));
    let mut entries: Vec<(Words, Words)> = Vec::new();
    let mut say = |name: &str, words: Words| entries.push((name.into(), words));
    if let Some(formula) = &it.formula {
        let label = it.label.as_ref().map_or_else(String::new, |label| format!("   ({label})"));
        say("formula", words![code(formula), label]);
    } else if let Some(label) = &it.label {
        say("label", label.into());
    }
    let inputs = it.inputs.iter().map(|input| match &input.value {
        Some(found) => words![&input.name, " = ", value(found, Digits::Short)],
        None => (&input.name).into(),
    });
    if !it.inputs.is_empty() {
        say("from", Words::joined(inputs, ", "));
    }
    if !it.also.is_empty() {
        say("also", words!["the label also belongs to: ", it.also.join("; ")]);
    }
    let parts = it.value.as_ref().and_then(parts);
    if let (Some(found), true, None) = (&it.value, it.routes.is_empty(), &parts) {
        say("value", value(found, Digits::Short));
    }
    if let Some(evidence) = &it.evidence {
        say("evidence", evidence.into());
    }
    if !it.skipped.is_empty() {
        let routes = Words::joined(it.skipped.iter().map(|skipped| Words::from(words::spoken(&skipped.route))), ", ");
        say("not run", words![routes, " (`verify` says why)"]);
    }
    say("known", words![(TextMark::Strong, it.known.to_string().as_str())]);
    if !it.hypotheses.is_empty() {
        say("assumes", it.hypotheses.join("; ").into());
    }
    for (name, words) in ["code", "proof", "tests"].into_iter().zip(behind(it)) {
        if !words.is_empty() {
            say(name, words);
        }
    }
    if let Some(paper) = &it.paper {
        say("paper", paper.into());
    }
    let mut blocks = vec![Block::paragraph(&it.sentence), Block::Gap, Block::Entries(10, entries)];
    if let (Some(parts), true) = (parts, it.routes.is_empty()) {
        let mut table = Table::new("Its values", [Column::words("of"), Column::words("value")]);
        parts.into_iter().for_each(|(of, found)| table.row([of, found]));
        blocks.extend([Block::Gap, Block::Table(table)]);
    }
    if !it.routes.is_empty() {
        let mut table = Table::new("By each route", [Column::words("route"), Column::words("value")]);
        for (route, found) in &it.routes {
            table.row([words::spoken(route).into(), value(found, TWELVE)]);
        }
        blocks.extend([Block::Gap, Block::Table(table)]);
    }
    blocks
}

/// Function, proof and tests of a quantity; each is empty if there is none.
pub(crate) fn behind(it: &Explanation) -> [Words; 3] {
    let code = |text: &str| Words::from(Span::Code(text.into()));
    let place = |file: &str, name: &str| code(&format!("{file}: {name}"));
    let function = it.code.as_ref().map(|function| place(&function.file, &function.function));
    let proof = it.derivation.as_ref().map(|proof| words![code(&proof.script), ": ", &proof.statement]);
    let tests = Words::joined(it.tests.iter().map(|test| place(&test.file, &test.test)), ", ");
    [function.unwrap_or_default(), proof.unwrap_or_default(), tests]
}

/// Named parts of a value: fields, or the rows of a list. `None` if the value fits in one line.
fn parts(found: &Value) -> Option<Vec<(Words, Words)>> {
    const NAMES: [&str; 4] = ["name", "quantity", "speeds", "compared"];
    let of = |name: &str, found: &Value| (Words::from(words::spoken(name)), value(found, Digits::Short));
    match found {
        Value::Object(fields) if fields.len() > 2 => Some(fields.iter().map(|(name, found)| of(name, found)).collect()),
        Value::Array(rows) if rows.iter().any(Value::is_object) => {
            let row = |(index, row): (usize, &Value)| {
                let mut row = row.clone();
                let name = row.as_object_mut().and_then(|row| NAMES.iter().find_map(|name| row.remove(*name)));
                of(name.as_ref().and_then(Value::as_str).unwrap_or(&(index + 1).to_string()), &row)
            };
            Some(rows.iter().enumerate().map(row).collect())
        }
        _ => None,
    }
}

/// Words for a value of a document.
fn value(found: &Value, digits: Digits) -> Words {
    let each = |found: &Value| value(found, digits);
    match found {
        Value::Number(number) => words![(number.as_f64().unwrap_or(f64::NAN), digits)],
        Value::String(text) => text.into(),
        Value::Null => "none".into(),
        Value::Bool(is_so) => if *is_so { "yes" } else { "no" }.into(),
        Value::Array(rows) if rows.iter().all(Value::is_array) && !rows.is_empty() => {
            words!["[", Words::joined(rows.iter().map(each), ", "), "]"]
        }
        Value::Array(entries) => words!["(", Words::joined(entries.iter().map(each), ", "), ")"],
        Value::Object(parts) if parts.len() == 2 && parts.contains_key("im") => {
            let part = |name: &str| parts.get(name).and_then(Value::as_f64).unwrap_or(f64::NAN);
            Span::Complex([part("re"), part("im")], Digits::Significant(12)).into()
        }
        Value::Object(fields) => {
            Words::joined(fields.iter().map(|(name, of)| words![words::spoken(name), " ", each(of)]), ", ")
        }
    }
}
