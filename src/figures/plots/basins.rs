//! Basins on a section: what each start ends on, the orbits, and the curve that parts the basins.

use crate::draw::{Axis, Colour, Data, Density, Figure, Marker, Series, Stroke};
use crate::figures::plots::panel;
use crate::flight::State;
use crate::show::words;
use crate::study::basins::{Basins, Curve};

/// Colours of the parts and how much of them, in order, so that each is a grey of its own; further ones share the last.
const COLOURS: [(Colour, f64); 5] =
    [(Colour::Blue, 1.0), (Colour::Vermilion, 0.6), (Colour::Green, 0.4), (Colour::Purple, 0.15), (Colour::Grey, 0.8)];

/// A grid of starts and what belongs to it.
#[derive(Clone, Copy, Debug)]
pub struct BasinsPicture<'a> {
    /// The figure's title.
    pub title: &'a str,
    /// The starts.
    pub basins: &'a Basins,
    /// Where stable orbits cross the section.
    pub stable: &'a [State],
    /// Where saddles do.
    pub saddles: &'a [State],
    /// Their stable manifolds.
    pub curves: &'a [Curve],
}

/// Position across, velocity up, a colour for each ending.
pub fn basins_figure(picture: &BasinsPicture<'_>) -> Figure {
    let grid = &picture.basins.grid;
    let (x, y) = (grid.positions, grid.velocities);
    let mut areas = vec![Density::new(x, y); picture.basins.parts.len().min(COLOURS.len())];
    let [columns, rows] = Density::new(x, y).cells();
    let place = |index: usize, count: usize| (index as f64 + 0.5) / count as f64;
    for row in 0..rows {
        for column in 0..columns {
            let (right, up) = (place(column, columns), place(row, rows));
            let cell = ((up * grid.rows as f64) as usize) * grid.columns + (right * grid.columns as f64) as usize;
            let Some(part) = picture.basins.cells[cell] else { continue };
            areas[part.min(COLOURS.len() - 1)].push(x[0] + right * (x[1] - x[0]), y[0] + up * (y[1] - y[0]));
        }
    }
    let mut series: Vec<Series> = Vec::new();
    for ((cells, part), (colour, strength)) in areas.into_iter().zip(&picture.basins.parts).zip(COLOURS) {
        series.push(Series { label: words::ending(&part.ending), colour, data: Data::Region { cells, strength } });
    }
    let at = |state: &State| [state.position, state.velocity];
    let mut line: Vec<[f64; 2]> = Vec::new();
    for piece in picture.curves.iter().flat_map(|curve| &curve.pieces) {
        line.extend(piece.iter().map(at));
        line.push([f64::NAN; 2]);
    }
    let named = |label: &str, data| Series { label: label.into(), colour: Colour::Ink, data };
    if !line.is_empty() {
        series.push(named("stable manifold", Data::Line { points: line, stroke: Stroke::Thin }));
    }
    for (label, states, marker) in
        [("stable orbit", picture.stable, Marker::Dot), ("saddle", picture.saddles, Marker::Ring)]
    {
        if !states.is_empty() {
            series.push(named(label, Data::Points { points: states.iter().map(at).collect(), marker }));
        }
    }
    Figure {
        title: picture.title.into(),
        x: Axis::new("follower position q at the section", "m").over(x),
        marks: Vec::new(),
        panels: vec![panel(Axis::new("velocity q'", "m/s").over(y), 0.66, series, Vec::new())],
        note: String::new(),
    }
}
