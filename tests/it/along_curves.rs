//! Does a curve in two numbers keep what its event promises: where it is on the cam, in whatever unit, and however the cam is turned?

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

use corner_impact::cam::apart;
use corner_impact::model::Model;
use corner_impact::orbit::branch::{Bifurcation, Branch, BranchPoint, End, Following, SpecialKind};
use corner_impact::orbit::{Parameter, Search};
use corner_impact::progress::Unwatched;
use corner_impact::simulate::{Event, EventKind, Goal, angular_velocity};
use corner_impact::study::curve::curves;
use serde_json::{Value, json};

use crate::bounds::ball;
use crate::orbit_numbers::{machine, model, orbits};
use crate::random::{cases_of_every_law, drawn};
use crate::scales::in_units;

fn following(model: &Model, parameter: &str, range: [f64; 2], longest_step: f64) -> Following {
    Following { parameter: Parameter::named(model, parameter).unwrap(), range, longest_step, most_points: 200 }
}

/// The points of a kind on the branches of the orbits at a speed, rpm, of so many revolutions.
fn points(model: &Model, rpm: f64, revolutions: u64, speeds: [f64; 2], name: &str) -> Vec<BranchPoint> {
    let through = |orbit| Branch::through(model, rpm, orbit, &following(model, "rpm", speeds, 0.05)).unwrap();
    let branches: Vec<Branch> = orbits(model, rpm, revolutions).iter().map(through).collect();
    let all = branches.into_iter().flat_map(|branch| branch.points);
    all.filter(|point| point.special.is_some_and(|it| it.kind.name() == name)).collect()
}

fn curve(model: &Model, point: &BranchPoint, speeds: [f64; 2], following: &Following) -> Branch {
    Branch::of_event(model, point, speeds, following).unwrap().unwrap()
}

/// The names of what changes along a curve, but for the event that it begins at.
fn changes(curve: &Branch, event: &str) -> Vec<&'static str> {
    let names = curve.points.iter().filter_map(|point| point.special).map(|special| special.kind.name());
    names.filter(|name| *name != event).collect()
}

/// The flank begins at the angle that is followed, and an impact that is at its beginning stays there, on whichever side of it.
#[test]
fn an_impact_on_a_corner_that_moves_goes_with_it() {
    let (model, speeds) = (model("osorio-2008"), [640.0, 780.0]);
    let number = following(&model, "flank_start_deg", [63.0, 117.0], 0.05);
    let corners = points(&model, 736.0, 1, speeds, "corner");
    let mut followed = 0;
    for corner in
        corners.iter().filter(|corner| matches!(corner.special.unwrap().kind, SpecialKind::Corner { segment: 1, .. }))
    {
        let curve = curve(&model, corner, speeds, &number);
        assert_eq!(curve.ends, [End::Range, End::Range], "{corner:?}");
        for point in &curve.points {
            let place = point.held.as_ref().unwrap().cam_angle;
            assert!((place - point.value.to_radians()).abs() < 1e-9, "{point:?}");
        }
        followed += 1;
    }
    assert!(followed > 0, "{corners:?}");
}

/// A curve that has one point, beyond which the touch is none, has not come back to it.
#[test]
fn a_curve_of_one_point_is_not_closed() {
    let case = drawn(cases_of_every_law(), 28).pop().unwrap();
    let (model, speeds) = (&case.model, [0.8 * case.rpm, 1.25 * case.rpm]);
    let own = model.follower.restitution;
    let number = following(model, "restitution", [0.7 * own, (1.3 * own).min(0.99)], 0.05);
    let grazes = points(model, case.rpm, 2, speeds, "graze");
    let curves: Vec<Branch> = grazes.iter().map(|graze| curve(model, graze, speeds, &number)).collect();
    let short: Vec<&Branch> = curves.iter().filter(|curve| curve.points.len() == 1).collect();
    let ends: Vec<_> = short.iter().map(|curve| &curve.ends).collect();
    assert!(
        ends.contains(&&[End::Graze, End::Graze]) && !ends.iter().any(|ends| ends.contains(&End::Closed)),
        "{ends:?}"
    );
}

/// Of places that are alike but for rounding none comes before the other, whatever rounding is in the model's units.
#[test]
#[ignore = "slow"]
fn a_cam_that_is_its_own_mirror_image_lets_go_at_two_places_in_any_unit() {
    for scales in [[0, 0, 0], [40, 0, 0], [-40, 0, 0], [0, -20, 0], [0, 0, -20], [0, 0, 20]] {
        let model = in_units("osorio-2008", scales);
        let [low, rpm, high] = [100.0, 110.0, 120.0].map(|rpm: f64| rpm * 2.0_f64.powi(-scales[2]));
        let leaves = points(&model, rpm, 1, [low, high], "detachment");
        let number = following(&model, "flank_start_deg", [60.0, 120.0], 0.05);
        let curve = curve(&model, &leaves[0], [low, high], &number);
        assert_eq!(curve.ends, [End::Range, End::Range], "{scales:?}");
        assert_eq!(changes(&curve, "detachment"), Vec::<&str>::new(), "{scales:?}");
        assert!(curve.points.iter().all(|point| point.orbit.residual < 1e-9), "{scales:?}");
    }
}

/// An eccentric that is turned on its shaft throws a follower off at the same speed, at a place that turns with it.
#[test]
fn a_cam_that_is_turned_lets_go_at_one_speed() {
    let model = model("laws/harmonic").with_number("cam.amplitudes[1]", 0.0).unwrap();
    let speeds = [200.0, 500.0];
    let leaves = points(&model, 300.0, 1, speeds, "detachment");
    let number = following(&model, "phases_deg[0]", [30.0, 330.0], 0.1);
    let curve = curve(&model, &leaves[0], speeds, &number);
    assert_eq!((&curve.ends, changes(&curve, "detachment")), (&[End::Range, End::Range], Vec::new()));
    let place = |point: &BranchPoint| point.held.as_ref().unwrap().cam_angle + point.value.to_radians();
    for point in &curve.points {
        assert!((point.rpm / curve.points[0].rpm - 1.0).abs() < 1e-9, "{point:?}");
        let moved = apart(place(point).rem_euclid(TAU), place(&curve.points[0]).rem_euclid(TAU));
        assert!(moved < 1e-6, "{moved} {point:?}");
    }
}

/// The cam has two like lobes, and the follower rests behind each: its flight goes from one rest to the other. Where both end is seen on
/// the branches of machines that give back a little more.
#[test]
fn an_onset_of_resting_may_be_of_two_rests_at_once() {
    let with = |restitution: f64| {
        let text = format!(
            "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 400.0\ngravity = 9.81\nrest_position = 0.08\n\
             restitution = {restitution:?}\n[cam]\nlaw = \"harmonic\"\noffset = 0.1\namplitudes = [0.0, 0.02]\n\
             phases_deg = [180.0, 0.0]\n"
        );
        Model::parse("two-lobes.toml", &text).unwrap()
    };
    let (own, speeds) = (with(0.3), [170.0, 300.0]);
    let ends = points(&own, 190.0, 1, speeds, "chatter");
    let [end] = &ends[..] else { panic!("{ends:?}") };
    let releases = end.orbit.events.iter().filter(|event| event.kind == EventKind::Release).count();
    assert_eq!(releases, 2, "{end:?}");
    let curve = curve(&own, end, speeds, &following(&own, "restitution", [0.3, 0.35], 0.2));
    assert_eq!(curve.ends, [End::Range, End::Range], "{:?}", curve.points.len());
    let last = curve.points.last().unwrap();
    let there = points(&with(last.value), 190.0, 1, speeds, "chatter");
    assert!((there[0].rpm / last.rpm - 1.0).abs() < 1e-7, "{} {}", there[0].rpm, last.rpm);
}

/// Where an impact is next to a touch, a curve ends at a graze, whatever the units of length and of time.
#[test]
fn an_end_at_a_graze_is_one_in_any_unit() {
    for scales in [[0, 0, 0], [20, 0, 0], [-20, 0, 0], [0, 0, -20], [0, 0, 20]] {
        let model = in_units("laws/rectified-sine", scales);
        let [length, time] = [scales[0], scales[2]].map(|power: i32| 2.0_f64.powi(power));
        let speeds = [12.0, 50.0].map(|rpm| rpm / time);
        let number = following(&model, "rest_position", [-0.5, 2.0].map(|at| at * length), 0.05);
        let flips = points(&model, 25.0 / time, 1, speeds, "flip");
        let curve = curve(&model, &flips[0], speeds, &number);
        assert_eq!(curve.ends, [End::Range, End::Graze], "{scales:?}");
        assert_eq!(changes(&curve, "flip"), Vec::<&str>::new(), "{scales:?}");
    }
}

/// The curve of a touch goes on to where the other impact of the orbit is none: what is left there meets the cam in the touch alone.
#[test]
fn a_curve_of_touches_ends_where_no_other_impact_is_left() {
    let case = drawn(cases_of_every_law(), 28).pop().unwrap();
    let speeds = [0.8 * case.rpm, 1.25 * case.rpm];
    let own = case.model.numbers().find(|(name, _)| *name == "follower.stiffness").unwrap().1;
    let number = following(&case.model, "stiffness", [0.7 * own, 1.3 * own], 0.05);
    let grazes = points(&case.model, case.rpm, 2, speeds, "graze");
    let ends: Vec<_> = grazes.iter().flat_map(|graze| curve(&case.model, graze, speeds, &number).ends).collect();
    assert!(ends.contains(&End::Graze), "{ends:?}");
}

/// Many branches pass one event, of which a curve that goes no further has one point.
#[test]
#[ignore = "slow"]
fn an_event_that_many_branches_pass_is_one() {
    for (revolutions, speeds, time) in [(2, [505.0, 525.0], 0), (2, [500.0, 530.0], -30)] {
        let model = in_units("laws/harmonic", [0, 0, time]);
        let number = Following { most_points: 0, ..following(&model, "restitution", [0.45, 0.9], 0.05) };
        let speeds = speeds.map(|rpm: f64| rpm * 2.0_f64.powi(-time));
        let wanted = Search { revolutions, impacts: None };
        let found = curves(&model, speeds, &wanted, &Bifurcation::ALL, &number, &Unwatched).unwrap().curves;
        let events: Vec<_> = found.iter().map(|curve| (curve.kind.name(), curve.points[0].rpm)).collect();
        assert!(found.iter().all(|curve| curve.points.len() == 1) && !events.is_empty(), "{events:?}");
        for (index, (name, rpm)) in events.iter().enumerate() {
            let again = events[..index].iter().any(|(other, at)| other == name && (at / rpm - 1.0).abs() < 1e-6);
            assert!(!again, "{name} {events:?}");
        }
    }
}

/// With the phase of the second harmonic a touch comes back to where it was. On the way another flight begins to hit the cam and ceases
/// to, before the touch in the motion: the touch stays the same one, of a flight that goes on.
#[test]
fn a_touch_stays_itself_while_another_impact_comes_and_goes() {
    let (model, speeds) = (model("laws/harmonic"), [420.0, 640.0]);
    let grazes = points(&model, 500.0, 2, speeds, "graze");
    let graze = grazes.iter().find(|graze| (graze.rpm - 475.144).abs() < 1e-3).unwrap();
    let curve = curve(&model, graze, speeds, &following(&model, "phases_deg[1]", [-180.0, 180.0], 0.05));
    assert_eq!(curve.ends, [End::Closed, End::Closed]);
    let impacts = |point: &BranchPoint| point.orbit.impacts().count();
    let all: Vec<usize> = curve.points.iter().filter(|point| point.special.is_none()).map(impacts).collect();
    assert_eq!(all.chunk_by(|one, two| one == two).map(|alike| alike[0]).collect::<Vec<_>>(), [3, 4, 3], "{all:?}");
    // The other impact comes and goes at a touch of its own.
    let others: Vec<f64> =
        curve.points.iter().filter(|point| point.special.is_some()).map(|point| point.value).collect();
    assert!(others.len() == 3 && others.contains(&0.0), "{others:?}");
    let places: Vec<f64> = curve.points.iter().map(|point| point.held.as_ref().unwrap().cam_angle).collect();
    assert!(places.windows(2).all(|pair| apart(pair[0], pair[1]) < 0.1), "{places:?}");
}

/// At half the speed a cam of two like lobes is the same machine, with two impacts in a revolution for one.
#[test]
fn a_cusp_is_where_it_is_with_two_lobes_for_one() {
    let cusps = |amplitudes: &str, phases: &str, lobes: usize, name: &str| {
        let text = format!(
            "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 400.0\ngravity = 9.81\nrest_position = 0.08\n\
             restitution = 0.6\n[cam]\nlaw = \"harmonic\"\noffset = 0.1\namplitudes = [{amplitudes}]\nphases_deg = [{phases}]\n"
        );
        let model = Model::parse("lobes.toml", &text).unwrap();
        let [low, rpm, high] = [480.0, 500.0, 510.0].map(|rpm| rpm / lobes as f64);
        let folds = points(&model, rpm, 1, [low, high], "fold");
        let like = folds.iter().filter(|fold| fold.orbit.impacts().count() == lobes);
        let fold = like.max_by(|one, two| one.rpm.total_cmp(&two.rpm)).unwrap();
        let number = Following { most_points: 20, ..following(&model, name, [-52.0, -40.0], 0.3) };
        let curve = curve(&model, fold, [low, high], &number);
        let is_cusp = |point: &&BranchPoint| point.special.is_some_and(|special| special.kind == SpecialKind::Cusp);
        let cusps = curve.points.iter().filter(is_cusp).map(|cusp| [cusp.value, cusp.rpm * lobes as f64]);
        let mut cusps: Vec<[f64; 2]> = cusps.collect();
        cusps.sort_by(|one, two| one[0].total_cmp(&two[0]));
        cusps
    };
    let one = cusps("0.02, 0.004", "180.0, -50.0", 1, "phases_deg[1]");
    let two = cusps("0.0, 0.02, 0.0, 0.004", "0.0, 180.0, 0.0, -50.0", 2, "phases_deg[3]");
    assert!(one.len() == 1 && two.len() == 1, "{one:?} {two:?}");
    for (one, two) in one.iter().zip(&two) {
        assert!((one[0] - two[0]).abs() < 1e-6 && (one[1] / two[1] - 1.0).abs() < 1e-9, "{one:?} {two:?}");
    }
}

/// Of two lobes the lower is the less curved and the less pressed: with the stiffness that changes which throws off first, both at speeds
/// that rise, `w^2 = (k (c - rest)/m + g)/(-c'')` at their tops. So it is from either side.
#[test]
fn which_of_two_lobes_throws_off_first_is_told_at_the_lesser_speed() {
    let [small, large] = [0.004, 0.01];
    let name = "follower.stiffness";
    let like = model("laws/harmonic").with_number("cam.amplitudes[0]", small).unwrap();
    let like = like.with_number("cam.amplitudes[1]", large).unwrap().with_number("follower.restitution", 0.2).unwrap();
    let follower = &like.follower;
    let speeds = |stiffness: f64| {
        [-1.0, 1.0].map(|sign| {
            let pressed = 0.1 + large + sign * small - follower.rest_position;
            let force = stiffness * pressed / follower.mass + follower.gravity;
            (force / (4.0 * large + sign * small)).sqrt() * 60.0 / TAU
        })
    };
    // As it is a lobe is at angle 0.
    let radian = 1.0_f64.to_degrees();
    for (own, turned) in [(700.0, 0.0), (1100.0, 0.0), (1100.0, radian), (700.0, 50.0), (1100.0, 50.0)] {
        let phases = [("cam.phases_deg[0]", 180.0 - turned), ("cam.phases_deg[1]", 360.0 - 2.0 * turned)];
        let turned =
            phases.iter().try_fold(like.clone(), |model, (name, phase)| model.with_number(name, *phase)).unwrap();
        let model = turned.with_number(name, own).unwrap();
        let [one, two] = speeds(own);
        let rpm = one.min(two);
        let range = [0.9 * rpm, 1.1 * rpm];
        let leaves = points(&model, 0.95 * rpm, 1, range, "detachment");
        let curve = curve(&model, &leaves[0], range, &following(&model, "stiffness", [600.0, 1500.0], 0.05));
        assert_eq!(
            (&curve.ends, &changes(&curve, "detachment")[..]),
            (&[End::Range, End::Range], &["place"][..]),
            "{own}"
        );
        for point in &curve.points {
            let [one, two] = speeds(point.value);
            assert!((point.rpm / one.min(two) - 1.0).abs() < 1e-9, "{one} {two} {point:?}");
        }
    }
}

/// Behind the touch in the motion an impact ceases to be one: the touch stays where it was, and the curve goes on with an impact less.
#[test]
fn a_touch_stays_itself_where_a_later_impact_is_none() {
    let (model, speeds) = (model("osorio-2008"), [550.0, 580.0]);
    let grazes = points(&model, 560.0, 2, speeds, "graze");
    let graze = grazes.iter().find(|graze| (graze.rpm - 574.0752).abs() < 1e-3).unwrap();
    let number = Following { most_points: 60, ..following(&model, "flank_start_deg", [89.0, 120.0], 0.05) };
    let curve = curve(&model, graze, [480.0, 580.0], &number);
    let impacts: Vec<usize> = curve.points.iter().map(|point| point.orbit.impacts().count()).collect();
    let counts: Vec<usize> = impacts.chunk_by(|one, two| one == two).map(|alike| alike[0]).collect();
    let less = changes(&curve, "corner");
    assert!(counts == [4, 3] && less == ["graze", "graze"], "{counts:?} {less:?} {:?}", curve.ends);
    let places: Vec<f64> = curve.points.iter().map(|point| point.held.as_ref().unwrap().cam_angle).collect();
    assert!(places.windows(2).all(|pair| apart(pair[0], pair[1]) < 0.02), "{places:?}");
    assert!(impacts.iter().filter(|count| **count == 3).count() > 10, "{impacts:?}");
}

/// To turn an eccentric by a whole turn and more changes nothing but where angle 0 is.
#[test]
fn where_a_follower_leaves_an_eccentric_may_pass_angle_0() {
    let model = model("laws/harmonic").with_number("cam.amplitudes[1]", 0.0).unwrap();
    let speeds = [310.0, 420.0];
    for name in ["detachment", "chatter"] {
        let found = points(&model, 340.0, 1, speeds, name);
        let turned = following(&model, "phases_deg[0]", [-90.0, 400.0], 0.05);
        let curve = curve(&model, &found[0], speeds, &turned);
        assert_eq!((&curve.ends, changes(&curve, name)), (&[End::Range, End::Range], Vec::new()), "{name}");
        let off = |point: &BranchPoint| (point.rpm / found[0].rpm - 1.0).abs();
        let most = curve.points.iter().map(off).fold(0.0, f64::max);
        assert!(most < 1e-8 && curve.points.len() > 20, "{name} {most:e} {}", curve.points.len());
    }
}

/// Between rows of a cubic table the acceleration of the cam is a straight line, so that it throws off most at a row: an eccentric at its
/// top, where of rows that are `h` apart it is `-6 (1 - cos h)/(h^2 (2 + cos h))` of the amplitude.
#[test]
fn a_table_lets_go_at_a_row_where_its_acceleration_has_a_kink() {
    let like = model("laws/harmonic");
    let (follower, amplitude) = (&like.follower, 0.02);
    let lift = |degrees: f64| 0.1 + amplitude * (degrees - 200.0).to_radians().cos();
    let rows: Vec<[f64; 2]> = (0..36).map(|row| 10.0 * f64::from(row)).map(|angle| [angle, lift(angle)]).collect();
    let cam = json!({ "law": "table", "spline": "cubic", "rows": rows });
    let model = Model::of_document("rows", &json!({ "follower": follower, "cam": cam })).unwrap();
    let apart = 10.0_f64.to_radians();
    let curvature = amplitude * 6.0 * (1.0 - apart.cos()) / (apart * apart * (2.0 + apart.cos()));
    let speed = |stiffness: f64| {
        let pressed = 0.1 + amplitude - follower.rest_position;
        ((stiffness * pressed / follower.mass + follower.gravity) / curvature).sqrt() * 60.0 / TAU
    };
    let own = speed(follower.stiffness);
    let speeds = [0.95 * own, 1.05 * own];
    let leaves = points(&model, 0.97 * own, 1, speeds, "detachment");
    let curve = curve(&model, &leaves[0], speeds, &following(&model, "stiffness", [100.0, 900.0], 0.1));
    assert_eq!((&curve.ends, changes(&curve, "detachment")), (&[End::Range, End::Range], Vec::new()));
    for point in &curve.points {
        let place = point.held.as_ref().unwrap().cam_angle.to_degrees();
        assert!((place - 200.0).abs() < 1e-9, "{place}");
        assert!((point.rpm / speed(point.value) - 1.0).abs() < 1e-9, "{point:?}");
    }
    assert!(curve.points.len() > 5);
}

/// Of a cam of rows, one just before the place where it lets go of the follower: nearly all impacts before a rest are on the segment before
/// that row. Where the cam's angles are counted from changes nothing, from that row included.
#[test]
fn an_onset_of_resting_behind_a_row_is_where_it_is_on_a_cam_that_is_turned() {
    let like = model("laws/harmonic").with_number("follower.restitution", 0.3).unwrap();
    // Where its lift has to be highest, in degrees, for a cam to let go at 140.
    for (spline, highest) in [("quintic", 202.782), ("cubic", 202.872)] {
        for behind in [0.004, 0.02, 0.3] {
            let onset = |turned: f64| {
                let lift = |degrees: f64| 0.1 + 0.02 * (degrees - highest - behind - turned).to_radians().cos();
                let rows: Vec<_> = (0..36).map(|row| 10.0 * f64::from(row)).map(|at| [at, lift(at)]).collect();
                let cam = json!({ "law": "table", "spline": spline, "rows": rows });
                let model = Model::of_document("rows", &json!({ "follower": &like.follower, "cam": cam })).unwrap();
                let speeds = [400.0, 600.0];
                let ends = points(&model, 430.0, 1, speeds, "chatter");
                let [end] = &ends[..] else { panic!("{spline} {behind}: {ends:?}") };
                curve(&model, end, speeds, &following(&model, "stiffness", [399.0, 401.0], 0.2)).points
            };
            let one = onset(0.0);
            let at = |point: &BranchPoint| point.held.as_ref().unwrap().cam_angle.to_degrees() - 140.0;
            assert!(
                one.iter().all(|point| (0.0..2.0 * behind + 0.02).contains(&at(point))),
                "{:?}",
                one.iter().map(at).collect::<Vec<_>>()
            );
            for turned in [220.0, 70.0] {
                let other = onset(turned);
                assert_eq!(one.len(), other.len(), "{spline} {behind} {turned}");
                for (one, other) in one.iter().zip(&other) {
                    let moved = (other.value / one.value - 1.0).abs().max((other.rpm / one.rpm - 1.0).abs());
                    assert!(moved < 1e-11, "{spline} {behind} {turned}: {one:?} {other:?}");
                }
            }
        }
    }
}

/// The events of some kinds at some speeds, of orbits of one impact.
fn events(follower: &Value, cam: &Value, wanted: &[Bifurcation], speeds: [f64; 2]) -> Vec<(SpecialKind, f64)> {
    let model = Model::of_document("events", &json!({ "follower": follower, "cam": cam })).unwrap();
    let number = Following { most_points: 0, ..following(&model, "restitution", [0.05, 0.9], 0.05) };
    let search = Search { revolutions: 1, impacts: Some(1) };
    let found = curves(&model, speeds, &search, wanted, &number, &Unwatched).unwrap().curves;
    found.iter().map(|curve| (curve.kind, curve.points[0].rpm)).collect()
}

/// A ball's orbits of one impact turn round where the table's velocity is greatest, which is on a row: the impact is on a corner there,
/// too, and each of the two events has its curve.
#[test]
fn two_events_of_one_orbit_are_two() {
    let fold = (PI * 9.81 * 0.2 / 1.8 / 0.001).sqrt() * 60.0 / TAU;
    let lift = |degrees: f64| 0.001 * degrees.to_radians().cos();
    let rows: Vec<[f64; 2]> = (0..24).map(|row| 15.0 * f64::from(row)).map(|angle| [angle, lift(angle)]).collect();
    let follower = serde_json::to_value(ball(0.8, 0.0).follower).unwrap();
    let cam = json!({ "law": "table", "spline": "quintic", "rows": rows });
    let found = events(&follower, &cam, &Bifurcation::ALL, [0.999 * fold, 1.001 * fold]);
    let [(SpecialKind::Corner { segment: 18, .. }, corner), (SpecialKind::Fold, there)] = found[..] else {
        panic!("{found:?}")
    };
    assert!((corner / there - 1.0).abs() < 1e-9 && (there / fold - 1.0).abs() < 1e-3, "{found:?} {fold}");
}

/// A follower that hovers above the cam is hit in the middle of a short rise, where the acceleration jumps, and swings six times, or
/// seven, until it is hit there again: the orbit is at one place of the cam at two speeds. With the frequency w of the spring, and x the
/// lift below where it is at rest, the phase says `pi w/omega = pi n - atan(c' (1 + r)/(1 - r) omega/w/x)`.
#[test]
fn an_impact_on_one_corner_at_two_speeds_is_two_events() {
    let [restitution, rise, span_deg, base, rest] = [0.1, 0.01, 25.0_f64, 0.1, 0.111];
    let frequency = 7.718 * 302.0 * TAU / 60.0;
    let segment =
        [("dwell", 100.0, 0.0), ("parabolic", span_deg, rise), ("parabolic", span_deg, -rise), ("dwell", 210.0, 0.0)]
            .map(|(motion, span, rise)| json!({ "motion": motion, "span_deg": span, "rise": rise }));
    let follower = json!({
        "mass": 1.0, "damping": 0.0, "stiffness": frequency * frequency, "gravity": 0.0, "rest_position": rest,
        "restitution": restitution
    });
    let cam = json!({ "law": "program", "base": base, "segment": segment });
    let found = events(&follower, &cam, &[Bifurcation::Corner], [300.0, 351.0]);
    assert!(found.len() == 2 && found[0].0 == found[1].0, "{found:?}");
    let slope = 2.0 * rise / span_deg.to_radians() * (1.0 + restitution) / (1.0 - restitution);
    for ((_, rpm), swings) in found.iter().zip([8.0, 7.0]) {
        let ratio = frequency / angular_velocity(*rpm);
        let phase = PI * swings - (slope / ratio / (rest - base - 0.5 * rise)).atan();
        assert!((PI * ratio - phase).abs() < 1e-9, "{rpm} {}", ratio - phase / PI);
    }
}

/// The curve of the onset of resting from one value of a number to another, past a kink: it comes to the speed at which branches of the
/// machine with that value have the event.
fn past_a_kink(name: &str, number: &str, rpm: f64, [from, to]: [f64; 2]) {
    let [(own, onset), (_, there)] = [from, to].map(|value| {
        let model = model(name).with_number(number, value).unwrap();
        let onset = points(&model, 0.99 * rpm, 1, [0.99 * rpm, 1.02 * rpm], "chatter").pop().unwrap();
        (model, onset)
    });
    let number = following(&own, number, [from.min(to), from.max(to)], 0.5);
    let curve = curve(&own, &onset, [0.9 * rpm, 1.1 * rpm], &number);
    assert_eq!((&curve.ends, &changes(&curve, "chatter")[..]), (&[End::Range, End::Range], &["corner"][..]));
    let ends = [&curve.points[0], curve.points.last().unwrap()].map(|point| point.rpm);
    let off = ends.map(|end| (end / there.rpm - 1.0).abs());
    assert!(off[0].min(off[1]) < 1e-9, "{ends:?} {}", there.rpm);
}

/// An impact on the way to the rest is at a corner, beyond which the curve goes on in hardly another direction.
#[test]
fn an_onset_of_resting_goes_on_where_it_turns_a_little() {
    past_a_kink("preloaded", "cam.flank_radius", 392.0, [0.5560, 0.553]);
}

/// The same where it goes almost back to where it came from, which it did along a bend.
#[test]
#[ignore = "slow"]
fn an_onset_of_resting_goes_on_where_it_turns_back() {
    past_a_kink("osorio-2008", "cam.flank_start_deg", 200.2, [49.0, 45.0]);
}

/// A follower that hovers above the cam swings to its lowest place between two impacts on the middle of a rise. The more an impact gives
/// back, the lower that is, `x - h/2` below it where the flight touches the dwell, and the curve of the corner impact goes on beyond with
/// another impact there.
#[test]
fn a_corner_impact_stays_itself_where_the_flight_from_it_touches() {
    let [rise, span_deg, base, rest] = [0.01, 100.0_f64, 0.1, 0.111];
    let frequency = 100.0;
    let segment =
        [("dwell", 60.0, 0.0), ("parabolic", span_deg, rise), ("parabolic", span_deg, -rise), ("dwell", 100.0, 0.0)]
            .map(|(motion, span, rise)| json!({ "motion": motion, "span_deg": span, "rise": rise }));
    let follower = json!({
        "mass": 1.0, "damping": 0.0, "stiffness": frequency * frequency, "gravity": 0.0, "rest_position": rest,
        "restitution": 0.1
    });
    let cam = json!({ "law": "program", "base": base, "segment": segment });
    let model = Model::of_document("hovers", &json!({ "follower": follower, "cam": cam })).unwrap();
    let corners = points(&model, 560.0, 1, [555.0, 565.0], "corner");
    let curve = curve(&model, &corners[0], [500.0, 650.0], &following(&model, "restitution", [0.1, 0.4], 0.1));
    let touches = curve.points.iter().filter_map(|point| match point.special?.kind {
        SpecialKind::Graze { before: 1, after: 2, .. } => Some(point),
        _ => None,
    });
    let [touch] = touches.collect::<Vec<_>>()[..] else { panic!("{:?}", curve.points) };
    let slope = 2.0 * rise / span_deg.to_radians() * (1.0 + touch.value) / (1.0 - touch.value);
    let (speed, below) = (slope * angular_velocity(touch.rpm) / frequency, rest - base - 0.5 * rise);
    assert!((speed.hypot(below) - (rest - base)).abs() < 1e-12, "{touch:?}");
    let corner = (60.0 + 0.5 * span_deg).to_radians();
    assert_eq!(curve.ends, [End::Range, End::Range]);
    let beyond: Vec<&BranchPoint> = curve.points.iter().skip_while(|point| *point != touch).skip(1).collect();
    assert!(beyond.len() > 5 && beyond.iter().all(|point| point.orbit.impacts().count() == 2), "{}", beyond.len());
    let places = curve.points.iter().map(|point| point.held.as_ref().unwrap().cam_angle);
    assert!(places.into_iter().all(|place| (place - corner).abs() < 1e-9));
}

/// On the curve of a corner impact a multiplier of the map behind the corner passes -1. A little to one side of that it is beyond -1 at the
/// corner and farther beyond from there on, and before the corner none is: whichever way through the corner, no flip is told.
#[test]
fn no_flip_is_told_at_a_corner_that_a_multiplier_only_jumps_at() {
    let (model, name) = (model("osorio-2008"), "follower.restitution");
    let corner = points(&model, 700.0, 1, [660.0, 710.0], "corner").swap_remove(0);
    let of_corner = curve(&model, &corner, [300.0, 1200.0], &following(&model, name, [0.3, 0.85], 0.1));
    let is_flip = |kind| matches!(kind, SpecialKind::Type { after_corner: Some(true), multiplier: -1.0 });
    let flip = of_corner.points.iter().find(|point| point.special.is_some_and(|special| is_flip(special.kind)));
    let (restitution, rpm) = flip.map(|flip| (flip.value, flip.rpm)).unwrap();
    let beside = model.with_number(name, restitution - 1e-8).unwrap();
    let of_one = orbits(&beside, 1.001 * rpm, 1).into_iter().filter(|orbit| orbit.impacts().count() == 1);
    let number = following(&beside, "rpm", [0.99 * rpm, 1.01 * rpm], 0.1);
    let branches: Vec<Branch> =
        of_one.map(|orbit| Branch::through(&beside, 1.001 * rpm, &orbit, &number).unwrap()).collect();
    assert_eq!(branches.len(), 2);
    for branch in branches {
        // The signs of 1 + trace + determinant, which is 0 at a flip.
        let ordinary = branch.points.iter().filter(|point| point.special.is_none()).map(|point| &point.orbit.matrix);
        let signs: Vec<bool> = ordinary.map(|matrix| 1.0 + matrix.trace() + matrix.determinant() < 0.0).collect();
        assert_eq!(signs.chunk_by(|one, two| one == two).count(), 2, "{signs:?}");
        assert_eq!(changes(&branch, "corner"), Vec::<&str>::new());
    }
}

/// The orbits of a ball turn round where the table is fastest upwards, at `a omega^2 (1 + r) = pi g (1 - r)`: with less and less gravity
/// that comes to a standstill. Whichever of the last steps fails, where it is for the speed this is what the end says.
#[test]
fn a_curve_that_comes_to_a_standstill_says_so() {
    let model = ball(0.8, 0.0);
    let fold = points(&model, 200.0, 1, [170.0, 210.0], "fold").swap_remove(0);
    let mut told = 0;
    for longest_step in [0.03, 0.05, 0.2, 0.5, 1.0] {
        let curve = curve(&model, &fold, [100.0, 300.0], &following(&model, "gravity", [-10.0, 10.0], longest_step));
        assert_eq!(curve.ends[1], End::Range);
        for point in &curve.points {
            let least = (PI * point.value * 0.2 / 1.8 / 0.01).sqrt() * 60.0 / TAU;
            assert!((point.rpm - least).abs() < 1e-6 * (1.0 + least), "{} {least}", point.rpm);
        }
        assert!(curve.points[0].rpm < 1e-3, "{longest_step} {}", curve.points[0].rpm);
        told += usize::from(matches!(&curve.ends[0], End::Edge { why, .. } if why.contains("speed")));
    }
    assert!(told > 0);
}

/// Of two lobes the second is hit on a corner, less and less as the spring lets the follower go higher: where it is touched alone there is
/// no impact on the corner left, and the curve ends there.
#[test]
fn a_curve_of_corner_impacts_ends_where_the_impact_on_the_corner_is_a_touch() {
    let parts = [("parabolic", 50.0, 0.0046), ("parabolic", 50.0, -0.0046), ("dwell", 30.0, 0.0)];
    let others = [("parabolic", 100.0, 0.0113), ("parabolic", 100.0, -0.0113), ("dwell", 30.0, 0.0)];
    let all = parts.into_iter().chain(others);
    let segment: Vec<Value> =
        all.map(|(motion, span, rise)| json!({ "motion": motion, "span_deg": span, "rise": rise })).collect();
    let follower = json!({
        "mass": 1.0, "damping": 0.6, "stiffness": 1300.0, "gravity": 9.81, "rest_position": 0.09, "restitution": 0.88
    });
    let cam = json!({ "law": "program", "base": 0.1, "segment": segment });
    let model = Model::of_document("two-lobes", &json!({ "follower": follower, "cam": cam })).unwrap();
    let speeds = [390.0, 480.0];
    let found = orbits(&model, 400.0, 1).into_iter().filter(|orbit| orbit.impacts().count() == 2);
    let through = |orbit| Branch::through(&model, 400.0, &orbit, &following(&model, "rpm", speeds, 0.2)).unwrap();
    let all = found.map(through).flat_map(|branch| branch.points);
    let on_it = |kind| matches!(kind, SpecialKind::Corner { impact: 1, segment: 9, .. });
    let corner = all.into_iter().find(|point| point.special.is_some_and(|special| on_it(special.kind))).unwrap();
    let curve = curve(&model, &corner, [200.0, 800.0], &following(&model, "rest_position", [0.09, 0.13], 0.2));
    assert_eq!(curve.ends, [End::Range, End::Graze]);
    let last = curve.points.last().unwrap();
    assert!(matches!(last.special.unwrap().kind, SpecialKind::Graze { before: 2, after: 1, .. }), "{last:?}");
    let [one, two] = &last.orbit.events[..] else { panic!("{last:?}") };
    let [one_speed, two_speed] = [one, two].map(|event| event.cam_velocity - event.velocity_before);
    assert!((two.cam_angle - 330.0_f64.to_radians()).abs() < 1e-9, "{two:?}");
    assert!(one_speed > 0.1 && two_speed.abs() < 1e-9, "{one_speed} {two_speed}");
}

/// Whether a follower that leaves the cam behind `place`, rad, at rest on it, rests again before it has turned to there.
fn rests(model: &Model, rpm: f64, place: f64) -> bool {
    /// A way on the cam before the place, rad.
    const BEFORE: f64 = 0.01;
    let machine = machine(model, rpm);
    let start = place - BEFORE;
    let mut motion = machine.start_on_cam(start, 0.0).unwrap();
    let mut rested = false;
    let goal = Goal { revolution: 1, cam_angle: place };
    let advanced = machine.advance(&mut motion, goal, &mut |event: &Event| {
        rested = event.kind == EventKind::Stick && event.turned_since(start) > BEFORE;
        if rested { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(rested || advanced.is_ok(), "{rpm} {advanced:?}");
    rested
}

/// All along its curve a follower that is a little slower rests before the cam lets go of it again, and one that is a little faster does
/// not: where the cam lets go smoothly, between the rows of a table, which the place passes on the way, and at a corner.
#[test]
fn at_the_onset_of_resting_slower_followers_rest_and_faster_ones_do_not() {
    let harmonic = model("laws/harmonic");
    let table = |spline: &str| {
        let lift = |row: u32| harmonic_lift(f64::from(row) * 5.0);
        let rows: Vec<[f64; 2]> = (0..72).map(|row| [f64::from(row) * 5.0, lift(row)]).collect();
        let cam = json!({ "law": "table", "spline": spline, "rows": rows });
        Model::of_document("rows", &json!({ "follower": &harmonic.follower, "cam": cam })).unwrap()
    };
    let at_corner = model("nonsmooth-flip");
    let hardly_thrown = at_corner.with_number("follower.restitution", 0.02).unwrap();
    for (model, rpm, speeds, range) in [
        (&harmonic, 380.0, [300.0, 500.0], [0.3, 0.9]),
        (&table("cubic"), 380.0, [300.0, 500.0], [0.3, 0.9]),
        (&table("quintic"), 380.0, [300.0, 500.0], [0.3, 0.9]),
        (&at_corner, 400.0, [150.0, 1200.0], [0.3, 0.51]),
        (&hardly_thrown, 900.0, [850.0, 1000.0], [0.02, 0.1]),
    ] {
        let onset = points(model, rpm, 1, speeds, "chatter").swap_remove(0);
        let curve = curve(model, &onset, speeds, &following(model, "restitution", range, 0.1));
        assert_eq!(curve.ends, [End::Range, End::Range], "{:?}", curve.points.len());
        for point in &curve.points {
            let there = model.with_number("follower.restitution", point.value).unwrap();
            let place = point.held.as_ref().unwrap().cam_angle;
            let beside = [1.0 - 1e-7, 1.0 + 1e-7].map(|part| rests(&there, part * point.rpm, place));
            assert_eq!(beside, [true, false], "{} rpm, restitution {}", point.rpm, point.value);
        }
    }
}

/// The lift of the eccentric in models/laws, m.
fn harmonic_lift(degrees: f64) -> f64 {
    0.1 - 0.02 * degrees.to_radians().cos() + 0.001 * (2.0 * degrees).to_radians().cos()
}
