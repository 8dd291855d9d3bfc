//! Chart: a grid over two numbers, coloured by the motion at each point.

use serde::Serialize;

use super::{Across, curve};
use crate::show::words;
use crate::show::words::followed_for as followed;
use corner_impact::border_collision::EventCurve;
use corner_impact::model::Units;
use corner_impact::orbit::Parameter;
use corner_impact::orbit::long_run::Kind;
use corner_impact::study::chart::Charted;
use corner_impact::study::survey::{self, Point};
use corner_impact_plot::ticks::{Tick, TickSpacing, Ticks, ticks};
use corner_impact_plot::{Colour, Data, Density, Figure, FigureAxis, Panel, Series};

/// Quantity shown by the colours of a chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Coloured {
    /// Number of revolutions after which the motion repeats.
    Period,
    /// Growth of a small deviation.
    Growth,
    /// Kind of motion.
    Regime,
    /// Impacts per revolution.
    Impacts,
    /// Speed of the fastest impact.
    ImpactSpeed,
}

corner_impact::named!(Coloured);

/// Name of a class, its colour, and the strength of the colour.
type Class = (String, Colour, f64);

/// Largest number of bands of a coloured number.
const BANDS: usize = 9;

/// Classes, and the function that maps a point to its class; the last class is for failed points.
fn classes(found: &Charted, coloured: Coloured, units: &Units) -> (Vec<Class>, impl Fn(&Point) -> usize) {
    let number: fn(&Point) -> f64 = match coloured {
        Coloured::Growth => |point| point.growth.value,
        Coloured::Impacts => |point| point.impact_rate,
        Coloured::ImpactSpeed => |point| point.impact_speed,
        Coloured::Period | Coloured::Regime => |point| point.kind as u8 as f64,
    };
    let mut finite: Vec<f64> = found.points.iter().flatten().map(number).filter(|value| value.is_finite()).collect();
    finite.sort_unstable_by(f64::total_cmp);
    // A few outliers are assigned to the outermost bands.
    let part = |share: f64| finite.get((share * finite.len() as f64) as usize).copied().unwrap_or(f64::NAN);
    let range = [part(0.01), part(0.99)];
    let Ticks { ticks: edges, exponent } = ticks(range, TickSpacing::Decimal, BANDS, |_| true);
    let mut classes: Vec<Class> = match coloured {
        Coloured::Period => PERIODS.map(|(label, colour, strength)| (label.into(), colour, strength)).into(),
        Coloured::Regime => REGIMES.map(|(kind, colour, strength)| (words::kind(kind).into(), colour, strength)).into(),
        _ => {
            let unit = if coloured == Coloured::ImpactSpeed { units.spelled("m/s") } else { String::new() };
            bands(&edges, exponent, &unit)
        }
    };
    let plain = classes.len();
    classes.push(("no growth: it rests".into(), Colour::Grey, 0.4));
    classes.push(("not known".into(), Colour::Ink, 0.35));
    classes.push(("failed".into(), Colour::Ink, 0.9));
    let of = move |point: &Point| match coloured {
        Coloured::Period => period(point),
        Coloured::Regime => REGIMES.iter().position(|(kind, ..)| *kind == point.kind).unwrap_or(plain + 1),
        _ => match number(point) {
            value if value == f64::NEG_INFINITY => plain,
            value if value.is_nan() => plain + 1,
            value => edges.partition_point(|edge| edge.at <= value).min(plain - 1),
        },
    };
    (classes, of)
}

/// Kinds of motion with their colours.
const REGIMES: [(Kind, Colour, f64); 5] = [
    (Kind::Stays, Colour::Grey, 0.4),
    (Kind::Periodic, Colour::Blue, 0.9),
    (Kind::Resting, Colour::Green, 0.6),
    (Kind::Chaotic, Colour::Vermilion, 0.75),
    (Kind::Undecided, Colour::Ink, 0.35),
];

/// Periods of motion with their colours.
const PERIODS: [(&str, Colour, f64); 11] = [
    ("stays on the cam", Colour::Grey, 0.4),
    ("period 1", Colour::Blue, 1.0),
    ("period 2", Colour::Blue, 0.6),
    ("period 3", Colour::Purple, 1.0),
    ("period 4", Colour::Blue, 0.3),
    ("period 5 and longer", Colour::Purple, 0.5),
    ("rests, period 1", Colour::Green, 1.0),
    ("rests, period 2", Colour::Green, 0.6),
    ("rests, a longer period", Colour::Green, 0.3),
    ("chaotic", Colour::Vermilion, 0.75),
    ("undecided", Colour::Ink, 0.35),
];

/// Index in [`PERIODS`] of a point.
fn period(point: &Point) -> usize {
    match (point.kind, point.revolutions) {
        (Kind::Stays, _) => 0,
        (Kind::Periodic, period) => period.clamp(1, 5) as usize,
        (Kind::Resting, period @ (1 | 2)) => 5 + period as usize,
        (Kind::Resting, _) => 8,
        (Kind::Chaotic, _) => 9,
        (Kind::Undecided, _) => 10,
    }
}

/// Bands between `edges` and beyond both ends. Colours are stronger away from 0; negative growth is blue.
fn bands(edges: &[Tick], exponent: i32, unit: &str) -> Vec<Class> {
    let power = if exponent == 0 { String::new() } else { format!("e{exponent}") };
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    // Bands before this index are below 0.
    let zero = edges.partition_point(|edge| edge.at <= 0.0);
    let above = edges.len() + 1 - zero;
    let band = |index: usize| {
        let edge = |at: usize| edges.get(at).map(|edge| format!("{}{power}", edge.label));
        let label = match (index.checked_sub(1).and_then(edge), edge(index)) {
            (Some(low), Some(high)) => format!("{low} to {high}{unit}"),
            (Some(low), None) => format!("{low}{unit} and above"),
            (None, Some(high)) => format!("below {high}{unit}"),
            (None, None) => "the same everywhere".into(),
        };
        let (colour, part) = match index.checked_sub(zero) {
            Some(index) => (Colour::Vermilion, (index + 1) as f64 / above as f64),
            None => (Colour::Blue, (zero - index) as f64 / zero as f64),
        };
        (label, colour, 0.1 + 0.9 * part)
    };
    (0..=edges.len()).map(band).collect()
}

/// Draws the points of a chart in the colours of their classes, with curves of events over them; numbers are coloured in bands.
pub fn chart_figure(found: &Charted, coloured: Coloured, curves: &[EventCurve], units: &Units) -> Figure {
    let (x, y) = (&found.chart.x, &found.chart.y);
    let (classes, class_of) = classes(found, coloured, units);
    let range = |axis: &survey::Axis| {
        // The ends of the axis are the centres of the outermost cells; a single value has a cell of some width.
        let ([low, high], count) = (axis.ends().map(|end| axis.spacing.place(end)), axis.values.len() as f64);
        let half = if high > low {
            0.5 * (high - low) / (count - 1.0)
        } else {
            0.01 * if low == 0.0 { 1.0 } else { low.abs() }
        };
        [low - half, high + half]
    };
    let (across, up) = (range(x), range(y));
    let [columns, rows] = Density::new(across, up).cells();
    let mut areas: Vec<Option<Density>> = vec![None; classes.len()];
    let place = |index: usize, count: usize| (index as f64 + 0.5) / count as f64;
    for row in 0..rows {
        for column in 0..columns {
            let (right, above) = (place(column, columns), place(row, rows));
            let (i, j) = ((right * x.values.len() as f64) as usize, (above * y.values.len() as f64) as usize);
            let point = found.points[j * x.values.len() + i].as_ref();
            let class = point.map_or(classes.len() - 1, &class_of);
            let cells = areas[class].get_or_insert_with(|| Density::new(across, up));
            let [[x0, x1], [y0, y1]] = [across, up];
            cells.push(x0 + right * (x1 - x0), y0 + above * (y1 - y0));
        }
    }
    let there = areas.into_iter().zip(&classes).filter_map(|(cells, class)| cells.map(|cells| (cells, class)));
    let series = there.map(|(cells, (label, colour, strength))| {
        Series::new(label, *colour, Data::Region { cells, strength: *strength })
    });
    let across_speeds = x.parameter == Parameter::Speed;
    let place = |rpm, value| {
        let (right, above) = if across_speeds { (rpm, value) } else { (value, rpm) };
        [x.spacing.place(right), y.spacing.place(above)]
    };
    let series = series.chain(curve::lines(curves, place)).collect();
    let axis = |axis: &survey::Axis, range| match &axis.parameter {
        Parameter::Speed => FigureAxis { label: "speed".into(), ..Across::of(axis, units).axis() }.over(range),
        Parameter::Field(_) => Across::of(axis, units).axis().over(range),
    };
    let what = match coloured {
        Coloured::Period => "after how many revolutions the motion repeats",
        Coloured::Growth => "growth of a small deviation in a revolution",
        Coloured::Regime => "kind of motion",
        Coloured::Impacts => "impacts a revolution",
        Coloured::ImpactSpeed => "speed of the fastest impact",
    };
    let at = found.chart.speed().map_or_else(String::new, |rpm| format!(" at {rpm} rpm"));
    let followed = followed(found.points.iter().flatten().map(|point| point.followed));
    let title = format!("{}{at}: {what}{followed}", found.chart.model.name);
    Figure::new(&title, axis(x, across), vec![Panel::new(axis(y, up), 0.66, series)])
}
