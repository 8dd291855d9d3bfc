//! Arrays of a store: the quantities of each point, with their types, units and names.

use serde_json::{Value, json};

use crate::model::Units;
use crate::orbit::long_run::Kind;
use crate::study::chart::class;
use crate::study::survey::Point;

/// An array of the store.
#[derive(Clone, Copy, Debug)]
pub struct Variable {
    /// Name of the array.
    pub name: &'static str,
    /// Number of bytes of an integer; none for a double.
    pub whole: Option<usize>,
    /// Unit of the values.
    pub units: &'static str,
    /// Description of the values.
    pub long_name: &'static str,
    value: fn(&Point) -> f64,
}

/// Variables of each point; NaN, or -1 for an integer, where a point failed. The class comes last: a block without it is not done.
pub const VARIABLES: [Variable; 8] = [
    Variable {
        name: "revolutions",
        whole: Some(4),
        units: "1",
        long_name: "revolutions of one period, 0 where there is none",
        value: |it| it.revolutions as f64,
    },
    Variable {
        name: "impacts",
        whole: Some(4),
        units: "1",
        long_name: "impacts of one period, 0 where there is none",
        value: |it| it.impacts as f64,
    },
    Variable {
        name: "impacts_per_revolution",
        whole: None,
        units: "1",
        long_name: "impacts a revolution",
        value: |it| it.impact_rate,
    },
    Variable {
        name: "growth_rate",
        whole: None,
        units: "1",
        long_name: "growth of a small deviation a revolution, a natural logarithm",
        value: |it| it.growth.value,
    },
    Variable {
        name: "growth_error",
        whole: None,
        units: "1",
        long_name: "its standard error",
        value: |it| it.growth.error,
    },
    Variable {
        name: "impact_speed",
        whole: None,
        units: "m s-1",
        long_name: "speed of the fastest impact, of follower and cam against each other",
        value: |it| it.impact_speed,
    },
    Variable {
        name: "followed",
        whole: Some(4),
        units: "1",
        long_name: "revolutions that the run was followed for",
        value: |it| it.followed as f64,
    },
    Variable {
        name: "class",
        whole: Some(1),
        units: "1",
        long_name: "kind of motion",
        value: |it| code(Some(it.kind)),
    },
];

/// Classes in the order of their codes; none for points that failed.
pub const CLASSES: [Option<Kind>; 6] =
    [Some(Kind::Stays), Some(Kind::Periodic), Some(Kind::Resting), Some(Kind::Chaotic), Some(Kind::Undecided), None];

fn code(kind: Option<Kind>) -> f64 {
    CLASSES.iter().position(|class| *class == kind).unwrap_or(CLASSES.len()) as f64
}

impl Variable {
    pub(super) fn data_type(&self) -> &'static str {
        match self.whole {
            Some(1) => "int8",
            Some(_) => "int32",
            None => "float64",
        }
    }

    /// Returns the variable's value at a point, as a double even for an integer.
    pub fn of(&self, point: &Result<Point, String>) -> f64 {
        match point {
            Ok(point) => (self.value)(point),
            Err(_) if self.name == "class" => code(None),
            Err(_) => self.fill().1,
        }
    }

    /// Fill value, as JSON and as a double, where nothing was computed or a point failed.
    pub(super) fn fill(&self) -> (Value, f64) {
        if self.whole.is_some() { (json!(-1), -1.0) } else { (json!("NaN"), f64::NAN) }
    }

    pub(super) fn bytes(&self, values: impl Iterator<Item = f64>) -> Vec<u8> {
        match self.whole {
            Some(1) => values.flat_map(|value| (value as i8).to_le_bytes()).collect(),
            Some(_) => values.flat_map(|value| (value as i32).to_le_bytes()).collect(),
            None => values.flat_map(f64::to_le_bytes).collect(),
        }
    }

    /// Number of bytes of a value.
    pub(super) fn size(&self) -> usize {
        self.whole.unwrap_or(8)
    }

    /// Returns the name, type and attributes of the variable, including the attributes of the CF conventions.
    pub fn document(&self, units: &Units) -> Value {
        json!({ "name": self.name, "dtype": self.data_type(), "attributes": self.attributes(units) })
    }

    pub(super) fn attributes(&self, units: &Units) -> Value {
        let mut attributes = json!({ "units": units.spelled(self.units), "long_name": self.long_name });
        if self.name == "class" {
            attributes["flag_values"] = json!((0..CLASSES.len()).collect::<Vec<_>>());
            attributes["flag_meanings"] = json!(CLASSES.map(class).join(" "));
        }
        attributes
    }
}
