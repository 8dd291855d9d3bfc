//! Is the speed of separation that of closed forms with little pressure and much damping, above another speed, and in every unit?

use std::f64::consts::{PI, TAU};

use approx::assert_relative_eq;
use corner_impact::cam::{Cam, nearest_turn};
use corner_impact::model::Model;
use corner_impact::study::design::SeparationPlace;
use corner_impact::study::design::contact::{Contact, Separation};

use crate::design::separation;
use crate::design_numbers::rpm;

fn machine([mass, damping, stiffness]: [f64; 3], lines: &str, cam: &str) -> Model {
    let text = format!(
        "[follower]\nmass = {mass:?}\ndamping = {damping:?}\nstiffness = {stiffness:?}\nrestitution = 0.5\n{lines}\n[cam]\n{cam}"
    );
    Model::parse("pressed.toml", &text).unwrap()
}

/// Before a bottom `c = a x^2` it is `N = P + a (k x^2 - 2 b w x + 2 m w^2)`, 0 first at `a w^2 (b^2 - 2 k m) = k P`, where `x = b w/k`.
#[test]
fn a_damped_follower_that_little_presses_on_leaves_before_the_bottom() {
    let (height, span) = (0.02, 0.5 * PI);
    let [mass, stiffness] = [0.5, 1000.0];
    let a = 2.0 * height / (span * span);
    let segment = |motion: &str, degrees: f64, rise: f64| {
        format!("[[cam.segment]]\nmotion = \"{motion}\"\nspan_deg = {degrees:?}\nrise = {rise:?}\n")
    };
    let cam = "law = \"program\"\nbase = 0.0\n".to_owned()
        + &segment("parabolic", 90.0, height)
        + &segment("dwell", 60.0, 0.0)
        + &segment("parabolic", 90.0, -height)
        + &segment("dwell", 120.0, 0.0);
    for damping in [33.0_f64, 40.0, 80.0] {
        for (preload, within) in [(0.1, 1e-9), (1e-3, 1e-9), (1e-5, 1e-8), (1e-8, 1e-5)] {
            let lines = format!("preload = {preload:?}\ngravity = 0.0");
            let found = separation(&machine([mass, damping, stiffness], &lines, &cam));
            let omega = (stiffness * preload / (a * (damping * damping - 2.0 * stiffness * mass))).sqrt();
            let Separation::At { rpm: at, cam_angle, .. } = found else { panic!("{damping} {preload}: {found:?}") };
            assert_relative_eq!(at, rpm(omega), max_relative = within);
            let x = damping * omega / stiffness;
            assert!(
                (240.0_f64.to_radians() - cam_angle - x).abs() < 100.0 * within.sqrt() * x,
                "{damping} {preload} {x}"
            );
        }
    }
}

/// A cam that falls to its dwell as `x^2/2 + g x^4`: a damper with `b^2 = 2.4 k m` pulls where `c'^2/(c'' c) > 5/3`, which is next to the
/// dwell alone, and then again far up. The speeds at which it does are apart.
struct Narrow {
    g: f64,
    mass: f64,
    damping: f64,
    stiffness: f64,
}

impl Narrow {
    /// Of the last piece, rad: less than between any two angles that are looked at all round.
    const LAST: f64 = 0.2 * PI / 180.0;

    /// The pull is deepest at this part of the last piece, where `x sqrt(g) = 0.14`.
    fn deepest_at(part: f64) -> Self {
        let (mass, stiffness) = (0.5, 1000.0);
        Self { g: (0.14 / (part * Self::LAST)).powi(2), mass, damping: f64::sqrt(2.4 * stiffness * mass), stiffness }
    }

    /// Lift and derivatives by x.
    fn lift(&self, x: f64) -> [f64; 5] {
        let g = self.g;
        [0.5 * x * x + g * x.powi(4), x + 4.0 * g * x.powi(3), 1.0 + 12.0 * g * x * x, 24.0 * g * x, 24.0 * g]
    }

    fn cam(&self) -> String {
        let piece = |start: f64, coefficients: &[f64]| {
            format!("[[cam.segment]]\nstart_deg = {:?}\ncoefficients = {coefficients:?}\n", start.to_degrees())
        };
        // By u from the start, where x is this.
        let quartic = |x: f64| {
            let [c, slope, bend, third, fourth] = self.lift(x);
            piece(TAU - x, &[c, -slope, bend / 2.0, -third / 6.0, fourth / 24.0])
        };
        // From a level to a level with a slope, over a span.
        let cubic = |start: f64, span: f64, from: f64, [to, slope]: [f64; 2]| {
            let rise = to - from;
            let second = 3.0 * rise / (span * span) - slope / span;
            let third = slope / (span * span) - 2.0 * rise / span.powi(3);
            piece(start, &[from, 0.0, second, third])
        };
        let first = 1.2 / self.g.sqrt();
        let [c, slope, ..] = self.lift(first);
        let [up, down, high] = [120.0_f64.to_radians(), 220.0_f64.to_radians(), 0.2];
        "law = \"polynomial\"\n".to_owned()
            + &piece(0.0, &[0.0])
            + &cubic(up, down - up, 0.0, [high, 0.0])
            + &cubic(down, TAU - first - down, high, [c, -slope])
            + &quartic(first)
            + &quartic(Self::LAST)
    }

    /// How deep the damper pulls at x, N, at the speed at which it does most; negative where it does not.
    fn pull(&self, x: f64) -> f64 {
        let [c, slope, bend, ..] = self.lift(x);
        (self.damping * slope).powi(2) / (4.0 * self.mass * bend) - self.stiffness * c
    }

    /// The least angular velocity at which `P + k c - b w c' + m w^2 c''` is 0 on the last piece, over many x.
    fn leaves(&self, preload: f64) -> f64 {
        const MANY: u32 = 400_000;
        let at = |index: u32| {
            let x = Self::LAST * (-16.0 * f64::from(index) / f64::from(MANY)).exp();
            let [c, slope, bend, ..] = self.lift(x);
            let (b, still) = (self.damping * slope, preload + self.stiffness * c);
            let square = b * b - 4.0 * self.mass * bend * still;
            if square >= 0.0 { 2.0 * still / (b + square.sqrt()) } else { f64::INFINITY }
        };
        (0..MANY).map(at).fold(f64::INFINITY, f64::min)
    }
}

/// Below that speed the follower stays, and from it on the damper holds it back, although faster it is on the cam again.
#[test]
fn a_damper_that_pulls_over_a_narrow_range_is_found() {
    for place in [2.0 / 3.0, 0.45, 0.2] {
        is_found(place);
    }
}

fn is_found(place: f64) {
    let it = Narrow::deepest_at(place);
    let cam = it.cam();
    let deepest = it.pull(place * Narrow::LAST);
    let between = rpm(0.13 * place * 1.5);
    for part in [0.999, 0.97, 0.9, 0.5, 0.1, 1e-3] {
        let preload = part * deepest;
        let model =
            machine([it.mass, it.damping, it.stiffness], &format!("preload = {preload:?}\ngravity = 0.0"), &cam);
        let omega = it.leaves(preload);
        assert_relative_eq!(separation(&model).speed(), rpm(omega), max_relative = 1e-7);
        let cam = Cam::new(&model).unwrap();
        let least = |part: f64| Contact::new(&cam, model.follower).least(part * rpm(omega)).value;
        assert!(least(1.0 - 1e-4) > 0.0 && least(1.0 + 1e-4) < 0.0, "{part}");
        // Between the two ranges of speeds, whatever the damper does.
        let faster = Contact::new(&cam, model.follower).least(between).value;
        assert!(faster > 0.0, "{faster}");
    }
    // Without a preload it is held back however slow the cam turns, and faster it leaves where it does with next to none.
    let [without, with] = [0.0, 1e-9 * deepest].map(|preload| {
        let lines = format!("preload = {preload:?}\ngravity = 0.0");
        let model = machine([it.mass, it.damping, it.stiffness], &lines, &cam);
        let cam = Cam::new(&model).unwrap();
        let contact = Contact::new(&cam, model.follower);
        (contact.separation(), contact.separation_above(between).speed())
    });
    assert!(matches!(without.0, Separation::NotPressed { .. }), "{without:?}");
    assert!(without.1 > between);
    assert_relative_eq!(without.1, with.1, max_relative = 1e-6);
}

/// A mass on an eccentric `c = r (1 + cos)`, held up by its weight: `k r - m g = r |k - m w^2 + i b w|` at two speeds, and between them it is on
/// the cam. `m^2 x^2 + (b^2 - 2 k m) x + k^2 - (k - m g/r)^2 = 0` of x = w^2.
#[test]
fn above_a_speed_a_damped_follower_leaves_where_its_closed_form_says() {
    let [mass, stiffness, radius, up] = [0.5, 1000.0, 0.02, 4.0];
    let cam = "law = \"harmonic\"\noffset = 0.02\namplitudes = [0.02]\nphases_deg = [25.0]\n";
    for damping in [0.0, 4.0, 15.0, 22.0] {
        let model = machine([mass, damping, stiffness], &format!("preload = 0.0\ngravity = {:?}", -up), cam);
        let cam = Cam::new(&model).unwrap();
        let contact = Contact::new(&cam, model.follower);
        let (a, b) = (mass * mass, damping * damping - 2.0 * stiffness * mass);
        let c = stiffness * stiffness - (stiffness - mass * up / radius).powi(2);
        let [on, off] = [-1.0, 1.0].map(|sign| rpm(((-b + sign * (b * b - 4.0 * a * c).sqrt()) / (2.0 * a)).sqrt()));
        assert!(matches!(contact.separation(), Separation::NotPressed { .. }));
        for (low, speed) in [(0.99, 0.0), (1.01, off), (0.99 * off / on, off), (1.01 * off / on, 0.0)] {
            assert_relative_eq!(contact.separation_above(low * on).speed(), speed, max_relative = 1e-11);
        }
        assert_eq!(contact.separation_above(0.0), contact.separation());
    }
}

/// On the way down to a bottom `c = a x^n` that nothing presses on, the damper holds the follower back at every speed where `n b^2 > 4 (n - 1) k m`,
/// and else at no slow one: of a cam of any size, and whether a dwell follows or not.
#[test]
fn a_damper_holds_back_by_the_order_of_the_bottom() {
    let [mass, stiffness] = [0.5, 1000.0];
    let is_held = |cam: &str, square: f64| {
        let damping = (square * stiffness * mass).sqrt();
        let model = machine([mass, damping, stiffness], "preload = 0.0\ngravity = 0.0", cam);
        matches!(separation(&model), Separation::NotPressed { .. })
    };
    for size in [1e-12, 1e-9, 0.01, 1.0, 1e9, 1e16] {
        let cam = format!("law = \"harmonic\"\noffset = {size:?}\namplitudes = [{size:?}]\nphases_deg = [25.0]\n");
        assert_eq!([0.99, 1.01].map(|part| is_held(&cam, part * 2.0)), [false, true], "{size}");
    }
    // (1 + cos)^p comes down as x^(2 p).
    let [squared, cubed] = ["2.0, 0.5", "3.75, 1.5, 0.25"];
    for (amplitudes, offset, critical) in [(squared, 1.5, 3.0), (cubed, 2.5, 10.0 / 3.0)] {
        for phase in [0.0, 25.0, 140.0] {
            let phases: Vec<f64> = (1..=amplitudes.split(',').count()).map(|wave| wave as f64 * phase).collect();
            let cam = format!(
                "law = \"harmonic\"\noffset = {offset:?}\namplitudes = [{amplitudes}]\nphases_deg = {phases:?}\n"
            );
            assert_eq!([0.98, 1.02].map(|part| is_held(&cam, part * critical)), [false, true], "{critical} {phase}");
        }
    }
    // A cycloid comes down as x^3.
    for (motion, critical) in [("parabolic", 2.0), ("cycloidal", 8.0 / 3.0)] {
        let held = [0.99, 1.01].map(|part| is_held(&two_dwells(motion), part * critical));
        assert_eq!(held, [false, true], "{motion}");
    }
}

/// Rises and falls by 0.02 m over 90 degrees each, with dwells between.
fn two_dwells(motion: &str) -> String {
    let segment =
        |motion: &str, rise: f64| format!("[[cam.segment]]\nmotion = \"{motion}\"\nspan_deg = 90.0\nrise = {rise:?}\n");
    let segments = segment(motion, 0.02) + &segment("dwell", 0.0) + &segment(motion, -0.02) + &segment("dwell", 0.0);
    format!("law = \"program\"\nbase = 0.0\n{segments}")
}

/// Next to a bottom of order 3 the force first rises, and the damper pulls over less than the angle between two samples.
#[test]
fn a_damper_that_pulls_next_to_a_bottom_has_the_least_force_there() {
    let [mass, stiffness] = [0.5_f64, 1000.0];
    let damping = (4.0 * stiffness * mass).sqrt();
    for preload in [1e-6, 1e-7, 1e-8] {
        let lines = format!("preload = {preload:?}\ngravity = 0.0");
        let model = machine([mass, damping, stiffness], &lines, &two_dwells("cycloidal"));
        let cam = Cam::new(&model).unwrap();
        let contact = Contact::new(&cam, model.follower);
        let at = contact.separation().speed();
        let least = |part: f64| contact.least(part * at).value;
        assert!(
            at > 0.0 && least(0.99) > 0.0 && least(1.01) < 0.0,
            "{preload}: {at} rpm, {:?}",
            [0.99, 1.01].map(least)
        );
    }
}

/// Nothing presses on a mass without a spring and a weight: its inertia alone holds it back where the cam turns down most, and a damper, however
/// slow the cam turns, where that falls fastest; on a cam that stands still nothing does.
#[test]
fn a_mass_that_nothing_presses_on_is_held_back_at_the_top_or_on_the_way_down() {
    let eccentric = "law = \"harmonic\"\noffset = 0.02\namplitudes = [0.02]\nphases_deg = [0.0]\n";
    let free = "rest_position = 0.0\ngravity = 0.0";
    for (damping, turned) in [(0.0, 0.0), (4.0, 0.5 * PI)] {
        let found = separation(&machine([0.5, damping, 0.0], free, eccentric));
        let Separation::NotPressed { cam_angle } = found else { panic!("{found:?}") };
        let off = (cam_angle - turned + PI).rem_euclid(TAU) - PI;
        assert!(off.abs() < 1e-6, "{damping}: {cam_angle}");
    }
    let still = "law = \"program\"\nbase = 1.0\n[[cam.segment]]\nmotion = \"dwell\"\nspan_deg = 360.0\nrise = 0.0\n";
    for damping in [0.0, 4.0] {
        assert_eq!(separation(&machine([0.5, damping, 0.0], free, still)), Separation::Never, "{damping}");
    }
}

/// A weight that hangs on the spring as far as the lowest lift: what presses there is the difference of two large forces, whose rounding holds back
/// nothing. The follower of an eccentric leaves at `m w^2 = 2 k`, whatever the weight.
#[test]
fn a_weight_that_the_spring_just_holds_up_is_none() {
    let [mass, stiffness, radius] = [0.7, 1.3, 0.02];
    let cam = "law = \"harmonic\"\noffset = 0.02\namplitudes = [0.02]\nphases_deg = [25.0]\n";
    for step in 1..40 {
        let gravity = 1.1 * f64::from(step) * if step % 2 == 0 { 100.0 } else { 1.0 };
        let rest = mass * gravity / stiffness;
        let lines = format!("rest_position = {rest:?}\ngravity = {gravity:?}");
        let model = machine([mass, 0.0, stiffness], &lines, cam);
        let cam = Cam::new(&model).unwrap();
        let contact = Contact::new(&cam, model.follower);
        let least = contact.least(0.0).value;
        assert_eq!(least, 0.0, "{gravity}");
        assert_relative_eq!(contact.separation().speed(), rpm((2.0 * stiffness / mass).sqrt()), max_relative = 1e-9);
        assert_relative_eq!(contact.largest(0.0), 2.0 * radius * stiffness, max_relative = 1e-9);
    }
}

/// At the speed of separation the force is 0 but for its rounding, which counts as 0: of a light follower that a strong spring presses on and a damper
/// holds back alone, `k (r + p) = r |k + i b w|` with a preload `k p`, and of a heavy one on a cam whose valley is narrow.
#[test]
fn the_force_at_the_separation_is_rounding_alone() {
    let least = |model: &Model| {
        let cam = Cam::new(model).unwrap();
        let contact = Contact::new(&cam, model.follower);
        let at = contact.separation().speed();
        (at, contact.least(at).value)
    };
    let (stiffness, radius) = (1000.0, 0.02_f64);
    for step in 0..30 {
        let (phase, damping) = (12.3 * f64::from(step), 3.0 + 0.7 * f64::from(step));
        let cam =
            format!("law = \"harmonic\"\noffset = {radius:?}\namplitudes = [{radius:?}]\nphases_deg = [{phase:?}]\n");
        let rest = -9.0 * radius;
        let lines = format!("rest_position = {rest:?}\ngravity = 0.0");
        let (at, force) = least(&machine([1e-12, damping, stiffness], &lines, &cam));
        assert_relative_eq!(at, rpm(stiffness / damping * 99.0_f64.sqrt()), max_relative = 1e-9);
        assert_eq!(force, 0.0, "{phase} {damping}");
    }
    // -sum q^n cos(n theta) of a radius.
    for step in 0..30 {
        let phase = 7.9 * f64::from(step);
        let amplitudes: Vec<f64> = (1..30).map(|number| radius * 0.7_f64.powi(number)).collect();
        let phases: Vec<f64> = (1..30).map(|number| 180.0 + phase * f64::from(number)).collect();
        let cam = format!("law = \"harmonic\"\noffset = 0.1\namplitudes = {amplitudes:?}\nphases_deg = {phases:?}\n");
        let (at, force) = least(&machine([0.5, 0.0, stiffness], "preload = 10.0\ngravity = 0.0", &cam));
        assert!(at > 0.0 && at.is_finite() && force == 0.0, "{phase}: {at} {force}");
    }
}

/// The place where an undamped follower leaves an eccentric is the top itself, and no angle next to it where the force differs by less than its rounding.
#[test]
fn an_undamped_follower_leaves_at_the_top_itself() {
    for turned in [25.0, 25.0 + 3e-6, 25.0 - 2e-6] {
        let cam = format!("law = \"harmonic\"\noffset = 0.02\namplitudes = [0.02]\nphases_deg = [{turned:?}]\n");
        let model = machine([0.5, 0.0, 1000.0], "preload = 10.0\ngravity = 9.81", &cam);
        let Separation::At { cam_angle, .. } = separation(&model) else { panic!("{turned}") };
        let top = Cam::new(&model).unwrap().highest().angle;
        assert!((cam_angle - top).abs() < 1e-12, "{turned}: {cam_angle} {top}");
    }
}

/// The force is told from 0 next to the speed of separation, whatever the unit of length, and however heavy the machine is as a whole.
#[test]
fn the_force_next_to_separation_is_no_rounding_in_any_unit() {
    // The last is a machine of a micrometre.
    for (unit, length) in [("m", 1.0), ("cm", 1e2), ("mm", 1e3), ("um", 1e6), ("ft", 1250.0 / 381.0), ("m", 1e-6)] {
        for heavy in [1.0, 1e-9, 1e9] {
            for (gravity, damping) in [(9.81, 4.0), (9.81, 0.0), (1e-9, 4.0), (0.0, 4.0)] {
                let text = format!(
                    "[units]\nlength = \"{unit}\"\n[follower]\nmass = {:?}\ndamping = {:?}\nstiffness = {:?}\nrestitution = 0.5\n\
                     gravity = {:?}\nrest_position = {:?}\n[cam]\nlaw = \"harmonic\"\noffset = {:?}\namplitudes = [{:?}]\nphases_deg = [0.0]\n",
                    0.5 * heavy,
                    damping * heavy,
                    2000.0 * heavy,
                    gravity * length,
                    0.05 * length,
                    0.1 * length,
                    0.02 * length
                );
                let model = Model::parse("units.toml", &text).unwrap();
                let cam = Cam::new(&model).unwrap();
                let contact = Contact::new(&cam, model.follower);
                let at = contact.separation().speed();
                let [below, here, above] = [-1e-11, 0.0, 1e-11].map(|off| contact.least(at * (1.0 + off)).value);
                assert!(below > 0.0 && above < 0.0, "{unit} {heavy} {gravity} {damping}: {below} {above}");
                assert_eq!(here, 0.0, "{unit} {heavy} {gravity} {damping}");
            }
        }
    }
}

/// A damper may pull over a range of angles that is narrower than any sampled step, on both sides of which the force is larger: the bottom
/// of (1 + cos)^2 and of an eccentric. There the force changes its sign at the speed of separation.
#[test]
fn the_force_is_told_where_a_damper_pulls_between_two_sampled_angles() {
    let [mass, stiffness] = [0.5, 1000.0];
    let bottoms = [("2.0, 0.5", 1.5, 3.0), ("1.0", 1.0, 2.0)];
    for (amplitudes, offset, critical) in bottoms {
        for phase in [0.0, 25.1] {
            let phases: Vec<f64> = (1..=amplitudes.split(',').count()).map(|wave| wave as f64 * phase).collect();
            let cam = format!(
                "law = \"harmonic\"\noffset = {offset:?}\namplitudes = [{amplitudes}]\nphases_deg = {phases:?}\n"
            );
            for above in [1.05_f64, 1.5, 10.0] {
                for preload in [1e-2, 1e-4, 1e-6] {
                    let damping = (above * critical * stiffness * mass).sqrt();
                    let lines = format!("preload = {preload:?}\ngravity = 0.0");
                    let model = machine([mass, damping, stiffness], &lines, &cam);
                    let cam = Cam::new(&model).unwrap();
                    let contact = Contact::new(&cam, model.follower);
                    let at = contact.separation().speed();
                    let [below, here, beyond] = [-1e-2, 0.0, 1e-2].map(|off| contact.least(at * (1.0 + off)).value);
                    let told = format!("{amplitudes} {phase} {above} {preload}: {at} rpm, {below} {here} {beyond}");
                    assert!(below > 0.0 && here == 0.0 && beyond < 0.0, "{told}");
                }
            }
        }
    }
}

/// At a bottom that is flat but for rounding, derivatives of no size at all hold back a follower that nothing presses on: it leaves where one
/// does that next to nothing presses on.
#[test]
fn derivatives_that_are_rounding_hold_back_nothing() {
    let [mass, stiffness] = [0.5, 1000.0];
    for (amplitudes, offset, critical) in [("2.0, 0.5", 1.5, 3.0), ("3.75, 1.5, 0.25", 2.5, 10.0 / 3.0)] {
        for step in 0..60 {
            let phase = 6.1 * f64::from(step);
            let phases: Vec<f64> = (1..=amplitudes.split(',').count()).map(|wave| wave as f64 * phase).collect();
            let cam = format!(
                "law = \"harmonic\"\noffset = {offset:?}\namplitudes = [{amplitudes}]\nphases_deg = {phases:?}\n"
            );
            for part in [0.01_f64, 0.5] {
                let damping = (part * critical * stiffness * mass).sqrt();
                let at = |preload: f64| {
                    let lines = format!("preload = {preload:?}\ngravity = 0.0");
                    separation(&machine([mass, damping, stiffness], &lines, &cam)).speed()
                };
                assert_relative_eq!(at(0.0), at(1e-6), max_relative = 1e-6);
            }
        }
    }
}

/// A lowest lift is flat up to the first order whose term exceeds rounding where the lift does. `4 cos x - (1 + e/4) cos 2x` has the derivatives e
/// and -12 of orders 2 and 4 at its minimum: the parabola counts while `e/2` exceeds the root of 12/24 of the rounding, and a lift that is
/// constant but for rounding has none.
#[test]
fn an_extremum_has_the_order_that_rounding_leaves() {
    let order = |amplitudes: [f64; 2], offset: f64| {
        let cam =
            format!("law = \"harmonic\"\noffset = {offset:?}\namplitudes = {amplitudes:?}\nphases_deg = [0.0, 0.0]\n");
        Cam::new(&machine([0.5, 0.0, 1.0], "rest_position = 0.0\ngravity = 0.0", &cam)).unwrap().segments()[0]
            .order_at(0.0)
    };
    for (second, wanted) in [(1.0, 2), (1e-5, 2), (4e-7, 2), (8e-8, 4), (1e-12, 4), (0.0, 4)] {
        assert_eq!(order([4.0, -1.0 - 0.25 * second], 0.0), Some(wanted), "{second}");
    }
    assert_eq!(order([1e-16, 0.0], 1.0), None);
    let flat = |motion: &str| {
        let cam = format!(
            "law = \"program\"\nbase = 0.1\n[[cam.segment]]\nmotion = \"{motion}\"\nspan_deg = 90.0\nrise = 0.02\n\
             [[cam.segment]]\nmotion = \"{motion}\"\nspan_deg = 180.0\nrise = -0.02\n\
             [[cam.segment]]\nmotion = \"dwell\"\nspan_deg = 90.0\nrise = 0.0\n"
        );
        let cam = Cam::new(&machine([0.5, 0.0, 1.0], "rest_position = 0.0\ngravity = 0.0", &cam)).unwrap();
        let [first, .., last, dwell] = cam.segments() else { panic!("{motion}") };
        [first.order_at(first.start), last.order_at(last.end), dwell.order_at(dwell.start)]
    };
    for (motion, order) in [("harmonic", 2), ("parabolic", 2), ("cycloidal", 3), ("poly345", 3), ("poly4567", 4)] {
        assert_eq!(flat(motion), [Some(order), Some(order), None], "{motion}");
    }
}

/// A follower leaves a cam whose velocity jumps at any speed, however little that throws it.
#[test]
fn a_jump_of_the_velocity_is_left_at_any_speed() {
    let cam = "law = \"polynomial\"\n[[cam.segment]]\nstart_deg = 0\ncoefficients = [0.0, 0.01]\n\
               [[cam.segment]]\nstart_deg = 180\ncoefficients = [0.031415926535897934, -0.01]\n";
    let model = machine([0.5, 0.0, 1000.0], "preload = 10.0\ngravity = 9.81", cam);
    let cam = Cam::new(&model).unwrap();
    let contact = Contact::new(&cam, model.follower);
    assert!(contact.least(1e-3).value > 0.0 && contact.leaves(1e-3));
}

/// An angle is turned by whole turns until it is as near as it can be to another.
#[test]
fn an_angle_is_turned_to_the_nearest() {
    for (angle, other, wanted) in
        [(0.1, 6.2, 0.1 + TAU), (6.2, 0.1, 6.2 - TAU), (1.0, 3.0, 1.0), (3.0, 1.0, 3.0), (0.5, 20.0, 0.5 + 3.0 * TAU)]
    {
        assert_relative_eq!(nearest_turn(angle, other), wanted, max_relative = 1e-14);
    }
}

/// A damper that holds the follower back on the way down to a dwell, which a preload P presses on. A parabola comes down as `a x^2`, where N is
/// least at `x = b w/k`: `P = a w^2 (b^2/k - 2 m)`. Of a cycloid it is the least root of all places. The less the preload, the nearer to the
/// dwell that is.
#[test]
fn a_damper_pulls_as_near_to_the_lowest_lift_as_the_preload_lets_it() {
    let [mass, stiffness, rise, span] = [0.5, 1000.0, 0.02, 0.5 * PI];
    let cam = |motion: &str| {
        let segment = |motion: &str, span: f64, rise: f64| {
            format!("[[cam.segment]]\nmotion = \"{motion}\"\nspan_deg = {span:?}\nrise = {rise:?}\n")
        };
        let turns = [(motion, 90.0, rise), ("dwell", 60.0, 0.0), (motion, 90.0, -rise), ("dwell", 120.0, 0.0)];
        let segments: String = turns.iter().map(|(motion, span, rise)| segment(motion, *span, *rise)).collect();
        format!("law = \"program\"\nbase = 0.0\n{segments}")
    };
    for damping in [50.0, 60.0, 200.0] {
        for power in 2..=8 {
            let preload = 10.0_f64.powi(-power);
            let found = |motion: &str| {
                let lines = format!("preload = {preload:?}\ngravity = 0.0");
                separation(&machine([mass, damping, stiffness], &lines, &cam(motion))).speed()
            };
            // What the lift is rounded by, over the preload.
            let known = 1e-8 + 1e-13 / preload;
            let bend = 2.0 * rise / (span * span);
            let parabola = (preload / (bend * (damping * damping / stiffness - 2.0 * mass))).sqrt();
            assert_relative_eq!(found("parabolic"), rpm(parabola), max_relative = known);
            // c = r (z - sin z)/(2 pi) of z = 2 pi x/span, N = still - 2 fall w + bent w^2.
            let root = |z: f64| {
                let series = z.powi(3) / 6.0 * (1.0 - z * z / 20.0 * (1.0 - z * z / 42.0 * (1.0 - z * z / 72.0)));
                let lift = rise / TAU * if z < 0.3 { series } else { z - z.sin() };
                let fall = damping * rise / span * (0.5 * z).sin().powi(2);
                let (still, bent) = (preload + stiffness * lift, mass * rise * TAU / (span * span) * z.sin());
                let square = fall * fall - bent * still;
                if square > 0.0 { still / (fall + square.sqrt()) } else { f64::INFINITY }
            };
            let least = |middle: f64, apart: f64| {
                let places = (-2000..=2000).map(|index| (middle + apart * f64::from(index)).exp());
                places.map(|z| (root(z), z)).min_by(|one, other| one.0.total_cmp(&other.0)).unwrap()
            };
            let near = least(-9.0, 5e-3).1;
            let cycloid = least(near.ln(), 5e-6).0;
            assert_relative_eq!(found("cycloidal"), rpm(cycloid), max_relative = known);
        }
    }
}

/// The end of a range that ends in the next turn is told within a turn; its width is not.
#[test]
fn a_place_about_angle_0_ends_in_the_next_turn() {
    for (cam_angles, end, width) in
        [([1.0, 1.5], 1.5, 0.5), ([6.0, TAU], 0.0, TAU - 6.0), ([6.0, TAU + 0.5], 0.5, TAU - 5.5)]
    {
        let ([from, to], wide) = SeparationPlace { cam_angles, share: 1.0, cams: 16 }.within_a_turn();
        assert_eq!(from, cam_angles[0]);
        assert_relative_eq!(to, end, epsilon = 1e-15);
        assert_relative_eq!(wide, width, max_relative = 1e-15);
    }
}
