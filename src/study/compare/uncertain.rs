//! Uncertainty of the differences between two machines: by a measured cam, and by the errors of the follower's numbers.
//!
//! A measured cam of both models, and each number that has one value and one error in both, change both machines alike. So they make the
//! difference less uncertain. Everything else is independent of the other machine.

use std::collections::BTreeMap;

use super::findings::{Findings, NamedValues, Numbers, differences, numbers};
use crate::cam::Cam;
use crate::measured::{Measured, PlausibleCams};
use crate::model::{FollowerErrors, Model, ModelError, Units};
use crate::uncertainty::{PlausibleMachines, SourcedUncertainty};

/// One of the two machines, with what is found for it.
pub(super) struct Side<'a> {
    pub model: &'a Model,
    pub found: &'a Findings,
    /// Units of the findings.
    pub units: &'a Units,
}

impl Side<'_> {
    fn like(&self, model: &Model, cam: &Cam) -> Option<NamedValues> {
        self.found.like(model, cam, self.units)
    }
}

/// Uncertainties of quantities by their names; an unknown one is NaN.
pub(super) type Open = BTreeMap<String, SourcedUncertainty>;

/// Returns the uncertainties of all differences between two machines, none for exact machines, and the accuracy of a measured cam.
pub(super) fn open(a: &Side<'_>, b: &Side<'_>) -> Result<(Open, Option<Measured>), ModelError> {
    let mut all = Open::new();
    let noisy = |side: &Side<'_>| PlausibleCams::of(side.model).map(|likely| likely.filter(|it| it.best.is_some()));
    let own = |side: &Side<'_>| numbers(&side.found.computed);
    let (of_a, of_b) = (noisy(a)?, noisy(b)?);
    let measured = of_a.as_ref().or(of_b.as_ref()).map(|likely| likely.measured.clone());
    match (of_a, of_b) {
        // One cam under both followers leaves the difference uncertain, by less than two cams would.
        (Some(likely), Some(_)) if a.model.cam == b.model.cam => {
            let of = |model: &Model, cam: &Cam| {
                Some(differences(&b.like(&b.model.on_cam_of(model, cam), cam)?, &a.like(model, cam)?))
            };
            add_cam(&mut all, &likely, &differences(&b.found.computed, &a.found.computed), of);
        }
        (of_a, of_b) => {
            for (likely, side) in [(of_a, a), (of_b, b)] {
                let Some(likely) = likely else { continue };
                let of = |model: &Model, cam: &Cam| side.like(model, cam).as_ref().map(numbers);
                add_cam(&mut all, &likely, &own(side), of);
            }
        }
    }
    add_numbers(&mut all, a, b)?;
    Ok((all, measured))
}

/// Adds the uncertainty from the errors of the followers' numbers.
fn add_numbers(all: &mut Open, a: &Side<'_>, b: &Side<'_>) -> Result<(), ModelError> {
    let [of_a, of_b] = [a, b].map(|side| side.model.errors);
    if of_a.are_none() && of_b.are_none() {
        return Ok(());
    }
    let cams = [Cam::new(a.model)?, Cam::new(b.model)?];
    let names: Vec<&str> = FollowerErrors::names().collect();
    let is_common = |index: usize| {
        let value = |side: &Side<'_>| side.model.of_follower(names[index]);
        of_a.all()[index] == of_b.all()[index] && value(a) == value(b)
    };
    let common = PlausibleMachines::of_numbers(a.model, &cams[0], of_a.kept(is_common));
    let lowest = cams[1].lowest().value;
    let both = |model: &Model, cam: &Cam| {
        let other = b.model.moved(lowest, &model.moves);
        Some(differences(&b.like(&other, &cams[1])?, &a.like(model, cam)?))
    };
    add(all, &common, &differences(&b.found.computed, &a.found.computed), both);
    for (side, cam, errors) in [(a, &cams[0], of_a), (b, &cams[1], of_b)] {
        let own = PlausibleMachines::of_numbers(side.model, cam, errors.kept(|index| !is_common(index)));
        add(all, &own, &numbers(&side.found.computed), |model, cam| side.like(model, cam).as_ref().map(numbers));
    }
    Ok(())
}

/// Adds the uncertainty from equally likely cams.
fn add_cam(
    all: &mut Open,
    likely: &PlausibleCams,
    numbers: &Numbers,
    of: impl Fn(&Model, &Cam) -> Option<Numbers> + Sync,
) {
    let values: Vec<f64> = numbers.values().copied().collect();
    let open = likely.errors(&values, |model, cam| Some(in_order(numbers, &of(model, cam)?)));
    let open = open.unwrap_or_else(|| vec![f64::NAN; values.len()]);
    for (name, cam) in numbers.keys().zip(open) {
        // Two cams may depend on each other, so their uncertainties are added.
        all.entry(name.clone()).or_default().cam += cam;
    }
}

/// Adds the uncertainty that the errors of numbers cause among machines.
fn add(
    all: &mut Open,
    machines: &PlausibleMachines<'_>,
    numbers: &Numbers,
    of: impl Fn(&Model, &Cam) -> Option<Numbers> + Sync,
) {
    let Some(machines) = machines.uncertain() else { return };
    let values: Vec<f64> = numbers.values().copied().collect();
    let open = machines.errors_of_numbers(&values, |model, cam| Some(in_order(numbers, &of(model, cam)?)));
    let open = open.unwrap_or_else(|| vec![SourcedUncertainty::UNKNOWN_OF_NUMBERS; values.len()]);
    for (name, open) in numbers.keys().zip(open) {
        let known = all.entry(name.clone()).or_default();
        *known = known.with_independent(&open);
    }
}

/// Numbers of `found` in the order of `order`; NaN for a missing one.
fn in_order(order: &Numbers, found: &Numbers) -> Vec<f64> {
    order.keys().map(|name| found.get(name).copied().unwrap_or(f64::NAN)).collect()
}
