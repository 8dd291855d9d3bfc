//! What stands in each figure of the table, and what is to be seen in it.

use crate::border_collision::feigin::Scenario;
use crate::cam::Cam;
use crate::draw::{Cloud, Data, Density, Figure, Marker};
use crate::figures::plates::Drawn;
use crate::figures::plots::{
    Against, Branches, Diagram, Trace, attractor, branches_figure, cam_figure, composition_figure, corner_marks,
    discontinuity_mapping_figure, impact_diagram, local_map_figure, outline_figure, phase_plane, section_diagram,
    shown_impacts, time_trace,
};
use crate::figures::run;
use crate::figures::{Outline, Run, Subject, TRANSIENT};
use crate::simulate::EventKind;

type Result = std::result::Result<Drawn, String>;

/// Revolutions that a slow motion is shown over, and a fast one, which takes several to come round.
const SLOW_TURNS: u64 = 2;
const FAST_TURNS: u64 = 12;
/// States of the attractor.
const STATES: usize = 20_000;

fn drawn(figure: Figure, caption: impl Into<String>) -> Result {
    Ok(Drawn { figure, caption: caption.into() })
}

pub(crate) fn cam_shape(subject: &Subject, title: &str) -> Result {
    let outline = Outline::new(&subject.cam);
    let how = if outline.added == 0.0 {
        "Its outline is the lift as a distance from the axis O: the follower stands on the point straight above O"
            .to_owned()
    } else {
        format!(
            "The model gives the lift alone; it is drawn around O with {:.4} m added, so this is the path of the follower's foot \
             seen from the cam and not the cut of the metal",
            outline.added
        )
    };
    drawn(
        outline_figure(title, &subject.cam, &outline),
        format!("The cam at angle 0. {how}. {}", corners(&subject.cam, "Dots on the outline")),
    )
}

pub(crate) fn cam(subject: &Subject, title: &str) -> Result {
    drawn(
        cam_figure(&subject.cam, title),
        format!(
            "The lift of the cam and its first two derivatives against the angle that the cam has turned. {}",
            corners(&subject.cam, "Vertical lines")
        ),
    )
}

/// What the marks of corners are, in a sentence.
fn corners(cam: &Cam, marks: &str) -> String {
    let (all, marked) = (cam.corners(), corner_marks(cam).len());
    let orders = all.iter().map(|corner| corner.jump_order);
    let Some((least, most)) = orders.clone().min().zip(orders.max()) else {
        return "It has no corner: no derivative of its lift jumps.".into();
    };
    let which = if marked < all.len() {
        format!("are {marked} of its {} corners", all.len())
    } else {
        format!("are its corners, {marked} in all")
    };
    let ordinal = match least {
        1 => "first".to_owned(),
        2 => "second".to_owned(),
        3 => "third".to_owned(),
        order => format!("{order}th"),
    };
    let what = if least == most {
        format!("the {ordinal} derivative of the lift jumps")
    } else {
        format!("a derivative of the lift jumps, the {ordinal} or a higher one")
    };
    format!("{marks} {which}, where {what}.")
}

fn trace(title: &str, run: &Run) -> Figure {
    let (points, impacts) = run::trace_points(&run.samples, &run.events, run.angular_velocity);
    time_trace(&Trace { title, points: &points, impacts: &impacts, against: Against::Revolutions, gap: true })
}

pub(crate) fn slow_trace(subject: &Subject, title: &str) -> Result {
    let run = subject.settled(subject.shown.slow.clone()?.chattering, SLOW_TURNS)?;
    let caption = if subject.is_paper {
        "Follower and cam above, the gap between them below. The follower leaves the cam at P, comes down, and bounces lower and \
         lower in less and less time until it stays on the cam: the chattering that the paper describes."
            .to_owned()
    } else {
        format!("Follower and cam above, the gap between them below. {} {SAME_MULTIPLE} first trace.", counted(&run))
    };
    drawn(trace(title, &run), caption)
}

/// Of a speed that is not the paper's.
const SAME_MULTIPLE: &str =
    "The speed is the same multiple of the one at which the follower first leaves the cam as in the paper's";

fn count(run: &Run, kind: EventKind) -> usize {
    run.events.iter().filter(|event| event.kind == kind).count()
}

/// What happens in a slow motion, in a sentence.
fn counted(run: &Run) -> String {
    let times = |count: usize| if count == 1 { "once".into() } else { format!("{count} times") };
    let hits = times(count(run, EventKind::Impact));
    match count(run, EventKind::Stick) {
        0 => format!("In {SLOW_TURNS} revolutions the follower hits the cam {hits} and never comes to rest on it."),
        rests => format!(
            "In {SLOW_TURNS} revolutions the follower hits the cam {hits} and comes to rest on it {}.",
            times(rests)
        ),
    }
}

pub(crate) fn slow_phase_plane(subject: &Subject, title: &str) -> Result {
    let run = subject.settled(subject.shown.slow.clone()?.chattering, SLOW_TURNS)?;
    let (points, _) = run::trace_points(&run.samples, &run.events, run.angular_velocity);
    let mut caption =
        format!("The motion at {} rpm as the gap and its velocity. An impact is a jump up at gap 0", run.rpm);
    if count(&run, EventKind::Stick) > 0 {
        caption
            .push_str("; loops that shrink into the origin are bounces that end with the follower at rest on the cam");
    }
    caption.push('.');
    if subject.cam.corners().iter().any(|corner| corner.jump_order <= 2) {
        caption.push_str(" A kink elsewhere is where a corner of the cam passes below the follower.");
    }
    drawn(phase_plane(title, &points), caption)
}

pub(crate) fn slow_impacts(subject: &Subject, title: &str) -> Result {
    let range = subject.shown.slow.clone()?.range;
    let mut points = Density::new(range, [0.0, 360.0]);
    subject.slow_impacts(range)?.iter().for_each(|[rpm, angle]| points.push(*rpm, angle.to_degrees()));
    let corners = corner_marks(&subject.cam);
    let shown = shown_impacts(&points);
    drawn(
        impact_diagram(Diagram { title, points, shown, corners: &corners, lyapunov: None }),
        format!(
            "Where on the cam impacts fall, speed by speed, in {} revolutions after {}. A curve is an impact that repeats, scattered \
             points are of motions that do not; curves crowd where impacts accumulate before the follower comes to rest. {}",
            subject.slow_effort.record,
            subject.slow_effort.transient,
            lines(&subject.cam)
        ),
    )
}

pub(crate) fn interrupted_trace(subject: &Subject, title: &str) -> Result {
    let run = subject.settled(subject.shown.slow.clone()?.interrupted, SLOW_TURNS)?;
    let caption = if subject.is_paper {
        "Follower, cam and gap at the speed of the paper's second trace. The follower comes down onto the base circle and bounces \
         there; before the bounces have died out the flank begins to rise, and the chattering ends on it, shortly before the \
         follower leaves the cam at P."
    } else {
        &format!("Follower, cam and gap at another slow speed. {} {SAME_MULTIPLE} second trace.", counted(&run))
    };
    drawn(trace(title, &run), caption)
}

pub(crate) fn fast_impacts(subject: &Subject, title: &str) -> Result {
    let range = subject.shown.fast.clone()?.range;
    let mut runs = Density::new(range, [0.0, 360.0]);
    subject.fast_runs(range, false)?.iter().for_each(|[rpm, angle]| runs.push(*rpm, angle.to_degrees()));
    let branches = subject.branches()?;
    let corners = corner_marks(&subject.cam);
    let shown = shown_impacts(&runs);
    let parameter = ("rpm", range);
    let mut figure = branches_figure(Branches { title, parameter, branches, settled: Some(runs), corners: &corners });
    if let Some(panel) = figure.panels.first_mut() {
        panel.y.range = shown.or(panel.y.range);
    }
    drawn(
        figure,
        format!(
            "Where impacts fall on the cam: grey is what runs with rising and with falling speed settle on, lines are the orbits of \
             one impact in one revolution and of two in two, stable unbroken and unstable broken.{}",
            at_corner_impact(subject)
        ),
    )
}

/// What the orbits of one impact do at the corner impact, in a sentence; nothing where that is not classified.
fn at_corner_impact(subject: &Subject) -> &'static str {
    let Some(kind) = subject.found().ok().and_then(|found| found.classification.as_ref().ok()) else { return "" };
    match kind.scenario {
        Scenario::NonsmoothFold => " At the corner impact two lines of one impact a revolution meet and end.",
        Scenario::NonsmoothFlip => {
            " At the corner impact the line of one impact a revolution goes on, and one of two in two begins."
        }
        Scenario::Persistence => " At the corner impact the line of one impact a revolution goes on.",
    }
}

/// What horizontal lines are, in a sentence.
fn lines(cam: &Cam) -> &'static str {
    match (cam.corners().len(), corner_marks(cam).len()) {
        (0, _) => "The cam has no corner.",
        (all, marked) if marked < all => "Horizontal lines are the largest of the cam's corners.",
        _ => "Horizontal lines are the cam's corners.",
    }
}

pub(crate) fn fast_section(subject: &Subject, title: &str) -> Result {
    let range = subject.shown.fast.clone()?.range;
    let mut runs = Cloud::new(range);
    subject.fast_runs(range, true)?.iter().for_each(|[rpm, position]| runs.push(*rpm, *position));
    let crossings = subject.crossings(subject.branches()?)?;
    let at = &subject.found()?.at;
    let degrees = at.section_angle().to_degrees();
    drawn(
        section_diagram(title, runs.finish(), &crossings, [at.speed_rpm(), at.state.position]),
        format!(
            "The same runs and orbits, looked at once a revolution: the position of the follower when the cam is at {degrees:.2}°, \
             half a turn from the corner."
        ),
    )
}

pub(crate) fn corner_orbit(subject: &Subject, title: &str) -> Result {
    let run = subject.corner_orbit()?;
    let at = &subject.found()?.at;
    drawn(
        named(trace(title, &run), &corner_name(subject, at.corner.angle)),
        format!(
            "One revolution of the periodic orbit with an impact at the corner at {:.2}°, from the section on. At this \
             one speed the law of the cam before the corner and the law after it both hold at the impact.",
            at.corner.angle.to_degrees()
        ),
    )
}

/// What the corner at an angle, rad, is called.
fn corner_name(subject: &Subject, angle: f64) -> String {
    let marks = corner_marks(&subject.cam);
    let mark = marks.iter().find(|mark| mark.angle_rad == angle);
    mark.map_or_else(|| "the corner".into(), |mark| format!("the corner {}", mark.label()))
}

/// A trace whose legend says where its impact is.
fn named(mut figure: Figure, place: &str) -> Figure {
    let legend = figure.panels.iter_mut().flat_map(|panel| &mut panel.series);
    let is_impact = |data: &Data| matches!(data, Data::Points { marker: Marker::Below, .. });
    for series in legend.filter(|series| is_impact(&series.data) && !series.label.is_empty()) {
        series.label = format!("impact at {place}");
    }
    figure
}

fn is_fold(subject: &Subject) -> bool {
    let kind = subject.found().ok().and_then(|found| found.classification.as_ref().ok());
    kind.is_some_and(|kind| kind.scenario == Scenario::NonsmoothFold)
}

pub(crate) fn beyond_trace(subject: &Subject, title: &str) -> Result {
    let run = subject.settled(subject.shown.fast.clone()?.beyond, FAST_TURNS)?;
    drawn(
        trace(title, &run),
        format!(
            "The motion at {} rpm, {} than the corner impact{}, after {TRANSIENT} revolutions from a start at rest on the cam.",
            run.rpm,
            if run.rpm < subject.found()?.at.speed_rpm() { "slower" } else { "faster" },
            if is_fold(subject) { ", where the two orbits that meet there are gone" } else { "" }
        ),
    )
}

pub(crate) fn beyond_attractor(subject: &Subject, title: &str) -> Result {
    let rpm = subject.shown.fast.clone()?.beyond;
    let states = subject.section_states(rpm, STATES)?;
    let star = subject.found()?.at.state;
    drawn(
        attractor(title, &states, star),
        format!(
            "The states at the section of the map, half a turn from the corner, in {STATES} revolutions of the motion at {rpm} rpm: \
             one that repeats is a few points. The orbit of the corner impact has q = {:.4} m, q' = {:.4} m/s there.",
            star.position, star.velocity
        ),
    )
}

pub(crate) fn composition(subject: &Subject, title: &str) -> Result {
    let shown = subject.composition()?;
    drawn(
        composition_figure(title, &shown),
        "The orbit x* comes to the corner once in a period T*. A neighbour starts at x₁ on Π₁: P₁ flies it to x_d⁻ on Π_D as if there \
         were no impact, below the cam's surface; P_D puts it to x_d⁺, where the flight after the impact has it at that time; P₂ flies \
         it on to x₂ on Π₂. All curves are the model's own flights.",
    )
}

pub(crate) fn discontinuity_mapping(subject: &Subject, title: &str) -> Result {
    let shown = subject.composition()?;
    drawn(
        discontinuity_mapping_figure(title, &shown),
        "P_D near the corner: from x_d⁻ on Π_D along the flight to the impact at time −t_i, through the impact (x⁻ to x⁺: the velocity \
         jumps), and along the flight after it to x_d⁺ on Π_D. In the upper panel the impact is before the corner and the way to it \
         goes back in time, in the lower it is after the corner and the way from it does; dotted lines are the laws of the cam, each \
         continued past the corner.",
    )
}

pub(crate) fn local_map(subject: &Subject, title: &str) -> Result {
    let shown = subject.next_to_corner()?;
    drawn(
        local_map_figure(title, &shown),
        format!(
            "Orbits of the local map of period one{} against the change δT of the machine's period: rays from the corner impact, \
             stable unbroken, unstable broken. Grey are the machine's own orbits.",
            if shown.rays.iter().any(|ray| ray.positions.len() == 2) { " and two" } else { "" }
        ),
    )
}
