//! The paper's composition of its Poincaré map, P = P2 ∘ PD ∘ P1, on a neighbour of the corner impact's orbit that is far
//! enough away to be seen: free flight to the time of the corner as if no impact happened, the discontinuity mapping PD, and
//! free flight on.
//!
//! Times run from the passage of the corner; sections are at -T/2 (Π1), 0 (ΠD) and T/2 (Π2). The neighbours come to the cam
//! before and after the corner, somewhat slower than the orbit comes to the corner:
//!
//! ```text
//! x_d^- = x at time 0 of the flight before the impact      x_1 the same flight at -T/2
//! x_d^+ = x at time 0 of the flight after the impact       x_2 the same flight at T/2
//! ```
//!
//! Whichever of x_d^- and x_d^+ lies on the other side of the impact is on no real motion: the flight goes on past the cam,
//! or back in time.

use std::f64::consts::TAU;
use std::iter::successors;

use nalgebra::Vector2;

use crate::cam::{Side, apart};
use crate::corner::CornerImpact;
use crate::draw::{Axis, BREAK, Beside, Colour, Figure, Marker, Panel, Series, Stroke, Word};
use crate::figures::{Entry, Subject, drawn};
use crate::flight::{Flight, State};
use crate::impact::rebound;
use crate::section::StroboscopicMap;
use crate::simulate::Machine;

/// One revolution on either side of the corner, on the neighbour whose impact is before the corner.
pub(crate) const COMPOSITION: Entry = Entry {
    id: "composition",
    place: "Figure 6",
    title: |subject| format!("{}: the map of one revolution, composed of three", subject.model.name),
    draw: |subject, title| {
        drawn(
            figure(title, &subject.composition()?),
            "The orbit x* comes to the corner once in a period T*. A neighbour starts at x₁ on Π₁: P₁ flies it to x_d⁻ on Π_D as \
             if there were no impact, below the cam's surface; P_D puts it to x_d⁺, where the flight after the impact has it at \
             that time; P₂ flies it on to x₂ on Π₂. All curves are the model's own flights.",
        )
    },
};

/// How far from the corner the neighbours' impacts are at most, rad.
const FARTHEST: f64 = 0.27;
/// Of the window of cam that is shown: where in it the impact is.
const IMPACT: f64 = 0.6;
/// How much slower than the orbit's its impact is, of the relative velocity, at an impact as far from the corner as can be.
const SLOWER: f64 = 0.15;
/// Halvings that are tried until the simulator's revolution has one impact.
const HALVINGS: usize = 8;
/// Samples of a curve.
const SAMPLES: u32 = 240;

/// A line of time, s, from the corner, and position, m.
pub type Line = Vec<[f64; 2]>;

/// The orbit, the cam, and a neighbour on each side of the corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Composition {
    /// T*, s.
    pub period: f64,
    /// Half the time that is shown around the corner, s.
    pub window: f64,
    /// The corner impact's orbit from -T to T.
    pub orbit: Line,
    /// The cam from -T to T.
    pub cam: Line,
    /// Around the corner: the law before it, up to it and continued.
    pub before: [Line; 2],
    /// The law after it, from it on and continued back.
    pub after: [Line; 2],
    /// x* on Π1 and Π2, and where the orbit is at the corner, before the impact and after.
    pub states: [State; 3],
    /// A neighbour that comes to the cam before the corner, and one that comes as much after.
    pub neighbours: [Neighbour; 2],
    /// One that comes before the corner, farther away where the cam has the room.
    pub far: Neighbour,
}

/// A neighbour of the orbit.
#[derive(Clone, Debug, PartialEq)]
pub struct Neighbour {
    /// The side of the corner that its impact is on.
    pub side: Side,
    /// When that is, s.
    pub time: f64,
    /// x_1, x_d^-, x_d^+ and x_2.
    pub sections: [State; 4],
    /// Before the impact and after.
    pub impact: [State; 2],
    /// Its flight from Π1 to the impact, and on to ΠD where that comes later.
    pub coming: [Line; 2],
    /// Its flight from the impact to Π2, and back to ΠD where that was before.
    pub going: [Line; 2],
    /// The state on Π2 that the simulator comes to from x_1.
    pub simulated: State,
}

/// The state `time`, s, before `state` on one flight.
fn back(flight: &Flight, state: State, time: f64) -> Option<State> {
    // The flow is affine: fly(x) - fly(y) = Phi (x - y).
    let flown = flight.fly(state, time).1;
    let miss = Vector2::new(state.position - flown.position, state.velocity - flown.velocity);
    let by = flight.propagator(time).try_inverse()? * miss;
    Some(State { position: state.position + by[0], velocity: state.velocity + by[1] })
}

/// The flight from `state` at time `from` to `to`, s, where it may end before it begins.
fn flown(flight: &Flight, state: State, from: f64, to: f64) -> Option<(State, Line)> {
    let start = if to < from { back(flight, state, from - to)? } else { state };
    let (first, span) = (from.min(to), (to - from).abs());
    let at = |step: u32| {
        let time = span * f64::from(step) / f64::from(SAMPLES);
        [first + time, flight.fly(start, time).1.position]
    };
    let end = if to < from { start } else { flight.fly(start, span).1 };
    Some((end, (0..=SAMPLES).map(at).collect()))
}

impl Subject {
    /// The composition, drawn large; or why there is none.
    pub fn composition(&self) -> Result<Composition, String> {
        let at = &self.found()?.at;
        let machine = self.machine(at.speed_rpm());
        let (corner, omega) = (&at.corner, at.angular_velocity());
        let sides = [self.cam.before(corner.segment), corner.segment].map(|index| &self.cam.segments()[index]);
        let widths = sides.map(|segment| segment.end - segment.start);
        // From as far as there is cam, by halves.
        let reaches = |width: f64| successors(Some((FARTHEST / IMPACT).min(0.9 * width)), |reach| Some(0.5 * reach));
        let beside = |side, reach| neighbour(at, &machine, side, reach);
        let both = |reach| Some((reach, [beside(Side::Minus, reach)?, beside(Side::Plus, reach)?]));
        let Some((reach, neighbours)) = reaches(widths[0].min(widths[1])).take(HALVINGS).find_map(both) else {
            return Err("no neighbour of the orbit has its one impact next to the corner".into());
        };
        // Going back in time a damped follower is soon far away.
        let seen = |found: &Neighbour| {
            let off = (found.sections[0].position - at.state.position).abs();
            off < 0.5 * (at.state.position - corner.minus.value).abs()
        };
        let wider = reaches(widths[0]).take_while(|wide| *wide > reach);
        let far = wider.filter_map(|wide| beside(Side::Minus, wide)).find(seen);
        let far = far.unwrap_or_else(|| neighbours[0].clone());
        let window = reach / omega;
        let law = |index: usize, from: f64, to: f64| -> Line {
            // Of the segment before angle 0 the law is that of a turn earlier.
            let segment = sides[index];
            let shift = if index == 0 && corner.segment == 0 { TAU } else { 0.0 };
            let at = |step: u32| from + (to - from) * f64::from(step) / f64::from(SAMPLES);
            let point = |step| [at(step), segment.law.lift(corner.angle + shift + omega * at(step)).value];
            (0..=SAMPLES).map(point).collect()
        };
        let leaving = State { position: corner.minus.value, velocity: at.velocity_after };
        let coming = State { position: corner.minus.value, velocity: at.velocity_before };
        let Some((_, once)) = flown(machine.flight(), leaving, 0.0, at.period) else {
            return Err("the orbit cannot be flown".into());
        };
        let earlier = once.iter().map(|[time, position]| [time - at.period, *position]);
        let turned = |step: u32| -at.period + 2.0 * at.period * f64::from(step) / 1440.0;
        let cam = |time: f64| [time, self.cam.lift((corner.angle + omega * time).rem_euclid(TAU) % TAU).value];
        Ok(Composition {
            period: at.period,
            window,
            orbit: earlier.chain(once.iter().copied()).collect(),
            cam: (0..=1440).map(|step| cam(turned(step))).collect(),
            before: [law(0, -window, 0.0), law(0, 0.0, window)],
            after: [law(1, 0.0, window), law(1, -window, 0.0)],
            states: [at.state, coming, leaving],
            neighbours,
            far,
        })
    }
}

/// The neighbour that comes to the cam next to the corner, if the simulator agrees that this is its one impact.
fn neighbour(at: &CornerImpact, machine: &Machine, side: Side, reach: f64) -> Option<Neighbour> {
    let (corner, omega, flight) = (&at.corner, at.angular_velocity(), machine.flight());
    let turn = if side == Side::Minus { -IMPACT * reach } else { IMPACT * reach };
    let time = turn / omega;
    let lift = machine.cam().lift((corner.angle + turn).rem_euclid(TAU) % TAU);
    let cam_velocity = omega * lift.slope;
    let share = 1.0 - SLOWER * (turn.abs() / FARTHEST);
    let velocity = cam_velocity + share * (at.velocity_before - at.cam_velocity);
    let before = State { position: lift.value, velocity };
    // eq:impactdynamics_2, at time -t_i
    let velocity = rebound(machine.restitution(), before.velocity, cam_velocity);
    let after = State { position: lift.value, velocity };
    let half = 0.5 * at.period;
    // eq:lmap   x_1 to x_2
    let (first, coming) = flown(flight, before, time, -half)?;
    let (last, going) = flown(flight, after, time, half)?;
    // eq:lmapd   x_d^- to x_d^+, by eq:impactdynamics_1: the state before the impact is phi_{-t_i} x_d^-
    let (from, past) = flown(flight, before, time, 0.0)?;
    // eq:impactdynamics_3   x_d^+ = phi_{t_i} of the state after it
    let (to, returned) = flown(flight, after, time, 0.0)?;
    let map = StroboscopicMap { machine: machine.clone(), cam_angle: at.section_angle() };
    let run = map.apply(first).ok()?;
    let alone = run.events.len() == 1 && run.impacts().count() == 1;
    let near = run.impacts().all(|impact| apart(impact.cam_angle, corner.angle + turn) < 0.5 * reach);
    (alone && near).then(|| {
        let unreal = side == Side::Minus;
        Neighbour {
            side,
            time,
            sections: [first, from, to, last],
            impact: [before, after],
            coming: [coming, if unreal { past } else { Line::new() }],
            going: [going, if unreal { Line::new() } else { returned }],
            simulated: run.state,
        }
    })
}

fn figure(title: &str, shown: &Composition) -> Figure {
    let in_periods = |line: &[[f64; 2]]| line.iter().map(|[time, q]| [time / shown.period, *q]).collect::<Vec<_>>();
    let near = &shown.far;
    let [first, minus, plus, last] = near.sections.map(|state| state.position);
    let star = shown.states[0].position;
    let [coming, past] = [0, 1].map(|index| in_periods(&near.coming[index]));
    let going = in_periods(&near.going[0]);
    let top = shown.orbit.iter().map(|[_, q]| *q).fold(first.max(last).max(plus), f64::max);
    let bottom = minus.min(shown.cam.iter().map(|[_, c]| *c).fold(f64::INFINITY, f64::min));
    let height = top - bottom;
    let range = [bottom - 0.1 * height, top + 0.16 * height];
    let sections = [-0.5, 0.0, 0.5].into_iter().flat_map(|time| [[time, range[0]], [time, range[1]], BREAK]);
    let middle = |line: &[[f64; 2]]| line.get(line.len() / 2).copied().unwrap_or(BREAK);
    let words = [
        Word::new([-0.5, top + 0.12 * height], "Π_1", Beside::Right),
        Word::new([0.0, top + 0.12 * height], "Π_D", Beside::Right),
        Word::new([0.5, top + 0.12 * height], "Π_2", Beside::Right),
        Word::new([-0.5, star], "x^*", Beside::Above),
        Word::new([0.5, star], "x^*", Beside::Above),
        Word::new([-0.5, first], "x_1", Beside::Left),
        Word::new([0.5, last], "x_2", Beside::Right),
        Word::new([0.0, minus], "x_d^−", Beside::BelowRight),
        Word::new([0.0, plus], "x_d^+", Beside::AboveRight),
        Word::new(middle(&coming), "P_1", Beside::Left),
        Word::new(middle(&going), "P_2", Beside::Right),
        Word::new([0.0, minus + 0.3 * (plus - minus)], "P_D", Beside::Right),
    ];
    let (red, mapping) = (Colour::Vermilion, [[0.0, minus], [0.0, plus]]);
    let series = vec![
        Series::line("", Colour::Grey, Stroke::Thin, sections),
        Series::area("cam c", Colour::Grey, Stroke::Thin, in_periods(&shown.cam)),
        Series::line("orbit x*", Colour::Blue, Stroke::Solid, in_periods(&shown.orbit)),
        Series::line("neighbour", red, Stroke::Solid, coming.into_iter().chain(going)),
        Series::line("as if no impact", red, Stroke::Dashed, past),
        Series::arrow("discontinuity mapping", Colour::Purple, Stroke::Solid, mapping),
        Series::points("", red, Marker::Disc, [[-0.5, first], mapping[0], mapping[1], [0.5, last]]),
        Series::points("", Colour::Blue, Marker::Disc, [[-0.5, star], [0.5, star]]),
        Series::words(words),
    ];
    let x = Axis::new("time from the passage of the corner, in periods T*", "").over([-1.0, 1.0]);
    Figure::new(title, x, vec![Panel::new(Axis::new("position", "m").over(range), 0.55, series)])
}
