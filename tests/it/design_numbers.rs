//! Are forces and what must be changed what they are in closed form, of an eccentric under a spring, a damper and gravity, in any units?

use std::f64::consts::{PI, TAU};

use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::cam::Cam;
use corner_impact::model::{Model, Study};
use corner_impact::progress::Unwatched;
use corner_impact::simulate::angular_velocity;
use corner_impact::study::StudyError;
use corner_impact::study::design::contact::{Contact, Separation};
use corner_impact::study::design::loads::{Load, Loads};
use corner_impact::study::design::needs::{Answer, Lever};
use corner_impact::study::design::{Asked, Design, design};
use corner_impact::study::survey::Values;
use corner_impact::tolerance;
use serde_json::json;

use crate::common;
use crate::design::{separation, valve};
use crate::orbit_numbers::{machine, model};

/// A mass on an eccentric, `c = 0.1 + 0.02 cos(theta)` in m.
#[derive(Clone, Copy)]
pub struct Eccentric {
    pub mass: f64,
    pub damping: f64,
    pub stiffness: f64,
    pub rest: f64,
}

pub const GRAVITY: f64 = 9.81;
pub const HEIGHT: f64 = 0.02;
pub const OWN: Eccentric = Eccentric { mass: 0.5, damping: 4.0, stiffness: 2000.0, rest: 0.05 };

impl Eccentric {
    /// The text, in m, kg and N or in mm, g and kN.
    pub fn model(self, preloaded: bool, in_millimetres: bool) -> Model {
        let [length, mass, force] = if in_millimetres { [1e3, 1e3, 1e-3] } else { [1.0; 3] };
        let units = "[units]\nlength = \"mm\"\nmass = \"g\"\nforce = \"kN\"\n";
        let spring = match preloaded {
            true => format!("preload = {:?}", self.preload() * force),
            false => format!("rest_position = {:?}", self.rest * length),
        };
        let text = format!(
            "name = \"eccentric\"\n{}[follower]\nmass = {:?}\ndamping = {:?}\nstiffness = {:?}\ngravity = 9.81\nrestitution = 0.5\n{spring}\n\
             [cam]\nlaw = \"harmonic\"\noffset = {:?}\namplitudes = [{:?}]\nphases_deg = [0.0]\n",
            if in_millimetres { units } else { "" },
            self.mass * mass,
            self.damping,
            self.stiffness,
            0.1 * length,
            HEIGHT * length
        );
        Model::parse("eccentric.toml", &text).unwrap()
    }

    pub fn preload(self) -> f64 {
        self.stiffness * (0.1 - HEIGHT - self.rest)
    }

    /// What presses in the mean, N.
    pub fn mean(self) -> f64 {
        self.stiffness * (0.1 - self.rest) + self.mass * GRAVITY
    }

    /// How far the force goes up and down about that at an angular velocity: `a |k - m w^2 + i b w|`.
    pub fn sway(self, omega: f64) -> f64 {
        HEIGHT * (self.stiffness - self.mass * omega * omega).hypot(self.damping * omega)
    }

    /// Where the two are one: `m^2 x^2 + (b^2 - 2 k m) x + k^2 - (mean/a)^2 = 0` of x = w^2.
    pub fn leaves(self) -> f64 {
        let Self { mass, damping, stiffness, .. } = self;
        let (a, b) = (mass * mass, damping * damping - 2.0 * stiffness * mass);
        let c = stiffness * stiffness - (self.mean() / HEIGHT).powi(2);
        ((-b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a)).sqrt()
    }
}

/// On the table with an amplitude of a millimetre, in metres or as written.
pub fn ball(units: &str) -> Model {
    let amplitude = if units.is_empty() { "0.001" } else { "1.0" };
    let text = format!(
        "name = \"ball\"\n{units}[follower]\nmass = 2.0\ndamping = 0.0\nstiffness = 0.0\ngravity = 9.81\nrest_position = 0.0\nrestitution = 0.8\n\
         [cam]\nlaw = \"harmonic\"\noffset = 0.0\namplitudes = [{amplitude}]\nphases_deg = [0.0]\n"
    );
    Model::parse("ball.toml", &text).unwrap()
}

pub fn rpm(omega: f64) -> f64 {
    omega / TAU * 60.0
}

/// With a rest position or a preload, in metres or millimetres, where the spring is stronger than the mass and where it is weaker.
#[test]
fn the_force_on_an_eccentric_is_a_mean_and_a_sine() {
    for (own, in_millimetres) in [(OWN, false), (Eccentric { damping: 60.0, ..OWN }, true)] {
        for preloaded in [false, true] {
            let model = own.model(preloaded, in_millimetres);
            let cam = common::cam(&model);
            let contact = Contact::new(&cam, model.follower);
            let force = |inside: f64| {
                let told = model.units.force.told(inside);
                if in_millimetres { told * 1e3 } else { told }
            };
            for speed in [0.3, 30.0, 500.0, 700.0, 2000.0] {
                let omega = angular_velocity(speed);
                let (least, largest) = (contact.least(speed), contact.largest(speed));
                assert_relative_eq!(
                    force(least.value),
                    own.mean() - own.sway(omega),
                    max_relative = 1e-12,
                    epsilon = 1e-9
                );
                assert_relative_eq!(force(largest), own.mean() + own.sway(omega), max_relative = 1e-12);
                let deep = (own.damping * omega).atan2(own.mass * omega * omega - own.stiffness).rem_euclid(TAU);
                assert_abs_diff_eq!(least.angle, deep, epsilon = 1e-6);
                for angle in [0.0, 1.0, 4.0] {
                    let (cos, sin) = (f64::cos(angle), f64::sin(angle));
                    let sways = (own.stiffness - own.mass * omega * omega) * cos - own.damping * omega * sin;
                    let told = force(contact.force(&cam.lift(angle), omega));
                    assert_relative_eq!(told, own.mean() + HEIGHT * sways, max_relative = 1e-12, epsilon = 1e-9);
                }
            }
            let Separation::At { rpm: at, error, cam_angle, .. } = contact.separation() else { panic!() };
            let omega = own.leaves();
            assert_relative_eq!(at, rpm(omega), max_relative = 1e-12);
            assert_abs_diff_eq!(
                cam_angle,
                (own.damping * omega).atan2(own.mass * omega * omega - own.stiffness),
                epsilon = 1e-6
            );
            assert_eq!(contact.separation().speed(), at);
            // Each term of N by its rounding and by that of the angle, over dN/dw, and a rounding of the speed itself.
            let (cos, sin) = (cam_angle.cos(), cam_angle.sin());
            let kept = own.mass * GRAVITY + own.stiffness * own.rest.abs();
            let of_motion = (own.mass * omega * omega + own.damping * omega + own.stiffness) * HEIGHT * (1.0 + TAU);
            let size = of_motion + own.stiffness * 0.1 + kept;
            let rate = HEIGHT * (2.0 * own.mass * omega * cos + own.damping * sin);
            let expected = tolerance::RANGE_ROUNDING.value * rpm(size / rate.abs()) + tolerance::ULP.value * rpm(omega);
            assert_relative_eq!(error, expected, max_relative = 1e-3);
        }
    }
}

#[test]
fn a_follower_leaves_at_a_speed_at_every_one_or_at_none() {
    let told = |model: &Model| {
        let found = separation(model);
        (found.name(), found.speed())
    };
    assert_eq!(told(&model("laws/rectified-sine")), ("at-every-speed", 0.0));
    // Pulled off the top: k (c - rest) + m g is least at the lowest lift.
    let pulled = Eccentric { rest: 0.0826, ..OWN };
    assert!(pulled.preload() + pulled.mass * GRAVITY < 0.0);
    let Separation::NotPressed { cam_angle } = separation(&pulled.model(false, false)) else { panic!() };
    assert_abs_diff_eq!(cam_angle, PI, epsilon = 1e-6);
    assert_eq!(told(&pulled.model(false, false)), ("at-every-speed", 0.0));
    let pressed = Eccentric { rest: 0.0824, ..OWN };
    assert_eq!(told(&pressed.model(false, false)).0, "at-a-speed");
    // Without a mass that its cam could throw off: a dwell all round.
    let still = "[follower]\nmass = 1\ndamping = 0\nstiffness = 1\ngravity = 9.81\nrest_position = 0\nrestitution = 0.5\n[cam]\n\
                 law = \"program\"\nbase = 1\n[[cam.segment]]\nmotion = \"dwell\"\nspan_deg = 360\nrise = 0\n";
    assert_eq!(told(&Model::parse("still.toml", still).unwrap()), ("never", f64::INFINITY));
}

pub fn asked(need: &str) -> Asked {
    Asked { rpm: Some([100.0, 100.0]), needs: vec![(need.into(), need.parse().unwrap())], ..Asked::default() }
}

pub fn answers(model: &Model, need: &str) -> Vec<Answer> {
    let found = design(model, &asked(need), &Unwatched).unwrap().needs;
    assert!(
        found.iter().map(|it| it.lever).eq(Lever::ALL) && found.iter().all(|it| it.need == need && it.error.is_none())
    );
    found
}

/// The roots of `a x^2 + b x + c`.
fn roots([a, b, c]: [f64; 3]) -> [f64; 2] {
    let root = (b * b - 4.0 * a * c).sqrt();
    [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)]
}

/// At the speed asked for mean and sway are one: an equation of first or second order in each of the numbers, with the spring's rest or its preload
/// as the model keeps it.
#[test]
fn what_must_be_changed_of_an_eccentric_is_a_root() {
    let speed = 1.3 * rpm(OWN.leaves());
    let omega = angular_velocity(speed);
    let (square, a) = (omega * omega, HEIGHT);
    let Eccentric { mass, damping, stiffness, rest } = OWN;
    for (preloaded, in_millimetres) in [(false, false), (true, false), (true, true)] {
        let found = answers(&OWN.model(preloaded, in_millimetres), &format!("no separation to {speed:?} rpm"));
        let [of_force, of_mass] = if in_millimetres { [1e-3, 1e3] } else { [1.0; 2] };
        let one = |lever: Lever| found.iter().find(|it| it.lever == lever).unwrap();
        let preload = one(Lever::Preload);
        let needed = OWN.sway(omega) - mass * GRAVITY - stiffness * a;
        assert_relative_eq!(preload.value.unwrap(), needed * of_force, max_relative = 1e-9);
        assert_relative_eq!(preload.now, OWN.preload() * of_force, max_relative = 1e-12);
        assert_eq!(preload.unit, if in_millimetres { "kN" } else { "N" });
        // (k p + q)^2 = a^2 ((k - m w^2)^2 + b^2 w^2)
        let (p, q) = if preloaded { (a, OWN.preload() + mass * GRAVITY) } else { (0.1 - rest, mass * GRAVITY) };
        let by_stiffness = [
            p * p - a * a,
            2.0 * p * q + 2.0 * a * a * mass * square,
            q * q - a * a * square * (mass * mass * square + damping * damping),
        ];
        let root = if preloaded { -by_stiffness[2] / by_stiffness[1] } else { roots(by_stiffness)[1] };
        assert_relative_eq!(one(Lever::Stiffness).value.unwrap(), root, max_relative = 1e-9);
        let damper = one(Lever::Damping);
        assert_eq!((damper.value, damper.is_upper_bound), (None, false));
        assert!(
            damper.note.starts_with("no damping below ")
                && damper.note.ends_with(" N s/m suffices, with the others unchanged")
        );
        // (k (0.1 - rest) + m g)^2 = a^2 ((k - m w^2)^2 + b^2 w^2)
        let spring = stiffness * (0.1 - rest);
        let by_mass = [
            GRAVITY * GRAVITY - a * a * square * square,
            2.0 * spring * GRAVITY + 2.0 * a * a * stiffness * square,
            spring * spring - a * a * (stiffness * stiffness + damping * damping * square),
        ];
        let root = roots(by_mass).into_iter().find(|mass| *mass > 0.0).unwrap();
        let weight = one(Lever::Mass);
        assert_relative_eq!(weight.value.unwrap(), root * of_mass, max_relative = 1e-9);
        assert!(weight.is_upper_bound && weight.other.is_none() && weight.note.is_empty());
        assert_eq!((weight.unit.as_str(), weight.now), (if in_millimetres { "g" } else { "kg" }, mass * of_mass));
    }
}

/// A machine whose mass alone is uncertain: the most mass is as certain as the runs resolve it, and the other numbers are as uncertain as the
/// mass makes them.
#[test]
#[ignore = "slow"]
fn a_number_that_is_sought_counts_as_exact() {
    let model = OWN.model(true, false).changed(&[("mass.error".to_owned(), 0.01)]).unwrap();
    for what in ["no separation", "impact speed below 0.1 m/s"] {
        let need = format!("{what} to {:?} rpm", 1.1 * rpm(OWN.leaves()));
        for answer in design(&model, &asked(&need), &Unwatched).unwrap().needs {
            let error = answer.error.map(|error| error.total());
            match answer.lever {
                Lever::Mass => assert_eq!(error, Some(0.0), "{answer:?}"),
                _ => assert!(answer.value.is_none() || error > Some(0.0), "{answer:?}"),
            }
        }
    }
}

/// Of what the machine does already: how much damping still does, how little preload, and that there is a mass above which it does no more.
#[test]
fn what_is_done_already_has_its_ends() {
    let speed = 0.8 * rpm(OWN.leaves());
    let omega = angular_velocity(speed);
    let need = format!("no separation to {speed:?} rpm");
    let found = answers(&OWN.model(false, false), &need);
    let one = |lever: Lever| found.iter().find(|it| it.lever == lever).unwrap();
    // a^2 ((k - m w^2)^2 + b^2 w^2) = mean^2
    let sways = OWN.stiffness - OWN.mass * omega * omega;
    let most = ((OWN.mean() / HEIGHT).powi(2) - sways * sways).sqrt() / omega;
    let damper = one(Lever::Damping);
    assert_relative_eq!(damper.value.unwrap(), most, max_relative = 1e-9);
    assert!(damper.is_upper_bound && damper.other.is_none() && damper.note.is_empty(), "{damper:?}");
    let preload = one(Lever::Preload);
    let needed = OWN.sway(omega) - OWN.mass * GRAVITY - OWN.stiffness * HEIGHT;
    assert_relative_eq!(preload.value.unwrap(), needed, max_relative = 1e-9);
    assert!(needed < OWN.preload() && !preload.is_upper_bound);
    // A ball that falls with more than the table does: whatever it weighs; and without a spring nothing of one.
    let table = ball("");
    let found = answers(&table, "no separation to 900 rpm");
    let one = |lever: Lever| found.iter().find(|it| it.lever == lever).unwrap();
    assert_eq!([Lever::Preload, Lever::Stiffness].map(|lever| one(lever).note.as_str()), ["there is no spring"; 2]);
    assert_eq!(one(Lever::Mass).value, Some(2.0 * 2.0_f64.powi(20)));
    assert_eq!(one(Lever::Mass).note, "any value suffices, as far as 2.097e6 kg was tried");
    // a w sqrt((m w)^2 + b^2) = m g
    let omega = angular_velocity(900.0);
    let most = 2.0 * ((GRAVITY / (0.001 * omega)).powi(2) - omega * omega).sqrt();
    assert_relative_eq!(one(Lever::Damping).value.unwrap(), most, max_relative = 1e-9);
    assert!(one(Lever::Damping).is_upper_bound);
    let found = answers(&table, "no separation to 950 rpm");
    let mass = found.iter().find(|it| it.lever == Lever::Mass).unwrap();
    assert_eq!((mass.value, mass.note.as_str()), (None, "no mass above 1.9e-6 kg suffices, with the others unchanged"));
    // Without gravity and preload nothing presses at the lowest lift, which is no separation: it stays up to `m^2 w^2 = 2 k m - b^2`.
    let hung = OWN.model(true, false).with_number("follower.gravity", 0.0).unwrap();
    let found = answers(&hung, "no separation to 500 rpm");
    let preload = found.iter().find(|it| it.lever == Lever::Preload).unwrap();
    assert_eq!((preload.value, preload.note.as_str()), (Some(0.0), "the least possible value suffices"));
    // Gravity of its own presses a mass however little the spring does.
    let light = Eccentric { stiffness: 100.0, rest: 0.08, damping: 0.0, ..OWN };
    let found = answers(&light.model(true, false), "no separation to 50 rpm");
    let preload = found.iter().find(|it| it.lever == Lever::Preload).unwrap();
    assert_eq!((preload.value, preload.note.as_str()), (Some(0.0), "the least possible value suffices"));
}

/// A damper that holds the follower on the rise lets it go on the return: of a speed between what it does without and with the best one, what
/// does is a range, and a narrow one of nearly the best.
#[test]
#[ignore = "slow"]
fn a_damper_that_does_has_two_ends() {
    // Where the best of the values that are tried is below the best one, and above it.
    has_two_ends(&valve("mass = 0.11\ndamping = 0\nstiffness = 30\npreload = 220", "cycloidal"));
    has_two_ends(&valve("mass = 0.11\ndamping = 0\nstiffness = 12\npreload = 220", "cycloidal"));
}

fn has_two_ends(model: &Model) {
    let with = |damping: f64| separation(&model.with_number("follower.damping", damping).unwrap()).speed();
    let (mut low, mut high) = (0.0, 100.0);
    for _ in 0..60 {
        let third = (high - low) / 3.0;
        if with(low + third) < with(high - third) { low += third } else { high -= third }
    }
    let (best, most) = (0.5 * (low + high), with(0.5 * (low + high)));
    assert!(best > 1.0 && most > 1.01 * with(0.0), "{best} {most}");
    for (part, is_narrow) in [(0.5, false), (1.0 - 1e-4, true)] {
        let goal = with(0.0) + part * (most - with(0.0));
        let found = answers(model, &format!("no separation to {goal:?} rpm"));
        let damper = found.iter().find(|it| it.lever == Lever::Damping).unwrap();
        let [least, most] = [damper.value, damper.other].map(Option::unwrap);
        assert!(least < best && best < most && !damper.is_upper_bound && damper.note.is_empty(), "{damper:?}");
        assert_eq!(most - least < 0.1 * best, is_narrow, "{damper:?}");
        for (end, outside) in [(least, 0.999 * least), (most, 1.001 * most)] {
            assert!((with(end) - goal).abs() < 1e-9 * goal && with(outside) < goal, "{damper:?}");
        }
    }
}

/// Pairs from the first value of the other number to its last; each what is needed of a machine with that.
#[test]
#[ignore = "slow"]
fn what_is_needed_against_another_number_is_what_each_needs() {
    let speed = 1.2 * rpm(OWN.leaves());
    let need = format!("no separation to {speed:?} rpm");
    let against = Some(common::axis_of(Lever::Mass, &Values::linear(300.0, 500.0, 3)));
    let found = design(&OWN.model(true, true), &Asked { against, ..asked(&need) }, &Unwatched).unwrap();
    assert_eq!(
        found.trades.iter().map(|it| it.parameter).collect::<Vec<_>>(),
        [Lever::Preload, Lever::Stiffness, Lever::Damping]
    );
    let alone = [0.3, 0.4, 0.5].map(|mass| answers(&Eccentric { mass, ..OWN }.model(true, true), &need));
    for trade in &found.trades {
        assert_eq!((trade.against.as_str(), trade.against_unit.as_str(), &trade.need), ("mass", "g", &need));
        assert_eq!(trade.pairs.iter().map(|it| it.given).collect::<Vec<_>>(), [300.0, 400.0, 500.0]);
        for (pair, alone) in trade.pairs.iter().zip(&alone) {
            let alone = alone.iter().find(|it| it.lever == trade.parameter).unwrap();
            // None at all comes before the most that does.
            let expected = if alone.is_upper_bound { [Some(0.0), alone.value] } else { [alone.value, alone.other] };
            assert_eq!([pair.found, pair.other].map(|it| it.is_some()), expected.map(|it| it.is_some()), "{trade:?}");
            for (one, other) in [pair.found, pair.other].into_iter().zip(expected) {
                assert_relative_eq!(one.unwrap_or(0.0), other.unwrap_or(0.0), max_relative = 1e-9, epsilon = 1e-12);
            }
        }
    }
    assert_eq!(found.trades.iter().map(|it| it.unit.as_str()).collect::<Vec<_>>(), ["kN", "N/m", "N s/m"]);
    // A single value is the first.
    let one = Asked { against: Some(common::axis_of(Lever::Preload, &Values::linear(50.0, 90.0, 1))), ..asked(&need) };
    let found = design(&OWN.model(true, false), &one, &Unwatched).unwrap();
    assert!(found.trades.iter().all(|it| it.pairs.len() == 1 && it.pairs[0].given == 50.0));
}

/// Around the separation, over `[study]` where there is none, or as asked; one speed has the force round the cam.
#[test]
fn forces_are_at_the_speeds_that_are_asked_for() {
    let own = OWN.model(false, false);
    let leaves = separation(&own).speed();
    let speeds = |found: &Design| found.forces.iter().map(|at| at.place.rpm).collect::<Vec<_>>();
    let told = |rpm: Option<[f64; 2]>, speeds: u32| {
        design(&own, &Asked { rpm, speeds, ..Asked::default() }, &Unwatched).unwrap()
    };
    let usual = told(None, 0);
    assert_eq!((speeds(&usual), usual.round.len()), (vec![0.5 * leaves, 1.5 * leaves], 0));
    assert_eq!(usual.loads.iter().map(|it| it.place.rpm).collect::<Vec<_>>(), [1.5 * leaves]);
    assert_eq!(speeds(&told(Some([100.0, 200.0]), 3)), [100.0, 150.0, 200.0]);
    let one = told(Some([300.0, 300.0]), 7);
    assert_eq!((speeds(&one), one.round.len()), (vec![300.0], 721));
    let omega = angular_velocity(300.0);
    for (index, [angle, force]) in one.round.iter().enumerate() {
        assert_abs_diff_eq!(*angle, TAU * index as f64 / 720.0, epsilon = 1e-12);
        let sways = (OWN.stiffness - OWN.mass * omega * omega) * angle.cos() - OWN.damping * omega * angle.sin();
        assert_relative_eq!(*force, OWN.mean() + HEIGHT * sways, max_relative = 1e-9);
    }
    // Both sides of each corner.
    let parts =
        design(&model("laws/polynomial"), &Asked { rpm: Some([300.0; 2]), ..Asked::default() }, &Unwatched).unwrap();
    let angles: Vec<f64> = parts.round.iter().map(|[angle, _]| *angle).collect();
    assert_eq!(angles.iter().filter(|angle| (*angle - PI / 2.0).abs() < 1e-9).count(), 2);
    assert!(angles.windows(2).all(|pair| pair[1] - pair[0] < TAU / 719.0 && pair[0] <= pair[1]));
    assert_eq!(angles.len(), 720 + parts.round.windows(2).filter(|pair| pair[0][0] == pair[1][0]).count() + 1);
    let mut kink = model("laws/rectified-sine");
    kink.study = None;
    let none = design(&kink, &Asked::default(), &Unwatched).map(|_| ());
    assert!(matches!(none, Err(StudyError::NoSpeeds)), "{none:?}");
    kink.study = Some(Study { rpm_min: 20.0, rpm_max: 21.0 });
    let found = design(&kink, &Asked::default(), &Unwatched).unwrap();
    assert_eq!((speeds(&found), found.loads.len()), (Vec::new(), 2));
}

/// A mass under its weight alone on a cam that falls away at a sharp top only, `c'' = a (1 - F)` with Fejer's kernel F of order 8,
/// which is 8 at the top and below 1 farther than half a radian from it: it leaves at the top, at `w^2 = g / (7 a)`.
#[test]
fn a_follower_leaves_at_a_top_that_is_narrow() {
    const ORDER: u32 = 8;
    const A: f64 = 0.01;
    for top in [1.1_f64, 2.25, 3.4, 4.55] {
        let numbers = |number: &dyn Fn(f64) -> f64| {
            let told: Vec<String> = (1..=ORDER).map(|order| format!("{:?}", number(f64::from(order)))).collect();
            told.join(", ")
        };
        let amplitudes = numbers(&|order| A * 2.0 * (1.0 - order / f64::from(ORDER)) / (order * order));
        let phases = numbers(&|order| -(order * top).to_degrees());
        let text = format!(
            "name = \"top\"\n[follower]\nmass = 0.5\ndamping = 0.0\nstiffness = 0.0\ngravity = 9.81\nrestitution = 0.5\nrest_position = 0.0\n\
             [cam]\nlaw = \"harmonic\"\noffset = 0.0\namplitudes = [{amplitudes}]\nphases_deg = [{phases}]\n"
        );
        let model = Model::parse("top.toml", &text).unwrap();
        let found = separation(&model);
        let Separation::At { rpm: leaves, cam_angle, .. } = found else { panic!("{top}: {found:?}") };
        assert_relative_eq!(leaves, rpm((GRAVITY / (7.0 * A)).sqrt()), max_relative = 1e-12);
        assert_abs_diff_eq!(cam_angle, top, epsilon = 1e-6);
    }
}

/// Of a follower that a spring holds off the cam there is no speed at which it first leaves, rounded or not.
#[test]
fn what_is_never_on_the_cam_leaves_at_no_speed() {
    let lifted = model("osorio-2008").with_number("follower.rest_position", 1e3).unwrap();
    let found = design(&lifted, &Asked { rpm: Some([100.0, 100.0]), ..Asked::default() }, &Unwatched).unwrap();
    assert!(matches!(found.separation, Separation::NotPressed { .. }));
    assert!(
        !found.rounded.is_empty() && found.rounded.iter().all(|it| it.separation_rpm.is_none()),
        "{:?}",
        found.rounded
    );
}

/// At the very speed of the separation the follower is on the cam yet, which presses; a little above, it is off and lands.
#[test]
fn at_the_separation_itself_the_cam_presses() {
    let own = OWN.model(false, false);
    let leaves = separation(&own).speed();
    for (rpm, loads) in [(leaves, 0), (leaves * (1.0 + 1e-9), 1)] {
        let asked = Asked { rpm: Some([rpm; 2]), limits: vec![(Load::Force, OWN.mean())], ..Asked::default() };
        let found = design(&own, &asked, &Unwatched).unwrap();
        assert_eq!((found.loads.len(), found.limits[0].at.map(|at| at.rpm)), (loads, Some(rpm)));
    }
    assert_relative_eq!(
        Loads::at(&own, &machine(&own, 2.0 * leaves)).unwrap().place.rpm,
        2.0 * leaves,
        max_relative = 1e-15
    );
}

/// Without damping and weight the least force is `P + 2 k a - m a w^2`: a little above `m w^2 = 2 k` a preload is needed that is a
/// hundred-millionth of what the spring does otherwise, and is none of those that are tried first.
#[test]
fn a_preload_that_is_next_to_nothing_is_found() {
    let (stiffness, mass, beyond) = (2000.0_f64, 0.5, 1e-8);
    let text = format!(
        "name = \"light\"\n[follower]\nmass = {mass:?}\ndamping = 0.0\nstiffness = {stiffness:?}\ngravity = 0.0\nrestitution = 0.5\npreload = 1.0\n\
         [cam]\nlaw = \"harmonic\"\noffset = {HEIGHT:?}\namplitudes = [{HEIGHT:?}]\nphases_deg = [0.0]\n"
    );
    let model = Model::parse("light.toml", &text).unwrap();
    let omega = (2.0 * stiffness / mass * (1.0 + beyond)).sqrt();
    let need = format!("no separation to {:?} rpm", rpm(omega));
    let found = answers(&model, &need).into_iter().find(|it| it.lever == Lever::Preload).unwrap();
    // The force is a difference of numbers that are a hundred million times as large.
    assert_relative_eq!(found.value.unwrap(), 2.0 * stiffness * HEIGHT * beyond, max_relative = 1e-6);
    assert_eq!((found.other, found.note.as_str()), (None, ""));
}

/// A machine that is lighter as a whole moves as before, and needs a preload as much smaller.
#[test]
fn a_preload_is_as_light_as_the_machine() {
    for heavy in [1e-9_f64, 1e9] {
        let (stiffness, mass, beyond) = (2000.0 * heavy, 0.5 * heavy, 1e-8_f64);
        let text = format!(
            "name = \"light\"\n[follower]\nmass = {mass:?}\ndamping = 0.0\nstiffness = {stiffness:?}\ngravity = 0.0\nrestitution = 0.5\n\
             preload = {heavy:?}\n[cam]\nlaw = \"harmonic\"\noffset = {HEIGHT:?}\namplitudes = [{HEIGHT:?}]\nphases_deg = [0.0]\n"
        );
        let model = Model::parse("light.toml", &text).unwrap();
        let need = format!("no separation to {:?} rpm", rpm((2.0 * stiffness / mass * (1.0 + beyond)).sqrt()));
        let found = answers(&model, &need).into_iter().find(|it| it.lever == Lever::Preload).unwrap();
        assert_relative_eq!(found.value.unwrap(), 2.0 * stiffness * HEIGHT * beyond, max_relative = 1e-6);
        assert_eq!((found.other, found.note.as_str()), (None, ""));
    }
}

/// The jerk of a rounded cam is told by its size: of thirds of a turn with second derivatives k, 0 and -k that of the jump by 2 k, up or down.
#[test]
fn the_jerk_of_a_rounded_cam_is_its_size_in_either_direction() {
    const THIRD: f64 = TAU / 3.0;
    for bend in [0.02, -0.02] {
        // It closes: the slopes s, s + k L and s again have a mean of 0.
        let (slope, fast) = (-2.0 / 3.0 * bend * THIRD, bend * THIRD / 3.0);
        let high = 0.1 + slope * THIRD + 0.5 * bend * THIRD * THIRD;
        let pieces = [[0.1, slope, 0.5 * bend], [high, fast, 0.0], [high + fast * THIRD, fast, -0.5 * bend]];
        let piece = |piece: usize| json!({ "start_deg": 120 * piece, "coefficients": pieces[piece] });
        let cam = json!({ "law": "polynomial", "segment": [piece(0), piece(1), piece(2)] });
        let document = json!({ "follower": OWN.model(false, false).follower, "cam": cam });
        let model = Model::of_document("thirds", &document).unwrap();
        let found = design(&model, &Asked { rpm: Some([300.0; 2]), ..Asked::default() }, &Unwatched).unwrap();
        assert!(!found.rounded.is_empty());
        for rounded in &found.rounded {
            let sharp = model.with_number("cam.corner_rounding_deg", rounded.corner_rounding_deg).unwrap();
            let cam = Cam::new(&sharp).unwrap();
            let third = |index: u32| cam.lift(TAU * f64::from(index) / 36_000.0).third;
            let [least, most] = [f64::min, f64::max].map(|which| (0..36_000).map(third).fold(0.0, which));
            assert!(if bend > 0.0 { most > -1.5 * least } else { -least > 1.5 * most }, "{least} {most}");
            let seen = most.max(-least);
            assert!(rounded.jerk >= seen * (1.0 - 1e-12) && rounded.jerk < 1.001 * seen, "{rounded:?} {seen}");
        }
    }
}

/// What the cam presses with is no impact, of a cam with a kink there is no force to be told, and the document has the force round the cam.
#[test]
fn limits_and_forces_are_of_their_own_kind() {
    let own = OWN.model(false, false);
    let below = 0.5 * separation(&own).speed();
    let asked =
        Asked { rpm: Some([below; 2]), limits: vec![(Load::ImpactSpeed, 1e-3), (Load::Gap, 1e-9)], ..Asked::default() };
    let found = design(&own, &asked, &Unwatched).unwrap();
    assert!(found.loads.is_empty() && found.limits.iter().all(|it| it.at.is_none()), "{:?}", found.limits);
    let document = serde_json::to_value(&found).unwrap();
    assert_eq!(document["force_round_the_cam"].as_array().unwrap().len(), 721);
    let kink = design(&model("laws/rectified-sine"), &Asked { rpm: Some([20.0; 2]), ..Asked::default() }, &Unwatched);
    assert!(kink.unwrap().round.is_empty());
}
