//! Finds the change of one number that makes a machine meet a need, with the other numbers kept.

use std::cell::Cell;
use std::convert::Infallible;

use rayon::prelude::*;
use serde::Serialize;

use super::contact::Contact;
use super::loads::Loads;
pub use super::need::{Need, What, in_si};
use crate::bracket::{Width, halve, secants};
use crate::cam::Cam;
use crate::known::Evidence;
use crate::model::{Follower, Model};
use crate::simulate::{Machine, SimulateError, angular_velocity};
use crate::tolerance;
use crate::uncertainty::{PlausibleMachines, SourcedUncertainty, UncertaintyParts};

/// A number of the machine that an engineer can change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
#[doc(hidden)]
pub enum Lever {
    /// The force of the spring at the lowest lift.
    Preload,
    /// The stiffness of the spring.
    Stiffness,
    /// The damping.
    Damping,
    /// The mass of the follower.
    Mass,
}

named!(Lever);

impl Lever {
    /// All levers.
    pub const ALL: [Self; 4] = [Self::Preload, Self::Stiffness, Self::Damping, Self::Mass];

    /// Dotted path of the number in a model file.
    pub fn path(self) -> String {
        format!("follower.{self}")
    }

    /// Whether smaller values help, as of the mass; otherwise larger values help.
    pub fn is_upper_bound(self) -> bool {
        self == Self::Mass
    }
}

/// A machine with one number changed at a time.
#[derive(Clone, Debug)]
pub(super) struct Changed<'a> {
    model: &'a Model,
    contact: Contact<'a>,
    /// Lowest lift; `preload` is the spring force there, if the model fixes it.
    lowest: f64,
    preload: Option<f64>,
}

impl<'a> Changed<'a> {
    pub fn new(model: &'a Model, contact: &Contact<'a>) -> Self {
        let lowest = contact.cam.lowest().value;
        Self { model, contact: contact.clone(), lowest, preload: model.preload }
    }

    /// Keeps the rest position instead of the preload, if `own` gives the rest position although this model gives a preload.
    pub fn keeping_rest_of(self, own: &Model) -> Self {
        Self { preload: self.preload.filter(|_| own.preload.is_some()), ..self }
    }

    /// Builds the counterpart of another model on its cam, which keeps the preload only if this one does.
    fn on<'b>(&self, model: &'b Model, contact: &Contact<'b>) -> Changed<'b> {
        let changed = Changed::new(model, contact);
        Changed { preload: changed.preload.filter(|_| self.preload.is_some()), ..changed }
    }

    /// Present value of the lever.
    pub fn value(&self, lever: Lever) -> f64 {
        let Follower { mass, damping, stiffness, rest_position, .. } = self.contact.follower;
        match lever {
            Lever::Preload => stiffness * (self.lowest - rest_position),
            Lever::Stiffness => stiffness,
            Lever::Damping => damping,
            Lever::Mass => mass,
        }
    }

    /// Returns a copy with another value of one number. If the model fixes the preload, `k (c_min - rest) = preload` is kept.
    pub fn with(&self, lever: Lever, value: f64) -> Self {
        let mut changed = self.clone();
        let follower = &mut changed.contact.follower;
        match lever {
            Lever::Preload => changed.preload = self.preload.map(|_| value),
            Lever::Stiffness => follower.stiffness = value,
            Lever::Damping => follower.damping = value,
            Lever::Mass => follower.mass = value,
        }
        let preload = if lever == Lever::Preload { Some(value) } else { changed.preload };
        if let Some(preload) = preload {
            changed.contact.follower.rest_position = self.lowest - preload / changed.contact.follower.stiffness;
        }
        changed
    }

    fn machine(&self, rpm: f64) -> Machine {
        Machine::new(self.contact.cam.clone(), &self.contact.follower, angular_velocity(rpm))
    }

    /// Converts a value of a lever to the user's unit; returns it with the unit's name.
    pub fn told(&self, lever: Lever, value: f64) -> (f64, String) {
        let unit = self.model.units.of_follower(&lever.to_string());
        unit.map_or((value, String::new()), |unit| (unit.told(value), unit.name().into()))
    }

    /// Whether the machine meets the need.
    fn does(&self, need: &Need) -> Result<bool, SimulateError> {
        let stays = self.contact.separation().speed();
        if stays > need.rpm {
            return Ok(true);
        }
        let What::Below(load, limit) = need.what else { return Ok(false) };
        let limit = load.of_si(&self.model.units, limit);
        let mut model = self.model.clone();
        model.follower = self.contact.follower;
        let speed = |index: u32| stays + (need.rpm - stays) * f64::from(index) / f64::from(SPEEDS);
        // The highest speed comes first: one failing speed is enough.
        let passes = |index: u32| match Loads::at(&model, &self.machine(speed(SPEEDS - index))) {
            Ok(loads) if loads.of(load) < limit => None,
            other => Some(other.map(|_| false)),
        };
        (0..SPEEDS).into_par_iter().find_map_any(passes).unwrap_or(Ok(true))
    }
}

/// Number of speeds, above separation up to the highest, at which a load is checked.
const SPEEDS: u32 = 24;

/// The value of one number that meets a need.
#[derive(Clone, Debug, PartialEq)]
#[doc(hidden)]
pub struct Answer {
    /// The need, in the user's words.
    pub need: String,
    /// The number to change.
    pub lever: Lever,
    /// Present value, in the displayed unit.
    pub now: f64,
    /// Least value that meets the need, or the largest (see `is_upper_bound`); none if no value meets it.
    pub value: Option<f64>,
    /// Uncertainty of `value`, at least the resolution of the runs for a load.
    pub error: Option<SourcedUncertainty>,
    /// Unit of the values.
    pub unit: String,
    /// Whether `value` is the largest that meets the need.
    pub is_upper_bound: bool,
    /// Limit on the other side, if there is one: a damper that keeps the follower on the cam's rise may throw it off on the return.
    pub other: Option<f64>,
    /// Uncertainty of `other`.
    pub other_error: Option<SourcedUncertainty>,
    /// A tried value beyond `other` that meets the load requirement again.
    pub again: Option<f64>,
    /// Why there is no value, or a further remark.
    pub note: String,
    /// Computed for a separation; sampled for a load.
    pub known: Evidence,
}

document!(Answer as it {
    need: it.need,
    parameter: it.lever,
    now: it.now,
    value: it.value,
    error if_any: it.error.map(|error| error.total()),
    error_parts if_any: it.error.map(|error| UncertaintyParts(error, "")),
    unit: it.unit,
    is_upper_bound: it.is_upper_bound,
    other if_any: it.other,
    other_error if_any: it.other_error.map(|error| error.total()),
    other_error_parts if_any: it.other_error.map(|error| UncertaintyParts(error, "")),
    again if_any: it.again,
    note: it.note,
    known: it.known,
});

/// Finds the value of one number that meets a need, the others kept. `machines` are the plausible ones; none if the machine is exact.
pub(super) fn answer(
    of: &Changed<'_>,
    (need, text): (&Need, &str),
    lever: Lever,
    machines: Option<&PlausibleMachines<'_>>,
) -> Result<Answer, SimulateError> {
    let known = need.known();
    let found = find(of, need, lever)?;
    let told = |value: f64| of.told(lever, value).0;
    // Nothing is uncertain if there is no value, or if the least possible value meets the need.
    let machines = machines.filter(|_| found.value.is_some() && found.note.is_empty());
    let ends = |found: &Found| [found.value, found.other].into_iter().flatten().collect::<Vec<f64>>();
    let there = |model: &Model, cam: &Cam| {
        let changed = of.on(model, &Contact::new(cam, model.follower));
        let near =
            if need.what == What::NoSeparation { ends_near(&changed, need.rpm, lever, &ends(&found)) } else { None };
        let found_there = near.or_else(|| Some(ends(&find(&changed, need, lever).ok()?)));
        found_there.filter(|found_there| found_there.len() == ends(&found).len())
    };
    // The number that is sought has no error.
    let of_numbers =
        machines.and_then(|machines| machines.without(&lever.path()).errors_of_numbers(&ends(&found), there));
    let of_cam = match (machines, need.what) {
        (None, _) => None,
        (Some(machines), What::NoSeparation) => machines.errors_of_cam(&ends(&found), there),
        // Many runs for each cam would take long: the speed of the need is raised by what the cam makes of the separation.
        (Some(machines), What::Below(..)) => {
            let raised = |(index, value): (usize, &f64)| -> Result<Option<f64>, SimulateError> {
                match share_of_cam(&of.with(lever, *value), lever, machines) {
                    Some(share) if share > 0.0 => {
                        let certain = find(of, &Need { rpm: need.rpm * (1.0 + share), ..*need }, lever)?;
                        Ok(ends(&certain).get(index).map(|certain| (certain - value).abs()))
                    }
                    share => Ok(share),
                }
            };
            ends(&found).iter().enumerate().map(raised).collect::<Result<Option<Vec<f64>>, _>>()?
        }
    };
    let is_measured = machines.is_some_and(|machines| machines.cams.as_ref().is_some_and(|cams| cams.best.is_some()));
    let error = |index: usize| {
        let (cam, numbers) = (*of_cam.as_ref()?.get(index)?, of_numbers.as_ref()?.get(index)?);
        let (value, error) = (ends(&found)[index], SourcedUncertainty { cam, ..*numbers });
        // At least as wide as the resolution of the runs.
        let width = if known == Evidence::Sampled { tolerance::NEEDED_BY_RUNS.value * value.abs() } else { 0.0 };
        let error = match error.total() {
            // The sought number may be the only uncertain one.
            0.0 if !is_measured => error,
            0.0 => SourcedUncertainty { cam: width, ..error },
            total if total < width => error.times(width / total),
            _ => error,
        };
        Some(error.times(told(1.0)))
    };
    let (now, unit) = of.told(lever, of.value(lever));
    let stuck = found
        .stuck
        .map(|value| format!("at {} {unit} a run makes no progress, which counts as a failure", told(value) as f32));
    let again = found.again.map(|value| format!("met again with {} {unit}", told(value) as f32));
    let notes = [found.note.clone()].into_iter().filter(|note| !note.is_empty()).chain(again).chain(stuck);
    Ok(Answer {
        need: text.into(),
        lever,
        now,
        value: found.value.map(told),
        error: error(0),
        is_upper_bound: found.is_upper_bound,
        other: found.other.map(told),
        other_error: error(1),
        again: found.again.map(told),
        unit,
        note: notes.collect::<Vec<_>>().join("; "),
        known,
    })
}

/// Finds the ends of the range that meets a need of no separation, by secants from the ends for a similar machine. None if these do not
/// converge nearby.
fn ends_near(of: &Changed<'_>, rpm: f64, lever: Lever, ends: &[f64]) -> Option<Vec<f64>> {
    /// Largest difference of the ends of similar machines, over the end.
    const NEARBY: f64 = 0.2;
    const STEPS: usize = 12;
    let excess =
        |value: f64| -> Result<f64, Infallible> { Ok(of.with(lever, value).contact.separation().speed() - rpm) };
    let near = |end: &f64| {
        let seen = |value: f64| excess(value).map(|excess| (value, excess));
        let (Ok(first), Ok(second)) = (seen(1.01 * end), seen(*end));
        let Ok(([_, (value, _)], converges)) = secants([first, second], STEPS, tolerance::ROOT_WIDTH.value, excess);
        Some(value).filter(|value| converges && (value / end - 1.0).abs() < NEARBY)
    };
    ends.iter().map(near).collect()
}

/// Uncertainty of the separation speed that a measured cam causes, over that speed. To meet a need for certain, its speed is raised by it.
/// None if it is unknown.
fn share_of_cam(of: &Changed<'_>, lever: Lever, machines: &PlausibleMachines<'_>) -> Option<f64> {
    let Some(rpm) = of.contact.separation().at_speed() else { return Some(0.0) };
    let there = |model: &Model, cam: &Cam| {
        let changed = of.on(model, &Contact::new(cam, model.follower)).with(lever, of.value(lever));
        Some(vec![changed.contact.separation().at_speed()?])
    };
    Some(machines.errors_of_cam(&[rpm], there)?[0] / rpm)
}

/// Range of values that meet the need, in the internal unit; a note says why there is none.
#[derive(Default)]
pub(super) struct Found {
    pub value: Option<f64>,
    pub other: Option<f64>,
    pub is_upper_bound: bool,
    pub note: String,
    /// A value beyond `other` that meets the need again.
    pub again: Option<f64>,
    /// A value at which a run makes no progress.
    pub stuck: Option<f64>,
}

/// Returns the range of values that meet the need, if there are any.
///
/// The contact force is linear in each number, so the values that keep the follower on the cam at every angle and speed form one range. For
/// loads this is not guaranteed.
pub(super) fn find(of: &Changed<'_>, need: &Need, lever: Lever) -> Result<Found, SimulateError> {
    /// Doublings and halvings of the number's own scale that are tried.
    const DOUBLINGS: i32 = 20;
    const DOUBLINGS_OF_RUNS: i32 = 6;
    let is_upper_bound = lever.is_upper_bound();
    let none = |note: String| Found { note, is_upper_bound, ..Found::default() };
    let springs = matches!(lever, Lever::Preload | Lever::Stiffness);
    if springs && of.contact.follower.stiffness == 0.0 {
        return Ok(none("there is no spring".into()));
    }
    let Follower { mass, stiffness, gravity, .. } = of.contact.follower;
    let weight = mass * gravity.abs();
    let rise = of.contact.cam.top() - of.lowest;
    let size = match lever {
        Lever::Preload => of.value(lever).max(stiffness * rise).max(weight),
        // The critical damping, or the damping that stops the mass within a radian.
        Lever::Damping => of.value(lever).max(2.0 * (stiffness * mass).sqrt()).max(mass * angular_velocity(need.rpm)),
        _ => of.value(lever),
    };
    let (most, width) = match need.what {
        What::NoSeparation => (DOUBLINGS, tolerance::ROOT_WIDTH.value),
        What::Below(..) => (DOUBLINGS_OF_RUNS, tolerance::NEEDED_BY_RUNS.value),
    };
    // A value at which a run makes no progress does not count as meeting the need.
    let stuck = Cell::new(None);
    let does = |value: f64| match of.with(lever, value).does(need) {
        Err(SimulateError::NoProgress { .. }) => {
            stuck.set(Some(value));
            Ok(false)
        }
        other => other,
    };
    let mut values: Vec<f64> = (-most..=most).map(|power| size * 2.0_f64.powi(power)).collect();
    if !matches!(lever, Lever::Mass | Lever::Stiffness) {
        values.insert(0, 0.0);
    }
    if is_upper_bound {
        values.reverse();
    }
    let told = |value: f64| of.told(lever, value);
    let mut first = None;
    for (index, value) in values.iter().enumerate() {
        if does(*value)? {
            first = Some(index);
            break;
        }
    }
    let edge = |fails: f64, does_it: f64| halve([fails, does_it], Width::Relative(width), does).map(|[_, found]| found);
    let told_stuck = |found: Found| Found { stuck: stuck.get(), ..found };
    let Some(first) = first else {
        // A narrow range may lie between two of the values.
        if need.what == What::NoSeparation
            && let Some([low, best, high]) =
                best_of(&values, |value| of.with(lever, value).contact.separation().speed())
            && does(best)?
        {
            let (value, other) = (edge(low, best)?, edge(high, best)?);
            let found = Found { value: Some(value), other: Some(other), is_upper_bound, ..Found::default() };
            return Ok(told_stuck(found));
        }
        let (last, unit) = told(values.last().copied().unwrap_or_default());
        let side = if is_upper_bound { "above" } else { "below" };
        let tried = if need.what == What::NoSeparation { "" } else { ", of those tried," };
        return Ok(told_stuck(none(format!(
            "no {lever} {side} {last:.1e} {unit}{tried} suffices, with the others unchanged"
        ))));
    };
    let before = match first.checked_sub(1) {
        // If a tiny value already meets the need, there is no least value to find.
        Some(before) if values[before] == 0.0 && does(width * values[first])? => None,
        Some(before) => Some(edge(values[before], values[first])?),
        None => None,
    };
    let (mut beyond, mut again) = (None, None);
    for pair in values[first..].windows(2) {
        match (beyond, does(pair[1])?) {
            (None, false) => beyond = Some(edge(pair[1], pair[0])?),
            (Some(_), true) => {
                again = Some(pair[1]);
                break;
            }
            // The values that keep the follower on the cam form one range.
            (Some(_), false) if need.what == What::NoSeparation => break,
            _ => {}
        }
    }
    let told_stuck = |found: Found| Found { again, ..told_stuck(found) };
    Ok(told_stuck(match (before, beyond) {
        (None, Some(_)) => Found { value: beyond, is_upper_bound: !is_upper_bound, ..Found::default() },
        (Some(_), _) => Found { value: before, other: beyond, is_upper_bound, ..Found::default() },
        (None, None) => {
            let (value, unit) = told(values[first]);
            let (value, note) = if is_upper_bound {
                (values[first], format!("any value suffices, as far as {value:.3e} {unit} was tried"))
            } else {
                (values[first], "the least possible value suffices".into())
            };
            Found { value: Some(value), ..none(note) }
        }
    }))
}

/// Finds the value with the largest `speed`, returned between its neighbours. The values with a speed above any bound must form one range.
fn best_of(values: &[f64], speed: impl Fn(f64) -> f64) -> Option<[f64; 3]> {
    /// Thirds of the range dropped one by one, down to the square root of the rounding: a flat maximum hides anything finer.
    const THIRDS: usize = 45;
    let speeds: Vec<f64> = values.iter().map(|value| speed(*value)).collect();
    let best = (0..values.len()).max_by(|one, two| speeds[*one].total_cmp(&speeds[*two]))?;
    let [from, to] = [best.saturating_sub(1), (best + 1).min(values.len() - 1)].map(|index| values[index]);
    let (mut low, mut high) = (from, to);
    for _ in 0..THIRDS {
        let third = (high - low) / 3.0;
        if speed(low + third) < speed(high - third) {
            low += third;
        } else {
            high -= third;
        }
    }
    Some([from, 0.5 * (low + high), to])
}
