//! One machine at speeds on either side of its corner impact: the orbits of one impact a revolution, stable or not, and
//! the attractors of runs with falling and with rising speed.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use rayon::prelude::*;
use serde::Serialize;

use corner_impact::cam::{Cam, Lift};
use corner_impact::corner::CornerImpact;
use corner_impact::model::Model;
use corner_impact::orbit::{Course, Cycle, Eigenvalue, PeriodicOrbit, Search, Stability, search};
use corner_impact::section::trace;
use corner_impact::simulate::{Event, EventKind, Machine, Motion, SimulateError, angular_velocity};

/// Speeds on each side of the corner impact.
const SPEEDS: usize = 90;
/// Distance of the slowest and the fastest speed from the corner impact, relative to its speed, where `[study]` allows.
const REACH: f64 = 0.06;
/// Revolutions of a run at each speed before recording, and recorded revolutions.
const SETTLING: u64 = 400;
const RECORDED: u64 = 24;
/// Revolutions of a run that are drawn in full, and samples of each revolution and of an orbit.
const DRAWN: u64 = 2;
const SAMPLES: u32 = 72;
/// Samples of the cam: four to a degree.
const CAM_SAMPLES: usize = 1440;

/// Orbits and runs at one speed.
#[derive(Clone, Debug, Serialize)]
pub struct Moment {
    /// Speed, rpm.
    pub rpm: f64,
    /// Every orbit of one impact a revolution. At the corner impact the single orbit appears twice: with the law before the corner
    /// and with the law after it.
    pub orbits: Vec<ShownOrbit>,
    /// Attractor of the run with falling speed.
    pub slowing: SettledRun,
    /// Attractor of the run with rising speed.
    pub speeding: SettledRun,
}

/// Position of an orbit's impact relative to the corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ImpactSide {
    /// On the segment that ends at the corner.
    Before,
    /// On the segment that starts at the corner.
    After,
    /// On another segment of the cam.
    Elsewhere,
}

corner_impact::named!(ImpactSide);

/// An orbit at one speed, with its impact.
#[derive(Clone, Debug, Serialize)]
#[expect(missing_docs, reason = "names carry what a number is, and its unit")]
pub struct ShownOrbit {
    /// Position of the impact relative to the corner.
    pub place: ImpactSide,
    pub stable: bool,
    pub stability: Stability,
    /// Cam angle of the impact.
    pub angle_deg: f64,
    /// Cam angle of the impact minus that of the corner.
    pub from_corner_deg: f64,
    pub position_m: f64,
    pub velocity_before_m_s: f64,
    pub velocity_after_m_s: f64,
    pub multipliers: [Eigenvalue; 2],
    /// The larger modulus of the two multipliers.
    pub modulus: f64,
    /// One revolution with its impact: cam angle, deg, from 0 to 360, and position, m.
    pub path: Vec<[f64; 2]>,
}

impl ShownOrbit {
    fn new(place: ImpactSide, impact: &Event, corner: f64, orbit: &PeriodicOrbit, path: Vec<[f64; 2]>) -> Self {
        let (angle_deg, multipliers) = (impact.cam_angle.to_degrees(), orbit.multipliers());
        Self {
            place,
            stable: orbit.is_stable(),
            stability: orbit.judgement.stability,
            angle_deg,
            from_corner_deg: (angle_deg - corner.to_degrees() + 540.0).rem_euclid(360.0) - 180.0,
            position_m: impact.position,
            velocity_before_m_s: impact.velocity_before,
            velocity_after_m_s: impact.velocity_after,
            multipliers,
            modulus: multipliers.iter().fold(0.0_f64, |largest, multiplier| largest.max(multiplier.modulus())),
            path,
        }
    }
}

/// Attractor of a run.
#[derive(Clone, Debug, Serialize)]
pub struct SettledRun {
    /// Cam angles of its impacts, rounded to a tenth of a degree, without repetition.
    pub impacts_deg: Vec<f64>,
    /// Description in words.
    pub words: String,
    /// Some of its revolutions with their impacts: cam angle, deg, and position, m. Empty for a run with rising speed.
    pub paths: Vec<Vec<[f64; 2]>>,
}

impl SettledRun {
    /// Most impact positions that are listed one by one.
    const TOLD: usize = 4;

    /// A run from its impacts, rad, in the recorded revolutions.
    fn new(impacts: &[f64], revolutions: u64, paths: Vec<Vec<[f64; 2]>>) -> Self {
        const ROUND: i64 = 3600;
        let tenth = |angle: &f64| ((angle.to_degrees() * 10.0).round() as i64).rem_euclid(ROUND);
        let tenths: BTreeSet<i64> = impacts.iter().map(tenth).collect();
        let impacts_deg: Vec<f64> = tenths.into_iter().map(|tenth| tenth as f64 / 10.0).collect();
        let words = match impacts_deg.as_slice() {
            [] => "no impact: it stays on the cam, or clear of it".to_owned(),
            [angle] => format!("all its impacts at {angle}°"),
            angles if angles.len() <= Self::TOLD => {
                let angles: Vec<String> = angles.iter().map(|angle| format!("{angle}°")).collect();
                format!("impacts at {}", angles.join(", "))
            }
            angles => {
                format!("impacts at {} angles, to a tenth of a degree, in {revolutions} revolutions", angles.len())
            }
        };
        Self { impacts_deg, words, paths }
    }
}

/// Every orbit of one impact a revolution at speeds around `at`, and the attractors of runs there, by rising speed, with the index
/// of the corner impact's own speed. `None` if the corner impact is not on an orbit of one impact a revolution.
///
/// Fails if a run cannot continue.
pub fn through_corner(
    model: &Model,
    cam: &Cam,
    at: &CornerImpact,
) -> Result<Option<(Vec<Moment>, usize)>, SimulateError> {
    if !at.is_simple() {
        return Ok(None);
    }
    let machine = Machine::new(cam.clone(), &model.follower, at.angular_velocity());
    let (speeds, at_corner) = speeds(model, at);
    let orbits: Result<Vec<Vec<ShownOrbit>>, SimulateError> = speeds
        .par_iter()
        .enumerate()
        .map(|(index, rpm)| {
            let machine = machine.at_speed(angular_velocity(*rpm));
            if index == at_corner { Ok(on_corner(&machine, at)) } else { orbits(&machine, at) }
        })
        .collect();
    let falling = || runs(&machine, speeds.iter().rev(), DRAWN);
    let rising = || runs(&machine, speeds.iter(), 0);
    let (slowing, speeding) = rayon::join(falling, rising);
    let (slowing, speeding) = (slowing?.into_iter().rev(), speeding?.into_iter());
    let found = speeds.iter().zip(orbits?).zip(slowing.zip(speeding));
    let moments =
        found.map(|((rpm, orbits), (slowing, speeding))| Moment { rpm: *rpm, orbits, slowing, speeding }).collect();
    Ok(Some((moments, at_corner)))
}

/// Speeds, rpm, ascending and densest at the corner impact, with the index of the corner impact's speed.
fn speeds(model: &Model, at: &CornerImpact) -> (Vec<f64>, usize) {
    let corner = at.speed_rpm();
    let [mut low, mut high] = [corner * (1.0 - REACH), corner * (1.0 + REACH)];
    if let Some(study) = model.study {
        (low, high) = (low.max(study.rpm_min), high.min(study.rpm_max));
    }
    // Squared, to be densest at the corner impact: a border collision moves its orbits in proportion to the change of the speed.
    let part = |index: usize| (index as f64 / SPEEDS as f64).powi(2);
    let slower = (1..=SPEEDS).rev().map(|index| corner + (low - corner) * part(index)).filter(|rpm| *rpm < corner);
    let faster = (1..=SPEEDS).map(|index| corner + (high - corner) * part(index)).filter(|rpm| *rpm > corner);
    let mut speeds: Vec<f64> = slower.collect();
    let index = speeds.len();
    speeds.push(corner);
    speeds.extend(faster);
    (speeds, index)
}

/// The segments before and after the corner.
fn sides(machine: &Machine, at: &CornerImpact) -> [usize; 2] {
    [machine.cam().before(at.corner.segment), at.corner.segment]
}

fn orbits(machine: &Machine, at: &CornerImpact) -> Result<Vec<ShownOrbit>, SimulateError> {
    let [before, after] = sides(machine, at);
    let found = search(machine, &Search { revolutions: 1, impacts: Some(1) })?;
    let shown = |orbit: &PeriodicOrbit| {
        let impact = *orbit.impacts().next()?;
        let Course::Impacts(cycle) = &orbit.course else { return None };
        let place = match impact.segment {
            segment if segment == before => ImpactSide::Before,
            segment if segment == after => ImpactSide::After,
            _ => ImpactSide::Elsewhere,
        };
        Some(ShownOrbit::new(place, &impact, at.corner.angle, orbit, path(machine, cycle)))
    };
    Ok(found.iter().filter_map(shown).collect())
}

/// Orbit through the corner, with the law on either side of it.
fn on_corner(machine: &Machine, at: &CornerImpact) -> Vec<ShownOrbit> {
    let lifts = [at.corner.minus, at.corner.plus];
    let names = [ImpactSide::Before, ImpactSide::After];
    let shown = |((segment, lift), place): ((usize, Lift), ImpactSide)| {
        let mut cycle = at.cycle.clone();
        let impact = &mut cycle.impacts[at.impact];
        impact.segment = segment;
        // A segment that ends at 2 pi has the corner at its end.
        if place == ImpactSide::Before && segment > at.corner.segment {
            impact.cam_angle = machine.cam().segments()[segment].end;
        }
        let orbit = PeriodicOrbit::of_cycle(machine, cycle, at.residual);
        let impact = Event { cam_angle: at.corner.angle, position: lift.value, ..orbit.events[0] };
        ShownOrbit::new(place, &impact, at.corner.angle, &orbit, path(machine, &at.cycle))
    };
    sides(machine, at).into_iter().zip(lifts).zip(names).map(shown).collect()
}

/// One revolution of a cycle with one impact: the flight before the impact from angle 0 on, then the flight after it.
fn path(machine: &Machine, cycle: &Cycle) -> Vec<[f64; 2]> {
    let Some(impact) = cycle.impacts.first() else { return Vec::new() };
    let (leaving, period) = cycle.flight(machine, 0);
    let turned = impact.cam_angle.rem_euclid(TAU);
    let position = |since: f64| leaving.position + machine.flight().fly(leaving, since / TAU * period).0;
    let angles = (0..=SAMPLES).map(|sample| TAU * f64::from(sample) / f64::from(SAMPLES));
    let (before, after): (Vec<f64>, Vec<f64>) = angles.partition(|angle| *angle < turned);
    let before = before.into_iter().map(|angle| [angle, position(angle - turned + TAU)]);
    let after = after.into_iter().filter(|angle| *angle > turned).map(|angle| [angle, position(angle - turned)]);
    let all = before.chain([[turned, leaving.position]]).chain(after);
    all.map(|[angle, position]| [angle.to_degrees(), position]).collect()
}

/// Attractors at each of `speeds`; each run starts from the final state of the previous one. Draws the given number of revolutions.
fn runs<'a>(
    machine: &Machine,
    speeds: impl Iterator<Item = &'a f64>,
    drawn: u64,
) -> Result<Vec<SettledRun>, SimulateError> {
    let mut motion: Option<Motion> = None;
    let mut runs = Vec::new();
    for rpm in speeds {
        let machine = machine.at_speed(angular_velocity(*rpm));
        let mut run = match &motion {
            None => machine.start_on_cam(0.0, 0.0)?,
            Some(motion) => machine.resume(motion)?,
        };
        machine.revolve(&mut run, SETTLING)?;
        let (paths, mut impacts) = (paths(&machine, run, drawn)?, Vec::new());
        machine.watch(&mut run, RECORDED, |event| {
            if event.kind == EventKind::Impact {
                impacts.push(event.cam_angle);
            }
        })?;
        runs.push(SettledRun::new(&impacts, RECORDED, paths));
        motion = Some(run);
    }
    Ok(runs)
}

/// The given number of revolutions of a run that begins at angle 0.
fn paths(machine: &Machine, motion: Motion, drawn: u64) -> Result<Vec<Vec<[f64; 2]>>, SimulateError> {
    let (samples, _) = trace(machine, motion, drawn, SAMPLES)?;
    let begun = motion.revolution as f64 * TAU;
    let mut paths = Vec::new();
    for turn in 0..drawn {
        let (from, to) = (begun + turn as f64 * TAU, begun + (turn + 1) as f64 * TAU);
        let inside = samples.iter().filter(|sample| (from..=to).contains(&sample.turned));
        paths.push(inside.map(|sample| [(sample.turned - from).to_degrees(), sample.state.position]).collect());
    }
    Ok(paths)
}

/// Profile of the cam four times a degree and on both sides of every corner: angle, rad, and lift with its derivatives.
pub(crate) fn profile(cam: &Cam) -> Vec<(f64, Lift)> {
    let mut points = Vec::new();
    for segment in cam.segments() {
        points.push((segment.start, segment.law.lift(segment.start)));
        let degrees = (0..=CAM_SAMPLES).map(|sample| TAU * sample as f64 / CAM_SAMPLES as f64);
        let inside = degrees.filter(|angle| *angle > segment.start && *angle < segment.end);
        points.extend(inside.map(|angle| (angle, segment.law.lift(angle))));
        points.push((segment.end, segment.law.lift(segment.end)));
    }
    points
}
