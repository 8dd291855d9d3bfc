//! Does the closed form meet what computer algebra derives, at 200 points, damped and undamped?

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use crate::common;
use corner_impact::cam::Lift;
use corner_impact::corner::closed_form::side_map;
use corner_impact::flight::Flight;
use corner_impact::model::Follower;
use serde_json::Value;

const CLOSED_FORMS: &str = include_str!("../../golden/derived/closed_forms.json");
const POINTS: &str = include_str!("../../golden/derived/points.json");

fn number(value: &Value) -> f64 {
    value.as_str().unwrap().parse().unwrap()
}

#[test]
fn two_hundred_points_to_twelve_digits() {
    let document: Value = serde_json::from_str(POINTS).unwrap();
    let points = document["points"].as_array().unwrap();
    assert_eq!(points.len(), 200);
    let mut kinds = BTreeMap::new();
    for point in points {
        let kind = point["kind"].as_str().unwrap();
        *kinds.entry(kind).or_insert(0) += 1;
        let input = |name: &str| number(&point["inputs"][name]["decimal"]);
        let (period, position) = (input("T"), 0.25);
        // With mass 1; the spring is slack at the corner, so that gravity alone is w0^2 (q - rest) + g.
        let follower = Follower {
            mass: 1.0,
            damping: 2.0 * input("zeta"),
            stiffness: input("omega0_squared"),
            gravity: input("spring"),
            rest_position: position,
            restitution: input("r"),
        };
        let omega = TAU / period;
        let (slope, curvature) = (input("c1") / omega, input("c2") / (omega * omega));
        let lift = Lift { value: position, slope, curvature, third: 0.0 };
        let map = side_map(&follower, period, input("v"), &lift);
        let rows = point["A"].as_array().unwrap();
        for (index, row) in rows.iter().enumerate() {
            meets(map.a[(index, 0)], number(&row[0]), point);
            meets(map.a[(index, 1)], number(&row[1]), point);
            meets(map.b[index], number(&point["B"][index]), point);
        }
        let response = Flight::new(&follower).response(0.5 * period);
        meets(response.step, number(&point["p"]), point);
        meets(response.impulse, number(&point["s"]), point);
    }
    assert!(kinds.len() == 6 && kinds.values().all(|count| *count >= 10), "{kinds:?}");
}

#[track_caller]
fn meets(computed: f64, derived: f64, point: &Value) {
    assert!(
        (computed - derived).abs() <= 1e-12 * derived.abs(),
        "{computed:e} against {derived:e} at {}",
        point["inputs"]
    );
}

/// The lines that computer algebra proves, evaluated as they stand, against the Rust code on every model.
#[test]
fn the_proved_lines_give_what_the_code_gives() {
    let document: Value = serde_json::from_str(CLOSED_FORMS).unwrap();
    let lines = document["lines"].as_array().unwrap();
    for file in common::model_files() {
        let model = common::read(&file);
        let at = corner_impact::corner::locate(&model, &common::cam(&model)).unwrap().0;
        let follower = model.follower;
        let (zeta, omega0_squared) = (0.5 * follower.damping / follower.mass, follower.stiffness / follower.mass);
        let half = Flight::new(&follower).response(0.5 * at.period);
        let omega = TAU / at.period;
        for lift in [&at.corner.minus, &at.corner.plus] {
            let spring = omega0_squared * (lift.value - follower.rest_position) + follower.gravity;
            let mut values: BTreeMap<String, f64> = [
                ("zeta", zeta),
                ("omega0_squared", omega0_squared),
                ("T", at.period),
                ("r", follower.restitution),
                ("spring", spring),
                ("v", at.velocity_before),
                ("c1", omega * lift.slope),
                ("c2", omega * omega * lift.curvature),
                ("p", half.step),
                ("s", half.impulse),
            ]
            .map(|(name, value)| (name.to_owned(), value))
            .into();
            for line in lines {
                let value = evaluate(line["expression"].as_str().unwrap(), &values);
                values.insert(line["name"].as_str().unwrap().into(), value);
            }
            let map = side_map(&follower, at.period, at.velocity_before, lift);
            let entries = [
                ("A11", map.a.m11),
                ("A12", map.a.m12),
                ("A21", map.a.m21),
                ("A22", map.a.m22),
                ("B1", map.b.x),
                ("B2", map.b.y),
            ];
            for (name, computed) in entries {
                let proved = values[name];
                let largest = if name.starts_with('A') { map.a.abs().max() } else { map.b.abs().max() };
                assert!(
                    (computed - proved).abs() <= 1e-12 * largest,
                    "{file:?} {name}: {computed:e} against {proved:e}"
                );
            }
        }
    }
}

/// Text in + - * / **, integers, names and brackets.
fn evaluate(text: &str, values: &BTreeMap<String, f64>) -> f64 {
    let letters: Vec<char> = text.chars().filter(|letter| !letter.is_whitespace()).collect();
    let mut reader = Reader { letters: &letters, at: 0, values };
    let value = reader.sum();
    assert_eq!(reader.at, letters.len(), "all of {text} is read");
    value
}

struct Reader<'a> {
    letters: &'a [char],
    at: usize,
    values: &'a BTreeMap<String, f64>,
}

impl Reader<'_> {
    fn next_is(&self, text: &str) -> bool {
        self.letters[self.at..].starts_with(&text.chars().collect::<Vec<_>>())
    }

    fn take(&mut self, text: &str) -> bool {
        let found = self.next_is(text);
        self.at += if found { text.len() } else { 0 };
        found
    }

    fn sum(&mut self) -> f64 {
        let mut value = self.product();
        loop {
            if self.take("+") {
                value += self.product();
            } else if self.take("-") {
                value -= self.product();
            } else {
                return value;
            }
        }
    }

    fn product(&mut self) -> f64 {
        let mut value = self.sign();
        loop {
            if !self.next_is("**") && self.take("*") {
                value *= self.sign();
            } else if self.take("/") {
                value /= self.sign();
            } else {
                return value;
            }
        }
    }

    fn sign(&mut self) -> f64 {
        if self.take("-") { -self.sign() } else { self.power() }
    }

    fn power(&mut self) -> f64 {
        let base = self.atom();
        if self.take("**") { base.powf(self.sign()) } else { base }
    }

    fn atom(&mut self) -> f64 {
        if self.take("(") {
            let value = self.sum();
            assert!(self.take(")"));
            return value;
        }
        let start = self.at;
        while self.at < self.letters.len() && (self.letters[self.at].is_alphanumeric() || self.letters[self.at] == '_')
        {
            self.at += 1;
        }
        let word: String = self.letters[start..self.at].iter().collect();
        word.parse().unwrap_or_else(|_| *self.values.get(&word).unwrap_or_else(|| panic!("no value for \"{word}\"")))
    }
}
