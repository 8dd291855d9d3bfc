//! Basins on a section: what each start ends on, the orbits, and the curve that parts the basins.

use crate::draw::{Axis, BREAK, Colour, Data, Density, Figure, Marker, Panel, Series, Stroke};
use crate::figures::{Across, position};
use crate::flight::State;
use crate::orbit::long_run::LongRun;
use crate::show::words;
use crate::study::basins::{Basins, BasinsOver, Border, Grid};

/// Colours of the parts and how much of them, in order, so that each is a grey of its own; further ones share the last.
const COLOURS: [(Colour, f64); 5] =
    [(Colour::Blue, 1.0), (Colour::Vermilion, 0.6), (Colour::Green, 0.4), (Colour::Purple, 0.15), (Colour::Grey, 0.8)];

/// Position across, velocity up, a colour for each ending; where stable orbits and saddles cross the section, and the stable
/// manifolds of these.
pub fn basins_figure(title: &str, grid: &Grid, basins: &Basins, border: &Border) -> Figure {
    let Border { stable, saddles, curves } = border;
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
    Figure::new(&title, position().over(x), vec![Panel::new(Axis::new("velocity q'", "m/s").over(y), 0.66, series)])
}

/// The share of the starts that end on each motion, against what varies: those of one kind and period as one.
pub fn shares_figure(found: &BasinsOver) -> Figure {
    let across = Across::named(&found.over.name, &found.over.unit, found.over.spacing, found.range);
    let mut labels: Vec<(String, f64)> = Vec::new();
    for part in found.at.iter().flat_map(|at| &at.found).flat_map(|found| &found.parts) {
        let label = words::ending(&part.ending);
        match labels.iter_mut().find(|(known, _)| *known == label) {
            Some((_, share)) => *share += part.share.value,
            None => labels.push((label, part.share.value)),
        }
    }
    // Stable: among motions of one share the first found comes first.
    labels.sort_by(|(_, one), (_, other)| other.total_cmp(one));
    let rest = labels.split_off(labels.len().min(COLOURS.len() - 1));
    let is_of = |ending: &LongRun, label: &str| match rest.is_empty() || label != OTHERS {
        true => words::ending(ending) == label,
        false => rest.iter().any(|(known, _)| *known == words::ending(ending)),
    };
    let others = (!rest.is_empty()).then(|| OTHERS.to_owned());
    let names = labels.iter().map(|(label, _)| label.clone()).chain(others);
    let line = |(label, (colour, _)): (String, (Colour, f64))| {
        let points = found.at.iter().filter_map(|at| {
            let parts = &at.found.as_ref().ok()?.parts;
            let share: f64 = parts.iter().filter(|part| is_of(&part.ending, &label)).map(|part| part.share.value).sum();
            Some([across.place(at.place.across()), 100.0 * share])
        });
        let stroke = [Stroke::Solid, Stroke::Dashed, Stroke::Dotted, Stroke::Thick, Stroke::Thin];
        let at = COLOURS.iter().position(|(known, _)| *known == colour).unwrap_or(0);
        Series::line(&label, colour, stroke[at], points)
    };
    let series = names.zip(COLOURS).map(line).collect();
    let title = format!("{}: what starts end on, {}", found.model, found.over.range(found.range));
    let shares = Axis::new("share of starts", "%").over([-5.0, 105.0]);
    Figure::new(&title, across.axis(), vec![Panel::new(shares, 0.5, series)])
}

/// Motions that have no colour of their own.
const OTHERS: &str = "others";
