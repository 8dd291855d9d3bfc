//! Motion at one speed, follower and cam over revolutions: the attractor, and the orbit of the corner impact.

use std::f64::consts::TAU;

use crate::figures::cam::corner_marks;
use crate::figures::design::FORCE;
use crate::figures::{Captioned, Entry, FigureContext, drawn};
use corner_impact::model::Unit;
use corner_impact::section::{self, TraceSample};
use corner_impact::simulate::{Event, EventKind, Machine, Motion, SimulateError};
use corner_impact_plot::{Colour, Data, Figure, FigureAxis, Marker, Panel, Series, Stroke, extent};

/// Trace at a speed at which the paper's follower chatters.
pub(crate) const SLOW_TRACE: Entry = Entry {
    id: "slow-trace",
    place: "Figure 4(a) and (b)",
    takes_rpm: true,
    title: |subject| {
        let what = if subject.is_paper { "chattering" } else { "the motion" };
        subject.slow_title("a slow motion", |slow| format!("{what} at {} rpm", slow.chattering))
    },
    draw: |subject, title| {
        let paper = "The follower leaves the cam at P, comes down, and bounces lower and faster until it stays on the cam: \
                     the chattering that the paper describes.";
        let run = subject.settled(subject.shown.slow.clone()?.chattering, SLOW_TURNS)?;
        let what = if subject.is_paper { paper } else { &in_words(&run) };
        drawn(time_trace(title, &run), format!("Follower and cam above, the gap between them below. {what}"))
    },
};

/// Trace with interrupted chattering: bounces that do not die out.
pub(crate) const INTERRUPTED_TRACE: Entry = Entry {
    id: "interrupted-trace",
    place: "Figure 5(b)",
    takes_rpm: true,
    title: |subject| {
        subject.slow_title("another slow motion", |slow| format!("the motion at {} rpm", slow.interrupted))
    },
    draw: |subject, title| {
        let run = subject.settled(subject.shown.slow.clone()?.interrupted, SLOW_TURNS)?;
        let caption = if subject.is_paper {
            "Follower, cam and gap at the speed of the paper's second trace. The follower comes down onto the base circle and \
             bounces there. The flank begins to rise before the bounces die out, so the chattering ends on the flank, shortly \
             before the follower leaves the cam at P."
        } else {
            &format!("Follower, cam and gap at another speed. {}", in_words(&run))
        };
        drawn(time_trace(title, &run), caption)
    },
};

/// Trace of the corner impact's orbit.
pub(crate) const CORNER_ORBIT: Entry = Entry {
    id: "corner-orbit",
    place: "Figure 5(e)",
    takes_rpm: false,
    title: |subject| {
        let at = subject.found().map(|found| format!(" at {:.6} rpm", found.at.speed_rpm())).unwrap_or_default();
        format!("{}: the orbit with its impact at the corner{at}", subject.model.name)
    },
    draw: corner_orbit,
};

/// Trace beyond a fold, where no orbit of one impact exists.
pub(crate) const BEYOND_TRACE: Entry = Entry {
    id: "beyond-trace",
    place: "Figure 5(f)",
    takes_rpm: false,
    title: |subject| {
        subject.fast_title("the motion beyond the corner impact", |fast| format!("the motion at {} rpm", fast.beyond))
    },
    draw: |subject, title| {
        let run = subject.settled(subject.shown.fast.clone()?.beyond, FAST_TURNS)?;
        let caption = format!(
            "The motion at {} rpm, {} than the corner impact{}, after {TRANSIENT} revolutions from a start at rest on the cam.",
            run.rpm,
            if run.rpm < subject.found()?.at.speed_rpm() { "slower" } else { "faster" },
            if subject.is_fold() { ", where the two orbits that meet there no longer exist" } else { "" }
        );
        drawn(time_trace(title, &run), caption)
    },
};

/// Displayed revolutions of a slow motion, and of a fast one, which repeats only after several.
pub(crate) const SLOW_TURNS: u64 = 2;
const FAST_TURNS: u64 = 12;
/// Revolutions before the displayed ones.
pub(crate) const TRANSIENT: u64 = 300;

/// Part of a motion at one speed.
#[derive(Clone, Debug, PartialEq)]
pub struct TracedRun {
    /// Speed, rpm.
    pub rpm: f64,
    /// Samples, evenly spaced in angle, and twice at every event.
    pub samples: Vec<TraceSample>,
    /// Events.
    pub events: Vec<Event>,
}

impl TracedRun {
    /// Number of samples per revolution in a picture: every tenth of a degree, so that short hops are curves, too.
    pub const DRAWN: u32 = 3600;
    /// Number of samples per revolution in a table.
    pub const WRITTEN: u32 = 360;

    /// Traces `revolutions` of a machine from a motion on, with the given number of samples each.
    pub(crate) fn new(
        machine: &Machine,
        motion: Motion,
        revolutions: u64,
        moments: u32,
    ) -> Result<Self, SimulateError> {
        let (samples, events) = section::trace(machine, motion, revolutions, moments)?;
        Ok(Self { rpm: machine.angular_velocity() / TAU * 60.0, samples, events })
    }

    /// Number of events of a kind.
    pub(crate) fn count(&self, kind: EventKind) -> usize {
        self.events.iter().filter(|event| event.kind == kind).count()
    }
}

impl FigureContext {
    /// Traces `revolutions`, from cam angle 0 on, of the attractor on which a start at rest on the cam settles; or returns the reason for a
    /// failure.
    pub fn settled(&self, rpm: f64, revolutions: u64) -> Result<TracedRun, String> {
        let machine = self.machine(rpm);
        let run = || {
            let mut motion = machine.start_on_cam(0.0, 0.0)?;
            machine.revolve(&mut motion, TRANSIENT)?;
            let mut motion = machine.resume(&motion)?;
            motion.revolution = 0;
            TracedRun::new(&machine, motion, revolutions, TracedRun::DRAWN)
        };
        Ok(TracedRun { rpm, ..run().map_err(|error| format!("at {rpm} rpm: {error}"))? })
    }

    /// Traces one revolution, from the section on, of the orbit with its impact at the corner.
    pub fn corner_orbit(&self) -> Result<TracedRun, String> {
        let at = &self.found()?.at;
        let machine = self.machine(at.speed_rpm());
        let run = || TracedRun::new(&machine, machine.start(at.section_angle(), at.state)?, 1, TracedRun::DRAWN);
        Ok(TracedRun { rpm: at.speed_rpm(), ..run().map_err(|error| error.to_string())? })
    }
}

fn corner_orbit(subject: &FigureContext, title: &str) -> Result<Captioned, String> {
    let corner = subject.found()?.at.corner.angle;
    let marks = corner_marks(&subject.cam);
    let mark = marks.iter().find(|mark| mark.angle_rad == corner);
    let name = mark.map_or_else(|| "the corner".into(), |mark| format!("the corner {}", mark.label()));
    let mut figure = time_trace(title, &subject.corner_orbit()?);
    // The legend states that the impact is at the corner.
    let is_impact = |data: &Data| matches!(data, Data::Points { marker: Marker::Below, .. });
    let legend = figure.panels.iter_mut().flat_map(|panel| &mut panel.series);
    for series in legend.filter(|series| is_impact(&series.data) && !series.label.is_empty()) {
        series.label = format!("impact at {name}");
    }
    drawn(
        figure,
        format!(
            "One revolution of the periodic orbit with an impact at the corner at {:.2}°, from the section on. At this \
             speed alone, the cam's law before the corner and its law after it both hold at the impact.",
            corner.to_degrees()
        ),
    )
}

/// Describes the events of a slow motion in a sentence.
fn in_words(run: &TracedRun) -> String {
    let times = |kind| match run.count(kind) {
        1 => "once".to_owned(),
        count => format!("{count} times"),
    };
    let rests = match run.count(EventKind::Stick) {
        0 => "never comes to rest on it".to_owned(),
        _ => format!("comes to rest on it {}", times(EventKind::Stick)),
    };
    format!("In {SLOW_TURNS} revolutions the follower hits the cam {} and {rests}.", times(EventKind::Impact))
}

/// Adds a panel with the force between follower and cam below the trace; `mass` is in kg.
pub fn with_force(mut figure: Figure, run: &TracedRun, mass: f64, unit: &Unit) -> Figure {
    let first = run.samples.first().map_or(0.0, |sample| sample.turned);
    let points = run.samples.iter().map(|sample| [(sample.turned - first) / TAU, unit.told(mass * sample.pressing)]);
    let line = Series::line("", Colour::Blue, Stroke::Solid, points);
    figure.panels.push(Panel::new(FigureAxis::new(FORCE, unit.name()), 0.2, vec![line]).with_zero());
    figure
}

/// Draws follower and cam over revolutions, with impacts and contact marked, and the gap in a panel below.
pub fn time_trace(title: &str, run: &TracedRun) -> Figure {
    let first = run.samples.first().map_or(0.0, |sample| sample.turned);
    let line = |value: fn(&TraceSample) -> f64| {
        run.samples.iter().map(move |sample| [(sample.turned - first) / TAU, value(sample)])
    };
    let impacts = || run.events.iter().filter(|event| event.kind == EventKind::Impact);
    // Contact and impacts, on the curve of the follower or of the gap.
    let marks = |value: fn(&TraceSample) -> f64, height: fn(&Event) -> f64, [contact, impact]: [&str; 2]| {
        let riding = run.samples.iter().zip(line(value));
        let riding = riding.map(|(sample, at)| if sample.contact { at } else { [f64::NAN; 2] });
        let hits = impacts().map(|event| [event.turned_since(first) / TAU, height(event)]);
        let sticks = run.samples.iter().any(|sample| sample.contact);
        let contact = sticks.then(|| Series::line(contact, Colour::Green, Stroke::Thick, riding));
        let impact = Series::points(impact, Colour::Ink, Marker::Below, hits).if_any();
        contact.into_iter().chain(impact)
    };
    let mut positions = vec![
        Series::area("cam c", Colour::Grey, Stroke::Thin, line(|sample| sample.lift)),
        Series::line("follower q", Colour::Blue, Stroke::Solid, line(|sample| sample.state.position)),
    ];
    positions.extend(marks(|sample| sample.state.position, |event| event.position, ["in contact", "impact"]));
    let mut gap = vec![Series::line("", Colour::Blue, Stroke::Solid, line(|sample| sample.gap))];
    gap.extend(marks(|sample| sample.gap, |_| 0.0, ["", ""]));
    let panels = vec![
        Panel::new(FigureAxis::new("position", "m"), 0.34, positions),
        Panel::new(FigureAxis::new("gap q − c", "m"), 0.2, gap).with_zero(),
    ];
    let ends = extent(line(|_| 0.0).map(|[x, _]| x).filter(|x| x.is_finite()));
    Figure::new(title, FigureAxis::new("revolutions of the cam", "").over(ends), panels)
}
