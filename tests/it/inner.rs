//! Functions inside of the library and the program that no public function shows alone. They are tested here and not beside the code: tests
//! there would have the compiler translate the library twice.

use std::cell::Cell;
use std::f64::consts::TAU;
use std::io::Write;
use std::process::{Command, Stdio};
use std::time::Duration;

use approx::assert_relative_eq;
use corner_impact::border_collision::feigin::Scenario;
use corner_impact::cam::Cam;
use corner_impact::flight::{Flight, State};
use corner_impact::inner::{
    GapAt, Link, OneImpact, Outcome, Powers, Unfinished, determinant, extrapolate, first_contact, held, joined, onward,
    solve,
};
use corner_impact::interval::Interval;
use corner_impact::model::{Model, OSORIO_2008};
use corner_impact::orbit::{Cycle, Impact};
use corner_impact::python::talk;
use corner_impact::simulate::{Goal, Machine, SimulateError, Unobserved, angular_velocity};
use corner_impact::study::compare::{Change, CornerVerdict};
use corner_impact::{elementary, tolerance, untrusted};
use corner_impact_cli::show::digits::at_least;
use corner_impact_plot::formula::{self, Part};
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};
use serde_json::Value;

#[test]
fn what_steers_is_written_out_and_what_is_long_is_cut() {
    assert_eq!(
        untrusted::visible("a\x1b[31m\0\u{9b}\u{202e}\u{7f}\tb\n"),
        "a\\u{1b}[31m\\u{0}\\u{9b}\\u{202e}\\u{7f}\tb\n"
    );
    assert_eq!(untrusted::value("one\ntwo\r"), "one\\ntwo\\r");
    assert_eq!(untrusted::value(&"9".repeat(60)), "9".repeat(60));
    let long = untrusted::value(&format!("begin{}end", "\x1b".repeat(1000))).into_owned();
    assert!(long.starts_with("begin\\u{1b}") && long.ends_with("end") && long.contains("..."), "{long}");
    assert_eq!(long.chars().count(), 60);
    assert_eq!(untrusted::sentence(&"ä".repeat(5000)).chars().count(), 1980);
    let text = "\u{feff}x\x1b = \u{9b}\u{2029}\r\n\r\t";
    assert_eq!(untrusted::in_place(text), "\u{fffd}x? = \u{b7}\u{fffd}\r\n?\t");
    assert_eq!(untrusted::in_place(text).len(), text.len());
}

/// Tests the fallback for file systems without nameless files: a hidden file ends up removed or with its name.
#[test]
fn a_hidden_file_takes_its_name_or_goes() {
    let folder = tempfile::TempDir::new().unwrap();
    let names =
        || std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect::<Vec<_>>();
    let target = folder.path().join("n".repeat(255));
    for words in ["new", "in its place"] {
        let mut file = Unfinished::hidden(folder.path()).unwrap();
        file.write_all(words.as_bytes()).unwrap();
        let listed = held().iter().any(|path| path.parent() == Some(folder.path()));
        assert!(listed, "a signal has to know it");
        file.named(&target).unwrap();
        assert_eq!((names().len(), std::fs::read_to_string(&target).unwrap().as_str()), (1, words));
    }
    drop(Unfinished::hidden(folder.path()).unwrap());
    assert_eq!(names().len(), 1);
    assert!(held().iter().all(|path| path.parent() != Some(folder.path())));
}

#[test]
fn what_does_not_end_is_stopped_and_told_from_what_failed() {
    let told = |script: &str| {
        let mut command = Command::new("sh");
        let child = command.args(["-c", script]).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        talk(child.spawn().unwrap(), Vec::new(), Duration::from_millis(300)).unwrap()
    };
    assert!(told("exec sleep 60").status.is_none());
    let failed = told("echo no >&2; exit 3");
    assert_eq!((failed.status.and_then(|status| status.code()), failed.stderr.as_str()), (Some(3), "no\n"));
}

/// Against the dense matrix, from one impact to many; each flight amplifies a hundredfold in one direction.
#[test]
fn one_pass_comes_to_what_the_dense_matrix_does() {
    for count in [1, 2, 3, 7, 40] {
        let at = |seed: usize| ((seed * 7919 + 13) % 97) as f64 / 97.0 - 0.4;
        let block =
            |seed: usize, grown: f64| Matrix2::new(grown + at(seed), at(seed + 1), at(seed + 2), 1.0 + at(seed + 3));
        let links: Vec<Link> =
            (0..count).map(|i| Link { leaving: block(5 * i, 100.0), coming: block(11 * i + 3, -1.0) }).collect();
        let mut dense = DMatrix::zeros(2 * count, 2 * count);
        for (i, link) in links.iter().enumerate() {
            let next = (i + 1) % count;
            for (column, by) in [(i, link.leaving), (next, link.coming)] {
                let mut view = dense.fixed_view_mut::<2, 2>(2 * i, 2 * column);
                view += by;
            }
        }
        let (size, found) = (dense.determinant(), determinant(&links));
        assert!((found - size).abs() <= 1e-12 * size.abs(), "{count}: {found} {size}");
        let right = DVector::from_fn(2 * count, |row, _| at(3 * row));
        let expected = dense.lu().solve(&right).map_or(DVector::zeros(0), |found| found);
        let found = solve(&links, &right).unwrap_or(DVector::zeros(0));
        assert!(found.len() == 2 * count && (&found - &expected).norm() <= 1e-12 * expected.norm(), "{count}: {found}");
    }
}

#[test]
fn equations_that_determine_nothing_are_refused() {
    let nothing = Link { leaving: Matrix2::zeros(), coming: Matrix2::zeros() };
    assert_eq!(solve(&[nothing, nothing], &DVector::zeros(4)), None);
    assert_eq!(solve(&[], &DVector::zeros(0)), None);
}

/// Impacts at these angles, rad, counted on over so many revolutions.
fn cycle(revolutions: u64, angles: &[f64]) -> Cycle {
    let impact = |angle: &f64| Impact {
        segment: 0,
        cam_angle: angle - TAU * (angle / TAU).floor(),
        revolution: (angle / TAU).floor() as i64,
        velocity_before: -1.0,
    };
    Cycle { revolutions, impacts: angles.iter().map(impact).collect() }
}

#[test]
fn a_motion_is_itself_whichever_impact_comes_first() {
    let one = cycle(2, &[0.0, 1.0, 5.0, 8.0]);
    // Of an impact on the seam rounding decides which revolution it is in.
    let seam = [-1e-13, 1e-13].map(|off| cycle(2, &[1.0, 5.0, 8.0, 2.0 * TAU + off]));
    let later = cycle(2, &[5.0 - TAU, 8.0 - TAU, TAU, TAU + 1.0]);
    for same in [&one, &seam[0], &seam[1], &later] {
        assert!(one.is_same(same) && same.is_same(&one), "{same:?}");
    }
    for other in [cycle(2, &[0.0, 1.0, 5.0, 8.1]), cycle(2, &[0.0, 1.0, 5.0]), cycle(3, &[0.0, 1.0, 5.0, 8.0])] {
        assert!(!one.is_same(&other), "{other:?}");
    }
}

#[test]
fn a_motion_repeats_after_as_few_revolutions_as_it_does() {
    let twice = cycle(4, &[-1e-13, 1.0, 2.0 * TAU, 2.0 * TAU + 1.0]);
    assert!(twice.repeats_sooner());
    assert_eq!(twice.shortest().revolutions, 2);
    for once in [cycle(4, &[0.0, 1.0, 2.0 * TAU, 2.0 * TAU + 1.1]), cycle(2, &[0.0, 1.0, 5.0])] {
        assert!(!once.repeats_sooner(), "{once:?}");
    }
}

/// Between two angles, or two times, E changes at a rate that its derivative has somewhere between them.
#[test]
fn each_derivative_is_that_of_the_equation() {
    for damping in ["0.0", "5.0", "500.0"] {
        let text = OSORIO_2008.replace("damping = 0.0", &format!("damping = {damping}"));
        let model = Model::parse("damped.toml", &text).unwrap();
        let (cam, flight) = (Cam::new(&model).unwrap(), Flight::new(&model.follower));
        let equation = OneImpact { cam: &cam, flight: &flight, restitution: 0.8, revolutions: 1 };
        for (angle, time) in [(1.6, 0.08), (1.9, 0.1), (2.3, 0.12), (2.7, 0.05), (4.0, 0.09)] {
            let law = &cam.segments()[cam.segment_at(angle)].law;
            let (angles, times) = (Interval::new(angle, angle + 1e-4), Interval::new(time, time + 1e-6));
            let at = |angles: Interval, times: Interval| {
                equation.equation(&law.lift_over(angles), times, &flight.response_over(times))
            };
            let [from, to] = [angles.low(), angles.high()].map(|angle| at(angle.into(), time.into()).value);
            let by_angle = (to - from) / (Interval::from(angles.high()) - angles.low());
            assert!(by_angle.is_inside(at(angles, time.into()).by_angle), "{damping} {angle} {time}: {by_angle:?}");
            let [from, to] = [times.low(), times.high()].map(|time| at(angle.into(), time.into()).value);
            let by_time = (to - from) / (Interval::from(times.high()) - times.low());
            assert!(by_time.is_inside(at(angle.into(), times).by_time), "{damping} {angle} {time}: {by_time:?}");
        }
    }
}

fn place(sides: [[f64; 2]; 2]) -> [Interval; 2] {
    sides.map(|[low, high]| Interval::new(low, high))
}

/// Three in a row of which the middle one comes last, two that touch at a corner alone, and one that is apart on one side only.
#[test]
fn boxes_that_touch_are_one_whatever_their_order() {
    let row = [[[0.0, 1.0], [0.0, 1.0]], [[0.1, 1.0], [2.0, 3.0]], [[0.2, 1.0], [1.0, 2.0]]].map(place);
    let corner = [[[4.0, 5.0], [4.0, 5.0]], [[5.0, 6.0], [5.0, 6.0]]].map(place);
    let apart = place([[0.0, 1.0], [7.0, 8.0]]);
    let all = [&corner[..], &[apart], &row].concat();
    let expected = [[[0.0, 1.0], [7.0, 8.0]], [[0.0, 1.0], [0.0, 3.0]], [[4.0, 6.0], [4.0, 6.0]]].map(place);
    assert_eq!(joined(all), expected);
}

/// Damping stops a follower within 1e-12 s of an impact, many digits above the cam, and the cam reaches it in the end.
#[test]
fn a_flight_that_is_stopped_at_once_takes_few_steps() {
    let (rate, stops, cam) = (17.0, 1e12, 1e-9);
    let looks = Cell::new(0);
    let gap_at = |time: f64| {
        looks.set(looks.get() + 1);
        let left = elementary::exp(-stops * time);
        let (value, third) =
            (-rate * elementary::exp_m1(-stops * time) / stops - cam * time, rate * stops * stops * left);
        let (rate, curvature) = (rate * left - cam, -rate * stops * left);
        GapAt { value, rounding: 1e-25, rate, rate_rounding: 1e-14, curvature, third }
    };
    let third_bound = |time: f64, _| rate * stops * stops * elementary::exp(-stops * time);
    let Outcome::Contact(time) = first_contact(gap_at, third_bound, 0.1, 200) else { panic!("no contact") };
    assert_relative_eq!(time, rate / stops / cam, max_relative = 1e-12);
    assert!(looks.get() < 200, "{}", looks.get());
}

/// A fault in the search for a contact would put the follower below the cam. No such fault is known: the test puts it there.
#[test]
fn a_follower_below_the_cam_is_an_error_with_its_state_and_speed() {
    let model = Model::built_in().unwrap();
    let cam = Cam::new(&model).unwrap();
    let machine = Machine::new(cam, &model.follower, angular_velocity(700.0));
    let mut motion = machine.start_on_cam(1.0, 5.0).unwrap();
    // The size of a lift over which rounding is told, the largest.
    let (lift, size) = (motion.state.position, machine.cam().highest().value);
    let most = tolerance::PASSED_THROUGH.value * (lift.abs() + size);
    for (depth, passes) in [(0.5 * most, false), (1.5 * most, true), (1e-3, true)] {
        (motion.state.position, motion.gap) = (lift - depth, None);
        let told = machine.above_cam(&motion, || machine.gap(&motion));
        let Err(SimulateError::PassedThrough { depth: found, cam_angle, position, velocity, rpm, .. }) = told else {
            assert!(!passes && told.is_ok(), "{depth:e} m: {told:?}");
            continue;
        };
        assert!(passes && (found - depth).abs() < 0.1 * most, "{depth:e} m: {found:e}");
        assert_eq!((cam_angle, position, velocity), (1.0, lift - depth, motion.state.velocity));
        assert!((rpm - 700.0).abs() < 1e-9);
    }
    // Where a state is shown, and where one segment ends.
    (motion.state, motion.gap) = (State { position: lift - 1e-3, velocity: 0.0 }, Some(-1e-3));
    let shown = machine.show_at(&mut motion.clone(), Goal { revolution: 0, cam_angle: 1.0 }, 0.0, &mut Unobserved);
    assert!(matches!(shown, Err(SimulateError::PassedThrough { .. })), "{shown:?}");
    let entered = machine.enter_next(&mut motion);
    assert!(matches!(entered, Err(SimulateError::PassedThrough { .. })), "{entered:?}");
}

#[test]
fn extrapolation_recovers_a_derivative_to_rounding() {
    let difference = |h: f64| {
        Ok::<_, ()>(Vector2::new(
            (elementary::exp(1.0 + h) - elementary::exp(1.0 - h)) / (2.0 * h),
            (elementary::sin(h)) / h,
        ))
    };
    let rounding = |h: f64| Vector2::repeat(f64::EPSILON / h);
    let nothing = (Vector2::zeros(), Vector2::zeros());
    let (limit, error) = extrapolate(0.5, Powers::Even, rounding, difference).unwrap_or(nothing);
    assert_relative_eq!(limit[0], std::f64::consts::E, epsilon = 1e-12);
    assert_relative_eq!(limit[1], 1.0, epsilon = 1e-12);
    assert!(error.max() < 1e-11 && error.min() > 0.0, "{error}");
}

#[test]
fn a_limit_from_one_side_has_every_power() {
    let one_sided = |h: f64| Ok::<_, ()>(Vector2::new((elementary::exp(h) - 1.0) / h, 1.0 / (1.0 + h)));
    let rounding = |h: f64| Vector2::repeat(f64::EPSILON / h);
    let nothing = (Vector2::zeros(), Vector2::zeros());
    let (limit, error) = extrapolate(0.25, Powers::Every, rounding, one_sided).unwrap_or(nothing);
    assert!((limit - Vector2::new(1.0, 1.0)).abs() < error * 4.0 && error.max() < 1e-8, "{limit} {error}");
}

fn change([a, b]: [f64; 2], errors: [Option<f64>; 2]) -> Change {
    let found = [a, b].map(Value::from);
    Change::new("number", found.each_ref().map(Some), errors, None)
}

#[test]
fn a_difference_within_the_errors_of_both_is_none() {
    assert!(!change([1.0, 1.3], [Some(0.1), Some(0.2)]).is_one);
    let moved = change([1.0, 1.5], [Some(0.1), Some(0.2)]);
    assert!(moved.is_one && (moved.times_error.unwrap() - 5.0 / 3.0).abs() < 1e-12);
    assert!((moved.relative.unwrap() - 0.5).abs() < 1e-12);
    // Without an error, every difference above rounding is reported.
    assert!(change([1.0, 1.3], [Some(10.0), None]).is_one);
    assert!(!change([1.0, 1.0 + f64::EPSILON], [None; 2]).is_one);
    assert!(!change([0.0, 0.0], [Some(0.0); 2]).is_one);
}

#[test]
fn a_verdict_says_that_it_is_not_verified() {
    let verdict = |agrees| CornerVerdict { found: Ok(Scenario::Persistence), agrees }.to_string();
    assert_eq!(verdict(true), "persistence");
    assert!(verdict(false).contains("not verified"));
}

#[test]
fn a_bound_from_below_is_rounded_down() {
    // The double nearest to 0.3 is below it.
    assert_eq!(at_least(0.3, 5), "0.29999");
    assert_eq!(at_least(7.58, 1), "7.5");
    assert_eq!(at_least(2.0, 1), "2.0");
}

/// Parts as LaTeX would have them, letters between stars.
fn set(text: &str) -> String {
    let parts = formula::sentence(text).into_iter();
    parts
        .map(|part| match part {
            Part::Plain(text) => text,
            Part::Letter(text) => format!("*{text}*"),
            Part::Below(text) => format!("_{{{text}}}"),
            Part::Above(text) => format!("^{{{text}}}"),
        })
        .collect()
}

#[test]
fn formulas_are_set_and_words_are_left() {
    for (text, as_set) in [
        ("dP/dx at fixed t_i is phi_{T/2} x*.", "*dP*/*dx* at fixed *t*_{i} is *φ*_{T/2} *x*^{*}."),
        ("A- and B- hold", "*A*^{−} and *B*^{−} hold"),
        ("det [e; e A-]", "det [e; e *A*^{−}]"),
        ("omega0^2 -> 0", "*ω*_{0}^{2} → 0"),
        ("c'' is 5.1e-9 m/s^2", "*c*′′ is 5.1e-9 m/s^2"),
        ("dP/dt_i: x + g/omega0^2,", "*dP*/*dt*_{i}: x + *g*/*ω*_{0}^{2},"),
        ("1/s, d/s, N/mm and m/s^2", "1/s, d/s, N/mm and m/s^2"),
        ("as printed, eq:PT in one-impact words", "as printed, eq:PT in one-impact words"),
        ("phi_t = e^{-zeta t} x*", "*φ*_{t} = *e*^{−ζ t} *x*^{*}"),
        ("W^{-1} x~", "*W*^{−1} *x*\u{303}"),
        ("x_d^-, x^+", "*x*_{d}^{−}, *x*^{+}"),
        ("$A_hat_minus$ and $T_star$", "*A*\u{302}^{−} and *T*^{*}"),
        ("a $T$ and $q0$; $5 is no $ formula", "a *T* and *q*_{0}; $5 is no $ formula"),
        ("ä$x$ß$", "ä*x*ß$"),
    ] {
        assert_eq!(set(text), as_set, "{text}");
    }
}

#[test]
fn a_terminal_shows_no_dollars() {
    assert_eq!(formula::typed("at $q$ = 1 with $B_tilde$ for $5"), "at q = 1 with B_tilde for $5");
}

/// A curve goes on the wider way around a kink, and nowhere that might be where it came from.
#[test]
fn a_curve_goes_on_where_it_did_not_come_from() {
    assert_eq!(onward(vec![2.0, -0.1]), Some(2.0));
    assert_eq!(onward(vec![0.3, -1.6]), Some(-1.6));
    assert_eq!(onward(vec![0.02, 0.11]), Some(0.11));
    for unclear in [vec![], vec![1.0], vec![0.3, 1.4], vec![-2.0, 2.0], vec![0.022, 0.1], vec![0.1, 0.2, 3.0]] {
        assert_eq!(onward(unclear.clone()), None, "{unclear:?}");
    }
}
