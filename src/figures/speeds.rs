//! Attractors over speeds: where their impacts fall, over which speeds each is there, and how many starts end on it.

use crate::draw::layout::{TEXT, WIDTH, width};
use crate::draw::{Axis, BREAK, Beside, Colour, Data, Density, Figure, Marker, Panel, Series, Spacing, Stroke, Word};
use crate::figures::Across;
use crate::figures::cam::CornerMark;
use crate::figures::impacts::{WHOLE_CAM, impact_angles};
use crate::orbit::long_run::Kind;
use crate::show::words;
use crate::study::speeds::{AttractorRow, SpeedSurvey};

/// The colours of attractors, and the marks by which those are told apart without them.
const COLOURS: [Colour; 4] = [Colour::Blue, Colour::Vermilion, Colour::Green, Colour::Purple];
const MARKERS: [Marker; 4] = [Marker::Dot, Marker::Ring, Marker::Triangle, Marker::Square];
/// The same of those whose impacts are a cloud.
const OF_CLOUDS: [Marker; 4] = [Marker::Diamond, Marker::Cross, Marker::Plus, Marker::Below];

fn marker(attractor: &AttractorRow, colour: Colour) -> Marker {
    let markers = if is_cloud(attractor) { OF_CLOUDS } else { MARKERS };
    COLOURS.iter().zip(markers).find(|(known, _)| **known == colour).map_or(Marker::Dot, |(_, marker)| marker)
}

/// Whether it has more impacts than can be marked one by one.
fn is_cloud(attractor: &AttractorRow) -> bool {
    attractor.kind != Kind::Periodic
}

/// A few impacts of a cloud, over all of its speeds: in grey they tell it from another.
fn few(across: &Across, attractor: &AttractorRow) -> impl Iterator<Item = [f64; 2]> {
    /// At so many of its speeds, and of the impacts of each, at most.
    const FEW: [usize; 2] = [8, 3];
    let speeds = attractor.at.iter().filter(|at| !at.impact_angles.is_empty());
    let apart = attractor.at.len().div_ceil(FEW[0]).max(1);
    speeds.skip(apart / 2).step_by(apart).flat_map(|at| {
        let apart = at.impact_angles.len().div_ceil(FEW[1]);
        at.impact_angles.iter().step_by(apart.max(1)).map(|phase| [across.place(at.value()), phase.to_degrees()])
    })
}

/// Each kind of motion with the stroke of its bar.
const BARS: [(Kind, Stroke); 5] = [
    (Kind::Stays, Stroke::Thick),
    (Kind::Periodic, Stroke::Solid),
    (Kind::Resting, Stroke::Dashed),
    (Kind::Chaotic, Stroke::Dotted),
    (Kind::Undecided, Stroke::Thin),
];

/// What `speeds` finds: impact phases in degrees, a bar for each attractor, and shares of starts, against the speed.
///
/// The page is `across` units wide, of which a letter is [`TEXT`] high: names of attractors that would touch there stand in lanes of their own.
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
    let shares = Panel::new(Axis::new("share of starts", "%").over(SHARES), 0.14, shares);
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

/// Its first panel alone: where impacts are on the cam.
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

/// From where to where an attractor's bar is drawn.
fn bar(over: &Across, attractor: &AttractorRow) -> [f64; 2] {
    attractor.range().map(|end| over.place(end))
}

/// A colour for each attractor, other than those of what it coexists with or follows closely, as far as there are enough.
fn colours(found: &SpeedSurvey) -> Vec<Colour> {
    /// Of the range.
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

/// The axis of shares, a little wider than they can be.
const SHARES: [f64; 2] = [-5.0, 105.0];

/// An attractor, its lane, the uppermost being 0, and the side of its beginning on which its name stands; none of one that is too
/// short to be seen where there are many.
type Placed<'a> = (&'a AttractorRow, Colour, usize, Option<Beside>);

/// The attractors in as few lanes as they and their names fit into, and how many lanes that are.
fn placed<'a>(found: &'a SpeedSurvey, colours: &[Colour], across: f64) -> (Vec<Placed<'a>>, usize) {
    /// Of the range: what is left between two bars of a lane.
    const APART: f64 = 0.004;
    /// Of the page's width: what labels take on either side of the frame.
    const LABELS: f64 = 130.0;
    /// More lanes are not looked through: what is shorter than this part of the range stands in one of its own then.
    const LOOKED_THROUGH: usize = 12;
    const SHORT: f64 = 0.01;
    let over = over(found);
    let [low, high] = found.range.map(|end| over.place(end));
    let span = high - low;
    // What a name takes of the range, with half a letter's room.
    let name =
        |attractor: &AttractorRow| span * (width(&attractor.id, TEXT) + 0.5 * TEXT) / (across - LABELS).max(LABELS);
    let each = || found.attractors.iter().zip(colours);
    let lanes = |named: &dyn Fn(&AttractorRow) -> bool| {
        let mut ends: Vec<f64> = Vec::new();
        let mut placed = Vec::new();
        for (attractor, colour) in each().filter(|(attractor, _)| named(attractor)) {
            let ([from, to], name) = (bar(&over, attractor), name(attractor));
            // At the right edge there is no room beside the bar's beginning but on the left.
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

/// The range of speeds of each attractor as a bar, stroked by its kind.
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
    // In the middle of each bar stands what the attractor has above.
    let marks = placed.iter().map(|(attractor, colour, lane, _)| {
        let [from, to] = bar(over, attractor);
        let middle = [0.5 * (from + to), place(*lane)];
        Series::points("", *colour, marker(attractor, *colour), [middle])
    });
    let names = placed.iter().filter_map(|(attractor, _, lane, beside)| {
        Some(Word::new([bar(over, attractor)[0], place(*lane)], &attractor.id, (*beside)?))
    });
    let series = bars.chain(marks).chain(Series::words(names).if_any()).collect();
    // Above the first lane its names have room in a narrow figure, too.
    let range = [0.5 + place(lanes), 1.3];
    let axis = Axis { spacing: Spacing::Nothing, ..Axis::new("attractor", "").over(range) };
    Panel::new(axis, 0.05 + 0.03 * (range[1] - range[0]), series)
}
