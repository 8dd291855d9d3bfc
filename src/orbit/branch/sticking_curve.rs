//! Curves, in two numbers, on which a follower first leaves the cam, or no longer comes to rest on it.

use std::f64::consts::{PI, TAU};

use nalgebra::{DVector, Matrix2};

use super::sticking_event::{Contact, MANY_IMPACTS, Nowhere, Reached, Rest, contact};
use super::{BranchPoint, End, Following, HalfBranch, OnCurve, Special, SpecialKind};
use crate::bracket::{Width, halve};
use crate::cam::{Corner, apart};
use crate::elementary;
use crate::flight::State;
use crate::known::Evidence;
use crate::orbit::curve::{self, CurvePoint, NoPoint};
use crate::orbit::{Course, Family, FamilyError, Judgement, OrbitError, PeriodicOrbit, sticking};
use crate::simulate::{Event, Machine};
use crate::tolerance;

/// Radius around a kink at which the curve is looked for, in units of the longest step.
const AROUND: f64 = 0.05;

/// Small step, relative to the spans, that shows which way a curve goes on.
const TRIAL: f64 = 1e-6;

/// Halvings that narrow an interval of doubles down to neighbours.
const BINARY_DIGITS: u32 = 60;

/// Follows the curve of the event at `special` in both directions from the machine with these `values`. Also returns its point there.
pub(super) fn curve(
    family: &Family,
    (values, spans): ([f64; 2], [f64; 2]),
    orbit: &PeriodicOrbit,
    special: Special,
    following: &Following,
) -> Result<Option<(BranchPoint, [HalfBranch; 2])>, OrbitError> {
    let (machine, _) = family.machine(&values)?;
    let Some(contact) = contact(special.kind, orbit, &machine) else { return Ok(None) };
    let unknowns = DVector::from_fn(2, |index, _| values[index] / spans[index]);
    let along = DVector::from_vec(vec![0.0, 1.0]);
    let rest = Rest { family, spans, contact };
    let Ok(point) = rest.settled(&unknowns, &along) else { return Ok(None) };
    let walk = |direction: f64| {
        let rest = Rest { family, spans, contact };
        let mut from = point.clone();
        let Ok(tangent) = curve::first_tangent(&rest, &from.unknowns) else { return (Vec::new(), End::Lost) };
        from.tangent = if tangent[1] * direction >= 0.0 { tangent } else { -tangent };
        let regions = rest.regions(&from.unknowns).unwrap_or_default();
        Walk { rest, following, revolutions: orbit.revolutions, from, regions, points: Vec::new() }.run()
    };
    let Ok(middle) = rest.branch_point(&point.unknowns, &along, orbit.revolutions, Some(special)) else {
        return Ok(None);
    };
    Ok(Some((middle, [-1.0, 1.0].map(walk))))
}

struct Walk<'a> {
    rest: Rest<'a>,
    following: &'a Following,
    revolutions: u64,
    from: CurvePoint,
    /// For each impact that is tracked one by one, the number of kinks before it.
    regions: Vec<usize>,
    points: Vec<BranchPoint>,
}

impl Walk<'_> {
    fn run(mut self) -> HalfBranch {
        let longest = self.following.longest_step;
        let mut step = longest;
        loop {
            if self.points.len() >= self.following.most_points {
                return (self.points, End::MostPoints);
            }
            match self.advance(step) {
                Ok(None) => step = longest.min(1.5 * step),
                Ok(Some(end)) => return (self.points, end),
                Err(error) => {
                    if let NoPoint::Outside(Nowhere::Refused(why)) = &error
                        && let Some(end) = self.on_to_limit(step, why)
                    {
                        return (self.points, end);
                    }
                    step *= 0.5;
                    if step >= tolerance::SHORTEST_STEP.value * longest {
                        continue;
                    }
                    // Each turn adds a point, and the number of points is limited.
                    if !self.turn() {
                        let end = self.stopped(&error);
                        return (self.points, end);
                    }
                    step = AROUND * longest;
                }
            }
        }
    }

    fn advance(&mut self, step: f64) -> Result<Option<End>, NoPoint<Nowhere>> {
        let reach = |step: f64| curve::step(&self.rest, &self.from.unknowns, &self.from.tangent, step);
        let next = reach(step)?;
        let value = |point: &CurvePoint| point.unknowns[1] * self.rest.spans[1];
        let [low, high] = self.following.range;
        if !(low..=high).contains(&value(&next)) {
            let bound = if value(&next) < low { low } else { high };
            self.end_at(bound)?;
            return Ok(Some(End::Range));
        }
        if self.rest.contact.is_first(&self.rest.machine(&next.unknowns)?.0) {
            let (unknowns, reached) = self.rest.refined(&next.unknowns, &next.tangent)?;
            let (machine, _) = self.rest.machine(&unknowns)?;
            let regions = regions(&machine, &reached);
            // Beyond a kink, the solution may be on another part of the curve.
            if regions.iter().zip(&self.regions).any(|(one, other)| one != other) {
                return Err(NoPoint::NotClosed);
            }
            let [contact, _] = reached.contact.told(&machine, &reached);
            self.points.push(self.rest.reached_point(&unknowns, reached, self.revolutions, None)?);
            (self.from, self.regions) = (CurvePoint { unknowns, ..next }, regions);
            self.rest.contact = contact;
            return Ok(None);
        }
        // Two places are first at once: this one up to there, and the other one from there.
        let is_beyond = |step: f64| {
            let (machine, _) = self.rest.machine(&reach(step)?.unknowns)?;
            Ok::<_, NoPoint<Nowhere>>(self.rest.contact.behind(&machine) > 0.0)
        };
        let ends = halve([0.0, step], Width::Halvings(BINARY_DIGITS), is_beyond)?;
        let [before, beyond] = [reach(ends[0])?, reach(ends[1])?];
        let mut bracket = [value(&before), value(&beyond)];
        bracket.sort_by(f64::total_cmp);
        let special = Special { kind: SpecialKind::Place, bracket, residual: ends[1] - ends[0] };
        let contact = Contact::first(&self.rest.machine(&beyond.unknowns)?.0).ok_or(Nowhere::OtherWay)?;
        let other = Rest { contact, ..self.rest };
        let tangent = curve::first_tangent(&other, &beyond.unknowns)?;
        // In one direction along the other curve the follower leaves the cam first at the other place, in the opposite direction at this
        // one.
        let behind = [TRIAL, -TRIAL].map(|step| {
            let machine = other.machine(&(&beyond.unknowns + &tangent * step));
            machine.map_or(f64::INFINITY, |(machine, _)| contact.behind(&machine))
        });
        let tangent = if behind[0] < behind[1] { tangent } else { -tangent };
        self.points.push(self.rest.branch_point(&before.unknowns, &before.tangent, self.revolutions, Some(special))?);
        (self.rest, self.from) = (other, CurvePoint { tangent, ..beyond });
        Ok(None)
    }

    /// Continues from a kink, where an impact on the way to the rest is at a corner. On a small circle around the kink the equation changes
    /// its sign where the curve arrives and where it leaves, in whatever direction. Returns whether the curve continues.
    fn turn(&mut self) -> bool {
        let Some(((kind, residual), on)) = self.at_corner().zip(self.beyond_kink()) else { return false };
        let Ok(point) = self.rest.branch_point(&on.unknowns, &on.tangent, self.revolutions, None) else { return false };
        let Ok(regions) = self.rest.regions(&on.unknowns) else { return false };
        if let Some(last) = self.points.last_mut() {
            let bracket = [last.value.min(point.value), last.value.max(point.value)];
            last.special = Some(Special { kind, bracket, residual });
        }
        self.points.push(point);
        self.regions = regions;
        self.from = on;
        true
    }

    /// Point where the curve leaves a kink, on the first of three circles on which it is distinct from the curve's arrival.
    fn beyond_kink(&self) -> Option<CurvePoint> {
        [0.1, 0.01, 1.0].into_iter().find_map(|part| self.on_circle(part * AROUND * self.following.longest_step))
    }

    fn on_circle(&self, radius: f64) -> Option<CurvePoint> {
        /// Least angle from the curve's arrival, rad, and ratio of each angle to the one before: both ways may be close together.
        const LEAST: f64 = 0.002;
        const RATIO: f64 = 1.5;
        let kink = &self.from.unknowns;
        let away = |point: &BranchPoint| {
            DVector::from_vec(vec![point.rpm / self.rest.spans[0], point.value / self.rest.spans[1]]) - kink
        };
        // Direction from the kink back to the last point outside of the circle.
        let back = self.points.iter().rev().map(away).find(|away| away.norm() >= radius)?.normalize();
        let direction = |turn: f64| {
            let (sin, cos) = elementary::sin_cos(turn);
            DVector::from_vec(vec![cos * back[0] - sin * back[1], sin * back[0] + cos * back[1]])
        };
        let off = |turn: f64| self.rest.reached(&(kink + direction(turn) * radius)).ok().map(|reached| reached.off);
        let turns: Vec<f64> =
            std::iter::successors(Some(LEAST), |turn| Some(RATIO * turn)).take_while(|turn| *turn < PI).collect();
        let around = turns.iter().rev().map(|turn| -turn).chain(turns.iter().copied());
        let seen: Vec<(f64, Option<f64>)> =
            [-PI].into_iter().chain(around).chain([PI]).map(|turn| (turn, off(turn))).collect();
        let mut passed = Vec::new();
        for pair in seen.windows(2) {
            if let [(from, Some(one)), (to, Some(two))] = *pair
                && (one < 0.0) != (two < 0.0)
            {
                let is_beyond = |turn: f64| off(turn).map(|off| (off < 0.0) != (one < 0.0)).ok_or(());
                passed.push(halve([from, to], Width::Halvings(BINARY_DIGITS), is_beyond).ok()?[0]);
            }
        }
        let along = direction(onward(passed)?);
        curve::closed(&self.rest, kink, &along, radius, kink + &along * radius).ok()
    }

    /// The corner nearest to an impact on the way, and the distance, rad.
    fn at_corner(&self) -> Option<(SpecialKind, f64)> {
        let (machine, _) = self.rest.machine(&self.from.unknowns).ok()?;
        let reached = self.rest.contact.reached(&machine)?;
        let corners: Vec<Corner> = kinks(&machine).collect();
        let pairs = told(&reached).iter().enumerate().flat_map(|at| corners.iter().map(move |corner| (at, corner)));
        let off = pairs.map(|((impact, event), corner)| (impact, corner, apart(corner.angle, event.cam_angle)));
        let (impact, corner, off) = off.min_by(|one, two| one.2.total_cmp(&two.2))?;
        let kind = SpecialKind::Corner { impact, segment: corner.segment, jump_order: corner.jump_order };
        (off < tolerance::KINK.value).then_some((kind, off))
    }

    /// End of the curve if no step leads further.
    fn stopped(&self, error: &NoPoint<Nowhere>) -> End {
        let reached = self.rest.reached(&self.from.unknowns);
        match () {
            () if reached.is_ok_and(|reached| reached.impacts.len() > MANY_IMPACTS / 2) => End::Endless,
            () if self.at_corner().is_some() => End::Kink,
            () if matches!((error, self.rest.contact), (NoPoint::NotClosed, Contact::Resting { .. })) => End::Lost,
            () => End::OtherWay,
        }
    }

    /// Adds the point of the curve at a value of the second number.
    fn end_at(&mut self, bound: f64) -> Result<(), NoPoint<Nowhere>> {
        let slope = self.from.tangent[0] / self.from.tangent[1];
        let mut guess = self.from.unknowns.clone();
        guess[1] = bound / self.rest.spans[1];
        guess[0] += slope * (guess[1] - self.from.unknowns[1]);
        let along = DVector::from_vec(vec![0.0, 1.0]);
        let point = self.rest.settled(&guess, &along)?;
        if !self.rest.contact.is_first(&self.rest.machine(&point.unknowns)?.0) {
            return Err(NoPoint::NotClosed);
        }
        self.points.push(self.rest.branch_point(&point.unknowns, &along, self.revolutions, None)?);
        Ok(())
    }

    /// Continues to the last value that the model allows, where the curve runs into it.
    fn on_to_limit(&mut self, step: f64, why: &FamilyError) -> Option<End> {
        let (value, slope) = (self.from.unknowns[1] * self.rest.spans[1], self.from.tangent[1] * self.rest.spans[1]);
        let is_refused =
            |value: f64| self.rest.family.machine(&[self.from.unknowns[0] * self.rest.spans[0], value]).is_err();
        let bound = curve::limit(value, value + 2.0 * slope * step, is_refused)?;
        self.end_at(bound).ok()?;
        Some(End::edge(slope > 0.0, why))
    }
}

/// Corners at which the velocity or the acceleration of the lift jumps. An impact there makes a kink in a curve.
fn kinks(machine: &Machine) -> impl Iterator<Item = Corner> {
    machine.cam().corners().iter().copied().filter(|corner| corner.jump_order <= 2)
}

/// Chooses the way that leads on from two ways, given as angles from the curve's arrival: the wider one. `None` unless the other is much
/// nearer to the arrival, since then either may be the way back.
pub fn onward(mut ways: Vec<f64>) -> Option<f64> {
    /// Largest ratio of the other angle to the wider one.
    const CLOSER: f64 = 0.2;
    ways.sort_by(|one, two| one.abs().total_cmp(&two.abs()));
    let [came, onward] = ways[..] else { return None };
    (came.abs() <= CLOSER * onward.abs()).then_some(onward)
}

/// Impacts that are tracked one by one. Impacts after these are at no corner except the last one.
fn told(reached: &Reached) -> &[Event] {
    let told = if let Contact::Resting { impact, .. } = reached.contact { impact } else { 0 };
    &reached.impacts[..told.min(reached.impacts.len())]
}

/// For each tracked impact, the number of kinks before it, counted around the cam.
fn regions(machine: &Machine, reached: &Reached) -> Vec<usize> {
    let angles: Vec<f64> = kinks(machine).map(|corner| corner.angle).collect();
    let region = |event: &Event| angles.iter().filter(|angle| **angle <= event.cam_angle).count() % angles.len().max(1);
    told(reached).iter().map(region).collect()
}

impl Rest<'_> {
    fn regions(&self, unknowns: &DVector<f64>) -> Result<Vec<usize>, Nowhere> {
        let (machine, _) = self.machine(unknowns)?;
        self.contact.reached(&machine).map(|reached| regions(&machine, &reached)).ok_or(Nowhere::OtherWay)
    }

    /// Solves for the point of the curve across `along`, from one near it.
    fn settled(&self, near: &DVector<f64>, along: &DVector<f64>) -> Result<CurvePoint, NoPoint<Nowhere>> {
        /// Largest difference, in spans, between the points that different impacts give.
        const MOVED: f64 = 1e-4;
        curve::closed(self, &(near - along * MOVED), along, MOVED, near.clone())
    }

    /// Refines the point across `along`, near one, by later and later impacts, until the last one is used or the point no longer moves.
    /// Also returns the evaluation there. Fails if the next impact gives another point.
    fn refined(&self, near: &DVector<f64>, along: &DVector<f64>) -> Result<(DVector<f64>, Reached), NoPoint<Nowhere>> {
        /// Most steps from one impact to a later one.
        const STEPS: usize = 50;
        let mut unknowns = near.clone();
        let mut reached = self.reached(&unknowns)?;
        let mut moved = f64::INFINITY;
        for _ in 0..STEPS {
            if reached.contact.is_exact(&reached) {
                return Ok((unknowns, reached));
            }
            let [_, contact] = reached.contact.told(&self.machine(&unknowns)?.0, &reached);
            let later = Rest { contact, ..*self };
            let next = later.settled(&unknowns, along);
            let Some(next) = next.ok().filter(|_| contact != reached.contact) else { break };
            moved = (&next.unknowns - &unknowns).norm();
            reached = later.reached(&next.unknowns)?;
            unknowns = next.unknowns;
        }
        // Rounding errors of a run grow from impact to impact as well. A point that still moves because of them is not on the curve.
        if moved <= tolerance::SAME_ORBIT.value { Ok((unknowns, reached)) } else { Err(NoPoint::NotClosed) }
    }

    fn branch_point(
        &self,
        near: &DVector<f64>,
        along: &DVector<f64>,
        revolutions: u64,
        special: Option<Special>,
    ) -> Result<BranchPoint, NoPoint<Nowhere>> {
        let (unknowns, reached) = self.refined(near, along)?;
        Ok(self.reached_point(&unknowns, reached, revolutions, special)?)
    }

    fn reached_point(
        &self,
        unknowns: &DVector<f64>,
        Reached { off, contact, mut impacts }: Reached,
        revolutions: u64,
        special: Option<Special>,
    ) -> Result<BranchPoint, Nowhere> {
        let (machine, rpm) = self.machine(unknowns)?;
        let cam_angle = match contact {
            Contact::Detachment(place) => place.cam_angle,
            Contact::Resting { to, impact, .. } => {
                impacts.truncate(impact.saturating_add(1));
                to.cam_angle
            }
        };
        let anchor = if cam_angle < TAU { cam_angle } else { 0.0 };
        let unknown = State { position: f64::NAN, velocity: f64::NAN };
        let orbit = PeriodicOrbit {
            revolutions,
            events: impacts,
            state: sticking::at_zero(&machine, anchor).unwrap_or(unknown),
            matrix: sticking::matrix(&machine),
            judgement: Judgement::of_rest(&machine),
            residual: off.abs(),
            course: Course::Sticking(anchor),
            known: Evidence::Computed,
        };
        let held = Some(OnCurve { cam_angle, sides: vec![Matrix2::zeros()], class: None });
        Ok(BranchPoint { rpm, value: unknowns[1] * self.spans[1], orbit, held, special })
    }
}
