//! Does a free flight come down to a level when its closed form does, and never where that does not?

use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::flight::{Flight, State};
use corner_impact::model::Follower;

/// A follower of mass 1 whose spring is slack at 0: `q'' = -2 zeta q' - w0^2 q - g`.
fn flight(zeta: f64, w0_squared: f64, gravity: f64) -> Flight {
    Flight::new(&Follower {
        mass: 1.0,
        damping: 2.0 * zeta,
        stiffness: w0_squared,
        gravity,
        rest_position: 0.0,
        restitution: 0.8,
    })
}

fn at(position: f64, velocity: f64) -> State {
    State { position, velocity }
}

/// The slowest rate is the root of `s^2 - 2 zeta s + w0^2` that is nearer to 0, and what is left of a deviation falls off by it.
#[test]
fn a_deviation_dies_out_by_the_slowest_rate() {
    for (slow, fast) in [(1.0, 5.0), (2.0, 2.0), (0.25, 3.0), (0.5, 40.0), (0.0, 0.7), (0.0, 0.0)] {
        let flight = flight(0.5 * (slow + fast), slow * fast, 0.0);
        assert_relative_eq!(flight.slowest_rate().unwrap(), slow, max_relative = 1e-12, epsilon = 0.0);
        // From the slower eigenvector: q' = -slow q.
        let start = at(0.3, -slow * 0.3);
        assert_relative_eq!(flight.fly(start, 1.5).1.position, 0.3 * (-1.5 * slow).exp(), max_relative = 1e-12);
    }
    for (zeta, w0_squared) in [(0.0, 4.0), (1.0, 4.0), (1.999, 4.0)] {
        assert_eq!(flight(zeta, w0_squared, 0.0).slowest_rate(), None);
    }
}

/// `q = R cos(t - phi)` comes down to its highest point where it is highest, to what is below it soon after, and to nothing below `-R`.
#[test]
fn a_swing_reaches_its_highest_point_and_nothing_below_its_lowest() {
    let swing = flight(0.0, 1.0, 0.0);
    let start = at(3.0, 4.0);
    let phi = (4.0_f64 / 3.0).atan();
    for (level, time) in
        [(5.0, phi), (4.0, phi + 0.8_f64.acos()), (0.0, phi + 0.0_f64.acos()), (-4.0, phi + (-0.8_f64).acos())]
    {
        let (found, state) = swing.fall_to(level, start).unwrap();
        assert_relative_eq!(found, time, max_relative = 1e-14);
        assert_abs_diff_eq!(state.velocity, -(25.0 - level * level).sqrt(), epsilon = 1e-14);
    }
    assert_eq!(swing.fall_to(-5.1, start), None);
    assert_eq!(swing.fall_to(-1e3, start), None);
    // From rest: on the level, over an equilibrium that is below it, it falls at once; in the equilibrium it stays.
    assert_eq!(swing.fall_to(2.0, at(2.0, 0.0)), Some((0.0, at(2.0, -0.0))));
    assert_eq!(swing.fall_to(0.0, at(0.0, 0.0)), None);
}

/// With negative damping, which is a flight backwards in time, a follower that begins at rest at `q0` has
/// `q = q0 (r2 exp(r1 t) - r1 exp(r2 t))/(r2 - r1)`, for the roots of `r^2 + 2 zeta r + w0^2`: it goes through its equilibrium once.
#[test]
fn a_follower_at_rest_comes_down_through_an_equilibrium_that_repels() {
    for (r1, r2) in [(1.0_f64, 5.0_f64), (0.2, 0.3), (0.01, 7.0)] {
        let flight = flight(-0.5 * (r1 + r2), r1 * r2, 0.0);
        let (time, state) = flight.fall_to(0.0, at(0.4, 0.0)).unwrap();
        assert_relative_eq!(time, (r2 / r1).ln() / (r2 - r1), max_relative = 1e-12);
        assert_relative_eq!(
            state.velocity,
            0.4 * r1 * r2 * ((r1 * time).exp() - (r2 * time).exp()) / (r2 - r1),
            max_relative = 1e-11
        );
        let deeper = flight.fall_to(-3.0, at(0.4, 0.0)).unwrap();
        assert_relative_eq!(flight.fly(at(0.4, 0.0), deeper.0).1.position, -3.0, max_relative = 1e-11);
        // In its equilibrium it stays.
        assert_eq!(flight.fall_to(-0.1, at(0.0, 0.0)), None);
    }
}

/// `q = v (1 - exp(-2 zeta t))/(2 zeta)`: damping alone stops a follower after `v/(2 zeta)`, and it comes down to all that is nearer.
#[test]
fn damping_alone_stops_a_follower_after_its_way() {
    for zeta in [0.05, 0.1, 0.7, 3.0, 40.0] {
        let flight = flight(zeta, 0.0, 0.0);
        for speed in [0.3, 1.0, 20.0] {
            let way = speed / (2.0 * zeta);
            for share in [0.01, 0.2, 0.8, 0.99] {
                let found = flight.fall_to(1.0 - share * way, at(1.0, -speed));
                let (time, state) = found.unwrap_or_else(|| panic!("zeta {zeta}, {speed} m/s, {share} of the way"));
                assert_relative_eq!(time, -(1.0 - share).ln() / (2.0 * zeta), max_relative = 1e-11);
                assert_relative_eq!(state.velocity, -speed * (1.0 - share), max_relative = 1e-9);
            }
            for share in [1.01, 1.5, 30.0] {
                assert_eq!(flight.fall_to(1.0 - share * way, at(1.0, -speed)), None, "{zeta} {speed} {share}");
            }
            // Upwards it stops as well, and nothing takes it down.
            assert_eq!(flight.fall_to(0.5, at(1.0, speed)), None);
        }
        assert_eq!(flight.fall_to(0.5, at(1.0, 0.0)), None);
    }
}

/// Without any force it goes on as it was thrown.
#[test]
fn nothing_at_all_lets_a_follower_go_on() {
    let flight = flight(0.0, 0.0, 0.0);
    assert_relative_eq!(flight.fall_to(-7.0, at(1.0, -2.0)).unwrap().0, 4.0, max_relative = 1e-14);
    for velocity in [0.0, 2.0] {
        assert_eq!(flight.fall_to(-7.0, at(1.0, velocity)), None);
    }
}

/// A damper that drives, as in a run backwards, leads from any push downwards to any depth: by both growing exponentials of the spring and
/// the driving, or by the one of the driving alone.
#[test]
fn a_driven_follower_that_is_pushed_down_comes_to_any_depth() {
    // s^2 - 4 s + 1 = 0 and q = a e^(r1 t) + b e^(r2 t).
    let roots = [2.0 + 3.0_f64.sqrt(), 2.0 - 3.0_f64.sqrt()];
    let driven = flight(-2.0, 1.0, 0.0);
    for velocity in [-10.0, -5.0] {
        let a = (velocity - roots[1]) / (roots[0] - roots[1]);
        for level in [0.5, -0.5, -5.0, -1e3] {
            let (time, state) = driven.fall_to(level, at(1.0, velocity)).unwrap();
            let parts = [a * (roots[0] * time).exp(), (1.0 - a) * (roots[1] * time).exp()];
            assert_relative_eq!(parts[0] + parts[1], level, max_relative = 1e-11, epsilon = 1e-12);
            assert_relative_eq!(roots[0] * parts[0] + roots[1] * parts[1], state.velocity, max_relative = 1e-10);
        }
    }
    let driven = flight(-0.1, 0.0, 0.0);
    for drop in [0.1, 3.0, 1e4] {
        let (time, _) = driven.fall_to(1.0 - drop, at(1.0, -2.0)).unwrap();
        assert_relative_eq!(time, (0.2 * drop / 2.0).ln_1p() / 0.2, max_relative = 1e-11);
    }
}

/// Thrown up from below a level against gravity and damping alone it comes down to it later than it was highest,
/// `q = (v + g/k)(1 - exp(-k t))/k - g t/k`, however near to its highest point the level is.
#[test]
fn a_throw_from_below_comes_down_after_its_highest_point() {
    let (rate, gravity, velocity) = (1.0, 10.0, 5.0);
    let thrown = flight(0.5 * rate, 0.0, gravity);
    let position = |time: f64| (velocity + gravity) * (1.0 - (-time).exp()) - gravity * time;
    let peak = 1.5_f64.ln();
    for below in [1e-6, 1e-4, 0.005, 0.1, 0.5] {
        let level = position(peak) - below;
        let (time, state) = thrown.fall_to(level, at(0.0, velocity)).unwrap();
        assert!(time > peak && state.velocity < 0.0, "{below}: {time} {state:?}");
        assert_abs_diff_eq!(position(time), level, epsilon = 1e-14);
    }
}

/// In a unit of time that is a power of two times as long every number is that power times another, to the last bit, and so is the time of a fall.
#[test]
fn a_fall_takes_as_long_in_any_unit_of_time() {
    let mut falls = 0;
    for zeta in [0.05, 0.3, 1.0, 2.0, 7.0, 40.0] {
        for (w0_squared, gravity) in [(0.0, 10.0), (1.0, 0.0), (1.0, 10.0), (25.0, 3.0)] {
            for (height, velocity) in [(0.02, 0.0), (0.02, 3.0), (0.3, -2.0), (1.0, -0.1), (5.0, 1.0), (40.0, -90.0)] {
                let fall = |unit: f64| {
                    let flight = flight(zeta * unit, w0_squared * unit * unit, gravity * unit * unit);
                    let (time, state) = flight.fall_to(-0.4, at(height - 0.4, velocity * unit))?;
                    Some((time * unit, state.velocity / unit))
                };
                let expected = fall(1.0);
                falls += u32::from(expected.is_some());
                for power in [-40, -8, 8, 40] {
                    let words = format!("{zeta} {w0_squared} {gravity}, {height} m, {velocity} m/s, 2^{power}");
                    assert_eq!(fall(2.0_f64.powi(power)), expected, "{words}");
                }
            }
        }
    }
    assert!(falls > 50, "{falls}");
}

/// Damping stops a follower that is thrown down, and it sinks the rest of the way: `q = q0 - s t - w (1 - exp(-k t))/k`, `s = g/k`. While it is being
/// stopped, Halley's step from the fall so far leads to before the start.
#[test]
fn a_follower_that_is_stopped_high_above_a_level_comes_down_to_it() {
    for turns in [15.0_f64, 16.0, 17.0, 30.0, 31.9, 33.0] {
        for share in [0.3, 1.0, 3.0] {
            // With k = 1 and s = 1, so fast that half of the way is left when as much of the velocity is.
            let fast = share * (0.5 * turns).exp();
            let drop = turns + fast * -(-turns).exp_m1();
            let (time, state) = flight(0.5, 0.0, 1.0).fall_to(0.0, at(drop, -1.0 - fast)).unwrap();
            assert_relative_eq!(time, turns, max_relative = 1e-8);
            assert_relative_eq!(state.velocity, -1.0 - fast * (-time).exp(), max_relative = 1e-8);
        }
    }
}
