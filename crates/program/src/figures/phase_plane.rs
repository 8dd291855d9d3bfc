//! Phase plane: the gap of a motion against its velocity.

use crate::figures::trace::{SLOW_TURNS, TracedRun};
use crate::figures::{Entry, drawn};
use corner_impact::elementary;
use corner_impact::section::TraceSample;
use corner_impact::simulate::{Event, EventKind};
use corner_impact_plot::{BREAK, Colour, Figure, FigureAxis, Mark, Marker, Panel, Series, Stroke, extent};

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
            _ => "; loops that shrink into the origin are bounces before the follower rests on the cam",
        };
        let kinks = match subject.cam.corners().iter().any(|corner| corner.jump_order <= 2) {
            true => " A kink elsewhere is where a corner of the cam passes below the follower.",
            false => "",
        };
        let what = format!("The motion at {} rpm as the gap and its velocity.", run.rpm);
        drawn(
            phase_plane(title, &run),
            format!("{what} An impact is a jump up at gap 0, from the cross to the ring{rests}.{kinks}"),
        )
    },
};

/// Draws the gap against its velocity, with arrows in the direction of time, and marks the beginning and end of each impact.
pub fn phase_plane(title: &str, run: &TracedRun) -> Figure {
    let point = |sample: &TraceSample| [sample.gap, sample.state.velocity - sample.cam_velocity];
    let points: Vec<[f64; 2]> = run.samples.iter().map(point).collect();
    let hits = || run.events.iter().filter(|event| event.kind == EventKind::Impact);
    let ends = |label: &str, marker: Marker, velocity: fn(&Event) -> f64| {
        let places = hits().map(move |event| [0.0, velocity(event) - event.cam_velocity]);
        Series::points(label, Colour::Ink, marker, places).if_any()
    };
    let line = Series::line("", Colour::Blue, Stroke::Thin, points.iter().copied());
    let arrows = Series::arrow("", Colour::Blue, Stroke::Thin, arrows(&points)).if_any();
    let before = ends("before an impact", Marker::Cross, |event| event.velocity_before);
    let after = ends("after it", Marker::Ring, |event| event.velocity_after);
    let series = [line].into_iter().chain(arrows).chain(before).chain(after).collect();
    let panel = Panel::new(FigureAxis::new("gap velocity q' − c'", "m/s"), 0.6, series).with_zero();
    Figure { marks: vec![Mark::zero()], ..Figure::new(title, FigureAxis::new("gap q − c", "m"), vec![panel]) }
}

/// Short pieces of a line, in the direction of motion, evenly spaced along its length in the picture.
fn arrows(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    /// Arrows along the whole line.
    const ARROWS: f64 = 10.0;
    let spans = [0, 1].map(|direction| {
        let [low, high] = extent(points.iter().map(|point| point[direction]));
        high - low
    });
    // An impact changes only the velocity: the line has no direction there.
    let is_jump = |pair: &[[f64; 2]]| pair[0][0] == pair[1][0];
    let length = |pair: &[[f64; 2]]| {
        let parts = [0, 1].map(|direction| (pair[1][direction] - pair[0][direction]) / spans[direction]);
        if parts.iter().all(|part| part.is_finite()) && !is_jump(pair) {
            elementary::hypot(parts[0], parts[1])
        } else {
            0.0
        }
    };
    let whole: f64 = points.windows(2).map(length).sum();
    let (mut passed, mut next, mut arrows) = (0.0, 0.5, Vec::new());
    for pair in points.windows(2) {
        let along = length(pair);
        passed += along;
        if along > 0.0 && passed >= whole * next / ARROWS {
            arrows.extend([BREAK, pair[0], pair[1]]);
            next = (ARROWS * passed / whole).floor() + 1.5;
        }
    }
    arrows
}
