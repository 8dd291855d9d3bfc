//! Figures for design: the contact force over a turn of the cam, forces and loads against the speed, or one number against another.

use crate::figures::Across;
use crate::figures::impacts::WHOLE_CAM;
use crate::show::digits::with_error;
use crate::show::sources::Sources;
use corner_impact::model::Units;
use corner_impact::study::design::contact::Separation;
use corner_impact::study::design::loads::{Load, Loads};
use corner_impact::study::design::{Design, RequiredPair, Trade};
use corner_impact::study::survey::Place;
use corner_impact_plot::{Beside, Colour, Figure, FigureAxis, Label, Mark, Marker, Panel, Series, Stroke, extent};

/// Draws trades, if any, else the force over a turn at one speed, else forces and loads against the speed.
pub fn design_figure(found: &Design) -> Figure {
    if !found.trades.is_empty() {
        return trades(found);
    }
    if !found.round.is_empty() { round(found) } else { speeds(found) }
}

/// Name of the axis of the contact force: its part along the follower's motion.
pub(super) const FORCE: &str = "contact force along the motion";

fn force_axis(found: &Design, name: &str) -> FigureAxis {
    FigureAxis::new(name, found.units.force.name())
}

fn round(found: &Design) -> Figure {
    let points = found.round.iter().map(|[angle, force]| [angle.to_degrees(), found.force(*force)]);
    let line = Series::line("", Colour::Blue, Stroke::Solid, points);
    let panel = Panel::new(force_axis(found, FORCE), 0.5, vec![line]).with_zero();
    let rpm = found.forces.first().map_or(f64::NAN, |at| at.place.rpm);
    let title = format!("{} at {rpm} rpm: contact force round the cam", found.model.name);
    let figure = Figure::new(&title, FigureAxis::degrees("cam angle").over(WHOLE_CAM), vec![panel]);
    // A negative force would be a pull, which a cam cannot exert.
    let pulls = found.round.iter().any(|[_, force]| *force < 0.0);
    Figure {
        note: if pulls { "below 0 the cam would have to pull: they separate".into() } else { String::new() },
        ..figure
    }
}

/// Quantity over the varied number: its position, its value, and its uncertainty range.
type Known = (f64, f64, Option<[f64; 2]>);

fn speeds(found: &Design) -> Figure {
    type Quantity = (&'static str, &'static str, f64, Option<Load>);
    let curves = found.load_curves();
    let all = curves.forces.iter().map(|at| at.place).chain(curves.loads.iter().map(|loads| loads.place));
    let range = extent(all.map(|place| place.across()));
    let across = Across::named(&found.over.name, &found.over.unit, found.over.spacing, range);
    let x = |place: Place| across.place(place.across());
    let known = |(place, value, bounds): (Place, f64, Option<[f64; 2]>)| {
        (x(place), found.force(value), bounds.map(|bounds| bounds.map(|end| found.force(end))))
    };
    let mut panels = Vec::new();
    let least: Vec<Known> = curves.forces.iter().map(|at| known((at.place, at.least.value, at.bounds()))).collect();
    let greatest: Vec<Known> = curves.greatest_forces().into_iter().map(known).collect();
    let open = open(found);
    let first = band(&open, &least);
    let second = band(if first.is_some() { "" } else { &open }, &greatest);
    let mut series: Vec<Series> = first.into_iter().chain(second).collect();
    series.extend(Series::line("greatest", Colour::Vermilion, Stroke::Dashed, plain(&greatest)).if_any());
    series.extend(Series::line("least", Colour::Blue, Stroke::Solid, plain(&least)).if_any());
    if !series.is_empty() {
        series.extend(limit(found, &across, range, Load::Force));
        panels.push(Panel::new(force_axis(found, FORCE), 0.24, series).with_zero());
    }
    let quantities: [Quantity; 4] = [
        ("impact speed", "m/s", 1.0, Some(Load::ImpactSpeed)),
        ("largest gap", "m", 1.0, Some(Load::Gap)),
        ("time off the cam", "%", 100.0, None),
        ("energy lost", "J/rev", 1.0, Some(Load::Energy)),
    ];
    if !curves.loads.is_empty() {
        // The panels are in the order of `Loads::numbers`.
        panels.extend(quantities.into_iter().enumerate().map(|(index, (name, unit, scale, load))| {
            let value = |loads: &Loads| {
                let bounds = loads.bounds(index).map(|bounds| bounds.map(|end| scale * end));
                (x(loads.place), scale * loads.numbers()[index], bounds)
            };
            let values: Vec<Known> = curves.loads.iter().map(value).collect();
            let line = Series::line("", Colour::Vermilion, Stroke::Solid, plain(&values));
            let limits = load.map(|load| limit(found, &across, range, load)).unwrap_or_default();
            let series = band("", &values).into_iter().chain([line]).chain(limits).collect();
            Panel::new(FigureAxis::new(name, unit), 0.15, series).with_zero()
        }));
    }
    let at = found.separation.speed();
    let label = || match found.separation {
        Separation::At { rpm, error, .. } if found.separation_errors.is_some() => {
            let (digits, error) = with_error(error);
            format!("separation, {} ± {} rpm", digits.text(rpm), digits.text(error))
        }
        _ => format!("separation, {at:.1} rpm"),
    };
    let marks = (found.over.is_speed() && range[0] <= at && at <= range[1]).then(|| Mark { at, label: label() });
    let at = found.over.rpm.map_or(String::new(), |rpm| format!(" at {rpm} rpm"));
    let title = format!("{}: contact force and loads{at}", found.model.name);
    Figure { marks: marks.into_iter().collect(), ..Figure::new(&title, across.axis(), panels) }
}

/// Limits of a load: a line across the frame with its value, and a ring where the load first exceeds it.
fn limit(found: &Design, across: &Across, range: [f64; 2], load: Load) -> Vec<Series> {
    let ends = range.map(|end| across.place(end));
    let of_load = found.limits.iter().filter(|passed| passed.limit == load);
    let series = of_load.flat_map(|passed| {
        let line = Series::line("", Colour::Ink, Stroke::Dashed, ends.map(|end| [end, passed.value]));
        let text = format!("limit {} {}", passed.value, passed.unit);
        let words = Series::words([Label::new([ends[0], passed.value], &text, Beside::AboveRight)]);
        let at = passed.at.map(|at| [across.place(at.across()), passed.value]);
        let ring = Series::points("", Colour::Ink, Marker::Ring, at).if_any();
        [line, words].into_iter().chain(ring)
    });
    series.collect()
}

fn plain(values: &[Known]) -> impl Iterator<Item = [f64; 2]> {
    values.iter().map(|(x, y, _)| [*x, *y])
}

/// Band of the machine's uncertainty around values; `None` without uncertainty.
fn band(label: &str, values: &[Known]) -> Option<Series> {
    let is_open = values.iter().any(|(.., bounds)| bounds.is_some_and(|[low, high]| low < high));
    let edges = values.iter().map(|(x, _, bounds)| {
        let [low, high] = bounds.unwrap_or([f64::NAN; 2]);
        [*x, low, high]
    });
    is_open.then(|| Series::band(label, Colour::Grey, edges))
}

/// Draws one load in each revolution of a sweep against the varied number.
pub fn loads_diagram(title: &str, across: &Across, sweep: &[Vec<Loads>], load: Load, units: &Units) -> Figure {
    let told = |value: f64| if load == Load::Force { units.force.told(value) } else { value };
    let points = sweep.iter().flatten().map(|loads| [across.place(loads.place.across()), told(loads.of(load))]);
    let (name, unit) = match load {
        Load::ImpactSpeed => ("fastest impact of a revolution", "m/s"),
        Load::Gap => ("largest gap of a revolution", "m"),
        Load::Energy => ("energy lost in a revolution", "J"),
        Load::Force => ("largest contact force along the motion, of a revolution", units.force.name()),
    };
    let series = Series::points("", Colour::Blue, Marker::Dot, points);
    Figure::new(title, across.axis(), vec![Panel::new(FigureAxis::new(name, unit), 0.5, vec![series])])
}

fn trades(found: &Design) -> Figure {
    // A trade that no value satisfies, or that every value satisfies, has no line.
    let does = |pair: &RequiredPair| pair.found.is_some_and(|value| value > 0.0) || pair.other.is_some();
    let has_line = |trade: &&Trade| trade.pairs.windows(2).any(|pairs| pairs.iter().all(does));
    let mut shown: Vec<&Trade> = found.trades.iter().filter(has_line).collect();
    if shown.is_empty() {
        shown = found.trades.iter().collect();
    }
    let panels = shown.into_iter().map(|trade| {
        let line = |name: &str, stroke: Stroke, end: fn(&RequiredPair) -> Option<f64>| {
            let points = trade.pairs.iter().map(|pair| [pair.given, end(pair).unwrap_or(f64::NAN)]);
            Series::line(name, Colour::Blue, stroke, points)
        };
        let is_range = trade.pairs.iter().any(|pair| pair.other.is_some());
        let [bound, beyond] = if trade.parameter.is_upper_bound() { ["most", "least"] } else { ["least", "most"] };
        let known = |pair: &RequiredPair| Some((pair.given, pair.found?, pair.found_bounds()));
        let known: Vec<Known> = trade.pairs.iter().filter_map(known).collect();
        let mut series: Vec<Series> = band(&open(found), &known).into_iter().collect();
        series.push(line(if is_range { bound } else { "" }, Stroke::Solid, |pair| pair.found));
        if is_range {
            let known = |pair: &RequiredPair| Some((pair.given, pair.other?, pair.other_bounds()));
            series.extend(band("", &trade.pairs.iter().filter_map(known).collect::<Vec<_>>()));
            series.push(line(beyond, Stroke::Dashed, |pair| pair.other));
        }
        let name = if is_range { trade.parameter.to_string() } else { format!("{bound} {}", trade.parameter) };
        Panel::new(FigureAxis::new(&name, &trade.unit), 0.22, series)
    });
    let (against, unit) =
        found.trades.first().map_or((String::new(), ""), |trade| (trade.against.clone(), trade.against_unit.as_str()));
    let range = extent(found.trades.iter().flat_map(|trade| trade.pairs.iter().map(|pair| pair.given)));
    let needs: Vec<&str> = found.trades.iter().map(|trade| trade.need.as_str()).collect();
    let title = format!("{}: {}", found.model.name, needs.first().unwrap_or(&""));
    Figure::new(&title, FigureAxis::new(&against, unit).over(range), panels.collect())
}

/// Label of the band of the machine's uncertainty, shown once per panel.
fn open(found: &Design) -> String {
    let sources = Sources::of(&found.measured, found.errors);
    format!("uncertainty from {}", sources.name())
}
