//! Comparison of two models: every number that `verify`, `cam` and `design` find for both, by one name, with its uncertainty.
//!
//! A number that follows from A and B is computed from them by each route. The spread between the routes is its uncertainty. The
//! uncertainty of the machines is computed on plausible machines, and is added.

mod findings;
mod uncertain;

use std::cmp::Ordering;
use std::collections::BTreeSet;
use std::fmt;

use serde::{Serialize, Serializer};
use serde_json::Value;

use super::verify::External;
use super::{ModelLabel, StudyError};
use crate::border_collision::Refusal;
use crate::border_collision::feigin::Scenario;
use crate::corner::LocateError;
use crate::known::Evidence;
use crate::measured::Measured;
use crate::model::{FollowerErrors, Model};
use crate::progress::Watch;
use crate::tolerance;
use crate::uncertainty::{SourcedUncertainty, UncertaintyParts};
use findings::Findings;
#[doc(hidden)]
pub use findings::spreads;
pub use findings::{NamedValues, values};
use uncertain::{Side, open};

/// A value for each of the two models.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pair<T> {
    /// Value of the first model.
    pub a: T,
    /// Value of the second model.
    pub b: T,
}

/// The result of a comparison: the document `corner-impact/compare/1`, in the units of the first model.
#[derive(Clone, Debug)]
pub struct ModelComparison {
    /// The two models.
    pub models: Pair<ModelLabel>,
    /// Verdict at the corner impact of each.
    pub verdict: Pair<CornerVerdict>,
    /// The fields of the model files that differ.
    pub fields: Vec<FieldChange>,
    /// Quantities that differ by more than their error. Words come first, then numbers with an error, numbers without one, and quantities
    /// of one model alone. Among numbers, the speeds come first, then the largest relative changes.
    pub changes: Vec<Change>,
    /// Quantities that do not differ by more than their error, in the order of their names.
    pub unchanged: Vec<Change>,
    /// Accuracy of a measured cam with noise, of the first model if both have one.
    pub measured: Option<Measured>,
    /// Standard deviations of the followers' numbers, the larger of both models.
    pub errors: FollowerErrors,
}

document!(ModelComparison as it {
    schema: "corner-impact/compare/1",
    known: Evidence::Computed,
    models: it.models,
    verdict: it.verdict,
    verdict_changed: it.verdict_changed(),
    fields: it.fields,
    changes: it.changes,
    unchanged: it.unchanged,
    uncertain if_any: it.errors.if_any(),
});

impl ModelComparison {
    /// Whether the two verdicts differ, or the two agreements. Two models without a corner impact have one verdict, whatever the file and
    /// the corners.
    pub fn verdict_changed(&self) -> bool {
        let Pair { a, b } = &self.verdict;
        let is_alike = match (&a.found, &b.found) {
            (Err(NoVerdict::NotThere(_)), Err(NoVerdict::NotThere(_))) => true,
            (Err(NoVerdict::NotLookedFor), Err(NoVerdict::NotLookedFor)) => true,
            (a, b) => a == b,
        };
        !is_alike || a.agrees != b.agrees
    }

    /// Whether the routes that ran agree about both.
    pub fn agrees(&self) -> bool {
        self.verdict.a.agrees && self.verdict.b.agrees
    }
}

/// The verdict at a corner impact, and whether its verification agrees.
#[derive(Clone, Debug, PartialEq)]
pub struct CornerVerdict {
    /// The verdict, or the reason why there is none.
    pub found: Result<Scenario, NoVerdict>,
    /// Whether the routes that ran agree; true if none had to run.
    pub agrees: bool,
}

/// Reason why there is no verdict.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoVerdict {
    /// There is no corner impact to verify.
    #[error("no corner impact: {0}")]
    NotThere(LocateError),
    /// The model does not say where to look for a corner impact.
    #[error("no corner impact is looked for: the model has no [study]")]
    NotLookedFor,
    /// The map of the corner impact is refused.
    #[error("{0}")]
    Refused(Refusal),
}

impl fmt::Display for CornerVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.found {
            Ok(scenario) => write!(f, "{scenario}")?,
            Err(why) => write!(f, "{why}")?,
        }
        f.write_str(if self.agrees { "" } else { "; not verified: routes disagree or did not run" })
    }
}

impl Serialize for CornerVerdict {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(self)
    }
}

/// A field that differs between the model files.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FieldChange {
    /// Path of the field.
    pub field: String,
    /// Value in the first model, in its units, if any.
    pub a: Option<Value>,
    /// Value in the second model, in the units of the first, if any.
    pub b: Option<Value>,
}

/// One quantity of both models.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Name in the documents of `verify`, `cam` and `design`, with its side and its indices, counted from 1.
    pub quantity: String,
    /// Value in the first model: a number, a word, or nothing if it has no such quantity.
    pub a: Option<Value>,
    /// Value in the second model: a number, a word, or nothing.
    pub b: Option<Value>,
    /// Number b less number a.
    pub difference: Option<f64>,
    /// Uncertainty of the difference; none if unknown.
    pub error: Option<f64>,
    /// The size of the difference, over its error.
    pub times_error: Option<f64>,
    /// Difference over the size of the first number; none if that is 0.
    pub relative: Option<f64>,
    /// Part of `error` from the uncertainty of the machines; none if both are exact, or if it is unknown.
    pub open: Option<SourcedUncertainty>,
    /// Whether the two differ by more than their error; without an error, by more than rounding.
    pub is_one: bool,
}

document!(Change as it {
    quantity: it.quantity,
    a: it.a,
    b: it.b,
    difference: it.difference,
    error: it.error,
    times_error: it.times_error,
    relative: it.relative,
    error_parts if_any: it.open.map(|open| UncertaintyParts(open, "")),
});

impl Change {
    /// Compares the values of both models, with the uncertainty of each. `open` is the uncertainty of the machines in the difference.
    #[doc(hidden)]
    pub fn new(
        quantity: &str,
        [a, b]: [Option<&Value>; 2],
        errors: [Option<f64>; 2],
        open: Option<SourcedUncertainty>,
    ) -> Self {
        let numbers = a.and_then(Value::as_f64).zip(b.and_then(Value::as_f64));
        let difference = numbers.map(|(a, b)| b - a);
        let rounding = tolerance::ULP.value * numbers.map_or(0.0, |(a, b)| a.abs().max(b.abs()));
        let both = errors[0].zip(errors[1]).filter(|_| difference.is_some());
        let total = open.map_or(0.0, |open| open.total());
        let error = both.map(|(a, b)| a + b + total + rounding).filter(|error| !error.is_nan());
        let relative = numbers.filter(|(a, _)| *a != 0.0).map(|(a, b)| (b - a) / a.abs());
        let is_one = difference.map_or(a != b, |difference| difference.abs() > error.unwrap_or(rounding));
        let times_error = difference.zip(error).filter(|(_, error)| *error > 0.0);
        Self {
            quantity: quantity.to_owned(),
            a: a.cloned(),
            b: b.cloned(),
            difference,
            error,
            times_error: times_error.map(|(difference, error)| difference.abs() / error),
            relative,
            open: open.filter(|_| error.is_some()),
            is_one,
        }
    }

    /// Sort key: words first, then numbers with an error, those without, and quantities of one model alone. Among numbers, the two main
    /// speeds come first, then larger relative changes before smaller ones.
    fn rank(&self) -> (bool, bool, bool, bool, f64) {
        let is_alone = self.a.is_none() || self.b.is_none();
        let relative = self.relative.map_or(f64::INFINITY, f64::abs);
        let is_unknown = self.difference.is_some() && self.error.is_none();
        (is_alone, is_unknown, self.difference.is_some(), !self.is_speed(), -relative)
    }

    /// Whether the quantity is the speed of the corner impact or of the separation.
    pub fn is_speed(&self) -> bool {
        const SPEEDS: [&str; 2] = ["speed_rpm", "separation_speed_rpm"];
        SPEEDS.contains(&self.quantity.as_str())
    }
}

/// Returns the fields in which two model files differ, in the units of the first.
fn fields(a: &Model, b: &Model) -> Vec<FieldChange> {
    let told = |path: &str, value: &Value| {
        let units = path.strip_prefix("follower.").map(|name| (a.units.of_follower(name), b.units.of_follower(name)));
        match (units, value.as_f64()) {
            (Some((Some(of_a), Some(of_b))), Some(number)) if of_a != of_b => of_a.told(of_b.inside(number)).into(),
            _ => value.clone(),
        }
    };
    let (of_a, of_b) = (a.values(), b.values());
    let paths: BTreeSet<&str> = of_a.keys().chain(of_b.keys()).copied().collect();
    let field = |path: &str| {
        let (a, b) = (of_a.get(path).cloned(), of_b.get(path).map(|value| told(path, value)));
        (a != b).then(|| FieldChange { field: path.to_owned(), a, b })
    };
    let mut fields: Vec<FieldChange> = paths.into_iter().filter_map(field).collect();
    if let (Some(one), Some(other)) = (a.table(), b.table())
        && one.rows != other.rows
    {
        let changed = one.rows.iter().zip(&other.rows[..]).filter(|(one, other)| one != other).count();
        let (a, b) = (format!("{} rows", one.rows.len()), format!("{} rows, {changed} others", other.rows.len()));
        fields.push(FieldChange { field: "rows of the table".into(), a: Some(a.into()), b: Some(b.into()) });
    }
    fields
}

/// Compares two models. Without `external`, only the routes of this program run.
pub fn compare(a: &Model, b: &Model, external: External, watch: &dyn Watch) -> Result<ModelComparison, StudyError> {
    let lengths = [a, b].map(|model| model.units.length.name().to_owned());
    if lengths[0] != lengths[1] {
        let [a, b] = lengths;
        return Err(StudyError::Lengths { a, b });
    }
    let (models, fields) = (Pair { a: ModelLabel::of(a), b: ModelLabel::of(b) }, fields(a, b));
    let units = &a.units;
    let (of_a, of_b) = (Findings::new(a, units, external, watch)?, Findings::new(b, units, external, watch)?);
    watch.at("uncertainty of the differences", 0, 0);
    let side = |model, found| Side { model, found, units };
    let (open, measured) = open(&side(a, &of_a), &side(b, &of_b))?;
    let names: BTreeSet<&String> = of_a.names().chain(of_b.names()).collect();
    let all = names.into_iter().map(|name| {
        let open = open.get(name).copied();
        // A quantity that only the uncertainty of a machine makes uncertain has no other error.
        let error = |found: &Findings| found.errors.get(name).copied().or(open.map(|_| 0.0));
        Change::new(name, [of_a.value(name), of_b.value(name)], [error(&of_a), error(&of_b)], open)
    });
    let (mut changes, unchanged): (Vec<Change>, Vec<Change>) = all.partition(|change| change.is_one);
    changes.sort_by(|one, other| one.rank().partial_cmp(&other.rank()).unwrap_or(Ordering::Equal));
    let verdict = Pair { a: of_a.verdict, b: of_b.verdict };
    Ok(ModelComparison { models, verdict, fields, changes, unchanged, measured, errors: a.errors.or(b.errors) })
}
