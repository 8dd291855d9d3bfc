//! Does a fold move as is said where its corner is rounded?

use std::f64::consts::TAU;
use std::path::Path;

use crate::common;
use corner_impact::bracket::{Width, halve};
use corner_impact::flight::Flight;
use corner_impact::model::Model;
use corner_impact::study::verify::{External, Verification, verify};

/// Lift and slope at `turn` from the corner, which is rounded over `angle` by the polynomial of fifth degree that meets both
/// laws to the second derivative.
fn lift(model: &Model, found: &Verification, turn: f64, angle: f64) -> (f64, f64) {
    let (cam, corner) = (common::cam(model), found.at.corner);
    let before = &cam.segments()[cam.before(corner.segment)].law;
    let end = if corner.angle == 0.0 { TAU } else { corner.angle };
    let from = before.lift(end - 0.5 * angle);
    let to = cam.segments()[corner.segment].law.lift(corner.angle + 0.5 * angle);
    // In parts of the angle.
    let [p, dp, ddp] = [from.value, from.slope * angle, from.curvature * angle * angle];
    let [q, dq, ddq] = [to.value, to.slope * angle, to.curvature * angle * angle];
    let (a, b, c) = (q - p - dp - 0.5 * ddp, dq - dp - ddp, ddq - ddp);
    let [c3, c4, c5] = [10.0 * a - 4.0 * b + 0.5 * c, -15.0 * a + 7.0 * b - c, 6.0 * a - 3.0 * b + 0.5 * c];
    let x = turn / angle + 0.5;
    let value = p + x * (dp + x * (0.5 * ddp + x * (c3 + x * (c4 + x * c5))));
    let slope = dp + x * (ddp + x * (3.0 * c3 + x * (4.0 * c4 + x * 5.0 * c5)));
    (value, slope / angle)
}

/// The period of the orbit of one impact in one revolution at `turn` from the corner, near T*: it flies for a period from the
/// cam back to it, and the law of restitution asks for the speed that it leaves with.
fn period(model: &Model, found: &Verification, turn: f64, angle: f64) -> f64 {
    let (follower, flight) = (&model.follower, Flight::new(&model.follower));
    let (position, slope) = lift(model, found, turn, angle);
    let off = |period: f64| {
        let response = flight.response(period);
        let force = flight.force(position);
        let leaving = -force * response.step / response.impulse;
        let arriving = leaving * response.impulse_rate + force * response.impulse;
        leaving - (1.0 + follower.restitution) * TAU / period * slope + follower.restitution * arriving
    };
    let bracket = [0.995, 1.005].map(|part| part * found.at.period);
    let sign = off(bracket[0]).signum();
    assert!(sign != off(bracket[1]).signum(), "{bracket:?}");
    halve(bracket, Width::Relative(1e-15), |period| Ok::<_, ()>(off(period).signum() != sign)).unwrap()[0]
}

/// At the fold the period is the longest that any place of the rounding has, where orbits are there for faster speeds; and the
/// shortest where for slower. By how much, is off by the second power of the angle.
#[test]
fn a_rounded_corner_moves_the_fold_in_proportion() {
    for name in ["osorio-2008", "damped-light", "damped-heavy"] {
        let model = common::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("models/{name}.toml")));
        let found = verify(&model, External::LeftOut).unwrap();
        let Some(rounded) = found.rounded_corner else { panic!("{name}") };
        let faster = found.classification.as_ref().unwrap().minus.exists_for.to_string() == "faster";
        let off = |angle: f64| {
            let all = (0..=200).map(|index| period(&model, &found, angle * (f64::from(index) / 200.0 - 0.5), angle));
            let fold = if faster { all.fold(0.0, f64::max) } else { all.fold(f64::INFINITY, f64::min) };
            let moved = 60.0 / fold - 60.0 / found.at.period;
            moved / (rounded.rpm_per_degree * angle.to_degrees()) - 1.0
        };
        let [wide, narrow] = [0.004, 0.002].map(off);
        assert!(wide.abs() < 0.05 && (narrow / wide - 0.5).abs() < 0.1, "{name}: {rounded:?} {wide} {narrow}");
        assert!((rounded.degrees * rounded.rpm_per_degree.abs() / 1e-4 - 1.0).abs() < 1e-12);
    }
    for name in ["persistence", "nonsmooth-flip"] {
        let model = common::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("models/{name}.toml")));
        assert_eq!(verify(&model, External::LeftOut).unwrap().rounded_corner, None);
    }
}
