//! Does a branch keep what it promises of its points: which orbits are on it, what is told of where something changes, and how many points
//! there are?

use std::f64::consts::{PI, TAU};

use corner_impact::cam::Cam;
use corner_impact::model::Model;
use corner_impact::orbit::branch::{Bifurcation, Branch, BranchPoint, End, Following, SpecialKind};
use corner_impact::orbit::{Course, Parameter, PeriodicOrbit, Search};
use corner_impact::progress::Unwatched;
use corner_impact::simulate::angular_velocity;
use corner_impact::study::continuation::branches;
use serde_json::json;

use crate::bounds::ball;
use crate::orbit_numbers::{model, orbits};

fn following(model: &Model, parameter: &str, range: [f64; 2], longest_step: f64) -> Following {
    Following { parameter: Parameter::named(model, parameter).unwrap(), range, longest_step, most_points: 400 }
}

fn is_special(point: &BranchPoint, is_wanted: impl Fn(SpecialKind) -> bool) -> bool {
    point.special.is_some_and(|special| is_wanted(special.kind))
}

/// The branch of the orbits that rest at a speed, rpm, and the first point where a kind of thing changes.
fn resting(model: &Model, rpm: f64, speeds: [f64; 2], kind: SpecialKind) -> (Branch, BranchPoint) {
    let orbits = orbits(model, rpm, 1);
    let rests = orbits.iter().find(|orbit| matches!(orbit.course, Course::Sticking(_))).unwrap();
    let branch = Branch::through(model, rpm, rests, &following(model, "rpm", speeds, 0.05)).unwrap();
    let point = branch.points.iter().find(|point| is_special(point, |it| it == kind)).unwrap().clone();
    (branch, point)
}

#[test]
fn each_event_that_has_a_curve_is_of_its_kind() {
    let graze = SpecialKind::Graze { before: 1, after: 2, turned: 1.0, first: None };
    let corner = SpecialKind::Corner { impact: 0, segment: 1, jump_order: 2 };
    let kinds = [corner, SpecialKind::Fold, SpecialKind::Flip, graze, SpecialKind::Detachment, SpecialKind::Chatter];
    assert_eq!(kinds.map(|kind| kind.bifurcation().unwrap()), Bifurcation::ALL);
    let others = [SpecialKind::Branching, SpecialKind::Cusp, SpecialKind::Place, SpecialKind::Turn];
    assert!(others.iter().all(|kind| kind.bifurcation().is_none()));
}

/// Nothing but the speeds on its two sides is known of it.
#[test]
fn what_is_left_of_a_detachment_is_the_width_of_its_bracket() {
    let (_, point) = resting(&model("osorio-2008"), 90.0, [80.0, 130.0], SpecialKind::Detachment);
    let special = point.special.unwrap();
    let [low, high] = special.bracket;
    assert_eq!(special.residual, high - low);
    assert!(low < high && (high - low) < 1e-9 * high, "{special:?}");
}

/// Also the first and the last, whichever way the branch goes there.
#[test]
fn each_point_of_a_branch_is_on_it() {
    for (name, rpm, range) in [
        ("osorio-2008", 700.0, [660.0, 760.0]),
        ("laws/harmonic", 500.0, [470.0, 560.0]),
        ("osorio-2008", 442.0, [425.0, 460.0]),
    ] {
        let model = model(name);
        let all: Vec<Branch> = orbits(&model, rpm, 1)
            .iter()
            .map(|orbit| Branch::through(&model, rpm, orbit, &following(&model, "rpm", range, 0.05)).unwrap())
            .collect();
        assert!(!all.is_empty(), "{name} {rpm}");
        for branch in &all {
            let off = branch.points.iter().find(|point| !branch.holds(point.value, &point.orbit));
            assert!(off.is_none(), "{name} {rpm} {off:?}");
            let lines = branch.lines();
            assert!(lines.iter().all(|line| line.points.len() > 1), "{name}");
        }
    }
}

/// The same motion may be told from any of its revolutions on; one of other revolutions is another, whatever its angles.
#[test]
fn an_orbit_is_known_by_its_revolutions_and_from_any_of_them_on() {
    let model = model("osorio-2008");
    let found = orbits(&model, 760.0, 3);
    let mut renamed = 0;
    for orbit in &found {
        let branch = Branch::through(&model, 760.0, orbit, &following(&model, "rpm", [755.0, 765.0], 0.05)).unwrap();
        let Course::Impacts(cycle) = &orbit.course else { continue };
        for later in 1..cycle.revolutions as i64 {
            let mut told = cycle.clone();
            for impact in &mut told.impacts {
                impact.revolution += later;
            }
            let again = PeriodicOrbit { course: Course::Impacts(told.in_order()), ..orbit.clone() };
            assert!(branch.holds(760.0, &again), "{later} {again:?}");
            renamed += 1;
        }
        let mut longer = cycle.clone();
        longer.revolutions += 1;
        let other = PeriodicOrbit { course: Course::Impacts(longer), ..orbit.clone() };
        assert!(branch.holds(760.0, orbit) && !branch.holds(760.0, &other), "{other:?}");
    }
    assert!(renamed > 0, "{found:?}");
}

/// With the phase of the second harmonic the branch turns round twice and comes back to where it began.
#[test]
#[ignore = "slow"]
fn a_branch_that_comes_back_to_its_start_is_followed_once() {
    let model = model("laws/harmonic").with_number("cam.amplitudes[1]", 0.004).unwrap();
    let following = following(&model, "phases_deg[1]", [-180.0, 180.0], 0.1);
    let branches = orbits(&model, 500.0, 1)
        .into_iter()
        .map(|orbit| Branch::through(&model, 500.0, &orbit, &following).unwrap())
        .filter(|branch| branch.ends != [End::Range, End::Range]);
    let mut closed = 0;
    for branch in branches {
        assert_eq!(branch.ends, [End::Closed, End::Closed]);
        let values: Vec<f64> = branch.points.iter().map(|point| point.value).collect();
        // A step along it is so long at most.
        let longest = 0.1 * 360.0;
        assert!((values[0] - values[values.len() - 1]).abs() <= longest, "{values:?}");
        // It left its start, which is 0, on one side, and comes back from the other.
        assert!(values[0] * values[values.len() - 2] < 0.0, "{values:?}");
        // It turns round at two grazes, and passes each once.
        let specials: Vec<SpecialKind> = branch.points.iter().filter_map(|it| it.special).map(|it| it.kind).collect();
        assert!(matches!(specials[..], [SpecialKind::Graze { .. }, SpecialKind::Graze { .. }]), "{specials:?}");
        closed += 1;
    }
    assert_eq!(closed, 2);
}

/// The model allows no restitution above 1: what is there to the other side leads on as it does anywhere.
#[test]
fn a_branch_from_the_last_value_that_is_allowed_begins_with_the_steps_of_any() {
    let model = model("laws/harmonic").with_number("follower.restitution", 1.0).unwrap();
    let found = orbits(&model, 500.0, 1);
    assert!(!found.is_empty());
    for orbit in found {
        let following = following(&model, "restitution", [0.5, 1.0], 0.05);
        let branch = Branch::through(&model, 500.0, &orbit, &following).unwrap();
        let below: Vec<f64> =
            branch.points.iter().rev().map(|it| it.value).filter(|value| *value < 1.0).take(4).collect();
        // Each step is half as long again as the one before.
        let steps: Vec<f64> = [&[1.0], &below[..]].concat().windows(2).map(|pair| pair[0] - pair[1]).collect();
        assert!(branch.ends[0] == End::Range && steps.len() == 4, "{:?}", branch.ends);
        assert!(steps.windows(2).all(|pair| (pair[1] / pair[0] - 1.5).abs() < 0.02), "{steps:?}");
    }
}

/// The curve of a special point in a number of the model.
fn curve(model: &Model, point: &BranchPoint, speeds: [f64; 2], following: &Following) -> Branch {
    let curve = Branch::of_event(model, point, speeds, following).unwrap().unwrap();
    for point in &curve.points {
        let place = point.held.as_ref().unwrap().cam_angle;
        assert!(matches!(point.orbit.course, Course::Sticking(anchor) if anchor == place), "{point:?}");
    }
    curve
}

/// The more an impact gives back, the more of them there are before the follower rests: each leaves less of the way by three fifths of what
/// the restitution lacks of 1. The 20,000 that are counted come from a radian to a few millionths where the curve ends.
#[test]
#[ignore = "slow"]
fn an_onset_of_resting_ends_where_impacts_are_without_number() {
    let model = model("laws/harmonic");
    let speeds = [310.0, 420.0];
    let (_, chatter) = resting(&model, 340.0, speeds, SpecialKind::Chatter);
    let curve = curve(&model, &chatter, speeds, &following(&model, "restitution", [0.599, 1.2], 0.1));
    assert_eq!(curve.ends, [End::Range, End::Endless]);
    let last = curve.points.last().unwrap().value;
    let left = (-20_000.0 * 0.6 * (1.0 - last)).exp();
    assert!((1e-6..1e-5).contains(&left), "{last} {left}");
}

/// However long a step is: of the impacts before a smooth release a late one tells where they end, and small differences move it far.
#[test]
fn an_onset_of_resting_is_one_curve_at_any_step() {
    let model = model("laws/harmonic");
    let speeds = [310.0, 420.0];
    let (_, chatter) = resting(&model, 340.0, speeds, SpecialKind::Chatter);
    let ends = [0.1, 0.05, 0.02].map(|step| {
        let curve = curve(&model, &chatter, speeds, &following(&model, "stiffness", [100.0, 900.0], step));
        assert_eq!(curve.ends, [End::Range, End::Range], "{step}");
        [curve.points.first(), curve.points.last()].map(|point| point.unwrap().rpm)
    });
    for [low, high] in ends {
        assert!((low - ends[0][0]).abs() < 1e-6 && (high - ends[0][1]).abs() < 1e-6, "{ends:?}");
    }
}

/// The speed goes to 0 where the spring at the lowest lift is as strong as the weight: from there on the follower hangs above the cam.
#[test]
fn a_detachment_ends_where_the_spring_carries_the_follower() {
    let model = model("laws/harmonic");
    let speeds = [310.0, 420.0];
    let (_, leaves) = resting(&model, 340.0, speeds, SpecialKind::Detachment);
    let curve = curve(&model, &leaves, speeds, &following(&model, "rest_position", [0.07, 0.2], 0.2));
    assert_eq!(curve.ends, [End::Range, End::OtherWay]);
    let lowest = 0.1 - 0.02 + 0.001;
    let last = curve.points.last().unwrap().value;
    assert!((last - (lowest + 9.81 / 400.0)).abs() < 1e-9, "{last}");
}

/// On a cam that is its own mirror image a damper holds the follower down before the top and lifts it behind it: it lets go where the nose
/// ends, in closed form.
#[test]
fn a_damped_follower_leaves_where_the_nose_ends() {
    let model = model("osorio-2008");
    let speeds = [100.0, 130.0];
    let (_, leaves) = resting(&model, 112.0, speeds, SpecialKind::Detachment);
    let curve = curve(&model, &leaves, speeds, &following(&model, "damping", [-1.0, 5.0], 0.1));
    let edge = matches!(&curve.ends, [End::Edge { largest: false, .. }, End::Range]);
    assert!(edge && curve.points.len() > 8, "{:?}", curve.ends);
    let cam = Cam::new(&model).unwrap();
    let corners = cam.corners();
    for point in curve.points.iter().filter(|point| point.value > 1e-6) {
        let place = point.held.as_ref().unwrap().cam_angle;
        let end = corners.iter().find(|corner| corner.angle == place).unwrap();
        assert!(place > std::f64::consts::PI, "{point:?}");
        let segments = cam.segments();
        let lift = segments[(end.segment + segments.len() - 1) % segments.len()].law.lift(place);
        let (follower, omega) = (&model.follower, angular_velocity(point.rpm));
        let force = follower.stiffness * (follower.rest_position - lift.value) - point.value * omega * lift.slope;
        let off = force / follower.mass - omega * omega * lift.curvature;
        assert!(off.abs() < 1e-9 * omega * omega, "{off} {point:?}");
    }
}

/// An orbit that rests once in two revolutions: its flight goes from one release to the next but one.
#[test]
fn an_onset_of_resting_may_be_of_two_revolutions() {
    let model = model("osorio-2008");
    let speeds = [205.0, 240.0];
    let orbits = orbits(&model, 220.0, 2);
    let rests = orbits.iter().find(|orbit| matches!(orbit.course, Course::Sticking(_))).unwrap();
    let branch = Branch::through(&model, 220.0, rests, &following(&model, "rpm", speeds, 0.1)).unwrap();
    assert_eq!(branch.ends, [End::Chatter, End::Chatter]);
    let number = following(&model, "restitution", [0.795, 0.805], 0.2);
    let [down, up] = [&branch.points[0], branch.points.last().unwrap()].map(|at| curve(&model, at, speeds, &number));
    assert_eq!((&down.ends, &up.ends), (&[End::Lost, End::Range], &[End::Range, End::Range]));
    assert!(up.points.len() > 5 && up.points.windows(2).all(|pair| pair[0].rpm > pair[1].rpm), "{:?}", up.points.len());
}

/// A curve is given up after so many points in either direction.
#[test]
fn a_curve_has_as_many_points_as_are_asked_for() {
    let model = model("osorio-2008");
    let speeds = [205.0, 240.0];
    let (_, leaves) = resting(&model, 112.0, [100.0, 130.0], SpecialKind::Detachment);
    let following = Following { most_points: 3, ..following(&model, "stiffness", [1000.0, 2000.0], 0.02) };
    let curve = curve(&model, &leaves, speeds, &following);
    assert_eq!((curve.ends, curve.points.len()), ([End::MostPoints, End::MostPoints], 3 + 1 + 3));
}

/// A nose of no width is the last that there is; the curve has its last point there.
#[test]
fn a_detachment_goes_on_to_the_last_value_that_is_allowed() {
    let model = model("osorio-2008");
    let speeds = [100.0, 130.0];
    let (_, leaves) = resting(&model, 112.0, speeds, SpecialKind::Detachment);
    let curve = curve(&model, &leaves, speeds, &following(&model, "nose_end_deg", [150.0, 180.0], 0.1));
    assert!(matches!(&curve.ends, [End::Range, End::Edge { largest: true, .. }]), "{:?}", curve.ends);
    let specials: Vec<SpecialKind> = curve.points.iter().filter_map(|point| point.special).map(|it| it.kind).collect();
    assert_eq!((curve.points.last().unwrap().value, &specials[..]), (180.0, &[SpecialKind::Detachment][..]));
}

/// A branch of twice the period goes to the flip that it comes from and no further. It is stable there, and for 0.004 rpm only: a flip
/// so near to the end is told, too.
#[test]
fn a_branch_of_twice_the_period_ends_at_its_flip() {
    let model = model("persistence");
    let orbits = orbits(&model, 493.0, 2);
    let of_three = orbits.iter().find(|orbit| orbit.events.len() == 3).unwrap();
    let branch = Branch::through(&model, 493.0, of_three, &following(&model, "rpm", [400.0, 600.0], 0.05)).unwrap();
    assert_eq!(branch.ends, [End::Range, End::Shorter]);
    let flips: Vec<usize> =
        (0..branch.points.len()).filter(|&at| is_special(&branch.points[at], |it| it == SpecialKind::Flip)).collect();
    let (points, last) = (&branch.points, branch.points.last().unwrap());
    let [flip, end] = flips[..] else { panic!("{flips:?} of {}", points.len()) };
    assert!(end == points.len() - 1 && last.orbit.revolutions == 1, "{end} {last:?}");
    let least = |at: &BranchPoint| at.orbit.multipliers().map(|one| one.re).into_iter().fold(f64::INFINITY, f64::min);
    let [before, there] = [flip - 1, flip].map(|index| least(&points[index]));
    assert!(before < -1.0 && (there + 1.0).abs() < 1e-6, "{before} {there}");
    assert!((points[flip].rpm - 576.22111).abs() < 1e-5 && last.rpm - points[flip].rpm < 0.004, "{}", points[flip].rpm);
}

/// The corner goes towards the impact, and not the other way round.
#[test]
fn a_branch_goes_on_beyond_a_corner_that_moves() {
    let model = model("osorio-2008");
    let orbits = orbits(&model, 700.0, 1);
    let of_two = orbits.iter().find(|orbit| orbit.events.len() == 2).unwrap();
    let number = following(&model, "flank_start_deg", [60.0, 120.0], 0.1);
    let branch = Branch::through(&model, 700.0, of_two, &number).unwrap();
    assert_eq!(branch.ends, [End::Range, End::Range]);
    let is_corner = |kind| matches!(kind, SpecialKind::Corner { .. });
    let corners: Vec<&BranchPoint> = branch.points.iter().filter(|point| is_special(point, is_corner)).collect();
    let [corner] = corners[..] else { panic!("{}", corners.len()) };
    assert!((corner.orbit.events[0].cam_angle - corner.value.to_radians()).abs() < 1e-9, "{corner:?}");
}

/// The angle that corners are rounded over is 0, or more than next to nothing: what is between ends a branch at its smallest.
#[test]
fn a_branch_of_a_follower_that_rests_ends_where_no_smaller_value_is_allowed() {
    let model = model("osorio-2008").with_number("cam.corner_rounding_deg", 2.0).unwrap();
    let orbits = orbits(&model, 150.0, 1);
    let rests = orbits.iter().find(|orbit| matches!(orbit.course, Course::Sticking(_))).unwrap();
    let number = following(&model, "corner_rounding_deg", [0.0, 4.0], 0.05);
    let branch = Branch::through(&model, 150.0, rests, &number).unwrap();
    assert!(matches!(&branch.ends, [End::Edge { largest: false, .. }, End::Range]), "{:?}", branch.ends);
}

/// Of a machine at a value beside which the cam has other segments, or none, no branch goes either way: the bounds are told, and not that
/// an orbit was lost.
#[test]
fn a_value_beside_which_the_cam_has_other_segments_is_a_bound_both_ways() {
    let model = model("osorio-2008");
    let orbits = orbits(&model, 700.0, 1);
    let number = following(&model, "corner_rounding_deg", [-1.0, 2.0], 0.1);
    let branch = Branch::through(&model, 700.0, &orbits[0], &number).unwrap();
    let [End::Edge { largest: false, why: least }, End::Edge { largest: true, why: most }] = &branch.ends else {
        panic!("{:?}", branch.ends)
    };
    assert_eq!(branch.points.len(), 1);
    assert!(least.contains("0") && !least.contains("segments"), "{least}");
    assert_eq!(most, &format!("must leave the cam its {} segments", Cam::new(&model).unwrap().segments().len()));
}

/// A line goes from one orbit to another: an impact that passes angle 0 between two orbits has none on either side.
#[test]
fn a_line_is_of_two_points_or_more() {
    let model = model("osorio-2008");
    let mut passes = 0;
    for orbit in orbits(&model, 320.0, 1) {
        let branch = Branch::through(&model, 320.0, &orbit, &following(&model, "rpm", [310.0, 340.0], 0.05)).unwrap();
        for pair in branch.points.windows(2) {
            let piece = Branch { points: pair.to_vec(), ends: branch.ends.clone() };
            let count = |point: &BranchPoint| point.orbit.impacts().count();
            let lines = piece.lines();
            assert!(lines.iter().all(|line| line.points.len() == 2), "{lines:?}");
            passes += usize::from(count(&pair[0]) == count(&pair[1]) && lines.len() < count(&pair[0]));
        }
    }
    assert!(passes > 0);
}

/// Branches of as many doublings of the orbits at a speed, rpm.
fn doubled(name: &str, rpm: f64, range: [f64; 2], doublings: u32) -> Vec<Branch> {
    let model = model(name);
    let following = Following { most_points: 150, ..following(&model, "rpm", range, 0.05) };
    branches(&model, rpm, &Search { revolutions: 1, impacts: None }, following, doublings, &Unwatched).unwrap().branches
}

fn revolutions(branch: &Branch) -> u64 {
    branch.points[branch.points.len() / 2].orbit.revolutions
}

/// Where an orbit of one revolution grazes, one begins that touches the cam in each second revolution.
#[test]
fn a_branch_of_twice_the_period_begins_at_a_graze() {
    for (name, rpm, range, graze) in
        [("damped-heavy", 752.0, [700.0, 800.0], 752.164816), ("nonsmooth-flip", 890.0, [800.0, 950.0], 814.65)]
    {
        let found = doubled(name, rpm, range, 1);
        let begins = found.iter().filter(|branch| revolutions(branch) == 2).any(|branch| {
            let last = branch.points.last().unwrap();
            let is_graze = is_special(last, |kind| matches!(kind, SpecialKind::Graze { .. }));
            branch.ends == [End::Range, End::Shorter] && is_graze && (last.rpm - graze).abs() < 1e-3
        });
        assert!(begins, "{name} {:?}", found.iter().map(|branch| &branch.ends).collect::<Vec<_>>());
    }
}

/// Orbits of four revolutions end where those of two have a flip, and not at another flip, however many impacts they have.
#[test]
fn branches_of_four_times_the_period_end_where_those_of_twice_flip() {
    let range = [730.0, 800.0];
    let found = doubled("osorio-2008", 735.0, range, 2);
    let all = |branch: &Branch| branch.points.iter().all(|point| (range[0]..=range[1]).contains(&point.rpm));
    assert!(found.iter().all(all));
    let [two, four] = [2, 4].map(|count| found.iter().filter(|it| revolutions(it) == count).collect::<Vec<_>>());
    let flips: Vec<f64> = two
        .iter()
        .flat_map(|it| &it.points)
        .filter(|it| is_special(it, |kind| kind == SpecialKind::Flip))
        .map(|it| it.rpm)
        .collect();
    let is_flip = |point: &BranchPoint| flips.iter().any(|rpm| (rpm - point.rpm).abs() < 1e-9 * rpm);
    let ending = four.iter().filter(|it| it.ends == [End::Range, End::Shorter] && is_flip(it.points.last().unwrap()));
    assert_eq!(ending.count(), 1, "{flips:?}");
    let ends = |wanted: End| four.iter().filter(|branch| branch.ends.contains(&wanted)).count();
    // No orbit of theirs has as many as two dozen impacts a revolution, and where one of them ends no impact is a touch.
    assert_eq!([ends(End::Chatter), ends(End::Graze), ends(End::Lost)], [0, 0, 1]);
}

/// At 180 degrees the nose goes round the whole back of the cam: the dwell opposite it has no width, and impacts are told by segments.
#[test]
#[ignore = "slow"]
fn a_branch_ends_where_a_segment_of_the_cam_would_have_no_width() {
    let model = model("osorio-2008");
    let edge = End::Edge { largest: true, why: "cam.nose_end_deg must be a finite number from 0 to 180".into() };
    for highest in [180.0, 208.0] {
        let number = following(&model, "nose_end_deg", [112.0, highest], 0.05);
        let mut seen = 0;
        for orbit in &orbits(&model, 320.0, 1) {
            let branch = Branch::through(&model, 320.0, orbit, &number).unwrap();
            for (end, point) in branch.ends.iter().zip([branch.points.first(), branch.points.last()]) {
                let value = point.unwrap().value;
                seen += usize::from(*end == edge && value < 180.0 && value > 180.0 - 1e-9);
            }
        }
        assert!(seen > 0, "{highest}");
    }
}

/// The branches, over these speeds, of the orbits of two revolutions of a ball on a table that goes up and down as a cosine.
fn of_a_ball(rpm: f64, speeds: [f64; 2], impacts: usize, longest_step: f64, most_points: usize) -> Vec<Branch> {
    let model = ball(0.8, 0.0);
    let number = Following { most_points, ..following(&model, "rpm", speeds, longest_step) };
    let orbits = orbits(&model, rpm, 2).into_iter().filter(|orbit| orbit.impacts().count() == impacts);
    orbits.map(|orbit| Branch::through(&model, rpm, &orbit, &number).unwrap()).collect()
}

/// Up in one step over touches of two flights, of which the one that is later in the motion is the sooner along the branch.
#[test]
fn of_two_touches_in_a_step_none_is_passed() {
    let grazes = |longest_step: f64| {
        let found = of_a_ball(300.0, [180.0, 480.0], 3, longest_step, 200);
        let is_graze = |point: &&BranchPoint| point.special.is_some_and(|special| special.kind.name() == "graze");
        let all = found.iter().map(|branch| branch.points.iter().filter(is_graze).map(|point| point.value).collect());
        all.collect::<Vec<Vec<f64>>>()
    };
    for longest_step in [0.01, 0.02, 0.05, 0.1] {
        let found = grazes(longest_step);
        assert!(found.len() == 2, "{longest_step} {found:?}");
        for mut grazes in found {
            grazes.retain(|rpm| *rpm > 425.0);
            grazes.sort_by(f64::total_cmp);
            let told = grazes.len() == 2
                && grazes.iter().zip([433.681_602_544, 470.189_697_368]).all(|(one, other)| (one - other).abs() < 1e-8);
            assert!(told, "{longest_step} {grazes:?}");
        }
    }
}

/// From its flip up, over a touch of one flight that is 2 rpm before that of another, and back to a fold with a flip beside it.
#[test]
fn a_branch_passes_the_same_points_however_long_its_steps_are() {
    let at = |longest_step: f64| {
        let found = of_a_ball(300.0, [180.0, 480.0], 4, longest_step, 200);
        let [branch] = &found[..] else { panic!("{longest_step} {}", found.len()) };
        let specials = branch.points.iter().filter_map(|point| Some((point.special?.kind.name(), point.value)));
        let (names, values): (Vec<_>, Vec<_>) = specials.take(5).unzip();
        assert_eq!((&branch.ends[0], &names[..]), (&End::Shorter, &["flip", "flip", "graze", "fold", "flip"][..]));
        values
    };
    let finest = at(0.02);
    for longest_step in [0.05, 0.1, 0.3] {
        let values = at(longest_step);
        assert!(values.iter().zip(&finest).all(|(one, other)| (one - other).abs() < 1e-7), "{values:?} {finest:?}");
    }
}

/// `a omega^2 (1 + r) = pi g (1 - r)`, with the impact a quarter of a turn from the top: in rows of five degrees on a row, or a little before or
/// behind it.
#[test]
fn a_fold_is_told_wherever_a_row_of_the_cam_is() {
    let fold = (PI * 9.81 * 0.2 / 1.8 / 0.001).sqrt() * 60.0 / TAU;
    for turned in [0.0, 1e-12, -1e-12, 1e-6, -1e-6, 1e-4, -1e-4, 3e-4, -3e-4, 1e-3, -1e-3, 0.03, -0.03, 1.0] {
        let lift = |row: u32| 0.001 * (5.0 * f64::from(row) + turned).to_radians().cos();
        let rows: Vec<(f64, f64)> = (0..72).map(|row| (5.0 * f64::from(row), lift(row))).collect();
        let cam = json!({ "law": "table", "spline": "quintic", "rows": rows });
        let model = Model::of_document("ball", &json!({ "follower": ball(0.8, 0.0).follower, "cam": cam })).unwrap();
        let found = orbits(&model, 700.0, 1);
        let orbit = found.iter().find(|orbit| orbit.impacts().count() == 1).unwrap();
        let branch = Branch::through(&model, 700.0, orbit, &following(&model, "rpm", [540.0, 720.0], 0.05)).unwrap();
        let folds = branch.points.iter().filter(|point| is_special(point, |kind| kind == SpecialKind::Fold));
        let told: Vec<f64> = folds.map(|point| point.rpm).collect();
        assert!(matches!(told[..], [rpm] if (rpm - fold).abs() < 1e-9 * fold), "{turned} {told:?}");
    }
}

/// A follower is said to chatter from two dozen impacts a revolution on, of as many revolutions as there are.
#[test]
fn an_orbit_of_two_revolutions_has_room_for_the_impacts_of_both() {
    let found = of_a_ball(400.0, [240.0, 640.0], 20, 0.02, 150);
    let most = |branch: &Branch| branch.points.iter().map(|point| point.orbit.impacts().count()).max();
    assert!(found.iter().any(|branch| most(branch) > Some(26)), "{:?}", found.iter().map(most).collect::<Vec<_>>());
    assert!(found.iter().all(|branch| !branch.ends.contains(&End::Chatter)));
}

/// A cam that does not move carries its follower all the way round, and lets go of it all at once where it is weightless.
#[test]
fn a_cam_that_does_not_move_lets_go_all_at_once() {
    let model = ball(0.5, 0.0).with_number("cam.amplitudes[0]", 0.0).unwrap();
    let orbits = orbits(&model, 300.0, 1);
    let rests = orbits.iter().find(|orbit| matches!(orbit.course, Course::Sticking(_))).unwrap();
    let branch = Branch::through(&model, 300.0, rests, &following(&model, "gravity", [-3.0, 20.0], 0.05)).unwrap();
    let (first, special) = (&branch.points[0], branch.points[0].special.unwrap());
    assert_eq!((&branch.ends, special.kind), (&[End::Chatter, End::Range], SpecialKind::Chatter));
    assert!(first.value.abs() < 1e-12 && special.bracket[0] <= 0.0 && 0.0 <= special.bracket[1], "{special:?}");
    assert_eq!(special.residual, std::f64::consts::TAU);
}

/// The first is a fiftieth of the longest, and each is half as long again as the one before: the tenth after it is the longest.
#[test]
#[ignore = "slow"]
fn steps_along_a_branch_grow_to_the_longest() {
    let model = ball(0.5, 0.0);
    let mut seen = 0;
    for longest_step in [0.05, 0.2] {
        for orbit in orbits(&model, 420.0, 1).iter().filter(|orbit| orbit.impacts().count() == 1) {
            let number = following(&model, "rpm", [300.0, 700.0], longest_step);
            let branch = Branch::through(&model, 420.0, orbit, &number).unwrap();
            let from = branch.points.iter().position(|point| point.value == 420.0).unwrap();
            let ordinary = branch.points[from..].iter().take_while(|point| point.special.is_none());
            let places = ordinary.map(|point| (point.value / 400.0, point.orbit.impacts().next().unwrap().cam_angle));
            let places: Vec<_> = places.collect();
            let steps: Vec<f64> =
                places.windows(2).map(|two| (two[1].0 - two[0].0).hypot(two[1].1 - two[0].1)).collect();
            let growth: Vec<f64> = steps.windows(2).map(|two| two[1] / two[0]).take(10).collect();
            if let [growing @ .., last] = &growth[..]
                && growth.len() == 10
            {
                assert!(growing.iter().all(|growth| *growth > 1.49) && *last > 1.29, "{longest_step} {growth:?}");
                seen += 1;
            }
        }
    }
    assert_eq!(seen, 3);
}

/// A narrow bump on the table, which a ball that is thrown higher touches just before it comes down behind it: the parabola from the
/// impact is tangent to the bump there, 2 degrees before it ends.
#[test]
fn a_graze_just_before_an_impact_is_where_the_parabola_touches() {
    const BUMP: f64 = 206.0;
    let coarse = (0..72).map(|part| 5.0 * f64::from(part)).filter(|angle| (angle - BUMP).abs() > 5.0);
    let mut angles: Vec<f64> = coarse.chain((-7..=7).map(|part| BUMP + 0.4 * f64::from(part))).collect();
    angles.sort_by(f64::total_cmp);
    let lift = |degrees: f64| {
        let beside = (degrees - BUMP) / 0.7;
        0.1 + 0.01 * degrees.to_radians().cos() + 9e-4 * (-0.5 * beside * beside).exp()
    };
    let rows: Vec<[f64; 2]> = angles.iter().map(|angle| [*angle, lift(*angle)]).collect();
    let cam = serde_json::json!({ "law": "table", "spline": "cubic", "rows": rows });
    let follower = serde_json::to_value(ball(0.55, 0.0).follower).unwrap();
    let model = Model::of_document("bump", &serde_json::json!({ "follower": follower, "cam": cam })).unwrap();
    let number = following(&model, "restitution", [0.549, 0.63], 0.05);
    let behind = orbits(&model, 400.0, 1).into_iter().find(|orbit| {
        let [impact] = &orbit.events[..] else { return false };
        (210.0..212.0).contains(&impact.cam_angle.to_degrees())
    });
    let branch = Branch::through(&model, 400.0, &behind.unwrap(), &number).unwrap();
    assert_eq!(branch.ends, [End::Range, End::Range]);
    let grazes = branch.points.iter().filter_map(|point| match point.special?.kind {
        SpecialKind::Graze { before: 1, after: 2, turned, .. } => Some((point, turned)),
        _ => None,
    });
    let [(graze, turned)] = grazes.collect::<Vec<_>>()[..] else { panic!("{:?}", branch.points) };
    let (cam, omega, impact) = (Cam::new(&model).unwrap(), angular_velocity(400.0), &graze.orbit.events[0]);
    let (from, place) = (impact.turned_since(0.0), turned % std::f64::consts::TAU);
    let left = (from + std::f64::consts::TAU - turned).to_degrees();
    assert!((2.0..2.5).contains(&left), "{left}");
    let (time, touched) = ((turned - from) / omega, cam.lift(place));
    let gap =
        cam.lift(impact.cam_angle).value + impact.velocity_after * time - 0.5 * 9.81 * time * time - touched.value;
    let relative = (impact.velocity_after - 9.81 * time) / omega - touched.slope;
    assert!(gap.abs() < 1e-12 && relative.abs() < 1e-7, "{gap} {relative}");
    assert!(branch.points.last().unwrap().orbit.impacts().count() == 2);
}

/// Less and less elastic, one touch follows another within less than a thousandth of a radian: what ends there is no one of them.
#[test]
fn a_cascade_of_touches_is_chatter() {
    let model = model("laws/harmonic");
    let found = orbits(&model, 500.0, 1).into_iter().filter(|orbit| orbit.impacts().count() > 1);
    let through = |orbit| Branch::through(&model, 500.0, &orbit, &following(&model, "restitution", [0.0, 1.0], 0.05));
    let ends: Vec<(End, f64)> =
        found.map(|orbit| through(orbit).unwrap()).map(|it| (it.ends[0].clone(), it.points[0].value)).collect();
    assert!(ends.iter().any(|(end, value)| *end == End::Chatter && (value - 0.19057).abs() < 1e-3), "{ends:?}");
}

/// On a slow cam only the lift tells where the follower is pressed least: on the lower of two dwells, all along it, where the spring and
/// the gravity that is followed cancel, `g = -k c/m`. It stays on the higher one and comes back to it.
#[test]
fn a_dwell_lets_go_all_along_itself_and_the_rest_goes_on() {
    let segments = [("dwell", 90.0, 0.0), ("cycloidal", 60.0, 0.01), ("dwell", 120.0, 0.0), ("cycloidal", 90.0, -0.01)]
        .map(|(motion, span, rise)| json!({ "motion": motion, "span_deg": span, "rise": rise }));
    let follower = json!({
        "mass": 1.0, "damping": 0.0, "stiffness": 400.0, "gravity": 9.81, "rest_position": 0.0, "restitution": 0.5
    });
    let cam = json!({ "law": "program", "base": 0.04, "segment": segments });
    let model = Model::of_document("dwells", &json!({ "follower": follower, "cam": cam })).unwrap();
    let found = orbits(&model, 10.0, 1);
    let rests = found.iter().find(|orbit| matches!(orbit.course, Course::Sticking(_))).unwrap();
    let branch = Branch::through(&model, 10.0, rests, &following(&model, "gravity", [-17.0, 10.0], 0.1)).unwrap();
    assert_eq!(branch.ends, [End::Range, End::Range]);
    let specials = branch.points.iter().filter_map(|point| Some((point.special?.kind, point.value)));
    let [(SpecialKind::Detachment, gravity)] = specials.collect::<Vec<_>>()[..] else { panic!("{:?}", branch.points) };
    assert!((gravity + 400.0 * 0.04).abs() < 1e-9, "{gravity}");
}

/// Within a few thousandths of its fold the two sides of a branch are less than a long step apart: back at the speed that it began at, it
/// is at another orbit, with its impact as far from the fold on the other side.
#[test]
fn a_branch_that_comes_back_beside_its_start_is_not_closed() {
    let model = ball(0.8, 0.0);
    let fold = (PI * 9.81 * 0.2 / 1.8 / 0.01).sqrt() * 60.0 / TAU;
    let range = [0.9999, 1.004].map(|part| part * fold);
    let found = orbits(&model, range[1], 1);
    for longest_step in [0.1, 0.3, 0.5] {
        for orbit in found.iter().filter(|orbit| orbit.impacts().count() == 1) {
            let number = following(&model, "rpm", range, longest_step);
            let branch = Branch::through(&model, range[1], orbit, &number).unwrap();
            assert_eq!(branch.ends, [End::Range, End::Range], "{longest_step}");
            let [first, last] = [&branch.points[0], branch.points.last().unwrap()];
            assert_eq!([first.rpm, last.rpm], [range[1]; 2]);
            let [one, two] = [first, last].map(|point| point.orbit.events[0].cam_angle);
            assert!((one + two - 3.0 * PI).abs() < 1e-6 && (one - two).abs() > 0.1, "{one} {two}");
        }
    }
    // From between it passes its start on the other side of the fold, less than a step away, and goes on.
    let rpm = 1.0016 * fold;
    for orbit in orbits(&model, rpm, 1).iter().filter(|orbit| orbit.impacts().count() == 1) {
        for longest_step in [0.3, 0.5, 1.0] {
            let branch = Branch::through(&model, rpm, orbit, &following(&model, "rpm", range, longest_step)).unwrap();
            assert_eq!(branch.ends, [End::Range, End::Range], "{longest_step}");
        }
    }
}

/// It turns round at two corner impacts and two touches. From a start right beside one of these it comes back through it: each is told,
/// however long the steps are.
#[test]
#[ignore = "slow"]
fn a_closed_branch_has_all_its_points_wherever_it_begins() {
    let model = model("persistence");
    let (own, found) = (model.follower.stiffness, orbits(&model, 237.0, 1));
    for longest_step in [0.05, 0.1, 0.3] {
        let number = following(&model, "stiffness", [0.6 * own, 1.2 * own], longest_step);
        let through = |orbit| Branch::through(&model, 237.0, orbit, &number).unwrap();
        let all: Vec<Branch> = found.iter().map(through).filter(|branch| branch.ends.contains(&End::Closed)).collect();
        let [branch] = &all[..] else { panic!("{longest_step} {}", all.len()) };
        assert_eq!(branch.ends, [End::Closed, End::Closed], "{longest_step}");
        let mut names: Vec<&str> = branch.points.iter().filter_map(|point| Some(point.special?.kind.name())).collect();
        names.sort_unstable();
        assert_eq!(names, ["corner", "corner", "graze", "graze"], "{longest_step}");
    }
}

/// Each touch of the cascade adds an impact, and behind it the branch turns round, until there are 23 at the fold: from then on it is chatter.
#[test]
#[ignore = "slow"]
fn a_cascade_of_touches_is_followed_to_some_two_dozen_impacts() {
    let model = model("laws/program");
    let found = orbits(&model, 1000.0, 1).into_iter().filter(|orbit| orbit.impacts().count() == 7);
    let through = |orbit| Branch::through(&model, 1000.0, &orbit, &following(&model, "rpm", [600.0, 1600.0], 0.3));
    let mut branches = found.map(|orbit| through(orbit).unwrap());
    let branch = branches.find(|branch| branch.ends == [End::Chatter, End::Chatter]).unwrap();
    let folds = branch.points.iter().filter(|point| is_special(point, |kind| kind == SpecialKind::Fold));
    let counts: Vec<usize> = folds.map(|fold| fold.orbit.impacts().count()).take_while(|count| *count > 7).collect();
    assert_eq!(counts, (8..=23).rev().collect::<Vec<_>>());
}

/// A ball on a table that moves along parabolas is in a uniform field over each half of the turn: at the speed at which its orbit of one impact
/// in a revolution flips, orbits of two impacts have every amplitude. That is one continuum, without a fold; of a sine's table the branch is none.
#[test]
fn orbits_of_every_amplitude_are_one_continuum() {
    let text = |law: &str| {
        format!(
            "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 0.0\ngravity = 2.0\nrest_position = 0.0\nrestitution = 0.85\n[cam]\n{law}"
        )
    };
    let half = |rise: f64| format!("[[cam.segment]]\nmotion = \"parabolic\"\nspan_deg = 180.0\nrise = {rise}\n");
    let parabolas = text(&format!("law = \"program\"\nbase = -0.01\n{}{}", half(0.02), half(-0.02)));
    let sine = text("law = \"harmonic\"\noffset = 0.0\namplitudes = [0.01]\nphases_deg = [0.0]\n");
    for (text, is_continuum) in [(parabolas, true), (sine, false)] {
        let model = Model::parse("table.toml", &text).unwrap();
        let wanted = Search { revolutions: 1, impacts: Some(1) };
        let range = if is_continuum { [149.0, 152.0] } else { [120.0, 146.0] };
        let along = following(&model, "rpm", range, 0.02);
        let found = branches(&model, if is_continuum { 149.9 } else { 130.0 }, &wanted, along, 1, &Unwatched).unwrap();
        let of_two: Vec<&Branch> =
            found.branches.iter().filter(|it| it.points.iter().any(|it| it.orbit.revolutions == 2)).collect();
        assert!(!of_two.is_empty(), "{}", found.branches.len());
        for branch in of_two {
            assert_eq!(branch.ends.contains(&End::Continuum), is_continuum, "{:?}", branch.ends);
            let folds = branch.points.iter().filter(
                |it| matches!(it.special, Some(it) if matches!(it.kind, SpecialKind::Fold | SpecialKind::Branching)),
            );
            assert!(!is_continuum || folds.count() == 0);
            if is_continuum {
                assert!(branch.points.iter().all(|it| (it.rpm / branch.points[0].rpm - 1.0).abs() < 1e-9));
                assert!(End::Continuum.words().contains("continuum"));
            }
        }
    }
}

/// A rise of `h` over 60 degrees has `c'' = -4.5 h` at its top, where `m w^2 c'' = k (rest - c) - m g`. It lets go there and not on the dwell below, on which the
/// spring is slack, or carries the weight alone, nor on one that it is pressed on.
#[test]
fn a_follower_leaves_at_the_top_and_not_on_a_dwell_that_presses_or_is_slack() {
    let (stiffness, rise) = (400.0, 0.02);
    let with = |base: f64, gravity: f64, rest: f64| {
        let motion = |motion: &str, span: f64, rise: f64| {
            format!("[[cam.segment]]\nmotion = \"{motion}\"\nspan_deg = {span:?}\nrise = {rise:?}\n")
        };
        let program = [motion("harmonic", 60.0, rise), motion("harmonic", 60.0, -rise), motion("dwell", 240.0, 0.0)];
        let text = format!(
            "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = {stiffness:?}\ngravity = {gravity:?}\nrest_position = {rest:?}\n\
             restitution = 0.3\n[cam]\nlaw = \"program\"\nbase = {base:?}\n{}",
            program.concat()
        );
        Model::parse("dwell.toml", &text).unwrap()
    };
    let rpm = |pressed: f64| (stiffness * pressed / (4.5 * rise)).sqrt() * 60.0 / TAU;
    for (base, gravity) in [(0.0, 0.0), (0.3, 0.0), (0.1, 9.81)] {
        let slack = base + gravity / stiffness;
        let speeds = [0.7 * rpm(rise), 1.4 * rpm(rise)];
        let (_, leaves) = resting(&with(base, gravity, slack), 0.8 * rpm(rise), speeds, SpecialKind::Detachment);
        assert!((leaves.rpm / rpm(rise) - 1.0).abs() < 1e-9, "{base} {gravity}: {}", leaves.rpm);
        if gravity == 0.0 {
            // Whatever the stiffness, the spring stays slack on the dwell.
            let loose = with(base, gravity, slack);
            let number = following(&loose, "stiffness", [0.5 * stiffness, 2.0 * stiffness], 0.1);
            let curve = curve(&loose, &leaves, [0.5 * rpm(rise), 2.0 * rpm(rise)], &number);
            assert_eq!(curve.ends, [End::Range, End::Range], "{base}");
            for point in &curve.points {
                let leaves = rpm(rise) * (point.value / stiffness).sqrt();
                assert!((point.rpm / leaves - 1.0).abs() < 1e-9, "{base}: {point:?}");
            }
        }
        let pressed = with(base, gravity, slack - 0.2 * rise);
        let (_, leaves) = resting(&pressed, 0.8 * rpm(rise), speeds, SpecialKind::Detachment);
        assert!((leaves.rpm / rpm(1.2 * rise) - 1.0).abs() < 1e-9, "{base} {gravity}: {}", leaves.rpm);
        let number = following(&pressed, "rest_position", [slack - 0.4 * rise, slack - 0.05 * rise], 0.1);
        let curve = curve(&pressed, &leaves, speeds, &number);
        assert_eq!(curve.ends, [End::Range, End::Range], "{base} {gravity}");
        for point in &curve.points {
            assert!((point.rpm / rpm(slack + rise - point.value) - 1.0).abs() < 1e-9, "{base} {gravity}: {point:?}");
        }
    }
}
