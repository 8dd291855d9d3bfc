//! The numbers of a model file, each with its symbol, meaning and unit.

use serde::Serialize;

use corner_impact::flight::Flight;
use corner_impact::model::{CORNER_ROUNDING, Model, Units};

/// A number of a model.
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

/// Evidence fields: path, symbol, meaning, unit.
const KNOWN: [(&str, &str, &str, &str); 16] = [
    ("follower.mass", "m", "mass of the follower", "kg"),
    ("follower.damping", "b", "damping", "N s/m"),
    ("follower.stiffness", "k", "stiffness of the spring", "N/m"),
    ("follower.gravity", "g", "gravity", "m/s²"),
    ("follower.rest_position", "", "position where the spring is slack", "m"),
    ("follower.preload", "", "force of the spring at the lowest lift", "N"),
    ("follower.restitution", "r", "coefficient of restitution", ""),
    ("cam.base_radius", "ρ₀", "radius of the base circle", "m"),
    ("cam.flank_radius", "ρ₁", "radius of the flank", "m"),
    ("cam.nose_radius", "ρ₂", "radius of the nose", "m"),
    ("cam.flank_start_deg", "", "cam angle where the flank starts", "deg"),
    ("cam.nose_end_deg", "", "cam angle where the nose ends", "deg"),
    ("cam.offset", "", "middle of the lift", "m"),
    ("cam.amplitude", "", "amplitude of the lift", "m"),
    ("cam.base", "", "lift at angle 0", "m"),
    ("cam.corner_rounding_deg", "", "angle that corners are rounded over", "deg"),
];

/// All numbers of the model in the order of its file, then derived ones.
pub(crate) fn quantities(model: &Model) -> Vec<ReportQuantity> {
    let place = |field: &str| KNOWN.iter().position(|(path, ..)| *path == field);
    let is_said = |(field, value): &(&str, f64)| *field != CORNER_ROUNDING || *value != 0.0;
    let mut numbers: Vec<(&str, f64)> = model.numbers().filter(is_said).collect();
    // Evidence fields in the order of the table, then the others in the order of the file.
    numbers.sort_by_key(|(field, _)| place(field).unwrap_or(KNOWN.len()));
    let mut quantities: Vec<ReportQuantity> =
        numbers.into_iter().map(|(field, value)| written(&model.units, field, value)).collect();
    if let Some(study) = model.study {
        for (field, meaning, value) in [
            ("study.rpm_min", "lowest speed at which a corner impact is looked for", study.rpm_min),
            ("study.rpm_max", "highest speed at which a corner impact is looked for", study.rpm_max),
        ] {
            quantities.push(ReportQuantity {
                field: field.into(),
                symbol: "",
                meaning: meaning.into(),
                value,
                unit: "rpm".into(),
            });
        }
    }
    let flight = Flight::new(&model.follower);
    let follows = |symbol, meaning: &str, value, unit: &str| ReportQuantity {
        field: String::new(),
        symbol,
        meaning: meaning.into(),
        value,
        unit: unit.into(),
    };
    quantities.push(follows("ζ", "damping over twice the mass", flight.zeta(), "1/s"));
    quantities.push(follows("ω₀", "root of stiffness over mass", flight.omega0_squared().sqrt(), "rad/s"));
    quantities
}

fn written(units: &Units, field: &str, value: f64) -> ReportQuantity {
    let of_follower =
        field.strip_prefix("follower.").and_then(|name| units.of_follower(name)).filter(|_| units.are_given);
    let told = |unit: &str| of_follower.map_or_else(|| units.spelled(unit), |unit| unit.name().to_owned());
    if let Some((_, symbol, meaning, unit)) = KNOWN.iter().find(|(path, ..)| *path == field) {
        return ReportQuantity { field: field.into(), symbol, meaning: (*meaning).into(), value, unit: told(unit) };
    }
    let name = field.rsplit('.').next().unwrap_or(field);
    let unit = match name.split('[').next().unwrap_or(name) {
        "amplitudes" | "rise" => "m",
        "phases_deg" | "span_deg" | "start_deg" => "deg",
        // The power of a coefficient is its index in the list.
        "coefficients" => "m/rad^place",
        _ => "",
    };
    let words = name.split('[').next().unwrap_or(name).trim_end_matches("_deg").replace('_', " ");
    ReportQuantity { field: field.into(), symbol: "", meaning: words, value, unit: told(unit) }
}
