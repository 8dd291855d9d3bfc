//! Models that another program passes as a document with the fields of a model file.

use serde_json::{Map, Value as Item};

use super::ModelError;
use super::fields::{Field, Fields, Value};

impl Fields {
    /// Fields of a document without a file; they have no line numbers.
    pub(super) fn of_document(name: &str, document: &Item) -> Result<Self, ModelError> {
        let mut fields = Self::none(name, None);
        match document {
            Item::Object(table) => fields.add_object("", table)?,
            _ => return Err(ModelError::file(name, "must be a table of fields".into())),
        }
        Ok(fields)
    }

    fn add_object(&mut self, prefix: &str, table: &Map<String, Item>) -> Result<(), ModelError> {
        for (key, value) in table {
            if key.contains(Self::PARTS) {
                return Err(ModelError::file(
                    self.file(),
                    format!("{prefix}{key}: a name must not have a dot or a bracket"),
                ));
            }
            self.add_item(&format!("{prefix}{key}"), value)?;
        }
        Ok(())
    }

    fn add_item(&mut self, path: &str, item: &Item) -> Result<(), ModelError> {
        let row = |item: &Item| match item.as_array()?.as_slice() {
            [one, two] => Some(([one.as_f64()?, two.as_f64()?], None)),
            _ => None,
        };
        let mut written = String::new();
        let value = match item {
            Item::Object(table) => {
                self.add_object(&format!("{path}."), table)?;
                Value::Table
            }
            Item::Array(items) => match items.iter().map(row).collect::<Option<Vec<_>>>() {
                Some(rows) if !rows.is_empty() => Value::Rows(rows),
                _ => {
                    for (index, item) in items.iter().enumerate() {
                        self.add_item(&format!("{path}[{index}]"), item)?;
                    }
                    Value::Array(items.len())
                }
            },
            other => {
                written = other.to_string();
                match other {
                    Item::String(text) => Value::Text(text.clone()),
                    other => other.as_f64().map_or(Value::Other, Value::Number),
                }
            }
        };
        self.fields.insert(path.into(), Field::without_line(written, value));
        Ok(())
    }
}
