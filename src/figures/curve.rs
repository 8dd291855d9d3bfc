//! Curves of corner impacts in the plane of the speed and a number of the model, by what happens at them.

use crate::border_collision::feigin::Scenario;
use crate::border_collision::impact_curve::{Happening, ImpactCurve};
use crate::draw::{Axis, BREAK, Colour, Figure, Mark, Marker, Panel, Series, Stroke};
use crate::orbit::branch::Kind;

/// Kinds of corner impact, with the way in which they are drawn.
const KINDS: [(Happening, Colour, Stroke); 5] = [
    (Happening::BorderCollision(Scenario::NonsmoothFold), Colour::Vermilion, Stroke::Solid),
    (Happening::BorderCollision(Scenario::NonsmoothFlip), Colour::Purple, Stroke::Dashed),
    (Happening::BorderCollision(Scenario::Persistence), Colour::Blue, Stroke::Thin),
    (Happening::NotPiecewiseLinear, Colour::Green, Stroke::Dashed),
    (Happening::Degenerate, Colour::Grey, Stroke::Thin),
];

/// Speed up, the parameter across; its name, its range, and its value in the model, which is marked.
pub fn curve_figure(
    title: &str,
    (name, range, own): (&str, [f64; 2], f64),
    speeds: [f64; 2],
    curves: &[ImpactCurve],
) -> Figure {
    let mut series = Vec::new();
    for (kind, colour, stroke) in KINDS {
        let pieces = curves.iter().flat_map(ImpactCurve::pieces).filter(|(_, happening)| *happening == kind);
        let pieces = pieces.map(|([from, to], _)| [[from.value, from.rpm], [to.value, to.rpm]]);
        series.extend(Series::line(&kind.to_string(), colour, stroke, joined(pieces)).if_any());
    }
    let all = curves.iter().flat_map(|curve| &curve.impacts);
    let changes = all.filter(|point| point.special.is_some_and(|special| matches!(special.kind, Kind::Type { .. })));
    let changes = changes.map(|point| [point.value, point.rpm]);
    series.extend(Series::points("a multiplier is 1 or -1", Colour::Ink, Marker::Ring, changes).if_any());
    let panel = Panel::new(Axis::new("speed of the corner impact", "rpm").over(speeds), 0.52, series);
    let marks = vec![Mark { at: own, label: format!("the model, {own}") }];
    Figure { marks, ..Figure::new(title, Axis::new(name, "").over(range), vec![panel]) }
}

/// Pieces that meet, as one line: dashes run on.
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
