//! Does a curve in two numbers keep what its event promises: where it is on the cam, in whatever unit, and however the cam is turned?

use std::f64::consts::TAU;

use corner_impact::cam::apart;
use corner_impact::model::Model;
use corner_impact::orbit::branch::{Bifurcation, Branch, BranchPoint, End, Following, Kind};
use corner_impact::orbit::{Parameter, Search};
use corner_impact::progress::Unwatched;
use corner_impact::simulate::EventKind;
use corner_impact::study::curve::curves;

use crate::orbit_numbers::{model, orbits};
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
        corners.iter().filter(|corner| matches!(corner.special.unwrap().kind, Kind::Corner { segment: 1, .. }))
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
        let is_cusp = |point: &&BranchPoint| point.special.is_some_and(|special| special.kind == Kind::Cusp);
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
