//! Locates an event in a machine that differs a little: its equations are solved there, with the speed or another number free.

use std::f64::consts::TAU;

use super::constraint::{Held, Pinned};
use super::problem::{BranchScales, Problem};
use super::{BranchPoint, switch};
use crate::cam::{Cam, apart, within_a_turn};
use crate::model::Model;
use crate::orbit::curve::Equations;
use crate::orbit::{Course, Cycle, Family, Parameter};
use crate::simulate::{Machine, angular_velocity};
use crate::tolerance;

/// An event of a machine, to be located in others.
pub(crate) struct Event<'a> {
    machine: &'a Machine,
    rpm: f64,
    free: Parameter,
    /// Value of the free number.
    value: f64,
    /// Size of the free number in the equations.
    span: f64,
    cycle: Cycle,
    held: Held,
}

impl<'a> Event<'a> {
    /// Builds the event at a special point of a branch in a number, with its machine; `range` is the range of the number. `None` if the
    /// point has no equations of its own.
    pub fn of_point(machine: &'a Machine, free: &Parameter, range: [f64; 2], point: &BranchPoint) -> Option<Self> {
        let Course::Impacts(cycle) = &point.orbit.course else { return None };
        let (cycle, held) = switch::held(point.special?.kind, cycle, machine)?;
        let span = if *free == Parameter::Speed { point.rpm } else { range[1] - range[0] };
        Some(Self { machine, rpm: point.rpm, free: free.clone(), value: point.value, span, cycle, held })
    }

    /// The event of an impact on a corner, at the end of its segment or at the start.
    pub fn of_corner(machine: &'a Machine, rpm: f64, cycle: &Cycle, impact: usize, at_end: bool) -> Self {
        let (cycle, held) = (cycle.clone(), Held::Corner(Pinned { impact, at_end }));
        Self { machine, rpm, free: Parameter::Speed, value: rpm, span: rpm, cycle, held }
    }

    /// Speed, rpm, or value of the free number of the event in another machine. `None` if Newton's method finds none nearby.
    pub fn moved(&self, model: &Model, cam: &Cam) -> Option<f64> {
        self.solved(model, cam).map(|(_, value)| value)
    }

    /// Cycle and value of the event in another machine, with those of the event's own machine as guesses.
    pub fn solved(&self, model: &Model, cam: &Cam) -> Option<(Cycle, f64)> {
        /// Number of times that an impact may turn out to be on another segment.
        const SEGMENTS: usize = 6;
        let there = Machine::new(cam.clone(), &model.follower, angular_velocity(self.rpm));
        let family = Family::of(model, &there, self.rpm, vec![self.free.clone()]);
        let (mut cycle, held) = renamed(&self.cycle, self.held, self.machine, &there)?;
        let mut value = self.value;
        for _ in 0..SEGMENTS {
            let (found, next) = solved(&family, &cycle, held, (value, self.span))?;
            let there = family.machine(&[next]).ok()?.0;
            let (named, _) = renamed(&found, held, &there, &there)?;
            let is_there = named.impacts.iter().zip(&cycle.impacts).all(|(one, two)| one.segment == two.segment);
            // Where two segments meet, each may pass the impact to the other.
            let is_between = (next - value).abs() <= tolerance::CYCLE_CLOSED.value * self.span;
            (cycle, value) = (named, next);
            if is_there || is_between {
                return Some((cycle, value));
            }
        }
        None
    }
}

/// Renames the impacts by the segments of another machine's cam, and adapts the condition to them.
fn renamed(cycle: &Cycle, held: Held, here: &Machine, there: &Machine) -> Option<(Cycle, Held)> {
    let from = here.cam().segments();
    let mut renamed = cycle.clone();
    let (mut held, mut is_before) = (held, None);
    for (index, impact) in renamed.impacts.iter_mut().enumerate() {
        match held {
            Held::Corner(Pinned { impact: pinned, at_end }) if pinned == index => {
                // The impact goes to the start of the segment behind the same corner.
                let segment = &from[impact.segment];
                let corner = within_a_turn(if at_end { segment.end } else { segment.start });
                let order = here.cam().corners().iter().copied().find(|other| other.angle == corner)?.jump_order;
                let alike = there.cam().corners().iter().copied().filter(|other| other.jump_order == order);
                let nearest = alike.min_by(|one, two| apart(one.angle, corner).total_cmp(&apart(two.angle, corner)));
                let nearest = nearest.filter(|one| apart(one.angle, corner) <= tolerance::NEIGHBOURING.value)?;
                // The corner may be on the other side of angle 0 there. Then the impact keeps its place, in another revolution.
                let turns = ((nearest.angle - impact.cam_angle) / TAU).round();
                impact.cam_angle += TAU * turns;
                impact.revolution -= turns as i64;
                impact.segment = nearest.segment;
                let at_start = Pinned { impact: pinned, at_end: false };
                held = Held::Corner(at_start);
                // Only where the velocity jumps do the laws on its two sides differ.
                is_before = (at_end && order == 1).then_some(at_start);
            }
            _ => {
                let cam_angle = within_a_turn(impact.cam_angle);
                impact.revolution += ((impact.cam_angle - cam_angle) / TAU).round() as i64;
                impact.cam_angle = cam_angle;
                impact.segment = there.cam().segment_at(cam_angle);
            }
        }
    }
    Some(match is_before {
        Some(pinned) => {
            (pinned.other_side(&renamed, there), Held::Corner(Pinned { impact: pinned.impact, at_end: true }))
        }
        None => (renamed, held),
    })
}

/// Solves for the cycle and the value of the free number at which all equations hold, on these segments. `span` is the number's size.
fn solved(family: &Family, cycle: &Cycle, held: Held, (value, span): (f64, f64)) -> Option<(Cycle, f64)> {
    /// Most Newton steps. If more are needed, the event is elsewhere or gone.
    const STEPS: usize = 20;
    let machine = family.machine(&[value]).ok()?.0;
    let problem = Problem::new(family, cycle, BranchScales::of(cycle, &machine), &[span], Some(held));
    let mut unknowns = problem.unknowns(cycle, &machine, &[value]);
    for _ in 0..STEPS {
        let (residual, jacobian) = problem.linear(&unknowns).ok()?;
        let correction = jacobian.lu().solve(&-residual)?;
        unknowns += &correction;
        if correction.norm() <= tolerance::CYCLE_CLOSED.value {
            let value = problem.values(&unknowns).first().copied()?;
            return problem.unpack(&unknowns).ok().map(|(cycle, ..)| (cycle, value));
        }
    }
    None
}
