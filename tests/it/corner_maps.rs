//! Are the corner maps of any orbit, by any number of the model, those that simulations show?

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::OnceLock;

use crate::common;
use corner_impact::agreement::{Quantity, compare_routes};
use corner_impact::cam::{Cam, Corner, Side};
use corner_impact::corner::least_squares::{Mat, Solver};
use corner_impact::corner::map::RouteName;
use corner_impact::corner::map::Uncertainty;
use corner_impact::corner::one_sided::{OneSidedMap, SampleError};
use corner_impact::corner::varied::{NoChange, Varied};
use corner_impact::corner::{CornerImpact, CornerMap, Route, finite_difference, least_squares, range, variational};
use corner_impact::flight::State;
use corner_impact::model::{Model, Study};
use corner_impact::progress::Unwatched;
use corner_impact::simulate::{Event, Goal, Machine};
use nalgebra::{DMatrix, Matrix2, Vector2, Vector3};

/// A model, its cam, and its corner impact next to a speed.
struct Case {
    model: Model,
    cam: Cam,
    at: CornerImpact,
}

fn case(model: Model, rpm: f64, revolutions: u64) -> Case {
    let cam = common::cam(&model);
    let near = Study { rpm_min: rpm - 1.0, rpm_max: rpm + 1.0 };
    let found = range::find_corner_impacts(&model, &cam, near, revolutions, &Unwatched).unwrap().found;
    let at = found.into_iter().find(|at| (at.speed_rpm() - rpm).abs() < 1e-3).unwrap();
    Case { model, cam, at }
}

fn read(file: &str) -> Model {
    common::read(&Path::new(common::ROOT).join("models").join(file))
}

/// One impact, two in one revolution, two in two, and three in three; three cams, with and without damping.
fn cases() -> &'static [Case] {
    static CASES: OnceLock<Vec<Case>> = OnceLock::new();
    CASES.get_or_init(found)
}

fn found() -> Vec<Case> {
    let damped = common::osorio_with(&[("damping", "1.0")]);
    vec![
        case(common::osorio(), 673.234445, 1),
        case(common::osorio(), 736.110814, 1),
        case(common::osorio(), 739.377930, 2),
        case(common::osorio(), 728.107240, 3),
        case(read("laws/polynomial.toml"), 410.969784, 1),
        case(damped, 730.768847, 1),
    ]
}

fn assert_agree(maps: &[Route], what: &str) {
    let comparisons = compare_routes(maps);
    assert!(!comparisons.is_empty());
    for item in comparisons {
        // A side that a number does not shape has B = 0, and the differences are their own rounding.
        let side = |map: &Route| if item.quantity.to_string() == "B_minus" { map.map.minus.b } else { map.map.plus.b };
        let is_nothing = |map: &Route| map.name == RouteName::Variational && side(map).norm() == 0.0;
        let by_nothing =
            maps.iter().any(is_nothing) && ["B_minus", "B_plus"].contains(&item.quantity.to_string().as_str());
        assert!(item.agrees || (by_nothing && item.max_abs_diff < 1e-9), "{what}: {item:?}");
    }
}

#[test]
#[ignore = "slow"]
fn the_product_around_any_orbit_is_the_map_that_simulations_show() {
    let counts: Vec<_> = cases().iter().map(|case| (case.at.cycle.revolutions, case.at.cycle.impacts.len())).collect();
    assert_eq!(counts, [(1, 1), (1, 2), (2, 2), (3, 3), (1, 2), (1, 2)]);
    for Case { model, cam, at } in cases() {
        let routes = [
            variational::route(model, cam, at),
            finite_difference::route(model, cam, at).unwrap(),
            least_squares::route(model, cam, at).unwrap(),
        ];
        assert_agree(&routes, &format!("{} rpm", at.speed_rpm()));
        // The sides are no copies of one another.
        let [minus, plus] = [routes[0].map.minus, routes[0].map.plus];
        assert!((minus.a - plus.a).norm() > 1e-3 * minus.a.norm() && (minus.b - plus.b).norm() > 1e-3 * minus.b.norm());
    }
}

/// Numbers of the follower and of the cam; damping 0 and corners that are not rounded have no neighbour below.
fn numbers(model: &Model) -> Vec<String> {
    let at_an_end = ["follower.damping", "cam.corner_rounding_deg"];
    let is_varied = |(name, value): &(&str, f64)| !(at_an_end.contains(name) && *value == 0.0);
    model.numbers().filter(is_varied).map(|(name, _)| name.to_owned()).collect()
}

#[test]
#[ignore = "slow"]
fn b_by_every_number_is_what_machines_with_that_number_show() {
    let (mut tried, mut untouched) = (0, 0);
    for Case { model, cam, at } in cases() {
        for name in numbers(model) {
            let by = Varied::Number(name.clone());
            // A polynomial moved alone parts from its neighbour, and is refused as a cam.
            if name.starts_with("cam.segment") {
                continue;
            }
            let product = variational::route_by(model, cam, at, &by).unwrap();
            let differences = finite_difference::route_by(model, cam, at, &by).unwrap();
            tried += 1;
            untouched += usize::from(product.map.minus.b.norm() == 0.0);
            assert_agree(&[product, differences], &format!("{name} at {} rpm", at.speed_rpm()));
        }
    }
    // Eleven of the arcs, six of the polynomial follower, with damping one more.
    assert_eq!(tried, 4 * 11 + 6 + 12);
    assert!((1..4).contains(&untouched), "{untouched}");
}

/// A preload stays when stiffness or cam are others, and numbers are in the units of their fields.
#[test]
fn b_of_a_preloaded_machine_in_grams_is_what_machines_show() {
    let text = common::osorio_text(&[("mass", "1221")]).replace("rest_position = 0.3", "preload = 143.08");
    let model = Model::parse("preloaded.toml", &format!("{text}\n[units]\nmass = \"g\"\n")).unwrap();
    let Case { model, cam, at } = case(model, 673.234445, 1);
    for name in ["follower.mass", "follower.stiffness", "follower.preload", "follower.gravity", "cam.base_radius"] {
        let by = Varied::Number(name.into());
        let product = variational::route_by(&model, &cam, &at, &by).unwrap();
        assert_agree(&[product, finite_difference::route_by(&model, &cam, &at, &by).unwrap()], name);
    }
}

/// Gravity goes on pulling while another number is varied, and is one itself.
#[test]
fn b_of_a_machine_with_gravity_is_what_machines_show() {
    let Case { model, cam, at } = case(read("persistence.toml"), 493.827512922, 1);
    assert!(model.follower.gravity > 0.0);
    for name in ["follower.mass", "follower.stiffness", "follower.gravity"] {
        let by = Varied::Number(name.into());
        let product = variational::route_by(&model, &cam, &at, &by).unwrap();
        assert_agree(&[product, finite_difference::route_by(&model, &cam, &at, &by).unwrap()], name);
    }
}

#[test]
#[ignore = "slow"]
fn a_fit_by_a_number_finds_the_same() {
    let Case { model, cam, at } = case(common::osorio(), 736.110814, 1);
    for name in ["follower.restitution", "cam.flank_start_deg"] {
        let by = Varied::Number(name.into());
        let routes = [
            variational::route_by(&model, &cam, &at, &by).unwrap(),
            least_squares::route_by(&model, &cam, &at, &by).unwrap(),
        ];
        assert_agree(&routes, name);
        let Some(Uncertainty::Extrapolation(error)) = &routes[0].uncertainty else { panic!("{name}: {:?}", routes[0]) };
        let errors = [error.minus.b, error.plus.b];
        assert!(errors.iter().all(|error| error.min() >= 0.0), "{name}: {errors:?}");
        assert_eq!(errors.iter().any(|error| error.max() > 0.0), name.starts_with("cam."), "{name}: {errors:?}");
    }
}

/// The border is one line of the space of states and numbers together: A+ - A- and every B+ - B- side by side have rank one.
/// That a corner moves with a number comes out of the laws on its two sides.
#[test]
#[ignore = "slow"]
fn the_jump_has_rank_one_in_states_and_numbers_together() {
    for Case { model, cam, at } in cases() {
        let jump = |map: &CornerMap| (map.plus.a - map.minus.a, map.plus.b - map.minus.b);
        let (a, b) = jump(&variational::route(model, cam, at).map);
        // In units of the orbit: each column over its own size, velocities over omega.
        let omega = at.angular_velocity();
        let mut columns = vec![a.column(0).into_owned(), a.column(1) * omega, b / at.period];
        for name in numbers(model).iter().filter(|name| !name.starts_with("cam.segment")) {
            let value = model.numbers().find(|(field, _)| field == name).unwrap().1;
            let by = variational::route_by(model, cam, at, &Varied::Number(name.clone())).unwrap();
            columns.push(jump(&by.map).1 * if value == 0.0 { 1.0 } else { value });
        }
        let rows =
            DMatrix::from_fn(2, columns.len(), |row, column| columns[column][row] / if row == 0 { 1.0 } else { omega });
        let values = rows.clone().singular_values();
        assert!(values[1] <= 1e-9 * values[0], "{} rpm: {values}", at.speed_rpm());
        assert!(columns.iter().all(|column| column.iter().all(|entry| entry.is_finite())) && columns.len() >= 8);
    }
}

/// Perturb the orbit, look on which side of the corner the impact falls.
#[test]
#[ignore = "slow"]
fn the_border_says_on_which_side_the_impact_falls() {
    for Case { model, cam, at } in cases() {
        let (e, f) = variational::border(model, cam, at);
        for side in [Side::Minus, Side::Plus] {
            let map = OneSidedMap::new(model, cam, at, side).unwrap();
            for direction in [[1.0, 0.3, 0.2], [-1.0, 0.2, -0.4], [0.1, -1.0, 0.3], [0.2, 0.1, -1.0], [0.0, 0.0, 1.0]] {
                // A quarter of a unit keeps the border straight.
                let sample = map.sample(map.scales().component_mul(&Vector3::from(direction)) * 0.25).unwrap();
                let by_border = (e * sample.perturbation.xy())[0] + f * sample.perturbation[2];
                let speed = at.speed_rpm();
                assert!(by_border * sample.past_corner > 0.0, "{speed} rpm {direction:?}: {by_border} {sample:?}");
            }
        }
    }
}

/// A border is compared with its sign: with -(e, f) both fixed points would turn from faster to slower.
#[test]
#[ignore = "slow"]
fn a_border_whose_sign_is_turned_disagrees() {
    for Case { model, cam, at } in cases().iter().take(3) {
        let mut product = variational::route(model, cam, at);
        let simulated = finite_difference::route(model, cam, at).unwrap();
        let agrees = |product: &Route| {
            let routes = [product.clone(), simulated.clone()];
            let borders: Vec<_> =
                compare_routes(&routes).into_iter().filter(|item| item.quantity == Quantity::Border).collect();
            assert_eq!(borders.len(), 1);
            borders[0].agrees && !borders[0].follows
        };
        assert!(agrees(&product));
        let (e, f) = product.own.border.unwrap();
        product.own.border = Some((-e, -f));
        assert!(!agrees(&product));
    }
}

#[test]
fn the_derivative_of_the_cams_lift_is_known_to_its_error() {
    let Case { model, cam, at } = case(common::osorio(), 736.110814, 1);
    let by = |name: &str| variational::route_by(&model, &cam, &at, &Varied::Number(name.into())).unwrap();
    for name in ["cam.base_radius", "cam.flank_start_deg"] {
        let Some(Uncertainty::Extrapolation(error)) = by(name).uncertainty else { panic!("{name}: no error") };
        for (b, error) in [(by(name).map.minus.b, error.minus.b), (by(name).map.plus.b, error.plus.b)] {
            assert!(error.norm() > 0.0 && error.norm() < 1e-8 * b.norm(), "{name}: {error} of {b}");
        }
    }
    // The follower's laws are differentiated exactly.
    let Some(Uncertainty::Extrapolation(error)) = by("follower.mass").uncertainty else { panic!("no error") };
    assert_eq!((error.minus.b, error.plus.a), (Vector2::zeros(), Matrix2::zeros()));
}

#[test]
#[ignore = "slow"]
fn what_cannot_be_varied_is_refused() {
    let Case { model, cam, at } = case(common::osorio(), 673.234445, 1);
    let unknown = Varied::Number("follower.colour".into());
    assert!(matches!(variational::route_by(&model, &cam, &at, &unknown), Err(NoChange::Unknown { .. })));
    let error = finite_difference::route_by(&model, &cam, &at, &unknown).unwrap_err();
    assert!(error.to_string().contains("follower.colour"), "{error}");
    // Below 0 there is no damping.
    let error = finite_difference::route_by(&model, &cam, &at, &Varied::Number("follower.damping".into())).unwrap_err();
    assert!(matches!(&error, SampleError::Varied { .. }) && error.to_string().contains("follower.damping"), "{error}");
    assert!(variational::route_by(&model, &cam, &at, &Varied::Number("follower.damping".into())).is_ok());
}

/// Here curvature that the monomials leave out puts more into the border than three standard errors.
#[test]
#[ignore = "slow"]
fn a_fit_knows_how_far_its_border_is_off() {
    for rpm in [383.525266432, 404.766076211] {
        let Case { model, cam, at } = case(read("laws/polynomial.toml"), rpm, 1);
        let [exact, fit] = [variational::route(&model, &cam, &at), least_squares::route(&model, &cam, &at).unwrap()];
        let ((e, f), (fitted_e, fitted_f)) = (exact.own.border.unwrap(), fit.own.border.unwrap());
        let off = (e - fitted_e).abs().max().max((f - fitted_f).abs());
        let said = fit.own.border_error.unwrap();
        assert!(off <= said && said < 1e-4 * e.norm(), "{rpm}: {off:e} {said:e}");
    }
}

/// The law that goes on past a corner ends 0.17 deg from it, where the next one is 5.6e-11 m away: less than what counts as one lift where a
/// cam's numbers were typed, and no less a step.
#[test]
#[ignore = "slow"]
fn a_flight_past_the_end_of_a_continued_law_comes_down_where_the_cam_is() {
    let Case { model, cam, at } = case(read("laws/program.toml"), 1928.338528659, 2);
    let machine = Machine::new(cam.clone(), &model.follower, at.angular_velocity());
    let continued = cam.continued(&at.corner, Side::Plus, 0.003).unwrap();
    let lifts = [&cam, &continued].map(|cam| cam.segments()[cam.segment_at(at.corner.angle - 0.0031)].law.clone());
    assert_eq!(lifts[0], lifts[1], "the law before it is cut there");
    let continued = Machine::new(continued, &model.follower, at.angular_velocity());
    let before = (0..at.cycle.impacts.len()).find(|impact| {
        let turn = at.cycle.turn(*impact);
        let angle = at.cycle.impacts[*impact].cam_angle;
        angle < at.corner.angle && (at.corner.angle + 1e-3..at.corner.angle + 0.01).contains(&(angle + turn))
    });
    let before = before.unwrap();
    let (leaving, time) = at.cycle.flight(&machine, before);
    let start = machine.flight().fly(leaving, 0.5 * time).1;
    let section = at.cycle.impacts[before].cam_angle + 0.5 * at.cycle.turn(before);
    let impact = |machine: &Machine, by: f64| {
        let mut motion = machine.start(section, State { position: start.position + by, ..start }).unwrap();
        let mut first = None;
        let on = Goal { revolution: 0, cam_angle: section + at.cycle.turn(before) };
        let _ = machine.advance(&mut motion, on, &mut |event: &Event| {
            first = Some(*event);
            ControlFlow::Break(())
        });
        first.unwrap()
    };
    for by in [-1e-6, 0.0, 1e-6] {
        let [found, expected] = [&continued, &machine].map(|machine| impact(machine, by));
        approx::assert_relative_eq!(found.cam_angle, expected.cam_angle, epsilon = 1e-14);
        approx::assert_relative_eq!(found.position, expected.position, epsilon = 1e-16);
        approx::assert_relative_eq!(found.velocity_after, expected.velocity_after, epsilon = 1e-12);
    }
}

/// Up to twelve impacts, the last ones of which chatter or nearly graze: each amplifies the rounding of those before.
#[test]
#[ignore = "slow"]
fn differences_know_their_errors_where_impacts_amplify_rounding() {
    for (name, least) in [("own.toml", 40), ("measured.toml", 130)] {
        let model = common::tutorial(name);
        let cam = common::cam(&model);
        let range = Study { rpm_min: 1000.0, rpm_max: 2000.0 };
        let found = range::find_corner_impacts(&model, &cam, range, 1, &Unwatched).unwrap().found;
        assert!(found.len() >= least && found.iter().any(|at| at.cycle.impacts.len() >= 12), "{name}: {}", found.len());
        let mut amplified: f64 = 0.0;
        for at in found {
            let exact = variational::route(&model, &cam, &at).map;
            let estimate = finite_difference::route(&model, &cam, &at).unwrap();
            let Some(Uncertainty::Extrapolation(error)) = estimate.uncertainty else { panic!("no error") };
            for (exact, found, error) in
                [(exact.minus, estimate.map.minus, error.minus), (exact.plus, estimate.map.plus, error.plus)]
            {
                let entries =
                    |a: Matrix2<f64>, b: Vector2<f64>| a.iter().chain(b.iter()).copied().collect::<Vec<f64>>();
                let off = entries(found.a - exact.a, found.b - exact.b);
                let mut pairs = off.iter().zip(entries(error.a, error.b));
                let rpm = at.speed_rpm();
                assert!(pairs.all(|(off, said)| off.abs() <= said), "{name} {rpm}: {off:?} {error:?}");
                let promise = (error.a.norm() / exact.a.norm()).max(error.b.norm() / exact.b.norm());
                assert!(promise > 0.0 && promise < 2e-6, "{name} {rpm}: {promise:e}");
                amplified = amplified.max(promise);
            }
        }
        assert!(amplified > 1e-8, "{name}: {amplified:e}");
    }
}

/// A line through four points, by the textbook: x = 0, 1, 2, 3 and y = 1, 3, 4, 4 give slope 1, intercept 1.5,
/// residuals -1/2, 1/2, 1/2, -1/2, sigma^2 = 1/2, se(slope)^2 = sigma^2/5, se(intercept)^2 = sigma^2 (1/4 + 9/20).
#[test]
fn standard_errors_are_those_of_the_textbook() {
    let design = Mat::from_fn(4, 2, |row, column| if column == 0 { 1.0 } else { row as f64 });
    let response = Mat::from_fn(4, 1, |row, _| [1.0, 3.0, 4.0, 4.0][row]);
    let solver = Solver::new(&design).unwrap();
    let fit = solver.fit(&response);
    approx::assert_relative_eq!(fit.coefficients[(0, 0)], 1.5, epsilon = 1e-14);
    approx::assert_relative_eq!(fit.coefficients[(1, 0)], 1.0, epsilon = 1e-14);
    approx::assert_relative_eq!(fit.standard_errors[(0, 0)], (0.5_f64 * 0.7).sqrt(), epsilon = 1e-14);
    approx::assert_relative_eq!(fit.standard_errors[(1, 0)], (0.5_f64 / 5.0).sqrt(), epsilon = 1e-14);
    // Of five rows and two columns there are three degrees of freedom.
    let design = Mat::from_fn(5, 2, |row, column| if column == 0 { 1.0 } else { row as f64 });
    let response = Mat::from_fn(5, 1, |row, _| [1.0, 3.0, 4.0, 4.0, 8.0][row]);
    let five = Solver::new(&design).unwrap().fit(&response);
    approx::assert_relative_eq!(five.standard_errors[(1, 0)], (3.5_f64 / 3.0 / 10.0).sqrt(), epsilon = 1e-14);
    // X'X = [[4, 6], [6, 14]] has eigenvalues 9 +- sqrt(61).
    let ratio = (9.0 + 61.0_f64.sqrt()) / (9.0 - 61.0_f64.sqrt());
    approx::assert_relative_eq!(solver.condition_number, ratio.sqrt(), epsilon = 1e-13);
}

/// At the paper's corner impact differences are known to eleven digits, which needs steps as long as the map lets them be, and the bias of a fit
/// is told by halving its width, a fifteenth of what that changes: no more than its noise.
#[test]
fn errors_at_the_papers_corner_impact_are_small() {
    let Case { model, cam, at } = case(common::osorio(), 673.234445, 1);
    let of_sides = |map: &CornerMap| [map.minus.a.norm(), map.plus.a.norm()];
    let Some(Uncertainty::Extrapolation(error)) = finite_difference::route(&model, &cam, &at).unwrap().uncertainty
    else {
        panic!("no error")
    };
    assert!(of_sides(&error).iter().all(|norm| (1e-14..1e-10).contains(norm)), "{error:?}");
    let fitted = least_squares::route(&model, &cam, &at).unwrap().uncertainty;
    let Some(Uncertainty::Fit { standard, systematic: Some(systematic), .. }) = fitted else { panic!("no error") };
    for (bias, noise) in of_sides(&systematic).into_iter().zip(of_sides(&standard)) {
        assert!(bias < 5.0 * noise && noise < 1e-9, "{systematic:?} {standard:?}");
    }
}

/// Two columns that are 1, and 1 but for d up and down: the ratio of the singular values is d/2. The rounding of a thousand rows is 2.2e-13.
#[test]
fn a_design_whose_rank_is_rounding_alone_is_refused() {
    let is_refused = |apart: f64| {
        let entry =
            |row: usize, column: usize| 1.0 + if row.is_multiple_of(2) { apart } else { -apart } * column as f64;
        Solver::new(&Mat::from_fn(1000, 2, entry)).is_err()
    };
    assert_eq!([0.0, 2e-14, 2e-12, 1.0].map(is_refused), [true, true, false, false]);
}

/// A corner of a table moves a little as the rows change. It is the same corner up to 0.05 rad, on either side of angle 0 as well.
#[test]
fn a_corner_is_the_same_corner_where_it_has_moved_a_little() {
    let Case { at, .. } = case(common::osorio(), 673.234445, 1);
    let on = |angle: f64| CornerImpact { corner: Corner { angle, ..at.corner }, ..at.clone() };
    for (one, other, is_same) in
        [(1.0, 1.0, true), (1.0, 1.04, true), (1.0, 0.94, false), (1.0, 4.0, false), (0.01, TAU - 0.01, true)]
    {
        assert_eq!(on(one).is_near(&on(other)), is_same, "{one} {other}");
    }
}
