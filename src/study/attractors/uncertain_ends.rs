//! Uncertainty of the values at which attractors begin and end: the shift of each event among the plausible machines.

use rayon::prelude::*;

use super::family::{AttractorFamily, StartsAndBudget, ValueGrid};
use super::transition::{Cause, Transition};
use super::{leaves, leaves_at};
use crate::bracket::outward;
use crate::cam::Cam;
use crate::model::Model;
use crate::orbit::branch::Event;
use crate::study::survey::Over;
use crate::uncertainty::{PlausibleMachines, SourcedUncertainty};

/// A survey whose ends are uncertain.
pub(crate) struct UncertainEnds<'a> {
    /// The machines of the survey.
    pub over: &'a Over<'a>,
    /// Lowest and highest value.
    pub range: [f64; 2],
    /// The values that were run.
    pub grid: &'a ValueGrid,
    /// Starts and budget of the runs.
    pub runs: StartsAndBudget<'a>,
    /// Plausible machines in place of the model's own.
    pub machines: &'a PlausibleMachines<'a>,
    /// Uncertainty of the first separation, if the speed varies.
    pub separation: Option<SourcedUncertainty>,
}

impl UncertainEnds<'_> {
    /// Gives the ends of each family their uncertainty.
    pub fn put(&self, families: &mut [AttractorFamily]) {
        families.par_iter_mut().for_each(|family| {
            let errors = [0, 1].map(|side| self.error(family, side));
            for (end, error) in family.ends.iter_mut().zip(errors) {
                end.iter_mut().for_each(|end| end.error = error);
            }
        });
    }

    /// Uncertainty of an end; none if it is exact or unknown. A number that varies is exact there.
    fn error(&self, family: &AttractorFamily, side: usize) -> Option<SourcedUncertainty> {
        let end = family.ends[side].as_ref()?;
        self.over.uncertain_at(self.machines, end.value(), |machines| self.among(machines, family, end, side)).ok()?
    }

    /// Uncertainty of an end among machines: by the equations of its event, or by runs if it is known by runs.
    fn among(
        &self,
        machines: &PlausibleMachines<'_>,
        family: &AttractorFamily,
        end: &Transition,
        side: usize,
    ) -> Option<SourcedUncertainty> {
        let machine = self.over.machine(end.value()).ok()?;
        let event = end.point.as_ref();
        let event = event.and_then(|point| Event::of_point(&machine, &self.over.parameter, self.range, point));
        let by_equations = |moved: &(dyn Fn(&Model, &Cam) -> Option<f64> + Sync)| {
            machines.error([end.value()], |model, cam| moved(model, cam).map(|value| [value])).map(|[error]| error)
        };
        match (end.cause, event) {
            // One detachment speed has one error.
            (Cause::Detachment, _) if self.over.is_speed() => self.separation.filter(|error| error.total().is_finite()),
            (Cause::Detachment, _) => {
                by_equations(&|model, cam| self.leaves_elsewhere(&self.over.elsewhere(model, cam), end.value()))
            }
            (_, Some(event)) => by_equations(&|model, cam| event.moved(model, cam)),
            (Cause::Runs, None) => machines.error_by_runs(end.value(), |model, cam| {
                family.moved(&self.over.elsewhere(model, cam), self.grid, self.runs, side)
            }),
            _ => None,
        }
    }

    /// Value at which the follower of other machines begins or ceases to leave the cam, near the value `from` of the survey's own follower.
    fn leaves_elsewhere(&self, other: &Over<'_>, from: f64) -> Option<f64> {
        /// First step, as a part of the range, and number of doublings.
        const FIRST: f64 = 1e-6;
        const DOUBLED: usize = 20;
        let step = FIRST * (self.range[1] - self.range[0]);
        let [leaves_there, leaves_above] = [leaves_at(other, from).ok()?, leaves_at(self.over, from + step).ok()?];
        let direction = if leaves_there == leaves_above { -1.0 } else { 1.0 };
        let is_beyond = |value: f64| Ok::<_, ()>(leaves_at(other, value).map_err(drop)? != leaves_there);
        leaves(other, outward(from, direction * step, DOUBLED, is_beyond).ok()??).map(|[value, _]| value)
    }
}
