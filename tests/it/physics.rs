//! Do flight, impact and cam obey their own laws, for every damping and stiffness?

use crate::common;
use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::flight::{Flight, State};
use corner_impact::impact::rebound;
use corner_impact::model::Follower;

const REST: f64 = 0.3;

fn followers() -> Vec<Follower> {
    let follower = |damping, stiffness, gravity| Follower {
        mass: 1.0,
        damping,
        stiffness,
        gravity,
        rest_position: REST,
        restitution: 0.8,
    };
    // zeta = damping/2, w0^2 = stiffness; 64 and 1024 are critical to the last bit: undamped, under-, nearly and exactly critical, over-, far over-damped,
    // a weak spring with strong damping, damping alone, nothing but gravity, nothing at all.
    let critical = 64.0;
    [
        (0.0, 1024.0, 0.0),
        (2.5, 1024.0, 9.81),
        (critical * (1.0 - 1e-9), 1024.0, 9.81),
        (critical, 1024.0, 9.81),
        (critical * (1.0 + 1e-9), 1024.0, 9.81),
        (200.0, 1024.0, 9.81),
        (20000.0, 1024.0, 9.81),
        (50.0, 1e-3, 9.81),
        (25.0, 0.0, 9.81),
        (0.0, 0.0, 9.81),
        (0.0, 0.0, 0.0),
    ]
    .map(|(damping, stiffness, gravity)| follower(damping, stiffness, gravity))
    .to_vec()
}

/// The flight against twenty thousand steps of a classical Runge-Kutta method, which knows only the equation of motion.
#[test]
fn flight_solves_the_equation_of_motion() {
    for follower in followers() {
        let flight = Flight::new(&follower);
        let Follower { mass, damping, stiffness, gravity, .. } = follower;
        let law = |q: f64, v: f64| (-damping * v - stiffness * (q - REST)) / mass - gravity;
        for t in [1e-3, 0.02, 0.0437, 0.31] {
            let (q0, v0) = (0.47, -3.1);
            let (mut q, mut v) = (q0, v0);
            let n = 20_000;
            let h = t / f64::from(n);
            for _ in 0..n {
                let (k1, l1) = (v, law(q, v));
                let (k2, l2) = (v + 0.5 * h * l1, law(q + 0.5 * h * k1, v + 0.5 * h * l1));
                let (k3, l3) = (v + 0.5 * h * l2, law(q + 0.5 * h * k2, v + 0.5 * h * l2));
                let (k4, l4) = (v + h * l3, law(q + h * k3, v + h * l3));
                q += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
                v += h / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
            }
            let (displacement, end) = flight.fly(State { position: q0, velocity: v0 }, t);
            assert_abs_diff_eq!(end.position, q, epsilon = 1e-11);
            assert_abs_diff_eq!(end.velocity, v, epsilon = 4e-10);
            assert_abs_diff_eq!(displacement, end.position - q0, epsilon = 1e-15);
            assert_abs_diff_eq!(flight.acceleration(end), law(end.position, end.velocity), epsilon = 1e-9);
        }
    }
}

/// Velocity is none where a flight turns, and of one sign before; where it never turns, of one sign for as long as is looked.
#[test]
fn a_flight_turns_where_its_velocity_is_none_first() {
    const LONG: f64 = 20.0;
    let (mut turned, mut never) = (0, 0);
    for follower in followers() {
        let flight = Flight::new(&follower);
        let (zeta, w0_squared) = (0.5 * follower.damping, follower.stiffness);
        let swings = w0_squared > zeta * zeta;
        let frequency = swings.then(|| (w0_squared - zeta * zeta).sqrt());
        assert_eq!(flight.damped_frequency(), frequency, "{follower:?}");
        for (position, velocity) in
            [(0.5, 3.0), (0.5, -3.0), (0.1, 3.0), (0.1, -3.0), (0.1, -30.0), (0.5, 0.0), (0.1, 0.0), (REST, 1.0)]
        {
            let start = State { position, velocity };
            let time = flight.turning_point(start);
            let case = format!("{follower:?} from {position}, {velocity}: {time}");
            let at = |time: f64| flight.fly(start, time).1.velocity;
            // Nearly critical it turns once more after hours, when nothing is left that a double holds.
            let is_seen = time < LONG;
            let end = time.min(LONG);
            let signs: Vec<f64> = (1..200).map(|part| at(end * f64::from(part) / 200.0).signum()).collect();
            assert!(signs.iter().all(|sign| *sign == signs[0]), "{case}: {signs:?}");
            if is_seen {
                let most = velocity.abs() + flight.acceleration(start).abs() * time;
                assert!(
                    at(time).abs() <= 1e-12 * most && at(1.01 * time).signum() == -signs[0],
                    "{case}: {}",
                    at(time)
                );
                turned += 1;
            } else {
                assert!(!swings || time.is_finite(), "{case}");
                never += 1;
            }
        }
    }
    assert!(turned > 40 && never > 20, "{turned} {never}");
}

/// A spring so weak that it is slack kilometres away: the way down to a level is still that of the flight.
#[test]
fn the_fall_to_a_level_keeps_its_digits() {
    for stiffness in [0.0, 1e-12, 1e-6, 1e-3, 0.1, 1.0, 100.0] {
        for gravity in [9.81, 0.5] {
            let follower =
                Follower { mass: 1.0, damping: 0.0, stiffness, gravity, rest_position: REST, restitution: 0.8 };
            let flight = Flight::new(&follower);
            for (position, velocity) in
                [(0.5, 0.0), (0.5, 3.0), (0.5, -3.0), (0.45, 1e-3), (0.4500001, -1e-3), (0.45, 8.0)]
            {
                let Some((time, state)) = flight.fall_to(0.45, State { position, velocity }) else { continue };
                let there = flight.fly(State { position, velocity }, time).1;
                let case = format!("{stiffness} {gravity} {position} {velocity}: {time} {there:?} {state:?}");
                // The rounding of the time, times the velocity; and that of the height that is flown through.
                let height = 0.5 + velocity * velocity / gravity;
                assert!(
                    (there.position - 0.45).abs() <= 1e-15 * (height + 10.0 * time * state.velocity.abs()),
                    "{case}"
                );
                let most = gravity * time + velocity.abs() + stiffness.sqrt();
                assert!((there.velocity - state.velocity).abs() <= 4e-15 * most, "{case}");
            }
        }
    }
}

/// With damping the way down is searched for: it is the first time that the flight, looked at every two milliseconds, is below
/// the level after it has been above, and there is none where it never is.
#[test]
fn a_damped_fall_ends_where_the_level_is_passed_first() {
    const STEP: f64 = 2e-3;
    let (mut reached, mut never, mut risen) = (0, 0, 0);
    for follower in followers().into_iter().filter(|follower| follower.damping > 0.0) {
        let flight = Flight::new(&follower);
        for level in [0.45, 0.4, 0.3, 0.29] {
            for (position, velocity) in [(0.5, 0.0), (0.5, 3.0), (0.5, -3.0), (0.2, 0.0)] {
                let start = State { position, velocity };
                let at = |time: f64| flight.fly(start, time).1;
                let times = || (0..60_000).map(|index| STEP * f64::from(index));
                let Some(above) = times().find(|time| at(*time).position > level) else { continue };
                let below = times().find(|time| *time > above && at(*time).position < level);
                let case = format!("{follower:?} from {position}, {velocity} to {level}: {below:?}");
                match (flight.fall_to(level, start), below) {
                    (Some((time, state)), Some(below)) => {
                        assert!(below - STEP <= time && time <= below, "{time}: {case}");
                        let there = at(time);
                        assert_abs_diff_eq!(there.position, level, epsilon = 1e-13);
                        assert_abs_diff_eq!(there.velocity, state.velocity, epsilon = 1e-9);
                        (reached, risen) = (reached + 1, risen + u32::from(position < level));
                    }
                    (None, None) => never += 1,
                    (found, _) => panic!("{found:?}: {case}"),
                }
            }
        }
    }
    assert!(reached > 40 && never > 10 && risen > 0, "{reached} {never} {risen}");
}

/// Thrown down hard, an overdamped follower turns far below where it rests: it is below the level for an instant or not at all.
#[test]
fn a_level_at_the_turn_is_reached_or_missed() {
    let mut turns = 0;
    for follower in followers().into_iter().filter(|follower| follower.damping > 0.0) {
        let flight = Flight::new(&follower);
        let start = State { position: 0.5, velocity: -300.0 };
        let turn = flight.turning_point(start);
        if turn.is_infinite() {
            continue;
        }
        let lowest = flight.fly(start, turn).1.position;
        let (time, state) = flight.fall_to(lowest + 1e-9, start).unwrap();
        assert!(
            time < turn && turn - time < 1e-3 * turn && state.velocity < 0.0,
            "{follower:?}: {time} {turn} {state:?}"
        );
        assert_eq!(flight.fall_to(lowest - 1e-9, start), None, "{follower:?}");
        turns += 1;
    }
    assert!(turns > 4, "{turns}");
}

/// A hair above the level and fast: the mean of the velocities takes it down, and the time has digits of its own, far above the
/// equilibrium, near it and below, in whatever unit lengths are.
#[test]
fn a_short_fall_keeps_its_digits() {
    let far = [0.0, 1e-12, 1e-6, 1e-3, 0.1].map(|stiffness| (stiffness, 9.81, REST, 0.45));
    let near = [0.45, -0.45].map(|level| (1.0, 0.0, 0.0, level));
    for (stiffness, gravity, rest_position, level) in far.into_iter().chain(near) {
        for unit in [1.0, 2.0_f64.powi(-60), 2.0_f64.powi(60)] {
            let [gravity, rest_position, level] = [gravity, rest_position, level].map(|length| length * unit);
            let follower = Follower { mass: 1.0, damping: 0.0, stiffness, gravity, rest_position, restitution: 0.8 };
            let start = State { position: level + 1e-9 * unit, velocity: -3.0 * unit };
            let (time, state) = Flight::new(&follower).fall_to(level, start).unwrap();
            let expected = 2.0 * (start.position - level) / -(start.velocity + state.velocity);
            assert_relative_eq!(time, expected, epsilon = 0.0, max_relative = 1e-13);
        }
    }
}

/// Two flights are one: the responses hold their digits through every switch of formula.
#[test]
fn flights_compose() {
    for follower in followers() {
        let flight = Flight::new(&follower);
        let start = State { position: 0.52, velocity: 7.3 };
        for k in 0..400 {
            let t = 1e-4 * 1.02_f64.powi(k);
            let whole = flight.fly(start, t).1;
            let split = flight.fly(flight.fly(start, 0.37 * t).1, 0.63 * t).1;
            let scale = 1.0 + t * t * follower.gravity;
            assert_abs_diff_eq!(whole.position, split.position, epsilon = 4e-14 * scale);
            assert_abs_diff_eq!(whole.velocity, split.velocity, epsilon = 2e-12 * scale);
        }
    }
}

/// A short hop keeps its digits: q(t) - q0 = v t + a t^2/2 + j t^3/6 + ...
#[test]
fn short_flights_keep_their_digits() {
    for follower in followers() {
        let flight = Flight::new(&follower);
        let start = State { position: 0.52, velocity: 2e-5 };
        let t = 1e-11;
        let (a, j) = (flight.acceleration(start), flight.jerk(start));
        let (displacement, end) = flight.fly(start, t);
        assert_relative_eq!(
            displacement,
            t * (start.velocity + t * (a / 2.0 + t * j / 6.0)),
            max_relative = 1e-14,
            epsilon = 0.0
        );
        assert_abs_diff_eq!(end.velocity - start.velocity, t * (a + t * j / 2.0), epsilon = 1e-20);
        // From rest the step response alone moves it: a formula that cancels would show.
        let start = State { position: 0.52, velocity: 0.0 };
        let (a, j) = (flight.acceleration(start), flight.jerk(start));
        assert_relative_eq!(
            flight.fly(start, t).0,
            t * t * (a / 2.0 + t * j / 6.0),
            max_relative = 1e-13,
            epsilon = 0.0
        );
    }
}

#[test]
fn the_jerk_and_its_bound() {
    for follower in followers() {
        let flight = Flight::new(&follower);
        let start = State { position: 0.52, velocity: -4.0 };
        let h = 1e-6;
        for k in 0..60 {
            let now = flight.fly(start, 0.004 * f64::from(k)).1;
            let (before, after) =
                (flight.fly(start, 0.004 * f64::from(k) + h).1, flight.fly(start, 0.004 * f64::from(k) + 2.0 * h).1);
            let slope = (flight.acceleration(after) - flight.acceleration(now)) / (2.0 * h);
            let scale = flight.jerk_bound(start);
            assert_abs_diff_eq!(flight.jerk(before), slope, epsilon = 1e-4 * scale + 1e-6);
            let bound = flight.jerk_bound(start);
            assert!(flight.jerk(now).abs() <= bound * (1.0 + 1e-12), "{follower:?}: {} {bound}", flight.jerk(now));
            assert!(flight.jerk_bound(now) <= bound * (1.0 + 1e-12), "{follower:?} the bound never grows");
        }
        // Not an empty bound: undamped it is the amplitude of the jerk.
        if follower.damping == 0.0 && follower.stiffness > 0.0 {
            let largest =
                (0..1000).map(|k| flight.jerk(flight.fly(start, 2e-4 * f64::from(k)).1).abs()).fold(0.0, f64::max);
            assert_relative_eq!(flight.jerk_bound(start), largest, max_relative = 1e-4);
            // Where squares overflow, too: w0 |a| with a = w0^2 q.
            let far = State { position: 1e200, velocity: 0.0 };
            assert_relative_eq!(flight.jerk_bound(far), 32.0 * 1024e200, max_relative = 1e-14);
        }
    }
}

/// The fourth derivative, by differences of the third, is never above its bound, and the bound is what is left of it and of the third together.
#[test]
fn the_fourth_derivative_and_its_bound() {
    for follower in followers() {
        let flight = Flight::new(&follower);
        let start = State { position: 0.52, velocity: -4.0 };
        let rate = flight.zeta() + flight.omega0_squared().sqrt();
        let h = 1e-5 / rate.max(1.0);
        let at = |time: f64| flight.fly(start, time).1;
        let fourth = |time: f64| (flight.jerk(at(time + h)) - flight.jerk(at((time - h).max(0.0)))) / (h + time.min(h));
        let bound = flight.fourth_bound(start);
        for k in 0..60 {
            let now = fourth(0.004 * f64::from(k)).abs();
            assert!(now <= bound * (1.0 + 1e-3) + 1e-6, "{follower:?}: {now} {bound}");
        }
        let left = fourth(0.0).hypot(flight.omega0_squared().sqrt() * flight.jerk(start));
        assert_relative_eq!(bound, left, max_relative = 1e-3, epsilon = 1e-9);
    }
}

#[test]
fn restitution_scales_and_reverses_the_relative_velocity() {
    for r in [0.0, 0.3, 0.8, 1.0] {
        for (incoming, surface) in [(-174.3, 19.37), (-2.0, 0.0), (3.0, 3.5), (-1.0, -0.25)] {
            let outgoing = rebound(r, incoming, surface);
            // eq:i1
            assert_relative_eq!(outgoing, (1.0 + r) * surface - r * incoming, max_relative = 1e-14);
            assert_relative_eq!(outgoing - surface, -r * (incoming - surface), max_relative = 1e-13, epsilon = 1e-15);
        }
    }
    // A relative velocity of one ulp survives: 1 + r then r apart would lose it.
    let surface = 1.0;
    let incoming = surface - f64::EPSILON;
    assert_eq!(rebound(1.0, incoming, surface) - surface, f64::EPSILON);
}

/// Lift derivatives against differences of the lift, bounds against the derivatives, rises against differences.
#[test]
fn cam_derivatives_bounds_and_rises() {
    for file in common::model_files() {
        let cam = common::cam(&common::read(&file));
        for segment in cam.segments() {
            let law = &segment.law;
            let span = segment.end - segment.start;
            let bound = law.third_bound(segment.start, segment.end);
            let mut largest = 0.0_f64;
            for k in 0..=50 {
                let angle = segment.start + span * f64::from(k) / 50.0;
                let (lift, h) = (law.lift(angle), 1e-4 * span);
                let (behind, ahead) = (law.lift(angle - h), law.lift(angle + h));
                let scale = 1.0 + lift.third.abs() / span;
                assert_abs_diff_eq!(lift.slope, (ahead.value - behind.value) / (2.0 * h), epsilon = 1e-6 * scale);
                assert_abs_diff_eq!(lift.curvature, (ahead.slope - behind.slope) / (2.0 * h), epsilon = 1e-5 * scale);
                assert_abs_diff_eq!(
                    lift.third,
                    (ahead.curvature - behind.curvature) / (2.0 * h),
                    epsilon = 1e-4 * scale
                );
                assert!(lift.third.abs() <= bound * (1.0 + 1e-12), "{file:?}: {} above {bound}", lift.third);
                largest = largest.max(lift.third.abs());
                assert_abs_diff_eq!(
                    law.rise(segment.start, angle - segment.start),
                    lift.value - law.lift(segment.start).value,
                    epsilon = 1e-15
                );
                // A tiny turn keeps its digits.
                let turn = 1e-9;
                assert_abs_diff_eq!(
                    law.rise(angle, turn),
                    turn * (lift.slope + 0.5 * turn * lift.curvature),
                    epsilon = 1e-23
                );
            }
            // Over short stretches the bound is close to what it bounds.
            if largest > 0.0 {
                let (start, end) = (segment.start + 0.50 * span, segment.start + 0.51 * span);
                let local = law.third_bound(start, end);
                assert!(
                    local < 12.0 * law.lift(0.5 * (start + end)).third.abs() + 3.0 * law.lift(start).value,
                    "{file:?} {local}"
                );
            }
        }
    }
}

/// Appendix A: the circles touch, the segments meet with one value and one slope, and the acceleration jumps at R, P, Q.
#[test]
fn the_arcs_cam_is_that_of_the_paper() {
    use std::f64::consts::{PI, TAU};
    let cam = common::cam(&common::osorio());
    let corners = cam.corners();
    let degrees: Vec<f64> = corners.iter().map(|corner| corner.angle.to_degrees()).collect();
    let expected = [90.0, 150.179371495, 160.0, 200.0, 209.820628505, 270.0];
    for (found, expected) in degrees.iter().zip(expected) {
        assert_abs_diff_eq!(*found, expected, epsilon = 1e-8);
    }
    let jumps: Vec<[f64; 2]> = corners.iter().map(|corner| [corner.minus.curvature, corner.plus.curvature]).collect();
    let (r, p, q) = (0.2117647058823529, [0.341597100028544513, -1.869212582774449], -1.4916801133032145);
    for (found, expected) in jumps.iter().zip([[0.0, r], p, [q, 0.0], [0.0, q], [p[1], p[0]], [r, 0.0]]) {
        assert_abs_diff_eq!(found[0], expected[0], epsilon = 1e-12);
        assert_abs_diff_eq!(found[1], expected[1], epsilon = 1e-12);
    }
    for corner in corners {
        assert_eq!(corner.jump_order, 2);
        assert_abs_diff_eq!(corner.minus.value, corner.plus.value, epsilon = 1e-15);
        assert_abs_diff_eq!(corner.minus.slope, corner.plus.slope, epsilon = 1e-15);
    }
    // c(2 pi - theta) = c(theta); the printed c_1 and c_2 with theta_1 = 0, theta_3 = -70 degrees.
    let (kappa1, rho1, kappa2, rho2) = (0.45, 0.85, 0.403933207238214137, 0.15);
    let theta3 = -70.0_f64.to_radians();
    for k in 1..1000 {
        let theta = PI * f64::from(k) / 1000.0;
        assert_abs_diff_eq!(cam.lift(theta).value, cam.lift(TAU - theta).value, epsilon = 1e-15);
        let printed = if theta <= 0.5 * PI {
            0.4
        } else if theta <= corners[1].angle {
            -kappa1 * theta.sin() + (rho1 * rho1 - (kappa1 * theta.cos()).powi(2)).sqrt()
        } else if theta <= corners[2].angle {
            kappa2 * (theta + theta3).sin() + (rho2 * rho2 - (kappa2 * (theta + theta3).cos()).powi(2)).sqrt()
        } else {
            kappa2 + rho2
        };
        assert_abs_diff_eq!(cam.lift(theta).value, printed, epsilon = 1e-14);
    }
}
