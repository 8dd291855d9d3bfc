//! Survey of a machine over speeds, or over values of another number: its attractors, where each begins and ends, and how many starts end
//! on each.

use std::collections::BTreeMap;

use rayon::prelude::*;
use serde::Serialize;

use crate::border_collision::Danger;
use crate::corner::CornerImpact;
use crate::corner::candidates::on_branch;
use crate::elementary;
use crate::estimate::Estimate;
use crate::known::Evidence;
use crate::measured::Measured;
use crate::model::{FollowerErrors, Model, ModelError};
use crate::orbit::cycle::own_speed;
use crate::orbit::long_run::{Budget, Kind, LongRun};
use crate::progress::Watch;
use crate::simulate::{EventKind, Machine, SimulateError};
use crate::study::attractors::{
    AttractorFamily, Attractors, AttractorsAtValue, AttractorsError, Cause, GridValue, Resolution, Transition,
    UncertainEnds, attractors,
};
use crate::study::design::contact::{Contact, Separation};
use crate::study::design::known;
use crate::study::machine;
use crate::study::routes;
use crate::study::survey::{Attractor, Over, Place, Sample, Spacing, VariedNumber, Wandering};
use crate::tolerance;
use crate::uncertainty::{PlausibleMachines, SourcedUncertainty, UncertaintyParts};

/// Survey of a machine over a range of speeds, or of values of another number: the document of `speeds --json`.
#[derive(Clone, Debug)]
pub struct SpeedSurvey {
    /// The model's name.
    pub model: String,
    /// The number that varies.
    pub over: VariedNumber,
    /// The range; for the speed, rpm.
    pub range: [f64; 2],
    /// Step from one value to the next; in decades for a logarithmic grid.
    pub step: f64,
    /// Starts at each value.
    pub sample: Sample,
    /// Budget of each run.
    pub budget: Budget,
    /// Whether runs also began on the stable orbits of two impacts in one revolution.
    pub two_impacts: bool,
    /// First speed, above the lowest of the range, at which the follower leaves the cam, by the contact force. Its error includes the
    /// uncertainty of the machine. None if the speed does not vary.
    pub separation: Option<Separation>,
    /// Uncertainty of the machine in that speed, rpm; none if the machine is exact.
    pub separation_error: Option<SourcedUncertainty>,
    /// Accuracy of the cam, if it is measured.
    pub measured: Option<Measured>,
    /// Standard deviations of the follower's numbers; the one that varies is exact.
    pub errors: FollowerErrors,
    /// The attractors, by rising value.
    pub attractors: Vec<AttractorRow>,
    /// Ranges with several attractors.
    pub coexistence: Vec<Coexistence>,
    /// Corner impacts of the attractors with a danger, by rising value.
    pub dangers: Vec<PassedDanger>,
    /// Values at which starts leave the cam for good, by rising value, with the share of these starts.
    pub off: Vec<Off>,
    /// Number of values of the range that were run.
    pub run: usize,
    /// Values at which nothing, or not every start, could be run.
    pub failed: Vec<FailedValue>,
}

document!(SpeedSurvey as it {
    schema: "corner-impact/speeds/1",
    model: it.model,
    rpm: it.over.rpm.map_or(it.range, |rpm| [rpm; 2]),
    over if_any: it.over.rpm.map(|_| &it.over.name),
    range if_any: it.over.rpm.map(|_| it.range),
    known: Evidence::Sampled,
    step_rpm if_any: it.over.is_speed().then_some(it.step),
    step if_any: it.over.rpm.map(|_| it.step),
    logarithmic if_any: (it.over.spacing == Spacing::Logarithmic).then_some(true),
    starts: it.sample.count(),
    given if_any: matches!(it.sample, Sample::Given(_)).then_some(true),
    budget: it.budget,
    two_impacts: it.two_impacts,
    missed_below_share: it.missed(),
    detachment_rpm: it.detachment().filter(|_| it.over.is_speed()).map(|[rpm, _]| rpm),
    detachment if_any: it.detachment().filter(|_| !it.over.is_speed()).map(|[value, _]| value),
    detachment_error_rpm if_any: it.detachment_error().filter(|_| it.over.is_speed()).map(|error| error.total()),
    detachment_error if_any: it.detachment_error().filter(|_| !it.over.is_speed()).map(|error| error.total()),
    detachment_error_parts if_any: it
        .detachment_error()
        .map(|error| UncertaintyParts(error, if it.over.is_speed() { "_rpm" } else { "" })),
    measured if_any: it.measured,
    uncertain if_any: it.errors.if_any(),
    attractors: it.attractors,
    coexistence: it.coexistence,
    off_for_good if_any: it.off_for_good(),
    dangers: it.dangers,
    failed: it.failed,
});

/// The share of the sample's starts that leave the cam for good at a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Off {
    /// Place of the value.
    pub at: Place,
    /// Share of these starts.
    pub share: Estimate,
}

document!(Off as it { speed_rpm: it.at.rpm, value if_any: it.at.value, share: it.share.value, error: it.share.error });

/// Starts that leave the cam for good. A flight that never returns to the cam ends on no attractor with impacts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OffForGood {
    /// The finding in a sentence.
    pub words: String,
    /// Share at each value with such starts.
    pub shares: Vec<Off>,
}

/// An attractor over a range of values.
#[derive(Clone, Debug)]
pub struct AttractorRow {
    /// Name of the attractor.
    pub id: String,
    /// Kind of motion at most of the values.
    pub kind: Kind,
    /// Turns of the cam in one period, if equal at all values.
    pub revolutions: Option<u64>,
    /// Impacts in one period, if equal at all values.
    pub impacts: Option<u64>,
    /// Places of its lowest and its highest value.
    pub ends: [Place; 2],
    /// Transition at its lowest value; none at the end of the range.
    pub birth: Option<Transition>,
    /// Transition at its highest value; none at the end of the range.
    pub death: Option<Transition>,
    /// The attractor at each value of the grid, by rising value.
    pub at: Vec<At>,
}

document!(AttractorRow as it {
    id: it.id,
    kind: it.kind,
    revolutions: it.revolutions,
    impacts: it.impacts,
    from_rpm: it.ends[0].rpm,
    to_rpm: it.ends[1].rpm,
    from if_any: it.ends[0].value,
    to if_any: it.ends[1].value,
    birth: it.birth,
    death: it.death,
    rests: it.rests(),
    shares: it.at,
});

/// An attractor at one value.
#[derive(Clone, Debug, PartialEq)]
pub struct At {
    /// Place of the value.
    pub place: Place,
    /// Share of the sample's starts that end on it. A sample is spread better than by chance, so its error is an overestimate; given
    /// starts are counted, and the error is 0.
    pub share: Estimate,
    /// The motion.
    pub ending: LongRun,
    /// Revolutions that its runs were followed for, in total.
    pub followed: u64,
    /// Totals of the runs at this value that neither rest nor settle on an orbit soon.
    pub wandering: Wandering,
    /// Cam angles of its impacts, rad.
    pub impact_angles: Vec<f64>,
    /// Speed of the fastest impact, relative to the cam, m/s; none if there are no impacts.
    pub impact_speed: Option<f64>,
}

document!(At as it {
    speed_rpm: it.place.rpm,
    value if_any: it.place.value,
    share: it.share.value,
    error: it.share.error,
    kind: it.ending.kind(),
    revolutions: it.ending.period().map(|(revolutions, _)| revolutions),
    impacts: it.ending.period().map(|(_, impacts)| impacts),
    revolutions_between_rests if_any: it.ending.between_rests(),
    impact_speed_m_s if_any: it.impact_speed,
    growth: it.ending.growth().value,
    growth_error: it.ending.growth().error,
    followed: it.followed,
});

/// Rate at which a chaotic motion rests on the cam, from runs that had wandered for long.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rests {
    /// Number of rests seen.
    pub rests: u64,
    /// Number of revolutions observed.
    pub revolutions: u64,
    /// Rests per revolution. Without any rest, the upper bound of the rate with 95 %.
    pub rate: f64,
    /// Standard error of the rate; none if there is no rest.
    pub rate_error: Option<f64>,
}

/// A range of values with two or more attractors, each reached by runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Coexistence {
    /// Places of the lowest and the highest value.
    pub ends: [Place; 2],
    /// Names of the attractors.
    pub attractors: Vec<String>,
}

document!(Coexistence as it {
    from_rpm: it.ends[0].rpm,
    to_rpm: it.ends[1].rpm,
    from if_any: it.ends[0].value,
    to if_any: it.ends[1].value,
    attractors: it.attractors,
});

/// A corner impact with a danger that attractors pass, begin or end with.
#[derive(Clone, Debug)]
pub struct PassedDanger {
    /// Names of the attractors.
    pub attractors: Vec<String>,
    /// Place of the corner impact.
    pub at: Place,
    /// Cam angle of the corner, rad.
    pub cam_angle: f64,
    /// Danger by the local map of the corner impact.
    pub danger: Danger,
}

document!(PassedDanger as it {
    attractors: it.attractors,
    speed_rpm: it.at.rpm,
    value if_any: it.at.value,
    cam_angle_rad: it.cam_angle,
    danger: it.danger,
});

/// A value at which nothing, or not every start, could be run.
#[derive(Clone, Debug, PartialEq)]
pub struct FailedValue {
    /// Place of the value.
    pub at: Place,
    /// Number of starts that could not be run; none if no start could.
    pub starts: Option<usize>,
    /// Reason.
    pub why: String,
}

document!(FailedValue as it { speed_rpm: it.at.rpm, value if_any: it.at.value, starts if_any: it.starts, why: it.why });

/// -ln(0.05): the mean number of starts in a basin that at least one start hits with 95 %.
const HIT: f64 = 2.995_732_273_553_991;

impl SpeedSurvey {
    /// Returns the share of the starts' rectangle that a basin needs so that randomly drawn starts of a value hit it with a probability of
    /// 95 %.
    pub fn missed(&self) -> f64 {
        (HIT / self.sample.count() as f64).min(1.0)
    }

    /// Returns the starts that leave the cam for good, if any do.
    pub fn off_for_good(&self) -> Option<OffForGood> {
        let ([first, .., last] | [first @ last]) = self.off.as_slice() else { return None };
        let all = self.off.iter().filter(|off| off.share.value == 1.0).count();
        let words = match (all, self.off.len()) {
            (all, _) if all == self.run => {
                let value = self.over.value();
                format!(
                    "Every start leaves the cam for good, at every {value} that was run: nothing brings the follower back."
                )
            }
            (_, some) => {
                let range = self.over.words(format!("{} to {}", first.at.across(), last.at.across()));
                format!(
                    "Starts leave the cam for good at {some} of {} {}s, {range}: all of them at {all}. Nothing brings the follower back.",
                    self.run,
                    self.over.value(),
                )
            }
        };
        Some(OffForGood { words, shares: self.off.clone() })
    }

    /// Returns the value at which the follower first leaves the cam, or ceases to, and its uncertainty. None outside the range, or if
    /// there is no such value.
    pub fn detachment(&self) -> Option<[f64; 2]> {
        match self.separation {
            Some(Separation::At { rpm, error, .. }) => {
                (self.range[0] <= rpm && rpm <= self.range[1]).then_some([rpm, error])
            }
            Some(_) => None,
            None => {
                let end = self.detachment_end()?;
                Some([end.value(), 0.5 * (end.bracket[1] - end.bracket[0])])
            }
        }
    }

    /// The first end of an attractor at which the follower begins or ceases to leave the cam.
    fn detachment_end(&self) -> Option<&Transition> {
        let ends = self.attractors.iter().flat_map(|row| row.birth.iter().chain(&row.death));
        ends.into_iter().find(|end| end.cause == Cause::Detachment)
    }

    /// Uncertainty of the machine in the detachment; none for an exact machine, or if unknown.
    pub fn detachment_error(&self) -> Option<SourcedUncertainty> {
        self.detachment()?;
        let error = if self.separation.is_some() { self.separation_error } else { self.detachment_end()?.error };
        error.filter(|error| error.total().is_finite())
    }

    /// Returns the speed of the fastest impact seen on an attractor, m/s relative to the cam, and its value.
    pub fn hardest(&self) -> Option<[f64; 2]> {
        let all = self.attractors.iter().flat_map(|attractor| &attractor.at);
        let all = all.filter_map(|at| Some([at.impact_speed?, at.value()]));
        all.max_by(|one, other| one[0].total_cmp(&other[0]))
    }
}

impl Coexistence {
    /// Lowest and highest value.
    pub fn range(&self) -> [f64; 2] {
        self.ends.map(|end| end.across())
    }
}

impl AttractorRow {
    /// Lowest and highest value.
    pub fn range(&self) -> [f64; 2] {
        self.ends.map(|end| end.across())
    }

    /// Returns the rate at which the attractor rests, if its runs wandered long enough.
    pub fn rests(&self) -> Option<Rests> {
        /// Least number of revolutions: as many as the runs of one value are followed for together.
        const TOLD: u64 = 100_000;
        let is_wandering = |at: &&At| matches!(at.ending, LongRun::Chaotic(_)) || at.ending.is_long();
        let all = self.at.iter().filter(is_wandering).fold(Wandering::default(), |all, at| all.with(at.wandering));
        let (rests, revolutions) = (all.rested, all.revolutions);
        let per = |count: f64| count / revolutions as f64;
        (revolutions >= TOLD).then(|| match rests {
            0 => Rests { rests, revolutions, rate: per(HIT), rate_error: None },
            _ => Rests { rests, revolutions, rate: per(rests as f64), rate_error: Some(per((rests as f64).sqrt())) },
        })
    }
}

/// Returns the default range of speeds, rpm. It goes from below the speed at which the follower first leaves the cam up to the fastest of
/// `[study]`. Without a study it ends at twice that speed, or at twice the machine's own speed if the follower never leaves.
pub fn usual_range(model: &Model) -> Result<[f64; 2], ModelError> {
    let machine = machine(model, FALLBACK)?;
    let own = own_speed(&machine).unwrap_or(FALLBACK);
    let leaves = Contact::new(machine.cam(), model.follower).separation().speed();
    let leaves = Some(leaves).filter(|rpm| *rpm > 0.0 && rpm.is_finite());
    let low = two_digits(leaves.map_or(0.5 * own, |rpm| 0.8 * rpm), f64::floor);
    let high = two_digits(2.0 * leaves.unwrap_or(own), f64::ceil);
    Ok(model.study.map_or([low, high], |study| [low.min(study.rpm_min), study.rpm_max]))
}

/// The own speed, rpm, of a machine without a time scale: no force acts on its follower.
const FALLBACK: f64 = 100.0;

/// Rounds a speed to two digits.
fn two_digits(rpm: f64, towards: fn(f64) -> f64) -> f64 {
    let scale = elementary::powf(10_f64, 1.0 - elementary::log10(rpm).floor());
    towards(rpm * scale) / scale
}

/// Surveys a machine over a range of speeds, rpm, or of values of another number. `watch` is notified at each value.
pub fn speeds(
    over: &Over<'_>,
    range: [f64; 2],
    resolution: &Resolution,
    watch: &dyn Watch,
) -> Result<SpeedSurvey, AttractorsError> {
    let Attractors { grid, mut families, coexistence, separation, .. } = attractors(over, range, resolution, watch)?;
    watch.at("uncertainty of the results", 0, 0);
    let lowest = machine(over.model, if over.is_speed() { range[0] } else { over.rpm })?;
    let machines = PlausibleMachines::of(over.model, lowest.cam())?;
    let known = separation.map(|separation| known(separation, &machines));
    let (separation, separation_errors) = known.map_or((None, None), |(found, errors)| (Some(found), errors));
    let separation_error = separation_errors.map(|[error, _]| error);
    if machines.uncertain().is_some() {
        let (grid, runs) = (&grid[..], (&resolution.sample, resolution.budget));
        let ends = UncertainEnds { over, range, grid, runs, machines: &machines, separation: separation_error };
        ends.put(&mut families);
    }
    watch.at("corner impacts on the way", 0, 0);
    let dangers = dangers(over, &families, range);
    let is_inside = |at: &&GridValue| range[0] <= at.value && at.value <= range[1];
    let row = |(index, family): (usize, &AttractorFamily)| {
        let at = family.at.iter().filter_map(|(place, attractor)| {
            let at = grid.get(*place).filter(is_inside)?;
            let here = at.found.as_ref().ok()?;
            let attractor = here.attractors.get(*attractor)?;
            let impacts = over.machine(at.value).ok().and_then(|machine| impacts(&machine, attractor).ok());
            let share = resolution.sample.share(here.count(attractor), here.run());
            Some(At::new(over.place(at.value), (here, attractor), share, impacts.unwrap_or_default()))
        });
        let at: Vec<At> = at.collect();
        let only = |number: fn((u64, u64)) -> u64| {
            let mut numbers = at.iter().map(|at| at.ending.period().map(number));
            let first = numbers.next()??;
            numbers.all(|other| other == Some(first)).then_some(first)
        };
        let most = kinds(&at).into_iter().max_by_key(|(_, count)| *count);
        AttractorRow {
            id: name(index),
            kind: most.map_or_else(|| family.kind(&grid), |(kind, _)| kind),
            revolutions: family.period().map_or_else(|| only(|period| period.0), |period| Some(period.0)),
            impacts: family.period().map_or_else(|| only(|period| period.1), |period| Some(period.1)),
            ends: family.range.map(|end| over.place(end)),
            birth: family.ends[0].clone(),
            death: family.ends[1].clone(),
            at,
        }
    };
    let run = || grid.iter().filter(is_inside).filter_map(|at| Some((over.place(at.value), at.found.as_ref().ok()?)));
    let off = run().filter(|(_, here)| here.off_for_good > 0);
    let off = off.map(|(at, here)| Off { at, share: resolution.sample.share(here.off_for_good, here.run()) }).collect();
    let failed = |at: &GridValue| {
        let (starts, why) = match &at.found {
            Err(error) => (None, error.to_string()),
            Ok(here) => (Some(here.failed.len()), here.failed.first()?.1.to_string()),
        };
        Some(FailedValue { at: over.place(at.value), starts, why })
    };
    Ok(SpeedSurvey {
        model: over.model.name.clone(),
        over: over.varied(resolution.step.spacing),
        range,
        step: resolution.step.width(),
        sample: resolution.sample.clone(),
        budget: resolution.budget,
        two_impacts: resolution.two_impacts,
        separation,
        separation_error,
        off,
        run: run().count(),
        measured: machines.measured(),
        errors: over.model.errors.without(over.parameter.name()),
        attractors: families.par_iter().enumerate().map(row).collect(),
        coexistence: coexistence
            .iter()
            .map(|several| Coexistence {
                ends: several.range.map(|end| over.place(end)),
                attractors: several.families.iter().map(|index| name(*index)).collect(),
            })
            .collect(),
        dangers,
        failed: grid.iter().filter(is_inside).filter_map(failed).collect(),
    })
}

/// Returns the kinds of an attractor over its values, each with the number of values, by kind.
#[doc(hidden)]
pub fn kinds(at: &[At]) -> Vec<(Kind, usize)> {
    let mut counts: BTreeMap<Kind, usize> = BTreeMap::new();
    at.iter().for_each(|at| *counts.entry(at.ending.kind()).or_default() += 1);
    counts.into_iter().collect()
}

/// Finds the dangers at corner impacts that attractors pass, begin or end with.
fn dangers(over: &Over<'_>, families: &[AttractorFamily], range: [f64; 2]) -> Vec<PassedDanger> {
    let mut passed = Vec::new();
    for (index, family) in families.iter().enumerate() {
        for point in family.corner_impacts(range) {
            let Ok((model, cam)) = over.model(point.value) else { continue };
            let Some(at) = on_branch(&cam, point).and_then(|at| at.confirmed(&model, &cam).ok()) else { continue };
            let value = if over.is_speed() { at.speed_rpm() } else { point.value };
            passed.push((value, at, name(index)));
        }
    }
    let danger = |(value, at, attractors): (f64, CornerImpact, Vec<String>)| {
        let (model, cam) = over.model(value).ok()?;
        let danger = routes::danger(&model, &cam, &at)?;
        Some(PassedDanger { attractors, at: over.place(value), cam_angle: at.corner.angle, danger })
    };
    passed_once(passed).into_par_iter().filter_map(danger).collect()
}

/// Returns each corner impact once, by rising value, with the names of the attractors that pass it.
#[doc(hidden)]
pub fn passed_once(passed: Vec<(f64, CornerImpact, String)>) -> Vec<(f64, CornerImpact, Vec<String>)> {
    let mut found: Vec<(f64, CornerImpact, Vec<String>)> = Vec::new();
    for (value, at, name) in passed {
        let same = |(other, known, _): &&mut (f64, CornerImpact, Vec<String>)| {
            known.corner.angle == at.corner.angle && (other - value).abs() <= tolerance::SAME_ORBIT.value * value.abs()
        };
        match found.iter_mut().find(same) {
            Some((.., names)) => names.push(name),
            None => found.push((value, at, vec![name])),
        }
    }
    found.sort_by(|(one, ..), (other, ..)| one.total_cmp(other));
    found.iter_mut().for_each(|(.., names)| names.dedup());
    found
}

fn name(index: usize) -> String {
    format!("A{}", index + 1)
}

impl At {
    /// The value; for the speed, rpm.
    pub fn value(&self) -> f64 {
        self.place.across()
    }

    fn new(
        place: Place,
        (here, attractor): (&AttractorsAtValue, &Attractor),
        share: Estimate,
        impacts: Vec<[f64; 2]>,
    ) -> Self {
        let impact_speed = impacts.iter().map(|[_, speed]| *speed).reduce(f64::max);
        let impact_angles = impacts.into_iter().map(|[angle, _]| angle).collect();
        let (ending, followed, wandering) = (attractor.ending.clone(), attractor.followed(), here.wandering);
        Self { place, share, ending, followed, wandering, impact_angles, impact_speed }
    }
}

/// Returns the impacts of an attractor: the cam angle, rad, and the speed relative to the cam, m/s. They cover one period, or as many
/// revolutions as a picture has room for.
fn impacts(machine: &Machine, attractor: &Attractor) -> Result<Vec<[f64; 2]>, SimulateError> {
    /// Revolutions that a picture has room for.
    const SHOWN: u64 = 120;
    /// Largest number of impacts: before a rest there may be any number.
    const MOST: usize = 600;
    if let LongRun::Orbit(orbit) = &attractor.ending {
        let of =
            |impact: &crate::simulate::Event| [impact.cam_angle, (impact.velocity_before - impact.cam_velocity).abs()];
        return Ok(orbit.impacts().map(of).collect());
    }
    let mut motion = machine.resume(&attractor.motion)?;
    let mut impacts = Vec::new();
    machine.watch(&mut motion, SHOWN, |event| {
        if event.kind == EventKind::Impact && impacts.len() < MOST {
            impacts.push([event.cam_angle, (event.velocity_before - event.cam_velocity).abs()]);
        }
    })?;
    Ok(impacts)
}
