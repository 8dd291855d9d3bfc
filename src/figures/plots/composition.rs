//! The composition of the map and the discontinuity mapping, with the model's own flow.

use crate::cam::Side;
use crate::draw::{Axis, Beside, Colour, Data, Figure, Marker, Panel, Series, Stroke, Word};
use crate::figures::plots::{panel, plain};
use crate::figures::{Composition, Neighbour};

const MILLI: f64 = 1e3;

fn named(label: &str, colour: Colour, data: Data) -> Series {
    Series { label: label.into(), colour, data }
}

fn word(at: [f64; 2], text: &str, beside: Beside) -> Word {
    Word { at, text: text.into(), beside }
}

fn arrow(from: [f64; 2], to: [f64; 2], stroke: Stroke) -> Data {
    Data::Arrow { points: vec![from, to], stroke }
}

/// The whole of it: one revolution on either side of the corner, on the neighbour whose impact is before the corner.
pub fn composition_figure(title: &str, shown: &Composition) -> Figure {
    let in_periods = |line: &[[f64; 2]]| line.iter().map(|[time, q]| [time / shown.period, *q]).collect::<Vec<_>>();
    let near = &shown.far;
    let [first, minus, plus, last] = near.sections.map(|state| state.position);
    let [star, ..] = shown.states;
    let mut series = vec![
        named("cam c", Colour::Grey, Data::Area { points: in_periods(&shown.cam), stroke: Stroke::Thin }),
        named("orbit x*", Colour::Blue, Data::Line { points: in_periods(&shown.orbit), stroke: Stroke::Solid }),
    ];
    let [real, past] = [0, 1].map(|index| in_periods(&near.coming[index]));
    let going = in_periods(&near.going[0]);
    let mut neighbour = real;
    neighbour.extend(going);
    series.push(named("neighbour", Colour::Vermilion, Data::Line { points: neighbour, stroke: Stroke::Solid }));
    series.push(named("as if no impact", Colour::Vermilion, Data::Line { points: past, stroke: Stroke::Dashed }));
    series.push(named("discontinuity mapping", Colour::Purple, arrow([0.0, minus], [0.0, plus], Stroke::Solid)));
    let top = shown.orbit.iter().map(|[_, q]| *q).fold(first.max(last).max(plus), f64::max);
    let bottom = minus.min(shown.cam.iter().map(|[_, c]| *c).fold(f64::INFINITY, f64::min));
    let height = top - bottom;
    let sections = [-0.5, 0.0, 0.5]
        .iter()
        .flat_map(|time| [[*time, bottom - 0.1 * height], [*time, top + 0.16 * height], [f64::NAN; 2]]);
    series.insert(0, plain(sections.collect(), Colour::Grey, Stroke::Thin));
    let neighbours = vec![[-0.5, first], [0.0, minus], [0.0, plus], [0.5, last]];
    series.push(named("", Colour::Vermilion, Data::Points { points: neighbours, marker: Marker::Disc }));
    let stars = vec![[-0.5, star.position], [0.5, star.position]];
    series.push(named("", Colour::Blue, Data::Points { points: stars, marker: Marker::Disc }));
    let quarter =
        |line: &[[f64; 2]]| line.get(line.len() / 2).map_or([f64::NAN; 2], |[time, q]| [time / shown.period, *q]);
    series.push(named(
        "",
        Colour::Ink,
        Data::Words(vec![
            word([-0.5, top + 0.12 * height], "Π_1", Beside::Right),
            word([0.0, top + 0.12 * height], "Π_D", Beside::Right),
            word([0.5, top + 0.12 * height], "Π_2", Beside::Right),
            word([-0.5, star.position], "x^*", Beside::Above),
            word([0.5, star.position], "x^*", Beside::Above),
            word([-0.5, first], "x_1", Beside::Left),
            word([0.5, last], "x_2", Beside::Right),
            word([0.0, minus], "x_d^−", Beside::BelowRight),
            word([0.0, plus], "x_d^+", Beside::AboveRight),
            word(quarter(&near.coming[0]), "P_1", Beside::Left),
            word(quarter(&near.going[0]), "P_2", Beside::Right),
            word([0.0, minus + 0.3 * (plus - minus)], "P_D", Beside::Right),
        ]),
    ));
    Figure {
        title: title.into(),
        x: Axis::new("time from the passage of the corner, in periods T*", "").over([-1.0, 1.0]),
        marks: Vec::new(),
        panels: vec![panel(
            Axis::new("position", "m").over([bottom - 0.1 * height, top + 0.16 * height]),
            0.55,
            series,
            Vec::new(),
        )],
        note: String::new(),
    }
}

/// The surroundings of the corner: an impact before it above, one after it below.
pub fn discontinuity_mapping_figure(title: &str, shown: &Composition) -> Figure {
    let window = shown.window * MILLI;
    let panels = shown.neighbours.iter().map(|near| mapping(shown, near));
    Figure {
        title: title.into(),
        x: Axis::new("time from the passage of the corner", "ms").over([-window, window]),
        marks: Vec::new(),
        panels: panels.collect(),
        note: String::new(),
    }
}

fn mapping(shown: &Composition, near: &Neighbour) -> Panel {
    let scaled = |line: &[[f64; 2]]| -> Vec<[f64; 2]> { line.iter().map(|[time, q]| [time * MILLI, *q]).collect() };
    let [_, minus, plus, _] = near.sections.map(|state| state.position);
    let hit = [near.time * MILLI, near.impact[0].position];
    let cam: Vec<[f64; 2]> = scaled(&shown.before[0]).into_iter().chain(scaled(&shown.after[0])).collect();
    let mut continued = scaled(&shown.before[1]);
    continued.push([f64::NAN; 2]);
    continued.extend(scaled(&shown.after[1]));
    let heights = cam.iter().map(|[_, c]| *c).chain([minus, plus]);
    let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], q| [low.min(q), high.max(q)]);
    let room = 0.16 * (high - low);
    let range = [low - room, high + room];
    let before = near.side == Side::Minus;
    let mut real = scaled(&near.coming[0]);
    real.extend(scaled(&near.going[0]));
    // What is on no real motion, in the order in which the mapping passes it.
    let (unreal, label) = if before {
        (scaled(&near.coming[1]).into_iter().rev().collect(), "past the cam, undone")
    } else {
        (scaled(&near.going[1]).into_iter().rev().collect::<Vec<_>>(), "back in time")
    };
    let sides = |points| Data::Line { points, stroke: Stroke::Dotted };
    let foot = range[0];
    // The law that the impact obeys, where it is continued past the corner.
    let far = |end: Option<&[f64; 2]>| end.map_or([f64::NAN; 2], |[time, c]| [time * MILLI, *c]);
    let law = if before {
        word(far(shown.before[1].last()), "law before the corner", Beside::AboveLeft)
    } else {
        word(far(shown.after[1].first()), "law after the corner", Beside::BelowRight)
    };
    let time = vec![hit, [hit[0], foot]];
    let (beside_minus, beside_plus) =
        if before { (Beside::Right, Beside::Right) } else { (Beside::Left, Beside::Left) };
    let series = vec![
        plain(vec![[0.0, range[0]], [0.0, range[1]]], Colour::Grey, Stroke::Thin),
        plain(time, Colour::Grey, Stroke::Dotted),
        named("cam c", Colour::Grey, Data::Area { points: cam, stroke: Stroke::Solid }),
        named("its laws, continued", Colour::Ink, sides(continued)),
        named("orbit x*", Colour::Blue, Data::Line { points: scaled(&shown.orbit), stroke: Stroke::Thin }),
        named("neighbour", Colour::Vermilion, Data::Line { points: real, stroke: Stroke::Solid }),
        named(label, Colour::Vermilion, Data::Arrow { points: unreal, stroke: Stroke::Dashed }),
        named("discontinuity mapping", Colour::Purple, arrow([0.0, minus], [0.0, plus], Stroke::Solid)),
        named(
            "",
            Colour::Vermilion,
            Data::Points { points: vec![[0.0, minus], hit, [0.0, plus]], marker: Marker::Disc },
        ),
        named(
            "",
            Colour::Ink,
            Data::Words(vec![
                word([0.0, range[1] - 0.5 * room], "Π_D", if before { Beside::Left } else { Beside::Right }),
                word([0.0, minus + 0.25 * (plus - minus)], "P_D", if before { Beside::Right } else { Beside::Left }),
                word([0.0, minus], "x_d^−", beside_minus),
                word([0.0, plus], "x_d^+", beside_plus),
                // Between the flights before and after the impact, where no law of the cam is.
                word([hit[0], hit[1] + 0.06 * (high - low)], "x^−, x^+", Beside::Above),
                law,
                word([hit[0], foot + 0.5 * room], "−t_i", if before { Beside::Left } else { Beside::Right }),
            ]),
        ),
    ];
    let name = if before { "position, impact before the corner" } else { "position, impact after the corner" };
    panel(Axis::new(name, "m").over(range), 0.42, series, Vec::new())
}
