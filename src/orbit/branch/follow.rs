//! One direction of a branch: steps along the curve, cut where something changes.

use super::cut::{Cut, Located, Stride};
use super::problem::{Pinned, Problem, Units};
use super::switch::{self, Exit};
use super::{BranchPoint, End, Following, Special, gap};
use crate::orbit::curve::{self, CurvePoint, NoPoint};
use crate::orbit::cycle::lift_size;
use crate::orbit::{Cycle, Departure, Family, FamilyError, OrbitError, PeriodicOrbit};
use crate::tolerance;

/// Impacts in a revolution beyond which a follower is said to chatter.
const MOST_IMPACTS: usize = 24;
/// The first step, and the one after each change of the cycle, of the longest.
const FIRST: f64 = 0.02;
/// How far the curve may turn in one step: the cosine.
const STRAIGHT: f64 = 0.985;

/// Where a walk starts.
pub(super) struct Start<'a> {
    pub(super) cycle: &'a Cycle,
    /// Of the free numbers; the last is the one that the walk is about.
    pub(super) values: &'a [f64],
    /// Of the free numbers.
    pub(super) spans: &'a [f64],
    pub(super) pinned: Option<Pinned>,
}

/// The branch in one direction: the sign of the last free number's first change.
pub(super) fn half(
    family: &Family,
    start: &Start<'_>,
    following: &Following,
    direction: f64,
) -> Result<(Vec<BranchPoint>, End), OrbitError> {
    let Start { cycle, values, spans, pinned } = *start;
    let machine = family.machine(values)?.0;
    let units = Units::of(cycle, &machine);
    let problem = Problem::new(family, cycle, units, spans, pinned);
    let unknowns = problem.unknowns(cycle, &machine, values);
    let Ok(tangent) = curve::first_tangent(&problem, &unknowns) else { return Ok((Vec::new(), End::Lost)) };
    let ahead = tangent[unknowns.len() - 1] * direction >= 0.0;
    let stride = Stride {
        family,
        following,
        units,
        spans: spans.to_vec(),
        pinned,
        pattern: cycle.clone(),
        from: CurvePoint { unknowns, tangent: if ahead { tangent } else { -tangent }, steps: 0 },
        step: FIRST * following.longest_step,
    };
    Walk { stride, fresh: None, points: Vec::new() }.run()
}

/// A walk along a branch, in one direction.
struct Walk<'a> {
    stride: Stride<'a>,
    /// What the cycle was changed for, until a step has been made with the new one.
    fresh: Option<Exit>,
    points: Vec<BranchPoint>,
}

impl Walk<'_> {
    fn run(mut self) -> Result<(Vec<BranchPoint>, End), OrbitError> {
        let mut begin = (self.stride.pattern.clone(), self.stride.from.clone());
        loop {
            if self.points.len() >= self.stride.following.most_points {
                return Ok((self.points, End::MostPoints));
            }
            match self.advance() {
                Ok(None) => self.rescale(&mut begin),
                Ok(Some(end)) => return Ok((self.points, end)),
                Err(error) => {
                    if matches!(error, NoPoint::Outside(_))
                        && let Some(last) = self.at_bound()
                    {
                        self.points.push(last);
                        return Ok((self.points, End::Range));
                    }
                    self.stride.step *= 0.5;
                    if self.stride.step < tolerance::SHORTEST_STEP.value * self.stride.following.longest_step {
                        let end = match (error, self.fresh) {
                            (NoPoint::Outside(error), _) => End::Edge(error.to_string()),
                            (_, Some(Exit::Touch { .. } | Exit::Tangent { .. })) => End::Graze,
                            _ if self.chatters() => End::Chatter,
                            _ => End::Lost,
                        };
                        return Ok((self.points, end));
                    }
                }
            }
            let home = &begin.1.unknowns;
            let alike = begin.0.impacts.len() == self.stride.pattern.impacts.len()
                && begin
                    .0
                    .impacts
                    .iter()
                    .zip(&self.stride.pattern.impacts)
                    .all(|(one, other)| one.segment == other.segment);
            if alike && self.points.len() > 20 {
                let away = &self.stride.from.unknowns - home;
                if away.norm() < self.stride.step && away.dot(&begin.1.tangent) <= 0.0 {
                    return Ok((self.points, End::Closed));
                }
            }
        }
    }

    /// Whether some impacts follow one another so closely that there is no telling them apart soon.
    fn chatters(&self) -> bool {
        let closest =
            |cycle: Cycle| (0..cycle.impacts.len()).map(|index| cycle.turn(index)).fold(f64::INFINITY, f64::min);
        let here = self.stride.problem().unpack(&self.stride.from.unknowns);
        here.is_ok_and(|(cycle, ..)| closest(cycle) < tolerance::CHATTERING_TURN.value)
    }

    /// The same curve in units of the velocities that it has come to.
    fn rescale(&mut self, home: &mut (Cycle, CurvePoint)) {
        /// From which factor on.
        const FACTOR: f64 = 1.5;
        let Ok((cycle, machine, _)) = self.stride.problem().unpack(&self.stride.from.unknowns) else { return };
        let units = Units::of(&cycle, &machine);
        let factor = units.velocity / self.stride.units.velocity;
        if !(1.0 / FACTOR..FACTOR).contains(&factor) {
            self.stride.units.convert(&mut self.stride.from, cycle.impacts.len(), units);
            self.stride.units.convert(&mut home.1, home.0.impacts.len(), units);
            self.stride.units = units;
        }
    }

    /// The orbit at the bound of the range that the branch runs into, where the model allows nothing beyond.
    fn at_bound(&self) -> Option<BranchPoint> {
        let from = &self.stride.from.unknowns;
        let (value, slope) = (self.stride.value(from), self.stride.value(&self.stride.from.tangent));
        let bound = self.stride.following.range[usize::from(slope > 0.0)];
        let step = (bound - value) / slope;
        if !(step.is_finite() && (0.0..=self.stride.step).contains(&step)) {
            return None;
        }
        // A pinned cycle closes at one speed only, and not at this one.
        if self.stride.pinned.is_some() {
            return None;
        }
        let (machine, rpm) = self.stride.family.machine(&[bound]).ok()?;
        let problem = self.stride.problem();
        let mut unknowns = from + &self.stride.from.tangent * step;
        unknowns[problem.column(0)] = bound / self.stride.spans[0];
        let (guess, _, _) = problem.unpack(&unknowns).ok()?;
        let (cycle, residual) = guess.closed(&machine).ok()?;
        let is_orbit = matches!(cycle.departure(&machine), Ok(None));
        let orbit = PeriodicOrbit::of_cycle(&machine, cycle, residual);
        is_orbit.then_some(BranchPoint { sides: None, rpm, value: bound, orbit, special: None })
    }

    /// One step, or the part of it up to where the cycle changes.
    fn advance(&mut self) -> Result<Option<End>, NoPoint<FamilyError>> {
        let problem = self.stride.problem();
        let next = curve::step(&problem, &self.stride.from.unknowns, &self.stride.from.tangent, self.stride.step)?;
        if next.tangent.dot(&self.stride.from.tangent) < STRAIGHT {
            return Err(NoPoint::NotClosed);
        }
        // The first that cuts the step short, of those that the equations tell.
        let mut first: Option<Located> = None;
        let mut keep = |located: Located| {
            if first.as_ref().is_none_or(|first| located.step < first.step) {
                first = Some(located);
            }
        };
        for cut in self.stride.cuts(&problem, &next.unknowns)? {
            keep(self.stride.locate(&problem, cut, self.stride.step)?);
        }
        if let Some(located) = self.stride.halved(&problem, &next)? {
            keep(located);
        }
        // And those that only the simulator sees, on the way there.
        let (mut clear, mut reach) = match &first {
            Some(located) => {
                let reach = located.step * (1.0 - 1e-3);
                (curve::step(&problem, &self.stride.from.unknowns, &self.stride.from.tangent, reach)?, reach)
            }
            None => (next.clone(), self.stride.step),
        };
        let (cycle, at, _) = problem.unpack(&clear.unknowns)?;
        match cycle.departure(&at) {
            Ok(None) => {}
            Ok(Some(Departure::Earlier { impact, event })) => {
                let turned = (event.revolution as f64) * std::f64::consts::TAU + event.cam_angle
                    - cycle.impacts[impact].cam_angle.rem_euclid(std::f64::consts::TAU);
                let touch = Exit::Touch { impact, turned };
                let located = self.stride.locate(&problem, Cut::Exit(touch), reach)?;
                reach = located.step;
                clear = located.point.clone();
                first = Some(located);
            }
            // So near to a cut that the simulator sees it already, or nothing that a shorter step would not show better.
            Ok(Some(_)) if first.is_some() => {}
            Ok(Some(_)) | Err(_) => return Err(NoPoint::NotClosed),
        }
        let end_point = first.as_ref().map_or(next, |located| located.point.clone());
        let mut points = Vec::new();
        let mut folds = false;
        for cut in self.stride.passed() {
            // At a fold a multiplier is 1 as well.
            if cut == Cut::Branching && folds {
                continue;
            }
            let at = |point: &CurvePoint| self.stride.measure(&problem, cut, point);
            // Just short of a graze, where the matrix has a pole.
            if (at(&self.stride.from)? > 0.0) != (at(&clear)? > 0.0) && self.fresh.is_none() {
                let located = match self.stride.locate(&problem, cut, reach) {
                    // Where branches cross, the equations are singular, and may not close that near.
                    Err(_) if cut == Cut::Branching => continue,
                    located => located?,
                };
                folds |= cut == Cut::Fold;
                // A sign that changes through infinity is no root.
                let small = if cut == Cut::Branching { tolerance::BRANCHING } else { tolerance::SAME_ORBIT };
                if located.residual > small.value {
                    continue;
                }
                points.push((
                    located.step,
                    self.branch_point(&problem, &located.point, self.stride.special(&problem, &located)?)?,
                ));
            }
        }
        points.sort_by(|one, two| one.0.total_cmp(&two.0));
        let special = match &first {
            Some(located) => self.stride.special(&problem, located)?,
            None => None,
        };
        let mut last = self.branch_point(&problem, &end_point, special)?;
        if let Some(Located { cut: Cut::Exit(exit @ Exit::Tangent { .. }), .. }) = first {
            // The impact that is none has no saltation matrix; the orbit without it has one.
            let (cycle, machine, _) = problem.unpack(&end_point.unknowns)?;
            if let Some(without) = switch::beyond(exit, &cycle, &machine) {
                last.orbit = PeriodicOrbit::of_cycle(&machine, without.shortest(), last.orbit.residual);
            }
        }
        if let (Some(Located { cut: Cut::Halved, .. }), (cycle, machine, _)) =
            (&first, problem.unpack(&end_point.unknowns)?)
        {
            last.orbit = PeriodicOrbit::of_cycle(&machine, cycle.shortest(), last.orbit.residual);
        }
        let grown = if end_point.steps <= 4 { 1.5 } else { 1.0 };
        drop(problem);
        self.points.extend(points.into_iter().map(|(_, point)| point));
        // A seam of the cam that is no corner is passed without a word.
        let silent = matches!(&first, Some(Located { cut: Cut::Exit(Exit::Corner { .. }), .. })) && special.is_none();
        if !silent {
            self.points.push(last);
        }
        self.stride.from = end_point;
        match first {
            Some(Located { cut: Cut::Range(_), .. }) => Ok(Some(End::Range)),
            Some(Located { cut: Cut::Halved, .. }) => Ok(Some(End::Shorter)),
            Some(Located { cut: Cut::Exit(exit), .. }) => self.go_over(exit),
            _ => {
                self.fresh = None;
                self.stride.step = (self.stride.step * grown).min(self.stride.following.longest_step);
                Ok(None)
            }
        }
    }

    fn branch_point(
        &self,
        problem: &Problem<'_>,
        point: &CurvePoint,
        special: Option<Special>,
    ) -> Result<BranchPoint, NoPoint<FamilyError>> {
        let (cycle, machine, rpm) = problem.unpack(&point.unknowns)?;
        let residual = cycle.residual(&machine).amax() / lift_size(&machine);
        let sides = self.stride.pinned.map(|pinned| pinned.sides(&cycle, &machine));
        let orbit = PeriodicOrbit::of_cycle(&machine, cycle, residual);
        Ok(BranchPoint { sides, rpm, value: self.stride.value(&point.unknowns), orbit, special })
    }

    /// Goes over to the cycle beyond an exit.
    fn go_over(&mut self, exit: Exit) -> Result<Option<End>, NoPoint<FamilyError>> {
        if self.stride.pinned.is_some() {
            return Ok(Some(if matches!(exit, Exit::Corner { .. }) { End::Corner } else { End::Graze }));
        }
        let values = [self.stride.value(&self.stride.from.unknowns)];
        let machine = self.stride.family.machine(&values)?.0;
        let (cycle, _, _) = self.stride.problem().unpack(&self.stride.from.unknowns)?;
        let exit = match exit {
            Exit::Touch { impact, turned } => match gap::least(&cycle, &machine, impact, turned) {
                Some((_, turned)) => Exit::Touch { impact, turned },
                None => return Ok(Some(End::Lost)),
            },
            other => other,
        };
        let exhausted = if matches!(exit, Exit::Corner { .. }) { End::Lost } else { End::Graze };
        // Straight back where it came from: the direction could not be told.
        if self.fresh.is_some() {
            return Ok(Some(exhausted));
        }
        let Some(beyond) = switch::beyond(exit, &cycle, &machine) else { return Ok(Some(End::Graze)) };
        if beyond.repeats_sooner() {
            return Ok(Some(End::Shorter));
        }
        if beyond.impacts.len() > MOST_IMPACTS * beyond.revolutions as usize {
            return Ok(Some(End::Chatter));
        }
        self.stride.pattern = beyond.clone();
        let problem = self.stride.problem();
        let unknowns = problem.unknowns(&beyond, &machine, &values);
        if problem.residual(&unknowns)?.amax() > tolerance::SAME_ORBIT.value {
            return Ok(Some(End::Gap));
        }
        let Ok(tangent) = switch::direction(exit, &cycle, &problem, &unknowns) else { return Ok(Some(exhausted)) };
        drop(problem);
        self.stride.from = CurvePoint { unknowns, tangent, steps: 0 };
        self.stride.step = FIRST * self.stride.following.longest_step;
        self.fresh = Some(exit);
        Ok(None)
    }
}
