//! Follows a branch in one direction: steps along the curve, cut where something changes.

use nalgebra::DVector;

use super::constraint::{Held, Pinned};
use super::problem::{BranchScales, Problem};
use super::step_event::{Cut, Located, Stride};
use super::switch::{self, Exit};
use super::{BranchPoint, End, Following, HalfBranch, Special, least_gap, special};
use crate::orbit::curve::{self, CurvePoint, NoPoint};
use crate::orbit::{Cycle, Departure, Family, FamilyError, OrbitError, PeriodicOrbit};
use crate::tolerance;

/// Impacts per revolution beyond which a follower counts as chattering.
const MOST_IMPACTS: usize = 24;
/// The first step, and the one after each change of the cycle, in units of the longest step.
const FIRST: f64 = 0.02;
/// Cosine of the largest turn of the curve in one step.
const STRAIGHT: f64 = 0.985;

/// Start of a walk.
#[derive(Clone, Copy)]
pub(super) struct Start<'a> {
    pub(super) cycle: &'a Cycle,
    /// Values of the free numbers; the walk follows the last one.
    pub(super) values: &'a [f64],
    /// Spans of the free numbers.
    pub(super) spans: &'a [f64],
    pub(super) held: Option<Held>,
}

impl<'a> Stride<'a> {
    /// The first stride of a walk, without a direction yet.
    fn begun(family: &'a Family, start: &Start<'_>, following: &'a Following) -> Result<Self, OrbitError> {
        let Start { cycle, values, spans, held } = *start;
        let machine = family.machine(values)?.0;
        let units = BranchScales::of(cycle, &machine);
        let unknowns = Problem::new(family, cycle, units, spans, held).unknowns(cycle, &machine, values);
        let tangent = DVector::zeros(unknowns.len());
        let from = CurvePoint { unknowns, tangent, steps: 0 };
        let (spans, pattern, step) = (spans.to_vec(), cycle.clone(), FIRST * following.longest_step);
        Ok(Self { family, following, units, spans, held, pattern, from, step })
    }

    /// Follows the branch in one direction: the sign of the last free number's first change.
    fn half(mut self, direction: f64) -> Result<HalfBranch, OrbitError> {
        let Ok(tangent) = curve::first_tangent(&self.problem(), &self.from.unknowns) else {
            return Ok((Vec::new(), self.stuck(direction)));
        };
        let ahead = tangent[tangent.len() - 1] * direction >= 0.0;
        self.from.tangent = if ahead { tangent } else { -tangent };
        Walk { stride: self, fresh: None, signs: Vec::new(), standing: 0, points: Vec::new() }.run()
    }

    /// Reason why no step leads away from the start. The model may refuse steps to both sides, for two different reasons.
    fn stuck(&self, direction: f64) -> End {
        let mut beside = self.from.unknowns.clone();
        beside[self.from.unknowns.len() - 1] += direction * self.step;
        self.problem().unpack(&beside).map_or_else(|why| End::edge(direction > 0.0, &why), |_| End::Lost)
    }
}

/// Follows the branch in one direction from an orbit.
pub(super) fn half(
    family: &Family,
    start: &Start<'_>,
    following: &Following,
    direction: f64,
) -> Result<HalfBranch, OrbitError> {
    Stride::begun(family, start, following)?.half(direction)
}

/// Follows the branch from the touch of an orbit without impacts. The impacts of the start's cycle are touches there.
pub(super) fn from_touch(family: &Family, start: &Start<'_>, following: &Following) -> Result<HalfBranch, OrbitError> {
    let mut cycle = start.cycle.clone();
    for impact in 0..cycle.impacts.len() {
        let stride = Stride::begun(family, &Start { cycle: &cycle, ..*start }, following)?;
        let Ok(tangent) = switch::from_touch(&stride.problem(), &stride.from.unknowns) else {
            return Ok((Vec::new(), End::Graze));
        };
        // At a top where two segments meet, the touch belongs to the segment that the impact moves into.
        let (machine, _) = family.machine(start.values)?;
        let segment = &machine.cam().segments()[cycle.impacts[impact].segment];
        let (angle, moves) = (cycle.impacts[impact].cam_angle, tangent[2 * impact]);
        if angle <= segment.start && moves < 0.0 || angle >= segment.end && moves > 0.0 {
            cycle = Pinned { impact, at_end: moves > 0.0 }.other_side(&cycle, &machine);
        }
    }
    let mut stride = Stride::begun(family, &Start { cycle: &cycle, ..*start }, following)?;
    let Ok(tangent) = switch::from_touch(&stride.problem(), &stride.from.unknowns) else {
        return Ok((Vec::new(), End::Graze));
    };
    stride.from.tangent = tangent;
    let fresh = Some(Exit::Touch { impact: 0, turned: 0.0 });
    Walk { stride, fresh, signs: Vec::new(), standing: 0, points: Vec::new() }.run()
}

/// Follows the curve of the held condition in both directions, from its point at the first value of the last number. Returns this point and
/// both halves; `None` if there is no such point.
pub(super) fn curve(
    family: &Family,
    start: &Start<'_>,
    following: &Following,
    special: Option<Special>,
) -> Result<Option<(BranchPoint, [HalfBranch; 2])>, OrbitError> {
    let begun = || Stride::begun(family, start, following);
    let mut stride = begun()?;
    let count = stride.from.unknowns.len();
    let along = DVector::from_fn(count, |row, _| f64::from(row + 1 == count));
    let guess = stride.from.unknowns.clone();
    // A located point is accurate to half of the digits that its own equations give.
    let Ok(point) = curve::closed(&stride.problem(), &guess, &along, 0.0, guess.clone()) else { return Ok(None) };
    stride.from = point;
    let Ok(middle) = stride.branch_point(&stride.problem(), &stride.from, special) else { return Ok(None) };
    let half = |direction: f64| {
        let from = stride.from.clone();
        Stride { from, ..begun()? }.half(direction)
    };
    Ok(Some((middle, [half(-1.0)?, half(1.0)?])))
}

/// A walk along a branch, in one direction.
struct Walk<'a> {
    stride: Stride<'a>,
    /// Exit for which the cycle was changed, until a step has been made with the new cycle.
    fresh: Option<Exit>,
    /// Signs of the quantities that may pass 0, on the side from which a smooth corner was reached.
    signs: Vec<bool>,
    /// Number of steps in a row over which the value did not change.
    standing: usize,
    points: Vec<BranchPoint>,
}

/// Steps in a row without a change of the value that make a continuum.
const CONTINUUM: usize = 5;

impl Walk<'_> {
    fn run(mut self) -> Result<HalfBranch, OrbitError> {
        let mut begin = (self.stride.pattern.clone(), self.stride.from.clone());
        loop {
            if self.points.len() >= self.stride.following.most_points {
                return Ok((self.points, End::MostPoints));
            }
            match self.advance() {
                Ok(None) if self.rescale(&mut begin) => return Ok((self.points, End::Unbounded)),
                Ok(None) => {}
                Ok(Some(end)) => return Ok((self.points, end)),
                Err(error) => {
                    if let NoPoint::Outside(why) = &error
                        && let Some((last, end)) = self.at_bound(why)
                    {
                        // A branch that begins at this value has the point already.
                        if last.value != self.stride.value(&self.stride.from.unknowns) {
                            self.points.push(last);
                        }
                        return Ok((self.points, end));
                    }
                    self.stride.step *= 0.5;
                    if self.stride.step < tolerance::SHORTEST_STEP.value * self.stride.following.longest_step {
                        let end = match (error, self.fresh) {
                            (NoPoint::Outside(why), _) => self.edge(&why),
                            _ if self.chatters() => End::Chatter,
                            (_, Some(Exit::Tangent { .. })) => End::Graze,
                            _ if self.grazes() => End::Graze,
                            _ => End::Lost,
                        };
                        return Ok((self.points, end));
                    }
                }
            }
            let home = &begin.1.unknowns;
            let [one, other] = [&begin.0, &self.stride.pattern].map(|cycle| cycle.impacts.iter().map(|it| it.segment));
            let alike = one.eq(other);
            if alike && self.points.len() > 20 {
                let away = &self.stride.from.unknowns - home;
                // Behind a fold, the branch may pass close to its start in the other direction.
                let is_onward = self.stride.from.tangent.dot(&begin.1.tangent) > 0.0;
                if is_onward && away.norm() < self.stride.step {
                    return Ok((self.points, End::Closed));
                }
            }
        }
    }

    /// Whether some impacts follow one another so closely that they soon cannot be distinguished.
    fn chatters(&self) -> bool {
        let closest =
            |cycle: Cycle| (0..cycle.impacts.len()).map(|index| cycle.turn(index)).fold(f64::INFINITY, f64::min);
        let here = self.stride.problem().unpack(&self.stride.from.unknowns);
        here.is_ok_and(|(cycle, ..)| closest(cycle) < tolerance::CHATTERING_TURN.value)
    }

    /// Whether some impact is nearly a touch.
    fn grazes(&self) -> bool {
        let here = self.stride.problem().unpack(&self.stride.from.unknowns);
        here.is_ok_and(|(cycle, machine, _)| {
            let approach = |index: usize| cycle.approach(&machine, index) / machine.angular_velocity();
            let slowest = (0..cycle.impacts.len()).map(approach).fold(f64::INFINITY, f64::min);
            slowest < tolerance::TOUCH.value * self.stride.units.velocity
        })
    }

    /// Converts the curve to units of its present velocities. Returns whether these grow without bound.
    fn rescale(&mut self, home: &mut (Cycle, CurvePoint)) -> bool {
        /// Least factor at which the units are changed.
        const FACTOR: f64 = 1.5;
        let Ok((cycle, machine, _)) = self.stride.problem().unpack(&self.stride.from.unknowns) else { return false };
        let units = BranchScales::of(&cycle, &machine);
        let factor = units.velocity / self.stride.units.velocity;
        if !(1.0 / FACTOR..FACTOR).contains(&factor) {
            self.stride.units.convert(&mut self.stride.from, cycle.impacts.len(), units);
            self.stride.units.convert(&mut home.1, home.0.impacts.len(), units);
            self.stride.units = units;
        }
        units.lift < tolerance::UNBOUNDED.value * units.velocity
    }

    /// End of the branch where the model allows no further value in the direction of the walk, with the reason.
    fn edge(&self, why: &FamilyError) -> End {
        End::edge(self.stride.value(&self.stride.from.tangent) > 0.0, why)
    }

    /// Returns the orbit at the last value that the model allows, where the branch runs into it.
    fn at_bound(&self, why: &FamilyError) -> Option<(BranchPoint, End)> {
        let from = &self.stride.from;
        let (count, problem) = (from.unknowns.len(), self.stride.problem());
        let span = self.stride.spans[self.stride.spans.len() - 1];
        let with = |value: f64| {
            let mut unknowns = from.unknowns.clone();
            unknowns[count - 1] = value / span;
            unknowns
        };
        let (value, slope) = (self.stride.value(&from.unknowns), from.tangent[count - 1]);
        let beyond = value + 2.0 * slope * span * self.stride.step;
        let bound = curve::limit(value, beyond, |value| problem.unpack(&with(value)).is_err())?;
        // Only the number is fixed, so that no machine beyond the model's bound is needed.
        let along = DVector::from_fn(count, |row, _| f64::from(row + 1 == count));
        let mut guess = &from.unknowns + &from.tangent * ((bound - value) / (slope * span));
        guess[count - 1] = bound / span;
        let point = curve::closed(&problem, &with(bound), &along, 0.0, guess).ok()?;
        let (cycle, machine, _) = problem.unpack(&point.unknowns).ok()?;
        // An impact without rebound leaves the cam as the orbits before it do, but no simulated flight can begin with it.
        let is_orbit = matches!(self.stride.departure(&cycle, &machine), Ok(None | Some(Departure::Elsewhere { .. })));
        let point = self.stride.branch_point(&problem, &point, None).ok().filter(|_| is_orbit)?;
        Some((point, self.edge(why)))
    }

    /// Makes one step, or the part of it up to where the cycle changes.
    fn advance(&mut self) -> Result<Option<End>, NoPoint<FamilyError>> {
        let problem = self.stride.problem();
        let next = curve::step(&problem, &self.stride.from.unknowns, &self.stride.from.tangent, self.stride.step)?;
        if next.tangent.dot(&self.stride.from.tangent) < STRAIGHT {
            return Err(NoPoint::NotClosed);
        }
        // The first of the cuts that the equations show.
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
        // Then the cuts that only the simulator sees, before that first one.
        let part_way = |step: f64| {
            Ok::<_, NoPoint<FamilyError>>((
                curve::step(&problem, &self.stride.from.unknowns, &self.stride.from.tangent, step)?,
                step,
            ))
        };
        let mut clear = match &first {
            // Where the halves of a period meet, their common equations are singular, and a multiplier is 1.
            Some(Located { cut: Cut::Halved, step, .. }) => part_way(0.5 * step)?,
            Some(Located { step, .. }) => part_way(step * (1.0 - 1e-3))?,
            None => (next.clone(), self.stride.step),
        };
        // Of two flights that touch, the simulator finds the one that touches first in time. The other may touch sooner along the step.
        for _ in 0..=self.stride.pattern.impacts.len() {
            let (cycle, at, _) = problem.unpack(&clear.0.unknowns)?;
            match self.stride.departure(&cycle, &at) {
                Ok(None) => break,
                Ok(Some(Departure::Earlier { impact, turned, .. })) => {
                    let touch = Exit::Touch { impact, turned };
                    let located = self.stride.locate(&problem, Cut::Exit(touch), clear.1)?;
                    clear = part_way(located.step * (1.0 - 1e-3))?;
                    first = Some(located);
                }
                // Either the simulator already sees the cut nearby, or a shorter step will show the event better.
                Ok(Some(_)) if first.is_some() => break,
                Ok(Some(_)) | Err(_) => return Err(NoPoint::NotClosed),
            }
        }
        let end_point = first.as_ref().map_or(next, |located| located.point.clone());
        let special = match &first {
            Some(located) => self.stride.special(&problem, located)?,
            None => None,
        };
        let smooth = match &first {
            Some(Located { cut: Cut::Exit(Exit::Corner { .. }), .. }) => {
                special.is_none_or(|special| special.kind.is_smooth_corner())
            }
            _ => false,
        };
        let mut points = Vec::new();
        let mut folds = false;
        let mut signs = Vec::new();
        // Along a continuum of orbits a multiplier is 1 up to rounding, and the sign of the rounding means nothing.
        let stands = self.stride.stands(&end_point);
        let passed = if stands { Vec::new() } else { self.stride.passed() };
        for (index, cut) in passed.into_iter().enumerate() {
            let at = |point: &CurvePoint| self.stride.measure(&problem, cut, point);
            let (end, reach) = match &first {
                // No multiplier is -1 at that cut, so a flip shortly before it is found as well.
                Some(Located { cut: Cut::Halved, step, .. }) if cut == Cut::Flip => &part_way(0.95 * step)?,
                Some(Located { step, point, .. }) if smooth => &(point.clone(), *step),
                // Just short of a graze, where the matrix has a pole.
                _ => &clear,
            };
            let [from, to] = [at(&self.stride.from)?, at(end)?];
            signs.push(to < 0.0);
            let before = self.signs.get(index).copied().unwrap_or(from < 0.0);
            let pole = matches!(self.fresh, Some(Exit::Touch { .. } | Exit::Tangent { .. }));
            // At a fold a multiplier is 1 as well.
            if before == (to < 0.0) || pole || cut == Cut::Branching && folds {
                continue;
            }
            folds |= cut == Cut::Fold;
            let located = if (from < 0.0) != (to < 0.0) {
                self.stride.locate(&problem, cut, *reach)?
            } else {
                // The root is at the corner where the step begins.
                let (point, value) = (self.stride.from.clone(), self.stride.value(&self.stride.from.unknowns));
                Located { step: 0.0, cut, point, bracket: [value; 2], residual: from.abs() }
            };
            // A sign that changes through infinity is no root.
            let small = if cut == Cut::Branching { tolerance::BRANCHING } else { tolerance::SAME_ORBIT };
            if located.residual > small.value {
                continue;
            }
            let special = self.stride.special(&problem, &located)?;
            points.push((located.step, self.stride.branch_point(&problem, &located.point, special)?));
        }
        points.sort_by(|one, two| one.0.total_cmp(&two.0));
        let mut last = self.stride.branch_point(&problem, &end_point, special)?;
        if let Some(Located { cut: Cut::Exit(exit @ Exit::Tangent { .. }), .. }) = first {
            // An impact that has become a touch has no saltation matrix. The orbit without it has a matrix.
            let (cycle, machine, _) = problem.unpack(&end_point.unknowns)?;
            if self.stride.held.is_none()
                && let Some(without) = switch::beyond(exit, &cycle, &machine)
            {
                last.orbit = PeriodicOrbit::of_cycle(&machine, without.shortest(), last.orbit.residual);
            }
        }
        if let (Some(Located { cut: Cut::Halved, .. }), (cycle, machine, _)) =
            (&first, problem.unpack(&end_point.unknowns)?)
        {
            let whole = PeriodicOrbit::of_cycle(&machine, cycle.shortest(), last.orbit.residual);
            last.orbit = special::judged(whole, special);
        }
        let grown = if end_point.steps <= 4 { 1.5 } else { 1.0 };
        drop(problem);
        self.points.extend(points.into_iter().map(|(_, point)| point));
        // A seam of the cam that is no corner gives no point of the branch.
        let silent = matches!(&first, Some(Located { cut: Cut::Exit(Exit::Corner { .. }), .. })) && special.is_none();
        if !silent {
            self.points.push(last);
        }
        self.stride.from = end_point;
        self.standing = if stands { self.standing + 1 } else { 0 };
        if self.standing == CONTINUUM {
            return Ok(Some(End::Continuum));
        }
        self.signs = if smooth { signs } else { Vec::new() };
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

    /// Switches to the cycle beyond an exit.
    fn go_over(&mut self, exit: Exit) -> Result<Option<End>, NoPoint<FamilyError>> {
        let problem = self.stride.problem();
        let values = problem.values(&self.stride.from.unknowns);
        let (cycle, machine, _) = problem.unpack(&self.stride.from.unknowns)?;
        drop(problem);
        let exit = match exit {
            Exit::Touch { impact, turned } => match least_gap::least(&cycle, &machine, impact, turned) {
                Some((_, turned)) => Exit::Touch { impact, turned },
                None => return Ok(Some(End::Lost)),
            },
            other => other,
        };
        let exhausted = if matches!(exit, Exit::Corner { .. }) { End::Lost } else { End::Graze };
        // The branch would go straight back: its direction could not be determined.
        if self.fresh.is_some() {
            return Ok(Some(exhausted));
        }
        let Some(beyond) = switch::beyond(exit, &cycle, &machine) else { return Ok(Some(End::Graze)) };
        let ended = if matches!(exit, Exit::Corner { .. }) { End::Corner } else { End::Graze };
        // A cycle whose only contact with the cam is a touch is no orbit with impacts.
        let hits = |held: &Held| !held.orbit(&beyond).impacts.is_empty();
        let held = match self.stride.held.map(|held| switch::held_beyond(held, exit).filter(hits)) {
            Some(None) => return Ok(Some(ended)),
            held => held.flatten(),
        };
        if beyond.repeats_sooner() {
            return Ok(Some(End::Shorter));
        }
        if beyond.impacts.len() > MOST_IMPACTS * beyond.revolutions as usize {
            return Ok(Some(End::Chatter));
        }
        (self.stride.pattern, self.stride.held) = (beyond.clone(), held);
        let problem = self.stride.problem();
        let unknowns = problem.unknowns(&beyond, &machine, &values);
        if problem.residual(&unknowns)?.amax() > tolerance::SAME_ORBIT.value {
            return Ok(Some(if held.is_some() { ended } else { End::Gap }));
        }
        let Ok(tangent) = switch::direction(exit, &cycle, &problem, &unknowns) else { return Ok(Some(exhausted)) };
        drop(problem);
        self.stride.from = CurvePoint { unknowns, tangent, steps: 0 };
        self.stride.step = FIRST * self.stride.following.longest_step;
        self.fresh = Some(exit);
        Ok(None)
    }
}
