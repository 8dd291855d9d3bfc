//! Attractors over speeds: cam angles of their impacts, ranges of speed, and shares of the starts that end on them.

use crate::figures::Across;
use crate::figures::cam::CornerMark;
use crate::figures::impacts::{WHOLE_CAM, impact_angles};
use crate::show::words;
use corner_impact::orbit::long_run::Kind;
use corner_impact::study::speeds::{At, AttractorRow, SpeedSurvey};
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

/// Whether the attractor has too many impacts to mark individually.
fn is_cloud(attractor: &AttractorRow) -> bool {
    attractor.kind != Kind::Periodic
}

/// A few impacts of a cloud, over all of its speeds; their marks distinguish clouds in grey.
fn few(across: &Across, attractor: &AttractorRow) -> impl Iterator<Item = [f64; 2]> {
    /// Largest number of speeds, and of impacts at each of them.
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

/// Draws the result of `speeds`: impact phases in degrees, a bar for each attractor, and shares of starts, against the speed.
///
/// The page is `across` units wide; a letter is [`TEXT`] high. Attractors whose names would touch are placed in separate lanes.
pub fn speeds_figure(found: &SpeedSurvey, corners: &[CornerMark], across: f64) -> Figure {
    with_folded(found, corners, across).0
}

/// Builds the figure, and a note on the attractors folded into one line.
fn with_folded(found: &SpeedSurvey, corners: &[CornerMark], across: f64) -> (Figure, Option<String>) {
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
    let folding = Folding::of(found, &colours, across);
    let (short, long): (Vec<_>, Vec<_>) = each().partition(|(_, attractor)| folding.folds(found, attractor));
    // Short-lived attractors are folded into one series.
    let brief = short.iter().flat_map(|(_, attractor)| places(&over, attractor));
    impacts.extend(Series::points("", Colour::Grey, Marker::Dot, brief).called(BRIEF).if_any());
    impacts.extend(
        long.iter()
            .flat_map(|(index, attractor)| {
                let (index, places) = (*index, places(&over, attractor));
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
    let shares = long.iter().map(|(index, attractor)| {
        let stroke = BARS.iter().find(|(kind, _)| *kind == attractor.kind).map_or(Stroke::Thin, |(_, stroke)| *stroke);
        let points = attractor.at.iter().map(|at| [over.place(at.value()), 100.0 * at.share.value]);
        // A single point makes no line.
        let of_one = || Series::points("", colour(*index), marker(attractor, colour(*index)), points.clone());
        let shares =
            if attractor.at.len() == 1 { of_one() } else { Series::line("", colour(*index), stroke, points.clone()) };
        shares.called(&attractor.id)
    });
    let shares = shade(SHARES[1]).into_iter().chain(shares).collect();
    let shares = Panel::new(FigureAxis::new("share of starts", "%").over(SHARES), 0.14, shares);
    let title = format!("{}: attractors from {}", found.model, found.over.range(found.range));
    let axis = over.axis();
    let placed = placed(found, &colours, across, folding);
    let folded = (!short.is_empty()).then(|| {
        format!("small grey dots: {} more motions, each over less than {} of the range", short.len(), folding.words())
    });
    let mut figure = Figure::new(&title, axis, vec![impacts, bars(&over, placed), shares]);
    let several = (!found.coexistence.is_empty()).then(|| "grey: several attractors, each reached by runs".to_owned());
    figure.note = several.into_iter().chain(folded.clone()).collect::<Vec<_>>().join("; ");
    (figure, folded)
}

/// Name of the series of folded attractors in tables.
const BRIEF: &str = "brief";

/// Impacts of an attractor: the position on the axis and the cam angle, degrees.
fn places(over: &Across, attractor: &AttractorRow) -> impl Iterator<Item = [f64; 2]> {
    let of = |at: &At| {
        let place = over.place(at.value());
        at.impact_angles.iter().map(move |phase| [place, phase.to_degrees()]).collect::<Vec<_>>()
    };
    attractor.at.iter().flat_map(of)
}

/// Rule for folding short-lived attractors into one line: the smallest range of those drawn separately.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Folding {
    Thousandth,
    /// Share of the range below which attractors are folded if there are too many lanes.
    Hundredth,
}

impl Folding {
    fn of(found: &SpeedSurvey, colours: &[Colour], across: f64) -> Self {
        /// Largest number of lanes that a reader can survey.
        const LANES: usize = 12;
        let lanes = placed(found, colours, across, Self::Thousandth).count;
        if lanes > LANES { Self::Hundredth } else { Self::Thousandth }
    }

    fn words(self) -> &'static str {
        if self == Self::Thousandth { "a thousandth" } else { "a hundredth" }
    }

    fn folds(self, found: &SpeedSurvey, attractor: &AttractorRow) -> bool {
        let share = if self == Self::Thousandth { 1e-3 } else { 1e-2 };
        let over = over(found);
        let [[from, to], [low, high]] = [bar(&over, attractor), found.range.map(|end| over.place(end))];
        to - from < share * (high - low)
    }
}

/// First panel of [`speeds_figure`] alone: impact phases.
pub fn impacts_by_speed(found: &SpeedSurvey, corners: &[CornerMark]) -> Figure {
    let (mut figure, folded) = with_folded(found, corners, WIDTH);
    figure.panels.truncate(1);
    let several = (!found.coexistence.is_empty()).then(|| "grey: several, each reached by runs".to_owned());
    let all = ["each colour and shape is one motion".to_owned()].into_iter().chain(several).chain(folded);
    figure.note = all.collect::<Vec<_>>().join("; ");
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

/// Chooses a colour for each attractor. It differs from the colours of coexisting and closely preceding attractors while there are enough
/// colours.
fn colours(found: &SpeedSurvey) -> Vec<Colour> {
    /// Largest distance of closely preceding attractors, as a share of the range.
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

/// Attractor, its colour, its lane (0 is uppermost), and the side of its start where its name is written; `None` if there is no room for
/// names.
type Placed<'a> = (&'a AttractorRow, Colour, usize, Option<Beside>);

/// Attractors in lanes.
struct Lanes<'a> {
    placed: Vec<Placed<'a>>,
    /// Number of lanes of named attractors.
    count: usize,
    /// Attractors folded into a lane below.
    brief: Vec<&'a AttractorRow>,
}

/// Places the attractors in the smallest number of lanes for them and their names.
fn placed<'a>(found: &'a SpeedSurvey, colours: &[Colour], across: f64, folding: Folding) -> Lanes<'a> {
    /// Smallest gap between two bars of a lane, as a share of the range.
    const APART: f64 = 0.004;
    /// Room for labels on both sides of the frame, in units of the page's width.
    const LABELS: f64 = 130.0;
    let over = over(found);
    let [low, high] = found.range.map(|end| over.place(end));
    let span = high - low;
    // Width of a name on the axis, with half a letter's room.
    let name =
        |attractor: &AttractorRow| span * (width(&attractor.id, TEXT) + 0.5 * TEXT) / (across - LABELS).max(LABELS);
    let mut ends: Vec<f64> = Vec::new();
    let mut placed = Vec::new();
    let (brief, long): (Vec<_>, Vec<_>) =
        found.attractors.iter().zip(colours).partition(|(attractor, _)| folding.folds(found, attractor));
    for (attractor, colour) in long {
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
    Lanes { placed, count: ends.len(), brief: brief.into_iter().map(|(attractor, _)| attractor).collect() }
}

/// Draws the range of speeds of each attractor as a bar, with a stroke for its kind.
fn bars(over: &Across, Lanes { placed, count, brief }: Lanes<'_>) -> Panel {
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
    let lanes = count + usize::from(!brief.is_empty());
    let dots = brief.iter().map(|attractor| [bar(over, attractor)[0], place(count)]);
    let dots = Series::points("", Colour::Grey, Marker::Dot, dots).called(BRIEF).if_any();
    let number = brief.first().map(|first| {
        let text = format!("{} brief", brief.len());
        Label::new([bar(over, first)[0], place(count)], &text, Beside::AboveRight)
    });
    let series = bars.chain(marks).chain(dots).chain(Series::words(names.chain(number)).if_any()).collect();
    // Room for the names above the first lane, even in a narrow figure.
    let range = [0.5 + place(lanes), 1.3];
    let axis = FigureAxis { spacing: TickSpacing::Nothing, ..FigureAxis::new("attractor", "").over(range) };
    Panel::new(axis, 0.05 + 0.03 * (range[1] - range[0]), series)
}
