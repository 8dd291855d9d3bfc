//! The pieces of work that are timed, each done by the baseline and by the project's own simulator.

#![allow(clippy::disallowed_methods, reason = "what is timed beside the project uses the standard library")]

use std::f64::consts::{PI, TAU};
use std::hint::black_box;
use std::ops::ControlFlow;

use corner_impact::cam::Cam;
use corner_impact::flight::State;
use corner_impact::model::{Model, OSORIO_2008};
use corner_impact::orbit::Parameter;
use corner_impact::simulate::{Machine, angular_velocity};
use corner_impact::study::survey::{
    Axis, Beginning, Counted, Placed, Section, Start, Survey, Sweep, SweepError, SweepStart, Values,
};

use crate::baseline::{Baseline, Place};

/// Calls of `sin_cos` in one [`chain`], each of which needs the one before.
pub const CHAIN: u32 = 1000;

/// A chain of dependent `sin_cos`: its time over [`CHAIN`] is the latency of one, with one addition.
pub fn chain(mut x: f64) -> f64 {
    for _ in 0..CHAIN {
        let (sin, cos) = x.sin_cos();
        x = sin + cos;
    }
    x
}

/// Speeds to run from one start, each for a transient and then a record, as a diagram does.
pub struct Work {
    /// What it stands for.
    pub name: &'static str,
    model: Model,
    machine: Machine,
    /// Cam speeds, rpm, each with the place where its run starts.
    runs: Vec<(f64, Place)>,
    /// Revolutions at each speed.
    each: u32,
}

impl Work {
    /// The pieces of work, in the order of the table.
    pub fn all() -> Vec<Self> {
        let diagram: Vec<f64> = (0..200).map(|k| 660.0 + 90.0 * f64::from(k) / 199.0).collect();
        vec![
            Self::settled("700 rpm, one impact a revolution", &[700.0], 1000, 100),
            Self::settled("670 rpm, chaos", &[670.0], 1000, 100),
            Self::settled("183 rpm, chattering and sticking", &[183.0], 100, 20),
            Self::settled("diagram 660 to 750 rpm, 200 speeds of 300 + 100 revolutions", &diagram, 0, 400),
        ]
    }

    /// Runs of `each` revolutions that start after `transient` revolutions from the paper's x*, at the half turn from P.
    fn settled(name: &'static str, speeds: &[f64], transient: u32, each: u32) -> Self {
        let Ok(model) = Model::parse("osorio-2008.toml", OSORIO_2008) else { unreachable!("the built-in model") };
        let state = State { position: 0.3 + 5.09700788184262174, velocity: 0.0 };
        let start = Place { cam_angle: 2.62112450116623235 + PI, state };
        let settle = |rpm: f64| {
            let settled = machine(&model, rpm).run(start, TAU * f64::from(transient), |_| ());
            (rpm, settled)
        };
        let runs = speeds.iter().map(|rpm| settle(*rpm)).collect();
        let Ok(cam) = Cam::new(&model) else { unreachable!("the built-in cam") };
        let machine = Machine::new(cam, &model.follower, 1.0);
        Self { name, model, machine, runs, each }
    }

    /// Revolutions in one piece of work.
    pub fn revolutions(&self) -> u64 {
        self.runs.len() as u64 * u64::from(self.each)
    }

    /// Does it by scan and bisect; the number of events.
    pub fn by_baseline(&self) -> usize {
        let mut events = 0;
        for (rpm, start) in &self.runs {
            let machine = machine(&self.model, *rpm);
            black_box(machine.run(*start, TAU * f64::from(self.each), |_| events += 1));
        }
        events
    }

    /// Does it by the project's own simulator; the number of events.
    pub fn by_simulator(&self) -> usize {
        let mut events = 0;
        for (rpm, start) in &self.runs {
            let machine = self.machine.at_speed(angular_velocity(*rpm));
            // The baseline may leave its follower a rounding below the cam.
            let lift = machine.cam().lift(start.cam_angle).value;
            let state = State { position: start.state.position.max(lift), ..start.state };
            let end = machine.turn(start.cam_angle, state, TAU * f64::from(self.each), |_| {
                events += 1;
                ControlFlow::Continue(())
            });
            let Ok(end) = end else { unreachable!("the start is on or above the cam") };
            black_box(end);
        }
        events
    }
}

/// The diagram's sweep at ten times as many speeds, for threads to share.
pub fn sweep() -> Sweep {
    let Ok(model) = Model::parse("osorio-2008.toml", OSORIO_2008) else { unreachable!("the built-in model") };
    let speeds = Axis::new(Parameter::Speed, &Values::linear(660.0, 750.0, 2000));
    let Ok(over) = Survey::new(&model, None, speeds, None) else { unreachable!("the built-in cam") };
    let state = State { position: 0.3 + 5.09700788184262174, velocity: 0.0 };
    Sweep {
        over,
        starts: Beginning::One(Start { cam_angle: 2.62112450116623235 + PI, follower: Placed::At(state) }),
        following: SweepStart::Nothing,
        transient: 300,
        record: 100,
        section: Section::Impacts,
        growth: None,
    }
}

/// Runs a sweep on so many threads; its rows.
pub fn count(sweep: &Sweep, threads: usize) -> u64 {
    let found = sweep.run(Some(threads), |_, _: Counted| Ok::<(), SweepError>(()));
    let Ok(tally) = found else { unreachable!("the start is above the cam") };
    tally.points
}

fn machine(model: &Model, rpm: f64) -> Baseline {
    let Ok(machine) = Baseline::new(model, rpm) else { unreachable!("the paper's follower is undamped") };
    machine
}
