//! Events within one step along a branch, such as a corner, a fold or a flip: detected, measured and located.

use nalgebra::DVector;

use super::constraint::Held;
use super::problem::{BranchScales, Problem};
use super::switch::{self, Exit};
use super::{BranchPoint, Following, OnCurve, Special, SpecialKind, least_gap, period_halving, special};
use crate::bracket::{Seen, regula_falsi};
use crate::orbit::curve::{self, CurvePoint, NoPoint};
use crate::orbit::{Cycle, Departure, Family, FamilyError, PeriodicOrbit};
use crate::simulate::{Machine, SimulateError};
use crate::tolerance;

/// Event that cuts the present step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cut {
    /// The parameter reaches a bound.
    Range(f64),
    /// The orbit leaves its cycle.
    Exit(Exit),
    /// A multiplier passes 1.
    Fold,
    /// A multiplier passes 1, and the branch goes on: another branch crosses it.
    Branching,
    /// A multiplier passes -1.
    Flip,
    /// The second half of a period becomes the same as the first.
    Halved,
    /// Along a curve: with the law on one side of the corner, or without the touch, a multiplier passes 1 or -1.
    Type { side: usize, multiplier: f64 },
    /// Along a curve of folds: the curve turns back in both numbers.
    Cusp,
}

pub(super) struct Located {
    /// Length of the step to the cut.
    pub(super) step: f64,
    pub(super) cut: Cut,
    pub(super) point: CurvePoint,
    /// Bracket of the parameter.
    pub(super) bracket: [f64; 2],
    pub(super) residual: f64,
}

/// One step of a branch: its start, its cycle and its length.
pub(super) struct Stride<'a> {
    pub(super) family: &'a Family,
    pub(super) following: &'a Following,
    pub(super) units: BranchScales,
    pub(super) spans: Vec<f64>,
    pub(super) held: Option<Held>,
    pub(super) pattern: Cycle,
    pub(super) from: CurvePoint,
    pub(super) step: f64,
}

impl Stride<'_> {
    /// The equations of the cycle.
    pub(super) fn problem(&self) -> Problem<'_> {
        Problem::new(self.family, &self.pattern, self.units, &self.spans, self.held)
    }

    /// Returns where the motion on the actual cam leaves the cycle, apart from the held condition.
    pub(super) fn departure(&self, cycle: &Cycle, machine: &Machine) -> Result<Option<Departure>, SimulateError> {
        match self.held {
            Some(Held::Touch(impact)) => cycle.departure_but_for(machine, Some(impact)),
            _ => cycle.departure_but_for(machine, None),
        }
    }

    /// Value of the parameter in the unknowns.
    pub(super) fn value(&self, unknowns: &DVector<f64>) -> f64 {
        unknowns[unknowns.len() - 1] * self.spans[self.spans.len() - 1]
    }

    /// Whether the value stays the same all the way to `next`, as along a continuum of orbits. At a fold the value changes on both sides of
    /// the point where it turns back.
    pub(super) fn stands(&self, next: &CurvePoint) -> bool {
        let slope = |point: &CurvePoint| point.tangent[point.tangent.len() - 1].abs();
        self.held.is_none() && [&self.from, next].into_iter().all(|point| slope(point) <= tolerance::STANDING.value)
    }

    /// Locates the flip that a step to `next` passes, if the orbit is one of twice the period.
    pub(super) fn halved(
        &self,
        problem: &Problem<'_>,
        next: &CurvePoint,
    ) -> Result<Option<Located>, NoPoint<FamilyError>> {
        if self.held.is_some() || self.pattern.second_half(0).is_none() {
            return Ok(None);
        }
        let (one, two) = (problem.unpack(&self.from.unknowns)?.0, problem.unpack(&next.unknowns)?.0);
        let ends = [(self.value(&self.from.unknowns), &one), (self.value(&next.unknowns), &two)];
        let values = |value: f64| {
            let mut values = problem.values(&self.from.unknowns);
            if let Some(last) = values.last_mut() {
                *last = value;
            }
            values
        };
        let machine_at = |value: f64| self.family.machine_of_cycles(&values(value)).ok().map(|(machine, _)| machine);
        let Some(flipped) = period_halving::flip(machine_at, ends) else { return Ok(None) };
        let Some(machine) = machine_at(flipped.value) else { return Ok(None) };
        let unknowns = problem.unknowns(&flipped.cycle, &machine, &values(flipped.value));
        let point = CurvePoint { unknowns, ..self.from.clone() };
        let part =
            period_halving::apart(&one).zip(period_halving::apart(&two)).map_or(0.0, |(one, two)| one / (one - two));
        let (bracket, residual) = (flipped.bracket, flipped.residual);
        Ok(Some(Located { step: part * self.step, cut: Cut::Halved, point, bracket, residual }))
    }

    /// Events that may be passed without a change of the cycle.
    pub(super) fn passed(&self) -> Vec<Cut> {
        let of_side = |side| [1.0, -1.0].map(|multiplier| Cut::Type { side, multiplier });
        match self.held {
            None => vec![Cut::Fold, Cut::Flip, Cut::Branching],
            Some(Held::Corner(_)) => [0, 1].into_iter().flat_map(of_side).chain([Cut::Fold]).collect(),
            Some(Held::Touch(_)) => of_side(0).into_iter().chain([Cut::Fold]).collect(),
            Some(Held::Multiplier(1.0)) => vec![Cut::Cusp, Cut::Fold],
            Some(Held::Multiplier(_)) => vec![Cut::Fold],
        }
    }

    /// Cuts that the equations show to have been passed at `unknowns`.
    pub(super) fn cuts(
        &self,
        problem: &Problem<'_>,
        unknowns: &DVector<f64>,
    ) -> Result<Vec<Cut>, NoPoint<FamilyError>> {
        let (cycle, machine, _) = problem.unpack(unknowns)?;
        let mut cuts = Vec::new();
        let value = self.value(unknowns);
        let [low, high] = self.following.range;
        if value < low {
            cuts.push(Cut::Range(low));
        }
        if value > high {
            cuts.push(Cut::Range(high));
        }
        for (index, impact) in cycle.impacts.iter().enumerate() {
            let segment = &machine.cam().segments()[impact.segment];
            let pinned = matches!(self.held, Some(Held::Corner(pinned)) if pinned.impact == index);
            if impact.cam_angle > segment.end && !pinned {
                cuts.push(Cut::Exit(Exit::Corner { impact: index, past_end: true }));
            }
            if impact.cam_angle < segment.start && !pinned {
                cuts.push(Cut::Exit(Exit::Corner { impact: index, past_end: false }));
            }
            if self.held != Some(Held::Touch(index)) && cycle.approach(&machine, index) <= 0.0 {
                cuts.push(Cut::Exit(Exit::Tangent { impact: index }));
            }
        }
        Ok(cuts)
    }

    /// Quantity that is positive before a cut and passes 0 at it. For a fold or a flip it may have either sign before.
    pub(super) fn measure(
        &self,
        problem: &Problem<'_>,
        cut: Cut,
        at: &CurvePoint,
    ) -> Result<f64, NoPoint<FamilyError>> {
        let (cycle, machine, _) = problem.unpack(&at.unknowns)?;
        Ok(match cut {
            Cut::Range(bound) => {
                let value = self.value(&at.unknowns);
                if bound == self.following.range[0] { value - bound } else { bound - value }
            }
            Cut::Exit(Exit::Corner { impact, past_end }) => {
                let impact = &cycle.impacts[impact];
                let segment = &machine.cam().segments()[impact.segment];
                if past_end { segment.end - impact.cam_angle } else { impact.cam_angle - segment.start }
            }
            Cut::Exit(Exit::Tangent { impact }) => cycle.approach(&machine, impact),
            Cut::Exit(Exit::Touch { impact, turned }) => {
                least_gap::least(&cycle, &machine, impact, turned).ok_or(NoPoint::NotClosed)?.0
            }
            Cut::Fold => at.tangent[at.tangent.len() - 1],
            // Its own equations are singular there: `halved` locates it.
            Cut::Halved => return Err(NoPoint::NotClosed),
            Cut::Branching => cycle.missing(&machine, 1.0),
            Cut::Flip => cycle.missing(&machine, -1.0),
            Cut::Type { side, multiplier } => {
                let sides = self.held.map(|held| held.sides(&cycle, &machine)).unwrap_or_default();
                sides.get(side).ok_or(NoPoint::NotClosed)?.missing(&machine, multiplier)
            }
            Cut::Cusp => {
                // Along the curve the two numbers move one way, more slowly towards the cusp, and back from there.
                let numbers = |tangent: &DVector<f64>| tangent.rows(tangent.len() - 2, 2).into_owned();
                numbers(&at.tangent).dot(&numbers(&self.from.tangent).normalize())
            }
        })
    }

    /// Locates a cut in `[0, step]` by secants that keep the bracket.
    pub(super) fn locate(&self, problem: &Problem<'_>, cut: Cut, step: f64) -> Result<Located, NoPoint<FamilyError>> {
        let at = |step: f64| -> Result<Seen<CurvePoint>, NoPoint<FamilyError>> {
            let with = curve::step(problem, &self.from.unknowns, &self.from.tangent, step)?;
            Ok(Seen { at: step, value: self.measure(problem, cut, &with)?, with })
        };
        let start = Seen { at: 0.0, value: self.measure(problem, cut, &self.from)?, with: self.from.clone() };
        let end = at(step)?;
        if (start.value < 0.0) == (end.value < 0.0) && end.value != 0.0 {
            return Err(NoPoint::NotClosed);
        }
        let value = |step: f64| match at(step) {
            // The singular equations give no nearer point.
            Err(_) if cut == Cut::Branching => Ok(None),
            reached => reached.map(|seen| Some((seen.value, seen.with))),
        };
        let (ends, best) = regula_falsi([start, end], tolerance::ROOT_WIDTH.value * step, value)?;
        let residual = best.value.abs();
        // The parameter is rounded along the curve as well.
        let [low, high] = ends.map(|end| self.value(&end.with.unknowns));
        let between = self.value(&best.with.unknowns);
        let bracket = [low.min(high).min(between), low.max(high).max(between)];
        Ok(Located { step: best.at, cut, point: best.with, bracket, residual })
    }

    /// The orbit at a point.
    pub(super) fn branch_point(
        &self,
        problem: &Problem<'_>,
        point: &CurvePoint,
        special: Option<Special>,
    ) -> Result<BranchPoint, NoPoint<FamilyError>> {
        let (cycle, machine, rpm) = problem.unpack(&point.unknowns)?;
        let residual = problem.residual(&point.unknowns)?.amax();
        let held = self.held.map(|held| {
            let sides = held.sides(&cycle, &machine);
            let sides = sides.iter().map(|side| side.at_section(&machine, 0.0).1).collect();
            OnCurve { cam_angle: held.cam_angle(&cycle), sides, class: None }
        });
        let cycle = self.held.map_or_else(|| cycle.clone(), |held| held.orbit(&cycle));
        let orbit = special::judged(PeriodicOrbit::of_cycle(&machine, cycle, residual), special);
        Ok(BranchPoint { held, rpm, value: self.value(&point.unknowns), orbit, special })
    }

    pub(super) fn special(
        &self,
        problem: &Problem<'_>,
        located: &Located,
    ) -> Result<Option<Special>, NoPoint<FamilyError>> {
        let (cycle, machine, _) = problem.unpack(&located.point.unknowns)?;
        let kind = match located.cut {
            Cut::Range(_) => return Ok(None),
            Cut::Fold if self.held.is_some() => SpecialKind::Turn,
            Cut::Fold => SpecialKind::Fold,
            Cut::Cusp => SpecialKind::Cusp,
            Cut::Flip | Cut::Halved => SpecialKind::Flip,
            Cut::Branching => SpecialKind::Branching,
            Cut::Type { side, multiplier } => {
                let after_corner = matches!(self.held, Some(Held::Corner(_))).then_some(side == 1);
                SpecialKind::Type { after_corner, multiplier }
            }
            Cut::Exit(exit) => match (exit, self.order(exit, &cycle, &machine)) {
                (Exit::Corner { .. }, None) => return Ok(None),
                // Impacts are numbered as in the orbit, from angle 0.
                (_, order) => match switch::kind(exit, &cycle, &machine, order.unwrap_or(0)) {
                    SpecialKind::Corner { impact, segment, jump_order } => {
                        SpecialKind::Corner { impact: cycle.place_in_order(impact), segment, jump_order }
                    }
                    other => other,
                },
            },
        };
        Ok(Some(Special { kind, bracket: located.bracket, residual: located.residual }))
    }

    /// Order of the corner by which an impact leaves its segment; `None` if it is no corner.
    pub(super) fn order(&self, exit: Exit, cycle: &Cycle, machine: &Machine) -> Option<usize> {
        let Exit::Corner { impact, past_end } = exit else { return None };
        let segment = cycle.impacts[impact].segment;
        let meeting = if past_end { (segment + 1) % machine.cam().segments().len() } else { segment };
        machine.cam().corners().iter().find(|corner| corner.segment == meeting).map(|corner| corner.jump_order)
    }
}
