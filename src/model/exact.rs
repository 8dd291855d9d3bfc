//! Exact numbers of a model for proofs: the rationals as written, as text.
//!
//! Each number is a decimal, or a decimal times a quotient of whole numbers that converts it to internal units, such as `"1.25 * 1/1000"`.

use serde_json::{Map, Value as Item, json};

use super::fields::{Fields, Value};
use super::numeral::Numeral;
use super::{Model, Unit};

impl Model {
    /// Tables of the follower and the cam, as in a model file in SI units or in the file's unit of length, with every number as text.
    ///
    /// If the file gives a preload, it replaces the rest position. A number without a field in the file, such as a lift of another table,
    /// is the shortest decimal that reads back as its double.
    pub fn exact(&self) -> Item {
        let told = |name: &str, number: f64| {
            let text = self.fields.exact(&format!("follower.{name}"), self.units.of_follower(name), number);
            (name.to_owned(), Item::from(text))
        };
        let Item::Object(numbers) = json!(self.follower) else { return Item::Null };
        let follower: Map<String, Item> = numbers
            .iter()
            .map(|(name, number)| match (name.as_str(), self.preload) {
                ("rest_position", Some(preload)) => told("preload", preload),
                (name, _) => told(name, number.as_f64().unwrap_or(f64::NAN)),
            })
            .collect();
        let mut cam = json!(self.cam);
        self.fields.make_exact("cam", &mut cam);
        if let Some(table) = self.table().filter(|table| !table.reading.written.is_empty()) {
            let lift = |text: &str| times(text.to_owned(), Some(&table.reading.in_model));
            let rows =
                table.reading.written.iter().map(|[angle, row]| json!({ "angle_deg": angle, "lift": lift(row) }));
            cam["rows"] = rows.collect();
        }
        json!({ "follower": follower, "cam": cam })
    }
}

/// Expression in internal units of a decimal in a unit.
fn times(decimal: String, unit: Option<&Unit>) -> String {
    match unit.and_then(Unit::factor) {
        Some([above, below]) => format!("{decimal} * {above}/{below}"),
        None => decimal,
    }
}

impl Fields {
    /// Text of the number that became `inside`; the digits of that double if no field has it.
    fn exact(&self, path: &str, unit: Option<&Unit>, inside: f64) -> String {
        let became = |number: f64| unit.map_or(number, |unit| unit.inside(number));
        match self.fields.get(path) {
            Some(field) => match field.value {
                Value::Number(number) if became(number) == inside => {
                    times(Numeral { number, text: field.written.to_string() }.decimal(), unit)
                }
                _ => format!("{inside:?}"),
            },
            None => format!("{inside:?}"),
        }
    }

    /// Replaces each number by its text.
    fn make_exact(&self, path: &str, item: &mut Item) {
        match item {
            Item::Object(table) => {
                table.iter_mut().for_each(|(name, item)| self.make_exact(&format!("{path}.{name}"), item))
            }
            Item::Array(items) => {
                let items = items.iter_mut().enumerate();
                items.for_each(|(index, item)| self.make_exact(&format!("{path}[{index}]"), item));
            }
            Item::Number(number) => *item = self.exact(path, None, number.as_f64().unwrap_or(f64::NAN)).into(),
            _ => {}
        }
    }
}
