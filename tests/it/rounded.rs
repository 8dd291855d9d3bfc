//! Does a fold move as is said where its corner is rounded, and is a cam refused whose corners cannot be?

use std::path::Path;

use crate::common;
use crate::progress::program;
use approx::assert_abs_diff_eq;
use corner_impact::cam::Cam;
use corner_impact::model::Model;
use corner_impact::orbit::branch::{Bifurcation, Following};
use corner_impact::orbit::{Parameter, Search};
use corner_impact::progress::Unwatched;
use corner_impact::study::curve::{Curves, curves};
use corner_impact::study::verify::{External, verify};

const ROUNDING: &str = "cam.corner_rounding_deg";

fn model(name: &str) -> Model {
    common::read(&Path::new(common::ROOT).join(format!("models/{name}.toml")))
}

/// The folds near a speed, from the smallest rounding on.
fn folds(model: &Model, rpm: f64) -> Curves {
    let parameter = Parameter::named(model, "corner_rounding_deg").unwrap();
    let following = Following { parameter, range: [0.001, 0.5], longest_step: 0.05, most_points: 400 };
    let wanted = Search { revolutions: 1, impacts: Some(1) };
    curves(model, [rpm - 2.0, rpm + 2.0], &wanted, &[Bifurcation::Fold], &following, &Unwatched).unwrap()
}

/// The speed of the fold goes to that of the corner impact, with the slope of the closed form; by how much it is off is in
/// proportion to the angle.
#[test]
#[ignore = "slow"]
fn a_rounded_corner_moves_the_fold_in_proportion() {
    for name in ["osorio-2008", "damped-light", "damped-heavy", "overdamped", "sharp-nose", "preloaded", "ballistic"] {
        let model = model(name);
        let found = verify(&model, External::LeftOut).unwrap();
        let (Some(rounded), rpm) = (found.rounded_corner, found.at.speed_rpm()) else { panic!("{name}") };
        let Curves { curves, sharp, .. } = folds(&model, rpm);
        let off = |rpm: f64, degrees: f64| (rpm - found.at.speed_rpm()) / (rounded.rpm_per_degree * degrees) - 1.0;
        let nearest = |points: &[[f64; 2]]| points.iter().fold(f64::INFINITY, |least, point| least.min(point[1].abs()));
        let all = curves.iter().map(|curve| {
            let points = curve.points.iter().map(|point| [point.value, off(point.rpm, point.value)]);
            (points.collect::<Vec<_>>(), curve)
        });
        let curve = all.min_by(|one, two| nearest(&one.0).total_cmp(&nearest(&two.0)));
        let (mut points, curve) = curve.unwrap_or_else(|| panic!("{name}: no fold"));
        points.sort_by(|one, two| one[0].total_cmp(&two[0]));
        let ([least, last], count) = ([points[0], points[points.len() - 1]], points.len());
        assert!(
            (least[0] - 0.001).abs() < 1e-9 && (last[0] - 0.5).abs() < 1e-9 && count > 8,
            "{name}: {least:?} {last:?} {:?}",
            curve.ends
        );
        assert!(least[1].abs() < 2e-3 && last[1].abs() > 4.0 * least[1].abs(), "{name}: {least:?} {last:?}");
        let middle = points[count / 2];
        assert!((middle[1] / middle[0] / (last[1] / last[0]) - 1.0).abs() < 0.5, "{name}: {middle:?} {last:?}");
        let told = sharp.iter().find(|(at, _)| (at - rpm).abs() < 1e-9 * rpm).unwrap().1;
        assert!((told.rpm_per_degree / rounded.rpm_per_degree - 1.0).abs() < 1e-6, "{name}: {told:?} {rounded:?}");
        assert!((rounded.degrees * rounded.rpm_per_degree.abs() / 1e-4 - 1.0).abs() < 1e-12);
    }
    for name in ["persistence", "nonsmooth-flip"] {
        assert_eq!(verify(&model(name), External::LeftOut).unwrap().rounded_corner, None);
    }
}

/// Lift, slope and acceleration go on through each end of a rounding, and away from the corners nothing is changed.
#[test]
fn a_rounded_cam_meets_the_sharp_one() {
    for name in ["osorio-2008", "laws/program", "laws/polynomial"] {
        let sharp = model(name);
        for degrees in [1e-4, 0.01, 1.0] {
            let [sharp, round] =
                [0.0, degrees].map(|degrees| Cam::new(&sharp.with_number(ROUNDING, degrees).unwrap()).unwrap());
            let corners: Vec<_> = sharp.corners().iter().copied().filter(|corner| corner.jump_order == 2).collect();
            assert!(
                !corners.is_empty() && round.corners().iter().all(|corner| corner.jump_order > 2),
                "{name} {degrees}"
            );
            let segments = round.segments();
            for (after, segment) in segments.iter().enumerate() {
                let before = &segments[round.before(after)];
                let (minus, plus) = (before.law.lift(before.end), segment.law.lift(segment.start));
                let room = 1e-15 / degrees.to_radians().powi(2);
                assert_abs_diff_eq!(minus.value, plus.value, epsilon = 1e-15);
                assert_abs_diff_eq!(minus.slope, plus.slope, epsilon = 1e-15 + room * degrees.to_radians());
                assert_abs_diff_eq!(minus.curvature, plus.curvature, epsilon = 1e-14 + room);
            }
            for corner in corners {
                let half = 0.5 * degrees.to_radians();
                for beside in
                    [-1.001 * half, 1.001 * half].map(|turn| (corner.angle + turn).rem_euclid(std::f64::consts::TAU))
                {
                    assert_eq!(sharp.lift(beside), round.lift(beside), "{name} {degrees} {beside}");
                }
                let middle = round.lift(corner.angle);
                let mean = 0.5 * (corner.minus.curvature + corner.plus.curvature);
                assert!(
                    (middle.curvature - mean).abs() < 0.1 * corner.jump.abs(),
                    "{name} {degrees}: {middle:?} {mean}"
                );
            }
        }
    }
}

#[test]
fn a_rounding_that_cannot_be_is_refused() {
    let refused = |name: &str, degrees: f64| {
        let model = model(name).with_number(ROUNDING, degrees);
        let error = model.and_then(|model| Cam::new(&model)).unwrap_err();
        assert_eq!(error.field.as_deref(), Some(ROUNDING));
        error.allowed
    };
    assert_eq!(refused("osorio-2008", -1.0), "must be a finite number from 0 to 360");
    assert_eq!(refused("osorio-2008", 1e-5), "must be 0, or 0.0001 or more");
    // From P, at 150.18 degrees, to Q, at 160.
    assert!(refused("osorio-2008", 9.9).starts_with("must be below 9.82"), "{}", refused("osorio-2008", 9.9));
    // A dwell of 2 degrees that only begins at a corner has room for half of 3.9, and not for half of 4.1.
    let motions = [("dwell", 90.0, 0.0), ("harmonic", 60.0, 0.1), ("dwell", 2.0, 0.0), ("cycloidal", 208.0, -0.1)];
    let cam = |degrees: f64| {
        let text = format!(
            "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 1.0\ngravity = 0.0\nrest_position = 0.0\nrestitution = 0.5\n\
             [cam]\n{}",
            program(0.1, &motions)
        );
        Cam::new(&Model::parse("room.toml", &text).unwrap().with_number(ROUNDING, degrees).unwrap())
    };
    assert!(cam(3.9).is_ok() && cam(4.1).is_err());
    assert!(refused("laws/harmonic", 1.0).starts_with("must be 0: the acceleration of this cam has no jump"));
}
