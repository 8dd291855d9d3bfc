//! Do runs, sweeps, branches, verifications and corner impacts tell what they promise at the ends of what they may be asked?

use std::f64::consts::TAU;

use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::agreement::{Agreement, Quantity, compare_routes};
use corner_impact::cam::Side;
use corner_impact::corner::map::{RouteName, SideMap, Uncertainty};
use corner_impact::corner::{CornerMap, finite_difference, least_squares, variational};
use corner_impact::flight::State;
use corner_impact::model::{Model, Study};
use corner_impact::orbit::branch::Following;
use corner_impact::orbit::long_run::Budget;
use corner_impact::orbit::{Parameter, Search};
use corner_impact::progress::Unwatched;
use corner_impact::simulate::EventKind;
use corner_impact::study::StudyError;
use corner_impact::study::continuation::branches;
use corner_impact::study::diagram::{loads, on_attractors, one_row};
use corner_impact::study::locate::{Happens, locate};
use corner_impact::study::simulate::{RunRequest, Sight, Simulation, Until};
use corner_impact::study::survey::{
    Axis, Beginning, Place, Placed, Places, Point, Sample, Section as Shows, Start, Survey, Sweep, Values,
};
use corner_impact::study::verify::{External, verify};
use corner_impact_cli::figures::Shown;
use serde_json::{Value, json};

use crate::chart_store::START;
use crate::common;
use crate::orbit_numbers::{machine, model};

/// Revolutions that are drawn are the last ones, a strobe shows each passage of its angle, and impacts are counted up to their number.
#[test]
fn a_run_shows_what_is_asked_for() {
    let paper = common::osorio();
    let start = Start { cam_angle: 1.0, follower: Placed::OnCam(2.0) };
    let simulation = Simulation::new(&paper, 700.0, start).unwrap();
    let wanted = RunRequest { until: Until::Revolutions(5), events: true, strobe: Some(2.0), drawn: 2, long_run: None };
    let (mut events, mut states) = (Vec::new(), Vec::new());
    let run = |wanted: RunRequest, see: &mut dyn FnMut(Sight<'_>)| {
        simulation.run(wanted, &Unwatched, |sight| -> Result<(), StudyError> {
            see(sight);
            Ok(())
        })
    };
    let found = run(wanted, &mut |sight| match sight {
        Sight::Events(some) => events.extend_from_slice(some),
        Sight::State(motion) => states.push(*motion),
    })
    .unwrap();
    assert_eq!((found.revolutions, found.end.cam_angle_rad), (5.0, 1.0));
    let before = found.before_drawn;
    assert_eq!((before.revolution, before.cam_angle), (3, 1.0));
    assert_eq!(
        states.iter().map(|it| (it.revolution, it.cam_angle)).collect::<Vec<_>>(),
        [0, 1, 2, 3, 4].map(|it| (it, 2.0))
    );
    let count = |kind: EventKind| events.iter().filter(|event| event.kind == kind).count() as u64;
    let counts = [EventKind::Impact, EventKind::Stick, EventKind::Release].map(count);
    assert_eq!([found.impacts, found.sticks, found.releases], counts);
    assert!(counts[0] > 3, "{counts:?}");
    // The same by the event loop alone.
    let mut motion = simulation.first;
    simulation.machine.revolve(&mut motion, 3).unwrap();
    assert_abs_diff_eq!(motion.state.position, before.state.position, epsilon = 1e-9);
    simulation.machine.revolve(&mut motion, 2).unwrap();
    assert_abs_diff_eq!(motion.state.position, found.end.position_m, epsilon = 1e-9);
    let whole = run(RunRequest { drawn: 9, strobe: None, events: false, ..wanted }, &mut |sight| {
        assert!(matches!(sight, Sight::Events([])));
    });
    let (before, first) = (whole.unwrap().before_drawn, simulation.first);
    assert_eq!((before.revolution, before.cam_angle, before.state), (first.revolution, first.cam_angle, first.state));
    let counted = run(RunRequest { until: Until::Impacts(3), strobe: None, ..wanted }, &mut |_| ()).unwrap();
    assert_eq!(counted.impacts, 3);
    let third = events.iter().filter(|it| it.kind == EventKind::Impact).nth(2).unwrap();
    assert_abs_diff_eq!(counted.end.cam_angle_rad, third.cam_angle, epsilon = 1e-9);
    assert_relative_eq!(
        counted.revolutions,
        third.revolution as f64 + (third.cam_angle - 1.0) / TAU,
        max_relative = 1e-12
    );
}

/// A follower that nothing draws to the cam comes to it once, after thousands of revolutions, and is waited for a hundred thousand more.
#[test]
fn the_next_impact_is_waited_for_from_the_last_one_on() {
    let free = "[follower]\nmass = 1\ndamping = 0\nstiffness = 0\ngravity = 0\nrest_position = 0\nrestitution = 0.5\n[cam]\n\
                law = \"harmonic\"\noffset = 0.0\namplitudes = [0.001]\nphases_deg = [0.0]\n";
    let free = Model::parse("free.toml", free).unwrap();
    // A metre at a millimetre a second is 11,667 revolutions.
    let start = Start { cam_angle: 0.0, follower: Placed::At(State { position: 1.0, velocity: -0.001 }) };
    let wanted = RunRequest { until: Until::Impacts(5), events: false, strobe: None, drawn: 0, long_run: None };
    let simulation = Simulation::new(&free, 700.0, start).unwrap();
    let found = simulation.run(wanted, &Unwatched, |_| -> Result<(), StudyError> { Ok(()) }).unwrap_err();
    let StudyError::NoImpact { waited, impacts, revolution, .. } = found else { panic!("{found}") };
    assert_eq!(waited, 100_000);
    assert!((1..4).contains(&impacts) && (111_600..116_500).contains(&revolution), "{impacts} {revolution}");
}

pub fn sweep(model: &Model, low: f64, high: f64, count: usize, section: Shows) -> Sweep {
    let speeds = Axis::new(Parameter::Speed, &Values::linear(low, high, count));
    Sweep {
        over: Survey::new(model, None, speeds, None).unwrap(),
        starts: Beginning::One(START),
        following: corner_impact::study::survey::SweepStart::Nothing,
        transient: 20,
        record: 3,
        section,
        growth: None,
    }
}

/// Impacts in degrees, positions as they are; of one speed a hundredth of it to either side, and one exponent a speed.
#[test]
fn a_picture_of_a_sweep_shows_its_places() {
    let paper = common::osorio();
    let places = |shown: Shown| shown.places();
    let mut several = Shown::new(&sweep(&paper, 600.0, 700.0, 3, Shows::Strobe(1.0)));
    let block = |rpm: f64, exponent: f64| Places { places: vec![[rpm, 1.0]], exponent: Some([rpm, exponent]) };
    [block(600.0, 0.1), block(600.0, 0.2), block(650.0, 0.3)].iter().for_each(|it| several.take(it));
    let (density, exponents) = places(several);
    assert_eq!((density.outside(), exponents), (0, vec![[600.0, 0.1], [650.0, 0.3]]));
    let [low, high] = density.extent().unwrap();
    assert!(low > 0.5 && high < 1.5);
    let mut one = Shown::new(&sweep(&paper, 700.0, 700.0, 1, Shows::Impacts));
    one.take(&Places { places: vec![[693.5, 1.0], [692.9, 1.0], [706.5, 2.0], [707.1, 2.0]], exponent: None });
    let (density, exponents) = places(one);
    assert_eq!((density.outside(), exponents.len()), (2, 0));
    let [low, high] = density.extent().unwrap();
    assert!((low - 1.0_f64.to_degrees()).abs() < 1.0 && (high - 2.0_f64.to_degrees()).abs() < 1.0, "{low} {high}");
}

/// What a sweep tells of a speed is what a run from the start comes to there; and a start on each attractor begins in revolution 0.
#[test]
fn a_sweep_is_a_run_at_each_speed() {
    let paper = common::osorio();
    let budget = Budget { transient: 20, record: 3, ..Budget::CHART };
    let over = sweep(&paper, 690.0, 710.0, 3, Shows::Impacts).over;
    let row = one_row(&over, START, budget, Some(1), &Unwatched).unwrap();
    let bears = loads(&over, START, budget, Some(1), &Unwatched).unwrap();
    assert_eq!([row.len(), bears.len()], [3, 3]);
    for ((rpm, point), bears) in [690.0, 700.0, 710.0].into_iter().zip(&row).zip(&bears) {
        let machine = machine(&paper, rpm);
        let expected = Point::of(&machine, START.motion(&machine).unwrap(), budget).unwrap();
        assert_eq!(point.as_ref().unwrap(), &expected);
        assert_eq!(bears.len(), 3);
        assert!(bears.iter().all(|it| it.place == Place::of_speed(rpm) && it.impact_speed > 0.0));
    }
    let motions = on_attractors(&machine(&paper, 678.0), &Sample::Spread(64), Budget::SURVEY).unwrap();
    assert!(motions.len() == 2 && motions.iter().all(|motion| motion.revolution == 0), "{motions:?}");
}

/// What changes is looked for within its range, of which the ends are part; runs settle at the middles of as many parts.
#[test]
fn branches_begin_within_their_range() {
    let paper = common::osorio();
    let wanted = Search { revolutions: 1, impacts: Some(1) };
    let following =
        |range: [f64; 2]| Following { parameter: Parameter::Speed, range, longest_step: 0.5, most_points: 20 };
    let from = |rpm: f64, range: [f64; 2]| branches(&paper, rpm, &wanted, following(range), 0, &Unwatched);
    for range in [[700.0, 702.0], [698.0, 700.0]] {
        let found = from(700.0, range).unwrap();
        assert!(found.branches.iter().all(|it| it.points.iter().all(|at| range[0] <= at.rpm && at.rpm <= range[1])));
        assert_eq!(found.title(), "osorio-2008: orbits found at 700 rpm, followed in speed");
        let settled = found.settled(2, &Unwatched).unwrap();
        let mut speeds: Vec<f64> = settled.iter().map(|[rpm, _]| *rpm).collect();
        speeds.dedup();
        assert_eq!(speeds, [range[0] + 0.5, range[0] + 1.5]);
        // A hundred revolutions of one impact each.
        assert_eq!(settled.len(), 200);
    }
    for range in [[700.1, 702.0], [698.0, 699.9]] {
        let outside = from(700.0, range).map(|_| ()).unwrap_err();
        let StudyError::Outside { name, value, range: told, .. } = outside else { panic!("{outside}") };
        assert_eq!((name.as_str(), value, told), ("rpm", 700.0, range));
    }
    let none = from(50.0, [40.0, 60.0]).map(|_| ()).unwrap_err();
    assert!(matches!(none, StudyError::NothingToFollow { revolutions: 1, rpm: 50.0, .. }), "{none}");
    let parameter = Parameter::named(&paper, "restitution").unwrap();
    let following = Following { parameter, ..following([0.7999, 0.8001]) };
    let found = branches(&paper, 700.0, &wanted, following, 0, &Unwatched).unwrap();
    assert!(found.title().ends_with("followed in follower.restitution"));
}

/// Numbers of pairs and of printed digits by what came of them, and entries by each route in the order of their names.
#[test]
fn a_verification_counts_what_came_of_it() {
    let mut found = verify(&common::osorio(), External::LeftOut).unwrap();
    let tally = found.tally();
    let following = found.comparisons.iter().filter(|pair| pair.follows).count();
    assert!(following > 0 && tally.following == following && tally.comparisons == found.comparisons.len() - following);
    assert_eq!((tally.agreeing, tally.following_agreeing), (tally.comparisons, tally.following));
    assert_eq!(tally.printed, found.published.len());
    assert_eq!(tally.printed_right + tally.printed_wrong, tally.printed);
    let wrong = found.published.iter().filter(|it| !it.agreement.agrees).count();
    assert!(wrong > 0 && tally.printed_wrong == wrong && tally.printed_otherwise == 0);
    for side in [Side::Minus, Side::Plus] {
        let entries = found.entries(side);
        let names: Vec<RouteName> = found.routes_by_name().map(|route| route.name).collect();
        assert!(names.is_sorted() && names.len() == found.routes.len());
        for (index, entry) in entries.iter().enumerate() {
            let values: Vec<f64> = found.routes_by_name().map(|route| route.map.of(side).entries()[index]).collect();
            assert_eq!(entry.values, values);
            let apart = values.iter().flat_map(|one| values.iter().map(move |two| one - two)).fold(0.0, f64::max);
            assert_eq!(entry.spread, apart, "{}", entry.entry);
            assert!(entry.printed.as_ref().is_some_and(|it| it.parse::<f64>().is_ok()), "{entry:?}");
        }
    }
    let pair = found.comparisons.iter().position(|pair| !pair.follows).unwrap();
    found.comparisons[pair].agrees = false;
    let pair = found.comparisons.iter().position(|pair| pair.follows).unwrap();
    found.comparisons[pair].agrees = false;
    let right = found.published.iter().position(|it| it.agreement.agrees).unwrap();
    found.published[right].as_found = false;
    let then = found.tally();
    assert_eq!((then.agreeing, then.following_agreeing), (tally.agreeing - 1, tally.following - 1));
    assert_eq!((then.printed_right, then.printed_otherwise, then.printed_wrong), (tally.printed_right - 1, 1, wrong));
}

/// Of a corner of velocity the side alone that the orbit is on has a map; a higher derivative leaves one matrix.
#[test]
fn a_corner_impact_is_told_by_its_order() {
    let range = Study { rpm_min: 673.0, rpm_max: 673.5 };
    let found = locate(&common::osorio(), range, 1, &Unwatched).unwrap();
    assert!(found.agrees && found.measured.is_none());
    // The route whose map is told is held against each other one first.
    assert_eq!(found.found[0].comparisons[0].routes[0], RouteName::Variational);
    let at = |jump_order: usize, side: Side, local: Happens| {
        let mut found = found.found[0].clone();
        (found.at.corner.jump_order, found.at.side, found.local) = (jump_order, side, local);
        serde_json::to_value(&found).unwrap()
    };
    for (side, name) in [(Side::Minus, "minus"), (Side::Plus, "plus")] {
        let gap = at(1, side, Happens::Gap);
        assert_eq!((&gap["side"], gap["classification"]["scenario"].as_str()), (&json!(name), Some("gap")));
        assert_eq!(gap["map"].as_object().unwrap().keys().collect::<Vec<_>>(), [name]);
    }
    for (order, local, scenario) in
        [(2, found.found[0].local.clone(), "nonsmooth-fold"), (3, Happens::Smooth, "smooth")]
    {
        let told = at(order, Side::Plus, local);
        assert_eq!((&told["side"], told["classification"]["scenario"].as_str()), (&Value::Null, Some(scenario)));
        assert_eq!(told["map"].as_object().unwrap().len(), 2);
    }
    let polynomial = model("laws/polynomial");
    let none = locate(&polynomial, Study { rpm_min: 700.0, rpm_max: 701.0 }, 1, &Unwatched).unwrap();
    assert!(none.found.is_empty() && none.agrees);
}

/// Corner impacts of orbits of so many revolutions between speeds: how many estimates are compared at those where the acceleration jumps, and how
/// many left out. Each is compared where it knows the quantity as closely as is asked, by three standard errors and the bias of a fit, by the
/// errors of differences: a fit is left out wherever it does not, and differences where they miss by no more than they say. The C of both
/// sides is known as A is, D as B.
fn compared(model: &Model, [rpm_min, rpm_max]: [f64; 2], revolutions: u64) -> [usize; 2] {
    let cam = common::cam(model);
    let found = locate(model, Study { rpm_min, rpm_max }, revolutions, &Unwatched).unwrap().found;
    let (mut compared, mut left_out) = (0, 0);
    for it in found.iter().filter(|it| it.at.corner.jump_order == 2) {
        let routes = [
            variational::route(model, &cam, &it.at),
            finite_difference::route(model, &cam, &it.at).unwrap(),
            least_squares::route(model, &cam, &it.at).unwrap(),
        ];
        for pair in compare_routes(&routes).into_iter().filter(|pair| pair.routes[0] == RouteName::Variational) {
            let route = routes.iter().find(|route| route.name == pair.routes[1]).unwrap();
            let largest = |errors: &CornerMap| {
                let a = |side: &SideMap| side.a.amax();
                let b = |side: &SideMap| side.b.amax();
                match pair.quantity {
                    Quantity::A(side) | Quantity::Eigenvalues(side) => a(errors.of(side)),
                    Quantity::B(side) => b(errors.of(side)),
                    Quantity::C => a(&errors.minus).max(a(&errors.plus)),
                    _ => b(&errors.minus).max(b(&errors.plus)),
                }
            };
            let (known, is_fit) = match route.uncertainty.as_ref().unwrap() {
                Uncertainty::Fit { standard, systematic, .. } => {
                    (3.0 * largest(standard) + systematic.as_ref().map_or(0.0, largest), true)
                }
                Uncertainty::Extrapolation(errors) => (largest(errors), false),
            };
            let known = if pair.quantity == Quantity::Border { route.own.border_error.unwrap() } else { known };
            let is_known = known <= pair.bound.value || !(is_fit || !pair.agrees && pair.max_abs_diff <= known);
            let is_there = |one: &Agreement| one.routes == pair.routes && one.quantity == pair.quantity;
            assert_eq!(it.comparisons.iter().any(is_there), is_known, "{pair:?} {known:e}");
            *(if is_known { &mut compared } else { &mut left_out }) += 1;
        }
        assert!(it.agrees, "{it:?}");
    }
    [compared, left_out]
}

/// At the first of two corner impacts all are known, at the second the fit is not.
#[test]
#[ignore = "slow"]
fn estimates_are_compared_where_they_know_enough() {
    let counts = [[739.3, 739.4], [754.6, 754.7]].map(|range| compared(&common::osorio(), range, 2));
    let [all, left_out] = [0, 1].map(|index| counts[0][index] + counts[1][index]);
    assert!(all > 0 && left_out > 0, "{counts:?}");
}

/// Differences that agree are compared though they promise less than is asked, and C of a fit that knows A so closely though it knows B less.
#[test]
fn estimates_that_agree_or_know_enough_of_one_quantity_are_compared() {
    let softer = model("nonsmooth-flip").with_number("follower.restitution", 0.8).unwrap();
    let rpm = verify(&softer, External::LeftOut).unwrap().at.speed_rpm();
    for (model, rpm) in [(&model("sharp-nose"), 759.513), (&softer, rpm)] {
        let [all, _] = compared(model, [rpm - 0.01, rpm + 0.01], 1);
        assert!(all >= 8, "{}: {all}", model.name);
    }
}

/// Next to this corner impact a follower that loses nearly all impacts twice: what cannot be estimated there is no agreement, though the routes that
/// are left agree.
#[test]
fn routes_that_fail_are_no_agreement() {
    let model = model("persistence").with_number("follower.restitution", 0.02).unwrap();
    let model = model.with_number("follower.damping", model.follower.damping + 1.0).unwrap();
    let rpm = verify(&model, External::LeftOut).unwrap().at.speed_rpm();
    let all = locate(&model, Study { rpm_min: rpm - 0.01, rpm_max: rpm + 0.01 }, 1, &Unwatched).unwrap();
    let [it] = &all.found[..] else { panic!("{all:?}") };
    assert!(it.skipped.iter().any(|skipped| skipped.failed) && it.comparisons.iter().all(|pair| pair.agrees), "{it:?}");
    assert!(!it.agrees && !all.agrees);
}

/// On a cam whose lift is five million times its rise from 0 doubles keep a digit or two fewer of the orbit than routes are asked for:
/// nothing fails, and what differs by more than it may is no agreement.
#[test]
fn routes_that_differ_are_no_agreement() {
    // A parabola that falls off after the corner at 90 degrees, and one that leads up to it again.
    let (lift, slope, cap) = (2.0_f64.powi(22), 0.3, 0.6_f64);
    let text = format!(
        "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 12.0\ngravity = 0.0\nrest_position = {:?}\nrestitution = 0.8\n\
         [cam]\nlaw = \"polynomial\"\n\
         [[cam.segment]]\nstart_deg = 90.0\ncoefficients = [{lift:?}, {slope:?}, {:?}]\n\
         [[cam.segment]]\nstart_deg = {:?}\ncoefficients = [{lift:?}, {:?}, {:?}]\n\
         [study]\nrpm_min = 66.0\nrpm_max = 68.0\n",
        lift - 0.125,
        -slope / cap,
        90.0 + cap.to_degrees(),
        -slope,
        slope / (TAU - cap)
    );
    let found = verify(&Model::parse("far.toml", &text).unwrap(), External::LeftOut).unwrap();
    assert!(!found.skipped.iter().any(|skipped| skipped.failed), "{:?}", found.skipped);
    let apart: Vec<_> = found.comparisons.iter().filter(|pair| !pair.agrees).map(|pair| pair.quantity).collect();
    assert!(apart.contains(&Quantity::Period) || apart.contains(&Quantity::State), "{apart:?}");
    assert!(!found.agrees);
}
