//! Conversion of a model to the text of a self-contained model file.

use std::sync::Arc;

use std::fmt::Write;

use super::fields::{Fields, Value};
use super::{FollowerErrors, Model, SmoothingTolerance, TableProfile};

impl Model {
    /// Text of the model file with exact numbers, which is equal for models whose machines move alike.
    pub(crate) fn text_of_values(&self) -> String {
        let mut exact = self.clone();
        for name in FollowerErrors::names() {
            exact.fields.drop_error(&format!("follower.{name}"));
        }
        exact.text()
    }

    /// Text of a self-contained model file: the model's name, every number in digits that read back as the same double, and a table's rows
    /// instead of their file. Reading the text gives the same model and the same text.
    pub fn text(&self) -> String {
        let mut fields = self.fields.clone();
        fields.put("name", Value::Text(self.name.clone()));
        fields.put("source", Value::Text(self.source.clone()));
        if let Some(table) = self.table() {
            fields.put_lifts(table, table.rows.iter().map(|row| row.lift));
        }
        let mut text = String::new();
        fields.write(&mut text, "");
        text
    }
}

impl Fields {
    /// Replaces a table's rows and file by rows at the same angles with other lifts, in the units of the model.
    pub(super) fn put_lifts(&mut self, table: &TableProfile, lifts: impl Iterator<Item = f64>) {
        // Fields that control how rows are read, which is done.
        const OF_READING: [&str; 12] = [
            "file",
            "unit",
            "angle_unit",
            "angle_column",
            "lift_column",
            "radius_column",
            "x_column",
            "y_column",
            "coordinates",
            "turn_deg",
            "mirrored",
            "outside",
        ];
        for name in OF_READING {
            self.fields.remove(&*format!("cam.{name}"));
        }
        if let Some(SmoothingTolerance::Within(within)) = table.spline.smoothing().map(|smoothing| smoothing.tolerance)
        {
            self.put("cam.tolerance", Value::Number(within));
        }
        let rows = table.rows.iter().zip(lifts).map(|(row, lift)| ([row.angle_deg, lift], None));
        self.put("cam.rows", Value::Rows(rows.collect()));
    }

    /// Writes the contents of the table at `path`. Values come first, because lines after a nested table's header belong to that table.
    fn write(&self, text: &mut String, path: &str) {
        let prefix = if path.is_empty() { String::new() } else { format!("{path}.") };
        let below =
            self.fields.range::<Arc<str>, _>(Arc::from(&*prefix)..).take_while(|(path, _)| path.starts_with(&prefix));
        let inside: Vec<(&str, &str, &Value)> = below
            .map(|(path, field)| (&path[prefix.len()..], &**path, &field.value))
            .filter(|(name, ..)| !name.contains(['.', '[']))
            .collect();
        for (name, path, value) in &inside {
            if let Some(value) = self.written(path, value) {
                // Writing to a string does not fail.
                let _ = writeln!(text, "{name} = {value}");
            }
        }
        for (_, path, value) in &inside {
            match value {
                Value::Table => {
                    let _ = writeln!(text, "\n[{path}]");
                    self.write(text, path);
                }
                Value::Array(count) if self.holds_tables(path) => {
                    for index in 0..*count {
                        let _ = writeln!(text, "\n[[{path}]]");
                        self.write(text, &format!("{path}[{index}]"));
                    }
                }
                _ => {}
            }
        }
    }

    /// Whether the array at `path` is an array of tables.
    fn holds_tables(&self, path: &str) -> bool {
        self.fields.get(&*format!("{path}[0]")).is_some_and(|first| matches!(first.value, Value::Table))
    }

    /// Value in one line; `None` for a table or an array of tables, which have separate headers.
    fn written(&self, path: &str, value: &Value) -> Option<String> {
        match value {
            Value::Number(number) => Some(match self.error_at(path) {
                Some(error) => format!("{{ value = {number:?}, error = {error:?} }}"),
                None => format!("{number:?}"),
            }),
            // TOML escapes as JSON does, except for one character.
            Value::Text(text) => Some(serde_json::Value::String(text.clone()).to_string().replace('\u{7f}', "\\u007f")),
            Value::Rows(rows) => {
                let rows: String = rows.iter().map(|([one, two], _)| format!("    [{one:?}, {two:?}],\n")).collect();
                Some(format!("[\n{rows}]"))
            }
            Value::Array(_) if self.holds_tables(path) => None,
            Value::Array(count) => {
                let item = |index: usize| {
                    let path = format!("{path}[{index}]");
                    self.written(&path, &self.fields.get(&*path)?.value)
                };
                Some(format!("[{}]", (0..*count).map(item).collect::<Option<Vec<_>>>()?.join(", ")))
            }
            Value::Table | Value::Other => None,
        }
    }
}
