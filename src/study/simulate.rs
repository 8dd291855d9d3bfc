//! Simulation of one motion: its events and states in order, and a summary.

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::time::Duration;

use serde::Serialize;

use super::{StudyError, machine};
use crate::known::Evidence;
use crate::model::Model;
use crate::orbit::long_run::{Budget, Kind, LongRun};
use crate::progress::{Clock, Watch};
use crate::simulate::{Event, EventKind, Goal, Machine, Motion, Unobserved};
use crate::study::design::loads::Loads;
use crate::study::survey::{Judged, Start, long_run};

/// A machine at a speed, and the initial state of a motion.
#[derive(Clone, Debug)]
pub struct Simulation {
    model: String,
    rpm: f64,
    /// The machine.
    pub machine: Machine,
    /// The initial motion.
    pub first: Motion,
}

/// Length of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Until {
    /// Turns of the cam.
    Revolutions(u64),
    /// Impacts.
    Impacts(u64),
}

/// Settings of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunRequest {
    /// End of the run.
    pub until: Until,
    /// Whether to show its events.
    pub events: bool,
    /// Cam angle, rad, in `[0, 2 pi)`, at which to show the states.
    pub strobe: Option<f64>,
    /// Number of the last revolutions to be drawn.
    pub drawn: u64,
    /// Budget for finding the long-run motion and the growth of a small deviation, if requested.
    pub long_run: Option<Budget>,
}

/// Events or a state that a run shows on its way.
#[derive(Clone, Copy, Debug)]
pub enum Sight<'a> {
    /// Some events, in order.
    Events(&'a [Event]),
    /// The motion at the requested cam angle.
    State(&'a Motion),
}

/// Summary of a run: the document of `simulate --json`.
#[derive(Clone, Debug, Serialize)]
pub struct Run {
    schema: &'static str,
    /// The model's name.
    pub model: String,
    /// Speed, rpm.
    pub rpm: f64,
    /// Turns of the cam.
    pub revolutions: f64,
    /// Impacts.
    pub impacts: u64,
    /// Number of times that the follower began to stick to the cam.
    pub sticks: u64,
    /// Number of times that the cam released the follower.
    pub releases: u64,
    /// State at the end.
    #[serde(rename = "final")]
    pub end: RunEnd,
    /// Long-run motion, if requested.
    #[serde(skip_serializing_if = "Option::is_none", flatten)]
    pub long_run: Option<Lyapunov>,
    /// Seconds that the simulation took, without reading, writing and drawing.
    pub wall_s: f64,
    /// Loads over the last revolutions.
    #[serde(skip_serializing_if = "Option::is_none", flatten)]
    pub loads: Option<RunLoads>,
    /// Motion at the start of the revolutions that are drawn.
    #[serde(skip)]
    pub before_drawn: Motion,
    /// Motion at the end.
    #[serde(skip)]
    pub last: Motion,
    /// Motion before the last revolutions, whose loads are computed.
    #[serde(skip)]
    before_last: Motion,
}

/// Loads over the last revolutions of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RunLoads {
    /// Relative speed of follower and cam at the hardest impact, m/s; 0 without impacts.
    pub hardest_impact_m_s: f64,
    /// Largest gap, m.
    pub largest_gap_m: f64,
    /// Share of the time that the follower is off the cam.
    pub off_cam_share: f64,
    /// Number of these revolutions.
    pub loads_over_revolutions: u64,
}

impl RunLoads {
    /// Most revolutions that are recorded.
    const MOST: u64 = 100;

    /// Loads of the last whole revolutions of a run; none if it is shorter than one.
    pub fn of(model: &Model, machine: &Machine, run: &Run) -> Result<Option<Self>, StudyError> {
        let loads_over_revolutions = Self::MOST.min(run.revolutions as u64);
        if loads_over_revolutions == 0 {
            return Ok(None);
        }
        let mut motion = run.before_last;
        let start = Goal { revolution: run.last.revolution - loads_over_revolutions, cam_angle: run.last.cam_angle };
        let _ = machine.advance(&mut motion, start, &mut Unobserved)?;
        let recorded = Loads::recorded(model, machine, motion, loads_over_revolutions)?;
        let most = |of: fn(&Loads) -> f64| recorded.iter().map(of).fold(0.0, f64::max);
        let off_cam: f64 = recorded.iter().map(|loads| loads.off_cam).sum();
        Ok(Some(Self {
            hardest_impact_m_s: most(|loads| loads.impact_speed),
            largest_gap_m: most(|loads| loads.gap),
            off_cam_share: off_cam / loads_over_revolutions as f64,
            loads_over_revolutions,
        }))
    }
}

/// Long-run motion of a run, and the growth of a small deviation in it.
#[derive(Clone, Debug, Serialize)]
pub struct Lyapunov {
    /// Growth of a small deviation per revolution, as a natural logarithm. Minus infinity (null in JSON) if the follower comes to rest on
    /// the cam.
    pub lyapunov_per_revolution: f64,
    /// Standard error of the growth; none if the growth follows from multipliers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lyapunov_standard_error: Option<f64>,
    /// The kind of motion.
    pub kind: Kind,
    /// The motion.
    #[serde(skip)]
    pub ending: LongRun,
    /// Revolutions that the run was followed for until it was judged.
    pub followed: u64,
    /// Budget of the run.
    pub budget: Budget,
    /// Evidence for these results.
    pub known: Evidence,
}

impl Lyapunov {
    fn of(judged: Judged, budget: Budget) -> Self {
        let Judged { ending, followed, .. } = judged;
        let (growth, kind) = (ending.growth(), ending.kind());
        let lyapunov_standard_error = ending.of_growth().map(|_| growth.error).filter(|error| error.is_finite());
        let (lyapunov_per_revolution, known) = (growth.value, Evidence::Sampled);
        Self { lyapunov_per_revolution, lyapunov_standard_error, kind, ending, followed, budget, known }
    }
}

/// The end of a run.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct RunEnd {
    /// Cam angle, rad, in [0, 2 pi).
    pub cam_angle_rad: f64,
    /// Position, m, in the cam's coordinates.
    pub position_m: f64,
    /// Velocity, m/s.
    pub velocity_m_s: f64,
    /// Whether the follower sticks to the cam.
    pub contact: bool,
}

/// Number of events kept before they are shown.
const KEPT: usize = 4096;
/// Revolutions, and events, between two reports of the progress.
const STRIDE: u64 = 4096;
const LOOKED: u32 = 1024;
/// Parts of a revolution in which progress is reported.
const PARTS: f64 = 1000.0;
/// Revolutions without an impact after which the run gives up.
const PATIENCE: u64 = 100_000;

impl Simulation {
    /// Builds a simulation of a machine at a speed, rpm, from an initial motion.
    pub fn of(model: &str, rpm: f64, machine: Machine, first: Motion) -> Self {
        Self { model: model.into(), rpm, machine, first }
    }

    /// Builds a simulation of a model at a speed, rpm, from a start.
    pub fn new(model: &Model, rpm: f64, start: Start) -> Result<Self, StudyError> {
        let machine = machine(model, rpm)?;
        let first = start.motion(&machine)?;
        Ok(Self::of(&model.name, rpm, machine, first))
    }

    /// Runs the simulation. `see` is shown the requested events and states as they occur.
    pub fn run<E: From<StudyError>>(
        &self,
        wanted: RunRequest,
        watch: &dyn Watch,
        mut see: impl FnMut(Sight<'_>) -> Result<(), E>,
    ) -> Result<Run, E> {
        let Self { machine, first, .. } = self;
        let (revolutions, most, total) = match wanted.until {
            Until::Revolutions(count) => (count, u64::MAX, count),
            Until::Impacts(count) => (u64::MAX, count, count),
        };
        let [end, drawn, last] =
            [0, wanted.drawn, RunLoads::MOST].map(|before| first.after(revolutions.saturating_sub(before)));
        let (mut motion, mut before_drawn, mut wall, mut last_impact) = (*first, *first, Duration::ZERO, 0);
        let mut marks = [*first; 2];
        let ([mut impacts, mut sticks, mut releases], mut kept) = ([0; 3], Vec::new());
        let told = |impacts: u64, revolution: u64, cam_angle: f64| {
            let turned = revolution as f64 + (cam_angle - first.cam_angle) / TAU;
            let done = if revolutions == u64::MAX { impacts as f64 } else { turned };
            watch.at("", (done * PARTS) as u64, (total as f64 * PARTS) as u64);
        };
        while impacts < most {
            // With marks this far apart, the first one is before the last revolutions wherever a number of impacts ends the run.
            if motion.revolution >= marks[1].revolution + RunLoads::MOST {
                marks = [marks[1], motion];
            }
            let mut goal = earlier(end, motion.after(STRIDE));
            goal = wanted.strobe.map_or(goal, |angle| earlier(goal, motion.next(angle)));
            for stop in [drawn, last] {
                if (motion.revolution, motion.cam_angle) < (stop.revolution, stop.cam_angle) {
                    goal = earlier(goal, stop);
                }
            }
            let (before, clock) = (impacts, Clock::start());
            let mut events = 0_u32;
            let flow = machine.advance(&mut motion, goal, &mut |event: &Event| {
                match event.kind {
                    EventKind::Impact => impacts += 1,
                    EventKind::Stick => sticks += 1,
                    EventKind::Release => releases += 1,
                }
                if wanted.events {
                    kept.push(*event);
                }
                events = events.wrapping_add(1);
                // Thousands of impacts in one revolution take as long as thousands of revolutions.
                if events.is_multiple_of(LOOKED) {
                    told(impacts, event.revolution, event.cam_angle);
                }
                if kept.len() >= KEPT || impacts >= most { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            wall += clock.elapsed();
            see(Sight::Events(&kept))?;
            kept.clear();
            let flow = flow.map_err(StudyError::from)?;
            if impacts > before {
                last_impact = motion.revolution;
            } else if revolutions == u64::MAX && motion.revolution - last_impact > PATIENCE {
                let (cam_angle, revolution) = (motion.cam_angle, motion.revolution);
                Err(StudyError::NoImpact { waited: PATIENCE, impacts, cam_angle, revolution })?;
            }
            if flow.is_break() {
                continue;
            }
            if goal == drawn {
                before_drawn = motion;
            }
            if goal == last {
                marks = [motion; 2];
            }
            if wanted.strobe == Some(goal.cam_angle) {
                see(Sight::State(&motion))?;
            }
            told(impacts, motion.revolution, motion.cam_angle);
            if goal == end {
                break;
            }
        }
        let follow = |budget: Budget| -> Result<Lyapunov, StudyError> {
            watch.at("motion in the long run", 0, 0);
            Ok(Lyapunov::of(long_run(machine, *first, budget)?, budget))
        };
        let long_run = wanted.long_run.map(follow).transpose()?;
        Ok(Run {
            schema: "corner-impact/simulate/1",
            model: self.model.clone(),
            rpm: self.rpm,
            revolutions: (motion.revolution as f64) + (motion.cam_angle - first.cam_angle) / TAU,
            impacts,
            sticks,
            releases,
            end: RunEnd {
                cam_angle_rad: motion.cam_angle,
                position_m: motion.state.position,
                velocity_m_s: motion.state.velocity,
                contact: motion.contact,
            },
            long_run,
            loads: None,
            wall_s: wall.as_secs_f64(),
            before_drawn,
            last: motion,
            before_last: marks[0],
        })
    }
}

fn earlier(one: Goal, other: Goal) -> Goal {
    if one <= other { one } else { other }
}
