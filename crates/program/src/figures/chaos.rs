//! H-set over the impacts of a run: its strips and their images.

use crate::figures::{Entry, drawn};
use crate::show::words::hypotheses;
use corner_impact::covering::prove::prove;
use corner_impact::covering::{HSet, known};
use corner_impact::study::chaos::{Portrait, portrait};
use corner_impact_plot::layout::widened;
use corner_impact_plot::{
    BREAK, Beside, Colour, Data, Density, Figure, FigureAxis, Label, Panel, Series, Stroke, extent,
};

/// The report's figure of a chaotic set: the stored proof for this model beyond the corner impact, checked again.
pub(crate) const CHAOTIC_SET: Entry = Entry {
    id: "chaotic-set",
    place: "",
    takes_rpm: false,
    title: |subject| {
        subject.fast_title("a set of chaotic motions beyond the corner impact", |fast| {
            format!("a set of chaotic motions at {} rpm, proved", fast.beyond)
        })
    },
    draw: |subject, title| {
        let rpm = subject.shown.fast.clone()?.beyond;
        let kept = known(&subject.model.name).into_iter().find(|set| set.rpm == [rpm; 2]);
        let set = kept.ok_or_else(|| format!("no h-set is kept for {rpm} rpm; `chaos --rpm {rpm}` looks for one"))?;
        let refused = |impacts: u64| format!("the proof that the strip of {impacts} impacts covers the h-set failed");
        prove(&subject.machine(rpm), &set).map_err(|why| refused(why.impacts))?;
        let portrait = portrait(&subject.model, &set).map_err(|error| error.to_string())?;
        let caption = format!(
            "Impacts of a long run, and a parallelogram N of impacts. The map of as many impacts as the number at a strip takes the strip \
             to the line of its colour, along N and beyond both its ends. So a motion follows every sequence of these numbers (proved): \
             a set of chaotic motions exists, with a topological entropy of at least {:.5} per revolution. {}",
            // Rounded down, as a lower bound must be.
            (1e5 * set.entropy()).floor() / 1e5,
            hypotheses(&corner_impact::study::hypotheses(subject.machine(rpm).cam())).unwrap_or_default()
        );
        drawn(chaos_figure(title, &set, &portrait), caption)
    },
};

/// Colours of the strips in order, used in rotation.
const COLOURS: [Colour; 5] = [Colour::Blue, Colour::Vermilion, Colour::Green, Colour::Purple, Colour::Ink];

/// Draws the h-set over a portrait of impacts: cam angle at an impact across, velocity after it relative to the cam up.
pub fn chaos_figure(title: &str, set: &HSet, portrait: &Portrait) -> Figure {
    let corners = corners(set.x, set.y).map(|place| set.at(place));
    let [across, up] = [0, 1].map(|side: usize| widened(extent(corners.map(|corner| corner[side])), 0.06));
    let mut cloud = Density::new(across, up);
    portrait.impacts.iter().for_each(|[angle, velocity]| cloud.push(*angle, *velocity));
    let mut series = vec![Series::new("", Colour::Grey, Data::Density(cloud))];
    let mut names = Vec::new();
    for ((strip, image), colour) in set.strips.iter().zip(&portrait.images).zip(COLOURS.into_iter().cycle()) {
        let mut cells = Density::new(across, up);
        for step in 0..=FILLED {
            let x = strip.x[0] + (strip.x[1] - strip.x[0]) * step as f64 / FILLED as f64;
            let [from, to] = set.y.map(|y| set.at([x, y]));
            cells.join(from, to, usize::MAX);
        }
        series.push(Series::new("", colour, Data::Region { cells, strength: 0.35 }));
        let is_seen =
            |point: &[f64; 2]| across[0] <= point[0] && point[0] <= across[1] && up[0] <= point[1] && point[1] <= up[1];
        let outline = image.iter().map(|point| if is_seen(point) { *point } else { BREAK });
        let label = format!("{} impacts", strip.impacts);
        series.push(Series::line(&label, colour, Stroke::Solid, outline));
        let middle = 0.5 * (strip.x[0] + strip.x[1]);
        names.push(Label::new(set.at([middle, set.y[1]]), &strip.impacts.to_string(), Beside::AboveRight));
    }
    let outline = corners.into_iter().chain(corners.first().copied());
    series.push(Series::line("h-set N", Colour::Ink, Stroke::Thin, outline));
    series.push(Series::words(names));
    let velocity = FigureAxis::new("velocity u after the impact, relative to the cam", "m/s").over(up);
    Figure::new(
        title,
        FigureAxis::degrees("cam angle at impact φ").over(across),
        vec![Panel::new(velocity, 0.7, series)],
    )
}

/// Number of lines that fill a strip.
const FILLED: usize = 400;

/// Corners of the parallelogram, in cyclic order.
fn corners(x: [f64; 2], y: [f64; 2]) -> [[f64; 2]; 4] {
    [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]
}
