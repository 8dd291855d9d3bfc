//! Discontinuity mapping P_D near the corner: an impact before it in the upper panel, one after it in the lower.

use crate::figures::composition::{Composition, Neighbour};
use crate::figures::{Entry, drawn};
use corner_impact::cam::Side;
use corner_impact_plot::{BREAK, Beside, Colour, Figure, FigureAxis, Label, Marker, Panel, Series, Stroke, extent};

/// The report's figure of the discontinuity mapping.
pub(crate) const DISCONTINUITY_MAPPING: Entry = Entry {
    id: "discontinuity-mapping",
    place: "Figure 7",
    takes_rpm: false,
    title: |subject| format!("{}: the discontinuity mapping on either side of the corner", subject.model.name),
    draw: |subject, title| {
        let shown = subject.composition()?;
        let window = shown.window * MILLI;
        let x = FigureAxis::new("time from the passage of the corner", "ms").over([-window, window]);
        let panels = shown.neighbours.iter().map(|near| mapping(&shown, near)).collect();
        drawn(
            Figure::new(title, x, panels),
            "P_D near the corner: from x_d⁻ on Π_D along the flight to the impact at time −t_i, through the impact (x⁻ to x⁺: the \
             velocity jumps), and along the flight after it to x_d⁺ on Π_D. In the upper panel the impact is before the corner \
             and the way to it goes back in time, in the lower it is after the corner and the way from it does; dotted lines are \
             the laws of the cam, each continued past the corner.",
        )
    },
};

const MILLI: f64 = 1e3;

fn mapping(shown: &Composition, near: &Neighbour) -> Panel {
    let scaled = |line: &[[f64; 2]]| -> Vec<[f64; 2]> { line.iter().map(|[time, q]| [time * MILLI, *q]).collect() };
    let [_, minus, plus, _] = near.sections.map(|state| state.position);
    let hit = [near.time * MILLI, near.impact[0].position];
    let [before, after] = [&shown.before, &shown.after].map(|law| [0, 1].map(|part| scaled(&law[part])));
    let cam = [before[0].as_slice(), &after[0]].concat();
    let continued = [before[1].as_slice(), &[BREAK], &after[1]].concat();
    let [low, high] = extent(cam.iter().map(|[_, c]| *c).chain([minus, plus]));
    let room = 0.16 * (high - low);
    let range = [low - room, high + room];
    let [coming, going] = [&near.coming, &near.going].map(|line| [0, 1].map(|part| scaled(&line[part])));
    let real = [coming[0].as_slice(), &going[0]].concat();
    // The virtual motion in the order in which the mapping follows it; the law at the impact, continued beyond the corner; and the sides of
    // words at the section and at the impact.
    let is_before = near.side == Side::Minus;
    let (name, unreal, label, law, [at_section, at_impact]) = if is_before {
        let end = before[1].last().copied().unwrap_or(BREAK);
        let law = Label::new(end, "law before the corner", Beside::AboveLeft);
        let sides = [Beside::Right, Beside::Left];
        ("position, impact before the corner", &coming[1], "past the cam, undone", law, sides)
    } else {
        let end = after[1].first().copied().unwrap_or(BREAK);
        let law = Label::new(end, "law after the corner", Beside::BelowRight);
        let sides = [Beside::Left, Beside::Right];
        ("position, impact after the corner", &going[1], "back in time", law, sides)
    };
    let words = [
        Label::new([0.0, range[1] - 0.5 * room], "Pi_D", at_impact),
        Label::new([0.0, minus + 0.25 * (plus - minus)], "P_D", at_section),
        Label::new([0.0, minus], "x_d^-", at_section),
        Label::new([0.0, plus], "x_d^+", at_section),
        // Between the flights before and after the impact, where the cam's law is not drawn.
        Label::new([hit[0], hit[1] + 0.06 * (high - low)], "x^-, x^+", Beside::Above),
        law,
        Label::new([hit[0], range[0] + 0.5 * room], "-t_i", at_impact),
    ];
    let (red, jump) = (Colour::Vermilion, [[0.0, minus], [0.0, plus]]);
    let series = vec![
        Series::line("", Colour::Grey, Stroke::Thin, [[0.0, range[0]], [0.0, range[1]]]),
        Series::line("", Colour::Grey, Stroke::Dotted, [hit, [hit[0], range[0]]]),
        Series::area("cam c", Colour::Grey, Stroke::Solid, cam),
        Series::line("its laws, continued", Colour::Ink, Stroke::Dotted, continued),
        Series::line("orbit x*", Colour::Blue, Stroke::Thin, scaled(&shown.orbit)),
        Series::line("neighbour", red, Stroke::Solid, real),
        Series::arrow(label, red, Stroke::Dashed, unreal.iter().rev().copied()),
        Series::arrow("discontinuity mapping", Colour::Purple, Stroke::Solid, jump),
        Series::points("", red, Marker::Disc, [jump[0], hit, jump[1]]),
        Series::words(words),
    ];
    Panel::new(FigureAxis::new(name, "m").over(range), 0.42, series)
}
