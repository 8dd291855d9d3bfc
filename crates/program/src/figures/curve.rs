//! Curves of events in the plane of the speed and a number of the model; corner impacts are drawn by their scenario.

use corner_impact::border_collision::EventCurve;
use corner_impact::border_collision::event_curve::{EventPoint, Happening};
use corner_impact::border_collision::feigin::Scenario;
use corner_impact::orbit::branch::Bifurcation;
use corner_impact_plot::{BREAK, Colour, Figure, FigureAxis, Mark, Marker, Panel, Series, Stroke};

/// Kinds of corner impact, with their names, colours and strokes.
const KINDS: [(Happening, Colour, Stroke); 5] = [
    (Happening::BorderCollision(Scenario::NonsmoothFold), Colour::Vermilion, Stroke::Thick),
    (Happening::BorderCollision(Scenario::NonsmoothFlip), Colour::Purple, Stroke::Dashed),
    (Happening::BorderCollision(Scenario::Persistence), Colour::Blue, Stroke::Thin),
    (Happening::NotPiecewiseLinear, Colour::Green, Stroke::Dashed),
    (Happening::Degenerate, Colour::Grey, Stroke::Thin),
];

/// Other events, with their names, colours and strokes.
const EVENTS: [(Bifurcation, &str, Colour, Stroke); 5] = [
    (Bifurcation::Fold, "fold", Colour::Ink, Stroke::Solid),
    (Bifurcation::Flip, "flip", Colour::Ink, Stroke::Dashed),
    (Bifurcation::Graze, "graze", Colour::Green, Stroke::Dotted),
    (Bifurcation::Detachment, "detachment", Colour::Grey, Stroke::Dashed),
    (Bifurcation::Resting, "onset of resting", Colour::Blue, Stroke::Dotted),
];

/// Points where a curve changes its type, by the name of the quantity that changes.
const MARKED: [(&str, &str, Marker); 3] = [
    ("type", "a multiplier is 1 or -1", Marker::Ring),
    ("cusp", "cusp", Marker::Diamond),
    ("class", "class of a graze", Marker::Square),
];

/// Event curves with the speed up and the parameter across. The parameter comes with name, unit, range, and its value in the model, which
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
    let marks = is_shown.then(|| Mark { at: own, label: format!("the model, {own}") }).into_iter().collect();
    Figure { marks, ..Figure::new(title, FigureAxis::new(name, unit).over(range), vec![panel]) }
}

/// A line for each kind of event, and their marks; `place` maps a speed, rpm, and a value of the number to a point of the figure.
pub(super) fn lines(curves: &[EventCurve], place: impl Fn(f64, f64) -> [f64; 2]) -> Vec<Series> {
    let place = |point: &EventPoint| place(point.rpm, point.value);
    let mut series = Vec::new();
    for (kind, colour, stroke) in KINDS {
        let pieces = curves.iter().flat_map(EventCurve::pieces).filter(|(_, happening)| *happening == Some(kind));
        series.extend(
            Series::line(&kind.to_string(), colour, stroke, joined(pieces.map(|(ends, _)| ends.map(place)))).if_any(),
        );
    }
    for (event, name, colour, stroke) in EVENTS {
        let of_event = curves.iter().filter(|curve| curve.kind.bifurcation() == Some(event));
        let pieces = of_event.flat_map(EventCurve::pieces).map(|(ends, _)| ends.map(place));
        series.extend(Series::line(name, colour, stroke, joined(pieces)).if_any());
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
