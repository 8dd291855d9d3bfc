//! Orbits with two impacts in one revolution: two equations for the angles of both.
//!
//! Flight 1, not the longer one, goes from the cam at `x` to `y = x + h`, in the time `t1 = h/omega`; flight 2 from there to `x + 2 pi`, in
//! `t2 = T - t1`. Each leaves with the velocity that it needs to arrive, and arrives as the responses say:
//!
//! ```text
//! u1 s1/t1 = A        A = omega (c(y) - c(x))/h - f(x) p1/t1        v(y) = u1 s1' + f(x) s1
//! u2 s2    = B        B = c(x) - c(y) - f(y) p2                     v(x) = u2 s2' + f(y) s2
//! ```
//!
//! The equations are the restitution law at x and at y, times `(s1/t1) s2`. Divided by the short hop in this way, they stay meaningful even
//! where the two impacts meet:
//!
//! ```text
//! A s2        - (1 + r) c'(x) (s1/t1) s2 + r (s1/t1) (B s2' + f(y) s2^2) = 0
//! B (s1/t1)   - (1 + r) c'(y) (s1/t1) s2 + r s2 (A s1' + f(x) s1 s1/t1)  = 0
//! ```

use std::f64::consts::{PI, TAU};

use super::clearance::Hop;
use super::{Solved, Standing, Struck, joined};
use crate::cam::{Lift, Segment};
use crate::flight::Response;
use crate::interval::Interval;
use crate::interval::dual::Dual;
use crate::interval::roots::{BoxValues, Isolated, isolate};
use crate::orbit::cycle::{Cycle, Impact};
use crate::progress::Watch;
use crate::simulate::Machine;

/// Boxes after which everything else is left undecided: some seconds.
const MOST_BOXES: usize = 1 << 18;

/// A run of neighbouring segments of the cam.
struct Run {
    /// Indices of its first and last segment.
    ends: [usize; 2],
    angles: Interval,
    /// Enclosures of its lift and derivatives.
    over: Lift<Interval>,
    /// Both halves of a run of several segments.
    halves: Option<Box<[Run; 2]>>,
}

impl Run {
    fn of(segments: &[Segment], ends: [usize; 2]) -> Self {
        let [first, last] = ends;
        let angles = Interval::new(segments[first].start, segments[last].end);
        if first == last {
            return Self { ends, angles, over: segments[first].over, halves: None };
        }
        let middle = first.midpoint(last);
        let halves = [[first, middle], [middle + 1, last]].map(|ends| Self::of(segments, ends));
        let [one, two] = [&halves[0].over, &halves[1].over];
        let over = Lift {
            value: one.value.hull(two.value),
            slope: one.slope.hull(two.slope),
            curvature: one.curvature.hull(two.curvature),
            third: one.third.hull(two.third),
        };
        Self { ends, angles, over, halves: Some(Box::new(halves)) }
    }

    /// The segment at an angle of the run.
    fn segment_at(&self, angle: f64) -> &Self {
        match self.halves.as_deref() {
            Some([one, _]) if angle < one.angles.high() => one.segment_at(angle),
            Some([_, two]) => two.segment_at(angle),
            None => self,
        }
    }
}

/// Two runs of segments of the cam, one struck after the other.
#[derive(Clone, Copy)]
struct Pair<'a> {
    machine: &'a Machine,
    runs: [&'a Run; 2],
    /// Number of times that the cam passes angle 0 from the first to the second: 0 or 1.
    turns: u64,
}

/// Quantities of the equations, over a box of angles.
struct Flights {
    lifts: [Lift<Interval>; 2],
    forces: [Interval; 2],
    responses: [Response<Interval>; 2],
    /// s1/t1, A and B.
    mean: Dual<2>,
    short: Dual<2>,
    long: Dual<2>,
}

impl<'a> Pair<'a> {
    /// h, rad.
    fn turn(&self, [x, y]: &[Interval; 2]) -> Interval {
        *y + Interval::TURN * self.turns as f64 - *x
    }

    /// Derivatives of the lift from `x` to `y`: the slope throughout, and the curvature if one law applies throughout.
    fn between(&self, [x, y]: &[Interval; 2]) -> [Interval; 2] {
        let segments = self.machine.cam().segments();
        let (first, last) = (self.runs[0].ends[0], self.runs[1].ends[1]);
        // Borders on the way; a cam of one segment has one where it passes angle 0.
        let borders = last + self.turns as usize * segments.len() - first;
        if borders == 0 {
            let lift = segments[first].law.lift_over(x.hull(*y));
            return [lift.slope, lift.curvature];
        }
        let slope = |border: usize| {
            let segment = &segments[(first + border) % segments.len()];
            let from = if border == 0 { x.low() } else { segment.start };
            let to = if border == borders { y.high() } else { segment.end };
            segment.law.lift_over(Interval::new(from, to)).slope
        };
        [(1..=borders).map(slope).fold(slope(0), Interval::hull), Interval::EVERYTHING]
    }

    /// Lift over angles of a run; over the whole run if it has several segments.
    fn lift_over(&self, which: usize, angles: Interval) -> Lift<Interval> {
        let run = self.runs[which];
        if run.halves.is_some() { run.over } else { self.machine.cam().segments()[run.ends[0]].law.lift_over(angles) }
    }

    /// Whether the second run may be struck within half a turn after the first.
    fn follows(&self) -> bool {
        let [first, second] = self.runs;
        let is_behind = if self.turns == 0 { second.ends[1] >= first.ends[0] } else { second.ends[0] <= first.ends[1] };
        let start = second.angles.low() + if self.turns == 1 { TAU } else { 0.0 };
        is_behind && start - first.angles.high() <= PI
    }

    /// Pairs of the other run with each half of the wider run; `None` if both runs are single segments.
    fn halved(&self) -> Option<[Self; 2]> {
        let [first, second] = self.runs;
        let is_first = first.angles.width() >= second.angles.width();
        let of_first = |[one, two]: &'a [Run; 2]| [one, two].map(|half| Self { runs: [half, second], ..*self });
        let of_second = |[one, two]: &'a [Run; 2]| [one, two].map(|half| Self { runs: [first, half], ..*self });
        match (first.halves.as_deref(), second.halves.as_deref()) {
            (Some(halves), other) if is_first || other.is_none() => Some(of_first(halves)),
            (_, Some(halves)) => Some(of_second(halves)),
            (_, None) => None,
        }
    }

    fn flights(&self, place: &[Interval; 2]) -> Flights {
        let (machine, flight) = (self.machine, self.machine.flight());
        let omega = Interval::from(machine.angular_velocity());
        let h = self.turn(place);
        let (t1, t2) = (h / omega, (Interval::TURN - h) / omega);
        let lifts = [0, 1].map(|which| self.lift_over(which, place[which]));
        let forces = lifts.map(|lift| flight.force(lift.value));
        let responses = [flight.response_over(t1), flight.response_over(t2)];
        let [one, two] = &responses;
        // Derivatives of t1 by x and y; those of t2 have the opposite sign.
        let later = Interval::from(1.0) / omega;
        let (by_x, by_y) = ([Interval::from(1.0), Interval::from(0.0)], [Interval::from(0.0), Interval::from(1.0)]);
        let (by_1, by_2) = ([-later, later], [later, -later]);
        // The means of s' and of s over the flight, and half their means weighted by time: as quotients, or by their bounds if the time may
        // be nearly 0.
        let (mean, mean_by, step, step_by, rise, rise_by) = if t1.low() > t1.width() {
            let (mean, step, rise) = (one.impulse / t1, one.step / t1, (lifts[1].value - lifts[0].value) / h);
            let rise_by = [(rise - lifts[0].slope) / h, (lifts[1].slope - rise) / h];
            (mean, (one.impulse_rate - mean) / t1, step, (one.impulse - step) / t1, rise, rise_by)
        } else {
            let since = flight.response_over(t1.hull(0.0.into()));
            let [rise, curvature] = self.between(place);
            (
                since.impulse_rate,
                flight.impulse_bend(&since).half(),
                since.impulse,
                since.impulse_rate.half(),
                rise,
                [curvature.half(); 2],
            )
        };
        let mean = Dual::of(mean, mean_by, by_1);
        let [x, y] = self.lift(&lifts, [by_x, by_y]);
        let spring = flight.omega0_squared();
        let force = |lift: Dual<2>| Dual { value: flight.force(lift.value), by: lift.by.map(|by| -(by * spring)) };
        let rise = Dual { value: rise, by: rise_by };
        let short = rise * omega - force(x) * Dual::of(step, step_by, by_1);
        let long = x - y - force(y) * Dual::of(two.step, two.impulse, by_2);
        Flights { lifts, forces, responses, mean, short, long }
    }

    /// c(x) and c(y).
    fn lift(&self, lifts: &[Lift<Interval>; 2], by: [[Interval; 2]; 2]) -> [Dual<2>; 2] {
        [0, 1].map(|which| Dual::of(lifts[which].value, lifts[which].slope, by[which]))
    }

    /// Evaluates the equations. A root is wanted if it breaks no law of impacts or flights, and y is at most half a turn after x.
    fn over(&self, place: &[Interval; 2]) -> BoxValues<2> {
        let flights = self.flights(place);
        let is_wanted = !flights.velocities(self.machine).is_broken
            && self.turn(place).common(Interval::new(0.0, Interval::TURN.half().high())).is_some();
        let Flights { lifts, forces, responses: [one, two], mean, short, long } = flights;
        let flight = self.machine.flight();
        let omega = Interval::from(self.machine.angular_velocity());
        let r = Interval::from(self.machine.restitution());
        let later = Interval::from(1.0) / omega;
        let (by_1, by_2) = ([-later, later], [later, -later]);
        let none = Interval::from(0.0);
        let (by_x, by_y) = ([Interval::from(1.0), none], [none, Interval::from(1.0)]);
        let force = |which: usize, by: [Interval; 2]| {
            Dual::of(forces[which], -(lifts[which].slope * flight.omega0_squared()), by)
        };
        let slope = |which: usize, by: [Interval; 2]| Dual::of(lifts[which].slope, lifts[which].curvature, by) * omega;
        let (s1, s2) = (Dual::of(one.impulse, one.impulse_rate, by_1), Dual::of(two.impulse, two.impulse_rate, by_2));
        let rates = [(&one, by_1), (&two, by_2)].map(|(of, by)| Dual::of(of.impulse_rate, flight.impulse_bend(of), by));
        let both = mean * s2 * (r + 1.0);
        let at_x = short * s2 - slope(0, by_x) * both + mean * (long * rates[1] + force(1, by_y) * s2 * s2) * r;
        let at_y = long * mean - slope(1, by_y) * both + s2 * (short * rates[0] + force(0, by_x) * s1 * mean) * r;
        BoxValues { values: [at_x.value, at_y.value], derivatives: [at_x.by, at_y.by], is_wanted }
    }

    /// Decides whether a solution is an orbit. A solution across an end of its segment is not proved: a flight passes over the law beyond
    /// that end up to the impact, where the gap is 0.
    fn standing(&self, place: &[Interval; 2]) -> Standing {
        if self.machine.restitution() == 0.0 {
            return Standing::Undecided;
        }
        let flights = self.flights(place);
        let omega = Interval::from(self.machine.angular_velocity());
        let Velocities { after, is_broken, .. } = flights.velocities(self.machine);
        if is_broken {
            return Standing::NoOrbit;
        }
        let struck =
            |which: usize, turns: u64| Struck { segment: self.runs[which].ends[0], angle: place[which], turns };
        let hops = [
            Hop { from: struck(0, 0), to: struck(1, self.turns), velocity: after[0], omega },
            Hop { from: struck(1, 0), to: struck(0, 1 - self.turns), velocity: after[1], omega },
        ];
        let clear = hops.map(|hop| hop.is_clear(self.machine.cam(), self.machine.flight()));
        match clear {
            [Some(false), _] | [_, Some(false)] => Standing::NoOrbit,
            // Both flights are proved clear, and so fall up to their ends: each impact is approached. If s2 may be 0, the equations, which
            // are multiplied by it, may hold although the laws of impact do not.
            [Some(true), Some(true)] if !flights.responses[1].impulse.holds_zero() => Standing::Orbit,
            _ => Standing::Undecided,
        }
    }

    fn guess(&self, place: &[Interval; 2]) -> Cycle {
        let middles = place.map(|side| side.middle().into());
        let before = self.flights(&middles).velocities(self.machine).before.map(Interval::middle);
        let impact = |which: usize| Impact {
            revolution: if which == 0 { 0 } else { self.turns as i64 },
            segment: self.runs[which].ends[0],
            cam_angle: middles[which].middle(),
            velocity_before: before[which],
        };
        Cycle { revolutions: 1, impacts: vec![impact(0), impact(1)] }
    }
}

/// Velocities before and after each impact, m/s.
struct Velocities {
    before: [Interval; 2],
    after: [Interval; 2],
    /// Whether an impact comes out of the cam, leaves into it, or leaves otherwise than the restitution law says.
    is_broken: bool,
}

impl Flights {
    /// Velocities from the responses of the flights. If a flight returns whatever its first velocity is, they follow from the other flight
    /// and the law of impact.
    fn velocities(&self, machine: &Machine) -> Velocities {
        let omega = Interval::from(machine.angular_velocity());
        let r = machine.restitution();
        let cam = [0, 1].map(|which: usize| self.lifts[which].slope * omega);
        // v+ = (1 + r) c' - r v-
        let thrown = |which: usize, before: Interval| cam[which] * (Interval::from(r) + 1.0) - before * r;
        let arrives = |from: usize, after: Interval| {
            let response = &self.responses[from];
            after * response.impulse_rate + self.forces[from] * response.impulse
        };
        let mut after = [self.short.value / self.mean.value, self.long.value / self.responses[1].impulse];
        let mut before = [arrives(1, after[1]), arrives(0, after[0])];
        for which in 0..2 {
            if after[which] == Interval::EVERYTHING {
                after[which] = thrown(which, before[which]);
                before[1 - which] = arrives(which, after[which]);
            }
        }
        let is_broken = (0..2).any(|which| {
            // By the law of impact, a follower that leaves into the cam also comes out of it. Both are checked, since this decides wider
            // boxes.
            (cam[which] - before[which]).is_negative()
                || (after[which] - cam[which]).is_negative()
                || thrown(which, before[which]).common(after[which]).is_none()
        });
        Velocities { before, after, is_broken }
    }
}

/// Pairs of segments that may hold an orbit, and the runs of segments left when the largest number of boxes was reached.
struct Candidates<'a> {
    pairs: Vec<Pair<'a>>,
    left: Vec<Pair<'a>>,
    boxes: usize,
}

/// Looks for pairs of segments that may hold an orbit, by halving: two runs over which the equations have no root are dropped whole.
fn candidates<'a>(machine: &'a Machine, all: &'a Run, watch: &dyn Watch) -> Candidates<'a> {
    let mut found = Candidates { pairs: Vec::new(), left: Vec::new(), boxes: 0 };
    let mut stack = [1, 0].map(|turns| Pair { machine, runs: [all, all], turns }).to_vec();
    while let Some(pair) = stack.pop() {
        if !pair.follows() {
            continue;
        }
        let Some(halves) = pair.halved() else {
            found.pairs.push(pair);
            continue;
        };
        found.boxes += 1;
        watch.at("two impacts: pairs of segments", found.boxes as u64, MOST_BOXES as u64);
        if found.boxes > MOST_BOXES {
            found.left.push(pair);
            continue;
        }
        let BoxValues { values, is_wanted, .. } = pair.over(&pair.runs.map(|run| run.angles));
        if is_wanted && values.iter().all(|value| value.holds_zero()) {
            stack.extend(halves);
        }
    }
    found.pairs.sort_by_key(|pair| (pair.runs[0].ends, pair.turns, pair.runs[1].ends));
    found
}

/// Returns every solution at the speed of a machine, and places that may be solutions.
pub(crate) fn of_two_impacts(machine: &Machine, watch: &dyn Watch) -> Vec<Solved> {
    let segments = machine.cam().segments();
    let whole = Run::of(segments, [0, segments.len() - 1]);
    let Candidates { pairs, left, boxes } = candidates(machine, &whole, watch);
    let mut most = MOST_BOXES.saturating_sub(boxes);
    let mut all: Vec<Solved> = Vec::new();
    let mut add = |pair: &Pair<'_>, place: [Interval; 2], standing: Standing| {
        let (turn, half) = (pair.turn(&place), Interval::TURN.half());
        // With its impacts exchanged, it is a root as well.
        if (turn - half).is_positive() {
            return;
        }
        // Half a turn apart, either impact may be called the first. A known solution with the names exchanged is the same one, since each
        // is alone in a box far wider than its own.
        let again = |known: &Solved| (0..2).all(|which| known.angles[which].common(place[1 - which]).is_some());
        if turn.common(half).is_some() && all.iter().any(again) {
            return;
        }
        let velocities = pair.flights(&place).velocities(machine).before.to_vec();
        all.push(Solved { guess: pair.guess(&place), angles: place.to_vec(), velocities, standing });
    };
    for (index, pair) in pairs.iter().enumerate() {
        watch.at("two impacts: segments of the cam", index as u64, pairs.len() as u64);
        let place = pair.runs.map(|run| run.angles);
        let Isolated { roots, undecided, boxes } = isolate(place, most, |place| pair.over(place));
        most = most.saturating_sub(boxes);
        roots.into_iter().for_each(|place| add(pair, place, pair.standing(&place)));
        joined(undecided).into_iter().for_each(|place| add(pair, place, Standing::Undecided));
    }
    for pair in left {
        let place = pair.runs.map(|run| run.angles);
        let runs = pair.runs.map(|run| run.segment_at(run.angles.middle()));
        add(&Pair { runs, ..pair }, place, Standing::Undecided);
    }
    all
}
