//! What does the paper's follower do, from the lowest speeds to 750 rpm? Each number has its reason beside it.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use crate::common;
use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::flight::State;
use corner_impact::section::StroboscopicMap;
use corner_impact::simulate::growth;
use corner_impact::simulate::{Event, EventKind, Machine, Motion, Unobserved, angular_velocity};

/// The corners R, P, Q, Q', P', R' by index.
const P: usize = 1;
const Q: usize = 2;
const Q_MIRRORED: usize = 3;

/// omega*, and x* in the cam's coordinates: where the spring is slack is 0.3 m.
const CORNER_IMPACT: f64 = 673.234445003848821;
const X_STAR: State = State { position: 0.3 + 5.09700788184262174, velocity: 0.0 };

fn machine(rpm: f64) -> Machine {
    let model = common::osorio();
    Machine::new(common::cam(&model), &model.follower, angular_velocity(rpm))
}

fn corner(machine: &Machine, index: usize) -> f64 {
    machine.cam().corners()[index].angle
}

fn map(rpm: f64) -> StroboscopicMap {
    let machine = machine(rpm);
    let cam_angle = corner(&machine, P) + PI;
    StroboscopicMap { machine, cam_angle }
}

fn from_x_star(map: &StroboscopicMap) -> Motion {
    map.machine.start(map.cam_angle, X_STAR).unwrap()
}

/// The events of the next `revolutions`.
fn events(machine: &Machine, motion: &mut Motion, revolutions: u64) -> Vec<Event> {
    let mut events = Vec::new();
    let goal = motion.after(revolutions);
    let _ = machine
        .advance(motion, goal, &mut |event: &Event| {
            events.push(*event);
            ControlFlow::Continue(())
        })
        .unwrap();
    events
}

/// Goes on without a look.
fn skip(machine: &Machine, motion: &mut Motion, revolutions: u64) {
    let goal = motion.after(revolutions);
    let _ = machine.advance(motion, goal, &mut Unobserved).unwrap();
}

/// Whether the next revolutions have one impact each, and end in the same state.
fn is_period_one(machine: &Machine, motion: &mut Motion) -> bool {
    let before = motion.state;
    let impacts = events(machine, motion, 20).len();
    impacts == 20 && (motion.state.position - before.position).abs() < 1e-9
}

fn kinds(events: &[Event], kind: EventKind) -> Vec<Event> {
    events.iter().filter(|event| event.kind == kind).copied().collect()
}

/// A follower released at P after sticking up to there: its events in the revolutions that follow.
fn released_at_p(rpm: f64, revolutions: u64) -> Vec<Event> {
    let machine = machine(rpm);
    let mut motion = machine.start_on_cam(corner(&machine, P) - 0.05, 0.0).unwrap();
    events(&machine, &mut motion, revolutions)
}

/// Revolutions from a release at P to the next one there.
fn period(rpm: f64) -> u64 {
    let p = corner(&machine(rpm), P);
    let events = released_at_p(rpm, 12);
    let at_p: Vec<u64> = kinds(&events, EventKind::Release)
        .iter()
        .filter(|event| event.cam_angle == p)
        .map(|event| event.revolution)
        .collect();
    at_p[1] - at_p[0]
}

/// The turned angle at which impacts accumulate, deg.
fn accumulation(rpm: f64) -> f64 {
    let events = released_at_p(rpm, 3);
    events.iter().find(|event| event.kind == EventKind::Stick).unwrap().turned_since(0.0).to_degrees()
}

/// The nose, right after P, is the first to fall away faster than the spring follows: omega^2 (-c'') = omega0^2 (c - 0.3).
#[test]
fn where_and_when_does_the_follower_first_leave_the_cam() {
    let slow = machine(100.0);
    let nose = slow.cam().corners()[P].plus;
    let speed = (slow.flight().omega0_squared() * (nose.value - 0.3) / -nose.curvature).sqrt() / angular_velocity(1.0);
    assert_abs_diff_eq!(speed, 114.979326743998, epsilon = 1e-11);
    for rpm in [1.0, 20.0, 60.0, 100.0, 110.0, 114.9, speed - 1e-9] {
        let machine = machine(rpm);
        let mut motion = machine.start_on_cam(0.0, 0.0).unwrap();
        assert_eq!(events(&machine, &mut motion, 2), [], "{rpm}");
        assert!(motion.contact);
    }
    for rpm in [speed + 1e-9, speed + 1e-3, 120.0, 183.0] {
        let machine = machine(rpm);
        let first = events(&machine, &mut machine.start_on_cam(0.0, 0.0).unwrap(), 1)[0];
        assert_eq!((first.kind, first.cam_angle), (EventKind::Release, corner(&machine, P)), "{rpm}");
    }
}

/// A revolution is a release at P, impacts whose relative velocities fall off by r in the end, and sticking up to P. Where
/// they accumulate is extrapolated from the impacts alone, whose distances fall off by r too.
#[test]
fn does_it_chatter_and_stick_at_183_and_at_175_rpm() {
    for (rpm, felt, degrees) in [(183.0, 64, 269.51376), (175.0, 71, 489.91078)] {
        let events = released_at_p(rpm, 2);
        let impacts: Vec<&Event> = events.iter().skip(1).take_while(|event| event.kind == EventKind::Impact).collect();
        let stick = &events[impacts.len() + 1];
        assert_eq!((events[0].kind, stick.kind), (EventKind::Release, EventKind::Stick));
        assert_eq!(events[impacts.len() + 2].kind, EventKind::Release, "one release a revolution");
        let relative = |event: &Event| event.velocity_after - event.cam_velocity;
        assert_eq!(impacts.iter().filter(|impact| relative(impact) > 1e-6).count(), felt);
        let end = &impacts[impacts.len() - 12..];
        for two in end.windows(2) {
            assert_relative_eq!(relative(two[1]) / relative(two[0]), 0.8, max_relative = 1e-4);
        }
        let angle = |event: &Event| event.turned_since(0.0);
        let step = angle(end[11]) - angle(end[10]);
        assert_abs_diff_eq!(angle(stick), angle(end[11]) + step * 0.8 / (1.0 - 0.8), epsilon = 1e-10);
        assert_abs_diff_eq!(angle(stick).to_degrees(), degrees, epsilon = 1e-5);
        assert_eq!(period(rpm), 1);
        // From any start: what was before the stick is forgotten.
        let machine = machine(rpm);
        let mut motion = machine.start(1.0, State { position: 0.9, velocity: 3.0 }).unwrap();
        skip(&machine, &mut motion, 10);
        assert_eq!(growth(&machine, motion, 3).unwrap(), f64::NEG_INFINITY);
        let first = &events[0];
        let again = kinds(&self::events(&machine, &mut motion, 1), EventKind::Release);
        assert_eq!((again[0].cam_angle, again[0].velocity_after), (first.cam_angle, first.velocity_after));
    }
}

/// The second impact crosses Q' at 176.963 rpm. Its own angle has one slope there; v+ = (1+r) c' - r v- has two, which differ
/// by (1+r) omega (c''+ - c''-) dphi/domega; so all later lines and the accumulation have a cusp. At Q the other way round.
#[test]
fn do_impact_lines_that_cross_a_corner_make_peaks() {
    let impact = |rpm: f64, index: usize| kinds(&released_at_p(rpm, 1), EventKind::Impact)[index];
    // Which impact, at which corner, where; whether the accumulation has its highest point there.
    for (index, at, between, speed, up) in [
        (1, Q_MIRRORED, [176.0, 178.0], 176.963134, true),
        (2, Q_MIRRORED, [159.0, 161.0], 159.821171, true),
        (0, Q, [124.0, 126.0], 124.998297, false),
    ] {
        let corner = machine(150.0).cam().corners()[at];
        let [mut low, mut high]: [f64; 2] = between;
        while high - low > 1e-12 * high {
            let middle = 0.5 * (low + high);
            if impact(middle, index).cam_angle < corner.angle { low = middle } else { high = middle }
        }
        assert_abs_diff_eq!(low, speed, epsilon = 1e-6);
        let step = 1e-5;
        let slopes = |quantity: &dyn Fn(f64) -> f64| {
            [(quantity(low) - quantity(low - step)) / step, (quantity(high + step) - quantity(high)) / step]
        };
        let angle = slopes(&|rpm| impact(rpm, index).cam_angle);
        assert_relative_eq!(angle[0], angle[1], max_relative = 1e-3);
        let velocity = slopes(&|rpm| impact(rpm, index).velocity_after);
        let jump = 1.8 * angular_velocity(speed) * (corner.plus.curvature - corner.minus.curvature) * angle[0];
        assert_relative_eq!(velocity[1] - velocity[0], jump, max_relative = 1e-3);
        let cusp = slopes(&accumulation);
        assert!(if up { cusp[0] > 1.0 && cusp[1] < -1.0 } else { cusp[0] < -1.0 && cusp[1] > 1.0 }, "{cusp:?}");
    }
}

/// Sticking ends where the accumulation reaches P, where the nose takes the follower along no further.
#[test]
fn how_far_does_the_chattering_motion_of_period_one_reach() {
    for rpm in [115.0, 130.0, 150.0, 170.0, 190.0, 198.56] {
        assert_eq!(period(rpm), 1, "{rpm}");
    }
    assert_abs_diff_eq!(accumulation(198.5605) - 360.0, corner(&machine(1.0), P).to_degrees(), epsilon = 1e-3);
    // The accumulation moves by 5.8 deg/rpm: it is past P from 198.56051 rpm on.
    assert!(accumulation(198.56051) < 360.0 + 150.179371496 && period(198.56051) == 1);
    assert!(period(198.57) > 1);
}

/// Motions with one more revolution of three impacts each. They accumulate where the motion from P runs into the unstable
/// motion that has three impacts in every revolution: so their distances shrink by its multiplier.
#[test]
fn are_there_cascades_of_periods_that_go_up_by_one() {
    let speeds = [299.5, 304.68, 305.52, 305.6775, 305.7079, 305.71384, 305.715005];
    for (speed, expected) in speeds.iter().zip(2..) {
        assert_eq!(period(*speed), expected, "{speed}");
    }
    let machine = machine(speeds[6]);
    let mut motion = machine.start_on_cam(corner(&machine, P) - 0.05, 0.0).unwrap();
    let goal = motion.next(0.0);
    let _ = machine.advance(&mut motion, goal, &mut Unobserved).unwrap();
    skip(&machine, &mut motion, 3);
    let map = StroboscopicMap { machine, cam_angle: 0.0 };
    let unstable = map.periodic(motion.state, 1).unwrap().unwrap();
    assert_eq!(map.apply(unstable.state).unwrap().impacts().count(), 3);
    let (trace, determinant) = (unstable.matrix.trace(), unstable.matrix.determinant());
    // Three impacts of an undamped follower: det = r^6.
    assert_relative_eq!(determinant, 0.8_f64.powi(6), max_relative = 1e-9);
    let multiplier = 0.5 * trace + (0.25 * trace * trace - determinant).sqrt();
    let gaps: Vec<f64> = speeds.windows(2).map(|two| two[1] - two[0]).collect();
    assert_relative_eq!(gaps[4] / gaps[5], multiplier, max_relative = 0.03);
    for (speed, expected) in [(313.2617, 4), (315.2107, 6), (316.2112, 8), (316.85478, 10)] {
        assert_eq!(period(speed), expected, "{speed}");
    }
}

/// One impact, undamped: det A = r^2, and a complex pair of multipliers has the modulus r.
#[test]
fn what_are_680_and_700_rpm_from_x_star() {
    for rpm in [680.0, 700.0] {
        let map = map(rpm);
        let mut motion = from_x_star(&map);
        skip(&map.machine, &mut motion, 500);
        assert!(is_period_one(&map.machine, &mut motion), "{rpm}");
        assert_abs_diff_eq!(growth(&map.machine, motion, 20_000).unwrap(), 0.8_f64.ln(), epsilon = 1e-3);
        let orbit = map.periodic(motion.state, 1).unwrap().unwrap();
        assert_relative_eq!(orbit.matrix.determinant(), 0.64, max_relative = 1e-10);
        assert!(orbit.matrix.trace().abs() < 1.6, "{rpm}: a complex pair");
    }
}

/// 0.3988 over three million revolutions; over a tenth of them a mean of this spread moves by less than 0.01. At 670 rpm
/// the follower did not come to rest once in two hundred million.
#[test]
fn is_670_rpm_chaotic() {
    let map = map(670.0);
    let mut motion = from_x_star(&map);
    skip(&map.machine, &mut motion, 5000);
    assert_abs_diff_eq!(growth(&map.machine, motion, 300_000).unwrap(), 0.399, epsilon = 0.02);
}

/// Down: the fixed points meet and vanish at omega*, and the motion leaves. Up: it comes back where the chaotic motion ends,
/// 9 rpm higher.
#[test]
fn where_does_a_slowly_changing_speed_make_the_motion_jump() {
    let settled = |motion: Option<Motion>, rpm: f64| {
        let map = map(rpm);
        let mut motion = motion.map_or_else(|| from_x_star(&map), |motion| map.machine.resume(&motion).unwrap());
        skip(&map.machine, &mut motion, 20_000);
        (is_period_one(&map.machine, &mut motion), motion)
    };
    let mut last = None;
    for offset in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5] {
        let (one, motion) = settled(last, CORNER_IMPACT + offset);
        assert!(one, "{offset} above");
        last = Some(motion);
    }
    let (one, mut last) = settled(last, CORNER_IMPACT - 1e-5);
    assert!(!one, "1e-5 below");
    for rpm in [671.0, 672.0] {
        last = settled(Some(last), rpm).1;
    }
    let (one, _) = settled(Some(last), 685.0);
    assert!(one, "above the end of the chaotic motion");
}

/// At 680 rpm about a quarter of the starts on the cam settle on one impact; at 683 rpm all do, after some hundred revolutions.
#[test]
fn which_starts_go_where_above_the_corner_impact() {
    let share = |rpm: f64| {
        let map = map(rpm);
        let mut settled = 0;
        for start in 0..64 {
            let angle = 2.0 * PI * (0.5 + f64::from(start % 8)) / 8.0;
            let mut motion = map.machine.start_on_cam(angle, 25.0 * f64::from(start / 8)).unwrap();
            skip(&map.machine, &mut motion, 4000);
            settled += u32::from(is_period_one(&map.machine, &mut motion));
        }
        settled
    };
    let at_680 = share(680.0);
    assert!((8..32).contains(&at_680), "{at_680} of 64");
    assert_eq!(share(684.0), 64);
    let map = map(680.0);
    let mut motion = map.machine.start_on_cam(0.0, 0.0).unwrap();
    skip(&map.machine, &mut motion, 300);
    assert!(growth(&map.machine, motion, 1000).unwrap() > 0.1, "from rest on the cam: chaotic");
}

/// Chaos with a hole: at 664 rpm the follower now and then comes to rest on the top, and is released at Q' as ever before.
#[test]
fn does_the_chaotic_motion_ever_forget() {
    let machine = machine(664.0);
    let mut motion = machine.start_on_cam(0.0, 0.0).unwrap();
    skip(&machine, &mut motion, 1);
    let mut releases = Vec::new();
    let goal = motion.after(200_000);
    let _ = machine
        .advance(&mut motion, goal, &mut |event: &Event| {
            if event.kind == EventKind::Release {
                releases.push(*event);
            }
            if releases.len() == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
        .unwrap();
    for release in &releases {
        assert_eq!(release.cam_angle, corner(&machine, Q_MIRRORED));
        assert_eq!((release.position, release.velocity_after), (releases[0].position, 0.0));
    }
    assert!(releases[1].revolution > releases[0].revolution + 100);
    assert_eq!(
        releases[2].revolution - releases[1].revolution,
        releases[1].revolution - releases[0].revolution,
        "the same state, so the same again"
    );
}

/// One stick in thousands of revolutions wipes out every deviation; without its revolution the motion is chaotic as ever.
#[test]
fn what_does_a_rare_stick_do_to_the_exponent() {
    let machine = machine(664.0);
    let mut start = machine.start_on_cam(0.0, 0.0).unwrap();
    skip(&machine, &mut start, 1);
    // Turn by turn, as the exponent is computed: chaos makes another motion of other roundings.
    let mut motion = start;
    let flies = |_: &u64| kinds(&events(&machine, &mut motion, 1), EventKind::Stick).is_empty();
    let before = (0..200_000_u64).take_while(flies).count() as u64;
    assert!(before > 100, "{before}: rare");
    assert!(growth(&machine, start, before).unwrap() > 0.3);
    assert_eq!(growth(&machine, start, before + 1).unwrap(), f64::NEG_INFINITY);
    assert_eq!(growth(&machine, start, 0).unwrap(), 0.0);
}

/// A multiplier passes -1 at 739.31978 rpm: two impact angles branch off, apart by the root of the distance. The later one
/// reaches Q at 739.378 rpm, where chaos begins.
#[test]
fn what_happens_between_735_and_745_rpm() {
    let mut guess = X_STAR;
    let mut orbit = None;
    for step in 0..=66 {
        orbit = map(CORNER_IMPACT + 1e-3 + f64::from(step)).periodic(guess, 1).unwrap();
        guess = orbit.unwrap().state;
    }
    assert!(orbit.unwrap().flip() > 0.0, "stable up to 739.2 rpm");
    let (mut low, mut high) = (739.0, 740.0);
    while high - low > 1e-9 {
        let middle = 0.5 * (low + high);
        let found = map(middle).periodic(guess, 1).unwrap().unwrap();
        if found.flip() > 0.0 { low = middle } else { high = middle }
    }
    assert_abs_diff_eq!(high, 739.319780, epsilon = 1e-6);
    // At the flip the product of the multipliers is still r^2: they are -1 and -0.64.
    let matrix = map(high).periodic(guess, 1).unwrap().unwrap().matrix;
    assert_abs_diff_eq!(matrix.trace(), -1.64, epsilon = 1e-8);

    let apart = |rpm: f64| {
        let map = map(rpm);
        let mut motion = map.machine.start(map.cam_angle, guess).unwrap();
        skip(&map.machine, &mut motion, 40_000);
        let impacts = events(&map.machine, &mut motion, 2);
        assert_eq!(impacts.len(), 2, "{rpm}");
        (impacts[0].cam_angle - impacts[1].cam_angle).abs()
    };
    assert!(apart(high - 0.005) < 1e-9);
    assert_relative_eq!((apart(high + 0.01) / apart(high + 0.0025)).powi(2), 4.0, max_relative = 0.05);

    let later = |rpm: f64| {
        let map = map(rpm);
        let mut motion = map.machine.start(map.cam_angle, guess).unwrap();
        skip(&map.machine, &mut motion, 40_000);
        let exponent = growth(&map.machine, motion, 4000).unwrap();
        let angles = events(&map.machine, &mut motion, 20).iter().map(|e| e.cam_angle).fold(0.0, f64::max);
        (exponent, angles)
    };
    let q = corner(&machine(1.0), Q);
    let (below, above) = (later(739.3775), later(739.379));
    assert!(below.0 < 0.0 && below.1 < q && q - below.1 < 3e-4, "{below:?}");
    assert!(above.0 > 0.1 && above.1 > q, "{above:?}");
    assert!(later(745.0).0 > 0.1);
}
