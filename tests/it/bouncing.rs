//! Are the corner impacts of a ball on a table, whose flights are parabolas, those of the textbook?

use std::f64::consts::{PI, TAU};

use approx::assert_relative_eq;
use corner_impact::cam::Side;
use corner_impact::corner::range::{FoundCornerImpacts, find_corner_impacts};
use corner_impact::corner::{CornerImpact, Way};
use corner_impact::flight::State;
use corner_impact::known::Evidence;
use corner_impact::model::{Model, Study};
use corner_impact::orbit::near::near;
use corner_impact::orbit::search::{Searched, search_all};
use corner_impact::orbit::{PeriodicOrbit, Search};
use corner_impact::progress::Unwatched;
use corner_impact::simulate::{Machine, angular_velocity};
use corner_impact::study::locate::{Located, locate};

use crate::common;

const GRAVITY: f64 = 9.81;
const RESTITUTION: f64 = 0.5;
const AMPLITUDE: f64 = 0.01;

fn follower() -> String {
    format!(
        "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 0.0\ngravity = {GRAVITY}\nrest_position = 0.0\n\
         restitution = {RESTITUTION}\n"
    )
}

/// A table that goes up and down as `a |sin theta|`: at 0 and 180 degrees its velocity jumps from `-w a` to `w a`.
fn ball() -> Model {
    let text = follower() + &format!("[cam]\nlaw = \"rectified-sine\"\noffset = 0.1\namplitude = {AMPLITUDE}\n");
    Model::parse("ball.toml", &text).unwrap()
}

fn around(rpm: f64) -> Study {
    Study { rpm_min: rpm - 1.0, rpm_max: rpm + 1.0 }
}

/// A flight of n turns leaves with `g n T/2` and comes with as much, so that `(1 - r) g n T/2 = (1 + r) w a` on the rising side.
#[test]
#[ignore = "slow"]
fn one_impact_in_any_number_of_turns_is_where_the_parabola_has_it() {
    let model = ball();
    let cam = common::cam(&model);
    for turns in 1..=3_u64 {
        let flight = GRAVITY * turns as f64;
        let period = (2.0 * (1.0 + RESTITUTION) * TAU * AMPLITUDE / ((1.0 - RESTITUTION) * flight)).sqrt();
        let rpm = 60.0 / period;
        let all = find_corner_impacts(&model, &cam, around(rpm), turns, &Unwatched).unwrap();
        assert_eq!(all.corners.iter().map(|corner| corner.angle).collect::<Vec<_>>(), [0.0, PI]);
        assert!(all.complete.iter().any(|it| (it.revolutions, it.impacts, it.known) == (turns, 1, Evidence::Proved)));
        let places: Vec<_> = all.found.iter().map(|at| (at.corner.angle, at.side, at.cycle.impacts.len())).collect();
        assert_eq!(places, [(0.0, Side::Plus, 1), (PI, Side::Plus, 1)]);
        for at in &all.found {
            assert_relative_eq!(at.period, period, max_relative = 1e-14);
            assert!(at.bracket[0] <= at.period && at.period <= at.bracket[1], "{:?}", at.bracket);
            assert!(at.bracket[1] - at.bracket[0] <= 1e-13 * period, "{:?}", at.bracket);
            assert_relative_eq!(at.velocity_before, -0.5 * flight * period, max_relative = 1e-13);
            assert_relative_eq!(at.velocity_after, 0.5 * flight * period, max_relative = 1e-13);
            assert_relative_eq!(at.cam_velocity, TAU / period * AMPLITUDE, max_relative = 1e-13);
            assert!(!at.is_simple(), "where the velocity jumps there is no map on the other side");
        }
        let beside = Study { rpm_min: rpm + 1e-6, rpm_max: rpm + 1.0 };
        assert_eq!(find_corner_impacts(&model, &cam, beside, turns, &Unwatched).unwrap().found, []);
    }
}

/// Half a turn from one corner to the other: such an orbit is on two corners at once.
#[test]
fn an_orbit_on_both_corners_is_refused_with_the_reason() {
    let model = ball();
    let rpm = 60.0 / (4.0 * (1.0 + RESTITUTION) * TAU * AMPLITUDE / ((1.0 - RESTITUTION) * GRAVITY)).sqrt();
    let all = find_corner_impacts(&model, &common::cam(&model), around(rpm), 1, &Unwatched).unwrap();
    assert_eq!(all.found, []);
    let told: Vec<_> = all.rejected.iter().map(|it| (it.cam_angle.to_degrees().round(), it.why.as_str())).collect();
    assert!(told.iter().all(|(_, why)| why.contains("are on corners at once")), "{told:?}");
    assert_eq!(told.iter().map(|(angle, _)| *angle).collect::<Vec<_>>(), [180.0, 0.0], "{told:?}");
    assert!(all.rejected.iter().all(|it| (it.speed_rpm / rpm - 1.0).abs() < 1e-12), "{:?}", all.rejected);
}

/// Where a cam begins to rise, and where it has come down, it is level and stands still. A ball that loses nothing comes back there after any
/// time, and what no force acts on stays: neither fixes a speed, in one turn or in two.
#[test]
fn where_the_cam_is_level_nothing_fixes_a_speed() {
    let cam = "[cam]\nlaw = \"program\"\nbase = 0.1\n\
               [[cam.segment]]\nmotion = \"dwell\"\nspan_deg = 120\n\
               [[cam.segment]]\nmotion = \"parabolic\"\nspan_deg = 120\nrise = 0.01\n\
               [[cam.segment]]\nmotion = \"parabolic\"\nspan_deg = 120\nrise = -0.01\n";
    let bouncing = follower().replace("restitution = 0.5", "restitution = 1.0");
    let floating = follower()
        .replace("gravity = 9.81", "gravity = 0.0")
        .replace("stiffness = 0.0", "stiffness = 1000.0")
        .replace("rest_position = 0.0", "rest_position = 0.1");
    for (follower, why) in [(bouncing, "flights of every period start and end there"), (floating, "a graze, v = c'")] {
        let model = Model::parse("level.toml", &(follower + cam)).unwrap();
        for turns in 1..=2 {
            let range = Study { rpm_min: 5000.0, rpm_max: 5001.0 };
            let all = find_corner_impacts(&model, &common::cam(&model), range, turns, &Unwatched).unwrap();
            for angle in [0.0, 120.0] {
                let told = all.rejected.iter().filter(|it| it.cam_angle.to_degrees().round() == angle);
                let told: Vec<_> = told.map(|it| (it.speed_rpm, it.why.as_str())).collect();
                assert!(told.iter().any(|(rpm, told)| (rpm - 5000.0).abs() < 1e-9 && told.contains(why)), "{told:?}");
            }
        }
    }
}

/// Half a turn later the table is what it was: a corner impact of two impacts is at both corners, by the same ways of looking.
#[test]
#[ignore = "slow"]
fn both_corners_have_the_same_corner_impacts() {
    let model = ball();
    let range = Study { rpm_min: 400.0, rpm_max: 420.0 };
    let all = find_corner_impacts(&model, &common::cam(&model), range, 2, &Unwatched).unwrap().found;
    let [one, other] = all.as_slice() else { panic!("{all:?}") };
    assert_ne!(one.corner.angle, other.corner.angle);
    assert_relative_eq!(one.period, other.period, max_relative = 1e-12);
    assert_relative_eq!(one.velocity_before, other.velocity_before, max_relative = 1e-9);
    assert_eq!((one.cycle.impacts.len(), other.cycle.impacts.len(), &one.ways), (2, 2, &other.ways));
}

/// Where the velocity jumps, differences of the one side know their errors as well as those of two: here 0.15, as six impacts amplify
/// rounding, and they are not held to five decimals.
#[test]
#[ignore = "slow"]
fn differences_on_the_side_of_a_velocity_jump_are_left_out_where_they_know_too_little() {
    let Located { found, agrees, .. } =
        locate(&ball(), Study { rpm_min: 510.98, rpm_max: 511.01 }, 4, &Unwatched).unwrap();
    assert!(agrees && found.len() == 2, "{found:?}");
    for it in &found {
        let why: Vec<_> = it.skipped.iter().map(|skipped| (skipped.route.as_str(), skipped.why.as_str())).collect();
        let differs = it.comparisons.iter().any(|item| !item.agrees);
        assert!(!differs, "{why:?}");
    }
    let left_out = |why: &str| why.contains("by its own errors");
    assert!(found.iter().any(|it| it.skipped.iter().any(|skipped| left_out(&skipped.why))), "{found:?}");
}

/// A flight over a ridge between two hollows is an orbit as long as it is clear of the ridge's edge, `z = g t (T - t)/2` above where it began.
/// The cam curves away from the flight on either side of the edge, so that nothing but the edge is near.
#[test]
fn a_flight_is_an_orbit_where_it_is_clear_of_an_edge() {
    let (rpm, hump, base) = (300.0, 0.012, 0.1);
    let period = 60.0 / rpm;
    // c = base + 4 a u (pi - u)/pi^2, and c' = (1 - r) g T^2/(4 pi (1 + r)) at the impact.
    let slope = (1.0 - RESTITUTION) * GRAVITY * period * period / (4.0 * PI * (1.0 + RESTITUTION));
    let impact = 0.5 * PI * (1.0 - slope * PI / (4.0 * hump));
    let above = 4.0 * hump * impact * (PI - impact) / (PI * PI);
    let time = (1.5 * PI - impact) / TAU * period;
    let edge = above + 0.5 * GRAVITY * time * (period - time);
    for (part, is_orbit) in
        [(0.5, true), (0.99, true), (1.0 - 1e-9, true), (1.0 + 1e-6, false), (1.01, false), (1.2, false)]
    {
        let height = edge * part;
        let segments = [
            (0.0, [base, 4.0 * hump / PI, -4.0 * hump / (PI * PI)]),
            (180.0, [base, 0.0, height * 4.0 / (PI * PI)]),
            (270.0, [base + height, -height * 4.0 / PI, height * 4.0 / (PI * PI)]),
        ];
        let segments = segments.map(|(start, coefficients)| {
            format!("[[cam.segment]]\nstart_deg = {start:?}\ncoefficients = {coefficients:?}\n")
        });
        let text = follower() + "[cam]\nlaw = \"polynomial\"\n" + &segments.concat();
        let model = Model::parse("ridge.toml", &text).unwrap();
        let machine = Machine::new(common::cam(&model), &model.follower, angular_velocity(rpm));
        let wanted = Search { revolutions: 1, impacts: Some(1) };
        let Searched { orbits: found, undecided, .. } = search_all(&machine, &wanted, &Unwatched).unwrap();
        assert_eq!(undecided, [], "{part}");
        let is_it =
            |orbit: &&PeriodicOrbit| orbit.events.len() == 1 && (orbit.events[0].cam_angle - impact).abs() < 1e-9;
        assert_eq!(found.iter().filter(is_it).count(), usize::from(is_orbit), "{part}: {found:?}");
    }
}

/// Where one law ends and the same begins nothing happens: an orbit that lands behind such a seam is found from flights that land before it.
#[test]
fn an_orbit_beside_a_seam_that_is_no_corner_is_found_from_either_side() {
    let (rpm, hump, base) = (300.0, 0.012, 0.1);
    let (period, omega) = (60.0 / rpm, angular_velocity(rpm));
    // c = base + 4 a u (pi - u)/pi^2, and c' = (1 - r) g T^2/(4 pi (1 + r)) at the impact.
    let slope = (1.0 - RESTITUTION) * GRAVITY * period * period / (4.0 * PI * (1.0 + RESTITUTION));
    let impact = 0.5 * PI * (1.0 - slope * PI / (4.0 * hump));
    let [lift, rate, bend] = [4.0 * hump / (PI * PI), 4.0 * hump / PI, -4.0 * hump / (PI * PI)];
    let at = |angle: f64| base + lift * angle * (PI - angle);
    for off in [-1e-3, 1e-3] {
        let seam = impact + off;
        let segments = [
            (0.0, [base, rate, bend]),
            (seam.to_degrees(), [at(seam), rate + 2.0 * bend * seam, bend]),
            (180.0, [base, -rate, -bend]),
        ];
        let segments = segments.map(|(start, coefficients)| {
            format!("[[cam.segment]]\nstart_deg = {start:?}\ncoefficients = {coefficients:?}\n")
        });
        let text = follower() + "[cam]\nlaw = \"polynomial\"\n" + &segments.concat();
        let model = Model::parse("seam.toml", &text).unwrap();
        let cam = common::cam(&model);
        assert_eq!(cam.corners().iter().map(|corner| corner.angle).collect::<Vec<_>>(), [0.0, PI]);
        let machine = Machine::new(cam, &model.follower, omega);
        for landing in [impact - 5e-3, impact + 5e-3] {
            // The parabola that comes back in one turn, half a turn on.
            let (leaving, time) = (0.5 * GRAVITY * period, PI / omega);
            let position = at(landing) + leaving * time - 0.5 * GRAVITY * time * time;
            let state = State { position, velocity: leaving - GRAVITY * time };
            let orbit = near(&machine, landing + PI, state, 1).unwrap();
            let orbit = orbit.unwrap_or_else(|| panic!("none from {landing} beside {seam}"));
            let [event] = orbit.events[..] else { panic!("{orbit:?}") };
            assert!((event.cam_angle - impact).abs() < 1e-10, "{event:?}");
            assert_eq!(event.segment, usize::from(off < 0.0), "{event:?}");
        }
    }
}

/// A table that rises from a kink at an angle with one slope and comes back to it with another, m/rad, in two halves.
fn kinked(degrees: f64, slopes: [f64; 2]) -> Model {
    kinked_in(&[0.0, PI], degrees, slopes)
}

/// The same in pieces that begin so far behind the kink, rad.
fn kinked_in(pieces: &[f64], degrees: f64, [plus, minus]: [f64; 2]) -> Model {
    // c = b + plus u + q u^2 + p u^3 is the same after a turn, and has the slope `minus` there.
    let (square, cubic) = (-(2.0 * plus + minus) / TAU, (plus + minus) / (TAU * TAU));
    let from = |u: f64| {
        [
            0.1 + u * (plus + u * (square + u * cubic)),
            plus + u * (2.0 * square + 3.0 * u * cubic),
            square + 3.0 * u * cubic,
            cubic,
        ]
    };
    let piece = |u: &f64| {
        let start = degrees + u.to_degrees();
        format!("[[cam.segment]]\nstart_deg = {start:?}\ncoefficients = {:?}\n", from(*u))
    };
    let pieces: String = pieces.iter().map(piece).collect();
    Model::parse("kinked.toml", &(follower() + "[cam]\nlaw = \"polynomial\"\n" + &pieces)).unwrap()
}

/// What is found at the kink between two speeds.
fn at_kink(model: &Model, [rpm_min, rpm_max]: [f64; 2], turns: u64) -> FoundCornerImpacts {
    find_corner_impacts(model, &common::cam(model), Study { rpm_min, rpm_max }, turns, &Unwatched).unwrap()
}

/// A flight of a turn has the velocity `g T/2` at both ends, `(1 + r)/(1 - r) = 3` times that of the side of the kink that is hit. The other side
/// must not be faster than the follower after the impact, nor slower than it before.
#[test]
#[ignore = "slow"]
fn an_impact_on_one_side_of_a_kink_needs_room_on_the_other() {
    for ([plus, minus], slope, side, why) in [
        ([0.04, 0.01], 0.04, Side::Plus, None),
        ([0.01, 0.04], 0.04, Side::Minus, None),
        ([0.01, 0.025], 0.01, Side::Plus, None),
        ([0.04, 0.01], 0.01, Side::Minus, Some("the cam's other side hits the follower again at once")),
        (
            [0.01, -0.04],
            0.01,
            Side::Plus,
            Some("the flight would reach the corner from inside the cam on its other side"),
        ),
    ] {
        let rpm = 60.0 / (2.0 * (1.0 + RESTITUTION) * TAU * slope / ((1.0 - RESTITUTION) * GRAVITY)).sqrt();
        let all = at_kink(&kinked(0.0, [plus, minus]), [rpm - 0.01, rpm + 0.01], 1);
        let found = all.found.iter().filter(|at| at.side == side && (at.speed_rpm() / rpm - 1.0).abs() < 1e-12);
        assert_eq!(found.count(), usize::from(why.is_none()), "{plus} {minus}: {all:?}");
        let told: Vec<&str> = all.rejected.iter().map(|it| it.why.as_str()).collect();
        assert_eq!(told, why.into_iter().collect::<Vec<_>>());
    }
}

/// Where angles are counted from is nothing to the follower: at 0, where a revolution ends and another begins, a kink has the corner impacts that it
/// has at 90 degrees, on the same sides, by branches and by shots; and none the less where the cam has no other segment than that from there to there.
#[test]
#[ignore = "slow"]
fn a_kink_at_angle_0_has_the_corner_impacts_of_any_other() {
    for (range, turns) in [([175.1, 175.2], 1), ([277.2, 277.4], 2), ([236.7, 236.8], 2)] {
        let told = |pieces: &[f64], degrees: f64| {
            let all = at_kink(&kinked_in(pieces, degrees, [0.01, 0.04]), range, turns);
            assert!(all.found.iter().all(|at| at.ways == [Way::Branch, Way::Shot]), "{degrees}: {:?}", all.found);
            let of = |at: &CornerImpact| (at.side, at.cycle.impacts.len());
            (all.found.iter().map(of).collect::<Vec<_>>(), all.found.iter().map(|at| at.period).collect::<Vec<_>>())
        };
        let there = told(&[0.0, PI], 90.0);
        for here in [told(&[0.0, PI], 0.0), told(&[0.0], 0.0)] {
            assert!(!here.0.is_empty() && here.0 == there.0, "{here:?} {there:?}");
            here.1.iter().zip(&there.1).for_each(|(one, other)| assert_relative_eq!(one, other, max_relative = 1e-9));
        }
    }
}

/// Two parabolas, one up and one down, wherever the first begins: on the way to where two branches cross an impact more may have been touched.
#[test]
#[ignore = "slow"]
fn a_crossing_behind_a_touch_is_looked_at() {
    let (height, rpm) = (0.02, 247.6136);
    let (slope, bend) = (4.0 * height / PI, 4.0 * height / (PI * PI));
    for degrees in [0.0, 90.0] {
        let segments = [(degrees, 1.0), (degrees + 180.0, -1.0)].map(|(start, sign): (f64, f64)| {
            let coefficients = [0.1, sign * slope, -sign * bend];
            format!("[[cam.segment]]\nstart_deg = {start:?}\ncoefficients = {coefficients:?}\n")
        });
        let text = follower() + "[cam]\nlaw = \"polynomial\"\n" + &segments.concat();
        let model = Model::parse("parabolas.toml", &text).unwrap();
        let all = at_kink(&model, [rpm - 1e-3, rpm + 1e-3], 2);
        assert!(all.found.iter().all(|at| (at.speed_rpm() - rpm).abs() < 2e-3), "{:?}", all.found);
    }
}

/// On branches and by shots: ways that know nothing of each other lead to the same orbits, of two impacts in two turns and of more than in one turn
/// would be chattering.
#[test]
#[ignore = "slow"]
fn branches_and_shots_lead_to_the_same_corner_impacts() {
    let model = kinked(0.0, [0.04, 0.01]);
    for (range, impacts) in [([242.2, 242.3], 2), ([198.25, 198.26], 9)] {
        let all = at_kink(&model, range, 2);
        let [at] = &all.found[..] else { panic!("{:?}", all.found) };
        assert_eq!((at.cycle.impacts.len(), &at.ways[..]), (impacts, &[Way::Branch, Way::Shot][..]));
    }
}

/// Each speed at which the equations hold and the cam has no such orbit is told once.
#[test]
fn what_is_refused_at_one_corner_is_told_at_each_speed() {
    let all = at_kink(&kinked(0.0, [0.01, 0.04]), [183.0, 190.0], 1);
    let speeds: Vec<f64> = all.rejected.iter().map(|it| it.speed_rpm).collect();
    assert!(speeds.len() > 3 && speeds.windows(2).all(|pair| pair[1] > pair[0] * (1.0 + 1e-9)), "{speeds:?}");
    assert!(
        all.rejected
            .iter()
            .all(|it| it.why == "the flight would reach the corner from inside the cam on its other side")
    );
}

/// A ball that loses all leaves a corner with the cam's velocity, `g T/2` for a flight of a turn. Where the cam is bent upwards there it does not
/// let go of the ball, which is carried on to where it is bent down.
#[test]
fn a_ball_that_the_cam_carries_on_is_told_to_stick() {
    let text = |before: f64, after: f64| {
        // Two parabolas up to 180 degrees, which meet at 90, and a cubic down.
        let (first, half) = (0.25 * before * PI * PI, PI * before);
        let (top, slope) = (first + 0.5 * PI * half + 0.25 * after * PI * PI, half + PI * after);
        let (square, cubic) = (-(3.0 * top / PI + 2.0 * slope) / PI, (2.0 * top / PI + slope) / (PI * PI));
        let segment =
            |start: f64, of: [f64; 4]| format!("[[cam.segment]]\nstart_deg = {start:?}\ncoefficients = {of:?}\n");
        follower().replace("restitution = 0.5", "restitution = 0.0")
            + "[cam]\nlaw = \"polynomial\"\n"
            + &segment(0.0, [0.1, 0.0, before, 0.0])
            + &segment(90.0, [0.1 + first, half, after, 0.0])
            + &segment(180.0, [0.1 + top, slope, square, cubic])
    };
    let slope = PI * 0.004;
    let rpm = (PI * GRAVITY / slope).sqrt() * 60.0 / TAU;
    let model = Model::parse("carried.toml", &text(0.004, 0.0005)).unwrap();
    let all = at_kink(&model, [rpm - 0.01, rpm + 0.01], 1);
    let told = all.rejected.iter().find(|it| (it.cam_angle - 0.5 * PI).abs() < 1e-12).unwrap();
    assert!((told.speed_rpm / rpm - 1.0).abs() < 1e-12, "{told:?}");
    assert_eq!(told.why, "the follower sticks to the cam up to or from 180.0000 deg");
}

/// Polynomials that go through the rows of a table are the cam: where they meet is looked at. Of one near the rows it is not.
#[test]
fn rows_are_corners_of_a_spline_through_them_and_not_of_one_near_them() {
    let lift = |angle: f64| (1e4 * (0.02 + 0.01 * (angle.to_radians()).cos())).round() / 1e4;
    for (spline, looked_at) in [("cubic", true), ("smoothing", false)] {
        let rows: Vec<String> =
            (0..16).map(|row| 22.5 * f64::from(row)).map(|it| format!("[{it:?}, {:?}]", lift(it))).collect();
        let text =
            follower() + &format!("[cam]\nlaw = \"table\"\nspline = \"{spline}\"\nrows = [{}]\n", rows.join(", "));
        let model = Model::parse("rows.toml", &text).unwrap();
        let cam = common::cam(&model);
        let all = at_kink(&model, [100.0, 100.01], 1);
        assert!(cam.corners().len() >= 8, "{:?}", cam.corners());
        assert_eq!(all.corners.len() + all.left_out, cam.corners().len());
        assert_eq!((all.left_out == 0, all.corners.is_empty()), (looked_at, !looked_at));
    }
}

/// Over a table that rises from a kink to an edge half a turn later the flight `3 s u (1 - u/(2 pi))` of a turn meets `s u + q u^2` before it is
/// over the edge, where that is too high. That is told with the place.
#[test]
fn a_flight_into_an_edge_is_refused_with_the_place() {
    let (slope, height) = (0.01, 0.06);
    let square = (height / PI - slope) / PI;
    let half = |start: f64, of: [f64; 3]| format!("[[cam.segment]]\nstart_deg = {start:?}\ncoefficients = {of:?}\n");
    let text = follower()
        + "[cam]\nlaw = \"polynomial\"\n"
        + &half(0.0, [0.1, slope, square])
        + &half(180.0, [0.1 + height, -(slope + 2.0 * PI * square), square]);
    let rpm = 60.0 / (2.0 * (1.0 + RESTITUTION) * TAU * slope / ((1.0 - RESTITUTION) * GRAVITY)).sqrt();
    let all = at_kink(&Model::parse("edge.toml", &text).unwrap(), [rpm - 0.01, rpm + 0.01], 1);
    let meets = 2.0 / (3.0 / TAU + square / slope);
    let told: Vec<_> = all.rejected.iter().map(|it| (it.cam_angle, it.why.as_str())).collect();
    let why = format!("the flight meets the cam elsewhere, at {:.4} deg", meets.to_degrees());
    assert_eq!((told, all.found.len()), (vec![(0.0, why.as_str())], 0));
}
