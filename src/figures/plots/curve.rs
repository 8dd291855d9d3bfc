//! Curves of corner impacts in the plane of the speed and a number of the model, by what happens at them.

use crate::border_collision::ImpactCurve;
use crate::draw::{Axis, Colour, Data, Figure, Mark, Marker, Series, Stroke};
use crate::figures::plots::panel;
use crate::orbit::branch::Kind;

/// Kinds of corner impact, with the way in which they are drawn.
const KINDS: [(&str, Colour, Stroke); 5] = [
    ("nonsmooth-fold", Colour::Vermilion, Stroke::Solid),
    ("nonsmooth-flip", Colour::Purple, Stroke::Dashed),
    ("persistence", Colour::Blue, Stroke::Thin),
    ("not-piecewise-linear", Colour::Green, Stroke::Dashed),
    ("degenerate", Colour::Grey, Stroke::Thin),
];

/// Speed up, the parameter across; its name, its range, and its value in the model, which is marked.
pub fn curve_figure(
    title: &str,
    (name, range, own): (&str, [f64; 2], f64),
    speeds: [f64; 2],
    curves: &[ImpactCurve],
) -> Figure {
    let mut series = Vec::new();
    for (label, colour, stroke) in KINDS {
        let mut points = Vec::new();
        for ([from, to], happening) in curves.iter().flat_map(ImpactCurve::pieces) {
            if happening.to_string() == label {
                points.extend([[from.value, from.rpm], [to.value, to.rpm], [f64::NAN; 2]]);
            }
        }
        if !points.is_empty() {
            series.push(Series { label: label.into(), colour, data: Data::Line { points: joined(points), stroke } });
        }
    }
    let all = curves.iter().flat_map(|curve| &curve.impacts);
    let of_type = |kind: &Kind| matches!(kind, Kind::Type { .. });
    let changes: Vec<[f64; 2]> = all
        .filter(|point| point.special.is_some_and(|special| of_type(&special.kind)))
        .map(|point| [point.value, point.rpm])
        .collect();
    if !changes.is_empty() {
        let data = Data::Points { points: changes, marker: Marker::Ring };
        series.push(Series { label: "a multiplier is 1 or -1".into(), colour: Colour::Ink, data });
    }
    Figure {
        title: title.into(),
        x: Axis::new(name, "").over(range),
        marks: vec![Mark { at: own, label: format!("the model, {own}") }],
        panels: vec![panel(Axis::new("speed of the corner impact", "rpm").over(speeds), 0.52, series, Vec::new())],
        note: String::new(),
    }
}

/// Pieces that meet, as one line: dashes run on.
fn joined(pieces: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let mut line: Vec<[f64; 2]> = Vec::new();
    for piece in pieces.chunks_exact(3) {
        match line.last() {
            Some(last) if *last == piece[0] => line.push(piece[1]),
            _ => line.extend([[f64::NAN; 2], piece[0], piece[1]]),
        }
    }
    line
}
