//! Contact forces and loads over the values of a table, with what is uncertain about the machine at each.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::contact::{Contact, Separation};
use super::denser;
use super::loads::{Load, Loads};
use crate::bracket::{Width, halve};
use crate::cam::{Cam, Least};
use crate::model::Model;
use crate::orbit::long_run::Budget;
use crate::progress::{Pieces, Watch};
use crate::simulate::{Machine, angular_velocity};
use crate::study::StudyError;
use crate::study::survey::{Attractor, Over, Place, Spacing, Start};
use crate::tolerance;
use crate::uncertainty::{PlausibleMachines, SourcedUncertainty, UncertaintyParts};

/// Least contact force of one machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceAt {
    /// The machine's place on the axis.
    pub place: Place,
    /// Least force and its place.
    pub least: Least,
    /// Uncertainty of the least force; none if there is none, or if it is unknown.
    pub error: Option<SourcedUncertainty>,
    /// Largest force round the cam.
    pub largest: f64,
}

/// Forces and loads at the values of a picture.
#[derive(Clone, Debug, Default)]
pub struct LoadCurves {
    /// Least force at each value.
    pub forces: Vec<ForceAt>,
    /// Loads at values where the follower leaves the cam. Uncertainties between the values of the table are interpolated.
    pub loads: Vec<Loads>,
    /// Uncertainty of the largest force on the cam at each value of the table.
    pub largest_errors: Vec<(f64, Option<[SourcedUncertainty; 1]>)>,
}

impl ForceAt {
    /// The range that the uncertainty of the least force leaves.
    pub fn bounds(&self) -> Option<[f64; 2]> {
        self.error.map(|error| error.around(self.least.value))
    }
}

impl LoadCurves {
    /// Returns the largest contact force by rising value, with the range that its uncertainty leaves. As long as the follower stays on the
    /// cam, it is the force of the cam. Beyond, it is the largest force of the motions, without impacts.
    pub fn greatest_forces(&self) -> Vec<(Place, f64, Option<[f64; 2]>)> {
        let parted = |place: Place| self.loads.iter().any(|loads| loads.place == place);
        let bounds =
            |at: &ForceAt| Some(denser::errors(&self.largest_errors, at.place.across())?[0].around(at.largest));
        let on_cam = self.forces.iter().filter(|at| !parted(at.place)).map(|at| (at.place, at.largest, bounds(at)));
        let off_cam = self.loads.iter().map(|loads| (loads.place, loads.force, loads.bounds(Loads::FORCE)));
        let mut all: Vec<_> = on_cam.chain(off_cam).collect();
        all.sort_by(|(one, ..), (other, ..)| one.across().total_cmp(&other.across()));
        all
    }
}

document!(ForceAt as it {
    speed_rpm: it.place.rpm,
    value if_any: it.place.value,
    least_n: it.least.value,
    cam_angle_rad: it.least.angle,
    error_n if_any: it.error.map(|error| error.total()),
    error_parts if_any: it.error.map(|error| UncertaintyParts(error, "_n")),
    largest_n: it.largest,
});

/// The motions that the starts of one machine converge to.
#[derive(Clone, Debug)]
#[doc(hidden)]
pub struct AttractorsAt {
    /// The machine's place on the axis.
    pub place: Place,
    /// The motions, in the order of their first starts.
    pub found: Vec<Attractor>,
}

document!(AttractorsAt as it {
    speed_rpm: it.place.rpm,
    value if_any: it.place.value,
    endings: it.found.iter().map(Ended).collect::<Vec<_>>(),
});

struct Ended<'a>(&'a Attractor);

document!(Ended<'_> as it {
    ending: it.0.ending.kind(),
    revolutions if_any: it.0.ending.period().map(|(revolutions, _)| revolutions),
    impacts if_any: it.0.ending.period().map(|(_, impacts)| impacts),
    growth: it.0.ending.growth().value,
    growth_error: it.0.ending.growth().error,
    followed: it.0.followed(),
    starts: it.0.starts.len(),
});

/// A limit set by the user, and where it is first exceeded among the values of the table.
#[derive(Clone, Debug, PartialEq)]
pub struct Passed {
    /// The limited load.
    pub limit: Load,
    /// Limit, in the displayed unit.
    pub value: f64,
    /// Unit of the limit.
    pub unit: String,
    /// The value at which the limit is first exceeded, located to a thousandth below the first table value that exceeds it. If that is the first value
    /// of the table, it is returned itself. None if no value exceeds the limit.
    pub at: Option<Place>,
}

document!(Passed as it {
    limit: it.limit,
    value: it.value,
    unit: it.unit,
    speed_rpm: it.at.map(|at| at.rpm),
    at if_any: it.at.and_then(|at| at.value),
});

/// The machines of a table: a model over the values of a number.
pub(super) struct LoadTable<'a> {
    /// The machines at any value.
    pub over: Over<'a>,
    /// Values of the table, rising.
    pub values: Vec<f64>,
    /// Spacing of the values.
    pub spacing: Spacing,
    /// Plausible machines in place of the model's own.
    pub machines: &'a PlausibleMachines<'a>,
    /// Separation of the model's own machine.
    pub separation: Separation,
    /// Starts of the runs; none for the usual starts.
    pub starts: Option<&'a [Start]>,
    /// Budget of the runs.
    pub budget: Budget,
}

/// Least force at a value, and whether the follower leaves the cam there; none where the cam's velocity jumps.
pub(super) type ForceFound = Option<(ForceAt, bool)>;

impl LoadTable<'_> {
    /// Uncertainties of numbers at a value, among the plausible machines; none if the machine is exact, or if they are unknown.
    fn errors<const N: usize>(
        &self,
        value: f64,
        numbers: [f64; N],
        of: impl Fn(&Model, &Cam) -> Option<[f64; N]> + Sync,
    ) -> Result<Option<[SourcedUncertainty; N]>, StudyError> {
        Ok(self.over.uncertain_at(self.machines, value, |machines| machines.error(numbers, of))?)
    }

    /// Separation of the machine at a value, from its contact.
    fn separation_at(&self, contact: &Contact<'_>) -> Separation {
        if self.over.is_speed() { self.separation } else { contact.separation() }
    }

    /// Least and largest force at a value, without uncertainty.
    fn plain_force(&self, value: f64) -> Result<ForceFound, StudyError> {
        let (model, cam) = self.over.model(value)?;
        let (contact, place) = (Contact::new(&cam, model.follower), self.over.place(value));
        let separation = self.separation_at(&contact);
        if matches!(separation, Separation::Kink { .. }) {
            return Ok(None);
        }
        let (least, largest) = (contact.least(place.rpm), contact.largest(place.rpm));
        Ok(Some((ForceAt { place, least, error: None, largest }, place.rpm > separation.speed())))
    }

    /// Least and largest force at a value.
    pub fn force(&self, value: f64) -> Result<ForceFound, StudyError> {
        let Some((at, is_parted)) = self.plain_force(value)? else { return Ok(None) };
        let of = |model: &Model, cam: &Cam| Some([Contact::new(cam, model.follower).least(at.place.rpm).value]);
        let error = self.errors(value, [at.least.value], of)?;
        // On a dwell rounding is the only uncertainty.
        let rounding = tolerance::JET_ROUNDING.value * at.largest.abs();
        let error = error.map(|[error]| error).filter(|error| error.total() > rounding);
        Ok(Some((ForceAt { error, ..at }, is_parted)))
    }

    /// Budget of runs whose motions are not judged, which does not change the loads.
    fn unjudged(&self) -> Budget {
        Budget { record: 0, ..self.budget }
    }

    /// Loads at a value, without uncertainty, and the attractors that they belong to.
    fn plain_loads(&self, value: f64, budget: Budget) -> Result<(Loads, Vec<Attractor>), StudyError> {
        let (model, machine) = (self.over.family.model(&[value])?, self.over.machine(value)?);
        let (loads, found) = Loads::among(&model, &machine, self.starts, budget)?;
        // The place as requested, not as recomputed from the angular velocity.
        Ok((Loads { place: self.over.place(value), ..loads }, found))
    }

    /// Loads at a value, and the attractors that they belong to.
    pub fn loads(&self, value: f64) -> Result<(Loads, AttractorsAt), StudyError> {
        let (loads, found) = self.plain_loads(value, self.budget)?;
        let (place, unjudged) = (self.over.place(value), self.unjudged());
        let of = |model: &Model, cam: &Cam| {
            let machine = Machine::new(cam.clone(), &model.follower, angular_velocity(place.rpm));
            Loads::among(model, &machine, self.starts, unjudged).ok().map(|(loads, _)| loads.numbers())
        };
        let errors = self.errors(value, loads.numbers(), of)?;
        Ok((loads.with_errors(errors), AttractorsAt { place, found }))
    }

    /// Forces and loads at `count` values or more, from those of the table.
    pub fn curves(
        &self,
        (forces, loads): (&[ForceAt], &[Loads]),
        count: usize,
        watch: &dyn Watch,
    ) -> Result<LoadCurves, StudyError> {
        let more = denser::between(&self.values, self.spacing, count);
        let known: Vec<_> = forces.iter().map(|at| (at.place.across(), at.error.map(|error| [error]))).collect();
        let known_loads: Vec<_> = loads.iter().map(|loads| (loads.place.across(), loads.errors)).collect();
        let pieces = Pieces::new(watch, "loads between the values of the table", more.len());
        let at = |value: &f64| -> Result<(Option<ForceAt>, Option<Loads>), StudyError> {
            let found = self.plain_force(*value)?;
            let force = found.map(|(at, _)| ForceAt { error: denser::errors(&known, *value).map(|[it]| it), ..at });
            if found.is_some_and(|(_, is_parted)| !is_parted) {
                return Ok((force, None));
            }
            let loads = self.plain_loads(*value, self.unjudged())?.0;
            Ok((force, Some(loads.with_errors(denser::errors(&known_loads, *value)))))
        };
        let found: Vec<_> =
            more.par_iter().map(|value| pieces.each(|| at(value))).collect::<Result<Vec<_>, StudyError>>()?;
        let largest_error = |at: &ForceAt| {
            let (value, rpm) = (at.place.across(), at.place.rpm);
            let of = |model: &Model, cam: &Cam| Some([Contact::new(cam, model.follower).largest(rpm)]);
            Ok((value, self.errors(value, [at.largest], of)?))
        };
        let largest_errors = forces.iter().map(largest_error).collect::<Result<_, StudyError>>()?;
        let mut curves = LoadCurves { forces: forces.to_vec(), loads: loads.to_vec(), largest_errors };
        for (force, loads) in found {
            curves.forces.extend(force);
            curves.loads.extend(loads);
        }
        curves.forces.sort_by(|one, other| one.place.across().total_cmp(&other.place.across()));
        curves.loads.sort_by(|one, other| one.place.across().total_cmp(&other.place.across()));
        Ok(curves)
    }

    /// The value at which a load first exceeds a limit, in the displayed unit, by the forces and loads of the table.
    pub fn passed(
        &self,
        (limit, value): (Load, f64),
        at_each: &[ForceFound],
        loads: &[Loads],
    ) -> Result<Passed, StudyError> {
        let (values, units) = (&self.values, &self.over.model.units);
        let most = limit.inside(units, value);
        // Up to the separation, the load is the contact force of the cam.
        let is_passed = |value: f64| -> Result<bool, StudyError> {
            let (of_value, cam) = self.over.model(value)?;
            let (contact, rpm) = (Contact::new(&cam, of_value.follower), self.over.place(value).rpm);
            let is_parted = rpm > self.separation_at(&contact).speed();
            Ok(match limit {
                Load::Force if !is_parted => contact.largest(rpm) > most,
                _ => is_parted && self.plain_loads(value, self.unjudged())?.0.of(limit) > most,
            })
        };
        let on_cam = at_each.iter().flatten().filter(|(_, is_parted)| limit == Load::Force && !is_parted);
        let on_cam = on_cam.map(|(at, _)| (at.place.across(), at.largest));
        let all = on_cam.chain(loads.iter().map(|loads| (loads.place.across(), loads.of(limit))));
        let beyond: Vec<f64> = all.filter(|(_, load)| *load > most).map(|(value, _)| value).collect();
        let first = values.iter().position(|value| beyond.contains(value));
        // Between that value and the one before.
        let bracket = first.and_then(|first| Some([values[first.checked_sub(1)?], values[first]]));
        let width = Width::Relative(tolerance::NEEDED_BY_RUNS.value);
        let located = bracket.map(|bracket| halve(bracket, width, is_passed)).transpose()?;
        let at = located.map(|[_, passed]| passed).or(first.map(|first| values[first]));
        let at = at.map(|value| self.over.place(value));
        Ok(Passed { limit, value, unit: limit.unit(units), at })
    }
}

/// Cam angle, rad, and force, at evenly spaced moments and at both sides of every corner.
pub(super) fn round(contact: &Contact<'_>, rpm: f64, moments: usize) -> Vec<[f64; 2]> {
    let omega = angular_velocity(rpm);
    let mut points = Vec::new();
    for segment in contact.cam.segments() {
        let part = (segment.end - segment.start) / TAU;
        let count = (part * moments as f64).ceil().max(1.0) as usize;
        let angle = |index: usize| segment.start + (segment.end - segment.start) * index as f64 / count as f64;
        points.extend((0..=count).map(|index| [angle(index), contact.force(&segment.law.lift(angle(index)), omega)]));
    }
    points
}
