//! Do the routes outside of the program know the cams that it knows, each by formulas of its own?

use std::f64::consts::TAU;
use std::path::Path;

use corner_impact::corner::map::RouteName;
use corner_impact::corner::told;
use corner_impact::model::{Model, Study};
use corner_impact::study::verify::{External, verify};
use serde_json::{Value, json};

use crate::common::{self, text};

/// Lift and two derivatives by the scripts of both routes, of each cam at the angles that are told.
const BOTH: &str = "
import json, sys
from bisect import bisect_right
sys.path.insert(0, 'derivations')
import evaluate, scipy_cams
document = sys.stdin.read()
plain, exact = json.loads(document), json.loads(document, parse_float=str, parse_int=str)
found = []
for one, other in zip(plain['cams'], exact['cams']):
    cam, laws = scipy_cams.Cam(one), evaluate.profile(other)
    starts = [float(angle) for angle, _ in laws]
    of_laws = lambda angle: [float(part) for part in laws[bisect_right(starts, angle) - 1][1].lift(angle)]
    found.append([[list(cam.law(angle)), of_laws(angle)] for angle in plain['angles']])
print(json.dumps(found))
";

/// The paper's machine with another follower on its cam.
fn followed_by(contact: &Value) -> Model {
    let paper = common::osorio();
    let study = json!({ "rpm_min": 350, "rpm_max": 1500 });
    let mut document = json!({ "follower": paper.follower, "cam": paper.cam, "study": study });
    document["cam"]["contact"] = contact.clone();
    Model::of_document("followed", &document).unwrap()
}

/// A valve behind a rocker: an offset roller, rounded corners and a lever together.
fn levered() -> Model {
    let paper = common::osorio();
    let mut document = json!({ "follower": paper.follower, "cam": paper.cam });
    document["cam"]["contact"] = json!({ "roller_radius": 0.1, "offset": 0.05 });
    document["cam"]["corner_rounding_deg"] = json!(5.0);
    document["cam"]["lever_ratio"] = json!(1.5);
    Model::of_document("levered", &document).unwrap()
}

/// Every law, with its corners rounded where it has some, and splines through and near the rows of a table: one with corners and
/// dwells that are found, one with a row beside the corner that is no knot.
fn cams() -> Vec<(String, Model)> {
    let laws =
        ["arcs", "harmonic", "rectified-sine", "program", "polynomial", "table-cubic", "table-quintic", "contour"];
    let file = |name: &str| match name {
        "arcs" => "models/osorio-2008.toml".to_owned(),
        _ => format!("models/laws/{name}.toml"),
    };
    let mut models: Vec<_> =
        laws.map(|name| (name.to_owned(), common::read(&Path::new(common::ROOT).join(file(name))))).into();
    for (name, rounding) in [("arcs", 5.0), ("program", 8.0), ("polynomial", 8.0)] {
        let sharp = models.iter().find(|(law, _)| law == name).unwrap();
        let mut document = json!({ "follower": sharp.1.follower, "cam": sharp.1.cam });
        document["cam"]["corner_rounding_deg"] = json!(rounding);
        models.push((format!("{name}, rounded"), Model::of_document("rounded", &document).unwrap()));
    }
    let contacts = [json!("flat"), json!({ "roller_radius": 0.2 }), json!({ "roller_radius": 0.1, "offset": 0.05 })];
    models.extend(contacts.map(|contact| (format!("arcs, {contact}"), followed_by(&contact))));
    models.push(("arcs, lever, rounded".into(), levered()));
    models.push(("contour, flat".into(), measured(&json!({ "law": "contour", "contact": "flat" }))));
    models.push(("smoothed".into(), measured(&json!({}))));
    models.push(("smoothed, a corner given".into(), measured(&json!({ "corners_deg": [150.3], "dwells_deg": [] }))));
    models
}

#[test]
#[ignore = "slow"]
fn a_number_of_the_follower_that_a_script_has_in_no_law_is_refused() {
    let model = Model::built_in().unwrap();
    let mut numbers = told(&model, model.study().unwrap()).unwrap();
    numbers["follower"]["drag"] = json!(0.5);
    let mut exact = model.exact();
    exact["follower"]["drag"] = json!("0.5");
    for (script, document) in [("evaluate.py", &numbers), ("simulate_scipy.py", &numbers), ("certify.py", &exact)] {
        let answer = common::python(&["-B", &format!("derivations/{script}")], document);
        let said = text(answer.stdout) + &text(answer.stderr);
        assert!(
            !answer.status.success() && said.contains("follower.drag: the laws of flight and impact"),
            "{script}: {said}"
        );
    }
}

#[test]
#[ignore = "slow"]
fn lifts_are_those_of_the_scripts() {
    let models = cams();
    let study = Study { rpm_min: 100.0, rpm_max: 1000.0 };
    let cams: Vec<Value> = models.iter().map(|(_, model)| told(model, study).unwrap()["cam"].take()).collect();
    // None is where two segments meet.
    let angles: Vec<f64> = (0..240).map(|index| (f64::from(index) + 0.371) * TAU / 240.0).collect();
    let answer = common::python(&["-c", BOTH], &json!({ "cams": cams, "angles": angles }));
    let found: Vec<Vec<[[f64; 3]; 2]>> = serde_json::from_slice(&answer.stdout).unwrap();
    assert_eq!(found.len(), models.len());
    for ((name, model), found) in models.iter().zip(found) {
        let cam = common::cam(model);
        // The rounding of short pieces grows with each derivative.
        let is_short = model.cam.law() == "table" || name.ends_with("rounded");
        let allowed = match model.cam.law() {
            // What the pieces of an envelope leave.
            "contour" => [1e-12, 1e-10, 1e-8],
            _ if is_short => [1e-13, 1e-11, 1e-9],
            _ => [1e-13; 3],
        };
        for (angle, both) in angles.iter().zip(found) {
            let lift = cam.lift(*angle);
            let own = [lift.value, lift.slope, lift.curvature];
            for (told, route) in both.iter().zip(["scipy", "symbolic"]) {
                for order in 0..3 {
                    let apart = (told[order] - own[order]).abs();
                    assert!(apart < allowed[order], "{name}: {route} at {angle}: order {order} is {apart} off");
                }
            }
        }
    }
}

/// The paper's cam, measured to a micrometre.
fn measured(more: &Value) -> Model {
    let paper = common::osorio();
    let cam = common::cam(&paper);
    let row = |k: u32| [f64::from(k), (cam.lift(f64::from(k).to_radians()).value * 1e6).round() / 1e6];
    let mut cam = json!({ "law": "table", "spline": "smoothing", "rows": (0..360).map(row).collect::<Vec<_>>() });
    cam.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    let study = json!({ "rpm_min": 600, "rpm_max": 760 });
    Model::of_document("measured", &json!({ "follower": paper.follower, "cam": cam, "study": study })).unwrap()
}

/// Two parabolas whose slopes were typed to ten digits, and two more, whose slopes gain something on the way round besides.
fn typed() -> [Model; 2] {
    let whole = std::fs::read_to_string(Path::new(common::ROOT).join("models/laws/polynomial.toml")).unwrap();
    let typed = whole.replace("0.06283185307179587", "0.0628318531") + "\n[study]\nrpm_min = 250\nrpm_max = 1500\n";
    let bent = typed.replacen("-0.02]", "-0.019999999995]", 1);
    assert!(bent != typed);
    [typed, bent].map(|text| Model::parse("typed.toml", &text).unwrap())
}

/// A cam of motions, one of which jumps, three of polynomials, two of them typed, and a measured one, of which no ball knows the spline.
#[test]
#[ignore = "slow"]
fn every_route_runs_on_every_cam_with_corners() {
    let new = |law: &str| {
        let file = text(common::corner_impact(["new", "--law", law]).stdout);
        Model::parse("new.toml", &file).unwrap()
    };
    let followers =
        [json!("flat"), json!({ "roller_radius": 0.1, "offset": 0.05 })].map(|contact| followed_by(&contact));
    let flat = measured(&json!({ "law": "contour", "contact": "flat" }));
    let cams = [new("program"), new("polynomial"), measured(&json!({})), flat];
    let levers = [&followers[0], &cams[1]].map(|model| model.with_number("cam.lever_ratio", 1.25).unwrap());
    for model in cams.into_iter().chain(typed()).chain(followers).chain(levers) {
        let (law, found) = (model.cam.law(), verify(&model, External::Run).unwrap());
        assert!(found.agrees, "{law}: {:?}", found.skipped);
        let last = (!["table", "contour"].contains(&law)).then_some(RouteName::Certificate);
        for name in [RouteName::Symbolic, RouteName::Scipy].into_iter().chain(last) {
            assert!(found.routes_by_name().any(|route| route.name == name), "{law}: {name} did not run");
        }
    }
}
