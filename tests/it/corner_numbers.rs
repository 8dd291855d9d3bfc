//! Have the maps at corner impacts moved? To the digits that they are known to, in a snapshot; and do what they are made of, periods of
//! parts of an orbit, begin and end where they must?

use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use std::ops::ControlFlow;

use approx::assert_relative_eq;
use corner_impact::cam::{Cam, Side};
use corner_impact::corner::jump_order::compared::{Compared, PowerLawQuantity, compare};
use corner_impact::corner::jump_order::measured::{SideFlights, gap};
use corner_impact::corner::jump_order::predicted::{self, Hits};
use corner_impact::corner::jump_order::{Approach, JumpOrderError};
use corner_impact::corner::map::Uncertainty;
use corner_impact::corner::one_sided::{OneSidedMap, SampleError};
use corner_impact::corner::range::{RangeError, find_corner_impacts};
use corner_impact::corner::varied::Varied;
use corner_impact::corner::{CornerImpact, Way, finite_difference, least_squares, second_order, variational};
use corner_impact::estimate::Estimate;
use corner_impact::flight::State;
use corner_impact::model::{CamProfile, Model, Study};
use corner_impact::paper::jump_order::EXAMPLES;
use corner_impact::progress::Unwatched;
use corner_impact::simulate::{Event, EventKind, Goal, Machine};
use corner_impact::tolerance;
use nalgebra::{Matrix2, Vector2, Vector3};

use crate::common;
use crate::orbit_numbers::is_as_it_was;

/// The corner impacts between two speeds.
fn found(model: &Model, [rpm_min, rpm_max]: [f64; 2], revolutions: u64) -> (Cam, Vec<CornerImpact>) {
    let cam = common::cam(model);
    let found = find_corner_impacts(model, &cam, Study { rpm_min, rpm_max }, revolutions, &Unwatched);
    (cam, found.unwrap().found)
}

fn read(file: &str) -> Model {
    common::read(format!("models/{file}.toml").as_ref())
}

/// The paper's machine with a damper, gravity, a preload, and masses in grams.
fn in_grams() -> Model {
    let text = common::osorio_text(&[("mass", "1221"), ("damping", "1.0"), ("gravity", "9.8")]);
    let text = text.replace("rest_position = 0.3", "preload = 143.08");
    Model::parse("preloaded.toml", &format!("{text}\n[units]\nmass = \"g\"\n")).unwrap()
}

/// To six digits; what is nothing but rounding is 0.
fn digits(number: f64) -> String {
    if number.abs() < 1e-9 { "0".into() } else { format!("{number:.5e}") }
}

fn pair(vector: Vector2<f64>) -> String {
    format!("({}, {})", digits(vector[0]), digits(vector[1]))
}

#[test]
#[ignore = "slow"]
fn b_by_every_number_is_as_it_was() {
    let mut text = String::new();
    let machines = [(in_grams(), [739.0, 739.1], 1), (read("persistence"), [493.0, 494.0], 1)];
    for (model, speeds, revolutions) in machines {
        let (cam, all) = found(&model, speeds, revolutions);
        let at = &all[0];
        let (rpm, impacts) = (digits(at.speed_rpm()), at.cycle.impacts.len());
        writeln!(text, "{} at {rpm} rpm, impacts {impacts}", model.name).unwrap();
        // Corners that are not rounded have no neighbour below.
        for (name, _) in model.numbers().filter(|(name, _)| *name != "cam.corner_rounding_deg") {
            let route = variational::route_by(&model, &cam, at, &Varied::Number(name.into())).unwrap();
            let Some(Uncertainty::Extrapolation(off)) = route.uncertainty else { panic!("{name}: {route:?}") };
            for (b, off) in [(route.map.minus.b, off.minus.b), (route.map.plus.b, off.plus.b)] {
                assert!(off.min() >= 0.0 && off.norm() <= 1e-8 * b.norm() + 1e-10, "{name}: {off} of {b}");
            }
            writeln!(text, "  {name}: {} {}", pair(route.map.minus.b), pair(route.map.plus.b)).unwrap();
        }
        let curved = second_order::second_order(&model, &cam, at);
        for side in [Side::Minus, Side::Plus] {
            let [first, second] = curved.of(side).fixed_point().unwrap();
            writeln!(text, "  fixed point {side:?}: {} {}", pair(first), pair(second)).unwrap();
        }
    }
    is_as_it_was("corner-numbers", &text);
}

/// Each from the middle of a flight to that of the next: unmoved it ends where the next begins, a unit in any direction leaves the
/// impact the orbit's, and the differences of all multiply to A of the product of propagators.
fn parts_begin_and_end_on_their_orbit<const N: usize>(machines: [(Model, [f64; 2], u64); N]) {
    for (model, speeds, revolutions) in machines {
        let (cam, all) = found(&model, speeds, revolutions);
        let at = &all[0];
        let exact = variational::route(&model, &cam, at).map;
        for side in [Side::Minus, Side::Plus] {
            let case = format!("{} at {} rpm, {side:?}", model.name, at.speed_rpm());
            let whole = OneSidedMap::new(&model, &cam, at, side).unwrap();
            let pieces = OneSidedMap::pieces(&model, &cam, at, side, &Varied::Period).unwrap();
            assert_eq!(pieces.len(), at.cycle.impacts.len());
            let (mut a, mut b) = (Matrix2::identity(), Vector2::zeros());
            for (index, map) in std::iter::once(&whole).chain(&pieces).enumerate() {
                let unmoved = map.sample(Vector3::zeros()).unwrap();
                let rounding = map.rounding();
                assert!(unmoved.end.abs() <= rounding * 1e4, "{case} {index}: {unmoved:?} {rounding}");
                assert!(unmoved.past_corner.abs() < 1e-8, "{case} {index}: {unmoved:?}");
                let (mut part, mut by_period) = (Matrix2::zeros(), Vector2::zeros());
                for direction in 0..3 {
                    let mut unit = Vector3::zeros();
                    unit[direction] = map.scales()[direction];
                    let difference = |unit: Vector3<f64>| {
                        let [ahead, behind] = [unit, -unit].map(|unit| map.sample(unit).unwrap());
                        (ahead.end - behind.end) / (ahead.perturbation - behind.perturbation)[direction]
                    };
                    assert!([unit, -unit].iter().all(|unit| map.sample(*unit).is_ok()), "{case} {index} {direction}");
                    // A hundredth of a unit keeps the map straight.
                    let column = difference(unit * 0.01);
                    match direction {
                        2 => by_period = column,
                        _ => part.set_column(direction, &column),
                    }
                }
                if index > 0 {
                    (a, b) = (part * a, part * b + by_period);
                }
            }
            let exact = if side == Side::Minus { exact.minus } else { exact.plus };
            let off = [(a - exact.a).norm() / exact.a.norm(), (b - exact.b).norm() / exact.b.norm()];
            assert!(off.iter().all(|off| *off < 1e-4), "{case}: {off:?}");
        }
    }
}

#[test]
#[ignore = "slow"]
fn parts_of_an_orbit_begin_and_end_on_it() {
    parts_begin_and_end_on_their_orbit([
        (common::osorio(), [736.0, 736.2], 1),
        (common::osorio(), [739.3, 739.4], 2),
        (read("laws/polynomial"), [410.9, 411.0], 1),
        (read("laws/polynomial"), [419.8, 419.9], 1),
        (in_grams(), [739.0, 739.1], 1),
    ]);
}

#[test]
#[ignore = "slow"]
fn parts_of_an_orbit_of_thirteen_impacts_begin_and_end_on_it() {
    parts_begin_and_end_on_their_orbit([(common::osorio(), [195.5, 195.7], 1)]);
}

/// Differences and fits over several impacts, of the map and of the border, are off by no more than ten times what they say, which is little.
#[test]
fn estimates_over_several_impacts_know_their_errors() {
    for (model, speeds) in [(common::osorio(), [736.0, 736.2]), (in_grams(), [739.0, 739.1])] {
        let (cam, all) = found(&model, speeds, 1);
        let at = &all[0];
        let exact = variational::route(&model, &cam, at);
        for side in [Side::Minus, Side::Plus] {
            let of = if side == Side::Minus { exact.map.minus } else { exact.map.plus };
            let (value, error) = finite_difference::side_map(&model, &cam, at, side, &Varied::Period).unwrap();
            let off = (value.map.a - of.a).abs();
            assert!(off <= error.map.a * 10.0 && error.map.a.norm() < 1e-6 * of.a.norm(), "{off} {}", error.map.a);
            let off = (value.map.b - of.b).abs();
            assert!(off <= error.map.b * 10.0 && error.map.b.norm() < 1e-6 * of.b.norm(), "{off} {}", error.map.b);
            assert!(error.map.a.min() > 0.0 && error.map.b.min() > 0.0 && error.gap.min() > 0.0);
        }
        let fit = least_squares::route(&model, &cam, at).unwrap();
        for (fit, of) in [(fit.map.minus, exact.map.minus), (fit.map.plus, exact.map.plus)] {
            assert!((fit.a - of.a).norm() < 1e-5 * of.a.norm() && (fit.b - of.b).norm() < 1e-5 * of.b.norm());
        }
    }
}

/// Also by a number that is 0, whose own size says nothing, and by one that the cam is made of.
#[test]
fn differences_by_a_number_are_those_of_the_product() {
    let model = common::osorio();
    let (cam, all) = found(&model, [673.0, 673.5], 1);
    for name in
        ["follower.gravity", "follower.mass", "follower.rest_position", "follower.restitution", "cam.nose_radius"]
    {
        let by = Varied::Number(name.into());
        let exact = variational::route_by(&model, &cam, &all[0], &by).unwrap().map;
        let found = finite_difference::route_by(&model, &cam, &all[0], &by).unwrap().map;
        for (found, exact) in [(found.minus.b, exact.minus.b), (found.plus.b, exact.plus.b)] {
            assert!((found - exact).norm() <= 1e-7 * exact.norm().max(1e-3), "{name}: {found} {exact}");
        }
    }
}

/// The follower's motion from the longest period of a range to the shortest: (w0 + zeta) n (T_2 - T_1).
#[test]
fn too_wide_a_range_says_how_many_radians_it_spans() {
    let model = common::osorio_with(&[("damping", "3.0")]);
    let range = Study { rpm_min: 1e-2, rpm_max: 700.0 };
    let follower = &model.follower;
    let rate = (follower.stiffness / follower.mass).sqrt() + 3.0 / (2.0 * follower.mass);
    for revolutions in [1, 3] {
        match find_corner_impacts(&model, &common::cam(&model), range, revolutions, &Unwatched).map(|_| ()) {
            Err(RangeError::TooWide { radians, .. }) => {
                let expected = rate * revolutions as f64 * (60.0 / 1e-2 - 60.0 / 700.0);
                assert_relative_eq!(radians, expected, max_relative = 1e-12);
            }
            other => panic!("{other:?}"),
        }
    }
}

/// A corner of velocity under a follower with every force: a heavy one with a spring, a damper and gravity.
fn of_every_force() -> Compared {
    let mut model = read("laws/rectified-sine");
    let CamProfile::RectifiedSine(_) = &model.cam else { panic!("{:?}", model.cam) };
    let follower = &mut model.follower;
    (follower.mass, follower.damping, follower.stiffness) = (1.7, 0.9, 2.3);
    (follower.gravity, follower.rest_position) = (0.7, 0.4);
    let cam = common::cam(&model);
    let (corner, omega) = (cam.corners()[1], 1.3);
    compare(&model, &cam, &Approach::new(corner, omega, omega * corner.minus.slope - 6.0).unwrap()).unwrap()
}

/// The same follower in the valley between two parabolas, whose curvature does not vanish there as a sine's does.
fn between_parabolas() -> Compared {
    let half =
        |start: u32| format!("[[cam.segment]]\nstart_deg = {start}\ncoefficients = [1.0, 0.8, -0.25464790894703254]\n");
    let follower = "[follower]\nmass = 1.7\ndamping = 0.9\nstiffness = 2.3\ngravity = 0.7\nrest_position = 0.4\nrestitution = 0.8\n";
    let text = format!("{follower}[cam]\nlaw = \"polynomial\"\n{}{}", half(0), half(180));
    let model = Model::parse("parabolas.toml", &text).unwrap();
    let cam = common::cam(&model);
    let (corner, omega) = (cam.corners()[1], 1.3);
    assert!(corner.jump_order == 1 && corner.minus.curvature < -0.5, "{corner:?}");
    compare(&model, &cam, &Approach::new(corner, omega, omega * corner.minus.slope - 6.0).unwrap()).unwrap()
}

#[test]
fn a_jump_is_as_predicted_under_every_force() {
    let parabolas = between_parabolas();
    assert!(parabolas.agrees(), "{parabolas:#?}");
    let compared = of_every_force();
    assert!(compared.agrees() && compared.rows.len() == 5, "{compared:#?}");
    for row in compared.rows.iter().chain(&parabolas.rows) {
        let off = (row.measured.coefficient.value / row.predicted.coefficient - 1.0).abs();
        assert_relative_eq!(row.relative_difference(), off, max_relative = 1e-3, epsilon = 1e-15);
        // In parts of a scale or in whole ones, the error is that of the coefficient.
        let Estimate { value, error, .. } = row.measured.coefficient;
        assert!(error > 0.0 && error <= 1e-5 * value.abs(), "{row:?}");
    }
}

/// Deviations that move the impact by comparable times, reach/omega: in position by what the gap closes in that time, in velocity by what
/// takes the whole flight to come to as much.
#[test]
fn deviations_of_flights_move_their_impact_alike() {
    for example in
        EXAMPLES.iter().filter(|example| !example.name.contains("sine,") && !example.name.contains("hollows"))
    {
        let (model, cam, approach) = example.build().unwrap();
        let sides = SideFlights::new(&model, &cam, &approach).unwrap();
        let (closing, omega, scales) = (approach.closing_velocity(), approach.angular_velocity, sides.scales());
        let time = scales[0] / closing;
        let reach = time * omega;
        // A tenth of a radian, or a part of it by halving.
        let halvings = (0.1 / reach).log2();
        assert!((halvings - halvings.round()).abs() < 1e-9 && halvings > -1e-9, "{}: {reach}", example.name);
        assert_relative_eq!(scales[1], closing * reach / sides.span(), max_relative = 1e-12);
        let slower = closing / (closing + approach.velocity_before.abs());
        assert_relative_eq!(scales[2], time * slower, max_relative = 1e-12);
        let gradient = predicted::over(&model.follower, &approach, sides.span(), sides.span()).gradient;
        for direction in 0..3 {
            let mut z = Vector3::zeros();
            z[direction] = 1e-3 * scales[direction];
            let offset = sides.pair(z).unwrap().offset;
            assert_relative_eq!((gradient * z)[0], offset, max_relative = 0.05);
        }
    }
}

/// At the bounds themselves: a follower as fast as the cam falls away misses it, one that rebounds as fast as it rises hits it once.
#[test]
fn the_bounds_of_a_velocity_jump_belong_to_one_side() {
    for (amplitude, closing, hits) in [
        (-1.0, 2.0, Hits::NeverAfter),
        (-1.0, 2.0 + 1e-12, Hits::Once),
        (1.0, 2.5, Hits::Once),
        (1.0, 2.5 - 1e-12, Hits::TwiceBefore),
    ] {
        let mut model = read("laws/rectified-sine");
        let CamProfile::RectifiedSine(profile) = &mut model.cam else { panic!("{:?}", model.cam) };
        profile.amplitude = amplitude;
        model.follower.restitution = 0.8;
        let mut corner = common::cam(&model).corners()[1];
        (corner.minus.slope, corner.plus.slope, corner.jump) = (-amplitude, amplitude, 2.0 * amplitude);
        let approach = Approach::new(corner, 1.0, -amplitude - closing).unwrap();
        assert_eq!(predicted::hits(&model.follower, &approach), hits, "{amplitude} {closing}");
    }
}

/// It agrees with no other exponent, coefficient or number of impacts, nor where nothing was compared.
#[test]
fn a_jump_that_is_not_as_predicted_disagrees() {
    let right = of_every_force();
    for index in 0..right.rows.len() {
        let mut wrong = right.clone();
        wrong.rows[index].measured.coefficient.value *= 1.01;
        assert!(!wrong.agrees(), "{index}");
        let mut wrong = right.clone();
        wrong.rows[index].measured.exponent.value += 0.1;
        assert!(!wrong.agrees(), "{index}");
    }
    let mut miscounted = right.clone();
    miscounted.gap.as_mut().unwrap().impacts = [2, 1];
    let empty = Compared { rows: Vec::new(), ..right };
    assert!(!miscounted.agrees() && !empty.agrees());
}

/// The deviation that is carried once around from x* is that of the state at its section, at each of its impacts.
#[test]
#[ignore = "slow"]
fn the_course_of_an_orbit_comes_round() {
    for (model, speeds, revolutions) in
        [(common::osorio(), [736.0, 736.2], 1), (common::osorio(), [739.3, 739.4], 2), (in_grams(), [739.0, 739.1], 1)]
    {
        let (_, all) = found(&model, speeds, revolutions);
        let at = &all[0];
        let (flights, last) = at.course();
        let mut angle = at.section_angle();
        for (turn, impact) in &flights {
            angle += turn;
            let there = at.cycle.impacts[*impact].cam_angle;
            let off = (angle - there) / TAU;
            assert!((off - off.round()).abs() < 1e-12, "{angle} {there}");
        }
        assert_relative_eq!(angle + last, at.section_angle() + revolutions as f64 * TAU, max_relative = 1e-12);
        assert!(!at.is_simple());
    }
    // Of one impact, where the acceleration jumps; where the velocity does it is not the paper's.
    for (name, speeds, is_simple) in
        [("osorio-2008", [673.2, 673.3], true), ("laws/rectified-sine", [18.4, 18.6], false)]
    {
        assert_eq!(found(&read(name), speeds, 1).1[0].is_simple(), is_simple, "{name}");
    }
}

/// Its two terms cancel, and what rounding leaves of them is told over the sum of their sizes.
#[test]
fn what_is_left_of_the_equation_for_the_period_is_a_rounding_of_its_terms() {
    let (_, all) = found(&common::osorio(), [673.2, 673.3], 1);
    let at = &all[0];
    assert_eq!(at.ways, [Way::Equation]);
    assert!((0.0..1e-14).contains(&at.residual), "{:e}", at.residual);
}

/// No branch comes to it: its period is known to where Newton's method closed.
#[test]
#[ignore = "slow"]
fn a_corner_impact_that_shots_alone_find_has_its_period_in_a_bracket() {
    let (_, all) = found(&read("sharp-nose"), [225.7, 225.8], 1);
    let at = &all[0];
    assert_eq!(at.ways, [Way::Shot]);
    let [low, high] = at.bracket.map(|end| end / at.period - 1.0);
    let width = tolerance::CYCLE_CLOSED.value;
    assert!((low / -width - 1.0).abs() < 1e-2 && (high / width - 1.0).abs() < 1e-2, "{low:e} {high:e}");
    assert!(at.residual < 1e-9, "{at:?}");
}

/// u T/2 pi and u in position and velocity, u = c' - v-, and T u/(u + |v-|) in the period, all by one factor; rounding moves a gap by that of a
/// position, and of an angle of a turn, in which the gap closes by u/omega a radian.
#[test]
#[ignore = "slow"]
fn units_and_roundings_of_a_gap_are_those_of_its_impact() {
    let model = common::osorio();
    for (speeds, revolutions) in [([673.2, 673.3], 1), ([736.0, 736.2], 1), ([739.3, 739.4], 2)] {
        let (cam, all) = found(&model, speeds, revolutions);
        let at = &all[0];
        let (u, omega) = (at.cam_velocity - at.velocity_before, TAU / at.period);
        for side in [Side::Minus, Side::Plus] {
            let map = OneSidedMap::new(&model, &cam, at, side).unwrap();
            let scales = map.scales();
            assert_relative_eq!(scales[0] * omega, scales[1], max_relative = 1e-14);
            assert_relative_eq!(scales[2] * (u + at.velocity_before.abs()), scales[0] * TAU, max_relative = 1e-14);
            let size = at.state.position.abs().max(at.corner.plus.value.abs());
            let expected = tolerance::RUN_ROUNDING.value * (size + TAU * u / omega);
            assert_relative_eq!(map.gap_rounding(), expected, max_relative = 1e-13);
        }
    }
}

/// A run whose event is no impact is another way around, though it has as many events as the orbit.
#[test]
fn a_sample_of_other_events_is_none_of_the_orbit() {
    let model = common::osorio();
    let (cam, all) = found(&model, [673.2, 673.3], 1);
    let at = &all[0];
    let map = OneSidedMap::new(&model, &cam, at, Side::Minus).unwrap();
    let machine = Machine::new(cam.clone(), &model.follower, TAU / at.period);
    let mut events: Vec<Event> = Vec::new();
    let mut motion = machine.start(0.0, at.state).unwrap();
    let goal = Goal { revolution: 1, cam_angle: 0.0 };
    let ended = machine.advance(&mut motion, goal, &mut |event: &Event| {
        events.push(*event);
        ControlFlow::Continue(())
    });
    assert!(ended.unwrap().is_continue() && events.len() == 1, "{events:?}");
    assert!(map.past_corner(&cam, 0.0, &events).is_some());
    events[0].kind = EventKind::Stick;
    assert_eq!(map.past_corner(&cam, 0.0, &events), None);
    assert_eq!(map.past_corner(&cam, 0.0, &[]), None);
}

/// Where the nose ends, and how round it is, is nothing to the flank: a follower that comes down on it is where it was, and the corner is not.
#[test]
fn an_impact_is_past_the_corner_where_that_is_now() {
    let model = common::osorio();
    let (cam, all) = found(&model, [673.2, 673.3], 1);
    let at = &all[0];
    for name in ["cam.nose_end_deg", "cam.nose_radius"] {
        let map = OneSidedMap::by(&model, &cam, at, Side::Minus, &Varied::Number(name.into())).unwrap();
        let sample = map.sample(Vector3::new(0.0, 0.0, map.scales()[2])).unwrap();
        assert!(sample.end.abs() <= map.rounding() * 1e4, "{name}: {sample:?}");
        let value = model.numbers().find(|(path, _)| *path == name).unwrap().1;
        let other = common::cam(&model.with_number(name, value + sample.perturbation[2]).unwrap());
        let there = other.corners().iter().find(|corner| corner.segment == at.corner.segment).unwrap();
        assert!((there.angle - at.corner.angle).abs() > 1e-4, "{name}");
        assert_relative_eq!(sample.past_corner, at.corner.angle - there.angle, epsilon = 1e-12);
    }
}

/// A unit of velocity moves the impact by 2e-3 rad, and a law goes on for 5e-2 at most. Of a period that is a third longer there are two impacts,
/// of one that is as much shorter there is none.
#[test]
fn a_sample_out_of_reach_is_refused_with_its_impacts() {
    let model = common::osorio();
    let (cam, all) = found(&model, [673.2, 673.3], 1);
    let at = &all[0];
    for side in [Side::Minus, Side::Plus] {
        let map = OneSidedMap::new(&model, &cam, at, side).unwrap();
        let scales = map.scales();
        let of = |direction: usize, times: f64| {
            let mut z = Vector3::zeros();
            z[direction] = times * scales[direction];
            map.sample(z)
        };
        assert!(of(1, 1.0).unwrap().past_corner > 2e-3, "{side:?}");
        for (direction, times, count) in [(1, 40.0, 1), (1, -40.0, 1), (2, 1000.0, 2), (2, -1000.0, 0)] {
            match of(direction, times) {
                Err(SampleError::OtherImpacts { impacts, expected, sticks, .. }) => {
                    assert_eq!((impacts, expected, sticks), (count, 1, false), "{side:?} {direction} {times}");
                }
                other => panic!("{side:?} {direction} {times}: {other:?}"),
            }
        }
    }
}

/// Without restitution it stays on the flank, and leaves it again.
#[test]
fn a_sample_that_sticks_is_refused_as_such() {
    let model = common::osorio_with(&[("restitution", "0.0")]);
    let (cam, all) = found(&model, [822.0, 823.0], 1);
    match OneSidedMap::new(&model, &cam, &all[0], Side::Minus).err() {
        Some(SampleError::OtherImpacts { impacts, sticks, .. }) => assert_eq!((impacts, sticks), (1, true)),
        other => panic!("{other:?}"),
    }
    assert!(OneSidedMap::new(&model, &cam, &all[0], Side::Plus).is_ok());
}

/// Where the corner comes last of six impacts, where six amplify what is not known of those before, and where it comes first of two in two
/// revolutions: map and border are off by no more than is said, which is little.
#[test]
#[ignore = "slow"]
fn differences_know_their_errors_wherever_the_corner_comes() {
    for (model, speeds, revolutions) in [
        (read("laws/polynomial"), [419.8, 419.9], 1),
        (common::tutorial("own.toml"), [1234.3, 1234.5], 1),
        (common::osorio(), [739.3, 739.4], 2),
    ] {
        let (cam, all) = found(&model, speeds, revolutions);
        let at = &all[0];
        let exact = variational::route(&model, &cam, at);
        let (e, f) = exact.own.border.unwrap();
        for side in [Side::Minus, Side::Plus] {
            let of = if side == Side::Minus { exact.map.minus } else { exact.map.plus };
            let (value, error) = finite_difference::side_map(&model, &cam, at, side, &Varied::Period).unwrap();
            assert!((value.map.a - of.a).abs() <= error.map.a, "{side:?} {} {}", value.map.a, error.map.a);
            assert!((value.map.b - of.b).abs() <= error.map.b, "{side:?} {} {}", value.map.b, error.map.b);
            assert!(error.map.a.norm() < 1e-6 * of.a.norm() && error.map.b.norm() < 1e-6 * of.b.norm(), "{side:?}");
            let gap = Vector3::new(e[0], e[1], f).transpose();
            assert!((value.gap - gap).abs() <= error.gap, "{side:?} {} {gap} {}", value.gap, error.gap);
            assert!(error.gap.min() > 0.0 && error.gap.norm() < 1e-6 * gap.norm(), "{side:?} {}", error.gap);
        }
    }
}

/// A machine that is lower by 40 mm, cam and spring together, is the same machine: B by the base is the same where that is 0, and known to no
/// less than a rounding of the lift over the step that it is differenced by, a 64th of the number, or of one unit where it is 0, at most.
#[test]
#[ignore = "slow"]
fn b_by_the_base_of_a_cam_does_not_hang_on_where_it_is() {
    let model = read("laws/program");
    let CamProfile::Program(_) = &model.cam else { panic!("{:?}", model.cam) };
    let [lower, higher] = [0.0, 10.0]
        .map(|base| model.changed(&[("cam.base".into(), base), ("rest_position".into(), base - 0.02)]).unwrap());
    let found = [&model, &lower, &higher].map(|model| {
        let (cam, all) = found(model, [2257.0, 2258.0], 1);
        let route = variational::route_by(model, &cam, &all[0], &Varied::Number("cam.base".into())).unwrap();
        let Some(Uncertainty::Extrapolation(off)) = route.uncertainty else { panic!("{route:?}") };
        (route.map.minus.b, off.minus.b, cam.top())
    });
    let [(here, ..), (there, ..), (above, ..)] = found;
    assert!((here - there).norm() < 1e-9 * here.norm() && (here - above).norm() < 1e-9 * here.norm(), "{found:?}");
    for ((b, error, top), step) in found.into_iter().zip([0.04, 1.0, 10.0].map(|number| number / 64.0)) {
        let least = b.abs() * (tolerance::ULP.value * top / step);
        assert!(least <= error && error.norm() < 1e-9 * b.norm(), "{least} {error} {b}");
    }
}

/// A row's error is as large a part of its coefficient as that of the flights that it is made of.
#[test]
fn errors_of_jumps_are_in_the_units_of_their_coefficients() {
    for example in EXAMPLES.iter() {
        let (model, cam, approach) = example.build().unwrap();
        let compared = compare(&model, &cam, &approach).unwrap();
        let rows = |quantity: PowerLawQuantity| compared.rows.iter().find(move |row| row.quantity == quantity);
        let (Some(of_position), Some(of_period)) =
            (rows(PowerLawQuantity::MapOfPosition), rows(PowerLawQuantity::MapOfPeriod))
        else {
            continue;
        };
        let sides = SideFlights::new(&model, &cam, &approach).unwrap();
        for (row, direction, component) in [(of_position, 0, 0), (of_period, 2, 1)] {
            let mut z = Vector3::zeros();
            z[direction] = sides.scales()[direction];
            let flown = sides.along(z).unwrap()[component].coefficient;
            let told = row.measured.coefficient;
            assert_relative_eq!(told.error / told.value, flown.error / flown.value, max_relative = 1e-12);
        }
    }
}

/// A cam of two slopes, from `first` to half a turn on and back, under a gravity, m/s^2, and with a restitution.
fn roof([gravity, restitution]: [f64; 2], first: f64, slope: f64) -> Model {
    let half = |start: u32, first: f64, slope: f64| {
        format!("[[cam.segment]]\nstart_deg = {start}\ncoefficients = [{first:?}, {slope:?}]\n")
    };
    let text = format!(
        "[follower]\nmass = 1\ndamping = 0\nstiffness = 0\ngravity = {gravity:?}\nrest_position = 0\n\
         restitution = {restitution:?}\n[cam]\nlaw = \"polynomial\"\n{}{}",
        half(0, first, slope),
        half(180, first + slope * PI, -slope)
    );
    Model::parse("roof.toml", &text).unwrap()
}

/// Two slopes of 1/2 that meet at a top, and no force. The follower comes down to the rise in `t = span (v/omega - s)/(v - s omega')`, at which
/// the corner has passed for `t - span/omega'`.
#[test]
fn a_flight_without_force_meets_a_slope_when_it_must() {
    let model = roof([0.0, 0.8], 1.0, 0.5);
    let cam = common::cam(&model);
    let (corner, omega, slope) = (cam.corners()[1], 2.0, 0.5);
    let velocity = omega * slope - 6.0;
    let approach = Approach::new(corner, omega, velocity).unwrap();
    let sides = SideFlights::new(&model, &cam, &approach).unwrap();
    for times in [1.0, -1.0, 0.3] {
        let longer = times * sides.scales()[2];
        let pair = sides.pair(Vector3::new(0.0, 0.0, longer)).unwrap();
        let other = TAU / (TAU / omega + longer);
        let time = sides.span() * (velocity / omega - slope) / (velocity - slope * other);
        assert_relative_eq!(pair.offset, time - sides.span() / other, max_relative = 1e-9);
    }
}

/// Between two hollows, without restitution: a follower that comes down on either of them is pressed on and stays, so that there are no flights,
/// however short: the shortest that is tried is half a turn over 2^11.
#[test]
fn flights_that_stick_are_none() {
    let half =
        |start: u32| format!("[[cam.segment]]\nstart_deg = {start}\ncoefficients = [1.0, -0.8, 0.25464790894703254]\n");
    let follower =
        "[follower]\nmass = 1\ndamping = 0\nstiffness = 0\ngravity = 1\nrest_position = 0\nrestitution = 0\n";
    let text = format!("{follower}[cam]\nlaw = \"polynomial\"\n{}{}", half(0), half(180));
    let model = Model::parse("hollows.toml", &text).unwrap();
    let cam = common::cam(&model);
    let corner = cam.corners()[1];
    let approach = Approach::new(corner, 1.3, 1.3 * corner.minus.slope - 6.0).unwrap();
    match gap(&model, &cam, &approach) {
        Err(JumpOrderError::NotFree { least, .. }) => assert_relative_eq!(least, PI / 2048.0, max_relative = 1e-12),
        other => panic!("{other:?}"),
    }
}

/// Wider and wider deviations, each run once more over the continued law: a sample that is taken has all other impacts on their own segments.
/// The last of six is 0.03 rad from the end of its own, and there are such that have it after that with the corner's impact still in reach; of
/// the other of two there are such that have it before.
#[test]
#[ignore = "slow"]
fn a_sample_has_every_impact_on_its_own_segment() {
    let (mut before, mut after) = (0, 0);
    for (model, speeds) in
        [(read("laws/polynomial"), [419.8, 419.9]), (common::osorio_with(&[("restitution", "0.4")]), [640.7, 640.9])]
    {
        let (cam, all) = found(&model, speeds, 1);
        let (at, reach) = (&all[0], 0.05);
        let (flights, _) = at.course();
        for side in [Side::Minus, Side::Plus] {
            let map = OneSidedMap::new(&model, &cam, at, side).unwrap();
            let continued = cam.continued(&at.corner, side, reach).unwrap();
            for (direction, times) in (0..3).flat_map(|direction| (-15..=15).map(move |times| (direction, times))) {
                let mut z = Vector3::zeros();
                z[direction] = f64::from(times) * map.scales()[direction];
                let machine = Machine::new(continued.clone(), &model.follower, TAU / (at.period + z[2]));
                let start = State { position: at.state.position + z[0], velocity: at.state.velocity + z[1] };
                let (mut motion, mut events) = (machine.start(at.section_angle(), start).unwrap(), Vec::new());
                let goal = Goal { revolution: 1, cam_angle: at.section_angle() };
                let _ = machine.advance(&mut motion, goal, &mut |event: &Event| {
                    events.push(*event);
                    ControlFlow::Continue(())
                });
                if events.len() != flights.len() || events.iter().any(|event| event.kind != EventKind::Impact) {
                    continue;
                }
                let (mut turned, mut is_close, mut is_before, mut is_after) = (0.0, false, false, false);
                for (event, (turn, index)) in events.iter().zip(&flights) {
                    turned += turn;
                    let (later, impact) = (event.turned_since(at.section_angle()) - turned, &at.cycle.impacts[*index]);
                    let segment = &cam.segments()[impact.segment];
                    if *index == at.impact {
                        is_close = later.abs() < reach;
                    } else {
                        is_before |= impact.cam_angle + later < segment.start;
                        is_after |= impact.cam_angle + later > segment.end;
                    }
                }
                let is_off = is_before || is_after;
                assert!(!is_off || map.sample(z).is_err(), "{} {side:?} {direction} {times}", model.name);
                before += usize::from(is_close && is_before);
                after += usize::from(is_close && is_after);
            }
        }
    }
    assert!(before > 0 && after > 0, "{before} {after}");
}

/// On a slope of 1/2 up or down under a gravity of 190 m/s^2 a follower that closes at u comes back after `2 r u/g`, here 12.6 ms at 6 m/s: in half
/// a turn over 2^8, 9.4 ms from the corner, it does not. Under the other law it closes at 7.3 or 4.7 m/s, and comes back after 15.4 or 9.9 ms. A
/// flight that is 3 ms or 1 ms early comes back in time under one of the laws, 8.4 or 8.1 ms from the corner, and is no flight of both.
#[test]
fn a_flight_that_comes_back_under_one_law_is_none() {
    for (slope, early) in [(-0.5, 3e-3), (0.5, 1e-3)] {
        let model = roof([190.0, 0.2], 3.0, slope);
        let cam = common::cam(&model);
        let (corner, omega) = (cam.corners()[1], 1.3);
        let approach = Approach::new(corner, omega, omega * slope - 6.0).unwrap();
        let sides = SideFlights::new(&model, &cam, &approach).unwrap();
        assert_relative_eq!(sides.span(), PI / 256.0, max_relative = 1e-14);
        // Lower when the corner passes, by what it falls past the slope until then.
        let lower = 6.0 * early - 0.5 * 190.0 * early * early;
        let flight = |lower: f64| sides.pair(Vector3::new(-lower, 0.0, 0.0));
        assert!(flight(lower).is_none() && flight(-lower).is_some(), "{slope}: {:?}", flight(lower));
    }
}

/// Two laws whose curvatures differ by 1e-7 m move flights that are 0.1 rad from the corner by 1e-9 m and less, and rounding moves them by 1e-14 m:
/// the exponent would have fewer digits than are promised.
#[test]
fn a_jump_that_rounding_hides_has_no_exponent() {
    // 1 + a x^2 (pi - x)^2, whose curvature is 2 a pi^2 where it meets the dwell.
    let a = 1e-7 / (2.0 * PI * PI);
    let follower =
        "[follower]\nmass = 1\ndamping = 0\nstiffness = 0\ngravity = 0\nrest_position = 0\nrestitution = 0.8\n";
    let hump = format!("start_deg = 0\ncoefficients = [1.0, 0.0, {:e}, {:e}, {a:e}]", a * PI * PI, -2.0 * PI * a);
    let cam = format!("[[cam.segment]]\n{hump}\n[[cam.segment]]\nstart_deg = 180\ncoefficients = [1.0]\n");
    let model = Model::parse("hump.toml", &format!("{follower}[cam]\nlaw = \"polynomial\"\n{cam}")).unwrap();
    let cam = common::cam(&model);
    let corner = cam.corners()[1];
    assert_relative_eq!(corner.jump, -1e-7, max_relative = 1e-6);
    let approach = Approach::new(corner, 1.3, -6.0).unwrap();
    match SideFlights::new(&model, &cam, &approach).unwrap().at_corner() {
        Err(JumpOrderError::Unresolved { resolved, tried, needed }) => assert!(resolved < needed && needed < tried),
        other => panic!("{other:?}"),
    }
}
