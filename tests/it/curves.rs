//! Are the events of a curve where a branch of the model with that number has them, does a curve end with a reason, and do
//! curves meet where they must?

use std::f64::consts::{PI, TAU};
use std::path::Path;

use crate::common;
use corner_impact::cam::Cam;
use corner_impact::model::Model;
use corner_impact::orbit::branch::{Bifurcation, Branch, End, Following, SpecialKind};
use corner_impact::orbit::{Course, Parameter, Search, search};
use corner_impact::progress::Unwatched;
use corner_impact::simulate::{Machine, angular_velocity};
use corner_impact::study::curve::{Curves, curves};

fn model(name: &str) -> Model {
    common::read(&Path::new(common::ROOT).join(format!("models/{name}.toml")))
}

fn followed(model: &Model, rpm: [f64; 2], events: &[Bifurcation], name: &str, range: [f64; 2]) -> Curves {
    let parameter = Parameter::named(model, name).unwrap();
    let following = Following { parameter, range, longest_step: 0.02, most_points: 2000 };
    curves(model, rpm, &Search { revolutions: 1, impacts: None }, events, &following, &Unwatched).unwrap()
}

/// The speeds near `rpm` at which branches have an event, found by searches a little below and above it.
fn on_branches(model: &Model, rpm: f64, event: Bifurcation) -> Vec<f64> {
    let range = [0.99, 1.01].map(|part| part * rpm);
    let following = Following { parameter: Parameter::Speed, range, longest_step: 0.02, most_points: 400 };
    let mut found = Vec::new();
    for beside in [0.9985, 1.0015].map(|part| part * rpm) {
        let machine = Machine::new(Cam::new(model).unwrap(), &model.follower, angular_velocity(beside));
        for orbit in search(&machine, &Search { revolutions: 1, impacts: None }).unwrap() {
            let branch = Branch::through(model, beside, &orbit, &following).unwrap();
            let is_event = |kind: SpecialKind| kind.bifurcation() == Some(event);
            let points =
                branch.points.iter().filter(|point| point.special.is_some_and(|special| is_event(special.kind)));
            found.extend(points.map(|point| point.rpm));
        }
    }
    found
}

/// The events of one model and number, against branches in the speed at three values of the number.
fn is_on_branches(name: &str, rpm: [f64; 2], event: Bifurcation, parameter: &str, range: [f64; 2]) {
    let model = model(name);
    let Parameter::Field(path) = Parameter::named(&model, parameter).unwrap() else { panic!("{parameter}") };
    let found = followed(&model, rpm, &[event], parameter, range);
    assert!(!found.curves.is_empty(), "{name} {event}");
    for curve in &found.curves {
        assert_eq!(curve.kind.bifurcation(), Some(event));
        assert!(curve.points.len() > 10, "{name} {event} {:?}", curve.ends);
        for part in [1, 2, 3] {
            let point = &curve.points[part * curve.points.len() / 4];
            let there = model.with_number(&path, point.value).unwrap();
            let speeds = on_branches(&there, point.rpm, event);
            let off = speeds.iter().map(|rpm| (rpm - point.rpm).abs() / point.rpm).fold(f64::INFINITY, f64::min);
            assert!(off < 1e-9, "{name} {event} {parameter} = {}: {} rpm, not in {speeds:?}", point.value, point.rpm);
        }
    }
}

#[test]
#[ignore = "slow"]
fn events_of_a_curve_are_where_branches_have_them() {
    use Bifurcation::{Corner, Flip, Fold, Graze};
    is_on_branches("osorio-2008", [740.0, 745.0], Fold, "restitution", [0.7, 0.9]);
    is_on_branches("osorio-2008", [738.0, 745.0], Flip, "restitution", [0.7, 0.9]);
    is_on_branches("osorio-2008", [441.0, 444.0], Graze, "restitution", [0.7, 0.9]);
    is_on_branches("osorio-2008", [670.0, 676.0], Corner, "nose_radius", [0.14, 0.16]);
    is_on_branches("persistence", [490.0, 496.0], Fold, "stiffness", [500.0, 800.0]);
    is_on_branches("nonsmooth-flip", [810.0, 816.0], Fold, "restitution", [0.45, 0.6]);
    is_on_branches("damped-heavy", [750.0, 754.0], Graze, "damping", [60.0, 90.0]);
}

/// Of a follower that rests: by bisection of its branch's own runs.
#[test]
#[ignore = "slow"]
fn detachment_and_the_onset_of_resting_are_where_branches_have_them() {
    use Bifurcation::{Detachment, Resting};
    is_on_branches("osorio-2008", [114.0, 116.0], Detachment, "stiffness", [1200.0, 1700.0]);
    is_on_branches("osorio-2008", [198.0, 199.0], Resting, "restitution", [0.794, 0.82]);
    is_on_branches("osorio-2008", [198.0, 199.0], Resting, "stiffness", [1200.0, 1700.0]);
    is_on_branches("laws/harmonic", [315.0, 316.0], Detachment, "damping", [0.0, 5.0]);
    // The cam lets go of it where no derivative jumps.
    is_on_branches("laws/harmonic", [380.0, 382.0], Resting, "damping", [0.0, 0.5]);
}

/// The curve of where the follower leaves the cam, from the speed at which the branch of those that rest at `rpm` has it.
fn of_detachment(model: &Model, rpm: f64, speeds: [f64; 2], name: &str, range: [f64; 2]) -> Branch {
    let machine = Machine::new(Cam::new(model).unwrap(), &model.follower, angular_velocity(rpm));
    let orbits = search(&machine, &Search { revolutions: 1, impacts: None }).unwrap();
    let rests = orbits.iter().find(|orbit| matches!(orbit.course, Course::Sticking(_))).unwrap();
    let following = |parameter, range| Following { parameter, range, longest_step: 0.05, most_points: 400 };
    let branch = Branch::through(model, rpm, rests, &following(Parameter::Speed, speeds)).unwrap();
    let is_detachment = |kind| kind == SpecialKind::Detachment;
    let leaves = branch.points.iter().find(|point| point.special.is_some_and(|it| is_detachment(it.kind))).unwrap();
    let parameter = Parameter::named(model, name).unwrap();
    Branch::of_event(model, leaves, speeds, &following(parameter, range)).unwrap().unwrap()
}

/// A cam of two like lobes, one the mirror image of the other, throws a follower off at two places at once; turned a little one way it throws
/// it off first at the one, turned the other way at the other.
#[test]
fn a_follower_leaves_at_two_places_at_once_where_they_are_alike() {
    let name = "cam.phases_deg[1]";
    let like = model("laws/harmonic").with_number("cam.amplitudes[1]", -0.003).unwrap();
    // From either side, with the change in the last step, and where the two curves part slowly.
    for (own, range) in [(7.0, [-20.0, 20.0]), (-7.0, [-20.0, 20.0]), (7.0, [-0.001, 20.0]), (0.05, [-0.1, 0.1])] {
        let own = like.with_number(name, own).unwrap();
        let curve = of_detachment(&own, 330.0, [300.0, 400.0], name, range);
        assert_eq!(curve.ends, [End::Range, End::Range]);
        let specials = curve.points.iter().filter_map(|point| Some((point, point.special?)));
        let places: Vec<_> = specials.filter(|(_, special)| special.kind == SpecialKind::Place).collect();
        let [(place, special)] = places[..] else { panic!("{range:?} {places:?}") };
        assert!((0.0..1e-12).contains(&special.residual), "{special:?}");
        assert!(place.value.abs() < 1e-9 && special.bracket[0] <= 1e-12 && -1e-12 <= special.bracket[1], "{special:?}");
        let mut sides = [0, 0];
        for point in &curve.points {
            let cam = Cam::new(&own.with_number(name, point.value).unwrap()).unwrap();
            let omega = angular_velocity(point.rpm);
            // a - w^2 c'' of a follower without damping, by which it leaves a cam that it goes with.
            let follower = &own.follower;
            let pulled = |angle: f64| {
                let lift = cam.lift(angle);
                let force =
                    follower.stiffness * (follower.rest_position - lift.value) / follower.mass - follower.gravity;
                force - omega * omega * lift.curvature
            };
            let most = (0..2000).map(|part| pulled(TAU * f64::from(part) / 2000.0)).fold(f64::NEG_INFINITY, f64::max);
            let (size, here) = (omega * omega * 0.02, point.held.as_ref().unwrap().cam_angle);
            assert!(pulled(here).abs() < 1e-9 * size && most < 1e-9 * size, "{most} {point:?}");
            // Either side has a lobe of its own.
            if point.value.abs() > 1e-6 {
                sides[usize::from((here > PI) == (point.value > 0.0))] += 1;
            }
        }
        assert!(sides.contains(&0) && curve.points.len() > 10, "{range:?} {sides:?}");
    }
}

/// All along a curve of a cam that is its own mirror image there are two, and none is told.
#[test]
#[ignore = "slow"]
fn a_cam_that_is_its_own_mirror_image_has_one_curve() {
    for name in ["nose_radius", "flank_start_deg"] {
        let range = if name == "nose_radius" { [0.1, 0.3] } else { [60.0, 120.0] };
        let curve = of_detachment(&model("osorio-2008"), 110.0, [100.0, 120.0], name, range);
        assert_eq!(curve.ends, [End::Range, End::Range], "{name}");
        let specials: Vec<_> = curve.points.iter().filter_map(|point| point.special).collect();
        assert!(matches!(specials[..], [special] if special.kind == SpecialKind::Detachment), "{name} {specials:?}");
        let goes_on = curve.points.windows(2).all(|pair| pair[0].value < pair[1].value);
        assert!(goes_on, "{name}");
    }
}

/// Where an impact on the way to the rest comes to a corner, the curve of the onset of resting has a kink, and may turn back sharply; it is
/// followed around each, and is on branches beyond them.
#[test]
#[ignore = "slow"]
fn the_onset_of_resting_goes_on_around_kinks() {
    let model = common::osorio();
    let found = followed(&model, [198.0, 199.0], &[Bifurcation::Resting], "restitution", [0.7, 0.9]);
    let [curve] = &found.curves[..] else { panic!("{}", found.curves.len()) };
    assert_eq!(curve.ends, [End::Range, End::Range]);
    // Two of the model's own events are on it where it goes further: it is one curve.
    let further = followed(&model, [180.0, 260.0], &[Bifurcation::Resting], "restitution", [0.6, 0.9]);
    assert_eq!(further.curves.len(), 2);
    assert!(further.curves.iter().all(|curve| curve.ends == [End::Range, End::Range]));
    let kinks: Vec<&_> = curve
        .points
        .iter()
        .filter(|point| matches!(point.special, Some(it) if matches!(it.kind, SpecialKind::Corner { .. })))
        .collect();
    assert!(kinks.len() >= 10, "{}", kinks.len());
    // Beyond a kink on either side of the model, far from the next.
    for (low, high) in [(0.775, 0.785), (0.855, 0.865)] {
        let point = curve.points.iter().find(|point| (low..high).contains(&point.value)).unwrap();
        let there = model.with_number("follower.restitution", point.value).unwrap();
        let speeds = on_branches(&there, point.rpm, Bifurcation::Resting);
        let off = speeds.iter().map(|rpm| (rpm - point.rpm).abs() / point.rpm).fold(f64::INFINITY, f64::min);
        assert!(off < 1e-8, "{} rpm at {}, not in {speeds:?}", point.rpm, point.value);
    }
}

/// Where the type of a corner impact changes, and where a graze has a multiplier of 1, a curve of folds or flips ends, by
/// other equations.
#[test]
#[ignore = "slow"]
fn curves_end_on_each_other() {
    let ends_on = |model: &str, rpm: [f64; 2], event: Bifurcation, on: Bifurcation| {
        let found = followed(&self::model(model), rpm, &[on, event], "restitution", [0.3, 0.9]);
        let (hosts, guests): (Vec<_>, Vec<_>) =
            found.curves.iter().partition(|curve| curve.kind.bifurcation() == Some(on));
        let all = hosts.iter().flat_map(|curve| &curve.points);
        let is_type = |kind| matches!(kind, SpecialKind::Type { .. });
        let types: Vec<_> = all.filter(|point| point.special.is_some_and(|special| is_type(special.kind))).collect();
        let mut met = 0;
        for curve in &guests {
            for (end, point) in curve.ends.iter().zip([curve.points.first().unwrap(), curve.points.last().unwrap()]) {
                if matches!(end, End::Corner | End::Graze) {
                    let off = |[value, rpm]: [f64; 2]| (value - point.value).abs().max((rpm / point.rpm - 1.0).abs());
                    assert!(types.iter().any(|at| off([at.value, at.rpm]) < 1e-9), "{model} {event}: {point:?}");
                    met += 1;
                }
            }
        }
        met
    };
    use Bifurcation::{Corner, Flip, Fold, Graze};
    assert_eq!(ends_on("osorio-2008", [660.0, 760.0], Fold, Corner), 1);
    assert_eq!(ends_on("osorio-2008", [660.0, 760.0], Flip, Corner), 2);
    assert_eq!(ends_on("nonsmooth-flip", [800.0, 830.0], Fold, Graze), 1);
}

/// Restitution 0 and 1 are bounds of the model: a curve that comes to one says so, and where the number alone is what ends it,
/// the last point is on it.
#[test]
#[ignore = "slow"]
fn a_bound_of_the_model_ends_a_curve_with_a_sentence() {
    use Bifurcation::{Corner, Flip, Fold, Graze};
    let all = &[Corner, Fold, Flip, Graze];
    for (range, bound) in [([0.5, 1.0], 1.0), ([0.5, 1.5], 1.0), ([0.0, 0.9], 0.0), ([-1.0, 0.9], 0.0)] {
        let found = followed(&common::osorio(), [660.0, 760.0], all, "restitution", range);
        let mut at_bound = 0;
        for curve in &found.curves {
            for (end, point) in curve.ends.iter().zip([curve.points.first().unwrap(), curve.points.last().unwrap()]) {
                assert!(!matches!(end, End::Lost | End::MostPoints), "{range:?} {:?}: {end:?} {point:?}", curve.kind);
                if let End::Edge { largest, why } = end {
                    assert_eq!((point.value, *largest), (bound, bound > 0.5), "{why}");
                    assert_eq!(why, "follower.restitution must be a finite number from 0 to 1");
                    at_bound += 1;
                }
            }
        }
        assert!(at_bound > 0, "{range:?}");
    }
}

/// A cusp of folds, by three equations in closed form. With one impact a revolution and no damping the flight is symmetric in time:
/// with e where the spring is at rest and w its frequency, `F = c(theta) - e - K c'(theta) = 0`, with
/// `K = (1 + r)/(1 - r) (omega/w) / tan(pi w/omega)`. At a fold `F' = 0` as well, at a cusp `F'' = 0`. So neither its place on the cam nor
/// its phase knows anything of r.
#[test]
#[ignore = "slow"]
fn a_cusp_of_folds_is_where_its_equations_are_zero() {
    for (restitution, rpm) in [(0.6, [430.0, 450.0]), (0.8, [350.0, 420.0])] {
        let model = model("laws/harmonic");
        let model = model.with_number("cam.amplitudes[1]", 0.004).unwrap();
        let model = model.with_number("follower.restitution", restitution).unwrap();
        let name = "cam.phases_deg[1]";
        let parameter = Parameter::named(&model, name).unwrap();
        let following = Following { parameter, range: [-180.0, 180.0], longest_step: 0.02, most_points: 2000 };
        let wanted = Search { revolutions: 1, impacts: Some(1) };
        let found = curves(&model, rpm, &wanted, &[Bifurcation::Fold], &following, &Unwatched).unwrap();
        let is_cusp = |kind| kind == SpecialKind::Cusp;
        let points = found.curves.iter().flat_map(|curve| &curve.points);
        let cusps: Vec<_> = points.filter(|point| point.special.is_some_and(|it| is_cusp(it.kind))).collect();
        assert_eq!(cusps.len(), 2, "{restitution}");
        for cusp in cusps {
            let there = model.with_number(name, cusp.value).unwrap();
            let (follower, omega) = (&there.follower, angular_velocity(cusp.rpm));
            let w = (follower.stiffness / follower.mass).sqrt();
            let rest = follower.rest_position - follower.gravity / (w * w);
            let ratio =
                (1.0 + restitution) / (1.0 - restitution) * omega / w / (std::f64::consts::PI * w / omega).tan();
            let lift = Cam::new(&there).unwrap().lift(cusp.cam_angle);
            let size = 0.02_f64;
            assert!((lift.value - rest - ratio * lift.slope).abs() < 1e-12 * size.max(rest), "{cusp:?}");
            assert!((lift.slope - ratio * lift.curvature).abs() < 1e-9 * size, "{cusp:?}");
            // The place of a double root is known to half of the digits.
            assert!((lift.curvature - ratio * lift.third).abs() < 1e-5 * size, "{cusp:?}");
        }
    }
}

/// Of another curve something differs: where it ends, for what reason, of what event; a single point is no curve.
#[test]
fn a_curve_is_the_same_from_either_end() {
    let parameter = Parameter::Field("follower.restitution".into());
    let following = Following { parameter, range: [0.79, 0.81], longest_step: 0.2, most_points: 2000 };
    let (wanted, events) = (Search { revolutions: 1, impacts: None }, [Bifurcation::Corner]);
    let found = curves(&common::osorio(), [670.0, 676.0], &wanted, &events, &following, &Unwatched).unwrap();
    let curve = &found.curves[0];
    let mut turned = curve.clone();
    turned.points.reverse();
    turned.ends.reverse();
    assert!(curve.is_same(curve) && curve.is_same(&turned) && turned.is_same(curve));
    for change in 0..9 {
        let mut other = curve.clone();
        let last = other.points.len() - 1;
        match change {
            0 => other.points[0].rpm *= 1.001,
            1 => other.points[0].value *= 1.001,
            2 => other.points[last].rpm *= 1.001,
            3 => other.points[last].value *= 1.001,
            4 => other.ends[0] = End::Kink,
            5 => other.ends[1] = End::Kink,
            6 => other.kind = SpecialKind::Fold,
            7 => other.points.truncate(1),
            _ => other.points.clear(),
        }
        for one in [curve, &turned] {
            assert!(!one.is_same(&other) && !other.is_same(one), "{change}");
        }
        assert_eq!(other.is_same(&other), other.points.len() > 1, "{change}");
    }
}

/// A follower that rests where its spring has it touches the cam's top at any speed once it rests there. That is a curve of grazes of the orbit
/// without impacts, which is told where such orbits are looked for, and grazes.
#[test]
fn an_orbit_without_impacts_grazes_at_every_speed() {
    let text = "[follower]\nmass = 1.0\nrestitution = 0.7\ndamping = 0.4\nstiffness = 100.0\ngravity = 0.0\nrest_position = 0.02\n\
                [cam]\nlaw = \"harmonic\"\noffset = 0.0\namplitudes = [0.01]\nphases_deg = [0.0]\n";
    let model = Model::parse("wall.toml", text).unwrap();
    let parameter = Parameter::named(&model, "rest_position").unwrap();
    let following = Following { parameter, range: [0.005, 0.02], longest_step: 0.2, most_points: 50 };
    for (revolutions, impacts, event, is_told) in [
        (1, None, Bifurcation::Graze, true),
        (1, Some(0), Bifurcation::Graze, true),
        (1, Some(1), Bifurcation::Graze, false),
        (2, Some(0), Bifurcation::Graze, false),
        (1, Some(0), Bifurcation::Fold, false),
    ] {
        let wanted = Search { revolutions, impacts };
        let found = curves(&model, [300.0, 301.0], &wanted, &[event], &following, &Unwatched).unwrap().curves;
        let touches: Vec<_> =
            found.iter().filter(|it| matches!(it.kind, SpecialKind::Graze { before: 0, .. })).collect();
        assert_eq!(touches.len(), usize::from(is_told), "{revolutions} {impacts:?} {event}");
        for point in touches.iter().flat_map(|curve| &curve.points) {
            assert!((point.value - 0.01).abs() < 1e-12 && (300.0..=301.0).contains(&point.rpm), "{point:?}");
        }
        // The number is the same at each point, which is no continuum of orbits: the speed moves.
        assert!(touches.iter().all(|curve| curve.ends == [End::Range, End::Range]), "{touches:?}");
    }
}
