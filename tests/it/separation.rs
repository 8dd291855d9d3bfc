//! Does the follower separate where the cam would have to pull, and nowhere else, by the force between them and by runs?

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use approx::assert_relative_eq;
use corner_impact::cam::Cam;
use corner_impact::model::Model;
use corner_impact::progress::Unwatched;
use corner_impact::simulate::{Event, Machine, angular_velocity};
use corner_impact::study::attractors::{Resolution, detachment};
use corner_impact::study::design::contact::{Contact, Separation};
use corner_impact::study::design::needs::Lever;
use corner_impact::study::design::{Asked, design};
use corner_impact::study::speeds::SpeedSurvey;
use corner_impact_cli::show::Paged;
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;

use crate::common::{self, corner_impact};
use crate::design::separation;
use crate::design_numbers::rpm;
use crate::random::{self, Case};

/// 0.5 kg under a spring of 1000 N/m; the other lines of the follower, and the cam.
fn machine(follower: &str, cam: &str) -> Model {
    let text = format!("[follower]\nmass = 0.5\nstiffness = 1000.0\nrestitution = 0.5\n{follower}\n[cam]\n{cam}");
    Model::parse("slack.toml", &text).unwrap()
}

/// A rise and a return of 20 mm in a quarter of a turn each, from a base, with dwells between them.
fn program(motion: &str, base: f64) -> String {
    let mut text = format!("law = \"program\"\nbase = {base:?}\n");
    for (motion, span, rise) in
        [(motion, 90.0, 0.02), ("dwell", 60.0, 0.0), (motion, 90.0, -0.02), ("dwell", 120.0, 0.0)]
    {
        text += &format!("[[cam.segment]]\nmotion = \"{motion}\"\nspan_deg = {span:?}\nrise = {rise:?}\n");
    }
    text
}

const SLACK: &str = "preload = 0.0\ngravity = 0.0\ndamping = 0.0";
const TWO_LOBES: &str = "law = \"harmonic\"\noffset = 0.02\namplitudes = [0.0, 0.02]\nphases_deg = [0.0, 0.0]\n";

/// Whether a follower that is put on the cam is still there after a turn: by a run.
fn stays(model: &Model, rpm: f64) -> bool {
    let machine = Machine::new(Cam::new(model).unwrap(), &model.follower, angular_velocity(rpm));
    let mut motion = machine.start_on_cam(0.0, 0.0).unwrap();
    let goal = motion.after(1);
    motion.contact && machine.advance(&mut motion, goal, &mut |_: &Event| ControlFlow::Break(())).unwrap().is_continue()
}

fn over(model: &Model, range: [f64; 2], step: f64) -> SpeedSurvey {
    let resolution = Resolution::new(common::step(step), 2);
    common::speeds(model, range, &resolution, &Unwatched).unwrap()
}

/// `k a (1 + cos 2 theta) = 4 m a w^2 cos 2 theta` first where the cosine is 1: `w^2 = k/(2 m)`.
#[test]
fn a_spring_that_is_just_slack_at_the_lowest_lift_lets_go_at_the_top() {
    let model = machine(SLACK, TWO_LOBES);
    let expected = rpm(1000.0_f64.sqrt());
    assert_relative_eq!(expected, 301.975_272_6, max_relative = 1e-9);
    let Separation::At { rpm, error, cam_angle, .. } = separation(&model) else { panic!() };
    assert_relative_eq!(rpm, expected, max_relative = 1e-13);
    assert!(error < 1e-9 && [0.0, 0.5 * TAU, TAU].iter().any(|top| (cam_angle - top).abs() < 1e-6), "{cam_angle}");
    let words = "no separation to 290 rpm".to_owned();
    let asked = Asked { speeds: 2, needs: vec![(words.clone(), words.parse().unwrap())], ..Asked::default() };
    let found = design(&model, &asked, &Unwatched).unwrap();
    assert!(found.text().unwrap().contains("leaves the cam first at 301.975273 rpm"));
    // w^2 = k/(2 m) of either, the other kept.
    let square = angular_velocity(290.0).powi(2);
    for (lever, value) in [(Lever::Stiffness, square), (Lever::Mass, 500.0 / square)] {
        let answer = found.needs.iter().find(|answer| answer.lever == lever).unwrap();
        assert_relative_eq!(answer.value.unwrap(), value, max_relative = 1e-9);
    }
    let preload = found.needs.iter().find(|answer| answer.lever == Lever::Preload).unwrap();
    assert_eq!((preload.value, preload.note.as_str()), (Some(0.0), "the least possible value suffices"));
}

/// `speeds` has the speed of `design`, to the last bit, and ends there what stays on the cam.
#[test]
#[ignore = "slow"]
fn speeds_has_the_separation_of_design() {
    let model = machine(SLACK, &program("cycloidal", 0.0));
    let Separation::At { rpm, error, .. } = separation(&model) else { panic!() };
    let found = over(&model, [0.8 * rpm, 1.2 * rpm], 20.0);
    assert_eq!(found.detachment(), Some([rpm, error]));
    let end = found.attractors[0].death.as_ref().unwrap();
    assert_eq!((end.cause.name(), end.value(), end.bracket), ("detachment", rpm, [rpm - error, rpm + error]));
}

/// The force is 0 all along the lowest dwell, at every speed. With every motion, on a base or at 0, with the spring's rest given as a
/// position, in millimetres, and where the spring hangs the mass up just there.
#[test]
fn no_force_on_a_dwell_is_no_separation() {
    for motion in ["parabolic", "harmonic", "cycloidal", "modified-trapezoid", "modified-sine", "poly345", "poly4567"] {
        for base in [0.0, 0.02, 0.3] {
            let cam = program(motion, base);
            let hung = format!("rest_position = {:?}\ngravity = 9.81\ndamping = 0.0", base + 0.5 * 9.81 / 1000.0);
            let given = format!("rest_position = {base:?}\ngravity = 0.0\ndamping = 0.0");
            let models = [SLACK, &hung, &given].map(|follower| machine(follower, &cam));
            let mm = format!(
                "[units]\nlength = \"mm\"\n[follower]\nmass = 0.5\nstiffness = 1000.0\nrestitution = 0.5\n{SLACK}\n[cam]\n"
            );
            let cam = program(motion, 1e3 * base).replace("0.02", "20.0");
            let mm = Model::parse("mm.toml", &(mm + &cam)).unwrap();
            let found = models.iter().chain([&mm]).map(separation).collect::<Vec<_>>();
            for (model, separation) in models.iter().chain([&mm]).zip(&found) {
                let Separation::At { rpm, .. } = separation else { panic!("{motion} from {base}: {separation:?}") };
                assert_relative_eq!(*rpm, found[0].speed(), max_relative = 1e-9);
                let runs = [0.01, 0.5, 1.0 - 1e-7, 1.0 + 1e-7].map(|part| stays(model, part * rpm));
                assert_eq!(runs, [true, true, true, false], "{motion} from {base}: {rpm}");
                let least = Contact::new(&Cam::new(model).unwrap(), model.follower).least(0.5 * rpm).value;
                assert_eq!(least, 0.0, "{motion} from {base}");
            }
        }
    }
}

/// The curve of detachment is of the place that lets go, not of the dwell, where the force is 0 at every speed. There is no other scale of
/// time than that of the spring: `w^2` goes with the stiffness.
#[test]
#[ignore = "slow"]
fn the_curve_of_detachment_is_of_the_place_that_lets_go() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("slack.toml");
    let text = format!(
        "[follower]\nmass = 0.5\nstiffness = 1000.0\nrestitution = 0.5\n{SLACK}\n[cam]\n{}",
        program("cycloidal", 0.0)
    );
    std::fs::write(&file, text).unwrap();
    let file = file.to_str().unwrap();
    let words = [
        "curve",
        file,
        "--rpm",
        "250:255",
        "--parameter",
        "stiffness=998:1002",
        "--event",
        "detachment",
        "--step",
        "2",
    ];
    let output = corner_impact(words);
    let said = common::text(output.stderr);
    assert!(said.contains("detachments, at 175.6") && !said.contains("curve 2"), "{said}");
    let own = separation(&Model::read(file.as_ref()).unwrap()).speed();
    let rows = common::text(output.stdout);
    let numbers = |row: &str| row.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect::<Vec<f64>>();
    let rows: Vec<Vec<f64>> = rows.lines().skip(1).map(numbers).collect();
    assert!(rows.len() >= 3, "{rows:?}");
    for row in rows {
        assert_relative_eq!(row[0], own * (row[2] / 1000.0).sqrt(), max_relative = 1e-9);
    }
}

/// A damper holds back a follower that nothing presses on at the lowest lift, however slow, where `n b^2 > 4 (n - 1) k m` of a lift that comes
/// to rest as the power n. Of an eccentric with less it is `m^2 w^2 = 2 k m - b^2`.
#[test]
fn a_damper_pulls_at_every_speed_from_its_closed_form_on() {
    let eccentric = "law = \"harmonic\"\noffset = 0.1\namplitudes = [0.02]\nphases_deg = [40.0]\n".to_owned();
    let motions = [("parabolic", 2.0), ("cycloidal", 3.0), ("poly345", 3.0), ("poly4567", 4.0)];
    let cams = motions.map(|(motion, order)| (program(motion, 0.02), order));
    for (cam, order) in cams.into_iter().chain([(eccentric.clone(), 2.0)]) {
        let critical = (4.0_f64 * (order - 1.0) / order * 1000.0 * 0.5).sqrt();
        for (part, holds) in [(0.5, false), (0.999, false), (1.001, true), (3.0, true)] {
            let damped = format!("preload = 0.0\ngravity = 0.0\ndamping = {:?}", part * critical);
            let model = machine(&damped, &cam);
            let found = separation(&model);
            assert_eq!(matches!(found, Separation::NotPressed { .. }), holds, "{part} {cam}: {found:?}");
            if holds && part > 2.0 {
                assert!(!stays(&model, 1.0) && !stays(&model, 30.0), "{cam}");
            }
            if !holds && cam == eccentric {
                let omega = (2.0 * 1000.0 * 0.5 - (part * critical).powi(2)).sqrt() / 0.5;
                assert_relative_eq!(found.speed(), rpm(omega), max_relative = 1e-7);
            }
        }
        // Pressed by little it goes slower than any that is pressed by more, and as slow as the force falls to.
        let pressed = |preload: f64| {
            let damped = format!("preload = {preload:?}\ngravity = 0.0\ndamping = {:?}", 3.0 * critical);
            separation(&machine(&damped, &cam)).speed()
        };
        // N = a (k x^n - n b w x^(n-1) + n (n - 1) m w^2 x^(n-2)) + P: x and w go with the n-th root of P.
        let ratio = pressed(1e-9) / pressed(1e-7);
        assert_relative_eq!(ratio, 100.0_f64.powf(-1.0 / order), max_relative = 0.05);
    }
}

/// Without a spring and without gravity the follower goes where the cam throws it; a cam that does not move throws nothing.
#[test]
#[ignore = "slow"]
fn a_follower_that_nothing_presses_on_is_thrown_off_at_every_speed() {
    for damping in [0.0, 3.0] {
        let free = |cam: &str| {
            let text = format!(
                "[follower]\nmass = 0.5\nstiffness = 0.0\nrest_position = 0.0\nrestitution = 0.5\ngravity = 0.0\ndamping = {damping:?}\n[cam]\n\
                 {cam}"
            );
            Model::parse("free.toml", &text).unwrap()
        };
        assert_eq!(separation(&free(TWO_LOBES)).name(), "at-every-speed");
        let still = TWO_LOBES.replace("[0.0, 0.02]", "[0.0, 0.0]");
        assert_eq!(separation(&free(&still)), Separation::Never);
        let found = over(&free(&program("cycloidal", 0.0)), [250.0, 330.0], 40.0);
        let off = found.off_for_good().unwrap();
        assert!(off.words.starts_with("Every start leaves the cam for good"), "{}", off.words);
        assert!(off.shares.len() == found.run && off.shares.iter().all(|off| off.share.value == 1.0));
        assert!(found.text().unwrap().contains("Every start leaves the cam for good"));
    }
    // A weight that falls upwards, and a spring that lifts the follower off with a damper.
    for lines in [
        "stiffness = 0.0\nrest_position = 0.0\ngravity = -9.81\ndamping = 0.0",
        "stiffness = 1000.0\nrest_position = 0.5\ngravity = 0.0\ndamping = 3.0",
    ] {
        let text = format!("[follower]\nmass = 0.5\nrestitution = 0.5\n{lines}\n[cam]\n{}", program("cycloidal", 0.0));
        let found = over(&Model::parse("up.toml", &text).unwrap(), [250.0, 330.0], 40.0);
        assert_eq!(found.off.len(), found.run, "{lines}");
        let document = serde_json::to_value(&found).unwrap();
        assert!(document["off_for_good"]["words"].as_str().unwrap().starts_with("Every start"), "{lines}");
    }
    assert_eq!(over(&machine(SLACK, &program("cycloidal", 0.0)), [250.0, 330.0], 40.0).off_for_good(), None);
}

/// A weight that falls upwards takes the follower off a slow cam; the inertia presses it on a faster one at the lowest lift, where
/// `k c + m w^2 a = m g`, and a yet faster one throws it off the top, where `2 k a = m w^2 a + m g`.
#[test]
fn a_follower_that_nothing_presses_on_at_rest_is_on_a_faster_cam() {
    let model = machine(
        "preload = 0.0\ngravity = -4.0\ndamping = 0.0",
        "law = \"harmonic\"\noffset = 0.02\namplitudes = [0.02]\nphases_deg = [0.0]\n",
    );
    let (pull, height) = (0.5 * 4.0, 0.02);
    let [on, off] =
        [pull / (0.5 * height), (2.0 * 1000.0 * height - pull) / (0.5 * height)].map(|square| rpm(f64::sqrt(square)));
    assert!(on < off && matches!(separation(&model), Separation::NotPressed { .. }));
    let cam = Cam::new(&model).unwrap();
    let contact = Contact::new(&cam, model.follower);
    for (low, speed) in [(0.99 * on, 0.0), (1.01 * on, off), (0.99 * off, off), (1.01 * off, 0.0)] {
        assert_relative_eq!(contact.separation_above(low).speed(), speed, max_relative = 1e-12);
        assert_eq!(stays(&model, low), speed > 0.0, "{low}");
    }
}

/// The case with its spring pressing by nothing, by little, by much or as it was, and gravity in half of the cases.
fn sprung(case: &Case) -> Model {
    let kind = case.rpm.to_bits() >> 8;
    let has_spring = !case.text.contains("stiffness = 0.0\n");
    let line = |line: &str| match line.split_once(" = ") {
        Some(("rest_position", _)) if has_spring && kind % 4 < 3 => {
            let preload = [0.0, 1e-6, 1.0][(kind % 4) as usize] * case.stroke * case.model.follower.stiffness;
            format!("preload = {preload:?}\n")
        }
        Some(("gravity", _)) if (kind / 4).is_multiple_of(2) => "gravity = 0.0\n".into(),
        _ => format!("{line}\n"),
    };
    random::model(&case.text.lines().map(line).collect::<String>(), case.table.as_deref())
}

fn is_where_runs_part(case: &Case) -> TestCaseResult {
    let model = sprung(case);
    let cam = Cam::new(&model).unwrap();
    let contact = Contact::new(&cam, model.follower);
    let found = contact.separation();
    let shown = || format!("{found:?} of {:?}, {:?} N\n{case:?}", model.follower, model.preload);
    match found {
        Separation::Kink { .. } => {}
        Separation::Never => prop_assert!(stays(&model, 1e3 * case.rpm), "{}", shown()),
        Separation::NotPressed { .. } => {
            let slow = [1e-4, 1e-3, 1e-2].map(|part| part * case.rpm);
            prop_assert!(slow.iter().any(|rpm| !stays(&model, *rpm)), "{}", shown());
            // Faster it may be on the cam again, and leaves it once more.
            let (low, high) = (case.rpm, 2.0 * case.rpm);
            let again = contact.separation_above(low).speed();
            let by_runs = detachment(&model, [low, high]).unwrap();
            match by_runs {
                Some(runs) => prop_assert!((runs - again).abs() < 1e-6 * runs, "{runs} and {again}: {}", shown()),
                None => prop_assert!(again == 0.0 || again > high, "{again}: {}", shown()),
            }
        }
        Separation::At { rpm, .. } => {
            // A run sees a gap once it is more than rounding.
            let by_runs = detachment(&model, [0.05 * rpm, 1.3 * rpm]).unwrap();
            prop_assert!(by_runs.is_some_and(|runs| (runs - rpm).abs() < 1e-6 * rpm), "{by_runs:?}: {}", shown());
        }
    }
    // Without a damper: w^2 = (k (c - rest) + m g) / (-m c''), the least all round.
    let follower = model.follower;
    if follower.damping == 0.0 && found.speed() > 0.0 && found.speed().is_finite() {
        const ANGLES: usize = 20_000;
        let squares = (0..ANGLES).filter_map(|index| {
            let lift = cam.lift(TAU * index as f64 / ANGLES as f64);
            let force = follower.stiffness * (lift.value - follower.rest_position) + follower.mass * follower.gravity;
            (lift.curvature < -1e-9 * case.stroke).then(|| force / (-follower.mass * lift.curvature))
        });
        let least = rpm(squares.fold(f64::INFINITY, f64::min).max(0.0).sqrt());
        prop_assert!(found.speed() <= least * (1.0 + 1e-9), "{least}: {}", shown());
    }
    Ok(())
}

/// Every law, with damping and gravity and without, of followers that a spring presses on by nothing, little or much: 500 of them in
/// `make properties`.
#[test]
fn the_force_tells_where_runs_leave_the_cam() {
    let count = if crate::common::is_whole() { 500 } else { 30 };
    random::check(count, is_where_runs_part);
}
