//! Do the routes outside of the program know the cams that it knows, each by formulas of its own?

use std::f64::consts::TAU;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

use corner_impact::corner::map::RouteName;
use corner_impact::study::verify::{External, verify};
use serde_json::{Value, json};

use crate::common::{self, text};

/// Lift and two derivatives by the scripts of both routes, at the angles that are told.
const BOTH: &str = "
import json, sys
from bisect import bisect_right
sys.path.insert(0, 'derivations')
import evaluate, simulate_scipy
document = sys.stdin.read()
plain, exact = json.loads(document), json.loads(document, parse_float=str, parse_int=str)
cam, laws = simulate_scipy.Cam(plain['cam']), evaluate.LAWS[plain['cam']['law']](exact['cam'])
starts = [float(angle) for angle, _ in laws]
of_laws = lambda angle: [float(part) for part in laws[bisect_right(starts, angle) - 1][1].lift(angle)]
print(json.dumps([[list(cam.law(angle)), of_laws(angle)] for angle in plain['angles']]))
";

#[test]
fn lifts_are_those_of_the_scripts() {
    for file in ["models/laws/program.toml", "models/laws/polynomial.toml", "models/osorio-2008.toml"] {
        let model = common::read(&Path::new(common::ROOT).join(file));
        let cam = common::cam(&model);
        // None is where two segments meet.
        let angles: Vec<f64> = (0..720).map(|index| (f64::from(index) + 0.371) * TAU / 720.0).collect();
        let document = json!({ "cam": model.cam, "angles": angles }).to_string();
        let python = Path::new(common::ROOT).join(".venv/bin/python");
        let mut command = Command::new(python);
        command.args(["-c", BOTH]).current_dir(common::ROOT).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().unwrap();
        child.stdin.take().unwrap().write_all(document.as_bytes()).unwrap();
        let found: Value = serde_json::from_str(&text(child.wait_with_output().unwrap().stdout)).unwrap();
        for (angle, both) in angles.iter().zip(found.as_array().unwrap()) {
            let lift = cam.lift(*angle);
            for (route, told) in both.as_array().unwrap().iter().enumerate() {
                for (order, own) in [lift.value, lift.slope, lift.curvature].into_iter().enumerate() {
                    let told = told[order].as_f64().unwrap();
                    assert!((told - own).abs() < 1e-13, "{file}: {route} at {angle}: order {order}: {told}, not {own}");
                }
            }
        }
    }
}

/// A cam of motions, one of which jumps, and one of polynomials.
#[test]
fn every_route_runs_on_motions_and_polynomials() {
    for law in ["program", "polynomial"] {
        let file = text(common::corner_impact(["new", "--law", law]).stdout);
        let model = corner_impact::model::Model::parse("new.toml", &file).unwrap();
        let found = verify(&model, External::Run).unwrap();
        assert!(found.agrees, "{law}: {:?}", found.skipped);
        for name in [RouteName::Symbolic, RouteName::Scipy, RouteName::Certificate] {
            assert!(found.routes_by_name().any(|route| route.name == name), "{law}: {name} did not run");
        }
    }
}
