//! Random models, speeds and starts: every law of the cam, every kind of follower.
//!
//! Most speeds are those at which the follower just leaves the cam, where everything happens; the others reach from a
//! thousandth of a revolution a minute to a hundred thousand.

use std::f64::consts::TAU;
use std::fmt;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

use corner_impact::cam::Cam;
use corner_impact::model::Model;
use corner_impact::simulate::{Machine, Motion, SimulateError, angular_velocity};
use proptest::prelude::*;
use proptest::strategy::{Union, ValueTree};
use proptest::test_runner::{Config, RngSeed, TestCaseResult, TestRunner};

use crate::common;

/// A machine, where a run of it starts, and what it was made from.
#[derive(Clone)]
pub struct Case {
    pub model: Model,
    pub machine: Machine,
    pub rpm: f64,
    pub angle: f64,
    pub start: Start,
    /// From the lowest lift to the highest, m; never 0.
    pub stroke: f64,
    pub text: String,
    pub table: Option<String>,
}

#[derive(Clone, Copy, Debug)]
pub enum Start {
    /// On the cam, leaving it at this velocity.
    OnCam(f64),
    /// This far above it, with this velocity.
    Above(f64, f64),
}

/// Everything that is needed to see it again.
impl fmt::Debug for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} rpm, from {:?} at {} rad\n{}", self.rpm, self.start, self.angle, self.text)?;
        self.table.as_ref().map_or(Ok(()), |table| writeln!(f, "table.csv:\n{table}"))
    }
}

impl Case {
    pub fn motion(&self) -> Result<Motion, SimulateError> {
        match self.start {
            Start::OnCam(velocity) => self.machine.start_on_cam(self.angle, velocity),
            Start::Above(height, velocity) => {
                let position = self.machine.cam().lift(self.angle).value + height;
                self.machine.start(self.angle, corner_impact::flight::State { position, velocity })
            }
        }
    }

    /// A velocity of the size of those that the run meets, m/s.
    pub fn velocity(&self) -> f64 {
        let State { omega, acceleration } = self.sizes();
        (omega * self.stroke).max((acceleration * self.stroke).sqrt())
    }

    /// So many turns, rad, but no more than the follower takes for a few thousand swings.
    pub fn turns(&self, count: f64) -> f64 {
        let swings = 2000.0 * self.machine.angular_velocity() / self.machine.flight().omega0_squared().sqrt();
        TAU * count.min(swings)
    }

    fn sizes(&self) -> State {
        let flight = self.machine.flight();
        let acceleration = flight.omega0_squared() * self.stroke + flight.force(self.machine.cam().top()).abs();
        State { omega: self.machine.angular_velocity(), acceleration }
    }
}

struct State {
    omega: f64,
    acceleration: f64,
}

fn unit() -> std::ops::Range<f64> {
    0.0..1.0
}

fn spread(unit: f64, low: f64, high: f64) -> f64 {
    low * (high / low).powf(unit)
}

fn around(unit: f64, size: f64) -> f64 {
    (2.0 * unit - 1.0) * size
}

/// `[follower]`, but for the rest position, which the cam gives its scale.
fn follower() -> impl Strategy<Value = String> {
    let gravity = prop_oneof![Just(0.0), Just(9.81), unit().prop_map(|u| spread(u, 0.1, 100.0)), Just(-1.0)];
    let restitution = prop_oneof![2 => Just(0.0), 2 => Just(1.0), 8 => unit(), 1 => Just(0.99)];
    let stiffness = prop_oneof![1 => Just(0.0), 4 => unit().prop_map(|u| spread(u, 1.0, 1e4))];
    // Of the critical one; of mass/s for a follower without a spring.
    let damping = prop_oneof![
        Just(0.0),
        Just(1.0),
        unit().prop_map(|u| spread(u, 1e-3, 1.0)),
        unit().prop_map(|u| spread(u, 1.0, 100.0))
    ];
    (unit(), damping, stiffness, gravity, restitution).prop_map(|(mass, damping, stiffness, gravity, restitution)| {
        let mass = spread(mass, 0.1, 10.0);
        let damping = damping * if stiffness == 0.0 { mass } else { 2.0 * f64::sqrt(stiffness * mass) };
        format!(
            "mass = {mass:?}\ndamping = {damping:?}\nstiffness = {stiffness:?}\ngravity = {gravity:?}\n\
             restitution = {restitution:?}\n"
        )
    })
}

/// `[follower]` in every regime: damping from none to overdamped, with a spring and without one, and all kinds of impact.
fn follower_of_every_regime() -> impl Strategy<Value = String> {
    let gravity = prop_oneof![Just(0.0), Just(9.81), unit().prop_map(|u| spread(u, 0.1, 100.0))];
    let restitution =
        prop_oneof![Just(0.0), Just(1e-6), Just(1.0), unit(), unit().prop_map(|u| 1.0 - spread(u, 1e-4, 0.1))];
    let stiffness = prop_oneof![1 => Just(0.0), 3 => unit().prop_map(|u| spread(u, 1.0, 1e4))];
    let damping = prop_oneof![
        Just(0.0),
        Just(1.0),
        unit().prop_map(|u| spread(u, 1e-8, 1e-3)),
        unit().prop_map(|u| spread(u, 1e-3, 1.0)),
        unit().prop_map(|u| spread(u, 1.0, 100.0))
    ];
    (damping, stiffness, gravity, restitution).prop_map(|(damping, stiffness, gravity, restitution)| {
        let damping = damping * if stiffness == 0.0 { 1.0 } else { 2.0 * f64::sqrt(stiffness) };
        format!(
            "mass = 1.0\ndamping = {damping:?}\nstiffness = {stiffness:?}\ngravity = {gravity:?}\n\
             restitution = {restitution:?}\n"
        )
    })
}

/// A cam whose lift is the same all round, so that it stands still however it turns.
fn still() -> impl Strategy<Value = Law> {
    unit().prop_map(|offset| {
        (
            format!("law = \"harmonic\"\noffset = {:?}\namplitudes = [0.0]\nphases_deg = [0.0]\n", around(offset, 1.0)),
            None,
        )
    })
}

/// `[cam]`, and the table that it names.
type Law = (String, Option<String>);

fn arcs() -> impl Strategy<Value = Law> {
    [unit(), unit(), unit(), unit(), unit()].prop_map(|[base, flank, nose, start, span]| {
        let base = 0.2 + base;
        let flank = base * (1.05 + 2.0 * flank);
        let start = 10.0 + 130.0 * start;
        let span = 10.0 + (170.0 - start) * span;
        let (sin, cos) = span.to_radians().sin_cos();
        // The largest nose circle that touches the flank circle and ends there.
        let largest = if cos > 0.0 { base } else { flank - (flank - base) * sin };
        let nose = largest.min(flank) * (0.05 + 0.9 * nose);
        let end = start + span;
        let text = format!(
            "law = \"arcs\"\nbase_radius = {base:?}\nflank_radius = {flank:?}\nnose_radius = {nose:?}\n\
             flank_start_deg = {start:?}\nnose_end_deg = {end:?}\n"
        );
        (text, None)
    })
}

fn harmonic() -> impl Strategy<Value = Law> {
    (unit(), prop::collection::vec((unit(), unit()), 1..6)).prop_map(|(offset, terms)| {
        let size = |(index, (unit, _)): (usize, &(f64, f64))| around(*unit, 0.3 / (1.0 + index as f64).powi(2));
        let amplitudes: Vec<f64> = terms.iter().enumerate().map(size).collect();
        let phases: Vec<f64> = terms.iter().map(|(_, phase)| 360.0 * phase).collect();
        let offset = around(offset, 1.0);
        (
            format!("law = \"harmonic\"\noffset = {offset:?}\namplitudes = {amplitudes:?}\nphases_deg = {phases:?}\n"),
            None,
        )
    })
}

fn rectified_sine() -> impl Strategy<Value = Law> {
    (unit(), unit()).prop_map(|(offset, amplitude)| {
        let (offset, amplitude) = (around(offset, 1.0), around(amplitude, 1.0));
        (format!("law = \"rectified-sine\"\noffset = {offset:?}\namplitude = {amplitude:?}\n"), None)
    })
}

const MOTIONS: [&str; 8] =
    ["dwell", "parabolic", "harmonic", "cycloidal", "modified-trapezoid", "modified-sine", "poly345", "poly4567"];

fn program() -> impl Strategy<Value = Law> {
    let segments = prop::collection::vec((0..MOTIONS.len(), unit(), unit()), 1..6);
    (unit(), segments, 1..MOTIONS.len()).prop_map(|(base, mut segments, last)| {
        segments.push((last, 0.3, 0.0));
        let whole: f64 = segments.iter().map(|(_, span, _)| 0.1 + span).sum();
        let mut text = format!("law = \"program\"\nbase = {:?}\n", around(base, 1.0));
        let mut lift = 0.0;
        let count = segments.len();
        for (index, (motion, span, rise)) in segments.into_iter().enumerate() {
            let rise = if index + 1 == count { -lift } else { around(rise, 0.2) };
            let (span, rise) = (360.0 * (0.1 + span) / whole, if motion == 0 { 0.0 } else { rise });
            lift += rise;
            text +=
                &format!("[[cam.segment]]\nmotion = \"{}\"\nspan_deg = {span:?}\nrise = {rise:?}\n", MOTIONS[motion]);
        }
        (text, None)
    })
}

/// Pieces through random lifts, with slopes that meet or do not.
fn polynomial(knots: Range<usize>) -> impl Strategy<Value = Law> {
    (unit(), any::<bool>(), prop::collection::vec((unit(), unit(), unit(), unit()), knots)).prop_map(
        |(first, smooth, knots)| {
            let count = knots.len();
            let width = TAU / count as f64;
            let first = 0.15 * first * width;
            let start =
                |index: usize| first + (index as f64 + 0.8 * if index == 0 { 0.0 } else { knots[index].0 }) * width;
            let mut text = "law = \"polynomial\"\n".to_owned();
            for index in 0..count {
                let next = (index + 1) % count;
                let end = if next == 0 { start(0) + TAU } else { start(next) };
                // In degrees and back, as the model's reader does.
                let degrees = start(index).to_degrees();
                let (h, (y0, y1)) = (end - degrees.to_radians(), (0.3 * knots[index].1, 0.3 * knots[next].1));
                let coefficients = if smooth {
                    let (s0, s1) = (around(knots[index].2, 0.3), around(knots[next].2, 0.3));
                    let d = (y1 - y0) / h;
                    vec![y0, s0, (3.0 * d - 2.0 * s0 - s1) / h, (s0 + s1 - 2.0 * d) / (h * h)]
                } else {
                    let (a2, a3) = (around(knots[index].2, 0.3), around(knots[index].3, 0.1));
                    vec![y0, (y1 - y0) / h - h * (a2 + h * a3), a2, a3]
                };
                text += &format!("[[cam.segment]]\nstart_deg = {degrees:?}\ncoefficients = {coefficients:?}\n");
            }
            (text, None)
        },
    )
}

fn table(rows: Range<usize>) -> impl Strategy<Value = Law> {
    let rows = prop::collection::vec((unit(), unit()), rows);
    (rows, any::<bool>(), unit(), unit()).prop_map(|(rows, quintic, offset, noise)| {
        let count = rows.len() as f64;
        let mut table = "angle_deg,lift\n".to_owned();
        for (index, (shift, lift)) in rows.iter().enumerate() {
            // Of three rows, two are less than half a turn apart: more would be refused.
            let angle = 360.0 * (index as f64 + 0.4 * shift) / count;
            let lift = around(offset, 0.5) + 0.2 * angle.to_radians().cos() + around(*lift, 0.1 * noise);
            table += &format!("{angle:?},{lift:?}\n");
        }
        let spline = if quintic { "quintic" } else { "cubic" };
        (format!("law = \"table\"\nfile = \"table.csv\"\nspline = \"{spline}\"\n"), Some(table))
    })
}

fn law() -> impl Strategy<Value = Law> {
    Union::new([
        arcs().boxed(),
        harmonic().boxed(),
        rectified_sine().boxed(),
        program().boxed(),
        polynomial(2..6).boxed(),
        table(3..40).boxed(),
    ])
}

/// The same laws, many with a lever between cam and follower, and circles under a flat face or a roller as well. These choices follow from
/// the text of the cam: a draw more would move all other draws.
fn law_with_followers() -> impl Strategy<Value = Law> {
    law().prop_map(|(text, table)| {
        let mut digest = text.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |digest, byte| {
            (digest ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
        });
        let mut part = || {
            digest = (digest ^ (digest >> 31)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            (digest >> 11) as f64 / 2.0_f64.powi(53)
        };
        let (head, rest) = text.split_once('\n').unwrap();
        let mut added = String::new();
        if part() < 0.4 {
            added += &format!("lever_ratio = {:?}\n", spread(part(), 0.3, 3.0));
        }
        if head.contains("arcs") {
            let base: f64 = rest.lines().find_map(|line| line.strip_prefix("base_radius = ")).unwrap().parse().unwrap();
            let kind = part();
            if kind < 0.3 {
                added += "contact = \"flat\"\n";
            } else if kind < 0.7 {
                let radius = base * spread(part(), 0.01, 1.0);
                // Half of them in line with the axis.
                let offset = if part() < 0.5 { 0.0 } else { around(part(), 0.7 * (base + radius)) };
                added += &format!("contact.roller_radius = {radius:?}\ncontact.offset = {offset:?}\n");
            }
        }
        (format!("{head}\n{added}{rest}"), table)
    })
}

/// Cams of so many segments that a flight passes several at once.
fn law_of_many_segments() -> impl Strategy<Value = Law> {
    Union::new([polynomial(64..90).boxed(), table(64..150).boxed()])
}

/// A folder of this case's own for its table.
fn folder() -> PathBuf {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    let name = format!("properties-{}-{}", std::process::id(), NEXT.fetch_add(1, Ordering::Relaxed));
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name)
}

pub fn model(text: &str, table: Option<&str>) -> Model {
    let Some(table) = table else { return Model::parse("random.toml", text).unwrap() };
    let folder = folder();
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("table.csv"), table).unwrap();
    let model = Model::parse(folder.join("random.toml").to_str().unwrap(), text).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    model
}

fn cases(law: impl Strategy<Value = Law>) -> impl Strategy<Value = Case> {
    cases_with(follower(), law)
}

fn cases_with(follower: impl Strategy<Value = String>, law: impl Strategy<Value = Law>) -> impl Strategy<Value = Case> {
    let rest = unit();
    let speed = (0..5, unit());
    let angle = (0..4, unit());
    let start = (0..6, unit(), unit());
    (follower, law, rest, speed, angle, start).prop_map(|(follower, (law, table), rest, speed, angle, start)| {
        let text = |rest: f64| format!("[follower]\nrest_position = {rest:?}\n{follower}\n[cam]\n{law}");
        // Where the cam is, from a model of the same cam.
        let cam = Cam::new(&model(&text(0.0), table.as_deref())).unwrap();
        let low = cam.segments().iter().fold(f64::INFINITY, |low, segment| low.min(segment.bounds.lift[0]));
        let stroke = (cam.top() - low).max(1e-3);
        let text = text(low + around(rest, 2.0) * stroke);
        let model = model(&text, table.as_deref());
        let mut case = Case {
            model: model.clone(),
            machine: Machine::new(Cam::new(&model).unwrap(), &model.follower, 1.0),
            rpm: 0.0,
            angle: 0.0,
            start: Start::OnCam(0.0),
            stroke,
            text,
            table,
        };
        // Where the cam's acceleration is that of the follower, and a factor of 30 to either side.
        let even = (case.sizes().acceleration / stroke).sqrt() * 60.0 / TAU;
        let (kind, unit) = speed;
        case.rpm = if kind == 0 { spread(unit, 1e-3, 1e5) } else { even * spread(unit, 1.0 / 30.0, 30.0) };
        case.rpm = case.rpm.clamp(1e-3, 1e5);
        case.machine = case.machine.at_speed(angular_velocity(case.rpm));
        let segments = case.machine.cam().segments();
        case.angle = match angle {
            (0, _) => 0.0,
            (1, unit) => segments[(unit * segments.len() as f64) as usize].start,
            (_, unit) => unit * TAU,
        };
        let size = case.velocity();
        case.start = match start {
            (0, ..) => Start::OnCam(0.0),
            (1, unit, _) => Start::OnCam(unit * size),
            (2, unit, _) => Start::OnCam(spread(unit, 1e-12, 1.0) * size),
            (3, height, velocity) => Start::Above(spread(height, 1e-12, 1.0) * stroke, around(velocity, size)),
            (_, height, velocity) => Start::Above(3.0 * height * stroke, around(velocity, 2.0 * size)),
        };
        case
    })
}

/// Cams whose lift a page of formulas gives, for a reference that shares none.
pub fn cases_of_few_laws() -> impl Strategy<Value = Case> {
    cases(Union::new([arcs().boxed(), harmonic().boxed(), rectified_sine().boxed(), polynomial(2..6).boxed()]))
}

/// Machines of every law, for what is asked of their models.
pub fn cases_of_every_law() -> impl Strategy<Value = Case> {
    cases(law())
}

/// Machines of every law and every regime, one in five with a cam that stands still.
pub fn cases_of_every_regime() -> impl Strategy<Value = Case> {
    cases_with(follower_of_every_regime(), prop_oneof![4 => law_with_followers(), 1 => still()])
}

/// Machines of every regime whose cam stands still.
pub fn cases_that_stand_still() -> impl Strategy<Value = Case> {
    cases_with(follower_of_every_regime(), still())
}

/// Machines whose flights pass many segments at once.
pub fn cases_of_many_segments() -> impl Strategy<Value = Case> {
    cases(law_of_many_segments())
}

/// So many of them, the same in every run, whatever the environment says.
pub fn drawn<Each: fmt::Debug>(each: impl Strategy<Value = Each>, count: usize) -> Vec<Each> {
    let mut runner = TestRunner::new(Config { rng_seed: RngSeed::Fixed(1), ..Config::default() });
    (0..count).map(|_| each.new_tree(&mut runner).unwrap().current()).collect()
}

/// Asks `holds` of `count` cases, or as many as the environment says.
#[track_caller]
pub fn check(count: u32, holds: fn(&Case) -> TestCaseResult) {
    check_all(cases(law_with_followers()), count, holds);
}

/// The same over cams of many segments.
#[track_caller]
pub fn check_many_segments(count: u32, holds: fn(&Case) -> TestCaseResult) {
    check_all(cases_of_many_segments(), count, holds);
}

/// The same over anything.
#[track_caller]
pub fn check_all<Each: fmt::Debug + Send + 'static>(
    each: impl Strategy<Value = Each>,
    count: u32,
    holds: fn(&Each) -> TestCaseResult,
) {
    let is_set = |name: &str| std::env::var_os(name).is_some();
    let config = Config::default();
    let config = Config {
        cases: if is_set("PROPTEST_CASES") { config.cases } else { count },
        rng_seed: if is_set("PROPTEST_RNG_SEED") { config.rng_seed } else { RngSeed::Fixed(1) },
        failure_persistence: None,
        max_shrink_time: 60_000,
        ..config
    };
    let in_time =
        move |case: Each| common::ends(move || holds(&case)).unwrap_or_else(|why| Err(TestCaseError::fail(why)));
    if let Err(error) = TestRunner::new(config).run(&each, in_time) {
        panic!("{error}");
    }
}
