//! Studies that need more than one call of the library: basins, figures, explanations.

use std::time::Instant;

use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::orbit::branch::Bifurcation;
use corner_impact::orbit::long_run::Budget;
use corner_impact::progress::Unwatched;
use corner_impact::study::basins::{BasinSection, BasinsOver, Begun, Grid, SectionStarts, States, Summary};
use corner_impact::study::survey::{Axis, Over};
use corner_impact::study::verify::{External, verify};
use corner_impact_cli::explain::{Findings, Links};
use corner_impact_cli::figures::{FigureContext, FigureList, OneFigure, plate};
use corner_impact_plot::{Look, svg};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;

use crate::error::OrRaise;
use crate::model::warn;
use crate::values::{answer, refused};
use crate::work::{shared, spread};

/// Starts on a section: cells of a grid, or states.
pub(crate) fn begun(
    cells: Option<[usize; 2]>,
    ranges: [Option<[f64; 2]>; 2],
    states: Option<Vec<[f64; 2]>>,
) -> PyResult<Begun> {
    match (cells, states) {
        (Some(cells), None) => match cells[0].checked_mul(cells[1]) {
            Some(1..=Grid::MOST) => Ok(Begun::Grid(cells, ranges)),
            _ => refused(format!("grid = {cells:?} must have 1 to {} cells", Grid::MOST)),
        },
        (None, Some(states)) if ranges == [None; 2] => {
            let state = |[position, velocity]: [f64; 2]| State { position, velocity };
            Ok(Begun::Given(states.into_iter().map(state).collect()))
        }
        _ => refused("the starts are a grid, with ranges if need be, or states".into()),
    }
}

/// Basins at one speed, and for each cell of a grid the motion on which its start settles.
pub(crate) fn basins<'py>(
    py: Python<'py>,
    model: &Model,
    rpm: f64,
    (cam_angle, begun): (f64, Begun),
    budget: Budget,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyAny>> {
    let clock = Instant::now();
    let section = spread(py, || BasinSection::new(model, rpm, cam_angle))?.or_raise()?;
    let starts = match begun {
        Begun::Grid(cells, [position, velocity]) => {
            SectionStarts::Grid(section.grid(cells, position, velocity).or_raise()?)
        }
        Begun::Given(states) => SectionStarts::Given(States { cam_angle, states }),
    };
    let grid = if let SectionStarts::Grid(grid) = starts { Some(grid) } else { None };
    let found = shared(py, || starts.basins(&section.map.machine, budget, threads, &Unwatched))?.or_raise()?;
    let cells: Vec<i32> = found.cells.iter().map(|part| part.map_or(-1, |part| part as i32)).collect();
    let summary = Summary::new(model, rpm, found, clock.elapsed().as_secs_f64());
    let result = answer(py, "Basins", &summary, &model.units)?;
    if let Some(grid) = grid {
        let [columns, rows] = grid.cells;
        let positions: Vec<f64> = (0..columns).map(|column| grid.start(column).position).collect();
        let velocities: Vec<f64> = (0..rows).map(|row| grid.start(row * columns).velocity).collect();
        result.setattr("ending", PyArray1::from_vec(py, cells).reshape([rows, columns])?)?;
        result.setattr("positions", PyArray1::from_vec(py, positions))?;
        result.setattr("velocities", PyArray1::from_vec(py, velocities))?;
    }
    Ok(result)
}

/// Shares of the basins at each value of an axis.
pub(crate) fn basin_shares<'py>(
    py: Python<'py>,
    model: &Model,
    (rpm, axis): (Option<f64>, Axis),
    (cam_angle, begun): &(f64, Begun),
    budget: Budget,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyAny>> {
    let over = Over::new(model, axis.parameter.clone(), rpm).or_raise()?;
    let found = shared(py, || BasinsOver::new(&over, &axis, (*cam_angle, begun), budget, threads, &Unwatched))?;
    answer(py, "BasinShares", &found, &model.units)
}

/// Bifurcations by their names; all of them if no name is given.
pub(crate) fn bifurcations(names: &[String]) -> PyResult<Vec<Bifurcation>> {
    if names.is_empty() {
        return Ok(Bifurcation::ALL.to_vec());
    }
    let named = |name: &String| {
        let found = Bifurcation::ALL.into_iter().find(|event| event.to_string() == *name);
        let all = || Bifurcation::ALL.map(|event| event.to_string()).join(", ");
        found.map_or_else(|| refused(format!("events = {name:?} must be of: {}", all())), Ok)
    };
    names.iter().map(named).collect()
}

/// Figure of the report with its picture, or the list of all figures.
pub(crate) fn figure<'py>(
    py: Python<'py>,
    model: &Model,
    id: Option<&str>,
    rpm: Option<[f64; 2]>,
) -> PyResult<Bound<'py, PyAny>> {
    let subject = spread(py, || FigureContext::new(model, rpm))?.or_raise()?;
    let list = FigureList::new(&subject);
    let Some(id) = id else { return answer(py, "Figures", &list, &model.units) };
    let Some(found) = spread(py, || plate(&subject, id))? else {
        let ids: Vec<_> = list.figures.iter().map(|listed| listed.id).collect();
        return refused(format!("no figure called {id:?}; there are: {}", ids.join(", ")));
    };
    let drawn = found.drawn.as_ref().or_else(|why| refused(format!("no figure {id}: {why}")))?;
    let picture = svg::render(&drawn.figure, &Look::default()).or_raise()?;
    let result = answer(py, "Figure", &OneFigure::new(&subject, found), &model.units)?;
    result.setattr("svg", picture)?;
    Ok(result)
}

/// Meaning of a name, with its values for a model.
pub(crate) fn explain<'py>(
    py: Python<'py>,
    model: &Model,
    what: &str,
    external: External,
) -> PyResult<Bound<'py, PyAny>> {
    let links = Links::read().or_raise()?;
    let needed = links.needs(what, model).or_raise()?;
    let needed = needed.map(|routes| if routes == External::Run { external } else { routes });
    let verified = needed.map(|routes| spread(py, || verify(model, routes))).transpose()?.transpose();
    let found = match verified {
        Ok(found) => found,
        Err(error) => {
            warn(py, format!("no values: {error}"))?;
            None
        }
    };
    let findings = Findings::new(model, found.as_ref()).or_raise()?;
    answer(py, "Explanation", &links.explain(what, &findings).or_raise()?, &model.units)
}
