//! Is what is found at a corner impact the same in whatever units of length the model is written, errors included?
//!
//! Lengths are scaled by 2^60 or 2^-60, and masses besides: a sum of a length and an angle, or a choice by one, comes out as another. So are times
//! where no speed has to be searched for, since searches are over a grid in rpm.

use corner_impact::corner::jump_order::Approach;
use corner_impact::corner::jump_order::measured::{MeasuredLaw, SideFlights, gap};
use corner_impact::corner::map::{CornerMap, Route, Uncertainty};
use corner_impact::corner::range::find_corner_impacts;
use corner_impact::corner::varied::Varied;
use corner_impact::corner::{CornerImpact, finite_difference, least_squares, variational};
use corner_impact::estimate::Estimate;
use corner_impact::model::{Model, Study};
use corner_impact::progress::Unwatched;
use nalgebra::Vector3;

use crate::common;
use crate::scales::in_units;

const LENGTH: i32 = 60;
const TIME: i32 = -20;

/// Numbers, each with its power of a length.
type Numbers = Vec<(f64, i32)>;

fn found(model: &Model, [rpm_min, rpm_max]: [f64; 2], revolutions: u64) -> Vec<CornerImpact> {
    let cam = common::cam(model);
    find_corner_impacts(model, &cam, Study { rpm_min, rpm_max }, revolutions, &Unwatched).unwrap().found
}

fn of_impact(at: &CornerImpact) -> Numbers {
    let mut all = vec![(at.period, 0), (at.residual, 0), (at.closure, 0), (at.section_angle(), 0)];
    all.extend([at.velocity_before, at.velocity_after, at.cam_velocity, at.state.position].map(|of| (of, 1)));
    all.extend(at.cycle.impacts.iter().flat_map(|impact| [(impact.cam_angle, 0), (impact.velocity_before, 1)]));
    all
}

/// A is of no length, as of state by state; B is of one, as of state by period.
fn of_map(map: &CornerMap) -> Numbers {
    let sides = [map.minus, map.plus];
    sides.iter().flat_map(|side| side.a.iter().map(|a| (*a, 0)).chain(side.b.iter().map(|b| (*b, 1)))).collect()
}

fn of_route(route: &Route) -> Numbers {
    let mut all = of_map(&route.map);
    match &route.uncertainty {
        Some(Uncertainty::Fit { standard, systematic, condition_number }) => {
            all.extend(of_map(standard));
            all.extend(systematic.iter().flat_map(of_map));
            // The design is the same in all machines but for rounding: its cube is in scales of the impact's own.
            assert!((25.0..40.0).contains(condition_number), "{condition_number}");
            all.push((*condition_number, 0));
        }
        Some(Uncertainty::Extrapolation(error)) => all.extend(of_map(error)),
        None => {}
    }
    if let Some((e, f)) = route.own.border {
        all.extend([(e[0], 0), (e[1], 0), (f, 1)]);
    }
    all
}

#[track_caller]
fn are_scaled(one: &Numbers, other: &Numbers, by: i32) {
    assert!(!one.is_empty() && one.len() == other.len(), "{one:?} {other:?}");
    for ((one, length), (other, _)) in one.iter().zip(other) {
        assert_eq!(one * 2.0_f64.powi(by * length), *other);
    }
}

/// The first corner impact between two speeds, its maps by every route here, and their errors.
#[track_caller]
fn are_the_same(name: &str, speeds: [f64; 2], revolutions: u64, length: i32) {
    let [model, scaled] = [[0; 3], [length, -40, 0]].map(|scales| in_units(name, scales));
    let [here, there] = [&model, &scaled].map(|model| found(model, speeds, revolutions));
    assert!(!here.is_empty() && here.len() == there.len(), "{here:?} {there:?}");
    let (at, scaled_at) = (&here[0], &there[0]);
    are_scaled(&of_impact(at), &of_impact(scaled_at), length);
    assert!(at.bracket[0] <= at.period && at.period <= at.bracket[1], "{at:?}");
    assert_eq!(at.ways, scaled_at.ways);
    // Where the velocity jumps there is no map.
    if at.corner.jump_order == 1 {
        return;
    }
    let routes = |model: &Model, at: &CornerImpact| {
        let cam = common::cam(model);
        let by_rest = Varied::Number("follower.rest_position".into());
        let by_rest = of_map(&finite_difference::route_by(model, &cam, at, &by_rest).unwrap().map);
        [
            of_route(&variational::route(model, &cam, at)),
            of_route(&finite_difference::route(model, &cam, at).unwrap()),
            of_route(&least_squares::route(model, &cam, at).unwrap()),
            // By a length, B is of none.
            by_rest.into_iter().map(|(number, _)| (number, 0)).collect(),
        ]
    };
    for (one, other) in routes(&model, at).iter().zip(routes(&scaled, scaled_at)) {
        are_scaled(one, &other, length);
    }
}

#[test]
fn the_map_of_one_impact_is_the_same_in_any_unit_of_length() {
    are_the_same("osorio-2008", [673.2, 673.3], 1, -LENGTH);
}

/// It has no map.
#[test]
#[ignore = "slow"]
fn a_corner_impact_where_the_velocity_jumps_is_the_same_in_any_unit_of_length() {
    are_the_same("laws/rectified-sine", [18.4, 18.6], 1, LENGTH);
}

#[test]
fn the_map_of_two_impacts_is_the_same_in_any_unit_of_length() {
    are_the_same("osorio-2008", [736.0, 736.2], 1, -LENGTH);
}

#[test]
#[ignore = "slow"]
fn the_map_of_two_revolutions_is_the_same_in_any_unit_of_length() {
    are_the_same("persistence", [465.7, 465.8], 2, LENGTH);
}

#[test]
#[ignore = "slow"]
fn the_map_at_a_smoother_corner_is_the_same_in_any_unit_of_length() {
    are_the_same("laws/program", [2257.0, 2258.0], 1, LENGTH);
}

/// The equation of one impact is searched whatever the speeds are. One that loses nothing has a root in the middle of the follower's own
/// period, where no velocity brings it back in that time.
#[test]
#[ignore = "slow"]
fn one_impact_is_found_and_a_resonance_is_told_in_any_units() {
    for [length, time] in [[0, 0], [LENGTH, TIME], [-LENGTH, -TIME]] {
        let model = in_units("laws/polynomial", [length, 0, time]);
        let rpm = |of: f64| of * 2.0_f64.powi(-time);
        let all = found(&model, [rpm(620.9), rpm(621.0)], 1);
        let [at] = all.as_slice() else { panic!("{time}: {all:?}") };
        assert!((at.speed_rpm() / rpm(620.938131) - 1.0).abs() < 1e-8 && at.is_simple(), "{time}: {at:?}");

        let lossless = model.with_number("follower.restitution", 1.0).unwrap();
        let range = Study { rpm_min: rpm(603.0), rpm_max: rpm(605.0) };
        let all = find_corner_impacts(&lossless, &common::cam(&lossless), range, 1, &Unwatched).unwrap();
        let resonance = rpm(60.0 * 1000.0_f64.sqrt() / std::f64::consts::PI);
        let told = |angle: f64| {
            all.rejected.iter().any(|it| {
                let is_there =
                    it.cam_angle.to_degrees().round() == angle && (it.speed_rpm / resonance - 1.0).abs() < 1e-9;
                is_there && it.why.contains("in resonance")
            })
        };
        assert!(told(90.0) && told(270.0), "{time}: {:?}", all.rejected);
    }
}

/// Of one impact in two revolutions nothing is the paper's.
#[test]
#[ignore = "slow"]
fn only_one_impact_in_one_revolution_is_simple() {
    let all = found(&in_units("laws/polynomial", [0; 3]), [1224.8, 1225.0], 2);
    let one: Vec<_> = all.iter().filter(|at| at.cycle.impacts.len() == 1).collect();
    assert!(!one.is_empty() && one.iter().all(|at| !at.is_simple()), "{all:?}");
}

/// What is measured at a corner by flights alone: exponents, and coefficients with their errors.
#[test]
fn laws_at_a_corner_are_the_same_in_any_units() {
    let measured = |name: &str, corner: usize, omega: f64, closing: f64, scales: [i32; 3]| {
        let factor = |length: i32, time: i32| 2.0_f64.powi(-length * scales[0] - time * scales[2]);
        let model = in_units(name, scales);
        let cam = common::cam(&model);
        let (corner, omega) = (cam.corners()[corner], omega / factor(0, -1));
        let before = omega * corner.minus.slope - closing / factor(1, -1);
        let approach = Approach::new(corner, omega, before).unwrap();
        let sides = SideFlights::new(&model, &cam, &approach).unwrap();
        // Exponents are slopes of logarithms, which round otherwise; all else is the same to the last bit.
        let slope = |of: Estimate| [(of.value, 1e-12), (of.error, 1e-2 * of.error + 1e-14)];
        // Position and velocity, against a time or against a part of a deviation.
        let law = |law: &MeasuredLaw, velocity: i32, by_time: bool| {
            let power = if by_time { law.exponent.value.round() as i32 } else { 0 };
            let unit = factor(1, -velocity - power);
            let Estimate { value, error, .. } = law.coefficient;
            [&slope(law.exponent)[..], &[(value * unit, 0.0), (error * unit, 0.0)]].concat()
        };
        let mut all = vec![(sides.span(), 0.0)];
        let of_both =
            |laws: [MeasuredLaw; 2], by_time: bool| [law(&laws[0], 0, by_time), law(&laws[1], 1, by_time)].concat();
        all.extend(of_both(sides.at_corner().unwrap(), true));
        let scales = sides.scales();
        all.extend([
            (scales[0] * factor(1, 0), 0.0),
            (scales[1] * factor(1, -1), 0.0),
            (scales[2] * factor(0, 1), 0.0),
        ]);
        for direction in 0..3 {
            let mut z = Vector3::zeros();
            z[direction] = 0.5 * scales[direction];
            all.extend(of_both(sides.along(z).unwrap(), false));
        }
        if corner.jump_order == 1 {
            let gap = gap(&model, &cam, &approach).unwrap();
            all.extend(slope(gap.exponent));
            all.extend(gap.limit.iter().enumerate().flat_map(|(index, limit)| {
                [limit.value, limit.error].map(|number| (number * factor(1, -(index as i32)), 0.0))
            }));
        }
        all
    };
    for (name, corner, omega, closing) in [
        ("osorio-2008", 0, 70.0, 300.0),
        ("osorio-2008", 1, 70.0, 300.0),
        ("laws/program", 1, 60.0, 5.0),
        ("laws/program", 0, 60.0, 5.0),
        ("laws/rectified-sine", 1, 1.3, 6.0),
    ] {
        let here = measured(name, corner, omega, closing, [0; 3]);
        let there = measured(name, corner, omega, closing, [LENGTH, -40, TIME]);
        assert_eq!(here.len(), there.len());
        for ((one, allowed), (other, _)) in here.iter().zip(&there) {
            assert!((one - other).abs() <= *allowed, "{name} {corner}: {one} {other}");
        }
    }
}
