//! Attractors over speeds: where their impacts fall, over which speeds each is there, and how many starts end on it.

use crate::draw::layout::{TEXT, WIDTH, width};
use crate::draw::{Axis, BREAK, Beside, Colour, Data, Density, Figure, Marker, Panel, Series, Spacing, Stroke, Word};
use crate::figures::SPEED;
use crate::figures::cam::CornerMark;
use crate::figures::impacts::{WHOLE_CAM, impact_angles};
use crate::orbit::ending::Kind;
use crate::show::words;
use crate::study::speeds::{Attractor, Speeds};

/// The colours of attractors, and the marks by which those are told apart without them.
const COLOURS: [Colour; 4] = [Colour::Blue, Colour::Vermilion, Colour::Green, Colour::Purple];
const MARKERS: [Marker; 4] = [Marker::Dot, Marker::Ring, Marker::Triangle, Marker::Square];

fn marker(colour: Colour) -> Marker {
    COLOURS.iter().zip(MARKERS).find(|(known, _)| **known == colour).map_or(Marker::Dot, |(_, marker)| marker)
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
pub fn speeds_figure(found: &Speeds, corners: &[CornerMark], across: f64) -> Figure {
    let colours = colours(found);
    let colour = |index: usize| colours[index];
    let each = || found.attractors.iter().enumerate();
    let shade = |top: f64| {
        let corners = found.coexistence.iter().flat_map(|over| [BREAK, [over.from_rpm, top], [over.to_rpm, top]]);
        Series::area("", Colour::Grey, Stroke::Thin, corners).if_any()
    };
    let mut impacts: Vec<Series> = shade(WHOLE_CAM[1]).into_iter().collect();
    impacts.extend(each().filter_map(|(index, attractor)| {
        let places =
            attractor.at.iter().flat_map(|at| at.impact_angles.iter().map(|phase| [at.rpm, phase.to_degrees()]));
        if attractor.kind == Kind::Periodic {
            let points = Series::points("", colour(index), marker(colour(index)), places);
            return points.called(&attractor.id).if_any();
        }
        let mut points = Density::new(found.rpm, WHOLE_CAM);
        places.for_each(|[rpm, degrees]| points.push(rpm, degrees));
        Some(Series::new("", colour(index), Data::Density(points)).called(&attractor.id))
    }));
    let impacts = Panel::new(impact_angles().over(WHOLE_CAM), 0.42, impacts);
    let impacts = Panel { marks: corners.iter().map(CornerMark::mark).collect(), ..impacts };
    let shares = each().map(|(index, attractor)| {
        let stroke = BARS.iter().find(|(kind, _)| *kind == attractor.kind).map_or(Stroke::Thin, |(_, stroke)| *stroke);
        let points = attractor.at.iter().map(|at| [at.rpm, 100.0 * at.share.value]);
        Series::line("", colour(index), stroke, points).called(&attractor.id)
    });
    let shares = shade(SHARES[1]).into_iter().chain(shares).collect();
    let shares = Panel::new(Axis::new("share of starts", "%").over(SHARES), 0.14, shares);
    let title = format!("{}: attractors from {} to {} rpm", found.model, found.rpm[0], found.rpm[1]);
    let axis = Axis::new(SPEED[0], SPEED[1]).over(found.rpm);
    let mut figure = Figure::new(&title, axis, vec![impacts, bars(found, &colours, across), shares]);
    if !found.coexistence.is_empty() {
        figure.note = "grey: several attractors, each reached by runs".into();
    }
    figure
}

/// Its first panel alone: where impacts are on the cam.
pub fn impacts_by_speed(found: &Speeds, corners: &[CornerMark]) -> Figure {
    let mut figure = speeds_figure(found, corners, WIDTH);
    figure.panels.truncate(1);
    let several = if found.coexistence.is_empty() { "" } else { "; grey: several, each reached by runs" };
    figure.note = format!("each colour and shape is one motion{several}");
    Figure { title: format!("{}: impacts from {} to {} rpm", found.model, found.rpm[0], found.rpm[1]), ..figure }
}

/// A colour for each attractor, other than those of what it coexists with or follows closely, as far as there are enough.
fn colours(found: &Speeds) -> Vec<Colour> {
    /// Of the range.
    const CLOSE: f64 = 0.02;
    let mut colours: Vec<Colour> = Vec::new();
    for (index, attractor) in found.attractors.iter().enumerate() {
        let from = attractor.rpm[0] - CLOSE * (found.rpm[1] - found.rpm[0]);
        let near = found.attractors.iter().zip(&colours).filter(|(other, _)| other.rpm[1] >= from);
        let taken: Vec<Colour> = near.map(|(_, colour)| *colour).collect();
        let free = COLOURS.iter().find(|colour| !taken.contains(colour));
        colours.push(*free.unwrap_or(&COLOURS[index % COLOURS.len()]));
    }
    colours
}

/// The axis of shares, a little wider than they can be.
const SHARES: [f64; 2] = [-5.0, 105.0];

/// The range of speeds of each attractor as a bar, stroked by its kind, in as few lanes as they fit into.
fn bars(found: &Speeds, colours: &[Colour], across: f64) -> Panel {
    /// Of the range: what is left between two bars of a lane.
    const APART: f64 = 0.004;
    /// Of the page's width: what labels take on either side of the frame.
    const LABELS: f64 = 130.0;
    let span = found.rpm[1] - found.rpm[0];
    // What a name takes of the range, with half a letter's room.
    let name = |id: &str| (width(id, TEXT) + 0.5 * TEXT) / (across - LABELS).max(LABELS);
    let mut lanes: Vec<f64> = Vec::new();
    let placed: Vec<(&Attractor, f64)> = found
        .attractors
        .iter()
        .map(|attractor| {
            let [from, to] = attractor.rpm;
            let lane = lanes.iter().position(|end| *end + APART * span < from).unwrap_or(lanes.len());
            lanes.resize(lanes.len().max(lane + 1), f64::NEG_INFINITY);
            lanes[lane] = to.max(from + name(&attractor.id) * span);
            (attractor, -(lane as f64))
        })
        .collect();
    let bars = BARS.iter().filter_map(|(kind, stroke)| {
        let of_kind = placed.iter().filter(|(attractor, _)| attractor.kind == *kind);
        let points =
            of_kind.flat_map(|(attractor, lane)| [BREAK, [attractor.rpm[0], *lane], [attractor.rpm[1], *lane]]);
        Series::line(words::kind(*kind), Colour::Ink, *stroke, points).if_any()
    });
    // In the middle of each bar stands what the attractor has above.
    let marks = placed.iter().zip(colours).filter_map(|((attractor, lane), colour)| {
        let middle = [0.5 * (attractor.rpm[0] + attractor.rpm[1]), *lane];
        let cloud = attractor.kind != Kind::Periodic;
        Series::points("", *colour, if cloud { Marker::Dot } else { marker(*colour) }, [middle]).if_any()
    });
    // At the right edge there is no room beside the bar's beginning but on the left.
    let names = placed.iter().map(|(attractor, lane)| {
        let is_last = attractor.rpm[0] + name(&attractor.id) * span > found.rpm[1];
        let beside = if is_last { Beside::AboveLeft } else { Beside::AboveRight };
        Word::new([attractor.rpm[0], *lane], &attractor.id, beside)
    });
    let series = bars.chain(marks).chain(Series::words(names).if_any()).collect();
    let lanes = [-(lanes.len() as f64) + 0.5, 0.9];
    let axis = Axis { spacing: Spacing::Nothing, ..Axis::new("attractor", "").over(lanes) };
    Panel::new(axis, 0.06 + 0.03 * (lanes[1] - lanes[0]), series)
}
