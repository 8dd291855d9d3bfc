//! Orbits of the local map against the change of period, with the machine's orbits beside them.
//!
//! The local map looks the same at every scale, so each of its orbits is a ray from the corner impact. The machine's
//! orbits deviate from these rays where second-order terms matter.

use crate::figures::{Entry, FigureContext, by_stability, drawn};
use crate::show::words;
use corner_impact::orbit::Stability;
use corner_impact::study::local::NextToCorner;
use corner_impact_plot::{BREAK, Beside, Colour, Figure, FigureAxis, Label, Mark, Panel, Series, Stroke};

/// The report's figure of the local map.
pub(crate) const LOCAL_MAP: Entry = Entry {
    id: "local-map",
    place: "Figure 8",
    takes_rpm: false,
    title: |subject| format!("{}: the orbits of the local map", subject.model.name),
    draw: |subject, title| {
        let shown = subject.next_to_corner()?;
        let caption = format!(
            "Orbits of the local map of period one{} against the change δT of the machine's period: rays from the corner \
             impact, solid if stable, broken if unstable. Grey lines are the machine's own orbits.",
            if shown.rays.iter().any(|ray| ray.positions.len() == 2) { " and two" } else { "" }
        );
        drawn(figure(title, &shown), caption)
    },
};

/// Smallest height of the lower of two rays with different slopes, relative to the panel.
const SEEN: f64 = 0.15;

impl FigureContext {
    /// Computes the local map's diagram, or returns the reason why there is none.
    pub fn next_to_corner(&self) -> Result<NextToCorner, String> {
        NextToCorner::new(&self.model, &self.cam, self.found()?)
    }
}

/// Unit in which the changes of period are some tens or hundreds, and the number of these units per second.
fn unit(reach: f64) -> (&'static str, f64) {
    if reach * 1e3 < 1.0 { ("µs", 1e6) } else { ("ms", 1e3) }
}

/// Draws positions relative to x* against the change of the period; a second panel enlarges the flatter rays.
fn figure(title: &str, shown: &NextToCorner) -> Figure {
    let (unit, per_second) = unit(shown.reach);
    let reach = shown.reach * per_second;
    let slopes = || shown.rays.iter().flat_map(|ray| &ray.positions).copied();
    let sizes = || slopes().map(|slope| slope.abs() * shown.reach);
    let steepest = sizes().fold(0.0, f64::max);
    let flattest = sizes().filter(|size| *size > 0.0).fold(f64::INFINITY, f64::min);
    let (low, high) = (slopes().fold(0.0, f64::min) * shown.reach, slopes().fold(0.0, f64::max) * shown.reach);
    let room = 0.15 * (high - low);
    let mut panels = vec![panel(shown, [low - room, high + room], "position relative to x*", true)];
    if flattest < SEEN * steepest {
        let side = slopes().find(|slope| slope.abs() * shown.reach == flattest).map_or(1.0, f64::signum);
        let ends = [-0.4 * side * flattest, 1.6 * side * flattest];
        panels.push(panel(shown, [ends[0].min(ends[1]), ends[0].max(ends[1])], "the same, enlarged", false));
    }
    let [left, middle, right] = [-shown.reach, 0.0, shown.reach].map(|change| 60.0 / (shown.period + change));
    let x = FigureAxis::new("change of the period δT; faster to the left", unit).over([-reach, reach]);
    Figure {
        marks: vec![Mark { at: 0.0, label: format!("{middle:.4} rpm") }],
        note: format!("The cam turns at {left:.4} rpm at the left end, at {right:.4} rpm at the right end."),
        ..Figure::new(title, x, panels)
    }
}

fn panel(shown: &NextToCorner, range: [f64; 2], name: &str, with_names: bool) -> Panel {
    let label = |name| if with_names { name } else { "" };
    let (_, per_second) = unit(shown.reach);
    let machine = shown.machine.iter().flat_map(|line| {
        let points = line.points.iter().map(|[change, q]| [change * per_second, *q]);
        points.chain([BREAK])
    });
    let mut series = vec![Series::line(label("the machine's own orbits"), Colour::Grey, Stroke::Thick, machine)];
    let of = |stability| match stability {
        Stability::Stable => label("of the local map: stable"),
        other => label(words::stability(other)),
    };
    series.extend(by_stability(of, |stability| {
        let rays = shown.rays.iter().filter(|ray| ray.stability == stability);
        let ends = rays.flat_map(|ray| {
            ray.positions.iter().map(move |position| [ray.sign * shown.reach * per_second, position * shown.reach])
        });
        ends.flat_map(|end| [[0.0, 0.0], end, BREAK]).collect()
    }));
    let gone = [-1.0, 1.0].into_iter().filter(|sign| with_names && !shown.rays.iter().any(|ray| ray.sign == *sign));
    let gone = gone.map(|sign| {
        let at = [0.5 * sign * shown.reach * per_second, 0.5 * (range[0] + range[1])];
        let left = shown.left.contains(&sign);
        let text = if left { "no orbit: motions diverge" } else { "no orbit of period one or two" };
        Label::new(at, text, Beside::Above)
    });
    let fixed = shown.rays.iter().filter(|ray| ray.positions.len() == 1).filter_map(|ray| {
        let (name, along) =
            if ray.word == "L" { ("x^- before the corner", 0.5) } else { ("x^+ after the corner", 0.85) };
        let along = along * shown.reach;
        let at = [ray.sign * along * per_second, ray.positions.first()? * along];
        (range[0] < at[1] && at[1] < range[1]).then(|| Label::new(at, name, free_side(shown, at, range)))
    });
    series.extend(Series::words(gone.chain(fixed)).if_any());
    Panel::new(FigureAxis::new(name, "m").over(range), 0.3, series).with_zero()
}

/// Side of a ray, at one of its points, with more room to the next line or to the edge of the panel.
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
    // A line that coincides with the ray occupies no side.
    let apart = 0.01 * (range[1] - range[0]);
    let others = rays.chain(machine).chain([0.0, range[0], range[1]]).map(|height| height - at[1]);
    let (above, below): (Vec<f64>, Vec<f64>) = others.filter(|off| off.abs() > apart).partition(|off| *off > 0.0);
    // A word far out is written inwards, because the frame would cut it.
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
