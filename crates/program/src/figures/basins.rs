//! Basins on a section: the end of each start, the orbits, and the boundary curve of the basins.

use crate::figures::{Across, position};
use crate::show::words;
use corner_impact::flight::State;
use corner_impact::study::basins::{BasinBoundary, Basins, BasinsOver, Grid, SharesOf};
use corner_impact_plot::{BREAK, Colour, Data, Density, Figure, FigureAxis, Marker, Panel, Series, Stroke};

/// Colour and strength of each part, in order, chosen so that their greys differ; further parts share the last.
const COLOURS: [(Colour, f64); 5] =
    [(Colour::Blue, 1.0), (Colour::Vermilion, 0.6), (Colour::Green, 0.4), (Colour::Purple, 0.15), (Colour::Grey, 0.8)];

/// Draws basins with position across, velocity up, and a colour for each end. The figure also marks the crossings of stable orbits and
/// saddles with the section, and draws the saddles' stable manifolds.
pub fn basins_figure(title: &str, grid: &Grid, basins: &Basins, border: &BasinBoundary) -> Figure {
    let BasinBoundary { stable, saddles, curves } = border;
    let (x, y) = (grid.positions, grid.velocities);
    let mut areas = vec![Density::new(x, y); basins.parts.len().min(COLOURS.len())];
    let [columns, rows] = Density::new(x, y).cells();
    let place = |index: usize, count: usize| (index as f64 + 0.5) / count as f64;
    for row in 0..rows {
        for column in 0..columns {
            let (right, up) = (place(column, columns), place(row, rows));
            let cell = ((up * grid.cells[1] as f64) as usize) * grid.cells[0] + (right * grid.cells[0] as f64) as usize;
            let Some(part) = basins.cells[cell] else { continue };
            areas[part.min(COLOURS.len() - 1)].push(x[0] + right * (x[1] - x[0]), y[0] + up * (y[1] - y[0]));
        }
    }
    let mut series: Vec<Series> = Vec::new();
    for ((cells, part), (colour, strength)) in areas.into_iter().zip(&basins.parts).zip(COLOURS) {
        series.push(Series::new(&words::ending(&part.ending), colour, Data::Region { cells, strength }));
    }
    let at = |state: &State| [state.position, state.velocity];
    let pieces = curves.iter().flat_map(|curve| &curve.pieces);
    let line = pieces.flat_map(|piece| piece.iter().map(at).chain([BREAK]));
    series.extend(Series::line("stable manifold", Colour::Ink, Stroke::Thin, line).if_any());
    series.extend(Series::points("stable orbit", Colour::Ink, Marker::Dot, stable.iter().map(at)).if_any());
    series.extend(Series::points("saddle", Colour::Ink, Marker::Ring, saddles.iter().map(at)).if_any());
    let title = format!("{title}{}", words::followed_for(basins.followed.iter().copied().flatten()));
    Figure::new(
        &title,
        position().over(x),
        vec![Panel::new(FigureAxis::new("velocity q'", "m/s").over(y), 0.66, series)],
    )
}

/// Draws the share of the starts that end on each kind of motion against the varied number, for the kinds with the most starts.
pub fn shares_figure(found: &BasinsOver) -> Figure {
    const STROKES: [Stroke; 5] = [Stroke::Solid, Stroke::Dashed, Stroke::Dotted, Stroke::Thick, Stroke::Thin];
    let across = Across::named(&found.over.name, &found.over.unit, found.over.spacing, found.range);
    let all = found.shares();
    let label = |it: &SharesOf| match it.motion {
        (kind, Some((revolutions, impacts))) => words::motion(kind, Some(revolutions), Some(impacts)),
        (kind, None) => words::motion(kind, None, None),
    };
    let styled = all.iter().zip(COLOURS.into_iter().zip(STROKES));
    let series = styled.map(|(it, ((colour, _), stroke))| {
        let points = it.shares.iter().map(|[value, share]| [across.place(*value), 100.0 * share]);
        Series::line(&label(it), colour, stroke, points)
    });
    let title = format!("{}: motions that starts settle on, {}", found.model, found.over.range(found.range));
    let shares = FigureAxis::new("share of starts", "%").over([-5.0, 105.0]);
    let panel = Panel::new(shares, 0.5, series.collect());
    let note = match all.len().saturating_sub(COLOURS.len()) {
        0 => String::new(),
        more => format!("{more} more kinds of motion have smaller shares and are not drawn"),
    };
    Figure { note, ..Figure::new(&title, across.axis(), vec![panel]) }
}
