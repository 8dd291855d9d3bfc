//! Does ± reach every answer that is asked over another number, beside another model, or in a table? By closed forms, and by the same command
//! asked at one value.

use corner_impact::cam::Cam;
use corner_impact::corner;
use corner_impact::model::Model;
use corner_impact::orbit::Parameter;
use corner_impact::orbit::long_run::Budget;
use corner_impact::progress::Unwatched;
use corner_impact::study::attractors::{Cause, Resolution};
use corner_impact::study::compare::compare;
use corner_impact::study::design::needs::Lever;
use corner_impact::study::design::{Asked, Design, design};
use corner_impact::study::speeds::{SpeedSurvey, speeds};
use corner_impact::study::survey::{Axis, Over, Values};
use corner_impact::study::verify::External;
use corner_impact::uncertainty::SourcedUncertainty;
use corner_impact_cli::show::Paged;
use serde_json::{Value, json};

use crate::common;
use crate::orbit_numbers::model;
use crate::uncertainty::{cosine, near, part, with};

const AMPLITUDE: f64 = 0.01;
const HIGH: f64 = 0.03;
const GRAVITY: f64 = 9.81;

/// A follower that leaves the cam of [`cosine`] where `m w^2 A = k h + m g`.
fn follower(mass: Value, stiffness: Value) -> Model {
    cosine(&json!({
        "mass": mass, "stiffness": stiffness, "gravity": GRAVITY, "rest_position": 0.0, "damping": 0.0, "restitution": 0.5,
    }))
}

/// Separation speed, rpm, and its derivatives with respect to mass and stiffness.
fn leaves(mass: f64, stiffness: f64) -> [f64; 3] {
    let omega = ((stiffness * HIGH + mass * GRAVITY) / (mass * AMPLITUDE)).sqrt();
    let rpm = 60.0 / std::f64::consts::TAU;
    let square = [-stiffness * HIGH / (mass * mass * AMPLITUDE), HIGH / (mass * AMPLITUDE)];
    let [by_mass, by_stiffness] = square.map(|by| rpm * by / (2.0 * omega));
    [rpm * omega, by_mass, by_stiffness]
}

/// The mass is one and the same in both; each stiffness has an error of its own.
#[test]
fn a_difference_has_less_of_an_error_that_both_machines_share() {
    let (mass, [one, other], errors) = (0.5, [2000.0, 2600.0], [0.005, 30.0]);
    let [a, b] = [one, other].map(|stiffness| follower(with(mass, errors[0]), with(stiffness, errors[1])));
    let found = compare(&a, &b, External::LeftOut, &Unwatched).unwrap();
    let of = |name: &str| found.changes.iter().find(|change| change.quantity == name).unwrap();
    let change = of("separation_speed_rpm");
    let open = change.open.unwrap();
    let [[from, mass_a, stiffness_a], [to, mass_b, stiffness_b]] = [leaves(mass, one), leaves(mass, other)];
    near(change.difference.unwrap(), to - from, 1e-6);
    near(part(&open, "mass"), 2.0 * errors[0] * (mass_b - mass_a).abs(), 1e-2);
    near(part(&open, "stiffness"), 2.0 * errors[1] * stiffness_a.hypot(stiffness_b), 1e-3);
    near(change.error.unwrap(), open.total(), 1e-6);
    assert_eq!(open.cam, 0.0);
    // The stress of the spring at the lowest lift: k (c_min - rest), b less a.
    near(part(&of("preload_n").open.unwrap(), "stiffness"), 2.0 * errors[1] * 0.01 * 2.0_f64.sqrt(), 1e-6);
    let document = serde_json::to_value(&found).unwrap();
    assert_eq!(document["uncertain"], json!(["mass", "stiffness"]));
    let speed =
        document["changes"].as_array().unwrap().iter().find(|it| it["quantity"] == "separation_speed_rpm").unwrap();
    near(speed["error_parts"]["mass"].as_f64().unwrap(), part(&open, "mass"), 1e-12);
    let page = common::in_one_line(&found.text().unwrap());
    for words in ["separation_speed_rpm: moved by ", "from the numbers (stiffness ", "acts on both alike"] {
        assert!(page.contains(words), "{words}: {page}");
    }
    // The same machine twice differs in nothing, whatever its errors.
    let same = compare(&a, &a, External::LeftOut, &Unwatched).unwrap();
    assert!(same.unchanged.iter().all(|change| change.open.is_none_or(|open| open.total() == 0.0)), "{same:?}");
}

/// A machine without errors has no new fields.
#[test]
fn exact_machines_have_no_parts() {
    let model = follower(json!(0.5), json!(2000.0));
    let found = compare(&model, &model.with_number("follower.mass", 0.6).unwrap(), External::LeftOut, &Unwatched);
    let document = serde_json::to_string(&found.unwrap()).unwrap();
    assert!(!document.contains("error_parts") && !document.contains("uncertain"), "{document}");
}

fn survey(model: &Model, path: &str, rpm: f64, range: [f64; 2], step: f64) -> SpeedSurvey {
    let over = Over::new(model, Parameter::Field(path.into()), Some(rpm)).unwrap();
    let budget = Budget { patience: 0, ..Budget::SURVEY };
    let resolution = Resolution { budget, ..Resolution::new(common::step(step), 4) };
    speeds(&over, range, &resolution, &Unwatched).unwrap()
}

/// At one speed the follower leaves the cam at `k = m (w^2 A - g) / h`, whose own error does not matter.
#[test]
fn a_detachment_over_a_number_has_the_parts_of_the_others() {
    let (mass, error) = (0.5, 0.005);
    let model = follower(with(mass, error), with(2000.0, 50.0));
    let [rpm, ..] = leaves(mass, 2003.0);
    let found = survey(&model, "follower.stiffness", rpm, [1900.0, 2100.0], 50.0);
    let [value, _] = found.detachment().unwrap();
    near(value, 2003.0, 1e-9);
    let whole = found.detachment_error().unwrap();
    near(part(&whole, "mass"), 2.0 * error * value / mass, 1e-6);
    assert_eq!((part(&whole, "stiffness"), whole.cam), (0.0, 0.0));
    assert_eq!(found.errors.uncertain().map(|(name, _)| name).collect::<Vec<_>>(), ["mass"]);
    let document = serde_json::to_value(&found).unwrap();
    near(document["detachment_error"].as_f64().unwrap(), whole.total(), 1e-12);
    near(document["detachment_error_parts"]["mass"].as_f64().unwrap(), whole.total(), 1e-12);
    assert!(document.get("detachment_error_rpm").is_none());
    let ends = document["attractors"].as_array().unwrap().iter().flat_map(|row| [&row["birth"], &row["death"]]);
    let end = ends.into_iter().find(|end| end["cause"] == "detachment").unwrap();
    near(end["error"].as_f64().unwrap(), whole.total(), 1e-12);
    assert!(end.get("error_rpm").is_none() && end["error_parts"]["numbers"].as_f64().is_some(), "{end}");
    let page = common::in_one_line(&found.text().unwrap());
    assert!(page.contains("2003 ± 41 N/m, from the numbers (mass 41)"), "{page}");
    assert!(page.contains("from the errors of mass. ") && !page.contains("errors of mass and stiffness"), "{page}");
}

/// A corner impact over the restitution moves as the speeds of the corner impacts of other machines say: `dr = -(dw/dm) / (dw/dr) dm`.
#[test]
fn an_event_over_a_number_moves_as_its_speed_says() {
    let error = 0.0004;
    let model = common::osorio_with(&[
        ("mass", &format!("{{ value = 1.221, error = {error} }}")),
        ("restitution", "{ value = 0.7, error = 0.01 }"),
    ]);
    let speed = |name: &str, value: f64| {
        let model = common::osorio()
            .changed(&[("restitution", 0.7), (name, value)].map(|(name, value)| (name.to_owned(), value)));
        let model = model.or_else(|_| common::osorio().changed(&[(name.to_owned(), value)])).unwrap();
        let (at, _) = corner::locate(&model, &Cam::new(&model).unwrap()).unwrap();
        at.speed_rpm()
    };
    let by_mass = (speed("mass", 1.221 + error) - speed("mass", 1.221 - error)) / (2.0 * error);
    let by_restitution = (speed("restitution", 0.701) - speed("restitution", 0.699)) / 0.002;
    let found = survey(&model, "follower.restitution", speed("restitution", 0.7), [0.66, 0.74], 0.02);
    let ends = found.attractors.iter().flat_map(|row| row.birth.iter().chain(&row.death));
    let end = ends.clone().find(|end| matches!(end.cause, Cause::CornerImpact { .. })).unwrap();
    near(end.value(), 0.7, 1e-9);
    let whole = end.error.unwrap();
    near(part(&whole, "mass"), 2.0 * error * (by_mass / by_restitution).abs(), 1e-2);
    assert_eq!(part(&whole, "restitution"), 0.0);
}

fn over(model: &Model, path: &str, rpm: f64, values: &[f64]) -> Design {
    let axis = Axis::of(Parameter::Field(path.into()), values.into());
    let asked = Asked { rpm: Some([rpm; 2]), over: Some(axis), speeds: 2, ..Asked::default() };
    design(model, &asked, &Unwatched).unwrap()
}

/// A measured valve: 0.11 kg, 30 N/mm and 220 N of preload, with errors.
fn valve(changes: &[(&str, f64)]) -> Model {
    let file = "src/model/templates/table.toml";
    common::read(std::path::Path::new(file))
        .changed(&changes.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect::<Vec<_>>())
        .unwrap()
}

/// At each value the table has the ± of the machine with that number, and none of the number itself.
#[test]
#[ignore = "slow"]
fn a_table_over_a_number_has_the_uncertainty_of_the_machine_at_each_value() {
    let model = valve(&[("mass.error", 0.001), ("stiffness.error", 0.3)]);
    for (path, values) in [("follower.stiffness", [25.0, 35.0]), ("cam.lever_ratio", [0.95, 1.05])] {
        let found = over(&model, path, 3200.0, &values);
        for ((value, force), loads) in values.into_iter().zip(&found.forces).zip(&found.loads) {
            let alone = model.with_number(path, value).unwrap();
            let asked = Asked { rpm: Some([3200.0; 2]), ..Asked::default() };
            let alone = design(&alone, &asked, &Unwatched).unwrap();
            let errors = |found: SourcedUncertainty, alone: SourcedUncertainty| {
                near(found.cam, alone.cam, 1e-6);
                near(part(&found, "mass"), part(&alone, "mass"), 1e-6);
                assert!(found.cam > 0.0 && part(&found, "mass") > 0.0, "{path} = {value}: {found:?}");
                let exact = path == "follower.stiffness";
                assert_eq!(part(&found, "stiffness") == 0.0, exact, "{path} = {value}: {found:?}");
            };
            errors(force.error.unwrap(), alone.forces[0].error.unwrap());
            let (here, alone) = (loads.errors.unwrap()[4], alone.loads[0].errors.unwrap()[4]);
            near(here.cam, alone.cam, 1e-6);
            assert!(here.cam > 0.0 && here.numbers > 0.0, "{path} = {value}: {here:?}");
        }
    }
}

/// The one uncertain number is exact where it varies: nothing in the table is unknown, and the page says so.
#[test]
fn a_table_over_the_only_uncertain_number_is_exact() {
    let model = follower(json!(0.5), with(2000.0, 30.0));
    let found = over(&model, "follower.stiffness", 700.0, &[1500.0, 2500.0]);
    assert!(found.forces.iter().all(|at| at.error.is_none()) && found.loads.iter().all(|at| at.errors.is_none()));
    let page = common::in_one_line(&found.text().unwrap());
    assert!(!page.contains("± ?") && page.contains("rpm, from the numbers (stiffness "), "{page}");
    assert!(page.contains("Where stiffness varies, stiffness is exact."), "{page}");
}

/// Any number of the model may be given to a need. The answer at each value is that of the machine with it.
#[test]
#[ignore = "slow"]
fn needs_over_any_number_are_those_of_each_machine() {
    let need = "no separation to 1500 rpm";
    let model = follower(with(0.5, 0.005), json!(2000.0));
    let needs = vec![(need.to_owned(), need.parse().unwrap())];
    for (path, values) in
        [("follower.gravity", [0.0, 20.0]), ("cam.offset", [0.02, 0.03]), ("follower.mass", [0.3, 0.4])]
    {
        let against = Some(Axis::of(Parameter::Field(path.into()), values.as_slice().into()));
        let asked = Asked { rpm: Some([100.0, 200.0]), speeds: 2, needs: needs.clone(), ..Asked::default() };
        let found = design(&model, &Asked { against, ..asked.clone() }, &Unwatched).unwrap();
        assert_eq!(found.trades.len(), Lever::ALL.iter().filter(|lever| lever.path() != path).count());
        for trade in found.trades.iter().filter(|trade| trade.parameter != Lever::Damping) {
            assert_eq!(path.rsplit('.').next(), Some(trade.against.as_str()));
            for (pair, value) in trade.pairs.iter().zip(values) {
                let alone = design(&model.with_number(path, value).unwrap(), &asked, &Unwatched).unwrap();
                let alone = alone.needs.into_iter().find(|it| it.lever == trade.parameter).unwrap();
                assert_eq!((pair.given, pair.found), (value, alone.value), "{path} = {value}");
                let total = |error: Option<SourcedUncertainty>| error.map_or(0.0, |error| error.total());
                near(total(pair.error), total(alone.error), 1e-9);
            }
        }
    }
    let document = serde_json::to_value(design_over_mass(&model, need)).unwrap();
    let pair = &document["trades"][0]["pairs"][0];
    assert!(pair.get("error").is_none() || pair["error_parts"]["numbers"].as_f64().is_some(), "{pair}");
    let words =
        common::corner_impact(["design", "--need", "no separation to 200 rpm", "--over", "base_radius=0.39:0.41:2"]);
    let page = common::in_one_line(&common::text(words.stdout));
    assert!(page.contains("the most mass for each base radius") && page.contains("base radius m mass kg"), "{page}");
}

fn design_over_mass(model: &Model, need: &str) -> Design {
    let against = Some(common::axis_of(Lever::Mass, &Values::linear(0.3, 0.4, 2)));
    let needs = vec![(need.to_owned(), need.parse().unwrap())];
    design(model, &Asked { rpm: Some([100.0, 200.0]), speeds: 2, needs, against, ..Asked::default() }, &Unwatched)
        .unwrap()
}

/// A preload that is given to a machine with a rest position is exact. The rest position is kept as the stiffness is sought, whose own error does
/// not matter.
#[test]
fn a_given_preload_is_exact_and_moves_the_rest_position() {
    let need = "no separation to 1500 rpm";
    let needs = vec![(need.to_owned(), need.parse().unwrap())];
    let model = follower(json!(0.5), with(2000.0, 30.0));
    let against = Some(common::axis_of(Lever::Preload, &Values::linear(30.0, 40.0, 2)));
    let asked = Asked { rpm: Some([100.0, 200.0]), speeds: 2, needs, against, ..Asked::default() };
    let found = design(&model, &asked, &Unwatched).unwrap();
    let of = |lever: Lever| &found.trades.iter().find(|trade| trade.parameter == lever).unwrap().pairs;
    let square = (1500.0 / 60.0 * std::f64::consts::TAU).powi(2);
    for pair in of(Lever::Stiffness) {
        // F = k0 (A - rest), and k (3 A - rest) = m (A w^2 - g) at the top, with 2 A of lift from the bottom.
        let rest = AMPLITUDE - pair.given / 2000.0;
        near(pair.found.unwrap(), 0.5 * (AMPLITUDE * square - GRAVITY) / (HIGH - rest), 1e-9);
        assert_eq!(pair.error.unwrap().total(), 0.0);
    }
    for pair in of(Lever::Mass) {
        // m = (F + 2 k A) / (A w^2 - g)
        near(pair.found.unwrap(), (pair.given + 2.0 * 2000.0 * AMPLITUDE) / (AMPLITUDE * square - GRAVITY), 1e-9);
        near(
            part(&pair.error.unwrap(), "stiffness"),
            2.0 * 30.0 * 2.0 * AMPLITUDE / (AMPLITUDE * square - GRAVITY),
            1e-3,
        );
    }
}

/// Needs, tables and trades name no number that is exact in them.
#[test]
fn the_page_says_which_numbers_are_exact_where() {
    let need = "no separation to 1500 rpm";
    let model = follower(with(0.5, 0.005), with(2000.0, 30.0));
    let page = common::in_one_line(&design_over_mass(&model, need).text().unwrap());
    let note = "Where mass varies, mass is exact. A number that is solved for has no error of its own.";
    assert!(page.contains(note), "{page}");
    let exact = common::in_one_line(&design_over_mass(&follower(json!(0.5), json!(2000.0)), need).text().unwrap());
    assert!(!exact.contains("exact") && !exact.contains('±'), "{exact}");
}

/// A need that takes next to nothing shows how little.
#[test]
fn a_tiny_value_that_is_needed_is_not_shown_as_nothing() {
    let [rpm, ..] = leaves(0.5, 2000.0);
    // F = m A w^2 - 2 k A - m g
    let preloaded = |preload: f64| {
        cosine(
            &json!({ "mass": 0.5, "stiffness": 2000.0, "gravity": 0.0, "preload": preload, "damping": 0.0, "restitution": 0.5 }),
        )
    };
    let omega = ((2.0 * 2000.0 * AMPLITUDE + 7e-9) / (0.5 * AMPLITUDE)).sqrt();
    let need = format!("no separation to {:?} rpm", omega * 60.0 / std::f64::consts::TAU);
    let needs = vec![(need.clone(), need.parse().unwrap())];
    let found =
        design(&preloaded(40.0), &Asked { rpm: Some([rpm; 2]), needs, ..Asked::default() }, &Unwatched).unwrap();
    let answer = found.needs.iter().find(|answer| answer.lever == Lever::Preload).unwrap();
    near(answer.value.unwrap(), 7e-9, 1e-3);
    let page = found.text().unwrap();
    let line = page.lines().find(|line| line.trim_start().starts_with("preload")).unwrap();
    assert!(line.contains("e-9 ") || line.contains("e-9\u{a0}"), "{line}");
}

/// Rounding the corners costs speed where it is narrow; the cam as it is stands above.
#[test]
fn rounded_corners_say_what_is_gained_and_lost() {
    let found = design(&model("preloaded"), &Asked { speeds: 2, ..Asked::default() }, &Unwatched).unwrap();
    let own = found.separation.speed();
    assert_eq!(found.rounded.len(), 3);
    for at in &found.rounded {
        near(at.separation_change.unwrap(), at.separation_rpm.unwrap() / own - 1.0, 1e-12);
    }
    assert!(found.rounded[0].separation_change.unwrap() < 0.0 && found.rounded[2].separation_change.unwrap() > 0.0);
    let page = found.text().unwrap();
    assert!(page.lines().any(|line| line.contains("none") && line.contains("119.8482") && line.contains("infinite")));
}

/// The follower is off the cam for no more than the whole time, and the parts of the ± say the same as the whole.
#[test]
fn time_off_the_cam_is_no_more_than_all() {
    let model = valve(&[("mass.error", 0.02), ("restitution.error", 0.1)]);
    let found = design(&model, &Asked { rpm: Some([7000.0; 2]), ..Asked::default() }, &Unwatched).unwrap();
    let loads = &found.loads[0];
    let error = loads.errors.unwrap()[2];
    near(error.total(), 1.0 - loads.off_cam, 1e-9);
    assert_eq!(loads.bounds(2).map(|[_, high]| high <= 1.0 + 1e-12), Some(true));
    let low = design(&model, &Asked { rpm: Some([2920.0; 2]), ..Asked::default() }, &Unwatched).unwrap();
    assert!((0..5).all(|index| low.loads[0].bounds(index).unwrap()[0] >= 0.0), "{:?}", low.loads[0]);
}

/// Tables of uncertain machines have the parts of each end; those of exact ones have the columns that they had.
#[test]
fn a_table_of_speeds_has_the_parts_of_each_end() {
    let table = |changes: &[&str]| {
        let range = ["speeds", "--rpm", "110:120", "--speeds", "3", "--starts", "2", "--quiet", "--out", "-"];
        common::text(common::corner_impact([&range[..], changes].concat()).stdout)
    };
    let (exact, uncertain) = (table(&[]), table(&["--set", "mass.error=0.004"]));
    let added = ",from,from_error,from_error_cam,from_error_numbers,to,to_error,to_error_cam,to_error_numbers";
    let head = |table: &str| table.lines().next().unwrap().to_owned();
    assert_eq!(head(&uncertain), head(&exact) + added);
    let first = uncertain.lines().nth(1).unwrap();
    let cells: Vec<&str> = first.rsplit(',').take(4).collect();
    let [numbers, cam, whole, to] = [0, 1, 2, 3].map(|index| cells[index].parse::<f64>().unwrap());
    near(to, 114.979327, 1e-6);
    assert_eq!((cam, numbers), (0.0, whole));
    near(whole, 114.979327 * 0.004 / 1.221, 1e-2);
}
