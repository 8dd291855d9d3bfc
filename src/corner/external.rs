//! Orbit and map by programs outside this one: `symbolic` (the derived expressions, to 30 digits) and `scipy` (its own integration). Both
//! read only the numbers of the model file and locate the corner impact themselves. For a smoothing spline they compute their own spline,
//! with the weight and the knots chosen here.

use nalgebra::{Matrix2, RowVector2, Vector2};
use serde::Deserialize;
use serde_json::{Value, json};

use super::map::{Eigenvalue, Own, Route, RouteName, SideMap, Sides, Uncertainty};
use crate::cam;
use crate::model::{Model, ModelError, Study};
use crate::python::{self, PythonError};

/// Route outside this program: its name, and its script in `derivations/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Program {
    pub name: RouteName,
    pub script: &'static str,
}

/// All routes outside this program.
pub const PROGRAMS: [Program; 2] = [
    Program { name: RouteName::Symbolic, script: "evaluate.py" },
    Program { name: RouteName::Scipy, script: "simulate_scipy.py" },
];

/// Results of an outside route.
#[derive(Clone, Debug, PartialEq)]
pub struct Outside {
    pub route: Route,
    /// x*, m from the equilibrium and m/s.
    pub x_star: Vector2<f64>,
    /// T*, s.
    pub period: f64,
}

/// Input of the outside routes for a model with study range `study`: its numbers, and for a smoothing spline the choices of its fit.
#[doc(hidden)]
pub fn told(model: &Model, study: Study) -> Result<Value, ModelError> {
    let mut numbers = json!({ "follower": model.follower, "cam": model.cam, "study": study });
    if let Some(fitted) = cam::fitted(model)? {
        numbers["cam"]["fitted"] = json!(fitted);
    }
    Ok(numbers)
}

/// Runs an outside route on the input from [`told`].
pub fn run(program: Program, told: &Value) -> Result<Outside, PythonError> {
    let answer: Answer = python::run(program.script, told)?;
    let (map, own) = (answer.map.map(Matrices::map), answer.own());
    let uncertainty = answer.standard_error.map(|error| Uncertainty::Fit {
        standard: error.map(Matrices::map),
        systematic: None,
        condition_number: answer.condition_number.unwrap_or(f64::NAN),
    });
    Ok(Outside {
        route: Route { name: program.name, map, own, uncertainty },
        x_star: Vector2::new(answer.x_star[0].value(), answer.x_star[1].value()),
        period: answer.period_s.value(),
    })
}

/// Number: a double, or text with more digits than a double has.
#[derive(Deserialize)]
#[serde(untagged)]
enum Number {
    Double(f64),
    Digits(String),
}

impl Number {
    /// Nearest double; NaN for text that is not a number, which fails every comparison.
    fn value(&self) -> f64 {
        match self {
            Self::Double(value) => *value,
            Self::Digits(digits) => digits.parse().unwrap_or(f64::NAN),
        }
    }
}

#[derive(Deserialize)]
struct Answer {
    period_s: Number,
    x_star: [Number; 2],
    #[serde(flatten)]
    map: Sides<Matrices>,
    standard_error: Option<Sides<Matrices>>,
    condition_number: Option<f64>,
    eigenvalues: Sides<[Parts; 2]>,
    border: [Number; 3],
    #[serde(rename = "C")]
    c: Option<[Number; 2]>,
    #[serde(rename = "D")]
    d: Option<Number>,
}

impl Answer {
    fn own(&self) -> Own {
        let line = |[first, second]: &[Number; 2], last: &Number| {
            (RowVector2::new(first.value(), second.value()), last.value())
        };
        let [e1, e2, f] = &self.border;
        Own {
            jump: self.c.as_ref().zip(self.d.as_ref()).map(|(c, d)| line(c, d)),
            eigenvalues: Some(self.eigenvalues.map(|pair| pair.each_ref().map(Parts::eigenvalue))),
            ..Own::border((RowVector2::new(e1.value(), e2.value()), f.value()))
        }
    }
}

/// Eigenvalue, by its real and imaginary parts.
#[derive(Deserialize)]
struct Parts {
    re: Number,
    im: Number,
}

impl Parts {
    fn eigenvalue(&self) -> Eigenvalue {
        Eigenvalue { re: self.re.value(), im: self.im.value() }
    }
}

#[derive(Deserialize)]
struct Matrices {
    #[serde(rename = "A")]
    a: [[Number; 2]; 2],
    #[serde(rename = "B")]
    b: [Number; 2],
}

impl Matrices {
    fn map(&self) -> SideMap {
        SideMap {
            a: Matrix2::from_fn(|row, column| self.a[row][column].value()),
            b: Vector2::from_fn(|row, _| self.b[row].value()),
        }
    }
}
