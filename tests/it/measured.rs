//! Is a measured cam smoothed as it should be, are its corners and dwells found, and does what is told of it hold of the true cam?

use std::f64::consts::{PI, TAU};

use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::cam::{Cam, Corner, Law, Segment, Side, apart};
use corner_impact::measured::{Measured, PlausibleCams, Remarks};
use corner_impact::model::{Model, Study};
use corner_impact::orbit::long_run::Budget;
use corner_impact::orbit::{Parameter, PeriodicOrbit, Search};
use corner_impact::progress::Unwatched;
use corner_impact::study::attractors::{Cause, Resolution, Step, Transition};
use corner_impact::study::design::contact::{Contact, Separation};
use corner_impact::study::design::needs::{Answer, Lever};
use corner_impact::study::design::{Asked, Design, SeparationPlace, design, known};
use corner_impact::study::locate::locate;
use corner_impact::study::orbit::{OrbitQuery, orbits};
use corner_impact::study::speeds::SpeedSurvey;
use corner_impact::study::survey::{Axis, Spacing, Values};
use corner_impact::study::verify::{External, Verification, verify};
use corner_impact::uncertainty::PlausibleMachines;
use corner_impact_cli::figures::corner_marks;
use corner_impact_cli::show::Paged;
use serde_json::{Value, json};

use crate::common;
use crate::design_numbers::{OWN, asked, rpm};
use crate::phantoms::Random;
use crate::snapshots;
use crate::study_numbers::resolution;

const SPLINES: &str = include_str!("../../golden/derived/smoothing_spline.json");

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().unwrap().iter().map(|text| text.as_str().unwrap().parse().unwrap()).collect()
}

/// A machine with 220 N of preload, 30 N/mm and 0.11 kg, and lifts in mm.
pub(crate) fn machine(cam: Value) -> Result<Model, String> {
    let follower = json!({ "mass": 0.11, "damping": 0, "stiffness": 30000, "gravity": 0, "rest_position": -220.0 / 30.0,
        "restitution": 0.3 });
    Model::of_document("a machine", &json!({ "follower": follower, "cam": cam })).map_err(|error| error.to_string())
}

pub(crate) fn smoothing(rows: &[(f64, f64)], more: &Value) -> Value {
    let rows: Vec<[f64; 2]> = rows.iter().map(|(angle, lift)| [*angle, *lift]).collect();
    let mut cam = json!({ "law": "table", "spline": "smoothing", "rows": rows });
    cam.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    cam
}

/// The splines of `derivations/smoothing_spline.py`, by B-splines and one dense system to 40 digits, with the largest distance
/// from a row that each of them has.
#[test]
fn smoothing_splines_are_those_of_another_way() {
    let document: Value = serde_json::from_str(SPLINES).unwrap();
    let (angles, places) = (numbers(&document["angles_deg"]), numbers(&document["places_deg"]));
    let splines = document["splines"].as_array().unwrap();
    assert_eq!(splines.len(), 5);
    for spline in splines {
        let rows: Vec<(f64, f64)> = angles.iter().copied().zip(numbers(&spline["lifts"])).collect();
        let corners = spline["corner"].as_u64().map(|row| angles[row as usize]);
        let dwells =
            spline["dwell"].as_array().map(|ends| [0, 1].map(|end| angles[ends[end].as_u64().unwrap() as usize]));
        let distance: f64 = spline["distance"].as_str().unwrap().parse().unwrap();
        // A step of 0.01 in the lifts would forbid the closest of them.
        let rows: Vec<(f64, f64)> = rows.into_iter().map(|(angle, lift)| (angle, lift + 1e-14 * angle)).collect();
        let more = json!({ "tolerance": distance, "corners_deg": corners.as_slice(), "dwells_deg": dwells.as_slice() });
        let cam = Cam::new(&machine(smoothing(&rows, &more)).unwrap()).unwrap();
        for (place, at) in places.iter().zip(spline["at"].as_array().unwrap()) {
            let (found, at) = (cam.lift(place.to_radians()), numbers(at));
            assert_abs_diff_eq!(found.value, at[0], epsilon = 1e-9);
            assert_abs_diff_eq!(found.slope, at[1], epsilon = 1e-8);
            assert_abs_diff_eq!(found.curvature, at[2], epsilon = 1e-7);
        }
        let orders: Vec<usize> =
            cam.corners().iter().map(|corner| corner.jump_order).filter(|order| *order < 5).collect();
        assert_eq!(orders, [vec![2; corners.iter().count()], vec![3; 2 * dwells.iter().count()]].concat());
        assert_eq!(
            cam.segments().iter().filter(|segment| matches!(segment.law, Law::Dwell(_))).count(),
            dwells.iter().count()
        );
    }
}

/// A rise of 10 mm and its return, at rest for `low` degrees before and for `top` in between.
fn program(motion: &str, span: f64, low: f64, top: f64) -> Value {
    let mut segments = vec![
        json!({ "motion": "dwell", "span_deg": low }),
        json!({ "motion": motion, "span_deg": span, "rise": 10 }),
        json!({ "motion": "dwell", "span_deg": top }),
        json!({ "motion": motion, "span_deg": span, "rise": -10 }),
        json!({ "motion": "dwell", "span_deg": 360.0 - low - top - 2.0 * span }),
    ];
    segments.retain(|segment| segment["span_deg"] != json!(0.0));
    json!({ "law": "program", "base": 0, "segment": segments })
}

/// 360 rows of a cam, rounded to so many places.
fn rounded(cam: &Cam, places: i32) -> Vec<(f64, f64)> {
    shifted(cam, places, 0.0)
}

/// The same of the cam turned by so many degrees.
fn shifted(cam: &Cam, places: i32, by: f64) -> Vec<(f64, f64)> {
    let power = 10.0_f64.powi(places);
    let lift = |angle: u32| cam.lift((f64::from(angle) + by).rem_euclid(360.0).to_radians()).value;
    (0..360).map(|angle| (f64::from(angle), (lift(angle) * power).round() / power)).collect()
}

/// Rows that fall on other angles, with other noise and with the ends of dwells elsewhere between them: of 54 tables two are farther
/// off than they say, by less than half.
#[test]
#[ignore = "slow"]
fn separation_does_not_hang_on_where_the_rows_fall() {
    let (mut outside, mut part) = (0, 0.0);
    for motion in ["cycloidal", "modified-sine", "poly345"] {
        let truth = machine(program(motion, 90.0, 60.0, 60.0)).unwrap();
        let cam = Cam::new(&truth).unwrap();
        let leaves = first(&truth, &cam);
        for places in [2, 3, 4] {
            for by in [0.0, 0.1, 0.25, 0.5, 0.7, 0.85] {
                let (found, error) = separation(smoothing(&shifted(&cam, places, by), &json!({})));
                let off = (found - leaves).abs() / error;
                assert!(off < 1.5, "{motion} to {places} places, turned by {by}: {found} ± {error}, not {leaves}");
                outside += usize::from(off > 1.0);
                part += error / leaves / 54.0;
            }
        }
    }
    assert!(outside <= 2 && part < 0.0085, "{outside} outside, ± {part} on average");
}

/// The loads of tables are within their ± of those of the exact cam, right above the separation as well, where a cam that separates a
/// little later has none at all.
#[test]
#[ignore = "slow"]
fn loads_are_within_their_error() {
    let asked = Asked { rpm: Some([3600.0, 6000.0]), speeds: 13, ..Asked::default() };
    let (mut outside, mut count) = (0, 0);
    for motion in ["cycloidal", "modified-sine", "poly345"] {
        let truth = machine(program(motion, 90.0, 60.0, 60.0)).unwrap();
        let cam = Cam::new(&truth).unwrap();
        let exact = design(&truth, &asked, &Unwatched).unwrap();
        assert!(exact.loads.iter().all(|loads| loads.errors.is_none()));
        for places in [2, 3] {
            let found = machine(smoothing(&rounded(&cam, places), &json!({}))).unwrap();
            let found = design(&found, &asked, &Unwatched).unwrap();
            for loads in &found.loads {
                // Where the exact cam does not separate it has no load but the force.
                let truth = exact.loads.iter().find(|truth| truth.place == loads.place).map(|truth| truth.numbers());
                let told = if truth.is_some() { 5 } else { 4 };
                let numbers = loads
                    .numbers()
                    .into_iter()
                    .zip(truth.unwrap_or_default())
                    .zip(loads.errors.unwrap().map(|it| it.total()));
                for ((found, truth), error) in numbers.take(told) {
                    let off = (found - truth).abs();
                    assert!(
                        off < 1.3 * error,
                        "{motion}, {places}, {}: {found} ± {error}, not {truth}",
                        loads.place.rpm
                    );
                    (outside, count) = (outside + usize::from(off > error), count + 1);
                    // Far above the separation they are known well.
                    assert!(loads.place.rpm < 5400.0 || error < 0.25 * found, "{motion}, {places}: {found} ± {error}");
                }
            }
        }
    }
    assert!(count > 250 && outside <= 2, "{outside} of {count}");
}

/// A dwell that was given where the rows rise is remarked on with where the cam is off, and one where they stay is not.
#[test]
fn a_dwell_that_the_rows_contradict_is_told() {
    let folder = tempfile::tempdir().unwrap();
    crate::common::program(["new", "valve.toml", "--law", "table"]).current_dir(folder.path()).output().unwrap();
    let file = folder.path().join("valve.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    for (dwell, is_told) in [("[[60.0, 100.0]]", true), ("[[196.0, 48.0]]", false)] {
        let given = text.replace("tolerance = \"auto\"", &format!("dwells_deg = {dwell}"));
        assert_ne!(given, text);
        std::fs::write(&file, given).unwrap();
        let output = crate::common::program(["cam", "valve.toml"]).current_dir(folder.path()).output().unwrap();
        let notes = crate::common::text(output.stderr);
        assert_eq!(notes.contains("cam.dwells_deg: the rows contradict it: at "), is_told, "{notes}");
        assert_eq!(notes.contains(" deg the cam is ") && notes.contains(" mm from them"), is_told, "{notes}");
    }
}

/// The speed at which the follower first leaves a cam, rpm.
fn first(model: &Model, cam: &Cam) -> f64 {
    Contact::new(cam, model.follower).separation().speed()
}

/// Where the follower first leaves the cam, and how far that may be off.
fn separation(cam: Value) -> (f64, f64) {
    let model = machine(cam).unwrap();
    let found = first(&model, &Cam::new(&model).unwrap());
    let likely = PlausibleCams::of(&model).unwrap().unwrap();
    let error = likely.errors(&[found], |model, cam| Some(vec![first(model, cam)])).unwrap()[0];
    (found, error)
}

/// Rows with errors without a pattern, of up to a hundredth of a millimetre.
fn with_errors(rows: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let error = |row: usize| 0.01 * (2.0 * (1e4 * (1.0 + row as f64).sin()).rem_euclid(1.0) - 1.0);
    rows.iter().enumerate().map(|(row, (angle, lift))| (*angle, lift + error(row))).collect()
}

/// Without preload and weight, errors of rows at the ends of a dwell decide where the follower leaves first. With a preload they do not, and
/// rounded rows have none there: their dwell is flat.
#[test]
fn a_separation_that_errors_of_rows_decide_is_told() {
    let exact = Cam::new(&machine(program("cycloidal", 90.0, 60.0, 60.0)).unwrap()).unwrap();
    let rows = rounded(&exact, 3);
    let noisy = with_errors(&rows);
    for (rows, preload, is_told) in [(&noisy, 0.0, true), (&noisy, 50.0, false), (&rows, 0.0, false)] {
        let mut model = machine(smoothing(rows, &json!({}))).unwrap();
        let lowest = Cam::new(&model).unwrap().lowest().value;
        model.follower.rest_position = lowest - preload / 30.0;
        let found = design(&model, &Asked::default(), &Unwatched).unwrap();
        let page = common::in_one_line(&found.text().unwrap());
        assert_eq!(page.contains("errors of the rows may decide the speed"), is_told, "{preload}: {page}");
        assert_eq!(serde_json::to_value(&found).unwrap()["separation"]["within_errors"], is_told);
    }
}

/// On a lever an error of a row moves the follower by the error times its ratio, and the spring's force by as much times the stiffness.
#[test]
fn errors_of_rows_decide_a_separation_as_much_as_a_lever_makes_of_them() {
    let exact = Cam::new(&machine(program("cycloidal", 90.0, 60.0, 60.0)).unwrap()).unwrap();
    let rows = with_errors(&rounded(&exact, 3));
    for (ratio, times, is_told) in [(2.0, 1.5, true), (2.0, 4.0, false), (0.5, 1.0, false)] {
        let mut model = machine(smoothing(&rows, &json!({ "lever_ratio": ratio }))).unwrap();
        let cam = Cam::new(&model).unwrap();
        let error = PlausibleCams::of(&model).unwrap().unwrap().measured.row_error();
        // The least force is so many times what the stiffness makes of the error of a row itself.
        model.follower.rest_position = cam.lowest().value - times * error;
        let machines = PlausibleMachines::of(&model, &cam).unwrap();
        let (found, _) = known(Contact::new(&cam, model.follower).separation(), &machines);
        let Separation::At { within_errors, .. } = found else { panic!("{found:?}") };
        assert_eq!(within_errors, is_told, "{ratio} {times}");
    }
}

/// Cams that all leave at 3285.37 rpm, each in three roundings: the smoothed ones leave there within what they say, the cubic
/// splines within what is said of them, and the roundest of these by less than half of that speed.
#[test]
#[ignore = "slow"]
fn separation_is_known_to_within_what_is_said() {
    for (motion, span, top) in [
        ("cycloidal", 74.0201, 0.0),
        ("poly345", 70.399, 40.3),
        ("modified-trapezoid", 69.0684, 0.0),
        ("harmonic", 63.689, 40.3),
    ] {
        let truth = machine(program(motion, span, 13.71, top)).unwrap();
        let cam = Cam::new(&truth).unwrap();
        let leaves = first(&truth, &cam);
        assert_abs_diff_eq!(leaves, 3285.37, epsilon = 0.02);
        let angle = |model: &Model| {
            let cam = Cam::new(model).unwrap();
            let separation = Contact::new(&cam, model.follower).separation();
            let (found, _) = known(separation, &PlausibleMachines::of(model, &cam).unwrap());
            let Separation::At { cam_angle, angle_error, .. } = found else { panic!("{motion}: {found:?}") };
            (cam_angle, angle_error)
        };
        let (leaves_at, exact) = angle(&truth);
        assert_eq!(exact, None);
        // A corner that the rounding hides is rounded off.
        let more = if motion == "harmonic" { 2.0 } else { 1.0 };
        for (places, most) in [(4, 0.01 * more), (3, 0.03 * more), (2, 0.09 * more)] {
            let table = smoothing(&rounded(&cam, places), &json!({}));
            let (at, error) = angle(&machine(table.clone()).unwrap());
            let error = error.unwrap();
            // Two flanks that are alike let it go at two places, of which the rows may tell either: that far off it is said to be.
            assert!(
                (at - leaves_at).abs() <= error,
                "{motion} to {places} places: {at} ± {error} rad, not {leaves_at}"
            );
            let (found, error) = separation(table);
            assert!((found - leaves).abs() <= error, "{motion} to {places} places: {found} ± {error}");
            assert!(error <= most * leaves, "{motion} to {places} places: ± {error}");
        }
        let mut through = smoothing(&rounded(&cam, 3), &json!({}));
        through["spline"] = json!("cubic");
        let (found, error) = separation(through.clone());
        assert!(leaves - found > 0.01 * leaves && leaves - found <= error, "{motion}, cubic: {found} ± {error}");
        through["rows"] = smoothing(&rounded(&cam, 2), &json!({}))["rows"].clone();
        let model = machine(through).unwrap();
        let found = first(&model, &Cam::new(&model).unwrap());
        assert!(found < 0.6 * leaves, "{motion}, cubic: {found}");
    }
}

#[test]
#[ignore = "slow"]
fn corners_and_dwells_are_found() {
    let measured = |motion: &str, span: f64, places: i32, more: &Value| {
        let cam = Cam::new(&machine(program(motion, span, 13.71, 40.3)).unwrap()).unwrap();
        let model = machine(smoothing(&rounded(&cam, places), more)).unwrap();
        (PlausibleCams::of(&model).unwrap().unwrap().measured, Cam::new(&model).unwrap())
    };
    // Harmonic motion begins and ends with an acceleration.
    let (told, cam) = measured("harmonic", 63.689, 6, &json!({}));
    let corners = [13.71, 77.399, 117.699, 181.388];
    assert_eq!(told.corners_deg.len(), 4);
    for (found, corner) in told.corners_deg.iter().zip(corners) {
        assert_abs_diff_eq!(*found, corner, epsilon = 0.01);
    }
    assert_eq!(told.dwells_deg.len(), 2);
    assert!(told.corners_are_found && told.dwells_are_found && told.is_noisy && told.is_smoothed);
    let orders = cam.corners();
    let jumps: Vec<f64> = orders.iter().filter(|corner| corner.jump_order == 2).map(|corner| corner.jump).collect();
    assert_eq!(jumps.len(), 4);
    for (jump, sign) in jumps.iter().zip([1.0, 1.0, -1.0, -1.0]) {
        // pi^2/2 of the rise over the span squared.
        assert_abs_diff_eq!(*jump, sign * 39.94, epsilon = 0.2);
    }
    // Others do not, and their dwells end inside of where they do, the later the coarser the lifts.
    for motion in ["cycloidal", "poly345", "modified-sine", "modified-trapezoid", "poly4567"] {
        for places in [4, 3, 2] {
            let (told, _) = measured(motion, 70.0, places, &json!({}));
            assert!(told.corners_deg.is_empty(), "{motion}, {places}: {:?}", told.corners_deg);
            let dwells = [[83.71, 124.01], [194.01, 373.71]];
            assert_eq!(told.dwells_deg.len(), 2, "{motion}, {places}");
            for (found, dwell) in told.dwells_deg.iter().zip(dwells) {
                let late = [found[0] - dwell[0], dwell[1] - found[1]];
                assert!(late.iter().all(|late| (-6.0..4.0).contains(late)), "{motion}, {places}: {found:?}");
            }
        }
    }
    // A slow cam's top is no dwell.
    let rows: Vec<(f64, f64)> =
        (0..360).map(|k| (f64::from(k), (500.0 * (1.0 - f64::from(k).to_radians().cos())).round() / 100.0)).collect();
    let told = PlausibleCams::of(&machine(smoothing(&rows, &json!({}))).unwrap()).unwrap().unwrap().measured;
    assert!(told.corners_deg.is_empty() && told.dwells_deg.is_empty(), "{told:?}");
    assert_eq!((told.step_m, told.is_rounded()), (Some(0.01), true));
    // What is given is taken, and nothing else.
    let (told, cam) =
        measured("harmonic", 63.689, 3, &json!({ "corners_deg": [77.4, -242.3], "dwells_deg": [[182, 13]] }));
    assert!(!told.corners_are_found && !told.dwells_are_found);
    assert_abs_diff_eq!(told.corners_deg.as_slice(), [77.4, 117.7].as_slice(), epsilon = 1e-9);
    assert_abs_diff_eq!(told.dwells_deg[0].as_slice(), [182.0, 373.0].as_slice(), epsilon = 1e-9);
    let orders: Vec<usize> = cam.corners().iter().map(|corner| corner.jump_order).filter(|order| *order < 5).collect();
    assert_eq!(orders, [3, 2, 2, 3]);
}

/// Rows of a cam with this second derivative, less its mean, mm/rad^2, at an angle in degrees.
fn bent(count: u32, second: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    const PARTS: u32 = 64;
    let step = TAU / f64::from(count * PARTS);
    let second: Vec<f64> =
        (0..count * PARTS).map(|part| second((f64::from(part) + 0.5) / f64::from(PARTS * count) * 360.0)).collect();
    let mean = second.iter().sum::<f64>() / second.len() as f64;
    let (mut slope, mut lift, mut lifts) = (0.0, 0.0, Vec::new());
    for second in &second {
        lifts.push(lift);
        lift += step * (slope + 0.5 * step * (second - mean));
        slope += step * (second - mean);
    }
    let rise = lift / second.len() as f64;
    let row = |row: u32| {
        let part = row * PARTS;
        (360.0 * f64::from(row) / f64::from(count), lifts[part as usize] - rise * f64::from(part))
    };
    (0..count).map(row).collect()
}

/// A second derivative that is one number from each of these angles, degrees, on.
fn stepped(steps: &[(f64, f64)]) -> impl Fn(f64) -> f64 {
    move |angle| steps.iter().rev().find(|(from, _)| *from <= angle).map_or(0.0, |(_, second)| *second)
}

/// Where a cam's acceleration jumps, degrees.
fn jumps(rows: &[(f64, f64)]) -> Vec<f64> {
    let cam = Cam::new(&machine(smoothing(rows, &json!({}))).unwrap()).unwrap();
    let jumps = cam.corners().iter().filter(|corner| corner.jump_order == 2);
    jumps.map(|corner| corner.angle.to_degrees()).collect()
}

/// Two jumps of the acceleration within a row are nearly one, which is told; of two that are far from one on so many rows neither is.
#[test]
fn corners_that_hide_each_other_are_not_told() {
    for (apart, first, is_told) in [(2.0, 0.5, true), (7.0, 0.3, false)] {
        let second =
            [(0.0, 1.0), (40.7, -1.0), (110.3, 1.0 - first), (110.3 + apart, 1.0), (200.9, -1.0), (290.1, 1.0)];
        let found = jumps(&bent(180, stepped(&second)));
        let mut expected = vec![40.7, 111.0, 200.9, 290.1];
        if !is_told {
            expected.remove(1);
        }
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (found, expected) in found.iter().zip(expected) {
            assert_abs_diff_eq!(*found, expected, epsilon = 0.5);
        }
    }
}

/// A jump that is less than a fifth of the largest acceleration is none, however plain it is.
#[test]
fn a_small_jump_is_no_corner() {
    for (before, is_told) in [(0.8, false), (0.6, true)] {
        let found = jumps(&bent(180, stepped(&[(0.0, -1.0), (130.3, before), (200.9, 1.0), (270.1, -1.0)])));
        assert_eq!(found.len(), if is_told { 3 } else { 2 }, "{found:?}");
    }
}

/// An acceleration that rises and falls, with bends but without a jump, has no corner.
#[test]
fn a_bent_acceleration_is_no_corner() {
    let near = |angle: f64| {
        let x = (angle - 180.0) / 45.0;
        let bends = -1.2781 * f64::max(x + 0.1751, 0.0) + 1.9632 * f64::max(x - 0.0873, 0.0);
        -0.2399 - 0.7311 * x - 0.3918 * x * x + bends
    };
    let second = |angle: f64| {
        let beyond = if angle < 112.5 { angle + 360.0 } else { angle };
        let (from, to, level) = (near(247.5), near(112.5), 0.644);
        match beyond {
            ..=247.5 => near(beyond),
            ..=307.5 => from + (level - from) * (beyond - 247.5) / 60.0,
            ..=432.5 => level,
            _ => level + (to - level) * (beyond - 432.5) / 40.0,
        }
    };
    assert_eq!(jumps(&bent(96, second)), [0.0; 0]);
}

/// Six rows at one lift are a dwell, if what noise may hide there is little.
#[test]
fn six_rows_at_one_lift_are_a_dwell() {
    let segments = [("poly345", 80.0, 10.0), ("dwell", 15.0, 0.0), ("poly345", 80.0, -10.0), ("dwell", 185.0, 0.0)];
    let segments = segments.map(|(motion, span, rise)| match motion {
        "dwell" => json!({ "motion": motion, "span_deg": span }),
        _ => json!({ "motion": motion, "span_deg": span, "rise": rise }),
    });
    let truth = Cam::new(&machine(json!({ "law": "program", "base": 0, "segment": segments })).unwrap()).unwrap();
    // From a row at 120 degrees to one at 135.
    let lift = |angle: f64| truth.lift((angle - 40.0).rem_euclid(360.0).to_radians()).value;
    let rows: Vec<(f64, f64)> = (0..120).map(|row| 3.0 * f64::from(row)).map(|angle| (angle, lift(angle))).collect();
    let cam = Cam::new(&machine(smoothing(&rows, &json!({}))).unwrap()).unwrap();
    let dwells = cam.segments().iter().filter(|segment| matches!(segment.law, Law::Dwell(_)));
    let within = |dwell: &&Segment| 120_f64.to_radians() <= dwell.start && dwell.end <= 135_f64.to_radians();
    assert_eq!(dwells.filter(within).count(), 1);
}

/// Corners, doubtful corners and dwells, in degrees.
fn features(found: &Measured) -> String {
    let doubtful = found.doubtful_corners.as_ref().map_or(&[][..], |doubtful| &doubtful.at_deg);
    let degrees = |all: &[f64]| all.iter().map(|angle| format!(" {angle:.4}")).collect::<String>();
    let [corners, doubtful, dwells] = [&found.corners_deg, doubtful, found.dwells_deg.as_flattened()].map(degrees);
    format!("corners{corners}, doubtful{doubtful}, dwells{dwells}")
}

/// Corners and dwells that are found in rows of known cams with noise, some of them with an eccentric base circle. A dwell that is found is
/// inside of one that is there, to within a row.
#[test]
#[ignore = "slow"]
fn corners_and_dwells_of_tables_are_where_they_were() {
    let cams = [
        ("cycloidal", 90.0, 60.0, 60.0),
        ("harmonic", 80.0, 100.0, 20.0),
        ("poly345", 60.0, 120.0, 12.0),
        ("modified-sine", 100.0, 30.0, 90.0),
    ];
    // Rows, places, first angle, noise in mm.
    let tables =
        [(360, 2, 0.0, 0.01), (360, 3, 0.3, 0.0), (180, 3, 0.0, 0.005), (120, 3, 0.7, 0.002), (720, 4, 0.1, 0.005)];
    let mut random = Random(1);
    let mut told = String::new();
    for (which, (motion, span, low, top)) in cams.into_iter().enumerate() {
        let exact = Cam::new(&machine(program(motion, span, low, top)).unwrap()).unwrap();
        let rests = [[low + 2.0 * span + top - 360.0, low], [low + span, low + span + top]];
        for (table, (count, places, by, noise)) in tables.into_iter().enumerate() {
            let eccentricity = [0.0, 0.02, 0.3][(which + table) % 3];
            let gap = 360.0 / f64::from(count);
            let row = |index: i32| {
                let angle = f64::from(index) * gap + by;
                let lift = exact.lift(angle.to_radians()).value + eccentricity * (1.0 + angle.to_radians().sin());
                let lift = lift + noise * random.normal();
                (angle, (lift * 10.0_f64.powi(places)).round() / 10.0_f64.powi(places))
            };
            let rows: Vec<_> = (0..count).map(row).collect();
            let model = machine(smoothing(&rows, &json!({}))).unwrap();
            let found = PlausibleCams::of(&model).unwrap().unwrap().measured;
            for [from, to] in &found.dwells_deg {
                let is_inside = |[start, end]: &[f64; 2]| {
                    let from = start + (from - start + 180.0).rem_euclid(360.0) - 180.0;
                    start - gap <= from && from + (to - from).rem_euclid(360.0) <= end + gap
                };
                assert!(rests.iter().any(is_inside), "{motion} {count} {places} {by} {eccentricity}: {from} {to}");
            }
            told += &format!(
                "{motion}, {eccentricity} mm eccentric, {count} rows from {by} to {places} places with {noise} mm: {}\n",
                features(&found)
            );
        }
    }
    snapshots::settings().bind(|| insta::assert_snapshot!("features", told));
}

/// Corners and dwells of a hundred random tables: coarse, uneven, noisy, without a dwell, or with corners or dwells that the model gives.
#[test]
#[ignore = "slow"]
fn corners_and_dwells_of_random_tables_are_where_they_were() {
    let mut random = Random(2);
    let mut told = String::new();
    for table in 0..100 {
        let motion = random.one_of(&["cycloidal", "harmonic", "poly345", "parabolic"]);
        let top = if random.is(0.4) { 0.0 } else { random.within(5.0, 90.0) };
        let span = random.within(30.0, 0.5 * (340.0 - top));
        let low = random.within(5.0, 355.0 - top - 2.0 * span);
        let exact = Cam::new(&machine(program(motion, span, low, top)).unwrap()).unwrap();
        let count = random.one_of(&[24, 36, 48, 60, 72, 90, 120, 120, 180, 180]);
        let noise = random.one_of(&[0.0, 0.0, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05]);
        let eccentricity = random.one_of(&[0.0, 0.0, 0.005, 0.02, 0.1, 0.3]);
        let power = 10.0_f64.powi(random.one_of(&[2, 3, 4, 6]));
        let (gap, uneven) = (360.0 / f64::from(count), if random.is(0.2) { 0.3 } else { 0.0 });
        let rows: Vec<(f64, f64)> = (0..count)
            .map(|row| {
                let angle = gap * (f64::from(row) + 0.4 + uneven * random.within(-1.0, 1.0));
                let lift = exact.lift(angle.to_radians()).value + eccentricity * (1.0 + angle.to_radians().sin());
                (angle, ((lift + noise * random.normal()) * power).round() / power)
            })
            .collect();
        let from = random.within(0.0, 300.0);
        let more = match table % 10 {
            0 => json!({ "corners_deg": [from, from + 30.0] }),
            5 => json!({ "dwells_deg": [[from, from + 20.0]] }),
            _ => json!({}),
        };
        let found = machine(smoothing(&rows, &more)).and_then(|model| {
            let found = PlausibleCams::of(&model).map_err(|error| error.to_string())?;
            found.ok_or_else(|| "nothing is uncertain".to_owned())
        });
        let found = found.map_or_else(|words| words, |found| features(&found.measured));
        told += &format!("{table}: {found}\n");
    }
    snapshots::settings().bind(|| insta::assert_snapshot!("features-of-random-tables", told));
}

/// Two stretches of rest with a short ramp between them are two dwells, however near they are: their lifts differ by more than the noise.
#[test]
fn dwells_at_two_lifts_are_not_one() {
    let exact = Cam::new(&machine(program("cycloidal", 80.0, 90.0, 0.0)).unwrap()).unwrap();
    let step = |degrees: f64| 0.01 * 0.5 * (1.0 - (PI * (degrees / 8.0).clamp(0.0, 1.0)).cos());
    let lift = |angle: f64| exact.lift(angle.to_radians()).value + step(angle - 10.0) - step(angle - 40.0);
    let rows: Vec<_> = (0..360).map(f64::from).map(|angle| (angle, (lift(angle) * 1000.0).round() / 1000.0)).collect();
    let told = PlausibleCams::of(&machine(smoothing(&rows, &json!({}))).unwrap()).unwrap().unwrap().measured;
    assert_eq!((told.dwells_deg.len(), told.corners_deg.len()), (3, 0), "{told:?}");
}

/// Beside one dwell two rows are enough for a cam.
#[test]
fn two_rows_beside_a_dwell_are_enough() {
    // A step of 1 in the lifts would forbid the tolerance.
    let lift = |angle: f64| if angle > 285.0 { 1.0 } else { 1e-14 * angle };
    let rows: Vec<(f64, f64)> = (0..12).map(|row| 30.0 * f64::from(row)).map(|angle| (angle, lift(angle))).collect();
    let of = |dwell: [f64; 2]| {
        machine(smoothing(&rows, &json!({ "tolerance": 0.1, "dwells_deg": [dwell], "corners_deg": [] })))
            .and_then(|model| Cam::new(&model).map_err(|error| error.to_string()))
    };
    let cam = of([0.0, 270.0]).unwrap();
    for (angle, lift) in [(0.0, 0.0), (135.0, 0.0), (300.0, 1.0), (330.0, 1.0)] {
        assert_abs_diff_eq!(cam.lift(f64::to_radians(angle)).value, lift, epsilon = 0.1 + 1e-9);
    }
    assert!(of([0.0, 300.0]).unwrap_err().contains("leaves fewer than three rows"));
}

/// A row is a ten-thousandth of a degree behind a corner that is given: the spline is as far from it as is told.
#[test]
fn a_row_beside_a_corner_is_as_far_from_the_cam_as_is_told() {
    let cam = Cam::new(&machine(program("harmonic", 80.0, 60.0, 60.0)).unwrap()).unwrap();
    let mut rows = rounded(&cam, 9);
    rows[100].1 += 0.05;
    let given = json!({ "tolerance": 0.02, "corners_deg": [99.9995], "dwells_deg": [] });
    let model = machine(smoothing(&rows, &given)).unwrap();
    let cam = Cam::new(&model).unwrap();
    let off = rows.iter().map(|(angle, lift)| (lift - cam.lift(angle.to_radians()).value).abs());
    assert_abs_diff_eq!(off.fold(0.0, f64::max), 0.02, epsilon = 1e-9);
}

/// A table whose angles count from elsewhere has the same corners and dwells, wherever angle 0 is: where it is between a corner as it is first found
/// and where the spline is best as well.
#[test]
#[ignore = "slow"]
fn corners_and_dwells_turn_through_angle_0() {
    let cam = Cam::new(&machine(program("harmonic", 63.689, 13.71, 40.3)).unwrap()).unwrap();
    let rows: Vec<(f64, f64)> = rounded(&cam, 2).into_iter().step_by(3).collect();
    let features = |from: f64| {
        let mut turned: Vec<(f64, f64)> =
            rows.iter().map(|(angle, lift)| ((angle - from).rem_euclid(360.0), *lift)).collect();
        turned.sort_by(|one, two| one.0.total_cmp(&two.0));
        let cam = Cam::new(&machine(smoothing(&turned, &json!({}))).unwrap()).unwrap();
        let mut corners: Vec<f64> = cam
            .corners()
            .iter()
            .filter(|corner| corner.jump_order < 5)
            .map(|corner| (corner.angle.to_degrees() + from).rem_euclid(360.0))
            .collect();
        corners.sort_by(f64::total_cmp);
        corners
    };
    let expected = features(50.0);
    assert_eq!(expected.len(), 4);
    for corner in &expected {
        for off in -5..=5 {
            let from = corner + 0.2 * f64::from(off);
            let found = features(from);
            assert_eq!(found.len(), expected.len(), "{from}: {found:?}, not {expected:?}");
            for (found, expected) in found.iter().zip(&expected) {
                assert_abs_diff_eq!(*found, *expected, epsilon = 0.05);
            }
        }
    }
}

/// Corners, dwells and lifts of tables of every kind, as they were when the slower tests held them against the cams that the rows are of: coarse,
/// rounded, noisy, uneven, many, turned so that a dwell and a corner lie on either side of angle 0, and with what a model may give.
#[test]
#[ignore = "slow"]
fn what_rows_become_is_what_it_was() {
    let cam = |motion: &str, span: f64| Cam::new(&machine(program(motion, span, 13.71, 40.3)).unwrap()).unwrap();
    let (sudden, smooth) = (cam("harmonic", 63.689), cam("cycloidal", 70.0));
    let cosines = |second: f64, phase: f64| {
        let law = json!({ "law": "harmonic", "offset": 5.0, "amplitudes": [-5.0, second], "phases_deg": [0.0, phase] });
        Cam::new(&machine(law).unwrap()).unwrap()
    };
    let (waves, flat) = (cosines(0.3, 20.0), cosines(1.0, 0.0));
    let rows = |cam: &Cam, count: u32, by: f64, places: i32, noise: f64| -> Vec<(f64, f64)> {
        let power = 10.0_f64.powi(places);
        let row = |index: u32| {
            let angle = 360.0 * f64::from(index) / f64::from(count);
            let lift = cam.lift((angle + by).rem_euclid(360.0).to_radians()).value;
            let noisy = lift + noise * (977.0 * f64::from(index + 1).sin()).sin();
            (angle, (noisy * power).round() / power)
        };
        (0..count).map(row).collect()
    };
    let uneven = |mut rows: Vec<(f64, f64)>| {
        let mut index = 0;
        rows.retain(|_| {
            index += 1;
            index % 7 != 3 && index % 11 != 5
        });
        rows
    };
    let none = json!({});
    let tables = [
        ("sudden", rows(&sudden, 180, 0.0, 6, 0.0), none.clone()),
        ("sudden, turned", rows(&sudden, 180, 100.0, 6, 0.0), none.clone()),
        ("sudden, corner at 0", rows(&sudden, 120, 77.0, 5, 0.0), none.clone()),
        ("sudden, corner before 0", rows(&sudden, 120, 77.5, 5, 0.0), none.clone()),
        ("sudden, coarse", rows(&sudden, 90, 0.0, 3, 0.0), none.clone()),
        ("sudden, noisy", rows(&sudden, 240, 31.0, 9, 0.001), none.clone()),
        ("sudden, uneven", uneven(rows(&sudden, 240, 0.0, 5, 0.0)), none.clone()),
        ("sudden, 1100 rows", rows(&sudden, 1100, 0.0, 5, 0.0), none.clone()),
        ("sudden, 40 rows", rows(&sudden, 40, 0.0, 5, 0.0), none.clone()),
        ("smooth", rows(&smooth, 180, 0.0, 3, 0.0), none.clone()),
        ("smooth, turned", rows(&smooth, 150, 200.0, 2, 0.0), none.clone()),
        ("smooth, noisy", rows(&smooth, 180, 0.0, 9, 0.01), none.clone()),
        ("no dwell", rows(&waves, 90, 0.0, 2, 0.0), none.clone()),
        ("hardly a dwell", rows(&flat, 360, 0.0, 2, 0.0), none.clone()),
        ("hardly a dwell, turned", rows(&flat, 360, 320.0, 2, 0.0), none.clone()),
        ("no dwell, noisy", rows(&waves, 90, 0.0, 9, 0.02), none.clone()),
        ("corners given", rows(&sudden, 120, 0.0, 3, 0.0), json!({ "corners_deg": [77.4, -242.3] })),
        ("dwells given", rows(&sudden, 120, 0.0, 3, 0.0), json!({ "dwells_deg": [[182, 13]] })),
        ("both given", rows(&sudden, 120, 0.0, 3, 0.0), json!({ "corners_deg": [77.4], "dwells_deg": [[182, 13]] })),
        ("tolerance given", rows(&smooth, 120, 0.0, 3, 0.0), json!({ "tolerance": 0.002 })),
    ];
    let mut became = String::new();
    for (name, rows, more) in tables {
        let model = machine(smoothing(&rows, &more)).unwrap();
        let cam = Cam::new(&model).unwrap_or_else(|error| panic!("{name}: {error}"));
        let degrees = |angle: f64| format!("{:.4}", angle.to_degrees());
        let corners = cam.corners().iter().filter(|corner| corner.jump_order < 5);
        let corner = |at: &Corner| format!("{} by {:.4e} of order {}", degrees(at.angle), at.jump, at.jump_order);
        let dwells = cam.segments().iter().filter(|segment| matches!(segment.law, Law::Dwell(_)));
        let dwell = |dwell: &Segment| format!("{} to {}", degrees(dwell.start), degrees(dwell.end));
        let lift = |place: u32| format!("{:.3}", cam.lift(0.7 * f64::from(place)).value * 1e6);
        let list = |of: Vec<String>| of.join(", ");
        let [corners, dwells] = [list(corners.map(corner).collect()), list(dwells.map(dwell).collect())];
        let lifts = list((0..9).map(lift).collect());
        became += &format!("{name}\n  corners: {corners}\n  dwells: {dwells}\n  lifts, 1e-6: {lifts}\n");
        if name.ends_with("noisy") {
            let told = PlausibleCams::of(&model).unwrap().unwrap().measured;
            let corners = list(told.corners_deg.iter().map(|corner| format!("{corner:.4}")).collect());
            became += &format!(
                "  noise: {:.7e}, at most {:.7e} from a row\n  corners: {corners}\n  curvature: {:.7e} ± {:.4e}\n",
                told.noise_m, told.largest_distance_m, told.largest_curvature, told.curvature_error
            );
        }
    }
    snapshots::settings().bind(|| insta::assert_snapshot!("rows", became));
}

/// The tolerance is the largest distance from a row, and what cannot be kept is told.
#[test]
fn tolerances() {
    let cam = Cam::new(&machine(program("cycloidal", 74.0201, 100.0, 0.0)).unwrap()).unwrap();
    let rows = rounded(&cam, 3);
    let refused = |more: Value| {
        let model = machine(smoothing(&rows, &more));
        let refused = model.and_then(|model| Cam::new(&model).map_err(|error| error.to_string()).map(|_| ()));
        refused.unwrap_err()
    };
    for tolerance in [0.0005, 0.002, 0.1] {
        let model = machine(smoothing(&rows, &json!({ "tolerance": tolerance }))).unwrap();
        let cam = Cam::new(&model).unwrap();
        let distance = |(angle, lift): &(f64, f64)| (cam.lift(angle.to_radians()).value - lift).abs();
        assert_abs_diff_eq!(rows.iter().map(distance).fold(0.0, f64::max), tolerance, epsilon = 1e-6 * tolerance);
    }
    for (more, says) in [
        (json!({ "tolerance": 0.0004 }), "cam.tolerance = 0.0004: must be at least 0.0005, half of the step 0.001"),
        (json!({ "tolerance": 0 }), "must be a finite number above 0"),
        (json!({ "tolerance": "none" }), "must be one of: \"auto\""),
        (json!({ "tolerance": 20 }), "is too large: a cam of constant lift is within it"),
        (
            json!({ "tolerance": 0.001, "dwells_deg": [[60, 110]] }),
            "cannot be kept: with corners and dwells as they are a row is",
        ),
        (json!({ "dwells_deg": [[60, 110], [100, 120]] }), "has dwells that meet"),
        (json!({ "dwells_deg": [[60, 60]] }), "a dwell must be longer than 0"),
        (json!({ "dwells_deg": [[1, 359]] }), "leaves fewer than three rows"),
        (json!({ "dwells_deg": [[10, 50]], "corners_deg": [20] }), "cam.corners_deg has 20, which is inside a dwell"),
    ] {
        let refused = refused(more.clone());
        assert!(refused.contains(says), "{more}: {refused}");
    }
    let few = machine(smoothing(&rows[..360].iter().step_by(40).copied().collect::<Vec<_>>(), &json!({}))).unwrap_err();
    assert!(few.contains("has 9 different angles; 12 to 1000000 are needed"), "{few}");
}

/// The same rows as gauges, spreadsheets and programs write them are the same cam, and how they were understood is told.
#[test]
fn real_files() {
    let folder = tempfile::tempdir().unwrap();
    let lift =
        |angle: f64| (1000.0 * (5.0 - 4.0 * angle.to_radians().cos() + angle.to_radians().sin())).round() / 1000.0;
    let rows: Vec<(f64, f64)> = (0..72).map(|k| 5.0 * f64::from(k)).map(|angle| (angle, lift(angle))).collect();
    let read_bytes = |bytes: &[u8], more: &str, length: &str| {
        std::fs::write(folder.path().join("lift.csv"), bytes).unwrap();
        let file = folder.path().join("model.toml");
        let text = format!(
            "[units]\nlength = \"{length}\"\n[follower]\nmass = 1\ndamping = 0\nstiffness = 1\ngravity = 0\nrest_position = 0\n\
             restitution = 1\n[cam]\nlaw = \"table\"\nfile = \"lift.csv\"\nspline = \"cubic\"\n{more}"
        );
        std::fs::write(&file, text).unwrap();
        let model = Model::read(&file).map_err(|error| error.to_string())?;
        let reading = PlausibleCams::of(&model).unwrap().unwrap().measured.reading;
        Ok::<_, String>((Cam::new(&model).unwrap(), serde_json::to_value(reading).unwrap()))
    };
    let read = |text: &str, more: &str, length: &str| read_bytes(text.as_bytes(), more, length);
    let table = |from: usize, header: &str, parted: &str, write: &dyn Fn(f64, f64) -> [String; 2]| {
        let turned = rows.iter().cycle().skip(from).take(rows.len());
        let lines: Vec<String> = turned.map(|(angle, lift)| write(*angle, *lift).join(parted) + "\n").collect();
        format!("{header}{}", lines.concat())
    };
    let plain = |angle: f64, lift: f64| [format!("{angle}"), format!("{lift}")];
    let comma = |angle: f64, lift: f64| plain(angle, lift).map(|number| number.replace('.', ","));
    let back = |angle: f64, lift: f64| plain(if angle >= 180.0 { angle - 360.0 } else { angle }, lift);
    let rad = |angle: f64, lift: f64| [format!("{:.6}", angle.to_radians()), format!("{lift}")];
    let (cam, told) = read(&table(0, "angle_deg,lift\n", ",", &plain), "", "mm").unwrap();
    let expected = json!({ "unit": "mm", "angle_unit": "deg", "separator": "comma", "decimal_comma": false, "comments": 0,
        "titles": 0, "header": "angle_deg,lift", "columns": [1, 2], "left_out": [], "rows": 72, "first_deg": 0.0, "falls": false,
        "merged": 0, "mirrored": false, "filled": 0, "repeats_first": false, "step": 0.001 });
    assert_eq!(told, expected);
    let cases: [(&str, String, &str, &str, Value); 11] = [
        ("headless", table(0, "", ",", &plain), "", "mm", json!({ "header": null })),
        (
            "semicolons",
            table(0, "angle;lift\n", ";", &comma),
            "",
            "mm",
            json!({ "separator": "semicolon", "decimal_comma": true }),
        ),
        (
            "German",
            table(0, "Winkel [Grad];Hub [mm]\n", ";", &comma),
            "",
            "m",
            json!({ "unit": "mm", "angle_unit": "deg" }),
        ),
        ("tabs", table(0, "theta\tlift\n", "\t", &plain), "", "mm", json!({ "separator": "tab" })),
        (
            "blanks",
            table(0, "phi [°]  hub [mm]\n", "  ", &comma),
            "",
            "mm",
            json!({ "separator": "blanks", "decimal_comma": true }),
        ),
        ("comments", table(0, "# gauge\n% 2\n\nangle,lift // x\n", " , ", &plain), "", "mm", json!({ "comments": 3 })),
        ("repeated", table(0, "angle,lift\n", ",", &plain) + "360,1.000\n", "", "mm", json!({ "repeats_first": true })),
        ("from -180", table(36, "angle,lift\n", ",", &back), "", "mm", json!({ "first_deg": -180.0 })),
        ("from 200", table(40, "angle,lift\n", ",", &plain), "", "mm", json!({ "first_deg": 200.0 })),
        ("in metres", table(0, "angle,lift_mm\n", ",", &plain), "", "m", json!({ "unit": "mm" })),
        ("as said", table(0, "angle,lift\n", ",", &plain), "unit = \"mm\"\n", "um", json!({ "unit": "mm" })),
    ];
    for (name, text, more, length, says) in cases {
        let (found, told) = read(&text, more, length).unwrap_or_else(|error| panic!("{name}: {error}"));
        let size = match length {
            "m" => 1e-3,
            "um" => 1e3,
            _ => 1.0,
        };
        for k in 0..100 {
            let angle = 0.0628 * f64::from(k);
            assert_abs_diff_eq!(found.lift(angle).value, size * cam.lift(angle).value, epsilon = 1e-12 * size);
        }
        for (field, value) in says.as_object().unwrap() {
            assert_eq!(&told[field], value, "{name}: {field}");
        }
    }
    // In Latin-1 a degree sign is one byte.
    let old = [b"Winkel [\xb0];Hub [mm]\n", table(0, "", ";", &comma).as_bytes()].concat();
    let (found, told) = read_bytes(&old, "", "mm").unwrap();
    assert_eq!((found.lift(1.0).value, &told["angle_unit"]), (cam.lift(1.0).value, &json!("deg")));
    // Radians to six digits, the last row a turn after the first but for what they leave out.
    let radians = table(0, "theta [rad],lift\n", ",", &rad) + "6.283185,1.0\n";
    let (found, told) = read(&radians, "angle_unit = \"rad\"\n", "mm").unwrap();
    assert_eq!((&told["angle_unit"], &told["repeats_first"]), (&json!("rad"), &json!(true)));
    assert_abs_diff_eq!(found.lift(1.0).value, cam.lift(1.0).value, epsilon = 1e-5);
    for (text, more, says) in [
        (
            radians.clone(),
            "angle_unit = \"deg\"\n",
            "cam.angle_unit = \"deg\": must be the unit in the header of the table: rad",
        ),
        (
            table(0, "angle,lift in mm\n", ",", &plain),
            "unit = \"m\"\n",
            "must be the unit in the header of the table: mm",
        ),
        (table(0, "", ",", &rad), "", "did you mean angle_unit = \"rad\" in [cam]?"),
        (
            table(0, "", ",", &plain).lines().take(37).collect::<Vec<_>>().join("\n"),
            "",
            "the rows cover 180 degrees, and a whole turn",
        ),
        (table(0, "", ";", &comma) + "\n355.5;1.5", "", "must use one decimal sign"),
        (table(0, "", ",", &plain).replace("\n10,", "\n5,"), "", "repeats the angle of the row before"),
        (table(0, "", ",", &plain).replace("\n10,", "\n1,"), "", "angles must rise"),
        (table(0, "", ",", &plain).replace("\n10,", "\n10,nan,"), "", "row = 10,nan,1.234: has 3 columns"),
        (table(0, "", ",", &plain) + "360,1.5\n", "", "must be 1, the lift at 0 on line 1"),
    ] {
        let refused = read(&text, more, "mm").unwrap_err();
        assert!(refused.contains(says), "{says}: {refused}");
    }
}

/// The paper's cam measured to a micrometre, its corners found: the corner impact and its map are the paper's to within what is said.
#[test]
#[ignore = "slow"]
fn a_measured_corner_impact() {
    let paper = crate::common::osorio();
    let measured = |places: i32, corners: Option<[f64; 2]>| {
        let (cam, power) = (crate::common::cam(&paper), 10.0_f64.powi(places));
        let row = |k: u32| [f64::from(k), (cam.lift(f64::from(k).to_radians()).value * power).round() / power];
        let rows: Vec<[f64; 2]> = (0..360).map(row).collect();
        let follower = serde_json::to_value(paper.follower).unwrap();
        let mut cam = json!({ "law": "table", "spline": "smoothing", "rows": rows });
        corners.into_iter().for_each(|corners| cam["corners_deg"] = json!(corners));
        let document = json!({ "follower": follower, "cam": cam, "study": { "rpm_min": 600, "rpm_max": 760 } });
        Model::of_document("the paper's cam", &document).unwrap()
    };
    let model = measured(6, None);
    // No certificate is of a spline near rows: it is left out, which is no disagreement.
    let found = verify(&model, External::Run).unwrap();
    let certificate = found.skipped.iter().find(|skipped| skipped.route == "certificate").unwrap();
    assert!(found.agrees && !certificate.failed, "{:?}", found.skipped);
    let truth = verify(&paper, External::LeftOut).unwrap();
    let open = found.uncertainty.as_ref().unwrap();
    let error = open.error.as_ref().unwrap();
    let (speed, map) = (error.speed.total(), error.total());
    assert!(
        (found.at.speed_rpm() - truth.at.speed_rpm()).abs() <= speed && speed < 3.0,
        "{} ± {speed}",
        found.at.speed_rpm()
    );
    for side in [Side::Minus, Side::Plus] {
        let entries = found.map.of(side).entries().into_iter().zip(truth.map.of(side).entries());
        for ((found, truth), error) in entries.zip(map.of(side).entries()) {
            assert!(
                (found - truth).abs() <= error && error <= 0.3 * truth.abs(),
                "{side}: {found} ± {error}, not {truth}"
            );
        }
    }
    // What happens there hangs on numbers that the rows leave open: what it is in truth is among what is told.
    let scenario = |found: &Verification| found.classification.as_ref().ok().map(|kind| kind.scenario);
    for (places, is_open) in [(4, true), (6, false)] {
        // So coarse a rounding leaves it doubtful that the acceleration jumps: then the model says so.
        let as_read = PlausibleCams::of(&measured(places, None)).unwrap().unwrap().measured;
        assert_eq!(as_read.doubtful_corners.is_some(), is_open);
        let model = measured(places, is_open.then_some([150.185, 209.815]));
        let found = verify(&model, External::LeftOut).unwrap();
        let verdicts = &found.uncertainty.as_ref().unwrap().verdicts;
        assert_eq!(verdicts.iter().map(|told| told.cams).sum::<usize>(), 18);
        assert!(verdicts.iter().any(|told| told.scenario == scenario(&truth)), "{verdicts:?}");
        assert_eq!(scenario(&found) != scenario(&truth), is_open);
        let file = tempfile::NamedTempFile::with_suffix(".toml").unwrap();
        std::fs::write(file.path(), model.text()).unwrap();
        let words = ["verify", file.path().to_str().unwrap(), "--no-external"];
        let page = crate::common::text(crate::common::program(words).output().unwrap().stdout);
        let page = crate::common::in_one_line(&page);
        assert_eq!(
            page.contains("not known: of 18 equally likely cams (lift rounded to 0.0001 m), "),
            is_open,
            "{page}"
        );
        assert_eq!(page.contains(" say nonsmooth-fold"), is_open, "{page}");
        assert_eq!(page.contains("the same verdict for 18 equally likely cams"), !is_open, "{page}");
    }
    let document = serde_json::to_value(&found).unwrap();
    assert_eq!(document["uncertainty"]["speed_rpm"], json!(speed));
    assert!(
        document["uncertainty"]["minus"]["A"][1][0].is_number()
            && document["uncertainty"]["measured"]["step_m"] == json!(1e-6)
    );
    let located = locate(&model, Study { rpm_min: 600.0, rpm_max: 760.0 }, 1, &Unwatched).unwrap();
    let here = located.found.iter().find(|one| one.at.corner.angle == found.at.corner.angle).unwrap();
    let error = here.speed_error.unwrap().total();
    // Knots are none of the corners that are looked at.
    let looked_at = &located.looked_at;
    assert!(looked_at.corners.iter().all(|corner| corner.jump_order < 5) && looked_at.left_out > 50, "{looked_at:?}");
    // The events of the paper's machine, to within what is said.
    let resolution = Resolution::new(common::step(20.0), 8);
    let survey = common::speeds(&model, [665.0, 755.0], &resolution, &Unwatched).unwrap();
    let ends: Vec<&Transition> = survey.attractors.iter().flat_map(|one| one.birth.iter().chain(&one.death)).collect();
    for (name, rpm) in [("corner-impact", 673.234_445), ("flip", 739.319_780)] {
        let event = ends.iter().find(|end| end.cause.name() == name).unwrap();
        let open = event.error.unwrap().total();
        assert!((event.value() - rpm).abs() <= open && open < 2.0, "{name}: {} ± {open}", event.value());
    }
    assert!((error - speed).abs() < 0.05 * speed, "{error}, not {speed}");
    // Where chaos ends and begins is known by runs, of either machine.
    let by_runs = |survey: &SpeedSurvey| -> Vec<Transition> {
        let ends = survey.attractors.iter().flat_map(|one| one.death.iter().chain(&one.birth));
        ends.filter(|end| end.cause == Cause::Runs).cloned().collect()
    };
    let exact = by_runs(&common::speeds(&paper, [665.0, 755.0], &resolution, &Unwatched).unwrap());
    let measured = by_runs(&survey);
    assert_eq!((exact.len(), measured.len()), (2, 2));
    for (end, exact) in measured.iter().zip(&exact) {
        let open = end.error.unwrap().total();
        assert!((end.value() - exact.value()).abs() <= open && open > 0.0 && open < 5.0, "{} ± {open}", end.value());
        assert_eq!(exact.error, None);
    }
}

/// Orbits of a rounded cam: those of the exact one are within what is said, of multipliers, states and impacts, where a spline goes
/// through the rows and where it goes near them; an exact cam has no ±.
#[test]
#[ignore = "slow"]
fn orbits_of_a_measured_cam_are_known_to_within_what_is_said() {
    let truth = machine(program("cycloidal", 74.0201, 13.71, 0.0)).unwrap();
    let cam = Cam::new(&truth).unwrap();
    let mut compared = 0;
    for rpm in [3500.0, 8000.0, 12000.0] {
        let find =
            |model: &Model| orbits(model, rpm, OrbitQuery::All(Search { revolutions: 1, impacts: None }), &Unwatched);
        let exact = find(&truth).unwrap();
        assert!(exact.measured.is_none() && exact.errors.is_empty());
        for spline in ["smoothing", "quintic"] {
            let mut rows = smoothing(&rounded(&cam, 4), &json!({}));
            rows["spline"] = json!(spline);
            let model = machine(rows).unwrap();
            let likely = PlausibleCams::of(&model).unwrap().unwrap();
            let found = find(&model).unwrap();
            assert_eq!(found.errors.len(), found.orbits.len());
            assert!(found.errors.iter().any(Option::is_some), "{spline} at {rpm}: {found:?}");
            for (orbit, error) in found.orbits.iter().zip(&found.errors) {
                let Some(error) = error.map(|error| error.total) else { continue };
                // Twice what any of the cams that are as likely differs by, of either multiplier and before and after an impact.
                for (model, _) in likely
                    .others
                    .iter()
                    .filter(|_| spline == "smoothing" && orbit.events.len() == orbit.impacts().count())
                {
                    let there = orbits(model, rpm, OrbitQuery::Near(orbit.state, 1), &Unwatched).unwrap();
                    for other in &there.orbits {
                        for (one, two) in other.multipliers().into_iter().zip(orbit.multipliers()) {
                            assert!(
                                2.0 * (one.re - two.re).abs() <= error.multiplier + 1e-9,
                                "{one:?} {two:?} {error:?}"
                            );
                        }
                        for (one, two) in other.impacts().zip(orbit.impacts()) {
                            let before = (one.velocity_before - two.velocity_before).abs();
                            let after = (one.velocity_after - two.velocity_after).abs();
                            assert!(2.0 * before.max(after) <= error.velocity_m_s + 1e-6, "{before} {after} {error:?}");
                        }
                    }
                }
                let angles = |orbit: &PeriodicOrbit| orbit.impacts().map(|event| event.cam_angle).collect::<Vec<_>>();
                let here = angles(orbit);
                let near = |other: &&PeriodicOrbit| {
                    let there = angles(other);
                    there.len() == here.len() && there.iter().zip(&here).all(|(one, two)| (one - two).abs() < 0.05)
                };
                let other = exact.orbits.iter().find(near).unwrap_or_else(|| panic!("{spline} at {rpm}: {orbit:?}"));
                compared += 1;
                let within = |one: f64, two: f64, error: f64, most: f64| {
                    let off = (one - two).abs();
                    assert!(off <= error + 1e-9 && error <= most, "{spline} at {rpm} rpm: {one} is {two} ± {error}");
                };
                for (one, two) in other.multipliers().into_iter().zip(orbit.multipliers()) {
                    within(one.re, two.re, error.multiplier, 0.3);
                    within(one.im, two.im, error.multiplier, 0.3);
                }
                within(other.state.position, orbit.state.position, error.state[0], 0.5);
                within(other.state.velocity, orbit.state.velocity, error.state[1], 300.0);
                for (one, two) in other.impacts().zip(orbit.impacts()) {
                    within(one.cam_angle, two.cam_angle, error.cam_angle_rad, 0.02);
                    within(one.velocity_before, two.velocity_before, error.velocity_m_s, 300.0);
                    within(one.velocity_after, two.velocity_after, error.velocity_m_s, 300.0);
                }
            }
        }
    }
    assert!(compared >= 6, "{compared}");
}

/// Commands whose numbers have no ± of their own say how well the cam is known that they are about, once, on standard error; those
/// whose numbers have one do not, and of exact rows none does.
#[test]
#[ignore = "slow"]
fn an_answer_without_an_error_says_how_well_its_cam_is_known() {
    let folder = tempfile::tempdir().unwrap();
    let run = |line: &str| {
        let output = crate::common::program(line.split(' ')).current_dir(folder.path()).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{line}: {}", String::from_utf8_lossy(&output.stderr));
        output
    };
    let notes = |line: &str| String::from_utf8(run(line).stderr).unwrap();
    run("new valve.toml --law table");
    let rounded =
        "note: lift rounded to 0.001 mm, so the cam's second derivative is uncertain by 1.4 % of its largest value; ";
    for (command, is_without) in [
        ("simulate valve.toml --rpm 3000 --revolutions 2", true),
        ("diagram valve.toml --rpm 3000:3100:100 --transient 0 --record 1", true),
        ("basins valve.toml --rpm 3000 --grid 2x2 --revolutions 2", true),
        ("continue valve.toml --from-rpm 8000 --parameter rpm=7990:8010", true),
        ("chaos valve.toml --rpm 3000", true),
        ("chart valve.toml --x rpm=3000:3100:2 --y restitution=0.2:0.3:2", true),
        ("curve valve.toml --rpm 2900:2950 --parameter restitution=0.2:0.3 --event detachment --step 0.5", true),
        ("explain restitution valve.toml --no-external", true),
        ("figure valve.toml cam", true),
        ("compare valve.toml --set stiffness=40", true),
        ("cam valve.toml", false),
        ("design valve.toml --rpm 2500 --speeds 2", false),
        ("orbit valve.toml --rpm 3300", false),
    ] {
        let told = notes(command);
        assert_eq!(told.matches(rounded).count(), usize::from(is_without), "{command}: {told}");
    }
    let page = crate::common::text(run("design valve.toml --rpm 3000:3400 --speeds 3 --limit impact-speed=100").stdout);
    assert!(crate::common::in_one_line(&page).contains("for the fitted cam, without a ±"), "{page}");
    let page = crate::common::text(run("orbit valve.toml --rpm 8000").stdout);
    let ends = crate::common::in_one_line(&page);
    assert!(ends.contains("± 0.0") && ends.contains("in a multiplier") && ends.contains("lift rounded to 0.001 mm."));
    assert!(page.contains("     multipliers   1.776   0.003"), "{page}");
    // It loses its stability within what the cam leaves open of where this speed is.
    for (rpm, is_open) in [(12009, true), (11900, false)] {
        let page = crate::common::text(run(&format!("orbit valve.toml --rpm {rpm}")).stdout);
        assert_eq!(page.contains("stable or unstable: its ± does not decide"), is_open, "{page}");
    }
    // The same cam with all digits, and with more rows than are looked at in a blink.
    let (model, rows) = (folder.path().join("valve.toml"), folder.path().join("valve.csv"));
    let text = std::fs::read_to_string(&model).unwrap();
    let quintic = text.replace("\"smoothing\"", "\"quintic\"").replace("tolerance = \"auto\"", "");
    std::fs::write(&model, quintic).unwrap();
    let lift = |angle: f64| 5.0 * (1.0 - angle.cos()) + 0.3 * (1.0 - (2.0 * angle).cos());
    for (count, digits, says) in [
        (360, 17, None),
        (360, 4, Some("lift rounded to 0.0001 mm")),
        (5000, 3, Some("by an amount that `cam` prints")),
    ] {
        let row = |index: u32| {
            let angle = 360.0 * f64::from(index) / f64::from(count);
            format!("{angle},{:.digits$}\n", lift(angle.to_radians()))
        };
        std::fs::write(&rows, format!("angle [deg],lift [mm]\n{}", (0..count).map(row).collect::<String>())).unwrap();
        let told = notes("simulate valve.toml --rpm 3000 --revolutions 2");
        match says {
            Some(says) => assert!(told.contains(says) && told.contains("second derivative is uncertain by"), "{told}"),
            None => {
                assert!(!told.contains("second derivative"), "{told}");
                assert!(!crate::common::text(run("orbit valve.toml --rpm 3000").stdout).contains('±'));
            }
        }
    }
}

/// What must be changed of an eccentric of which rows alone are known is what must be changed of the exact one, to within what is said
/// to be open; runs tell it as well but for a thousandth, and of what need not be changed nothing is open.
#[test]
#[ignore = "slow"]
fn needs_of_a_measured_cam_are_known_to_within_what_is_said() {
    let exact = OWN.model(false, false);
    let rows = rounded(&Cam::new(&exact).unwrap(), 5);
    let document = json!({ "follower": exact.follower, "cam": smoothing(&rows, &json!({})) });
    let model = Model::of_document("rows", &document).unwrap();
    let leaves = rpm(OWN.leaves());
    let needs = |model: &Model, what: &str, part: f64| {
        design(model, &asked(&format!("{what} to {:?} rpm", part * leaves)), &Unwatched).unwrap().needs
    };
    let measured = needs(&model, "no separation", 1.1);
    for (found, known) in measured.iter().zip(needs(&exact, "no separation", 1.1)) {
        assert_eq!((found.value.is_some(), known.error), (known.value.is_some(), None), "{found:?}");
        if let (Some(value), Some(error), Some(known)) = (found.value, found.error.map(|it| it.total()), known.value) {
            assert!((value - known).abs() < error && error < 0.01 * known, "{found:?}, not {known}");
        }
    }
    assert_eq!(measured.iter().filter(|it| it.error.is_some()).count(), 3);
    for (found, computed) in needs(&model, "impact speed below 0.1 m/s", 1.1).iter().zip(&measured) {
        if let (Some(value), Some(error)) = (found.value, found.error.map(|it| it.total())) {
            assert!(
                error >= 1e-3 * value && error < 1.5 * computed.error.unwrap().total() + 1e-3 * value,
                "{found:?}, {computed:?}"
            );
        }
    }
    // Rows to eight places leave next to nothing open, of which runs would tell a thousandth.
    let rows = rounded(&Cam::new(&exact).unwrap(), 8);
    let document = json!({ "follower": exact.follower, "cam": smoothing(&rows, &json!({})) });
    let fine = needs(&Model::of_document("rows", &document).unwrap(), "no separation", 1.1);
    assert!(fine.iter().any(|it| it.error.is_some()));
    assert!(fine.iter().all(|it| it.error.is_none_or(|error| error.total() < 3e-4 * it.value.unwrap())), "{fine:?}");
    let open = |it: &Answer| (it.note.is_empty(), it.error.is_some());
    let few: Vec<_> = needs(&model, "no separation", 0.1).iter().map(open).collect();
    assert!(few.contains(&(false, false)) && !few.contains(&(false, true)), "{few:?}");
}

/// The measured machine that `new` writes: what is told of its cam, and ± on what depends on it.
#[test]
#[ignore = "slow"]
fn a_new_measured_machine() {
    let folder = tempfile::tempdir().unwrap();
    let run = |words: &[&str]| {
        let output = crate::common::program(words).current_dir(folder.path()).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{words:?}: {}", String::from_utf8_lossy(&output.stderr));
        crate::common::text(output.stdout).split_whitespace().collect::<Vec<_>>().join(" ")
    };
    run(&["new", "valve.toml", "--law", "table"]);
    let page = run(&["cam", "valve.toml"]);
    for says in [
        "table: 180 rows; columns separated by commas; the header is \"angle [deg],lift [mm]\"; 1 comment",
        "angles: column 1, in deg",
        "lifts: column 2, in mm",
        "accuracy: lift rounded to 0.001 mm; the rows scatter about a smooth motion by 0.000",
        "no corners of order 2 found; dwells found: 19",
        "Corners (2)",
    ] {
        assert!(page.contains(says), "no \"{says}\" in: {page}");
    }
    // A tolerance that smooths the cam away is remarked on, and one of a coarse gauge is not.
    let text = std::fs::read_to_string(folder.path().join("valve.toml")).unwrap();
    for (tolerance, is_loose) in [("0.5", true), ("0.005", false)] {
        let loose = text.replace("tolerance = \"auto\"", &format!("tolerance = {tolerance}"));
        std::fs::write(folder.path().join("loose.toml"), loose).unwrap();
        let output = crate::common::program(["cam", "loose.toml"]).current_dir(folder.path()).output().unwrap();
        let notes = String::from_utf8_lossy(&output.stderr);
        assert_eq!(notes.contains("mm is far more than the spread of the rows, about 0.00"), is_loose, "{notes}");
        assert_eq!(notes.contains("cam.tolerance: 0.50 mm"), is_loose, "{notes}");
    }
    let page = run(&["design", "valve.toml", "--speeds", "3"]);
    assert!(page.contains(" ± ") && page.contains(" rpm (± from the cam: lift rounded to 0.001 mm)."), "{page}");
    let speeds = ["speeds", "valve.toml", "--rpm", "2700:4500", "--speeds", "10", "--starts", "8"];
    let page = run(&speeds);
    assert!(
        page.contains("leaves the cam first at 29") && page.contains("rpm (± from the cam: lift rounded to 0.001 mm)"),
        "{page}"
    );
    assert!(page.contains("± is the uncertainty from the cam, lift rounded to 0.001 mm"), "{page}");
    // No speed has more digits than the cam leaves it, whether how far it is open is known or not.
    let decimals =
        page.split_whitespace().filter_map(|word| word.split_once('.')).map(|(_, decimals)| decimals.len()).max();
    assert!(decimals < Some(4) && !page.contains("six decimals"), "{page}");
    let model = Model::read(&folder.path().join("valve.toml")).unwrap();
    let resolution =
        Resolution::new(Step::for_values([2700.0, 3000.0], 2, corner_impact::study::survey::Spacing::Linear), 2);
    let mut found = common::speeds(&model, [2700.0, 3000.0], &resolution, &Unwatched).unwrap();
    found.attractors[0].death.as_mut().unwrap().error = None;
    let page = found.text().unwrap();
    assert!(page.contains("2915 ± ?  stays") && page.contains("2915 ± 13"), "{page}");
    found.attractors[1].birth.as_mut().unwrap().error = None;
    let page = found.text().unwrap();
    assert_eq!(page.matches(" 2915 ± ? ").count(), 2, "{page}");
    // A need and a survey over the number to change find one value with one uncertainty.
    let needs = design(&model, &asked("no separation to 3500 rpm"), &Unwatched).unwrap().needs;
    let preload = needs.iter().find(|it| it.lever == Lever::Preload).unwrap();
    let survey = ["speeds", "valve.toml", "--rpm", "3500", "--over", "preload=425:440:4", "--starts", "4", "--json"];
    let survey: Value = serde_json::from_str(&run(&survey)).unwrap();
    assert_relative_eq!(survey["detachment"].as_f64().unwrap(), preload.value.unwrap(), max_relative = 1e-9);
    let error = preload.error.unwrap().total();
    assert_relative_eq!(survey["detachment_error"].as_f64().unwrap(), error, max_relative = 1e-6);
    run(&["report", "valve.toml", "--no-external", "--rpm", "2700:3500", "--out", "report.html"]);
    let report = std::fs::read_to_string(folder.path().join("report.html")).unwrap();
    for says in [
        "id=\"loads\"",
        "table: 180 rows; columns separated by commas",
        ">impact speed</text>",
        ">(mm/s)<",
        "± is the uncertainty from the cam, lift rounded to 0.001 mm",
        "for the cam as it is drawn (lift rounded to 0.001 mm). The loads below have their ±",
        "design valve.toml --rpm 2700:3500 --out loads.svg",
        "speeds valve.toml --rpm 2700:3500 --out attractors.svg",
    ] {
        assert!(report.contains(says), "{says}");
    }
    let found: Value = serde_json::from_str(&run(&[&speeds[..], &["--json"]].concat())).unwrap();
    let error = found["detachment_error_rpm"].as_f64().unwrap();
    assert!(error > 1.0 && error < 0.03 * found["detachment_rpm"].as_f64().unwrap(), "{error}");
    let ends = found["attractors"].as_array().unwrap().iter().flat_map(|one| [&one["birth"], &one["death"]]);
    let located: Vec<&Value> = ends.filter(|end| end["located"] == json!(true)).collect();
    let known = located.iter().filter(|end| end["error_rpm"].as_f64().is_some_and(|error| error > 0.0)).count();
    assert!(known >= 2 && 3 * known >= 2 * located.len(), "{known} of {}", located.len());
}

/// Dwells, corners and errors are the same in whatever unit the lifts are: on a dwell rounding alone is left of them.
#[test]
#[ignore = "slow"]
fn what_is_found_does_not_hang_on_the_unit() {
    let dwell = |span: f64| json!({ "motion": "dwell", "span_deg": span });
    let moves = |span: f64, rise: f64| json!({ "motion": "cycloidal", "span_deg": span, "rise": rise });
    let exact = json!({ "law": "program", "base": 20.0,
        "segment": [dwell(60.0), moves(80.0, 10.0), dwell(15.0), moves(90.0, -10.0), dwell(115.0)] });
    let cam = Cam::new(&machine(exact).unwrap()).unwrap();
    let rows: String =
        (0..360).map(|degree| format!("{degree},{:.3}\n", cam.lift(f64::from(degree).to_radians()).value)).collect();
    let folder = tempfile::tempdir().unwrap();
    let found = ["mm", "m", "um", "in"].map(|length| {
        std::fs::write(folder.path().join("lift.csv"), format!("angle [deg],lift [mm]\n{rows}")).unwrap();
        let file = folder.path().join("model.toml");
        let text = format!(
            "[units]\nlength = \"{length}\"\nstiffness = \"N/mm\"\n[follower]\nmass = 0.11\ndamping = 5\nstiffness = 30\ngravity = 0\n\
             preload = 220\nrestitution = 0.3\n[cam]\nlaw = \"table\"\nfile = \"lift.csv\"\nspline = \"smoothing\"\n"
        );
        std::fs::write(&file, text).unwrap();
        let model = Model::read(&file).unwrap();
        // The ends of its dwells are marked in pictures, and not the knots of the spline.
        assert_eq!(corner_marks(&Cam::new(&model).unwrap()).len(), 4, "{length}");
        let asked = Asked { rpm: Some([2000.0, 2600.0]), speeds: 2, ..Asked::default() };
        let found = design(&model, &asked, &Unwatched).unwrap();
        let Separation::At { rpm, error, .. } = found.separation else { panic!("{length}") };
        // On a dwell the spring alone presses, and nothing is open of that.
        let force = found.forces[0];
        assert!(force.error.is_none() && (found.force(force.least.value) - 220.0).abs() < 1e-6, "{length}: {force:?}");
        (found.measured.unwrap().dwells_deg, rpm, error)
    });
    for (dwells, rpm, error) in &found[1..] {
        assert_eq!(dwells.len(), 2);
        for (one, other) in dwells.as_flattened().iter().zip(found[0].0.as_flattened()) {
            assert_abs_diff_eq!(one, other, epsilon = 1e-6);
        }
        assert_abs_diff_eq!(*rpm, found[0].1, epsilon = 1e-6 * rpm);
        assert_abs_diff_eq!(*error, found[0].2, epsilon = 1e-3 * error);
    }
}

/// Of coarse rows without noise a jump of the acceleration, or the bend of the cam, is no slip, nor is noise of fine ones; a slip that is larger than
/// both is one.
#[test]
fn a_slip_is_larger_than_what_the_cam_bends() {
    let strays = |rows: &[(f64, f64)]| {
        PlausibleCams::of(&machine(smoothing(rows, &json!({}))).unwrap()).unwrap().unwrap().measured.strays
    };
    for motion in ["harmonic", "poly345"] {
        let cam = Cam::new(&machine(program(motion, 63.7, 13.71, 40.3)).unwrap()).unwrap();
        let mut rows: Vec<_> = rounded(&cam, 9).into_iter().step_by(5).collect();
        let noisy = |index: usize| 0.004 * (977.0 * (index as f64).sin()).sin();
        let noise: Vec<_> =
            rounded(&cam, 9).iter().enumerate().map(|(index, row)| (row.0, row.1 + noisy(index))).collect();
        assert!(strays(&rows).is_empty() && strays(&noise).is_empty(), "{motion}: {:?}", strays(&rows));
        rows[20].1 += 0.4;
        let found = strays(&rows);
        let [one] = found[..] else { panic!("{motion}: {found:?}") };
        assert_eq!((one.line, one.cam_angle_deg), (21, 100.0));
        assert_abs_diff_eq!(one.off_m, 0.4, epsilon = 0.02);
    }
}

/// A slip in one row is found with the row and how far it is off, whatever the spline and wherever it is; noise, rounding, corners,
/// dwells and coarse rows are none.
#[test]
#[ignore = "slow"]
fn a_slip_in_one_row_is_told() {
    let strays = |rows: &[(f64, f64)], spline: &str| {
        let mut cam = smoothing(rows, &json!({}));
        cam["spline"] = json!(spline);
        PlausibleCams::of(&machine(cam).unwrap()).unwrap().unwrap().measured.strays
    };
    for motion in ["cycloidal", "poly345", "modified-trapezoid", "harmonic"] {
        let cam = Cam::new(&machine(program(motion, 63.7, 13.71, 40.3)).unwrap()).unwrap();
        for places in [2, 3, 4, 9] {
            let rows = rounded(&cam, places);
            let noisy = |index: usize| 0.004 * (977.0 * (index as f64).sin()).sin();
            let noise: Vec<_> = rows.iter().enumerate().map(|(index, row)| (row.0, row.1 + noisy(index))).collect();
            let coarse: Vec<_> = rows.iter().copied().step_by(5).collect();
            for rows in [&rows, &noise, &coarse] {
                let found = strays(rows, "cubic");
                assert!(found.is_empty(), "{motion} to {places} places, {} rows: {found:?}", rows.len());
            }
        }
        // On the flank, at the top, in the dwell and at the seam.
        for (row, slip) in [(0, 0.5), (60, -0.2), (95, 0.03), (300, -0.05), (359, 0.5)] {
            let mut rows = rounded(&cam, 3);
            rows[row].1 += slip;
            for spline in ["smoothing", "cubic", "quintic"] {
                let found = strays(&rows, spline);
                let [one] = found[..] else { panic!("{slip} at {row}: {found:?}") };
                assert_eq!((one.line, one.cam_angle_deg), (row + 1, row as f64));
                assert_abs_diff_eq!(one.off_m, slip, epsilon = 0.003);
            }
        }
    }
}

/// A slip in the rows of a measured machine, as its user is told of it, by each command that reads it.
#[test]
fn a_slip_is_told_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let run = |words: &[&str]| crate::common::program(words).current_dir(folder.path()).output().unwrap();
    run(&["new", "valve.toml", "--law", "table"]);
    let (rows, lines) =
        (folder.path().join("valve.csv"), |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>());
    let mut written = lines(&std::fs::read_to_string(&rows).unwrap());
    for (line, lift) in [(60, "6.514"), (100, "0.050"), (120, "0.050"), (140, "0.050"), (160, "-0.050")] {
        let angle = written[line - 1].split(',').next().unwrap().to_owned();
        written[line - 1] = format!("{angle},{lift}");
    }
    std::fs::write(&rows, written.join("\n")).unwrap();
    let told = lines(&crate::common::text(run(&["cam", "valve.toml"]).stderr));
    assert_eq!(told.len(), 4, "{told:?}");
    assert!(
        told[0].starts_with("note: valve.csv, line 60: lift 6.514 at 114 deg is 3.0 mm below the trend"),
        "{told:?}"
    );
    assert!(told[2].starts_with("note: valve.csv, line 120: lift 0.05 at 234 deg is 0.05"), "{told:?}");
    assert_eq!(told[3], "note: 2 more rows are off as well: `cam --json` lists them");
    let of_run =
        lines(&crate::common::text(run(&["simulate", "valve.toml", "--rpm", "100", "--revolutions", "1"]).stderr));
    assert_eq!(told, of_run[..4]);
    assert!(
        of_run[4].contains("so the cam's second derivative is uncertain by 72 %") && of_run.len() == 5,
        "{of_run:?}"
    );
    let sheet: Value = serde_json::from_slice(&run(&["cam", "valve.toml", "--json"]).stdout).unwrap();
    let strays = sheet["measured"]["strays"].as_array().unwrap();
    assert_eq!(strays.iter().map(|one| &one["line"]).collect::<Vec<_>>(), [60, 100, 120, 140, 160]);
    assert_abs_diff_eq!(strays[4]["off_mm"].as_f64().unwrap(), -0.05, epsilon = 1e-3);
}

/// Corner impacts of the paper's cam as it is measured, from another angle on each time, with how far noise may have moved them: once with
/// the corner next to angle 0, so that on other likely cams it is on the other side of it.
#[test]
#[ignore = "slow"]
fn corner_impacts_of_a_measured_cam_are_known_as_well_as_they_were() {
    let paper = crate::common::osorio();
    let cam = crate::common::cam(&paper);
    let mut known = String::new();
    for from in [0.0, 150.1458, 211.0] {
        let row = |k: u32| {
            let lift = cam.lift((f64::from(k) + from).to_radians().rem_euclid(TAU)).value;
            [f64::from(k), (lift * 1e6).round() / 1e6]
        };
        let rows: Vec<[f64; 2]> = (0..360).map(row).collect();
        let follower = serde_json::to_value(paper.follower).unwrap();
        let cam = json!({ "law": "table", "spline": "smoothing", "rows": rows });
        let model = Model::of_document("turned", &json!({ "follower": follower, "cam": cam })).unwrap();
        let found = locate(&model, Study { rpm_min: 665.0, rpm_max: 680.0 }, 1, &Unwatched).unwrap();
        assert_eq!(found.found.len(), 1);
        for it in &found.found {
            let (speed, angle) = (it.at.speed_rpm(), it.at.corner.angle.to_degrees());
            let error = it.speed_error.unwrap().total();
            assert!((speed - 673.234_445_003_8).abs() <= error && error < 0.1, "{speed} ± {error}");
            known += &format!("{from}: {speed:.5} ± {error:.3e} rpm at {angle:.4}\n");
        }
    }
    snapshots::settings().bind(|| insta::assert_snapshot!("measured-events", known));
}

/// The paper's cam as a table of micrometres, its angles counted from one, in degrees, and its dwells where they are drawn.
fn counted_from(zero: f64) -> Model {
    let dwells = [[160.0, 200.0], [270.0, 450.0]].map(|dwell| {
        let start = (dwell[0] - zero).rem_euclid(360.0);
        [start, start + dwell[1] - dwell[0]]
    });
    the_papers_cam(zero, 1, &json!({ "dwells_deg": dwells }))
}

fn the_papers_cam(zero: f64, step: u32, more: &Value) -> Model {
    let paper = crate::common::osorio();
    let cam = crate::common::cam(&paper);
    let lift = |k: u32| (cam.lift(f64::from(k).to_radians()).value * 1e6).round() * 1e-6;
    let angles = (0..360).step_by(step as usize);
    let mut rows: Vec<(f64, f64)> = angles.map(|k| ((f64::from(k) - zero).rem_euclid(360.0), lift(k))).collect();
    rows.sort_by(|one, two| one.0.total_cmp(&two.0));
    let follower = serde_json::to_value(paper.follower).unwrap();
    Model::of_document("the paper's cam", &json!({ "follower": follower, "cam": smoothing(&rows, more) })).unwrap()
}

/// Where angles are counted from is all one, also where a table as likely has the corner, or the other impact, on the other side of angle 0.
#[test]
#[ignore = "slow"]
fn a_corner_impact_beside_angle_0_is_known_as_well_as_any() {
    let found = |zero: f64| {
        let located = locate(&counted_from(zero), Study { rpm_min: 735.5, rpm_max: 736.5 }, 1, &Unwatched).unwrap();
        let [found] = &located.found[..] else { panic!("{zero} {:?}", located.found) };
        let angles: Vec<f64> = found.at.cycle.impacts.iter().map(|impact| impact.cam_angle.to_degrees()).collect();
        (found.at.speed_rpm(), found.speed_error.unwrap().total(), angles)
    };
    let (speed, error, angles) = found(0.0);
    assert!((speed - 736.110_8).abs() <= error && error < 0.5, "{speed} {error}");
    let [corner, other] = angles[..] else { panic!("{angles:?}") };
    for zero in [corner + 1e-5, other] {
        let (there, known, _) = found(zero);
        assert!((there / speed - 1.0).abs() < 1e-9, "{there} {speed}");
        assert!((known / error - 1.0).abs() < 0.3, "{known} {error}");
    }
}

/// Of two impacts in a revolution one is on a corner that is found in the rows, 150.2097 degrees from where they begin. Counted from there,
/// about half of the tables that are as likely have it at the end of a revolution, and the impact is one of the revolution before.
#[test]
fn a_corner_that_noise_moves_over_angle_0_takes_its_impact_along() {
    let model = the_papers_cam(150.2097, 2, &json!({}));
    let located = locate(&model, Study { rpm_min: 355.0, rpm_max: 355.4 }, 1, &Unwatched).unwrap();
    let [found] = &located.found[..] else { panic!("{:?}", located.found) };
    let from_0 = apart(found.at.corner.angle, 0.0);
    assert!(found.at.cycle.impacts.len() == 2 && from_0 < 1e-5, "{from_0}");
    // The exact cam has it at 355.1545 rpm.
    let (speed, error) = (found.at.speed_rpm(), found.speed_error.unwrap().total());
    assert!((speed - 355.154_5).abs() <= error && error < 3.0, "{speed} {error}");
}

/// The end of a dwell that is found in the rows is put inside of where the cam leaves it: what is met there is no corner of the cam.
#[test]
#[ignore = "slow"]
fn where_a_dwell_is_found_to_end_is_no_corner() {
    let range = Study { rpm_min: 735.5, rpm_max: 737.0 };
    let count = |model: &Model| locate(model, range, 1, &Unwatched).unwrap().found.len();
    assert_eq!([counted_from(0.0), the_papers_cam(0.0, 1, &json!({}))].each_ref().map(count), [1, 0]);
}

/// The flip of the paper's machine.
#[test]
#[ignore = "slow"]
fn a_flip_of_a_measured_cam_is_known_to_within_what_is_said() {
    let resolution = Resolution::new(common::step(0.05), 2);
    let survey = common::speeds(&the_papers_cam(0.0, 1, &json!({})), [739.2, 739.36], &resolution, &Unwatched).unwrap();
    let ends: Vec<&Transition> = survey.attractors.iter().flat_map(|one| one.birth.iter().chain(&one.death)).collect();
    let flip = ends.iter().find(|end| end.cause.name() == "flip").unwrap();
    let error = flip.error.unwrap().total();
    assert!((flip.value() - 739.319_780).abs() <= error && error < 1.0, "{} ± {error}", flip.value());
}

/// A ball on a table `a cos(theta + turned)` of a millimetre, measured in rows of 5 degrees to its hundred thousandths.
fn ball_on_rows(turned_deg: f64) -> Model {
    let lift = |row: u32| (1e8 * 0.001 * (5.0 * f64::from(row) + turned_deg).to_radians().cos()).round() / 1e8;
    let rows: Vec<(f64, f64)> = (0..72).map(|row| (5.0 * f64::from(row), lift(row))).collect();
    let cam = smoothing(&rows, &json!({}));
    Model::of_document("ball", &json!({ "follower": follower_of_a_ball(), "cam": cam })).unwrap()
}

fn follower_of_a_ball() -> Value {
    json!({ "mass": 1, "damping": 0, "stiffness": 0, "gravity": 9.81, "rest_position": 0, "restitution": 0.8 })
}

/// `m (g - a w^2)` presses least on the ball, where the table is highest: within what the rows leave open, which is not nothing.
#[test]
fn the_force_on_a_measured_cam_is_as_far_off_as_is_said() {
    let asked = Asked { rpm: Some([600.0, 800.0]), speeds: 3, ..Asked::default() };
    for at in design(&ball_on_rows(2.5), &asked, &Unwatched).unwrap().forces {
        let (omega, error) = (at.place.rpm * TAU / 60.0, at.error.unwrap().total());
        let off = (at.least.value - (9.81 - 0.001 * omega * omega)).abs();
        assert!(off <= error && error < 5e-3, "{off} {at:?}");
    }
}

/// The motion of one impact begins in a fold at `a w^2 (1 + r) = pi g (1 - r)`, a quarter of a turn from the top: within what the rows leave open,
/// whether one of them is there or not.
#[test]
fn a_fold_on_a_measured_cam_is_as_far_off_as_is_said() {
    let fold = (PI * 9.81 * 0.2 / 1.8 / 0.001).sqrt() * 60.0 / TAU;
    let exact = |row: u32| 0.001 * (5.0 * f64::from(row)).to_radians().cos();
    let rows: Vec<(f64, f64)> = (0..72).map(|row| (5.0 * f64::from(row), exact(row))).collect();
    let through = json!({ "law": "table", "spline": "quintic", "rows": rows });
    let through = Model::of_document("ball", &json!({ "follower": follower_of_a_ball(), "cam": through })).unwrap();
    for model in [ball_on_rows(2.5), ball_on_rows(0.0), through] {
        let found = common::speeds(&model, [555.0, 560.0], resolution(5.0, 2), &Unwatched).unwrap();
        let birth = found.attractors.iter().find(|it| it.impacts == Some(1)).unwrap().birth.as_ref().unwrap();
        let error = birth.error.unwrap().total();
        assert_eq!(birth.cause, Cause::Fold);
        assert!((birth.value() - fold).abs() <= error && error < 0.05, "{} {error}", birth.value());
    }
}

/// A ball that does not bounce is thrown once a revolution from where `a w^2 cos = g` on the way up, and rests until then, up to where it
/// is back there just as it is thrown again: `a w^2 = g (1 + pi^2)^(1/2)`. Runs tell that end, and how far the rows leave it open.
#[test]
fn an_end_by_runs_on_a_measured_cam_is_as_far_off_as_is_said() {
    let end = (9.81 * PI.hypot(1.0) / 0.001).sqrt() * 60.0 / TAU;
    for turned_deg in [0.0, 2.5] {
        let plastic = ball_on_rows(turned_deg).with_number("follower.restitution", 0.0).unwrap();
        let found = common::speeds(&plastic, [1600.0, 1800.0], resolution(100.0, 1), &Unwatched).unwrap();
        let death = found.attractors[0].death.as_ref().unwrap();
        let error = death.error.unwrap().total();
        assert_eq!(death.cause, Cause::Runs);
        assert!((death.value() - end).abs() <= error && error < 2.0, "{} {error}", death.value());
    }
}

/// A branch ends at the last of its steps where runs tell its end, and from another start at another one: what it has of an orbit is one
/// orbit nevertheless.
#[test]
#[ignore = "slow"]
fn an_orbit_whose_end_runs_tell_is_listed_once() {
    let model = ball_on_rows(0.0).with_number("follower.restitution", 0.1).unwrap();
    let found = common::speeds(&model, [1480.0, 1520.0], resolution(20.0, 1), &Unwatched).unwrap();
    let mut listed = Vec::new();
    for row in &found.attractors {
        let by_runs = [&row.birth, &row.death].map(|end| end.as_ref().is_some_and(|end| end.cause == Cause::Runs));
        listed.push((row.revolutions, row.impacts, by_runs, row.range()));
    }
    let alike = |one: &[f64; 2], two: &[f64; 2]| (one[0] - two[0]).abs() < 1e-6 * two[0] && one[1] > two[0];
    for (index, one) in listed.iter().enumerate() {
        let again = listed[..index].iter().find(|two| (one.0, one.1) == (two.0, two.1) && alike(&one.3, &two.3));
        assert!(again.is_none(), "{listed:?}");
    }
    assert!(listed.iter().any(|row| row.2[1]), "{listed:?}");
}

/// The paper's cam in rows of two degrees to a thousandth of a millimetre, its corners as they are drawn: cams that are as likely have its corner
/// impact, too, and the true one is no farther off than they are.
#[test]
fn a_corner_impact_of_a_measured_cam_is_as_far_off_as_is_said() {
    let paper = crate::common::osorio();
    let (cam, follower) = (crate::common::cam(&paper), paper.follower);
    let lift = |degrees: f64| (cam.lift(degrees.to_radians()).value * 1e6).round() / 1e6;
    let rows: Vec<(f64, f64)> = (0..180).map(|row| 2.0 * f64::from(row)).map(|angle| (angle, lift(angle))).collect();
    let corners: Vec<f64> = cam.corners().iter().map(|corner| corner.angle.to_degrees()).collect();
    let document = json!({
        "follower": { "mass": follower.mass, "damping": follower.damping, "stiffness": follower.stiffness,
            "gravity": follower.gravity, "rest_position": follower.rest_position, "restitution": follower.restitution },
        "cam": smoothing(&rows, &json!({ "corners_deg": corners })),
        "study": { "rpm_min": 600.0, "rpm_max": 760.0 },
    });
    let found = verify(&Model::of_document("paper", &document).unwrap(), External::LeftOut).unwrap();
    let open = found.uncertainty.unwrap();
    let error = open.error.unwrap().speed.total();
    assert!((found.at.speed_rpm() - 673.234445).abs() <= error && error < 0.5, "{} {error}", found.at.speed_rpm());
    assert!(open.verdicts.iter().map(|told| told.cams).sum::<usize>() > 10, "{:?}", open.verdicts);
}

/// Rows at random, of a table that nobody could have measured, from which a spline is drawn all the same.
fn rough(seed: u64, count: usize) -> Vec<[f64; 2]> {
    let mut bits = seed;
    let mut next = || {
        bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (bits >> 11) as f64 / 2.0_f64.powi(53)
    };
    // Angles of an even grid, some of them close together, and lifts of few values.
    let mut rows: Vec<[f64; 2]> = (0..count)
        .map(|row| [360.0 * (row as f64 + next().powi(8)) / count as f64, 0.04 + 0.001 * (8.0 * next()).floor()])
        .collect();
    if count >= 8 && seed.is_multiple_of(3) {
        rows[1][0] = rows[0][0] + 1e-3;
    }
    rows
}

/// The noise of rows is known or it is said that it is not; that costs the cam nothing, and no command.
#[test]
fn a_spline_through_rough_rows_is_never_refused() {
    let case = [
        [84.7859, 0.045562],
        [115.1225, 0.046744],
        [132.4371, 0.046842],
        [161.4759, 0.044638],
        [182.2986, 0.042219],
        [182.5445, 0.046409],
        [251.4643, 0.041071],
        [287.6182, 0.046922],
        [287.9566, 0.046354],
        [290.2375, 0.043765],
        [304.1736, 0.047985],
        [335.9606, 0.04194],
    ];
    let tables = (0..24).map(|seed| rough(seed, 3 + seed as usize % 12)).chain([case.to_vec()]);
    let mut told = 0;
    for rows in tables {
        for spline in ["cubic", "quintic"] {
            let cam = json!({ "law": "table", "spline": spline, "unit": "m", "rows": rows });
            let model = machine(cam).unwrap_or_else(|why| panic!("{why}: {rows:?}"));
            let likely = PlausibleCams::of(&model).unwrap_or_else(|why| panic!("{why}: {rows:?}"));
            assert_eq!(likely.is_some(), rows.len() >= 12);
            let Some(likely) = likely else { continue };
            assert_eq!(likely.measured.noise_unknown.is_some(), likely.measured.noise_m.is_nan(), "{rows:?}");
            told += usize::from(likely.measured.noise_m.is_finite());
        }
    }
    assert!(told >= 8, "{told}");
}

/// Two rows so close together that no smooth motion is fitted to them.
#[test]
fn a_noise_that_is_unknown_is_said_to_be() {
    let mut rows: Vec<[f64; 2]> =
        (0..16).map(|row| [22.5 * f64::from(row), 0.04 + 0.001 * f64::from(row % 5)]).collect();
    rows[7][0] = rows[6][0] + 1e-9;
    let model = machine(json!({ "law": "table", "spline": "cubic", "unit": "m", "rows": rows })).unwrap();
    let measured = PlausibleCams::of(&model).unwrap().unwrap().measured;
    let why = measured.noise_unknown.clone().unwrap();
    assert!(why.contains("for a spline near them") && measured.noise_m.is_nan() && !measured.is_noisy, "{measured:?}");
    assert!(measured.largest_curvature > 0.0 && measured.curvature_error.is_nan());
    let sheet =
        corner_impact::study::cam::CamSheet::new(&model, &Cam::new(&model).unwrap(), 3).unwrap().text().unwrap();
    let design =
        design(&model, &Asked { rpm: Some([10.0, 10.0]), ..Asked::default() }, &Unwatched).unwrap().text().unwrap();
    let as_drawn = corner_impact_cli::show::notes::as_drawn(&model).unwrap().unwrap();
    for page in [sheet, design, as_drawn] {
        let page = crate::common::in_one_line(&page);
        assert!(page.contains("The noise of the rows is unknown"), "{page}");
    }
}

/// Loads of a measured cam have uncertainties where the noise of its rows is known, over any number; the force round the cam is told of one speed, and of no
/// other number.
#[test]
fn loads_are_as_uncertain_as_rows_are_known_to_leave_them() {
    let table =
        |rows: &[[f64; 2]]| machine(json!({ "law": "table", "spline": "cubic", "unit": "m", "rows": rows })).unwrap();
    let mut rows: Vec<[f64; 2]> = (0..36)
        .map(|row| 10.0 * f64::from(row))
        .map(|angle| [angle, (0.05 + 0.01 * angle.to_radians().cos()) * 1e5])
        .collect();
    rows.iter_mut().for_each(|[_, lift]| *lift = lift.round() / 1e5);
    let noisy = table(&rows);
    // No smooth motion is fitted to two rows that are so close together.
    rows[7][0] = rows[6][0] + 1e-9;
    let unknown = table(&rows);
    let budget = Some(Budget { transient: 20, record: 0, longest: 8, patience: 0 });
    let apart = 1.3 * Contact::new(&Cam::new(&noisy).unwrap(), noisy.follower).separation().speed();
    let of_speed = Asked { rpm: Some([apart; 2]), budget, ..Asked::default() };
    let values = Values { low: noisy.follower.mass, high: noisy.follower.mass, count: 1, spacing: Spacing::Linear };
    let mass = Axis::new(Parameter::named(&noisy, "mass").unwrap(), &values);
    let of_mass = Asked { over: Some(mass), ..of_speed.clone() };
    for (model, asked, is_uncertain, is_round) in
        [(&noisy, &of_speed, true, true), (&unknown, &of_speed, false, true), (&noisy, &of_mass, true, false)]
    {
        let found = design(model, asked, &Unwatched).unwrap();
        assert_eq!(found.loads.len(), 1);
        assert_eq!((found.loads[0].errors.is_some(), !found.round.is_empty()), (is_uncertain, is_round));
    }
}

/// A lobe whose acceleration is least at two places alike, 13 degrees before and behind its nose, is left first at either, as the rounding of its
/// rows has it.
#[test]
fn two_places_that_may_be_left_first_are_both_named() {
    let row = |angle: u32| {
        let from_nose = (f64::from(angle) - 180.0).to_radians();
        let lift = if from_nose.abs() < PI / 3.0 {
            4.0 * (1.0 + (3.0 * from_nose).cos()) - 0.15 * (1.0 + (9.0 * from_nose).cos())
        } else {
            0.0
        };
        format!("{angle},{lift:.3}\n")
    };
    let folder = tempfile::tempdir().unwrap();
    let rows: String = (0..360).map(row).collect();
    std::fs::write(folder.path().join("lift.csv"), format!("angle [deg],lift [mm]\n{rows}")).unwrap();
    let text = "name = \"twofold\"\n[units]\nlength = \"mm\"\nstiffness = \"N/mm\"\n[follower]\nmass = 0.1\ndamping = 0\nstiffness = 30\n\
                preload = 220\ngravity = 0\nrestitution = 0.5\n[cam]\nlaw = \"table\"\nfile = \"lift.csv\"\nspline = \"smoothing\"\n\
                corners_deg = []\n";
    std::fs::write(folder.path().join("twofold.toml"), text).unwrap();
    let model = Model::read(&folder.path().join("twofold.toml")).unwrap();
    let asked = Asked { rpm: Some([1000.0, 1000.0]), speeds: 1, ..Asked::default() };
    let found = design(&model, &asked, &Unwatched).unwrap();
    let [one, two] = &found.places[..] else { panic!("{:?} {:?}", found.separation, found.places) };
    assert!(one.share >= two.share && two.share > 0.0 && (one.share + two.share - 1.0).abs() < 1e-12);
    let mut middles = [one, two].map(|place| 0.5 * (place.cam_angles[0] + place.cam_angles[1]).to_degrees());
    middles.sort_by(f64::total_cmp);
    assert!((middles[0] - 167.0).abs() < 4.0 && (middles[1] - 193.0).abs() < 4.0, "{middles:?}");
    let page = crate::common::in_one_line(&found.text().unwrap());
    assert!(
        page.contains("The angle is uncertain: ") && page.matches(" % of 16 equally likely cams").count() == 2,
        "{page}"
    );
    assert!(!page.split("The angle is uncertain").next().unwrap().contains(" deg"), "{page}");
    // The report says the same.
    let sentence = page.split("The follower leaves").nth(1).unwrap().split(" (computed").next().unwrap();
    let words = ["report", "twofold.toml", "--no-external", "--rpm", "1000:1100", "--out", "twofold.html"];
    common::program(words).current_dir(folder.path()).output().unwrap();
    let report = std::fs::read_to_string(folder.path().join("twofold.html")).unwrap();
    let open = sentence.split("The angle is uncertain").nth(1).unwrap();
    let report: String = report.split('<').filter_map(|part| part.split_once('>')).map(|(_, text)| text).collect();
    assert!(common::in_one_line(&report).contains(&format!("The angle is uncertain{open}")), "{open}");
    // One place that all likely cams share is not open.
    let one = SeparationPlace { share: 1.0, ..found.places[0] };
    let page = crate::common::in_one_line(&Design { places: vec![one], ..found }.text().unwrap());
    assert!(
        page.contains(". On each of 16 equally likely cams, it leaves at 1") && !page.contains("is uncertain"),
        "{page}"
    );
}

/// Coarse rows with four decimals of an exact motion: the note advises the tolerance that the decimals allow, with which the answer is right, and
/// dwells that are given are not blamed for what the smoothing does elsewhere.
#[test]
fn clean_coarse_rows_are_told_which_tolerance_they_allow() {
    let truth = machine(program("poly345", 60.0, 100.0, 30.0)).unwrap();
    let exact = Cam::new(&truth).unwrap();
    let rows: Vec<(f64, f64)> = rounded(&exact, 4).into_iter().step_by(5).collect();
    let leaves = first(&truth, &exact);
    let noted = |more: &Value| {
        let model = machine(smoothing(&rows, more)).unwrap();
        (Remarks::on(&model).unwrap(), separation(smoothing(&rows, more)))
    };
    let (remarks, _) = noted(&json!({}));
    let [distance, allowed] = remarks.smoothed_away.unwrap();
    assert!(distance > 30.0 * allowed && (allowed - 1e-4).abs() < 1e-9, "{distance} {allowed}");
    let (remarks, (found, error)) = noted(&json!({ "tolerance": allowed }));
    assert!(remarks.smoothed_away.is_none() && (found - leaves).abs() <= error, "{found} ± {error}, not {leaves}");
    let (remarks, _) = noted(&json!({ "dwells_deg": [[250.0, 100.0], [160.0, 190.0]] }));
    assert!(remarks.contradicted.is_none(), "{:?}", remarks.contradicted);
}
