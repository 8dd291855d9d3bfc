//! The local map's own orbits against the change of period, and the machine's beside them.

use crate::draw::{Axis, Beside, Colour, Data, Figure, Mark, Series, Stroke, Word};
use crate::figures::NextToCorner;
use crate::figures::plots::{panel, zero};

/// Changes of the period in a unit that makes them some tens or hundreds.
fn unit(reach: f64) -> (&'static str, f64) {
    if reach * 1e3 < 1.0 { ("µs", 1e6) } else { ("ms", 1e3) }
}

/// How much of the height of a panel the lower of two rays with slopes of another size takes, at least.
const SEEN: f64 = 0.15;

/// Positions less that of x* against the change of the period; a second panel shows the flatter rays enlarged.
pub fn local_map_figure(title: &str, shown: &NextToCorner) -> Figure {
    let (unit, per_second) = unit(shown.reach);
    let reach = shown.reach * per_second;
    let slopes: Vec<f64> =
        shown.rays.iter().flat_map(|ray| &ray.positions).map(|slope| slope.abs() * shown.reach).collect();
    let steepest = slopes.iter().copied().fold(0.0, f64::max);
    let flattest = slopes.iter().copied().filter(|size| *size > 0.0).fold(f64::INFINITY, f64::min);
    let signs = |at: fn(f64, f64) -> f64, start: f64| {
        let ends = shown.rays.iter().flat_map(|ray| &ray.positions).copied();
        ends.fold(start, at) * shown.reach
    };
    let (low, high) = (signs(f64::min, 0.0), signs(f64::max, 0.0));
    let room = 0.15 * (high - low);
    let mut panels = vec![drawn(shown, [low - room, high + room], "position less that of x*", true)];
    if flattest < SEEN * steepest {
        let flat = shown.rays.iter().flat_map(|ray| &ray.positions).find(|slope| slope.abs() * shown.reach == flattest);
        let side = flat.map_or(1.0, |slope| slope.signum());
        let ends = [-0.4 * side * flattest, 1.6 * side * flattest];
        panels.push(drawn(shown, [ends[0].min(ends[1]), ends[0].max(ends[1])], "the same, enlarged", false));
    }
    let rpm = |change: f64| 60.0 / (shown.period + change);
    Figure {
        title: title.into(),
        x: Axis::new("change of the period δT; faster to the left", unit).over([-reach, reach]),
        marks: vec![Mark { at: 0.0, label: format!("{:.4} rpm", rpm(0.0)) }],
        panels,
        note: format!(
            "At the left end the cam turns at {:.4} rpm, at the right end at {:.4}.",
            rpm(-shown.reach),
            rpm(shown.reach)
        ),
    }
}

fn drawn(shown: &NextToCorner, range: [f64; 2], name: &str, with_names: bool) -> crate::draw::Panel {
    let label = |name: &str| if with_names { name.to_owned() } else { String::new() };
    let (_, per_second) = unit(shown.reach);
    let mut series = Vec::new();
    let machine = shown
        .machine
        .iter()
        .flat_map(|line| line.points.iter().map(|[change, q]| [change * per_second, *q]).chain([[f64::NAN; 2]]));
    series.push(Series {
        label: label("the machine's own orbits"),
        colour: Colour::Grey,
        data: Data::Line { points: machine.collect(), stroke: Stroke::Thick },
    });
    for (stable, text, colour, stroke) in [
        (true, "of the local map: stable", Colour::Blue, Stroke::Solid),
        (false, "unstable", Colour::Vermilion, Stroke::Dashed),
    ] {
        let rays = shown.rays.iter().filter(|ray| ray.stable == stable);
        let points: Vec<[f64; 2]> = rays
            .flat_map(|ray| {
                ray.positions.iter().map(move |position| [ray.sign * shown.reach * per_second, position * shown.reach])
            })
            .flat_map(|end| [[0.0, 0.0], end, [f64::NAN; 2]])
            .collect();
        if !points.is_empty() {
            series.push(Series { label: label(text), colour, data: Data::Line { points, stroke } });
        }
    }
    let gone = [-1.0, 1.0].into_iter().filter(|sign| with_names && !shown.rays.iter().any(|ray| ray.sign == *sign));
    let words: Vec<Word> = gone
        .map(|sign| {
            let at = [0.5 * sign * shown.reach * per_second, 0.5 * (range[0] + range[1])];
            let text =
                if shown.left.contains(&sign) { "no orbit: motions leave" } else { "no orbit of period one or two" };
            Word { at, text: text.into(), beside: Beside::Above }
        })
        .collect();
    let fixed = shown.rays.iter().filter(|ray| ray.positions.len() == 1).filter_map(|ray| {
        let (name, along) =
            if ray.word == "L" { ("x^− before the corner", 0.5) } else { ("x^+ after the corner", 0.85) };
        let along = along * shown.reach;
        let at = [ray.sign * along * per_second, ray.positions.first()? * along];
        let beside = free_side(shown, at, range);
        (range[0] < at[1] && at[1] < range[1]).then(|| Word { at, text: name.into(), beside })
    });
    let words: Vec<Word> = words.into_iter().chain(fixed).collect();
    if !words.is_empty() {
        series.push(Series { label: String::new(), colour: Colour::Ink, data: Data::Words(words) });
    }
    panel(Axis::new(name, "m").over(range), 0.3, series, vec![zero()])
}

/// The side of a ray, at a point of it, with more room up to the next line or the end of the panel.
fn free_side(shown: &NextToCorner, at: [f64; 2], range: [f64; 2]) -> Beside {
    let (_, per_second) = unit(shown.reach);
    let change = at[0] / per_second;
    let rays = shown.rays.iter().filter(|ray| ray.sign * change > 0.0);
    let rays = rays.flat_map(|ray| ray.positions.iter().map(|position| position * change.abs()));
    let machine = shown.machine.iter().filter_map(|line| {
        let off = |point: &&[f64; 2]| (point[0] - change).abs();
        line.points.iter().min_by(|one, other| off(one).total_cmp(&off(other)))
    });
    let machine = machine.filter(|point| point[0] * change > 0.0).map(|point| point[1]);
    // A line that the ray lies on takes no side.
    let apart = 0.01 * (range[1] - range[0]);
    let others = rays.chain(machine).chain([0.0, range[0], range[1]]).map(|height| height - at[1]);
    let (above, below): (Vec<f64>, Vec<f64>) = others.filter(|off| off.abs() > apart).partition(|off| *off > 0.0);
    // A word far out goes inwards, or the frame would cut it.
    let outer = change.abs() > 0.6 * shown.reach;
    let room = |offs: Vec<f64>| offs.into_iter().map(f64::abs).fold(f64::INFINITY, f64::min);
    let rises = at[0] * at[1] > 0.0;
    let is_above = if outer { rises != (at[0] < 0.0) } else { room(above) > room(below) };
    match (is_above, rises) {
        (true, true) => Beside::AboveLeft,
        (true, false) => Beside::AboveRight,
        (false, true) => Beside::BelowRight,
        (false, false) => Beside::BelowLeft,
    }
}
