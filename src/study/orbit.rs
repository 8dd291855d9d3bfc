//! The periodic orbits at one speed.

use serde::Serialize;

use super::{StudyError, hypotheses, machine};
use crate::cam::{Cam, apart};
use crate::elementary;
use crate::flight::State;
use crate::known::{Complete, Evidence};
use crate::measured::Measured;
use crate::model::{FollowerErrors, Model};
use crate::orbit::near::near;
use crate::orbit::{PeriodicOrbit, Search, Searched, Undecided, search_all};
use crate::progress::Watch;
use crate::simulate::{Event, Machine};
use crate::uncertainty::{PlausibleMachines, SourcedUncertainty};

/// The periodic orbits of a model at a speed: the document of `orbit --json`.
#[derive(Clone, Debug, Serialize)]
pub struct Orbits {
    schema: &'static str,
    /// The model's name.
    pub model: String,
    /// Speed, rpm.
    pub speed_rpm: f64,
    /// Cam angle at which their states are given, rad.
    pub section_angle_rad: f64,
    /// Numbers of impacts for which the list is complete.
    pub complete: Vec<Complete>,
    /// Hypotheses on the machine for proofs of orbits or of completeness; empty if nothing is proved.
    pub hypotheses: Vec<&'static str>,
    /// Places where orbits of these numbers of impacts may be missing.
    pub undecided: Vec<Undecided>,
    /// The orbits found.
    pub orbits: Vec<PeriodicOrbit>,
    /// Accuracy of a measured cam, if its rows have noise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured: Option<Measured>,
    /// Standard deviations of the follower's numbers.
    #[serde(rename = "uncertain", skip_serializing_if = "FollowerErrors::are_none")]
    pub deviations: FollowerErrors,
    /// Uncertainty of each orbit; none if too few of the likely machines have the orbit.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub errors: Vec<Option<OrbitUncertainty>>,
}

/// Uncertainty of an orbit's numbers.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct OrbitUncertainty {
    /// Whole uncertainty.
    #[serde(flatten)]
    pub total: OrbitErrors,
    /// Part of a measured cam.
    pub cam: OrbitErrors,
    /// Part of the follower's numbers.
    pub numbers: OrbitErrors,
}

/// Uncertainties of an orbit's numbers, or one part of them.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct OrbitErrors {
    /// Uncertainty of either multiplier, in the complex plane.
    pub multiplier: f64,
    /// Position and velocity of the state, m and m/s.
    pub state: [f64; 2],
    /// Largest uncertainty of the cam angle of an impact, or of the start or end of sticking, rad.
    pub cam_angle_rad: f64,
    /// Largest uncertainty of the velocity before or after one of these, m/s.
    pub velocity_m_s: f64,
}

/// The orbits to be looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OrbitQuery {
    /// All orbits that a search finds.
    All(Search),
    /// The orbit of so many revolutions that Newton's method finds from a state at cam angle 0.
    Near(State, u64),
}

/// Looks for the periodic orbits of a model at `speed_rpm`.
pub fn orbits(model: &Model, speed_rpm: f64, wanted: OrbitQuery, watch: &dyn Watch) -> Result<Orbits, StudyError> {
    let machine = machine(model, speed_rpm)?;
    let Searched { orbits, complete, undecided } = match wanted {
        OrbitQuery::All(wanted) => search_all(&machine, &wanted, watch)?,
        OrbitQuery::Near(state, revolutions) => {
            let orbits = near(&machine, 0.0, state, revolutions)?.into_iter().collect();
            Searched { orbits, complete: Vec::new(), undecided: Vec::new() }
        }
    };
    let machines = if orbits.is_empty() { None } else { Some(PlausibleMachines::of(model, machine.cam())?) };
    let errors = match machines.as_ref().and_then(PlausibleMachines::uncertain) {
        Some(machines) => orbits.iter().map(|orbit| error(machines, &machine, orbit)).collect(),
        None => Vec::new(),
    };
    let measured = machines.and_then(PlausibleMachines::measured).filter(|cam| cam.is_noisy);
    let mut known = orbits.iter().map(|orbit| orbit.known).chain(complete.iter().map(|complete| complete.known));
    let hypotheses = if known.any(|known| known == Evidence::Proved) { hypotheses(machine.cam()) } else { Vec::new() };
    let (schema, deviations, model) = ("corner-impact/orbit/1", model.errors, model.name.clone());
    Ok(Orbits {
        schema,
        model,
        speed_rpm,
        section_angle_rad: 0.0,
        complete,
        hypotheses,
        undecided,
        orbits,
        measured,
        deviations,
        errors,
    })
}

/// Uncertainty of an orbit of `machine`, from the same orbit of the likely machines.
fn error(machines: &PlausibleMachines<'_>, machine: &Machine, orbit: &PeriodicOrbit) -> Option<OrbitUncertainty> {
    /// Number of values for the multipliers and the state.
    const OF_ORBIT: usize = 6;
    /// Number of values for each event: an angle and the velocities before and after.
    const OF_EVENT: usize = 3;
    /// Number of impacts that are compared. The last impacts before a rest are lost in rounding.
    const IMPACTS: usize = 64;
    let compared =
        |orbit: &PeriodicOrbit| -> Vec<Event> { orbit.impacts().take(IMPACTS).chain(orbit.rests()).copied().collect() };
    let events = compared(orbit);
    let numbers = |found: &PeriodicOrbit| -> Option<Vec<f64>> {
        let [one, two] = found.multipliers();
        let of_orbit = [one.re, one.im, two.re, two.im, found.state.position, found.state.velocity];
        let there = compared(found);
        let is_alike = there.iter().map(|event| event.kind).eq(events.iter().map(|event| event.kind));
        // Angles are measured from the event's angle in the orbit: on another cam it may be on the other side of angle 0.
        let of_event = |(there, here): (&Event, &Event)| {
            [apart(there.cam_angle, here.cam_angle), there.velocity_before, there.velocity_after]
        };
        is_alike.then(|| of_orbit.into_iter().chain(there.iter().zip(&events).flat_map(of_event)).collect())
    };
    let there = |model: &Model, cam: &Cam| {
        let there = Machine::new(cam.clone(), &model.follower, machine.angular_velocity());
        // A state that touches one cam may be inside another.
        let state = State { position: orbit.state.position.max(cam.lift(0.0).value), ..orbit.state };
        let found = near(&there, 0.0, state, orbit.revolutions).ok()??;
        numbers(&found).filter(|_| found.revolutions == orbit.revolutions)
    };
    let errors = machines.errors(&numbers(orbit)?, there)?;
    let part = |of: fn(&SourcedUncertainty) -> f64| {
        let errors: Vec<f64> = errors.iter().map(of).collect();
        let (of_orbit, of_events) = errors.split_at(OF_ORBIT);
        let most = |of: &[usize]| {
            let of_one = |one: &[f64]| of.iter().map(|index| one[*index]).fold(0.0, f64::max);
            of_events.chunks(OF_EVENT).map(of_one).fold(0.0, f64::max)
        };
        OrbitErrors {
            multiplier: elementary::hypot(of_orbit[0], of_orbit[1]).max(elementary::hypot(of_orbit[2], of_orbit[3])),
            state: [of_orbit[4], of_orbit[5]],
            cam_angle_rad: most(&[0]),
            velocity_m_s: most(&[1, 2]),
        }
    };
    Some(OrbitUncertainty {
        total: part(SourcedUncertainty::total),
        cam: part(|error| error.cam),
        numbers: part(|error| error.numbers),
    })
}
