//! Attractors over speeds: cam angles of their impacts, ranges of speed, and shares of the starts that end on them.

use crate::figures::Across;
use crate::figures::cam::CornerMark;
use crate::figures::impacts::{WHOLE_CAM, impact_angles};
use crate::show::words;
use corner_impact::orbit::long_run::Kind;
use corner_impact::study::speeds::{AttractorRow, SpeedSurvey};
use corner_impact_plot::layout::{TEXT, WIDTH, width};
use corner_impact_plot::{
    BREAK, Beside, Colour, Data, Density, Figure, FigureAxis, Label, Marker, Panel, Series, Stroke, TickSpacing,
};

/// Colours of attractors, and the marks that distinguish them without colour.
const COLOURS: [Colour; 4] = [Colour::Blue, Colour::Vermilion, Colour::Green, Colour::Purple];
const MARKERS: [Marker; 4] = [Marker::Dot, Marker::Ring, Marker::Triangle, Marker::Square];
/// Marks of attractors whose impacts are a cloud.
const OF_CLOUDS: [Marker; 4] = [Marker::Diamond, Marker::Cross, Marker::Plus, Marker::Below];

fn marker(attractor: &AttractorRow, colour: Colour) -> Marker {
    let markers = if is_cloud(attractor) { OF_CLOUDS } else { MARKERS };
    COLOURS.iter().zip(markers).find(|(known, _)| **known == colour).map_or(Marker::Dot, |(_, marker)| marker)
}

/// Whether the attractor has too many impacts to mark one by one.
fn is_cloud(attractor: &AttractorRow) -> bool {
    attractor.kind != Kind::Periodic
}

/// A few impacts of a cloud, over all of its speeds; their marks distinguish clouds in grey.
fn few(across: &Across, attractor: &AttractorRow) -> impl Iterator<Item = [f64; 2]> {
    /// Most speeds, and most impacts at each of them.
    const FEW: [usize; 2] = [8, 3];
    let speeds = attractor.at.iter().filter(|at| !at.impact_angles.is_empty());
    let apart = attractor.at.len().div_ceil(FEW[0]).max(1);
    speeds.skip(apart / 2).step_by(apart).flat_map(|at| {
        let apart = at.impact_angles.len().div_ceil(FEW[1]);
        at.impact_angles.iter().step_by(apart.max(1)).map(|phase| [across.place(at.value()), phase.to_degrees()])
    })
}

/// Strokes of bars by kind of motion.
const BARS: [(Kind, Stroke); 5] = [
    (Kind::Stays, Stroke::Thick),
    (Kind::Periodic, Stroke::Solid),
    (Kind::Resting, Stroke::Dashed),
    (Kind::Chaotic, Stroke::Dotted),
    (Kind::Undecided, Stroke::Thin),
];

/// Result of `speeds`: impact phases in degrees, a bar for each attractor, and shares of starts, against the speed.
///
/// The page is `across` units wide; a letter is [`TEXT`] high. Attractors whose names would touch are placed in separate lanes.
pub fn speeds_figure(found: &SpeedSurvey, corners: &[CornerMark], across: f64) -> Figure {
    let over = over(found);
    let colours = colours(found);
    let colour = |index: usize| colours[index];
    let each = || found.attractors.iter().enumerate();
    let shade = |top: f64| {
        let corners = found.coexistence.iter().map(|several| several.range().map(|end| over.place(end)));
        let corners = corners.flat_map(|[from, to]| [BREAK, [from, top], [to, top]]);
        Series::area("", Colour::Grey, Stroke::Thin, corners).if_any()
    };
    let mut impacts: Vec<Series> = shade(WHOLE_CAM[1]).into_iter().collect();
    impacts.extend(
        each()
            .flat_map(|(index, attractor)| {
                let places = attractor
                    .at
                    .iter()
                    .flat_map(|at| at.impact_angles.iter().map(|phase| [over.place(at.value()), phase.to_degrees()]));
                let marked = |places| {
                    let points = Series::points("", colour(index), marker(attractor, colour(index)), places);
                    points.called(&attractor.id).if_any()
                };
                if !is_cloud(attractor) {
                    return [marked(places.collect::<Vec<_>>()), None];
                }
                let mut points = Density::new(found.range.map(|end| over.place(end)), WHOLE_CAM);
                places.for_each(|[rpm, degrees]| points.push(rpm, degrees));
                let cloud = Series::new("", colour(index), Data::Density(points)).called(&attractor.id);
                [Some(cloud), marked(few(&over, attractor).collect())]
            })
            .flatten(),
    );
    let impacts = Panel::new(impact_angles().over(WHOLE_CAM), 0.42, impacts);
    let impacts = Panel { marks: corners.iter().map(CornerMark::mark).collect(), ..impacts };
    let shares = each().map(|(index, attractor)| {
        let stroke = BARS.iter().find(|(kind, _)| *kind == attractor.kind).map_or(Stroke::Thin, |(_, stroke)| *stroke);
        let points = attractor.at.iter().map(|at| [over.place(at.value()), 100.0 * at.share.value]);
        Series::line("", colour(index), stroke, points).called(&attractor.id)
    });
    let shares = shade(SHARES[1]).into_iter().chain(shares).collect();
    let shares = Panel::new(FigureAxis::new("share of starts", "%").over(SHARES), 0.14, shares);
    let title = format!("{}: attractors from {}", found.model, found.over.range(found.range));
    let axis = over.axis();
    let placed = placed(found, &colours, across);
    let unnamed = placed.0.iter().filter(|(.., beside)| beside.is_none()).count();
    let mut figure = Figure::new(&title, axis, vec![impacts, bars(&over, placed), shares]);
    let several = (!found.coexistence.is_empty()).then(|| "grey: several attractors, each reached by runs".to_owned());
    let short = (unnamed > 0).then(|| format!("lowest lane: {unnamed} over short ranges, without names"));
    figure.note = several.into_iter().chain(short).collect::<Vec<_>>().join("; ");
    figure
}

/// First panel of [`speeds_figure`] alone: impact phases.
pub fn impacts_by_speed(found: &SpeedSurvey, corners: &[CornerMark]) -> Figure {
    let mut figure = speeds_figure(found, corners, WIDTH);
    figure.panels.truncate(1);
    let several = if found.coexistence.is_empty() { "" } else { "; grey: several, each reached by runs" };
    figure.note = format!("each colour and shape is one motion{several}");
    Figure { title: format!("{}: impacts from {}", found.model, found.over.range(found.range)), ..figure }
}

/// The horizontal axis of a survey.
fn over(found: &SpeedSurvey) -> Across {
    Across::named(&found.over.name, &found.over.unit, found.over.spacing, found.range)
}

/// Ends of an attractor's bar on the axis.
fn bar(over: &Across, attractor: &AttractorRow) -> [f64; 2] {
    attractor.range().map(|end| over.place(end))
}

/// A colour for each attractor. It differs from those of coexisting and closely preceding attractors while there are enough colours.
fn colours(found: &SpeedSurvey) -> Vec<Colour> {
    /// Share of the range.
    const CLOSE: f64 = 0.02;
    let over = over(found);
    let [low, high] = found.range.map(|end| over.place(end));
    let mut colours: Vec<Colour> = Vec::new();
    for (index, attractor) in found.attractors.iter().enumerate() {
        let from = bar(&over, attractor)[0] - CLOSE * (high - low);
        let near = found.attractors.iter().zip(&colours).filter(|(other, _)| bar(&over, other)[1] >= from);
        let taken: Vec<Colour> = near.map(|(_, colour)| *colour).collect();
        let free = COLOURS.iter().find(|colour| !taken.contains(colour));
        colours.push(*free.unwrap_or(&COLOURS[index % COLOURS.len()]));
    }
    colours
}

/// Axis of shares, slightly wider than 0 to 100 %.
const SHARES: [f64; 2] = [-5.0, 105.0];

/// An attractor, its lane (0 is uppermost), and the side of its start where its name is written. Where there are many attractors, short
/// ones have no name.
type Placed<'a> = (&'a AttractorRow, Colour, usize, Option<Beside>);

/// Places the attractors in as few lanes as they and their names need; also returns the number of lanes.
fn placed<'a>(found: &'a SpeedSurvey, colours: &[Colour], across: f64) -> (Vec<Placed<'a>>, usize) {
    /// Smallest gap between two bars of a lane, as a share of the range.
    const APART: f64 = 0.004;
    /// Room for labels on both sides of the frame, in units of the page's width.
    const LABELS: f64 = 130.0;
    /// Most lanes that are tried. With more, bars shorter than the share `SHORT` of the range get one extra lane, without names.
    const LOOKED_THROUGH: usize = 12;
    const SHORT: f64 = 0.01;
    let over = over(found);
    let [low, high] = found.range.map(|end| over.place(end));
    let span = high - low;
    // Width of a name on the axis, with half a letter's room.
    let name =
        |attractor: &AttractorRow| span * (width(&attractor.id, TEXT) + 0.5 * TEXT) / (across - LABELS).max(LABELS);
    let each = || found.attractors.iter().zip(colours);
    let lanes = |named: &dyn Fn(&AttractorRow) -> bool| {
        let mut ends: Vec<f64> = Vec::new();
        let mut placed = Vec::new();
        for (attractor, colour) in each().filter(|(attractor, _)| named(attractor)) {
            let ([from, to], name) = (bar(&over, attractor), name(attractor));
            // At the right edge, only the left side of the bar's start has room.
            let (beside, taken) = if from + name > high {
                (Beside::AboveLeft, [from - name, to])
            } else {
                (Beside::AboveRight, [from, to.max(from + name)])
            };
            let lane = ends.iter().position(|end| *end + APART * span < taken[0]).unwrap_or(ends.len());
            ends.resize(ends.len().max(lane + 1), f64::NEG_INFINITY);
            ends[lane] = taken[1];
            placed.push((attractor, *colour, lane, Some(beside)));
        }
        (placed, ends.len())
    };
    let all = lanes(&|_| true);
    if all.1 <= LOOKED_THROUGH {
        return all;
    }
    let is_long = |attractor: &AttractorRow| {
        let [from, to] = bar(&over, attractor);
        to - from >= SHORT * span
    };
    let (mut placed, count) = lanes(&is_long);
    placed.extend(each().filter(|(one, _)| !is_long(one)).map(|(short, colour)| (short, *colour, count, None)));
    (placed, count + 1)
}

/// Range of speeds of each attractor as a bar, with a stroke for its kind.
fn bars(over: &Across, (placed, lanes): (Vec<Placed<'_>>, usize)) -> Panel {
    let place = |lane: usize| -(lane as f64);
    let bars = BARS.iter().filter_map(|(kind, stroke)| {
        let of_kind = placed.iter().filter(|(attractor, ..)| attractor.kind == *kind);
        let points = of_kind.flat_map(|(attractor, _, lane, _)| {
            let [from, to] = bar(over, attractor);
            [BREAK, [from, place(*lane)], [to, place(*lane)]]
        });
        Series::line(words::kind(*kind), Colour::Ink, *stroke, points).if_any()
    });
    // The middle of each bar has the attractor's marker from the panel above.
    let marks = placed.iter().map(|(attractor, colour, lane, _)| {
        let [from, to] = bar(over, attractor);
        let middle = [0.5 * (from + to), place(*lane)];
        Series::points("", *colour, marker(attractor, *colour), [middle])
    });
    let names = placed.iter().filter_map(|(attractor, _, lane, beside)| {
        Some(Label::new([bar(over, attractor)[0], place(*lane)], &attractor.id, (*beside)?))
    });
    let series = bars.chain(marks).chain(Series::words(names).if_any()).collect();
    // Room for the names above the first lane, in a narrow figure, too.
    let range = [0.5 + place(lanes), 1.3];
    let axis = FigureAxis { spacing: TickSpacing::Nothing, ..FigureAxis::new("attractor", "").over(range) };
    Panel::new(axis, 0.05 + 0.03 * (range[1] - range[0]), series)
}
