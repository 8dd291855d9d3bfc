//! Bifurcation diagrams: where impacts fall on the cam, or where the follower is at the section, against speed.

use crate::draw::layout::widened;
use crate::draw::{Axis, Colour, Data, Density, Figure, Marker, Panel, Series, Stroke};
use crate::figures::Crossings;
use crate::figures::plots::cam::CornerMark;
use crate::figures::plots::{panel, plain, zero};
use crate::flight::State;

/// What a sweep over speeds found.
#[derive(Clone, Debug)]
pub struct Diagram<'a> {
    /// The figure's title.
    pub title: &'a str,
    /// Speeds in rpm across; impact phases in degrees, or positions in m, up.
    pub points: Density,
    /// The vertical range to show; that of the points where there is none.
    pub shown: Option<[f64; 2]>,
    /// The cam's corners; only the impact diagram draws them.
    pub corners: &'a [CornerMark],
    /// `[rpm, Lyapunov exponent per revolution]`, for a second panel.
    pub lyapunov: Option<&'a [[f64; 2]]>,
}

/// Below a diagram in which some exponent cannot be drawn.
const FORGETS: &str = "λ = −∞, not drawn, where the follower came to stick to the cam: every deviation is lost there";

/// Impact phases against speed, with the cam's corners as lines.
pub fn impact_diagram(diagram: Diagram<'_>) -> Figure {
    let marks = diagram.corners.iter().map(CornerMark::mark).collect();
    let axis = Axis::degrees("cam angle at impact φ");
    figure(diagram, axis, marks)
}

/// Positions at the section against speed.
pub fn strobe_diagram(diagram: Diagram<'_>) -> Figure {
    let axis = Axis::new("follower position q at the section", "m");
    figure(diagram, axis, Vec::new())
}

/// The range of impact phases, degrees, that points take up, with a little room; no more than the whole cam.
pub fn shown_impacts(points: &Density) -> Option<[f64; 2]> {
    let [low, high] = widened(points.extent()?, 0.02);
    Some([low.max(0.0), high.min(360.0)])
}

/// Positions at the section against speed, with the branches of orbits over what runs settle on, and the corner impact at a
/// speed, rpm, and position, m.
pub fn section_diagram(title: &str, runs: Density, branches: &[Crossings], corner: [f64; 2]) -> Figure {
    let [rpm, all] = runs.ranges();
    let shown = |[speed, _]: &&[f64; 2]| (rpm[0]..=rpm[1]).contains(speed);
    let heights = branches.iter().flat_map(|line| &line.points).chain([&corner]).filter(shown).map(|[_, q]| *q);
    let all = widened(heights.fold(all, |[low, high], q| [low.min(q), high.max(q)]), 0.03);
    let mut series = vec![Series { label: "runs".into(), colour: Colour::Grey, data: Data::Density(runs) }];
    for (stable, label, colour, stroke) in
        [(true, "stable", Colour::Blue, Stroke::Solid), (false, "unstable", Colour::Vermilion, Stroke::Dashed)]
    {
        let lines = branches.iter().filter(|line| line.stable == stable);
        let points: Vec<[f64; 2]> = lines.flat_map(|line| line.points.iter().copied().chain([[f64::NAN; 2]])).collect();
        if !points.is_empty() {
            series.push(Series { label: label.into(), ..plain(points, colour, stroke) });
        }
    }
    let data = Data::Points { points: vec![corner], marker: Marker::Ring };
    series.push(Series { label: "corner impact".into(), colour: Colour::Ink, data });
    Figure {
        title: title.into(),
        x: Axis::new("cam speed ω", "rpm").over(rpm),
        marks: Vec::new(),
        panels: vec![panel(Axis::new("follower position q at the section", "m").over(all), 0.52, series, Vec::new())],
        note: String::new(),
    }
}

/// The states of a long run at the section; and where an orbit that is gone was, if that is among them.
pub fn attractor(title: &str, states: &[State], gone: State) -> Figure {
    let ends = |value: fn(&State) -> f64| {
        let all = states.iter().map(value);
        widened(all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)]), 0.03)
    };
    let (x, y) = (ends(|state| state.position), ends(|state| state.velocity));
    let mut cloud = Density::new(x, y);
    states.iter().for_each(|state| cloud.push(state.position, state.velocity));
    let at = [gone.position, gone.velocity];
    let inside = (x[0]..=x[1]).contains(&at[0]) && (y[0]..=y[1]).contains(&at[1]);
    let mut series =
        vec![Series { label: "states, once a revolution".into(), colour: Colour::Blue, data: Data::Density(cloud) }];
    if inside {
        let data = Data::Points { points: vec![at], marker: Marker::Disc };
        series.push(Series { label: "x* of the corner impact".into(), colour: Colour::Vermilion, data });
    }
    Figure {
        title: title.into(),
        x: Axis::new("follower position q at the section", "m").over(x),
        marks: Vec::new(),
        panels: vec![panel(Axis::new("velocity q'", "m/s").over(y), 0.6, series, Vec::new())],
        note: String::new(),
    }
}

fn figure(diagram: Diagram<'_>, axis: Axis, marks: Vec<crate::draw::Mark>) -> Figure {
    let Diagram { title, points, shown, lyapunov, .. } = diagram;
    let [rpm, all] = points.ranges();
    let forgets = lyapunov.is_some_and(|points| points.iter().any(|[_, exponent]| *exponent == f64::NEG_INFINITY));
    let cloud = Series { label: String::new(), colour: Colour::Blue, data: Data::Density(points) };
    let mut panels = vec![panel(axis.over(shown.unwrap_or(all)), 0.52, vec![cloud], marks)];
    panels.extend(lyapunov.map(exponents));
    Figure {
        title: title.into(),
        x: Axis::new("cam speed ω", "rpm").over(rpm),
        marks: Vec::new(),
        panels,
        note: if forgets { FORGETS.into() } else { String::new() },
    }
}

fn exponents(points: &[[f64; 2]]) -> Panel {
    let data = Data::Line { points: points.to_vec(), stroke: Stroke::Thin };
    let line = Series { label: String::new(), colour: Colour::Vermilion, data };
    panel(Axis::new("Lyapunov exponent λ", "per revolution"), 0.2, vec![line], vec![zero()])
}
