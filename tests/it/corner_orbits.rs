//! Is a flight from a corner back to it told to be what it is: an orbit that hits the corner, one that touches it, or none?
//!
//! On cams whose numbers are chosen for an orbit that is known in closed form: of parabolas that fall off after the corner, so that
//! flights are free of them, and cubics that lead up to it again.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::fmt::Write;

use approx::assert_relative_eq;
use corner_impact::border_collision::feigin::Speeds;
use corner_impact::cam::apart;
use corner_impact::corner::range::{FoundCornerImpacts, find_corner_impacts};
use corner_impact::corner::{CornerImpact, Way, locate};
use corner_impact::model::{Model, Study};
use corner_impact::orbit::{Course, PeriodicOrbit, Search, eigenvalues, search};
use corner_impact::progress::Unwatched;
use corner_impact::section::StroboscopicMap;
use corner_impact::simulate::{Machine, Unobserved, angular_velocity};
use corner_impact::study::verify::{External, verify};
use corner_impact::tolerance;

use crate::common;

/// A lift and its slope, m and m/rad.
type Place = [f64; 2];

/// A piece of a cam from an angle on, rad: its coefficients.
type Piece = (f64, Vec<f64>);

/// A parabola from a place on, and where it is after an angle.
fn parabola([lift, slope]: Place, curvature: f64, angle: f64) -> (Vec<f64>, Place) {
    let end = [lift + slope * angle + 0.5 * curvature * angle * angle, slope + curvature * angle];
    (vec![lift, slope, 0.5 * curvature], end)
}

/// The cubic from one place to another.
fn cubic([from, leaving]: Place, [to, arriving]: Place, angle: f64) -> Vec<f64> {
    let mean = (to - from) / angle;
    vec![
        from,
        leaving,
        (3.0 * mean - 2.0 * leaving - arriving) / angle,
        (leaving + arriving - 2.0 * mean) / (angle * angle),
    ]
}

/// A cam that bends down at its corner at 90 degrees, which it comes up to with a slope of its own.
fn bump(corner: Place, curvature: f64, slope_before: f64) -> Vec<Piece> {
    /// How far the parabola goes, rad.
    const CAP: f64 = 0.6;
    let (cap, end) = parabola(corner, curvature, CAP);
    vec![(FRAC_PI_2, cap), (FRAC_PI_2 + CAP, cubic(end, [corner[0], slope_before], TAU - CAP))]
}

/// A follower off the cam, by half its damping and its frequency, 1/s, beside a weight: it goes to `equilibrium`, m.
struct Follower {
    zeta: f64,
    omega: f64,
    equilibrium: f64,
    restitution: f64,
}

impl Follower {
    /// After a time: velocity to position, a unit of force to position, and velocity to velocity.
    fn responses(&self, time: f64) -> [f64; 3] {
        let (decay, (sin, cos)) = ((-self.zeta * time).exp(), (self.omega * time).sin_cos());
        let ratio = self.zeta / self.omega;
        let step = (1.0 - decay * (cos + ratio * sin)) / self.stiffness();
        [decay * sin / self.omega, step, decay * (cos - ratio * sin)]
    }

    fn stiffness(&self) -> f64 {
        self.zeta.powi(2) + self.omega.powi(2)
    }

    fn on(&self, cam: &[Piece]) -> Model {
        model([2.0 * self.zeta, self.stiffness(), 0.0, self.equilibrium, self.restitution], cam)
    }
}

/// A unit of mass on a cam of polynomials.
fn model([damping, stiffness, gravity, rest_position, restitution]: [f64; 5], cam: &[Piece]) -> Model {
    let mut text = format!(
        "[follower]\nmass = 1.0\ndamping = {damping:?}\nstiffness = {stiffness:?}\ngravity = {gravity:?}\n\
         rest_position = {rest_position:?}\nrestitution = {restitution:?}\n[cam]\nlaw = \"polynomial\"\n"
    );
    for (start, coefficients) in cam {
        writeln!(text, "[[cam.segment]]\nstart_deg = {:?}\ncoefficients = {coefficients:?}", start.to_degrees())
            .unwrap();
    }
    text.push_str("[study]\nrpm_min = 59.9\nrpm_max = 60.1\n");
    Model::parse("pieces.toml", &text).unwrap()
}

/// The orbit of one impact near 60 rpm that has it on the corner at 90 degrees; or why there is none.
fn one_impact(model: &Model) -> Result<CornerImpact, String> {
    let located = locate(model, &common::cam(model));
    located.map(|(at, _)| at).map_err(|error| {
        let text = error.to_string();
        let (_, why) = text.split_once(" rpm at 90.0000 deg: ").expect(&text);
        why.lines().next().unwrap().to_owned()
    })
}

/// What is found and refused of one revolution near a speed, rpm.
fn near(model: &Model, rpm: f64) -> FoundCornerImpacts {
    let range = Study { rpm_min: 0.999 * rpm, rpm_max: 1.001 * rpm };
    find_corner_impacts(model, &common::cam(model), range, 1, &Unwatched).unwrap()
}

/// Why what is found at the corner at 90 degrees is no orbit that hits it.
fn refused(found: &FoundCornerImpacts) -> String {
    let there: Vec<_> = found.rejected.iter().filter(|it| (it.cam_angle - FRAC_PI_2).abs() < 1e-9).collect();
    let [it] = there[..] else { panic!("{:?}", found.rejected) };
    assert!(found.found.is_empty(), "{:?}", found.found);
    it.why.clone()
}

/// The damper leaves nothing of the impact but a ten-millionth, and the next one hits a follower that all but rests: no resonance, where
/// an impact changes nothing later.
#[test]
fn a_follower_that_has_all_but_come_to_rest_is_hit_at_the_corner() {
    let mut follower = Follower { zeta: 15.0, omega: 2.5, equilibrium: 1.0, restitution: 0.8 };
    let [impulse, step, rate] = follower.responses(1.0);
    let (slope, r) = (0.3, follower.restitution);
    let cam_velocity = TAU * slope;
    let leaving = (1.0 + r) * cam_velocity / (1.0 + r * rate - r * impulse * impulse / step);
    follower.equilibrium -= leaving * impulse / step / follower.stiffness();
    let at = one_impact(&follower.on(&bump([1.0, slope], -1.0, slope))).unwrap();
    assert_relative_eq!(at.speed_rpm(), 60.0, max_relative = 1e-9);
    assert_relative_eq!(at.velocity_after, leaving, max_relative = 1e-9);
    assert_relative_eq!(at.velocity_before, leaving * (rate - impulse * impulse / step), max_relative = 1e-6);
}

/// A flight that swings once and loses next to nothing comes back with next to the velocity that it left with, which is the cam's. By how
/// much less tells what it loses: with E the energy
///
/// ```text
/// E+ - E- = (v+ - v-) c' = (1 + r) (c' - v-) c' = b A^2 T/2       A^2: the square of the velocity's amplitude
/// ```
///
/// Less than a millionth of both velocities is no impact.
#[test]
fn what_meets_the_corner_with_next_to_the_cam_s_velocity_does_not_hit_it() {
    let (slope, lifted) = (0.3, 1.0);
    let closing = |zeta: f64| {
        let amplitude = TAU.powi(2) * (lifted * lifted + slope * slope);
        zeta * amplitude / (1.8 * TAU * slope) / (2.0 * TAU * slope)
    };
    let machine = |zeta: f64, before: f64| {
        let follower = Follower { zeta, omega: TAU, equilibrium: 1.0 + lifted, restitution: 0.8 };
        follower.on(&bump([1.0, slope], -1.0, before))
    };
    for part in 1..=16 {
        let zeta = 2.8e-7 * f64::from(part) / 16.0;
        assert!(closing(zeta) < tolerance::GRAZE_FOUND.value);
        let machine = machine(zeta, slope);
        let why = locate(&machine, &common::cam(&machine)).map(|(at, _)| at.speed_rpm()).unwrap_err().to_string();
        assert!(why.contains(": grazing impact at ") && why.contains(" touches the corner at 90.0"), "{zeta}: {why}");
    }
    let at = one_impact(&machine(1e-5, slope)).unwrap();
    let relative = (at.cam_velocity - at.velocity_before) / (at.cam_velocity + at.velocity_before);
    assert!(relative > tolerance::GRAZE_FOUND.value);
    assert_relative_eq!(relative, closing(1e-5), max_relative = 1e-3);
    // Where the velocity jumps it is told to be a graze before anything else that is wrong with it.
    let why = refused(&near(&machine(1e-7, slope + 0.1), 60.0));
    assert!(why.starts_with("a graze at 90.0000 deg, v = c' = "), "{why}");
}

/// A follower that swings twice is as high as the corner half a period later, too; what an orbit may be off by at its end is measured by its
/// swing, however little the impact changes.
#[test]
fn an_orbit_that_is_nearly_a_graze_closes() {
    let at = |lift: f64, zeta: f64| {
        let follower = Follower { zeta, omega: 2.0 * TAU, equilibrium: lift + 0.5, restitution: 0.8 };
        one_impact(&follower.on(&bump([lift, 0.3], -1.0, 0.3)))
    };
    for zeta in [2e-6, 1e-4] {
        let closure = at(1.0, zeta).unwrap().closure;
        assert!(closure < tolerance::ORBIT_CLOSURE.value, "{zeta} {closure:e}");
    }
    // A hundred million times its swing away from 0 rounding is too much.
    let why = at(2.0_f64.powi(28), 2e-6).unwrap_err();
    let off = why.strip_prefix("one period ends ").expect(&why);
    let (off, _) = off.split_once(" of the orbit's size from its start").expect(&why);
    assert!(off.parse::<f64>().unwrap() > tolerance::ORBIT_CLOSURE.value, "{why}");
}

/// The cam comes up to where the follower rests without any force, and falls off again: once a revolution it is touched by a cam that has
/// a velocity up to there, and none from there on.
#[test]
fn a_follower_at_rest_touches_the_top_that_just_reaches_it() {
    let follower = Follower { zeta: 0.0, omega: TAU, equilibrium: 1.0, restitution: 0.8 };
    let why = refused(&near(&follower.on(&bump([1.0, 0.0], -0.4, 0.2)), 59.0));
    assert!(why.contains("the corner is touched, not hit"), "{why}");
}

/// It comes with the velocity with which the cam goes: what it leaves with fixes the damper's work, and that the restitution.
///
/// ```text
/// v- = -c',   v+ = (1 + 2 r) c',   v-/v+ = s' - s^2/p
/// ```
#[test]
fn an_impact_at_the_cam_s_own_speed_the_other_way_is_no_graze() {
    let mut follower = Follower { zeta: 0.4, omega: 4.0, equilibrium: 1.0, restitution: 0.0 };
    let [impulse, step, rate] = follower.responses(1.0);
    let ratio = rate - impulse * impulse / step;
    follower.restitution = -0.5 * (1.0 / ratio + 1.0);
    let slope = 0.3;
    let leaving = (1.0 + 2.0 * follower.restitution) * TAU * slope;
    follower.equilibrium -= leaving * impulse / step / follower.stiffness();
    // The side after the corner alone has this slope: an impact there is looked at as one of several would be.
    let found = near(&follower.on(&bump([1.0, slope], -1.0, slope - 0.1)), 60.0);
    let [at] = &found.found[..] else { panic!("{:?}", found.rejected) };
    assert_relative_eq!(at.speed_rpm(), 60.0, max_relative = 1e-9);
    assert_relative_eq!(at.velocity_before, -at.cam_velocity, max_relative = 1e-9);
    assert_relative_eq!(at.velocity_after, leaving, max_relative = 1e-9);
}

/// How far bumps go, rad: the first from its corner on, and the second before and after where it is hit.
const LONG: [f64; 3] = [1.6, 0.2, 1.2];
const SHORT: [f64; 3] = [0.7, 0.2, 0.6];

/// Two bumps of a curvature, m/rad^2: the first from its corner on, at `start` rad, the second so that a follower that hardly bounces is
/// thrown from the corner onto it and from there back, each time half a turn, where the cam turns at 1/s; and the slope at the corner.
fn two_bumps(gravity: f64, curvature: f64, [cap, before, after]: [f64; 3], start: f64) -> ([Piece; 4], f64) {
    let first = [0.0, 0.55 * gravity * PI];
    let second = [first[1] * PI - 0.5 * gravity * PI * PI, gravity * PI - first[1]];
    let (corner, from) = parabola(first, curvature, cap);
    let (_, to) = parabola(second, curvature, -before);
    let (bump, off) = parabola(to, curvature, before + after);
    let cam = [
        (start, corner),
        (start + cap, cubic(from, to, PI - before - cap)),
        (start + PI - before, bump),
        (start + PI + after, cubic(off, first, PI - after)),
    ];
    (cam, first[1])
}

/// Thrown from the corner with the cam's velocity, under a weight alone, the follower falls on a second bump and from there on the corner
/// again: with w = 1/s and half a turn for either flight
///
/// ```text
/// c2 = s1 pi - g pi^2/2,   s2 = g pi - s1
/// ```
///
/// Nothing of either impact is left but what rounding leaves, or nothing at all.
#[test]
fn what_hardly_bounces_hits_a_corner_and_leaves_it_with_the_cam_s_velocity() {
    for (gravity, restitution) in [(0.1, 1e-16), (0.17, 1e-16), (0.23, 1e-16), (0.29, 1e-16), (0.1, 0.0), (0.29, 0.0)] {
        let (cam, slope) = two_bumps(gravity, -0.3, LONG, FRAC_PI_2);
        let found = near(&model([0.0, 0.0, gravity, 0.0, restitution], &cam), 60.0 / TAU);
        let [at] = &found.found[..] else { panic!("{gravity}: {:?} {:?}", found.found, found.rejected) };
        assert_relative_eq!(at.speed_rpm(), 60.0 / TAU, max_relative = 1e-9);
        assert_eq!((at.corner.jump_order, at.cycle.impacts.len()), (2, 2));
        assert_relative_eq!(at.velocity_after, slope, max_relative = 1e-9);
        assert_relative_eq!(at.velocity_before, -slope, max_relative = 1e-9);
    }
}

/// What is found between two speeds of a follower under a weight alone on two bumps: speed, impacts, and how.
fn between(
    restitution: f64,
    [low, high]: [f64; 2],
    (curvature, lengths, start): (f64, [f64; 3], f64),
) -> Vec<(f64, CornerImpact)> {
    let (cam, _) = two_bumps(0.2, curvature, lengths, start);
    let model = model([0.0, 0.0, 0.2, 0.0, restitution], &cam);
    let range = Study { rpm_min: low, rpm_max: high };
    let found = find_corner_impacts(&model, &common::cam(&model), range, 1, &Unwatched).unwrap();
    assert!(found.rejected.is_empty(), "{:?}", found.rejected);
    found.found.into_iter().map(|at| (at.speed_rpm(), at)).collect()
}

/// At angle 0 an impact may be named by either revolution.
#[test]
fn a_corner_at_angle_0_has_the_corner_impacts_of_any_other() {
    let [here, turned] = [FRAC_PI_2, 0.0].map(|start| between(0.1, [9.035, 9.05], (-0.3, LONG, start)));
    assert!(!here.is_empty() && here.len() == turned.len());
    for ((rpm, at), (turned_rpm, turned)) in here.iter().zip(&turned) {
        assert_relative_eq!(rpm, turned_rpm, max_relative = 1e-9);
        assert_eq!((&at.ways, at.cycle.impacts.len()), (&turned.ways, turned.cycle.impacts.len()));
        assert!(at.ways.contains(&Way::Branch) && at.ways.contains(&Way::Shot), "{:?}", at.ways);
    }
}

/// A follower that hardly bounces comes to the corner with impacts that are nearer and nearer to it: those that have one within four times
/// the least reach of the estimates, which would reach beyond it, are left out.
#[test]
fn a_corner_impact_has_no_other_impact_next_to_it() {
    for (restitution, range, impacts) in [(0.02, [9.63, 9.64], 3), (0.3, [9.665, 9.672], 6)] {
        let found = between(restitution, range, (-1.0, SHORT, FRAC_PI_2));
        assert!(found.iter().any(|(_, at)| at.cycle.impacts.len() == impacts), "{found:?}");
        for (rpm, at) in &found {
            let corner = at.cycle.impacts[at.impact].cam_angle;
            let others = at.cycle.impacts.iter().enumerate().filter(|(index, _)| *index != at.impact);
            let nearest = others.map(|(_, it)| apart(it.cam_angle, corner)).fold(f64::INFINITY, f64::min);
            assert!(nearest >= 4.0 * tolerance::LEAST_REACH.value, "{rpm}: {nearest}");
        }
    }
}

/// Beyond twelve impacts a revolution no branch is looked at, and a shot ends at its thirteenth.
#[test]
#[ignore = "slow"]
fn of_more_than_twelve_impacts_a_revolution_nothing_is_looked_for() {
    let on_short = (-1.0, SHORT, FRAC_PI_2);
    for (restitution, range) in [(0.6, [8.629, 8.631]), (0.8, [8.647, 8.649])] {
        for (rpm, at) in between(restitution, range, on_short) {
            let count = at.cycle.impacts.len();
            assert!(count <= 13 && (count <= 12 || !at.ways.contains(&Way::Branch)), "{rpm}: {count} {:?}", at.ways);
        }
    }
}

/// A shot leads to speeds that are so near that it is made for any range with them in it.
#[test]
fn a_part_of_a_range_is_looked_through_in_the_same_ways() {
    let on_short = (-1.0, SHORT, FRAC_PI_2);
    let [part, whole] = [9.742, 9.0].map(|low| between(0.05, [low, 9.744], on_short));
    let (Some((rpm, one)), Some((_, other))) = (part.last(), whole.last()) else { panic!("{part:?} {whole:?}") };
    assert_relative_eq!(one.speed_rpm(), other.speed_rpm(), max_relative = 1e-9);
    assert_eq!(one.ways, other.ways, "{rpm}");
}

/// The orbits next to the corner impact are those that Feigin's classification counts, for every model that has one.
#[test]
#[ignore = "slow"]
fn orbits_on_either_side_are_those_of_the_classification() {
    let mut checked = 0;
    for file in common::model_files() {
        let model = common::read(&file);
        let findings = verify(&model, External::LeftOut).unwrap();
        let Ok(kind) = &findings.classification else { continue };
        checked += 1;
        let at = &findings.at;
        let machine = Machine::new(common::cam(&model), &model.follower, at.angular_velocity());
        let [before, after] = [machine.cam().before(at.corner.segment), at.corner.segment];
        // Orbits of one impact a revolution on a segment next to the corner, at a speed next to that of the corner impact.
        let beside = |segment: usize, share: f64| {
            let machine = machine.at_speed(angular_velocity(at.speed_rpm() * (1.0 + share)));
            let found = search(&machine, &Search { revolutions: 1, impacts: Some(1) }).unwrap();
            let stable = |orbit: &PeriodicOrbit| {
                let impact = orbit.impacts().next()?;
                let from_corner = (impact.cam_angle - at.corner.angle + PI).rem_euclid(TAU) - PI;
                // Another orbit on the same segment, far from the corner, is none of the local map's.
                let is_beside = impact.segment == segment && from_corner.abs() < 0.05;
                (is_beside && matches!(orbit.course, Course::Impacts(_))).then(|| orbit.is_stable())
            };
            found.iter().filter_map(stable).collect::<Vec<_>>()
        };
        for (segment, side, matrix) in
            [(before, &kind.minus, findings.map.minus.a), (after, &kind.plus, findings.map.plus.a)]
        {
            const NEXT: f64 = 7e-6;
            let expected = |there: bool| if there { vec![side.stable] } else { vec![] };
            let (on_faster, on_slower) = match side.exists_for {
                Speeds::Faster => (true, false),
                Speeds::Slower => (false, true),
            };
            assert_eq!(beside(segment, NEXT), expected(on_faster), "{} {segment} faster", file.display());
            assert_eq!(beside(segment, -NEXT), expected(on_slower), "{} {segment} slower", file.display());
            // At the corner impact the multipliers are the eigenvalues of that side's matrix.
            let mut cycle = at.cycle.clone();
            let impact = &mut cycle.impacts[at.impact];
            impact.segment = segment;
            // A segment that ends at 2 pi has the corner at its end.
            if segment > at.corner.segment {
                impact.cam_angle = machine.cam().segments()[segment].end;
            }
            let orbit = PeriodicOrbit::of_cycle(&machine, cycle, at.residual);
            for (one, other) in orbit.multipliers().iter().zip(eigenvalues(&matrix)) {
                assert!((one.re - other.re).hypot(one.im - other.im) < 1e-6, "{}: {one:?} {other:?}", file.display());
            }
        }
    }
    assert!(checked >= 8, "{checked}");
}

/// Orbits faster than the corner impact, and their multipliers, against the simulator, which knows neither.
#[test]
#[ignore = "slow"]
fn orbits_beyond_the_corner_impact_are_those_of_the_simulator() {
    let model = common::osorio();
    let at = verify(&model, External::LeftOut).unwrap().at;
    let at_rest = Machine::new(common::cam(&model), &model.follower, 1.0);
    let orbits = |share: f64| {
        let machine = at_rest.at_speed(angular_velocity(at.speed_rpm() * (1.0 + share)));
        let found = search(&machine, &Search { revolutions: 1, impacts: Some(1) }).unwrap();
        (machine, found)
    };
    for share in [1e-5, 1e-4, 1e-3, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06] {
        let (machine, found) = orbits(share);
        assert_eq!(found.len(), 2, "{share}");
        for orbit in &found {
            let Course::Impacts(cycle) = &orbit.course else { panic!("{share}: {orbit:?}") };
            let impact = orbit.impacts().next().unwrap();
            let leaving =
                impact.velocity_after - machine.angular_velocity() * machine.cam().lift(impact.cam_angle).slope;
            let mut motion = machine.start_on_cam(impact.cam_angle, leaving).unwrap();
            let goal = motion.next(0.0);
            let _ = machine.advance(&mut motion, goal, &mut Unobserved).unwrap();
            // The flight of the cycle after the rest of the revolution.
            let (from, period) = cycle.flight(&machine, 0);
            let rest = (TAU - impact.cam_angle.rem_euclid(TAU)) / TAU * period;
            let position = from.position + machine.flight().fly(from, rest).0;
            assert!((position - motion.state.position).abs() < 1e-8, "{position} {:?}", motion.state);
            let map = StroboscopicMap { machine: machine.clone(), cam_angle: 0.0 };
            let (state, matrix) = map.carry(motion.state, 1).unwrap();
            assert!((state.position - motion.state.position).abs() < 1e-8);
            for (one, other) in orbit.multipliers().iter().zip(eigenvalues(&matrix)) {
                assert!((one.re - other.re).hypot(one.im - other.im) < 1e-6, "{share}: {one:?} {other:?}");
            }
        }
    }
    // Slower there is no such orbit.
    for share in [-1e-5, -1e-3, -0.02, -0.06] {
        assert!(orbits(share).1.is_empty(), "{share}");
    }
}
