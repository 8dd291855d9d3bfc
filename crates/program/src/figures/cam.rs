//! Cam against its angle: lift and two derivatives, with gaps at jumps; and the marks of its corners in every figure.

use std::f64::consts::TAU;

use crate::figures::{Entry, drawn};
use corner_impact::cam::{Cam, Corner, Law, Lift};
use corner_impact_plot::{BREAK, Colour, Figure, FigureAxis, Mark, Panel, Series, Stroke};

/// The report's figure of the cam.
pub(crate) const CAM: Entry = Entry {
    id: "cam",
    place: "Figure 3(b)",
    takes_rpm: false,
    title: |subject| format!("{}: lift, velocity and acceleration of the cam", subject.model.name),
    draw: |subject, title| {
        drawn(
            lift_figure(&subject.cam, title),
            format!(
                "The lift of the cam and its first two derivatives against the cam angle. {}",
                corners_in_words(&subject.cam, "Vertical lines")
            ),
        )
    },
};

/// Largest number of labelled corners.
const LABELLED: usize = 12;
/// Number of samples per revolution: four per unit of the page.
const SAMPLES: usize = 2400;

/// Corner as it appears in figures.
#[derive(Clone, Debug, PartialEq)]
pub struct CornerMark {
    /// Cam angle, rad.
    pub angle_rad: f64,
    /// Letter of the corner; empty if it has none.
    pub name: String,
}

impl CornerMark {
    /// Reference line of the corner, labelled with its letter and its angle in degrees.
    pub(crate) fn mark(&self) -> Mark {
        let at = self.angle_rad.to_degrees();
        let angle = format!("{at:.1}°");
        Mark { at, label: if self.name.is_empty() { angle } else { format!("{} {angle}", self.name) } }
    }

    /// The letter, or the angle in degrees if there is no letter.
    pub(crate) fn label(&self) -> String {
        if self.name.is_empty() { self.mark().label } else { self.name.clone() }
    }
}

/// Corners to label, without knots of a spline: at most a dozen, ordered by angle. Low orders are chosen first, then large jumps. Corners
/// of a cam of three circles have the letters of the paper's drawing, with an apostrophe on the way down.
pub fn corner_marks(cam: &Cam) -> Vec<CornerMark> {
    let corners = cam.corners();
    let letters: &[&str] = if of_circles(cam) { &["R", "P", "Q", "Q'", "P'", "R'"] } else { &[] };
    let mut order: Vec<usize> = (0..corners.len()).filter(|index| !cam.is_knot(&corners[*index])).collect();
    let rank = |index: &usize| (corners[*index].jump_order, -corners[*index].jump.abs());
    order.sort_by(|one, other| {
        let ((order, size), (other_order, other_size)) = (rank(one), rank(other));
        order.cmp(&other_order).then(size.total_cmp(&other_size))
    });
    order.truncate(LABELLED);
    order.sort_unstable();
    let mark = |index: usize| CornerMark {
        angle_rad: corners[index].angle,
        name: letters.get(index).copied().unwrap_or_default().to_owned(),
    };
    order.into_iter().map(mark).collect()
}

/// Explains the marks of corners in a sentence.
pub(crate) fn corners_in_words(cam: &Cam, marks: &str) -> String {
    let marked = corner_marks(cam).len();
    let all: Vec<&Corner> = cam.corners().iter().filter(|corner| !cam.is_knot(corner)).collect();
    let orders = all.iter().map(|corner| corner.jump_order);
    let Some((least, most)) = orders.clone().min().zip(orders.max()) else {
        return match cam.corners().len() {
            0 => "It has no corner: no derivative of its lift jumps.".into(),
            knots => format!("It is a spline, whose {knots} knots are not marked, and has no corner."),
        };
    };
    let which = if marked < all.len() {
        format!("are {marked} of its {} corners", all.len())
    } else {
        format!("are its corners, {marked} in all")
    };
    let ordinal = match least {
        1 => "first".to_owned(),
        2 => "second".to_owned(),
        3 => "third".to_owned(),
        order => format!("{order}th"),
    };
    let what = if least == most {
        format!("the {ordinal} derivative of the lift jumps")
    } else {
        format!("a derivative of the lift jumps, the {ordinal} or a higher one")
    };
    format!("{marks} {which}, where {what}.")
}

/// Whether the cam consists of base circle, flank, nose, top, and their mirror image.
pub(crate) fn of_circles(cam: &Cam) -> bool {
    let dwells: Vec<bool> = cam.segments().iter().map(|segment| matches!(segment.law, Law::Dwell(_))).collect();
    let arcs = cam
        .segments()
        .iter()
        .all(|segment| matches!(segment.law, Law::Dwell(_)) || segment.law.circle_centre().is_some());
    arcs && cam.corners().len() == 6 && dwells == [true, false, false, true, false, false, true]
}

/// Draws lift, velocity and acceleration of the cam against its angle in degrees, with its corners marked.
pub(crate) fn lift_figure(cam: &Cam, title: &str) -> Figure {
    let corners = cam.corners();
    let marks = corner_marks(cam);
    let worth = corners.iter().filter(|corner| !cam.is_knot(corner)).count();
    let note = if marks.len() < worth {
        format!(
            "{} of {worth} corners are marked: those of the lowest derivatives, then of the largest jumps.",
            marks.len()
        )
    } else {
        String::new()
    };
    let panel = |name: &str, unit: &str, of: fn(&Lift) -> f64, order: usize| {
        let line = Series::line("", Colour::Blue, Stroke::Solid, samples(cam, corners, of, order));
        Panel::new(FigureAxis::new(name, unit), 0.21, vec![line])
    };
    let panels = vec![
        panel("lift c", "m", |lift| lift.value, 0),
        panel("velocity dc/dθ", "m/rad", |lift| lift.slope, 1).with_zero(),
        panel("acceleration d²c/dθ²", "m/rad²", |lift| lift.curvature, 2).with_zero(),
    ];
    let x = FigureAxis::degrees("cam angle θ").over([0.0, 360.0]);
    Figure { marks: marks.iter().map(CornerMark::mark).collect(), note, ..Figure::new(title, x, panels) }
}

/// Evenly spaced samples of a derivative of the lift against degrees. At each corner where it jumps, both sides are included with a break
/// between them.
fn samples(cam: &Cam, corners: &[Corner], derivative: fn(&Lift) -> f64, order: usize) -> Vec<[f64; 2]> {
    let Some(last) = cam.segments().last() else { return Vec::new() };
    let mut jumps = corners.iter().filter(|corner| corner.jump_order <= order && corner.angle > 0.0).peekable();
    let sides = |corner: &Corner| {
        let at = corner.angle.to_degrees();
        [[at, derivative(&corner.minus)], BREAK, [at, derivative(&corner.plus)]]
    };
    let mut points = Vec::new();
    for sample in 0..SAMPLES {
        let angle = TAU * sample as f64 / SAMPLES as f64;
        while let Some(corner) = jumps.next_if(|corner| corner.angle <= angle) {
            points.extend(sides(corner));
        }
        points.push([angle.to_degrees(), derivative(&cam.lift(angle))]);
    }
    points.extend(jumps.flat_map(sides));
    points.push([360.0, derivative(&last.law.lift(last.end))]);
    points
}
