//! A settled motion's next impact is looked for one turn on, and nowhere else if certificates hold (`simulate::again`). Are
//! they needed; and does the motion, whose impacts are summed from a lift known nearby, stay on the cam?
//!
//! A flight that leaves the cam at the height where the spring is slack, and swings whole halves in a turn, is back at that
//! height one turn later at any velocity. So a motion hits the cam again and again in one place, as a settled one does, while
//! its velocity still changes, until the flight meets another part of the cam first.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use std::ops::ControlFlow;

use crate::common;
use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::flight::{Flight, State};
use corner_impact::model::Model;
use corner_impact::simulate::{Event, EventKind, Machine, Motion, Observer, Work, angular_velocity};

/// omega, rad/s: a turn takes 2 pi seconds.
const OMEGA: f64 = 1.0;

/// A follower of mass 1 with `omega_d` and `zeta`, 1/s, over the cam of some `[cam]` table.
fn machine(omega_d: f64, zeta: f64, rest_position: f64, restitution: f64, cam: &str) -> Machine {
    let (stiffness, damping) = (omega_d * omega_d + zeta * zeta, 2.0 * zeta);
    let text = format!(
        "[follower]\nmass = 1.0\ndamping = {damping:?}\nstiffness = {stiffness:?}\ngravity = 0.0\n\
         rest_position = {rest_position:?}\nrestitution = {restitution:?}\n[cam]\n{cam}\n"
    );
    let model = Model::parse("settled.toml", &text).unwrap();
    Machine::new(common::cam(&model), &model.follower, OMEGA)
}

/// The next `count` impacts.
fn impacts(machine: &Machine, mut motion: Motion, count: usize) -> Vec<Event> {
    let mut found = Vec::new();
    let goal = motion.after(1000);
    let flow = machine.advance(&mut motion, goal, &mut |event: &Event| {
        found.extend((event.kind == EventKind::Impact).then_some(*event));
        if found.len() == count { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(flow.unwrap().is_break(), "{found:?}");
    found
}

/// `settled` impacts at `angle`, one each turn, and one that comes earlier, somewhere else; each of them is also the next for
/// a run that starts from the one before and knows of no other.
#[track_caller]
fn leaves_its_place_after(settled: usize, machine: &Machine, angle: f64, relative_velocity: f64) -> Event {
    let found = impacts(machine, machine.start_on_cam(angle, relative_velocity).unwrap(), settled + 1);
    for (turn, impact) in found[..settled].iter().enumerate() {
        assert_abs_diff_eq!(impact.cam_angle, angle, epsilon = 1e-6);
        assert_eq!(impact.revolution, turn as u64 + 1);
    }
    for two in found.windows(2) {
        let state = State { position: two[0].position, velocity: two[0].velocity_after };
        let fresh = impacts(machine, machine.start(two[0].cam_angle, state).unwrap(), 1)[0];
        assert_eq!(fresh.revolution, two[1].revolution - two[0].revolution, "{two:?}");
        assert_abs_diff_eq!(fresh.cam_angle, two[1].cam_angle, epsilon = 1e-12);
        assert_relative_eq!(fresh.velocity_before, two[1].velocity_before, max_relative = 1e-12);
    }
    let last = found[settled];
    assert!(last.turned_since(angle) < settled as f64 * TAU + TAU - 0.05, "{last:?}");
    last
}

/// Lobes a cos(n theta - pi) around the cam, and a flight of one half swing that is damped to 3/10: it comes down between
/// two lobes, the slower the less, in the end onto the one before.
const LOBES: usize = 24;
const AMPLITUDE: f64 = 0.01;
const LEFT: f64 = 0.3;
/// How far before the top of its lobe the impacts are, rad of the lobe's own phase.
const BEFORE_TOP: f64 = 2.7;

#[track_caller]
fn hits_the_lobe_before(cam: &str) {
    let (n, steep) = (LOBES as f64, AMPLITUDE * LOBES as f64);
    // A hair less than half a swing a turn: with one turning point, as rounding sees it too.
    let machine = machine(0.5 - 1e-10, -LEFT.ln() / TAU, AMPLITUDE * (2.0 + BEFORE_TOP.cos()), 0.9, cam);
    // Of the thirteenth lobe, half a turn on.
    let angle = PI + (PI - BEFORE_TOP) / n;
    let lift = machine.cam().lift(angle);
    assert_relative_eq!(lift.slope, steep * BEFORE_TOP.sin(), max_relative = 1e-10);
    // Down with 8 a n, then with 2.4, 0.9 and 0.5 a n; below some 0.53 the lobe before is in the way.
    let last = leaves_its_place_after(3, &machine, angle, 8.0 * steep / LEFT - lift.slope);
    let phase = (angle - last.cam_angle) * n;
    assert!((TAU - BEFORE_TOP - 1.0..TAU - BEFORE_TOP + 0.5).contains(&phase), "{phase} before: {last:?}");
}

/// One segment: what forbids to look one turn on only is that the gap does not shrink all the way down.
#[test]
fn a_lobe_of_the_same_segment_is_not_passed_through() {
    let mut amplitudes = vec!["0.0"; LOBES - 1];
    let amplitude = format!("{AMPLITUDE:?}");
    amplitudes.push(&amplitude);
    let phases = vec!["180.0"; LOBES].join(", ");
    let (offset, amplitudes) = (2.0 * AMPLITUDE, amplitudes.join(", "));
    let cam = format!("law = \"harmonic\"\noffset = {offset:?}\namplitudes = [{amplitudes}]\nphases_deg = [{phases}]");
    hits_the_lobe_before(&cam);
}

/// The same lobes, each of a rise and a return: on the rise the gap only shrinks, but the flight comes from before it.
#[test]
fn a_lobe_of_the_segment_before_is_not_passed_through() {
    let mut cam = format!("law = \"program\"\nbase = {AMPLITUDE:?}\n");
    for segment in 0..2 * LOBES {
        let (span, rise) = (180.0 / LOBES as f64, if segment % 2 == 0 { 2.0 } else { -2.0 } * AMPLITUDE);
        writeln!(cam, "[[cam.segment]]\nmotion = \"harmonic\"\nspan_deg = {span:?}\nrise = {rise:?}").unwrap();
    }
    hits_the_lobe_before(&cam);
}

/// Three half swings a turn, undamped: the second is below the height of the impacts, over the base, and grows.
#[test]
fn a_flight_of_two_peaks_is_not_taken_for_one() {
    let cam = "law = \"program\"\nbase = 1.0\n\
        [[cam.segment]]\nmotion = \"harmonic\"\nspan_deg = 90.0\nrise = 1.0\n\
        [[cam.segment]]\nmotion = \"harmonic\"\nspan_deg = 60.0\nrise = -1.0\n\
        [[cam.segment]]\nmotion = \"dwell\"\nspan_deg = 210.0\nrise = 0.0";
    let machine = machine(1.5, 0.0, 1.9, 0.5, cam);
    // c = 1 + (1 - cos 2 theta)/2 = 1.9, where c' = 0.6.
    let angle = 0.5 * (-0.8_f64).acos();
    assert_relative_eq!(machine.cam().lift(angle).slope, 0.6, max_relative = 1e-12);
    // Amplitudes 0.5, 0.5 * 0.5 + 0.6 = 0.85, and 1.025: further down than the base, at 0.9.
    let last = leaves_its_place_after(2, &machine, angle, 0.5 * 1.5 - 0.6);
    // 1.025 sin(phase - pi) = 0.9 at 1.5 times the angle turned.
    let phase = PI + (0.9_f64 / 1.025).asin();
    assert_abs_diff_eq!(last.turned_since(angle) - 2.0 * TAU, phase / 1.5, epsilon = 1e-9);
    assert_eq!(last.position, 1.0);
}

/// Each turn the impact is a little later, until it is past a corner: there the other law holds, which bends the other way.
#[test]
fn an_impact_past_a_corner_is_on_the_next_segment() {
    let cam = "law = \"program\"\nbase = 1.0\n\
        [[cam.segment]]\nmotion = \"parabolic\"\nspan_deg = 90.0\nrise = 0.1\n\
        [[cam.segment]]\nmotion = \"parabolic\"\nspan_deg = 90.0\nrise = -0.1\n\
        [[cam.segment]]\nmotion = \"dwell\"\nspan_deg = 180.0\nrise = 0.0";
    // A half swing is shorter than a turn by 6e-8: some 4e-7 rad a turn, less what the cam's slope takes off.
    let machine = machine(0.5 * (1.0 - 6e-8), 0.0, 1.05, 0.9, cam);
    let corner =
        machine.cam().corners().iter().map(|corner| corner.angle).find(|angle| (angle - PI / 4.0).abs() < 1e-9);
    let corner = corner.unwrap();
    let found = impacts(&machine, machine.start_on_cam(corner - 1e-6, 2.0).unwrap(), 8);
    let crossing = found.windows(2).position(|two| two[0].cam_angle < corner && two[1].cam_angle > corner).unwrap();
    assert!(crossing >= 1, "two impacts before, for the motion to be settled: {found:?}");
    for (turn, impact) in found.iter().enumerate() {
        assert_eq!(impact.revolution, turn as u64 + 1);
        let lift = machine.cam().lift(impact.cam_angle);
        assert_relative_eq!(impact.cam_velocity, OMEGA * lift.slope, max_relative = 1e-14);
        assert_eq!(impact.segment, machine.cam().segment_at(impact.cam_angle));
    }
}

/// An impact is where the lift of its segment is, with its velocity.
#[track_caller]
fn is_on_its_segment(machine: &Machine, event: &Event) {
    let segment = &machine.cam().segments()[event.segment];
    assert!(segment.start <= event.cam_angle && event.cam_angle <= segment.end, "{event:?}");
    let lift = segment.law.lift(event.cam_angle);
    let cam_velocity = machine.angular_velocity() * lift.slope;
    let steepest = segment.bounds.slope[0].abs().max(segment.bounds.slope[1].abs());
    // An ulp of the sums that the lift and its slope are, and what an ulp of the angle makes of them.
    let rounding = |sum: f64, rate: f64| 4.0 * f64::EPSILON * (sum + rate.abs() * event.cam_angle);
    assert!((event.position - lift.value).abs() <= rounding(machine.cam().top(), lift.slope), "{event:?}, {lift:?}");
    let apart = (event.cam_velocity - cam_velocity).abs() / machine.angular_velocity();
    assert!(apart <= rounding(steepest, lift.curvature), "{event:?}, {cam_velocity}");
}

/// Runs `revolutions` from `turn`, rad, after the corner P, with `state`, and holds every impact against the lift of the
/// segment that it is on; the impacts, by how far after P they are, rad.
fn held(machine: &Machine, corner: f64, turn: f64, state: State, revolutions: u64) -> Vec<f64> {
    let mut motion = machine.start(corner + turn, state).unwrap();
    let goal = motion.after(revolutions);
    let mut found = Vec::new();
    let mut hold = |event: &Event| {
        if event.kind == EventKind::Impact {
            is_on_its_segment(machine, event);
            found.push(event.cam_angle - corner);
        }
        ControlFlow::Continue(())
    };
    let _ = machine.advance(&mut motion, goal, &mut hold).unwrap();
    found
}

/// Next to the corner impact an orbit on the flank is left slowly for one on the nose: over the corner, by steps so small
/// that the lift known on the one side would be taken for that of the other; as it would from a start on the corner.
#[test]
fn a_settled_motion_goes_over_a_corner() {
    let model = common::osorio();
    let machine = Machine::new(common::cam(&model), &model.follower, 1.0);
    let corner = machine.cam().segments()[1].end;
    let (mut crossings, mut on_the_flank) = (0, 0);
    for parts in [1e-10, 1e-9, 1e-8] {
        let machine = machine.at_speed(angular_velocity(673.234445003848821 * (1.0 + parts)));
        for shift in [-1e-6, -1e-7, -1e-8, 0.0, 1e-8, 1e-7, 1e-6] {
            let state = State { position: 0.3 + 5.09700788184262174 + shift, velocity: 0.0 };
            let found = held(&machine, corner, PI, state, 3000);
            let near = |pair: &&[f64]| pair[0] * pair[1] < 0.0 && pair.iter().all(|apart| apart.abs() < 4e-7);
            crossings += found.windows(2).filter(near).count();
            // v+ = v- reversed, on an orbit that time reverses.
            let state = State { position: 0.3 + 0.231255562019001421, velocity: 174.300839020840963 + shift };
            let found = held(&machine, corner, 0.0, state, 100);
            on_the_flank += found.iter().filter(|apart| (-4e-7..0.0).contains(*apart)).count();
        }
    }
    assert!(
        crossings > 0 && on_the_flank > 0,
        "{crossings} go over the corner by small steps, {on_the_flank} close by"
    );
}

/// At other speeds it settles away from corners, to the last digits.
#[test]
fn a_settled_motion_stays_on_the_cam() {
    let model = common::osorio();
    let machine = Machine::new(common::cam(&model), &model.follower, 1.0);
    let corner = machine.cam().segments()[1].end;
    for rpm in [680.0, 700.0, 720.0, 738.0] {
        let machine = machine.at_speed(angular_velocity(rpm));
        let state = State { position: 0.3 + 5.09700788184262174, velocity: 0.0 };
        let found = held(&machine, corner, PI, state, 2000);
        let last = found.last().unwrap();
        assert!(found.iter().rev().take(100).all(|apart| (apart - last).abs() < 1e-12), "{rpm} rpm does not settle");
    }
}

/// How often the shortcut was taken.
#[derive(Default)]
struct Repeats {
    events: Vec<Event>,
    repeats: u64,
    /// s, of flights: up to each event, and so far.
    times: Vec<f64>,
    time: f64,
}

impl Observer for Repeats {
    const COUNTS: bool = true;

    fn event(&mut self, event: &Event) -> ControlFlow<()> {
        self.events.push(*event);
        self.times.push(self.time);
        if self.events.len() == 12 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn work(&mut self, work: Work) {
        self.repeats += work.repeats;
    }

    fn flight(&mut self, _: &Flight, _: State, time: f64) {
        self.time += time;
    }
}

/// Numbers from 0 to 1 that are the same in every run, and go through all places alike.
fn part(index: u32, side: u32) -> f64 {
    (f64::from(index + 1) * f64::from([2_u32, 3, 5, 7, 11, 13, 17][side as usize]).sqrt()).fract()
}

/// A machine whose flights come back to where they left in a turn, or nearly so, at a speed that falls or grows until something is in the
/// way; and a run of it.
fn recurrent(index: u32) -> (Machine, Motion) {
    if index.is_multiple_of(3) { slow(index) } else { over_lobes(index) }
}

/// Over lobes as high as where it leaves, or higher, on one segment or many.
fn over_lobes(index: u32) -> (Machine, Motion) {
    let lobes = [1, 2, 3, 5, 8, 24][index as usize / 15 % 6];
    let height =
        |lobe: usize| AMPLITUDE * if index.is_multiple_of(2) { 2.0 } else { 2.0 * part(index, 6) + lobe as f64 % 2.0 };
    let cam = if part(index, 0) < 0.4 {
        let mut amplitudes = vec![0.0; lobes];
        amplitudes[0] = AMPLITUDE * part(index, 6);
        amplitudes[lobes - 1] += AMPLITUDE;
        let (offset, phases) = (2.0 * AMPLITUDE, vec![180.0; lobes]);
        format!("law = \"harmonic\"\noffset = {offset:?}\namplitudes = {amplitudes:?}\nphases_deg = {phases:?}")
    } else {
        // Steep lobes between others that are not.
        let whole: f64 = (0..lobes).map(|lobe| 1.0 + (lobe % 3) as f64).sum();
        let span = |lobe: usize| 180.0 * (1.0 + (lobe % 3) as f64) / whole;
        program((0..lobes).flat_map(|lobe| [(span(lobe), height(lobe)), (span(lobe), -height(lobe))]))
    };
    let left = if (index / 3).is_multiple_of(3) { 1.0 } else { 0.2 + 0.8 * part(index, 2) };
    let restitution = if index.is_multiple_of(5) { 1.0 } else { part(index, 3) };
    // A little less than half a swing a turn, or a little more, or three.
    let swings = [0.5, 0.5, 0.5, 1.5][index as usize / 4 % 4];
    let speed = AMPLITUDE * 30.0 * part(index, 5).powi(2) * lobes as f64;
    back_in_a_turn(index, &cam, TAU * part(index, 1), swings, left, restitution, |_| speed)
}

/// Slowly up a long rise behind a steep lobe, near the speed that it keeps.
fn slow(index: u32) -> (Machine, Motion) {
    let (rise, lobe) = (2.0 * AMPLITUDE, 3.0 * AMPLITUDE * part(index, 6));
    let span = 50.0 + 100.0 * part(index, 0);
    let cam = program([(60.0, 0.0), (15.0, lobe), (15.0, -lobe), (span, rise), (270.0 - span, -rise)]);
    let angle = (90.0 + span * (0.2 + 0.6 * part(index, 1))).to_radians();
    let (left, restitution) = (0.2 + 0.4 * part(index, 2), 0.6 + 0.4 * part(index, 3));
    // v = (1 + r) c' + r left v
    let kept = (1.0 + restitution) / (1.0 - restitution * left) - 1.0;
    let share = 0.5 + part(index, 5);
    back_in_a_turn(index, &cam, angle, 0.5, left, restitution, |slope| slope * kept * share)
}

fn program(segments: impl IntoIterator<Item = (f64, f64)>) -> String {
    segments.into_iter().fold(format!("law = \"program\"\nbase = {AMPLITUDE:?}\n"), |cam, (span, rise)| {
        let motion = if rise == 0.0 { "dwell" } else { "harmonic" };
        cam + &format!("[[cam.segment]]\nmotion = \"{motion}\"\nspan_deg = {span:?}\nrise = {rise:?}\n")
    })
}

/// With so many swings in a turn, but for some ten-millionths, and what is left of a speed after one. Speeds are a radian's.
fn back_in_a_turn(
    index: u32,
    cam: &str,
    angle: f64,
    swings: f64,
    left: f64,
    restitution: f64,
    relative_velocity: impl Fn(f64) -> f64,
) -> (Machine, Motion) {
    // The cam turns at any speed.
    let omega = [1.0, 0.2, 5.0][index as usize / 12 % 3];
    let swings = omega * swings * (1.0 - 2e-7 * part(index, 4).powi(2) + 1e-10);
    let lift = machine(1.0, 0.0, 0.0, 1.0, cam).cam().lift(angle);
    let machine = machine(swings, -omega * f64::ln(left) / TAU, lift.value, restitution, cam).at_speed(omega);
    let relative_velocity = omega * relative_velocity(lift.slope).max(0.0);
    let launch = State { position: lift.value, velocity: omega * lift.slope + relative_velocity };
    // From within the flight, so that nothing is known of the cam where it comes down, where it is above the cam there.
    let turned = part(index, 2) * PI;
    let state = machine.flight().fly(launch, turned / omega).1;
    let above = machine.start((angle + turned) % TAU, state);
    let start = above.unwrap_or_else(|_| machine.start_on_cam(angle, relative_velocity).unwrap());
    (machine, start)
}

/// Each impact, of whatever kind the way there was found in, is what a run finds that starts from the one before and knows of no other.
#[test]
#[ignore = "slow"]
fn what_is_found_one_turn_on_is_what_is_found_from_nothing() {
    let (mut repeats, mut flights) = (0, 0);
    for index in 0..1500 {
        let (machine, mut motion) = recurrent(index);
        let goal = motion.after(40);
        let mut seen = Repeats::default();
        let _ = machine.advance(&mut motion, goal, &mut seen).unwrap();
        repeats += seen.repeats;
        for (two, times) in seen.events.windows(2).zip(seen.times.windows(2)) {
            // Hops that follow each other at once are known as badly as the small velocities they start with.
            let turned = (two[1].revolution - two[0].revolution) as f64 * TAU + two[1].cam_angle - two[0].cam_angle;
            if two[1].kind != EventKind::Impact || turned < 0.1 {
                continue;
            }
            flights += 1;
            // The lift is summed there, and may be an ulp below what it is here.
            let position = two[0].position.max(machine.cam().lift(two[0].cam_angle).value);
            let state = State { position, velocity: two[0].velocity_after };
            let fresh = impacts(&machine, machine.start(two[0].cam_angle, state).unwrap(), 1)[0];
            assert_eq!(fresh.revolution, two[1].revolution - two[0].revolution, "{index}: {two:?} {fresh:?}");
            let size = fresh.velocity_before.abs() + fresh.cam_velocity.abs();
            assert_abs_diff_eq!(fresh.cam_angle, two[1].cam_angle, epsilon = 1e-12);
            assert_abs_diff_eq!(fresh.velocity_before, two[1].velocity_before, epsilon = 5e-14 * size);
            assert_abs_diff_eq!(machine.angular_velocity() * (times[1] - times[0]), turned, epsilon = 1e-12);
            is_on_its_segment(&machine, &two[1]);
        }
    }
    assert_eq!([flights, repeats], [15020, 2434]);
}

/// A ball that loses nothing hits a table near its highest place, a little sooner each turn, after it has come from elsewhere: the lift that was known
/// there is not near. It is on the cam at each impact.
#[test]
fn a_motion_that_settles_just_after_angle_0_stays_on_the_cam() {
    let model = crate::bounds::ball(1.0, 0.0);
    let machine = Machine::new(common::cam(&model), &model.follower, OMEGA);
    let gravity = model.follower.gravity;
    let (first, sooner, start) = (3e-6, 5e-7, 5.0);
    let lift = machine.cam().lift(first);
    let rebound = 0.5 * gravity * (TAU - sooner) / OMEGA;
    let (comes, time) = (2.0 * OMEGA * lift.slope - rebound, (TAU - start + first) / OMEGA);
    let state =
        State { position: lift.value - comes * time - 0.5 * gravity * time * time, velocity: comes + gravity * time };
    let mut motion = machine.start(start, state).unwrap();
    let mut seen = Repeats::default();
    let goal = motion.after(5);
    let _ = machine.advance(&mut motion, goal, &mut seen).unwrap();
    assert!(seen.repeats > 0);
    let impacts = impacts(&machine, machine.start(start, state).unwrap(), 4);
    for (turn, impact) in impacts.iter().enumerate() {
        assert_abs_diff_eq!(impact.cam_angle, first - turn as f64 * sooner, epsilon = 1e-7);
        assert_abs_diff_eq!(impact.position, machine.cam().lift(impact.cam_angle).value, epsilon = 1e-15);
    }
}
