//! Do the machines of textbooks and engines have the numbers that were printed of them? `docs/engineering.md` has the table.

use std::f64::consts::TAU;
use std::path::Path;

use approx::assert_abs_diff_eq;
use corner_impact::cam::{Cam, Lift};
use serde_json::Value;

use crate::common::{self, corner_impact};

const INCHES_PER_FOOT: f64 = 12.0;
const METRES: f64 = 1e-3;

/// The cam in the unit of its file: inches, feet or millimetres.
fn cam(name: &str) -> Cam {
    common::cam(&common::read(&Path::new(common::ROOT).join(format!("models/machines/{name}.toml"))))
}

/// The lift just behind an angle.
fn behind(cam: &Cam, angle_deg: f64) -> Lift {
    cam.lift((angle_deg + 1e-7).to_radians())
}

fn omega(rpm: f64) -> f64 {
    rpm * TAU / 60.0
}

/// 45 degrees are the top of a lobe, where the spring is compressed most: the printed force is the largest one.
#[test]
fn a_face_cam_presses_with_the_printed_force() {
    let rpm = format!("{}", 6.0 * 60.0 / TAU);
    let words = ["design", "models/machines/face-cam-force.toml", "--rpm", &rpm, "--json"];
    let found: Value = serde_json::from_slice(&corner_impact(words).stdout).unwrap();
    assert_abs_diff_eq!(found["contact_force"][0]["largest_lbf"].as_f64().unwrap(), 4.464, epsilon = 0.0005);
}

#[test]
fn three_arcs_lift_a_flat_face_by_the_printed_law() {
    let (cam, omega) = (cam("flat-face-arcs"), omega(1200.0));
    // The printed factor of the flank, 4.477 in, is 0.02 % above that of the printed circles.
    assert_abs_diff_eq!(behind(&cam, 125.0).curvature, 4.477, epsilon = 0.0011);
    let apex = behind(&cam, 180.0);
    assert_abs_diff_eq!(apex.curvature, -1.5, epsilon = 1e-6);
    assert_abs_diff_eq!(omega * omega * apex.curvature / INCHES_PER_FOOT, -1974.0, epsilon = 0.5);
    // The nose's velocity is 15.71 sin(55 deg - theta) ft/s; 150 deg are 25 of the ascent.
    let printed = 15.71 * 30.0_f64.to_radians().sin();
    assert_abs_diff_eq!(omega * behind(&cam, 150.0).slope / INCHES_PER_FOOT, printed, epsilon = 0.0025);
}

#[test]
fn a_tangent_cam_starts_a_roller_with_the_printed_acceleration() {
    // The book takes 62.84 rad/s for 600 rpm.
    let start = METRES * 62.84_f64.powi(2) * behind(&cam("tangent-roller"), 105.0).curvature;
    assert_abs_diff_eq!(start, 187.6, epsilon = 0.05);
}

/// Largest velocity and acceleration of a rise and of a return: where each begins and where its middle is, degrees.
fn largest(name: &str, rpm: f64, parts: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let (cam, omega) = (cam(name), omega(rpm));
    parts.map(|[begins, middle]| {
        let slope = cam.lift(middle.to_radians()).slope.abs();
        [METRES * omega * slope, METRES * omega * omega * behind(&cam, begins).curvature.abs()]
    })
}

#[test]
fn simple_harmonic_motions_have_the_printed_accelerations() {
    let [rise, fall] = largest("harmonic-valve", 100.0, [[0.0, 60.0], [150.0, 180.0]]);
    for (found, printed) in [rise, fall].concat().iter().zip([0.39, 6.17, 0.78, 24.67]) {
        assert_abs_diff_eq!(*found, printed, epsilon = 0.0055);
    }
    // The companion takes 3.141 for pi.
    let [rise, fall] = largest("harmonic-fast", 300.0, [[0.0, 30.0], [105.0, 150.0]]);
    let pi = 3141.0 / (1000.0 * std::f64::consts::PI);
    assert_abs_diff_eq!(pi * pi * rise[1], 177.6, epsilon = 0.05);
    assert_abs_diff_eq!(pi * pi * fall[1], 78.9, epsilon = 0.05);
}

#[test]
fn constant_accelerations_are_those_printed_in_centimetres() {
    let [rise, fall] = largest("constant-acceleration", 1000.0, [[0.0, 60.0], [180.0, 225.0]]);
    assert_abs_diff_eq!(100.0 * rise[1], 25_000.0, epsilon = 0.05);
    assert_abs_diff_eq!(100.0 * fall[1], 44_444.4, epsilon = 0.05);
}

#[test]
fn a_cycloid_has_the_printed_table() {
    let cam = cam("cycloid-table");
    let degree = 1.0_f64.to_radians();
    for (angle, printed) in [
        (5.0_f64, [0.075117, 0.044658, 0.017453]),
        (10.0, [0.576689, 0.166667, 0.030230]),
        (15.0, [1.816901, 0.333333, 0.034907]),
        (20.0, [3.910022, 0.500000, 0.030230]),
        (25.0, [6.741784, 0.622008, 0.017453]),
        (30.0, [10.0, 0.666667, 0.0]),
        (45.0, [18.18310, 0.333333, -0.034907]),
        (55.0, [19.92488, 0.044658, -0.017453]),
    ] {
        let lift = cam.lift(angle.to_radians());
        let found = [lift.value, lift.slope * degree, lift.curvature * degree * degree];
        for (found, printed) in found.iter().zip(printed) {
            assert_abs_diff_eq!(*found, printed, epsilon = if printed > 10.0 { 5.5e-6 } else { 5.5e-7 });
        }
    }
}

/// The peak, and where the lift is 0.1 mm beside the published valve events, whose lift is not stated: crank degrees.
#[test]
fn an_engines_valves_open_and_close_where_they_were_published() {
    for (name, begins, opens, closes) in [("tcc3-intake", 339.0, 352.8, 600.8), ("tcc3-exhaust", 108.0, 124.8, 372.8)] {
        let cam = cam(name);
        let lift = |crank: f64| cam.lift((0.5 * crank).to_radians()).value;
        let peak = (0..2800).map(|tenth| lift(begins + 0.1 * f64::from(tenth))).fold(0.0, f64::max);
        assert_abs_diff_eq!(peak, 8.89, epsilon = 0.005);
        assert!(lift(opens - 0.8) < 0.1 && lift(opens + 0.8) > 0.1, "{name} opens");
        assert!(lift(closes - 0.8) > 0.1 && lift(closes + 0.8) < 0.1, "{name} closes");
    }
}
