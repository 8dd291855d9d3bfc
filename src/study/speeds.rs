//! What a machine does at which speed: its attractors, where each begins and ends, and how many starts end on each.

use std::collections::BTreeMap;

use rayon::prelude::*;
use serde::Serialize;

use crate::border_collision::Danger;
use crate::cam::Cam;
use crate::corner::CornerImpact;
use crate::corner::candidates::on_branch;
use crate::estimate::Estimate;
use crate::known::Known;
use crate::measured::{Likely, Measured};
use crate::model::{Model, ModelError};
use crate::orbit::branch::Event;
use crate::orbit::cycle::own_speed;
use crate::orbit::long_run::{Budget, Kind, LongRun};
use crate::progress::Watch;
use crate::simulate::{EventKind, Machine, SimulateError, angular_velocity};
use crate::study::attractors::rows::Asked;
use crate::study::attractors::{Attractors, AttractorsError, Cause, Change, Grid, Here, Resolution, Row, attractors};
use crate::study::compared;
use crate::study::design::contact::{Contact, Separation};
use crate::study::design::known;
use crate::study::machine;
use crate::study::survey::{Part, Sample, Wandering};
use crate::tolerance;

/// What a machine does over a range of speeds: the document of `speeds --json`.
#[derive(Clone, Debug)]
pub struct Speeds {
    /// The model's name.
    pub model: String,
    /// The range, rpm.
    pub rpm: [f64; 2],
    /// From one speed to the next, rpm.
    pub step: f64,
    /// The starts at each speed.
    pub sample: Sample,
    /// For how long runs were followed.
    pub budget: Budget,
    /// Whether runs began on the stable orbits of two impacts in one revolution, too.
    pub two_impacts: bool,
    /// Where the follower first leaves the cam above the lowest speed, by the force between them; its error has what a measured cam leaves open.
    pub separation: Separation,
    /// How well the cam is known, if it is measured.
    pub measured: Option<Measured>,
    /// The attractors, by rising speed.
    pub attractors: Vec<Attractor>,
    /// Where there are several.
    pub coexistence: Vec<Coexistence>,
    /// Corner impacts of its attractors at which there is danger, by rising speed.
    pub dangers: Vec<PassedDanger>,
    /// Speeds at which starts leave the cam for good, by rising speed, and how many do.
    pub off: Vec<Off>,
    /// How many speeds of the range were run.
    pub run: usize,
    /// Speeds at which nothing, or not every start, could be run.
    pub failed: Vec<Failed>,
}

document!(Speeds as it {
    schema: "corner-impact/speeds/1",
    model: it.model,
    rpm: it.rpm,
    known: Known::Sampled,
    step_rpm: it.step,
    starts: it.sample.count(),
    given if_any: matches!(it.sample, Sample::Given(_)).then_some(true),
    budget: it.budget,
    two_impacts: it.two_impacts,
    missed_below_share: it.missed(),
    detachment_rpm: it.detachment().map(|[rpm, _]| rpm),
    detachment_error_rpm if_any: it.detachment_error(),
    measured if_any: it.measured,
    attractors: it.attractors,
    coexistence: it.coexistence,
    off_for_good if_any: it.off_for_good(),
    dangers: it.dangers,
    failed: it.failed,
});

/// The share of the sample's starts that leave the cam for good at a speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Off {
    /// rpm.
    pub rpm: f64,
    /// Their share.
    pub share: Estimate,
}

document!(Off as it { speed_rpm: it.rpm, share: it.share.value, error: it.share.error });

/// Which starts leave the cam for good: a flight that never comes down to it again ends on no attractor that has impacts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OffForGood {
    /// In a sentence.
    pub words: String,
    /// At each speed at which there are any.
    pub shares: Vec<Off>,
}

/// An attractor over a range of speeds.
#[derive(Clone, Debug)]
pub struct Attractor {
    /// Its name.
    pub id: String,
    /// What it is at most of the speeds.
    pub kind: Kind,
    /// Turns of the cam in one period, where it is the same at every speed.
    pub revolutions: Option<u64>,
    /// Impacts in one period, likewise.
    pub impacts: Option<u64>,
    /// Lowest and highest speed, rpm.
    pub rpm: [f64; 2],
    /// What it begins with at the lowest speed; nothing at the end of the range.
    pub birth: Option<Change>,
    /// What it ends with at the highest.
    pub death: Option<Change>,
    /// What it is at each speed of the grid, by rising speed.
    pub at: Vec<At>,
}

document!(Attractor as it {
    id: it.id,
    kind: it.kind,
    revolutions: it.revolutions,
    impacts: it.impacts,
    from_rpm: it.rpm[0],
    to_rpm: it.rpm[1],
    birth: it.birth,
    death: it.death,
    rests: it.rests(),
    shares: it.at,
});

/// An attractor at one speed.
#[derive(Clone, Debug, PartialEq)]
pub struct At {
    /// rpm.
    pub rpm: f64,
    /// The share of the sample's starts that end on it. They are spread better than by chance, so that its error errs on the
    /// large side.
    pub share: Estimate,
    /// What it is.
    pub ending: LongRun,
    /// Revolutions that its runs were followed for, all together.
    pub followed: u64,
    /// What runs did that neither rested nor came to an orbit soon.
    pub wandering: Wandering,
    /// Cam angles of its impacts, rad.
    pub impact_angles: Vec<f64>,
    /// The fastest of its impacts, relative to the cam, m/s; nothing where it has none.
    pub impact_speed: Option<f64>,
}

document!(At as it {
    speed_rpm: it.rpm,
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

/// How often chaos rests on the cam, from runs that had wandered for long.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rests {
    /// Rests that were seen.
    pub rests: u64,
    /// In so many revolutions.
    pub revolutions: u64,
    /// A revolution: their ratio, and its standard error; of no rest at all the bound that it is below with 95 %.
    pub rate: f64,
    /// None where there is no rest.
    pub rate_error: Option<f64>,
}

/// Two or more attractors at the same speeds, each of which runs have come to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Coexistence {
    /// Lowest speed, rpm.
    pub from_rpm: f64,
    /// Highest speed, rpm.
    pub to_rpm: f64,
    /// Their names.
    pub attractors: Vec<String>,
}

/// A corner impact that attractors pass, begin or end with, and at which there is danger.
#[derive(Clone, Debug)]
pub struct PassedDanger {
    /// The attractors' names.
    pub attractors: Vec<String>,
    /// rpm.
    pub speed_rpm: f64,
    /// Where the corner is, rad.
    pub cam_angle: f64,
    /// By the local map of the corner impact.
    pub danger: Danger,
}

document!(PassedDanger as it {
    attractors: it.attractors,
    speed_rpm: it.speed_rpm,
    cam_angle_rad: it.cam_angle,
    danger: it.danger,
});

/// A speed at which nothing, or not every start, could be run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Failed {
    /// rpm.
    pub speed_rpm: f64,
    /// How many starts could not be run; none are named where nothing could.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub starts: Option<usize>,
    /// Why.
    pub why: String,
}

/// -ln(0.05): the mean number of starts in a basin that is hit by one of them with 95 %.
const HIT: f64 = 2.995_732_273_553_991;

impl Speeds {
    /// The share of the starts' rectangle that a basin has which one of the starts of a speed hits with 95 %, if they were drawn by
    /// chance.
    pub fn missed(&self) -> f64 {
        (HIT / self.sample.count() as f64).min(1.0)
    }

    /// Which starts leave the cam for good, if any do.
    pub fn off_for_good(&self) -> Option<OffForGood> {
        let ([first, .., last] | [first @ last]) = self.off.as_slice() else { return None };
        let all = self.off.iter().filter(|off| off.share.value == 1.0).count();
        let words = match (all, self.off.len()) {
            (all, _) if all == self.run => {
                "Every start leaves the cam for good, at every speed that was run: nothing brings the follower back."
                    .into()
            }
            (_, some) => format!(
                "Starts leave the cam for good at {some} of {} speeds, {} to {} rpm: all of them at {all}. Nothing brings the follower back.",
                self.run, first.rpm, last.rpm
            ),
        };
        Some(OffForGood { words, shares: self.off.clone() })
    }

    /// The speed at which the follower first leaves the cam, and how far that may be off, rpm; none outside of the range, or where there is no
    /// such speed.
    pub fn detachment(&self) -> Option<[f64; 2]> {
        let Separation::At { rpm, error, .. } = self.separation else { return None };
        (self.rpm[0] <= rpm && rpm <= self.rpm[1]).then_some([rpm, error])
    }

    /// How far a measured cam may have moved the detachment, rpm; none of another cam, or where that is not known.
    pub fn detachment_error(&self) -> Option<f64> {
        Measured::noisy(&self.measured)?;
        self.detachment().map(|[_, error]| error).filter(|error| error.is_finite())
    }

    /// The fastest impact that was seen on an attractor, m/s relative to the cam, and at which speed, rpm.
    pub fn hardest(&self) -> Option<[f64; 2]> {
        let all = self.attractors.iter().flat_map(|attractor| &attractor.at);
        let all = all.filter_map(|at| Some([at.impact_speed?, at.rpm]));
        all.max_by(|one, other| one[0].total_cmp(&other[0]))
    }
}

impl Attractor {
    /// How often it rests, if runs of it wandered for long enough to tell.
    pub fn rests(&self) -> Option<Rests> {
        /// Revolutions: what the runs of one speed are given.
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

/// The range of speeds to look at where none is named, rpm: from below the speed at which the follower first leaves the cam up to
/// the fastest of `[study]`, or twice that speed, or twice the machine's own where it never does.
pub fn usual_range(model: &Model) -> Result<[f64; 2], ModelError> {
    let machine = machine(model, FALLBACK)?;
    let own = own_speed(&machine).unwrap_or(FALLBACK);
    let leaves = Contact::new(machine.cam(), model.follower).separation().speed();
    let leaves = Some(leaves).filter(|rpm| *rpm > 0.0 && rpm.is_finite());
    let low = two_digits(leaves.map_or(0.5 * own, |rpm| 0.8 * rpm), f64::floor);
    let high = two_digits(2.0 * leaves.unwrap_or(own), f64::ceil);
    Ok(model.study.map_or([low, high], |study| [low.min(study.rpm_min), study.rpm_max]))
}

/// The own speed of a machine that has no scale of time, rpm: no force is on its follower.
const FALLBACK: f64 = 100.0;

/// A speed as a person would choose it.
fn two_digits(rpm: f64, towards: fn(f64) -> f64) -> f64 {
    let scale = 10_f64.powf(1.0 - rpm.log10().floor());
    towards(rpm * scale) / scale
}

/// What `model` does over a range of speeds, rpm; `watch` is told speed by speed.
pub fn speeds(
    model: &Model,
    range: [f64; 2],
    resolution: &Resolution,
    watch: &dyn Watch,
) -> Result<Speeds, AttractorsError> {
    let Attractors { grid, mut rows, coexistence, separation, .. } = attractors(model, range, resolution, watch)?;
    let lowest = machine(model, range[0])?;
    watch.at("what the measured cam leaves open", 0, 0);
    let likely = Likely::of(model)?;
    let noisy = likely.as_ref().filter(|likely| likely.best.is_some());
    let separation = known(separation, noisy);
    if let Some(likely) = noisy {
        rows.par_iter_mut().for_each(|row| {
            let errors = [0, 1].map(|side| {
                error((&lowest, (&resolution.sample, resolution.budget)), (likely, separation), row, side, &grid)
            });
            for (change, error) in row.ends.iter_mut().zip(errors) {
                change.iter_mut().for_each(|change| change.error = error);
            }
        });
    }
    watch.at("corner impacts on the way", 0, 0);
    let dangers = dangers(model, lowest.cam(), &rows, range);
    let is_inside = |rpm: f64| range[0] <= rpm && rpm <= range[1];
    let attractor = |(index, row): (usize, &Row)| {
        let at = row.at.iter().filter_map(|(place, part)| {
            let here = grid.get(*place)?.as_ref().ok().filter(|here| is_inside(here.rpm))?;
            let part = here.parts.get(*part)?;
            let machine = lowest.at_speed(angular_velocity(here.rpm));
            Some(At::new(here, part, impacts(&machine, part).unwrap_or_default()))
        });
        let at: Vec<At> = at.collect();
        let only = |number: fn((u64, u64)) -> u64| {
            let mut numbers = at.iter().map(|at| at.ending.period().map(number));
            let first = numbers.next()??;
            numbers.all(|other| other == Some(first)).then_some(first)
        };
        Attractor {
            id: name(index),
            kind: most(&at).unwrap_or_else(|| row.kind(&grid)),
            revolutions: row.period().map_or_else(|| only(|period| period.0), |period| Some(period.0)),
            impacts: row.period().map_or_else(|| only(|period| period.1), |period| Some(period.1)),
            rpm: row.rpm,
            birth: row.ends[0].clone(),
            death: row.ends[1].clone(),
            at,
        }
    };
    let run = || grid.iter().filter_map(|found| found.as_ref().ok()).filter(|here| is_inside(here.rpm));
    let off = run().filter(|here| here.off_for_good > 0);
    let off = off.map(|here| Off { rpm: here.rpm, share: Estimate::share(here.off_for_good, here.sampled) }).collect();
    let failed = |found: &Result<Here, (f64, SimulateError)>| {
        let (speed_rpm, starts, error) = match found {
            Err((rpm, error)) => (*rpm, None, *error),
            Ok(here) => (here.rpm, Some(here.failed.len()), here.failed.first()?.1),
        };
        is_inside(speed_rpm).then(|| Failed { speed_rpm, starts, why: error.to_string() })
    };
    Ok(Speeds {
        model: model.name.clone(),
        rpm: range,
        step: resolution.step.rpm(),
        sample: resolution.sample.clone(),
        budget: resolution.budget,
        two_impacts: resolution.two_impacts,
        separation,
        off,
        run: run().count(),
        measured: likely.map(|likely| likely.measured),
        attractors: rows.par_iter().enumerate().map(attractor).collect(),
        coexistence: coexistence
            .iter()
            .map(|over| Coexistence {
                from_rpm: over.rpm[0],
                to_rpm: over.rpm[1],
                attractors: over.rows.iter().map(|index| name(*index)).collect(),
            })
            .collect(),
        dangers,
        failed: grid.iter().filter_map(failed).collect(),
    })
}

/// The kind that an attractor is at most speeds of the range.
fn most(at: &[At]) -> Option<Kind> {
    let mut counts: BTreeMap<Kind, usize> = BTreeMap::new();
    at.iter().for_each(|at| *counts.entry(at.ending.kind()).or_default() += 1);
    counts.into_iter().max_by_key(|(_, count)| *count).map(|(kind, _)| kind)
}

/// The dangers at corner impacts that attractors pass, begin or end with.
fn dangers(model: &Model, cam: &Cam, rows: &[Row], range: [f64; 2]) -> Vec<PassedDanger> {
    let mut places: Vec<(CornerImpact, Vec<String>)> = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let found = row.corner_impacts(range).filter_map(|point| on_branch(cam, point)?.confirmed(model, cam).ok());
        for at in found {
            let same = |other: &CornerImpact| {
                other.corner.angle == at.corner.angle
                    && (other.period - at.period).abs() <= tolerance::SAME_ORBIT.value * at.period
            };
            match places.iter_mut().find(|(other, _)| same(other)) {
                Some((_, names)) => names.push(name(index)),
                None => places.push((at, vec![name(index)])),
            }
        }
    }
    places.sort_by(|(one, _), (other, _)| other.period.total_cmp(&one.period));
    let danger = |(at, mut attractors): (CornerImpact, Vec<String>)| {
        let danger = compared::danger(model, cam, &at)?;
        attractors.dedup();
        Some(PassedDanger { attractors, speed_rpm: at.speed_rpm(), cam_angle: at.corner.angle, danger })
    };
    places.into_par_iter().filter_map(danger).collect()
}

/// How far a measured cam may have moved what an attractor begins or ends with, rpm: by the event's equations, or by runs where it is
/// known by runs.
fn error(
    (machine, runs): (&Machine, Asked<'_>),
    (likely, separation): (&Likely, Separation),
    row: &Row,
    side: usize,
    grid: &Grid,
) -> Option<f64> {
    let change = row.ends[side].as_ref()?;
    let (rpm, speed) = (change.rpm, angular_velocity(change.rpm));
    let machine = machine.at_speed(speed);
    let event = change.point.as_ref().and_then(|point| Event::of_point(&machine, point));
    let by_equations = |moved: &(dyn Fn(&Model, &Cam) -> Option<f64> + Sync)| {
        likely.error([rpm], |model, cam| moved(model, cam).map(|rpm| [rpm])).map(|[error]| error)
    };
    match (change.cause, event) {
        // One speed has one error.
        (Cause::Detachment, _) => match separation {
            Separation::At { error, .. } => Some(error).filter(|error| error.is_finite()),
            _ => None,
        },
        (_, Some(event)) => by_equations(&|model, cam| event.moved(model, cam)),
        (Cause::Runs, None) => likely.error_by_runs(rpm, |model, cam| {
            row.moved(&Machine::new(cam.clone(), &model.follower, speed), grid, runs, side)
        }),
        _ => None,
    }
}

fn name(index: usize) -> String {
    format!("A{}", index + 1)
}

impl At {
    fn new(here: &Here, part: &Part, impacts: Vec<[f64; 2]>) -> Self {
        let impact_speed = impacts.iter().map(|[_, speed]| *speed).reduce(f64::max);
        let impact_angles = impacts.into_iter().map(|[angle, _]| angle).collect();
        let share = Estimate::share(here.count(part), here.sampled);
        let (rpm, ending, followed, wandering) = (here.rpm, part.ending.clone(), part.followed(), here.wandering);
        Self { rpm, share, ending, followed, wandering, impact_angles, impact_speed }
    }
}

/// Where the impacts of an attractor are, cam angles in rad, and how fast relative to the cam, m/s: of a period, or of as many
/// revolutions as a picture has room for.
fn impacts(machine: &Machine, part: &Part) -> Result<Vec<[f64; 2]>, SimulateError> {
    /// Revolutions that a picture has room for.
    const SHOWN: u64 = 120;
    /// Impacts of them: before a rest there are any number.
    const MOST: usize = 600;
    if let LongRun::Orbit(orbit) = &part.ending {
        let of =
            |impact: &crate::simulate::Event| [impact.cam_angle, (impact.velocity_before - impact.cam_velocity).abs()];
        return Ok(orbit.impacts().map(of).collect());
    }
    let mut motion = machine.resume(&part.motion)?;
    let mut impacts = Vec::new();
    machine.watch(&mut motion, SHOWN, |event| {
        if event.kind == EventKind::Impact && impacts.len() < MOST {
            impacts.push([event.cam_angle, (event.velocity_before - event.cam_velocity).abs()]);
        }
    })?;
    Ok(impacts)
}
