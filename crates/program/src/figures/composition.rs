//! Composition of the paper's Poincaré map, P = P2 ∘ PD ∘ P1, for a visibly distant neighbour of the corner impact's orbit. The three maps
//! are free flight to the time of the corner as if no impact happened, the discontinuity mapping PD, and free flight onwards.
//!
//! Times are measured from the passage of the corner; sections are at -T/2 (Π1), 0 (ΠD) and T/2 (Π2). The neighbours reach the cam
//! before and after the corner, somewhat slower than the orbit reaches the corner:
//!
//! ```text
//! x_d^- = x at time 0 of the flight before the impact      x_1 the same flight at -T/2
//! x_d^+ = x at time 0 of the flight after the impact       x_2 the same flight at T/2
//! ```
//!
//! One of x_d^- and x_d^+ lies on the other side of the impact and is on no real motion: that flight continues beyond the cam,
//! or backwards in time.

use std::f64::consts::TAU;
use std::iter::successors;

use nalgebra::Vector2;

use crate::figures::{Entry, FigureContext, drawn};
use corner_impact::cam::{Side, apart};
use corner_impact::corner::CornerImpact;
use corner_impact::flight::{Flight, State};
use corner_impact::impact::rebound;
use corner_impact::section::StroboscopicMap;
use corner_impact::simulate::Machine;
use corner_impact_plot::{BREAK, Beside, Colour, Figure, FigureAxis, Label, Marker, Panel, Series, Stroke};

/// Figure of the revolution around the corner, for the neighbour with its impact before the corner.
pub(crate) const COMPOSITION: Entry = Entry {
    id: "composition",
    place: "Figure 6",
    takes_rpm: false,
    title: |subject| format!("{}: the map of one revolution, composed of three", subject.model.name),
    draw: |subject, title| {
        drawn(
            figure(title, &subject.composition()?),
            "The orbit x* reaches the corner once in a period T*. A neighbour starts at x₁ on Π₁. P₁ flies it to x_d⁻ on Π_D as \
             if there were no impact, below the cam's surface. P_D maps it to x_d⁺, the state of the flight after the impact at \
             that time. P₂ flies it on to x₂ on Π₂. All curves are the model's own flights.",
        )
    },
};

/// Largest distance of the neighbours' impacts from the corner, rad.
const FARTHEST: f64 = 0.27;
/// Position of the impact in the displayed window of the cam, as a share of it.
const IMPACT: f64 = 0.6;
/// Relative reduction of the neighbour's impact velocity, compared with the orbit's, at the largest distance from the corner.
const SLOWER: f64 = 0.15;
/// Largest number of halvings until the simulated revolution has one impact.
const HALVINGS: usize = 8;
/// Samples of each curve.
const SAMPLES: u32 = 240;

/// Line of points: time from the corner, s, and position, m.
pub type Line = Vec<[f64; 2]>;

/// Orbit, cam, and a neighbour on each side of the corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Composition {
    /// Period T*, s.
    pub period: f64,
    /// Half of the displayed time around the corner, s.
    pub window: f64,
    /// Orbit of the corner impact from -T to T.
    pub orbit: Line,
    /// Lift of the cam from -T to T.
    pub cam: Line,
    /// Cam law before the corner: the part up to the corner, and its continuation.
    pub before: [Line; 2],
    /// Cam law after the corner: the part from the corner on, and its continuation backwards.
    pub after: [Line; 2],
    /// State x* on Π1 and Π2, and the orbit's state at the corner before and after the impact.
    pub states: [State; 3],
    /// Two neighbours, with impacts equally far before and after the corner.
    pub neighbours: [Neighbour; 2],
    /// Neighbour with its impact before the corner, farther away if the cam has room for it.
    pub far: Neighbour,
}

/// Neighbour of the corner impact's orbit.
#[derive(Clone, Debug, PartialEq)]
pub struct Neighbour {
    /// Side of the corner on which its impact is.
    pub side: Side,
    /// Time of the impact, s.
    pub time: f64,
    /// States x_1, x_d^-, x_d^+ and x_2.
    pub sections: [State; 4],
    /// States before and after the impact.
    pub impact: [State; 2],
    /// Flight from Π1 to the impact, and on to ΠD if that is later.
    pub coming: [Line; 2],
    /// Flight from the impact to Π2, and back to ΠD if that was earlier.
    pub going: [Line; 2],
    /// State on Π2 that the simulator reaches from x_1.
    pub simulated: State,
}

/// State `time`, s, before `state` on the same flight.
fn back(flight: &Flight, state: State, time: f64) -> Option<State> {
    // The flow is affine: fly(x) - fly(y) = Phi (x - y).
    let flown = flight.fly(state, time).1;
    let miss = Vector2::new(state.position - flown.position, state.velocity - flown.velocity);
    let by = flight.propagator(time).try_inverse()? * miss;
    Some(State { position: state.position + by[0], velocity: state.velocity + by[1] })
}

/// Flight from `state` at time `from` to time `to`, s, which may be earlier.
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

impl FigureContext {
    /// Computes the composition at a visible size, or returns the reason why there is none.
    pub fn composition(&self) -> Result<Composition, String> {
        let at = &self.found()?.at;
        let machine = self.machine(at.speed_rpm());
        let (corner, omega) = (&at.corner, at.angular_velocity());
        let sides = [self.cam.before(corner.segment), corner.segment].map(|index| &self.cam.segments()[index]);
        let widths = sides.map(|segment| segment.end - segment.start);
        // Starts from the largest reach that the cam allows, and halves it.
        let reaches = |width: f64| successors(Some((FARTHEST / IMPACT).min(0.9 * width)), |reach| Some(0.5 * reach));
        let beside = |side, reach| neighbour(at, &machine, side, reach);
        let both = |reach| Some((reach, [beside(Side::Minus, reach)?, beside(Side::Plus, reach)?]));
        let Some((reach, neighbours)) = reaches(widths[0].min(widths[1])).take(HALVINGS).find_map(both) else {
            return Err("no neighbour of the orbit has its one impact next to the corner".into());
        };
        // Backwards in time, a damped follower is soon far away.
        let seen = |found: &Neighbour| {
            let off = (found.sections[0].position - at.state.position).abs();
            off < 0.5 * (at.state.position - corner.minus.value).abs()
        };
        let wider = reaches(widths[0]).take_while(|wide| *wide > reach);
        let far = wider.filter_map(|wide| beside(Side::Minus, wide)).find(seen);
        let far = far.unwrap_or_else(|| neighbours[0].clone());
        let window = reach / omega;
        let law = |index: usize, from: f64, to: f64| -> Line {
            // The segment before angle 0 has the law of a turn earlier.
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

/// Neighbour that reaches the cam close to the corner, if the simulator confirms that this is its only impact.
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
        Label::new([-0.5, top + 0.12 * height], "Pi_1", Beside::Right),
        Label::new([0.0, top + 0.12 * height], "Pi_D", Beside::Right),
        Label::new([0.5, top + 0.12 * height], "Pi_2", Beside::Right),
        Label::new([-0.5, star], "x^*", Beside::Above),
        Label::new([0.5, star], "x^*", Beside::Above),
        Label::new([-0.5, first], "x_1", Beside::Left),
        Label::new([0.5, last], "x_2", Beside::Right),
        Label::new([0.0, minus], "x_d^-", Beside::BelowRight),
        Label::new([0.0, plus], "x_d^+", Beside::AboveRight),
        Label::new(middle(&coming), "P_1", Beside::Left),
        Label::new(middle(&going), "P_2", Beside::Right),
        Label::new([0.0, minus + 0.3 * (plus - minus)], "P_D", Beside::Right),
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
    let x = FigureAxis::new("time from the passage of the corner, in periods T*", "").over([-1.0, 1.0]);
    Figure::new(title, x, vec![Panel::new(FigureAxis::new("position", "m").over(range), 0.55, series)])
}
