//! Phase plane: the gap of a motion against its velocity.

use crate::figures::trace::{SLOW_TURNS, TracedRun};
use crate::figures::{Entry, drawn};
use corner_impact::section::TraceSample;
use corner_impact::simulate::EventKind;
use corner_impact_plot::{Colour, Figure, FigureAxis, Mark, Panel, Series, Stroke};

/// The report's figure of the phase plane.
pub(crate) const SLOW_PHASE_PLANE: Entry = Entry {
    id: "slow-phase-plane",
    place: "Figure 4(c)",
    takes_rpm: true,
    title: |subject| {
        subject.slow_title("gap and its velocity", |slow| format!("gap and its velocity at {} rpm", slow.chattering))
    },
    draw: |subject, title| {
        let run = subject.settled(subject.shown.slow.clone()?.chattering, SLOW_TURNS)?;
        let rests = match run.count(EventKind::Stick) {
            0 => "",
            _ => "; loops that shrink into the origin are bounces that end with the follower at rest on the cam",
        };
        let kinks = match subject.cam.corners().iter().any(|corner| corner.jump_order <= 2) {
            true => " A kink elsewhere is where a corner of the cam passes below the follower.",
            false => "",
        };
        let what = format!("The motion at {} rpm as the gap and its velocity.", run.rpm);
        drawn(phase_plane(title, &run), format!("{what} An impact is a jump up at gap 0{rests}.{kinks}"))
    },
};

/// Draws the gap against its velocity.
pub fn phase_plane(title: &str, run: &TracedRun) -> Figure {
    let point = |sample: &TraceSample| [sample.gap, sample.state.velocity - sample.cam_velocity];
    let line = Series::line("", Colour::Blue, Stroke::Thin, run.samples.iter().map(point));
    let panel = Panel::new(FigureAxis::new("gap velocity q' − c'", "m/s"), 0.6, vec![line]).with_zero();
    Figure { marks: vec![Mark::zero()], ..Figure::new(title, FigureAxis::new("gap q − c", "m"), vec![panel]) }
}
