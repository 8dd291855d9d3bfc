//! Parser of TOML into fields with their places in the text.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::ModelError;
use super::fields::{Field, Fields, Value};
use super::numeral::Numeral;

/// Converts a TOML number to a double; `None` for any other value.
fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Integer(integer) => {
            i64::from_str_radix(integer.as_str(), integer.radix()).ok().map(|integer| integer as f64)
        }
        DeValue::Float(float) => float.as_str().parse().ok(),
        _ => None,
    }
}

/// Returns the two numbers of a TOML array; `None` for any other value.
fn pair(value: &DeValue<'_>) -> Option<[f64; 2]> {
    let DeValue::Array(items) = value else { return None };
    let mut items = items.iter().map(|item| number(item.get_ref()));
    match (items.next(), items.next(), items.next()) {
        (Some(one), Some(two), None) => Some([one?, two?]),
        _ => None,
    }
}

/// Pairs of numbers in a TOML array, each number as the decimal written; empty if the text is anything else.
pub(super) fn pairs(array: &str) -> Vec<[String; 2]> {
    let text = format!("rows = {array}");
    let Ok(table) = DeTable::parse(&text) else { return Vec::new() };
    let Some(DeValue::Array(rows)) = table.get_ref().get("rows").map(Spanned::get_ref) else { return Vec::new() };
    let decimal = |value: &Spanned<DeValue<'_>>| {
        let number = number(value.get_ref())?;
        let text = text.get(value.span())?.to_owned();
        Some(Numeral { number, text }.decimal())
    };
    let row = |row: &Spanned<DeValue<'_>>| match row.get_ref() {
        DeValue::Array(items) => Some([decimal(items.first()?)?, decimal(items.get(1)?)?]),
        _ => None,
    };
    rows.iter().map(row).collect::<Option<_>>().unwrap_or_default()
}

impl Fields {
    /// Parses a text into fields; errors name the file as `file`.
    pub(super) fn parse(file: &str, text: &str) -> Result<Self, ModelError> {
        let line_ends: Vec<usize> = text.match_indices('\n').map(|(at, _)| at).collect();
        let line_of = |offset: usize| 1 + line_ends.partition_point(|end| *end < offset);
        let comma = |span: Range<usize>| {
            let parts = text.split_at_checked(span.start);
            parts.is_some_and(|(before, from)| {
                before.ends_with(|last: char| last.is_ascii_digit()) && from.starts_with(',')
            })
        };
        let root = DeTable::parse(text).map_err(|error| ModelError {
            line: error.span().map(|span| line_of(span.start)),
            // Some messages are two lines long.
            ..ModelError::file(file, format!("not valid TOML: {}", error.message().replace('\n', ", ")))
                .at(Some(text.into()), error.span())
                .meaning(error.span().is_some_and(comma).then(|| "did you mean a decimal point?".into()))
        })?;
        let mut fields = Self::none(file, Some(text));
        let place = |span: Range<usize>| (line_of(span.start), text.get(span).unwrap_or_default().to_owned());
        fields.add_table("", root.get_ref(), &place)?;
        Ok(fields)
    }

    fn add_table(
        &mut self,
        prefix: &str,
        table: &DeTable<'_>,
        place: &dyn Fn(Range<usize>) -> (usize, String),
    ) -> Result<(), ModelError> {
        for (key, value) in table {
            let path = format!("{prefix}{}", key.get_ref());
            if key.get_ref().contains(Self::PARTS) {
                let (line, written) = place(key.span());
                let words = "must not be in quotes: a name has no dot or bracket; write the field without quotes, or under its [table]";
                return Err(ModelError {
                    line: Some(line),
                    field: Some(written),
                    ..ModelError::file(self.file(), words.into()).at(Some(self.source().into()), Some(key.span()))
                });
            }
            // The span of a table does not include its header; the span of its key is used.
            let (line, _) = place(key.span());
            self.add(&path, (line, key.span()), value, place)?;
        }
        Ok(())
    }

    fn add(
        &mut self,
        path: &str,
        (line, key): (usize, Range<usize>),
        spanned: &Spanned<DeValue<'_>>,
        place: &dyn Fn(Range<usize>) -> (usize, String),
    ) -> Result<(), ModelError> {
        let (_, written) = place(spanned.span());
        let value = match spanned.get_ref() {
            DeValue::Table(table) => {
                self.add_table(&format!("{path}."), table, place)?;
                Value::Table
            }
            DeValue::Array(items) => {
                let row = |item: &Spanned<DeValue<'_>>| Some((pair(item.get_ref())?, Some(place(item.span()).0)));
                match items.iter().map(row).collect::<Option<Vec<_>>>() {
                    Some(rows) if !rows.is_empty() => Value::Rows(rows),
                    _ => {
                        for (index, item) in items.iter().enumerate() {
                            let (line, _) = place(item.span());
                            self.add(&format!("{path}[{index}]"), (line, item.span()), item, place)?;
                        }
                        Value::Array(items.len())
                    }
                }
            }
            DeValue::String(text) => Value::Text(text.to_string()),
            other => number(other).map_or(Value::Other, Value::Number),
        };
        let field =
            Field { line: Some(line), is_there: true, key, span: spanned.span(), written: written.into(), value };
        self.fields.insert(path.into(), field);
        Ok(())
    }
}
