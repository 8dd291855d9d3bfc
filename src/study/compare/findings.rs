//! The quantities found for one model, each by a name, with their uncertainties.

use std::array;
use std::collections::BTreeMap;

use nalgebra::Matrix3;
use serde::Serialize;
use serde_json::{Value, json};

use super::{CornerVerdict, NoVerdict};
use crate::agreement::{Quantity, worse};
use crate::border_collision::feigin::speeds_at;
use crate::border_collision::validity::Range;
use crate::border_collision::{LocalMap, LocalOutcome, classify, conditions, normal_form};
use crate::cam::Cam;
use crate::corner::map::{LinearForm, rows};
use crate::corner::{self, CornerImpact, LocateError, Route, closed_form, variational};
use crate::model::{Converted, Model, Units};
use crate::progress::Watch;
use crate::study::StudyError;
use crate::study::cam::Largest;
use crate::study::design::contact::{Contact, Separation};
use crate::study::verify::{External, Verification, Whole, verify_watched};

/// Numbers by name.
pub type Numbers = BTreeMap<String, f64>;

/// Numbers and words by name.
pub type NamedValues = BTreeMap<String, Value>;

/// Converts a result to the form that documents have. Everything flattened here has named fields, so that this cannot fail.
fn document(found: &impl Serialize) -> Value {
    serde_json::to_value(found).unwrap_or_default()
}

/// Adds the numbers and words of a document to others, in the units of a model. Their names are made of the names of fields and the
/// indices, as in `A_minus_21`.
fn flatten(before: &str, value: &Value, told: Option<Converted>, units: &Units, all: &mut NamedValues) {
    let name = || before.trim_end_matches('_').to_owned();
    match value {
        Value::Object(fields) => {
            let between = if before.is_empty() || before.ends_with('_') { "" } else { "_" };
            for (field, value) in fields {
                let told = units.converted(field).or(told);
                flatten(&format!("{before}{between}{}_", units.field(field)), value, told, units, all);
            }
        }
        Value::Array(entries) => {
            for (index, entry) in (1..).zip(entries) {
                flatten(&format!("{before}{index}"), entry, told, units, all);
            }
        }
        Value::Number(number) => {
            let number = number.as_f64().unwrap_or(f64::NAN);
            all.insert(name(), told.map_or(number, |told| told(units, number)).into());
        }
        Value::Null => {}
        word => {
            all.insert(name(), word.clone());
        }
    }
}

/// Returns the numbers and words of documents. If several documents have one name, the first counts.
fn flattened(documents: &[Value], units: &Units) -> NamedValues {
    let mut all = NamedValues::new();
    documents.iter().rev().for_each(|document| flatten("", document, None, units, &mut all));
    all
}

/// Returns the documents of all quantities that follow from a map and its border.
fn follows(route: &Route, border: LinearForm, is_classified: bool) -> Vec<Value> {
    let (map, c, (e, f)) = (&route.map, route.c(), route.own.border.unwrap_or(border));
    let entries = json!({
        "A": map.map(|side| rows(&side.a)),
        "B": map.map(|side| <[f64; 2]>::from(side.b)),
        "C": [c[0], c[1]],
        "D": route.d(),
        "border": [e[0], e[1], f],
        "eigenvalues": route.eigenvalues(),
    });
    let kind = classify(map, (e, f)).ok().filter(|_| is_classified).map_or(Value::Null, |kind| {
        // The border is stated above, and the determinants are among the conditions.
        let mut kind = document(&kind);
        kind["border"].take();
        kind["determinant_of_identity_minus_a"].take();
        kind
    });
    let conditions = conditions(&LocalMap::new(map, (e, f)));
    let conditions = conditions.iter().flat_map(|condition| {
        let holds = (format!("{} holds", condition.name), condition.holds().into());
        [(condition.name.to_owned(), Value::from(condition.value)), holds]
    });
    let form = normal_form(map).map_or(Value::Null, |form| document(&form));
    vec![entries, form, kind, Value::Object(conditions.collect())]
}

/// Returns the quantities that depend on the cam and, if there is one, on the corner impact, by the closed form.
fn computed(model: &Model, cam: &Cam, at: Option<(&CornerImpact, bool)>, units: &Units) -> NamedValues {
    const NAMES: [&str; 3] = ["largest_velocity_m", "largest_acceleration_m", "largest_jerk_m"];
    // Both flanks of a cam may have the largest value, one upwards and one downwards. Rounding decides between them.
    let largest =
        NAMES.iter().zip(1..).map(|(name, order)| ((*name).to_owned(), json!(Largest::of(cam, order).value_m.abs())));
    let follower = &model.follower;
    let separation = Contact::new(cam, *follower).separation();
    let place = match separation {
        Separation::At { rpm, cam_angle, .. } => json!({ "speed_rpm": rpm, "cam_angle_rad": cam_angle }),
        _ => Value::Null,
    };
    let (lowest, highest) = (cam.lowest().value, -cam.least([-1.0, 0.0, 0.0, 0.0]).value);
    let of_cam = json!({
        "lowest_lift_m": lowest,
        "highest_lift_m": highest,
        // k (c_min - rest_position)
        "preload_n": follower.stiffness * (lowest - follower.rest_position),
        "separates": separation.name(),
        "separation": place,
    });
    let mut all = vec![Value::Object(largest.collect()), of_cam];
    if let Some((at, is_classified)) = at {
        let mut orbit = document(&Whole(at));
        // These say how well the period is known, not what it is.
        for field in ["period_bracket_s", "period_residual", "closure"] {
            orbit[field].take();
        }
        all.push(json!({ "T_star": orbit["period_s"].take(), "x_star": orbit["state"].take() }));
        all.push(orbit);
        all.extend(follows(&closed_form::route(model, at), variational::border(model, cam, at), is_classified));
    }
    flattened(&all, units)
}

/// Returns the quantities of a verification besides the map. Only one route gives them.
fn besides(found: &Verification) -> Vec<Value> {
    /// Largest number of words from the many orbits of some maps.
    const MOST_WORDS: usize = 8;
    let curved = found.second_order.as_ref().map(|curved| {
        // Each matrix is symmetric, and the fixed points to first order are those of the map.
        let half = |second: Matrix3<f64>| -> [[Option<f64>; 3]; 3] {
            array::from_fn(|row| array::from_fn(|column| (column >= row).then(|| second[(row, column)])))
        };
        json!({
            "second_derivatives": curved.map(|side| side.second.map(half)),
            "fixed_point_per_unit_period_squared": curved.map(|side| side.fixed_point().map(|[_, it]| [it[0], it[1]])),
        })
    });
    let range = |range: &Range| {
        let Range { compared, order, within, sign, speed_rpm, ends, .. } = range;
        let name = format!("linear_range_{compared}_{order}_{}_{within}", speeds_at(*sign));
        [(name.clone(), json!(speed_rpm)), (name + "_ends", document(ends))]
    };
    let local = |outcome: &LocalOutcome| {
        let outcome = document(outcome);
        let words = |list: &str, of: &dyn Fn(&Value) -> String| {
            let mut words = outcome[list].as_array().into_iter().flatten().map(of).collect::<Vec<_>>();
            let more = words.len().saturating_sub(MOST_WORDS);
            words.truncate(MOST_WORDS);
            words.extend((more > 0).then(|| format!("{more} more")));
            if words.is_empty() { "none".to_owned() } else { words.join(", ") }
        };
        let word = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let end = |end: &Value| format!("{} {}", word(&end["end"]), word(&end["word"])).trim_end().to_owned();
        let speeds = word(&outcome["speeds"]);
        let (ends, orbits) = (words("ends", &end), words("periodic_orbits", &|orbit| word(&orbit["word"])));
        [(format!("local_map_{speeds}"), ends.into()), (format!("local_map_{speeds}_orbits"), orbits.into())]
    };
    let rounded = found.rounded_corner.map(|corner| corner.rpm_per_degree);
    vec![
        curved.unwrap_or_default(),
        Value::Object(found.ranges.iter().flat_map(range).collect()),
        Value::Object(found.outcomes.iter().flat_map(local).collect()),
        json!({ "rounded_corner": { "fold_moves_rpm_per_degree": rounded } }),
        json!({ "danger": found.danger.as_ref().map_or("none".into(), |danger| danger.kind.to_string()) }),
    ]
}

/// Returns the spread between the routes in each number that follows from the map and its border, and in the orbit. A number of one route
/// alone has none.
#[doc(hidden)]
pub fn spreads(found: &Verification, units: &Units) -> Numbers {
    let mut ranges: BTreeMap<String, (usize, [f64; 2])> = BTreeMap::new();
    for route in &found.routes {
        for (name, value) in flattened(&follows(route, found.border, true), units) {
            let Some(number) = value.as_f64() else { continue };
            let (count, [least, most]) = ranges.entry(name).or_insert((0, [number; 2]));
            (*count, *least, *most) = (*count + 1, least.min(number), most.max(number));
        }
    }
    let spread = ranges.into_iter().filter(|(_, (count, _))| *count > 1);
    let mut spreads: Numbers = spread.map(|(name, (_, [least, most]))| (name, most - least)).collect();
    let orbit = |quantity| {
        let pairs = found.comparisons.iter().filter(|pair| pair.quantity == quantity);
        pairs.map(|pair| pair.max_abs_diff).reduce(worse)
    };
    let period = orbit(Quantity::Period);
    let speed = period.map(|error| error * found.at.speed_rpm() / found.at.period);
    let state = orbit(Quantity::State);
    let of_orbit = [("T_star", period), ("speed_rpm", speed), ("x_star_1", state), ("x_star_2", state)];
    spreads.extend(of_orbit.into_iter().filter_map(|(name, error)| Some((name.to_owned(), error?))));
    spreads
}

/// The quantities found for a model.
pub(super) struct Findings {
    pub verdict: CornerVerdict,
    /// The corner impact, and whether it is classified.
    at: Option<(CornerImpact, bool)>,
    /// Quantities from the closed form and the cam.
    pub computed: NamedValues,
    besides: NamedValues,
    /// Uncertainties of numbers, without those of the machine. Numbers of one route alone have none, except the separation speed.
    pub errors: Numbers,
}

impl Findings {
    pub fn new(model: &Model, units: &Units, external: External, watch: &dyn Watch) -> Result<Self, StudyError> {
        let cam = Cam::new(model)?;
        let mut errors = Numbers::new();
        if let Separation::At { error, .. } = Contact::new(&cam, model.follower).separation() {
            errors.insert("separation_speed_rpm".into(), error);
        }
        let (verdict, at, besides) = match verify_watched(model, external, watch) {
            Ok(found) => {
                errors.extend(spreads(&found, units));
                let besides = flattened(&besides(&found), units);
                let kind = found.classification.map(|kind| kind.scenario).map_err(NoVerdict::Refused);
                let at = (found.at, kind.is_ok());
                (CornerVerdict { found: kind, agrees: found.agrees }, Some(at), besides)
            }
            Err(why) => {
                let why = match why {
                    LocateError::Model(_) if model.study.is_none() => NoVerdict::NotLookedFor,
                    why => NoVerdict::NotThere(why),
                };
                (CornerVerdict { found: Err(why), agrees: true }, None, NamedValues::new())
            }
        };
        let computed = computed(model, &cam, at.as_ref().map(|(at, is_classified)| (at, *is_classified)), units);
        Ok(Self { verdict, at, computed, besides, errors })
    }

    /// Returns the quantities from the closed form and the cam for another model that is as likely. None if it lacks this corner impact.
    pub fn like(&self, model: &Model, cam: &Cam, units: &Units) -> Option<NamedValues> {
        let Some((at, is_classified)) = &self.at else { return Some(computed(model, cam, None, units)) };
        let (first, others) = corner::locate(model, cam).ok()?;
        let found = std::iter::once(first).chain(others).find(|found| at.is_near(found))?;
        Some(computed(model, cam, Some((&found, *is_classified)), units))
    }

    pub fn value(&self, name: &str) -> Option<&Value> {
        self.computed.get(name).or_else(|| self.besides.get(name))
    }

    pub fn names(&self) -> impl Iterator<Item = &String> {
        self.computed.keys().chain(self.besides.keys())
    }
}

/// Returns the quantities that `compare` has of one model, in its own units: the cam's, and the corner impact's if it is given.
pub fn values(model: &Model, cam: &Cam, found: Option<&Verification>) -> NamedValues {
    let at = found.map(|found| (&found.at, found.classification.is_ok()));
    let mut all = found.map_or_else(NamedValues::new, |found| flattened(&besides(found), &model.units));
    all.extend(computed(model, cam, at, &model.units));
    all
}

/// Returns the numbers among values.
pub(super) fn numbers(values: &NamedValues) -> Numbers {
    values.iter().filter_map(|(name, value)| Some((name.clone(), value.as_f64()?))).collect()
}

/// Returns the numbers of `b` less those of the same names in `a`.
pub(super) fn differences(b: &NamedValues, a: &NamedValues) -> Numbers {
    let a = numbers(a);
    numbers(b).into_iter().filter_map(|(name, number)| Some((name.clone(), number - a.get(&name)?))).collect()
}
