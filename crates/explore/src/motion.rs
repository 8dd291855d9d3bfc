//! One run: its moments, its events, and its long-run motion.

use corner_impact::model::Model;
use corner_impact::orbit::long_run::Kind;
use corner_impact::section::{TraceSample, trace};
use corner_impact::simulate::Event;
use corner_impact::study::simulate::Simulation;
use corner_impact::study::survey::Judged;
use serde::Serialize;

use crate::PageRefusal;
use crate::question::MotionRequest;

/// Moments and events of a run, as columns: the columns of `simulate --out` and of `simulate --events`.
#[derive(Serialize)]
pub struct MotionFound {
    rpm: f64,
    time_s: Vec<f64>,
    turned_rad: Vec<f64>,
    cam_angle_rad: Vec<f64>,
    position_m: Vec<f64>,
    velocity_m_s: Vec<f64>,
    cam_lift_m: Vec<f64>,
    cam_velocity_m_s: Vec<f64>,
    gap_m: Vec<f64>,
    contact_force_n: Vec<f64>,
    events: EventColumns,
}

/// Events of a run, as columns.
#[derive(Default, Serialize)]
struct EventColumns {
    revolution: Vec<u64>,
    time_s: Vec<f64>,
    cam_angle_rad: Vec<f64>,
    event: Vec<&'static str>,
    position_m: Vec<f64>,
    velocity_before_m_s: Vec<f64>,
    velocity_after_m_s: Vec<f64>,
    cam_velocity_m_s: Vec<f64>,
}

/// Largest number of revolutions, of moments and of their product that the page may request.
const MOST_REVOLUTIONS: u64 = 1_000_000;
const MOST_MOMENTS: u64 = 200_000;

impl MotionFound {
    /// Simulates the transient and then records.
    pub(crate) fn of(model: &Model, asked: &MotionRequest) -> Result<Self, PageRefusal> {
        let moments = asked.revolutions.saturating_mul(u64::from(asked.samples));
        if asked.revolutions.max(asked.transient) > MOST_REVOLUTIONS || moments > MOST_MOMENTS {
            let words = format!(
                "motion: transient = {}, revolutions = {}, samples = {}: transient and revolutions must each be at most \
                 {MOST_REVOLUTIONS}, and revolutions times samples at most {MOST_MOMENTS}",
                asked.transient, asked.revolutions, asked.samples
            );
            return Err(PageRefusal::of_words(words));
        }
        let Simulation { machine, first, .. } = Simulation::new(model, asked.rpm, asked.start.start()?)?;
        let (omega, mut motion) = (machine.angular_velocity(), first);
        machine.revolve(&mut motion, asked.transient)?;
        let (samples, events) = if asked.samples > 0 {
            trace(&machine, motion, asked.revolutions, asked.samples)?
        } else {
            let mut events = Vec::new();
            machine.watch(&mut motion, asked.revolutions, |event| events.push(*event))?;
            (Vec::new(), events)
        };
        let time = |turned: f64| (turned - first.cam_angle) / omega;
        let of = |value: fn(&TraceSample) -> f64| samples.iter().map(value).collect::<Vec<f64>>();
        let pressing = of(|sample| sample.pressing).into_iter().map(|pressing| model.follower.mass * pressing);
        Ok(Self {
            rpm: asked.rpm,
            time_s: samples.iter().map(|sample| time(sample.turned)).collect(),
            turned_rad: of(|sample| sample.turned),
            cam_angle_rad: of(|sample| sample.cam_angle),
            position_m: of(|sample| sample.state.position),
            velocity_m_s: of(|sample| sample.state.velocity),
            cam_lift_m: of(|sample| sample.lift),
            cam_velocity_m_s: of(|sample| sample.cam_velocity),
            gap_m: of(|sample| sample.gap),
            contact_force_n: pressing.collect(),
            events: EventColumns::of(&events, |event| event.turned_since(first.cam_angle) / omega),
        })
    }
}

impl EventColumns {
    fn of(events: &[Event], time: impl Fn(&Event) -> f64) -> Self {
        let of = |value: fn(&Event) -> f64| events.iter().map(value).collect::<Vec<f64>>();
        Self {
            revolution: events.iter().map(|event| event.revolution).collect(),
            time_s: events.iter().map(time).collect(),
            cam_angle_rad: of(|event| event.cam_angle),
            event: events.iter().map(|event| event.kind.name()).collect(),
            position_m: of(|event| event.position),
            velocity_before_m_s: of(|event| event.velocity_before),
            velocity_after_m_s: of(|event| event.velocity_after),
            cam_velocity_m_s: of(|event| event.cam_velocity),
        }
    }
}

/// Motion on which a run settles, with the names of `simulate --lyapunov --json`.
#[derive(Serialize)]
pub struct LongRunFound {
    kind: Kind,
    #[serde(skip_serializing_if = "Option::is_none")]
    revolutions: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    impacts: Option<u64>,
    lyapunov_per_revolution: f64,
    lyapunov_standard_error: Option<f64>,
    followed: u64,
}

impl LongRunFound {
    /// Builds the document from the judged motion.
    pub(crate) fn of(judged: Judged) -> Self {
        let Judged { ending, followed, .. } = judged;
        let (growth, period) = (ending.growth(), ending.period());
        Self {
            kind: ending.kind(),
            revolutions: period.map(|(revolutions, _)| revolutions),
            impacts: period.map(|(_, impacts)| impacts),
            lyapunov_per_revolution: growth.value,
            lyapunov_standard_error: ending.of_growth().map(|_| growth.error).filter(|error| error.is_finite()),
            followed,
        }
    }
}
