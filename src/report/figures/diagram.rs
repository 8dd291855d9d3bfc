//! Bifurcation diagrams: where impacts fall on the cam, or where the follower is at the section, against speed.

use super::cam::CornerMark;
use super::{panel, zero};
use crate::report::figure::{Axis, Colour, Data, Density, Figure, Panel, Series, Stroke};

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

fn figure(diagram: Diagram<'_>, axis: Axis, marks: Vec<crate::report::figure::Mark>) -> Figure {
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
