//! Curves, in two numbers, of where a follower first leaves the cam and where it no longer comes to rest on it.

use std::f64::consts::TAU;

use nalgebra::{DVector, Matrix2};

use super::contact::{Contact, MANY_IMPACTS, Nowhere, Reached, Rest, contact};
use super::{BranchPoint, End, Following, HalfBranch, Kind, OnCurve, Special};
use crate::bracket::{Width, halve};
use crate::cam::apart;
use crate::flight::State;
use crate::known::Known;
use crate::orbit::curve::{self, CurvePoint, NoPoint};
use crate::orbit::{Course, Family, FamilyError, OrbitError, PeriodicOrbit, sticking};
use crate::simulate::Event;
use crate::tolerance;

/// Halvings that leave nothing of an interval of doubles.
const BINARY_DIGITS: u32 = 60;

/// The curve of the event at `special`, in both directions from the machine that has these `values`; and its point there.
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
    let Ok(point) = curve::closed(&rest, &unknowns, &along, 0.0, unknowns.clone()) else { return Ok(None) };
    let walk = |direction: f64| {
        let rest = Rest { family, spans, contact };
        let mut from = point.clone();
        let Ok(tangent) = curve::first_tangent(&rest, &from.unknowns) else { return (Vec::new(), End::Lost) };
        from.tangent = if tangent[1] * direction >= 0.0 { tangent } else { -tangent };
        Walk { rest, following, revolutions: orbit.revolutions, from, points: Vec::new() }.run()
    };
    let Ok(middle) = rest.branch_point(&point, orbit.revolutions, Some(special)) else { return Ok(None) };
    Ok(Some((middle, [-1.0, 1.0].map(walk))))
}

struct Walk<'a> {
    rest: Rest<'a>,
    following: &'a Following,
    revolutions: u64,
    from: CurvePoint,
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
                    if step < tolerance::SHORTEST_STEP.value * longest {
                        let end = self.stopped();
                        return (self.points, end);
                    }
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
        let reached = self.rest.reached(&next.unknowns)?;
        if self.rest.contact.is_at(reached.contact) {
            self.points.push(self.rest.branch_point(&next, self.revolutions, None)?);
            let (machine, _) = self.rest.machine(&next.unknowns)?;
            self.rest.contact = self.rest.contact.told(&machine, &reached);
            self.from = next;
            return Ok(None);
        }
        // Two places at once: up to there, and on from there in the direction of the other.
        let is_beyond = |step: f64| {
            let reached = self.rest.reached(&reach(step)?.unknowns)?;
            Ok::<_, NoPoint<Nowhere>>(!self.rest.contact.is_at(reached.contact))
        };
        let ends = halve([0.0, step], Width::Halvings(BINARY_DIGITS), is_beyond)?;
        let [before, beyond] = [reach(ends[0])?, reach(ends[1])?];
        let mut bracket = [value(&before), value(&beyond)];
        bracket.sort_by(f64::total_cmp);
        let residual = ends[1] - ends[0];
        let special = Special { kind: Kind::Place, bracket, residual };
        self.points.push(self.rest.branch_point(&before, self.revolutions, Some(special))?);
        self.rest.contact = reached.contact;
        let tangent = curve::first_tangent(&self.rest, &beyond.unknowns)?;
        let onward = tangent.dot(&self.from.tangent) >= 0.0;
        self.from = CurvePoint { tangent: if onward { tangent } else { -tangent }, ..beyond };
        Ok(None)
    }

    /// What the curve comes to where no step leads on.
    fn stopped(&self) -> End {
        let here = self.rest.machine(&self.from.unknowns).ok().zip(self.rest.reached(&self.from.unknowns).ok());
        let Some(((machine, _), Reached { impacts, contact, .. })) = here else { return End::OtherWay };
        // The impacts that are told one by one; those after them are at no corner but the last.
        let told = if let Contact::Resting { impact, .. } = contact { impact } else { 0 };
        let corners = machine.cam().corners();
        let at_corner = |event: &Event| {
            let near = |angle: f64| apart(angle, event.cam_angle) < tolerance::SAME_ORBIT.value;
            corners.iter().any(|corner| corner.jump_order <= 2 && near(corner.angle))
        };
        match () {
            () if impacts.len() > MANY_IMPACTS / 2 => End::Endless,
            () if impacts.iter().take(told).any(at_corner) => End::Kink,
            () => End::OtherWay,
        }
    }

    /// The point at a value of the second number.
    fn end_at(&mut self, bound: f64) -> Result<(), NoPoint<Nowhere>> {
        let mut base = self.from.unknowns.clone();
        base[1] = bound / self.rest.spans[1];
        let slope = self.from.tangent[0] / self.from.tangent[1];
        let mut guess = base.clone();
        guess[0] += slope * (base[1] - self.from.unknowns[1]);
        let point = curve::closed(&self.rest, &base, &DVector::from_vec(vec![0.0, 1.0]), 0.0, guess)?;
        self.points.push(self.rest.branch_point(&point, self.revolutions, None)?);
        Ok(())
    }

    /// On to the last value that the model allows, where the curve runs into it.
    fn on_to_limit(&mut self, step: f64, why: &FamilyError) -> Option<End> {
        let (value, slope) = (self.from.unknowns[1] * self.rest.spans[1], self.from.tangent[1] * self.rest.spans[1]);
        let is_refused =
            |value: f64| self.rest.family.machine(&[self.from.unknowns[0] * self.rest.spans[0], value]).is_err();
        let bound = curve::limit(value, value + 2.0 * slope * step, is_refused)?;
        self.end_at(bound).ok()?;
        Some(End::edge(slope > 0.0, why))
    }
}

impl Rest<'_> {
    fn branch_point(
        &self,
        point: &CurvePoint,
        revolutions: u64,
        special: Option<Special>,
    ) -> Result<BranchPoint, NoPoint<Nowhere>> {
        let (machine, rpm) = self.machine(&point.unknowns)?;
        let Reached { off, contact, mut impacts } = self.reached(&point.unknowns)?;
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
            matrix: Matrix2::zeros(),
            residual: off.abs(),
            course: Course::Sticking(anchor),
            known: Known::Computed,
        };
        let held = Some(OnCurve { cam_angle, sides: vec![Matrix2::zeros()] });
        Ok(BranchPoint { rpm, value: point.unknowns[1] * self.spans[1], orbit, held, special })
    }
}
