//! Curves of events in the plane of the speed and a number of the model; corner impacts are drawn by their scenario.

use corner_impact::border_collision::EventCurve;
use corner_impact::border_collision::event_curve::{EventPoint, Happening};
use corner_impact::border_collision::feigin::Scenario;
use corner_impact::orbit::branch::Bifurcation;
use corner_impact_plot::{BREAK, Colour, Figure, FigureAxis, Mark, Marker, Panel, Series, Stroke};

/// Kinds of corner impact with their strokes. Curves are in ink, which no class of motion behind them has at full strength. Corner impacts
/// are thick and other events thin; strokes distinguish kinds.
const KINDS: [(Happening, Stroke); 5] = [
    (Happening::BorderCollision(Scenario::NonsmoothFold), Stroke::Thick),
    (Happening::BorderCollision(Scenario::NonsmoothFlip), Stroke::ThickDashed),
    (Happening::BorderCollision(Scenario::Persistence), Stroke::ThickDotted),
    (Happening::NotPiecewiseLinear, Stroke::ThickDashDotted),
    (Happening::Degenerate, Stroke::Thin),
];

/// Other events, with their names and strokes.
const EVENTS: [(Bifurcation, &str, Stroke); 5] = [
    (Bifurcation::Fold, "fold", Stroke::Solid),
    (Bifurcation::Flip, "flip", Stroke::Dashed),
    (Bifurcation::Graze, "graze", Stroke::Dotted),
    (Bifurcation::Detachment, "detachment", Stroke::DashDotted),
    (Bifurcation::Resting, "onset of resting", Stroke::DashDotDotted),
];

/// Points where a curve changes its type, by the name of the quantity that changes.
const MARKED: [(&str, &str, Marker); 3] = [
    ("type", "a multiplier is 1 or -1", Marker::Ring),
    ("cusp", "cusp", Marker::Diamond),
    ("class", "class of a graze", Marker::Square),
];

/// Draws event curves with the speed up and the parameter across. The parameter has a name, unit, range, and its value in the model, which
/// is marked.
pub fn curve_figure(
    title: &str,
    (name, unit, range, own): (&str, &str, [f64; 2], f64),
    speeds: [f64; 2],
    curves: &[EventCurve],
) -> Figure {
    let panel =
        Panel::new(FigureAxis::new("speed", "rpm").over(speeds), 0.52, lines(curves, |rpm, value| [value, rpm]));
    let is_shown = (range[0]..=range[1]).contains(&own);
    let marks = is_shown.then(|| Mark { at: own, label: format!("this model, {own}") }).into_iter().collect();
    Figure { marks, ..Figure::new(title, FigureAxis::new(name, unit).over(range), vec![panel]) }
}

/// Lines for each kind of event, and their marks; `place` maps a speed, rpm, and a value of the number to a point of the figure.
pub(super) fn lines(curves: &[EventCurve], place: impl Fn(f64, f64) -> [f64; 2]) -> Vec<Series> {
    let place = |point: &EventPoint| place(point.rpm, point.value);
    let mut series = Vec::new();
    for (kind, stroke) in KINDS {
        let pieces = curves.iter().flat_map(EventCurve::pieces).filter(|(_, happening)| *happening == Some(kind));
        series.extend(
            Series::line(&kind.to_string(), Colour::Ink, stroke, joined(pieces.map(|(ends, _)| ends.map(place))))
                .if_any(),
        );
    }
    for (event, name, stroke) in EVENTS {
        let of_event = curves.iter().filter(|curve| curve.kind.bifurcation() == Some(event));
        let pieces = of_event.flat_map(EventCurve::pieces).map(|(ends, _)| ends.map(place));
        series.extend(Series::line(name, Colour::Ink, stroke, joined(pieces)).if_any());
    }
    for (kind, name, marker) in MARKED {
        let all = curves.iter().flat_map(|curve| &curve.points);
        let points = all.filter(|point| point.special.is_some_and(|special| special.kind.name() == kind));
        series.extend(Series::points(name, Colour::Ink, marker, points.map(place)).if_any());
    }
    series
}

/// Joins adjacent pieces into one line, so that dashes continue across them.
fn joined(pieces: impl Iterator<Item = [[f64; 2]; 2]>) -> Vec<[f64; 2]> {
    let mut line: Vec<[f64; 2]> = Vec::new();
    for [from, to] in pieces {
        match line.last() {
            Some(last) if *last == from => line.push(to),
            _ => line.extend([BREAK, from, to]),
        }
    }
    line
}
