//! Does a branch, or a curve, that runs into the last value that the model allows have its last point on it, to the last bit, however wide or
//! narrow a range is asked for?

use corner_impact::model::Model;
use corner_impact::orbit::branch::{Branch, BranchPoint, End, Following, SpecialKind};
use corner_impact::orbit::{Course, Parameter};

use crate::orbit_numbers::{model, orbits};

const GRAVITY: f64 = 9.81;
const AMPLITUDE: f64 = 0.01;
const RPM: f64 = 400.0;

/// A ball on a table that goes up and down as a cosine.
pub fn ball(restitution: f64, damping: f64) -> Model {
    let text = format!(
        "[follower]\nmass = 1.0\ndamping = {damping:?}\nstiffness = 0.0\ngravity = {GRAVITY}\nrest_position = 0.0\n\
         restitution = {restitution:?}\n[cam]\nlaw = \"harmonic\"\noffset = 0.1\namplitudes = [{AMPLITUDE}]\n\
         phases_deg = [0.0]\n"
    );
    Model::parse("ball.toml", &text).unwrap()
}

fn following(model: &Model, parameter: &str, range: [f64; 2]) -> Following {
    Following { parameter: Parameter::named(model, parameter).unwrap(), range, longest_step: 0.05, most_points: 400 }
}

/// The branches of the orbits of one impact in one revolution.
fn branches(model: &Model, parameter: &str, range: [f64; 2]) -> Vec<Branch> {
    let one = orbits(model, RPM, 1).into_iter().filter(|orbit| orbit.impacts().count() == 1);
    one.map(|orbit| Branch::through(model, RPM, &orbit, &following(model, parameter, range)).unwrap()).collect()
}

/// `(1 - r) g T/2 = -(1 + r) w a sin theta`: a ball that loses nothing is met where the table stands still.
#[test]
fn a_ball_is_followed_to_where_it_loses_nothing() {
    for highest in [1.0 + 1e-6, 1.5, 1e4] {
        let found = branches(&ball(0.9, 0.0), "restitution", [0.85, highest]);
        assert_eq!(found.len(), 2);
        for branch in found {
            let last = branch.points.last().unwrap();
            assert!(
                matches!(&branch.ends, [End::Range, End::Edge { largest: true, .. }]),
                "{highest} {:?}",
                branch.ends
            );
            assert_eq!(last.value, 1.0, "{highest}");
            let impact = last.orbit.impacts().next().unwrap();
            assert!(impact.cam_angle.sin().abs() < 1e-8, "{highest} {impact:?}");
        }
    }
}

/// Where nothing changes on a short way, steps down from a branch's own value grow, but for the last, which ends at the bound.
#[track_caller]
fn is_reached_in_one_step(branch: &Branch, own: f64) {
    let values = branch.points[1..].iter().map(|point| point.value).take_while(|value| *value < 1.001 * own);
    let values: Vec<f64> = values.collect();
    let steps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let grow = steps.len() > 2 && steps.windows(2).all(|pair| pair[0] > 0.9 * pair[1]);
    assert!(grow, "{steps:?}");
}

/// Nor is there less damping than none: what is met there is the parabola.
#[test]
fn a_ball_is_followed_to_where_nothing_damps_it() {
    let period = 60.0 / RPM;
    for (own, lowest) in [(5e-4, -1e-3), (5e-4, -1.0), (0.5, -1e3)] {
        let found = branches(&ball(0.5, own), "damping", [lowest, 2.0 * own]);
        assert_eq!(found.len(), 2);
        for branch in found {
            let first = &branch.points[0];
            assert!(matches!(&branch.ends, [End::Edge { largest: false, .. }, End::Range]), "{own} {:?}", branch.ends);
            assert_eq!(first.value, 0.0, "{own}");
            if lowest == -1e-3 {
                is_reached_in_one_step(&branch, own);
            }
            let impact = first.orbit.impacts().next().unwrap();
            assert!((impact.velocity_before + 0.5 * GRAVITY * period).abs() < 1e-8, "{own} {impact:?}");
        }
    }
}

/// A value beside which the cam has other segments is a bound, and no angle far beyond it tells otherwise.
#[test]
fn a_bound_on_both_sides_is_told_however_wide_the_range_is() {
    let model = model("osorio-2008");
    let orbits = orbits(&model, 700.0, 1);
    for highest in [2.0, 200.0] {
        let number = following(&model, "corner_rounding_deg", [-1.0, highest]);
        let branch = Branch::through(&model, 700.0, &orbits[0], &number).unwrap();
        let [End::Edge { largest: false, .. }, End::Edge { largest: true, why }] = &branch.ends else {
            panic!("{highest} {:?}", branch.ends)
        };
        assert!(branch.points.len() == 1 && why.contains("segments"), "{highest} {why}");
    }
}

/// The branch of the orbits that rest at a speed.
fn resting(model: &Model, rpm: f64, number: &Following) -> Branch {
    let orbits = orbits(model, rpm, 1);
    let rests = orbits.iter().find(|orbit| matches!(orbit.course, Course::Sticking(_))).unwrap();
    Branch::through(model, rpm, rests, number).unwrap()
}

/// A cam that turns slowly carries its follower, whatever damps it, and however heavy both are.
#[test]
fn a_follower_on_the_cam_is_followed_to_where_nothing_damps_it() {
    let model = model("laws/harmonic");
    let numbers = ["mass", "damping", "stiffness"];
    for (own, beyond) in [(1.0, 1.0001), (1.0, 1.001), (1.0, 1.7), (2.0_f64.powi(40), 1.001), (2.0_f64.powi(40), 3.3)] {
        let heavy = [1.0, 1.0, 400.0].iter().zip(numbers);
        let heavy = heavy.fold(model.clone(), |model, (number, name)| {
            model.with_number(&format!("follower.{name}"), number * own).unwrap()
        });
        let branch = resting(&heavy, 100.0, &following(&heavy, "damping", [-beyond * own, 1.5 * own]));
        assert!(matches!(&branch.ends, [End::Edge { largest: false, .. }, End::Range]), "{own} {:?}", branch.ends);
        assert_eq!(branch.points[0].value, 0.0, "{own} {beyond}");
    }
}

/// One that rests may give back all that it comes with, and no more.
#[test]
fn a_follower_on_the_cam_is_followed_to_where_it_loses_nothing() {
    let model = model("laws/harmonic");
    for highest in [1.25, 1.7, 40.0] {
        let branch = resting(&model, 100.0, &following(&model, "restitution", [0.5, highest]));
        assert!(matches!(&branch.ends, [End::Range, End::Edge { largest: true, .. }]), "{highest} {:?}", branch.ends);
        assert_eq!(branch.points.last().unwrap().value, 1.0, "{highest}");
    }
}

/// The curve of where a follower that rests at a speed leaves the cam.
fn detachment(model: &Model, rpm: f64, speeds: [f64; 2], number: &Following) -> Branch {
    let branch = resting(model, rpm, &following(model, "rpm", speeds));
    let is_it = |point: &&BranchPoint| point.special.is_some_and(|special| special.kind == SpecialKind::Detachment);
    let leaves = branch.points.iter().find(is_it).unwrap();
    Branch::of_event(model, leaves, speeds, number).unwrap().unwrap()
}

/// `k (rest - c) - m g = m w^2 c''` at the place, where nothing damps it.
#[test]
fn a_detachment_is_followed_to_where_nothing_damps_the_follower() {
    for (own, lowest) in [(5e-5, -1e-5), (5e-3, -2.0), (0.5, -1e4)] {
        let model = model("laws/harmonic").with_number("follower.damping", own).unwrap();
        let number = following(&model, "damping", [lowest, 2.0 * own]);
        let curve = detachment(&model, 310.0, [300.0, 420.0], &number);
        assert!(matches!(&curve.ends, [End::Edge { largest: false, .. }, End::Range]), "{own} {:?}", curve.ends);
        assert_eq!(curve.points[0].value, 0.0, "{own}");
        if lowest == -1e-5 {
            is_reached_in_one_step(&curve, own);
        }
    }
}

/// A nose of half a turn is the widest.
#[test]
fn a_detachment_is_followed_to_the_widest_nose() {
    let model = model("osorio-2008");
    for highest in [181.0, 1e4, 1e6] {
        let number = following(&model, "nose_end_deg", [150.0, highest]);
        let curve = detachment(&model, 112.0, [100.0, 130.0], &number);
        assert!(matches!(&curve.ends, [End::Range, End::Edge { largest: true, .. }]), "{highest} {:?}", curve.ends);
        assert_eq!(curve.points.last().unwrap().value, 180.0, "{highest}");
    }
}

/// Beside the flip of one impact a turn an undamped ball repeats after two turns; next to no damping makes it repeat after one, a part of a first
/// step from where no less is allowed.
#[test]
fn a_branch_from_a_bound_ends_at_a_flip_close_by() {
    let model = ball(0.5, 0.0);
    let number = following(&model, "rpm", [360.0, 380.0]);
    let one = orbits(&model, 369.0, 1).into_iter().filter(|orbit| orbit.impacts().count() == 1);
    let mut points = one.flat_map(|orbit| Branch::through(&model, 369.0, &orbit, &number).unwrap().points);
    let is_flip = |point: &BranchPoint| point.special.is_some_and(|special| special.kind == SpecialKind::Flip);
    let rpm = points.find(is_flip).unwrap().value + 1e-3;
    let twice: Vec<_> = orbits(&model, rpm, 2).into_iter().filter(|orbit| orbit.impacts().count() == 2).collect();
    let [orbit] = &twice[..] else { panic!("{twice:?}") };
    let number = Following { longest_step: 1.0, ..following(&model, "damping", [0.0, 0.5]) };
    let branch = Branch::through(&model, rpm, orbit, &number).unwrap();
    let values: Vec<f64> = branch.points.iter().map(|point| point.value).collect();
    let [bound, flip] = &branch.points[..] else { panic!("{values:?}") };
    assert!(branch.ends[1] == End::Shorter && is_flip(flip), "{:?} {values:?}", branch.ends);
    assert!(bound.value == 0.0 && (1e-6..1e-3).contains(&flip.value), "{values:?}");
    let [one, two] = flip.orbit.multipliers().map(|multiplier| multiplier.re);
    assert!(flip.orbit.revolutions == 1 && (one.min(two) + 1.0).abs() < 1e-9, "{one} {two}");
}
