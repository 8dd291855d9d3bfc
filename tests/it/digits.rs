//! Do sums of infinitely many impacts, long bounces and long runs keep their digits?

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use crate::common;
use corner_impact::cam::Cam;
use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::simulate::{Event, EventKind, Goal, Machine, Unobserved, accumulation, angular_velocity};

/// The gap t after an impact that it leaves at u, and its rate: `g'' = -A + J t - 2 zeta g'`, solved by its power series.
fn hop(u: f64, pressing: f64, rate: f64, zeta: f64, t: f64) -> (f64, f64) {
    // (n + 2)(n + 1) a_{n+2} = -A [n = 0] + J [n = 1] - 2 zeta (n + 1) a_{n+1}
    let (mut last, mut gap, mut speed, mut power) = (u, u * t, u, t);
    for n in 0..30 {
        let forced = if n == 0 {
            -pressing
        } else if n == 1 {
            rate
        } else {
            0.0
        };
        let order = f64::from(n) + 2.0;
        let next = (forced - 2.0 * zeta * (order - 1.0) * last) / (order * (order - 1.0));
        speed += order * next * power;
        power *= t;
        gap += next * power;
        last = next;
    }
    (gap, speed)
}

/// All the hops, one by one, each by Newton's method on its series.
fn hops(mut u: f64, restitution: f64, pressing: f64, rate: f64, zeta: f64) -> f64 {
    let mut time = 0.0;
    let first = u;
    while u > 1e-17 * first {
        let pressing = pressing - rate * time;
        let mut t = 2.0 * u / pressing;
        for _ in 0..20 {
            let (gap, speed) = hop(u, pressing, rate, zeta, t);
            t -= gap / speed;
        }
        time += t;
        u = -restitution * hop(u, pressing, rate, zeta, t).1;
    }
    time
}

/// Two terms of the sum leave out a third: half the velocity, an eighth of what is missing. Dropping or changing the second
/// term leaves a fourth.
#[test]
fn the_sum_of_infinitely_many_impacts_is_right_to_the_second_order() {
    for (restitution, pressing, rate, zeta) in [
        (0.5, 10.0, 40.0, 0.0),
        (0.9, 10.0, -40.0, 0.0),
        (0.8, 2.0, 0.0, 1.5),
        (0.3, 5.0, 20.0, 2.0),
        (0.0, 3.0, 9.0, 1.0),
    ] {
        let missing = |u: f64| {
            let (sum, left_out) = accumulation(u, restitution, pressing, rate, zeta);
            let exact = hops(u, restitution, pressing, rate, zeta);
            let missing = (sum - exact).abs();
            // What is said to be left out is of the size of what is.
            assert!(missing <= left_out * exact, "{restitution} {u}: {sum} {exact} {left_out}");
            missing
        };
        let u = 0.01 * pressing * (1.0 - restitution);
        let (whole, half, quarter) = (missing(u), missing(0.5 * u), missing(0.25 * u));
        for (more, less) in [(whole, half), (half, quarter)] {
            assert!((7.0..9.0).contains(&(more / less)), "{restitution} {pressing} {rate} {zeta}: {more} {less}");
        }
    }
    // Without either the series is geometric.
    let (sum, left_out) = accumulation(1.0, 0.5, 10.0, 0.0, 0.0);
    assert_eq!((sum, left_out), (0.4, 0.0));
}

/// A ball on a dwell that loses nothing: after 10^5 impacts the energy is that of the start.
#[test]
fn an_elastic_ball_keeps_its_energy() {
    let text = "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 0.0\ngravity = 9.81\nrest_position = 0.0\n\
                restitution = 1.0\n[cam]\nlaw = \"program\"\nbase = 0.4\n[[cam.segment]]\nmotion = \"dwell\"\n\
                span_deg = 360.0\n";
    let model = Model::parse("ball.toml", text).unwrap();
    for height in [1e-6, 0.3, 1e3] {
        let machine = Machine::new(Cam::new(&model).unwrap(), &model.follower, angular_velocity(60.0));
        let mut motion = machine.start(1.0, State { position: 0.4 + height, velocity: 0.0 }).unwrap();
        let speed = (2.0 * 9.81 * (motion.state.position - 0.4)).sqrt();
        let (mut impacts, mut last) = (0, 0.0);
        let goal = Goal { revolution: u64::MAX, cam_angle: 0.0 };
        let _ = machine.advance(&mut motion, goal, &mut |event: &Event| {
            impacts += u32::from(event.kind == EventKind::Impact);
            last = event.velocity_after;
            if impacts == 100_000 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert_eq!(impacts, 100_000, "{height}");
        // At most one rounding of the velocity for each impact, and one of the position, of which the height is a part.
        let rounding = f64::EPSILON * 1e5 * (speed * speed + 9.81 * motion.state.position.abs().max(height));
        assert!((last * last - speed * speed).abs() <= rounding, "{height} m: {last} {speed}");
    }
}

/// A million revolutions of the orbit at 700 rpm: time starts anew at every impact, so the last is where the first was.
#[test]
fn a_million_revolutions_lose_no_digit() {
    let model = common::osorio();
    let machine = Machine::new(common::cam(&model), &model.follower, angular_velocity(700.0));
    let mut motion = machine.start(5.762717154756, State { position: 5.397, velocity: 0.0 }).unwrap();
    let goal = motion.after(2000);
    let _ = machine.advance(&mut motion, goal, &mut Unobserved).unwrap();
    let (mut low, mut high, mut impacts) = (f64::INFINITY, 0.0_f64, 0);
    let goal = motion.after(1_000_000);
    let _ = machine
        .advance(&mut motion, goal, &mut |event: &Event| {
            (low, high, impacts) = (low.min(event.cam_angle), high.max(event.cam_angle), impacts + 1);
            ControlFlow::Continue(())
        })
        .unwrap();
    assert_eq!(impacts, 1_000_000);
    let ulp = f64::EPSILON * 2.0;
    assert!((2.0..4.0).contains(&low) && high - low <= 4.0 * ulp, "{low} to {high}: {} ulps", (high - low) / ulp);
    assert!(low < TAU);
}
