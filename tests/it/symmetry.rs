//! Is the loss of a symmetry where mechanics has it? A ball that is thrown from the same place of each lobe loses it at a speed in closed form.
//!
//! Gravity g, restitution r, `k` lobes `c = A cos(nu (theta - top))` about their tops. A flight over m lobes takes `T = 2 pi m/(k omega)`, and lands
//! as fast as it left, `v = g T/2`; so `c' = v (1 - r)/(1 + r)` at each impact. With an angle psi before the top, times nu, at
//! `a = A nu^2 omega^2/g`:
//!
//! ```text
//! a sin psi = pi m (nu/k) (1 - r)/(1 + r)
//! S has the determinant r^2 and the trace 1 + r^2 - (1 + r)^2 a cos psi: the multiplier -1 where a cos psi = 2 (1 + r^2)/(1 + r)^2
//! ```

use std::f64::consts::{PI, TAU};

use corner_impact::cam::Cam;
use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::orbit::PeriodicOrbit;
use corner_impact::orbit::near::near;
use corner_impact::orbit::symmetry::breaking;
use corner_impact::simulate::Machine;

/// A ball over equal lobes, each flight over so many of them.
#[derive(Clone)]
struct Ball {
    /// The lines that describe the cam.
    cam: String,
    lobes: u64,
    /// A, m, and nu.
    wave: [f64; 2],
    /// The angle of a top, rad, and the lift halfway up to it, m.
    top: [f64; 2],
    over: u64,
    restitution: f64,
    gravity: f64,
}

impl Ball {
    /// Over cosines of these amplitudes, m, each with its number of waves; the first has the lobes.
    fn over_waves(waves: &[(usize, f64)], over: u64) -> Self {
        let most = waves.iter().map(|wave| wave.0).max().unwrap();
        let of = |number: usize| waves.iter().find(|wave| wave.0 == number).map_or(0.0, |wave| wave.1);
        let amplitudes: Vec<f64> = (1..=most).map(of).collect();
        let cam = format!(
            "law = \"harmonic\"\noffset = 0.0\namplitudes = {amplitudes:?}\nphases_deg = {:?}\n",
            vec![0.0; most]
        );
        let (lobes, amplitude) = waves[0];
        let wave = [amplitude, lobes as f64];
        Self { cam, lobes: lobes as u64, wave, top: [0.0, 0.0], over, restitution: 0.5, gravity: 9.81 }
    }

    fn over_lobes(lobes: usize, over: u64) -> Self {
        Self::over_waves(&[(lobes, 0.01)], over)
    }

    /// Over two lobes of single motions; one degree of the way down of the second has this motion, and of the first a harmonic one.
    fn over_motions(other: &str) -> Self {
        let lobe = |last: &str| {
            let motions = [
                ("harmonic", 50, 0.02),
                ("dwell", 10, 0.0),
                ("harmonic", 58, -0.0199),
                (last, 1, -0.0001),
                ("dwell", 61, 0.0),
            ];
            motions.map(|(motion, span, rise)| {
                format!("[[cam.segment]]\nmotion = \"{motion}\"\nspan_deg = {span}.0\nrise = {rise:?}\n")
            })
        };
        let motions = [lobe("harmonic").concat(), lobe(other).concat()].concat();
        let cam = format!("law = \"program\"\nbase = 0.0\n{motions}");
        let (wave, top) = ([0.01, 180.0 / 50.0], [50.0_f64.to_radians(), 0.01]);
        Self { cam, lobes: 2, wave, top, over: 1, restitution: 0.5, gravity: 9.81 }
    }

    fn machine(&self, omega: f64) -> Machine {
        let text = format!(
            "[follower]\nmass = 1.0\ndamping = 0.0\nstiffness = 0.0\ngravity = {:?}\nrest_position = 0.0\nrestitution = {:?}\n[cam]\n{}",
            self.gravity, self.restitution, self.cam
        );
        let model = Model::parse("ball.toml", &text).unwrap();
        Machine::new(Cam::new(&model).unwrap(), &model.follower, omega)
    }

    /// a sin psi.
    fn across(&self) -> f64 {
        let loss = (1.0 - self.restitution) / (1.0 + self.restitution);
        PI * self.over as f64 * self.wave[1] / self.lobes as f64 * loss
    }

    /// The speed at which S has the multiplier -1, rad/s.
    fn broken(&self) -> f64 {
        let r = self.restitution;
        let along = 2.0 * (1.0 + r * r) / (1.0 + r).powi(2);
        (self.across().hypot(along) * self.gravity / self.wave[0]).sqrt() / self.wave[1]
    }

    /// psi at a speed, rad/s.
    fn before_top(&self, omega: f64) -> f64 {
        let [amplitude, nu] = self.wave;
        (self.across() * self.gravity / (amplitude * (nu * omega).powi(2))).asin()
    }

    /// The orbit at a speed, rad/s: a run from where the ball is highest.
    fn orbit(&self, omega: f64) -> PeriodicOrbit {
        let psi = self.before_top(omega);
        let half = PI * self.over as f64 / self.lobes as f64;
        let position = self.top[1] + self.wave[0] * psi.cos() + 0.5 * self.gravity * (half / omega).powi(2);
        let angle = (self.top[0] - psi / self.wave[1] + half).rem_euclid(TAU);
        let common = (1..=self.over).rev().find(|it| self.over.is_multiple_of(*it) && self.lobes.is_multiple_of(*it));
        let revolutions = self.over / common.unwrap();
        let orbit = near(&self.machine(omega), angle, State { position, velocity: 0.0 }, revolutions).unwrap().unwrap();
        assert_eq!(orbit.impacts().count() as u64, self.lobes / common.unwrap());
        orbit
    }

    /// Where the symmetry is lost, over where it should be, asked with the orbit at `part` of that speed.
    fn found(&self, part: f64) -> Option<(f64, PeriodicOrbit)> {
        let (omega, machine) = (self.broken(), self.machine(1.0));
        // Right there the equations do not determine the orbit.
        let orbit = self.orbit(if (part - 1.0).abs() < 1e-4 { 0.9999 } else { part } * omega);
        let (found, beside) = breaking(|omega| Some(machine.at_speed(omega)), part * omega, orbit.cycle()?)?;
        Some((found / omega, beside))
    }
}

/// Over two, four and six lobes, with flights over one or more, in one revolution or three; of cosines, and of single motions.
fn balls() -> Vec<Ball> {
    let of_cosines =
        [(2, 1), (2, 3), (4, 1), (4, 2), (4, 3), (6, 1)].map(|(lobes, over)| Ball::over_lobes(lobes, over));
    let other = Ball { restitution: 0.3, gravity: 2.0, ..Ball::over_waves(&[(2, 0.03)], 1) };
    of_cosines.into_iter().chain([other, Ball::over_motions("harmonic")]).collect()
}

#[test]
fn a_symmetry_is_lost_where_a_flight_from_lobe_to_lobe_has_the_multiplier_minus_one() {
    for (index, ball) in balls().iter().enumerate() {
        for part in [0.985, 0.995, 1.0 - 1e-6, 1.0, 1.001, 1.01] {
            let (found, beside) = ball.found(part).unwrap_or_else(|| panic!("{index} from {part}"));
            assert!((found - 1.0).abs() < 1e-11, "{index} from {part}: {found}");
            // The orbit is one of a speed right above, at which it draws in nothing any more.
            let psi = |speed: f64| ball.before_top(speed * ball.broken());
            let above =
                |event: f64| psi(1.0) - (ball.top[0] - event).rem_euclid(TAU / ball.lobes as f64) * ball.wave[1];
            for event in beside.impacts() {
                let [least, most] = [1e-5, 1e-3].map(|off| psi(1.0) - psi(1.0 + off));
                let above = above(event.cam_angle);
                assert!(least < above && above < most, "{index} from {part}: {above} {least} {most}");
            }
            assert!(!beside.is_stable() && beside.residual < 1e-9, "{beside:?}");
        }
    }
}

/// `a` and psi are all there is: the speed that loses the symmetry at an amplitude has this amplitude, gravity or restitution where it is lost.
#[test]
fn a_symmetry_is_lost_along_any_number_of_the_model() {
    let ball = Ball::over_lobes(2, 1);
    let (omega, begun) = (ball.broken(), 1.01);
    let waves = |part: f64| Ball::over_waves(&[(2, 0.01 * part)], 1);
    let gravity = |part: f64| Ball { gravity: 9.81 * part, ..ball.clone() };
    let restitution = |part: f64| Ball { restitution: 0.5 * part, ..ball.clone() };
    let along: [&dyn Fn(f64) -> Ball; 3] = [&waves, &gravity, &restitution];
    for (index, of) in along.into_iter().enumerate() {
        let orbit = of(begun).orbit(omega);
        let found = breaking(|part| Some(of(part).machine(omega)), begun, orbit.cycle().unwrap()).unwrap().0;
        assert!((found - 1.0).abs() < 1e-12, "{index}: {found}");
    }
    // A number may be negative; one that is 0 has no part to go on by.
    let (machine, orbit) = (ball.machine(omega), ball.orbit(begun * omega));
    let cycle = orbit.cycle().unwrap();
    let found = breaking(|it| Some(machine.at_speed(-it)), -begun * omega, cycle).unwrap().0;
    assert!((found / omega + 1.0).abs() < 1e-12, "{found}");
    assert_eq!(breaking(|it| Some(machine.at_speed(begun * omega + it)), 0.0, cycle), None);
}

/// What is more than two hundredths away is lost somewhere else.
#[test]
fn a_symmetry_that_is_lost_far_away_is_not_lost_here() {
    let ball = Ball::over_lobes(2, 1);
    for part in [0.95, 0.97, 1.03, 1.05] {
        assert_eq!(ball.found(part), None, "{part}");
    }
    for part in [0.982, 1.018] {
        assert!((ball.found(part).unwrap().0 - 1.0).abs() < 1e-12, "{part}");
    }
}

/// Of an odd number of parts the whole period has the multiplier -1 where each has: the period doubles.
#[test]
fn an_orbit_of_an_odd_number_of_equal_parts_has_no_such_symmetry_to_lose() {
    for (lobes, over) in [(1, 1), (3, 1), (6, 2), (3, 2)] {
        let ball = Ball::over_lobes(lobes, over);
        assert_eq!(ball.found(0.999), None, "{lobes} {over}");
    }
}

/// Each lobe or pair of lobes moves the ball in the same way only as far as they are equal, in lift and in slope.
#[test]
fn lobes_that_are_not_equal_have_no_symmetry_to_lose() {
    // The lobes have a height of 0.02 m, and equal digits down to 1e-9 of it.
    for others in [
        vec![(1, 1e-5)],
        vec![(1, 1e-9)],
        // Their lift is as good as equal, but not the slope; and the other way round.
        vec![(15, 5e-12)],
        vec![(1, 1e-11), (3, 1e-11 / 9.0)],
    ] {
        let ball = Ball::over_waves(&[&[(2, 0.01)], &others[..]].concat(), 1);
        assert_eq!(ball.found(0.999), None, "{others:?}");
    }
    let found = Ball::over_waves(&[(2, 0.01), (1, 2e-12)], 1).found(0.999).unwrap().0;
    assert!((found - 1.0).abs() < 1e-9, "{found}");
    // One degree in which a tenth of a millimetre is gone down otherwise.
    assert_eq!(Ball::over_motions("cycloidal").found(0.999), None);
    // Lobes of which only each second is equal, for flights over one.
    let found = Ball::over_waves(&[(4, 0.01), (2, 1e-5)], 1).found(0.999);
    assert_eq!(found, None);
}

/// The orbit is asked for from what nearly is it: by whichever impact it begins, and not from what is far from symmetric.
#[test]
fn what_is_near_to_symmetric_is_taken_for_it_and_nothing_else() {
    for ball in balls() {
        let (omega, machine) = (ball.broken(), ball.machine(1.0));
        let begun = 0.999 * omega;
        let orbit = ball.orbit(begun);
        let cycle = orbit.cycle().unwrap();
        let asked = |moved: f64, faster: f64| {
            let mut other = cycle.clone();
            other.impacts[0].cam_angle += moved / 2.0;
            other.impacts[1].cam_angle -= moved / 2.0;
            other.impacts[0].velocity_before *= 1.0 + faster / 2.0;
            other.impacts[1].velocity_before *= 1.0 - faster / 2.0;
            breaking(|omega| Some(machine.at_speed(omega)), begun, &other).map(|(found, _)| found / omega)
        };
        for (moved, faster) in [(0.0, 0.0), (0.05, 0.05), (-0.05, 0.1)] {
            let found = asked(moved, faster).unwrap_or_else(|| panic!("{moved} {faster}"));
            assert!((found - 1.0).abs() < 1e-11, "{moved} {faster}: {found}");
        }
        for (moved, faster) in [(0.5, 0.0), (-0.5, 0.0), (0.0, 0.6), (0.0, -0.6)] {
            assert_eq!(asked(moved, faster), None, "{moved} {faster}");
        }
        let mut turned = cycle.clone();
        turned.impacts.rotate_left(1);
        let found = breaking(|omega| Some(machine.at_speed(omega)), begun, &turned).unwrap().0;
        assert!((found / omega - 1.0).abs() < 1e-11, "{found}");
    }
}

/// An orbit of two impacts over one lobe doubles its period at four times the speed at which it loses its symmetry over four.
#[test]
fn a_symmetry_of_parts_with_two_impacts_is_lost_where_these_alone_double_the_period() {
    let (one, four) = (Ball::over_lobes(1, 1).machine(1.0), Ball::over_lobes(4, 1).machine(1.0));
    let settled = |machine: &Machine, revolutions: u64| {
        let mut motion = machine.start_on_cam(0.0, 0.5).unwrap();
        machine.revolve(&mut motion, 4000).unwrap();
        machine.turn_to(&mut motion, 0.0).unwrap();
        near(machine, 0.0, motion.state, revolutions).unwrap().unwrap()
    };
    // 1 + tr M + det M by the secant through what it was at two speeds.
    let begun = 1.02 * Ball::over_lobes(1, 1).broken();
    let mut orbit = settled(&one.at_speed(begun), 2);
    assert_eq!((orbit.impacts().count(), orbit.is_stable()), (2, true));
    let mut missing = |omega: f64| {
        orbit = near(&one.at_speed(omega), 0.0, orbit.state, 2).unwrap().unwrap();
        1.0 + orbit.matrix.trace() + orbit.matrix.determinant()
    };
    let mut last = [(begun, missing(begun)), (1.001 * begun, missing(1.001 * begun))];
    for _ in 0..30 {
        let [(from, low), (to, high)] = last;
        if (to - from).abs() < 1e-13 * begun {
            break;
        }
        let next = to - (high * (to - from) / (high - low)).clamp(-0.002 * begun, 0.002 * begun);
        last = [last[1], (next, missing(next))];
    }
    let flip = last[1].0;
    let begun = 0.25 * 0.999 * flip;
    let orbit = settled(&four.at_speed(begun), 1);
    assert_eq!(orbit.impacts().count(), 4);
    let found = breaking(|omega| Some(four.at_speed(omega)), begun, orbit.cycle().unwrap()).unwrap().0;
    assert!((4.0 * found / flip - 1.0).abs() < 1e-9, "{found} {flip}");
}
