//! Events of a follower on the cam: where it first leaves the cam, and where it no longer comes to rest on it. Each is one equation in two
//! numbers of the model.
//!
//! Detachment: for a follower that moves with the cam, the greatest acceleration of the gap is 0. Its place is kept until another place
//! becomes the first.
//!
//! Onset of resting: the infinitely many impacts after a release end just where the cam releases the follower. If this is a corner, the law
//! before it is continued, and the impacts end on the continued law. If the release is smooth, the gap's acceleration is -J tau at a time
//! tau before, and impacts shrink towards it self-similarly: from tau to (1 - d) tau each, at
//!
//! ```text
//! u = rho J tau^2,   rho = d/2 - d^2/6 = r (d/2 - d^2/3)/(1 - d)^2
//! ```
//!
//! A faster follower passes the place, a slower one rests. The error of this law at an impact is of the size tau^2, and deviations from rho
//! grow from one impact to the next. So a later impact locates the event better, but needs a nearer start.

use std::convert::Infallible;
use std::f64::consts::TAU;
use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector};

use super::SpecialKind;
use crate::bracket::{Width, halve};
use crate::cam::{Lift, Segment, Side, apart, within_a_turn};
use crate::orbit::curve::Equations;
use crate::orbit::cycle::lift_size;
use crate::orbit::{Course, Family, FamilyError, PeriodicOrbit};
use crate::simulate::{Event, EventKind, Goal, Machine};
use crate::tolerance;

/// Place where the cam releases the follower.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    pub(super) segment: usize,
    /// Cam angle, rad; at a corner the start of the segment.
    pub(super) cam_angle: f64,
    pub(super) is_corner: bool,
}

/// Most impacts before a rest that are counted.
pub(super) const MANY_IMPACTS: usize = 20_000;

/// Event that a curve follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Contact {
    /// Detachment of the follower at a place.
    Detachment(Place),
    /// Flight of the follower from one place to a rest at another, or the same, after `turned`, rad. The impact with index `impact` on the
    /// way shows where the impacts end.
    Resting { from: Place, to: Place, turned: f64, impact: usize },
}

/// Evaluation of the event at two numbers.
pub(super) struct Reached {
    /// Residual: for a detachment in units of the cam's lift per radian squared, for a rest in rad.
    pub(super) off: f64,
    /// The event, at its places here.
    pub(super) contact: Contact,
    pub(super) impacts: Vec<Event>,
}

pub(super) struct Rest<'a> {
    pub(super) family: &'a Family,
    pub(super) spans: [f64; 2],
    pub(super) contact: Contact,
}

/// Greatest acceleration of the gap over omega^2, m/rad^2, among the wanted places, and its place.
fn greatest(machine: &Machine, is_wanted: impl Fn(Place) -> bool) -> Option<(f64, Place)> {
    /// Samples of a segment; between two of them designed cams have one extreme at most.
    const SAMPLES: usize = 64;
    let (cam, segments) = (machine.cam(), machine.cam().segments());
    let mut jumps = vec![false; segments.len()];
    cam.corners().iter().filter(|corner| corner.jump_order <= 2).for_each(|corner| jumps[corner.segment] = true);
    // On a dwell on which a slack spring does not press, the acceleration is 0 at every speed.
    let is_slack = |segment: &Segment| {
        let lift = segment.law.lift(segment.start);
        segment.bounds.slope == [0.0; 2] && machine.lifting(&lift).abs() <= machine.lifting_rate(&lift).1
    };
    let mut best: Option<(f64, Place)> = None;
    for (index, segment) in segments.iter().enumerate() {
        let at = |part: usize| segment.start + (segment.end - segment.start) * part as f64 / SAMPLES as f64;
        let lift = |angle: f64| segment.law.lift(angle);
        let mut keep = |cam_angle: f64, place: Place| {
            let lifting = machine.lifting(&lift(cam_angle)) / machine.angular_velocity().powi(2);
            if is_wanted(place) && best.is_none_or(|(most, _)| lifting > most) {
                best = Some((lifting, place));
            }
        };
        let rises = |angle: f64| machine.lifting_rate(&lift(angle)).0 > 0.0;
        // At a jump either side may be the greatest. Elsewhere segments meet within a rise or a fall, or at a maximum.
        let next = (index + 1) % segments.len();
        let rises_behind = machine.lifting_rate(&segments[next].law.lift(segments[next].start)).0 > 0.0;
        if is_slack(segment) {
            continue;
        }
        if jumps[index] {
            keep(segment.start, Place { segment: index, cam_angle: segment.start, is_corner: true });
        }
        if !is_slack(&segments[next]) && (jumps[next] || rises(segment.end) && !rises_behind) {
            keep(segment.end, Place { segment: next, cam_angle: segments[next].start, is_corner: true });
        }
        for part in 0..SAMPLES {
            if rises(at(part)) && !rises(at(part + 1)) {
                let width = Width::Relative(tolerance::ROOT_WIDTH.value);
                let Ok([cam_angle, _]) = halve([at(part), at(part + 1)], width, |x| Ok::<_, Infallible>(!rises(x)));
                keep(cam_angle, Place { segment: index, cam_angle, is_corner: false });
            }
        }
    }
    best
}

/// Cam angle, rad, near `cam_angle` where the cam would release the follower by the law of a segment, and the lift there. `None` if it
/// would not.
fn lets_go(machine: &Machine, segment: &Segment, mut cam_angle: f64) -> Option<(f64, Lift)> {
    /// Most Newton steps. They double the digits of a place that is known to a step along the curve.
    const STEPS: usize = 20;
    let mut lift = segment.law.lift(cam_angle);
    for _ in 0..STEPS {
        cam_angle -= machine.angular_velocity() * machine.lifting(&lift) / machine.lifting_rate(&lift).0;
        lift = segment.law.lift(cam_angle);
    }
    (machine.lifting_rate(&lift).0 > 0.0).then_some((cam_angle, lift))
}

impl Place {
    /// Whether this is the same place of the cam as another, a step along the curve apart. A smooth place may run into a corner.
    fn is_near(self, other: Self) -> bool {
        apart(self.cam_angle, other.cam_angle) < tolerance::NEIGHBOURING.value
    }

    /// The place of the release `event`.
    pub(super) fn of(event: &Event, machine: &Machine) -> Self {
        let start = machine.cam().segments()[event.segment].start;
        let is_corner = (event.cam_angle - start).abs() <= tolerance::CORNER_ANGLE.value;
        Self { segment: event.segment, cam_angle: event.cam_angle, is_corner }
    }

    /// The place on another machine. `None` if that cam does not release the follower nearby.
    fn on(self, machine: &Machine) -> Option<Self> {
        /// Number of segments that the place may move to.
        const SEGMENTS: usize = 3;
        let cam = machine.cam();
        if self.is_corner {
            let cam_angle = cam.segments()[self.segment].start;
            let lift = cam.segments()[self.segment].law.lift(cam_angle);
            return (machine.lifting(&lift) > 0.0).then_some(Self { cam_angle, ..self });
        }
        let mut on = self;
        for _ in 0..SEGMENTS {
            let segment = &cam.segments()[on.segment];
            (on.cam_angle, _) = lets_go(machine, segment, on.cam_angle)?;
            if (segment.start..=segment.end).contains(&on.cam_angle) {
                return Some(on);
            }
            // The place has moved to another segment, or past angle 0.
            on.cam_angle = within_a_turn(on.cam_angle);
            on.segment = cam.segment_at(on.cam_angle);
        }
        None
    }

    /// Angle, rad, by which the infinitely many impacts from `last` on end beyond this place, which is `left`, rad, ahead of `last`. `None`
    /// if they do not arrive here by the law before.
    fn passed(self, machine: &Machine, last: &Event, left: f64) -> Option<f64> {
        if self.is_corner {
            return self.rest_beyond(machine, last, left).map(|turn| turn - left);
        }
        let relative = last.velocity_after - last.cam_velocity;
        let (further, lift) = self.by_law_of(machine, last.segment, left)?;
        let time = (relative / (alike(machine.restitution()) * machine.lifting_rate(&lift).0)).sqrt();
        let off = machine.angular_velocity() * time - (left + further);
        off.is_finite().then_some(off)
    }

    /// Angle from `last` at which infinitely many impacts end, rad, by the law before the corner, continued past it.
    fn rest_beyond(self, machine: &Machine, last: &Event, left: f64) -> Option<f64> {
        /// Largest length by which the law is continued, rad; it is at most half of the segment behind.
        const REACH: f64 = 0.05;
        let cam = machine.cam();
        let corner = cam.corners().iter().find(|corner| corner.segment == self.segment)?;
        let behind = &cam.segments()[self.segment];
        let reach = REACH.min(0.5 * (behind.end - behind.start));
        let machine = machine.with_cam(cam.continued(corner, Side::Minus, reach)?);
        let motion = machine.start_on_cam(last.cam_angle, last.velocity_after - last.cam_velocity).ok()?;
        let mut motion = motion.with_each_impact();
        let end = last.cam_angle + left + reach;
        let mut rest = None;
        let _ = machine.advance(&mut motion, Goal::turned(end), &mut |event: &Event| {
            rest = (event.kind == EventKind::Stick).then(|| event.turned_since(last.cam_angle));
            if rest.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        rest
    }

    /// Angle, rad, by which the cam would release the follower later by the law of a segment, and the lift there. Right behind a seam, as
    /// between rows of a table, all impacts but the last follow the law of an earlier segment. `None` if the angle is not less than the
    /// distance `left` from an impact to the place.
    fn by_law_of(self, machine: &Machine, segment: usize, left: f64) -> Option<(f64, Lift)> {
        let here = self.cam_angle + if segment > self.segment { TAU } else { 0.0 };
        let (cam_angle, lift) = lets_go(machine, &machine.cam().segments()[segment], here)?;
        ((cam_angle - here).abs() < left).then_some((cam_angle - here, lift))
    }

    /// Index of the segment before the place, on which a follower rests.
    pub(super) fn before(self, machine: &Machine) -> usize {
        if self.is_corner { machine.cam().before(self.segment) } else { self.segment }
    }
}

/// rho of the impacts that shrink self-similarly towards a smooth release.
pub(super) fn alike(restitution: f64) -> f64 {
    let is_beyond = |d: f64| Ok::<_, Infallible>((0.5 - d / 6.0) * (1.0 - d).powi(2) < restitution * (0.5 - d / 3.0));
    let Ok([d, _]) = halve([0.0, 1.0], Width::Absolute(tolerance::ROOT_WIDTH.value), is_beyond);
    d / 2.0 - d * d / 6.0
}

impl Contact {
    /// The place where a follower that moves with the cam first leaves it.
    pub(super) fn first(machine: &Machine) -> Option<Self> {
        greatest(machine, |_| true).map(|(_, place)| Self::Detachment(place))
    }

    /// Excess of the greatest acceleration of the gap over the one at this place, in units of the cam's lift per radian squared; 0 for a
    /// rest.
    pub(super) fn behind(self, machine: &Machine) -> f64 {
        let Self::Detachment(here) = self else { return 0.0 };
        let of = |found: Option<(f64, Place)>| found.map_or(f64::NEG_INFINITY, |(lifting, _)| lifting);
        let [here, first] = [greatest(machine, |place| place.is_near(here)), greatest(machine, |_| true)].map(of);
        (first - here) / lift_size(machine)
    }

    /// Whether this is the place where the follower first leaves the cam, up to rounding. On a cam that is its own mirror image, two places
    /// are first at once all along a curve.
    pub(super) fn is_first(self, machine: &Machine) -> bool {
        self.behind(machine) <= tolerance::CYCLE_CLOSED.value
    }

    /// Evaluates the event on a machine; `None` if the follower goes another way.
    pub(super) fn reached(self, machine: &Machine) -> Option<Reached> {
        match self {
            Self::Detachment(place) => {
                let (off, place) = greatest(machine, |other| other.is_near(place))?;
                let off = off / lift_size(machine);
                Some(Reached { off, contact: Self::Detachment(place), impacts: Vec::new() })
            }
            Self::Resting { from, to, turned, impact } => {
                let [from, to] = [from.on(machine)?, to.on(machine)?];
                let turns = ((turned + from.cam_angle - to.cam_angle) / TAU).round();
                let turned = turns * TAU + to.cam_angle - from.cam_angle;
                let impacts = flown(machine, from.cam_angle, turned)?;
                let passed = |impact: usize| {
                    let event: &Event = impacts.get(impact)?;
                    to.passed(machine, event, turned - event.turned_since(from.cam_angle))
                };
                let last = impacts.len().checked_sub(1)?;
                // An impact may have moved to the law of an earlier segment, as at a row of a table. Then the first later impact that has
                // not is used.
                let (impact, off) = (impact.min(last)..=last).find_map(|later| Some((later, passed(later)?)))?;
                Some(Reached { off, contact: Self::Resting { from, to, turned, impact }, impacts })
            }
        }
    }

    /// Whether no later impact would locate the event better.
    pub(super) fn is_exact(self, reached: &Reached) -> bool {
        let Self::Resting { from, to, turned, impact } = self else { return true };
        let mut later = reached.impacts.iter().skip(impact).skip(1);
        to.is_corner || !later.any(|event| turned - event.turned_since(from.cam_angle) > tolerance::CHATTER_LEFT.value)
    }

    /// Locates the event by two impacts: the first one near the end, and the last one that is still on its way there. The first stays the
    /// same over long steps along the curve. The last locates the end better, since the error of the equation shrinks from one impact to
    /// the next. Before a corner there is no error, and both are the first.
    pub(super) fn told(self, machine: &Machine, reached: &Reached) -> [Self; 2] {
        /// Distance from their end, rad, within which impacts nearly follow the known law.
        const ALIKE: f64 = 0.05;
        /// Largest error of an impact, relative to its distance from the place, from which Newton's method converges.
        const FOLLOWED: f64 = 0.1;
        let Self::Resting { from, to, turned, .. } = reached.contact else { return [reached.contact; 2] };
        let left = |event: &Event| turned - event.turned_since(from.cam_angle);
        let is_on_its_way = |event: &Event| {
            if to.is_corner {
                return event.segment == to.before(machine);
            }
            let off = to.passed(machine, event, left(event));
            left(event) > tolerance::CHATTER_LEFT.value && off.is_some_and(|off| off.abs() < FOLLOWED * left(event))
        };
        let last = reached.impacts.iter().rposition(is_on_its_way);
        let first = reached.impacts.iter().position(|event| left(event) < ALIKE).or(last);
        let last = if to.is_corner { first } else { last };
        [first, last].map(|impact| impact.map_or(reached.contact, |impact| Self::Resting { from, to, turned, impact }))
    }
}

/// Returns the impacts of a follower that the cam releases at `cam_angle`, for `turned`, rad, or until it rests.
pub(super) fn flown(machine: &Machine, cam_angle: f64, turned: f64) -> Option<Vec<Event>> {
    let mut motion = machine.start_on_cam(cam_angle, 0.0).ok()?.with_each_impact();
    let mut impacts = Vec::new();
    let _ = machine.advance(&mut motion, Goal::turned(cam_angle + turned), &mut |event: &Event| match event.kind {
        EventKind::Impact if impacts.len() == MANY_IMPACTS => ControlFlow::Break(()),
        EventKind::Impact => {
            impacts.push(*event);
            ControlFlow::Continue(())
        }
        EventKind::Stick => ControlFlow::Break(()),
        EventKind::Release => ControlFlow::Continue(()),
    });
    (impacts.len() < MANY_IMPACTS).then_some(impacts)
}

/// Reason why the equation cannot be evaluated.
#[derive(Clone, Debug)]
pub(super) enum Nowhere {
    Refused(FamilyError),
    OtherWay,
}

impl Rest<'_> {
    pub(super) fn machine(&self, unknowns: &DVector<f64>) -> Result<(Machine, f64), Nowhere> {
        let values = [0, 1].map(|index| unknowns[index] * self.spans[index]);
        self.family.machine(&values).map_err(Nowhere::Refused)
    }

    pub(super) fn reached(&self, unknowns: &DVector<f64>) -> Result<Reached, Nowhere> {
        self.contact.reached(&self.machine(unknowns)?.0).ok_or(Nowhere::OtherWay)
    }
}

impl Equations for Rest<'_> {
    type Error = Nowhere;

    fn linear(&self, unknowns: &DVector<f64>) -> Result<(DVector<f64>, DMatrix<f64>), Nowhere> {
        /// Difference for derivatives, in spans of a number. It steers Newton's method and the tangent.
        const DIFFERENCE: f64 = 1e-7;
        /// Smaller difference before a smooth release, where a late impact moves by hundreds of times as much, but must not pass the place.
        /// At a corner the wider difference carries a curve over the small kinks between impacts.
        const SMALL: f64 = 1e-9;
        let is_smooth = matches!(self.contact, Contact::Resting { to, .. } if !to.is_corner);
        let difference = if is_smooth { SMALL } else { DIFFERENCE };
        let off = self.reached(unknowns)?.off;
        let mut slopes = DMatrix::zeros(1, 2);
        for column in 0..2 {
            let moved = |step: f64| {
                let mut moved = unknowns.clone();
                moved[column] += step;
                self.reached(&moved).map(|reached| (moved[column], reached.off))
            };
            let here = (unknowns[column], off);
            // At the edge of the allowed values, the difference is one-sided.
            let (ahead, behind) = match (moved(difference), moved(-difference)) {
                (Ok(ahead), Ok(behind)) => (ahead, behind),
                (Ok(ahead), Err(_)) => (ahead, here),
                (Err(_), behind) => (here, behind?),
            };
            // The divisor is the actual difference of the doubles.
            slopes[column] = (ahead.1 - behind.1) / (ahead.0 - behind.0);
        }
        Ok((DVector::from_element(1, off), slopes))
    }
}

/// The event at a special point of a branch of orbits that rest.
pub(super) fn contact(kind: SpecialKind, orbit: &PeriodicOrbit, machine: &Machine) -> Option<Contact> {
    let Course::Sticking(anchor) = orbit.course else { return None };
    if kind == SpecialKind::Detachment {
        return Contact::first(machine);
    }
    // The rest around the anchor is the one that vanishes. Its event goes from the release before it to the release after it.
    let period = orbit.revolutions as f64 * TAU;
    let releases: Vec<&Event> = orbit.rests().filter(|event| event.kind == EventKind::Release).collect();
    // An orbit has no such event if a corner ends one of its rests by an impact.
    if 2 * releases.len() != orbit.rests().count() {
        return None;
    }
    let after = |event: &Event| (event.turned_since(anchor)).rem_euclid(period);
    let to = releases.iter().min_by(|one, two| after(one).total_cmp(&after(two)))?;
    let from = releases.iter().max_by(|one, two| after(one).total_cmp(&after(two)))?;
    let turned = (to.turned_since(0.0) - from.turned_since(0.0)).rem_euclid(period);
    let turned = if turned > 0.0 { turned } else { period };
    let [from, to] = [from, to].map(|event| Place::of(event, machine));
    let all = Contact::Resting { from, to, turned, impact: usize::MAX };
    let [first, _] = all.told(machine, &all.reached(machine)?);
    Some(first)
}
