//! What stands in each figure of the table, and what is to be seen in it.

use super::Drawn;
use crate::gallery::{Outline, Run, Subject};
use crate::report::figure::{Beside, Cloud, Colour, Data, Density, Figure, Marker, Series, Word};
use crate::report::figures::{
    Against, Branches, Diagram, Trace, attractor, branches_figure, cam_figure, composition_figure, corner_marks,
    discontinuity_mapping_figure, impact_diagram, local_map_figure, outline_figure, phase_plane, section_diagram,
    shown_impacts, time_trace,
};
use crate::report::run;

type Result = std::result::Result<Drawn, String>;

/// Revolutions that a slow motion is shown over, and a fast one, which takes several to come round.
const SLOW_TURNS: u64 = 2;
const FAST_TURNS: u64 = 12;
/// States of the attractor.
const STATES: usize = 20_000;

fn drawn(figure: Figure, caption: impl Into<String>) -> Result {
    Ok(Drawn { figure, caption: caption.into() })
}

pub(super) fn cam_shape(subject: &Subject, title: &str) -> Result {
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
        format!(
            "The cam at angle 0. {how}. Dots on the outline are its corners, where a derivative of the lift jumps."
        ),
    )
}

pub(super) fn cam(subject: &Subject, title: &str) -> Result {
    drawn(
        cam_figure(&subject.cam, title),
        "The lift of the cam and its two derivatives against the angle that the cam has turned. Vertical lines are the corners, \
         where one of the derivatives jumps.",
    )
}

fn trace(title: &str, run: &Run) -> Figure {
    let (points, impacts) = run::trace_points(&run.samples, &run.events, run.angular_velocity);
    time_trace(&Trace { title, points: &points, impacts: &impacts, against: Against::Revolutions, gap: true })
}

pub(super) fn slow_trace(subject: &Subject, title: &str) -> Result {
    let run = subject.settled(subject.shown.slow.clone()?.chattering, SLOW_TURNS)?;
    drawn(
        trace(title, &run),
        if subject.is_paper {
            "Follower and cam above, the gap between them below. The follower leaves the cam at P, comes down, and bounces lower and \
             lower in less and less time until it stays on the cam: the chattering that the paper describes."
        } else {
            "Follower and cam above, the gap between them below, at a speed that is to the one of detachment as in the paper's trace."
        },
    )
}

pub(super) fn slow_phase_plane(subject: &Subject, title: &str) -> Result {
    let run = subject.settled(subject.shown.slow.clone()?.chattering, SLOW_TURNS)?;
    let (points, _) = run::trace_points(&run.samples, &run.events, run.angular_velocity);
    drawn(
        phase_plane(title, &points),
        "The same motion as gap against the velocity of the gap. Each impact jumps from below to above at gap 0; what shrinks \
         into the origin comes to rest on the cam. A kink away from gap 0 is where the cam passes a corner below the follower.",
    )
}

pub(super) fn slow_impacts(subject: &Subject, title: &str) -> Result {
    let range = subject.shown.slow.clone()?.range;
    let mut points = Density::new(range, [0.0, 360.0]);
    subject.slow_impacts(range)?.iter().for_each(|[rpm, angle]| points.push(*rpm, angle.to_degrees()));
    let corners = corner_marks(&subject.cam);
    let shown = shown_impacts(&points);
    drawn(
        impact_diagram(Diagram { title, points, shown, corners: &corners, lyapunov: None }),
        "Where on the cam the impacts of the settled motion fall, speed by speed; horizontal lines are the corners. Each curve is \
         one impact; they crowd where impacts accumulate before the follower comes to rest, and bend where one crosses a corner.",
    )
}

pub(super) fn interrupted_trace(subject: &Subject, title: &str) -> Result {
    let run = subject.settled(subject.shown.slow.clone()?.interrupted, SLOW_TURNS)?;
    let caption = if subject.is_paper {
        "Follower, cam and gap at the speed of the paper's second trace. The follower comes down onto the base circle and bounces \
         there; before the bounces have died out the flank begins to rise, and the chattering ends on it, shortly before the \
         follower leaves the cam at P."
    } else {
        "Follower, cam and gap at another slow speed, which is to the one of detachment as in the paper's second trace."
    };
    drawn(trace(title, &run), caption)
}

pub(super) fn fast_impacts(subject: &Subject, title: &str) -> Result {
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
        "Where impacts fall on the cam: grey is what runs with rising and with falling speed settle on, lines are the orbits of one \
         impact in one revolution and of two in two, stable unbroken and unstable broken. The stable line ends where it meets the \
         corner.",
    )
}

pub(super) fn fast_section(subject: &Subject, title: &str) -> Result {
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

pub(super) fn corner_orbit(subject: &Subject, title: &str) -> Result {
    let run = subject.corner_orbit()?;
    let at = &subject.found()?.at;
    drawn(
        marked(trace(title, &run), &corner_name(subject, at.corner.angle)),
        format!(
            "One revolution of the orbit that repeats with a single impact exactly at the corner at {:.2}°, from the section on. At \
             this one speed the law before the corner and the law behind it both hold for the impact.",
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

/// A trace with its impacts named.
fn marked(mut figure: Figure, name: &str) -> Figure {
    for panel in &mut figure.panels {
        let hits = panel.series.iter().find_map(|series| match &series.data {
            Data::Points { points, marker: Marker::Below } => Some(points.clone()),
            _ => None,
        });
        let hits = hits.unwrap_or_default();
        let word = |at: &[f64; 2]| Word { at: *at, text: format!("impact at {name}"), beside: Beside::Right };
        let words: Vec<Word> = hits.iter().map(word).collect();
        for data in [Data::Points { points: hits, marker: Marker::Ring }, Data::Words(words)] {
            panel.series.push(Series { label: String::new(), colour: Colour::Ink, data });
        }
    }
    figure
}

pub(super) fn beyond_trace(subject: &Subject, title: &str) -> Result {
    let run = subject.settled(subject.shown.fast.clone()?.beyond, FAST_TURNS)?;
    drawn(
        trace(title, &run),
        "The motion on the side of the corner impact where its orbit is gone, after 300 revolutions from rest on the cam.",
    )
}

pub(super) fn beyond_attractor(subject: &Subject, title: &str) -> Result {
    let states = subject.section_states(subject.shown.fast.clone()?.beyond, STATES)?;
    let star = subject.found()?.at.state;
    drawn(
        attractor(title, &states, star),
        format!(
            "The states of {STATES} revolutions of that motion at the section of the map, half a turn from the corner. x*, the \
             state of the orbit that is gone, was at q = {:.4} m, q' = {:.4} m/s.",
            star.position, star.velocity
        ),
    )
}

pub(super) fn composition(subject: &Subject, title: &str) -> Result {
    let shown = subject.composition()?;
    drawn(
        composition_figure(title, &shown),
        "The orbit x* comes to the corner once in a period T*. A neighbour starts at x₁ on Π₁: P₁ flies it to Π_D as if there were \
         no impact, which ends at x_d⁻ under the cam's surface; P_D puts it to x_d⁺, where the impact that did happen leaves it at that \
         time; P₂ flies on to x₂ on Π₂. All curves are the model's own flow.",
    )
}

pub(super) fn discontinuity_mapping(subject: &Subject, title: &str) -> Result {
    let shown = subject.composition()?;
    drawn(
        discontinuity_mapping_figure(title, &shown),
        "P_D near the corner: from x_d⁻ on Π_D back along the flight to the impact at time −t_i, through the impact (x⁻ to x⁺, the \
         velocity jumps), and along the flight after it to x_d⁺. Above the impact is before the corner, below it is after it; the \
         dotted lines are the two laws of the cam, each continued past the corner.",
    )
}

pub(super) fn local_map(subject: &Subject, title: &str) -> Result {
    let shown = subject.next_to_corner()?;
    drawn(
        local_map_figure(title, &shown),
        "Fixed points of the local map, and its other short orbits, against the change δT of the period: rays from the corner impact, \
         stable unbroken, unstable broken. Grey is where the machine's own orbits are.",
    )
}
