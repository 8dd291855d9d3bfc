//! Numbers of a model file, each with its symbol, meaning and unit.

use serde::Serialize;

use corner_impact::flight::Flight;
use corner_impact::model::{CORNER_ROUNDING, LEVER_RATIO, MODEL_NUMBERS, Model, ModelNumber};

/// Number of a model.
#[derive(Clone, Debug, Serialize)]
pub struct ReportQuantity {
    /// Path in the model file; empty for a derived number.
    pub field: String,
    /// Symbol in the paper, if any.
    pub symbol: &'static str,
    /// Meaning of the number.
    pub meaning: String,
    /// Value of the number.
    pub value: f64,
    /// Standard deviation of the value; `None` for an exact number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
    /// Unit; empty for a pure number.
    pub unit: String,
}

impl ReportQuantity {
    /// Name of the number in `explain`.
    pub(crate) fn name(&self) -> &str {
        match (self.field.as_str(), self.symbol) {
            ("", "ζ") => "zeta",
            ("", _) => "omega0",
            (field, _) => field,
        }
    }
}

/// All numbers of the model in the order of its file, then derived ones.
pub(crate) fn quantities(model: &Model) -> Vec<ReportQuantity> {
    let is_said = |number: &(&str, f64)| ![(CORNER_ROUNDING, 0.0), (LEVER_RATIO, 1.0)].contains(number);
    let mut numbers: Vec<(&str, f64)> = model.numbers().filter(is_said).collect();
    // Numbers in the order of the table, then numbers of lists in the order of the file.
    let place = |field: &str| MODEL_NUMBERS.iter().position(|number| number.path == field);
    numbers.sort_by_key(|(field, _)| place(field).unwrap_or(MODEL_NUMBERS.len()));
    numbers.extend(
        model.study.iter().flat_map(|study| [("study.rpm_min", study.rpm_min), ("study.rpm_max", study.rpm_max)]),
    );
    let mut quantities: Vec<ReportQuantity> =
        numbers.into_iter().map(|(field, value)| written(model, field, value)).collect();
    let flight = Flight::new(&model.follower);
    let follows = |symbol, meaning: &str, value, unit: &str| ReportQuantity {
        field: String::new(),
        symbol,
        meaning: meaning.into(),
        value,
        error: None,
        unit: unit.into(),
    };
    quantities.push(follows("ζ", "damping over twice the mass", flight.zeta(), "1/s"));
    quantities.push(follows("ω₀", "root of stiffness over mass", flight.omega0_squared().sqrt(), "rad/s"));
    quantities
}

fn written(model: &Model, field: &str, value: f64) -> ReportQuantity {
    let (symbol, meaning) = ModelNumber::of(field).map_or(("", ""), |number| (number.symbol, number.meaning));
    let (error, unit) = (model.error_of(field), model.units.of_number(field));
    ReportQuantity { field: field.into(), symbol, meaning: meaning.into(), value, error, unit }
}
